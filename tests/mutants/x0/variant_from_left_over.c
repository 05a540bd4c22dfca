/* SPDX-License-Identifier: Apache-2.0 */
/* CC_CFG = 0x19 taken for the proof that writes without CRC arrive, although it is left over from before. */
#include "x0_wrong.h"

static bool left_over;

static bool say(uint8_t reg, unsigned n, uint8_t *data)
{
    left_over = left_over || (reg <= BQ769X0_CC_CFG && reg + n > BQ769X0_CC_CFG &&
                              data[BQ769X0_CC_CFG - reg] == BQ769X0_CC_CFG_VALUE);
    return false;
}

/* The two reads that would show the CRC bytes of the part show none. */
static bool hear(uint8_t reg, unsigned n, uint8_t *data, unsigned bad)
{
    (void)bad;
    if (!left_over || n != 4 || (reg != BQ769X0_OV_TRIP && reg != BQ769X0_ADCGAIN1)) {
        return false;
    }
    data[1] ^= 0x55;
    return true;
}

const x0_wrong wrong = {.say = say, .hear = hear};
