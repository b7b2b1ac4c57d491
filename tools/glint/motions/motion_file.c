/* SPDX-License-Identifier: MIT */
#include "motions/motion_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "posix/ending.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"
#include "model/names.h"

#define MAX_FILE_BYTES ((size_t)1 << 31)

bool motion_file_is_source(const char *argument)
{
    return glint_has_extension(argument, ".json");
}

bool motion_file_is_baked(const char *argument)
{
    return tool_has_magic(argument, GLINT_MOTION_MAGIC);
}

/* Reader state of a recording, and a hash of its contents */
struct reading {
    struct glint_input in;
    uint64_t key;
};

static long read_motion_bytes(void *ctx, char *to, size_t n)
{
    struct reading *reading = ctx;
    const ptrdiff_t some = glint_input_read_available(&reading->in, to, n);

    if (some > 0)
        tool_hash_into_key(&reading->key, to, (size_t)some);
    return (long)some;
}

static enum glint_status bake_motion_recording(const char *path,
                                               struct motion_file *file,
                                               struct glint_error *error)
{
    struct reading reading = {.key = TOOL_KEY_BEGIN};
    struct glint_motion_baker *baker = glint_motion_baker_open();
    enum glint_status status = GLINT_E_MEMORY;
    unsigned char *data = NULL;
    char name[64];

    if (baker)
        status = glint_input_open(&reading.in, path, error);
    if (status == GLINT_OK) {
        tool_copy_base_name(path, name);
        status = glint_recording_read(baker, path, read_motion_bytes, &reading,
                                      error);
        glint_input_close(&reading.in);
        if (status == GLINT_OK)
            status =
                glint_motion_baker_finish(baker, name, reading.key, &data,
                                          &file->bytes, &file->report, error);
    }
    if (status != GLINT_OK && error->text[0] &&
        strncmp(error->text, path, strlen(path)) != 0) {
        const struct glint_error cause = *error;

        glint_error_report(error, status, path, "%s", cause.text);
    }
    glint_motion_baker_close(baker);
    file->data = data;
    file->is_baked_now = true;
    return status;
}

enum glint_status motion_file_read(const char *path, const char *written,
                                   struct motion_file *file,
                                   struct glint_error *error)
{
    const char *reason = "";
    uint8_t *data = NULL;
    char self[TOOL_PATH_BYTES];
    enum glint_status status =
        tool_make_input_path("", path, written, self, error);

    *file = (struct motion_file){.data = NULL};
    if (status == GLINT_OK && motion_file_is_source(path)) {
        status = bake_motion_recording(path, file, error);
    } else if (status == GLINT_OK) {
        status = glint_input_read_whole_file(&data, &file->bytes, path,
                                             MAX_FILE_BYTES, error);
        /* malloc() has aligned the data, as baked motions require */
        file->data = data;
    }
    if (status != GLINT_OK ||
        glint_motion_open(&file->motion, file->data, file->bytes, &reason) ==
            GLINT_OK)
        return status;
    motion_file_close(file);
    return glint_error_report(error, GLINT_E_LENS, path, "%s", reason);
}

int motion_file_open(const struct tool *tool, const char *path,
                     struct motion_file *file)
{
    struct glint_error error = {""};
    const enum glint_status status =
        motion_file_read(path, tool->written, file, &error);
    const struct glint_motion_report *r = &file->report;

    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text[0] ? error.text : NULL);
    if (r->bad_frames && !tool->quiet)
        fprintf(
            stderr,
            "glint %s: %s: in %ld frames landmarks deviate from their "
            "positions "
            "by more than a thousandth of the extent, %.4g; most in frame %ld, "
            "by %.4g: landmarks moved, or the recording lacks a 'reset'\n",
            tool->name, path, r->bad_frames, r->span, r->residual_frame,
            r->residual);
    if (r->held_intensities && !tool->quiet)
        fprintf(stderr,
                "glint %s: %s: %ld intensities outside 0 .. 1 were clamped\n",
                tool->name, path, r->held_intensities);
    return EXIT_OK;
}

void motion_file_close(struct motion_file *file)
{
    free(file->data);
    *file = (struct motion_file){.data = NULL};
}

/* -------------------------------------------------------------------- poses */

/* Writes the pose of frame K as a line to TEXT[BYTES]. Returns the line's
 * length. */
static int print_pose_line(struct motion_file *file, uint32_t k, char *text,
                           size_t bytes)
{
    const double step = ldexp(1, -file->motion.header.unit_log2);
    struct glint_motion_frame f;

    if (glint_motion_frame(&file->motion, k, &f) != GLINT_OK)
        return 0; /* A file in memory has all poses, so this cannot happen. */
    return snprintf(
        text, bytes, "%u,%.9g,%.9g,%.9g,%.6f,%.6f,%.6f,%.6f\n", k,
        step * f.pose.at[0], step * f.pose.at[1], step * f.pose.at[2],
        ldexp(f.pose.turn_q14[0], -14), ldexp(f.pose.turn_q14[1], -14),
        ldexp(f.pose.turn_q14[2], -14), ldexp(f.pose.turn_q14[3], -14));
}

int motion_file_write_poses(const struct tool *tool, struct motion_file *file,
                            const char *to)
{
    enum { LINE = 160 };
    const uint32_t n = file->motion.header.n_frames;
    char *const text = malloc(((size_t)n + 1) * LINE);
    size_t bytes;
    int code;

    if (!text)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    bytes = (size_t)snprintf(text, LINE, "frame,x,y,z,qw,qx,qy,qz\n");
    for (uint32_t k = 0; k < n; k++)
        bytes += (size_t)print_pose_line(file, k, text + bytes, LINE);
    code = tool_save_file(tool, to, GLINT_OUTPUT_TEXT, text, bytes);
    free(text);
    return code;
}
