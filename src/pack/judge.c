/* SPDX-License-Identifier: Apache-2.0 */
/* For every fault: is its cause present in this picture, and where. */
#include "pack_internal.h"
#include <string.h>

/* Flags after which a monitor protects or measures nothing: acted on at once. */
#define CHIP_HARD (BQ_F_DIE_TEMP | BQ_F_SUPPLY | BQ_F_MEMORY | BQ_F_DEFECTIVE)
/* Flags a driver can cure: acted on when they last for comm_timeout_ms. BQ_F_COMM is judged by blindness. */
#define CHIP_SOFT (BQ_F_RESET | BQ_F_LOCKUP | BQ_F_CONFIG | BQ_F_BALANCE | BQ_F_CHAIN)

/* Number, counted from 1, of the k-th (k from 0) cell or sensor of module m, or of its k-th without a valid
 * reading; 0 if the module has fewer. */
static uint16_t place(const bq_sample *s, bool sensor, uint16_t m, uint16_t k, bool bad)
{
    const uint16_t count = sensor ? s->temp_count : s->cell_count;

    for (uint16_t i = 0; i < count; i++) {
        const uint8_t module = sensor ? s->temps[i].module : s->cells[i].module;
        const uint8_t quality = sensor ? s->temps[i].quality : s->cells[i].quality;
        if (module == m && !(bad && (quality & BQ_Q_VALID) != 0u) && k-- == 0u) {
            return (uint16_t)(i + 1u);
        }
    }
    return 0;
}

static uint16_t lowest_bit(uint32_t mask)
{
    uint16_t n = 0;

    while (n < 31u && ((mask >> n) & 1u) == 0u) {
        n++;
    }
    return n;
}

static int32_t as_value(uint32_t ms)
{
    return ms > INT32_MAX ? INT32_MAX : (int32_t)ms;
}

/* A limit that must not be exceeded, by the value of one cell or one sensor. */
static void judge_high(bq_condition *c, int32_t value, int32_t trip, int32_t clear)
{
    c->value = value;
    c->broken = value > trip;
    c->clear = value < clear;
}

static void judge_low(bq_condition *c, int32_t value, int32_t trip, int32_t clear)
{
    judge_high(c, -value, -trip, -clear);
    c->value = value;
}

static void at_cell(bq_condition *c, const bq_sample *s, uint16_t cell)
{
    c->cell = cell;
    c->device = (uint8_t)(s->cells[cell - 1u].module + 1u);
}

static void at_sensor(bq_condition *c, const bq_sample *s, uint8_t sensor)
{
    c->sensor = sensor;
    c->device = (uint8_t)(s->temps[sensor - 1u].module + 1u);
}

static void judge_cells(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;

    if (y->cell_max == 0u) {
        return;
    }
    judge_high(&c[BQ_FAULT_CELL_OV], y->cell_max_mv, k->cell_ov_mv, k->cell_ov_clear_mv);
    at_cell(&c[BQ_FAULT_CELL_OV], v->s, y->cell_max);
    judge_low(&c[BQ_FAULT_CELL_UV], y->cell_min_mv, k->cell_uv_mv, k->cell_uv_clear_mv);
    at_cell(&c[BQ_FAULT_CELL_UV], v->s, y->cell_min);
    judge_high(&c[BQ_FAULT_IMBALANCE], y->cell_max_mv - y->cell_min_mv,
               k->imbalance_mv != 0u ? k->imbalance_mv : UINT16_MAX, k->imbalance_clear_mv);
    at_cell(&c[BQ_FAULT_IMBALANCE], v->s, y->cell_min);
}

static void judge_sensors(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;

    if (y->temp_max == 0u) {
        return;
    }
    judge_high(&c[BQ_FAULT_OVERTEMP], y->temp_max_dc, k->overtemp_dc, k->overtemp_clear_dc);
    at_sensor(&c[BQ_FAULT_OVERTEMP], v->s, y->temp_max);
    judge_low(&c[BQ_FAULT_UNDERTEMP], y->temp_min_dc, k->undertemp_dc, k->undertemp_clear_dc);
    at_sensor(&c[BQ_FAULT_UNDERTEMP], v->s, y->temp_min);
}

