/* SPDX-License-Identifier: Apache-2.0 */
/* TIM2 as a 32-bit up-counter with four compares (RM0091 section 18, RM0090 section 18). Not modelled:
 * capture, output pins, down and centre-aligned counting, slave modes; their use is misuse. A compare value
 * that the counter already has when it is written does not match before the counter comes round again. */
#include "emu_periph.h"

#define CR1 0x00u
#define CR2 0x04u
#define SMCR 0x08u
#define DIER 0x0cu
#define SR 0x10u
#define EGR 0x14u
#define CCMR1 0x18u
#define CCMR2 0x1cu
#define CCER 0x20u
#define CNT 0x24u
#define PSC 0x28u
#define ARR 0x2cu
#define CCR1 0x34u
#define CCR4 0x40u
#define CHANNELS 4u
#define NS_PER_S 1000000000u

typedef struct tim {
    uint32_t reg[0x15];
    uint64_t origin_ns; /**< when the counter stood at `from` */
    uint32_t from;
    uint32_t prescaler;         /**< in use; PSC is its preload */
    uint32_t hz;                /**< clock of the prescaler */
    uint64_t due[CHANNELS + 1]; /**< of the compares and the update */
} tim;

static bool counting(const tim *t)
{
    return (t->reg[CR1 / 4] & 1u) != 0;
}

static uint64_t ticks(const emu_periph *p)
{
    const tim *t = p->state;
    uint64_t d = emu_now(p->e) - t->origin_ns, hz = t->hz;

    if (!counting(t)) {
        return 0;
    }
    return (d / NS_PER_S * hz + d % NS_PER_S * hz / NS_PER_S) / (t->prescaler + 1u);
}

static uint64_t period(const tim *t)
{
    return (uint64_t)t->reg[ARR / 4] + 1u;
}

static uint32_t count_after(const tim *t, uint64_t n)
{
    return (uint32_t)((t->from + n) % period(t));
}

/* When the counter comes to `value` next, strictly after n ticks. */
static uint64_t arrival(const emu_periph *p, uint64_t n, uint32_t value)
{
    const tim *t = p->state;
    uint64_t steps;

    if (!counting(t) || value >= period(t)) {
        return EMU_NEVER;
    }
    steps = (value + period(t) - count_after(t, n)) % period(t);
    steps = steps == 0 ? period(t) : steps;
    return t->origin_ns + emu_cycles_ns(t->hz, (n + steps) * (t->prescaler + 1u));
}

static void plan(emu_periph *p, unsigned i)
{
    tim *t = p->state;

    t->due[i] = arrival(p, ticks(p), i < CHANNELS ? t->reg[CCR1 / 4 + i] : 0);
}

static void plan_all(emu_periph *p)
{
    for (unsigned i = 0; i <= CHANNELS; i++) {
        plan(p, i);
    }
}

/* The counter goes on from its present value under new conditions. */
static void rebase(emu_periph *p, uint32_t from)
{
    tim *t = p->state;

    t->from = from;
    t->origin_ns = emu_now(p->e);
}

static void drive(emu_periph *p)
{
    const tim *t = p->state;

    emu_irq(p, 0, (t->reg[SR / 4] & t->reg[DIER / 4] & 0x5fu) != 0);
}

static uint64_t tim_next(const emu_periph *p)
{
    const tim *t = p->state;
    uint64_t next = EMU_NEVER;

    for (unsigned i = 0; i <= CHANNELS; i++) {
        next = t->due[i] < next ? t->due[i] : next;
    }
    return next;
}

static void update(emu_periph *p, bool by_software)
{
    tim *t = p->state;
    uint32_t cr1 = t->reg[CR1 / 4];

    if ((cr1 & 2u) == 0) { /* UDIS */
        t->prescaler = t->reg[PSC / 4];
        if (!by_software || (cr1 & 4u) == 0) { /* URS */
            t->reg[SR / 4] |= 1u;
        }
    }
    if (by_software) {
        rebase(p, 0);
    } else if ((cr1 & 8u) != 0) { /* one pulse */
        rebase(p, 0);
        t->reg[CR1 / 4] &= ~1u;
    }
}

