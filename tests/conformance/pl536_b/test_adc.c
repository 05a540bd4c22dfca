/* SPDX-License-Identifier: Apache-2.0 */
/* ADC in general (PL-ADC) and the ambiguities that touch it. */
#include "rig.h"

static const double cells[6] = {3.0, 3.3, 3.6, 3.7, 4.15, 4.2};
static const int codes[6] = {0x1eb8, 0x21ca, 0x24dd, 0x25e3, 0x2a7e, 0x2b01};

static void world(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_cells(&rig, 1, cells));
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_gpai(&rig, 1, 1.0));
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_ts_ratio(&rig, 1, 1, 0.1369));
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_ts_ratio(&rig, 1, 2, 0.2));
    rig_write(1, R_IO, 0x03);
}

/* proves: PL-ADC-01, PL-ADC-03 */
static void nine_inputs_in_big_endian_pairs(void)
{
    rig_ready(1);
    world();
    rig_adc(1, 0x7d, 0x40);
    rig_convert(1);
    EXPECT(0x1e, 1, 0x03);
    EXPECT(0xb8, 1, 0x04);
    for (int c = 0; c < 6; c++) {
        EXPECT_WORD(codes[c], 1, R_CELL1 + 2 * c);
    }
    EXPECT_WORD(0x1999, 1, R_GPAI);
    EXPECT_WORD(0x11aa, 1, R_TEMP1);
    EXPECT_WORD(0x19cd, 1, R_TEMP2);
    rig_shadow(1, C_FUNC, 0x50);
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_vbat(&rig, 1, 20.0));
    rig_convert(1);
    EXPECT_WORD(0x2666, 1, R_GPAI);
    EXPECT_CLEAN();
}

/* proves: PL-ADC-01, PL-ADC-02, PL-ADC-11, PL-AMB-74 */
static void results_clip_and_never_roll_over(void)
{
    rig_ready(1);
    rig_write(1, R_IO, 0x03);
    rig_adc(1, 0x7d, 0x40);
    for (int c = 1; c <= 6; c++) {
        TEST_ASSERT_EQUAL_INT(0, sim_pl_set_cell(&rig, 1, c, 7.5));
    }
    sim_pl_set_gpai(&rig, 1, 5.5);
    sim_pl_set_ts_ratio(&rig, 1, 1, 1.0);
    sim_pl_set_ts_ratio(&rig, 1, 2, 1.0);
    rig_convert(1);
    for (int r = R_GPAI; r <= R_TEMP2; r += 2) {
        EXPECT_WORD(0x3fff, 1, r);
    }
    sim_pl_set_vbat(&rig, 1, 21.6);
    for (int c = 1; c <= 6; c++) {
        sim_pl_set_cell(&rig, 1, c, c == 1 ? 0.0 : -0.25);
    }
    sim_pl_set_gpai(&rig, 1, -0.5);
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.0);
    sim_pl_set_ts_ratio(&rig, 1, 2, 0.0);
    rig_convert(1);
    for (int r = R_GPAI; r <= R_TEMP2; r += 2) {
        EXPECT_WORD(0x0000, 1, r);
    }
}

/* proves: PL-ADC-04, PL-ADC-05, PL-AMB-72 */
static void control_selects_channels_and_the_rest_keep_theirs(void)
{
    for (int control = 0; control < 64; control++) {
        int last = (control & 7) <= 5 ? (control & 7) : 0;
        rig_ready(1);
        for (int r = R_GPAI; r <= R_TEMP2; r += 2) {
            EXPECT_WORD(0x0000, 1, r);
        }
        world();
        rig_adc(1, 0x7d, 0x40);
        rig_convert(1); /* every register now holds the first picture */
        sim_pl_set_gpai(&rig, 1, 2.0);
        sim_pl_set_ts_ratio(&rig, 1, 1, 0.25);
        sim_pl_set_ts_ratio(&rig, 1, 2, 0.25);
        for (int c = 1; c <= 6; c++) {
            sim_pl_set_cell(&rig, 1, c, 2.5);
        }
        rig_write(1, R_ADC, 0x40 | control);
        rig_convert(1);
        EXPECT_WORD(control & 0x08 ? 0x3332 : 0x1999, 1, R_GPAI);
        EXPECT_WORD(control & 0x10 ? 0x2044 : 0x11aa, 1, R_TEMP1);
        EXPECT_WORD(control & 0x20 ? 0x2042 : 0x19cd, 1, R_TEMP2);
        for (int c = 0; c < 6; c++) {
            EXPECT_WORD(c <= last ? 0x1999 : codes[c], 1, R_CELL1 + 2 * c);
        }
    }
}

