/* SPDX-License-Identifier: Apache-2.0 */
/* The bench with a bq769x0: wiring, paths, shunt, thermistors, bleeding, and what the scenarios rely on. */
#include "ps_run.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench {
    ps_ini ini;
    ps_scenario scenario;
    ps_rig rig;
    ps_error error;
    int next_event;
} bench;

static bench *b;

#define SMALL                                                                                                \
    "[pack]\nmonitor = bq7694003\ncells = 13\nchemistry = nmc\nsoc_percent = 60\n"                           \
    "resistance_mohm = 10\ncapacity_ah = 10\nshunt_mohm = 2\n"                                               \
    "[run]\nduration = 60 s\nperiod = 250 ms\n[load]\ncurrent_a = -8\nrequest = on\n"

static const char small[] = SMALL;
/* imbalance would open both paths */
static const char one_apart[] = SMALL "[limits]\nimbalance_mv = 0\nimbalance_clear_mv = 0\n";

static void build_from(const char *path)
{
    ps_search search = {"", ""};
    ps_override nothing;
    memset(&nothing, 0, sizeof nothing);
    memset(b, 0, sizeof *b);
    (void)snprintf(search.data_dir, sizeof search.data_dir, "%s/data", PACKSIM_SOURCE_DIR);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_ini_read(&b->ini, path, &b->error), b->error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_scenario_build(&b->scenario, &b->ini, &search, &nothing, &b->error),
                              b->error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_rig_init(&b->rig, &b->scenario, &b->error), b->error.text);
}

static void build(const char *text)
{
    FILE *f = fopen("test_packsim_afe.ini", "w");
    TEST_ASSERT_NOT_NULL(f);
    (void)fputs(text, f);
    (void)fclose(f);
    build_from("test_packsim_afe.ini");
}

/* Runs the firmware, and the scenario's events in their time. */
static void run_until(uint64_t t)
{
    while (ps_rig_now(&b->rig) < t) {
        const ps_scenario *s = &b->scenario;
        uint64_t now = ps_rig_now(&b->rig), stop = t;
        while (b->next_event < s->events && s->event[b->next_event].t <= now) {
            ps_rig_act(&b->rig, &s->event[b->next_event++]);
        }
        if (b->next_event < s->events && s->event[b->next_event].t < t) {
            stop = s->event[b->next_event].t;
        }
        uint64_t hint = (uint64_t)bq_firmware_step(&b->rig.fw.firmware) * 1000u;
        (void)ps_rig_sync(&b->rig);
        now = ps_rig_now(&b->rig);
        if (now < stop) {
            ps_rig_advance(&b->rig, hint < stop - now ? hint : stop - now);
        }
    }
}

static void act(ps_event v)
{
    ps_rig_act(&b->rig, &v);
}

static void ask_current(double a)
{
    act((ps_event){.kind = PS_ACT_CURRENT, .value = a});
}

static bq_pack_state_id state(void)
{
    return bq_app_pack(&b->rig.fw.firmware.app)->state;
}

void setUp(void)
{
    b = calloc(1, sizeof *b);
    TEST_ASSERT_NOT_NULL(b);
}

void tearDown(void)
{
    free(b);
}

/* proves: X0-CELL-01, X0-CELL-02, X0-CELL-03, X0-CELL-04, X0-CELL-05, X0-CELL-06, X0-CELL-07, X0-CELL-08,
 * X0-CELL-09, X0-CELL-10, X0-CELL-11, X0-CELL-12, X0-CELL-13, X0-CELL-14, X0-CELL-15, X0-CELL-17 */
static void test_cells_are_connected_as_the_tables_say(void)
{
    static const struct {
        int inputs, cells;
        unsigned in_use;
    } rows[] = {
        {5, 3, 0x0013},   {5, 4, 0x0017},   {5, 5, 0x001f},   {10, 6, 0x0273},  {10, 7, 0x0277},
        {10, 8, 0x02f7},  {10, 9, 0x02ff},  {10, 10, 0x03ff}, {15, 9, 0x4e73},  {15, 10, 0x4e77},
        {15, 11, 0x4ef7}, {15, 12, 0x5ef7}, {15, 13, 0x5eff}, {15, 14, 0x5fff}, {15, 15, 0x7fff},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        static sim_cells cells;
        unsigned mask = 0;
        int last = 0;
        memset(&cells, 0, sizeof cells);
        TEST_ASSERT_EQUAL(0, sim_cells_x0_share(&cells.config, rows[i].inputs, rows[i].cells));
        for (int m = 1; m < cells.config.modules; m++) {
            cells.first_cell[m] = cells.first_cell[m - 1] + cells.config.cells_in_module[m - 1];
        }
        for (int cell = 1; cell <= rows[i].cells; cell++) {
            int input = sim_cells_x0_input(&cells, cell);
            TEST_ASSERT_GREATER_THAN(last, input);
            last = input;
            mask |= 1u << (unsigned)(input - 1);
        }
        TEST_ASSERT_EQUAL_HEX16(rows[i].in_use, mask);
    }
}

