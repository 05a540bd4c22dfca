/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_can.h
 * What a world or a test may want to know of the CAN controller.
 */
#ifndef EMU_CAN_H
#define EMU_CAN_H

#include "emu_periph.h"

/** Bits per second that the controller of this bus is set to; 0 = no such controller or no clock. A world
 * that knows the rate of its bus breaks frames of another rate with EMU_CAN_FORM_ERROR. */
uint32_t emu_can_bit_hz(const emu *e, unsigned can);
/** Bits of a frame on the wire from SOF to the end of the intermission, stuff bits included. */
unsigned emu_can_frame_bits(const emu_can_frame *f);

#endif
