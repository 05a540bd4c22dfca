/* SPDX-License-Identifier: Apache-2.0 */
/* What packsim makes of the frames of a firmware that it cannot look into. The frames are written from the
 * table of the telemetry. */
#include "ps_mirror.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static ps_rig *rig;
static ps_scenario *scenario;
static ps_mirror mirror;

void setUp(void)
{
    rig = calloc(1, sizeof *rig);
    scenario = calloc(1, sizeof *scenario);
    TEST_ASSERT_NOT_NULL(rig);
    TEST_ASSERT_NOT_NULL(scenario);
    scenario->cells = 7;
    scenario->devices = 2;
    scenario->cells_of[0] = 4;
    scenario->cells_of[1] = 3;
    rig->s = scenario;
    rig->monitor = &ps_stack;
    TEST_ASSERT_EQUAL(0, sim_pl_init(&rig->pl, 2, NULL));
    ps_mirror_begin(&mirror, rig);
}

void tearDown(void)
{
    free(rig);
    free(scenario);
}

static void hear(uint32_t id, const char *hex)
{
    uint8_t data[8];
    for (int i = 0; i < 8; i++) {
        char byte[3] = {hex[2 * i], hex[2 * i + 1], 0};
        data[i] = (uint8_t)strtoul(byte, NULL, 16);
    }
    ps_mirror_hear(&mirror, rig, id, data, 5000000);
}

static const bq_pack *pack(void)
{
    return bq_app_pack(&rig->fw.firmware.app);
}

static const bq_sample *sample(void)
{
    return bq_app_sample(&rig->fw.firmware.app);
}

static void test_a_new_life_knows_nothing(void)
{
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, pack()->state);
    TEST_ASSERT_EQUAL(-1, pack()->summary.soc_permille);
    TEST_ASSERT_EQUAL(0, sample()->cell_count);
    TEST_ASSERT_FALSE(mirror.alive);
    TEST_ASSERT_EQUAL(0, rig->fw.cells[3].module);
    TEST_ASSERT_EQUAL(1, rig->fw.cells[4].module);
}

static void test_frames_of_the_period(void)
{
    hear(0x100, "030fff0010270000");
    hear(0x101, "e0930400f0d8ffff");
    hear(0x102, "100ea00f01000700");
    hear(0x103, "0a00fa00f4010200");
    hear(0x108, "2a00000007000000");
    TEST_ASSERT_EQUAL(3, pack()->state);
    TEST_ASSERT_TRUE(pack()->summary.complete);
    TEST_ASSERT_TRUE(bq_app_outputs_on(&rig->fw.firmware.app));
    TEST_ASSERT_EQUAL(10000, mirror.uptime_ms);
    TEST_ASSERT_EQUAL(300000, pack()->summary.pack_mv);
    TEST_ASSERT_EQUAL(-10000, sample()->current_ma);
    TEST_ASSERT_EQUAL(3600, pack()->summary.cell_min_mv);
    TEST_ASSERT_EQUAL(7, pack()->summary.cell_max);
    TEST_ASSERT_EQUAL(250, pack()->summary.temp_max_dc);
    TEST_ASSERT_EQUAL(500, pack()->summary.soc_permille);
    TEST_ASSERT_EQUAL(2, pack()->summary.balancing);
    TEST_ASSERT_EQUAL(7, mirror.stats.bus_errors);
    TEST_ASSERT_EQUAL(0, mirror.unknown);
}

static void test_a_fault_is_named_by_its_event(void)
{
    hear(0x104, "0100000002000164");
    TEST_ASSERT_EQUAL(0, pack()->faults); /* the table comes first and names no cell */
    TEST_ASSERT_EQUAL(2, mirror.found);
    hear(0x105, "000105000200ff00");
    TEST_ASSERT_EQUAL(1, pack()->faults);
    TEST_ASSERT_EQUAL(5, pack()->fault[0].cell);
    TEST_ASSERT_EQUAL(2, pack()->fault[0].device);
    TEST_ASSERT_EQUAL(-1, pack()->fault[0].wire);
    hear(0x105, "000005000200ff01");
    TEST_ASSERT_EQUAL(0, pack()->faults);
}

static void test_an_event_that_is_lost_does_not_hide_the_fault(void)
{
    hear(0x104, "0200000002000164");
    TEST_ASSERT_EQUAL(0, pack()->faults);
    hear(0x104, "0200000002000164");
    TEST_ASSERT_EQUAL(2, pack()->faults);
    hear(0x104, "0000000002000164");
    TEST_ASSERT_EQUAL(0, pack()->faults);
}

static void test_a_sample_counts_when_its_last_cell_is_there(void)
{
    hear(0x100, "0308ff0010270000"); /* complete */
    hear(0x107, "050000003e4b4c00"); /* sequence 5, 4999998 us: 2 us ago */
    hear(0x106, "0005100e110e120e");
    hear(0x106, "0105130effff150e");
    TEST_ASSERT_EQUAL(0, sample()->cell_count);
    hear(0x106, "0205160effffffff");
    TEST_ASSERT_EQUAL(7, sample()->cell_count);
    TEST_ASSERT_EQUAL(5, sample()->sequence);
    TEST_ASSERT_EQUAL(3600, sample()->cells[0].mv);
    TEST_ASSERT_EQUAL(BQ_Q_VALID, sample()->cells[6].quality);
    TEST_ASSERT_EQUAL(0, sample()->cells[4].quality);
    TEST_ASSERT_EQUAL(0, sample()->modules[1].age_ms);
    TEST_ASSERT_EQUAL_UINT32(0u - 2u, sample()->t_us); /* the bench stands at 0 */
}

static void test_frames_of_another_sample_or_order_are_not_mixed(void)
{
    hear(0x107, "0500000000000000");
    hear(0x106, "0005100e110e120e");
    hear(0x106, "0206160effffffff"); /* of sequence 6 */
    hear(0x106, "0205160effffffff"); /* one is missing before it */
    TEST_ASSERT_EQUAL(0, sample()->cell_count);
    TEST_ASSERT_EQUAL(2, mirror.unknown);
}

static void test_what_is_in_no_table_is_counted(void)
{
    hear(0x10a, "0000000000000000");
    hear(0x0ff, "0000000000000000");
    hear(0x105, "ff01000000000000");
    TEST_ASSERT_EQUAL(3, mirror.unknown);
    TEST_ASSERT_EQUAL(0, pack()->faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_new_life_knows_nothing);
    RUN_TEST(test_frames_of_the_period);
    RUN_TEST(test_a_fault_is_named_by_its_event);
    RUN_TEST(test_an_event_that_is_lost_does_not_hide_the_fault);
    RUN_TEST(test_a_sample_counts_when_its_last_cell_is_there);
    RUN_TEST(test_frames_of_another_sample_or_order_are_not_mixed);
    RUN_TEST(test_what_is_in_no_table_is_counted);
    return UNITY_END();
}
