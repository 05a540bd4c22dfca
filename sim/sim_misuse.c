/* SPDX-License-Identifier: Apache-2.0 */
#include "sim_misuse.h"
#include <string.h>

static void copy_text(char *to, size_t size, const char *from)
{
    size_t n = strlen(from);

    if (n >= size) {
        n = size - 1;
    }
    memcpy(to, from, n);
    to[n] = '\0';
}

void sim_misuse_clear(sim_misuse *m)
{
    memset(m, 0, sizeof *m);
}

void sim_misuse_add(sim_misuse *m, uint64_t time_ns, int device, const char *id, const char *text)
{
    if (m->count < SIM_MISUSE_KEPT) {
        sim_misuse_entry *e = &m->entry[m->count];

        e->time_ns = time_ns;
        e->device = device;
        copy_text(e->id, sizeof e->id, id);
        copy_text(e->text, sizeof e->text, text);
    }
    if (m->count < UINT32_MAX) {
        m->count++;
    }
}

uint32_t sim_misuse_of(const sim_misuse *m, const char *id)
{
    uint32_t kept = m->count < SIM_MISUSE_KEPT ? m->count : SIM_MISUSE_KEPT;
    uint32_t n = 0;

    for (uint32_t i = 0; i < kept; i++) {
        if (strcmp(m->entry[i].id, id) == 0) {
            n++;
        }
    }
    return n;
}
