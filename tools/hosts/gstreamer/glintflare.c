/* SPDX-License-Identifier: MIT
 *
 * The GStreamer element glintflare: adds a flare to the frames of a pipeline in
 * place, like glint overlay.
 */
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

struct _GlintFlareElement {
    GstVideoFilter parent;
    /* Values of the properties, guarded by the object's lock. They are copied
     * to FILTER before each frame, because only the streaming thread uses
     * FILTER. */
    struct filter_values values;
    struct filter *filter;
    struct glint_image image; /* format, size and colours of frames */
    /* nominal duration of a frame, microseconds; 0: still pictures */
    gint32 frame_us;
    GstClockTime last; /* time of the last frame drawn */
};

G_DEFINE_TYPE(GlintFlareElement, glint_flare_element, GST_TYPE_VIDEO_FILTER)

/* --------------------------------------------------------------- properties */

/* Property number ID is parameter ID - 1 of the filter. */
static void set_property(GObject *object, guint id, const GValue *value,
                         GParamSpec *spec)
{
    GlintFlareElement *const e = GLINT_FLARE(object);
    const int i = (int)id - 1;

    GST_OBJECT_LOCK(e);
    if (G_IS_PARAM_SPEC_STRING(spec))
        filter_set_text(&e->values, i, g_value_get_string(value));
    else if (G_IS_PARAM_SPEC_DOUBLE(spec))
        filter_set_number(&e->values, i, g_value_get_double(value));
    else
        filter_set_number(&e->values, i, g_value_get_boolean(value));
    GST_OBJECT_UNLOCK(e);
}

static void get_property(GObject *object, guint id, GValue *value,
                         GParamSpec *spec)
{
    GlintFlareElement *const e = GLINT_FLARE(object);
    const int i = (int)id - 1;

    GST_OBJECT_LOCK(e);
    if (G_IS_PARAM_SPEC_STRING(spec))
        g_value_set_string(value, e->values.text[i]);
    else if (G_IS_PARAM_SPEC_DOUBLE(spec))
        g_value_set_double(value, e->values.number[i]);
    else
        g_value_set_boolean(value, e->values.number[i] > 0);
    GST_OBJECT_UNLOCK(e);
}

static GParamSpec *make_parameter_spec(const struct filter_parameter *p)
{
    const GParamFlags flags =
        (GParamFlags)(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                      GST_PARAM_MUTABLE_PLAYING |
                      (p->type == FILTER_TEXT ? 0 : GST_PARAM_CONTROLLABLE));

    if (p->type == FILTER_TEXT)
        return g_param_spec_string(p->name, p->label, p->help, NULL, flags);
    if (p->type == FILTER_NUMBER)
        return g_param_spec_double(p->name, p->label, p->help, p->low, p->high,
                                   p->initial, flags);
    return g_param_spec_boolean(p->name, p->label, p->help, p->initial > 0,
                                flags);
}

/* ------------------------------------------------------------------- frames */

static gboolean find_pixel_format(GstVideoFormat from,
                                  enum glint_pixel_format *to)
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

/* Returns the transfer curve of the frames: that of sRGB if the caps state it,
 * or for RGB whose caps state no curve; else that of BT.709. */
static enum glint_tone find_transfer_curve(const GstVideoInfo *info)
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

static void close_element_filter(GlintFlareElement *e)
{
    filter_destroy(e->filter);
    e->filter = NULL;
    e->last = GST_CLOCK_TIME_NONE;
}

static gboolean set_caps_info(GstVideoFilter *base, GstCaps *in_caps,
                              GstVideoInfo *in, GstCaps *out_caps,
                              GstVideoInfo *out)
{
    GlintFlareElement *const e = GLINT_FLARE(base);
    const gint fps_n = GST_VIDEO_INFO_FPS_N(in);

    (void)in_caps, (void)out_caps, (void)out;
    close_element_filter(e);
    e->image = (struct glint_image){
        .width = GST_VIDEO_INFO_WIDTH(in),
        .height = GST_VIDEO_INFO_HEIGHT(in),
        .range = in->colorimetry.range == GST_VIDEO_COLOR_RANGE_16_235
                     ? GLINT_RANGE_LIMITED
                     : GLINT_RANGE_FULL,
        .matrix = in->colorimetry.matrix == GST_VIDEO_COLOR_MATRIX_BT709
                      ? GLINT_MATRIX_BT709
                      : GLINT_MATRIX_BT601,
        .transfer = find_transfer_curve(in)};
    e->frame_us =
        fps_n > 0 ? (gint32)CLAMP(1e6 * GST_VIDEO_INFO_FPS_D(in) / fps_n + 0.5,
                                  1, 1e9)
                  : 0;
    return find_pixel_format(GST_VIDEO_INFO_FORMAT(in), &e->image.format);
}

