/* SPDX-License-Identifier: Apache-2.0 */
/* Self-test of the FAULT and ALERT chains: PL-SEQ-09. The simulator's chains are whole; a break is made by a
 * board whose lines are read only for the devices below it. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;
static int fault_break, alert_break; /* devices above this one are not heard; 99 = whole */
static bool stuck_after;
static int forced[64];
static uint32_t bytes;

static bool below(int reg, int limit)
{
    for (int n = 1; n <= c.devices && n <= limit; n++) {
        int flags = sim_pl_peek(&r.pl, n, (uint8_t)reg);
        if (flags > 0) {
            return true;
        }
    }
    return false;
}

static bq_status broken_read(void *ctx, bq_line line, bool *level)
{
    static bool was_high;
    (void)ctx;
    switch (line) {
    case BQ_LINE_FAULT:
        *level = below(0x21, fault_break) || (stuck_after && was_high);
        was_high = *level;
        return BQ_OK;
    case BQ_LINE_ALERT:
        *level = below(0x20, alert_break);
        return BQ_OK;
    default:
        return BQ_E_UNSUPPORTED;
    }
}

static bq_status no_write(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    (void)line;
    (void)level;
    return BQ_E_UNSUPPORTED;
}

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    bytes += n;
    if (n == 4 && (tx[1] == 0x20 || tx[1] == 0x21) && tx[2] == 0x10) {
        forced[tx[0] >> 1]++;
    }
    return false;
}

static void open_board(void)
{
    static const bq_gpio_ops ops = {broken_read, no_write};
    const bq_gpio gpio = {&ops, &r};
    rig_open(&r, &c, NULL);
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, 62));
    sim_pl_bus_fault(&r.pl)->hook = watch;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
}

static bq_status self_test(void)
{
    memset(forced, 0, sizeof forced);
    bytes = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_self_test(&r.d));
    return rig_run(&r, 5);
}

void setUp(void)
{
    c = rig_config(5);
    fault_break = 99;
    alert_break = 99;
    stuck_after = false;
}

void tearDown(void)
{
}

/* proves: PL-SEQ-09-02, PL-SEQ-09-03, PL-SEQ-09-04, PL-SEQ-09-05, PL-SEQ-09-06, PL-FLT-17, PL-VEC-29 */
static void forces_the_top_device_and_releases_it(void)
{
    rig_up(&r, &c, NULL);
    sim_pl_bus_fault(&r.pl)->hook = watch;
    TEST_ASSERT_EQUAL_INT(BQ_OK, self_test());
    TEST_ASSERT_EQUAL_INT(2, forced[5]);
    TEST_ASSERT_EQUAL_INT(0, forced[4]);
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->chain_skipped);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&r.pl));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-09-02, PL-SEQ-09-05 */
static void a_broken_chain_is_located(void)
{
    open_board();
    TEST_ASSERT_EQUAL_INT(BQ_OK, self_test());
    fault_break = 3;
    TEST_ASSERT_EQUAL_INT(BQ_E_CHAIN_BROKEN, self_test());
    TEST_ASSERT_EQUAL_UINT(4, bq76pl536_diagnose(&r.d)->fault_chain_break);
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_diagnose(&r.d)->alert_chain_break);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, r.modules[3].faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[18].quality);
    fault_break = 99;
    alert_break = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_CHAIN_BROKEN, self_test());
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_diagnose(&r.d)->fault_chain_break);
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->alert_chain_break);
    for (int n = 1; n <= 5; n++) {
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x21));
    }
    alert_break = 99;
    TEST_ASSERT_EQUAL_INT(BQ_OK, self_test());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults | r.modules[3].faults);
}

/* 62 devices: whatever place the break has, finding it takes no longer than proving the whole chain, so that
 * the readings do not grow older than in a healthy stack.
 * proves: PL-SEQ-09-02 */
static void a_break_is_found_in_few_steps(void)
{
    c = rig_config(62);
    open_board();
    const uint64_t from = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, self_test());
    TEST_ASSERT_LESS_THAN(360, (uint32_t)((sim_pl_now(&r.pl) - from) / SIM_PL_MS));
    const uint32_t whole = bytes;
    TEST_ASSERT_UINT_WITHIN(62, 21 * 62 + 26, whole); /* some reads take a byte more: PL-CRC-12 */
    for (fault_break = 0; fault_break < 62; fault_break++) {
        int most = 0, sum = 0;
        TEST_ASSERT_EQUAL_INT(BQ_E_CHAIN_BROKEN, self_test());
        TEST_ASSERT_EQUAL_UINT(fault_break + 1, bq76pl536_diagnose(&r.d)->fault_chain_break);
        for (int n = 1; n <= 62; n++) {
            most = forced[n] > most ? forced[n] : most;
            sum += forced[n];
        }
        TEST_ASSERT_EQUAL_INT(2, most);        /* the top device, for each chain */
        TEST_ASSERT_LESS_OR_EQUAL(1 + 7, sum); /* 2 to the 6th exceeds 61 */
        TEST_ASSERT_LESS_THAN(whole, bytes);
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-09-04 */
static void a_line_that_does_not_fall_again_is_stuck(void)
{
    open_board();
    stuck_after = true;
    TEST_ASSERT_EQUAL_INT(BQ_E_LINE_STUCK, self_test());
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->fault_line_stuck);
}

/* proves: PL-SEQ-09-01 */
static void a_chain_that_is_already_high_is_left_out(void)
{
    rig_up(&r, &c, NULL);
    sim_pl_bus_fault(&r.pl)->hook = watch;
    (void)sim_pl_set_cell(&r.pl, 2, 1, 4.3);
    rig_advance_ms(&r, 600);
    TEST_ASSERT_EQUAL_INT(BQ_OK, self_test());
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->chain_skipped);
    TEST_ASSERT_EQUAL_INT(1, forced[5]);                       /* ALERT only */
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 2, 0x21)); /* the real flag was not touched */
}

static void a_board_without_lines_tests_nothing(void)
{
    rig_open(&r, &c, NULL);
    const bq_spi spi = hal_sim_spi(&r.hal);
    const bq_clock clock = hal_sim_clock(&r.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, NULL, &clock, r.devices, 62));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->chain_skipped);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(forces_the_top_device_and_releases_it);
    RUN_TEST(a_broken_chain_is_located);
    RUN_TEST(a_break_is_found_in_few_steps);
    RUN_TEST(a_line_that_does_not_fall_again_is_stuck);
    RUN_TEST(a_chain_that_is_already_high_is_left_out);
    RUN_TEST(a_board_without_lines_tests_nothing);
    return UNITY_END();
}
