/* SPDX-License-Identifier: Apache-2.0 */
/* X0-SEQ-21..27 and 38..46: measuring, counting, balancing and temperatures by a host of the rows. */
#include "rig.h"
#include <math.h>
#include <stdlib.h>

static void ready(const char *name)
{
    rig_boot(name);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    TEST_ASSERT_TRUE(rig_write(0x07, 0x7f)); /* nothing here is about overcurrent */
    TEST_ASSERT_TRUE(rig_write(0x06, 0x9f));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x40));
}

static int16_t fetch(void)
{
    int16_t code = (int16_t)rig_read16(0x32);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
    return code;
}

static void wait_for_alert(void)
{
    for (int i = 0; i < 700 && !sim_x0_alert(&chip); i++) {
        rig_wait(1);
    }
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
}

static void cycles(const rig_part *p)
{
    long sum = 0;
    ready(p->name);
    for (int n = 0; n < 20; n++) {
        uint8_t block[40];
        unsigned total = 0;
        (void)sim_x0_set_sense(&chip, (n - 10) * 1e-3);
        wait_for_alert();
        expect_stat(0x80);
        rig_block_read(0x0c, block, 40);
        for (int i = 0; i < p->inputs; i++) {
            TEST_ASSERT_EQUAL(9424, (block[2 * i] & 0x3f) << 8 | block[2 * i + 1]);
            total += 9424;
        }
        TEST_ASSERT_INT_WITHIN(1, (int)(total / 4), block[30] << 8 | block[31]); /* X0-BAT-05 */
        sum += fetch();
        expect_stat(0x00);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
    }
    TEST_ASSERT_EQUAL(0, chip.lost_cc);
    TEST_ASSERT_INT_WITHIN(130, -1185, (int)sum); /* -10 mV of 20 windows, give or take the one at a step */
    expect_clean();
}

/* proves: X0-SEQ-21, X0-SEQ-22, X0-SEQ-23, X0-SEQ-25, X0-SEQ-26, X0-ADC-16, X0-SEQ-45 */
static void test_the_cycle(void)
{
    rig_each(cycles);
    ready("bq7692003"); /* clear first, fetch second: a result that comes in between is cleared unseen */
    rig_wait(250);
    expect_stat(0x80);
    rig_wait(249);
    (void)rig_read16(0x32);
    rig_wait(2); /* the next result */
    TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
    expect_stat(0x00);
    TEST_ASSERT_EQUAL(1, chip.lost_cc);
}

/* proves: X0-SEQ-23 */
static void test_a_dead_cell(void)
{
    ready("bq7694003");
    (void)sim_x0_set_cell(&chip, 7, 0.2);
    rig_wait(30000);
    TEST_ASSERT_TRUE(rig_read16(0x18) < 0x0518);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(0x00) & 0x3f); /* the part says nothing: the host has to look */
}

/* proves: X0-SEQ-24, X0-SEQ-37 */
static void test_an_event_during_the_cycle_keeps_alert_high(void)
{
    ready("bq7693000");
    wait_for_alert();
    expect_stat(0x80);
    (void)sim_x0_strike_xready(&chip);
    (void)fetch();
    TEST_ASSERT_TRUE(sim_x0_alert(&chip)); /* no edge, but a level */
    expect_stat(0x20);
    expect_clean();
}

/* proves: X0-SEQ-25 */
static void test_a_part_that_was_reset_gives_no_results(void)
{
    ready("bq7693003");
    (void)sim_x0_set_supply(&chip, false);
    (void)sim_x0_set_supply(&chip, true);
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(610);
    expect_stat(0x00);
}

/* proves: X0-SEQ-27 */
static void test_without_the_counter(void)
{
    rig_boot("bq7694006");
    for (int n = 0; n < 40; n++) {
        (void)sim_x0_set_cell(&chip, 15, 3.0 + 0.01 * n);
        rig_wait(250);
        TEST_ASSERT_FALSE(sim_x0_alert(&chip));
        TEST_ASSERT_INT_WITHIN(1, (int)((3.0 + 0.01 * n) / 382e-6 + 0.5), rig_read16(0x28));
    }
    (void)sim_x0_set_alert_ext(&chip, true);
    expect_stat(0x10); /* never masked */
    expect_clean();
}

/* proves: X0-SEQ-39, X0-SEQ-40, X0-SEQ-41, X0-SEQ-42 */
static void test_balancing(void)
{
    static const uint8_t one[3] = {0x15, 0x0a, 0x15}, two[3] = {0x0a, 0x15, 0x0a}, off[3] = {0, 0, 0};
    ready("bq7694003");
    for (int n = 0; n < 6; n++) {
        uint8_t back[3];
        const uint8_t *set = n & 1 ? two : one;
        TEST_ASSERT_TRUE(rig_block_write(0x01, set, 3));
        rig_block_read(0x01, back, 3);
        TEST_ASSERT_EQUAL_HEX8(set[0], back[0]);
        TEST_ASSERT_EQUAL_HEX8(set[2], back[2]);
        rig_wait(2000);
        TEST_ASSERT_EQUAL(9424, rig_read16(0x0c));
    }
    TEST_ASSERT_TRUE(rig_block_write(0x01, off, 3));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&chip));
    expect_clean();
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    (void)sim_x0_strike_xready(&chip);
    expect_reg(0x01, 0x00); /* never assume they persist */
    expect_clean();
    TEST_ASSERT_TRUE(rig_write(0x01, 0x03));
    expect_misuse("X0-CB-04");
}

