/* SPDX-License-Identifier: MIT
 *
 * Checks the bytes that sinks write for frames: raw planes, Y4M, V4L2 output
 * devices.
 */
#include <errno.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <linux/videodev2.h>

#include "linux/fourcc.h"
#include "linux/v4l2_sink.h"
#include "panel/sinks.h"
#include "support/fakes/wrapped.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_row_rgb row;
static struct glint_y4m_sink y4m;
static struct glint_error error;

/* Returns an image with its planes in MEM. */
static struct glint_image make_image(enum glint_pixel_format format, int width,
                                     int height, void *mem)
{
    struct glint_image image = glint_image_over(mem, format, width, height);

    image.range = GLINT_RANGE_LIMITED;
    return image;
}

/* ------------------------------------------------------------------ planes */

/* Converts 3 x 3 pixels FROM of FORMAT to the format PLANAR. Checks that the
 * resulting planes, one after the other, equal WANT. */
static void expect_planes(enum glint_pixel_format format, const uint8_t *from,
                          enum glint_pixel_format planar, const char *want)
{
    const struct glint_image image =
        make_image(format, 3, 3, (uint8_t *)(uintptr_t)from);
    struct glint_image to;
    uint8_t mem[64], work[64];
    const size_t n = glint_image_bytes(planar, 3, 3);

    assert_int_equal(glint_get_planar_format(format), planar);
    assert_int_equal(strlen(want), n);
    memset(mem, '-', sizeof mem);
    to = make_image(planar, 3, 3, mem);
    assert_true(glint_row_rgb_bytes(3) <= sizeof work);
    glint_row_rgb_init(&row, work, 3);
    glint_convert_to_planes(&to, &image, &row);
    mem[sizeof mem - 1] = 0;
    if (memcmp(mem, want, n) != 0)
        fail_msg("format %d: %s", format, (char *)mem);
    assert_int_equal(mem[n], '-');
}

/* Letters stand for samples: a, b, c .. are luma, A, B .. are Cb, and 1, 2 ..
 * are Cr. */
TEST(converts_packed_to_planar)
{
    expect_planes(GLINT_YUYV, (const uint8_t *)"aAb1cB.2dCe3fD.4gEh5iF.6",
                  GLINT_I422, "abcdefghiABCDEF123456");
    expect_planes(GLINT_UYVY, (const uint8_t *)"Aa1bBc2.Cd3eDf4.Eg5hFi6.",
                  GLINT_I422, "abcdefghiABCDEF123456");
    expect_planes(GLINT_NV12, (const uint8_t *)"abcdefghiA1B2C3D4", GLINT_I420,
                  "abcdefghiABCD1234");
    expect_planes(GLINT_NV21, (const uint8_t *)"abcdefghi1A2B3C4D", GLINT_I420,
                  "abcdefghiABCD1234");
    expect_planes(GLINT_I420, (const uint8_t *)"abcdefghiABCD1234", GLINT_I420,
                  "abcdefghiABCD1234");
    expect_planes(GLINT_GREY, (const uint8_t *)"abcdefghi", GLINT_GREY,
                  "abcdefghi");
}

/* Computes Y', Cb and Cr of an RGB colour with the coefficients of the
 * standard. */
static void compute_ycc_of_rgb(int ycc[3], const int rgb[3],
                               const struct glint_image *as)
{
    const bool full = as->range == GLINT_RANGE_FULL;
    const double kr = as->matrix == GLINT_MATRIX_BT601 ? .299 : .2126;
    const double kb = as->matrix == GLINT_MATRIX_BT601 ? .114 : .0722;
    const double y = kr * rgb[0] + (1 - kr - kb) * rgb[1] + kb * rgb[2];
    const double cb = (rgb[2] - y) / (2 - 2 * kb),
                 cr = (rgb[0] - y) / (2 - 2 * kr);

    ycc[0] = (int)floor((full ? y : 16 + y * 219 / 255) + .5);
    ycc[1] = (int)fmin(255, floor(128 + (full ? cb : cb * 224 / 255) + .5));
    ycc[2] = (int)fmin(255, floor(128 + (full ? cr : cr * 224 / 255) + .5));
}

static void check_rgb_to_ycc_colours(enum glint_matrix matrix,
                                     enum glint_range range)
{
    uint8_t rgb[3 * 256], ycc[3 * 256], work[2048];
    const struct glint_image from = make_image(GLINT_RGB24, 256, 1, rgb);
    struct glint_image to = make_image(GLINT_I444, 256, 1, ycc);
    long n_off = 0;

