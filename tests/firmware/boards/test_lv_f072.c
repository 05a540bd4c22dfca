/* SPDX-License-Identifier: Apache-2.0 */
/* The image of lv-f072 from power-on: clocks with and without the crystal, console, CAN, monitor, crash,
 * watchdog, damage. Numbers on CAN: docs of telemetry.h; causes and kinds: hal.h. */
#include "lv_world.h"
#include "unity.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAUSE_POWER 1
#define CAUSE_PIN 3
#define CAUSE_WATCHDOG 5
#define CAUSE_CRASH 6
#define FLAG_CRASH 1
#define FLAG_NO_CRYSTAL 2
#define FLAG_IMAGE_OK 4
#define BOOT 9
#define UP_MS 2500 /* monitor brought up, measured, tested, outputs on */

void setUp(void)
{
    TEST_ASSERT_TRUE(lv_start(IMAGE));
}

void tearDown(void)
{
    lv_end();
}

/* Neither the microcontroller's judge nor the monitor's noted anything. */
static void clean(void)
{
    sim_misuse *book = emu_get_misuse(lv.e);
    TEST_ASSERT_EQUAL_STRING("", book->count != 0 ? book->entry[0].text : "");
    TEST_ASSERT_EQUAL_INT(0, (int)sim_x0_misuse(&lv.chip)->count);
}

static uint32_t crash_kind(void)
{
    return lv.last[BOOT].data[2] | (uint32_t)lv.last[BOOT].data[3] << 8;
}

static void boot_frame(int cause, int flags)
{
    TEST_ASSERT_EQUAL_INT(cause, lv.last[BOOT].data[0]);
    TEST_ASSERT_EQUAL_INT(flags, lv.last[BOOT].data[1]);
}

static void up(void)
{
    lv.request = true;
    lv_run(UP_MS);
    TEST_ASSERT_TRUE(lv_both_fets());
    TEST_ASSERT_TRUE(lv.led);
}

static void test_power_on(void)
{
    lv_run(150);
    boot_frame(CAUSE_POWER, FLAG_IMAGE_OK);
    lv_run(1000);
    TEST_ASSERT_FALSE(lv_both_fets()); /* nobody asked */
    up();
    TEST_ASSERT_TRUE(lv.count[0] >= 8); /* heartbeats, one a period of 250 ms */
    TEST_ASSERT_TRUE(lv.count[6] >= 5 && lv.count[6] % 5u == 0);
    lv.request = false;
    lv_run(UP_MS + 300);
    TEST_ASSERT_FALSE(sim_x0_chg(&lv.chip) || sim_x0_dsg(&lv.chip));
    clean();
}

static void test_console(void)
{
    lv_run(UP_MS);
    lv_type("cells\r");
    TEST_ASSERT_TRUE(strstr(lv.said, "3600") != NULL);
    lv_type("version\r");
    TEST_ASSERT_TRUE(strstr(lv.said, "lv-f072") != NULL);
    TEST_ASSERT_TRUE(strstr(lv.said, "power-on") != NULL);
    clean();
}

static void test_without_crystal(void)
{
    emu_set_crystal(lv.e, false);
    lv_run(300);
    boot_frame(CAUSE_POWER, FLAG_IMAGE_OK | FLAG_NO_CRYSTAL);
    up();
    clean();
}

/* The change of clock costs no transaction, no frame and no reset. */
static void test_crystal_fails_in_service(void)
{
    unsigned frames;
    up();
    frames = lv.frames;
    emu_set_crystal(lv.e, false);
    lv_run(UP_MS + 3000);
    boot_frame(CAUSE_POWER, FLAG_IMAGE_OK | FLAG_NO_CRYSTAL);
    TEST_ASSERT_TRUE(lv_both_fets());
    TEST_ASSERT_TRUE(lv.frames - frames >= 12u * 11u);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_SOFTWARE]);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_IWDG]);
    clean();
}

/* The guard lies behind the record of 80 bytes at the start of RAM. The bring-up after the reset turns the
 * FETs off. */
