/* SPDX-License-Identifier: Apache-2.0 */
/* The access primitives PL-SEQ-00, the rules of the jobs, and the back-end of hal/sim. */
#include "bench.h"
#include "hal_sim.h"

/* A bus that answers nothing for the device: counts how often the driver asks. */
static int reads_of(int device, int reg)
{
    return bench_count(RD(device), reg);
}

/* proves: PL-SEQ-00-01, PL-SEQ-06-05 */
static void a_read_is_tried_three_times_and_no_more(void)
{
    bench_ready(1, NULL);
    bench_wait_ms(1);
    bench_mark();
    sim_pl_bus_fault(&b.pl)->flip_probability = 0.5;
    sim_pl_bus_fault(&b.pl)->rng = 3;
    bench_scan();
    sim_pl_bus_fault(&b.pl)->flip_probability = 0;
    TEST_ASSERT_INT_WITHIN(3, 3, reads_of(1, 0x00)); /* the scan may be repeated once */
    TEST_ASSERT_TRUE(b.packets < 100);
    bench_sample();
    TEST_ASSERT_EQUAL_HEX8(0, CELL(1, 1)->quality & BQ_Q_VALID);
}

/* proves: PL-SEQ-00-01, PL-AMB-12 */
static void no_answer_and_damaged_answer_are_different(void)
{
    for (int dead = 1; dead <= 2; dead++) {
        bench_ready(1, NULL);
        const bq_link_stats *s = b.afe.ops->stats(b.afe.ctx);
        bq_link_stats before = *s;
        sim_pl_bus_fault(&b.pl)->dead = dead;
        EXPECT_STATUS(BQ_E_NO_ANSWER, bench_scan());
        TEST_ASSERT_TRUE(s->no_answers > before.no_answers);
        TEST_ASSERT_EQUAL_UINT32(before.crc_errors, s->crc_errors);
    }
    bench_ready(1, NULL);
    const bq_link_stats *s = b.afe.ops->stats(b.afe.ctx);
    bq_link_stats before = *s;
    sim_pl_bus_fault(&b.pl)->late_bits = 1;
    bench_scan();
    TEST_ASSERT_TRUE(s->crc_errors > before.crc_errors);
    TEST_ASSERT_EQUAL_UINT32(before.no_answers, s->no_answers);
}

/* proves: PL-SEQ-00-02, PL-SEQ-00-04, PL-CRC-10, PL-CRC-11 */
static void damaged_writes_are_cleared_and_repeated(void)
{
    uint32_t total;
    bench_ready(2, NULL);
    bench_mark();
    EXPECT_STATUS(BQ_OK, bench_balance(1, 0x15));
    total = b.packets;
    for (uint32_t n = 0; n < total; n++) {
        for (int bit = 0; bit < 40; bit += 7) {
            bench_ready(2, NULL);
            bench_mark();
            EXPECT_STATUS(BQ_OK, b.afe.ops->apply(b.afe.ctx, &(bq_action){.balance = {0x15}}));
            bq_status status;
            bool armed = false;
            do {
                if (b.packets == n && !armed) {
                    sim_pl_bus_fault(&b.pl)->flip_mosi_bit = 1 + bit;
                    armed = true;
                }
                status = b.afe.ops->poll(b.afe.ctx, NULL);
                sim_pl_advance(&b.pl, 20000);
            } while (status == BQ_PENDING);
            EXPECT_STATUS(BQ_OK, status);
            TEST_ASSERT_EQUAL_HEX8(0x15, sim_pl_cb(&b.pl, 1));
            TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_cb(&b.pl, 2));
            for (int i = 0; i < 2; i++) { /* the flag is cleared by the next scan at the latest */
                bench_scan();
            }
            TEST_ASSERT_EQUAL_HEX8(0x00, PEEK(1, 0x21));
            bench_judge_packets();
        }
    }
}

