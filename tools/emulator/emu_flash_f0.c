/* SPDX-License-Identifier: Apache-2.0 */
/* Flash controller of the STM32F0 (RM0091 section 3). */
#include "emu_flash.h"

#define ACR 0x00u
#define KEYR 0x04u
#define OPTKEYR 0x08u
#define SR 0x0cu
#define CR 0x10u
#define AR 0x14u
#define OBR 0x1cu
#define WRPR 0x20u

#define SR_BSY 1u
#define SR_PGERR 4u
#define SR_WRPRTERR 0x10u
#define SR_EOP 0x20u
#define CR_PG 1u
#define CR_PER 2u
#define CR_MER 4u
#define CR_STRT 0x40u
#define CR_LOCK 0x80u
#define CR_ERRIE 0x400u
#define CR_EOPIE 0x1000u

#define PAGE_BYTES 2048u
#define PROGRAM_NS 53500u
#define ERASE_NS 30000000u
#define SLOW_HZ 24000000u /* up to here without wait state */

static void drive(emu_periph *p)
{
    const flash *s = p->state;

    emu_irq(p, 0,
            ((s->cr & CR_EOPIE) != 0 && (s->sr & SR_EOP) != 0) ||
                ((s->cr & CR_ERRIE) != 0 && (s->sr & (SR_PGERR | SR_WRPRTERR)) != 0));
}

static void judge_latency(emu_periph *p)
{
    const flash *s = p->state;

    if (p->e->clock.hclk > SLOW_HZ && (s->acr & 7u) == 0) {
        emu_misuse(p, "ACR", "no wait state at %lu Hz", (unsigned long)p->e->clock.hclk);
    }
}

static bool can_begin(emu_periph *p)
{
    if (flash_busy(p)) {
        emu_misuse(p, "SR", "an operation begins while BSY is set");
        return false;
    }
    if (!emu_rcc_hsi_on(p->e)) {
        emu_misuse(p, "CR", "program or erase without HSI");
    }
    if ((((const flash *)p->state)->sr & (SR_PGERR | SR_WRPRTERR)) != 0) {
        emu_misuse(p, "SR", "an operation begins with an error flag set");
    }
    return true;
}

static bool f0_store(emu_periph *p, uint32_t address, uint32_t value, unsigned bytes)
{
    flash *s = p->state;
    uint16_t old = 0;
    uint8_t result[2] = {(uint8_t)value, (uint8_t)(value >> 8)};

    if (s->lock != OPEN || (s->cr & CR_PG) == 0) {
        emu_misuse(p, "CR", "store to %08lx without PG", (unsigned long)address);
        return false;
    }
    if (bytes != 2) {
        emu_misuse(p, "CR", "program of %u bytes: only half-words", bytes);
        return false;
    }
    if (!can_begin(p)) {
        return true;
    }
    (void)emu_peek(p->e, address, &old, 2);
    if (old != 0xffffu && (value & 0xffffu) != 0) {
        emu_misuse(p, "SR", "program of %08lx, which is not erased", (unsigned long)address);
        s->sr |= SR_PGERR;
        drive(p);
        return true;
    }
    flash_begin(p, address, 2, result, PROGRAM_NS);
    return true;
}

static void start(emu_periph *p)
{
    flash *s = p->state;
    uint32_t base = p->e->chip->flash_base;

    if ((s->cr & (CR_PER | CR_MER)) == 0 || (s->cr & CR_PG) != 0) {
        emu_misuse(p, "CR", "STRT with CR = %03lx", (unsigned long)s->cr);
        return;
    }
    if (!can_begin(p)) {
        return;
    }
    if ((s->cr & CR_MER) != 0) {
        emu_misuse(p, "CR", "mass erase: would erase the image itself");
        return;
    }
    if (s->ar < base || s->ar - base >= p->e->chip->flash_size) {
        emu_misuse(p, "AR", "erase of %08lx: no flash", (unsigned long)s->ar);
        return;
    }
    flash_begin(p, s->ar & ~(PAGE_BYTES - 1u), PAGE_BYTES, NULL, ERASE_NS);
}

static void f0_run(emu_periph *p)
{
    flash *s = p->state;

    s->busy_ns = 0;
    s->sr |= SR_EOP;
    s->cr &= ~CR_STRT;
    drive(p);
}

static uint32_t f0_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const flash *s = p->state;

    (void)bytes;
    switch (offset & ~3u) {
    case ACR:
        return s->acr | ((s->acr & 0x10u) != 0 ? 0x20u : 0);
    case SR:
        return s->sr | (flash_busy(p) ? SR_BSY : 0);
    case CR:
        return s->cr | (s->lock == OPEN ? 0 : CR_LOCK);
    case OBR:
        return 0x03fffff2u;
    case WRPR:
        return 0xffffffffu;
    default:
        return 0;
    }
}

static void write_cr(emu_periph *p, uint32_t value)
{
    flash *s = p->state;

    if (s->lock != OPEN) {
        if (value != (s->cr | CR_LOCK)) {
            emu_misuse(p, "CR", "written while locked");
        }
        return;
    }
    if (flash_busy(p)) {
        emu_misuse(p, "CR", "written while BSY is set");
        return;
    }
    s->cr = emu_reserved(p, "CR", value, 0x36f7u) & ~CR_LOCK;
    if ((value & CR_LOCK) != 0) {
        s->lock = LOCKED;
    } else if ((value & CR_STRT) != 0) {
        start(p);
    }
    drive(p);
}

static void f0_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    flash *s = p->state;

    if (bytes != 4) {
        emu_misuse(p, "width", "register %02lx written in %u bytes", (unsigned long)offset, bytes);
    }
    switch (offset & ~3u) {
    case ACR:
        s->acr = value & 0x1fu;
        judge_latency(p);
        break;
    case KEYR:
        flash_key(p, &s->lock, value, "KEYR");
        break;
    case SR:
        s->sr &= ~(value & (SR_PGERR | SR_WRPRTERR | SR_EOP));
        drive(p);
        break;
    case CR:
        write_cr(p, value);
        break;
    case AR:
        if (flash_busy(p)) {
            emu_misuse(p, "AR", "written while BSY is set");
        } else {
            s->ar = value;
        }
        break;
    case OPTKEYR:
        emu_misuse(p, "OPTKEYR", "option bytes are not modelled");
        break;
    default:
        break;
    }
}

static void f0_reset(emu_periph *p)
{
    flash *s = p->state;

    flash_abort(p);
    s->acr = 0x10u;
    s->sr = s->cr = s->ar = 0;
    s->lock = s->option_lock = LOCKED;
    drive(p);
}

emu_periph *emu_flash_f0_new(emu *e, const emu_instance *at)
{
    emu_periph *p = flash_new(e, at, PAGE_BYTES);

    if (p != NULL) {
        p->read = f0_read;
        p->write = f0_write;
        p->run = f0_run;
        p->reset = f0_reset;
        e->flash_store = f0_store;
        e->flash_judge = judge_latency;
    }
    return p;
}
