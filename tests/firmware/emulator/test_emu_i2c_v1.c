/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F4 from outside: the sequences of the reference manual, their times, and each mistake. */
#include "outside.h"

#define I2C 0x40005400u
#define CR1 (I2C + 0x00)
#define CR2 (I2C + 0x04)
#define DR (I2C + 0x10)
#define SR1 (I2C + 0x14)
#define SR2 (I2C + 0x18)
#define CCR (I2C + 0x1c)
#define TRISE (I2C + 0x20)

enum { PE = 1, START = 1 << 8, STOP = 1 << 9, ACK = 1 << 10, POS = 1 << 11, SWRST = 1 << 15 };
enum { SB = 1, ADDR = 2, BTF = 4, RXNE = 0x40, TXE = 0x80, BERR = 0x100, ARLO = 0x200, AF = 0x400 };

static void enabled(void)
{
    set_bits(0x40023840u, 1u << 21); /* RCC_APB1ENR */
    pin_function(1, 6, 4, true);
    pin_function(1, 7, 4, true);
    put(CR2, 16);
    put(CCR, 80); /* 16 MHz / 160 = 100 kHz */
    put(TRISE, 17);
    put(CR1, PE);
}

void setUp(void)
{
    outside_begin(&emu_f405);
    enabled();
}

void tearDown(void)
{
    outside_end();
}

static void start(uint32_t more)
{
    put(CR1, PE | START | more);
    (void)UNTIL(SR1, SB);
}

static void address(uint8_t byte)
{
    put(DR, byte);
    (void)UNTIL(SR1, ADDR);
}

static void clear_addr(void)
{
    (void)get(SR1);
    (void)get(SR2);
}

static void stop_and_wait(void)
{
    set_bits(CR1, STOP);
    for (int i = 0; (get(CR1) & STOP) != 0 && i < 1000; i++) {
        pass(1 * US);
    }
    TEST_ASSERT_EQUAL(0, get(CR1) & STOP);
}

static void test_a_write_of_two_bytes(void)
{
    uint64_t from = emu_now(chip);

    start(0);
    address(0x10);
    clear_addr();
    TEST_ASSERT_EQUAL_HEX8(TXE, get(SR1) & (TXE | BTF));
    TEST_ASSERT_EQUAL_HEX8(7, get(SR2)); /* MSL, BUSY, TRA */
    put(DR, 0x04);
    put(DR, 0x2a);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR1) & TXE);
    (void)UNTIL(SR1, BTF);
    /* START, address and two bytes: 28 bits of 10 us */
    TEST_ASSERT_INT_WITHIN(5000, 280000, (long long)(emu_now(chip) - from));
    stop_and_wait();
    TEST_ASSERT_EQUAL_STRING("S10 W04 W2a P ", out.log);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR2));
    NO_MISUSE();
}

static void test_fast_mode_counts_its_own_period(void)
{
    uint64_t took;

    put(CR1, 0);
    put(CCR, 0x8000u | 14u); /* 3 * 14 cycles of 62.5 ns = 2.625 us */
    put(TRISE, 5);
    put(CR1, PE);
    start(0);
    put(DR, 0x10);
    took = until(SR1, ADDR, 100, __LINE__);
    TEST_ASSERT_INT_WITHIN(200, 9 * 2625, (long long)took);
    clear_addr();
    stop_and_wait();
    NO_MISUSE();
}

static void test_one_byte_is_read_with_nack_and_stop_in_time(void)
{
    start(ACK);
    address(0x11);
    put(CR1, PE);
    clear_addr();
    put(CR1, PE | STOP);
    (void)UNTIL(SR1, RXNE);
    TEST_ASSERT_EQUAL_HEX8(0x40, get(DR));
    pass(20 * US);
    TEST_ASSERT_EQUAL_STRING("S11 R40n P ", out.log);
    NO_MISUSE();
}

static void test_two_bytes_are_read_with_pos(void)
{
    start(ACK | POS);
    address(0x11);
    clear_addr();
    put(CR1, PE | POS);
    (void)UNTIL(SR1, BTF);
    put(CR1, PE | POS | STOP);
    TEST_ASSERT_EQUAL_HEX8(0x40, get(DR));
    TEST_ASSERT_EQUAL_HEX8(0x41, get(DR));
    pass(20 * US);
    TEST_ASSERT_EQUAL_STRING("S11 R40a R41n P ", out.log);
    NO_MISUSE();
}

