/* SPDX-License-Identifier: Apache-2.0 */
/* The image of hv-f405 from reset to reset: watchdog, crash, damage, supply, contactor. The contactor's pin
 * is watched all the time. Numbers on CAN: docs/can.md; causes and kinds: hal.h. */
#include "bqhost/settings.h"
#include "hv_settings.h"
#include "hv_world.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

enum { POWER = 1, BROWN_OUT, PIN, SOFTWARE, WATCHDOG, CRASH };
enum { FLAG_CRASH = 1, FLAG_IMAGE_OK = 4 };
enum { STANDBY = 2, ON = 3, FAULT = 4 };
enum { BOOT = 9, FAULTS = 4 };
#define FAULT_CONTACTOR (1u << 14)
#define TIM2_CR1 0x40000000u
#define GUARD 0x20000060u /* behind the record of 80 bytes at the start of RAM */
#define VECTOR_USART2 (0x08000000u + 4u * (16u + 38u))

void setUp(void)
{
    TEST_ASSERT_TRUE(hv_start(IMAGE));
}

void tearDown(void)
{
    hv_end();
}

static void boot_frame(int cause, int flags)
{
    TEST_ASSERT_EQUAL_INT(cause, hv.last[BOOT].data[0]);
    TEST_ASSERT_EQUAL_INT(flags, hv.last[BOOT].data[1]);
}

static unsigned crash_kind(void)
{
    return hv.last[BOOT].data[2] | (unsigned)hv.last[BOOT].data[3] << 8;
}

static void says(const char *command, const char *words)
{
    hv_type(command);
    TEST_ASSERT_TRUE_MESSAGE(strstr(hv.said, words) != NULL, hv.said);
}

/* From here on the contactor is open and stays so. */
static void never_closes(void)
{
    TEST_ASSERT_FALSE(hv.contactor);
    hv.forbidden = true;
}

static void test_nobody_asked(void)
{
    hv.forbidden = true;
    hv_run(1500);
    TEST_ASSERT_EQUAL_INT(STANDBY, hv_state());
    boot_frame(POWER, FLAG_IMAGE_OK);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* The time base stops: nothing wakes the loop. The contactor opens with the reset, one second later. */
static void test_watchdog_bites(void)
{
    uint64_t hung;
    hv_up();
    hung = emu_now(hv.e);
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, TIM2_CR1, 4, 0));
    hv.request = false;
    hv_run(1300);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_TRUE(hv.opened_ns - hung <= 1050 * MS);
    never_closes();
    hv_run(1000);
    boot_frame(WATCHDOG, FLAG_IMAGE_OK);
    says("version\r", "watchdog");
    TEST_ASSERT_EQUAL_INT(STANDBY, hv_state());
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* Its oscillator is anything from 17 to 47 kHz (datasheet of the STM32F405). */
static void test_watchdog_with_its_slowest_oscillator(void)
{
    uint64_t hung;
    emu_set_lsi_hz(hv.e, 17000);
    hv_up();
    hung = emu_now(hv.e);
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, TIM2_CR1, 4, 0));
    hv_run(2100);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_TRUE(hv.opened_ns - hung <= 1950 * MS);
}

static void test_watchdog_with_its_fastest_oscillator(void)
{
    emu_set_lsi_hz(hv.e, 47000);
    hv_up();
    hv_run(3000);
    TEST_ASSERT_EQUAL_UINT(0, hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_EQUAL_UINT(1, hv.closed);
    hv_clean();
}

static void test_stack_guard(void)
{
    uint32_t damage = 0;
    uint64_t struck;
    hv_up();
    hv.request = false;
    hv.forbidden = true;
    struck = emu_now(hv.e);
    TEST_ASSERT_TRUE(emu_poke(hv.e, GUARD, &damage, 4));
    hv_run(1400);
    TEST_ASSERT_TRUE(hv.opened_ns - struck <= 25 * MS); /* the next pass */
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_SOFTWARE));
    boot_frame(CRASH, FLAG_IMAGE_OK | FLAG_CRASH);
    TEST_ASSERT_EQUAL_HEX32(0x100, crash_kind());
    says("version\r", "kind 256");
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* The vector of USART2 without its Thumb bit: the first byte on the console is a UsageFault that escalates.
 * It is repaired before the next start, or the checksum would not hold. */
static void test_hard_fault(void)
{
    uint32_t vector, even, pc;
    char text[16];
    hv_up();
    TEST_ASSERT_TRUE(emu_peek(hv.e, VECTOR_USART2, &vector, 4));
    even = vector & ~1u;
    TEST_ASSERT_TRUE(emu_poke(hv.e, VECTOR_USART2, &even, 4));
    emu_stop_on_reset(hv.e, true);
    hv.type = "x";
    TEST_ASSERT_EQUAL_INT(EMU_STOP_RESET, emu_run_until(hv.e, emu_now(hv.e) + 100 * MS));
    TEST_ASSERT_FALSE(hv.contactor);
    emu_stop_on_reset(hv.e, false);
    TEST_ASSERT_TRUE(emu_poke(hv.e, VECTOR_USART2, &vector, 4));
    hv.request = false;
    never_closes();
    hv_run(1200);
    boot_frame(CRASH, FLAG_IMAGE_OK | FLAG_CRASH);
    TEST_ASSERT_EQUAL_HEX32(3, crash_kind());
    memcpy(&pc, &hv.last[BOOT].data[4], 4);
    TEST_ASSERT_EQUAL_HEX32(even, pc);
    (void)snprintf(text, sizeof text, "%08lx", (unsigned long)even);
    hv_type("version\r");
    TEST_ASSERT_TRUE_MESSAGE(strstr(hv.said, "crash") != NULL, hv.said);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
}

