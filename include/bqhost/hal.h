/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file hal.h
 * The boundary between the library and a board. A back-end fills these small tables of functions;
 * the library calls nothing else. Copy hal/template to start a new port.
 *
 * General contract
 * - The library calls a back-end from one context only, never from an interrupt. A back-end MAY use
 *   interrupts or DMA inside; they only record.
 * - `ctx` is the back-end's own pointer; the library hands it back and never looks inside.
 * - No function may block longer than its bound stated here. No function may be called re-entrantly.
 * - A back-end returns BQ_OK, BQ_PENDING (poll only) or a negative status; it MUST NOT return another
 *   positive value.
 */
#ifndef BQHOST_HAL_H
#define BQHOST_HAL_H

#include "bqhost/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- time ---------------------------------------------------------------------------------- */

/**
 * A free-running microsecond counter, 32 bits, wrapping from 0xffffffff to 0. It MUST be monotonic
 * otherwise, MUST have a resolution of 10 us or better and MUST run while the CPU sleeps. The library only
 * ever subtracts two readings and needs them less than 2^31 us apart.
 */
typedef struct bq_clock {
    uint32_t (*now_us)(void *ctx);
    void *ctx;
} bq_clock;

/* ---- SPI ----------------------------------------------------------------------------------- */

/**
 * One SPI master with one chip select (mode 1, MSB first, PL-SPI-01, PL-SPI-02).
 *
 * start: one call is one packet. The back-end MUST assert CS, transfer exactly `len` bytes full duplex
 * without pauses above 100 us (PL-AMB-20), release CS and keep it high for at least 3 us before the next
 * packet (PL-SPI-04); SCLK and SDI MUST be low outside packets (PL-SPI-11). `tx` and `rx` are never NULL, do
 * not overlap and stay valid and untouched until the transfer has ended. `len` is 1..256; a back-end MUST
 * return BQ_E_ARG for any other. It MAY complete inside start (a polled back-end); then the next poll returns
 * BQ_OK. Returns BQ_OK (started), BQ_E_BUSY (a transfer is running; nothing was started), BQ_E_ARG, BQ_E_BUS.
 *
 * poll: BQ_PENDING while the transfer runs, BQ_OK once after it ended well, or BQ_E_BUS / BQ_E_TIMEOUT. After
 * a negative answer CS MUST be high and the back-end ready for the next start; the content of `rx` is then
 * undefined. A back-end MUST bound its own transfer: no later than twice the nominal transfer time plus 1 ms.
 *
 * set_clock: optional (NULL = fixed clock). Sets SCLK to at most `hz`; BQ_E_RANGE if it cannot go that low.
 *   Only called between transfers.
 */
typedef struct bq_spi_ops {
    bq_status (*start)(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len);
    bq_status (*poll)(void *ctx);
    bq_status (*set_clock)(void *ctx, uint32_t hz);
} bq_spi_ops;

typedef struct bq_spi {
    const bq_spi_ops *ops;
    void *ctx;
} bq_spi;

/* ---- I2C ----------------------------------------------------------------------------------- */

/** One piece of an I2C transaction, in wire order. */
typedef struct bq_i2c_segment {
    uint8_t *data;   /**< bytes to send or room for bytes to receive; not NULL when len > 0 */
    uint16_t len;    /**< 0 is legal for a write (address only), not for a read */
    bool read;       /**< direction of this segment */
    bool stop_after; /**< STOP after this segment; otherwise the next one begins with a repeated START.
                          The last segment always ends with STOP, whatever stands here. */
} bq_i2c_segment;

/**
 * One I2C master (standard mode).
 *
 * start: one call is one transaction to `address7`: each segment begins with START and the address byte.
 * `segments` and their data stay valid until it has ended. Returns BQ_OK, BQ_E_BUSY, BQ_E_ARG or
 * BQ_E_ARBITRATION (bus not free).
 *
 * poll: BQ_PENDING, BQ_OK, BQ_E_NACK, BQ_E_ARBITRATION, BQ_E_TIMEOUT or
 * BQ_E_BUS. After any error the back-end MUST have sent STOP where it could and be ready for the next start.
 * Clock stretching MUST be tolerated up to 10 ms.
 *
 * recover: frees a slave that holds SDA: up to nine clocks,
 * then STOP. Blocks for at most 200 us (ten clocks of 100 kHz take 100 us; a slave that stretches them is
 * given up). BQ_OK if SDA and SCL are high afterwards, else BQ_E_ARBITRATION.
 */
