/* SPDX-License-Identifier: Apache-2.0 */
/* TIM2, watchdog, USART of both families, SysTick. */
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
    start(&emu_f072); /* 8 MHz */
    set(e, F0_RCC + 0x1c, 1u | 1u << 17);
    set(e, F0_RCC + 0x14, 1u << 17);
}

void tearDown(void)
{
    emu_destroy(e);
    e = NULL;
}

/* ---- TIM2 (RM0091 18.4) ---- */

#define CNT (TIM2_BASE + 0x24)

static void count_microseconds(void)
{
    wr(e, TIM2_BASE + 0x28, 7);
    wr(e, TIM2_BASE + 0x14, 1);
    wr(e, TIM2_BASE + 0x10, 0);
    wr(e, TIM2_BASE, 1);
}

static void test_counter(void)
{
    count_microseconds();
    TEST_ASSERT_EQUAL(0, rd(e, CNT));
    advance_us(e, 1234567);
    TEST_ASSERT_EQUAL(1234567, rd(e, CNT));
    wr(e, CNT, 0xfffffff0u);
    advance_us(e, 0x20);
    TEST_ASSERT_EQUAL_HEX32(0x10, rd(e, CNT)); /* 32 bits wide, and it went over the end */
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, TIM2_BASE + 0x10) & 1u);
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_prescaler_is_preloaded(void)
{
    wr(e, TIM2_BASE + 0x28, 7);
    wr(e, TIM2_BASE, 1); /* no update event: still undivided */
    advance_us(e, 10);
    TEST_ASSERT_EQUAL(80, rd(e, CNT));
    wr(e, TIM2_BASE + 0x14, 1);
    TEST_ASSERT_EQUAL(0, rd(e, CNT));
    advance_us(e, 10);
    TEST_ASSERT_EQUAL(10, rd(e, CNT));
}

static void test_compare(void)
{
    count_microseconds();
    wr(e, TIM2_BASE + 0x34, 1000);
    wr(e, TIM2_BASE + 0x0c, 2);
    advance_us(e, 999);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, TIM2_BASE + 0x10) & 2u);
    TEST_ASSERT_FALSE(pending(e, 15));
    advance_us(e, 1);
    TEST_ASSERT_EQUAL_HEX32(2, rd(e, TIM2_BASE + 0x10) & 2u);
    TEST_ASSERT_TRUE(pending(e, 15));
    wr(e, TIM2_BASE + 0x10, ~2u);
    wr(e, NVIC_ICPR, 1u << 15);
    TEST_ASSERT_FALSE(pending(e, 15));
    wr(e, TIM2_BASE + 0x34, 500); /* already past: an hour away */
    advance_us(e, 10000000);
    TEST_ASSERT_FALSE(pending(e, 15));
}

static void test_update_by_software(void)
{
    wr(e, TIM2_BASE, 4); /* URS */
    wr(e, TIM2_BASE + 0x14, 1);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, TIM2_BASE + 0x10) & 1u);
    wr(e, TIM2_BASE, 0);
    wr(e, TIM2_BASE + 0x14, 1);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, TIM2_BASE + 0x10) & 1u);
}

static void test_short_periods(void)
{
    count_microseconds();
    wr(e, TIM2_BASE + 0x2c, 9); /* ten counts */
    wr(e, CNT, 0);
    wr(e, TIM2_BASE + 0x10, 0);
    advance_us(e, 9);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, TIM2_BASE + 0x10) & 1u);
    advance_us(e, 1);
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, TIM2_BASE + 0x10) & 1u);
    advance_us(e, 1003);
    TEST_ASSERT_EQUAL(3, rd(e, CNT));
}

static void test_what_is_not_modelled_is_said(void)
{
    wr(e, TIM2_BASE, 0x10);
    wr(e, TIM2_BASE + 0x20, 1);
    TEST_ASSERT_EQUAL(2, misuse(e, "TIM2"));
}

/* ---- watchdog (RM0091 24.4) ---- */

static uint32_t bites(void)
{
    return rd(e, F0_RCC + 0x24) >> 29 & 1u;
}

static void test_watchdog_bites_in_time(void)
{
    wr(e, IWDG_BASE, 0xcccc);
    wr(e, IWDG_BASE, 0x5555);
    wr(e, IWDG_BASE + 4, 4); /* / 64 */
    wr(e, IWDG_BASE + 8, 624);
    TEST_ASSERT_EQUAL_HEX32(3, rd(e, IWDG_BASE + 0x0c)); /* both under way */
    advance_us(e, 200);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, IWDG_BASE + 0x0c));
    wr(e, IWDG_BASE, 0xaaaa); /* 625 * 64 / 40 kHz = 1 s */
    advance_us(e, 999000);
    TEST_ASSERT_EQUAL(0, bites());
    wr(e, IWDG_BASE, 0xaaaa);
    advance_us(e, 999000);
    TEST_ASSERT_EQUAL(0, bites());
    advance_us(e, 2000);
    TEST_ASSERT_EQUAL(1, bites());
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    advance_us(e, 10000000); /* the reset stopped it */
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->resets[EMU_CAUSE_IWDG]);
}

