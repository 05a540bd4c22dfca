#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# usage: size.sh gate|canary SIZE_SH CC SCRATCH
set -eu
part=$1
tool=$2
cc=$3
scratch=$4

[ "$part" = canary ] || exec sh "$tool" "$cc" -Os

rm -rf "$scratch"
mkdir -p "$scratch/src/core" "$scratch/drivers/chip" "$scratch/include"
echo 'int two(void); int two(void) { return 2; }' >"$scratch/drivers/chip/two.c"

look() { # look CODE: what the tool says about a library with this file in it
    echo "$1" >"$scratch/src/core/canary.c"
    SIZE_ROOT=$scratch sh "$tool" "$cc" -O0 -fno-stack-protector 2>&1
}

red() { # red PROBLEM CODE
    got=0
    out=$(look "$2") || got=$?
    if [ "$got" = 1 ] && printf '%s\n' "$out" | grep -q "^$1"; then
        echo "ok: $1"
    else
        echo "FAILED ($got): $1"
        printf '%s\n' "$out"
        exit 1
    fi
}

red 'writable data' 'int counter = 1;'
red 'writable data' 'int counter;'
red 'writable data: shared' 'int shared __attribute__((common));'
red 'writable data' 'int next(void); int next(void) { static int n; return ++n; }'
red 'needs malloc' '#include <stdlib.h>
void *f(void); void *f(void) { return malloc(9); }'
red 'needs somewhere' 'int somewhere(void); int f(void); int f(void) { return somewhere(); }'
red 'floating point: __aeabi_dmul' 'int __aeabi_dmul(void); int f(void); int f(void) { return __aeabi_dmul(); }'
look 'int two(void); const int ten[2] = {10, 10}; int f(void); int f(void) { return two() + ten[1]; }'
echo "ok: constants and calls within the library are green"
