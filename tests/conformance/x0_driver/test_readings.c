/* SPDX-License-Identifier: Apache-2.0 */
/* The driver under every other reading of what the datasheet leaves open, and under what was seen in the
 * field: each option of the model, on each of the fifteen parts, through a whole life. */
#include "bench.h"
#include "rows.h"
#include <stddef.h>
#include <stdio.h>

void setUp(void)
{
}
void tearDown(void)
{
}

typedef struct reading {
    const char *name;
    size_t at; /* of the option */
} reading;

#define READING(field) {#field, offsetof(sim_x0_options, field)}

static const reading readings[] = {
    READING(amb10_bat_rounds),    READING(amb16_like_boot),      READING(amb25_ready_ignored),
    READING(amb26_finishes),      READING(amb42_full_delay),     READING(amb43_at_once),
    READING(amb50_write_sticks),  READING(amb53_edge),           READING(amb63_faults_clear_cb),
    READING(amb65_config_lost),   READING(amb66_upper_zero),     READING(amb69_i2c_at_boot),
    READING(amb71_needs_00),      READING(amb72_shut_reads_0),   READING(amb83_pointer_lost),
    READING(amb86_nack),          READING(amb88_nibble_reads_8), READING(field_zero_boot),
    READING(field_nibble_offset), READING(field_alert_high),
};
#define READINGS (sizeof readings / sizeof readings[0])

static const char *reading_name, *part_name;

static void demand(bool met, const char *what)
{
    if (!met) {
        char text[160];
        (void)snprintf(text, sizeof text, "%s under %s: %s", part_name, reading_name, what);
        TEST_FAIL_MESSAGE(text);
    }
}

static bool truth(double volts)
{
    bool all = b.sample.cell_count == b.cfg.cells;
    unsigned c;
    for (c = 0; c < b.sample.cell_count; c++)
        all = all && b.cells[c].quality == BQ_Q_VALID && b.cells[c].mv + 1.0 >= volts * 1000 &&
              b.cells[c].mv <= volts * 1000 + 1.0;
    return all;
}

static bool on(uint32_t limit)
{
    return bench_until(true, true, limit) < limit;
}

static void a_fault(const char *what, uint16_t flag)
{
    bench_serve(1000, 250);
    demand((b.module.faults & flag) != 0, what);
    demand(!sim_x0_chg(&b.chip) || !sim_x0_dsg(&b.chip), "both FETs on during a fault");
    demand(sim_x0_cb(&b.chip) == 0, "balancing during a fault");
}

static void voltage_faults(void)
{
    (void)sim_x0_set_cell(&b.chip, 2, 4.3);
    bench_serve(1500, 250);
    a_fault("no OV", BQ_F_CELL_OV);
    (void)sim_x0_set_cell(&b.chip, 2, 3.6);
    demand(on(12000), "OV never ends");
    (void)sim_x0_set_cell(&b.chip, 2, 2.6);
    bench_serve(1500, 250);
    a_fault("no UV", BQ_F_CELL_UV);
    (void)sim_x0_set_cell(&b.chip, 2, 3.6);
    demand(on(12000), "UV never ends");
}

static void current_faults(void)
{
    (void)sim_x0_set_sense(&b.chip, -0.045);
    bench_wait(500);
    (void)sim_x0_set_sense(&b.chip, 0);
    a_fault("no OCD", BQ_F_OVERCURRENT);
    demand(on(15000), "OCD never ends");
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(1);
    (void)sim_x0_set_sense(&b.chip, 0);
    a_fault("no SCD", BQ_F_SHORT);
    demand(on(15000), "SCD never ends");
}

/* A persistent short: the driver must not turn the FETs on against it, whichever way a cleared bit returns.
 */
static void a_short_that_stays(void)
{
    uint64_t n;
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_serve(5000, 250);
    n = b.count;
    bench_serve(10000, 250);
    demand(!sim_x0_dsg(&b.chip), "discharging into a short");
    demand(bench_writes(n, 0, NULL) < 80, "loops on clearing");
    (void)sim_x0_set_sense(&b.chip, 0);
    bq769x0_unlock(&b.d);
    demand(on(30000), "the short never ends");
}

static void pin_and_internal_faults(void)
{
    bench_serve(11000, 250);
    (void)bench_scan();
    (void)sim_x0_set_alert_ext(&b.chip, true); /* while the part does not drive the pin (X0-ALERT-05) */
    bench_serve(500, 250);
    a_fault("no override", BQ_F_CHAIN);
    (void)sim_x0_set_alert_ext(&b.chip, false);
    demand(on(15000), "the override never ends");
    bench_serve(11000, 250);
    (void)sim_x0_strike_xready(&b.chip);
    a_fault("no XREADY", BQ_F_MEMORY);
    demand(!truth(3.6), "values called valid while the part reports an internal fault");
    demand(on(20000), "XREADY never ends");
}

