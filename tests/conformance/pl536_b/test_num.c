/* SPDX-License-Identifier: Apache-2.0 */
/* Code tables and timing vectors: PL-NUM, PL-TIM. */
#include "rig.h"

/* proves: PL-NUM-13, PL-COV-01, PL-COV-03, PL-AMB-42, PL-COV-11, PL-ELEC-04 */
static void every_cov_code_to_the_microvolt(void)
{
    for (int code = 0x00; code <= 0x3c; code++) {
        int mv = 2000 + 50 * code;
        rig_ready(1);
        sim_pl_set_vbat(&rig, 1, 21.6);
        for (int c = 2; c <= 6; c++) {
            sim_pl_set_cell(&rig, 1, c, 1.5);
        }
        sim_pl_set_cell(&rig, 1, 1, 1.5);
        rig_cov(code, 0x00);
        EXPECT(code, 1, C_COV);
        sim_pl_set_cell(&rig, 1, 1, mv / 1000.0);
        rig_us(1);
        EXPECT(0x00, 1, R_COV); /* equality does not trip */
        sim_pl_set_cell(&rig, 1, 1, (mv * 1000 + 10) / 1e6);
        rig_us(1);
        EXPECT(0x01, 1, R_COV);
        EXPECT(0x01, 1, R_FAULT);
        sim_pl_set_cell(&rig, 1, 1, (mv - 50) / 1000.0);
        rig_us(1);
        EXPECT(0x01, 1, R_COV); /* nor does it release */
        sim_pl_set_cell(&rig, 1, 1, ((mv - 50) * 1000 - 10) / 1e6);
        rig_us(1);
        EXPECT(0x00, 1, R_COV);
        EXPECT(0x00, 1, R_FAULT);
        rig_shadow(1, C_COV, 0x80 | code);
        EXPECT(0x80 | code, 1, C_COV);
        sim_pl_set_cell(&rig, 1, 1, 5.9);
        rig_us(1);
        EXPECT(0x00, 1, R_COV);
        EXPECT_CLEAN();
    }
}

/* proves: PL-NUM-14, PL-CUV-01, PL-CUV-03, PL-AMB-42, PL-CUV-07, PL-ELEC-04 */
static void every_cuv_code_to_the_microvolt(void)
{
    for (int code = 0x00; code <= 0x1a; code++) {
        int mv = 700 + 100 * code;
        rig_ready(1);
        sim_pl_set_vbat(&rig, 1, 21.6);
        for (int c = 1; c <= 6; c++) {
            sim_pl_set_cell(&rig, 1, c, 4.0);
        }
        rig_cuv(code, 0x00);
        EXPECT(code, 1, C_CUV);
        sim_pl_set_cell(&rig, 1, 1, mv / 1000.0);
        rig_us(1);
        EXPECT(0x00, 1, R_CUV);
        sim_pl_set_cell(&rig, 1, 1, (mv * 1000 - 10) / 1e6);
        rig_us(1);
        EXPECT(0x01, 1, R_CUV);
        EXPECT(0x02, 1, R_FAULT);
        sim_pl_set_cell(&rig, 1, 1, (mv + 100) / 1000.0);
        rig_us(1);
        EXPECT(0x01, 1, R_CUV);
        sim_pl_set_cell(&rig, 1, 1, ((mv + 100) * 1000 + 10) / 1e6);
        rig_us(1);
        EXPECT(0x00, 1, R_CUV);
        rig_shadow(1, C_CUV, 0x80 | code);
        EXPECT(0x80 | code, 1, C_CUV);
        sim_pl_set_cell(&rig, 1, 1, 0.1);
        rig_us(1);
        EXPECT(0x00, 1, R_CUV);
        EXPECT_CLEAN();
    }
}

static bool busy(void)
{
    return (rig_read(1, R_STATUS) & 1) == 0;
}

/* proves: PL-NUM-37, PL-CONV-10, PL-ADC-09, PL-AMB-62, PL-AMB-63, PL-TIM-13, PL-TIM-14 */
static void every_conversion_time_to_the_microsecond(void)
{
    static const int step[4] = {3, 6, 12, 24};
    for (int adct = 0; adct < 4; adct++) {
        for (int extra = 0; extra < 8; extra++) { /* TS2, TS1, GPAI */
            for (int sel = 0; sel < 8; sel++) {
                int n = (extra & 1) + (extra >> 1 & 1) + (extra >> 2) + (sel <= 5 ? sel + 1 : 1);
                uint64_t us = (uint64_t)((n + 1) * step[adct]);
                for (int pin = 0; pin <= 1; pin++) {
                    rig_ready(1);
                    rig_adc(1, 0x40 | extra << 3 | sel, adct << 6);
                    if (pin) {
                        sim_pl_set_conv(&rig, true);
                    } else {
                        rig_write(1, R_CONV, 1);
                    }
                    rig_us(us - 1);
                    TEST_ASSERT_TRUE(busy());
                    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
                    rig_us(1);
                    TEST_ASSERT_FALSE(busy());
                    TEST_ASSERT_TRUE(sim_pl_drdy_pin(&rig));
                    EXPECT_CLEAN();
                }
            }
        }
    }
}

/* proves: PL-NUM-37, PL-ADC-15, PL-TIM-15, PL-NUM-34 */
static void automatic_mode_takes_500_us_more(void)
{
    for (int control = 0; control < 64; control++) {
        int sel = control & 7;
        int n = (control >> 3 & 1) + (control >> 4 & 1) + (control >> 5 & 1) + (sel <= 5 ? sel + 1 : 1);
        rig_ready(1);
        rig_write(1, R_ADC, control);
        rig_write(1, R_CONV, 1);
        rig_us((uint64_t)(500 + 3 * (n + 1) - 1));
        TEST_ASSERT_TRUE(busy());
        rig_us(1);
        TEST_ASSERT_FALSE(busy());
    }
}

