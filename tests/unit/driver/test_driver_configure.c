/* SPDX-License-Identifier: Apache-2.0 */
/* Configuration by shadow writes: PL-SEQ-03, PL-SEQ-04, and its upkeep. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

/* Group-3 writes as they pass, and the smallest distance of COV and CUV that any device ever had. */
static struct spy {
    uint8_t order[64];
    unsigned writes;
    int naked; /* group-3 writes without the key directly before */
    bool key;
    int smallest_mv;
    int late_adc_on; /* ADCT set while ADC_ON = 0, or earlier than 1 ms after */
    uint64_t adc_on_ns;
    int test_select;
    int devices;
} spy;

static int distance(int n)
{
    int cov = sim_pl_peek(&r.pl, n, 0x42);
    int cuv = sim_pl_peek(&r.pl, n, 0x44);
    return 2000 + 50 * (cov & 0x3f) - 700 - 100 * (cuv & 0x1f);
}

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    (void)rx;
    for (int k = 1; k <= spy.devices; k++) {
        if (distance(k) < spy.smallest_mv) {
            spy.smallest_mv = distance(k);
        }
    }
    if (n != 4 || (tx[0] & 1) == 0) {
        return false;
    }
    if (tx[1] >= 0x40 && tx[1] <= 0x4b) {
        spy.naked += !spy.key;
        if (spy.writes < sizeof spy.order && (spy.writes == 0 || spy.order[spy.writes - 1] != tx[1])) {
            spy.order[spy.writes++] = tx[1];
        }
    }
    if (tx[1] == 0x30 && (tx[2] & 0x40) != 0) {
        spy.adc_on_ns = sim_pl_now(&r.pl);
    }
    if (tx[1] == 0x40 && (tx[2] & 0xc0) != 0 &&
        (spy.adc_on_ns == 0 || sim_pl_now(&r.pl) - spy.adc_on_ns < SIM_PL_MS)) {
        spy.late_adc_on++;
    }
    spy.test_select += tx[1] == 0x3d;
    spy.key = tx[1] == 0x3a && tx[2] == 0x35;
    return false;
}

static unsigned place(uint8_t reg)
{
    for (unsigned i = 0; i < spy.writes; i++) {
        if (spy.order[i] == reg) {
            return i;
        }
    }
    return 99;
}

void setUp(void)
{
    memset(&spy, 0, sizeof spy);
    spy.smallest_mv = 9999;
    c = rig_config(3);
}

void tearDown(void)
{
}

static void open_with_spy(void)
{
    rig_open(&r, &c, NULL);
    spy.devices = c.devices;
    sim_pl_bus_fault(&r.pl)->hook = watch;
}

static void set_otp(int n, uint8_t reg, uint8_t value)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_set_otp(&r.pl, n, reg, value));
}

/* proves: PL-SEQ-03-03, PL-SEQ-03-04, PL-SEQ-03-05, PL-SEQ-03-06, PL-SEQ-03-07, PL-SEQ-03-08, PL-SEQ-03-09,
 * PL-SEQ-04-02, PL-SEQ-04-03, PL-G3-02, PL-G3-10, PL-ADC-10, PL-ADC-13, PL-SEQ-00-04, PL-SEQ-00-05,
 * PL-BCAST-03, PL-BCAST-05, PL-BCAST-06, PL-TEST-03, PL-NUM-34, PL-NUM-35, PL-TIM-16, PL-TS-05, PL-TS-07 */
static void writes_and_verifies_every_register_in_order(void)
{
    static const uint8_t group3[12] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85,
                                       0x55, 0x32, 0x5a, 0x01, 0x02, 0x03};
    static const uint8_t user[4] = {0x5a, 0x01, 0x02, 0x03};
    memcpy(c.user, user, 4);
    open_with_spy();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    for (int n = 1; n <= 3; n++) {
        for (int i = 0; i < 12; i++) {
            TEST_ASSERT_EQUAL_HEX8(group3[i], sim_pl_peek(&r.pl, n, (uint8_t)(0x40 + i)));
        }
        TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, n, 0x30));
        TEST_ASSERT_EQUAL_HEX8(0x03, sim_pl_peek(&r.pl, n, 0x31) & 0xdf);
    }
    TEST_ASSERT_EQUAL_INT(0, spy.naked);
    TEST_ASSERT_EQUAL_INT(0, spy.late_adc_on);
    TEST_ASSERT_EQUAL_INT(0, spy.test_select);
    TEST_ASSERT_TRUE(place(0x40) < place(0x42));
    TEST_ASSERT_TRUE(place(0x42) < place(0x44)); /* COV rises: first */
    TEST_ASSERT_TRUE(place(0x47) < place(0x46));
    TEST_ASSERT_TRUE(place(0x44) < place(0x43));
    TEST_ASSERT_TRUE(place(0x46) < place(0x43) && place(0x43) < place(0x45) && place(0x45) < 99);
    TEST_ASSERT_TRUE(spy.smallest_mv >= 300);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* The EPROM of every device holds a wide window high up, then a low one; then one of each kind.
 * proves: PL-COV-12, PL-SEQ-03-05 */
