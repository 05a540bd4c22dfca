/* SPDX-License-Identifier: Apache-2.0 */
/* Limits: defaults, checking, access by name. */
#include "bqhost/pack.h"
#include "unity.h"
#include <string.h>

static bq_pack_config c;
static const char *field;

void setUp(void)
{
    c = bq_pack_config_nmc(96, 32, 16);
    field = "untouched";
}

void tearDown(void)
{
}

static void test_the_defaults_of_both_chemistries_are_accepted(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_validate(&c, &field));
    TEST_ASSERT_NULL(field);
    TEST_ASSERT_EQUAL(96, c.cells);
    TEST_ASSERT_EQUAL(32, c.sensors);
    TEST_ASSERT_EQUAL(16, c.modules);
    TEST_ASSERT_TRUE(c.cell_ov_mv >= 4200 && c.cell_ov_mv <= 4300); /* a full NMC cell has 4.2 V */
    TEST_ASSERT_FALSE(c.separate_paths);
    c = bq_pack_config_lfp(6, 0, 1);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_validate(&c, NULL));
    TEST_ASSERT_TRUE(c.cell_ov_mv >= 3600 &&
                     c.cell_ov_mv <= 3800); /* a full LFP cell has 3.6 V while charging */
    TEST_ASSERT_TRUE(c.cell_uv_mv >= 2000 && c.cell_uv_mv <= 2800);
}

typedef struct range {
    const char *name;
    int32_t min, max, top; /* top: largest value of the type */
} range;

/* The ranges of pack.h. */
static const range ranges[] = {
    {"cells", 1, 372, 65535},
    {"sensors", 0, 128, 65535},
    {"modules", 1, 62, 65535},
    {"cell_ov_mv", 1000, 4500, 65535},
    {"cell_ov_clear_mv", 1000, 4500, 65535},
    {"cell_uv_mv", 1000, 4500, 65535},
    {"cell_uv_clear_mv", 1000, 4500, 65535},
    {"overtemp_dc", -400, 1250, 32767},
    {"overtemp_clear_dc", -400, 1250, 32767},
    {"undertemp_dc", -400, 1250, 32767},
    {"undertemp_clear_dc", -400, 1250, 32767},
    {"imbalance_mv", 0, 4500, 65535},
    {"imbalance_clear_mv", 0, 4500, 65535},
    {"charge_max_ma", 0, 1000000, 1000001},
    {"discharge_max_ma", 0, 1000000, 1000001},
    {"debounce_ms", 0, 10000, 65535},
    {"recover_ms", 100, 65535, 65535},
    {"comm_timeout_ms", 20, 30000, 65535},
    {"balance_start_mv", 0, 1000, 65535},
    {"balance_stop_mv", 1, 1000, 65535},
    {"balance_min_cell_mv", 1000, 4500, 65535},
    {"balance_max_temp_dc", -400, 1250, 32767},
    {"balance_rest_ma", 0, 1000000, INT32_MAX},
    {"balance_rest_ms", 0, 65535, 65535},
    {"balance_duty_percent", 1, 100, 255},
    {"balance_max_per_module", 0, 255, 255},
};

#define RANGES (sizeof ranges / sizeof ranges[0])

static void test_every_field_can_be_set_and_read_at_both_ends_of_its_range(void)
{
    for (unsigned i = 0; i < RANGES; i++) {
        int32_t value = 0;
        TEST_ASSERT_EQUAL_STRING(ranges[i].name, bq_pack_config_field((uint16_t)i));
        TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, ranges[i].name, ranges[i].min));
        TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_get(&c, ranges[i].name, &value));
        TEST_ASSERT_EQUAL_MESSAGE(ranges[i].min, value, ranges[i].name);
        TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, ranges[i].name, ranges[i].max));
        TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_get(&c, ranges[i].name, &value));
        TEST_ASSERT_EQUAL_MESSAGE(ranges[i].max, value, ranges[i].name);
    }
    TEST_ASSERT_NULL(bq_pack_config_field((uint16_t)RANGES));
}

static void test_names_reach_their_own_field(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, "cell_ov_mv", 4111));
    TEST_ASSERT_EQUAL(4111, c.cell_ov_mv);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, "undertemp_dc", -399));
    TEST_ASSERT_EQUAL(-399, c.undertemp_dc);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, "balance_rest_ma", 123456));
    TEST_ASSERT_EQUAL(123456, c.balance_rest_ma);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_set(&c, "balance_duty_percent", 77));
    TEST_ASSERT_EQUAL(77, c.balance_duty_percent);
}

static void test_what_lies_outside_is_refused_and_changes_nothing(void)
{
    for (unsigned i = 0; i < RANGES; i++) {
        const bq_pack_config before = c;
        TEST_ASSERT_EQUAL_MESSAGE(BQ_E_RANGE, bq_pack_config_set(&c, ranges[i].name, ranges[i].min - 1),
                                  ranges[i].name);
        if (ranges[i].max < INT32_MAX) {
            TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_pack_config_set(&c, ranges[i].name, ranges[i].max + 1));
        }
        TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof c);
    }
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_set(&c, "cell_ov", 4200));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_set(NULL, "cells", 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_set(&c, NULL, 1));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_get(&c, "cells", NULL));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_get(&c, "nothing", &(int32_t){0}));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_config_validate(NULL, &field));
    TEST_ASSERT_NULL(field);
}

