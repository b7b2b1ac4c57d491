/* SPDX-License-Identifier: MIT
 *
 * Renders the frames of an animated scene in linear light, with the flare of
 * the scene's lights if there is a lens.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "overlay/apart.h"
#include "desk/render_file.h"
#include "glint/composite.h"
#include "options/numbered.h"
#include "overlay/drawing.h"
#include "ffmpeg/ffmpeg.h"
#include "overlay/overlay.h"
#include "formats/paint.h"
#include "render/render_scene.h"
#include "video/y4m.h"

/* Alignment of the run time's arenas, bytes. */
#define ALIGNMENT 64

struct frames {
    struct tool *tool;
    struct render_scene *r;
    struct drawing *c;
    bool is_y4m, is_numbered;
    int32_t elapsed_us; /* microseconds between frames; 0: a single frame */
    /* 8-bit picture of the scene, from which exposure and veil are computed */
    struct glint_image seen;
    int32_t *light_q20; /* linear light of the scene, [height][width][3] */
    /* linear light of the flare, [height][width][3]; NULL: there is no lens */
    float *flare;

    /* output video; unused for numbered images */
    struct glint_y4m_header header;
    struct glint_y4m_writer writer;
    struct glint_image frame;
    struct glint_composite *composite;
    void *tables;
    uint16_t *rgb_q16; /* three planes of RGB, Q16 */
};

/* ------------------------------------------------------------------ opening */

static int check_output_name(const struct tool *tool, struct frames *f)
{
    const struct render_scene *r = f->r;

    f->is_y4m = overlay_is_video(r->output) && !ffmpeg_is_video(r->output);
    f->is_numbered = numbered_is_pattern(r->output);
    if (ffmpeg_is_video(r->output))
        return tool_usage(tool,
                          "--frames writes a .y4m or numbered pictures; ffmpeg "
                          "-i OUT.y4m converts them to %s",
                          r->output);
    if (r->is_video && !f->is_y4m && !f->is_numbered)
        return tool_usage(tool, "--frames needs -o OUT.y4m, or %%04d in OUT "
                                "for one picture per frame");
    return EXIT_OK;
}

/* Opens the output video and initialises the conversion of linear light to the
 * video's codes. */
static enum glint_status open_output_video(struct frames *f,
                                           struct glint_error *error)
{
    const struct render_scene *r = f->r;
    const size_t n = (size_t)r->width * (size_t)r->height;
    const size_t bytes = glint_image_bytes(GLINT_I420, r->width, r->height);
    const double fps = r->fps;
    const int den = fps == rint(fps) ? 1 : 1000;
    uint8_t *const planes = malloc(bytes);

    glint_y4m_header_init(&f->header, r->width, r->height, GLINT_I420,
                          (int)lrint(fps * den), den);
    f->frame = (struct glint_image){.format = GLINT_I420,
                                    .width = r->width,
                                    .height = r->height,
                                    .range = f->header.range,
                                    .matrix = f->header.matrix,
                                    .transfer = GLINT_TONE_BT709};
    f->rgb_q16 = malloc(3 * n * sizeof *f->rgb_q16);
    if (!planes || !f->rgb_q16 ||
        posix_memalign(&f->tables, ALIGNMENT, glint_composite_bytes())) {
        free(planes);
        return GLINT_E_MEMORY;
    }
    glint_image_place(&f->frame, planes);
    glint_composite_init(&f->composite, &f->frame,
                         tool_enabled_instruction_sets(f->tool), 0, f->tables,
                         glint_composite_bytes());
    return glint_y4m_writer_open(&f->writer, r->output, &f->header, error);
}

static int open_frame_buffers(struct frames *f)
{
    const struct render_scene *r = f->r;
    const size_t n = 3 * (size_t)r->width * (size_t)r->height;
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    uint8_t *const codes = calloc(n, 1);

    f->light_q20 = malloc(n * sizeof *f->light_q20);
    if (f->c->files.has_lens)
        f->flare = malloc(n * sizeof *f->flare);
    f->seen = (struct glint_image){
        .format = GLINT_RGB24, .width = r->width, .height = r->height};
    if (codes)
        glint_image_place(&f->seen, codes);
    if (!codes || !f->light_q20 || (f->c->files.has_lens && !f->flare))
        return tool_fail(f->tool, GLINT_E_MEMORY, NULL);
    if (f->is_y4m)
        status = open_output_video(f, &error);
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(f->tool, status, error.text);
}

