/* SPDX-License-Identifier: Apache-2.0 */
/* Power-up, address discovery, configuration and conversion set-up: PL-SEQ-01 to PL-SEQ-04. */
#include "bench.h"

/* Packets of discovery alone, in order. */
static int discovery(const bench_packet **out, int max)
{
    int n = 0;
    for (uint32_t i = 0; i < b.packets && n < max; i++) {
        const bench_packet *p = &b.log[i];
        if (p->tx[1] == 0x3b || p->tx[1] == 0x3c) {
            out[n++] = p;
        }
    }
    return n;
}

static void start(int devices)
{
    bench_up(devices, NULL);
    bench_init();
    EXPECT_STATUS(BQ_OK, bench_start());
    bench_no_misuse();
    bench_judge_packets();
}

/* proves: PL-SEQ-02-01, PL-SEQ-02-02, PL-SEQ-02-03, PL-SEQ-02-04, PL-SEQ-02-05, PL-SEQ-02-07, PL-ADR-11,
 * PL-ADR-12, PL-ADR-13, PL-ADR-06, PL-ADR-16, PL-AMB-31, PL-AMB-26, PL-ADR-05, PL-POR-09, PL-AMB-93,
 * PL-TIM-19, PL-AMB-18, PL-AMB-19 */
static void discovery_grows_by_one_device_per_reset(void)
{
    static const bench_packet *p[2000];
    for (int devices = 1; devices <= 9; devices++) {
        start(devices);
        int n = discovery(p, 2000), at = 0;
        for (int pass = 1; pass <= devices; pass++) {
            TEST_ASSERT_EQUAL_HEX8(0x7f, p[at]->tx[0]);
            TEST_ASSERT_EQUAL_HEX8(0x3c, p[at]->tx[1]);
            TEST_ASSERT_TRUE(p[at + 1]->t_us - p[at]->t_us >= 1000);
            at++;
            for (int k = 1; k <= pass; k++, at += 2) {
                TEST_ASSERT_EQUAL_HEX8(0x01, p[at]->tx[0]);
                TEST_ASSERT_EQUAL_HEX8(0x80 | k, p[at]->tx[2]);
                TEST_ASSERT_EQUAL_HEX8(RD(k), p[at + 1]->tx[0]);
                TEST_ASSERT_EQUAL_HEX8(0x3b, p[at + 1]->tx[1]);
            }
        }
        TEST_ASSERT_TRUE(n >= at);
        for (; at < n; at++) {
            TEST_ASSERT_TRUE(IS_READ(p[at])); /* nothing is assigned or reset afterwards */
        }
        for (int k = 1; k <= devices; k++) {
            TEST_ASSERT_EQUAL_HEX8(0x80 | k, PEEK(k, 0x3b));
        }
        TEST_ASSERT_EQUAL_INT(devices, b.afe.ops->modules_found(b.afe.ctx));
    }
}

/* proves: PL-SEQ-02-08, PL-ADR-14 */
static void nothing_may_answer_at_zero_afterwards(void)
{
    start(3);
    int last = -1;
    for (int i = bench_find(0, 0x01, 0x3b); i >= 0; i = bench_find(i + 1, 0x01, 0x3b)) {
        last = i;
    }
    TEST_ASSERT_TRUE(bench_find(last, 0x00, 0x00) > last);
    bench_up(4, NULL);
    b.config.devices = 3;
    bench_init();
    EXPECT_STATUS(BQ_E_EXTRA_DEVICE, bench_start());
}

/* proves: PL-SEQ-02-10, PL-SEQ-02-09, PL-ALT-09, PL-AMB-28, PL-AMB-33, PL-AMB-54, PL-FLT-12, PL-ADR-07,
 * PL-NUM-42 */