static void keeps_cov_and_cuv_apart_whatever_the_eprom_holds(void)
{
    static const uint8_t eprom[3][2] = {{0x3c, 0x1a}, {0x06, 0x06}, {0x10, 0x0a}};
    for (int mixed = 0; mixed < 4; mixed++) {
        memset(&spy, 0, sizeof spy);
        spy.smallest_mv = 9999;
        c.cov_mv = 2500;
        c.cuv_mv = 2200;
        rig_open(&r, &c, NULL);
        for (int n = 1; n <= 3; n++) {
            int which = mixed < 3 ? mixed : n - 1;
            set_otp(n, 0x42, eprom[which][0]);
            set_otp(n, 0x44, eprom[which][1]);
            (void)sim_pl_set_supply(&r.pl, n, false);
        }
        sim_pl_advance(&r.pl, SIM_PL_MS);
        for (int n = 1; n <= 3; n++) {
            (void)sim_pl_set_supply(&r.pl, n, true);
        }
        sim_pl_advance(&r.pl, 100 * SIM_PL_MS);
        spy.devices = 3;
        sim_pl_bus_fault(&r.pl)->hook = watch;
        for (int n = 1; n <= 3; n++) {
            double low[6] = {2.35, 2.35, 2.35, 2.35, 2.35, 2.35};
            (void)sim_pl_set_cells(&r.pl, n, low);
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
        TEST_ASSERT_TRUE(spy.smallest_mv >= 300);
        for (int n = 1; n <= 3; n++) {
            TEST_ASSERT_EQUAL_HEX8(0x0a, sim_pl_peek(&r.pl, n, 0x42));
            TEST_ASSERT_EQUAL_HEX8(0x0f, sim_pl_peek(&r.pl, n, 0x44));
        }
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* proves: PL-SEQ-04-01, PL-ADC-14, PL-OTP-11 */
static void a_programmed_part_gets_adc_on_before_any_conversion(void)
{
    open_with_spy();
    for (int n = 1; n <= 3; n++) {
        set_otp(n, 0x40, 0x50);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_INT(SIM_PL_ACTIVE, sim_pl_get_mode(&r.pl, n));
        TEST_ASSERT_EQUAL_UINT(1, sim_pl_conversions(&r.pl, n));
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-ADC-08, PL-CUV-08, PL-GEN-01, PL-AMB-73 */
static void devices_with_fewer_cells_are_masked_and_scanned_accordingly(void)
{
    static const uint8_t cells[4] = {6, 3, 5, 4};
    static const uint8_t function[4] = {0x50, 0x5c, 0x54, 0x58};
    static const uint8_t adc[4] = {0x7d, 0x7a, 0x7c, 0x7b};
    c = rig_config(4);
    c.cells = cells;
    open_with_spy();
    for (int n = 1; n <= 4; n++) {
        for (int k = 1; k <= 6; k++) {
            (void)sim_pl_set_cell(&r.pl, n, k, k <= cells[n - 1] ? 3.3 + 0.01 * k : 0.0);
        }
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(18, r.sample.cell_count);
    unsigned at = 0;
    for (int n = 1; n <= 4; n++) {
        TEST_ASSERT_EQUAL_HEX8(function[n - 1], sim_pl_peek(&r.pl, n, 0x40));
        TEST_ASSERT_EQUAL_HEX8(adc[n - 1], sim_pl_peek(&r.pl, n, 0x30));
        for (unsigned k = 1; k <= cells[n - 1]; k++, at++) {
            TEST_ASSERT_EQUAL_UINT(3300 + 10 * k, r.cells[at].mv);
            TEST_ASSERT_EQUAL_UINT(n - 1, r.cells[at].module);
        }
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[n - 1].faults);
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-03-10, PL-SEQ-03-11 */
static void waits_the_longest_delay_and_finds_flags_that_are_real(void)
{
    open_with_spy();
    (void)sim_pl_set_cell(&r.pl, 2, 3, 4.3);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_TRUE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_FALSE(bq76pl536_diagnose(&r.d)->fault_line_stuck);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[1].faults);
    TEST_ASSERT_EQUAL_HEX16(0x04, r.modules[1].cell_ov);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
}

static bq_line stuck_line;

static bq_status stuck_read(void *ctx, bq_line line, bool *level)
{
    const bq_gpio good = hal_sim_gpio(ctx);
    bq_status st = good.ops->read(ctx, line, level);
    *level = *level || line == stuck_line;
    return st;
}

/* proves: PL-SEQ-03-11, PL-SEQ-08-09 */
static void reports_a_line_that_is_high_without_a_reason(void)
{
    static const bq_line lines[2] = {BQ_LINE_FAULT, BQ_LINE_ALERT};
    for (int i = 0; i < 2; i++) {
        rig_open(&r, &c, NULL);
        static bq_gpio_ops ops;
        ops = *hal_sim_gpio(&r.hal).ops;
        ops.read = stuck_read;
        stuck_line = lines[i];
        const bq_gpio gpio = {&ops, &r.hal};
        const bq_spi spi = hal_sim_spi(&r.hal);
        const bq_clock clock = hal_sim_clock(&r.hal);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_init(&r.d, &c, &spi, &gpio, &clock, r.devices, 3));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
        TEST_ASSERT_EQUAL_INT(i == 0, bq76pl536_diagnose(&r.d)->fault_line_stuck);
        TEST_ASSERT_EQUAL_INT(i == 1, bq76pl536_diagnose(&r.d)->alert_line_stuck);
        TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->line_above);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_CHAIN, r.modules[0].faults);
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_self_test(&r.d));
        TEST_ASSERT_EQUAL_INT(BQ_E_LINE_STUCK, rig_run(&r, 5));
    }
}

static void comparators_that_are_off_are_disabled(void)
{
    c.cov_mv = 0;
    c.cuv_mv = 0;
    c.ot_c[0] = 0;
    c.ot_c[1] = 0;
    open_with_spy();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_HEX8(0x80, sim_pl_peek(&r.pl, 1, 0x42) & 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x80, sim_pl_peek(&r.pl, 1, 0x44) & 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, 1, 0x46));
    (void)sim_pl_set_cell(&r.pl, 1, 1, 5.5);
    rig_advance_ms(&r, 5000);
    TEST_ASSERT_FALSE(sim_pl_fault_pin(&r.pl));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* The bq76PL536A: reserved ADCT bits stay 0, everything else is the same. */
static void the_a_part_is_left_alone_where_it_differs(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.variant_a = true;
    c.variant_a = true;
    rig_up(&r, &c, &o);
    TEST_ASSERT_EQUAL_HEX8(0x10, sim_pl_peek(&r.pl, 1, 0x40));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3600, r.cells[17].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[17].quality);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-CRC-08, PL-AMB-16, PL-VEC-54, PL-AMB-03 */
static void runs_without_crc_when_told_so(void)
{
    c.crc_off = true;
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 3, 0x41));
    uint64_t bytes = r.hal.bytes;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    TEST_ASSERT_EQUAL_UINT(3 + 3 * 22, r.hal.bytes - bytes);
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(3600, r.cells[17].mv);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r)); /* and again from there */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

