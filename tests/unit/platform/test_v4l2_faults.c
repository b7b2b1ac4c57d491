/* SPDX-License-Identifier: MIT
 *
 * Tests the V4L2 source on a fake driver with faults: which faults it recovers
 * from, which end the stream, after what time and with which message, and that
 * no resource leaks.
 */
#include "support/fakes/camera_check.h"
#include "support/scratch.h"

#include <linux/videodev2.h>
#include "jpeg/mjpeg.h"

/* ---------------------------------------------------------------- requests */

TEST_BEFORE
{
    fake_camera_reset();
}

TEST(queueing_fails_once)
{
    must_open(NULL);
    fake_camera_deliver(0, 1);
    fake_camera_refuse(VIDIOC_QBUF, EIO, 1);
    must_get(1);
    assert_int_equal(camera.n_queued, 3);
    fake_camera_deliver(1, 2);
    must_get(2); /* The failed request is repeated before any other. */
    assert_int_equal(camera.n_queued, 4);
    assert_int_equal(v4l2.source.n_restarts, 0);
    must_close();
    fake_camera_refuse(VIDIOC_QBUF, EIO, 1); /* also while the stream starts */
    must_open(NULL);
    assert_int_equal(camera.n_queued, 3);
    must_get_nothing();
    assert_int_equal(camera.n_queued, 4);
    must_close();
}

TEST(opens_at_second_try)
{
    static const unsigned long request[] = {VIDIOC_REQBUFS, VIDIOC_STREAMON};

    for (int i = 0; i < 2; i++) {
        fake_camera_reset();
        fake_camera_refuse(request[i], EINVAL, 1);
        must_open(NULL);
        assert_int_equal(v4l2.io, GLINT_V4L2_MMAP);
        fake_camera_deliver(0, 1);
        must_get(1);
        must_close();
    }
}

TEST(refuses)
{
    static const struct {
        unsigned long request;
        int number;
        const char *text;
    } failure[] = {
        {VIDIOC_QBUF, EIO, FAKE_PATH ": VIDIOC_QBUF: Input/output error"},
        {VIDIOC_STREAMON, EINVAL, ": VIDIOC_STREAMON: Invalid argument"},
        {VIDIOC_STREAMON, EBUSY,
         ": VIDIOC_STREAMON: Device or resource busy; "
         "another program is using it"},
        {VIDIOC_S_FMT, EBUSY,
         ": VIDIOC_S_FMT: Device or resource busy; "
         "another program is using it"},
        {VIDIOC_G_FMT, EINVAL, ": VIDIOC_G_FMT: Invalid argument"},
        {VIDIOC_QUERYCAP, ENOTTY,
         ": not a camera: the device does not support V4L2"},
        {VIDIOC_QUERYCAP, ENODEV, "; the device is gone"},
        {VIDIOC_S_FMT, ENODEV, "; the device is gone"},
    };

    for (size_t i = 0; i < sizeof failure / sizeof *failure; i++) {
        fake_camera_reset();
        fake_camera_refuse(failure[i].request, failure[i].number, -1);
        must_refuse(NULL, GLINT_E_DEVICE, failure[i].text);
    }
    fake_camera_reset();
    camera.caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    must_refuse(NULL, GLINT_E_DEVICE, "'Fake' does not capture pictures");
}

/* Checks that the source works on drivers that lack these requests. */
TEST(does_without)
{
    static const unsigned long request[] = {
        VIDIOC_G_PARM,   VIDIOC_S_PARM,          VIDIOC_G_INPUT,
        VIDIOC_ENUM_FMT, VIDIOC_SUBSCRIBE_EVENT, VIDIOC_DQEVENT,
        VIDIOC_EXPBUF,   VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS};

    for (size_t i = 0; i < sizeof request / sizeof *request; i++) {
        fake_camera_reset();
        fake_camera_refuse(request[i], ENOTTY, -1);
        must_open(NULL);
        fake_camera_deliver(0, 1);
        must_get(1);
        must_close();
    }
}

/* ---------------------------------------------------------- broken streams */

/* Checks that the next frame has WIDTH pixels per row and that its first
 * byte is CODE. */
