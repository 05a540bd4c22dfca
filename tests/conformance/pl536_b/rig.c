/* SPDX-License-Identifier: Apache-2.0 */
#include "rig.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

sim_pl rig;

void setUp(void)
{
}
void tearDown(void)
{
}

uint8_t rig_crc(const uint8_t *data, size_t n)
{
    unsigned crc = 0;
    for (size_t i = 0; i < n; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc & 0x80u) ? ((crc << 1) ^ 0x07u) & 0xffu : (crc << 1) & 0xffu;
        }
    }
    return (uint8_t)crc;
}

const char *rig_text(const char *format, ...)
{
    static char texts[4][160]; /* the arguments of one assertion may need several */
    static unsigned next;
    char *text = texts[next++ % 4u];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof texts[0], format, args);
    va_end(args);
    return text;
}

void rig_up_with(int devices, const sim_pl_options *options)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_init(&rig, devices, options));
    sim_misuse_clear(sim_pl_misuse(&rig));
}

void rig_up(int devices)
{
    rig_up_with(devices, NULL);
}

void rig_write(int device, int reg, int value)
{
    uint8_t tx[4] = {(uint8_t)(device << 1 | 1), (uint8_t)reg, (uint8_t)value, 0};
    uint8_t rx[4];
    tx[3] = rig_crc(tx, 3);
    sim_pl_spi(&rig, tx, rx, NULL, sizeof tx);
}

void rig_shadow(int device, int reg, int value)
{
    rig_write(device, R_SHDW, 0x35);
    rig_write(device, reg, value);
}

void rig_clear(int device, int reg, int mask)
{
    rig_write(device, reg, mask);
    rig_write(device, reg, 0);
}

static bool transfer(int device, int reg, uint8_t *data, size_t n)
{
    uint8_t tx[260] = {(uint8_t)(device << 1), (uint8_t)reg, (uint8_t)n};
    uint8_t rx[260], driven[260], all[260];
    if (n > 255) {
        return false;
    }
    memset(driven, 0, sizeof driven);
    sim_pl_spi(&rig, tx, rx, driven, n + 4);
    for (size_t i = 3; i < n + 4; i++) {
        if (!driven[i]) {
            return false;
        }
    }
    memcpy(all, tx, 3);
    memcpy(all + 3, rx + 3, n);
    memcpy(data, rx + 3, n);
    return rig_crc(all, n + 3) == rx[n + 3];
}

void rig_read_block(int device, int reg, uint8_t *data, size_t n)
{
    TEST_ASSERT_TRUE_MESSAGE(transfer(device, reg, data, n),
                             rig_text("no valid answer of device %d register %02x", device, (unsigned)reg));
}

uint8_t rig_read(int device, int reg)
{
    uint8_t value = 0;
    rig_read_block(device, reg, &value, 1);
    return value;
}

int rig_word(int device, int reg)
{
    uint8_t pair[2] = {0, 0};
    rig_read_block(device, reg, pair, 2);
    return pair[0] << 8 | pair[1];
}

bool rig_answers(int device)
{
    uint8_t value;
    return transfer(device, R_STATUS, &value, 1);
}

void rig_us(uint64_t us)
{
    sim_pl_advance(&rig, us * SIM_PL_US);
}

void rig_ms(uint64_t ms)
{
    sim_pl_advance(&rig, ms * SIM_PL_MS);
}

void rig_s(uint64_t s)
{
    sim_pl_advance(&rig, s * SIM_PL_S);
}

void rig_reset(int device)
{
    rig_write(device, R_RESET, 0xa5);
    rig_ms(1);
}

void rig_address(int devices)
{
    for (int n = 1; n <= devices; n++) {
        rig_write(0, R_ADDR, 0x80 | n);
        rig_us(5);
    }
}

void rig_ready_with(int devices, const sim_pl_options *options)
{
    rig_up_with(devices, options);
    rig_address(devices);
    rig_shadow(ALL, C_COV, 0x80);
    rig_shadow(ALL, C_CUV, 0x80);
    rig_clear(ALL, R_ALERT, 0x80);
    rig_clear(ALL, R_FAULT, 0x0b);
    if (options == NULL || !options->strict_timing) {
        EXPECT_CLEAN();
    }
}

void rig_ready(int devices)
{
    rig_ready_with(devices, NULL);
    for (int n = 1; n <= devices; n++) {
        EXPECT(0x81, n, R_STATUS);
    }
}

void rig_adc(int device, int control, int function)
{
    rig_write(device, R_ADC, control);
    rig_ms(1);
    rig_shadow(device, C_FUNC, function);
}

void rig_convert(int device)
{
    rig_write(device, R_CONV, 0x01);
    rig_ms(1);
}

/* The threshold goes in while the function is off, so that no state in between counts as misuse. */
void rig_cov(int code, int delay)
{
    rig_shadow(ALL, C_CUV, 0x80);
    rig_shadow(ALL, C_COV, code);
    rig_shadow(ALL, C_COVT, delay);
}

void rig_cuv(int code, int delay)
{
    rig_shadow(ALL, C_COV, 0x80);
    rig_shadow(ALL, C_CUV, code);
    rig_shadow(ALL, C_CUVT, delay);
}

void rig_ot(int codes, int delay)
{
    rig_write(ALL, R_IO, 0x03);
    rig_shadow(ALL, C_OTT, delay);
    rig_shadow(ALL, C_OT, codes);
}

bool rig_misused(const char *a, const char *b, const char *c, const char *d)
{
    const char *ids[] = {a, b, c, d};
    for (size_t i = 0; i < sizeof ids / sizeof ids[0] && ids[i] != NULL; i++) {
        if (sim_misuse_of(sim_pl_misuse(&rig), ids[i]) > 0) {
            return true;
        }
    }
    return false;
}
