#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Every test that docs/datasheet-notes.md names for a row exists and names that row. A wrong row must turn this red.
# usage: notes.sh ROOT
set -eu
cd "$1"

wrong_rows() { # wrong_rows FILE
    grep -E '^\| (PL|X0)-AMB-[0-9]+ ' "$1" | while IFS= read -r line; do
        id=$(printf '%s\n' "$line" | sed 's/^| \([A-Z0-9-]*\) .*/\1/')
        printf '%s\n' "$line" | grep -oE 'tests/[A-Za-z0-9_/]+\.c' | while read -r file; do
            grep -q "$id" "$file" 2>/dev/null || echo "$id: $file does not name it"
        done
    done
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo '| PL-AMB-01 | x | y | z | tests/unit/core/test_thermistor.c |' >"$scratch/wrong.md"
echo '| PL-AMB-02 | x | y | z | tests/unit/core/missing.c |' >>"$scratch/wrong.md"
[ "$(wrong_rows "$scratch/wrong.md" | wc -l)" -eq 2 ] || { echo "notes: the canary lives"; exit 1; }
[ "$(grep -cE '^\| PL-AMB-' docs/datasheet-notes.md)" -eq 111 ] || { echo "notes: rows are missing"; exit 1; }
bad=$(wrong_rows docs/datasheet-notes.md)
[ -z "$bad" ] || { printf '%s\n' "$bad"; exit 1; }
