/* SPDX-License-Identifier: Apache-2.0 */
/* The fields of the super-loop's own structures, in the order of the record. */
#include "bqhost/app.h"
#include "bqhost/settings.h"

#define U(member) BQ_FIELD(bq_app_config, member, BQ_FIELD_UNSIGNED)
#define S(member) BQ_FIELD(bq_app_config, member, BQ_FIELD_SIGNED)

static const bq_field app_fields[] = {
    U(period_ms),
    U(retry_ms),
    U(balance_timer_s),
    U(precharge_ms),
    U(precharge_end_ma),
    U(pack.cells),
    U(pack.sensors),
    U(pack.modules),
    U(pack.cell_ov_mv),
    U(pack.cell_ov_clear_mv),
    U(pack.cell_uv_mv),
    U(pack.cell_uv_clear_mv),
    S(pack.overtemp_dc),
    S(pack.overtemp_clear_dc),
    S(pack.undertemp_dc),
    S(pack.undertemp_clear_dc),
    U(pack.imbalance_mv),
    U(pack.imbalance_clear_mv),
    S(pack.charge_max_ma),
    S(pack.discharge_max_ma),
    U(pack.debounce_ms),
    U(pack.recover_ms),
    U(pack.comm_timeout_ms),
    U(pack.balance_start_mv),
    U(pack.balance_stop_mv),
    U(pack.balance_min_cell_mv),
    S(pack.balance_max_temp_dc),
    S(pack.balance_rest_ma),
    U(pack.balance_rest_ms),
    U(pack.balance_duty_percent),
    U(pack.balance_max_per_module),
    BQ_FIELD(bq_app_config, pack.separate_paths, BQ_FIELD_BOOL),
    BQ_FIELD(bq_app_config, pack.soc.points, BQ_FIELD_POINTS),
    U(pack.soc.capacity_mah),
    S(pack.soc.rest_ma),
    U(pack.soc.rest_ms),
    U(pack.soc.gap_ms),
};

static const bq_field point_fields[] = {
    BQ_FIELD(bq_ocv_point, permille, BQ_FIELD_UNSIGNED),
    BQ_FIELD(bq_ocv_point, mv, BQ_FIELD_UNSIGNED),
};

static const bq_field byte_fields[] = {BQ_FIELD_AT(0, 1, BQ_FIELD_UNSIGNED)};

#define COUNT(array) ((uint16_t)(sizeof(array) / sizeof((array)[0])))

const bq_field_table bq_app_config_fields = {app_fields, COUNT(app_fields), 1,
                                             (uint16_t)sizeof(bq_app_config)};
const bq_field_table bq_ocv_point_fields = {point_fields, COUNT(point_fields), 2,
                                            (uint16_t)sizeof(bq_ocv_point)};
const bq_field_table bq_byte_fields = {byte_fields, COUNT(byte_fields), 3, 1};
