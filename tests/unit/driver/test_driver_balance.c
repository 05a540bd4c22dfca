/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing with measurement pauses: PL-SEQ-10. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

static struct spy {
    int nonzero_to_nonzero, time_while_on, high_bits;
    int on_at_start;    /* outputs on when a conversion started */
    uint64_t off_ns;    /* last CB_CTRL = 0 broadcast */
    uint64_t settle_ns; /* from there to the start */
} spy;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (n != 4 || (tx[0] & 1) == 0) {
        return false;
    }
    int device = tx[0] >> 1;
    if (tx[1] == 0x32) {
        spy.high_bits += (tx[2] & 0xc0) != 0;
        if (device != 0x3f && tx[2] != 0 && sim_pl_peek(&r.pl, device, 0x32) != 0) {
            spy.nonzero_to_nonzero++;
        }
        if (tx[2] == 0) {
            spy.off_ns = sim_pl_now(&r.pl);
        }
    }
    if (tx[1] == 0x33 && sim_pl_peek(&r.pl, device, 0x32) != 0) {
        spy.time_while_on++;
    }
    if (tx[1] == 0x34) {
        spy.settle_ns = sim_pl_now(&r.pl) - spy.off_ns;
        for (int k = 1; k <= c.devices; k++) {
            spy.on_at_start += sim_pl_cb(&r.pl, k) != 0;
        }
    }
    return false;
}

void setUp(void)
{
    c = rig_config(3);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    memset(&spy, 0, sizeof spy);
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

void tearDown(void)
{
}

/* proves: PL-SEQ-10-01, PL-SEQ-10-02, PL-SEQ-10-03, PL-CB-13, PL-NUM-32, PL-AMB-82, PL-AMB-85, PL-AMB-88 */
static void the_mask_reaches_the_outputs_with_the_timer_set(void)
{
    bq_mask_set(r.action.balance, 2);
    bq_mask_set(r.action.balance, 5);
    bq_mask_set(r.action.balance, 7);
    bq_mask_set(r.action.balance, 18);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x12, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 2));
    TEST_ASSERT_EQUAL_HEX8(0x20, sim_pl_cb(&r.pl, 3));
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&r.pl, 1, 0x33)); /* 4 s by default */
    TEST_ASSERT_EQUAL_INT(0, spy.time_while_on);
    TEST_ASSERT_EQUAL_INT(0, spy.high_bits);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-10-04, PL-SEQ-10-05, PL-CB-15, PL-CB-14, PL-ADC-22, PL-AMB-83 */
static void outputs_pause_for_every_measurement_and_restart_from_zero(void)
{
    bq_mask_set(r.action.balance, 3);
    bq_mask_set(r.action.balance, 13);
    for (int i = 0; i < 30; i++) { /* longer than the timer: only restarts keep it going */
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
        TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_cb(&r.pl, 1));
        TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 3));
        rig_advance_ms(&r, 500);
        uint64_t packets = r.hal.transfers;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        TEST_ASSERT_EQUAL_UINT(1 + 1 + 3, r.hal.transfers - packets);
        rig_sample(&r);
        TEST_ASSERT_EQUAL_HEX16(0x04, r.modules[0].balancing);
        TEST_ASSERT_EQUAL_HEX16(0x00, r.modules[1].balancing);
        TEST_ASSERT_EQUAL_HEX16(0x01, r.modules[2].balancing);
        TEST_ASSERT_TRUE(spy.settle_ns >= 10 * SIM_PL_MS);
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    }
    TEST_ASSERT_EQUAL_INT(0, spy.on_at_start);
    TEST_ASSERT_EQUAL_INT(0, spy.nonzero_to_nonzero);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-10-05, PL-AMB-83 */
static void a_new_mask_without_a_scan_in_between_also_starts_from_zero(void)
{
    bq_mask_set(r.action.balance, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 3500);
    bq_mask_set(r.action.balance, 2);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 3500);
    TEST_ASSERT_EQUAL_HEX8(0x03, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_INT(0, spy.nonzero_to_nonzero);
}

/* proves: PL-SEQ-10-06, PL-AMB-84, PL-CB-14 */
static void an_expired_timer_is_not_reported_as_balancing(void)
{
    bq_mask_set(r.action.balance, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 10000);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].balancing);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 1));
}