/* A host that bleeds what stands out: everything it has to know first is there to be read. */
/* proves: X0-SEQ-38, X0-SEQ-44, X0-AMB-76, X0-SEQ-41 */
static void test_conditions_of_balancing(void)
{
    int code[15], lowest = 16383;
    unsigned want = 0;
    ready("bq7694003");
    for (int i = 0; i < 15; i++) {
        (void)sim_x0_set_cell(&chip, i + 1, i % 4 == 1 ? 3.68 : 3.6);
    }
    (void)sim_x0_set_tdie(&chip, 140); /* nothing of its own happens here, the host has to act */
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_wait(2250);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_read(0x00) & 0x3f);
    TEST_ASSERT_EQUAL_HEX8(0x18, rig_read(0x04) & 0x1f);
    for (int i = 0; i < 15; i++) {
        code[i] = rig_read16(0x0c + 2 * i);
        lowest = code[i] < lowest ? code[i] : lowest;
    }
    for (int i = 0; i < 15; i++) {
        want |= code[i] - lowest > 131 ? 1u << i : 0u; /* 50 mV */
    }
    TEST_ASSERT_EQUAL_HEX16(0x2222, want);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10)); /* the die, 2.25 s each way */
    rig_wait(2250);
    TEST_ASSERT_INT_WITHIN(1, 1877, rig_read16(0x2c)); /* 0.717 V: 140 degC, too hot */
    (void)sim_x0_set_tdie(&chip, 60);
    rig_wait(2250);
    TEST_ASSERT_INT_WITHIN(1, 2757, rig_read16(0x2c));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    for (int g = 0; g < 3; g++) {
        TEST_ASSERT_TRUE(rig_write(0x01 + g, (int)(want >> (5 * g) & 0x1fu)));
    }
    TEST_ASSERT_EQUAL_HEX16(0x2222, sim_x0_cb(&chip));
    rig_wait(2250);
    TEST_ASSERT_INT_WITHIN(1, 4319, rig_read16(0x2c));
    expect_clean();
}

/* proves: X0-SEQ-43 */
static void test_change_of_the_temperature_source(void)
{
    for (int phase = 0; phase < 2000; phase += 190) {
        rig_boot("bq7692003");
        (void)sim_x0_set_tdie(&chip, 45);
        rig_wait(2250 + phase);
        TEST_ASSERT_INT_WITHIN(1, 2922, rig_read16(0x2c)); /* 1.116 V */
        TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
        expect_reg(0x04, 0x18);
        rig_wait(2250);
        TEST_ASSERT_INT_WITHIN(1, 4319, rig_read16(0x2c)); /* 1.65 V */
        TEST_ASSERT_TRUE(rig_write(0x04, 0x10));
        rig_wait(2250);
        TEST_ASSERT_INT_WITHIN(1, 2922, rig_read16(0x2c));
        expect_clean();
    }
}

/* proves: X0-SEQ-45, X0-ADC-16, X0-AMB-20 */
static void test_calibration_is_the_hosts_matter(void)
{
    double sum = 0.0, gain2;
    rig_pulse("bq7692003");
    (void)sim_x0_set_gain(&chip, 371);
    (void)sim_x0_set_offset(&chip, 12);
    rig_at(260);
    for (int i = 0; i < 5; i++) {
        sum += rig_read16(0x0c + 2 * i) * 371e-6 + 12e-3;
    }
    gain2 = 18.0 / sum; /* a perfect divider finds a perfect converter */
    TEST_ASSERT_TRUE(fabs(gain2 - 1.0) < 1e-4);
    TEST_ASSERT_TRUE(rig_write(0x09, 0xbf)); /* thresholds see raw codes, whatever the host makes of them */
    (void)sim_x0_set_cell(&chip, 1, (0x2bf8 + 2) * 371e-6 + 12e-3);
    rig_wait(1500);
    expect_stat(0x04);
    expect_clean();
}

/* proves: X0-SEQ-46 */
static void test_one_shot(void)
{
    rig_boot("bq7693003");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    (void)sim_x0_set_sense(&chip, 0.00844);
    for (int n = 0; n < 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0, rig_read(0x05) & 0x40);
        rig_clear();
        TEST_ASSERT_TRUE(rig_write(0x05, 0x23)); /* FETs as in the shadow */
        rig_wait(260);
        expect_stat(0x80);
        TEST_ASSERT_EQUAL(1000, (int16_t)rig_read16(0x32));
        TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
        expect_reg(0x05, 0x03);
    }
    TEST_ASSERT_TRUE(rig_write(0x05, 0x23));
    rig_wait(100);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00)); /* FETs off in between: allowed, and it ends the measurement */
    rig_wait(600);
    expect_stat(0x00);
    expect_clean();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_cycle);
    RUN_TEST(test_a_dead_cell);
    RUN_TEST(test_an_event_during_the_cycle_keeps_alert_high);
    RUN_TEST(test_a_part_that_was_reset_gives_no_results);
    RUN_TEST(test_without_the_counter);
    RUN_TEST(test_balancing);
    RUN_TEST(test_conditions_of_balancing);
    RUN_TEST(test_change_of_the_temperature_source);
    RUN_TEST(test_calibration_is_the_hosts_matter);
    RUN_TEST(test_one_shot);
    return UNITY_END();
}
