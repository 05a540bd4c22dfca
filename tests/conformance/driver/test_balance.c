/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing with pauses, SLEEP and open wires: PL-SEQ-10, PL-SEQ-11, PL-SEQ-14. */
#include "bench.h"

static void expect_outputs(int devices, int device, unsigned mask)
{
    for (int d = 1; d <= devices; d++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(d == device ? mask : 0u, sim_pl_cb(&b.pl, d),
                                       bench_text("device %d", d));
    }
}

/* proves: PL-SEQ-10-01, PL-SEQ-10-02, PL-SEQ-10-03, PL-CB-13, PL-CB-14, PL-AMB-82, PL-AMB-84, PL-AMB-85,
 * PL-AMB-88, PL-VEC-30, PL-CB-10 */
static void order_of_the_writes(void)
{
    for (int device = 1; device <= 3; device++) {
        for (unsigned mask = 1; mask < 64; mask++) {
            bench_ready(3, NULL);
            bench_mark();
            EXPECT_STATUS(BQ_OK, bench_balance(device, mask));
            expect_outputs(3, device, mask);
            int on = -1, timer = -1;
            for (uint32_t i = 0; i < b.packets; i++) {
                const bench_packet *p = &b.log[i];
                on = IS_WRITE(p) && p->tx[1] == 0x32 && p->tx[2] != 0 ? (int)i : on;
                timer = IS_WRITE(p) && p->tx[1] == 0x33 ? (int)i : timer;
            }
            TEST_ASSERT_TRUE(on >= 0 && timer < on);
            TEST_ASSERT_EQUAL_HEX8(mask, b.log[on].tx[2]);
            TEST_ASSERT_TRUE(bench_find(on, RD(device), 0x32) > on); /* CB_CTRL read back, and CBT */
            TEST_ASSERT_EQUAL_HEX8(0x04, PEEK(device, 0x33));
            bench_no_misuse();
            bench_judge_packets();
        }
    }
}

/* proves: PL-SEQ-10-04, PL-CB-15, PL-ADC-22, PL-SEQ-06-01, PL-SEQ-10-08, PL-VEC-31 */
static void measured_only_while_off_and_settled(void)
{
    bench_ready(3, NULL);
    for (int i = 0; i < 10; i++) {
        EXPECT_STATUS(BQ_OK, bench_balance(2, 0x2a));
        bench_wait_ms(900);
        bench_mark();
        EXPECT_STATUS(BQ_OK, bench_scan());
        expect_outputs(3, 0, 0);
        int off = bench_find(0, 0x7f, 0x32), convert = bench_find(0, 0x7f, 0x34);
        TEST_ASSERT_TRUE(off >= 0 && off < convert);
        TEST_ASSERT_EQUAL_HEX8(0x00, b.log[off].tx[2]);
        TEST_ASSERT_TRUE(b.log[convert].t_us - b.log[off].t_us >= 10000);
        TEST_ASSERT_TRUE(bench_find(convert, RD(2), 0x00) > convert); /* the burst shows CBT */
        bench_sample();
        TEST_ASSERT_EQUAL_HEX16(0x2a, MODULE(2)->balancing);
        TEST_ASSERT_EQUAL_HEX16(0x00, MODULE(1)->balancing);
    }
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0));
    EXPECT_STATUS(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(0x00, (bench_sample(), MODULE(2)->balancing));
    bench_no_misuse();
}

/* proves: PL-SEQ-10-04, PL-CB-15, PL-SEQ-06-01 */
static void an_off_that_got_lost_does_not_spoil_the_readings(void)
{
    for (int bit = 0; bit <= 32; bit++) { /* 0 = the whole packet, else one bit of it */
        bench_ready(3, NULL);
        EXPECT_STATUS(BQ_OK, bench_balance(2, 0x2a));
        bench_wait_ms(100);
        bench_mark();
        b.lose = bit == 0;
        sim_pl_bus_fault(&b.pl)->flip_mosi_bit = bit;
        EXPECT_STATUS(BQ_OK, bench_scan());
        expect_outputs(3, 0, 0);
        int convert = -1, off = -1;
        for (int i = bench_find(0, 0x7f, 0x34); i >= 0; i = bench_find(i + 1, 0x7f, 0x34)) {
            convert = i;
        }
        for (int i = 1; i < convert; i++) { /* the first packet is the damaged one */
            off = IS_WRITE(&b.log[i]) && b.log[i].tx[1] == 0x32 ? i : off;
        }
        TEST_ASSERT_TRUE_MESSAGE(off > 0, bench_text("bit %d", bit));
        TEST_ASSERT_TRUE(b.log[convert].t_us - b.log[off].t_us >= 10000);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, (bench_sample(), CELL(2, 2)->quality));
    }
}

