/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the cell inputs see. With all sense wires whole, input n sees cell n. An open wire leaves its node to
 * leakage and to the balancing switches; ADC and comparators see the result alike, and the BAT pin keeps its
 * own wire (PL-VBAT-02).
 *
 * - Open inner wire k (1..5), balancing off: the node drifts toward the next lower one by the fraction
 * `wire_drift` (0.5) of cell k. Cell k reads low, cell k + 1 high by the same amount, the sum is true
 * (PL-SEQ-14-03). With 0.5 both readings of ordinary cells stay inside the converter's range, so that the
 * rule can be seen in the codes.
 * - With a balancing output beside the open node on, its cell reads 0 and the neighbour takes both voltages
 * (PL-SEQ-14-04); with both on they share equally.
 * - Several open wires in a row: each cell but the highest keeps (1 - drift) of its voltage, the highest
 * takes the rest; cells with their output on read 0 and the others share in proportion.
 * - Open VC6 or VC0: no neighbour takes up the difference. Cell 6 (cell 1) reads (1 - drift) of its voltage,
 * 0 with its output on, and the sum falls below VBAT (PL-SEQ-14-02).
 * - Option wire_field_pattern, as seen on hardware: the cell below an open inner wire (cell 1 for VC0, cell 6
 * for VC6) reads 0, the one above it a fifth of that voltage too much: the sum is too low by less than one
 * cell.
 */
#include "sim_pl536_internal.h"
#include <string.h>

static bool is_open(const sim_pl_dev *d, int wire)
{
    return (d->wires_open >> wire & 1u) != 0;
}

static double drift(const sim_pl *s)
{
    return s->options.wire_drift > 0.0 ? s->options.wire_drift : 0.5;
}

/* Cells first..last hang between two firm nodes; the nodes between them float. Index 0 = cell 1. */
static void share(const sim_pl *s, sim_pl_dev *d, int first, int last, unsigned on)
{
    double total = 0.0, off_total = 0.0, rest;
    unsigned mask = 0;

    for (int i = first; i <= last; i++) {
        total += d->cell[i];
        off_total += (on >> i & 1u) != 0 ? 0.0 : d->cell[i];
        mask |= 1u << i;
    }
    rest = total;
    for (int i = first; i <= last; i++) {
        if ((on & mask) == mask) {
            d->seen[i] = total / (last - first + 1);
        } else if ((on & mask) != 0) {
            d->seen[i] = (on >> i & 1u) != 0 || !(off_total > 0.0) ? 0.0 : total * d->cell[i] / off_total;
        } else {
            d->seen[i] = i == last ? rest : d->cell[i] * (1.0 - drift(s));
            rest -= d->seen[i];
        }
    }
}

/* Cells between the end of the stack and the nearest firm node, when the end wire is open. */
static void hang(const sim_pl *s, sim_pl_dev *d, int first, int last, unsigned on)
{
    for (int i = first; i <= last; i++) {
        d->seen[i] = (on >> i & 1u) != 0 ? 0.0 : d->cell[i] * (1.0 - drift(s));
    }
}

static void field_pattern(sim_pl_dev *d)
{
    for (int wire = 0; wire <= 6; wire++) {
        if (is_open(d, wire)) {
            double lost = d->cell[wire > 0 ? wire - 1 : 0];

            d->seen[wire > 0 ? wire - 1 : 0] = 0.0;
            if (wire > 0 && wire < 6) {
                d->seen[wire] += 0.2 * lost;
            }
        }
    }
}

void sim_pl_inputs(sim_pl *s, sim_pl_dev *d)
{
    unsigned on = d->cb_running ? d->reg[REG_CB_CTRL] : 0u;
    int low = 0;

    memcpy(d->seen, d->cell, sizeof d->seen);
    if (d->wires_open == 0) {
        return;
    }
    if (s->options.wire_field_pattern) {
        field_pattern(d);
        return;
    }
    for (int wire = 1; wire <= 6; wire++) {
        if (is_open(d, wire) && wire < 6) {
            continue;
        }
        if (is_open(d, low) || is_open(d, wire)) { /* only VC0 and VC6 can still be open here */
            hang(s, d, low, wire - 1, on);
        } else if (wire - low > 1) {
            share(s, d, low, wire - 1, on);
        }
        low = wire;
    }
}
