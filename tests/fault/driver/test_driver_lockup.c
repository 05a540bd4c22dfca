/* SPDX-License-Identifier: Apache-2.0 */
/* ADC lock-up: PL-SEQ-05. The lock-up itself is somebody else's doing here; the driver must never cause it.
 */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;
static int unicast_resets, broadcast_resets;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (n == 4 && (tx[0] & 1) == 1 && tx[1] == 0x3c) {
        unicast_resets += tx[0] != 0x7f;
        broadcast_resets += tx[0] == 0x7f;
    }
    return false;
}

void setUp(void)
{
    c = rig_config(4);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    unicast_resets = 0;
    broadcast_resets = 0;
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

void tearDown(void)
{
}

static void lock_up(uint8_t device)
{
    rig_poke(&r, device, 0x30, 0x3d); /* ADC_ON off behind the driver's back, ADCT still 6 us */
}

/* proves: PL-SEQ-05-01, PL-SEQ-05-02, PL-SEQ-05-05, PL-SEQ-06-06, PL-AMB-66, PL-AMB-93 */
static void one_device_is_reset_and_taken_back_in(void)
{
    for (uint8_t k = 1; k <= 4; k++) {
        setUp();
        lock_up(k);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_INT(1, unicast_resets);
        TEST_ASSERT_EQUAL_INT(0, broadcast_resets);
        TEST_ASSERT_TRUE((r.modules[k - 1].faults & BQ_F_LOCKUP) != 0);
        TEST_ASSERT_EQUAL_HEX8(0, r.cells[6 * (k - 1)].quality & BQ_Q_VALID);
        for (int n = 1; n <= 4; n++) {
            TEST_ASSERT_TRUE(n == k || (r.cells[6 * (n - 1)].quality & BQ_Q_VALID) != 0);
        }
        rig_advance_ms(&r, 100);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        for (int n = 1; n <= 4; n++) {
            TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, n));
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * (n - 1)].quality);
            TEST_ASSERT_EQUAL_HEX16(0, r.modules[n - 1].faults);
            TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, n, 0x30));
        }
    }
}

/* proves: PL-SEQ-05-03 */
static void several_devices_take_the_full_discovery(void)
{
    lock_up(2);
    lock_up(3);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_INT(0, unicast_resets);
    TEST_ASSERT_EQUAL_INT(4, broadcast_resets);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int n = 1; n <= 4; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, n));
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * (n - 1)].quality);
    }
}

/* proves: PL-SEQ-07-03, PL-SEQ-05-01 */
static void the_pin_is_lowered_when_drdy_never_rises(void)
{
    c.use_conv_pin = true;
    rig_up(&r, &c, NULL);
    lock_up(2);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_FALSE(sim_pl_conv(&r.pl));
    rig_advance_ms(&r, 100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int i = 0; i < 24; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_device_is_reset_and_taken_back_in);
    RUN_TEST(several_devices_take_the_full_discovery);
    RUN_TEST(the_pin_is_lowered_when_drdy_never_rises);
    return UNITY_END();
}
