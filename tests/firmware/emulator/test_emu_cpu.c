/* SPDX-License-Identifier: Apache-2.0 */
/* The processor: count of instructions, sleep, interrupts, priorities (PM0215, PM0214, ARMv6-M and ARMv7-M
 * manuals). */
#include "image.h"
#include "unity.h"
#include <stdio.h>

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

static void test_each_instruction_is_one_cycle(void)
{
    e = START(&emu_f072, &w, code_count);
    /* 8 MHz: 1000 cycles of 125 ns */
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, image_run(e, 125000));
    TEST_ASSERT_EQUAL(1000, emu_get_meter(e)->instructions);
    TEST_ASSERT_EQUAL(1000, emu_get_meter(e)->cycles);
    TEST_ASSERT_EQUAL(0, emu_register(e, 0));
    TEST_ASSERT_EQUAL_HEX32(CODE + 6, emu_register(e, 15));
    TEST_ASSERT_EQUAL(125000, emu_now(e));
}

/* One instruction before the loop; its two share the rest (movs, then subs and bne). */
static void test_executions_are_counted_at_each_address(void)
{
    e = START(&emu_f072, &w, code_count);
    TEST_ASSERT_EQUAL(0, emu_code_count(e, CODE));
    TEST_ASSERT_TRUE(emu_count_code(e));
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, image_run(e, 101u * 125u));
    TEST_ASSERT_EQUAL(1, emu_code_count(e, CODE));
    TEST_ASSERT_EQUAL(50, emu_code_count(e, CODE + 2));
    TEST_ASSERT_EQUAL(50, emu_code_count(e, CODE + 4));
    TEST_ASSERT_EQUAL(0, emu_code_count(e, CODE + 6));
    TEST_ASSERT_EQUAL(0, emu_code_count(e, 0x20000000u));
}

static void test_it_can_stop_at_every_instruction(void)
{
    e = START(&emu_f072, &w, code_count);
    emu_reset(e, EMU_CAUSE_POWER);
    for (unsigned n = 1; n <= 150; n++) {
        emu_run_until(e, n * 125u);
        TEST_ASSERT_EQUAL(n, emu_get_meter(e)->instructions);
        TEST_ASSERT_EQUAL(100 - n / 2, emu_register(e, 0));
    }
}

static void test_sleep_jumps_to_the_next_event(void)
{
    e = START(&emu_f072, &w, code_sleep);
    HANDLER(e, 15, handler_count);
    emu_reset(e, EMU_CAUSE_POWER);
    TEST_ASSERT_TRUE(emu_bus_write(e, 0xe000e014u, 4, 7999)); /* each ms at 8 MHz */
    TEST_ASSERT_TRUE(emu_bus_write(e, 0xe000e018u, 4, 0));
    TEST_ASSERT_TRUE(emu_bus_write(e, 0xe000e010u, 4, 7));
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, emu_run_until(e, 100ull * 1000000000u + 500000u));
    TEST_ASSERT_EQUAL(100000, emu_register(e, 5));
    TEST_ASSERT_EQUAL(100000, emu_register(e, 4));
    TEST_ASSERT_EQUAL(100001, emu_get_meter(e)->passes);
    /* entry 16, two of the handler, leaving 10, adds, b, wfi */
    TEST_ASSERT_EQUAL(31, emu_get_meter(e)->longest_awake);
    TEST_ASSERT_EQUAL(100ull * 8000000u + 4000u, emu_get_meter(e)->cycles + emu_get_meter(e)->cycles_asleep);
    TEST_ASSERT_EQUAL(100000, emu_get_meter(e)->exceptions);
}

static void test_sleep_without_any_event_lasts_till_the_end(void)
{
    e = START(&emu_f405, &w, code_sleep);
    TEST_ASSERT_EQUAL(EMU_STOP_TIME, image_run(e, 1000000000u));
    TEST_ASSERT_EQUAL(2, emu_get_meter(e)->instructions);
    TEST_ASSERT_EQUAL(1000000000u, emu_now(e));
}

static void test_what_happens_between_two_runs_wakes_at_once(void)
{
    e = START(&emu_f072, &w, code_sleep);
    HANDLER(e, 16, handler_count);
    image_run(e, 100000);
    wr(e, 0xe000e100u, 1);
    wr(e, 0xe000e200u, 1); /* pended from outside while it sleeps */
    emu_run_until(e, emu_now(e) + 19u * 125u);
    TEST_ASSERT_EQUAL(1, emu_register(e, 5));
}

