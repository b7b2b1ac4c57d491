/* SPDX-License-Identifier: MIT
 *
 * How much a bright region looks like a lamp.
 *
 *   in   the bright regions of a picture, at each of the levels of brightness
 *        that they were sought at, and the picture around them
 *   out  a score of each: 0 and more speak for a lamp, 64 are a factor e of
 *        its odds; below -SCORE_DOUBT it is none even if it was one before.
 *        Lamps are seldom alone: where a picture has SCORE_SEVERAL, what is
 *        above -SCORE_COMPANY is one, too; where it has none, the best
 *        one is from a little below 0 on: who asks for a flare mostly has a
 *        lamp. A picture by itself has one chance of that, a lamp of a video
 *        one in each frame, and so has what is none
 *
 * The score is a sum of terms, each a measure held to a range and weighed; so
 * it moves little where the picture does. Regions of the levels lie within each
 * other, a lamp in its glow in the sky, and of those the one with the highest
 * score is meant.
 *
 * Around a region SCORE_POINTS pixels are read on each of SCORE_RINGS ellipses:
 * distances grow with the region and with the picture, so that the same scene
 * in more pixels has the same score.
 *
 * Limits: each term is below 2^13 * 2^10, so that the sum of some 20 fits 32
 * bits with ease; what areas and boxes need is in 64.
 */
#ifndef GLINT_LAMPS_SCORE_H
#define GLINT_LAMPS_SCORE_H

#include "lamps/bright.h"
#include "lamps/regions.h"
#include "lamps/white.h"

enum {
    SCORE_RINGS = 3,
    SCORE_POINTS = 16,
    SCORE_DOUBT = 256,
    SCORE_SEVERAL = 2,
    SCORE_COMPANY = 96,
    SCORE_ALONE = 48, /* of a picture by itself: tests/figures/finder.md */
    SCORE_ALONE_VIDEO = 32,
    SCORE_LEVELS = 8
};

/* Measures, _q8. */
enum glint_evidence {
    EVIDENCE_AROUND, /* stops over the lower quartile of what is around */
    EVIDENCE_HALO,   /* stops by which that contrast is more further out: light
                        falls off */
    EVIDENCE_SPREAD, /* stops between the quartiles close around: light does not
                        fall off alike in all directions */
    EVIDENCE_FILL,   /* area over that of a disc that is as wide: 256 for one */
    EVIDENCE_BOX,    /* area over that of its box */
    EVIDENCE_SIZE,   /* log2 of its share of the picture: 0 and less */
    EVIDENCE_COLOUR, /* saturation, 256: one channel alone; of a small region */
    EVIDENCE_DIM,    /* stops by which half of the picture is less than five
                        below a white that is none */
    EVIDENCE_CLOSE, /* stops over what is close to the edge, which is steep at a
                       lamp */
    EVIDENCE_WHITE, /* stops of its mean luminance over its level's white */
    EVIDENCE_CROWD, /* log2 of the regions of its level: lamps are few */
    EVIDENCE_HIGH,  /* height above the picture's lower edge: 256 is the top */
    /* Of a large region, which is the sun or a shade; 0 of a small one. */
    EVIDENCE_WIDE_HALO,
    EVIDENCE_WIDE_HOT, /* 256: as bright as its level's white, and more */
    /* Stops below white that one pixel in 2, 4, 32 of the picture reaches:
       where nearly all is dark, what is bright is lit from within. */
    EVIDENCE_DARK_2,
    EVIDENCE_DARK_4,
    EVIDENCE_DARK_32,
    EVIDENCES
};

/* A region that may be a lamp. */
struct glint_candidate {
    struct glint_region sum;
    int32_t x_q8, y_q8;
    int32_t score_q8;
    int16_t level; /* counts from 0, the darkest */
    int32_t rank_q8;
    uint8_t faint;
    uint8_t gone; /* merged into another, or another stands for it */
    int32_t evidence_q8[EVIDENCES];
};

/* Brightness that regions are made of. */
struct glint_level {
    int low;           /* least brightness of the regions' pixels */
    int seed, clipped; /* brightness from which pixels count as seeds, or as
                          clipped */
    int32_t cost_q8;   /* taken off the score where regions of several levels
                          lie within each other */
};

struct glint_score {
    struct glint_bright *bright;
    const struct glint_white *white;
    int width, height;
    const struct glint_level *level;
    int is_brief; /* 1: of what must fall below -SCORE_DOUBT the surroundings
                     are not read; its score is some number below that, and no
                     less than it would be */
    int32_t alone_q8; /* how far below 0 the best one may be where it is alone
                       */
};

/* Sets the score of the N candidates of ORDER. */
void glint_score_all(const struct glint_score *score,
                     struct glint_candidate *candidate, const int32_t *order,
                     int n);

/* The score from which a candidate is a lamp: 0, or less in company, or that of
 * the best one where it is alone. ORDER comes out in another order. */
int32_t glint_score_least(const struct glint_score *score,
                          struct glint_candidate *candidate, int32_t *order,
                          int n);

/* Marks those gone that lie within or around one with a higher score. ORDER
 * comes out by falling score. */
void glint_score_choose(const struct glint_score *score,
                        struct glint_candidate *candidate, int32_t *order,
                        int n);

#endif