static void must_get_wide(int width, int code)
{
    assert_int_equal(next(), GLINT_OK);
    assert_non_null(frame.image.plane[0]);
    assert_int_equal(frame.image.width, width);
    assert_int_equal(frame.image.plane[0][0], code);
    done();
}

/* Checks that a broken stream is restarted, at the size that another program
 * has set in the meantime. */
TEST(broken_stream)
{
    must_open(NULL);
    fake_camera_deliver(41, 1);
    must_get(1);
    camera.is_broken = true;
    camera.now.width = 32;
    camera.now.height = 24;
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(v4l2.device.format.width, 32);
    fake_camera_deliver(0, 2);
    must_get_wide(32, 2);
    assert_int_equal(frame.n_dropped, 0); /* the count restarted at 0 */
    must_close();
}

/* Checks that a restart may change to another supported format and back. */
TEST(other_format)
{
    must_open(NULL);
    for (int i = 0; i < 3; i++) {
        camera.mode[0].fourcc = camera.now.fourcc =
            i == 1 ? V4L2_PIX_FMT_RGB24 : V4L2_PIX_FMT_GREY;
        camera.is_broken = true;
        must_get_nothing();
        fake_camera_deliver(0, i);
        must_get_wide(64, i);
        assert_int_equal(frame.image.format, i == 1 ? GLINT_RGB24 : GLINT_GREY);
    }
    camera.mode[0].fourcc = camera.now.fourcc = V4L2_PIX_FMT_H264;
    camera.is_broken = true;
    assert_int_equal(next(), GLINT_E_UNSUPPORTED);
    assert_non_null(strstr(said.text, "delivers pixel format H264"));
    must_close();
}

/* Checks that requests which fail during a restart are repeated for a
 * limited time. */
TEST(stubborn)
{
    static const unsigned long request[] = {VIDIOC_REQBUFS, VIDIOC_STREAMON,
                                            VIDIOC_S_FMT, VIDIOC_QBUF};

    for (int i = 0; i < 4; i++) {
        int failed_ms;

        fake_camera_reset();
        must_open(NULL);
        camera.is_broken = true;
        fake_camera_refuse(request[i], EBUSY, 8);
        assert_int_equal(follow(600, &failed_ms), GLINT_OK);
        fake_camera_deliver(0, 3);
        must_get(3);
        must_close();
    }
}

/* Checks that a stream which cannot be restarted ends with a message that
 * names the failed request. */
TEST(never_again)
{
    static const struct {
        unsigned long request;
        int number;
        const char *text;
    } failure[] = {
        {VIDIOC_STREAMON, EBUSY,
         ": VIDIOC_STREAMON: Device or resource busy; "
         "another program is using it"},
        {VIDIOC_REQBUFS, EBUSY, ": VIDIOC_REQBUFS: Device or resource busy; "},
        {VIDIOC_REQBUFS, ENOMEM, ": VIDIOC_REQBUFS: Cannot allocate memory"},
        {VIDIOC_QBUF, EIO, ": VIDIOC_QBUF: Input/output error"},
        {VIDIOC_S_FMT, EBUSY, ": VIDIOC_S_FMT: Device or resource busy; "},
        {VIDIOC_DQBUF, EIO,
         ": the stream is broken, and restarting does "
         "not help"},
        {VIDIOC_DQBUF, EPIPE, "restarting does not help"},
    };

    for (size_t i = 0; i < sizeof failure / sizeof *failure; i++) {
        int failed_ms;

        fake_camera_reset();
        must_open(NULL);
        camera.is_broken = true;
        fake_camera_refuse(failure[i].request, failure[i].number, -1);
        assert_int_equal(follow(5000, &failed_ms), GLINT_E_DEVICE);
        assert_in_range(failed_ms, 500, 1000);
        if (!strstr(said.text, failure[i].text))
            fail_msg("'%s' does not say '%s'", said.text, failure[i].text);
        must_close();
    }
}

/* Checks that each delivered frame resets the time limit for restarts. */
TEST(patience)
{
    must_open(NULL);
    for (int i = 1; i <= 20; i++) {
        camera.is_broken = true;
        must_get_nothing();
        fake_camera_deliver(0, i);
        must_get(i);
        assert_int_equal(v4l2.source.n_restarts, i);
        fake_camera_pass(100000);
    }
    must_close();
}

