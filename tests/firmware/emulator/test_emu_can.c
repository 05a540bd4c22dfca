/* SPDX-License-Identifier: Apache-2.0 */
/* bxCAN of both families from outside: transmission and errors. */
#include "can_bench.h"

void setUp(void)
{
    ready(&emu_f405, 0);
}

void tearDown(void)
{
    outside_end();
}

/* ---- frames
 * ----------------------------------------------------------------------------------------------------------------
 */

static void test_frame_lengths(void)
{
    /* 47 bits around the data; id 0x555 with no data has no five equal bits before the CRC; the known worst
     * case of 8 bytes is 135 bits with the intermission, never exceeded */
    emu_can_frame f = {.id = 0x555, .length = 0};
    unsigned longest = 0;

    TEST_ASSERT_INT_WITHIN(3, 47 + 1, emu_can_frame_bits(&f));
    for (unsigned seed = 0; seed < 4000; seed++) {
        f = (emu_can_frame){.id = seed * 7u & 0x7ffu, .length = 8};
        for (unsigned i = 0; i < 8; i++) {
            f.data[i] = (uint8_t)(seed % 3 == 0 ? 0x00 : seed % 3 == 1 ? 0xff : seed * 31u + i * 77u);
        }
        TEST_ASSERT_TRUE(emu_can_frame_bits(&f) >= 111);
        longest = emu_can_frame_bits(&f) > longest ? emu_can_frame_bits(&f) : longest;
    }
    TEST_ASSERT_TRUE(longest <= 135);
    TEST_ASSERT_TRUE(longest >= 125);
    f = (emu_can_frame){.id = 0x15555555, .extended = true, .length = 0};
    TEST_ASSERT_INT_WITHIN(5, 67 + 2, emu_can_frame_bits(&f));
}

static void test_a_frame_goes_out_in_its_time(const emu_chip *which)
{
    unsigned bits;
    uint64_t from;

    again(which, 0);
    TEST_ASSERT_EQUAL(500000, emu_can_bit_hz(chip, 1));
    put(C_IER, 1);
    TEST_ASSERT_EQUAL_HEX32(0x1c000000, get(C_TSR));
    from = emu_now(chip);
    send(0, 0x100, 8);
    TEST_ASSERT_EQUAL_HEX32(0x19000000, get(C_TSR)); /* mailbox 1 is the next one free */
    (void)UNTIL(C_TSR, 3);
    TEST_ASSERT_EQUAL(1, out.sents);
    TEST_ASSERT_EQUAL_HEX32(0x100, out.sent[0].id);
    TEST_ASSERT_EQUAL(8, out.sent[0].length);
    TEST_ASSERT_EQUAL_HEX8(0x11, out.sent[0].data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x88, out.sent[0].data[7]);
    TEST_ASSERT_FALSE(out.sent[0].extended);
    bits = emu_can_frame_bits(&out.sent[0]);
    TEST_ASSERT_INT_WITHIN(100, (long long)bits * BIT_NS, (long long)(out.sent_at[0] - from));
    TEST_ASSERT_TRUE(irq_pending(tx_irq()));
    put(C_TSR, 1);
    TEST_ASSERT_EQUAL_HEX32(0x1c000000, get(C_TSR));
    irq_clear(tx_irq());
    TEST_ASSERT_FALSE(irq_pending(tx_irq()));
    NO_MISUSE();
}

static void test_a_frame_goes_out_f4(void)
{
    test_a_frame_goes_out_in_its_time(&emu_f405);
}

static void test_a_frame_goes_out_f0(void)
{
    test_a_frame_goes_out_in_its_time(&emu_f072);
}

static void test_extended_and_remote(void)
{
    put(C_TX(0, 4), 2);
    put(C_TX(0, 0), 0x12345678u << 3 | 4u | 2u | 1u);
    pass(1 * MS);
    TEST_ASSERT_TRUE(out.sent[0].extended);
    TEST_ASSERT_TRUE(out.sent[0].remote);
    TEST_ASSERT_EQUAL_HEX32(0x12345678, out.sent[0].id);
}

