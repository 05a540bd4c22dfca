/* SPDX-License-Identifier: Apache-2.0 */
/* DEVICE_XREADY, several faults at once, probation, and what the scrub finds: lost settings and lost parts.
 */
#include "bench.h"
#include "rows.h"

#define PERIOD 100

void setUp(void)
{
}
void tearDown(void)
{
}

static void on_duty_with(const char *name, const sim_x0_options *options)
{
    bench_part(name, options);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    TEST_ASSERT_TRUE(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip));
}

static void on_duty(const char *name)
{
    on_duty_with(name, NULL);
}

static uint32_t until_on(uint32_t limit)
{
    return bench_until_on(limit, PERIOD);
}

/* proves: X0-SEQ-35, X0-XRDY-03, X0-XRDY-04, X0-TIM-15, X0-AMB-65, X0-AMB-66, X0-AMB-104, X0-SEQ-41 */
static void test_internal_fault(void)
{
    int k, way;
    for (k = 0; k < 15; k++)
        for (way = 0; way < 2; way++) {
            sim_x0_options o;
            uint64_t struck, n;
            bool cleared = false;
            memset(&o, 0, sizeof o);
            o.amb66_upper_zero = way;
            on_duty_with(sim_x0_part_at(k)->name, &o);
            b.action.balance[0] = 1;
            bench_serve(250, 250);
            TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&b.chip));
            (void)sim_x0_strike_xready(&b.chip);
            struck = b.chip.now;
            n = b.count;
            while (!sim_x0_chg(&b.chip) || !sim_x0_dsg(&b.chip)) {
                bench_serve(PERIOD, PERIOD);
                if (b.chip.reg[0] & 0x20) { /* no value counts, nothing is on, nothing is cleared for 3 s */
                    TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, b.module.faults);
                    TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
                    TEST_ASSERT_FALSE(b.temps[0].quality & BQ_Q_VALID);
                    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&b.chip));
                    TEST_ASSERT_EQUAL_HEX8(0, sim_x0_peek(&b.chip, 5) & 3);
                } else if (!cleared) {
                    cleared = true;
                    TEST_ASSERT_TRUE(b.chip.now - struck >= 3000 * MS);
                    TEST_ASSERT_TRUE(b.chip.now - struck < 3500 * MS);
                }
                TEST_ASSERT_TRUE(b.chip.now - struck < 20000 * MS);
            }
            /* 3 s, clear for 1 s, one scan and 2 s for the readings */
            TEST_ASSERT_TRUE(b.chip.now - struck >= 3000 * MS + 1000 * MS + 2000 * MS);
            TEST_ASSERT_TRUE(bench_writes(n, 0x06, NULL) >= 1); /* everything was written again */
            TEST_ASSERT_TRUE(bench_writes(n, 0x0b, NULL) >= 1);
            NO_MISUSE();
        }
}

/* proves: X0-SEQ-35, X0-AMB-105, X0-AMB-65 */
static void test_internal_fault_that_stays_is_not_cleared_for_ever(void)
{
    int k;
    for (k = 0; k < 15; k++) {
        uint64_t from, n;
        bq_status s = BQ_OK;
        unsigned clears = 0;
        on_duty(sim_x0_part_at(k)->name);
        (void)sim_x0_strike_xready(&b.chip);
        from = b.chip.now;
        n = b.count;
        while (s == BQ_OK && b.chip.now < from + 120000 * MS) {
            s = bench_scan();
            if (s == BQ_OK)
                (void)bench_apply(true, true, 0);
            if ((b.chip.reg[0] & 0x20) == 0 && b.chip.mode == SIM_X0_NORMAL)
                (void)sim_x0_strike_xready(&b.chip); /* the cause is still there */
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip) || sim_x0_dsg(&b.chip));
            bench_wait(PERIOD);
        }
        TEST_ASSERT_EQUAL(BQ_E_DEFECTIVE, s);
        TEST_ASSERT_TRUE(b.chip.now - from >= (3000 + 6000 + 12000) * MS);
        for (; n < b.count; n++)
            clears += bench_log(n)->wrote == 1 && bench_log(n)->reg == 0 && (bench_log(n)->data[0] & 0x20);
        TEST_ASSERT_EQUAL(3, clears);
        TEST_ASSERT_EQUAL(SIM_X0_SHIP, b.chip.mode);
        TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
        TEST_ASSERT_TRUE(b.module.faults & BQ_F_DEFECTIVE);
        TEST_ASSERT_EQUAL(BQ_OK, bench_start()); /* a new bring-up boots it again */
        TEST_ASSERT_TRUE(until_on(20000) < 20000);
        NO_MISUSE();
    }
}

