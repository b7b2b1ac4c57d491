/* SPDX-License-Identifier: MIT
 *
 * Checks that recordings in JSON are read with both sets of key names and with
 * tolerated deviations, and that errors have their line numbers.
 */
#include "glint/scene/motion_bake.h"
#include "support/test.h"
#include "support/tracks/tracks.h"

struct text {
    const char *at;
    size_t left, most; /* bytes not yet read; max bytes per read */
};

static long read_recording_text(void *ctx, char *to, size_t n)
{
    struct text *t = ctx;

    n = n < t->left ? n : t->left;
    n = n < t->most ? n : t->most;
    memcpy(to, t->at, n);
    t->at += n;
    t->left -= n;
    return (long)n;
}

struct baked {
    unsigned char *data;
    size_t bytes;
    struct glint_motion motion;
    struct glint_motion_report report;
    struct glint_error error;
};

/* Bakes TEXT, which is read in pieces of at most MOST bytes. */
static enum glint_status bake_recording_text(const char *text, size_t most,
                                             struct baked *baked)
{
    struct text t = {text, strlen(text), most};
    struct glint_motion_baker *baker;
    enum glint_status status;
    const char *reason;

    memset(baked, 0, sizeof *baked);
    baker = glint_motion_baker_open();
    assert_non_null(baker);
    status = glint_recording_read(baker, "run.json", read_recording_text, &t,
                                  &baked->error);
    if (status == GLINT_OK)
        status = glint_motion_baker_finish(baker, "run", 7, &baked->data,
                                           &baked->bytes, &baked->report,
                                           &baked->error);
    glint_motion_baker_close(baker);
    if (status == GLINT_OK) {
        test_free_later(baked->data);
        assert_ok(glint_motion_open(&baked->motion, baked->data, baked->bytes,
                                    &reason));
    }
    return status;
}

/* A recording of two frames with the alternative key names. The two %s are the
 * values of its keys STRUCTURE and FRAMES. */
#define BODY                                                                 \
    "\"structure\": {\"size\": .5e0, \"sensors\": [{\"theta\": 0, \"phi\": " \
    "0}], \"angleofview\": 60}"
#define FOODS(x)                                                         \
    "[{\"x\":" x ",\"y\":0,\"z\":0},{\"x\":0,\"y\":1,\"z\":0},{\"x\":0," \
    "\"y\":0,\"z\":1},{\"x\":1,\"y\":1,\"z\":1}]"
#define BODY_0                                                              \
    "\"structure\": {\"size\": 0.5, \"sensors\": [{\"theta\": 0, \"phi\": " \
    "0}], \"angleofview\": 60}"
#define RUN(frames) "{" BODY_0 ", \"frames\": [" frames "]}"
#define FRAME       "{\"foods\": " FOODS("2") "}"

static void bake_must_fail(const char *text, const char *why)
{
    struct baked baked;

    assert_int_equal(bake_recording_text(text, 1 << 20, &baked), GLINT_E_LENS);
    if (!strstr(baked.error.text, why))
        fail_msg("'%s' does not contain '%s'", baked.error.text, why);
    assert_null(baked.data);
}

