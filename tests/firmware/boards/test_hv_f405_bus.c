/* SPDX-License-Identifier: Apache-2.0 */
/* The image of hv-f405 with trouble on its wires: CAN, the stack's bus, interrupt storms. The contactor's pin
 * is watched all the time. */
#include "hv_world.h"
#include "unity.h"
#include <stdio.h>
#include <string.h>

enum { STANDBY = 2, ON = 3, FAULT = 4 };
enum { PORT_A, PORT_B, PORT_C };
enum { COUNTERS = 8, EVENT = 5 };
#define PERIOD_NS (100 * MS)
#define COMM_TIMEOUT_MS 2000u
#define CAN_ESR 0x40006418u
#define ESR_BOFF 4u
#define ESR_EPVF 2u
#define DMA2 0x40026400u
#define DMA_S0CR (DMA2 + 0x10u)
#define DMA_S0M0AR (DMA2 + 0x1cu)

void setUp(void)
{
    TEST_ASSERT_TRUE(hv_start(IMAGE));
}

void tearDown(void)
{
    hv_end();
}

static uint32_t esr(void)
{
    uint32_t v = 0;
    TEST_ASSERT_TRUE(emu_bus_read(hv.e, CAN_ESR, 4, &v));
    return v;
}

static void undisturbed(void)
{
    TEST_ASSERT_TRUE(hv.contactor);
    TEST_ASSERT_EQUAL_UINT(1, hv.closed);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    TEST_ASSERT_EQUAL_UINT(0, hv_resets(EMU_CAUSE_IWDG) + hv_resets(EMU_CAUSE_SOFTWARE));
}

/* Heartbeats, one a period, have come for so long without a pause beyond what the loop promises. */
static void kept_period(unsigned ms)
{
    unsigned before = hv.count[0];
    hv_watch_period();
    hv_run(ms);
    TEST_ASSERT_INT_WITHIN(1, (int)(ms * MS / PERIOD_NS), (int)(hv.count[0] - before));
    TEST_ASSERT_TRUE(hv.longest_ns <= PERIOD_NS + PERIOD_NS / 4);
}

/* ---- CAN ---------------------------------------------------------------------------------------------- */

static void until_bus_off(void)
{
    for (unsigned i = 0; i < 300 && (esr() & ESR_BOFF) == 0u; i++) {
        hv_run(1);
    }
    TEST_ASSERT_TRUE((esr() & ESR_BOFF) != 0u);
}

static void test_bus_off_and_back(void)
{
    unsigned beats, pictures;
    hv_up();
    hv.result = EMU_CAN_BIT_ERROR;
    hv_run(60);
    until_bus_off();
    hv_run(500);
    undisturbed();
    until_bus_off(); /* from there it comes back without errors; between two it would be passive for a while
                      */
    hv.result = EMU_CAN_ACKED;
    hv_run(60); /* 128 times 11 bits are 2.8 ms */
    TEST_ASSERT_EQUAL_HEX32(0, esr() & (ESR_BOFF | ESR_EPVF));
    beats = hv.count[0];
    pictures = hv.count[6];
    kept_period(500);
    TEST_ASSERT_TRUE(hv.count[0] - beats >= 4u);
    TEST_ASSERT_TRUE(hv.count[6] - pictures >= 4u * 32u); /* 96 cells, three a frame */
    undisturbed();
    hv_clean();
}

/* The controller repeats the same frame for ever and becomes error passive, not bus-off. */
static void test_nobody_acknowledges(void)
{
    hv_up();
    hv.result = EMU_CAN_NO_ACK;
    hv_run(700);
    TEST_ASSERT_EQUAL_HEX32(ESR_EPVF, esr() & (ESR_BOFF | ESR_EPVF));
    undisturbed();
    hv_type("status\r");
    TEST_ASSERT_TRUE_MESSAGE(strstr(hv.said, "passive") != NULL, hv.said);
    hv.result = EMU_CAN_ACKED;
    hv_run(60);
    kept_period(500);
    undisturbed();
    hv_clean();
}

