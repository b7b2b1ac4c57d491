/* SPDX-License-Identifier: MIT
 *
 * The filter of OBS: a flare over the frames of a camera, a video or another
 * source whose frames are in memory, where they lie, as glint overlay draws it.
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <obs-module.h>

#include "desk/styles.h"
#include "glint/glint.h"
#include "model/lens_files.h"
#include "obs/frame.h"
#include "obs/opening.h"

/* cppcheck-suppress unknownMacro ; of OBS's headers */
OBS_DECLARE_MODULE()

enum { FRAME_US = 40000, LONGEST_US = 10000000 };

struct flare {
    pthread_mutex_t lock; /* of what the user set last */
    struct flare_settings wanted;
    /* The graphics thread's alone: */
    struct filter *filter;
    struct flare_settings opened; /* what it was opened with, and for */
    int width, height;
    struct opening *opening;
    obs_source_t *source;
    uint64_t last_ns; /* of the last frame drawn; 0: none */
    bool has_warned;
};

/* --------------------------------------------------------------- properties */

/* A setting; a number is FACTOR times the filter's, and at most that. */
static const struct number_setting {
    const char *key, *label;
    enum filter_number which;
    double factor;
} number_settings[] = {
    {"strength", "Strength", FILTER_STRENGTH, 1},
    {"gain", "Gain", FILTER_GAIN, 2},
    {"starburst", "Starburst", FILTER_STARBURST, 2},
    {"quality", "Quality", FILTER_QUALITY, 1},
    {"x", "Lamp from the left", FILTER_X, 1},
    {"y", "Lamp from the top", FILTER_Y, 1},
};

static const char *const word_key[FILTER_WORDS] = {[FILTER_LENS] = "lens",
                                                   [FILTER_STYLE] = "style",
                                                   [FILTER_F_NUMBER] =
                                                       "f-number"};

enum { N_NUMBERS = sizeof number_settings / sizeof *number_settings };

static void get_defaults(obs_data_t *data)
{
    for (int i = 0; i < N_NUMBERS; i++)
        obs_data_set_default_double(
            data, number_settings[i].key,
            number_settings[i].factor *
                filter_default[number_settings[i].which]);
    obs_data_set_default_bool(data, "auto", filter_default[FILTER_AUTO] >= 0.5);
}

static void update(void *ctx, obs_data_t *data)
{
    struct flare *const f = ctx;

    pthread_mutex_lock(&f->lock);
    for (int i = 0; i < N_NUMBERS; i++)
        f->wanted.number[number_settings[i].which] =
            obs_data_get_double(data, number_settings[i].key) /
            number_settings[i].factor;
    f->wanted.number[FILTER_AUTO] = obs_data_get_bool(data, "auto");
    for (int i = 0; i < FILTER_WORDS; i++)
        snprintf(f->wanted.word[i], WORD_BYTES, "%s",
                 obs_data_get_string(data, word_key[i]));
    pthread_mutex_unlock(&f->lock);
}

static bool add_lens(void *list, const char *name)
{
    obs_property_list_add_string(list, name, name);
    return true;
}

/* The place of a lamp is asked for where none are looked for. */
static bool show_place(obs_properties_t *all, obs_property_t *changed,
                       obs_data_t *data)
{
    const bool is_given = !obs_data_get_bool(data, "auto");

    (void)changed;
    obs_property_set_visible(obs_properties_get(all, "x"), is_given);
    obs_property_set_visible(obs_properties_get(all, "y"), is_given);
    return true;
}

static obs_properties_t *get_properties(void *ctx)
{
    obs_properties_t *const all = obs_properties_create();
    obs_property_t *const lens = obs_properties_add_list(
        all, "lens", "Lens, or a file of one", OBS_COMBO_TYPE_EDITABLE,
        OBS_COMBO_FORMAT_STRING);
    obs_property_t *const style = obs_properties_add_list(
        all, "style", "Style", OBS_COMBO_TYPE_LIST, OBS_COMBO_FORMAT_STRING);

    (void)ctx;
    lens_files_each(add_lens, lens);
    obs_property_list_add_string(style, "none", "");
    for (const struct style *s = styles; s->name; s++)
        obs_property_list_add_string(style, s->name, s->name);
    obs_properties_add_text(all, "f-number", "F-number, as 5.6",
                            OBS_TEXT_DEFAULT);
    obs_property_set_modified_callback(
        obs_properties_add_bool(all, "auto", "Find lamps"), show_place);
    for (int i = 0; i < N_NUMBERS; i++)
        obs_properties_add_float_slider(all, number_settings[i].key,
                                        number_settings[i].label, 0,
                                        number_settings[i].factor, 0.01);
    return all;
}

