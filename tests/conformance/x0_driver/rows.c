/* SPDX-License-Identifier: Apache-2.0 */
#include "rows.h"
#include <stddef.h>

const uint8_t rows_ocd_mv[2][16] = {
    {8, 11, 14, 17, 19, 22, 25, 28, 31, 33, 36, 39, 42, 44, 47, 50},
    {17, 22, 28, 33, 39, 44, 50, 56, 61, 67, 72, 78, 83, 89, 94, 100},
};
const uint8_t rows_scd_mv[2][8] = {{22, 33, 44, 56, 67, 78, 89, 100}, {44, 67, 89, 111, 133, 155, 178, 200}};
const uint16_t rows_ocd_ms[8] = {8, 20, 40, 80, 160, 320, 640, 1280};
const uint16_t rows_scd_us[4] = {70, 100, 200, 400};

uint16_t rows_wiring(unsigned inputs, unsigned cells)
{
    static const uint16_t of_5[] = {0x0013, 0x0017, 0x001f};
    static const uint16_t of_10[] = {0x0273, 0x0277, 0x02f7, 0x02ff, 0x03ff};
    static const uint16_t of_15[] = {0x4e73, 0x4e77, 0x4ef7, 0x5ef7, 0x5eff, 0x5fff, 0x7fff};
    unsigned least = rows_least(inputs);
    if (cells < least || cells > inputs)
        return 0;
    return inputs == 5 ? of_5[cells - 3] : inputs == 10 ? of_10[cells - 6] : of_15[cells - 9];
}

unsigned rows_input(unsigned inputs, unsigned cells, unsigned cell)
{
    uint16_t mask = rows_wiring(inputs, cells);
    unsigned i;
    for (i = 1; i <= inputs; i++)
        if ((mask >> (i - 1) & 1) && --cell == 0)
            return i;
    return 0;
}

int rows_legal_cellbal(unsigned group_wiring, unsigned value)
{
    static const uint8_t of_13[] = {0x00, 0x01, 0x02, 0x10, 0x11};
    static const uint8_t of_17[] = {0x00, 0x01, 0x02, 0x04, 0x05, 0x10, 0x11, 0x12};
    static const uint8_t of_1f[] = {0x00, 0x01, 0x02, 0x04, 0x05, 0x08, 0x09,
                                    0x0a, 0x10, 0x11, 0x12, 0x14, 0x15};
    const uint8_t *list = group_wiring == 0x13 ? of_13 : group_wiring == 0x17 ? of_17 : of_1f;
    size_t n = group_wiring == 0x13 ? sizeof of_13 : group_wiring == 0x17 ? sizeof of_17 : sizeof of_1f;
    while (n-- > 0)
        if (list[n] == value)
            return 1;
    return 0;
}

unsigned rows_least(unsigned inputs)
{
    return inputs == 5 ? 3 : inputs == 10 ? 6 : 9;
}