static void test_watchdog_mistakes(void)
{
    wr(e, IWDG_BASE + 4, 4);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "IWDG", "PR"));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, IWDG_BASE + 4));
    wr(e, IWDG_BASE, 0x5555);
    wr(e, IWDG_BASE + 8, 100);
    wr(e, IWDG_BASE + 8, 200); /* RVU still set */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "IWDG", "RLR"));
    TEST_ASSERT_EQUAL(100, rd(e, IWDG_BASE + 8));
    wr(e, IWDG_BASE, 0x1234);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "IWDG", "KR"));
}

static void test_watchdog_window(void)
{
    wr(e, IWDG_BASE, 0xcccc);
    wr(e, IWDG_BASE, 0x5555);
    wr(e, IWDG_BASE + 0x10, 2000);
    TEST_ASSERT_EQUAL(0, bites());
    wr(e, IWDG_BASE, 0xaaaa); /* too early: 2095 counts of 100 us have to pass */
    advance_us(e, 1);
    TEST_ASSERT_EQUAL(1, bites());
}

static void test_watchdog_of_f4(void)
{
    start(&emu_f405);
    emu_set_lsi_hz(e, 17000); /* as slow as it may be */
    wr(e, IWDG_BASE, 0xcccc);
    advance_us(e, 963000); /* 4 * 4096 / 17 kHz = 963.8 ms */
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->resets[EMU_CAUSE_IWDG]);
    advance_us(e, 1000);
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->resets[EMU_CAUSE_IWDG]);
}

/* ---- USART v2 (RM0091 27.8) ---- */

#define U USART2_BASE

static void usart_on(void)
{
    set(e, F0_GPIOA + 0x20, 0x1100); /* PA2, PA3: AF1 */
    wr(e, F0_GPIOA, 0x280000a0u);
    wr(e, U + 0x0c, 69); /* 8 MHz / 115200 */
    wr(e, U, 0x0d);
}

static void test_bytes_take_their_time(void)
{
    usart_on();
    TEST_ASSERT_EQUAL_HEX32(0xc0, rd(e, U + 0x1c) & 0xffu);
    wr(e, U + 0x28, 'a');
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, U + 0x1c) & 0xffu); /* in the shift register: TXE, not TC */
    wr(e, U + 0x28, 'b');
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, U + 0x1c) & 0xffu);
    advance_us(e, 86);
    TEST_ASSERT_EQUAL(0, w.sent_count);
    advance_us(e, 1); /* ten bits of 8.625 us */
    TEST_ASSERT_EQUAL(1, w.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0x80, rd(e, U + 0x1c) & 0xffu);
    advance_us(e, 87);
    TEST_ASSERT_EQUAL(2, w.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0xc0, rd(e, U + 0x1c) & 0xffu);
    TEST_ASSERT_EQUAL('b', w.sent[1]);
    TEST_ASSERT_INT_WITHIN(100, 86250, w.sent_ns[1] - w.sent_ns[0]);
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_transmit_mistakes(void)
{
    wr(e, U + 0x0c, 69);
    wr(e, U + 0x28, 'x'); /* off */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "USART2", "TDR"));
    wr(e, U, 0x0d);
    wr(e, U + 0x28, 'a'); /* no pin */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "USART2", "pin"));
    wr(e, U + 0x28, 'b');
    wr(e, U + 0x28, 'c');
    TEST_ASSERT_GREATER_OR_EQUAL(2, emu_misuse_of(e, "USART2", "TDR"));
    wr(e, U + 0x0c, 70); /* BRR while on */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "USART2", "BRR"));
}

static void test_unusual_speed(void)
{
    usart_on();
    wr(e, U, 0);
    wr(e, U + 0x0c, 72); /* 3.5 % off */
    wr(e, U, 0x0d);
    wr(e, U + 0x28, 'a');
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "USART2", "BRR"));
}

