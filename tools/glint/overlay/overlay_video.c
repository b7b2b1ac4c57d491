/* SPDX-License-Identifier: MIT
 *
 * Draws all frames of a video. glint reads and writes y4m files and pipes
 * itself; other videos are read and written by ffmpeg (ffmpeg.h).
 */
#include "overlay/overlay.h"
#include "overlay/overlay_y4m.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/picture.h"
#include "ffmpeg/ffmpeg.h"
#include "video/y4m.h"
#include "posix/ending.h"
#include "posix/error.h"

struct video {
    struct tool *tool;
    struct overlay *o;
    struct glint_error error;
    /* reads: whether ffmpeg decodes the input; writes: whether ffmpeg encodes
     * the output */
    bool reads, writes;
    struct ffmpeg_video about;
    struct child reader, writer;
    struct glint_output file; /* temporary file that ffmpeg writes */
    /* path of the pipe to ffmpeg, which OUT opens by name */
    char pipe[32];
    struct glint_y4m_reader in;
    struct glint_y4m_writer out;
    struct ffmpeg_times times;
    /* is_variable: whether the intervals of the input's frames vary;
     * keeps_times: whether the output has the frame times of the input */
    bool is_variable, keeps_times;
    /* whether the program that reads the output has closed the pipe */
    bool is_closed;
    /* whether the end of the input was read, rather than only the last frame of
     * --frames */
    bool has_ended;
};

static bool is_y4m_name(const char *name)
{
    return strcmp(name, "-") == 0 || glint_y4m_has_extension(name);
}

bool overlay_is_video(const char *name)
{
    return is_y4m_name(name) || ffmpeg_is_video(name);
}

int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video)
{
    const int n = glint_gif_count_frames(o->input);
    const bool moves =
        overlay_is_video(o->output) || glint_has_extension(o->output, ".gif");

    *video = n > 1 && moves;
    if (glint_has_extension(o->output, ".gif") && overlay_is_video(o->input))
        *video = true;
    else if (n == 1 && overlay_is_video(o->output))
        return tool_usage(
            tool, "%s has only one frame, so the output cannot be a video",
            o->input);
    else if (n > 1 && !moves && !tool->quiet)
        fprintf(stderr,
                "glint overlay: %s has %d frames; only the first is drawn. -o "
                "NAME.gif or NAME.mp4 draws all\n",
                o->input, n);
    return EXIT_OK;
}

/* ----------------------------------------------------------------- opening */

static int report_video_failure(struct video *v, enum glint_status status)
{
    return tool_fail(v->tool, status, v->error.text);
}

static ptrdiff_t read_ffmpeg_output(void *ctx, void *dst, size_t bytes)
{
    struct child *child = ctx;
    ssize_t n;

    do
        n = read(child->fd, dst, bytes);
    while (n < 0 && errno == EINTR);
    child_forward_messages(child);
    return n;
}

/* Returns whether the output can have the sound, tags and frame times of the
 * input. A GIF cannot, nor a video of which --frames omits the end. */
static bool can_keep_other_streams(const struct overlay *o)
{
    return !glint_has_extension(o->output, ".gif") && o->last == INT_MAX;
}

/* Sets range, matrix and transfer of the input by its tags. Prints a warning if
 * a tag is unknown, or if a video with primaries other than BT.709 has no
 * transfer tag. */
static void set_input_colour_tags(struct video *v)
{
    static const char *const matrices[] = {"601", "709", "2020"};
    struct glint_y4m_header *const h = &v->in.header;
    char unknown[FFMPEG_REPORT];

    ffmpeg_set_y4m_colour_tags(&v->about, h, unknown);
    if (!*unknown && !*v->about.transfer &&
        h->primaries != GLINT_PRIMARIES_BT709)
        snprintf(unknown, sizeof unknown, ", no transfer");
    if (*unknown && !v->tool->quiet)
        fprintf(stderr,
                "glint overlay: %s: tagged with %s; read with matrix %s and "
                "transfer %s, see --matrix and --transfer\n",
                v->o->input, unknown + 2,
                matrices[v->o->matrix ? v->o->matrix - 1 : (int)h->matrix],
                glint_transfer_words[v->o->transfer >= 0 ? v->o->transfer
                                                         : (int)h->transfer]);
}

/* Opens the input through ffmpeg, which prints its own errors. Returns an exit
 * code. */
