/* SPDX-License-Identifier: Apache-2.0 */
/* Protection settings of the bq769x0: the numbers of the requirements, every request and every code, and what
 * the usual mistakes would give instead. */
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

/* proves: X0-NUM-501, X0-NUM-502, X0-NUM-503, X0-NUM-504, X0-NUM-505, X0-NUM-506, X0-NUM-507, X0-NUM-508,
 * X0-NUM-509, X0-NUM-510, X0-NUM-511, X0-NUM-512, X0-OV-01, X0-OV-02, X0-OV-03, X0-UV-01, X0-UV-02,
 * X0-UV-03, X0-AMB-35, X0-AMB-36 */
static void test_what_a_trip_code_means(void)
{
    for (unsigned i = 0; i < sizeof trip_codes / sizeof trip_codes[0]; i++) {
        uint16_t code =
            trip_codes[i].is_uv ? bq769x0_uv_code(trip_codes[i].trip) : bq769x0_ov_code(trip_codes[i].trip);
        TEST_ASSERT_EQUAL_INT(trip_codes[i].code, code);
        TEST_ASSERT_EQUAL_INT32(trip_codes[i].uv_382_0, bq769x0_cell_uv(trim(382, 0), code));
        TEST_ASSERT_EQUAL_INT32(trip_codes[i].uv_380_30, bq769x0_cell_uv(trim(380, 30), code));
    }
    for (unsigned t = 0; t < 256u; t++) {
        TEST_ASSERT_EQUAL_HEX16(0x2000u + 16u * t + 8u, bq769x0_ov_code((uint8_t)t));
        TEST_ASSERT_EQUAL_HEX16(0x1000u + 16u * t, bq769x0_uv_code((uint8_t)t));
    }
}

static void expect_vector(const trip_vector *v, bq_status status, uint8_t trip, uint16_t code)
{
    if (v->trip < 0) {
        TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, status);
        return;
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, status);
    TEST_ASSERT_EQUAL_HEX8(v->trip, trip);
    TEST_ASSERT_EQUAL_INT(v->code, code);
    TEST_ASSERT_EQUAL_INT32(v->uv, bq769x0_cell_uv(trim(v->gain_uv, v->offset_mv), code));
}

/* proves: X0-NUM-513, X0-NUM-514, X0-NUM-515, X0-NUM-516, X0-NUM-517, X0-NUM-518, X0-NUM-519, X0-NUM-520,
 * X0-NUM-521, X0-NUM-522, X0-NUM-523, X0-NUM-524, X0-NUM-525, X0-NUM-526, X0-NUM-527, X0-NUM-528,
 * X0-NUM-529, X0-NUM-530, X0-NUM-531, X0-NUM-532, X0-NUM-533, X0-NUM-534, X0-NUM-535, X0-NUM-536,
 * X0-NUM-537, X0-NUM-538, X0-NUM-539, X0-NUM-540, X0-NUM-541, X0-NUM-542, X0-NUM-543, X0-NUM-544,
 * X0-NUM-545, X0-NUM-546, X0-OV-12, X0-UV-12, X0-OV-14 */
static void test_the_procedure_of_the_datasheet(void)
{
    uint8_t trip = 0;
    for (unsigned i = 0; i < sizeof ov_vectors / sizeof ov_vectors[0]; i++) {
        const trip_vector *v = &ov_vectors[i];
        bq_status st = bq769x0_ov_trip_datasheet(trim(v->gain_uv, v->offset_mv), (uint16_t)v->mv, &trip);
        expect_vector(v, st, trip, bq769x0_ov_code(trip));
    }
    for (unsigned i = 0; i < sizeof uv_vectors / sizeof uv_vectors[0]; i++) {
        const trip_vector *v = &uv_vectors[i];
        bq_status st = bq769x0_uv_trip_datasheet(trim(v->gain_uv, v->offset_mv), (uint16_t)v->mv, &trip);
        expect_vector(v, st, trip, bq769x0_uv_code(trip));
    }
}

/* No range check: what public drivers write for 5.0 V and 3.3 V. */
static uint8_t wrong_trip(bq769x0_trim t, int mv)
{
    return (uint8_t)((unsigned)((mv - t.offset_mv) * 1000 / t.gain_uv) >> 4);
}