static void test_many_bytes_are_read_with_btf_at_the_end(void)
{
    start(ACK);
    address(0x11);
    clear_addr();
    for (int i = 0; i < 2; i++) {
        (void)UNTIL(SR1, RXNE);
        TEST_ASSERT_EQUAL_HEX8(0x40 + i, get(DR));
    }
    (void)UNTIL(SR1, BTF); /* the last but two waits in DR, the last but one behind it */
    put(CR1, PE);
    TEST_ASSERT_EQUAL_HEX8(0x42, get(DR));
    (void)UNTIL(SR1, BTF);
    put(CR1, PE | STOP);
    TEST_ASSERT_EQUAL_HEX8(0x43, get(DR));
    TEST_ASSERT_EQUAL_HEX8(0x44, get(DR));
    pass(20 * US);
    TEST_ASSERT_EQUAL_STRING("S11 R40a R41a R42a R43a R44n P ", out.log);
    NO_MISUSE();
}

static void test_the_clock_is_held_while_two_bytes_wait(void)
{
    start(ACK);
    address(0x11);
    clear_addr();
    pass(10 * MS);
    TEST_ASSERT_EQUAL_STRING("S11 R40a R41a ", out.log);
    TEST_ASSERT_EQUAL_HEX8(RXNE | BTF, get(SR1));
}

static void test_a_repeated_start_follows_a_write(void)
{
    start(0);
    address(0x10);
    clear_addr();
    put(DR, 0x0c);
    (void)UNTIL(SR1, BTF);
    start(ACK);
    address(0x11);
    put(CR1, PE);
    clear_addr();
    put(CR1, PE | STOP);
    (void)UNTIL(SR1, RXNE);
    (void)get(DR);
    pass(20 * US);
    TEST_ASSERT_EQUAL_STRING("S10 W0c S11 R40n P ", out.log);
    NO_MISUSE();
}

static void test_a_missing_slave_is_told_and_a_stop_ends_it(void)
{
    out.address_answer = EMU_I2C_NACK;
    put(CR2, 16 | 1 << 8);
    start(0);
    put(DR, 0x10);
    (void)UNTIL(SR1, AF);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR1) & ADDR);
    TEST_ASSERT_TRUE(irq_pending(32)); /* error */
    put(SR1, 0xffffu & ~(uint32_t)AF);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR1) & AF);
    stop_and_wait();
    TEST_ASSERT_EQUAL_STRING("S10 P ", out.log);
    NO_MISUSE();
}

static void test_a_refused_byte_is_told(void)
{
    out.refuse_at = 1;
    out.byte_answer = EMU_I2C_NACK;
    start(0);
    address(0x10);
    clear_addr();
    put(DR, 1);
    put(DR, 2);
    (void)UNTIL(SR1, AF);
    put(DR, 3);
    MISUSE("I2C1", "DR", "after NACK");
    stop_and_wait();
    TEST_ASSERT_EQUAL_STRING("S10 W01 W02 P ", out.log);
}

static void test_a_lost_arbitration_lets_go_of_the_bus(void)
{
    out.refuse_at = 0;
    out.byte_answer = EMU_I2C_LOST;
    start(0);
    address(0x10);
    clear_addr();
    put(DR, 1);
    (void)UNTIL(SR1, ARLO);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR2) & 1u);
    NO_MISUSE();
}

static void test_a_bus_error_is_told(void)
{
    out.refuse_at = 0;
    out.byte_answer = EMU_I2C_ERROR;
    start(0);
    address(0x10);
    clear_addr();
    put(DR, 1);
    (void)UNTIL(SR1, BERR);
    stop_and_wait();
    NO_MISUSE();
}

static void test_stuck_wires_keep_the_master_waiting(void)
{
    out.held = EMU_I2C_SDA_LOW;
    TEST_ASSERT_EQUAL_HEX8(2, get(SR2)); /* BUSY */
    put(CR1, PE | START);
    pass(30 * MS);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR1));
    TEST_ASSERT_EQUAL(START, get(CR1) & START);
    put(CR1, SWRST);
    put(CR1, 0);
    out.held = 0;
    TEST_ASSERT_EQUAL_HEX8(0, get(SR2));
    enabled();
    start(0);
    out.held = EMU_I2C_SCL_LOW;
    put(DR, 0x10);
    pass(30 * MS);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR1));
    out.held = 0;
    (void)UNTIL(SR1, ADDR);
    NO_MISUSE();
}

