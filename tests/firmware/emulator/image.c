/* SPDX-License-Identifier: Apache-2.0 */
#include "image.h"
#include "unity.h"

#define VECTORS 98u

static void put(emu *e, uint32_t at, const void *bytes, size_t n)
{
    TEST_ASSERT_TRUE(emu_load(e, at, bytes, n));
}

static void vector(emu *e, unsigned number, uint32_t value)
{
    put(e, 0x08000000u + 4u * number, &value, 4);
}

emu *image_start(const emu_chip *chip, regs_world *w, const uint16_t *code, size_t bytes)
{
    static const uint16_t halt[] = {0xe7fe};
    emu_world world = regs_world_of(w);
    emu *e = emu_create(chip, &world);

    TEST_ASSERT_NOT_NULL(e);
    TEST_ASSERT_TRUE(emu_cpu_open(e));
    vector(e, 0, STACK_TOP);
    vector(e, 1, CODE | 1u);
    for (unsigned i = 2; i < VECTORS; i++) {
        vector(e, i, HALT | 1u);
    }
    put(e, HALT, halt, sizeof halt);
    put(e, CODE, code, bytes);
    return e;
}

uint32_t image_handler_at(unsigned number)
{
    return 0x08000000u + 0x800u * number;
}

void image_handler(emu *e, unsigned number, const uint16_t *code, size_t bytes)
{
    put(e, image_handler_at(number), code, bytes);
    vector(e, number, image_handler_at(number) | 1u);
}

emu_stop image_run(emu *e, uint64_t ns)
{
    emu_reset(e, EMU_CAUSE_POWER);
    return emu_run_until(e, emu_now(e) + ns);
}

uint32_t image_word(emu *e, uint32_t address)
{
    uint32_t v = 0;

    TEST_ASSERT_TRUE(emu_peek(e, address, &v, 4));
    return v;
}