static void test_other_counts_are_refused(void)
{
    static const int bad[][2] = {{5, 2},   {5, 6},   {10, 5}, {10, 11}, {15, 8},
                                 {15, 16}, {20, 20}, {7, 5},  {0, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        sim_cells_config config;
        memset(&config, 0, sizeof config);
        TEST_ASSERT_EQUAL(-1, sim_cells_x0_share(&config, bad[i][0], bad[i][1]));
        TEST_ASSERT_EQUAL(0, config.modules);
    }
}

/* Every part with every count it can carry comes up, and each cell is measured where it is. */
/* proves: X0-CELL-22 */
static void test_every_part_with_every_count(void)
{
    for (int n = 0; n < 15; n++) {
        const sim_x0_part *part = sim_x0_part_at(n);
        for (int cells = 3 * part->cells / 5; cells <= part->cells; cells++) {
            char text[512];
            (void)snprintf(text, sizeof text,
                           "[pack]\nmonitor = %s\ncells = %d\nchemistry = nmc\nsoc_percent = 60\n"
                           "soc_spread_percent = 15\n[run]\nperiod = 250 ms\n[load]\nrequest = on\n",
                           part->name, cells);
            build(text);
            run_until(6 * PS_S);
            TEST_ASSERT_EQUAL_MESSAGE(BQ_PACK_ON, state(), text);
            const bq_sample *s = bq_app_sample(&b->rig.fw.firmware.app);
            TEST_ASSERT_EQUAL(cells, s->cell_count);
            TEST_ASSERT_EQUAL(part->cells / 5, s->temp_count);
            for (int i = 0; i < cells; i++) {
                TEST_ASSERT_DOUBLE_WITHIN(3.0, b->rig.world.volts[i] * 1000.0, s->cells[i].mv);
            }
            TEST_ASSERT_EQUAL(0, sim_x0_misuse(&b->rig.x0)->count);
        }
    }
}

static void test_current_needs_its_fet_and_passes_the_other_ones_diode(void)
{
    build(one_apart);
    run_until(PS_S / 2);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.world.current_a);
    run_until(6 * PS_S);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -8.0, b->rig.world.current_a);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -0.016, b->rig.x0.sense);
    act((ps_event){.kind = PS_ACT_CELL_VOLTS, .n = 9, .value = 4.35}); /* the part opens CHG alone */
    ask_current(4.0);
    run_until(10 * PS_S);
    TEST_ASSERT_TRUE(!sim_x0_chg(&b->rig.x0) && sim_x0_dsg(&b->rig.x0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.world.current_a);
    ask_current(-3.0);
    run_until(11 * PS_S);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -3.0, b->rig.world.current_a);
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
}

static void test_undervoltage_leaves_the_charger_its_path(void)
{
    build(one_apart);
    run_until(6 * PS_S);
    act((ps_event){.kind = PS_ACT_CELL_VOLTS, .n = 2, .value = 2.4});
    run_until(10 * PS_S);
    TEST_ASSERT_TRUE(sim_x0_chg(&b->rig.x0) && !sim_x0_dsg(&b->rig.x0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.world.current_a);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.x0.sense);
    ask_current(4.0);
    run_until(11 * PS_S);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0, b->rig.world.current_a);
}

static void test_the_pack_measures_its_current_with_the_part(void)
{
    build(small);
    run_until(8 * PS_S);
    const bq_sample *s = bq_app_sample(&b->rig.fw.firmware.app);
    TEST_ASSERT_TRUE(s->current_valid);
    TEST_ASSERT_INT_WITHIN(15, -8000, s->current_ma); /* 4.2 mA a code, noise */
    ask_current(5.0);
    run_until(9 * PS_S);
    TEST_ASSERT_INT_WITHIN(15, 5000, bq_app_sample(&b->rig.fw.firmware.app)->current_ma);
}

