/* SPDX-License-Identifier: Apache-2.0 */
/* Readings of the bq769x0: the numbers of the requirements, every code in both directions, and what the usual
 * mistakes would give instead. */
#include "bqhost/bq769x0_convert.h"
#include "unity.h"
#include "vectors.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static bq769x0_trim trim(int gain_uv, int offset_mv)
{
    bq769x0_trim t = {(uint16_t)gain_uv, (int8_t)offset_mv};
    return t;
}

/* The usual mistakes, to show that the numbers below tell them apart. */
static int32_t wrong_offset_unsigned(bq769x0_trim t, uint16_t code)
{
    return (int32_t)code * t.gain_uv + (uint8_t)t.offset_mv * 1000;
}

/* proves: X0-NUM-101, X0-NUM-102, X0-NUM-103, X0-NUM-104, X0-NUM-105, X0-NUM-106, X0-NUM-108, X0-ADC-02,
 * X0-ADC-08, X0-AMB-07, X0-AMB-12 */
static void test_cells(void)
{
    TEST_ASSERT_EQUAL_INT32(2364720, bq769x0_cell_uv(trim(380, 30), 0x1800));
    TEST_ASSERT_EQUAL_INT32(3051760, bq769x0_cell_uv(trim(380, 30), 0x1f10));
    for (unsigned i = 0; i < sizeof ideal / sizeof ideal[0]; i++) {
        bq769x0_trim t = trim(ideal[i].gain_uv, ideal[i].offset_mv);
        int32_t uv = bq769x0_cell_uv(t, (uint16_t)ideal[i].code);
        TEST_ASSERT_EQUAL_INT32(ideal[i].back_uv, uv);
        TEST_ASSERT_INT_WITHIN(ideal[i].gain_uv / 2 + 1, ideal[i].mv * 1000, uv);
        if (ideal[i].offset_mv < 0) {
            TEST_ASSERT_TRUE(uv != wrong_offset_unsigned(t, (uint16_t)ideal[i].code));
        }
    }
    /* the limit below which the part takes an input for shorted */
    TEST_ASSERT_EQUAL_INT32(498128, bq769x0_cell_uv(trim(382, 0), 0x0518));
    TEST_ASSERT_EQUAL_INT32(525520, bq769x0_cell_uv(trim(380, 30), 0x0518));
    TEST_ASSERT_EQUAL_INT32(347960, bq769x0_cell_uv(trim(365, -128), 0x0518));
    TEST_ASSERT_EQUAL_INT32(643384, bq769x0_cell_uv(trim(396, 127), 0x0518));
    TEST_ASSERT_EQUAL_INT32(16383 * 396 + 127000, bq769x0_cell_uv(trim(396, 127), 0x3fff));
}

/* proves: X0-ADC-05 */
static void test_the_field_mistake_of_the_unsigned_offset(void)
{
    bq769x0_trim t = bq769x0_trim_from(0x08, 0xec, 0x20); /* 382 uV, -20 mV */
    uint16_t code = 9476;                                 /* 3.600 V */
    TEST_ASSERT_INT_WITHIN(200, 3600000, bq769x0_cell_uv(t, code));
    TEST_ASSERT_INT_WITHIN(200, 3856000, wrong_offset_unsigned(t, code)); /* what such a driver shows */
}

/* proves: X0-NUM-301, X0-NUM-302, X0-NUM-303, X0-NUM-304, X0-NUM-305, X0-NUM-306, X0-NUM-307, X0-NUM-308,
 * X0-NUM-309, X0-NUM-310, X0-NUM-311, X0-NUM-312, X0-NUM-313, X0-NUM-314, X0-NUM-315, X0-NUM-316,
 * X0-NUM-317, X0-NUM-318, X0-NUM-319, X0-NUM-320, X0-NUM-321, X0-NUM-322, X0-NUM-323, X0-NUM-324,
 * X0-NUM-325, X0-NUM-326, X0-NUM-327, X0-NUM-328, X0-NUM-329, X0-NUM-330, X0-NUM-331, X0-NUM-332,
 * X0-NUM-333, X0-ADC-03, X0-ADC-04 */
static void test_gain_codes(void)
{
    for (unsigned g = 0; g < 32u; g++) {
        uint8_t r50 = (uint8_t)((g >> 3) << 2), r59 = (uint8_t)((g & 7u) << 5);
        TEST_ASSERT_EQUAL_UINT16(365u + g, bq769x0_trim_from(r50, 0, r59).gain_uv);
        TEST_ASSERT_EQUAL_UINT16(365u + g, bq769x0_trim_from(r50 | 0xf3, 0, r59 | 0x1f).gain_uv);
    }
    TEST_ASSERT_EQUAL_UINT16(377, bq769x0_trim_from(0x05, 0, 0x82).gain_uv);
    TEST_ASSERT_EQUAL_UINT16(380, bq769x0_trim_from(0xf7, 0, 0xff).gain_uv);
}

