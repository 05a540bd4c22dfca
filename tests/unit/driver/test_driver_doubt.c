/* SPDX-License-Identifier: Apache-2.0 */
/* A running stack that is not as bring-up left it, in whatever way: it is not adopted but brought up from the
 * beginning. */
#include "bqhost/crc8.h"
#include "driver_lives.h"
#include "unity.h"
#include <string.h>

/* Packets: outputs off, five looks at each device, four for strangers. */
#define ADOPTION (1u + LIFE_DEVICES * 5u + 4u)

void setUp(void)
{
    life_set_up();
}

void tearDown(void)
{
    life_tear_down();
}

/* ---- not adopted: addresses ----------------------------------------------------------------------- */

/* proves: PL-SEQ-13-01 */
static void a_device_without_its_address_leads_to_discovery(void)
{
    life_first(NULL);
    for (uint8_t n = 1; n <= LIFE_DEVICES; n++) {
        rig_poke(&r, n, 0x3c, 0xa5); /* RESET of that device alone */
        sim_pl_advance(&r.pl, SIM_PL_MS);
        life_expect_cold(BQ76PL536_WARM_UNHEARD, n);
    }
    for (int n = 1; n <= LIFE_DEVICES; n++) {
        (void)sim_pl_set_supply(&r.pl, n, false);
        sim_pl_advance(&r.pl, SIM_PL_MS);
        (void)sim_pl_set_supply(&r.pl, n, true);
        sim_pl_advance(&r.pl, 80 * SIM_PL_MS);
        life_expect_cold(BQ76PL536_WARM_UNHEARD, (unsigned)n);
    }
}

static void addresses_in_a_wrong_order_lead_to_discovery(void)
{
    life_first(NULL);
    rig_poke(&r, 0x3f, 0x3c, 0xa5);
    sim_pl_advance(&r.pl, SIM_PL_MS);
    rig_poke(&r, 0, 0x3b, 0x82);
    rig_poke(&r, 0, 0x3b, 0x81);
    rig_poke(&r, 0, 0x3b, 0x83);
    rig_poke(&r, 0, 0x3b, 0x84);
    life_expect_cold(BQ76PL536_WARM_SETTINGS, 1);
}

/* proves: PL-SEQ-02-08 */
static void a_stack_larger_than_configured_is_not_adopted(void)
{
    c = rig_config(LIFE_DEVICES + 1);
    c.warm_start = true;
    life_first(NULL);
    c.devices = LIFE_DEVICES; /* the settings changed: the top device still has its address */
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_E_EXTRA_DEVICE, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_STRANGER, life_warm());
    TEST_ASSERT_EQUAL_UINT(LIFE_DEVICES + 1, bq76pl536_diagnose(&r.d)->warm_device);
    TEST_ASSERT_TRUE(bq76pl536_diagnose(&r.d)->extra_device);
    life_reset_host(); /* and the failed bring-up left nothing to adopt */
    TEST_ASSERT_EQUAL_INT(BQ_E_EXTRA_DEVICE, rig_start(&r));
    TEST_ASSERT_TRUE(life_warm() != BQ76PL536_WARM_ADOPTED);
}

/* Devices above a break do not hear what the others are told: what they show belongs to an older life. */
static void a_bring_up_of_a_part_leaves_no_mark(void)
{
    c.allow_partial = true;
    life_first(NULL);
    rig_poke(&r, 1, 0x33, 0); /* no mark: brought up anew, but only below the break */
    (void)sim_pl_set_link(&r.pl, 3, true);
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_modules_found(&r.d));
    (void)sim_pl_set_link(&r.pl, 3, false);
    life_expect_cold(BQ76PL536_WARM_UNFINISHED, 1);
}

/* proves: PL-SEQ-02-08 */
static void a_device_added_meanwhile_is_noticed_at_address_0(void)
{
    bq76pl536_config big = rig_config(LIFE_DEVICES + 1);
    rig_open(&r, &big, NULL);
    (void)sim_pl_set_link(&r.pl, LIFE_DEVICES + 1, true);
    (void)sim_pl_set_supply(&r.pl, LIFE_DEVICES + 1, false);
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    (void)sim_pl_set_link(&r.pl, LIFE_DEVICES + 1, false);
    (void)sim_pl_set_supply(&r.pl, LIFE_DEVICES + 1, true);
    sim_pl_advance(&r.pl, 80 * SIM_PL_MS);
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_E_EXTRA_DEVICE, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_STRANGER, life_warm());
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_diagnose(&r.d)->warm_device);
}

