#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The example of README.md, compiled from its text, prints exactly what README.md says.
# usage: readme.sh README PROGRAM
set -eu
here=$(cd "$(dirname "$0")" && pwd)
expected=$(awk -v name=example-output -f "$here/extract.awk" "$1")
[ -n "$expected" ] || { echo "FAILED: README.md shows no output"; exit 1; }
lines=$(awk -v name=example -f "$here/extract.awk" "$1" | wc -l)
[ "$lines" -le 45 ] || { echo "FAILED: the example has grown to $lines lines"; exit 1; }
printed=$("$2") || { echo "FAILED: the example ended with status $?"; exit 1; }
if [ "$printed" != "$expected" ]; then
    printf 'FAILED: README.md says\n%s\nbut the example prints\n%s\n' "$expected" "$printed"
    exit 1
fi
printf '%s\n' "$printed"
