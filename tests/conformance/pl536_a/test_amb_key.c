/* SPDX-License-Identifier: Apache-2.0 */
/* PL-AMB-99 to PL-AMB-111: key, EPROM programming, special registers. */
#include "bench.h"
#include <stdio.h>

static void arm(void)
{
    bench_write(1, 0x3a, 0x35);
}

/* True when a write to USER1 goes through, that is, when the key is armed; the key is used up by it. */
static bool key_is_armed(void)
{
    static int value;

    value = value % 250 + 1;
    bench_write(1, 0x48, value);
    return bench_read(1, 0x48) == value;
}

/* proves: PL-AMB-99 */
static void test_the_key_serves_one_write_and_any_write_cancels_it(void)
{
    bench_stack(2);
    bench_quiet(2);
    TEST_ASSERT_FALSE(key_is_armed());
    arm();
    TEST_ASSERT_TRUE(key_is_armed());
    TEST_ASSERT_FALSE(key_is_armed()); /* used up */
    for (int reg = 0x00; reg <= 0xff; reg++) {
        if (reg == 0x3a || reg == 0x3b || reg == 0x3c || reg == 0x3d || reg == 0x3f) {
            continue;
        }
        arm();
        bench_write(1, reg, reg == 0x48 ? 0xfe : 0x00); /* unicast, whatever the register */
        TEST_ASSERT_FALSE(key_is_armed());
    }
    arm();
    bench_write(ALL, 0x31, 0x00); /* broadcast */
    TEST_ASSERT_FALSE(key_is_armed());
    arm();
    bench_write(1, 0x3a, 0x00); /* another value */
    TEST_ASSERT_FALSE(key_is_armed());
    arm();
    bench_write(1, 0x3a, 0x34);
    TEST_ASSERT_FALSE(key_is_armed());
    arm();
    bench_write(1, 0x3a, 0x27);
    TEST_ASSERT_FALSE(key_is_armed());
    arm();
    arm(); /* 0x35 again renews it */
    TEST_ASSERT_TRUE(key_is_armed());
    TEST_ASSERT_FALSE(key_is_armed());
}

/* proves: PL-AMB-99 */
static void test_reads_discarded_writes_and_other_devices_leave_the_key(void)
{
    bench_stack(2);
    bench_quiet(2);
    arm();
    (void)bench_read(1, 0x3a);
    (void)bench_read(1, 0x40);
    TEST_ASSERT_TRUE(key_is_armed());
    arm();
    expect("spi 03 31 00 00", "ok -- -- -- --"); /* wrong CRC */
    expect("spi 03 31 00", "ok -- -- --");
    TEST_ASSERT_TRUE(key_is_armed());
    arm();
    bench_write(2, 0x31, 0x00);
    bench_shadow(2, 0x48, 0x11);
    TEST_ASSERT_TRUE(key_is_armed());
    arm();
    expect("advance 1h", "ok"); /* it does not grow old */
    TEST_ASSERT_TRUE(key_is_armed());
    arm();
    bench_write(1, 0x3c, 0xa5);
    expect("advance 1ms", "ok");
    bench_write(0, 0x48, 0xfd);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3a));
    bench_write(0, 0x3a, 0x35);
    expect("set dev.1.supply off", "ok"); /* nor does it outlive a power-on reset */
    expect("advance 1ms", "ok");
    expect("set dev.1.supply on", "ok");
    expect("advance 57ms", "ok");
    bench_write(0, 0x48, 0xfd);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x48));
}

/* proves: PL-AMB-100 */
static void test_user_registers_are_writable_with_the_key(void)
{
    bench_address(1);
    for (int reg = 0x48; reg <= 0x4b; reg++) {
        bench_write(1, reg, 0xff);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, reg));
        bench_shadow(1, reg, 0x5a + reg);
        TEST_ASSERT_EQUAL_HEX8(0x5a + reg, bench_read(1, reg));
    }
}

