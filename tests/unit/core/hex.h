/* SPDX-License-Identifier: Apache-2.0 */
/* Bytes written the way the requirements print them: "7f 3c a5 57". */
#ifndef TEST_HEX_H
#define TEST_HEX_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

static inline size_t hex_bytes(const char *text, uint8_t *out, size_t room)
{
    size_t n = 0;
    char *end;
    while (n < room) {
        unsigned long value = strtoul(text, &end, 16);
        if (end == text) {
            break;
        }
        out[n++] = (uint8_t)value;
        text = end;
    }
    return n;
}

#endif
