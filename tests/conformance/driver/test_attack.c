/* SPDX-License-Identifier: Apache-2.0 */
/* Damage from outside: whatever happens on the wire, nothing invented is ever reported as valid, and the
 * driver ends. */
#include "bench.h"

/* Cells carry their place, so that a value from elsewhere or from before shows. */
static double truth(int device, int cell, int round)
{
    return 3.0 + 0.05 * device + 0.007 * cell + 0.1 * (round % 5);
}

static void world(int devices, int round)
{
    for (int d = 1; d <= devices; d++) {
        double v[6];
        for (int c = 1; c <= 6; c++) {
            v[c - 1] = truth(d, c, round);
        }
        sim_pl_set_cells(&b.pl, d, v);
    }
}

/* The round in which each device converted last. A broadcast start that nobody received leaves no trace
 * without the CONV pin (PL-SEQ-06-08): then the old picture may be taken for the new one, but nothing else
 * ever. */
static int taken[BQ76PL536_MAX_DEVICES + 1];
static uint32_t conversions[BQ76PL536_MAX_DEVICES + 1];

static void note_conversions(int devices, int round)
{
    for (int d = 1; d <= devices; d++) {
        uint32_t now = sim_pl_conversions(&b.pl, d);
        taken[d] = now != conversions[d] ? round : taken[d];
        conversions[d] = now;
    }
}

/* Every value that claims to be fresh is the present truth. Returns how many are fresh. */
static int expect_honest(int devices, int round, uint32_t since_ms)
{
    int fresh = 0;
    note_conversions(devices, round);
    if (b.afe.ops->sample(b.afe.ctx, &b.sample) != BQ_OK) {
        return 0;
    }
    for (int d = 1; d <= devices; d++) {
        for (int c = 1; c <= 6; c++) {
            if ((CELL(d, c)->quality & BQ_Q_VALID) && MODULE(d)->age_ms <= since_ms) {
                TEST_ASSERT_INT_WITHIN_MESSAGE(
                    1, truth(d, c, b.config.use_conv_pin ? round : taken[d]) * 1000 + 0.5, CELL(d, c)->mv,
                    bench_text("device %d cell %d round %d", d, c, round));
                fresh++;
            }
        }
    }
    return fresh;
}

static uint32_t elapsed_ms(uint64_t from_ns)
{
    return (uint32_t)((sim_pl_now(&b.pl) - from_ns) / SIM_PL_MS) + 1;
}

static void scan_and_judge(int devices, int round)
{
    uint64_t before;
    world(devices, round);
    before = sim_pl_now(&b.pl);
    bench_scan();
    expect_honest(devices, round, elapsed_ms(before));
}

