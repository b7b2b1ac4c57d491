/* SPDX-License-Identifier: MIT
 *
 * How much a bright region looks like a lamp.
 *
 *   in   the bright regions of a picture, at each of the levels of brightness
 *        that they were sought at, and the picture around them
 *   out  a score of each, in doubts: 256 is one; 0 and more speak for a lamp
 *
 * The score is a sum of terms, each a measure held to a range and weighed; so
 * it moves little where the picture does. Regions of the levels lie within each
 * other, a lamp in its glow in the sky, and of those the one with the highest
 * score is meant.
 *
 * Around a region SCORE_POINTS pixels are read on each of SCORE_RINGS outlines
 * of its box: distances grow with the region and with the picture, so that the
 * same scene in more pixels has the same score.
 */
#ifndef GLINT_FLARE_SCORE_H
#define GLINT_FLARE_SCORE_H

#include "flare/bright.h"
#include "flare/regions.h"
#include "flare/white.h"

enum { SCORE_RINGS = 3, SCORE_POINTS = 16, SCORE_DOUBT = 256 };

/* Measures, _q8. */
enum glint_evidence {
    EVIDENCE_NEAR,   /* stops over what is close around */
    EVIDENCE_AROUND, /* further out: the lower quartile of the points */
    EVIDENCE_FAR,    /* and further yet */
    EVIDENCE_HALO,   /* by how much far exceeds near: light falls off */
    EVIDENCE_FILL,   /* area over that of a disc that is as wide: 256 for one */
    EVIDENCE_SIZE,   /* log2 of its share of the picture: 0 and less */
    EVIDENCE_REST,   /* log2 of the share of the picture that is as bright and
                        not it */
    EVIDENCE_CLIPPED, /* share of its pixels; 128 where all are by choice */
    EVIDENCE_COLOUR,  /* saturation, 256: one channel alone */
    EVIDENCE_CROWD,   /* log2 of 1 + regions alike around it */
    EVIDENCE_SCENE,   /* stops of half of the picture over white: 0 and less */
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
    int low;           /* of their pixels */
    int seed, clipped; /* of pixels that are counted */
    int32_t cost_q8;   /* taken off the score where regions of several levels
                          lie within each other */
};

struct glint_score {
    struct glint_bright *bright;
    const struct glint_white *white;
    int width, height;
    const struct glint_level *level;
};

/* Sets the score of the N candidates of ORDER, which it puts into another
 * order. */
void glint_score_all(const struct glint_score *score,
                     struct glint_candidate *candidate, int32_t *order, int n);

/* Marks those gone that lie within or around one with a higher score. ORDER
 * comes out by falling score. */
void glint_score_choose(const struct glint_score *score,
                        struct glint_candidate *candidate, int32_t *order,
                        int n);

#endif