#define REFUSED(status, name, change)                                                                        \
    do {                                                                                                     \
        setUp();                                                                                             \
        change;                                                                                              \
        TEST_ASSERT_EQUAL_MESSAGE(status, bq_pack_config_validate(&c, &field), #change);                     \
        TEST_ASSERT_NOT_NULL_MESSAGE(field, #change);                                                        \
        TEST_ASSERT_EQUAL_STRING_MESSAGE(name, field, #change);                                              \
    } while (0)

static void test_the_offending_field_is_named(void)
{
    REFUSED(BQ_E_RANGE, "cells", c.cells = 0);
    REFUSED(BQ_E_RANGE, "cells", c.cells = 373);
    REFUSED(BQ_E_RANGE, "sensors", c.sensors = 129);
    REFUSED(BQ_E_RANGE, "modules", c.modules = 0);
    REFUSED(BQ_E_RANGE, "cell_ov_mv", c.cell_ov_mv = 4501);
    REFUSED(BQ_E_RANGE, "undertemp_dc", c.undertemp_dc = -401);
    REFUSED(BQ_E_RANGE, "recover_ms", c.recover_ms = 99);
    REFUSED(BQ_E_RANGE, "comm_timeout_ms", c.comm_timeout_ms = 0);
    REFUSED(BQ_E_RANGE, "balance_rest_ma", c.balance_rest_ma = -1);
    REFUSED(BQ_E_RANGE, "balance_duty_percent", c.balance_duty_percent = 101);
}

static void test_contradictions_are_named(void)
{
    REFUSED(BQ_E_CONFIG, "modules", (c.cells = 5, c.modules = 6));
    REFUSED(BQ_E_CONFIG, "cell_ov_clear_mv", c.cell_ov_clear_mv = c.cell_ov_mv);
    REFUSED(BQ_E_CONFIG, "cell_uv_clear_mv", c.cell_uv_clear_mv = c.cell_uv_mv);
    REFUSED(BQ_E_CONFIG, "cell_uv_clear_mv", c.cell_uv_clear_mv = c.cell_ov_clear_mv);
    REFUSED(BQ_E_CONFIG, "overtemp_clear_dc", c.overtemp_clear_dc = c.overtemp_dc);
    REFUSED(BQ_E_CONFIG, "undertemp_clear_dc", c.undertemp_clear_dc = c.undertemp_dc);
    REFUSED(BQ_E_CONFIG, "undertemp_clear_dc", c.undertemp_clear_dc = c.overtemp_clear_dc);
    REFUSED(BQ_E_CONFIG, "imbalance_clear_mv", c.imbalance_clear_mv = c.imbalance_mv);
    REFUSED(BQ_E_CONFIG, "imbalance_clear_mv", c.imbalance_clear_mv = 0);
    REFUSED(BQ_E_CONFIG, "imbalance_clear_mv", c.imbalance_mv = 0);
    REFUSED(BQ_E_CONFIG, "balance_stop_mv", c.balance_stop_mv = (uint16_t)(c.balance_start_mv + 1u));
    REFUSED(BQ_E_CONFIG, "soc", c.soc.points = 2);
}

static void test_what_is_switched_off_contradicts_nothing(void)
{
    c.imbalance_mv = 0;
    c.imbalance_clear_mv = 0;
    c.balance_start_mv = 0;
    c.modules = 62;
    c.cells = 62; /* and a chip per cell is possible */
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_config_validate(&c, &field));
}

static void test_init_refuses_what_validation_refuses_and_changes_nothing(void)
{
    static bq_pack p, before;

    memset(&p, 0x5a, sizeof p);
    before = p;
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_init(NULL, &c));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_pack_init(&p, NULL));
    c.cells = 0;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bq_pack_init(&p, &c));
    setUp();
    c.cell_ov_clear_mv = c.cell_ov_mv;
    TEST_ASSERT_EQUAL(BQ_E_CONFIG, bq_pack_init(&p, &c));
    TEST_ASSERT_EQUAL_MEMORY(&before, &p, sizeof p);
    setUp();
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_init(&p, &c));
    TEST_ASSERT_EQUAL(BQ_PACK_INIT, p.state);
    TEST_ASSERT_EQUAL(-1, p.summary.soc_permille);
    memset(&before, 0, sizeof before);
    TEST_ASSERT_EQUAL(BQ_OK, bq_pack_init(&before, &c));
    TEST_ASSERT_EQUAL_MEMORY(&before, &p, sizeof p); /* whatever lay in the memory before */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_defaults_of_both_chemistries_are_accepted);
    RUN_TEST(test_every_field_can_be_set_and_read_at_both_ends_of_its_range);
    RUN_TEST(test_names_reach_their_own_field);
    RUN_TEST(test_what_lies_outside_is_refused_and_changes_nothing);
    RUN_TEST(test_the_offending_field_is_named);
    RUN_TEST(test_contradictions_are_named);
    RUN_TEST(test_what_is_switched_off_contradicts_nothing);
    RUN_TEST(test_init_refuses_what_validation_refuses_and_changes_nothing);
    return UNITY_END();
}