/* proves: PL-SEQ-10-05, PL-CB-13, PL-SEQ-10-04 */
static void every_apply_gives_the_full_time(void)
{
    bench_ready(2, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(1, 0x01));
    for (int i = 0; i < 6;
         i++) { /* re-applied without a scan in between: still extended by a zero, never without */
        bench_wait_ms(3000);
        EXPECT_STATUS(BQ_OK, bench_balance(1, i & 1 ? 0x01 : 0x03));
        expect_outputs(2, 1, i & 1 ? 0x01 : 0x03);
    }
    bench_wait_ms(3900);
    expect_outputs(2, 1, 0x01);
    bench_wait_ms(200);
    expect_outputs(2, 0, 0);
}

/* proves: PL-SEQ-10-06, PL-CB-14 */
static void a_hung_host_is_caught_by_the_timer(void)
{
    bench_ready(2, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x3f));
    bench_wait_ms(10000);
    expect_outputs(2, 0, 0);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x3f));
    expect_outputs(2, 2, 0x3f);
}

/* proves: PL-SEQ-10-01, PL-SEQ-10-07, PL-UVLO-04 */
static void no_balancing_with_a_fault(void)
{
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x01));
    sim_pl_set_cell(&b.pl, 2, 6, 4.3);
    bench_wait_ms(800);
    EXPECT_STATUS(BQ_OK, bench_scan());
    bench_balance(2, 0x01);
    expect_outputs(3, 0, 0);
    bench_ready(3, NULL); /* a device that was not measured */
    sim_pl_set_supply(&b.pl, 3, false);
    bench_wait_ms(1);
    bench_scan();
    bench_balance(3, 0x3f);
    bench_balance(2, 0x3f);
    sim_pl_set_supply(&b.pl, 3, true);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&b.pl, 3));
}

/* proves: PL-SEQ-10-03, PL-SEQ-00-02 */
static void outputs_that_do_not_come_on_are_reported(void)
{
    bench_ready(2, NULL);
    sim_pl_set_vbat(&b.pl, 2, 5.2); /* UVLO between the scan and the action */
    bench_wait_ms(1);
    bq_status status = bench_balance(2, 0x07);
    TEST_ASSERT_TRUE(status != BQ_OK);
    expect_outputs(2, 0, 0);
}

/* proves: PL-SEQ-11-01, PL-SEQ-11-02, PL-SEQ-11-03, PL-SEQ-11-05, PL-SEQ-11-06, PL-SLEEP-04, PL-SLEEP-09,
 * PL-SLEEP-12, PL-AMB-86, PL-AMB-81, PL-AMB-51, PL-AMB-90, PL-DRDY-05, PL-TS-06, PL-SLEEP-07, PL-GPIO-06,
 * PL-AMB-70, PL-ADC-18 */