/* proves: X0-OV-12, X0-UV-12, X0-AMB-37 */
static void test_the_field_mistake_of_the_missing_range_check(void)
{
    uint8_t trip = 0x5a;
    int32_t uv = -1;
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_ov_trip(trim(382, 0), 5000, &trip, &uv));
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_uv_trip(trim(382, 0), 3300, &trip, &uv));
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_ov_trip_datasheet(trim(382, 0), 5000, &trip));
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_uv_trip_datasheet(trim(382, 0), 3300, &trip));
    TEST_ASSERT_EQUAL_HEX8(0x5a, trip);
    TEST_ASSERT_EQUAL_INT32(-1, uv);
    uv = bq769x0_cell_uv(trim(382, 0), bq769x0_ov_code(wrong_trip(trim(382, 0), 5000)));
    TEST_ASSERT_INT_WITHIN(10000, 3440000, uv); /* silently */
    uv = bq769x0_cell_uv(trim(382, 0), bq769x0_uv_code(wrong_trip(trim(382, 0), 3300)));
    TEST_ASSERT_INT_WITHIN(15000, 1740000, uv);
}

static void never_looser(bq769x0_trim t)
{
    for (int mv = 0; mv < 6600; mv++) {
        uint8_t trip = 0;
        int32_t uv = 0;
        if (bq769x0_ov_trip(t, (uint16_t)mv, &trip, &uv) == BQ_OK) {
            TEST_ASSERT_EQUAL_INT32(bq769x0_cell_uv(t, bq769x0_ov_code(trip)), uv);
            TEST_ASSERT_TRUE(uv <= mv * 1000 && uv + 16 * t.gain_uv > mv * 1000);
        } else {
            TEST_ASSERT_TRUE(mv * 1000 < bq769x0_cell_uv(t, 0x2008) ||
                             mv * 1000 >= bq769x0_cell_uv(t, 0x3000));
        }
        if (bq769x0_uv_trip(t, (uint16_t)mv, &trip, &uv) == BQ_OK) {
            TEST_ASSERT_EQUAL_INT32(bq769x0_cell_uv(t, bq769x0_uv_code(trip)), uv);
            TEST_ASSERT_TRUE(uv >= mv * 1000 && uv - 16 * t.gain_uv < mv * 1000);
        } else {
            TEST_ASSERT_TRUE(mv * 1000 > bq769x0_cell_uv(t, 0x1ff0) ||
                             mv * 1000 <= bq769x0_cell_uv(t, 0x0fff));
        }
    }
}

/* proves: X0-OV-12, X0-UV-12, X0-OV-02, X0-UV-02, X0-AMB-06 */
static void test_limits_are_never_looser_than_asked(void)
{
    for (int gain = 365; gain <= 396; gain += 1) {
        never_looser(trim(gain, gain * 7 % 256 - 128));
    }
    never_looser(trim(365, -128));
    never_looser(trim(396, 127));
}

/* proves: X0-NUM-547, X0-NUM-548, X0-NUM-549, X0-OV-04, X0-UV-04 */
static void test_delays_of_protect3(void)
{
    static const uint8_t ov_s[] = {1, 2, 4, 8}, uv_s[] = {1, 4, 8, 16};
    uint8_t reg = 0x55;
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_protect3(0, 1, &reg));
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, bq769x0_protect3(1, 0, &reg));
    TEST_ASSERT_EQUAL_HEX8(0x55, reg);
    for (unsigned o = 1; o < 256u; o++) {
        for (unsigned u = 1; u < 256u; u++) {
            unsigned oc = 3, uc = 3;
            while (ov_s[oc] > o) {
                oc--;
            }
            while (uv_s[uc] > u) {
                uc--;
            }
            TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_protect3((uint8_t)o, (uint8_t)u, &reg));
            TEST_ASSERT_EQUAL_HEX8((uc * 4u + oc) * 16u, reg);
        }
    }
}

static const uint8_t ocd_mv[2][16] = {{8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
                                      {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100}};
static const uint8_t scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100},
                                     {44, 67, 89, 111, 133, 155, 178, 200}};

/* What a register pair means, read by the tables of the datasheet. */
static unsigned ocd_of(const bq769x0_current_limits *l)
{
    return ocd_mv[l->protect1 >> 7][l->protect2 & 15u];
}

static unsigned scd_of(const bq769x0_current_limits *l)
{
    return scd_mv[l->protect1 >> 7][l->protect1 & 7u];
}

