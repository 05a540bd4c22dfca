/* SPDX-License-Identifier: Apache-2.0 */
/* The fifteen parts: name, inputs, address, CRC, regulator; what each size has. */
#include "rig.h"

static void is_as_listed(const rig_part *p)
{
    const sim_x0_part *found = sim_x0_find_part(p->name);
    TEST_ASSERT_NOT_NULL_MESSAGE(found, p->name);
    TEST_ASSERT_EQUAL_STRING(p->name, found->name);
    TEST_ASSERT_EQUAL_MESSAGE(p->inputs, found->cells, p->name);
    TEST_ASSERT_EQUAL_MESSAGE(p->address, found->address7, p->name);
    TEST_ASSERT_EQUAL_MESSAGE(p->crc, found->crc, p->name);
    TEST_ASSERT_EQUAL_MESSAGE(p->ldo_mv, found->ldo_mv, p->name);
}

/* What the bus shows: address, bus bytes, CRC or not. */
static void behaves_as_listed(const rig_part *p)
{
    rig_boot(p->name);
    for (int address = 0; address < 128; address++) {
        TEST_ASSERT_EQUAL_MESSAGE(address == p->address, rig_answers(address), p->name);
    }
    sim_x0_i2c_start(&chip);
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, (uint8_t)(2 * p->address)));
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x0b));
    TEST_ASSERT_TRUE(sim_x0_i2c_write(&chip, 0x19));
    sim_x0_i2c_stop(&chip);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(p->crc ? 0x00 : 0x19, sim_x0_peek(&chip, 0x0b), p->name);
    TEST_ASSERT_TRUE(rig_write(0x0b, 0x19));
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x19, sim_x0_peek(&chip, 0x0b), p->name);
    expect_reg(0x0b, 0x19);
    expect_clean();
}

/*
 * proves: X0-VAR-01, X0-VAR-02, X0-VAR-03, X0-VAR-04, X0-VAR-05, X0-VAR-06, X0-VAR-07, X0-VAR-08, X0-VAR-09,
 *     X0-VAR-10, X0-VAR-11, X0-VAR-12, X0-VAR-13, X0-VAR-14, X0-VAR-15, X0-I2C-02, X0-I2C-03, X0-AMB-90,
 *     X0-AMB-103, X0-LDO-01
 */
static void test_the_fifteen_parts(void)
{
    rig_each(is_as_listed);
    rig_each(behaves_as_listed);
    for (int i = 0; i < 15; i++) {
        TEST_ASSERT_NOT_NULL(sim_x0_part_at(i));
    }
    TEST_ASSERT_NULL(sim_x0_part_at(15));
    TEST_ASSERT_NULL(sim_x0_part_at(-1));
}

/* proves: X0-VAR-16, X0-VAR-17 */
static void test_the_suffix_fixes_address_crc_and_regulator(void)
{
    static const struct {
        const char *suffix;
        int address, crc, ldo_mv;
    } rule[5] = {
        {"00", 8, 0, 2500}, {"01", 8, 1, 2500}, {"02", 8, 0, 3300}, {"03", 8, 1, 3300}, {"06", 24, 0, 3300}};
    for (int i = 0; i < 15; i++) {
        const sim_x0_part *p = sim_x0_part_at(i);
        int hits = 0;
        for (int k = 0; k < 5; k++) {
            if (strcmp(p->name + 7, rule[k].suffix) == 0) {
                TEST_ASSERT_EQUAL(rule[k].address, p->address7);
                TEST_ASSERT_EQUAL(rule[k].crc, p->crc);
                TEST_ASSERT_EQUAL(rule[k].ldo_mv, p->ldo_mv);
                hits++;
            }
        }
        TEST_ASSERT_EQUAL(1, hits);
        TEST_ASSERT_FALSE(p->crc && p->address7 == 0x18);
    }
}

/* proves: X0-VAR-21 */
static void test_any_other_name_is_refused(void)
{
    static const char *const wrong[] = {
        "",           "bq76920",    "bq7692004",     "bq7692005",  "bq7692007", "bq7694000DBT",
        "bq7694003R", "bq769400",   "BQ7694000",     "bq7695000",  "bq7694 00", "bq76PL536",
        "bq7691000",  "bq76940000", "bq7694000DBTR", " bq7694000", "bq7694010", "bq7694030"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(sim_x0_find_part(wrong[i]) == NULL, wrong[i]);
    }
    TEST_ASSERT_NULL(sim_x0_find_part(NULL));
    TEST_ASSERT_EQUAL(-1, sim_x0_init(&chip, NULL, NULL));
}

/* Only the inputs and sensors the size has can be set, and only its registers hold anything. */
static void has_what_its_size_has(const rig_part *p)
{
    int groups = p->inputs / 5;
    rig_pulse(p->name);
    for (int i = 0; i <= 16; i++) {
        TEST_ASSERT_EQUAL(i >= 1 && i <= p->inputs ? 0 : -1, sim_x0_set_cell(&chip, i, 3.0));
    }
    for (int i = 0; i <= 4; i++) {
        TEST_ASSERT_EQUAL(i >= 1 && i <= groups ? 0 : -1, sim_x0_set_ts(&chip, i, 10000.0));
    }
    rig_at(rig_first_ms());
    for (int i = 0; i < 15; i++) {
        TEST_ASSERT_EQUAL_HEX16(i < p->inputs ? 7853 : 0, rig_read16(0x0c + 2 * i));
    }
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX16(i < groups ? 3141 : 0, rig_read16(0x2c + 2 * i));
        TEST_ASSERT_TRUE(rig_write(0x01 + i, 0x01));
        expect_reg(0x01 + i, i < groups ? 0x01 : 0x00);
    }
    TEST_ASSERT_EQUAL(groups < 3 ? (uint32_t)(3 - groups) : 0u, sim_x0_misuse(&chip)->count);
    TEST_ASSERT_EQUAL(sim_x0_misuse(&chip)->count, sim_misuse_of(sim_x0_misuse(&chip), "X0-AMB-85"));
}