static void address_and_reset_flags_are_cleared_and_checked(void)
{
    start(3);
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x81, PEEK(d, 0x00));
    }
    int reg[2] = {0x20, 0x21}, bit[2] = {0x80, 0x08};
    for (int k = 0; k < 2; k++) {
        int cleared = 0;
        for (uint32_t i = 0; i + 1 < b.packets; i++) {
            const bench_packet *p = &b.log[i];
            if (IS_WRITE(p) && p->tx[1] == reg[k] && p->tx[2] != 0 && p->tx[2] != 0x10) {
                TEST_ASSERT_EQUAL_HEX8(p->tx[0], p[1].tx[0]); /* the pair: mask, then 0 */
                TEST_ASSERT_EQUAL_HEX8(reg[k], p[1].tx[1]);
                TEST_ASSERT_EQUAL_HEX8(0x00, p[1].tx[2]);
                cleared |= (p->tx[2] & bit[k]) != 0;
            }
        }
        TEST_ASSERT_TRUE(cleared);
    }
}

/* proves: PL-SEQ-01-01, PL-SEQ-01-02, PL-SEQ-01-04, PL-SEQ-01-05, PL-TIM-10, PL-ADC-19, PL-AMB-65, PL-POR-06,
 * PL-SEQ-01-03, PL-CONV-04, PL-AMB-69 */
static void waits_of_the_power_up(void)
{
    static const struct {
        int devices;
        uint32_t hz;
    } v[] = {{1, 250000}, {16, 250000}, {17, 125000}, {32, 125000}, {33, 62500}, {62, 62500}};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        start(v[i].devices);
        TEST_ASSERT_TRUE(b.log[0].t_us >= 70000);
        TEST_ASSERT_EQUAL_UINT32(v[i].hz, b.hz);
        TEST_ASSERT_EQUAL_INT(
            -1, bench_find(0, 0x7f, 0x34)); /* FAULT and ALERT are high here: nobody waited for them */
        EXPECT_STATUS(BQ_OK, bench_scan());
        int convert = bench_find(0, 0x7f, 0x34);
        TEST_ASSERT_TRUE(convert >= 0 && (uint32_t)convert < BENCH_LOG);
        TEST_ASSERT_TRUE(b.log[convert].t_us >= 120000);
        TEST_ASSERT_FALSE(sim_pl_conv(&b.pl));
    }
}

/* proves: PL-SEQ-01-05, PL-ADC-19, PL-TIM-18 */
static void first_conversion_waits_when_bring_up_was_quick(void)
{
    bench_up(1, NULL);
    b.config.cov_delay_us = 100;
    b.config.cuv_delay_us = 100;
    b.config.ot_delay_ms = 20;
    bench_ready_from();
    int convert = bench_find(0, 0x7f, 0x34);
    TEST_ASSERT_TRUE(b.log[convert].t_us >= 120000);
}

static int first_write(int from, int reg)
{
    for (uint32_t i = (uint32_t)from; i < b.packets; i++) {
        if (IS_WRITE(&b.log[i]) && b.log[i].tx[1] == reg) {
            return (int)i;
        }
    }
    return -1;
}

static int last_write(int reg)
{
    int last = -1;
    for (int i = first_write(0, reg); i >= 0; i = first_write(i + 1, reg)) {
        last = i;
    }
    return last;
}

/* proves: PL-SEQ-03-03, PL-SEQ-03-04, PL-SEQ-03-05, PL-SEQ-03-06, PL-SEQ-03-07, PL-SEQ-03-08, PL-SEQ-04-01,
 * PL-SEQ-04-02, PL-ADC-13, PL-TIM-16, PL-ADC-10, PL-BCAST-03, PL-AMB-46, PL-SPI-14, PL-ADC-18, PL-AMB-64,
 * PL-AMB-99, PL-GPIO-03, PL-AMB-68 */
