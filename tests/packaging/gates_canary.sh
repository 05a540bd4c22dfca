#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Proves that every gate of gates.sh can turn red: a small sound tree first, then one breach at a time.
# usage: gates_canary.sh GATES SCRATCH
set -eu
gates=$1
tree=$2
failed=0
spdx='/* SPDX-License-Identifier: Apache-2.0 */'

fresh() {
    rm -rf "$tree"
    for d in include/bqhost src/core src/pack src/app drivers/bq76pl536 hal/sim hal/template sim tests/unit tools tools/emulator \
        hal/stm32 hal/stm32f0 hal/stm32f4 hal/boards/b; do
        mkdir -p "$tree/$d"
    done
    put include/bqhost/crc.h '/* a free-running double buffer */' '#include <stdint.h>'
    put src/core/crc.c '#include "bqhost/crc.h"' '#include "core.h"' 'static int code = 0x1e3; // float' 'const char *s = "malloc";'
    put src/core/core.h ''
    put src/pack/pack.c '#include "bqhost/pack.h"'
    put src/app/app.c '#include "bqhost/afe.h"'
    put drivers/bq76pl536/d.c '#include "bqhost/afe.h"' '#include <string.h>'
    put hal/sim/hal_sim.c '#include "bqhost/hal.h"' '#include "sim_chip.h"' 'double volts = 1.5;'
    put hal/template/t.c '#include "bqhost/hal.h"' '#include <my_registers.h>'
    put hal/stm32/stm32_time.h ''
    put hal/stm32/stm32_time.c '#include "bqhost/hal.h"' '#include "stm32_chip.h"'
    put hal/stm32f0/stm32_chip.h '#include "stm32_time.h"'
    put hal/stm32f4/stm32f4_spi.h ''
    put hal/boards/b/main.c '#include "bqhost/bq76pl536.h"' '#include "stm32_time.h"' '#include "stm32f4_spi.h"'
    put hal/boards/b/board.h '#include "board_main.h"'
    put hal/boards/board_main.h ''
    put hal/boards/board_main.c '#include "bqhost/firmware.h"' '#include "board.h"' '#include "pins.h"'
    put sim/sim_chip.h '#include <math.h>'
    put sim/sim_chip.c '#include "sim_chip.h"'
    put tests/unit/t.c 'TEST_ASSERT_EQUAL(1, 1);' '/* TEST_ASSERT_SAME */'
    put tools/t.c '#include "sim_chip.h"'
    put tools/emulator/emu.h '#include "sim_misuse.h"'
    put tools/emulator/emu.c '#include "emu.h"' '#include <unicorn/unicorn.h>'
    echo 'See [the tool](tools/t.c#top) and [the web](https://example.com).' >"$tree/README.md"
}

put() { # put FILE LINE...: a source file with an SPDX line and these lines
    file=$tree/$1
    shift
    { echo "$spdx"; printf '%s\n' "$@"; } >"$file"
}

# red GATE WHERE WHAT: exactly this gate is broken, at this place
red() {
    out=$(sh "$gates" "$tree" 2>&1) && got=0 || got=$?
    broken=$(printf '%s\n' "$out" | sed -n 's/^gate \(.*\): broken$/\1/p')
    if [ "$got" = 1 ] && [ "$broken" = "$1" ] && printf '%s\n' "$out" | grep -q "^$2:"; then
        echo "ok: $3"
    else
        echo "FAILED: $3"
        printf '%s\n' "$out"
        failed=1
    fi
    fresh
}

fresh
if sh "$gates" "$tree" >"$tree.log" 2>&1; then
    echo "ok: a sound tree is green"
else
    echo "FAILED: a sound tree is red"
    cat "$tree.log"
    failed=1
fi
rm -f "$tree.log"

