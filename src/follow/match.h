/* SPDX-License-Identifier: MIT
 *
 * Assigns the spots of a picture to the lamps of the previous picture.
 *
 *    in   spots in any order; the predicted position of each lamp
 *    out  for each lamp its spot, or none; each spot at most once
 *
 * The method is greedy: of all pairs of a lamp and a spot within its reach, the
 * pair with the smallest distance is assigned first. The distance counts double
 * if the spot is faint, and double again if the lamp is lost. Spots are sorted
 * by x, so that a lamp visits only spots within reach; it considers only the
 * NEAREST_SPOTS nearest of them. A lamp whose candidates are all assigned to
 * other lamps gets no spot. */
#ifndef GLINT_FOLLOW_MATCH_H
#define GLINT_FOLLOW_MATCH_H

#include "glint/lamps.h"

struct glint_arena;

/* A lamp of the previous picture for which a spot is searched. */
struct glint_seeker {
    /* Unique number of the lamp. Of two pairs of equal cost, the pair with the
     * lower number is assigned first. */
    uint32_t id;
    int32_t x_q8, y_q8;
    int32_t reach_q8;       /* search radius: max distance of the spot from (x,
                               y), pixels, 0 .. 2^23 */
    int32_t max_faint_area; /* max area of a faint spot that may be assigned,
                               pixels */
    int is_lost;
    int32_t spot; /* index of the assigned spot, or -1; set by the matcher */
};

struct glint_pair;

struct glint_match {
    struct glint_seeker *seeker;
    int n_seekers;
    /* Indices of all spots sorted by x. Spots with equal x are sorted by their
     * other members, so that the input order does not matter. */
    int32_t *by_x;
    uint8_t *taken; /* for each spot, 1 if it is assigned to a lamp; set by the
                       matcher */
    struct glint_pair *pair;
    int32_t *order; /* indices of pairs */
    int n_pairs;
};

void glint_match_allocate(struct glint_match *m, struct glint_arena *arena,
                          int max_seekers, int max_spots);

/* Assigns the N SPOTS: sets spot of m->seeker[0 .. n_seekers - 1], by_x and
 * taken. */
void glint_match_assign_spots(struct glint_match *m,
                              const struct glint_spot *spots, int n);

#endif
