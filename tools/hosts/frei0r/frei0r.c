/* SPDX-License-Identifier: MIT
 *
 * The frei0r plug-in: adds a flare to pictures in ffmpeg, MLT, Kdenlive,
 * Shotcut and GStreamer.
 */
#include "frei0r/abi.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter/filter.h"
#include "glint/glint.h"
#include "model/lens_files.h"

enum { FRAME_US = 40000, HELP_BYTES = 512 };

static char help[FILTER_MAX][HELP_BYTES];

struct instance {
    struct filter *filter;
    struct filter_values values;
    struct glint_image image;
    double seconds; /* time of the last picture; NAN: none yet */
};

/* All numeric parameters of frei0r have the range 0 .. 1. */
int f0r_init(void)
{
    struct filter_parameter p;

    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (p.type == FILTER_NUMBER && (p.low != 0 || p.high != 1))
            snprintf(help[i], HELP_BYTES, "%s (0 to 1 stands for %g to %g)",
                     p.help, p.low, p.high);
        else
            snprintf(help[i], HELP_BYTES, "%s", p.help);
    return 1;
}

void f0r_deinit(void)
{
}

void f0r_get_plugin_info(struct f0r_plugin *info)
{
    struct filter_parameter p;
    int n = 0;

    while (filter_get_parameter(n, &p))
        n++;
    *info = (struct f0r_plugin){
        .name = "glint",
        .author = "glint",
        .kind = F0R_FILTER,
        .colour_model = F0R_BGRA,
        .frei0r_version = F0R_MAJOR,
        .minor_version = 1,
        .n_params = n,
        .explanation = "Lens flare: ghosts and starbursts of a real lens"};
}

void f0r_get_param_info(struct f0r_param *info, int index)
{
    static const enum f0r_type types[] = {[FILTER_NUMBER] = F0R_DOUBLE,
                                          [FILTER_SWITCH] = F0R_BOOL,
                                          [FILTER_TEXT] = F0R_STRING};
    struct filter_parameter p;

    if (filter_get_parameter(index, &p))
        *info = (struct f0r_param){.name = p.name,
                                   .type = (int)types[p.type],
                                   .explanation = help[index]};
}

static bool stop_at_first_lens(void *ctx, const char *name)
{
    (void)ctx, (void)name;
    return false;
}

/* Returns whether any lens is installed. This is checked when an instance is
 * created, because frei0r cannot report failures later. */
static bool has_installed_lenses(void)
{
    if (lens_files_visit_all(stop_at_first_lens, NULL) > 0)
        return true;
    fprintf(stderr, "glint frei0r: no lenses: neither in GLINT_LENSES nor in "
                    "lenses/ or share/glint/lenses/ above the plug-in; install "
                    "glint, or set GLINT_LENSES to a folder of .lens files\n");
    return false;
}

void *f0r_construct(unsigned width, unsigned height)
{
    struct instance *const i =
        has_installed_lenses() ? calloc(1, sizeof *i) : NULL;

    if (i && width - 1 < GLINT_MAX_SIDE && height - 1 < GLINT_MAX_SIDE)
        i->filter = filter_create("frei0r", (int)width, (int)height);
    if (!i || !i->filter) {
        free(i);
        return NULL;
    }
    filter_values_init(&i->values);
    i->image = (struct glint_image){
        .format = GLINT_XRGB8888, .width = (int)width, .height = (int)height};
    i->seconds = NAN;
    return i;
}

void f0r_destruct(void *instance)
{
    struct instance *const i = instance;

    if (i) {
        filter_destroy(i->filter);
        filter_values_free(&i->values);
    }
    free(i);
}

void f0r_set_param_value(void *instance, void *value, int index)
{
    struct filter_values *const values = &((struct instance *)instance)->values;
    struct filter_parameter p;

    if (!value || !filter_get_parameter(index, &p))
        return;
    if (p.type == FILTER_TEXT)
        filter_set_text(values, index, *(char **)value);
    else
        filter_set_number(values, index,
                          p.low + *(double *)value * (p.high - p.low));
}

void f0r_get_param_value(void *instance, void *value, int index)
{
    const struct filter_values *const values =
        &((struct instance *)instance)->values;
    struct filter_parameter p;

    if (!value || !filter_get_parameter(index, &p))
        return;
    if (p.type == FILTER_TEXT)
        *(const char **)value = values->text[index] ? values->text[index] : "";
    else
        *(double *)value = (values->number[index] - p.low) / (p.high - p.low);
}

/* Returns the microseconds since the last picture. A difference of ten seconds
 * or more is taken as milliseconds, because ffmpeg 5.1 passes the time times
 * 1000. For the first picture, after a jump back, and if the difference is
 * still ten seconds or more, returns the duration of a frame at 25 frames per
 * second. */
static int32_t compute_elapsed_us(const struct instance *i, double seconds)
{
    const double us = 1e6 * (seconds - i->seconds);
    const double frame = us < 1e7 ? us : us / 1000;

    return frame >= 0.5 && frame < 1e7 ? (int32_t)(frame + 0.5) : FRAME_US;
}

void f0r_update(void *instance, double seconds, const uint32_t *in,
                uint32_t *out)
{
    struct instance *const i = instance;

    if (in != out)
        memcpy(
            out, in,
            glint_image_bytes(GLINT_XRGB8888, i->image.width, i->image.height));
    glint_image_place(&i->image, out);
    filter_set_values(i->filter, &i->values);
    if (filter_draw_flare(i->filter, &i->image, compute_elapsed_us(i, seconds)))
        i->seconds = seconds;
}
