/* SPDX-License-Identifier: Apache-2.0 */
/* Cell balancing: PL-CB and the ambiguities of its timer. */
#include "rig.h"

static void expect(int outputs, int cbt)
{
    TEST_ASSERT_EQUAL_HEX8(outputs, sim_pl_cb(&rig, 1));
    TEST_ASSERT_EQUAL_HEX8(cbt ? 0x02 : 0x00, rig_read(1, R_STATUS) & 0x02);
}

/* proves: PL-CB-01, PL-CB-09, PL-CB-17, PL-CB-05, PL-AMB-88, PL-AMB-82 */
static void outputs_follow_the_bits_while_the_timer_runs(void)
{
    rig_ready(1);
    expect(0, 0);
    for (int mask = 1; mask < 64; mask++) {
        rig_write(1, R_CBT, 5);
        rig_write(1, R_CB, mask);
        expect(mask, 1);
        EXPECT(mask, 1, R_CB);
        rig_write(1, R_CB, 0);
        expect(0, 0);
    }
    EXPECT_CLEAN();
    rig_write(1, R_CB, 0xc1);
    EXPECT(0x01, 1, R_CB);
    rig_write(1, R_CBT, 0x7f);
    EXPECT(0x3f, 1, R_CBT);
    rig_write(1, R_CBT, 0xff);
    EXPECT(0xbf, 1, R_CBT);
    EXPECT_MISUSE("PL-REG-02", "PL-CB-17");
}

/* proves: PL-CB-02, PL-CB-06, PL-CB-08, PL-NUM-32, PL-TIM-25, PL-AMB-84 */
static void every_period(void)
{
    for (int code = 0; code < 256; code++) {
        uint64_t s = (uint64_t)(code & 0x3f) * (code & 0x80 ? 60 : 1);
        if (code & 0x40) {
            continue;
        }
        rig_ready(1);
        rig_write(1, R_CBT, code);
        EXPECT(code, 1, R_CBT);
        rig_write(1, R_CB, 0x15);
        if (s == 0) {
            expect(0, 0);
            EXPECT(0x15, 1, R_CB);
            continue;
        }
        rig_us(s * 1000000 - 1);
        expect(0x15, 1);
        rig_us(2);
        expect(0, 0);
        EXPECT(0x15, 1, R_CB); /* the register stays */
        EXPECT(code, 1, R_CBT);
        rig_write(1, R_CB, 0x3f); /* non-zero to non-zero starts nothing */
        expect(0, 0);
        rig_write(1, R_CB, 0x00);
        rig_write(1, R_CB, 0x2a);
        rig_us(s * 1000000 - 1);
        expect(0x2a, 1); /* the full period again */
        rig_us(2);
        expect(0, 0);
    }
}

/* proves: PL-CB-03, PL-CB-05, PL-NUM-33 */
static void the_zero_restarts_the_period(void)
{
    rig_ready(1);
    rig_write(1, R_CBT, 30);
    rig_write(1, R_CB, 0x02);
    rig_s(10);
    rig_write(1, R_CB, 0x00);
    expect(0, 0);
    rig_write(1, R_CB, 0x02);
    rig_s(20);
    rig_ms(1);
    expect(0x02, 1);
    rig_us(9998999);
    expect(0x02, 1);
    rig_us(2);
    expect(0, 0);
}

/* proves: PL-CB-04, PL-CB-07, PL-NUM-33, PL-AMB-83 */
static void a_change_does_not_restart_it(void)
{
    rig_ready(1);
    rig_write(1, R_CBT, 30);
    rig_write(1, R_CB, 0x02);
    rig_s(10);
    rig_write(1, R_CB, 0x03);
    expect(0x03, 1);
    rig_s(10);
    rig_write(1, R_CB, 0x20);
    expect(0x20, 1);
    rig_us(9999999);
    expect(0x20, 1);
    rig_us(2);
    expect(0, 0);
}

/* proves: PL-AMB-83 */
static void option_any_new_bit_restarts_it(void)
{
    const sim_pl_options o = {.amb83_any_rise = true};
    rig_ready_with(1, &o);
    rig_write(1, R_CBT, 30);
    rig_write(1, R_CB, 0x02);
    rig_s(10);
    rig_write(1, R_CB, 0x03);
    rig_s(10);
    rig_write(1, R_CB, 0x01); /* nothing rises */
    rig_us(19999999);
    expect(0x01, 1);
    rig_us(2);
    expect(0, 0);
}

