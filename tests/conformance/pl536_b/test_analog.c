/* SPDX-License-Identifier: Apache-2.0 */
/* What the ADC makes of volts and ratios: PL-VCELL, PL-GPAI, PL-VBAT, PL-TS and their vectors in PL-NUM. */
#include "rig.h"

struct vector {
    double in;
    int code, code2;
};

static void up(int function)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x03);
    rig_adc(1, 0x7d, function);
}

/* proves: PL-VCELL-01, PL-VCELL-02, PL-VCELL-03, PL-NUM-01, PL-NUM-08, PL-NUM-07, PL-AMB-60 */
static void cell_vectors(void)
{
    static const struct vector v[] = {
        {0.0, 0x0000, 0}, {0.7, 0x072b, 0},  {1.0, 0x0a3d, 0}, {1.2, 0x0c4a, 0},  {2.0, 0x147b, 0},
        {2.5, 0x1999, 0}, {3.0, 0x1eb8, 0},  {3.3, 0x21ca, 0}, {3.35, 0x224d, 0}, {3.6, 0x24dd, 0},
        {3.7, 0x25e3, 0}, {4.15, 0x2a7e, 0}, {4.2, 0x2b01, 0}, {4.5, 0x2e14, 0},  {5.0, 0x3332, 0},
        {6.0, 0x3d70, 0}, {6.25, 0x3fff, 0}, {6.5, 0x3fff, 0},
    };
    up(0x40);
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        for (int c = 1; c <= 6; c++) {
            for (int other = 1; other <= 6; other++) {
                sim_pl_set_cell(&rig, 1, other, other == c ? v[i].in : 3.1);
            }
            rig_convert(1);
            for (int other = 1; other <= 6; other++) {
                EXPECT_WORD(other == c ? v[i].code : 8126, 1, R_CELL1 + 2 * (other - 1));
            }
        }
    }
}

/* proves: PL-VCELL-01, PL-VCELL-04 */
static void every_millivolt_of_a_cell(void)
{
    up(0x40);
    for (int mv = 0; mv <= 6300; mv++) {
        long code = (mv * 16383L * 2 + 6250) / (2 * 6250);
        sim_pl_set_cell(&rig, 1, 1, mv / 1000.0);
        rig_write(1, R_CONV, 1);
        rig_us(60);
        EXPECT_WORD(code > 16383 ? 16383 : code, 1, R_CELL1);
    }
}

/* proves: PL-VCELL-04, PL-GPAI-05, PL-VBAT-05, PL-TS-10 */
static void noise_stays_in_its_bounds(void)
{
    const sim_pl_options o = {.seed = 7, .noise_uv_rms = 250.0, .cell_offset_uv_max = 2500.0};
    double sum = 0, square = 0;
    int first = 0, moved = 0;
    rig_ready_with(1, &o);
    rig_adc(1, 0x4d, 0x50);
    for (int i = 0; i < 400; i++) {
        rig_convert(1);
        int code = rig_word(1, R_CELL1);
        int brick = rig_word(1, R_GPAI);
        first = i == 0 ? code : first;
        moved += code != first;
        sum += code;
        square += (double)code * code;
        TEST_ASSERT_INT_WITHIN(12, 0x24dd, code); /* 2.5 mV offset plus 6 sigma of noise */
        TEST_ASSERT_INT_WITHIN(6, 0x2979, brick); /* 6 sigma of 1.5 mV */
    }
    TEST_ASSERT_GREATER_THAN(20, moved);
    double mean = sum / 400;
    double variance = square / 400 - mean * mean;
    TEST_ASSERT_TRUE(variance < 1.2); /* 250 uV are 0.655 codes, quantisation adds a twelfth */
}

/* proves: PL-GPAI-01, PL-GPAI-02, PL-GPAI-04, PL-NUM-02, PL-NUM-09, PL-NUM-07, PL-AMB-56, PL-AMB-61 */
static void gpai_vectors(void)
{
    static const struct vector v[] = {
        {0.0, 0x0000, 0}, {0.25, 0x0666, 0}, {0.5, 0x0ccd, 0}, {1.0, 0x1999, 0}, {1.25, 0x2000, 0},
        {2.0, 0x3332, 0}, {2.4, 0x3d70, 0},  {2.5, 0x3fff, 0}, {2.6, 0x3fff, 0}, {-0.1, 0x0000, 0},
    };
    up(0x40);
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        TEST_ASSERT_EQUAL_INT(0, sim_pl_set_gpai(&rig, 1, v[i].in));
        rig_convert(1);
        EXPECT_WORD(v[i].code, 1, R_GPAI);
        EXPECT(v[i].code >> 8, 1, 0x01);
        EXPECT(v[i].code & 0xff, 1, 0x02);
    }
}

/* proves: PL-GPAI-02, PL-GPAI-03, PL-AMB-57 */
static void gpai_against_reg50_has_the_same_scale(void)
{
    up(0x60);
    sim_pl_set_gpai(&rig, 1, 1.0);
    rig_convert(1);
    EXPECT_WORD(0x1999, 1, R_GPAI);
    EXPECT(0x60, 1, C_FUNC);
}

/* proves: PL-VBAT-01, PL-VBAT-02, PL-VBAT-03, PL-VBAT-04, PL-NUM-03, PL-NUM-06, PL-NUM-10, PL-NUM-07,
 * PL-AMB-58, PL-AMB-59 */