/* proves: PL-SPI-14, PL-SPI-13 */
static void one_job_at_a_time_and_in_its_state(void)
{
    const bq_action action = {.clear_faults = true};
    bench_up(1, NULL);
    bench_init();
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->scan(b.afe.ctx));
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->apply(b.afe.ctx, &action));
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->self_test(b.afe.ctx));
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->sleep(b.afe.ctx));
    EXPECT_STATUS(BQ_E_STATE, b.afe.ops->wake(b.afe.ctx));
    EXPECT_STATUS(BQ_E_STALE, b.afe.ops->sample(b.afe.ctx, &b.sample));
    TEST_ASSERT_EQUAL_INT(0, b.afe.ops->modules_found(b.afe.ctx));
    EXPECT_STATUS(BQ_OK, b.afe.ops->start(b.afe.ctx));
    EXPECT_STATUS(BQ_E_BUSY, b.afe.ops->start(b.afe.ctx));
    EXPECT_STATUS(BQ_OK, bench_run(BQ_OK));
    EXPECT_STATUS(BQ_OK, b.afe.ops->scan(b.afe.ctx));
    EXPECT_STATUS(BQ_E_BUSY, b.afe.ops->scan(b.afe.ctx));
    EXPECT_STATUS(BQ_E_BUSY, b.afe.ops->sleep(b.afe.ctx));
    EXPECT_STATUS(BQ_OK, bench_run(BQ_OK));
    b.sample.cell_capacity = 5;
    EXPECT_STATUS(BQ_E_ARG, b.afe.ops->sample(b.afe.ctx, &b.sample));
}

/* proves: PL-SPI-13, PL-SPI-03, PL-SEQ-01-05, PL-CONV-12 */
static void the_back_end_of_the_simulator(void)
{
    static sim_pl pl;
    static hal_sim h;
    for (int pin = 0; pin <= 1; pin++) {
        bench_up(4, NULL);
        TEST_ASSERT_EQUAL_INT(0, sim_pl_init(&pl, 4, NULL));
        hal_sim_init(&h, &pl);
        h.tick_ns = 1000;
        h.pending = 3;
        b.config.use_conv_pin = pin != 0;
        bench_init(); /* arrays of the sample */
        bq_spi spi = hal_sim_spi(&h);
        bq_gpio gpio = hal_sim_gpio(&h);
        bq_clock clock = hal_sim_clock(&h);
        EXPECT_STATUS(BQ_OK, bq76pl536_init(&b.driver, &b.config, &spi, &gpio, &clock, b.devices, 62));
        EXPECT_STATUS(BQ_OK, bq76pl536_start(&b.driver));
        EXPECT_STATUS(BQ_OK, bq76pl536_wait(&b.driver, 10000000));
        for (int i = 0; i < 3; i++) {
            sim_pl_set_cell(&pl, 4, 6, 3.5 + 0.1 * i);
            EXPECT_STATUS(BQ_OK, bq76pl536_scan(&b.driver));
            EXPECT_STATUS(BQ_OK, bq76pl536_wait(&b.driver, 1000000));
            bench_sample();
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, CELL(4, 6)->quality);
            TEST_ASSERT_INT_WITHIN(1, 3500 + 100 * i, CELL(4, 6)->mv);
        }
        EXPECT_STATUS(BQ_OK, bq76pl536_sleep(&b.driver));
        EXPECT_STATUS(BQ_OK, bq76pl536_wait(&b.driver, 1000000));
        TEST_ASSERT_EQUAL_UINT32(0, h.overlaps);
        TEST_ASSERT_EQUAL_UINT(0, sim_pl_misuse(&pl)->count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_read_is_tried_three_times_and_no_more);
    RUN_TEST(no_answer_and_damaged_answer_are_different);
    RUN_TEST(damaged_writes_are_cleared_and_repeated);
    RUN_TEST(one_job_at_a_time_and_in_its_state);
    RUN_TEST(the_back_end_of_the_simulator);
    return UNITY_END();
}
