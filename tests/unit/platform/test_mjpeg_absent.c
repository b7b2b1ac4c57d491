/* SPDX-License-Identifier: MIT
 *
 * Checks that an MJPEG camera is rejected with a message in a build without
 * libjpeg.
 */
#include "jpeg/mjpeg.h"
#include "support/test.h"

TEST(reports_that_libjpeg_is_missing)
{
    struct glint_mjpeg *decoder;
    struct glint_error error;

    assert_false(glint_mjpeg_available());
    assert_int_equal(glint_mjpeg_open(&decoder, "/dev/video0", 8, 8, &error),
                     GLINT_E_UNSUPPORTED);
    assert_null(decoder);
    assert_string_equal(error.text,
                        "/dev/video0: MJPEG: glint was built without libjpeg; "
                        "choose another format, or install it and build again");
    glint_mjpeg_close(decoder);
}
