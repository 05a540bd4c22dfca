#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Worst-case stack of a board's image by the call graph of that image, optimised as it is: the deepest path of the program,
# and that of the interrupt handlers.
# usage: tools/image_stack.sh BOARD [OPTION OF stack.py...]
set -eu
cd "$(dirname "$0")/.."
board=${1:-}
[ -n "$board" ] && [ -f "hal/boards/$board/board.h" ] || { echo "image_stack: no board '$board' in hal/boards" >&2; exit 2; }
shift
build=build/stack-$board
rm -rf "$build"
{ CFLAGS=-fcallgraph-info=su,da cmake --preset "$board" -B "$build" && cmake --build "$build"; } >"$build.log" 2>&1 || {
    tail "$build.log"
    exit 1
}
python3 tools/stack.py --image "$build" --board hal/stm32/stack.targets "$@"
