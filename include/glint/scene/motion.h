/* SPDX-License-Identifier: MIT
 *
 * glint/scene/motion.h - reads the file of a recorded motion in blocks of 4
 * KiB. The file has the reconstructed poses of a body.
 *
 *     status = glint_motion_open(&motion, data, bytes, &reason); in memory
 *     status = glint_motion_over(&motion, &blocks, buffer, &reason); elsewhere
 *     status = glint_motion_frame(&motion, k, &frame); any frame
 *
 * A body with sensors moves among food items (landmarks that its sensors
 * detect). Each frame of the file has position and rotation of the body and the
 * position of each food item. In frame 0 the body is at the origin and not
 * rotated, so positions are relative to that pose. Axes are those of the
 * recording.
 *
 * Lengths are in steps: one unit of the recording is 2^unit_log2 steps;
 * unit_log2 is 24 except for very large or tiny recordings.
 *
 * The file consists of the header of all baked files and of tables, in blocks
 * of GLINT_MOTION_BLOCK bytes, little-endian. A block has as many records as
 * fit into the first GLINT_MOTION_ROOM bytes, then the number of the block and
 * its glint_motion_sum(). To read any frame, three blocks are needed (poses,
 * index and intensities), and the blocks with the events (replacements of food
 * items) since the first frame of the block of poses. */
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
    GLINT_MOTION_SPAN = 1 << 30 /* number of steps: every coordinate is smaller
                                   in magnitude */
};

/* The pose of the body in a frame, 20 bytes. */
struct glint_motion_pose {
    int32_t at[3];       /* position, steps */
    int16_t turn_q14[4]; /* unit quaternion w, x, y, z: rotation from the axes
                            of the body to the axes of frame 0 */
};

/* An event: in frame FRAME, a new food item at AT replaces the food item with
 * index SLOT. */
struct glint_motion_event {
    uint32_t frame, slot;
    int32_t at[3]; /* position, steps */
};

/* State of the food items in the first frame of a block of poses, so that
 * reading a frame need not begin at frame 0. */
struct glint_motion_index {
    uint32_t event; /* index of the first event after that frame */
    /* Max distance, over the frames of the block, between the observed position
     * of a food item and that known from earlier frames, steps. */
    uint32_t residual;
    /* For each food item, index of the event that states its position. */
    uint32_t food[GLINT_MOTION_MAX_FOODS];
};

struct glint_motion_sensor {
    int32_t axis_q30[3]; /* viewing direction, a unit vector in the axes of the
                            body */
};

/* The header of the file. It begins with the members that the headers of all
 * baked files have (src/base/blob.h). */
struct glint_motion_header {
    uint32_t magic, version;
    uint32_t bytes;    /* bytes of the whole file */
    uint32_t crc32;    /* checksum of all bytes after this word, as in struct
                          glint_model_header */
    uint32_t variant;  /* must be 0 */
    uint32_t key[2];   /* key of the recording, low word first */
    char name[64];     /* name of the motion, terminated */
    int32_t unit_log2; /* log2 of the steps in a unit of the recording, -30 ..
                          60 */
    uint32_t n_frames; /* number of frames, 1 .. GLINT_MOTION_MAX_FRAMES */
    uint32_t n_foods;  /* number of food items, 0 .. GLINT_MOTION_MAX_FOODS */
    uint32_t n_sensors;
    uint32_t n_events; /* number of events, at least n_foods: first the events
                          that state the food items of frame 0 */
    int32_t size;      /* radius of the body, steps */
    /* Half of the angle of view of a sensor: its cosine, -1 .. 1; and its
     * tangent, for cameras, clamped to 64 (2^30). */
    int32_t cos_half_q30, tan_half_q24;
    int32_t low[3], high[3]; /* bounding box of the positions of the body and of
                                the food items in all frames; steps */
    uint32_t residual;       /* max of residual over all blocks, steps */
    uint32_t residual_frame;
    /* Number of intensities per frame, a byte each, in 255ths: one for each
     * food item, or one for each pair of food item and sensor. 0: all
     * intensities are 1. */
    uint32_t intensities;
    /* Number of the first block of each table; tables are in this order. */
    uint32_t sensor_block, event_block, index_block, pose_block,
        intensity_block;
};

/* Reads blocks of a file. READ copies the GLINT_MOTION_BLOCK bytes of block
 * BLOCK to TO. It returns 0 on failure, else not 0. */
struct glint_motion_blocks {
    void *ctx;
    int (*read)(void *ctx, uint32_t block, uint8_t *to);
    uint32_t n_blocks;
};

/* An opened file. */
struct glint_motion {
    struct glint_motion_header header;
    struct glint_motion_sensor sensor[GLINT_MOTION_MAX_SENSORS];

    /* The following members are private. */
    const uint8_t *data; /* the file; NULL: blocks are read into BUFFER */
    struct glint_motion_blocks blocks;
    uint8_t *buffer;
    uint32_t held; /* number of the block that BUFFER holds; 0: none */
};

/* State of the body and the landmarks (food items) in one frame. */
struct glint_motion_frame {
    struct glint_motion_pose pose;
    int32_t food[GLINT_MOTION_MAX_FOODS][3]; /* positions of the food items,
                                                steps */
    /* Intensity of each food item at each sensor, 255ths. */
    uint8_t intensity[GLINT_MOTION_MAX_FOODS][GLINT_MOTION_MAX_SENSORS];
};

/* Checks all of DATA[BYTES], aligned to 4 bytes, and opens it in place; DATA
 * must outlive MOTION. On GLINT_E_FORMAT, *REASON states what is wrong, in
 * static text. */
enum glint_status glint_motion_open(struct glint_motion *motion,
                                    const void *data, size_t bytes,
                                    const char **reason);

/* Opens a file of which BLOCKS reads the blocks. BLOCKS is copied. BUFFER has
 * GLINT_MOTION_BLOCK bytes, is aligned to 4 and must outlive MOTION. Each block
 * is checked when it is read. */
enum glint_status glint_motion_over(struct glint_motion *motion,
                                    const struct glint_motion_blocks *blocks,
                                    uint8_t *buffer, const char **reason);

/* Sets FRAME to frame K, 0 .. header.n_frames - 1. Returns GLINT_E_ARGUMENT if
 * there is no such frame, GLINT_E_IO if a block cannot be read, and
 * GLINT_E_FORMAT if a block is damaged. After GLINT_E_IO or GLINT_E_FORMAT,
 * which do not occur with data in memory, FRAME is undefined. */
enum glint_status glint_motion_frame(struct glint_motion *motion, uint32_t k,
                                     struct glint_motion_frame *frame);

/* Sets EVENT to event I; returns errors like glint_motion_frame(). */
enum glint_status glint_motion_event(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_event *event);

/* Sets INDEX to entry I of the index, the entry for block I of poses. That
 * block begins with frame I * glint_motion_per_block(sizeof (struct
 * glint_motion_pose)). */
enum glint_status glint_motion_index(struct glint_motion *motion, uint32_t i,
                                     struct glint_motion_index *index);

/* Returns the checksum of block BLOCK, which is at address AT, without its last
 * 4 bytes. The method is that of crc32 of the header. For block 0 the sum
 * starts at the header's member VARIANT. */
uint32_t glint_motion_sum(const uint8_t *at, uint32_t block);

/* Returns the number of records of BYTES each (1 .. GLINT_MOTION_ROOM) in a
 * block. */
static inline uint32_t glint_motion_per_block(size_t bytes)
{
    return (uint32_t)(GLINT_MOTION_ROOM / bytes);
}

#ifdef __cplusplus
}
#endif

#endif
