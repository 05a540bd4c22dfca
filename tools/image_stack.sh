#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Worst-case stack of a board's image by the call graph: the deepest path of the program, and that of the interrupt handlers.
# usage: tools/image_stack.sh lv-f072|hv-f405 [OPTION OF stack.py...]
set -eu
cd "$(dirname "$0")/.."
board=$1
shift
case $board in
lv-f072) family=stm32f0 cpu=cortex-m0 driver=bq769x0 ;;
hv-f405) family=stm32f4 cpu=cortex-m4 driver=bq76pl536 ;;
*) echo "image_stack: no board $board" >&2; exit 2 ;;
esac
sources=$(ls src/*/*.c drivers/$driver/*.c hal/stm32/*.c hal/$family/*.c hal/boards/$board/*.c | grep -v stm32_string.c)
# The string functions of the image are leaves, compiled without the compiler's knowledge of them.
python3 tools/stack.py --cc arm-none-eabi-gcc --board hal/stm32/stack.targets \
    --flags="-Os -mcpu=$cpu -mthumb -DBQHOST_BOARD='\"$board\"' -DBQHOST_IMAGE_VERSION=1u -Ihal/stm32 -Ihal/$family -Ihal/boards/$board" \
    "$@" $sources
