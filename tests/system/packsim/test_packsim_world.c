/* SPDX-License-Identifier: Apache-2.0 */
/* The world of cells: curves, charge, bleed, heat, thermistors, load. */
#include "sim_cells.h"
#include "sim_cells_load.h"
#include "sim_cells_pl.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static sim_ocv ocv;
static sim_cells cells;
static sim_pl stack;
static sim_cells_load load;
static char error[512];

static const char *write_file(const char *text)
{
    static const char name[] = "test_packsim_world.csv";
    FILE *f = fopen(name, "w");
    TEST_ASSERT_NOT_NULL(f);
    (void)fputs(text, f);
    (void)fclose(f);
    return name;
}

static sim_cells_config plain(int modules)
{
    sim_cells_config k;
    memset(&k, 0, sizeof k);
    k.modules = modules;
    for (int m = 0; m < modules; m++) {
        k.cells_in_module[m] = 6;
    }
    k.capacity_ah = 10.0;
    k.resistance_ohm = 0.002;
    k.soc_percent = 50.0;
    k.ambient_c = 25.0;
    k.bleed_ohm = 30.0;
    k.seed = 7;
    k.ocv = &ocv;
    return k;
}

void setUp(void)
{
    TEST_ASSERT_EQUAL(0,
                      sim_ocv_load(&ocv, write_file("# source\nsoc_percent,ocv_v\n0,3.0\n50,3.5\n100,4.5\n"),
                                   error, sizeof error));
}

void tearDown(void)
{
}

static void test_curve_is_linear_between_points_and_goes_on_beyond_them(void)
{
    int segment = 0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.25, sim_ocv_volts(&ocv, 25.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0, sim_ocv_volts(&ocv, 75.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.0, sim_ocv_volts(&ocv, 0.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.7, sim_ocv_volts(&ocv, 110.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.9, sim_ocv_volts(&ocv, -10.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, sim_ocv_volts(&ocv, -1000.0, &segment));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, SIM_OCV_V_MAX, sim_ocv_volts(&ocv, 1000.0, &segment));
}

static void refused(const char *text, const char *where)
{
    sim_ocv before = ocv;
    TEST_ASSERT_EQUAL(-1, sim_ocv_load(&ocv, write_file(text), error, sizeof error));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error, where), error);
    TEST_ASSERT_EQUAL_MEMORY(&before, &ocv, sizeof ocv);
}

static void test_bad_curves_are_refused_with_their_line(void)
{
    refused("soc,ocv\n0,3\n1,4\n", ".csv:1: wrong header");
    refused("soc_percent,ocv_v\n0,3\n0,4\n", ".csv:3: state of charge does not rise");
    refused("soc_percent,ocv_v\n0,3\n1,7\n", ".csv:3: voltage outside");
    refused("soc_percent,ocv_v\n0,3\n101,4\n", ".csv:3: state of charge outside");
    refused("soc_percent,ocv_v\n# comment\n0;3\n", ".csv:3: not two numbers");
    refused("soc_percent,ocv_v\n0,nan\n", ".csv:2: not two numbers");
    refused("soc_percent,ocv_v\n0,3,4\n", ".csv:2: not two numbers");
    refused("soc_percent,ocv_v\n0,3\n", "fewer than two rows");
    refused("# nothing\n", "no header line");
    TEST_ASSERT_EQUAL(-1, sim_ocv_load(&ocv, "/nonexistent/file.csv", error, sizeof error));
}

static void test_charge_is_counted_and_resistance_seen(void)
{
    sim_cells_config k = plain(1);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.5, cells.volts[0]);
    /* 36 s at 10 A = 0.1 Ah = 1 % of 10 Ah: -0.01 V of curve below 50 %, 10 A x 2 mOhm in the direction of
     * the current */
    for (int i = 0; i < 360; i++) {
        sim_cells_step(&cells, 0.1, -10.0, -10.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 49.0, sim_cells_mean_soc(&cells));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 3.49 - 0.02, cells.volts[5]);
    sim_cells_step(&cells, 0.0, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 3.49, cells.volts[5]);
    sim_cells_step(&cells, 36.0, 0.0, 20.0); /* a ramp to 20 A charges as much as 10 A */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50.0, sim_cells_mean_soc(&cells));
}

static void test_spread_is_even_seeded_and_repeatable(void)
{
    sim_cells_config k = plain(4);
    k.soc_spread_percent = 23.0; /* 24 places, 1 % apart, 38.5..61.5 */
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    bool seen[24] = {false};
    for (int i = 0; i < 24; i++) {
        int place = (int)lround(cells.soc[i] - 38.5);
        TEST_ASSERT_TRUE(place >= 0 && place < 24 && !seen[place]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 38.5 + place, cells.soc[i]);
        seen[place] = true;
    }
    double first[24];
    memcpy(first, cells.soc, sizeof first);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_EQUAL_MEMORY(first, cells.soc, sizeof first);
    k.seed = 8;
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_TRUE(memcmp(first, cells.soc, sizeof first) != 0);
}