static void tim_run(emu_periph *p)
{
    tim *t = p->state;
    uint64_t now = emu_now(p->e);

    for (unsigned i = 0; i < CHANNELS; i++) {
        if (t->due[i] <= now) {
            t->reg[SR / 4] |= 2u << i;
            plan(p, i);
        }
    }
    if (t->due[CHANNELS] <= now) {
        uint32_t before = t->prescaler;

        update(p, false);
        if (before != t->prescaler) {
            rebase(p, 0);
        }
        plan_all(p);
    }
    drive(p);
}

static uint32_t tim_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const tim *t = p->state;

    (void)bytes;
    if (offset == CNT) {
        return count_after(t, ticks(p));
    }
    return offset / 4 < 0x15 && offset != EGR ? t->reg[offset / 4] : 0;
}

static void write_cr1(emu_periph *p, uint32_t value)
{
    tim *t = p->state;
    uint32_t now = count_after(t, ticks(p));

    if ((value & 0x70u) != 0) {
        emu_misuse(p, "CR1", "down or centre-aligned counting is not modelled");
    }
    t->reg[CR1 / 4] = emu_reserved(p, "CR1", value, 0x3ffu);
    rebase(p, now);
    plan_all(p);
}

static void write_egr(emu_periph *p, uint32_t value)
{
    tim *t = p->state;

    for (unsigned i = 0; i < CHANNELS; i++) {
        if ((value & 2u << i) != 0) {
            t->reg[SR / 4] |= 2u << i;
        }
    }
    if ((value & 1u) != 0) {
        update(p, true);
        plan_all(p);
    }
}

static void tim_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    tim *t = p->state;

    (void)bytes;
    switch (offset) {
    case CR1:
        write_cr1(p, value);
        break;
    case SR:
        t->reg[SR / 4] &= value; /* bits written 0 are cleared */
        break;
    case EGR:
        write_egr(p, value);
        break;
    case CNT:
        rebase(p, value);
        plan_all(p);
        break;
    case ARR: {
        uint32_t now = count_after(t, ticks(p));

        t->reg[ARR / 4] = value;
        rebase(p, now);
        plan_all(p);
        break;
    }
    case PSC:
        t->reg[PSC / 4] = value & 0xffffu;
        break;
    case CCMR1:
    case CCMR2:
    case CCER:
    case SMCR:
        if (value != 0) {
            emu_misuse(p, "mode", "capture, outputs and slave modes are not modelled");
        }
        t->reg[offset / 4] = value;
        break;
    default:
        if (offset / 4 < 0x15) {
            t->reg[offset / 4] = value;
        }
        if (offset >= CCR1 && offset <= CCR4) {
            plan(p, (offset - CCR1) / 4);
        }
        break;
    }
    drive(p);
}

static void tim_reset(emu_periph *p)
{
    tim *t = p->state;

    *t = (tim){.origin_ns = emu_now(p->e), .hz = emu_kernel_hz(p->e, p->at)};
    t->reg[ARR / 4] = 0xffffffffu;
    plan_all(p);
    drive(p);
}

/* What was counted was counted at the old rate. */
static void tim_clock(emu_periph *p)
{
    tim *t = p->state;

    rebase(p, count_after(t, ticks(p)));
    t->hz = emu_kernel_hz(p->e, p->at);
    plan_all(p);
}

emu_periph *emu_tim2_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(tim));

    if (p != NULL) {
        p->read = tim_read;
        p->write = tim_write;
        p->next = tim_next;
        p->run = tim_run;
        p->reset = tim_reset;
        p->clock = tim_clock;
    }
    return p;
}
