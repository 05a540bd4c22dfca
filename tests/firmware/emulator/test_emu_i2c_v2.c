/* SPDX-License-Identifier: Apache-2.0 */
/* I2C of the STM32F0 from outside: the sequences of the reference manual, their times, and each mistake. */
#include "outside.h"

#define I2C 0x40005400u
#define CR1 (I2C + 0x00)
#define CR2 (I2C + 0x04)
#define TIMINGR (I2C + 0x10)
#define TIMEOUTR (I2C + 0x14)
#define ISR (I2C + 0x18)
#define ICR (I2C + 0x1c)
#define RXDR (I2C + 0x24)
#define TXDR (I2C + 0x28)

enum { PE = 1, RD = 1 << 10, START = 1 << 13, STOP = 1 << 14, RELOAD = 1 << 24, AUTOEND = 1 << 25 };
enum { TXE = 1, TXIS = 2, RXNE = 4, NACKF = 0x10, STOPF = 0x20, TC = 0x40, TCR = 0x80, BUSY = 0x8000 };
#define BYTES(n) ((uint32_t)(n) << 16)
#define SLAVE 0x10u

/* 8 MHz / (2 prescaled): 20 + 20 cycles of 250 ns = 10 us, less than 1 us more for the edges */
#define TIMING_100K 0x10420f13u

static void enabled(void)
{
    set_bits(0x4002101cu, 1u << 21); /* RCC_APB1ENR */
    pin_function(1, 6, 1, true);
    pin_function(1, 7, 1, true);
    put(TIMINGR, TIMING_100K);
    put(CR1, PE);
}

void setUp(void)
{
    outside_begin(&emu_f072);
    enabled();
}

void tearDown(void)
{
    outside_end();
}

static void test_a_write_with_autoend(void)
{
    uint64_t from = emu_now(chip);

    put(CR2, SLAVE | BYTES(2) | AUTOEND | START);
    (void)UNTIL(ISR, TXIS);
    TEST_ASSERT_EQUAL(0, get(CR2) & START);
    put(TXDR, 0x04);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 0x2a);
    (void)UNTIL(ISR, STOPF);
    /* START, 3 bytes and STOP: 29 periods; SCLL 20 + SCLH 16 of 250 ns and 6 cycles of 125 ns = 9.75 us */
    TEST_ASSERT_INT_WITHIN(5000, 29 * 9750, (long long)(emu_now(chip) - from));
    TEST_ASSERT_EQUAL_STRING("S10 W04 W2a P ", out.log);
    TEST_ASSERT_EQUAL_HEX8(0, get(ISR) & BUSY);
    put(ICR, STOPF);
    TEST_ASSERT_EQUAL_HEX8(TXE, get(ISR));
    NO_MISUSE();
}

static void test_a_repeated_start_after_tc(void)
{
    put(CR2, SLAVE | BYTES(1) | START);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 0x0c);
    (void)UNTIL(ISR, TC);
    put(CR2, SLAVE | BYTES(2) | RD | AUTOEND | START);
    (void)UNTIL(ISR, RXNE);
    TEST_ASSERT_EQUAL_HEX8(0x40, get(RXDR));
    (void)UNTIL(ISR, RXNE);
    TEST_ASSERT_EQUAL_HEX8(0x41, get(RXDR));
    (void)UNTIL(ISR, STOPF);
    TEST_ASSERT_EQUAL_STRING("S10 W0c S11 R40a R41n P ", out.log);
    NO_MISUSE();
}

static void test_reload_goes_on_with_the_next_block(void)
{
    put(CR2, SLAVE | BYTES(1) | RELOAD | START);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 1);
    (void)UNTIL(ISR, TCR);
    put(CR2, SLAVE | BYTES(1) | AUTOEND);
    TEST_ASSERT_EQUAL_HEX8(0, get(ISR) & TCR);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 2);
    (void)UNTIL(ISR, STOPF);
    TEST_ASSERT_EQUAL_STRING("S10 W01 W02 P ", out.log);
    NO_MISUSE();
}

