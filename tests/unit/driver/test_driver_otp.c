/* SPDX-License-Identifier: Apache-2.0 */
/* EPROM programming: PL-SEQ-12. In a build without BQHOST_OTP only its absence is tested. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;
static const uint8_t image[12] = {0x50, 0x00, 0x2c, 0x85, 0x15, 0x85, 0x55, 0x64, 0x5a, 0x00, 0x00, 0x01};

void setUp(void)
{
    c = rig_config(3);
    rig_up(&r, &c, NULL);
    r.hal.vpp_device = 2;
}

void tearDown(void)
{
}

#ifdef BQHOST_OTP

static int vpp_on_packets, damage_program, drop_program;

static bool watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    vpp_on_packets += sim_pl_vpp(&r.pl, 2);
    if (tx[1] == 0x3f && (tx[0] & 1) == 1) {
        if (damage_program > 0) {
            damage_program--;
            tx[3] ^= 1;
        } else if (drop_program > 0) {
            drop_program--;
            memset(rx, 0, n);
            return true;
        }
    }
    return false;
}

static bq_status program(const uint8_t *what)
{
    vpp_on_packets = 0;
    sim_pl_bus_fault(&r.pl)->hook = watch;
    bq_status st = bq76pl536_program_otp(&r.d, 2, what, BQ76PL536_OTP_GUARD);
    return st == BQ_OK ? rig_run(&r, 5) : st;
}

static void nothing_programmed(void)
{
    TEST_ASSERT_FALSE(sim_pl_vpp(&r.pl, 2));
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_HEX8(0, sim_pl_otp(&r.pl, 2, (uint8_t)(0x40 + i)));
    }
}

/* proves: PL-SEQ-12-02, PL-SEQ-12-03, PL-SEQ-12-04, PL-SEQ-12-05, PL-SEQ-12-06, PL-SEQ-12-07, PL-SEQ-12-08,
 * PL-OTP-06, PL-OTP-07, PL-TIM-26, PL-AMB-103, PL-AMB-104, PL-AMB-105, PL-OTP-08 */
static void programs_once_and_proves_it_after_a_reset(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, program(image));
    for (int i = 0; i < 12; i++) {
        TEST_ASSERT_EQUAL_HEX8(image[i], sim_pl_otp(&r.pl, 2, (uint8_t)(0x40 + i)));
    }
    TEST_ASSERT_FALSE(sim_pl_vpp(&r.pl, 2));
    TEST_ASSERT_EQUAL_INT(1, vpp_on_packets); /* the command and nothing else */
    rig_advance_ms(&r, 100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int i = 0; i < 18; i++) {
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    TEST_ASSERT_EQUAL_INT(BQ_E_NOT_BLANK, program(image));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-12-01, PL-OTP-09, PL-ELEC-12 */
static void every_guard_refuses(void)
{
    uint8_t bad[12];
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_program_otp(&r.d, 2, image, 0));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_program_otp(&r.d, 2, NULL, BQ76PL536_OTP_GUARD));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_program_otp(&r.d, 0, image, BQ76PL536_OTP_GUARD));
    TEST_ASSERT_EQUAL_INT(BQ_E_ARG, bq76pl536_program_otp(&r.d, 4, image, BQ76PL536_OTP_GUARD));
    memcpy(bad, image, 12);
    bad[2] = 0x3d;
    TEST_ASSERT_EQUAL_INT(BQ_E_RANGE, program(bad));
    memcpy(bad, image, 12);
    bad[4] = 0x1a;
    bad[2] = 0x1f;
    TEST_ASSERT_EQUAL_INT(BQ_E_COV_CUV, program(bad));
    memcpy(bad, image, 12);
    bad[3] = 0;
    TEST_ASSERT_EQUAL_INT(BQ_E_UNLATCHED, program(bad));
    memcpy(bad, image, 12);
    bad[1] = 1;
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, program(bad));
    r.hal.missing = 1u << BQ_LINE_VPP;
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, program(image));
    r.hal.missing = 0;
    TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
    TEST_ASSERT_EQUAL_INT(BQ_E_BUSY, program(image));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 1));
    (void)sim_pl_set_vbat(&r.pl, 2, 19.9);
    TEST_ASSERT_EQUAL_INT(BQ_E_VOLTAGE, program(image));
    nothing_programmed();
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* proves: PL-SEQ-12-09 */
static void a_damaged_command_is_repeated_once_when_proven_blank(void)
{
    damage_program = 1;
    TEST_ASSERT_EQUAL_INT(BQ_OK, program(image));
    TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_otp(&r.pl, 2, 0x42));
    setUp();
    damage_program = 2;
    TEST_ASSERT_EQUAL_INT(BQ_E_VERIFY, program(image));
    nothing_programmed();
    setUp();
    drop_program = 1; /* blank without a CRC flag: no repetition */
    TEST_ASSERT_EQUAL_INT(BQ_E_VERIFY, program(image));
    nothing_programmed();
    damage_program = 0;
    drop_program = 0;
}

/* Whatever transfer fails, the programming voltage is removed.
 * proves: PL-SEQ-12-06 */
static void the_voltage_goes_on_every_path(void)
{
    for (uint32_t n = 1; n < 110; n += 2) {
        setUp();
        sim_pl_bus_fault(&r.pl)->hook = watch;
        TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_program_otp(&r.d, 2, image, BQ76PL536_OTP_GUARD));
        r.hal.fail_at = n;
        r.hal.fail_count = 12;
        TEST_ASSERT_TRUE(rig_run(&r, 5) != BQ_PENDING);
        TEST_ASSERT_FALSE(sim_pl_vpp(&r.pl, 2));
        TEST_ASSERT_EQUAL_UINT(0, sim_misuse_of(sim_pl_misuse(&r.pl), "PL-AMB-105"));
        TEST_ASSERT_EQUAL_UINT(0, sim_misuse_of(sim_pl_misuse(&r.pl), "PL-OTP-05"));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(programs_once_and_proves_it_after_a_reset);
    RUN_TEST(every_guard_refuses);
    RUN_TEST(a_damaged_command_is_repeated_once_when_proven_blank);
    RUN_TEST(the_voltage_goes_on_every_path);
    return UNITY_END();
}

#else

/* proves: PL-OTP-09 */
static void is_absent(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_E_UNSUPPORTED, bq76pl536_program_otp(&r.d, 2, image, BQ76PL536_OTP_GUARD));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(is_absent);
    return UNITY_END();
}

#endif
