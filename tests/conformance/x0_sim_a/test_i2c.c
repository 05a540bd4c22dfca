/* SPDX-License-Identifier: Apache-2.0 */
/* Framing, pointer and CRC on the bus. */
#include "rig.h"
#include <stdlib.h>

#define W 0x10
#define R 0x11

static bool put(int byte)
{
    return sim_x0_i2c_write(&chip, (uint8_t)byte);
}

static int get(bool ack)
{
    return sim_x0_i2c_read(&chip, ack);
}

static void start(void)
{
    sim_x0_i2c_start(&chip);
}

static void stop(void)
{
    sim_x0_i2c_stop(&chip);
}

/* proves: X0-I2C-11, X0-NUM-801, X0-NUM-802 */
static void test_the_crc_of_this_rig(void)
{
    TEST_ASSERT_EQUAL_HEX8(0xf4, rig_crc((const uint8_t *)"123456789", 9));
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_crc((const uint8_t *)"", 0));
    TEST_ASSERT_EQUAL_HEX8(0x07, rig_crc((const uint8_t[]){0x01}, 1));
    TEST_ASSERT_EQUAL_HEX8(0x89, rig_crc((const uint8_t[]){0x80}, 1));
    TEST_ASSERT_EQUAL_HEX8(0xf3, rig_crc((const uint8_t[]){0xff}, 1));
    TEST_ASSERT_EQUAL_HEX8(0x4f, rig_crc((const uint8_t[]){0x19}, 1));
    TEST_ASSERT_EQUAL_HEX8(0x66, rig_crc((const uint8_t[]){0x10, 0x0b}, 2));
    rig_boot("bq7694003"); /* and of the model: every data byte is accepted with this CRC only */
    for (int data = 0; data < 256; data++) {
        uint8_t frame[3] = {W, 0x09, (uint8_t)data}, right = rig_crc(frame, 3);
        for (int k = 0; k < 256; k++) {
            start();
            TEST_ASSERT_TRUE(put(W) && put(0x09) && put(data));
            TEST_ASSERT_EQUAL(k == right, put(k));
            stop();
        }
        TEST_ASSERT_EQUAL_HEX8(data, sim_x0_peek(&chip, 0x09));
    }
}

static void frames_a_single_write(const rig_part *p)
{
    uint8_t f[3] = {(uint8_t)(2 * p->address), 0x0a, 0x5a};
    rig_boot(p->name);
    start();
    TEST_ASSERT_TRUE(put(f[0]) && put(f[1]) && put(f[2]));
    TEST_ASSERT_EQUAL_HEX8(p->crc ? 0x97 : 0x5a,
                           sim_x0_peek(&chip, 0x0a)); /* X0-AMB-81: when it takes effect */
    if (p->crc) {
        TEST_ASSERT_TRUE(put(rig_crc(f, 3)));
    }
    TEST_ASSERT_EQUAL_HEX8(0x5a, sim_x0_peek(&chip, 0x0a));
    stop();
    expect_clean();
}

/* proves: X0-I2C-04, X0-I2C-05, X0-I2C-12, X0-AMB-81, X0-AMB-77 */
static void test_single_write(void)
{
    rig_each(frames_a_single_write);
}

/* proves: X0-I2C-06, X0-I2C-07, X0-I2C-13 */
static void test_block_write_with_crc(void)
{
    static const uint8_t data[3] = {0x15, 0x0a, 0x11};
    uint8_t f[3] = {W, 0x01, 0x15};
    rig_boot("bq7694003");
    start();
    TEST_ASSERT_TRUE(put(W) && put(0x01) && put(data[0]));
    TEST_ASSERT_EQUAL(0x01, chip.i2c.pointer);
    TEST_ASSERT_TRUE(put(rig_crc(f, 3)));
    TEST_ASSERT_EQUAL(0x02, chip.i2c.pointer); /* the advance comes with the crc */
    for (int i = 1; i < 3; i++) {
        TEST_ASSERT_TRUE(put(data[i]));
        TEST_ASSERT_EQUAL(1 + i, chip.i2c.pointer);
        TEST_ASSERT_TRUE(put(rig_crc(&data[i], 1)));
        TEST_ASSERT_EQUAL(2 + i, chip.i2c.pointer);
    }
    stop();
    TEST_ASSERT_EQUAL_HEX16(0x11 << 10 | 0x0a << 5 | 0x15, sim_x0_cb(&chip));
}