/* proves: PL-ADC-06, PL-AMB-73, PL-COV-10 */
static void scan_and_masking_are_independent(void)
{
    rig_ready(1);
    world();
    rig_adc(1, 0x45, 0x4c); /* CN = 3 cells, CELL_SEL = 6 cells */
    rig_convert(1);
    EXPECT_WORD(0x2b01, 1, R_CELL6);
    rig_adc(1, 0x40, 0x40); /* CELL_SEL = cell 1, CN = 6 cells */
    rig_cov(0x2a, 0);       /* 4.10 V: cells 5 and 6 lie above */
    rig_us(1);
    EXPECT(0x30, 1, R_COV);
}

/* proves: PL-ADC-07, PL-CUV-08 */
static void shorted_inputs_read_zero_and_count_as_empty(void)
{
    rig_ready(1);
    sim_pl_set_cell(&rig, 1, 5, 0.0);
    sim_pl_set_cell(&rig, 1, 6, 0.0);
    rig_adc(1, 0x4d, 0x50);
    rig_convert(1);
    EXPECT_WORD(0x24dd, 1, R_CELL1);
    EXPECT_WORD(0, 1, R_CELL6 - 2);
    EXPECT_WORD(0, 1, R_CELL6);
    EXPECT_WORD(0x1ba6, 1, R_GPAI); /* 14.4 V: four cells */
    rig_cuv(0x15, 0);
    rig_us(1);
    EXPECT(0x30, 1, R_CUV);
    rig_shadow(1, C_FUNC, 0x58);
    rig_us(1);
    EXPECT(0x00, 1, R_CUV);
}

static void lock(int adct, bool pin)
{
    rig_ready(1);
    rig_write(1, R_ADC, 0x45);
    rig_ms(1);
    rig_convert(1);
    EXPECT_WORD(0x24dd, 1, R_CELL1);
    rig_shadow(1, C_FUNC, adct << 6);
    EXPECT_CLEAN();
    rig_write(1, R_ADC, 0x05);
    sim_pl_set_cell(&rig, 1, 1, 2.5);
    if (pin) {
        sim_pl_set_conv(&rig, true);
        rig_us(10);
        sim_pl_set_conv(&rig, false);
    } else {
        rig_write(1, R_CONV, 1);
    }
    rig_ms(100);
}

static void expect_locked(void)
{
    MODE(SIM_PL_LOCKED, 1);
    EXPECT(0x80, 1, R_STATUS);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    EXPECT_WORD(0x24dd, 1, R_CELL1);
}

/* proves: PL-ADC-12, PL-AMB-66, PL-GEN-02 */
static void lock_up_stays_until_reset(void)
{
    for (int adct = 1; adct <= 3; adct++) {
        for (int pin = 0; pin <= 1; pin++) {
            lock(adct, pin != 0);
            expect_locked();
            EXPECT_MISUSE("PL-ADC-12", "PL-AMB-66");
            rig_write(1, R_ADC, 0x45); /* neither settings nor further starts help */
            rig_shadow(1, C_FUNC, 0x00);
            rig_ms(2);
            rig_write(1, R_CONV, 1);
            sim_pl_set_conv(&rig, true);
            rig_ms(10);
            sim_pl_set_conv(&rig, false);
            expect_locked();
            EXPECT(0x45, 1, R_ADC);   /* the bus goes on */
            rig_write(1, R_IO, 0x04); /* SLEEP waits for the conversion */
            rig_ms(100);
            expect_locked();
            EXPECT(0x00, 1, R_ALERT);
            rig_write(1, R_IO, 0x00);
            rig_cov(0x1e, 0x01); /* the comparators go on */
            rig_ms(1);
            EXPECT(0x3e, 1, R_COV);
            rig_reset(1);
            MODE(SIM_PL_ACTIVE, 1);
            EXPECT(0x61, 0, R_STATUS);
            rig_address(1);
            rig_convert(1);
            EXPECT_WORD(0x1999, 1, R_CELL1);
        }
    }
}

/* proves: PL-ADC-12, PL-POR-13 */
static void lock_up_ends_with_power_or_broadcast_reset(void)
{
    lock(1, false);
    expect_locked();
    sim_pl_set_supply(&rig, 1, false);
    rig_ms(1);
    sim_pl_set_supply(&rig, 1, true);
    rig_ms(57);
    MODE(SIM_PL_ACTIVE, 1);
    lock(2, false);
    expect_locked();
    rig_reset(ALL);
    MODE(SIM_PL_ACTIVE, 1);
}

