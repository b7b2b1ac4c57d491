/* SPDX-License-Identifier: MIT
 *
 * glint/lamps.h - finds the lamps and the sun in a picture.
 *
 *     bytes = glint_lamp_finder_bytes(&cfg);                     once
 *     glint_lamp_finder_init(&finder, &cfg, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 64);    each picture
 *
 * Bright regions become lamps: pixels above the upper threshold seed a region,
 * and adjacent pixels above the lower threshold belong to it. A pixel is as
 * bright as its largest channel, so that a red lamp is as bright as a white
 * one. Thresholds are in stops from white, the light at which codes clip (codes
 * of 250 and above count as clipped). In a picture that does not reach white,
 * regions are also sought relative to the white of the picture: the code that
 * one of 2048 of its pixels reaches, but at least code 64, because noise would
 * otherwise count as lamps. Thresholds below the defaults add lamps to those
 * that the defaults find, unless JUDGE is 0.
 *
 * Skies, clouds, snow, paper and flowers are as bright as lamps. Regions are
 * therefore scored by their appearance and surroundings: contrast, light that
 * falls off equally in all directions, a compact shape, colour, and the
 * fraction of the picture that is equally bright; see lamps/score.h. A region
 * that is not a lamp may contain a lamp: a bright sky contains the sun. Such a
 * region is therefore searched again for smaller regions of pixels that are
 * clipped in one channel, in nearly all channels, and in all channels. At least
 * an eighth of a region must reach the upper threshold.
 *
 * All results are weighted by flux in linear light and never depend on the
 * brightest pixel alone, so that noise does not move a lamp. Limits of sizes
 * scale with the picture, so that a picture has the same lamps at any
 * resolution. All arithmetic is in integers. No state is preserved from picture
 * to picture except white, if the caller requests it. */
#ifndef GLINT_LAMPS_H
#define GLINT_LAMPS_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The main reason for which a region was rejected as a lamp. */
enum glint_doubt {
    GLINT_DOUBT_NONE, /* not rejected: the region is a lamp */
    GLINT_DOUBT_DIM,  /* too few pixels reach the upper threshold, or the region
                         has too few pixels */
    /* The surroundings of the region are nearly as bright as the region
     * itself. */
    GLINT_DOUBT_AROUND,
    /* Light around the region does not fall off, or falls off unevenly. */
    GLINT_DOUBT_GLOW,
    GLINT_DOUBT_SHAPE, /* the region is not compact */
    GLINT_DOUBT_SIZE,  /* the region is too small relative to the picture */
    GLINT_DOUBT_GREY,  /* the region is darker than white */
    GLINT_DOUBT_CROWD, /* many regions of the picture are equally bright */
    GLINT_DOUBT_DAY,   /* the whole picture is bright, or lacks contrast */
    GLINT_DOUBT_LOW,   /* the region lies low in the picture */
    GLINT_DOUBT_DRAWN  /* the region fills its bounding box, as windows and
                          bars do */
};

/* A lamp in one picture. */
struct glint_spot {
    int32_t x_q8, y_q8; /* flux-weighted centroid; pixels from the top left
                           corner of the picture, pixel centres at n + 1/2 */
    int32_t size_q8;    /* RMS radius, pixels */
    int32_t area;       /* number of pixels of the region */
    /* Number of pixels of the region whose largest channel is clipped or
     * reaches the picture's white level. */
    int32_t n_clipped;
    int64_t flux_q16;   /* linear luminance summed over the region's pixels, 1 =
                           white */
    int32_t rgb_q15[3]; /* mean linear colour, luminance 1 (BT.709 weights) */
    int32_t faint;      /* 1: the spot is not a lamp yet; see keep_faint of
                           struct glint_lamp_finder_config */
    /* If faint is 1, the reason; else GLINT_DOUBT_NONE. */
    enum glint_doubt doubt;