static void test_sda_held_low_against_a_one_loses_the_arbitration(void)
{
    start(0);
    out.held = EMU_I2C_SDA_LOW;
    put(DR, 0x10);
    (void)UNTIL(SR1, ARLO);
}

static void test_a_slave_stretches_the_clock(void)
{
    start(0);
    address(0x10);
    clear_addr();
    out.stretch_ns = 300 * US;
    put(DR, 1);
    put(DR, 2);
    TEST_ASSERT_INT_WITHIN(5000, 90000 + 300000 + 90000, (long long)UNTIL(SR1, BTF));
}

static void test_events_and_buffers_interrupt(void)
{
    put(CR2, 16 | 1 << 9);
    start(0);
    TEST_ASSERT_TRUE(irq_pending(31));
    address(0x10);
    clear_addr();
    irq_clear(31);
    TEST_ASSERT_FALSE(irq_pending(31)); /* TXE alone needs ITBUFEN */
    put(CR2, 16 | 1 << 9 | 1 << 10);
    TEST_ASSERT_TRUE(irq_pending(31));
}

/* ---- mistakes
 * ------------------------------------------------------------------------------------------------------- */

static void test_sr2_before_sr1_leaves_addr(void)
{
    start(0);
    put(DR, 0x10);
    pass(200 * US);
    (void)get(SR2);
    MISUSE("I2C1", "SR2", "SR2 read before SR1");
    TEST_ASSERT_EQUAL_HEX8(ADDR, get(SR1) & ADDR);
}

static void test_dr_before_sb(void)
{
    put(DR, 0x10);
    MISUSE("I2C1", "DR", "before SB");
    TEST_ASSERT_EQUAL_STRING("", out.log);
}

static void test_address_without_reading_sr1(void)
{
    put(CR1, PE | START);
    pass(50 * US);
    put(DR, 0x10);
    MISUSE("I2C1", "DR", "before SR1 was read");
}

static void test_dr_written_while_addr_or_full_or_receiving(void)
{
    start(0);
    address(0x10);
    put(DR, 1);
    MISUSE("I2C1", "DR", "while ADDR is set");
    clear_addr();
    put(DR, 1);
    put(DR, 2);
    put(DR, 3);
    MISUSE("I2C1", "DR", "TXE is not set");
    (void)UNTIL(SR1, BTF);
    start(ACK);
    address(0x11);
    clear_addr();
    put(DR, 4);
    MISUSE("I2C1", "DR", "while receiving");
}

static void test_empty_dr_read(void)
{
    (void)get(DR);
    MISUSE("I2C1", "DR", "RXNE is not set");
}

static void test_stop_behind_an_acknowledged_byte(void)
{
    start(ACK);
    address(0x11);
    clear_addr();
    put(CR1, PE | ACK | STOP); /* ACK was not cleared: N = 1 done wrongly */
    (void)UNTIL(SR1, RXNE);
    MISUSE("I2C1", "CR1", "was acknowledged");
}

static void test_nack_without_stop_lets_the_clock_run_on(void)
{
    start(ACK);
    address(0x11);
    put(CR1, PE);
    clear_addr();
    (void)UNTIL(SR1, RXNE);
    MISUSE("I2C1", "CR1", "the clock runs on");
    pass(1 * MS);
    TEST_ASSERT_EQUAL_STRING("S11 R40n R41n ", out.log);
}

static void test_two_bytes_without_pos_are_refused_too_early(void)
{
    start(ACK);
    address(0x11);
    clear_addr();
    put(CR1, PE); /* without POS the first byte is the one refused */
    (void)UNTIL(SR1, RXNE);
    MISUSE("I2C1", "CR1", "the clock runs on");
}

static void test_cr1_written_while_a_condition_waits(void)
{
    put(CR1, PE | START);
    put(CR1, PE | START | ACK);
    MISUSE("I2C1", "CR1", "START waits");
}