/* ---- not adopted: registers and flags --------------------------------------------------------------- */

static void one_register_of_one_device_is_enough(void)
{
    static const struct {
        uint8_t reg, value;
    } other[] = {{0x40, 0x54}, {0x42, 0x20}, {0x43, 0x86}, {0x44, 0x10}, {0x45, 0x86}, {0x46, 0x22},
                 {0x47, 0x40}, {0x48, 0x01}, {0x49, 0x80}, {0x4a, 0x10}, {0x4b, 0xff}, {0x30, 0x3d},
                 {0x30, 0x75}, {0x31, 0x01}, {0x31, 0x43}, {0x31, 0x83}, {0x31, 0x07}};
    life_first(NULL);
    for (unsigned i = 0; i < sizeof other / sizeof other[0]; i++) {
        const uint8_t n = (uint8_t)(1u + i % LIFE_DEVICES);
        if (other[i].reg >= 0x40u) {
            rig_poke(&r, n, 0x3a, 0x35);
        }
        rig_poke(&r, n, other[i].reg, other[i].value);
        sim_pl_advance(&r.pl, SIM_PL_MS);
        TEST_ASSERT_TRUE(sim_pl_peek(&r.pl, n, other[i].reg) != reference[n][other[i].reg]);
        life_expect_cold(BQ76PL536_WARM_SETTINGS, n);
    }
    rig_poke(&r, 3, 0x33, 0x05); /* and the mark */
    life_expect_cold(BQ76PL536_WARM_UNFINISHED, 3);
}

static struct {
    uint8_t dev, reg, flip;
} lie;

/* The first answer of device `dev` that holds `reg` says something else about it, with a sound CRC. */
static bool tell_a_lie(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)life_watch(ctx, tx, rx, n);
    if (lie.dev == 0u || tx[0] != lie.dev << 1 || lie.reg < tx[1] || lie.reg >= tx[1] + tx[2]) {
        return false;
    }
    memcpy(rx, tx, 3);
    for (uint8_t i = 0; i < tx[2]; i++) {
        const uint8_t reg = (uint8_t)(tx[1] + i);
        rx[3 + i] = (uint8_t)(sim_pl_peek(&r.pl, lie.dev, reg) ^ (reg == lie.reg ? lie.flip : 0));
    }
    rx[n - 1u] = bq_crc8_bitwise(0, rx, n - 1u);
    lie.dev = 0;
    return true;
}

/* Every bit that is looked at decides. A CRC flag alone is cleared up.
 * proves: PL-SEQ-08-02, PL-SEQ-08-05, PL-POR-11 */
static void every_bit_of_every_register_counts(void)
{
    static const struct {
        uint8_t first, last, bits;
        bq76pl536_warm why;
    } looked_at[] = {
        {0x3b, 0x3b, 0xff, BQ76PL536_WARM_UNHEARD},   {0x40, 0x4b, 0xff, BQ76PL536_WARM_SETTINGS},
        {0x30, 0x30, 0xff, BQ76PL536_WARM_SETTINGS},  {0x31, 0x31, 0xc7, BQ76PL536_WARM_SETTINGS},
        {0x32, 0x32, 0xff, BQ76PL536_WARM_BALANCING}, {0x33, 0x33, 0xff, BQ76PL536_WARM_UNFINISHED},
        {0x20, 0x20, 0xff, BQ76PL536_WARM_FLAGS},     {0x21, 0x21, 0xfb, BQ76PL536_WARM_FLAGS},
        {0x22, 0x25, 0xff, BQ76PL536_WARM_FLAGS},     {0x00, 0x00, 0xff, BQ76PL536_WARM_FLAGS},
        {0x21, 0x21, 0x04, BQ76PL536_WARM_ADOPTED},
    };
    life_first(NULL);
    sim_pl_bus_fault(&r.pl)->hook = tell_a_lie;
    for (unsigned i = 0; i < sizeof looked_at / sizeof looked_at[0]; i++) {
        for (unsigned reg = looked_at[i].first; reg <= looked_at[i].last; reg++) {
            for (unsigned bit = 1; bit <= 0x80u; bit <<= 1) {
                if ((looked_at[i].bits & bit) == 0u) {
                    continue;
                }
                lie.dev = 2;
                lie.reg = (uint8_t)reg;
                lie.flip = (uint8_t)bit;
                life_next();
                TEST_ASSERT_EQUAL_UINT(0, lie.dev);
                TEST_ASSERT_EQUAL_INT(looked_at[i].why, life_warm());
                TEST_ASSERT_EQUAL(looked_at[i].why != BQ76PL536_WARM_ADOPTED, spy.resets > 0u);
                life_assert_right();
            }
        }
    }
}

