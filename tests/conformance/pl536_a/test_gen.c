/* SPDX-License-Identifier: Apache-2.0 */
/* Section 1, general. */
#include "bench.h"
#include <stdio.h>

/* proves: PL-GEN-01 */
static void test_every_input_and_output_exists(void)
{
    uint8_t block[18];
    static const uint8_t expected[18] = {0x26, 0xf7, 0x1e, 0xb8, 0x21, 0xca, 0x24, 0xdd, 0x25,
                                         0xe3, 0x2a, 0x7e, 0x2b, 0x01, 0x11, 0x16, 0x19, 0xcd};

    bench_address(1);
    expect("set dev.1.cell.1 3.0", "ok");
    expect("set dev.1.cell.2 3.3", "ok");
    expect("set dev.1.cell.3 3.6", "ok");
    expect("set dev.1.cell.4 3.7", "ok");
    expect("set dev.1.cell.5 4.15", "ok");
    expect("set dev.1.cell.6 4.2", "ok");
    expect("set dev.1.vbat 20.295", "ok");
    expect("set dev.1.ts.1 0.13242", "ok");
    expect("set dev.1.ts.2 0.2", "ok");
    expect("set dev.1.gpai 1.25", "ok");
    bench_write(1, 0x31, 0x43); /* both thermistors on, GPIO released */
    bench_shadow(1, 0x40, 0x10);
    bench_convert();
    bench_read_block(1, 0x01, 18, block);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, block, 18);
    bench_shadow(1, 0x40, 0x00); /* the same channel now measures the GPAI pins */
    bench_convert();
    bench_read_block(1, 0x01, 2, block);
    TEST_ASSERT_EQUAL_HEX8(0x20, block[0]);
    TEST_ASSERT_EQUAL_HEX8(0x00, block[1]);
    TEST_ASSERT_EQUAL_HEX8(0x63, bench_read(1, 0x31));
    expect("set dev.1.gpio 0", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x43, bench_read(1, 0x31));
    bench_write(1, 0x33, 0x1e);
    bench_write(1, 0x32, 0x3f);
    expect("get dev.1.cb", "ok 3f");
}

/* proves: PL-GEN-01 */
static void test_three_to_six_cells_are_protected(void)
{
    static const struct {
        int function_config, cov_fault;
    } cells[] = {{0x00, 0x3f}, {0x04, 0x1f}, {0x08, 0x0f}, {0x0c, 0x07}};

    bench_address(1);
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++) {
        bench_shadow(1, 0x40, cells[i].function_config);
        TEST_ASSERT_EQUAL_HEX8(cells[i].cov_fault, bench_read(1, 0x22)); /* blank part: 2.0 V without delay */
    }
}

