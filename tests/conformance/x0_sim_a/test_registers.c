/* SPDX-License-Identifier: Apache-2.0 */
/* Every register of the map on every part: reset value, which bits store, who has it, what a write does. */
#include "rig.h"

typedef struct row {
    int reg;
    int inputs;   /* the smallest size that has it */
    int reset;    /* on entering NORMAL */
    int stores;   /* bits that keep what is written; 0 = read-only */
    int harmless; /* a value that is no misuse and starts nothing */
} row;

static const row rows[] = {
    {0x00, 5, 0x00, 0x00, 0x00},  {0x01, 5, 0x00, 0x1f, 0x15}, {0x02, 10, 0x00, 0x1f, 0x0a},
    {0x03, 15, 0x00, 0x1f, 0x05}, {0x04, 5, 0x10, 0x1f, 0x18}, {0x05, 5, 0x00, 0xff, 0x03},
    {0x06, 5, 0x00, 0xbf, 0x9f},  {0x07, 5, 0x00, 0x7f, 0x7f}, {0x08, 5, 0x00, 0xff, 0xf0},
    {0x09, 5, 0xac, 0xff, 0xff},  {0x0a, 5, 0x97, 0xff, 0x5a}, {0x0b, 5, 0x00, 0x3f, 0x19},
};
#define ROWS (int)(sizeof rows / sizeof rows[0])

static int smallest_with(int reg)
{
    if (reg >= 0x0c && reg <= 0x29) {
        return reg < 0x16 ? 5 : reg < 0x20 ? 10 : 15;
    }
    return reg == 0x02 || reg == 0x2e || reg == 0x2f   ? 10
           : reg == 0x03 || reg == 0x30 || reg == 0x31 ? 15
                                                       : 5;
}

static void resets_as_listed(const rig_part *p)
{
    rig_pulse(p->name);
    rig_at(20);
    for (int i = 0; i < ROWS; i++) {
        expect_reg(rows[i].reg, rows[i].inputs <= p->inputs ? rows[i].reset : 0);
    }
    for (int reg = 0x0c; reg <= 0x33; reg++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(reg));
    }
}

static void stores_as_listed(const rig_part *p)
{
    for (int i = 1; i < ROWS; i++) {
        const row *r = &rows[i];
        rig_boot(p->name);
        TEST_ASSERT_TRUE(rig_write(r->reg, r->harmless));
        expect_reg(r->reg, r->inputs <= p->inputs ? r->harmless : 0);
        if (r->inputs <= p->inputs) {
            expect_clean();
        } else {
            expect_misuse("X0-AMB-85");
        }
    }
}

/* Measurement registers follow the inputs of exactly the rows that name them. */
static void measures_as_listed(const rig_part *p)
{
    rig_pulse(p->name);
    for (int i = 1; i <= p->inputs; i++) { /* code 0x1000 + 0x0111 * input: every byte differs */
        (void)sim_x0_set_cell(&chip, i, (0x1000 + 0x111 * i) * 382e-6);
    }
    for (int i = 1; i <= p->inputs / 5; i++) {
        (void)sim_x0_set_ts(&chip, i, 10000.0 * i);
    }
    (void)sim_x0_set_sense(&chip, -0.131);
    rig_at(15);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_at(rig_first_ms() + 10);
    {
        static const int ts_code[3] = {0x10df, 0x167f, 6479}; /* 10, 20 and 30 kohm: 2.475 V / 382 uV */
        uint8_t got[40], expected[40] = {0};
        unsigned sum = 0;
        for (int i = 0; i < p->inputs; i++) {
            unsigned code = 0x1000u + 0x111u * (unsigned)(i + 1);
            sum += code;
            expected[2 * i] = (uint8_t)(code >> 8);
            expected[2 * i + 1] = (uint8_t)code;
        }
        expected[30] = (uint8_t)(sum / 4 >> 8);
        expected[31] = (uint8_t)(sum / 4);
        for (int i = 0; i < p->inputs / 5; i++) {
            expected[32 + 2 * i] = (uint8_t)(ts_code[i] >> 8);
            expected[33 + 2 * i] = (uint8_t)ts_code[i];
        }
        expected[38] = 0xc3; /* -0.131 V / 8.44 uV = -15521 */
        expected[39] = 0x5f;
        if (p->inputs == 5) { /* at 270 ms the window that began at 15 ms is complete */
            TEST_ASSERT_EQUAL_HEX16(0xc35f, rig_read16(0x32));
        }
        rig_block_read(0x0c, got, 40);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, got, 40);
        for (int reg = 0x0c; reg <= 0x33; reg += 2) { /* each alone: 0 where the size has none */
            TEST_ASSERT_EQUAL_HEX16(expected[reg - 0x0c] << 8 | expected[reg - 0x0b], rig_read16(reg));
            if (smallest_with(reg) > p->inputs) {
                TEST_ASSERT_EQUAL_HEX16(0, rig_read16(reg));
            }
        }
    }
    expect_clean();
}

