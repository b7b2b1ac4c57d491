/* SPDX-License-Identifier: MIT */
#include "support/test.h"

static struct CMUnitTest tests[64];
static size_t n_tests;
void (*test_opens)(void), (*test_closes)(void);
void (*test_before)(void), (*test_after)(void);

void test_register(const char *name, CMUnitTestFunction run)
{
    if (n_tests < sizeof tests / sizeof *tests)
        tests[n_tests] = (struct CMUnitTest){name, run, NULL, NULL, NULL};
    n_tests++;
}

void test_run_with_fixtures(void (*test)(void))
{
    if (test_before)
        test_before();
    test();
    if (test_after)
        test_after();
    test_free_memory();
}

static int set_up_test_group(void **state)
{
    (void)state;
    if (test_opens)
        test_opens();
    return 0;
}

static int tear_down_test_group(void **state)
{
    (void)state;
    if (test_closes)
        test_closes();
    return 0;
}

int main(int argc, char **argv)
{
    const char *const name = argc ? strrchr(*argv, '/') : NULL;

    if (n_tests > sizeof tests / sizeof *tests)
        return 99; /* the table of tests is full */
    return _cmocka_run_group_tests(name ? name + 1 : "tests", tests, n_tests,
                                   set_up_test_group, tear_down_test_group);
}
