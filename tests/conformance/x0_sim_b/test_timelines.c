/* SPDX-License-Identifier: Apache-2.0 */
/* The printed time lines, t = 0 being the start of the boot pulse, and the price of simulated time. */
#include "rig.h"

#define ALL_ON 0x03

static bool answers(void)
{
    return rig_answers(chip.part->address7);
}

static int vc(int input)
{
    return sim_x0_peek(&chip, (uint8_t)(0x0a + 2 * input)) << 8 |
           sim_x0_peek(&chip, (uint8_t)(0x0b + 2 * input));
}

static int ts1(void)
{
    return sim_x0_peek(&chip, 0x2c) << 8 | sim_x0_peek(&chip, 0x2d);
}

/* proves: X0-NUM-1001, X0-MODE-06, X0-SCH-07 */
static void test_start_of_each_size(void)
{
    static const struct {
        const char *part;
        int first, temperature2;
    } c[] = {{"bq7692000", 260, 2260}, {"bq7693003", 410, 2410}, {"bq7694006", 810, 2810}};
    for (int i = 0; i < 3; i++) {
        rig_pulse(c[i].part);
        rig_at(0.999);
        TEST_ASSERT_FALSE(answers());
        rig_at(1);
        TEST_ASSERT_TRUE(answers());
        TEST_ASSERT_EQUAL(SIM_X0_BOOT, chip.mode);
        rig_at(10);
        TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
        for (int n = 0; n < 4; n++) {
            (void)sim_x0_set_cell(&chip, 1, (7000 + n) * 382e-6);
            rig_at(c[i].first + 250 * n - 1);
            TEST_ASSERT_EQUAL(n == 0 ? 0 : 6999 + n, vc(1));
            rig_at(c[i].first + 250 * n);
            TEST_ASSERT_EQUAL(7000 + n, vc(1));
        }
        TEST_ASSERT_EQUAL_HEX16(0x0c45, ts1());
        (void)sim_x0_set_tdie(&chip, 60);
        rig_at(c[i].temperature2 - 1);
        TEST_ASSERT_EQUAL_HEX16(0x0c45, ts1());
        rig_at(c[i].temperature2);
        TEST_ASSERT_EQUAL_HEX16(0x0ac5, ts1());
    }
}

/* proves: X0-NUM-1002 */
static void test_first_data(void)
{
    rig_pulse("bq7692003");
    rig_at(259);
    TEST_ASSERT_EQUAL_HEX16(0, vc(1));
    TEST_ASSERT_EQUAL_HEX8(0, sim_x0_peek(&chip, 0x2a) | sim_x0_peek(&chip, 0x2b));
    rig_at(260);
    TEST_ASSERT_EQUAL_HEX16(0x24d0, rig_read16(0x0c));
    TEST_ASSERT_EQUAL_HEX16(0x2e04, rig_read16(0x2a));
}

/* proves: X0-NUM-1003 */
static void test_pulse_length(void)
{
    rig_ship("bq7692003");
    (void)sim_x0_boot(&chip, 1900 * US);
    rig_at(100);
    TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    (void)sim_x0_boot(&chip, 2000 * US);
    rig_at(110);
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, chip.mode);
}

static void fets_at(double ms, int on)
{
    rig_at(ms);
    TEST_ASSERT_TRUE(rig_write(0x05, on));
}

/* SYS_STAT 0 at `before`, `stat` and SYS_CTRL2 `ctrl2` at `at`. */
static void changes(double before, double at, int stat, int ctrl2)
{
    rig_at(before);
    expect_stat(0x00);
    rig_at(at);
    expect_stat(stat);
    expect_reg(0x05, ctrl2);
}

/* proves: X0-NUM-1004 */
static void test_overvoltage(void)
{
    for (int round = 0; round < 3; round++) {
        rig_pulse("bq7692003");
        fets_at(900, round == 2 ? 0x81 : 0x01);
        TEST_ASSERT_TRUE(rig_write(0x08, round == 1 ? 0x10 : 0x00));
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 2, 4.300);
        if (round == 0) {
            changes(1760, 2010, 0x04, 0x00);
        } else if (round == 1) {
            changes(2760, 3010, 0x04, 0x00);
        } else {
            changes(1009, 1010, 0x04, 0x80);
        }
    }
}