static void other_settings_are_another_stack(void)
{
    life_first(NULL);
    c.cov_mv = 4100;
    life_next();
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_SETTINGS, life_warm());
    TEST_ASSERT_EQUAL_HEX8(reference[1][0x42] - 2, sim_pl_peek(&r.pl, 1, 0x42));
    life_remember();
    c.variant_a = true; /* whose conversion time is fixed */
    life_reset_host();
    (void)rig_start(&r);
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_SETTINGS, life_warm());
    TEST_ASSERT_GREATER_THAN(0, spy.resets);
}

static void every_flag_is_a_doubt(void)
{
    life_first(NULL);
    rig_poke(&r, 2, 0x20, 0x10); /* a self-test that was cut off: FORCE stands */
    life_expect_cold(BQ76PL536_WARM_FLAGS, 2);
    rig_poke(&r, 3, 0x21, 0x10);
    life_expect_cold(BQ76PL536_WARM_FLAGS, 3);
    (void)sim_pl_damage_ram(&r.pl, 4, 0x4b, 0x01); /* parity */
    sim_pl_advance(&r.pl, SIM_PL_MS);
    life_next();
    TEST_ASSERT_TRUE(life_warm() == BQ76PL536_WARM_SETTINGS || life_warm() == BQ76PL536_WARM_FLAGS);
    life_assert_right();
    (void)sim_pl_set_cell(&r.pl, 1, 2, 4.4);
    sim_pl_advance(&r.pl, 700 * SIM_PL_MS);
    (void)sim_pl_set_cell(&r.pl, 1, 2, 3.6); /* latched, its cause is gone */
    sim_pl_advance(&r.pl, 10 * SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 1, 0x21) & 0x01);
    life_expect_cold(BQ76PL536_WARM_FLAGS, 1);
}

static void a_device_that_was_too_hot_is_not_adopted(void)
{
    life_first(NULL);
    (void)sim_pl_set_tdie(&r.pl, 2, 160.0);
    sim_pl_advance(&r.pl, 100 * SIM_PL_MS);
    (void)sim_pl_set_tdie(&r.pl, 2, 25.0);
    sim_pl_advance(&r.pl, 100 * SIM_PL_MS);
    life_next();
    TEST_ASSERT_TRUE(life_warm() != BQ76PL536_WARM_ADOPTED);
    TEST_ASSERT_EQUAL_UINT(2, bq76pl536_diagnose(&r.d)->warm_device);
    life_assert_right();
}

/* Its address and its registers are right again, but nothing says how long. What has balanced since was
 * measured before, so it had settled.
 * proves: PL-SEQ-13-06 */
static void a_device_that_service_took_in_again_is_not_adopted(void)
{
    for (unsigned balanced = 0; balanced < 2u; balanced++) {
        life_first(NULL);
        (void)sim_pl_set_supply(&r.pl, 2, false);
        (void)sim_pl_set_supply(&r.pl, 2, true);
        for (int scan = 0; scan < 10; scan++) {
            rig_advance_ms(&r, 50);
            (void)rig_scan(&r);
        }
        life_assert_picture();
        life_assert_registers();
        if (balanced == 0u) {
            life_expect_cold(BQ76PL536_WARM_UNFINISHED, 2);
        } else {
            r.action.balance[0] = 1u << 6; /* the first cell of device 2 */
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
            life_expect_adopted();
        }
    }
}

