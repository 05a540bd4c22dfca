/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up and address discovery: PL-SEQ-01, PL-SEQ-02. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

/* A spy on the bus: counts packets by their first bytes, and can answer for devices that do not exist. */
static struct spy {
    int resets, resets_bare, zero_assignments, bare_assignments, broadcast_assignments;
    int reads_of_two, assignments_of_two;
    int fail_two_until; /* so many packets with an assignment of 2 are damaged */
    int corrupt_from;   /* while a device of this number has an address, device 1 answers garbage */
    bool seen;
    uint64_t first_packet_ns, first_convert_ns;
} spy;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (!spy.seen) {
        spy.seen = true;
        spy.first_packet_ns = sim_pl_now(&r.pl);
    }
    if (tx[0] == 0x7f && tx[1] == 0x34 && spy.first_convert_ns == 0) {
        spy.first_convert_ns = sim_pl_now(&r.pl);
    }
    spy.resets += n == 4 && tx[0] == 0x7f && tx[1] == 0x3c && tx[2] == 0xa5 && tx[3] == 0x57;
    spy.resets_bare += n == 3 && tx[0] == 0x7f && tx[1] == 0x3c;
    spy.broadcast_assignments += tx[0] == 0x7f && tx[1] == 0x3b;
    if (tx[0] == 0x01 && tx[1] == 0x3b) {
        spy.zero_assignments += (tx[2] & 0x80) != 0;
        spy.bare_assignments += (tx[2] & 0x80) == 0;
        spy.assignments_of_two += (tx[2] & 0x3f) == 2;
    }
    spy.reads_of_two += tx[0] == 0x04 && tx[1] == 0x3b;
    if (spy.corrupt_from != 0 && (tx[0] & 1) == 0 && sim_pl_peek(&r.pl, spy.corrupt_from, 0x3b) != 0) {
        memset(rx, 0x42, n); /* the bus is disturbed as soon as that device takes part */
        return true;
    }
    return false;
}

void setUp(void)
{
    memset(&spy, 0, sizeof spy);
    c = rig_config(4);
}

void tearDown(void)
{
}

