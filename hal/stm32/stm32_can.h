/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file stm32_can.h
 * The bxCAN controller at 500 kbit/s. Receives data frames with standard ids STM32_CAN_FIRST_ID .. + 15,
 * sends anything. Frames leave in the order of their queueing (three mailboxes). Bus-off: the mailboxes are
 * emptied, the controller rejoins by itself after 128 times 11 recessive bits.
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
    bq_can_frame rx[STM32_CAN_RX];
    volatile uint8_t put, get; /* run freely */
    uint32_t dropped;          /**< frames that arrived without room */
    uint32_t bus_offs;         /**< times the controller went off */
} stm32_can;

/**
 * Clocks CAN1 and sets it up; its pins come from the board's table. Blocks at most 1 ms for the answer to the
 * request for initialisation. Does not wait for the bus: a bus that is held dominant leaves the state
 * BQ_CAN_OFF until it is free. BQ_OK; BQ_E_TIMEOUT: the controller did not enter initialisation, nothing is
 * sent or received.
 */
bq_status stm32_can_init(stm32_can *can, stm32_time *time);

/** For the board's CAN handlers: transmit, receive FIFO 0, status change (one vector on the F0, three on the
 * F4; each may call it). */
void stm32_can_irq(stm32_can *can);

/** send: BQ_OK; BQ_E_BUSY (three frames wait); BQ_E_BUS (off, or not yet on the bus); BQ_E_ARG. */
bq_can stm32_can_bus(stm32_can *can);

#endif
