/* SPDX-License-Identifier: MIT
 *
 * Extracts bright lights from an environment map.
 *
 * A luminance threshold is halved repeatedly. It ends near the mean luminance
 * of the texels below it, at a given multiple of this mean. At each threshold,
 * connected texels above it form a spot. A spot is a light if it is bright and
 * small enough. The lowest threshold at which it is small determines its
 * extent. Spots that merge at a lower threshold become one light, or stay
 * separate if their union is too large.
 */
#include "bake/environment/sphere.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/view.h"

/* min luminance x solid angle of an extracted light, as a fraction of the sum
 * over the sphere */
#define LEAST_SHARE .002

enum {
    MAX_SPOTS = 4096,
    /* width of the ring around a light, texels; its mean replaces the light in
     * the map */
    RING = 2,
    NOBODY = -1
};

struct spot {
    /* luminance x sr of the spot; 0: the spot was merged into another one or
     * extracted as a light */
    double light;
};

struct split {
    struct glint_sphere *sphere;
    double limit; /* max squared RMS radius of a light, radians^2 */
    double all;   /* total luminance x sr of the sphere */
    /* [texels]: index of the spot that contains the texel, or NOBODY */
    int *owner;
    /* [texels]: number of the last flood fill that visited the texel */
    int *seen;
    int *queue; /* [texels]: indices of the texels of the current flood fill */
    struct spot spot[MAX_SPOTS];
    int n_spots;
};

static double get_texel_luminance(const struct split *s, int i)
{
    return glint_luminance(s->sphere->texel[i].light);
}

static void find_texel_neighbours(const struct split *s, int i, int near[8])
{
    const int side = s->sphere->side, x = i % side, y = i / side;
    int n = 0;

    for (int v = -1; v <= 1; v++)
        for (int u = -1; u <= 1; u++)
            if (u || v)
                near[n++] =
                    (int)glint_sphere_get_texel_index(side, x + u, y + v);
}

/* Flood fill: sets the queue to the texels that are connected with texel I and
 * whose luminance is at least THRESHOLD. Marks visited texels with ROUND, the
 * number of this fill. Returns the number of queued texels. */
static int flood_fill_texels(struct split *s, int i, double threshold,
                             int round)
{
    int n = 0, near[8];

    s->queue[n++] = i;
    s->seen[i] = round;
    for (int at = 0; at < n; at++) {
        find_texel_neighbours(s, s->queue[at], near);
        for (int k = 0; k < 8; k++)
            if (s->seen[near[k]] != round &&
                get_texel_luminance(s, near[k]) >= threshold) {
                s->seen[near[k]] = round;
                s->queue[n++] = near[k];
            }
    }
    return n;
}

/* Returns luminance x sr of the N texels in the queue. Sets *SQUARE to the
 * square of their RMS radius, radians^2. */
static double measure_queued_spot(const struct split *s, int n, double *square)
{
    double middle[3] = {0, 0, 0}, sum = 0, length, cosine;

    for (int at = 0; at < n; at++) {
        const struct glint_sphere_texel *t = &s->sphere->texel[s->queue[at]];
        const double light = t->weight * glint_luminance(t->light);

        for (int k = 0; k < 3; k++)
            middle[k] += light * t->toward[k];
        sum += light;
    }
    length = sqrt(middle[0] * middle[0] + middle[1] * middle[1] +
                  middle[2] * middle[2]);
    /* mean cosine of the angle between the texels and their centroid */
    cosine = sum > 0 ? length / sum : 0;
    *square = 2 * (1 - cosine);
    return sum;
}

/* Records the N texels in the queue as a spot if they are bright and small
 * enough for a light, and removes the spots that they contain. */
static void add_spot_if_light(struct split *s, int n)
{
    double square;
    const double light = measure_queued_spot(s, n, &square);

    if (square > s->limit || light < LEAST_SHARE * s->all ||
        s->n_spots == MAX_SPOTS)
        return;
    for (int at = 0; at < n; at++) {
        int *owner = &s->owner[s->queue[at]];

        if (*owner != NOBODY)
            s->spot[*owner].light = 0;
        *owner = s->n_spots;
    }
    s->spot[s->n_spots++].light = light;
}

static double compute_mean_luminance_below(const struct split *s, int n,
                                           double threshold)
{
    double sum = 0, weight = 0;

    for (int i = 0; i < n; i++)
        if (get_texel_luminance(s, i) < threshold) {
            sum += s->sphere->texel[i].weight * get_texel_luminance(s, i);
            weight += s->sphere->texel[i].weight;
        }
    return weight > 0 ? sum / weight : 0;
}

static void find_bright_spots(struct split *s, int n, double above)
{
    double threshold = 0;

    for (int i = 0; i < n; i++) {
        threshold = fmax(threshold, get_texel_luminance(s, i));
        s->all += s->sphere->texel[i].weight * get_texel_luminance(s, i);
    }
    for (int round = 1; round < 64; round++) {
        threshold /= 2;
        if (!(threshold >
              above * compute_mean_luminance_below(s, n, threshold)))
            return;
        for (int i = 0; i < n; i++)
            if (s->seen[i] != round && get_texel_luminance(s, i) >= threshold)
                add_spot_if_light(s, flood_fill_texels(s, i, threshold, round));
    }
}

