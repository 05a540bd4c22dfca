/* SPDX-License-Identifier: Apache-2.0 */
/* Test image: at every start it loads the settings (equal bytes), tells them as CAN frame 0x200
 * {status, value, all equal}, saves the next value, tells the outcome as 0x201 {status, value}, and sleeps.
 */
#include "bqhost/settings.h"
#include "nvm.h"
#include "stm32_can.h"
#include "stm32_chip.h"
#include "stm32_clock.h"
#include "stm32_core.h"
#include "stm32_gpio.h"
#include "stm32_life.h"
#include "stm32_nvm.h"
#include "stm32_supply.h"
#include "stm32_time.h"
#include "stm32_watchdog.h"

static const stm32_pin pin_table[] = {
    {STM32_NO_LINE, STM32_PORT_B, 8, STM32_PIN_AF, STM32_PULL_UP, 0, NVM_CAN_AF, STM32_EDGE_NONE},
    {STM32_NO_LINE, STM32_PORT_B, 9, STM32_PIN_AF, STM32_PULL_NONE, 1, NVM_CAN_AF, STM32_EDGE_NONE}};
static const stm32_pins pins = {pin_table, 2};
static const stm32_nvm sectors = NVM_SECTORS;

static bq_boot boot;
static stm32_time timebase;
static stm32_can can;
static uint8_t stored[NVM_BYTES];
static const bq_settings_part part = {&bq_byte_fields, stored, NVM_BYTES};
static const bq_settings settings = {&part, 1};

void board_outputs_safe(void)
{
}

void tim2_handler(void)
{
    stm32_time_irq(&timebase);
}

NVM_CAN_HANDLERS

static void start(void)
{
    stm32_life_begin(&boot);
    boot.crystal_failed = !stm32_clock_start();
    stm32_watchdog_start();
    stm32_time_init(&timebase);
    stm32_supply_init();
    stm32_pins_init(&pins);
    (void)stm32_can_init(&can, &timebase);
    stm32_unlock(0);
}

static void tell(uint32_t id, bq_status status)
{
    bq_can bus = stm32_can_bus();
    bq_can_frame frame = {.id = id, .len = 3};
    frame.data[0] = (uint8_t)status;
    frame.data[1] = stored[0];
    frame.data[2] = 1;
    for (unsigned i = 1; i < NVM_BYTES; i++) {
        if (stored[i] != stored[0]) {
            frame.data[2] = 0;
        }
    }
    while (bus.ops->send(bus.ctx, &frame) != BQ_OK) { /* the bus is joined some bits after the start */
        stm32_time_sleep(&timebase, 100);
    }
}

void board_main(void)
{
    bq_nvm nvm = stm32_nvm_memory(&sectors);
    uint8_t next;
    start();
    tell(0x200, bq_settings_load(&settings, &nvm));
    next = (uint8_t)(stored[0] + 1u);
    for (unsigned i = 0; i < NVM_BYTES; i++) {
        stored[i] = next;
    }
    tell(0x201, bq_settings_save(&settings, &nvm));
    for (;;) {
        stm32_watchdog_feed();
        stm32_life_pass();
        stm32_time_sleep(&timebase, 100000);
    }
}
