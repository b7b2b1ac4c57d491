/* SPDX-License-Identifier: MIT
 *
 * What the parts of the finder of lamps share: light_rows.c makes candidates
 * of a picture, lamp_list.c holds, sorts and merges them.
 */
#ifndef GLINT_LAMPS_LAMP_FINDER_H
#define GLINT_LAMPS_LAMP_FINDER_H

#include "lamps/bright.h"
#include "lamps/regions.h"
#include "lamps/row_light.h"
#include "lamps/score.h"
#include "lamps/white.h"
#include "glint/lamps.h"

enum {
    LIGHT_CANDIDATES = 2048, /* number of candidates, more than the 1024 lamps
                                that find may be asked for */
    LIGHT_LEVELS = 6
};

struct glint_lamp_finder {
    struct glint_lamp_finder_config cfg;
    int64_t max_area;
    int64_t merge2_q16; /* squared merge distance */
    struct glint_bright bright;
    struct glint_white *white;
    int32_t least_white_q20; /* white of the next picture is no less; linear
                                light */
    int32_t alone_q8;        /* of the next picture, as struct glint_score has
                                it */
    struct glint_row_light row;
    struct glint_regions regions[LIGHT_LEVELS];
    struct glint_level level[LIGHT_LEVELS]; /* levels, by rising brightness */
    int n_levels;
    int at; /* level whose regions are being offered */
    /* the candidates, and room for one on its way out */
    struct glint_candidate *candidate;
    int32_t *order; /* indices of candidates: a heap, then by falling flux */
    int n;          /* number of candidates in order, the faint ones last */
    int dropped;
};

/* Holds the candidates that IMAGE has, and no others. */
void glint_lamps_collect(struct glint_lamp_finder *f,
                         const struct glint_image *image);

/* Holds CANDIDATE, at the expense of the last if need be. */
void glint_lamps_hold(struct glint_lamp_finder *f,
                      const struct glint_candidate *candidate);

/* Takes those out of the order that are gone. */
void glint_lamps_compact(struct glint_lamp_finder *f);

/* Sorts by falling flux and unites what is nearer than the merge distance. */
void glint_lamps_merge(struct glint_lamp_finder *f);

/* Leaves MAX: what exceeds it joins the nearest that is kept, or is dropped. */
void glint_lamps_cap(struct glint_lamp_finder *f, int max);

#endif
