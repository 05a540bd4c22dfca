/* SPDX-License-Identifier: Apache-2.0 */
/* Overvoltage and undervoltage: thresholds, delays, timers, latches. */
#include "rig.h"

#define OV 0x04
#define UV 0x08
#define CHG 0x01
#define DSG 0x02

/* A part whose trims and OV_TRIP, UV_TRIP are these, delays bypassed, every input at `code`. */
static int flags_at(int gain, int offset, int ov_trip, int uv_trip, int code)
{
    rig_pulse("bq7692000");
    (void)sim_x0_set_gain(&chip, gain);
    (void)sim_x0_set_offset(&chip, offset);
    rig_at(20);
    TEST_ASSERT_TRUE(rig_block_write(0x09, (uint8_t[]){(uint8_t)ov_trip, (uint8_t)uv_trip}, 2));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x80));
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, code * gain * 1e-6 + offset * 1e-3);
    }
    rig_at(260);
    TEST_ASSERT_EQUAL(code, rig_read16(0x0c));
    return rig_read(0x00);
}

/*
 * proves: X0-NUM-501, X0-NUM-502, X0-NUM-503, X0-NUM-504, X0-NUM-505, X0-NUM-506, X0-NUM-513, X0-NUM-514,
 *     X0-NUM-515, X0-NUM-516, X0-NUM-517, X0-NUM-518, X0-NUM-519, X0-NUM-520, X0-NUM-521, X0-NUM-522,
 *     X0-NUM-523, X0-NUM-524, X0-NUM-525, X0-NUM-526, X0-NUM-527, X0-OV-01, X0-OV-02, X0-OV-03, X0-OV-06,
 *     X0-AMB-35, X0-AMB-37, X0-AMB-38, X0-AMB-04
 */
static void test_every_overvoltage_vector(void)
{
    static const struct {
        int gain, offset, trip, code;
        double mv;
    } c[] = {
        {382, 0, 0x00, 0x2008, 3132.4},     {380, 30, 0x00, 0x2008, 3146},
        {382, 0, 0xac, 0x2ac8, 4183.664},   {380, 30, 0xac, 0x2ac8, 4191.76},
        {382, 0, 0xbe, 0x2be8, 4293.68},    {380, 30, 0xbe, 0x2be8, 4301.2},
        {382, 0, 0xbf, 0x2bf8, 4299.792},   {380, 30, 0xbf, 0x2bf8, 4307.28},
        {382, 0, 0xc9, 0x2c98, 4360.912},   {380, 30, 0xc9, 0x2c98, 4368.08},
        {382, 0, 0xff, 0x2ff8, 4690.96},    {380, 30, 0xff, 0x2ff8, 4696.4},
        {382, 0, 0xb7, 0x2b78, 4250.896},   {382, 0, 0xaf, 0x2af8, 4202},
        {382, 0, 0x55, 0x2558, 3651.92},    {380, 30, 0xad, 0x2ad8, 4197.84},
        {377, -1, 0xc9, 0x2c98, 4302.832},  {377, 48, 0x9f, 0x29f8, 4098.488},
        {371, 62, 0xc9, 0x2c98, 4297.336},  {372, 54, 0xc9, 0x2c98, 4300.752},
        {365, 0, 0xe0, 0x2e08, 4301.16},    {396, 0, 0xa6, 0x2a68, 4298.976},
        {365, -128, 0xf6, 0x2f68, 4301.64}, {396, 127, 0x92, 0x2928, 4299.256},
        {396, 127, 0xd9, 0x2d98, 4749.112},
    };
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.0006, c[i].mv, c[i].code * c[i].gain * 1e-3 + c[i].offset);
        TEST_ASSERT_EQUAL_HEX8(0x00, flags_at(c[i].gain, c[i].offset, c[i].trip, 0x00, c[i].code));
        TEST_ASSERT_EQUAL_HEX8(OV, flags_at(c[i].gain, c[i].offset, c[i].trip, 0x00, c[i].code + 1));
    }
}

