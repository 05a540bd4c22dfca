/* SPDX-License-Identifier: Apache-2.0 */
/* Measurement by broadcast and by pin: PL-SEQ-06, PL-SEQ-07. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

static struct spy {
    uint8_t first[4];
    unsigned packets;
    uint64_t start_ns, read_ns; /* end of the start packet, begin of the first burst */
    int starts_while_conv_high;
} spy;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (spy.packets == 0) {
        memcpy(spy.first, tx, n < 4 ? n : 4);
    }
    if (tx[1] == 0x34) {
        spy.start_ns = sim_pl_now(&r.pl);
        spy.starts_while_conv_high += sim_pl_conv(&r.pl);
    }
    if (n == 23 && spy.read_ns == 0) {
        spy.read_ns = sim_pl_now(&r.pl);
    }
    spy.packets++;
    return false;
}

void setUp(void)
{
    c = rig_config(3);
}

void tearDown(void)
{
}

static void spy_on(void)
{
    memset(&spy, 0, sizeof spy);
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

/* proves: PL-SEQ-06-01, PL-SEQ-06-02, PL-SEQ-06-03, PL-SEQ-06-04, PL-SEQ-06-09, PL-CONV-09, PL-CONV-12,
 * PL-PKT-08, PL-PKT-15, PL-VEC-12 */
static void a_quiet_scan_is_one_broadcast_and_one_burst_each(void)
{
    static const int sizes[] = {1, 2, 3, 32, 62};
    static const uint8_t convert[4] = {0x7f, 0x34, 0x01, 0x8a};
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        unsigned n = (unsigned)sizes[i];
        c = rig_config(sizes[i]);
        rig_up(&r, &c, NULL);
        spy_on();
        uint64_t packets = r.hal.transfers, bytes = r.hal.bytes;
        uint32_t before_us = (uint32_t)(sim_pl_now(&r.pl) / 1000u);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        TEST_ASSERT_EQUAL_UINT(n + 1, r.hal.transfers - packets);
        TEST_ASSERT_EQUAL_UINT(23 * n + 4, r.hal.bytes - bytes);
        TEST_ASSERT_EQUAL_MEMORY(convert, spy.first, 4);
        TEST_ASSERT_EQUAL_UINT(1, r.most_packets_per_poll);
        TEST_ASSERT_TRUE(spy.read_ns - spy.start_ns >= 4u * 8u * 1000000000ull / r.hal.clock_hz + 68000);
        rig_sample(&r);
        TEST_ASSERT_EQUAL_UINT(n, r.sample.module_count);
        TEST_ASSERT_EQUAL_UINT(6 * n, r.sample.cell_count);
        TEST_ASSERT_EQUAL_UINT(1, r.sample.sequence);
        TEST_ASSERT_UINT_WITHIN(2, before_us, r.sample.t_us);
        for (unsigned k = 0; k < n; k++) {
            TEST_ASSERT_EQUAL_UINT(1, sim_pl_conversions(&r.pl, (int)k + 1));
            TEST_ASSERT_EQUAL_UINT(r.modules[0].age_ms, r.modules[k].age_ms);
        }
        TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->scans);
        TEST_ASSERT_EQUAL_UINT(0, bq76pl536_stats(&r.d)->retries);
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* proves: PL-SEQ-07-01, PL-SEQ-07-02, PL-SEQ-07-03, PL-SEQ-07-04, PL-CONV-05, PL-DRDY-06 */
static void the_pin_is_held_until_the_cycle_is_complete(void)
{
    c.use_conv_pin = true;
    rig_up(&r, &c, NULL);
    spy_on();
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    TEST_ASSERT_FALSE(sim_pl_conv(&r.pl));
    uint32_t wait_us;
    TEST_ASSERT_EQUAL_INT(BQ_PENDING, bq76pl536_poll(&r.d, &wait_us));
    TEST_ASSERT_TRUE(sim_pl_conv(&r.pl));
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&r.pl));
    TEST_ASSERT_TRUE(wait_us >= 68);
    sim_pl_advance(&r.pl, 30 * SIM_PL_US);
    TEST_ASSERT_EQUAL_INT(BQ_PENDING, bq76pl536_poll(&r.d, NULL));
    TEST_ASSERT_TRUE(sim_pl_conv(&r.pl));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 1));
    TEST_ASSERT_FALSE(sim_pl_conv(&r.pl));
    TEST_ASSERT_EQUAL_UINT(3, spy.packets);
    TEST_ASSERT_EQUAL_UINT(0, spy.start_ns);
    TEST_ASSERT_EQUAL_UINT(1, sim_pl_conversions(&r.pl, 3));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-07-02, PL-AMB-79 */
