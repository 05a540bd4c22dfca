/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32f4_spi.h
 * SPI1 as master for a stack of bq76PL536: mode 1, 8 bits, most significant first, chip select by software,
 * DMA2 (stream 0 receives, stream 3 sends). Outside packets SCK and MOSI are outputs at low level
 * (PL-SPI-11); they belong to SPI1 only while chip select is low.
 */
#ifndef STM32F4_SPI_H
#define STM32F4_SPI_H

#include "bqhost/hal.h"
#include "stm32_time.h"

/** One bus; the board owns it. The pins share one port and stand in the board's table: `cs` as output,
 * initially high, `sck` and `mosi` as outputs, initially low, with the number of SPI1 as alternate function,
 * `miso` as alternate function. */
typedef struct stm32_spi {
    stm32_time *time;
    uint8_t port, cs, sck, mosi;
    uint8_t rate;               /* SCK is APB2 divided by 2 << rate */
    bool busy;                  /* a packet is on its way, or its outcome was not asked for */
    bq_status result;           /* of the last packet */
    volatile bool received;     /* DMA has stored the last byte */
    volatile bool failed;       /* DMA or SPI reported an error */
    uint32_t from_us, limit_us; /* begin of the packet and its bound */
    uint32_t released_us;       /* chip select went high */
} stm32_spi;

/** The highest rate of SCK in Hz that is not above `hz`: 5.25 MHz / 2^n, n = 0..7, rounded down; 0 if there
 * is none. Half of each period is high. */
uint32_t stm32_spi_rate(uint32_t hz);

/** Clocks and sets up SPI1 and DMA2 at the slowest rate. Interrupts: SPI1, DMA2 stream 0 and 3. */
void stm32_spi_init(stm32_spi *spi, stm32_time *time, unsigned port, unsigned cs, unsigned sck,
                    unsigned mosi);

/** For the board's handlers of SPI1, DMA2 stream 0 and DMA2 stream 3. They record and report an event to
 * `time`. */
void stm32_spi_irq(stm32_spi *spi);

/**
 * start, poll, set_clock as in bqhost/hal.h. start waits for what is left of the 3 us of high chip select.
 * poll: BQ_E_BUS (DMA error, overrun, mode fault); BQ_E_TIMEOUT after twice the nominal time plus 1 ms; in
 * both cases the peripheral was reset and chip select is high. set_clock: stm32_spi_rate(hz), which reaches
 * down to 41.0 kHz; BQ_E_RANGE below; BQ_E_BUSY while a packet runs.
 */
bq_spi stm32_spi_bus(stm32_spi *spi);

#endif