static void cause(int kind, bool there)
{
    switch (kind) {
    case 0:
        (void)sim_x0_set_cell(&b.chip, 1, there ? 4.3 : 3.6);
        break;
    case 1:
        (void)sim_x0_set_cell(&b.chip, 2, there ? 2.6 : 3.6);
        break;
    case 2:
        (void)sim_x0_set_chgpin(&b.chip, there ? 3.0 : 0.0);
        if (there) {
            (void)sim_x0_set_sense(&b.chip, -0.150);
            bench_wait(0.2);
            (void)sim_x0_set_sense(&b.chip, 0);
        }
        break;
    case 3:
        (void)bench_scan();
        (void)sim_x0_set_alert_ext(&b.chip, there);
        break;
    default:
        if (there)
            (void)sim_x0_strike_xready(&b.chip);
        break;
    }
}

/* Every pair, in both orders: while one cause remains, the FETs it forbids stay off, and when the last is
   gone everything comes back. */
/* proves: X0-SEQ-36, X0-SEQ-28, X0-SEQ-37, X0-AMB-104 */
static void test_every_pair_of_faults(void)
{
    static const uint8_t forbids[5] = {1, 2, 3, 3, 3}; /* CHG = 1, DSG = 2 */
    static const uint16_t flag[5] = {BQ_F_CELL_OV, BQ_F_CELL_UV, BQ_F_SHORT, BQ_F_CHAIN, BQ_F_MEMORY};
    int a, c;
    for (a = 0; a < 5; a++)
        for (c = 0; c < 4; c++) { /* an internal fault strikes once and has no cause that remains */
            int n;
            if (a == c)
                continue;
            on_duty("bq7694003");
            cause(c, true);
            bench_serve(2500, PERIOD);
            cause(a, true);
            bench_serve(2500, PERIOD);
            TEST_ASSERT_TRUE(b.module.faults & flag[c]);
            cause(a, false);
            for (n = 0; n < 200; n++) {
                bench_serve(PERIOD, PERIOD);
                if (forbids[c] & 1)
                    TEST_ASSERT_FALSE(sim_x0_chg(&b.chip));
                if (forbids[c] & 2)
                    TEST_ASSERT_FALSE(sim_x0_dsg(&b.chip));
            }
            cause(c, false);
            TEST_ASSERT_TRUE(until_on(30000) < 30000);
            bench_serve(PERIOD, PERIOD);
            TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
            NO_MISUSE();
        }
}

/* The cause comes back while the bits are on probation: no FET was on in between. */
/* proves: X0-SEQ-29, X0-AMB-42, X0-AMB-50 */
static void test_a_fault_that_returns_on_probation(void)
{
    int n;
    on_duty("bq7692000");
    (void)sim_x0_set_cell(&b.chip, 1, 4.3);
    bench_serve(2000, PERIOD);
    for (n = 0; n < 5; n++) {
        (void)sim_x0_set_cell(&b.chip, 1, 3.6);
        while (b.chip.reg[0] & 0x04)
            bench_serve(PERIOD, PERIOD);
        (void)sim_x0_set_cell(&b.chip, 1, 4.3);
        while (!(b.chip.reg[0] & 0x04)) {
            bench_serve(PERIOD, PERIOD);
            TEST_ASSERT_FALSE(sim_x0_chg(&b.chip));
        }
    }
    (void)sim_x0_set_cell(&b.chip, 1, 3.6);
    TEST_ASSERT_TRUE(until_on(20000) < 20000);
    NO_MISUSE();
}

