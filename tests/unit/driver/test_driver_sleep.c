/* SPDX-License-Identifier: Apache-2.0 */
/* SLEEP entry and exit: PL-SEQ-11. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(3);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

void tearDown(void)
{
}

static void fall_asleep(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_sleep(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
}

static bq_status wake(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wake(&r.d));
    return rig_run(&r, 10);
}

/* proves: PL-SEQ-11-01, PL-SEQ-11-02, PL-SEQ-11-03, PL-SEQ-11-04, PL-SLEEP-04, PL-SLEEP-07, PL-SLEEP-11,
 * PL-SLEEP-12, PL-AMB-86, PL-AMB-90 */
static void everything_is_off_and_silent_in_sleep(void)
{
    bq_mask_set(r.action.balance, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    fall_asleep();
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&r.pl, n));
        TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&r.pl, n, 0x31) & 0xdf);
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x32));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x33));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x30) & 0x40);
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, n));
    }
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_apply(&r.d, &r.action));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_sleep(&r.d));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(0, r.cells[0].quality & BQ_Q_VALID);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-11-05, PL-SEQ-11-06, PL-SEQ-11-08, PL-SLEEP-09, PL-TIM-24, PL-SEQ-04-04 */
static void wakes_up_to_a_measuring_stack(void)
{
    fall_asleep();
    rig_advance_ms(&r, 60000);
    uint64_t t = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, wake());
    TEST_ASSERT_TRUE(sim_pl_now(&r.pl) - t >= 11 * SIM_PL_MS); /* reference and thermistors */
    (void)sim_pl_set_cell(&r.pl, 2, 2, 3.55);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3550, r.cells[7].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[7].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[0].quality);
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0x03, sim_pl_peek(&r.pl, n, 0x31) & 0xdf);
        TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, n, 0x30));
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    bq_mask_set(r.action.balance, 1); /* the timer is set again */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(1, sim_pl_cb(&r.pl, 1));
}

/* proves: PL-SEQ-11-07, PL-AMB-89 */
static void flags_from_before_sleep_are_still_there_afterwards(void)
{
    (void)sim_pl_set_cell(&r.pl, 2, 1, 4.3);
    rig_advance_ms(&r, 600);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    fall_asleep();
    (void)sim_pl_set_cell(&r.pl, 2, 1, 3.6);
    rig_advance_ms(&r, 1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, wake());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[1].faults);
}

/* proves: PL-SEQ-11-07 */
static void a_device_reset_in_sleep_is_configured_again(void)
{
    fall_asleep();
    (void)sim_pl_set_supply(&r.pl, 2, false);
    rig_advance_ms(&r, 10);
    (void)sim_pl_set_supply(&r.pl, 2, true);
    rig_advance_ms(&r, 100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, wake());
    rig_advance_ms(&r, 100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int i = 0; i < 18; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, n));
        TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, n, 0x42));
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

static int deaf_device;

static bool deaf(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (deaf_device != 0 && n == 4 && tx[0] == 0x7f && tx[1] == 0x31) {
        uint8_t other[4];
        memcpy(other, tx, 4);
        deaf_device = 0;
        return true; /* nobody hears the broadcast */
    }
    return false;
}

/* proves: PL-SEQ-11-02, PL-SEQ-11-03, PL-BCAST-05 */
static void a_lost_sleep_command_is_repeated_by_unicast(void)
{
    sim_pl_bus_fault(&r.pl)->hook = deaf;
    deaf_device = 1;
    fall_asleep();
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&r.pl, n));
    }
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    deaf_device = 1;
    TEST_ASSERT_EQUAL_INT(BQ_OK, wake());
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, n));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(everything_is_off_and_silent_in_sleep);
    RUN_TEST(wakes_up_to_a_measuring_stack);
    RUN_TEST(flags_from_before_sleep_are_still_there_afterwards);
    RUN_TEST(a_device_reset_in_sleep_is_configured_again);
    RUN_TEST(a_lost_sleep_command_is_repeated_by_unicast);
    return UNITY_END();
}
