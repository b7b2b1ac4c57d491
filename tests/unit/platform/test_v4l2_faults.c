/* SPDX-License-Identifier: MIT
 *
 * Tests the V4L2 source on a fake driver with faults. From some faults the
 * source must recover. Other faults must end the stream, after the right time
 * and with the right message. No fault may leak a resource.
 */
#include "support/fakes/camera_check.h"
#include "support/scratch.h"

#include <linux/videodev2.h>
#include "jpeg/mjpeg.h"

/* -------------------------------------------------------- failing requests */

TEST(failed_queueing_is_repeated)
{
    must_open_camera(NULL);
    fake_camera_add_frame(0, 1);
    fake_camera_fail_request(VIDIOC_QBUF, EIO, 1);
    must_get_frame(1);
    assert_int_equal(camera.n_queued, 3);
    fake_camera_add_frame(1, 2);
    /* the failed request is repeated before any other request */
    must_get_frame(2);
    assert_int_equal(camera.n_queued, 4);
    assert_int_equal(v4l2.source.n_restarts, 0);
    fake_camera_fail_request(VIDIOC_QBUF, EIO,
                             1); /* a request fails while the stream starts */
    must_open_camera(NULL);
    assert_int_equal(camera.n_queued, 3);
    must_get_no_frame();
    assert_int_equal(camera.n_queued, 4);
}

TEST(opening_is_repeated_once)
{
    static const unsigned long request[] = {VIDIOC_REQBUFS, VIDIOC_STREAMON};

    for (int i = 0; i < 2; i++) {
        must_reset_camera();
        fake_camera_fail_request(request[i], EINVAL, 1);
        must_open_camera(NULL);
        assert_int_equal(v4l2.io, GLINT_V4L2_MMAP);
        fake_camera_add_frame(0, 1);
        must_get_frame(1);
    }
}

TEST(reports_failed_requests)
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
         ": not a camera: the device does not support V4L2; --list-devices "
         "shows the cameras"},
        {VIDIOC_QUERYCAP, ENODEV, "; the device was removed"},
        {VIDIOC_S_FMT, ENODEV, "; the device was removed"},
    };

    for (size_t i = 0; i < sizeof failure / sizeof *failure; i++) {
        must_reset_camera();
        fake_camera_fail_request(failure[i].request, failure[i].number, -1);
        must_refuse_to_open(NULL, GLINT_E_DEVICE, failure[i].text);
    }
    must_reset_camera();
    camera.caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    must_refuse_to_open(NULL, GLINT_E_DEVICE,
                        "'Fake' does not capture pictures");
}

/* Checks that the source works with drivers that do not support the requests in
 * the list. */
TEST(works_without_optional_requests)
{
    static const unsigned long request[] = {
        VIDIOC_G_PARM,   VIDIOC_S_PARM,          VIDIOC_G_INPUT,
        VIDIOC_ENUM_FMT, VIDIOC_SUBSCRIBE_EVENT, VIDIOC_DQEVENT,
        VIDIOC_EXPBUF,   VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS};

    for (size_t i = 0; i < sizeof request / sizeof *request; i++) {
        must_reset_camera();
        fake_camera_fail_request(request[i], ENOTTY, -1);
        must_open_camera(NULL);
        fake_camera_add_frame(0, 1);
        must_get_frame(1);
    }
}

/* ---------------------------------------------------------- broken streams */

/* Checks that the next frame has WIDTH pixels per row and that its first
 * byte is CODE. */
static void must_get_frame_of_width(int width, int code)
{
    assert_int_equal(get_next_frame(), GLINT_OK);
    assert_non_null(frame.image.plane[0]);
    assert_int_equal(frame.image.width, width);
    assert_int_equal(frame.image.plane[0][0], code);
    release_frame();
}

/* Breaks a stream while another program sets another size. Checks that the
 * stream is restarted at this size. */
TEST(broken_stream_is_restarted)
{
    must_open_camera(NULL);
    fake_camera_add_frame(41, 1);
    must_get_frame(1);
    camera.is_broken = true;
    camera.now.width = 32;
    camera.now.height = 24;
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(v4l2.device.format.width, 32);
    fake_camera_add_frame(0, 2);
    must_get_frame_of_width(32, 2);
    /* the sequence numbers restarted at 0, so no frame counts as dropped */
    assert_int_equal(frame.n_dropped, 0);
}

