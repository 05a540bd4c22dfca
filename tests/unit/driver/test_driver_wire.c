/* SPDX-License-Identifier: Apache-2.0 */
/* Open sense wires: PL-SEQ-14. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(2);
    c.cov_mv = 0;
    c.cuv_mv = 0;
}

void tearDown(void)
{
}

static void scans(int count)
{
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    }
    rig_sample(&r);
}

/* proves: PL-SEQ-14-01, PL-SEQ-14-02, PL-SEQ-14-05, PL-VBAT-06 */
static void an_open_end_wire_is_named_after_three_cycles(void)
{
    static const int wires[2] = {0, 6};
    for (int i = 0; i < 2; i++) {
        unsigned cell = wires[i] == 0 ? 6 : 11; /* of device 2 */
        rig_up(&r, &c, NULL);
        scans(1);
        (void)sim_pl_set_wire(&r.pl, 2, wires[i], true);
        scans(2);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);               /* several cycles, not one */
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_OPEN_WIRE, r.cells[cell].quality); /* but nothing doubtful counts */
        TEST_ASSERT_EQUAL_UINT(3600, r.cells[cell].mv);
        scans(1);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, r.modules[1].faults);
        TEST_ASSERT_EQUAL_HEX16(1u << wires[i], r.modules[1].open_wire);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[8].quality);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
        (void)sim_pl_set_wire(&r.pl, 2, wires[i], false);
        scans(1);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[cell].quality);
    }
}

/* proves: PL-SEQ-14-03, PL-SEQ-14-05 */
static void an_open_inner_wire_is_named_by_its_neighbours(void)
{
    for (int wire = 1; wire <= 5; wire++) {
        rig_up(&r, &c, NULL);
        scans(1);
        (void)sim_pl_set_wire(&r.pl, 1, wire, true);
        scans(4);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, r.modules[0].faults);
        TEST_ASSERT_EQUAL_HEX16(1u << wire, r.modules[0].open_wire);
        for (int cell = 1; cell <= 6; cell++) {
            bool beside = cell == wire || cell == wire + 1;
            TEST_ASSERT_EQUAL_HEX8(beside ? BQ_Q_OPEN_WIRE : BQ_Q_VALID, r.cells[cell - 1].quality);
            TEST_ASSERT_EQUAL_UINT(3600, r.cells[cell - 1].mv);
        }
    }
}

/* The pattern of the field notes: cells 3 and 6 read nothing, the brick is 2.7 V above the sum.
 * proves: PL-SEQ-14-02 */
static void the_pattern_seen_on_hardware_is_recognised_without_history(void)
{
    static const double volts[6] = {3.463, 3.382, 0.0, 3.612, 3.702, 0.0};
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_cells(&r.pl, 1, volts);
    (void)sim_pl_set_vbat(&r.pl, 1, 16.877);
    scans(3);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, r.modules[0].faults);
    TEST_ASSERT_EQUAL_HEX16(1u << 2 | 1u << 3 | 1u << 6, r.modules[0].open_wire);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_OPEN_WIRE, r.cells[2].quality);
}

/* proves: PL-SEQ-14-02, PL-VBAT-07, PL-ELEC-13, PL-ELEC-14 */
static void legal_tolerances_raise_no_alarm(void)
{
    static const double difference[2] = {-0.109, 0.049};
    for (int i = 0; i < 2; i++) {
        rig_up(&r, &c, NULL);
        (void)sim_pl_set_vbat(&r.pl, 1, 21.6 + difference[i]);
        scans(10);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    }
}

static void a_load_step_on_all_cells_is_no_open_wire(void)
{
    static const double low[6] = {3.2, 3.21, 3.19, 3.2, 3.22, 3.18};
    rig_up(&r, &c, NULL);
    scans(1);
    (void)sim_pl_set_cells(&r.pl, 1, low);
    scans(1);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
}

/* proves: PL-SEQ-14-04 */
static void the_active_test_finds_a_wire_that_looks_whole(void)
{
    for (int wire = 0; wire <= 6; wire++) {
        sim_pl_options o;
        memset(&o, 0, sizeof o);
        o.wire_drift = 0.005; /* hardly visible at rest */
        rig_up(&r, &c, &o);
        scans(1);
        (void)sim_pl_set_wire(&r.pl, 2, wire, true);
        scans(4);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wire_test(&r.d));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_HEX16(1u << wire, r.modules[1].open_wire);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_OPEN_WIRE, r.modules[1].faults);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].open_wire);
        for (int n = 1; n <= 2; n++) {
            TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x32));
        }
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* proves: PL-SEQ-14-04 */
static void the_active_test_of_a_healthy_stack_finds_nothing(void)
{
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wire_test(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
    rig_sample(&r);
    for (int n = 0; n < 2; n++) {
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[n].open_wire);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[n].faults);
    }
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-14-05 */
static void a_device_with_an_open_wire_is_not_balanced(void)
{
    rig_up(&r, &c, NULL);
    scans(1);
    (void)sim_pl_set_wire(&r.pl, 1, 3, true);
    scans(3);
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 7);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_HEX8(1, sim_pl_cb(&r.pl, 2));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_open_end_wire_is_named_after_three_cycles);
    RUN_TEST(an_open_inner_wire_is_named_by_its_neighbours);
    RUN_TEST(the_pattern_seen_on_hardware_is_recognised_without_history);
    RUN_TEST(legal_tolerances_raise_no_alarm);
    RUN_TEST(a_load_step_on_all_cells_is_no_open_wire);
    RUN_TEST(the_active_test_finds_a_wire_that_looks_whole);
    RUN_TEST(the_active_test_of_a_healthy_stack_finds_nothing);
    RUN_TEST(a_device_with_an_open_wire_is_not_balanced);
    return UNITY_END();
}
