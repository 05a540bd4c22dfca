/* SPDX-License-Identifier: Apache-2.0 */
#include "unity.h"
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct {
    const char *file;
    const char *test;
    int tests, failures, ignored, ended_early;
    jmp_buf leave;
} unity;

void UnityBegin(const char *file)
{
    memset(&unity, 0, sizeof unity);
    unity.file = file;
}

int UnityEnd(void)
{
    printf("\n%d Tests %d Failures %d Ignored\n%s\n", unity.tests, unity.failures, unity.ignored,
           unity.failures == 0 && unity.tests > 0 ? "OK" : "FAIL");
    if (unity.tests == 0) {
        return 1;
    }
    return unity.failures < 255 ? unity.failures : 255; /* an exit status holds 8 bits: 256 must not look like success */
}

void UnityDefaultTestRun(void (*function)(void), const char *name, int line)
{
    const char *only = getenv("UNITY_ONLY");
    if (only != NULL && strcmp(only, name) != 0) {
        return;
    }
    unity.test = name;
    unity.tests++;
    unity.ended_early = 0;
    if (setjmp(unity.leave) == 0) {
        setUp();
        function();
    }
    if (setjmp(unity.leave) == 0) {
        tearDown();
    }
    if (!unity.ended_early) {
        printf("%s:%d:%s:PASS\n", unity.file, line, name);
    }
}

static void leave(void)
{
    fflush(stdout);
    unity.ended_early = 1;
    longjmp(unity.leave, 1);
}

static void fail(int line, const char *detail, const char *message)
{
    unity.failures++;
    printf("%s:%d:%s:FAIL: %s%s%s\n", unity.file, line, unity.test, detail, message ? " " : "", message ? message : "");
    leave();
}

void UnityFailAt(int line, const char *message)
{
    fail(line, "", message);
}

void UnityIgnoreAt(int line, const char *message)
{
    unity.ignored++;
    printf("%s:%d:%s:IGNORE: %s\n", unity.file, line, unity.test, message ? message : "");
    leave();
}

void UnityAssert(int condition, int line, const char *text, const char *message)
{
    if (!condition) {
        fail(line, text, message);
    }
}

void UnityAssertInt(UNITY_INT expected, UNITY_INT actual, int line, const char *message)
{
    char text[96];
    if (expected != actual) {
        snprintf(text, sizeof text, "Expected %lld Was %lld", expected, actual);
        fail(line, text, message);
    }
}

void UnityAssertHex(UNITY_UINT expected, UNITY_UINT actual, int digits, int line, const char *message)
{
    char text[96];
    UNITY_UINT mask = (1ull << (digits * 4)) - 1u;
    if ((expected & mask) != (actual & mask)) {
        snprintf(text, sizeof text, "Expected 0x%0*llX Was 0x%0*llX", digits, expected & mask, digits, actual & mask);
        fail(line, text, message);
    }
}

void UnityAssertWithin(UNITY_INT delta, UNITY_INT expected, UNITY_INT actual, int line, const char *message)
{
    char text[128];
    UNITY_INT difference = actual > expected ? actual - expected : expected - actual;
    if (difference > delta) {
        snprintf(text, sizeof text, "Values Not Within Delta %lld Expected %lld Was %lld", delta, expected, actual);
        fail(line, text, message);
    }
}

void UnityAssertOrder(UNITY_INT bound, UNITY_INT actual, int relation, int line, const char *message)
{
    char text[128];
    const char *name = relation == 1 ? "greater than" : relation == 2 ? "at least" : relation == -1 ? "less than" : "at most";
    int holds = relation == 1 ? actual > bound : relation == 2 ? actual >= bound : relation == -1 ? actual < bound : actual <= bound;
    if (!holds) {
        snprintf(text, sizeof text, "Expected %s %lld Was %lld", name, bound, actual);
        fail(line, text, message);
    }
}

void UnityAssertString(const char *expected, const char *actual, int line, const char *message)
{
    char text[1200];
    int same = expected == actual || (expected && actual && strcmp(expected, actual) == 0);
    if (!same) {
        snprintf(text, sizeof text, "Expected '%.500s' Was '%.500s'", expected ? expected : "NULL", actual ? actual : "NULL");
        fail(line, text, message);
    }
}

void UnityAssertMemory(const void *expected, const void *actual, unsigned long size, int line, const char *message)
{
    char text[96];
    const unsigned char *e = expected, *a = actual;
    for (unsigned long i = 0; i < size; i++) {
        if (e[i] != a[i]) {
            snprintf(text, sizeof text, "Byte %lu Expected 0x%02X Was 0x%02X", i, e[i], a[i]);
            fail(line, text, message);
        }
    }
}

void UnityAssertDoubleWithin(double delta, double expected, double actual, int line, const char *message)
{
    char text[128];
    double difference = actual > expected ? actual - expected : expected - actual;
    if (!(difference <= delta)) {
        snprintf(text, sizeof text, "Expected %.9g Was %.9g (delta %.3g)", expected, actual, delta);
        fail(line, text, message);
    }
}