/* proves: PL-AMB-84 */
static void option_expiry_clears_the_register(void)
{
    const sim_pl_options o = {.amb84_clear_cbctrl = true};
    rig_ready_with(1, &o);
    rig_write(1, R_CBT, 1);
    rig_write(1, R_CB, 0x3f);
    rig_us(1000001);
    expect(0, 0);
    EXPECT(0x00, 1, R_CB);
    rig_write(1, R_CB, 0x01);
    expect(0x01, 1);
}

/* proves: PL-CB-10, PL-AMB-85 */
static void the_period_rewritten(void)
{
    rig_ready(1);
    rig_write(1, R_CBT, 10);
    rig_write(1, R_CB, 0x01);
    rig_s(5);
    rig_write(1, R_CBT, 20); /* the running period goes on */
    rig_us(4999999);
    expect(0x01, 1);
    rig_us(2);
    expect(0, 0);
    rig_write(1, R_CB, 0);
    rig_write(1, R_CB, 1);
    rig_us(19999999);
    expect(0x01, 1);
    rig_us(2);
    expect(0, 0);
    rig_write(1, R_CB, 0);
    rig_write(1, R_CB, 1);
    rig_s(1);
    rig_write(1, R_CBT, 0x80); /* a count of zero ends it at once */
    expect(0, 0);
    rig_write(1, R_CBT, 20);
    expect(0, 0);
    rig_write(1, R_CB, 0);
    rig_write(1, R_CBT, 0);
    rig_write(1, R_CB, 0x01); /* starts nothing, not even later */
    rig_write(1, R_CBT, 20);
    expect(0, 0);
    rig_write(1, R_CB, 0x03);
    expect(0, 0);
}

/* proves: PL-CB-11, PL-UVLO-02, PL-POR-13 */
static void uvlo_and_reset_end_it(void)
{
    rig_ready(1);
    rig_write(1, R_CBT, 30);
    rig_write(1, R_CB, 0x3f);
    sim_pl_set_vbat(&rig, 1, 5.2);
    rig_us(20);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&rig, 1));
    EXPECT(0x00, 1, R_CB);
    EXPECT(30, 1, R_CBT);
    sim_pl_set_vbat(&rig, 1, -1.0);
    rig_ms(1);
    expect(0, 0);
    rig_write(1, R_CB, 0x3f);
    expect(0x3f, 1);
    rig_reset(1);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&rig, 1));
    EXPECT(0x00, 0, R_CB);
    EXPECT(0x00, 0, R_CBT);
}

/* proves: PL-CB-12, PL-AMB-86 */
static void sleep_and_tsd_under_both_readings(void)
{
    for (int option = 0; option <= 1; option++) {
        for (int tsd = 0; tsd <= 1; tsd++) {
            const sim_pl_options o = {.amb86_sleep_stops_cb = option != 0};
            rig_ready_with(1, &o);
            rig_write(1, R_CBT, 10);
            rig_write(1, R_CB, 0x21);
            rig_s(1);
            if (tsd) {
                sim_pl_set_tdie(&rig, 1, 150);
            } else {
                rig_write(1, R_IO, 0x04);
            }
            rig_us(1);
            TEST_ASSERT_EQUAL_HEX8(option ? 0 : 0x21, sim_pl_cb(&rig, 1));
            rig_us(8999998 - 1);
            TEST_ASSERT_EQUAL_HEX8(option ? 0 : 0x21, sim_pl_cb(&rig, 1));
            rig_us(3);
            TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&rig, 1));
        }
    }
}

/* proves: PL-CB-02, PL-TIM-25 */
static void the_tolerance_scales_the_timer(void)
{
    sim_pl_options o = {.delay_percent = -10};
    rig_ready_with(1, &o);
    rig_write(1, R_CBT, 10);
    rig_write(1, R_CB, 0x01);
    rig_us(8999990);
    expect(1, 1);
    rig_us(20);
    expect(0, 0);
    o.delay_percent = 10;
    rig_ready_with(1, &o);
    rig_write(1, R_CBT, 10);
    rig_write(1, R_CB, 0x01);
    rig_us(10999990);
    expect(1, 1);
    rig_us(20);
    expect(0, 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(outputs_follow_the_bits_while_the_timer_runs);
    RUN_TEST(every_period);
    RUN_TEST(the_zero_restarts_the_period);
    RUN_TEST(a_change_does_not_restart_it);
    RUN_TEST(option_any_new_bit_restarts_it);
    RUN_TEST(option_expiry_clears_the_register);
    RUN_TEST(the_period_rewritten);
    RUN_TEST(uvlo_and_reset_end_it);
    RUN_TEST(sleep_and_tsd_under_both_readings);
    RUN_TEST(the_tolerance_scales_the_timer);
    return UNITY_END();
}
