/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_life.h"
#include "stm32_chip.h"
#include "stm32_core.h"
#include "stm32_image.h"
#include "stm32_start.h"
#include "stm32_time.h"
#include "stm32_watchdog.h"
#include <string.h>

#define ALIVE 0x4C495645u
#define CRASHED 0x44454144u

/* ---- begin
 * --------------------------------------------------------------------------------------------------- */

static bool crash_is_valid(const stm32_record *r)
{
    return r->magic == CRASHED && r->check == stm32_crc32(0, &r->crash, sizeof r->crash);
}

void stm32_life_begin(bq_boot *boot)
{
    stm32_record *r = &stm32_life_record;
    uint32_t flags = STM32_RCC_CSR;
    bool kept = r->alive == ALIVE;
    STM32_RCC_CSR = flags | STM32_CSR_RMVF;
    memset(boot, 0, sizeof *boot);
    boot->crashed = kept && crash_is_valid(r);
    boot->cause = stm32_reset_cause(flags, STM32_CSR_BROWN_OUT, kept, boot->crashed);
    if (boot->crashed) {
        boot->crash = r->crash;
    }
    memset(r, 0, sizeof *r);
    r->alive = ALIVE;
}

/* ---- every pass
 * ---------------------------------------------------------------------------------------------- */

static bool guard_whole(void)
{
    for (const uint32_t *w = stm32_guard_begin; w < stm32_guard_end; w++) {
        if (*w != STM32_GUARD_WORD) {
            return false;
        }
    }
    return true;
}

void stm32_life_pass(void)
{
    stm32_record *r = &stm32_life_record;
    uint32_t now = stm32_now_us(), whole;
    if (!guard_whole()) {
        stm32_crash(STM32_CRASH_GUARD);
    }
    r->rest_us += now - r->last_us;
    r->last_us = now;
    whole = r->rest_us / 1000u;
    r->uptime_ms += whole;
    r->rest_us -= whole * 1000u;
}

uint32_t stm32_stack_free(void)
{
    const uint32_t *w = stm32_guard_end;
    while (w < stm32_stack_end && *w == STM32_PAINT_WORD) {
        w++;
    }
    return (uint32_t)(w - stm32_guard_end) * 4u;
}

/* ---- end
 * ----------------------------------------------------------------------------------------------------- */

static void restart(void) __attribute__((noreturn));
static void restart(void)
{
    stm32_dsb();
    STM32_SCB_AIRCR = STM32_AIRCR_KEY | STM32_AIRCR_SYSRESETREQ;
    stm32_dsb();
    for (;;) {
    }
}

void stm32_reset(void)
{
    (void)stm32_lock();
    board_outputs_safe();
    restart();
}

/* `frame`: what the core pushed when the exception began, NULL if the stack does not hold it; then `pc`. */
static void keep(uint32_t kind, const uint32_t *frame, uint32_t pc, uint32_t sp)
{
    stm32_record *r = &stm32_life_record;
    bq_crash *c = &r->crash;
    memset(c, 0, sizeof *c);
    c->kind = kind;
    c->sp = sp;
    c->pc = pc;
    c->lr = pc;
    if (frame != NULL) {
        c->lr = frame[5];
        c->pc = frame[6];
        c->psr = frame[7];
    }
    stm32_fault_status(c);
    c->uptime_ms = r->uptime_ms;
    r->check = stm32_crc32(0, c, sizeof *c);
    r->magic = CRASHED;
}

__attribute__((used)) void stm32_fault_kept(const uint32_t *frame, uint32_t exception)
{
    bool inside = frame >= stm32_guard_begin && frame + 8 <= stm32_stack_end;
    board_outputs_safe();
    keep(exception, inside ? frame : NULL, 0, (uint32_t)(uintptr_t)frame + 32u);
    restart();
}

void stm32_crash(uint32_t kind)
{
    uint32_t sp, pc = (uint32_t)(uintptr_t)__builtin_return_address(0);
    (void)stm32_lock();
    __asm volatile("mov %0, sp" : "=r"(sp));
    board_outputs_safe();
    keep(kind, NULL, pc, sp);
    restart();
}

/* ---- the microcontroller of hal.h
 * ------------------------------------------------------------------------------ */

static void mcu_feed(void *ctx)
{
    (void)ctx;
    stm32_watchdog_feed();
}

static void mcu_reset(void *ctx)
{
    (void)ctx;
    stm32_reset();
}

static uint32_t mcu_stack_free(void *ctx)
{
    (void)ctx;
    return stm32_stack_free();
}

bq_mcu stm32_mcu(const bq_boot *boot)
{
    static const bq_mcu_ops ops = {mcu_feed, mcu_reset, mcu_stack_free};
    bq_mcu mcu = {&ops, NULL, boot};
    return mcu;
}
