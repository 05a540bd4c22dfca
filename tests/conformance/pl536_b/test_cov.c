/* SPDX-License-Identifier: Apache-2.0 */
/* Overvoltage and undervoltage comparators: PL-COV, PL-CUV, their ambiguities and code tables. */
#include "rig.h"

/* The same behaviour mirrored: `bad` volts trips code `code`, `mid` lies inside the hysteresis, `good`
 * releases. */
struct side {
    int threshold, delay, cells, flag, code;
    double bad, mid, good;
    void (*arm)(int code, int delay);
};

static const struct side sides[2] = {
    {C_COV, C_COVT, R_COV, 0x01, 0x2c, 4.21, 4.17, 4.14, rig_cov}, /* 4.20 V */
    {C_CUV, C_CUVT, R_CUV, 0x02, 0x15, 2.79, 2.85, 2.91, rig_cuv}, /* 2.8 V */
};

static void cell(int n, double volts)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_cell(&rig, 1, n, volts));
}

static void expect(const struct side *s, int cells, int flag)
{
    EXPECT(cells, 1, s->cells);
    EXPECT(flag ? s->flag : 0, 1, R_FAULT);
    EXPECT(flag ? 0xc1 : 0x81, 1, R_STATUS);
    EXPECT(0, 1, R_ALERT);
    TEST_ASSERT_EQUAL_INT(flag != 0, sim_pl_fault_pin(&rig));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&rig));
}

/* proves: PL-COV-02, PL-COV-04, PL-COV-05, PL-CUV-02, PL-CUV-04, PL-FLT-20, PL-AMB-39 */
static void a_cell_trips_after_its_delay(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        for (int n = 1; n <= 6; n++) {
            rig_ready(1);
            s->arm(s->code, 0x05); /* 500 us */
            rig_ms(5);
            expect(s, 0, 0);
            cell(n, s->bad);
            rig_us(499);
            expect(s, 0, 0);
            rig_us(2);
            expect(s, 1 << (n - 1), 1);
            EXPECT(0, 1, s == sides ? R_CUV : R_COV);
            EXPECT_CLEAN();
        }
    }
}

/* proves: PL-COV-03, PL-CUV-03, PL-NUM-15, PL-COV-06, PL-CUV-05, PL-AMB-42 */
static void hysteresis_seen_through_the_unlatched_flag(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x00);
        cell(2, s->mid);
        rig_us(1);
        expect(s, 0, 0); /* the band is entered from the good side */
        cell(2, s->bad);
        rig_us(1);
        expect(s, 0x02, 1);
        cell(2, s->mid);
        rig_us(1);
        expect(s, 0x02, 1);
        cell(2, s->good);
        rig_us(1);
        expect(s, 0, 0);
    }
}

/* proves: PL-COV-06, PL-CUV-05, PL-FLT-11, PL-COV-07, PL-CUV-06, PL-AMB-40, PL-AMB-34 */
static void a_latched_flag_waits_for_the_host(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x01);
        cell(1, s->bad);
        cell(6, s->bad);
        rig_ms(1);
        expect(s, 0x21, 1);
        cell(1, s->good);
        cell(6, s->good);
        rig_s(3);
        expect(s, 0x21, 1);
        rig_write(1, R_FAULT, 0); /* writing 0 leaves it */
        expect(s, 0x21, 1);
        rig_write(1, R_FAULT, s->flag ^ 0x03); /* so does the neighbour's bit */
        expect(s, 0x21, 1);
        rig_clear(1, R_FAULT, s->flag);
        expect(s, 0, 0);
        rig_s(3);
        expect(s, 0, 0);
    }
}

/* proves: PL-COV-08, PL-CUV-06, PL-FLT-12, PL-AMB-42 */
static void the_flag_returns_after_the_whole_delay(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x0a); /* 1 ms */
        cell(3, s->bad);
        rig_ms(2);
        cell(3, s->mid); /* not released: the cause is still there */
        for (int again = 0; again < 3; again++) {
            expect(s, 0x04, 1);
            rig_clear(1, R_FAULT, s->flag);
            rig_us(999);
            expect(s, 0, 0);
            rig_us(2);
        }
        expect(s, 0x04, 1);
    }
}

/* proves: PL-COV-09, PL-COV-02, PL-CUV-02 */
static void an_interruption_restarts_the_delay(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x0a);
        cell(4, s->bad);
        rig_us(900);
        cell(4, s->mid); /* no release, the delay goes on */
        rig_us(50);
        cell(4, s->good);
        rig_us(10);
        cell(4, s->bad);
        rig_us(999);
        expect(s, 0, 0);
        rig_us(2);
        expect(s, 0x08, 1);
        rig_clear(1, R_FAULT, s->flag);
        cell(4, s->good);
        rig_ms(5);
        cell(4, s->bad);
        rig_us(900);
        cell(4, s->mid);
        rig_us(101);
        expect(s, 0x08, 1);
    }
}

