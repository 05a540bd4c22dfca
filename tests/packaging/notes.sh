#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# docs/datasheet-notes.md has a row for everything that the requirement lists found contradicted or open, of both chips; every test it names
# for a row exists and names that row. A wrong row must turn this red.
# usage: notes.sh ROOT
set -eu
cd "$1"

wrong_rows() { # wrong_rows FILE
    grep -E '^\| (PL|X0)-AMB-[0-9]+ ' "$1" | while IFS= read -r line; do
        id=$(printf '%s\n' "$line" | sed 's/^| \([A-Z0-9-]*\) .*/\1/')
        printf '%s\n' "$line" | grep -oE 'tests/[A-Za-z0-9_/]+\.c' | while read -r file; do
            grep -q "$id" "$file" 2>/dev/null || echo "$id: $file does not name it"
        done
        case $line in
        *tests/* | *'| not observable here |' | *'| none yet |') ;;
        *) echo "$id: no test, and no word why" ;;
        esac
    done
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo '| PL-AMB-01 | x | y | z | tests/unit/core/test_thermistor.c |' >"$scratch/wrong.md"
echo '| PL-AMB-02 | x | y | z | tests/unit/core/missing.c |' >>"$scratch/wrong.md"
echo '| X0-AMB-03 | x | y | z | the same |' >>"$scratch/wrong.md"
[ "$(wrong_rows "$scratch/wrong.md" | wc -l)" -eq 3 ] || { echo "notes: the canary lives"; exit 1; }
rows() { # rows FILE: the IDs of its rows
    grep -oE '^\| (PL|X0)-AMB-[0-9]+ ' "$1" | sort
}
for chip in bq769x0 bq76pl536; do
    rows "docs/requirements/$chip.md"
done | sort >"$scratch/known"
rows docs/datasheet-notes.md >"$scratch/noted"
diff "$scratch/known" "$scratch/noted" || { echo "notes: rows are missing or twice"; exit 1; }
bad=$(wrong_rows docs/datasheet-notes.md)
[ -z "$bad" ] || { printf '%s\n' "$bad"; exit 1; }
