/* SPDX-License-Identifier: Apache-2.0 */
/* The judge: a correct host is never blamed. What is blamed is tested where the rule is. */
#include "rig.h"

static void configure(int device)
{
    rig_write(device, R_ADC, 0x7d);
    rig_ms(1);
    rig_shadow(device, C_FUNC, 0x50);
    rig_shadow(device, C_COV, 0x2c);
    rig_shadow(device, C_CUV, 0x15);
    rig_shadow(device, C_OTT, 0x64);
    rig_shadow(device, C_OT, 0x55);
    rig_shadow(device, C_COVT, 0x85);
    rig_shadow(device, C_CUVT, 0x85);
    rig_write(device, R_IO, 0x03);
    rig_ms(10);
    rig_clear(device, R_FAULT, 0x08);
}

static void work(void)
{
    rig_convert(ALL);
    for (int d = 1; d <= 4; d++) {
        uint8_t all[19];
        rig_read_block(d, 0, all, sizeof all);
        TEST_ASSERT_EQUAL_HEX8(0x81, all[0]);
    }
    sim_pl_set_conv(&rig, true);
    rig_us(100);
    sim_pl_set_conv(&rig, false);
    rig_write(ALL, R_CB, 0x00);
    rig_write(ALL, R_CBT, 0x05);
    rig_write(3, R_CB, 0x3f);
    rig_s(1);
    rig_write(ALL, R_CB, 0x00);
    rig_write(4, R_FAULT, 0x10);
    rig_write(4, R_FAULT, 0x00);
    rig_write(4, R_ALERT, 0x10);
    rig_write(4, R_ALERT, 0x00);
    rig_write(ALL, R_ADC, 0x3d);
    rig_write(ALL, R_IO, 0x04);
    rig_s(1);
    rig_clear(ALL, R_ALERT, 0x04);
    rig_write(ALL, R_IO, 0x03);
    rig_ms(1);
    rig_write(ALL, R_ADC, 0x7d);
    rig_ms(1);
    rig_convert(ALL);
    rig_write(2, R_SHDW, 0x27); /* a refresh falls back to the EPROM: configure again */
    configure(2);
    rig_reset(3);
    rig_write(0, R_ADDR, 0x83);
    rig_clear(3, R_ALERT, 0x80);
    configure(3);
    rig_convert(ALL);
}

/* proves: PL-SPI-12, PL-ADC-18, PL-FLT-12, PL-REG-50 */
static void a_correct_host_has_a_clean_book(void)
{
    rig_up(4);
    for (int pass = 0; pass < 4; pass++) {
        rig_write(ALL, R_RESET, 0xa5);
        rig_ms(1);
        for (int n = 1; n <= pass + 1; n++) {
            rig_write(0, R_ADDR, 0x80 | n);
            rig_us(5);
            EXPECT(0x80 | n, n, R_ADDR);
        }
    }
    TEST_ASSERT_FALSE(rig_answers(0));
    rig_clear(ALL, R_ALERT, 0x80);
    configure(ALL);
    work();
    EXPECT_CLEAN();
    for (int d = 1; d <= 4; d++) {
        EXPECT(0x81, d, R_STATUS);
    }
}

/* proves: PL-REG-01, PL-REG-02, PL-AMB-106 */
static void the_book_counts_names_and_forgets(void)
{
    rig_ready(2);
    rig_us(123);
    rig_write(2, 0x13, 0x01);
    TEST_ASSERT_EQUAL_UINT(1, sim_pl_misuse(&rig)->count);
    TEST_ASSERT_EQUAL_INT(2, sim_pl_misuse(&rig)->entry[0].device);
    TEST_ASSERT_TRUE(sim_pl_misuse(&rig)->entry[0].time_ns == sim_pl_now(&rig));
    TEST_ASSERT_EQUAL_INT(0, sim_pl_misuse(&rig)->entry[0].text[0] == '\0');
    for (int i = 0; i < 200; i++) {
        rig_write(2, 0x13, 0x01);
    }
    TEST_ASSERT_EQUAL_UINT(201, sim_pl_misuse(&rig)->count);
    sim_misuse_clear(sim_pl_misuse(&rig));
    EXPECT_CLEAN();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_correct_host_has_a_clean_book);
    RUN_TEST(the_book_counts_names_and_forgets);
    return UNITY_END();
}
