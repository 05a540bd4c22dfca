/* SPDX-License-Identifier: Apache-2.0 */
/* One life of a stack under every reading of the ambiguous facts that the simulator offers (PL-AMB rows). */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;
static const sim_pl_options *reading;

void setUp(void)
{
}

void tearDown(void)
{
}

static void scan(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
}

static void expect_all_fresh(void)
{
    for (int i = 0; i < 18; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
    for (int n = 0; n < 3; n++) {
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[n].faults);
    }
}

/* Overvoltage, acknowledged after its cause has gone. */
static void overvoltage(void)
{
    (void)sim_pl_set_cell(&r.pl, 2, 3, 4.3);
    rig_advance_ms(&r, 600);
    scan();
    TEST_ASSERT_EQUAL_HEX16(BQ_F_CELL_OV, r.modules[1].faults);
    (void)sim_pl_set_cell(&r.pl, 2, 3, 3.6);
    r.action.clear_faults = true;
    rig_advance_ms(&r, 600);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 600);
    scan();
    expect_all_fresh();
}

static void balancing(void)
{
    memset(&r.action, 0, sizeof r.action);
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 14);
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
        TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 1));
        TEST_ASSERT_EQUAL_HEX8(0x02, sim_pl_cb(&r.pl, 3));
        rig_advance_ms(&r, 500);
        scan();
        expect_all_fresh();
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    rig_advance_ms(&r, 6000); /* expires */
    scan();
    expect_all_fresh();
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_cb(&r.pl, 1));
    memset(&r.action, 0, sizeof r.action);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
}

static void sleeping(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_sleep(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    TEST_ASSERT_EQUAL_INT(SIM_PL_SLEEP, sim_pl_get_mode(&r.pl, 3));
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_wake(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    scan();
    expect_all_fresh();
}

static void losing_a_device(void)
{
    rig_poke(&r, 2, 0x3c, 0xa5);
    sim_pl_advance(&r.pl, 2 * SIM_PL_MS);
    scan();
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[0].quality);
    TEST_ASSERT_TRUE((r.modules[1].faults & BQ_F_RESET) != 0);
    rig_advance_ms(&r, 100);
    scan();
    expect_all_fresh();
}

/* A damaged write to one device: dealt with in the next scan, whoever flags it. */
static void damaged_write(void)
{
    uint8_t bad[4] = {0x05, 0x30, 0x7d, 0x00}, rx[4];
    sim_pl_spi(&r.pl, bad, rx, NULL, 4);
    sim_pl_advance(&r.pl, 10 * SIM_PL_US);
    uint32_t misuse = rig_misuse(&r);
    scan();
    TEST_ASSERT_EQUAL_UINT(misuse, rig_misuse(&r));
    sim_misuse_clear(sim_pl_misuse(&r.pl));
    scan();
    expect_all_fresh();
    for (int n = 1; n <= 3; n++) {
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_peek(&r.pl, n, 0x21));
    }
}

static void corrected_error(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&r.pl, 1, 0x44, 0x01));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start(&r));
    TEST_ASSERT_EQUAL_UINT(1, bq76pl536_diagnose(&r.d)->ecc_corrected);
    scan();
    expect_all_fresh();
}

static void memory(void)
{
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_ram(&r.pl, 3, 0x44, 0x01));
    scan();
    scan();
    expect_all_fresh();
    TEST_ASSERT_EQUAL_HEX8(0x15, sim_pl_peek(&r.pl, 3, 0x44));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    TEST_ASSERT_EQUAL_INT(0, sim_pl_damage_otp(&r.pl, 2, 0x44, 0x03));
    rig_poke(&r, 2, 0x3a, 0x27);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_advance_ms(&r, 100);
    }
    rig_sample(&r);
    TEST_ASSERT_TRUE((r.modules[1].faults & BQ_F_DEFECTIVE) != 0);
}

