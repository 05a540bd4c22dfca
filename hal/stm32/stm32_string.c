/* SPDX-License-Identifier: Apache-2.0 */
/* The C library's own forms of these are unrolled for speed and take 1.8 KB on a Cortex-M4, which the images
 * do not have. Compiled as freestanding code, or the compiler would make calls of the same functions out of
 * the loops. */
#include <stdint.h>
#include <string.h>

typedef uint32_t __attribute__((may_alias)) word;

/* From low to high addresses, by words where both sides allow it. */
static void copy_upward(void *to, const void *from, size_t n)
{
    unsigned char *t = to;
    const unsigned char *f = from;
    if ((((uintptr_t)t | (uintptr_t)f) & 3u) == 0u) {
        for (; n >= 4u; n -= 4u, t += 4, f += 4) {
            *(word *)(void *)t = *(const word *)(const void *)f;
        }
    }
    while (n-- > 0u) {
        *t++ = *f++;
    }
}

void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    copy_upward(to, from, n);
    return to;
}

void *memmove(void *to, const void *from, size_t n)
{
    unsigned char *t = to;
    const unsigned char *f = from;
    if (t <= f) {
        copy_upward(to, from, n);
    } else {
        while (n-- > 0u) {
            t[n] = f[n];
        }
    }
    return to;
}

void *memset(void *to, int value, size_t n)
{
    unsigned char *t = to;
    word whole = (unsigned char)value * 0x01010101u;
    if (((uintptr_t)t & 3u) == 0u) {
        for (; n >= 4u; n -= 4u, t += 4) {
            *(word *)(void *)t = whole;
        }
    }
    while (n-- > 0u) {
        *t++ = (unsigned char)value;
    }
    return to;
}

int memcmp(const void *a, const void *b, size_t n)
{
    const unsigned char *x = a, *y = b;
    for (; n > 0u; n--, x++, y++) {
        if (*x != *y) {
            return (int)*x - (int)*y;
        }
    }
    return 0;
}

size_t strlen(const char *s)
{
    size_t n = 0;
    while (s[n] != '\0') {
        n++;
    }
    return n;
}

int strcmp(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return (int)(unsigned char)*a - (int)(unsigned char)*b;
}