static void reads_in_both_forms(const rig_part *p)
{
    int address = 2 * p->address;
    uint8_t got[2][12];
    rig_boot(p->name);
    TEST_ASSERT_TRUE(rig_block_write(0x06, (const uint8_t[]){0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19}, 6));
    for (int form = 0; form < 2; form++) {
        start();
        TEST_ASSERT_TRUE(put(address) && put(0x06));
        if (form == 1) {
            stop();
            rig_wait(1000); /* the pointer waits */
        }
        start();
        TEST_ASSERT_TRUE(put(address + 1));
        for (int i = 0; i < 12; i++) {
            got[form][i] = (uint8_t)get(i < 11);
        }
        TEST_ASSERT_EQUAL_HEX8(0xff, get(true)); /* released after the last one */
        stop();
    }
    TEST_ASSERT_EQUAL_HEX8_ARRAY(got[0], got[1], p->crc ? 12 : 6);
    if (p->crc) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x8b, 0xfa, 0x5a, 0x81, 0x50, 0xb7}), got[0], 6);
    } else {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19}), got[0], 6);
    }
}

/* proves: X0-I2C-08, X0-I2C-09, X0-I2C-10, X0-I2C-14, X0-I2C-15, X0-I2C-16, X0-AMB-78, X0-AMB-83 */
static void test_both_read_forms(void)
{
    rig_each(reads_in_both_forms);
}

/* proves: X0-I2C-10, X0-AMB-82, X0-AMB-102 */
static void test_the_device_stops_at_the_byte_not_acknowledged(void)
{
    for (int last = 0; last < 6; last++) {
        rig_boot("bq7694003");
        start();
        TEST_ASSERT_TRUE(put(W) && put(0x06));
        start();
        TEST_ASSERT_TRUE(put(R));
        for (int i = 0; i <= last; i++) {
            (void)get(i < last);
        }
        TEST_ASSERT_EQUAL_HEX8(0xff, get(true));
        stop();
        TEST_ASSERT_EQUAL(0x06 + last / 2 + 1, chip.i2c.pointer);
        expect_reg(0x09, 0xac); /* a short read is a normal end */
    }
}

/* proves: X0-I2C-17, X0-I2C-07, X0-AMB-79, X0-AMB-80 */
static void test_a_wrong_crc_ends_the_transfer(void)
{
    uint8_t f[3] = {W, 0x06, 0x8b};
    rig_boot("bq7694003");
    start();
    TEST_ASSERT_TRUE(put(W) && put(0x06) && put(0x8b) && put(rig_crc(f, 3)) && put(0x5a));
    TEST_ASSERT_FALSE(put(0x00));
    TEST_ASSERT_EQUAL(0x07, chip.i2c.pointer);
    TEST_ASSERT_FALSE(put(0x5a));
    TEST_ASSERT_FALSE(put(0x81));
    TEST_ASSERT_EQUAL_HEX8(0xff, get(true));
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x07));
    start(); /* resumes at once, without a stop */
    TEST_ASSERT_TRUE(put(R));
    TEST_ASSERT_EQUAL_HEX8(0x00, get(false));
    stop();
    expect_clean();
}

/* proves: X0-I2C-18 */
static void test_a_part_without_crc_takes_every_byte_as_data(void)
{
    rig_boot("bq7694006");
    start();
    TEST_ASSERT_TRUE(put(0x30) && put(0x06) && put(0x8b) && put(0x27));
    stop();
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x27, sim_x0_peek(&chip, 0x07));
}

/* proves: X0-I2C-21, X0-AMB-19, X0-AMB-18 */
static void test_a_pair_is_coherent_and_other_pairs_are_live(void)
{
    rig_boot("bq7692000"); /* all cells 0x24d0 */
    start();
    TEST_ASSERT_TRUE(put(W) && put(0x0c));
    start();
    TEST_ASSERT_TRUE(put(R));
    TEST_ASSERT_EQUAL_HEX8(0x24, get(true));
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, 4.2); /* 0x2af3 */
    }
    rig_wait(250); /* published between the two bytes */
    TEST_ASSERT_EQUAL_HEX8(0xd0, get(true));
    TEST_ASSERT_EQUAL_HEX8(0x2a, get(true));
    TEST_ASSERT_EQUAL_HEX8(0xf3, get(false));
    stop();
    TEST_ASSERT_EQUAL_HEX16(0x2af3, rig_read16(0x0c));
    expect_clean();
}

