/* SPDX-License-Identifier: Apache-2.0 */
/* Clock controllers, reset flags, voltage detector (RM0091 sections 6 and 7, RM0090 sections 5 and 7). */
#include "emu_periph.h"
#include "regs.h"
#include "unity.h"

#define CR 0x00u
#define HSEON (1u << 16)
#define HSERDY (1u << 17)
#define CSSON (1u << 19)
#define PLLON (1u << 24)
#define PLLRDY (1u << 25)

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

/* HSE 8 MHz, PLL times 6: 48 MHz, one wait state */
static void f0_to_48_mhz(void)
{
    set(e, F0_RCC + CR, HSEON);
    advance_us(e, 3000);
    wr(e, F0_FLASH, 0x11);
    wr(e, F0_RCC + 0x04, 4u << 18 | 2u << 15);
    set(e, F0_RCC + CR, PLLON);
    advance_us(e, 300);
    set(e, F0_RCC + 0x04, 2);
}

static void f4_to_168_mhz(void)
{
    set(e, F4_RCC + CR, HSEON);
    advance_us(e, 3000);
    wr(e, F4_RCC + 0x04, 0x20000000u | 7u << 24 | 1u << 22 | 336u << 6 | 8u); /* M 8, N 336, P 2, Q 7 */
    wr(e, F4_RCC + 0x08, 5u << 10 | 4u << 13);                                /* APB1 / 4, APB2 / 2 */
    set(e, F4_RCC + CR, PLLON);
    advance_us(e, 300);
    wr(e, F4_FLASH, 0x705);
    set(e, F4_RCC + 0x08, 2);
}

static void test_both_start_from_hsi(void)
{
    TEST_ASSERT_EQUAL(8000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL_HEX32(3, rd(e, F0_RCC) & 3u);
    start(&emu_f405);
    TEST_ASSERT_EQUAL(16000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL_HEX32(0x24003010, rd(e, F4_RCC + 0x04));
    TEST_ASSERT_EQUAL_HEX32(0x00100000, rd(e, F4_RCC + 0x30));
}

static void test_f0_to_full_speed(void)
{
    set(e, F0_RCC, HSEON);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_RCC) & HSERDY); /* it takes its time */
    f0_to_48_mhz();
    TEST_ASSERT_EQUAL_HEX32(2u << 2, rd(e, F0_RCC + 0x04) & 12u);
    TEST_ASSERT_EQUAL(48000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL(48000000, emu_bus_hz(e, EMU_APB1));
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_f4_to_full_speed(void)
{
    start(&emu_f405);
    f4_to_168_mhz();
    TEST_ASSERT_EQUAL_HEX32(2u << 2, rd(e, F4_RCC + 0x08) & 12u);
    TEST_ASSERT_EQUAL(168000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL(42000000, emu_bus_hz(e, EMU_APB1));
    TEST_ASSERT_EQUAL(84000000, emu_bus_hz(e, EMU_APB2));
    TEST_ASSERT_EQUAL(84000000,
                      emu_kernel_hz(e, emu_periph_find(e, "TIM2")->at)); /* timers run at twice PCLK1 */
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_hsi48(void)
{
    set(e, F0_RCC + 0x34, 1u << 16);
    advance_us(e, 10);
    TEST_ASSERT_EQUAL_HEX32(1u << 17, rd(e, F0_RCC + 0x34) & 1u << 17);
    wr(e, F0_FLASH, 0x11);
    wr(e, F0_RCC + 0x04, 3);
    TEST_ASSERT_EQUAL(48000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL_HEX32(0xf, rd(e, F0_RCC + 0x04) & 15u);
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
}

static void test_mistakes_with_the_clock(void)
{
    wr(e, F0_RCC + 0x04, 1); /* SW to a source that is off */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "RCC", "CFGR"));
    TEST_ASSERT_EQUAL(8000000, emu_bus_hz(e, EMU_AHB));
    wr(e, F0_RCC + 0x04, 2u << 15);
    set(e, F0_RCC, PLLON); /* PLL without HSE */
    TEST_ASSERT_EQUAL(2, emu_misuse_of(e, "RCC", "CR") + emu_misuse_of(e, "RCC", "CFGR"));
    wr(e, F0_RCC + 0x04, 4u << 18 | 2u << 15); /* changed while on */
    TEST_ASSERT_EQUAL(2, emu_misuse_of(e, "RCC", "CFGR"));
    start(&emu_f072);
    clear(e, F0_RCC, 1); /* HSI off while in use */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "RCC", "CR"));
    TEST_ASSERT_EQUAL_HEX32(1, rd(e, F0_RCC) & 1u);
}

static void test_missing_wait_states(void)
{
    set(e, F0_RCC + 0x34, 1u << 16);
    advance_us(e, 10);
    wr(e, F0_RCC + 0x04, 3);
    TEST_ASSERT_GREATER_OR_EQUAL(1, emu_misuse_of(e, "FLASH", "ACR"));
    start(&emu_f405);
    f4_to_168_mhz();
    TEST_ASSERT_EQUAL(0, misuse(e, NULL));
    wr(e, F4_FLASH, 0x704);
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "FLASH", "ACR"));
}

