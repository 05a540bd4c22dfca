/* SPDX-License-Identifier: Apache-2.0 */
/* For every fault: is its cause present in this picture, and where. */
#include "pack_internal.h"
#include <string.h>

/* Flags after which a monitor protects or measures nothing: acted on at once. */
#define CHIP_HARD (BQ_F_DIE_TEMP | BQ_F_SUPPLY | BQ_F_MEMORY | BQ_F_DEFECTIVE)
/* Flags a driver can cure: acted on when they last for comm_timeout_ms. BQ_F_COMM is judged by blindness. */
#define CHIP_SOFT (BQ_F_RESET | BQ_F_LOCKUP | BQ_F_CONFIG | BQ_F_BALANCE | BQ_F_CHAIN)

/* The comparators of a module and its wires, in the order of the faults from BQ_FAULT_CHIP_CELL_OV on. */
enum { CELL_OV, CELL_UV, OVERTEMP, OPEN_WIRE, LISTS };

#define NOT_VALID (-1)

/* In the module of the condition: its k-th (k from 0) cell or sensor, or the first one without a valid
 * reading. False if the module has none. */
static bool find(const bq_sample *s, bq_condition *c, bool sensor, int k)
{
    const unsigned count = sensor ? s->temp_count : s->cell_count, module = c->device - 1u;
    const bq_cell_reading *r = bq_reading(s, sensor, 0);

    for (unsigned n = 1; n <= count; n++, r++) {
        if (r->module != module || (k == NOT_VALID ? (r->quality & BQ_Q_VALID) != 0u : k-- != 0)) {
            continue;
        }
        if (sensor) {
            c->sensor = (uint8_t)n;
        } else {
            c->cell = (uint16_t)n;
        }
        return true;
    }
    return false;
}

static int lowest_bit(uint32_t mask)
{
    int n = 0;

    for (; (mask & 1u) == 0u; mask >>= 1) {
        n++;
    }
    return n;
}

static int32_t as_value(uint32_t ms)
{
    return ms > INT32_MAX ? INT32_MAX : (int32_t)ms;
}

/* Takes what shows the cause first, in place of what is only suspected. False if another one did before. */
static bool found(bq_condition *c, uint8_t device, int32_t value)
{
    if (c->broken && c->debounce_ms == 0u) {
        return false;
    }
    c->broken = true;
    c->debounce_ms = 0;
    c->device = device;
    c->value = value;
    return true;
}

/* What has to last for comm_timeout_ms. */
static void suspected(const bq_pack *p, bq_condition *c, uint8_t device, int32_t value)
{
    if (!c->broken) {
        (void)found(c, device, value);
        c->debounce_ms = p->config.comm_timeout_ms;
    }
}

/* A limit that must not be exceeded, or, where it lies below its release, not be undercut (~ turns the
 * order). */
static void limit(bq_condition *c, int32_t value, int32_t trip, int32_t clear)
{
    c->value = value;
    if (trip < clear) {
        value = ~value;
        trip = ~trip;
        clear = ~clear;
    }
    c->broken = value > trip;
    c->clear = value < clear;
}

static void judge_cells(const bq_pack *p, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;

    if (y->cell_max == 0u) {
        return;
    }
    limit(&c[BQ_FAULT_CELL_OV], y->cell_max_mv, k->cell_ov_mv, k->cell_ov_clear_mv);
    c[BQ_FAULT_CELL_OV].cell = y->cell_max;
    limit(&c[BQ_FAULT_CELL_UV], y->cell_min_mv, k->cell_uv_mv, k->cell_uv_clear_mv);
    c[BQ_FAULT_CELL_UV].cell = y->cell_min;
    limit(&c[BQ_FAULT_IMBALANCE], y->cell_max_mv - y->cell_min_mv,
          k->imbalance_mv != 0u ? k->imbalance_mv : UINT16_MAX, k->imbalance_clear_mv);
    c[BQ_FAULT_IMBALANCE].cell = y->cell_min;
}

static void judge_sensors(const bq_pack *p, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;

    if (y->temp_max == 0u) {
        return;
    }
    limit(&c[BQ_FAULT_OVERTEMP], y->temp_max_dc, k->overtemp_dc, k->overtemp_clear_dc);
    c[BQ_FAULT_OVERTEMP].sensor = y->temp_max;
    limit(&c[BQ_FAULT_UNDERTEMP], y->temp_min_dc, k->undertemp_dc, k->undertemp_clear_dc);
    c[BQ_FAULT_UNDERTEMP].sensor = y->temp_min;
}

/* Limits of the current, where there are any: then it must be known. */
static void judge_current(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const int32_t ma = v->s->current_ma;

    if (!v->current_known) {
        if (p->started && bq_pack_limits_current(k)) {
            (void)found(&c[BQ_FAULT_SENSOR], 0, as_value(v->s->current_age_ms));
        }
        return;
    }
    if (k->charge_max_ma != 0) {
        limit(&c[BQ_FAULT_CHARGE_CURRENT], ma, k->charge_max_ma, 0);
    }
    if (k->discharge_max_ma != 0) {
        limit(&c[BQ_FAULT_OVERCURRENT], ma, -k->discharge_max_ma, 0);
        c[BQ_FAULT_OVERCURRENT].debounce_ms = k->debounce_ms;
    }
}