/* Checks that a restart may change to another supported format, and back. */
TEST(restart_may_change_the_format)
{
    must_open_camera(NULL);
    for (int i = 0; i < 3; i++) {
        camera.mode[0].fourcc = camera.now.fourcc =
            i == 1 ? V4L2_PIX_FMT_RGB24 : V4L2_PIX_FMT_GREY;
        camera.is_broken = true;
        must_get_no_frame();
        fake_camera_add_frame(0, i);
        must_get_frame_of_width(64, i);
        assert_int_equal(frame.image.format, i == 1 ? GLINT_RGB24 : GLINT_GREY);
    }
    camera.mode[0].fourcc = camera.now.fourcc = V4L2_PIX_FMT_H264;
    camera.is_broken = true;
    assert_int_equal(get_next_frame(), GLINT_E_UNSUPPORTED);
    assert_non_null(strstr(said.text, "delivers pixel format H264"));
}

/* Checks that requests that fail during a restart are repeated for a limited
 * time. */
TEST(failing_restart_is_repeated)
{
    static const unsigned long request[] = {VIDIOC_REQBUFS, VIDIOC_STREAMON,
                                            VIDIOC_S_FMT, VIDIOC_QBUF};

    for (int i = 0; i < 4; i++) {
        int failed_ms;

        must_reset_camera();
        must_open_camera(NULL);
        camera.is_broken = true;
        fake_camera_fail_request(request[i], EBUSY, 8);
        assert_int_equal(get_frames_during_ms(600, &failed_ms), GLINT_OK);
        fake_camera_add_frame(0, 3);
        must_get_frame(3);
    }
}

/* Checks that a stream that cannot be restarted ends with a message that names
 * the failed request. */
TEST(failed_restart_ends_with_a_message)
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
         ": the stream is broken; restarting the stream "
         "failed"},
        {VIDIOC_DQBUF, EPIPE, "restarting the stream failed"},
    };

    for (size_t i = 0; i < sizeof failure / sizeof *failure; i++) {
        int failed_ms;

        must_reset_camera();
        must_open_camera(NULL);
        camera.is_broken = true;
        fake_camera_fail_request(failure[i].request, failure[i].number, -1);
        assert_int_equal(get_frames_during_ms(5000, &failed_ms),
                         GLINT_E_DEVICE);
        assert_in_range(failed_ms, 500, 1000);
        if (!strstr(said.text, failure[i].text))
            fail_msg("'%s' does not contain '%s'", said.text, failure[i].text);
    }
}

TEST(delivered_frame_resets_the_restart_limit)
{
    must_open_camera(NULL);
    for (int i = 1; i <= 20; i++) {
        camera.is_broken = true;
        must_get_no_frame();
        fake_camera_add_frame(0, i);
        must_get_frame(i);
        assert_int_equal(v4l2.source.n_restarts, i);
        fake_camera_advance_clock(100000);
    }
}

TEST(reports_an_unplugged_camera)
{
    static const unsigned long request[] = {VIDIOC_DQBUF, VIDIOC_QUERYCAP};
    int failed_ms;

    must_open_camera(NULL);
    fake_camera_add_frame(0, 1);
    assert_int_equal(get_next_frame(), GLINT_OK);
    /* the camera disappears while a frame is lent to the caller */
    camera.is_gone = true;
    release_frame();
    assert_int_equal(get_next_frame(), GLINT_E_DEVICE);
    assert_string_equal(said.text, FAKE_PATH ": the camera was removed");
    must_refuse_to_open(NULL, GLINT_E_DEVICE, "no such device; --list-devices");

    /* The loss of the camera is reported first by request[i]. */
    for (int i = 0; i < 2; i++) {
        must_reset_camera();
        must_open_camera(NULL);
        camera.is_broken = i == 1;
        fake_camera_fail_request(request[i], ENODEV, -1);
        assert_int_equal(get_frames_during_ms(100, &failed_ms), GLINT_E_DEVICE);
        assert_int_equal(failed_ms, 0);
        assert_non_null(strstr(said.text, "the camera was removed"));
    }
}

