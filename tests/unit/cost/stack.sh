#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# usage: stack.sh gate|canary STACK_PY CC SCRATCH
set -eu
part=$1
tool=$2
cc=$3
scratch=$4

command -v python3 >/dev/null || { echo "SKIPPED: python3 is needed"; exit 77; }
if [ "$part" = gate ]; then
    exec python3 "$tool" --cc "$cc" --limit 1024 --top 5
fi

mkdir -p "$scratch"
echo "$scratch call board" >"$scratch/targets"

# look CODE [OPTION...]: what the tool says about one source file
look() {
    echo "$1" >"$scratch/canary.c"
    shift
    python3 "$tool" --cc "$cc" --flags=-O0 --targets "$scratch/targets" "$@" "$scratch/canary.c"
}

red() { # red PROBLEM CODE [OPTION...]
    problem=$1
    shift
    got=0
    out=$(look "$@") || got=$?
    [ "$got" != 77 ] || { echo "$out"; exit 77; }
    if [ "$got" = 1 ] && [ "$(printf '%s\n' "$out" | grep -c "^PROBLEM")" = 1 ] &&
        printf '%s\n' "$out" | grep -q "^PROBLEM $problem"; then
        echo "ok: $problem"
    else
        echo "FAILED ($got): $problem"
        printf '%s\n' "$out"
        exit 1
    fi
}

red 'recursion: f -> f' 'int f(int n); int f(int n) { return n > 0 ? f(n - 1) : 0; }'
red 'recursion: . -> . -> .' 'int f(int n); static int g(int n) { return f(n) + 1; } int f(int n) { return n ? g(n - 1) : 0; }'
red 'frame of unknown size: f' 'int f(int n); int f(int n) { char a[n]; a[0] = 1; return a[n - 1]; }'
red 'undeclared call through a pointer: .*: other, in f' 'int f(int (*other)(void)); int f(int (*other)(void)) { return other(); }'
red 'not part of the library: malloc' '#include <stdlib.h>
void *f(void); void *f(void) { return malloc(4); }'
red 'deeper than 256 bytes: f' 'int f(int n); int f(int n) { volatile char a[1000]; a[0] = (char)n; return a[0]; }' --limit 256
echo "$scratch call f" >"$scratch/targets"
red 'recursion: f -> f' 'int f(int (*call)(void)); int f(int (*call)(void)) { return call(); }'
echo "$scratch call gone" >"$scratch/targets"
red 'target gone of .* does not exist' 'int f(int (*call)(void)); int f(int (*call)(void)) { return call(); }'
echo "$scratch call board" >"$scratch/targets"
look 'int f(int (*call)(void)); int f(int (*call)(void)) { return call(); }' --limit 256
echo "ok: what is declared and small is green"
