/* SPDX-License-Identifier: Apache-2.0 */
/* The bench does to the pack what a scenario says, and the judge hears of it. */
#include "ps_options.h"
#include "ps_run.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench {
    ps_ini ini;
    ps_scenario scenario;
    ps_rig rig;
    ps_judge judge;
    ps_run run;
    ps_error error;
} bench;

static bench *b;

static const char small[] =
    "[pack]\nmonitor = bq76pl536\ndevices = 3\ncells = 14\nchemistry = nmc\nsoc_percent = 60\n"
    "resistance_mohm = 1\ncapacity_ah = 60\n"
    "[run]\nduration = 20 s\n[load]\ncurrent_a = -50\nrequest = on\n";

static void build_from(const char *path)
{
    ps_search search = {"", ""};
    ps_override nothing;
    memset(&nothing, 0, sizeof nothing);
    (void)snprintf(search.data_dir, sizeof search.data_dir, "%s/data", PACKSIM_SOURCE_DIR);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_ini_read(&b->ini, path, &b->error), b->error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_scenario_build(&b->scenario, &b->ini, &search, &nothing, &b->error),
                              b->error.text);
    TEST_ASSERT_EQUAL_MESSAGE(0, ps_rig_init(&b->rig, &b->scenario, &b->error), b->error.text);
    ps_judge_init(&b->judge, &b->scenario);
    b->run.rig = &b->rig;
    b->run.judge = &b->judge;
}

static void build(const char *more)
{
    FILE *f = fopen("test_packsim_rig.ini", "w");
    TEST_ASSERT_NOT_NULL(f);
    (void)fprintf(f, "%s%s", small, more);
    (void)fclose(f);
    build_from("test_packsim_rig.ini");
}

static void run_until(uint64_t t)
{
    while (ps_rig_now(&b->rig) < t) {
        uint64_t left = t - ps_rig_now(&b->rig);
        uint64_t hint = (uint64_t)bq_firmware_step(&b->rig.fw.firmware) * 1000u;
        (void)ps_rig_sync(&b->rig);
        ps_rig_advance(&b->rig, hint < left ? hint : left);
    }
}

static void act(ps_event v)
{
    ps_rig_act(&b->rig, &v);
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

static void test_current_flows_only_through_a_closed_or_welded_contactor(void)
{
    build("");
    double rest = b->rig.world.volts[0];
    run_until(PS_S / 10);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, rest, b->rig.world.volts[0]);
    run_until(10 * PS_S);
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, rest - 0.050,
                              b->rig.world.volts[0]); /* 50 A x 1 mOhm and a little charge */
    act((ps_event){.kind = PS_ACT_REQUEST, .on = false});
    run_until(11 * PS_S);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, rest, b->rig.world.volts[0]);
    act((ps_event){.kind = PS_ACT_WELD});
    run_until(12 * PS_S);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, rest - 0.050, b->rig.world.volts[0]);
}

static void test_reset_releases_the_pins_and_forgets_everything(void)
{
    build("");
    run_until(10 * PS_S);
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
    act((ps_event){.kind = PS_ACT_MCU_RESET});
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, bq_app_pack(&b->rig.fw.firmware.app)->state);
    TEST_ASSERT_EQUAL(0, b->rig.afe.ops->modules_found(b->rig.afe.ctx));
    run_until(20 * PS_S); /* the request stays */
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
}

/* A watchdog of one second would not bite, and the firmware may ask for its own restart. */
static void test_the_watchdog_is_fed_and_a_reset_can_be_asked_for(void)
{
    build("");
    run_until(10 * PS_S);
    TEST_ASSERT_GREATER_THAN(0, b->rig.fed_gap);
    TEST_ASSERT_LESS_OR_EQUAL(300 * PS_MS, b->rig.fed_gap);
    TEST_ASSERT_FALSE(b->rig.player->restarted(&b->rig));
    b->rig.fw.firmware.target.reset = true; /* as the console's command does */
    run_until(11 * PS_S);
    TEST_ASSERT_FALSE(ps_rig_outputs_on(&b->rig));
    TEST_ASSERT_TRUE(b->rig.player->restarted(&b->rig));
    TEST_ASSERT_EQUAL(BQ_RESET_SOFTWARE, b->rig.boot.cause);
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, bq_app_pack(&b->rig.fw.firmware.app)->state);
    run_until(20 * PS_S); /* the request stays */
    TEST_ASSERT_TRUE(ps_rig_outputs_on(&b->rig));
}

static void test_wires_belong_to_the_device_that_measures_the_cell(void)
{
    build(""); /* 14 cells on 3 devices: 5, 5, 4 */
    act((ps_event){.kind = PS_ACT_WIRE, .n = 0, .on = true});
    TEST_ASSERT_EQUAL_HEX8(0x01, b->rig.pl.dev[0].wires_open);
    act((ps_event){.kind = PS_ACT_WIRE, .n = 5, .on = true});
    TEST_ASSERT_EQUAL_HEX8(0x21, b->rig.pl.dev[0].wires_open);
    act((ps_event){.kind = PS_ACT_WIRE, .n = 6, .on = true});
    TEST_ASSERT_EQUAL_HEX8(0x02, b->rig.pl.dev[1].wires_open);
    act((ps_event){.kind = PS_ACT_WIRE, .n = 14, .on = true});
    TEST_ASSERT_EQUAL_HEX8(0x10, b->rig.pl.dev[2].wires_open);
    act((ps_event){.kind = PS_ACT_WIRE, .n = 14, .on = false});
    TEST_ASSERT_EQUAL_HEX8(0x00, b->rig.pl.dev[2].wires_open);
}

