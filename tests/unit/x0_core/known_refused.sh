#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What a part that is known cannot be told does not compile.
# usage: known_refused.sh CC ROOT
set -eu
cc=$1
root=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

compiles() { # compiles PART REGISTERS
    printf '#include "bqhost/bq769x0_known.h"\nextern const bq769x0_known k;\nconst bq769x0_known k = {BQ769X0_PART(%s), .registers = BQ769X0_REGISTERS(BQ769X0_DIE, %s)};\n' \
        "$1" "$2" >"$scratch/k.c"
    "$cc" -std=c99 -Wall -Wextra -Werror -I"$root/include" -c "$scratch/k.c" -o "$scratch/k.o" 2>"$scratch/err"
}

good='50, 320, 100, 100, 2, 4'
compiles '15, 0x7fffu' "$good" || { cat "$scratch/err"; exit 1; }
while IFS='|' read -r part registers; do
    if compiles "$part" "$registers"; then
        echo "compiles: BQ769X0_PART($part) with $registers"
        exit 1
    fi
    grep -q "negative\|array size" "$scratch/err" || { cat "$scratch/err"; exit 1; }
    echo "refused: $part with $registers"
done <<END
6, 0x33u|$good
5, 0x3fu|$good
10, 0x3ebu|$good
15, 0x7fffu|7, 320, 100, 100, 2, 4
15, 0x7fffu|50, 7, 100, 100, 2, 4
15, 0x7fffu|8, 320, 21, 100, 2, 4
15, 0x7fffu|50, 320, 100, 69, 2, 4
15, 0x7fffu|50, 320, 100, 100, 0, 4
15, 0x7fffu|50, 320, 100, 100, 2, 0
15, 0x7fffu|60, 320, 40, 100, 2, 4
15, 0x7fffu|100, 320, 95, 100, 2, 4
END
