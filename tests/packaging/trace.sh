#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Proves that tools/trace can turn red: a small tree that is right, then one that is wrong in one way at a time.
# usage: trace.sh TRACE SCRATCH
set -eu
trace=$1
tree=$2
failed=0

fresh() {
    rm -rf "$tree"
    mkdir -p "$tree/docs/requirements" "$tree/tests/unit/a" "$tree/tests/conformance/pl536_a"
    cat >"$tree/docs/requirements/list.md" <<'END'
Totals: 4 rows (PL-CRC 3, PL-HW 1).

| ID | Requirement |
|---|---|
| PL-CRC-01 | [SD] one |
| PL-CRC-02 | [D] two |
| PL-CRC-03 | no audience |
| PL-HW-01 | [HW] board |
END
    echo "X0-REG-0A | not a row" >>"$tree/docs/requirements/list.md"
    echo "PL-CRC-03 nobody can" >"$tree/docs/requirements/not-testable.txt"
    echo "bq_test(a SOURCES test_a.c)" >"$tree/tests/unit/a/CMakeLists.txt"
    printf 'foreach(x b)\n bq_test(${x} SOURCES test_${x}.c)\nendforeach()\n' >"$tree/tests/conformance/pl536_a/CMakeLists.txt"
    printf '/* proves: PL-CRC-01,\n * PL-CRC-02 */\nstatic void test_a(void)\n{\n}\nint main(void) { RUN_TEST(test_a); }\n' \
        >"$tree/tests/unit/a/test_a.c"
    printf '/* proves: PL-CRC-01 */\nstatic void test_b(void)\n{\n}\nint main(void) { RUN_TEST(test_b); }\n' \
        >"$tree/tests/conformance/pl536_a/test_b.c"
}

# expect STATUS PATTERN WHAT [ARGUMENT...]: trace ends with STATUS and prints a line that matches PATTERN
expect() {
    status=$1 pattern=$2 what=$3
    shift 3
    got=0
    out=$("$trace" --root "$tree" "$@" 2>&1) || got=$?
    if [ "$got" = "$status" ] && printf '%s\n' "$out" | grep -Eq -- "$pattern"; then
        echo "ok: $what"
    else
        echo "FAILED: $what: status $got instead of $status, or no line matches: $pattern"
        printf '%s\n' "$out"
        failed=1
    fi
}

fresh
expect 0 '^PL-CRC +3 +2 +0 +1 +1 +1 +1$' 'a sound tree is green, both sides of an [SD] row are told apart'
expect 0 '^PL-HW +1 +0 +0 +1 ' 'a board row is not testable here'
expect 0 'unit/a/test_a.c:1: test_a' 'the tests of a row are named' --where PL-CRC-01
rm "$tree/tests/conformance/pl536_a/test_b.c"
expect 1 '^PL-CRC-01 \[SD\] simulator side not proven' 'a row proven on one side only is listed' --list
expect 1 'error: PL-CRC-01 \[SD\] simulator side not proven' 'and an error'
echo "PL-CRC-01 simulator: it cannot" >>"$tree/docs/requirements/not-testable.txt"
expect 0 '^PL-CRC +3 +2 +0 +1 +1 +0 +1$' 'unless a line of reason excuses that side'
fresh
echo "PL-CRC-01 driver: it cannot" >>"$tree/docs/requirements/not-testable.txt"
expect 1 'proves PL-CRC-01, whose driver side' 'a side that is proven cannot be excused'
sed -i '/PL-CRC-01,/s/PL-CRC-01,//' "$tree/tests/unit/a/test_a.c"
expect 0 '^PL-CRC +3 +2 +0 +1 +1 +1 +0$' 'one that is not can'
echo "PL-CRC-01 driver: again" >>"$tree/docs/requirements/not-testable.txt"
expect 1 'PL-CRC-01 is listed twice' 'a side excused twice'
fresh
echo "PL-CRC-01 simulator:" >>"$tree/docs/requirements/not-testable.txt"
expect 1 'PL-CRC-01 has no reason' 'a side excused without a reason'
fresh
echo "PL-CRC-02 simulator: no" >>"$tree/docs/requirements/not-testable.txt"
expect 1 'PL-CRC-02 has one side only' 'a side of a row that has one'
fresh
mv "$tree/tests/conformance/pl536_a" "$tree/tests/conformance/x0_driver"
expect 1 '^PL-CRC-01 \[SD\] simulator side not proven' 'the tests of a driver are not the simulator side' --list
mv "$tree/tests/conformance/x0_driver" "$tree/tests/conformance/x0_sim_a"
expect 0 '^PL-CRC +3 +2 +0 +1 +1 +1 +1$' 'those of either model are'

