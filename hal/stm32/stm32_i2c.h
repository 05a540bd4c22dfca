/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_i2c.h
 * I2C1 as master at 100 kHz, interrupt-driven, below bq_i2c. The state machine is of the family: version 2 of
 * the peripheral in the F0, version 1 in the F4. Shared: arguments, the limit of a transaction, recovery of
 * the bus by hand.
 */
#ifndef STM32_I2C_H
#define STM32_I2C_H

#include "bqhost/hal.h"
#include "stm32_time.h"

/** One bus; the board owns it. */
typedef struct stm32_i2c {
    volatile bool busy;        /* a transaction runs */
    volatile uint8_t step;     /* of the family's state machine, where it needs one; 0 = idle */
    bool owed;                 /* its outcome has not been told yet */
    volatile bq_status result; /* of the transaction; BQ_OK until something failed */
    uint8_t port, scl, sda;    /* the pins, for recovery */
    uint8_t address7;
    stm32_time *time;
    const bq_i2c_segment *segment, *last; /* the present one */
    uint8_t *at, *end;                    /* of its bytes that have not moved */
    uint32_t from_us, limit_us;
} stm32_i2c;

/** Clocks I2C1 and starts it. The pins `scl`, `sda` of `port` come from the board's table as alternate
 * functions, open drain. */
void stm32_i2c_init(stm32_i2c *i2c, stm32_time *time, unsigned port, unsigned scl, unsigned sda);

/** For the board's I2C1 handlers (one vector on the F0, event and error on the F4; each may call it). Reports
 * an event to `time` when a transaction has ended. */
void stm32_i2c_irq(stm32_i2c *i2c);

/** start, poll, recover as in bqhost/hal.h. A transaction that has not ended after its nominal time and a
 * half plus 10 ms of stretching is cut off (BQ_E_TIMEOUT): the peripheral is reset and releases both lines.
 */
bq_i2c stm32_i2c_bus(stm32_i2c *i2c);

/* ---- shared by both generations, for their source files
 * ------------------------------------------------------ */

/** True if start may take these arguments: 1..255 segments, data where there is a length, no empty read, an
 * address of 7 bits. */
bool stm32_i2c_legal(uint8_t address7, const bq_i2c_segment *segments, size_t count);
/** Longest time the transaction may take. */
uint32_t stm32_i2c_limit_us(const bq_i2c_segment *segments, size_t count);
/** Whether both lines are high at the pins. */
bool stm32_i2c_lines_free(const stm32_i2c *i2c);
/** Makes `s` the present segment. */
void stm32_i2c_enter(stm32_i2c *i2c, const bq_i2c_segment *s);
/** Ends the transaction with `why`: the peripheral is reset and releases both lines. */
void stm32_i2c_cut_off(stm32_i2c *i2c, bq_status why);
/** Up to nine clocks and a STOP by hand while the peripheral is off; the pins are alternate functions again
 * afterwards. At most 200 us. BQ_OK: both lines are high; else BQ_E_ARBITRATION. */
bq_status stm32_i2c_free_lines(const stm32_i2c *i2c);

/* ---- by the family
 * --------------------------------------------------------------------------------------------- */

/** Releases the lines and forgets what was under way. */
void stm32_i2c_off(void);
/** Configures the peripheral, ready for a START, without interrupts. */
void stm32_i2c_on(void);
/** Enables its vectors. */
void stm32_i2c_irqs_enable(void);
/** Whether a transaction may begin. */
bool stm32_i2c_bus_free(const stm32_i2c *i2c);
/** Enters `s`, the first segment, and sends START. */
void stm32_i2c_begin(stm32_i2c *i2c, const bq_i2c_segment *s);
/** What no interrupt tells, at every poll. */
void stm32_i2c_look(stm32_i2c *i2c);

#endif