/* A device that speaks without CRC: nothing it says is sound. */
static void a_device_without_crc_is_not_adopted(void)
{
    life_first(NULL);
    rig_poke(&r, 3, 0x3a, 0x35);
    rig_poke(&r, 3, 0x41, 0x01);
    sim_pl_advance(&r.pl, SIM_PL_MS);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 3, 0x41));
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_FOUND, rig_start(&r)); /* it does not hear a RESET with CRC */
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_UNHEARD, life_warm());
    TEST_ASSERT_EQUAL_UINT(3, bq76pl536_diagnose(&r.d)->warm_device);
    TEST_ASSERT_GREATER_THAN(0, spy.resets);
}

static void a_stack_that_was_put_to_sleep_is_not_adopted(void)
{
    life_first(NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_sleep(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 10));
    life_expect_cold(BQ76PL536_WARM_SETTINGS, 1);
}

static void a_converter_that_does_not_end_is_not_adopted(void)
{
    life_first(NULL);
    rig_poke(&r, 3, 0x30, 0x3d); /* ADC_ON = 0 with 6 us: the next start locks it up */
    rig_poke(&r, 3, 0x34, 0x01);
    sim_pl_advance(&r.pl, 20 * SIM_PL_MS);
    rig_poke(&r, 3, 0x30, 0x7d); /* what it is asked to show looks right */
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, 3, 0x00) & 0x01);
    life_reset_host();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_TRUE(life_warm() != BQ76PL536_WARM_ADOPTED);
    TEST_ASSERT_GREATER_THAN(0, spy.resets);
    life_assert_right();
}

/* ---- not adopted: what happens meanwhile -------------------------------------------------------------- */

static void damage_reply(void)
{
    sim_pl_bus_fault(&r.pl)->flip_miso_bit = 1 + 26; /* in the first data byte */
}

/* Every packet of the adoption damaged in turn: the answer that was damaged counts as a deviation. */
static void a_damaged_answer_leads_to_the_bring_up(void)
{
    life_first(NULL);
    life_expect_adopted();
    spy.act = damage_reply;
    for (spy.at = 2; spy.at <= ADOPTION; spy.at++) {
        life_next();
        TEST_ASSERT_TRUE(life_warm() == BQ76PL536_WARM_UNHEARD || life_warm() == BQ76PL536_WARM_STRANGER);
        TEST_ASSERT_GREATER_THAN(0, spy.resets);
        life_assert_right();
    }
    life_next(); /* the one behind belongs to the self-test, which repeats */
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_ADOPTED, life_warm());
}

static void damage_command(void)
{
    sim_pl_bus_fault(&r.pl)->flip_mosi_bit =
        1 + 20; /* outputs off becomes something else, with a wrong CRC */
}

/* The broadcast that ends balancing is damaged: outputs on are a deviation, outputs off a flag to clear. */
static void balancing_that_does_not_end_leads_to_the_bring_up(void)
{
    life_first(NULL);
    r.action.balance[0] = 1;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    spy.act = damage_command;
    spy.at = 1;
    life_next();
    TEST_ASSERT_EQUAL_INT(BQ76PL536_WARM_BALANCING, life_warm());
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->warm_device);
    life_assert_right();
    life_expect_adopted();
}

static uint8_t victim;

static void brown_out(void)
{
    (void)sim_pl_set_supply(&r.pl, victim, false);
    (void)sim_pl_set_supply(&r.pl, victim, true);
}

/* A device is reset at any packet of the adoption: either it is noticed there, or the next scans take the
 * device in again like at any other time. What is reported as valid is right in both cases. */
static void a_device_lost_in_the_middle_is_noticed(void)
{
    const uint32_t packets = ADOPTION + LIFE_DEVICES * 2u; /* the self-test looks at each device first */
    life_first(NULL);
    spy.act = brown_out;
    for (victim = 1; victim <= LIFE_DEVICES; victim++) {
        for (spy.at = 1; spy.at <= packets; spy.at++) {
            const uint32_t misuse = rig_misuse(&r);
            life_reset_host();
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
            TEST_ASSERT_TRUE(life_warm() != BQ76PL536_WARM_ADOPTED || spy.at > packets);
            for (int scan = 0; scan < 10; scan++) {
                rig_advance_ms(&r, 50);
                (void)rig_scan(&r);
                rig_sample(&r);
                for (unsigned i = 0; i < c.devices * 6u; i++) {
                    if ((r.cells[i].quality & BQ_Q_VALID) != 0u) {
                        TEST_ASSERT_EQUAL_UINT(3600, r.cells[i].mv);
                    }
                }
            }
            life_assert_picture();
            life_assert_registers();
            TEST_ASSERT_EQUAL_UINT(misuse, rig_misuse(&r));
        }
    }
}