/* proves: X0-VAR-20, X0-AMB-85, X0-PIN-04, X0-CELL-22, X0-AMB-11 */
static void test_what_each_size_has(void)
{
    rig_each(has_what_its_size_has);
}

/* Nothing the bus can write changes address, CRC or trim. */
static void keeps_its_factory_options(const rig_part *p)
{
    rig_boot(p->name);
    (void)sim_x0_set_gain(&chip, 377);
    (void)sim_x0_set_offset(&chip, 48);
    for (int reg = 0x0c; reg < 0x100; reg++) {
        TEST_ASSERT_TRUE(rig_write(reg, 0xff));
    }
    sim_misuse_clear(sim_x0_misuse(&chip));
    TEST_ASSERT_TRUE(rig_answers(p->address));
    expect_reg(0x50, 0x04);
    expect_reg(0x59, 0x80);
    expect_reg(0x51, 48);
    TEST_ASSERT_TRUE(rig_write(0x04, 0x11));
    TEST_ASSERT_TRUE(rig_write(0x04, 0x12)); /* SHIP and back */
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(11);
    expect_reg(0x50, 0x04);
    expect_reg(0x59, 0x80);
    expect_reg(0x51, 48);
    expect_clean();
}

/* proves: X0-VAR-18, X0-ADC-06 */
static void test_factory_options_cannot_be_written(void)
{
    rig_each(keeps_its_factory_options);
}

static void counts_as(const char *name, unsigned in_use, int cells)
{
    uint8_t raw[30];
    int found = 0;
    rig_pulse(name);
    for (int i = 0; i < chip.part->cells; i++) {
        TEST_ASSERT_EQUAL(0, sim_x0_set_cell(&chip, i + 1, (in_use >> i & 1u) != 0 ? 3.6 : 0.0));
    }
    rig_at(rig_first_ms());
    rig_block_read(0x0c, raw, 2 * chip.part->cells);
    for (int i = 0; i < chip.part->cells; i++) {
        int code = raw[2 * i] << 8 | raw[2 * i + 1];
        TEST_ASSERT_EQUAL((in_use >> i & 1u) != 0 ? 9424 : 0, code);
        found += code >= 0x0518;
    }
    TEST_ASSERT_EQUAL(cells, found);
    rig_wait(20000);
    expect_stat(0x00); /* shorted inputs raise no undervoltage, no setting needed */
    for (int g = 0; g < chip.part->cells / 5; g++) {
        unsigned mask = in_use >> 5 * g & 0x1fu;
        for (unsigned bit = 0; bit < 5; bit++) {
            TEST_ASSERT_TRUE(rig_write(1 + g, (int)(1u << bit)));
            if ((mask >> bit & 1u) != 0) {
                expect_clean(); /* the CELLBAL mask of the row */
            } else {
                expect_misuse("X0-CB-06");
            }
        }
        TEST_ASSERT_TRUE(rig_write(1 + g, 0));
    }
}

/*
 * proves: X0-CELL-01, X0-CELL-02, X0-CELL-03, X0-CELL-04, X0-CELL-05, X0-CELL-06, X0-CELL-07, X0-CELL-08,
 *     X0-CELL-09, X0-CELL-10, X0-CELL-11, X0-CELL-12, X0-CELL-13, X0-CELL-14, X0-CELL-15, X0-VAR-22,
 *     X0-UV-07, X0-CELL-22, X0-CB-02
 */
static void test_every_wiring_with_fewer_cells(void)
{
    static const unsigned wiring[3][7] = {
        {0x0013, 0x0017, 0x001f},
        {0x0273, 0x0277, 0x02f7, 0x02ff, 0x03ff},
        {0x4e73, 0x4e77, 0x4ef7, 0x5ef7, 0x5eff, 0x5fff, 0x7fff},
    };
    static const int least[3] = {3, 6, 9}, rows[3] = {3, 5, 7};
    static const char *const name[3] = {"bq7692000", "bq7693003", "bq7694006"};
    for (int size = 0; size < 3; size++) {
        for (int row = 0; row < rows[size]; row++) {
            counts_as(name[size], wiring[size][row], least[size] + row);
        }
    }
}

/* proves: X0-CELL-23 */
static void test_cells_may_be_connected_in_any_order(void)
{
    static const int order[5] = {3, 1, 5, 2, 4};
    rig_ship("bq7692000");
    for (int i = 1; i <= 5; i++) {
        (void)sim_x0_set_cell(&chip, i, 0.0);
    }
    for (int i = 0; i < 5; i++) {
        rig_wait(100);
        (void)sim_x0_set_cell(&chip, order[i], 3.6);
        TEST_ASSERT_EQUAL(SIM_X0_SHIP, chip.mode);
    }
    (void)sim_x0_boot(&chip, 3 * MS);
    rig_wait(260);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL(9424, rig_read16(0x0c + 2 * i));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_fifteen_parts);
    RUN_TEST(test_the_suffix_fixes_address_crc_and_regulator);
    RUN_TEST(test_any_other_name_is_refused);
    RUN_TEST(test_what_each_size_has);
    RUN_TEST(test_factory_options_cannot_be_written);
    RUN_TEST(test_every_wiring_with_fewer_cells);
    RUN_TEST(test_cells_may_be_connected_in_any_order);
    return UNITY_END();
}
