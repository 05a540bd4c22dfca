/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The back-end of the STM32F405, unchanged, against the emulator's judge: SPI and DMA below a stack, I2C
 * version 1 with everything that can happen on that bus, the clock tree with and without its crystal. usage:
 * test_f405 FOLDER      FOLDER/hv-f405/hv-f405.bin and FOLDER/f405-afe/f405-afe.bin
 */
#include "rig.h"
#include "unity.h"
#include <stdio.h>

enum { STATE_ON = 3 };
enum { BOOT_CRYSTAL_FAILED = 2, BOOT_IMAGE_OK = 4 };

void setUp(void)
{
}

void tearDown(void)
{
    rig_end();
}

/* Two seconds to find the monitors, then the request. */
static void switch_on(void)
{
    rig_run(2.5);
    r.request = true;
    rig_run(0.8);
    TEST_ASSERT_EQUAL(STATE_ON, r.heartbeat[0]);
}

static void test_a_stack_is_measured_and_its_contactor_closes(void)
{
    rig_stack(16);
    rig_run(0.02);
    TEST_ASSERT_FALSE(r.contactor);
    switch_on();
    TEST_ASSERT_TRUE(r.contactor);
    TEST_ASSERT_EQUAL(BOOT_IMAGE_OK, r.boot[1]);
    r.request = false;
    rig_run(0.3);
    TEST_ASSERT_FALSE(r.contactor);
    rig_clean();
}

static void test_without_its_crystal_it_runs_all_the_same_and_says_so(void)
{
    rig_stack(3);
    emu_set_crystal(r.e, false);
    rig_run(1.0);
    TEST_ASSERT_EQUAL(BOOT_CRYSTAL_FAILED | BOOT_IMAGE_OK, r.boot[1]);
    TEST_ASSERT_GREATER_THAN(5, r.heartbeats);
    rig_clean();
}

static void test_a_crystal_that_stops_in_service_does_not_stop_the_firmware(void)
{
    rig_stack(16);
    switch_on();
    emu_set_crystal(r.e, false);
    rig_run(6.0); /* the boot frame is repeated every 5 s */
    TEST_ASSERT_EQUAL(STATE_ON, r.heartbeat[0]);
    TEST_ASSERT_TRUE(r.contactor);
    TEST_ASSERT_EQUAL(BOOT_CRYSTAL_FAILED | BOOT_IMAGE_OK, r.boot[1]);
    rig_clean();
}

static void survives(rig_trouble trouble)
{
    rig_afe();
    switch_on();
    r.trouble = trouble;
    r.trouble_ns = r.now_ns;
    rig_run(2.0);
    TEST_ASSERT_EQUAL(RIG_FINE, r.trouble); /* it has struck */
    TEST_ASSERT_EQUAL(STATE_ON, r.heartbeat[0]);
    TEST_ASSERT_TRUE(sim_x0_chg(&r.afe) && sim_x0_dsg(&r.afe));
    rig_clean();
}

static void test_i2c_works(void)
{
    survives(RIG_FINE);
    TEST_ASSERT_EQUAL(0, r.held);
}

static void test_i2c_survives_a_byte_not_acknowledged(void)
{
    survives(RIG_NACK);
}

static void test_i2c_survives_lost_arbitration(void)
{
    survives(RIG_LOST);
}

static void test_i2c_survives_a_bus_error(void)
{
    survives(RIG_BUS_ERROR);
}

static void test_i2c_waits_for_a_slave_that_stretches_the_clock(void)
{
    survives(RIG_STRETCH);
}

static void test_i2c_gives_up_a_slave_that_stretches_too_long_and_comes_back(void)
{
    survives(RIG_TOO_LONG);
}

static void test_i2c_clocks_out_a_slave_that_holds_the_data_line(void)
{
    survives(RIG_STUCK);
    TEST_ASSERT_GREATER_OR_EQUAL(5, r.clocks);
    TEST_ASSERT_EQUAL(0, r.held);
}

static void test_a_dead_i2c_ends_the_state_on_and_breaks_no_rule(void)
{
    rig_afe();
    switch_on();
    r.trouble = RIG_DEAD;
    r.trouble_ns = r.now_ns;
    rig_run(5.0);
    TEST_ASSERT_NOT_EQUAL(STATE_ON, r.heartbeat[0]);
    rig_clean();
}

int main(void)
{
    const char *missing = rig_missing();
    if (missing != NULL) {
        printf("SKIPPED: %s\n", missing);
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_a_stack_is_measured_and_its_contactor_closes);
    RUN_TEST(test_without_its_crystal_it_runs_all_the_same_and_says_so);
    RUN_TEST(test_a_crystal_that_stops_in_service_does_not_stop_the_firmware);
    RUN_TEST(test_i2c_works);
    RUN_TEST(test_i2c_survives_a_byte_not_acknowledged);
    RUN_TEST(test_i2c_survives_lost_arbitration);
    RUN_TEST(test_i2c_survives_a_bus_error);
    RUN_TEST(test_i2c_waits_for_a_slave_that_stretches_the_clock);
    RUN_TEST(test_i2c_gives_up_a_slave_that_stretches_too_long_and_comes_back);
    RUN_TEST(test_i2c_clocks_out_a_slave_that_holds_the_data_line);
    RUN_TEST(test_a_dead_i2c_ends_the_state_on_and_breaks_no_rule);
    return UNITY_END();
}
