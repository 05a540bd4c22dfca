/* SPDX-License-Identifier: Apache-2.0 */
/* SPI and DMA streams of the STM32F4 from outside. */
#include "outside.h"

#define SPI 0x40013000u
#define CR1 (SPI + 0x00)
#define CR2 (SPI + 0x04)
#define SR (SPI + 0x08)
#define DR (SPI + 0x0c)
#define DMA2 0x40026400u
#define LISR (DMA2 + 0x00)
#define LIFCR (DMA2 + 0x08)
#define STREAM(n) (DMA2 + 0x10u + 0x18u * (n))
#define RAM 0x20000100u

enum { RXNE = 1, TXE = 2, MODF = 0x20, OVR = 0x40, BSY = 0x80 };
enum {
    CPHA = 1,
    CPOL = 2,
    MSTR = 4,
    BR16 = 3 << 3,
    SPE = 0x40,
    LSB = 0x80,
    SSI = 0x100,
    SSM = 0x200,
    DFF = 0x800
};
#define MASTER (CPHA | MSTR | BR16 | SSI | SSM) /* 16 MHz / 16 = 1 MHz: 8 us a byte */

enum { EN = 1, TCIE = 0x10, TO_PERIPH = 0x40, CIRC = 0x100, MINC = 0x400 };
#define CH3 (3u << 25)

static void enabled(void)
{
    set_bits(0x40023844u, 1u << 12); /* RCC_APB2ENR: SPI1 */
    set_bits(0x40023830u, 1u << 22); /* RCC_AHB1ENR: DMA2 */
    pin_function(0, 5, 5, false);
    pin_function(0, 6, 5, false);
    pin_function(0, 7, 5, false);
    put(CR1, MASTER);
    put(CR1, MASTER | SPE);
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

static void test_a_byte_takes_eight_clocks(void)
{
    TEST_ASSERT_EQUAL_HEX8(TXE, get(SR));
    put(DR, 0x3a);
    TEST_ASSERT_EQUAL_HEX8(TXE | BSY, get(SR));
    TEST_ASSERT_INT_WITHIN(150, 8000, (long long)until(SR, RXNE, 100, __LINE__));
    TEST_ASSERT_EQUAL_HEX8(0xc5, get(DR));
    TEST_ASSERT_EQUAL_HEX8(TXE, get(SR));
    TEST_ASSERT_EQUAL(1, out.frames);
    TEST_ASSERT_EQUAL_HEX16(0x3a, out.frame[0].value);
    TEST_ASSERT_EQUAL(8, out.frame[0].bits);
    TEST_ASSERT_EQUAL(1, out.frame[0].mode);
    TEST_ASSERT_EQUAL(1000000, out.frame[0].hz);
    TEST_ASSERT_FALSE(out.frame[0].lsb_first);
    NO_MISUSE();
}

static void test_mode_clock_and_order_reach_the_other_side(void)
{
    put(CR1, 0);
    put(CR1, (MASTER & ~(CPHA | 7 << 3)) | CPOL | LSB | DFF);
    put(CR1, (MASTER & ~(CPHA | 7 << 3)) | CPOL | LSB | DFF | SPE);
    put(DR, 0x1234);
    TEST_ASSERT_INT_WITHIN(150, 2000, (long long)until(SR, RXNE, 100, __LINE__));
    TEST_ASSERT_EQUAL(2, out.frame[0].mode);
    TEST_ASSERT_EQUAL(8000000, out.frame[0].hz);
    TEST_ASSERT_EQUAL(16, out.frame[0].bits);
    TEST_ASSERT_TRUE(out.frame[0].lsb_first);
    TEST_ASSERT_EQUAL_HEX16(0xedcb, get(DR));
    NO_MISUSE();
}

static void test_an_undriven_miso_reads_ones(void)
{
    out.miso_undriven = true;
    put(DR, 0);
    (void)UNTIL(SR, RXNE);
    TEST_ASSERT_EQUAL_HEX8(0xff, get(DR));
}

static void test_two_bytes_follow_without_a_gap(void)
{
    put(DR, 1);
    put(DR, 2);
    (void)until(SR, RXNE, 100, __LINE__);
    (void)get(DR);
    TEST_ASSERT_EQUAL_HEX8(BSY, get(SR) & BSY);
    TEST_ASSERT_INT_WITHIN(250, 8000, (long long)until(SR, RXNE, 100, __LINE__));
    NO_MISUSE();
}

static void test_each_flag_interrupts_when_enabled(void)
{
    put(CR2, 1 << 6);
    TEST_ASSERT_FALSE(irq_pending(35));
    put(DR, 1);
    pass(10 * US);
    TEST_ASSERT_TRUE(irq_pending(35));
}

/* ---- mistakes at the SPI
 * ------------------------------------------------------------------------------------------------ */

static void test_overrun(void)
{
    put(DR, 1);
    put(DR, 2);
    pass(20 * US);
    MISUSE("SPI1", "DR", "overrun");
    TEST_ASSERT_EQUAL_HEX8(OVR | RXNE, get(SR) & (OVR | RXNE));
    TEST_ASSERT_EQUAL_HEX8(0xfe, get(DR)); /* the first stays */
    (void)get(SR);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR) & OVR);
}