/* A short circuit lasts as long as the comparator needs, not as long as a step of the world. */
static void test_a_short_circuit_opens_at_once_and_the_load_is_seen(void)
{
    build(small);
    run_until(6 * PS_S);
    uint64_t t = ps_rig_now(&b->rig);
    ask_current(-200.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -200.0, b->rig.world.current_a);
    ps_rig_advance(&b->rig, PS_MS);
    TEST_ASSERT_FALSE(sim_x0_dsg(&b->rig.x0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.world.current_a);
    TEST_ASSERT_UINT_WITHIN(100001, t, b->rig.moved_t); /* scd_delay_us 100 */
    run_until(8 * PS_S);
    TEST_ASSERT_FALSE(sim_x0_chg(&b->rig.x0)); /* the driver looks for the load */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, SIM_CELLS_X0_LOAD_V, b->rig.x0.chgpin);
    ask_current(0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, b->rig.x0.chgpin);
    run_until(25 * PS_S);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
}

static void test_with_the_load_left_on_nothing_is_tried_again(void)
{
    build_from(PACKSIM_SOURCE_DIR "/scenarios/afe-short-no-removal.ini");
    run_until(21 * PS_S);
    for (uint64_t t = 21 * PS_S; t < 300 * PS_S; t += 50 * PS_MS) {
        run_until(t);
        TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    }
}

static void test_thermistors_are_ohms(void)
{
    build(small);
    run_until(6 * PS_S);
    TEST_ASSERT_DOUBLE_WITHIN(200.0, 10000.0, b->rig.x0.ts_ohm[0]); /* 25 C and a little warmth */
    act((ps_event){.kind = PS_ACT_SENSOR, .n = 2, .value = 45.0});
    TEST_ASSERT_DOUBLE_WITHIN(2.0, 4846.0, b->rig.x0.ts_ohm[1]); /* 10 kOhm, B = 3435 K */
    run_until(9 * PS_S);
    const bq_sample *s = bq_app_sample(&b->rig.fw.firmware.app);
    TEST_ASSERT_INT_WITHIN(10, 450, s->temps[1].dc);
    TEST_ASSERT_INT_WITHIN(10, 250, s->temps[0].dc);
}

/* Switch 1 and the top switch of a group of four cells, commanded for 100 s, conduct for 70 of them. */
/* proves: X0-SCH-04 */
static void test_bleeding_takes_its_share_of_the_time(void)
{
    build(small); /* 5, 4, 4 cells */
    sim_x0 *x = &b->rig.x0;
    sim_cells *c = &b->rig.world;
    double low = c->soc[0], top = c->soc[8], other = c->soc[7];
    double v_low = c->volts[0], v_top = c->volts[8];
    (void)sim_x0_boot(x, 3 * PS_MS);
    sim_x0_advance(x, 2 * PS_S);
    x->reg[1] = 0x01;
    x->reg[2] = 0x10;
    for (int i = 0; i < 100000; i++) {
        sim_x0_advance(x, PS_MS);
        TEST_ASSERT_TRUE(sim_cells_x0_observe(c, x, 0.001));
    }
    sim_cells_take_bleed(c, 1, 0);
    sim_cells_take_bleed(c, 2, 0);
    double percent_per_volt = 70.0 / 33.0 / (10.0 * 3600.0) * 100.0;
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * v_low * percent_per_volt, low - v_low * percent_per_volt, c->soc[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * v_top * percent_per_volt, top - v_top * percent_per_volt, c->soc[8]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, other, c->soc[7]);
    x->reg[1] = x->reg[2] = 0;
    TEST_ASSERT_FALSE(sim_cells_x0_observe(c, x, 0.001));
}

/* proves: X0-NUM-704, X0-NUM-706, X0-NUM-707 */
static void test_design_example_reaches_the_registers(void)
{
    build_from(PACKSIM_SOURCE_DIR "/scenarios/pack-8s.ini");
    run_until(6 * PS_S);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&b->rig.x0, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x5a, sim_x0_peek(&b->rig.x0, 0x07));
    TEST_ASSERT_EQUAL_HEX8(0x50, sim_x0_peek(&b->rig.x0, 0x08));
}

