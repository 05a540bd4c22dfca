/* SPDX-License-Identifier: Apache-2.0 */
/* What the files of the super-loop share; see include/bqhost/app.h. */
#ifndef APP_INTERNAL_H
#define APP_INTERNAL_H

#include "bqhost/app.h"

void bq_app_count(uint32_t *counter); /* saturating */

/* monitor.c */
void bq_app_poll_job(bq_app *app);  /* polls the running job once */
bool bq_app_begin_job(bq_app *app); /* begins the next one when idle; true if it tried */
bool bq_app_paused(const bq_app *app, uint32_t *left_us); /* a failed job may not be repeated yet */

/* contactor.c */
bq_status bq_app_write_contactor(bq_app *app, bool on); /* BQ_E_UNSUPPORTED counts as BQ_OK */
void bq_app_watch_contactor(bq_app *app);
uint32_t bq_app_mismatch_ms(const bq_app *app);
bool bq_app_precharge_overdue(const bq_app *app); /* the path is closed alone for longer than it may be */

/* app.c */
bool bq_app_step_due(const bq_app *app);

#endif
