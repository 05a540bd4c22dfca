/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file app.h
 * The super-loop: joins a monitor (bq_afe), the pack controller and the board's lines.
 * Every period: scan, sample, pack step, apply, outputs. Nothing blocks.
 * SKELETON: the owner of src/app completes it.
 */
#ifndef BQHOST_APP_H
#define BQHOST_APP_H

#include "bqhost/afe.h"
#include "bqhost/hal.h"
#include "bqhost/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bq_app_config {
    uint32_t period_ms;       /**< control period, 10..10000 */
    bq_pack_config pack;
} bq_app_config;

#ifdef __cplusplus
}
#endif
#endif