/* A bus held dominant at power-on: the controller cannot join, the pack does not care. */
static void test_bus_dead_at_start(void)
{
    hv.dead_wire = true;
    hv_up();
    TEST_ASSERT_EQUAL_UINT(0, hv.frames);
    hv_type("status\r");
    TEST_ASSERT_TRUE_MESSAGE(strstr(hv.said, "bus-off") != NULL, hv.said);
    hv.dead_wire = false;
    hv_run(60);
    kept_period(300);
    TEST_ASSERT_EQUAL_INT(ON, hv.last[0].data[0]);
    hv_clean();
}

static uint32_t exceptions_in(unsigned ms)
{
    uint32_t before = emu_get_meter(hv.e)->exceptions;
    hv_run(ms);
    return emu_get_meter(hv.e)->exceptions - before;
}

/* A full bus of frames for others: no interrupt comes of them. */
static void test_foreign_frames(void)
{
    static const emu_can_frame foreign[] = {{.id = 0x090, .length = 8},
                                            {.id = 0x07f, .length = 8},
                                            {.id = 0x085, .extended = true, .length = 8},
                                            {.id = 0x085, .remote = true}};
    uint32_t quiet;
    hv_up();
    quiet = exceptions_in(100);
    noise_begin(&hv.noise.can, hv.e, 250000);
    for (unsigned i = 0; i < 4u; i++) {
        hv.noise.frame = foreign[i];
        TEST_ASSERT_TRUE(exceptions_in(100) < quiet + quiet / 10u);
    }
    TEST_ASSERT_TRUE(hv.noise.taken > 1500u);
    undisturbed();
    hv_clean();
}

/* Frames that the filter lets through, as many as the bus holds, also broken ones: nothing reads them, the
 * ring is full after eight, and nothing else suffers. */
static void test_flood_of_accepted_frames(void)
{
    hv_up();
    hv.noise.frame = (emu_can_frame){.id = 0x085, .length = 8};
    noise_begin(&hv.noise.can, hv.e, 100000);
    kept_period(500);
    TEST_ASSERT_TRUE(hv.noise.taken > 2500u);
    undisturbed();
    hv_clean();
}

/* ---- interrupt storms --------------------------------------------------------------------------------- */

/* A line that toggles for ever, one edge in 5 us: every pass of the loop is interrupted dozens of times. */
static void storm(unsigned pin)
{
    uint32_t before;
    hv_up();
    before = emu_get_meter(hv.e)->exceptions;
    hv.noise.port = PORT_B;
    hv.noise.pin = pin;
    noise_begin(&hv.noise.line, hv.e, 5000);
    kept_period(300);
    TEST_ASSERT_TRUE(emu_get_meter(hv.e)->exceptions - before > 20000u);
    TEST_ASSERT_EQUAL_UINT(0, hv_resets(EMU_CAUSE_IWDG) + hv_resets(EMU_CAUSE_SOFTWARE));
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    noise_end(&hv.noise);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(hv.e)->count);
}

static void test_storm_on_fault(void)
{
    storm(4);
}

static void test_storm_on_alert(void)
{
    storm(5);
}

static void test_storm_on_drdy(void)
{
    storm(1);
}

static void test_console_under_fire(void)
{
    hv_up();
    hv.noise.byte = 0x55;
    noise_begin(&hv.noise.uart, hv.e, 86805); /* back to back at 115200 */
    kept_period(500);
    TEST_ASSERT_TRUE(hv.noise.uart.given > 5000u);
    undisturbed();
    noise_end(&hv.noise);
    hv_type("\x15version\r"); /* Ctrl-U clears what the line held */
    hv_run(200);
    TEST_ASSERT_TRUE_MESSAGE(strstr(hv.said, "hv-f405") != NULL, hv.said);
    hv_clean();
}

/* ---- the stack's bus ---------------------------------------------------------------------------------- */

/* Bytes in mode 1, highest bit first, without pauses: all else is in the book of the strict stack. */
/* proves: PL-SPI-01, PL-SPI-02, PL-AMB-20 */
static void test_frames_on_the_wire(void)
{
    uint64_t bytes;
    hv_up();
    bytes = sim_pl_bus_fault(&hv.stack)->bytes;
    hv_run(500);
    TEST_ASSERT_TRUE(sim_pl_bus_fault(&hv.stack)->bytes - bytes > 5u * 300u); /* 16 devices, 5 scans */
    TEST_ASSERT_EQUAL_UINT(0, hv.misframed);
    hv_clean();
}