/* Checks that a stream of only damaged frames ends with a message. AS_JPEG:
 * frames cannot be decoded; otherwise the driver marks them as damaged. */
static void check_stream_of_damaged_frames(bool as_jpeg)
{
    static const char garbage[] = "not a JPEG at all";
    uint32_t sequence = 0;
    enum glint_status status = GLINT_OK;
    int n_corrupt = 0, n_frames;

    must_reset_camera();
    if (as_jpeg)
        camera.mode[0].fourcc = V4L2_PIX_FMT_MJPEG;
    must_open_camera(NULL);
    for (n_frames = 0; status == GLINT_OK && n_frames < 200; n_frames++) {
        struct fake_frame *f = fake_camera_add_frame(sequence++, 1);

        f->flags = as_jpeg ? 0 : V4L2_BUF_FLAG_ERROR;
        f->data = as_jpeg ? garbage : NULL;
        f->bytesused[0] = as_jpeg ? sizeof garbage : 0;
        status = get_next_frame();
        n_corrupt += frame.n_corrupt;
        assert_int_equal(v4l2.source.n_restarts,
                         (n_frames + 1) / 30 > 1 ? 1 : (n_frames + 1) / 30);
        release_frame();
        fake_camera_advance_clock(33333);
    }
    assert_int_equal(status, GLINT_E_DEVICE);
    assert_string_equal(said.text, FAKE_PATH ": all frames are damaged; "
                                             "restarting the stream failed");
    assert_int_equal(n_frames, 60); /* two seconds at 30 frames per second */
    assert_int_equal(n_corrupt, 60);
}

TEST(only_damaged_frames_cause_a_restart)
{
    check_stream_of_damaged_frames(false);
    if (glint_mjpeg_available())
        check_stream_of_damaged_frames(true);
}

/* Checks that a stream with one intact frame in thirty continues without a
 * restart. */
TEST(one_intact_frame_in_30_is_enough)
{
    must_open_camera(NULL);
    for (uint32_t i = 0; i < 300; i++) {
        const bool whole = i % 30 == 29;

        fake_camera_add_frame(i, 1)->flags = whole ? 0 : V4L2_BUF_FLAG_ERROR;
        if (whole)
            must_get_frame(1);
        else
            must_get_no_frame();
    }
    assert_int_equal(v4l2.source.n_restarts, 0);
}

TEST(unqueued_buffer_causes_a_restart)
{
    struct glint_source_frame kept;

    must_open_camera(NULL);
    fake_camera_add_frame(0, 1);
    camera.returned_index = 5;
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 1);
    camera.returned_index = 0;
    fake_camera_add_frame(0, 1);
    assert_int_equal(get_next_frame(), GLINT_OK);
    kept = frame;
    fake_camera_add_frame(1, 2);
    /* returned_index is 1 plus a buffer index. Buffer 0, which is lent to the
     * caller, is returned. */
    camera.returned_index = 1;
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 2);
    camera.returned_index = 0;
    v4l2.source.done(&v4l2.source, &kept);
    assert_int_equal(v4l2.source.start(&v4l2.source, &said), GLINT_OK);
    assert_int_equal(camera.n_queued, 4);
    fake_camera_add_frame(0, 3);
    must_get_frame(3);
}

/* ---------------------------------------------------------- missing frames */

TEST(missing_frames_cause_a_restart)
{
    int failed_ms;

    must_open_camera(NULL);
    fake_camera_advance_clock(2100000);
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 0);
    fake_camera_advance_clock(
        40000); /* longer than the time limit of 2 s and 4 frames */
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 1);
    fake_camera_add_frame(0, 1); /* after the restart frames arrive again */
    must_get_frame(1);
    assert_int_equal(get_frames_during_ms(10000, &failed_ms), GLINT_E_DEVICE);
    /* The second restart has no effect, so the stream ends. */
    assert_in_range(failed_ms, 4200, 4400);
    assert_string_equal(said.text, FAKE_PATH ": no frames arrive; restarting "
                                             "the stream failed");
}

