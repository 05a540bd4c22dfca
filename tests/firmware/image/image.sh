#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds one firmware image and checks it: limits of flash and RAM, vector table, header, checksum, .hex = .bin, nothing
# of floating point or heap.
# usage: image.sh ROOT SCRATCH PRESET BOARD
set -eu
root=$1
scratch=$2
preset=$3
board=$4
failed=0

skip() { echo "SKIPPED: $1"; exit 77; }
command -v arm-none-eabi-gcc >/dev/null || skip "no arm-none-eabi-gcc"
echo '#include <string.h>' | arm-none-eabi-gcc -E -xc - >/dev/null 2>&1 || skip "no C library for arm-none-eabi-gcc (newlib)"
command -v ninja >/dev/null || skip "no ninja"
command -v python3 >/dev/null || skip "no python3"
case $preset in *-clang) command -v clang-19 >/dev/null && command -v ld.lld-19 >/dev/null || skip "no clang-19 with lld" ;; esac

limits() { # flash and RAM in bytes
    case $preset in
    lv-f072) echo 32768 8192 ;;
    lv-f072-clang) echo 36352 8192 ;;
    f072-nvm | f405-nvm) echo 16384 4096 ;;
    hv-f405* | f405-afe) echo 49152 20480 ;;
    *) echo 0 0 ;;
    esac
}

verdict() { # verdict WHAT COMMAND...: one line, remembered
    what=$1
    shift
    if "$@"; then echo "ok: $what"; else echo "FAILED: $what"; failed=1; fi
}

mkdir -p "$scratch"
rm -f "$scratch/CMakeCache.txt" # flags of a toolchain file that has changed since
cd "$root"
{ cmake --preset "$preset" -B "$scratch" && cmake --build "$scratch"; } >"$scratch/build.log" 2>&1 || {
    tail -n 40 "$scratch/build.log"
    echo "FAILED: does not build"
    exit 1
}
image=$scratch/$board

tools/size_image.sh "$image.elf"
set -- $(tools/size_image.sh "$image.elf" | awk -F ' *[|] *' 'NR == 3 { print $3, $4 }') $(limits)
verdict "flash $1 of less than $3" [ "$1" -lt "$3" ]
verdict "RAM $2 of at most $4" [ "$2" -le "$4" ]

none() { ! arm-none-eabi-nm "$image.elf" | awk '{ print $NF }' | grep -E "$1"; }
verdict "no floating point" none '^__aeabi_([a-z]+2[a-z]+|[dfc]+(r?add|r?sub|mul|div|cmp[a-z]*|rcmple))$|^__(add|sub|mul|div|float|fix)[a-z]*[sd]f'
verdict "no heap, no printing" none '^_?(malloc|calloc|realloc|free|sbrk|v?s?n?printf.*)$'

word() { od -An -tu4 -j "$1" -N 4 "$image.bin" | tr -d ' '; }
verdict "stack pointer in RAM, 8-aligned" [ $(($(word 0) / 65536)) -eq $((0x2000)) -a $(($(word 0) % 8)) -eq 0 ]
verdict "reset vector in flash, Thumb" [ $(($(word 4) / 1048576)) -eq $((0x080)) -a $(($(word 4) % 2)) -eq 1 ]
vectors() { # every vector but the first points to an address of this image with bit 0 set
    od -An -v -tu4 -w4 -N "$1" "$image.bin" | awk -v size="$(wc -c <"$image.bin")" '
        NR > 1 && ($1 % 2 != 1 || $1 - 134217728 >= size || $1 < 134217728) { print "vector " NR - 1 ": " $1; bad = 1 }
        END { exit bad }'
}
header=$(grep -aob BQIM "$image.bin" | head -n 1 | cut -d: -f1)
verdict "every vector points into the image ($((header / 4)) of them)" vectors "$header"

verdict "checksum" python3 tools/imagecrc.py check "$image.bin"
verdict "checksum of the .elf" python3 tools/imagecrc.py check "$image.elf"
arm-none-eabi-objcopy -I ihex -O binary "$image.hex" "$image.hex.bin"
verdict ".hex holds the same as .bin" cmp "$image.hex.bin" "$image.bin"
exit $failed
