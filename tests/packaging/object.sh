#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What the compiled library holds: no writable data of its own, and nothing from outside but a few memory functions
# (so no heap, no floating-point helper, no printf).
# usage: object.sh LIBRARY CC SCRATCH
set -eu
library=$1
cc=$2
scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"

# check ARCHIVE: prints every breach
check() {
    # .data.rel.ro holds constants with addresses in them, which a position-independent program must relocate once
    size -A "$1" | awk '$1 ~ /^\.t?(data|bss)/ && $1 !~ /^\.data\.rel\.ro/ && $2 != 0 { print "writable data: " $1 " " $2 }'
    nm "$1" | awk '
        NF == 3 && $2 ~ /[TtRrDdBbWVC]/ { defined[$3] }
        NF == 3 && $2 == "C" { print "writable data: common " $3 }
        NF == 2 && $1 == "U" { wanted[$2] }
        END {
            for (name in wanted)
                if (!(name in defined) && name !~ /^(memcpy|memmove|memset|memcmp|strlen|strcmp|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_)$/)
                    print "needs " name
        }'
}

canary() { # canary PATTERN CODE: an archive of CODE is refused
    echo "$2" >"$scratch/canary.c"
    "$cc" -c -O0 "$scratch/canary.c" -o "$scratch/canary.o"
    rm -f "$scratch/canary.a"
    ar rc "$scratch/canary.a" "$scratch/canary.o"
    if check "$scratch/canary.a" | grep -q "$1"; then
        echo "ok: refuses $1"
    else
        echo "FAILED: does not notice: $2"
        exit 1
    fi
}

canary 'writable data: .data 4' 'int counter = 1;'
canary 'writable data: common' 'int counter __attribute__((common));'
canary 'writable data: .bss 4' 'int next(void); int next(void) { static int n; return ++n; }'
canary 'needs malloc' 'void *malloc(unsigned long); void *f(void); void *f(void) { return malloc(9); }'

breaches=$(check "$library")
if [ -n "$breaches" ]; then
    printf '%s\n' "$breaches"
    exit 1
fi
echo "no writable data; nothing from outside but memory functions"
