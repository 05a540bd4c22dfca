/* SPDX-License-Identifier: Apache-2.0 */
#include "noise.h"

void noise_begin(noise_source *s, const emu *e, uint64_t every_ns)
{
    s->every_ns = every_ns;
    s->at_ns = emu_now(e) + every_ns;
    s->given = 0;
}

void noise_end(noise *n)
{
    n->line.every_ns = n->uart.every_ns = n->can.every_ns = 0;
}

/* One at a time: an instant that is late is not made up for, as no wire would. */
static bool due(noise_source *s, uint64_t now_ns)
{
    if (s->every_ns == 0 || now_ns < s->at_ns) {
        return false;
    }
    s->at_ns = now_ns + s->every_ns;
    s->given++;
    return true;
}

void noise_advance(noise *n, emu *e, uint64_t now_ns)
{
    if (due(&n->line, now_ns)) {
        n->level = !n->level;
    }
    if (due(&n->uart, now_ns)) {
        (void)emu_uart_in(e, 2, n->byte);
    }
    if (due(&n->can, now_ns) && emu_can_in(e, 1, &n->frame)) {
        n->taken++;
    }
}

static uint64_t earlier(uint64_t at, const noise_source *s)
{
    return s->every_ns != 0 && s->at_ns < at ? s->at_ns : at;
}

uint64_t noise_next(const noise *n)
{
    return earlier(earlier(earlier(EMU_NEVER, &n->line), &n->uart), &n->can);
}

bool noise_on(const noise *n, unsigned port, unsigned pin)
{
    return n->line.every_ns != 0 && n->port == port && n->pin == pin;
}
