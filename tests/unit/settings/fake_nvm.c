/* SPDX-License-Identifier: Apache-2.0 */
#include "fake_nvm.h"
#include <string.h>

/* 1 = do it, 0 = torn, -1 = the power is gone. */
static int power(fake_nvm *n)
{
    const long number = n->operations++;

    if (n->power_until < 0 || number < n->power_until) {
        return 1;
    }
    return number == n->power_until ? 0 : -1;
}

static bq_status nvm_read(void *ctx, uint8_t sector, uint32_t offset, void *data, size_t len)
{
    fake_nvm *n = ctx;

    if (n->read_status != BQ_OK) {
        return n->read_status;
    }
    if (sector >= NVM_SECTORS || offset + len > NVM_BYTES) {
        n->breaches++;
        return BQ_E_ARG;
    }
    memcpy(data, &n->memory[sector][offset], len);
    return BQ_OK;
}

static bq_status nvm_program(void *ctx, uint8_t sector, uint32_t offset, const void *data, size_t len)
{
    fake_nvm *n = ctx;
    uint8_t *at = &n->memory[sector][offset];

    if (n->program_status != BQ_OK) {
        return n->program_status;
    }
    if (sector >= NVM_SECTORS || offset + len > NVM_BYTES || len != n->unit || offset % n->unit != 0u) {
        n->breaches++;
        return BQ_E_ARG;
    }
    for (size_t i = 0; i < len; i++) {
        n->breaches += at[i] != 0xffu;
    }
    switch (power(n)) {
    case 1:
        memcpy(at, data, len);
        at[0] = (uint8_t)(n->sticks ? at[0] ^ 1u : at[0]);
        return BQ_OK;
    case 0:
        for (size_t i = 0; i < len; i++) {
            at[i] = (uint8_t)(((const uint8_t *)data)[i] ^ n->torn);
        }
        return BQ_OK; /* nobody is there to hear it */
    default:
        return BQ_OK;
    }
}

static bq_status nvm_erase(void *ctx, uint8_t sector)
{
    fake_nvm *n = ctx;
    int alive;

    if (n->erase_status != BQ_OK) {
        return n->erase_status;
    }
    alive = power(n);
    if (alive == 1) {
        memset(n->memory[sector], 0xff, NVM_BYTES);
    } else if (alive == 0) { /* half of it, in any state */
        memset(n->memory[sector], 0xff ^ n->torn, NVM_BYTES / 2);
    }
    return BQ_OK;
}

void fake_nvm_init(fake_nvm *n, uint8_t unit)
{
    memset(n, 0, sizeof *n);
    memset(n->memory, 0xff, sizeof n->memory);
    n->unit = unit;
    n->power_until = -1;
}

bq_nvm fake_nvm_ops(fake_nvm *n, uint8_t sectors)
{
    static const bq_nvm_ops ops = {nvm_read, nvm_program, nvm_erase};
    const bq_nvm nvm = {&ops, n, sectors, n->unit, NVM_BYTES};

    return nvm;
}
