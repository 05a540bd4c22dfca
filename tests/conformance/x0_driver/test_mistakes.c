/* SPDX-License-Identifier: Apache-2.0 */
/* The mistakes that drivers of this part are known for: one test each. tests/mutants runs every one of them
 * against a driver that has the mistake, and demands that it fails there. */
#include "bench.h"

#define CLEARING 3u /* a scan is SYS_STAT, the block, the clearing */

void setUp(void)
{
}
void tearDown(void)
{
}

static void up_with(const char *part, int gain_uv, int offset_mv)
{
    bench_part(part, NULL);
    (void)sim_x0_set_gain(&b.chip, gain_uv);
    (void)sim_x0_set_offset(&b.chip, offset_mv);
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
}

/* Scans until a scrub is just over, so that the next one has three transactions. */
static void quiet(void)
{
    for (int n = 0; n < 20; n++) {
        uint64_t before;
        bench_wait(255);
        before = b.count;
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        if (b.count - before > CLEARING) {
            break;
        }
    }
    bench_wait(255);
}

/* proves: X0-ADC-05, X0-ADC-02 */
static void offset_is_a_signed_number(void)
{
    up_with("bq7692003", 380, -20);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.cells[0].quality);
    TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
}

static void raise_the_upper_bits(struct bench *on)
{
    for (unsigned reg = 0x0c; reg < 0x2a; reg += 2) {
        on->chip.reg[reg] |= 0xc0;
    }
    on->chip.reg[0x2c] |= 0xc0;
}

/* proves: X0-ADC-01, X0-SEQ-22, X0-BIT-16 */
static void upper_bits_of_a_high_byte_are_no_data(void)
{
    bench_up("bq7694003");
    bench_serve(3000, 250);
    b.hook = raise_the_upper_bits;
    bench_wait(255);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    for (unsigned c = 0; c < 15; c++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.cells[c].quality);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[c].mv);
    }
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.temps[0].quality);
    TEST_ASSERT_INT_WITHIN(1, 250, b.temps[0].dc);
}

/* proves: X0-TS-05, X0-DIE-02 */
static void temperatures_have_a_scale_of_their_own(void)
{
    for (int die = 0; die < 2; die++) {
        bench_part("bq7692003", NULL);
        (void)sim_x0_set_gain(&b.chip, 365);
        (void)sim_x0_set_ts(&b.chip, 1, 10000.0);
        (void)sim_x0_set_tdie(&b.chip, 25.0);
        b.cfg.sensors = die ? 0 : 1;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        bench_serve(3000, 250);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.temps[0].quality);
        TEST_ASSERT_INT_WITHIN(5, 250, b.temps[0].dc);
    }
}

/* proves: X0-OV-12, X0-UV-12, X0-SEQ-14 */
static void limits_that_no_code_holds_are_refused(void)
{
    bench_part("bq7692003", NULL);
    b.cfg.ov_mv = 5000; /* the low byte alone would be 3.44 V */
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_NO_CODE, bench_start());
    bench_part("bq7692003", NULL);
    b.cfg.uv_mv = 3300; /* ... 1.74 V */
    b.cfg.uv_recover_mv = 3400;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_E_NO_CODE, bench_start());
    bench_up("bq7692003");
    TEST_ASSERT_INT_WITHIN(6200, 4200000 - 3100,
                           bq769x0_get_achieved(&b.d)->ov_uv); /* and what was achieved */
    TEST_ASSERT_INT_WITHIN(6200, 2800000 + 3100, bq769x0_get_achieved(&b.d)->uv_uv);
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 0x09));
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->uv_trip, sim_x0_peek(&b.chip, 0x0a));
}

/* proves: X0-OV-04, X0-UV-04, X0-OCD-04 */
static void delays_are_in_their_units(void)
{
    bench_part("bq7692003", NULL);
    b.cfg.ov_delay_s = 2;
    b.cfg.uv_delay_s = 4;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_HEX8(0x50, sim_x0_peek(&b.chip, 0x08)); /* UV code 1 = 4 s, OV code 1 = 2 s */
    TEST_ASSERT_EQUAL_HEX8(0x50, sim_x0_peek(&b.chip, 0x07) & 0x70);
}