static void close_frame_buffers(struct frames *f)
{
    if (f->writer.out.fd >= 0)
        glint_y4m_writer_abort(&f->writer);
    free(f->seen.plane[0]);
    free(f->frame.plane[0]);
    free(f->light_q20);
    free(f->flare);
    free(f->tables);
    free(f->rgb_q16);
}

/* ------------------------------------------------------------------ drawing */

/* Computes the exposure and adds the flare of the scene's lights to the
 * picture. The lamps are already dimmed by the objects that occlude them. */
static enum glint_status add_flare_of_lights(struct frames *f)
{
    struct drawing *const c = f->c;
    const size_t n = 3 * (size_t)f->r->width * (size_t)f->r->height;
    enum glint_status status;

    status = drawing_set_exposure(c, &f->seen);
    if (status != GLINT_OK || !f->flare ||
        ((c->run.n_lamps == 0 || !(drawing_get_exposure_factor(&c->run) > 0)) &&
         !glint_engine_has_veil(c->run.engine)))
        return status;
    status = drawing_draw_layer(&c->run, 0, f->flare);
    for (size_t i = 0; status == GLINT_OK && i < n; i++)
        f->r->image.rgb[i] += f->flare[i];
    return status;
}

/* Draws frame number c->run.n_frames into r->image. */
static enum glint_status draw_scene_frame(struct frames *f)
{
    struct render_scene *const r = f->r;
    const size_t n = 3 * (size_t)r->width * (size_t)r->height;
    struct glint_image linear =
        glint_image_over(f->light_q20, GLINT_LINEAR_Q20, r->width, r->height);
    enum glint_status status = GLINT_OK;

    memset(f->light_q20, 0, n * sizeof *f->light_q20);
    if (f->c->files.has_lens && f->seen.plane[0]) {
        memset(f->seen.plane[0], 0, n);
        status = drawing_detect_and_draw_scene(f->c, &f->seen, f->elapsed_us);
        if (status == GLINT_OK)
            glint_scene_draw(f->c->files.scene.frame.scene, &linear);
    } else {
        f->c->files.scene.elapsed_us = f->elapsed_us;
        status =
            over_scene_draw(&f->c->files.scene, &linear, f->c->run.n_frames);
    }
    for (size_t i = 0; status == GLINT_OK && i < n; i++)
        r->image.rgb[i] = (float)ldexp(f->light_q20[i], -20);
    if (status == GLINT_OK && f->c->files.has_lens)
        status = add_flare_of_lights(f);
    for (size_t i = 0; status == GLINT_OK && i < n && r->exposure_ev != 0; i++)
        r->image.rgb[i] *= (float)exp2(r->exposure_ev);
    return status;
}

/* ------------------------------------------------------------------ writing */

static enum glint_status write_video_frame(struct frames *f,
                                           struct glint_error *error)
{
    const size_t n = (size_t)f->r->width * (size_t)f->r->height;
    const struct glint_layer layer = {
        {f->rgb_q16, f->rgb_q16 + n, f->rgb_q16 + 2 * n}, f->r->width};

    for (size_t i = 0; i < 3 * n; i++)
        f->rgb_q16[i % 3 * n + i / 3] =
            (uint16_t)lrintf(65535 * fminf(fmaxf(f->r->image.rgb[i], 0), 1));
    paint_set_image_black(&f->frame);
    glint_composite_add(f->composite, &f->frame, &layer);
    return glint_y4m_writer_put(&f->writer, &f->frame, "", error);
}

static int write_output_frame(struct frames *f, int number)
{
    struct glint_error error = {""};
    char name[NUMBERED_BYTES];
    enum glint_status status;

    if (f->is_y4m) {
        status = write_video_frame(f, &error);
        return status == GLINT_OK ? EXIT_OK
                                  : tool_fail(f->tool, status, error.text);
    }
    if (f->is_numbered && !numbered_make_name(name, f->r->output, number))
        return tool_usage(f->tool, "-o: the name of frame %d is too long",
                          number);
    return render_file_save(f->tool, f->is_numbered ? name : f->r->output,
                            f->r->linear, &f->r->image, 1);
}

