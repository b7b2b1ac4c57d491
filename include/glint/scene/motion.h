/* SPDX-License-Identifier: MIT
 *
 * glint/scene/motion.h - a recorded motion with reconstructed poses: its file,
 * read in blocks of 4 KiB.
 *
 *     status = glint_motion_open(&motion, data, bytes, &reason);     in memory
 *     status = glint_motion_over(&motion, &blocks, buffer, &reason); elsewhere
 *     status = glint_motion_frame(&motion, k, &frame);               any frame
 *
 * A body with sensors moves among foods. Each frame of the file has position
 * and rotation of the body and the position of each food. In frame 0 the body
 * is at the origin and not rotated, so positions are relative to that pose.
 * Axes are those of the recording, right-handed.
 *
 * Lengths are in steps: one unit of the recording is 2^unit_log2 steps, 2^24
 * but for large and tiny ones.
 *
 * The file begins as every baked file does and continues with tables, all of
 * them in blocks of GLINT_MOTION_BLOCK bytes, little-endian: as many records as
 * fit into the first GLINT_MOTION_ROOM bytes, then the number of the block and
 * the sum of glint_motion_sum(). So any frame is at hand after reading three
 * blocks, of poses, index and intensities, and those with the events since its
 * block of poses began. */
#ifndef GLINT_SCENE_MOTION_H
#define GLINT_SCENE_MOTION_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MOTION_MAGIC   UINT32_C(0x4d544e47) /* "GNTM" */
#define GLINT_MOTION_VERSION 1

enum {
    GLINT_MOTION_BLOCK = 4096,
    GLINT_MOTION_ROOM = GLINT_MOTION_BLOCK - 8,
    GLINT_MOTION_MAX_FOODS = 32,
    GLINT_MOTION_MAX_SENSORS = 32,
    GLINT_MOTION_MAX_FRAMES = 1 << 26,
    GLINT_MOTION_SPAN = 1 << 30 /* steps: every coordinate is below */
};

/* 20 bytes. */
struct glint_motion_pose {
    int32_t at[3];       /* steps */
    int16_t turn_q14[4]; /* quaternion w, x, y, z of length 1: from the body's
                            axes to those of frame 0 */
};

/* From frame FRAME on food SLOT is another one, at AT. */
struct glint_motion_event {
    uint32_t frame, slot;
    int32_t at[3]; /* steps */
};

/* What there is at the first frame of a block of poses. */
struct glint_motion_index {
    uint32_t event;    /* the first event after that frame */
    uint32_t residual; /* steps: the most by which a food's place missed what
                          was seen of it in frames of the block */
    /* The event that placed each food. */
    uint32_t food[GLINT_MOTION_MAX_FOODS];
};

struct glint_motion_sensor {
    int32_t axis_q30[3]; /* unit vector, in the body's axes */
};

/* Begins as every baked file does (src/base/blob.h). */
struct glint_motion_header {
    uint32_t magic, version;
    uint32_t bytes;    /* bytes of the whole file */
    uint32_t crc32;    /* checksum of all bytes after this word: polynomial
                          0xedb88320, reflected, begun and ended with all ones */
    uint32_t variant;  /* 0 */
    uint32_t key[2];   /* key of the recording, low word first */
    char name[64];     /* name of the motion, terminated */
    int32_t unit_log2; /* -30 .. 60: steps in a unit of the recording */
    uint32_t n_frames; /* 1 .. GLINT_MOTION_MAX_FRAMES */
    uint32_t n_foods;  /* 0 .. GLINT_MOTION_MAX_FOODS */
    uint32_t n_sensors;
    uint32_t n_events; /* n_foods at least: those of frame 0 come first */
    int32_t size;      /* of the body, steps */
    /* Half of the angle that a sensor sees: cosine, -1 .. 1, and, for cameras,
     * tangent, clamped to 2^30, 64. */
    int32_t cos_half_q30, tan_half_q24;
    int32_t low[3], high[3]; /* of the body's places and the foods, all frames;
                                steps */
    uint32_t residual;       /* the largest, steps */
    uint32_t residual_frame;
    /* Intensities of a frame: a byte, in 255ths, for each food, or for each
     * food and sensor. 0: all are 1. */
    uint32_t intensities;
    /* First block of each table, in this order. */
    uint32_t sensor_block, event_block, index_block, pose_block,
        intensity_block;
};

/* Reads the GLINT_MOTION_BLOCK bytes of block BLOCK into TO; returns whether it
 * could. */
struct glint_motion_blocks {
    void *ctx;
    int (*read)(void *ctx, uint32_t block, uint8_t *to);
    uint32_t n_blocks;
};

/* An opened file. */
struct glint_motion {
    struct glint_motion_header header;
    struct glint_motion_sensor sensor[GLINT_MOTION_MAX_SENSORS];

    /* Private. */
    const uint8_t *data; /* NULL: blocks are read into BUFFER */
    struct glint_motion_blocks blocks;
    uint8_t *buffer;
    uint32_t held; /* what is in it; 0: nothing */
};

/* What there is at one frame. */
struct glint_motion_frame {
    struct glint_motion_pose pose;
    int32_t food[GLINT_MOTION_MAX_FOODS][3]; /* steps */
    /* In 255ths, by food and sensor. */
    uint8_t intensity[GLINT_MOTION_MAX_FOODS][GLINT_MOTION_MAX_SENSORS];
};

/* Checks DATA[BYTES], aligned to 4 bytes, all of it, and opens it where it
 * lies; DATA must outlive MOTION. GLINT_E_FORMAT: *REASON states what is wrong,
 * in static text. */
enum glint_status glint_motion_open(struct glint_motion *motion,
                                    const void *data, size_t bytes,
                                    const char **reason);

/* Opens a file that is read by BLOCKS, which is copied, into BUFFER, of
 * GLINT_MOTION_BLOCK bytes, aligned to 4, which is kept. Each block is checked
 * when it is read. */
enum glint_status glint_motion_over(struct glint_motion *motion,
                                    const struct glint_motion_blocks *blocks,
                                    uint8_t *buffer, const char **reason);

/* Sets FRAME to frame K, of header.n_frames. GLINT_E_ARGUMENT: there is no such
 * frame. GLINT_E_IO, GLINT_E_FORMAT: a block could not be read, or is damaged,
 * which data in memory never are: FRAME is then to be thrown away. */
enum glint_status glint_motion_frame(struct glint_motion *motion, uint32_t k,
                                     struct glint_motion_frame *frame);

/* Sets EVENT to event I; likewise. */
enum glint_status glint_motion_event(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_event *event);

/* Sets INDEX to entry I, the entry of frames from I glint_motion_per_block()
 * on. */
enum glint_status glint_motion_index(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_index *index);

/* Returns the checksum, as crc32 of the header, of the block number BLOCK at
 * AT, but its last 4 bytes; of block 0 from the header's variant on. */
uint32_t glint_motion_sum(const uint8_t *at, uint32_t block);

/* Returns how many records of BYTES each, 1 .. GLINT_MOTION_ROOM, a block has.
 */
static inline uint32_t glint_motion_per_block(size_t bytes)
{
    return (uint32_t)(GLINT_MOTION_ROOM / bytes);
}

#ifdef __cplusplus
}
#endif

#endif
