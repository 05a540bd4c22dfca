#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The console of an image from a pipe: the first line waits for the first prompt, each other for the answer to the one
# before it.
# usage: image_console.sh PACKSIM IMAGE.bin SCENARIO.ini
set -eu
[ -f "$2" ] || { echo "SKIPPED: no image $2 (cross compiler missing?)"; exit 77; }
out=$(printf 'help\nversion\n@1s cells' | "$1" "$3" --duration 2s --console --image "$2" 2>&1) || true
case $out in *'needs the emulator'*) echo "SKIPPED: packsim is built without the emulator"; exit 77 ;; esac
typed=$(printf '%s\n' "$out" | sed -n 's/^> \(..*\)/\1/p' | tr '\n' ' ')
[ "$typed" = 'help version cells ' ] || { echo "typed after a prompt: $typed"; printf '%s\n' "$out"; exit 1; }
printf '%s\n' "$out" | grep -q '^reset: outputs off, then restart$' || { echo "help is cut short: $out"; exit 1; }
