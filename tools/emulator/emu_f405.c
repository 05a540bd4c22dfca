/* SPDX-License-Identifier: Apache-2.0 */
/* The STM32F405RG as a table (RM0090, datasheet DS8626). */
#include "emu_internal.h"

/* offsets of the clock enable and reset registers of RCC */
#define AHB 0x30, 0x10
#define APB2 0x44, 0x24
#define APB1 0x40, 0x20
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
     .base = 0x40020000u + ((n) - 1u) * 0x400u,                                                              \
     .size = 0x400,                                                                                          \
     .number = (n),                                                                                          \
     .family = EMU_F4,                                                                                       \
     .bus = EMU_AHB,                                                                                         \
     GATE(AHB, bit),                                                                                         \
     .irq = NO_IRQ}

static const emu_pad usart1_pads[] = {{EMU_SIG_TX, 0, 9, 7},
                                      {EMU_SIG_RX, 0, 10, 7},
                                      {EMU_SIG_TX, 1, 6, 7},
                                      {EMU_SIG_RX, 1, 7, 7},
                                      {EMU_SIG_END, 0, 0, 0}};
static const emu_pad usart2_pads[] = {{EMU_SIG_TX, 0, 2, 7}, {EMU_SIG_RX, 0, 3, 7}, {EMU_SIG_END, 0, 0, 0}};

static const emu_pad i2c1_pads[] = {{EMU_SIG_SCL, 1, 6, 4},
                                    {EMU_SIG_SDA, 1, 7, 4},
                                    {EMU_SIG_SCL, 1, 8, 4},
                                    {EMU_SIG_SDA, 1, 9, 4},
                                    {EMU_SIG_END, 0, 0, 0}};
static const emu_pad spi1_pads[] = {{EMU_SIG_SCK, 0, 5, 5}, {EMU_SIG_MISO, 0, 6, 5}, {EMU_SIG_MOSI, 0, 7, 5},
                                    {EMU_SIG_SCK, 1, 3, 5}, {EMU_SIG_MISO, 1, 4, 5}, {EMU_SIG_MOSI, 1, 5, 5},
                                    {EMU_SIG_END, 0, 0, 0}};
static const emu_pad can1_pads[] = {{EMU_SIG_RX, 0, 11, 9}, {EMU_SIG_TX, 0, 12, 9}, {EMU_SIG_RX, 1, 8, 9},
                                    {EMU_SIG_TX, 1, 9, 9},  {EMU_SIG_RX, 3, 0, 9},  {EMU_SIG_TX, 3, 1, 9},
                                    {EMU_SIG_END, 0, 0, 0}};
#define ANALOG(channel, port, pin) {EMU_SIG_CHANNEL0 + (channel), port, pin, EMU_AF_ANALOG}
static const emu_pad adc1_pads[] = {
    ANALOG(0, 0, 0),  ANALOG(1, 0, 1),       ANALOG(2, 0, 2),  ANALOG(3, 0, 3),  ANALOG(4, 0, 4),
    ANALOG(5, 0, 5),  ANALOG(6, 0, 6),       ANALOG(7, 0, 7),  ANALOG(8, 1, 0),  ANALOG(9, 1, 1),
    ANALOG(10, 2, 0), ANALOG(11, 2, 1),      ANALOG(12, 2, 2), ANALOG(13, 2, 3), ANALOG(14, 2, 4),
    ANALOG(15, 2, 5), {EMU_SIG_END, 0, 0, 0}};

