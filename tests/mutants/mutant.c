/* SPDX-License-Identifier: Apache-2.0 */
#include "mutant.h"
#include <stdio.h>
#include <stdlib.h>

static unsigned long times;

static void report(void)
{
    printf("mutant acted %lu times\n", times);
}

void mutant_acted(void)
{
    if (times++ == 0) {
        atexit(report);
    }
}
