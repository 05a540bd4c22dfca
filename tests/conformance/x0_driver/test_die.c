/* SPDX-License-Identifier: Apache-2.0 */
/* The die beside thermistors: looked at every so often while cells are bled, never taken for a thermistor,
 * and hot it ends balancing long before the part would shut down. */
#include "bench.h"
#include <math.h>

void setUp(void)
{
}
void tearDown(void)
{
}

static double ohms_at(double celsius)
{
    return 10000.0 * exp(3435.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15));
}

static void thermistors(double celsius)
{
    int t;
    for (t = 1; t <= b.chip.part->cells / 5; t++)
        (void)sim_x0_set_ts(&b.chip, t, ohms_at(celsius));
}

static void bleeding(const char *name, uint8_t check_s)
{
    bench_part(name, NULL);
    b.cfg.die_check_s = check_s;
    thermistors(30);
    (void)sim_x0_set_tdie(&b.chip, 55);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    b.action.balance[0] = 0x15;
    bench_serve(3000, 250);
    TEST_ASSERT_EQUAL_HEX16(0x15, sim_x0_cb(&b.chip));
}

static void temperatures_are(double celsius)
{
    int t;
    for (t = 0; t < b.sample.temp_count; t++)
        if (b.temps[t].quality & BQ_Q_VALID)
            TEST_ASSERT_INT_WITHIN(3, (int)(celsius * 10), b.temps[t].dc);
}

/* Times between the switches of the source, from the bus. */
/* proves: X0-SEQ-44, X0-SEQ-43, X0-DIE-01, X0-DIE-02, X0-AMB-29, X0-TIM-14 */
static void test_the_look_at_the_die(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t n, from, to_die = 0, looks = 0;
        int16_t dc = 0;
        uint32_t age = 0;
        bool die = false;
        bleeding(sim_x0_part_at(k)->name, 0);
        from = n = b.count;
        while (b.chip.now < 200000 * MS) {
            bench_serve(250, 250);
            temperatures_are(30); /* the die's 55 degC are nobody's thermistor */
            TEST_ASSERT_TRUE(b.temps[0].quality & BQ_Q_VALID);
            TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
            for (; n < b.count; n++) {
                const bench_entry *e = bench_log(n);
                bool sel;
                if (e->wrote == 0 || e->reg != 4)
                    continue;
                sel = (e->data[0] & 0x08) != 0;
                TEST_ASSERT_EQUAL_HEX8(0x10, e->data[0] & ~0x08);
                if (!sel && !die) {
                    if (looks > 0) /* every 60 s */
                        TEST_ASSERT_TRUE(e->t_ns - to_die > 50000 * MS && e->t_ns - to_die < 75000 * MS);
                    to_die = e->t_ns;
                    looks++;
                }
                if (sel && die) /* 2.25 s for the registers to follow, and no longer than needed */
                    TEST_ASSERT_TRUE(e->t_ns - to_die >= 2250 * MS && e->t_ns - to_die < 5000 * MS);
                die = !sel;
            }
        }
        TEST_ASSERT_TRUE(looks >= 2 && looks <= 4);
        TEST_ASSERT_TRUE(b.count > from);
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_get_die(&b.d, &dc, &age));
        TEST_ASSERT_INT_WITHIN(2, 550, dc);
        TEST_ASSERT_TRUE(age < 75000);
        NO_MISUSE();
    }
}

/* A thermistor that changes while the die is looked at: old for 10 s at most, then the new one or none. */
/* proves: X0-SEQ-44 */
static void test_thermistors_are_never_older_than_ten_seconds(void)
{
    int round;
    bleeding("bq7694003", 10);
    for (round = 0; round < 40; round++) {
        double celsius = 30 + 10 * (round & 1);
        uint64_t changed;
        bench_wait(137 * round % 1000);
        thermistors(celsius);
        changed = b.chip.now;
        while (b.chip.now < changed + 14000 * MS) {
            bench_serve(250, 250);
            if (b.chip.now > changed + 12500 * MS) /* 10 s and what a sensor of this part takes anyway */
                temperatures_are(celsius);
        }
    }
    NO_MISUSE();
}

