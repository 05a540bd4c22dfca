/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_i2c.h
 * What both forms of the I2C peripheral share: the wires.
 */
#ifndef EMU_I2C_H
#define EMU_I2C_H

#include "emu_periph.h"

/** SCL and SDA are on pins, as alternate function and open drain; anything else is misuse, once per call.
 * False: at least one of them is on no pin, so that nothing reaches the wires. */
bool emu_i2c_connected(emu_periph *p);
/** Who else holds a wire low: EMU_I2C_SCL_LOW, EMU_I2C_SDA_LOW. */
unsigned emu_i2c_held(emu_periph *p);

#endif