/*
 * proves: X0-NUM-507, X0-NUM-508, X0-NUM-509, X0-NUM-510, X0-NUM-511, X0-NUM-512, X0-NUM-531, X0-NUM-532,
 *     X0-NUM-533, X0-NUM-534, X0-NUM-535, X0-NUM-536, X0-NUM-537, X0-NUM-538, X0-NUM-539, X0-NUM-540,
 *     X0-NUM-541, X0-NUM-542, X0-NUM-543, X0-UV-01, X0-UV-02, X0-UV-03, X0-UV-06, X0-AMB-36, X0-AMB-37,
 *     X0-AMB-39, X0-AMB-03
 */
static void test_every_undervoltage_vector(void)
{
    static const struct {
        int gain, offset, trip, code;
        double mv;
    } c[] = {
        {382, 0, 0x00, 0x1000, 1564.672}, {380, 30, 0x00, 0x1000, 1586.48},
        {382, 0, 0x1a, 0x11a0, 1723.584}, {380, 30, 0x1a, 0x11a0, 1744.56},
        {382, 0, 0x97, 0x1970, 2487.584}, {380, 30, 0x97, 0x1970, 2504.56},
        {382, 0, 0x99, 0x1990, 2499.808}, {380, 30, 0x99, 0x1990, 2516.72},
        {382, 0, 0x9a, 0x19a0, 2505.92},  {380, 30, 0x9a, 0x19a0, 2522.8},
        {382, 0, 0xff, 0x1ff0, 3123.232}, {380, 30, 0xff, 0x1ff0, 3136.88},
        {382, 0, 0xca, 0x1ca0, 2799.296}, {382, 0, 0xea, 0x1ea0, 2994.88},
        {382, 0, 0x47, 0x1470, 1998.624}, {380, 30, 0x96, 0x1960, 2498.48},
        {380, 30, 0xe8, 0x1e80, 2997.04}, {377, -1, 0x9e, 0x19e0, 2496.248},
        {371, 62, 0x9a, 0x19a0, 2495.76}, {372, 54, 0x9a, 0x19a0, 2494.32},
        {365, 0, 0xac, 0x1ac0, 2499.52},  {396, 0, 0x8a, 0x18a0, 2496.384},
        {365, -128, 0xc2, 0x1c20, 2500},  {396, 127, 0x76, 0x1760, 2496.664},
    };
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.0006, c[i].mv, c[i].code * c[i].gain * 1e-3 + c[i].offset);
        TEST_ASSERT_EQUAL_HEX8(0x00, flags_at(c[i].gain, c[i].offset, 0xff, c[i].trip, c[i].code));
        TEST_ASSERT_EQUAL_HEX8(UV, flags_at(c[i].gain, c[i].offset, 0xff, c[i].trip, c[i].code - 1));
    }
    TEST_ASSERT_EQUAL_HEX8(UV, flags_at(382, 0, 0xff, 0xff, 0x0518)); /* still a cell */
    TEST_ASSERT_EQUAL_HEX8(0x00, flags_at(382, 0, 0xff, 0xff, 0x0517));
}

/* All 256 codes of either register. */
static void test_every_threshold_code(void)
{
    for (int trip = 0; trip < 256; trip++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, flags_at(382, 0, trip, 0x00, 0x2000 + 16 * trip + 8));
        TEST_ASSERT_EQUAL_HEX8(OV, flags_at(382, 0, trip, 0x00, 0x2000 + 16 * trip + 9));
        TEST_ASSERT_EQUAL_HEX8(0x00, flags_at(382, 0, 0xff, trip, 0x1000 + 16 * trip));
        TEST_ASSERT_EQUAL_HEX8(UV, flags_at(382, 0, 0xff, trip, 0x1000 + 16 * trip - 1));
    }
}

/* Booted, FETs on, at 900 ms; the other inputs stay inside. */
static void prepare(const char *part, const sim_x0_options *options, int protect3)
{
    rig_boot_with(part, options);
    rig_at(900);
    TEST_ASSERT_TRUE(rig_write(0x08, protect3));
    TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
}

/* SYS_STAT becomes `flag` at `at` ms and not 1 us before. */
static void comes_at(int flag, double at)
{
    rig_at(at - 0.001);
    expect_stat(0x00);
    expect_reg(0x05, CHG | DSG);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    rig_at(at);
    expect_stat(flag);
    expect_reg(0x05, flag == OV ? DSG : CHG);
    TEST_ASSERT_EQUAL(flag != OV, sim_x0_chg(&chip));
    TEST_ASSERT_EQUAL(flag == OV, sim_x0_dsg(&chip));
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
}

