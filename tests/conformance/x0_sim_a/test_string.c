/* SPDX-License-Identifier: Apache-2.0 */
/* A string of cells and a shunt joined to the part: which input each cell reaches, what a current becomes. */
#include "rig.h"
#include "sim_cells_x0.h"

static sim_ocv curve;
static sim_cells string;

/* A string of `cells` at rest, each cell at its own voltage, shown to a booted part. */
static void join(const char *name, int inputs, int cells)
{
    sim_cells_config config = {
        .capacity_ah = 1.0, .soc_percent = 50.0, .ambient_c = 25.0, .bleed_ohm = 100.0};
    curve.points = 2;
    curve.soc[1] = 100.0;
    curve.v[0] = 3.0;
    curve.v[1] = 4.0;
    curve.slope[0] = curve.slope[1] = 0.01;
    config.ocv = &curve;
    TEST_ASSERT_EQUAL(0, sim_cells_x0_share(&config, inputs, cells));
    TEST_ASSERT_EQUAL(0, sim_cells_init(&string, &config));
    for (int cell = 1; cell <= cells; cell++) {
        TEST_ASSERT_EQUAL(0, sim_cells_force(&string, cell, 2.0 + 0.1 * cell));
    }
    rig_pulse(name);
    sim_cells_x0_feed(&string, &chip);
}

/* Inputs with a voltage; they rise with the number of the cell, and none is left out. */
static unsigned in_use(int inputs, int cells)
{
    unsigned mask = 0;
    int cell = 0;
    for (int i = 0; i < inputs; i++) {
        if (chip.cell[i] > 0.0) {
            cell++;
            TEST_ASSERT_TRUE(chip.cell[i] > 1.95 + 0.1 * cell && chip.cell[i] < 2.05 + 0.1 * cell);
            mask |= 1u << i;
        }
    }
    TEST_ASSERT_EQUAL(cells, cell);
    return mask;
}

static const char *const name_of[3] = {"bq7692000", "bq7693003", "bq7694006"};

/* proves: X0-CELL-16 */
static void test_each_group_has_its_lowest_two_and_its_top(void)
{
    for (int groups = 1; groups <= 3; groups++) {
        for (int cells = 3 * groups; cells <= 5 * groups; cells++) {
            unsigned mask;
            join(name_of[groups - 1], 5 * groups, cells);
            mask = in_use(5 * groups, cells);
            for (int g = 0; g < groups; g++) {
                TEST_ASSERT_EQUAL_HEX8(0x13, mask >> 5 * g & 0x13u);
            }
        }
    }
}

/* proves: X0-CELL-17 */
static void test_inputs_gain_a_cell_in_the_order_of_the_tables(void)
{
    static const int gained[3][6] = {{3, 4}, {3, 8, 4, 9}, {3, 8, 13, 4, 9, 14}};
    for (int groups = 1; groups <= 3; groups++) {
        unsigned before, now;
        join(name_of[groups - 1], 5 * groups, 3 * groups);
        before = in_use(5 * groups, 3 * groups);
        for (int n = 0; n < 2 * groups; n++) {
            join(name_of[groups - 1], 5 * groups, 3 * groups + n + 1);
            now = in_use(5 * groups, 3 * groups + n + 1);
            TEST_ASSERT_EQUAL_HEX16(1u << (gained[groups - 1][n] - 1), now & ~before);
            TEST_ASSERT_EQUAL_HEX16(0, before & ~now);
            before = now;
        }
    }
}

static void through(double milliohm, double amp)
{
    sim_cells_x0_show_current(&chip, milliohm * 1e-3, -amp, -amp);
}

static void drops(double milliohm, double amp, double millivolt)
{
    through(milliohm, amp);
    TEST_ASSERT_TRUE(chip.sense > -(millivolt + 0.001) * 1e-3 && chip.sense < -(millivolt - 0.001) * 1e-3);
}

/* 12 mohm is the right quotient of 300 mV and 25 A, 7.5 mohm that of 40 A and that of 100 mV and 13.3 A. */
/* proves: X0-AMB-05 */
static void test_a_current_becomes_the_voltage_of_its_shunt(void)
{
    rig_boot("bq7692003");
    drops(12.0, 25.0, 300.0);
    drops(7.5, 40.0, 300.0);
    drops(7.5, 13.0 + 1.0 / 3.0, 100.0);
    drops(5.0, 25.0, 125.0);
}

/* Both choices are as near to 25 A through 5 mohm; only the one below it trips there. */
/* proves: X0-AMB-06 */
static void test_a_limit_of_25_a_is_kept_by_the_threshold_below_it(void)
{
    static const struct {
        int protect1;
        double trips_above_a;
    } choice[2] = {{0x83, 22.2}, {0x84, 26.6}}; /* 111 and 133 mV, 70 us */
    for (int i = 0; i < 2; i++) {
        rig_boot("bq7692003");
        TEST_ASSERT_TRUE(rig_write(0x06, choice[i].protect1));
        TEST_ASSERT_TRUE(rig_write(0x07, 0x7f)); /* 1280 ms: the overcurrent limit stays out of it */
        through(5.0, choice[i].trips_above_a - 0.01);
        rig_wait(1);
        expect_stat(0x00);
        through(5.0, 25.0);
        rig_wait(1);
        expect_stat(i == 0 ? 0x02 : 0x00);
        through(5.0, choice[i].trips_above_a + 0.01);
        rig_wait(1);
        expect_stat(0x02);
    }
}

/* Below 6 V a group is outside its range and below 3.6 V the part would shut down; the model's supply is a
 * switch of its own, whatever the cells have. */
/* proves: X0-AMB-97 */
static void test_the_supply_does_not_follow_the_cells(void)
{
    for (int volts = 2; volts >= 0; volts--) {
        rig_boot("bq7694003");
        for (int i = 1; i <= 15; i++) {
            (void)sim_x0_set_cell(&chip, i, 0.5 * volts); /* groups of 5.0, 2.5 and 0 V */
        }
        rig_wait(1000);
        TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
        TEST_ASSERT_EQUAL(volts == 0 ? 0 : volts == 1 ? 1309 : 2618, rig_read16(0x0c)); /* 382 uV each */
        expect_reg(0x04, 0x10);
        expect_clean();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_group_has_its_lowest_two_and_its_top);
    RUN_TEST(test_inputs_gain_a_cell_in_the_order_of_the_tables);
    RUN_TEST(test_a_current_becomes_the_voltage_of_its_shunt);
    RUN_TEST(test_a_limit_of_25_a_is_kept_by_the_threshold_below_it);
    RUN_TEST(test_the_supply_does_not_follow_the_cells);
    return UNITY_END();
}
