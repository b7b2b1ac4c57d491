/* SPDX-License-Identifier: MIT
 *
 * Assigns the spots of a picture to the lamps of the previous picture.
 *
 *    in   spots in any order; the predicted position of each lamp
 *    out  for each lamp its spot, or none; each spot at most once
 *
 * Method: greedy, the nearest pair within reach first. The distance of a faint
 * spot is doubled, and that of a lost lamp again. Each lamp considers only its
 * NEAREST_SPOTS nearest spots, found among spots sorted by x, so that only
 * spots within reach cost time. A lamp whose candidates are all assigned gets
 * no spot.
 */
#ifndef GLINT_FOLLOW_MATCH_H
#define GLINT_FOLLOW_MATCH_H

#include "glint/lamps.h"

struct glint_arena;

/* A lamp for which a spot is searched. */
struct glint_seeker {
    uint32_t id; /* breaks ties; must be unique */
    int32_t x_q8, y_q8;
    int32_t reach_q8;       /* max distance of its spot, pixels, 0 .. 2^23 */
    int32_t max_faint_area; /* pixels; a faint spot of a larger area does not
                               match */
    int is_lost;
    int32_t spot; /* result: index of its spot, or -1 */
};

struct glint_pair;

struct glint_match {
    struct glint_seeker *seeker;
    int n_seekers;
    int32_t *by_x;  /* indices of all spots sorted by x; the order depends only
                       on their members */
    uint8_t *taken; /* result, per spot: 1 if it is assigned to a lamp */
    struct glint_pair *pair;
    int32_t *order; /* indices of pairs */
    int n_pairs;
};

void glint_match_carve(struct glint_match *m, struct glint_arena *arena,
                       int max_seekers, int max_spots);

/* Assigns the N SPOTS: sets spot of m->seeker[0 .. n_seekers - 1], by_x and
 * taken. */
void glint_match_find(struct glint_match *m, const struct glint_spot *spots,
                      int n);

#endif
