/* SPDX-License-Identifier: Apache-2.0 */
/* What the monitors say about themselves. */
#include "rig.h"
#include "unity.h"
#include <string.h>

static rig r;
static bq_pack_config config;

void setUp(void)
{
    config = rig_config();
    rig_init(&r, &config);
    rig_on(&r);
}

void tearDown(void)
{
}

static void only(bq_pack_fault f)
{
    TEST_ASSERT_EQUAL_MESSAGE(1u << f, r.p.faults, bq_pack_fault_name(f));
    TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
}

static void healthy(void)
{
    TEST_ASSERT_EQUAL(0, r.p.faults);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r.p.state);
    TEST_ASSERT_TRUE(r.a.charge_on && r.a.discharge_on);
}

static void test_hard_chip_flags_act_at_once(void)
{
    static const uint16_t hard[] = {BQ_F_DIE_TEMP, BQ_F_SUPPLY, BQ_F_MEMORY, BQ_F_DEFECTIVE};

    for (unsigned i = 0; i < 4; i++) {
        setUp();
        r.modules[1].faults = hard[i];
        rig_scan(&r);
        only(BQ_FAULT_CHIP);
        TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP].device);
        TEST_ASSERT_EQUAL(hard[i], r.p.fault[BQ_FAULT_CHIP].value);
        r.modules[1].faults = 0;
        rig_run(&r, 1200);
        healthy();
    }
}

static void test_soft_chip_flags_act_when_they_last(void)
{
    static const uint16_t soft[] = {BQ_F_RESET, BQ_F_LOCKUP, BQ_F_CONFIG, BQ_F_BALANCE, BQ_F_CHAIN};

    for (unsigned i = 0; i < 5; i++) {
        setUp();
        r.modules[1].faults = soft[i];
        rig_scan(&r);
        rig_run(&r, config.comm_timeout_ms - RIG_PERIOD);
        healthy();
        r.modules[1].faults = 0; /* cured in time */
        rig_scan(&r);
        r.modules[1].faults = soft[i];
        rig_scan(&r);
        rig_run(&r, config.comm_timeout_ms - RIG_PERIOD);
        healthy();
        rig_scan(&r);
        only(BQ_FAULT_CHIP);
        TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP].device);
    }
}

static void test_a_hard_flag_is_not_hidden_by_a_soft_one_below(void)
{
    r.modules[0].faults = BQ_F_RESET;
    r.modules[1].faults = BQ_F_MEMORY;
    rig_scan(&r);
    only(BQ_FAULT_CHIP);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP].device);
}

static void test_actions_that_fail_for_long_are_a_chip_fault(void)
{
    r.in.apply_status = BQ_E_VERIFY;
    rig_scan(&r);
    rig_run(&r, 400);
    healthy();
    rig_scan(&r);
    only(BQ_FAULT_CHIP);
    TEST_ASSERT_EQUAL(BQ_E_VERIFY, r.p.fault[BQ_FAULT_CHIP].value);
    TEST_ASSERT_EQUAL(0, r.p.fault[BQ_FAULT_CHIP].device);
    r.in.apply_status = BQ_OK;
    rig_run(&r, 1200);
    healthy();
}

/* BQ_E_STATE: the driver holds a path open for a reason that the sample names; that is judged, not the
 * status. */
static void test_a_path_held_back_is_no_chip_fault(void)
{
    r.in.apply_status = BQ_E_STATE;
    rig_run(&r, 3u * config.comm_timeout_ms);
    healthy();
}

/* proves: PL-TSD-03 */
static void test_thermal_shutdown_comes_before_everything_else(void)
{
    config.debounce_ms = 0;
    rig_init(&r, &config);
    rig_on(&r);
    r.cells[0].mv = 4300;
    r.temps[0].dc = 700;
    r.in.self_test = BQ_TEST_FAILED;
    r.modules[0].faults = BQ_F_CELL_OV | BQ_F_OVERTEMP | BQ_F_OVERCURRENT;
    r.modules[1].faults = BQ_F_DIE_TEMP;
    rig_scan(&r);
    TEST_ASSERT_TRUE(rig_active(&r, BQ_FAULT_CELL_OV) && rig_active(&r, BQ_FAULT_OVERTEMP));
    TEST_ASSERT_EQUAL(BQ_FAULT_CHIP, bq_pack_cause(&r.p));
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP].device);
    TEST_ASSERT_EQUAL(BQ_F_DIE_TEMP, r.p.fault[BQ_FAULT_CHIP].value);
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