static void order_of_the_configuration(void)
{
    start(4);
    int adc = first_write(0, 0x30), func = first_write(0, 0x40);
    TEST_ASSERT_EQUAL_HEX8(0x40, b.log[adc].tx[2] & 0x40);
    TEST_ASSERT_TRUE(adc >= 0 && adc < func);
    TEST_ASSERT_TRUE(b.log[func].t_us - b.log[adc].t_us >= 1000);
    TEST_ASSERT_TRUE(last_write(0x42) < first_write(0, 0x43) && first_write(0, 0x42) >= 0);
    TEST_ASSERT_TRUE(last_write(0x44) < first_write(0, 0x45) && first_write(0, 0x44) >= 0);
    TEST_ASSERT_TRUE(last_write(0x44) < first_write(0, 0x43));
    TEST_ASSERT_TRUE(last_write(0x42) < first_write(0, 0x45));
    TEST_ASSERT_TRUE(last_write(0x47) < first_write(0, 0x46) && first_write(0, 0x47) >= 0);
    TEST_ASSERT_TRUE(func < first_write(0, 0x42)); /* CN masks before the comparators are armed */
    TEST_ASSERT_EQUAL_HEX8(0x03, PEEK(4, 0x31));
    TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(4, 0x30));
}

static void expect_group3(int device, const uint8_t *want)
{
    for (int r = 0x40; r <= 0x4b; r++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(want[r - 0x40], PEEK(device, (uint8_t)r),
                                       bench_text("dev %d reg %02x", device, r));
    }
}

static const uint8_t usual[12] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85, 0x55, 0x64, 0x11, 0x22, 0x33, 0x44};

/* proves: PL-SEQ-03-09, PL-BCAST-05, PL-SEQ-00-05, PL-G3-10, PL-CRC-11, PL-SEQ-03-11, PL-NUM-15, PL-NUM-35 */
static void everything_is_read_back_by_unicast(void)
{
    start(5);
    for (int d = 1; d <= 5; d++) {
        uint16_t seen = 0;
        expect_group3(d, usual);
        int written = 0;
        for (int r = 0x40; r <= 0x4b; r++) {
            int w = last_write(r);
            written = w > written ? w : written;
        }
        for (uint32_t i = 0; i < b.packets; i++) {
            const bench_packet *p = &b.log[i];
            if (p->tx[0] == RD(d) && p->tx[1] >= 0x40) {
                for (int r = p->tx[1]; r < p->tx[1] + p->tx[2]; r++) {
                    if ((int)i > last_write(r)) {
                        seen |= (uint16_t)(1u << (r - 0x40));
                    }
                }
            }
        }
        /* USER registers may be left out when nothing is wanted there; here all twelve are */
        TEST_ASSERT_EQUAL_HEX16(0x0fff, seen);
        (void)written;
    }
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&b.pl));
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&b.pl));
}

/* proves: PL-SEQ-03-01, PL-ADC-08, PL-CUV-08, PL-NUM-34, PL-NUM-35, PL-AMB-73, PL-ADC-07, PL-AMB-72,
 * PL-NUM-36 */
static void fewer_cells_set_the_scan_and_the_mask(void)
{
    static const uint8_t cells[4] = {3, 4, 5, 6};
    static const uint8_t function[4] = {0x5c, 0x58, 0x54, 0x50};
    bench_up(4, NULL);
    b.config.cells = cells;
    for (int d = 1; d <= 4; d++) {
        for (int c = cells[d - 1] + 1; c <= 6; c++) {
            sim_pl_set_cell(&b.pl, d, c, 0.0);
        }
    }
    bench_ready_from();
    for (int d = 1; d <= 4; d++) {
        TEST_ASSERT_EQUAL_HEX8(function[d - 1], PEEK(d, 0x40));
        TEST_ASSERT_EQUAL_HEX8(0x78 | (cells[d - 1] - 1), PEEK(d, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x81, PEEK(d, 0x00));
    }
    TEST_ASSERT_EQUAL_INT(18, bench_sample()->cell_count);
    for (int c = 0; c < 18; c++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.sample.cells[c].quality);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.sample.cells[c].mv);
    }
}