static void order_of_sleep_and_wake(void)
{
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_balance(2, 0x3f));
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_sleep());
    int off = bench_find(0, 0x7f, 0x32), enter = bench_find(0, 0x7f, 0x31), clear = bench_find(0, 0x7f, 0x20);
    TEST_ASSERT_TRUE(off >= 0 && off < enter && enter < clear);
    TEST_ASSERT_EQUAL_HEX8(0x04, b.log[enter].tx[2]);
    TEST_ASSERT_EQUAL_HEX8(0x04, b.log[clear].tx[2]);
    TEST_ASSERT_EQUAL_HEX8(0x00, b.log[clear + 1].tx[2]);
    for (int d = 1; d <= 3; d++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&b.pl, d));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x32));
        TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(d, 0x30) & 0x40);
        TEST_ASSERT_TRUE(bench_find(enter, RD(d), -1) > enter); /* each verified */
    }
    TEST_ASSERT_FALSE(sim_pl_alert_pin(&b.pl));
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->scan(b.afe.ctx));
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(0, CELL(1, 1)->quality & BQ_Q_VALID);
    bench_wait_ms(100000);
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_wake());
    int leave = bench_find(0, 0x7f, 0x31);
    TEST_ASSERT_TRUE(leave >= 0);
    TEST_ASSERT_EQUAL_HEX8(0x03, b.log[leave].tx[2]);
    EXPECT_STATUS(BQ_OK, bench_scan());
    int convert = bench_find(0, 0x7f, 0x34), adc = -1;
    for (uint32_t i = 0; i < b.packets && adc < 0; i++) {
        adc = IS_WRITE(&b.log[i]) && b.log[i].tx[1] == 0x30 ? (int)i : -1;
    }
    TEST_ASSERT_TRUE(leave < adc && adc < convert);
    TEST_ASSERT_TRUE(b.log[adc].t_us - b.log[leave].t_us >= 1000);
    TEST_ASSERT_TRUE(b.log[convert].t_us - b.log[adc].t_us >= 1000);
    TEST_ASSERT_TRUE(b.log[convert].t_us - b.log[leave].t_us >= 10000); /* sensors */
    bench_no_misuse();
    bench_judge_packets();
}

/* proves: PL-SEQ-11-05, PL-SEQ-11-06, PL-SLEEP-09, PL-TIM-24, PL-TIM-16 */
static void waits_of_the_wake_up_on_a_fast_bus(void)
{
    bench_up(1, NULL);
    b.config.spi_hz = 1000000;
    b.config.sensors = 0;
    b.config.ot_c[0] = b.config.ot_c[1] = 0;
    bench_ready_from();
    EXPECT_STATUS(BQ_OK, bench_sleep());
    bench_wait_ms(100);
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_wake());
    EXPECT_STATUS(BQ_OK, bench_scan());
    int leave = -1, adc = -1, convert = -1;
    for (uint32_t i = 0; i < b.packets; i++) {
        const bench_packet *p = &b.log[i];
        leave = leave < 0 && IS_WRITE(p) && p->tx[1] == 0x31 ? (int)i : leave;
        adc = adc < 0 && IS_WRITE(p) && p->tx[1] == 0x30 ? (int)i : adc;
        convert = convert < 0 && IS_WRITE(p) && p->tx[1] == 0x34 ? (int)i : convert;
    }
    TEST_ASSERT_TRUE(leave >= 0 && leave < adc && adc < convert);
    TEST_ASSERT_TRUE(b.log[adc].t_us - b.log[leave].t_us >= 1000);
    TEST_ASSERT_TRUE(b.log[convert].t_us - b.log[adc].t_us >= 1000);
}

/* proves: PL-CB-13, PL-CB-17, PL-AMB-88, PL-SEQ-10-03 */
static void every_cell_of_the_tallest_stack_by_its_number(void)
{
    static const uint8_t mixed[62] = {3, 4, 5, 6, 3, 6, 5, 4, 6, 6, 3, 3, 4, 5, 6, 6, 6, 6, 6, 6, 6,
                                      6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6,
                                      6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 6, 3};
    for (int kind = 0; kind <= 1; kind++) {
        bench_up(62, NULL);
        b.config.cells = kind ? mixed : NULL;
        for (int d = 1; kind && d <= 62; d++) {
            for (int c = mixed[d - 1] + 1; c <= 6; c++) {
                sim_pl_set_cell(&b.pl, d, c, 0.0);
            }
        }
        bench_ready_from();
        uint16_t n = 0;
        for (int d = 1; d <= 62; d++) {
            int cells = kind ? mixed[d - 1] : 6;
            for (int c = 1; c <= cells; c++) {
                n++;
                if (d % 5 != 1 && d != 62 && kind == 0) {
                    continue;
                }
                bq_action action = {.charge_on = true};
                bq_mask_set(action.balance, n);
                EXPECT_STATUS(BQ_OK, bench_scan());
                EXPECT_STATUS(BQ_OK, bench_apply(&action));
                expect_outputs(62, d, 1u << (c - 1));
            }
        }
        bench_no_misuse();
    }
}