TEST(rejects_invalid_recordings)
{
    bake_must_fail("", "run.json:1:1: the file ends within the recording");
    bake_must_fail("[]", "run.json:1:1: expected '{' here");
    bake_must_fail("{" BODY ", \"frames\": [" FRAME "]}", "invalid token");
    bake_must_fail("{\"frames\": [" FRAME "]}", "there is no structure");
    bake_must_fail("{" BODY_0 ", \"frames\": []}",
                   "the recording has no frames");
    bake_must_fail("{" BODY_0 "}", "the recording has no frames");
    bake_must_fail("{" BODY_0 ", \"frames\": 3}", "expected '['");
    bake_must_fail(RUN("{}"), "frame 0: the frame has no array 'foods'");
    bake_must_fail(RUN("3"), "frame 0: the frame is not a JSON object");
    bake_must_fail(RUN(FRAME ",\n {\"foods\": 5}"), "run.json:2:2: frame 1: ");
    bake_must_fail(RUN(FRAME ", {\"foods\": " FOODS("NaN") "}"),
                   "invalid token");
    bake_must_fail(RUN(FRAME ", {\"foods\": " FOODS("1e999") "}"), "overflow");
    bake_must_fail(RUN(FRAME ", {\"foods\": " FOODS("1e7") "}"),
                   "not within +-1e6");
    bake_must_fail(RUN(FRAME ", {\"foods\": " FOODS("\"2\"") "}"),
                   "'x' of food 0 is not a number");
    bake_must_fail(RUN(FRAME ", {\"foods\": [{\"x\": 1, \"z\": 2}]}"),
                   "frame 1: food 0 has no 'y'");
    bake_must_fail(RUN("{\"foods\": [{\"x\":1,\"y\":0,\"z\":0}]}"),
                   "fewer than three food items, too few");
    bake_must_fail(RUN(FRAME ", {\"foods\": "
                             "[{\"x\":1,\"y\":0,\"z\":0},{\"x\":1,\"y\":1,"
                             "\"z\":0},{\"x\":1,\"y\":0,\"z\":1}]}"),
                   "the number of food items differs");
    bake_must_fail(RUN("{\"frame_num\": 4, \"foods\": " FOODS(
                       "2") "}, {\"frame_num\": 6, \"foods\": " FOODS("2") "}"),
                   "frame 1: frames are missing: frame 6 follows frame 4");
    bake_must_fail(RUN("{\"frame_num\": 4, \"foods\": " FOODS(
                       "2") "}, {\"frame_num\": 4, \"foods\": " FOODS("2") "}"),
                   "out of order: frame 4 follows frame 4");
    bake_must_fail(RUN("{\"frame_num\": -1, \"foods\": " FOODS("2") "}"),
                   "'frame_num' is not a whole number");
    bake_must_fail(RUN("{\"rv\": [1, 2], \"foods\": " FOODS("2") "}"),
                   "'rv' needs three numbers [x, y, z]");
    bake_must_fail(RUN("{\"foods\": " FOODS("2")),
                   "']' does not match the opening '{'");
    bake_must_fail("{" BODY_0 ", \"frames\": [" FRAME
                   ", {\"foods\": [{\"x\": 1",
                   "the file ends within frame 1");
    bake_must_fail("{" BODY_0 ", " BODY_0 "}", "a second 'structure'");
    bake_must_fail(RUN(FRAME) " {", "text after the end of the recording");
    bake_must_fail("{\"structure\": {\"size\": -1, \"angleofview\": 60}}",
                   "the size of the body");
    bake_must_fail("{\"structure\": {\"size\": 1, \"angleofview\": 0}}",
                   "the angle of view");
    bake_must_fail("{\"structure\": {\"size\": 1}}",
                   "the structure has no 'angleofview'");
    bake_must_fail("{\"structure\": {\"angleofview\": 1, \"size\": 1, "
                   "\"sensors\": [{\"theta\": 1}]}}",
                   "a sensor has no 'phi'");
    bake_must_fail("{\"a\": [1, 2}", "'}' does not match the opening '['");
    bake_must_fail("{\"a\": \"b\nc\"}", "a string must end on its line");
    bake_must_fail("{\"a\" 1}", "expected ':'");
    bake_must_fail("{\"a\": , }", "expected a JSON value");
}

/* Checks that recordings are rejected whose foods (landmarks) are collinear, or
 * that lose three foods in one frame. */
TEST(rejects_recordings_that_cannot_be_localised)
{
#define LINE                                                             \
    "{\"foods\": [{\"x\":0,\"y\":0,\"z\":0},{\"x\":1,\"y\":0,\"z\":0},{" \
    "\"x\":2,\"y\":0,\"z\":0}]}"
#define GONE(a, b)                                                     \
    "{\"foods\": [{\"x\":2,\"y\":0,\"z\":0},{\"x\":0,\"y\":1,\"z\":0," \
    "\"reset\":" a "},{\"x\":0,\"y\":0,\"z\":1,\"reset\":" b           \
    "},{\"x\":1,\"y\":1,\"z\":1}]}"
    struct baked baked;

    bake_must_fail(RUN(LINE ", " LINE),
                   "frame 1: the food items with known positions lie on a "
                   "line, so the pose is ambiguous");
    bake_must_fail(RUN(FRAME ", " GONE("true", "1")),
                   "frame 1: fewer than three food items have known positions");
    assert_ok(
        bake_recording_text(RUN(FRAME ", " GONE("true", "false")), 9, &baked));
    assert_int_equal(baked.report.n_resets, 1);
}

