/* SPDX-License-Identifier: MIT
 *
 * Unit tests for cmocka that register themselves:
 *
 *   TEST(rejects_a_truncated_header)
 *   {
 *       assert_int_equal(read(bytes, 3), GLINT_E_FORMAT);
 *   }
 *
 * main(), in test.c, runs a program's tests in the order of the source.
 */
#ifndef GLINT_TESTS_SUPPORT_TEST_H
#define GLINT_TESTS_SUPPORT_TEST_H

/* Tests use these without including them again. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/memory.h"

#define TEST(name)                                            \
    static void test_##name(void);                            \
    static void run_##name(void **state)                      \
    {                                                         \
        (void)state;                                          \
        test_run_with_fixtures(test_##name);                  \
    }                                                         \
    __attribute__((constructor)) static void add_##name(void) \
    {                                                         \
        test_register("test_" #name, run_##name);             \
    }                                                         \
    static void test_##name(void)

/* Defines a function that runs before the first test, or after the last
 * test. */
#define TEST_OPEN  TEST_FIXTURE(open_tests, test_opens)
#define TEST_CLOSE TEST_FIXTURE(close_tests, test_closes)
#define TEST_FIXTURE(name, of)                                \
    static void name(void);                                   \
    __attribute__((constructor)) static void add_##name(void) \
    {                                                         \
        of = name;                                            \
    }                                                         \
    static void name(void)

/* Defines a function that runs before each test, or after each test. */
#define TEST_BEFORE TEST_FIXTURE(before_test, test_before)
#define TEST_AFTER  TEST_FIXTURE(after_test, test_after)

/* Uses existing functions as TEST_OPEN and TEST_CLOSE. */
#define TEST_GROUP(open, close)                                \
    __attribute__((constructor)) static void group_tests(void) \
    {                                                          \
        test_opens = open;                                     \
        test_closes = close;                                   \
    }                                                          \
    struct test_group

/* Checks that STATUS is GLINT_OK or EXIT_OK. */
#define assert_ok(status) assert_int_equal(status, 0)

void test_register(const char *name, CMUnitTestFunction run);
void test_run_with_fixtures(void (*test)(void));
extern void (*test_opens)(void), (*test_closes)(void);
extern void (*test_before)(void), (*test_after)(void);

#endif
