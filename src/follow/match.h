/* SPDX-License-Identifier: MIT
 *
 * Finds which spot of a picture is which lamp of the last one.
 *
 *   in   spots in any order; where each lamp should be by now
 *   out  for each lamp its spot, or none; no spot twice
 *
 * Method: of all pairs within reach the nearest is taken, then the nearest of
 * those left, and so on. A faint spot counts as twice as far, and so does a
 * lost lamp. Each lamp looks only at its NEAREST_SPOTS nearest spots, which it
 * finds among spots sorted by x, so that 1024 spots cost no more than a look at
 * those in reach; a lamp that finds all of these taken gets no spot. */
#ifndef GLINT_FOLLOW_MATCH_H
#define GLINT_FOLLOW_MATCH_H

#include "glint/lamps.h"

struct glint_arena;

/* A lamp that looks for its spot. */
struct glint_seeker {
    uint32_t id; /* decides ties; all are different */
    int32_t x_q8, y_q8;
    int32_t reach_q8;       /* 0 .. 2^23 */
    int32_t max_faint_area; /* pixels: larger faint spots are not this lamp */
    int is_lost;
    int32_t spot; /* result: index of its spot, or -1 */
};

struct glint_pair;

struct glint_match {
    struct glint_seeker *seeker;
    int n_seekers;
    int32_t *by_x;  /* indices of all spots by rising x; the order depends only
                       on their members */
    uint8_t *taken; /* result, by spot: 1 if a lamp took it */
    struct glint_pair *pair;
    int32_t *order; /* indices of pairs */
    int n_pairs;
};

void glint_match_carve(struct glint_match *m, struct glint_arena *arena,
                       int max_seekers, int max_spots);

/* Sets the spot of m->seeker[0 .. n_seekers - 1], and by_x and taken of the N
 * SPOTS. */
void glint_match_find(struct glint_match *m, const struct glint_spot *spots,
                      int n);

#endif
