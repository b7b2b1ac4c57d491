/* SPDX-License-Identifier: MIT
 *
 * glint/lamps.h - finds the lamps and the sun in a picture.
 *
 *     bytes = glint_lamp_finder_bytes(&cfg);                     once
 *     glint_lamp_finder_init(&finder, &cfg, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 64);    each picture
 *
 * Bright regions become lamps: pixels above the upper threshold seed a region,
 * pixels above the lower one belong to it. A pixel is as bright as its largest
 * channel, so that a red lamp is as bright as a white one. Thresholds are in
 * stops from white, which is where codes clip (250 and above count as clipped).
 * In a picture that does not reach that, regions are also sought from its own
 * white: the code that one of 2048 of its pixels reaches, but at least code 64,
 * or noise would be lamps.
 *
 * Skies, clouds, snow, paper and flowers are as bright as lamps. Regions are
 * therefore scored by their appearance and surroundings: contrast, light that
 * falls off equally in all directions, a compact shape, colour, fraction of the
 * picture that is as bright; see lamps/score.h. A region that is not a lamp may
 * have one in it, and so is searched where it clips in one channel, in nearly
 * all, and in all: the sun in a bright sky is a separate lamp. At least an
 * eighth of a region must be at the upper threshold.
 *
 * All results are weighted by flux in linear light, never by the single
 * brightest pixel, so that noise does not move a lamp. Sizes follow the
 * picture's, so that it has the same lamps at any resolution. Integers only;
 * nothing is kept from picture to picture but white, and that only if the
 * caller requests it. */
#ifndef GLINT_LAMPS_H
#define GLINT_LAMPS_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The main reason against a region that is not a lamp. */
enum glint_doubt {
    GLINT_DOUBT_NONE,   /* it is a lamp */
    GLINT_DOUBT_DIM,    /* too few pixels at the upper threshold, or too few at
                           all */
    GLINT_DOUBT_AROUND, /* its surroundings are nearly as bright */
    GLINT_DOUBT_GLOW,   /* light does not fall off around it, or unevenly */
    GLINT_DOUBT_SHAPE,  /* it is not compact */
    GLINT_DOUBT_SIZE,   /* it is small for the picture */
    GLINT_DOUBT_GREY,   /* it is less bright than white */
    GLINT_DOUBT_CROWD,  /* many regions are as bright */
    GLINT_DOUBT_DAY,    /* the picture is bright, or dull */
    GLINT_DOUBT_LOW,    /* it lies low in the picture */
    GLINT_DOUBT_DRAWN   /* it fills a box, as windows and bars do */
};

/* A lamp in one picture. */
struct glint_spot {
    int32_t x_q8, y_q8; /* flux-weighted centroid; pixels from the top left
                           corner of the picture, pixel centres at n + 1/2 */
    int32_t size_q8;    /* RMS radius, pixels */
    int32_t area;       /* number of its pixels */
    int32_t n_clipped; /* number of its pixels whose largest channel is clipped,
                          or at the picture's own white */
    int64_t flux_q16;  /* sum of linear luminance over its pixels, 1 = white */
    int32_t rgb_q15[3]; /* mean linear colour, luminance 1 (BT.709 weights) */
    int32_t faint;      /* 1: not a lamp yet; see keep_faint */
    enum glint_doubt doubt; /* of a faint one */

    /* glint_profile_measure (glint/profile.h) sets these members and refines
     * rgb; before, they are the flux and the radius. */
    int64_t power_q16;  /* flux over the background, without clipping, in white
                           pixels */
    int32_t axis_q8[2]; /* RMS semi-axes of its core, pixels, the major one
                           first */
    /* Direction of the major axis, y down; cos >= 0. */
    int32_t cos_q15, sin_q15;
};

struct glint_lamp_finder_config {
    int width, height;         /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int32_t threshold_high_q8; /* upper threshold, stops from white, -20 .. 0: a
                                  region must have pixels there */
    int32_t threshold_low_q8;  /* lower threshold, stops from white, -20 ..
                                  threshold_high_q8: a region extends to here */
    int white_code; /* 8-bit full-range code of white, 1 .. 255; 0: where codes
                       clip, and the picture's own white if that is darker */
    int min_area;   /* min area, pixels, 1 or more; smaller regions are noise */
    int32_t max_share_q15; /* max area as a fraction of the picture; larger
                              regions are sky or walls */
    int32_t
        merge_q15; /* merge distance, as a fraction of the picture's width */
    int32_t judge; /* 1: regions are scored by appearance and surroundings; 0:
                      all bright regions are lamps */
    int32_t keep_faint; /* 1: the list also has regions marked faint, after the
                           lamps, for glint/lamp_tracker.h: those with too few
                           pixels at the upper threshold, with half of min_area,
                           or with a score slightly too low */
};

struct glint_lamp_finder; /* opaque, in the caller's memory */

/* Sets CFG to suitable values for pictures of WIDTH x HEIGHT. */
void glint_lamp_finder_defaults(struct glint_lamp_finder_config *cfg, int width,
                                int height);

/* Returns the exact number of bytes that init needs for CFG, or 0 if CFG is
 * out of range. */
size_t glint_lamp_finder_bytes(const struct glint_lamp_finder_config *cfg);

/* Places a finder in MEM[BYTES], aligned to 64. GLINT_E_MEMORY: BYTES is too
 * small. GLINT_E_ARGUMENT: CFG or the alignment is wrong. */
enum glint_status
glint_lamp_finder_init(struct glint_lamp_finder **finder,
                       const struct glint_lamp_finder_config *cfg, void *mem,
                       size_t bytes);

/* Writes the lamps of IMAGE (of cfg's size, any format but LINEAR_Q20), by
 * falling flux, at most MAX (1 .. 1024). A lamp above MAX is merged with the
 * nearest one in the list if that is near, else dropped. Returns their
 * number. */
int glint_lamp_finder_find(struct glint_lamp_finder *finder,
                           const struct glint_image *image,
                           struct glint_spot *spots, int max);

/* Prepares the next find, and only that, for a picture of a video. White is
 * then at least PART (0 .. 2^15) of the white of the last picture: otherwise
 * the glow of a lamp that is hidden for a moment would become white and so a
 * lamp. If no region is a lamp, the best one needs a slightly higher score
 * than in a still picture, as other pictures may show it, too.
 */
void glint_lamp_finder_keep_white(struct glint_lamp_finder *finder,
                                  int32_t part_q15);

/* Returns how many lamps of the last find were dropped because MAX was too
 * small. */
int glint_lamp_finder_dropped(const struct glint_lamp_finder *finder);

#ifdef __cplusplus
}
#endif

#endif
