/* SPDX-License-Identifier: Apache-2.0 */
/* One suite for all fifteen parts, each with every cell count it can have: bring-up, truth of every reading,
 * limits, faults and their recovery, balancing, SHIP. The book of misuse stays empty throughout. */
#include "bench.h"
#include "rows.h"
#include <stdio.h>

void setUp(void)
{
}
void tearDown(void)
{
}

static const sim_x0_part *part;
static unsigned cells;

static unsigned input_of(unsigned cell)
{
    return rows_input(part->cells, cells, cell);
}

static void set_pack(double volts)
{
    unsigned c;
    for (c = 1; c <= cells; c++)
        TEST_ASSERT_EQUAL(0, sim_x0_set_cell(&b.chip, (int)input_of(c), volts));
}

static void prepare(void)
{
    bench_part(part->name, NULL);
    b.cfg.cells = (uint8_t)cells;
    (void)sim_x0_set_gain(&b.chip, 371);
    (void)sim_x0_set_offset(&b.chip, -33);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL(part->address7, bq769x0_get_achieved(&b.d)->address7);
    TEST_ASSERT_EQUAL(part->crc, bq769x0_get_achieved(&b.d)->crc);
    TEST_ASSERT_EQUAL(371, bq769x0_get_achieved(&b.d)->trim.gain_uv);
    TEST_ASSERT_EQUAL(-33, bq769x0_get_achieved(&b.d)->trim.offset_mv);
}

/* Each cell has its own voltage, each sensor its own temperature. */
static void every_reading_is_true(void)
{
    static const double ohms[3] = {28704.0, 10000.0, 4101.0}; /* 0, 25 and 50 degC at beta 3435 */
    static const int dc[3] = {0, 250, 500};
    uint32_t sum = 0;
    unsigned c, t;
    for (c = 1; c <= cells; c++)
        (void)sim_x0_set_cell(&b.chip, (int)input_of(c), 3.1 + 0.063 * c);
    for (t = 1; t <= part->cells / 5u; t++)
        (void)sim_x0_set_ts(&b.chip, (int)t, ohms[t - 1]);
    (void)sim_x0_set_sense(&b.chip, -0.0211);
    bench_serve(2750, 250);
    TEST_ASSERT_EQUAL(cells, b.sample.cell_count);
    TEST_ASSERT_EQUAL(part->cells / 5, b.sample.temp_count);
    TEST_ASSERT_EQUAL(1, b.sample.module_count);
    for (c = 1; c <= cells; c++) {
        TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[c - 1].quality);
        TEST_ASSERT_INT_WITHIN(1, 3100 + 63 * (int)c, b.cells[c - 1].mv);
        sum += b.cells[c - 1].mv;
    }
    TEST_ASSERT_EQUAL(sum, b.module.stack_mv);
    for (t = 0; t < part->cells / 5u; t++) {
        TEST_ASSERT_EQUAL(BQ_Q_VALID, b.temps[t].quality);
        TEST_ASSERT_INT_WITHIN(3, dc[t], b.temps[t].dc);
    }
    TEST_ASSERT_TRUE(b.sample.current_valid);
    TEST_ASSERT_INT_WITHIN(2, -4220, b.sample.current_ma);
    TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
    (void)sim_x0_set_sense(&b.chip, 0);
    set_pack(3.6);
}

/* The limit is never looser than asked, and not more than one step tighter (16 codes, 40 mV across the
 * shunt). */
static void limits_hold(void)
{
    const bq769x0_achieved *a = bq769x0_get_achieved(&b.d);
    int32_t ov = (0x2000 + 16 * sim_x0_peek(&b.chip, 0x09) + 8) * 371 - 33000;
    int32_t uv = (0x1000 + 16 * sim_x0_peek(&b.chip, 0x0a)) * 371 - 33000;
    unsigned range = sim_x0_peek(&b.chip, 0x06) >> 7;
    TEST_ASSERT_EQUAL(ov, a->ov_uv);
    TEST_ASSERT_EQUAL(uv, a->uv_uv);
    TEST_ASSERT_TRUE(ov <= 4200000 && ov > 4200000 - 16 * 371);
    TEST_ASSERT_TRUE(uv >= 2800000 && uv < 2800000 + 16 * 371);
    TEST_ASSERT_EQUAL(39, rows_ocd_mv[range][sim_x0_peek(&b.chip, 0x07) & 15]); /* of 40 */
    TEST_ASSERT_EQUAL(67, rows_scd_mv[range][sim_x0_peek(&b.chip, 0x06) & 7]);  /* of 75 */
    TEST_ASSERT_EQUAL(320, rows_ocd_ms[sim_x0_peek(&b.chip, 0x07) >> 4]);
    TEST_ASSERT_EQUAL(100, rows_scd_us[sim_x0_peek(&b.chip, 0x06) >> 3 & 3]);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&b.chip, 0x08));
}

