#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds the deliberately broken images of one board, function by function: the linker puts the defects in the place of
# functions that an optimisation of the whole image would not leave there.
# usage: broken.sh ROOT SCRATCH BOARD
set -eu
root=$1
scratch=$2
board=$3

skip() { echo "SKIPPED: $1"; exit 77; }
command -v arm-none-eabi-gcc >/dev/null || skip "no arm-none-eabi-gcc"
echo '#include <string.h>' | arm-none-eabi-gcc -E -xc - >/dev/null 2>&1 || skip "no C library for arm-none-eabi-gcc (newlib)"
command -v ninja >/dev/null || skip "no ninja"
command -v python3 >/dev/null || skip "no python3"

mkdir -p "$scratch"
rm -f "$scratch/CMakeCache.txt" # flags of a toolchain file that has changed since
cd "$root"
{ cmake --preset "$board" -B "$scratch" -DBQHOST_BOARD="$board-broken" -DBQHOST_LTO=OFF && cmake --build "$scratch"; } >"$scratch/build.log" 2>&1 || {
    tail -n 40 "$scratch/build.log"
    echo "FAILED: does not build"
    exit 1
}
echo "built: $(cd "$scratch" && ls *.bin | tr '\n' ' ')"
