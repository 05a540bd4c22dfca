#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Writes the firmware of a board into it, or prints how.
# usage: tools/flash.sh BOARD [openocd|st-flash] [--print]
#   BOARD      a folder of hal/boards, for example lv-f072, built before: cmake --preset BOARD && cmake --build build/BOARD
#   programmer default: the first of openocd and st-flash that is installed; both need an ST-LINK on the board's SWD pins
#   --print    print the command line instead of running it
# BUILD=DIR takes the image from another build folder. The settings of the board (the last pages or own sectors) are kept.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
board= programmer= print=
for argument; do
    case $argument in
    openocd | st-flash) programmer=$argument ;;
    --print) print=1 ;;
    *) [ -f "$root/hal/boards/$argument/board.h" ] && board=$argument && continue
        echo "flash.sh: unknown argument '$argument'" >&2; sed -n 4,8p "$0" | cut -c 3- >&2; exit 2 ;;
    esac
done
[ -n "$board" ] || { sed -n 4,8p "$0" | cut -c 3- >&2; exit 2; }
target=$(sed -n 's/^bqhost_board([^ ]* \(stm32f[0-9]\) .*/\1x/p' "$root/hal/boards/$board/CMakeLists.txt")

image=${BUILD:-$root/build/$board}/$board
if [ ! -f "$image.bin" ]; then
    echo "flash.sh: no $image.bin; build it: cmake --preset $board && cmake --build build/$board" >&2
    exit 1
fi
if [ -z "$programmer" ]; then
    for candidate in openocd st-flash; do
        if command -v $candidate >/dev/null; then programmer=$candidate; break; fi
    done
fi
if [ -z "$programmer" ] && [ -z "$print" ]; then
    echo "flash.sh: neither openocd nor st-flash is installed (Debian: openocd, stlink-tools)" >&2
    exit 1
fi
python3 "$root/tools/imagecrc.py" check "$image.bin" >&2 || exit 1

case ${programmer:-openocd} in
openocd) set -- openocd -f interface/stlink.cfg -f "target/$target.cfg" -c "program $image.elf verify reset exit" ;;
st-flash) set -- st-flash --reset write "$image.bin" 0x08000000 ;;
esac
if [ -n "$print" ]; then
    for word; do case $word in *' '*) printf '"%s" ' "$word" ;; *) printf '%s ' "$word" ;; esac; done
    echo
    exit 0
fi
command -v "$1" >/dev/null || { echo "flash.sh: $1 is not installed" >&2; exit 1; }
exec "$@"
