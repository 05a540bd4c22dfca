/* SPDX-License-Identifier: Apache-2.0 */
/* Everything at once, at random, on every part: cells, currents, pins, internal faults, supply dips, a
 * converter that stands, a bus that fails in every way, a host that is late. Throughout, what is called valid
 * is true and no FET is on that must be off; and when the damage ends the driver comes back without help. */
#include "bench.h"
#include <stdio.h>

#define HISTORY 4096

void setUp(void)
{
}
void tearDown(void)
{
}

/* What cell 1 and the others have been: the attack moves them all to one voltage, cell 1 to another. */
static struct {
    uint64_t t;
    double one, others;
} history[HISTORY];
static unsigned changes;
static unsigned round_no;
static const char *what;

static void fail_here(const char *text)
{
    char line[160];
    (void)snprintf(line, sizeof line, "%s, round %u, t = %.3f s, after %s: %s", b.chip.part->name, round_no,
                   (double)b.chip.now / 1e9, what, text);
    TEST_FAIL_MESSAGE(line);
}

static void set_cells(double one, double others)
{
    int i;
    (void)sim_x0_set_cell(&b.chip, 1, one);
    for (i = 2; i <= b.chip.part->cells; i++)
        (void)sim_x0_set_cell(&b.chip, i, others);
    history[changes % HISTORY].t = b.chip.now;
    history[changes % HISTORY].one = one;
    history[changes % HISTORY].others = others;
    changes++;
}

static bool near(double volts, unsigned mv)
{
    return mv + 2.0 > volts * 1e3 && mv < volts * 1e3 + 2.0;
}

/* True if the value was true at an instant that its age admits. */
static bool was_true(int cell, unsigned mv, uint32_t age_ms)
{
    uint64_t oldest = b.chip.now > (age_ms + 20ull) * MS ? b.chip.now - (age_ms + 20ull) * MS : 0;
    unsigned n;
    for (n = changes; n-- > 0 && changes - n < HISTORY;) {
        double volts = cell == 0 ? history[n % HISTORY].one : history[n % HISTORY].others;
        if (near(volts, mv))
            return true;
        if (history[n % HISTORY].t <= oldest)
            return false; /* this was it at the oldest admissible instant */
    }
    return true;
}

static void judge(void)
{
    int i;
    if (bench_picture() != BQ_OK)
        return;
    for (i = 0; i < b.sample.cell_count; i++)
        if ((b.cells[i].quality & BQ_Q_VALID) && !was_true(i, b.cells[i].mv, b.module.age_ms))
            fail_here("a value called valid was never true");
}

static uint64_t limits_ns; /* when DSG was off or had its limits */

static void outputs(void)
{
    uint8_t stat = b.chip.reg[0];
    if ((stat & 0x34) && sim_x0_chg(&b.chip) && !b.chip.options.amb50_write_sticks)
        fail_here("CHG on against a fault bit");
    if ((stat & 0x3b) && sim_x0_dsg(&b.chip) && !b.chip.options.amb50_write_sticks)
        fail_here("DSG on against a fault bit");
    if (b.chip.reg[7] != 0 || !sim_x0_dsg(&b.chip))
        limits_ns = b.chip.now;
    else if (b.chip.now - limits_ns > (1000 + 450) * MS) /* a scrub a second (X0-SEQ-20), a late host */
        fail_here("DSG on without limits");
}

/* `clean`: nothing that touches a transfer or takes the part's supply, so that the book has to stay empty. */
static void blow(bool crc_part, bool clean)
{
    static const char *const name[] = {"cells",
                                       "a high cell",
                                       "a low cell",
                                       "a dead cell",
                                       "overcurrent",
                                       "a short",
                                       "a load",
                                       "override",
                                       "XREADY",
                                       "a supply dip",
                                       "a dead bus",
                                       "a stuck bus",
                                       "bad transfers",
                                       "flips",
                                       "a late host",
                                       "calm",
                                       "a stop of the converter"};
    sim_x0_bus_fault *bus = sim_x0_bus(&b.chip);
    unsigned kind = bench_random(17);
    if (clean && kind >= 9 && kind <= 13)
        kind -= 9;
    what = name[kind];
    switch (kind) {
    case 0:
        set_cells(3.2 + 0.001 * bench_random(800), 3.2 + 0.001 * bench_random(800));
        break;
    case 1:
        set_cells(4.3, 3.6);
        break;
    case 2:
        set_cells(2.6, 3.6);
        break;
    case 3:
        set_cells(0.2, 3.6);
        break;
    case 4:
        (void)sim_x0_set_sense(&b.chip, -0.045);
        break;
    case 5:
        (void)sim_x0_set_sense(&b.chip, -0.150);
        bench_wait(0.3);
        (void)sim_x0_set_sense(&b.chip, 0);
        break;
    case 6:
        (void)sim_x0_set_chgpin(&b.chip, 3.0);
        break;
    case 7:
        (void)sim_x0_set_alert_ext(&b.chip, true);
        break;
    case 8:
        (void)sim_x0_strike_xready(&b.chip);
        break;
    case 9:
        (void)sim_x0_set_supply(&b.chip, false);
        (void)sim_x0_set_supply(&b.chip, true);
        if (bench_random(2))
            (void)sim_x0_boot(&b.chip, 3 * MS);
        break;
    case 10:
        bus->dead = 1 + (int)bench_random(2);
        break;
    case 11:
        bus->stuck_clocks = bench_random(2) ? -1 : (int)bench_random(10);
        break;
    case 12:
        b.spoil_at = b.count + 1;
        b.spoil_kind = (spoil)(1 + bench_random(SPOIL_BROWNOUT));
        b.flip_bit = (int)bench_random(48);
        b.spoil_count = 1 + bench_random(6);
        if (b.spoil_kind == SPOIL_FLIP && !crc_part)
            b.spoil_at = 0;
        break;
    case 13:
        bus->flip_probability = crc_part ? 2e-4 : 0.0;
        break;
    case 14:
        bench_wait(bench_random(3000));
        break;
    case 16:
        b.chip.t_cc_end = UINT64_MAX;
        b.chip.due = 0;
        break;
    default:
        break;
    }
}

