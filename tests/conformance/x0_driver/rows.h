/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file rows.h
 * Tables of the requirement list, typed in from its rows, so that no test asks the driver what is right.
 */
#ifndef ROWS_H
#define ROWS_H

#include <stdint.h>

/** X0-CELL-01..15: inputs that carry cells, bit n-1 = VCn; 0 for a count the size cannot have. */
uint16_t rows_wiring(unsigned inputs, unsigned cells);
/** Input (1..) of a pack cell (1..). */
unsigned rows_input(unsigned inputs, unsigned cells, unsigned cell);
/** X0-CELL-19..21: whether a group's CELLBAL value is legal for the group's five bits of the wiring. */
int rows_legal_cellbal(unsigned group_wiring, unsigned value);
/** Fewest cells of a size: 3, 6, 9 (X0-VAR-22). */
unsigned rows_least(unsigned inputs);

/* X0-OCD-03, X0-SCD-01, X0-OCD-04, X0-SCD-02 */
extern const uint8_t rows_ocd_mv[2][16], rows_scd_mv[2][8];
extern const uint16_t rows_ocd_ms[8], rows_scd_us[4];

#endif
