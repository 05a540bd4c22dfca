/* SPDX-License-Identifier: Apache-2.0 */
/** @file hv_settings.h
 * A record of settings for hv-f405 as a tool on a PC would put it into flash. */
#ifndef HV_SETTINGS_H
#define HV_SETTINGS_H

#include "bqhost/app.h"
#include "bqhost/bq76pl536.h"

#define HV_SECTOR_0 0x0800C000u
#define HV_SECTOR_1 0x08010000u

typedef struct hv_settings {
    bq_app_config app;
    bq_ocv_point ocv[64];
    bq76pl536_config stack;
    uint8_t cells[BQ76PL536_MAX_DEVICES];
} hv_settings;

/** NMC cells, six a device, two sensors each; protection delays as given. */
void hv_settings_make(hv_settings *s, uint8_t devices, uint32_t delay_ms);
/** The record; its length in bytes. */
size_t hv_settings_record(hv_settings *s, uint32_t sequence, uint8_t *record, size_t capacity);
/** Puts the record into a sector of the emulated flash. */
void hv_settings_put(hv_settings *s, uint32_t sequence, uint32_t address);

#endif
