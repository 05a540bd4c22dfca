/* SPDX-License-Identifier: Apache-2.0 */
/* Flash of both families (RM0091 section 3, RM0090 section 3), and power lost while it works. */
#include "image.h"
#include "unity.h"
#include <string.h>

#define PAGE 0x0801f000u    /* of F0, 2 KB */
#define SECTOR3 0x0800c000u /* of F4, 16 KB */

static regs_world w;
static emu *e;

static void start(const emu_chip *chip)
{
    emu_world world = regs_world_of(&w);

    emu_destroy(e);
    e = emu_create(chip, &world);
    TEST_ASSERT_NOT_NULL(e);
}

void setUp(void)
{
    start(&emu_f072);
}

void tearDown(void)
{
    emu_destroy(e);
    e = NULL;
}

static void open_flash(uint32_t base)
{
    wr(e, base + 4, 0x45670123u);
    wr(e, base + 4, 0xcdef89abu);
}

static void test_f0_program(void)
{
    open_flash(F0_FLASH);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_FLASH + 0x10));
    wr(e, F0_FLASH + 0x10, 1);
    wr16(e, PAGE, 0x1234);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, F0_FLASH + 0x0c)); /* BSY */
    advance_us(e, 54);
    TEST_ASSERT_EQUAL_HEX32(0x20, rd(e, F0_FLASH + 0x0c)); /* EOP */
    TEST_ASSERT_EQUAL_HEX32(0x1234, rd16(e, PAGE));
    wr(e, F0_FLASH + 0x0c, 0x20);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_FLASH + 0x0c));
    wr16(e, PAGE, 0); /* the only second value that may be programmed */
    advance_us(e, 54);
    TEST_ASSERT_EQUAL_HEX32(0, rd16(e, PAGE));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    TEST_ASSERT_EQUAL(2, emu_flash_ops(e));
}

static void test_f0_refuses_what_is_not_erased(void)
{
    open_flash(F0_FLASH);
    wr(e, F0_FLASH + 0x10, 1);
    wr16(e, PAGE, 0x1234);
    advance_us(e, 60);
    wr16(e, PAGE, 0x1200);
    TEST_ASSERT_EQUAL_HEX32(4, rd(e, F0_FLASH + 0x0c) & 4u); /* PGERR */
    TEST_ASSERT_EQUAL_HEX32(0x1234, rd16(e, PAGE));
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "FLASH", "SR"));
}

static void test_f0_keys_and_lock(void)
{
    wr(e, F0_FLASH + 0x10, 1); /* locked: no effect */
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, F0_FLASH + 0x10));
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "FLASH", "CR"));
    TEST_ASSERT_FALSE(emu_bus_write(e, PAGE, 2, 0)); /* bus error */
    wr(e, F0_FLASH + 4, 0xcdef89abu);                /* wrong order */
    open_flash(F0_FLASH);
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, F0_FLASH + 0x10)); /* shut until the next reset */
    emu_reset(e, EMU_CAUSE_PIN);
    open_flash(F0_FLASH);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_FLASH + 0x10));
    wr(e, F0_FLASH + 0x10, 0x80);
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, F0_FLASH + 0x10));
}

static void test_f0_width_and_busy(void)
{
    open_flash(F0_FLASH);
    wr(e, F0_FLASH + 0x10, 1);
    TEST_ASSERT_FALSE(emu_bus_write(e, PAGE, 4, 0)); /* half-words only */
    TEST_ASSERT_EQUAL(1, misuse(e, "FLASH"));
    wr16(e, PAGE, 1);
    wr16(e, PAGE + 2, 2); /* BSY */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "FLASH", "SR"));
    wr(e, F0_FLASH + 0x10, 0); /* BSY */
    TEST_ASSERT_EQUAL(2, emu_misuse_of(e, "FLASH", "CR"));
}