static void must_recover(int devices)
{
    for (int i = 0; i < 12; i++) {
        world(devices, 0);
        bench_wait_ms(100);
        if (bench_scan() == BQ_OK && expect_honest(devices, 0, 50) == 6 * devices) {
            return;
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(BQ_OK, bench_start(), "neither a scan nor a start recovers");
    world(devices, 0);
    bench_scan();
    TEST_ASSERT_EQUAL_INT(6 * devices, expect_honest(devices, 0, 50));
}

/* proves: PL-CRC-07, PL-CRC-11, PL-SEQ-00-01, PL-SEQ-00-02, PL-SEQ-00-03, PL-SEQ-00-04, PL-SEQ-06-05,
 * PL-SEQ-06-08, PL-CRC-10 */
static void one_bit_in_a_thousand(void)
{
    for (unsigned seed = 1; seed <= 6; seed++) {
        bench_up(4, NULL);
        b.config.use_conv_pin = seed > 3;
        bench_init();
        sim_pl_bus_fault(&b.pl)->rng = seed * 77777u;
        sim_pl_bus_fault(&b.pl)->flip_probability = 1e-3;
        for (int i = 0; i < 10 && bench_start() != BQ_OK; i++) {
            TEST_ASSERT_TRUE_MESSAGE(i < 9, "no bring-up in ten tries");
        }
        for (int round = 0; round < 150; round++) {
            scan_and_judge(4, round);
            if (round % 10 == 3) {
                bench_balance(2, 0x21);
            }
        }
        sim_pl_bus_fault(&b.pl)->flip_probability = 0;
        must_recover(4);
        const bq_link_stats *s = b.afe.ops->stats(b.afe.ctx);
        TEST_ASSERT_TRUE(s->crc_errors > 0);
        TEST_ASSERT_TRUE(s->retries > 0);
        TEST_ASSERT_TRUE(s->scans > 100); /* single errors cost retries, not pictures */
    }
}

/* proves: PL-SEQ-02-05, PL-SEQ-02-06, PL-SEQ-00-02, PL-SEQ-00-05, PL-SEQ-03-09, PL-BCAST-05, PL-ADR-15 */
static void any_single_packet_of_the_bring_up_is_lost(void)
{
    uint32_t total;
    bench_up(3, NULL);
    bench_init();
    EXPECT_STATUS(BQ_OK, bench_start());
    total = b.transfers;
    for (int kind = 0; kind < 4; kind++) {
        for (uint32_t n = 1; n <= total; n++) {
            bench_up(3, NULL);
            sim_pl_bus_fault(&b.pl)->rng = n;
            bench_init();
            if (kind == 0) {
                b.lose = n;
            } else if (kind == 1) {
                b.refuse = n;
            } else {
                b.lose = n;
                b.refuse = n + 3; /* two faults close together */
            }
            if (kind == 3) {
                b.config.use_conv_pin = true;
                bench_init();
            }
            bq_status status = bench_start();
            TEST_ASSERT_EQUAL_INT_MESSAGE(BQ_OK, status, bench_text("packet %u lost (%d)", n, kind));
            world(3, 1);
            EXPECT_STATUS(BQ_OK, bench_scan());
            TEST_ASSERT_EQUAL_INT(18, expect_honest(3, 1, 100));
            for (int d = 1; d <= 3; d++) {
                static const uint8_t want[12] = {0x50, 0,    0x2c, 0x85, 0x15, 0x85,
                                                 0x55, 0x64, 0x11, 0x22, 0x33, 0x44};
                TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
                for (int r = 0; r < 12; r++) {
                    TEST_ASSERT_EQUAL_HEX8_MESSAGE(want[r], PEEK(d, (uint8_t)(0x40 + r)),
                                                   bench_text("lost %u", n));
                }
            }
            bench_judge_packets();
        }
    }
}

/* proves: PL-SEQ-06-08, PL-DRDY-04, PL-DRDY-06, PL-SEQ-07-02, PL-SEQ-00-03 */
static void any_single_packet_of_a_scan_is_lost(void)
{
    for (int pin = 0; pin <= 1; pin++) {
        bench_up(4, NULL);
        b.config.use_conv_pin = pin != 0;
        bench_ready_from();
        world(4, 0);
        bench_mark();
        EXPECT_STATUS(BQ_OK, bench_scan());
        note_conversions(4, 0);
        uint32_t total = b.transfers;
        for (int kind = 0; kind < 3; kind++) {
            for (uint32_t n = 1; n <= total + 2; n++) {
                int round = (int)(n % 5);
                uint64_t before = sim_pl_now(&b.pl);
                bench_mark();
                b.lose = kind == 0 ? n : 0;
                b.refuse = kind == 1 ? n : 0;
                b.fail_after = kind == 2 ? n : 0;
                world(4, round);
                bq_status status = bench_scan();
                b.lose = b.refuse = b.fail_after = 0;
                /* A lost broadcast start leaves no trace without the pin: the values may be the old ones, but
                 * then the driver must not have called them fresh. */
                int fresh = expect_honest(4, round, elapsed_ms(before));
                TEST_ASSERT_TRUE_MESSAGE(status != BQ_OK || fresh == 24, bench_text("packet %u", n));
                bench_no_misuse();
                bench_wait_ms(20);
            }
        }
    }
}

/* proves: PL-SEQ-13-01, PL-SEQ-13-03, PL-SEQ-13-08, PL-VB-06, PL-SEQ-06-05 */
static void a_device_loses_power_at_every_byte_of_a_scan(void)
{
    for (int device = 1; device <= 3; device++) {
        for (uint32_t at = 1; at <= 23 * 3 + 6; at++) {
            bench_ready(3, NULL);
            world(3, 2);
            bench_wait_ms(5);
            uint64_t before = sim_pl_now(&b.pl);
            sim_pl_bus_fault(&b.pl)->brownout_device = device;
            sim_pl_bus_fault(&b.pl)->brownout_bytes = at;
            bench_scan();
            expect_honest(3, 2, elapsed_ms(before));
            for (int i = 0; i < 3; i++) {
                before = sim_pl_now(&b.pl);
                bench_scan();
                expect_honest(3, 2, elapsed_ms(before));
                TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, CELL(device, 1)->quality & (BQ_Q_COMM | BQ_Q_VALID));
                TEST_ASSERT_EQUAL_HEX8(BQ_Q_COMM, CELL(3, 6)->quality & (BQ_Q_COMM | BQ_Q_VALID));
                TEST_ASSERT_EQUAL_HEX16(BQ_F_COMM, MODULE(device)->faults & BQ_F_COMM);
            }
            sim_pl_set_supply(&b.pl, device, true);
            bench_wait_ms(200);
            must_recover(3);
        }
    }
}

/* proves: PL-SEQ-13-02, PL-SEQ-13-03, PL-SEQ-13-06, PL-SEQ-13-08, PL-ADR-09, PL-ADR-10 */
static void the_stack_breaks_above_every_device(void)
{
    for (int k = 1; k <= 4; k++) {
        for (int world_link = 0; world_link <= 1; world_link++) {
            bench_ready(5, NULL);
            world(5, 3);
            if (world_link) {
                sim_pl_set_link(&b.pl, k, true);
            } else {
                sim_pl_bus_fault(&b.pl)->break_above = k;
            }
            for (int i = 0; i < 3; i++) {
                uint64_t before = sim_pl_now(&b.pl);
                bench_wait_ms(10);
                bench_scan();
                expect_honest(5, 3, elapsed_ms(before));
                bench_sample();
                for (int d = 1; d <= 5; d++) {
                    TEST_ASSERT_EQUAL_INT(d <= k, (CELL(d, 1)->quality & BQ_Q_VALID) != 0);
                    TEST_ASSERT_EQUAL_INT(d > k, (MODULE(d)->faults & BQ_F_COMM) != 0);
                }
            }
            sim_pl_set_link(&b.pl, k, false);
            sim_pl_bus_fault(&b.pl)->break_above = 0;
            must_recover(5);
        }
    }
}

/* proves: PL-CRC-12, PL-CRC-13, PL-SEQ-00-01, PL-AMB-12 */
static void a_bus_that_is_dead_from_the_beginning_or_dies(void)
{
    for (int dead = 1; dead <= 2; dead++) {
        for (int devices = 1; devices <= 62; devices += devices < 3 ? 1 : 20) {
            bench_up(devices, NULL);
            sim_pl_bus_fault(&b.pl)->dead = dead;
            bench_init();
            bq_status status = bench_start();
            TEST_ASSERT_TRUE_MESSAGE(status == BQ_E_NO_ANSWER || status == BQ_E_NOT_FOUND,
                                     bq_status_name(status));
            TEST_ASSERT_EQUAL_INT(0, b.afe.ops->modules_found(b.afe.ctx));
            TEST_ASSERT_EQUAL_INT(0, expect_honest(devices, 0, UINT32_MAX));
        }
        bench_ready(3, NULL);
        world(3, 1);
        EXPECT_STATUS(BQ_OK, bench_scan());
        sim_pl_bus_fault(&b.pl)->dead = dead;
        for (int i = 0; i < 5; i++) {
            uint64_t before = sim_pl_now(&b.pl);
            world(3, 2 + i);
            bench_scan();
            TEST_ASSERT_EQUAL_INT(0, expect_honest(3, 2 + i, elapsed_ms(before)));
            for (int c = 0; c < 18; c++) {
                TEST_ASSERT_EQUAL_HEX8(0, b.cells[c].quality & BQ_Q_VALID);
            }
        }
        sim_pl_bus_fault(&b.pl)->dead = 0;
        must_recover(3);
    }
}

/* proves: PL-ADR-14, PL-SEQ-02-06, PL-SEQ-02-08 */
static void more_and_fewer_devices_than_configured(void)
{
    for (int real = 1; real <= 5; real++) {
        bench_up(real, NULL);
        b.config.devices = 3;
        bench_init();
        bq_status status = bench_start();
        if (real == 3) {
            EXPECT_STATUS(BQ_OK, status);
        } else if (real > 3) {
            EXPECT_STATUS(BQ_E_EXTRA_DEVICE, status);
        } else {
            EXPECT_STATUS(BQ_E_NOT_FOUND, status);
            TEST_ASSERT_EQUAL_INT(real, b.afe.ops->modules_found(b.afe.ctx));
        }
    }
}

static uint32_t chaos_rng;

static uint32_t chance(uint32_t below)
{
    chaos_rng = chaos_rng * 1664525u + 1013904223u;
    return (chaos_rng >> 8) % below;
}

static void strike(int devices)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&b.pl);
    int d = 1 + (int)chance((uint32_t)devices);
    switch (chance(16)) {
    case 0:
        sim_pl_set_supply(&b.pl, d, false);
        break;
    case 1:
        sim_pl_set_supply(&b.pl, d, true);
        break;
    case 2:
        f->break_above = d;
        break;
    case 3:
        f->break_above = 0;
        break;
    case 4:
        f->flip_probability = 1e-3;
        break;
    case 5:
        f->flip_probability = 0;
        break;
    case 6:
        b.lose = b.transfers + 1 + chance(12);
        break;
    case 7:
        b.refuse = b.transfers + 1 + chance(12);
        break;
    case 8:
        b.fail_after = b.transfers + 1 + chance(12);
        break;
    case 9:
        bench_raw_write(d, 0x30, 0x3d);
        break; /* locks up at the next start */
    case 10:
        bench_raw_write(d, 0x3c, 0xa5);
        break;
    case 11:
        f->dead = (int)chance(3);
        break;
    case 12:
        sim_pl_set_tdie(&b.pl, d, chance(2) ? 150 : 25);
        break;
    case 13:
        f->short_packets = 1 + chance(2);
        break;
    case 14:
        sim_pl_damage_ram(&b.pl, d, (uint8_t)(0x42 + chance(10)), 0x04);
        break;
    default:
        bench_raw_write(d, 0x31, 0x04);
        break; /* falls asleep */
    }
}

