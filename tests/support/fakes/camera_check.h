/* SPDX-License-Identifier: MIT
 *
 * camera_check.h - steps shared by the tests of the V4L2 source. After
 * each test, and before the camera is opened again, must_close_camera() checks
 * that no file, buffer mapping or heap block remains.
 */
#ifndef GLINT_SUPPORT_CAMERA_CHECK_H
#define GLINT_SUPPORT_CAMERA_CHECK_H

#include <errno.h>

#include "linux/v4l2.h"
#include "support/fakes/fake_camera.h"
#include "support/test.h"

static struct glint_v4l2 v4l2;
static struct glint_error said;
static struct glint_source_frame frame;
static bool camera_is_open;

static const struct glint_v4l2_config any_camera = {
    .device = FAKE_PATH, .input = -1, .range = -1, .matrix = -1};

/* Checks that the camera is closed, that no buffer is mapped or allocated, and
 * that the code under test violated no rule of the driver. */
static inline void must_be_closed_camera(void)
{
    assert_int_equal(v4l2.source.fd, -1);
    assert_int_equal(v4l2.device.fd, -1);
    assert_int_equal(camera.fd, -1);
    assert_int_equal(camera.n_maps, 0);
    assert_int_equal(camera.breaches, 0);
    assert_int_equal(fake_camera_count_leaks(), 0);
}

/* Closes the camera if it is open, twice, which must have no effect. */
static inline void must_close_camera(void)
{
    if (!camera_is_open)
        return;
    camera_is_open = false;
    v4l2.source.close(&v4l2.source);
    v4l2.source.close(&v4l2.source);
    must_be_closed_camera();
}

static inline void must_reset_camera(void)
{
    must_close_camera();
    fake_camera_reset();
}

TEST_BEFORE
{
    camera_is_open = false;
    fake_camera_reset();
}

TEST_AFTER
{
    must_close_camera();
}

/* Closes the camera first if it is open. */
static inline enum glint_status
try_open_camera(const struct glint_v4l2_config *wish, enum glint_v4l2_io io)
{
    enum glint_status status;

    must_close_camera();
    said.text[0] = '\0';
    status = glint_v4l2_open(&v4l2, wish ? wish : &any_camera, io, 4, &said);
    if (status == GLINT_OK) {
        status = v4l2.source.start(&v4l2.source, &said);
        if (status != GLINT_OK)
            v4l2.source.close(&v4l2.source);
    }
    camera_is_open = status == GLINT_OK;
    return status;
}

static inline void must_open_camera(const struct glint_v4l2_config *wish)
{
    if (try_open_camera(wish, GLINT_V4L2_AUTO))
        fail_msg("%s", said.text);
}

/* Checks that opening fails with STATUS and that the message contains TEXT. */
static inline void must_refuse_to_open(const struct glint_v4l2_config *wish,
                                       enum glint_status status,
                                       const char *text)
{
    assert_int_equal(try_open_camera(wish, GLINT_V4L2_AUTO), status);
    if (!strstr(said.text, text))
        fail_msg("'%s' does not contain '%s'", said.text, text);
    must_be_closed_camera();
}

static inline enum glint_status get_next_frame(void)
{
    said.text[0] = '\0';
    return v4l2.source.next(&v4l2.source, &frame, &said);
}

static inline void release_frame(void)
{
    v4l2.source.done(&v4l2.source, &frame);
}

/* Gets a frame, checks that its first byte is CODE, and releases it. */
static inline void must_get_frame(int code)
{
    assert_ok(get_next_frame());
    assert_non_null(frame.image.plane[0]);
    assert_int_equal(frame.image.plane[0][0], code);
    release_frame();
}

static inline void must_get_no_frame(void)
{
    assert_ok(get_next_frame());
    assert_null(frame.image.plane[0]);
    release_frame();
}

/* Gets a frame every 10 ms until MS milliseconds of the fake clock have passed
 * or a status differs from GLINT_OK. Returns the last status. Sets *FAILED_MS
 * to the time of the last attempt. */
static inline enum glint_status get_frames_during_ms(int ms, int *failed_ms)
{
    const int64_t start = fake_camera_time_us();

    while (fake_camera_time_us() - start < 1000 * (int64_t)ms) {
        const enum glint_status status = get_next_frame();

        *failed_ms = (int)((fake_camera_time_us() - start) / 1000);
        if (status != GLINT_OK)
            return status;
        release_frame();
        fake_camera_advance_clock(10000);
    }
    return GLINT_OK;
}

#endif
