/* SPDX-License-Identifier: Apache-2.0 */
/* ALERT, its override input, the status bits, the internal fault. */
#include "rig.h"

/* Sets every status bit without a lasting cause. */
static void raise_all(void)
{
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    (void)sim_x0_set_alert_ext(&chip, true);
    (void)sim_x0_set_alert_ext(&chip, false);
    (void)sim_x0_strike_xready(&chip);
    (void)sim_x0_set_sense(&chip, -0.030);
    (void)sim_x0_set_cell(&chip, 1, 4.5);
    (void)sim_x0_set_cell(&chip, 2, 2.0);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
    rig_wait(2000);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    (void)sim_x0_set_sense(&chip, 0);
    (void)sim_x0_set_cell(&chip, 1, 3.6);
    (void)sim_x0_set_cell(&chip, 2, 3.6);
    rig_wait(500);
}

static void clears_bit_by_bit(const rig_part *p)
{
    static const int order[7] = {0x08, 0x80, 0x01, 0x20, 0x04, 0x10, 0x02};
    int left = 0xbf;
    rig_boot(p->name);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    raise_all();
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_TRUE(sim_x0_alert(&chip));
        expect_stat(left);
        expect_stat(left); /* reading clears nothing */
        TEST_ASSERT_TRUE(rig_write(0x00, order[i]));
        left &= ~order[i];
        expect_stat(left);
        TEST_ASSERT_EQUAL(left != 0, sim_x0_alert(&chip));
    }
    rig_wait(5000);
    expect_stat(0x00);
    expect_clean();
}

/*
 * proves: X0-ALERT-01, X0-ALERT-02, X0-ALERT-03, X0-AMB-51, X0-AMB-52, X0-BIT-05, X0-BIT-06, X0-BIT-07,
 *     X0-REG-00
 */
static void test_each_bit_holds_alert_until_it_is_cleared(void)
{
    rig_each(clears_bit_by_bit);
}

/* proves: X0-ALERT-01, X0-AMB-51 */
static void test_each_bit_alone_drives_alert(void)
{
    static const int bits[7] = {0x80, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01};
    for (int i = 0; i < 7; i++) {
        rig_boot("bq7692000");
        raise_all();
        (void)rig_read(0x00);
        TEST_ASSERT_TRUE(rig_write(0x00, 0xbf & ~bits[i]));
        expect_stat(bits[i]);
        TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    }
}

/* proves: X0-BIT-05, X0-BIT-07, X0-XRDY-01, X0-BIT-06 */
static void test_the_host_cannot_set_a_status_bit(void)
{
    rig_boot("bq7692000");
    for (int bit = 0; bit < 8; bit++) {
        TEST_ASSERT_TRUE(rig_write(0x00, 1 << bit));
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    }
}

static void is_overridden(const rig_part *p)
{
    rig_boot(p->name);
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
    (void)sim_x0_set_alert_ext(&chip, true);
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    (void)sim_x0_set_alert_ext(&chip, false);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip)); /* the device drives the pin itself now */
    rig_wait(60000);
    expect_stat(0x10);
    expect_reg(0x05, 0x00);
    expect_reg(0x01, 0x15); /* nothing else changes */
    TEST_ASSERT_TRUE(rig_write(0x00, 0x10));
    expect_stat(0x00);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    expect_clean();
}

/* proves: X0-ALERT-04, X0-ALERT-11, X0-BIT-06, X0-AMB-54, X0-AMB-53, X0-FET-07 */
static void test_the_override(void)
{
    rig_each(is_overridden);
}

/* proves: X0-ALERT-05, X0-AMB-53, X0-BIT-06 */
static void test_an_outside_level_is_masked_while_the_device_drives(void)
{
    sim_x0_options edge = {.amb53_edge = true};
    for (int other = 0; other < 2; other++) {
        rig_boot_with("bq7692003", other ? &edge : NULL);
        TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
        (void)sim_x0_set_cell(&chip, 1, 4.5);
        rig_wait(2000);
        (void)sim_x0_set_cell(&chip, 1, 3.6);
        rig_wait(500);
        expect_stat(0x04);
        (void)sim_x0_set_alert_ext(&chip, true);
        expect_stat(0x04);
        TEST_ASSERT_TRUE(sim_x0_dsg(&chip));
        TEST_ASSERT_TRUE(rig_write(0x00, 0x04));
        expect_stat(other ? 0x00 : 0x10); /* noticed if it is still there */
        TEST_ASSERT_EQUAL(other, sim_x0_dsg(&chip));
        TEST_ASSERT_TRUE(sim_x0_alert(&chip)); /* the outside still drives it */
    }
    rig_boot("bq7692003"); /* a level that came and went is lost */
    (void)sim_x0_strike_xready(&chip);
    (void)sim_x0_set_alert_ext(&chip, true);
    (void)sim_x0_set_alert_ext(&chip, false);
    rig_clear();
    expect_stat(0x00);
}

