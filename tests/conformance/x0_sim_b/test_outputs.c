/* SPDX-License-Identifier: Apache-2.0 */
/* FET drivers, load detection, balancing switches. */
#include "rig.h"
#include <math.h>

#define CHG 0x01
#define DSG 0x02

static void follows_its_bits(const rig_part *p)
{
    rig_boot(p->name);
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    for (int bits = 0; bits < 4; bits++) {
        TEST_ASSERT_TRUE(rig_write(0x05, bits));
        TEST_ASSERT_EQUAL((bits & CHG) != 0, sim_x0_chg(&chip));
        TEST_ASSERT_EQUAL((bits & DSG) != 0, sim_x0_dsg(&chip));
        expect_reg(0x05, bits);
    }
    expect_clean();
}

/* proves: X0-FET-01, X0-FET-17, X0-AMB-56 */
static void test_the_pins_follow_the_bits(void)
{
    rig_each(follows_its_bits);
}

/* Brings up one cause each; all of them leave the part in service. */
static void cause(int bit)
{
    switch (bit) {
    case 0x01:
        (void)sim_x0_set_sense(&chip, -0.010);
        rig_wait(8);
        (void)sim_x0_set_sense(&chip, 0.0);
        break;
    case 0x02:
        TEST_ASSERT_TRUE(rig_write(0x07, 0x7f));
        (void)sim_x0_set_sense(&chip, -0.030);
        rig_wait(0.07);
        (void)sim_x0_set_sense(&chip, 0.0);
        break;
    case 0x04:
    case 0x08:
        (void)sim_x0_set_cell(&chip, 1, bit == 0x04 ? 4.5 : 2.0);
        rig_wait(1500);
        (void)sim_x0_set_cell(&chip, 1, 3.6);
        rig_wait(250);
        break;
    case 0x10:
        (void)sim_x0_set_alert_ext(&chip, true);
        (void)sim_x0_set_alert_ext(&chip, false);
        break;
    default:
        TEST_ASSERT_EQUAL(0, sim_x0_strike_xready(&chip));
        break;
    }
    expect_stat(bit);
}

static const struct {
    int bit, off;
} reaction[6] = {{0x04, CHG}, {0x08, DSG}, {0x01, DSG}, {0x02, DSG}, {0x10, CHG | DSG}, {0x20, CHG | DSG}};

static void reacts(const rig_part *p)
{
    for (int i = 0; i < 6; i++) {
        rig_boot(p->name);
        TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
        cause(reaction[i].bit);
        expect_reg(0x05, (CHG | DSG) & ~reaction[i].off);
        TEST_ASSERT_EQUAL((reaction[i].off & CHG) == 0, sim_x0_chg(&chip));
        TEST_ASSERT_EQUAL((reaction[i].off & DSG) == 0, sim_x0_dsg(&chip));
    }
}

/* proves: X0-FET-03, X0-FET-04, X0-FET-05, X0-FET-06, X0-FET-07, X0-FET-08, X0-FET-12, X0-AMB-104 */
static void test_every_event_of_the_table(void)
{
    rig_each(reacts);
}

/* proves: X0-FET-10, X0-FET-11, X0-FET-02, X0-AMB-50 */
static void test_a_set_bit_holds_its_fet(void)
{
    sim_x0_options sticks = {.amb50_write_sticks = true};
    for (int i = 0; i < 6; i++) {
        for (int other = 0; other < 2; other++) {
            rig_boot_with("bq7693003", other ? &sticks : NULL);
            TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
            TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
            cause(reaction[i].bit);
            TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
            expect_reg(0x05, other ? 0x43 : 0x43 & ~reaction[i].off); /* the rest takes effect */
            TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
            rig_clear();
            expect_stat(0x00);
            rig_wait(1000);
            expect_reg(0x05, 0x00); /* nothing turns on by itself */
            TEST_ASSERT_TRUE(rig_write(0x05, 0x03));
            expect_reg(0x05, 0x03);
        }
    }
}

/* proves: X0-AMB-50 */
static void test_a_fet_that_sticks_stays_on_while_the_fault_lasts(void)
{
    sim_x0_options sticks = {.amb50_write_sticks = true};
    rig_boot_with("bq7693003", &sticks);
    (void)sim_x0_set_cell(&chip, 1, 4.5);
    rig_wait(2000);
    expect_stat(0x04);
    TEST_ASSERT_TRUE(rig_write(0x05, CHG));
    rig_wait(5000); /* the reaction belongs to the moment the bit becomes 1 */
    expect_reg(0x05, CHG);
}

/* proves: X0-FET-09, X0-MODE-12 */
static void test_ship_turns_both_off(void)
{
    rig_boot("bq7693003");
    TEST_ASSERT_TRUE(rig_write(0x05, CHG | DSG));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11) && rig_write(0x04, 0x12));
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(1000);
    TEST_ASSERT_FALSE(sim_x0_chg(&chip) || sim_x0_dsg(&chip));
    expect_reg(0x05, 0x00);
}

