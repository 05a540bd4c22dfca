/* SPDX-License-Identifier: Apache-2.0 */
/* What becomes of the codes in a burst. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(2);
    c.cov_mv = 0;
    c.cuv_mv = 0;
    c.wire_limit_mv = 60000; /* these tests move cells as no pack does */
}

void tearDown(void)
{
}

/* proves: PL-VCELL-01, PL-VCELL-05, PL-SEQ-06-07, PL-NUM-08, PL-VBAT-01, PL-NUM-10, PL-AMB-58 */
static void cells_and_brick_convert_to_the_nearest_millivolt(void)
{
    static const double volts[6] = {1.2, 2.5, 3.35, 3.7, 4.2, 4.5};
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_cells(&r.pl, 1, volts);
    (void)sim_pl_set_vbat(&r.pl, 1, 20.0);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_UINT((unsigned)(volts[i] * 1000 + 0.5), r.cells[i].mv);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[i].quality);
    }
    TEST_ASSERT_EQUAL_UINT(19999, r.modules[0].stack_mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.modules[0].quality);
}

/* proves: PL-SEQ-06-07, PL-NUM-07 */
static void the_ends_of_the_converter_are_marked(void)
{
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_cell(&r.pl, 1, 1, 0.0);
    (void)sim_pl_set_cell(&r.pl, 1, 2, 6.5);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID | BQ_Q_RANGE | BQ_Q_OUTSIDE, r.cells[0].quality);
    TEST_ASSERT_EQUAL_UINT(0, r.cells[0].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID | BQ_Q_RANGE | BQ_Q_OUTSIDE, r.cells[1].quality);
    TEST_ASSERT_EQUAL_UINT(6250, r.cells[1].mv);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[2].quality);
}

static void set_brick(double volts)
{
    (void)sim_pl_set_vbat(&r.pl, 1, volts);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
}

/* proves: PL-ELEC-01, PL-AMB-94 */
static void values_outside_the_recommended_range_count_and_carry_a_warning(void)
{
    static const double volts[6] = {0.98, 1.02, 3.6, 3.6, 4.48, 4.52};
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_cells(&r.pl, 1, volts);
    set_brick(7.1);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID | BQ_Q_OUTSIDE, r.modules[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.modules[1].quality);
    for (int i = 0; i < 6; i++) {
        uint8_t warning = i == 0 || i == 5 ? BQ_Q_OUTSIDE : 0;
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID | warning, r.cells[i].quality);
    }
    set_brick(7.3);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.modules[0].quality);
    set_brick(26.9);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.modules[0].quality);
    set_brick(27.1);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID | BQ_Q_OUTSIDE, r.modules[0].quality);
}

/* proves: PL-TS-01, PL-TS-02, PL-TS-08, PL-TS-09, PL-NUM-12, PL-AMB-75 */
static void thermistors_read_degrees_and_name_broken_sensors(void)
{
    rig_up(&r, &c, NULL);
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 1, 1820.0 / (3290.0 + 10000.0));
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 2, 1820.0 / (3290.0 + 27280.0)); /* 0 C */
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_INT_WITHIN(1, 250, r.temps[0].dc);
    TEST_ASSERT_INT_WITHIN(15, 0, r.temps[1].dc);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.temps[1].quality);
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 1, 0.0);
    (void)sim_pl_set_ts_ratio(&r.pl, 1, 2, 0.553);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_SENSOR | BQ_Q_RANGE, r.temps[0].quality);
    TEST_ASSERT_EQUAL_HEX8(BQ_Q_SENSOR | BQ_Q_RANGE, r.temps[1].quality);
    TEST_ASSERT_INT_WITHIN(1, 250, r.temps[0].dc); /* the last good value */
}

/* A burst whose CRC is right and whose content cannot be true. */
static struct lie {
    int device, kind;
} lie;

static uint8_t crc8(const uint8_t *data, unsigned n, uint8_t crc)
{
    for (unsigned i = 0; i < n; i++) {
        crc ^= data[i];
        for (int b = 0; b < 8; b++) {
            crc = (uint8_t)((crc << 1) ^ ((crc & 0x80) != 0 ? 0x07 : 0));
        }
    }
    return crc;
}

static bool tell(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n)
{
    (void)ctx;
    if (n != 23 || tx[0] >> 1 != lie.device) {
        return false;
    }
    memset(rx, 0, n);
    for (int i = 0; i < 9; i++) {
        rx[4 + 2 * i] = 0x24;
        rx[5 + 2 * i] = 0xdd;
    }
    rx[4] = 0x29;
    rx[5] = 0x79;
    rx[3] = 0x81;
    switch (lie.kind) {
    case 0:
        rx[3] = 0x01; /* no address */
        break;
    case 1:
        rx[3] = 0x91; /* bit 4 */
        break;
    case 2:
        rx[10] |= 0x40; /* bit 14 of a word */
        break;
    case 3:
        rx[20] |= 0x80;
        break;
    case 4:
        memset(rx, 0x00, n);
        return true;
    default:
        memset(rx, 0xff, n);
        return true;
    }
    rx[22] = crc8(rx + 3, 19, crc8(tx, 3, 0));
    return true;
}

/* proves: PL-CRC-12, PL-CRC-13, PL-VCELL-06, PL-VEC-51, PL-VEC-52, PL-SEQ-06-06, PL-AMB-12 */
static void impossible_content_is_refused_even_with_a_right_crc(void)
{
    for (lie.kind = 0; lie.kind < 6; lie.kind++) {
        c.devices = 62;
        lie.device = 0x38; /* all ones have a right CRC here */
        rig_up(&r, &c, NULL);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        sim_pl_bus_fault(&r.pl)->hook = tell;
        bq_link_stats before = *bq76pl536_stats(&r.d);
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.cells[6 * 55].quality);
        TEST_ASSERT_EQUAL_UINT(3600, r.cells[6 * 55].mv);
        if (lie.kind < 4) {
            TEST_ASSERT_EQUAL_UINT(before.implausible + 3, bq76pl536_stats(&r.d)->implausible);
        } else {
            TEST_ASSERT_EQUAL_UINT(before.no_answers + 3, bq76pl536_stats(&r.d)->no_answers);
        }
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * 54].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * 56].quality);
    }
}

/* 62 devices of 6 cells at 4.5 V: the sum of the pack does not fit 16 bits, that of a brick does. */
static void large_stacks_do_not_wrap(void)
{
    static const double volts[6] = {4.5, 4.5, 4.5, 4.5, 4.5, 4.5};
    c.devices = 62;
    rig_up(&r, &c, NULL);
    for (int n = 1; n <= 62; n++) {
        (void)sim_pl_set_cells(&r.pl, n, volts);
    }
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    uint32_t sum = 0;
    for (int i = 0; i < 372; i++) {
        sum += r.cells[i].mv;
    }
    TEST_ASSERT_EQUAL_UINT(372u * 4500u, sum);
    TEST_ASSERT_UINT_WITHIN(3, 27000, r.modules[61].stack_mv);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(cells_and_brick_convert_to_the_nearest_millivolt);
    RUN_TEST(the_ends_of_the_converter_are_marked);
    RUN_TEST(values_outside_the_recommended_range_count_and_carry_a_warning);
    RUN_TEST(thermistors_read_degrees_and_name_broken_sensors);
    RUN_TEST(impossible_content_is_refused_even_with_a_right_crc);
    RUN_TEST(large_stacks_do_not_wrap);
    return UNITY_END();
}
