/* SPDX-License-Identifier: Apache-2.0 */
/* The bq769x0 on the I2C bus of the board. */
#include "board.h"

static bq769x0 monitor;

bq_status board_monitor(const bq_board *b, bq_afe *afe)
{
    bq_i2c i2c = stm32_i2c_bus(&board_hw.i2c);
    *afe = bq769x0_afe(&monitor);
    return bq769x0_init(&monitor, &board_set.afe, &i2c, &b->gpio, &b->clock);
}

/* The FETs must go off whatever is wrong, so the monitor is brought up with limits that it accepts. */
void board_refused(bq_board *b)
{
    bq_afe afe;
    board_defaults(&board_set);
    if (board_monitor(b, &afe) == BQ_OK) {
        b->safe = afe;
    }
}