/* proves: PL-AMB-100 */
static void test_other_reading_user_registers_are_read_only(void)
{
    static const sim_pl_options other = {.amb100_user_readonly = true};

    bench_stack_with(1, &other);
    bench_address(1);
    expect("set dev.1.otp.49 77", "ok");
    bench_write(1, 0x3a, 0x27);
    for (int reg = 0x48; reg <= 0x4b; reg++) {
        bench_shadow(1, reg, 0x5a);
        TEST_ASSERT_EQUAL_HEX8(reg == 0x49 ? 0x77 : 0x00, bench_read(1, reg));
    }
    bench_shadow(1, 0x47, 0x5a); /* the others are not */
    TEST_ASSERT_EQUAL_HEX8(0x5a, bench_read(1, 0x47));
}

/* proves: PL-AMB-101 */
static void test_4c_to_4f_ignore_writes_but_use_up_the_key(void)
{
    bench_address(1);
    for (int reg = 0x4c; reg <= 0x4f; reg++) {
        arm();
        bench_write(1, reg, 0xff);
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, reg));
        TEST_ASSERT_FALSE(key_is_armed());
    }
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x21) & 0x04);
}

/* Programs what the registers hold: 7 V, the command, `us`, voltage off. */
static void program(bool voltage, uint32_t us)
{
    if (voltage) {
        expect("set dev.1.vpp on", "ok");
    }
    bench_write(1, 0x3f, 0x91);
    bench_advance_us(us);
    expect("set dev.1.vpp off", "ok");
}

static void expect_otp(int user1)
{
    TEST_ASSERT_EQUAL_HEX8(user1, sim_pl_otp(bench_pl(), 1, 0x48));
}

/* proves: PL-AMB-102, PL-AMB-103, PL-AMB-105 */
static void test_programming_needs_the_voltage_and_its_time(void)
{
    static const uint32_t us[] = {0, 1000, 1499};

    for (size_t i = 0; i < sizeof us / sizeof us[0]; i++) {
        bench_stack(1);
        bench_quiet(1);
        bench_shadow(1, 0x48, 0x5a);
        program(true, us[i]); /* taken away too early */
        expect_otp(0x00);
    }
    bench_stack(1);
    bench_quiet(1);
    bench_shadow(1, 0x48, 0x5a);
    program(false, 3000);
    expect_otp(0x00);
    bench_write(1, 0x3f, 0x91); /* the voltage must be there at that moment */
    expect("set dev.1.vpp on", "ok");
    expect("advance 3ms", "ok");
    expect("set dev.1.vpp off", "ok");
    expect_otp(0x00);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3f));
    program(true, 1501);
    expect_otp(0x5a);
    expect("get dev.1.otp.42", "ok 2d"); /* all of 0x40..0x4b at once */
    expect("get dev.1.otp.43", "ok 85");
    expect("get dev.1.otp.45", "ok 85");
    bench_shadow(1, 0x48, 0x00);
    bench_write(1, 0x3a, 0x27);
    TEST_ASSERT_EQUAL_HEX8(0x5a, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3f));
}

/* proves: PL-AMB-103 */
static void test_any_access_closes_the_programming_window(void)
{
    for (int kind = 0; kind < 3; kind++) {
        bench_stack(2);
        bench_quiet(2);
        bench_shadow(1, 0x48, 0x5a);
        expect("set dev.1.vpp on", "ok");
        bench_write(1, 0x3f, 0x91);
        bench_advance_us(500);
        if (kind == 0) {
            (void)bench_read(1, 0x21);
        } else if (kind == 1) {
            bench_write(1, 0x31, 0x00);
        } else {
            bench_write(2, 0x31, 0x00); /* traffic to another device is none */
            (void)bench_read(2, 0x31);
        }
        bench_advance_us(2000);
        expect("set dev.1.vpp off", "ok");
        expect_otp(kind == 2 ? 0x5a : 0x00);
    }
}

/* proves: PL-AMB-104 */
static void test_values_may_be_written_before_or_after_the_voltage(void)
{
    bench_quiet(1);
    expect("set dev.1.vpp on", "ok");
    bench_shadow(1, 0x48, 0x3c);
    bench_write(1, 0x3f, 0x91);
    bench_advance_us(2500);
    expect("set dev.1.vpp off", "ok");
    expect_otp(0x3c);
}

