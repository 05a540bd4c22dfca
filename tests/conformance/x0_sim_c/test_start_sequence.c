/* SPDX-License-Identifier: Apache-2.0 */
/* X0-SEQ-01..20: bring-up by a host that knows nothing but the rows. */
#include "rig.h"

static void tail(const rig_part *p)
{
    rig_wait(12); /* after the END of the pulse */
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    expect_reg(0x05, 0x00);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    expect_reg(0x0b, 0x19);
    rig_at(p->inputs == 5 ? 290 : p->inputs == 10 ? 455 : 895);
    for (int i = 0; i < p->inputs; i++) {
        TEST_ASSERT_EQUAL_HEX16(9424, rig_read16(0x0c + 2 * i));
    }
    expect_clean();
}

static void boots_by_the_rows(const rig_part *p)
{
    rig_ship(p->name);
    rig_wait(2.5); /* the pulse rises at 0 and ends now */
    TEST_ASSERT_EQUAL(0, sim_x0_boot_ended(&chip, 0));
    TEST_ASSERT_TRUE(rig_answers(p->address)); /* polling is allowed */
    tail(p);
}

static void too_early(const rig_part *p)
{
    rig_pulse(p->name);
    rig_at(5);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    expect_misuse("X0-MODE-09");
    rig_at(12);
    expect_reg(0x0b, 0x00); /* lost */
    (void)rig_read16(0x0c);
    expect_misuse("X0-ADC-14");
}

static void no_device(const rig_part *p)
{
    rig_ship(p->name);
    for (int attempt = 0; attempt < 3; attempt++) {
        (void)sim_x0_boot(&chip, 1 * MS); /* too short */
        rig_wait(50);
        TEST_ASSERT_FALSE(rig_answers(p->address));
    }
    (void)sim_x0_set_supply(&chip, false);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(50);
    TEST_ASSERT_FALSE(rig_answers(p->address));
}

/* proves: X0-SEQ-01, X0-SEQ-02, X0-SEQ-03, X0-SEQ-04, X0-AMB-34 */
static void test_boot(void)
{
    rig_each(boots_by_the_rows);
    rig_each(too_early);
    rig_each(no_device);
    rig_ship("bq7692000"); /* a pulse far too long has no consequence here */
    rig_wait(500);
    (void)sim_x0_boot_ended(&chip, 0);
    rig_wait(1);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
    expect_clean();
}

/* One byte of SYS_STAT: what a probe costs. */
static bool probe(int address)
{
    bool ack;
    sim_x0_i2c_start(&chip);
    ack = sim_x0_i2c_write(&chip, (uint8_t)(2 * address));
    if (ack) {
        (void)sim_x0_i2c_write(&chip, 0x00);
        sim_x0_i2c_start(&chip);
        (void)sim_x0_i2c_write(&chip, (uint8_t)(2 * address + 1));
        (void)sim_x0_i2c_read(&chip, false);
    }
    sim_x0_i2c_stop(&chip);
    return ack;
}

/* Four bytes as they come, without knowing whether two of them are CRCs. */
static void four(const rig_part *p, int reg, uint8_t got[4])
{
    sim_x0_i2c_start(&chip);
    (void)sim_x0_i2c_write(&chip, (uint8_t)(2 * p->address));
    (void)sim_x0_i2c_write(&chip, (uint8_t)reg);
    sim_x0_i2c_start(&chip);
    (void)sim_x0_i2c_write(&chip, (uint8_t)(2 * p->address + 1));
    for (int i = 0; i < 4; i++) {
        got[i] = sim_x0_i2c_read(&chip, i < 3);
    }
    sim_x0_i2c_stop(&chip);
}

static bool looks_like_crc(const rig_part *p, int reg)
{
    uint8_t got[4], head[2] = {(uint8_t)(2 * p->address + 1), 0};
    four(p, reg, got);
    head[1] = got[0];
    return got[1] == rig_crc(head, 2) && got[3] == rig_crc(&got[2], 1);
}

static bool raw_write(const rig_part *p, int reg, const uint8_t *bytes, int n)
{
    bool ok;
    sim_x0_i2c_start(&chip);
    ok = sim_x0_i2c_write(&chip, (uint8_t)(2 * p->address)) && sim_x0_i2c_write(&chip, (uint8_t)reg);
    for (int i = 0; i < n && ok; i++) {
        ok = sim_x0_i2c_write(&chip, bytes[i]);
    }
    sim_x0_i2c_stop(&chip);
    return ok;
}

static void identify(const rig_part *p)
{
    uint8_t frame[3] = {(uint8_t)(2 * p->address), 0x0b, 0x19}, data[2] = {0x19, 0};
    rig_boot(p->name);
    (void)sim_x0_strike_xready(&chip);
    TEST_ASSERT_EQUAL(p->address == 0x08, probe(0x08));
    TEST_ASSERT_EQUAL(p->address == 0x18, probe(0x18));
    expect_stat(0x20); /* no side effect */
    TEST_ASSERT_EQUAL(p->crc, looks_like_crc(p, 0x09) && looks_like_crc(p, 0x50));
    expect_clean();
    data[1] = rig_crc(frame, 3); /* and by a write: with CRC it holds on either kind */
    TEST_ASSERT_TRUE(raw_write(p, 0x0b, data, 2));
    expect_reg(0x0b, 0x19);
    if (!p->crc) {
        expect_misuse("X0-AMB-86"); /* the surplus byte, which X0-SEQ-09 accepts */
    } else {
        data[0] = 0x00;
        (void)raw_write(p, 0x0b, data, 1); /* without CRC it does not hold */
        expect_reg(0x0b, 0x19);
    }
}

