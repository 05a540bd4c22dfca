/* SPDX-License-Identifier: Apache-2.0 */
/* The die temperature: beside thermistors by switching over, alone where it is the source; what too hot a die
 * ends. */
#include "x0_rig.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static bool die_selected(void)
{
    return (rig_reg(0x04) & 0x08u) == 0u;
}

/* Time with a scan and an apply every 250 ms. */
static void balance(unsigned ms, uint32_t cells)
{
    for (unsigned t = 0; t < ms; t += 250u) {
        rig_pass(250);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, cells));
    }
}

static void up(const char *part, unsigned cells)
{
    rig_up(part, cells);
    for (unsigned i = 1; i <= cells / 5u; i++) {
        TEST_ASSERT_EQUAL_INT(0, sim_x0_set_ts(&rig.chip, (int)i, 8269.0)); /* 30 degrees */
    }
    (void)sim_x0_set_tdie(&rig.chip, 40.0);
    rig_pass(5000);
}

/* proves: X0-SEQ-43, X0-SEQ-44, X0-DIE-01, X0-DIE-02, X0-AMB-29 */
static void test_a_look_at_the_die_between_thermistor_values(void)
{
    static const char *const part[] = {"bq7692003", "bq7693003", "bq7694003"};
    for (unsigned k = 0; k < 3u; k++) {
        unsigned at_die_ms = 0, looks = 0, first_ms = 0, second_ms = 0;
        bool before = false;
        int16_t dc = 0;
        uint32_t age_ms;
        up(part[k], 5u * (k + 1u));
        TEST_ASSERT_EQUAL_INT(BQ_E_STALE, bq769x0_get_die(&rig.d, &dc, &age_ms));
        for (unsigned t = 0; t < 90000u; t += 250u) {
            balance(250, 1);
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
            for (unsigned i = 0; i <= k; i++) { /* never the die's value, never a gap */
                TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.temps[i].quality);
                TEST_ASSERT_INT_WITHIN(3, 300, rig.temps[i].dc);
            }
            if (die_selected() && !before) {
                looks++;
                first_ms = looks == 1u ? t : first_ms;
                second_ms = t;
            }
            before = die_selected();
            at_die_ms += before ? 250u : 0u;
        }
        TEST_ASSERT_EQUAL_UINT(2, looks);
        TEST_ASSERT_UINT_WITHIN(3000, 60000, second_ms - first_ms);
        TEST_ASSERT_TRUE(at_die_ms >= 2u * 2250u && at_die_ms <= 2u * 3000u);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_get_die(&rig.d, &dc, &age_ms));
        TEST_ASSERT_INT_WITHIN(2, 400, dc);
        TEST_ASSERT_TRUE(age_ms < 60000u);
        rig_clean();
    }
}

/* proves: X0-SEQ-44 */
static void test_no_look_when_nothing_is_bled_or_none_is_wanted(void)
{
    for (unsigned never = 0; never < 2u; never++) {
        rig_part("bq7692003", 5);
        rig.config.die_check_s = never != 0u ? BQ769X0_DIE_NEVER : 0u;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
        for (unsigned t = 0; t < 130000u; t += 250u) {
            balance(250, never);
            TEST_ASSERT_FALSE(die_selected());
        }
    }
}

/* proves: X0-DIE-05, X0-CB-12, X0-SEQ-38, X0-SEQ-41 */
static void test_a_hot_die_ends_balancing_until_it_is_cooler(void)
{
    up("bq7692003", 5);
    balance(6000, 1);
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&rig.chip));
    (void)sim_x0_set_tdie(&rig.chip, 90.0);
    balance(65000, 1);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    TEST_ASSERT_EQUAL_HEX16(0, rig_faults()); /* no fault yet: the FETs stay on */
    TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
    (void)sim_x0_set_tdie(&rig.chip, 80.0); /* below the limit, but not by the hysteresis */
    balance(65000, 1);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    (void)sim_x0_set_tdie(&rig.chip, 70.0);
    balance(65000, 1);
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&rig.chip));
    (void)sim_x0_set_tdie(&rig.chip, 97.0);
    balance(65000, 1);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_DIE_TEMP, rig_faults());
    (void)sim_x0_set_tdie(&rig.chip, 60.0);
    balance(130000, 0); /* looked at again although nothing is asked for */
    TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
    rig_clean();
}

