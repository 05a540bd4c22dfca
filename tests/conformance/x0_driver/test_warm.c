/* SPDX-License-Identifier: Apache-2.0 */
/* The host is reset while a fault of the part stands: a fault that was not released before the reset is not
 * released by it (X0-SEQ-06, X0-SEQ-28, X0-SEQ-29). */
#include "bench.h"

void setUp(void)
{
}
void tearDown(void)
{
}

typedef struct standing {
    uint8_t bit;
    uint16_t flag;
    void (*strike)(void);
    void (*cure)(void);
    bool charge, discharge; /* may be on while it stands */
} standing;

static void cell_high(void)
{
    (void)sim_x0_set_cell(&b.chip, 2, 4.3);
    bench_wait(2500);
}

static void cell_low(void)
{
    (void)sim_x0_set_cell(&b.chip, 2, 2.7);
    bench_wait(2500);
}

static void cell_good(void)
{
    (void)sim_x0_set_cell(&b.chip, 2, 3.6);
}

/* The load that did it stays: it pulls CHG up when that is off. */
static void short_circuit(void)
{
    (void)sim_x0_set_chgpin(&b.chip, 3.0);
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(0.2);
    (void)sim_x0_set_sense(&b.chip, 0);
}

static void overcurrent(void)
{
    (void)sim_x0_set_chgpin(&b.chip, 3.0);
    (void)sim_x0_set_sense(&b.chip, -0.045);
    bench_wait(400);
    (void)sim_x0_set_sense(&b.chip, 0);
}

static void load_gone(void)
{
    (void)sim_x0_set_chgpin(&b.chip, 0.0);
}

static void alert_held(void)
{
    bench_wait(20);
    b.chip.reg[0] = 0; /* nothing that the part itself holds ALERT high for */
    (void)sim_x0_set_alert_ext(&b.chip, true);
}

static void alert_free(void)
{
    (void)sim_x0_set_alert_ext(&b.chip, false);
}

static const standing faults[] = {
    {0x04, BQ_F_CELL_OV, cell_high, cell_good, false, true},
    {0x08, BQ_F_CELL_UV, cell_low, cell_good, true, false},
    {0x01, BQ_F_OVERCURRENT, overcurrent, load_gone, false, false},
    {0x02, BQ_F_SHORT, short_circuit, load_gone, false, false},
    {0x10, BQ_F_CHAIN, alert_held, alert_free, false, false},
};

/* `sticks`: the reading in which the part lets a FET bit be set although its fault stands (X0-AMB-50). */
static void on_duty(const char *name, bool sticks)
{
    sim_x0_options o;
    memset(&o, 0, sizeof o);
    o.amb50_write_sticks = sticks;
    bench_part(name, &o);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static void restart(bool keep)
{
    b.cfg.keep_fets = keep;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
}

static void only_what_helps(const standing *f)
{
    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) && !f->charge);
    TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip) && !f->discharge);
}

/* proves: X0-SEQ-06, X0-SEQ-18, X0-SEQ-28, X0-SEQ-29, X0-SEQ-30, X0-SEQ-31, X0-SEQ-32, X0-SEQ-34, X0-MODE-18
 */
static void test_a_standing_fault_outlives_the_reset_of_the_host(void)
{
    static const char *const name[3] = {"bq7692000", "bq7693003", "bq7694006"};
    for (int k = 0; k < 3; k++)
        for (int keep = 0; keep < 2; keep++)
            for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
                const standing *f = &faults[i];
                on_duty(name[k], k == 1);
                f->strike();
                TEST_ASSERT_EQUAL_HEX8(f->bit, b.chip.reg[0] & f->bit); /* nobody has served it */
                restart(keep != 0);
                TEST_ASSERT_EQUAL(BQ_E_STATE, bench_apply(true, true, 0)); /* before the first scan */
                only_what_helps(f);
                for (int n = 0; n < 80; n++) { /* 20 s: the cause is still there */
                    bench_serve(250, 250);
                    only_what_helps(f);
                }
                TEST_ASSERT_EQUAL_HEX16(f->flag, b.module.faults);
                f->cure();
                TEST_ASSERT_TRUE(bench_until(true, true, 15000) < 15000);
                bench_serve(250, 250);
                TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
                NO_MISUSE();
            }
}

/* The internal fault likewise: measurements are not used, and FETs come back after its 3 s and the rest. */
/* proves: X0-SEQ-06, X0-SEQ-35, X0-XRDY-04 */
static void test_a_standing_internal_fault(void)
{
    for (int sticks = 0; sticks < 2; sticks++) {
        on_duty("bq7693003", sticks != 0);
        TEST_ASSERT_EQUAL(0, sim_x0_strike_xready(&b.chip));
        restart(false);
        TEST_ASSERT_EQUAL(BQ_E_STATE, bench_apply(true, true, 0));
        TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
        bench_serve(2500, 250);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, b.module.faults);
        TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
        TEST_ASSERT_TRUE(b.chip.reg[0] & 0x20);
        TEST_ASSERT_TRUE(bench_until(true, true, 20000) < 20000);
        NO_MISUSE();
    }
}

/* Flags that are older than a boot are cleared by it (X0-SEQ-18): the part was in SHIP meanwhile. */
/* proves: X0-SEQ-18 */
static void test_after_a_boot_nothing_is_held(void)
{
    on_duty("bq7692003", false);
    short_circuit();
    TEST_ASSERT_EQUAL_HEX8(0x02, b.chip.reg[0] & 0x02);
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(2000));
    load_gone();
    restart(false);
    TEST_ASSERT_TRUE(bench_until(true, true, 1000) < 1000);
    NO_MISUSE();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_standing_fault_outlives_the_reset_of_the_host);
    RUN_TEST(test_a_standing_internal_fault);
    RUN_TEST(test_after_a_boot_nothing_is_held);
    return UNITY_END();
}
