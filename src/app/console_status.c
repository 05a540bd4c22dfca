/* SPDX-License-Identifier: Apache-2.0 */
/* The commands status and version: one row for each subject. */
#include "bqhost/field.h"
#include "bqhost/text.h"
#include "bqhost/version.h"
#include "console_internal.h"
#include <string.h>

#define MOST_VALUES 5u

#define U(member) BQ_FIELD(bq_app, member, BQ_FIELD_UNSIGNED)
#define S(member) BQ_FIELD(bq_app, member, BQ_FIELD_SIGNED)

/* What the rows show, one row after the other. The last ones are there to be read beyond the last row. */
/* clang-format off */
static const bq_field fields[] = {
    /*  0 state     */ U(pack.state), U(pack.state_ms),
    /*  2 outputs   */ U(action.charge_on), U(action.discharge_on), U(line_on),
    /*  5 request   */ U(input.request),
    /*  6 pack      */ U(pack.summary.pack_mv), U(pack.summary.complete), U(pack.summary.blind_ms),
    /*  9 cells     */ U(pack.summary.cell_min), U(pack.summary.cell_min_mv), U(pack.summary.cell_min),
                       U(pack.summary.cell_max_mv), U(pack.summary.cell_max),
    /* 14 sensors   */ U(pack.summary.temp_min), S(pack.summary.temp_min_dc), U(pack.summary.temp_min),
                       S(pack.summary.temp_max_dc), U(pack.summary.temp_max),
    /* 19 current   */ U(sample.current_valid), S(sample.current_ma), U(sample.current_age_ms),
    /* 22 charge    */ U(pack.soc.valid), S(pack.summary.soc_permille),
    /* 24 balance   */ U(input.balance_off), U(pack.summary.balancing),
    /* 26 monitor   */ U(input.monitor), U(input.monitor) /* modules */, S(input.monitor_status),
    /* 29 self-test */ U(input.self_test), S(input.self_test_status),
                       U(now_ms), U(now_ms), U(now_ms)};
/* clang-format on */

/* Where in `fields` a row begins. */
static const uint8_t first[] = {0, 2, 5, 5, 6, 9, 14, 19, 22, 24, 26, 29};

/* clang-format off */
static const char formats[] =
    "state     %S for %T s\0"
    "outputs   charge %[off|on], discharge %[off|on], contactor %[off|on]\0"
    "request   %[off|on|sleep]\0"
    "cause     %F, held by %H\0"
    "pack      %3 V, %[not complete|complete]%a\0"
    "cells     %?%3 V (%0) to %3 V (%0)\0"
    "sensors   %?%1 C (%0) to %1 C (%0)\0"
    "current   %?%3 A%a\0"
    "charge    %?%1 %\0"
    "balance   %[allowed|forbidden], cells %0\0"
    "monitor   %[down|up|failed], modules %0, %E\0"
    "self-test %[not done|passed|failed], %E\0"
    "can       %[active|passive|bus-off|none]\0"
    "uptime    %t s";
/* clang-format on */

enum { ROW_CAUSE = 3, ROW_PACK = 4, ROW_MONITOR = 10, ROW_CAN = 12, ROWS = 14 };

/* The values of one row, and what follows them in `fields`; returns its format. */
static const char *look(const bq_app *app, unsigned row, int32_t *v)
{
    const bq_pack *p = bq_app_pack(app);

    for (unsigned i = 0; i < MOST_VALUES; i++) {
        v[i] = (int32_t)bq_field_load(fields[first[row] + i], app);
    }
    if (row == ROW_CAUSE) {
        const bq_pack_fault f = bq_pack_cause(p);
        if (f == BQ_FAULT_COUNT) {
            return "cause     none";
        }
        v[0] = (int32_t)f;
        v[1] = (int32_t)p->fault[f].hold;
    } else if (row == ROW_PACK && bq_app_sample(app)->cell_count == 0u) {
        v[2] = -1;
    } else if (row == ROW_MONITOR) {
        v[1] = bq_app_modules_found(app);
    }
    return bq_word(formats, row);
}

static void refused(bq_console *c, const bq_console_target *t)
{
    const int32_t v = (int32_t)t->refused;

    console_say(c, "refused   %E ", &v);
    console_text(c, t->what != NULL ? t->what : "");
    console_text(c, ", outputs stay off");
}

console_row console_status(bq_console *c, const bq_console_target *t)
{
    const unsigned row = c->row++;
    int32_t v[MOST_VALUES];

    if (row >= ROWS) {
        return CONSOLE_DONE;
    }
    if (row >= ROW_CAN) {
        v[0] = (int32_t)t->now_ms;
        if (row == ROW_CAN) {
            v[0] = t->can != NULL && t->can->ops != NULL ? (int32_t)t->can->ops->state(t->can->ctx) : 3;
        }
        console_say(c, bq_word(formats, row), v);
    } else if (t->app != NULL) {
        console_say(c, look(t->app, row, v), v);
    } else {
        c->row = ROW_CAN;
        refused(c, t);
    }
    return CONSOLE_ROW;
}

/* ---- version ------------------------------------------------------------------------------------ */

static void identity(bq_console *c, const bq_console_target *t)
{
    console_text(c, "bqhost " BQHOST_VERSION " ");
    console_text(c, t->name != NULL ? t->name : "");
}

/* The words of a crash, as they stand in their structure: five in the first row, four in the second. */
static void crash(bq_console *c, const bq_crash *k, bool second)
{
    int32_t v[sizeof *k / sizeof(int32_t)];

    memcpy(v, k, sizeof v);
    if (second) {
        console_say(c, "          psr %X cfsr %X hfsr %X address %X", &v[5]);
    } else {
        console_say(c, "crash     kind %0 pc %X lr %X sp %X after %t s", v);
    }
}

static void start(bq_console *c, const bq_mcu *m)
{
    const bq_boot *b = m->boot;
    const int32_t v[] = {(int32_t)b->cause, b->crystal_failed, (int32_t)b->image_crc, b->image_ok,
                         m->ops != NULL ? (int32_t)m->ops->stack_free(m->ctx) : 0};

    console_say(c,
                "reset by  %[unknown|power-on|brown-out|pin|software|watchdog|crash]%[|, crystal failed], "
                "image %X %[damaged|ok], stack left %0",
                v);
}

console_row console_version(bq_console *c, const bq_console_target *t)
{
    const bq_boot *b = t->mcu != NULL ? t->mcu->boot : NULL;
    const uint16_t row = c->row++;

    if (row > 3u || (row > 0u && b == NULL) || (row > 1u && !b->crashed)) {
        return CONSOLE_DONE;
    }
    switch (row) {
    case 0:
        identity(c, t);
        break;
    case 1:
        start(c, t->mcu);
        break;
    default:
        crash(c, &b->crash, row == 3u);
        break;
    }
    return CONSOLE_ROW;
}
