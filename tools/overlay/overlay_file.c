/* SPDX-License-Identifier: MIT */
#include "overlay/overlay_file.h"

#include <stdlib.h>
#include <string.h>

#include "overlay/compositor_layer.h"
#include "formats/kept_types.h"

static bool is_deep(const struct glint_samples *s)
{
    return s->colour[0].sample != GLINT_SAMPLE_U8;
}

static bool takes_float(const char *path)
{
    const struct glint_file_type *const type = glint_file_type_of(path);

    return type && type->takes_float && !type->takes_u8;
}

static int fail(const struct tool *tool, const struct overlay_file *f,
                enum glint_status status)
{
    char text[256];

    snprintf(text, sizeof text, "%.200s: no memory for this picture", f->from);
    return tool_fail(tool, status, status == GLINT_E_MEMORY ? text : NULL);
}

/* ------------------------------------------------------------------ opening */

/* Makes f->work, a copy of the input in floats to draw on, for an output that
 * has floats where the input has not. */
static enum glint_status deepen(struct overlay_file *f)
{
    struct glint_samples *const from = &f->kept.samples;
    struct glint_samples like = *from;
    enum glint_status status;

    like.colour[0].sample = GLINT_SAMPLE_FLOAT;
    status = glint_kept_blank(&f->work, &like, from->has_alpha);
    if (status == GLINT_OK)
        glint_samples_convert(&f->work, from);
    f->is_copied = status == GLINT_OK;
    return status;
}

static enum glint_status choose_way(struct overlay_file *f,
                                    const struct compositor *compositor)
{
    const bool to_float =
        takes_float(f->to) && !glint_kept_is_same_type(&f->kept, f->to);
    const bool has_own_layer =
        compositor->flare_alpha || (compositor->flare_only && to_float);

    f->is_direct = !to_float && !has_own_layer &&
                   glint_samples_image(&f->kept.samples, &f->image);
    if (f->is_direct)
        return GLINT_OK;
    if (to_float && !compositor->flare_only && deepen(f) != GLINT_OK)
        return GLINT_E_MEMORY;
    return glint_samples_proxy(&f->kept.samples, &f->image, &f->white);
}

int overlay_file_open(const struct tool *tool, struct overlay_file *file,
                      const struct compositor *compositor, const char *from,
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
    status = choose_way(file, compositor);
    if (status == GLINT_OK)
        return EXIT_OK;
    overlay_file_close(file);
    return fail(tool, file, status);
}

void overlay_file_close(struct overlay_file *file)
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

/* ------------------------------------------------------------------ drawing */

static struct glint_samples *drawn_on(struct overlay_file *f)
{
    return f->is_copied ? &f->work : &f->kept.samples;
}

static bool adds_nothing(const struct compositor *compositor)
{
    return compositor->n_lamps == 0 || !(compositor_scale(compositor) > 0);
}

/* Marks the lights on the proxy, and copies the marks to the samples. */
static enum glint_status mark(struct overlay_file *f,
                              struct compositor *compositor)
{
    const size_t bytes =
        glint_image_bytes(GLINT_RGB24, f->image.width, f->image.height);
    uint8_t *const before = malloc(bytes);

    if (!before)
        return GLINT_E_MEMORY;
    memcpy(before, f->image.plane[0], bytes);
    compositor_mark(compositor, &f->image);
    glint_samples_put(drawn_on(f), &f->image, before);
    free(before);
    return GLINT_OK;
}

enum glint_status overlay_file_draw(struct overlay_file *file,
                                    struct compositor *compositor,
                                    int32_t elapsed_us)
{
    const size_t n = 3 * (size_t)file->image.width * (size_t)file->image.height;
    enum glint_status status;

    compositor->is_measured = file->kept.is_float;
    if (file->is_direct)
        return compositor_draw(compositor, &file->image, elapsed_us);
    compositor_find(compositor, &file->image, elapsed_us);
    if (file->kept.is_float)
        compositor_measure(compositor, &file->kept.samples, file->white);
    compositor->white = file->white;
    compositor_expose(compositor, elapsed_us);
    file->layer = calloc(n, sizeof *file->layer);
    if (!file->layer)
        return GLINT_E_MEMORY;
    status = adds_nothing(compositor)
                 ? GLINT_OK
                 : compositor_draw_layer(compositor,
                                         is_deep(drawn_on(file)) ||
                                             compositor->flare_only,
                                         file->layer);
    if (status == GLINT_OK && !compositor->flare_only &&
        !adds_nothing(compositor))
        glint_samples_add(drawn_on(file), file->layer);
    if (status == GLINT_OK && !compositor->flare_only &&
        compositor->show_lights)
        status = mark(file, compositor);
    compositor->n_frames++;
    return status;
}

/* ------------------------------------------------------------------- saving */

/* Makes ALONE, a picture of the flare by itself, with the input's depth or
 * more. */
static enum glint_status make_layer(const struct overlay_file *f,
                                    const struct compositor *compositor,
                                    struct glint_samples *alone)
{
    struct glint_samples like = f->kept.samples;
    const float *rgb = f->layer;
    enum glint_status status;
    float *to;

    if (compositor->flare_alpha || takes_float(f->to))
        like.colour[0].sample = GLINT_SAMPLE_FLOAT;
    status = glint_kept_blank(alone, &like, compositor->flare_alpha);
    if (status != GLINT_OK)
        return status;
    if (!compositor->flare_alpha) {
        glint_samples_add(alone, f->layer);
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

static enum glint_status write(struct overlay_file *f,
                               const struct compositor *compositor,
                               struct glint_kept_options *options,
                               struct glint_error *error)
{
    const bool own_layer = compositor->flare_only && !f->is_direct;
    struct glint_samples alone;
    enum glint_status status;

    if (adds_nothing(compositor) && !compositor->flare_only &&
        !compositor->show_lights && !options->quality &&
        glint_kept_is_same_type(&f->kept, f->to))
        return glint_kept_copy(&f->kept, f->to, error);
    if (!own_layer)
        return glint_kept_save(&f->kept, f->to, f->is_copied ? &f->work : NULL,
                               options, error);
    status = make_layer(f, compositor, &alone);
    if (status != GLINT_OK)
        return status;
    status = glint_kept_save(&f->kept, f->to, &alone, options, error);
    free(alone.mem);
    return status;
}

int overlay_file_save(const struct tool *tool, struct overlay_file *file,
                      const struct compositor *compositor, int quality)
{
    struct glint_kept_options options = {.quality = quality};
    struct glint_error error = {""};
    const enum glint_status status = write(file, compositor, &options, &error);

    if (status != GLINT_OK)
        return *error.text ? tool_fail(tool, status, error.text)
                           : fail(tool, file, status);
    if (*options.said && !tool->quiet)
        fprintf(stderr, "glint %s: %s: %s\n", tool->name, file->to,
                options.said);
    return EXIT_OK;
}
