/* SPDX-License-Identifier: MIT
 *
 * Checks the values between and outside key frames, and that invalid files are
 * rejected.
 */
#include "desk/keys.h"
#include "support/test.h"

static enum glint_status parse_keys(struct keys *keys, const char *text,
                                    struct glint_error *error)
{
    return key_frames_parse_text(keys, "k.csv", text, strlen(text), error);
}

TEST(interpolates_values_between_keys)
{
    struct glint_error error = {""};
    struct keys k;

    assert_ok(parse_keys(&k,
                         "# remark\nframe, gain ,exposure,x,y\n10,1,-2,0,0\n"
                         "20,3,,100,\n\n30,,8,,50\r\n",
                         &error));
    assert_true(key_frames_have_column(&k, KEYS_GAIN) &&
                !key_frames_have_column(&k, KEYS_STRENGTH));
    assert_true(key_frames_interpolate_at(&k, KEYS_STRENGTH, 15, 7) == 7);
    assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 0, 7) == 1);
    assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 10, 7) == 1);
    assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 15, 7) == 2);
    assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 20, 7) == 3);
    assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 1000000, 7) == 3);
    /* An empty field is no key, so the value at frame 20 is interpolated from
     * frames 10 and 30. */
    assert_true(key_frames_interpolate_at(&k, KEYS_EXPOSURE, 20, 7) == 3);
    assert_true(key_frames_interpolate_at(&k, KEYS_X, 15, 7) == 50);
    assert_true(key_frames_interpolate_at(&k, KEYS_Y, 20, 7) == 25);
    key_frames_free(&k);
    assert_false(key_frames_have_column(&k, KEYS_GAIN));
}

/* Checks a file of many key frames: the two key frames around the requested
 * frame must be used. */
TEST(uses_the_right_two_of_many_keys)
{
    static char text[40000] = "frame,gain\n";
    struct glint_error error = {""};
    size_t at = strlen(text);
    struct keys k;

    for (int i = 0; i < 1000; i++) {
        const int frame = 3 * i, gain = i * i;

        at += (size_t)snprintf(text + at, sizeof text - at, "%d,%d\n", frame,
                               gain);
    }
    assert_ok(parse_keys(&k, text, &error));
    for (int i = 0; i < 999; i++) {
        assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 3 * i, 0) ==
                    i * i);
        assert_true(key_frames_interpolate_at(&k, KEYS_GAIN, 3 * i + 1, 0) ==
                    i * i + (2 * i + 1) * 1.0 / 3);
    }
    key_frames_free(&k);
}

TEST(rejects_wrong_key_files)
{
    static const char *const bad[][2] = {
        {"0,1\n", "k.csv:1: '0' is not a column; the first line names"},
        {"gain\n1\n", "k.csv:1: the column 'frame' is missing"},
        {"frame,gain,gain\n", "k.csv:1: a column appears twice"},
        {"frame,wine\n",
         "k.csv:1: 'wine' is not a column; the first line names"},
        {"frame,exposure,strength\n",
         "k.csv:1: the columns strength and exposure"},
        {"frame,x\n", "k.csv:1: a light needs"},
        {"frame,ev\n", "k.csv:1: a light needs"},
        {"frame,gain\n", "k.csv: has no key frames"},
        {"", "k.csv: has no key frames"},
        {"frame,gain\n\n1\n", "k.csv:3: expected as many"},
        {"frame,gain\n1,2,3\n", "k.csv:2: expected as many"},
        {"frame,gain\n1,a\n", "k.csv:2: each field must be a number"},
        {"frame,gain\n1,-1\n", "k.csv:2: gain must be"},
        {"frame,gain\n1,nan\n", "k.csv:2: "},
        {"frame,gain\n1.5,1\n", "k.csv:2: frame must be"},
        {"frame,gain\n,1\n", "k.csv:2: frame must be"},
        {"frame,gain\n-1,1\n", "k.csv:2: frame must be"},
        {"frame,gain\n2,1\n2,1\n", "k.csv:3: frame numbers must increase"},
        {"frame,f-number\n2,0\n", "k.csv:2: f-number must be"},
    };

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct glint_error error = {""};
        struct keys k;

        assert_int_equal(parse_keys(&k, bad[i][0], &error), GLINT_E_FORMAT);
        assert_ptr_equal(strstr(error.text, bad[i][1]), error.text);
        assert_int_equal(k.n[KEYS_FRAME], 0);
    }
}