static void test_bleed_takes_charge_only_while_on(void)
{
    sim_cells_config k = plain(1);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    /* 3.5 V / 30 Ohm for half of an hour = 0.0583 Ah = 0.583 % */
    for (int i = 0; i < 36000; i++) {
        sim_cells_bleed(&cells, 1, i % 2 != 0 ? 0x02u : 0u, 0.1);
        sim_cells_step(&cells, 0.1, 0.0, 0.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 50.0, cells.soc[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 50.0 - 0.583, cells.soc[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 50.0, cells.soc[2]);
}

static void test_forced_cells_stay_until_freed(void)
{
    sim_cells_config k = plain(1);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_EQUAL(0, sim_cells_force(&cells, 3, 4.3));
    sim_cells_step(&cells, 1.0, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.3, cells.volts[2]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.8, sim_cells_spread(&cells));
    TEST_ASSERT_EQUAL(0, sim_cells_free(&cells, 3));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.5, cells.volts[2]);
    TEST_ASSERT_EQUAL(-1, sim_cells_force(&cells, 0, 4.0));
    TEST_ASSERT_EQUAL(-1, sim_cells_force(&cells, 7, 4.0));
    TEST_ASSERT_EQUAL(-1, sim_cells_force(&cells, 1, 6.1));
    TEST_ASSERT_EQUAL(-1, sim_cells_free(&cells, 7));
    TEST_ASSERT_EQUAL(-1, sim_cells_force_sensor(&cells, 3, 25.0));
    TEST_ASSERT_EQUAL(-1, sim_cells_force_sensor(&cells, 1, 161.0));
}

static void test_losses_warm_the_cells_and_they_cool_again(void)
{
    sim_cells_config k = plain(1);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    /* 50 A: 5 W into 170 J/K = 0.0294 K/s against a time constant of 1800 s: towards 25 + 52.9 K */
    for (int i = 0; i < 1800; i++) {
        sim_cells_step(&cells, 1.0, i % 2 != 0 ? 50.0 : -50.0, i % 2 != 0 ? 50.0 : -50.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 25.0 + 52.94 * (1.0 - exp(-1.0)), sim_cells_celsius(&cells, 1));
    for (int i = 0; i < 18000; i++) {
        sim_cells_step(&cells, 1.0, 0.0, 0.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 25.0, sim_cells_celsius(&cells, 2));
}

/* proves: PL-TS-08 */
static void test_sensor_network(void)
{
    sim_cells_config k = plain(1);
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1820.0 / (1820.0 + 1470.0 + 10000.0), sim_cells_ts_ratio(&cells, 1));
    TEST_ASSERT_EQUAL(0, sim_cells_force_sensor(&cells, 2, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1820.0 / (1820.0 + 1470.0 + 28704.0), sim_cells_ts_ratio(&cells, 2));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1820.0 / (1820.0 + 1470.0 + 10000.0), sim_cells_ts_ratio(&cells, 1));
    TEST_ASSERT_EQUAL(0, sim_pl_init(&stack, 1, NULL));
    sim_cells_pl_feed(&cells, &stack);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1820.0 / 31994.0, sim_pl_ts_ratio(&stack, 1, 2));
}

static void test_stack_sees_each_cell_at_its_place(void)
{
    sim_cells_config k = plain(3);
    k.cells_in_module[1] = 4;
    TEST_ASSERT_EQUAL(0, sim_cells_init(&cells, &k));
    TEST_ASSERT_EQUAL(0, sim_pl_init(&stack, 3, NULL));
    TEST_ASSERT_EQUAL(0, sim_cells_force(&cells, 10, 3.61)); /* 6 + 4: highest cell of device 2 */
    TEST_ASSERT_EQUAL(0, sim_cells_force(&cells, 11, 3.62)); /* lowest of device 3 */
    sim_cells_pl_feed(&cells, &stack);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.61, sim_pl_cell(&stack, 2, 4));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, sim_pl_cell(&stack, 2, 5));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.62, sim_pl_cell(&stack, 3, 1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.5, sim_pl_cell(&stack, 1, 1));
}

static void test_load_is_linear_and_repeats(void)
{
    TEST_ASSERT_EQUAL(0, sim_cells_load_file(&load, write_file("time_s,current_a\n10,0\n12,-20\n20,10\n"),
                                             error, sizeof error));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, sim_cells_load_at(&load, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -10.0, sim_cells_load_at(&load, 1.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -5.0, sim_cells_load_at(&load, 6.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -10.0,
                              sim_cells_load_at(&load, 31.0)); /* 3 turns of 10 s and one second */
    load.use_table = 0;
    load.constant_a = 4.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, sim_cells_load_at(&load, 31.0));
    TEST_ASSERT_EQUAL(
        -1, sim_cells_load_file(&load, write_file("time_s,current_a\n1,0\n1,0\n"), error, sizeof error));
    TEST_ASSERT_NOT_NULL(strstr(error, ".csv:3: time does not rise"));
}

static void test_impossible_strings_are_refused(void)
{
    sim_cells_config k = plain(1);
    k.modules = 63;
    TEST_ASSERT_EQUAL(-1, sim_cells_init(&cells, &k));
    k = plain(1);
    k.capacity_ah = 0.0;
    TEST_ASSERT_EQUAL(-1, sim_cells_init(&cells, &k));
    k = plain(1);
    k.soc_percent = 101.0;
    TEST_ASSERT_EQUAL(-1, sim_cells_init(&cells, &k));
    k = plain(1);
    k.bleed_ohm = 0.0;
    TEST_ASSERT_EQUAL(-1, sim_cells_init(&cells, &k));
    k = plain(1);
    k.ocv = NULL;
    TEST_ASSERT_EQUAL(-1, sim_cells_init(&cells, &k));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_curve_is_linear_between_points_and_goes_on_beyond_them);
    RUN_TEST(test_bad_curves_are_refused_with_their_line);
    RUN_TEST(test_charge_is_counted_and_resistance_seen);
    RUN_TEST(test_spread_is_even_seeded_and_repeatable);
    RUN_TEST(test_bleed_takes_charge_only_while_on);
    RUN_TEST(test_forced_cells_stay_until_freed);
    RUN_TEST(test_losses_warm_the_cells_and_they_cool_again);
    RUN_TEST(test_sensor_network);
    RUN_TEST(test_stack_sees_each_cell_at_its_place);
    RUN_TEST(test_load_is_linear_and_repeats);
    RUN_TEST(test_impossible_strings_are_refused);
    return UNITY_END();
}