static void trips_for_every_input(const rig_part *p)
{
    double grid;
    for (int flag = OV; flag <= UV; flag += UV - OV) {
        for (int i = 1; i <= p->inputs; i++) {
            prepare(p->name, NULL, 0x00);
            grid = rig_first_ms() == 260 ? 1010 : rig_first_ms() == 410 ? 1160 : 1060;
            rig_at(1000);
            (void)sim_x0_set_cell(&chip, i, flag == OV ? 4.3 : 2.0);
            comes_at(flag, grid + 1000);
        }
    }
}

/*
 * proves: X0-OV-06, X0-UV-06, X0-OV-09, X0-UV-10, X0-FET-03, X0-FET-04, X0-OV-08, X0-UV-09, X0-FET-12,
 *     X0-BIT-07, X0-SCH-08
 */
static void test_every_input_of_every_part_trips(void)
{
    rig_each(trips_for_every_input);
}

/*
 * proves: X0-OV-04, X0-OV-05, X0-UV-04, X0-UV-05, X0-TIM-10, X0-NUM-547, X0-NUM-548, X0-NUM-549, X0-OV-08,
 *     X0-UV-09, X0-AMB-41
 */
static void test_all_sixteen_delay_pairs(void)
{
    static const int ov_s[4] = {1, 2, 4, 8}, uv_s[4] = {1, 4, 8, 16};
    for (int uv = 0; uv < 4; uv++) {
        for (int ov = 0; ov < 4; ov++) {
            prepare("bq7692003", NULL, (uv * 4 + ov) * 16);
            rig_at(1000);
            (void)sim_x0_set_cell(&chip, 3, 4.3);
            comes_at(OV, 1010 + 1000 * ov_s[ov]); /* inside the tolerance plus one scan */
            prepare("bq7692003", NULL, (uv * 4 + ov) * 16);
            rig_at(1000);
            (void)sim_x0_set_cell(&chip, 3, 2.0);
            comes_at(UV, 1010 + 1000 * uv_s[uv]);
        }
    }
}

/* proves: X0-OV-08, X0-UV-09, X0-AMB-41 */
static void test_one_good_scan_restarts_the_delay_and_cells_share_it(void)
{
    for (int flag = OV; flag <= UV; flag += UV - OV) {
        double bad = flag == OV ? 4.3 : 2.0;
        prepare("bq7692003", NULL, 0x00);
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 2, bad); /* publications 1010, 1260 */
        rig_at(1300);
        (void)sim_x0_set_cell(&chip, 2, 3.6); /* 1510 is good */
        rig_at(1600);
        (void)sim_x0_set_cell(&chip, 2, bad); /* from 1760 on */
        comes_at(flag, 2760);
        prepare("bq7692003", NULL, 0x00);
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 2, bad);
        rig_at(1500);
        (void)sim_x0_set_cell(&chip, 2, 3.6); /* another cell goes on with the same delay */
        (void)sim_x0_set_cell(&chip, 5, bad);
        comes_at(flag, 2010);
        prepare("bq7692003", NULL, 0x00);
        rig_at(1011);
        (void)sim_x0_set_cell(&chip, 2, bad); /* gone before any publication saw it */
        rig_at(1259);
        (void)sim_x0_set_cell(&chip, 2, 3.6);
        rig_at(10000);
        expect_stat(0x00);
    }
}

/* proves: X0-OV-10, X0-UV-11, X0-BIT-07, X0-FET-11 */
static void test_the_bits_are_latched(void)
{
    for (int flag = OV; flag <= UV; flag += UV - OV) {
        prepare("bq7692003", NULL, 0x00);
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 2, flag == OV ? 4.3 : 2.0);
        rig_at(2010);
        (void)sim_x0_set_cell(&chip, 2, 3.6);
        rig_at(20000);
        expect_stat(flag);
        TEST_ASSERT_TRUE(rig_write(0x00, 0x00));
        expect_stat(flag);
        TEST_ASSERT_TRUE(rig_write(0x00, flag));
        expect_stat(0x00);
        expect_reg(0x05, flag == OV ? DSG : CHG); /* clearing alone turns nothing on */
        rig_at(40000);
        expect_stat(0x00);
        TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
        expect_reg(0x05, CHG | DSG);
        expect_clean();
    }
}

