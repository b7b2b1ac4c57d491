/* SPDX-License-Identifier: MIT
 *
 * The GStreamer element glintflare: a flare over the frames of a pipeline, in
 * place, as glint overlay draws it.
 */
#include <math.h>
#include <string.h>

#include <gst/video/gstvideofilter.h>
#include <gst/video/video.h>

#include "filter/filter.h"
#include "glint/glint.h"

#define FORMATS                                                            \
    "{ I420, NV12, NV21, YUY2, UYVY, Y42B, Y444, RGBA, RGBx, BGRA, BGRx, " \
    "RGB, "                                                                \
    "BGR, GRAY8 }"

#define GLINT_TYPE_FLARE (glint_flare_element_get_type())
G_DECLARE_FINAL_TYPE(GlintFlareElement, glint_flare_element, GLINT, FLARE,
                     GstVideoFilter)

enum { N_PARAMETERS = FILTER_WORDS + FILTER_NUMBERS };

struct _GlintFlareElement {
    GstVideoFilter parent;
    /* What properties say, by the object's lock; handed to the filter, which
     * the streaming thread alone uses, before each frame. */
    gdouble number[FILTER_NUMBERS];
    gchar *word[FILTER_WORDS];
    struct filter *filter;
    struct glint_image image; /* format, size and colours of frames */
    gint32 frame_us;          /* nominal; 0: pictures by themselves */
    GstClockTime last;        /* time of the last frame drawn */
};

G_DEFINE_TYPE(GlintFlareElement, glint_flare_element, GST_TYPE_VIDEO_FILTER)

/* --------------------------------------------------------------- properties */

/* A property; a number is FACTOR times the filter's, and at most that. */
struct property {
    const gchar *name, *about;
    gboolean is_word;
    int which;
    gdouble factor;
};

static const struct property properties[] = {
    {"lens",
     "Lens by name, or a .lens or .glint file; none: the style's, or "
     "nikon-zoom-short",
     TRUE, FILTER_LENS, 0},
    {"style", "natural, clean, vintage, cinema or toy", TRUE, FILTER_STYLE, 0},
    {"f-number", "How far the lens is stopped down, as 5.6; none: open", TRUE,
     FILTER_F_NUMBER, 0},
    {"strength",
     "How bright the flare comes out: 0 none, 0.5 a quarter of white at its "
     "brightest, 1 white",
     FALSE, FILTER_STRENGTH, 1},
    {"gain", "Factor on all light of the flare", FALSE, FILTER_GAIN, 2},
    {"starburst", "Star around each lamp: 0 none, 1 as a lens has it", FALSE,
     FILTER_STARBURST, 2},
    {"quality", "0 fast, 0.5 as overlay draws, 1 fine", FALSE, FILTER_QUALITY,
     1},
    {"auto", "Lamps are found and followed; else there is one, at x, y", FALSE,
     FILTER_AUTO, 0},
    {"x", "Lamp without auto: 0 left, 1 right", FALSE, FILTER_X, 1},
    {"y", "Lamp without auto: 0 top, 1 bottom", FALSE, FILTER_Y, 1},
};

G_STATIC_ASSERT(G_N_ELEMENTS(properties) == N_PARAMETERS);

static void set_property(GObject *object, guint id, const GValue *value,
                         GParamSpec *spec)
{
    GlintFlareElement *const e = GLINT_FLARE(object);
    const struct property *const p = &properties[id - 1];

    (void)spec;
    GST_OBJECT_LOCK(e);
    if (p->is_word) {
        g_free(e->word[p->which]);
        e->word[p->which] = g_value_dup_string(value);
    } else if (p->factor > 0) {
        e->number[p->which] = g_value_get_double(value) / p->factor;
    } else {
        e->number[p->which] = g_value_get_boolean(value);
    }
    GST_OBJECT_UNLOCK(e);
}

static void get_property(GObject *object, guint id, GValue *value,
                         GParamSpec *spec)
{
    GlintFlareElement *const e = GLINT_FLARE(object);
    const struct property *const p = &properties[id - 1];

    (void)spec;
    GST_OBJECT_LOCK(e);
    if (p->is_word)
        g_value_set_string(value, e->word[p->which]);
    else if (p->factor > 0)
        g_value_set_double(value, e->number[p->which] * p->factor);
    else
        g_value_set_boolean(value, e->number[p->which] >= 0.5);
    GST_OBJECT_UNLOCK(e);
}

static GParamSpec *spec_of(const struct property *p)
{
    const GParamFlags flags =
        (GParamFlags)(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                      GST_PARAM_MUTABLE_PLAYING |
                      (p->is_word ? 0 : GST_PARAM_CONTROLLABLE));

    if (p->is_word)
        return g_param_spec_string(p->name, p->name, p->about, NULL, flags);
    if (p->factor > 0)
        return g_param_spec_double(p->name, p->name, p->about, 0, p->factor,
                                   filter_default[p->which] * p->factor, flags);
    return g_param_spec_boolean(p->name, p->name, p->about,
                                filter_default[p->which] >= 0.5, flags);
}

