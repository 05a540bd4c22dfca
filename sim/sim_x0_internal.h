/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the bq769x0 model only. */
#ifndef SIM_X0_INTERNAL_H
#define SIM_X0_INTERNAL_H

#include "sim_x0.h"

#define X0_NEVER UINT64_MAX
#define X0_US 1000ull
#define X0_MS 1000000ull
#define X0_SCAN (250u * X0_MS)

enum {
    X0_SYS_STAT = 0x00,
    X0_CELLBAL1 = 0x01,
    X0_CELLBAL3 = 0x03,
    X0_SYS_CTRL1 = 0x04,
    X0_SYS_CTRL2 = 0x05,
    X0_PROTECT1 = 0x06,
    X0_PROTECT2 = 0x07,
    X0_PROTECT3 = 0x08,
    X0_OV_TRIP = 0x09,
    X0_UV_TRIP = 0x0a,
    X0_CC_CFG = 0x0b,
    X0_VC1_HI = 0x0c,
    X0_BAT_HI = 0x2a,
    X0_TS1_HI = 0x2c,
    X0_CC_HI = 0x32,
    X0_CC_LO = 0x33,
    X0_GAIN1 = 0x50,
    X0_OFFSET = 0x51,
    X0_GAIN2 = 0x59
};
enum {
    X0_CC_READY = 0x80,
    X0_XREADY = 0x20,
    X0_OVRD = 0x10,
    X0_UV = 0x08,
    X0_OV = 0x04,
    X0_SCD = 0x02,
    X0_OCD = 0x01
};
enum {
    X0_ADC_EN = 0x10,
    X0_TEMP_SEL = 0x08,
    X0_DELAY_DIS = 0x80,
    X0_CC_EN = 0x40,
    X0_CC_ONESHOT = 0x20,
    X0_DSG_ON = 2,
    X0_CHG_ON = 1
};

void x0_misuse(sim_x0 *s, const char *id, const char *text);
void x0_defaults(sim_x0 *s, uint8_t ctrl1);
void x0_enter_ship(sim_x0 *s);
void x0_enter_normal(sim_x0 *s);
/** From the start of the converter to the first results, ns. */
uint64_t x0_first_scan(const sim_x0 *s);
/** Sets SYS_STAT bits and carries out the FET reactions of Table 7-1. */
void x0_raise(sim_x0 *s, uint8_t bits);
/** The outside level on ALERT; `rising` = it just came. */
void x0_alert_check(sim_x0 *s, bool rising);
void x0_publish(sim_x0 *s);
void x0_converter(sim_x0 *s, bool on);
void x0_overcurrent(sim_x0 *s);
uint64_t x0_overcurrent_due(const sim_x0 *s);
void x0_cc_integrate(sim_x0 *s);
void x0_cc_result(sim_x0 *s);
void x0_cc_control(sim_x0 *s, uint8_t before, uint8_t wanted);
uint8_t x0_read(sim_x0 *s, uint8_t reg);
/** Returns whether the byte is acknowledged. */
bool x0_write(sim_x0 *s, uint8_t reg, uint8_t value);
void x0_judge_balance(sim_x0 *s, int group);
void x0_judge_read(sim_x0 *s, uint8_t reg, bool high_before);
double x0_uniform(sim_x0 *s);
double x0_gauss(sim_x0 *s);
/* bus events without their trace in the waveform */
void x0_bus_start(sim_x0 *s);
bool x0_bus_write(sim_x0 *s, uint8_t byte);
uint8_t x0_bus_read(sim_x0 *s, bool ack);
void x0_bus_stop(sim_x0 *s);
/* waveform; all do nothing while none is recorded */
void x0_record_pins(sim_x0 *s);
void x0_record_lines(sim_x0 *s, bool scl, bool sda);
void x0_record_start(sim_x0 *s);
void x0_record_byte(sim_x0 *s, uint8_t byte, bool ack);
void x0_record_stop(sim_x0 *s);

#endif