static void fets_come_on(uint32_t limit)
{
    uint32_t took = bench_until(true, true, limit);
    if (took >= limit) {
        char text[96];
        (void)snprintf(text, sizeof text, "%s with %u cells: FETs off for ever, faults %04x", part->name,
                       cells, (unsigned)b.module.faults);
        TEST_FAIL_MESSAGE(text);
    }
}

static void expect_fault(uint16_t flag, bool chg, bool dsg)
{
    bench_serve(500, 250);
    TEST_ASSERT_EQUAL_HEX16(flag, b.module.faults);
    TEST_ASSERT_EQUAL(chg, sim_x0_chg(&b.chip));
    TEST_ASSERT_EQUAL(dsg, sim_x0_dsg(&b.chip));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
}

static void each_fault_and_its_recovery(void)
{
    const int top = (int)input_of(cells);
    fets_come_on(5000);
    (void)sim_x0_set_cell(&b.chip, top, 4.15); /* below the limit */
    bench_serve(3000, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip));
    (void)sim_x0_set_cell(&b.chip, top, 4.21);
    bench_serve(1500, 250);
    expect_fault(BQ_F_CELL_OV, false, true);
    set_pack(3.6);
    fets_come_on(10000);
    (void)sim_x0_set_cell(&b.chip, top, 2.79);
    bench_serve(1500, 250);
    expect_fault(BQ_F_CELL_UV, true, false);
    set_pack(3.6);
    fets_come_on(10000);
    (void)sim_x0_set_sense(&b.chip, -0.038);
    bench_serve(1000, 250);
    TEST_ASSERT_TRUE(sim_x0_dsg(&b.chip));
    (void)sim_x0_set_sense(&b.chip, -0.040);
    bench_wait(400);
    (void)sim_x0_set_sense(&b.chip, 0);
    expect_fault(BQ_F_OVERCURRENT, false, false);
    fets_come_on(15000);
    (void)sim_x0_set_sense(&b.chip, -0.068);
    bench_wait(0.2);
    (void)sim_x0_set_sense(&b.chip, 0);
    expect_fault(BQ_F_SHORT, false, false);
    fets_come_on(15000);
    bench_serve(11000, 250); /* what comes now is not the same fault again */
    (void)sim_x0_set_alert_ext(&b.chip, true);
    bench_serve(500, 250);
    (void)sim_x0_set_alert_ext(&b.chip, false);
    expect_fault(BQ_F_CHAIN, false, false);
    fets_come_on(15000);
    bench_serve(11000, 250);
    (void)sim_x0_strike_xready(&b.chip);
    expect_fault(BQ_F_MEMORY, false, false);
    fets_come_on(15000);
}

/* Every cell is served, and only in sets the rows allow. */
static void balancing_is_legal(void)
{
    uint16_t wiring = rows_wiring(part->cells, cells), seen = 0;
    unsigned n, g;
    b.action.balance[0] = (1u << cells) - 1u;
    for (n = 0; n < 40; n++) {
        uint16_t cb;
        bench_serve(250, 250);
        cb = sim_x0_cb(&b.chip);
        for (g = 0; g < part->cells / 5u; g++)
            TEST_ASSERT_TRUE(rows_legal_cellbal(wiring >> (5 * g) & 31u, cb >> (5 * g) & 31u));
        seen |= cb;
    }
    TEST_ASSERT_EQUAL_HEX16(wiring, seen);
    b.action.balance[0] = 0;
    bench_serve(250, 250);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
}

static void ships(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_self_test(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(1000));
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(2000));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
    TEST_ASSERT_EQUAL(BQ_E_STATE, bq769x0_begin_scan(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
}

/* proves: X0-VAR-01, X0-VAR-02, X0-VAR-03, X0-VAR-04, X0-VAR-05, X0-VAR-06, X0-VAR-07, X0-VAR-08, X0-VAR-09,
   X0-VAR-10, X0-VAR-11, X0-VAR-12, X0-VAR-13, X0-VAR-14, X0-VAR-15, X0-VAR-16, X0-VAR-18, X0-VAR-20,
   X0-VAR-22, X0-CELL-01, X0-CELL-02, X0-CELL-03, X0-CELL-04, X0-CELL-05, X0-CELL-06, X0-CELL-07, X0-CELL-08,
   X0-CELL-09, X0-CELL-10, X0-CELL-11, X0-CELL-12, X0-CELL-13, X0-CELL-14, X0-CELL-15, X0-CELL-16,
   X0-CELL-18, X0-CELL-19, X0-CELL-20, X0-CELL-21, X0-PIN-04, X0-PIN-05, X0-FET-01, X0-FET-11, X0-CB-01,
   X0-AMB-94, X0-AMB-103, X0-AMB-104 */
static void test_every_part_with_every_cell_count(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        part = sim_x0_part_at(k);
        for (cells = rows_least(part->cells); cells <= part->cells; cells++) {
            prepare();
            every_reading_is_true();
            limits_hold();
            each_fault_and_its_recovery();
            balancing_is_legal();
            ships();
            NO_MISUSE();
        }
        for (cells = 0; cells < 20; cells++) {
            bench_part(part->name, NULL);
            b.cfg.cells = (uint8_t)cells;
            TEST_ASSERT_EQUAL(rows_wiring(part->cells, cells) ? BQ_OK : BQ_E_CELLS, bench_init());
        }
    }
}