typedef struct bq_i2c_ops {
    bq_status (*start)(void *ctx, uint8_t address7, const bq_i2c_segment *segments, size_t count);
    bq_status (*poll)(void *ctx);
    bq_status (*recover)(void *ctx);
} bq_i2c_ops;

typedef struct bq_i2c {
    const bq_i2c_ops *ops;
    void *ctx;
} bq_i2c;

/* ---- lines --------------------------------------------------------------------------------- */

/** Every digital line the library may use. `true` is the electrical high level at the MCU's view of the chip
 * pin. */
typedef enum bq_line {
    BQ_LINE_CONV,         /**< out: CONV_H of a bq76PL536 stack; low when unused */
    BQ_LINE_DRDY,         /**< in: DRDY_H */
    BQ_LINE_FAULT,        /**< in: FAULT_H */
    BQ_LINE_ALERT,        /**< in: ALERT_H of a stack, or ALERT of a bq769x0 */
    BQ_LINE_VPP,          /**< out: 7 V on LDOD1/LDOD2 for EPROM programming */
    BQ_LINE_AFE_POWER,    /**< out: supply of the monitors, where the board can cycle it */
    BQ_LINE_AFE_BOOT,     /**< out: boot signal to TS1 of a bq769x0 */
    BQ_LINE_CONTACTOR,    /**< out: main contactor or the enable of both FETs; false = open */
    BQ_LINE_PRECHARGE,    /**< out: precharge path; false = open */
    BQ_LINE_CONTACTOR_FB, /**< in: feedback contact, true = closed */
    BQ_LINE_REQUEST,      /**< in: the user or the vehicle wants the outputs on */
    BQ_LINE_COUNT
} bq_line;

/**
 * read: sets `*level`. write: drives the line.
 * Both return at once.
 * Both return BQ_E_UNSUPPORTED for a line this board does not have; the library then uses its documented
 * substitute (computed waiting time, polling), and BQ_E_ARG for a line outside the list.
 */
typedef struct bq_gpio_ops {
    bq_status (*read)(void *ctx, bq_line line, bool *level);
    bq_status (*write)(void *ctx, bq_line line, bool level);
} bq_gpio_ops;

typedef struct bq_gpio {
    const bq_gpio_ops *ops;
    void *ctx;
} bq_gpio;

/* ---- pack current -------------------------------------------------------------------------- */

/**
 * The board's own current measurement, where the monitor has none. `*current_ma` is positive while charging.
 * Returns BQ_OK, BQ_E_STALE (no new conversion since the last call; `*current_ma` unchanged) or BQ_E_BUS.
 * Returns at once.
 */
typedef struct bq_ammeter {
    bq_status (*read)(void *ctx, int32_t *current_ma);
    void *ctx;
} bq_ammeter;

/* ---- CAN ----------------------------------------------------------------------------------- */

typedef struct bq_can_frame {
    uint32_t id; /**< 0..0x7ff, or 0..0x1fffffff with `extended` */
    bool extended;
    uint8_t len; /**< 0..8 */
    uint8_t data[8];
} bq_can_frame;

typedef enum bq_can_state {
    BQ_CAN_ACTIVE,  /**< takes part in the bus */
    BQ_CAN_PASSIVE, /**< error passive: still takes part */
    BQ_CAN_OFF      /**< bus-off, recovery under way: nothing is sent or received */
} bq_can_state;

/**
 * One CAN controller (2.0A/B, data frames).
 *
 * send: queues one frame in hardware. BQ_OK; BQ_E_BUSY (no room: try later, nothing was queued); BQ_E_BUS
 * (bus-off); BQ_E_ARG (id or len out of range). Frames of one id leave in the order of their queueing.
 *
 * receive: takes the oldest received frame. BQ_OK; BQ_PENDING (none).
 *
 * state: of the controller. A back-end MUST recover from bus-off by itself, no faster than the 128 times 11
 *   recessive bits of ISO 11898-1, and MUST drop frames that were queued when it went off.
 *
 * All return at once.
 */
typedef struct bq_can_ops {
    bq_status (*send)(void *ctx, const bq_can_frame *frame);
    bq_status (*receive)(void *ctx, bq_can_frame *frame);
    bq_can_state (*state)(void *ctx);
} bq_can_ops;

typedef struct bq_can {
    const bq_can_ops *ops; /**< NULL = the board has none */
    void *ctx;
} bq_can;

/* ---- a stream of bytes, for the console ------------------------------------------------------ */

