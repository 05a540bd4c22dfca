#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Code size of the library's objects, room by room, as a table in Markdown.
# usage: tools/size.sh [CC [FLAG...]]       default: cc -Os
# Exit status 1 if an object holds writable data or wants anything from outside but memory functions and compiler helpers.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
cc=${1:-cc}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- -Os
case $cc in *-gcc) tools=${cc%gcc} ;; *) tools= ;; esac
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# SIZE_ROOT: another tree, for the proof that this turns red
cd "${SIZE_ROOT:-$root}"
for source in $(find src drivers -name '*.c' ! -path 'drivers/template/*' | sort); do
    room=$(dirname "$source" | tr / _)
    mkdir -p "$scratch/$room"
    "$cc" "$@" -std=c99 -fno-pic -ffunction-sections -DBQHOST_OTP=1 -Iinclude -c "$source" -o "$scratch/$room/$(basename "$source" .c).o"
done

# flash, data and bss of all sections of some objects; .data.rel.ro does not exist without -fpic
sections() {
    "${tools}size" -A "$@" | awk '
        $1 ~ /^\.t?data/ { data += $2 } $1 ~ /^(\.t?bss|COMMON)/ { bss += $2 }
        $1 ~ /^\.(text|rodata)/ { flash += $2 }
        END { printf "%d | %d | %d", flash, data, bss }'
}

echo "| room | code and constants | data | bss |"
echo "|---|---|---|---|"
for room in "$scratch"/*; do
    echo "| $(basename "$room" | tr _ /) | $(sections "$room"/*.o) |"
done
echo "| all objects | $(sections "$scratch"/*/*.o) |"

breaches=$(
    sections "$scratch"/*/*.o | awk -F ' [|] ' '$2 + $3 != 0 { print "writable data" }'
    "${tools}nm" "$scratch"/*/*.o | awk '
        NF == 3 && $2 == "C" { print "writable data: " $3 }
        NF == 3 && $2 != "U" { defined[$3] }
        NF == 2 && $1 == "U" { wanted[$2] }
        END { for (name in wanted)
                  if (name ~ /^__aeabi_([a-z]+2[a-z]+|[dfc]+(r?add|r?sub|mul|div|cmp[a-z]*|rcmple))$/) print "floating point: " name
                  else if (!(name in defined) &&
                           name !~ /^(mem(cpy|move|set|cmp)|str(len|cmp)|__aeabi_[a-z0-9_]+|__gnu_thumb1_case_[a-z]+)$/)
                      print "needs " name }')
if [ -n "$breaches" ]; then
    printf '%s\n' "$breaches" >&2
    exit 1
fi
