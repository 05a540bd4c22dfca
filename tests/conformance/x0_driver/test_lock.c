/* SPDX-License-Identifier: Apache-2.0 */
/* The lock after five short circuits in a row: what ends it and what does not. */
#include "bench.h"
#include "unity.h"

#define PERIOD 250u

void setUp(void)
{
}

void tearDown(void)
{
}

static bool both_on(uint32_t ms)
{
    return bench_until_on(ms, PERIOD) < ms;
}

static void short_circuit(void)
{
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.2);
    (void)sim_x0_set_sense(&b.chip, 0);
    bench_serve(2 * PERIOD, PERIOD);
}

static void locked(void)
{
    bench_part("bq7692003", NULL);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    for (int n = 0; n < 6; n++) {
        TEST_ASSERT_TRUE(both_on(30000));
        short_circuit();
    }
    TEST_ASSERT_FALSE(both_on(60000));
    TEST_ASSERT_TRUE((b.module.faults & BQ_F_SHORT) != 0u);
}

/* Nobody intervened: the part is brought up again, which clears its own flags or not, and stays locked. */
/* proves: X0-SEQ-32 */
static void test_another_start_does_not_unlock(void)
{
    locked();
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_FALSE(both_on(60000));
    TEST_ASSERT_TRUE((b.module.faults & BQ_F_SHORT) != 0u);
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
    (void)bench_run(1000);
    TEST_ASSERT_EQUAL(BQ_OK, bench_start()); /* booted: nothing is flagged any more */
    TEST_ASSERT_FALSE(both_on(60000));
    bq769x0_unlock(&b.d);
    TEST_ASSERT_TRUE(both_on(30000));
    NO_MISUSE();
}

/* That of a pack controller whose request is off. */
/* proves: X0-SEQ-32 */
static void test_an_action_unlocks(void)
{
    locked();
    b.action.unlock = true;
    bench_serve(PERIOD, PERIOD);
    b.action.unlock = false;
    TEST_ASSERT_TRUE(both_on(30000));
    NO_MISUSE();
}

/* The load is looked for afterwards as before: unlocking alone turns nothing on. */
/* proves: X0-SEQ-32 */
static void test_unlocked_with_a_load_stays_off(void)
{
    locked();
    (void)sim_x0_set_chgpin(&b.chip, 3.0);
    bq769x0_unlock(&b.d);
    TEST_ASSERT_FALSE(both_on(30000));
    (void)sim_x0_set_chgpin(&b.chip, 0);
    TEST_ASSERT_TRUE(both_on(30000));
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_another_start_does_not_unlock);
    RUN_TEST(test_an_action_unlocks);
    RUN_TEST(test_unlocked_with_a_load_stays_off);
    return UNITY_END();
}