static void test_the_lowest_identifier_goes_first(void)
{
    send(0, 0x300, 1);
    send(1, 0x200, 1);
    send(2, 0x100, 1);
    TEST_ASSERT_EQUAL_HEX32(0x20000000, get(C_TSR) & 0xfc000000); /* full; mailbox 0 is the lowest */
    pass(1 * MS);
    TEST_ASSERT_EQUAL(3, out.sents);
    TEST_ASSERT_EQUAL_HEX32(0x300, out.sent[0].id); /* it was on the wire already */
    TEST_ASSERT_EQUAL_HEX32(0x100, out.sent[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x200, out.sent[2].id);
}

static void test_txfp_keeps_the_order(void)
{
    again(&emu_f405, 1u << 2);
    send(2, 0x300, 1);
    send(1, 0x200, 1);
    send(0, 0x100, 1);
    pass(1 * MS);
    TEST_ASSERT_EQUAL_HEX32(0x300, out.sent[0].id);
    TEST_ASSERT_EQUAL_HEX32(0x200, out.sent[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x100, out.sent[2].id);
}

static void test_abort(void)
{
    send(0, 0x100, 8);
    send(1, 0x200, 8);
    put(C_TSR, 1u << 15); /* waits only: at once */
    TEST_ASSERT_EQUAL_HEX32(1u << 8, get(C_TSR) & 0xff00u);
    put(C_TSR, 1u << 7); /* on the wire: the frame decides */
    TEST_ASSERT_EQUAL_HEX32(1u << 7, get(C_TSR) & 0xffu);
    pass(1 * MS);
    TEST_ASSERT_EQUAL_HEX32(3, get(C_TSR) & 0xffu);
    TEST_ASSERT_EQUAL(1, out.sents);
    NO_MISUSE();
}

static void test_lost_arbitration_is_tried_again(void)
{
    out.result = EMU_CAN_LOST;
    send(0, 0x100, 1);
    pass(200 * US);
    TEST_ASSERT_EQUAL_HEX32(1u << 2, get(C_TSR) & 0xffu);
    TEST_ASSERT_EQUAL(0, get(C_ESR));
    out.result = EMU_CAN_ACKED;
    pass(300 * US);
    TEST_ASSERT_EQUAL_HEX32(3, get(C_TSR) & 0xffu);
}

static void test_without_retransmission_one_try_is_all(void)
{
    again(&emu_f405, 1u << 4);
    out.result = EMU_CAN_NO_ACK;
    send(0, 0x100, 1);
    pass(5 * MS);
    TEST_ASSERT_EQUAL(1, out.sents);
    TEST_ASSERT_EQUAL_HEX32(1 | 1u << 3, get(C_TSR) & 0xffu);
    out.result = EMU_CAN_LOST;
    put(C_TSR, 1);
    send(0, 0x100, 1);
    pass(5 * MS);
    TEST_ASSERT_EQUAL_HEX32(1 | 1u << 2, get(C_TSR) & 0xffu);
}

static void test_loop_back_needs_nobody(void)
{
    outside_end();
    clocked(&emu_f405);
    init_mode();
    put(C_BTR, SEGMENTS | 1u | 1u << 30 | 1u << 31);
    filter();
    normal_mode(0);
    send(0, 0x081, 3);
    pass(1 * MS);
    TEST_ASSERT_EQUAL(0, out.sents);
    TEST_ASSERT_EQUAL(3, get(C_TSR) & 0xffu);
    TEST_ASSERT_EQUAL(1, get(C_RF0R) & 3u);
    TEST_ASSERT_EQUAL_HEX32(0x081u << 21, get(C_RX(0, 0)));
    TEST_ASSERT_EQUAL_HEX32(0x332211, get(C_RX(0, 8)) & 0xffffff);
}

/* ---- errors
 * -----------------------------------------------------------------------------------------------------------------
 */

static void test_a_dead_bus_makes_it_passive_but_not_off(void)
{
    out.result = EMU_CAN_NO_ACK;
    put(C_IER, 1u << 15 | 1u << 8 | 1u << 9 | 1u << 10);
    send(0, 0x100, 8);
    pass(300 * US);
    TEST_ASSERT_EQUAL_HEX32(8u << 16 | 3u << 4, get(C_ESR));
    pass(3 * MS);
    TEST_ASSERT_EQUAL_HEX32(1, get(C_ESR) & 7u); /* warning */
    TEST_ASSERT_EQUAL(4, get(C_MSR) & 4u);
    TEST_ASSERT_TRUE(irq_pending(22));
    put(C_MSR, 4);
    pass(50 * MS);
    TEST_ASSERT_EQUAL_HEX32(3, get(C_ESR) & 7u);
    TEST_ASSERT_EQUAL(128, get(C_ESR) >> 16 & 0xffu);
    TEST_ASSERT_EQUAL(4, get(C_MSR) & 4u);
    out.result = EMU_CAN_ACKED;
    pass(1 * MS);
    TEST_ASSERT_EQUAL(127, get(C_ESR) >> 16 & 0xffu);
    TEST_ASSERT_EQUAL_HEX32(1, get(C_ESR) & 7u);
    NO_MISUSE();
}

static void go_off(void)
{
    out.result = EMU_CAN_FORM_ERROR;
    send(0, 0x100, 0);
    (void)UNTIL(C_ESR, 4);
    out.result = EMU_CAN_ACKED;
}

static void test_bus_off_comes_back_by_itself_with_abom(void)
{
    again(&emu_f405, 1u << 6);
    go_off();
    TEST_ASSERT_EQUAL(32, out.sents); /* 32 times 8 */
    TEST_ASSERT_FALSE(emu_can_in(chip, 1, &(emu_can_frame){.id = 0x080}));
    pass(128u * 11u * BIT_NS - 2000u);
    TEST_ASSERT_EQUAL(4, get(C_ESR) & 4u);
    pass(4000);
    TEST_ASSERT_EQUAL(0, get(C_ESR) & 0xffff0007u);
    pass(1 * MS);
    TEST_ASSERT_EQUAL(3, get(C_TSR) & 0xffu); /* what waited goes out */
    NO_MISUSE();
}

static void test_bus_off_stays_without_abom_until_software_comes(void)
{
    go_off();
    pass(1000 * MS);
    TEST_ASSERT_EQUAL(4, get(C_ESR) & 4u);
    set_bits(C_MCR, 1);
    (void)UNTIL(C_MSR, 1);
    TEST_ASSERT_EQUAL(4, get(C_ESR) & 4u);
    put(C_MCR, 0x00010000u);
    pass(128u * 11u * BIT_NS - 2000u);
    TEST_ASSERT_EQUAL(4, get(C_ESR) & 4u);
    pass(4000);
    TEST_ASSERT_EQUAL(0, get(C_ESR) & 4u);
    NO_MISUSE();
}

static void test_a_bus_held_dominant_lets_nobody_in(void)
{
    outside_end();
    clocked(&emu_f405);
    init_mode();
    out.wire = EMU_CAN_DOMINANT;
    put(C_MCR, 0x00010000u);
    pass(50 * MS);
    TEST_ASSERT_EQUAL(1, get(C_MSR) & 1u);
    out.wire = EMU_CAN_RECESSIVE;
    pass(50 * US);
    TEST_ASSERT_EQUAL(0, get(C_MSR) & 1u);
    out.wire = EMU_CAN_DOMINANT;
    send(0, 0x100, 1);
    pass(1 * MS);
    TEST_ASSERT_EQUAL(0, out.sents);
    TEST_ASSERT_EQUAL(4, get(C_ESR) >> 4 & 7u);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frame_lengths);
    RUN_TEST(test_a_frame_goes_out_f4);
    RUN_TEST(test_a_frame_goes_out_f0);
    RUN_TEST(test_extended_and_remote);
    RUN_TEST(test_the_lowest_identifier_goes_first);
    RUN_TEST(test_txfp_keeps_the_order);
    RUN_TEST(test_abort);
    RUN_TEST(test_lost_arbitration_is_tried_again);
    RUN_TEST(test_without_retransmission_one_try_is_all);
    RUN_TEST(test_loop_back_needs_nobody);
    RUN_TEST(test_a_dead_bus_makes_it_passive_but_not_off);
    RUN_TEST(test_bus_off_comes_back_by_itself_with_abom);
    RUN_TEST(test_bus_off_stays_without_abom_until_software_comes);
    RUN_TEST(test_a_bus_held_dominant_lets_nobody_in);
    return UNITY_END();
}
