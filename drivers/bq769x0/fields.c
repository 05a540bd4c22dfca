/* SPDX-License-Identifier: Apache-2.0 */
/* The fields of the configuration, in the order of a record of the settings. */
#include "bqhost/bq769x0.h"

#define U(member) BQ_FIELD(bq769x0_config, member, BQ_FIELD_UNSIGNED)
#define S(member) BQ_FIELD(bq769x0_config, member, BQ_FIELD_SIGNED)
#define B(member) BQ_FIELD(bq769x0_config, member, BQ_FIELD_BOOL)

static const bq_field fields[] = {
    U(inputs),
    U(cells),
    U(wiring),
    U(address7),
    U(crc),
    U(sensors),
    U(shunt_uohm),
    B(invert_current),
    U(ov_mv),
    U(uv_mv),
    U(ov_recover_mv),
    U(uv_recover_mv),
    U(ov_delay_s),
    U(uv_delay_s),
    U(ocd_ma),
    U(scd_ma),
    U(ocd_delay_ms),
    U(scd_delay_us),
    U(load_settle_ms),
    U(frozen_scans),
    U(balance_timer_s),
    U(balance_max),
    B(counter_off),
    B(balance_across_groups),
    B(balance_external),
    B(keep_fets),
    S(die_limit_dc),
    S(die_fault_dc),
    U(die_check_s),
    U(die_v25_uv),
};

const bq_field_table bq769x0_config_fields = {fields, (uint16_t)(sizeof fields / sizeof fields[0]), 0x7690,
                                              (uint16_t)sizeof(bq769x0_config)};
