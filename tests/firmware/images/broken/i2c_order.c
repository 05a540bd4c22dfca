/* SPDX-License-Identifier: Apache-2.0 */
/* The I2C is switched on before its timing is set. */
#include "defect.h"
#include "stm32_i2c.h"
#include "stm32f0_regs.h"

void __real_stm32_i2c_init(stm32_i2c *i2c, stm32_time *time, unsigned port, unsigned scl, unsigned sda);
void __wrap_stm32_i2c_init(stm32_i2c *i2c, stm32_time *time, unsigned port, unsigned scl, unsigned sda);

void __wrap_stm32_i2c_init(stm32_i2c *i2c, stm32_time *time, unsigned port, unsigned scl, unsigned sda)
{
    __real_stm32_i2c_init(i2c, time, port, scl, sda);
    STM32_I2C1->timingr = STM32_I2C1->timingr;
}
