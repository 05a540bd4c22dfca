/* SPDX-License-Identifier: Apache-2.0 */
/* Debug units that firmware uses: the cycle counter of DWT (Cortex-M4) and the registers of DBGMCU. */
#include "emu_internal.h"

typedef struct dwt {
    uint32_t control;
    uint64_t origin; /**< core cycle at which CYCCNT was 0 */
    uint32_t frozen; /**< value while it does not count */
} dwt;

static bool counting(const emu_periph *p)
{
    const dwt *d = p->state;

    return (d->control & 1u) != 0 && (p->e->exc.demcr & 1u << 24) != 0;
}

static uint32_t dwt_value(const emu_periph *p)
{
    const dwt *d = p->state;

    return counting(p) ? (uint32_t)(p->e->cycle - d->origin) : d->frozen;
}

static uint32_t dwt_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    (void)bytes;
    switch (offset) {
    case 0:
        return 0x40000000u | ((const dwt *)p->state)->control;
    case 4:
        return dwt_value(p);
    default:
        return 0;
    }
}

static void dwt_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    dwt *d = p->state;
    uint32_t now = dwt_value(p);

    (void)bytes;
    if ((p->e->exc.demcr & 1u << 24) == 0) {
        emu_misuse(p, "CTRL", "written while TRCENA is 0");
        return;
    }
    if (offset == 0) {
        d->control = value & 1u;
        d->frozen = now;
        d->origin = p->e->cycle - now;
    } else if (offset == 4) {
        d->frozen = value;
        d->origin = p->e->cycle - value;
    }
}

static void dwt_reset(emu_periph *p)
{
    *(dwt *)p->state = (dwt){0};
}

emu_periph *emu_dwt_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(dwt));

    if (p != NULL) {
        p->read = dwt_read;
        p->write = dwt_write;
        p->reset = dwt_reset;
    }
    return p;
}

/* ---- DBGMCU ---- */

static uint32_t debug_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const uint32_t *r = p->state;

    (void)bytes;
    if (offset == 0) {
        return p->at->family == EMU_F0 ? 0x20010448u : 0x100f6413u;
    }
    return offset < 16 ? r[offset / 4] : 0;
}

static void debug_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    uint32_t *r = p->state;

    (void)bytes;
    if (offset > 0 && offset < 16) {
        r[offset / 4] = value;
    }
}

emu_periph *emu_debug_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, 16);

    if (p != NULL) {
        p->read = debug_read;
        p->write = debug_write;
    }
    return p;
}
