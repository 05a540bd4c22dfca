/* SPDX-License-Identifier: Apache-2.0 */
/* Limits of the pack controller: defaults, and one table from which checking and access by name follow. */
#include "bqhost/field.h"
#include "bqhost/pack.h"
#include "bqhost/text.h"
#include <stddef.h>
#include <string.h>

/* Name, kind, lowest and highest value; those of four bytes are currents, their limits in A. */
#define FIELDS(F)                                                                                            \
    F(cells, BQ_FIELD_UNSIGNED, 1, BQ_PACK_MAX_CELLS)                                                        \
    F(sensors, BQ_FIELD_UNSIGNED, 0, BQ_PACK_MAX_SENSORS)                                                    \
    F(modules, BQ_FIELD_UNSIGNED, 1, BQ_PACK_MAX_MODULES)                                                    \
    F(cell_ov_mv, BQ_FIELD_UNSIGNED, 1000, 4500)                                                             \
    F(cell_ov_clear_mv, BQ_FIELD_UNSIGNED, 1000, 4500)                                                       \
    F(cell_uv_mv, BQ_FIELD_UNSIGNED, 1000, 4500)                                                             \
    F(cell_uv_clear_mv, BQ_FIELD_UNSIGNED, 1000, 4500)                                                       \
    F(overtemp_dc, BQ_FIELD_SIGNED, -400, 1250)                                                              \
    F(overtemp_clear_dc, BQ_FIELD_SIGNED, -400, 1250)                                                        \
    F(undertemp_dc, BQ_FIELD_SIGNED, -400, 1250)                                                             \
    F(undertemp_clear_dc, BQ_FIELD_SIGNED, -400, 1250)                                                       \
    F(imbalance_mv, BQ_FIELD_UNSIGNED, 0, 4500)                                                              \
    F(imbalance_clear_mv, BQ_FIELD_UNSIGNED, 0, 4500)                                                        \
    F(charge_max_ma, BQ_FIELD_SIGNED, 0, 1000)                                                               \
    F(discharge_max_ma, BQ_FIELD_SIGNED, 0, 1000)                                                            \
    F(debounce_ms, BQ_FIELD_UNSIGNED, 0, 10000)                                                              \
    F(recover_ms, BQ_FIELD_UNSIGNED, 100, 65535)                                                             \
    F(comm_timeout_ms, BQ_FIELD_UNSIGNED, 20, 30000)                                                         \
    F(balance_start_mv, BQ_FIELD_UNSIGNED, 0, 1000)                                                          \
    F(balance_stop_mv, BQ_FIELD_UNSIGNED, 1, 1000)                                                           \
    F(balance_min_cell_mv, BQ_FIELD_UNSIGNED, 1000, 4500)                                                    \
    F(balance_max_temp_dc, BQ_FIELD_SIGNED, -400, 1250)                                                      \
    F(balance_rest_ma, BQ_FIELD_SIGNED, 0, 1000)                                                             \
    F(balance_rest_ms, BQ_FIELD_UNSIGNED, 0, 65535)                                                          \
    F(balance_duty_percent, BQ_FIELD_UNSIGNED, 1, 100)                                                       \
    F(balance_max_per_module, BQ_FIELD_UNSIGNED, 0, 255)

typedef struct field {
    bq_field f;
    int16_t min;
    uint16_t max;
} field;

#define NUMBER(name, kind, min, max) N_##name,
#define NAME(name, kind, min, max) #name "\0"
#define ROW(name, kind, min, max) {BQ_FIELD(bq_pack_config, name, kind), (min), (max)},

enum { FIELDS(NUMBER) FIELD_COUNT, N_soc = FIELD_COUNT, NONE };
static const char names[] = FIELDS(NAME) "soc";
static const field fields[] = {FIELDS(ROW)};

/* Fields that must be below another one; `wrong` is the one that is named. */
static const struct order {
    uint8_t below, above, wrong;
} orders[] = {
    {N_cell_ov_clear_mv, N_cell_ov_mv, N_cell_ov_clear_mv},
    {N_cell_uv_mv, N_cell_uv_clear_mv, N_cell_uv_clear_mv},
    {N_cell_uv_clear_mv, N_cell_ov_clear_mv, N_cell_uv_clear_mv},
    {N_overtemp_clear_dc, N_overtemp_dc, N_overtemp_clear_dc},
    {N_undertemp_dc, N_undertemp_clear_dc, N_undertemp_clear_dc},
    {N_undertemp_clear_dc, N_overtemp_clear_dc, N_undertemp_clear_dc},
};

static int32_t load(const bq_pack_config *c, unsigned n)
{
    return (int32_t)bq_field_load(fields[n].f, c);
}