    to.matrix = matrix;
    to.range = range;
    glint_row_rgb_init(&row, work, 256);
    for (int i = 0; i < 256; i++) {
        for (int x = 0; x < 256; x++) {
            rgb[3 * x] = (uint8_t)x;
            rgb[3 * x + 1] = (uint8_t)i;
            rgb[3 * x + 2] = (uint8_t)(7 * i + 13 * x);
        }
        glint_convert_to_planes(&to, &from, &row);
        for (int x = 0; x < 256; x++) {
            const int px[] = {rgb[3 * x], rgb[3 * x + 1], rgb[3 * x + 2]};
            int want[3];

            compute_ycc_of_rgb(want, px, &to);
            for (int k = 0; k < 3; k++) {
                assert_true(abs(ycc[256 * k + x] - want[k]) <= 1);
                n_off += ycc[256 * k + x] != want[k];
            }
        }
    }
    /* Only ties may be rounded differently. */
    assert_true(n_off < 256 * 256 * 3 / 500);
}

/* Checks that the chroma of pure blue and pure red in full range, which would
 * be 255.5, is clamped to 255. */
static void check_clamped_chroma_codes(void)
{
    uint8_t rgb[] = {0, 0, 255, 255, 0, 0}, ycc[6], work[64];
    const struct glint_image from = make_image(GLINT_RGB24, 2, 1, rgb);
    struct glint_image to = make_image(GLINT_I444, 2, 1, ycc);

    to.range = GLINT_RANGE_FULL;
    glint_row_rgb_init(&row, work, 2);
    glint_convert_to_planes(&to, &from, &row);
    assert_int_equal(ycc[2], 255);
    assert_int_equal(ycc[5], 255);
}

TEST(converts_rgb_to_ycc)
{
    static const uint8_t colours[] = {255, 255, 255, 0, 0, 0,   255, 0,   0,
                                      0,   255, 0,   0, 0, 255, 128, 128, 128,
                                      0,   0,   0,   0, 0, 0,   0,   0,   0};
    /* Y, Cb, Cr of white, black, red, green, blue and grey in BT.601, limited
     * range */
    static const char want[] = "\xeb\x10\x51\x91\x29\x7e\x10\x10\x10"
                               "\x80\x80\x5a\x36\xf0\x80\x80\x80\x80"
                               "\x80\x80\xf0\x22\x6e\x80\x80\x80\x80";

    expect_planes(GLINT_RGB24, colours, GLINT_I444, want);
    check_clamped_chroma_codes();
    check_rgb_to_ycc_colours(GLINT_MATRIX_BT601, GLINT_RANGE_LIMITED);
    check_rgb_to_ycc_colours(GLINT_MATRIX_BT601, GLINT_RANGE_FULL);
    check_rgb_to_ycc_colours(GLINT_MATRIX_BT709, GLINT_RANGE_LIMITED);
    check_rgb_to_ycc_colours(GLINT_MATRIX_BT709, GLINT_RANGE_FULL);
}

/* --------------------------------------------------------------------- Y4M */

TEST(writes_y4m)
{
    static const char want[] =
        "YUV4MPEG2 W4 H2 F25:1 Ip A1:1 C422 XCOLORRANGE=FULL\n"
        "FRAME\nabcdefghABCD1234FRAME\nabcdefghABCD1234";
    struct glint_image image =
        make_image(GLINT_YUYV, 4, 2, (void *)"aAb1cBd2eCf3gDh4");

    image.range = GLINT_RANGE_FULL;
    glint_y4m_sink_open(&y4m, scratch_file, 25, 1);
    for (int i = 0; i < 2; i++)
        assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    assert_int_equal(y4m.n_frames, 2);
    image.width = 2;
    assert_int_equal(y4m.sink.put(&y4m.sink, &image, &error), GLINT_E_OUTPUT);
    assert_ok(glint_y4m_sink_finish(&y4m, &error));
    assert_ok(glint_y4m_sink_finish(&y4m, &error));
    scratch_expect_bytes(scratch_file, want, sizeof want - 1);
}

/* Checks that images in a format that Y4M supports are written without a copy,
 * and that RGB images are converted and declared as limited code range. */