static void test_empty_read_and_full_write(void)
{
    (void)get(DR);
    MISUSE("SPI1", "DR", "RXNE is not set");
    put(DR, 1);
    put(DR, 2);
    put(DR, 3);
    MISUSE("SPI1", "DR", "TXE is not set");
}

static void test_disabled_while_busy(void)
{
    put(DR, 1);
    put(CR1, MASTER);
    MISUSE("SPI1", "CR1", "SPE cleared while BSY");
}

static void test_changes_while_busy_or_enabled(void)
{
    put(DR, 1);
    put(CR1, MASTER | SPE | CPOL);
    MISUSE("SPI1", "CR1", "changed while BSY");
    pass(20 * US);
    put(CR1, MASTER | SPE | CPOL | DFF);
    MISUSE("SPI1", "CR1", "DFF changed");
}

static void test_nss_not_held_is_a_mode_fault(void)
{
    put(CR1, (MASTER & ~SSI) | SPE);
    MISUSE("SPI1", "CR1", "MODF");
    TEST_ASSERT_EQUAL_HEX8(MODF, get(SR) & MODF);
    TEST_ASSERT_EQUAL(0, get(CR1) & (SPE | MSTR));
    put(CR1, MASTER);
    TEST_ASSERT_EQUAL_HEX8(0, get(SR) & MODF);
}

static void test_pins_must_be_connected(void)
{
    pin_function(0, 6, 0, false);
    put(DR, 1);
    pass(10 * US);
    TEST_ASSERT_EQUAL(0, out.frames);
    TEST_ASSERT_TRUE(emu_misuse_of(chip, "SPI1", NULL) >= 1);
}

static void test_what_is_not_modelled_is_told(void)
{
    put(CR1, MASTER | 1 << 13);
    MISUSE("SPI1", "CR1", "not modelled");
    put(CR1, CPHA | SPE);
    MISUSE("SPI1", "CR1", "slave");
    put(SPI + 0x1c, 0x800);
    MISUSE("SPI1", "I2SCFGR", "not modelled");
}

/* ---- DMA
 * -------------------------------------------------------------------------------------------------------------------
 */

static void stream(unsigned n, uint32_t cr, uint32_t memory, uint32_t items)
{
    put(STREAM(n) + 0x08, DR);
    put(STREAM(n) + 0x0c, memory);
    put(STREAM(n) + 0x04, items);
    put(STREAM(n), cr);
}

static void test_a_packet_by_two_streams(void)
{
    static const uint8_t packet[5] = {0x02, 0x3b, 0x01, 0x00, 0x00};
    uint8_t back[5];

    TEST_ASSERT_TRUE(emu_poke(chip, RAM, packet, 5));
    put(CR1, MASTER);
    put(CR2, 1);
    stream(0, CH3 | MINC | TCIE | EN, RAM + 0x10, 5);
    stream(3, CH3 | MINC | TO_PERIPH | EN, RAM, 5);
    put(CR2, 3);
    put(CR1, MASTER | SPE);
    TEST_ASSERT_INT_WITHIN(2000, 40000, (long long)UNTIL(LISR, 1u << 5));
    TEST_ASSERT_EQUAL(1u << 27, get(LISR) & 1u << 27);
    TEST_ASSERT_TRUE(irq_pending(56));
    TEST_ASSERT_EQUAL(0, get(STREAM(0)) & EN);
    TEST_ASSERT_EQUAL(0, get(STREAM(0) + 4));
    TEST_ASSERT_TRUE(emu_peek(chip, RAM + 0x10, back, 5));
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_HEX8((uint8_t)~packet[i], back[i]);
        TEST_ASSERT_EQUAL_HEX8(packet[i], out.frame[i].value);
    }
    put(LIFCR, 0x0f7d0f7d);
    TEST_ASSERT_EQUAL(0, get(LISR));
    irq_clear(56);
    TEST_ASSERT_FALSE(irq_pending(56));
    NO_MISUSE();
}

static void test_without_increment_one_byte_repeats(void)
{
    uint8_t zero = 0x5a;

    TEST_ASSERT_TRUE(emu_poke(chip, RAM, &zero, 1));
    put(CR2, 1);
    stream(0, CH3 | MINC | EN, RAM + 0x10, 3);
    stream(3, CH3 | TO_PERIPH | EN, RAM, 3);
    put(CR2, 3);
    (void)UNTIL(LISR, 1u << 5);
    TEST_ASSERT_EQUAL(3, out.frames);
    TEST_ASSERT_EQUAL_HEX8(0x5a, out.frame[2].value);
}

