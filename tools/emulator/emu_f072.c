/* SPDX-License-Identifier: Apache-2.0 */
/* The STM32F072CB as a table (RM0091, datasheet DS9826). */
#include "emu_internal.h"

/* offsets of the clock enable and reset registers of RCC */
#define AHB 0x14, 0x28
#define APB2 0x18, 0x0c
#define APB1 0x1c, 0x10
#define NO_IRQ {EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ}
#define IRQ(n) {n, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ}
#define IRQS(a, b, c, d) {a, b, c, d}

/* A clock gate as the table wants it: GATE(APB1, bit). */
#define GATE_(enable, reset, bit) .enable_reg = (enable), .reset_reg = (reset), .enable_bit = (bit)
#define GATE(bus, bit) GATE_X(bus, bit)
#define GATE_X(enable, reset, bit) GATE_(enable, reset, bit)
#define ALWAYS .enable_reg = 0xff, .reset_reg = 0xff

#define PORT(letter, n, bit)                                                                                 \
    {.name = "GPIO" letter,                                                                                  \
     .create = emu_gpio_new,                                                                                 \
     .base = 0x48000000u + ((n) - 1u) * 0x400u,                                                              \
     .size = 0x400,                                                                                          \
     .number = (n),                                                                                          \
     .family = EMU_F0,                                                                                       \
     .bus = EMU_AHB,                                                                                         \
     GATE(AHB, bit),                                                                                         \
     .irq = NO_IRQ}

static const emu_pad usart1_pads[] = {{EMU_SIG_TX, 0, 9, 1},
                                      {EMU_SIG_RX, 0, 10, 1},
                                      {EMU_SIG_TX, 1, 6, 0},
                                      {EMU_SIG_RX, 1, 7, 0},
                                      {EMU_SIG_END, 0, 0, 0}};
static const emu_pad usart2_pads[] = {{EMU_SIG_TX, 0, 2, 1},
                                      {EMU_SIG_RX, 0, 3, 1},
                                      {EMU_SIG_TX, 0, 14, 1},
                                      {EMU_SIG_RX, 0, 15, 1},
                                      {EMU_SIG_END, 0, 0, 0}};

static const emu_pad i2c1_pads[] = {{EMU_SIG_SCL, 1, 6, 1},
                                    {EMU_SIG_SDA, 1, 7, 1},
                                    {EMU_SIG_SCL, 1, 8, 1},
                                    {EMU_SIG_SDA, 1, 9, 1},
                                    {EMU_SIG_END, 0, 0, 0}};
static const emu_pad can_pads[] = {{EMU_SIG_RX, 0, 11, 4}, {EMU_SIG_TX, 0, 12, 4}, {EMU_SIG_RX, 1, 8, 4},
                                   {EMU_SIG_TX, 1, 9, 4},  {EMU_SIG_RX, 3, 0, 0},  {EMU_SIG_TX, 3, 1, 0},
                                   {EMU_SIG_END, 0, 0, 0}};

