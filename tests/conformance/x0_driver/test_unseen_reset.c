/* SPDX-License-Identifier: Apache-2.0 */
/* A reset that the scrub has not seen yet: no FET comes on without its limits. */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* proves: X0-SEQ-05, X0-OCD-10, X0-SEQ-20 */
static void test_no_fet_comes_on_after_an_unseen_reset(void)
{
    int k, ms;
    for (k = 0; k < 15; k++)
        for (ms = 0; ms < 1000; ms += 90) {
            bench_up(sim_x0_part_at(k)->name);
            b.action.charge_on = b.action.discharge_on = false;
            bench_serve(3000, 250);
            bench_wait(ms);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            (void)sim_x0_set_supply(&b.chip, false);
            (void)sim_x0_set_supply(&b.chip, true);
            (void)sim_x0_boot(&b.chip, 3 * MS);
            bench_wait(12);
            (void)bench_apply(true, true, 0); /* the host does not know yet */
            if (sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip)) {
                TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->current.protect2, sim_x0_peek(&b.chip, 7));
                TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 9));
            }
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_fet_comes_on_after_an_unseen_reset);
    return UNITY_END();
}
