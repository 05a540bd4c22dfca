/* SPDX-License-Identifier: Apache-2.0 */
/* Limits of the pack controller: defaults, and one table from which checking and access by name follow. */
#include "bqhost/pack.h"
#include <stddef.h>
#include <string.h>

typedef enum field_kind { FIELD_U8, FIELD_U16, FIELD_I16, FIELD_I32 } field_kind;

typedef struct field {
    const char *name;
    uint16_t offset;
    uint8_t kind; /* field_kind */
    int32_t min, max;
} field;

#define FIELD(name, kind, min, max) {#name, (uint16_t)offsetof(bq_pack_config, name), (kind), (min), (max)}

static const field fields[] = {
    FIELD(cells, FIELD_U16, 1, (int32_t)BQ_PACK_MAX_CELLS),
    FIELD(sensors, FIELD_U16, 0, (int32_t)BQ_PACK_MAX_SENSORS),
    FIELD(modules, FIELD_U16, 1, (int32_t)BQ_PACK_MAX_MODULES),
    FIELD(cell_ov_mv, FIELD_U16, 1000, 4500),
    FIELD(cell_ov_clear_mv, FIELD_U16, 1000, 4500),
    FIELD(cell_uv_mv, FIELD_U16, 1000, 4500),
    FIELD(cell_uv_clear_mv, FIELD_U16, 1000, 4500),
    FIELD(overtemp_dc, FIELD_I16, -400, 1250),
    FIELD(overtemp_clear_dc, FIELD_I16, -400, 1250),
    FIELD(undertemp_dc, FIELD_I16, -400, 1250),
    FIELD(undertemp_clear_dc, FIELD_I16, -400, 1250),
    FIELD(imbalance_mv, FIELD_U16, 0, 4500),
    FIELD(imbalance_clear_mv, FIELD_U16, 0, 4500),
    FIELD(charge_max_ma, FIELD_I32, 0, 1000000),
    FIELD(discharge_max_ma, FIELD_I32, 0, 1000000),
    FIELD(debounce_ms, FIELD_U16, 0, 10000),
    FIELD(recover_ms, FIELD_U16, 100, 65535),
    FIELD(comm_timeout_ms, FIELD_U16, 20, 30000),
    FIELD(balance_start_mv, FIELD_U16, 0, 1000),
    FIELD(balance_stop_mv, FIELD_U16, 1, 1000),
    FIELD(balance_min_cell_mv, FIELD_U16, 1000, 4500),
    FIELD(balance_max_temp_dc, FIELD_I16, -400, 1250),
    FIELD(balance_rest_ma, FIELD_I32, 0, 1000000),
    FIELD(balance_rest_ms, FIELD_U16, 0, 65535),
    FIELD(balance_duty_percent, FIELD_U8, 1, 100),
    FIELD(balance_max_per_module, FIELD_U8, 0, 255),
};

#define FIELD_COUNT (sizeof fields / sizeof fields[0])

static int32_t load(const bq_pack_config *c, const field *f)
{
    const unsigned char *at = (const unsigned char *)c + f->offset;
    uint8_t u8;
    uint16_t u16;
    int16_t i16;
    int32_t i32;

    switch (f->kind) {
    case FIELD_U8:
        memcpy(&u8, at, sizeof u8);
        return u8;
    case FIELD_U16:
        memcpy(&u16, at, sizeof u16);
        return u16;
    case FIELD_I16:
        memcpy(&i16, at, sizeof i16);
        return i16;
    default:
        memcpy(&i32, at, sizeof i32);
        return i32;
    }
}

/* The value has been checked against the field's range, which lies inside its type. */
static void store(bq_pack_config *c, const field *f, int32_t value)
{
    unsigned char *at = (unsigned char *)c + f->offset;
    const uint8_t u8 = (uint8_t)value;
    const uint16_t u16 = (uint16_t)value;
    const int16_t i16 = (int16_t)value;

    switch (f->kind) {
    case FIELD_U8:
        memcpy(at, &u8, sizeof u8);
        break;
    case FIELD_U16:
        memcpy(at, &u16, sizeof u16);
        break;
    case FIELD_I16:
        memcpy(at, &i16, sizeof i16);
        break;
    default:
        memcpy(at, &value, sizeof value);
        break;
    }
}

static const field *find(const char *name)
{
    for (size_t i = 0; i < FIELD_COUNT; i++) {
        if (strcmp(fields[i].name, name) == 0) {
            return &fields[i];
        }
    }
    return NULL;
}

const char *bq_pack_config_field(uint16_t n)
{
    return n < FIELD_COUNT ? fields[n].name : NULL;
}

