/* SPDX-License-Identifier: Apache-2.0 */
/* A read is repeated without its register: it goes on where the pointer of the part stands. */
#include "x0_wrong.h"

static bool without_pointer(bool again)
{
    return again;
}

const x0_wrong wrong = {.without_pointer = without_pointer};
