/* SPDX-License-Identifier: Apache-2.0 */
/* The record: its form, every field, what is refused. */
#include "bqhost/bq769x0.h"
#include "fake_nvm.h"
#include "objects.h"
#include "unity.h"
#include <string.h>

static objects a, b;
static fake_nvm flash;
static bq_nvm nvm;
static uint8_t record[NVM_BYTES];

void setUp(void)
{
    objects_init(&a);
    objects_init(&b);
    fake_nvm_init(&flash, 8);
    nvm = fake_nvm_ops(&flash, 2);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, flash.breaches);
}

static uint32_t word(size_t n)
{
    const uint8_t *w = &record[4u * n];

    return (uint32_t)w[0] | (uint32_t)w[1] << 8 | (uint32_t)w[2] << 16 | (uint32_t)w[3] << 24;
}

static void set_word(size_t n, uint32_t value)
{
    for (unsigned i = 0; i < 4u; i++) {
        record[4u * n + i] = (uint8_t)(value >> (8u * i));
    }
}

/* Encodes `a` and puts it into a sector. */
static size_t place(uint8_t sector, uint32_t sequence)
{
    const size_t len = bq_settings_encode(&a.settings, sequence, record, sizeof record);

    memcpy(flash.memory[sector], record, len);
    return len;
}

/* The record with one word changed and a right CRC, in sector 0. */
static void place_changed(size_t n, uint32_t value)
{
    const size_t len = bq_settings_encode(&a.settings, 1, record, sizeof record);

    set_word(n, value);
    set_word(1, bq_crc32(0, record + 8, len - 8u));
    memcpy(flash.memory[0], record, len);
}

/* Check value of CRC-32/ISO-HDLC in the catalogue of CRCs: "123456789" gives cbf43926. */
static void test_crc_is_that_of_zlib(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u, bq_crc32(0, "123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u, bq_crc32(bq_crc32(0, "1234", 4), "56789", 5));
    TEST_ASSERT_EQUAL_HEX32(0, bq_crc32(0, "", 0));
}

static void test_the_form_of_a_record(void)
{
    const size_t words = 5u + 37u + 2u * 64u + 30u + 62u; /* head, loop and pack, curve, driver, cells */
    const size_t len = bq_settings_encode(&a.settings, 0x01020304u, record, sizeof record);

    TEST_ASSERT_EQUAL((words + 1u) / 2u * 8u, len);
    TEST_ASSERT_EQUAL_MEMORY("BQCF", record, 4);
    TEST_ASSERT_EQUAL_HEX32(bq_crc32(0, record + 8, len - 8u), word(1));
    TEST_ASSERT_EQUAL_HEX32(1u << 16 | (uint32_t)(len / 4u), word(2));
    TEST_ASSERT_EQUAL_HEX32(bq_settings_layout(&a.settings), word(3));
    TEST_ASSERT_EQUAL_HEX32(0x01020304u, word(4));
    TEST_ASSERT_EQUAL(100, word(5));                      /* period_ms */
    TEST_ASSERT_EQUAL_HEX32(0xffffff38u, word(5u + 14u)); /* undertemp_dc = -200 */
    TEST_ASSERT_EQUAL_HEX32(a.cells[BQ76PL536_MAX_DEVICES - 1u], word(words - 1u));
    TEST_ASSERT_EQUAL(0, bq_settings_encode(&a.settings, 1, record, len - 1u));
    a.parts[3].count--; /* an odd number of words is filled up */
    TEST_ASSERT_EQUAL(len, bq_settings_encode(&a.settings, 1, record, sizeof record));
    TEST_ASSERT_EQUAL_HEX32(0xffffffffu, word(words - 1u));
}

/* The layout does not depend on where a compiler puts a field. */
static void test_layout_follows_shape_and_meaning_not_offsets(void)
{
    static const bq_field one[] = {BQ_FIELD_AT(0, 2, BQ_FIELD_UNSIGNED), BQ_FIELD_AT(4, 1, BQ_FIELD_BOOL)};
    static const bq_field moved[] = {BQ_FIELD_AT(8, 2, BQ_FIELD_UNSIGNED), BQ_FIELD_AT(3, 1, BQ_FIELD_BOOL)};
    static const bq_field wider[] = {BQ_FIELD_AT(0, 4, BQ_FIELD_UNSIGNED), BQ_FIELD_AT(4, 1, BQ_FIELD_BOOL)};
    static const bq_field other_kind[] = {BQ_FIELD_AT(0, 2, BQ_FIELD_SIGNED),
                                          BQ_FIELD_AT(4, 1, BQ_FIELD_BOOL)};
    const bq_field_table tables[] = {{one, 2, 1, 8},        {moved, 2, 1, 16}, {wider, 2, 1, 8},
                                     {other_kind, 2, 1, 8}, {one, 1, 1, 8},    {one, 2, 2, 8}};
    uint32_t layout[6];

    for (int i = 0; i < 6; i++) {
        const bq_settings_part part = {&tables[i], NULL, 1};
        const bq_settings s = {&part, 1};
        layout[i] = bq_settings_layout(&s);
    }
    TEST_ASSERT_EQUAL_HEX32(layout[0], layout[1]);
    for (int i = 2; i < 6; i++) {
        TEST_ASSERT_NOT_EQUAL(layout[0], layout[i]);
    }
}

/* How many bytes of an object the table covers: those that a record of zeros clears. */
static size_t covered(const bq_field_table *table, void *object, size_t size)
{
    const bq_settings_part part = {table, object, 1};
    const bq_settings s = {&part, 1};
    size_t cleared = 0;
    size_t len;

    memset(object, 0, size);
    fake_nvm_init(&flash, 8);
    nvm = fake_nvm_ops(&flash, 2);
    len = bq_settings_encode(&s, 1, record, sizeof record);
    memcpy(flash.memory[0], record, len);
    memset(object, 0xa5, size);
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&s, &nvm));
    for (size_t i = 0; i < size; i++) {
        cleared += ((const uint8_t *)object)[i] == 0u;
    }
    return cleared;
}

