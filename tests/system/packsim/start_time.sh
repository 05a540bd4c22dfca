#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# From reset to outputs decided on the image of a board, in simulated time. Decided is what comes first: the outputs switched
# on, or "standby" or "on" told on the CAN bus.
# usage: start_time.sh PACKSIM IMAGE.bin SCRATCH BELOW_S SCENARIO.ini ["AT ..."]
# AT: seconds at which the microcontroller is reset, one run for each; without it the time counts from power-on.
set -eu
packsim=$1
image=$2
scratch=$3
below=$4
scenario=$5
name=$(basename "$scenario" .ini)

skip() { echo "SKIPPED: $1"; exit 77; }
[ -f "$image" ] || skip "no image $image (cross compiler missing?)"
mkdir -p "$scratch"
bad=0

measure() { # measure REQUEST RESET_S: one line, and bad = 1 when it is too late
    file=$scratch/$name.$1.$2
    sed -e "s/^request = .*/request = $1/" -e "s/^[0-9.]* s = mcu reset/$2 s = mcu reset/" \
        -e '/^\[expect\]/,$d' "$scenario" >"$file.ini"
    end=$(awk -v at="$2" 'BEGIN { print int(at) + 2 }')
    "$packsim" "$file.ini" --quiet --duration "${end}s" --image "$image" --decisions "$file.decisions" >"$file.out" 2>&1 || {
        if grep -q 'needs the emulator' "$file.out"; then skip "packsim is built without the emulator"; fi
        cat "$file.out"
        exit 1
    }
    # The reset itself may cut a packet short; nothing else may be wrong.
    awk -v at="$2" '$1 == "misuse:" && $3 == "s" && $2 != at { print; n++ } END { exit n > 0 }' "$file.out" || bad=1
    awk -v from="$2" -v below="$below" -v what="$name, request $1, reset at $2 s" '
        $1 >= from && !after && ($2 $3 == "outputson" || $2 $3 == "stateon" || $2 $3 == "statestandby") { after = $1 - from; how = $2 " " $3 }
        END { printf "%s: %.3f s (%s), allowed %s s\n", what, after, how, below
              exit !(after > 0 && after < below) }' "$file.decisions" || bad=1
}

for at in ${6:-0}; do
    measure on "$at"
    measure off "$at"
done
exit $bad