static void test_world_actions_reach_the_chips(void)
{
    build("");
    act((ps_event){.kind = PS_ACT_CELL_VOLTS, .n = 11, .value = 4.1});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.1, sim_pl_cell(&b->rig.pl, 3, 1));
    act((ps_event){.kind = PS_ACT_SENSOR, .n = 4, .value = 0.0});
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1820.0 / 31994.0, sim_pl_ts_ratio(&b->rig.pl, 2, 2));
    act((ps_event){.kind = PS_ACT_DEVICE, .n = 2, .on = false});
    TEST_ASSERT_FALSE(sim_pl_supply(&b->rig.pl, 2));
    act((ps_event){.kind = PS_ACT_FLIP, .value = 0.25});
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, sim_pl_bus_fault(&b->rig.pl)->flip_probability);
    act((ps_event){.kind = PS_ACT_BUS_DEAD, .on = false});
    TEST_ASSERT_EQUAL(1, sim_pl_bus_fault(&b->rig.pl)->dead);
    act((ps_event){.kind = PS_ACT_BUS_DEAD, .on = true});
    TEST_ASSERT_EQUAL(2, sim_pl_bus_fault(&b->rig.pl)->dead);
    act((ps_event){.kind = PS_ACT_BUS_FREE});
    TEST_ASSERT_EQUAL(0, sim_pl_bus_fault(&b->rig.pl)->dead);
}

static void test_truth_is_that_of_the_moment_asked_for(void)
{
    build("");
    ps_rig_advance(&b->rig, 150 * PS_MS);
    double before = b->rig.world.volts[0];
    act((ps_event){.kind = PS_ACT_CELL_VOLTS, .n = 1, .value = 4.1});
    ps_rig_advance(&b->rig, 20 * PS_MS);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, before, ps_rig_truth(&b->rig, 149 * PS_MS)[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.1, ps_rig_truth(&b->rig, 150 * PS_MS)[0]);
    ps_rig_advance(&b->rig, 2 * PS_S);
    TEST_ASSERT_NULL(ps_rig_truth(&b->rig, 150 * PS_MS));
}

/* The lock-up scenario would prove nothing if its converter never locked up. */
static void test_lock_up_scenario_locks_up(void)
{
    int locked = 0;
    build_from(PACKSIM_SOURCE_DIR "/scenarios/adc-lock-up.ini");
    for (uint64_t t = 0; t < 60 * PS_S; t += 5 * PS_MS) {
        while (b->run.next_event < b->scenario.events && b->scenario.event[b->run.next_event].t <= t) {
            act(b->scenario.event[b->run.next_event++]);
        }
        run_until(t);
        locked += sim_pl_get_mode(&b->rig.pl, 2) == SIM_PL_LOCKED ? 1 : 0;
    }
    TEST_ASSERT_GREATER_THAN(0, locked);
    TEST_ASSERT_EQUAL(SIM_PL_ACTIVE, sim_pl_get_mode(&b->rig.pl, 2));
}

static char *summary_of_run(void)
{
    static char text[8192];
    FILE *f = tmpfile();
    TEST_ASSERT_NOT_NULL(f);
    ps_run_all(&b->run);
    (void)ps_summary(f, &b->run, false);
    rewind(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    (void)fclose(f);
    return text;
}

/* Someone else on the bus does what the datasheet forbids: it must not pass unseen. */
static void test_misuse_fails_the_run_and_is_named(void)
{
    build("[expect]\nmisuse none\n");
    sim_misuse_add(sim_pl_misuse(&b->rig.pl), 0, 1, "PL-ADC-12", "canary");
    const char *text = summary_of_run();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "misuse none (1 times)"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "PL-ADC-12 canary"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "result: fail"), text);
}

static bool damage_addresses(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    if (n == 4 && tx[1] == 0x3b) {
        tx[3] ^= 0xffu; /* damaged address writes */
    }
    return false;
}

/* A stack that never accepts an address: no device, no outputs, and the run ends all the same. */
static void test_a_stack_that_never_answers_ends_in_a_fault(void)
{
    build("[expect]\ndiscovered 3 at 19 s\nstate on at 19 s\noutputs off within 1 ms of 19 s\n");
    sim_pl_bus_fault(&b->rig.pl)->hook = damage_addresses;
    const char *text = summary_of_run();
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(text, "failed: test_packsim_rig.ini:15: discovered 3 at 19 s (0 discovered)"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "held: outputs off within 1 ms of 19 s"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "devices found: 0"), text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_current_flows_only_through_a_closed_or_welded_contactor);
    RUN_TEST(test_reset_releases_the_pins_and_forgets_everything);
    RUN_TEST(test_the_watchdog_is_fed_and_a_reset_can_be_asked_for);
    RUN_TEST(test_wires_belong_to_the_device_that_measures_the_cell);
    RUN_TEST(test_world_actions_reach_the_chips);
    RUN_TEST(test_truth_is_that_of_the_moment_asked_for);
    RUN_TEST(test_lock_up_scenario_locks_up);
    RUN_TEST(test_misuse_fails_the_run_and_is_named);
    RUN_TEST(test_a_stack_that_never_answers_ends_in_a_fault);
    return UNITY_END();
}
