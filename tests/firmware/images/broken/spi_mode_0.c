/* SPDX-License-Identifier: Apache-2.0 */
/* Packets to the stack go out in mode 0 instead of mode 1. */
#include "defect.h"
#include "stm32f4_spi.h"

#define SPI1_CR1 STM32_REG(0x40013000u)
#define CR1_CPHA 1u

bq_spi __real_stm32_spi_bus(stm32_spi *spi);
bq_spi __wrap_stm32_spi_bus(stm32_spi *spi);

static bq_spi good;

static bq_status start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    SPI1_CR1 &= ~CR1_CPHA;
    return good.ops->start(ctx, tx, rx, len);
}

bq_spi __wrap_stm32_spi_bus(stm32_spi *spi)
{
    static bq_spi_ops wrong;
    good = __real_stm32_spi_bus(spi);
    wrong = *good.ops;
    wrong.start = start;
    return (bq_spi){&wrong, spi};
}