/* Bit n of a list: cell, sensor or wire n. */
static void find_listed(const bq_sample *s, bq_condition *c, unsigned list, uint32_t bits)
{
    const int n = lowest_bit(bits);

    if (list == OPEN_WIRE) {
        c->wire = (int8_t)(n + 1);
    }
    if (!find(s, c, list == OVERTEMP, n) && list == OPEN_WIRE) { /* the top wire */
        (void)find(s, c, false, n - 1);
    }
}

static void judge_lists(const bq_sample *s, const bq_module_reading *r, uint8_t device, bq_condition *c)
{
    static const uint16_t flag[LISTS] = {BQ_F_CELL_OV, BQ_F_CELL_UV, BQ_F_OVERTEMP, BQ_F_OPEN_WIRE};
    const uint16_t bits[LISTS] = {r->cell_ov, r->cell_uv, r->sensor_ot, r->open_wire};

    c += BQ_FAULT_CHIP_CELL_OV;
    for (unsigned i = 0; i < LISTS; i++, c++) {
        if ((bits[i] != 0u || (r->faults & flag[i]) != 0u) && found(c, device, r->faults) && bits[i] != 0u) {
            find_listed(s, c, i, bits[i]);
        }
    }
}

static void judge_module(const bq_pack *p, const bq_sample *s, const bq_module_reading *r, uint8_t device,
                         bq_condition *c)
{
    const uint16_t flags = r->faults;

    if ((flags & CHIP_HARD) != 0u) {
        (void)found(&c[BQ_FAULT_CHIP], device, flags);
    } else if ((flags & CHIP_SOFT) != 0u) {
        suspected(p, &c[BQ_FAULT_CHIP], device, flags);
    }
    if ((flags & BQ_F_SUPPLY) != 0u) {
        return;
    }
    if ((flags & (BQ_F_OVERCURRENT | BQ_F_SHORT)) != 0u) {
        (void)found(&c[BQ_FAULT_OVERCURRENT], device, flags);
    }
    judge_lists(s, r, device, c);
}

static void judge_modules(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    for (uint16_t m = 0; m < v->s->module_count; m++) {
        judge_module(p, v->s, &v->s->modules[m], (uint8_t)(m + 1u), c);
    }
    if (v->open_cell != 0u && found(&c[BQ_FAULT_OPEN_WIRE], 0, 0)) {
        c[BQ_FAULT_OPEN_WIRE].cell = v->open_cell;
    }
}

/* Why a module has been blind for too long: a fault is broken, or one that explains it is active. */
static void judge_blind(const bq_pack *p, const bq_picture *v, uint16_t m, bq_condition *c)
{
    const uint8_t wrong = v->module[m], device = (uint8_t)(m + 1u);
    const uint32_t explained = (1ul << BQ_FAULT_OPEN_WIRE) | (1ul << BQ_FAULT_CHIP);
    const int32_t blind = as_value(p->blind_ms[m]);

    if (v->s == NULL || (wrong & (BQ_MODULE_OLD | BQ_MODULE_SILENT)) != 0u) {
        (void)found(&c[BQ_FAULT_COMM_LOSS], device, blind);
        return;
    }
    if ((wrong & BQ_MODULE_NO_CELL) != 0u && (p->faults & explained) == 0u &&
        found(&c[BQ_FAULT_NO_READING], device, blind)) {
        (void)find(v->s, &c[BQ_FAULT_NO_READING], false, NOT_VALID);
    }
    if ((wrong & BQ_MODULE_NO_TEMP) != 0u && found(&c[BQ_FAULT_SENSOR], device, blind)) {
        (void)find(v->s, &c[BQ_FAULT_SENSOR], true, NOT_VALID);
    }
}

static void judge_input(const bq_pack *p, const bq_pack_input *in, bq_condition *c)
{
    if (in->self_test == BQ_TEST_FAILED) {
        (void)found(&c[BQ_FAULT_SELF_TEST], 0, (int32_t)in->self_test_status);
    }
    if (in->monitor == BQ_MONITOR_FAILED) {
        (void)found(&c[BQ_FAULT_CONFIG], 0, (int32_t)in->monitor_status);
    }
    if (in->contactor_mismatch_ms >= BQ_PACK_MISMATCH_MS) {
        (void)found(&c[BQ_FAULT_CONTACTOR], 0, as_value(in->contactor_mismatch_ms));
    }
    if (in->apply_status < 0 && in->apply_status != BQ_E_STATE) {
        suspected(p, &c[BQ_FAULT_CHIP], 0, (int32_t)in->apply_status);
    }
}

void bq_pack_judge(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    memset(c, 0, sizeof *c * BQ_FAULT_COUNT);
    if (v->live && v->s != NULL) {
        judge_cells(p, c);
        judge_sensors(p, c);
        judge_current(p, v, c);
        judge_modules(p, v, c);
    }
    for (uint16_t m = 0; v->live && m < p->config.modules; m++) {
        if (p->blind_ms[m] > p->config.comm_timeout_ms) {
            judge_blind(p, v, m, c);
        }
    }
    judge_input(p, v->in, c);
}