TEST(gone)
{
    static const unsigned long request[] = {VIDIOC_DQBUF, VIDIOC_QUERYCAP};
    int failed_ms;

    must_open(NULL);
    fake_camera_deliver(0, 1);
    assert_int_equal(next(), GLINT_OK);
    camera.is_gone = true; /* while a frame is lent */
    done();
    assert_int_equal(next(), GLINT_E_DEVICE);
    assert_string_equal(said.text, FAKE_PATH ": the camera is gone");
    must_close();
    must_refuse(NULL, GLINT_E_DEVICE, "no such device; --list-devices");

    /* number of the request that reports the loss first */
    for (int i = 0; i < 2; i++) {
        fake_camera_reset();
        must_open(NULL);
        camera.is_broken = i == 1;
        fake_camera_refuse(request[i], ENODEV, -1);
        assert_int_equal(follow(100, &failed_ms), GLINT_E_DEVICE);
        assert_int_equal(failed_ms, 0);
        assert_non_null(strstr(said.text, "the camera is gone"));
        must_close();
    }
}

/* Checks that a stream of only damaged frames, marked by the driver or
 * undecodable (AS_JPEG), ends with a message. */
static void check_damaged_stream(bool as_jpeg)
{
    static const char garbage[] = "not a JPEG at all";
    uint32_t sequence = 0;
    enum glint_status status = GLINT_OK;
    int n_corrupt = 0, n_frames;

    fake_camera_reset();
    if (as_jpeg)
        camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    must_open(NULL);
    for (n_frames = 0; status == GLINT_OK && n_frames < 200; n_frames++) {
        struct fake_frame *f = fake_camera_deliver(sequence++, 1);

        f->flags = as_jpeg ? 0 : V4L2_BUF_FLAG_ERROR;
        f->data = as_jpeg ? garbage : NULL;
        f->bytesused[0] = as_jpeg ? sizeof garbage : 0;
        status = next();
        n_corrupt += frame.n_corrupt;
        assert_int_equal(v4l2.source.n_restarts,
                         (n_frames + 1) / 30 > 1 ? 1 : (n_frames + 1) / 30);
        done();
        fake_camera_pass(33333);
    }
    assert_int_equal(status, GLINT_E_DEVICE);
    assert_string_equal(said.text, FAKE_PATH ": all frames are damaged, and "
                                             "restarting does not help");
    assert_int_equal(n_frames, 60); /* two seconds at 30 frames per second */
    assert_int_equal(n_corrupt, 60);
    must_close();
}

TEST(all_damaged)
{
    check_damaged_stream(false);
    if (glint_mjpeg_available())
        check_damaged_stream(true);
}

/* Checks that one intact frame in thirty is enough to continue without a
 * restart. */
TEST(many_damaged)
{
    must_open(NULL);
    for (uint32_t i = 0; i < 300; i++) {
        const bool whole = i % 30 == 29;

        fake_camera_deliver(i, 1)->flags = whole ? 0 : V4L2_BUF_FLAG_ERROR;
        if (whole)
            must_get(1);
        else
            must_get_nothing();
    }
    assert_int_equal(v4l2.source.n_restarts, 0);
    must_close();
}

/* Checks that a driver which returns a buffer that was not queued causes a
 * restart. */
TEST(wrong_index)
{
    struct glint_source_frame kept;

    must_open(NULL);
    fake_camera_deliver(0, 1);
    camera.says_index = 5;
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 1);
    camera.says_index = 0;
    fake_camera_deliver(0, 1);
    assert_int_equal(next(), GLINT_OK);
    kept = frame;
    fake_camera_deliver(1, 2);
    camera.says_index = 1; /* buffer 0, which is lent */
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 2);
    camera.says_index = 0;
    v4l2.source.done(&v4l2.source, &kept);
    assert_int_equal(v4l2.source.start(&v4l2.source, &said), GLINT_OK);
    assert_int_equal(camera.n_queued, 4);
    fake_camera_deliver(0, 3);
    must_get(3);
    must_close();
}

/* ----------------------------------------------------------------- silence */

