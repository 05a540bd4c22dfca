/* SPDX-License-Identifier: Apache-2.0 */
/* Open sense wires: what converter and comparators see. */
#include "sim_bench.h"

void setUp(void)
{
    TEST_ASSERT_EQUAL(0, sim_pl_init(&s, 1, NULL));
}

void tearDown(void)
{
}

static void expect_seen(double v1, double v2, double v3, double v4, double v5, double v6)
{
    const double want[6] = {v1, v2, v3, v4, v5, v6};

    put(1, 0x30, 0x05);
    put(1, 0x34, 0x01);
    sim_pl_advance(&s, SIM_PL_MS);
    for (int i = 0; i < 6; i++) {
        int code = peek(1, (uint8_t)(3 + 2 * i)) << 8 | peek(1, (uint8_t)(4 + 2 * i));

        TEST_ASSERT_INT_WITHIN(1, (int)(want[i] * 16383.0 / 6.25 + 0.5), code);
    }
}

static void balance(unsigned mask)
{
    put(1, 0x33, 0x1e);
    put(1, 0x32, 0x00);
    put(1, 0x32, mask);
    TEST_ASSERT_EQUAL_HEX8(mask, sim_pl_cb(&s, 1));
}

/* An open inner wire leaves the sum alone; balancing makes the reading collapse; an end wire takes from the
 * sum. */
static void test_open_wire(void)
{
    static const double cells[6] = {1.0, 1.2, 1.4, 1.6, 1.8, 2.0};

    put(0, 0x3b, 0x81);
    sim_pl_set_cells(&s, 1, cells);
    sim_pl_set_wire(&s, 1, 3, true);
    expect_seen(1.0, 1.2, 0.7, 2.3, 1.8, 2.0);
    balance(0x04);
    expect_seen(1.0, 1.2, 0.0, 3.0, 1.8, 2.0);
    balance(0x08);
    expect_seen(1.0, 1.2, 3.0, 0.0, 1.8, 2.0);
    balance(0x0c);
    expect_seen(1.0, 1.2, 1.5, 1.5, 1.8, 2.0);
    balance(0x02);
    expect_seen(1.0, 1.2, 0.7, 2.3, 1.8, 2.0);
    put(1, 0x32, 0x00);
    sim_pl_set_wire(&s, 1, 2, true);
    expect_seen(1.0, 0.6, 0.7, 2.9, 1.8, 2.0);
    balance(0x02);
    expect_seen(1.0, 0.0, 4.2 * 1.4 / 3.0, 4.2 * 1.6 / 3.0, 1.8, 2.0);
    sim_pl_advance(&s, 30 * SIM_PL_S);
    expect_seen(1.0, 0.6, 0.7, 2.9, 1.8, 2.0);
    sim_pl_set_wire(&s, 1, 2, false);
    sim_pl_set_wire(&s, 1, 3, false);
    expect_seen(1.0, 1.2, 1.4, 1.6, 1.8, 2.0);
}

static void test_open_end_wires(void)
{
    static const double cells[6] = {1.0, 1.2, 1.4, 1.6, 1.8, 2.0};

    put(0, 0x3b, 0x81);
    sim_pl_set_cells(&s, 1, cells);
    sim_pl_set_wire(&s, 1, 0, true);
    expect_seen(0.5, 1.2, 1.4, 1.6, 1.8, 2.0);
    sim_pl_set_wire(&s, 1, 6, true);
    expect_seen(0.5, 1.2, 1.4, 1.6, 1.8, 1.0);
    sim_pl_set_wire(&s, 1, 0, false);
    balance(0x20);
    expect_seen(1.0, 1.2, 1.4, 1.6, 1.8, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 9.0, sim_pl_vbat(&s, 1));
}

/* Cells and outputs that change under an open wire are seen, by converter and comparators. */
static void test_open_wire_follows_cells_and_outputs(void)
{
    put(0, 0x3b, 0x81);
    key_put(1, 0x42, 0x3c);
    key_put(1, 0x44, 0x80);
    sim_pl_set_wire(&s, 1, 3, true);
    sim_pl_set_cell(&s, 1, 3, 3.0);
    expect_seen(3.6, 3.6, 1.5, 5.1, 3.6, 3.6);
    sim_pl_set_cell(&s, 1, 3, 1.0);
    sim_pl_set_cell(&s, 1, 4, 4.1);
    expect_seen(3.6, 3.6, 0.5, 4.6, 3.6, 3.6);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
    balance(0x04);
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x22)); /* 5.1 V above the open node */
    put(1, 0x32, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
}

/* The comparators see what the converter sees. */
static void test_open_wire_trips_the_comparators(void)
{
    put(0, 0x3b, 0x81);
    key_put(1, 0x42, 0x2c);
    key_put(1, 0x44, 0x15);
    TEST_ASSERT_EQUAL_HEX8(0x00, peek(1, 0x22));
    sim_pl_set_wire(&s, 1, 3, true);
    TEST_ASSERT_EQUAL_HEX8(0x08, peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x04, peek(1, 0x23));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_open_wire);
    RUN_TEST(test_open_end_wires);
    RUN_TEST(test_open_wire_follows_cells_and_outputs);
    RUN_TEST(test_open_wire_trips_the_comparators);
    return UNITY_END();
}
