/* SPDX-License-Identifier: Apache-2.0 */
/* The main program of every board: its safe state, the order in which it starts, the common interrupt
 * handlers, the loop, and all memory of the firmware. */
#include "board.h"
#include "pins.h"
#include "stm32_clock.h"
#include "stm32_core.h"
#include "stm32_gpio.h"
#include "stm32_image.h"
#include "stm32_watchdog.h"

static const stm32_pin pin_table[] = {BOARD_PINS};
static const stm32_pins pins = {pin_table, sizeof pin_table / sizeof pin_table[0]};

board_parts board_hw;
board_config board_set;
static bq_cell_reading cells[BOARD_CELLS];
static bq_temp_reading temps[BOARD_SENSORS];
static bq_module_reading modules[BOARD_MODULES];
static bq_firmware firmware;

/* ---- interrupts: they only record
 * --------------------------------------------------------------------------- */

void nmi_handler(void)
{
    if (!stm32_clock_failed()) {
        stm32_crash(2);
    }
    board_hw.boot.crystal_failed = true;
}

void tim2_handler(void)
{
    stm32_time_irq(&board_hw.time);
}

void usart2_handler(void)
{
    stm32_uart_irq(&board_hw.uart);
}

void board_line_rose(uint32_t mask)
{
    if (stm32_exti_take(mask) != 0u) {
        stm32_time_event(&board_hw.time);
    }
}

/* ---- start
 * -------------------------------------------------------------------------------------------------- */

void board_outputs_safe(void)
{
    stm32_pins_safe(&pins);
}

/* From reset to running peripherals; interrupts stay masked. */
static void start_parts(void)
{
    bq_boot *boot = &board_hw.boot;
    stm32_life_begin(boot);
    boot->crystal_failed = !stm32_clock_start(); /* first: the checksum takes ten times longer without */
    boot->image_ok = stm32_image_self_check();
    boot->image_crc = stm32_image_stored_crc();
    stm32_watchdog_start();
    stm32_time_init(&board_hw.time);
    stm32_pins_init(&pins);
    stm32_uart_init(&board_hw.uart, &board_hw.time, BOARD_BAUD);
    (void)stm32_can_init(&board_hw.can, &board_hw.time); /* a dead controller is told by its state */
    board_peripherals();
}

static void offer(bq_board *b)
{
    *b = (bq_board){.name = BQHOST_BOARD,
                    .gpio = stm32_gpio(&pins),
                    .clock = stm32_clock(),
                    .can = stm32_can_bus(),
                    .console = stm32_uart_stream(&board_hw.uart),
                    .mcu = stm32_mcu(&board_hw.boot)};
    board_offer(b);
}

/* `*what`: the part that was refused. */
static bq_status start(const bq_board *b, const char **what)
{
    bq_afe afe;
    bq_status st;
    *what = "image";
    if (!board_hw.boot.image_ok) {
        return BQ_E_CRC;
    }
    *what = "settings";
    st = board_settings(&board_set, &b->nvm);
    if (st != BQ_OK) {
        return st;
    }
    *what = "monitor";
    st = board_monitor(b, &afe);
    if (st != BQ_OK) {
        return st;
    }
    st = bq_app_config_validate(&board_set.app, what);
    if (st != BQ_OK) {
        return st;
    }
    *what = "firmware";
    st = bq_firmware_init(&firmware, b, &board_set.app, &afe, cells, BOARD_CELLS, temps, BOARD_SENSORS,
                          modules, BOARD_MODULES);
    if (st == BQ_OK && BOARD_PRECHARGE) {
        bq_app_use_precharge(bq_firmware_app(&firmware));
    }
    return st;
}

/* ---- loop
 * --------------------------------------------------------------------------------------------------- */

__attribute__((noinline, used)) uint32_t board_pass(void)
{
    const uint32_t hint = bq_firmware_step(&firmware);
    const bq_app *app = bq_firmware_app(&firmware);
    stm32_life_pass();
    stm32_pin_write(BOARD_LED_PORT, BOARD_LED_PIN, app != NULL && bq_app_outputs_on(app));
    return hint;
}

void board_main(void)
{
    bq_board board;
    bq_status st;
    const char *what;
    start_parts();
    offer(&board);
    board_defaults(&board_set);
    st = start(&board, &what);
    if (st != BQ_OK) {
        board_refused(&board);
        bq_firmware_refuse(&firmware, &board, st, what);
    }
    stm32_unlock(0);
    for (;;) {
        stm32_time_sleep(&board_hw.time, board_pass());
    }
}
