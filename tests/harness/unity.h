/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file unity.h
 * A small test harness with the names of Unity, so that every test of this tree also compiles against the real one.
 * A test program defines setUp() and tearDown(), runs its functions with RUN_TEST between UNITY_BEGIN and UNITY_END,
 * and returns the value of UNITY_END (number of failures, at most 255; 1 if no test ran). A failed assertion ends its test function.
 * With UNITY_ONLY=NAME in the environment only that function runs.
 */
#ifndef UNITY_H
#define UNITY_H

#include <stdint.h>

#define UNITY_INT long long
#define UNITY_UINT unsigned long long

void setUp(void);
void tearDown(void);

void UnityBegin(const char *file);
int UnityEnd(void);
void UnityDefaultTestRun(void (*function)(void), const char *name, int line);
void UnityFailAt(int line, const char *message);
void UnityIgnoreAt(int line, const char *message);
void UnityAssert(int condition, int line, const char *text, const char *message);
void UnityAssertInt(UNITY_INT expected, UNITY_INT actual, int line, const char *message);
void UnityAssertHex(UNITY_UINT expected, UNITY_UINT actual, int digits, int line, const char *message);
void UnityAssertWithin(UNITY_INT delta, UNITY_INT expected, UNITY_INT actual, int line, const char *message);
void UnityAssertOrder(UNITY_INT bound, UNITY_INT actual, int relation, int line, const char *message);
void UnityAssertString(const char *expected, const char *actual, int line, const char *message);
void UnityAssertMemory(const void *expected, const void *actual, unsigned long size, int line, const char *message);
void UnityAssertDoubleWithin(double delta, double expected, double actual, int line, const char *message);

#define UNITY_BEGIN() UnityBegin(__FILE__)
#define UNITY_END() UnityEnd()
#define RUN_TEST(f) UnityDefaultTestRun(f, #f, __LINE__)

#define TEST_FAIL() UnityFailAt(__LINE__, (const char *)0)
#define TEST_FAIL_MESSAGE(m) UnityFailAt(__LINE__, (m))
#define TEST_IGNORE() UnityIgnoreAt(__LINE__, (const char *)0)
#define TEST_IGNORE_MESSAGE(m) UnityIgnoreAt(__LINE__, (m))

#define TEST_ASSERT(c) UnityAssert((c) != 0, __LINE__, #c, (const char *)0)
#define TEST_ASSERT_TRUE(c) UnityAssert((c) != 0, __LINE__, #c " is TRUE", (const char *)0)
#define TEST_ASSERT_FALSE(c) UnityAssert((c) == 0, __LINE__, #c " is FALSE", (const char *)0)
#define TEST_ASSERT_TRUE_MESSAGE(c, m) UnityAssert((c) != 0, __LINE__, #c, (m))
#define TEST_ASSERT_FALSE_MESSAGE(c, m) UnityAssert((c) == 0, __LINE__, #c, (m))
#define TEST_ASSERT_MESSAGE(c, m) UnityAssert((c) != 0, __LINE__, #c, (m))
#define TEST_ASSERT_NULL(p) UnityAssert((p) == 0, __LINE__, #p " is NULL", (const char *)0)
#define TEST_ASSERT_NOT_NULL(p) UnityAssert((p) != 0, __LINE__, #p " is not NULL", (const char *)0)
#define TEST_ASSERT_NOT_NULL_MESSAGE(p, m) UnityAssert((p) != 0, __LINE__, #p, (m))

#define TEST_ASSERT_EQUAL(e, a) UnityAssertInt((UNITY_INT)(e), (UNITY_INT)(a), __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_MESSAGE(e, a, m) UnityAssertInt((UNITY_INT)(e), (UNITY_INT)(a), __LINE__, (m))
#define TEST_ASSERT_NOT_EQUAL(e, a) UnityAssert((e) != (a), __LINE__, #e " != " #a, (const char *)0)
#define TEST_ASSERT_EQUAL_INT(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_INT_MESSAGE(e, a, m) TEST_ASSERT_EQUAL_MESSAGE(e, a, m)
#define TEST_ASSERT_EQUAL_INT16(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_INT32(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_INT64(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_UINT(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_UINT_MESSAGE(e, a, m) TEST_ASSERT_EQUAL_MESSAGE(e, a, m)
#define TEST_ASSERT_EQUAL_UINT8(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_UINT16(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_UINT32(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_UINT64(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_EQUAL_HEX8(e, a) UnityAssertHex((UNITY_UINT)(e), (UNITY_UINT)(a), 2, __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_HEX8_MESSAGE(e, a, m) UnityAssertHex((UNITY_UINT)(e), (UNITY_UINT)(a), 2, __LINE__, (m))
#define TEST_ASSERT_EQUAL_HEX16(e, a) UnityAssertHex((UNITY_UINT)(e), (UNITY_UINT)(a), 4, __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_HEX16_MESSAGE(e, a, m) UnityAssertHex((UNITY_UINT)(e), (UNITY_UINT)(a), 4, __LINE__, (m))
#define TEST_ASSERT_EQUAL_HEX32(e, a) UnityAssertHex((UNITY_UINT)(e), (UNITY_UINT)(a), 8, __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_CHAR(e, a) TEST_ASSERT_EQUAL(e, a)
#define TEST_ASSERT_INT_WITHIN(d, e, a)                                                                               \
    UnityAssertWithin((UNITY_INT)(d), (UNITY_INT)(e), (UNITY_INT)(a), __LINE__, (const char *)0)
#define TEST_ASSERT_INT_WITHIN_MESSAGE(d, e, a, m)                                                                    \
    UnityAssertWithin((UNITY_INT)(d), (UNITY_INT)(e), (UNITY_INT)(a), __LINE__, (m))
#define TEST_ASSERT_UINT_WITHIN(d, e, a) TEST_ASSERT_INT_WITHIN(d, e, a)
#define TEST_ASSERT_GREATER_THAN(t, a) UnityAssertOrder((UNITY_INT)(t), (UNITY_INT)(a), 1, __LINE__, (const char *)0)
#define TEST_ASSERT_GREATER_OR_EQUAL(t, a) UnityAssertOrder((UNITY_INT)(t), (UNITY_INT)(a), 2, __LINE__, (const char *)0)
#define TEST_ASSERT_LESS_THAN(t, a) UnityAssertOrder((UNITY_INT)(t), (UNITY_INT)(a), -1, __LINE__, (const char *)0)
#define TEST_ASSERT_LESS_OR_EQUAL(t, a) UnityAssertOrder((UNITY_INT)(t), (UNITY_INT)(a), -2, __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_STRING(e, a) UnityAssertString((e), (a), __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_STRING_MESSAGE(e, a, m) UnityAssertString((e), (a), __LINE__, (m))
#define TEST_ASSERT_EQUAL_MEMORY(e, a, n) UnityAssertMemory((e), (a), (unsigned long)(n), __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_MEMORY_MESSAGE(e, a, n, m) UnityAssertMemory((e), (a), (unsigned long)(n), __LINE__, (m))
#define TEST_ASSERT_EQUAL_HEX8_ARRAY(e, a, n) UnityAssertMemory((e), (a), (unsigned long)(n), __LINE__, (const char *)0)
#define TEST_ASSERT_EQUAL_UINT8_ARRAY(e, a, n) UnityAssertMemory((e), (a), (unsigned long)(n), __LINE__, (const char *)0)
#define TEST_ASSERT_DOUBLE_WITHIN(d, e, a) UnityAssertDoubleWithin((d), (e), (a), __LINE__, (const char *)0)

#endif
