/* SPDX-License-Identifier: Apache-2.0 */
/* ADC1 of the STM32F4 from outside. */
#include "outside.h"

#define ADC 0x40012000u
#define SR (ADC + 0x00)
#define CR1 (ADC + 0x04)
#define CR2 (ADC + 0x08)
#define SMPR1 (ADC + 0x0c)
#define SMPR2 (ADC + 0x10)
#define SQR1 (ADC + 0x2c)
#define SQR3 (ADC + 0x34)
#define DR (ADC + 0x4c)
#define CCR (ADC + 0x304)

enum { EOC = 2, OVR = 0x20, ADON = 1, CONT = 2, DMA = 0x100, EOCS = 0x400, ALIGN = 0x800 };
#define SWSTART (1u << 30)

static void enabled(void)
{
    set_bits(0x40023844u, 1u << 8); /* RCC_APB2ENR: ADC1 */
    pin_function(2, 0, 16, false);  /* PC0, channel 10 */
    put(SQR3, 10);
    put(CR2, ADON);
    pass(4 * US);
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

static uint32_t convert(void)
{
    set_bits(CR2, SWSTART);
    (void)until(SR, EOC, 100, __LINE__);
    return get(DR);
}

static void test_volts_become_codes(void)
{
    static const struct {
        double volts;
        unsigned code;
    } row[] = {{0.0, 0}, {1.650, 2048}, {3.299, 4094}, {3.3, 4095}, {5.0, 4095}, {-1.0, 0}, {0.8253, 1024}};

    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        out.volts[10] = row[i].volts;
        TEST_ASSERT_EQUAL(row[i].code, convert());
        TEST_ASSERT_EQUAL(0, get(SR) & EOC);
    }
    NO_MISUSE();
}

static void test_the_time_is_sampling_and_twelve_cycles(void)
{
    /* 16 MHz / 2 = 8 MHz: 3 + 12 cycles = 1.875 us, 480 + 12 cycles = 61.5 us */
    set_bits(CR2, SWSTART);
    TEST_ASSERT_INT_WITHIN(60, 1875, (long long)until(SR, EOC, 25, __LINE__));
    (void)get(DR);
    put(SMPR1, 7);
    set_bits(CR2, SWSTART);
    TEST_ASSERT_INT_WITHIN(60, 61500, (long long)until(SR, EOC, 25, __LINE__));
    (void)get(DR);
    put(CCR, 1u << 16);
    set_bits(CR2, SWSTART);
    TEST_ASSERT_INT_WITHIN(60, 123000, (long long)until(SR, EOC, 25, __LINE__));
}

static void test_resolution_and_alignment(void)
{
    out.volts[10] = 1.650;
    put(CR1, 2u << 24);
    TEST_ASSERT_EQUAL(128, convert());
    put(CR1, 0);
    set_bits(CR2, ALIGN);
    TEST_ASSERT_EQUAL_HEX16(0x8000, convert());
}

static void test_end_of_conversion_interrupts(void)
{
    put(CR1, 1 << 5);
    set_bits(CR2, SWSTART);
    pass(5 * US);
    TEST_ASSERT_TRUE(irq_pending(18));
    (void)get(DR);
    irq_clear(18);
    TEST_ASSERT_FALSE(irq_pending(18));
}

static void test_continuous_conversions_by_dma(void)
{
    uint16_t value[3];

    set_bits(0x40023830u, 1u << 22);
    put(0x40026470u + 0x08, DR); /* DMA2 stream 4, channel 0 */
    put(0x40026470u + 0x0c, 0x20000100u);
    put(0x40026470u + 0x04, 3);
    put(0x40026470u, 1u << 10 | 1u << 11 | 1u << 13 | 1u);
    out.volts[10] = 1.650;
    put(CR2, ADON | DMA | CONT | SWSTART);
    pass(20 * US);
    TEST_ASSERT_TRUE(emu_peek(chip, 0x20000100u, value, 6));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(2048, value[i]);
    }
    /* nobody fetches the fourth: the fifth overruns */
    MISUSE("ADC1", "DR", "overrun");
    TEST_ASSERT_EQUAL(OVR, get(SR) & OVR);
    put(SR, ~(uint32_t)OVR);
    TEST_ASSERT_EQUAL(0, get(SR) & OVR);
}

static void test_a_sequence_with_a_flag_for_each(void)
{
    pin_function(0, 1, 16, false); /* PA1, channel 1 */
    put(CR1, 1 << 8);
    put(SQR1, 1u << 20);
    put(SQR3, 10 | 1 << 5);
    out.volts[10] = 1.650;
    out.volts[1] = 0.8253;
    put(CR2, ADON | EOCS | SWSTART);
    (void)until(SR, EOC, 100, __LINE__);
    TEST_ASSERT_EQUAL(2048, get(DR));
    (void)until(SR, EOC, 100, __LINE__);
    TEST_ASSERT_EQUAL(1024, get(DR));
    NO_MISUSE();
}

/* ---- mistakes
 * ------------------------------------------------------------------------------------------------------------
 */

static void test_start_without_power(void)
{
    put(CR2, 0);
    put(CR2, SWSTART);
    MISUSE("ADC1", "CR2", "ADON is not set");
}

static void test_start_before_it_is_stable(void)
{
    put(CR2, 0);
    put(CR2, ADON);
    pass(2900);
    put(CR2, ADON | SWSTART);
    MISUSE("ADC1", "CR2", "3 us");
}

static void test_start_and_changes_during_a_conversion(void)
{
    set_bits(CR2, SWSTART);
    set_bits(CR2, SWSTART);
    MISUSE("ADC1", "CR2", "during a conversion");
    put(SMPR2, 1);
    MISUSE("ADC1", "SQR3", "changed during a conversion");
}

static void test_a_result_that_is_not_there(void)
{
    (void)get(DR);
    MISUSE("ADC1", "DR", "EOC is not set");
}

static void test_a_pin_that_is_not_analog(void)
{
    put(SQR3, 11);
    set_bits(CR2, SWSTART);
    MISUSE("ADC1", "SQR3", "channel 11");
    pass(10 * US);
    put(SQR3, 31);
    set_bits(CR2, SWSTART);
    MISUSE("ADC1", "SQR3", "does not exist");
}

static void test_what_is_not_modelled_is_told(void)
{
    put(CR2, ADON | 1u << 28);
    MISUSE("ADC1", "CR2", "not modelled");
    put(CR1, 1u << 23);
    MISUSE("ADC1", "CR1", "not modelled");
    put(ADC + 0x38, 1);
    MISUSE("ADC1", "JSQR", "not modelled");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_volts_become_codes);
    RUN_TEST(test_the_time_is_sampling_and_twelve_cycles);
    RUN_TEST(test_resolution_and_alignment);
    RUN_TEST(test_end_of_conversion_interrupts);
    RUN_TEST(test_continuous_conversions_by_dma);
    RUN_TEST(test_a_sequence_with_a_flag_for_each);
    RUN_TEST(test_start_without_power);
    RUN_TEST(test_start_before_it_is_stable);
    RUN_TEST(test_start_and_changes_during_a_conversion);
    RUN_TEST(test_a_result_that_is_not_there);
    RUN_TEST(test_a_pin_that_is_not_analog);
    RUN_TEST(test_what_is_not_modelled_is_told);
    return UNITY_END();
}