static void open_with_spy(const sim_pl_options *options)
{
    rig_open(&r, &c, options);
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

/* proves: PL-SEQ-01-01, PL-SEQ-01-02, PL-SEQ-01-05, PL-ADC-19, PL-POR-09, PL-CONV-04 */
static void waits_for_the_power_up_and_the_first_conversion(void)
{
    open_with_spy(NULL);
    sim_pl_set_conv(&r.pl, true);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_FALSE(sim_pl_conv(&r.pl));
    TEST_ASSERT_TRUE(spy.first_packet_ns >= 70 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_TRUE(spy.first_convert_ns >= 120 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* The delays are short here, so that nothing but the rule itself makes the first conversion wait.
 * proves: PL-SEQ-01-05, PL-ADC-19 */
static void the_first_conversion_waits_without_long_delays_too(void)
{
    c = rig_config(1);
    c.cov_delay_us = 100;
    c.cuv_delay_us = 100;
    c.ot_c[0] = 0;
    c.ot_c[1] = 0;
    open_with_spy(NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_TRUE(spy.first_convert_ns >= 120 * SIM_PL_MS);
}

/* proves: PL-SEQ-02-01, PL-SEQ-02-02, PL-SEQ-02-03, PL-SEQ-02-04, PL-SEQ-02-07, PL-ADR-11, PL-ADR-12,
 * PL-ADR-15, PL-ADR-16, PL-AMB-29 */
static void follows_the_growing_loop(void)
{
    open_with_spy(NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(4, spy.resets);
    TEST_ASSERT_EQUAL_INT(4 + 3 + 2 + 1, spy.zero_assignments);
    TEST_ASSERT_EQUAL_INT(0, spy.bare_assignments);
    TEST_ASSERT_EQUAL_INT(0, spy.broadcast_assignments);
    TEST_ASSERT_EQUAL_INT(0, spy.resets_bare);
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_modules_found(&r.d));
    for (int n = 1; n <= 4; n++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 + n, sim_pl_peek(&r.pl, n, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x21));
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    TEST_ASSERT_EQUAL_UINT(1, r.most_packets_per_poll);
}

/* A second life of the host finds every device with an address.
 * proves: PL-ADR-13, PL-SEQ-02-10, PL-ALT-09 */
static void finds_a_stack_that_already_has_addresses(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    /* addresses in a wrong order, given by somebody else */
    static const uint8_t swap[][4] = {
        {0x7f, 0x3c, 0xa5, 0x57}, {0x01, 0x3b, 0x02, 0x0b}, {0x01, 0x3b, 0x01, 0x02}};
    uint8_t rx[4];
    for (unsigned i = 0; i < 3; i++) {
        sim_pl_spi(&r.pl, swap[i], rx, NULL, 4);
        sim_pl_advance(&r.pl, SIM_PL_MS);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_HEX8(0x81, sim_pl_peek(&r.pl, 1, 0x3b));
    TEST_ASSERT_EQUAL_HEX8(0x82, sim_pl_peek(&r.pl, 2, 0x3b));
}

/* proves: PL-SEQ-02-05, PL-ADR-06, PL-CRC-07, PL-SEQ-00-01 */
static void repeats_only_the_read_after_a_damaged_read_back(void)
{
    rig_open(&r, &c, NULL);
    sim_bus_fault *bus = sim_pl_bus_fault(&r.pl);
    bus->hook = watch;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
    while (spy.assignments_of_two == 0) {
        uint32_t wait_us;
        TEST_ASSERT_EQUAL_INT(BQ_PENDING, bq76pl536_poll(&r.d, &wait_us));
        hal_sim_advance(&r.hal, wait_us * 1000ull + 100u);
    }
    bus->flip_miso_bit = 1 + 26; /* in the data byte of the read-back */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
    TEST_ASSERT_EQUAL_INT(3, spy.assignments_of_two);
    TEST_ASSERT_EQUAL_INT(4, spy.reads_of_two);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->crc_errors);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_stats(&r.d)->retries);
}

/* proves: PL-SEQ-02-06, PL-AMB-26 */
static void second_attempt_is_bare_and_third_halves_the_clock(void)
{
    open_with_spy(NULL);
    (void)sim_pl_set_link(&r.pl, 2, true);
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_FOUND, rig_start(&r));
    TEST_ASSERT_TRUE(spy.bare_assignments > 0);
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_diagnose(&r.d)->broken_hop);
    TEST_ASSERT_EQUAL_UINT(2, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

static uint32_t too_fast(driver_rig *rig)
{
    return rig->hal.clock_hz > 150000;
}

static bool fails_when_fast(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (too_fast(&r) && (tx[0] >> 1) == 4) {
        memset(rx, 0, n);
        return true;
    }
    return false;
}

/* proves: PL-SEQ-02-06 */
static void a_stack_that_needs_a_slower_clock_is_found_at_half_of_it(void)
{
    rig_open(&r, &c, NULL);
    sim_pl_bus_fault(&r.pl)->hook = fails_when_fast;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_UINT(125000, bq76pl536_diagnose(&r.d)->spi_hz);
}

/* proves: PL-SEQ-13-03 */
static void keeps_the_devices_below_a_broken_hop_when_allowed(void)
{
    c.allow_partial = true;
    rig_open(&r, &c, NULL);
    (void)sim_pl_set_link(&r.pl, 3, true);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_diagnose(&r.d)->broken_hop);
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int i = 0; i < 18; i++) {
        TEST_ASSERT_EQUAL_UINT(3600, r.cells[i].mv);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.cells[18].quality);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, r.modules[3].faults);
    TEST_ASSERT_EQUAL_UINT(UINT32_MAX, r.modules[3].age_ms);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* A device whose presence disturbs all below it: the stack is used up to the one before. */
static void finds_the_largest_height_when_a_device_disturbs_the_others(void)
{
    c = rig_config(9);
    c.allow_partial = true;
    open_with_spy(NULL);
    spy.corrupt_from = 6;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(5, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_UINT(6, bq76pl536_diagnose(&r.d)->broken_hop);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

/* proves: PL-SEQ-02-08, PL-ADR-14 */
static void reports_more_devices_than_configured(void)
{
    bq76pl536_config big = rig_config(5);
    rig_open(&r, &big, NULL);
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, NULL, &clock, r.devices, 4));
    TEST_ASSERT_EQUAL_INT(BQ_E_EXTRA_DEVICE, rig_start(&r));
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->extra_device);
}

/* proves: PL-SEQ-02-11, PL-CRC-08 */
static void finds_and_reports_devices_programmed_without_crc(void)
{
    rig_open(&r, &c, NULL);
    for (int n = 1; n <= 4; n++) {
        (void)sim_pl_set_otp(&r.pl, n, 0x41, 0x01);
        (void)sim_pl_set_supply(&r.pl, n, false);
    }
    sim_pl_advance(&r.pl, SIM_PL_MS);
    for (int n = 1; n <= 4; n++) {
        (void)sim_pl_set_supply(&r.pl, n, true);
    }
    sim_pl_advance(&r.pl, 100 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_INT(BQ_E_CRC_OFF, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq76pl536_scan(&r.d));
    c.crc_off = true;
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_gpio gpio = hal_sim_gpio(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, 4));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

/* proves: PL-SEQ-01-03, PL-POR-06 */
static void does_not_wait_for_silent_lines_and_notes_a_mute_chain(void)
{
    rig_open(&r, &c, NULL);
    TEST_ASSERT_TRUE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->alert_silent);
    /* a board whose ALERT input is cut sees low: reported, bring-up goes on */
    static bq_gpio_ops cut;
    extern bq_status cut_read(void *ctx, bq_line line, bool *level);
    const bq_gpio good = hal_sim_gpio(&r.hal);
    cut = *good.ops;
    cut.read = cut_read;
    const bq_gpio gpio = {&cut, &r.hal};
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, 4));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->alert_silent);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->alert_chain_break);
}

