/* SPDX-License-Identifier: MIT
 *
 * Scores whether a bright region is a lamp.
 *
 *   in   the bright regions of a picture, at each of the levels of brightness
 *        that they were sought at, and the picture around them
 *   out  a score of each: from 0 on a region is a lamp; 64 are a factor e of
 *        its odds; below -SCORE_DOUBT it is not one, even if it was before
 *
 * Lamps are seldom alone: in a picture with SCORE_SEVERAL lamps, the threshold
 * is -SCORE_COMPANY. In a picture without any, the best region is accepted if
 * its score is not far below 0, since a picture for a flare usually has a lamp:
 * from -SCORE_ALONE in a still picture. A region of a video has another chance
 * in each frame, whether it is a lamp or not, and so must reach
 * -SCORE_ALONE_VIDEO.
 *
 * The score is a sum of terms, each a measure clamped to a range and weighted,
 * so that it moves little where the picture does. Regions of the levels lie
 * within each other, as a lamp does in its glow in the sky; of these the one
 * with the highest score is taken.
 *
 * Around a region SCORE_POINTS pixels are read on each of SCORE_RINGS ellipses.
 * Their distances grow with the region and with the picture, so that the same
 * scene in more pixels has the same score.
 *
 * Limits: each term is below 2^13 * 2^10, so that the sum of some 20 fits 32
 * bits; areas and boxes are computed in 64. */
#ifndef GLINT_LAMPS_SCORE_H
#define GLINT_LAMPS_SCORE_H

#include "glint/lamps.h"
#include "lamps/bright.h"
#include "lamps/regions.h"
#include "lamps/white.h"

enum {
    SCORE_RINGS = 3,
    SCORE_POINTS = 16,
    SCORE_DOUBT = 256,
    SCORE_SEVERAL = 2,
    SCORE_COMPANY = 96,
    SCORE_ALONE = 48, /* in a still picture; see tests/figures/finder.md */
    SCORE_ALONE_VIDEO = 32,
    SCORE_LEVELS = 8
};

/* Measures, _q8. */
enum glint_evidence {
    EVIDENCE_AROUND, /* lower quartile of the contrast at the middle distance,
                        stops */
    EVIDENCE_HALO, /* stops by which contrast is larger at the farthest ellipse
                      than at the nearest: fall-off of light */
    EVIDENCE_SPREAD, /* stops between the quartiles of the contrast close
                        around: large where light does not fall off alike in all
                        directions */
    EVIDENCE_FILL,   /* area / area of a disc of the same RMS radius: 256 for a
                        disc */
    EVIDENCE_BOX,    /* area / area of its box: 256 if it fills the box */
    EVIDENCE_SIZE,   /* log2 of its fraction of the picture, 0 or less */
    EVIDENCE_COLOUR, /* saturation, 256 if it is one channel alone; less in a
                        large region */
    EVIDENCE_DIM, /* stops by which the picture's median is less than five below
                     the level's white, if that white is darker than codes clip;
                     else 0 */
    EVIDENCE_CLOSE, /* lower quartile of the contrast close to the edge, stops:
                       lamps have steep edges */
    EVIDENCE_WHITE, /* stops of its mean luminance over its level's white */
    EVIDENCE_CROWD, /* log2 of the number of regions of its level: lamps are few
                     */
    EVIDENCE_HIGH,  /* height above the picture's lower edge: 256 is the top */
    /* EVIDENCE_HALO of a large region, which is the sun or a lampshade; 0 for a
     * small one. */
    EVIDENCE_WIDE_HALO,
    EVIDENCE_WIDE_HOT, /* 256 for a large region as bright as its level's white;
                          0 for a small or a darker one */
    /* Stops below white of the brightness that one pixel in 2, 4, 32 of the
     * picture reaches: where nearly all is dark, bright objects are lit from
     * within. */
    EVIDENCE_DARK_2,
    EVIDENCE_DARK_4,
    EVIDENCE_DARK_32,
    /* How far a region of 36 pixels or more fills its upright box: 0 up to
     * 250/256 of the box, 256 from 254/256 on. Bars, cursors and windows of a
     * screen fill theirs. */
    EVIDENCE_DRAWN,
    EVIDENCES
};

/* A region that may be a lamp. */
struct glint_candidate {
    struct glint_region sum;
    int32_t x_q8, y_q8;
    int32_t score_q8;
    int16_t level; /* index of its level; 0 is the darkest */
    int32_t rank_q8;
    uint8_t faint;
    uint8_t doubt; /* enum glint_doubt */
    uint8_t gone; /* 1: merged into another region, or replaced by one of higher
                     rank */
    int32_t evidence_q8[EVIDENCES];
};

/* A level of brightness at which regions are sought. */
struct glint_level {
    int low;           /* least brightness of the pixels of its regions */
    int seed, clipped; /* brightness from which pixels count as seeds, or as
                          clipped */
    int32_t cost_q8; /* subtracted from the score when regions within each other
                        are compared */
};

struct glint_score {
    struct glint_bright *bright;
    const struct glint_white *white;
    int width, height;
    const struct glint_level *level;
    int is_brief; /* 1: the rings of a region are not read once its score must
                     be below -SCORE_DOUBT; the score is then below that, but
                     may be too high */
    int32_t alone_q8; /* how far below 0 the best score may be for a lamp if
                         none reaches 0 */
};

/* Sets the scores of the N candidates that ORDER lists. */
void glint_score_all(const struct glint_score *score,
                     struct glint_candidate *candidate, const int32_t *order,
                     int n);

/* Returns the measure that lowers the score of C most, compared with the middle
 * of its range. */
enum glint_doubt glint_score_doubt(const struct glint_candidate *c);

/* Returns the min score of a lamp: 0, or -SCORE_COMPANY in a picture of
 * SCORE_SEVERAL lamps, or the best score if none reaches 0 and that is not
 * below -alone_q8. Changes the order of ORDER. */
int32_t glint_score_least(const struct glint_score *score,
                          struct glint_candidate *candidate, int32_t *order,
                          int n);

/* Sorts ORDER by falling rank, which is the score less the cost of its level,
 * and marks each candidate gone that lies within or around one of higher rank.
 */
void glint_score_choose(const struct glint_score *score,
                        struct glint_candidate *candidate, int32_t *order,
                        int n);

#endif
