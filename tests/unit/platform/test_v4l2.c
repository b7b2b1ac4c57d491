/* SPDX-License-Identifier: MIT
 *
 * Tests the V4L2 source on a fake driver without faults: the choice of format,
 * the layout of planes, which frames are delivered, and the counts of dropped
 * frames.
 */
#include "support/fakes/camera_check.h"

#include "jpeg/mjpeg.h"

/* ------------------------------------------------------------------ formats */

/* Returns the FOURCC that the source chooses from the N modes of LIST when
 * 64 x 48 pixels at FPS frames per second are requested. */
static uint32_t choose_fourcc(const struct fake_mode *list, int n, int fps)
{
    struct glint_v4l2_config wish = any_camera;
    uint32_t fourcc;

    fake_camera_reset();
    memset(camera.mode, 0, sizeof camera.mode);
    memcpy(camera.mode, list, (size_t)n * sizeof *list);
    wish.width = 64;
    wish.height = 48;
    wish.fps_num = fps;
    wish.fps_den = 1;
    must_open(&wish);
    fourcc = v4l2.device.format.fourcc;
    must_close();
    return fourcc;
}

TEST_BEFORE
{
    fake_camera_reset();
}

TEST(cheapest)
{
    static const struct fake_mode equal[] = {
        {V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1},
        {V4L2_PIX_FMT_RGB24, 64, 48, 30, 1},
        {V4L2_PIX_FMT_NV12, 64, 48, 30, 1},
        {V4L2_PIX_FMT_YUYV, 64, 48, 30, 1}};
    static const struct fake_mode slow[] = {
        {V4L2_PIX_FMT_YUYV, 64, 48, 10, 1},
        {V4L2_PIX_FMT_YUYV, 32, 24, 30, 1},
        {V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1}};
    static const struct fake_mode small[] = {
        {V4L2_PIX_FMT_YUYV, 32, 24, 30, 1},
        {V4L2_PIX_FMT_RGB24, 64, 48, 30, 1}};
    static const struct fake_mode foreign[] = {
        {V4L2_PIX_FMT_H264, 64, 48, 30, 1}, {V4L2_PIX_FMT_GREY, 64, 48, 30, 1}};

    assert_int_equal(choose_fourcc(equal, 4, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(choose_fourcc(equal, 3, 30), V4L2_PIX_FMT_NV12);
    assert_int_equal(choose_fourcc(equal, 2, 30), V4L2_PIX_FMT_RGB24);
    assert_int_equal(choose_fourcc(slow, 3, 30), V4L2_PIX_FMT_MJPEG);
    assert_int_equal(choose_fourcc(slow, 3, 10), V4L2_PIX_FMT_YUYV);
    /* no mode reaches the rate */
    assert_int_equal(choose_fourcc(slow, 3, 60), V4L2_PIX_FMT_YUYV);
    assert_int_equal(choose_fourcc(small, 2, 30), V4L2_PIX_FMT_RGB24);
    assert_int_equal(choose_fourcc(foreign, 2, 30), V4L2_PIX_FMT_GREY);
}

/* Checks that a rate requested without a size is searched among the modes of
 * the camera's present size. */
TEST(rate_alone)
{
    struct glint_v4l2_config wish = any_camera;

    camera.mode[0].fps_num = 10;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1};
    wish.fps_num = 30;
    wish.fps_den = 1;
    must_open(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_MJPEG);
    assert_int_equal(v4l2.device.format.fps_num, 30);
    must_close();
}

/* Checks that intervals of 333334 units of 100 ns (reported by some USB
 * cameras) and of 1001/30000 s match a request of 30 frames per second, and
 * that 24 frames per second do not match 25. */
TEST(almost_the_rate)
{
    static const struct fake_mode usb[] = {
        {V4L2_PIX_FMT_YUYV, 64, 48, 10000000, 333334},
        {V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1}};
    static const struct fake_mode ntsc[] = {
        {V4L2_PIX_FMT_YUYV, 64, 48, 30000, 1001},
        {V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1}};
    static const struct fake_mode film[] = {
        {V4L2_PIX_FMT_YUYV, 64, 48, 24, 1},
        {V4L2_PIX_FMT_MJPEG, 64, 48, 25, 1}};

    assert_int_equal(choose_fourcc(usb, 2, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(choose_fourcc(ntsc, 2, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(choose_fourcc(film, 2, 25), V4L2_PIX_FMT_MJPEG);
}

TEST(stepwise)
{
    struct glint_v4l2_config wish = any_camera;

    camera.is_stepwise = true;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_RGB24, 256, 128, 60, 1};
    wish.width = 200;
    wish.height = 100;
    must_open(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_RGB24);
    assert_int_equal(v4l2.device.format.width, 200);
    must_close();
    fake_camera_reset();
    camera.has_no_sizes = true;
    must_open(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_YUYV);
    must_close();
}

/* Checks that MJPG is not chosen in a build without libjpeg. */
TEST(no_jpeg)
{
    fake_lacks_jpeg = true;
    camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_GREY, 64, 48, 30, 1};
    must_open(NULL);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_GREY);
    must_close();
}

TEST(unread_format)
{
    struct glint_v4l2_config wish = any_camera;

    camera.mode[0].fourcc = camera.now.fourcc = V4L2_PIX_FMT_H264;
    must_refuse(NULL, GLINT_E_UNSUPPORTED,
                FAKE_PATH
                ": delivers pixel format H264, which glint does not support; "
                "--list-formats");
    fake_camera_reset();
    wish.fourcc = V4L2_PIX_FMT_NV12;
    must_refuse(&wish, GLINT_E_DEVICE,
                "does not support NV12 (the driver returns YUYV instead)");
}

/* Checks that the format which the camera sets is used, even if another was
 * requested. */
TEST(believes)
{
    struct glint_v4l2_config wish = any_camera;

    camera.rounds = true;
    wish.width = 50;
    wish.height = 40;
    wish.fps_num = 25;
    wish.fps_den = 1;
    must_open(&wish);
    assert_int_equal(v4l2.device.format.width, 64);
    assert_int_equal(v4l2.device.format.height, 48);
    assert_int_equal(v4l2.device.format.fps_num, 30);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    assert_int_equal(frame.image.width, 64);
    assert_int_equal(frame.image.height, 48);
    done();
    must_close();
}

TEST(odd_rates)
{
    static const struct v4l2_fract odd[] = {
        {1, 0}, {1, UINT32_MAX}, {UINT32_MAX, 1}, {UINT32_MAX, UINT32_MAX}};

    for (int i = 0; i < 4; i++) {
        fake_camera_reset();
        camera.rate = odd[i];
        must_open(NULL);
        /* A rate out of range is reported as unknown. */
        assert_int_equal(v4l2.device.format.fps_num, 0);
        must_close();
    }
}

TEST(inputs)
{
    struct glint_v4l2_config wish = any_camera;

    camera.n_inputs = 2;
    wish.input = 1;
    must_open(&wish);
    assert_int_equal(camera.input, 1);
    must_close();
    wish.input = 2;
    must_refuse(&wish, GLINT_E_DEVICE, "has no input 2");
    fake_camera_refuse(VIDIOC_S_INPUT, EBUSY, 1);
    must_refuse(&wish, GLINT_E_DEVICE,
                "VIDIOC_S_INPUT: Device or resource busy; another program");
}

TEST(colours)
{
    struct glint_v4l2_config wish = any_camera;

    camera.quantization = V4L2_QUANTIZATION_FULL_RANGE;
    camera.ycbcr_enc = V4L2_YCBCR_ENC_709;
    must_open(NULL);
    assert_int_equal(v4l2.device.format.range, GLINT_RANGE_FULL);
    assert_int_equal(v4l2.device.format.matrix, GLINT_MATRIX_BT709);
    must_close();
    wish.range = GLINT_RANGE_LIMITED;
    wish.matrix = GLINT_MATRIX_BT601;
    must_open(&wish);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    assert_int_equal(frame.image.range, GLINT_RANGE_LIMITED);
    assert_int_equal(frame.image.matrix, GLINT_MATRIX_BT601);
    done();
    must_close();
}

/* Checks that a long device name, as udev creates them, is accepted, and
 * that one longer than the buffer is rejected. */
TEST(long_names)
{
    struct glint_v4l2_config wish = any_camera;
    char name[400];

    memset(name, 'x', sizeof name);
    memcpy(name, "/dev/", 5);
    name[120] = '\0';
    wish.device = name;
    must_refuse(&wish, GLINT_E_DEVICE, "xxx: no such device");
    assert_int_equal(strlen(v4l2.device.path), 120);
    name[120] = 'x';
    name[399] = '\0';
    must_refuse(&wish, GLINT_E_DEVICE, "name is too long");
    wish.device = "77"; /* short for /dev/video77 */
    must_open(&wish);
    must_close();
}

/* ------------------------------------------------------------------- layout */

static void use_format(uint32_t fourcc, bool multiplanar)
{
    fake_camera_reset();
    camera.mode[0].fourcc = camera.now.fourcc = fourcc;
    camera.multiplanar = multiplanar;
    if (multiplanar)
        camera.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
}

/* Checks the plane's offset from the start of BLOCK and its stride, in
 * bytes. */
static void expect_plane(int plane, const uint8_t *block, ptrdiff_t offset,
                         ptrdiff_t stride)
{
    assert_int_equal(frame.image.plane[plane] - block, offset);
    assert_int_equal(frame.image.stride_bytes[plane], stride);
}

static const uint8_t *find_block(int k)
{
    return camera.buffer[0].map[k];
}

TEST(strides)
{
    use_format(V4L2_PIX_FMT_YUYV, false);
    camera.stride_more = 24;
    must_open(NULL);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    expect_plane(0, find_block(0), 0, 2 * 64 + 24);
    done();
    must_close();
    camera.stride_more = 0;
    camera.says_no_stride = true;
    must_open(NULL);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    expect_plane(0, find_block(0), 0, 2 * 64);
    done();
    must_close();
}

TEST(one_block)
{
    use_format(V4L2_PIX_FMT_NV12, false);
    camera.stride_more = 16;
    must_open(NULL);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    expect_plane(0, find_block(0), 0, 80);
    expect_plane(1, find_block(0), 80 * 48, 80);
    done();
    must_close();
    use_format(V4L2_PIX_FMT_YUV420, true);
    camera.stride_more = 16;
    must_open(NULL);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    expect_plane(0, find_block(0), 0, 80);
    expect_plane(1, find_block(0), 80 * 48, 40);
    expect_plane(2, find_block(0), 80 * 48 + 40 * 24, 40);
    done();
    must_close();
}

TEST(several_blocks)
{
    struct fake_frame *f;

    use_format(V4L2_PIX_FMT_NV12M, true);
    camera.stride_more = 16;
    must_open(NULL);
    assert_int_equal(v4l2.device.format.n_blocks, 2);
    fake_camera_deliver(0, 9);
    assert_int_equal(next(), GLINT_OK);
    assert_int_equal(frame.image.format, GLINT_NV12);
    expect_plane(0, find_block(0), 0, 80);
    expect_plane(1, find_block(1), 0, 80);
    done();
    must_close();
    use_format(V4L2_PIX_FMT_YUV420M, true);
    must_open(NULL);
    f = fake_camera_deliver(0, 9);
    f->is_odd = true; /* keeps the sizes below as they are set */
    f->bytesused[0] = 64 * 48;
    f->bytesused[1] = f->bytesused[2] = 32 * 24;
    assert_int_equal(next(), GLINT_OK);
    assert_non_null(frame.image.plane[0]);
    expect_plane(2, find_block(2), 0, 32);
    done();
    f = fake_camera_deliver(1, 9);
    f->is_odd = true;
    f->bytesused[0] = 64 * 48;
    f->bytesused[1] = 32 * 24;
    must_get_nothing(); /* the third plane is empty */
    assert_int_equal(frame.n_corrupt, 1);
    must_close();
}

/* Checks that data which the driver puts before the image is skipped. */
TEST(data_offset)
{
    struct fake_frame *f;

    use_format(V4L2_PIX_FMT_YUYV, true);
    camera.sizeimage = 2 * 64 * 48 + 32;
    must_open(NULL);
    f = fake_camera_deliver(0, 9);
    f->is_odd = true;
    f->data_offset[0] = 32;
    f->bytesused[0] = 2 * 64 * 48 + 32;
    assert_int_equal(next(), GLINT_OK);
    expect_plane(0, find_block(0), 32, 2 * 64);
    done();
    f = fake_camera_deliver(1, 9);
    f->is_odd = true;
    f->data_offset[0] = 33;
    f->bytesused[0] = 2 * 64 * 48 + 32;
    must_get_nothing();
    assert_int_equal(frame.n_corrupt, 1);
    f = fake_camera_deliver(2, 9);
    f->is_odd = true;
    f->data_offset[0] = 4000; /* beyond the 100 bytes used */
    f->bytesused[0] = 100;
    must_get_nothing();
    assert_int_equal(frame.n_corrupt, 1);
    must_close();
}

TEST(too_small)
{
    camera.sizeimage = 2 * 64 * 48 - 1;
    must_refuse(
        NULL, GLINT_E_DEVICE,
        "64x48 YUYV needs more bytes than the 6143 that the driver reports");
    fake_camera_reset();
    /* The driver reports a larger buffer than it has. */
    camera.length_less = 1;
    must_open(NULL);
    fake_camera_deliver(0, 9);
    must_get_nothing();
    assert_int_equal(frame.n_corrupt, 1);
    must_close();
    fake_camera_reset();
    camera.now.width = GLINT_MAX_SIDE + 1;
    must_refuse(NULL, GLINT_E_UNSUPPORTED, "pictures of ");
}

/* ------------------------------------------------------------------- frames */

static void deliver_odd(uint32_t sequence, uint32_t bytesused)
{
    struct fake_frame *f = fake_camera_deliver(sequence, 9);

    f->is_odd = true;
    f->bytesused[0] = bytesused;
}

TEST(damaged)
{
    must_open(NULL);
    deliver_odd(0, 0);
    deliver_odd(1, 2 * 64 * 48 - 1);
    deliver_odd(2, 2 * 64 * 48 + 1);
    fake_camera_deliver(3, 9)->flags = V4L2_BUF_FLAG_ERROR;
    must_get_nothing();
    assert_int_equal(frame.n_corrupt, 4);
    assert_int_equal(frame.n_dropped, 0);
    assert_int_equal(camera.n_queued, 4);
    deliver_odd(4, 2 * 64 * 48);
    must_get(9);
    assert_int_equal(frame.n_corrupt, 0);
    must_close();
}

/* Checks that an intact frame is delivered even if a damaged frame precedes
 * or follows it. */
TEST(damaged_among_whole)
{
    must_open(NULL);
    fake_camera_deliver(0, 9)->flags = V4L2_BUF_FLAG_ERROR;
    fake_camera_deliver(1, 8);
    fake_camera_deliver(2, 7)->flags = V4L2_BUF_FLAG_ERROR;
    must_get(8);
    assert_int_equal(frame.n_corrupt, 2);
    assert_int_equal(frame.n_late, 0);
    assert_int_equal(camera.n_queued, 4);
    must_close();
}

TEST(newest)
{
    must_open(NULL);
    must_get_nothing();
    for (int i = 0; i < 3; i++)
        fake_camera_deliver((uint32_t)i, 10 + i)->time_us = 5000 + i;
    assert_int_equal(next(), GLINT_OK);
    assert_int_equal(frame.image.plane[0][0], 12);
    assert_int_equal(frame.n_late, 2);
    assert_int_equal(frame.n_dropped, 0);
    assert_int_equal(frame.sequence, 2);
    assert_int_equal(frame.time_us, 5002);
    /* One of the four buffers is lent to the caller. */
    assert_int_equal(camera.n_queued, 3);
    fake_camera_deliver(3, 13);
    done();
    assert_int_equal(camera.n_queued, 4);
    done(); /* A second release has no effect. */
    assert_int_equal(camera.n_queued, 4);
    must_get(13);
    must_close();
}

static int64_t read_stamp(int64_t stamp_us, bool unknown_clock)
{
    struct fake_frame *f = fake_camera_deliver(0, 1);

    f->time_us = stamp_us;
    f->unknown_clock = unknown_clock;
    must_get(1);
    return frame.time_us;
}

/* Checks that a plausible time stamp of an unknown clock is used, and that
 * no time stamp is later than the present. */
TEST(stamps)
{
    const int64_t now_us = fake_camera_now();

    must_open(NULL);
    assert_int_equal(read_stamp(now_us - 30000, false), now_us - 30000);
    assert_int_equal(read_stamp(now_us - 30000, true), now_us - 30000);
    assert_int_equal(read_stamp(now_us - 9000000, true), now_us);
    assert_int_equal(read_stamp(now_us + 5000, false), now_us);
    assert_int_equal(read_stamp(now_us + 5000, true), now_us);
    must_close();
}

/* Checks that a lent frame is unchanged while other frames arrive. */
TEST(lent)
{
    struct glint_source_frame kept;

    must_open(NULL);
    fake_camera_deliver(0, 50);
    assert_int_equal(next(), GLINT_OK);
    kept = frame;
    for (int i = 1; i < 20; i++) {
        fake_camera_deliver((uint32_t)i, i);
        must_get(i);
        assert_int_equal(kept.image.plane[0][0], 50);
        assert_int_equal(camera.n_queued, 3);
    }
    v4l2.source.done(&v4l2.source, &kept);
    assert_int_equal(camera.n_queued, 4);
    must_close();
}

/* Checks that an open camera has its format locked but does not stream
 * before start(), also after a restart, and that next() starts it as well. */
TEST(streams_when_started)
{
    assert_int_equal(
        glint_v4l2_open(&v4l2, &any_camera, GLINT_V4L2_AUTO, 4, &said),
        GLINT_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(camera.n_streamons, i);
        assert_false(camera.streams);
        assert_int_equal(camera.n_buffers, 4);
        assert_int_equal(camera.n_queued, 0);
        assert_int_equal(v4l2.source.start(&v4l2.source, &said), GLINT_OK);
        assert_int_equal(camera.n_streamons, i + 1);
        assert_int_equal(camera.n_queued, 4);
        assert_int_equal(v4l2.source.start(&v4l2.source, &said), GLINT_OK);
        assert_int_equal(camera.n_streamons, i + 1);
        camera.is_broken = true;
        must_get_nothing();
    }
    assert_false(camera.streams);
    fake_camera_deliver(0, 5);
    must_get(5);
    assert_int_equal(camera.n_streamons, 3);
    must_close();
}

static int count_dropped(uint32_t sequence)
{
    fake_camera_deliver(sequence, 9);
    must_get(9);
    return frame.n_dropped;
}

TEST(sequence)
{
    must_open(NULL);
    /* The sequence may start at any number. */
    assert_int_equal(count_dropped(1000), 0);
    assert_int_equal(count_dropped(1001), 0);
    assert_int_equal(count_dropped(1005), 3);
    assert_int_equal(count_dropped(1005), 0);
    assert_int_equal(count_dropped(3),
                     0); /* sequence restarted by the driver */
    assert_int_equal(count_dropped(4), 0);
    must_close();
    must_open(NULL);
    assert_int_equal(count_dropped(UINT32_MAX - 1), 0);
    assert_int_equal(count_dropped(UINT32_MAX), 0);
    assert_int_equal(count_dropped(0), 0);
    assert_int_equal(count_dropped(2), 1);
    must_close();
    must_open(NULL);
    /* left over from before the stream, as v4l2loopback sends it */
    assert_int_equal(count_dropped(0), 0);
    assert_int_equal(count_dropped(28), 0);
    assert_int_equal(count_dropped(30), 1);
    must_close();
    must_open(NULL); /* Some drivers leave the sequence at 0. */
    for (int i = 0; i < 5; i++)
        assert_int_equal(count_dropped(0), 0);
    must_close();
}

/* Checks that gaps and damaged frames before a delivered frame are counted
 * together. */
TEST(gaps_add_up)
{
    must_open(NULL);
    assert_int_equal(count_dropped(6),
                     0); /* left over from before the stream */
    assert_int_equal(count_dropped(0), 0);
    fake_camera_deliver(2, 1)->flags = V4L2_BUF_FLAG_ERROR;
    fake_camera_deliver(5, 2);
    fake_camera_deliver(7, 3);
    must_get(3);
    assert_int_equal(frame.n_dropped, 4);
    assert_int_equal(frame.n_corrupt, 1);
    assert_int_equal(frame.n_late, 1);
    must_close();
}

/* Checks that implausible jumps of the sequence are not counted as dropped
 * frames, and that their sum does not overflow. */
TEST(leaps)
{
    must_open(NULL);
    assert_int_equal(count_dropped(0), 0);
    for (uint32_t i = 1; i <= 3; i++)
        fake_camera_deliver(i * 0x7fffffff, 9);
    must_get(9);
    assert_int_equal(frame.n_dropped, 0);
    must_close();
}

TEST(jpeg)
{
    static const char garbage[] = "not a JPEG at all";

    if (!glint_mjpeg_available())
        skip();
    camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    must_open(NULL);
    for (uint32_t i = 0; i < 3; i++) {
        struct fake_frame *f = fake_camera_deliver(i, 0);

        f->data = garbage;
        f->bytesused[0] = sizeof garbage;
    }
    must_get_nothing();
    assert_int_equal(frame.n_corrupt, 1);
    assert_int_equal(frame.n_late, 2);
    assert_int_equal(camera.n_queued, 4);
    must_close();
}

/* --------------------------------------------------- other kinds of memory */

static void check_io_method(enum glint_v4l2_io wish, enum glint_v4l2_io got)
{
    if (try_open(NULL, wish))
        fail_msg("%s", said.text);
    assert_int_equal(v4l2.io, got);
    for (uint32_t i = 0; i < 10; i++) {
        fake_camera_deliver(i, 20 + (int)i);
        must_get(20 + (int)i);
        assert_int_equal(frame.n_dropped, 0);
    }
    assert_int_equal(camera.n_maps, got == GLINT_V4L2_MMAP ? 4 : 0);
    must_close();
}

TEST(memory)
{
    check_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_MMAP);
    check_io_method(GLINT_V4L2_MMAP, GLINT_V4L2_MMAP);
    check_io_method(GLINT_V4L2_USERPTR, GLINT_V4L2_USERPTR);
    camera.lacks_mmap = true;
    check_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_USERPTR);
    use_format(V4L2_PIX_FMT_NV12M, true);
    check_io_method(GLINT_V4L2_USERPTR, GLINT_V4L2_USERPTR);
    fake_camera_reset();
    camera.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    check_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_READ);
    check_io_method(GLINT_V4L2_READ, GLINT_V4L2_READ);
}

