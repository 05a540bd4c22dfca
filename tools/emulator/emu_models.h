/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_models.h
 * The peripheral models: one maker each. The comment states the order of the instance's irq list.
 */
#ifndef EMU_MODELS_H
#define EMU_MODELS_H

#include "emu_periph.h"

emu_periph *emu_rcc_f0_new(emu *e, const emu_instance *at);   /**< none */
emu_periph *emu_rcc_f4_new(emu *e, const emu_instance *at);   /**< none */
emu_periph *emu_flash_f0_new(emu *e, const emu_instance *at); /**< global */
emu_periph *emu_flash_f4_new(emu *e, const emu_instance *at); /**< global */
emu_periph *emu_pwr_new(emu *e, const emu_instance *at);      /**< none; PVD goes to EXTI line 16 */
emu_periph *emu_gpio_new(emu *e, const emu_instance *at);     /**< none; number 1 = port A */
emu_periph *emu_syscfg_new(emu *e, const emu_instance *at);   /**< none */
emu_periph *emu_exti_new(emu *e, const emu_instance *at);     /**< none; the chip's table of lines */
emu_periph *emu_tim2_new(emu *e, const emu_instance *at);     /**< global */
emu_periph *emu_iwdg_new(emu *e, const emu_instance *at);     /**< none */
emu_periph *emu_usart_v1_new(emu *e, const emu_instance *at); /**< global (F4) */
emu_periph *emu_usart_v2_new(emu *e, const emu_instance *at); /**< global (F0) */
emu_periph *emu_i2c_v1_new(emu *e, const emu_instance *at);   /**< event, error (F4) */
emu_periph *emu_i2c_v2_new(emu *e, const emu_instance *at);   /**< global (F0) */
emu_periph *emu_spi_v1_new(emu *e, const emu_instance *at);   /**< global */
emu_periph *emu_dma_v2_new(emu *e, const emu_instance *at);   /**< streams 0 to 3; the others have none */
emu_periph *emu_can_new(emu *e, const emu_instance *at);    /**< transmit, FIFO 0, FIFO 1, change; F0: all */
emu_periph *emu_adc_f4_new(emu *e, const emu_instance *at); /**< global */

#endif