/* proves: X0-NUM-401, X0-NUM-402, X0-NUM-403, X0-NUM-404, X0-NUM-405, X0-NUM-406, X0-NUM-407, X0-NUM-408,
 * X0-NUM-409, X0-ADC-05 */
static void test_offset_codes(void)
{
    static const struct {
        uint8_t reg;
        int16_t mv;
    } row[] = {{0x00, 0},  {0x01, 1},  {0x7f, 127}, {0x80, -128}, {0x81, -127},
               {0xff, -1}, {0x1e, 30}, {0x30, 48},  {0xc4, -60}};
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_INT(row[i].mv, bq769x0_trim_from(0, row[i].reg, 0).offset_mv);
    }
    for (int mv = -128; mv < 128; mv++) {
        TEST_ASSERT_EQUAL_INT(mv, bq769x0_trim_from(0, (uint8_t)mv, 0).offset_mv);
    }
}

/* proves: X0-NUM-109, X0-NUM-110, X0-NUM-111, X0-NUM-112, X0-NUM-114, X0-NUM-115, X0-NUM-117, X0-BAT-02,
 * X0-AMB-08, X0-AMB-09 */
static void test_stack_voltage(void)
{
    TEST_ASSERT_EQUAL_UINT32(15259, bq769x0_bat_mv(trim(380, 30), 9940, 5));
    TEST_ASSERT_EQUAL_UINT32(18000, bq769x0_bat_mv(trim(382, 0), 11780, 5));
    TEST_ASSERT_EQUAL_UINT32(36000, bq769x0_bat_mv(trim(382, 0), 23560, 10));
    TEST_ASSERT_EQUAL_UINT32(54000, bq769x0_bat_mv(trim(382, 0), 35340, 15));
    /* eight cells on ten inputs: a negative offset counts for all inputs, a positive one for those in use */
    TEST_ASSERT_EQUAL_UINT32(28800, bq769x0_bat_mv(trim(365, -128), 20603, 10));
    TEST_ASSERT_EQUAL_UINT32(29056, bq769x0_bat_mv(trim(365, -128), 20603, 8));
    TEST_ASSERT_EQUAL_UINT32(28861, bq769x0_bat_mv(trim(380, 30), 18790, 10));
    TEST_ASSERT_EQUAL_UINT32(28801, bq769x0_bat_mv(trim(380, 30), 18790, 8));
    /* one code is four cell codes */
    TEST_ASSERT_EQUAL_UINT32(1460, bq769x0_bat_mv(trim(365, 0), 1000, 5));
    TEST_ASSERT_EQUAL_UINT32(1528, bq769x0_bat_mv(trim(382, 0), 1000, 5));
    TEST_ASSERT_EQUAL_UINT32(1532, bq769x0_bat_mv(trim(383, 0), 1000, 5));
    TEST_ASSERT_EQUAL_UINT32(1584, bq769x0_bat_mv(trim(396, 0), 1000, 5));
    TEST_ASSERT_EQUAL_UINT32(97315 - 1920, bq769x0_bat_mv(trim(396, -128), 61436, 15));
}

/* proves: X0-NUM-201, X0-NUM-202, X0-NUM-203, X0-NUM-204, X0-NUM-205, X0-NUM-206, X0-NUM-207, X0-NUM-208,
 * X0-NUM-209, X0-NUM-210, X0-NUM-211, X0-NUM-212, X0-NUM-213, X0-NUM-214, X0-CC-01, X0-CC-13 */
static void test_current(void)
{
    static const struct {
        uint16_t code;
        int32_t nv; /* across the shunt */
    } row[] = {{0x0001, 8440},       {0x2710, 84400000},  {0x7d00, 270080000}, {0x8300, -270080000},
               {0xc350, -131123840}, {0xffff, -8440},     {0x0000, 0},         {0x7fff, 276553480},
               {0x8000, -276561920}, {0xe8dc, -49998560}, {0x1724, 49998560},  {0xfb5f, -10001400},
               {0xa36f, -200002680}, {0x0076, 995920}};
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_INT_WITHIN(1, row[i].nv / 100, bq769x0_current_ma((int16_t)row[i].code, 100));
    }
    TEST_ASSERT_EQUAL_INT32(-10000, bq769x0_current_ma(-5924, 5000)); /* -9.9997 A */
    TEST_ASSERT_EQUAL_INT32(10000, bq769x0_current_ma(5924, 5000));
    TEST_ASSERT_EQUAL_INT32(-2000, bq769x0_current_ma(-1185, 5000));
    TEST_ASSERT_EQUAL_INT32(-40001, bq769x0_current_ma(-23697, 5000));
    TEST_ASSERT_EQUAL_INT32(996, bq769x0_current_ma(118, 1000));
    TEST_ASSERT_EQUAL_INT32(1688, bq769x0_current_ma(1000, 5000)); /* 1.688 mA a code */
}

