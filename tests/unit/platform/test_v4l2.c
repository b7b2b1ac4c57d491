/* SPDX-License-Identifier: MIT
 *
 * Tests the V4L2 source on a fake driver without faults: how it chooses a
 * format, where it expects the planes of an image, which frames it delivers,
 * and how many dropped frames it counts.
 */
#include "support/fakes/camera_check.h"

#include "jpeg/mjpeg.h"

/* ------------------------------------------------------------------ formats */

/* Returns the FOURCC that the source chooses from the modes LIST[N] when 64 x
 * 48 pixels and FPS frames per second are requested. */
static uint32_t open_and_read_fourcc(const struct fake_mode *list, int n,
                                     int fps)
{
    struct glint_v4l2_config wish = any_camera;
    uint32_t fourcc;

    must_reset_camera();
    memset(camera.mode, 0, sizeof camera.mode);
    memcpy(camera.mode, list, (size_t)n * sizeof *list);
    wish.width = 64;
    wish.height = 48;
    wish.fps_num = fps;
    wish.fps_den = 1;
    must_open_camera(&wish);
    fourcc = v4l2.device.format.fourcc;
    return fourcc;
}

TEST(chooses_the_cheapest_format)
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

    assert_int_equal(open_and_read_fourcc(equal, 4, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(open_and_read_fourcc(equal, 3, 30), V4L2_PIX_FMT_NV12);
    assert_int_equal(open_and_read_fourcc(equal, 2, 30), V4L2_PIX_FMT_RGB24);
    assert_int_equal(open_and_read_fourcc(slow, 3, 30), V4L2_PIX_FMT_MJPEG);
    assert_int_equal(open_and_read_fourcc(slow, 3, 10), V4L2_PIX_FMT_YUYV);
    /* no mode reaches the requested rate */
    assert_int_equal(open_and_read_fourcc(slow, 3, 60), V4L2_PIX_FMT_YUYV);
    assert_int_equal(open_and_read_fourcc(small, 2, 30), V4L2_PIX_FMT_RGB24);
    assert_int_equal(open_and_read_fourcc(foreign, 2, 30), V4L2_PIX_FMT_GREY);
}

/* Requests a frame rate but no size. Checks that the source chooses among the
 * modes that have the camera's present size. */
TEST(rate_without_size_keeps_the_size)
{
    struct glint_v4l2_config wish = any_camera;

    camera.mode[0].fps_num = 10;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_MJPEG, 64, 48, 30, 1};
    wish.fps_num = 30;
    wish.fps_den = 1;
    must_open_camera(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_MJPEG);
    assert_int_equal(v4l2.device.format.fps_num, 30);
}

/* Checks that two frame intervals match a request of 30 frames per second:
 * 1001/30000 s, and 333334 units of 100 ns, as some USB cameras report. A
 * camera with 24 frames per second must not match 25. */
TEST(nearly_equal_rates_match)
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

    assert_int_equal(open_and_read_fourcc(usb, 2, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(open_and_read_fourcc(ntsc, 2, 30), V4L2_PIX_FMT_YUYV);
    assert_int_equal(open_and_read_fourcc(film, 2, 25), V4L2_PIX_FMT_MJPEG);
}

TEST(chooses_from_stepwise_sizes)
{
    struct glint_v4l2_config wish = any_camera;

    camera.is_stepwise = true;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_RGB24, 256, 128, 60, 1};
    wish.width = 200;
    wish.height = 100;
    must_open_camera(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_RGB24);
    assert_int_equal(v4l2.device.format.width, 200);
    must_reset_camera();
    camera.has_no_sizes = true;
    must_open_camera(&wish);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_YUYV);
}

TEST(mjpg_needs_libjpeg)
{
    fake_lacks_jpeg = true;
    camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    camera.mode[1] = (struct fake_mode){V4L2_PIX_FMT_GREY, 64, 48, 30, 1};
    must_open_camera(NULL);
    assert_int_equal(v4l2.device.format.fourcc, V4L2_PIX_FMT_GREY);
}