/* proves: X0-OCD-03, X0-OCD-11 */
static void the_index_is_of_the_range_that_is_set(void)
{
    bench_part("bq7692003", NULL);
    b.cfg.ocd_ma = 15000; /* 75 mV and 125 mV: the range of RSNS = 1 */
    b.cfg.scd_ma = 25000;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_HEX8(0x8b, sim_x0_peek(&b.chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x5a, sim_x0_peek(&b.chip, 0x07));
}

/* proves: X0-OCD-03, X0-OCD-04, X0-SCD-01, X0-SCD-02 */
static void a_table_ends_with_its_last_entry(void)
{
    static const uint16_t ms[8] = {8, 20, 40, 80, 160, 320, 640, 1280};
    for (unsigned code = 0; code < 8; code++) {
        bench_part("bq7692003", NULL);
        b.cfg.ocd_delay_ms = ms[code];
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL_HEX8(code << 4, sim_x0_peek(&b.chip, 0x07) & 0x70);
    }
    bench_part("bq7692003", NULL);
    b.cfg.ocd_ma = 32000; /* 160 mV, 300 mV, 3 s, 500 us, 100 s: beyond every table */
    b.cfg.scd_ma = 60000;
    b.cfg.ocd_delay_ms = 3000;
    b.cfg.scd_delay_us = 500;
    b.cfg.ov_delay_s = b.cfg.uv_delay_s = 100;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
    TEST_ASSERT_EQUAL(BQ_OK, bench_start());
    TEST_ASSERT_EQUAL_HEX8(0x9f, sim_x0_peek(&b.chip, 0x06));
    TEST_ASSERT_EQUAL_HEX8(0x7f, sim_x0_peek(&b.chip, 0x07));
    TEST_ASSERT_EQUAL_HEX8(0xf0, sim_x0_peek(&b.chip, 0x08));
}

/* proves: X0-I2C-19, X0-I2C-15 */
static void every_byte_of_a_block_is_checked(void)
{
    bench_up("bq7694003");
    for (int i = 1; i <= 15; i++) {
        (void)sim_x0_set_cell(&b.chip, i, 3.5 + 0.02 * i);
    }
    for (unsigned byte = 0; byte < 80; byte++) {
        uint32_t errors;
        quiet();
        errors = bq769x0_afe(&b.d).ops->stats(&b.d)->crc_errors;
        b.spoil_at = b.count + 2;
        b.spoil_kind = SPOIL_FLIP;
        b.flip_bit = (int)(24 + 8 * byte + byte % 8);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL(errors + 1, bq769x0_afe(&b.d).ops->stats(&b.d)->crc_errors);
        for (unsigned c = 0; c < 15; c++) {
            TEST_ASSERT_INT_WITHIN(1, 3520 + 20 * (int)c, b.cells[c].mv);
        }
    }
}

/* proves: X0-SEQ-48 */
static void a_repetition_names_its_register_again(void)
{
    uint64_t from;
    bench_up("bq7694003");
    bench_serve(3000, 250);
    (void)sim_x0_set_cell(&b.chip, 2, 4.4);
    bench_wait(2500); /* OV is set; the register behind SYS_STAT holds 0 */
    from = b.count;
    b.spoil_at = b.count + 1;
    b.spoil_kind = SPOIL_FLIP;
    b.flip_bit = 24 + 8;
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, b.module.faults & BQ_F_CELL_OV);
    for (; from < b.count; from++) {
        TEST_ASSERT_TRUE(bench_log(from)->read == 0 || bench_log(from)->restart);
    }
}

/* proves: X0-SEQ-51, X0-SEQ-49 */
static void repetitions_end(void)
{
    uint64_t before;
    bench_up("bq7692003");
    b.no_power = true;
    before = b.count;
    TEST_ASSERT_TRUE(bench_scan() < 0);
    TEST_ASSERT_TRUE(b.count - before <= 10);
}

/* proves: X0-SEQ-48 */
static void damage_on_the_bus_never_ends_in_ship(void)
{
    bench_up("bq7694003");
    bench_serve(3000, 250);
    for (int n = 0; n < 30; n++) {
        b.spoil_at = b.count + 1;
        b.spoil_kind = SPOIL_FLIP;
        b.spoil_count = 1000;
        b.flip_bit = 24 + n % 16;
        bench_wait(250);
        (void)bench_scan();
    }
    b.spoil_at = 0;
    TEST_ASSERT_EQUAL(SIM_X0_NORMAL, b.chip.mode);
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.cells[14].quality);
}

/* proves: X0-SEQ-08, X0-SEQ-09 */
static void content_left_over_names_no_variant(void)
{
    static const char *const part[2] = {"bq7692000", "bq7692003"};
    for (int crc = 0; crc < 2; crc++) {
        bench_up(part[crc]);
        TEST_ASSERT_EQUAL_HEX8(0x19, sim_x0_peek(&b.chip, 0x0b));
        bench_wait(1000); /* the host is reset, the part is not */
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(crc, bq769x0_get_achieved(&b.d)->crc);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, b.cells[0].quality);
    }
}

static uint64_t scan_from; /* log number of the scan's first transaction */