/*
 * proves: X0-REG-00, X0-REG-01, X0-REG-02, X0-REG-03, X0-REG-04, X0-REG-05, X0-REG-06, X0-REG-07, X0-REG-08,
 *     X0-REG-09, X0-REG-0A, X0-REG-0B, X0-MODE-07, X0-AMB-14, X0-OV-03, X0-UV-03, X0-ADC-11
 */
static void test_control_registers(void)
{
    rig_each(resets_as_listed);
    rig_each(stores_as_listed);
}

/*
 * proves: X0-REG-0C, X0-REG-0D, X0-REG-0E, X0-REG-0F, X0-REG-10, X0-REG-11, X0-REG-12, X0-REG-13, X0-REG-14,
 *     X0-REG-15, X0-REG-16, X0-REG-17, X0-REG-18, X0-REG-19, X0-REG-1A, X0-REG-1B, X0-REG-1C, X0-REG-1D,
 *     X0-REG-1E, X0-REG-1F, X0-REG-20, X0-REG-21, X0-REG-22, X0-REG-23, X0-REG-24, X0-REG-25, X0-REG-26,
 *     X0-REG-27, X0-REG-28, X0-REG-29, X0-REG-2A, X0-REG-2B, X0-REG-2C, X0-REG-2D, X0-REG-2E, X0-REG-2F,
 *     X0-REG-30, X0-REG-31, X0-REG-32, X0-REG-33, X0-BIT-16, X0-AMB-13, X0-ADC-01, X0-TS-04, X0-BAT-01
 */
static void test_measurement_registers(void)
{
    rig_each(measures_as_listed);
}

static void trim_reads(const rig_part *p)
{
    rig_boot(p->name);
    TEST_ASSERT_EQUAL(0, sim_x0_set_gain(&chip, 396));
    TEST_ASSERT_EQUAL(0, sim_x0_set_offset(&chip, -60));
    expect_reg(0x50, 0x0c);
    expect_reg(0x59, 0xe0);
    expect_reg(0x51, 0xc4);
    TEST_ASSERT_EQUAL(0, sim_x0_set_gain(&chip, 365));
    chip.rsvd50 = 0xff; /* a test may give the reserved bits any value */
    chip.rsvd59 = 0xff;
    expect_reg(0x50, 0xf3);
    expect_reg(0x59, 0x1f);
}

/* proves: X0-REG-50, X0-REG-51, X0-REG-59, X0-ADC-04, X0-ADC-05 */
static void test_trim_registers(void)
{
    rig_each(trim_reads);
}

/* proves: X0-BIT-01, X0-AMB-87 */
static void test_bits_that_are_not_implemented(void)
{
    static const struct {
        int reg, written, read;
        const char *id;
    } c[] = {
        {0x01, 0xe0, 0x00, "X0-REG-01"}, {0x02, 0xe0, 0x00, "X0-REG-02"}, {0x03, 0xe0, 0x00, "X0-REG-03"},
        {0x04, 0x70, 0x10, "X0-REG-04"}, {0x06, 0x40, 0x00, "X0-REG-06"}, {0x07, 0x80, 0x00, "X0-REG-07"},
        {0x0b, 0xd9, 0x19, "X0-REG-0B"},
    };
    rig_boot("bq7694003");
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_TRUE(rig_write(c[i].reg, c[i].written));
        expect_reg(c[i].reg, c[i].read);
        expect_misuse(c[i].id);
        for (int bit = 0x80; bit != 0; bit >>= 1) { /* each bit alone */
            if ((c[i].written & ~c[i].read & bit) != 0) {
                TEST_ASSERT_TRUE(rig_write(c[i].reg, c[i].read | bit));
                expect_reg(c[i].reg, c[i].read);
                expect_misuse(c[i].id);
            }
        }
    }
    TEST_ASSERT_TRUE(rig_write(0x04, 0x90)); /* LOAD_PRESENT as it may have been read: ignored, no misuse */
    expect_reg(0x04, 0x10);
    expect_clean();
}