/* Checks that a type of memory which the device lacks is reported as such,
 * not as a failed request. */
TEST(no_such_memory)
{
    assert_int_equal(try_open(NULL, GLINT_V4L2_READ), GLINT_E_DEVICE);
    assert_non_null(
        strstr(said.text, "as --io allows: Operation not supported"));
    must_be_closed();
    camera.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    assert_int_equal(try_open(NULL, GLINT_V4L2_MMAP), GLINT_E_DEVICE);
    assert_non_null(strstr(said.text, "as --io allows: "));
    must_be_closed();
}

TEST(few_buffers)
{
    camera.max_buffers = 2;
    must_open(NULL);
    assert_int_equal(v4l2.n_buffers, 2);
    for (uint32_t i = 0; i < 10; i++) {
        fake_camera_deliver(i, (int)i);
        must_get((int)i);
    }
    must_close();
    camera.max_buffers = 0;
    must_refuse(NULL, GLINT_E_DEVICE, "VIDIOC_REQBUFS: Cannot allocate memory");
}

/* Checks that the message names the request that failed first, even if a
 * fallback was tried or a resource freed after it. */
TEST(names_what_failed)
{
    fake_camera_refuse(VIDIOC_QUERYBUF, EIO, 1);
    must_refuse(NULL, GLINT_E_DEVICE,
                FAKE_PATH ": VIDIOC_QUERYBUF: Input/output error");
    fake_camera_refuse(VIDIOC_REQBUFS, ENOMEM, -1);
    must_refuse(NULL, GLINT_E_DEVICE,
                FAKE_PATH ": VIDIOC_REQBUFS: Cannot allocate memory");
    fake_camera_refuse(VIDIOC_REQBUFS, EBUSY, -1);
    must_refuse(NULL, GLINT_E_DEVICE,
                "VIDIOC_REQBUFS: Device or resource busy; another program is "
                "using it");
}