TEST(y4m_writes_supported_formats_without_copy)
{
    static const char planes[] = "YUV4MPEG2 W2 H2 F0:0 Ip A1:1 C420jpeg "
                                 "XCOLORRANGE=LIMITED\nFRAME\nabcdA1";
    static const char white[] = "YUV4MPEG2 W1 H1 F30:1 Ip A1:1 C444 "
                                "XCOLORRANGE=LIMITED\nFRAME\n\xeb\x80\x80";
    struct glint_image image = make_image(GLINT_I420, 2, 2, (void *)"abcdA1");

    glint_y4m_sink_open(&y4m, scratch_file, 0, 0);
    assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    assert_null(y4m.mem);
    y4m.sink.close(&y4m.sink);
    y4m.sink.close(&y4m.sink);
    scratch_expect_bytes(scratch_file, planes, sizeof planes - 1);
    image = make_image(GLINT_BGR24, 1, 1, (void *)"\xff\xff\xff");
    image.range = GLINT_RANGE_FULL;
    glint_y4m_sink_open(&y4m, scratch_file, 30, 1);
    assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    y4m.sink.close(&y4m.sink);
    scratch_expect_bytes(scratch_file, white, sizeof white - 1);
}

/* Checks a pipe of 64 KiB from which no program reads: frames are dropped, and
 * writing does not block. */
TEST(y4m_drops_frames_for_a_slow_reader)
{
    static uint8_t mem[4096 * 3], sink_hole[65536];
    const struct glint_image image = make_image(GLINT_GREY, 96, 128, mem);
    char name[32];
    int fd[2];

    assert_int_equal(pipe(fd), 0);
    snprintf(name, sizeof name, "/dev/fd/%d", fd[1]);
    glint_y4m_sink_open(&y4m, name, 25, 1);
    /* each frame has 12288 bytes plus the line FRAME */
    for (int i = 0; i < 4; i++)
        assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    assert_int_equal(y4m.n_dropped, 0);
    assert_int_equal(fcntl(fd[1], F_SETFL, O_NONBLOCK), 0);
    while (write(fd[1], mem, 100) > 0)
        ;
    assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    assert_int_equal(y4m.n_dropped, 1);
    assert_int_equal(y4m.n_frames, 4);
    while (read(fd[0], sink_hole, sizeof sink_hole) == sizeof sink_hole)
        ;
    assert_ok(y4m.sink.put(&y4m.sink, &image, &error));
    assert_int_equal(y4m.n_frames, 5);
    close(fd[0]);
    assert_int_equal(y4m.sink.put(&y4m.sink, &image, &error), GLINT_E_CLOSED);
    y4m.sink.close(&y4m.sink);
    close(fd[1]);
}

TEST(y4m_reports_an_invalid_path)
{
    const struct glint_image image =
        make_image(GLINT_YUYV, 2, 1, (void *)"aAb1");

    glint_y4m_sink_open(&y4m, "/nowhere/x.y4m", 25, 1);
    assert_int_equal(y4m.sink.put(&y4m.sink, &image, &error), GLINT_E_OUTPUT);
    assert_null(y4m.mem);
    y4m.sink.close(&y4m.sink);
}

TEST(null_sink_accepts_images)
{
    const struct glint_image image =
        make_image(GLINT_YUYV, 2, 1, (void *)"aAb1");
    struct glint_null_sink null;

    glint_null_sink_open(&null);
    assert_ok(null.sink.put(&null.sink, &image, &error));
    assert_int_equal(null.n_frames, 1);
    null.sink.close(&null.sink);
}

/* ------------------------------------------------------------- V4L2 output */

static struct {
    /* values that the fake driver sets; 0: the requested value */
    uint32_t caps, stride, size, fourcc;
    /* the ioctl() request that fails */
    unsigned long fail_request;
    int fail_errno, write_errno;
    int n_streaming;
    ssize_t most; /* max number of bytes per write(); 0: no limit */
    struct v4l2_format set;
    struct v4l2_streamparm parm;
} node;

ssize_t __real_write(int fd, const void *data, size_t bytes);
ssize_t __wrap_write(int fd, const void *data, size_t bytes);

static void answer_set_format(struct v4l2_format *f)
{
    struct v4l2_pix_format *const px = &f->fmt.pix;

    assert_int_equal(f->type, V4L2_BUF_TYPE_VIDEO_OUTPUT);
    px->bytesperline = node.stride;
    px->sizeimage = node.size;
    if (node.fourcc)
        px->pixelformat = node.fourcc;
    node.set = *f;
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list args;
    void *arg;

    va_start(args, request);
    arg = va_arg(args, void *);
    va_end(args);
    if (!wrapped_is_file(fd, scratch_file) || !node.caps)
        return __real_ioctl(fd, request, arg);
    if (node.fail_errno && request == node.fail_request) {
        errno = node.fail_errno;
        return -1;
    }
    if (request == VIDIOC_QUERYCAP)
        *(struct v4l2_capability *)arg =
            (struct v4l2_capability){.card = "fake",
                                     .capabilities = V4L2_CAP_DEVICE_CAPS,
                                     .device_caps = node.caps};
    else if (request == VIDIOC_S_FMT)
        answer_set_format(arg);
    else if (request == VIDIOC_S_PARM)
        memcpy(&node.parm, arg, sizeof node.parm);
    else if (request == VIDIOC_STREAMON)
        node.n_streaming++;
    else
        fail_msg("ioctl %lx", request);
    return 0;
}

