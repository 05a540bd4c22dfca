/* SPDX-License-Identifier: Apache-2.0 */
/* Bring-up and SHIP: boot, the past of a part that already runs, identification, configuration. */
#include "bqhost/crc8.h"
#include "x0_rig.h"
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* proves: X0-SEQ-01, X0-SEQ-02, X0-SEQ-04, X0-ADC-14, X0-AMB-17, X0-AMB-69, X0-MODE-09 */
static void test_boot_waits(void)
{
    static const struct {
        const char *name;
        unsigned cells, ms;
    } row[] = {{"bq7692003", 5, 290}, {"bq7693003", 10, 455}, {"bq7694003", 15, 895}};
    for (unsigned i = 0; i < 3u; i++) {
        rig_part(row[i].name, row[i].cells);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start()); /* the judge notes early writes and early measurements */
        TEST_ASSERT_TRUE(rig.chip.now >= row[i].ms * 1000000ull);
        TEST_ASSERT_TRUE(rig.chip.now < (row[i].ms + 120u) * 1000000ull);
        TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
        rig_clean();
    }
}

/* proves: X0-SEQ-03 */
static uint32_t moving_clock(void *ctx)
{
    hal_sim_x0_advance(ctx, 3000);
    return hal_sim_x0_clock(ctx).now_us(ctx);
}

/* A real clock moves between any two readings, also within one call of poll.
 * proves: X0-SEQ-01, X0-SEQ-02 */
static void test_boot_waits_with_a_clock_that_moves(void)
{
    rig_part("bq7694003", 15);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    rig.d.clock.now_us = moving_clock;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    TEST_ASSERT_EQUAL_INT(0, (int)sim_x0_misuse(&rig.chip)->count);
}

static void test_no_device(void)
{
    rig_part("bq7692003", 5);
    (void)sim_x0_set_supply(&rig.chip, false);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_FOUND, rig_start());
    TEST_ASSERT_TRUE(rig.chip.now >= 150000000ull); /* three boots of 50 ms each */
    (void)sim_x0_set_supply(&rig.chip, true);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
}

/* proves: X0-SEQ-06, X0-SEQ-13, X0-SEQ-14, X0-SEQ-15, X0-SEQ-17, X0-SEQ-19, X0-MODE-18, X0-AMB-88, X0-DLY-03
 */
static void test_warm_start_takes_nothing_for_granted(void)
{
    rig_up("bq7693003", 8);
    TEST_ASSERT_EQUAL_INT(BQ_OK, (rig_pass(2500), rig_apply(true, true, 1)));
    rig.chip.reg[0x05] = 0xc3; /* delays bypassed by somebody */
    rig.chip.reg[0x02] = 0x05;
    rig.chip.reg[0x06] = 0x00;
    rig.chip.reg[0x09] = 0x11;
    hal_sim_x0_reset(&rig.hal);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    TEST_ASSERT_EQUAL_HEX8(0x40, rig_reg(0x05));
    TEST_ASSERT_EQUAL_HEX16(0, sim_x0_cb(&rig.chip));
    TEST_ASSERT_EQUAL_HEX8(0x18, rig_reg(0x04));
    TEST_ASSERT_EQUAL_HEX8(0x8b, rig_reg(0x06));
    TEST_ASSERT_EQUAL_HEX8(0x5a, rig_reg(0x07));
    TEST_ASSERT_EQUAL_HEX8(0x50, rig_reg(0x08));
    TEST_ASSERT_EQUAL_HEX8(bq769x0_get_achieved(&rig.d)->ov_trip, rig_reg(0x09));
    TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
    rig_clean();
}

/* proves: X0-SEQ-06 */
static void test_warm_start_may_keep_the_fets_but_not_after_a_failure(void)
{
    for (unsigned broken = 0; broken < 2u; broken++) {
        rig_up("bq7692003", 5);
        rig_pass(2500);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 0));
        hal_sim_x0_reset(&rig.hal);
        rig.config.keep_fets = true;
        rig.config.cells = broken != 0u ? 4 : 5; /* the wiring no longer fits */
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
        TEST_ASSERT_EQUAL_INT(broken != 0u ? BQ_E_CELLS : BQ_OK, rig_start());
        TEST_ASSERT_EQUAL_INT(broken == 0u, sim_x0_chg(&rig.chip));
        TEST_ASSERT_EQUAL_INT(broken == 0u, sim_x0_dsg(&rig.chip));
        rig_clean();
    }
    rig_up("bq7692003", 5);
    rig_pass(2500);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 0));
    rig.config.keep_fets = true;
    rig.config.ov_mv = 5000; /* no code for it */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, rig_start());
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
}

