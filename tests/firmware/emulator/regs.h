/* SPDX-License-Identifier: Apache-2.0 */
/** @file regs.h
 * An emulated chip without a processor, for tests that read and write registers as firmware would. */
#ifndef REGS_H
#define REGS_H

#include "emu.h"

/* What a world made of a table remembers. */
typedef struct regs_world {
    uint64_t now_ns, next_ns;
    int level[9][16]; /**< what the outside puts on a pin, -1 = nothing */
    emu_drive drive[9][16];
    unsigned pin_changes;
    uint8_t sent[256];
    uint64_t sent_ns[256];
    unsigned sent_count;
} regs_world;

emu_world regs_world_of(regs_world *w); /**< resets it first */

uint32_t rd(emu *e, uint32_t address);
uint32_t rd16(emu *e, uint32_t address);
uint32_t rd8(emu *e, uint32_t address);
void wr(emu *e, uint32_t address, uint32_t value);
void wr16(emu *e, uint32_t address, uint32_t value);
void wr8(emu *e, uint32_t address, uint32_t value);
void set(emu *e, uint32_t address, uint32_t bits);   /**< read, OR, write */
void clear(emu *e, uint32_t address, uint32_t bits); /**< read, AND NOT, write */
void advance_us(emu *e, uint64_t us);
/** All misuse so far as one number; with a name only of that peripheral. */
uint32_t misuse(emu *e, const char *periph);
/** NVIC: pending bit of an interrupt. */
bool pending(emu *e, unsigned irq);

/* the same on both chips */
#define NVIC_ISER 0xe000e100u
#define NVIC_ICPR 0xe000e280u

/* STM32F072 */
#define F0_RCC 0x40021000u
#define F0_FLASH 0x40022000u
#define F0_GPIOA 0x48000000u
#define F0_GPIOB 0x48000400u
#define F0_GPIOC 0x48000800u
#define F0_SYSCFG 0x40010000u
#define F0_EXTI 0x40010400u
/* STM32F405 */
#define F4_RCC 0x40023800u
#define F4_FLASH 0x40023c00u
#define F4_GPIOA 0x40020000u
#define F4_GPIOB 0x40020400u
#define F4_GPIOC 0x40020800u
#define F4_SYSCFG 0x40013800u
#define F4_EXTI 0x40013c00u
/* both */
#define TIM2_BASE 0x40000000u
#define IWDG_BASE 0x40003000u
#define USART2_BASE 0x40004400u
#define PWR_BASE 0x40007000u

#endif
