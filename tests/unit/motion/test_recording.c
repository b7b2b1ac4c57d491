/* SPDX-License-Identifier: MIT
 *
 * Recordings in JSON: both spellings, what is tolerated, and what is refused
 * with which line. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/motion_bake.h"
#include "support/test.h"
#include "support/tracks/tracks.h"

struct text {
    const char *at;
    size_t left, most; /* of one read */
};

static long read_text(void *ctx, char *to, size_t n)
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

/* Bakes TEXT, which comes in pieces of MOST bytes. */
static enum glint_status bake(const char *text, size_t most,
                              struct baked *baked)
{
    struct text t = {text, strlen(text), most};
    struct glint_motion_baker *baker;
    enum glint_status status;
    const char *reason;

    memset(baked, 0, sizeof *baked);
    baker = glint_motion_baker_open();
    assert_non_null(baker);
    status =
        glint_recording_read(baker, "run.json", read_text, &t, &baked->error);
    if (status == GLINT_OK)
        status = glint_motion_baker_finish(baker, "run", 7, &baked->data,
                                           &baked->bytes, &baked->report,
                                           &baked->error);
    glint_motion_baker_close(baker);
    if (status == GLINT_OK)
        assert_ok(glint_motion_open(&baked->motion, baked->data, baked->bytes,
                                    &reason));
    return status;
}

/* A recording of two frames in other words; STRUCTURE and FRAMES in its places.
 */
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

static void refused(const char *text, const char *why)
{
    struct baked baked;

    assert_int_equal(bake(text, 1 << 20, &baked), GLINT_E_LENS);
    if (!strstr(baked.error.text, why))
        fail_msg("'%s' does not say '%s'", baked.error.text, why);
    assert_null(baked.data);
}

TEST(bad_recordings_are_refused)
{
    refused("", "run.json:1:1: the text ends within the recording");
    refused("[]", "run.json:1:1: '{' is expected here");
    refused("{" BODY ", \"frames\": [" FRAME "]}", "invalid token");
    refused("{\"frames\": [" FRAME "]}", "there is no structure");
    refused("{" BODY_0 ", \"frames\": []}", "there are no frames");
    refused("{" BODY_0 "}", "there are no frames");
    refused("{" BODY_0 ", \"frames\": 3}", "'[' is expected");
    refused(RUN("{}"), "frame 0: the frame has no array 'foods'");
    refused(RUN("3"), "frame 0: the frame is not a JSON object");
    refused(RUN(FRAME ",\n {\"foods\": 5}"), "run.json:2:2: frame 1: ");
    refused(RUN(FRAME ", {\"foods\": " FOODS("NaN") "}"), "invalid token");
    refused(RUN(FRAME ", {\"foods\": " FOODS("1e999") "}"), "overflow");
    refused(RUN(FRAME ", {\"foods\": " FOODS("1e7") "}"), "not within +-1e6");
    refused(RUN(FRAME ", {\"foods\": " FOODS("\"2\"") "}"),
            "'x' of food 0 is not a number");
    refused(RUN(FRAME ", {\"foods\": [{\"x\": 1, \"z\": 2}]}"),
            "frame 1: food 0 has no 'y'");
    refused(RUN("{\"foods\": [{\"x\":1,\"y\":0,\"z\":0}]}"),
            "fewer than three foods");
    refused(RUN(FRAME ", {\"foods\": [{\"x\":1,\"y\":0,\"z\":0},{\"x\":1,"
                      "\"y\":1,\"z\":0},{\"x\":1,\"y\":0,\"z\":1}]}"),
            "the number of foods differs");
    refused(RUN("{\"frame_num\": 4, \"foods\": " FOODS(
                "2") "}, {\"frame_num\": 6, \"foods\": " FOODS("2") "}"),
            "frame 1: frames are missing: 6 follows 4");
    refused(RUN("{\"frame_num\": 4, \"foods\": " FOODS(
                "2") "}, {\"frame_num\": 4, \"foods\": " FOODS("2") "}"),
            "out of order: 4 follows 4");
    refused(RUN("{\"frame_num\": -1, \"foods\": " FOODS("2") "}"),
            "'frame_num' is not a whole number");
    refused(RUN("{\"rv\": [1, 2], \"foods\": " FOODS("2") "}"),
            "'rv' needs three numbers");
    refused(RUN("{\"foods\": " FOODS("2")), "']' closes what '{' opened");
    refused("{" BODY_0 ", \"frames\": [" FRAME ", {\"foods\": [{\"x\": 1",
            "the text ends within frame 1");
    refused("{" BODY_0 ", " BODY_0 "}", "a second 'structure'");
    refused(RUN(FRAME) " {", "text follows the end of the recording");
    refused("{\"structure\": {\"size\": -1, \"angleofview\": 60}}",
            "the size of the body");
    refused("{\"structure\": {\"size\": 1, \"angleofview\": 0}}",
            "the angle of view");
    refused("{\"structure\": {\"size\": 1}}",
            "the structure has no 'angleofview'");
    refused("{\"structure\": {\"angleofview\": 1, \"size\": 1, \"sensors\": "
            "[{\"theta\": 1}]}}",
            "a sensor has no 'phi'");
    refused("{\"a\": [1, 2}", "'}' closes what '[' opened");
    refused("{\"a\": \"b\nc\"}", "a string must end on its line");
    refused("{\"a\" 1}", "':' is expected");
    refused("{\"a\": , }", "a value is expected");
}