static void a_board_without_drdy_or_pin_uses_the_computed_time(void)
{
    c.use_conv_pin = true;
    rig_open(&r, &c, NULL);
    r.hal.missing = 1u << BQ_LINE_DRDY;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_UINT(1, sim_pl_conversions(&r.pl, 3));
    r.hal.missing |= 1u << BQ_LINE_CONV; /* no pin after all: broadcast */
    spy_on();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_UINT(4, spy.packets);
    TEST_ASSERT_EQUAL_UINT(2, sim_pl_conversions(&r.pl, 3));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* A programmed device that was reset unnoticed would be locked up by the edge.
 * proves: PL-SEQ-07-05, PL-ADC-14 */
static void the_pin_is_not_raised_before_a_reset_device_is_configured(void)
{
    c.use_conv_pin = true;
    rig_open(&r, &c, NULL);
    for (int n = 1; n <= 3; n++) {
        (void)sim_pl_set_otp(&r.pl, n, 0x40, 0x50);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_poke(&r, 2, 0x3c, 0xa5);
    sim_pl_advance(&r.pl, 2 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, 2));
    TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, 2, 0x30));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-06-05 */
static void a_damaged_burst_is_asked_for_again_as_a_whole(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    uint32_t wait_us;
    (void)bq76pl536_poll(&r.d, &wait_us); /* the broadcast */
    sim_pl_bus_fault(&r.pl)->flip_miso_bit = 1 + 8 * 10;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 1));
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->crc_errors);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->retries);
    TEST_ASSERT_EQUAL_UINT(1, sim_pl_conversions(&r.pl, 1));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->scans);
}

static int damage_device;

static bool damage(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (n == 23 && tx[0] >> 1 == damage_device) {
        memset(rx, 0x37, n);
        return true;
    }
    return false;
}

/* proves: PL-SEQ-06-05 */
static void a_device_that_stays_damaged_is_invalid_and_the_others_are_fresh(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_advance_ms(&r, 100);
    damage_device = 2;
    sim_pl_bus_fault(&r.pl)->hook = damage;
    (void)sim_pl_set_cell(&r.pl, 2, 1, 3.7);
    (void)sim_pl_set_cell(&r.pl, 3, 1, 3.7);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3700, r.cells[12].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[12].quality);
    TEST_ASSERT_EQUAL_UINT(3600, r.cells[6].mv); /* the last good value */
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.temps[2].quality);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, r.modules[1].faults);
    TEST_ASSERT_TRUE(r.modules[1].age_ms >= 100 && r.modules[0].age_ms < 20);
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_stats(&r.d)->crc_errors);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->scans);
    sim_pl_bus_fault(&r.pl)->hook = NULL;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3700, r.cells[6].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
}

/* The start reaches device 2 with a flipped bit: it keeps old data, DRDY = 1 and the CRC flag.
 * proves: PL-SEQ-06-08, PL-SEQ-08-04, PL-SEQ-00-03, PL-CRC-10, PL-CRC-11, PL-DRDY-04 */
static void a_start_that_was_damaged_is_repeated_for_the_devices_that_missed_it(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    for (int n = 1; n <= 3; n++) {
        (void)sim_pl_set_cell(&r.pl, n, 4, 3.65);
    }
    sim_pl_bus_fault(&r.pl)->flip_mosi_bit = 1 + 31;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_UINT(3650, r.cells[6 * n - 3].mv);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * n - 3].quality);
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x21));
    }
    TEST_ASSERT_TRUE(bq76pl536_stats(&r.d)->write_errors >= 3);
}

/* proves: PL-SEQ-06-08 */
static void results_that_never_change_are_not_believed_for_ever(void)
{
    c.frozen_scans = 3;
    rig_up(&r, &c, NULL);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        (void)sim_pl_set_cell(&r.pl, 1, 1, 3.6 + 0.001 * (i + 1));
        (void)sim_pl_set_cell(&r.pl, 3, 1, 3.6 + 0.001 * (i + 1));
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_LOCKUP, r.modules[1].faults);
    (void)sim_pl_set_cell(&r.pl, 2, 1, 3.61);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
}