/* Sets MEAN to the mean light of the ring around spot K, without texels of
 * spots that are not extracted yet. Sets it to 0 if these fill the ring. ROUND:
 * an unused flood-fill number, which marks visited texels. */
static void compute_mean_around_spot(struct split *s, int k, int n, int round,
                                     double mean[3])
{
    double weight = 0;
    int count = 0, begin = 0;

    memset(mean, 0, 3 * sizeof *mean);
    for (int i = 0; i < n; i++)
        if (s->owner[i] == k) {
            s->seen[i] = round;
            s->queue[count++] = i;
        }
    for (int ring = 0; ring < RING; ring++) {
        const int end = count;

        for (; begin < end; begin++) {
            int near[8];

            find_texel_neighbours(s, s->queue[begin], near);
            for (int j = 0; j < 8; j++)
                if (s->seen[near[j]] != round) {
                    s->seen[near[j]] = round;
                    s->queue[count++] = near[j];
                }
        }
    }
    for (int at = 0; at < count; at++) {
        const struct glint_sphere_texel *t = &s->sphere->texel[s->queue[at]];
        const int owner = s->owner[s->queue[at]];

        if (owner != NOBODY && s->spot[owner].light > 0)
            continue;
        for (int c = 0; c < 3; c++)
            mean[c] += t->weight * t->light[c];
        weight += t->weight;
    }
    for (int c = 0; c < 3; c++)
        mean[c] = weight > 0 ? mean[c] / weight : 0;
}

/* Moves the light above MEAN from the texels of spot K to LIGHT. At most MEAN
 * remains in the map. */
static void move_spot_to_light(struct split *s, int k, int n,
                               const double mean[3],
                               struct glint_split_light *light)
{
    double middle[3] = {0, 0, 0}, sum = 0, length, square;

    memset(light, 0, sizeof *light);
    for (int i = 0; i < n; i++) {
        struct glint_sphere_texel *t = &s->sphere->texel[i];
        double more[3], luma;

        if (s->owner[i] != k)
            continue;
        for (int c = 0; c < 3; c++) {
            more[c] = t->weight * fmax(t->light[c] - mean[c], 0);
            light->irradiance[c] += more[c];
            t->light[c] = fmin(t->light[c], mean[c]);
        }
        luma = glint_luminance(more);
        for (int j = 0; j < 3; j++)
            middle[j] += luma * t->toward[j];
        sum += luma;
    }
    length = sqrt(middle[0] * middle[0] + middle[1] * middle[1] +
                  middle[2] * middle[2]);
    for (int j = 0; j < 3; j++)
        light->toward[j] = middle[j] / length;
    /* The squared RMS radius of a uniform square is 1/6 of its area.
     * Subtracting that of a texel, 4 pi / side^2 sr, removes the blur by
     * texels. */
    square = 2 * (1 - fmin(length / sum, 1)) -
             4 * GLINT_PI / (6. * s->sphere->side * s->sphere->side);
    light->radius = sqrt(2 * fmax(square, 0));
}

/* Extracts the strongest spots as LIGHTS, at most MOST. Returns their
 * number. */
static int extract_strongest_spots(struct split *s, int n, int most,
                                   struct glint_split_light *lights,
                                   struct glint_environment_report *report)
{
    int taken = 0;

    for (int k = 0; k < s->n_spots; k++)
        report->spots += s->spot[k].light > 0;
    while (taken < most) {
        double mean[3];
        int best = NOBODY;

        for (int k = 0; k < s->n_spots; k++)
            if (s->spot[k].light > 0 &&
                (best == NOBODY || s->spot[k].light > s->spot[best].light))
                best = k;
        if (best == NOBODY)
            break;
        compute_mean_around_spot(s, best, n, 64 + taken, mean);
        move_spot_to_light(s, best, n, mean, &lights[taken]);
        s->spot[best].light = 0;
        report->light_share +=
            glint_luminance(lights[taken++].irradiance) / s->all;
    }
    return taken;
}

int glint_sphere_extract_lights(struct glint_sphere *sphere,
                                const struct glint_environment_options *options,
                                struct glint_split_light *lights,
                                struct glint_environment_report *report)
{
    const size_t n = (size_t)sphere->side * (size_t)sphere->side;
    const double rms = options->light_deg * GLINT_PI / 180;
    struct split *s = calloc(1, sizeof *s);
    int *words = malloc(3 * n * sizeof *words);
    int taken = -1;

    if (s && words) {
        s->sphere = sphere;
        s->limit = rms * rms;
        s->owner = words;
        s->seen = words + n;
        s->queue = words + 2 * n;
        memset(s->owner, 0xff, n * sizeof *s->owner);
        memset(s->seen, 0, n * sizeof *s->seen);
        if (options->max_lights > 0)
            find_bright_spots(s, (int)n, options->light_above);
        taken = extract_strongest_spots(s, (int)n, options->max_lights, lights,
                                        report);
    }
    free(words);
    free(s);
    return taken;
}
