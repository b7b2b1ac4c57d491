/* SPDX-License-Identifier: MIT */
#include "overlay/zoom_clip.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ffmpeg/ffmpeg.h"
#include "posix/error.h"
#include "video/y4m.h"

enum { ROW = 40, MOST_FRAMES = 10000000 };

/* Max focal length that key frames accept, mm. */
#define MOST_MM 1e5

static const char heading[] = "frame,zoom\n";

bool zoom_clip_parse(struct zoom_clip *clip, const char *text)
{
    char from[32];
    const size_t n = strcspn(text, "-");

    if (n == 0 || n >= sizeof from || text[n] != '-')
        return false;
    memcpy(from, text, n);
    from[n] = '\0';
    clip->is_asked = tool_parse_number(from, &clip->from) &&
                     tool_parse_number(text + n + 1, &clip->to) &&
                     clip->from >= 0 && clip->to >= 0 &&
                     clip->from <= MOST_MM && clip->to <= MOST_MM;
    snprintf(clip->label, sizeof clip->label, "--zoom %s", text);
    return clip->is_asked;
}

/* Returns the number of frames of the y4m file NAME, up to the first damaged
 * one; 0 if the file cannot be opened. */
static long count_y4m_frames(const char *name, struct glint_error *error)
{
    struct glint_y4m_reader in;
    const struct glint_image *frame;
    long n = 0;

    if (glint_y4m_reader_open(&in, name, error) != GLINT_OK)
        return 0;
    while (glint_y4m_reader_next(&in, &frame, error) == GLINT_OK && frame)
        n = in.n_frames;
    glint_y4m_reader_close(&in);
    return n;
}

/* Returns key frames that zoom by CLIP over N frames, in equal ratios for mm
 * and in equal steps for 0 .. 1, as text allocated by malloc(); NULL without
 * memory. */
static char *make_zoom_keys(const struct zoom_clip *clip, long n)
{
    const bool is_mm = clip->from > 1;
    const size_t room = sizeof heading + (size_t)n * ROW;
    char *const text = malloc(room);
    size_t at = sizeof heading - 1;

    if (!text)
        return NULL;
    memcpy(text, heading, sizeof heading);
    for (long k = 0; k < n; k++) {
        const double part = n > 1 ? (double)k / (double)(n - 1) : 0;
        const double zoom = is_mm
                                ? clip->from * pow(clip->to / clip->from, part)
                                : clip->from + (clip->to - clip->from) * part;

        at += (size_t)snprintf(text + at, room - at, "%ld,%.12g\n", k, zoom);
    }
    return text;
}

int zoom_clip_open(struct tool *tool, struct zoom_clip *clip, const char *input,
                   struct drawing_line *line)
{
    struct glint_error error = {""};
    long n;

    if (!clip->is_asked)
        return EXIT_OK;
    if ((clip->from > 1) != (clip->to > 1))
        return tool_usage(tool,
                          "--zoom %g-%g: both values must be mm, or both 0 to "
                          "1 of the zoom range",
                          clip->from, clip->to);
    if (line->settings.options.keys)
        return tool_usage(
            tool,
            "--zoom A-B excludes --keys; add a column zoom to the key frames");
    if (!input || strcmp(input, "-") == 0)
        return tool_usage(tool, "--zoom A-B needs a video in a file; otherwise "
                                "use --keys with a column zoom");
    n = glint_y4m_has_extension(input) ? count_y4m_frames(input, &error)
                                       : ffmpeg_count_frames(input);
    if ((n <= 0 || n > MOST_FRAMES) && !error.text[0])
        glint_error_report(
            &error, GLINT_E_FORMAT, input,
            "the number of frames, which --zoom A-B needs, is unknown or too "
            "large; use --keys with a column zoom");
    if (n <= 0 || n > MOST_FRAMES)
        return tool_fail(tool, GLINT_E_FORMAT, error.text);
    clip->keys = make_zoom_keys(clip, n);
    if (!clip->keys)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    line->settings.options.keys = clip->label;
    line->keys_text = clip->keys;
    return EXIT_OK;
}

void zoom_clip_close(struct zoom_clip *clip)
{
    free(clip->keys);
    clip->keys = NULL;
}