/* proves: PL-SEQ-03-05, PL-COV-12, PL-SEQ-04-01, PL-ADC-14, PL-OTP-11 */
static void programmed_parts_are_taken_over(void)
{
    static const uint8_t eprom[4][12] = {
        {0x50, 0, 0x3c, 0x85, 0x1a, 0x85, 0x55, 0x64, 9, 8, 7, 6}, /* higher thresholds than wanted */
        {0x50, 0, 0x06, 0x85, 0x0a, 0x85, 0x11, 0x01, 0, 0, 0, 0}, /* lower ones, the smallest distance */
        {0xd0, 0, 0x80, 0x00, 0x80, 0x00, 0x00, 0x00, 0, 0, 0, 0}, /* comparators off, 24 us */
        {0x5c, 0, 0x2c, 0x9f, 0x15, 0x9f, 0xbb, 0xff, 1, 2, 3, 4},
    };
    for (int k = 0; k < 4; k++) {
        bench_up(3, NULL);
        for (int d = 1; d <= 3; d++) {
            for (int r = 0; r < 12; r++) {
                sim_pl_set_otp(&b.pl, d, (uint8_t)(0x40 + r), eprom[d == 2 ? (k + 1) % 4 : k][r]);
            }
        }
        bench_power_cycle();
        bench_wait_ms(60);
        bench_ready_from();
        for (int d = 1; d <= 3; d++) {
            expect_group3(d, usual);
            TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, d));
            TEST_ASSERT_EQUAL_UINT32(1, sim_pl_conversions(&b.pl, d));
        }
        bench_judge_packets();
    }
}

/* proves: PL-SEQ-02-11, PL-SEQ-13-09, PL-AMB-16, PL-CRC-09, PL-AMB-03 */
static void parts_with_crc_off_in_eprom_are_named(void)
{
    bench_up(3, NULL);
    for (int d = 1; d <= 3; d++) {
        sim_pl_set_otp(&b.pl, d, 0x41, 0x01);
    }
    bench_power_cycle();
    bench_wait_ms(60);
    bench_init();
    bq_status status = bench_start();
    if (status == BQ_OK) { /* brought to CRC: then it must really run with it */
        EXPECT_STATUS(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(1, 0x41));
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, bench_sample()->cells[0].quality);
    } else {
        EXPECT_STATUS(BQ_E_CRC_OFF, status);
    }
}

/* proves: PL-SEQ-03-10, PL-AMB-89, PL-FLT-19 */
static void a_real_fault_at_start_is_reported_not_hidden(void)
{
    bench_up(2, NULL);
    sim_pl_set_cell(&b.pl, 2, 3, 4.35);
    bench_init();
    EXPECT_STATUS(BQ_OK, bench_start());
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(2)->faults & BQ_F_CELL_OV);
    TEST_ASSERT_EQUAL_HEX16(0x04, MODULE(2)->cell_ov);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->faults);
    TEST_ASSERT_INT_WITHIN(1, 4350, CELL(2, 3)->mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 3)->quality);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(discovery_grows_by_one_device_per_reset);
    RUN_TEST(nothing_may_answer_at_zero_afterwards);
    RUN_TEST(address_and_reset_flags_are_cleared_and_checked);
    RUN_TEST(waits_of_the_power_up);
    RUN_TEST(first_conversion_waits_when_bring_up_was_quick);
    RUN_TEST(order_of_the_configuration);
    RUN_TEST(everything_is_read_back_by_unicast);
    RUN_TEST(fewer_cells_set_the_scan_and_the_mask);
    RUN_TEST(programmed_parts_are_taken_over);
    RUN_TEST(parts_with_crc_off_in_eprom_are_named);
    RUN_TEST(a_real_fault_at_start_is_reported_not_hidden);
    return UNITY_END();
}