ssize_t __wrap_write(int fd, const void *data, size_t bytes)
{
    if (!node.caps || !wrapped_is_file(fd, scratch_file))
        return __real_write(fd, data, bytes);
    if (node.write_errno) {
        errno = node.write_errno;
        return -1;
    }
    if (node.most && bytes > (size_t)node.most)
        bytes = (size_t)node.most;
    return __real_write(fd, data, bytes);
}

static void reset_fake_v4l2_node(void)
{
    memset(&node, 0, sizeof node);
    node.caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_READWRITE;
    assert_int_equal(truncate(scratch_file, 0), 0);
}

static void open_v4l2_sink(struct glint_v4l2_sink *out,
                           const struct glint_image *like)
{
    if (glint_v4l2_sink_open(out, scratch_file, like, 30, 1, &error))
        fail_msg("%s", error.text);
}

TEST(v4l2_writes_an_image)
{
    struct glint_image image = make_image(GLINT_YUYV, 2, 2, (void *)"aAb1cBd2");
    struct glint_v4l2_sink out;

    reset_fake_v4l2_node();
    image.matrix = GLINT_MATRIX_BT709;
    open_v4l2_sink(&out, &image);
    assert_string_equal(out.card, "fake");
    assert_int_equal(node.set.fmt.pix.pixelformat, V4L2_PIX_FMT_YUYV);
    assert_int_equal(node.set.fmt.pix.ycbcr_enc, V4L2_YCBCR_ENC_709);
    assert_int_equal(node.set.fmt.pix.quantization,
                     V4L2_QUANTIZATION_LIM_RANGE);
    assert_int_equal(node.set.fmt.pix.priv, V4L2_PIX_FMT_PRIV_MAGIC);
    assert_int_equal(node.parm.parm.output.timeperframe.denominator, 30);
    assert_ok(out.sink.put(&out.sink, &image, &error));
    scratch_expect_bytes(scratch_file, "aAb1cBd2", 8);
    assert_int_equal(out.n_frames, 1);
    assert_int_equal(node.n_streaming, 1);
    out.sink.close(&out.sink);
    out.sink.close(&out.sink);
    assert_int_equal(out.fd, -1);
}

/* Checks that rows are copied between images and devices with different row
 * padding. */
TEST(v4l2_writes_padded_rows)
{
    static const uint8_t zero;
    struct glint_image image =
        make_image(GLINT_I420, 4, 2, (void *)"abcdefghABCD");
    struct glint_v4l2_sink out;
    char want[] = "abcd..efgh..AB.CD.";

    for (char *c = want; *c; c++)
        if (*c == '.')
            *c = (char)zero;
    reset_fake_v4l2_node();
    node.stride = 6;
    node.size = 100;
    open_v4l2_sink(&out, &image);
    assert_ok(out.sink.put(&out.sink, &image, &error));
    scratch_expect_bytes(scratch_file, want, 18);
    out.sink.close(&out.sink);

    reset_fake_v4l2_node();
    image = make_image(GLINT_YUYV, 2, 2, (void *)"aAb1..cBd2");
    image.stride_bytes[0] = 6;
    open_v4l2_sink(&out, &image);
    assert_ok(out.sink.put(&out.sink, &image, &error));
    scratch_expect_bytes(scratch_file, "aAb1cBd2", 8);
    out.sink.close(&out.sink);

    reset_fake_v4l2_node();
    image = make_image(GLINT_NV12, 2, 2, (void *)"abcdA1");
    node.stride = 3;
    open_v4l2_sink(&out, &image);
    assert_ok(out.sink.put(&out.sink, &image, &error));
    scratch_expect_bytes(scratch_file, "ab\0cd\0A1", 9);
    out.sink.close(&out.sink);

    reset_fake_v4l2_node(); /* an image whose planes are not contiguous */
    image = make_image(GLINT_NV12, 2, 2, (void *)"abcd..A1");
    image.plane[1] += 2;
    open_v4l2_sink(&out, &image);
    assert_ok(out.sink.put(&out.sink, &image, &error));
    scratch_expect_bytes(scratch_file, "abcdA1", 6);
    out.sink.close(&out.sink);
}