bq_status cut_read(void *ctx, bq_line line, bool *level)
{
    const bq_gpio good = hal_sim_gpio(ctx);
    bq_status st = good.ops->read(ctx, line, level);
    *level = *level && line != BQ_LINE_ALERT;
    return st;
}

/* proves: PL-SEQ-05-04 */
static void cycles_the_supply_once_when_nobody_answers(void)
{
    rig_open(&r, &c, NULL);
    /* TEST mode at the base: it hears nothing until its supply was off (PL-AMB-108) */
    rig_poke(&r, 0, 0x3d, 0xa4);
    rig_poke(&r, 0, 0x3d, 0x25);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_modules_found(&r.d));
    /* a board that cannot, reports */
    rig_open(&r, &c, NULL);
    r.hal.missing = 1u << BQ_LINE_AFE_POWER;
    sim_pl_bus_fault(&r.pl)->dead = 1;
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_FOUND, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->broken_hop);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(waits_for_the_power_up_and_the_first_conversion);
    RUN_TEST(the_first_conversion_waits_without_long_delays_too);
    RUN_TEST(follows_the_growing_loop);
    RUN_TEST(finds_a_stack_that_already_has_addresses);
    RUN_TEST(repeats_only_the_read_after_a_damaged_read_back);
    RUN_TEST(second_attempt_is_bare_and_third_halves_the_clock);
    RUN_TEST(a_stack_that_needs_a_slower_clock_is_found_at_half_of_it);
    RUN_TEST(keeps_the_devices_below_a_broken_hop_when_allowed);
    RUN_TEST(finds_the_largest_height_when_a_device_disturbs_the_others);
    RUN_TEST(reports_more_devices_than_configured);
    RUN_TEST(finds_and_reports_devices_programmed_without_crc);
    RUN_TEST(does_not_wait_for_silent_lines_and_notes_a_mute_chain);
    RUN_TEST(cycles_the_supply_once_when_nobody_answers);
    return UNITY_END();
}