/* proves: X0-I2C-21 */
static void test_the_freeze_does_not_outlive_the_transaction(void)
{
    rig_boot("bq7692000");
    (void)rig_read(0x0c);
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, 4.2);
    }
    rig_wait(250);
    TEST_ASSERT_EQUAL_HEX8(0xf3, rig_read(0x0d)); /* torn: 24 f3 */
    expect_misuse("X0-I2C-21");
}

/* proves: X0-I2C-24, X0-AMB-83 */
static void test_a_start_anywhere_begins_anew(void)
{
    rig_boot("bq7694003");
    for (int cut = 0; cut < 4; cut++) {
        start();
        for (int i = 0; i < cut; i++) {
            TEST_ASSERT_TRUE(put(i == 0 ? W : i == 1 ? 0x09 : 0x55));
        }
        start();
        TEST_ASSERT_TRUE(put(W) && put(0x0a));
        start();
        TEST_ASSERT_TRUE(put(R));
        TEST_ASSERT_EQUAL_HEX8(0x97, get(true));
        start(); /* in the middle of a read too */
        TEST_ASSERT_TRUE(put(R));
        TEST_ASSERT_EQUAL_HEX8(0x00, get(false)); /* 0x0b: the pointer was kept */
        stop();
        TEST_ASSERT_FALSE(put(W)); /* idle: no byte is taken without a start */
        TEST_ASSERT_EQUAL_HEX8(0xac, sim_x0_peek(&chip, 0x09));
    }
    TEST_ASSERT_EQUAL(0x0c, chip.i2c.pointer);
}

/* proves: X0-I2C-26, X0-AMB-102 */
static void test_an_address_alone_changes_nothing(void)
{
    uint8_t before[SIM_X0_REGS];
    rig_boot("bq7693003");
    (void)rig_read(0x06);
    memcpy(before, chip.reg, sizeof before);
    TEST_ASSERT_TRUE(rig_answers(0x08));
    start();
    TEST_ASSERT_TRUE(put(R));
    stop();
    TEST_ASSERT_EQUAL(0x07, chip.i2c.pointer);
    TEST_ASSERT_EQUAL_MEMORY(before, chip.reg, sizeof before);
    expect_clean();
}

/* proves: X0-I2C-27 */
static void test_one_flipped_bit_of_a_write(void)
{
    for (int bit = 0; bit < 32; bit++) {
        uint8_t f[4] = {W, 0x0b, 0x19, 0x7a};
        int taken = 0;
        rig_boot("bq7694003");
        TEST_ASSERT_EQUAL(0, sim_x0_flip_sda(&chip, bit));
        start();
        while (taken < 4 && put(f[taken])) {
            taken++;
        }
        stop();
        TEST_ASSERT_EQUAL(bit < 7 ? 0 : bit == 7 ? 1 : 3, taken);
        for (int reg = 0; reg < 0x0c; reg++) {
            static const uint8_t reset[12] = {0, 0, 0, 0, 0x10, 0, 0, 0, 0, 0xac, 0x97, 0};
            TEST_ASSERT_EQUAL_HEX8(reset[reg], sim_x0_peek(&chip, (uint8_t)reg));
        }
        TEST_ASSERT_TRUE(rig_write(0x0b, 0x19)); /* once only */
        expect_reg(0x0b, 0x19);
    }
    rig_boot("bq7694000"); /* without CRC it goes unseen, except by read-back */
    (void)sim_x0_flip_sda(&chip, 23);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    expect_reg(0x0b, 0x18);
}

/* proves: X0-I2C-27 */
static void test_one_flipped_bit_of_a_read(void)
{
    rig_boot("bq7694003");
    for (int bit = 24; bit < 40; bit++) {
        uint8_t got[3] = {R, 0, 0};
        (void)sim_x0_flip_sda(&chip, bit);
        start();
        TEST_ASSERT_TRUE(put(W) && put(0x0a));
        start();
        TEST_ASSERT_TRUE(put(R));
        got[1] = (uint8_t)get(true);
        got[2] = (uint8_t)get(false);
        stop();
        TEST_ASSERT_NOT_EQUAL(rig_crc(got, 2), got[2]);
    }
    TEST_ASSERT_EQUAL(-1, sim_x0_flip_sda(&chip, -1));
    expect_reg(0x0a, 0x97);
}