/* The scenario would prove nothing if its converter never stopped. */
static void test_frozen_converter_stops_until_it_is_switched_off(void)
{
    build_from(PACKSIM_SOURCE_DIR "/scenarios/afe-frozen-adc.ini");
    run_until(19900 * PS_MS);
    TEST_ASSERT_FALSE(b->rig.x0.frozen);
    run_until(22 * PS_S);
    TEST_ASSERT_TRUE(b->rig.x0.frozen);
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
    run_until(59 * PS_S);
    TEST_ASSERT_FALSE(b->rig.x0.frozen);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
}

/* Noise keeps every converter that works from looking stopped. */
static void test_noise_tells_a_working_converter_from_a_stopped_one(void)
{
    build(small);
    ask_current(0.0);
    for (uint64_t t = 6 * PS_S; t < 600 * PS_S; t += 250 * PS_MS) {
        run_until(t);
        TEST_ASSERT_EQUAL(0, bq_app_sample(&b->rig.fw.firmware.app)->modules[0].faults & BQ_F_LOCKUP);
    }
}

static void test_reset_of_the_firmware_leaves_the_part_running(void)
{
    build(small);
    run_until(10 * PS_S);
    uint32_t scans = b->rig.x0.scans;
    act((ps_event){.kind = PS_ACT_MCU_RESET});
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, state());
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig)); /* the part knows nothing of it */
    run_until(10 * PS_S + 100 * PS_MS);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    run_until(20 * PS_S);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
    TEST_ASSERT_GREATER_THAN(scans, b->rig.x0.scans); /* never booted again */
}

static void test_power_and_bus_actions_reach_the_part(void)
{
    build(small);
    run_until(6 * PS_S);
    act((ps_event){.kind = PS_ACT_FLIP, .value = 0.25});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, sim_x0_bus(&b->rig.x0)->flip_probability);
    act((ps_event){.kind = PS_ACT_FLIP, .value = 0.0});
    act((ps_event){.kind = PS_ACT_BUS_DEAD, .on = false});
    TEST_ASSERT_EQUAL(1, sim_x0_bus(&b->rig.x0)->dead);
    act((ps_event){.kind = PS_ACT_BUS_DEAD, .on = true});
    TEST_ASSERT_EQUAL(2, sim_x0_bus(&b->rig.x0)->dead);
    act((ps_event){.kind = PS_ACT_BUS_FREE});
    TEST_ASSERT_EQUAL(0, sim_x0_bus(&b->rig.x0)->dead);
    act((ps_event){.kind = PS_ACT_ALERT});
    TEST_ASSERT_TRUE(b->rig.x0.alert_ext);
    ps_rig_advance(&b->rig, 400 * PS_MS);
    TEST_ASSERT_FALSE(b->rig.x0.alert_ext);
    act((ps_event){.kind = PS_ACT_XREADY});
    TEST_ASSERT_EQUAL_HEX8(0x20, sim_x0_peek(&b->rig.x0, 0) & 0x20);
    act((ps_event){.kind = PS_ACT_DEVICE, .n = 1, .on = false});
    TEST_ASSERT_EQUAL(SIM_X0_OFF, b->rig.x0.mode);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    act((ps_event){.kind = PS_ACT_DEVICE, .n = 1, .on = true});
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, b->rig.x0.mode);
    run_until(30 * PS_S);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, state());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cells_are_connected_as_the_tables_say);
    RUN_TEST(test_other_counts_are_refused);
    RUN_TEST(test_every_part_with_every_count);
    RUN_TEST(test_current_needs_its_fet_and_passes_the_other_ones_diode);
    RUN_TEST(test_undervoltage_leaves_the_charger_its_path);
    RUN_TEST(test_the_pack_measures_its_current_with_the_part);
    RUN_TEST(test_a_short_circuit_opens_at_once_and_the_load_is_seen);
    RUN_TEST(test_with_the_load_left_on_nothing_is_tried_again);
    RUN_TEST(test_thermistors_are_ohms);
    RUN_TEST(test_bleeding_takes_its_share_of_the_time);
    RUN_TEST(test_design_example_reaches_the_registers);
    RUN_TEST(test_frozen_converter_stops_until_it_is_switched_off);
    RUN_TEST(test_noise_tells_a_working_converter_from_a_stopped_one);
    RUN_TEST(test_reset_of_the_firmware_leaves_the_part_running);
    RUN_TEST(test_power_and_bus_actions_reach_the_part);
    return UNITY_END();
}