static void detects_a_load(const rig_part *p)
{
    rig_boot(p->name);
    for (int fets = 0; fets < 4; fets++) {
        TEST_ASSERT_TRUE(rig_write(0x05, fets));
        for (int tenths = 0; tenths <= 100; tenths++) {
            int load = (fets & CHG) == 0 && tenths > 7;
            (void)sim_x0_set_chgpin(&chip, tenths / 10.0);
            expect_reg(0x04, load ? 0x90 : 0x10); /* at once, both ways */
        }
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    }
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    (void)sim_x0_set_chgpin(&chip, 0.699);
    expect_reg(0x04, 0x10);
    (void)sim_x0_set_chgpin(&chip, 0.701);
    expect_reg(0x04, 0x90);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10)); /* read-only */
    expect_reg(0x04, 0x90);
    rig_wait(5000);
    expect_reg(0x04, 0x90);
    (void)sim_x0_set_chgpin(&chip, 0.0);
    expect_reg(0x04, 0x10);
}

/* proves: X0-LOAD-01, X0-LOAD-02, X0-LOAD-06, X0-BIT-10, X0-AMB-57 */
static void test_load_detection(void)
{
    rig_each(detects_a_load);
}

static void balances(const rig_part *p)
{
    rig_boot(p->name);
    for (int input = 1; input <= p->inputs; input++) {
        int reg = 1 + (input - 1) / 5, bit = 1 << (input - 1) % 5;
        TEST_ASSERT_TRUE(rig_write(reg, bit));
        expect_reg(reg, bit);
        TEST_ASSERT_EQUAL_HEX16(1 << (input - 1), sim_x0_cb(&chip));
        TEST_ASSERT_TRUE(rig_write(reg, 0));
    }
    expect_clean();
}

/* proves: X0-CB-01, X0-CB-02, X0-PIN-04 */
static void test_each_bit_is_the_switch_of_its_input(void)
{
    rig_each(balances);
}

/* proves: X0-CB-03, X0-AMB-63 */
static void test_what_clears_the_balancing_bits(void)
{
    sim_x0_options faults_clear = {.amb63_faults_clear_cb = true};
    for (int other = 0; other < 2; other++) {
        for (int i = 0; i < 6; i++) {
            bool kept = !other && reaction[i].bit != 0x20;
            rig_boot_with("bq7694003", other ? &faults_clear : NULL);
            TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&chip));
            TEST_ASSERT_TRUE(rig_block_write(0x01, (uint8_t[]){0x15, 0x0a, 0x15}, 3));
            cause(reaction[i].bit);
            TEST_ASSERT_EQUAL_HEX16(kept ? 0x15 << 10 | 0x0a << 5 | 0x15 : 0, sim_x0_cb(&chip));
        }
    }
    rig_boot("bq7694003"); /* nor do the converter off, a result of the counter or an hour */
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19) && rig_write(0x05, 0x40) && rig_write(0x04, 0x00));
    TEST_ASSERT_TRUE(rig_block_write(0x01, (uint8_t[]){0x15, 0x0a, 0x15}, 3));
    rig_wait(3600000);
    expect_reg(0x01, 0x15);
    expect_reg(0x02, 0x0a);
    expect_reg(0x03, 0x15);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x01) && rig_write(0x04, 0x02));
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(20);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&chip));
}

/* Per mask of the CELLBAL register: every value, against what is legal for the cells in use. */
static void judges(unsigned mask, int legal_count)
{
    int legal = 0;
    rig_pulse("bq7692000");
    for (unsigned i = 0; i < 5; i++) {
        (void)sim_x0_set_cell(&chip, (int)i + 1, (mask >> i & 1u) != 0 ? 3.6 : 0.0);
    }
    rig_at(260);
    for (unsigned value = 0; value < 32; value++) {
        bool adjacent = false, shorted = (value & ~mask) != 0, below = false;
        for (unsigned i = 0; i < 5; i++) {
            bool on = (value >> i & 1u) != 0;
            if ((mask >> i & 1u) != 0) {
                adjacent = adjacent || (on && below);
                below = on;
            }
        }
        sim_misuse_clear(sim_x0_misuse(&chip));
        TEST_ASSERT_TRUE(rig_write(0x01, (int)value));
        expect_reg(0x01, (int)value); /* stored as written all the same */
        if (!shorted) {
            TEST_ASSERT_EQUAL(adjacent, sim_misuse_of(sim_x0_misuse(&chip), "X0-CB-04") > 0);
        }
        TEST_ASSERT_EQUAL(shorted, sim_misuse_of(sim_x0_misuse(&chip), "X0-CB-06") > 0);
        legal += sim_x0_misuse(&chip)->count == 0;
    }
    TEST_ASSERT_EQUAL(legal_count, legal);
}