TEST(rejects_unsupported_formats)
{
    struct glint_v4l2_config wish = any_camera;

    camera.mode[0].fourcc = camera.now.fourcc = V4L2_PIX_FMT_H264;
    must_refuse_to_open(NULL, GLINT_E_UNSUPPORTED,
                        FAKE_PATH ": delivers pixel format H264, which glint "
                                  "does not support; --list-formats");
    must_reset_camera();
    wish.fourcc = V4L2_PIX_FMT_NV12;
    must_refuse_to_open(
        &wish, GLINT_E_DEVICE,
        "does not support NV12 (the driver returns YUYV instead)");
}

TEST(uses_the_format_that_the_camera_sets)
{
    struct glint_v4l2_config wish = any_camera;

    camera.rounds = true;
    wish.width = 50;
    wish.height = 40;
    wish.fps_num = 25;
    wish.fps_den = 1;
    must_open_camera(&wish);
    assert_int_equal(v4l2.device.format.width, 64);
    assert_int_equal(v4l2.device.format.height, 48);
    assert_int_equal(v4l2.device.format.fps_num, 30);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_int_equal(frame.image.width, 64);
    assert_int_equal(frame.image.height, 48);
    release_frame();
}

TEST(invalid_rates_are_unknown)
{
    static const struct v4l2_fract odd[] = {
        {1, 0}, {1, UINT32_MAX}, {UINT32_MAX, 1}, {UINT32_MAX, UINT32_MAX}};

    for (int i = 0; i < 4; i++) {
        must_reset_camera();
        camera.rate = odd[i];
        must_open_camera(NULL);
        /* a frame rate out of range is reported as unknown */
        assert_int_equal(v4l2.device.format.fps_num, 0);
    }
}

TEST(selects_the_input)
{
    struct glint_v4l2_config wish = any_camera;

    camera.n_inputs = 2;
    wish.input = 1;
    must_open_camera(&wish);
    assert_int_equal(camera.input, 1);
    wish.input = 2;
    must_refuse_to_open(&wish, GLINT_E_DEVICE, "has no input 2");
    fake_camera_fail_request(VIDIOC_S_INPUT, EBUSY, 1);
    must_refuse_to_open(
        &wish, GLINT_E_DEVICE,
        "VIDIOC_S_INPUT: Device or resource busy; another program");
}

TEST(reads_the_colour_declaration)
{
    struct glint_v4l2_config wish = any_camera;

    camera.quantization = V4L2_QUANTIZATION_FULL_RANGE;
    camera.ycbcr_enc = V4L2_YCBCR_ENC_709;
    must_open_camera(NULL);
    assert_int_equal(v4l2.device.format.range, GLINT_RANGE_FULL);
    assert_int_equal(v4l2.device.format.matrix, GLINT_MATRIX_BT709);
    wish.range = GLINT_RANGE_LIMITED;
    wish.matrix = GLINT_MATRIX_BT601;
    must_open_camera(&wish);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_int_equal(frame.image.range, GLINT_RANGE_LIMITED);
    assert_int_equal(frame.image.matrix, GLINT_MATRIX_BT601);
    release_frame();
}

/* Checks that a long device name, as created by udev, is accepted, and that a
 * name longer than the buffer is rejected. */
TEST(limits_the_device_name)
{
    struct glint_v4l2_config wish = any_camera;
    char name[400];

    memset(name, 'x', sizeof name);
    memcpy(name, "/dev/", 5);
    name[120] = '\0';
    wish.device = name;
    must_refuse_to_open(&wish, GLINT_E_DEVICE, "xxx: no such device");
    assert_int_equal(strlen(v4l2.device.path), 120);
    name[120] = 'x';
    name[399] = '\0';
    must_refuse_to_open(&wish, GLINT_E_DEVICE, "device is too long");
    wish.device = "77"; /* short for /dev/video77 */
    must_open_camera(&wish);
}

/* ------------------------------------------------------- planes and blocks */

static void set_camera_format(uint32_t fourcc, bool multiplanar)
{
    must_reset_camera();
    camera.mode[0].fourcc = camera.now.fourcc = fourcc;
    camera.multiplanar = multiplanar;
    if (multiplanar)
        camera.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
}