/* proves: PL-SEQ-10-08 */
static void an_empty_mask_switches_everything_off_and_proves_it(void)
{
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 12);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    memset(&r.action, 0, sizeof r.action);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x32));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x00) & 0x02);
    }
    uint64_t packets = r.hal.transfers;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r)); /* nothing on, nothing to do */
    TEST_ASSERT_EQUAL_UINT(0, r.hal.transfers - packets);
}

/* proves: PL-SEQ-10-01, PL-UVLO-04, PL-SEQ-10-07 */
static void no_output_of_a_device_with_a_fault(void)
{
    (void)sim_pl_set_cell(&r.pl, 1, 1, 4.3);
    (void)sim_pl_set_vbat(&r.pl, 2, 5.2);
    rig_advance_ms(&r, 600);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 7);
    bq_mask_set(r.action.balance, 13);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, 2, 0x32));
    TEST_ASSERT_EQUAL_HEX8(1, sim_pl_cb(&r.pl, 3));
}

/* proves: PL-SEQ-10-03 */
static void cells_that_do_not_exist_have_no_output(void)
{
    c.cells_per_device = 4;
    rig_open(&r, &c, NULL);
    for (int n = 1; n <= 3; n++) {
        (void)sim_pl_set_cell(&r.pl, n, 5, 0);
        (void)sim_pl_set_cell(&r.pl, n, 6, 0);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    memset(r.action.balance, 0xff, sizeof r.action.balance);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0x0f, sim_pl_cb(&r.pl, n));
    }
}

static bool drop_on(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (n == 4 && tx[0] == 0x05 && tx[1] == 0x32 && tx[2] != 0) {
        memset(rx, 0, n);
        return true; /* device 2 never hears it */
    }
    return false;
}

/* proves: PL-SEQ-10-03 */
static void outputs_that_do_not_follow_are_reported(void)
{
    sim_pl_bus_fault(&r.pl)->hook = drop_on;
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 7);
    TEST_ASSERT_EQUAL_INT(BQ_E_VERIFY, rig_apply(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_BALANCE, r.modules[1].faults);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 2));
}

static int drop_offs;

static bool drop_off(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (drop_offs > 0 && n == 4 && tx[0] == 0x7f && tx[1] == 0x32) {
        drop_offs--;
        memset(rx, 0, n);
        return true;
    }
    return false;
}

/* The pause gets lost: the CBT bits tell, nothing measured with outputs on is used.
 * proves: PL-SEQ-10-04, PL-CB-15 */
static void a_lost_pause_is_noticed_and_the_measurement_repeated(void)
{
    bq_mask_set(r.action.balance, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    sim_pl_bus_fault(&r.pl)->hook = drop_off;
    drop_offs = 1;
    uint32_t conversions = sim_pl_conversions(&r.pl, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_UINT(conversions + 2, sim_pl_conversions(&r.pl, 1));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_TRUE((r.modules[0].faults & BQ_F_BALANCE) != 0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
}

/* The back-end cannot send the pause: outputs are off as soon as it can.
 * proves: PL-SEQ-10-04 */
static void a_pause_that_was_never_sent_is_made_up_for(void)
{
    bq_mask_set(r.action.balance, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_sample(&r);
    uint32_t sequence = r.sample.sequence;
    r.hal.fail_at = 1;
    r.hal.fail_count = 6; /* three tries of the pause, three of the start */
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(sequence, r.sample.sequence);
    memset(&r.action, 0, sizeof r.action);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, 1, 0x32));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_mask_reaches_the_outputs_with_the_timer_set);
    RUN_TEST(outputs_pause_for_every_measurement_and_restart_from_zero);
    RUN_TEST(a_new_mask_without_a_scan_in_between_also_starts_from_zero);
    RUN_TEST(an_expired_timer_is_not_reported_as_balancing);
    RUN_TEST(an_empty_mask_switches_everything_off_and_proves_it);
    RUN_TEST(no_output_of_a_device_with_a_fault);
    RUN_TEST(cells_that_do_not_exist_have_no_output);
    RUN_TEST(outputs_that_do_not_follow_are_reported);
    RUN_TEST(a_lost_pause_is_noticed_and_the_measurement_repeated);
    RUN_TEST(a_pause_that_was_never_sent_is_made_up_for);
    return UNITY_END();
}
