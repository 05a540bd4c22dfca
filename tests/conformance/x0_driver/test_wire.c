/* SPDX-License-Identifier: Apache-2.0 */
/* What the driver really puts on the wire, byte by byte, against the printed traces (X0-NUM-803..868). */
#include "bench.h"
#include "bqhost/crc8.h"
#include <stdio.h>
#include <stdlib.h>

void setUp(void)
{
}
void tearDown(void)
{
}

typedef struct trace {
    int row;
    bool emitted; /* must be seen on the wire, alone or as the beginning of a longer block */
    const char *text;
} trace;

static const trace traces[] = {
    {803, true, "S 10+ 05+ 40+ 24+ P"},
    {804, false, "S 10+ 0b+ 19+ 7a+ P"},
    {805, true, "S 10+ 04+ 10+ 86+ P"},
    {806, true, "S 10+ 04+ 18+ be+ P"},
    {807, true, "S 10+ 05+ 43+ 2d+ P"},
    {808, true, "S 10+ 05+ 42+ 2a+ P"},
    {809, true, "S 10+ 05+ 20+ 03+ P"},
    {810, true, "S 10+ 05+ 00+ e3+ P"},
    {811, true, "S 10+ 00+ 80+ 2b+ P"},
    {812, true, "S 10+ 00+ 04+ be+ P"},
    {813, true, "S 10+ 00+ 08+ 9a+ P"},
    {814, true, "S 10+ 00+ 03+ ab+ P"},
    {815, true, "S 10+ 00+ 10+ d2+ P"},
    {816, true, "S 10+ 00+ 20+ 42+ P"},
    {817, false, "S 10+ 00+ bf+ 96+ P"},
    {818, true, "S 10+ 06+ 8b+ 64+ P"},
    {819, false, "S 10+ 07+ 5a+ 48+ P"},
    {820, false, "S 10+ 08+ 50+ bd+ P"},
    {821, false, "S 10+ 09+ bf+ 2b+ P"},
    {822, false, "S 10+ 0a+ 99+ e6+ P"},
    {823, true, "S 10+ 01+ 15+ dc+ P"},
    {824, true, "S 10+ 01+ 0a+ 81+ P"},
    {825, false, "S 10+ 02+ 15+ e3+ P"},
    {826, false, "S 10+ 03+ 0a+ ab+ P"},
    {827, true, "S 10+ 04+ 18+ be+ P"},
    {827, true, "S 10+ 04+ 19+ b9+ P"},
    {827, true, "S 10+ 04+ 1a+ b0+ P"},
    {828, false, "S 10+ 04+ 00+ f6+ P"},
    {828, false, "S 10+ 04+ 01+ f1+ P"},
    {828, false, "S 10+ 04+ 02+ f8+ P"},
    {829, true, "S 10+ 06+ 8b+ 64+ 5a+ 81+ 50+ b7+ bf+ 34+ 99+ c6+ 19+ 4f+ P"},
    {830, true, "S 10+ 01+ 15+ dc+ 0a+ 36+ 15+ 6b+ P"},
    {831, true, "S 10+ 01+ 00+ b7+ 00+ 00+ 00+ 00+ P"},
    {832, false, "S 10+ 09+ ac+ 52+ 97+ ec+ P"},
    {833, true, "S 10+ 05+ S 11+ 40 85 P"},
    {834, true, "S 10+ 00+ S 11+ 00 42 P"},
    {835, true, "S 10+ 00+ S 11+ 80 cb P"},
    {836, true, "S 10+ 00+ S 11+ 84 d7 P"},
    {837, true, "S 10+ 04+ S 11+ 10 32 P"},
    {838, true, "S 10+ 04+ S 11+ 18 0a P"},
    {839, true, "S 10+ 04+ S 11+ 98 83 P"},
    {840, false, "S 10+ 0b+ S 11+ 19 0d P"},
    {841, false, "S 10+ 09+ S 11+ ac 0f P"},
    {842, false, "S 10+ 0a+ S 11+ 97 ae P"},
    {843, true, "S 10+ 59+ S 11+ e0 ec P"},
    {844, true, "S 10+ 50+ S 11+ 04 5e 1e 5a P"},
    {845, true, "S 10+ 0c+ S 11+ 18 0a 00 00 P"},
    {846, true, "S 10+ 0c+ S 11+ 1f 1f 10 70 P"},
    {847, true, "S 10+ 0c+ S 11+ 24 be d0 3e 24 fc d0 3e 24 fc d0 3e 24 fc d0 3e 24 fc d0 3e P"},
    {848, true, "S 10+ 2a+ S 11+ 2e 88 04 1c P"},
    {849, true, "S 10+ 32+ S 11+ c3 05 50 b7 P"},
    {850, true, "S 10+ 32+ S 11+ 27 b7 10 70 P"},
    {851, false, "S 10+ 2c+ S 11+ 10 32 df 13 P"},
    {852, true, "S 10+ 06+ S 11+ 8b fa 5a 81 50 b7 bf 34 99 c6 19 4f P"},
    {853, false, "S 10+ 06+ S 11+ 00 42 00 00 00 00 ac 4d 97 ec 00 00 P"},
    {854, false, "S 10+ 32+ P S 11+ c3 05 50 b7 P"},
    {867, false, "S 30+ 0b+ 19+ P"},
    {867, true, "S 30+ 0c+ S 31+ 24 d0 P"},
    {867, true, "S 30+ 06+ 8b+ 5a+ 50+ bf+ 99+ 19+ P"},
    {868, false, "S 10+ 0b+ 19+ P"},
    {868, true, "S 10+ 00+ S 11+ 80 P"},
};
#define TRACES (sizeof traces / sizeof traces[0])
static bool seen[TRACES];

