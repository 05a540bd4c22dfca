/* SPDX-License-Identifier: Apache-2.0 */
/* The base set: what a small firmware links measures, protects and balances. */
#include "bqhost/bq769x0_regs.h"
#include "x0_rig.h"
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static bq_status init_known(void)
{
    bq_i2c i2c = hal_sim_x0_i2c(&rig.hal);
    bq_clock clock = hal_sim_x0_clock(&rig.hal);
    bq769x0_known known;
    bq_status st = bq769x0_known_of(&rig.config, &known);
    if (st == BQ_OK) {
        bq769x0_init_known(&rig.d, &known, &i2c, &clock);
    }
    return st;
}

static bq_status configure(void)
{
    return rig_run(bq769x0_begin_configure(&rig.d));
}

static bq_status measure(void)
{
    return rig_run(bq769x0_begin_measure(&rig.d));
}

static bq769x0_reading r;

/* Everything there is to read; the events of SYS_STAT. */
static unsigned look(void)
{
    bq769x0_read(&rig.d, &r);
    for (unsigned n = 0; n < rig.config.cells; n++) {
        bq769x0_read_cell(&rig.d, n, &rig.cells[n]);
    }
    for (unsigned n = 0; n < rig.config.sensors; n++) {
        bq769x0_read_temp(&rig.d, n, &rig.temps[n]);
    }
    return r.events;
}

static bq_status outputs(unsigned fets, unsigned cells)
{
    return rig_run(bq769x0_begin_outputs(&rig.d, fets, cells));
}

/* An awake part with a configuration that says what it is. */
static void awake(const char *name, unsigned cells)
{
    rig_part(name, cells);
    rig.config.wiring = bq769x0_wiring(rig.config.inputs, (uint8_t)cells);
    rig.config.address7 = rig.chip.part->address7;
    rig.config.crc = rig.chip.part->crc ? BQ769X0_CRC_ON : BQ769X0_CRC_OFF;
    (void)sim_x0_boot(&rig.chip, 3000000);
    rig_wait_ms(1000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, init_known());
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq769x0_begin_measure(&rig.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq769x0_begin_clear(&rig.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, configure());
}

static void loop(unsigned ms)
{
    for (unsigned t = 0; t < ms; t += 250u) {
        rig_wait_ms(230);
        TEST_ASSERT_EQUAL_INT(BQ_OK, measure());
    }
}

/* proves: X0-SEQ-15, X0-SEQ-16, X0-SEQ-21, X0-SEQ-22 */
static void test_every_part_is_configured_and_measured(void)
{
    for (int k = 0; k < 15; k++) {
        const sim_x0_part *part = sim_x0_part_at(k);
        const bq769x0_achieved *a;
        uint64_t transactions;
        awake(part->name, part->cells);
        (void)sim_x0_set_sense(&rig.chip, -0.010);
        loop(3000);
        a = bq769x0_get_achieved(&rig.d);
        TEST_ASSERT_EQUAL_HEX8(0x8b, rig_reg(0x06));
        TEST_ASSERT_EQUAL_HEX8(0x5a, rig_reg(0x07));
        TEST_ASSERT_EQUAL_HEX8(0x50, rig_reg(0x08));
        TEST_ASSERT_EQUAL_HEX8(a->ov_trip, rig_reg(0x09));
        TEST_ASSERT_EQUAL_HEX8(a->uv_trip, rig_reg(0x0a));
        TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
        TEST_ASSERT_EQUAL_HEX8(0x18, rig_reg(0x04));
        TEST_ASSERT_EQUAL_HEX8(0x40, rig_reg(0x05));
        transactions = rig.hal.transactions;
        loop(250);
        TEST_ASSERT_EQUAL_UINT(part->cells == 15 ? 3 : 4, rig.hal.transactions - transactions);
        TEST_ASSERT_EQUAL_HEX8(0, look());
        for (unsigned i = 0; i < part->cells; i++) {
            TEST_ASSERT_UINT_WITHIN(1, 3600, rig.cells[i].mv);
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[i].quality);
        }
        TEST_ASSERT_INT_WITHIN(3, 250, rig.temps[0].dc);
        TEST_ASSERT_TRUE(r.current_valid);
        TEST_ASSERT_INT_WITHIN(2, -2000, r.current_ma);
        rig_clean();
    }
}

