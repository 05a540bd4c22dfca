#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# What packsim does with its command line: exit status, the place of errors, table, repeatability.
# usage: cli.sh PACKSIM WORK_DIRECTORY
packsim=$1
scenarios=$(cd "$(dirname "$0")/../../../tools/packsim/scenarios" && pwd)
rm -rf "$2"
mkdir -p "$2" && cd "$2" || exit 1
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

good() {
    cat <<'END'
# a small pack
[pack]
monitor = bq76pl536
devices = 2
cells = 11
chemistry = lfp
soc_percent = 50
soc_spread_percent = 3
[limits]
cell_ov_mv = 3650
[run]
duration = 12 s
period = 100 ms
[load]
current_a = 1
request = on
[events]
6 s = cell 3 volts 3.3
[expect]
discovered 2 at 5 s
no faults
misuse none
END
}

# refused NAME SED-EXPRESSION LINE TEXT [OPTION...]: the changed scenario ends with 2, names its line, simulates nothing.
refused() {
    name=$1 expression=$2 line=$3 text=$4
    shift 4
    good | sed "$expression" >bad.ini
    rm -f never.csv
    "$packsim" bad.ini --csv never.csv "$@" >out 2>err
    status=$?
    [ $status -eq 2 ] || fail "$name: exit status $status"
    grep -q "^bad.ini:$line: .*$text" err || fail "$name: no 'bad.ini:$line: ...$text' in: $(cat err)"
    [ ! -s out ] || fail "$name: printed $(head -1 out)"
    [ ! -e never.csv ] || fail "$name: wrote a table"
}

# option_refused TEXT OPTION...: refused because of the command line.
option_refused() {
    text=$1
    shift
    rm -f never.csv
    "$packsim" "$@" >out 2>err
    status=$?
    [ $status -eq 2 ] || fail "$*: exit status $status"
    grep -q "^[^ ]*.*:[0-9]*: .*$text" err || fail "$*: no '$text' with a place in: $(cat err)"
    [ ! -s out ] || fail "$*: printed $(head -1 out)"
}

good >good.ini
"$packsim" good.ini --csv a.csv --quiet >out 2>err || fail "good scenario: exit status $?: $(cat out err)"
names=$(sed 's/:.*//' out | tr '\n' ';')
want="monitor;devices found;cells;simulated;scans;bus bytes per scan;bus errors;worst measurement error mv;spread start mv;"
want="${want}spread end mv;soc error percent;faults;state;misuse;speed;expectations;result;"
[ "$names" = "$want" ] || fail "summary is $names"
grep -q '^expectations: 3/3$' out || fail "expectations not counted"
grep -q '^result: pass$' out || fail "no pass"

header="time_s,state,current_a,pack_v,soc_percent,cell_min_mv,cell_max_mv,cell_min_true_mv,cell_max_true_mv,temp_max_c"
header="$header,balancing_cells,fault_count"
for i in 1 2 3 4 5 6 7 8 9 10 11; do header="$header,cell_${i}_mv"; done
[ "$(head -1 a.csv)" = "$header" ] || fail "table header $(head -1 a.csv)"
[ "$(wc -l <a.csv)" -eq 121 ] || fail "$(wc -l <a.csv) lines for 120 periods"
awk -F, 'NF != 23 { bad = 1 } END { exit bad }' a.csv || fail "a row has not 23 fields"
awk -F, 'NR == 2 && ($1 != "0.100" || $2 != "init" || $13 != "") { exit 1 }' a.csv || fail "first row"
awk -F, 'NR == 121 && ($1 != "12.000" || $2 != "on" || $3 != "1.000" || $15 < 3299 || $15 > 3301) { exit 1 }' a.csv ||
    fail "last row $(tail -1 a.csv)"

"$packsim" good.ini --csv b.csv --quiet >/dev/null && cmp -s a.csv b.csv || fail "the same run differs"
"$packsim" good.ini --csv b.csv --quiet --seed 1 >/dev/null && cmp -s a.csv b.csv || fail "seed 1 is not the default"
"$packsim" good.ini --csv b.csv --quiet --seed 99 >/dev/null && ! cmp -s a.csv b.csv || fail "another seed, the same table"
good | sed 's/^\[load\]/[load]\n/; s/^current_a.*//; /^6 s/a 7 s = spi flip 0.001' >noisy.ini
"$packsim" noisy.ini --csv c.csv --quiet >/dev/null
"$packsim" noisy.ini --csv d.csv --quiet >/dev/null
cmp -s c.csv d.csv || fail "random faults do not repeat"

