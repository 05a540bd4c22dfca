/* SPDX-License-Identifier: Apache-2.0 */
/* The n-th transfer fails, for every n, in every job. The back-end reports it, or stays silent. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(3);
    c.cov_delay_us = 1000;
    c.cuv_delay_us = 1000;
    c.ot_delay_ms = 20;
}

void tearDown(void)
{
}

static void check_configuration(void)
{
    static const uint8_t group3[8] = {0x50, 0x00, 0x2c, 0x0a, 0x15, 0x0a, 0x55, 0x02};
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 + n, sim_pl_peek(&r.pl, n, 0x3b));
        for (int i = 0; i < 8; i++) {
            TEST_ASSERT_EQUAL_HEX8(group3[i], sim_pl_peek(&r.pl, n, (uint8_t)(0x40 + i)));
        }
        TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, n, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x20));
    }
}

/* How many packets each failure swallows: the same in all runs of a test. */
static void one_failing_transfer_in_bring_up(bool in_start)
{
    rig_up(&r, &c, NULL);
    uint64_t packets = r.hal.transfers;
    for (uint32_t n = 1; n <= packets; n++) {
        rig_open(&r, &c, NULL);
        r.hal.fail_at = n;
        r.hal.fail_in_start = in_start;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
        TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->bus_errors);
        TEST_ASSERT_EQUAL_UINT(3, bq76pl536_modules_found(&r.d));
        check_configuration();
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_UINT(3600, r.cells[17].mv);
        TEST_ASSERT_EQUAL_UINT(1, r.most_packets_per_poll);
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* proves: PL-SEQ-00-01, PL-SEQ-00-02, PL-SEQ-00-04, PL-SEQ-00-06 */
static void bring_up_survives_any_single_failure_reported_by_poll(void)
{
    one_failing_transfer_in_bring_up(false);
}

static void bring_up_survives_any_single_failure_reported_by_start(void)
{
    one_failing_transfer_in_bring_up(true);
}

/* proves: PL-SEQ-00-02, PL-SEQ-00-04, PL-SEQ-00-05, PL-SEQ-00-06, PL-CRC-11 */
static void bring_up_survives_any_single_lost_packet(void)
{
    rig_up(&r, &c, NULL);
    uint64_t packets = r.hal.transfers;
    for (uint64_t n = 1; n <= packets; n++) {
        rig_open(&r, &c, NULL);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
        bq_status st = BQ_PENDING;
        bool armed = false;
        while (st == BQ_PENDING) {
            if (!armed && r.hal.transfers + 1 == n) {
                sim_pl_bus_fault(&r.pl)->drop_packets = 1;
                armed = true;
            }
            uint32_t wait_us;
            st = bq76pl536_poll(&r.d, &wait_us);
            hal_sim_advance(&r.hal, wait_us * 1000ull);
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, st);
        check_configuration();
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* A flipped bit on the way to the devices in any packet of bring-up.
 * proves: PL-SEQ-00-02, PL-SEQ-00-04, PL-CRC-10, PL-CRC-11 */
static void bring_up_survives_any_single_damaged_packet(void)
{
    rig_up(&r, &c, NULL);
    uint64_t packets = r.hal.transfers;
    for (uint64_t n = 1; n <= packets; n++) {
        rig_open(&r, &c, NULL);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
        bq_status st = BQ_PENDING;
        bool armed = false;
        while (st == BQ_PENDING) {
            if (!armed && r.hal.transfers + 1 == n) {
                sim_pl_bus_fault(&r.pl)->flip_mosi_bit = 1 + 16 + (int)(n % 8);
                armed = true;
            }
            uint32_t wait_us;
            st = bq76pl536_poll(&r.d, &wait_us);
            hal_sim_advance(&r.hal, wait_us * 1000ull);
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, st);
        check_configuration();
    }
}

/* proves: PL-SEQ-06-05 */
static void a_scan_survives_any_single_failure(void)
{
    for (uint32_t n = 1; n <= 4; n++) {
        for (int in_start = 0; in_start < 2; in_start++) {
            rig_up(&r, &c, NULL);
            r.hal.fail_at = n;
            r.hal.fail_in_start = in_start != 0;
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
            rig_sample(&r);
            for (int i = 0; i < 18; i++) {
                TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
            }
            TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->bus_errors);
            TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
        }
    }
}

/* A back-end that fails for good: every job ends, in a bounded number of packets, and says so. */
static void no_job_hangs_on_a_dead_back_end(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    for (uint32_t n = 1; n <= 40; n++) {
        r.hal.fail_at = n;
        r.hal.fail_count = 1000000;
        uint64_t before = r.hal.transfers;
        bq_status st = n % 4 == 0   ? bq76pl536_self_test(&r.d)
                       : n % 4 == 1 ? bq76pl536_scan(&r.d)
                       : n % 4 == 2 ? bq76pl536_wire_test(&r.d)
                                    : bq76pl536_sleep(&r.d);
        TEST_ASSERT_EQUAL_INT(BQ_OK, st);
        TEST_ASSERT_TRUE(rig_run(&r, 60) != BQ_PENDING);
        TEST_ASSERT_TRUE(r.hal.transfers - before < 2000);
        r.hal.fail_at = 0;
        r.hal.fail_count = 0;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    }
    r.hal.fail_at = 1;
    r.hal.fail_count = 1000000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
    bq_status st = rig_run(&r, 60);
    TEST_ASSERT_TRUE(st < 0);
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_modules_found(&r.d));
}

/* A failed start of the conversion leaves the old picture, growing older. */
static void a_scan_that_cannot_start_changes_nothing(void)
{
    rig_up(&r, &c, NULL);
    uint32_t t_us;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    t_us = r.sample.t_us;
    rig_advance_ms(&r, 200);
    (void)sim_pl_set_cell(&r.pl, 1, 1, 3.9);
    r.hal.fail_at = 1;
    r.hal.fail_count = 3;
    TEST_ASSERT_EQUAL_INT(BQ_E_BUS, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(1, r.sample.sequence);
    TEST_ASSERT_EQUAL_UINT(t_us, r.sample.t_us); /* the time of this picture, not of the attempt */
    TEST_ASSERT_EQUAL_UINT(3600, r.cells[0].mv);
    TEST_ASSERT_TRUE(r.modules[0].age_ms >= 200);
}

/* A back-end with DMA: poll answers pending; one that never ends is given up. */
static void slow_and_stuck_back_ends_are_waited_for_with_a_bound(void)
{
    rig_open(&r, &c, NULL);
    r.hal.pending = 3;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_UINT(0, r.hal.overlaps);
    r.hal.pending = UINT32_MAX;
    TEST_ASSERT_TRUE(rig_scan(&r) < 0);
    TEST_ASSERT_TRUE(bq76pl536_stats(&r.d)->bus_errors > 0);
}

/* Balancing and sleep with one failing transfer anywhere. */
static void apply_sleep_and_wake_survive_any_single_failure(void)
{
    for (uint32_t n = 1; n <= 60; n++) {
        rig_up(&r, &c, NULL);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        bq_mask_set(r.action.balance, 1);
        bq_mask_set(r.action.balance, 14);
        r.hal.fail_at = n;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
        TEST_ASSERT_EQUAL_HEX8(1, sim_pl_cb(&r.pl, 1));
        TEST_ASSERT_EQUAL_HEX8(2, sim_pl_cb(&r.pl, 3));
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_sleep(&r.d));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
        for (int k = 1; k <= 3; k++) {
            TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&r.pl, k));
            TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, k));
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wake(&r.d));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[17].quality);
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(bring_up_survives_any_single_failure_reported_by_poll);
    RUN_TEST(bring_up_survives_any_single_failure_reported_by_start);
    RUN_TEST(bring_up_survives_any_single_lost_packet);
    RUN_TEST(bring_up_survives_any_single_damaged_packet);
    RUN_TEST(a_scan_survives_any_single_failure);
    RUN_TEST(no_job_hangs_on_a_dead_back_end);
    RUN_TEST(a_scan_that_cannot_start_changes_nothing);
    RUN_TEST(slow_and_stuck_back_ends_are_waited_for_with_a_bound);
    RUN_TEST(apply_sleep_and_wake_survive_any_single_failure);
    return UNITY_END();
}
