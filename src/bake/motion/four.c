/* SPDX-License-Identifier: MIT */
#include "bake/motion/four.h"

#include <math.h>

#include "bake/motion/rigid.h"

double glint_rounded(enum glint_arithmetic arithmetic, double x)
{
    return arithmetic == GLINT_FLOAT32 ? (double)(float)x : x;
}

struct base {
    enum glint_arithmetic arithmetic;
    double edge[3][3], normal[3][3], det; /* normal i is of the other edges */
};

static double keep(const struct base *b, double x)
{
    return glint_rounded(b->arithmetic, x);
}

static double dot(const struct base *b, const double x[3], const double y[3])
{
    return keep(b, keep(b, keep(b, x[0] * y[0]) + keep(b, x[1] * y[1])) +
                       keep(b, x[2] * y[2]));
}

static void set_base(struct base *b, const double (*const from[4])[3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            b->edge[i][k] = keep(b, (*from[i])[k] - (*from[3])[k]);
    for (int i = 0; i < 3; i++) {
        const double *x = b->edge[(i + 1) % 3], *y = b->edge[(i + 2) % 3];

        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;

            b->normal[i][k] =
                keep(b, keep(b, x[l] * y[m]) - keep(b, x[m] * y[l]));
        }
    }
    b->det = dot(b, b->edge[0], b->normal[0]);
}

/* Sets PLACE to where POINT goes, from the base of FROM to TO. */
static void take(const struct base *b, const double (*const from[4])[3],
                 const double (*const to[4])[3], const double point[3],
                 double place[3])
{
    double off[3], weight[4], sum = 0;

    for (int k = 0; k < 3; k++)
        off[k] = keep(b, point[k] - (*from[3])[k]);
    for (int i = 0; i < 3; i++) {
        weight[i] = keep(b, dot(b, off, b->normal[i]) / b->det);
        sum = keep(b, sum + weight[i]);
    }
    weight[3] = keep(b, 1 - sum);
    for (int k = 0; k < 3; k++) {
        place[k] = 0;
        for (int i = 0; i < 4; i++)
            place[k] = keep(b, place[k] + keep(b, weight[i] * (*to[i])[k]));
    }
}

double glint_four_spans(const double (*const from[4])[3])
{
    struct base b = {.arithmetic = GLINT_DOUBLE};
    double bound = 1;

    set_base(&b, from);
    for (int i = 0; i < 3; i++)
        bound *= sqrt(dot(&b, b.edge[i], b.edge[i]));
    return bound > 0 ? fabs(b.det) / bound : 0;
}

bool glint_four_map(enum glint_arithmetic arithmetic,
                    const double (*const from[4])[3],
                    const double (*const to[4])[3], double map[4][3])
{
    static const double point[4][3] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    struct base b = {.arithmetic = arithmetic};

    if (!(glint_four_spans(from) >= GLINT_RIGID_LEAST))
        return false;
    set_base(&b, from);
    if (b.det == 0)
        return false;
    for (int i = 0; i < 4; i++)
        take(&b, from, to, point[i], map[i]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            map[i][k] = keep(&b, map[i][k] - map[3][k]);
    return true;
}