/* The record is read once: the start after the next one knows nothing of it. */
static void test_crash_is_told_once(void)
{
    uint32_t damage = 0;
    TEST_ASSERT_TRUE((hv_run(150), true));
    TEST_ASSERT_TRUE(emu_poke(hv.e, GUARD, &damage, 4));
    hv_run(150);
    boot_frame(CRASH, FLAG_IMAGE_OK | FLAG_CRASH);
    emu_reset(hv.e, EMU_CAUSE_PIN);
    hv_run(150);
    boot_frame(PIN, FLAG_IMAGE_OK);
}

static void test_damaged_image(void)
{
    uint8_t byte;
    TEST_ASSERT_TRUE(emu_peek(hv.e, 0x0800001cu, &byte, 1)); /* vector 7, which nobody uses */
    byte ^= 0x80u;
    TEST_ASSERT_TRUE(emu_poke(hv.e, 0x0800001cu, &byte, 1));
    hv.request = true;
    never_closes();
    hv_run(2500);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    boot_frame(POWER, 0);
    TEST_ASSERT_TRUE(hv.count[0] >= 20);
    TEST_ASSERT_EQUAL_INT(FAULT, hv_state());
    says("status\r", "image");
    hv_clean();
}

static void refused(const char *what)
{
    hv.request = true;
    never_closes();
    hv_power();
    hv_run(1500);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    boot_frame(POWER, FLAG_IMAGE_OK);
    TEST_ASSERT_EQUAL_INT(FAULT, hv_state());
    TEST_ASSERT_TRUE(hv.count[0] >= 10);
    says("status\r", what);
    TEST_ASSERT_EQUAL_UINT(0, hv_resets(EMU_CAUSE_IWDG));
    hv_clean();
}

static void again(hv_settings *s)
{
    hv_end();
    TEST_ASSERT_TRUE(hv_prepare(IMAGE, HV_DEVICES));
    hv_settings_make(s, HV_DEVICES, 100);
}

/* One bit of the only record. */
static void test_damaged_settings(void)
{
    hv_settings s;
    uint8_t byte;
    again(&s);
    hv_settings_put(&s, 1, HV_SECTOR_0);
    TEST_ASSERT_TRUE(emu_peek(hv.e, HV_SECTOR_0 + 40u, &byte, 1));
    byte ^= 4u;
    TEST_ASSERT_TRUE(emu_poke(hv.e, HV_SECTOR_0 + 40u, &byte, 1));
    refused("settings");
}

/* An intact record with a contradiction in it is not used, and the older one neither. */
static void test_contradicting_settings(void)
{
    hv_settings s;
    again(&s);
    hv_settings_put(&s, 1, HV_SECTOR_0);
    s.app.pack.cell_ov_clear_mv = (uint16_t)(s.app.pack.cell_ov_mv + 100u);
    hv_settings_put(&s, 2, HV_SECTOR_1);
    refused("cell_ov_clear_mv");
}

/* The newest intact record counts: a stack of fifteen would not be found complete. */
static void test_newest_settings(void)
{
    hv_settings s;
    again(&s);
    hv_settings_make(&s, 15, 100);
    hv_settings_put(&s, 1, HV_SECTOR_0);
    hv_settings_make(&s, HV_DEVICES, 100);
    hv_settings_put(&s, 2, HV_SECTOR_1);
    hv_power();
    hv_up();
    hv_clean();
}

/* Nothing the firmware itself does before it touches the stack takes long: clocks, checksum, settings. */
static void test_time_to_the_first_frame(void)
{
    hv_run(12);
    TEST_ASSERT_EQUAL_UINT(1, hv.count[BOOT]);
}

/* The pack that was just powered is in the state standby: of the time 70 ms are the devices' own reset, 0.55
 * s the longest protection delay of the defaults, the rest the bus. */
static void test_time_to_standby(void)
{
    hv_run(1000);
    TEST_ASSERT_TRUE(hv.settled_ns != 0 && hv.settled_ns <= 910 * MS);
}

/* The tallest stack the board has room for, 164 kbit/s on its bus, protection delays of 0.1 s. */
static void test_time_to_standby_of_32_devices(void)
{
    hv_settings s;
    hv_end();
    TEST_ASSERT_TRUE(hv_prepare(IMAGE, 32));
    hv_settings_make(&s, 32, 100);
    hv_settings_put(&s, 1, HV_SECTOR_0);
    hv_power();
    hv_run(1000);
    TEST_ASSERT_TRUE(hv.settled_ns != 0 && hv.settled_ns <= 810 * MS);
    hv_clean();
}