/* The previous life was cut off at any packet of its bring-up: without the mark nothing is adopted. */
static void a_bring_up_that_was_cut_off_is_begun_anew(void)
{
    life_first(NULL);
    rig_poke(&r, 1, 0x33, 0); /* no mark: a whole bring-up follows */
    life_next();
    const uint32_t whole = spy.packets;
    TEST_ASSERT_GREATER_THAN(100, whole);
    for (uint32_t last = 3; last <= whole; last++) {
        rig_poke(&r, 1, 0x33, 0);
        life_reset_host();
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_start(&r.d));
        while (spy.packets < last) {
            uint32_t wait_us;
            (void)bq76pl536_poll(&r.d, &wait_us);
            hal_sim_advance(&r.hal, wait_us * 1000ull + 100u);
        }
        life_next();
        TEST_ASSERT_EQUAL(last >= whole, life_warm() == BQ76PL536_WARM_ADOPTED);
        life_assert_right();
    }
}

/* Programming the EPROM is cut off at any packet: from the first key on nothing is adopted, although the
 * device shows exactly what the configuration wants. */
static void programming_that_was_cut_off_is_not_adopted(void)
{
    uint8_t image[12];
    unsigned doubted = 0;
    for (uint32_t last = 1;; last++) {
        uint32_t keys, wait_us;
        life_first(NULL);
        life_expect_adopted();
        for (unsigned i = 0; i < sizeof image; i++) {
            image[i] = (uint8_t)reference[2][0x40 + i];
        }
        r.hal.vpp_device = 2;
        spy.packets = spy.keys = 0;
        const bq_status begun = bq76pl536_program_otp(&r.d, 2, image, BQ76PL536_OTP_GUARD);
        if (begun == BQ_E_UNSUPPORTED) {
            return; /* built without */
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, begun);
        bq_status st = BQ_PENDING;
        while (st == BQ_PENDING && spy.packets < last) {
            st = bq76pl536_poll(&r.d, &wait_us);
            hal_sim_advance(&r.hal, wait_us * 1000ull + 100u);
        }
        keys = spy.keys;
        (void)sim_pl_set_vpp(&r.pl, 2, false); /* a reset releases the line */
        life_next();
        TEST_ASSERT_TRUE(keys == 0u || life_warm() != BQ76PL536_WARM_ADOPTED);
        life_assert_right();
        doubted += keys != 0u;
        if (st != BQ_PENDING) {
            TEST_ASSERT_EQUAL_INT(BQ_OK, st);
            break;
        }
    }
    TEST_ASSERT_GREATER_THAN(50, doubted);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_device_without_its_address_leads_to_discovery);
    RUN_TEST(addresses_in_a_wrong_order_lead_to_discovery);
    RUN_TEST(a_stack_larger_than_configured_is_not_adopted);
    RUN_TEST(a_bring_up_of_a_part_leaves_no_mark);
    RUN_TEST(a_device_added_meanwhile_is_noticed_at_address_0);
    RUN_TEST(one_register_of_one_device_is_enough);
    RUN_TEST(every_bit_of_every_register_counts);
    RUN_TEST(other_settings_are_another_stack);
    RUN_TEST(every_flag_is_a_doubt);
    RUN_TEST(a_device_that_was_too_hot_is_not_adopted);
    RUN_TEST(a_device_that_service_took_in_again_is_not_adopted);
    RUN_TEST(a_device_without_crc_is_not_adopted);
    RUN_TEST(a_stack_that_was_put_to_sleep_is_not_adopted);
    RUN_TEST(a_converter_that_does_not_end_is_not_adopted);
    RUN_TEST(a_damaged_answer_leads_to_the_bring_up);
    RUN_TEST(balancing_that_does_not_end_leads_to_the_bring_up);
    RUN_TEST(a_device_lost_in_the_middle_is_noticed);
    RUN_TEST(a_bring_up_that_was_cut_off_is_begun_anew);
    RUN_TEST(programming_that_was_cut_off_is_not_adopted);
    return UNITY_END();
}
