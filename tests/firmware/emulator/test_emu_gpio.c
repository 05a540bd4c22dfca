/* SPDX-License-Identifier: Apache-2.0 */
/* Ports, clock gate, EXTI (RM0091 sections 7 to 11, RM0090 sections 7 to 12). */
#include "regs.h"
#include "unity.h"

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
    set(e, F0_RCC + 0x14u, 7u << 17); /* ports A to C */
    set(e, F0_RCC + 0x18u, 1u);       /* SYSCFG */
}

void tearDown(void)
{
    emu_destroy(e);
    e = NULL;
}

static void test_reset_values(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x28000000, rd(e, F0_GPIOA));
    TEST_ASSERT_EQUAL_HEX32(0x24000000, rd(e, F0_GPIOA + 0x0c));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_GPIOB));
    start(&emu_f405);
    set(e, F4_RCC + 0x30u, 3u);
    TEST_ASSERT_EQUAL_HEX32(0xa8000000, rd(e, F4_GPIOA));
    TEST_ASSERT_EQUAL_HEX32(0x280, rd(e, F4_GPIOB));
    TEST_ASSERT_EQUAL_HEX32(0x100, rd(e, F4_GPIOB + 0x0c));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_access_without_clock_is_misuse_and_reads_0(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, 0x48001400u)); /* port F */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "GPIOF", "000"));
    wr(e, 0x48001400u, 1);
    TEST_ASSERT_EQUAL(2, misuse(e, "GPIOF"));
    set(e, F0_RCC + 0x14u, 1u << 22);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, 0x48001400u)); /* the write had no effect */
    TEST_ASSERT_EQUAL(2, misuse(e, "GPIOF"));
}

static void test_output_reaches_the_world(void)
{
    wr(e, F0_GPIOA + 0x18, 1u << 1); /* BSRR before MODER: no glitch */
    wr(e, F0_GPIOA, 0x28000004u);
    TEST_ASSERT_EQUAL(EMU_DRIVE_HIGH, w.drive[0][1]);
    TEST_ASSERT_EQUAL(1, w.pin_changes);
    wr(e, F0_GPIOA + 0x18, 1u << 17);
    TEST_ASSERT_EQUAL(EMU_DRIVE_LOW, w.drive[0][1]);
    wr(e, F0_GPIOA + 0x18, 1u << 17 | 1u << 1); /* set wins */
    TEST_ASSERT_EQUAL(EMU_DRIVE_HIGH, w.drive[0][1]);
    wr(e, F0_GPIOA + 0x28, 1u << 1); /* BRR */
    TEST_ASSERT_EQUAL(EMU_DRIVE_LOW, w.drive[0][1]);
    wr16(e, F0_GPIOA + 0x18, 1u << 1); /* half of BSRR */
    TEST_ASSERT_EQUAL(EMU_DRIVE_HIGH, w.drive[0][1]);
    wr16(e, F0_GPIOA + 0x1a, 1u << 1);
    TEST_ASSERT_EQUAL(EMU_DRIVE_LOW, w.drive[0][1]);
    emu_reset(e, EMU_CAUSE_PIN);
    TEST_ASSERT_EQUAL(EMU_DRIVE_NONE, w.drive[0][1]);
}

static void test_open_drain_lets_the_outside_pull_low(void)
{
    wr(e, F0_GPIOB + 0x04, 1u << 6);
    wr(e, F0_GPIOB + 0x14, 1u << 6);
    wr(e, F0_GPIOB, 1u << 12);
    w.level[1][6] = 1;
    TEST_ASSERT_EQUAL_HEX32(1u << 6, rd(e, F0_GPIOB + 0x10));
    w.level[1][6] = 0;
    advance_us(e, 1);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_GPIOB + 0x10));
}

static void test_pulls_decide_when_nothing_drives(void)
{
    TEST_ASSERT_EQUAL_HEX32(1u << 13,
                            rd(e, F0_GPIOA + 0x10) & 0xa000u); /* SWDIO up, analog and others down */
    wr(e, F0_GPIOC + 0x0c, 1u << 26);
    TEST_ASSERT_EQUAL_HEX32(1u << 13, rd(e, F0_GPIOC + 0x10));
    wr(e, F0_GPIOC + 0x0c, 2u << 26);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_GPIOC + 0x10));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, F0_GPIOC + 0x0c, 3u << 26);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "GPIOC", "PUPDR"));
}

static void test_an_edge_on_a_pin_pends_its_interrupt(void)
{
    w.level[0][0] = 0;
    wr(e, F0_EXTI, 1u);
    wr(e, F0_EXTI + 0x08, 1u);
    advance_us(e, 10);
    TEST_ASSERT_FALSE(pending(e, 5));
    w.next_ns = emu_now(e) + 5000;
    w.level[0][0] = 1;
    advance_us(e, 10);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, F0_EXTI + 0x14));
    TEST_ASSERT_TRUE(pending(e, 5));
    wr(e, NVIC_ICPR, 1u << 5); /* the line is still on */
    TEST_ASSERT_TRUE(pending(e, 5));
    wr(e, F0_EXTI + 0x14, 1u);
    wr(e, NVIC_ICPR, 1u << 5);
    TEST_ASSERT_FALSE(pending(e, 5));
    w.level[0][0] = 0; /* falling: not asked for */
    w.next_ns = emu_now(e) + 1000;
    advance_us(e, 10);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_EXTI + 0x14));
}

static void test_syscfg_chooses_the_port(void)
{
    start(&emu_f405);
    set(e, F4_RCC + 0x30u, 7u);
    set(e, F4_RCC + 0x44u, 1u << 14);
    wr(e, F4_SYSCFG + 0x0c, 1u << 4); /* line 5 from port B */
    w.level[1][5] = 0;
    wr(e, F4_EXTI, 1u << 5);
    wr(e, F4_EXTI + 0x0c, 1u << 5);
    w.level[1][5] = 1;
    w.next_ns = 1000;
    advance_us(e, 2);
    TEST_ASSERT_FALSE(pending(e, 23));
    w.level[1][5] = 0;
    w.next_ns = 3000;
    advance_us(e, 2);
    TEST_ASSERT_TRUE(pending(e, 23));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, F4_SYSCFG + 0x0c, 10u << 4);
    TEST_ASSERT_EQUAL(1, misuse(e, "SYSCFG"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reset_values);
    RUN_TEST(test_access_without_clock_is_misuse_and_reads_0);
    RUN_TEST(test_output_reaches_the_world);
    RUN_TEST(test_open_drain_lets_the_outside_pull_low);
    RUN_TEST(test_pulls_decide_when_nothing_drives);
    RUN_TEST(test_an_edge_on_a_pin_pends_its_interrupt);
    RUN_TEST(test_syscfg_chooses_the_port);
    return UNITY_END();
}
