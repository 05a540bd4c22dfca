/* SPDX-License-Identifier: Apache-2.0 */
#include "rig.h"
#include "unity.h"
#include <string.h>

bq_pack_config rig_config(void)
{
    bq_pack_config c = bq_pack_config_nmc(RIG_CELLS, RIG_SENSORS, RIG_MODULES);

    c.cell_ov_mv = 4200;
    c.cell_ov_clear_mv = 4100;
    c.cell_uv_mv = 3000;
    c.cell_uv_clear_mv = 3200;
    c.overtemp_dc = 600;
    c.overtemp_clear_dc = 550;
    c.undertemp_dc = 0;
    c.undertemp_clear_dc = 50;
    c.imbalance_mv = 0;
    c.imbalance_clear_mv = 0;
    c.debounce_ms = 300;
    c.recover_ms = 1000;
    c.comm_timeout_ms = 500;
    c.balance_start_mv = 20;
    c.balance_stop_mv = 5;
    c.balance_min_cell_mv = 3400;
    c.balance_max_temp_dc = 450;
    c.balance_rest_ma = 200;
    c.balance_rest_ms = 1000;
    c.balance_duty_percent = 100;
    c.balance_max_per_module = 0;
    return c;
}

void rig_all_cells(rig *r, uint16_t mv)
{
    for (int i = 0; i < RIG_CELLS; i++) {
        r->cells[i].mv = mv;
    }
}

void rig_all_temps(rig *r, int16_t dc)
{
    for (int i = 0; i < RIG_SENSORS; i++) {
        r->temps[i].dc = dc;
    }
}

void rig_init(rig *r, const bq_pack_config *c)
{
    memset(r, 0, sizeof *r);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_init(&r->p, c));
    r->s.cells = r->cells;
    r->s.temps = r->temps;
    r->s.modules = r->modules;
    r->s.cell_capacity = r->s.cell_count = RIG_CELLS;
    r->s.temp_capacity = r->s.temp_count = RIG_SENSORS;
    r->s.module_capacity = r->s.module_count = RIG_MODULES;
    for (int i = 0; i < RIG_CELLS; i++) {
        r->cells[i].module = (uint8_t)(i / 6);
        r->cells[i].quality = BQ_Q_VALID;
    }
    for (int i = 0; i < RIG_SENSORS; i++) {
        r->temps[i].module = (uint8_t)(i / 2);
        r->temps[i].quality = BQ_Q_VALID;
    }
    for (int i = 0; i < RIG_MODULES; i++) {
        r->modules[i].quality = BQ_Q_VALID;
    }
    rig_all_cells(r, 3700);
    rig_all_temps(r, 250);
    r->s.current_age_ms = UINT32_MAX;
    r->in.sample_copied = true;
}

void rig_idle(rig *r, uint32_t ms)
{
    r->now_ms += ms;
    for (int i = 0; i < RIG_MODULES; i++) {
        r->modules[i].age_ms += ms;
    }
    bq_pack_step(&r->p, &r->s, &r->in, r->now_ms, &r->a);
}

void rig_scan(rig *r)
{
    r->now_ms += RIG_PERIOD;
    r->s.sequence++;
    for (int i = 0; i < RIG_MODULES; i++) {
        if ((r->modules[i].faults & BQ_F_COMM) != 0u) {
            r->modules[i].age_ms += RIG_PERIOD;
        } else {
            r->modules[i].age_ms = RIG_AGE;
        }
    }
    bq_pack_step(&r->p, &r->s, &r->in, r->now_ms, &r->a);
}

void rig_run(rig *r, uint32_t ms)
{
    for (uint32_t t = 0; t < ms; t += RIG_PERIOD) {
        rig_scan(r);
    }
}

void rig_standby(rig *r)
{
    r->in.monitor = BQ_MONITOR_UP;
    r->in.self_test = BQ_TEST_PASSED;
    rig_run(r, 3 * RIG_PERIOD);
    TEST_ASSERT_EQUAL(BQ_PACK_STANDBY, r->p.state);
}

void rig_on(rig *r)
{
    rig_standby(r);
    r->in.request = BQ_REQUEST_ON;
    rig_scan(r);
    TEST_ASSERT_EQUAL(BQ_PACK_ON, r->p.state);
    TEST_ASSERT_TRUE(r->a.charge_on);
    TEST_ASSERT_TRUE(r->a.discharge_on);
}

static void mark(rig *r, uint8_t module, uint8_t quality)
{
    for (int i = 0; i < RIG_CELLS; i++) {
        if (r->cells[i].module == module) {
            r->cells[i].quality = quality;
        }
    }
    for (int i = 0; i < RIG_SENSORS; i++) {
        if (r->temps[i].module == module) {
            r->temps[i].quality = quality;
        }
    }
}

void rig_lose(rig *r, uint8_t module)
{
    r->modules[module].faults |= BQ_F_COMM;
    mark(r, module, BQ_Q_COMM);
}

void rig_find(rig *r, uint8_t module)
{
    r->modules[module].faults &= (uint16_t)~BQ_F_COMM;
    mark(r, module, BQ_Q_VALID);
}

int rig_active(const rig *r, bq_pack_fault f)
{
    return ((r->p.faults >> f) & 1u) != 0u;
}

int rig_bleeding(const rig *r)
{
    int n = 0;

    for (uint16_t i = 1; i <= RIG_CELLS; i++) {
        n += bq_mask_get(r->a.balance, i) ? 1 : 0;
    }
    return n;
}
