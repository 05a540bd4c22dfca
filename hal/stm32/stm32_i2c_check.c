/* SPDX-License-Identifier: Apache-2.0 */
/* Arguments and time limit of an I2C transaction. Pure, tested on the host. */
#include "stm32_i2c.h"

#define BYTE_US 135u      /* nine bits of 100 kHz and a half */
#define STRETCH_US 10000u /* what a slave may stretch in one transaction */

bool stm32_i2c_legal(uint8_t address7, const bq_i2c_segment *segments, size_t count)
{
    if (segments == NULL || count == 0u || count > 255u || address7 > 0x7fu) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        if (segments[i].len > 0u ? segments[i].data == NULL : segments[i].read) {
            return false;
        }
    }
    return true;
}

uint32_t stm32_i2c_limit_us(const bq_i2c_segment *segments, size_t count)
{
    uint32_t bytes = 0;
    for (size_t i = 0; i < count; i++) {
        bytes += segments[i].len + 1u;
    }
    return bytes * BYTE_US + STRETCH_US;
}
