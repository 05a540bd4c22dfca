/* SPDX-License-Identifier: Apache-2.0 */
/* bxCAN of both families from outside: reception, modes, and each mistake. */
#include "can_bench.h"

void setUp(void)
{
    ready(&emu_f405, 0);
}

void tearDown(void)
{
    outside_end();
}

/* ---- reception
 * ----------------------------------------------------------------------------------------------------------------
 */

static void test_the_filter_lets_through_what_it_shall(const emu_chip *which)
{
    again(which, 0);
    put(C_IER, 2);
    TEST_ASSERT_TRUE(hear(0x07f, false)); /* acknowledged, not kept */
    TEST_ASSERT_TRUE(hear(0x090, false));
    TEST_ASSERT_TRUE(hear(0x080, true));
    TEST_ASSERT_EQUAL(0, get(C_RF0R));
    TEST_ASSERT_TRUE(hear(0x08f, false));
    TEST_ASSERT_EQUAL(1, get(C_RF0R));
    TEST_ASSERT_TRUE(irq_pending(f0 ? 30 : 20));
    TEST_ASSERT_EQUAL_HEX32(0x08fu << 21, get(C_RX(0, 0)));
    TEST_ASSERT_EQUAL_HEX32(2, get(C_RX(0, 4)) & 15u);
    TEST_ASSERT_EQUAL_HEX32(0xa58f, get(C_RX(0, 8)));
    put(C_RF0R, 1u << 5);
    TEST_ASSERT_EQUAL(0, get(C_RF0R));
    NO_MISUSE();
}

static void test_filter_f4(void)
{
    test_the_filter_lets_through_what_it_shall(&emu_f405);
}

static void test_filter_f0(void)
{
    test_the_filter_lets_through_what_it_shall(&emu_f072);
}

static void test_lists_and_16_bit_filters_and_the_other_fifo(void)
{
    set_bits(C_FMR, 1);
    put(C_FA1R, 0);
    put(C_FM1R, 3);  /* banks 0 and 1 are lists */
    put(C_FS1R, 1);  /* bank 1 in 16 bits */
    put(C_FFA1R, 2); /* bank 1 into FIFO 1 */
    put(C_BANK(0, 0), 0x123u << 21);
    put(C_BANK(0, 1), 0x1234567u << 3 | 4u);
    put(C_BANK(1, 0), 0x200u << 5 | 0x201u << 21);
    put(C_BANK(1, 1), 0x202u << 5 | 0x203u << 21);
    put(C_FA1R, 3);
    put(C_FMR, get(C_FMR) & ~1u);
    hear(0x123, false);
    hear(0x1234567, true);
    hear(0x124, false);
    TEST_ASSERT_EQUAL(2, get(C_RF0R) & 3u);
    TEST_ASSERT_EQUAL(0, get(C_RX(0, 4)) >> 8 & 0xffu);
    put(C_RF0R, 1u << 5);
    TEST_ASSERT_EQUAL(1, get(C_RX(0, 4)) >> 8 & 0xffu);
    hear(0x203, false);
    TEST_ASSERT_EQUAL(1, get(C_RF1R) & 3u);
    TEST_ASSERT_EQUAL(3, get(C_RX(1, 4)) >> 8 & 0xffu);
    NO_MISUSE();
}

static void test_an_inactive_filter_hears_nothing(void)
{
    put(C_FA1R, 0);
    TEST_ASSERT_TRUE(hear(0x080, false));
    TEST_ASSERT_EQUAL(0, get(C_RF0R));
    put(C_FA1R, 1);
    set_bits(C_FMR, 1);
    TEST_ASSERT_TRUE(hear(0x080, false));
    TEST_ASSERT_EQUAL(0, get(C_RF0R));
}

static void test_three_fit_and_the_fourth_overruns(void)
{
    for (unsigned i = 0; i < 4; i++) {
        hear(0x080 + i, false);
    }
    TEST_ASSERT_EQUAL_HEX8(3 | 8 | 16, get(C_RF0R));
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX32(i < 2 ? 0x080 + i : 0x083, get(C_RX(0, 0)) >> 21);
        put(C_RF0R, 1u << 5);
    }
    TEST_ASSERT_EQUAL_HEX8(16, get(C_RF0R));
    put(C_RF0R, 16);
    TEST_ASSERT_EQUAL_HEX8(0, get(C_RF0R));
}

static void test_a_locked_fifo_keeps_the_old_ones(void)
{
    again(&emu_f405, 1u << 3);
    for (unsigned i = 0; i < 4; i++) {
        hear(0x080 + i, false);
    }
    put(C_RF0R, 1u << 5);
    put(C_RF0R, 1u << 5);
    TEST_ASSERT_EQUAL_HEX32(0x082, get(C_RX(0, 0)) >> 21);
}

static void test_who_takes_no_part_gives_no_acknowledge(void)
{
    outside_end();
    clocked(&emu_f405);
    TEST_ASSERT_FALSE(hear(0x080, false)); /* asleep after reset */
    init_mode();
    TEST_ASSERT_FALSE(hear(0x080, false));
    filter();
    normal_mode(0);
    TEST_ASSERT_TRUE(hear(0x080, false));
}

