#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tools/flash.sh prints the right command for each board and programmer, and says what is missing.
# usage: flash.sh ROOT BUILD    BUILD: the folder with lv-f072.bin
set -eu
tool=$1/tools/flash.sh
BUILD=$2
export BUILD
failed=0
[ -f "$BUILD/lv-f072.bin" ] || { echo "SKIPPED: no image"; exit 77; }

expect() { # expect STATUS PATTERN ARGUMENT...
    status=$1
    pattern=$2
    shift 2
    got=0
    out=$(sh "$tool" "$@" 2>&1) || got=$?
    if [ "$got" = "$status" ] && printf '%s\n' "$out" | grep -q -- "$pattern"; then
        echo "ok: $*"
    else
        echo "FAILED: $* gave $got: $out"
        failed=1
    fi
}

expect 0 '^openocd -f interface/stlink.cfg -f target/stm32f0x.cfg -c "program .*/lv-f072.elf verify reset exit"' lv-f072 openocd --print
expect 0 '^st-flash --reset write .*/lv-f072.bin 0x08000000' lv-f072 st-flash --print
expect 2 "unknown argument 'lv-f071'" lv-f071
expect 2 '^BUILD=DIR .* kept.$'
[ "$(sh "$tool" 2>&1 | tail -n 1 | cut -c 1-9)" = BUILD=DIR ] || { echo "FAILED: usage ends in something else"; failed=1; }
expect 2 "unknown argument '\.'" .
expect 1 'no .*/hv-f405.bin; build it: cmake --preset hv-f405' hv-f405 --print
PATH=$(dirname "$(command -v python3)"):/bin
command -v openocd >/dev/null || command -v st-flash >/dev/null || expect 1 'neither openocd nor st-flash is installed' lv-f072

# an image with one damaged byte is not written
scratch=$BUILD/damaged
mkdir -p "$scratch"
python3 - "$BUILD/lv-f072.bin" "$scratch/lv-f072.bin" <<'END'
import sys
with open(sys.argv[1], "rb") as file:
    image = bytearray(file.read())
image[len(image) // 2] ^= 0x40
with open(sys.argv[2], "wb") as file:
    file.write(image)
END
cp "$BUILD/lv-f072.bin" "$scratch/hv-f405.bin"
BUILD=$scratch
expect 0 'target/stm32f4x.cfg' hv-f405 openocd --print
expect 1 'CRC .* header says' lv-f072 openocd --print
exit $failed
