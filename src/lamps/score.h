/* SPDX-License-Identifier: MIT
 *
 * Scores whether a bright region is a lamp.
 *
 *   in   the bright regions of a picture at each level of brightness, and the
 *        picture around them
 *   out  a score per region: from 0 on it is a lamp; a step of 64 is a factor
 *        e of the odds; below -SCORE_DOUBT it is not a lamp, even if it was
 *        a lamp in the previous frame
 *
 * A picture with several lamps often has more of them. So with SCORE_SEVERAL
 * lamps the min score of a lamp falls from 0 to -SCORE_COMPANY. A picture that
 * gets a flare usually has a lamp. So if no score reaches 0, the region with
 * the highest score is accepted as a lamp. In a still picture this score must
 * be -SCORE_ALONE or more. In a video it must be -SCORE_ALONE_VIDEO or more, as
 * a region is scored in each frame, which gives false lamps more chances.
 *
 * The score is a sum of terms. Each is a measure of the region, clamped to a
 * range and multiplied by a weight, so that small changes of the picture change
 * the score little. Regions of different levels are nested, like a lamp in its
 * glow in the sky; among nested regions the one with the highest score minus
 * the level's cost is chosen.
 *
 * Around a region SCORE_POINTS pixels are read on each of SCORE_RINGS ellipses.
 * Their distances grow with the region and with the picture, so that the same
 * scene in more pixels has the same score.
 *
 * Limits: each term is below 2^13 * 2^10, so that the sum of about 20 terms
 * fits 32 bits; areas and boxes are computed in 64 bits. */
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
    SCORE_ALONE = 48, /* in a still picture in which no score reaches 0, the
                         best region is a lamp if its score is at least
                         -SCORE_ALONE (tests/figures/finder.md) */
    SCORE_ALONE_VIDEO = 32,
    SCORE_LEVELS = 9
};

/* Measures of a region from which its score is computed, _q8. */
enum glint_evidence {
    EVIDENCE_AROUND, /* lower quartile of the contrast between the region and
                        the middle ellipse around it, stops */
    EVIDENCE_HALO,   /* fall-off of light: mean contrast with the outermost
                        ellipse minus mean contrast with the innermost ellipse,
                        stops */
    EVIDENCE_SPREAD, /* upper minus lower quartile of the contrast with the
                        innermost ellipse, stops; large if the fall-off of light
                        depends on the direction */
    EVIDENCE_FILL,   /* area of the region / area of a disc of the same RMS
                        radius: 256 for a disc */
    EVIDENCE_BOX,    /* area of the region / area of its bounding box: 256 if
                        the box is full */
    EVIDENCE_SIZE,   /* log2 of region area / picture area, 0 or less */
    EVIDENCE_COLOUR, /* saturation of the colour, 256 for a single channel;
                        reduced for large regions */
    EVIDENCE_DIM,    /* high for pictures that are grey overall: 5 stops minus
                        log2 of (white level / median of the picture), at least
                        0; 0 if white is where codes clip */
    EVIDENCE_CLOSE,  /* lower quartile of the contrast with the innermost
                        ellipse, stops; high for lamps, which have steep edges */
    EVIDENCE_WHITE,  /* log2 of (mean luminance of the region / white of its
                        brightness level), stops */
    EVIDENCE_CROWD,  /* log2 of the number of regions of the same level; low for
                        lamps, which are few */
    EVIDENCE_HIGH,   /* height of the centroid above the picture's lower edge;
                        256 at the top */
    /* EVIDENCE_HALO of a large region (the sun or a lampshade); 0 for a small
     * region. */
    EVIDENCE_WIDE_HALO,
    EVIDENCE_WIDE_HOT, /* 256 for a large region as bright as the white of its
                          brightness level; 0 for a small or darker region */
    /* log2 of (white / brightness), stops, for the brightness that one pixel in
     * 2, 4 or 32 of the picture reaches. If nearly all of the picture is dark,
     * bright objects are light sources. */
    EVIDENCE_DARK_2,
    EVIDENCE_DARK_4,
    EVIDENCE_DARK_32,
    /* Degree to which a region of 36 pixels or more fills its bounding box: 0
     * if it fills up to 250/256 of the box, 256 from 254/256 on. Bars, cursors
     * and windows of a screen fill their boxes. */
    EVIDENCE_DRAWN,
    EVIDENCES
};

/* A region that may be a lamp. */
struct glint_candidate {
    struct glint_region sum;
    int32_t x_q8, y_q8;
    int32_t score_q8;
    /* index of the brightness level of the region; 0 is the darkest */
    int16_t level;
    int32_t rank_q8;
    uint8_t faint;
    uint8_t doubt; /* value of enum glint_doubt */
    uint8_t gone;  /* 1: the region has been merged into another one or replaced
                      by one of higher rank */
    int32_t evidence_q8[EVIDENCES];
};

/* A brightness level at which regions are searched. */
struct glint_level {
    int low;           /* min brightness of pixels of its regions */
    int seed, clipped; /* seed: min brightness of seeds, which are pixels at the
                          upper threshold; clipped: min brightness of pixels
                          that count as clipped */
    int32_t cost_q8;   /* cost of the level, which is subtracted from scores
                          when nested regions are compared */
};

struct glint_score {
    struct glint_bright *bright;
    const struct glint_white *white;
    int width, height;
    const struct glint_level *level;
    int is_brief;     /* 1: stop reading the rings of a region once its score is
                         certain to be below -SCORE_DOUBT; the returned score is
                         then an upper bound */
    int32_t alone_q8; /* If no score reaches 0, the region with the highest
                         score is a lamp if this score is at least -alone_q8. */
};

/* Computes the scores of the N candidates whose indices are in ORDER. */
void glint_score_score_candidates(const struct glint_score *score,
                                  struct glint_candidate *candidate,
                                  const int32_t *order, int n);

/* Returns the main reason why C may not be a lamp, by the measure whose term is
 * farthest below the middle of its range. */
enum glint_doubt glint_score_choose_doubt(const struct glint_candidate *c);

/* Returns the min score of a lamp: 0; -SCORE_COMPANY in a picture with
 * SCORE_SEVERAL lamps; or, if no score reaches 0 and the best score is at least
 * -alone_q8, the best score. Reorders ORDER. */
int32_t glint_score_find_min_lamp_score(const struct glint_score *score,
                                        struct glint_candidate *candidate,
                                        int32_t *order, int n);

/* Sorts ORDER by descending rank, which is the score minus the cost of the
 * level. Of candidates that lie in each other's boxes, only the candidate of
 * the highest rank remains; the others are marked as gone. */
void glint_score_choose_among_nested(const struct glint_score *score,
                                     struct glint_candidate *candidate,
                                     int32_t *order, int n);

#endif