static void test_under_primask_an_interrupt_wakes_but_is_not_taken(void)
{
    e = START(&emu_f072, &w, code_masked_sleep);
    HANDLER(e, 15, handler_count);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_bus_write(e, 0xe000e014u, 4, 7999);
    emu_bus_write(e, 0xe000e010u, 4, 7);
    emu_run_until(e, 500000);
    TEST_ASSERT_EQUAL(0, emu_register(e, 4));
    emu_run_until(e, 1500000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 5));    /* after CPSIE, once */
    TEST_ASSERT_EQUAL(0x12, emu_register(e, 4)); /* the second WFI did not sleep: still pending */
}

static void test_of_two_interrupts_the_lower_number_comes_first(void)
{
    e = START(&emu_f072, &w, code_two_irqs);
    HANDLER(e, 16, handler_a);
    HANDLER(e, 17, handler_b);
    image_run(e, 100000);
    TEST_ASSERT_EQUAL_HEX32(0x12, emu_register(e, 4));
    TEST_ASSERT_EQUAL(1, emu_register(e, 7));
    TEST_ASSERT_EQUAL(0, emu_register(e, 3)); /* restored from the frame */
    TEST_ASSERT_EQUAL_HEX32(STACK_TOP, emu_register(e, 13));
}

static void test_the_more_urgent_interrupt_comes_first(void)
{
    e = START(&emu_f072, &w, code_two_irqs);
    HANDLER(e, 16, handler_a);
    HANDLER(e, 17, handler_b);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_bus_write(e, 0xe000e400u, 4, 0x4080); /* 0: 2, 1: 1 */
    emu_run_until(e, 100000);
    TEST_ASSERT_EQUAL_HEX32(0x21, emu_register(e, 4));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_a_more_urgent_interrupt_preempts_a_handler(void)
{
    static const struct {
        uint32_t priorities, order;
    } cases[] = {{0x0080, 0x324}, {0x4080, 0x324}, {0x8080, 0x342}, {0xc080, 0x342}};

    for (unsigned i = 0; i < 4; i++) {
        e = START(&emu_f072, &w, code_two_irqs);
        HANDLER(e, 16, handler_nested);
        HANDLER(e, 17, handler_b);
        emu_reset(e, EMU_CAUSE_POWER);
        emu_bus_write(e, 0xe000e400u, 4, cases[i].priorities);
        emu_run_until(e, 4u * 125u);
        emu_bus_write(e, 0xe000e280u, 4, 2);
        emu_run_until(e, 6u * 125u); /* both pended by the program: withdraw the second */
        emu_bus_write(e, 0xe000e280u, 4, 2);
        emu_run_until(e, 100000);
        TEST_ASSERT_EQUAL_HEX32(cases[i].order, emu_register(e, 4));
        TEST_ASSERT_EQUAL_HEX32(STACK_TOP, emu_register(e, 13));
        emu_destroy(e);
        e = NULL;
    }
}

static void test_basepri_holds_back_what_is_not_more_urgent(void)
{
    e = START(&emu_f405, &w, code_basepri);
    HANDLER(e, 16, handler_a);
    HANDLER(e, 17, handler_b);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_bus_write(e, 0xe000e400u, 4, 0x3040);
    emu_bus_write(e, 0xe000e100u, 4, 3);
    emu_run_until(e, 8u * 125u / 2u);
    emu_run_until(e, 100000);
    TEST_ASSERT_EQUAL(2, emu_register(e, 4));
    TEST_ASSERT_EQUAL(2, emu_get_meter(e)->exceptions);
    /* the second was held back until BASEPRI was 0: some ten instructions */
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->longest_latency_irq);
    TEST_ASSERT_GREATER_THAN(5, emu_get_meter(e)->longest_latency);
}

static void test_stack_and_handler_are_measured(void)
{
    e = START(&emu_f072, &w, code_sleep);
    HANDLER(e, 15, handler_stack);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_bus_write(e, 0xe000e014u, 4, 7999);
    emu_bus_write(e, 0xe000e010u, 4, 7);
    emu_run_until(e, 1500000);
    TEST_ASSERT_EQUAL_HEX32(STACK_TOP - 32 - 8 - 40, emu_get_meter(e)->lowest_sp);
    TEST_ASSERT_EQUAL(5, emu_get_meter(e)->longest_isr);
    TEST_ASSERT_EQUAL(1, emu_register(e, 6));
}

