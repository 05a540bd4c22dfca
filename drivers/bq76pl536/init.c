/* SPDX-License-Identifier: Apache-2.0 */
/* Validation of the whole configuration before anything else happens (PL-SEQ-03-01), and the set-up of the
 * instance. */
#include "bqhost/bq76pl536_convert.h"
#include "pl536_internal.h"
#include <string.h>

#define COV_HYSTERESIS_MV 50u  /* PL-ELEC-05 */
#define CUV_HYSTERESIS_MV 100u /* PL-ELEC-05 */

static bq_status check_stack(const bq76pl536_config *c)
{
    if (c->devices < 1u || c->devices > BQ76PL536_MAX_DEVICES) {
        return BQ_E_DEVICES;
    }
    for (unsigned n = 0; n < c->devices; n++) {
        unsigned cells = c->cells != NULL ? c->cells[n] : c->cells_per_device;
        if (cells < 3u || cells > BQ76PL536_MAX_CELLS) {
            return BQ_E_CELLS;
        }
    }
    return BQ_OK;
}

static bq_status check_delay(const bq76pl536_config *c, uint16_t threshold_mv, uint32_t delay_us)
{
    uint8_t code;
    if (threshold_mv == 0u) {
        return BQ_OK;
    }
    if (delay_us == 0u) {
        return c->allow_unlatched ? BQ_OK : BQ_E_UNLATCHED;
    }
    return bq76pl536_delay_code(delay_us, &code);
}

static bq_status check_thresholds(const bq76pl536_config *c)
{
    uint8_t code;
    bq_status st;
    if (c->cov_mv != 0u) {
        st = bq76pl536_cov_code(c->cov_mv, &code);
        if (st != BQ_OK) {
            return st;
        }
    }
    if (c->cuv_mv != 0u) {
        st = bq76pl536_cuv_code(c->cuv_mv, &code);
        if (st != BQ_OK) {
            return st;
        }
    }
    if (c->cov_mv != 0u && c->cuv_mv != 0u && !bq76pl536_cov_cuv_legal(c->cov_mv, c->cuv_mv)) {
        return BQ_E_COV_CUV;
    }
    st = check_delay(c, c->cov_mv, c->cov_delay_us);
    return st != BQ_OK ? st : check_delay(c, c->cuv_mv, c->cuv_delay_us);
}

/* Normal operation must release the comparators and keep the smallest device supplied (PL-ELEC-05,
 * PL-ELEC-03). */
static bq_status check_normal_range(const bq76pl536_config *c)
{
    unsigned fewest = BQ76PL536_MAX_CELLS;
    for (unsigned n = 0; n < c->devices; n++) {
        unsigned cells = c->cells != NULL ? c->cells[n] : c->cells_per_device;
        fewest = cells < fewest ? cells : fewest;
    }
    if (c->normal_max_mv != 0u) {
        if (c->normal_max_mv < c->normal_min_mv) {
            return BQ_E_RANGE;
        }
        if (c->cov_mv != 0u && c->normal_max_mv >= c->cov_mv - COV_HYSTERESIS_MV) {
            return BQ_E_CONFIG;
        }
    }
    if (c->normal_min_mv != 0u) {
        if (fewest * c->normal_min_mv < PL_SUPPLY_MIN_MV) {
            return BQ_E_CONFIG;
        }
        if (c->cuv_mv != 0u && c->normal_min_mv <= c->cuv_mv + CUV_HYSTERESIS_MV) {
            return BQ_E_CONFIG;
        }
    }
    return BQ_OK;
}

static bq_status check_overtemperature(const bq76pl536_config *c)
{
    uint8_t code;
    bool any = false;
    for (unsigned i = 0; i < 2u; i++) {
        if (c->ot_c[i] == 0u) {
            continue;
        }
        bq_status st = bq76pl536_ot_code(c->ot_c[i], &code);
        if (st != BQ_OK) {
            return st;
        }
        if (i >= c->sensors) {
            return BQ_E_CONFIG;
        }
        any = true;
    }
    if (!any) {
        return BQ_OK;
    }
    if (c->ot_delay_ms == 0u) {
        return c->allow_unlatched ? BQ_OK : BQ_E_UNLATCHED;
    }
    if (c->ot_delay_ms <= (c->sensor_settle_ms != 0u ? c->sensor_settle_ms : 10u)) {
        return BQ_E_CONFIG; /* PL-OT-08: switching the sensors on would raise a false alert */
    }
    return bq76pl536_ott_code(c->ot_delay_ms, &code);
}

