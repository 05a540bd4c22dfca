/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file ps_can.h
 * Where frames of the simulated CAN controller go: a log in the format of candump, or a SocketCAN interface.
 */
#ifndef PS_CAN_H
#define PS_CAN_H

#include "bqhost/hal.h"
#include <stdio.h>

typedef struct ps_can {
    FILE *log;                  /**< NULL = a socket */
    int socket;                 /**< -1 = a log */
    uint64_t (*now)(void *ctx); /**< simulated time in ns */
    void *ctx;
    int error; /**< errno of the first write that failed, 0 = none */
} ps_can;

/** DEST is a network interface if one has this name, else a file, which is written anew. `now` stamps the
 *  log. 0, or -1 with errno set. */
int ps_can_open(ps_can *c, const char *dest, uint64_t (*now)(void *ctx), void *ctx);
/** 0, or -1 if something could not be written. */
int ps_can_close(ps_can *c);
/** What the firmware's board offers. `c` must outlive it. */
bq_can ps_can_controller(ps_can *c);

#endif
