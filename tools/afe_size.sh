#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What a linker keeps of the bq769x0 driver and its core on a Cortex-M0+: the base set (measuring, protecting, balancing) and
# everything, with the smallest possible board (tools/bench/image_afe.c). Counted are code and constants of src/ and
# drivers/; beside them what comes from the compiler's and the C library. The bitwise CRC is the smallest.
# usage: tools/afe_size.sh [LIMIT]         LIMIT: bytes the base set may take
# Exit status 1 if the base set takes more, or if any of both holds writable data or pulls in floating point; 77 without compiler.
set -eu
limit=${1:-}
root=$(cd "$(dirname "$0")/.." && pwd)
cross=arm-none-eabi-
flags="-Os -mcpu=cortex-m0plus -mthumb -std=c99 -ffunction-sections -fdata-sections -DBQHOST_CRC8=bitwise"
command -v ${cross}gcc >/dev/null || { echo "SKIPPED: ${cross}gcc is needed"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
status=0

# AFE_ROOT: another tree, for the proof that this turns red
cd "${AFE_ROOT:-$root}"
for source in $(find src/core drivers/bq769x0 -name '*.c' ! -name '*76pl536*'); do
    # shellcheck disable=SC2086
    ${cross}gcc $flags -Iinclude -c "$source" -o "$scratch/lib_$(basename "$source" .c).o"
done

look() { # look NAME [FLAG...]
    name=$1
    shift
    # shellcheck disable=SC2086
    ${cross}gcc $flags "$@" -Iinclude -c tools/bench/image_afe.c -o "$scratch/image.o"
    # shellcheck disable=SC2086
    ${cross}gcc $flags "$scratch"/*.o -nostartfiles --specs=nano.specs --specs=nosys.specs -Wl,--gc-sections \
        -Wl,-e,main -Wl,-Map="$scratch/map" -o "$scratch/image.elf"
    # sections as "NAME ADDRESS SIZE FILE", a long name on a line of its own; what was thrown away stands before the memory map
    bytes=$(awk '
        /^Linker script and memory map/ { kept = 1 }
        !kept { next }
        NF == 1 && /^ \./ { name = $1; next }
        /^ \./ { name = $1; size = $3; file = $4 }
        /^ +0x/ && NF == 3 && name != "" { size = $2; file = $3 }
        { if (name != "" && file != "") add() ; name = file = "" }
        function hex(s,   n, i) {
            n = 0
            for (i = 3; i <= length(s); i++) n = n * 16 + index("0123456789abcdef", substr(s, i, 1)) - 1
            return n
        }
        function add() {
            if (file !~ /\/lib_[^\/]*\.o$/) { if (file ~ /lib(gcc|c)[^\/]*\.a/ && name ~ /^\.(text|rodata)/) helpers += hex(size); return }
            if (name ~ /^\.(text|rodata)/) code += hex(size)
            if (name ~ /^\.(data|bss)|^COMMON/) ram += hex(size)
        }
        END { print code + 0, helpers + 0, ram + 0 }' "$scratch/map")
    # shellcheck disable=SC2086
    set -- $bytes
    echo "| $name | $1 | $2 |"
    [ "$3" = 0 ] || { echo "$name: writable data, $3 bytes" >&2; status=1; }
    floats=$(${cross}nm "$scratch/image.elf" | awk '$3 ~ /^__aeabi_([a-z]+2[a-z]+|[dfc]+(r?add|r?sub|mul|div|cmp[a-z]*|rcmple))$/ { print $3 }')
    [ -z "$floats" ] || { echo "$name: floating point: $floats" >&2; status=1; }
    code=$1
}

echo "| linked | driver and core | compiler's and C library |"
echo "|---|---|---|"
look "base set"
if [ -n "$limit" ] && [ "$code" -gt "$limit" ]; then
    echo "base set: $code bytes, more than $limit" >&2
    status=1
fi
look "complete driver" -DWHOLE
exit $status