# what the firmware sends on CAN, in the format of candump
"$packsim" good.ini --can can.log --quiet >out 2>err || fail "--can: exit status $?: $(cat out err)"
bad=$(grep -vcE '^\([0-9]{10}\.[0-9]{6}\) can0 10[0-9]#([0-9A-F]{2}){8}$' can.log)
[ "$bad" = 0 ] || fail "--can: $bad lines are none of candump"
head -1 can.log | grep -q '^(0000000000.000000) can0 109#0104' || fail "--can: no boot frame first: $(head -1 can.log)"
beats=$(grep -c ' 100#' can.log)
[ "$beats" -ge 119 ] && [ "$beats" -le 122 ] || fail "--can: $beats heartbeats in 12 s"
grep -q ' 100#033FFF00' can.log || fail "--can: no heartbeat of a pack that is on"
[ "$(grep ' 106#00' can.log | tail -1 | cut -d'#' -f2 | cut -c13-16)" = E40C ] || fail "--can: cell 3 is not at 3300 mV"
"$packsim" good.ini --can /dev/full --quiet >out 2>err
[ $? -eq 2 ] || fail "--can to a full disk: exit status $?"
grep -q '^/dev/full:0: cannot be written' err || fail "--can to a full disk: $(cat err)"

# the console from a pipe: each line when the one before it is answered, or at its time; then the summary
printf '@5s status\nbalance off\n@6s balance\n@7s reset\n@11s version' |
    "$packsim" good.ini --console >out 2>err || fail "--console: exit status $?: $(cat out err)"
for row in 'state     on for [0-9.]* s' 'uptime    5\.0 s' '> balance off' 'forbidden, cells that bleed: 0' \
    'outputs off, then reset' 'reset by  software, image 00000000 ok, stack left 0' 'result: pass'; do
    grep -q "^$row\$" out || fail "--console: no row '$row' in: $(cat out)"
done
[ "$(grep -c '^bqhost ' out)" = 3 ] || fail "--console: greeting at start and after the reset, version once"
grep -q "$(printf '\r')" out && fail "--console: carriage returns in a pipe"
"$packsim" good.ini --console </dev/null >out 2>err || fail "--console without input: exit status $?"
[ "$(tail -1 out)" = "result: pass" ] || fail "--console without input: ends with $(tail -1 out)"

# an expectation that cannot hold ends with 1 and says so
good | sed 's/^no faults/state fault at 10 s/' >failing.ini
"$packsim" failing.ini --quiet >out 2>err
status=$?
[ $status -eq 1 ] || fail "failing expectation: exit status $status"
grep -q '^failed: failing.ini:21: state fault at 10 s (state on)$' out || fail "failing expectation not named: $(head -1 out)"
grep -q '^result: fail$' out || fail "no result: fail"

