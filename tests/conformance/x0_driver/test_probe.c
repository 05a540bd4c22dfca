/* SPDX-License-Identifier: Apache-2.0 */
/* Finding out what hangs on the bus: address, CRC option, what a doubtful answer asks for, what is never
 * touched. */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* proves: X0-SEQ-07, X0-AMB-84, X0-AMB-86, X0-AMB-90, X0-AMB-102, X0-I2C-01, X0-I2C-02, X0-TIM-08, X0-AMB-67
 */
static void test_what_is_never_touched(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        const sim_x0_part *part = sim_x0_part_at(k);
        uint64_t n;
        bool found = false;
        bench_up(part->name);
        b.action.balance[0] = 0x7fff;
        bench_serve(20000, 250);
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
        TEST_ASSERT_EQUAL(BQ_OK, bench_run(3000));
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
        TEST_ASSERT_EQUAL(BQ_OK, bench_run(3000));
        for (n = 0; n < b.count; n++) {
            const bench_entry *e = bench_log(n);
            unsigned last = (unsigned)e->reg + (e->wrote ? e->wrote : e->read) - 1u;
            TEST_ASSERT_TRUE(e->address7 == 0x08 || e->address7 == 0x18);
            if (e->wrote > 0) {
                TEST_ASSERT_TRUE(last <= 0x0b);
                TEST_ASSERT_TRUE(e->reg > 3 || last < 1 || last <= part->cells / 5u);
            } else if (e->read > 0) { /* four bytes from 0x50 are part of the probe */
                TEST_ASSERT_TRUE(last <= 0x33 || (e->reg >= 0x50 && last <= 0x53) ||
                                 (e->reg == 0x59 && last == 0x59));
            }
            if (!found && e->status == BQ_OK) { /* the first thing that is answered has no side effect */
                TEST_ASSERT_TRUE(e->wrote == 0 && e->read <= 1 && e->reg == 0);
                found = true;
            }
            if (found)
                TEST_ASSERT_EQUAL(part->address7, e->address7);
        }
        NO_MISUSE();
    }
}

/* A part without CRC whose registers happen to look like a register and its CRC; found warm, with CC_CFG left
   at 0x19 by a host that was reset. Writes tell, and only 0x0b is used for them. */
/* proves: X0-SEQ-08, X0-SEQ-09, X0-NUM-870, X0-NUM-871, X0-AMB-86, X0-I2C-28 */
static void test_a_part_without_crc_that_looks_like_one_with(void)
{
    int way;
    for (way = 0; way < 2; way++) {
        sim_x0_options o;
        uint64_t n, from;
        memset(&o, 0, sizeof o);
        o.amb86_nack = way;
        bench_part("bq7692000", &o);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        b.chip.reg[0x09] = 0xac; /* CRC of 11 ac is 0f */
        b.chip.reg[0x0a] = 0x0f;
        b.chip.reg[0x0b] = 0x19;
        b.wire_used = 0;
        b.wire[0] = 0;
        from = b.count;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_FALSE(bq769x0_get_achieved(&b.d)->crc);
        TEST_ASSERT_EQUAL(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 0x09));
        TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        for (n = from; n < b.count; n++) { /* until the option is known nothing but 0x0b is written */
            const bench_entry *e = bench_log(n);
            if (e->wrote > 0 && e->reg != 0x0b)
                break;
        }
        for (; n < b.count; n++)
            TEST_ASSERT_FALSE(bench_log(n)->wrote == 2 && bench_log(n)->reg == 0x0b);
        TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&b.chip, 0x08));
        bench_serve(1000, 250);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
    }
}

