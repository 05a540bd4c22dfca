#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures and writes docs/performance.md (or the file named). Fails if a scan needs more bytes than it must, if the library holds
# writable data or wants anything from outside, or if its stack is not bounded.
# usage: tools/bench.sh [FILE]
set -euo pipefail
# shellcheck source=tools/needs.sh
source "$(dirname "$0")/needs.sh"
need_tools
cd "$root"
out=${1:-docs/performance.md}
page=$(mktemp)
trap 'rm -f "$page"' EXIT

arm() { have arm-none-eabi-gcc; }
version() { # "gcc 12.2.0", "arm-none-eabi-gcc 12.2.1"
    local target=
    case $1 in *-gcc) target=${1%gcc} ;; esac
    "$1" -v 2>&1 | sed -n "s/^\\(.*\\) version \\([^ ]*\\).*/$target\\1 \\2/p" | head -n 1
}

build() { # build CRC_FORM TARGET: an optimised build with line numbers, which change nothing
    local tree=$root/build/bench-$1
    fresh_if_foreign "$tree"
    cmake -S "$root" -B "$tree" -G "$generator" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DBQHOST_BUILD_TESTS=OFF \
        -DBQHOST_OTP=ON -DBQHOST_CRC8="$1" >/dev/null
    cmake --build "$tree" --parallel "$jobs" --target "$2" >/dev/null
}

run() { # run CRC_FORM TOOL ARGUMENT...: a tool of that build
    "$root/build/bench-$1/tools/$2/$2" "${@:3}"
}

# Instructions of one scan of 32 devices, room by room: the difference of runs with 10 and with 110 scans.
instructions() { # instructions CRC_FORM
    local count
    for count in 10 110; do
        valgrind --tool=callgrind --callgrind-out-file="$root/build/bench-$1/callgrind.$count" \
            "$root/build/bench-$1/tools/bench/bench" scan 32 "$count" >/dev/null 2>"$root/build/bench-$1/callgrind.log"
    done
    python3 tools/bench/selfcost.py "$root" "$root/build/bench-$1/callgrind.10" "$root/build/bench-$1/callgrind.110" 100
}

instruction_rows() {
    local form
    for form in table256 table16 bitwise; do
        build "$form" bench
        instructions "$form" | awk -v form="$form" '
            { cost[$1] = $2; sum += $2 }
            END { printf "| %s | %.0f | %.0f | %.0f | %.0f | **%.0f** |\n", form, cost["src/core"], cost["drivers"], cost["include"],
                  sum, sum / 192 }'
    done
}

linked() { # linked CPU [FLAG]: text, constants and RAM of an image
    arm-none-eabi-gcc -Os -mcpu="$1" -mthumb -std=c99 -ffunction-sections -fdata-sections -Iinclude "${@:2}" \
        tools/bench/image.c $(find src drivers -name '*.c' ! -path 'drivers/template/*') -nostartfiles --specs=nano.specs --specs=nosys.specs \
        -Wl,--gc-sections -Wl,-e,main -o "$root/build/bench-table16/image.elf"
    arm-none-eabi-size "$root/build/bench-table16/image.elf" | awk 'NR == 2 { print $1 + $2 " | " $2 + $3 }'
}

stack_rows() { # stack_rows NAME OPTION...
    python3 tools/stack.py --limit 1024 "${@:2}" | awk -v name="$1" '
        !first++ || $2 == "bq76pl536_poll" { path = $0; sub(/^ *[0-9]+ /, "", path); print "| " name " | " $1 " | `" path "` |" }'
}

bus_part() {
    cat <<'TEXT'
# What it costs

Every figure stands under the command that makes it; `tools/bench.sh` runs them all and writes this page. Figures of time depend on
the computer; the others repeat exactly with the same compiler.

## The bus

One complete scan of a healthy stack: convert everywhere, then status, brick voltage, six cells and two temperatures of every
device. The command fails unless it is one broadcast of 4 bytes and one burst of 23 bytes for each device.

    build/bench-table16/tools/bench/bench bus

TEXT
    run table16 bench bus
    cat <<'TEXT'

Bus time is 8 clocks a byte and 3 us between packets. Besides scans, the configuration of one device is read back every
`scrub_period_ms`, and balancing adds its writes while it runs.

One complete update of a bq769x0: status, every measurement, clearing of the fetched coulomb counter result. The command fails
unless the largest part needs 92 bytes with CRC and 50 without in 3 transactions. Addresses count; bus time is 9 clocks a byte.

    build/bench-table16/tools/bench/bench afe

TEXT
    run table16 bench afe
}