/* Limits of the current, where there are any: then it must be known. */
static void judge_current(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const int32_t ma = v->s->current_ma;

    if (!v->current_known) {
        c[BQ_FAULT_SENSOR].broken = p->started && bq_pack_limits_current(k);
        c[BQ_FAULT_SENSOR].value = as_value(v->s->current_age_ms);
        return;
    }
    if (k->charge_max_ma != 0) {
        judge_high(&c[BQ_FAULT_CHARGE_CURRENT], ma, k->charge_max_ma, 0);
    }
    if (k->discharge_max_ma != 0) {
        judge_low(&c[BQ_FAULT_OVERCURRENT], ma, -k->discharge_max_ma, 0);
        c[BQ_FAULT_OVERCURRENT].debounce_ms = k->debounce_ms;
    }
}

/* Takes the first module that shows the cause. False if another one did before. */
static bool first(bq_condition *c, uint16_t m, int32_t value)
{
    if (c->broken) {
        return false;
    }
    c->broken = true;
    c->device = (uint8_t)(m + 1u);
    c->value = value;
    return true;
}

static void judge_chip(const bq_pack *p, uint16_t m, uint16_t flags, bq_condition *c)
{
    bq_condition *chip = &c[BQ_FAULT_CHIP];

    if ((flags & CHIP_HARD) != 0u) {
        if (chip->debounce_ms != 0u) { /* so far a soft one only */
            chip->broken = false;
        }
        (void)first(chip, m, flags);
        chip->debounce_ms = 0;
    } else if ((flags & CHIP_SOFT) != 0u && first(chip, m, flags)) {
        chip->debounce_ms = p->config.comm_timeout_ms;
    }
}

/* A comparator of module m: its flag, and a bit for each cell or sensor it sees. */
static void judge_comparator(const bq_picture *v, uint16_t m, bool set, uint32_t bits, bq_condition *c,
                             bool sensor)
{
    if ((set || bits != 0u) && first(c, m, v->s->modules[m].faults) && bits != 0u) {
        const uint16_t n = place(v->s, sensor, m, lowest_bit(bits), false);
        if (sensor) {
            c->sensor = (uint8_t)n;
        } else {
            c->cell = n;
        }
    }
}

static void judge_comparators(const bq_picture *v, uint16_t m, uint16_t flags, bq_condition *c)
{
    const bq_module_reading *r = &v->s->modules[m];

    judge_comparator(v, m, (flags & BQ_F_CELL_OV) != 0u, r->cell_ov, &c[BQ_FAULT_CHIP_CELL_OV], false);
    judge_comparator(v, m, (flags & BQ_F_CELL_UV) != 0u, r->cell_uv, &c[BQ_FAULT_CHIP_CELL_UV], false);
    judge_comparator(v, m, (flags & BQ_F_OVERTEMP) != 0u, r->sensor_ot, &c[BQ_FAULT_CHIP_OVERTEMP], true);
    if ((flags & (BQ_F_OVERCURRENT | BQ_F_SHORT)) != 0u && c[BQ_FAULT_OVERCURRENT].debounce_ms != 0u) {
        c[BQ_FAULT_OVERCURRENT].broken = false; /* so far a limit of the pack only */
        c[BQ_FAULT_OVERCURRENT].debounce_ms = 0;
    }
    judge_comparator(v, m, (flags & (BQ_F_OVERCURRENT | BQ_F_SHORT)) != 0u, 0, &c[BQ_FAULT_OVERCURRENT],
                     false);
}

static void judge_wires(const bq_picture *v, uint16_t m, uint16_t flags, bq_condition *c)
{
    const uint16_t wires = v->s->modules[m].open_wire;
    bq_condition *w = &c[BQ_FAULT_OPEN_WIRE];

    if ((wires != 0u || (flags & BQ_F_OPEN_WIRE) != 0u) && first(w, m, flags) && wires != 0u) {
        const uint16_t wire = lowest_bit(wires);
        w->wire = (int8_t)wire;
        w->cell = place(v->s, false, m, wire, false);
        if (w->cell == 0u) { /* the top wire */
            w->cell = place(v->s, false, m, (uint16_t)(wire - 1u), false);
        }
    }
}