static bq_status check_sensors(const bq76pl536_config *c)
{
    const bq_thermistor *t = c->thermistor;
    if (c->sensors > 2u) {
        return BQ_E_RANGE;
    }
    if (c->sensors != 0u && (t == NULL || t->ohms == NULL || t->count < 2u || t->step_dc <= 0)) {
        return BQ_E_CONFIG;
    }
    return BQ_OK;
}

static bq_status check_clock(const bq76pl536_config *c)
{
    uint32_t limit;
    if (c->spi_hz == 0u) {
        return BQ_OK;
    }
    bq_status st = bq76pl536_spi_max_hz(c->devices, &limit);
    if (st != BQ_OK) {
        return st;
    }
    return c->spi_hz >= BQ76PL536_SPI_MIN_HZ && c->spi_hz <= limit ? BQ_OK : BQ_E_CLOCK;
}

static bq_status check_operation(const bq76pl536_config *c)
{
    if (c->balance_timer_s > BQ76PL536_CB_DURATION) {
        return BQ_E_RANGE;
    }
    if (c->wire_limit_mv != 0u && c->wire_limit_mv < 110u) {
        return BQ_E_RANGE; /* PL-VBAT-07: a healthy brick channel may differ that much */
    }
    return BQ_OK;
}

static bq_status check_config(const bq76pl536_config *c)
{
    bq_status st = check_stack(c);
    st = st != BQ_OK ? st : check_sensors(c);
    st = st != BQ_OK ? st : check_thresholds(c);
    st = st != BQ_OK ? st : check_normal_range(c);
    st = st != BQ_OK ? st : check_overtemperature(c);
    st = st != BQ_OK ? st : check_clock(c);
    return st != BQ_OK ? st : check_operation(c);
}

static void fill_defaults(bq76pl536_config *c)
{
    if (c->spi_hz == 0u) {
        (void)bq76pl536_spi_default_hz(c->devices, &c->spi_hz);
    }
    c->balance_timer_s = c->balance_timer_s != 0u ? c->balance_timer_s : 4u;
    c->balance_settle_ms = c->balance_settle_ms != 0u ? c->balance_settle_ms : 10u;
    c->scrub_period_ms = c->scrub_period_ms != 0u ? c->scrub_period_ms : 1000u;
    c->wire_limit_mv = c->wire_limit_mv != 0u ? c->wire_limit_mv : 200u;
}

bq_status bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi, const bq_gpio *gpio,
                         const bq_clock *clock, bq76pl536_device *devices, uint8_t device_capacity)
{
    if (d == NULL || config == NULL || spi == NULL || clock == NULL || devices == NULL) {
        return BQ_E_ARG;
    }
    if (spi->ops == NULL || spi->ops->start == NULL || spi->ops->poll == NULL || clock->now_us == NULL) {
        return BQ_E_ARG;
    }
    if (gpio != NULL && (gpio->ops == NULL || gpio->ops->read == NULL || gpio->ops->write == NULL)) {
        return BQ_E_ARG;
    }
    bq_status st = check_config(config);
    if (st != BQ_OK) {
        return st;
    }
    if (device_capacity < config->devices) {
        return BQ_E_ARG;
    }
    memset(d, 0, sizeof *d);
    memset(devices, 0, config->devices * sizeof devices[0]);
    d->config = *config;
    fill_defaults(&d->config);
    d->spi = *spi;
    d->clock = *clock;
    if (gpio != NULL) {
        d->gpio = *gpio;
    }
    d->devices = devices;
    d->crc = true;
    d->gpai_pins = config->gpai_pins;
    d->spi_hz = d->config.spi_hz;
    d->diagnosis.spi_hz = d->spi_hz;
    d->now_us = clock->now_us(clock->ctx);
    pl_invalidate_from(d, 1u, 0, 0);
    return BQ_OK;
}