/* ------------------------------------------------------------------- frames */

static gboolean format_of(GstVideoFormat from, enum glint_pixel_format *to)
{
    static const struct {
        GstVideoFormat from;
        enum glint_pixel_format to;
    } pairs[] = {
        {GST_VIDEO_FORMAT_I420, GLINT_I420},
        {GST_VIDEO_FORMAT_NV12, GLINT_NV12},
        {GST_VIDEO_FORMAT_NV21, GLINT_NV21},
        {GST_VIDEO_FORMAT_YUY2, GLINT_YUYV},
        {GST_VIDEO_FORMAT_UYVY, GLINT_UYVY},
        {GST_VIDEO_FORMAT_Y42B, GLINT_I422},
        {GST_VIDEO_FORMAT_Y444, GLINT_I444},
        {GST_VIDEO_FORMAT_RGBA, GLINT_XBGR8888},
        {GST_VIDEO_FORMAT_RGBx, GLINT_XBGR8888},
        {GST_VIDEO_FORMAT_BGRA, GLINT_XRGB8888},
        {GST_VIDEO_FORMAT_BGRx, GLINT_XRGB8888},
        {GST_VIDEO_FORMAT_RGB, GLINT_RGB24},
        {GST_VIDEO_FORMAT_BGR, GLINT_BGR24},
        {GST_VIDEO_FORMAT_GRAY8, GLINT_GREY},
    };

    for (guint i = 0; i < G_N_ELEMENTS(pairs); i++)
        if (pairs[i].from == from) {
            *to = pairs[i].to;
            return TRUE;
        }
    return FALSE;
}

/* Returns the curve from the codes of frames to light: that of the caps, else
 * what is usual for R, G, B and for luma. */
static enum glint_tone tone_of(const GstVideoInfo *info)
{
    switch (info->colorimetry.transfer) {
    case GST_VIDEO_TRANSFER_SRGB:
        return GLINT_TONE_SRGB;
    case GST_VIDEO_TRANSFER_UNKNOWN:
        return GST_VIDEO_INFO_IS_RGB(info) ? GLINT_TONE_SRGB : GLINT_TONE_BT709;
    default:
        return GLINT_TONE_BT709;
    }
}

static void drop_filter(GlintFlareElement *e)
{
    filter_destroy(e->filter);
    e->filter = NULL;
    e->last = GST_CLOCK_TIME_NONE;
}

static gboolean set_info(GstVideoFilter *base, GstCaps *in_caps,
                         GstVideoInfo *in, GstCaps *out_caps, GstVideoInfo *out)
{
    GlintFlareElement *const e = GLINT_FLARE(base);
    const gint fps_n = GST_VIDEO_INFO_FPS_N(in);

    (void)in_caps, (void)out_caps, (void)out;
    drop_filter(e);
    e->image = (struct glint_image){
        .width = GST_VIDEO_INFO_WIDTH(in),
        .height = GST_VIDEO_INFO_HEIGHT(in),
        .range = in->colorimetry.range == GST_VIDEO_COLOR_RANGE_16_235
                     ? GLINT_RANGE_LIMITED
                     : GLINT_RANGE_FULL,
        .matrix = in->colorimetry.matrix == GST_VIDEO_COLOR_MATRIX_BT709
                      ? GLINT_MATRIX_BT709
                      : GLINT_MATRIX_BT601,
        .transfer = tone_of(in)};
    e->frame_us =
        fps_n > 0 ? (gint32)CLAMP(1e6 * GST_VIDEO_INFO_FPS_D(in) / fps_n + 0.5,
                                  1, 1e9)
                  : 0;
    return format_of(GST_VIDEO_INFO_FORMAT(in), &e->image.format);
}

/* Returns the microseconds since the last frame drawn: those of the caps, but
 * after a gap, as of frames that came too late to be drawn. */
static gint32 elapsed_us(const GlintFlareElement *e, GstClockTime now)
{
    const gint64 us =
        GST_CLOCK_TIME_IS_VALID(e->last) && GST_CLOCK_TIME_IS_VALID(now)
            ? GST_CLOCK_DIFF(e->last, now) / GST_USECOND
            : 0;

    return us <= 0 || ABS(us - e->frame_us) <= 1000
               ? e->frame_us
               : (gint32)MIN(us, 1000000000);
}

/* Hands the properties to the filter, which does nothing where they are as they
 * were. */
