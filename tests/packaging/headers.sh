#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Every public header compiles alone as C99, C11, C17 and, with a C++ compiler, as C++11 and C++17, without a warning.
# A header NAME_state.h is the second half of NAME.h (which must include it) and is not meant to stand alone.
# usage: headers.sh ROOT SCRATCH CC [CXX]
set -eu
root=$1
scratch=$2
cc=$3
cxx=${4:-}
rm -rf "$scratch"
mkdir -p "$scratch"
warnings='-Wall -Wextra -Wconversion -Wshadow -Wundef -pedantic -Werror'
count=0

# try COMPILER STANDARD SUFFIX INCLUDE_DIR HEADER
try() {
    unit=$scratch/unit.$3
    printf '#include "bqhost/%s"\n#include "bqhost/%s"\nint unit(void);\nint unit(void) { return 0; }\n' "$5" "$5" >"$unit"
    # shellcheck disable=SC2086
    "$1" "-std=$2" $warnings -I "$4" -c "$unit" -o "$scratch/unit.o"
}

# canary: a header that leans on another one, and one with a warning, are refused
mkdir -p "$scratch/bad/bqhost"
echo 'uint8_t needs_stdint(void);' >"$scratch/bad/bqhost/leans.h"
printf '#ifndef W_H\n#define W_H\nstatic inline unsigned char w(int v) { return v; }\n#endif\n' >"$scratch/bad/bqhost/warns.h"
for bad in leans.h warns.h; do
    if try "$cc" c99 c "$scratch/bad" $bad >/dev/null 2>&1; then
        echo "FAILED: $bad was accepted"
        exit 1
    fi
done

for path in "$root"/include/bqhost/*.h; do
    header=${path##*/}
    whole=${header%_state.h}.h
    if [ "$whole" != "$header.h" ] && grep -q "^#include \"bqhost/$header\"" "$root/include/bqhost/$whole"; then
        continue
    fi
    for std in c99 c11 c17; do
        try "$cc" $std c "$root/include" "$header" || { echo "FAILED: $header as $std"; exit 1; }
        count=$((count + 1))
    done
    [ -n "$cxx" ] || continue
    for std in c++11 c++17; do
        try "$cxx" $std cpp "$root/include" "$header" || { echo "FAILED: $header as $std"; exit 1; }
        count=$((count + 1))
    done
done
echo "$count compilations"
[ -n "$cxx" ] || { echo "SKIPPED: the C++ half, no C++ compiler found"; exit 77; }