put src/core/crc.c 'int a;' 'float x;';                     red words src/core/crc.c:3 'float in the library'
put src/core/crc.c '/* a' ' */ int x = 15e3;';              red words src/core/crc.c:3 'a floating constant'
put drivers/bq76pl536/d.c 'int *p = malloc(4);';            red words drivers/bq76pl536/d.c:2 'heap in a driver'
put hal/template/t.c 'double x;';                           red words hal/template/t.c:2 'double in a back-end'
put include/bqhost/crc.h 'void free(void *);';              red words include/bqhost/crc.h:2 'heap in a public header'
put sim/sim_chip.c '#include "bqhost/crc.h"';               red arrows sim/sim_chip.c:2 'the simulator includes a public header'
put sim/sim_chip.c '#include <bqhost/crc.h>';               red arrows sim/sim_chip.c:2 'the same in angle brackets'
put sim/sim_chip.c '#include "../src/core/core.h"';         red arrows sim/sim_chip.c:2 'the simulator climbs out'
put tools/emulator/emu.c '#include "stm32_chip.h"';        red arrows tools/emulator/emu.c:2 'the emulator knows a back-end'
put tools/emulator/emu.c '#include "bqhost/crc.h"';        red arrows tools/emulator/emu.c:2 'the emulator includes a public header'
put src/core/crc.c '#include "sim_chip.h"';                 red arrows src/core/crc.c:2 'the library includes the simulator'
put src/core/crc.c '#include "bqhost/hal.h"';               red arrows src/core/crc.c:2 'the core knows the board'
put src/core/crc.c '#include <stdio.h>';                    red arrows src/core/crc.c:2 'the library wants a big C library'
put drivers/bq76pl536/d.c '#include "bqhost/pack.h"';       red arrows drivers/bq76pl536/d.c:2 'a driver knows the pack'
put src/pack/pack.c '#include "bqhost/bq76pl536.h"';        red arrows src/pack/pack.c:2 'the pack knows a chip'
put src/app/app.c '#include "bqhost/bq76pl536.h"';          red arrows src/app/app.c:2 'the loop knows a chip'
put hal/template/t.c '#include "bqhost/afe.h"';             red arrows hal/template/t.c:2 'a back-end knows a driver'
put hal/template/t.c '#include "sim_chip.h"';               red arrows hal/template/t.c:2 'the template knows the simulator'
put hal/stm32/stm32_time.c '#include "bqhost/app.h"';        red arrows hal/stm32/stm32_time.c:2 'a microcontroller back-end knows the loop'
put hal/stm32/stm32_time.c '#include "stm32f4_spi.h"';      red arrows hal/stm32/stm32_time.c:2 'the common half knows one family'
put hal/stm32f0/stm32_chip.h '#include "stm32f4_spi.h"';    red arrows hal/stm32f0/stm32_chip.h:2 'one family knows the other'
put hal/stm32f0/stm32_chip.h 'int x = 2 * (float)1;';       red words hal/stm32f0/stm32_chip.h:2 'float in a microcontroller back-end'
put hal/boards/b/main.c '#include "sim_chip.h"';            red arrows hal/boards/b/main.c:2 'a board knows the simulator'
put hal/boards/board_main.c '#include "config.h"';          red arrows hal/boards/board_main.c:2 'all boards know one of them'
echo 'MEMORY {}' >"$tree/hal/boards/b/link.ld";             red spdx hal/boards/b/link.ld:1 'no licence line in a linker script'
awk 'BEGIN { print "/* SPDX-License-Identifier: Apache-2.0 */"; for (i = 0; i < 500; i++) print "" }' >"$tree/tools/t.c"
red length tools/t.c:501 'a file of 501 lines'
echo 'int x;' >"$tree/sim/sim_chip.c";                      red spdx sim/sim_chip.c:1 'no licence line'
echo 'add_library(x)' >"$tree/sim/CMakeLists.txt";          red spdx sim/CMakeLists.txt:1 'no licence line in a build file'
put tools/t.c '/* TO''DO: later */';                        red unfinished tools/t.c:2 'something left for later'
put tests/unit/t.c 'TEST_ASSERT_SAME(1, 1);';               red unity tests/unit/t.c:2 'a macro that Unity does not have'

echo '[gone](docs/gone.md)' >"$tree/README.md";            red links README.md:1 'a link to nothing'

rm -rf "$tree"
exit $failed