static void test_too_fast_a_bus(void)
{
    start(&emu_f405);
    f4_to_168_mhz();
    wr(e, F4_RCC + 0x08, 4u << 10 | 4u << 13 | 2u); /* APB1 at 84 MHz */
    TEST_ASSERT_EQUAL(1, emu_misuse_of(e, "RCC", "CFGR"));
}

static void test_a_crystal_that_never_starts(void)
{
    emu_set_crystal(e, false);
    set(e, F0_RCC, HSEON);
    advance_us(e, 1000000);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_RCC) & HSERDY);
    TEST_ASSERT_EQUAL(8000000, emu_bus_hz(e, EMU_AHB));
}

static void test_a_crystal_that_fails_is_caught_by_the_security_system(void)
{
    f0_to_48_mhz();
    set(e, F0_RCC, CSSON);
    emu_set_crystal(e, false);
    TEST_ASSERT_EQUAL(8000000, emu_bus_hz(e, EMU_AHB));
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_RCC + 0x04) & 12u);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_RCC) & (HSEON | HSERDY | PLLON | CSSON));
    TEST_ASSERT_EQUAL_HEX32(1u << 7, rd(e, F0_RCC + 0x08));
    TEST_ASSERT_EQUAL_HEX32(1u << 31, rd(e, 0xe000ed04u) & 1u << 31); /* NMI pending */
    wr(e, F0_RCC + 0x08, 1u << 23);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, F0_RCC + 0x08));
}

static void test_a_dividing_timer_keeps_its_rate_over_a_clock_change(void)
{
    set(e, F0_RCC + 0x1c, 1);
    wr(e, TIM2_BASE + 0x28, 7);
    wr(e, TIM2_BASE + 0x14, 1);
    wr(e, TIM2_BASE, 1);
    advance_us(e, 1000);
    set(e, F0_RCC + 0x34, 1u << 16);
    advance_us(e, 1000);
    wr(e, F0_FLASH, 0x11);
    wr(e, F0_RCC + 0x04, 3);
    TEST_ASSERT_INT_WITHIN(1, 2000, rd(e, TIM2_BASE + 0x24));
    advance_us(e, 1000);
    TEST_ASSERT_INT_WITHIN(1, 8000, rd(e, TIM2_BASE + 0x24));
}

static uint32_t flags(uint32_t csr)
{
    return rd(e, csr) & 0xfe800000u;
}

