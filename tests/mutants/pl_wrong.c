/* SPDX-License-Identifier: Apache-2.0 */
#include "pl_wrong.h"
#include "bqhost/crc8.h"
#include <string.h>

bq_status __real_bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi,
                                const bq_gpio *gpio, const bq_clock *clock, bq76pl536_device *devices,
                                uint8_t device_capacity);
bq_status __wrap_bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi,
                                const bq_gpio *gpio, const bq_clock *clock, bq76pl536_device *devices,
                                uint8_t device_capacity);

static struct {
    bq_spi bus;
    bq_spi_ops ops;
    uint8_t out[256], *rx;
    const uint8_t *tx;
    size_t len;
    bool dropped;
} w;

static bq_status wrong_start(void *ctx, const uint8_t *tx, uint8_t *rx, size_t len)
{
    pl_deed deed = PL_AS_IT_IS;
    (void)ctx;
    memcpy(w.out, tx, len);
    if ((tx[0] & 1) != 0 && len >= 3 && wrong.say != NULL) {
        deed = wrong.say(tx[0] >> 1, tx[1], &w.out[2]);
    }
    w.tx = tx;
    w.rx = rx;
    w.len = len;
    w.dropped = deed == PL_DROPPED;
    if (deed != PL_AS_IT_IS) {
        mutant_acted();
    }
    if (w.dropped) {
        memset(rx, 0, len);
        return BQ_OK;
    }
    if (deed == PL_CHANGED && len == 4) {
        w.out[3] = bq_crc8(0, w.out, 3);
    }
    return w.bus.ops->start(w.bus.ctx, w.out, rx, len);
}

static bq_status wrong_poll(void *ctx)
{
    uint8_t all[256];
    bq_status st;
    (void)ctx;
    if (w.dropped) {
        w.dropped = false;
        return BQ_OK;
    }
    st = w.bus.ops->poll(w.bus.ctx);
    if (st != BQ_OK || (w.tx[0] & 1) != 0 || wrong.hear == NULL || w.len != w.tx[2] + 4u) {
        return st; /* not a read with CRC that arrived */
    }
    memcpy(all, w.tx, 3);
    memcpy(all + 3, w.rx + 3, w.len - 3);
    if (wrong.hear(w.tx[0] >> 1, w.tx[1], w.tx[2], w.rx + 3, bq_crc8(0, all, w.len - 1) == all[w.len - 1]) ==
        PL_CHANGED) {
        mutant_acted();
        memcpy(all + 3, w.rx + 3, w.len - 3);
        w.rx[w.len - 1] = bq_crc8(0, all, w.len - 1);
    }
    return st;
}

static bq_status wrong_set_clock(void *ctx, uint32_t hz)
{
    (void)ctx;
    return w.bus.ops->set_clock(w.bus.ctx, hz);
}

bq_status __wrap_bq76pl536_init(bq76pl536 *d, const bq76pl536_config *config, const bq_spi *spi,
                                const bq_gpio *gpio, const bq_clock *clock, bq76pl536_device *devices,
                                uint8_t device_capacity)
{
    bq_spi mine = {&w.ops, NULL};
    bq76pl536_config changed = *config;
    w.bus = *spi;
    w.dropped = false;
    w.ops = (bq_spi_ops){wrong_start, wrong_poll, spi->ops->set_clock != NULL ? wrong_set_clock : NULL};
    if (wrong.config != NULL) {
        wrong.config(&changed);
        mutant_acted();
    }
    return __real_bq76pl536_init(d, &changed, &mine, gpio, clock, devices, device_capacity);
}
