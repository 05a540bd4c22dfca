/* SPDX-License-Identifier: Apache-2.0 */
/* What the header promises beyond the rows: how an apply ends, what a picture that does not count looks like,
 * what is refused, how long a poll may be left alone. */
#include "bench.h"
#include <math.h>

void setUp(void)
{
}
void tearDown(void)
{
}

/* A running part is taken over: its temperatures are not known for two seconds, and until then no FET comes
 * on and no apply ends as if it had. */
/* proves: X0-SEQ-05, X0-TS-07 */
static void test_an_apply_that_holds_a_fet_back_says_so(void)
{
    uint64_t from;
    bool was_on = false;
    bench_up("bq7693003");
    TEST_ASSERT_EQUAL(BQ_OK, bench_init()); /* the host was reset, the part was not */
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    from = b.chip.now;
    while (b.chip.now < from + 4000 * MS) {
        bq_status s;
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        s = bench_apply(true, true, 0);
        if (b.temps[0].quality == BQ_Q_VALID) {
            was_on = true;
            TEST_ASSERT_EQUAL(BQ_OK, s);
            TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        } else {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, b.temps[0].quality); /* it answers: COMM would be a lie */
            TEST_ASSERT_EQUAL(BQ_E_STATE, s);
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, 0)); /* what was not asked for is not missed */
        }
        bench_wait(200);
    }
    TEST_ASSERT_TRUE(was_on);
    NO_MISUSE();
}

/* One path held by a fault: the other one comes on, and the end still tells. */
/* proves: X0-FET-11, X0-SEQ-30 */
static void test_the_other_path_comes_on(void)
{
    bench_up("bq7692003");
    bench_serve(2750, 250);
    (void)sim_x0_set_cell(&b.chip, 1, 4.3);
    bench_wait(2500);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults);
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, 0));
    TEST_ASSERT_EQUAL(BQ_E_STATE, bench_apply(true, true, 0));
    TEST_ASSERT_TRUE(!sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, true, 0));
    NO_MISUSE();
}

/* proves: X0-SEQ-25 */
static void test_a_dead_bus_for_a_second_ends_with_the_fets_off(void)
{
    bench_up("bq7694003");
    bench_serve(2750, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    for (int n = 0; n < 8; n++) { /* measurements are lost, a write still arrives */
        bench_wait(230);
        b.spoil_at = b.count + 2;
        b.spoil_kind = SPOIL_LOST;
        b.spoil_count = 3;
        TEST_ASSERT_EQUAL(BQ_E_BUS, bench_scan());
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_COMM);
        TEST_ASSERT_FALSE(b.module.faults & BQ_F_LOCKUP);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, b.cells[0].quality);
    }
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    b.spoil_at = 0;
    TEST_ASSERT_TRUE(bench_until(true, true, 3000) < 3000);
}

/* proves: X0-SEQ-35 */
static void test_nothing_is_configured_while_the_part_reports_itself_broken(void)
{
    uint64_t before;
    bench_up("bq7694003");
    bench_serve(2750, 250);
    (void)sim_x0_strike_xready(&b.chip);
    bench_serve(500, 250);
    b.chip.reg[7] ^= 0x10; /* what a broken part may do */
    before = b.count;
    bench_serve(2250, 250);
    TEST_ASSERT_EQUAL(0, bench_writes(before, 7, NULL));
    bench_serve(8000, 250);
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->current.protect2, sim_x0_peek(&b.chip, 7));
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

/* Every poll that is not done says when to look again, and in total that is a few looks a transfer. */
static void test_a_poll_tells_how_long_it_can_be_left_alone(void)
{
    for (int k = 0; k < 15; k++) {
        unsigned polls = 0;
        uint64_t transfers;
        bq_status s;
        bench_up(sim_x0_part_at(k)->name);
        bench_wait(250);
        transfers = b.count;
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_scan(&b.d));
        for (;;) {
            uint32_t wait = 0;
            s = bq769x0_poll(&b.d, &wait);
            if (s != BQ_PENDING)
                break;
            polls++;
            TEST_ASSERT_TRUE(wait > 0 && wait <= 9000);
            bench_wait(wait / 1e3);
        }
        TEST_ASSERT_EQUAL(BQ_OK, s);
        TEST_ASSERT_TRUE(polls <= 3 * (b.count - transfers));
    }
}

