/* SPDX-License-Identifier: Apache-2.0 */
/* For every fault: is its cause present in this picture, and where. */
#include "pack_internal.h"
#include <string.h>

/* Flags after which a monitor protects or measures nothing: acted on at once. */
#define CHIP_HARD (BQ_F_DIE_TEMP | BQ_F_SUPPLY | BQ_F_MEMORY | BQ_F_DEFECTIVE)
/* Flags a driver can cure: acted on when they last for comm_timeout_ms. BQ_F_COMM is judged by blindness. */
#define CHIP_SOFT (BQ_F_RESET | BQ_F_LOCKUP | BQ_F_CONFIG | BQ_F_BALANCE | BQ_F_CHAIN)

/* Number, counted from 1, of the k-th cell (sensor) of module m, k from 0; 0 if the module has fewer. */
static uint16_t cell_of(const bq_sample *s, uint16_t m, uint16_t k)
{
    for (uint16_t i = 0; i < s->cell_count; i++) {
        if (s->cells[i].module == m && k-- == 0u) {
            return (uint16_t)(i + 1u);
        }
    }
    return 0;
}

static uint8_t sensor_of(const bq_sample *s, uint16_t m, uint16_t k)
{
    for (uint16_t i = 0; i < s->temp_count; i++) {
        if (s->temps[i].module == m && k-- == 0u) {
            return (uint8_t)(i + 1u);
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

static void at_cell(bq_condition *c, const bq_sample *s, uint16_t cell, int32_t value)
{
    c->cell = cell;
    c->device = cell == 0u ? 0u : (uint8_t)(s->cells[cell - 1u].module + 1u);
    c->value = value;
}

static void at_sensor(bq_condition *c, const bq_sample *s, uint8_t sensor, int32_t value)
{
    c->sensor = sensor;
    c->device = sensor == 0u ? 0u : (uint8_t)(s->temps[sensor - 1u].module + 1u);
    c->value = value;
}

static void judge_cells(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;
    const uint16_t spread = (uint16_t)(y->cell_max_mv - y->cell_min_mv);

    if (y->cell_max == 0u) {
        return;
    }
    c[BQ_FAULT_CELL_OV].broken = y->cell_max_mv > k->cell_ov_mv;
    c[BQ_FAULT_CELL_OV].clear = y->cell_max_mv < k->cell_ov_clear_mv;
    at_cell(&c[BQ_FAULT_CELL_OV], v->s, y->cell_max, y->cell_max_mv);
    c[BQ_FAULT_CELL_UV].broken = y->cell_min_mv < k->cell_uv_mv;
    c[BQ_FAULT_CELL_UV].clear = y->cell_min_mv > k->cell_uv_clear_mv;
    at_cell(&c[BQ_FAULT_CELL_UV], v->s, y->cell_min, y->cell_min_mv);
    c[BQ_FAULT_IMBALANCE].broken = k->imbalance_mv != 0u && spread > k->imbalance_mv;
    c[BQ_FAULT_IMBALANCE].clear = spread < k->imbalance_clear_mv;
    at_cell(&c[BQ_FAULT_IMBALANCE], v->s, y->cell_min, spread);
}

static void judge_sensors(const bq_pack *p, const bq_picture *v, bq_condition *c)
{
    const bq_pack_config *k = &p->config;
    const bq_pack_summary *y = &p->summary;

    if (y->temp_max == 0u) {
        return;
    }
    c[BQ_FAULT_OVERTEMP].broken = y->temp_max_dc > k->overtemp_dc;
    c[BQ_FAULT_OVERTEMP].clear = y->temp_max_dc < k->overtemp_clear_dc;
    at_sensor(&c[BQ_FAULT_OVERTEMP], v->s, y->temp_max, y->temp_max_dc);
    c[BQ_FAULT_UNDERTEMP].broken = y->temp_min_dc < k->undertemp_dc;
    c[BQ_FAULT_UNDERTEMP].clear = y->temp_min_dc > k->undertemp_clear_dc;
    at_sensor(&c[BQ_FAULT_UNDERTEMP], v->s, y->temp_min, y->temp_min_dc);
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

static void judge_comparators(const bq_picture *v, uint16_t m, uint16_t flags, bq_condition *c)
{
    const bq_module_reading *r = &v->s->modules[m];

    if (((flags & BQ_F_CELL_OV) != 0u || r->cell_ov != 0u) && first(&c[BQ_FAULT_CHIP_CELL_OV], m, flags)) {
        c[BQ_FAULT_CHIP_CELL_OV].cell = r->cell_ov != 0u ? cell_of(v->s, m, lowest_bit(r->cell_ov)) : 0u;
    }
    if (((flags & BQ_F_CELL_UV) != 0u || r->cell_uv != 0u) && first(&c[BQ_FAULT_CHIP_CELL_UV], m, flags)) {
        c[BQ_FAULT_CHIP_CELL_UV].cell = r->cell_uv != 0u ? cell_of(v->s, m, lowest_bit(r->cell_uv)) : 0u;
    }
    if (((flags & BQ_F_OVERTEMP) != 0u || r->sensor_ot != 0u) &&
        first(&c[BQ_FAULT_CHIP_OVERTEMP], m, flags)) {
        c[BQ_FAULT_CHIP_OVERTEMP].sensor =
            r->sensor_ot != 0u ? sensor_of(v->s, m, lowest_bit(r->sensor_ot)) : (uint8_t)0;
    }
    if ((flags & (BQ_F_OVERCURRENT | BQ_F_SHORT)) != 0u) {
        (void)first(&c[BQ_FAULT_OVERCURRENT], m, flags);
    }
}

static void judge_wires(const bq_picture *v, uint16_t m, uint16_t flags, bq_condition *c)
{
    const bq_module_reading *r = &v->s->modules[m];
    bq_condition *w = &c[BQ_FAULT_OPEN_WIRE];

    if ((r->open_wire != 0u || (flags & BQ_F_OPEN_WIRE) != 0u) && first(w, m, flags) && r->open_wire != 0u) {
        const uint16_t wire = lowest_bit(r->open_wire);
        w->wire = (int8_t)wire;
        w->cell = cell_of(v->s, m, wire);
        if (w->cell == 0u) { /* the top wire */
            w->cell = cell_of(v->s, m, (uint16_t)(wire - 1u));
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
        at_cell(&c[BQ_FAULT_OPEN_WIRE], v->s, v->open_cell, 0);
    }
}

/* First cell (sensor) of a module without a valid reading; 0 = none. */
static uint16_t bad_cell(const bq_sample *s, uint16_t m)
{
    for (uint16_t i = 0; i < s->cell_count; i++) {
        if (s->cells[i].module == m && (s->cells[i].quality & BQ_Q_VALID) == 0u) {
            return (uint16_t)(i + 1u);
        }
    }
    return 0;
}

static uint8_t bad_sensor(const bq_sample *s, uint16_t m)
{
    for (uint16_t i = 0; i < s->temp_count; i++) {
        if (s->temps[i].module == m && (s->temps[i].quality & BQ_Q_VALID) == 0u) {
            return (uint8_t)(i + 1u);
        }
    }
    return 0;
}

/* Why a module has been blind for too long: a fault is broken, or one that explains it is active. */
static void judge_blind(const bq_pack *p, const bq_picture *v, uint16_t m, bq_condition *c)
{
    const uint64_t bit = (uint64_t)1 << m;
    const uint32_t explained = (1ul << BQ_FAULT_OPEN_WIRE) | (1ul << BQ_FAULT_CHIP);
    const int32_t blind = p->blind_ms[m] > INT32_MAX ? INT32_MAX : (int32_t)p->blind_ms[m];

    if (v->s == NULL || ((v->old | v->silent) & bit) != 0u) {
        (void)first(&c[BQ_FAULT_COMM_LOSS], m, blind);
        return;
    }
    if ((v->no_cell & bit) != 0u && (p->faults & explained) == 0u &&
        first(&c[BQ_FAULT_NO_READING], m, blind)) {
        c[BQ_FAULT_NO_READING].cell = bad_cell(v->s, m);
    }
    if ((v->no_temp & bit) != 0u && first(&c[BQ_FAULT_SENSOR], m, blind)) {
        c[BQ_FAULT_SENSOR].sensor = bad_sensor(v->s, m);
    }
}

static void judge_input(const bq_pack *p, const bq_pack_input *in, bq_condition *c)
{
    c[BQ_FAULT_SELF_TEST].broken = in->self_test == BQ_TEST_FAILED;
    c[BQ_FAULT_SELF_TEST].value = (int32_t)in->self_test_status;
    c[BQ_FAULT_CONFIG].broken = in->monitor == BQ_MONITOR_FAILED;
    c[BQ_FAULT_CONFIG].value = (int32_t)in->monitor_status;
    c[BQ_FAULT_CONTACTOR].broken = in->contactor_mismatch_ms >= BQ_PACK_MISMATCH_MS;
    c[BQ_FAULT_CONTACTOR].value =
        in->contactor_mismatch_ms > INT32_MAX ? INT32_MAX : (int32_t)in->contactor_mismatch_ms;
    if (in->apply_status < 0 && !c[BQ_FAULT_CHIP].broken) {
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
        judge_modules(p, v, c);
    }
    for (uint16_t m = 0; v->live && m < p->config.modules; m++) {
        if (p->blind_ms[m] > p->config.comm_timeout_ms) {
            judge_blind(p, v, m, c);
        }
    }
    judge_input(p, in, c);
    for (unsigned f = 0; f < BQ_FAULT_COUNT; f++) {
        if (f == BQ_FAULT_OPEN_WIRE || f <= BQ_FAULT_IMBALANCE) {
            c[f].debounce_ms = p->config.debounce_ms;
        }
        if (f > BQ_FAULT_IMBALANCE) {
            c[f].clear = !c[f].broken;
        }
    }
}