/* ------------------------------------------------------------------- frames */

static void warn_once(struct flare *f, const char *text)
{
    if (!f->has_warned)
        blog(LOG_WARNING, "glint: %s; frames stay as they are", text);
    f->has_warned = true;
}

/* Disables the source's filter, which its user sees, and drops what failed, so
 * that it is opened again once the user enables it. */
static void disable(struct flare *f)
{
    blog(LOG_ERROR, "glint: the filter is disabled: %s",
         filter_cause(f->filter));
    filter_destroy(f->filter);
    f->filter = NULL;
    obs_source_set_enabled(f->source, false);
}

/* Takes the filter that has been opened, if there is one, and begins to open
 * another where this one does not serve. Returns whether this one can draw. */
static bool ready(struct flare *f, const struct flare_settings *wanted,
                  const struct glint_image *image)
{
    struct filter *opened;

    if (f->opening &&
        opening_end(f->opening, &opened, &f->opened, &f->width, &f->height)) {
        filter_destroy(f->filter);
        f->filter = opened;
        f->opening = NULL;
        f->last_ns = 0;
        f->has_warned = false;
    }
    if (!f->opening &&
        !(f->filter && f->width == image->width && f->height == image->height &&
          flare_settings_serve(&f->opened, wanted))) {
        f->opening = opening_begin(wanted, image->width, image->height);
        if (!f->opening)
            warn_once(f, "no memory");
    }
    return f->filter && f->width == image->width && f->height == image->height;
}

/* Returns the microseconds since the last frame drawn. The first, and one of
 * before the last or long after it, counts as the next of 25 a second. */
static int32_t elapsed_us(const struct flare *f, uint64_t now_ns)
{
    const uint64_t us = (now_ns - f->last_ns + 500) / 1000;

    return f->last_ns != 0 && now_ns > f->last_ns && us < LONGEST_US
               ? (int32_t)us
               : FRAME_US;
}

static struct obs_source_frame *filter_video(void *ctx,
                                             struct obs_source_frame *frame)
{
    struct flare *const f = ctx;
    struct glint_image image;
    struct flare_settings wanted;

    if (!frame_image(frame, &image)) {
        warn_once(f, "no flare on frames of this kind");
        return frame;
    }
    pthread_mutex_lock(&f->lock);
    wanted = f->wanted;
    pthread_mutex_unlock(&f->lock);
    if (!ready(f, &wanted, &image))
        return frame;
    flare_settings_turn(&wanted, f->filter);
    if (filter_draw(f->filter, &image, elapsed_us(f, frame->timestamp)))
        f->last_ns = frame->timestamp;
    else
        disable(f);
    return frame;
}

/* ------------------------------------------------------------------- module */

static const char *get_name(void *type)
{
    (void)type;
    return "Lens flare (glint)";
}

static void destroy(void *ctx)
{
    struct flare *const f = ctx;

    opening_leave(f->opening);
    filter_destroy(f->filter);
    pthread_mutex_destroy(&f->lock);
    free(f);
}

static void *create(obs_data_t *data, obs_source_t *source)
{
    struct flare *const f = calloc(1, sizeof *f);

    if (!f)
        return NULL;
    f->source = source;
    pthread_mutex_init(&f->lock, NULL);
    update(f, data);
    return f;
}

static struct obs_source_info info = {
    .id = "glint_flare",
    .type = OBS_SOURCE_TYPE_FILTER,
    .output_flags = OBS_SOURCE_VIDEO | OBS_SOURCE_ASYNC,
    .get_name = get_name,
    .create = create,
    .destroy = destroy,
    .get_defaults = get_defaults,
    .get_properties = get_properties,
    .update = update,
    .filter_video = filter_video,
};

const char *obs_module_description(void)
{
    return "Lens flare of real lenses";
}

const char *obs_module_name(void)
{
    return "glint " GLINT_VERSION;
}

bool obs_module_load(void)
{
    obs_register_source(&info);
    return true;
}