/* proves: X0-ALERT-11, X0-AMB-73, X0-MODE-12 */
static void test_the_pin_in_ship_is_the_outside_level(void)
{
    rig_ship("bq7692003");
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    (void)sim_x0_set_alert_ext(&chip, true);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    (void)sim_x0_set_alert_ext(&chip, false);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(20);
    expect_stat(0x00);
    (void)sim_x0_strike_xready(&chip);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(0x04, 0x12)); /* the SHIP command works meanwhile */
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
}

static void has_an_internal_fault(const rig_part *p)
{
    static const uint8_t config[6] = {0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19};
    uint8_t back[6];
    rig_boot(p->name);
    TEST_ASSERT_TRUE(rig_block_write(0x06, config, 6));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    for (int g = 0; g < p->inputs / 5; g++) {
        TEST_ASSERT_TRUE(rig_write(1 + g, 0x15));
    }
    TEST_ASSERT_EQUAL(0, sim_x0_strike_xready(&chip));
    expect_stat(0x20);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    expect_reg(0x05, 0x40);
    expect_reg(0x04, 0x18);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&chip));
    rig_block_read(0x06, back, 6);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(config, back, 6);
    TEST_ASSERT_TRUE(rig_write(0x09, 0xc0)); /* registers work meanwhile */
    expect_reg(0x09, 0xc0);
    (void)sim_x0_set_cell(&chip, 2, 3.82);
    rig_wait(250);
    TEST_ASSERT_EQUAL(10000, rig_read16(0x0e)); /* and measurements go on */
    expect_stat(0xa0);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_stat(0x80);
    rig_wait(100); /* strikes once: one clear suffices */
    expect_stat(0x80);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
    expect_stat(0x00);
    expect_clean();
}

/* proves: X0-XRDY-01, X0-XRDY-02, X0-XRDY-05, X0-XRDY-06, X0-FET-08, X0-AMB-65, X0-AMB-66, X0-AMB-104,
 * X0-CB-03 */
static void test_the_internal_fault(void)
{
    rig_each(has_an_internal_fault);
    rig_ship("bq7692000");
    TEST_ASSERT_EQUAL(-1, sim_x0_strike_xready(&chip));
}

/* proves: X0-AMB-104 */
static void test_protections_run_during_an_internal_fault(void)
{
    rig_boot("bq7694003");
    (void)sim_x0_strike_xready(&chip);
    (void)sim_x0_set_cell(&chip, 15, 4.5);
    (void)sim_x0_set_sense(&chip, -0.010);
    rig_wait(1500);
    expect_stat(0x25);
}

/* proves: X0-AMB-65, X0-AMB-66 */
static void test_the_internal_fault_in_the_other_readings(void)
{
    sim_x0_options o = {.amb65_config_lost = true, .amb66_upper_zero = true};
    rig_boot_with("bq7694003", &o);
    TEST_ASSERT_TRUE(rig_block_write(0x06, (uint8_t[]){0x8b, 0x5a, 0x50, 0xbf, 0x99, 0x19}, 6));
    (void)sim_x0_strike_xready(&chip);
    {
        static const uint8_t reset[6] = {0, 0, 0, 0xac, 0x97, 0};
        uint8_t back[6];
        rig_block_read(0x06, back, 6);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(reset, back, 6);
    }
    rig_wait(250);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x14));
    TEST_ASSERT_EQUAL(0, rig_read16(0x16));
    TEST_ASSERT_EQUAL(0, rig_read16(0x28));
    rig_clear();
    rig_wait(250);
    TEST_ASSERT_EQUAL(9424, rig_read16(0x28));
}

/* proves: X0-BIT-08, X0-AMB-58 */
static void test_set_wins_over_a_clear_of_the_same_instant(void)
{
    for (int read_first = 0; read_first < 2; read_first++) {
        rig_boot("bq7692003");
        TEST_ASSERT_TRUE(rig_write(0x0b, 0x19) && rig_write(0x05, 0x40));
        rig_wait(250); /* the result comes at this very instant */
        if (read_first != 0) {
            expect_stat(0x80); /* then the clear comes later, however soon */
        }
        TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
        expect_stat(read_first ? 0x00 : 0x80);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_bit_holds_alert_until_it_is_cleared);
    RUN_TEST(test_each_bit_alone_drives_alert);
    RUN_TEST(test_the_host_cannot_set_a_status_bit);
    RUN_TEST(test_the_override);
    RUN_TEST(test_an_outside_level_is_masked_while_the_device_drives);
    RUN_TEST(test_the_pin_in_ship_is_the_outside_level);
    RUN_TEST(test_the_internal_fault);
    RUN_TEST(test_protections_run_during_an_internal_fault);
    RUN_TEST(test_the_internal_fault_in_the_other_readings);
    RUN_TEST(test_set_wins_over_a_clear_of_the_same_instant);
    return UNITY_END();
}
