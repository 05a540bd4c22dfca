/* SPDX-License-Identifier: Apache-2.0 */
/* Noise and damage on the bus. The truth is known: nothing called valid may differ from it. */
#include "driver_rig.h"
#include "unity.h"
#include <string.h>

static driver_rig r;
static bq76pl536_config c;
static unsigned round_number;

void setUp(void)
{
    c = rig_config(4);
    rig_up(&r, &c, NULL);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    round_number = 0;
}

void tearDown(void)
{
}

/* New voltages every round, so that old values are recognised. */
static unsigned change_voltages(void)
{
    unsigned mv = 3500 + round_number++ % 50 * 4;
    double volts[6];
    for (int i = 0; i < 6; i++) {
        volts[i] = mv / 1000.0;
    }
    for (int n = 1; n <= 4; n++) {
        (void)sim_pl_set_cells(&r.pl, n, volts);
    }
    return mv;
}

static unsigned check_truth(unsigned mv)
{
    unsigned valid = 0;
    for (int i = 0; i < 24; i++) {
        if ((r.cells[i].quality & BQ_Q_VALID) != 0) {
            TEST_ASSERT_UINT_WITHIN(1, mv, r.cells[i].mv);
            valid++;
        }
    }
    return valid;
}

/* A bit error rate at which a tenth of the bursts is damaged. Conversions start by pin: a broadcast whose
 * address is hit reaches nobody and leaves no trace.
 * proves: PL-SEQ-06-05, PL-SEQ-06-08, PL-CRC-07 */
static void noise_costs_retries_not_truth(void)
{
    c.use_conv_pin = true;
    rig_up(&r, &c, NULL);
    sim_bus_fault *bus = sim_pl_bus_fault(&r.pl);
    bus->rng = 12345;
    bus->flip_probability = 0.0003;
    unsigned valid = 0;
    for (int i = 0; i < 300; i++) {
        unsigned mv = change_voltages();
        if (rig_scan(&r) == BQ_OK) {
            rig_sample(&r);
            valid += check_truth(mv);
        }
        rig_advance_ms(&r, 100);
    }
    TEST_ASSERT_TRUE(valid > 280u * 24u);
    TEST_ASSERT_TRUE(bq76pl536_stats(&r.d)->retries > 20);
    TEST_ASSERT_TRUE(bq76pl536_stats(&r.d)->crc_errors > 20);
}

/* Every single bit of a burst, flipped on its way to the devices and back.
 * proves: PL-CRC-06, PL-CRC-07, PL-CRC-15, PL-SEQ-06-05 */
static void every_bit_of_a_burst_may_flip(void)
{
    for (int bit = 0; bit < 23 * 8; bit++) {
        for (int way = 0; way < 2; way++) {
            unsigned mv = change_voltages();
            TEST_ASSERT_EQUAL_INT(BQ_OK, bq76pl536_scan(&r.d));
            uint32_t wait_us;
            (void)bq76pl536_poll(&r.d, &wait_us);
            hal_sim_advance(&r.hal, wait_us * 1000ull);
            if (way == 0) {
                sim_pl_bus_fault(&r.pl)->flip_mosi_bit = bit + 1;
            } else {
                sim_pl_bus_fault(&r.pl)->flip_miso_bit = bit + 1;
            }
            TEST_ASSERT_EQUAL_INT(BQ_OK, rig_run(&r, 5));
            rig_sample(&r);
            TEST_ASSERT_EQUAL_UINT(24, check_truth(mv));
        }
    }
}

/* Every bit of the start; a start that nobody took (the address was hit) is lost without a trace and not
 * provable here.
 * proves: PL-SEQ-06-08, PL-SEQ-08-04 */
static void a_damaged_start_is_repeated(void)
{
    for (int bit = 8; bit < 32; bit++) {
        unsigned mv = change_voltages();
        sim_pl_bus_fault(&r.pl)->flip_mosi_bit = bit + 1;
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_UINT(24, check_truth(mv));
    }
}

