/* SPDX-License-Identifier: Apache-2.0 */
/* The measurement cycle: its cost, what it does under disturbed transfers, charge, a stopped converter. */
#include "x0_rig.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void cost(const char *name, unsigned cells, unsigned transactions, unsigned bytes)
{
    uint64_t t, b;
    rig_up(name, cells);
    rig_pass(2000);
    (void)rig_scan(); /* with the scrub, and right after it none is due */
    rig_wait_ms(250);
    t = rig.hal.transactions;
    b = rig.hal.bytes;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    TEST_ASSERT_EQUAL_UINT(transactions, rig.hal.transactions - t);
    TEST_ASSERT_EQUAL_UINT(bytes, rig.hal.bytes - b);
}

/* proves: X0-SEQ-21, X0-SEQ-22, X0-BIT-16 */
static void test_cost_of_an_update(void)
{
    cost("bq7694003", 15, 3, 92);
    cost("bq7694000", 15, 3, 50);
}

/* proves: X0-CC-03, X0-CC-13, X0-SEQ-26, X0-AMB-21 */
static void test_charge(void)
{
    for (unsigned inverted = 0; inverted < 2u; inverted++) {
        rig_part("bq7692003", 5);
        rig.config.invert_current = inverted != 0u;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
        (void)sim_x0_set_sense(&rig.chip, -0.010);
        rig_pass(1000);
        bq769x0_charge_reset(&rig.d);
        rig_pass(10000);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        TEST_ASSERT_INT_WITHIN(2, inverted != 0u ? 2000 : -2000, rig.sample.current_ma);
        TEST_ASSERT_INT_WITHIN(100000, inverted != 0u ? 20000000 : -20000000,
                               (int)bq769x0_get_charge(&rig.d)->uas);
        rig_wait_ms(500); /* two windows nobody fetched */
        rig_pass(250);
        TEST_ASSERT_EQUAL_UINT(2, bq769x0_get_charge(&rig.d)->missed);
        TEST_ASSERT_INT_WITHIN(100000, inverted != 0u ? 21500000 : -21500000,
                               (int)bq769x0_get_charge(&rig.d)->uas);
        rig_clean();
    }
}

/* proves: X0-SEQ-46, X0-AMB-25, X0-AMB-26 */
static void test_one_shot(void)
{
    for (unsigned reading = 0; reading < 3u; reading++) {
        rig_up("bq7692003", 5);
        rig.chip.options.amb25_ready_ignored = reading == 1u;
        rig.chip.options.amb26_finishes = reading == 2u;
        (void)sim_x0_set_sense(&rig.chip, 0.010);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_oneshot(&rig.d)));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        TEST_ASSERT_INT_WITHIN(2, 2000, rig.sample.current_ma);
        TEST_ASSERT_EQUAL_HEX8(0x40, rig_reg(0x05));
        rig_clean();
    }
}

/* proves: X0-SEQ-20, X0-AMB-15, X0-ELEC-17 */
static void test_lost_configuration_and_unexpected_reset(void)
{
    rig_up("bq7692003", 5);
    rig_pass(2500);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 0));
    rig.chip.reg[0x04] = 0x08; /* the field's lost ADC_EN */
    rig.chip.t_scan = UINT64_MAX;
    rig_pass(1250);
    TEST_ASSERT_EQUAL_HEX8(0x18, rig_reg(0x04));
    rig_pass(3000);
    TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
    (void)sim_x0_set_supply(&rig.chip, false);
    (void)sim_x0_set_supply(&rig.chip, true);
    (void)sim_x0_boot(&rig.chip, 3000000);
    rig_wait_ms(1100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
    TEST_ASSERT_TRUE((rig_faults() & BQ_F_RESET) != 0u);
    TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
}

/* proves: X0-SEQ-25 */
static void test_values_that_never_change(void)
{
    bool seen = false;
    rig_part("bq7692003", 5);
    rig.config.frozen_scans = 4;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    for (unsigned n = 0; n < 12u; n++) {
        (void)sim_x0_set_cell(&rig.chip, 1, 3.6 + 0.01 * (n & 1u));
        rig_pass(250);
        TEST_ASSERT_EQUAL_HEX16(0, rig_faults() & BQ_F_LOCKUP);
    }
    sim_x0_freeze(&rig.chip, true);
    for (unsigned n = 0; n < 8u; n++) {
        rig_pass(250);
        seen = seen || (rig_faults() & BQ_F_LOCKUP) != 0u;
    }
    TEST_ASSERT_TRUE(seen);
    rig_clean();
}

/* proves: X0-I2C-19, X0-SEQ-48, X0-I2C-15 */
static void test_the_field_mistake_of_half_a_crc_check(void)
{
    rig_up("bq7694003", 15);
    for (unsigned byte = 0; byte < 80u; byte++) {
        uint32_t errors;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
        errors = rig.d.stats.crc_errors;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_begin_scan(&rig.d));
        (void)bq769x0_poll(&rig.d, NULL);                                     /* SYS_STAT goes out */
        (void)sim_x0_flip_sda(&rig.chip, (int)(24u + 8u * byte + byte % 8u)); /* in the block behind it */
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(BQ_OK));
        TEST_ASSERT_EQUAL_UINT(errors + 1u, rig.d.stats.crc_errors);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        TEST_ASSERT_UINT_WITHIN(1, 3600, rig.cells[14].mv); /* of its own register after the repetition */
    }
    rig_clean();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cost_of_an_update);
    RUN_TEST(test_charge);
    RUN_TEST(test_one_shot);
    RUN_TEST(test_lost_configuration_and_unexpected_reset);
    RUN_TEST(test_values_that_never_change);
    RUN_TEST(test_the_field_mistake_of_half_a_crc_check);
    return UNITY_END();
}