/* Every integer field is in its table: what stays is pointers and padding. */
static void test_tables_leave_no_field_out(void)
{
    static union {
        bq_app_config app;
        bq76pl536_config stack;
        bq769x0_config afe;
    } u;
    const size_t app = 3u * 4u + 1u + 22u * 2u + 2u * 1u + 3u * 4u + 1u + 2u + 4u * 4u;
    const size_t stack = 18u * 1u + 9u * 2u + 3u * 4u;
    const size_t afe = 15u * 1u + 11u * 2u + 4u * 4u;

    TEST_ASSERT_EQUAL(app, covered(&bq_app_config_fields, &u, sizeof u.app));
    TEST_ASSERT_EQUAL(stack, covered(&bq76pl536_config_fields, &u, sizeof u.stack));
    TEST_ASSERT_EQUAL(afe, covered(&bq769x0_config_fields, &u, sizeof u.afe));
}

static void test_what_is_loaded_is_what_was_encoded(void)
{
    a.app.pack.balance_rest_ma = -1;
    a.app.pack.undertemp_dc = -400;
    a.app.pack.separate_paths = true;
    a.driver.cuv_delay_us = 3100000;
    a.driver.user[3] = 0xff;
    a.cells[61] = 3;
    (void)place(1, 7);
    memset(&b.app, 0x55, sizeof b.app);
    b.app.pack.soc.ocv = b.ocv;
    memset(b.cells, 0, sizeof b.cells);
    b.ocv[2].mv = 0;
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    TEST_ASSERT_EQUAL(-1, b.app.pack.balance_rest_ma);
    TEST_ASSERT_EQUAL(-400, b.app.pack.undertemp_dc);
    TEST_ASSERT_TRUE(b.app.pack.separate_paths);
    TEST_ASSERT_EQUAL(3100000, b.driver.cuv_delay_us);
    TEST_ASSERT_EQUAL(0xff, b.driver.user[3]);
    TEST_ASSERT_EQUAL(3, b.cells[61]);
    TEST_ASSERT_EQUAL(4200, b.ocv[2].mv);
    TEST_ASSERT_TRUE(b.app.pack.soc.ocv == b.ocv); /* pointers are the owner's */
    TEST_ASSERT_TRUE(b.driver.thermistor == &bq_thermistor_103at);
}

/* ---- refused ----------------------------------------------------------------------------------- */

/* Refused with `status`; nothing of the objects has moved. */
static void refused(bq_status status)
{
    b.app.pack.cell_ov_mv = 1234;
    b.cells[61] = 5;
    TEST_ASSERT_EQUAL(status, bq_settings_load(&b.settings, &nvm));
    TEST_ASSERT_EQUAL(1234, b.app.pack.cell_ov_mv);
    TEST_ASSERT_EQUAL(5, b.cells[61]);
}

static void test_an_unused_memory_holds_nothing(void)
{
    refused(BQ_E_NOT_FOUND);
}

static void test_every_single_changed_byte_is_noticed(void)
{
    const size_t len = place(0, 1);

    for (size_t i = 0; i < len; i++) {
        flash.memory[0][i] ^= 0x10u;
        refused(BQ_E_CRC);
        flash.memory[0][i] ^= 0x10u;
    }
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
}