/* Answers of another device, late answers, stuck and short ones: never believed, always over when the fault
 * is. */
static void other_damage_is_never_believed(void)
{
    for (int kind = 0; kind < 7; kind++) {
        setUp();
        sim_bus_fault *bus = sim_pl_bus_fault(&r.pl);
        unsigned mv = change_voltages();
        for (int i = 0; i < 3; i++) {
            bus->late_bits = kind == 0 ? 3 : 0;
            bus->stuck_miso = kind == 1 ? 1 : kind == 2 ? 2 : 0;
            bus->stuck_mosi = kind == 3 ? 1 : kind == 4 ? 2 : 0;
            bus->short_packets = kind == 5 ? 1000 : 0;
            bus->drop_packets = kind == 6 ? 1000 : 0;
            bq_status st = rig_scan(&r);
            rig_sample(&r);
            TEST_ASSERT_EQUAL_UINT(0, st == BQ_OK ? check_truth(mv) : 0);
            for (int k = 0; k < 24; k++) {
                TEST_ASSERT_EQUAL_HEX8(0, r.cells[k].quality & BQ_Q_VALID);
            }
            rig_advance_ms(&r, 100);
        }
        bus->late_bits = bus->stuck_miso = bus->stuck_mosi = 0;
        bus->short_packets = bus->drop_packets = 0;
        for (int i = 0; i < 3; i++) {
            (void)rig_scan(&r);
            rig_advance_ms(&r, 150);
        }
        TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
        rig_sample(&r);
        TEST_ASSERT_EQUAL_UINT(24, check_truth(mv));
    }
}

/* A bus that is broken above a device, as seen by the bus itself. */
static void a_break_on_the_bus_isolates_the_devices_above(void)
{
    unsigned mv = change_voltages();
    sim_pl_bus_fault(&r.pl)->break_above = 2;
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(12, check_truth(mv));
    sim_pl_bus_fault(&r.pl)->break_above = 0;
    rig_advance_ms(&r, 100);
    (void)rig_scan(&r);
    rig_advance_ms(&r, 100);
    TEST_ASSERT_EQUAL_INT(BQ_OK, rig_scan(&r));
    rig_sample(&r);
    TEST_ASSERT_EQUAL_UINT(24, check_truth(mv));
}

/* Bring-up under noise ends well or says why, and never leaves a wrong configuration behind a success.
 * proves: PL-SEQ-03-09, PL-G3-10 */
static void bring_up_under_noise_never_lies(void)
{
    unsigned good = 0;
    for (unsigned seed = 1; seed <= 25; seed++) {
        rig_open(&r, &c, NULL);
        sim_bus_fault *bus = sim_pl_bus_fault(&r.pl);
        bus->rng = seed * 77u;
        bus->flip_probability = 0.001;
        bq_status st = rig_start(&r);
        bus->flip_probability = 0;
        if (st != BQ_OK) {
            continue;
        }
        good++;
        for (int n = 1; n <= 4; n++) {
            TEST_ASSERT_EQUAL_HEX8(0x50, sim_pl_peek(&r.pl, n, 0x40));
            TEST_ASSERT_EQUAL_HEX8(0x2c, sim_pl_peek(&r.pl, n, 0x42));
            TEST_ASSERT_EQUAL_HEX8(0x15, sim_pl_peek(&r.pl, n, 0x44));
        }
    }
    TEST_ASSERT_TRUE(good >= 15);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(noise_costs_retries_not_truth);
    RUN_TEST(every_bit_of_a_burst_may_flip);
    RUN_TEST(a_damaged_start_is_repeated);
    RUN_TEST(other_damage_is_never_believed);
    RUN_TEST(a_break_on_the_bus_isolates_the_devices_above);
    RUN_TEST(bring_up_under_noise_never_lies);
    return UNITY_END();
}