static void test_a_missing_slave_ends_in_a_stop_by_itself(void)
{
    out.address_answer = EMU_I2C_NACK;
    put(CR2, SLAVE | BYTES(1) | START);
    (void)UNTIL(ISR, STOPF | NACKF);
    TEST_ASSERT_EQUAL_HEX8(0, get(ISR) & TXIS);
    TEST_ASSERT_EQUAL_STRING("S10 P ", out.log);
    put(ICR, NACKF | STOPF);
    NO_MISUSE();
}

static void test_a_refused_byte_ends_in_a_stop_by_itself(void)
{
    out.refuse_at = 0;
    out.byte_answer = EMU_I2C_NACK;
    put(CR2, SLAVE | BYTES(3) | AUTOEND | START);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 1);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 2);
    (void)UNTIL(ISR, STOPF | NACKF);
    TEST_ASSERT_EQUAL_STRING("S10 W01 P ", out.log);
    TEST_ASSERT_EQUAL_HEX8(0, get(ISR) & TXE); /* the second byte is still there */
    put(ICR, NACKF | STOPF);
    put(CR2, SLAVE | BYTES(1) | AUTOEND | START);
    MISUSE("I2C1", "TXDR", "earlier transfer");
    put(ISR, TXE);
    TEST_ASSERT_EQUAL_HEX8(TXE, get(ISR) & TXE);
}

static void test_the_clock_is_held_while_rxdr_is_full(void)
{
    put(CR2, SLAVE | BYTES(4) | RD | AUTOEND | START);
    pass(10 * MS);
    TEST_ASSERT_EQUAL_STRING("S11 R40a R41a ", out.log);
    for (int i = 0; i < 4; i++) {
        (void)UNTIL(ISR, RXNE);
        TEST_ASSERT_EQUAL_HEX8(0x40 + i, get(RXDR));
    }
    (void)UNTIL(ISR, STOPF);
    TEST_ASSERT_EQUAL_STRING("S11 R40a R41a R42a R43n P ", out.log);
    NO_MISUSE();
}

static void test_a_software_stop_ends_early(void)
{
    put(CR2, SLAVE | BYTES(9) | START);
    (void)UNTIL(ISR, TXIS);
    set_bits(CR2, STOP);
    (void)UNTIL(ISR, STOPF);
    TEST_ASSERT_EQUAL_STRING("S10 P ", out.log);
    NO_MISUSE();
}

static void test_lost_arbitration_and_bus_error(void)
{
    out.address_answer = EMU_I2C_LOST;
    put(CR2, SLAVE | BYTES(1) | START);
    (void)UNTIL(ISR, 1u << 9);
    TEST_ASSERT_EQUAL_HEX8(0, get(ISR) & BUSY);
    put(ICR, 1u << 9);
    out.address_answer = EMU_I2C_ERROR;
    put(CR2, SLAVE | BYTES(1) | START);
    (void)UNTIL(ISR, 1u << 8);
    NO_MISUSE();
}

static void test_stuck_wires_and_the_way_out(void)
{
    out.held = EMU_I2C_SDA_LOW;
    TEST_ASSERT_EQUAL(BUSY, get(ISR) & BUSY);
    put(CR2, SLAVE | BYTES(1) | START);
    MISUSE("I2C1", "CR2", "START while BUSY");
    pass(30 * MS);
    TEST_ASSERT_EQUAL(START, get(CR2) & START);
    put(CR1, 0);
    TEST_ASSERT_EQUAL(0, get(CR2) & START);
    TEST_ASSERT_EQUAL(0, get(CR1));
    out.held = 0;
    put(CR1, PE);
    put(CR2, SLAVE | BYTES(1) | AUTOEND | START);
    out.held = EMU_I2C_SCL_LOW;
    pass(30 * MS);
    TEST_ASSERT_EQUAL_STRING("", out.log);
    out.held = 0;
    (void)UNTIL(ISR, TXIS);
}