/* proves: X0-SEQ-08, X0-SEQ-09, X0-NUM-869 */
static void test_the_field_mistake_of_content_left_over(void)
{
    static const char *const name[] = {"bq7692000", "bq7692003"};
    for (unsigned crc = 0; crc < 2u; crc++) {
        /* plain: content and trim that look like CRC bytes in one of the two reads; both: CC_CFG is 0x19 */
        for (unsigned trap = 0; trap < 2u; trap++) {
            rig_part(name[crc], 5);
            (void)sim_x0_set_gain(&rig.chip, 365);
            (void)sim_x0_set_offset(&rig.chip, trap != 0u ? 0x42 : 0);
            TEST_ASSERT_EQUAL_HEX8(0x42, bq_crc8(0, (const uint8_t *)"\x11\x00", 2));
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
            TEST_ASSERT_EQUAL_INT(crc, bq769x0_get_achieved(&rig.d)->crc);
            TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b)); /* left over from before, it proves nothing */
            hal_sim_x0_reset(&rig.hal);
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
            TEST_ASSERT_EQUAL_INT(crc, bq769x0_get_achieved(&rig.d)->crc);
            rig_clean();
        }
    }
}

/* proves: X0-SEQ-11 */
static void test_zero_trim_is_a_device_zero_everything_a_bad_boot(void)
{
    rig_part("bq7693003", 10);
    (void)sim_x0_set_gain(&rig.chip, 365);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    TEST_ASSERT_EQUAL_UINT(365, bq769x0_get_achieved(&rig.d)->trim.gain_uv);
    rig_part("bq7693003", 10);
    rig.chip.options.field_zero_boot = true;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start()); /* SHIP, boot again */
    TEST_ASSERT_EQUAL_UINT(382, bq769x0_get_achieved(&rig.d)->trim.gain_uv);
    TEST_ASSERT_EQUAL_HEX8(0x19, rig_reg(0x0b));
}

/* proves: X0-SEQ-12 */
static void test_wrong_wiring_is_found(void)
{
    rig_part("bq7694003", 13);
    (void)sim_x0_set_cell(&rig.chip, 9, 3.6); /* should be shorted */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_CELLS, rig_start());
    rig_part("bq7692003", 5);
    rig.config.inputs = 15; /* a larger part than there is */
    rig.config.cells = 15;
    rig.config.sensors = 1;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_TRUE(rig_start() < 0);
    TEST_ASSERT_FALSE(sim_x0_chg(&rig.chip) || sim_x0_dsg(&rig.chip));
}

/* proves: X0-AMB-88 */
static void test_low_nibble_of_protect3_stays(void)
{
    rig_part("bq7692003", 5);
    rig.chip.options.amb88_nibble_reads_8 = true;
    rig.chip.options.field_nibble_offset = true;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_start());
    rig_pass(3000);
    TEST_ASSERT_EQUAL_HEX8(0x58, rig_reg(0x08));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_sample());
    TEST_ASSERT_EQUAL_INT32(0, rig.sample.current_ma); /* zeroed and polled it would be 1 A */
    rig_clean();
}

/* proves: X0-SEQ-47, X0-AMB-71, X0-AMB-72, X0-AMB-73, X0-NUM-827, X0-BIT-04 */
static void test_ship(void)
{
    for (unsigned reading = 0; reading < 3u; reading++) {
        rig_up("bq7692003", 5);
        rig.chip.options.amb71_needs_00 = reading == 1u;
        rig.chip.options.amb72_shut_reads_0 = reading == 2u;
        rig_pass(2500);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(true, true, 1));
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(bq769x0_begin_ship(&rig.d)));
        TEST_ASSERT_EQUAL_INT(SIM_X0_SHIP, rig.chip.mode);
        /* the last five: the pattern with nothing in between, then two looks */
        for (unsigned k = 0; k < 3u; k++) {
            const uint8_t *line = rig.log[(rig.logged - 5u + k) % 64u];
            static const uint8_t crc[3] = {0xbe, 0xb9, 0xb0};
            TEST_ASSERT_EQUAL_HEX8(0x10, line[0]);
            TEST_ASSERT_EQUAL_HEX8(0x04, line[1]);
            TEST_ASSERT_EQUAL_HEX8(0x18u + k, line[2]);
            TEST_ASSERT_EQUAL_HEX8(crc[k], line[3]);
        }
        rig_clean();
    }
}

