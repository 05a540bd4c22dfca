/* SPDX-License-Identifier: Apache-2.0 */
/* A device lost in the middle of the stack: PL-SEQ-13. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;

void setUp(void)
{
    c = rig_config(5);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
}

void tearDown(void)
{
}

static void scan(void)
{
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
}

static void expect_valid(int first, int last, bool valid)
{
    for (int n = first; n <= last; n++) {
        for (int i = 0; i < 6; i++) {
            TEST_ASSERT_EQUAL_HEX8(valid ? BQ_Q_VALID : BQ_Q_COMM, r.cells[6 * (n - 1) + i].quality);
            TEST_ASSERT_EQUAL_UINT(3600, r.cells[6 * (n - 1) + i].mv);
        }
    }
}

/* proves: PL-SEQ-13-01, PL-SEQ-13-02, PL-SEQ-13-03, PL-SEQ-13-08, PL-ADR-08, PL-BCAST-05 */
static void a_broken_link_keeps_the_devices_below_in_use(void)
{
    (void)sim_pl_set_link(&r.pl, 3, true);
    for (int i = 0; i < 5; i++) {
        rig_advance_ms(&r, 100);
        scan();
        expect_valid(1, 3, true);
        expect_valid(4, 5, false);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, r.modules[3].faults);
        TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, r.modules[4].faults);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[2].faults);
        TEST_ASSERT_TRUE(r.modules[3].age_ms >= 100u * (unsigned)(i + 1));
        TEST_ASSERT_TRUE(r.modules[2].age_ms < 100);
        TEST_ASSERT_EQUAL_UINT(3, bq76pl536_modules_found(&r.d));
        TEST_ASSERT_EQUAL_UINT(4, bq76pl536_diagnose(&r.d)->broken_hop);
    }
    (void)sim_pl_set_link(&r.pl, 3, false); /* they kept addresses and settings */
    rig_advance_ms(&r, 100);
    scan();
    scan();
    expect_valid(1, 5, true);
    TEST_ASSERT_EQUAL_HEX16(0, r.modules[3].faults);
    TEST_ASSERT_EQUAL_UINT(0, bq76pl536_diagnose(&r.d)->broken_hop);
    TEST_ASSERT_EQUAL_UINT(2, bq76pl536_stats(&r.d)->recoveries);
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* Device k loses its supply for a moment, for every k.
 * proves: PL-SEQ-13-04, PL-SEQ-13-05, PL-SEQ-13-06, PL-SEQ-13-07, PL-ADR-09, PL-ADR-10, PL-POR-10, PL-POR-11,
 * PL-SEQ-08-05 */
static void a_device_that_lost_its_supply_comes_back_configured(void)
{
    for (int k = 1; k <= 5; k++) {
        setUp();
        (void)sim_pl_set_supply(&r.pl, k, false);
        rig_advance_ms(&r, 20);
        if (k > 1) {
            scan();
            expect_valid(1, k - 1, true);
            expect_valid(k, 5, false);
        } else {
            TEST_ASSERT_EQUAL_INT(BQ_E_NO_ANSWER, rig_scan(&r));
            rig_sample(&r);
            expect_valid(1, 5, false);
        }
        (void)sim_pl_set_supply(&r.pl, k, true);
        rig_advance_ms(&r, 150);
        (void)rig_scan(&r);
        rig_sample(&r);
        TEST_ASSERT_TRUE((r.modules[k - 1].faults & BQ_F_RESET) != 0);
        TEST_ASSERT_EQUAL_UINT(5, bq76pl536_modules_found(&r.d));
        TEST_ASSERT_EQUAL_HEX8(0, r.cells[6 * (k - 1)].quality & BQ_Q_VALID); /* it warms up for 50 ms */
        rig_advance_ms(&r, 100);
        scan();
        expect_valid(1, 5, true);
        for (int n = 1; n <= 5; n++) {
            TEST_ASSERT_EQUAL_HEX16(0, r.modules[n - 1].faults);
            TEST_ASSERT_EQUAL_HEX8(0x80 + n, sim_pl_peek(&r.pl, n, 0x3b));
            TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, n, 0x42));
            TEST_ASSERT_EQUAL_HEX8(0x85, sim_pl_peek(&r.pl, n, 0x43));
            TEST_ASSERT_EQUAL_HEX8(0x7d, sim_pl_peek(&r.pl, n, 0x30));
            TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x20));
            TEST_ASSERT_EQUAL_HEX8(0x00, sim_pl_peek(&r.pl, n, 0x21));
        }
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* A RESET that nobody asked for: the device answers at 0x00 at once, the others go on.
 * proves: PL-SEQ-13-04, PL-SEQ-13-05, PL-SEQ-08-05 */
static void a_device_that_was_reset_is_taken_back_in_within_one_scan(void)
{
    for (int k = 1; k <= 5; k++) {
        setUp();
        rig_poke(&r, (uint8_t)k, 0x3c, 0xa5);
        sim_pl_advance(&r.pl, 2 * SIM_PL_MS);
        (void)rig_scan(&r);
        rig_sample(&r);
        expect_valid(1, k - 1, true);
        TEST_ASSERT_TRUE((r.modules[k - 1].faults & BQ_F_RESET) != 0);
        rig_advance_ms(&r, 100);
        scan();
        expect_valid(1, 5, true);
        TEST_ASSERT_EQUAL_HEX16(0, r.modules[k - 1].faults);
        TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, k, 0x42));
        TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
    }
}