static void judge_modules(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    for (uint16_t m = 0; m < v->s->module_count; m++) {
        const bq_module_reading *r = &v->s->modules[m];
        const bool lockout = (r->faults & BQ_F_SUPPLY) != 0u;
        judge_chip(p, m, r->faults, c);
        if (!lockout) {
            judge_comparators(v, m, r->faults, c);
            judge_wires(v, m, r->faults, c);
        }
    }
    if (v->open_cell != 0u && !c[BQ_FAULT_OPEN_WIRE].broken) {
        c[BQ_FAULT_OPEN_WIRE].broken = true;
        at_cell(&c[BQ_FAULT_OPEN_WIRE], v->s, v->open_cell);
    }
}

/* Why a module has been blind for too long: a fault is broken, or one that explains it is active. */
static void judge_blind(const bq_pack *p, const bq_picture *v, uint16_t m, bq_condition *c)
{
    const uint8_t wrong = v->module[m];
    const uint32_t explained = (1ul << BQ_FAULT_OPEN_WIRE) | (1ul << BQ_FAULT_CHIP);
    const int32_t blind = as_value(p->blind_ms[m]);

    if (v->s == NULL || (wrong & (BQ_MODULE_OLD | BQ_MODULE_SILENT)) != 0u) {
        (void)first(&c[BQ_FAULT_COMM_LOSS], m, blind);
        return;
    }
    if ((wrong & BQ_MODULE_NO_CELL) != 0u && (p->faults & explained) == 0u &&
        first(&c[BQ_FAULT_NO_READING], m, blind)) {
        c[BQ_FAULT_NO_READING].cell = place(v->s, false, m, 0, true);
    }
    if ((wrong & BQ_MODULE_NO_TEMP) != 0u && first(&c[BQ_FAULT_SENSOR], m, blind)) {
        c[BQ_FAULT_SENSOR].sensor = (uint8_t)place(v->s, true, m, 0, true);
    }
}

static void judge_input(const bq_pack *p, const bq_pack_input *in, bq_condition *c)
{
    c[BQ_FAULT_SELF_TEST].broken = in->self_test == BQ_TEST_FAILED;
    c[BQ_FAULT_SELF_TEST].value = (int32_t)in->self_test_status;
    c[BQ_FAULT_CONFIG].broken = in->monitor == BQ_MONITOR_FAILED;
    c[BQ_FAULT_CONFIG].value = (int32_t)in->monitor_status;
    c[BQ_FAULT_CONTACTOR].broken = in->contactor_mismatch_ms >= BQ_PACK_MISMATCH_MS;
    c[BQ_FAULT_CONTACTOR].value = as_value(in->contactor_mismatch_ms);
    if (in->apply_status < 0 && in->apply_status != BQ_E_STATE && !c[BQ_FAULT_CHIP].broken) {
        c[BQ_FAULT_CHIP].broken = true;
        c[BQ_FAULT_CHIP].debounce_ms = p->config.comm_timeout_ms;
        c[BQ_FAULT_CHIP].value = (int32_t)in->apply_status;
    }
}

void bq_pack_judge(const bq_pack *p, const bq_picture *v, const bq_pack_input *in, bq_condition *c)
{
    memset(c, 0, sizeof *c * BQ_FAULT_COUNT);
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++) {
        c[f].wire = -1;
    }
    if (v->live && v->s != NULL) {
        judge_cells(p, v, c);
        judge_sensors(p, v, c);
        judge_current(p, v, c);
        judge_modules(p, v, c);
    }
    for (uint16_t m = 0; v->live && m < p->config.modules; m++) {
        if (p->blind_ms[m] > p->config.comm_timeout_ms) {
            judge_blind(p, v, m, c);
        }
    }
    judge_input(p, in, c);
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++) {
        if (f == BQ_FAULT_OPEN_WIRE || f == BQ_FAULT_CHARGE_CURRENT || f <= BQ_FAULT_IMBALANCE) {
            c[f].debounce_ms = p->config.debounce_ms;
        }
        if (f > BQ_FAULT_IMBALANCE) {
            c[f].clear = !c[f].broken;
        }
    }
}