/* A CRC part found warm with any thresholds is still taken for what it is. */
/* proves: X0-SEQ-08, X0-SEQ-09, X0-NUM-869, X0-I2C-28 */
static void test_crc_option_found_warm_with_any_content(void)
{
    static const char *const name[2] = {"bq7693000", "bq7693003"};
    int k, n;
    for (k = 0; k < 2; k++)
        for (n = 0; n < 300; n++) {
            bench_part(name[k], NULL);
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            (void)sim_x0_set_offset(&b.chip, (int)bench_random(256) - 128);
            (void)sim_x0_set_gain(&b.chip, 365 + (int)bench_random(32));
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            b.chip.reg[0x09] = (uint8_t)bench_random(256);
            b.chip.reg[0x0a] = (uint8_t)bench_random(256);
            b.chip.reg[0x0b] = bench_random(2) ? 0x19 : (uint8_t)bench_random(64);
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_EQUAL(k == 1, bq769x0_get_achieved(&b.d)->crc);
            TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        }
}

/* A controller that cannot repeat a START: the pointer survives the stop, bytes and CRCs are the same. */
/* proves: X0-I2C-09, X0-NUM-854 */
static void test_reads_without_repeated_start(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        bench_part(sim_x0_part_at(k)->name, NULL);
        b.no_restart = true;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_serve(3000, 250);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[b.chip.part->cells - 1].mv);
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
        TEST_ASSERT_EQUAL(0, bench_stats()->retries);
        NO_MISUSE();
    }
}

/* The CRC byte of a block write is damaged at each place: what stands before it is stored, the rest is not,
   and the driver writes the whole block again. */
/* proves: X0-I2C-20, X0-NUM-855, X0-NUM-856, X0-SEQ-49, X0-AMB-79, X0-AMB-80 */
static void test_a_damaged_crc_in_a_block_write(void)
{
    int byte;
    for (byte = 0; byte < 6; byte++) {
        uint64_t n;
        unsigned blocks = 0;
        bench_part("bq7692003", NULL);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        b.spoil_writes = true;
        b.spoil_reg = 6;
        b.spoil_at = 1;
        b.spoil_kind = SPOIL_FLIP;
        b.flip_bit = 16 + 16 * byte + 8 + byte; /* in the CRC behind this data byte */
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        for (n = 0; n < b.count; n++)
            blocks += bench_log(n)->wrote == 6 && bench_log(n)->reg == 6;
        TEST_ASSERT_EQUAL(2, blocks);
        TEST_ASSERT_NOT_NULL(strstr(b.wire, "- P")); /* it was refused and ended there */
        TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->uv_trip, sim_x0_peek(&b.chip, 0x0a));
        TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        NO_MISUSE();
    }
}

/* Cells connect in any order while the host tries again and again: nothing comes on until the last is there.
 */
/* proves: X0-CELL-23, X0-SEQ-12, X0-SEQ-05 */
static void test_cells_connect_in_any_order(void)
{
    static const char *const name[3] = {"bq7692003", "bq7693000", "bq7694006"};
    int k, round;
    for (k = 0; k < 3; k++)
        for (round = 0; round < 4; round++) {
            int order[15], i, cells;
            bench_part(name[k], NULL);
            cells = b.chip.part->cells;
            for (i = 0; i < cells; i++) {
                int j = (int)bench_random((uint32_t)i + 1u);
                order[i] = order[j];
                order[j] = i + 1;
                (void)sim_x0_set_cell(&b.chip, i + 1, 0.0);
            }
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            for (i = 0; i < cells; i++) {
                TEST_ASSERT_TRUE(bench_start() < 0);
                TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
                (void)sim_x0_set_cell(&b.chip, order[i], 3.6);
            }
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_TRUE(bench_until(true, true, 10000) < 10000);
            NO_MISUSE();
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_never_touched);
    RUN_TEST(test_a_part_without_crc_that_looks_like_one_with);
    RUN_TEST(test_crc_option_found_warm_with_any_content);
    RUN_TEST(test_reads_without_repeated_start);
    RUN_TEST(test_a_damaged_crc_in_a_block_write);
    RUN_TEST(test_cells_connect_in_any_order);
    return UNITY_END();
}
