/* SPDX-License-Identifier: Apache-2.0 */
/* Balancing with fewer switches than cells that ask: who gets how much. And days of uptime. */
#include "x0_rig.h"
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static unsigned turns[15];

/* Applies the same request for `periods` turns of 4.1 s and counts for each cell. */
static void serve(uint32_t asked, unsigned most, unsigned periods)
{
    memset(turns, 0, sizeof turns);
    rig_part("bq7694003", 15);
    rig.config.balance_max = (uint8_t)most;
    rig.config.die_check_s = BQ769X0_DIE_NEVER;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    for (unsigned n = 0; n < periods; n++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan());
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(false, false, asked));
        TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip) & ~asked);
        TEST_ASSERT_TRUE(__builtin_popcount(sim_x0_cb(&rig.chip)) <= (int)most);
        for (unsigned i = 0; i < 15u; i++) {
            turns[i] += sim_x0_cb(&rig.chip) >> i & 1u;
        }
        rig_wait_ms(4096u);
    }
    rig_clean();
}

/* At least half of what an equal share would be; where the two sets of neighbours are about as large, 0.8 of
 * it. */
static void expect_shares(uint32_t asked, unsigned most, unsigned tenths)
{
    unsigned periods = 336, cells = (unsigned)__builtin_popcount(asked);
    serve(asked, most, periods);
    for (unsigned i = 0; i < 15u; i++) {
        if ((asked >> i & 1u) != 0u) {
            TEST_ASSERT_TRUE(10u * (turns[i] + 2u) * cells >= tenths * most * periods);
        }
    }
}

/* proves: X0-SEQ-39, X0-SEQ-40, X0-SEQ-41, X0-SEQ-42 */
static void test_every_cell_gets_its_share(void)
{
    for (unsigned most = 1; most <= 7u; most++) {
        expect_shares(0x7fff, most, 8);
    }
    expect_shares(0x0007, 1, 5);
    expect_shares(0x1111, 1, 5); /* far apart, one set */
    expect_shares(0x2222, 3, 5);
    expect_shares(0x0303, 2, 8);
    expect_shares(0x4c63, 2, 5); /* neighbours in pairs */
}

/* The old mistake: the lowest first, every time. */
static unsigned wrong_share(unsigned cell, unsigned most)
{
    return cell < 2u * most ? 1u : 0u;
}

/* proves: X0-SEQ-42 */
static void test_the_highest_cells_are_not_forgotten(void)
{
    serve(0x7fff, 2, 64);
    for (unsigned i = 0; i < 15u; i++) {
        TEST_ASSERT_TRUE(turns[i] > 0u);
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong_share(14, 2));
}

/* Half a year in jumps of three days between two updates: the driver's clock of milliseconds changes its sign
 * after 25 days and wraps after 50. */
static void test_months_of_uptime(void)
{
    const uint32_t jump = 0x10000000u;
    rig_up("bq7692003", 5);
    rig_pass(3000);
    for (unsigned n = 0; n < 60u; n++) {
        uint32_t before = rig.d.sequence;
        rig.d.now_ms += jump;
        rig.d.cc_ms += jump; /* what every update renews */
        rig.d.scrub_ms += jump;
        rig.d.picture_ms += jump;
        rig_pass(250);
        TEST_ASSERT_EQUAL_UINT(before + 1u, rig.d.sequence);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[0].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.temps[0].quality);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_cell_gets_its_share);
    RUN_TEST(test_the_highest_cells_are_not_forgotten);
    RUN_TEST(test_months_of_uptime);
    return UNITY_END();
}