static void test_stack_guard(void)
{
    uint32_t damage = 0;
    up();
    TEST_ASSERT_TRUE(emu_poke(lv.e, 0x20000060u, &damage, 4));
    lv.request = false;
    lv_run(UP_MS + 1200);
    TEST_ASSERT_EQUAL_UINT(1, emu_get_meter(lv.e)->resets[EMU_CAUSE_SOFTWARE]);
    boot_frame(CAUSE_CRASH, FLAG_IMAGE_OK | FLAG_CRASH);
    TEST_ASSERT_EQUAL_HEX32(0x100, crash_kind());
    TEST_ASSERT_FALSE(sim_x0_chg(&lv.chip) || sim_x0_dsg(&lv.chip));
    clean();
}

/* The vector of USART2 without its Thumb bit: the first byte on the console is a HardFault. The vector is
 * repaired before the next start, or the checksum would not hold. */
static void test_hard_fault(void)
{
    uint32_t vector, even, pc;
    up();
    TEST_ASSERT_TRUE(emu_peek(lv.e, 0x08000000u + 4u * (16u + 28u), &vector, 4));
    even = vector & ~1u;
    TEST_ASSERT_TRUE(emu_poke(lv.e, 0x08000000u + 4u * (16u + 28u), &even, 4));
    emu_stop_on_reset(lv.e, true);
    lv.type = "x";
    TEST_ASSERT_EQUAL_INT(EMU_STOP_RESET, emu_run_until(lv.e, emu_now(lv.e) + 100 * MS));
    emu_stop_on_reset(lv.e, false);
    TEST_ASSERT_TRUE(emu_poke(lv.e, 0x08000000u + 4u * (16u + 28u), &vector, 4));
    lv_run(UP_MS + 600);
    boot_frame(CAUSE_CRASH, FLAG_IMAGE_OK | FLAG_CRASH);
    TEST_ASSERT_EQUAL_HEX32(3, crash_kind());
    memcpy(&pc, &lv.last[BOOT].data[4], 4);
    TEST_ASSERT_EQUAL_HEX32(even, pc);
    lv_type("version\r");
    TEST_ASSERT_TRUE(strstr(lv.said, "crash") != NULL);
}

/* The time base stops: nothing wakes the loop any more. The watchdog waits one second, its oscillator
 * is 30..60 kHz. */
static void test_watchdog(void)
{
    up();
    TEST_ASSERT_TRUE(emu_bus_write(lv.e, 0x40000000u, 4, 0));
    lv_run(UP_MS + 1600);
    TEST_ASSERT_EQUAL_UINT(1, emu_get_meter(lv.e)->resets[EMU_CAUSE_IWDG]);
    boot_frame(CAUSE_WATCHDOG, FLAG_IMAGE_OK);
}

/* The slowest loop that is healthy lives with the fastest oscillator of the watchdog. */
static void test_fast_watchdog(void)
{
    emu_set_lsi_hz(lv.e, 60000);
    up();
    lv_run(10000);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_meter(lv.e)->resets[EMU_CAUSE_IWDG]);
    clean();
}

static void test_reset_pin(void)
{
    up();
    emu_reset(lv.e, EMU_CAUSE_PIN);
    lv_run(UP_MS + 200);
    boot_frame(CAUSE_PIN, FLAG_IMAGE_OK);
}

/* One bit of the image: no output for ever, but heartbeat and console. */
static void test_damaged_image(void)
{
    uint8_t byte;
    TEST_ASSERT_TRUE(emu_peek(lv.e, 0x0800001cu, &byte, 1)); /* vector 7, which nobody uses */
    byte ^= 0x80u;
    TEST_ASSERT_TRUE(emu_poke(lv.e, 0x0800001cu, &byte, 1));
    lv.request = true;
    lv_run(4000);
    TEST_ASSERT_FALSE(sim_x0_chg(&lv.chip) || sim_x0_dsg(&lv.chip) || lv.led);
    boot_frame(CAUSE_POWER, 0);
    TEST_ASSERT_TRUE(lv.count[0] >= 20);
    lv_type("status\r");
    TEST_ASSERT_TRUE_MESSAGE(strstr(lv.said, "image") != NULL, lv.said);
}

/* A slave that holds SDA is clocked free, and the pack goes on. */
static void test_stuck_bus(void)
{
    up();
    sim_x0_bus(&lv.chip)->stuck_clocks = 7;
    lv_run(UP_MS + 2000);
    TEST_ASSERT_TRUE(sim_x0_sda_free(&lv.chip));
    TEST_ASSERT_TRUE(lv_both_fets());
}

