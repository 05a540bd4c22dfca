/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_can.h
 * The bxCAN controller at 500 kbit/s. Sends anything; where a board listens, receives data frames with
 * standard ids STM32_CAN_FIRST_ID .. + 15. Frames leave in the order of their queueing (three mailboxes).
 * Bus-off: the mailboxes are emptied, the controller rejoins by itself after 128 times 11 recessive bits.
 */
#ifndef STM32_CAN_H
#define STM32_CAN_H

#include "bqhost/hal.h"
#include "stm32_time.h"

#define STM32_CAN_FIRST_ID                                                                                   \
    0x080u              /**< the sixteen ids that are received; the rest of the bus wakes nobody             \
                         */
#define STM32_CAN_RX 8u /**< received frames that may wait, a power of two */

/** One controller; the board owns it. */
typedef struct stm32_can {
    stm32_time *time;
} stm32_can;

/** What it received; the board owns it. A frame that arrives without room is dropped. */
typedef struct stm32_can_inbox {
    stm32_time *time;
    bq_can_frame rx[STM32_CAN_RX];
    volatile uint8_t put, get; /* run freely */
} stm32_can_inbox;

/**
 * Clocks CAN1 and sets it up; its pins come from the board's table. Blocks at most 1 ms for the answer to the
 * request for initialisation. Does not wait for the bus: a bus that is held dominant leaves the state
 * BQ_CAN_OFF until it is free. BQ_OK; BQ_E_TIMEOUT: the controller did not enter initialisation, nothing is
 * sent or received.
 */
bq_status stm32_can_init(stm32_can *can, stm32_time *time);

/** For the board's CAN handlers: transmit, status change (one vector on the F0, two on the F4; each may call
 * it). */
void stm32_can_irq(stm32_can *can);

/** For a board that sends only. send: BQ_OK; BQ_E_BUSY (three frames wait); BQ_E_BUS (off, or not yet on the
 * bus); BQ_E_ARG. receive: nothing ever comes. */
bq_can stm32_can_bus(void);

/** The same for a board that listens; call after stm32_can_init(). */
bq_can stm32_can_listen(stm32_can_inbox *inbox, stm32_time *time);

/** For its CAN handler of receive FIFO 0. */
void stm32_can_rx_irq(stm32_can_inbox *inbox);

#endif