/* Checks that PLANE begins OFFSET bytes after BLOCK, with STRIDE bytes per
 * row. */
static void expect_plane_offset_and_stride(int plane, const uint8_t *block,
                                           ptrdiff_t offset, ptrdiff_t stride)
{
    assert_int_equal(frame.image.plane[plane] - block, offset);
    assert_int_equal(frame.image.stride_bytes[plane], stride);
}

static const uint8_t *address_of_mapped_block(int k)
{
    return camera.buffer[0].map[k];
}

TEST(reads_padded_rows)
{
    set_camera_format(V4L2_PIX_FMT_YUYV, false);
    camera.stride_more = 24;
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 0,
                                   2 * 64 + 24);
    release_frame();
    camera.stride_more = 0;
    camera.reports_no_stride = true;
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 0, 2 * 64);
    release_frame();
}

TEST(reads_planes_in_one_block)
{
    set_camera_format(V4L2_PIX_FMT_NV12, false);
    camera.stride_more = 16;
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 0, 80);
    expect_plane_offset_and_stride(1, address_of_mapped_block(0), 80 * 48, 80);
    release_frame();
    set_camera_format(V4L2_PIX_FMT_YUV420, true);
    camera.stride_more = 16;
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 0, 80);
    expect_plane_offset_and_stride(1, address_of_mapped_block(0), 80 * 48, 40);
    expect_plane_offset_and_stride(2, address_of_mapped_block(0),
                                   80 * 48 + 40 * 24, 40);
    release_frame();
}

TEST(reads_planes_in_several_blocks)
{
    struct fake_frame *f;

    set_camera_format(V4L2_PIX_FMT_NV12M, true);
    camera.stride_more = 16;
    must_open_camera(NULL);
    assert_int_equal(v4l2.device.format.n_blocks, 2);
    fake_camera_add_frame(0, 9);
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_int_equal(frame.image.format, GLINT_NV12);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 0, 80);
    expect_plane_offset_and_stride(1, address_of_mapped_block(1), 0, 80);
    release_frame();
    set_camera_format(V4L2_PIX_FMT_YUV420M, true);
    must_open_camera(NULL);
    f = fake_camera_add_frame(0, 9);
    f->is_odd = true; /* with this flag, bytesused of 0 means 0 bytes */
    f->bytesused[0] = 64 * 48;
    f->bytesused[1] = f->bytesused[2] = 32 * 24;
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_non_null(frame.image.plane[0]);
    expect_plane_offset_and_stride(2, address_of_mapped_block(2), 0, 32);
    release_frame();
    f = fake_camera_add_frame(1, 9);
    f->is_odd = true;
    f->bytesused[0] = 64 * 48;
    f->bytesused[1] = 32 * 24;
    /* the third plane is empty, so the frame is not delivered */
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 1);
}

TEST(skips_data_before_the_image)
{
    struct fake_frame *f;

    set_camera_format(V4L2_PIX_FMT_YUYV, true);
    camera.sizeimage = 2 * 64 * 48 + 32;
    must_open_camera(NULL);
    f = fake_camera_add_frame(0, 9);
    f->is_odd = true;
    f->data_offset[0] = 32;
    f->bytesused[0] = 2 * 64 * 48 + 32;
    assert_int_equal(get_next_frame(), GLINT_OK);
    expect_plane_offset_and_stride(0, address_of_mapped_block(0), 32, 2 * 64);
    release_frame();
    f = fake_camera_add_frame(1, 9);
    f->is_odd = true;
    f->data_offset[0] = 33;
    f->bytesused[0] = 2 * 64 * 48 + 32;
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 1);
    f = fake_camera_add_frame(2, 9);
    f->is_odd = true;
    f->data_offset[0] = 4000; /* an offset outside the 100 bytes in use */
    f->bytesused[0] = 100;
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 1);
}