/* proves: PL-UVLO-04 */
static void test_nothing_a_module_in_supply_lockout_says_counts(void)
{
    config.debounce_ms = 0;
    rig_init(&r, &config);
    rig_on(&r);
    r.modules[1].faults = BQ_F_SUPPLY | BQ_F_CELL_OV | BQ_F_CELL_UV | BQ_F_OVERTEMP;
    r.modules[1].cell_ov = 0x3f;
    r.modules[1].cell_uv = 0x3f;
    r.modules[1].sensor_ot = 3;
    r.cells[8].mv = 6000;
    r.cells[9].mv = 0;
    r.temps[2].dc = 1200;
    r.temps[3].dc = -400;
    rig_scan(&r);
    only(BQ_FAULT_CHIP);
    TEST_ASSERT_EQUAL(3700, r.p.summary.cell_max_mv);
    TEST_ASSERT_EQUAL(3700, r.p.summary.cell_min_mv);
    TEST_ASSERT_EQUAL(250, r.p.summary.temp_max_dc);
    TEST_ASSERT_FALSE(r.p.summary.complete);
    TEST_ASSERT_EQUAL(0, rig_bleeding(&r));
}

/* proves: PL-ELEC-14 */
static void test_a_comparator_that_disagrees_with_the_converter_is_not_a_defect(void)
{
    r.cells[8].mv = 4199; /* the software limit is not reached */
    r.modules[1].faults = BQ_F_CELL_OV;
    r.modules[1].cell_ov = 1u << 2;
    rig_scan(&r);
    only(BQ_FAULT_CHIP_CELL_OV);
    TEST_ASSERT_EQUAL(9, r.p.fault[BQ_FAULT_CHIP_CELL_OV].cell);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP_CELL_OV].device);
    r.modules[1].faults = 0;
    r.modules[1].cell_ov = 0;
    rig_run(&r, 1200);
    healthy();
    r.cells[8].mv = 4201; /* and the other way round */
    rig_run(&r, 400);
    only(BQ_FAULT_CELL_OV);
}

static void test_comparators_and_overcurrent_act_at_once_and_name_the_place(void)
{
    r.modules[1].cell_uv = 1u << 5;
    rig_scan(&r);
    only(BQ_FAULT_CHIP_CELL_UV);
    TEST_ASSERT_EQUAL(12, r.p.fault[BQ_FAULT_CHIP_CELL_UV].cell);
    setUp();
    r.modules[1].sensor_ot = 2;
    rig_scan(&r);
    only(BQ_FAULT_CHIP_OVERTEMP);
    TEST_ASSERT_EQUAL(4, r.p.fault[BQ_FAULT_CHIP_OVERTEMP].sensor);
    setUp();
    r.modules[0].faults = BQ_F_OVERCURRENT;
    rig_scan(&r);
    only(BQ_FAULT_OVERCURRENT);
    setUp();
    r.modules[0].faults = BQ_F_SHORT;
    rig_scan(&r);
    only(BQ_FAULT_OVERCURRENT);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_OVERCURRENT].device);
}

/* proves: PL-SEQ-08-06 */
static void test_chip_flags_are_cleared_only_once_acted_on(void)
{
    TEST_ASSERT_FALSE(r.a.clear_faults);
    r.modules[0].faults = BQ_F_CELL_UV;
    r.modules[0].cell_uv = 1;
    rig_scan(&r);
    TEST_ASSERT_TRUE(r.a.clear_faults); /* in the same action that opens */
    TEST_ASSERT_FALSE(r.a.charge_on || r.a.discharge_on);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_CHIP_CELL_UV].count);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_CHIP_CELL_UV].cell);
    r.modules[0].faults = 0;
    r.modules[0].cell_uv = 0;
    rig_scan(&r);
    TEST_ASSERT_FALSE(r.a.clear_faults);
    TEST_ASSERT_EQUAL(BQ_HOLD_TIME, r.p.fault[BQ_FAULT_CHIP_CELL_UV].hold);
    r.modules[0].faults = BQ_F_CELL_UV; /* it returns: the condition persists */
    rig_scan(&r);
    TEST_ASSERT_EQUAL(BQ_HOLD_CONDITION, r.p.fault[BQ_FAULT_CHIP_CELL_UV].hold);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_CHIP_CELL_UV].count);
}

