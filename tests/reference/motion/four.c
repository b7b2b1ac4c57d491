/* SPDX-License-Identifier: MIT */
#include "reference/motion/four.h"

#include <math.h>
#include <string.h>

enum { MOST = GLINT_MOTION_MAX_FOODS };

double four_round_value(enum four_arithmetic arithmetic, double x)
{
    return arithmetic == FOUR_FLOAT32 ? (double)(float)x : x;
}

void four_init_localiser(struct four *four, enum four_fit fit,
                         enum four_arithmetic arithmetic)
{
    *four = (struct four){.fit = fit, .arithmetic = arithmetic};
    for (int k = 0; k < 3; k++)
        four->chain[k][k] = 1;
}

/* Four points that are not coplanar, as a base for barycentric weights: the
 * edges from the last point to the other three, and their normals. The four
 * weights of a point sum to 1, and do not change when all points move
 * rigidly. */
struct base {
    enum four_arithmetic arithmetic;
    /* normal[i]: cross product of the other two edges */
    double edge[3][3], normal[3][3], det;
};

static double round_to_arithmetic(const struct base *b, double x)
{
    return four_round_value(b->arithmetic, x);
}

static double compute_dot(const struct base *b, const double x[3],
                          const double y[3])
{
    return round_to_arithmetic(
        b, round_to_arithmetic(b, round_to_arithmetic(b, x[0] * y[0]) +
                                      round_to_arithmetic(b, x[1] * y[1])) +
               round_to_arithmetic(b, x[2] * y[2]));
}

static void set_base_matrix(struct base *b, const double (*const from[4])[3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            b->edge[i][k] =
                round_to_arithmetic(b, (*from[i])[k] - (*from[3])[k]);
    for (int i = 0; i < 3; i++) {
        const double *x = b->edge[(i + 1) % 3], *y = b->edge[(i + 2) % 3];

        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;

            b->normal[i][k] =
                round_to_arithmetic(b, round_to_arithmetic(b, x[l] * y[m]) -
                                           round_to_arithmetic(b, x[m] * y[l]));
        }
    }
    b->det = compute_dot(b, b->edge[0], b->normal[0]);
}

/* Moves POINT rigidly together with the four points FROM, which move to the
 * points TO, and sets PLACE to its new position. */
static void map_point_by_moved_base(const struct base *b,
                                    const double (*const from[4])[3],
                                    const double (*const to[4])[3],
                                    const double point[3], double place[3])
{
    double off[3], weight[4], sum = 0;

    for (int k = 0; k < 3; k++)
        off[k] = round_to_arithmetic(b, point[k] - (*from[3])[k]);
    for (int i = 0; i < 3; i++) {
        weight[i] =
            round_to_arithmetic(b, compute_dot(b, off, b->normal[i]) / b->det);
        sum = round_to_arithmetic(b, sum + weight[i]);
    }
    weight[3] = round_to_arithmetic(b, 1 - sum);
    for (int k = 0; k < 3; k++) {
        place[k] = 0;
        for (int i = 0; i < 4; i++)
            place[k] = round_to_arithmetic(
                b, place[k] + round_to_arithmetic(b, weight[i] * (*to[i])[k]));
    }
}

/* Returns the volume of the tetrahedron of the four points FROM as a fraction
 * of its upper bound, the product of three edge lengths. Computed in double
 * precision. */
static double four_span_volume(const double (*const from[4])[3])
{
    struct base b = {.arithmetic = FOUR_DOUBLE};
    double bound = 1;

    set_base_matrix(&b, from);
    for (int i = 0; i < 3; i++)
        bound *= sqrt(compute_dot(&b, b.edge[i], b.edge[i]));
    return bound > 0 ? fabs(b.det) / bound : 0;
}

/* Sets MAP to the affine map that moves FROM[4] to TO[4]. The columns of MAP
 * are the images of the three axes and of the origin. Returns false if
 * four_span_volume() is below 2^-20. */