static void test_timeout_of_a_held_clock(void)
{
    put(TIMEOUTR, 0x8000u | 97u); /* 98 * 2048 cycles of 8 MHz = 25 ms */
    put(CR1, PE | 1u << 7);
    put(CR2, SLAVE | BYTES(1) | AUTOEND | START);
    out.held = EMU_I2C_SCL_LOW;
    TEST_ASSERT_INT_WITHIN(100000, 25088000, (long long)UNTIL(ISR, 1u << 12));
    TEST_ASSERT_TRUE(irq_pending(23));
    put(TIMEOUTR, 0x8000u | 98u);
    MISUSE("I2C1", "TIMEOUTR", "TIMOUTEN");
}

static void test_a_slave_stretches_the_clock(void)
{
    out.stretch_ns = 300 * US;
    put(CR2, SLAVE | BYTES(1) | AUTOEND | START);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 1);
    TEST_ASSERT_INT_WITHIN(6000, 300000 + 9 * 9750 + 300000 + 9750, (long long)UNTIL(ISR, STOPF));
}

static void test_each_flag_interrupts_when_enabled(void)
{
    put(CR1, PE | 2 | 4 | 0x20);
    put(CR2, SLAVE | BYTES(1) | AUTOEND | START);
    (void)UNTIL(ISR, TXIS);
    TEST_ASSERT_TRUE(irq_pending(23));
    put(TXDR, 1);
    irq_clear(23);
    TEST_ASSERT_FALSE(irq_pending(23));
    (void)UNTIL(ISR, STOPF);
    TEST_ASSERT_TRUE(irq_pending(23));
    put(ICR, STOPF);
    irq_clear(23);
    TEST_ASSERT_FALSE(irq_pending(23));
}

/* ---- mistakes
 * ---------------------------------------------------------------------------------------------------------
 */

static void test_start_while_a_transfer_runs(void)
{
    put(CR2, SLAVE | BYTES(2) | START);
    (void)UNTIL(ISR, TXIS);
    put(CR2, SLAVE | BYTES(2) | START);
    MISUSE("I2C1", "CR2", "START while BUSY");
}

static void test_cr2_written_while_start_waits(void)
{
    put(CR2, SLAVE | BYTES(2) | START);
    put(CR2, SLAVE | BYTES(3));
    MISUSE("I2C1", "CR2", "START waits");
}

static void test_start_and_stop_without_peripheral(void)
{
    put(CR2, SLAVE | BYTES(1) | STOP);
    MISUSE("I2C1", "CR2", "STOP while not master");
    put(CR1, 0);
    put(CR2, SLAVE | BYTES(1) | START);
    MISUSE("I2C1", "CR2", "PE is not set");
    pass(1 * MS);
    TEST_ASSERT_EQUAL_STRING("", out.log);
}

static void test_txdr_without_txis(void)
{
    put(TXDR, 1);
    MISUSE("I2C1", "TXDR", "TXIS is not set");
}

static void test_rxdr_without_rxne(void)
{
    (void)get(RXDR);
    MISUSE("I2C1", "RXDR", "RXNE is not set");
}

static void test_nbytes_changed_before_tcr(void)
{
    put(CR2, SLAVE | BYTES(2) | START);
    (void)UNTIL(ISR, TXIS);
    put(CR2, SLAVE | BYTES(3));
    MISUSE("I2C1", "CR2", "before TCR");
}

static void test_nbytes_of_zero_leaves_tcr(void)
{
    put(CR2, SLAVE | BYTES(1) | RELOAD | START);
    (void)UNTIL(ISR, TXIS);
    put(TXDR, 1);
    (void)UNTIL(ISR, TCR);
    put(CR2, SLAVE | BYTES(0) | AUTOEND);
    MISUSE("I2C1", "CR2", "does not clear TCR");
    TEST_ASSERT_EQUAL(TCR, get(ISR) & TCR);
}

static void test_a_read_of_no_bytes(void)
{
    put(CR2, SLAVE | RD | START);
    MISUSE("I2C1", "CR2", "read of no bytes");
}

