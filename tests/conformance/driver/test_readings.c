/* SPDX-License-Identifier: Apache-2.0 */
/* The driver under every reading of the ambiguous facts: a whole life each time, and never a forbidden act.
 */
#include "bench.h"

/* One option after the other; 0 = none. Returns false when there is no such option. */
static bool reading(int k, sim_pl_options *o)
{
    memset(o, 0, sizeof *o);
    switch (k) {
    case 0:
        return true;
    case 1:
        o->variant_a = true;
        return true;
    case 2:
        o->noise_uv_rms = 250;
        o->cell_offset_uv_max = 2500;
        o->seed = 5;
        return true;
    case 3:
        o->delay_percent = -12;
        return true;
    case 4:
        o->delay_percent = 10;
        return true;
    case 5:
        o->deglitch = true;
        return true;
    case 6:
        o->strict_timing = true;
        return true;
    case 7:
        o->amb12_idle_ff = true;
        return true;
    case 8:
        o->amb26_needs_bit7 = true;
        return true;
    case 9:
        o->amb33_hold_until_zero = true;
        return true;
    case 10:
        o->amb40_sticky_cells = true;
        return true;
    case 11:
        o->amb49_no_ifault = true;
        return true;
    case 12:
        o->amb54_reset_no_por = true;
        return true;
    case 13:
        o->amb78_drdy_zero = true;
        return true;
    case 14:
        o->amb79_drdy_base_only = true;
        return true;
    case 15:
        o->amb83_any_rise = true;
        return true;
    case 16:
        o->amb84_clear_cbctrl = true;
        return true;
    case 17:
        o->amb86_sleep_stops_cb = true;
        return true;
    case 18:
        o->amb100_user_readonly = true;
        return true;
    case 19: /* everything at once */
        *o = (sim_pl_options){.seed = 9,
                              .noise_uv_rms = 200,
                              .cell_offset_uv_max = 2000,
                              .delay_percent = 10,
                              .deglitch = true,
                              .strict_timing = true,
                              .amb12_idle_ff = true,
                              .amb26_needs_bit7 = true,
                              .amb33_hold_until_zero = true,
                              .amb40_sticky_cells = true,
                              .amb49_no_ifault = true,
                              .amb54_reset_no_por = true,
                              .amb78_drdy_zero = true,
                              .amb79_drdy_base_only = true,
                              .amb83_any_rise = true,
                              .amb84_clear_cbctrl = true,
                              .amb86_sleep_stops_cb = true,
                              .amb100_user_readonly = true};
        return true;
    default:
        return false;
    }
}

static void expect_fresh(int devices)
{
    bench_sample();
    TEST_ASSERT_EQUAL_INT(6 * devices, b.sample.cell_count);
    for (int d = 1; d <= devices; d++) {
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(d)->faults);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, MODULE(d)->quality);
        TEST_ASSERT_INT_WITHIN(25, 21600, MODULE(d)->stack_mv);
        TEST_ASSERT_TRUE(MODULE(d)->age_ms < 100);
        for (int c = 1; c <= 6; c++) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(d, c)->quality);
            TEST_ASSERT_INT_WITHIN(6, 3600, CELL(d, c)->mv);
        }
        for (int t = 0; t < 2; t++) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.sample.temps[(d - 1) * 2 + t].quality);
            TEST_ASSERT_INT_WITHIN(5, 250, b.sample.temps[(d - 1) * 2 + t].dc);
        }
    }
}

static void balance(void)
{
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x15));
    TEST_ASSERT_EQUAL_HEX8(0x15, sim_pl_cb(&b.pl, 2));
    bench_wait_ms(500);
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(0x15, (bench_sample(), MODULE(2)->balancing));
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x00));
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_cb(&b.pl, d));
    }
}

static void fault(void)
{
    sim_pl_set_cell(&b.pl, 3, 6, 4.4);
    bench_wait_ms(700);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults);
    TEST_ASSERT_EQUAL_HEX16(0x20, MODULE(3)->cell_ov);
    sim_pl_set_cell(&b.pl, 3, 6, 3.6);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults); /* until it is acknowledged */
    EXPECT_STATUS(BQ_OK, bench_acknowledge());
    bench_wait_ms(700);
    EXPECT_STATUS(BQ_OK, bench_scan());
    expect_fresh(3);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&b.pl));
}

static void life(bool pin)
{
    b.config.use_conv_pin = pin;
    bench_ready_from();
    expect_fresh(3);
    for (int i = 0; i < 3; i++) {
        uint32_t sequence = b.sample.sequence;
        EXPECT_STATUS(BQ_OK, bench_scan());
        expect_fresh(3);
        TEST_ASSERT_EQUAL_UINT32(sequence + 1, b.sample.sequence);
    }
    balance();
    fault();
    EXPECT_STATUS(BQ_OK, bench_self_test());
    EXPECT_STATUS(BQ_OK, bench_sleep());
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&b.pl, d));
    }
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&b.pl));
    bench_wait_ms(60000);
    EXPECT_STATUS(BQ_OK, bench_wake());
    EXPECT_STATUS(BQ_OK, bench_scan());
    expect_fresh(3);
    bench_no_misuse();
    bench_judge_packets();
}

/* proves: PL-AMB-12, PL-AMB-26, PL-AMB-33, PL-AMB-40, PL-AMB-49, PL-AMB-54, PL-AMB-78, PL-AMB-79, PL-AMB-83,
 * PL-AMB-84, PL-AMB-86, PL-AMB-100, PL-FLT-04, PL-SPI-04, PL-TIM-04, PL-CONV-05, PL-ADC-13, PL-REG-02,
 * PL-AMB-35 */
static void a_whole_life_under_every_reading(void)
{
    sim_pl_options o;
    for (int k = 0; reading(k, &o); k++) {
        for (int variant = 0; variant < 4; variant++) {
            bench_up(3, &o);
            b.no_lines = (variant & 1) != 0;
            b.clock_offset_us = variant & 2 ? 0xffffffffu - 300000u : 0; /* the clock wraps on the way */
            life((variant & 1) == 0 && k % 2 == 0);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_whole_life_under_every_reading);
    return UNITY_END();
}