/* proves: PL-AMB-105 */
static void test_the_voltage_beyond_50_ms_is_reported(void)
{
    for (int late = 0; late <= 1; late++) {
        bench_stack(1);
        bench_quiet(1);
        bench_shadow(1, 0x48, 0x5a);
        program(true, late ? 50001 : 49999);
        expect_otp(0x5a);
        if (late) {
            expect_misuse("PL-AMB-105 PL-OTP-06 PL-TIM-26", 1);
        } else {
            expect_no_misuse();
        }
    }
}

/* proves: PL-AMB-111 */
static void test_a_second_programming_run_is_refused_and_reported(void)
{
    bench_quiet(1);
    bench_shadow(1, 0x48, 0x51);
    program(true, 2500);
    expect_otp(0x51);
    expect_no_misuse();
    bench_shadow(1, 0x48, 0xff);
    program(true, 2500);
    expect_otp(0x51);
    expect_misuse("PL-AMB-111 PL-OTP-12 PL-OTP-02", 1);
}

/* proves: PL-AMB-106, PL-REG-01, PL-REG-03 */
static void test_writes_to_read_only_and_reserved_registers_are_ignored(void)
{
    uint8_t before[256], after[256];

    bench_quiet(1);
    bench_convert();
    for (int reg = 0; reg < 256; reg++) {
        bool readable = reg <= 0x12 || (reg >= 0x22 && reg <= 0x25),
             listed = (reg >= 0x20 && reg <= 0x25) || (reg >= 0x30 && reg <= 0x34);

        listed = listed || (reg >= 0x3a && reg <= 0x3d) || reg == 0x3f || (reg >= 0x40 && reg <= 0x4b);
        if (!readable && listed) {
            continue;
        }
        arm();
        bench_dump(1, before);
        bench_write(1, reg, 0xff);
        bench_dump(1, after);
        TEST_ASSERT_EQUAL_MEMORY(before, after, 256); /* not an error either: no flag */
        TEST_ASSERT_FALSE(key_is_armed());            /* but a write */
    }
}

/* proves: PL-AMB-107 */
static void test_what_the_special_registers_read(void)
{
    bench_address(1);
    bench_write(1, 0x3c, 0x5a); /* not the reset value */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3c));
    bench_write(1, 0x3f, 0x91);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3f));
    bench_write(1, 0x3f, 0x11);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3f));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3d));
    bench_write(1, 0x3d, 0x5a);
    TEST_ASSERT_EQUAL_HEX8(0x5a, bench_read(1, 0x3d));
    bench_write(1, 0x3d, 0xa4);
    TEST_ASSERT_EQUAL_HEX8(0xa4, bench_read(1, 0x3d));
    bench_write(1, 0x3d, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x3d));
}

/* proves: PL-AMB-108, PL-TEST-04 */
static void test_test_mode_cuts_the_base_off_until_power_on_reset(void)
{
    bench_stack(2);
    bench_quiet(2);
    bench_write(1, 0x3d, 0xa4);
    bench_write(1, 0x31, 0x00); /* voids the sequence */
    bench_write(1, 0x3d, 0x25);
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b));
    sim_misuse_clear(sim_pl_misuse(bench_pl()));
    bench_write(1, 0x3d, 0xa4);
    bench_write(1, 0x3d, 0x25);
    expect_misuse("PL-TEST-04 PL-TEST-03 PL-AMB-108", 1);
    TEST_ASSERT_TRUE(bench_silent(1));
    TEST_ASSERT_TRUE(bench_silent(2));
    bench_write(1, 0x3c, 0xa5); /* not even RESET is heard */
    expect("advance 1ms", "ok");
    TEST_ASSERT_TRUE(bench_silent(0));
    TEST_ASSERT_TRUE(bench_silent(1));
    expect("set dev.1.supply off", "ok");
    expect("advance 1ms", "ok");
    expect("set dev.1.supply on", "ok");
    expect("advance 57ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(0, 0x3b));
}

/* proves: PL-AMB-108 */
static void test_test_mode_elsewhere_does_not_touch_the_stack(void)
{
    bench_stack(3);
    bench_quiet(3);
    bench_write(2, 0x3d, 0xa4);
    bench_write(2, 0x3d, 0x25);
    for (int k = 1; k <= 3; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_read(k, 0x3b));
    }
    bench_write(2, 0x33, 0x1e);
    TEST_ASSERT_EQUAL_HEX8(0x1e, bench_read(2, 0x33));
}