static const emu_instance instances[] = {
    {.name = "RCC",
     .create = emu_rcc_f0_new,
     .base = 0x40021000u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_AHB,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "FLASH",
     .create = emu_flash_f0_new,
     .base = 0x40022000u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_AHB,
     ALWAYS,
     .irq = IRQ(3)},
    {.name = "PWR",
     .create = emu_pwr_new,
     .base = 0x40007000u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_APB1,
     GATE(APB1, 28),
     .irq = NO_IRQ},
    PORT("A", 1, 17),
    PORT("B", 2, 18),
    PORT("C", 3, 19),
    PORT("D", 4, 20),
    PORT("E", 5, 21),
    PORT("F", 6, 22),
    {.name = "SYSCFG",
     .create = emu_syscfg_new,
     .base = 0x40010000u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_APB2,
     GATE(APB2, 0),
     .irq = NO_IRQ},
    {.name = "EXTI",
     .create = emu_exti_new,
     .base = 0x40010400u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_APB2,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "TIM2",
     .create = emu_tim2_new,
     .base = 0x40000000u,
     .size = 0x400,
     .number = 2,
     .family = EMU_F0,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_TIMER,
     GATE(APB1, 0),
     .irq = IRQ(15)},
    {.name = "IWDG",
     .create = emu_iwdg_new,
     .base = 0x40003000u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_LSI,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "USART1",
     .create = emu_usart_v2_new,
     .base = 0x40013800u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F0,
     .bus = EMU_APB2,
     .kernel = EMU_KERNEL_USART,
     GATE(APB2, 14),
     .irq = IRQ(27),
     .pads = usart1_pads},
    {.name = "USART2",
     .create = emu_usart_v2_new,
     .base = 0x40004400u,
     .size = 0x400,
     .number = 2,
     .family = EMU_F0,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_USART,
     GATE(APB1, 17),
     .irq = IRQ(28),
     .pads = usart2_pads},
    {.name = "I2C1",
     .create = emu_i2c_v2_new,
     .base = 0x40005400u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F0,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_I2C1,
     GATE(APB1, 21),
     .irq = IRQ(23),
     .pads = i2c1_pads},
    {.name = "CAN",
     .create = emu_can_new,
     .base = 0x40006400u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F0,
     .bus = EMU_APB1,
     GATE(APB1, 25),
     .irq = IRQ(30),
     .pads = can_pads},
    {.name = "DBGMCU",
     .create = emu_debug_new,
     .base = 0x40015800u,
     .size = 0x400,
     .family = EMU_F0,
     .bus = EMU_APB2,
     GATE(APB2, 22),
     .irq = NO_IRQ},
    {.name = "SCS",
     .create = emu_scs_new,
     .base = 0xe000e000u,
     .size = 0x1000,
     .family = EMU_F0,
     .bus = EMU_CORE,
     ALWAYS,
     .irq = NO_IRQ},
};

static const emu_region regions[] = {
    {EMU_FLASH, 0x08000000u, 128u * 1024u},
    {EMU_ALIAS, 0x00000000u, 128u * 1024u},
    {EMU_RAM, 0x20000000u, 16u * 1024u},
    {EMU_ROM, 0x1fffc000u, 16u * 1024u}, /* system memory from 1fffc800, option bytes at 1ffff800 */
    {EMU_RAM, 0, 0},
};

/* Calibration values, size of flash in KB and option bytes (factory state). */
static const emu_word rom[] = {{0x1ffff7b8u, 0x05ee06d6u}, /* VREFINT and temperature at 30 degrees */
                               {0x1ffff7c0u, 0xffff04dfu},
                               {0x1ffff7ccu, 0xffff0080u},
                               {0x1ffff7acu, 0x00280043u},
                               {0x1ffff7b0u, 0x5734500bu},
                               {0x1ffff7b4u, 0x20333350u},
                               {0x1ffff800u, 0x00ff55aau},
                               {0, 0}};

static const emu_window windows[] = {{0x40000000u, 0x8000u}, {0x40010000u, 0x8000u}, {0x40020000u, 0x5000u},
                                     {0x48000000u, 0x1800u}, {0xe000e000u, 0x1000u}, {0, 0}};

/* EXTI lines 0..31; lines that no model drives have no number. */
static const uint8_t exti_irq[32] = {
    5,  5,          6,          6,          7,          7,          7,          7,          7,          7, 7,
    7,  7,          7,          7,          7,          1,          2,          EMU_NO_IRQ, 2,          2, 12,
    12, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, EMU_NO_IRQ, 1};

const emu_chip emu_f072 = {
    .name = "STM32F072CB",
    .family = EMU_F0,
    .m4 = false,
    .irqs = 32,
    .priority_bits = 2,
    .flash_base = 0x08000000u,
    .flash_size = 128u * 1024u,
    .max_hclk = 48000000u,
    .max_pclk1 = 48000000u,
    .max_pclk2 = 48000000u,
    .hsi_hz = 8000000u,
    .hse_hz = 8000000u,
    .lsi_hz = 40000u,
    .regions = regions,
    .windows = windows,
    .rom = rom,
    .instances = instances,
    .instance_count = sizeof instances / sizeof instances[0],
    .exti_lines = 32,
    .exti_irq = exti_irq,
};
