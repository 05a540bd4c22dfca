/* SPDX-License-Identifier: Apache-2.0 */
/* The bus fails: each transaction once, wires stuck, flipped bits, no supply. */
#include "x0_rig.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* proves: X0-SEQ-49, X0-SEQ-53 */
static void test_each_transaction_of_bring_up_and_scan_fails_once(void)
{
    static const char *const name[] = {"bq7692000", "bq7693003", "bq7694003"};
    for (unsigned p = 0; p < 3u; p++) {
        for (unsigned n = 1; n < 40u; n++) {
            rig_part(name[p], 5u * (p + 1u));
            rig.hal.fail_at = n;
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
            rig.hal.fail_at = n % 7u + 1u;
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
            rig.hal.fail_at = 0;
            rig_pass(1500);
            TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
            TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
            rig_clean();
        }
    }
}

/* proves: X0-SEQ-52, X0-AMB-89 */
static void test_stuck_data_line(void)
{
    rig_up("bq7692003", 5);
    for (int clocks = 1; clocks <= 9; clocks++) {
        sim_x0_bus(&rig.chip)->stuck_clocks = clocks;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
        TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
    }
    sim_x0_bus(&rig.chip)->stuck_clocks = -1;
    TEST_ASSERT_EQUAL_INT(BQ_E_ARBITRATION, rig_scan());
    TEST_ASSERT_TRUE((rig_faults() & BQ_F_COMM) != 0u);
    TEST_ASSERT_EQUAL_HEX8(0, rig.cells[0].quality & BQ_Q_VALID);
    sim_x0_bus(&rig.chip)->stuck_clocks = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    rig_clean();
}

/* proves: X0-SEQ-51, X0-SEQ-54 */
static void test_silence_and_return_of_the_supply(void)
{
    rig_up("bq7692003", 5);
    for (int dead = 1; dead <= 2; dead++) {
        sim_x0_bus(&rig.chip)->dead = dead;
        TEST_ASSERT_TRUE(rig_scan() < 0);
        TEST_ASSERT_TRUE((rig_faults() & BQ_F_COMM) != 0u);
    }
    sim_x0_bus(&rig.chip)->dead = 0;
    (void)sim_x0_set_supply(&rig.chip, false);
    TEST_ASSERT_EQUAL_INT(BQ_E_NACK, rig_scan());
    (void)sim_x0_set_supply(&rig.chip, true);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
}

/* proves: X0-I2C-27 */
static void test_flipped_bits_never_show_as_values(void)
{
    rig_up("bq7694003", 15);
    sim_x0_bus(&rig.chip)->flip_probability = 1e-4;
    for (unsigned n = 0; n < 2000u; n++) {
        (void)rig_scan();
        rig_wait_ms(240);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        for (unsigned c = 0; c < 15u; c++) {
            if ((rig.cells[c].quality & BQ_Q_VALID) != 0u) {
                TEST_ASSERT_UINT_WITHIN(1, 3600, rig.cells[c].mv);
            }
        }
    }
    TEST_ASSERT_TRUE(rig.d.stats.retries > 20u);
    rig_clean();
}

/* A part that holds the clock: tolerated up to the bound of the back-end, an error beyond, over when it is
 * over. */
/* proves: X0-I2C-23, X0-AMB-89 */
static void test_a_part_that_stretches_the_clock(void)
{
    static const char *const name[] = {"bq7692000", "bq7693003", "bq7694006"};
    for (unsigned p = 0; p < 3u; p++) {
        for (uint32_t us = 100; us <= 9000u; us += 890u) {
            rig_up(name[p], 5u * (p + 1u));
            sim_x0_bus(&rig.chip)->stretch_us = us;
            for (unsigned n = 0; n < 12u; n++) {
                TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
                rig_wait_ms(250);
            }
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 1));
            TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
            TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
        }
        sim_x0_bus(&rig.chip)->stretch_us = 20000u;
        TEST_ASSERT_EQUAL_INT(BQ_E_TIMEOUT, rig_scan());
        TEST_ASSERT_TRUE((rig_faults() & BQ_F_COMM) != 0u);
        TEST_ASSERT_EQUAL_HEX8(0, rig.cells[0].quality & BQ_Q_VALID);
        sim_x0_bus(&rig.chip)->stretch_us = 0;
        rig_pass(1500);
        TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
        rig_clean();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_transaction_of_bring_up_and_scan_fails_once);
    RUN_TEST(test_stuck_data_line);
    RUN_TEST(test_silence_and_return_of_the_supply);
    RUN_TEST(test_flipped_bits_never_show_as_values);
    RUN_TEST(test_a_part_that_stretches_the_clock);
    return UNITY_END();
}