/* Collinear foods, and three that vanish at once. */
TEST(what_cannot_be_localised_is_refused)
{
#define LINE                                                             \
    "{\"foods\": [{\"x\":0,\"y\":0,\"z\":0},{\"x\":1,\"y\":0,\"z\":0},{" \
    "\"x\":2,\"y\":0,\"z\":0}]}"
#define GONE(a, b)                                                     \
    "{\"foods\": [{\"x\":2,\"y\":0,\"z\":0},{\"x\":0,\"y\":1,\"z\":0," \
    "\"reset\":" a "},{\"x\":0,\"y\":0,\"z\":1,\"reset\":" b           \
    "},{\"x\":1,\"y\":1,\"z\":1}]}"
    struct baked baked;

    refused(RUN(LINE ", " LINE),
            "frame 1: the foods with known positions lie on a line");
    refused(RUN(FRAME ", " GONE("true", "1")),
            "frame 1: fewer than three foods have known positions");
    assert_ok(bake(RUN(FRAME ", " GONE("true", "false")), 9, &baked));
    assert_int_equal(baked.report.n_resets, 1);
    free(baked.data);
}

/* Unknown keys, also deep ones, commas that trail, any order, pieces of any
 * size, brackets and escapes in strings. */
TEST(what_is_tolerated)
{
    static const char text[] =
        "\n{\"made by\": \"a \\\" ] tool, }\", \"notes\": [1, {\"x\": [[], "
        "{},]},],\n"
        "\"frames\": [{\"foods\": " FOODS("2") ", \"more\": {\"a\": [1, "
                                               "2 , ] , } ,},\n" FRAME
                                               " ,\n],\n" BODY_0 ",\n}\n";
    struct baked whole, bits;

    assert_ok(bake(text, 1 << 20, &whole));
    assert_ok(bake(text, 1, &bits));
    assert_int_equal(whole.bytes, bits.bytes);
    assert_memory_equal(whole.data, bits.data, whole.bytes);
    assert_int_equal(whole.motion.header.n_frames, 2);
    assert_int_equal(whole.motion.header.n_foods, 4);
    assert_int_equal(whole.motion.header.intensities, 0);
    assert_int_equal(whole.motion.header.size, 1 << 23);
    free(whole.data);
    free(bits.data);
}

static char *written(const struct track_options *o, bool is_second)
{
    FILE *file = tmpfile();
    char *text;
    long n;

    assert_non_null(file);
    track_write(o, is_second, 2, 60, file);
    n = ftell(file);
    rewind(file);
    text = malloc((size_t)n + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)n, file), n);
    text[n] = '\0';
    fclose(file);
    return text;
}

/* Both spellings say the same; `reset` in the first frame means nothing; row
 * D11: what rv and tv sum up to. */
TEST(both_spellings)
{
    const struct track_options o = {2, 500, 5, 60, 6, 11};
    char *first = written(&o, false), *second = written(&o, true);
    char *reset = strstr(first, "false");
    struct baked a, b;

    memcpy(reset, "true ", 5);
    assert_ok(bake(first, 4096, &a));
    assert_ok(bake(second, 4096, &b));
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
    free(a.data);
    free(b.data);
    free(first);
    free(second);
}

/* A food that moves without a reset is reported as a residual. */
TEST(a_food_that_moves_is_told)
{
    struct baked baked;

    assert_ok(bake(RUN(FRAME ", {\"foods\": " FOODS("2.1") "}"), 4096, &baked));
    assert_int_equal(baked.report.bad_frames, 1);
    assert_int_equal(baked.report.residual_frame, 1);
    assert_true(baked.report.residual > .02 && baked.report.residual < .1);
    assert_true(baked.motion.header.residual >=
                (uint32_t)(baked.report.residual * 0x1p24));
    free(baked.data);
}