static int open_input_by_ffmpeg(struct video *v)
{
    struct glint_input file;
    enum glint_status status =
        glint_input_open_file(&file, v->o->input, &v->error);

    if (status != GLINT_OK)
        return report_video_failure(v, status);
    glint_input_close(&file);
    ffmpeg_probe_video(&v->about, v->o->input);
    v->is_variable = ffmpeg_read_times(&v->times, v->o->input, &v->about);
    v->keeps_times = v->is_variable && v->writes &&
                     can_keep_other_streams(v->o) &&
                     ffmpeg_can_store_times(v->o->output) &&
                     !(v->o->encode && strstr(v->o->encode, "-vf")) &&
                     !(v->o->encode && strstr(v->o->encode, "-filter"));
    status = ffmpeg_start_reader(&v->reader, v->o->input, &v->about,
                                 v->keeps_times, &v->error);
    if (status != GLINT_OK)
        return report_video_failure(v, status);
    status = glint_y4m_reader_start(&v->in, read_ffmpeg_output, &v->reader,
                                    v->o->input, &v->error);
    if (status == GLINT_OK) {
        set_input_colour_tags(v);
        return EXIT_OK;
    }
    if (child_wait_for_exit(&v->reader) != 0)
        snprintf(v->error.text, sizeof v->error.text,
                 "%.180s: ffmpeg cannot read it", v->o->input);
    return report_video_failure(v, status == GLINT_E_MEMORY ? status
                                                            : GLINT_E_FORMAT);
}

/* Returns ffmpeg's name of the pixel format with samples as in LAYOUT. */
static const char *
find_pixel_format_of_layout(const struct glint_y4m_layout *layout)
{
    const char *const chroma = layout->format == GLINT_GREY   ? "gray"
                               : layout->format == GLINT_I444 ? "444"
                               : layout->format == GLINT_I422 ? "422"
                                                              : "420";

    return layout->has_alpha ? "yuva444p"
           : layout->is_411  ? "yuv411p"
                             : find_pixel_format(chroma, layout->bits);
}

/* Opens raw frames, which have no headers, as a video of 30 frames per
 * second. */
static enum glint_status open_raw_input(struct video *v)
{
    static const enum glint_pixel_format formats[] = {GLINT_I420, GLINT_I422,
                                                      GLINT_I444, GLINT_GREY};
    const struct overlay *const o = v->o;
    struct glint_y4m_header header;

    glint_y4m_header_init(&header, o->raw.width, o->raw.height,
                          formats[o->raw.format], 30, 1);
    return glint_y4m_reader_open_raw(&v->in, o->input, &header,
                                     (size_t)o->raw.stride, &v->error);
}

/* Appends to ERROR, of a pipe without Y4M header, how to read such frames. */
static void add_raw_format_hint(struct glint_error *error)
{
    const size_t used = strlen(error->text);

    snprintf(error->text + used, sizeof error->text - used,
             "; frames without headers need --format and --size");
}

static int open_video_input(struct video *v)
{
    struct glint_y4m_header *h = &v->in.header;
    const struct overlay *o = v->o;
    int code = EXIT_OK;

    if (v->reads) {
        code = open_input_by_ffmpeg(v);
    } else {
        const enum glint_status status =
            o->raw.width ? open_raw_input(v)
                         : glint_y4m_reader_open(&v->in, o->input, &v->error);

        if (status == GLINT_E_FORMAT && strcmp(o->input, "-") == 0)
            add_raw_format_hint(&v->error);
        if (status != GLINT_OK)
            code = report_video_failure(v, status);
        snprintf(v->about.pixels, sizeof v->about.pixels, "%s",
                 find_pixel_format_of_layout(&h->layout));
    }
    if (code == EXIT_OK && o->range)
        h->range = o->range == 1 ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED;
    if (code == EXIT_OK && o->matrix)
        h->matrix = (enum glint_matrix)(o->matrix - 1);
    if (code == EXIT_OK && o->transfer >= 0)
        h->transfer = (enum glint_transfer_curve)o->transfer;
    return code;
}

/* Starts ffmpeg, which reads y4m from a pipe and writes a temporary file next
 * to the output. */
static enum glint_status start_ffmpeg_encoder(struct video *v)
{
    const struct overlay *o = v->o;
    struct ffmpeg_target target = {
        .name = o->output,
        .sound = v->reads && can_keep_other_streams(o) ? o->input : NULL,
        .options = o->encode,
        .width = v->in.header.width,
        .height = v->in.header.height,
        .times = v->keeps_times ? &v->times : NULL,
        .is_444 = v->in.header.format == GLINT_I444,
        .range = v->in.header.range,
        .quiet = v->tool->quiet};
    enum glint_status status =
        glint_output_open(&v->file, o->output, GLINT_OUTPUT_BINARY, &v->error);