static void test_f0_erase(void)
{
    uint32_t v = 0;

    emu_poke(e, PAGE, &v, 4);
    emu_poke(e, PAGE + 2044, &v, 4);
    emu_poke(e, PAGE + 2048, &v, 4);
    emu_poke(e, PAGE - 4, &v, 4);
    open_flash(F0_FLASH);
    wr(e, F0_FLASH + 0x10, 2);
    wr(e, F0_FLASH + 0x14, PAGE + 100);
    wr(e, F0_FLASH + 0x10, 0x42);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, F0_FLASH + 0x0c) & 1u);
    advance_us(e, 19000);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, F0_FLASH + 0x0c) & 1u); /* 20 to 40 ms */
    advance_us(e, 21000);
    TEST_ASSERT_EQUAL_HEX32(0x20, rd(e, F0_FLASH + 0x0c));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, PAGE));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, PAGE + 2044));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, PAGE + 2048));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, PAGE - 4));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, F0_FLASH + 0x10, 0x40); /* STRT of nothing */
    TEST_ASSERT_EQUAL(1, misuse(e, "FLASH"));
}

static void f4_open(uint32_t cr)
{
    start(&emu_f405);
    open_flash(F4_FLASH);
    wr(e, F4_FLASH + 0x10, cr);
}

static void test_f4_program(void)
{
    f4_open(0x201); /* PG, x32 */
    wr(e, SECTOR3, 0x12345678u);
    TEST_ASSERT_EQUAL_HEX32(0x10000, rd(e, F4_FLASH + 0x0c));
    advance_us(e, 17);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F4_FLASH + 0x0c)); /* EOP only with EOPIE */
    TEST_ASSERT_EQUAL_HEX32(0x12345678, rd(e, SECTOR3));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, SECTOR3, 0x02345678u); /* ones to zeroes: no rule of hardware against it */
    advance_us(e, 17);
    TEST_ASSERT_EQUAL_HEX32(0x02345678, rd(e, SECTOR3));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, SECTOR3, 0xffffffffu); /* zeroes stay */
    advance_us(e, 17);
    TEST_ASSERT_EQUAL_HEX32(0x02345678, rd(e, SECTOR3));
    TEST_ASSERT_EQUAL(1, misuse(e, "FLASH"));
}

static void test_f4_errors(void)
{
    f4_open(0x201);
    wr16(e, SECTOR3, 0); /* not PSIZE */
    TEST_ASSERT_EQUAL_HEX32(0x40, rd(e, F4_FLASH + 0x0c));
    f4_open(0x200);
    wr(e, SECTOR3, 0); /* no PG */
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, F4_FLASH + 0x0c));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, SECTOR3));
    f4_open(0x201);
    wr(e, SECTOR3 + 14, 0); /* over the end of a row of 128 bits */
    TEST_ASSERT_EQUAL_HEX32(0x20, rd(e, F4_FLASH + 0x0c));
    wr(e, SECTOR3, 0); /* an error flag is set */
    TEST_ASSERT_EQUAL(2, emu_misuse_of(e, "FLASH", "SR"));
    wr(e, F4_FLASH + 0x0c, 0x20);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F4_FLASH + 0x0c) & 0xf2u);
}

static void test_f4_parallelism_needs_its_supply(void)
{
    f4_open(0x201);
    emu_set_supply_mv(e, 2500);
    wr(e, SECTOR3, 0);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "FLASH", "CR"));
}

static void test_f4_erase(void)
{
    uint32_t v = 0;

    f4_open(0x200 | 2 | 3u << 3);
    emu_poke(e, SECTOR3, &v, 4);
    emu_poke(e, 0x0800fffcu, &v, 4);
    emu_poke(e, 0x08010000u, &v, 4);
    set(e, F4_FLASH + 0x10, 0x10000);
    advance_us(e, 249000);
    TEST_ASSERT_EQUAL_HEX32(0x10000, rd(e, F4_FLASH + 0x0c));
    advance_us(e, 2000);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F4_FLASH + 0x0c));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, SECTOR3));
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, 0x0800fffcu));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, 0x08010000u));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

