#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Proves that the sanitizers are armed: a defect kills the program and is named, the same program without one lives,
# and the code of the libraries is instrumented too (a flag on the link line alone would not do that).
# usage: sanitizer.sh SCRATCH CANARY LIBRARY...
set -eu
scratch=$1/sanitizer.log
canary=$2
shift 2
trap 'rm -f "$scratch"' EXIT

out=$("$canary" none)
[ "$out" = survived ] || { echo "FAILED: the sound run printed '$out'"; exit 1; }

killed() { # killed DEFECT REPORT
    if "$canary" "$1" >"$scratch" 2>&1 || grep -q survived "$scratch"; then
        echo "FAILED: the $1 defect survived"
        cat "$scratch"
        exit 1
    fi
    grep -q "$2" "$scratch" || { echo "FAILED: the $1 defect was not named"; cat "$scratch"; exit 1; }
    echo "ok: the $1 defect is fatal"
}
killed heap heap-buffer-overflow
killed signed 'signed integer overflow'

for library; do
    nm "$library" 2>/dev/null | grep -q ' U __asan_report_' || { echo "FAILED: $library without AddressSanitizer"; exit 1; }
    nm "$library" 2>/dev/null | grep -q ' U __ubsan_handle_' || { echo "FAILED: $library without UBSan"; exit 1; }
    echo "ok: ${library##*/} is instrumented"
done
