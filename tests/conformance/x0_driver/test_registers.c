/* SPDX-License-Identifier: Apache-2.0 */
/* Every register as the driver uses it: each bit is put into the model's register file by hand and must show
 * up in the one reading it belongs to, or is set by the driver and must be found in its register. */
#include "bench.h"
#include "rows.h"

void setUp(void)
{
}
void tearDown(void)
{
}

/* resistance = 2 x tenths of a degree, so that a code can be read back */
static const uint32_t straight_ohms[2] = {60000, 0};
static const bq_thermistor straight = {straight_ohms, 2, 0, 30000};

static uint16_t code[15], ts[3], bat;

static void put(unsigned reg, unsigned value)
{
    b.chip.reg[reg] = (uint8_t)(value >> 8);
    b.chip.reg[reg + 1] = (uint8_t)value;
}

/* `extra` are the bits above D13, which the row says are zero and the driver masks all the same. */
static void put_picture(unsigned extra)
{
    unsigned i, sum = 0;
    for (i = 0; i < b.chip.part->cells; i++) {
        put(0x0c + 2 * i, code[i] | extra);
        sum += code[i];
    }
    bat = (uint16_t)(sum / 4);
    put(0x2a, bat);
    for (i = 0; i < b.chip.part->cells / 5u; i++)
        put(0x2c + 2 * i, ts[i] | extra);
}

static void with_straight_sensors(const char *name)
{
    unsigned i;
    bench_part(name, NULL);
    b.cfg.sensor_ctx = &straight;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    bench_serve(2750, 250);
    sim_x0_freeze(&b.chip, true); /* nothing but the test writes measurements from now on */
    for (i = 0; i < 15; i++)
        code[i] = 9000;
    for (i = 0; i < 3; i++)
        ts[i] = 1500;
}

static int expected_dc(unsigned c)
{
    double volts = c * 382e-6, ohms = 10000.0 * volts / (3.3 - volts);
    return (int)((60000.0 - ohms) / 2.0 + 0.5);
}

static void expect_picture(void)
{
    unsigned i;
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    for (i = 0; i < b.chip.part->cells; i++)
        TEST_ASSERT_EQUAL((code[i] * 382u + 500u) / 1000u, b.cells[i].mv);
    for (i = 0; i < b.chip.part->cells / 5u; i++)
        TEST_ASSERT_INT_WITHIN(2, expected_dc(ts[i]), b.temps[i].dc);
}

/* proves: X0-REG-0C, X0-REG-0D, X0-REG-0E, X0-REG-0F, X0-REG-10, X0-REG-11, X0-REG-12, X0-REG-13, X0-REG-14,
   X0-REG-15, X0-REG-16, X0-REG-17, X0-REG-18, X0-REG-19, X0-REG-1A, X0-REG-1B, X0-REG-1C, X0-REG-1D,
   X0-REG-1E, X0-REG-1F, X0-REG-20, X0-REG-21, X0-REG-22, X0-REG-23, X0-REG-24, X0-REG-25, X0-REG-26,
   X0-REG-27, X0-REG-28, X0-REG-29, X0-ADC-01, X0-ADC-02, X0-AMB-13, X0-BAT-01, X0-AMB-11 */
static void test_each_bit_of_each_cell_register(void)
{
    static const char *const name[3] = {"bq7692003", "bq7693000", "bq7694003"};
    unsigned k, i, bit;
    for (k = 0; k < 3; k++) {
        with_straight_sensors(name[k]);
        for (i = 0; i < b.chip.part->cells; i++)
            for (bit = 0; bit < 14; bit++) {
                code[i] = (uint16_t)(9000 ^ 1u << bit);
                put_picture(bit & 1 ? 0xc000 : 0);
                expect_picture();
                code[i] = 9000;
            }
        NO_MISUSE();
    }
}

/* proves: X0-REG-2C, X0-REG-2D, X0-REG-2E, X0-REG-2F, X0-REG-30, X0-REG-31, X0-TS-01, X0-TS-02, X0-TS-03,
   X0-TS-04, X0-TS-05, X0-TS-08, X0-AMB-13, X0-AMB-31, X0-AMB-32 */
static void test_each_bit_of_each_temperature_register(void)
{
    static const char *const name[3] = {"bq7692003", "bq7693000", "bq7694003"};
    unsigned k, i, bit;
    for (k = 0; k < 3; k++) {
        with_straight_sensors(name[k]);
        for (i = 0; i < b.chip.part->cells / 5u; i++)
            for (bit = 0; bit < 13; bit++) { /* bit 13 alone is near an open input */
                ts[i] = (uint16_t)(1500 ^ 1u << bit);
                put_picture(bit & 1 ? 0xc000 : 0);
                expect_picture();
                ts[i] = 1500;
            }
    }
}

