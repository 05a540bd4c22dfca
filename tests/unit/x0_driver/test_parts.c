/* SPDX-License-Identifier: Apache-2.0 */
/* One suite for all: every part with every cell count it can have goes through boot, identification,
 * configuration, measurement, outputs, balancing and SHIP, without one thing the judge would note. */
#include "x0_rig.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void distinct_cells(void)
{
    for (unsigned c = 1; c <= rig.config.cells; c++) {
        (void)sim_x0_set_cell(&rig.chip, (int)rig_input(c), 3.4 + 0.02 * c);
    }
}

static void judge_picture(unsigned cells)
{
    uint32_t sum = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    TEST_ASSERT_EQUAL_UINT(cells, rig.sample.cell_count);
    for (unsigned c = 0; c < cells; c++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[c].quality);
        TEST_ASSERT_UINT_WITHIN(1, 3420u + 20u * c, rig.cells[c].mv);
        sum += rig.cells[c].mv;
    }
    TEST_ASSERT_EQUAL_UINT(sum, rig.modules[0].stack_mv);
    TEST_ASSERT_EQUAL_HEX16(0, rig.modules[0].faults);
    for (unsigned t = 0; t < rig.config.sensors; t++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.temps[t].quality);
        TEST_ASSERT_INT_WITHIN(1, 250, rig.temps[t].dc);
    }
    TEST_ASSERT_TRUE(rig.sample.current_valid);
    TEST_ASSERT_INT_WITHIN(2, -2000, rig.sample.current_ma);
}

static void whole_life(const sim_x0_part *part, unsigned cells)
{
    rig_part(part->name, cells);
    (void)sim_x0_set_gain(&rig.chip, 377);
    (void)sim_x0_set_offset(&rig.chip, -20);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    TEST_ASSERT_EQUAL_HEX8(part->address7, bq769x0_get_achieved(&rig.d)->address7);
    TEST_ASSERT_EQUAL_INT(part->crc, bq769x0_get_achieved(&rig.d)->crc);
    TEST_ASSERT_EQUAL_INT(-20, bq769x0_get_achieved(&rig.d)->trim.offset_mv);
    TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
    distinct_cells();
    (void)sim_x0_set_sense(&rig.chip, -0.010);
    rig_pass(2500);
    judge_picture(cells);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 0x7fffu));
    TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
    TEST_ASSERT_TRUE(sim_x0_cb(&rig.chip) != 0);
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_self_test(&rig.d)));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_ship(&rig.d)));
    TEST_ASSERT_EQUAL_INT(SIM_X0_SHIP, rig.chip.mode);
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq769x0_begin_scan(&rig.d));
    rig_clean();
    /* the suffix alone gives address and CRC; a wrong one is an error of the configuration, not a retry */
    rig.config.crc = part->crc ? BQ769X0_CRC_OFF : part->address7 == 0x08 ? BQ769X0_CRC_ON : BQ769X0_CRC_OFF;
    if (part->address7 == 0x08) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
        TEST_ASSERT_EQUAL_INT(BQ_E_CONFIG, rig_start());
    }
}

/* proves: X0-VAR-01, X0-VAR-02, X0-VAR-03, X0-VAR-04, X0-VAR-05, X0-VAR-06, X0-VAR-07, X0-VAR-08, X0-VAR-09,
 * X0-VAR-10, X0-VAR-11, X0-VAR-12, X0-VAR-13, X0-VAR-14, X0-VAR-15, X0-VAR-16, X0-VAR-19, X0-VAR-20,
 * X0-VAR-22, X0-SEQ-07, X0-SEQ-08, X0-SEQ-10, X0-CELL-18, X0-BIT-03 */
static void test_every_part_with_every_cell_count(void)
{
    static const struct {
        uint8_t inputs, least;
    } size[3] = {{5, 3}, {10, 6}, {15, 9}};
    for (int n = 0; n < 15; n++) {
        const sim_x0_part *part = sim_x0_part_at(n);
        unsigned k = part->cells / 5u - 1u;
        TEST_ASSERT_EQUAL_UINT(size[k].inputs, part->cells);
        for (unsigned cells = size[k].least; cells <= part->cells; cells++) {
            whole_life(part, cells);
        }
        rig.config.crc = BQ769X0_CRC_PROBE;
        rig.config.cells = (uint8_t)(size[k].least - 1u);
        TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, rig_init());
        rig.config.cells = (uint8_t)(part->cells + 1u);
        TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, rig_init());
    }
}

/* proves: X0-VAR-17 */
static void test_no_part_has_crc_at_0x18(void)
{
    rig_part("bq7694006", 15);
    rig.config.address7 = 0x18;
    rig.config.crc = BQ769X0_CRC_ON;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, rig_init());
    rig.config.crc = BQ769X0_CRC_PROBE;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    rig.config.address7 = 0x08; /* somebody else's */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_FOUND, rig_start());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_part_with_every_cell_count);
    RUN_TEST(test_no_part_has_crc_at_0x18);
    return UNITY_END();
}