static void test_an_open_wire_is_named_not_its_bouncing_cells(void)
{
    static const struct {
        uint16_t mask;
        int wire, cell;
    } wires[] = {{1u << 0, 0, 7}, {1u << 3, 3, 10}, {1u << 6, 6, 12}};

    for (unsigned i = 0; i < 3; i++) {
        setUp();
        r.modules[1].faults = BQ_F_OPEN_WIRE;
        r.modules[1].open_wire = wires[i].mask;
        r.cells[8].quality = r.cells[9].quality = BQ_Q_OPEN_WIRE;
        rig_run(&r, config.debounce_ms);
        healthy();
        rig_run(&r, 2000);
        only(BQ_FAULT_OPEN_WIRE);
        TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_OPEN_WIRE].device);
        TEST_ASSERT_EQUAL(wires[i].wire, r.p.fault[BQ_FAULT_OPEN_WIRE].wire);
        TEST_ASSERT_EQUAL(wires[i].cell, r.p.fault[BQ_FAULT_OPEN_WIRE].cell);
    }
}

static void test_an_open_wire_known_only_from_its_cells_is_enough(void)
{
    r.cells[3].quality = BQ_Q_OPEN_WIRE;
    rig_scan(&r);
    rig_run(&r, 200);
    healthy();
    rig_scan(&r);
    only(BQ_FAULT_OPEN_WIRE);
    TEST_ASSERT_EQUAL(4, r.p.fault[BQ_FAULT_OPEN_WIRE].cell);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_OPEN_WIRE].device);
    TEST_ASSERT_EQUAL(-1, r.p.fault[BQ_FAULT_OPEN_WIRE].wire);
}

static void test_of_several_modules_the_lowest_is_named(void)
{
    r.modules[0].cell_ov = 1u << 4 | 1u << 5;
    r.modules[1].cell_ov = 1u << 0;
    r.modules[0].sensor_ot = 2;
    r.modules[1].sensor_ot = 1;
    rig_scan(&r);
    TEST_ASSERT_EQUAL(5, r.p.fault[BQ_FAULT_CHIP_CELL_OV].cell);
    TEST_ASSERT_EQUAL(1, r.p.fault[BQ_FAULT_CHIP_CELL_OV].device);
    TEST_ASSERT_EQUAL(2, r.p.fault[BQ_FAULT_CHIP_OVERTEMP].sensor);
}

static void test_masks_alone_are_cleared_too(void)
{
    r.modules[1].cell_ov = 1;
    rig_scan(&r);
    TEST_ASSERT_TRUE(r.a.clear_faults);
    setUp();
    r.modules[1].cell_uv = 1;
    rig_scan(&r);
    TEST_ASSERT_TRUE(r.a.clear_faults);
    setUp();
    r.modules[1].sensor_ot = 1;
    rig_scan(&r);
    TEST_ASSERT_TRUE(r.a.clear_faults);
}

static void test_every_chip_fault_recovers_by_itself_while_on_is_requested(void)
{
    static const uint16_t flags[] = {BQ_F_CELL_OV, BQ_F_CELL_UV, BQ_F_OVERTEMP,    BQ_F_DIE_TEMP,
                                     BQ_F_RESET,   BQ_F_SHORT,   BQ_F_OVERCURRENT, BQ_F_OPEN_WIRE};

    for (unsigned i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        setUp();
        r.modules[0].faults = flags[i];
        rig_run(&r, 1000);
        TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
        r.modules[0].faults = 0;
        rig_run(&r, 1000);
        TEST_ASSERT_EQUAL(BQ_PACK_FAULT, r.p.state);
        rig_run(&r, 200);
        healthy();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_hard_chip_flags_act_at_once);
    RUN_TEST(test_soft_chip_flags_act_when_they_last);
    RUN_TEST(test_a_hard_flag_is_not_hidden_by_a_soft_one_below);
    RUN_TEST(test_actions_that_fail_for_long_are_a_chip_fault);
    RUN_TEST(test_a_path_held_back_is_no_chip_fault);
    RUN_TEST(test_thermal_shutdown_comes_before_everything_else);
    RUN_TEST(test_nothing_a_module_in_supply_lockout_says_counts);
    RUN_TEST(test_a_comparator_that_disagrees_with_the_converter_is_not_a_defect);
    RUN_TEST(test_comparators_and_overcurrent_act_at_once_and_name_the_place);
    RUN_TEST(test_chip_flags_are_cleared_only_once_acted_on);
    RUN_TEST(test_an_open_wire_is_named_not_its_bouncing_cells);
    RUN_TEST(test_an_open_wire_known_only_from_its_cells_is_enough);
    RUN_TEST(test_every_chip_fault_recovers_by_itself_while_on_is_requested);
    RUN_TEST(test_of_several_modules_the_lowest_is_named);
    RUN_TEST(test_masks_alone_are_cleared_too);
    return UNITY_END();
}
