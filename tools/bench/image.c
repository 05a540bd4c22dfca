/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The smallest firmware there is, to see what a linker keeps: the board is one register that answers
 * everything. Without WHOLE the driver alone is brought up and scans; with WHOLE the super-loop with pack
 * controller runs on it. Only linked, never run.
 */
#include "bqhost/app.h"
#include "bqhost/bq76pl536.h"

#define DEVICES 32u

int main(void);

static volatile uint32_t *const board = (volatile uint32_t *)0x40000000u;

static bq_status spi_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    (void)ctx;
    for (size_t i = 0; i < len; i++) {
        *board = tx[i];
        rx[i] = (uint8_t)*board;
    }
    return BQ_OK;
}

static bq_status spi_poll(void *ctx)
{
    (void)ctx;
    return BQ_OK;
}

static bq_status line_read(void *ctx, bq_line line, bool *level)
{
    (void)ctx;
    *level = (*board >> line & 1u) != 0u;
    return BQ_OK;
}

static bq_status line_write(void *ctx, bq_line line, bool level)
{
    (void)ctx;
    *board = (uint32_t)level << line;
    return BQ_OK;
}

static uint32_t now_us(void *ctx)
{
    (void)ctx;
    return *board;
}

static const bq_spi_ops spi_ops = {spi_start, spi_poll, NULL};
static const bq_gpio_ops gpio_ops = {line_read, line_write};
static const bq_spi spi = {&spi_ops, NULL};
static const bq_gpio gpio = {&gpio_ops, NULL};
static const bq_clock tick = {now_us, NULL};

static bq76pl536 driver;
static bq76pl536_device devices[DEVICES];
static bq_cell_reading cells[6u * DEVICES];
static bq_temp_reading temps[2u * DEVICES];
static bq_module_reading modules[DEVICES];

static const bq76pl536_config config = {
    .devices = DEVICES, .cells_per_device = 6, .sensors = 2, .thermistor = &bq_thermistor_103at};

#ifdef WHOLE
static bq_app app;
static bq_app_config settings;

int main(void)
{
    bq_status status = bq76pl536_init(&driver, &config, &spi, &gpio, &tick, devices, DEVICES);
    bq_afe afe = bq76pl536_afe(&driver);
    settings.period_ms = *board;
    if (status != BQ_OK || bq_app_init(&app, &settings, &afe, &gpio, &tick, NULL, cells, 6u * DEVICES, temps,
                                       2u * DEVICES, modules, DEVICES) != BQ_OK) {
        return 1;
    }
    for (;;) {
        *board = bq_app_step(&app);
    }
}
#else
static bq_sample sample = {cells, temps, modules, 6u * DEVICES, 2u * DEVICES, DEVICES, 0, 0, 0, 0,
                           0,     0,     0,       false};

int main(void)
{
    if (bq76pl536_init(&driver, &config, &spi, &gpio, &tick, devices, DEVICES) != BQ_OK ||
        bq76pl536_start(&driver) != BQ_OK || bq76pl536_wait(&driver, 1000000) != BQ_OK) {
        return 1;
    }
    while (bq76pl536_scan(&driver) == BQ_OK && bq76pl536_wait(&driver, 1000000) == BQ_OK &&
           bq76pl536_sample(&driver, &sample) == BQ_OK) {
        *board = sample.cells[0].mv;
    }
    return 1;
}
#endif
