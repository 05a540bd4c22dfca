/* SPDX-License-Identifier: Apache-2.0 */
/* Two lives of a host on one stack: the first brings it up, the next one finds it running. */
#ifndef DRIVER_LIVES_H
#define DRIVER_LIVES_H

#include "driver_rig.h"

#define LIFE_DEVICES 4

extern driver_rig r;
extern bq76pl536_config c;                            /* of LIFE_DEVICES devices, with warm_start */
extern int reference[BQ76PL536_MAX_DEVICES + 1][256]; /* registers of the healthy stack, by device */

/* A spy on the bus that can do something at packet number `at` of a life. */
extern struct spy {
    uint32_t packets, bytes, resets, assignments, keys; /* since the host was reset; keys: shadow and EPROM */
    uint8_t first[4];
    uint32_t at;
    void (*act)(void);
} spy;

void life_set_up(void);
void life_tear_down(void);
bool life_watch(void *ctx, uint8_t *tx, uint8_t *rx, uint32_t n);
void life_remember(void); /* the registers as they are become the reference */
/* A life of the host with readings; what follows belongs to the next one. */
void life_first(const sim_pl_options *options);
/* The host forgets everything. */
void life_reset_host(void);
/* The same, and its start ends well, with all devices and without misuse. */
void life_next(void);
bq76pl536_warm life_warm(void);
/* The next life starts anew for the reason given, and rightly. */
void life_expect_cold(bq76pl536_warm why, unsigned device);
/* It resets nothing, and all is right. */
void life_expect_adopted(void);
void life_assert_registers(void); /* as in the reference, outputs off, no flags */
void life_assert_picture(void);   /* complete, valid, right */
void life_assert_right(void);     /* both, with a scan in between, and silent lines */

#endif
