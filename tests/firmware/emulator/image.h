/* SPDX-License-Identifier: Apache-2.0 */
/** @file image.h
 * Small images for the processor tests: a vector table and pieces of machine code at fixed places. */
#ifndef IMAGE_H
#define IMAGE_H

#include "regs.h"
#include "snippets.h"

#define CODE 0x08000400u /* where the program of an image stands */
#define STACK_TOP 0x20002000u
#define HALT 0x08000300u /* handlers that a test does not name: branch to self */
#define SKIP_TEST 77

/** A fresh chip with processor; every vector at HALT, the program at CODE. Not yet started. */
emu *image_start(const emu_chip *chip, regs_world *w, const uint16_t *code, size_t bytes);
/** Exception `number` is handled by code at 08000000 + 0x800 * number. */
void image_handler(emu *e, unsigned number, const uint16_t *code, size_t bytes);
uint32_t image_handler_at(unsigned number);
/** Starts the image with a power-on reset and runs so many nanoseconds. */
emu_stop image_run(emu *e, uint64_t ns);
uint32_t image_word(emu *e, uint32_t address);

#define START(chip, w, code) image_start((chip), (w), (code), sizeof(code))
#define HANDLER(e, number, code) image_handler((e), (number), (code), sizeof(code))

#endif