/* Many losses of power: every state of a unit between old and new occurs, and none beyond. */
static void test_power_lost_while_a_half_word_is_programmed(void)
{
    bool seen_partial = false;

    for (uint32_t seed = 0; seed < 50; seed++) {
        uint32_t v;

        start(&emu_f072);
        open_flash(F0_FLASH);
        wr(e, F0_FLASH + 0x10, 1);
        emu_lose_power_at_flash_op(e, 2, seed, 1000000);
        wr16(e, PAGE, 0x1234);
        advance_us(e, 60);
        wr16(e, PAGE + 2, 0x0ff0);
        v = rd16(e, PAGE + 2);
        TEST_ASSERT_EQUAL_HEX32(0x1234, rd16(e, PAGE));
        TEST_ASSERT_EQUAL_HEX32(0x0ff0, v & 0x0ff0u); /* ones of the new value were ones before */
        seen_partial |= v != 0x0ff0u && v != 0xffffu;
        TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, F0_FLASH + 0x10)); /* it has started again */
        TEST_ASSERT_EQUAL_HEX32(1u << 27, rd(e, F0_RCC + 0x24) & 1u << 27);
        TEST_ASSERT_EQUAL(2, emu_flash_ops(e));
    }
    TEST_ASSERT_TRUE(seen_partial);
}

static void test_power_lost_while_a_page_is_erased(void)
{
    uint8_t zero[2048] = {0}, after[2048];
    unsigned erased = 0;

    emu_poke(e, PAGE, zero, sizeof zero);
    open_flash(F0_FLASH);
    wr(e, F0_FLASH + 0x10, 2);
    wr(e, F0_FLASH + 0x14, PAGE);
    emu_lose_power_at_flash_op(e, 1, 7, 0);
    wr(e, F0_FLASH + 0x10, 0x42);
    emu_peek(e, PAGE, after, sizeof after);
    for (unsigned i = 0; i < sizeof after; i++) {
        TEST_ASSERT_TRUE(after[i] == 0 || after[i] == 0xff);
        erased += after[i] == 0xff;
    }
    TEST_ASSERT_GREATER_THAN(500, erased);
    TEST_ASSERT_LESS_THAN(1500, erased);
}

static void test_a_reset_in_the_middle_leaves_it_half_done(void)
{
    uint8_t zero[2048] = {0}, after[2048], all[2048];

    memset(all, 0xff, sizeof all);
    emu_poke(e, PAGE, zero, sizeof zero);
    open_flash(F0_FLASH);
    wr(e, F0_FLASH + 0x10, 2);
    wr(e, F0_FLASH + 0x14, PAGE);
    wr(e, F0_FLASH + 0x10, 0x42);
    advance_us(e, 1000);
    emu_reset(e, EMU_CAUSE_PIN);
    emu_peek(e, PAGE, after, sizeof after);
    TEST_ASSERT_TRUE(memcmp(after, zero, sizeof zero) != 0 && memcmp(after, all, sizeof all) != 0);
}

/* ---- with the processor ---- */

#ifdef BQHOST_EMU_CPU
static void run_until_done(const emu_chip *chip, const uint16_t *code, size_t bytes, uint64_t ns)
{
    emu_destroy(e);
    e = image_start(chip, &w, code, bytes);
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, image_run(e, ns));
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->faults);
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_the_processor_stalls_while_flash_is_busy(void)
{
    run_until_done(&emu_f072, code_program_f0, sizeof code_program_f0, 200000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 6)); /* one look at BSY: the next instruction waited for the end */
    TEST_ASSERT_EQUAL_HEX32(0x5aa5, emu_register(e, 4));
    run_until_done(&emu_f405, code_program_f4, sizeof code_program_f4, 200000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 6));
    TEST_ASSERT_EQUAL_HEX32(0x12345678, emu_register(e, 4));
    TEST_ASSERT_EQUAL_HEX32(SECTOR3 + 4, emu_register(e, 2)); /* the store also counted its address up */
}

