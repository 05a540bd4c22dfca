/* SPDX-License-Identifier: Apache-2.0 */
/* The part's limits are a second line: with them set as loosely as they go, the pack controller alone opens
 * the paths, through the same driver and on the same readings. */
#include "bench.h"
#include "bqhost/pack.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static bq_pack pack;

static void host(uint32_t ms, bool balance_off)
{
    uint64_t end = b.chip.now + ms * MS;
    static bq_status applied;
    while (b.chip.now < end) {
        bq_pack_input in;
        memset(&in, 0, sizeof in);
        in.request = BQ_REQUEST_ON;
        in.monitor = BQ_MONITOR_UP;
        in.self_test = BQ_TEST_PASSED;
        in.balance_off = balance_off;
        in.apply_status = applied;
        (void)bench_scan();
        in.sample_copied = bench_picture() == BQ_OK;
        bq_pack_step(&pack, &b.sample, &in, (uint32_t)(b.chip.now / MS), &b.action);
        applied = bq769x0_begin_apply(&b.d, &b.action);
        if (applied == BQ_OK)
            applied = bench_run(5000);
        bench_wait(230);
    }
}

static void on_duty(const char *name)
{
    bq_pack_config c;
    bench_part(name, NULL);
    b.cfg.ov_mv = 4600;
    b.cfg.ov_recover_mv = 4100;
    b.cfg.uv_mv = 1700;
    b.cfg.uv_recover_mv = 3000;
    b.cfg.ov_delay_s = 8;
    b.cfg.uv_delay_s = 16;
    b.cfg.ocd_ma = 20000;
    b.cfg.scd_ma = 40000;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    c = bq_pack_config_nmc(b.cfg.cells, b.cfg.sensors, 1);
    c.separate_paths = true;
    c.comm_timeout_ms = 2000;
    c.imbalance_mv = c.imbalance_clear_mv = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_init(&pack, &c));
    host(5000, true);
    TEST_ASSERT_EQUAL_STRING("on", bq_pack_state_name(pack.state));
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static void part_is_silent(void)
{
    TEST_ASSERT_EQUAL_HEX8(0, b.chip.reg[0] & 0x3f);
    NO_MISUSE();
}

/* proves: X0-OV-13 */
static void test_voltage_limits_of_the_host(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        on_duty(sim_x0_part_at(k)->name);
        (void)sim_x0_set_cell(&b.chip, 3, pack.config.cell_ov_mv * 1e-3 + 0.01);
        host(3000, true);
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip));
        TEST_ASSERT_TRUE(sim_x0_dsg(&b.chip));
        TEST_ASSERT_EQUAL_STRING("cell_ov", bq_pack_fault_name(bq_pack_cause(&pack)));
        part_is_silent();
        on_duty(sim_x0_part_at(k)->name);
        (void)sim_x0_set_cell(&b.chip, 3, pack.config.cell_uv_mv * 1e-3 - 0.01);
        host(3000, true);
        TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
        TEST_ASSERT_EQUAL_STRING("cell_uv", bq_pack_fault_name(bq_pack_cause(&pack)));
        part_is_silent();
    }
}

/* What the part does not look at at all. */
/* proves: X0-UV-08, X0-TS-07 */
static void test_what_the_part_does_not_look_at(void)
{
    on_duty("bq7694003");
    (void)sim_x0_set_ts(&b.chip, 2, 1200.0); /* about 90 degC */
    host(4000, true);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL_STRING("overtemp", bq_pack_fault_name(bq_pack_cause(&pack)));
    part_is_silent();
    on_duty("bq7694003");
    (void)sim_x0_set_cell(&b.chip, 9, 0.2); /* dead */
    host(4000, true);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_TRUE(pack.fault[BQ_FAULT_OPEN_WIRE].active);
    TEST_ASSERT_EQUAL(9, pack.fault[BQ_FAULT_CELL_UV].cell);
    part_is_silent();
    on_duty("bq7694003");
    (void)sim_x0_set_ts(&b.chip, 3, 0.0); /* a sensor that is gone */
    host(5000, true);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    part_is_silent();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_voltage_limits_of_the_host);
    RUN_TEST(test_what_the_part_does_not_look_at);
    return UNITY_END();
}