static void test_sleep_and_waking_by_the_bus(void)
{
    again(&emu_f405, 1u << 5);
    put(C_IER, 1u << 16);
    put(C_MCR, 0x00010000u | 1u << 5 | 2u);
    (void)UNTIL(C_MSR, 2);
    TEST_ASSERT_FALSE(hear(0x080, false));
    TEST_ASSERT_EQUAL(8, get(C_MSR) & 8u);
    TEST_ASSERT_TRUE(irq_pending(22));
    TEST_ASSERT_EQUAL(0, get(C_MCR) & 2u);
    pass(50 * US);
    TEST_ASSERT_TRUE(hear(0x080, false));
    TEST_ASSERT_EQUAL(1, get(C_RF0R) & 3u);
}

static void test_initialisation_waits_for_the_frame_on_the_wire(void)
{
    send(0, 0x100, 8);
    set_bits(C_MCR, 1);
    TEST_ASSERT_EQUAL(0, get(C_MSR) & 1u);
    pass(300 * US);
    TEST_ASSERT_EQUAL(1, get(C_MSR) & 1u);
    TEST_ASSERT_EQUAL(1, out.sents);
}

/* ---- mistakes
 * -------------------------------------------------------------------------------------------------------------------
 */

static void test_registers_outside_of_initialisation(void)
{
    put(C_BTR, SEGMENTS | 3u);
    MISUSE(f0 ? "CAN" : "CAN1", "BTR", "outside of initialisation");
    TEST_ASSERT_EQUAL(500000, emu_can_bit_hz(chip, 1));
    put(C_MCR, 0x00010000u | 1u << 6);
    MISUSE("CAN1", "MCR", "outside of initialisation");
    put(C_FM1R, 1);
    MISUSE("CAN1", "FM1R", "FINIT");
    put(C_BANK(0, 0), 0);
    MISUSE("CAN1", "FiRx", "FINIT");
}

static void test_an_inactive_bank_may_be_written(void)
{
    put(C_BANK(1, 0), 5);
    NO_MISUSE();
    TEST_ASSERT_EQUAL(5, get(C_BANK(1, 0)));
}

static void test_init_without_leaving_sleep(void)
{
    outside_end();
    clocked(&emu_f405);
    put(C_MCR, 0x00010003u);
    MISUSE("CAN1", "MCR", "SLEEP not cleared");
    pass(1 * MS);
    TEST_ASSERT_EQUAL(0, get(C_MSR) & 1u);
}

static void test_bit_timing_is_judged(void)
{
    outside_end();
    clocked(&emu_f405);
    init_mode();
    put(C_BTR, 1u << 16 | 0u << 20 | 3u << 24 | 0u);
    normal_mode(0);
    MISUSE("CAN1", "BTR", "time quanta");
    MISUSE("CAN1", "BTR", "SJW");
    MISUSE("CAN1", "BTR", "1 Mbit/s");
}

static void test_mailboxes_and_fifos_at_the_wrong_time(void)
{
    send(0, 0x100, 8);
    put(C_TX(0, 8), 0);
    MISUSE("CAN1", "TIxR", "not empty");
    (void)get(C_RX(0, 0));
    MISUSE("CAN1", "RI0R", "empty FIFO");
    put(C_RF0R, 1u << 5);
    MISUSE("CAN1", "RF0R", "empty FIFO");
    send(1, 0x100, 9);
    MISUSE("CAN1", "TDTxR", "DLC");
}

static void test_pins_must_be_connected(void)
{
    outside_end();
    clocked(&emu_f405);
    pin_function(1, 9, 0, false);
    init_mode();
    normal_mode(0);
    TEST_ASSERT_TRUE(emu_misuse_of(chip, "CAN1", NULL) >= 1);
    send(0, 0x100, 1);
    pass(1 * MS);
    TEST_ASSERT_EQUAL(0, out.sents);
}

static void test_reserved_bits_and_modes_that_are_not_modelled(void)
{
    put(C_IER, 0x80);
    MISUSE("CAN1", "IER", "reserved");
    put(C_FMR, 1);
    MISUSE("CAN1", "FMR", "reset value");
    put(C_MCR, 0x00010000u | 1u << 7);
    MISUSE("CAN1", "MCR", "not modelled");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_filter_f4);
    RUN_TEST(test_filter_f0);
    RUN_TEST(test_lists_and_16_bit_filters_and_the_other_fifo);
    RUN_TEST(test_an_inactive_filter_hears_nothing);
    RUN_TEST(test_three_fit_and_the_fourth_overruns);
    RUN_TEST(test_a_locked_fifo_keeps_the_old_ones);
    RUN_TEST(test_who_takes_no_part_gives_no_acknowledge);
    RUN_TEST(test_sleep_and_waking_by_the_bus);
    RUN_TEST(test_initialisation_waits_for_the_frame_on_the_wire);
    RUN_TEST(test_registers_outside_of_initialisation);
    RUN_TEST(test_an_inactive_bank_may_be_written);
    RUN_TEST(test_init_without_leaving_sleep);
    RUN_TEST(test_bit_timing_is_judged);
    RUN_TEST(test_mailboxes_and_fifos_at_the_wrong_time);
    RUN_TEST(test_pins_must_be_connected);
    RUN_TEST(test_reserved_bits_and_modes_that_are_not_modelled);
    return UNITY_END();
}