/* Two devices at once.
 * proves: PL-SEQ-13-06 */
static void two_reset_devices_come_back_together(void)
{
    rig_poke(&r, 4, 0x3c, 0xa5);
    rig_poke(&r, 2, 0x3c, 0xa5);
    sim_pl_advance(&r.pl, 2 * SIM_PL_MS);
    scan();
    expect_valid(1, 1, true);
    rig_advance_ms(&r, 100);
    scan();
    expect_valid(1, 5, true);
    TEST_ASSERT_EQUAL_UINT(5, bq76pl536_modules_found(&r.d));
    TEST_ASSERT_EQUAL_UINT(0, rig_misuse(&r));
}

/* Supply lost after any number of bytes of a scan. Nothing old is ever called valid.
 * proves: PL-SEQ-13-08 */
static void brown_out_at_any_byte_of_a_scan(void)
{
    for (uint32_t byte = 1; byte <= 4 + 23 * 5; byte += 3) {
        setUp();
        for (int n = 1; n <= 5; n++) {
            (void)sim_pl_set_cell(&r.pl, n, 1, 3.8);
        }
        sim_bus_fault *bus = sim_pl_bus_fault(&r.pl);
        bus->brownout_device = 3;
        bus->brownout_bytes = byte;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        for (int n = 1; n <= 5; n++) {
            bool valid = (r.cells[6 * (n - 1)].quality & BQ_Q_VALID) != 0;
            TEST_ASSERT_TRUE(!valid || r.cells[6 * (n - 1)].mv == 3800);
            TEST_ASSERT_TRUE(valid || n >= 3);
        }
        bus->brownout_device = 0;
        (void)sim_pl_set_supply(&r.pl, 3, true);
        rig_advance_ms(&r, 150);
        (void)rig_scan(&r);
        rig_advance_ms(&r, 150);
        scan();
        for (int n = 1; n <= 5; n++) {
            TEST_ASSERT_EQUAL_HEX8(BQ_Q_VALID, r.cells[6 * (n - 1)].quality);
            TEST_ASSERT_EQUAL_UINT(3800, r.cells[6 * (n - 1)].mv);
        }
    }
}

/* proves: PL-SEQ-13-08, PL-SEQ-10-07 */
static void balancing_ends_when_a_device_is_lost(void)
{
    bq_mask_set(r.action.balance, 1);
    bq_mask_set(r.action.balance, 25);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    (void)sim_pl_set_link(&r.pl, 3, true);
    scan();
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 1));
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_apply(&r));
    TEST_ASSERT_EQUAL_HEX8(1, sim_pl_cb(&r.pl, 1));
    rig_advance_ms(&r, 4500);
    TEST_ASSERT_EQUAL_HEX8(0, sim_pl_cb(&r.pl, 5)); /* the safety timer */
}

/* proves: PL-SEQ-13-09, PL-CRC-09 */
static void a_reset_device_in_a_stack_without_crc_is_found_with_crc(void)
{
    c.crc_off = true;
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    (void)sim_pl_set_supply(&r.pl, 3, false);
    rig_advance_ms(&r, 10);
    (void)sim_pl_set_supply(&r.pl, 3, true);
    rig_advance_ms(&r, 150);
    (void)rig_scan(&r);
    rig_advance_ms(&r, 150);
    scan();
    expect_valid(1, 5, true);
    TEST_ASSERT_EQUAL_HEX8(0x01, sim_pl_peek(&r.pl, 3, 0x41));
}

/* The whole bus is gone for a while: everything becomes invalid, nothing is lost for ever.
 * proves: PL-SEQ-05-03, PL-AMB-12 */
static void a_dead_bus_recovers(void)
{
    for (int level = 1; level <= 2; level++) {
        setUp();
        sim_pl_bus_fault(&r.pl)->dead = level;
        for (int i = 0; i < 8; i++) {
            TEST_ASSERT_TRUE(rig_scan(&r) < 0);
            rig_sample(&r);
            expect_valid(1, 5, false);
            rig_advance_ms(&r, 100);
        }
        sim_pl_bus_fault(&r.pl)->dead = 0;
        (void)rig_scan(&r);
        rig_advance_ms(&r, 150);
        scan();
        expect_valid(1, 5, true);
    }
}

/* Values of a device that lost its address never stay: the mistake of a public driver.
 * proves: PL-SEQ-13-08 */
static void no_value_of_a_lost_device_stays_valid(void)
{
    (void)sim_pl_set_link(&r.pl, 4, true);
    (void)sim_pl_set_cell(&r.pl, 5, 1, 2.0);
    for (int i = 0; i < 3; i++) {
        scan();
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.cells[24].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.temps[8].quality);
        TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, r.modules[4].quality);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_broken_link_keeps_the_devices_below_in_use);
    RUN_TEST(a_device_that_lost_its_supply_comes_back_configured);
    RUN_TEST(a_device_that_was_reset_is_taken_back_in_within_one_scan);
    RUN_TEST(two_reset_devices_come_back_together);
    RUN_TEST(brown_out_at_any_byte_of_a_scan);
    RUN_TEST(balancing_ends_when_a_device_is_lost);
    RUN_TEST(a_reset_device_in_a_stack_without_crc_is_found_with_crc);
    RUN_TEST(a_dead_bus_recovers);
    RUN_TEST(no_value_of_a_lost_device_stays_valid);
    return UNITY_END();
}
