/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The smallest firmware around a bq769x0, to see what a linker keeps: the board is one register that answers
 * everything. Without WHOLE the base set: a part that is known is configured with read-back, its limits in
 * codes; then it is measured, its cells bled, its FETs switched, its faults reported and cleared on request.
 * With WHOLE everything the driver can do. Only linked, never run.
 */
#include "bqhost/bq769x0.h"

int main(void);

static volatile uint32_t *const board = (volatile uint32_t *)0x40000000u;

static bq_status i2c_start(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    (void)ctx;
    *board = address7;
    *board = segments[count - 1u].len;
    return BQ_OK;
}

static bq_status i2c_poll(void *ctx)
{
    (void)ctx;
    return *board != 0u ? BQ_OK : BQ_PENDING;
}

static uint32_t now_us(void *ctx)
{
    (void)ctx;
    return *board;
}

static const bq_i2c_ops i2c_ops = {i2c_start, i2c_poll, NULL};
static const bq_i2c i2c = {&i2c_ops, NULL};
static const bq_clock tick = {now_us, NULL};

/* The sensor of this board, 0.7 degrees exact from -20 to 80: data of the user, not of the library. */
#define CODE(ohms) BQ769X0_TS_CODE(ohms)
static const uint16_t codes[] = {CODE(67889), CODE(41978), CODE(26870), CODE(17753), CODE(12074), CODE(8434),
                                 CODE(6034),  CODE(4408),  CODE(3283),  CODE(2487),  CODE(1915)};
static const bq769x0_code_table table = {codes, 11, -200, 100};

static bq769x0 driver;

#ifdef WHOLE
static bq_cell_reading cells[15];
static bq_temp_reading temps[3];
static bq_module_reading modules[1];
static bq_action action;
static bq_sample sample = {cells, temps, modules, 15, 3, 1, 0, 0, 0, 0, 0, 0, 0, false};

static const bq769x0_config config = {.inputs = 15,
                                      .cells = 15,
                                      .wiring = 0x7fff,
                                      .address7 = 0x08,
                                      .crc = BQ769X0_CRC_ON,
                                      .sensors = 3,
                                      .sensor = bq769x0_sensor_codes,
                                      .sensor_ctx = &table,
                                      .shunt_uohm = 1000,
                                      .ov_mv = 4250,
                                      .uv_mv = 2800,
                                      .ov_recover_mv = 4150,
                                      .uv_recover_mv = 3000,
                                      .ov_delay_s = 2,
                                      .uv_delay_s = 4,
                                      .ocd_ma = 50000,
                                      .scd_ma = 100000,
                                      .ocd_delay_ms = 320,
                                      .scd_delay_us = 100};
#else
static const bq769x0_known known = {BQ769X0_PART(15, 0x7fffu),
                                    .address7 = 0x08,
                                    .crc = true,
                                    .registers =
                                        BQ769X0_REGISTERS(BQ769X0_THERMISTORS, BQ769X0_SHUNT_MV(50000, 1000),
                                                          320, BQ769X0_SHUNT_MV(100000, 1000), 100, 2, 4),
                                    .counter = BQ769X0_CTRL2_CC_EN,
                                    .ov_mv = 4250,
                                    .uv_mv = 2800,
                                    .shunt_uohm = 1000,
                                    .sensor = bq769x0_sensor_codes,
                                    .sensor_ctx = &table};
#endif

static bool done(bq_status begun)
{
    while (begun == BQ_OK && (begun = bq769x0_poll(&driver, NULL)) == BQ_PENDING) {
        begun = BQ_OK;
    }
    return begun == BQ_OK;
}

#ifdef WHOLE
static bool started(void)
{
    return bq769x0_init(&driver, &config, &i2c, NULL, &tick) == BQ_OK && done(bq769x0_begin_start(&driver));
}

/* Whatever the loop, the console and the user may ask for. */
static bool updated(void)
{
    bq_afe afe = bq769x0_afe(&driver);
    bq769x0_unlock(&driver);
    *board = (uint32_t)bq769x0_get_charge(&driver)->uas + bq769x0_get_achieved(&driver)->ov_trip;
    bq769x0_charge_reset(&driver);
    return afe.ops->scan(afe.ctx) == BQ_OK && done(BQ_OK) && done(bq769x0_begin_oneshot(&driver)) &&
           bq769x0_calibration_due(&driver) && bq769x0_calibrate(&driver, *board) == BQ_OK &&
           bq769x0_alert_pending(&driver);
}
static bool used(void)
{
    if (bq769x0_sample(&driver, &sample) != BQ_OK) {
        return false;
    }
    *board =
        sample.cells[0].mv + (uint32_t)sample.current_ma + (uint32_t)sample.temps[0].dc + modules[0].faults;
    action.charge_on = action.discharge_on = *board != 0u;
    action.balance[0] = *board;
    return done(bq769x0_begin_apply(&driver, &action));
}
#else
static bool started(void)
{
    bq769x0_init_known(&driver, &known, &i2c, &tick);
    return done(bq769x0_begin_configure(&driver));
}

static bool updated(void)
{
    return done(bq769x0_begin_measure(&driver));
}

static bool used(void)
{
    bq_cell_reading cell;
    bq_temp_reading temp;
    bq769x0_reading r;
    bq769x0_read(&driver, &r);
    bq769x0_read_cell(&driver, 0, &cell);
    bq769x0_read_temp(&driver, 0, &temp);
    *board = cell.mv + cell.quality + (uint32_t)r.current_ma + (uint32_t)temp.dc;
    return done(bq769x0_begin_outputs(&driver, *board, *board)) &&
           (r.events == 0u || done(bq769x0_begin_clear(&driver)));
}
#endif

int main(void)
{
    if (!started()) {
        return 1;
    }
    while (updated() && used()) {
    }
    return 1;
}
