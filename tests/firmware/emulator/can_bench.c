/* SPDX-License-Identifier: Apache-2.0 */
#include "can_bench.h"

bool f0;

unsigned tx_irq(void)
{
    return f0 ? 30 : 19;
}

void clocked(const emu_chip *which)
{
    f0 = which == &emu_f072;
    outside_begin(which);
    set_bits(f0 ? 0x4002101cu : 0x40023840u, 1u << 25);
    pin_function(1, 8, f0 ? 4 : 9, false);
    pin_function(1, 9, f0 ? 4 : 9, false);
}

void init_mode(void)
{
    put(C_MCR, 0x00010001u); /* INRQ, SLEEP cleared */
    (void)UNTIL(C_MSR, 1);
    put(C_BTR, SEGMENTS | (f0 ? 0 : 1));
}

void normal_mode(uint32_t mcr)
{
    put(C_MCR, 0x00010000u | mcr);
    for (int i = 0; (get(C_MSR) & 3u) != 0 && i < 1000; i++) {
        pass(1 * US);
    }
    TEST_ASSERT_EQUAL(0, get(C_MSR) & 3u);
}

void filter(void)
{
    set_bits(C_FMR, 1);
    put(C_FS1R, 1);
    put(C_BANK(0, 0), 0x080u << 21);
    put(C_BANK(0, 1), 0x7f0u << 21 | 4u);
    put(C_FA1R, 1);
    put(C_FMR, get(C_FMR) & ~1u);
}

void ready(const emu_chip *which, uint32_t mcr)
{
    clocked(which);
    init_mode();
    put(C_MCR, 0x00010001u | mcr);
    filter();
    normal_mode(mcr);
}

void send(unsigned mailbox, uint32_t id, unsigned length)
{
    put(C_TX(mailbox, 4), length);
    put(C_TX(mailbox, 8), 0x44332211);
    put(C_TX(mailbox, 12), 0x88776655);
    put(C_TX(mailbox, 0), id << 21 | 1u);
}

void again(const emu_chip *which, uint32_t mcr)
{
    outside_end();
    ready(which, mcr);
}

bool hear(uint32_t id, bool extended)
{
    emu_can_frame f = {.id = id, .extended = extended, .length = 2, .data = {(uint8_t)id, 0xa5}};

    return emu_can_in(chip, 1, &f);
}
