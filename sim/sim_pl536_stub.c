/* SPDX-License-Identifier: Apache-2.0 */
/* Placeholders until the model is in. */
#include "sim_pl536.h"
#include <string.h>
#define U(x) ((void)(x))
int sim_pl_init(sim_pl *s, int devices, const sim_pl_options *o) { memset(s, 0, sizeof *s); s->devices = devices; if (o) s->options = *o; return 0; }
void sim_pl_advance(sim_pl *s, uint64_t ns) { s->now += ns; }
uint64_t sim_pl_now(const sim_pl *s) { return s->now; }
uint64_t sim_pl_next_event(const sim_pl *s) { U(s); return UINT64_MAX; }
sim_misuse *sim_pl_misuse(sim_pl *s) { return &s->misuse; }
void sim_pl_spi(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *d, size_t n) { U(s); U(tx); memset(rx, 0, n); if (d) memset(d, 0, n); }
void sim_pl_spi_bits(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *d, size_t n) { sim_pl_spi(s, tx, rx, d, n / 8); }
void sim_pl_spi_timed(sim_pl *s, const uint8_t *tx, uint8_t *rx, uint8_t *d, size_t n, const sim_pl_spi_timing *t) { U(t); sim_pl_spi(s, tx, rx, d, n); }
void sim_pl_set_spi_clock(sim_pl *s, uint32_t hz) { s->spi_hz = hz; }
void sim_pl_set_conv(sim_pl *s, bool l) { s->conv = l; }
bool sim_pl_conv(const sim_pl *s) { return s->conv; }
bool sim_pl_fault_pin(const sim_pl *s) { U(s); return false; }
bool sim_pl_alert_pin(const sim_pl *s) { U(s); return false; }
bool sim_pl_drdy_pin(const sim_pl *s) { U(s); return false; }
int sim_pl_set_cell(sim_pl *s, int d, int c, double v) { U(s); U(d); U(c); U(v); return -1; }
int sim_pl_set_cells(sim_pl *s, int d, const double v[6]) { U(s); U(d); U(v); return -1; }
double sim_pl_cell(const sim_pl *s, int d, int c) { U(s); U(d); U(c); return 0; }
int sim_pl_set_vbat(sim_pl *s, int d, double v) { U(s); U(d); U(v); return -1; }
double sim_pl_vbat(const sim_pl *s, int d) { U(s); U(d); return 0; }
int sim_pl_set_ts_ratio(sim_pl *s, int d, int n, double r) { U(s); U(d); U(n); U(r); return -1; }
double sim_pl_ts_ratio(const sim_pl *s, int d, int n) { U(s); U(d); U(n); return 0; }
int sim_pl_set_gpai(sim_pl *s, int d, double v) { U(s); U(d); U(v); return -1; }
double sim_pl_gpai(const sim_pl *s, int d) { U(s); U(d); return 0; }
int sim_pl_set_gpio(sim_pl *s, int d, bool v) { U(s); U(d); U(v); return -1; }
bool sim_pl_gpio(const sim_pl *s, int d) { U(s); U(d); return false; }
int sim_pl_set_tdie(sim_pl *s, int d, double v) { U(s); U(d); U(v); return -1; }
double sim_pl_tdie(const sim_pl *s, int d) { U(s); U(d); return 0; }
int sim_pl_set_supply(sim_pl *s, int d, bool v) { U(s); U(d); U(v); return -1; }
bool sim_pl_supply(const sim_pl *s, int d) { U(s); U(d); return false; }
int sim_pl_set_otp(sim_pl *s, int d, uint8_t r, uint8_t v) { U(s); U(d); U(r); U(v); return -1; }
uint8_t sim_pl_otp(const sim_pl *s, int d, uint8_t r) { U(s); U(d); U(r); return 0; }
int sim_pl_damage_otp(sim_pl *s, int d, uint8_t r, uint8_t v) { U(s); U(d); U(r); U(v); return -1; }
int sim_pl_damage_ram(sim_pl *s, int d, uint8_t r, uint8_t v) { U(s); U(d); U(r); U(v); return -1; }
int sim_pl_set_vpp(sim_pl *s, int d, bool v) { U(s); U(d); U(v); return -1; }
bool sim_pl_vpp(const sim_pl *s, int d) { U(s); U(d); return false; }
int sim_pl_set_wire(sim_pl *s, int d, int w, bool v) { U(s); U(d); U(w); U(v); return -1; }
int sim_pl_set_link(sim_pl *s, int d, bool v) { U(s); U(d); U(v); return -1; }
uint8_t sim_pl_cb(const sim_pl *s, int d) { U(s); U(d); return 0; }
bool sim_pl_aux(const sim_pl *s, int d) { U(s); U(d); return false; }
bool sim_pl_reg50(const sim_pl *s, int d) { U(s); U(d); return false; }
sim_pl_mode sim_pl_get_mode(const sim_pl *s, int d) { U(s); U(d); return SIM_PL_OFF; }
int sim_pl_peek(const sim_pl *s, int d, uint8_t r) { U(s); U(d); U(r); return -1; }
uint32_t sim_pl_conversions(const sim_pl *s, int d) { U(s); U(d); return 0; }
struct sim_bus_fault *sim_pl_bus_fault(sim_pl *s) { return &s->fault; }
void sim_pl_record(sim_pl *s, struct sim_vcd *v) { s->vcd = v; }
