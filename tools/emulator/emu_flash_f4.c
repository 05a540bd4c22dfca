/* SPDX-License-Identifier: Apache-2.0 */
/* Flash controller of the STM32F405 (RM0090 section 3). */
#include "emu_flash.h"

#define ACR 0x00u
#define KEYR 0x04u
#define OPTKEYR 0x08u
#define SR 0x0cu
#define CR 0x10u
#define OPTCR 0x14u

#define SR_EOP 1u
#define SR_OPERR 2u
#define SR_WRPERR 0x10u
#define SR_PGAERR 0x20u
#define SR_PGPERR 0x40u
#define SR_PGSERR 0x80u
#define SR_ERRORS 0xf2u
#define SR_BSY 0x10000u
#define CR_PG 1u
#define CR_SER 2u
#define CR_MER 4u
#define CR_STRT 0x10000u
#define CR_EOPIE 0x1000000u
#define CR_ERRIE 0x2000000u
#define CR_LOCK 0x80000000u

#define PROGRAM_NS 16000u
#define HZ_PER_WAIT 30000000u /* supply 2.7 V to 3.6 V */
#define LARGEST (128u * 1024u)
#define ROW 16u

static void drive(emu_periph *p)
{
    const flash *s = p->state;

    emu_irq(p, 0,
            ((s->cr & CR_EOPIE) != 0 && (s->sr & SR_EOP) != 0) ||
                ((s->cr & CR_ERRIE) != 0 && (s->sr & SR_OPERR) != 0));
}

static void judge_latency(emu_periph *p)
{
    const flash *s = p->state;
    uint32_t hclk = p->e->clock.hclk;
    uint32_t needed = (hclk - 1u) / HZ_PER_WAIT;

    if ((s->acr & 7u) < needed) {
        emu_misuse(p, "ACR", "%lu wait states at %lu Hz", (unsigned long)(s->acr & 7u), (unsigned long)hclk);
    }
}

static unsigned parallelism(const emu_periph *p)
{
    return 1u << (((const flash *)p->state)->cr >> 8 & 3u);
}

/* x32 needs 2.7 V, x16 2.1 V, x64 an external programming voltage. */
static void judge_parallelism(emu_periph *p)
{
    unsigned size = parallelism(p), mv = p->e->supply_mv;

    if (size == 8 || (size == 4 && mv < 2700) || (size == 2 && mv < 2100)) {
        emu_misuse(p, "CR", "PSIZE of %u bytes at %u mV", size, mv);
    }
}

static bool can_begin(emu_periph *p)
{
    if (flash_busy(p)) {
        emu_misuse(p, "SR", "an operation begins while BSY is set");
        return false;
    }
    if ((((const flash *)p->state)->sr & SR_ERRORS) != 0) {
        emu_misuse(p, "SR", "an operation begins with an error flag set");
    }
    judge_parallelism(p);
    return true;
}

static bool refuse(emu_periph *p, uint32_t flag, uint32_t address, const char *why)
{
    flash *s = p->state;

    emu_misuse(p, "SR", "store to %08lx: %s", (unsigned long)address, why);
    s->sr |= flag;
    if ((s->cr & CR_ERRIE) != 0) {
        s->sr |= SR_OPERR;
    }
    drive(p);
    return true;
}

static bool f4_store(emu_periph *p, uint32_t address, uint32_t value, unsigned bytes)
{
    flash *s = p->state;
    uint8_t result[8], old[8] = {0};
    bool clean = true;

    if (s->lock != OPEN || (s->cr & CR_PG) == 0) {
        return refuse(p, SR_PGSERR, address, "PG is not set");
    }
    if (bytes != parallelism(p)) {
        return refuse(p, SR_PGPERR, address, "not as wide as PSIZE");
    }
    if ((address & (ROW - 1u)) + bytes > ROW) {
        return refuse(p, SR_PGAERR, address, "crosses a row of 128 bits");
    }
    if (!can_begin(p)) {
        return true;
    }
    (void)emu_peek(p->e, address, old, bytes);
    for (unsigned i = 0; i < bytes; i++) {
        uint8_t b = (uint8_t)(value >> (8 * i));

        clean = clean && (b & ~old[i]) == 0;
        result[i] = b & old[i];
    }
    if (!clean) {
        emu_misuse(p, "SR", "program of %08lx, which is not erased", (unsigned long)address);
    }
    flash_begin(p, address, bytes, result, PROGRAM_NS);
    return true;
}