/* proves: PL-AMB-41, PL-FLT-01, PL-FLT-05, PL-COV-05 */
static void every_cell_has_its_own_delay(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x0a);
        for (int n = 1; n <= 6; n++) {
            cell(n, s->bad);
            rig_us(100);
        }
        rig_us(399); /* 999 us after the first */
        expect(s, 0, 0);
        for (int n = 1; n <= 6; n++) {
            rig_us(2);
            expect(s, (1 << n) - 1, 1);
            rig_us(97);
            expect(s, (1 << n) - 1, 1);
            rig_us(1);
        }
    }
}

/* proves: PL-FLT-01, PL-COV-15 */
static void both_sides_run_at_the_same_time(void)
{
    rig_ready(1);
    rig_shadow(1, C_COV, 0x2c);
    rig_shadow(1, C_CUV, 0x15);
    rig_shadow(1, C_COVT, 0x05);
    rig_shadow(1, C_CUVT, 0x0a);
    rig_write(1, R_CBT, 10);
    rig_write(1, R_CB, 0x3f); /* neither balancing nor conversions enter */
    rig_adc(1, 0x45, 0x40);
    cell(1, 4.5);
    cell(2, 1.0);
    rig_us(400);
    rig_write(1, R_CONV, 1);
    rig_us(99);
    EXPECT(0, 1, R_FAULT);
    rig_us(2);
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0x01, 1, R_COV);
    rig_us(498);
    EXPECT(0x01, 1, R_FAULT);
    rig_us(2);
    EXPECT(0x03, 1, R_FAULT);
    EXPECT(0x02, 1, R_CUV);
    rig_write(1, R_FAULT, 0x02);
    EXPECT(0x01, 1, R_FAULT);
    EXPECT(0x01, 1, R_COV);
    EXPECT_CLEAN();
}

/* proves: PL-COV-10, PL-CUV-09, PL-NUM-36 */
static void cn_masks_from_the_top(void)
{
    static const int seen[4] = {0x3f, 0x1f, 0x0f, 0x07};
    for (int cn = 0; cn < 4; cn++) {
        for (const struct side *s = sides; s < sides + 2; s++) {
            rig_ready(1);
            rig_shadow(1, C_FUNC, cn << 2);
            sim_pl_set_vbat(&rig, 1, 21.6); /* the part itself stays alive */
            for (int n = 1; n <= 6; n++) {
                cell(n, s == sides ? 5.0 : 0.0);
            }
            s->arm(s->code, 0x01);
            rig_ms(1);
            expect(s, seen[cn], 1);
        }
    }
    rig_ready(1);
    rig_shadow(1, C_FUNC, 0x0c);
    rig_cov(0x2c, 0x01);
    cell(4, 5.0);
    rig_s(1);
    expect(sides, 0, 0);
}

/* proves: PL-AMB-44, PL-COV-06, PL-CUV-05 */
static void count_zero_is_unlatched_whatever_the_unit(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x80);
        cell(1, s->bad);
        rig_us(1);
        expect(s, 0x01, 1);
        cell(1, s->good);
        rig_us(1);
        expect(s, 0, 0);
    }
}

/* proves: PL-COV-01, PL-CUV-01 */
static void disable_switches_the_function_off(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code | 0x80, 0x01);
        cell(1, s->bad);
        rig_s(1);
        expect(s, 0, 0);
        rig_shadow(1, s->threshold, s->code);
        rig_us(99);
        expect(s, 0, 0);
        rig_us(2);
        expect(s, 0x01, 1);
    }
}

/* proves: PL-COV-14, PL-AMB-46, PL-G3-12 */
static void settings_changed_at_run_time(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        int harmless = s == sides ? 0x30 : 0x10; /* 4.40 V, 2.3 V */
        rig_ready(1);
        s->arm(harmless, 0x0a);
        cell(1, s->bad);
        rig_ms(5);
        expect(s, 0, 0);
        rig_shadow(1, s->threshold, s->code); /* the new threshold acts at once */
        rig_us(999);
        expect(s, 0, 0);
        rig_us(2);
        expect(s, 0x01, 1);
        rig_shadow(1, s->threshold, harmless); /* a latched flag stays */
        rig_ms(5);
        expect(s, 0x01, 1);
        rig_shadow(1, s->threshold, 0x80 | s->code);
        expect(s, 0x01, 1);
        rig_clear(1, R_FAULT, s->flag);
        rig_ms(5);
        expect(s, 0, 0);
        rig_shadow(1, s->threshold, s->code);
        rig_us(500);
        rig_shadow(1, s->threshold, 0x80 | s->code); /* a running delay is dropped */
        rig_ms(5);
        expect(s, 0, 0);
        rig_shadow(1, s->threshold, s->code);
        rig_us(999);
        expect(s, 0, 0);
        rig_us(2);
        expect(s, 0x01, 1);
    }
}

