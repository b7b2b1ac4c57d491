/* SPDX-License-Identifier: MIT
 *
 * The OBS filter: adds a flare in place to the frames of a camera, a video or
 * another source whose frames are in memory, like glint overlay.
 */
#include <math.h>
#include <obs-module.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "desk/styles.h"
#include "filter/filter.h"
#include "glint/glint.h"
#include "model/lens_files.h"

static bool find_pixel_format(enum video_format from,
                              enum glint_pixel_format *to)
{
    static const struct {
        enum video_format from;
        enum glint_pixel_format to;
    } pairs[] = {
        {VIDEO_FORMAT_I420, GLINT_I420},
        {VIDEO_FORMAT_NV12, GLINT_NV12},
        {VIDEO_FORMAT_YUY2, GLINT_YUYV},
        {VIDEO_FORMAT_UYVY, GLINT_UYVY},
        {VIDEO_FORMAT_I422, GLINT_I422},
        {VIDEO_FORMAT_I444, GLINT_I444},
        {VIDEO_FORMAT_RGBA, GLINT_XBGR8888},
        {VIDEO_FORMAT_BGRA, GLINT_XRGB8888},
        {VIDEO_FORMAT_BGRX, GLINT_XRGB8888},
        {VIDEO_FORMAT_BGR3, GLINT_BGR24},
        {VIDEO_FORMAT_Y800, GLINT_GREY},
    };

    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (pairs[i].from == from) {
            *to = pairs[i].to;
            return true;
        }
    return false;
}

/* Returns the luma matrix (BT.601 or BT.709) that is nearest to FRAME's matrix
 * from codes to RGB. The matrices are distinguished by the factor from Cr to R:
 * 1.40 for BT.601 and 1.57 for BT.709 at full range. If a source states no
 * matrix, all its factors are 0. */
static enum glint_matrix find_luma_matrix(const struct obs_source_frame *frame)
{
    const float cr = frame->color_matrix[2];
    const float between = frame->full_range ? 1.488F : 1.694F;

    return cr > between ? GLINT_MATRIX_BT709 : GLINT_MATRIX_BT601;
}

/* Returns the transfer curve of sRGB if the frame states it, or if the frame is
 * RGB and states no curve; else that of BT.709. */
static enum glint_tone find_transfer_curve(const struct obs_source_frame *frame,
                                           bool is_rgb)
{
    return frame->trc == VIDEO_TRC_SRGB ||
                   (frame->trc == VIDEO_TRC_DEFAULT && is_rgb)
               ? GLINT_TONE_SRGB
               : GLINT_TONE_BT709;
}

/* Sets IMAGE to the pixels of FRAME in place, bottom row first if OBS will
 * flip them. Returns false for frames that glint cannot draw on: more than 8
 * bits, HDR curves, or an unsupported format or size. */
static bool set_image_to_frame(const struct obs_source_frame *frame,
                               struct glint_image *image)
{
    enum glint_pixel_format format;

    if (!find_pixel_format(frame->format, &format) ||
        frame->trc == VIDEO_TRC_PQ || frame->trc == VIDEO_TRC_HLG ||
        frame->width - 1 >= GLINT_MAX_SIDE ||
        frame->height - 1 >= GLINT_MAX_SIDE)
        return false;
    *image = (struct glint_image){
        .format = format,
        .width = (int)frame->width,
        .height = (int)frame->height,
        .range = frame->full_range ? GLINT_RANGE_FULL : GLINT_RANGE_LIMITED,
        .matrix = find_luma_matrix(frame),
        .transfer = find_transfer_curve(frame, glint_image_is_rgb(format))};
    for (int i = 0; i < glint_image_planes(format); i++) {
        const ptrdiff_t stride = (ptrdiff_t)frame->linesize[i];
        const int rows = glint_image_plane_height(format, i, image->height);

        image->plane[i] =
            frame->data[i] + (frame->flip ? (rows - 1) * stride : 0);
        image->stride_bytes[i] = frame->flip ? -stride : stride;
    }
    return true;
}

struct opening {
    /* used only by the thread that opens the filter, until is_done is true */
    struct filter *filter;
    pthread_mutex_t lock; /* guards the following members */
    bool is_done, is_left;
};

static void free_filter_opening(struct opening *o)
{
    filter_destroy(o->filter);
    pthread_mutex_destroy(&o->lock);
    free(o);
}

static void *open_filter_in_thread(void *arg)
{
    struct opening *const o = arg;
    bool is_left;

    /* The result is ignored: after a failure drawing fails, too, and prints the
     * cause. */
    filter_open_lens(o->filter);
    pthread_mutex_lock(&o->lock);
    o->is_done = true;
    is_left = o->is_left;
    pthread_mutex_unlock(&o->lock);
    if (is_left)
        free_filter_opening(o);
    return NULL;
}