TEST(slow_camera_is_not_restarted)
{
    camera.mode[0].fps_num = camera.now.fps_num = 1;
    camera.mode[0].fps_den = camera.now.fps_den = 3;
    must_open_camera(NULL);
    for (uint32_t i = 0; i < 5; i++) {
        fake_camera_advance_clock(6000000);
        must_get_no_frame();
        fake_camera_add_frame(i, 1);
        must_get_frame(1);
    }
    assert_int_equal(v4l2.source.n_restarts, 0);
}

/* ---------------------------------------------------- changed input signal */

TEST(changed_source_causes_a_restart)
{
    must_open_camera(NULL);
    fake_camera_add_frame(0, 1);
    must_get_frame(1);
    camera.n_events = 2;
    camera.now.width = 32;
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 1);
    fake_camera_add_frame(0, 2);
    must_get_frame_of_width(32, 2);
}

static void reset_camera_with_hdmi(void)
{
    must_reset_camera();
    camera.has_dv = true;
}

TEST(changed_timings_cause_a_restart)
{
    reset_camera_with_hdmi();
    must_open_camera(NULL);
    assert_true(v4l2.device.has_signal);
    camera.n_events = 1; /* This event reports that nothing has changed. */
    fake_camera_add_frame(0, 1);
    must_get_frame(1);
    assert_int_equal(v4l2.source.n_restarts, 0);
    camera.received.width = 128;
    camera.n_events = 1;
    must_get_no_frame();
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(camera.timings.width, 128);
    fake_camera_add_frame(0, 2);
    must_get_frame_of_width(128, 2);
}

/* Checks that the signal at the input may be absent for any time and return,
 * whether the driver sends events or not. */
TEST(signal_may_be_absent_for_any_time)
{
    int failed_ms;

    for (int with_events = 0; with_events < 2; with_events++) {
        reset_camera_with_hdmi();
        must_open_camera(NULL);
        camera.has_signal = false;
        camera.n_events = with_events;
        assert_int_equal(get_frames_during_ms(60000, &failed_ms), GLINT_OK);
        assert_false(v4l2.device.has_signal);
        assert_int_equal(v4l2.source.n_restarts, 0);
        camera.has_signal = true;
        camera.n_events = with_events;
        if (with_events) {
            assert_int_equal(get_frames_during_ms(100, &failed_ms), GLINT_OK);
            assert_true(v4l2.device.has_signal);
            assert_int_equal(v4l2.source.n_restarts, 0);
        }
        fake_camera_add_frame(0, 1);
        must_get_frame(1);
    }
}

/* Checks an input at which no signal is detected: the source uses the timings
 * that are set there. */
TEST(timings_without_signal_are_used)
{
    reset_camera_with_hdmi();
    camera.has_signal = false;
    must_open_camera(NULL);
    assert_false(v4l2.device.has_signal);
    assert_int_equal(camera.n_s_dv_timings, 0);
    fake_camera_add_frame(0, 1);
    must_get_frame(1);
}

/* Checks a signal that is repeatedly lost and found again without a frame, as
 * while a cable is plugged in. The stream must survive this for longer than the
 * time limit for restarts. */
TEST(wavering_signal_is_not_a_failure)
{
    int failed_ms;

    reset_camera_with_hdmi();
    must_open_camera(NULL);
    for (uint32_t i = 0; i < 8; i++) {
        camera.received.width = 64 + 16 * (i % 2 + 1);
        camera.n_events = 1;
        camera.has_signal = true;
        assert_int_equal(get_frames_during_ms(300, &failed_ms), GLINT_OK);
        camera.has_signal = false;
        camera.n_events = 1;
        assert_int_equal(get_frames_during_ms(1500, &failed_ms), GLINT_OK);
    }
    /* the signal returns, and then the camera fails */
    camera.has_signal = true;
    camera.n_events = 1;
    camera.is_broken = true;
    must_get_no_frame();
    fake_camera_add_frame(0, 1);
    must_get_frame_of_width(96, 1);
}

/* Checks that a driver that reports a change at every start does not cause a
 * busy loop. */
TEST(endless_changes_cause_no_busy_loop)
{
    int64_t start;

    must_open_camera(NULL);
    start = fake_camera_time_us();
    for (int i = 0; i < 50; i++) {
        camera.n_events = 1;
        must_get_no_frame();
    }
    assert_true(fake_camera_time_us() - start > 500000);
}

/* ------------------------------------------ restart with other memory types */