/* proves: X0-SEQ-28, X0-FET-13, X0-BIT-09, X0-SEQ-41 */
static void test_a_fault_is_reported_kept_and_cleared_on_request(void)
{
    awake("bq7693003", 8);
    loop(3000);
    TEST_ASSERT_EQUAL_INT(BQ_OK, outputs(3, 0x01));
    TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&rig.chip));
    (void)sim_x0_set_cell(&rig.chip, 1, 4.3);
    loop(3500);
    TEST_ASSERT_EQUAL_HEX8(BQ769X0_STAT_OV, look());
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, outputs(3, 0x01)); /* asked for, not done */
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip));
    TEST_ASSERT_TRUE(sim_x0_dsg(&rig.chip));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    TEST_ASSERT_EQUAL_HEX8(0x42, rig_reg(0x05)); /* register and pins agree */
    (void)sim_x0_set_cell(&rig.chip, 1, 3.6);
    loop(1000);
    TEST_ASSERT_EQUAL_HEX8(BQ769X0_STAT_OV, look()); /* latched */
    (void)sim_x0_set_sense(&rig.chip, -0.150);       /* another one in between is not cleared unseen */
    rig_wait_ms(1);
    (void)sim_x0_set_sense(&rig.chip, 0.0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_clear(&rig.d)));
    loop(250);
    TEST_ASSERT_EQUAL_HEX8(BQ769X0_STAT_SCD, look());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_clear(&rig.d)));
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, outputs(3, 0)); /* not before it was seen to be gone */
    TEST_ASSERT_FALSE(sim_x0_dsg(&rig.chip));
    loop(250);
    TEST_ASSERT_EQUAL_HEX8(0, look());
    TEST_ASSERT_EQUAL_INT(BQ_OK, outputs(3, 0));
    TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
    rig_clean();
}

/* proves: X0-SEQ-48, X0-SEQ-51 */
static void test_a_disturbed_and_a_dead_bus(void)
{
    awake("bq7694003", 15);
    loop(3000);
    for (unsigned bit = 0; bit < 700u; bit += 7u) {
        (void)sim_x0_flip_sda(&rig.chip, (int)bit);
        loop(250);
        TEST_ASSERT_EQUAL_HEX8(0, look());
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[14].quality);
        TEST_ASSERT_UINT_WITHIN(1, 3600, rig.cells[14].mv);
    }
    sim_x0_bus(&rig.chip)->dead = 2;
    TEST_ASSERT_TRUE(measure() < 0);
    (void)look();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, rig.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, rig.temps[0].quality);
    sim_x0_bus(&rig.chip)->dead = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, measure());
    TEST_ASSERT_EQUAL_HEX8(0, look());
}

static void test_what_init_refuses(void)
{
    bq769x0_config good;
    awake("bq7693003", 8);
    good = rig.config;
    rig.config.wiring = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, init_known());
    rig.config.wiring = 0x02f3; /* seven cells */
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, init_known());
    rig.config = good;
    rig.config.wiring = (uint16_t)(good.wiring << 1);
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, init_known());
    rig.config = good;
    rig.config.shunt_uohm = 99;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, init_known());
    rig.config.shunt_uohm = 100001;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, init_known());
    rig.config = good;
    rig.config.sensors = 3;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, init_known());
    rig.config = good;
    rig.config.sensor = NULL;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, init_known());
    rig.config = good;
    rig.config.ocd_delay_ms = 7;
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, init_known());
    rig.config = good;
    rig.config.uv_delay_s = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, init_known());
    rig.config = good;
    rig.config.scd_ma = rig.config.ocd_ma;
    TEST_ASSERT_EQUAL_INT(BQ_E_CONFIG, init_known());
    TEST_ASSERT_EQUAL_INT(BQ_OK, measure()); /* the instance is as before */
    rig.config = good;
    rig.config.ov_mv = 5000;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init_known());
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, configure());
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, bq769x0_begin_measure(&rig.d));
}

/* proves: X0-SEQ-05, X0-SEQ-38, X0-SEQ-43 */
static void test_nothing_is_on_before_a_temperature_is_known(void)
{
    awake("bq7694003", 15);
    (void)look();
    TEST_ASSERT_EQUAL_HEX8(0, rig.cells[0].quality & BQ_Q_VALID); /* no picture yet */
    TEST_ASSERT_FALSE(r.current_valid);
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, outputs(3, 0x0001));
    loop(1000);
    (void)look();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_CHIP, rig.temps[0].quality);
    TEST_ASSERT_EQUAL_INT(BQ_E_STATE, outputs(3, 0x0001));
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    loop(1500);
    TEST_ASSERT_EQUAL_INT(BQ_OK, outputs(3, 0x0001));
    TEST_ASSERT_TRUE(sim_x0_chg(&rig.chip) && sim_x0_dsg(&rig.chip));
    TEST_ASSERT_EQUAL_HEX16(1, sim_x0_cb(&rig.chip));
    rig_clean();
}