/* proves: X0-REG-2A, X0-REG-2B, X0-BAT-05, X0-SEQ-23, X0-AMB-09, X0-AMB-10, X0-NUM-113 */
static void test_each_bit_of_the_stack_register_is_a_cross_check(void)
{
    static const char *const name[3] = {"bq7692003", "bq7693000", "bq7694003"};
    unsigned k, bit;
    int off;
    for (k = 0; k < 3; k++) {
        with_straight_sensors(name[k]);
        for (bit = 0; bit < 5; bit++)
            code[bit] = 9423; /* five of them: 11778.75 */
        put_picture(0);
        if (k == 0)
            TEST_ASSERT_EQUAL(11778, bat);
        for (off = -1; off <= 1; off++) { /* within 1 */
            put(0x2a, (unsigned)((int)bat + off));
            TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[0].quality);
            TEST_ASSERT_EQUAL(BQ_Q_VALID, b.module.quality);
        }
        for (bit = 1; bit < 16; bit++) {
            uint32_t before = bench_stats()->implausible;
            put(0x2a, bat ^ 1u << bit);
            (void)bench_scan();
            TEST_ASSERT_FALSE(b.cells[0].quality & BQ_Q_VALID);
            TEST_ASSERT_FALSE(b.module.quality & BQ_Q_VALID);
            TEST_ASSERT_TRUE(bench_stats()->implausible > before);
        }
        put(0x2a, bat);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(BQ_Q_VALID, b.cells[0].quality);
    }
}

/* proves: X0-REG-32, X0-REG-33, X0-CC-01, X0-CC-03, X0-AMB-23 */
static void test_each_bit_of_the_current_register(void)
{
    unsigned bit;
    bench_part("bq7692003", NULL);
    b.cfg.shunt_uohm = 8440; /* one code is one milliampere */
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    sim_x0_freeze(&b.chip, true);
    for (bit = 0; bit < 16; bit++) {
        put(0x32, 0x1234u ^ 1u << bit);
        bench_wait(250);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL((int16_t)(0x1234u ^ 1u << bit), b.sample.current_ma);
    }
}

/* proves: X0-REG-01, X0-REG-02, X0-REG-03, X0-CB-01, X0-AMB-85 */
static void test_each_balancing_bit(void)
{
    unsigned k, cell;
    for (k = 0; k < 15; k++) {
        bench_up(sim_x0_part_at((int)k)->name);
        bench_serve(500, 250);
        for (cell = 1; cell <= b.chip.part->cells; cell++) {
            uint8_t want[3] = {0, 0, 0};
            want[(cell - 1) / 5] = (uint8_t)(1u << (cell - 1) % 5);
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(true, true, 1u << (cell - 1)));
            TEST_ASSERT_EQUAL_HEX8(want[0], sim_x0_peek(&b.chip, 0x01));
            TEST_ASSERT_EQUAL_HEX8(want[1], sim_x0_peek(&b.chip, 0x02));
            TEST_ASSERT_EQUAL_HEX8(want[2], sim_x0_peek(&b.chip, 0x03));
        }
        NO_MISUSE();
    }
}

/* proves: X0-REG-04, X0-REG-05, X0-REG-0B, X0-FET-01, X0-AMB-14, X0-AMB-56, X0-BIT-03, X0-BIT-04, X0-DLY-01
 */
