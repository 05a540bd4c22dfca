/* SPDX-License-Identifier: Apache-2.0 */
/* Section 8, broadcast, with PL-AMB-17 to PL-AMB-19. */
#include "bench.h"

/* proves: PL-BCAST-01, PL-AMB-18 */
static void test_a_broadcast_reaches_up_to_the_first_unaddressed_device(void)
{
    for (int addressed = 0; addressed <= 5; addressed++) {
        bench_stack(5);
        bench_address(addressed);
        expect("spi 7f 31 03 c5", "ok -- -- -- --");
        for (int k = 1; k <= 5; k++) {
            TEST_ASSERT_EQUAL_HEX8(k <= addressed + 1 ? 0x03 : 0x00, bench_peek(k, 0x31));
        }
        expect_no_misuse();
    }
}

/* proves: PL-BCAST-02, PL-AMB-17, PL-VEC-53 */
static void test_a_broadcast_read_gets_no_answer(void)
{
    for (int addressed = 0; addressed <= 2; addressed++) {
        bench_stack(2);
        bench_address(addressed);
        expect("spi 7e 00 01 00 00", "ok -- -- -- -- --");
        expect("spi 7e 3b 06 00 00 00 00 00 00 00", "ok -- -- -- -- -- -- -- -- -- --");
        expect_misuse("PL-BCAST-02 PL-AMB-17", -1);
    }
}

/* proves: PL-BCAST-02 */
static void test_a_broadcast_writes_one_register(void)
{
    uint8_t before[256], after[256];

    bench_stack(2);
    bench_quiet(2);
    bench_dump(2, before);
    bench_write(ALL, 0x33, 0x2a);
    bench_dump(2, after);
    for (int reg = 0; reg < 256; reg++) {
        TEST_ASSERT_EQUAL_HEX8(reg == 0x33 ? 0x2a : before[reg], after[reg]);
    }
}

/* proves: PL-BCAST-04, PL-AMB-19 */
static void test_a_broadcast_reset_reaches_whatever_receives_it(void)
{
    bench_stack(4);
    bench_write(0, 0x3b, 0x11);
    bench_write(0, 0x3b, 0x02);
    bench_write(ALL, 0x30, 0x05); /* devices 1 to 3; 3 has no address */
    expect("spi 7f 3c a5 57", "ok -- -- -- --");
    expect("get dev.1.mode", "ok reset");
    expect("get dev.2.mode", "ok reset");
    expect("get dev.3.mode", "ok reset");
    expect("get dev.4.mode", "ok active"); /* behind the unaddressed one */
    expect("advance 501us", "ok");
    for (int k = 1; k <= 4; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(k, 0x3b));
        TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(k, 0x30));
    }
    bench_address(4);
    expect("spi 7f 3c a5 57", "ok -- -- -- --");
    expect("get dev.4.mode", "ok reset");
    expect_no_misuse();
}

/* proves: PL-BCAST-06 */
static void test_shadow_writes_mix_broadcast_and_unicast(void)
{
    bench_stack(3);
    bench_quiet(3);
    bench_write(ALL, 0x3a, 0x35); /* both by broadcast */
    bench_write(ALL, 0x48, 0x11);
    for (int k = 1; k <= 3; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x11, bench_read(k, 0x48));
    }
    bench_write(ALL, 0x3a, 0x35); /* key to all, register to one */
    bench_write(2, 0x48, 0x22);
    TEST_ASSERT_EQUAL_HEX8(0x11, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x22, bench_read(2, 0x48));
    bench_write(3, 0x48, 0x33); /* device 3 heard nothing in between: its key still counts */
    TEST_ASSERT_EQUAL_HEX8(0x33, bench_read(3, 0x48));
    bench_write(2, 0x48, 0x44); /* that of device 2 is used up */
    TEST_ASSERT_EQUAL_HEX8(0x22, bench_read(2, 0x48));
    bench_stack(3);
    bench_quiet(3);
    bench_write(2, 0x3a, 0x35); /* key to one, register to all */
    bench_write(ALL, 0x48, 0x55);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x55, bench_read(2, 0x48));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(3, 0x48));
}

/* proves: PL-BCAST-07 */
static void test_each_device_checks_a_broadcast_by_its_own_rule(void)
{
    bench_stack(2);
    bench_quiet(2);
    bench_shadow(2, 0x41, 0x01); /* device 2 expects no CRC */
    bench_write(ALL, 0x33, 0x07);
    TEST_ASSERT_EQUAL_HEX8(0x07, bench_peek(1, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x21));
    expect("spi 7f 33 08", "ok -- -- --");
    TEST_ASSERT_EQUAL_HEX8(0x07, bench_peek(1, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x08, bench_peek(2, 0x33));
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_peek(1, 0x21)); /* flags for itself */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_peek(2, 0x21));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_broadcast_reaches_up_to_the_first_unaddressed_device);
    RUN_TEST(test_a_broadcast_read_gets_no_answer);
    RUN_TEST(test_a_broadcast_writes_one_register);
    RUN_TEST(test_a_broadcast_reset_reaches_whatever_receives_it);
    RUN_TEST(test_shadow_writes_mix_broadcast_and_unicast);
    RUN_TEST(test_each_device_checks_a_broadcast_by_its_own_rule);
    return UNITY_END();
}
