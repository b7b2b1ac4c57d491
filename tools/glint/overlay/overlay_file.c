/* SPDX-License-Identifier: MIT
 *
 * Draws on a picture file: opens it, adds scene and flare, and writes it.
 *
 * Opaque 8-bit sRGB is drawn on in place, in integers. For all other pictures
 * lamps are detected in an 8-bit proxy; the light of the lamps is measured in
 * floats if the file has floats, and the flare is added in linear light to the
 * samples that the flare changes. A file on which nothing is drawn is copied if
 * the output has the same type.
 */
#include "overlay/overlay.h"

#include <stdlib.h>
#include <string.h>

#include "overlay/drawing.h"
#include "overlay/grey.h"

struct overlay_file {
    /* 8-bit picture in which lamps are detected: the file's samples, or a
     * proxy */
    struct glint_image image;

    const char *from, *to;
    struct glint_kept kept;
    /* float copy of the input's samples, for an output file with floats */
    struct glint_samples work;
    /* is_direct: IMAGE is the file's samples, which are drawn on in place.
     * is_copied: the flare is added to WORK instead of the file's samples. */
    bool is_direct, is_copied;
    double white; /* linear light of the proxy's code 255 */
    float *layer;
};

static int report_file_failure(const struct tool *tool,
                               const struct overlay_file *f,
                               enum glint_status status)
{
    char text[256];

    snprintf(text, sizeof text, "%.200s: no memory for this picture", f->from);
    return tool_fail(tool, status, status == GLINT_E_MEMORY ? text : NULL);
}

/* ------------------------------------------------------------------ opening */

/* Sets f->work to a float copy of the input, which is needed if the output file
 * stores floats but the input does not. */
static enum glint_status convert_input_to_float(struct overlay_file *f)
{
    struct glint_samples *const from = &f->kept.samples;
    struct glint_samples like = *from;
    enum glint_status status;

    like.colour[0].sample = GLINT_SAMPLE_FLOAT;
    status = glint_kept_make_blank(&f->work, &like, from->has_alpha);
    if (status == GLINT_OK)
        glint_samples_convert(&f->work, from);
    f->is_copied = status == GLINT_OK;
    return status;
}

static enum glint_status choose_drawing_method(struct overlay_file *f,
                                               const struct drawing *drawing)
{
    const bool to_float = glint_picture_is_float(f->to) &&
                          !glint_kept_is_same_type(&f->kept, f->to);
    const bool has_own_layer =
        drawing->line.settings.options.layer == GLINT_LAYER_FLARE_ALPHA ||
        (drawing->line.settings.options.layer != GLINT_LAYER_COMPOSITE &&
         to_float);

    f->is_direct = !to_float && !has_own_layer &&
                   glint_samples_get_image(&f->kept.samples, &f->image);
    if (f->is_direct)
        return GLINT_OK;
    if (to_float &&
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE &&
        convert_input_to_float(f) != GLINT_OK)
        return GLINT_E_MEMORY;
    return glint_samples_make_proxy(&f->kept.samples, &f->image, &f->white);
}

static void close_picture_file(struct overlay_file *file)
{
    if (!file->is_direct)
        free(file->image.plane[0]);
    file->image.plane[0] = NULL;
    free(file->work.mem);
    file->work.mem = NULL;
    free(file->layer);
    file->layer = NULL;
    glint_kept_close(&file->kept);
}

/* Opens FROM, to be written to TO after drawing. Both strings must outlive
 * FILE. Returns an exit code. */