refused 'unknown key' 's/^capacity.*//; s/^soc_percent/soc_per_cent/' 7 'unknown key soc_per_cent'
refused 'unknown section' 's/^\[load\]/[loads]/' 14 'unknown section \[loads\]'
refused 'unknown limit' 's/^cell_ov_mv/cell_ov_mw/' 10 'unknown key cell_ov_mw'
refused 'no unit' 's/^duration.*/duration = 12/' 12 'duration: 12 is not a time'
refused 'bad unit' 's/^duration.*/duration = 12 sec/' 12 'not a time'
refused 'bad unit in an event' 's/^6 s/6 sec/' 18 'not a time'
refused 'order of events' '/^6 s/a 5 s = mend' 19 'not in time order'
refused 'late event' 's/^6 s/13 s/' 18 'after the end'
refused 'unknown action' 's/^6 s.*/6 s = explode/' 18 'unknown action'
refused 'action of another chip' 's/^6 s.*/6 s = afe xready/' 18 'bq769x0'
refused 'cell out of range' 's/cell 3 volts/cell 12 volts/' 18 'cell 12 is not in 1..11'
refused 'unknown expectation' 's/^no faults/no worries/' 21 'expected: no fault'
refused 'unknown state' 's/^no faults/state asleep at 3 s/' 21 'unknown state asleep'
refused 'unknown fault' 's/^no faults/fault gone within 1 s of 2 s/' 21 'unknown fault gone'
refused 'late expectation' 's/5 s$/15 s/' 20 'beyond the end'
refused 'missing curve' 's/^chemistry.*/chemistry = nowhere.csv/' 6 'nowhere.csv'
refused 'missing current' 's/^current_a.*/file = nowhere.csv/' 15 'nowhere.csv'
refused 'two loads' 's/^current_a.*/current_a = 1\nfile = x.csv/' 16 'exclude each other'
refused 'stack keys with another monitor' 's/bq76pl536/bq7694003/' 4 'devices concerns a bq76pl536'
refused 'unknown size' 's/bq76pl536/bq769/' 3 'unknown part bq769'
refused 'unknown variant' 's/bq76pl536/bq7694004/' 3 'unknown part bq7694004'
refused 'base number alone' 's/bq76pl536/bq76940/' 3 'unknown part bq76940'
refused 'freeze of a stack' 's/^soc_percent.*/adc_freeze = 3 s/' 7 'adc_freeze concerns a bq769x0'
refused 'AFE limit for a stack' 's/^cell_ov_mv.*/ov_mv = 4200/' 10 'unknown key ov_mv'
refused 'unknown monitor' 's/bq76pl536/bq1/' 3 'unknown part'
refused 'too many cells' 's/^cells.*/cells = 13/' 5 'cannot be shared'
refused 'limit out of range' 's/^cell_ov_mv.*/cell_ov_mv = 9000/' 10 'cell_ov_mv'
refused 'contradicting limits' 's/^cell_ov_mv.*/cell_ov_mv = 3000/' 10 'cell_ov'
refused 'comparators too close' 's/^cell_ov_mv.*/cov_mv = 2200/' 10 'cov_mv'
refused 'unencodable threshold' 's/^cell_ov_mv.*/cov_mv = 3851/' 10 'cov_mv'
refused 'count in the limits' 's/^cell_ov_mv.*/cells = 11/' 10 'follows from \[pack\]'
refused 'unknown eprom' 's/^soc_percent.*/eprom = old/' 7 'neither blank nor fast'
refused 'request in between' 's/^request.*/request = maybe/' 16 'neither on nor off'
refused 'negative seed' 's/^period.*/seed = -1/' 13 'seed'
refused 'no duration' 's/^duration.*/duration = 0/' 12 'nothing to simulate'
refused 'no monitor' 's/^monitor.*//' 4 'no monitor'
refused 'expectation without a unit' 's/5 s$/5/' 20 'discovered K at T'
refused 'no key' 's/^soc_percent.*/= 4/' 7 'key'
refused 'no value' 's/^soc_percent.*/soc_percent =/' 7 'value'
refused 'no equals sign' 's/^soc_percent.*/soc_percent 50/' 7 'key = value'
refused 'given twice' 's/^soc_spread_percent.*/soc_percent = 3/' 8 'twice'
refused 'before a section' 's/^\[pack\]//' 3 'before the first'
refused 'bad period' 's/^period.*/period = 1500 us/' 13 'period'

# the same for a pack with a bq769x0
refused_afe() {
    name=$1 expression=$2 line=$3 text=$4
    good | sed 's/bq76pl536/bq7693003/; s/^devices.*/shunt_mohm = 5/; s/^cells.*/cells = 8/; s/^discovered 2/discovered 1/' >afe.ini
    sed "$expression" afe.ini >bad.ini
    "$packsim" afe.ini --quiet --duration 1s >out 2>err || fail "$name: the good one is refused: $(cat err)"
    rm -f never.csv
    "$packsim" bad.ini --csv never.csv >out 2>err
    status=$?
    [ $status -eq 2 ] || fail "$name: exit status $status"
    grep -q "^bad.ini:$line: .*$text" err || fail "$name: no 'bad.ini:$line: ...$text' in: $(cat err)"
    [ ! -s out ] || fail "$name: printed $(head -1 out)"
    [ ! -e never.csv ] || fail "$name: wrote a table"
}
for n in 1 5 11 15; do
    refused_afe "$n cells on a bq76930" "s/^cells.*/cells = $n/" 5 "$n cells cannot be connected to a bq7693003"