/* proves: PL-NUM-34 */
static void adc_control_examples(void)
{
    static const struct {
        int control, channels;
    } v[] = {{0x7d, 9}, {0x45, 6}, {0x43, 4}, {0x40, 1}, {0x46, 1},
             {0x47, 1}, {0x50, 2}, {0x60, 2}, {0x70, 3}};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        int seen = 0;
        rig_ready(1);
        rig_write(1, R_IO, 0x03);
        sim_pl_set_gpai(&rig, 1, 1.0);
        rig_adc(1, v[i].control, 0x40);
        EXPECT(v[i].control, 1, R_ADC);
        rig_convert(1);
        for (int r = R_GPAI; r <= R_TEMP2; r += 2) {
            seen += rig_word(1, r) != 0;
        }
        TEST_ASSERT_EQUAL_INT(v[i].channels, seen);
    }
}

/* proves: PL-NUM-35, PL-REG-37 */
static void function_config_examples(void)
{
    static const struct {
        int value, gpai, cells;
        uint64_t us;
    } v[] = {
        {0x50, 0x2979, 0x3f, 60}, {0x40, 0x1999, 0x3f, 60},  {0x60, 0x1999, 0x3f, 60},
        {0x58, 0x2979, 0x0f, 60}, {0x54, 0x2979, 0x1f, 60},  {0x5c, 0x2979, 0x07, 60},
        {0x00, 0x1999, 0x3f, 30}, {0x90, 0x2979, 0x3f, 120}, {0xd0, 0x2979, 0x3f, 240},
    };
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        rig_ready(1);
        sim_pl_set_gpai(&rig, 1, 1.0);
        rig_adc(1, 0x7d, v[i].value);
        rig_write(1, R_CONV, 1);
        rig_us(v[i].us - 1);
        TEST_ASSERT_TRUE(busy());
        rig_us(1);
        TEST_ASSERT_FALSE(busy());
        EXPECT_WORD(v[i].gpai, 1, R_GPAI);
        rig_cov(0x1e, 0x00); /* 3.50 V: every unmasked cell is over */
        rig_us(1);
        EXPECT(v[i].cells, 1, R_COV);
    }
    rig_ready(1);
    rig_shadow(1, C_FUNC, 0xff);
    EXPECT(0xfc, 1, C_FUNC);
}

/* proves: PL-NUM-16, PL-COV-12 */
static void the_distance_of_the_thresholds(void)
{
    static const struct {
        int cov, cuv, legal;
    } v[] = {{0x00, 0x0a, 1}, {0x00, 0x0b, 0}, {0x20, 0x1a, 1}, {0x1f, 0x1a, 0}};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        rig_ready(1);
        rig_shadow(1, C_COV, v[i].cov);
        EXPECT_CLEAN();
        rig_shadow(1, C_CUV, v[i].cuv);
        if (v[i].legal) {
            EXPECT_CLEAN();
        } else {
            EXPECT_MISUSE("PL-COV-12");
        }
    }
}

/* proves: PL-TIM-28 */
static void transfers_take_no_time(void)
{
    rig_ready(3);
    uint64_t before = sim_pl_now(&rig);
    for (int i = 0; i < 100; i++) {
        rig_read(3, R_STATUS);
        rig_write(2, R_CB, 0x00);
    }
    TEST_ASSERT_TRUE(before == sim_pl_now(&rig));
    rig_us(7);
    TEST_ASSERT_TRUE(before + 7000 == sim_pl_now(&rig));
}

/* proves: PL-SPI-12, PL-TIM-01, PL-TIM-04 */
static void the_strict_judge_of_bus_timing(void)
{
    static const uint32_t legal[] = {10000, 250000, 1000000};
    static const uint32_t illegal[] = {9999, 1000001};
    const sim_pl_options o = {.strict_timing = true};
    for (size_t i = 0; i < 3; i++) {
        rig_up_with(1, &o);
        sim_pl_set_spi_clock(&rig, legal[i]);
        rig_read(0, R_STATUS);
        rig_us(4);
        rig_read(0, R_STATUS);
        EXPECT_CLEAN();
    }
    for (size_t i = 0; i < 2; i++) {
        rig_up_with(1, &o);
        sim_pl_set_spi_clock(&rig, illegal[i]);
        rig_read(0, R_STATUS);
        EXPECT_MISUSE("PL-TIM-01", "PL-SPI-12", "PL-SPI-10");
        rig_up(1);
        sim_pl_set_spi_clock(&rig, illegal[i]);
        rig_read(0, R_STATUS);
        EXPECT_CLEAN(); /* only on request */
    }
    rig_up_with(1, &o);
    sim_pl_set_spi_clock(&rig, 250000);
    rig_read(0, R_STATUS);
    rig_us(2);
    rig_read(0, R_STATUS);
    EXPECT_MISUSE("PL-TIM-04", "PL-SPI-04", "PL-SPI-12");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_cov_code_to_the_microvolt);
    RUN_TEST(every_cuv_code_to_the_microvolt);
    RUN_TEST(every_conversion_time_to_the_microsecond);
    RUN_TEST(automatic_mode_takes_500_us_more);
    RUN_TEST(adc_control_examples);
    RUN_TEST(function_config_examples);
    RUN_TEST(the_distance_of_the_thresholds);
    RUN_TEST(transfers_take_no_time);
    RUN_TEST(the_strict_judge_of_bus_timing);
    return UNITY_END();
}