/* proves: X0-I2C-01, X0-I2C-23, X0-AMB-89, X0-TIM-20 */
static void test_no_bus_time_and_no_timeout(void)
{
    uint64_t before;
    rig_boot("bq7692000");
    before = chip.now;
    start();
    TEST_ASSERT_TRUE(put(W) && put(0x0b));
    TEST_ASSERT_EQUAL_UINT64(before, chip.now);
    rig_wait(3600000); /* an hour inside a transfer */
    TEST_ASSERT_TRUE(put(0x19));
    stop();
    expect_reg(0x0b, 0x19);
    TEST_ASSERT_TRUE(sim_x0_sda_free(&chip));
}

/* Sends the tokens of a trace and demands each acknowledge and each byte read. */
static void replay(const char *trace)
{
    for (const char *t = trace; *t != '\0'; t += strspn(t, " ")) {
        size_t n = strcspn(t, " ");
        int byte = (int)strtol(t, NULL, 16);
        const char *next = t + n + strspn(t + n, " ");
        if (n == 1) {
            (t[0] == 'S' ? start : stop)();
        } else if (n == 3) {
            TEST_ASSERT_EQUAL_MESSAGE(t[2] == '+', put(byte), trace);
        } else {
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(byte, get(*next != 'P'), trace);
        }
        t += n;
    }
}

/* proves: X0-NUM-859, X0-NUM-860, X0-NUM-861, X0-NUM-862, X0-NUM-863, X0-NUM-864, X0-NUM-865, X0-NUM-866 */
static void test_the_crc_of_address_0x18(void)
{
    /* no real part joins that address and CRC; a made-up one tests the arithmetic */
    static const sim_x0_part odd = {"made-up", 5, 0x18, true, 3300};
    TEST_ASSERT_EQUAL(0, sim_x0_init(&chip, &odd, NULL));
    (void)sim_x0_set_gain(&chip, 373); /* 0x50 reads 04 */
    (void)sim_x0_set_offset(&chip, 30);
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, 0x24d0 * 373e-6 + 0.030);
    }
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(300);
    replay("S 30+ 0b+ 19+ 39+ P");
    replay("S 30+ 04+ S 31+ 10 9c P");
    replay("S 30+ 0c+ S 31+ 24 10 d0 3e 24 fc d0 3e P");
    replay("S 30+ 50+ S 31+ 04 f0 1e 5a P");
    replay("S 30+ 05+ 43+ 6e+ P");
    rig_wait(250);
    replay("S 30+ 00+ S 31+ 80 65 P");
    replay("S 30+ 00+ 80+ 68+ P");
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_x0_peek(&chip, 0x00));
    replay("S 30+ 06+ 8b+ 27+ 5a+ 81+ 50+ b7+ bf+ 34+ 99+ c6+ 19+ 4f+ P");
    TEST_ASSERT_EQUAL_HEX8(0x99, sim_x0_peek(&chip, 0x0a));
    TEST_ASSERT_EQUAL_HEX8(0x43, sim_x0_peek(&chip, 0x05));
    expect_clean();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_crc_of_this_rig);
    RUN_TEST(test_single_write);
    RUN_TEST(test_block_write_with_crc);
    RUN_TEST(test_both_read_forms);
    RUN_TEST(test_the_device_stops_at_the_byte_not_acknowledged);
    RUN_TEST(test_a_wrong_crc_ends_the_transfer);
    RUN_TEST(test_a_part_without_crc_takes_every_byte_as_data);
    RUN_TEST(test_a_pair_is_coherent_and_other_pairs_are_live);
    RUN_TEST(test_the_freeze_does_not_outlive_the_transaction);
    RUN_TEST(test_a_start_anywhere_begins_anew);
    RUN_TEST(test_an_address_alone_changes_nothing);
    RUN_TEST(test_one_flipped_bit_of_a_write);
    RUN_TEST(test_one_flipped_bit_of_a_read);
    RUN_TEST(test_no_bus_time_and_no_timeout);
    RUN_TEST(test_the_crc_of_address_0x18);
    return UNITY_END();
}