static void test_direction_changed_during_a_transfer(void)
{
    put(CR2, SLAVE | BYTES(2) | START);
    (void)UNTIL(ISR, TXIS);
    put(CR2, SLAVE | BYTES(2) | RD);
    MISUSE("I2C1", "CR2", "direction");
}

static void test_timing_changed_or_missing(void)
{
    put(TIMINGR, TIMING_100K + 1);
    MISUSE("I2C1", "TIMINGR", "while PE is set");
    put(CR1, 0);
    (void)get(CR1);
    put(TIMINGR, 0);
    put(CR1, PE);
    put(CR2, SLAVE | BYTES(1) | START);
    MISUSE("I2C1", "TIMINGR", "never written");
}

static void test_filter_changed_while_enabled(void)
{
    put(CR1, PE | 1u << 12);
    MISUSE("I2C1", "CR1", "filter");
}

static void test_pe_must_stay_low_for_a_moment(void)
{
    put(CR1, 0);
    put(CR1, PE);
    MISUSE("I2C1", "CR1", "3 bus cycles");
}

static void test_pe_read_back_is_moment_enough(void)
{
    put(CR1, 0);
    (void)get(CR1);
    put(CR1, PE);
    NO_MISUSE();
}

static void test_flags_are_not_cleared_in_isr(void)
{
    put(ISR, STOPF);
    MISUSE("I2C1", "ISR", "ICR");
}

static void test_pins_must_be_open_drain_and_alternate(void)
{
    pin_function(1, 6, 1, false);
    pin_function(1, 7, 0, true);
    put(CR2, SLAVE | BYTES(1) | START);
    MISUSE("I2C1", "CR1", "not open drain");
    (void)UNTIL(ISR, NACKF);
    TEST_ASSERT_EQUAL_STRING("", out.log);
    TEST_ASSERT_TRUE(emu_misuse_of(chip, "I2C1", NULL) >= 2);
}

static void test_reserved_bits(void)
{
    put(CR1, PE | 1u << 13);
    MISUSE("I2C1", "CR1", "reserved");
    put(ICR, 1);
    MISUSE("I2C1", "ICR", "reserved");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_write_with_autoend);
    RUN_TEST(test_a_repeated_start_after_tc);
    RUN_TEST(test_reload_goes_on_with_the_next_block);
    RUN_TEST(test_a_missing_slave_ends_in_a_stop_by_itself);
    RUN_TEST(test_a_refused_byte_ends_in_a_stop_by_itself);
    RUN_TEST(test_the_clock_is_held_while_rxdr_is_full);
    RUN_TEST(test_a_software_stop_ends_early);
    RUN_TEST(test_lost_arbitration_and_bus_error);
    RUN_TEST(test_stuck_wires_and_the_way_out);
    RUN_TEST(test_timeout_of_a_held_clock);
    RUN_TEST(test_a_slave_stretches_the_clock);
    RUN_TEST(test_each_flag_interrupts_when_enabled);
    RUN_TEST(test_start_while_a_transfer_runs);
    RUN_TEST(test_cr2_written_while_start_waits);
    RUN_TEST(test_start_and_stop_without_peripheral);
    RUN_TEST(test_txdr_without_txis);
    RUN_TEST(test_rxdr_without_rxne);
    RUN_TEST(test_nbytes_changed_before_tcr);
    RUN_TEST(test_nbytes_of_zero_leaves_tcr);
    RUN_TEST(test_a_read_of_no_bytes);
    RUN_TEST(test_direction_changed_during_a_transfer);
    RUN_TEST(test_timing_changed_or_missing);
    RUN_TEST(test_filter_changed_while_enabled);
    RUN_TEST(test_pe_must_stay_low_for_a_moment);
    RUN_TEST(test_pe_read_back_is_moment_enough);
    RUN_TEST(test_flags_are_not_cleared_in_isr);
    RUN_TEST(test_pins_must_be_open_drain_and_alternate);
    RUN_TEST(test_reserved_bits);
    return UNITY_END();
}
