/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32f4_adc.h
 * ADC1 on one channel as the ammeter of bqhost/hal.h: it converts all the time, DMA2 stream 4 keeps the last
 * STM32_ADC_SAMPLES results, a reading is their mean (6.0 ms of current). No interrupt.
 */
#ifndef STM32F4_ADC_H
#define STM32F4_ADC_H

#include "bqhost/hal.h"

#define STM32_ADC_SAMPLES 64u /**< a power of two */

/** One ammeter; the board owns it. */
typedef struct stm32_adc {
    volatile uint16_t sample[STM32_ADC_SAMPLES];
    uint8_t channel;
    bool filled;     /* every sample was written */
    uint32_t left;   /* items DMA had left in its round when read last */
    int32_t half_ma; /**< current that changes the reading by half of its range */
    uint16_t zero;   /**< reading without current */
} stm32_adc;

/** Clocks and starts ADC1 and DMA2. The pin of `channel` (0..15) is analog in the board's table. `zero` and
 * `half_ma` as above: the current is (mean - zero) / 2048 x half_ma. Blocks for 4 us. */
void stm32_adc_init(stm32_adc *adc, unsigned channel, uint16_t zero, int32_t half_ma);

/** read as in bqhost/hal.h. BQ_E_STALE also until STM32_ADC_SAMPLES conversions are there. BQ_E_BUS:
 * conversions or DMA failed; both were started again. */
bq_ammeter stm32_adc_ammeter(stm32_adc *adc);

#endif
