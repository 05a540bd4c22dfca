#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The library for processors that no board of this tree has: every source without a warning, no floating point.
# usage: portable.sh ROOT SCRATCH CORE    CORE: rv32imac or cortex-m33
set -eu
root=$1
scratch=$2
core=$3
case $core in
rv32imac) prefix=riscv64-unknown-elf- flags="-march=rv32imac -mabi=ilp32 -ffreestanding -isystem $scratch" package=gcc-riscv64-unknown-elf ;;
cortex-m33) prefix=arm-none-eabi- flags="-mcpu=cortex-m33+nofp -mthumb -mfloat-abi=soft" package=gcc-arm-none-eabi ;;
*) echo "unknown core $core"; exit 2 ;;
esac
command -v "${prefix}gcc" >/dev/null || { echo "SKIPPED: no ${prefix}gcc (Debian: $package)"; exit 77; }

rm -rf "$scratch"
mkdir -p "$scratch"
# The RISC-V compiler comes without a C library: the library wants these declarations only.
cat >"$scratch/string.h" <<'END'
#include <stddef.h>
void *memcpy(void *restrict to, const void *restrict from, size_t n);
void *memmove(void *to, const void *from, size_t n);
void *memset(void *to, int value, size_t n);
int memcmp(const void *a, const void *b, size_t n);
size_t strlen(const char *s);
int strcmp(const char *a, const char *b);
int strncmp(const char *a, const char *b, size_t n);
END
cd "$root"
count=0
for source in $(find src drivers -name '*.c' | sort); do
    "${prefix}gcc" $flags -std=c99 -Os -Wall -Wextra -Wconversion -Wshadow -Wundef -Werror -DBQHOST_OTP=1 -Iinclude \
        -c "$source" -o "$scratch/$(echo "$source" | tr / _).o"
    count=$((count + 1))
done
"${prefix}nm" "$scratch"/*.o | awk '
    NF == 3 && $2 != "U" { defined[$3] }
    NF == 2 && $1 == "U" { wanted[$2] }
    END {
        for (name in wanted)
            if (!(name in defined) && name !~ /^(mem(cpy|move|set|cmp)|str(len|n?cmp)|__aeabi_u?l?i?div(mod)?|__aeabi_l(mul|asr|lsl|lsr)|__aeabi_u?lcmp|__u?(div|mod)di3|__(ashl|ashr|lshr)di3|__aeabi_mem[a-z0-9]+)$/) {
                print "needs " name
                bad = 1
            }
        exit bad
    }'
echo "$count sources for $core: $("${prefix}size" -t "$scratch"/*.o | awk 'END { print $1 " bytes of code and constants, data " $2 ", bss " $3 }')"