/* Checks that unknown keys (also nested), trailing commas, any order of keys,
 * input in pieces of any size, and brackets and escapes in strings are
 * accepted. */
TEST(accepts_deviations_of_syntax)
{
    static const char text[] =
        "\n{\"made by\": \"a \\\" ] tool, }\", \"notes\": [1, {\"x\": [[], "
        "{},]},],\n"
        "\"frames\": [{\"foods\": " FOODS(
            "2") ", \"more\": {\"a\": [1, 2 , ] , } ,},\n" FRAME
                 " ,\n],\n" BODY_0 ",\n}\n";
    struct baked whole, bits;

    assert_ok(bake_recording_text(text, 1 << 20, &whole));
    assert_ok(bake_recording_text(text, 1, &bits));
    assert_int_equal(whole.bytes, bits.bytes);
    assert_memory_equal(whole.data, bits.data, whole.bytes);
    assert_int_equal(whole.motion.header.n_frames, 2);
    assert_int_equal(whole.motion.header.n_foods, 4);
    assert_int_equal(whole.motion.header.intensities, 0);
    assert_int_equal(whole.motion.header.size, 1 << 23);
}

static char *write_recording_file(const struct track_options *o, bool is_second)
{
    FILE *file = tmpfile();
    char *text;
    long n;

    assert_non_null(file);
    track_write_recording(o, is_second, 2, 60, file);
    n = ftell(file);
    rewind(file);
    text = malloc((size_t)n + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)n, file), n);
    text[n] = '\0';
    fclose(file);
    return text;
}

/* Checks that both sets of key names give the same motion, that `reset` in the
 * first frame has no effect, and the sums of the fields rv (rotation) and tv
 * (translation). */
TEST(both_sets_of_key_names_are_equal)
{
    const struct track_options o = {2, 500, 5, 60, 6, 11};
    char *first = write_recording_file(&o, false),
         *second = write_recording_file(&o, true);
    char *reset = strstr(first, "false");
    struct baked a, b;

    memcpy(reset, "true ", 5);
    assert_ok(bake_recording_text(first, 4096, &a));
    assert_ok(bake_recording_text(second, 4096, &b));
    assert_int_equal(a.motion.header.n_frames, 500);
    assert_int_equal(a.motion.header.n_events, b.motion.header.n_events);
    assert_int_equal(a.report.n_resets, 8);
    for (uint32_t k = 0; k < 500; k++) {
        struct glint_motion_frame f, g;

        assert_ok(glint_motion_frame(&a.motion, k, &f));
        assert_ok(glint_motion_frame(&b.motion, k, &g));
        assert_memory_equal(&f.pose, &g.pose, sizeof f.pose);
        assert_memory_equal(f.food, g.food, 5 * sizeof *f.food);
        assert_int_equal(f.intensity[4][1], 191);
        assert_int_equal(g.intensity[4][0], 128);
        assert_int_equal(g.intensity[4][1], 64);
    }
    assert_true(a.report.has_senses);
    print_message("  rv and tv sum up to a place %.1e away of %.1f\n",
                  a.report.senses_off, a.report.path);
    assert_true(a.report.senses_most < 1e-3);
    assert_true(a.report.residual < 3e-4 && a.report.bad_frames == 0);
    free(first);
    free(second);
}

/* Checks that a food (landmark) that moves without a `reset` in the recording
 * is reported as a residual. */
TEST(moving_food_is_reported)
{
    struct baked baked;

    assert_ok(bake_recording_text(RUN(FRAME ", {\"foods\": " FOODS("2.1") "}"),
                                  4096, &baked));
    assert_int_equal(baked.report.bad_frames, 1);
    assert_int_equal(baked.report.residual_frame, 1);
    assert_true(baked.report.residual > .02 && baked.report.residual < .1);
    assert_true(baked.motion.header.residual >=
                (uint32_t)(baked.report.residual * 0x1p24));
}