    if (status != GLINT_OK)
        return status;
    if (!v->file.tmp)
        return glint_error_report(
            &v->error, GLINT_E_OUTPUT, o->output,
            "is not a file; only .y4m can be written to a pipe");
    target.file = v->file.tmp;
    status = ffmpeg_start_writer(&v->writer, &target, &v->about, &v->error);
    if (status != GLINT_OK)
        return status;
    snprintf(v->pipe, sizeof v->pipe, "/proc/self/fd/%d", v->writer.fd);
    status = glint_y4m_writer_open(&v->out, v->pipe, &v->in.header, &v->error);
    close(v->writer.fd); /* The y4m writer has opened the pipe by its name. */
    v->writer.fd = -1;
    return status;
}

static int open_video_output(struct video *v)
{
    const enum glint_status status =
        v->writes ? start_ffmpeg_encoder(v)
                  : glint_y4m_writer_open(&v->out, v->o->output, &v->in.header,
                                          &v->error);

    return status == GLINT_OK ? EXIT_OK : report_video_failure(v, status);
}

/* ------------------------------------------------------------------ frames */

/* Draws on IMAGE, the frame read last, and writes it. Returns an exit code. */
static int draw_and_write_frame(struct video *v,
                                const struct glint_image *image)
{
    enum glint_status status;
    const int code = overlay_y4m_draw(v->tool, v->o, &v->in, image);

    if (code != EXIT_OK)
        return code;
    status = glint_y4m_writer_put_planes(&v->out, v->in.planes,
                                         overlay_y4m_frame_bytes(&v->in),
                                         v->in.frame_tags, &v->error);
    overlay_print_progress(v->tool, v->o);
    v->is_closed = status == GLINT_E_CLOSED;
    return status == GLINT_OK || v->is_closed ? EXIT_OK
                                              : report_video_failure(v, status);
}

static int draw_all_frames(struct video *v)
{
    const int *const at = &v->o->drawing.run.n_frames;
    const struct glint_image *image;
    int code = EXIT_OK;

    while (code == EXIT_OK && !v->is_closed && *at <= v->o->last) {
        const enum glint_status status =
            glint_y4m_reader_next(&v->in, &image, &v->error);

        v->has_ended =
            status == GLINT_E_CLOSED || (status == GLINT_OK && !image);
        if (v->has_ended)
            break;
        if (status != GLINT_OK)
            code = report_video_failure(v, status);
        else if (*at < v->o->first)
            code = overlay_find_lamps_only(v->tool, v->o, image);
        else
            code = draw_and_write_frame(v, image);
    }
    if (code == EXIT_OK && *at <= v->o->first && !v->is_closed) {
        fprintf(stderr, "glint overlay: %s: %s\n", v->in.name,
                *at > 0 ? "ends before the first frame of --frames"
                        : "has no frames");
        code = EXIT_INPUT;
    }
    return code;
}

/* Prints the first and last frame of each shot. A shot begins where tracking
 * and exposure restart. They restart in every frame without lamps; such frames
 * belong to the shot that follows them. */
static int print_shot_list(struct video *v)
{
    const int *const at = &v->o->drawing.run.n_frames;
    const struct glint_image *image;
    bool was_cut = true;
    int code = EXIT_OK, first = 0;

    while (code == EXIT_OK) {
        const enum glint_status status =
            glint_y4m_reader_next(&v->in, &image, &v->error);

        if (status != GLINT_OK)
            code = report_video_failure(v, status);
        else if (!image)
            break;
        else
            code = overlay_find_lamps_only(v->tool, v->o, image);
        if (code == EXIT_OK && v->o->is_cut && !was_cut) {
            printf("%d-%d\n", first, *at - 2);
            first = *at - 1;
        }
        was_cut = v->o->is_cut;
    }
    if (code == EXIT_OK && *at > 0)
        printf("%d-%d\n", first, *at - 1);
    return code;
}

/* Returns the mean interval between frames, microseconds; 40000 (25 frames per
 * second) if the rate is unknown. */
static int32_t compute_mean_frame_interval_us(const struct video *v)
{
    const struct glint_y4m_header *const header = &v->in.header;
    const struct ffmpeg_times *const t = &v->times;
    const double us =
        v->keeps_times        ? 1e6 * (t->at[t->n - 1] - t->at[0]) / (t->n - 1)
        : header->fps_num > 0 ? 1e6 * header->fps_den / header->fps_num
                              : 1e6 / 25;

    return (int32_t)fmin(fmax(us + 0.5, 1), 1e9);
}