static int open_picture_file(const struct tool *tool, struct overlay_file *file,
                             const struct drawing *drawing, const char *from,
                             const char *to)
{
    struct glint_error error = {""};
    enum glint_status status;

    *file = (struct overlay_file){.from = from, .to = to, .white = 1};
    status = glint_kept_open(&file->kept, from, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    if (*file->kept.note && !tool->quiet)
        fprintf(stderr, "glint %s: %s: %s\n", tool->name, from,
                file->kept.note);
    status = choose_drawing_method(file, drawing);
    if (status == GLINT_OK)
        return EXIT_OK;
    close_picture_file(file);
    return report_file_failure(tool, file, status);
}

/* ------------------------------------------------------------------ drawing */

/* Draws scene and flare in grey on a monochrome picture. */
static enum glint_status draw_on_grey_image(struct overlay_file *f,
                                            struct drawing *drawing,
                                            int32_t elapsed_us)
{
    struct glint_image grey;
    uint8_t *const mem =
        malloc(glint_image_bytes(GLINT_GREY, f->image.width, f->image.height));
    enum glint_status status;

    if (!mem)
        return GLINT_E_MEMORY;
    grey = grey_copy_green(&f->image, mem);
    status = drawing_draw_flare(drawing, &grey, elapsed_us);
    grey_add_difference(&f->image, &grey);
    free(mem);
    return status;
}

static struct glint_samples *get_samples_to_draw_on(struct overlay_file *f)
{
    return f->is_copied ? &f->work : &f->kept.samples;
}

static bool is_flare_absent(const struct drawing *drawing)
{
    return !drawing->files.scene.is_open &&
           !glint_engine_has_veil(drawing->run.engine) &&
           (drawing->run.n_lamps == 0 ||
            !(drawing_get_exposure_factor(&drawing->run) > 0));
}

/* Copies the pixels of DRAWN that differ from BEFORE to the pixels of S, which
 * become opaque. BEFORE is the image before marks were drawn, without row
 * padding. */
static void copy_marks_to_samples(struct glint_samples *s,
                                  const struct glint_image *drawn,
                                  const uint8_t *before)
{
    const uint8_t *at = drawn->plane[0];
    struct glint_tone_curve srgb;

    glint_tone_curve_set(&srgb, GLINT_TONE_IS_SRGB, 0);
    for (int y = 0; y < drawn->height; y++)
        for (int x = 0; x < drawn->width; x++, at += 3, before += 3) {
            double rgb[3];

            if (memcmp(at, before, 3) == 0)
                continue;
            for (int c = 0; c < 3; c++)
                rgb[c] = glint_tone_curve_decode(&srgb, at[c] / 255.0);
            glint_samples_set_pixel(s, x, y, rgb, 1);
        }
}

/* Draws the marks of lamps on the proxy, and copies them to the samples. */
static enum glint_status draw_marks_on_proxy(struct overlay_file *f,
                                             struct drawing *drawing)
{
    const size_t bytes =
        glint_image_bytes(GLINT_RGB24, f->image.width, f->image.height);
    uint8_t *const before = malloc(bytes);

    if (!before)
        return GLINT_E_MEMORY;
    memcpy(before, f->image.plane[0], bytes);
    drawing_draw_marks(drawing, &f->image);
    copy_marks_to_samples(get_samples_to_draw_on(f), &f->image, before);
    free(before);
    return GLINT_OK;
}

/* Composites the scene over pixel (X, Y): the new pixel is pixel * (1 - HIDDEN)
 * + RGB. HIDDEN is the coverage by the scene. */
static void composite_scene_pixel(struct glint_samples *s, int x, int y,
                                  double hidden, const double rgb[3])
{
    double sum[3];
    float own[3];

    glint_samples_get_light(s, x, y, own);
    for (int c = 0; c < 3; c++)
        sum[c] = (double)own[c] * (1 - hidden) + rgb[c];
    glint_samples_set_pixel(s, x, y, sum, hidden);
}

/* Composites the scene drawn last over the samples of FILE. file->white is the
 * linear light of the scene's white. */
static enum glint_status draw_scene_on_samples(struct overlay_file *file,
                                               struct drawing *drawing,
                                               bool is_grey)
{
    const size_t width = (size_t)file->image.width;
    const size_t n = width * (size_t)file->image.height;
    struct over_scene_layer layer;
    const enum glint_status status =
        over_scene_make_layer(&drawing->files.scene, &layer);

    if (status != GLINT_OK)
        return status;
    if (is_grey)
        grey_convert_light(layer.rgb, n);
    for (size_t i = 0; i < n; i++) {
        const float *const from = layer.rgb + 3 * i;
        const double rgb[3] = {file->white * (double)from[0],
                               file->white * (double)from[1],
                               file->white * (double)from[2]};

        if (layer.cover_q8[i] || from[0] > 0 || from[1] > 0 || from[2] > 0)
            composite_scene_pixel(get_samples_to_draw_on(file),
                                  (int)(i % width), (int)(i / width),
                                  layer.cover_q8[i] / 256.0, rgb);
    }
    over_scene_layer_free(&layer);
    return GLINT_OK;
}

/* Prints a warning if scene and flare become grey because the file has a single
 * channel. */
static void warn_of_grey_result(const struct overlay_file *file,
                                const struct drawing *drawing)
{
    const struct tool *const tool = drawing->files.scene.tool;

    if (file->kept.samples.n_colours == 1 && drawing->files.scene.is_open &&
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE &&
        !tool->quiet)
        fprintf(stderr,
                "glint %s: %s has one channel, so objects and flare become "
                "grey; with three channels they have colours\n",
                tool->name, file->from);
}

/* Returns the accuracy that the flare of FILE needs: a flag of
 * glint_engine_draw_layer(), or 0 for that of floats. A layer of 8 bits may be
 * brightened later, as a picture of 16 bits. */
static unsigned choose_flare_accuracy(struct overlay_file *file,
                                      bool is_composite)
{
    const enum glint_sample sample =
        get_samples_to_draw_on(file)->colour[0].sample;

    if (sample == GLINT_SAMPLE_U8 && is_composite)
        return GLINT_ENGINE_CODES;
    return sample <= GLINT_SAMPLE_U16 && !glint_picture_is_float(file->to)
               ? GLINT_ENGINE_CODES_16
               : 0;
}

/* Draws the flare in linear light into the file's layer. If --layer is
 * composite, adds the layer and the marks of lamps to the samples. */
static enum glint_status draw_flare_layer(struct overlay_file *file,
                                          struct drawing *drawing, bool is_grey)
{
    const size_t n = (size_t)file->image.width * (size_t)file->image.height;
    const bool is_composite =
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE;
    const bool is_lit = !is_flare_absent(drawing);
    enum glint_status status = GLINT_OK;

    file->layer = calloc(3 * n, sizeof *file->layer);
    if (!file->layer)
        return GLINT_E_MEMORY;
    if (is_lit)
        status = drawing_draw_layer(&drawing->run,
                                    choose_flare_accuracy(file, is_composite),
                                    file->layer);
    if (status != GLINT_OK)
        return status;
    if (is_grey)
        grey_convert_light(file->layer, n);
    if (is_composite && is_lit)
        glint_samples_add_light(get_samples_to_draw_on(file), file->layer);
    return is_composite && drawing_has_marks(&drawing->line)
               ? draw_marks_on_proxy(file, drawing)
               : GLINT_OK;
}

/* Draws on samples that are not plain 8-bit codes. Detects lamps in the proxy,
 * corrects their light by the samples, then adds scene and flare. */
static enum glint_status draw_on_non_8_bit_samples(struct overlay_file *file,
                                                   struct drawing *drawing,
                                                   bool is_grey,
                                                   int32_t elapsed_us)
{
    enum glint_status status =
        drawing_detect_and_draw_scene(drawing, &file->image, elapsed_us);

    if (status != GLINT_OK)
        return status;
    if (file->kept.is_float)
        drawing_measure_clipped_lamps(drawing, &file->kept.samples);
    if (drawing->files.scene.is_open &&
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE)
        status = draw_scene_on_samples(file, drawing, is_grey);
    if (status == GLINT_OK && drawing->files.has_lens) {
        status = drawing_set_exposure(drawing, &file->image);
        if (status == GLINT_OK)
            status = draw_flare_layer(file, drawing, is_grey);
    }
    drawing->run.n_frames++;
    return status;
}

/* Adds scene and flare to the overlay_file CTX. This is an overlay_draw_fn. */
static enum glint_status draw_flare_on_file(void *ctx, struct drawing *drawing,
                                            const struct glint_image *image,
                                            int32_t elapsed_us)
{
    struct overlay_file *const file = ctx;
    /* A scene over a file with three channels stays coloured, also over grey
     * pixels. */
    const bool is_grey =
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE &&
        !(drawing->files.scene.is_open &&
          get_samples_to_draw_on(file)->n_colours == 3) &&
        grey_is_monochrome(image);

    drawing->run.is_measured = file->kept.is_float;
    drawing->run.white = file->white;
    warn_of_grey_result(file, drawing);
    if (!file->is_direct)
        return draw_on_non_8_bit_samples(file, drawing, is_grey, elapsed_us);
    return is_grey ? draw_on_grey_image(file, drawing, elapsed_us)
                   : drawing_draw_flare(drawing, image, elapsed_us);
}

/* ------------------------------------------------------------------- saving */

/* Sets ALONE to a picture of only the flare, with floats if the output has
 * floats or alpha, else with the samples of the input. */
static enum glint_status make_flare_only_picture(const struct overlay_file *f,
                                                 const struct drawing *drawing,
                                                 struct glint_samples *alone)
{
    struct glint_samples like = f->kept.samples;
    const float *rgb = f->layer;
    enum glint_status status;
    float *to;

    if (drawing->line.settings.options.layer == GLINT_LAYER_FLARE_ALPHA ||
        glint_picture_is_float(f->to))
        like.colour[0].sample = GLINT_SAMPLE_FLOAT;
    status = glint_kept_make_blank(alone, &like,
                                   drawing->line.settings.options.layer ==
                                       GLINT_LAYER_FLARE_ALPHA);
    if (status != GLINT_OK)
        return status;
    if (drawing->line.settings.options.layer != GLINT_LAYER_FLARE_ALPHA) {
        glint_samples_add_light(alone, f->layer);
        return GLINT_OK;
    }
    to = (float *)(void *)alone->mem;
    for (size_t n = (size_t)alone->width * (size_t)alone->height; n > 0; n--) {
        float most = 0;

        for (int c = 0; c < 3; c++) {
            *to = rgb[c] > 0 ? rgb[c] : 0;
            most = *to > most ? *to : most;
            to++;
        }
        *to++ = most < 1 ? most : 1;
        rgb += 3;
    }
    return GLINT_OK;
}

/* Writes the output of F, or copies the input if nothing was drawn and the
 * types are the same. Sets IS_COPIED to whether it was copied. */
static enum glint_status write_picture(struct overlay_file *f,
                                       const struct drawing *drawing,
                                       struct glint_kept_options *options,
                                       bool *is_copied,
                                       struct glint_error *error)
{
    const bool own_layer =
        drawing->line.settings.options.layer != GLINT_LAYER_COMPOSITE &&
        !f->is_direct;
    struct glint_samples alone;
    enum glint_status status;

    *is_copied =
        is_flare_absent(drawing) &&
        drawing->line.settings.options.layer == GLINT_LAYER_COMPOSITE &&
        !drawing_has_marks(&drawing->line) && !options->quality &&
        glint_kept_is_same_type(&f->kept, f->to);
    if (*is_copied)
        return glint_kept_copy_file(&f->kept, f->to, error);
    if (!own_layer)
        return glint_kept_save(&f->kept, f->to, f->is_copied ? &f->work : NULL,
                               options, error);
    status = make_flare_only_picture(f, drawing, &alone);
    if (status != GLINT_OK)
        return status;
    status = glint_kept_save(&f->kept, f->to, &alone, options, error);
    free(alone.mem);
    return status;
}

/* Writes the picture to its output file and prints which properties were lost.
 * Returns an exit code. */
static int save_picture(const struct tool *tool, struct overlay_file *file,
                        struct overlay *o)
{
    struct glint_kept_options options = {.quality = o->quality};
    struct glint_error error = {""};
    const enum glint_status status =
        write_picture(file, &o->drawing, &options, &o->is_copied, &error);

    if (status != GLINT_OK)
        return *error.text ? tool_fail(tool, status, error.text)
                           : report_file_failure(tool, file, status);
    if (*options.said && !tool->quiet)
        fprintf(stderr, "glint %s: %s: %s\n", tool->name, file->to,
                options.said);
    return EXIT_OK;
}

/* ------------------------------------------------------------ picture file */

/* Draws on FILE, and writes and closes it. Returns an exit code. */
static int draw_opened_file(struct tool *tool, struct overlay *o,
                            struct overlay_file *file)
{
    int code = EXIT_OK;

    if (o->drawing.run.is_sized &&
        (file->image.width != o->drawing.run.view.width ||
         file->image.height != o->drawing.run.view.height)) {
        fprintf(stderr,
                "glint overlay: %s: is %dx%d, but the pictures before it are "
                "%dx%d\n",
                file->from, file->image.width, file->image.height,
                o->drawing.run.view.width, o->drawing.run.view.height);
        code = EXIT_INPUT;
    }
    if (code == EXIT_OK)
        code = overlay_draw_frame_by_callback(tool, o, &file->image,
                                              draw_flare_on_file, file);
    if (code == EXIT_OK)
        code = save_picture(tool, file, o);
    close_picture_file(file);
    return code;
}

int overlay_draw_picture_file(struct tool *tool, struct overlay *o,
                              const char *from, const char *to)
{
    struct overlay_file file;
    const int code = open_picture_file(tool, &file, &o->drawing, from, to);

    return code == EXIT_OK ? draw_opened_file(tool, o, &file) : code;
}

int overlay_draw_single_picture(struct tool *tool, struct overlay *o)
{
    struct overlay_file file;
    double opening;
    int code = open_picture_file(tool, &file, &o->drawing, o->input, o->output);

    if (code != EXIT_OK)
        return code;
    drawing_line_follow_photo(&o->drawing.line, file.kept.f_number,
                              file.kept.focal_mm);
    opening = tool_clock_s();
    code = drawing_open(tool, &o->drawing);
    o->figures.started += tool_clock_s() - opening;
    if (code == EXIT_OK)
        return draw_opened_file(tool, o, &file);
    close_picture_file(&file);
    return code;
}