static const emu_instance instances[] = {
    {.name = "RCC",
     .create = emu_rcc_f4_new,
     .base = 0x40023800u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_AHB,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "FLASH",
     .create = emu_flash_f4_new,
     .base = 0x40023c00u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_AHB,
     ALWAYS,
     .irq = IRQ(4)},
    {.name = "PWR",
     .create = emu_pwr_new,
     .base = 0x40007000u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_APB1,
     GATE(APB1, 28),
     .irq = NO_IRQ},
    PORT("A", 1, 0),
    PORT("B", 2, 1),
    PORT("C", 3, 2),
    PORT("D", 4, 3),
    PORT("E", 5, 4),
    PORT("F", 6, 5),
    PORT("G", 7, 6),
    PORT("H", 8, 7),
    PORT("I", 9, 8),
    {.name = "SYSCFG",
     .create = emu_syscfg_new,
     .base = 0x40013800u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_APB2,
     GATE(APB2, 14),
     .irq = NO_IRQ},
    {.name = "EXTI",
     .create = emu_exti_new,
     .base = 0x40013c00u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_APB2,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "TIM2",
     .create = emu_tim2_new,
     .base = 0x40000000u,
     .size = 0x400,
     .number = 2,
     .family = EMU_F4,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_TIMER,
     GATE(APB1, 0),
     .irq = IRQ(28)},
    {.name = "TIM5",
     .create = emu_tim2_new,
     .base = 0x40000c00u,
     .size = 0x400,
     .number = 5,
     .family = EMU_F4,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_TIMER,
     GATE(APB1, 3),
     .irq = IRQ(50)},
    {.name = "IWDG",
     .create = emu_iwdg_new,
     .base = 0x40003000u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_APB1,
     .kernel = EMU_KERNEL_LSI,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "USART1",
     .create = emu_usart_v1_new,
     .base = 0x40011000u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_APB2,
     GATE(APB2, 4),
     .irq = IRQ(37),
     .pads = usart1_pads},
    {.name = "USART2",
     .create = emu_usart_v1_new,
     .base = 0x40004400u,
     .size = 0x400,
     .number = 2,
     .family = EMU_F4,
     .bus = EMU_APB1,
     GATE(APB1, 17),
     .irq = IRQ(38),
     .pads = usart2_pads},
    {.name = "I2C1",
     .create = emu_i2c_v1_new,
     .base = 0x40005400u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_APB1,
     GATE(APB1, 21),
     .irq = IRQS(31, 32, EMU_NO_IRQ, EMU_NO_IRQ),
     .pads = i2c1_pads},
    {.name = "SPI1",
     .create = emu_spi_v1_new,
     .base = 0x40013000u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_APB2,
     GATE(APB2, 12),
     .irq = IRQ(35),
     .pads = spi1_pads},
    {.name = "DMA1",
     .create = emu_dma_v2_new,
     .base = 0x40026000u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_AHB,
     GATE(AHB, 21),
     .irq = IRQS(11, 12, 13, 14)},
    {.name = "DMA2",
     .create = emu_dma_v2_new,
     .base = 0x40026400u,
     .size = 0x400,
     .number = 2,
     .family = EMU_F4,
     .bus = EMU_AHB,
     GATE(AHB, 22),
     .irq = IRQS(56, 57, 58, 59)},
    {.name = "CAN1",
     .create = emu_can_new,
     .base = 0x40006400u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_APB1,
     GATE(APB1, 25),
     .irq = IRQS(19, 20, 21, 22),
     .pads = can1_pads},
    {.name = "ADC1",
     .create = emu_adc_f4_new,
     .base = 0x40012000u,
     .size = 0x400,
     .number = 1,
     .family = EMU_F4,
     .bus = EMU_APB2,
     GATE(APB2, 8),
     .irq = IRQ(18),
     .pads = adc1_pads},
    {.name = "DBGMCU",
     .create = emu_debug_new,
     .base = 0xe0042000u,
     .size = 0x400,
     .family = EMU_F4,
     .bus = EMU_CORE,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "DWT",
     .create = emu_dwt_new,
     .base = 0xe0001000u,
     .size = 0x1000,
     .family = EMU_F4,
     .bus = EMU_CORE,
     ALWAYS,
     .irq = NO_IRQ},
    {.name = "SCS",
     .create = emu_scs_new,
     .base = 0xe000e000u,
     .size = 0x1000,
     .family = EMU_F4,
     .bus = EMU_CORE,
     ALWAYS,
     .irq = NO_IRQ},
};

static const emu_region regions[] = {
    {EMU_FLASH, 0x08000000u, 1024u * 1024u},
    {EMU_ALIAS, 0x00000000u, 1024u * 1024u},
    {EMU_RAM, 0x20000000u, 128u * 1024u},
    {EMU_RAM, 0x10000000u, 64u * 1024u}, /* CCM: data only, not for DMA */
    {EMU_ROM, 0x1fff0000u, 32u * 1024u}, /* system memory, device signature */
    {EMU_RAM, 0, 0},
};

/* Calibration values, unique number and size of flash in KB. */
static const emu_word rom[] = {{0x1fff7a10u, 0x00280043u},
                               {0x1fff7a14u, 0x5734500bu},
                               {0x1fff7a18u, 0x20333350u},
                               {0x1fff7a20u, 0x0400ffffu},
                               {0x1fff7a28u, 0x05deffffu},
                               {0x1fff7a2cu, 0x04be03b2u},
                               {0, 0}};

static const emu_window windows[] = {
    {0x40000000u, 0x8000u}, {0x40010000u, 0x8000u}, {0x40020000u, 0x10000u}, {0x50000000u, 0x61000u},
    {0xe0000000u, 0x3000u}, {0xe000e000u, 0x1000u}, {0xe0040000u, 0x3000u},  {0, 0}};

/* EXTI lines 0..22; lines that no model drives have no number. */
static const uint8_t exti_irq[23] = {6,  7,  8,  9,  10, 23, 23, 23, 23, 23, 40, 40,
                                     40, 40, 40, 40, 1,  41, 42, 62, 76, 2,  3};

static const uint32_t sectors[] = {16u << 10,  16u << 10,  16u << 10,  16u << 10,  64u << 10,
                                   128u << 10, 128u << 10, 128u << 10, 128u << 10, 128u << 10,
                                   128u << 10, 128u << 10, 0};

const emu_chip emu_f405 = {
    .name = "STM32F405RG",
    .family = EMU_F4,
    .m4 = true,
    .irqs = 82,
    .priority_bits = 4,
    .flash_base = 0x08000000u,
    .flash_size = 1024u * 1024u,
    .max_hclk = 168000000u,
    .max_pclk1 = 42000000u,
    .max_pclk2 = 84000000u,
    .hsi_hz = 16000000u,
    .hse_hz = 8000000u,
    .lsi_hz = 32000u,
    .regions = regions,
    .windows = windows,
    .rom = rom,
    .instances = instances,
    .instance_count = sizeof instances / sizeof instances[0],
    .exti_lines = 23,
    .exti_irq = exti_irq,
    .sectors = sectors,
};
