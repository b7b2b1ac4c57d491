/* SPDX-License-Identifier: MIT */
#include "bake/motion/localise.h"

#include <math.h>
#include <string.h>

enum { MOST = GLINT_MOTION_MAX_FOODS };

void glint_localiser_init(struct glint_localiser *localiser, bool average)
{
    *localiser = (struct glint_localiser){.average = average};
}

/* ------------------------------------------------------------------- rigid */

/* Fits POSE to all foods (landmarks) known from earlier frames, except food
 * BUT. Returns false if there are fewer than three, or if they lie on a
 * line. */
static bool fit_pose_to_known_landmarks(const struct glint_localiser *l, int n,
                                        const double (*seen)[3],
                                        const bool *is_new, int but,
                                        struct glint_rigid *pose)
{
    double from[MOST][3], to[MOST][3];
    int m = 0;

    for (int i = 0; i < n; i++) {
        if (is_new[i] || i == but)
            continue;
        memcpy(from[m], seen[i], sizeof *from);
        memcpy(to[m], l->place[i], sizeof *to);
        m++;
    }
    return glint_rigid_fit_points(m, (const double(*)[3])from,
                                  (const double(*)[3])to, pose);
}

/* Updates the mean position of each known food. Its position in this frame is
 * computed with the pose fitted to all other foods. */
static void update_landmark_positions(struct glint_localiser *l, int n,
                                      const double (*seen)[3],
                                      const bool *is_new)
{
    double said[MOST][3];
    bool is_said[MOST];

    for (int i = 0; i < n; i++) {
        struct glint_rigid pose;

        is_said[i] = !is_new[i] &&
                     fit_pose_to_known_landmarks(l, n, seen, is_new, i, &pose);
        if (is_said[i])
            glint_rigid_transform_point(&pose, seen[i], said[i]);
    }
    for (int i = 0; i < n; i++) {
        if (!is_said[i])
            continue;
        l->age[i] += 1;
        for (int k = 0; k < 3; k++)
            l->place[i][k] += (said[i][k] - l->place[i][k]) / l->age[i];
    }
}

/* -------------------------------------------------------------------- frame */

static const char *locate_body(struct glint_localiser *l, int n,
                               const double (*seen)[3], const bool *is_new,
                               struct glint_located *located)
{
    if (!fit_pose_to_known_landmarks(l, n, seen, is_new, -1, &located->pose))
        return located->n_known < 3
                   ? "fewer than three food items have known positions"
                   : "the food items with known positions lie on a line, so "
                     "the pose is ambiguous";
    if (l->average)
        update_landmark_positions(l, n, seen, is_new);
    for (int i = 0; i < n; i++)
        if (is_new[i]) {
            glint_rigid_transform_point(&located->pose, seen[i], l->place[i]);
            l->age[i] = 1;
        }
    return NULL;
}

static void init_from_first_frame(struct glint_localiser *l, int n,
                                  const double (*seen)[3],
                                  struct glint_located *located)
{
    located->pose = (struct glint_rigid){
        {0, 0, 0}, {1, 0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    located->n_known = n;
    for (int i = 0; i < n; i++) {
        l->age[i] = 1;
        memcpy(l->place[i], seen[i], sizeof *l->place);
    }
    l->has_begun = true;
}

/* Sets the residual of the frame: the max distance, over all known foods,
 * between the position in this frame and the estimate from earlier frames. */
static void compute_frame_residual(int n, const double (*places)[3],
                                   const double (*seen)[3], const bool *is_new,
                                   struct glint_located *located)
{
    for (int i = 0; i < n; i++) {
        double at[3], square = 0;

        if (is_new[i])
            continue;
        glint_rigid_transform_point(&located->pose, seen[i], at);
        for (int k = 0; k < 3; k++)
            square += (at[k] - places[i][k]) * (at[k] - places[i][k]);
        located->residual = fmax(located->residual, sqrt(square));
    }
}

const char *glint_localise_body(struct glint_localiser *localiser, int n,
                                const double (*seen)[3], const bool *is_new,
                                struct glint_located *located)
{
    struct glint_localiser *l = localiser;
    double before[MOST][3];
    const char *wrong;

    located->n_known = 0;
    located->residual = 0;
    if (!l->has_begun) {
        init_from_first_frame(l, n, seen, located);
        return NULL;
    }
    memcpy(before, l->place, sizeof before);
    for (int i = 0; i < n; i++)
        located->n_known += !is_new[i];
    wrong = locate_body(l, n, seen, is_new, located);
    if (!wrong)
        compute_frame_residual(n, (const double(*)[3])before, seen, is_new,
                               located);
    return wrong;
}
