/* SPDX-License-Identifier: MIT
 *
 * Without libjpeg an MJPEG camera must be refused with a message.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "jpeg/mjpeg.h"

static void test_refusal(void **state)
{
    struct glint_mjpeg *decoder;
    struct glint_error error;

    (void)state;
    assert_false(glint_mjpeg_available());
    assert_int_equal(glint_mjpeg_open(&decoder, "/dev/video0", 8, 8, &error),
                     GLINT_E_UNSUPPORTED);
    assert_null(decoder);
    assert_string_equal(error.text,
                        "/dev/video0: MJPEG: glint was built without libjpeg");
    glint_mjpeg_close(decoder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusal),
    };

    return cmocka_run_group_tests_name("mjpeg_absent", tests, NULL, NULL);
}