instruction_part() {
    cat <<TEXT

## Instructions

Scan of 32 devices (192 cells, 64 temperatures) and copying the sample, x86-64, \`-O2\`, $(version cc). Counted is what
is executed in the library's own sources, inlined functions included; simulator, back-end and C library are not. Two runs of different
length are subtracted, so that set-up cancels out. The rows differ in the form of the CRC (\`BQHOST_CRC8\`).

    valgrind --tool=callgrind --callgrind-out-file=more build/bench-table16/tools/bench/bench scan 32 110    # and: fewer, 10
    tools/bench/selfcost.py "\$PWD" fewer more 100

| CRC | src/core | drivers | inlined from include | whole scan | for each cell |
|---|---|---|---|---|---|
TEXT
    instruction_rows
}

size_part() {
    local objects images=
    objects=$(sh tools/size.sh cc -Os)
    cat <<TEXT

## Size

Bytes of all objects, \`BQHOST_OTP\` on. The command fails if an object holds writable data or wants anything but memory functions: no
heap, no floating point, no standard I/O.

    tools/size.sh cc -Os

$(version cc):

$objects
TEXT
    arm || return 0
    objects=$(sh tools/size.sh arm-none-eabi-gcc -Os -mcpu=cortex-m0 -mthumb)
    local cpu
    for cpu in cortex-m0 cortex-m4; do
        images+="| bq76PL536 driver alone | $cpu | $(linked $cpu) |"$'\n'
        images+="| driver, pack controller and super-loop | $cpu | $(linked $cpu -DWHOLE) |"$'\n'
    done
    cat <<TEXT

    tools/size.sh arm-none-eabi-gcc -Os -mcpu=cortex-m0 -mthumb

$(version arm-none-eabi-gcc):

$objects

What a linker keeps of it, with the smallest possible board (\`tools/bench/image.c\`, 32 devices, \`BQHOST_OTP\` off); flash includes the
compiler's helpers, RAM is everything the firmware owns but the stack:

    arm-none-eabi-gcc -Os -mcpu=cortex-m0 -mthumb -ffunction-sections -fdata-sections -Wl,--gc-sections ... tools/bench/image.c

| image | core | flash | RAM |
|---|---|---|---|
${images%$'\n'}
TEXT
}

afe_size_part() {
    arm || return 0
    cat <<TEXT

The bq769x0 driver by itself on a Cortex-M0+, bytes of flash of driver and core, without the table of the thermistor, which is the user's
(146 bytes for \`bq769x0_codes_103at\`). The base set configures a part that is known with read-back, its limits made codes by the compiler
(\`bq769x0_known.h\`), measures in three transactions, switches FETs and balancing outputs with read-back, reports faults and clears them on
request; it neither probes nor recovers by itself. No writable data, no floating point: the command fails otherwise.

    tools/afe_size.sh

$(sh tools/afe_size.sh)
TEXT
}

stack_part() {
    cat <<'TEXT'

## Stack

Deepest path from any entry point, bytes, found from the compiler's call graph; first the deepest of all, then that of the
driver's poll. What the board's own functions need comes on top. The command fails on recursion, on frames of unknown size and on
calls through pointers whose targets are not declared in `tools/stack.targets`.

    tools/stack.py                                                                    # x86-64
TEXT
    ! arm || echo '    tools/stack.py --cc arm-none-eabi-gcc --flags="-Os -mcpu=cortex-m0 -mthumb"'
    printf '\n| target | bytes | path |\n|---|---|---|\n'
    stack_rows x86-64
    ! arm || stack_rows Cortex-M0 --cc arm-none-eabi-gcc --flags="-Os -mcpu=cortex-m0 -mthumb"
    ! arm || stack_rows Cortex-M4 --cc arm-none-eabi-gcc --flags="-Os -mcpu=cortex-m4 -mthumb"
}

speed_part() {
    build table16 packsim
    cat <<'TEXT'

## Speed of the simulation

The whole firmware on a simulated pack of 32 devices, 192 cells, in a drive cycle, ten scans a second, on one core. Speed is in
times real time; bytes per scan include the read-back of configuration.

    build/bench-table16/tools/packsim/packsim tools/bench/speed.ini --quiet

| | |
|---|---|
TEXT
    speed_rows tools/bench/speed.ini
    cat <<'TEXT'

A bq76940 with 13 cells, two hours of riding, pause and charging, four updates a second:

    build/bench-table16/tools/packsim/packsim ebike-13s --quiet

| | |
|---|---|
TEXT
    speed_rows ebike-13s
}

speed_rows() { # speed_rows SCENARIO
    run table16 packsim "$1" --quiet |
        sed -n -E 's/^(devices found|cells|simulated|scans|bus bytes per scan|misuse|speed|result): (.*)$/| \1 | \2 |/p'
}

# ---- the firmware images ----

image_build() { # image_build BOARD: the image of the preset
    cmake -S "$root" --preset "$1" -B "$root/build/bench-$1" >/dev/null
    cmake --build "$root/build/bench-$1" --parallel "$jobs" >/dev/null
}

image_run() { # image_run BOARD SCENARIO DURATION
    local loop elf=$root/build/bench-$1/$1.elf
    loop=$(arm-none-eabi-nm "$elf" | awk '$3 == "board_pass" { print $1 }')
    "$root/build/bench-table16/tools/packsim/packsim" "$2" --duration "$3" --image "$root/build/bench-$1/$1.bin" --quiet \
        --costs "$root/build/bench-$1/costs" ${loop:+--loop "$loop"} >/dev/null
}

image_size() { # flash and RAM; the stack is part of the RAM
    arm-none-eabi-size "$root/build/bench-$1/$1.elf" | awk 'NR == 2 { print "| flash | " $1 + $2 " bytes |\n| RAM, stack included | " $2 + $3 " bytes |" }'
}

image_stack() { # the deepest path of the program; of the handlers; 36 bytes are what an exception saves
    sh tools/image_stack.sh "$1" | awk '
        $2 == "stm32_start" && !program { program = $1 }
        $2 ~ /_handler$/ && $1 > handler { handler = $1 }
        END { print "| deepest stack by the call graph | " program " bytes, and " handler + 36 " in an interrupt |" }'
}

image_table() { # image_table BOARD SCENARIO DURATION WHAT
    cat <<TEXT

### $1

$4

    build/bench-table16/tools/packsim/packsim $2 --duration $3 --image build/bench-$1/$1.bin --costs FILE --loop ADDRESS
    tools/bench/image_costs.py loop FILE build/bench-$1/$1.elf       # and: rooms
    tools/image_stack.sh $1

| | |
|---|---|
TEXT
    image_run "$1" "$2" "$3"
    image_size "$1"
    python3 tools/bench/image_costs.py loop "build/bench-$1/costs" "build/bench-$1/$1.elf"
    image_stack "$1"
    printf '\n| instructions for each update of the pack | |\n|---|---|\n'
    python3 tools/bench/image_costs.py rooms "build/bench-$1/costs" "build/bench-$1/$1.elf"
}

image_part() {
    arm && "$root/build/bench-table16/tools/packsim/packsim" --help | grep -q -e --image || return 0
    cat <<'TEXT'

## The firmware images

The unchanged images of the two boards in the emulator, where one instruction takes one cycle: flash wait states are not counted. An
update is one complete scan with everything that follows from it: pack step, actions, CAN, and the passes of the main loop in between.
"Longest pass" is what the main loop was ever kept busy for, from one look at everything to the next.
TEXT
    local board
    for board in lv-f072 hv-f405; do image_build $board; done
    image_table lv-f072 ebike-13s 120s "A bq7694003 with 13 cells, four updates a second."
    image_table hv-f405 tools/bench/speed.ini 60s "32 bq76PL536 with 192 cells, ten updates a second."
}

for tool in valgrind python3; do
    have $tool || { echo "bench: $tool is needed" >&2; exit 1; }
done
build table16 bench
for part in bus instruction size afe_size stack speed image; do
    "${part}_part" >>"$page"
done
cp "$page" "$out"
echo "written: $out"