/* Behind the read of SYS_STAT, so that the clearing comes later. */
static void strike_behind_the_look(struct bench *on)
{
    if (on->count == scan_from + 1) {
        (void)sim_x0_strike_xready(&on->chip);
    }
}

/* proves: X0-BIT-09, X0-SEQ-21 */
static void only_what_was_read_is_cleared(void)
{
    bench_up("bq7694003");
    quiet();
    scan_from = b.count;
    b.hook = strike_behind_the_look;
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    b.hook = NULL;
    TEST_ASSERT_EQUAL_HEX8(0x20, sim_x0_peek(&b.chip, 0x00) & 0x20); /* not lost in between */
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(BQ_F_MEMORY, b.module.faults & BQ_F_MEMORY);
    NO_MISUSE();
}

/* proves: X0-SEQ-30, X0-SEQ-31 */
static void recovery_thresholds_are_mandatory(void)
{
    bench_part("bq7692003", NULL);
    b.cfg.ov_recover_mv = 0;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bench_init());
    b.cfg.ov_recover_mv = 4100;
    b.cfg.uv_recover_mv = 0;
    TEST_ASSERT_EQUAL(BQ_E_RANGE, bench_init());
    b.cfg.uv_recover_mv = 3000;
    TEST_ASSERT_EQUAL(BQ_OK, bench_init());
}

/* proves: X0-SEQ-30 */
static void overvoltage_recovers_at_its_threshold(void)
{
    bench_up("bq7692003");
    bench_serve(3000, 250);
    (void)sim_x0_set_cell(&b.chip, 2, 4.3);
    TEST_ASSERT_TRUE(bench_until(false, true, 5000) < 5000);
    (void)sim_x0_set_cell(&b.chip, 2, 4.15); /* inside, but not yet recovered */
    TEST_ASSERT_EQUAL(10000, bench_until(true, true, 10000));
    (void)sim_x0_set_cell(&b.chip, 2, 4.05);
    TEST_ASSERT_TRUE(bench_until(true, true, 10000) < 10000);
}

/* proves: X0-SEQ-31 */
static void undervoltage_recovers_at_its_threshold(void)
{
    bench_up("bq7692003");
    bench_serve(3000, 250);
    (void)sim_x0_set_cell(&b.chip, 2, 2.7);
    TEST_ASSERT_TRUE(bench_until(true, false, 5000) < 5000);
    (void)sim_x0_set_cell(&b.chip, 2, 2.95);
    TEST_ASSERT_EQUAL(10000, bench_until(true, true, 10000));
    (void)sim_x0_set_cell(&b.chip, 2, 3.1);
    TEST_ASSERT_TRUE(bench_until(true, true, 10000) < 10000);
}

/* No two closed switches of one group of five with nothing but shorted inputs between them. */
static void expect_no_neighbours(uint16_t in_use, uint16_t closed)
{
    for (unsigned group = 0; group < 15; group += 5) {
        bool below = false;
        for (unsigned i = group; i < group + 5; i++) {
            bool on = (closed >> i & 1) != 0;
            TEST_ASSERT_FALSE(on && ((in_use >> i & 1) == 0 || below));
            below = (in_use >> i & 1) != 0 ? on : below;
        }
    }
}

/* proves: X0-CB-02, X0-CB-04, X0-CB-06 */
static void neighbours_are_so_by_input(void)
{
    for (int across = 0; across < 2; across++) {
        bench_part("bq7694003", NULL);
        b.cfg.cells = 13;
        b.cfg.wiring = 0x7ef7; /* VC4 and VC9 shorted */
        b.cfg.balance_across_groups = across != 0;
        TEST_ASSERT_EQUAL(BQ_OK, bench_init());
        bench_cells(3.6);
        TEST_ASSERT_EQUAL(BQ_OK, bench_start());
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        for (uint32_t asked = 1; asked < 1u << 13; asked += 3) {
            TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, asked));
            expect_no_neighbours(b.cfg.wiring, sim_x0_cb(&b.chip));
        }
        NO_MISUSE();
    }
}

/* proves: X0-I2C-21, X0-AMB-19 */
static void both_halves_come_in_one_transaction(void)
{
    uint64_t from;
    bench_up("bq7693003");
    from = b.count;
    for (int n = 0; n < 120; n++) { /* 3.412 V and 3.608 V have different high bytes */
        for (int i = 1; i <= 10; i++) {
            (void)sim_x0_set_cell(&b.chip, i, (n & 1) != 0 ? 3.412 : 3.608);
        }
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        for (unsigned c = 0; c < 10; c++) {
            TEST_ASSERT_TRUE(n < 2 || (b.cells[c].quality & BQ_Q_VALID) == 0 || b.cells[c].mv < 3414 ||
                             b.cells[c].mv > 3606);
        }
        bench_wait(241);
    }
    for (; from < b.count; from++) {
        const bench_entry *e = bench_log(from);
        if (e->read > 0 && e->reg >= 0x0c && e->reg < 0x34) {
            TEST_ASSERT_EQUAL(0, e->reg & 1);
            TEST_ASSERT_EQUAL(0, e->read & 1);
        }
    }
}

