/* SPDX-License-Identifier: Apache-2.0 */
/* Power control of both families (RM0091 section 6, RM0090 section 5): voltage detector, backup access. */
#include "emu_internal.h"

#define CR_PVDE (1u << 4)
#define CR_DBP (1u << 8)
#define CSR_PVDO (1u << 2)
#define HYSTERESIS_MV 100u

typedef struct pwr {
    uint32_t cr, csr;
    bool low; /**< PVDO */
} pwr;

static unsigned rising_mv(const emu_periph *p)
{
    static const uint16_t f0[8] = {2180, 2280, 2380, 2480, 2580, 2680, 2780, 2880};
    static const uint16_t f4[8] = {2140, 2300, 2450, 2600, 2760, 2930, 3100, 3210};
    unsigned level = ((const pwr *)p->state)->cr >> 5 & 7u;

    return p->at->family == EMU_F0 ? f0[level] : f4[level];
}

static void look(emu_periph *p)
{
    pwr *s = p->state;
    unsigned threshold = rising_mv(p);

    if ((s->cr & CR_PVDE) == 0) {
        s->low = false;
    } else if (p->e->supply_mv < threshold - HYSTERESIS_MV) {
        s->low = true;
    } else if (p->e->supply_mv >= threshold) {
        s->low = false;
    }
    emu_exti_line(p->e, 16, s->low);
}

void emu_pwr_supply(emu *e)
{
    if (e->pwr != NULL) {
        look(e->pwr);
    }
}

bool emu_pwr_backup_unlocked(const emu *e)
{
    return (((const pwr *)e->pwr->state)->cr & CR_DBP) != 0;
}

static uint32_t pwr_read(emu_periph *p, uint32_t offset, unsigned bytes)
{
    const pwr *s = p->state;

    (void)bytes;
    if (offset == 0) {
        return s->cr;
    }
    if (offset == 4) {
        uint32_t vos_ready = p->at->family == EMU_F4 ? 1u << 14 : 1u << 3; /* F0: VREFINT ready */

        return s->csr | (s->low ? CSR_PVDO : 0) | vos_ready;
    }
    return 0;
}

static void pwr_write(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes)
{
    pwr *s = p->state;

    (void)bytes;
    if (offset == 0) {
        s->cr = emu_reserved(p, "CR", value, p->at->family == EMU_F0 ? 0x1ffu : 0x43ffu) & ~0xcu;
        if ((value & 2u) != 0) {
            emu_misuse(p, "CR", "standby is not modelled");
        }
        look(p);
    } else if (offset == 4) {
        s->csr = value & (p->at->family == EMU_F0 ? 0xff00u : 0x300u);
    }
}

static void pwr_reset(emu_periph *p)
{
    pwr *s = p->state;

    s->cr = p->at->family == EMU_F4 ? 0x4000u : 0;
    s->csr = 0;
    look(p);
}

emu_periph *emu_pwr_new(emu *e, const emu_instance *at)
{
    emu_periph *p = emu_periph_new(e, at, sizeof(pwr));

    if (p != NULL) {
        p->read = pwr_read;
        p->write = pwr_write;
        p->reset = pwr_reset;
        e->pwr = p;
    }
    return p;
}