TEST(rejects_too_small_buffers)
{
    camera.sizeimage = 2 * 64 * 48 - 1;
    must_refuse_to_open(
        NULL, GLINT_E_DEVICE,
        "64x48 YUYV needs more bytes than the 6143 that the driver reports");
    must_reset_camera();
    /* The driver states that its buffer is one byte larger than it is. */
    camera.length_less = 1;
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9);
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 1);
    must_reset_camera();
    camera.now.width = GLINT_MAX_SIDE + 1;
    must_refuse_to_open(NULL, GLINT_E_UNSUPPORTED, "pictures of ");
}

/* ---------------------------------------- damaged, lent and dropped frames */

static void deliver_frame_of_bytes(uint32_t sequence, uint32_t bytesused)
{
    struct fake_frame *f = fake_camera_add_frame(sequence, 9);

    f->is_odd = true;
    f->bytesused[0] = bytesused;
}

TEST(skips_damaged_frames)
{
    must_open_camera(NULL);
    deliver_frame_of_bytes(0, 0);
    deliver_frame_of_bytes(1, 2 * 64 * 48 - 1);
    deliver_frame_of_bytes(2, 2 * 64 * 48 + 1);
    fake_camera_add_frame(3, 9)->flags = V4L2_BUF_FLAG_ERROR;
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 4);
    assert_int_equal(frame.n_dropped, 0);
    assert_int_equal(camera.n_queued, 4);
    deliver_frame_of_bytes(4, 2 * 64 * 48);
    must_get_frame(9);
    assert_int_equal(frame.n_corrupt, 0);
}

/* Checks that an intact frame is delivered even if damaged frames precede or
 * follow it. */
TEST(delivers_intact_frames_among_damaged)
{
    must_open_camera(NULL);
    fake_camera_add_frame(0, 9)->flags = V4L2_BUF_FLAG_ERROR;
    fake_camera_add_frame(1, 8);
    fake_camera_add_frame(2, 7)->flags = V4L2_BUF_FLAG_ERROR;
    must_get_frame(8);
    assert_int_equal(frame.n_corrupt, 2);
    assert_int_equal(frame.n_late, 0);
    assert_int_equal(camera.n_queued, 4);
}

TEST(delivers_the_newest_frame)
{
    must_open_camera(NULL);
    must_get_no_frame();
    for (int i = 0; i < 3; i++)
        fake_camera_add_frame((uint32_t)i, 10 + i)->time_us = 5000 + i;
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_int_equal(frame.image.plane[0][0], 12);
    assert_int_equal(frame.n_late, 2);
    assert_int_equal(frame.n_dropped, 0);
    assert_int_equal(frame.sequence, 2);
    assert_int_equal(frame.time_us, 5002);
    /* one of the four buffers is lent to the caller */
    assert_int_equal(camera.n_queued, 3);
    fake_camera_add_frame(3, 13);
    release_frame();
    assert_int_equal(camera.n_queued, 4);
    release_frame(); /* releasing the frame again has no effect */
    assert_int_equal(camera.n_queued, 4);
    must_get_frame(13);
}

static int64_t read_frame_time_stamp(int64_t stamp_us, bool unknown_clock)
{
    struct fake_frame *f = fake_camera_add_frame(0, 1);

    f->time_us = stamp_us;
    f->unknown_clock = unknown_clock;
    must_get_frame(1);
    return frame.time_us;
}

/* Checks that a plausible time stamp is used even if its clock is unknown, and
 * that no frame gets a time stamp in the future. */
TEST(time_stamps_are_never_in_the_future)
{
    const int64_t now_us = fake_camera_time_us();

    must_open_camera(NULL);
    assert_int_equal(read_frame_time_stamp(now_us - 30000, false),
                     now_us - 30000);
    assert_int_equal(read_frame_time_stamp(now_us - 30000, true),
                     now_us - 30000);
    assert_int_equal(read_frame_time_stamp(now_us - 9000000, true), now_us);
    assert_int_equal(read_frame_time_stamp(now_us + 5000, false), now_us);
    assert_int_equal(read_frame_time_stamp(now_us + 5000, true), now_us);
}

/* The source lends the buffer of a frame to the caller. Checks that other
 * frames that arrive do not change the lent frame. */
