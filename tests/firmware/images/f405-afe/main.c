/* SPDX-License-Identifier: Apache-2.0 */
/* The test image f405-afe: all memory, the interrupt handlers, the loop. */
#include "board.h"
#include "stm32_clock.h"
#include "stm32_core.h"
#include "stm32_gpio.h"

static board_parts parts;
static board_config config;
static bq769x0 monitor;
static bq_cell_reading cells[BOARD_CELLS];
static bq_temp_reading temps[BOARD_SENSORS];
static bq_module_reading modules[1];
static bq_firmware firmware;

/* ---- interrupts: they only record
 * --------------------------------------------------------------------------- */

void nmi_handler(void)
{
    if (!stm32_clock_failed()) {
        stm32_crash(2);
    }
    parts.boot.crystal_failed = true;
}

void tim2_handler(void)
{
    stm32_time_irq(&parts.time);
}

void exti9_5_handler(void)
{
    if (stm32_exti_take(1u << 5) != 0u) { /* ALERT */
        stm32_time_event(&parts.time);
    }
}

void i2c1_ev_handler(void)
{
    stm32_i2c_irq(&parts.i2c);
}

void i2c1_er_handler(void)
{
    stm32_i2c_irq(&parts.i2c);
}

void usart2_handler(void)
{
    stm32_uart_irq(&parts.uart);
}

void can1_tx_handler(void)
{
    stm32_can_irq(&parts.can);
}

void can1_rx0_handler(void)
{
    stm32_can_irq(&parts.can);
}

void can1_sce_handler(void)
{
    stm32_can_irq(&parts.can);
}

/* ---- loop
 * --------------------------------------------------------------------------------------------------- */

static bq_status start_monitor(const bq_board *b)
{
    bq_i2c i2c = stm32_i2c_bus(&parts.i2c);
    return bq769x0_init(&monitor, &config.afe, &i2c, &b->gpio, &b->clock);
}

/* `*what`: the part that was refused. */
static bq_status start(const bq_board *b, const char **what)
{
    const bq_afe afe = bq769x0_afe(&monitor);
    bq_status st;
    *what = "image";
    if (!parts.boot.image_ok) {
        return BQ_E_CRC;
    }
    *what = "settings";
    st = board_settings(&config, &b->nvm);
    if (st != BQ_OK) {
        return st;
    }
    *what = "monitor";
    st = start_monitor(b);
    if (st != BQ_OK) {
        return st;
    }
    st = bq_app_config_validate(&config.app, what);
    if (st != BQ_OK) {
        return st;
    }
    *what = "firmware";
    return bq_firmware_init(&firmware, b, &config.app, &afe, cells, BOARD_CELLS, temps, BOARD_SENSORS,
                            modules, 1);
}

/* The FETs must go off whatever is wrong, so the monitor is brought up with limits that it accepts. */
static void refuse(bq_board *b, bq_status why, const char *what)
{
    board_defaults(&config);
    if (start_monitor(b) == BQ_OK) {
        b->safe = bq769x0_afe(&monitor);
    }
    bq_firmware_refuse(&firmware, b, why, what);
}

static void show_outputs(void)
{
    const bq_app *app = bq_firmware_app(&firmware);
    board_led(app != NULL && bq_app_outputs_on(app));
}

void board_main(void)
{
    bq_board board;
    bq_status st;
    const char *what;
    board_start(&parts);
    board = board_table(&parts);
    board_defaults(&config);
    st = start(&board, &what);
    if (st != BQ_OK) {
        refuse(&board, st, what);
    }
    stm32_unlock(0);
    for (;;) {
        uint32_t hint = bq_firmware_step(&firmware);
        stm32_life_pass();
        show_outputs();
        stm32_time_sleep(&parts.time, hint);
    }
}
