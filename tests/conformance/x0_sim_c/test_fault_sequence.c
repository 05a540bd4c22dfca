/* SPDX-License-Identifier: Apache-2.0 */
/* X0-SEQ-28..37: fault service and release by a host of the rows; and what becomes of one in a hurry. */
#include "rig.h"

static void on_duty(const char *name)
{
    static const uint8_t limits[6] = {0x8b, 0x5a, 0x00, 0xbf, 0x99, 0x19};
    rig_boot(name);
    TEST_ASSERT_TRUE(rig_block_write(0x06, limits, 6));
    rig_clear();
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
    expect_reg(0x05, 0x03);
}

/* Clears what is read, waits, and demands it stays clear. */
static void release(int bits, double ms)
{
    expect_stat(bits);
    TEST_ASSERT_TRUE(rig_write(0x00, bits));
    rig_wait(ms);
    expect_stat(0x00);
    TEST_ASSERT_EQUAL_HEX8(0, rig_read(0x05) & 0x03 & (bits == 0x04 ? 0x01 : bits == 0x08 ? 0x02 : 0x03));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03)); /* clearing alone turned nothing on */
    expect_reg(0x05, 0x03);
}

static void voltage_fault(int bit, int other, double bad)
{
    on_duty("bq7693000");
    (void)sim_x0_set_cell(&chip, 4, bad);
    rig_wait(1500);
    expect_stat(bit);
    expect_reg(0x05, other); /* the device has turned its FET off; the other may stay on */
    TEST_ASSERT_TRUE(rig_write(0x05, other));
    TEST_ASSERT_TRUE(rig_write(0x00, bit)); /* in a hurry: the cause is still there */
    rig_wait(250);
    expect_stat(bit);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
    expect_reg(0x05, other); /* and the FET is refused */
    (void)sim_x0_set_cell(&chip, 4, 3.6);
    rig_wait(2000);
    release(bit, 1500);
    expect_clean();
}

/* proves: X0-SEQ-28, X0-SEQ-29, X0-SEQ-30, X0-SEQ-31 */
static void test_ov_and_uv(void)
{
    voltage_fault(0x04, 0x02, 4.4);
    voltage_fault(0x08, 0x01, 2.4);
}

static bool load(void)
{
    return (rig_read(0x04) & 0x80) != 0;
}

static void overcurrent(double volts, double ms, int bits)
{
    on_duty("bq7692003");
    (void)sim_x0_set_chgpin(&chip, 3.0);
    (void)sim_x0_set_sense(&chip, volts);
    rig_wait(ms);
    expect_stat(bits);
    expect_reg(0x05, 0x01);
    TEST_ASSERT_FALSE(load()); /* CHG is still on: no detector */
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    TEST_ASSERT_TRUE(load());
    TEST_ASSERT_TRUE(rig_write(0x00, bits)); /* in a hurry, with the current still there */
    rig_wait(400);
    TEST_ASSERT_EQUAL_HEX8(bits, rig_read(0x00) & bits);
    bits = rig_read(0x00);
    (void)sim_x0_set_sense(&chip, 0);
    rig_wait(100);
    for (int n = 0; n < 4; n++) {
        TEST_ASSERT_TRUE(load());
        rig_wait(250);
    }
    (void)sim_x0_set_chgpin(&chip, 0);
    for (int n = 0; n < 4; n++) {
        TEST_ASSERT_FALSE(load());
        rig_wait(250);
    }
    release(bits, 420);
    expect_clean();
}

/* proves: X0-SEQ-32, X0-SEQ-33 */
static void test_ocd_and_scd(void)
{
    overcurrent(-0.090, 330, 0x01);
    overcurrent(-0.150, 0.2, 0x02);
    overcurrent(-0.150, 330, 0x03);
}

/* proves: X0-SEQ-34 */
static void test_override(void)
{
    on_duty("bq7694006");
    (void)sim_x0_set_alert_ext(&chip, true);
    expect_stat(0x10);
    expect_reg(0x05, 0x00);
    for (int n = 0; n < 3; n++) {
        rig_wait(5000);
        expect_stat(0x10);
        TEST_ASSERT_TRUE(rig_write(0x00, 0x10));
        expect_stat(0x10); /* the outside still holds it */
    }
    (void)sim_x0_set_alert_ext(&chip, false);
    rig_wait(1000);
    release(0x10, 2000);
    expect_clean();
}

/* proves: X0-SEQ-35, X0-TIM-15 */
static void test_internal_fault(void)
{
    on_duty("bq7694003");
    TEST_ASSERT_TRUE(rig_write(0x02, 0x05));
    (void)sim_x0_strike_xready(&chip);
    expect_reg(0x05, 0x00);
    expect_reg(0x02, 0x00);
    rig_wait(3000); /* a few seconds; it does not go by itself */
    release(0x20, 1000);
    on_duty("bq7694003"); /* and a cause that persists */
    for (int wait = 3; wait <= 12; wait *= 2) {
        (void)sim_x0_strike_xready(&chip);
        rig_wait(1000.0 * wait);
        expect_stat(0x20);
        TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    }
    (void)sim_x0_strike_xready(&chip);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10) && rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(11);
    expect_stat(0x00);
    expect_clean();
}

/* A group without supply is all zero above, with the bus alive; the fault stands again after each clear. */
/* proves: X0-AMB-105, X0-SEQ-35 */
static void test_upper_groups_without_supply(void)
{
    sim_x0_options o;
    memset(&o, 0, sizeof o);
    o.amb66_upper_zero = true;
    rig_boot_with("bq7694003", &o);
    for (int n = 0; n < 3; n++) {
        (void)sim_x0_strike_xready(&chip);
        rig_wait(250);
        TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
        for (int i = 5; i < 15; i++) {
            TEST_ASSERT_EQUAL(0, rig_read16(0x0c + 2 * i));
        }
        expect_stat(0x20);
        TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
        rig_wait(250);
        TEST_ASSERT_EQUAL(9424, rig_read16(0x0c + 28));
    }
}

/* proves: X0-SEQ-36, X0-SEQ-37 */
static void test_several_at_once(void)
{
    on_duty("bq7693003");
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    (void)sim_x0_set_cell(&chip, 1, 4.4);
    rig_wait(1500);
    (void)sim_x0_set_sense(&chip, -0.150);
    rig_wait(0.2);
    (void)sim_x0_set_sense(&chip, 0);
    TEST_ASSERT_EQUAL_HEX8(0x86, rig_read(0x00)); /* CC_READY beside them is no fault and ends none */
    TEST_ASSERT_TRUE(rig_write(0x00, 0x82));
    rig_wait(420);
    TEST_ASSERT_EQUAL_HEX8(0x04, rig_read(0x00) & 0x3f);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    expect_reg(0x05, 0x42); /* OV alone holds CHG now */
    expect_clean();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ov_and_uv);
    RUN_TEST(test_ocd_and_scd);
    RUN_TEST(test_override);
    RUN_TEST(test_internal_fault);
    RUN_TEST(test_upper_groups_without_supply);
    RUN_TEST(test_several_at_once);
    return UNITY_END();
}
