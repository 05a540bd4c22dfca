/* SPDX-License-Identifier: Apache-2.0 */
/* What the configuration means in registers. Nothing is stored: init has proved that every value has a code.
 */
#include "bqhost/bq76pl536_convert.h"
#include "pl536_internal.h"

uint8_t pl_cells(const bq76pl536 *d, unsigned n)
{
    return d->config.cells != NULL ? d->config.cells[n - 1u] : d->config.cells_per_device;
}

bool pl_uniform(const bq76pl536 *d)
{
    for (unsigned n = 2u; n <= d->config.devices; n++) {
        if (pl_cells(d, n) != pl_cells(d, 1u)) {
            return false;
        }
    }
    return true;
}

static uint8_t function_config(const bq76pl536 *d, unsigned n)
{
    bq76pl536_adct adct =
        d->config.variant_a ? BQ76PL536_ADCT_3US : BQ76PL536_ADCT_6US; /* code 0: reserved bits */
    uint8_t value = 0;
    (void)bq76pl536_function_config(adct, pl_cells(d, n), !d->gpai_pins, false, &value);
    return value;
}

static uint8_t delay(uint16_t threshold_mv, uint32_t delay_us)
{
    uint8_t code = 0;
    if (threshold_mv != 0u) {
        (void)bq76pl536_delay_code(delay_us, &code);
    }
    return code;
}

/* A comparator that is off still gets a code that keeps COV and CUV apart (PL-COV-12). */
static uint8_t cov(const bq76pl536 *d)
{
    uint8_t code = BQ76PL536_COV_DISABLE | BQ76PL536_COV_CODE_MAX;
    (void)bq76pl536_cov_code(d->config.cov_mv, &code);
    return code;
}

static uint8_t cuv(const bq76pl536 *d)
{
    uint8_t code = BQ76PL536_CUV_DISABLE;
    (void)bq76pl536_cuv_code(d->config.cuv_mv, &code);
    return code;
}

static uint8_t overtemperature(const bq76pl536 *d)
{
    uint8_t code[2] = {0, 0};
    (void)bq76pl536_ot_code(d->config.ot_c[0], &code[0]);
    (void)bq76pl536_ot_code(d->config.ot_c[1], &code[1]);
    return (uint8_t)(code[0] | code[1] << 4);
}

static uint8_t overtemperature_delay(const bq76pl536 *d)
{
    uint8_t code = 0;
    if (overtemperature(d) != 0u) {
        (void)bq76pl536_ott_code(d->config.ot_delay_ms, &code);
    }
    return code;
}

uint8_t pl_image(const bq76pl536 *d, unsigned n, unsigned reg)
{
    switch (reg) {
    case BQ76PL536_FUNCTION_CONFIG:
        return function_config(d, n);
    case BQ76PL536_IO_CONFIG:
        return d->config.crc_off ? BQ76PL536_IOC_CRC_DIS : 0u;
    case BQ76PL536_CONFIG_COV:
        return cov(d);
    case BQ76PL536_CONFIG_COVT:
        return delay(d->config.cov_mv, d->config.cov_delay_us);
    case BQ76PL536_CONFIG_CUV:
        return cuv(d);
    case BQ76PL536_CONFIG_CUVT:
        return delay(d->config.cuv_mv, d->config.cuv_delay_us);
    case BQ76PL536_CONFIG_OT:
        return overtemperature(d);
    case BQ76PL536_CONFIG_OTT:
        return overtemperature_delay(d);
    default:
        return d->config.user[(reg - BQ76PL536_USER1) & 3u];
    }
}

uint8_t pl_adc_control(const bq76pl536 *d, unsigned n)
{
    uint8_t value = 0;
    uint8_t sensors = (uint8_t)((1u << d->config.sensors) - 1u);
    (void)bq76pl536_adc_control(pl_cells(d, n), sensors, true, true, &value);
    return value;
}

uint8_t pl_io_control(const bq76pl536 *d)
{
    return (uint8_t)((1u << d->config.sensors) - 1u); /* TS1 is bit 0, TS2 bit 1 */
}

uint32_t pl_conversion_us(const bq76pl536 *d)
{
    uint16_t worst = 0;
    uint8_t channels = 0;
    for (unsigned n = 1u; n <= d->config.devices; n++) {
        uint8_t here = bq76pl536_channels(pl_adc_control(d, n));
        channels = here > channels ? here : channels;
        if (d->config.cells == NULL) {
            break;
        }
    }
    (void)bq76pl536_conversion_us(channels, BQ76PL536_ADCT_6US, true, NULL, &worst);
    return worst;
}

uint32_t pl_longest_delay_us(const bq76pl536 *d)
{
    uint32_t longest = 0;
    if (d->config.cov_mv != 0u && d->config.cov_delay_us > longest) {
        longest = d->config.cov_delay_us;
    }
    if (d->config.cuv_mv != 0u && d->config.cuv_delay_us > longest) {
        longest = d->config.cuv_delay_us;
    }
    if (overtemperature(d) != 0u && d->config.ot_delay_ms * 1000ul > longest) {
        longest = d->config.ot_delay_ms * 1000ul;
    }
    return longest + longest / 10u + 200u; /* tolerance, comparator and deglitch (PL-TIM-22) */
}

uint32_t pl_settle_us(const bq76pl536 *d)
{
    if (d->config.sensors == 0u) {
        return 0;
    }
    return (d->config.sensor_settle_ms != 0u ? d->config.sensor_settle_ms : 10u) * 1000ul;
}