/* proves: PL-UVLO-04, PL-AMB-55 */
static void undervoltage_lockout_discards_the_device(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    (void)sim_pl_set_vbat(&r.pl, 2, 5.2);
    rig_advance_ms(&r, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_SUPPLY, r.modules[1].faults & BQ_F_SUPPLY);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, r.cells[6].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    (void)sim_pl_set_vbat(&r.pl, 2, -1);
    rig_advance_ms(&r, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6].quality);
}

static void a_sample_is_whole_or_not_at_all(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_E_STALE, bq76pl536_sample(&r.d, &r.sample));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    (void)sim_pl_set_cell(&r.pl, 1, 1, 3.7);
    (void)sim_pl_set_cell(&r.pl, 3, 6, 3.7);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    for (;;) {
        uint32_t wait_us;
        bq_status st = bq76pl536_poll(&r.d, &wait_us);
        if (st != BQ_PENDING) {
            break;
        }
        if (bq76pl536_sample(&r.d, &r.sample) == BQ_OK) {
            TEST_ASSERT_EQUAL_UINT(r.cells[0].mv, r.cells[17].mv);
        }
        hal_sim_advance(&r.hal, wait_us * 1000ull);
    }
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3700, r.cells[0].mv);
    TEST_ASSERT_EQUAL_UINT(3700, r.cells[17].mv);
    TEST_ASSERT_EQUAL_UINT(2, r.sample.sequence);
    r.sample.cell_capacity = 17;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_sample(&r.d, &r.sample));
    r.sample.cell_capacity = 18;
    r.sample.temp_capacity = 5;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_sample(&r.d, &r.sample));
    r.sample.temp_capacity = 6;
    r.sample.module_capacity = 2;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_sample(&r.d, &r.sample));
}

/* A back-end that completes a transfer inside start has moved the clock on by then: nobody waits for it
 * again. */
static void a_scan_of_a_polled_back_end_takes_its_time_on_the_bus(void)
{
    rig_up(&r, &c, NULL);
    const uint64_t bytes = r.hal.bytes, from = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    for (uint32_t wait_us = 0; bq76pl536_poll(&r.d, &wait_us) == BQ_PENDING;) {
        hal_sim_advance(&r.hal, wait_us * 1000ull);
    }
    const uint64_t bus_us = (r.hal.bytes - bytes) * 8000000u / r.hal.clock_hz;
    const uint64_t scan_us = (sim_pl_now(&r.pl) - from) / 1000u;
    TEST_ASSERT_TRUE(scan_us >= bus_us);
    TEST_ASSERT_TRUE(scan_us < bus_us + 1000u); /* conversion, gaps between packets */
}

/* The counter of the clock wraps in 71 minutes; a lost module must not look young again. */
static void ages_survive_the_wrap_of_the_clock(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    for (int minute = 0; minute < 150; minute++) {
        rig_advance_ms(&r, 60000);
    }
    rig_sample(&r);
    TEST_ASSERT_UINT_WITHIN(100, 150u * 60000u, r.modules[0].age_ms);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_TRUE(r.modules[0].age_ms < 20);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_quiet_scan_is_one_broadcast_and_one_burst_each);
    RUN_TEST(the_pin_is_held_until_the_cycle_is_complete);
    RUN_TEST(a_board_without_drdy_or_pin_uses_the_computed_time);
    RUN_TEST(the_pin_is_not_raised_before_a_reset_device_is_configured);
    RUN_TEST(a_damaged_burst_is_asked_for_again_as_a_whole);
    RUN_TEST(a_device_that_stays_damaged_is_invalid_and_the_others_are_fresh);
    RUN_TEST(a_start_that_was_damaged_is_repeated_for_the_devices_that_missed_it);
    RUN_TEST(results_that_never_change_are_not_believed_for_ever);
    RUN_TEST(undervoltage_lockout_discards_the_device);
    RUN_TEST(a_sample_is_whole_or_not_at_all);
    RUN_TEST(a_scan_of_a_polled_back_end_takes_its_time_on_the_bus);
    RUN_TEST(ages_survive_the_wrap_of_the_clock);
    return UNITY_END();
}
