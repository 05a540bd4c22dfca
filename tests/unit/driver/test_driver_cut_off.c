/* SPDX-License-Identifier: Apache-2.0 */
/* A host that is reset at any moment of any work, with things happening to the stack before: whatever the
 * next life adopts is as a complete bring-up left it, and what it is told is right. */
#include "driver_lives.h"
#include "unity.h"
#include <string.h>

static uint32_t seed;

static uint32_t dice(uint32_t sides)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % sides;
}

void setUp(void)
{
    life_set_up();
}

void tearDown(void)
{
    life_tear_down();
}

/* Something of the driver's begins; false: nothing may. */
static bool begin_work(void)
{
    switch (dice(9)) {
    case 0:
        return bq76pl536_self_test(&r.d) == BQ_OK;
    case 1:
        return bq76pl536_wire_test(&r.d) == BQ_OK;
    case 2:
        return bq76pl536_select_gpai(&r.d, dice(3) == 0u) == BQ_OK;
    case 3:
        return dice(3) == 0u && bq76pl536_sleep(&r.d) == BQ_OK;
    case 4:
        return bq76pl536_wake(&r.d) == BQ_OK;
    case 5:
        return dice(3) == 0u && bq76pl536_start(&r.d) == BQ_OK;
    case 6:
    case 7:
        r.action.balance[0] = dice(2) == 0u ? 0u : 1u << dice(24);
        r.action.clear_faults = dice(3) == 0u;
        return bq76pl536_apply(&r.d, &r.action) == BQ_OK;
    default:
        return bq76pl536_scan(&r.d) == BQ_OK;
    }
}

/* Something happens to the stack. */
static void happen(void)
{
    const int n = 1 + (int)dice(LIFE_DEVICES);

    switch (dice(16)) {
    case 0:
        rig_poke(&r, (uint8_t)n, 0x3c, 0xa5);
        break;
    case 1:
        (void)sim_pl_set_supply(&r.pl, n, false);
        sim_pl_advance(&r.pl, dice(20) * SIM_PL_MS);
        (void)sim_pl_set_supply(&r.pl, n, true);
        break;
    case 2:
        (void)sim_pl_damage_ram(&r.pl, n, (uint8_t)(0x42u + dice(10)), (uint8_t)(1u << dice(8)));
        break;
    case 3:
        (void)sim_pl_set_cell(&r.pl, n, 2, dice(2) == 0u ? 4.4 : 2.0);
        break;
    case 4:
        (void)sim_pl_set_tdie(&r.pl, n, 160.0);
        break;
    case 5:
        sim_pl_bus_fault(&r.pl)->flip_miso_bit = 1 + (int)dice(60);
        break;
    case 6:
        sim_pl_bus_fault(&r.pl)->flip_mosi_bit = 1 + (int)dice(30);
        break;
    case 7:
        (void)sim_pl_set_link(&r.pl, n, true);
        break;
    default:
        break;
    }
    sim_pl_advance(&r.pl, dice(3) == 0u ? dice(700) * SIM_PL_MS : dice(5) * SIM_PL_MS);
}

/* What happened ends, what it left behind stays. */
static void all_well(void)
{
    for (int n = 1; n <= LIFE_DEVICES; n++) {
        (void)sim_pl_set_link(&r.pl, n, false);
        (void)sim_pl_set_tdie(&r.pl, n, 25.0);
        (void)sim_pl_set_cell(&r.pl, n, 2, 3.6);
    }
    sim_pl_bus_fault(&r.pl)->flip_miso_bit = 0;
    sim_pl_bus_fault(&r.pl)->flip_mosi_bit = 0;
}

static void poll_for(uint32_t times)
{
    for (bq_status st = BQ_PENDING; times > 0u && st == BQ_PENDING; times--) {
        uint32_t wait_us = 0;
        st = bq76pl536_poll(&r.d, &wait_us);
        hal_sim_advance(&r.hal, wait_us != 0u ? wait_us * 1000ull : 100u);
    }
}

static bool a_life_cut_off(void)
{
    c.balance_settle_ms = (uint8_t)dice(20);
    c.allow_partial = dice(2) == 0u;
    life_first(NULL);
    for (uint32_t works = dice(5); works > 0u; works--) {
        happen();
        if (begin_work()) {
            (void)rig_run(&r, 60.0);
        }
    }
    if (begin_work()) {
        poll_for(dice(2) == 0u ? dice(20) : dice(400));
    }
    all_well();
    sim_pl_advance(&r.pl, dice(2) == 0u ? dice(1000) * SIM_PL_US : dice(200) * SIM_PL_MS);
    life_reset_host();
    const bq_status st = rig_start(&r);
    if (life_warm() == BQ76PL536_WARM_ADOPTED) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, st);
        TEST_ASSERT_EQUAL_UINT(0, spy.resets);
        life_assert_right();
        rig_advance_ms(&r, 600); /* nothing was on its way */
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        life_assert_picture();
        return true;
    }
    if (st == BQ_OK && bq76pl536_modules_found(&r.d) == LIFE_DEVICES) {
        life_assert_right();
    } else {
        TEST_ASSERT_EQUAL_INT(BQ_OK, st);
    }
    return false;
}

static void cut_off_at_any_moment(void)
{
    unsigned adopted = 0, anew = 0;

    for (uint32_t life = 1; life <= 2000u; life++) {
        seed = life;
        life_set_up();
        if (a_life_cut_off()) {
            adopted++;
        } else {
            anew++;
        }
        life_tear_down();
    }
    TEST_ASSERT_GREATER_THAN(100, adopted);
    TEST_ASSERT_GREATER_THAN(100, anew);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(cut_off_at_any_moment);
    return UNITY_END();
}
