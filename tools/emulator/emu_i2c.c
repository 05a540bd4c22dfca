/* SPDX-License-Identifier: Apache-2.0 */
#include "emu_i2c.h"

static bool on_pin(emu_periph *p, unsigned signal, const char *name)
{
    const emu_pad *pad = emu_pad_needed(p, signal, name);

    if (pad == NULL) {
        return false;
    }
    if (!emu_pin_open_drain(p->e, pad->port, pad->pin)) {
        emu_misuse(p, "CR1", "%s drives push-pull: the pin is not open drain", name);
    }
    return true;
}

bool emu_i2c_connected(emu_periph *p)
{
    bool scl = on_pin(p, EMU_SIG_SCL, "SCL");
    bool sda = on_pin(p, EMU_SIG_SDA, "SDA");

    return scl && sda;
}

unsigned emu_i2c_held(emu_periph *p)
{
    const emu_world *w = emu_outside(p->e);

    return w->i2c_lines(w->ctx, p->at->number);
}
