/* SPDX-License-Identifier: Apache-2.0 */
/* Pins of the test image f405-afe: an STM32F405RG and one bq769x0. */
#ifndef PINS_H
#define PINS_H

#include "stm32_gpio.h"

/* clang-format off */
#define BOARD_PINS                                                                                                     \
    /* line                    port         pin  mode              pull             initial  af  edge */               \
    {BQ_LINE_AFE_BOOT,         STM32_PORT_B,  0, STM32_PIN_OUTPUT, STM32_PULL_NONE, 0,       0,  STM32_EDGE_NONE},      \
    {BQ_LINE_ALERT,            STM32_PORT_B,  5, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_RISING},    \
    {STM32_NO_LINE /*SCL*/,    STM32_PORT_B,  6, STM32_PIN_AF_OD,  STM32_PULL_NONE, 1,       4,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*SDA*/,    STM32_PORT_B,  7, STM32_PIN_AF_OD,  STM32_PULL_NONE, 1,       4,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*TX*/,     STM32_PORT_A,  2, STM32_PIN_AF,     STM32_PULL_NONE, 1,       7,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*RX*/,     STM32_PORT_A,  3, STM32_PIN_AF,     STM32_PULL_UP,   0,       7,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*CAN_RX*/, STM32_PORT_B,  8, STM32_PIN_AF,     STM32_PULL_UP,   0,       9,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*CAN_TX*/, STM32_PORT_B,  9, STM32_PIN_AF,     STM32_PULL_NONE, 1,       9,  STM32_EDGE_NONE},      \
    {BQ_LINE_REQUEST,          STM32_PORT_C,  9, STM32_PIN_INPUT,  STM32_PULL_DOWN, 0,       0,  STM32_EDGE_NONE},      \
    {STM32_NO_LINE /*LED*/,    STM32_PORT_C, 13, STM32_PIN_OUTPUT, STM32_PULL_NONE, 0,       0,  STM32_EDGE_NONE}
/* clang-format on */

#define BOARD_LED_PORT STM32_PORT_C
#define BOARD_LED_PIN 13u
#define BOARD_I2C_PORT STM32_PORT_B
#define BOARD_I2C_SCL 6u
#define BOARD_I2C_SDA 7u
#define BOARD_BAUD 115200u
#define BOARD_NVM {{0x0800C000u, 0x08010000u}, 16384u} /* sectors 3 and 4 */

#endif