static void test_conditions_at_wrong_places(void)
{
    put(CR1, PE | STOP);
    MISUSE("I2C1", "CR1", "STOP while not master");
    start(0);
    put(CR1, PE | START);
    MISUSE("I2C1", "CR1", "START while SB");
    put(CR1, START);
    MISUSE("I2C1", "CR1", "while PE is not set");
}

static void test_pe_cleared_in_the_middle(void)
{
    start(0);
    put(DR, 0x10);
    put(CR1, 0);
    MISUSE("I2C1", "CR1", "before the end of the communication");
}

static void test_timing_written_while_enabled(void)
{
    put(CCR, 81);
    MISUSE("I2C1", "CCR", "while PE is set");
    put(TRISE, 18);
    MISUSE("I2C1", "TRISE", "while PE is set");
}

static void test_clock_settings_are_judged_at_start(void)
{
    put(CR1, 0);
    put(CR2, 8);
    put(CCR, 40);
    put(TRISE, 40);
    put(CR1, PE);
    start(0);
    MISUSE("I2C1", "CR2", "FREQ 8");
    MISUSE("I2C1", "CCR", "too fast");
    MISUSE("I2C1", "TRISE", "does not fit");
}

static void test_pins_must_be_open_drain_and_alternate(void)
{
    pin_function(1, 6, 4, false);
    pin_function(1, 7, 0, true);
    out.address_answer = EMU_I2C_ACK;
    start(0);
    MISUSE("I2C1", "CR1", "not open drain");
    put(DR, 0x10);
    (void)UNTIL(SR1, AF); /* nothing reaches the wires */
    TEST_ASSERT_EQUAL_STRING("", out.log);
    TEST_ASSERT_TRUE(emu_misuse_of(chip, "I2C1", NULL) >= 2);
}

static void test_what_is_not_modelled_is_told(void)
{
    put(CR1, PE | 1 << 12);
    MISUSE("I2C1", "CR1", "not modelled");
    put(CR1, PE | 1 << 2);
    MISUSE("I2C1", "CR1", "reserved");
}

static void test_registers_behind_a_software_reset(void)
{
    put(CR1, SWRST);
    put(CCR, 80);
    MISUSE("I2C1", "CR1", "SWRST");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_write_of_two_bytes);
    RUN_TEST(test_fast_mode_counts_its_own_period);
    RUN_TEST(test_one_byte_is_read_with_nack_and_stop_in_time);
    RUN_TEST(test_two_bytes_are_read_with_pos);
    RUN_TEST(test_many_bytes_are_read_with_btf_at_the_end);
    RUN_TEST(test_the_clock_is_held_while_two_bytes_wait);
    RUN_TEST(test_a_repeated_start_follows_a_write);
    RUN_TEST(test_a_missing_slave_is_told_and_a_stop_ends_it);
    RUN_TEST(test_a_refused_byte_is_told);
    RUN_TEST(test_a_lost_arbitration_lets_go_of_the_bus);
    RUN_TEST(test_a_bus_error_is_told);
    RUN_TEST(test_stuck_wires_keep_the_master_waiting);
    RUN_TEST(test_sda_held_low_against_a_one_loses_the_arbitration);
    RUN_TEST(test_a_slave_stretches_the_clock);
    RUN_TEST(test_events_and_buffers_interrupt);
    RUN_TEST(test_sr2_before_sr1_leaves_addr);
    RUN_TEST(test_dr_before_sb);
    RUN_TEST(test_address_without_reading_sr1);
    RUN_TEST(test_dr_written_while_addr_or_full_or_receiving);
    RUN_TEST(test_empty_dr_read);
    RUN_TEST(test_stop_behind_an_acknowledged_byte);
    RUN_TEST(test_nack_without_stop_lets_the_clock_run_on);
    RUN_TEST(test_two_bytes_without_pos_are_refused_too_early);
    RUN_TEST(test_cr1_written_while_a_condition_waits);
    RUN_TEST(test_conditions_at_wrong_places);
    RUN_TEST(test_pe_cleared_in_the_middle);
    RUN_TEST(test_timing_written_while_enabled);
    RUN_TEST(test_clock_settings_are_judged_at_start);
    RUN_TEST(test_pins_must_be_open_drain_and_alternate);
    RUN_TEST(test_what_is_not_modelled_is_told);
    RUN_TEST(test_registers_behind_a_software_reset);
    return UNITY_END();
}