/* Starts opening a filter with VALUES for frames of WIDTH x HEIGHT in a
 * thread. Returns NULL if there is no memory or thread. */
static struct opening *start_filter_opening(const struct filter_values *values,
                                            int width, int height)
{
    struct opening *const o = calloc(1, sizeof *o);
    pthread_t thread;

    if (!o)
        return NULL;
    pthread_mutex_init(&o->lock, NULL);
    o->filter = filter_create("obs", width, height);
    if (o->filter)
        filter_set_values(o->filter, values);
    if (!o->filter ||
        pthread_create(&thread, NULL, open_filter_in_thread, o) != 0) {
        free_filter_opening(o);
        return NULL;
    }
    pthread_detach(thread);
    return o;
}

/* Returns whether opening has ended, successfully or not. If it has, sets
 * *FILTER to the filter and frees O. */
static bool collect_opened_filter(struct opening *o, struct filter **filter)
{
    bool is_done;

    pthread_mutex_lock(&o->lock);
    is_done = o->is_done;
    pthread_mutex_unlock(&o->lock);
    if (!is_done)
        return false;
    *filter = o->filter;
    o->filter = NULL;
    free_filter_opening(o);
    return true;
}

/* Abandons the opening O, which may be NULL. The thread of O frees everything
 * when the thread ends. */
static void abandon_opening(struct opening *o)
{
    bool is_done;

    if (!o)
        return;
    pthread_mutex_lock(&o->lock);
    is_done = o->is_done;
    o->is_left = true;
    pthread_mutex_unlock(&o->lock);
    if (is_done)
        free_filter_opening(o);
}

/* cppcheck-suppress unknownMacro ; a macro of OBS */
OBS_DECLARE_MODULE()

enum { FRAME_US = 40000, LONGEST_US = 10000000 };

struct flare {
    /* guards WANTED, the latest values that the user has set */
    pthread_mutex_t lock;
    struct filter_values wanted;
    /* used only by the graphics thread: */
    struct filter *filter;
    struct opening *opening;
    obs_source_t *source;
    uint64_t last_ns; /* time of the last frame drawn; 0: none */
    bool has_warned;
};

/* --------------------------------------------------------------- properties */

static void get_default_settings(obs_data_t *data)
{
    struct filter_parameter p;

    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (p.type == FILTER_NUMBER)
            obs_data_set_default_double(data, p.name, p.initial);
        else if (p.type == FILTER_SWITCH)
            obs_data_set_default_bool(data, p.name, p.initial > 0);
}

static void update_settings(void *ctx, obs_data_t *data)
{
    struct flare *const f = ctx;
    struct filter_parameter p;

    pthread_mutex_lock(&f->lock);
    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (p.type == FILTER_NUMBER)
            filter_set_number(&f->wanted, i, obs_data_get_double(data, p.name));
        else if (p.type == FILTER_SWITCH)
            filter_set_number(&f->wanted, i, obs_data_get_bool(data, p.name));
        else
            filter_set_text(&f->wanted, i, obs_data_get_string(data, p.name));
    pthread_mutex_unlock(&f->lock);
}

static bool add_lens_to_list(void *list, const char *name)
{
    obs_property_list_add_string(list, name, name);
    return true;
}

/* Shows the controls of the lamp's position, unless lamps are detected. */
static bool show_lamp_position(obs_properties_t *all, obs_property_t *changed,
                               obs_data_t *data)
{
    const bool is_given = !obs_data_get_bool(data, "auto");

    (void)changed;
    obs_property_set_visible(obs_properties_get(all, "x"), is_given);
    obs_property_set_visible(obs_properties_get(all, "y"), is_given);
    return true;
}

static obs_property_t *add_parameter_text(obs_properties_t *all,
                                          const struct filter_parameter *p)
{
    const bool is_lens = strcmp(p->name, "lens") == 0;
    obs_property_t *list;

    if (!is_lens && strcmp(p->name, "style") != 0)
        return obs_properties_add_text(all, p->name, p->label,
                                       OBS_TEXT_DEFAULT);
    list = obs_properties_add_list(all, p->name, p->label,
                                   is_lens ? OBS_COMBO_TYPE_EDITABLE
                                           : OBS_COMBO_TYPE_LIST,
                                   OBS_COMBO_FORMAT_STRING);
    if (is_lens) {
        lens_files_visit_all(add_lens_to_list, list);
        return list;
    }
    obs_property_list_add_string(list, "none", "");
    for (const struct style *s = styles; s->name; s++)
        obs_property_list_add_string(list, s->name, s->name);
    return list;
}