static bool in_range(unsigned n, int32_t value)
{
    const int32_t unit = bq_field_size(fields[n].f) == 4u ? 1000 : 1;

    return value >= fields[n].min * unit && value <= fields[n].max * unit;
}

static unsigned find(const char *name)
{
    unsigned n = 0;

    while (n < FIELD_COUNT && strcmp(bq_word(names, n), name) != 0) {
        n++;
    }
    return n;
}

const char *bq_pack_config_field(uint16_t n)
{
    return n < FIELD_COUNT ? bq_word(names, n) : NULL;
}

bq_status bq_pack_config_set(bq_pack_config *config, const char *name, int32_t value)
{
    const unsigned n = config != NULL && name != NULL ? find(name) : FIELD_COUNT;

    if (n == FIELD_COUNT) {
        return BQ_E_ARG;
    }
    if (!in_range(n, value)) {
        return BQ_E_RANGE;
    }
    bq_field_store(fields[n].f, config, (uint32_t)value);
    return BQ_OK;
}

bq_status bq_pack_config_get(const bq_pack_config *config, const char *name, int32_t *value)
{
    const unsigned n = config != NULL && name != NULL && value != NULL ? find(name) : FIELD_COUNT;

    if (n == FIELD_COUNT) {
        return BQ_E_ARG;
    }
    *value = load(config, n);
    return BQ_OK;
}

static unsigned out_of_range(const bq_pack_config *c)
{
    for (unsigned n = 0; n < FIELD_COUNT; n++) {
        if (!in_range(n, load(c, n))) {
            return n;
        }
    }
    return NONE;
}

static unsigned contradiction(const bq_pack_config *c)
{
    if (c->modules > c->cells) {
        return N_modules;
    }
    for (unsigned i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        if (load(c, orders[i].below) >= load(c, orders[i].above)) {
            return orders[i].wrong;
        }
    }
    /* both 0, or a release below the limit */
    if (c->imbalance_mv == 0u ? c->imbalance_clear_mv != 0u
                              : c->imbalance_clear_mv == 0u || c->imbalance_clear_mv >= c->imbalance_mv) {
        return N_imbalance_clear_mv;
    }
    if (c->balance_start_mv != 0u && c->balance_stop_mv > c->balance_start_mv) {
        return N_balance_stop_mv;
    }
    return bq_soc_config_ok(&c->soc) ? NONE : N_soc;
}

bq_status bq_pack_config_validate(const bq_pack_config *config, const char **field_name)
{
    unsigned wrong = NONE;
    bq_status status = BQ_E_ARG;

    if (config != NULL) {
        status = BQ_E_RANGE;
        wrong = out_of_range(config);
        if (wrong == NONE) {
            status = BQ_E_CONFIG;
            wrong = contradiction(config);
        }
        status = wrong != NONE ? status : BQ_OK;
    }
    if (field_name != NULL) {
        *field_name = wrong != NONE ? bq_word(names, wrong) : NULL;
    }
    return status;
}

/* What does not depend on the chemistry. */
#define COMMON                                                                                               \
    .overtemp_dc = 600, .overtemp_clear_dc = 550, .undertemp_dc = -200, .undertemp_clear_dc = -150,          \
    .imbalance_mv = 500, .imbalance_clear_mv = 400, .debounce_ms = 300, .recover_ms = 5000,                  \
    .comm_timeout_ms = 2000, .balance_start_mv = 15, .balance_stop_mv = 5, .balance_max_temp_dc = 500,       \
    .balance_rest_ma = 500, .balance_rest_ms = 60000, .balance_duty_percent = 90

static const bq_pack_config nmc = {COMMON,
                                   .cell_ov_mv = 4250,
                                   .cell_ov_clear_mv = 4150,
                                   .cell_uv_mv = 2700,
                                   .cell_uv_clear_mv = 3000,
                                   .balance_min_cell_mv = 3500};
static const bq_pack_config lfp = {COMMON,
                                   .cell_ov_mv = 3650,
                                   .cell_ov_clear_mv = 3500,
                                   .cell_uv_mv = 2500,
                                   .cell_uv_clear_mv = 2900,
                                   .balance_min_cell_mv = 3350};

static bq_pack_config sized(const bq_pack_config *from, uint16_t cells, uint16_t sensors, uint16_t modules)
{
    bq_pack_config c = *from;

    c.cells = cells;
    c.sensors = sensors;
    c.modules = modules;
    return c;
}

bq_pack_config bq_pack_config_nmc(uint16_t cells, uint16_t sensors, uint16_t modules)
{
    return sized(&nmc, cells, sensors, modules);
}

bq_pack_config bq_pack_config_lfp(uint16_t cells, uint16_t sensors, uint16_t modules)
{
    return sized(&lfp, cells, sensors, modules);
}
