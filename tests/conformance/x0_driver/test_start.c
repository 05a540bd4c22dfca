/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up as it shows on the bus: boot, probing, trim, configuration, first picture. */
#include "bench.h"
#include <stdio.h>

void setUp(void)
{
}
void tearDown(void)
{
}

static const char *const names[] = {"bq7692000", "bq7692003", "bq7692006", "bq7693000", "bq7693003",
                                    "bq7693006", "bq7694000", "bq7694003", "bq7694006"};

static int find_write(uint64_t from, uint8_t reg)
{
    uint64_t n;
    for (n = from; n < b.count; n++) {
        const bench_entry *e = bench_log(n);
        if (e->wrote > 0 && reg >= e->reg && reg < e->reg + e->wrote)
            return (int)n;
    }
    return -1;
}

/* proves: X0-SEQ-01, X0-SEQ-02, X0-SEQ-04, X0-SEQ-11, X0-SEQ-13, X0-SEQ-15, X0-SEQ-17, X0-SEQ-18, X0-SEQ-19,
   X0-AMB-17, X0-AMB-34, X0-AMB-68, X0-AMB-69, X0-ADC-14, X0-CC-10, X0-AMB-28, X0-I2C-02, X0-I2C-28, X0-DLY-03
 */
static void test_cold_start_of_every_part(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        const sim_x0_part *part = sim_x0_part_at(k);
        uint32_t first = part->cells == 5 ? 290 : part->cells == 10 ? 455 : 895;
        uint64_t n, pulse;
        int protect;
        bench_part(part->name, NULL);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(0, b.count); /* init touches no bus */
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        pulse = b.fall_ns - b.rise_ns;
        TEST_ASSERT_EQUAL(1, b.rises);
        TEST_ASSERT_EQUAL(1, b.falls);
        TEST_ASSERT_TRUE(pulse >= 2500000 && pulse < 10 * MS);
        for (n = 0; n < b.count; n++) {
            const bench_entry *e = bench_log(n);
            TEST_ASSERT_FALSE(e->wrote > 0 && e->t_ns < b.fall_ns + 12 * MS);
            if (e->reg + e->read > 0x0d && e->reg <= 0x33 && e->t_ns > b.fall_ns) { /* a measurement */
                TEST_ASSERT_TRUE(e->t_ns >= b.rise_ns + first * MS);
            }
            TEST_ASSERT_FALSE(e->wrote > 0 && e->address7 == part->address7 && !e->crc_good &&
                              !(e->reg == BQ769X0_CC_CFG));
            TEST_ASSERT_FALSE(e->wrote > 0 && e->reg <= 5 && e->reg + e->wrote > 5 &&
                              (e->data[5 - e->reg] & 0x83)); /* FETs, DELAY_DIS */
        }
        TEST_ASSERT_EQUAL(part->address7, bq769x0_get_achieved(&b.d)->address7);
        TEST_ASSERT_EQUAL(part->crc, bq769x0_get_achieved(&b.d)->crc);
        protect = find_write(0, 0x06);
        TEST_ASSERT_TRUE(protect > 0 && find_write(0, 0x05) >= 0 && find_write(0, 0x05) < protect);
        TEST_ASSERT_TRUE(find_write(0, 0x01) >= 0 && find_write(0, 0x01) < protect);
        TEST_ASSERT_TRUE(find_write((uint64_t)protect, 0x04) > protect);
        TEST_ASSERT_TRUE(find_write((uint64_t)protect, 0x05) > protect);
        TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        TEST_ASSERT_EQUAL_HEX8(0x18, sim_x0_peek(&b.chip, 0x04) & 0x1f);
        TEST_ASSERT_EQUAL_HEX8(0x40, sim_x0_peek(&b.chip, 0x05));
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
        NO_MISUSE();
        TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[part->cells - 1].mv);
    }
}

/* proves: X0-SEQ-06, X0-MODE-18, X0-AMB-70 */
static void test_warm_start(void)
{
    int keep, k;
    for (k = 0; k < 9; k++)
        for (keep = 0; keep < 2; keep++) {
            uint32_t rises;
            uint64_t n;
            bench_up(names[k]);
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 1));
            TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
            b.cfg.keep_fets = keep != 0;
            rises = b.rises;
            n = b.count;
            bench_wait(5000);
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_EQUAL(rises, b.rises);
            TEST_ASSERT_EQUAL(keep, sim_x0_chg(&b.chip));
            TEST_ASSERT_EQUAL(keep, sim_x0_dsg(&b.chip));
            TEST_ASSERT_EQUAL(0, sim_x0_cb(&b.chip));
            TEST_ASSERT_TRUE(bench_writes(n, 0x06, NULL) >= 1 && bench_writes(n, 0x0a, NULL) >= 1);
            TEST_ASSERT_EQUAL(b.chip.part->crc, bq769x0_get_achieved(&b.d)->crc);
            NO_MISUSE();
        }
}