static void test_reset_pin(void)
{
    hv_up();
    emu_reset(hv.e, EMU_CAUSE_PIN);
    TEST_ASSERT_FALSE(hv.contactor);
    hv.request = false;
    never_closes();
    hv_run(1200);
    boot_frame(PIN, FLAG_IMAGE_OK);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* A supply below the level of the voltage detector harms nothing; one below the level of the reset opens the
 * contactor. */
static void test_supply(void)
{
    hv_up();
    emu_set_supply_mv(hv.e, 2300);
    hv_run(400);
    TEST_ASSERT_EQUAL_INT(ON, hv_state());
    emu_set_supply_mv(hv.e, 1000);
    hv_run(50);
    TEST_ASSERT_FALSE(hv.contactor);
    hv.request = false;
    never_closes();
    emu_set_supply_mv(hv.e, 3300);
    hv_run(1200);
    TEST_ASSERT_TRUE(hv.last[BOOT].data[0] == POWER || hv.last[BOOT].data[0] == BROWN_OUT);
    TEST_ASSERT_EQUAL_INT(STANDBY, hv_state());
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

static uint32_t faults(void)
{
    uint32_t mask;
    memcpy(&mask, hv.last[FAULTS].data, 4);
    return mask;
}

/* docs/boards.md: 300 ms alone, open again 100 ms after the contactor, each up to one period later. */
static void test_closing_is_precharged(void)
{
    hv_up();
    TEST_ASSERT_TRUE(hv.precharged_ns >= 300 * MS && hv.precharged_ns <= 425 * MS);
    hv_run(300);
    TEST_ASSERT_FALSE(hv.precharge);
    TEST_ASSERT_TRUE(hv.contactor);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* The coil is driven and the contact does not follow: open again after 100 ms and 1.25 periods. */
static void test_contactor_that_does_not_close(void)
{
    uint64_t closed;
    hv_run(1000);
    hv.feedback = HV_STAYS_OPEN;
    hv.request = true;
    for (unsigned i = 0; i < 500 && !hv.contactor; i++) {
        hv_run(1);
    }
    closed = emu_now(hv.e);
    TEST_ASSERT_TRUE(hv.contactor);
    hv_run(300);
    TEST_ASSERT_FALSE(hv.contactor);
    TEST_ASSERT_TRUE(hv.opened_ns - closed <= 225 * MS);
    never_closes();
    hv_run(1000);
    TEST_ASSERT_EQUAL_INT(FAULT, hv_state());
    TEST_ASSERT_TRUE((faults() & FAULT_CONTACTOR) != 0u);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

static void test_contactor_that_is_welded(void)
{
    hv.feedback = HV_WELDED;
    hv.request = true;
    never_closes();
    hv_run(2000);
    TEST_ASSERT_EQUAL_INT(FAULT, hv_state());
    TEST_ASSERT_TRUE((faults() & FAULT_CONTACTOR) != 0u);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv_clean();
}

/* The line must be high for 20 ms; low is low at once. */
static void test_request_is_debounced(void)
{
    uint64_t low;
    hv_run(1000);
    never_closes();
    for (unsigned i = 0; i < 40; i++) {
        hv.request = true;
        hv_run(18);
        hv.request = false;
        hv_run(7);
    }
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    hv.forbidden = false;
    hv_up();
    low = emu_now(hv.e);
    hv.request = false;
    hv_run(100);
    TEST_ASSERT_FALSE(hv.contactor);
    TEST_ASSERT_TRUE(hv.opened_ns - low <= 25 * MS);
    hv_clean();
}

int main(void)
{
    if (!hv_start(IMAGE)) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    hv_end();
    UNITY_BEGIN();
    RUN_TEST(test_nobody_asked);
    RUN_TEST(test_watchdog_bites);
    RUN_TEST(test_watchdog_with_its_slowest_oscillator);
    RUN_TEST(test_watchdog_with_its_fastest_oscillator);
    RUN_TEST(test_stack_guard);
    RUN_TEST(test_hard_fault);
    RUN_TEST(test_crash_is_told_once);
    RUN_TEST(test_damaged_image);
    RUN_TEST(test_damaged_settings);
    RUN_TEST(test_contradicting_settings);
    RUN_TEST(test_newest_settings);
    RUN_TEST(test_time_to_the_first_frame);
    RUN_TEST(test_time_to_standby);
    RUN_TEST(test_time_to_standby_of_32_devices);
    RUN_TEST(test_reset_pin);
    RUN_TEST(test_supply);
    RUN_TEST(test_closing_is_precharged);
    RUN_TEST(test_contactor_that_does_not_close);
    RUN_TEST(test_contactor_that_is_welded);
    RUN_TEST(test_request_is_debounced);
    return UNITY_END();
}