static int finish_output_video(struct frames *f)
{
    struct glint_error error = {""};
    const enum glint_status status =
        f->is_y4m ? glint_y4m_writer_commit(&f->writer, &error) : GLINT_OK;

    return status == GLINT_OK || status == GLINT_E_CLOSED
               ? EXIT_OK
               : tool_fail(f->tool, status, error.text);
}

/* -------------------------------------------------------------- all frames */

static void print_run_summary(const struct frames *f, double ms)
{
    const struct render_scene *const r = f->r;
    struct json_writer json = {.to = stdout};
    char what[80];

    snprintf(what, sizeof what, "%d frames, %d to %d", r->last - r->first + 1,
             r->first, r->last);
    render_file_print_summary(f->tool, r->output, r->width, r->height, what,
                              1e-3 * ms);
    if (!f->tool->json || strcmp(r->output, "-") == 0)
        return;
    json_write(&json, "{engine: %s, frames: %d", "model",
               r->last - r->first + 1);
    over_scene_write_json(&json, &f->c->files.scene);
    json_write(&json, "lens: %s",
               f->c->files.has_lens ? f->c->files.lens.table.name : NULL);
    if (f->c->files.has_lens)
        settings_write_json(&json, &f->c->run.report);
    json_write(&json, "ms: %.3f}\n", ms);
}

static int render_all_frames(struct frames *f)
{
    struct render_scene *const r = f->r;
    const double start = tool_clock_s();
    int code = open_frame_buffers(f);

    for (int i = r->first; code == EXIT_OK && i <= r->last; i++) {
        enum glint_status status;

        f->c->run.n_frames = i;
        status = draw_scene_frame(f);
        code = status == GLINT_OK ? write_output_frame(f, i)
                                  : tool_fail(f->tool, status, NULL);
    }
    if (code == EXIT_OK)
        code = finish_output_video(f);
    if (code == EXIT_OK)
        code = drawing_finish_lamp_file(f->tool, f->c);
    if (code == EXIT_OK)
        print_run_summary(f, 1e3 * (tool_clock_s() - start));
    return code;
}

/* Rejects options of the drawing that glint render does not support for scenes.
 * Returns an exit code. */
static int check_drawing_options(const struct tool *tool,
                                 const struct drawing *c)
{
    if (c->line.settings.options.scene)
        return tool_usage(tool, "--scene applies to overlay, live and explain "
                                "only; render takes the scene as its input");
    if (c->line.settings.options.layer != GLINT_LAYER_COMPOSITE)
        return tool_usage(tool, "--layer applies to overlay and live only");
    return drawing_has_marks(&c->line)
               ? tool_usage(tool, "--show lights and --preview apply to "
                                  "overlay and live only")
               : EXIT_OK;
}

int render_frames(struct tool *tool, struct render_scene *r, const char *path)
{
    struct drawing *const c = &r->drawing;
    struct frames f = {.tool = tool, .r = r, .c = c, .writer.out.fd = -1};
    struct apart files = {.n_read = 0};
    int code = check_output_name(tool, &f);

    if (code == EXIT_OK)
        code = check_drawing_options(tool, c);
    if (code != EXIT_OK)
        return code;
    c->line.settings.options.scene = path;
    file_conflicts_add_drawing_files(&files, &c->line);
    file_conflicts_add_output(&files, "-o", r->output);
    code = file_conflicts_check_outputs(tool, &files);
    if (code != EXIT_OK)
        return code;
    c->line.scene_dials.edge_samples = r->samples;
    c->line.is_still = !r->is_video;
    if (r->is_video)
        f.elapsed_us = (int32_t)lrint(1e6 / r->fps);
    code = drawing_open(tool, c);
    /* no detection of lamps, because there is no photograph */
    c->files.is_listed = true;
    if (code == EXIT_OK)
        code = drawing_allocate(tool, c, r->width, r->height);
    if (code == EXIT_OK)
        code = render_all_frames(&f);
    close_frame_buffers(&f);
    return code;
}