static void test_circular_mode_begins_again(void)
{
    put(CR2, 1);
    stream(0, CH3 | MINC | CIRC | EN, RAM + 0x10, 2);
    for (int i = 0; i < 3; i++) {
        put(DR, (uint32_t)i);
        pass(20 * US);
    }
    TEST_ASSERT_EQUAL(1, get(STREAM(0) + 4));
    TEST_ASSERT_EQUAL(EN, get(STREAM(0)) & EN);
}

static void test_another_channel_moves_nothing(void)
{
    put(CR2, 1);
    stream(0, 2u << 25 | MINC | EN, RAM + 0x10, 1);
    put(DR, 1);
    pass(100 * US);
    TEST_ASSERT_EQUAL(1, get(STREAM(0) + 4));
    TEST_ASSERT_EQUAL_HEX8(RXNE, get(SR) & RXNE);
}

static void test_configured_while_enabled(void)
{
    stream(0, CH3 | MINC | EN, RAM, 4);
    put(STREAM(0) + 0x04, 5);
    MISUSE("DMA2", "SxCR", "configured while enabled");
    TEST_ASSERT_EQUAL(4, get(STREAM(0) + 4));
}

static void test_cr_changed_while_enabled(void)
{
    stream(0, CH3 | MINC | EN, RAM, 4);
    NO_MISUSE();
    put(STREAM(0), CH3 | EN);
    MISUSE("DMA2", "SxCR", "configured while enabled");
    TEST_ASSERT_EQUAL(MINC, get(STREAM(0)) & MINC);
}

static void test_flags_must_be_cleared_before_enabling(void)
{
    stream(0, CH3 | MINC | EN, RAM, 4);
    put(STREAM(0), CH3 | MINC); /* stopping sets TCIF */
    TEST_ASSERT_EQUAL(1u << 5, get(LISR) & 1u << 5);
    put(STREAM(0), CH3 | MINC | EN);
    MISUSE("DMA2", "SxCR", "not cleared");
}

static void test_enabled_with_nothing_or_misaligned(void)
{
    stream(0, CH3 | MINC | EN, RAM, 0);
    MISUSE("DMA2", "SxNDTR", "nothing to transfer");
    stream(2, CH3 | MINC | 1u << 11 | 1u << 13 | EN, RAM + 1, 4);
    MISUSE("DMA2", "SxPAR", "not aligned");
    stream(3, CH3 | MINC | 1u << 13 | TO_PERIPH | EN, RAM, 4);
    MISUSE("DMA2", "SxCR", "sizes differ");
}

static void test_ccm_cannot_be_reached(void)
{
    put(CR2, 1);
    stream(0, CH3 | MINC | EN, 0x10000000u, 4);
    put(DR, 1);
    pass(20 * US);
    MISUSE("DMA2", "SxCR", "transfer error");
    TEST_ASSERT_EQUAL(1u << 3, get(LISR) & 1u << 3);
}

static void test_narrow_and_reserved_writes(void)
{
    TEST_ASSERT_TRUE(emu_bus_write(chip, STREAM(0) + 4, 2, 3));
    MISUSE("DMA2", "-", "only words");
    put(LIFCR, 2);
    MISUSE("DMA2", "LIFCR", "reserved");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_byte_takes_eight_clocks);
    RUN_TEST(test_mode_clock_and_order_reach_the_other_side);
    RUN_TEST(test_an_undriven_miso_reads_ones);
    RUN_TEST(test_two_bytes_follow_without_a_gap);
    RUN_TEST(test_each_flag_interrupts_when_enabled);
    RUN_TEST(test_overrun);
    RUN_TEST(test_empty_read_and_full_write);
    RUN_TEST(test_disabled_while_busy);
    RUN_TEST(test_changes_while_busy_or_enabled);
    RUN_TEST(test_nss_not_held_is_a_mode_fault);
    RUN_TEST(test_pins_must_be_connected);
    RUN_TEST(test_what_is_not_modelled_is_told);
    RUN_TEST(test_a_packet_by_two_streams);
    RUN_TEST(test_without_increment_one_byte_repeats);
    RUN_TEST(test_circular_mode_begins_again);
    RUN_TEST(test_another_channel_moves_nothing);
    RUN_TEST(test_configured_while_enabled);
    RUN_TEST(test_cr_changed_while_enabled);
    RUN_TEST(test_flags_must_be_cleared_before_enabling);
    RUN_TEST(test_enabled_with_nothing_or_misaligned);
    RUN_TEST(test_ccm_cannot_be_reached);
    RUN_TEST(test_narrow_and_reserved_writes);
    return UNITY_END();
}