/* proves: X0-DIE-02, X0-SEQ-17 */
static void test_the_die_as_the_source(void)
{
    awake("bq7692003", 5);
    rig.config.sensors = 0;
    rig.config.sensor = NULL;
    TEST_ASSERT_EQUAL_INT(BQ_OK, init_known());
    (void)sim_x0_set_tdie(&rig.chip, 40.0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, configure());
    TEST_ASSERT_EQUAL_HEX8(0x10, rig_reg(0x04));
    loop(3000);
    bq769x0_read_temp(&rig.d, 0, &rig.temps[0]);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.temps[0].quality);
    TEST_ASSERT_INT_WITHIN(3, 400, rig.temps[0].dc);
    rig_clean();
}

/* A part with eight cells as a constant: limits by the compiler, temperatures by codes. */
static const bq769x0_known constant = {
    BQ769X0_PART(10, 0x02f7u),
    .address7 = 0x08,
    .crc = true,
    .registers = BQ769X0_REGISTERS(BQ769X0_THERMISTORS, BQ769X0_SHUNT_MV(75000, 1000), 320,
                                   BQ769X0_SHUNT_MV(125000, 1000), 100, 2, 4),
    .counter = BQ769X0_CTRL2_CC_EN,
    .ov_mv = 4250,
    .uv_mv = 2800,
    .shunt_uohm = 1000,
    .sensor = bq769x0_sensor_codes,
    .sensor_ctx = &bq769x0_codes_103at};

/* proves: X0-SEQ-15, X0-SEQ-22, X0-CELL-18, X0-CC-13 */
static void test_a_part_that_is_a_constant(void)
{
    bq_i2c i2c;
    bq_clock clock;
    awake("bq7693003", 8);
    i2c = hal_sim_x0_i2c(&rig.hal);
    clock = hal_sim_x0_clock(&rig.hal);
    bq769x0_init_known(&rig.d, &constant, &i2c, &clock);
    TEST_ASSERT_EQUAL_INT(BQ_OK, configure());
    TEST_ASSERT_EQUAL_HEX8(0x8b, rig_reg(0x06));
    TEST_ASSERT_EQUAL_HEX8(0x5a, rig_reg(0x07));
    TEST_ASSERT_EQUAL_HEX8(0x50, rig_reg(0x08));
    TEST_ASSERT_EQUAL_HEX8(0x18, rig_reg(0x04));
    for (unsigned n = 0; n < 8u; n++) {
        (void)sim_x0_set_cell(&rig.chip, (int)rig_input(n + 1u), 3.4 + 0.05 * n);
    }
    (void)sim_x0_set_sense(&rig.chip, -0.010);
    loop(3000);
    TEST_ASSERT_EQUAL_HEX8(0, look());
    for (unsigned n = 0; n < 8u; n++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, rig.cells[n].quality);
        TEST_ASSERT_UINT_WITHIN(1, 3400u + 50u * n, rig.cells[n].mv);
    }
    TEST_ASSERT_INT_WITHIN(2, 250, rig.temps[0].dc);
    TEST_ASSERT_INT_WITHIN(2, 250, rig.temps[1].dc);
    TEST_ASSERT_TRUE(r.current_valid);
    TEST_ASSERT_INT_WITHIN(10, -10000, r.current_ma);
    rig_clean();
}

/* A part described by hand with something left out: measured without converter it would look healthy. */
static void test_a_part_half_described_is_not_configured(void)
{
    bq769x0_known whole;
    awake("bq7694003", 15);
    TEST_ASSERT_EQUAL(BQ_OK, bq769x0_known_of(&rig.config, &whole));
    for (int left_out = 0; left_out < 4; left_out++) {
        bq_i2c i2c = hal_sim_x0_i2c(&rig.hal);
        bq_clock clock = hal_sim_x0_clock(&rig.hal);
        bq769x0_known known = whole;
        if (left_out == 0) {
            memset(known.registers, 0, sizeof known.registers);
        } else if (left_out == 1) {
            known.shunt_uohm = 0;
        } else if (left_out == 2) {
            known.sensor = NULL;
        }
        bq769x0_init_known(&rig.d, &known, &i2c, &clock);
        TEST_ASSERT_EQUAL(left_out < 3 ? BQ_E_CONFIG : BQ_OK, configure());
        TEST_ASSERT_EQUAL(left_out < 3 ? BQ_E_STATE : BQ_OK, bq769x0_begin_outputs(&rig.d, 0, 0));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_part_is_configured_and_measured);
    RUN_TEST(test_a_fault_is_reported_kept_and_cleared_on_request);
    RUN_TEST(test_a_disturbed_and_a_dead_bus);
    RUN_TEST(test_what_init_refuses);
    RUN_TEST(test_nothing_is_on_before_a_temperature_is_known);
    RUN_TEST(test_the_die_as_the_source);
    RUN_TEST(test_a_part_that_is_a_constant);
    RUN_TEST(test_a_part_half_described_is_not_configured);
    return UNITY_END();
}
