/* SPDX-License-Identifier: Apache-2.0 */
/* The base set, for a firmware with little flash, on every part with every cell count: what it configures,
 * measures, reports, clears, bleeds; and what it says when what it was told is not true. */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

static bq_status known(void)
{
    bq_i2c i2c = bench_i2c();
    bq_clock clock = bench_clock();
    bq769x0_known k;
    bq_status s = bq769x0_known_of(&b.cfg, &k);
    if (s == BQ_OK)
        bq769x0_init_known(&b.d, &k, &i2c, &clock);
    return s;
}

static void booted(const sim_x0_part *part, unsigned cells)
{
    bench_part(part->name, NULL);
    b.cfg.cells = (uint8_t)cells;
    b.cfg.wiring = rows_wiring(part->cells, cells);
    b.cfg.address7 = part->address7;
    b.cfg.crc = part->crc ? BQ769X0_CRC_ON : BQ769X0_CRC_OFF;
    TEST_ASSERT_EQUAL(BQ_OK, known());
    bench_cells(3.6);
    (void)sim_x0_boot(&b.chip, 3 * MS);
    bench_wait(900);
}

static bq_status configure(void)
{
    bq_status s = bq769x0_begin_configure(&b.d);
    return s == BQ_OK ? bench_run(5000) : s;
}

static bq769x0_reading r;

static void look(void)
{
    unsigned n;
    bq769x0_read(&b.d, &r);
    for (n = 0; n < b.cfg.cells; n++)
        bq769x0_read_cell(&b.d, n, &b.cells[n]);
    for (n = 0; n < b.cfg.sensors; n++)
        bq769x0_read_temp(&b.d, n, &b.temps[n]);
}

static bq_status outputs(unsigned fets, unsigned cells)
{
    bq_status s = bq769x0_begin_outputs(&b.d, fets, cells);
    return s == BQ_OK ? bench_run(5000) : s;
}

static bq_status measure(void)
{
    bq_status s = bq769x0_begin_measure(&b.d);
    s = s == BQ_OK ? bench_run(5000) : s;
    look();
    return s;
}

static bq_status clear(void)
{
    bq_status s = bq769x0_begin_clear(&b.d);
    return s == BQ_OK ? bench_run(5000) : s;
}

static void life(const sim_x0_part *part, unsigned cells)
{
    unsigned c, g, n;
    uint16_t seen = 0;
    booted(part, cells);
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_measure(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, configure());
    TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 9));
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    for (c = 1; c <= cells; c++)
        (void)sim_x0_set_cell(&b.chip, (int)rows_input(part->cells, cells, c), 3.3 + 0.05 * c);
    bench_wait(2600);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    bench_wait(260);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    for (c = 1; c <= cells; c++) {
        TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[c - 1].quality);
        TEST_ASSERT_INT_WITHIN(1, (int)(3300 + 50 * c), b.cells[c - 1].mv);
    }
    TEST_ASSERT_EQUAL(BQ_Q_VALID, b.temps[0].quality);
    TEST_ASSERT_INT_WITHIN(1, 250, b.temps[0].dc);
    TEST_ASSERT_EQUAL(BQ_OK, outputs(3, 0));
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    for (n = 0; n < 40; n++) {
        uint16_t cb;
        TEST_ASSERT_EQUAL(BQ_OK, outputs(3, (1u << cells) - 1u));
        cb = sim_x0_cb(&b.chip);
        for (g = 0; g < part->cells / 5u; g++)
            TEST_ASSERT_TRUE(rows_legal_cellbal(b.cfg.wiring >> (5 * g) & 31u, cb >> (5 * g) & 31u));
        seen |= cb;
        bench_wait(500);
        TEST_ASSERT_EQUAL(BQ_OK, measure());
    }
    TEST_ASSERT_EQUAL_HEX16(b.cfg.wiring, seen);
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.3);
    (void)sim_x0_set_sense(&b.chip, 0);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    TEST_ASSERT_EQUAL_HEX8(0x02, r.events);
    TEST_ASSERT_EQUAL(BQ_E_STATE, outputs(3, 0)); /* not while the bit stands */
    TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
    (void)sim_x0_strike_xready(&b.chip); /* after the measurement: not cleared unseen */
    TEST_ASSERT_EQUAL(BQ_OK, clear());
    TEST_ASSERT_EQUAL_HEX8(0x20, b.chip.reg[0] & 0x3f);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    TEST_ASSERT_EQUAL(BQ_OK, clear());
    TEST_ASSERT_EQUAL(BQ_OK, configure());
    bench_wait(2600);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    TEST_ASSERT_EQUAL_HEX8(0, r.events);
    TEST_ASSERT_EQUAL(BQ_OK, outputs(3, 0));
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
    NO_MISUSE();
}