TEST(lent_frame_is_unchanged)
{
    struct glint_source_frame kept;

    must_open_camera(NULL);
    fake_camera_add_frame(0, 50);
    assert_int_equal(get_next_frame(), GLINT_OK);
    kept = frame;
    for (int i = 1; i < 20; i++) {
        fake_camera_add_frame((uint32_t)i, i);
        must_get_frame(i);
        assert_int_equal(kept.image.plane[0][0], 50);
        assert_int_equal(camera.n_queued, 3);
    }
    v4l2.source.done(&v4l2.source, &kept);
    assert_int_equal(camera.n_queued, 4);
}

/* Checks when streaming starts. An open camera, also after a restart, has its
 * format locked but must not stream before start(). A call of next() must start
 * streaming, too. */
TEST(streams_only_when_started)
{
    assert_int_equal(
        glint_v4l2_open(&v4l2, &any_camera, GLINT_V4L2_AUTO, 4, &said),
        GLINT_OK);
    camera_is_open = true;
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
        must_get_no_frame();
    }
    assert_false(camera.streams);
    fake_camera_add_frame(0, 5);
    must_get_frame(5);
    assert_int_equal(camera.n_streamons, 3);
}

static int count_dropped_before_sequence(uint32_t sequence)
{
    fake_camera_add_frame(sequence, 9);
    must_get_frame(9);
    return frame.n_dropped;
}

TEST(sequence_gaps_are_dropped_frames)
{
    must_open_camera(NULL);
    /* the sequence numbers may start at any value */
    assert_int_equal(count_dropped_before_sequence(1000), 0);
    assert_int_equal(count_dropped_before_sequence(1001), 0);
    assert_int_equal(count_dropped_before_sequence(1005), 3);
    assert_int_equal(count_dropped_before_sequence(1005), 0);
    assert_int_equal(count_dropped_before_sequence(3),
                     0); /* the driver restarted its sequence numbers at 0 */
    assert_int_equal(count_dropped_before_sequence(4), 0);
    must_open_camera(NULL);
    assert_int_equal(count_dropped_before_sequence(UINT32_MAX - 1), 0);
    assert_int_equal(count_dropped_before_sequence(UINT32_MAX), 0);
    assert_int_equal(count_dropped_before_sequence(0), 0);
    assert_int_equal(count_dropped_before_sequence(2), 1);
    must_open_camera(NULL);
    /* The first frame of v4l2loopback is from before the stream began. */
    assert_int_equal(count_dropped_before_sequence(0), 0);
    assert_int_equal(count_dropped_before_sequence(28), 0);
    assert_int_equal(count_dropped_before_sequence(30), 1);
    must_open_camera(NULL); /* some drivers leave the sequence number at 0 */
    for (int i = 0; i < 5; i++)
        assert_int_equal(count_dropped_before_sequence(0), 0);
}

/* Checks that missing sequence numbers and damaged frames before a delivered
 * frame are both counted as dropped. */
TEST(gaps_and_damaged_frames_are_counted_together)
{
    must_open_camera(NULL);
    assert_int_equal(count_dropped_before_sequence(6),
                     0); /* a frame from before the stream began */
    assert_int_equal(count_dropped_before_sequence(0), 0);
    fake_camera_add_frame(2, 1)->flags = V4L2_BUF_FLAG_ERROR;
    fake_camera_add_frame(5, 2);
    fake_camera_add_frame(7, 3);
    must_get_frame(3);
    assert_int_equal(frame.n_dropped, 4);
    assert_int_equal(frame.n_corrupt, 1);
    assert_int_equal(frame.n_late, 1);
}

/* Checks that implausible jumps of the sequence number are not counted as
 * dropped frames, and that their sum does not overflow. */
TEST(implausible_sequence_jumps_are_not_counted)
{
    must_open_camera(NULL);
    assert_int_equal(count_dropped_before_sequence(0), 0);
    for (uint32_t i = 1; i <= 3; i++)
        fake_camera_add_frame(i * 0x7fffffff, 9);
    must_get_frame(9);
    assert_int_equal(frame.n_dropped, 0);
}