/* proves: X0-NUM-601, X0-NUM-602, X0-NUM-603, X0-NUM-604, X0-NUM-605, X0-NUM-606, X0-NUM-607, X0-NUM-608,
 * X0-NUM-609, X0-NUM-610, X0-NUM-611, X0-NUM-612, X0-NUM-613, X0-NUM-614, X0-NUM-615, X0-NUM-616,
 * X0-NUM-625, X0-NUM-626, X0-NUM-627, X0-NUM-628, X0-NUM-629, X0-NUM-630, X0-NUM-631, X0-NUM-632,
 * X0-OCD-03, X0-SCD-01, X0-OCD-11, X0-AMB-47, X0-ELEC-13 */
static void test_current_thresholds(void)
{
    for (uint32_t o = 0; o <= 130u; o++) {
        for (uint32_t s = 0; s <= 240u; s++) {
            bq769x0_current_limits l = {.protect1 = 0x77};
            bq_status st = bq769x0_current_codes(o * 1000u + 999u, 8, s * 1000u, 70, &l);
            bool coarse = (o > 50u || s > 100u) && o >= 17u && s >= 44u;
            unsigned best_o = 0, best_s = 0;
            for (unsigned i = 0; i < 16u; i++) {
                best_o = ocd_mv[coarse][i] <= o ? ocd_mv[coarse][i] : best_o;
            }
            for (unsigned i = 0; i < 8u; i++) {
                best_s = scd_mv[coarse][i] <= s ? scd_mv[coarse][i] : best_s;
            }
            if (best_o == 0u || best_s == 0u) {
                TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, st);
            } else if (best_o >= best_s) {
                TEST_ASSERT_EQUAL_INT(BQ_E_CONFIG, st);
            } else {
                TEST_ASSERT_EQUAL_INT(BQ_OK, st);
                TEST_ASSERT_EQUAL_UINT(best_o, l.ocd_mv);
                TEST_ASSERT_EQUAL_UINT(best_s, l.scd_mv);
                TEST_ASSERT_EQUAL_UINT(l.ocd_mv, ocd_of(&l)); /* the index of its own table */
                TEST_ASSERT_EQUAL_UINT(l.scd_mv, scd_of(&l));
                TEST_ASSERT_EQUAL_HEX8(0, l.protect1 & 0x60u);
                continue;
            }
            TEST_ASSERT_EQUAL_HEX8(0x77, l.protect1);
        }
    }
}

/* proves: X0-NUM-617, X0-NUM-618, X0-NUM-619, X0-NUM-620, X0-NUM-621, X0-NUM-622, X0-NUM-623, X0-NUM-624,
 * X0-NUM-633, X0-NUM-634, X0-NUM-635, X0-NUM-636, X0-OCD-04, X0-SCD-02 */
static void test_current_delays(void)
{
    static const uint16_t ocd_ms[] = {8, 20, 40, 80, 160, 320, 640, 1280}, scd_us[] = {70, 100, 200, 400};
    bq769x0_current_limits l;
    for (unsigned ms = 0; ms < 3000u; ms++) {
        bq_status st = bq769x0_current_codes(17000, (uint16_t)ms, 44000, 70, &l);
        unsigned c = 7;
        TEST_ASSERT_EQUAL_INT(ms < 8u ? BQ_E_NO_CODE : BQ_OK, st);
        while (ms >= 8u && ocd_ms[c] > ms) {
            c--;
        }
        if (st == BQ_OK) {
            TEST_ASSERT_EQUAL_UINT(c, l.protect2 >> 4);
            TEST_ASSERT_EQUAL_UINT(ocd_ms[c], l.ocd_delay_ms);
        }
    }
    for (unsigned us = 0; us < 1000u; us++) {
        bq_status st = bq769x0_current_codes(17000, 8, 44000, (uint16_t)us, &l);
        unsigned c = 3;
        TEST_ASSERT_EQUAL_INT(us < 70u ? BQ_E_NO_CODE : BQ_OK, st);
        while (us >= 70u && scd_us[c] > us) {
            c--;
        }
        if (st == BQ_OK) {
            TEST_ASSERT_EQUAL_UINT(c, l.protect1 >> 3 & 3u);
            TEST_ASSERT_EQUAL_UINT(scd_us[c], l.scd_delay_us);
        }
    }
}