/* Looks for every trace in what was recorded. A block may go on where the printed one stops. */
static void look(void)
{
    size_t i;
    for (i = 0; i < TRACES; i++) {
        char text[160];
        size_t n = strlen(traces[i].text);
        memcpy(text, traces[i].text, n + 1);
        text[n - 1] = 0; /* without the stop, with the blank before it */
        seen[i] = seen[i] || strstr(b.wire, text) != NULL;
    }
    b.wire_used = 0;
    b.wire[0] = 0;
}

static void pass(uint32_t ms)
{
    bench_serve(ms, 250);
    look();
}

static void design_example(const char *name)
{
    bench_part(name, NULL);
    b.cfg.ov_mv = 4300;
    b.cfg.ov_recover_mv = 4200;
    b.cfg.uv_mv = 2499; /* the next code, 0x9a, lies above 2.5 V */
    b.cfg.uv_recover_mv = 2700;
    b.cfg.ov_delay_s = 2;
    b.cfg.uv_delay_s = 4;
    b.cfg.ocd_ma = 15000;
    b.cfg.scd_ma = 25000;
}

static void up(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    look();
}

static void currents(void)
{
    static const double code[2] = {10000, -15536};
    int i;
    for (i = 0; i < 2; i++) {
        (void)sim_x0_set_sense(&b.chip, code[i] * 8.44e-6);
        TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_oneshot(&b.d));
        TEST_ASSERT_EQUAL(BQ_OK, bench_run(3000));
    }
    (void)sim_x0_set_sense(&b.chip, 0);
    look();
}

static void faults(void)
{
    (void)sim_x0_set_sense(&b.chip, -0.150);
    bench_wait(400);
    (void)sim_x0_set_sense(&b.chip, 0);
    (void)sim_x0_set_chgpin(&b.chip, 3.0);
    pass(2000);
    (void)sim_x0_set_chgpin(&b.chip, 0);
    pass(20000);
    (void)sim_x0_set_cell(&b.chip, 1, 4.4);
    pass(5000);
    (void)sim_x0_set_cell(&b.chip, 1, 3.6);
    pass(15000);
    (void)sim_x0_set_cell(&b.chip, 1, 2.4);
    pass(6000);
    (void)sim_x0_set_cell(&b.chip, 1, 3.6);
    pass(25000);
    (void)sim_x0_set_alert_ext(&b.chip, true);
    pass(500);
    (void)sim_x0_set_alert_ext(&b.chip, false);
    pass(15000);
    (void)sim_x0_strike_xready(&b.chip);
    pass(15000);
}

static void ship(void)
{
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_begin_ship(&b.d));
    TEST_ASSERT_EQUAL(BQ_OK, bench_run(2000));
    look();
}

static void life_of_a_small_part(void)
{
    design_example("bq7692003");
    up();
    pass(3000);
    b.action.charge_on = false;
    pass(2000);
    b.action.charge_on = true;
    b.action.balance[0] = 0x1f;
    pass(10000); /* both sets */
    b.action.balance[0] = 0;
    faults();
    currents();
    (void)sim_x0_set_cell(&b.chip, 1, 0x1800 * 382e-6);
    pass(1000);
    (void)sim_x0_set_cell(&b.chip, 1, 0x1f10 * 382e-6);
    pass(1000);
    b.chip.reg[0] = 0xbf; /* a host that forgot everything finds every bit set */
    up();
    ship();
}

