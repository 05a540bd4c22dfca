#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# A test passes with the driver as it is and fails with a wrong variant of it, or it proves nothing.
# usage: kill.sh PROGRAM VARIANT TEST    the same test program, linked with the driver and with the variant
set -u
right=$1
wrong=$2
[ -x "$wrong" ] || { echo "mutant: $wrong was not built"; exit 1; }
UNITY_ONLY=$3
export UNITY_ONLY

out=$("$right" 2>&1) || { printf '%s\n' "$out"; echo "mutant: $UNITY_ONLY fails with the driver as it is"; exit 1; }
printf '%s\n' "$out" | grep -q ":$UNITY_ONLY:PASS$" || { echo "mutant: there is no test $UNITY_ONLY"; exit 1; }
out=$("$wrong" 2>&1) && got=0 || got=$?
printf '%s\n' "$out" | grep -q '^mutant acted [1-9]' || {
    printf '%s\n' "$out"
    echo "mutant: no longer applies (its mistake was never made)"
    exit 1
}
if [ "$got" = 0 ] || ! printf '%s\n' "$out" | grep -q ":$UNITY_ONLY:FAIL"; then
    printf '%s\n' "$out"
    echo "mutant: survives $UNITY_ONLY"
    exit 1
fi
echo "mutant: killed by"
printf '%s\n' "$out" | grep ":$UNITY_ONLY:FAIL"
