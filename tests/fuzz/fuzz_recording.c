/* SPDX-License-Identifier: MIT
 *
 * Reads random bytes as a recording in JSON, in pieces of several sizes, and
 * bakes it. An accepted recording must open and have finite poses.
 *
 *     make fuzz FUZZ=recording SECONDS=60
 */
#include <math.h>

#include "fuzz/fuzz.h"
#include "glint/scene/motion_bake.h"

struct text {
    const uint8_t *at;
    size_t left, piece;
};

static long read_recording_text(void *ctx, char *to, size_t n)
{
    struct text *t = ctx;

    n = n < t->left ? n : t->left;
    n = n < t->piece ? n : t->piece;
    if (n)
        memcpy(to, t->at, n);
    t->at += n;
    t->left -= n;
    return (long)n;
}

static void check_baked_motion(const unsigned char *data, size_t bytes,
                               const struct glint_motion_report *report)
{
    struct glint_motion motion;
    struct glint_motion_frame frame;
    const char *reason;

    require(glint_motion_open(&motion, data, bytes, &reason) == GLINT_OK);
    require(motion.header.n_frames == (uint32_t)report->n_frames);
    for (uint32_t k = 0; k < motion.header.n_frames; k++)
        require(glint_motion_frame(&motion, k, &frame) == GLINT_OK);
    require(isfinite(report->residual) && isfinite(report->path));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct text text = {data + 1, size ? size - 1 : 0,
                        size ? 1 + (size_t)(data[0] >> 2) : 1};
    struct glint_motion_report report;
    struct glint_motion_baker *baker;
    struct glint_error error = {""};
    unsigned char *baked = NULL;
    size_t bytes = 0;
    enum glint_status status;

    if (!size)
        return 0;
    baker = glint_motion_baker_open();
    require(baker != NULL);
    status =
        glint_recording_read(baker, "x", read_recording_text, &text, &error);
    if (status == GLINT_OK)
        status = glint_motion_baker_finish(baker, "x", 1, &baked, &bytes,
                                           &report, &error);
    if (status == GLINT_OK)
        check_baked_motion(baked, bytes, &report);
    else
        require(status == GLINT_E_LENS && error.text[0]);
    free(baked);
    glint_motion_baker_close(baker);
    return 0;
}