static obs_properties_t *get_properties(void *ctx)
{
    obs_properties_t *const all = obs_properties_create();
    obs_property_t *property;
    struct filter_parameter p;

    (void)ctx;
    for (int i = 0; filter_get_parameter(i, &p); i++) {
        if (p.type == FILTER_TEXT)
            property = add_parameter_text(all, &p);
        else if (p.type == FILTER_NUMBER)
            property = obs_properties_add_float_slider(all, p.name, p.label,
                                                       p.low, p.high, 0.01);
        else
            property = obs_properties_add_bool(all, p.name, p.label);
        obs_property_set_long_description(property, p.help);
    }
    obs_property_set_modified_callback(obs_properties_get(all, "auto"),
                                       show_lamp_position);
    return all;
}

/* ------------------------------------------------------------------- frames */

static void print_warning_once(struct flare *f, const char *text)
{
    if (!f->has_warned)
        blog(LOG_WARNING, "glint: %s; frames are passed unchanged", text);
    f->has_warned = true;
}

/* Disables the filter in the source, so that the user sees the failure. Closes
 * the failed filter, so that it is opened again when the user enables it. */
static void disable_failed_filter(struct flare *f)
{
    blog(LOG_ERROR, "glint: the filter is disabled: %s",
         filter_error_text(f->filter));
    filter_destroy(f->filter);
    f->filter = NULL;
    obs_source_set_enabled(f->source, false);
}

/* Takes over a filter whose opening has ended. Starts to open another filter if
 * the current one does not fit IMAGE and the values. Sets the live values.
 * Returns whether the filter can draw. */
static bool prepare_filter(struct flare *f, const struct glint_image *image)
{
    const int w = image->width, h = image->height;
    struct filter *opened;

    if (f->opening && collect_opened_filter(f->opening, &opened)) {
        filter_destroy(f->filter);
        f->filter = opened;
        f->opening = NULL;
        f->last_ns = 0;
        f->has_warned = false;
    }
    if (!f->opening &&
        !(f->filter && filter_is_reusable(f->filter, &f->wanted, w, h))) {
        f->opening = start_filter_opening(&f->wanted, w, h);
        if (!f->opening)
            print_warning_once(f, "no memory");
    }
    if (f->filter)
        filter_set_live_values(f->filter, &f->wanted);
    return f->filter && filter_has_size(f->filter, w, h);
}

/* Returns the microseconds since the last frame drawn. For the first frame,
 * after a jump back and after a long gap, returns the duration of a frame at 25
 * frames per second. */
static int32_t compute_elapsed_us(const struct flare *f, uint64_t now_ns)
{
    const uint64_t us = (now_ns - f->last_ns + 500) / 1000;

    return f->last_ns != 0 && now_ns > f->last_ns && us < LONGEST_US
               ? (int32_t)us
               : FRAME_US;
}

static struct obs_source_frame *
filter_video_frame(void *ctx, struct obs_source_frame *frame)
{
    struct flare *const f = ctx;
    struct glint_image image;
    bool is_ready;

    if (!set_image_to_frame(frame, &image)) {
        print_warning_once(f, "frames of this format are not supported");
        return frame;
    }
    pthread_mutex_lock(&f->lock);
    is_ready = prepare_filter(f, &image);
    pthread_mutex_unlock(&f->lock);
    if (!is_ready)
        return frame;
    if (filter_draw_flare(f->filter, &image,
                          compute_elapsed_us(f, frame->timestamp)))
        f->last_ns = frame->timestamp;
    else
        disable_failed_filter(f);
    return frame;
}

/* ------------------------------------------------------------------- module */

static const char *get_filter_name(void *type)
{
    (void)type;
    return "Lens flare (glint)";
}

static void destroy_flare(void *ctx)
{
    struct flare *const f = ctx;

    abandon_opening(f->opening);
    filter_destroy(f->filter);
    filter_values_free(&f->wanted);
    pthread_mutex_destroy(&f->lock);
    free(f);
}

static void *create_flare(obs_data_t *data, obs_source_t *source)
{
    struct flare *const f = calloc(1, sizeof *f);

    if (!f)
        return NULL;
    f->source = source;
    filter_values_init(&f->wanted);
    pthread_mutex_init(&f->lock, NULL);
    update_settings(f, data);
    return f;
}

static struct obs_source_info info = {
    .id = "glint_flare",
    .type = OBS_SOURCE_TYPE_FILTER,
    .output_flags = OBS_SOURCE_VIDEO | OBS_SOURCE_ASYNC,
    .get_name = get_filter_name,
    .create = create_flare,
    .destroy = destroy_flare,
    .get_defaults = get_default_settings,
    .get_properties = get_properties,
    .update = update_settings,
    .filter_video = filter_video_frame,
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