/* A word is programmed, 16 us = 256 cycles, while the processor waits in RAM; turns of its wait. */
static unsigned turns(uint64_t poll_ns)
{
    uint64_t began;

    e = (emu_destroy(e), START(&emu_f405, &w, code_to_ram));
    emu_set_flash_poll_ns(e, poll_ns);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_poke(e, 0x20000000u, code_poll, sizeof code_poll);
    (void)emu_run_until(e, emu_now(e) + 10000u);
    TEST_ASSERT_EQUAL(0, emu_register(e, 4));
    open_flash(F4_FLASH);
    wr(e, F4_FLASH + 0x10, 0x201);
    began = emu_now(e);
    wr(e, SECTOR3, 0x12345678u);
    (void)emu_run_until(e, began + 15800u);
    TEST_ASSERT_LESS_THAN(0x2000000eu, emu_register(e, 15)); /* not before the end */
    (void)emu_run_until(e, began + 17000u);
    TEST_ASSERT_EQUAL_HEX32(0x2000000eu, emu_register(e, 15));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    return emu_register(e, 4);
}

static void test_a_wait_in_ram_may_be_shortened_for_the_pc(void)
{
    TEST_ASSERT_INT_WITHIN(2, 256 / 4, turns(0));
    TEST_ASSERT_INT_WITHIN(2, 16000 / (1000 + 3 * 62), turns(1000));
    TEST_ASSERT_INT_WITHIN(1, 2, turns(1000000)); /* not beyond the end */
}

static void test_a_store_without_pg_is_a_fault_on_f0(void)
{
    static const uint16_t store[] = {0x4801, /* ldr r0, [pc, #4] */
                                     0x8000, /* strh r0, [r0] */
                                     0xe7fe, /* b . */
                                     0xbf00, 0xf000, 0x0801};

    e = (emu_destroy(e), START(&emu_f072, &w, store));
    image_run(e, 10000);
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->faults);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, image_word(e, PAGE));
}

static void test_power_lost_in_a_running_program(void)
{
    e = (emu_destroy(e), START(&emu_f072, &w, code_erase_f0));
    emu_reset(e, EMU_CAUSE_POWER);
    emu_lose_power_at_flash_op(e, 1, 3, 5000000);
    emu_stop_on_reset(e, true);
    TEST_ASSERT_EQUAL(EMU_STOP_RESET, emu_run_until(e, 1000000000u));
    TEST_ASSERT_GREATER_OR_EQUAL(5000000, emu_now(e));
    TEST_ASSERT_LESS_THAN(6000000, emu_now(e));
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, emu_run_until(e, 1000000000u)); /* the second time it ends */
    TEST_ASSERT_EQUAL_HEX32(0x20, emu_register(e, 7));
    TEST_ASSERT_EQUAL(2, emu_flash_ops(e));
}
#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_f0_program);
    RUN_TEST(test_f0_refuses_what_is_not_erased);
    RUN_TEST(test_f0_keys_and_lock);
    RUN_TEST(test_f0_width_and_busy);
    RUN_TEST(test_f0_erase);
    RUN_TEST(test_f4_program);
    RUN_TEST(test_f4_errors);
    RUN_TEST(test_f4_parallelism_needs_its_supply);
    RUN_TEST(test_f4_erase);
    RUN_TEST(test_power_lost_while_a_half_word_is_programmed);
    RUN_TEST(test_power_lost_while_a_page_is_erased);
    RUN_TEST(test_a_reset_in_the_middle_leaves_it_half_done);
#ifdef BQHOST_EMU_CPU
    RUN_TEST(test_the_processor_stalls_while_flash_is_busy);
    RUN_TEST(test_a_wait_in_ram_may_be_shortened_for_the_pc);
    RUN_TEST(test_a_store_without_pg_is_a_fault_on_f0);
    RUN_TEST(test_power_lost_in_a_running_program);
#endif
    return UNITY_END();
}