fresh
sed -i 's/PL-CRC-02/PL-CRC-99/' "$tree/tests/unit/a/test_a.c"
expect 1 'unknown ID PL-CRC-99' 'an unknown ID in a test'
expect 1 '^PL-CRC-02 \[D\] not proven' 'the row it left is unproven' --list
expect 1 'error: PL-CRC-02 \[D\] not proven' 'and that is an error'

fresh
sed -i 's/PL-CRC-02/PL-CRC-03/' "$tree/tests/unit/a/test_a.c"
expect 1 'proves PL-CRC-03, which' 'a test that proves what is listed as not testable'

fresh
echo '| PL-CRC-02 | [D] again |' >>"$tree/docs/requirements/list.md"
expect 1 'PL-CRC-02 exists twice' 'a duplicate row'

fresh
sed -i '/PL-CRC-02 |/d' "$tree/docs/requirements/list.md"
expect 1 'says 4 rows, has 3' 'a lost row'

fresh
echo 'PL-CRC-02' >>"$tree/docs/requirements/not-testable.txt"
expect 1 'PL-CRC-02 has no reason' 'not testable without a reason'

fresh
echo 'PL-CRC-77 gone' >>"$tree/docs/requirements/not-testable.txt"
expect 1 'not-testable.txt:2: unknown ID PL-CRC-77' 'an unknown ID among the not testable'

fresh
echo '# bq_test(a SOURCES test_a.c)' >"$tree/tests/unit/a/CMakeLists.txt"
expect 1 'test_a.c: not compiled' 'a file that nobody compiles is named'
expect 1 '^PL-CRC-02 \[D\] not proven' 'and its claims do not count' --list

fresh
echo 'file(GLOB all test_*.c)' >"$tree/tests/unit/a/CMakeLists.txt"
expect 0 '^PL-CRC +3 +2 ' 'a file that a GLOB covers counts'
echo 'file(GLOB all other_*.c)' >"$tree/tests/unit/a/CMakeLists.txt"
expect 1 'test_a.c: not compiled' 'a file that no GLOB covers does not'

fresh
sed -i 's/RUN_TEST(test_a)/return 0/' "$tree/tests/unit/a/test_a.c"
expect 1 'test_a\(\) is never run' 'a test function that nobody runs'

fresh
sed -i 's/static void test_a(void)/static int x;/; s/RUN_TEST(test_a)/return 0/' "$tree/tests/unit/a/test_a.c"
expect 1 'no function follows' 'a claim that belongs to no test'

fresh
sed -i 's|^/[*] proves:|/* What it is about.\n * proves:|' "$tree/tests/unit/a/test_a.c"
expect 0 '^PL-CRC +3 +2 ' 'a claim may follow a sentence'

fresh
printf 'int a; /* proves: PL-CRC-02 */\n' >>"$tree/tests/unit/a/test_a.c"
expect 1 'must begin a line of a comment' 'a claim in the wrong place'

fresh
rm "$tree/docs/requirements/list.md"
expect 1 'no requirement rows|unknown ID' 'no rows at all'

fresh
ln -s nowhere "$tree/tests/unit/a/test_z.c"
expect 1 'could not be read to its end' 'a file that cannot be read'

rm -rf "$tree"
exit $failed
