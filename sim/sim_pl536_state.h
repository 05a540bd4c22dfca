/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_pl536_state.h
 * The state of a simulated bq76PL536 stack, complete so that a caller can own it. Its members are private to
 * the model: use the functions of sim_pl536.h.
 */
#ifndef SIM_PL536_STATE_H
#define SIM_PL536_STATE_H

#include "sim_bus_fault.h"

#define SIM_PL_REGS 0x50 /**< 0x00..0x4f; everything above reads 0 */
#define SIM_PL_GROUP3 12 /**< 0x40..0x4b */
#define SIM_PL_NEVER UINT64_MAX
#define SIM_PL_PACKET_MAX 1024u /**< bytes of a packet on which injected faults act */

/** What keeps the registers' clock running, from worst to best. */
typedef enum sim_pl_power { SIM_PL_POWER_OFF, SIM_PL_POWER_RESET, SIM_PL_POWER_ON } sim_pl_power;

/** One protection function with its comparators: COV, CUV (six inputs) or OT (two). */
typedef struct sim_pl_guard {
    uint64_t due[6];   /**< when the delay of an input ends; SIM_PL_NEVER = not running */
    double trip, hold; /**< COV, CUV: levels beyond which it trips and up to which it stays tripped */
    uint64_t delay_ns; /**< 0 = no delay and no latch */
    uint8_t enabled;   /**< inputs that are watched */
    uint8_t active;    /**< comparators that are tripped */
    uint8_t latched;   /**< inputs that are reported: COV_FAULT, CUV_FAULT, ALERT_STATUS[OT2..OT1] */
    uint8_t pending;   /**< inputs whose delay runs */
} sim_pl_guard;

typedef struct sim_pl_dev {
    uint8_t reg[SIM_PL_REGS]; /**< exactly what a read returns */
    uint8_t power;            /**< sim_pl_power */
    bool uvlo, tsd, asleep, locked, drdy, cb_running;
    bool key; /**< SHDW_CTRL key armed */
    bool test, test_step;
    bool conv_in;    /**< level at the CONV input */
    bool by_command; /**< the reset that runs was a RESET command */
    bool lost;       /**< had an address and lost it with its supply */
    bool slept_by_host;
    uint8_t hold_alert, hold_fault; /**< PL-AMB-33: flags held cleared */
    uint8_t conv_select, conv_adct; /**< ADC_CONTROL and ADCT when the running cycle began */
    uint8_t wires_open;
    uint32_t conversions;
    uint32_t address_generation;

    uint64_t next; /**< earliest of the times below */
    uint64_t conv_end, adc_ready, cb_end, reset_end, blank_end, uvlo_at, por_at, prog_end, vpp_limit;
    uint64_t
        tainted_until; /**< an injected fault hit a write to this device: its consequences are not judged */
    sim_pl_guard cov, cuv, ot;

    double cell[6], seen[6]; /**< the cells, and what the inputs see of them */
    double vbat;             /**< negative = sum of the cells */
    double ts[2], gpai, tdie;
    double ot_trip[2], ot_hold[2];
    double offset_v[6];
    bool supply, gpio_level, vpp;

    uint8_t otp[SIM_PL_GROUP3], otp_damage[SIM_PL_GROUP3]; /**< programmed content, bits flipped since */
    uint8_t image[SIM_PL_GROUP3];                          /**< what the running programming burns in */
    uint16_t parity_bits;                                  /**< ninth bit of each group-3 register */
    bool programmed;
} sim_pl_dev;

/** A packet that arrives byte by byte (sim_pl536_bytes.c). */
typedef struct sim_pl_bytes {
    bool selected, answered, faulty;
    size_t n, expected; /**< bytes clocked; bytes of the answered read from its start */
    uint64_t selected_at, byte_end, released_at, longest_pause, lead;
    bool released_before;
    uint8_t tx[SIM_PL_PACKET_MAX], rx[SIM_PL_PACKET_MAX], driven[SIM_PL_PACKET_MAX];
} sim_pl_bytes;

struct sim_pl {
    int devices;
    int reach;       /**< devices that see chip select now, counted from the base */
    int reach_break; /**< break_above for which reach holds */
    bool reach_valid, chain_changed;
    bool conv;
    bool exempt; /**< the packet being carried was touched by an injected fault */
    bool spi_seen;
    uint8_t by_address[64]; /**< 1 + index of the lowest device that sees chip select and has this address */
    bool duplicate;         /**< two reachable devices share an address */
    uint64_t now, next;
    uint64_t last_packet; /**< start of the last packet */
    uint32_t spi_hz;
    uint64_t crc_off_search_until; /* somebody looks for devices whose CRC is off: short packets are no mistake */
    int spi_mode;
    uint32_t generation; /**< counts broadcast RESETs: addresses of an older one are stale */
    uint64_t rng;
    sim_pl_options options;
    bool link_broken[SIM_PL_MAX_DEVICES];
    struct sim_vcd *vcd;
    int vcd_signal[8];
    uint64_t vcd_time; /**< how far the waveform got */
    uint64_t vcd_free; /**< the next packet may begin */
    sim_bus_fault fault;
    sim_misuse misuse;
    sim_pl_bytes bytes;
    sim_pl_dev dev[SIM_PL_MAX_DEVICES];
};
typedef struct sim_pl sim_pl;

#endif
