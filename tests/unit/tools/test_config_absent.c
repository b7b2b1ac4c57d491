/* SPDX-License-Identifier: MIT
 *
 * Checks that any configuration file is rejected with a message in a build
 * without inih.
 */
#include <stdint.h>

#include "options/config.h"
#include "support/test.h"

TEST(reports_that_inih_is_missing)
{
    struct config config = {0};
    struct glint_error error;

    assert_int_equal(config_parse(&config, "x.ini", "", 0, &error), EXIT_INPUT);
    assert_string_equal(error.text,
                        "x.ini: --config: glint was built without inih, which "
                        "reads these files");
    config_free(&config);
}