static void lives_of_others(void)
{
    design_example("bq7692003");
    (void)sim_x0_set_gain(&b.chip, 380);
    (void)sim_x0_set_offset(&b.chip, 30);
    b.cfg.sensors = 0;
    b.cfg.counter_off = true;
    up();
    currents();
    design_example("bq7694003");
    up();
    pass(2500);
    b.action.balance[0] = 0x5555; /* inputs 1, 3, 5, 7, 9, 11, 13, 15 */
    pass(500);
    design_example("bq7692006");
    up();
    pass(500);
    design_example("bq7692000");
    up();
    pass(500);
    b.chip.reg[0x0b] = 0; /* lost: written again by the scrub, as a block or alone */
    pass(1500);
}

static uint8_t next(const char **p)
{
    uint8_t byte = (uint8_t)strtoul(*p, NULL, 16);
    *p += (*p)[2] == '+' ? 4 : 3;
    return byte;
}

/* Every printed CRC by the library's arithmetic and the rules of X0-I2C-12..15. */
static bool crcs_hold(const char *p)
{
    uint8_t head[3], n = 0, byte;
    bool all = true;
    while (*p != 0) {
        if (*p == 'S' || *p == 'P') {
            n = 0;
            p += p[1] != 0 ? 2 : 1;
            continue;
        }
        head[n++] = next(&p);
        if (n == 1 && !(head[0] & 1))
            head[n++] = next(&p); /* the register */
        if (*p == 'S' || *p == 'P')
            continue; /* the pointer phase of a read carries no CRC */
        if (head[0] == 0x30 || head[0] == 0x31)
            return true; /* no CRC at that address */
        head[n++] = next(&p);
        byte = next(&p);
        all = all && byte == bq_crc8(0, head, n);
        while (*p != 'P') {
            head[0] = next(&p);
            byte = next(&p);
            all = all && byte == bq_crc8(0, head, 1);
        }
    }
    return all;
}

/* proves: X0-NUM-803, X0-NUM-804, X0-NUM-805, X0-NUM-806, X0-NUM-807, X0-NUM-808, X0-NUM-809,
   X0-NUM-810, X0-NUM-811, X0-NUM-812, X0-NUM-813, X0-NUM-814, X0-NUM-815, X0-NUM-816, X0-NUM-817,
   X0-NUM-818, X0-NUM-819, X0-NUM-820, X0-NUM-821, X0-NUM-822, X0-NUM-823, X0-NUM-824, X0-NUM-825,
   X0-NUM-826, X0-NUM-827, X0-NUM-828, X0-NUM-829, X0-NUM-830, X0-NUM-831, X0-NUM-832, X0-NUM-833,
   X0-NUM-834, X0-NUM-835, X0-NUM-836, X0-NUM-837, X0-NUM-838, X0-NUM-839, X0-NUM-840, X0-NUM-841,
   X0-NUM-842, X0-NUM-843, X0-NUM-844, X0-NUM-845, X0-NUM-846, X0-NUM-847, X0-NUM-848, X0-NUM-849,
   X0-NUM-850, X0-NUM-851, X0-NUM-852, X0-NUM-853, X0-NUM-854, X0-NUM-867, X0-NUM-868, X0-I2C-04,
   X0-I2C-05, X0-I2C-06, X0-I2C-08, X0-I2C-10, X0-I2C-12, X0-I2C-13, X0-I2C-14, X0-I2C-15, X0-AMB-78 */
static void test_printed_traces(void)
{
    size_t i;
    life_of_a_small_part();
    lives_of_others();
    for (i = 0; i < TRACES; i++) {
        char text[200];
        (void)snprintf(text, sizeof text, "X0-NUM-%d: %s", traces[i].row, traces[i].text);
        if (traces[i].emitted && !seen[i])
            TEST_FAIL_MESSAGE(text);
        if (traces[i].row != 868 && !crcs_hold(traces[i].text))
            TEST_FAIL_MESSAGE(text);
    }
}

/* proves: X0-I2C-25, X0-BIT-16, X0-SEQ-22 */
static void test_the_longest_transfer(void)
{
    static const char *const name[2] = {"bq7694000", "bq7694003"};
    static const unsigned bits[2] = {387, 747};
    int k;
    for (k = 0; k < 2; k++) {
        unsigned longest = 0;
        uint64_t n;
        bench_up(name[k]);
        bench_serve(3000, 250);
        for (n = 0; n < b.count; n++)
            if (9u * bench_log(n)->raw > longest)
                longest = 9u * bench_log(n)->raw;
        TEST_ASSERT_EQUAL(bits[k], longest);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_printed_traces);
    RUN_TEST(test_the_longest_transfer);
    return UNITY_END();
}
