#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# usage: afe_size.sh gate|canary AFE_SIZE_SH CC SCRATCH
set -eu
part=$1
tool=$2
scratch=$4
limit=2690 # bytes of the base set: what was reached

[ "$part" = canary ] || exec sh "$tool" $limit
command -v arm-none-eabi-gcc >/dev/null || { echo "SKIPPED: arm-none-eabi-gcc is needed"; exit 77; }

rm -rf "$scratch"
mkdir -p "$scratch/src/core" "$scratch/drivers/bq769x0" "$scratch/include" "$scratch/tools/bench"
echo 'int work(int n); int main(void); int main(void) { return work(3); }' >"$scratch/tools/bench/image_afe.c"

look() { # look CODE [LIMIT]: what the tool says about a driver of this one file
    echo "$1" >"$scratch/drivers/bq769x0/driver.c"
    AFE_ROOT=$scratch sh "$tool" "${2:-100}" 2>&1
}

red() { # red PROBLEM CODE [LIMIT]
    problem=$1
    shift
    got=0
    out=$(look "$@") || got=$?
    if [ "$got" = 1 ] && printf '%s\n' "$out" | grep -q "^$problem"; then
        echo "ok: $problem"
    else
        echo "FAILED ($got): $problem"
        printf '%s\n' "$out"
        exit 1
    fi
}

ten='extern volatile int port; int work(int n); volatile int *const at = (volatile int *)64;
int work(int n) { *at = n; *at = n + 1; *at = n + 2; return n; } int unused(int n); int unused(int n) { return n * 4711; }'
look "$ten" >/dev/null
echo "ok: small code is green, and what nobody calls does not count"
red 'base set: [0-9]* bytes, more than 3' "$ten" 3
red 'base set: writable data, 4 bytes' 'int work(int n); int work(int n) { static int sum; return sum += n; }'
red 'base set: writable data, 4 bytes' 'int work(int n); int work(int n) { static int sum = 5; return sum += n; }'
red 'base set: floating point: __aeabi_' 'int work(int n); int work(int n) { return (int)((float)n * 0.7f); }'
