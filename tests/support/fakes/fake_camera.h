/* SPDX-License-Identifier: MIT
 *
 * fake_camera.h - a fake V4L2 camera and a fake clock, for tests that are
 * linked with fake_camera.o and FAKE_CAMERA of the Makefile.
 *
 * The fake driver is as strict as the kernel: a buffer is queued once, no
 * format is set while there are buffers, and no buffers are freed while they
 * are mapped. The member breaches counts mistakes that the kernel would punish
 * only later. Any call to the kernel or the heap can be made to fail.
 */
#ifndef GLINT_SUPPORT_FAKE_CAMERA_H
#define GLINT_SUPPORT_FAKE_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <linux/videodev2.h>

#define FAKE_PATH "/dev/video77"

enum { FAKE_MODES = 8, FAKE_FRAMES = 128, FAKE_BUFFERS = 64 };

/* A format, a size and a rate that go together; fourcc 0 ends the list. */
struct fake_mode {
    uint32_t fourcc, width, height, fps_num, fps_den;
};

struct fake_frame {
    uint32_t sequence;
    int code;         /* value of every byte, 0 .. 255 */
    const void *data; /* bytesused[0] bytes that replace code; NULL: none */
    uint32_t flags;
    uint32_t bytesused[3]; /* 0: the whole frame, unless is_odd */
    uint32_t data_offset[3];
    int64_t time_us;
    bool unknown_clock; /* The driver does not tell which clock it used. */
    bool is_odd;        /* A bytesused of 0 means 0 bytes. */
    int error;          /* errno with which DQBUF fails; 0: none */
};

struct fake_buffer {
    uint32_t bytes[3];
    uint8_t *map[3];      /* NULL: this block is not mapped. */
    unsigned long own[3]; /* address of the caller's memory; 0: none */
    bool queued;
};

struct fake_camera {
    /* These members describe the device. */
    uint32_t caps;
    bool multiplanar, has_dv, has_no_sizes, is_stepwise;
    uint32_t n_inputs;
    struct fake_mode mode[FAKE_MODES];
    uint32_t stride_more;   /* bytes by which a stride exceeds a row */
    uint32_t length_less;   /* bytes that a buffer lacks of sizeimage */
    uint32_t sizeimage;     /* bytes that the driver reports; 0: the right
                             * ones */
    bool says_no_stride;    /* The driver gives a bytesperline of 0. */
    bool rounds;            /* Sizes become multiples of 16. */
    bool ignores_fourcc;    /* S_FMT always sets the first mode's fourcc. */
    bool lacks_mmap;        /* REQBUFS refuses MMAP. */
    uint32_t max_buffers;   /* buffers that REQBUFS gives at most */
    struct v4l2_fract rate; /* G_PARM reports this rate; 0/x: the mode's */
    uint32_t quantization, ycbcr_enc, colorspace;

    /* These members are the settings, and what the cable carries. */
    struct fake_mode now;
    uint32_t input;
    struct v4l2_bt_timings timings, received;
    bool has_signal;

    /* These members are the state of the stream. */
    int fd; /* file descriptor; -1: closed */
    bool streams, is_gone, is_broken;
    int n_events; /* number of source changes to be reported */
    uint32_t n_buffers;
    struct fake_buffer buffer[FAKE_BUFFERS];
    uint32_t order[FAKE_BUFFERS]; /* queued buffers, the oldest first */
    int n_queued;
    struct fake_frame frame[FAKE_FRAMES];
    int n_frames;
    int read_errno;           /* errno with which read() fails; 0: none */
    void (*on_dequeue)(void); /* Each DQBUF calls this first, unless NULL. */
    void (*on_stream)(void);  /* Each STREAMON calls this first, unless NULL. */
    int says_index;           /* index that DQBUF gives, plus 1; 0: the true
                               * one */

    /* These members count what happened. */
    int n_maps, n_exports, breaches, n_streamons, n_reqbufs;
    int n_s_dv_timings;
};

extern struct fake_camera camera;

/* Resets the camera to YUYV of 64 x 48 at 30 fps and takes back all
 * failures. */
void fake_camera_reset(void);

/* Appends a frame to those that wait, all bytes CODE, taken now. The caller may
 * change the frame that is returned. */
struct fake_frame *fake_camera_deliver(uint32_t sequence, int code);

/* Makes the next TIMES requests REQUEST fail with errno NUMBER; TIMES -1:
 * all. */
void fake_camera_refuse(unsigned long request, int number, int times);

/* Makes call N from now fail with errno NUMBER, and with FOREVER all later
 * calls, too; N 0: none. Calls are those to the kernel for the camera and those
 * to the heap for memory. Returns how many there were since this was last
 * set. */
int fake_camera_fail_at(int n, int number, bool forever);

/* Returns how many blocks of the heap the code under test has not freed yet. */
int fake_camera_blocks(void);

/* Returns how often the heap was requested memory since the program began. */
int fake_camera_asked(void);

/* Advances the clock by US microseconds; only sleeping advances it
 * otherwise. */
void fake_camera_pass(int64_t us);
int64_t fake_camera_now(void);

/* true: the program acts as if it was built without libjpeg. */
extern bool fake_lacks_jpeg;

#endif
