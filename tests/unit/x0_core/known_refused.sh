#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What a part that is known cannot be told does not compile, and the compiler says why.
# usage: known_refused.sh CC ROOT
set -eu
cc=$1
root=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

compiles() { # compiles PART REGISTERS
    printf '#include "bqhost/bq769x0_known.h"\nextern const bq769x0_known k;\nconst bq769x0_known k = {BQ769X0_PART(%s), .registers = BQ769X0_REGISTERS(%s)};\n' \
        "$1" "$2" >"$scratch/k.c"
    "$cc" -std=c99 -Wall -Wextra -Werror -I"$root/include" -c "$scratch/k.c" -o "$scratch/k.o" 2>"$scratch/err"
}

limits='50, 320, 100, 100, 2, 4'
good="BQ769X0_DIE, $limits"
compiles '15, 0x7fffu' "$good" || { cat "$scratch/err"; exit 1; }
while IFS='|' read -r why part registers; do
    if compiles "$part" "$registers"; then
        echo "compiles: BQ769X0_PART($part) with $registers"
        exit 1
    fi
    grep -q "negative.*$why\|$why.*negative" "$scratch/err" || { cat "$scratch/err"; exit 1; }
    echo "refused: $part with $registers: $why"
done <<END
wiring_is_of_this_size|6, 0x33u|$good
wiring_is_of_this_size|5, 0x3fu|$good
wiring_is_of_this_size|10, 0x3ebu|$good
wiring_is_of_this_size|5, 0u|$good
source_is_thermistors_or_die|15, 0x7fffu|0, $limits
source_is_thermistors_or_die|15, 0x7fffu|BQ769X0_CTRL1_TEMP_SEL, $limits
ocd_mv_is_8_or_more|15, 0x7fffu|BQ769X0_DIE, 7, 320, 100, 100, 2, 4
ocd_ms_is_8_or_more|15, 0x7fffu|BQ769X0_DIE, 50, 7, 100, 100, 2, 4
scd_mv_is_22_or_more|15, 0x7fffu|BQ769X0_DIE, 8, 320, 21, 100, 2, 4
scd_us_is_70_or_more|15, 0x7fffu|BQ769X0_DIE, 50, 320, 100, 69, 2, 4
ov_s_is_1_or_more|15, 0x7fffu|BQ769X0_DIE, 50, 320, 100, 100, 0, 4
uv_s_is_1_or_more|15, 0x7fffu|BQ769X0_DIE, 50, 320, 100, 100, 2, 0
ocd_is_below_scd_in_one_range|15, 0x7fffu|BQ769X0_DIE, 60, 320, 40, 100, 2, 4
ocd_is_below_scd_in_one_range|15, 0x7fffu|BQ769X0_DIE, 100, 320, 95, 100, 2, 4
END
