/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file board_main.h
 * The main program that all boards share (board_main.c), and what it wants of each. A board's folder has
 *
 * - `board.h`: BOARD_CELLS, BOARD_SENSORS, BOARD_MODULES (room for the largest pack); BOARD_PRECHARGE,
 *   whether there is a precharge path; board_parts, the peripherals in use, with at least `boot`, `time`,
 *   `uart`, `can`; board_config, what the settings hold, with at least `app`. At its end it includes this
 *   file.
 * - `pins.h`: BOARD_PINS, BOARD_LED_PORT, BOARD_LED_PIN, BOARD_BAUD.
 * - the functions of the second part below, and the handlers of its own interrupts (vectors.c of the family
 *   lists their names). They only record.
 */
#ifndef BOARD_MAIN_H
#define BOARD_MAIN_H

/* ---- for the board
 * ------------------------------------------------------------------------------------------ */

extern board_parts board_hw;
extern board_config board_set;

/** For handlers of EXTI: acknowledges the lines of `mask` (bit n = EXTIn) and wakes the loop if one rose. */
void board_line_rose(uint32_t mask);

/** One pass of the loop; the time in us until the next one is due. A function with a name in every build:
 * tests measure at it how long a pass takes. */
uint32_t board_pass(void);

/* ---- by the board
 * ------------------------------------------------------------------------------------------- */

/** Starts what the others do not have, and enables the interrupts of its lines. Clock, time base and pins are
 * up; interrupts stay masked. */
void board_peripherals(void);

/** Completes what the board offers: `b` holds lines, clock, CAN, console and microcontroller. */
void board_offer(bq_board *b);

/** Limits of a board that nobody has configured, and the pointers that settings do not hold. */
void board_defaults(board_config *config);

/** Replaces the defaults by the settings in flash, if there are any, and completes what neither tells.
 * BQ_OK, also without settings; otherwise a status of bq_settings_load(): they are there and cannot be used.
 */
bq_status board_settings(board_config *config, const bq_nvm *nvm);

/** Initialises the driver of the monitor with board_set and tells it. Its statuses. */
bq_status board_monitor(const bq_board *b, bq_afe *afe);

/** Before the firmware refuses to work: a board whose outputs are FETs of the monitor gives `b->safe`. */
void board_refused(bq_board *b);

#endif
