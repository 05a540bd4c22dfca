/* SPDX-License-Identifier: Apache-2.0 */
/* Deliberately broken images of hv-f405 (tests/firmware/images/broken): the run that the good image passes
 * catches each of them, by exactly the promise it breaks. */
#include "hv_world.h"
#include "unity.h"
#include "verdict.h"
#include <stdio.h>
#include <string.h>

#define PERIOD_NS (100 * MS)
#define KIND_GUARD 0x100u

void setUp(void)
{
}

void tearDown(void)
{
    hv_end();
}

static const char *path_of(const char *image)
{
    static char path[512];
    (void)snprintf(path, sizeof path, "%s/%s.bin", BROKEN, image);
    return image != NULL ? path : IMAGE;
}

static unsigned resets(void)
{
    return hv_resets(EMU_CAUSE_IWDG) + hv_resets(EMU_CAUSE_SOFTWARE);
}

static bool period_kept(unsigned beats)
{
    return beats + 1u >= V_MS * MS / PERIOD_NS && hv.longest_ns <= PERIOD_NS + PERIOD_NS / 4;
}

static unsigned run(const char *image)
{
    unsigned beats, broken = 0;
    uint64_t passes;
    TEST_ASSERT_TRUE_MESSAGE(hv_start(path_of(image)), path_of(image));
    hv.request = true;
    hv_run(V_FROM_MS);
    beats = hv.count[0];
    hv_watch_period();
    hv_run(V_MS - V_LAST_MS);
    passes = emu_get_meter(hv.e)->passes;
    hv_run(V_LAST_MS);
    broken |= period_kept(hv.count[0] - beats) ? 0u : V_PERIOD;
    broken |= resets() == 0u ? 0u : V_RESET;
    broken |= hv.contactor ? 0u : V_ON;
    broken |= emu_get_misuse(hv.e)->count == 0u ? 0u : V_BOOK;
    broken |= sim_pl_misuse(&hv.stack)->count == 0u ? 0u : V_MONITOR;
    broken |= hv.contactor && emu_get_meter(hv.e)->passes == passes ? V_BITE : 0u;
    return broken;
}

static void expect(const char *image, unsigned broken)
{
    TEST_ASSERT_EQUAL_HEX32(broken, run(image));
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
}

static void test_the_good_image_keeps_every_promise(void)
{
    expect(NULL, 0);
}

/* Bitten, so open, at the latest one second after the loop stopped. The next life adopts the stack, which ran
 * on, and works until it hangs too: at the end of the run the outputs are on again, precharged and closed
 * once more. */
static void test_a_hanging_loop(void)
{
    expect("hang", V_PERIOD | V_RESET);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_TRUE(hv.opened_ns >= 1600 * MS && hv.opened_ns <= 2660 * MS);
    TEST_ASSERT_EQUAL_UINT(2, hv.closed);
    TEST_ASSERT_TRUE(hv.path_ns > hv.opened_ns && hv.path_ns - hv.opened_ns < 250 * MS);
    TEST_ASSERT_TRUE(hv.closed_ns > hv.path_ns && hv.closed_ns - hv.path_ns <= 425 * MS);
}

static void test_a_hanging_loop_without_watchdog(void)
{
    expect("no_watchdog", V_PERIOD | V_BITE);
}

static void test_a_hanging_loop_whose_watchdog_is_fed_by_an_interrupt(void)
{
    expect("fed_by_irq", V_PERIOD | V_BITE);
}

static void test_a_watchdog_that_nobody_feeds(void)
{
    TEST_ASSERT_TRUE((run("never_fed") & V_RESET) != 0u);
    TEST_ASSERT_EQUAL_UINT(3, hv_resets(EMU_CAUSE_IWDG)); /* one a second */
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
}

static void test_a_peripheral_without_its_clock(void)
{
    expect("no_clock", V_PERIOD | V_BOOK);
    TEST_ASSERT_TRUE(emu_misuse_of(hv.e, "CAN1", NULL) > 0u);
}

/* The first edge of DRDY is served for ever: the contactor never closes, the watchdog bites. */
static void test_a_handler_that_keeps_its_flag(void)
{
    TEST_ASSERT_TRUE(hv_start(path_of("flag_kept")));
    hv.request = true;
    hv_run(1300);
    TEST_ASSERT_EQUAL_UINT(0, hv.closed);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_TRUE(hv.count[0] < 6u);
}

static void test_spi_mode_0(void)
{
    expect("spi_mode_0", V_MONITOR);
    TEST_ASSERT_TRUE(sim_misuse_of(sim_pl_misuse(&hv.stack), "PL-SPI-01") > 0u);
}

static unsigned crash_kind(void)
{
    return hv.last[9].data[2] | (unsigned)hv.last[9].data[3] << 8;
}

/* Outputs off in the same pass, the record says why, and the next start works until it happens again. */
static void test_a_stack_that_grows_into_its_guard(void)
{
    expect("guard_hit", V_RESET);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_SOFTWARE));
    TEST_ASSERT_TRUE(hv.opened_ns <= 1710 * MS);
    TEST_ASSERT_EQUAL_HEX32(KIND_GUARD, crash_kind());
}

/* Through the guard and out of RAM: a fault, with the stack pointer where no memory is. */
static void test_a_stack_that_grows_for_ever(void)
{
    expect("overflow", V_RESET);
    TEST_ASSERT_EQUAL_UINT(1, hv_resets(EMU_CAUSE_SOFTWARE) + hv_resets(EMU_CAUSE_IWDG));
    TEST_ASSERT_TRUE(hv.opened_ns <= 2660 * MS); /* at the latest by the watchdog */
}

int main(void)
{
    if (!hv_start(IMAGE) || (hv_end(), !hv_start(path_of("hang")))) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    hv_end();
    UNITY_BEGIN();
    RUN_TEST(test_the_good_image_keeps_every_promise);
    RUN_TEST(test_a_hanging_loop);
    RUN_TEST(test_a_hanging_loop_without_watchdog);
    RUN_TEST(test_a_hanging_loop_whose_watchdog_is_fed_by_an_interrupt);
    RUN_TEST(test_a_watchdog_that_nobody_feeds);
    RUN_TEST(test_a_peripheral_without_its_clock);
    RUN_TEST(test_a_handler_that_keeps_its_flag);
    RUN_TEST(test_spi_mode_0);
    RUN_TEST(test_a_stack_that_grows_into_its_guard);
    RUN_TEST(test_a_stack_that_grows_for_ever);
    return UNITY_END();
}