/* proves: X0-CELL-17, X0-CELL-16 */
static void test_an_input_gains_a_cell_in_the_order_of_the_tables(void)
{
    static const uint8_t gained[3][6] = {{3, 4}, {3, 8, 4, 9}, {3, 8, 13, 4, 9, 14}};
    unsigned size, n;
    for (size = 0; size < 3; size++)
        for (n = 0; n + rows_least(5 * size + 5) <= 5 * size + 5; n++) {
            uint8_t inputs = (uint8_t)(5 * size + 5), count = (uint8_t)(rows_least(inputs) + n);
            TEST_ASSERT_EQUAL_HEX16(rows_wiring(inputs, count), bq769x0_wiring(inputs, count));
            if (n > 0)
                TEST_ASSERT_EQUAL_HEX16(1u << (gained[size][n - 1] - 1),
                                        bq769x0_wiring(inputs, count) &
                                            ~(unsigned)bq769x0_wiring(inputs, (uint8_t)(count - 1)));
        }
}

/* A wiring of one's own is accepted exactly when it keeps the rule of all tables: the lowest two inputs and
   the top one of each group, and as many as there are cells. */
/* proves: X0-CELL-16 */
static void test_every_wiring_there_could_be(void)
{
    static const char *const name[3] = {"bq7692003", "bq7693003", "bq7694003"};
    unsigned size, mask, g;
    for (size = 0; size < 3; size++) {
        bench_part(name[size], NULL);
        for (mask = 1; mask < 1u << (5 * size + 5); mask++) {
            bool legal = true;
            for (g = 0; g <= size; g++)
                legal = legal && (mask >> (5 * g) & 0x13) == 0x13;
            b.cfg.wiring = (uint16_t)mask;
            b.cfg.cells = (uint8_t)__builtin_popcount(mask);
            TEST_ASSERT_EQUAL(legal, bench_init() == BQ_OK);
            if (!legal)
                continue;
            if (bench_random(8) == 0) {
                bench_cells(3.6);
                bench_wait(300);
                TEST_ASSERT_EQUAL(BQ_OK, bench_start());
                TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
                TEST_ASSERT_INT_WITHIN(b.cfg.cells, 3600 * b.cfg.cells, (int)b.module.stack_mv);
            }
            b.cfg.cells++;
            TEST_ASSERT_EQUAL(BQ_E_CELLS, bench_init());
        }
    }
}

/* proves: X0-VAR-23 */
static void test_chemistry_is_a_matter_of_limits(void)
{
    static const uint16_t limit[3][4] = {
        {4200, 2800, 4100, 3000}, {3650, 2500, 3500, 2800}, {3900, 2000, 3700, 2300}};
    int k, kind;
    for (k = 0; k < 15; k++)
        for (kind = 0; kind < 3; kind++) {
            bench_part(sim_x0_part_at(k)->name, NULL);
            b.cfg.ov_mv = limit[kind][0];
            b.cfg.uv_mv = limit[kind][1];
            b.cfg.ov_recover_mv = limit[kind][2];
            b.cfg.uv_recover_mv = limit[kind][3];
            bench_cells(3.3);
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_INT_WITHIN(6200, limit[kind][0] * 1000, bq769x0_get_achieved(&b.d)->ov_uv);
            TEST_ASSERT_INT_WITHIN(6200, limit[kind][1] * 1000, bq769x0_get_achieved(&b.d)->uv_uv);
            NO_MISUSE();
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_part_with_every_cell_count);
    RUN_TEST(test_an_input_gains_a_cell_in_the_order_of_the_tables);
    RUN_TEST(test_every_wiring_there_could_be);
    RUN_TEST(test_chemistry_is_a_matter_of_limits);
    return UNITY_END();
}
