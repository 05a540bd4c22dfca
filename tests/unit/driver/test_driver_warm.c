/* SPDX-License-Identifier: Apache-2.0 */
/* A host that was reset while its stack kept running: what is adopted without a reset, and when nothing is
 * tried. */
#include "driver_lives.h"
#include "unity.h"
#include <string.h>

void setUp(void)
{
    life_set_up();
}

void tearDown(void)
{
    life_tear_down();
}

/* ---- adopted ----------------------------------------------------------------------------------- */

static void adopts_a_running_stack_without_a_reset(void)
{
    static const uint8_t outputs_off[] = {0x7f, 0x32, 0x00};
    life_first(NULL);
    life_expect_adopted();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(outputs_off, spy.first, 3);
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_stats(&r.d)->crc_errors + bq76pl536_stats(&r.d)->no_answers +
                                  bq76pl536_stats(&r.d)->retries);
    life_expect_adopted(); /* and again: the mark stays */
}

/* 32 devices: bytes and time against those of the bring-up with resets. */
static void takes_far_fewer_bytes_and_far_less_time(void)
{
    c = rig_config(32);
    c.warm_start = true;
    rig_open(&r, &c, NULL);
    sim_pl_bus_fault(&r.pl)->hook = life_watch;
    life_reset_host();
    uint64_t from = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    const uint64_t cold_ns = sim_pl_now(&r.pl) - from;
    const uint32_t cold_bytes = spy.bytes;
    life_remember();
    life_reset_host();
    from = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    const uint64_t warm_ns = sim_pl_now(&r.pl) - from;
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_ADOPTED, life_warm());
    /* one broadcast, 44 bytes a device, three looks for strangers, and the self-test of both chains */
    TEST_ASSERT_LESS_THAN(2200, spy.bytes);
    TEST_ASSERT_LESS_THAN(cold_bytes / 4u, spy.bytes);
    TEST_ASSERT_LESS_THAN(150, (uint32_t)(warm_ns / SIM_PL_MS));
    TEST_ASSERT_GREATER_THAN(800, (uint32_t)(cold_ns / SIM_PL_MS));
    life_assert_right();
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* Outputs that the previous life left on go off with the first packet, and are settled before a conversion.
 */
static void balancing_left_on_ends_with_the_first_packet(void)
{
    c.balance_settle_ms = 30;
    life_first(NULL);
    r.action.balance[0] = 0x00fc1041u;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 1));
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
    while (spy.packets < 2u) {
        uint32_t wait_us;
        TEST_ASSERT_EQUAL_INT(BQ_PENDING, bq76pl536_poll(&r.d, &wait_us));
        hal_sim_advance(&r.hal, wait_us * 1000ull + 100u);
    }
    for (int n = 1; n <= LIFE_DEVICES; n++) {
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, n));
    }
    const uint64_t off_ns = sim_pl_now(&r.pl);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_ADOPTED, life_warm());
    TEST_ASSERT_TRUE(sim_pl_now(&r.pl) - off_ns >= 30 * SIM_PL_MS);
    life_assert_right();
    r.action.balance[0] = 1; /* and balancing works as ever */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 1));
}

/* A host that dies in the middle of a packet leaves a CRC flag: that alone is no doubt. */
static void a_packet_cut_off_by_the_reset_is_cleared_up(void)
{
    static const uint8_t cut[] = {0x05, 0x21, 0x00, 0x00}; /* with a wrong CRC */
    uint8_t rx[4];
    life_first(NULL);
    sim_pl_spi(&r.pl, cut, rx, NULL, 4);
    sim_pl_advance(&r.pl, SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x04, sim_pl_peek(&r.pl, 2, 0x21));
    life_expect_adopted();
}

static void parts_of_variant_a_are_adopted_as_such(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.variant_a = true;
    c.variant_a = true;
    life_first(&o);
    life_expect_adopted();
}

/* ---- never tried --------------------------------------------------------------------------------- */

static void without_the_option_nothing_is_looked_for_and_nothing_is_left(void)
{
    life_first(NULL);
    c.warm_start = false;
    life_next();
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_NONE, life_warm());
    TEST_ASSERT_EQUAL_HEX8(0x3c, spy.first[1]); /* RESET comes first */
    TEST_ASSERT_EQUAL_UINT(LIFE_DEVICES, spy.resets);
    life_assert_right();
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, 1, 0x33));
    c.warm_start = true; /* no mark of a life without the option */
    life_expect_cold(BQ76PL536_WARM_UNFINISHED, 1);
}

static void without_crc_nothing_is_adopted(void)
{
    c.crc_off = true;
    rig_up(&r, &c, NULL);
    life_remember();
    sim_pl_bus_fault(&r.pl)->hook = life_watch;
    life_next();
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_NONE, life_warm());
    TEST_ASSERT_GREATER_THAN(0, spy.resets);
    life_assert_right();
}

/* A start that is repeated has a reason that only a reset cures. */
static void the_second_start_of_a_life_resets(void)
{
    life_first(NULL);
    life_expect_adopted();
    spy.resets = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(LIFE_DEVICES, spy.resets);
    life_assert_right();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(adopts_a_running_stack_without_a_reset);
    RUN_TEST(takes_far_fewer_bytes_and_far_less_time);
    RUN_TEST(balancing_left_on_ends_with_the_first_packet);
    RUN_TEST(a_packet_cut_off_by_the_reset_is_cleared_up);
    RUN_TEST(parts_of_variant_a_are_adopted_as_such);
    RUN_TEST(without_the_option_nothing_is_looked_for_and_nothing_is_left);
    RUN_TEST(without_crc_nothing_is_adopted);
    RUN_TEST(the_second_start_of_a_life_resets);
    return UNITY_END();
}
