/* SPDX-License-Identifier: Apache-2.0 */
/* ADC1 (RM0090 13.3, 13.13) with DMA2 in a circle (RM0090 10.3). APB2 / 2 = 5.25 MHz; 480 + 12 cycles a
 * conversion. */
#include "stm32_chip.h"
#include "stm32_time.h"
#include "stm32f4_adc.h"

typedef struct stm32_adc_regs {
    volatile uint32_t sr, cr1, cr2;
    volatile uint32_t smpr[2]; /* channels 10..18, 0..9: 3 bits each */
    volatile uint32_t jofr[4], htr, ltr;
    volatile uint32_t sqr[3]; /* number of conversions - 1; ...; the first six channels */
    volatile uint32_t jsqr, jdr[4], dr;
} stm32_adc_regs;

#define ADC1 ((stm32_adc_regs *)(uintptr_t)0x40012000u)
#define ADC_CCR STM32_REG(0x40012304u)
#define SR_OVR (1u << 5)
#define CR2_ADON (1u << 0)
#define CR2_CONT (1u << 1)
#define CR2_DMA (1u << 8)
#define CR2_DDS (1u << 9) /* DMA goes on after its last item: a circle */
#define CR2_SWSTART (1u << 30)
#define SMP_480_CYCLES 7u
#define START_UP_US 3u

#define STREAM 4u
#define CHANNEL 0u

static void start_dma(stm32_adc *a)
{
    stm32_dma_stream *d = &STM32_DMA2->stream[STREAM];
    (void)stm32_dma_stop(STREAM);
    stm32_dma_clear(STREAM, STM32_DMA_ALL);
    d->par = (uint32_t)(uintptr_t)&ADC1->dr;
    d->m0ar = (uint32_t)(uintptr_t)a->sample;
    d->ndtr = STM32_ADC_SAMPLES;
    d->cr = STM32_DMA_CR_CHANNEL(CHANNEL) | STM32_DMA_CR_PRIORITY(2) | STM32_DMA_CR_MINC | STM32_DMA_CR_CIRC |
            STM32_DMA_CR_PSIZE16 | STM32_DMA_CR_MSIZE16;
    d->cr |= STM32_DMA_CR_EN;
}

static void start(stm32_adc *a)
{
    a->filled = false;
    a->left = STM32_ADC_SAMPLES;
    ADC1->cr2 = 0;
    ADC1->sr = 0;
    start_dma(a);
    ADC1->cr1 = 0; /* 12 bits */
    ADC1->smpr[a->channel >= 10u ? 0 : 1] = SMP_480_CYCLES << 3u * (a->channel % 10u);
    ADC1->sqr[0] = 0;
    ADC1->sqr[2] = a->channel;
    ADC1->cr2 = CR2_DMA | CR2_DDS | CR2_CONT | CR2_ADON;
    stm32_wait_us(START_UP_US);
    ADC1->cr2 |= CR2_SWSTART;
}

void stm32_adc_init(stm32_adc *adc, unsigned channel, uint16_t zero, int32_t half_ma)
{
    adc->channel = (uint8_t)channel;
    adc->zero = zero;
    adc->half_ma = half_ma;
    STM32_RCC_APB2ENR |= STM32_APB2_ADC1;
    STM32_RCC_AHB1ENR |= STM32_AHB1_DMA2;
    (void)STM32_RCC_AHB1ENR;
    ADC_CCR = 0; /* APB2 / 2; one ADC alone */
    start(adc);
}

/* Whether conversions have come since the last call. */
static bool renewed(stm32_adc *a)
{
    uint32_t left = STM32_DMA2->stream[STREAM].ndtr;
    bool round = (stm32_dma_flags(STREAM) & STM32_DMA_TCIF) != 0u;
    bool moved = left != a->left;
    if (round) {
        stm32_dma_clear(STREAM, STM32_DMA_TCIF | STM32_DMA_HTIF);
        a->filled = true;
    }
    a->left = left;
    return a->filled && (round || moved);
}

static int32_t mean_ma(const stm32_adc *a)
{
    int32_t sum = -(int32_t)(a->zero * STM32_ADC_SAMPLES);
    for (unsigned i = 0; i < STM32_ADC_SAMPLES; i++) {
        sum += a->sample[i];
    }
    return (int32_t)((int64_t)sum * a->half_ma / (2048 * (int32_t)STM32_ADC_SAMPLES));
}

static bq_status ammeter_read(void *ctx, int32_t *current_ma)
{
    stm32_adc *a = ctx;
    if (current_ma == NULL) {
        return BQ_E_ARG;
    }
    if ((ADC1->sr & SR_OVR) != 0u || (stm32_dma_flags(STREAM) & (STM32_DMA_TEIF | STM32_DMA_DMEIF)) != 0u) {
        start(a);
        return BQ_E_BUS;
    }
    if (!renewed(a)) {
        return BQ_E_STALE;
    }
    *current_ma = mean_ma(a);
    return BQ_OK;
}

bq_ammeter stm32_adc_ammeter(stm32_adc *adc)
{
    bq_ammeter ammeter = {ammeter_read, adc};
    return ammeter;
}
