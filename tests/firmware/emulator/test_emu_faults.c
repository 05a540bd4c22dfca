/* SPDX-License-Identifier: Apache-2.0 */
/* Faults reach the handler of the image, with the frame that hardware stores (PM0215, PM0214). */
#include "image.h"
#include "unity.h"
#include <stdio.h>

#define CFSR 0xe000ed28u
#define HFSR 0xe000ed2cu
#define BFAR 0xe000ed38u

static regs_world w;
static emu *e;

void setUp(void)
{
}

void tearDown(void)
{
    emu_destroy(e);
    e = NULL;
}

/* The image runs until its HardFault handler has stored the frame and asked for a reset. */
static void crash(const emu_chip *chip, const uint16_t *code, size_t bytes)
{
    emu_destroy(e);
    e = image_start(chip, &w, code, bytes);
    HANDLER(e, 3, handler_save);
    emu_stop_on_reset(e, true);
    TEST_ASSERT_EQUAL(EMU_STOP_RESET, image_run(e, 1000000));
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->resets[EMU_CAUSE_SOFTWARE]);
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->faults);
}

#define CRASH(chip, code) crash((chip), (code), sizeof(code))

static uint32_t crash_pc(void)
{
    return image_word(e, 0x20000100u);
}

static uint32_t status_at_fault(const emu_chip *chip, const uint16_t *code, size_t bytes, uint32_t reg)
{
    emu_destroy(e);
    e = image_start(chip, &w, code, bytes); /* handlers stand still */
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, image_run(e, 100000));
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->faults);
    TEST_ASSERT_EQUAL_HEX32(HALT, emu_register(e, 15));
    return rd(e, reg);
}

#define STATUS(code, reg) status_at_fault(&emu_f405, (code), sizeof(code), (reg))

static void test_load_from_nowhere(void)
{
    CRASH(&emu_f072, code_bad_read);
    TEST_ASSERT_EQUAL_HEX32(CODE + 6, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(7, image_word(e, 0x20000108u));                      /* r0 at the fault */
    TEST_ASSERT_EQUAL_HEX32(1u << 24, image_word(e, 0x20000104u) & 0x010001ffu); /* Thumb, from thread */
    CRASH(&emu_f405, code_bad_read);
    TEST_ASSERT_EQUAL_HEX32(CODE + 6, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(0x8200, STATUS(code_bad_read, CFSR)); /* PRECISERR, BFARVALID */
    TEST_ASSERT_EQUAL_HEX32(0x60000000, rd(e, BFAR));
    TEST_ASSERT_EQUAL_HEX32(0x40000000, rd(e, HFSR)); /* FORCED */
}

static void test_store_to_nowhere(void)
{
    CRASH(&emu_f072, code_bad_write);
    TEST_ASSERT_EQUAL_HEX32(CODE + 4, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(0x8200, STATUS(code_bad_write, CFSR));
}

static void test_unaligned_access(void)
{
    CRASH(&emu_f072, code_unaligned);
    TEST_ASSERT_EQUAL_HEX32(CODE + 4, crash_pc());
    CRASH(&emu_f072, code_unaligned_store);
    TEST_ASSERT_EQUAL_HEX32(0xa5a5a5a5, image_word(e, 0x20000200u)); /* nothing was stored */
    TEST_ASSERT_EQUAL_HEX32(CODE + 6, crash_pc());
    e = (emu_destroy(e), START(&emu_f405, &w, code_unaligned)); /* allowed on Cortex-M4 */
    image_run(e, 10000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 2));
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->faults);
    CRASH(&emu_f405, code_unaligned_pair); /* but not of several words */
    TEST_ASSERT_EQUAL_HEX32(CODE + 4, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(1u << 24, STATUS(code_unaligned_pair, CFSR));
}

static void test_unaligned_trap_of_the_m4(void)
{
    e = START(&emu_f405, &w, code_unaligned);
    HANDLER(e, 3, handler_save);
    emu_stop_on_reset(e, true);
    emu_reset(e, EMU_CAUSE_POWER);
    wr(e, 0xe000ed14u, 0x208); /* UNALIGN_TRP */
    TEST_ASSERT_EQUAL(EMU_STOP_RESET, emu_run_until(e, emu_now(e) + 100000));
}

static void test_undefined_instructions(void)
{
    CRASH(&emu_f072, code_udf);
    TEST_ASSERT_EQUAL_HEX32(CODE + 2, crash_pc());
    CRASH(&emu_f072, code_movw); /* ARMv6-M has none */
    TEST_ASSERT_EQUAL_HEX32(CODE + 2, crash_pc());
    CRASH(&emu_f072, code_it);
    TEST_ASSERT_EQUAL_HEX32(CODE + 4, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(1u << 16, STATUS(code_udf, CFSR));
    e = (emu_destroy(e), START(&emu_f405, &w, code_movw));
    image_run(e, 10000);
    TEST_ASSERT_EQUAL_HEX32(0x1234, emu_register(e, 0));
}

static void test_fpu_needs_its_coprocessor_access(void)
{
    TEST_ASSERT_EQUAL_HEX32(1u << 19, STATUS(code_fpu, CFSR)); /* NOCP */
    e = (emu_destroy(e), START(&emu_f405, &w, code_fpu));
    emu_reset(e, EMU_CAUSE_POWER);
    wr(e, 0xe000ed88u, 0xfu << 20);
    emu_run_until(e, emu_now(e) + 10000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 2));
}

static void test_jumps(void)
{
    CRASH(&emu_f072, code_even);
    TEST_ASSERT_EQUAL_HEX32(1u << 17, STATUS(code_even, CFSR)); /* INVSTATE */
    CRASH(&emu_f072, code_jump_nowhere);
    TEST_ASSERT_EQUAL_HEX32(0x60000000, crash_pc());
    TEST_ASSERT_EQUAL_HEX32(1u << 8, STATUS(code_jump_nowhere, CFSR)); /* IBUSERR */
}

static void test_a_breakpoint_without_debugger_is_a_hardfault(void)
{
    CRASH(&emu_f072, code_bkpt);
    TEST_ASSERT_EQUAL_HEX32(1u << 31, STATUS(code_bkpt, HFSR)); /* DEBUGEVT */
}

static void test_an_enabled_fault_has_its_own_handler(void)
{
    e = START(&emu_f405, &w, code_bad_read);
    HANDLER(e, 5, handler_save);
    emu_stop_on_reset(e, true);
    emu_reset(e, EMU_CAUSE_POWER);
    wr(e, 0xe000ed24u, 1u << 17); /* BUSFAULTENA */
    TEST_ASSERT_EQUAL(EMU_STOP_RESET, emu_run_until(e, emu_now(e) + 100000));
    TEST_ASSERT_EQUAL_HEX32(CODE + 6, crash_pc());
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->faults); /* no HardFault */
}

static void test_a_fault_in_the_fault_handler_locks_up_until_the_watchdog(void)
{
    e = START(&emu_f072, &w, code_bad_read);
    HANDLER(e, 3, handler_fault_again);
    emu_reset(e, EMU_CAUSE_POWER);
    TEST_ASSERT_EQUAL(EMU_STOP_LOCKUP, emu_run_until(e, emu_now(e) + 1000000));
    wr(e, IWDG_BASE, 0xcccc); /* as if it ran: 4 * 4096 / 40 kHz = 409.6 ms */
    emu_stop_on_reset(e, true);
    TEST_ASSERT_EQUAL(EMU_STOP_RESET, emu_run_until(e, emu_now(e) + 500000000u));
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->resets[EMU_CAUSE_IWDG]);
    TEST_ASSERT_EQUAL(409600000u + 1000000u, emu_now(e));
}