static void turn(GlintFlareElement *e)
{
    GST_OBJECT_LOCK(e);
    for (int i = 0; i < FILTER_WORDS; i++)
        filter_set_word(e->filter, (enum filter_word)i, e->word[i]);
    for (int i = 0; i < FILTER_NUMBERS; i++)
        filter_set_number(e->filter, (enum filter_number)i, e->number[i]);
    GST_OBJECT_UNLOCK(e);
}

static GstFlowReturn transform(GstVideoFilter *base, GstVideoFrame *frame)
{
    GlintFlareElement *const e = GLINT_FLARE(base);
    const GstClockTime now = GST_BUFFER_PTS(frame->buffer);
    const int planes = glint_image_planes(e->image.format);

    if (GST_CLOCK_TIME_IS_VALID(now))
        gst_object_sync_values(
            GST_OBJECT(e),
            gst_segment_to_stream_time(&GST_BASE_TRANSFORM(e)->segment,
                                       GST_FORMAT_TIME, now));
    if (GST_BUFFER_IS_DISCONT(frame->buffer) &&
        GST_CLOCK_TIME_IS_VALID(e->last) && now <= e->last)
        drop_filter(e); /* a jump back */
    if (!e->filter)
        e->filter =
            filter_create("glintflare", e->image.width, e->image.height);
    if (!e->filter) {
        GST_ELEMENT_ERROR(e, RESOURCE, NO_SPACE_LEFT, (NULL), ("no memory"));
        return GST_FLOW_ERROR;
    }
    turn(e);
    for (int i = 0; i < planes; i++) {
        e->image.plane[i] = GST_VIDEO_FRAME_PLANE_DATA(frame, i);
        e->image.stride_bytes[i] = GST_VIDEO_FRAME_PLANE_STRIDE(frame, i);
    }
    if (!filter_draw(e->filter, &e->image, elapsed_us(e, now))) {
        GST_ELEMENT_ERROR(e, LIBRARY, FAILED,
                          ("No flare: %s", filter_cause(e->filter)), (NULL));
        return GST_FLOW_ERROR;
    }
    e->last = now;
    return GST_FLOW_OK;
}

/* ------------------------------------------------------------------ element */

static gboolean stop(GstBaseTransform *base)
{
    drop_filter(GLINT_FLARE(base));
    return TRUE;
}

static void finalize(GObject *object)
{
    GlintFlareElement *const e = GLINT_FLARE(object);

    drop_filter(e);
    for (int i = 0; i < FILTER_WORDS; i++)
        g_free(e->word[i]);
    G_OBJECT_CLASS(glint_flare_element_parent_class)->finalize(object);
}

static void glint_flare_element_init(GlintFlareElement *e)
{
    memcpy(e->number, filter_default, sizeof e->number);
    e->last = GST_CLOCK_TIME_NONE;
    gst_base_transform_set_in_place(GST_BASE_TRANSFORM(e), TRUE);
    gst_base_transform_set_qos_enabled(GST_BASE_TRANSFORM(e), TRUE);
}

static void add_pad(GstElementClass *class, const gchar *name,
                    GstPadDirection direction)
{
    GstCaps *const caps = gst_caps_from_string(GST_VIDEO_CAPS_MAKE(FORMATS));

    gst_element_class_add_pad_template(
        class, gst_pad_template_new(name, direction, GST_PAD_ALWAYS, caps));
    gst_caps_unref(caps);
}

static void glint_flare_element_class_init(GlintFlareElementClass *class)
{
    GObjectClass *const object = G_OBJECT_CLASS(class);

    object->set_property = set_property;
    object->get_property = get_property;
    object->finalize = finalize;
    for (guint i = 0; i < N_PARAMETERS; i++)
        g_object_class_install_property(object, i + 1, spec_of(&properties[i]));
    gst_element_class_set_static_metadata(
        GST_ELEMENT_CLASS(class), "Lens flare", "Filter/Effect/Video",
        "Draws the ghosts and stars of a real lens on frames, in place",
        "glint");
    add_pad(GST_ELEMENT_CLASS(class), "sink", GST_PAD_SINK);
    add_pad(GST_ELEMENT_CLASS(class), "src", GST_PAD_SRC);
    GST_BASE_TRANSFORM_CLASS(class)->stop = stop;
    GST_VIDEO_FILTER_CLASS(class)->set_info = set_info;
    GST_VIDEO_FILTER_CLASS(class)->transform_frame_ip = transform;
}

static gboolean plugin_init(GstPlugin *plugin)
{
    return gst_element_register(plugin, "glintflare", GST_RANK_NONE,
                                GLINT_TYPE_FLARE);
}

#define PACKAGE "glint"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, glint,
                  "Lens flare of real lenses", plugin_init, GLINT_VERSION,
                  "MIT/X11", "glint", "glint")