TEST(v4l2_drops_frames_without_a_buffer)
{
    const struct glint_image image =
        make_image(GLINT_GREY, 4, 1, (void *)"abcd");
    struct glint_v4l2_sink out;

    reset_fake_v4l2_node();
    open_v4l2_sink(&out, &image);
    node.write_errno = EAGAIN;
    assert_ok(out.sink.put(&out.sink, &image, &error));
    assert_int_equal(out.n_dropped, 1);
    node.write_errno = ENODEV;
    assert_int_equal(out.sink.put(&out.sink, &image, &error), GLINT_E_DEVICE);
    assert_non_null(strstr(error.text, ": write: "));
    assert_non_null(strstr(error.text, "was removed"));
    node.write_errno = 0;
    node.most = 3;
    assert_int_equal(out.sink.put(&out.sink, &image, &error), GLINT_E_DEVICE);
    assert_non_null(strstr(error.text, "accepted 3 of 4 bytes of a frame"));
    assert_int_equal(out.n_frames, 0);
    out.sink.close(&out.sink);
}

static void expect_rejected(enum glint_status status, const char *part)
{
    const struct glint_image image =
        make_image(GLINT_YUYV, 2, 2, (void *)"aAb1cBd2");
    struct glint_v4l2_sink out;

    assert_int_equal(
        glint_v4l2_sink_open(&out, scratch_file, &image, 30, 1, &error),
        status);
    if (!strstr(error.text, part))
        fail_msg("\"%s\" is not in \"%s\"", part, error.text);
    assert_int_equal(out.fd, -1);
    assert_null(out.mem);
}

TEST(v4l2_rejects_unsuitable_devices)
{
    struct glint_image image = make_image(GLINT_YUYV, 2, 2, (void *)"aAb1cBd2");
    struct glint_v4l2_sink out;

    reset_fake_v4l2_node();
    node.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    expect_rejected(GLINT_E_DEVICE, "fake is not a video output");
    node.caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    expect_rejected(GLINT_E_DEVICE, "does not accept frames by write()");
    reset_fake_v4l2_node();
    node.fourcc = V4L2_PIX_FMT_MJPEG;
    expect_rejected(GLINT_E_DEVICE, "accepts MJPG 2 x 2, not YUYV 2 x 2");
    reset_fake_v4l2_node();
    node.fail_request = VIDIOC_S_FMT;
    node.fail_errno = EBUSY;
    expect_rejected(GLINT_E_DEVICE, "VIDIOC_S_FMT: Device or resource busy; "
                                    "another program");
    reset_fake_v4l2_node();
    node.stride = 8;
    node.size = 15;
    expect_rejected(GLINT_E_DEVICE, "frames of 15 bytes with rows of 8");
    reset_fake_v4l2_node();
    node.fail_request = VIDIOC_QUERYCAP;
    node.fail_errno = ENODEV;
    expect_rejected(GLINT_E_DEVICE, "VIDIOC_QUERYCAP: No such device");
    node.caps = 0; /* a regular file */
    expect_rejected(GLINT_E_DEVICE, "is not a video device");
    image.format = GLINT_I444;
    assert_int_equal(
        glint_v4l2_sink_open(&out, scratch_file, &image, 0, 0, &error),
        GLINT_E_UNSUPPORTED);
    image.format = GLINT_YUYV;
    assert_int_equal(
        glint_v4l2_sink_open(&out, "/dev/video-none", &image, 0, 0, &error),
        GLINT_E_DEVICE);
    assert_non_null(strstr(error.text, "modprobe v4l2loopback"));
    /* The driver reports the same pixel format by another FOURCC. */
    reset_fake_v4l2_node();
    node.fourcc = V4L2_PIX_FMT_BGR32;
    image.format = GLINT_XRGB8888;
    open_v4l2_sink(&out, &image);
    out.sink.close(&out.sink);
    image.format = GLINT_YUYV;
    /* the driver has no setting for the frame rate */
    reset_fake_v4l2_node();
    node.fail_request = VIDIOC_S_PARM;
    node.fail_errno = ENOTTY;
    open_v4l2_sink(&out, &image);
    image.width = 1;
    assert_int_equal(out.sink.put(&out.sink, &image, &error), GLINT_E_DEVICE);
    out.sink.close(&out.sink);
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