static const char *counter(const char *name)
{
    const char *at;
    lv_type("counters\r");
    at = strstr(lv.said, name);
    return at != NULL ? at + strlen(name) : "";
}

/* hal.h: a recovery blocks for 200 us at most. */
static void test_recovery_is_short(void)
{
    up();
    lv.clock_first = 0;
    sim_x0_bus(&lv.chip)->stuck_clocks = 9;
    lv_run(UP_MS + 260);
    TEST_ASSERT_TRUE(lv.clock_first != 0);
    TEST_ASSERT_TRUE(lv.clock_last - lv.clock_first >= 9u * 9000u); /* nine clocks of 100 kHz or so */
    TEST_ASSERT_TRUE(lv.clock_last - lv.clock_first <= 200000u);
    TEST_ASSERT_TRUE(sim_x0_sda_free(&lv.chip));
}

/* hal.h: clock stretching up to 10 ms is tolerated, what lasts longer is cut off and repeated. */
static void test_stretching(void)
{
    up();
    lv.stretch_ns = 9500000;
    lv_run(UP_MS + 500);
    TEST_ASSERT_EQUAL_UINT(0, lv.stretch_ns);
    TEST_ASSERT_EQUAL_INT(0, strncmp(counter("bus errors "), "0\r", 2));
    lv.stretch_ns = 30000000;
    lv_run(UP_MS + 1500);
    TEST_ASSERT_EQUAL_UINT(0, lv.stretch_ns);
    TEST_ASSERT_TRUE(strncmp(counter("bus errors "), "0\r", 2) != 0);
    TEST_ASSERT_TRUE(lv_both_fets());
    clean();
}

/* A missing acknowledge, a lost arbitration, a START at a wrong place: one transaction fails, the next one
 * works. */
static void test_errors_of_the_bus(void)
{
    static const emu_i2c_answer answers[] = {EMU_I2C_NACK, EMU_I2C_LOST, EMU_I2C_ERROR};
    static const char *const counters[] = {"no answers ", "bus errors ", "bus errors "};
    up();
    for (unsigned i = 0; i < 3u; i++) {
        int before = atoi(counter(counters[i]));
        lv.upset = 1;
        lv.upset_answer = answers[i];
        (void)emu_run_until(lv.e, emu_now(lv.e) + 600 * MS);
        TEST_ASSERT_EQUAL_UINT(0, lv.upset);
        TEST_ASSERT_EQUAL_INT(before + 1, atoi(counter(counters[i])));
        TEST_ASSERT_TRUE(lv_both_fets());
    }
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(lv.e)->count);
}

/* Nothing in one pass takes longer than 200 us: 9600 cycles of 48 MHz. */
static void test_no_pass_is_long(void)
{
    TEST_ASSERT_TRUE(lv_mark(MAP));
    up();
    emu_meter_clear(lv.e);
    lv_type("status\r");
    lv_type("cells\r");
    lv_type("counters\r");
    lv_type("faults\r");
    lv_type("help\r");
    lv_type("self-test\r");
    lv_run(8000);
    TEST_ASSERT_TRUE(emu_get_meter(lv.e)->longest_pass > 1000u); /* the mark is visited */
    TEST_ASSERT_TRUE(emu_get_meter(lv.e)->longest_pass <= 9600u);
}

int main(void)
{
    if (!lv_start(IMAGE)) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    lv_end();
    UNITY_BEGIN();
    RUN_TEST(test_power_on);
    RUN_TEST(test_console);
    RUN_TEST(test_without_crystal);
    RUN_TEST(test_crystal_fails_in_service);
    RUN_TEST(test_stack_guard);
    RUN_TEST(test_hard_fault);
    RUN_TEST(test_watchdog);
    RUN_TEST(test_fast_watchdog);
    RUN_TEST(test_reset_pin);
    RUN_TEST(test_damaged_image);
    RUN_TEST(test_stuck_bus);
    RUN_TEST(test_recovery_is_short);
    RUN_TEST(test_stretching);
    RUN_TEST(test_errors_of_the_bus);
    RUN_TEST(test_no_pass_is_long);
    return UNITY_END();
}