static void brick_vectors(void)
{
    static const struct vector v[] = {
        {7.2, 0x0dd3, 0},  {10.8, 0x14bc, 0},   {14.4, 0x1ba6, 0},   {18.0, 0x228f, 0},
        {20.0, 0x2666, 0}, {20.295, 0x26f7, 0}, {21.6, 0x2979, 0},   {25.2, 0x3062, 0},
        {27.0, 0x33d7, 0}, {30.0, 0x399a, 0},   {33.333, 0x3fff, 0}, {35.0, 0x3fff, 0},
    };
    for (int ref = 0; ref <= 1; ref++) {
        up(ref ? 0x70 : 0x50);
        for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
            TEST_ASSERT_EQUAL_INT(0, sim_pl_set_vbat(&rig, 1, v[i].in));
            rig_convert(1);
            EXPECT_WORD(v[i].code, 1, R_GPAI);
            EXPECT_WORD(0x24dd, 1, R_CELL1); /* cells keep their scale, and the brick is not their sum */
        }
        sim_pl_set_vbat(&rig, 1, -1.0);
        rig_convert(1);
        EXPECT_WORD(0x2979, 1, R_GPAI);
    }
}

/* proves: PL-TS-01, PL-TS-02, PL-TS-03, PL-TS-04, PL-NUM-04, PL-NUM-05, PL-NUM-07, PL-NUM-11, PL-NUM-12,
 * PL-TS-08, PL-AMB-75,
 * PL-TS-12 */
static void temperature_vectors(void)
{
    static const struct vector v[] = {
        {0.0, 0x0000, 0x0000},    {0.0001, 0x0001, 0x0000},  {0.05, 0x0672, 0x066c}, {0.1, 0x0ce7, 0x0ce2},
        {0.1369, 0x11aa, 0x11a6}, {0.13695, 0x11ac, 0x11a8}, {0.2, 0x19cf, 0x19cd},  {0.25, 0x2044, 0x2042},
        {0.3, 0x26b8, 0x26b7},    {0.4, 0x33a0, 0x33a2},     {0.48, 0x3df4, 0x3df8}, {0.5, 0x3fff, 0x3fff},
        {0.6, 0x3fff, 0x3fff},
    };
    up(0x40);
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        sim_pl_set_ts_ratio(&rig, 1, 1, v[i].in);
        sim_pl_set_ts_ratio(&rig, 1, 2, v[i].in);
        rig_convert(1);
        EXPECT_WORD(v[i].code, 1, R_TEMP1);
        EXPECT_WORD(v[i].code2, 1, R_TEMP2);
    }
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.1322);
    rig_convert(1);
    EXPECT_WORD(0x110f, 1, R_TEMP1);
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.1324);
    rig_convert(1);
    EXPECT_WORD(0x1115, 1, R_TEMP1);
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.13242);
    rig_convert(1);
    EXPECT_WORD(0x1116, 1, R_TEMP1);
}

/* proves: PL-TS-05, PL-AMB-76 */
static void a_sensor_needs_its_switch_and_its_channel(void)
{
    for (int io = 0; io < 4; io++) {
        for (int adc = 0; adc < 4; adc++) {
            rig_ready(1);
            rig_write(1, R_IO, 0x03);
            rig_adc(1, 0x70, 0x40);
            rig_convert(1);
            EXPECT_WORD(0x11aa, 1, R_TEMP1);
            EXPECT_WORD(0x11a6, 1, R_TEMP2);
            sim_pl_set_ts_ratio(&rig, 1, 1, 0.3);
            sim_pl_set_ts_ratio(&rig, 1, 2, 0.3);
            rig_write(1, R_IO, io);
            rig_write(1, R_ADC, 0x40 | adc << 4);
            rig_convert(1);
            EXPECT_WORD(!(adc & 1) ? 0x11aa : io & 1 ? 0x26b8 : 0, 1, R_TEMP1);
            EXPECT_WORD(!(adc & 2) ? 0x11a6 : io & 2 ? 0x26b7 : 0, 1, R_TEMP2);
        }
    }
}

/* proves: PL-TS-11, PL-GPIO-05 */
static void reg50_is_off_in_sleep_and_tsd(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x83);
    TEST_ASSERT_TRUE(sim_pl_reg50(&rig, 1));
    TEST_ASSERT_TRUE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x87);
    rig_us(1);
    TEST_ASSERT_FALSE(sim_pl_reg50(&rig, 1));
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
    rig_write(1, R_IO, 0x83);
    rig_us(1);
    TEST_ASSERT_TRUE(sim_pl_aux(&rig, 1));
    rig_ot(0x11, 0x01);
    sim_pl_set_tdie(&rig, 1, 150.0);
    rig_us(1);
    TEST_ASSERT_FALSE(sim_pl_reg50(&rig, 1));
    TEST_ASSERT_FALSE(sim_pl_aux(&rig, 1));
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.4);
    rig_ms(100);
    TEST_ASSERT_EQUAL_HEX8(0, rig_read(1, R_ALERT) & 0x03);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(cell_vectors);
    RUN_TEST(every_millivolt_of_a_cell);
    RUN_TEST(noise_stays_in_its_bounds);
    RUN_TEST(gpai_vectors);
    RUN_TEST(gpai_against_reg50_has_the_same_scale);
    RUN_TEST(brick_vectors);
    RUN_TEST(temperature_vectors);
    RUN_TEST(a_sensor_needs_its_switch_and_its_channel);
    RUN_TEST(reg50_is_off_in_sleep_and_tsd);
    return UNITY_END();
}
