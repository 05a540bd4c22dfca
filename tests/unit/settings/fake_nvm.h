/* SPDX-License-Identifier: Apache-2.0 */
/* Flash that keeps its rules and can lose its power: programs only erased units, erases whole sectors. */
#ifndef FAKE_NVM_H
#define FAKE_NVM_H

#include "bqhost/hal.h"

#define NVM_SECTORS 3
#define NVM_BYTES 2048

typedef struct fake_nvm {
    uint8_t memory[NVM_SECTORS][NVM_BYTES];
    uint8_t unit;
    long operations;  /* programs and erases carried out */
    long power_until; /* the operation with this number is torn, no later one happens; negative = never */
    uint8_t torn;     /* what a torn unit or sector is left with: XORed over what it should become */
    bq_status program_status, erase_status, read_status; /* BQ_OK = works */
    bool sticks;   /* programs without an error, but a bit does not take */
    long breaches; /* programmed what was not erased, outside, or not a unit */
} fake_nvm;

void fake_nvm_init(fake_nvm *n, uint8_t unit);
bq_nvm fake_nvm_ops(fake_nvm *n, uint8_t sectors);

#endif