static void heal(int devices)
{
    struct sim_bus_fault *f = sim_pl_bus_fault(&b.pl);
    f->break_above = f->dead = 0;
    f->flip_probability = 0;
    f->short_packets = 0;
    b.lose = b.refuse = b.fail_after = 0;
    for (int d = 1; d <= devices; d++) {
        sim_pl_set_supply(&b.pl, d, true);
        sim_pl_set_tdie(&b.pl, d, 25);
    }
    bench_wait_ms(2000);
}

/* proves: PL-SEQ-13-06, PL-SEQ-13-07, PL-SEQ-05-03, PL-SEQ-06-05, PL-SEQ-10-07 */
static void many_faults_at_once(void)
{
    for (uint32_t seed = 1; seed <= 60; seed++) {
        chaos_rng = seed * 99991u;
        bench_up(4, NULL);
        b.config.use_conv_pin = seed % 3 == 0;
        sim_pl_bus_fault(&b.pl)->rng = seed;
        bench_ready_from();
        note_conversions(4, 0);
        for (int round = 1; round <= 60; round++) {
            uint64_t before;
            world(4, round);
            if (chance(3) == 0) {
                strike(4);
            }
            bench_wait_ms(chance(4) == 0 ? 300 : 20);
            before = sim_pl_now(&b.pl);
            bq_status status = bench_scan();
            expect_honest(4, round, elapsed_ms(before));
            if (status == BQ_OK && chance(4) == 0) {
                bench_balance(1 + (int)chance(4), 1u << chance(6));
            } else if (status == BQ_E_STATE) {
                bench_start();
            }
        }
        heal(4);
        must_recover(4);
        for (int d = 1; d <= 4; d++) {
            static const uint8_t want[12] = {0x50, 0,    0x2c, 0x85, 0x15, 0x85,
                                             0x55, 0x64, 0x11, 0x22, 0x33, 0x44};
            for (int i = 0; i < 10; i++) { /* the scrub passes every device */
                bench_wait_ms(600);
                bench_scan();
            }
            for (int r = 0; r < 12; r++) {
                TEST_ASSERT_EQUAL_HEX8_MESSAGE(want[r], PEEK(d, (uint8_t)(0x40 + r)),
                                               bench_text("seed %u", seed));
            }
            TEST_ASSERT_EQUAL_HEX8(0x7d, PEEK(d, 0x30));
            TEST_ASSERT_EQUAL_HEX8(0x80 | d, PEEK(d, 0x3b));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(one_bit_in_a_thousand);
    RUN_TEST(any_single_packet_of_the_bring_up_is_lost);
    RUN_TEST(any_single_packet_of_a_scan_is_lost);
    RUN_TEST(a_device_loses_power_at_every_byte_of_a_scan);
    RUN_TEST(the_stack_breaks_above_every_device);
    RUN_TEST(a_bus_that_is_dead_from_the_beginning_or_dies);
    RUN_TEST(more_and_fewer_devices_than_configured);
    RUN_TEST(many_faults_at_once);
    return UNITY_END();
}