static void configuration_is_as_asked(void)
{
    const bq769x0_achieved *a = bq769x0_get_achieved(&b.d);
    demand(sim_x0_peek(&b.chip, 0x06) == a->current.protect1, "PROTECT1");
    demand(sim_x0_peek(&b.chip, 0x07) == a->current.protect2, "PROTECT2");
    demand(sim_x0_peek(&b.chip, 0x09) == a->ov_trip, "OV_TRIP");
    demand(sim_x0_peek(&b.chip, 0x0a) == a->uv_trip, "UV_TRIP");
    demand(sim_x0_peek(&b.chip, 0x0b) == 0x19, "CC_CFG");
    demand((sim_x0_peek(&b.chip, 0x08) & 0x0f) == (b.chip.options.amb88_nibble_reads_8 ? 8 : 0),
           "PROTECT3's low nibble is not as it came up");
}

static void current_is_true(void)
{
    (void)sim_x0_set_sense(&b.chip, 0.010);
    bench_serve(1000, 250);
    demand(b.sample.current_valid && b.sample.current_ma > 1998 && b.sample.current_ma < 2002, "current");
    demand(bq769x0_begin_oneshot(&b.d) == BQ_OK && bench_run(3000) == BQ_OK, "one-shot");
    (void)bench_picture();
    demand(b.sample.current_ma > 1998 && b.sample.current_ma < 2002, "current of the one-shot");
    (void)sim_x0_set_sense(&b.chip, 0);
}

/* The counter may run without CC_CFG between the loss of the configuration and the next look at it. */
static void book_is_empty(const reading *r)
{
    sim_misuse *m = sim_x0_misuse(&b.chip);
    uint32_t excused = strcmp(r->name, "amb65_config_lost") == 0 ? sim_misuse_of(m, "X0-CC-10") : 0;
    if (m->count != excused)
        demand(false, m->entry[0].text);
}

static void life(const reading *r, const sim_x0_part *part)
{
    sim_x0_options o;
    memset(&o, 0, sizeof o);
    *(bool *)((char *)&o + r->at) = true;
    reading_name = r->name;
    part_name = part->name;
    bench_part(part->name, &o);
    demand(bench_init() == BQ_OK && bench_start() == BQ_OK, "bring-up");
    demand(bq769x0_get_achieved(&b.d)->crc == part->crc, "CRC option");
    configuration_is_as_asked();
    bench_cells(3.61);
    bench_serve(2500, 250);
    demand(truth(3.61), "measurement");
    bench_cells(3.6);
    demand(on(5000), "FETs never come on");
    current_is_true();
    b.action.balance[0] = 0x5;
    bench_serve(1000, 250);
    demand(sim_x0_cb(&b.chip) == 0x5, "balancing");
    voltage_faults();
    current_faults();
    a_short_that_stays();
    pin_and_internal_faults();
    configuration_is_as_asked();
    demand(bq769x0_begin_ship(&b.d) == BQ_OK && bench_run(3000) == BQ_OK, "SHIP");
    demand(b.chip.mode == SIM_X0_SHIP, "still awake");
    demand(bench_start() == BQ_OK, "second bring-up");
    bench_serve(2500, 250);
    demand(truth(3.6), "measurement after SHIP");
    book_is_empty(r);
}

/* proves: X0-AMB-10, X0-AMB-16, X0-AMB-25, X0-AMB-26, X0-AMB-42, X0-AMB-43, X0-AMB-50, X0-AMB-53, X0-AMB-63,
   X0-AMB-65, X0-AMB-66, X0-AMB-69, X0-AMB-71, X0-AMB-72, X0-AMB-83, X0-AMB-86, X0-AMB-88 */
static void test_every_reading_on_every_part(void)
{
    size_t r;
    int k;
    for (r = 0; r < READINGS; r++)
        for (k = 0; k < 15; k++)
            life(&readings[r], sim_x0_part_at(k));
}

/* PROTECT3's low nibble comes up as 8 and must stay 8: writing 0 over it and reading it shifts the current.
 */
/* proves: X0-AMB-88, X0-REG-08 */
static void test_the_low_nibble_of_protect3_is_kept(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        sim_x0_options o;
        memset(&o, 0, sizeof o);
        o.amb88_nibble_reads_8 = o.field_nibble_offset = true;
        bench_part(sim_x0_part_at(k)->name, &o);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_serve(3000, 250);
        TEST_ASSERT_EQUAL_HEX8(0x08, sim_x0_peek(&b.chip, 0x08));
        TEST_ASSERT_INT_WITHIN(1, 0, b.sample.current_ma);
        NO_MISUSE();
    }
}

/* About one boot in a hundred reads zeros everywhere, the trim too. */
/* proves: X0-SEQ-11, X0-AMB-17 */
static void test_a_boot_that_reads_zero_is_repeated(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        sim_x0_options o;
        memset(&o, 0, sizeof o);
        o.field_zero_boot = true;
        bench_part(sim_x0_part_at(k)->name, &o);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(2, b.rises);
        TEST_ASSERT_EQUAL(382, bq769x0_get_achieved(&b.d)->trim.gain_uv);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_reading_on_every_part);
    RUN_TEST(test_the_low_nibble_of_protect3_is_kept);
    RUN_TEST(test_a_boot_that_reads_zero_is_repeated);
    return UNITY_END();
}