static bool four_solve_affine_map(enum four_arithmetic arithmetic,
                                  const double (*const from[4])[3],
                                  const double (*const to[4])[3],
                                  double map[4][3])
{
    static const double point[4][3] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    struct base b = {.arithmetic = arithmetic};

    if (!(four_span_volume(from) >= GLINT_RIGID_LEAST))
        return false;
    set_base_matrix(&b, from);
    if (b.det == 0)
        return false;
    for (int i = 0; i < 4; i++)
        map_point_by_moved_base(&b, from, to, point[i], map[i]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            map[i][k] = round_to_arithmetic(&b, map[i][k] - map[3][k]);
    return true;
}

/* Sets FOUR to the indices of four foods (landmarks), chosen by the method
 * l->fit among those known from earlier frames. Returns false if fewer than
 * four are known. */
static bool choose_four_food_items(const struct four *l, int n,
                                   const double (*seen)[3], const bool *is_new,
                                   int four[4])
{
    int known[MOST], m = 0;
    double best = -1;

    for (int i = 0; i < n; i++)
        if (!is_new[i])
            known[m++] = i;
    for (int i = 0; i < 4 && m >= 4; i++)
        four[i] = known[i];
    if (m < 4 || l->fit == FOUR_FIRST || l->fit == FOUR_CHAIN)
        return m >= 4;
    for (int a = 0; a < m; a++)
        for (int b = a + 1; b < m; b++)
            for (int c = b + 1; c < m; c++)
                for (int d = c + 1; d < m; d++) {
                    const int pick[4] = {known[a], known[b], known[c],
                                         known[d]};
                    const double(*const from[4])[3] = {
                        &seen[pick[0]], &seen[pick[1]], &seen[pick[2]],
                        &seen[pick[3]]};
                    const double spans = four_span_volume(from);

                    if (spans > best) {
                        best = spans;
                        memcpy(four, pick, sizeof pick);
                    }
                }
    return true;
}

/* Multiplies l->chain, the product of the motions of earlier frames, by MAP,
 * the motion from this frame to the previous one. Sets MAP to the new product.
 */
static void extend_motion_chain(struct four *l, double map[4][3])
{
    double next[4][3];

    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            double sum = i == 3 ? l->chain[3][k] : 0;

            for (int j = 0; j < 3; j++)
                sum = four_round_value(
                    l->arithmetic,
                    sum + four_round_value(l->arithmetic,
                                           l->chain[j][k] * map[i][j]));
            next[i][k] = sum;
        }
    memcpy(l->chain, next, sizeof next);
    memcpy(map, next, sizeof next);
}

/* Sets MAP to the affine motion of the body since the reference frame, solved
 * from four of the N observed foods (landmarks). Returns NULL, or the text of
 * an error. */
static const char *solve_motion_from_four_foods(struct four *l, int n,
                                                const double (*seen)[3],
                                                const bool *is_new,
                                                double map[4][3])
{
    const double(*const places)[3] = l->fit == FOUR_CHAIN
                                         ? (const double(*)[3])l->last
                                         : (const double(*)[3])l->place;
    const double(*from[4])[3], (*to[4])[3];
    int four[4];

    if (!choose_four_food_items(l, n, seen, is_new, four))
        return "fewer than four foods are known, which this fit takes";
    for (int i = 0; i < 4; i++) {
        from[i] = &seen[four[i]];
        to[i] = &places[four[i]];
    }
    if (!four_solve_affine_map(l->arithmetic, from, to, map))
        return "the four foods lie in a plane, or out of range";
    if (l->fit == FOUR_CHAIN)
        extend_motion_chain(l, map);
    return NULL;
}

/* Sets TO to the image of POINT under MAP. */
static void apply_affine_map(const struct four *l, double map[4][3],
                             const double point[3], double to[3])
{
    for (int k = 0; k < 3; k++) {
        to[k] = map[3][k];
        for (int i = 0; i < 3; i++)
            to[k] = four_round_value(
                l->arithmetic,
                to[k] + four_round_value(l->arithmetic, map[i][k] * point[i]));
    }
}

static void begin_localiser(struct four *l, int n, const double (*seen)[3],
                            struct glint_located *located)
{
    located->pose = (struct glint_rigid){
        {0, 0, 0}, {1, 0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    memcpy(l->place, seen, (size_t)n * sizeof *l->place);
    l->has_begun = true;
}

static const char *compute_body_pose(struct four *l, int n,
                                     const double (*seen)[3],
                                     const bool *is_new,
                                     struct glint_located *located)
{
    double map[4][3], row[3][3];
    const char *const wrong =
        solve_motion_from_four_foods(l, n, seen, is_new, map);

    if (wrong)
        return wrong;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            row[k][i] = map[i][k];
    glint_rigid_set_nearest_rotation((const double(*)[3])row, &located->pose);
    memcpy(located->pose.at, map[3], sizeof located->pose.at);
    for (int i = 0; i < n; i++)
        if (is_new[i])
            apply_affine_map(l, map, seen[i], l->place[i]);
    return NULL;
}

const char *four_localise_by_landmarks(struct four *four, int n,
                                       const double (*seen)[3],
                                       const bool *is_new,
                                       struct glint_located *located)
{
    double rounded[MOST][3] = {{0}};
    const char *wrong = NULL;

    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            rounded[i][k] = four_round_value(four->arithmetic, seen[i][k]);
    if (four->has_begun)
        wrong = compute_body_pose(four, n, (const double(*)[3])rounded, is_new,
                                  located);
    else
        begin_localiser(four, n, (const double(*)[3])rounded, located);
    memcpy(four->last, rounded, sizeof four->last);
    return wrong;
}