/* proves: X0-SEQ-07, X0-SEQ-08, X0-SEQ-09, X0-SEQ-10 */
static void test_identification(void)
{
    rig_each(identify);
}

/* proves: X0-SEQ-11, X0-AMB-12, X0-AMB-07 */
static void test_trim(void)
{
    for (int gain = 365; gain <= 396; gain++) {
        int offset = -128 + 255 * (gain - 365) / 31, g, code;
        rig_pulse("bq7693003");
        (void)sim_x0_set_gain(&chip, gain);
        (void)sim_x0_set_offset(&chip, offset);
        rig_at(410);
        g = 365 + ((rig_read(0x50) & 0x0c) << 1) + ((rig_read(0x59) & 0xe0) >> 5);
        TEST_ASSERT_EQUAL(gain, g);
        TEST_ASSERT_EQUAL(offset, (int8_t)rig_read(0x51));
        TEST_ASSERT_EQUAL_HEX8(rig_read(0x50), rig_read(0x50));
        code = rig_read16(0x0c); /* GAIN and OFFSET are needed, the text on "no correction" notwithstanding */
        TEST_ASSERT_INT_WITHIN(gain / 2 + 1, 3600000, code * gain + offset * 1000);
        TEST_ASSERT_INT_WITHIN(1, 3141, rig_read16(0x2c)); /* die sensor, 1.2 V: 382 uV whatever GAIN is */
    }
}

/* proves: X0-SEQ-12, X0-AMB-94, X0-VAR-23 */
static void test_size_and_shorts(void)
{
    rig_pulse("bq7694003");
    for (int i = 1; i <= 15; i++) {
        (void)sim_x0_set_cell(&chip, i, i == 3 || i == 4 ? 0.0 : i == 11 ? 2.4 : 3.3);
    }
    rig_at(810);
    for (int i = 1; i <= 15; i++) {
        int code = rig_read16(0x0a + 2 * i);
        TEST_ASSERT_EQUAL(i != 3 && i != 4, code >= 0x0518);
        TEST_ASSERT_INT_WITHIN(200, i == 3 || i == 4 ? 0 : i == 11 ? 2400000 : 3300000, code * 382);
    }
    expect_clean();
    rig_boot("bq7692003"); /* configured larger than it is: zeros above */
    for (int i = 6; i <= 15; i++) {
        TEST_ASSERT_EQUAL(0, rig_read16(0x0a + 2 * i));
    }
}

static void configure(const rig_part *p)
{
    static const uint8_t wanted[6] = {0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19};
    static const uint8_t mask[6] = {0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f}, off[3] = {0, 0, 0};
    uint8_t back[6];
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    TEST_ASSERT_TRUE(rig_block_write(0x01, off, p->inputs / 5));
    TEST_ASSERT_TRUE(rig_block_write(0x06, wanted, 6));
    rig_block_read(0x06, back, 6);
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_HEX8(wanted[i] & mask[i], back[i] & mask[i]);
    }
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    TEST_ASSERT_EQUAL_HEX8(0x18, rig_read(0x04) & 0x1f);
    rig_clear();
    expect_stat(0x00);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
    expect_reg(0x05, 0x40);
}

static void configured(const rig_part *p)
{
    rig_boot(p->name);
    (void)sim_x0_set_sense(&chip, -0.030); /* beyond the reset values, within the wanted ones */
    rig_wait(20);
    TEST_ASSERT_TRUE((rig_read(0x00) & 0x03) != 0); /* a bit from before (X0-OCD-10) */
    configure(p);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43)); /* a separate write, verified */
    rig_wait(400);
    expect_reg(0x05, 0x43);
    TEST_ASSERT_TRUE(sim_x0_chg(&chip) && sim_x0_dsg(&chip));
    expect_clean();
    rig_boot(p->name); /* the other order: FETs before limits */
    (void)sim_x0_set_sense(&chip, -0.030);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
    rig_wait(20);
    TEST_ASSERT_FALSE(sim_x0_dsg(&chip));
}

/* proves: X0-SEQ-05, X0-SEQ-13, X0-SEQ-14, X0-SEQ-15, X0-SEQ-16, X0-SEQ-17, X0-SEQ-18, X0-SEQ-19 */
static void test_configuration(void)
{
    rig_each(configured);
}

static void warm(const rig_part *p)
{
    rig_boot(p->name);
    configure(p);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    TEST_ASSERT_TRUE(rig_write(0x01, 0x05));
    rig_wait(60000); /* the host is gone; the part goes on by itself */
    TEST_ASSERT_TRUE(rig_answers(p->address));
    TEST_ASSERT_TRUE(sim_x0_chg(&chip) && sim_x0_dsg(&chip));
    expect_reg(0x05, 0x43);
    expect_reg(0x01, 0x05);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00)); /* drop */
    TEST_ASSERT_TRUE(rig_write(0x01, 0x00));
    configure(p);
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    (void)sim_x0_set_supply(&chip, false);
    (void)sim_x0_set_supply(&chip, true);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(10);
    expect_reg(0x04, 0x10); /* what a scrub sees after a reset */
    expect_reg(0x0b, 0x00);
    expect_reg(0x09, 0xac);
    expect_reg(0x0a, 0x97);
    expect_reg(0x05, 0x00);
    expect_clean();
}

/* proves: X0-SEQ-06, X0-SEQ-20 */
static void test_warm_start_and_reset(void)
{
    rig_each(warm);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_boot);
    RUN_TEST(test_identification);
    RUN_TEST(test_trim);
    RUN_TEST(test_size_and_shorts);
    RUN_TEST(test_configuration);
    RUN_TEST(test_warm_start_and_reset);
    return UNITY_END();
}