/* Each bit of each register of the configuration is upset once: found within a second and put right. */
/* proves: X0-SEQ-20, X0-SEQ-16, X0-AMB-87, X0-BIT-03, X0-ADC-11, X0-DLY-03, X0-AMB-49 */
static void test_scrub_finds_every_bit(void)
{
    static const uint8_t mask[12] = {0, 0x1f, 0x1f, 0x1f, 0x18, 0xc3, 0x9f, 0x7f, 0xf0, 0xff, 0xff, 0x3f};
    unsigned reg, bit;
    for (reg = 1; reg < 12; reg++)
        for (bit = 0; bit < 8; bit++) {
            uint8_t right;
            uint64_t from;
            if (!(mask[reg] >> bit & 1))
                continue;
            on_duty("bq7694003");
            right = b.chip.reg[reg];
            b.chip.reg[reg] ^= (uint8_t)(1u << bit);
            from = b.chip.now;
            while (((b.chip.reg[reg] ^ right) >> bit & 1) && b.chip.now < from + 5000 * MS) {
                bench_serve(250, 250);
                TEST_ASSERT_TRUE(((b.chip.reg[reg] ^ right) >> bit & 1) == 0 ||
                                 b.chip.now - from < 1600 * MS);
            }
            bench_serve(6000, 250);
            TEST_ASSERT_EQUAL_HEX8(right, b.chip.reg[reg]);
            TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_self_test(&b.d));
            TEST_ASSERT_EQUAL(BQ_OK, bench_run(2000));
        }
}

/* Limits are written with the FETs off, also when they were found lost in service. */
/* proves: X0-AMB-46, X0-SEQ-20, X0-OCD-10 */
static void test_limits_are_never_rewritten_under_load(void)
{
    unsigned reg;
    for (reg = 6; reg < 11; reg++) {
        uint64_t n;
        bool on = true, written = false;
        on_duty("bq7693003");
        b.chip.reg[reg] ^= 0x10;
        for (n = b.count; !written && b.chip.now < 60000 * MS;) {
            bench_serve(250, 250);
            for (; n < b.count; n++) {
                const bench_entry *e = bench_log(n);
                if (e->wrote > 0 && e->reg == 5)
                    on = (e->data[0] & 3) != 0;
                if (e->wrote > 0 && e->reg >= 6) {
                    TEST_ASSERT_FALSE(on);
                    written = true;
                }
            }
        }
        TEST_ASSERT_TRUE(written);
        NO_MISUSE();
    }
}

/* Reserved bits that read as something else are no mismatch (X0-BIT-03). */
/* proves: X0-SEQ-16, X0-BIT-03, X0-AMB-87 */
static void test_reserved_bits_are_not_compared(void)
{
    uint64_t n;
    on_duty("bq7692003");
    b.chip.reg[0x06] |= 0x60;
    b.chip.reg[0x07] |= 0x80;
    b.chip.reg[0x0b] |= 0xc0;
    n = b.count;
    bench_serve(3000, 250);
    TEST_ASSERT_EQUAL(0, bench_writes(n, 0x06, NULL));
    TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
}

/* The part loses its supply and is booted by somebody else: within a second the driver knows, says so, writes
   everything, and the FETs come back on its own terms. */
/* proves: X0-SEQ-20, X0-ELEC-17, X0-AMB-70, X0-SEQ-41, X0-OCD-10 */
static void test_a_reset_in_service(void)
{
    int k, phase;
    for (k = 0; k < 15; k++)
        for (phase = 0; phase < 1000; phase += 230) {
            uint64_t from, n;
            bool told = false;
            on_duty(sim_x0_part_at(k)->name);
            bench_wait(phase);
            (void)sim_x0_set_supply(&b.chip, false);
            (void)sim_x0_set_supply(&b.chip, true);
            (void)sim_x0_boot(&b.chip, 3 * MS);
            bench_wait(11);
            from = b.chip.now;
            n = b.count;
            while (!(sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip)) && b.chip.now < from + 20000 * MS) {
                bench_serve(250, 250);
                told = told || (b.module.faults & BQ_F_RESET) != 0;
                TEST_ASSERT_FALSE(!told && b.chip.now > from + 1600 * MS);
                if (sim_x0_dsg(&b.chip)) { /* limits first (X0-OCD-10) */
                    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->current.protect1,
                                           sim_x0_peek(&b.chip, 0x06));
                    TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
                }
            }
            TEST_ASSERT_TRUE(told && sim_x0_dsg(&b.chip));
            TEST_ASSERT_TRUE(bench_writes(n, 0x06, NULL) >= 1);
            bench_serve(2000, 250);
            TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
            TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_internal_fault);
    RUN_TEST(test_internal_fault_that_stays_is_not_cleared_for_ever);
    RUN_TEST(test_every_pair_of_faults);
    RUN_TEST(test_a_fault_that_returns_on_probation);
    RUN_TEST(test_scrub_finds_every_bit);
    RUN_TEST(test_limits_are_never_rewritten_under_load);
    RUN_TEST(test_reserved_bits_are_not_compared);
    RUN_TEST(test_a_reset_in_service);
    return UNITY_END();
}