/* Returns the microseconds since the last frame drawn. This is the nominal
 * duration that the caps state, except after a gap, for example if late frames
 * were dropped. */
static gint32 compute_elapsed_us(const GlintFlareElement *e, GstClockTime now)
{
    const gint64 us =
        GST_CLOCK_TIME_IS_VALID(e->last) && GST_CLOCK_TIME_IS_VALID(now)
            ? GST_CLOCK_DIFF(e->last, now) / GST_USECOND
            : 0;

    return us <= 0 || ABS(us - e->frame_us) <= 1000
               ? e->frame_us
               : (gint32)MIN(us, 1000000000);
}

static GstFlowReturn transform_frame(GstVideoFilter *base, GstVideoFrame *frame)
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
        /* After a jump back in time, the lens is opened again. */
        close_element_filter(e);
    if (!e->filter)
        e->filter =
            filter_create("glintflare", e->image.width, e->image.height);
    if (!e->filter) {
        GST_ELEMENT_ERROR(e, RESOURCE, NO_SPACE_LEFT, (NULL), ("no memory"));
        return GST_FLOW_ERROR;
    }
    GST_OBJECT_LOCK(e);
    filter_set_values(e->filter, &e->values);
    GST_OBJECT_UNLOCK(e);
    for (int i = 0; i < planes; i++) {
        e->image.plane[i] = GST_VIDEO_FRAME_PLANE_DATA(frame, i);
        e->image.stride_bytes[i] = GST_VIDEO_FRAME_PLANE_STRIDE(frame, i);
    }
    if (!filter_draw_flare(e->filter, &e->image, compute_elapsed_us(e, now))) {
        GST_ELEMENT_ERROR(e, LIBRARY, FAILED,
                          ("No flare: %s", filter_error_text(e->filter)),
                          (NULL));
        return GST_FLOW_ERROR;
    }
    e->last = now;
    return GST_FLOW_OK;
}

/* ------------------------------------------------------------------ element */

static gboolean stop_element(GstBaseTransform *base)
{
    close_element_filter(GLINT_FLARE(base));
    return TRUE;
}

static void finalize_element(GObject *object)
{
    GlintFlareElement *const e = GLINT_FLARE(object);

    close_element_filter(e);
    filter_values_free(&e->values);
    G_OBJECT_CLASS(glint_flare_element_parent_class)->finalize(object);
}

static void glint_flare_element_init(GlintFlareElement *e)
{
    filter_values_init(&e->values);
    e->last = GST_CLOCK_TIME_NONE;
    gst_base_transform_set_in_place(GST_BASE_TRANSFORM(e), TRUE);
    gst_base_transform_set_qos_enabled(GST_BASE_TRANSFORM(e), TRUE);
}

static void add_element_pad(GstElementClass *class, const gchar *name,
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
    struct filter_parameter p;

    object->set_property = set_property;
    object->get_property = get_property;
    object->finalize = finalize_element;
    for (int i = 0; filter_get_parameter(i, &p); i++)
        g_object_class_install_property(object, (guint)i + 1,
                                        make_parameter_spec(&p));
    gst_element_class_set_static_metadata(
        GST_ELEMENT_CLASS(class), "Lens flare", "Filter/Effect/Video",
        "Draws the ghosts and starbursts of a real lens on frames, in place",
        "glint");
    add_element_pad(GST_ELEMENT_CLASS(class), "sink", GST_PAD_SINK);
    add_element_pad(GST_ELEMENT_CLASS(class), "src", GST_PAD_SRC);
    GST_BASE_TRANSFORM_CLASS(class)->stop = stop_element;
    GST_VIDEO_FILTER_CLASS(class)->set_info = set_caps_info;
    GST_VIDEO_FILTER_CLASS(class)->transform_frame_ip = transform_frame;
}

static gboolean register_element(GstPlugin *plugin)
{
    return gst_element_register(plugin, "glintflare", GST_RANK_NONE,
                                GLINT_TYPE_FLARE);
}

#define PACKAGE "glint"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, glint,
                  "Lens flare of real lenses", register_element, GLINT_VERSION,
                  "MIT/X11", "glint", "glint")