/* proves: X0-SEQ-15, X0-SEQ-16, X0-SEQ-21, X0-SEQ-22, X0-SEQ-39, X0-BIT-09, X0-FET-11, X0-CELL-18 */
static void test_every_part_with_every_cell_count(void)
{
    int k;
    unsigned cells;
    for (k = 0; k < 15; k++) {
        const sim_x0_part *part = sim_x0_part_at(k);
        for (cells = rows_least(part->cells); cells <= part->cells; cells++)
            life(part, cells);
    }
}

/* The field's mistake: a part with CRC is driven without. Every byte is acknowledged and nothing is stored.
 */
/* proves: X0-NUM-857, X0-AMB-81, X0-I2C-28, X0-SEQ-16 */
static void test_a_part_with_crc_driven_without(void)
{
    booted(sim_x0_find_part("bq7692003"), 5);
    b.cfg.crc = BQ769X0_CRC_OFF;
    TEST_ASSERT_EQUAL(BQ_OK, known());
    b.wire_used = 0;
    b.wire[0] = 0;
    TEST_ASSERT_TRUE(configure() < 0);
    TEST_ASSERT_NOT_NULL(strstr(b.wire, "+ P"));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&b.chip, 0x0b));
    TEST_ASSERT_EQUAL_HEX8(0xac, sim_x0_peek(&b.chip, 0x09));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&b.chip, 0x05));
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_measure(&b.d));
}

/* proves: X0-I2C-28, X0-SEQ-48 */
static void test_a_part_without_crc_driven_with(void)
{
    booted(sim_x0_find_part("bq7693000"), 10);
    b.cfg.crc = BQ769X0_CRC_ON;
    TEST_ASSERT_EQUAL(BQ_OK, known());
    TEST_ASSERT_TRUE(configure() < 0);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_measure(&b.d));
}

/* proves: X0-SEQ-51, X0-SEQ-48, X0-SEQ-49 */
static void test_every_transaction_fails_once(void)
{
    static const char *const two[2] = {"bq7692000", "bq7694003"};
    int k, kind;
    unsigned n;
    for (k = 0; k < 2; k++)
        for (kind = SPOIL_LOST; kind < SPOIL_FLIP; kind++)
            for (n = 1; n < 40; n++) {
                const sim_x0_part *part = sim_x0_find_part(two[k]);
                booted(part, part->cells);
                b.spoil_at = b.count + n;
                b.spoil_kind = (spoil)kind;
                TEST_ASSERT_EQUAL(BQ_OK, configure());
                bench_wait(2600);
                TEST_ASSERT_EQUAL(BQ_OK, measure());
                TEST_ASSERT_EQUAL(BQ_OK, outputs(3, 0x5));
                TEST_ASSERT_EQUAL(BQ_OK, measure());
                TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[part->cells - 1].mv);
                TEST_ASSERT_EQUAL_HEX16(0x5, sim_x0_cb(&b.chip));
                TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
                NO_MISUSE();
            }
}

/* proves: X0-SEQ-51, X0-SEQ-20 */
static void test_a_lost_part(void)
{
    booted(sim_x0_find_part("bq7693003"), 10);
    TEST_ASSERT_EQUAL(BQ_OK, configure());
    bench_wait(2600);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    (void)sim_x0_set_supply(&b.chip, false);
    TEST_ASSERT_TRUE(measure() < 0);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, b.cells[0].quality);
    (void)sim_x0_set_supply(&b.chip, true);
    (void)sim_x0_boot(&b.chip, 3 * MS);
    bench_wait(15);
    (void)measure();
    TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID); /* registers at zero: no picture */
    (void)outputs(3, 0);
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    bench_wait(800);
    TEST_ASSERT_EQUAL(BQ_OK, configure());
    bench_wait(2600);
    TEST_ASSERT_EQUAL(BQ_OK, measure());
    TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[0].quality);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_part_with_every_cell_count);
    RUN_TEST(test_a_part_with_crc_driven_without);
    RUN_TEST(test_a_part_without_crc_driven_with);
    RUN_TEST(test_every_transaction_fails_once);
    RUN_TEST(test_a_lost_part);
    return UNITY_END();
}