static void test_a_stack_that_runs_out_of_memory(void)
{
    e = START(&emu_f072, &w, code_overflow);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_run_until(e, emu_now(e) + 10000000);
    TEST_ASSERT_GREATER_OR_EQUAL(1, emu_get_meter(e)->faults);
    TEST_ASSERT_LESS_OR_EQUAL(0x20000000, emu_get_meter(e)->lowest_sp);
}

static void test_an_erased_flash_locks_up(void)
{
    emu_world world = regs_world_of(&w);

    e = emu_create(&emu_f072, &world);
    TEST_ASSERT_TRUE(emu_cpu_open(e));
    TEST_ASSERT_EQUAL(EMU_STOP_LOCKUP, emu_run_until(e, 1000000));
}

static void test_a_null_pointer_is_noticed(void)
{
    e = START(&emu_f072, &w, code_null);
    image_run(e, 10000);
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->faults); /* flash is mirrored at 0 */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "MEM", "null"));
    TEST_ASSERT_EQUAL_HEX32(CODE + 2, emu_misuse_pc(e, 0));
}

int main(void)
{
#ifndef BQHOST_EMU_CPU
    puts("SKIP: built without Unicorn (libunicorn-dev)");
    return SKIP_TEST;
#endif
    UNITY_BEGIN();
    RUN_TEST(test_load_from_nowhere);
    RUN_TEST(test_store_to_nowhere);
    RUN_TEST(test_unaligned_access);
    RUN_TEST(test_unaligned_trap_of_the_m4);
    RUN_TEST(test_undefined_instructions);
    RUN_TEST(test_fpu_needs_its_coprocessor_access);
    RUN_TEST(test_jumps);
    RUN_TEST(test_a_breakpoint_without_debugger_is_a_hardfault);
    RUN_TEST(test_an_enabled_fault_has_its_own_handler);
    RUN_TEST(test_a_fault_in_the_fault_handler_locks_up_until_the_watchdog);
    RUN_TEST(test_a_stack_that_runs_out_of_memory);
    RUN_TEST(test_an_erased_flash_locks_up);
    RUN_TEST(test_a_null_pointer_is_noticed);
    return UNITY_END();
}