/* ------------------------------------------------------------------ ending */

/* Waits until the decoder has ended. Returns an exit code, an error if the
 * input is truncated. */
static int wait_for_decoder(struct video *v)
{
    const int code = child_wait_for_exit(&v->reader);

    if (code == 0 && !v->reader.heard)
        return EXIT_OK;
    if (code != 0)
        fprintf(stderr,
                "glint overlay: %s: ffmpeg could not read the complete file\n",
                v->o->input);
    else
        fprintf(stderr,
                "glint overlay: %s is cut off after frame %d; 'ffmpeg -i IN -c "
                "copy OUT' makes a valid video of the existing frames\n",
                v->o->input, v->o->drawing.run.n_frames - 1);
    return EXIT_INPUT;
}

static int finish_encoder(struct video *v)
{
    enum glint_status status = glint_y4m_writer_commit(&v->out, &v->error);

    if (v->writes && child_wait_for_exit(&v->writer) != 0) {
        fprintf(stderr, "glint overlay: %s: ffmpeg could not write this file\n",
                v->o->output);
        return EXIT_OUTPUT;
    }
    /* An encoder that stops before the end, for example by -frames:v, has
     * written a valid file. */
    if (v->writes && (status == GLINT_OK || status == GLINT_E_CLOSED)) {
        status = ffmpeg_check_output(v->file.tmp, v->o->output, &v->error);
        if (status == GLINT_OK && !v->o->encode && !v->tool->quiet)
            ffmpeg_report_losses(v->file.tmp, v->o->output, &v->about);
        if (status == GLINT_OK)
            status = glint_output_commit(&v->file, &v->error);
    }
    return status == GLINT_OK ? EXIT_OK : report_video_failure(v, status);
}

/* Prints a warning if ffmpeg repeated or dropped frames to make a variable
 * frame rate constant. */
static void warn_of_variable_rate(const struct video *v)
{
    if (v->is_variable && !v->keeps_times && v->has_ended && !v->tool->quiet)
        fprintf(stderr,
                "glint overlay: %s: %d frames of a variable rate become %d at "
                "%d/%d per second; .mp4 .mov .mkv .webm preserve the time of "
                "each frame\n",
                v->o->output, v->times.n, v->o->drawing.run.n_frames,
                v->in.header.fps_num, v->in.header.fps_den);
}

static int add_flare_to_video_frames(struct video *v)
{
    int code = open_video_input(v);

    v->o->elapsed_us = compute_mean_frame_interval_us(v);
    if (code == EXIT_OK && v->o->lists_shots) {
        code = print_shot_list(v);
        return code == EXIT_OK && v->reads ? wait_for_decoder(v) : code;
    }
    if (code == EXIT_OK)
        code = open_video_output(v);
    if (code != EXIT_OK)
        return code;
    code = draw_all_frames(v);
    if (code == EXIT_OK && v->reads && v->has_ended)
        code = wait_for_decoder(v);
    if (code == EXIT_OK)
        warn_of_variable_rate(v);
    return code == EXIT_OK ? finish_encoder(v) : code;
}

/* Closes all open files and children and removes unfinished files. */
static void close_video_files(struct video *v)
{
    child_kill(&v->reader);
    child_kill(&v->writer);
    if (v->out.out.fd >= 0)
        glint_y4m_writer_abort(&v->out);
    if (v->writes)
        glint_output_abort(&v->file);
    glint_y4m_reader_close(&v->in);
    free(v->times.at);
}

int overlay_check_ffmpeg(const struct tool *tool, const struct overlay *o)
{
    if (((o->raw.width || is_y4m_name(o->input)) && is_y4m_name(o->output)) ||
        child_is_program_installed("ffmpeg"))
        return EXIT_OK;
    ffmpeg_print_manual_commands(tool, o->input, o->output);
    return EXIT_INPUT;
}

int overlay_draw_video(struct tool *tool, struct overlay *o)
{
    struct video v = {.tool = tool,
                      .o = o,
                      .reads = !o->raw.width && !is_y4m_name(o->input),
                      .writes = !is_y4m_name(o->output),
                      .reader = CHILD_NONE,
                      .writer = CHILD_NONE,
                      .file = {.fd = -1},
                      .in = {.in = {.fd = -1}},
                      .out = {.out = {.fd = -1}}};
    const int code = add_flare_to_video_frames(&v);

    close_video_files(&v);
    return code;
}