/* proves: X0-CB-04, X0-CB-05, X0-AMB-61, X0-AMB-62 */
static void test_adjacency_is_judged_on_cells_in_use(void)
{
    judges(0x13, 5); /* as many as the CELL rows list */
    judges(0x17, 8);
    judges(0x1f, 13);
    rig_boot("bq7694003"); /* neighbours across a group border are allowed */
    TEST_ASSERT_TRUE(rig_block_write(0x01, (uint8_t[]){0x10, 0x11, 0x01}, 3));
    expect_clean();
    for (int group = 0; group < 3; group++) {
        for (int low = 0; low < 4; low++) {
            TEST_ASSERT_TRUE(rig_write(1 + group, 3 << low));
            expect_reg(1 + group, 3 << low);
            expect_misuse("X0-CB-04");
            TEST_ASSERT_TRUE(rig_write(1 + group, 0));
            expect_clean();
        }
    }
}

/* proves: X0-SCH-04, X0-CB-07, X0-TIM-03, X0-AMB-60, X0-AMB-101 */
static void test_the_switches_open_while_the_group_is_measured(void)
{
    for (int adc = 0; adc < 2; adc++) {
        int on = 0, edges = 0;
        bool last = true;
        rig_boot("bq7692000");
        TEST_ASSERT_TRUE(rig_write(0x04, adc ? 0x10 : 0x00));
        rig_at(510);
        TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
        TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb_conducting(&chip)); /* acts at once */
        for (int us = 0; us < 2500000; us += 500) {                 /* ten intervals */
            bool now = sim_x0_cb_conducting(&chip) != 0;
            TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb(&chip));
            on += now;
            edges += now != last;
            last = now;
            sim_x0_advance(&chip, 500 * US);
        }
        TEST_ASSERT_EQUAL(5000 * 175 / 250, on); /* 70 % */
        TEST_ASSERT_INT_WITHIN(1, 20, edges);
    }
    rig_boot("bq7692000");
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    rig_at(510 + 174.9);
    TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb_conducting(&chip));
    rig_at(510 + 175); /* 12.5 ms to relax and five times 12.5 ms to convert */
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb_conducting(&chip));
    rig_at(760);
    TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb_conducting(&chip));
    TEST_ASSERT_EQUAL(9424, rig_read16(0x0c)); /* undisturbed */
}

/* Root mean square of the noise of an input over 400 scans, in microvolts. */
static double noise_of(int input)
{
    double sum = 0;
    for (int n = 0; n < 400; n++) {
        double uv;
        rig_wait(250);
        uv = rig_read16(0x0a + 2 * input) * 382.0 - 3.6e6;
        sum += uv * uv;
    }
    return sqrt(sum / 400);
}

/* proves: X0-SCH-02, X0-SCH-03, X0-SCH-05, X0-TIM-02, X0-AMB-59 */
static void test_a_balancing_group_is_converted_in_short_windows(void)
{
    sim_x0_options noisy = {.seed = 7, .noise_uv_rms = 5000};
    for (int balancing = 0; balancing < 4; balancing++) {
        rig_boot_with("bq7694000", &noisy);
        if (balancing > 0) {
            TEST_ASSERT_TRUE(rig_write(balancing, 0x10));
        }
        rig_wait(250);
        for (int input = 1; input <= 15; input += 2) { /* all five of the group, no other group */
            bool quick = balancing > 0 && (input - 1) / 5 == balancing - 1;
            TEST_ASSERT_DOUBLE_WITHIN(1500, quick ? 10000 : 5000, noise_of(input));
        }
    }
}

/* proves: X0-AMB-101 */
static void test_the_short_window_begins_with_the_next_scan(void)
{
    sim_x0_options noisy = {.seed = 3, .noise_uv_rms = 5000};
    int plain[3], changed[3];
    for (int round = 0; round < 2; round++) {
        rig_boot_with("bq7692000", &noisy); /* the same noise both times */
        rig_wait(10);
        TEST_ASSERT_TRUE(rig_write(0x01, round == 0 ? 0x00 : 0x01));
        for (int n = 0; n < 3; n++) {
            rig_at(510 + 250 * n);
            (round == 0 ? plain : changed)[n] = rig_read16(0x0c);
        }
    }
    TEST_ASSERT_EQUAL(plain[0], changed[0]);
    TEST_ASSERT_NOT_EQUAL(plain[1], changed[1]);
    TEST_ASSERT_INT_WITHIN(1, 2 * (plain[1] - 9424), changed[1] - 9424);
    TEST_ASSERT_INT_WITHIN(1, 2 * (plain[2] - 9424), changed[2] - 9424);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_pins_follow_the_bits);
    RUN_TEST(test_every_event_of_the_table);
    RUN_TEST(test_a_set_bit_holds_its_fet);
    RUN_TEST(test_a_fet_that_sticks_stays_on_while_the_fault_lasts);
    RUN_TEST(test_ship_turns_both_off);
    RUN_TEST(test_load_detection);
    RUN_TEST(test_each_bit_is_the_switch_of_its_input);
    RUN_TEST(test_what_clears_the_balancing_bits);
    RUN_TEST(test_adjacency_is_judged_on_cells_in_use);
    RUN_TEST(test_the_switches_open_while_the_group_is_measured);
    RUN_TEST(test_a_balancing_group_is_converted_in_short_windows);
    RUN_TEST(test_the_short_window_begins_with_the_next_scan);
    return UNITY_END();
}
