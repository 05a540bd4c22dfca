/* SPDX-License-Identifier: Apache-2.0 */
/* The register map, 0x00 to 0x25, PL-REG: one test per row, through the bus alone. */
#include "rig_reg.h"

/* proves: PL-REG-07, PL-REG-03, PL-AMB-106 */
static void device_status_00(void)
{
    read_only(0x00);
    rig_up(1);
    EXPECT(0x61, 0, 0x00);
    rig_ready(1);
    rig_write(1, R_CBT, 5);
    rig_write(1, R_CB, 1);
    EXPECT(0x83, 1, 0x00);
    rig_write(1, R_CONV, 1);
    EXPECT(0x82, 1, 0x00);
    rig_ms(1);
    rig_write(1, R_CB, 0);
    rig_write(1, R_FAULT, 0x10);
    EXPECT(0xc1, 1, 0x00);
    rig_write(1, R_FAULT, 0x00);
    rig_write(1, R_ALERT, 0x10);
    EXPECT(0xa1, 1, 0x00);
    rig_write(1, R_ALERT, 0x00);
    sim_pl_set_vbat(&rig, 1, 5.2);
    rig_us(20);
    EXPECT(0x85, 1, 0x00);
}

/* proves: PL-REG-08 */
static void gpai_01(void)
{
    result(0x01, gpai_full);
}

/* proves: PL-REG-09 */
static void vcell1_03(void)
{
    result(0x03, all_cells_full);
}

/* proves: PL-REG-10 */
static void vcell2_05(void)
{
    result(0x05, all_cells_full);
}

/* proves: PL-REG-11 */
static void vcell3_07(void)
{
    result(0x07, all_cells_full);
}

/* proves: PL-REG-12 */
static void vcell4_09(void)
{
    result(0x09, all_cells_full);
}

/* proves: PL-REG-13 */
static void vcell5_0b(void)
{
    result(0x0b, all_cells_full);
}

/* proves: PL-REG-14 */
static void vcell6_0d(void)
{
    result(0x0d, all_cells_full);
}

/* proves: PL-REG-15 */
static void temperature1_0f(void)
{
    result(0x0f, sensors_full);
}

/* proves: PL-REG-16 */
static void temperature2_11(void)
{
    result(0x11, sensors_full);
}

/* proves: PL-REG-17, PL-REG-01 */
static void reserved_13_to_1f(void)
{
    reserved(0x13, 0x1f);
}

/* proves: PL-REG-18, PL-REG-50 */
static void alert_status_20(void)
{
    read_write(0x20, 0x10, 0x00, 0x80);
}

/* proves: PL-REG-19, PL-REG-50 */
static void fault_status_21(void)
{
    read_write(0x21, 0x10, 0x00, 0x09);
    reserved_bits(0x21, 0x3f);
}

/* proves: PL-REG-20 */
static void cov_fault_22(void)
{
    read_only(0x22);
    EXPECT(0x00, 1, 0x22);
    for (int c = 1; c <= 6; c++) {
        sim_pl_set_cell(&rig, 1, c, 5.0);
    }
    rig_cov(0x15, 0x00);
    rig_us(1);
    EXPECT(0x3f, 1, 0x22);
}

/* proves: PL-REG-21 */
static void cuv_fault_23(void)
{
    read_only(0x23);
    EXPECT(0x00, 1, 0x23);
    for (int c = 1; c <= 6; c++) {
        sim_pl_set_cell(&rig, 1, c, 2.0);
    }
    rig_cuv(0x15, 0x00);
    rig_us(1);
    EXPECT(0x3f, 1, 0x23);
}

/* proves: PL-REG-22 */
static void presult_a_24(void)
{
    read_only(0x24);
    EXPECT(0x00, 1, 0x24);
}

/* proves: PL-REG-23 */
static void presult_b_25(void)
{
    read_only(0x25);
    EXPECT(0x00, 1, 0x25);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(device_status_00);
    RUN_TEST(gpai_01);
    RUN_TEST(vcell1_03);
    RUN_TEST(vcell2_05);
    RUN_TEST(vcell3_07);
    RUN_TEST(vcell4_09);
    RUN_TEST(vcell5_0b);
    RUN_TEST(vcell6_0d);
    RUN_TEST(temperature1_0f);
    RUN_TEST(temperature2_11);
    RUN_TEST(reserved_13_to_1f);
    RUN_TEST(alert_status_20);
    RUN_TEST(fault_status_21);
    RUN_TEST(cov_fault_22);
    RUN_TEST(cuv_fault_23);
    RUN_TEST(presult_a_24);
    RUN_TEST(presult_b_25);
    return UNITY_END();
}