/* proves: PL-SEQ-11-07, PL-SEQ-11-08, PL-POR-11 */
static void what_happened_in_sleep_is_seen(void)
{
    bench_ready(3, NULL);
    EXPECT_STATUS(BQ_OK, bench_sleep());
    sim_pl_set_supply(&b.pl, 2, false);
    bench_wait_ms(10);
    sim_pl_set_supply(&b.pl, 2, true);
    sim_pl_set_cell(&b.pl, 3, 2, 4.4);
    bench_wait_ms(1000);
    (void)bench_wake();
    for (int i = 0; i < 6; i++) {
        if (bench_scan() == BQ_E_STATE) {
            bench_start();
        }
        bench_wait_ms(300);
    }
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(2, 1)->quality);
    TEST_ASSERT_EQUAL_HEX8(0x2c, PEEK(2, 0x42));
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, MODULE(3)->faults & BQ_F_CELL_OV);
    TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&b.pl, 1));
}

/* proves: PL-SEQ-14-01, PL-SEQ-14-02, PL-VBAT-06, PL-VBAT-07 */
static void the_brick_tells_an_open_end_but_not_too_early(void)
{
    for (int mv = -110; mv <= 50; mv += 10) { /* legal tolerances never alarm */
        bench_ready(1, NULL);
        sim_pl_set_vbat(&b.pl, 1, 21.6 + mv / 1000.0);
        for (int i = 0; i < 10; i++) {
            EXPECT_STATUS(BQ_OK, bench_scan());
        }
        bench_sample();
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->faults);
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->open_wire);
    }
    bench_ready(2, NULL);
    sim_pl_set_vbat(&b.pl, 2, 21.6 + 2.7);
    for (int i = 0; i < 10; i++) {
        EXPECT_STATUS(BQ_OK, bench_scan());
    }
    bench_sample();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, MODULE(2)->faults & BQ_F_OPEN_WIRE);
    TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->faults);
}

/* proves: PL-SEQ-14-03, PL-SEQ-14-04, PL-SEQ-14-05 */
static void every_open_wire_is_named(void)
{
    for (int wire = 0; wire <= 6; wire++) {
        bench_ready(2, NULL);
        sim_pl_set_wire(&b.pl, 2, wire, true);
        for (int i = 0; i < 6; i++) {
            bench_scan();
            bench_wait_ms(100);
        }
        (void)bench_run(bq76pl536_wire_test(&b.driver));
        bench_sample();
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(1 << wire, MODULE(2)->open_wire, bench_text("wire %d", wire));
        TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, MODULE(2)->faults & BQ_F_OPEN_WIRE);
        if (wire > 0) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_OPEN_WIRE, CELL(2, wire)->quality & (BQ_Q_OPEN_WIRE | BQ_Q_VALID));
        }
        if (wire < 6) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_OPEN_WIRE,
                                   CELL(2, wire + 1)->quality & (BQ_Q_OPEN_WIRE | BQ_Q_VALID));
        }
        TEST_ASSERT_EQUAL_HEX16(0, MODULE(1)->open_wire);
        expect_outputs(2, 0, 0);
        bench_balance(2, 0x3f); /* no balancing of this device */
        expect_outputs(2, 0, 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(order_of_the_writes);
    RUN_TEST(measured_only_while_off_and_settled);
    RUN_TEST(an_off_that_got_lost_does_not_spoil_the_readings);
    RUN_TEST(every_apply_gives_the_full_time);
    RUN_TEST(a_hung_host_is_caught_by_the_timer);
    RUN_TEST(no_balancing_with_a_fault);
    RUN_TEST(outputs_that_do_not_come_on_are_reported);
    RUN_TEST(order_of_sleep_and_wake);
    RUN_TEST(waits_of_the_wake_up_on_a_fast_bus);
    RUN_TEST(every_cell_of_the_tallest_stack_by_its_number);
    RUN_TEST(what_happened_in_sleep_is_seen);
    RUN_TEST(the_brick_tells_an_open_end_but_not_too_early);
    RUN_TEST(every_open_wire_is_named);
    return UNITY_END();
}
