/* SPDX-License-Identifier: MIT
 *
 * The frei0r plug-in: what ffmpeg, MLT, Kdenlive, Shotcut and GStreamer call.
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

/* A parameter: a number, or a word if IS_WORD. */
struct parameter {
    const char *name, *about;
    enum f0r_type type;
    int which; /* a filter_number or a filter_word */
};

static const struct parameter parameters[] = {
    {"lens",
     "Lens by name, or a .lens or .glint file; empty: the style's, or "
     "nikon-zoom-short",
     F0R_STRING, FILTER_LENS},
    {"strength",
     "How bright the flare comes out: 0 none, 0.5 a quarter of "
     "white at its brightest, 1 white",
     F0R_DOUBLE, FILTER_STRENGTH},
    {"gain", "Factor on all light of the flare: 0.5 is 1, 1 is 2", F0R_DOUBLE,
     FILTER_GAIN},
    {"starburst",
     "Star around each lamp: 0 none, 0.5 as a lens has it, 1 twice "
     "that",
     F0R_DOUBLE, FILTER_STARBURST},
    {"quality", "0 fast, 0.5 as overlay draws, 1 fine", F0R_DOUBLE,
     FILTER_QUALITY},
    {"auto", "Lamps are found and followed; else there is one, at x, y",
     F0R_BOOL, FILTER_AUTO},
    {"x", "Lamp without auto: 0 left, 1 right", F0R_DOUBLE, FILTER_X},
    {"y", "Lamp without auto: 0 top, 1 bottom", F0R_DOUBLE, FILTER_Y},
    {"f-number", "How far the lens is stopped down, as 5.6; empty: open",
     F0R_STRING, FILTER_F_NUMBER},
    {"style", "natural, clean, vintage, cinema or toy; empty: none", F0R_STRING,
     FILTER_STYLE},
};

enum { N_PARAMETERS = sizeof parameters / sizeof *parameters };
enum { FRAME_US = 40000 };

struct instance {
    struct filter *filter;
    struct glint_image image;
    double seconds; /* moment of the last picture; NAN: there was none */
};

int f0r_init(void)
{
    return 1;
}

void f0r_deinit(void)
{
}

void f0r_get_plugin_info(struct f0r_plugin *info)
{
    *info = (struct f0r_plugin){
        .name = "glint",
        .author = "glint",
        .kind = F0R_FILTER,
        .colour_model = F0R_BGRA,
        .frei0r_version = F0R_MAJOR,
        .minor_version = 1,
        .n_params = N_PARAMETERS,
        .explanation = "Lens flare: ghosts and stars of a real lens"};
}

void f0r_get_param_info(struct f0r_param *info, int index)
{
    if (index < 0 || index >= N_PARAMETERS)
        return;
    *info = (struct f0r_param){.name = parameters[index].name,
                               .type = (int)parameters[index].type,
                               .explanation = parameters[index].about};
}

static bool stop_at_first(void *ctx, const char *name)
{
    (void)ctx, (void)name;
    return false;
}

/* Returns whether there are lenses. Later the host cannot be informed: its call
 * for pictures returns nothing. */
static bool has_lenses(void)
{
    if (lens_files_each(stop_at_first, NULL) > 0)
        return true;
    fprintf(stderr, "glint frei0r: no lenses: neither in GLINT_LENSES nor in "
                    "lenses/ or share/glint/lenses/ above the plug-in; install "
                    "glint, or set GLINT_LENSES to a folder of .lens files\n");
    return false;
}

void *f0r_construct(unsigned width, unsigned height)
{
    struct instance *const i = has_lenses() ? calloc(1, sizeof *i) : NULL;

    if (i && width - 1 < GLINT_MAX_SIDE && height - 1 < GLINT_MAX_SIDE)
        i->filter = filter_create("frei0r", (int)width, (int)height);
    if (!i || !i->filter) {
        free(i);
        return NULL;
    }
    i->image = (struct glint_image){
        .format = GLINT_XRGB8888, .width = (int)width, .height = (int)height};
    i->seconds = NAN;
    return i;
}

void f0r_destruct(void *instance)
{
    struct instance *const i = instance;

    if (i)
        filter_destroy(i->filter);
    free(i);
}

void f0r_set_param_value(void *instance, void *value, int index)
{
    struct filter *const f = ((struct instance *)instance)->filter;

    if (index < 0 || index >= N_PARAMETERS || !value)
        return;
    if (parameters[index].type == F0R_STRING)
        filter_set_word(f, (enum filter_word)parameters[index].which,
                        *(char **)value);
    else
        filter_set_number(f, (enum filter_number)parameters[index].which,
                          *(double *)value);
}

void f0r_get_param_value(void *instance, void *value, int index)
{
    const struct filter *const f = ((struct instance *)instance)->filter;

    if (index < 0 || index >= N_PARAMETERS || !value)
        return;
    if (parameters[index].type == F0R_STRING)
        *(const char **)value =
            filter_word(f, (enum filter_word)parameters[index].which);
    else
        *(double *)value =
            filter_number(f, (enum filter_number)parameters[index].which);
}

/* Returns the microseconds since the last picture. The first, and one of before
 * the last as after a jump back, counts as the next of 25 a second. Ten seconds
 * and more are taken for milliseconds: ffmpeg 5.1 passes a thousand times the
 * seconds. */
static int32_t elapsed(const struct instance *i, double seconds)
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
    if (filter_draw(i->filter, &i->image, elapsed(i, seconds)))
        i->seconds = seconds;
}