/* proves: X0-NUM-1005 */
static void test_overvoltage_restart(void)
{
    rig_boot("bq7692003");
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 2, 4.300);
    rig_at(1300);
    (void)sim_x0_set_cell(&chip, 2, 3.600);
    rig_at(1600);
    (void)sim_x0_set_cell(&chip, 2, 4.300);
    changes(2759, 2760, 0x04, 0x00);
}

/* proves: X0-NUM-1006 */
static void test_overvoltage_again(void)
{
    rig_boot("bq7692003");
    rig_at(1000);
    (void)sim_x0_set_cell(&chip, 2, 4.300);
    rig_at(2100);
    expect_stat(0x04);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x04));
    changes(2259, 2260, 0x04, 0x00);
}

/* proves: X0-NUM-1007 */
static void test_undervoltage(void)
{
    for (int code = 0; code < 2; code++) {
        rig_boot("bq7692003");
        fets_at(900, 0x02);
        TEST_ASSERT_TRUE(rig_write(0x08, code << 6));
        rig_at(1000);
        (void)sim_x0_set_cell(&chip, 1, 2.000);
        changes(code ? 4760 : 1760, code ? 5010 : 2010, 0x08, 0x00);
    }
}

/* proves: X0-NUM-1008 */
static void test_minimum_qualification(void)
{
    static const struct {
        double volts;
        int code, stat;
    } c[] = {{0.498, 1304, 0x08}, {0.4975, 1302, 0x00}, {0.0, 0, 0x00}};
    for (int i = 0; i < 3; i++) {
        rig_boot("bq7692003");
        (void)sim_x0_set_cell(&chip, 1, c[i].volts);
        rig_at(20000);
        TEST_ASSERT_EQUAL(c[i].code, rig_read16(0x0c));
        expect_stat(c[i].stat);
    }
}

/* proves: X0-NUM-1009 */
static void test_overcurrent(void)
{
    static const struct {
        double volts;
        int stat;
    } c[] = {{-0.010, 0x01}, {0.010, 0x00}, {-0.008, 0x00}};
    for (int i = 0; i < 3; i++) {
        rig_boot("bq7692003");
        fets_at(900, ALL_ON);
        rig_at(1000);
        (void)sim_x0_set_sense(&chip, c[i].volts);
        changes(1007.999, 1008, c[i].stat, c[i].stat ? 0x01 : 0x03);
        rig_at(20000);
        expect_stat(c[i].stat);
    }
    rig_boot("bq7692003");
    rig_at(1000);
    (void)sim_x0_set_sense(&chip, -0.010);
    rig_at(1007);
    (void)sim_x0_set_sense(&chip, 0);
    changes(1008, 20000, 0x00, 0x00);
}

/* proves: X0-NUM-1010 */
static void test_short_circuit(void)
{
    rig_boot("bq7692003");
    rig_at(1000);
    (void)sim_x0_set_sense(&chip, -0.025);
    changes(1000.069, 1000.070, 0x02, 0x00);
    rig_at(1007.999);
    expect_stat(0x02);
    rig_at(1008);
    expect_stat(0x03);
    rig_at(1100);
    rig_clear();
    changes(1100.069, 1100.070, 0x02, 0x00);
    rig_at(1107.999);
    expect_stat(0x02);
    rig_at(1108);
    expect_stat(0x03);
}

/* proves: X0-NUM-1011 */
static void test_coulomb_counter(void)
{
    for (int round = 0; round < 2; round++) {
        rig_boot("bq7692003");
        TEST_ASSERT_TRUE(rig_block_write(0x06, (uint8_t[]){0x9f, 0x7f, 0x00, 0xac, 0x97, 0x19}, 6));
        (void)sim_x0_set_sense(&chip, round == 0 ? -0.050 : 0.0);
        fets_at(300, 0x40);
        rig_at(425);
        (void)sim_x0_set_sense(&chip, -0.050);
        changes(549, 550, 0x80, 0x40);
        TEST_ASSERT_EQUAL_HEX16(round == 0 ? 0xe8dc : 0xf46e, rig_read16(0x32));
        TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
        changes(799, 800, 0x80, 0x40);
        TEST_ASSERT_EQUAL_HEX16(0xe8dc, rig_read16(0x32));
    }
}

