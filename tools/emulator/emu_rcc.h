/* SPDX-License-Identifier: Apache-2.0 */
/** @file emu_rcc.h
 * What the clock controllers of both families share: oscillators that take their time, the flags of resets,
 * the clock security system. */
#ifndef EMU_RCC_H
#define EMU_RCC_H

#include "emu_internal.h"

#define RCC_WORDS 0x25u

#define CR_HSION (1u << 0)
#define CR_HSIRDY (1u << 1)
#define CR_HSEON (1u << 16)
#define CR_HSERDY (1u << 17)
#define CR_CSSON (1u << 19)
#define CR_PLLON (1u << 24)
#define CR_PLLRDY (1u << 25)
#define CIR_CSSF (1u << 7)
#define CIR_CSSC (1u << 23)

enum rcc_osc { OSC_HSI, OSC_HSE, OSC_PLL, OSC_LSI, OSC_HSI48, OSC_HSI14, OSCS };

typedef struct rcc_source {
    bool on, ready;
    uint64_t due; /**< when it becomes ready; EMU_NEVER = it does not */
} rcc_source;

/** The state of both models; the registers come first. */
typedef struct rcc {
    uint32_t reg[RCC_WORDS];
    rcc_source osc[OSCS];
    uint32_t flags; /**< reset flags of CSR */
    uint8_t csr;    /**< word of CSR */
    uint8_t wanted; /**< SW as written; SWS follows when that source is ready */
    uint8_t used;   /**< SWS */
    bool css_nmi;
    /** Takes the present registers into bus clocks; by each family. */
    void (*retune)(emu_periph *p);
    bool (*source_ready)(const struct rcc *r, unsigned sw);
    bool (*uses_crystal)(const struct rcc *r); /**< SYSCLK comes from it, also through the PLL */
} rcc;

void rcc_switch(emu_periph *p, unsigned osc, bool on);
uint64_t rcc_next(const emu_periph *p);
void rcc_run(emu_periph *p);
void rcc_reset_common(emu_periph *p);
void rcc_write_cr(emu_periph *p, uint32_t value, uint32_t kept, uint32_t allowed);
uint32_t rcc_read_cr(const rcc *r);
void rcc_write_csr(emu_periph *p, uint32_t value);
uint32_t rcc_read_csr(const rcc *r);
void rcc_write_cir(emu_periph *p, uint32_t value);
void rcc_want(emu_periph *p, unsigned sw);
void rcc_crystal_changed(emu_periph *p);
void rcc_reset_bits(emu_periph *p, unsigned reg, uint32_t value);
uint32_t rcc_ahb_divider(uint32_t hpre);
uint32_t rcc_apb_divider(uint32_t ppre);
void rcc_judge(emu_periph *p, const emu_clocks *c);

#endif
