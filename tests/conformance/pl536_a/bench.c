/* SPDX-License-Identifier: Apache-2.0 */
#include "bench.h"
#include <stdio.h>

static bqsim_session session;
static char reply_text[BQSIM_REPLY_MAX];

void setUp(void)
{
    bench_stack(1);
}

void tearDown(void)
{
}

void bench_stack_with(int n, const sim_pl_options *options)
{
    char line[24];

    bqsim_init(&session, NULL);
    if (options != NULL) {
        session.options = *options;
    }
    (void)snprintf(line, sizeof line, "stack %d", n);
    expect(line, "ok");
}

void bench_stack(int n)
{
    bench_stack_with(n, NULL);
}

sim_pl *bench_pl(void)
{
    return &session.stack;
}

sim_bus_fault *bench_fault(void)
{
    return sim_pl_bus_fault(&session.stack);
}

void bench_expect(const char *line, const char *reply, int at)
{
    (void)bqsim_exec(&session, line, reply_text, sizeof reply_text);
    UnityAssertString(reply, reply_text, at, line);
}

uint8_t bench_crc(const uint8_t *bytes, size_t n)
{
    unsigned crc = 0;

    for (size_t i = 0; i < n; i++) {
        for (int bit = 7; bit >= 0; bit--) {
            unsigned in = (unsigned)(bytes[i] >> bit) & 1u;
            unsigned out = (crc >> 7) ^ in;

            crc = (crc << 1) & 0xffu;
            if (out) {
                crc ^= 0x07u;
            }
        }
    }
    return (uint8_t)crc;
}

bool bench_send(const uint8_t *bytes, size_t n)
{
    uint8_t rx[300], driven[300];
    bool none = true;

    TEST_ASSERT_TRUE(n <= sizeof rx);
    sim_pl_spi(&session.stack, bytes, rx, driven, n);
    for (size_t i = 0; i < n; i++) {
        none = none && !driven[i];
    }
    return none;
}

void bench_write(int address, int reg, int data)
{
    uint8_t p[4] = {(uint8_t)(address << 1 | 1), (uint8_t)reg, (uint8_t)data, 0};

    p[3] = bench_crc(p, 3);
    TEST_ASSERT_TRUE_MESSAGE(bench_send(p, 4), "a device drove SDO during a write");
}

void bench_shadow(int address, int reg, int data)
{
    bench_write(address, 0x3a, 0x35);
    bench_write(address, reg, data);
}

void bench_read_block(int address, int reg, int n, uint8_t *data)
{
    uint8_t tx[300] = {(uint8_t)(address << 1), (uint8_t)reg, (uint8_t)n}, rx[300], driven[300], sum[300];
    size_t size = (uint8_t)n;

    sim_pl_spi(&session.stack, tx, rx, driven, size + 4);
    for (size_t i = 0; i < size + 4; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(i >= 3, driven[i], "only data and CRC of an answered read are driven");
    }
    memcpy(sum, tx, 3);
    memcpy(&sum[3], &rx[3], size);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(bench_crc(sum, size + 3), rx[size + 3], "CRC of a read");
    memcpy(data, &rx[3], size);
}

int bench_read(int address, int reg)
{
    uint8_t data;

    bench_read_block(address, reg, 1, &data);
    return data;
}

bool bench_silent(int address)
{
    uint8_t tx[5] = {(uint8_t)(address << 1), 0, 1, 0, 0};

    return bench_send(tx, sizeof tx);
}

void bench_address(int n)
{
    for (int k = 1; k <= n; k++) {
        bench_write(0, 0x3b, k);
    }
}

void bench_quiet(int n)
{
    bench_address(n);
    bench_shadow(ALL, 0x42, 0x2d);
    bench_shadow(ALL, 0x43, 0x85);
    bench_shadow(ALL, 0x44, 0x15);
    bench_shadow(ALL, 0x45, 0x85);
    bench_write(ALL, 0x20, 0x80);
    bench_write(ALL, 0x20, 0x00);
    bench_write(ALL, 0x21, 0x08);
    bench_write(ALL, 0x21, 0x00);
    for (int k = 1; k <= n; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(k, 0x20));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(k, 0x21));
        TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(k, 0x00));
    }
}

int bench_peek(int device, int reg)
{
    return sim_pl_peek(&session.stack, device, (uint8_t)reg);
}

void bench_dump(int device, uint8_t out[256])
{
    for (int reg = 0; reg < 256; reg++) {
        int value = bench_peek(device, reg);

        TEST_ASSERT_TRUE(value >= 0 && value <= 255);
        out[reg] = (uint8_t)value;
    }
}

void bench_advance_us(uint32_t us)
{
    char line[40];

    (void)snprintf(line, sizeof line, "advance %luus", (unsigned long)us);
    expect(line, "ok");
}

void bench_convert(void)
{
    bench_write(ALL, 0x30, 0x3d);
    bench_write(ALL, 0x34, 0x01);
    bench_advance_us(1000);
}

uint32_t bench_misuses(void)
{
    return sim_pl_misuse(&session.stack)->count;
}

void bench_no_misuse_at(int at)
{
    const sim_misuse *m = sim_pl_misuse(&session.stack);
    char text[140];

    (void)snprintf(text, sizeof text, "misuse of a correct host: %s device %d %s", m->entry[0].id,
                   m->entry[0].device, m->entry[0].text);
    UnityAssertInt(0, (UNITY_INT)m->count, at, text);
}

static bool listed(const char *ids, const char *id)
{
    size_t n = strlen(id);

    for (const char *p = ids; (p = strstr(p, id)) != NULL; p += n) {
        if ((p == ids || p[-1] == ' ') && (p[n] == ' ' || p[n] == '\0')) {
            return true;
        }
    }
    return false;
}

void bench_misuse_at(const char *ids, int device, int at)
{
    sim_misuse *m = sim_pl_misuse(&session.stack);
    uint32_t kept = m->count < SIM_MISUSE_KEPT ? m->count : SIM_MISUSE_KEPT;
    bool found = false;
    char text[200];

    for (uint32_t i = 0; i < kept; i++) {
        found = found || (m->entry[i].id[0] != '\0' && listed(ids, m->entry[i].id) &&
                          (device < 0 || m->entry[i].device == device));
    }
    (void)snprintf(text, sizeof text, "no %s for device %d; %lu entries, first %s device %d %s", ids, device,
                   (unsigned long)m->count, kept > 0 ? m->entry[0].id : "-",
                   kept > 0 ? m->entry[0].device : 0, kept > 0 ? m->entry[0].text : "");
    sim_misuse_clear(m);
    UnityAssert(found, at, text, NULL);
}
