/* SPDX-License-Identifier: Apache-2.0 */
/* Settings in the flash of an STM32F072 or an STM32F405, written by the driver of the flash and the library's
 * settings together, with the supply failing in every single operation. The images f072-nvm and f405-nvm save
 * once per start and tell what they found. The F405 waits for the erasure of a sector, 250 ms, in RAM: here
 * it looks once in 10 us. */
#include "emu.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

#define MS 1000000ull
#define SAVE_MS (ERASE_MS + 100u) /* a start and a save */
#define BUS ((uint8_t)-20)        /* BQ_E_BUS */
#define POLL_NS 10000u

#define IMAGE_OF(wrong) BROKEN "_" wrong ".bin"

static emu *e;
static emu_can_frame loaded, saved; /* newest frames 0x200 and 0x201 */
static unsigned loads, saves;

static emu_can_result can_out(void *ctx, unsigned bus, const emu_can_frame *frame)
{
    (void)ctx;
    (void)bus;
    if (frame->id == 0x200u) {
        loaded = *frame;
        loads++;
    } else if (frame->id == 0x201u) {
        saved = *frame;
        saves++;
    }
    return EMU_CAN_ACKED;
}

static bool begin_with(const char *image)
{
    const emu_world world = {.can_out = can_out};
    loads = saves = 0;
    e = emu_create(&CHIP, &world);
    if (e == NULL || !emu_cpu_open(e) || !emu_load_file(e, image)) {
        return false;
    }
    emu_set_flash_poll_ns(e, POLL_NS);
    emu_reset(e, EMU_CAUSE_POWER);
    return true;
}

static bool begin(void)
{
    return begin_with(IMAGE);
}

void setUp(void)
{
    TEST_ASSERT_TRUE(begin());
}

void tearDown(void)
{
    emu_destroy(e);
}

static void run(unsigned ms)
{
    (void)emu_run_until(e, emu_now(e) + ms * MS);
}

static void restart(void)
{
    emu_reset(e, EMU_CAUSE_PIN);
    run(SAVE_MS);
}

static void expect_loaded(int status, int value)
{
    TEST_ASSERT_EQUAL_INT((uint8_t)status, loaded.data[0]);
    TEST_ASSERT_EQUAL_INT(value, loaded.data[1]);
    TEST_ASSERT_EQUAL_INT(1, loaded.data[2]);
}

/* Nothing that RM0091 3.2.2 or RM0090 3.6 forbids happens on the way. */
static void clean(void)
{
    sim_misuse *book = emu_get_misuse(e);
    TEST_ASSERT_EQUAL_STRING("", book->count != 0 ? book->entry[0].text : "");
}

static void test_one_save_after_another(void)
{
    run(SAVE_MS);
    expect_loaded(-31, 0);
    TEST_ASSERT_EQUAL_INT(0, saved.data[0]);
    for (int value = 1; value <= 5; value++) {
        restart();
        expect_loaded(0, value);
        TEST_ASSERT_EQUAL_INT(0, saved.data[0]);
        TEST_ASSERT_EQUAL_INT(value + 1, saved.data[1]);
    }
    clean();
}

/* Whatever operation the supply fails in, afterwards the old or the new value is there, whole; and the next
 * save works. */
static void test_power_lost_in_each_operation(void)
{
    unsigned before, operations, lost = 0;
    run(SAVE_MS);
    before = emu_flash_ops(e);
    restart();
    operations = emu_flash_ops(e) - before;
    TEST_ASSERT_TRUE(operations >= OPERATIONS); /* one erasure and a record of units */
    for (unsigned n = 1; n <= ROUNDS * operations; n++) {
        int value = saved.data[1];
        emu_lose_power_at_flash_op(e, (n - 1u) / ROUNDS + 1u, n, 20 * MS);
        emu_reset(e, EMU_CAUSE_PIN);
        run(2u * SAVE_MS);
        TEST_ASSERT_EQUAL_INT(0, loaded.data[0]);
        TEST_ASSERT_TRUE(loaded.data[1] == (value & 255) || loaded.data[1] == ((value + 1) & 255));
        TEST_ASSERT_EQUAL_INT(1, loaded.data[2]);
        TEST_ASSERT_EQUAL_INT(0, saved.data[0]);
        TEST_ASSERT_EQUAL_INT((loaded.data[1] + 1) & 255, saved.data[1]);
        lost += loaded.data[1] == (value & 255);
    }
    TEST_ASSERT_TRUE(2u * lost >= ROUNDS * operations); /* the fault did strike before the commit */
}

/* Below the level of the voltage detector (2.9 V at most) nothing is begun: the save fails, the old record
 * stays. */
static void test_low_supply(void)
{
    unsigned before;
    run(SAVE_MS);
    restart();
    expect_loaded(0, 1);
    before = emu_flash_ops(e);
    emu_set_supply_mv(e, 2500);
    restart();
    expect_loaded(0, 2);
    TEST_ASSERT_EQUAL_INT(BUS, saved.data[0]);
    TEST_ASSERT_EQUAL_UINT(before, emu_flash_ops(e));
    emu_set_supply_mv(e, 3300);
    restart();
    expect_loaded(0, 2);
    TEST_ASSERT_EQUAL_INT(0, saved.data[0]);
    clean();
}

/* ---- images that break a rule of the flash ------------------------------------------------------------- */

static void broken(const char *image)
{
    tearDown();
    TEST_ASSERT_TRUE_MESSAGE(begin_with(image), image);
    run(SAVE_MS);
    for (unsigned i = 0; i < 2u; i++) { /* the third save comes into a sector that is used */
        restart();
    }
    TEST_ASSERT_TRUE(saved.data[0] != 0u);
    TEST_ASSERT_TRUE(emu_misuse_of(e, "FLASH", NULL) > 0u);
}

static void test_program_without_erase(void)
{
    broken(IMAGE_OF("no_erase"));
}

static void test_program_while_locked(void)
{
    broken(IMAGE_OF("locked"));
}

#ifdef F4
static void test_program_with_the_wrong_width(void)
{
    broken(IMAGE_OF("psize"));
    TEST_ASSERT_TRUE(emu_misuse_of(e, "FLASH", "SR") > 0u);
}

/* Words need 2.7 V: below, the result is a matter of luck, and no flag says so. */
static void test_erase_and_program_below_their_voltage(void)
{
    unsigned before;
    tearDown();
    TEST_ASSERT_TRUE(begin_with(IMAGE_OF("voltage")));
    run(SAVE_MS);
    restart();
    clean(); /* nothing to say as long as the supply is whole */
    before = emu_flash_ops(e);
    emu_set_supply_mv(e, 2500);
    restart();
    TEST_ASSERT_TRUE(emu_flash_ops(e) - before >= OPERATIONS);
    TEST_ASSERT_EQUAL_UINT(emu_flash_ops(e) - before, emu_misuse_of(e, "FLASH", "CR"));
}
#endif

int main(void)
{
    if (!begin()) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    emu_destroy(e);
    UNITY_BEGIN();
    RUN_TEST(test_one_save_after_another);
    RUN_TEST(test_power_lost_in_each_operation);
    RUN_TEST(test_low_supply);
    RUN_TEST(test_program_without_erase);
    RUN_TEST(test_program_while_locked);
#ifdef F4
    RUN_TEST(test_program_with_the_wrong_width);
    RUN_TEST(test_erase_and_program_below_their_voltage);
#endif
    return UNITY_END();
}