static void test_stack_of_a_call(void)
{
    e = START(&emu_f072, &w, code_deep);
    image_run(e, 10000);
    TEST_ASSERT_EQUAL_HEX32(STACK_TOP - 8 - 64, emu_get_meter(e)->lowest_sp);
}

static void test_a_pass_is_measured_at_a_marked_place(void)
{
    e = START(&emu_f072, &w, code_sleep);
    HANDLER(e, 15, handler_stack);
    emu_mark(e, CODE + 4); /* behind WFI */
    emu_reset(e, EMU_CAUSE_POWER);
    emu_bus_write(e, 0xe000e014u, 4, 7999);
    emu_bus_write(e, 0xe000e010u, 4, 7);
    emu_run_until(e, 5500000);
    /* adds, b, wfi, then entry, five of the handler, leaving; time asleep does not count */
    TEST_ASSERT_EQUAL(3 + 16 + 5 + 10, emu_get_meter(e)->longest_pass);
}

static void test_cycle_counter(void)
{
    e = START(&emu_f405, &w, code_cyccnt);
    image_run(e, 10000);
    TEST_ASSERT_EQUAL(3, emu_register(e, 2) - emu_register(e, 1));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_svc(void)
{
    e = START(&emu_f072, &w, code_svc);
    HANDLER(e, 11, handler_count);
    image_run(e, 10000);
    TEST_ASSERT_EQUAL(1, emu_register(e, 5));
    TEST_ASSERT_EQUAL(2, emu_register(e, 4));
}

static void test_it_runs_conditionally(void)
{
    e = START(&emu_f405, &w, code_it);
    for (unsigned n = 1; n < 20; n++) { /* wherever it is interrupted */
        emu_reset(e, EMU_CAUSE_POWER);
        for (unsigned k = 0; k < 8; k++) {
            emu_run_until(e, emu_now(e) + n * 63u);
        }
        TEST_ASSERT_EQUAL(2, emu_register(e, 3));
    }
}

static void test_ram_survives_every_reset_but_power(void)
{
    uint32_t v = 0x12345678u;

    e = START(&emu_f072, &w, code_sleep);
    emu_reset(e, EMU_CAUSE_POWER);
    emu_poke(e, 0x20000010u, &v, 4);
    emu_reset(e, EMU_CAUSE_SOFTWARE);
    emu_reset(e, EMU_CAUSE_IWDG);
    emu_reset(e, EMU_CAUSE_PIN);
    TEST_ASSERT_EQUAL_HEX32(v, image_word(e, 0x20000010u));
    emu_reset(e, EMU_CAUSE_POWER);
    TEST_ASSERT_NOT_EQUAL(v, image_word(e, 0x20000010u));
}

int main(void)
{
#ifndef BQHOST_EMU_CPU
    puts("SKIP: built without Unicorn (libunicorn-dev)");
    return SKIP_TEST;
#endif
    UNITY_BEGIN();
    RUN_TEST(test_each_instruction_is_one_cycle);
    RUN_TEST(test_executions_are_counted_at_each_address);
    RUN_TEST(test_it_can_stop_at_every_instruction);
    RUN_TEST(test_sleep_jumps_to_the_next_event);
    RUN_TEST(test_sleep_without_any_event_lasts_till_the_end);
    RUN_TEST(test_what_happens_between_two_runs_wakes_at_once);
    RUN_TEST(test_under_primask_an_interrupt_wakes_but_is_not_taken);
    RUN_TEST(test_of_two_interrupts_the_lower_number_comes_first);
    RUN_TEST(test_the_more_urgent_interrupt_comes_first);
    RUN_TEST(test_a_more_urgent_interrupt_preempts_a_handler);
    RUN_TEST(test_basepri_holds_back_what_is_not_more_urgent);
    RUN_TEST(test_stack_and_handler_are_measured);
    RUN_TEST(test_stack_of_a_call);
    RUN_TEST(test_a_pass_is_measured_at_a_marked_place);
    RUN_TEST(test_cycle_counter);
    RUN_TEST(test_svc);
    RUN_TEST(test_it_runs_conditionally);
    RUN_TEST(test_ram_survives_every_reset_but_power);
    return UNITY_END();
}
