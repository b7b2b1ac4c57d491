/* SPDX-License-Identifier: MIT
 *
 * fake_camera.h - a fake V4L2 camera and a fake clock for tests. The Makefile
 * links these tests with fake_camera.o and the linker flags FAKE_CAMERA.
 *
 * The fake driver is as strict as the kernel: a buffer may be queued only once,
 * no format may be set while there are buffers, and no buffers may be freed
 * while they are mapped. The member `breaches` counts violations of these
 * rules that the kernel would not report at once. Any call to the kernel or
 * the heap can be made to fail.
 */
#ifndef GLINT_SUPPORT_FAKE_CAMERA_H
#define GLINT_SUPPORT_FAKE_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <linux/videodev2.h>

#define FAKE_PATH "/dev/video77"

enum { FAKE_MODES = 8, FAKE_FRAMES = 128, FAKE_BUFFERS = 64 };

/* A combination of format, size and frame rate; fourcc 0 ends a list. */
struct fake_mode {
    uint32_t fourcc, width, height, fps_num, fps_den;
};

struct fake_frame {
    uint32_t sequence;
    int code; /* value of all bytes of the frame, 0 .. 255, if `data` is NULL */
    /* image data, bytesused[0] bytes; NULL: all bytes are `code` */
    const void *data;
    uint32_t flags;
    /* bytes used in each block; 0: the whole frame (is_odd false) or no bytes
     * (is_odd true) */
    uint32_t bytesused[3];
    uint32_t data_offset[3];
    int64_t time_us;
    /* the driver does not report which clock its time stamps use */
    bool unknown_clock;
    bool is_odd; /* true: 0 in bytesused means no bytes, not the whole frame */
    /* errno that the request DQBUF sets for this frame; 0: no error */
    int error;
};

struct fake_buffer {
    uint32_t bytes[3];
    uint8_t *map[3]; /* addresses of the mapped blocks; NULL: not mapped */
    /* addresses of blocks in the caller's memory; 0: none */
    unsigned long own[3];
    bool queued;
};

struct fake_camera {
    /* Properties of the device: */
    uint32_t caps;
    bool multiplanar, has_dv, has_no_sizes, is_stepwise;
    uint32_t n_inputs;
    struct fake_mode mode[FAKE_MODES];
    uint32_t stride_more; /* padding at the end of each row, bytes */
    /* number of bytes by which buffers are shorter than sizeimage */
    uint32_t length_less;
    /* sizeimage that the driver reports, bytes; 0: the true value */
    uint32_t sizeimage;
    bool reports_no_stride; /* the driver reports 0 as bytesperline */
    bool rounds;            /* the driver rounds sizes to multiples of 16 */
    /* the request S_FMT always sets the fourcc of the first mode */
    bool ignores_fourcc;
    bool lacks_mmap; /* REQBUFS rejects MMAP */
    /* max number of buffers that the request REQBUFS allocates */
    uint32_t max_buffers;
    /* frame interval that the request G_PARM reports; numerator 0: that of the
     * mode */
    struct v4l2_fract rate;
    uint32_t quantization, ycbcr_enc, colorspace;

    /* Present settings of the device, and the signal on the cable: */
    struct fake_mode now;
    uint32_t input;
    struct v4l2_bt_timings timings, received;
    bool has_signal;

    /* State of the stream: */
    int fd; /* file descriptor; -1: closed */
    bool streams, is_gone, is_broken;
    int n_events; /* pending source-change events */
    uint32_t n_buffers;
    struct fake_buffer buffer[FAKE_BUFFERS];
    uint32_t order[FAKE_BUFFERS]; /* queued buffers, oldest first */
    int n_queued;
    struct fake_frame frame[FAKE_FRAMES];
    int n_frames;
    int read_errno; /* errno that read() sets; 0: read() succeeds */
    /* called at the start of each DQBUF request, unless NULL */
    void (*on_dequeue)(void);
    /* called at the start of each STREAMON request, unless NULL */
    void (*on_stream)(void);
    /* 1 + the wrong buffer index that DQBUF returns; 0: DQBUF is right */
    int returned_index;

    /* Numbers of calls, and of violated driver rules (breaches): */
    int n_maps, n_exports, breaches, n_streamons, n_reqbufs;
    int n_s_dv_timings;
};

extern struct fake_camera camera;

/* Resets the camera to YUYV of 64 x 48 at 30 fps, without failures. */
void fake_camera_reset(void);

/* Appends a frame to the frames that the camera will deliver: all bytes CODE,
 * time stamp now. The caller may change the returned frame. */
struct fake_frame *fake_camera_add_frame(uint32_t sequence, int code);

/* Makes the next TIMES requests of type REQUEST fail with errno NUMBER; TIMES
 * -1: all later ones. */
void fake_camera_fail_request(unsigned long request, int number, int times);

/* Makes the Nth call from now fail with errno NUMBER, and all later calls as
 * well if FOREVER; N 0: none. System calls for the camera and allocations count
 * as calls. Returns the number of calls since this function was last called. */
int fake_camera_fail_call(int n, int number, bool forever);

/* Returns the number of heap blocks that the code under test has not freed. */
int fake_camera_count_leaks(void);

/* Returns the number of allocations since the program began. */
int fake_camera_count_allocations(void);

/* Advances the fake clock by US microseconds. Apart from this, only sleeping
 * advances it. */
void fake_camera_advance_clock(int64_t us);
int64_t fake_camera_time_us(void);

/* true: glint behaves like a build without libjpeg */
extern bool fake_lacks_jpeg;

#endif