/* proves: X0-DIE-05, X0-CB-12, X0-AMB-76, X0-SEQ-38, X0-SEQ-41 */
static void test_a_hot_die_ends_balancing(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t from;
        bleeding(sim_x0_part_at(k)->name, 20);
        (void)sim_x0_set_tdie(&b.chip, 84); /* just inside the limit of 85 */
        bench_serve(60000, 250);
        TEST_ASSERT_TRUE(sim_x0_cb(&b.chip) != 0);
        (void)sim_x0_set_tdie(&b.chip, 87); /* well below 100 */
        from = b.chip.now;
        while (sim_x0_cb(&b.chip) != 0 && b.chip.now < from + 60000 * MS)
            bench_serve(250, 250);
        TEST_ASSERT_TRUE(b.chip.now - from < 30000 * MS);
        bench_serve(60000, 250);
        TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
        TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) &&
                         sim_x0_dsg(&b.chip)); /* hot for balancing, not for the pack */
        (void)sim_x0_set_tdie(&b.chip, 97);
        bench_serve(60000, 250);
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_DIE_TEMP);
        (void)sim_x0_set_tdie(&b.chip, 60);
        from = b.chip.now;
        while (sim_x0_cb(&b.chip) == 0 && b.chip.now < from + 60000 * MS)
            bench_serve(250, 250);
        TEST_ASSERT_TRUE(sim_x0_cb(&b.chip) != 0);
        bench_serve(1000, 250);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        NO_MISUSE();
    }
}

/* proves: X0-SEQ-38, X0-DIE-05 */
static void test_a_hot_die_where_it_is_the_only_sensor(void)
{
    bench_part("bq7692000", NULL);
    b.cfg.sensors = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    b.action.balance[0] = 0x5;
    bench_serve(3000, 250);
    TEST_ASSERT_EQUAL_HEX16(0x5, sim_x0_cb(&b.chip));
    (void)sim_x0_set_tdie(&b.chip, 90);
    bench_serve(3000, 250);
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
    NO_MISUSE();
}

/* proves: X0-DIE-04 */
static void test_a_value_of_the_production(void)
{
    int16_t dc = 0;
    bench_part("bq7692000", NULL);
    b.cfg.sensors = 0;
    b.cfg.die_v25_uv = 1242000; /* this sensor gives 42 mV more: 10 degrees */
    (void)sim_x0_set_tdie(&b.chip, 25);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2500, 250);
    TEST_ASSERT_INT_WITHIN(2, 350, b.temps[0].dc);
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_get_die(&b.d, &dc, &(uint32_t){0}));
    TEST_ASSERT_INT_WITHIN(2, 350, dc);
}

/* The look is disturbed in every way at every switch: the source is the wanted one in the end. */
/* proves: X0-SEQ-44, X0-SEQ-43, X0-SEQ-49 */
static void test_every_switch_fails_once(void)
{
    int kind, n;
    for (kind = SPOIL_LOST; kind < SPOIL_FLIP; kind++)
        for (n = 1; n <= 6; n++) {
            uint64_t end;
            bleeding("bq7693003", 10);
            b.spoil_writes = true;
            b.spoil_reg = 4;
            b.spoil_seen = 0;
            b.spoil_at = (uint64_t)n;
            b.spoil_kind = (spoil)kind;
            end = b.chip.now + 40000 * MS;
            while (b.chip.now < end) {
                bench_serve(250, 250);
                temperatures_are(30);
            }
            b.spoil_at = 0;
            b.action.balance[0] = 0;
            bench_serve(12000, 250);
            TEST_ASSERT_EQUAL_HEX8(0x18, sim_x0_peek(&b.chip, 4) & 0x1f);
            TEST_ASSERT_TRUE(b.temps[0].quality & BQ_Q_VALID);
            NO_MISUSE();
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_look_at_the_die);
    RUN_TEST(test_thermistors_are_never_older_than_ten_seconds);
    RUN_TEST(test_a_hot_die_ends_balancing);
    RUN_TEST(test_a_hot_die_where_it_is_the_only_sensor);
    RUN_TEST(test_a_value_of_the_production);
    RUN_TEST(test_every_switch_fails_once);
    return UNITY_END();
}