static uint64_t erase_ns(const emu_periph *p, uint32_t size)
{
    /* milliseconds typical, by size (16, 64, 128 KB) and parallelism (x8, x16, x32) */
    static const uint16_t ms[3][3] = {{400, 300, 250}, {1200, 700, 550}, {2000, 1300, 1000}};
    unsigned by_size = size > 65536u ? 2 : size > 16384u ? 1 : 0;
    unsigned by_width = ((const flash *)p->state)->cr >> 8 & 3u;

    return (uint64_t)ms[by_size][by_width > 2 ? 2 : by_width] * 1000000u;
}

static void start(emu_periph *p)
{
    flash *s = p->state;
    unsigned sector = s->cr >> 3 & 15u;
    uint32_t at = p->e->chip->flash_base;

    if ((s->cr & (CR_SER | CR_MER)) != CR_SER || (s->cr & CR_PG) != 0) {
        emu_misuse(p, "CR", "STRT with CR = %08lx", (unsigned long)s->cr);
        s->sr |= SR_PGSERR;
        return;
    }
    for (unsigned i = 0; i < sector && p->e->chip->sectors[i] != 0; i++) {
        at += p->e->chip->sectors[i];
    }
    if (sector > 11) {
        emu_misuse(p, "CR", "SNB = %u: no such sector", sector);
    } else if (can_begin(p)) {
        flash_begin(p, at, p->e->chip->sectors[sector], NULL, erase_ns(p, p->e->chip->sectors[sector]));
    }
}

static void f4_run(emu_periph *p)
{
    flash *s = p->state;

    s->busy_ns = 0;
    s->cr &= ~CR_STRT;
    if ((s->cr & CR_EOPIE) != 0) {
        s->sr |= SR_EOP;
    }
    drive(p);
}

static uint32_t read_sr(emu_periph *p)
{
    if (!flash_busy(p)) {
        return ((const flash *)p->state)->sr;
    }
    flash_polled(p);
    return ((const flash *)p->state)->sr | SR_BSY;
}

static uint32_t f4_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const flash *s = p->state;

    (void)bytes;
    switch (offset & ~3u) {
    case ACR:
        return s->acr;
    case SR:
        return read_sr(p);
    case CR:
        return s->cr | (s->lock == OPEN ? 0 : CR_LOCK);
    case OPTCR:
        return 0x0fffaaedu;
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
    s->cr = emu_reserved(p, "CR", value, 0x8301037fu) & ~CR_LOCK;
    if ((value & CR_LOCK) != 0) {
        s->lock = LOCKED;
    } else if ((value & CR_STRT) != 0) {
        start(p);
    }
    drive(p);
}

static void f4_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    flash *s = p->state;

    value = emu_merge(offset < SR ? 0 : f4_read(p, offset & ~3u, 4), offset, value, bytes);
    switch (offset & ~3u) {
    case ACR:
        s->acr = emu_reserved(p, "ACR", value, 0x1f07u);
        judge_latency(p);
        break;
    case KEYR:
        flash_key(p, &s->lock, value, "KEYR");
        break;
    case SR:
        s->sr &= ~(value & 0xf3u);
        drive(p);
        break;
    case CR:
        write_cr(p, value);
        break;
    case OPTKEYR:
    case OPTCR:
        emu_misuse(p, "OPTCR", "option bytes are not modelled");
        break;
    default:
        break;
    }
}

static void f4_reset(emu_periph *p)
{
    flash *s = p->state;

    flash_abort(p);
    s->acr = s->sr = s->cr = 0;
    s->lock = s->option_lock = LOCKED;
    drive(p);
}

emu_periph *emu_flash_f4_new(emu *e, const emu_instance *at)
{
    emu_periph *p = flash_new(e, at, LARGEST);

    if (p != NULL) {
        p->read = f4_read;
        p->write = f4_write;
        p->run = f4_run;
        p->reset = f4_reset;
        e->flash_store = f4_store;
        e->flash_judge = judge_latency;
    }
    return p;
}
