/* SPDX-License-Identifier: MIT
 *
 * gst_harness - tests the element glintflare in GStreamer's test harness:
 * frames are drawn in place, properties take effect between frames, late frames
 * are dropped. Prints a line for each test, as tests/run-one reads them.
 */
#include <string.h>

#include <gst/check/gstharness.h>
#include <gst/gst.h>

enum { WIDTH = 160, HEIGHT = 96, BYTES = 4 * WIDTH * HEIGHT };

static int status;

static void print_test_result(const char *name, int is_met)
{
    g_print("%s %s\n", is_met ? "ok" : "not ok", name);
    status |= !is_met;
}

/* Returns a buffer that owns its memory and contains frame K: a lamp on
 * grey. */
static GstBuffer *make_frame_buffer(int k)
{
    guint8 *const px = g_malloc(BYTES);
    GstBuffer *const buffer = gst_buffer_new_wrapped(px, BYTES);

    memset(px, 30, BYTES);
    for (int y = 30; y < 36; y++)
        memset(px + 4 * (WIDTH * y + 40), 255, 4 * 6);
    GST_BUFFER_PTS(buffer) = (GstClockTime)k * 40 * GST_MSECOND;
    GST_BUFFER_DURATION(buffer) = 40 * GST_MSECOND;
    return buffer;
}

static const guint8 *copy_buffer_bytes(GstBuffer *buffer)
{
    GstMapInfo map;
    const guint8 *data;

    gst_buffer_map(buffer, &map, GST_MAP_READ);
    data = map.data;
    gst_buffer_unmap(buffer, &map);
    return data;
}

static GstHarness *start_harness(const char *properties)
{
    char *const line = g_strdup_printf("glintflare %s", properties);
    GstHarness *const h = gst_harness_new_parse(line);

    g_free(line);
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=160,"
                                    "height=96,framerate=25/1");
    return h;
}

/* Pushes frame K through the element. Returns its output buffer, or NULL if the
 * frame was dropped. */
static GstBuffer *filter_frame(GstHarness *h, int k)
{
    if (gst_harness_push(h, make_frame_buffer(k)) != GST_FLOW_OK)
        return NULL;
    return gst_harness_try_pull(h);
}

static int has_no_flare(GstBuffer *buffer)
{
    GstBuffer *const plain = make_frame_buffer(0);
    const int same =
        memcmp(copy_buffer_bytes(buffer), copy_buffer_bytes(plain), BYTES) == 0;

    gst_buffer_unref(plain);
    gst_buffer_unref(buffer);
    return same;
}

static void test_in_place_drawing(void)
{
    GstHarness *const h = start_harness("lens=heliar-tronnier");
    GstBuffer *const in = make_frame_buffer(0);
    const guint8 *const before = copy_buffer_bytes(in);
    GstBuffer *out;

    gst_harness_push(h, in);
    out = gst_harness_pull(h);
    print_test_result("the frame is the buffer that came, at the same address",
                      out == in && copy_buffer_bytes(out) == before);
    print_test_result("with a flare on it", !has_no_flare(out));
    gst_harness_teardown(h);
}

/* Returns whether the error message posted by the element E contains NAME. */
static int error_names_lens(GstElement *e, const gchar *name)
{
    GstBus *const bus = gst_element_get_bus(e);
    GstMessage *const message =
        bus ? gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR) : NULL;
    GError *error = NULL;
    int found;

    if (!message)
        return 0;
    gst_message_parse_error(message, &error, NULL);
    found = strstr(error->message, name) != NULL;
    g_error_free(error);
    gst_message_unref(message);
    gst_object_unref(bus);
    return found;
}

static void test_live_properties(void)
{
    GstHarness *const h = start_harness("lens=heliar-tronnier");
    GstElement *const e = gst_harness_find_element(h, "glintflare");
    GstBus *const bus = gst_bus_new();
    gchar *lens = NULL;
    gdouble gain = 0;
    GstBuffer *full;
    guint8 first[BYTES];

    gst_element_set_bus(e, bus);
    gst_object_unref(bus);
    full = filter_frame(h, 0);
    memcpy(first, copy_buffer_bytes(full), BYTES);
    gst_buffer_unref(full);
    g_object_set(e, "gain", 0.0, "starburst", 0.0, NULL);
    print_test_result("gain 0 from the next frame on",
                      has_no_flare(filter_frame(h, 1)));
    g_object_set(e, "gain", 1.0, "starburst", 1.0, NULL);
    print_test_result("and gain 1 again", !has_no_flare(filter_frame(h, 2)));
    g_object_set(e, "auto", FALSE, "x", 0.8, "y", 0.2, "f-number", "8", NULL);
    full = filter_frame(h, 3);
    print_test_result("a lamp at x, y",
                      memcmp(copy_buffer_bytes(full), first, BYTES) != 0);
    print_test_result("which draws", !has_no_flare(full));
    g_object_get(e, "lens", &lens, "gain", &gain, NULL);
    print_test_result("properties are read back",
                      g_strcmp0(lens, "heliar-tronnier") == 0 && gain > 0.99);
    g_object_set(e, "lens", "nothing", NULL);
    print_test_result("an unknown lens is an error of the stream",
                      gst_harness_push(h, make_frame_buffer(4)) ==
                          GST_FLOW_ERROR);
    print_test_result("whose message names it", error_names_lens(e, "nothing"));
    g_object_set(e, "lens", "heliar-tronnier", NULL);
    print_test_result("until it is known", !has_no_flare(filter_frame(h, 5)));
    g_free(lens);
    gst_object_unref(e);
    gst_harness_teardown(h);
}

static void test_quality_of_service(void)
{
    GstHarness *const h = start_harness("lens=heliar-tronnier");
    GstBuffer *out = filter_frame(h, 0);

    print_test_result("frames in time come", out != NULL);
    gst_buffer_unref(out);
    /* The sink reports that the frame with the time stamp 40 ms arrived 200 ms
     * late. */
    gst_harness_push_upstream_event(h, gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW,
                                                         2, 200 * GST_MSECOND,
                                                         40 * GST_MSECOND));
    out = filter_frame(h, 2);
    print_test_result("one that is late already is dropped", out == NULL);
    if (out)
        gst_buffer_unref(out);
    out = filter_frame(h, 100);
    print_test_result("one after that is drawn", out && !has_no_flare(out));
    gst_harness_teardown(h);
}

/* Checks that frames are drawn after their size changed, and after it changed
 * back. */
static void test_changed_frame_size(void)
{
    GstHarness *const h = start_harness("lens=heliar-tronnier");
    GstBuffer *small;

    gst_buffer_unref(filter_frame(h, 0));
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=80,"
                                    "height=192,framerate=25/1");
    small = filter_frame(h, 1);
    print_test_result("another size",
                      small && gst_buffer_get_size(small) == BYTES);
    gst_buffer_unref(small);
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=160,"
                                    "height=96,framerate=25/1");
    print_test_result("and the first again, after a jump back",
                      !has_no_flare(filter_frame(h, 0)));
    gst_harness_teardown(h);
}

int main(int argc, char **argv)
{
    gst_init(&argc, &argv);
    test_in_place_drawing();
    test_live_properties();
    test_quality_of_service();
    test_changed_frame_size();
    return status;
}
