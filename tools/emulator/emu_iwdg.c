/* SPDX-License-Identifier: Apache-2.0 */
/* Independent watchdog of both families (RM0091 section 24, RM0090 section 21); the window only on F0. */
#include "emu_internal.h"

#define KR 0x00u
#define PR 0x04u
#define RLR 0x08u
#define SR 0x0cu
#define WINR 0x10u
#define KEY_RELOAD 0xaaaau
#define KEY_OPEN 0x5555u
#define KEY_START 0xccccu
#define UPDATE_CYCLES 5u /* of LSI until a written register is taken over */

typedef struct iwdg {
    uint32_t pr, rlr, winr;
    uint64_t busy_ns[3]; /**< until when PVU, RVU, WVU are set */
    uint64_t refreshed_ns, bite_ns;
    bool open, running;
} iwdg;

static uint64_t counts_ns(const emu_periph *p, uint32_t counts)
{
    const iwdg *w = p->state;
    uint32_t divider = 4u << (w->pr > 6 ? 6 : w->pr);

    return emu_cycles_ns(emu_kernel_hz(p->e, p->at), (uint64_t)counts * divider);
}

static void refresh(emu_periph *p)
{
    iwdg *w = p->state;

    w->refreshed_ns = emu_now(p->e);
    w->bite_ns = w->refreshed_ns + counts_ns(p, w->rlr + 1u);
}

/* The window opens when the counter has fallen to WINR. */
static bool too_early(const emu_periph *p)
{
    const iwdg *w = p->state;

    return w->running && w->winr < w->rlr && emu_now(p->e) < w->refreshed_ns + counts_ns(p, w->rlr - w->winr);
}

static void reload(emu_periph *p)
{
    iwdg *w = p->state;

    if (too_early(p)) {
        emu_ask_reset(p->e, EMU_CAUSE_IWDG);
        return;
    }
    if (w->running) {
        refresh(p);
    }
}

static void write_key(emu_periph *p, uint32_t key)
{
    iwdg *w = p->state;

    w->open = key == KEY_OPEN;
    switch (key) {
    case KEY_START:
        w->running = true;
        refresh(p);
        break;
    case KEY_RELOAD:
        reload(p);
        break;
    case KEY_OPEN:
        break;
    default:
        emu_misuse(p, "KR", "unknown key %04lx", (unsigned long)key);
        break;
    }
}

static bool busy(const emu_periph *p, unsigned which)
{
    return ((const iwdg *)p->state)->busy_ns[which] > emu_now(p->e);
}

static bool may_write(emu_periph *p, unsigned which, const char *reg)
{
    iwdg *w = p->state;

    if (!w->open) {
        emu_misuse(p, reg, "written without key 5555");
        return false;
    }
    if (busy(p, which)) {
        emu_misuse(p, reg, "written while its update bit in SR is set");
        return false;
    }
    w->busy_ns[which] = emu_now(p->e) + emu_cycles_ns(emu_kernel_hz(p->e, p->at), UPDATE_CYCLES);
    return true;
}

static uint32_t iwdg_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const iwdg *w = p->state;

    (void)bytes;
    switch (offset) {
    case PR:
        return w->pr;
    case RLR:
        return w->rlr;
    case SR:
        return (busy(p, 0) ? 1u : 0) | (busy(p, 1) ? 2u : 0) | (busy(p, 2) ? 4u : 0);
    case WINR:
        return p->at->family == EMU_F0 ? w->winr : 0;
    default:
        return 0;
    }
}

static void iwdg_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    iwdg *w = p->state;

    (void)bytes;
    if (offset == KR) {
        write_key(p, value & 0xffffu);
    } else if (offset == PR && may_write(p, 0, "PR")) {
        w->pr = emu_reserved(p, "PR", value, 7u);
    } else if (offset == RLR && may_write(p, 1, "RLR")) {
        w->rlr = emu_reserved(p, "RLR", value, 0xfffu);
    } else if (offset == WINR && p->at->family == EMU_F0 && may_write(p, 2, "WINR")) {
        w->winr = emu_reserved(p, "WINR", value, 0xfffu);
        if (w->running) {
            refresh(p); /* writing the window also reloads */
        }
    }
}

static uint64_t iwdg_next(const emu_periph *p)
{
    const iwdg *w = p->state;

    return w->running ? w->bite_ns : EMU_NEVER;
}

static void iwdg_run(emu_periph *p)
{
    iwdg *w = p->state;

    w->running = false;
    emu_ask_reset(p->e, EMU_CAUSE_IWDG);
}

static void iwdg_reset(emu_periph *p)
{
    *(iwdg *)p->state = (iwdg){.rlr = 0xfff, .winr = 0xfff};
}

emu_periph *emu_iwdg_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(iwdg));

    if (p != NULL) {
        p->read = iwdg_read;
        p->write = iwdg_write;
        p->next = iwdg_next;
        p->run = iwdg_run;
        p->reset = iwdg_reset;
    }
    return p;
}
