/* SPDX-License-Identifier: Apache-2.0 */
/* Pins of hv-f405: an STM32F405RG (LQFP64) below a stack of bq76PL536. One row a pin, as in docs/boards.md.
 */
#ifndef PINS_H
#define PINS_H

#include "stm32_gpio.h"

/* SCK and MOSI are outputs at low level between packets; the SPI takes them for the length of a packet. */
/* clang-format off */
#define BOARD_PINS                                                                                                     \
    /* line                    port         pin  mode              pull             initial  af  edge */               \
    {BQ_LINE_CONTACTOR,        STM32_PORT_C,  6, STM32_PIN_OUTPUT, STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {BQ_LINE_PRECHARGE,        STM32_PORT_C,  7, STM32_PIN_OUTPUT, STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {BQ_LINE_CONTACTOR_FB,     STM32_PORT_C,  8, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {BQ_LINE_REQUEST,          STM32_PORT_C,  9, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*SHUNT*/,  STM32_PORT_C,  0, STM32_PIN_ANALOG, STM32_PULL_NONE, 0,       0,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*LED*/,    STM32_PORT_C, 13, STM32_PIN_OUTPUT, STM32_PULL_NONE, 0,       0,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*CS*/,     STM32_PORT_A,  4, STM32_PIN_OUTPUT, STM32_PULL_UP,   1,       0,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*SCK*/,    STM32_PORT_A,  5, STM32_PIN_OUTPUT, STM32_PULL_DOWN, 0,       5,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*MISO*/,   STM32_PORT_A,  6, STM32_PIN_AF,     STM32_PULL_UP,   0,       5,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*MOSI*/,   STM32_PORT_A,  7, STM32_PIN_OUTPUT, STM32_PULL_DOWN, 0,       5,  STM32_EDGE_NONE},      \
    {BQ_LINE_CONV,             STM32_PORT_B,  0, STM32_PIN_OUTPUT, STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {BQ_LINE_DRDY,             STM32_PORT_B,  1, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_RISING},    \
    {BQ_LINE_FAULT,            STM32_PORT_B,  4, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_RISING},    \
    {BQ_LINE_ALERT,            STM32_PORT_B,  5, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_RISING},    \
    {STM32_NO_LINE /*TX*/,     STM32_PORT_A,  2, STM32_PIN_AF,     STM32_PULL_NONE, 1,       7,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*RX*/,     STM32_PORT_A,  3, STM32_PIN_AF,     STM32_PULL_UP,   0,       7,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*CAN_RX*/, STM32_PORT_B,  8, STM32_PIN_AF,     STM32_PULL_UP,   0,       9,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*CAN_TX*/, STM32_PORT_B,  9, STM32_PIN_AF,     STM32_PULL_NONE, 1,       9,  STM32_EDGE_NONE}
/* clang-format on */

#define BOARD_LED_PORT STM32_PORT_C
#define BOARD_LED_PIN 13u
#define BOARD_SPI_PORT STM32_PORT_A
#define BOARD_SPI_CS 4u
#define BOARD_SPI_SCK 5u
#define BOARD_SPI_MOSI 7u
#define BOARD_SHUNT_CHANNEL 10u /* PC0 */
#define BOARD_SHUNT_ZERO 2048u  /* 1.650 V of 3.300 V */
#define BOARD_SHUNT_MA 330000   /* 1.650 V / 50 / 100 microohm: half of the range */
#define BOARD_BAUD 115200u
#define BOARD_NVM {{0x0800C000u, 0x08010000u}, 16384u} /* sectors 3 and 4; of the second the first 16 KB */

#endif