TEST(silence)
{
    int failed_ms;

    must_open(NULL);
    fake_camera_pass(2100000);
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 0);
    fake_camera_pass(40000); /* longer than the time limit: 2 s and 4 frames */
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 1);
    fake_camera_deliver(0, 1); /* The restart makes frames arrive. */
    must_get(1);
    assert_int_equal(follow(10000, &failed_ms), GLINT_E_DEVICE);
    /* The restart has no effect. */
    assert_in_range(failed_ms, 4200, 4400);
    assert_string_equal(said.text, FAKE_PATH ": no frames come, and restarting "
                                             "does not help");
    must_close();
}

TEST(slow_camera)
{
    camera.mode[0].fps_num = camera.now.fps_num = 1;
    camera.mode[0].fps_den = camera.now.fps_den = 3;
    must_open(NULL);
    for (uint32_t i = 0; i < 5; i++) {
        fake_camera_pass(6000000);
        must_get_nothing();
        fake_camera_deliver(i, 1);
        must_get(1);
    }
    assert_int_equal(v4l2.source.n_restarts, 0);
    must_close();
}

/* ------------------------------------------------------------------ source */

TEST(source_changes)
{
    must_open(NULL);
    fake_camera_deliver(0, 1);
    must_get(1);
    camera.n_events = 2;
    camera.now.width = 32;
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 1);
    fake_camera_deliver(0, 2);
    must_get_wide(32, 2);
    must_close();
}

static void use_hdmi(void)
{
    fake_camera_reset();
    camera.has_dv = true;
}

TEST(timings_change)
{
    use_hdmi();
    must_open(NULL);
    assert_true(v4l2.device.has_signal);
    camera.n_events = 1; /* an event without a change */
    fake_camera_deliver(0, 1);
    must_get(1);
    assert_int_equal(v4l2.source.n_restarts, 0);
    camera.received.width = 128;
    camera.n_events = 1;
    must_get_nothing();
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(camera.timings.width, 128);
    fake_camera_deliver(0, 2);
    must_get_wide(128, 2);
    must_close();
}

/* Checks that the input's signal may be absent for any time and return, with
 * or without events. */
TEST(signal_lost)
{
    int failed_ms;

    for (int with_events = 0; with_events < 2; with_events++) {
        use_hdmi();
        must_open(NULL);
        camera.has_signal = false;
        camera.n_events = with_events;
        assert_int_equal(follow(60000, &failed_ms), GLINT_OK);
        assert_false(v4l2.device.has_signal);
        assert_int_equal(v4l2.source.n_restarts, 0);
        camera.has_signal = true;
        camera.n_events = with_events;
        if (with_events) {
            assert_int_equal(follow(100, &failed_ms), GLINT_OK);
            assert_true(v4l2.device.has_signal);
            assert_int_equal(v4l2.source.n_restarts, 0);
        }
        fake_camera_deliver(0, 1);
        must_get(1);
        must_close();
    }
}

/* Checks that the input's present timings are used while no signal is
 * detected. */
TEST(no_signal_yet)
{
    use_hdmi();
    camera.has_signal = false;
    must_open(NULL);
    assert_false(v4l2.device.has_signal);
    assert_int_equal(camera.n_s_dv_timings, 0);
    fake_camera_deliver(0, 1);
    must_get(1);
    must_close();
}

/* Checks a signal that is lost and returns repeatedly without a frame, for
 * longer than the time limit for restarts, as while a cable is plugged in. */
TEST(signal_wavers)
{
    int failed_ms;

    use_hdmi();
    must_open(NULL);
    for (uint32_t i = 0; i < 8; i++) {
        camera.received.width = 64 + 16 * (i % 2 + 1);
        camera.n_events = 1;
        camera.has_signal = true;
        assert_int_equal(follow(300, &failed_ms), GLINT_OK);
        camera.has_signal = false;
        camera.n_events = 1;
        assert_int_equal(follow(1500, &failed_ms), GLINT_OK);
    }
    /* The signal returns, and then the camera fails. */
    camera.has_signal = true;
    camera.n_events = 1;
    camera.is_broken = true;
    must_get_nothing();
    fake_camera_deliver(0, 1);
    must_get_wide(96, 1);
    must_close();
}

/* Checks that a driver which reports a change at every start does not cause
 * a busy loop. */