/* proves: X0-NUM-901, X0-NUM-902, X0-NUM-903, X0-NUM-904, X0-NUM-905, X0-NUM-906, X0-NUM-907, X0-NUM-908,
 * X0-NUM-909, X0-NUM-910, X0-TS-05, X0-TS-07, X0-AMB-31 */
static void test_thermistor_codes(void)
{
    static const struct {
        uint16_t code;
        uint32_t tenths; /* of an ohm, as the formula gives them back */
    } row[] = {{0, 0},        {86, 1006},     {785, 9995},    {1440, 20003}, {2880, 50011},
               {4319, 99983}, {5759, 199983}, {7199, 500020}, {7853, 999436}};
    uint32_t ohms = 0;
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_ts_ohms(row[i].code, &ohms));
        TEST_ASSERT_UINT_WITHIN(6, row[i].tenths, 10u * ohms);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_ts_ohms(8638, &ohms));
    TEST_ASSERT_UINT_WITHIN(100000, 116200000u, ohms);
    ohms = 7;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq769x0_ts_ohms(8639, &ohms));
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq769x0_ts_ohms(0x3fff, &ohms));
    TEST_ASSERT_EQUAL_UINT32(7, ohms);
    /* every code, against the formula in long arithmetic; a reading scaled with the trimmed gain is off */
    for (uint16_t code = 1; code < 8639u; code++) {
        uint64_t up = 10000u * 191ull * code, down = 1650000u - 191u * code;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_ts_ohms(code, &ohms));
        TEST_ASSERT_UINT_WITHIN(1, (uint32_t)((up + down / 2u) / down), ohms);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_ts_ohms(4319, &ohms));
    TEST_ASSERT_TRUE(ohms + 300u < 10000ull * 4319u * 396u / (3300000u - 4319u * 396u));
}

/* proves: X0-NUM-911, X0-NUM-912, X0-NUM-913, X0-NUM-914, X0-NUM-915, X0-NUM-916, X0-NUM-917, X0-DIE-02,
 * X0-DIE-04 */
static void test_die_temperature(void)
{
    static const struct {
        uint16_t code;
        int16_t dc;
    } row[] = {{3856, -400}, {3416, 0}, {3141, 250}, {2757, 600}, {2482, 850}, {2317, 1000}, {2042, 1250}};
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_INT(row[i].dc, bq769x0_die_dc(row[i].code, 1200000));
    }
    TEST_ASSERT_EQUAL_INT(250, bq769x0_die_dc(3168, 1210000)); /* with a V25 measured in production */
}

static unsigned wired(unsigned inputs, unsigned cells)
{
    return bq769x0_wiring((uint8_t)inputs, (uint8_t)cells);
}

/* proves: X0-CELL-01, X0-CELL-02, X0-CELL-03, X0-CELL-04, X0-CELL-05, X0-CELL-06, X0-CELL-07, X0-CELL-08,
 * X0-CELL-09, X0-CELL-10, X0-CELL-11, X0-CELL-12, X0-CELL-13, X0-CELL-14, X0-CELL-15, X0-CELL-16, X0-CELL-17,
 * X0-CELL-18, X0-NUM-711, X0-VAR-22 */
static void test_wiring(void)
{
    static const uint16_t five[] = {0x0013, 0x0017, 0x001f};
    static const uint16_t ten[] = {0x0273, 0x0277, 0x02f7, 0x02ff, 0x03ff};
    static const uint16_t fifteen[] = {0x4e73, 0x4e77, 0x4ef7, 0x5ef7, 0x5eff, 0x5fff, 0x7fff};
    for (unsigned cells = 0; cells < 256u; cells++) {
        TEST_ASSERT_EQUAL_HEX16(cells >= 3u && cells <= 5u ? five[cells - 3u] : 0, wired(5, cells));
        TEST_ASSERT_EQUAL_HEX16(cells >= 6u && cells <= 10u ? ten[cells - 6u] : 0, wired(10, cells));
        TEST_ASSERT_EQUAL_HEX16(cells >= 9u && cells <= 15u ? fifteen[cells - 9u] : 0, wired(15, cells));
        TEST_ASSERT_EQUAL_HEX16(0, wired(20, cells) | wired(0, cells) | wired(7, cells));
    }
}