static void check_restart_of_io_method(enum glint_v4l2_io io)
{
    assert_int_equal(try_open_camera(NULL, io), GLINT_OK);
    fake_camera_add_frame(0, 1);
    must_get_frame(1);
    if (io == GLINT_V4L2_READ)
        camera.read_errno = EIO;
    else
        camera.is_broken = true;
    must_get_no_frame();
    camera.read_errno = 0;
    assert_int_equal(v4l2.source.n_restarts, 1);
    assert_int_equal(v4l2.source.fd, camera.fd);
    camera.now.width = 64;
    fake_camera_add_frame(0, 2);
    must_get_frame_of_width(64, 2);
}

TEST(restarts_with_user_memory_and_read)
{
    check_restart_of_io_method(GLINT_V4L2_USERPTR);
    camera.caps |= V4L2_CAP_READWRITE;
    check_restart_of_io_method(GLINT_V4L2_READ);
}

/* ---------------------------------------------------- failure of every call */

static int n_got;

/* Runs a session of frames, a stream that breaks, and a source that changes.
 * Sets *N_CALLS to the number of calls that can be made to fail. Returns the
 * first error. */
static enum glint_status run_capture_session(enum glint_v4l2_io io,
                                             int *n_calls)
{
    enum glint_status status = try_open_camera(NULL, io);

    for (uint32_t i = 0; status == GLINT_OK && i < 12; i++) {
        fake_camera_add_frame(i, (int)i);
        camera.is_broken |= i == 4;
        camera.n_events += i == 8;
        status = get_next_frame();
        n_got += status == GLINT_OK && frame.image.plane[0] != NULL;
        if (status == GLINT_OK)
            release_frame();
        fake_camera_advance_clock(33333);
    }
    *n_calls = fake_camera_fail_call(0, 0, false);
    v4l2.source.close(&v4l2.source);
    return status;
}

static void check_session_failing_calls(int number, bool forever,
                                        enum glint_v4l2_io io, bool multiplanar,
                                        uint32_t fourcc)
{
    const int fds = scratch_count_entries("/proc/self/fd");
    int n_failed = 0, n_calls, n = 0;

    do {
        enum glint_status status;

        n++;
        must_reset_camera();
        camera.multiplanar = multiplanar;
        camera.mode[0].fourcc = camera.now.fourcc = fourcc;
        camera.caps = V4L2_CAP_READWRITE | V4L2_CAP_STREAMING |
                      (multiplanar ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                   : V4L2_CAP_VIDEO_CAPTURE);
        fake_camera_fail_call(n, number, forever);
        n_got = 0;
        status = run_capture_session(io, &n_calls);
        if (status != GLINT_OK) {
            n_failed++;
            assert_true(status == GLINT_E_DEVICE || status == GLINT_E_MEMORY);
            assert_non_null(strstr(said.text, FAKE_PATH ": "));
        }
        /* one frame may be lost, and one more at each restart */
        if (status == GLINT_OK && !forever && fourcc != V4L2_PIX_FMT_MJPEG)
            assert_true(n_got >= 8);
        must_be_closed_camera();
        assert_int_equal(scratch_count_entries("/proc/self/fd"), fds);
    } while (n <= n_calls);
    assert_true(n_failed >= 4);
}

TEST(every_failing_call_is_handled)
{
    static const int number[] = {EIO, EINVAL, EBUSY, ENOMEM, ENODEV, EAGAIN};

    for (int i = 0; i < 6; i++)
        for (int forever = 0; forever < 2; forever++) {
            check_session_failing_calls(number[i], forever, GLINT_V4L2_AUTO,
                                        false, V4L2_PIX_FMT_YUYV);
            check_session_failing_calls(number[i], forever, GLINT_V4L2_AUTO,
                                        true, V4L2_PIX_FMT_YUV420M);
            check_session_failing_calls(number[i], forever, GLINT_V4L2_USERPTR,
                                        true, V4L2_PIX_FMT_NV12M);
            check_session_failing_calls(number[i], forever, GLINT_V4L2_READ,
                                        false, V4L2_PIX_FMT_YUYV);
            check_session_failing_calls(number[i], forever, GLINT_V4L2_AUTO,
                                        false, V4L2_PIX_FMT_MJPEG);
        }
}