TEST(endless_changes)
{
    int64_t start;

    must_open(NULL);
    start = fake_camera_now();
    for (int i = 0; i < 50; i++) {
        camera.n_events = 1;
        must_get_nothing();
    }
    assert_true(fake_camera_now() - start > 500000);
    must_close();
}

/* ------------------------------------------------ begun again, other memory */

static void check_restart(enum glint_v4l2_io io)
{
    assert_int_equal(try_open(NULL, io), GLINT_OK);
    fake_camera_deliver(0, 1);
    must_get(1);
    if (io == GLINT_V4L2_READ)
        camera.read_errno = EIO;
    else
        camera.is_broken = true;
    must_get_nothing();
    camera.read_errno = 0;
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(v4l2.source.fd, camera.fd);
    camera.now.width = 64;
    fake_camera_deliver(0, 2);
    must_get_wide(64, 2);
    must_close();
}

TEST(restarts_user_memory_and_reads)
{
    check_restart(GLINT_V4L2_USERPTR);
    camera.caps |= V4L2_CAP_READWRITE;
    check_restart(GLINT_V4L2_READ);
}

/* --------------------------------------------------- every call that fails */

static int n_got;

/* Runs a sequence of frames, a broken stream and a changed source. Sets
 * *N_CALLS to the number of calls that can fail. Returns the first error. */
static enum glint_status run_session(enum glint_v4l2_io io, int *n_calls)
{
    enum glint_status status = try_open(NULL, io);

    for (uint32_t i = 0; status == GLINT_OK && i < 12; i++) {
        fake_camera_deliver(i, (int)i);
        camera.is_broken |= i == 4;
        camera.n_events += i == 8;
        status = next();
        n_got += status == GLINT_OK && frame.image.plane[0] != NULL;
        if (status == GLINT_OK)
            done();
        fake_camera_pass(33333);
    }
    *n_calls = fake_camera_fail_at(0, 0, false);
    v4l2.source.close(&v4l2.source);
    return status;
}

static void check_failures(int number, bool forever, enum glint_v4l2_io io,
                           bool multiplanar, uint32_t fourcc)
{
    const int fds = scratch_count("/proc/self/fd");
    int n_failed = 0, n_calls, n = 0;

    do {
        enum glint_status status;

        n++;
        fake_camera_reset();
        camera.multiplanar = multiplanar;
        camera.mode[0].fourcc = camera.now.fourcc = fourcc;
        camera.caps = V4L2_CAP_READWRITE | V4L2_CAP_STREAMING |
                      (multiplanar ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                   : V4L2_CAP_VIDEO_CAPTURE);
        fake_camera_fail_at(n, number, forever);
        n_got = 0;
        status = run_session(io, &n_calls);
        if (status != GLINT_OK) {
            n_failed++;
            assert_true(status == GLINT_E_DEVICE || status == GLINT_E_MEMORY);
            assert_non_null(strstr(said.text, FAKE_PATH ": "));
        }
        /* One frame may be lost, and one more at each restart. */
        if (status == GLINT_OK && !forever && fourcc != V4L2_PIX_FMT_MJPEG)
            assert_true(n_got >= 8);
        must_be_closed();
        assert_int_equal(scratch_count("/proc/self/fd"), fds);
    } while (n <= n_calls);
    assert_true(n_failed >= 4);
}

TEST(every_failure)
{
    static const int number[] = {EIO, EINVAL, EBUSY, ENOMEM, ENODEV, EAGAIN};

    for (int i = 0; i < 6; i++)
        for (int forever = 0; forever < 2; forever++) {
            check_failures(number[i], forever, GLINT_V4L2_AUTO, false,
                           V4L2_PIX_FMT_YUYV);
            check_failures(number[i], forever, GLINT_V4L2_AUTO, true,
                           V4L2_PIX_FMT_YUV420M);
            check_failures(number[i], forever, GLINT_V4L2_USERPTR, true,
                           V4L2_PIX_FMT_NV12M);
            check_failures(number[i], forever, GLINT_V4L2_READ, false,
                           V4L2_PIX_FMT_YUYV);
            check_failures(number[i], forever, GLINT_V4L2_AUTO, false,
                           V4L2_PIX_FMT_MJPEG);
        }
}
