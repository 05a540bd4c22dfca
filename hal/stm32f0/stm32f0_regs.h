/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32f0_regs.h
 * Registers that only this family has in this form (RM0091), those in use.
 */
#ifndef STM32F0_REGS_H
#define STM32F0_REGS_H

#include "stm32_regs.h"

/* ---- RCC (RM0091 6.4) -------------------------------------------------------------------------------------
 */

#define STM32_RCC_CR STM32_REG(0x40021000u)
#define STM32_RCC_CR_HSEON (1u << 16)
#define STM32_RCC_CR_HSERDY (1u << 17)
#define STM32_RCC_CR_CSSON (1u << 19)
#define STM32_RCC_CR_PLLON (1u << 24)
#define STM32_RCC_CR_PLLRDY (1u << 25)

#define STM32_RCC_CFGR STM32_REG(0x40021004u)
#define STM32_RCC_CFGR_SW 3u
#define STM32_RCC_CFGR_SW_PLL 2u
#define STM32_RCC_CFGR_SW_HSI48 3u
#define STM32_RCC_CFGR_SWS_SHIFT 2
#define STM32_RCC_CFGR_PLLSRC_HSI_2 (0u << 15)
#define STM32_RCC_CFGR_PLLSRC_HSE (2u << 15)
#define STM32_RCC_CFGR_PLLMUL(n) (((n) - 2u) << 18)
#define STM32_RCC_CFGR_PLL (0x3fu << 15 | 1u << 17) /* source, prescaler bit, factor */

#define STM32_RCC_CIR STM32_REG(0x40021008u)
#define STM32_RCC_CIR_CSSF (1u << 7)
#define STM32_RCC_CIR_CSSC (1u << 23)

#define STM32_RCC_CFGR3 STM32_REG(0x40021030u)
#define STM32_RCC_CFGR3_I2C1SW (1u << 4) /* 0: HSI, 8 MHz */

#define STM32_RCC_CR2 STM32_REG(0x40021034u)
#define STM32_RCC_CR2_HSI48ON (1u << 16)
#define STM32_RCC_CR2_HSI48RDY (1u << 17)

/* ---- flash (RM0091 3.5) -----------------------------------------------------------------------------------
 */

typedef struct stm32_flash_regs {
    volatile uint32_t acr, keyr, optkeyr, sr, cr, ar;
} stm32_flash_regs;

#define STM32_FLASH ((stm32_flash_regs *)(uintptr_t)0x40022000u)
#define STM32_FLASH_ACR_LATENCY 1u /* one wait state above 24 MHz */
#define STM32_FLASH_ACR_PRFTBE (1u << 4)
#define STM32_FLASH_KEY1 0x45670123u
#define STM32_FLASH_KEY2 0xCDEF89ABu
#define STM32_FLASH_SR_BSY (1u << 0)
#define STM32_FLASH_SR_PGERR (1u << 2)
#define STM32_FLASH_SR_WRPRTERR (1u << 4)
#define STM32_FLASH_SR_EOP (1u << 5)
#define STM32_FLASH_CR_PG (1u << 0)
#define STM32_FLASH_CR_PER (1u << 1)
#define STM32_FLASH_CR_STRT (1u << 6)
#define STM32_FLASH_CR_LOCK (1u << 7)

/* ---- I2C, version 2 (RM0091 26.7)
 * -------------------------------------------------------------------------- */

typedef struct stm32_i2c_regs {
    volatile uint32_t cr1, cr2, oar1, oar2, timingr, timeoutr, isr, icr, pecr, rxdr, txdr;
} stm32_i2c_regs;

#define STM32_I2C1 ((stm32_i2c_regs *)(uintptr_t)0x40005400u)
#define STM32_I2C_CR1_PE (1u << 0)
#define STM32_I2C_CR1_TXIE (1u << 1)
#define STM32_I2C_CR1_RXIE (1u << 2)
#define STM32_I2C_CR1_NACKIE (1u << 4)
#define STM32_I2C_CR1_STOPIE (1u << 5)
#define STM32_I2C_CR1_TCIE (1u << 6)
#define STM32_I2C_CR1_ERRIE (1u << 7)
#define STM32_I2C_CR2_SADD7_SHIFT 1
#define STM32_I2C_CR2_RD_WRN (1u << 10)
#define STM32_I2C_CR2_START (1u << 13)
#define STM32_I2C_CR2_NBYTES_SHIFT 16
#define STM32_I2C_CR2_RELOAD (1u << 24)
#define STM32_I2C_CR2_AUTOEND (1u << 25)
#define STM32_I2C_ISR_TXE (1u << 0)
#define STM32_I2C_ISR_TXIS (1u << 1)
#define STM32_I2C_ISR_RXNE (1u << 2)
#define STM32_I2C_ISR_NACKF (1u << 4)
#define STM32_I2C_ISR_STOPF (1u << 5)
#define STM32_I2C_ISR_TC (1u << 6)
#define STM32_I2C_ISR_TCR (1u << 7)
#define STM32_I2C_ISR_BERR (1u << 8)
#define STM32_I2C_ISR_ARLO (1u << 9)
#define STM32_I2C_ISR_BUSY (1u << 15)

#endif
