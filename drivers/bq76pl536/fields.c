/* SPDX-License-Identifier: Apache-2.0 */
/* The fields of the configuration, in the order of a record of the settings. */
#include "bqhost/bq76pl536.h"

#define U(member) BQ_FIELD(bq76pl536_config, member, BQ_FIELD_UNSIGNED)
#define B(member) BQ_FIELD(bq76pl536_config, member, BQ_FIELD_BOOL)

static const bq_field fields[] = {
    U(devices),         U(cells_per_device), B(variant_a),        B(crc_off),         B(use_conv_pin),
    B(allow_unlatched), U(sensors),          U(sensor_settle_ms), U(cov_mv),          U(cuv_mv),
    U(normal_max_mv),   U(normal_min_mv),    U(cov_delay_us),     U(cuv_delay_us),    U(ot_c[0]),
    U(ot_c[1]),         U(ot_delay_ms),      U(spi_hz),           U(balance_timer_s), U(balance_settle_ms),
    U(scrub_period_ms), U(wire_limit_mv),    U(user[0]),          U(user[1]),         U(user[2]),
    U(user[3]),         B(allow_partial),    B(gpai_pins),        U(frozen_scans),    B(warm_start),
};

const bq_field_table bq76pl536_config_fields = {fields, (uint16_t)(sizeof fields / sizeof fields[0]), 0x7653,
                                                (uint16_t)sizeof(bq76pl536_config)};