/* proves: X0-SEQ-47 */
static void test_ship_that_does_not_happen_is_reported(void)
{
    rig_up("bq7692000", 5);
    rig.chip.options.amb72_shut_reads_0 = true;
    rig.chip.zero_boot = false;
    rig.chip.bus.dead = 0;
    rig_pass(500);
    /* a host that holds TS1 high would wake it again; here the pattern never arrives */
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq769x0_begin_ship(&rig.d));
    for (unsigned n = 0; n < 100000u; n++) {
        uint32_t wait_us = 0;
        bq_status st = bq769x0_poll(&rig.d, &wait_us);
        rig.chip.ship_armed = false;
        if (st != BQ_PENDING) {
            TEST_ASSERT_EQUAL_INT(BQ_E_VERIFY, st);
            TEST_ASSERT_EQUAL_INT(SIM_X0_NORMAL, rig.chip.mode);
            return;
        }
        hal_sim_x0_advance(&rig.hal, wait_us != 0u ? (uint64_t)wait_us * 1000u : 1000u);
    }
    TEST_FAIL();
}

/* proves: X0-NUM-528, X0-NUM-544, X0-CELL-18, X0-ELEC-13 */
static bool knows_nothing(const void *ctx, uint16_t code, int16_t *dc)
{
    (void)ctx, (void)code, (void)dc;
    return false;
}

static void test_configurations_that_are_refused(void)
{
    bq769x0_config good;
    rig_part("bq7692003", 5);
    good = rig.config;
#define REFUSED(status, change)                                                                              \
    do {                                                                                                     \
        rig.config = good;                                                                                   \
        change;                                                                                              \
        TEST_ASSERT_EQUAL_INT(status, rig_init());                                                           \
    } while (0)
    REFUSED(BQ_OK, (void)0);
    REFUSED(BQ_E_RANGE, rig.config.inputs = 6);
    REFUSED(BQ_E_CELLS, rig.config.wiring = 0x000f);
    REFUSED(BQ_E_RANGE,
            rig.config.ov_recover_mv = 0); /* mandatory: a fault that cannot end, or ends at once */
    REFUSED(BQ_E_RANGE, rig.config.uv_recover_mv = 0);
    REFUSED(BQ_E_RANGE, rig.config.ov_recover_mv = 4250);
    REFUSED(BQ_E_RANGE, rig.config.uv_recover_mv = 2800);
    REFUSED(BQ_E_CONFIG, rig.config.uv_recover_mv = 4300);
    REFUSED(BQ_E_RANGE, rig.config.sensors = 2);
    REFUSED(BQ_E_RANGE, rig.config.sensor = NULL);
    REFUSED(BQ_E_CONFIG, rig.config.sensor = knows_nothing);
    REFUSED(BQ_E_RANGE, rig.config.shunt_uohm = 99);
    REFUSED(BQ_E_RANGE, rig.config.address7 = 0x09);
    REFUSED(BQ_E_NO_CODE, rig.config.ocd_ma = 1000);
    REFUSED(BQ_E_NO_CODE, rig.config.scd_delay_us = 69);
    REFUSED(BQ_E_CONFIG, rig.config.scd_ma = 15000);
#undef REFUSED
    rig.config = good;
    rig.config.ov_mv = 4750;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, rig_start());
    rig.config = good;
    rig.config.uv_mv = 1500;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_init());
    TEST_ASSERT_EQUAL_INT(BQ_E_NO_CODE, rig_start());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_boot_waits);
    RUN_TEST(test_boot_waits_with_a_clock_that_moves);
    RUN_TEST(test_no_device);
    RUN_TEST(test_warm_start_takes_nothing_for_granted);
    RUN_TEST(test_warm_start_may_keep_the_fets_but_not_after_a_failure);
    RUN_TEST(test_the_field_mistake_of_content_left_over);
    RUN_TEST(test_zero_trim_is_a_device_zero_everything_a_bad_boot);
    RUN_TEST(test_wrong_wiring_is_found);
    RUN_TEST(test_low_nibble_of_protect3_stays);
    RUN_TEST(test_ship);
    RUN_TEST(test_ship_that_does_not_happen_is_reported);
    RUN_TEST(test_configurations_that_are_refused);
    return UNITY_END();
}