static void calm(void)
{
    sim_x0_bus_fault *bus = sim_x0_bus(&b.chip);
    bus->dead = bus->stuck_clocks = 0;
    bus->flip_probability = 0.0;
    b.spoil_at = 0;
    (void)sim_x0_set_sense(&b.chip, 0);
    (void)sim_x0_set_chgpin(&b.chip, 0);
    (void)sim_x0_set_alert_ext(&b.chip, false);
    set_cells(3.6, 3.6);
}

/* What the super-loop does: scan, apply; a new bring-up when the monitor is lost. */
static bool up;

static void serve_once(void)
{
    bq_status s;
    if (!up) {
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_start(&b.d));
        up = bench_run(60000) == BQ_OK;
        outputs();
        return;
    }
    s = bq769x0_begin_scan(&b.d);
    if (s == BQ_OK)
        s = bench_run(60000);
    judge();
    outputs();
    if (s == BQ_OK && bq769x0_begin_apply(&b.d, &b.action) == BQ_OK)
        (void)bench_run(60000);
    outputs();
    up = s != BQ_E_NACK && s != BQ_E_DEFECTIVE && s != BQ_E_STATE;
}

static void attack(const sim_x0_part *part, unsigned blows, bool clean)
{
    uint64_t end;
    changes = 0;
    bench_part(part->name, NULL);
    b.action.balance[0] = 0x7fff;
    set_cells(3.6, 3.6);
    up = false;
    limits_ns = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    while (blows-- > 0) {
        unsigned n = 1 + bench_random(12);
        if (bench_random(3) == 0)
            calm();
        blow(part->crc, clean);
        while (n-- > 0) {
            serve_once();
            bench_wait(bench_random(400));
        }
    }
    calm();
    what = "the end";
    bq769x0_unlock(&b.d);
    end = b.chip.now + 120000 * MS;
    while (b.chip.now < end - 118000 * MS) { /* what was done last shows only now */
        serve_once();
        bench_wait(200);
    }
    while (b.chip.now < end && !(up && sim_x0_chg(&b.chip) && sim_x0_dsg(&b.chip) && b.module.faults == 0)) {
        serve_once();
        bench_wait(200);
    }
    if (b.chip.now >= end)
        fail_here("it does not come back");
    serve_once();
    if (!(b.cells[0].quality & BQ_Q_VALID) || sim_x0_peek(&b.chip, 0x0b) != 0x19 ||
        sim_x0_peek(&b.chip, 0x09) != bq769x0_get_achieved(&b.d)->ov_trip ||
        sim_x0_peek(&b.chip, 0x06) != bq769x0_get_achieved(&b.d)->current.protect1)
        fail_here("the configuration is not back");
    if (clean)
        NO_MISUSE();
}

/* proves: X0-SEQ-20, X0-SEQ-25, X0-SEQ-29, X0-SEQ-36, X0-SEQ-53, X0-I2C-27, X0-FET-11, X0-SEQ-05 */
static void test_everything_at_once(void)
{
    int k;
    for (k = 0; k < 15; k++)
        for (round_no = 0; round_no < 25; round_no++)
            attack(sim_x0_part_at(k), 60, false);
}

/* proves: X0-SEQ-28, X0-SEQ-36, X0-BIT-09, X0-CB-04, X0-CB-06, X0-AMB-15 */
static void test_everything_but_the_bus_leaves_the_book_empty(void)
{
    int k;
    for (k = 0; k < 15; k++)
        for (round_no = 0; round_no < 15; round_no++)
            attack(sim_x0_part_at(k), 60, true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_everything_at_once);
    RUN_TEST(test_everything_but_the_bus_leaves_the_book_empty);
    return UNITY_END();
}
