/* SPDX-License-Identifier: Apache-2.0 */
/* The smallest program of somebody who uses the library: it must compile, link and know a status by name. */
#include "bqhost/app.h"
#include "bqhost/bq76pl536.h"
#include <stdio.h>

int main(void)
{
    bq76pl536 driver;
    bq76pl536_config config = {0};
    bq_status status = bq76pl536_init(&driver, &config, NULL, NULL, NULL, NULL, 0);
    puts(bq_status_name(status));
    return status == BQ_OK;
}