TEST(decodes_mjpg)
{
    static const char garbage[] = "not a JPEG at all";

    if (!glint_mjpeg_available())
        skip();
    camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    must_open_camera(NULL);
    for (uint32_t i = 0; i < 3; i++) {
        struct fake_frame *f = fake_camera_add_frame(i, 0);

        f->data = garbage;
        f->bytesused[0] = sizeof garbage;
    }
    must_get_no_frame();
    assert_int_equal(frame.n_corrupt, 1);
    assert_int_equal(frame.n_late, 2);
    assert_int_equal(camera.n_queued, 4);
}

/* ------------------------------------------------------- other memory types */

static void check_chosen_io_method(enum glint_v4l2_io wish,
                                   enum glint_v4l2_io got)
{
    if (try_open_camera(NULL, wish))
        fail_msg("%s", said.text);
    assert_int_equal(v4l2.io, got);
    for (uint32_t i = 0; i < 10; i++) {
        fake_camera_add_frame(i, 20 + (int)i);
        must_get_frame(20 + (int)i);
        assert_int_equal(frame.n_dropped, 0);
    }
    assert_int_equal(camera.n_maps, got == GLINT_V4L2_MMAP ? 4 : 0);
}

TEST(every_memory_type_is_used)
{
    check_chosen_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_MMAP);
    check_chosen_io_method(GLINT_V4L2_MMAP, GLINT_V4L2_MMAP);
    check_chosen_io_method(GLINT_V4L2_USERPTR, GLINT_V4L2_USERPTR);
    camera.lacks_mmap = true;
    check_chosen_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_USERPTR);
    set_camera_format(V4L2_PIX_FMT_NV12M, true);
    check_chosen_io_method(GLINT_V4L2_USERPTR, GLINT_V4L2_USERPTR);
    must_reset_camera();
    camera.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    check_chosen_io_method(GLINT_V4L2_AUTO, GLINT_V4L2_READ);
    check_chosen_io_method(GLINT_V4L2_READ, GLINT_V4L2_READ);
}

/* Checks that the message for a memory type that the device does not support
 * says so, instead of naming a failed request. */
TEST(reports_a_missing_memory_type)
{
    assert_int_equal(try_open_camera(NULL, GLINT_V4L2_READ), GLINT_E_DEVICE);
    assert_non_null(
        strstr(said.text, "(whichever --io allows): Operation not supported"));
    must_be_closed_camera();
    camera.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
    assert_int_equal(try_open_camera(NULL, GLINT_V4L2_MMAP), GLINT_E_DEVICE);
    assert_non_null(strstr(said.text, "(whichever --io allows): "));
    must_be_closed_camera();
}

TEST(works_with_two_buffers)
{
    camera.max_buffers = 2;
    must_open_camera(NULL);
    assert_int_equal(v4l2.n_buffers, 2);
    for (uint32_t i = 0; i < 10; i++) {
        fake_camera_add_frame(i, (int)i);
        must_get_frame((int)i);
    }
    camera.max_buffers = 0;
    must_refuse_to_open(NULL, GLINT_E_DEVICE,
                        "VIDIOC_REQBUFS: Cannot allocate memory");
}

/* Checks that the error message names the request that failed first, even if
 * the source tried a fallback or freed a resource afterwards. */
TEST(message_names_the_first_failed_request)
{
    fake_camera_fail_request(VIDIOC_QUERYBUF, EIO, 1);
    must_refuse_to_open(NULL, GLINT_E_DEVICE,
                        FAKE_PATH ": VIDIOC_QUERYBUF: Input/output error");
    fake_camera_fail_request(VIDIOC_REQBUFS, ENOMEM, -1);
    must_refuse_to_open(NULL, GLINT_E_DEVICE,
                        FAKE_PATH ": VIDIOC_REQBUFS: Cannot allocate memory");
    fake_camera_fail_request(VIDIOC_REQBUFS, EBUSY, -1);
    must_refuse_to_open(
        NULL, GLINT_E_DEVICE,
        "VIDIOC_REQBUFS: Device or resource busy; another program is using it");
}
