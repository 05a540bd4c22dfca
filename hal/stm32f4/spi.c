/* SPDX-License-Identifier: Apache-2.0 */
/* SPI of generation 1 with DMA (RM0090 28.3, 28.5, 10.3). */
#include "stm32_chip.h"
#include "stm32_core.h"
#include "stm32_gpio.h"
#include "stm32f4_spi.h"

typedef struct stm32_spi_regs {
    volatile uint32_t cr1, cr2, sr, dr;
} stm32_spi_regs;

#define SPI1 ((stm32_spi_regs *)(uintptr_t)0x40013000u)
#define CR1_CPHA (1u << 0)
#define CR1_MSTR (1u << 2)
#define CR1_BR(n) ((uint32_t)(n) << 3)
#define CR1_SPE (1u << 6)
#define CR1_SSI (1u << 8)
#define CR1_SSM (1u << 9)
#define CR2_RXDMAEN (1u << 0)
#define CR2_TXDMAEN (1u << 1)
#define CR2_ERRIE (1u << 5)
#define SR_TXE (1u << 1)
#define SR_MODF (1u << 5)
#define SR_OVR (1u << 6)
#define SR_BSY (1u << 7)

#define RX_STREAM 0u
#define TX_STREAM 3u
#define CHANNEL 3u
#define RATES 8u
#define CS_HIGH_US 4u /* 3 us (PL-SPI-04) and the resolution of the clock */
#define PIN_OUTPUT 1u
#define PIN_AF 2u

/* ---- pieces
 * ------------------------------------------------------------------------------------------------ */

static uint32_t hertz(unsigned rate)
{
    return STM32_APB2_HZ >> (rate + 1u);
}

/* The shortest divider, 2 << result, that keeps `hz`; RATES if there is none. */
static unsigned divider(uint32_t hz)
{
    unsigned rate = 0;
    while (rate < RATES && hertz(rate) > hz) {
        rate++;
    }
    return rate;
}

uint32_t stm32_spi_rate(uint32_t hz)
{
    unsigned rate = divider(hz);
    return rate < RATES ? hertz(rate) : 0u;
}

static void configure(const stm32_spi *s)
{
    SPI1->cr1 = CR1_CPHA | CR1_MSTR | CR1_SSM | CR1_SSI | CR1_BR(s->rate);
    SPI1->cr2 = 0;
}

/* SCK and MOSI to SPI1 or to the low level their outputs have. */
static void set_pins(const stm32_spi *s, uint32_t mode)
{
    stm32_gpio_regs *port = stm32_port(s->port);
    uint32_t mask = 3u << 2u * s->sck | 3u << 2u * s->mosi;
    uint32_t value = mode << 2u * s->sck | mode << 2u * s->mosi;
    port->moder = (port->moder & ~mask) | value;
}

static void arm(unsigned stream, uint32_t memory, size_t len, uint32_t cr)
{
    stm32_dma_stream *d = &STM32_DMA2->stream[stream];
    stm32_dma_clear(stream, STM32_DMA_ALL);
    d->par = (uint32_t)(uintptr_t)&SPI1->dr;
    d->m0ar = memory;
    d->ndtr = (uint32_t)len;
    d->cr = cr | STM32_DMA_CR_CHANNEL(CHANNEL) | STM32_DMA_CR_MINC | STM32_DMA_CR_TEIE | STM32_DMA_CR_DMEIE;
    d->cr |= STM32_DMA_CR_EN;
}

/* Chip select high, lines low. */
static void release(stm32_spi *s)
{
    stm32_pin_write(s->port, s->cs, true);
    s->released_us = stm32_now_us();
    set_pins(s, PIN_OUTPUT);
}

static void end(stm32_spi *s)
{
    release(s);
    SPI1->cr1 &= ~CR1_SPE;
    SPI1->cr2 = 0;
    s->busy = false;
    s->result = BQ_OK;
}

/* After an error nothing in the peripheral is trusted, and nothing of the packet is waited for. */
static void give_up(stm32_spi *s, bq_status result)
{
    release(s);
    (void)stm32_dma_stop(TX_STREAM);
    (void)stm32_dma_stop(RX_STREAM);
    STM32_RCC_APB2RSTR |= STM32_APB2_SPI1;
    STM32_RCC_APB2RSTR &= ~STM32_APB2_SPI1;
    configure(s);
    s->busy = false;
    s->result = result;
}

/* ---- interrupt
 * --------------------------------------------------------------------------------------------- */