static void expect_pair(uint32_t ocd_uv, unsigned ms, uint32_t scd_uv, unsigned us, uint8_t p1, uint8_t p2)
{
    bq769x0_current_limits l;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_current_codes(ocd_uv, (uint16_t)ms, scd_uv, (uint16_t)us, &l));
    TEST_ASSERT_EQUAL_HEX8(p1, l.protect1);
    TEST_ASSERT_EQUAL_HEX8(p2, l.protect2);
}

/* proves: X0-NUM-637, X0-NUM-639, X0-NUM-640, X0-NUM-641, X0-NUM-642, X0-NUM-643, X0-NUM-644, X0-NUM-645,
 * X0-NUM-646, X0-NUM-647, X0-NUM-648, X0-REG-06, X0-REG-07 */
static void test_registers_of_the_current_limits(void)
{
    expect_pair(8000, 8, 22000, 70, 0x00, 0x00);
    expect_pair(36000, 320, 100000, 200, 0x17, 0x5a);
    expect_pair(72000, 320, 111000, 100, 0x8b, 0x5a);
    expect_pair(78000, 320, 133000, 100, 0x8c, 0x5b);
    expect_pair(100000, 1280, 200000, 400, 0x9f, 0x7f);
    expect_pair(28000, 80, 78000, 400, 0x1d, 0x37);
}

/* The index of the fine table written with the coarse range set, as a public driver does. */
static unsigned wrong_ocd_index(unsigned mv)
{
    unsigned i = 15;
    while (i > 0u && ocd_mv[0][i] > mv) {
        i--;
    }
    return i;
}

/* The example of the datasheet: 15 A and 25 A at most, 5 mohm. The constants printed there lie above both. */
/* proves: X0-NUM-701, X0-NUM-702, X0-NUM-703, X0-NUM-704, X0-NUM-705, X0-NUM-706, X0-NUM-707, X0-NUM-708,
 * X0-NUM-709, X0-AMB-01, X0-AMB-02, X0-AMB-03, X0-AMB-04, X0-AMB-05, X0-OV-14 */
static void test_the_design_example(void)
{
    bq769x0_current_limits l;
    uint8_t reg = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_current_codes(75000, 320, 125000, 100, &l));
    TEST_ASSERT_EQUAL_HEX8(0x8b, l.protect1);
    TEST_ASSERT_EQUAL_HEX8(0x5a, l.protect2);
    TEST_ASSERT_EQUAL_UINT(72, l.ocd_mv);
    TEST_ASSERT_EQUAL_UINT(111, l.scd_mv);
    l.protect1 = 0x8c; /* as printed */
    l.protect2 = 0x5b;
    TEST_ASSERT_TRUE(scd_of(&l) > 125u && ocd_of(&l) > 75u);
    TEST_ASSERT_EQUAL_UINT(100, ocd_mv[1][wrong_ocd_index(75)]); /* 20 A instead of 15 */
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_protect3(2, 4, &reg));
    TEST_ASSERT_EQUAL_HEX8(0x50, reg);
    static const struct {
        int16_t gain, offset, ov, uv;
    } device[] = {{382, 0, 0xbf, 0x99}, {380, 30, 0xbe, 0x96}, {371, 62, 0xc9, 0x9a}, {377, -1, 0xc9, 0x9e}};
    for (unsigned i = 0; i < 4u; i++) {
        bq769x0_trim t = trim(device[i].gain, device[i].offset);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_ov_trip_datasheet(t, 4300, &reg));
        TEST_ASSERT_EQUAL_HEX8(device[i].ov, reg);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_uv_trip_datasheet(t, 2500, &reg));
        TEST_ASSERT_EQUAL_HEX8(device[i].uv, reg);
    }
    for (int gain = 365; gain <= 396; gain++) { /* no device at all gives the printed 0x1a */
        for (int offset = -128; offset < 128; offset++) {
            TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_uv_trip_datasheet(trim(gain, offset), 2500, &reg));
            TEST_ASSERT_TRUE(reg >= 0x76u && reg <= 0xc2u);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_a_trip_code_means);
    RUN_TEST(test_the_procedure_of_the_datasheet);
    RUN_TEST(test_the_field_mistake_of_the_missing_range_check);
    RUN_TEST(test_limits_are_never_looser_than_asked);
    RUN_TEST(test_delays_of_protect3);
    RUN_TEST(test_current_thresholds);
    RUN_TEST(test_current_delays);
    RUN_TEST(test_registers_of_the_current_limits);
    RUN_TEST(test_the_design_example);
    return UNITY_END();
}
