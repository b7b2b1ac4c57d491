/* SPDX-License-Identifier: MIT
 *
 * gst_harness - the element glintflare in a harness of GStreamer's own: frames
 * stay where they are, properties take effect between frames, late frames are
 * dropped. Prints a line for each test, as tests/run-one reads them.
 */
#include <string.h>

#include <gst/check/gstharness.h>
#include <gst/gst.h>

enum { WIDTH = 160, HEIGHT = 96, BYTES = 4 * WIDTH * HEIGHT };

static int status;

static void report_result(const char *name, int is_met)
{
    g_print("%s %s\n", is_met ? "ok" : "not ok", name);
    status |= !is_met;
}

/* Returns frame number K, a lamp on grey, whose memory a buffer takes over. */
static GstBuffer *frame_of(int k)
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

static GstHarness *harness(const char *properties)
{
    char *const line = g_strdup_printf("glintflare %s", properties);
    GstHarness *const h = gst_harness_new_parse(line);

    g_free(line);
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=160,"
                                    "height=96,framerate=25/1");
    return h;
}

/* Draws frame K; returns the buffer, or NULL if none comes. */
static GstBuffer *drawn(GstHarness *h, int k)
{
    if (gst_harness_push(h, frame_of(k)) != GST_FLOW_OK)
        return NULL;
    return gst_harness_try_pull(h);
}

static int is_plain(GstBuffer *buffer)
{
    GstBuffer *const plain = frame_of(0);
    const int same =
        memcmp(copy_buffer_bytes(buffer), copy_buffer_bytes(plain), BYTES) == 0;

    gst_buffer_unref(plain);
    gst_buffer_unref(buffer);
    return same;
}

static void test_in_place(void)
{
    GstHarness *const h = harness("lens=heliar-tronnier");
    GstBuffer *const in = frame_of(0);
    const guint8 *const before = copy_buffer_bytes(in);
    GstBuffer *out;

    gst_harness_push(h, in);
    out = gst_harness_pull(h);
    report_result("the frame is the buffer that came, at the same address",
                  out == in && copy_buffer_bytes(out) == before);
    report_result("with a flare on it", !is_plain(out));
    gst_harness_teardown(h);
}

/* Returns whether the error that E has posted contains NAME. */
static int names_lens(GstElement *e, const gchar *name)
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

static void test_live(void)
{
    GstHarness *const h = harness("lens=heliar-tronnier");
    GstElement *const e = gst_harness_find_element(h, "glintflare");
    GstBus *const bus = gst_bus_new();
    gchar *lens = NULL;
    gdouble gain = 0;
    GstBuffer *full;
    guint8 first[BYTES];

    gst_element_set_bus(e, bus);
    gst_object_unref(bus);
    full = drawn(h, 0);
    memcpy(first, copy_buffer_bytes(full), BYTES);
    gst_buffer_unref(full);
    g_object_set(e, "gain", 0.0, "starburst", 0.0, NULL);
    report_result("gain 0 from the next frame on", is_plain(drawn(h, 1)));
    g_object_set(e, "gain", 1.0, "starburst", 1.0, NULL);
    report_result("and gain 1 again", !is_plain(drawn(h, 2)));
    g_object_set(e, "auto", FALSE, "x", 0.8, "y", 0.2, "f-number", "8", NULL);
    full = drawn(h, 3);
    report_result("a lamp at x, y",
                  memcmp(copy_buffer_bytes(full), first, BYTES) != 0);
    report_result("which draws", !is_plain(full));
    g_object_get(e, "lens", &lens, "gain", &gain, NULL);
    report_result("properties are read back",
                  g_strcmp0(lens, "heliar-tronnier") == 0 && gain > 0.99);
    g_object_set(e, "lens", "nothing", NULL);
    report_result("an unknown lens is an error of the stream",
                  gst_harness_push(h, frame_of(4)) == GST_FLOW_ERROR);
    report_result("whose message names it", names_lens(e, "nothing"));
    g_object_set(e, "lens", "heliar-tronnier", NULL);
    report_result("until it is known", !is_plain(drawn(h, 5)));
    g_free(lens);
    gst_object_unref(e);
    gst_harness_teardown(h);
}

static void test_qos(void)
{
    GstHarness *const h = harness("lens=heliar-tronnier");
    GstBuffer *out = drawn(h, 0);

    report_result("frames in time come", out != NULL);
    gst_buffer_unref(out);
    /* The sink got the frame of 40 ms 200 ms too late. */
    gst_harness_push_upstream_event(h, gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW,
                                                         2, 200 * GST_MSECOND,
                                                         40 * GST_MSECOND));
    out = drawn(h, 2);
    report_result("one that is late already is dropped", out == NULL);
    if (out)
        gst_buffer_unref(out);
    out = drawn(h, 100);
    report_result("one after that is drawn", out && !is_plain(out));
    gst_harness_teardown(h);
}

/* Frames of another size, and of before, must be drawn. */
static void test_again(void)
{
    GstHarness *const h = harness("lens=heliar-tronnier");
    GstBuffer *small;

    gst_buffer_unref(drawn(h, 0));
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=80,"
                                    "height=192,framerate=25/1");
    small = drawn(h, 1);
    report_result("another size", small && gst_buffer_get_size(small) == BYTES);
    gst_buffer_unref(small);
    gst_harness_set_src_caps_str(h, "video/x-raw,format=RGBA,width=160,"
                                    "height=96,framerate=25/1");
    report_result("and the first again, after a jump back",
                  !is_plain(drawn(h, 0)));
    gst_harness_teardown(h);
}

int main(int argc, char **argv)
{
    gst_init(&argc, &argv);
    test_in_place();
    test_live();
    test_qos();
    test_again();
    return status;
}
