/* SPDX-License-Identifier: MIT
 *
 * Without inih a configuration must be refused with a message, whatever is in
 * it.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "options/config.h"

static void test_refusal(void **state)
{
    struct config config = {0};
    struct glint_error error;

    (void)state;
    assert_int_equal(config_parse(&config, "x.ini", "", 0, &error), EXIT_INPUT);
    assert_string_equal(error.text,
                        "x.ini: --config: glint was built without inih");
    config_free(&config);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusal),
    };

    return cmocka_run_group_tests_name("config_absent", tests, NULL, NULL);
}
