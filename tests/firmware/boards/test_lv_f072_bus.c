/* SPDX-License-Identifier: Apache-2.0 */
/* The image of lv-f072 with trouble on its wires: CAN, a monitor that holds the bus at reset, interrupt
 * storms, request line, supply, settings. */
#include "lv_world.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

enum { STANDBY = 2, ON = 3, FAULT = 4 };
enum { POWER = 1, BROWN_OUT = 2 };
enum { BOOT = 9, FLAG_IMAGE_OK = 4 };
#define UP_MS 2500
#define WARM_MS 3500 /* a monitor that was awake has new temperatures after up to 2 s */
#define PERIOD_NS (250 * MS)
#define CAN_ESR 0x40006418u
#define ESR_BOFF 4u
#define ESR_EPVF 2u
#define SETTINGS 0x0801F000u

void setUp(void)
{
    TEST_ASSERT_TRUE(lv_start(IMAGE));
}

void tearDown(void)
{
    lv_end();
}

static void run(unsigned ms)
{
    (void)emu_run_until(lv.e, emu_now(lv.e) + ms * MS);
}

static void up(void)
{
    lv.request = true;
    lv_run(UP_MS);
    TEST_ASSERT_TRUE(lv_both_fets());
}

static bool any_fet(void)
{
    return sim_x0_chg(&lv.chip) || sim_x0_dsg(&lv.chip);
}

/* The FETs stay off for so long. */
static void off_for(unsigned ms)
{
    for (unsigned i = 0; i < ms; i += 20u) {
        run(20);
        TEST_ASSERT_FALSE(any_fet());
    }
}

static void undisturbed(void)
{
    TEST_ASSERT_TRUE(lv_both_fets());
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_IWDG]);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_SOFTWARE]);
}

static void clean(void)
{
    sim_misuse *book = emu_get_misuse(lv.e);
    TEST_ASSERT_EQUAL_STRING("", book->count != 0 ? book->entry[0].text : "");
    TEST_ASSERT_EQUAL_INT(0, (int)sim_x0_misuse(&lv.chip)->count);
}

static uint32_t esr(void)
{
    uint32_t v = 0;
    TEST_ASSERT_TRUE(emu_bus_read(lv.e, CAN_ESR, 4, &v));
    return v;
}

/* Heartbeats, one a period, without a pause beyond what the loop promises. */
static void kept_period(unsigned ms)
{
    unsigned before = lv.count[0];
    lv_watch_period();
    run(ms);
    TEST_ASSERT_INT_WITHIN(1, (int)(ms * MS / PERIOD_NS), (int)(lv.count[0] - before));
    TEST_ASSERT_TRUE(lv.longest_ns <= PERIOD_NS + PERIOD_NS / 4);
}

/* ---- time from reset ---------------------------------------------------------------------------------- */

/* A bq76940 has its first cells 800 ms after its start (X0-ADC-14); 1.2 s after power-on the healthy pack has
 * reached standby. Return arrives at 1199 ms, the answer shows the state of that moment. */
static void test_time_to_standby(void)
{
    lv_run(1187);
    lv.type = "status\r";
    lv.type_ns = 1187 * MS;
    lv_run(1240);
    TEST_ASSERT_TRUE_MESSAGE(strstr(lv.said, "state     standby") != NULL, lv.said);
    lv_run(1300);
    TEST_ASSERT_TRUE(lv.settled_ns != 0 && lv.settled_ns <= 1300 * MS); /* told once a period */
    clean();
}

/* ---- CAN ---------------------------------------------------------------------------------------------- */

static void until_bus_off(void)
{
    for (unsigned i = 0; i < 300 && (esr() & ESR_BOFF) == 0u; i++) {
        run(1);
    }
    TEST_ASSERT_TRUE((esr() & ESR_BOFF) != 0u);
}

static void test_bus_off_and_back(void)
{
    unsigned pictures;
    up();
    lv.result = EMU_CAN_BIT_ERROR;
    until_bus_off();
    run(1000);
    undisturbed();
    until_bus_off(); /* from there it comes back without errors; between two it would be passive for a while
                      */
    lv.result = EMU_CAN_ACKED;
    run(60);
    TEST_ASSERT_EQUAL_HEX32(0, esr() & (ESR_BOFF | ESR_EPVF));
    pictures = lv.count[6];
    kept_period(1000);
    TEST_ASSERT_TRUE(lv.count[6] - pictures >= 3u * 5u); /* 15 cells, three a frame */
    undisturbed();
    clean();
}

static void test_nobody_acknowledges(void)
{
    up();
    lv.result = EMU_CAN_NO_ACK;
    run(1000);
    TEST_ASSERT_EQUAL_HEX32(ESR_EPVF, esr() & (ESR_BOFF | ESR_EPVF));
    undisturbed();
    lv.result = EMU_CAN_ACKED;
    run(60);
    kept_period(1000);
    undisturbed();
    clean();
}

static uint32_t exceptions_in(unsigned ms)
{
    uint32_t before = emu_get_meter(lv.e)->exceptions;
    run(ms);
    return emu_get_meter(lv.e)->exceptions - before;
}

/* A full bus: this board only sends, so no frame interrupts it, not even one with an id that others accept.
 */
