/* SPDX-License-Identifier: MIT
 *
 * fake_camera.h - a V4L2 camera and a clock that are answered here, for a test
 * linked with fake_camera.o and FAKE_CAMERA of the Makefile.
 *
 * The driver is as strict as the kernel: buffers are queued once, no format is
 * set while there are buffers, none are freed while they are mapped. Breaches
 * that the kernel would punish later are counted in breaches. Any call that
 * reaches the kernel or the heap may be made to fail.
 */
#ifndef GLINT_SUPPORT_FAKE_CAMERA_H
#define GLINT_SUPPORT_FAKE_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <linux/videodev2.h>

#define FAKE_PATH "/dev/video77"

enum { FAKE_MODES = 8, FAKE_FRAMES = 128, FAKE_BUFFERS = 64 };

/* A format, a size and a rate that go together; fourcc 0 ends them. */
struct fake_mode {
    uint32_t fourcc, width, height, fps_num, fps_den;
};

struct fake_frame {
    uint32_t sequence;
    int code;         /* that its bytes have */
    const void *data; /* or these, bytesused[0] of them */
    uint32_t flags;
    uint32_t bytesused[3]; /* 0: all, unless is_odd */
    uint32_t data_offset[3];
    int64_t time_us;
    bool unknown_clock; /* that time_us is of */
    bool is_odd;        /* bytesused is meant */
    int error;          /* DQBUF fails with this instead */
};

struct fake_buffer {
    uint32_t bytes[3];
    uint8_t *map[3];      /* where it is mapped */
    unsigned long own[3]; /* userptr */
    bool queued;
};

struct fake_camera {
    /* what it is */
    uint32_t caps;
    bool multiplanar, has_dv, has_no_sizes, is_stepwise;
    uint32_t n_inputs;
    struct fake_mode mode[FAKE_MODES];
    uint32_t stride_more;   /* than a row */
    uint32_t length_less;   /* of buffers, than sizeimage */
    uint32_t sizeimage;     /* unless 0: as it says */
    bool says_no_stride;    /* bytesperline 0 */
    bool rounds;            /* sizes to multiples of 16 */
    bool ignores_fourcc;    /* gives the first mode's whatever is asked */
    bool lacks_mmap;        /* REQBUFS has USERPTR only */
    uint32_t max_buffers;   /* that REQBUFS gives */
    struct v4l2_fract rate; /* G_PARM; numerator 0: that of the mode */
    uint32_t quantization, ycbcr_enc, colorspace;

    /* how it is set */
    struct fake_mode now;
    uint32_t input;
    struct v4l2_bt_timings timings, received;
    bool has_signal;

    /* what it is doing */
    int fd; /* -1: closed */
    bool streams, is_gone, is_broken;
    int n_events; /* source changes that wait */
    uint32_t n_buffers;
    struct fake_buffer buffer[FAKE_BUFFERS];
    uint32_t order[FAKE_BUFFERS]; /* that they were queued in */
    int n_queued;
    struct fake_frame frame[FAKE_FRAMES];
    int n_frames;
    int read_errno;           /* read() fails with it */
    void (*on_dequeue)(void); /* unless NULL: before each DQBUF */
    int says_index;           /* unless 0: DQBUF gives this less one */

    /* what happened */
    int n_maps, n_exports, breaches, n_streamons, n_reqbufs;
    int n_s_dv_timings;
};

extern struct fake_camera camera;

/* A camera of YUYV 64 x 48 at 30 fps, and every failure off. */
void fake_camera_reset(void);

/* Puts a frame behind those that wait, of camera.mode's own making. */
struct fake_frame *fake_camera_deliver(uint32_t sequence, int code);

/* REQUEST fails with NUMBER the next TIMES times; -1: for ever. */
void fake_camera_refuse(unsigned long request, int number, int times);

/* All calls count: the kernel's for the camera, and the heap's. Call N fails,
 * and with FOREVER all that follow; 0: none. Returns how many there were. */
int fake_camera_fail_at(int n, int number, bool forever);

/* Blocks of the heap that the code under test holds. */
int fake_camera_blocks(void);

/* How often the heap was asked for memory so far. */
int fake_camera_asked(void);

/* The clock stands still but for this and for sleeping. */
void fake_camera_pass(int64_t us);
int64_t fake_camera_now(void);

/* Built without libjpeg. */
extern bool fake_lacks_jpeg;

#endif
