/* SPDX-License-Identifier: Apache-2.0 */
/* Commands with a row for each item: cells, faults, counters, cells that bleed. */
#include "console_internal.h"
#include <string.h>

#define CELLS_A_ROW 6u
#define NUMBERS_A_ROW 12u

/* ---- cells and sensors -------------------------------------------------------------------------- */

/* Age of the module's picture, and why a value is not valid (bits of all bad ones; 0 = all are valid). */
static void tail(bq_console *c, const bq_app *app, uint8_t module, uint8_t bad)
{
    static const uint8_t bits[] = {BQ_Q_COMM, BQ_Q_OPEN_WIRE, BQ_Q_SENSOR, BQ_Q_RANGE};
    int32_t v = (int32_t)bq_app_sample(app)->modules[module].age_ms;

    console_say(c, "%a", &v);
    if (bad == 0u) {
        return;
    }
    for (v = 0; v < 4 && (bad & bits[v]) == 0u; v++) {
    }
    console_say(c, ", ? is not valid: %[no answer|open wire|sensor|range|chip]", &v);
}

/* What is to be said about a value that is not valid; 0 for a valid one. */
static uint8_t doubt(bq_console *c, uint8_t quality)
{
    if ((quality & BQ_Q_VALID) != 0u) {
        return 0;
    }
    console_char(c, '?');
    return quality | BQ_Q_CHIP;
}

static void cells_row(bq_console *c, const bq_app *app)
{
    const bq_sample *s = bq_app_sample(app);
    const int32_t first = c->item + 1;
    const uint8_t module = s->cells[c->item].module;
    uint8_t bad = 0;

    console_say(c, "cells %0:", &first);
    for (unsigned n = 0; n < CELLS_A_ROW && c->item < s->cell_count && s->cells[c->item].module == module;
         n++) {
        const bq_cell_reading *r = &s->cells[c->item++];
        const int32_t mv = r->mv;
        console_say(c, " %0", &mv);
        bad |= doubt(c, r->quality);
        if (bq_mask_get(bq_app_action(app)->balance, c->item)) {
            console_char(c, 'b');
        }
    }
    console_text(c, " mV");
    tail(c, app, module, bad);
}

static void sensor_row(bq_console *c, const bq_app *app, uint16_t n)
{
    const bq_temp_reading *r = &bq_app_sample(app)->temps[n];
    const int32_t v[] = {n + 1, r->dc};

    c->item++;
    console_say(c, "sensor %0: %1 C", v);
    tail(c, app, r->module, doubt(c, r->quality));
}

console_row console_cells(bq_console *c, const bq_app *app)
{
    const bq_sample *s = bq_app_sample(app);

    if (c->item < s->cell_count) {
        cells_row(c, app);
        return CONSOLE_ROW;
    }
    if (c->item < s->cell_count + s->temp_count) {
        sensor_row(c, app, (uint16_t)(c->item - s->cell_count));
        return CONSOLE_ROW;
    }
    if (s->cell_count > 0u || c->row++ > 0u) {
        return CONSOLE_DONE;
    }
    console_text(c, "nothing measured yet");
    return CONSOLE_ROW;
}

/* ---- cells that bleed ---------------------------------------------------------------------------- */

console_row console_bleeding(bq_console *c, const bq_app *app)
{
    const uint16_t cells = bq_app_sample(app)->cell_count;
    unsigned shown = 0;

    while (c->item < cells && shown < NUMBERS_A_ROW) {
        c->item++;
        if (bq_mask_get(bq_app_action(app)->balance, c->item)) {
            const int32_t v[] = {shown == 0u, c->item};
            console_say(c, "%[|cells] %0", v);
            shown++;
        }
    }
    return shown > 0u ? CONSOLE_ROW : CONSOLE_DONE;
}

/* ---- faults -------------------------------------------------------------------------------------- */

#define BIT(fault) ((uint32_t)1 << (fault))

/* Unit of what a record holds. */
static const char *unit(bq_pack_fault f, int32_t value)
{
    const uint32_t bit = BIT(f);

    if ((bit & (BIT(BQ_FAULT_CELL_OV) | BIT(BQ_FAULT_CELL_UV) | BIT(BQ_FAULT_IMBALANCE))) != 0u) {
        return ", %3 V";
    }
    if ((bit & (BIT(BQ_FAULT_OVERTEMP) | BIT(BQ_FAULT_UNDERTEMP))) != 0u) {
        return ", %1 C";
    }
    if ((bit & (BIT(BQ_FAULT_COMM_LOSS) | BIT(BQ_FAULT_NO_READING) | BIT(BQ_FAULT_SENSOR) |
                BIT(BQ_FAULT_CONTACTOR))) != 0u) {
        return ", %0 ms";
    }
    return value < 0 ? ", %E" : ", flags %x";
}

static void fault_row(bq_console *c, bq_pack_fault f, const bq_pack_fault_record *r)
{
    const int32_t v[] = {(int32_t)f, r->active, (int32_t)r->hold, r->device, r->cell, r->sensor, r->wire};
    const int32_t end[] = {(int32_t)r->trip_ms, (int32_t)r->count};

    console_say(c, "%F: %[cleared|active], held by %H%(, device )%(, cell )%(, sensor )", v);
    if (r->wire >= 0) {
        console_say(c, ", wire %0", &v[6]);
    }
    console_say(c, unit(f, r->value), &r->value);
    console_say(c, ", at %t s, times %0", end);
}

console_row console_faults(bq_console *c, const bq_app *app)
{
    const bq_pack_fault_record *r = bq_app_pack(app)->fault;

    while (c->item < (uint16_t)BQ_FAULT_COUNT) {
        const uint16_t f = c->item++;
        if (r[f].count > 0u) {
            c->row = 1;
            fault_row(c, (bq_pack_fault)f, &r[f]);
            return CONSOLE_ROW;
        }
    }
    if (c->row > 0u) {
        return CONSOLE_DONE;
    }
    c->row = 1;
    console_text(c, "none since the start");
    return CONSOLE_ROW;
}

/* ---- counters ------------------------------------------------------------------------------------ */

/* Both structures hold nothing but counters, in the order of the names. */
console_row console_counters(bq_console *c, const bq_app *app)
{
    static const char format[] =
        "%[periods|steps|overruns|late scans|scan failures|sample failures|apply failures|bring-ups|"
        "bring-up failures|self-test failures|line failures|ammeter failures|precharge failures|"
        "transfers|bytes|scans|retries|crc errors|no answers|implausible|bus errors|write errors|"
        "recoveries] %0";
    const uint16_t loop = (uint16_t)(sizeof(bq_app_counters) / sizeof(uint32_t));
    const uint16_t link = (uint16_t)(sizeof(bq_link_stats) / sizeof(uint32_t));
    const void *from = bq_app_get_counters(app);
    uint16_t n = c->item++;
    int32_t v[2] = {n, 0};

    if (n >= loop) {
        n = (uint16_t)(n - loop);
        from = bq_app_link(app);
        if (n >= link || from == NULL) {
            return CONSOLE_DONE;
        }
    }
    memcpy(&v[1], (const unsigned char *)from + n * sizeof v[1], sizeof v[1]);
    console_say(c, format, v);
    return CONSOLE_ROW;
}