/* The part opens its switches by itself to measure, so the values are right; the host has to know which cells
 * were bled meanwhile.
 * proves: X0-SEQ-40, X0-CB-07 */
static void a_picture_tells_which_cells_were_bled(void)
{
    bench_up("bq7692003");
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    TEST_ASSERT_EQUAL_HEX16(0, b.module.balancing);
    TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, 0x05));
    for (int n = 0; n < 4; n++) {
        uint16_t bled = sim_x0_cb(&b.chip);
        TEST_ASSERT_TRUE(bled != 0);
        bench_wait(260);
        TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
        TEST_ASSERT_EQUAL_HEX16(bled, b.module.balancing);
        TEST_ASSERT_INT_WITHIN(1, 3600, b.cells[0].mv);
        TEST_ASSERT_EQUAL(BQ_OK, bench_apply(false, false, 0x05));
    }
    NO_MISUSE();
}

/* proves: X0-SEQ-35, X0-XRDY-03 */
static void an_internal_fault_is_left_alone_for_seconds(void)
{
    uint64_t from, struck;
    bench_up("bq7692003");
    bench_serve(3000, 250);
    b.chip.options.amb65_config_lost = true;
    (void)sim_x0_strike_xready(&b.chip);
    struck = bench_now_ms();
    while (bench_now_ms() < struck + 2750) {
        bench_serve(250, 250);
        TEST_ASSERT_EQUAL_HEX8(0x20, sim_x0_peek(&b.chip, 0x00) & 0x20);
        TEST_ASSERT_EQUAL_HEX8(0, b.cells[0].quality & BQ_Q_VALID);
    }
    from = b.count;
    TEST_ASSERT_TRUE(bench_until(true, true, 20000) < 20000);
    TEST_ASSERT_TRUE(bench_writes(from, 0x06, NULL) >= 1); /* the whole configuration again */
    TEST_ASSERT_TRUE(bench_writes(from, 0x0b, NULL) >= 1);
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&b.d)->ov_trip, sim_x0_peek(&b.chip, 0x09));
}

/* proves: X0-CELL-18 */
static void a_buffer_that_is_too_small_is_refused(void)
{
    bq_status st;
    bench_up("bq7694003");
    TEST_ASSERT_EQUAL(BQ_OK, bench_scan());
    for (unsigned room = 0; room < 15; room++) {
        memset(b.cells, 0xa5, sizeof b.cells);
        b.sample.cell_capacity = (uint16_t)room;
        st = bench_picture();
        for (unsigned c = 0; c < 15; c++) {
            TEST_ASSERT_EQUAL_HEX16(0xa5a5, b.cells[c].mv); /* nothing written, and nothing beyond */
        }
        TEST_ASSERT_EQUAL(BQ_E_ARG, st);
    }
    b.sample.cell_capacity = 15;
    TEST_ASSERT_EQUAL(BQ_OK, bench_picture());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(offset_is_a_signed_number);
    RUN_TEST(upper_bits_of_a_high_byte_are_no_data);
    RUN_TEST(temperatures_have_a_scale_of_their_own);
    RUN_TEST(limits_that_no_code_holds_are_refused);
    RUN_TEST(delays_are_in_their_units);
    RUN_TEST(the_index_is_of_the_range_that_is_set);
    RUN_TEST(a_table_ends_with_its_last_entry);
    RUN_TEST(every_byte_of_a_block_is_checked);
    RUN_TEST(a_repetition_names_its_register_again);
    RUN_TEST(repetitions_end);
    RUN_TEST(damage_on_the_bus_never_ends_in_ship);
    RUN_TEST(content_left_over_names_no_variant);
    RUN_TEST(only_what_was_read_is_cleared);
    RUN_TEST(recovery_thresholds_are_mandatory);
    RUN_TEST(overvoltage_recovers_at_its_threshold);
    RUN_TEST(undervoltage_recovers_at_its_threshold);
    RUN_TEST(neighbours_are_so_by_input);
    RUN_TEST(both_halves_come_in_one_transaction);
    RUN_TEST(a_picture_tells_which_cells_were_bled);
    RUN_TEST(an_internal_fault_is_left_alone_for_seconds);
    RUN_TEST(a_buffer_that_is_too_small_is_refused);
    return UNITY_END();
}