/**
 * write: takes as many bytes as there is room for and returns their number.
 *
 * read: returns what has arrived,
 * at most `len` bytes. Both return at once; 0 = nothing now. Bytes that arrive while there is no room are
 * dropped and counted by the back-end.
 */
typedef struct bq_stream_ops {
    size_t (*write)(void *ctx, const uint8_t *data, size_t len);
    size_t (*read)(void *ctx, uint8_t *data, size_t len);
} bq_stream_ops;

typedef struct bq_stream {
    const bq_stream_ops *ops; /**< NULL = the board has none */
    void *ctx;
} bq_stream;

/* ---- non-volatile memory --------------------------------------------------------------------- */

/**
 * Two or more sectors of flash that belong to nobody else. Erased bytes read 0xff.
 *
 * read: copies `len` bytes from `offset` of a sector. BQ_OK, BQ_E_ARG.
 *
 * program: writes `len` bytes, `offset` and `len` multiples of `unit_bytes`, into erased units. Blocks at
 * most 100 us a unit; the library asks for one unit at a time. BQ_OK; BQ_E_ARG; BQ_E_VERIFY (does not read
 * back); BQ_E_BUS (the hardware reported an error).
 *
 * erase: erases one sector. MAY block up to 2 s on hardware
 * that stalls the CPU meanwhile; MUST keep the watchdog fed or outputs safe in that time. BQ_OK, BQ_E_ARG,
 * BQ_E_BUS, BQ_E_VERIFY.
 *
 * A loss of power at any moment may leave the unit or sector under way in any state,
 * and MUST leave all others as they were.
 */
typedef struct bq_nvm_ops {
    bq_status (*read)(void *ctx, uint8_t sector, uint32_t offset, void *data, size_t len);
    bq_status (*program)(void *ctx, uint8_t sector, uint32_t offset, const void *data, size_t len);
    bq_status (*erase)(void *ctx, uint8_t sector);
} bq_nvm_ops;

typedef struct bq_nvm {
    const bq_nvm_ops *ops; /**< NULL = the board has none */
    void *ctx;
    uint8_t sectors;       /**< 2 or more */
    uint8_t unit_bytes;    /**< smallest programmable unit: 2, 4 or 8 */
    uint32_t sector_bytes; /**< usable size of each sector */
} bq_nvm;

/* ---- start and end of a life ----------------------------------------------------------------- */

typedef enum bq_reset_cause {
    BQ_RESET_UNKNOWN,
    BQ_RESET_POWER, /**< power-on */
    BQ_RESET_BROWN_OUT,
    BQ_RESET_PIN,
    BQ_RESET_SOFTWARE, /**< asked for by the firmware itself */
    BQ_RESET_WATCHDOG,
    BQ_RESET_CRASH /**< a fault handler wrote a crash record and reset */
} bq_reset_cause;

/** What a fault handler leaves behind in memory that survives a reset. */
typedef struct bq_crash {
    uint32_t kind; /**< number of the exception (3 = HardFault ...), 0x100 = stack guard, 0x101 = assertion */
    uint32_t pc, lr, sp, uptime_ms;
    uint32_t psr, cfsr, hfsr, address; /**< the last three: fault status where the core has it, else 0 */
} bq_crash;

/** What the start-up code found out; constant afterwards. */
typedef struct bq_boot {
    bq_reset_cause cause;
    bool crashed; /**< `crash` is of the life before */
    bq_crash crash;
    bool crystal_failed; /**< runs from the internal oscillator: same speed, less accurate time */
    bool image_ok;       /**< the checksum of the image holds; false = outputs stay off for ever */
    uint32_t image_crc;  /**< as stored in the image */
} bq_boot;

/**
 * The microcontroller itself. All return at once but `reset`, which does not return.
 *
 * feed: restarts the watchdog. Called only after a healthy cycle.
 *
 * reset: outputs safe, then a software reset.
 *
 * stack_free: bytes of the stack that were never used, by its paint; UINT32_MAX when unknown.
 */
typedef struct bq_mcu_ops {
    void (*feed)(void *ctx);
    void (*reset)(void *ctx);
    uint32_t (*stack_free)(void *ctx);
} bq_mcu_ops;

typedef struct bq_mcu {
    const bq_mcu_ops *ops; /**< NULL = a PC */
    void *ctx;
    const bq_boot *boot; /**< NULL = nothing known */
} bq_mcu;

#ifdef __cplusplus
}
#endif
#endif