static void life(bool pin)
{
    static const uint8_t user[4] = {1, 2, 3, 4};
    c = rig_config(3);
    c.use_conv_pin = pin;
    memcpy(c.user, user, 4);
    rig_up(&r, &c, reading);
    TEST_ASSERT_EQUAL_INT(reading != NULL && reading->amb100_user_readonly,
                          bq76pl536_diagnose(&r.d)->user_readonly);
    scan();
    expect_all_fresh();
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_self_test(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
    overvoltage();
    balancing();
    sleeping();
    losing_a_device();
    damaged_write();
    corrected_error();
    memory();
}

static void both_ways(const sim_pl_options *options)
{
    reading = options;
    life(false);
    life(true);
}

#define READING(field)                                                                                       \
    do {                                                                                                     \
        sim_pl_options o;                                                                                    \
        memset(&o, 0, sizeof o);                                                                             \
        o.field = true;                                                                                      \
        both_ways(&o);                                                                                       \
    } while (0)

static void the_reading_chosen(void)
{
    both_ways(NULL);
}

/* proves: PL-AMB-12 */
static void idle_bus_reads_ones(void)
{
    READING(amb12_idle_ff);
}

/* proves: PL-AMB-26 */
static void an_address_needs_bit_7(void)
{
    READING(amb26_needs_bit7);
}

/* proves: PL-AMB-33 */
static void a_latch_is_held_until_the_zero(void)
{
    READING(amb33_hold_until_zero);
}

/* proves: PL-AMB-40 */
static void cell_flags_stick_to_the_comparator(void)
{
    READING(amb40_sticky_cells);
}

/* proves: PL-AMB-49 */
static void an_ecc_error_raises_no_i_fault(void)
{
    READING(amb49_no_ifault);
}

/* proves: PL-AMB-54 */
static void a_reset_command_sets_no_por(void)
{
    READING(amb54_reset_no_por);
}

/* proves: PL-AMB-78 */
static void drdy_is_low_until_the_first_conversion(void)
{
    READING(amb78_drdy_zero);
}

/* proves: PL-AMB-79 */
static void drdy_shows_the_base_only(void)
{
    READING(amb79_drdy_base_only);
}

/* proves: PL-AMB-83 */
static void any_rise_restarts_the_timer(void)
{
    READING(amb83_any_rise);
}

/* proves: PL-AMB-84 */
static void expiry_clears_the_mask(void)
{
    READING(amb84_clear_cbctrl);
}

/* proves: PL-AMB-86 */
static void sleep_stops_balancing(void)
{
    READING(amb86_sleep_stops_cb);
}

/* proves: PL-AMB-100 */
static void user_registers_cannot_be_written(void)
{
    READING(amb100_user_readonly);
}

/* proves: PL-AMB-01 */
static void a_crc_error_raises_alert_too(void)
{
    READING(amb01_crc_alert);
}

/* proves: PL-AMB-02 */
static void a_good_write_clears_the_crc_flag(void)
{
    READING(amb02_crc_last_packet);
}

/* proves: PL-AMB-06 */
static void every_device_checks_every_crc(void)
{
    READING(amb06_all_check);
}

/* proves: PL-AMB-18 */
static void no_broadcast_without_address_but_reset(void)
{
    READING(amb18_addressed_only);
}

/* proves: PL-AMB-28 */
static void ar_is_a_copy(void)
{
    READING(amb28_ar_copy);
}

/* proves: PL-AMB-48 */
static void a_corrected_error_raises_alert(void)
{
    READING(amb48_ecc_alert);
}

/* proves: PL-AMB-51 */
static void leaving_sleep_sets_the_flag_too(void)
{
    READING(amb51_sleep_on_exit);
}

/* proves: PL-AMB-62 */
static void the_fastest_setting_takes_6_us(void)
{
    READING(amb62_six_us);
}

/* proves: PL-AMB-68 */
static void conv_reads_one_while_converting(void)
{
    READING(amb68_conv_reads_one);
}

/* proves: PL-AMB-85 */
static void cb_time_restarts_the_period(void)
{
    READING(amb85_time_restarts);
}

/* proves: PL-AMB-99 */
static void a_discarded_write_cancels_the_key(void)
{
    READING(amb99_discarded_cancels);
}

/* proves: PL-AMB-93, PL-SEQ-02-02 */
static void a_reset_may_take_almost_a_millisecond(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.amb93_reset_us = 950;
    both_ways(&o);
}

static void slow_and_fast_timers(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.deglitch = true;
    o.delay_percent = 10;
    both_ways(&o);
    o.delay_percent = -12;
    both_ways(&o);
}

static void real_noise_and_offsets(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.seed = 7;
    o.noise_uv_rms = 250;
    o.cell_offset_uv_max = 2500;
    both_ways(&o);
}

static void the_judge_of_timing(void)
{
    sim_pl_options o;
    memset(&o, 0, sizeof o);
    o.strict_timing = true;
    both_ways(&o);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_reading_chosen);
    RUN_TEST(idle_bus_reads_ones);
    RUN_TEST(an_address_needs_bit_7);
    RUN_TEST(a_latch_is_held_until_the_zero);
    RUN_TEST(cell_flags_stick_to_the_comparator);
    RUN_TEST(an_ecc_error_raises_no_i_fault);
    RUN_TEST(a_reset_command_sets_no_por);
    RUN_TEST(drdy_is_low_until_the_first_conversion);
    RUN_TEST(drdy_shows_the_base_only);
    RUN_TEST(any_rise_restarts_the_timer);
    RUN_TEST(expiry_clears_the_mask);
    RUN_TEST(sleep_stops_balancing);
    RUN_TEST(user_registers_cannot_be_written);
    RUN_TEST(a_crc_error_raises_alert_too);
    RUN_TEST(a_good_write_clears_the_crc_flag);
    RUN_TEST(every_device_checks_every_crc);
    RUN_TEST(no_broadcast_without_address_but_reset);
    RUN_TEST(ar_is_a_copy);
    RUN_TEST(a_corrected_error_raises_alert);
    RUN_TEST(leaving_sleep_sets_the_flag_too);
    RUN_TEST(the_fastest_setting_takes_6_us);
    RUN_TEST(conv_reads_one_while_converting);
    RUN_TEST(cb_time_restarts_the_period);
    RUN_TEST(a_discarded_write_cancels_the_key);
    RUN_TEST(a_reset_may_take_almost_a_millisecond);
    RUN_TEST(slow_and_fast_timers);
    RUN_TEST(real_noise_and_offsets);
    RUN_TEST(the_judge_of_timing);
    return UNITY_END();
}
