/* SPDX-License-Identifier: Apache-2.0 */
/* The configuration of a stack, as a board keeps it. */
#ifndef SETTINGS_OBJECTS_H
#define SETTINGS_OBJECTS_H

#include "bqhost/app.h"
#include "bqhost/bq76pl536.h"
#include "bqhost/settings.h"

typedef struct objects {
    bq_app_config app;
    bq_ocv_point ocv[BQ_FIELD_MAX_POINTS];
    bq76pl536_config driver;
    uint8_t cells[BQ76PL536_MAX_DEVICES];
    bq_settings_part parts[4];
    bq_settings settings;
} objects;

/* Defaults for 96 cells with a curve of three points. */
void objects_init(objects *o);

#endif
