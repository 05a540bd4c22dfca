/* SPDX-License-Identifier: Apache-2.0 */
/* Saving: the new record counts when it is whole, until then the old one does. */
#include "fake_nvm.h"
#include "objects.h"
#include "unity.h"
#include <string.h>

static objects a, b;
static fake_nvm flash;
static bq_nvm nvm;

static void start(uint8_t unit, uint8_t sectors)
{
    fake_nvm_init(&flash, unit);
    nvm = fake_nvm_ops(&flash, sectors);
}

void setUp(void)
{
    objects_init(&a);
    objects_init(&b);
    start(8, 2);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, flash.breaches);
}

static bq_status save(uint16_t cell_ov_mv)
{
    a.app.pack.cell_ov_mv = cell_ov_mv;
    return bq_settings_save(&a.settings, &nvm);
}

/* What a restart would find: the limit, or the status. */
static int found(void)
{
    const long power = flash.power_until;
    bq_status status;

    flash.power_until = -1;
    b.app.pack.cell_ov_mv = 0;
    status = bq_settings_load(&b.settings, &nvm);
    flash.power_until = power;
    return status == BQ_OK ? (int)b.app.pack.cell_ov_mv : (int)status;
}

static void test_saved_is_loaded_with_every_size_of_unit(void)
{
    static const uint8_t units[] = {2, 4, 8};

    for (int i = 0; i < 3; i++) {
        start(units[i], 2);
        for (uint16_t n = 0; n < 5; n++) {
            TEST_ASSERT_EQUAL(BQ_OK, save((uint16_t)(4000u + n)));
            TEST_ASSERT_EQUAL(4000 + n, found());
        }
    }
}

static void test_the_sectors_take_turns(void)
{
    start(8, 3);
    for (uint8_t n = 0; n < 7; n++) {
        uint8_t before[NVM_SECTORS][NVM_BYTES];
        memcpy(before, flash.memory, sizeof before);
        TEST_ASSERT_EQUAL(BQ_OK, save((uint16_t)(4000u + n)));
        for (uint8_t sector = 0; sector < 3; sector++) {
            TEST_ASSERT_EQUAL(sector == n % 3u, memcmp(before[sector], flash.memory[sector], NVM_BYTES) != 0);
        }
    }
}

/* Saved and encoded on a PC: the same bytes. */
static void test_a_tool_makes_the_same_record(void)
{
    static uint8_t record[NVM_BYTES];
    size_t len;

    TEST_ASSERT_EQUAL(BQ_OK, save(4111));
    len = bq_settings_encode(&a.settings, 1, record, sizeof record);
    TEST_ASSERT_EQUAL_MEMORY(record, flash.memory[0], len);
}

/* ---- power ----------------------------------------------------------------------------------------- */

/* The power goes away in every operation of a save in turn; `torn` is what that one leaves behind. */
static void lose_power_everywhere(uint8_t unit, uint8_t torn)
{
    long operations;

    start(unit, 2);
    TEST_ASSERT_EQUAL(BQ_OK, save(4001));
    TEST_ASSERT_EQUAL(BQ_OK, save(4002));
    operations = flash.operations;
    TEST_ASSERT_EQUAL(BQ_OK, save(4003));
    operations = flash.operations - operations; /* of one save */
    TEST_ASSERT_EQUAL(1 + 262 * 4 / unit, operations);
    for (long at = 0; at < operations; at++) {
        start(unit, 2);
        TEST_ASSERT_EQUAL(BQ_OK, save(4001));
        TEST_ASSERT_EQUAL(BQ_OK, save(4002));
        flash.power_until = flash.operations + at;
        flash.torn = torn;
        (void)save(4003);
        if (at < operations - 1 || torn != 0u) {
            TEST_ASSERT_EQUAL(4002, found());
        } else {
            TEST_ASSERT_EQUAL(4003, found()); /* the last unit was complete */
        }
        flash.power_until = -1; /* the next life can save */
        TEST_ASSERT_EQUAL(BQ_OK, save(4004));
        TEST_ASSERT_EQUAL(4004, found());
    }
}

static void test_power_lost_in_any_unit_leaves_the_old_record_in_force(void)
{
    static const uint8_t units[] = {2, 4, 8};
    static const uint8_t torn[] = {0x00, 0x01, 0xff, 0x5a};

    for (int u = 0; u < 3; u++) {
        for (int t = 0; t < 4; t++) {
            lose_power_everywhere(units[u], torn[t]);
        }
    }
}

/* Nothing was there before: nothing is there after, or it is told. */
static void test_power_lost_in_the_first_save_of_all(void)
{
    for (long at = 0; at < 132; at++) {
        start(8, 2);
        flash.power_until = at;
        flash.torn = 0x5a;
        (void)save(4001);
        TEST_ASSERT_EQUAL(at > 0 && at < 131 ? BQ_E_NOT_FOUND : BQ_E_CRC, found());
    }
}

/* ---- failures ---------------------------------------------------------------------------------------- */

static void old_stays(bq_status status)
{
    TEST_ASSERT_EQUAL(status, save(4002));
    flash.program_status = flash.erase_status = BQ_OK;
    flash.sticks = false;
    TEST_ASSERT_EQUAL(4001, found());
    TEST_ASSERT_EQUAL(BQ_OK, save(4003));
    TEST_ASSERT_EQUAL(4003, found());
}

static void test_failures_of_the_memory_are_told_and_change_nothing(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, save(4001));
    flash.erase_status = BQ_E_BUS;
    old_stays(BQ_E_BUS);
    TEST_ASSERT_EQUAL(BQ_OK, save(4001));
    flash.program_status = BQ_E_VERIFY;
    old_stays(BQ_E_VERIFY);
    TEST_ASSERT_EQUAL(BQ_OK, save(4001));
    flash.sticks = true;
    old_stays(BQ_E_VERIFY);
}

static void test_a_memory_that_cannot_be_read_is_not_erased(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, save(4001));
    flash.operations = 0;
    flash.read_status = BQ_E_BUS;
    TEST_ASSERT_EQUAL(BQ_E_BUS, save(4002));
    TEST_ASSERT_EQUAL(0, flash.operations);
}

static void test_arguments(void)
{
    nvm.unit_bytes = 1;
    TEST_ASSERT_EQUAL(BQ_E_ARG, save(4001));
    nvm.unit_bytes = 16;
    TEST_ASSERT_EQUAL(BQ_E_ARG, save(4001));
    nvm.unit_bytes = 8;
    nvm.sectors = 1;
    TEST_ASSERT_EQUAL(BQ_E_ARG, save(4001));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_save(NULL, &nvm));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_save(&a.settings, NULL));
    TEST_ASSERT_EQUAL(0, flash.operations);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_saved_is_loaded_with_every_size_of_unit);
    RUN_TEST(test_the_sectors_take_turns);
    RUN_TEST(test_a_tool_makes_the_same_record);
    RUN_TEST(test_power_lost_in_any_unit_leaves_the_old_record_in_force);
    RUN_TEST(test_power_lost_in_the_first_save_of_all);
    RUN_TEST(test_failures_of_the_memory_are_told_and_change_nothing);
    RUN_TEST(test_a_memory_that_cannot_be_read_is_not_erased);
    RUN_TEST(test_arguments);
    return UNITY_END();
}
