/* SPDX-License-Identifier: Apache-2.0 */
/* Deliberate defects. With sanitizers compiled and linked in, each must kill the program; without a defect it ends well. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static volatile int one = 1;

static int heap_overflow(void)
{
    size_t size = 8u * (size_t)one; /* unknown to the compiler, so that no other check comes first */
    volatile char *room = malloc(size);
    if (!room) {
        return 2;
    }
    room[size] = 1;
    int kept = room[size];
    free((void *)room);
    return kept - 1;
}

static int signed_overflow(void)
{
    int value = INT_MAX;
    value += one;
    return value > 0;
}

int main(int argc, char **argv)
{
    const char *defect = argc > 1 ? argv[1] : "none";
    int status = strcmp(defect, "heap") == 0 ? heap_overflow() : strcmp(defect, "signed") == 0 ? signed_overflow() : 0;
    puts("survived");
    return status;
}