/* proves: PL-ADC-12, PL-CONV-07 */
static void programmed_part_locks_up_on_the_pin_after_its_reset(void)
{
    rig_up(2);
    sim_pl_set_otp(&rig, 2, C_FUNC, 0x50);
    sim_pl_set_supply(&rig, 2, false);
    rig_us(100);
    sim_pl_set_supply(&rig, 2, true);
    rig_ms(60);
    sim_pl_set_conv(&rig, true); /* nobody is addressed */
    rig_ms(1);
    sim_pl_set_conv(&rig, false);
    MODE(SIM_PL_ACTIVE, 1);
    MODE(SIM_PL_LOCKED, 2);
    EXPECT_MISUSE("PL-ADC-12", "PL-AMB-66");
}

/* proves: PL-ADC-15, PL-AMB-63 */
static void automatic_mode_adds_the_wake_up_every_time(void)
{
    rig_ready(1);
    rig_write(1, R_ADC, 0x05);
    for (int again = 0; again < 3; again++) {
        rig_write(1, R_CONV, 1);
        rig_us(520);
        EXPECT(0x80, 1, R_STATUS);
        rig_us(1);
        EXPECT(0x81, 1, R_STATUS);
        rig_us(50);
    }
    EXPECT_CLEAN();
}

/* proves: PL-ADC-18, PL-AMB-64, PL-TIM-15 */
static void start_inside_the_wake_up_is_held(void)
{
    rig_ready(1);
    rig_write(1, R_ADC, 0x45);
    rig_us(100);
    rig_write(1, R_CONV, 1);
    rig_us(400 + 20);
    EXPECT(0x80, 1, R_STATUS);
    TEST_ASSERT_FALSE(sim_pl_drdy_pin(&rig));
    rig_us(1); /* 500 us of the wake-up, 21 us for six channels */
    EXPECT(0x81, 1, R_STATUS);
    rig_ms(5);
    rig_write(1, R_CONV, 1); /* permanently on: no wake-up any more */
    rig_us(20);
    EXPECT(0x80, 1, R_STATUS);
    rig_us(1);
    EXPECT(0x81, 1, R_STATUS);
}

/* proves: PL-ADC-20, PL-CONV-13, PL-AMB-70 */
static void the_adc_rests_in_uvlo_sleep_and_tsd(void)
{
    for (int state = 0; state < 3; state++) {
        rig_ready(1);
        rig_adc(1, 0x45, 0x40);
        if (state == 0) {
            rig_write(1, R_IO, 0x04);
        } else if (state == 1) {
            sim_pl_set_vbat(&rig, 1, 5.2);
        } else {
            sim_pl_set_tdie(&rig, 1, 150.0);
        }
        rig_ms(1);
        MODE(state == 0 ? SIM_PL_SLEEP : state == 1 ? SIM_PL_UVLO : SIM_PL_TSD, 1);
        EXPECT(0x45, 1, R_ADC);
        TEST_ASSERT_EQUAL_HEX8(0x01, rig_read(1, R_STATUS) & 1);
        rig_write(1, R_CONV, 1);
        TEST_ASSERT_EQUAL_HEX8(0x01, rig_read(1, R_STATUS) & 1);
        rig_ms(5);
        sim_pl_set_conv(&rig, true);
        TEST_ASSERT_EQUAL_HEX8(0x01, rig_read(1, R_STATUS) & 1);
        rig_ms(5);
        EXPECT_WORD(0, 1, R_CELL1);
        TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 1));
        if (state == 0) { /* the host knows of SLEEP, not of the other two */
            EXPECT_MISUSE("PL-CONV-13", "PL-AMB-70", "PL-ADC-20");
        }
        sim_pl_set_conv(&rig, false);
        sim_pl_set_vbat(&rig, 1, -1.0);
        sim_pl_set_tdie(&rig, 1, 25.0);
        rig_ms(1);
        rig_write(1, R_IO, 0x00);
        rig_ms(10); /* the request was not remembered */
        TEST_ASSERT_EQUAL_UINT32(0, sim_pl_conversions(&rig, 1));
        EXPECT(0x45, 1, R_ADC);
        rig_convert(1);
        EXPECT_WORD(0x24dd, 1, R_CELL1);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(nine_inputs_in_big_endian_pairs);
    RUN_TEST(results_clip_and_never_roll_over);
    RUN_TEST(control_selects_channels_and_the_rest_keep_theirs);
    RUN_TEST(scan_and_masking_are_independent);
    RUN_TEST(shorted_inputs_read_zero_and_count_as_empty);
    RUN_TEST(lock_up_stays_until_reset);
    RUN_TEST(lock_up_ends_with_power_or_broadcast_reset);
    RUN_TEST(programmed_part_locks_up_on_the_pin_after_its_reset);
    RUN_TEST(automatic_mode_adds_the_wake_up_every_time);
    RUN_TEST(start_inside_the_wake_up_is_held);
    RUN_TEST(the_adc_rests_in_uvlo_sleep_and_tsd);
    return UNITY_END();
}