static void test_a_value_out_of_range_refuses_the_whole_record(void)
{
    static const struct {
        size_t word;
        uint32_t good, bad;
    } values[] = {
        {5u + 2u, 255, 256},                  /* balance_timer_s, 8 bits */
        {5u + 5u, 65535, 65536},              /* cells, 16 bits */
        {5u + 14u, 0xffff8000u, 0xffff7fffu}, /* undertemp_dc, 16 bits signed */
        {5u + 14u, 32767, 32768},
        {5u + 31u, 1, 2},                        /* separate_paths */
        {5u + 32u, 64, 65},                      /* points of the curve */
        {5u + 37u + 128u + 30u + 61u, 255, 256}, /* cells of the last device: the last value of all */
    };

    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        objects_init(&b);
        place_changed(values[i].word, values[i].bad);
        refused(BQ_E_RANGE);
        place_changed(values[i].word, values[i].good);
        TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    }
}

static void test_a_record_of_another_firmware_is_refused(void)
{
    place_changed(3, bq_settings_layout(&a.settings) ^ 1u);
    refused(BQ_E_CONFIG);
    (void)bq_settings_encode(&a.settings, 1, record, sizeof record);
    place_changed(2, word(2) + 0x10000u); /* the next format */
    refused(BQ_E_CONFIG);
    b.settings.count = 3;
    (void)place(0, 1);
    refused(BQ_E_CONFIG); /* longer than this firmware's */
}

/* An older one that would fit does not come into force behind the user's back. */
static void test_a_newer_record_that_cannot_be_used_is_not_replaced_by_an_older_one(void)
{
    (void)place(1, 8);
    place_changed(4, 9); /* sector 0, newer, same layout: in force */
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    set_word(5u + 31u, 2); /* separate_paths */
    set_word(1, bq_crc32(0, record + 8, (word(2) & 0xffffu) * 4u - 8u));
    memcpy(flash.memory[0], record, (word(2) & 0xffffu) * 4u);
    refused(BQ_E_RANGE);
}

static void test_a_damaged_record_gives_way_to_an_older_one(void)
{
    a.app.pack.cell_ov_mv = 4100;
    (void)place(1, 8);
    a.app.pack.cell_ov_mv = 4200;
    (void)place(0, 9);
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    TEST_ASSERT_EQUAL(4200, b.app.pack.cell_ov_mv);
    flash.memory[0][100] ^= 1u;
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    TEST_ASSERT_EQUAL(4100, b.app.pack.cell_ov_mv);
}

static void test_sequence_numbers_wrap(void)
{
    a.app.pack.cell_ov_mv = 4100;
    (void)place(0, UINT32_MAX);
    a.app.pack.cell_ov_mv = 4200;
    (void)place(1, 0);
    TEST_ASSERT_EQUAL(BQ_OK, bq_settings_load(&b.settings, &nvm));
    TEST_ASSERT_EQUAL(4200, b.app.pack.cell_ov_mv);
}

static void test_lengths_that_lie_are_no_record(void)
{
    static const uint32_t lengths[] = {0, 4, 5, 261, 514, 0xfffe};

    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        place_changed(2, 1u << 16 | lengths[i]);
        refused(BQ_E_CRC);
    }
}

static void test_arguments(void)
{
    const bq_settings none = {NULL, 0};
    bq_nvm bad = nvm;

    refused(BQ_E_NOT_FOUND);
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(NULL, &nvm));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(&none, &nvm));
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(&b.settings, NULL));
    bad.sectors = 1;
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(&b.settings, &bad));
    bad = nvm;
    bad.sector_bytes = 1047; /* the record has 262 words */
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(&b.settings, &bad));
    bad.sector_bytes = 1048;
    TEST_ASSERT_EQUAL(BQ_E_NOT_FOUND, bq_settings_load(&b.settings, &bad));
    bad.ops = NULL;
    TEST_ASSERT_EQUAL(BQ_E_ARG, bq_settings_load(&b.settings, &bad));
    flash.read_status = BQ_E_BUS;
    refused(BQ_E_BUS);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_crc_is_that_of_zlib);
    RUN_TEST(test_the_form_of_a_record);
    RUN_TEST(test_layout_follows_shape_and_meaning_not_offsets);
    RUN_TEST(test_tables_leave_no_field_out);
    RUN_TEST(test_what_is_loaded_is_what_was_encoded);
    RUN_TEST(test_an_unused_memory_holds_nothing);
    RUN_TEST(test_every_single_changed_byte_is_noticed);
    RUN_TEST(test_a_value_out_of_range_refuses_the_whole_record);
    RUN_TEST(test_a_record_of_another_firmware_is_refused);
    RUN_TEST(test_a_newer_record_that_cannot_be_used_is_not_replaced_by_an_older_one);
    RUN_TEST(test_a_damaged_record_gives_way_to_an_older_one);
    RUN_TEST(test_sequence_numbers_wrap);
    RUN_TEST(test_lengths_that_lie_are_no_record);
    RUN_TEST(test_arguments);
    return UNITY_END();
}