void stm32_spi_irq(stm32_spi *s)
{
    uint32_t rx = stm32_dma_flags(RX_STREAM), tx = stm32_dma_flags(TX_STREAM);
    stm32_dma_clear(RX_STREAM, rx);
    stm32_dma_clear(TX_STREAM, tx);
    if (((rx | tx) & (STM32_DMA_TEIF | STM32_DMA_DMEIF)) != 0u) {
        s->failed = true;
    }
    if ((rx & STM32_DMA_TCIF) != 0u) {
        s->received = true;
    }
    if ((SPI1->cr2 & CR2_ERRIE) != 0u && (SPI1->sr & (SR_OVR | SR_MODF)) != 0u) {
        SPI1->cr2 &= ~CR2_ERRIE; /* told once; the reset in give_up() clears it */
        s->failed = true;
    }
    stm32_time_event(s->time);
}

/* ---- bus
 * --------------------------------------------------------------------------------------------------- */

static void wait_chip_select(const stm32_spi *s)
{
    while (stm32_now_us() - s->released_us < CS_HIGH_US) {
    }
}

/* SPI is on before the pins are its own, and the pins before chip select falls, so that SCK is low all the
 * time. The receiver stands ready before the first byte is asked for. */
static bq_status spi_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    stm32_spi *s = ctx;
    if (tx == NULL || rx == NULL || len < 1u || len > 256u) {
        return BQ_E_ARG;
    }
    if (s->busy) {
        return BQ_E_BUSY;
    }
    s->busy = true;
    s->received = false;
    s->failed = false;
    wait_chip_select(s);
    s->from_us = stm32_now_us();
    s->limit_us = 2u * ((uint32_t)len * 8000000u / hertz(s->rate)) + 1000u;
    SPI1->cr2 = CR2_RXDMAEN | CR2_ERRIE;
    SPI1->cr1 |= CR1_SPE;
    set_pins(s, PIN_AF);
    stm32_pin_write(s->port, s->cs, false);
    stm32_dsb(); /* `tx` is in memory */
    arm(RX_STREAM, (uint32_t)(uintptr_t)rx, len, STM32_DMA_CR_TCIE | STM32_DMA_CR_PRIORITY(3));
    arm(TX_STREAM, (uint32_t)(uintptr_t)tx, len, STM32_DMA_CR_FROM_MEMORY | STM32_DMA_CR_PRIORITY(1));
    SPI1->cr2 = CR2_RXDMAEN | CR2_ERRIE | CR2_TXDMAEN;
    return BQ_OK;
}

/* The last byte is stored at its last sampling edge; the clock may still be at its end. */
static bool line_idle(void)
{
    return (SPI1->sr & (SR_TXE | SR_BSY)) == SR_TXE;
}

static bq_status spi_poll(void *ctx)
{
    stm32_spi *s = ctx;
    if (!s->busy) {
        return s->result;
    }
    if (s->failed || (SPI1->sr & (SR_OVR | SR_MODF)) != 0u) {
        give_up(s, BQ_E_BUS);
    } else if (s->received && line_idle()) {
        stm32_dsb();
        end(s);
    } else if (stm32_now_us() - s->from_us > s->limit_us) {
        give_up(s, BQ_E_TIMEOUT);
    } else {
        return BQ_PENDING;
    }
    return s->result;
}

static bq_status spi_set_clock(void *ctx, uint32_t hz)
{
    stm32_spi *s = ctx;
    unsigned rate = divider(hz);
    if (s->busy) {
        return BQ_E_BUSY;
    }
    if (rate >= RATES) {
        return BQ_E_RANGE;
    }
    s->rate = (uint8_t)rate;
    configure(s);
    return BQ_OK;
}

/* ---- set-up
 * ------------------------------------------------------------------------------------------------ */

void stm32_spi_init(stm32_spi *spi, stm32_time *time, unsigned port, unsigned cs, unsigned sck, unsigned mosi)
{
    spi->time = time;
    spi->port = (uint8_t)port;
    spi->cs = (uint8_t)cs;
    spi->sck = (uint8_t)sck;
    spi->mosi = (uint8_t)mosi;
    spi->rate = RATES - 1u;
    spi->busy = false;
    spi->result = BQ_OK;
    spi->released_us = stm32_now_us();
    STM32_RCC_APB2ENR |= STM32_APB2_SPI1;
    STM32_RCC_AHB1ENR |= STM32_AHB1_DMA2;
    (void)STM32_RCC_AHB1ENR;
    configure(spi);
    stm32_irq_enable(STM32_IRQ_SPI1, 1);
    stm32_irq_enable(STM32_IRQ_DMA2_S0, 1);
    stm32_irq_enable(STM32_IRQ_DMA2_S3, 1);
}

bq_spi stm32_spi_bus(stm32_spi *spi)
{
    static const bq_spi_ops ops = {spi_start, spi_poll, spi_set_clock};
    bq_spi bus = {&ops, spi};
    return bus;
}