static void test_control_registers(void)
{
    unsigned k, fets, die;
    uint64_t n;
    for (k = 0; k < 15; k++)
        for (die = 0; die < 2; die++) {
            bench_part(sim_x0_part_at((int)k)->name, NULL);
            if (die)
                b.cfg.sensors = 0;
            TEST_ASSERT_EQUAL(BQ_OK, bench_init());
            TEST_ASSERT_EQUAL(BQ_OK, bench_start());
            TEST_ASSERT_TRUE(bench_writes(0, 0x04, NULL) >= 1); /* not left to what the part sets by itself */
            bench_serve(2750, 250);
            for (fets = 0; fets < 4; fets++) {
                TEST_ASSERT_EQUAL(BQ_OK, bench_apply(fets & 1, fets & 2, 0));
                TEST_ASSERT_EQUAL_HEX8(0x40 | fets, sim_x0_peek(&b.chip, 0x05));
                TEST_ASSERT_EQUAL((fets & 1) != 0, sim_x0_chg(&b.chip));
                TEST_ASSERT_EQUAL((fets & 2) != 0, sim_x0_dsg(&b.chip));
            }
            TEST_ASSERT_EQUAL_HEX8(die ? 0x10 : 0x18, sim_x0_peek(&b.chip, 0x04));
            TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, 0));
            (void)sim_x0_set_chgpin(&b.chip, 3.0); /* LOAD_PRESENT reads 1 and is no configuration */
            n = b.count;
            bench_serve(2500, 250);
            b.action.charge_on = b.action.discharge_on = false;
            TEST_ASSERT_EQUAL(0, bench_writes(n, 0x04, NULL));
            TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
            for (n = 0; n < b.count; n++) {
                const bench_entry *e = bench_log(n);
                if (e->wrote > 0 && e->reg <= 4 && e->reg + e->wrote > 4)
                    TEST_ASSERT_EQUAL_HEX8(0, e->data[4 - e->reg] & 0xe7);
                if (e->wrote > 0 && e->reg <= 5 && e->reg + e->wrote > 5)
                    TEST_ASSERT_EQUAL_HEX8(0, e->data[5 - e->reg] & 0x9c);
            }
            NO_MISUSE();
        }
}

/* proves: X0-REG-50, X0-REG-51, X0-REG-59, X0-ADC-03, X0-ADC-04, X0-ADC-05, X0-ADC-06, X0-OV-14 */
static void test_trim_registers(void)
{
    int gain, n = 0;
    for (gain = 365; gain <= 396; gain++) {
        int offset = -128 + (gain - 365) * 255 / 31;
        int32_t lsb = gain, ov;
        bench_part("bq7692003", NULL);
        (void)sim_x0_set_gain(&b.chip, gain);
        (void)sim_x0_set_offset(&b.chip, offset);
        b.chip.rsvd50 = (uint8_t)(n & 1 ? 0xf3 : 0);
        b.chip.rsvd59 = (uint8_t)(n++ & 2 ? 0x1f : 0);
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(gain, bq769x0_get_achieved(&b.d)->trim.gain_uv);
        TEST_ASSERT_EQUAL(offset, bq769x0_get_achieved(&b.d)->trim.offset_mv);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        ov = (0x2000 + 16 * sim_x0_peek(&b.chip, 0x09) + 8) * lsb + 1000 * offset;
        TEST_ASSERT_TRUE(ov <= 4200000 && ov > 4200000 - 16 * lsb);
        NO_MISUSE();
    }
}

/* proves: X0-REG-00, X0-BIT-09, X0-AMB-51 */
static void test_each_status_bit(void)
{
    static const uint16_t flag[6] = {BQ_F_OVERCURRENT, BQ_F_SHORT, BQ_F_CELL_OV,
                                     BQ_F_CELL_UV,     BQ_F_CHAIN, BQ_F_MEMORY};
    unsigned bit;
    uint64_t n;
    for (bit = 0; bit < 6; bit++) {
        bench_up("bq7692003");
        bench_serve(2750, 250);
        TEST_ASSERT_TRUE(bench_until(true, true, 1000) < 1000);
        b.chip.reg[0] = (uint8_t)(b.chip.reg[0] | 1u << bit);
        n = b.count;
        bench_serve(500, 250);
        TEST_ASSERT_EQUAL_HEX16(flag[bit], b.module.faults);
        TEST_ASSERT_TRUE(bench_until(true, true, 20000) < 20000);
        bench_serve(500, 250);
        TEST_ASSERT_EQUAL_HEX16(0, b.module.faults);
        for (; n < b.count; n++) { /* exactly this bit is cleared, and CC_READY; b6 never */
            const bench_entry *e = bench_log(n);
            if (e->wrote > 0 && e->reg == 0)
                TEST_ASSERT_EQUAL_HEX8(0, e->data[0] & ~(0x80u | 1u << bit));
        }
        NO_MISUSE();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_bit_of_each_cell_register);
    RUN_TEST(test_each_bit_of_each_temperature_register);
    RUN_TEST(test_each_bit_of_the_stack_register_is_a_cross_check);
    RUN_TEST(test_each_bit_of_the_current_register);
    RUN_TEST(test_each_balancing_bit);
    RUN_TEST(test_control_registers);
    RUN_TEST(test_trim_registers);
    RUN_TEST(test_each_status_bit);
    return UNITY_END();
}
