/* SPDX-License-Identifier: MIT
 *
 * Declares the state of the lamp finder (lamp_finder.c), for programs that list
 * its candidates. */
#ifndef GLINT_LAMPS_LAMP_FINDER_H
#define GLINT_LAMPS_LAMP_FINDER_H

#include "lamps/bright.h"
#include "lamps/regions.h"
#include "lamps/row_light.h"
#include "lamps/score.h"
#include "lamps/white.h"
#include "glint/lamps.h"

enum {
    LIGHT_CANDIDATES = 2048, /* max number of candidates, more than the max of
                                1024 lamps per picture */
    LIGHT_LEVELS_LOWER = 3,  /* max number of brightness levels added for
                                thresholds below the defaults */
    LIGHT_LEVELS = 6 + LIGHT_LEVELS_LOWER
};

struct glint_lamp_finder {
    struct glint_lamp_finder_config cfg;
    int64_t max_area;
    int64_t merge2_q16; /* squared merge distance, pixels^2 */
    struct glint_bright bright;
    struct glint_white *white;
    int32_t least_white_q20; /* min linear light that may count as the white of
                                the next picture */
    int32_t alone_q8; /* alone_q8 of struct glint_score for the next picture */
    struct glint_row_light row;
    struct glint_regions *regions;          /* one per level */
    struct glint_level level[LIGHT_LEVELS]; /* brightness levels, rising */
    int n_levels;
    int at; /* index of the level whose regions are being processed */
    /* [LIGHT_CANDIDATES + 1]: candidates; the last element is for a new
     * candidate that may replace the faintest */
    struct glint_candidate *candidate;
    int32_t *order; /* indices of candidates: a heap while candidates are added,
                       then sorted by descending flux */
    int n;          /* number of candidates in order; faint candidates come
                       last */
    int dropped;
};

/* Finds the candidates (regions that may be lamps) of IMAGE; drops all earlier
 * candidates. */
void glint_lamps_collect_candidates(struct glint_lamp_finder *f,
                                    const struct glint_image *image);

#endif