bq_status bq_pack_config_set(bq_pack_config *config, const char *name, int32_t value)
{
    const field *f = config != NULL && name != NULL ? find(name) : NULL;

    if (f == NULL) {
        return BQ_E_ARG;
    }
    if (value < f->min || value > f->max) {
        return BQ_E_RANGE;
    }
    store(config, f, value);
    return BQ_OK;
}

bq_status bq_pack_config_get(const bq_pack_config *config, const char *name, int32_t *value)
{
    const field *f = config != NULL && name != NULL && value != NULL ? find(name) : NULL;

    if (f == NULL) {
        return BQ_E_ARG;
    }
    *value = load(config, f);
    return BQ_OK;
}

/* Name of the first field that contradicts another one, or NULL. */
static const char *contradiction(const bq_pack_config *c)
{
    if (c->modules > c->cells) {
        return "modules";
    }
    if (c->cell_ov_clear_mv >= c->cell_ov_mv) {
        return "cell_ov_clear_mv";
    }
    if (c->cell_uv_clear_mv <= c->cell_uv_mv || c->cell_uv_clear_mv >= c->cell_ov_clear_mv) {
        return "cell_uv_clear_mv";
    }
    if (c->overtemp_clear_dc >= c->overtemp_dc) {
        return "overtemp_clear_dc";
    }
    if (c->undertemp_clear_dc <= c->undertemp_dc || c->undertemp_clear_dc >= c->overtemp_clear_dc) {
        return "undertemp_clear_dc";
    }
    /* both 0, or a release below the limit */
    if (c->imbalance_mv == 0u ? c->imbalance_clear_mv != 0u
                              : c->imbalance_clear_mv == 0u || c->imbalance_clear_mv >= c->imbalance_mv) {
        return "imbalance_clear_mv";
    }
    if (c->balance_start_mv != 0u && c->balance_stop_mv > c->balance_start_mv) {
        return "balance_stop_mv";
    }
    return bq_soc_config_ok(&c->soc) ? NULL : "soc";
}

bq_status bq_pack_config_validate(const bq_pack_config *config, const char **field_name)
{
    const char *wrong = NULL;
    bq_status status = BQ_OK;

    if (config == NULL) {
        status = BQ_E_ARG;
    }
    for (size_t i = 0; status == BQ_OK && i < FIELD_COUNT; i++) {
        const int32_t value = load(config, &fields[i]);
        if (value < fields[i].min || value > fields[i].max) {
            wrong = fields[i].name;
            status = BQ_E_RANGE;
        }
    }
    if (status == BQ_OK) {
        wrong = contradiction(config);
        status = wrong != NULL ? BQ_E_CONFIG : BQ_OK;
    }
    if (field_name != NULL) {
        *field_name = wrong;
    }
    return status;
}

/* What does not depend on the chemistry. */
static bq_pack_config common(uint16_t cells, uint16_t sensors, uint16_t modules)
{
    bq_pack_config c;

    memset(&c, 0, sizeof c);
    c.cells = cells;
    c.sensors = sensors;
    c.modules = modules;
    c.overtemp_dc = 600;
    c.overtemp_clear_dc = 550;
    c.undertemp_dc = -200;
    c.undertemp_clear_dc = -150;
    c.imbalance_mv = 500;
    c.imbalance_clear_mv = 400;
    c.debounce_ms = 300;
    c.recover_ms = 5000;
    c.comm_timeout_ms = 2000;
    c.balance_start_mv = 15;
    c.balance_stop_mv = 5;
    c.balance_max_temp_dc = 500;
    c.balance_rest_ma = 500;
    c.balance_rest_ms = 60000;
    c.balance_duty_percent = 90;
    return c;
}

bq_pack_config bq_pack_config_nmc(uint16_t cells, uint16_t sensors, uint16_t modules)
{
    bq_pack_config c = common(cells, sensors, modules);

    c.cell_ov_mv = 4250;
    c.cell_ov_clear_mv = 4150;
    c.cell_uv_mv = 2700;
    c.cell_uv_clear_mv = 3000;
    c.balance_min_cell_mv = 3500;
    return c;
}

bq_pack_config bq_pack_config_lfp(uint16_t cells, uint16_t sensors, uint16_t modules)
{
    bq_pack_config c = common(cells, sensors, modules);

    c.cell_ov_mv = 3650;
    c.cell_ov_clear_mv = 3500;
    c.cell_uv_mv = 2500;
    c.cell_uv_clear_mv = 2900;
    c.balance_min_cell_mv = 3350;
    return c;
}
