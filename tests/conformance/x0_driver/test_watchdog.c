/* SPDX-License-Identifier: Apache-2.0 */
/* Scans that bring no good picture for a second end with both FETs off and a word about it. */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* proves: X0-SEQ-25 */
static void test_no_good_picture_for_a_second(void)
{
    int k, n;
    for (k = 0; k < 15; k++) {
        uint64_t from;
        bench_up(sim_x0_part_at(k)->name);
        bench_serve(3000, 250);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        sim_x0_freeze(&b.chip, true);
        b.chip.reg[0x2a] ^= 0x10; /* the stack code contradicts the cells from now on */
        from = b.chip.now;
        for (n = 0; n < 3; n++) { /* for less than a second nothing happens */
            (void)bench_scan();
            TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
            TEST_ASSERT_TRUE(sim_x0_dsg(&b.chip));
            bench_wait(230);
        }
        while (sim_x0_dsg(&b.chip) && b.chip.now < from + 4000 * MS) {
            (void)bench_scan();
            bench_wait(230);
        }
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
        TEST_ASSERT_TRUE(b.chip.now - from < 1700 * MS);
        TEST_ASSERT_TRUE(b.module.faults != 0);
        sim_x0_freeze(&b.chip, false);
        bench_wait(300);
        TEST_ASSERT_TRUE(bench_until(true, true, 10000) < 10000);
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_good_picture_for_a_second);
    return UNITY_END();
}
