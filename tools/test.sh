#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds everything and runs every test: the debug suite, the firmware images in the emulator (optimised, for speed), the
# suite under AddressSanitizer and UndefinedBehaviorSanitizer, a clang build with all warnings as errors, the requirement
# trace. Installs what is missing when it may; what needs a tool that is not there is skipped, and said.
#   tools/test.sh [--quick]     --quick: nothing is installed but what is needed, and only debug suite and trace
# Works from any directory, writes only into build/ of the tree. The last line is "N passed, N failed".
set -u
quick=0
case ${1:-} in
'') ;;
--quick) quick=1 ;;
*) sed -n '3,9s/^# \{0,1\}//p' "$0"; [ "$1" = --help ] && exit 0 || exit 2 ;;
esac
. "$(dirname "${BASH_SOURCE[0]}")/needs.sh"
need_tools
[ $quick = 1 ] || want_tools

passed=0
failed=0
skipped=()
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }
count() { if [ "$1" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi; }
skip() { skipped+=("$*"); echo "SKIPPED: $*"; }

# build NAME ARGUMENT...: one build counts as one check
build() {
    say "build $1"
    build_preset "$@"
    local status=$?
    count $status
    [ $status = 0 ] && echo "built" || echo "BUILD FAILED: $1"
    return $status
}

# suite PRESET [CTEST_OPTION...]: every test of a build, counted one by one
suite() {
    say "tests $1"
    local log=$TMPDIR/ctest-$1.log
    ctest --test-dir "$root/build/$1" -j "$jobs" --output-on-failure --no-tests=error "${@:2}" 2>&1 | tee "$log" | grep -v -e '^ *Start ' -e ' Passed '
    # "100% tests passed, 0 tests failed out of 12"; a suite that did not get so far is one failure
    local line bad all why
    line=$(grep -E '^[0-9]+% tests passed' "$log") || { failed=$((failed + 1)); return; }
    bad=$(sed -E 's/.* ([0-9]+) tests failed.*/\1/' <<<"$line")
    all=$(sed -E 's/.*out of ([0-9]+).*/\1/' <<<"$line")
    passed=$((passed + all - bad))
    failed=$((failed + bad))
    while read -r name; do
        passed=$((passed - 1))
        why=$(awk -v test="Testing: $name" 'substr($0, length($0) - length(test) + 1) == test { on = 1 }
            on && sub(/^SKIPPED: /, "") { print; exit }' "$root/build/$1/Testing/Temporary/LastTest.log")
        skip "$name in $1: ${why:-see build/$1/Testing/Temporary/LastTest.log}"
    done < <(sed -nE 's/.*Test +#[0-9]+: ([^ ]+) .*\*\*\*Skipped.*/\1/p' "$log")
}

build dev && suite dev -LE firmware

if [ $quick = 1 ]; then
    skip "images, sanitizers and clang: --quick"
else
    build release && suite release -L firmware
    if echo 'int main(void) { return 0; }' | gcc -x c - -fsanitize=address,undefined -o "$TMPDIR/sanitizers" 2>/dev/null &&
        "$TMPDIR/sanitizers" 2>/dev/null; then
        build asan && suite asan -LE firmware
    else
        skip "AddressSanitizer and UBSan: gcc's sanitizer libraries are missing or do not run here"
    fi
    if have clang-19; then
        build clang -DCMAKE_C_COMPILER=clang-19
    elif have clang; then
        build clang
    else
        skip "clang build: clang is not installed"
    fi
fi

say "requirement trace"
"$root/tools/trace" check
count $?

echo
for text in ${skipped[@]+"${skipped[@]}"}; do echo "skipped: $text"; done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
