/* SPDX-License-Identifier: Apache-2.0 */
#include "ps_can.h"

#include <errno.h>
#include <net/if.h>
#include <string.h>
#include <unistd.h>
#ifdef __linux__
#include <linux/can.h>
#include <sys/socket.h>
#endif

/* ---- SocketCAN --------------------------------------------------------------------------------- */

#ifdef __linux__
static int open_socket(unsigned interface)
{
    struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)interface};
    int fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (fd >= 0 && bind(fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        int error = errno;
        (void)close(fd);
        errno = error;
        return -1;
    }
    return fd;
}

static bq_status send_socket(ps_can *c, const bq_can_frame *frame)
{
    struct can_frame out = {.can_id = frame->id | (frame->extended ? CAN_EFF_FLAG : 0u),
                            .can_dlc = frame->len};
    memcpy(out.data, frame->data, frame->len);
    if (write(c->socket, &out, sizeof out) == (ssize_t)sizeof out) {
        return BQ_OK;
    }
    if (errno == EAGAIN || errno == ENOBUFS) {
        return BQ_E_BUSY;
    }
    c->error = c->error != 0 ? c->error : errno;
    return BQ_E_BUS;
}
#else
static int open_socket(unsigned interface)
{
    (void)interface;
    errno = EAFNOSUPPORT;
    return -1;
}

static bq_status send_socket(ps_can *c, const bq_can_frame *frame)
{
    (void)c;
    (void)frame;
    return BQ_E_BUS;
}
#endif

/* ---- log --------------------------------------------------------------------------------------- */

static bq_status send_log(ps_can *c, const bq_can_frame *frame)
{
    uint64_t us = c->now(c->ctx) / 1000u;
    int bad = fprintf(c->log, "(%010llu.%06llu) can0 %0*X#", (unsigned long long)(us / 1000000u),
                      (unsigned long long)(us % 1000000u), frame->extended ? 8 : 3, (unsigned)frame->id) < 0;
    for (int i = 0; i < frame->len; i++) {
        bad |= fprintf(c->log, "%02X", (unsigned)frame->data[i]) < 0;
    }
    bad |= fputc('\n', c->log) == EOF;
    if (bad != 0 && c->error == 0) {
        c->error = errno;
    }
    return BQ_OK;
}

/* ---- the controller ------------------------------------------------------------------------------ */

static bq_status can_send(void *ctx, const bq_can_frame *frame)
{
    ps_can *c = ctx;
    if (frame->len > 8u || frame->id > (frame->extended ? 0x1fffffffu : 0x7ffu)) {
        return BQ_E_ARG;
    }
    return c->log != NULL ? send_log(c, frame) : send_socket(c, frame);
}

/* Nobody sends to a simulated pack. */
static bq_status can_receive(void *ctx, bq_can_frame *frame)
{
    (void)ctx;
    (void)frame;
    return BQ_PENDING;
}

static bq_can_state can_state(void *ctx)
{
    const ps_can *c = ctx;
    return c->log == NULL && c->error != 0 ? BQ_CAN_OFF : BQ_CAN_ACTIVE;
}

bq_can ps_can_controller(ps_can *c)
{
    static const bq_can_ops ops = {can_send, can_receive, can_state};
    const bq_can can = {&ops, c};
    return can;
}

int ps_can_open(ps_can *c, const char *dest, uint64_t (*now)(void *ctx), void *ctx)
{
    unsigned interface = if_nametoindex(dest);
    memset(c, 0, sizeof *c);
    c->now = now;
    c->ctx = ctx;
    c->socket = -1;
    if (interface != 0u) {
        c->socket = open_socket(interface);
        return c->socket >= 0 ? 0 : -1;
    }
    c->log = fopen(dest, "w");
    return c->log != NULL ? 0 : -1;
}

int ps_can_close(ps_can *c)
{
    int bad = c->error;
    if (c->log != NULL) {
        bad |= ferror(c->log);
        bad |= fclose(c->log);
        c->log = NULL;
    }
    if (c->socket >= 0) {
        (void)close(c->socket);
        c->socket = -1;
    }
    return bad != 0 ? -1 : 0;
}
