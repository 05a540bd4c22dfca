/* SPDX-License-Identifier: Apache-2.0 */
/* Deliberately broken images of lv-f072 (tests/firmware/images/broken): the run that the good image passes
 * catches each of them, by exactly the promise it breaks. */
#include "lv_world.h"
#include "unity.h"
#include "verdict.h"
#include <stdio.h>
#include <string.h>

#define PERIOD_NS (250 * MS)
#define KIND_GUARD 0x100u

void setUp(void)
{
}

void tearDown(void)
{
    lv_end();
}

static const char *path_of(const char *image)
{
    static char path[512];
    (void)snprintf(path, sizeof path, "%s/%s.bin", BROKEN, image);
    return image != NULL ? path : IMAGE;
}

static unsigned resets_by(emu_cause cause)
{
    return emu_get_meter(lv.e)->resets[cause];
}

static bool period_kept(unsigned beats)
{
    return beats + 1u >= V_MS * MS / PERIOD_NS && lv.longest_ns <= PERIOD_NS + PERIOD_NS / 4;
}

static unsigned run(const char *image)
{
    unsigned beats, broken = 0;
    uint64_t passes;
    TEST_ASSERT_TRUE_MESSAGE(lv_start(path_of(image)), path_of(image));
    lv.request = true;
    lv_run(V_FROM_MS);
    beats = lv.count[0];
    lv_watch_period();
    lv_run(V_FROM_MS + V_MS - V_LAST_MS);
    passes = emu_get_meter(lv.e)->passes;
    lv_run(V_FROM_MS + V_MS);
    broken |= period_kept(lv.count[0] - beats) ? 0u : V_PERIOD;
    broken |= resets_by(EMU_CAUSE_IWDG) + resets_by(EMU_CAUSE_SOFTWARE) == 0u ? 0u : V_RESET;
    broken |= lv_both_fets() ? 0u : V_ON;
    broken |= emu_get_misuse(lv.e)->count == 0u ? 0u : V_BOOK;
    broken |= sim_x0_misuse(&lv.chip)->count == 0u ? 0u : V_MONITOR;
    broken |= lv_both_fets() && emu_get_meter(lv.e)->passes == passes ? V_BITE : 0u;
    return broken;
}

static void expect(const char *image, unsigned broken)
{
    TEST_ASSERT_EQUAL_HEX32(broken, run(image));
}

static void test_the_good_image_keeps_every_promise(void)
{
    expect(NULL, 0);
}

/* The FETs are the monitor's: the bring-up after the bite turns them off. */
static void test_a_hanging_loop(void)
{
    expect("hang", V_PERIOD | V_RESET | V_ON);
    TEST_ASSERT_EQUAL_UINT(1, resets_by(EMU_CAUSE_IWDG));
}

static void test_a_hanging_loop_without_watchdog(void)
{
    expect("no_watchdog", V_PERIOD | V_BITE);
}

static void test_a_hanging_loop_whose_watchdog_is_fed_by_an_interrupt(void)
{
    expect("fed_by_irq", V_PERIOD | V_BITE);
}

/* The pack never gets as far as its outputs. */
static void test_a_watchdog_that_nobody_feeds(void)
{
    TEST_ASSERT_EQUAL_HEX32(V_RESET | V_ON, run("never_fed") & (V_RESET | V_ON));
    TEST_ASSERT_EQUAL_UINT(3, resets_by(EMU_CAUSE_IWDG)); /* one a second */
}

static void test_a_peripheral_without_its_clock(void)
{
    TEST_ASSERT_EQUAL_HEX32(V_PERIOD | V_BOOK, run("no_clock") & (V_PERIOD | V_BOOK));
    TEST_ASSERT_TRUE(emu_misuse_of(lv.e, "CAN", NULL) > 0u);
}

/* The first edge of ALERT is served for ever. */
static void test_a_handler_that_keeps_its_flag(void)
{
    TEST_ASSERT_TRUE(lv_start(path_of("flag_kept")));
    lv.request = true;
    for (unsigned ms = 100; ms <= 2500u; ms += 100u) {
        lv_run(ms);
        TEST_ASSERT_FALSE(sim_x0_chg(&lv.chip) || sim_x0_dsg(&lv.chip));
    }
    TEST_ASSERT_TRUE(resets_by(EMU_CAUSE_IWDG) >= 1u);
}

static void test_i2c_switched_on_before_its_timing(void)
{
    expect("i2c_order", V_BOOK);
    TEST_ASSERT_TRUE(emu_misuse_of(lv.e, "I2C1", "TIMINGR") > 0u);
}

static unsigned crash_kind(void)
{
    return lv.last[9].data[2] | (unsigned)lv.last[9].data[3] << 8;
}

static void test_a_stack_that_grows_into_its_guard(void)
{
    TEST_ASSERT_TRUE((run("guard_hit") & V_RESET) != 0u);
    TEST_ASSERT_EQUAL_UINT(1, resets_by(EMU_CAUSE_SOFTWARE));
    TEST_ASSERT_EQUAL_HEX32(KIND_GUARD, crash_kind());
}

/* Through the guard and out of RAM: a fault, with the stack pointer where no memory is. */
static void test_a_stack_that_grows_for_ever(void)
{
    TEST_ASSERT_TRUE((run("overflow") & V_RESET) != 0u);
    TEST_ASSERT_EQUAL_UINT(1, resets_by(EMU_CAUSE_SOFTWARE) + resets_by(EMU_CAUSE_IWDG));
}

int main(void)
{
    if (!lv_start(IMAGE) || (lv_end(), !lv_start(path_of("hang")))) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    lv_end();
    UNITY_BEGIN();
    RUN_TEST(test_the_good_image_keeps_every_promise);
    RUN_TEST(test_a_hanging_loop);
    RUN_TEST(test_a_hanging_loop_without_watchdog);
    RUN_TEST(test_a_hanging_loop_whose_watchdog_is_fed_by_an_interrupt);
    RUN_TEST(test_a_watchdog_that_nobody_feeds);
    RUN_TEST(test_a_peripheral_without_its_clock);
    RUN_TEST(test_a_handler_that_keeps_its_flag);
    RUN_TEST(test_i2c_switched_on_before_its_timing);
    RUN_TEST(test_a_stack_that_grows_into_its_guard);
    RUN_TEST(test_a_stack_that_grows_for_ever);
    return UNITY_END();
}
