/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_world.h
 * What hangs on the pins of an emulated microcontroller: a table of callbacks that the user of the emulator
 * fills in. Any callback may be NULL; emu_create() then puts an idle one in its place (stated at each), so a
 * model never checks for NULL.
 *
 * Time: before any other callback the core calls advance() with the present time, so a world is always at the
 * time of the call. A world may push bytes and frames into the microcontroller with emu_uart_in() and
 * emu_can_in() from inside advance(); it may not call emu_run_until() or emu_reset().
 */
#ifndef EMU_WORLD_H
#define EMU_WORLD_H

#include <stdbool.h>
#include <stdint.h>

#define EMU_NEVER UINT64_MAX

/** How the microcontroller drives a pin. */
typedef enum emu_drive {
    EMU_DRIVE_NONE, /**< input, analog, or an open-drain output at 1 */
    EMU_DRIVE_LOW,
    EMU_DRIVE_HIGH
} emu_drive;

/** Answer of a bus to one byte of an I2C master. */
typedef enum emu_i2c_answer {
    EMU_I2C_NACK,
    EMU_I2C_ACK,
    EMU_I2C_LOST, /**< another master won the arbitration: this one lets go of the bus at once */
    EMU_I2C_ERROR /**< a START or STOP stood at a forbidden place */
} emu_i2c_answer;

/** Bits of i2c_lines(): who holds a line low apart from the microcontroller. */
#define EMU_I2C_SCL_LOW 1u
#define EMU_I2C_SDA_LOW 2u

typedef struct emu_spi_frame {
    uint16_t value; /**< what the master sends, right-aligned */
    uint8_t bits;   /**< 4..16 */
    uint8_t mode;   /**< CPOL * 2 + CPHA */
    bool lsb_first;
    uint32_t hz; /**< of SCK */
} emu_spi_frame;

typedef struct emu_can_frame {
    uint32_t id; /**< 11 or 29 bits */
    bool extended, remote;
    uint8_t length; /**< 0..8 */
    uint8_t data[8];
} emu_can_frame;

/** What becomes of a frame that the controller puts on the CAN bus. */
typedef enum emu_can_result {
    EMU_CAN_ACKED,
    EMU_CAN_NO_ACK,     /**< nobody else on the bus */
    EMU_CAN_LOST,       /**< arbitration lost: a stronger frame is on the wire */
    EMU_CAN_BIT_ERROR,  /**< a bit came back other than sent (a bus that is held dominant or recessive) */
    EMU_CAN_FORM_ERROR, /**< somebody broke the frame with an error flag */
} emu_can_result;

/** State of the CAN wires as the controller's receiver sees them while nobody sends. */
typedef enum emu_can_wire {
    EMU_CAN_RECESSIVE, /**< idle: eleven recessive bits will be seen */
    EMU_CAN_DOMINANT   /**< held dominant: never idle, initialisation cannot be left */
} emu_can_wire;

typedef struct emu_world {
    void *ctx; /**< first argument of every callback */
    /** Moves the world to now_ns (absolute, never backwards). Idle: nothing. */
    void (*advance)(void *ctx, uint64_t now_ns);
    /** Absolute time of the next change that the microcontroller may notice by itself (a pin that toggles, a
     * byte that arrives); EMU_NEVER = none. Idle: EMU_NEVER. */
    uint64_t (*next)(void *ctx);
    /** Level that the outside puts on a pin: 0, 1, or -1 = nothing drives it (then the pull resistor decides,
     * and without one the level reads 0). Port 0 = A. Where both drive, the lower level wins. Idle: -1. */
    int (*pin_in)(void *ctx, unsigned port, unsigned pin);
    /** The microcontroller changed how it drives a pin by its GPIO. Called for changes only. */
    void (*pin_out)(void *ctx, unsigned port, unsigned pin, emu_drive drive);
    /** Bus = number of the peripheral (1 = I2C1). START or repeated START and the address byte (address * 2 +
     * read). Idle: NACK. */
    emu_i2c_answer (*i2c_start)(void *ctx, unsigned bus, uint8_t address_byte);
    emu_i2c_answer (*i2c_write)(void *ctx, unsigned bus, uint8_t byte); /**< Idle: NACK. */
    uint8_t (*i2c_read)(void *ctx, unsigned bus, bool ack);             /**< Idle: 0xff. */
    void (*i2c_stop)(void *ctx, unsigned bus);
    unsigned (*i2c_lines)(void *ctx, unsigned bus); /**< EMU_I2C_*_LOW; asked at any time. Idle: 0. */
    uint64_t (*i2c_stretch_ns)(void *ctx,
                               unsigned bus); /**< clock held low after the byte just done. Idle: 0. */
    /** One frame on SPI bus n; returns what the master receives. Chip select is a pin. Idle: all ones. */
    uint16_t (*spi_frame)(void *ctx, unsigned bus, const emu_spi_frame *frame);
    /** A whole frame was put on the wire; called at the time of its end. Idle: EMU_CAN_NO_ACK. */
    emu_can_result (*can_out)(void *ctx, unsigned bus, const emu_can_frame *frame);
    emu_can_wire (*can_wire)(void *ctx, unsigned bus); /**< Idle: recessive. */
    /** A byte left the transmitter of USART n; called at the end of its stop bit. Idle: dropped. */
    void (*uart_out)(void *ctx, unsigned uart, uint8_t byte);
    /** Volts at the input of an ADC channel. Idle: 0. */
    double (*adc_volts)(void *ctx, unsigned adc, unsigned channel);
} emu_world;

#endif