/* proves: X0-SEQ-03 */
static void test_nobody_there(void)
{
    bench_part("bq7694003", NULL);
    b.no_power = true;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_NOT_FOUND, bench_start());
    TEST_ASSERT_EQUAL(3, b.rises);
    TEST_ASSERT_EQUAL(3, b.falls);
    TEST_ASSERT_EQUAL(BQ_E_STALE, bench_picture());
    b.no_power = false;
    TEST_ASSERT_EQUAL(BQ_OK, bench_start()); /* power comes back */
}

/* proves: X0-SEQ-52, X0-AMB-89 */
static void test_bus_dead_from_the_beginning(void)
{
    int kind;
    for (kind = 0; kind < 4; kind++) {
        bq_status s;
        bench_part("bq7693003", NULL);
        if (kind < 2)
            sim_x0_bus(&b.chip)->dead = kind + 1;
        b.never_free = kind == 2;
        if (kind == 3)
            sim_x0_bus(&b.chip)->stuck_clocks = -1;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        s = bench_start();
        TEST_ASSERT_TRUE(s < 0);
        if (kind >= 2)
            TEST_ASSERT_TRUE(b.recoveries > 0);
        TEST_ASSERT_EQUAL(BQ_E_STALE, bench_picture());
        b.never_free = false;
        sim_x0_bus(&b.chip)->dead = 0;
        sim_x0_bus(&b.chip)->stuck_clocks = 5;
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    }
}

/* proves: X0-SEQ-10, X0-VAR-19, X0-SEQ-12, X0-AMB-85 */
static void test_wrong_part(void)
{
    uint64_t n;
    bench_part("bq7692003", NULL); /* 0x08, CRC */
    b.cfg.crc = BQ769X0_CRC_OFF;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_CONFIG, bench_start());
    TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip) || sim_x0_chg(&b.chip));
    bench_part("bq7692000", NULL);
    b.cfg.crc = BQ769X0_CRC_ON;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_CONFIG, bench_start());
    bench_part("bq7692006", NULL); /* 0x18 */
    b.cfg.address7 = 0x08;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_TRUE(bench_start() < 0);
    bench_part("bq7692003", NULL);
    b.cfg.inputs = b.cfg.cells = 10; /* larger than it is */
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_CELLS, bench_start());
    bench_part("bq7693003", NULL);
    b.cfg.cells = 8;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    (void)sim_x0_set_cell(&b.chip, 4, 3.6); /* a cell where a short should be */
    TEST_ASSERT_EQUAL(BQ_E_CELLS, bench_start());
    for (n = 0; n < b.count; n++)
        TEST_ASSERT_FALSE(bench_log(n)->wrote && bench_log(n)->reg == 5 && (bench_log(n)->data[0] & 3));
}

/* proves: X0-SEQ-16, X0-AMB-87 */
static void test_configuration_that_does_not_hold(void)
{
    unsigned n;
    bench_part("bq7692000", NULL);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    /* reserved bits that read as 1 are not compared */
    b.chip.reg[0x08] |= 0x05;
    n = bench_writes(0, 0x08, NULL);
    bench_serve(3000, 250);
    TEST_ASSERT_EQUAL(n, bench_writes(0, 0x08, NULL));
}

static uint64_t transactions(const char *name)
{
    bench_up(name);
    return b.count;
}

/* proves: X0-SEQ-51, X0-SEQ-49, X0-SEQ-53 */
static void test_every_transaction_of_the_start_fails_in_every_way(void)
{
    static const char *const two[] = {"bq7692000", "bq7694003"};
    int k, kind;
    for (k = 0; k < 2; k++) {
        uint64_t n, all = transactions(two[k]);
        for (n = 1; n <= all; n++)
            for (kind = SPOIL_LOST; kind < SPOIL_KINDS; kind++) {
                bq_status s;
                bench_part(two[k], NULL);
                b.spoil_at = n;
                b.spoil_kind = (spoil)kind;
                b.flip_bit = (int)(8 + bench_random(16));
                TEST_ASSERT_EQUAL(BQ_OK, bench_init());
                s = bench_start();
                TEST_ASSERT_EQUAL(0, b.overlaps);
                TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
                if (kind < SPOIL_FIRST_HALF && kind != SPOIL_FLIP && s != BQ_OK) {
                    char text[80];
                    (void)snprintf(text, sizeof text, "transaction %u of %s, kind %d: %d", (unsigned)n,
                                   two[k], kind, (int)s);
                    TEST_FAIL_MESSAGE(text);
                }
                b.spoil_at = 0;
                if (s != BQ_OK)
                    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
                TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 0x09));
                TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->current.protect1,
                                       sim_x0_peek(&b.chip, 0x06));
                TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
            }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cold_start_of_every_part);
    RUN_TEST(test_warm_start);
    RUN_TEST(test_nobody_there);
    RUN_TEST(test_bus_dead_from_the_beginning);
    RUN_TEST(test_wrong_part);
    RUN_TEST(test_configuration_that_does_not_hold);
    RUN_TEST(test_every_transaction_of_the_start_fails_in_every_way);
    return UNITY_END();
}
