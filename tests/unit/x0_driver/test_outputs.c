/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing switches, FETs that a fault takes back, calibration against the stack, the ALERT line. */
#include "x0_rig.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t commanded(void)
{
    return sim_x0_cb(&rig.chip);
}

/* Inputs of the pack's cells in `cells`, bit n-1 = VCn. */
static uint16_t inputs_of(uint32_t cells)
{
    uint16_t mask = 0;
    for (unsigned cell = 1; cell <= rig.config.cells; cell++) {
        if ((cells >> (cell - 1u) & 1u) != 0u) {
            mask = (uint16_t)(mask | 1u << (rig_input(cell) - 1u));
        }
    }
    return mask;
}

static void every_mask(const char *part, unsigned cells)
{
    rig_up(part, cells);
    rig_pass(1000);
    for (uint32_t asked = 0; asked < 1u << cells; asked += cells > 10u ? 7u : 1u) {
        uint16_t first, second;
        uint64_t from = rig.chip.now;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, asked));
        first = commanded();
        sim_x0_advance(&rig.chip, from + 4096u * 1000000u - rig.chip.now);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, asked));
        second = commanded();
        TEST_ASSERT_EQUAL_HEX16(0, (first | second) & ~inputs_of(asked));
        TEST_ASSERT_EQUAL_HEX16(inputs_of(asked),
                                first | second); /* the sets take turns: everybody is served */
    }
    rig_clean(); /* the model notes switches that are neighbours, also across shorted inputs */
}

/* proves: X0-SEQ-39, X0-CB-02, X0-CB-04, X0-CB-06, X0-AMB-62 */
static void test_every_mask_of_every_wiring_is_legal_and_served(void)
{
    every_mask("bq7692003", 3);
    every_mask("bq7692003", 4);
    every_mask("bq7692003", 5);
    every_mask("bq7693003", 6);
    every_mask("bq7693003", 8);
    every_mask("bq7693003", 10);
    every_mask("bq7694003", 13);
}

/* proves: X0-AMB-61 */
static void test_group_borders(void)
{
    rig_up("bq7693003", 10);
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0x30)); /* cells 5 and 6 */
    TEST_ASSERT_TRUE(commanded() == 0x10 || commanded() == 0x20);
    rig_part("bq7693003", 10);
    rig.config.balance_across_groups = true;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0x30));
    TEST_ASSERT_EQUAL_HEX16(0x30, commanded());
    rig_clean();
}

/* proves: X0-SEQ-42 */
static void test_number_of_switches(void)
{
    rig_part("bq7694003", 15);
    rig.config.balance_max = 2;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0x7fff));
    TEST_ASSERT_EQUAL_INT(2, __builtin_popcount(commanded()));
}

/* proves: X0-CB-13, X0-SEQ-41 */
static void test_switches_end_when_nobody_asks_for_them(void)
{
    rig_up("bq7694003", 15);
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0x0005));
    rig_pass(3500);
    TEST_ASSERT_EQUAL_HEX16(0x0005, commanded());
    rig_pass(1000);
    TEST_ASSERT_EQUAL_HEX16(0x0000, commanded());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0x0005));
    TEST_ASSERT_EQUAL_HEX16(0x0005, commanded());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, 0));
    TEST_ASSERT_EQUAL_HEX16(0x0000, commanded());
    rig_clean();
}

/* proves: X0-SEQ-41, X0-AMB-63 */
static void test_switches_end_with_any_fault(void)
{
    rig_up("bq7694003", 15);
    rig_pass(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 0x0400));
    TEST_ASSERT_EQUAL_HEX16(0x0400, commanded());
    (void)sim_x0_set_cell(&rig.chip, 1, 4.3);
    for (int n = 0; n < 12; n++) {
        bq_status held;
        rig_pass(250);
        held = rig_apply(true, true, 0x0400);
        TEST_ASSERT_EQUAL_INT(rig_faults() == 0 ? BQ_OK : BQ_E_STATE, held);
    }
    TEST_ASSERT_EQUAL_INT(BQ_F_CELL_OV, rig_faults() & BQ_F_CELL_OV);
    TEST_ASSERT_EQUAL_HEX16(0x0000, commanded());
    rig_clean();
}

/* proves: X0-FET-13, X0-SEQ-05 */
static void test_a_fault_between_scan_and_apply_keeps_the_fets_off(void)
{
    rig_up("bq7694003", 15);
    rig_pass(1000);
    (void)sim_x0_strike_xready(&rig.chip);
    TEST_ASSERT_EQUAL_INT(BQ_E_VERIFY, rig_apply(true, true, 0)); /* the chip refused: nothing is on */
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip));
    TEST_ASSERT_FALSE(sim_x0_dsg(&rig.chip));
    rig_pass(250);
    TEST_ASSERT_EQUAL_INT(BQ_F_MEMORY, rig_faults() & BQ_F_MEMORY);
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, rig_apply(true, true, 0));
    TEST_ASSERT_FALSE(sim_x0_dsg(&rig.chip));
    rig_clean();
}

/* proves: X0-NUM-116, X0-ADC-16, X0-ADC-17, X0-SEQ-45, X0-AMB-20 */
static void test_calibration_against_the_stack(void)
{
    rig_up("bq7693003", 8);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq769x0_calibrate(&rig.d, 27900)); /* 0.969 */
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, bq769x0_calibrate(&rig.d, 29700)); /* 1.031 */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    TEST_ASSERT_EQUAL_UINT(3600, rig.cells[0].mv);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_calibrate(&rig.d, 29000));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    for (unsigned i = 0; i < 8u; i++) {
        TEST_ASSERT_EQUAL_UINT(3625, rig.cells[i].mv);
    }
    TEST_ASSERT_FALSE(bq769x0_calibration_due(&rig.d));
    (void)sim_x0_set_cell(&rig.chip, (int)rig_input(8), 3.52);
    rig_pass(500);
    TEST_ASSERT_FALSE(bq769x0_calibration_due(&rig.d));
    (void)sim_x0_set_cell(&rig.chip, (int)rig_input(8), 3.49);
    rig_pass(500);
    TEST_ASSERT_TRUE(bq769x0_calibration_due(&rig.d));
    rig_clean();
}

/* proves: X0-ALERT-07 */
static void test_alert_line(void)
{
    rig_up("bq7694003", 15);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    TEST_ASSERT_FALSE(bq769x0_alert_pending(&rig.d));
    rig_wait_ms(260);
    TEST_ASSERT_TRUE(bq769x0_alert_pending(&rig.d)); /* a result of the coulomb counter */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    TEST_ASSERT_FALSE(bq769x0_alert_pending(&rig.d));
    rig.hal.missing = 1u << (unsigned)BQ_LINE_ALERT;
    TEST_ASSERT_TRUE(bq769x0_alert_pending(&rig.d));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_mask_of_every_wiring_is_legal_and_served);
    RUN_TEST(test_group_borders);
    RUN_TEST(test_number_of_switches);
    RUN_TEST(test_switches_end_when_nobody_asks_for_them);
    RUN_TEST(test_switches_end_with_any_fault);
    RUN_TEST(test_a_fault_between_scan_and_apply_keeps_the_fets_off);
    RUN_TEST(test_calibration_against_the_stack);
    RUN_TEST(test_alert_line);
    return UNITY_END();
}
