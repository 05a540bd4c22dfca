/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file sim_pl536_internal.h
 * What the files of the bq76PL536 model share. Nobody else includes it.
 */
#ifndef SIM_PL536_INTERNAL_H
#define SIM_PL536_INTERNAL_H

#include "sim_pl536.h"

enum {
    REG_STATUS = 0x00,
    REG_GPAI = 0x01,
    REG_VCELL1 = 0x03,
    REG_TEMP1 = 0x0f,
    REG_TEMP2 = 0x11,
    REG_ALERT = 0x20,
    REG_FAULT = 0x21,
    REG_COV_FAULT = 0x22,
    REG_CUV_FAULT = 0x23,
    REG_PRESULT_A = 0x24,
    REG_PRESULT_B = 0x25,
    REG_ADC_CONTROL = 0x30,
    REG_IO_CONTROL = 0x31,
    REG_CB_CTRL = 0x32,
    REG_CB_TIME = 0x33,
    REG_ADC_CONVERT = 0x34,
    REG_SHDW_CTRL = 0x3a,
    REG_ADDRESS = 0x3b,
    REG_RESET = 0x3c,
    REG_TEST_SELECT = 0x3d,
    REG_E_EN = 0x3f,
    REG_FUNCTION = 0x40,
    REG_IO_CONFIG = 0x41,
    REG_COV = 0x42,
    REG_COVT = 0x43,
    REG_CUV = 0x44,
    REG_CUVT = 0x45,
    REG_OT = 0x46,
    REG_OTT = 0x47,
    REG_USER1 = 0x48,
    REG_LAST = 0x4b
};

enum { /* DEVICE_STATUS */
       ST_AR = 0x80,
       ST_FAULT = 0x40,
       ST_ALERT = 0x20,
       ST_ECC_COR = 0x08,
       ST_UVLO = 0x04,
       ST_CBT = 0x02,
       ST_DRDY = 0x01
};

enum { /* ALERT_STATUS */
       AL_AR = 0x80,
       AL_PARITY = 0x40,
       AL_ECC_ERR = 0x20,
       AL_FORCE = 0x10,
       AL_TSD = 0x08,
       AL_SLEEP = 0x04,
       AL_OT = 0x03
};

enum { /* FAULT_STATUS */
       FA_I_FAULT = 0x20,
       FA_FORCE = 0x10,
       FA_POR = 0x08,
       FA_CRC = 0x04,
       FA_CUV = 0x02,
       FA_COV = 0x01,
       FA_ALL = 0x3f
};

enum { /* ADC_CONTROL, IO_CONTROL, ADDRESS_CONTROL, FUNCTION_CONFIG, IO_CONFIG, and the protection registers
        */
       ADC_ON = 0x40,
       IO_AUX = 0x80,
       IO_GPIO_OUT = 0x40,
       IO_GPIO_IN = 0x20,
       IO_SLEEP = 0x04,
       IO_TS = 0x03,
       ADDR_AR = 0x80,
       ADDR_MASK = 0x3f,
       ADDR_BROADCAST = 0x3f,
       FN_GPAI_REF = 0x20,
       FN_GPAI_SRC = 0x10,
       IOC_CRC_DIS = 0x01,
       IOC_CRCNOFLT = 0x80,
       PROT_DISABLE = 0x80
};

/** Comparisons of volts, ratios and degrees treat differences below this as equality. */
#define SIM_PL_EPS 1e-9

/* ---- register table (sim_pl536_regs.c) -------------------------------------------------------- */

typedef enum sim_pl_access { SIM_PL_RESERVED, SIM_PL_R, SIM_PL_RW, SIM_PL_W } sim_pl_access;

typedef struct sim_pl_reg {
    uint8_t address, group;
    uint8_t access; /**< sim_pl_access */
    uint8_t keep;   /**< bits that can keep a written 1 (PL-REG-50) */
    uint8_t legal;  /**< bits a host may write as 1 */
    uint8_t reset;  /**< after POR or RESET; group 3: blank EPROM */
    void (*effect)(sim_pl *s, sim_pl_dev *d,
                   uint8_t value); /**< what a write does beyond storing; NULL = stored under `keep` */
    const char *id;                /**< the row that describes it */
    const char *name;
} sim_pl_reg;

/** The row of any address 0x00..0xff; reserved addresses share rows. */
const sim_pl_reg *sim_pl_reg_at(uint8_t address);
/** Groups 1 and 2 as after a reset. */
void sim_pl_reg_reset(sim_pl_dev *d);
uint8_t sim_pl_reg_keep(const sim_pl *s, const sim_pl_reg *r);
uint8_t sim_pl_reg_legal(const sim_pl *s, const sim_pl_reg *r);

/* ---- helpers ------------------------------------------------------------------------------------ */

uint8_t sim_pl_crc8(uint8_t crc, const uint8_t *data, size_t n);
static inline int sim_pl_number(const sim_pl *s, const sim_pl_dev *d)
{
    return (int)(d - s->dev) + 1;
}
static inline bool sim_pl_is_on(const sim_pl_dev *d)
{
    return d->power == SIM_PL_POWER_ON;
}
static inline uint8_t sim_pl_address(const sim_pl_dev *d)
{
    return d->reg[REG_ADDRESS] & ADDR_MASK;
}
static inline bool sim_pl_link_down(const sim_pl *s, int index)
{
    return s->link_broken[index] || s->fault.break_above == index + 1;
}
/** Brings DEVICE_STATUS and the times of the next events up to date after any change in a device. */
void sim_pl_touch(sim_pl *s, sim_pl_dev *d);
/** After a change of power or links: chip select and CONV find their new way. */
void sim_pl_chain_changed(sim_pl *s);
void sim_pl_chain_settle(sim_pl *s);
uint64_t sim_pl_random(uint64_t *state);
/** Nominal time scaled by the option delay_percent. */
uint64_t sim_pl_scaled(const sim_pl *s, uint64_t ns);