static void test_foreign_frames(void)
{
    uint32_t quiet;
    up();
    quiet = exceptions_in(250);
    lv.noise.frame = (emu_can_frame){.id = 0x123, .length = 8};
    noise_begin(&lv.noise.can, lv.e, 250000);
    TEST_ASSERT_TRUE(exceptions_in(250) < quiet + quiet / 5u);
    lv.noise.frame.id = 0x085;
    TEST_ASSERT_TRUE(exceptions_in(250) < quiet + quiet / 5u);
    kept_period(1000);
    TEST_ASSERT_TRUE(lv.noise.taken > 4000u);
    undisturbed();
    clean();
}

/* ---- interrupt storms --------------------------------------------------------------------------------- */

/* ALERT toggles for ever, an edge in 20 us: 25000 interrupts a second. */
static void test_storm_on_alert(void)
{
    up();
    noise_begin(&lv.noise.line, lv.e, 20000); /* PA0 */
    kept_period(1000);
    TEST_ASSERT_TRUE(lv.noise.line.given > 40000u);
    undisturbed();
    noise_end(&lv.noise);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(lv.e)->count);
}

static void test_console_under_fire(void)
{
    up();
    lv.noise.byte = 0x55;
    noise_begin(&lv.noise.uart, lv.e, 86805); /* back to back at 115200 */
    kept_period(1000);
    TEST_ASSERT_TRUE(lv.noise.uart.given > 10000u);
    undisturbed();
    noise_end(&lv.noise);
    lv_type("\x15version\r"); /* Ctrl-U clears what the line held */
    TEST_ASSERT_TRUE_MESSAGE(strstr(lv.said, "lv-f072") != NULL, lv.said);
    clean();
}

/* ---- the monitor holds SDA when the processor starts --------------------------------------------------- */

/* A transaction was cut by the reset: nine clocks free the bus. */
static void test_sda_held_at_reset(void)
{
    up();
    sim_x0_bus(&lv.chip)->stuck_clocks = 9;
    emu_reset(lv.e, EMU_CAUSE_PIN);
    run(WARM_MS);
    TEST_ASSERT_TRUE(sim_x0_sda_free(&lv.chip));
    TEST_ASSERT_TRUE(lv_both_fets());
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(lv.e)->count);
}

/* Nothing frees it: no output, but heartbeat, console and watchdog. */
static void test_sda_held_for_ever(void)
{
    sim_x0_bus(&lv.chip)->stuck_clocks = -1;
    lv.request = true;
    off_for(4000);
    TEST_ASSERT_TRUE(lv.count[0] >= 12u);
    TEST_ASSERT_NOT_EQUAL(ON, lv.last[0].data[0]);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_IWDG]);
    lv_type("status\r");
    TEST_ASSERT_TRUE(strstr(lv.said, "outputs   charge off, discharge off") != NULL);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(lv.e)->count);
}

/* ---- request, supply, settings ------------------------------------------------------------------------ */

static void test_request_is_debounced(void)
{
    lv_run(UP_MS);
    for (unsigned i = 0; i < 60u; i++) {
        lv.request = true;
        run(18);
        TEST_ASSERT_FALSE(any_fet());
        lv.request = false;
        run(7);
    }
    off_for(300);
    lv.request = true;
    run(600);
    TEST_ASSERT_TRUE(lv_both_fets());
    clean();
}

static void test_supply(void)
{
    up();
    emu_set_supply_mv(lv.e, 2300);
    run(600);
    undisturbed();
    emu_set_supply_mv(lv.e, 1000);
    run(50);
    lv.request = false;
    emu_set_supply_mv(lv.e, 3300);
    run(WARM_MS - 500);
    TEST_ASSERT_TRUE(lv.last[BOOT].data[0] == POWER || lv.last[BOOT].data[0] == BROWN_OUT);
    TEST_ASSERT_FALSE(any_fet()); /* the bring-up has turned them off */
    run(500);
    TEST_ASSERT_EQUAL_INT(STANDBY, lv.last[0].data[0]);
    clean();
}

/* Something is there, and it is no record. */
static void test_damaged_settings(void)
{
    static const uint8_t rubbish[] = {0x42, 0x51, 0x43, 0x46, 1, 2, 3, 4, 5, 6, 7, 8};
    lv_end();
    TEST_ASSERT_TRUE(lv_start(IMAGE));
    TEST_ASSERT_TRUE(emu_load(lv.e, SETTINGS, rubbish, sizeof rubbish));
    lv.request = true;
    off_for(3000);
    TEST_ASSERT_EQUAL_INT(FAULT, lv.last[0].data[0]);
    TEST_ASSERT_EQUAL_INT(FLAG_IMAGE_OK, lv.last[BOOT].data[1]);
    TEST_ASSERT_TRUE(lv.count[0] >= 15u);
    lv_type("status\r");
    TEST_ASSERT_TRUE_MESSAGE(strstr(lv.said, "settings") != NULL, lv.said);
    clean();
}

int main(void)
{
    if (!lv_start(IMAGE)) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    lv_end();
    UNITY_BEGIN();
    RUN_TEST(test_time_to_standby);
    RUN_TEST(test_bus_off_and_back);
    RUN_TEST(test_nobody_acknowledges);
    RUN_TEST(test_foreign_frames);
    RUN_TEST(test_storm_on_alert);
    RUN_TEST(test_console_under_fire);
    RUN_TEST(test_sda_held_at_reset);
    RUN_TEST(test_sda_held_for_ever);
    RUN_TEST(test_request_is_debounced);
    RUN_TEST(test_supply);
    RUN_TEST(test_damaged_settings);
    return UNITY_END();
}