done
refused_afe 'cells on the smallest' 's/bq7693003/bq7692003/' 5 '8 cells cannot be connected to a bq7692003'
refused_afe 'cells on the largest' 's/bq7693003/bq7694006/' 5 '8 cells cannot be connected to a bq7694006'
refused_afe 'eprom' 's/^soc_percent.*/eprom = fast/' 7 'eprom concerns a bq76pl536'
refused_afe 'stack limit' 's/^cell_ov_mv.*/cov_mv = 3700/' 10 'unknown key cov_mv'
refused_afe 'shunt too large' 's/^shunt.*/shunt_mohm = 200/' 4 'shunt_mohm'
refused_afe 'overcurrent limit without a code' 's/^cell_ov_mv.*/ocd_ma = 500/' 10 'ocd_ma'
refused_afe 'recovery above the limit' 's/^cell_ov_mv.*/ov_recover_mv = 3800/' 10 'ov_recover_mv'
refused_afe 'short circuit below overcurrent' 's/^cell_ov_mv.*/ocd_ma = 20000\nscd_ma = 9000/' 1[01] '_ma'
refused_afe 'stack action' 's/^6 s.*/6 s = wire 2 open/' 18 'wire concerns a bq76pl536 stack'
refused_afe 'bus of the stack' 's/^6 s.*/6 s = spi flip 0.1/' 18 'spi concerns a bq76pl536 stack'
refused_afe 'no contactor' 's/^6 s.*/6 s = contactor weld/' 18 'contactor concerns a bq76pl536 stack'

option_refused 'No such file' nowhere.ini
option_refused 'unknown key nonsense' good.ini --set run.nonsense=1
option_refused 'unknown section' good.ini --set runs.seed=1
option_refused 'SECTION.KEY=VALUE' good.ini --set seed
option_refused 'cell_ov_mv' good.ini --set limits.cell_ov_mv=high
option_refused 'unknown option' good.ini --frobnicate
option_refused 'needs an argument' good.ini --csv
option_refused 'not a time' good.ini --duration 10
option_refused 'needs --image' good.ini --costs costs
option_refused 'not an address' good.ini --image none.bin --loop here
option_refused 'No such file' good.ini --image none.bin
option_refused 'no firmware' good.ini --image good.ini
printf '\000\040\000\040\001\001\000\010BQIM............lv-f072\0........' >other.bin
option_refused 'an image of lv-f072; this pack needs the board hv-f405' good.ini --image other.bin
option_refused 'not a whole number' good.ini --seed x
option_refused 'more than one' good.ini good.ini
option_refused 'no scenario' --quiet
option_refused 'No such file or directory' good.ini --can nowhere/can.log
option_refused 'not supported by protocol\|not permitted\|No such device' good.ini --can lo # an interface, but none of CAN
option_refused 'wants the terminal too' good.ini --console --watch
option_refused 'nowhere.csv' good.ini --current nowhere.csv
option_refused 'No such file' good.ini --csv nowhere/a.csv

# a shorter run leaves out what lies beyond; a longer one goes on
"$packsim" good.ini --duration 2s >out || fail "shortened run"
grep -q '^simulated: 2.000 s$' out || fail "shortened run: $(grep simulated out)"
grep -q '^left out: 1 ' out || fail "nothing left out"
"$packsim" good.ini --duration 20s --set load.current_a=-2 --csv e.csv --quiet >out || fail "longer run"
awk -F, 'END { exit $3 != "-2.000" }' e.csv || fail "--set without effect: $(tail -1 e.csv)"
printf 'time_s,current_a\n0,4\n1,4\n' >four.csv
"$packsim" good.ini --current four.csv --csv e.csv --quiet >out || fail "--current"
awk -F, 'END { exit $3 != "4.000" }' e.csv || fail "--current without effect: $(tail -1 e.csv)"

"$packsim" good.ini --duration 1s --vcd w.vcd --quiet >/dev/null || fail "--vcd"
grep -q '^\$enddefinitions' w.vcd || fail "no waveform"

"$packsim" good.ini --report r.html --watch --quiet >out 2>err || fail "--report --watch"
grep -q '^expectations: 3/3' r.html || fail "report without summary"
[ "$(grep -c '<svg' r.html)" -eq 8 ] || fail "report without its charts"
grep -q 'class="cell" d="M' r.html || fail "report without cell voltages"
grep -q 'event: cell 3 volts 3.3' r.html || fail "report without events"
! grep -q 'http' r.html || fail "report needs a network"
grep -q '12.0 s  on  outputs on  devices 2' err || fail "no live view"
[ "$(tail -1 out)" = 'result: pass' ] || fail "--watch disturbs the summary"

"$packsim" --list >out || fail "--list"
for scenario in "$scenarios"/*.ini; do
    name=$(basename "$scenario" .ini)
    grep -q "^$name  *[A-Z0-9]" out || fail "$name is not listed with a description"
done
(cd / && "$packsim" cell-overvoltage --quiet) >out || fail "a scenario by its bare name"
"$packsim" --help | grep -q cell_ov_mv || fail "--help names no limits"

[ $failures -eq 0 ] && echo "packsim command line: ok"
[ $failures -eq 0 ]
