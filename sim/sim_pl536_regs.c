/* SPDX-License-Identifier: Apache-2.0 */
/* The register table, written from PL-REG-07..50. */
#include "sim_pl536_internal.h"

/* address, group, access, keep, legal, reset, effect, row, name. Bits outside `legal` are reserved or read
 * only. */
static const sim_pl_reg table[] = {
    {0x00, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-07", "DEVICE_STATUS"},
    {0x01, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-08", "GPAI high"},
    {0x02, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-08", "GPAI low"},
    {0x03, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-09", "VCELL1 high"},
    {0x04, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-09", "VCELL1 low"},
    {0x05, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-10", "VCELL2 high"},
    {0x06, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-10", "VCELL2 low"},
    {0x07, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-11", "VCELL3 high"},
    {0x08, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-11", "VCELL3 low"},
    {0x09, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-12", "VCELL4 high"},
    {0x0a, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-12", "VCELL4 low"},
    {0x0b, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-13", "VCELL5 high"},
    {0x0c, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-13", "VCELL5 low"},
    {0x0d, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-14", "VCELL6 high"},
    {0x0e, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-14", "VCELL6 low"},
    {0x0f, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-15", "TEMPERATURE1 high"},
    {0x10, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-15", "TEMPERATURE1 low"},
    {0x11, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-16", "TEMPERATURE2 high"},
    {0x12, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-16", "TEMPERATURE2 low"},
    {0x13, 0, SIM_PL_RESERVED, 0x00, 0x00, 0x00, NULL, "PL-REG-17", "reserved"}, /* 0x13..0x1f */
    {0x20, 2, SIM_PL_RW, 0x10, 0xff, 0x80, sim_pl_write_alert, "PL-REG-18", "ALERT_STATUS"},
    {0x21, 2, SIM_PL_RW, 0x10, 0x3f, 0x08, sim_pl_write_fault, "PL-REG-19", "FAULT_STATUS"},
    {0x22, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-20", "COV_FAULT"},
    {0x23, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-21", "CUV_FAULT"},
    {0x24, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-22", "PRESULT_A"},
    {0x25, 1, SIM_PL_R, 0x00, 0x00, 0x00, NULL, "PL-REG-23", "PRESULT_B"},
    {0x26, 0, SIM_PL_RESERVED, 0x00, 0x00, 0x00, NULL, "PL-REG-24", "reserved"}, /* 0x26..0x2f */
    {0x30, 2, SIM_PL_RW, 0x7f, 0x7f, 0x00, sim_pl_do_adc_control, "PL-REG-25", "ADC_CONTROL"},
    {0x31, 2, SIM_PL_RW, 0xc7, 0xc7, 0x00, sim_pl_do_io_control, "PL-REG-26", "IO_CONTROL"},
    {0x32, 2, SIM_PL_RW, 0x3f, 0x3f, 0x00, sim_pl_do_cb_ctrl, "PL-REG-27", "CB_CTRL"},
    {0x33, 2, SIM_PL_RW, 0xbf, 0xbf, 0x00, sim_pl_do_cb_time, "PL-REG-28", "CB_TIME"},
    {0x34, 2, SIM_PL_RW, 0x00, 0x01, 0x00, sim_pl_do_convert, "PL-REG-29", "ADC_CONVERT"},
    {0x35, 0, SIM_PL_RESERVED, 0x00, 0x00, 0x00, NULL, "PL-REG-30", "reserved"}, /* 0x35..0x39 */
    {0x3a, 2, SIM_PL_RW, 0x00, 0xff, 0x00, sim_pl_do_shadow, "PL-REG-31", "SHDW_CTRL"},
    {0x3b, 2, SIM_PL_RW, 0x3f, 0xbf, 0x00, sim_pl_do_address, "PL-REG-32", "ADDRESS_CONTROL"},
    {0x3c, 2, SIM_PL_W, 0x00, 0xff, 0x00, sim_pl_do_reset, "PL-REG-33", "RESET"},
    {0x3d, 2, SIM_PL_RW, 0xff, 0xff, 0x00, sim_pl_do_test, "PL-REG-34", "TEST_SELECT"},
    {0x3e, 0, SIM_PL_RESERVED, 0x00, 0x00, 0x00, NULL, "PL-REG-35", "reserved"},
    {0x3f, 2, SIM_PL_RW, 0x00, 0xff, 0x00, sim_pl_do_e_en, "PL-REG-36", "E_EN"},
    {0x40, 3, SIM_PL_RW, 0xfc, 0xfc, 0x00, NULL, "PL-REG-37", "FUNCTION_CONFIG"},
    {0x41, 3, SIM_PL_RW, 0x01, 0x01, 0x00, NULL, "PL-REG-38", "IO_CONFIG"},
    {0x42, 3, SIM_PL_RW, 0xbf, 0xbf, 0x00, NULL, "PL-REG-39", "CONFIG_COV"},
    {0x43, 3, SIM_PL_RW, 0x9f, 0x9f, 0x00, NULL, "PL-REG-40", "CONFIG_COVT"},
    {0x44, 3, SIM_PL_RW, 0x9f, 0x9f, 0x00, NULL, "PL-REG-41", "CONFIG_CUV"},
    {0x45, 3, SIM_PL_RW, 0x9f, 0x9f, 0x00, NULL, "PL-REG-42", "CONFIG_CUVT"},
    {0x46, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-43", "CONFIG_OT"},
    {0x47, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-44", "CONFIG_OTT"},
    {0x48, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-45", "USER1"},
    {0x49, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-46", "USER2"},
    {0x4a, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-47", "USER3"},
    {0x4b, 3, SIM_PL_RW, 0xff, 0xff, 0x00, NULL, "PL-REG-48", "USER4"},
    {0x4c, 0, SIM_PL_RESERVED, 0x00, 0x00, 0x00, NULL, "PL-REG-49", "reserved"}, /* 0x4c..0xff */
};

/* The rows lie in address order: a row stands for all addresses up to the next row. */
const sim_pl_reg *sim_pl_reg_at(uint8_t address)
{
    size_t low = 0, high = sizeof table / sizeof table[0];

    while (high - low > 1) {
        size_t middle = (low + high) / 2;

        if (table[middle].address <= address) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return &table[low];
}

void sim_pl_reg_reset(sim_pl_dev *d)
{
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (table[i].group == 1 || table[i].group == 2) {
            d->reg[table[i].address] = table[i].reset;
        }
    }
}

uint8_t sim_pl_reg_keep(const sim_pl *s, const sim_pl_reg *r)
{
    if (s->options.variant_a && r->address == REG_FUNCTION) {
        return 0x3c; /* no ADCT */
    }
    if (s->options.variant_a && r->address == REG_IO_CONFIG) {
        return 0x81; /* CRCNOFLT */
    }
    return r->keep;
}

uint8_t sim_pl_reg_legal(const sim_pl *s, const sim_pl_reg *r)
{
    return s->options.variant_a && (r->address == REG_FUNCTION || r->address == REG_IO_CONFIG)
               ? sim_pl_reg_keep(s, r)
               : r->legal;
}