/* A register that changes behind the host's back is found within one rotation, reported and repaired.
 * proves: PL-G3-07, PL-SEQ-08-07 */
static void the_scrub_finds_and_repairs_one_device_at_a_time(void)
{
    c.scrub_period_ms = 100;
    rig_up(&r, &c, NULL);
    rig_poke(&r, 3, 0x3a, 0x35);
    rig_poke(&r, 3, 0x42, 0x30);
    TEST_ASSERT_EQUAL_HEX8(0x30, sim_pl_peek(&r.pl, 3, 0x42));
    int found = 0;
    for (int i = 0; i < 4; i++) {
        rig_advance_ms(&r, 100);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        found += (r.modules[2].faults & BQ_F_CONFIG) != 0;
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[0].faults);
    }
    TEST_ASSERT_EQUAL_INT(1, found);
    TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, 3, 0x42));
}

/* proves: PL-GPAI-06, PL-GPAI-01, PL-AMB-56 */
static void switches_between_brick_and_pins(void)
{
    bq76pl536_flags flags;
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_gpai(&r.pl, 2, 1.25);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_select_gpai(&r.d, true));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    TEST_ASSERT_EQUAL_HEX8(0x40, sim_pl_peek(&r.pl, 2, 0x40));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_device_flags(&r.d, 2, &flags));
    TEST_ASSERT_EQUAL_UINT(1250, flags.gpai_mv);
    TEST_ASSERT_EQUAL_UINT(0, r.modules[1].stack_mv);
    TEST_ASSERT_EQUAL_HEX8(0, r.modules[1].quality);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[1].faults);
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_select_gpai(&r.d, false));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    rig_sample(&r); /* what the pins read is no brick voltage */
    TEST_ASSERT_EQUAL_UINT(0, r.modules[1].stack_mv);
    TEST_ASSERT_EQUAL_HEX8(0, r.modules[1].quality);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_UINT_WITHIN(3, 21600, r.modules[1].stack_mv);
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_device_flags(&r.d, 4, &flags));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(writes_and_verifies_every_register_in_order);
    RUN_TEST(keeps_cov_and_cuv_apart_whatever_the_eprom_holds);
    RUN_TEST(a_programmed_part_gets_adc_on_before_any_conversion);
    RUN_TEST(devices_with_fewer_cells_are_masked_and_scanned_accordingly);
    RUN_TEST(waits_the_longest_delay_and_finds_flags_that_are_real);
    RUN_TEST(reports_a_line_that_is_high_without_a_reason);
    RUN_TEST(comparators_that_are_off_are_disabled);
    RUN_TEST(the_a_part_is_left_alone_where_it_differs);
    RUN_TEST(runs_without_crc_when_told_so);
    RUN_TEST(the_scrub_finds_and_repairs_one_device_at_a_time);
    RUN_TEST(switches_between_brick_and_pins);
    return UNITY_END();
}
