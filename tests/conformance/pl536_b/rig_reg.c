/* SPDX-License-Identifier: Apache-2.0 */
#include "rig_reg.h"

void read_only(int reg)
{
    rig_ready(1);
    int before = rig_read(1, reg);
    for (int value = 0; value < 256; value++) {
        rig_write(1, reg, value);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(before, rig_read(1, reg), rig_text("register %02x", (unsigned)reg));
    }
    EXPECT(0x81, 1, R_STATUS);
    EXPECT_MISUSE("PL-AMB-106", "PL-REG-01", "PL-REG-03");
}

void reserved(int first, int last)
{
    for (int reg = first; reg <= last; reg++) {
        rig_ready(1);
        EXPECT(0x00, 1, reg);
        rig_write(1, reg, 0xff);
        EXPECT(0x00, 1, reg);
        rig_shadow(1, reg, 0xff);
        EXPECT(0x00, 1, reg);
        EXPECT(0x81, 1, R_STATUS);
        EXPECT_MISUSE("PL-REG-01", "PL-AMB-106", "PL-AMB-101");
    }
}

void result(int reg, void (*full)(void))
{
    read_only(reg);
    read_only(reg + 1);
    rig_ready(1);
    EXPECT_WORD(0x0000, 1, reg);
    full();
    rig_write(1, R_IO, 0x03);
    rig_adc(1, 0x7d, 0x40);
    rig_convert(1);
    EXPECT(0x3f, 1, reg);
    EXPECT(0xff, 1, reg + 1);
    rig_reset(1);
    EXPECT_WORD(0x0000, 0, reg);
}

void all_cells_full(void)
{
    for (int c = 1; c <= 6; c++) {
        sim_pl_set_cell(&rig, 1, c, 6.4);
    }
    sim_pl_set_vbat(&rig, 1, 21.6);
}

void gpai_full(void)
{
    sim_pl_set_gpai(&rig, 1, 2.6);
}

void sensors_full(void)
{
    sim_pl_set_ts_ratio(&rig, 1, 1, 0.6);
    sim_pl_set_ts_ratio(&rig, 1, 2, 0.6);
}

void read_write(int reg, int mask, int live, int reset)
{
    bool key = reg >= C_FUNC && reg <= 0x4b;
    rig_ready(1);
    for (int step = 0; step < 258; step++) {
        int value = step < 256 ? step : step == 256 ? 0xff : 0x00;
        if (reg == R_IO && (value & 0x44)) {
            continue; /* SLEEP and the released GPIO have tests of their own */
        }
        if (key) {
            rig_shadow(1, reg, value);
        } else {
            rig_write(1, reg, value);
        }
        TEST_ASSERT_EQUAL_HEX8_MESSAGE((value & mask) | live, rig_read(1, reg),
                                       rig_text("%02x to %02x", (unsigned)value, (unsigned)reg));
    }
    if (key) {
        rig_shadow(1, reg, mask & 0x15);
    } else {
        rig_write(1, reg, mask & 0x13);
    }
    rig_reset(1);
    EXPECT(reset, 0, reg);
}

void reserved_bits(int reg, int mask)
{
    bool key = reg >= C_FUNC && reg <= 0x4b;
    for (int bit = 0; bit < 8; bit++) {
        if (mask >> bit & 1) {
            continue;
        }
        rig_ready(1);
        if (key) {
            rig_write(1, R_SHDW, 0x35);
        }
        rig_write(1, reg, 1 << bit);
        EXPECT_MISUSE("PL-REG-02", "PL-G3-11", "PL-REG-03", "PL-CB-17");
    }
}