    /* Members that glint_profile_measure() (glint/profile.h) sets; it also
     * refines rgb_q15. Before that call the power equals the flux, and the axes
     * are those of a circle with the same RMS radius as the spot. */
    int64_t power_q16;  /* estimated flux minus background, as if nothing were
                           clipped; 1 = one white pixel */
    int32_t axis_q8[2]; /* RMS semi-axes of its core, pixels, the major axis
                           first */
    /* Direction of the major axis, y down; cos >= 0. */
    int32_t cos_q15, sin_q15;
};

struct glint_lamp_finder_config {
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    /* Upper threshold, stops from white, -20 .. 0: a region must have pixels
     * that reach it. */
    int32_t threshold_high_q8;
    /* Lower threshold, stops from white, -20 .. threshold_high_q8: a region
     * extends to the pixels that reach it. */
    int32_t threshold_low_q8;
    /* 8-bit full-range code of white, 1 .. 255; 0: white is the code at which
     * codes clip. If a picture does not reach that code, the code that one of
     * 2048 of its pixels reaches counts as white, too. */
    int white_code;
    int min_area; /* min area, pixels, 1 or more; smaller regions are noise */
    /* Max area of a lamp, as a fraction of the area of the picture; larger
     * regions are sky or walls. */
    int32_t max_share_q15;
    int32_t
        merge_q15; /* merge distance, as a fraction of the picture's width */
    /* 1: regions are scored by appearance and surroundings; 0: all bright
     * regions are lamps. */
    int32_t judge;
    /* 1: after the lamps, the list has regions marked faint, for
     * glint/lamp_tracker.h. These are regions with too few pixels at the upper
     * threshold, with an area of only half of min_area, or with a score
     * slightly too low. */
    int32_t keep_faint;
};

struct glint_lamp_finder; /* opaque, in the caller's memory */

/* Sets CFG to suitable values for pictures of WIDTH x HEIGHT. */
void glint_lamp_finder_defaults(struct glint_lamp_finder_config *cfg, int width,
                                int height);

/* Returns the exact number of bytes that glint_lamp_finder_init() needs for
 * CFG, or 0 if CFG is out of range. */
size_t glint_lamp_finder_bytes(const struct glint_lamp_finder_config *cfg);

/* Places a finder in MEM[BYTES], aligned to 64; *FINDER points into it. Returns
 * GLINT_E_MEMORY if BYTES is too small. Returns GLINT_E_ARGUMENT if CFG or the
 * alignment is wrong. */
enum glint_status
glint_lamp_finder_init(struct glint_lamp_finder **finder,
                       const struct glint_lamp_finder_config *cfg, void *mem,
                       size_t bytes);

/* Writes the lamps of IMAGE to SPOTS, sorted by decreasing flux, at most MAX (1
 * .. 1024); returns their number. IMAGE must have the size of the configuration
 * and any format but LINEAR_Q20. Each lamp above MAX is merged with the nearest
 * lamp in the list if it is within four merge distances, else dropped. */
int glint_lamp_finder_find(struct glint_lamp_finder *finder,
                           const struct glint_image *image,
                           struct glint_spot *spots, int max);

/* Prepares the next call of glint_lamp_finder_find(), and only that call, for a
 * picture of a video. The white level will be at least the white level of the
 * last picture times PART_Q15, 0 .. 2^15. Otherwise, while a lamp is hidden for
 * a moment, its glow would be the brightest light and count as a lamp. If no
 * region is a lamp, the best region needs a slightly higher score than in a
 * still picture, because other pictures may show that region, too. */
void glint_lamp_finder_keep_white(struct glint_lamp_finder *finder,
                                  int32_t part_q15);

/* Returns the number of lamps that the last glint_lamp_finder_find() dropped
 * because MAX was too small. */
int glint_lamp_finder_dropped(const struct glint_lamp_finder *finder);

#ifdef __cplusplus
}
#endif

#endif
