/* SPDX-License-Identifier: MIT
 *
 * Checks that the type of a file is determined from the extension of its name.
 */
#include "posix/ending.h"
#include "support/test.h"
#include "video/y4m.h"

TEST(endings_match_in_any_case)
{
    assert_true(glint_has_extension("clip.y4m", ".y4m"));
    assert_true(glint_has_extension("in.d/CLIP.Y4M", ".y4m"));
    assert_true(glint_y4m_has_extension("CLIP.Y4m"));
    assert_false(glint_has_extension("clip.y4m2", ".y4m"));
    assert_false(glint_has_extension("clipy4m", ".y4m"));
    assert_false(glint_has_extension("4m", ".y4m"));
    assert_false(glint_has_extension(".y4m", ".y4m"));
    assert_false(glint_has_extension("", ".y4m"));
}

TEST(ending_is_that_of_the_last_path_component)
{
    assert_string_equal(glint_get_extension("a.b/flare.tar.gz"), ".gz");
    assert_string_equal(glint_get_extension("X.BMP"), ".BMP");
    assert_string_equal(glint_get_extension("x."), ".");
    assert_string_equal(glint_get_extension("folder.d/x"), "");
    assert_string_equal(glint_get_extension("/dev/stdout"), "");
    assert_string_equal(glint_get_extension("a/.hidden"), "");
    assert_string_equal(glint_get_extension("planar-f1.4"), "");
    assert_string_equal(glint_get_extension("-"), "");
    assert_string_equal(glint_get_extension(""), "");
}