static bq_status no_start(void *ctx, uint8_t address7, const bq_i2c_segment *s, size_t count)
{
    (void)ctx, (void)address7, (void)s, (void)count;
    return BQ_OK;
}
static bq_status no_poll(void *ctx)
{
    (void)ctx;
    return BQ_OK;
}
static bq_status no_write(void *ctx, bq_line line, bool level)
{
    (void)ctx, (void)line, (void)level;
    return BQ_OK;
}

static void test_init_refuses_what_it_could_not_call_or_look_up(void)
{
    static const uint32_t ohms[2] = {20000, 5000};
    static const bq_i2c_ops no_poll_ops = {no_start, NULL, NULL}, no_start_ops = {NULL, no_poll, NULL};
    static const bq_gpio_ops half = {NULL, no_write};
    bq_thermistor t = {ohms, 1, 0, 500};
    bq_i2c i2c = {&no_poll_ops, NULL};
    bq_gpio gpio = {&half, NULL};
    bq_clock clock = bench_clock();
    bench_part("bq7692000", NULL);
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
    i2c.ops = &no_start_ops;
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
    i2c = bench_i2c();
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq769x0_init(&b.d, &b.cfg, &i2c, &gpio, &clock));
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
    b.cfg.sensor_ctx = &t;
    TEST_ASSERT_EQUAL(BQ_E_CONFIG, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
    t.count = 2;
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
    t.ohms = NULL;
    TEST_ASSERT_EQUAL(BQ_E_CONFIG, bq769x0_init(&b.d, &b.cfg, &i2c, NULL, &clock));
}

/* proves: X0-AMB-64 */
static void test_internal_balancing_of_the_larger_parts_is_warned_of(void)
{
    for (int k = 0; k < 15; k++) {
        bench_part(sim_x0_part_at(k)->name, NULL);
        TEST_ASSERT_EQUAL(b.cfg.inputs > 5 ? BQ769X0_WARN_BALANCE : 0, bq769x0_config_warnings(&b.cfg));
        b.cfg.balance_external = true;
        TEST_ASSERT_EQUAL(0, bq769x0_config_warnings(&b.cfg));
    }
}

/* The quotient is computed from the configured shunt: 300 mV / 25 A are 12 mohm, 7.5 mohm belong to 40 A. */
/* proves: X0-ELEC-14, X0-AMB-05 */
static void test_a_shunt_too_large_for_the_short_circuit_is_warned_of(void)
{
    static const struct {
        uint32_t uohm, ma;
        bool warned;
    } point[] = {{12000, 25000, false},
                 {12010, 25000, true},
                 {7500, 40000, false},
                 {7510, 40000, true},
                 {5000, 25000, false}};
    for (size_t p = 0; p < sizeof point / sizeof point[0]; p++) {
        bench_part("bq7692000", NULL);
        b.cfg.shunt_uohm = point[p].uohm;
        b.cfg.scd_ma = point[p].ma;
        TEST_ASSERT_EQUAL(point[p].warned ? BQ769X0_WARN_SHUNT : 0, bq769x0_config_warnings(&b.cfg));
    }
}

/* proves: X0-CC-11, X0-AMB-23 */
static void test_a_current_outside_its_range_is_marked(void)
{
    static const double code[] = {23690, 23702, -23690, -23702};
    for (int p = 0; p < 4; p++) {
        bench_up("bq7692003");
        (void)sim_x0_set_sense(&b.chip, code[p] * 8.44e-6);
        bench_serve(1000, 250);
        TEST_ASSERT_TRUE(b.sample.current_valid);
        TEST_ASSERT_EQUAL(fabs(code[p]) > 23696, bq769x0_current_outside(&b.d));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_apply_that_holds_a_fet_back_says_so);
    RUN_TEST(test_the_other_path_comes_on);
    RUN_TEST(test_a_dead_bus_for_a_second_ends_with_the_fets_off);
    RUN_TEST(test_nothing_is_configured_while_the_part_reports_itself_broken);
    RUN_TEST(test_a_poll_tells_how_long_it_can_be_left_alone);
    RUN_TEST(test_init_refuses_what_it_could_not_call_or_look_up);
    RUN_TEST(test_internal_balancing_of_the_larger_parts_is_warned_of);
    RUN_TEST(test_a_shunt_too_large_for_the_short_circuit_is_warned_of);
    RUN_TEST(test_a_current_outside_its_range_is_marked);
    return UNITY_END();
}