/* proves: X0-NUM-1012 */
static void test_one_shot(void)
{
    rig_boot("bq7692003");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    fets_at(300, 0x20);
    rig_at(549);
    expect_reg(0x05, 0x20);
    changes(549, 550, 0x80, 0x00);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x20));
    expect_reg(0x05, 0x00);
    TEST_ASSERT_EQUAL(210 * MS, sim_x0_next_event(&chip)); /* the scan at 760 ms and nothing else */
}

/* proves: X0-NUM-1013 */
static void test_temperature_source(void)
{
    rig_pulse("bq7692003");
    rig_at(20);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_at(260);
    TEST_ASSERT_EQUAL_HEX16(0x10df, rig_read16(0x2c));
    rig_pulse("bq7692003");
    rig_at(300);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x18));
    rig_at(2259);
    TEST_ASSERT_EQUAL_HEX16(0x0c45, rig_read16(0x2c));
    rig_at(2260);
    TEST_ASSERT_EQUAL_HEX16(0x10df, rig_read16(0x2c));
}

/* proves: X0-NUM-1014 */
static void test_override(void)
{
    rig_boot("bq7692003");
    fets_at(400, ALL_ON);
    rig_at(500);
    expect_stat(0x00);
    (void)sim_x0_set_alert_ext(&chip, true);
    expect_stat(0x10);
    expect_reg(0x05, 0x00);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    rig_at(600);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x10));
    expect_stat(0x10);
    (void)sim_x0_set_alert_ext(&chip, false);
    TEST_ASSERT_TRUE(sim_x0_alert(&chip));
    TEST_ASSERT_TRUE(rig_write(0x00, 0x10));
    expect_stat(0x00);
    TEST_ASSERT_FALSE(sim_x0_alert(&chip));
}

/* proves: X0-NUM-1015 */
static void test_override_masked(void)
{
    rig_boot("bq7692003");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    fets_at(300, 0x43);
    rig_at(550);
    expect_stat(0x80);
    (void)sim_x0_set_alert_ext(&chip, true);
    expect_stat(0x80);
    expect_reg(0x05, 0x43);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x80));
    expect_stat(0x10);
    expect_reg(0x05, 0x40);
}

/* proves: X0-NUM-1016 */
static void test_internal_fault(void)
{
    rig_boot("bq7692003");
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    fets_at(300, 0x43);
    TEST_ASSERT_TRUE(rig_write(0x01, 0x15));
    rig_at(500);
    (void)sim_x0_strike_xready(&chip);
    expect_stat(0x20);
    expect_reg(0x05, 0x40);
    expect_reg(0x01, 0x00);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x20));
    expect_stat(0x00);
}

/* proves: X0-NUM-1017 */
static void test_fet_lock(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_set_cell(&chip, 1, 4.5);
    rig_at(2000);
    (void)sim_x0_set_cell(&chip, 1, 3.6);
    rig_at(2300);
    expect_stat(0x04);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    expect_reg(0x05, 0x42);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x04));
    TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
    expect_reg(0x05, 0x43);
}

/* proves: X0-NUM-1018 */
static void test_load(void)
{
    rig_boot("bq7692003");
    (void)sim_x0_set_chgpin(&chip, 3.0);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x01));
    expect_reg(0x04, 0x10);
    TEST_ASSERT_TRUE(rig_write(0x05, 0x00));
    expect_reg(0x04, 0x90);
    (void)sim_x0_set_chgpin(&chip, 0.5);
    expect_reg(0x04, 0x10);
}

/* proves: X0-NUM-1019 */
static void test_ship(void)
{
    static const struct {
        int reg[4], value[4], n;
        bool ships;
    } c[] = {{{4, 4, 4, 0}, {0x10, 0x11, 0x12, 0}, 3, true},
             {{4, 4, 5, 4}, {0x10, 0x11, 0x00, 0x12}, 4, false},
             {{4, 4, 4, 4}, {0x10, 0x11, 0x11, 0x12}, 4, false},
             {{4, 4, 4, 0}, {0x13, 0x11, 0x12, 0}, 3, true}};
    for (int i = 0; i < 4; i++) {
        rig_boot("bq7692003");
        for (int k = 0; k < c[i].n; k++) {
            TEST_ASSERT_TRUE(rig_write(c[i].reg[k], c[i].value[k]));
        }
        TEST_ASSERT_EQUAL(!c[i].ships, answers());
    }
}