static void test_reset_flags(void)
{
    const uint32_t csr = F0_RCC + 0x24;

    TEST_ASSERT_EQUAL_HEX32(1u << 27 | 1u << 26 | 1u << 23, flags(csr));
    emu_reset(e, EMU_CAUSE_SOFTWARE);
    TEST_ASSERT_EQUAL_HEX32(1u << 28 | 1u << 27 | 1u << 26 | 1u << 23, flags(csr)); /* they add up */
    wr(e, csr, 1u << 24);
    TEST_ASSERT_EQUAL_HEX32(0, flags(csr));
    emu_reset(e, EMU_CAUSE_IWDG);
    TEST_ASSERT_EQUAL_HEX32(1u << 29 | 1u << 26, flags(csr));
    wr(e, csr, 1u << 24);
    emu_reset(e, EMU_CAUSE_PIN);
    TEST_ASSERT_EQUAL_HEX32(1u << 26, flags(csr));
    start(&emu_f405);
    TEST_ASSERT_EQUAL_HEX32(1u << 27 | 1u << 26 | 1u << 25, flags(F4_RCC + 0x74));
    emu_reset(e, EMU_CAUSE_BROWNOUT);
    TEST_ASSERT_EQUAL_HEX32(1u << 26 | 1u << 25, flags(F4_RCC + 0x74));
}

static void test_reset_register_resets_a_peripheral(void)
{
    set(e, F0_RCC + 0x1c, 1);
    wr(e, TIM2_BASE + 0x2c, 1000);
    set(e, F0_RCC + 0x10, 1);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, TIM2_BASE + 0x2c));
    TEST_ASSERT_EQUAL(1, misuse(e, "TIM2")); /* still held in reset */
    clear(e, F0_RCC + 0x10, 1);
    TEST_ASSERT_EQUAL_HEX32(0xffffffff, rd(e, TIM2_BASE + 0x2c));
}

static void test_voltage_detector(void)
{
    set(e, F0_RCC + 0x1c, 1u << 28);
    set(e, F0_RCC + 0x18, 1);
    wr(e, F0_EXTI, 1u << 16);
    wr(e, F0_EXTI + 0x08, 1u << 16);
    wr(e, PWR_BASE, 7u << 5 | 1u << 4); /* 2.88 V rising */
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, PWR_BASE + 4) & 4u);
    emu_set_supply_mv(e, 2500);
    TEST_ASSERT_EQUAL_HEX32(4, rd(e, PWR_BASE + 4) & 4u);
    TEST_ASSERT_TRUE(pending(e, 1));
    emu_set_supply_mv(e, 2850); /* hysteresis */
    TEST_ASSERT_EQUAL_HEX32(4, rd(e, PWR_BASE + 4) & 4u);
    emu_set_supply_mv(e, 3300);
    TEST_ASSERT_EQUAL_HEX32(0, rd(e, PWR_BASE + 4) & 4u);
}

static void test_power_lost_and_back(void)
{
    uint32_t v = 0x55aa55aau, now;

    emu_poke(e, 0x20000000u, &v, 4);
    wr(e, F0_RCC + 0x24, 1u << 24);
    emu_set_supply_mv(e, 1000);
    advance_us(e, 10);
    emu_set_supply_mv(e, 3300);
    advance_us(e, 10);
    TEST_ASSERT_EQUAL_HEX32(1u << 27 | 1u << 26 | 1u << 23, flags(F0_RCC + 0x24));
    emu_peek(e, 0x20000000u, &now, 4);
    TEST_ASSERT_NOT_EQUAL(v, now);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_both_start_from_hsi);
    RUN_TEST(test_f0_to_full_speed);
    RUN_TEST(test_f4_to_full_speed);
    RUN_TEST(test_hsi48);
    RUN_TEST(test_mistakes_with_the_clock);
    RUN_TEST(test_missing_wait_states);
    RUN_TEST(test_too_fast_a_bus);
    RUN_TEST(test_a_crystal_that_never_starts);
    RUN_TEST(test_a_crystal_that_fails_is_caught_by_the_security_system);
    RUN_TEST(test_a_dividing_timer_keeps_its_rate_over_a_clock_change);
    RUN_TEST(test_reset_flags);
    RUN_TEST(test_reset_register_resets_a_peripheral);
    RUN_TEST(test_voltage_detector);
    RUN_TEST(test_power_lost_and_back);
    return UNITY_END();
}