/* proves: PL-AMB-109, PL-AMB-25 */
static void test_47_registers_exist_and_no_other_holds_anything(void)
{
    int writable = 0;

    bench_quiet(1);
    bench_write(1, 0x30, 0x40); /* ADC_ON: any ADCT may be written */
    for (int reg = 0; reg < 256; reg++) {
        int before, keeps;

        if (reg == 0x20 || reg == 0x21 || reg == 0x3b || reg == 0x3c || reg == 0x3d || reg == 0x41 ||
            reg == 0x34) {
            continue; /* seven more that exist: flags, address, reset, test, framing, start */
        }
        before = bench_read(1, reg);
        arm();
        bench_write(1, reg, 0xbb);
        keeps = bench_read(1, reg) != before;
        writable += keeps;
        if (keeps) {
            bench_shadow(1, reg, before);
        }
        TEST_ASSERT_EQUAL(keeps, (reg >= 0x30 && reg <= 0x33) || (reg >= 0x40 && reg <= 0x4b));
        if (reg > 0x12 && !keeps) {
            TEST_ASSERT_EQUAL_HEX8(0x00, before);
        }
    }
    TEST_ASSERT_EQUAL(4 + 11, writable);
}

/* proves: PL-AMB-110 */
static void test_command_codes(void)
{
    bench_stack(2);
    bench_quiet(2);
    expect("set dev.*.otp.48 66", "ok");
    for (int value = 0; value < 256; value++) { /* refresh is 0x27 and nothing else */
        if (value != 0x27 && value != 0x35) {
            bench_write(1, 0x3a, value);
            bench_write(1, 0x48, 0xaa); /* nor is any of them the key */
            TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x48));
        }
    }
    bench_write(1, 0x3a, 0x27);
    TEST_ASSERT_EQUAL_HEX8(0x66, bench_peek(1, 0x48));
    for (int value = 0; value < 256; value++) { /* reset is 0xa5 and nothing else */
        if (value != 0xa5) {
            bench_write(ALL, 0x3c, value);
            expect("get dev.2.mode", "ok active");
        }
    }
    bench_write(ALL, 0x3c, 0xa5);
    expect("get dev.1.mode", "ok reset");
    expect("get dev.2.mode", "ok reset");
    expect("advance 1ms", "ok");
    bench_quiet(2);
    bench_shadow(1, 0x49, 0x5a);
    expect("set dev.1.vpp on", "ok");
    for (int value = 0; value < 256; value++) { /* programming is 0x91 and nothing else */
        bench_write(1, 0x3f, value == 0x91 ? 0 : value);
    }
    bench_advance_us(2000);
    expect("get dev.1.otp.49", "ok 00");
    bench_write(1, 0x3f, 0x91);
    bench_advance_us(2000);
    expect("get dev.1.otp.49", "ok 5a");
    expect("set dev.1.vpp off", "ok");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_key_serves_one_write_and_any_write_cancels_it);
    RUN_TEST(test_reads_discarded_writes_and_other_devices_leave_the_key);
    RUN_TEST(test_user_registers_are_writable_with_the_key);
    RUN_TEST(test_other_reading_user_registers_are_read_only);
    RUN_TEST(test_4c_to_4f_ignore_writes_but_use_up_the_key);
    RUN_TEST(test_programming_needs_the_voltage_and_its_time);
    RUN_TEST(test_any_access_closes_the_programming_window);
    RUN_TEST(test_values_may_be_written_before_or_after_the_voltage);
    RUN_TEST(test_the_voltage_beyond_50_ms_is_reported);
    RUN_TEST(test_a_second_programming_run_is_refused_and_reported);
    RUN_TEST(test_writes_to_read_only_and_reserved_registers_are_ignored);
    RUN_TEST(test_what_the_special_registers_read);
    RUN_TEST(test_test_mode_cuts_the_base_off_until_power_on_reset);
    RUN_TEST(test_test_mode_elsewhere_does_not_touch_the_stack);
    RUN_TEST(test_47_registers_exist_and_no_other_holds_anything);
    RUN_TEST(test_command_codes);
    return UNITY_END();
}