/* proves: X0-NUM-1020 */
static void test_early_write(void)
{
    rig_pulse("bq7692003");
    rig_at(5);
    TEST_ASSERT_TRUE(rig_write(0x09, 0xbf));
    rig_at(20);
    expect_reg(0x09, 0xac);
}

/* The same life in one stride, in steps of 1 ms and in uneven steps ends in the same state. */
static void test_the_length_of_steps_does_not_matter(void)
{
    static const uint64_t step[3] = {0, 1000000, 777777};
    sim_x0 end[3];
    for (int round = 0; round < 3; round++) {
        sim_x0_options noisy = {.seed = 5, .noise_uv_rms = 2000, .cc_noise_uv_rms = 50};
        uint64_t until;
        rig_boot_with("bq7694003", &noisy);
        TEST_ASSERT_TRUE(rig_block_write(0x06, (uint8_t[]){0x9f, 0x7f, 0x50, 0xbf, 0x99, 0x19}, 6));
        TEST_ASSERT_TRUE(rig_write(0x05, 0x43));
        (void)sim_x0_set_sense(&chip, -0.051);
        until = chip.now + 100000 * MS;
        while (chip.now < until) {
            uint64_t left = until - chip.now;
            sim_x0_advance(&chip, step[round] == 0 || step[round] > left ? left : step[round]);
        }
        chip.due = 0; /* private to the model's clock */
        end[round] = chip;
    }
    TEST_ASSERT_EQUAL_MEMORY(end[0].reg, end[1].reg, sizeof end[0].reg);
    TEST_ASSERT_EQUAL_MEMORY(end[0].reg, end[2].reg, sizeof end[0].reg);
    TEST_ASSERT_EQUAL_UINT64(end[0].now, end[1].now);
    TEST_ASSERT_EQUAL_UINT64(end[0].now, end[2].now);
}

/* Everything that moves the next event is noticed although the model remembers when it is due. */
static void test_the_next_event_follows_every_change(void)
{
    rig_ship("bq7692003");
    sim_x0_advance(&chip, MS);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, sim_x0_next_event(&chip));
    (void)sim_x0_boot(&chip, 3 * MS);
    sim_x0_advance(&chip, 9 * MS);
    TEST_ASSERT_EQUAL_UINT64(MS, sim_x0_next_event(&chip));
    sim_x0_advance(&chip, MS);
    TEST_ASSERT_EQUAL_UINT64(250 * MS, sim_x0_next_event(&chip));
    (void)sim_x0_set_sense(&chip, -0.010);
    TEST_ASSERT_EQUAL_UINT64(8 * MS, sim_x0_next_event(&chip));
    sim_x0_advance(&chip, 8 * MS);
    expect_stat(0x01);
    TEST_ASSERT_TRUE(rig_write(0x00, 0x01));
    sim_x0_advance(&chip, 8 * MS);
    expect_stat(0x01);
    (void)sim_x0_set_sense(&chip, 0);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19) && rig_write(0x05, 0x20));
    sim_x0_advance(&chip, 250 * MS);
    expect_stat(0x81);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x00));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, sim_x0_next_event(&chip));
    sim_x0_advance(&chip, 60000 * MS);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x10));
    TEST_ASSERT_EQUAL_UINT64(250 * MS, sim_x0_next_event(&chip));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_start_of_each_size);
    RUN_TEST(test_first_data);
    RUN_TEST(test_pulse_length);
    RUN_TEST(test_overvoltage);
    RUN_TEST(test_overvoltage_restart);
    RUN_TEST(test_overvoltage_again);
    RUN_TEST(test_undervoltage);
    RUN_TEST(test_minimum_qualification);
    RUN_TEST(test_overcurrent);
    RUN_TEST(test_short_circuit);
    RUN_TEST(test_coulomb_counter);
    RUN_TEST(test_one_shot);
    RUN_TEST(test_temperature_source);
    RUN_TEST(test_override);
    RUN_TEST(test_override_masked);
    RUN_TEST(test_internal_fault);
    RUN_TEST(test_fet_lock);
    RUN_TEST(test_load);
    RUN_TEST(test_ship);
    RUN_TEST(test_early_write);
    RUN_TEST(test_the_length_of_steps_does_not_matter);
    RUN_TEST(test_the_next_event_follows_every_change);
    return UNITY_END();
}