/* proves: X0-DIE-05, X0-DIE-04 */
static void test_the_die_as_only_source(void)
{
    rig_part("bq7693003", 10);
    rig.config.sensors = 0;
    rig.config.sensor = NULL;
    rig.config.die_limit_dc = 600;
    rig.config.die_v25_uv = 1221000; /* this one reads 5 degrees low by the book */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    (void)sim_x0_set_tdie(&rig.chip, 40.0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    balance(3000, 1);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    TEST_ASSERT_INT_WITHIN(2, 450, rig.temps[0].dc);
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&rig.chip));
    (void)sim_x0_set_tdie(&rig.chip, 57.0);
    balance(3000, 1); /* as fast as the part converts */
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    rig_clean();
}

/* A bus that fails at every moment of the look: temperatures are the thermistors' or not valid. */
/* proves: X0-SEQ-44, X0-SEQ-43 */
static void test_a_bus_that_fails_during_the_look(void)
{
    for (unsigned from = 0; from < 24u; from++) {
        for (unsigned length = 1; length <= 61u; length += 12u) { /* 250 ms to 15 s */
            bool returned = false;
            up("bq7692003", 5);
            for (unsigned n = 0; n < 140u; n++) {
                bool dead = n >= from && n < from + length;
                sim_x0_bus(&rig.chip)->dead = dead ? 2 : 0;
                (void)rig_scan();
                (void)rig_apply(true, true, 1);
                rig_wait_ms(200);
                TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
                if ((rig.temps[0].quality & BQ_Q_VALID) != 0u) {
                    TEST_ASSERT_INT_WITHIN(3, 300, rig.temps[0].dc);
                    returned = n > from + length;
                }
            }
            TEST_ASSERT_TRUE(returned);
            TEST_ASSERT_FALSE(rig.d.die_hot ||
                              rig.d.die.fault); /* no value of a thermistor was taken for the die's */
        }
    }
}

/* proves: X0-SEQ-43 */
static void test_a_reset_during_the_look(void)
{
    up("bq7692003", 5);
    balance(1000, 1);
    TEST_ASSERT_TRUE(die_selected());
    (void)sim_x0_set_supply(&rig.chip, false);
    (void)sim_x0_set_supply(&rig.chip, true);
    (void)sim_x0_boot(&rig.chip, 3000000);
    rig_wait_ms(1000);
    for (unsigned n = 0; n < 40u; n++) {
        rig_pass(250);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
        if ((rig.temps[0].quality & BQ_Q_VALID) != 0u) {
            TEST_ASSERT_INT_WITHIN(3, 300, rig.temps[0].dc);
        }
    }
    TEST_ASSERT_FALSE(die_selected());
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.temps[0].quality);
}

/* proves: X0-DIE-02 */
static void test_a_sensor_that_gives_no_temperature(void)
{
    int16_t dc;
    uint32_t age_ms;
    up("bq7692003", 5);
    (void)sim_x0_set_tdie(&rig.chip, 300.0);
    balance(6000, 1);
    TEST_ASSERT_EQUAL_INT(BQ_E_STALE, bq769x0_get_die(&rig.d, &dc, &age_ms));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip)); /* unknown is too hot for balancing */
    TEST_ASSERT_EQUAL_HEX16(0, rig_faults());
}

static void test_what_init_refuses(void)
{
    static const struct {
        int16_t limit_dc, fault_dc;
        uint8_t check_s;
        uint32_t v25_uv;
    } bad[] = {{-1, 0, 0, 0}, {951, 0, 0, 0},     {0, -1, 0, 0},     {0, 1001, 0, 0},
               {0, 0, 4, 0},  {0, 0, 0, 1099999}, {0, 0, 0, 1300001}};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        rig_part("bq7692003", 5);
        rig.config.die_limit_dc = bad[i].limit_dc;
        rig.config.die_fault_dc = bad[i].fault_dc;
        rig.config.die_check_s = bad[i].check_s;
        rig.config.die_v25_uv = bad[i].v25_uv;
        TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, rig_init());
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_look_at_the_die_between_thermistor_values);
    RUN_TEST(test_no_look_when_nothing_is_bled_or_none_is_wanted);
    RUN_TEST(test_a_hot_die_ends_balancing_until_it_is_cooler);
    RUN_TEST(test_the_die_as_only_source);
    RUN_TEST(test_a_bus_that_fails_during_the_look);
    RUN_TEST(test_a_reset_during_the_look);
    RUN_TEST(test_a_sensor_that_gives_no_temperature);
    RUN_TEST(test_what_init_refuses);
    return UNITY_END();
}
