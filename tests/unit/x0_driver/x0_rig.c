/* SPDX-License-Identifier: Apache-2.0 */
#include "x0_rig.h"
#include <string.h>

x0_rig rig;

static bq_status logged_start(void *ctx, uint8_t address7, const bq_i2c_segment *seg, size_t count)
{
    bq_i2c i2c = hal_sim_x0_i2c(&rig.hal);
    uint8_t *line = rig.log[rig.logged % 64u];
    memset(line, 0xee, 16);
    line[0] = (uint8_t)(address7 * 2u + (count > 1u));
    for (unsigned i = 0; i < seg[0].len && i < 15u; i++) {
        line[1u + i] = seg[0].data[i];
    }
    if (count > 1u) {
        line[2] = (uint8_t)seg[1].len;
    }
    rig.logged++;
    return i2c.ops->start(ctx, address7, seg, count);
}

static void shape(unsigned inputs, unsigned cells)
{
    uint16_t in_use = bq769x0_wiring((uint8_t)inputs, (uint8_t)cells);
    for (unsigned i = 0; i < inputs; i++) {
        TEST_ASSERT_EQUAL_INT(0,
                              sim_x0_set_cell(&rig.chip, (int)i + 1, (in_use >> i & 1u) != 0u ? 3.6 : 0.0));
    }
}

void rig_part(const char *name, unsigned cells)
{
    const sim_x0_part *part = sim_x0_find_part(name);
    TEST_ASSERT_NOT_NULL(part);
    memset(&rig, 0, sizeof rig);
    TEST_ASSERT_EQUAL_INT(0, sim_x0_init(&rig.chip, part, NULL));
    hal_sim_x0_init(&rig.hal, &rig.chip);
    shape(part->cells, cells);
    rig.config = (bq769x0_config){.inputs = part->cells,
                                  .cells = (uint8_t)cells,
                                  .sensors = (uint8_t)(part->cells / 5u),
                                  .sensor = bq769x0_sensor_codes,
                                  .sensor_ctx = &bq769x0_codes_103at,
                                  .shunt_uohm = 5000,
                                  .ov_mv = 4250,
                                  .uv_mv = 2800,
                                  .ov_recover_mv = 4150,
                                  .uv_recover_mv = 3000,
                                  .ov_delay_s = 2,
                                  .uv_delay_s = 4,
                                  .ocd_ma = 15000,
                                  .scd_ma = 25000,
                                  .ocd_delay_ms = 320,
                                  .scd_delay_us = 100};
    rig.sample = (bq_sample){.cells = rig.cells,
                             .temps = rig.temps,
                             .modules = rig.modules,
                             .cell_capacity = 15,
                             .temp_capacity = 3,
                             .module_capacity = 1};
}

bq_status rig_init(void)
{
    bq_i2c i2c = hal_sim_x0_i2c(&rig.hal);
    bq_gpio gpio = hal_sim_x0_gpio(&rig.hal);
    bq_clock clock = hal_sim_x0_clock(&rig.hal);
    rig.ops = *i2c.ops;
    rig.ops.start = logged_start;
    i2c.ops = &rig.ops;
    return bq769x0_init(&rig.d, &rig.config, &i2c, &gpio, &clock);
}

bq_status rig_run(bq_status begun)
{
    if (begun != BQ_OK) {
        return begun;
    }
    for (unsigned n = 0; n < 100000u; n++) {
        uint32_t wait_us = 0;
        bq_status st = bq769x0_poll(&rig.d, &wait_us);
        if (st != BQ_PENDING) {
            return st;
        }
        hal_sim_x0_advance(&rig.hal, wait_us != 0u ? (uint64_t)wait_us * 1000u : 1000u);
    }
    TEST_FAIL_MESSAGE("a job never ended");
    return BQ_E_TIMEOUT;
}

bq_status rig_start(void)
{
    return rig_run(bq769x0_begin_start(&rig.d));
}

bq_status rig_scan(void)
{
    return rig_run(bq769x0_begin_scan(&rig.d));
}

void rig_wait_ms(unsigned ms)
{
    hal_sim_x0_advance(&rig.hal, (uint64_t)ms * 1000000u);
}

void rig_pass(unsigned ms)
{
    for (unsigned t = 0; t < ms; t += 250u) {
        uint64_t next = rig.chip.now + 250000000u;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
        if (rig.chip.now < next) {
            hal_sim_x0_advance(&rig.hal, next - rig.chip.now);
        }
    }
}

bq_status rig_apply(bool charge, bool discharge, uint32_t balance)
{
    bq_action action = {.charge_on = charge, .discharge_on = discharge};
    action.balance[0] = balance;
    return rig_run(bq769x0_begin_apply(&rig.d, &action));
}

bq_status rig_sample(void)
{
    return bq769x0_sample(&rig.d, &rig.sample);
}

uint16_t rig_faults(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    return rig.modules[0].faults;
}

uint8_t rig_reg(uint8_t reg)
{
    return sim_x0_peek(&rig.chip, reg);
}

unsigned rig_input(unsigned cell)
{
    uint16_t in_use = bq769x0_wiring(rig.config.inputs, rig.config.cells);
    for (unsigned i = 0; i < 15u; i++) {
        if ((in_use >> i & 1u) != 0u && --cell == 0u) {
            return i + 1u;
        }
    }
    return 0;
}

void rig_cells(double volts)
{
    for (unsigned c = 1; c <= rig.config.cells; c++) {
        (void)sim_x0_set_cell(&rig.chip, (int)rig_input(c), volts);
    }
}

void rig_clean(void)
{
    const sim_misuse *m = sim_x0_misuse(&rig.chip);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, m->count, m->count != 0u ? m->entry[0].text : "");
    TEST_ASSERT_EQUAL_UINT(0, rig.hal.overlaps);
    /* frames are not wiped when a job ends: the last one was never needed */
    TEST_ASSERT_NULL((const void *)(uintptr_t)rig.d.frames[BQ769X0_FRAMES].job);
}

void rig_up(const char *name, unsigned cells)
{
    rig_part(name, cells);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
}
