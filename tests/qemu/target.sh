#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The portable code and its tests on the instruction set of the firmware: Cortex-M4, in QEMU, without an operating system.
# usage: target.sh build ROOT SCRATCH              the library, the simulator and the harness
#        target.sh test ROOT SCRATCH NAME FILE...  one test program, files below ROOT; its status is the program's
#        target.sh canary ROOT SCRATCH             a test that fails, one that runs into an exception, one that hangs
# Exit 77 with a reason when the cross compiler, its C library or QEMU is missing.
set -eu
part=$1
root=$2
scratch=$3
shift 3
cc=arm-none-eabi-gcc
flags="-mcpu=cortex-m4 -mthumb -Os -g -ffunction-sections -fdata-sections -fno-builtin-printf
    -Wall -Wextra -Wundef -Werror -I$root/include -I$root/tests/harness -I$root/sim -I$root/hal/sim"

missing() {
    echo "SKIPPED: $1"
    exit 77
}
command -v $cc >/dev/null || missing "$cc is not installed"
echo '#include <stdio.h>' | $cc -mcpu=cortex-m4 -mthumb -E -o /dev/null - 2>/dev/null || missing "$cc has no C library (newlib)"
command -v qemu-system-arm >/dev/null || missing "qemu-system-arm is not installed"
qemu-system-arm -M help | grep -q '^netduinoplus2 ' || missing "qemu-system-arm has no netduinoplus2"

build() {
    rm -rf "$scratch"
    mkdir -p "$scratch/objects"
    cd "$root"
    for source in $(find src drivers sim hal/sim -name '*.c') tests/harness/unity.c tests/qemu/startup.c; do
        std=c11
        case $source in src/* | drivers/*) std=c99 ;; esac
        $cc $flags -std=$std -Wconversion -Wshadow -DBQHOST_CRC8=table16 -c "$source" -o "$scratch/objects/$(echo "$source" | tr / _).o"
    done
    arm-none-eabi-ar rcs "$scratch/libtarget.a" "$scratch"/objects/*.o
}

# link NAME FLAG... FILE...: startup.o is named, so that the vectors are taken whatever wants them
link() {
    program=$1
    shift
    (cd "$root" && $cc $flags -std=c11 "$@" -nostartfiles -Wl,--gc-sections -T tests/qemu/target.ld \
        "$scratch/objects/tests_qemu_startup.c.o" "$scratch/libtarget.a" -lm -o "$scratch/$program.elf")
}

run() { # run NAME [SECONDS]
    timeout "${2:-120}" qemu-system-arm -M netduinoplus2 -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -kernel "$scratch/$1.elf"
}

expect() { # expect STATUS NAME [SECONDS]
    wanted=$1
    got=0
    run "$2" "${3:-20}" >"$scratch/$2.txt" 2>&1 || got=$?
    [ "$got" = "$wanted" ] || { cat "$scratch/$2.txt"; echo "FAILED: $2 ends with $got, not $wanted"; exit 1; }
    echo "ok: $2 ends with $got"
}

canary() {
    for case in PASSES FAILS MANY FAULTS HANGS; do
        link "canary_$case" -DCANARY_$case tests/qemu/canary.c
    done
    expect 0 canary_PASSES
    expect 1 canary_FAILS
    expect 255 canary_MANY
    expect 99 canary_FAULTS
    expect 124 canary_HANGS 3
}

case $part in
build) build ;;
test)
    name=$1
    shift
    link "$name" "$@"
    run "$name" 2>&1
    ;;
canary) canary ;;
*) exit 2 ;;
esac