/* proves: X0-OV-11, X0-UV-11, X0-AMB-42 */
static void test_a_condition_that_persists_comes_back(void)
{
    sim_x0_options full_delay = {.amb42_full_delay = true};
    for (int other = 0; other < 2; other++) {
        for (int flag = OV; flag <= UV; flag += UV - OV) {
            prepare("bq7692003", other ? &full_delay : NULL, 0x00);
            rig_at(1000);
            (void)sim_x0_set_cell(&chip, 2, flag == OV ? 4.3 : 2.0);
            rig_at(2100);
            expect_stat(flag);
            TEST_ASSERT_TRUE(rig_write(0x00, flag));
            expect_stat(0x00);
            TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG)); /* possible in between */
            comes_at(flag, other ? 3260 : 2260);
        }
    }
}

/* proves: X0-OV-07, X0-UV-09, X0-AMB-15, X0-AMB-16, X0-BIT-11, X0-MODE-15 */
static void test_no_judgement_without_the_converter(void)
{
    for (int flag = OV; flag <= UV; flag += UV - OV) {
        rig_boot("bq7692003");
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 2, flag == OV ? 4.3 : 2.0);
        rig_at(1900); /* 0.89 s of the delay are over */
        TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
        rig_at(60000);
        expect_stat(0x00);
        TEST_ASSERT_TRUE(rig_write(0x04, 0x10)); /* publications from 60250; the whole delay again */
        rig_at(61249.999);
        expect_stat(0x00);
        rig_at(61250);
        expect_stat(flag);
    }
}

/* proves: X0-OV-15, X0-AMB-46 */
static void test_new_limits_apply_from_the_next_publication(void)
{
    prepare("bq7692003", NULL, 0x30); /* 8 s */
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 2, 4.3);
    rig_at(4000);
    TEST_ASSERT_TRUE(rig_write(0x08, 0x10)); /* 2 s: over already */
    comes_at(OV, 4010);
    prepare("bq7692003", NULL, 0x00);
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 2, 4.3);
    rig_at(1800);
    TEST_ASSERT_TRUE(rig_write(0x09, 0xff));
    rig_at(10000);
    expect_stat(0x00);
    TEST_ASSERT_TRUE(rig_write(0x09, 0xac));
    comes_at(OV, 11010);
}

/* proves: X0-UV-07, X0-AMB-40, X0-UV-06 */
static void test_a_collapsed_cell_is_taken_for_a_short(void)
{
    prepare("bq7692003", NULL, 0x00);
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 1, 2.0);
    rig_at(1600);
    (void)sim_x0_set_cell(&chip, 1, 0.4); /* through the limit within the delay */
    rig_at(30000);
    expect_stat(0x00);
    (void)sim_x0_set_cell(&chip, 1, 2.0);
    rig_at(32000);
    expect_stat(UV);
    (void)sim_x0_set_cell(&chip, 1, 0.4);
    rig_at(34000);
    expect_stat(UV); /* once set it stays */
}

/* proves: X0-CB-08 */
static void test_limits_work_while_balancing(void)
{
    prepare("bq7692003", NULL, 0x00);
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 1, 4.3);
    comes_at(OV, 2010);
    TEST_ASSERT_EQUAL(11257, rig_read16(0x0c)); /* the undisturbed voltage */
    expect_reg(0x01, 0x15);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_overvoltage_vector);
    RUN_TEST(test_every_undervoltage_vector);
    RUN_TEST(test_every_threshold_code);
    RUN_TEST(test_every_input_of_every_part_trips);
    RUN_TEST(test_all_sixteen_delay_pairs);
    RUN_TEST(test_one_good_scan_restarts_the_delay_and_cells_share_it);
    RUN_TEST(test_the_bits_are_latched);
    RUN_TEST(test_a_condition_that_persists_comes_back);
    RUN_TEST(test_no_judgement_without_the_converter);
    RUN_TEST(test_new_limits_apply_from_the_next_publication);
    RUN_TEST(test_a_collapsed_cell_is_taken_for_a_short);
    RUN_TEST(test_limits_work_while_balancing);
    return UNITY_END();
}