/* proves: PL-GEN-02 */
static void test_comparators_do_not_depend_on_the_adc(void)
{
    bench_quiet(1);
    expect("set dev.1.cell.3 4.4", "ok"); /* the ADC is off */
    expect("advance 501ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x04, bench_read(1, 0x22));
    expect("set dev.1.cell.3 3.6", "ok");
    bench_write(1, 0x21, 0x01);
    bench_write(1, 0x21, 0x00);
    bench_shadow(1, 0x40, 0x40); /* ADCT without ADC_ON: the next start locks the ADC */
    bench_write(1, 0x34, 0x01);
    expect("advance 10ms", "ok");
    expect("get dev.1.mode", "ok locked");
    expect("set dev.1.cell.5 4.4", "ok");
    expect("set dev.1.cell.2 2.5", "ok");
    expect("advance 501ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x03, bench_read(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x10, bench_read(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_read(1, 0x23));
}

/* proves: PL-GEN-02 */
static void test_conversions_and_faults_do_not_touch_each_other(void)
{
    uint8_t block[2];

    bench_quiet(1);
    expect("set dev.1.cell.1 4.4", "ok");
    for (int i = 0; i < 24; i++) { /* conversions all through the delay of 500 ms */
        expect("advance 19ms", "ok");
        bench_convert();
    }
    expect("advance 19ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x22));
    expect("advance 2ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_read(1, 0x22));
    bench_convert(); /* 4.4 V x 16383 / 6.25 = 11533.6 */
    bench_read_block(1, 0x03, 2, block);
    TEST_ASSERT_EQUAL(11534, block[0] << 8 | block[1]);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench_read(1, 0x22));
    expect_no_misuse();
}

/* proves: PL-GEN-03 */
static void test_protection_runs_from_eprom_without_a_host(void)
{
    expect("set dev.1.otp.42 2c", "ok"); /* 4.20 V */
    expect("set dev.1.otp.43 85", "ok"); /* 500 ms */
    expect("set dev.1.otp.44 15", "ok"); /* 2.8 V */
    expect("set dev.1.otp.45 85", "ok");
    expect("set dev.1.supply off", "ok");
    expect("advance 1ms", "ok");
    expect("set dev.1.supply on", "ok");
    expect("advance 100ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x08, bench_peek(1, 0x21));
    expect("set dev.1.cell.2 4.21", "ok");
    expect("set dev.1.cell.6 2.79", "ok");
    expect("advance 499ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x08, bench_peek(1, 0x21));
    expect("advance 2ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x0b, bench_peek(1, 0x21));
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_peek(1, 0x22));
    TEST_ASSERT_EQUAL_HEX8(0x20, bench_peek(1, 0x23));
    expect("get pin.fault", "ok 1");
}

/* proves: PL-GEN-04 */
static void test_only_the_host_balances(void)
{
    bench_quiet(1);
    expect("set dev.1.cell.4 4.2", "ok");
    expect("set dev.1.cell.5 3.0", "ok");
    expect("advance 1h", "ok");
    expect("get dev.1.cb", "ok 00");
    bench_write(1, 0x33, 0x05);
    bench_write(1, 0x32, 0x12); /* not what the cells would ask for: the device does not judge it */
    expect("get dev.1.cb", "ok 12");
    expect("advance 4999ms", "ok");
    expect("get dev.1.cb", "ok 12");
    expect("advance 2ms", "ok");
    expect("get dev.1.cb", "ok 00");
}

/* proves: PL-GEN-05, PL-AMB-32 */
static void test_62_devices_can_be_addressed(void)
{
    uint8_t block[2];
    char line[40];

    bench_stack(62);
    bench_address(62);
    for (int k = 1; k <= 62; k++) {
        TEST_ASSERT_EQUAL_HEX8(0x80 | k, bench_read(k, 0x3b));
        (void)snprintf(line, sizeof line, "set dev.%d.cell.1 %d.%02d", k, 3, k);
        expect(line, "ok");
    }
    bench_convert();
    for (int k = 1; k <= 62; k++) { /* each device measures its own cells */
        bench_read_block(k, 0x03, 2, block);
        TEST_ASSERT_EQUAL((int)((3.0 + k / 100.0) * 16383 / 6.25 + 0.5), block[0] << 8 | block[1]);
    }
    TEST_ASSERT_TRUE(bench_silent(0x00));
    expect("stack 63", "err number of devices must be 1..62: 63");
    expect_no_misuse();
}

/* proves: PL-GEN-06, PL-PIN-05 */
static void test_only_the_base_talks_to_the_host(void)
{
    bench_stack(3);
    bench_quiet(3);
    bench_write(3, 0x21, 0x10); /* FORCE in the top device shows on the base's pin */
    expect("get pin.fault", "ok 1");
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(3, 0x3b));
    expect("set dev.1.supply off",
           "ok"); /* without the base nothing reaches the host, whatever the others do */
    expect("advance 1ms", "ok");
    TEST_ASSERT_TRUE(bench_silent(1));
    TEST_ASSERT_TRUE(bench_silent(2));
    TEST_ASSERT_TRUE(bench_silent(3));
    TEST_ASSERT_TRUE(bench_silent(0));
    expect("get pin.fault", "ok 0");
    expect("get pin.alert", "ok 0");
    expect("get pin.drdy", "ok 0");
    TEST_ASSERT_EQUAL_HEX8(0x10, bench_peek(3, 0x21));
}

/* proves: PL-GEN-08 */
static void test_the_registers_behind_the_names(void)
{
    bench_address(1);
    expect("set dev.1.cell.1 3.35", "ok");
    bench_write(1, 0x30, 0x40); /* ADC_CONTROL, ADC_CTRL, ADC_CONFIG */
    expect("advance 1ms", "ok");
    bench_write(1, 0x34, 0x01); /* ADC_CONVERT, CONVERT_CTRL, CONVERT */
    expect("advance 1ms", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x22, bench_read(1, 0x03));
    bench_write(1, 0x31, 0x80); /* IO_CONTROL, IO_CTRL */
    TEST_ASSERT_TRUE(sim_pl_aux(bench_pl(), 1));
    bench_write(1, 0x33, 0x01); /* CB_TIME, CBT_CONTROL */
    bench_write(1, 0x32, 0x01);
    expect("get dev.1.cb", "ok 01");
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x3b)); /* ADDRESS_CONTROL, ADDR_CTRL, DEVICE_ADDRESS */
    bench_shadow(1, 0x40, 0x0c); /* SHDW_CTRL and FUNCTION_CONFIG, FUNC_CONFIG: three cells */
    TEST_ASSERT_EQUAL_HEX8(0x07, bench_read(1, 0x22));
    bench_shadow(1, 0x42, 0x80);
    bench_shadow(1, 0x44, 0x1a); /* CONFIG_CUV, CONFIG_UV: 3.3 V */
    expect("set dev.1.cell.2 3.2", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_read(1, 0x23));
    TEST_ASSERT_EQUAL_HEX8(0x0a, bench_read(1, 0x21)); /* FAULT_STATUS, FAULT: POR and CUV */
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(1, 0x20)); /* ALERT_STATUS, ALERT */
    bench_shadow(1, 0x46, 0x21);                       /* CONFIG_OT: CONFIG_OT1 low, CONFIG_OT2 high nibble */
    bench_write(1, 0x31, 0x03);
    expect("set dev.*.ts.1 0.21", "ok"); /* above 40 C */
    expect("set dev.*.ts.2 0.21", "ok"); /* below 45 C */
    TEST_ASSERT_EQUAL_HEX8(0x81, bench_read(1, 0x20));
    expect("set dev.*.ts.2 0.23", "ok");
    TEST_ASSERT_EQUAL_HEX8(0x83, bench_read(1, 0x20));
    TEST_ASSERT_EQUAL(0, sim_pl_damage_ram(bench_pl(), 1, 0x47, 0x01));
    TEST_ASSERT_EQUAL_HEX8(0x80, bench_read(1, 0x24)); /* PRESULT_A */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x25));
    TEST_ASSERT_EQUAL(0, sim_pl_damage_ram(bench_pl(), 1, 0x49, 0x80));
    TEST_ASSERT_EQUAL_HEX8(0x02, bench_read(1, 0x25)); /* PRESULT_B, also printed PARITY_H */
    bench_write(1, 0x3a, 0x27);                        /* RELOAD_SHADOW, SHADOW_LOAD, REFRESH */
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x44));
    TEST_ASSERT_EQUAL_HEX8(0x00, bench_read(1, 0x24));
}

/* proves: PL-GEN-08 */
static void test_e_en_programs_from_its_address(void)
{
    bench_address(1);
    bench_shadow(1, 0x48, 0x5a);
    expect("set dev.1.vpp on", "ok");
    bench_write(1, 0x3f, 0x91); /* E_EN, EE_EN */
    expect("advance 2ms", "ok");
    expect("set dev.1.vpp off", "ok");
    expect("get dev.1.otp.48", "ok 5a");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_input_and_output_exists);
    RUN_TEST(test_three_to_six_cells_are_protected);
    RUN_TEST(test_comparators_do_not_depend_on_the_adc);
    RUN_TEST(test_conversions_and_faults_do_not_touch_each_other);
    RUN_TEST(test_protection_runs_from_eprom_without_a_host);
    RUN_TEST(test_only_the_host_balances);
    RUN_TEST(test_62_devices_can_be_addressed);
    RUN_TEST(test_only_the_base_talks_to_the_host);
    RUN_TEST(test_the_registers_behind_the_names);
    RUN_TEST(test_e_en_programs_from_its_address);
    return UNITY_END();
}
