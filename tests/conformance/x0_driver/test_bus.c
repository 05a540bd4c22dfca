/* SPDX-License-Identifier: Apache-2.0 */
/* The bus fails in every way at every transaction of every job (X0-SEQ-48..53): no value is invented, no
 * limit is lost, no FET comes on by itself, and when the damage ends everything is as before. */
#include "bench.h"
#include <stdio.h>

void setUp(void)
{
}
void tearDown(void)
{
}

static const char *const two[2] = {"bq7692000", "bq7694003"};

static void on_duty(const char *name)
{
    bench_up(name);
    bench_serve(2750, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static void valid_is_true(void)
{
    unsigned i;
    if (bench_picture() != BQ_OK)
        return;
    for (i = 0; i < b.sample.cell_count; i++)
        if (b.cells[i].quality & BQ_Q_VALID)
            TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[i].mv);
    for (i = 0; i < b.sample.temp_count; i++)
        if (b.temps[i].quality & BQ_Q_VALID)
            TEST_ASSERT_INT_WITHIN(1, 250, b.temps[i].dc);
}

static void configuration_holds(void)
{
    const bq769x0_achieved *a = bq769x0_get_achieved(&b.d);
    TEST_ASSERT_EQUAL_HEX8(a->current.protect1, sim_x0_peek(&b.chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(a->current.protect2, sim_x0_peek(&b.chip, 0x07));
    TEST_ASSERT_EQUAL_HEX8(a->protect3, sim_x0_peek(&b.chip, 0x08) & 0xf0);
    TEST_ASSERT_EQUAL_HEX8(a->ov_trip, sim_x0_peek(&b.chip, 0x09));
    TEST_ASSERT_EQUAL_HEX8(a->uv_trip, sim_x0_peek(&b.chip, 0x0a));
    TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
    TEST_ASSERT_EQUAL_HEX8(0x18, sim_x0_peek(&b.chip, 0x04) & 0x1f);
}

/* A job of the driver; each is run from the same state. */
static bq_status job(int which)
{
    bq_status s = BQ_OK;
    switch (which) {
    case 0:
        return bench_scan();
    case 1:
        return bench_apply(true, false, 0x12);
    case 2:
        s = bq769x0_begin_self_test(&b.d);
        break;
    case 3:
        s = bq769x0_begin_oneshot(&b.d);
        break;
    default:
        bench_wait(1000); /* a scan with the scrub in it */
        return bench_scan();
    }
    return s == BQ_OK ? bench_run(20000) : s;
}
#define JOBS 5

/* proves: X0-SEQ-48, X0-SEQ-49, X0-SEQ-51, X0-SEQ-53, X0-I2C-19, X0-I2C-20, X0-AMB-79, X0-AMB-80, X0-AMB-81
 */
static void test_every_transaction_of_every_job_fails_once(void)
{
    int k, which, kind;
    for (k = 0; k < 2; k++)
        for (which = 0; which < JOBS; which++) {
            uint64_t n, all;
            on_duty(two[k]);
            all = b.count;
            TEST_ASSERT_EQUAL(BQ_OK, job(which));
            all = b.count - all;
            for (kind = SPOIL_LOST; kind < SPOIL_BROWNOUT; kind++)
                for (n = 1; n <= all; n++) {
                    bq_status s;
                    on_duty(two[k]);
                    b.spoil_at = b.count + n;
                    b.spoil_kind = (spoil)kind;
                    b.flip_bit = (int)(8 + bench_random(16));
                    s = job(which);
                    valid_is_true();
                    if (kind != SPOIL_FLIP && s != BQ_OK) { /* one failure is repeated, not reported */
                        char text[96];
                        (void)snprintf(text, sizeof text, "%s job %d transaction %u kind %d: %d", two[k],
                                       which, (unsigned)n, kind, (int)s);
                        TEST_FAIL_MESSAGE(text);
                    }
                    b.spoil_at = 0;
                    bench_serve(8000, 250);
                    valid_is_true();
                    TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
                    configuration_holds();
                    TEST_ASSERT_EQUAL(0, b.overlaps);
                    if (kind != SPOIL_FLIP) /* on a part without CRC a flip makes the host do anything */
                        NO_MISUSE();
                }
        }
}

/* The same for a while: three tries are not enough, the job fails, says why, and the bus is recovered. */
/* proves: X0-SEQ-51, X0-SEQ-52, X0-SEQ-53, X0-I2C-23, X0-AMB-89 */
static void test_a_failure_that_lasts_ends_the_job_and_passes(void)
{
    static const spoil kinds[] = {SPOIL_LOST, SPOIL_NACK, SPOIL_TIMEOUT, SPOIL_REFUSED, SPOIL_FIRST_HALF};
    static const bq_status why[] = {BQ_E_BUS, BQ_E_NACK, BQ_E_TIMEOUT, BQ_E_ARBITRATION, BQ_E_NACK};
    int k, i, which;
    for (k = 0; k < 2; k++)
        for (i = 0; i < 5; i++)
            for (which = 0; which < JOBS; which++) {
                uint64_t from, tries;
                on_duty(two[k]);
                b.spoil_at = b.count + 1;
                b.spoil_count = 1000000;
                b.spoil_kind = kinds[i];
                b.recoveries = 0;
                from = b.chip.now;
                tries = b.count;
                TEST_ASSERT_EQUAL(why[i], job(which));
                tries = b.count - tries;
                TEST_ASSERT_TRUE(tries >= 3 && tries <= 24); /* bounded */
                TEST_ASSERT_TRUE(b.chip.now - from < 2000 * MS);
                TEST_ASSERT_TRUE(b.recoveries >= 1);
                if (which == 0) {
                    TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
                    TEST_ASSERT_TRUE(b.module.faults & BQ_F_COMM);
                    TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
                    TEST_ASSERT_FALSE(b.temps[0].quality & BQ_Q_VALID);
                }
                b.spoil_at = 0;
                b.spoil_count = 0;
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan()); /* by itself, and looks at the configuration */
                bench_serve(8000, 250);
                configuration_holds();
                TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
                NO_MISUSE();
            }
}

/* proves: X0-SEQ-48, X0-I2C-14, X0-I2C-15, X0-I2C-27, X0-SEQ-22 */
static void test_every_bit_of_a_block_flips_once(void)
{
    int bit;
    on_duty("bq7692003");
    for (bit = 0; bit < 8 * (3 + 20); bit++) {
        uint32_t retries, crc;
        bench_wait(250);
        (void)bench_scan();
        retries = bench_stats()->retries;
        crc = bench_stats()->crc_errors;
        b.spoil_at = b.count + 3; /* SYS_STAT, BAT and the rest, cells */
        b.spoil_kind = SPOIL_FLIP;
        b.flip_bit = bit;
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        b.spoil_at = 0;
        valid_is_true();
        TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
        if (bit >= 24) /* behind the addresses and the register */
            TEST_ASSERT_EQUAL(crc + 1, bench_stats()->crc_errors);
        if (bit < 8 || bit >= 16)
            TEST_ASSERT_TRUE(bench_stats()->retries > retries);
    }
    NO_MISUSE();
}

/* proves: X0-SEQ-52, X0-AMB-89, X0-I2C-22 */
static void test_data_line_stuck(void)
{
    int k, clocks;
    for (k = 0; k < 2; k++) {
        for (clocks = 1; clocks <= 9; clocks++) {
            on_duty(two[k]);
            sim_x0_bus(&b.chip)->stuck_clocks = clocks;
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_TRUE(b.recoveries >= 1);
            bench_serve(250, 250);
            TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
            NO_MISUSE();
        }
        sim_x0_bus(&b.chip)->stuck_clocks = -1;
        TEST_ASSERT_EQUAL(BQ_E_ARBITRATION, bench_scan());
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_COMM);
        sim_x0_bus(&b.chip)->stuck_clocks = 0;
        bench_serve(3000, 250);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-51, X0-SEQ-54, X0-SEQ-23 */
static void test_dead_wires(void)
{
    int k, dead, n;
    for (k = 0; k < 15; k++)
        for (dead = 1; dead <= 2; dead++) {
            on_duty(sim_x0_part_at(k)->name);
            sim_x0_bus(&b.chip)->dead = dead;
            for (n = 0; n < 8; n++) {
                bq_status s = bench_scan();
                TEST_ASSERT_TRUE(s < 0 || dead == 2 || !b.chip.part->crc);
                TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
                TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
                TEST_ASSERT_FALSE(b.module.quality & BQ_Q_VALID);
                (void)bench_apply(true, true, 0);
                bench_wait(250);
            }
            TEST_ASSERT_TRUE(b.module.age_ms > 1900); /* and no age starts anew */
            sim_x0_bus(&b.chip)->dead = 0;
            bench_serve(25000, 250);
            TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
            configuration_holds();
            TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        }
}

/* proves: X0-I2C-23, X0-AMB-89 */
static void test_a_back_end_that_never_ends_is_given_up(void)
{
    on_duty("bq7693003");
    b.stuck_pending = 1;
    TEST_ASSERT_EQUAL(BQ_E_TIMEOUT, bench_scan());
    TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
    b.stuck_pending = 0;
    bench_serve(3000, 250);
    TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
    TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
}

/* Somebody puts another board under the host: the old address is silent, a new bring-up finds the new one. */
/* proves: X0-SEQ-51, X0-SEQ-07, X0-I2C-02, X0-I2C-01 */
static void test_the_address_changes(void)
{
    on_duty("bq7693002");
    TEST_ASSERT_EQUAL_HEX8(0x08, bq769x0_get_achieved(&b.d)->address7);
    b.chip.part = sim_x0_find_part("bq7693006");
    TEST_ASSERT_EQUAL(BQ_E_NACK, bench_scan());
    TEST_ASSERT_TRUE(b.module.faults & BQ_F_COMM);
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_HEX8(0x18, bq769x0_get_achieved(&b.d)->address7);
    bench_serve(500, 250);
    TEST_ASSERT_TRUE(b.cells[0].quality & BQ_Q_VALID);
    NO_MISUSE();
}

/* The answer to a write with side effects is lost: the status is read again before it is cleared again. */
/* proves: X0-SEQ-50, X0-BIT-09 */
static void test_a_lost_answer_to_a_clear(void)
{
    static const double kind[2] = {4.3, 2.6};
    int k, i, n;
    for (k = 0; k < 2; k++)
        for (i = 0; i < 2; i++) {
            on_duty(two[k]);
            (void)sim_x0_set_cell(&b.chip, 1, kind[i]);
            bench_serve(2500, 250);
            (void)sim_x0_set_cell(&b.chip, 1, 3.6);
            b.spoil_kind = SPOIL_UNHEARD;
            b.spoil_writes = true;
            b.spoil_reg = 0;
            for (n = 0; n < 20; n++) {
                b.spoil_at = b.spoil_seen + 1; /* the next one of each period */
                bench_serve(250, 250);
            }
            TEST_ASSERT_TRUE(b.spoil_seen >= 20);
            b.spoil_at = 0;
            TEST_ASSERT_TRUE(bench_until(true, true, 20000) < 20000);
            NO_MISUSE(); /* the book notes a bit cleared that was not read as set */
        }
}

/* What was read before is a picture all the same. */
/* proves: X0-SEQ-21, X0-SEQ-51 */
static void test_a_result_that_cannot_be_cleared(void)
{
    bench_up("bq7694003");
    bench_serve(3000, 250);
    b.spoil_writes = true;
    b.spoil_reg = 0x00;
    b.spoil_seen = 0;
    b.spoil_at = 1;
    b.spoil_count = 1000000;
    b.spoil_kind = SPOIL_NACK;
    bench_wait(260);
    TEST_ASSERT_EQUAL(BQ_E_NACK, bench_scan());
    TEST_ASSERT_EQUAL_UINT(4, b.spoil_seen); /* three tries, and one after the recovery of the bus */
    TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.cells[0].quality);
    TEST_ASSERT_TRUE(b.sample.current_valid);
    b.spoil_at = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_transaction_of_every_job_fails_once);
    RUN_TEST(test_a_failure_that_lasts_ends_the_job_and_passes);
    RUN_TEST(test_every_bit_of_a_block_flips_once);
    RUN_TEST(test_data_line_stuck);
    RUN_TEST(test_dead_wires);
    RUN_TEST(test_a_back_end_that_never_ends_is_given_up);
    RUN_TEST(test_the_address_changes);
    RUN_TEST(test_a_lost_answer_to_a_clear);
    RUN_TEST(test_a_result_that_cannot_be_cleared);
    return UNITY_END();
}