/* proves: PL-AMB-46 */
static void a_new_delay_counts_from_the_next_crossing(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready(1);
        s->arm(s->code, 0x14); /* 2 ms */
        cell(1, s->bad);
        rig_us(500);
        rig_shadow(1, s->delay, 0x0a); /* 1 ms */
        rig_us(1499);
        expect(s, 0, 0);
        rig_us(2);
        expect(s, 0x01, 1);
        cell(1, s->good);
        rig_clear(1, R_FAULT, s->flag);
        cell(1, s->bad);
        rig_us(500);
        rig_shadow(1, s->delay, 0x00); /* a change to 0 follows the comparator at once */
        rig_us(1);
        expect(s, 0x01, 1);
        cell(1, s->good);
        rig_us(1);
        expect(s, 0, 0);
        cell(1, s->bad);
        rig_us(1);
        rig_shadow(1, s->threshold, 0x80 | s->code); /* disabled: an unlatched flag goes */
        rig_us(1);
        expect(s, 0, 0);
        rig_shadow(1, s->threshold, s->code);
        cell(1, s->good);
        cell(6, s->bad);
        rig_us(1);
        expect(s, 0x20, 1);
        rig_shadow(1, C_FUNC, 0x04); /* masked: likewise */
        rig_us(1);
        expect(s, 0, 0);
    }
}

/* proves: PL-AMB-40 */
static void option_cell_bits_stay_until_the_comparator_releases(void)
{
    const sim_pl_options o = {.amb40_sticky_cells = true};
    for (const struct side *s = sides; s < sides + 2; s++) {
        rig_ready_with(1, &o);
        s->arm(s->code, 0x0a);
        cell(2, s->bad);
        rig_ms(2);
        expect(s, 0x02, 1);
        rig_clear(1, R_FAULT, s->flag);
        expect(s, 0x02, 0);
        cell(2, s->good);
        rig_us(1);
        expect(s, 0, 0);
    }
}

/* proves: PL-COV-13, PL-CUV-02 */
static void comparators_are_off_in_sleep_uvlo_and_tsd(void)
{
    for (const struct side *s = sides; s < sides + 2; s++) {
        for (int state = 0; state < 3; state++) {
            rig_ready(1);
            s->arm(s->code, 0x01);
            if (state == 0) {
                rig_write(1, R_IO, 0x04);
            } else if (state == 1) {
                sim_pl_set_vbat(&rig, 1, 5.2);
            } else {
                sim_pl_set_tdie(&rig, 1, 150.0);
            }
            rig_ms(1);
            cell(1, s->bad);
            rig_s(5);
            EXPECT(0, 1, s->cells);
            EXPECT(0, 1, R_FAULT);
            sim_pl_set_vbat(&rig, 1, -1.0);
            sim_pl_set_tdie(&rig, 1, 25.0);
            rig_us(1);
            rig_write(1, R_IO, 0x00);
            rig_ms(2);
            EXPECT(0x01, 1, s->cells);
        }
    }
}

/* proves: PL-COV-12, PL-AMB-45 */
static void the_judge_sees_illegal_thresholds(void)
{
    rig_ready(1);
    rig_shadow(1, C_COV, 0x1f); /* 3.55 V */
    EXPECT_CLEAN();
    rig_shadow(1, C_CUV, 0x1a); /* 3.3 V: 250 mV below */
    EXPECT_MISUSE("PL-COV-12");
    rig_ready(1);
    rig_shadow(1, C_COV, 0x20);
    rig_shadow(1, C_CUV, 0x1a);
    EXPECT_CLEAN();
    for (int code = 0x3d; code <= 0x3f; code++) {
        rig_ready(1);
        rig_shadow(1, C_COV, code);
        EXPECT_MISUSE("PL-AMB-45");
        cell(1, 5.0); /* acts as 5.00 V */
        rig_us(1);
        EXPECT(0, 1, R_COV);
        cell(1, 5.001);
        rig_us(1);
        EXPECT(1, 1, R_COV);
    }
    for (int code = 0x1b; code <= 0x1f; code++) {
        rig_ready(1);
        rig_shadow(1, C_CUV, code);
        EXPECT_MISUSE("PL-AMB-45");
        cell(1, 3.3);
        rig_us(1);
        EXPECT(0, 1, R_CUV);
        cell(1, 3.299);
        rig_us(1);
        EXPECT(1, 1, R_CUV);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_cell_trips_after_its_delay);
    RUN_TEST(hysteresis_seen_through_the_unlatched_flag);
    RUN_TEST(a_latched_flag_waits_for_the_host);
    RUN_TEST(the_flag_returns_after_the_whole_delay);
    RUN_TEST(an_interruption_restarts_the_delay);
    RUN_TEST(every_cell_has_its_own_delay);
    RUN_TEST(both_sides_run_at_the_same_time);
    RUN_TEST(cn_masks_from_the_top);
    RUN_TEST(count_zero_is_unlatched_whatever_the_unit);
    RUN_TEST(disable_switches_the_function_off);
    RUN_TEST(settings_changed_at_run_time);
    RUN_TEST(a_new_delay_counts_from_the_next_crossing);
    RUN_TEST(option_cell_bits_stay_until_the_comparator_releases);
    RUN_TEST(comparators_are_off_in_sleep_uvlo_and_tsd);
    RUN_TEST(the_judge_sees_illegal_thresholds);
    return UNITY_END();
}