/* MISO stuck: outputs off after the time-out of communication and 1.25 periods. */
static void stuck(int level)
{
    uint64_t struck;
    hv_up();
    struck = emu_now(hv.e);
    hv.miso = level;
    hv_run(COMM_TIMEOUT_MS + 250);
    TEST_ASSERT_FALSE(hv.contactor);
    TEST_ASSERT_TRUE(hv.opened_ns - struck <= (COMM_TIMEOUT_MS + 125u) * MS);
    TEST_ASSERT_EQUAL_INT(FAULT, hv_state());
    hv.forbidden = true;
    hv_run(1000);
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
    TEST_ASSERT_EQUAL_UINT(0, emu_get_misuse(hv.e)->count);
}

static void test_miso_stuck_low(void)
{
    stuck(0);
}

/* With the wire whole again the pack recovers. */
static void test_miso_stuck_high(void)
{
    stuck(0xff);
    hv.request = false;
    hv.miso = -1;
    hv_run(7500); /* recover_ms is 5 s */
    TEST_ASSERT_EQUAL_INT(STANDBY, hv_state());
    TEST_ASSERT_EQUAL_UINT(0, hv.unsafe);
}

static uint32_t reg(uint32_t address)
{
    uint32_t v = 0;
    TEST_ASSERT_TRUE(emu_bus_read(hv.e, address, 4, &v));
    return v;
}

static long counter(const char *name)
{
    const char *at;
    long n = -1;
    hv_type("counters\r");
    at = strstr(hv.said, name);
    if (at != NULL) {
        (void)sscanf(at + strlen(name), "%ld", &n);
    }
    return n;
}

static void stop_in_a_packet(void)
{
    hv.stop_in_packet = true;
    TEST_ASSERT_EQUAL_INT(EMU_STOP_BREAK, emu_run_until(hv.e, emu_now(hv.e) + 300 * MS));
    hv.stop_in_packet = false;
    TEST_ASSERT_TRUE((reg(DMA_S0CR) & 1u) != 0u);
}

static void one_transfer_failed(long before)
{
    hv_run(300);
    TEST_ASSERT_EQUAL_INT(before + 1, counter("bus errors "));
    undisturbed();
    TEST_ASSERT_EQUAL_INT(ON, hv_state());
}

/* The receiving stream stops in the middle: bytes arrive that nobody fetches. */
static void test_spi_overrun(void)
{
    long before;
    hv_up();
    before = counter("bus errors ");
    stop_in_a_packet();
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, DMA_S0CR, 4, reg(DMA_S0CR) & ~1u));
    one_transfer_failed(before);
}

/* The receiving stream is pointed to where no memory is: transfer error. */
static void test_dma_error(void)
{
    long before;
    uint32_t cr;
    hv_up();
    before = counter("bus errors ");
    stop_in_a_packet();
    cr = reg(DMA_S0CR);
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, DMA_S0CR, 4, cr & ~1u));
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, DMA2 + 0x08u, 4, 0x3du)); /* the flags of the stop */
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, DMA_S0M0AR, 4, 0x60000000u));
    TEST_ASSERT_TRUE(emu_bus_write(hv.e, DMA_S0CR, 4, cr));
    one_transfer_failed(before);
}

int main(void)
{
    if (!hv_start(IMAGE)) {
        puts("SKIPPED: no image (no cross compiler) or no emulated processor (libunicorn-dev)");
        return 77;
    }
    hv_end();
    UNITY_BEGIN();
    RUN_TEST(test_bus_off_and_back);
    RUN_TEST(test_nobody_acknowledges);
    RUN_TEST(test_bus_dead_at_start);
    RUN_TEST(test_foreign_frames);
    RUN_TEST(test_flood_of_accepted_frames);
    RUN_TEST(test_storm_on_fault);
    RUN_TEST(test_storm_on_alert);
    RUN_TEST(test_storm_on_drdy);
    RUN_TEST(test_console_under_fire);
    RUN_TEST(test_frames_on_the_wire);
    RUN_TEST(test_miso_stuck_low);
    RUN_TEST(test_miso_stuck_high);
    RUN_TEST(test_spi_overrun);
    RUN_TEST(test_dma_error);
    return UNITY_END();
}