static void test_receive(void)
{
    usart_on();
    wr(e, U, 0x2d); /* RXNEIE */
    TEST_ASSERT_TRUE(emu_uart_in(e, 2, 'q'));
    TEST_ASSERT_TRUE(pending(e, 28));
    TEST_ASSERT_EQUAL_HEX32(0x20, rd(e, U + 0x1c) & 0x28u);
    TEST_ASSERT_EQUAL('q', rd(e, U + 0x24));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, U + 0x1c) & 0x28u);
    emu_uart_in(e, 2, '1');
    emu_uart_in(e, 2, '2'); /* overrun: the second is lost */
    TEST_ASSERT_EQUAL_HEX32(0x28, rd(e, U + 0x1c) & 0x28u);
    TEST_ASSERT_EQUAL('1', rd(e, U + 0x24));
    TEST_ASSERT_EQUAL_HEX32(8, rd(e, U + 0x1c) & 0x28u);
    wr(e, U + 0x20, 8);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, U + 0x1c) & 0x28u);
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    rd(e, U + 0x24);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "USART2", "RDR"));
    wr(e, U, 0);
    TEST_ASSERT_FALSE(emu_uart_in(e, 2, 'q'));
}

/* ---- USART v1 (RM0090 30.6) ---- */

static void test_v1(void)
{
    start(&emu_f405);
    set(e, F4_RCC + 0x40, 1u << 17);
    set(e, F4_RCC + 0x30, 1);
    set(e, F4_GPIOA + 0x20, 0x7700);
    set(e, F4_GPIOA, 0xa0);
    wr(e, U + 8, 139); /* 16 MHz / 115200 */
    wr(e, U + 0x0c, 0x202c);
    wr(e, U + 4, 'z');
    advance_us(e, 88);
    TEST_ASSERT_EQUAL(1, w.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0xc0, rd(e, U));
    emu_uart_in(e, 2, '1');
    emu_uart_in(e, 2, '2');
    TEST_ASSERT_TRUE(pending(e, 38));
    TEST_ASSERT_EQUAL('1', rd(e, U + 4));
    TEST_ASSERT_EQUAL_HEX32(0xc8, rd(e, U)); /* ORE: only a read of SR before that of DR clears it */
    rd(e, U + 4);
    TEST_ASSERT_EQUAL_HEX32(0xc0, rd(e, U));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

/* ---- SysTick (PM0215 4.4) ---- */

static void test_systick(void)
{
    wr(e, 0xe000e014u, 999);
    wr(e, 0xe000e018u, 0);
    wr(e, 0xe000e010u, 5); /* without interrupt, core clock */
    advance_us(e, 100);
    TEST_ASSERT_INT_WITHIN(1, 200, rd(e, 0xe000e018u));
    TEST_ASSERT_EQUAL_HEX32(5, rd(e, 0xe000e010u));
    advance_us(e, 30);
    TEST_ASSERT_EQUAL_HEX32(0x10005, rd(e, 0xe000e010u)); /* COUNTFLAG, cleared by this read */
    TEST_ASSERT_EQUAL_HEX32(5, rd(e, 0xe000e010u));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, 0xe000ed04u) & 1u << 26);
    wr(e, 0xe000e010u, 7);
    advance_us(e, 130);
    TEST_ASSERT_EQUAL_HEX32(1u << 26, rd(e, 0xe000ed04u) & 1u << 26);
    wr(e, 0xe000ed04u, 1u << 25);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, 0xe000ed04u) & 1u << 26);
}

static void test_core_judge(void)
{
    wr8(e, 0xe000e400u, 0x40); /* Cortex-M0: words only */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "SCS", "IPR"));
    wr(e, 0xe000ed0cu, 4); /* no key */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "SCS", "AIRCR"));
    TEST_ASSERT_EQUAL(0, emu_get_meter(e)->resets[EMU_CAUSE_SOFTWARE]);
    wr(e, 0xe000ed0cu, 0x05fa0004u);
    TEST_ASSERT_EQUAL(1, emu_get_meter(e)->resets[EMU_CAUSE_SOFTWARE]);
    wr(e, 0xe000ed08u, 0x100); /* no VTOR on this core */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "SCS", "SCB"));
    rd(e, 0x40007c00u); /* nothing there */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "BUS", "hole"));
    uint32_t v;
    TEST_ASSERT_FALSE(emu_bus_read(e, 0x50000000u, 4, &v));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_counter);
    RUN_TEST(test_prescaler_is_preloaded);
    RUN_TEST(test_compare);
    RUN_TEST(test_update_by_software);
    RUN_TEST(test_short_periods);
    RUN_TEST(test_what_is_not_modelled_is_said);
    RUN_TEST(test_watchdog_bites_in_time);
    RUN_TEST(test_watchdog_mistakes);
    RUN_TEST(test_watchdog_window);
    RUN_TEST(test_watchdog_of_f4);
    RUN_TEST(test_bytes_take_their_time);
    RUN_TEST(test_transmit_mistakes);
    RUN_TEST(test_unusual_speed);
    RUN_TEST(test_receive);
    RUN_TEST(test_v1);
    RUN_TEST(test_systick);
    RUN_TEST(test_core_judge);
    return UNITY_END();
}
