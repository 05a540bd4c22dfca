/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file rig.h
 * A host of a few lines for the conformance tests of the simulated stack: it speaks the packets of the
 * requirements with a CRC of its own and shares no code with the library or the simulator. Device 0x3f is the
 * broadcast, 0 the discovery address.
 */
#ifndef RIG_H
#define RIG_H

#include "sim_pl536.h"
#include "unity.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    ALL = 0x3f,
    R_STATUS = 0x00,
    R_GPAI = 0x01,
    R_CELL1 = 0x03,
    R_CELL6 = 0x0d,
    R_TEMP1 = 0x0f,
    R_TEMP2 = 0x11,
    R_ALERT = 0x20,
    R_FAULT = 0x21,
    R_COV = 0x22,
    R_CUV = 0x23,
    R_PRES_A = 0x24,
    R_PRES_B = 0x25,
    R_ADC = 0x30,
    R_IO = 0x31,
    R_CB = 0x32,
    R_CBT = 0x33,
    R_CONV = 0x34,
    R_SHDW = 0x3a,
    R_ADDR = 0x3b,
    R_RESET = 0x3c,
    R_TEST = 0x3d,
    R_EEN = 0x3f,
    C_FUNC = 0x40,
    C_IO = 0x41,
    C_COV = 0x42,
    C_COVT = 0x43,
    C_CUV = 0x44,
    C_CUVT = 0x45,
    C_OT = 0x46,
    C_OTT = 0x47
};

extern sim_pl rig;

/** A stack as it comes out of power-on reset, nothing addressed; every call begins anew. */
void rig_up(int devices);
void rig_up_with(int devices, const sim_pl_options *options);
/** Addresses 1..devices to address 0x00 in turn. */
void rig_address(int devices);
/** Up, addressed, COV and CUV switched off, every flag cleared: DEVICE_STATUS 0x81, no misuse. */
void rig_ready(int devices);
void rig_ready_with(int devices, const sim_pl_options *options);

uint8_t rig_crc(const uint8_t *data, size_t n);
void rig_write(int device, int reg, int value);
void rig_shadow(int device, int reg, int value); /**< key and write */
void rig_clear(int device, int reg, int mask);   /**< mask, then 0 */
uint8_t rig_read(int device, int reg);           /**< fails the test without an answer or with a wrong CRC */
void rig_read_block(int device, int reg, uint8_t *data, size_t n);
int rig_word(int device, int reg);
bool rig_answers(int device);
void rig_reset(int device); /**< RESET command and 1 ms */

void rig_us(uint64_t us);
void rig_ms(uint64_t ms);
void rig_s(uint64_t s);

/** ADC on, 1 ms, 6 us per channel, ADC_CONTROL = `control` (with ADC_ON set); for a device or ALL. */
void rig_adc(int device, int control, int function);
void rig_convert(int device); /**< firmware start and 1 ms */
/** COV or CUV at `code` with `delay`; the other one off. */
void rig_cov(int code, int delay);
void rig_cuv(int code, int delay);
/** OT on both sensors with their switches closed. */
void rig_ot(int codes, int delay);

/** Whether one of the (up to four, NULL-ended) requirements was recorded as broken. */
bool rig_misused(const char *a, const char *b, const char *c, const char *d);
const char *rig_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

#define EXPECT(value, device, reg)                                                                           \
    TEST_ASSERT_EQUAL_HEX8_MESSAGE((value), rig_read((device), (reg)),                                       \
                                   rig_text("device %d register %02x", (device), (reg)))
#define EXPECT_WORD(value, device, reg)                                                                      \
    TEST_ASSERT_EQUAL_HEX16_MESSAGE((value), rig_word((device), (reg)),                                      \
                                    rig_text("device %d register %02x", (device), (reg)))
#define EXPECT_CLEAN()                                                                                       \
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, sim_pl_misuse(&rig)->count, sim_pl_misuse(&rig)->entry[0].id)
#define EXPECT_MISUSE(...) EXPECT_MISUSE_(__VA_ARGS__, NULL, NULL, NULL, NULL)
#define EXPECT_MISUSE_(a, b, c, d, ...)                                                                      \
    TEST_ASSERT_TRUE_MESSAGE(                                                                                \
        rig_misused(a, b, c, d),                                                                             \
        rig_text("%s not recorded; first entry: %s", a,                                                      \
                 sim_pl_misuse(&rig)->count ? sim_pl_misuse(&rig)->entry[0].id : "none"))
#define MODE(m, device) TEST_ASSERT_EQUAL_INT((m), sim_pl_get_mode(&rig, (device)))

#endif