static bool listed(const uint8_t *list, unsigned n, unsigned value)
{
    bool found = false;
    for (unsigned i = 0; i < n; i++) {
        found = found || list[i] == value;
    }
    return found;
}

/* proves: X0-CELL-19, X0-CELL-20, X0-CELL-21, X0-CB-04, X0-CB-06, X0-AMB-62 */
static void test_balancing_sets_of_a_group(void)
{
    static const uint8_t three[] = {0x00, 0x01, 0x02, 0x10, 0x11};
    static const uint8_t four[] = {0x00, 0x01, 0x02, 0x04, 0x05, 0x10, 0x11, 0x12};
    static const uint8_t five[] = {0x00, 0x01, 0x02, 0x04, 0x05, 0x08, 0x09,
                                   0x0a, 0x10, 0x11, 0x12, 0x14, 0x15};
    for (unsigned group = 0; group < 15u; group += 5u) {
        for (unsigned bits = 0; bits < 32u; bits++) {
            uint16_t mask = (uint16_t)(bits << group);
            TEST_ASSERT_EQUAL_INT(listed(three, 5, bits),
                                  bq769x0_balance_legal((uint16_t)(0x13u << group), mask, false));
            TEST_ASSERT_EQUAL_INT(listed(four, 8, bits),
                                  bq769x0_balance_legal((uint16_t)(0x17u << group), mask, false));
            TEST_ASSERT_EQUAL_INT(listed(five, 13, bits),
                                  bq769x0_balance_legal((uint16_t)(0x1fu << group), mask, false));
        }
    }
}

/* proves: X0-AMB-61 */
static void test_borders_of_groups(void)
{
    TEST_ASSERT_TRUE(bq769x0_balance_legal(0x7fff, 0x0030, false)); /* 5 and 6 */
    TEST_ASSERT_FALSE(bq769x0_balance_legal(0x7fff, 0x0030, true));
    TEST_ASSERT_TRUE(bq769x0_balance_legal(0x7fff, 0x0600, false)); /* 10 and 11 */
    TEST_ASSERT_FALSE(bq769x0_balance_legal(0x7fff, 0x0600, true));
    TEST_ASSERT_TRUE(bq769x0_balance_legal(0x7fff, 0x5555, true));
}

/* 13 cells on a bq76940: cells 8 and 9 of the pack sit on VC8 and VC10, cells 7 and 9 are no neighbours by
 * number. By logical number bits 2 and 4 of a group of four are apart; on the part they share a node. */
static bool wrong_adjacency_by_cell_number(uint32_t cells)
{
    return (cells & cells >> 1) == 0u;
}

/* proves: X0-CB-06 */
static void test_the_field_mistake_of_logical_numbers(void)
{
    uint16_t in_use = bq769x0_wiring(15, 13);
    unsigned told_apart = 0;
    for (unsigned a = 0; a < 15u; a++) {
        for (unsigned b = a + 1u; b < 15u; b++) {
            uint16_t mask = (uint16_t)(1u << a | 1u << b);
            bool used = (mask & ~in_use) == 0u, between = false;
            for (unsigned i = a + 1u; i < b; i++) {
                between = between || (in_use >> i & 1u) != 0u;
            }
            TEST_ASSERT_EQUAL_INT(used && (between || a / 5u != b / 5u),
                                  bq769x0_balance_legal(in_use, mask, false));
            /* the other way round: pack numbers written to the switches as they are */
            told_apart += wrong_adjacency_by_cell_number(mask) != bq769x0_balance_legal(in_use, mask, false);
        }
    }
    TEST_ASSERT_TRUE(told_apart > 0u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cells);
    RUN_TEST(test_the_field_mistake_of_the_unsigned_offset);
    RUN_TEST(test_gain_codes);
    RUN_TEST(test_offset_codes);
    RUN_TEST(test_stack_voltage);
    RUN_TEST(test_current);
    RUN_TEST(test_thermistor_codes);
    RUN_TEST(test_die_temperature);
    RUN_TEST(test_wiring);
    RUN_TEST(test_balancing_sets_of_a_group);
    RUN_TEST(test_borders_of_groups);
    RUN_TEST(test_the_field_mistake_of_logical_numbers);
    return UNITY_END();
}