/* proves: X0-BIT-02, X0-AMB-87 */
static void test_reserved_bits_store_and_are_misuse(void)
{
    static const struct {
        int reg, bits, base;
        const char *id;
    } c[] = {
        {0x04, 0x04, 0x10, "X0-REG-04"}, {0x05, 0x04, 0x00, "X0-REG-05"}, {0x05, 0x08, 0x00, "X0-REG-05"},
        {0x05, 0x10, 0x00, "X0-REG-05"}, {0x06, 0x20, 0x00, "X0-REG-06"}, {0x08, 0x01, 0x00, "X0-REG-08"},
        {0x08, 0x02, 0x00, "X0-REG-08"}, {0x08, 0x04, 0x00, "X0-REG-08"}, {0x08, 0x08, 0x00, "X0-REG-08"}};
    rig_boot("bq7692000");
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        TEST_ASSERT_TRUE(rig_write(c[i].reg, c[i].base | c[i].bits));
        expect_reg(c[i].reg, c[i].base | c[i].bits);
        expect_misuse(c[i].id);
        TEST_ASSERT_TRUE(rig_write(c[i].reg, c[i].base));
        expect_reg(c[i].reg, c[i].base);
        expect_clean();
    }
    TEST_ASSERT_TRUE(rig_write(0x00, 0x40)); /* SYS_STAT b6 always reads 0 */
    expect_stat(0x00);
    expect_misuse("X0-REG-00");
}

static void ignores_writes(const rig_part *p)
{
    static const int read_only[] = {0x50, 0x51, 0x59};
    uint8_t before[40], after[40];
    rig_boot(p->name);
    rig_block_read(0x0c, before, 40);
    for (int reg = 0x0c; reg <= 0x33; reg++) {
        TEST_ASSERT_TRUE(rig_write(reg, 0xa5));
        TEST_ASSERT_EQUAL(reg + 1, chip.i2c.pointer);
        expect_misuse("X0-AMB-86");
    }
    rig_block_read(0x0c, after, 40);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(before, after, 40);
    for (int i = 0; i < 3; i++) {
        int old = rig_read(read_only[i]);
        TEST_ASSERT_TRUE(rig_write(read_only[i], 0xa5));
        TEST_ASSERT_EQUAL(read_only[i] + 1, chip.i2c.pointer);
        expect_reg(read_only[i], old);
        expect_misuse("X0-AMB-86");
    }
}

/* proves: X0-BIT-15, X0-AMB-86 */
static void test_read_only_registers_ignore_writes(void)
{
    rig_each(ignores_writes);
}

static void has_nothing_elsewhere(const rig_part *p)
{
    rig_boot(p->name);
    for (int reg = 0x34; reg < 0x100; reg++) {
        if (reg == 0x50 || reg == 0x51 || reg == 0x59) {
            continue;
        }
        expect_reg(reg, 0x00);
        TEST_ASSERT_TRUE(rig_write(reg, 0xff));
        expect_misuse("X0-AMB-84");
        expect_reg(reg, 0x00);
    }
}

/* proves: X0-AMB-84 */
static void test_undescribed_addresses_read_0(void)
{
    uint8_t four[4];
    rig_each(has_nothing_elsewhere);
    rig_boot("bq7694003");
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    rig_block_read(0xfe, four, 4); /* FE, FF, 00, 01 */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x00, 0x00, 0x00, 0x15}), four, 4);
}

static void takes_blocks(const rig_part *p)
{
    static const uint8_t config[6] = {0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19};
    uint8_t back[6];
    rig_boot(p->name);
    TEST_ASSERT_TRUE(rig_block_write(0x06, config, 6));
    rig_block_read(0x06, back, 6);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(config, back, 6);
    for (int i = 0; i < 6; i++) {
        expect_reg(0x06 + i, config[i]);
    }
    expect_clean();
}

/* proves: X0-BIT-16, X0-I2C-06, X0-I2C-10 */
static void test_configuration_as_one_block(void)
{
    rig_each(takes_blocks);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_control_registers);
    RUN_TEST(test_measurement_registers);
    RUN_TEST(test_trim_registers);
    RUN_TEST(test_bits_that_are_not_implemented);
    RUN_TEST(test_reserved_bits_store_and_are_misuse);
    RUN_TEST(test_read_only_registers_ignore_writes);
    RUN_TEST(test_undescribed_addresses_read_0);
    RUN_TEST(test_configuration_as_one_block);
    return UNITY_END();
}
