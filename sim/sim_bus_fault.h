/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_bus_fault.h
 * The one point at which injected faults touch a bus. Each kind acts on its own or falls through to the chip
 * model; several may be armed together. All zero = no fault.
 */
#ifndef SIM_BUS_FAULT_H
#define SIM_BUS_FAULT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct sim_bus_fault {
    double flip_probability; /**< each bit, in both directions, flips with this probability */
    uint64_t rng;            /**< state of the generator; seed it for repeatable runs */
    int flip_mosi_bit; /**< 1 + bit of the next packet to flip on its way to the devices; 0 = none; clears
                          itself */
    int flip_miso_bit; /**< 1 + bit of the next packet to flip on its way back; 0 = none; clears itself */
    int dead;          /**< 0 = bus alive, 1 = host reads 00 and devices see nothing, 2 = the same with ff */
    int break_above;   /**< nothing crosses above device k in either direction; 0 = whole */
    uint32_t drop_packets;      /**< this many packets never reach a device (CS did not assert) */
    uint32_t short_packets;     /**< this many packets lose their last byte on the way to the devices */
    int late_bits;              /**< the answer arrives this many clocks late (shifted) */
    int stuck_mosi, stuck_miso; /**< 0 = free, 1 = stuck low, 2 = stuck high */
    int wrong_device;           /**< the answer comes from this device whatever the address says; 0 = off */
    int brownout_device;        /**< this device loses its supply ... */
    uint32_t brownout_bytes; /**< ... after this many more bytes on the bus (0 = not armed); it stays off */
    uint64_t flips, packets, bytes; /**< counted */
    uint64_t skip;                  /**< bits until the next random flip; the model's own */
    double skip_for;                /**< flip_probability for which skip was drawn; the model's own */
    /** A test's own hook, called before the built-in kinds. Returns true when it answered itself (the model
     * is not asked and rx stays as the hook left it), false to fall through. tx may be altered. */
    bool (*hook)(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n);
    void *hook_ctx;
} sim_bus_fault;

#endif
