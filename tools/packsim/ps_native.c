/* SPDX-License-Identifier: Apache-2.0 */
/* The firmware compiled for this computer, its board made of the back-end that ends in the simulator. */
#include "ps_rig.h"

#include <math.h>
#include <string.h>

#define POISON 0xa5

static bq_status read_ammeter(void *ctx, int32_t *current_ma)
{
    ps_rig *r = ctx;
    *current_ma = (int32_t)lround(ps_rig_current_at(r, ps_rig_now(r)) * 1000.0);
    return BQ_OK;
}

static void feed_watchdog(void *ctx)
{
    ps_rig *r = ctx;
    uint64_t gap = ps_rig_now(r) - r->fed_t;
    r->fed_gap = gap > r->fed_gap ? gap : r->fed_gap;
    r->fed_t += gap;
}

/* Carried out when the present pass has returned: ps_rig_sync(). */
static void ask_reset(void *ctx)
{
    ((ps_rig *)ctx)->reset_asked = true;
}

static uint32_t stack_free(void *ctx)
{
    (void)ctx;
    return 0; /* of a PC nobody knows */
}

static bq_board board_of(ps_rig *r)
{
    static const bq_mcu_ops mcu = {feed_watchdog, ask_reset, stack_free};
    bq_board board = {0};
    board.name = "packsim";
    board.gpio = r->monitor->gpio(r);
    board.clock = r->monitor->clock(r);
    if (!r->monitor->measures_current) {
        board.ammeter = (bq_ammeter){read_ammeter, r};
    }
    board.can = r->can;
    board.console = r->console;
    board.mcu = (bq_mcu){&mcu, r, &r->boot};
    return board;
}

static bq_status boot(ps_rig *r, bq_reset_cause cause)
{
    ps_firmware *f = &r->fw;
    const bq_board board = board_of(r);
    bq_status status = r->monitor->init(r);
    if (status != BQ_OK) {
        return status;
    }
    r->boot = (bq_boot){.cause = cause, .image_ok = true};
    r->reset_asked = false;
    r->fed_t = ps_rig_now(r);
    status = bq_firmware_init(&f->firmware, &board, &r->s->app, &r->afe, f->cells, SIM_CELLS_MAX, f->temps,
                              SIM_CELLS_MODULES * SIM_CELLS_SENSORS, f->modules, SIM_CELLS_MODULES);
    if (status == BQ_OK) {
        bq_app_use_precharge(bq_firmware_app(&f->firmware));
    }
    return status;
}

static void keep_stats(ps_rig *r)
{
    const bq_link_stats *s = r->afe.ops->stats(r->afe.ctx);
    r->lost.crc_errors += s->crc_errors;
    r->lost.no_answers += s->no_answers;
    r->lost.implausible += s->implausible;
    r->lost.bus_errors += s->bus_errors;
    r->lost.write_errors += s->write_errors;
}

static void request(ps_rig *r)
{
    (void)bq_firmware_request(&r->fw.firmware, r->request);
}

/* Memory as a reset leaves it, pins released, start from the reset vector. What the user asks for stays. */
static void restart(ps_rig *r, bq_reset_cause cause)
{
    keep_stats(r);
    memset(&r->fw, POISON, sizeof r->fw);
    r->monitor->release(r);
    (void)boot(r, cause);
    request(r);
}

static void reset(ps_rig *r)
{
    restart(r, BQ_RESET_PIN);
}

static bool restarted(ps_rig *r)
{
    if (!r->reset_asked) {
        return false;
    }
    restart(r, BQ_RESET_SOFTWARE);
    return true;
}

static int begin(ps_rig *r, ps_error *e)
{
    bq_status status = boot(r, BQ_RESET_POWER);
    if (status != BQ_OK) {
        return ps_fail(e, r->s->pack_at, "the firmware refuses this configuration (%s)",
                       bq_status_name(status));
    }
    request(r);
    return 0;
}

static void end(ps_rig *r)
{
    (void)r;
}

static uint64_t pass(ps_rig *r)
{
    return (uint64_t)bq_firmware_step(&r->fw.firmware) * 1000u;
}

static sim_misuse *no_judge(ps_rig *r)
{
    (void)r;
    return NULL;
}

const ps_player ps_native = {
    .begin = begin,
    .end = end,
    .pass = pass,
    .elapse = ps_rig_advance,
    .request = request,
    .reset = reset,
    .restarted = restarted,
    .misuse = no_judge,
};
