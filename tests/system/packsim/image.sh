#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# One scenario on the image of a board: every expectation holds, host build and image take the same decisions, and no pass
# of the main loop takes longer than 200 us. A longer scenario is cut off after LIMIT seconds.
# usage: image.sh PACKSIM IMAGE.bin SCENARIO.ini SCRATCH LIMIT
set -eu
packsim=$1
image=$2
scenario=$3
scratch=$4
limit=$5
name=$(basename "$scenario" .ini)

skip() { echo "SKIPPED: $1"; exit 77; }
[ -f "$image" ] || skip "no image $image (cross compiler missing?)"
mkdir -p "$scratch"

seconds_of() { # seconds_of KEY: a time of the scenario
    awk -F'[= ]+' -v key="$1" '$1 == key {
        print $2 * ($3 == "h" ? 3600 : $3 == "min" ? 60 : $3 == "ms" ? 0.001 : 1); exit }' "$scenario"
}
seconds=$(seconds_of duration)
set -- "$scenario" --quiet
cut=0
if [ "$seconds" -gt "$limit" ]; then
    cut=1
    set -- "$@" --duration "${limit}s"
fi

# What the host build cannot reach in the shortened time is not asked of the image either.
failed_of() { sed -n 's/^\(failed: .*\) (.*/\1/p' "$1"; }
"$packsim" "$@" --decisions "$scratch/$name.host" >"$scratch/$name.host.out" 2>&1 || [ "$cut" -eq 1 ] || {
    cat "$scratch/$name.host.out"
    exit 1
}
# The passes are counted at the function that the main loop calls.
loop=$(arm-none-eabi-nm "${image%.bin}.elf" | awk '$3 == "board_pass" { print $1 }')
[ -n "$loop" ] || { echo "no board_pass in ${image%.bin}.elf"; exit 1; }
case $image in *lv-f072.bin) pass_cycles=9600 ;; *) pass_cycles=33600 ;; esac
status=0
"$packsim" "$@" --image "$image" --costs "$scratch/$name.costs" --loop "$loop" --decisions "$scratch/$name.image" >"$scratch/$name.out" 2>&1 || status=$?
if grep -q 'needs the emulator' "$scratch/$name.out"; then skip "packsim is built without the emulator"; fi
cat "$scratch/$name.out"
if [ "$status" -ne 0 ]; then
    [ "$status" -eq 1 ] && [ "$(failed_of "$scratch/$name.out")" = "$(failed_of "$scratch/$name.host.out")" ] || exit 1
fi

# Within one control period, and the few milliseconds by which the scans of the two lie apart. The host build starts at
# once; a board starts its clocks and checks its image first. What the board decides is seen when it tells it: faults at
# once, the state once a period, so that one may pass unseen that lasted no longer.
awk -v period="$(seconds_of period)" -v start=0.15 -v apart=0.02 '
    { key = $2 == "fault" ? $2 " " $3 : $2; text = $3 " " $4 }
    FNR == NR { n = ++hosts[key]; host[key, n] = text; at[key, n] = $1
                if (key == "state" && n > 1 && $1 - at[key, n - 1] <= period) brief[n - 1] = 1
                next }
    { n = ++seen[key]
      if (key == "state") while (host[key, n] != text && brief[n]) n = ++seen[key]
      if (host[key, n] != text) { print "differs: image " $0 "; host " at[key, n] " " key " " host[key, n]; bad = 1; next }
      d = $1 - at[key, n]; worst = d * d > worst * worst ? d : worst
      if (d < -period - apart || d > period * ($2 == "state" ? 2 : 1) + start) { print "image " $0 "; host at " at[key, n] " s"; bad = 1 } }
    END { while (brief[seen["state"] + 1]) seen["state"]++
          for (k in hosts) if (hosts[k] != seen[k]) { print k ": host " hosts[k] " times, image " seen[k] + 0; bad = 1 }
          printf "largest difference: %.3f s\n", worst
          exit bad }' "$scratch/$name.host" "$scratch/$name.image"

awk -v most=$pass_cycles '$1 == "longest_pass" { n = $2 }
    END { printf "longest pass of the main loop: %d of %d cycles\n", n, most
          exit !(n > 0 && n <= most) }' "$scratch/$name.costs"