/* ---- parts of a device ----------------------------------------------------------------------------- */

/* sim_pl536_power.c */
void sim_pl_power_update(sim_pl *s, sim_pl_dev *d);
void sim_pl_power_due(sim_pl *s, sim_pl_dev *d);
void sim_pl_reset_enter(sim_pl *s, sim_pl_dev *d, bool by_command);
void sim_pl_reset_leave(sim_pl *s, sim_pl_dev *d);
void sim_pl_tsd_update(sim_pl *s, sim_pl_dev *d);
void sim_pl_sleep_request(sim_pl *s, sim_pl_dev *d);
double sim_pl_brick(const sim_pl_dev *d);
bool sim_pl_reg50_on(const sim_pl_dev *d);

/* sim_pl536_adc.c */
void sim_pl_adc_start(sim_pl *s, sim_pl_dev *d, bool by_pin);
void sim_pl_adc_abort(sim_pl_dev *d);
void sim_pl_adc_finish(sim_pl *s, sim_pl_dev *d);
void sim_pl_adc_wake(sim_pl *s, sim_pl_dev *d);

/* sim_pl536_protect.c */
void sim_pl_protect_config(sim_pl *s, sim_pl_dev *d);
void sim_pl_protect_check(sim_pl *s, sim_pl_dev *d);
bool sim_pl_protect_cells_changed(const sim_pl_dev *d);
void sim_pl_protect_off(sim_pl_dev *d);
void sim_pl_protect_rest(sim_pl_dev *d);
void sim_pl_protect_due(sim_pl *s, sim_pl_dev *d);
void sim_pl_write_alert(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_write_fault(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_alert_set(sim_pl_dev *d, uint8_t bits);
void sim_pl_fault_set(sim_pl_dev *d, uint8_t bits);

/* sim_pl536_write.c */
void sim_pl_write(sim_pl *s, sim_pl_dev *d, uint8_t reg, uint8_t value, bool broadcast);
void sim_pl_balance_stop(sim_pl *s, sim_pl_dev *d);
void sim_pl_balance_expire(sim_pl *s, sim_pl_dev *d);
void sim_pl_do_adc_control(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_io_control(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_cb_ctrl(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_cb_time(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_convert(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_shadow(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_address(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_reset(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_do_test(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_gpio_update(sim_pl_dev *d);

/* sim_pl536_eprom.c */
void sim_pl_eprom_load(sim_pl *s, sim_pl_dev *d);
void sim_pl_do_e_en(sim_pl *s, sim_pl_dev *d, uint8_t value);
void sim_pl_eprom_access(sim_pl *s, sim_pl_dev *d);
void sim_pl_eprom_due(sim_pl *s, sim_pl_dev *d);
void sim_pl_parity_store(sim_pl_dev *d, int index);
void sim_pl_parity_check(sim_pl_dev *d);

/* sim_pl536_analog.c */
void sim_pl_inputs(sim_pl *s, sim_pl_dev *d);

/* sim_pl536_packet.c */
/** What an injected fault does to the way of one packet through the stack. All zero = nothing. */
typedef struct sim_pl_route {
    int answer_from;  /**< this device answers whatever the address says */
    int cut_device;   /**< this device and all above it vanish ... */
    size_t cut_bytes; /**< ... after this many bytes */
} sim_pl_route;
void sim_pl_packet(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits,
                   const sim_pl_route *route);
void sim_pl_reach(sim_pl *s);
/** A whole packet, judged, counted and through the fault interception point. */
void sim_pl_carry(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits);

/* sim_bus_fault.c */
static inline bool sim_bus_fault_idle(const sim_bus_fault *f)
{
    return (f->flip_mosi_bit | f->flip_miso_bit | f->dead | f->late_bits | f->stuck_mosi | f->stuck_miso |
            f->wrong_device) == 0 &&
           (f->drop_packets | f->short_packets | f->brownout_bytes) == 0 && f->hook == NULL &&
           !(f->flip_probability > 0.0);
}
void sim_pl_faulty_packet(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *driven, size_t bits);

/* sim_pl536_pins.c */
void sim_pl_pins_record(sim_pl *s);
void sim_pl_record_select(sim_pl *s, bool low);
void sim_pl_record_byte(sim_pl *s, uint8_t tx, uint8_t rx); /* eight clocks that end now */
void sim_pl_record_packet(sim_pl *s, const uint8_t *tx, const uint8_t *rx, size_t bits);

/* sim_pl536_judge.c: `state` judgements depend on what earlier packets left behind */
void sim_pl_judge(sim_pl *s, const sim_pl_dev *d, const char *id, const char *text);
void sim_pl_judge_state(sim_pl *s, const sim_pl_dev *d, const char *id, const char *text);
void sim_pl_judge_write(sim_pl *s, const sim_pl_dev *d, uint8_t reg, uint8_t value, bool key, bool broadcast);
void sim_pl_judge_read(sim_pl *s, const sim_pl_dev *d, uint8_t first, uint8_t length, size_t bits);
void sim_pl_judge_host(sim_pl *s, const uint8_t *tx, size_t bits);
void sim_pl_judge_timing(sim_pl *s, const sim_pl_spi_timing *timing);

#endif
