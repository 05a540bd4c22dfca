#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# kill.sh turns red whenever a variant proves nothing. usage: canary.sh KILL SCRATCH
set -eu
kill=$1
scratch=$2
failed=0
mkdir -p "$scratch"

program() { # program NAME EXIT LINE...
    file=$scratch/$1
    code=$2
    shift 2
    { echo '#!/bin/sh'; for line; do echo "echo '$line'"; done; echo "exit $code"; } >"$file"
    chmod +x "$file"
}

expect() { # expect STATUS WHAT RIGHT WRONG
    sh "$kill" "$scratch/$3" "$scratch/$4" it >"$scratch/out" 2>&1 && got=0 || got=$?
    if [ "$got" = "$1" ]; then
        echo "ok: $2"
    else
        echo "FAILED: $2"
        cat "$scratch/out"
        failed=1
    fi
}

program right 0 't.c:1:it:PASS'
program red 1 't.c:1:it:FAIL: early'
program other 0 't.c:1:that:PASS'
program killed 1 't.c:1:it:FAIL: 3856' 'mutant acted 3 times'
program alive 0 't.c:1:it:PASS' 'mutant acted 3 times'
program idle 1 't.c:1:it:FAIL: something else'
program elsewhere 1 't.c:1:that:FAIL: 1' 'mutant acted 3 times'
program crashed 139 'mutant acted 3 times'
expect 0 'a variant that the test catches' right killed
expect 1 'a variant that survives' right alive
expect 1 'a variant that never made its mistake' right idle
expect 1 'a variant that another test catches' right elsewhere
expect 1 'a variant that only crashes' right crashed
expect 1 'a variant that was not built' right missing
expect 1 'a test that is red anyway' red killed
expect 1 'a test that does not exist' other killed
exit $failed
