/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone.h"

#include <math.h>

#include "bake/trace/degrees.h"

/* -------------------------------------------------------------------- boxes */

/* Of a box; a fuller one is not worth the higher powers of s it takes, which
 * everything that is seen through it has to undo. */
#define ENOUGH_FILL 0.6
#define FULLER      1.6 /* what another power has to gain */

double glint_zone_node(int k, int n)
{
    return n == 1 ? 0 : -cos(GLINT_PI * k / (n - 1));
}

double glint_zone_at(const double side[GLINT_BOX_TERMS], double s, double w)
{
    double value = 0;

    for (int k = GLINT_BOX_POWERS - 1; k >= 0; k--)
        value = value * s + side[k];
    return value +
           w * (side[GLINT_BOX_POWERS] + s * side[GLINT_BOX_POWERS + 1]);
}

/* What a zone's box has to hold, with s and w for the zone. */
enum { ROOM = GLINT_PROFILE * GLINT_HUNT_WAVES };

struct seen {
    int n, n_angles;
    double s[ROOM], w[ROOM];
    double middle[ROOM], half_x[ROOM], half_y[ROOM];
    double narrowest;
};

static void add(struct seen *seen, double s, double w,
                const struct glint_pupil *box)
{
    const int i = seen->n++;

    seen->s[i] = s;
    seen->w[i] = w;
    seen->middle[i] = 0.5 * (box->x0_mm + box->x1_mm);
    seen->half_x[i] = 0.5 * (box->x1_mm - box->x0_mm);
    seen->half_y[i] = box->y1_mm;
    seen->narrowest = fmin(seen->narrowest, seen->half_x[i]);
}

/* One angle beyond each end, too, so that the ends are covered. */
static void gather(const struct glint_visible_profile *p, double lo, double hi,
                   bool by_colour, struct seen *seen)
{
    int first = 0, last = p->n - 1;

    while (first + 1 < last && p->sine[first + 1] <= lo)
        first++;
    while (last - 1 > first && p->sine[last - 1] >= hi)
        last--;
    seen->n = 0;
    seen->n_angles = last - first + 1;
    seen->narrowest = HUGE_VAL;
    for (int k = first; k <= last && !by_colour; k++)
        add(seen, (2 * p->sine[k] - lo - hi) / (hi - lo), 0, &p->box[k]);
    for (int k = 0; k < p->n_glimpses && by_colour; k++) {
        const struct glint_glimpse *g = &p->glimpse[k];

        if (g->sine >= p->sine[first] && g->sine <= p->sine[last])
            add(seen, (2 * g->sine - lo - hi) / (hi - lo), g->w, &g->box);
    }
}

/* The polynomial that follows VALUE within TOLERANCE, or as well as it can with
 * powers of s up to DEGREE, and, BY_COLOUR, w and s w. */
static void follow(const struct seen *seen, const double *value, int degree,
                   bool by_colour, double tolerance,
                   double side[GLINT_BOX_TERMS])
{
    static const double zero[ROOM];
    double scratch[ROOM * (GLINT_BOX_TERMS + 1)], weight[ROOM];
    const struct glint_regress_samples samples = {
        seen->n, {zero, zero, seen->s, seen->w}, weight};
    const int total = degree < 2 ? 2 : degree;
    const struct glint_degrees degrees = {
        .most = {0, 0, (uint8_t)degree, by_colour},
        .weight = {1, 1, 1, (uint8_t)(total - 1)},
        .total = total,
        .parity = -1,
        .terms = GLINT_BOX_TERMS};
    struct glint_poly fit;

    for (int i = 0; i < seen->n; i++)
        weight[i] = 1;
    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        side[k] = 0;
    glint_regress_fit(scratch, &samples, value, &degrees, tolerance,
                      4 * tolerance, &fit);
    for (int k = 0; k < fit.n; k++)
        side[fit.power[k][3] ? GLINT_BOX_POWERS + fit.power[k][2]
                             : fit.power[k][2]] = fit.coef[k];
}

/* What HALF lacks to be above 0 everywhere. */
static double lacks(const double half[GLINT_BOX_TERMS])
{
    double lowest = HUGE_VAL;

    for (int k = -8; k <= 8; k++)
        lowest = fmin(lowest, fmin(glint_zone_at(half, k / 8.0, -1),
                                   glint_zone_at(half, k / 8.0, 1)));
    return -lowest;
}

/* Widens the box until it holds all that was seen, and a hundredth more. */
static void widen(struct glint_zone *z, const struct seen *seen)
{
    double more_x = 0, more_y = 0;

    for (int i = 0; i < seen->n; i++) {
        const double s = seen->s[i], w = seen->w[i];
        const double off =
            fabs(seen->middle[i] - glint_zone_at(z->middle, s, w));

        more_x = fmax(more_x,
                      seen->half_x[i] + off - glint_zone_at(z->half_x, s, w));
        more_y = fmax(more_y, seen->half_y[i] - glint_zone_at(z->half_y, s, w));
    }
    z->half_x[0] += more_x;
    z->half_y[0] += more_y;
    z->half_x[0] += fmax(0.01 * z->half_x[0], 1.1 * lacks(z->half_x));
    z->half_y[0] += fmax(0.01 * z->half_y[0], 1.1 * lacks(z->half_y));
}

static double mean_fill(const struct glint_zone *z, const struct seen *seen)
{
    double sum = 0;

    for (int i = 0; i < seen->n; i++)
        sum += seen->half_x[i] * seen->half_y[i] /
               (glint_zone_at(z->half_x, seen->s[i], seen->w[i]) *
                glint_zone_at(z->half_y, seen->s[i], seen->w[i]));
    return sum / seen->n;
}

static void set_box(struct glint_zone *z, const struct seen *seen, int degree,
                    bool by_colour)
{
    const double tolerance = 0.02 * seen->narrowest;
    const int tame = degree < 2 ? degree : 2;

    follow(seen, seen->middle, degree, by_colour, tolerance, z->middle);
    follow(seen, seen->half_x, tame, by_colour, tolerance, z->half_x);
    follow(seen, seen->half_y, tame, by_colour, tolerance, z->half_y);
    widen(z, seen);
    z->fill = mean_fill(z, seen);
}

void glint_zone_init(struct glint_zone *zone,
                     const struct glint_visible_profile *profile, double lo,
                     double hi, bool by_colour)
{
    struct seen seen;
    int most;

    gather(profile, lo, hi, by_colour, &seen);
    most = seen.n_angles > 12 ? GLINT_BOX_POWERS - 1 : (seen.n_angles - 1) / 2;
    *zone = (struct glint_zone){.fill = 0};
    for (int degree = most < 1 ? most : 1;
         degree <= most && zone->fill < ENOUGH_FILL; degree++) {
        struct glint_zone z = {.lo = lo, .hi = hi};

        set_box(&z, &seen, degree, by_colour);
        if (z.fill > FULLER * zone->fill)
            *zone = z;
    }
}

/* Puts W0 + (1 + w) / 2 * (W1 - W0) in place of w. */
static void narrow(double side[GLINT_BOX_TERMS], double w0, double w1)
{
    double *of_w = side + GLINT_BOX_POWERS;

    for (int k = 0; k < 2; k++) {
        side[k] += 0.5 * (w0 + w1) * of_w[k];
        of_w[k] *= 0.5 * (w1 - w0);
    }
}

double glint_zone_rim(int hollow)
{
    return hollow / (hollow + 1.0);
}

void glint_zone_part_halve(const struct glint_zone_part *part, bool along_v,
                           struct glint_zone_part *first,
                           struct glint_zone_part *second)
{
    const int k = part->hollow;

    *first = *second = *part;
    if (along_v) { /* k .. k + 1 in steps of 1 / (k + 1) of the height */
        first->top *= (2 * k + 1) / (2 * k + 2.0);
        first->hollow = 2 * k;
        second->hollow = 2 * k + 1;
    } else {
        first->u1 = second->u0 = 0.5 * (part->u0 + part->u1);
    }
}

void glint_zone_cut(struct glint_zone *zone, const struct glint_zone_part *part)
{
    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        zone->middle[k] += 0.5 * (part->u0 + part->u1) * zone->half_x[k];
        zone->half_x[k] *= 0.5 * (part->u1 - part->u0);
        zone->half_y[k] *= part->top;
    }
    narrow(zone->middle, part->w0, part->w1);
    narrow(zone->half_x, part->w0, part->w1);
    narrow(zone->half_y, part->w0, part->w1);
    zone->hollow = part->hollow;
}

/* ------------------------------------------------------------------ barrels */

/* Low-discrepancy numbers -1 .. 1: multiples of powers of the root of
 * x^5 = x + 1, which fill four dimensions evenly. */
static void between(int k, double x[GLINT_VARIABLES])
{
    const double root = 1.16730397826141868426;
    double step = 1;

    for (int i = 0; i < GLINT_VARIABLES; i++) {
        step /= root;
        x[i] = 2 * fmod(0.5 + (k + 1) * step, 1) - 1;
    }
}

/* What a ray of the survey says: how far past each barrel it is. */
struct survey {
    int n, n_events;
    double (*radius)[GLINT_MAX_EVENTS + 1];
};

static void direction_of(const struct glint_zone *z, double s, double d[3])
{
    d[0] = 0.5 * (z->lo + z->hi) + 0.5 * s * (z->hi - z->lo);
    d[1] = 0;
    d[2] = sqrt(1 - d[0] * d[0]);
}

/* Rays of one path that are traced together. */
enum { TOGETHER = 32 };

struct together {
    const struct glint_path *path;
    int n;
    double x[TOGETHER][GLINT_VARIABLES]; /* in the zone */
    struct glint_launch from[TOGETHER];
    struct glint_ray ray[TOGETHER];
    enum glint_ray_status status[TOGETHER];
    double hits[TOGETHER * (GLINT_MAX_EVENTS + 1)][2]; /* -1: not reached */
};

/* Adds the ray at X of the zone, w being that of the path and v 0 .. 1 from the
 * inner end of what there is. */
static void together_add(struct together *t, const struct glint_zone *z,
                         const double x[GLINT_VARIABLES])
{
    const double s = x[2], w = x[3], rim = glint_zone_rim(z->hollow);
    struct glint_launch *from = &t->from[t->n];

    for (int k = 0; k < GLINT_VARIABLES; k++)
        t->x[t->n][k] = x[k];
    t->x[t->n][1] = rim + (1 - rim) * x[1];
    from->x_mm =
        glint_zone_at(z->middle, s, w) + x[0] * glint_zone_at(z->half_x, s, w);
    from->y_mm = t->x[t->n][1] * glint_zone_at(z->half_y, s, w);
    direction_of(z, s, from->direction);
    t->n++;
}

static void together_trace(struct together *t)
{
    for (int k = 0; k < t->n * t->path->n_events; k++)
        t->hits[k][0] = t->hits[k][1] = -1;
    glint_trace_many(t->path, t->n, t->from, t->ray, t->status, t->hits);
}

static double (*hits_of(struct together *t, int k))[2]
{
    return t->hits + k * t->path->n_events;
}

/* What LOW .. HIGH of -1 .. 1 is of *FROM .. *TO, which becomes that. */
static void reduce(double low, double high, double *from, double *to)
{
    const double middle = 0.5 * (*from + *to), half = 0.5 * (*to - *from);

    *from = middle + fmax(-1, low) * half;
    *to = middle + fmin(1, high) * half;
}

/* Bounds of what is seen, by u, v and w. */
struct sighting {
    double low[GLINT_VARIABLES], high[GLINT_VARIABLES];
};

static void sight(const struct glint_hunt *h, const struct together *t,
                  struct sighting *seen)
{
    for (int i = 0; i < t->n; i++)
        if (t->status[i] == GLINT_RAY_OK && glint_hunt_visible(h, &t->ray[i]))
            for (int k = 0; k < GLINT_VARIABLES; k++) {
                seen->low[k] = fmin(seen->low[k], t->x[i][k]);
                seen->high[k] = fmax(seen->high[k], t->x[i][k]);
            }
}

double glint_zone_crop(const struct glint_zone *zone,
                       const struct glint_hunt *hunt,
                       struct glint_zone_part *part)
{
    enum { ANGLES = 5, COLUMNS = TOGETHER, ROWS = 12 };
    const double margin = 3.0 / COLUMNS;
    const struct glint_zone_part before = *part;
    struct sighting seen = {{9, 9, 9, 9}, {-9, -9, -9, -9}};
    struct together t;

    for (int k = 0; k < ANGLES * GLINT_HUNT_WAVES * (ROWS + 1); k++) {
        const int row = k % (ROWS + 1), wave = k / (ROWS + 1) / ANGLES;

        t.path = &hunt->scout[wave];
        for (t.n = 0; t.n < COLUMNS;) {
            const double x[GLINT_VARIABLES] = {
                2.0 * t.n / (COLUMNS - 1) - 1, (double)row / ROWS,
                2.0 * (k / (ROWS + 1) % ANGLES) / (ANGLES - 1) - 1,
                glint_zone_node(wave, GLINT_HUNT_WAVES)};

            together_add(&t, zone, x);
        }
        together_trace(&t);
        sight(hunt, &t, &seen);
    }
    if (seen.high[0] < seen.low[0])
        return 0;
    reduce(seen.low[0] - margin, seen.high[0] + margin, &part->u0, &part->u1);
    reduce(seen.low[3] - 0.3, seen.high[3] + 0.3, &part->w0, &part->w1);
    if (!part->hollow)
        part->top *= fmin(1, seen.high[1] + 1.5 / ROWS);
    return (part->u1 - part->u0) / (before.u1 - before.u0) *
           (part->w1 - part->w0) / (before.w1 - before.w0) * part->top /
           before.top;
}

/* Notes the ray's radius at every event if the stop and the field let it pass,
 * so that only barrels can stop it. */
static bool survey_ray(const struct glint_hunt *h,
                       const struct glint_path *path,
                       enum glint_ray_status status,
                       const struct glint_ray *ray, double (*hits)[2],
                       double *radius)
{
    const double stop = h->setup->optics.stop_radius_mm;
    double most = 0;

    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double r = hypot(hits[k][0], hits[k][1]);

        radius[k] =
            e->kind == GLINT_STOP || (hits[k][0] == -1 && hits[k][1] == -1)
                ? 0
                : r / e->semi_mm;
        most = fmax(most, radius[k]);
    }
    if (most <= 1)
        return false;
    return status != GLINT_RAY_OK ||
           (hypot(ray->stop_x_mm, ray->stop_y_mm) < 1.02 * stop &&
            hypot(ray->sensor_x_mm, ray->sensor_y_mm) < h->field_mm);
}

/* Rays at angles of their own: a barrel may cut between any two, and there
 * only. */
static void run_survey(const struct glint_zone *z, const struct glint_hunt *h,
                       struct survey *survey)
{
    static const int waves[] = {GLINT_HUNT_WAVES / 2, 0, GLINT_HUNT_WAVES - 1};
    struct together t;

    survey->n = 0;
    survey->n_events = h->path[0].n_events;
    for (int k = 0; k < GLINT_SURVEY_RAYS / TOGETHER; k++) {
        const int wave = waves[k % 3];
        double x[GLINT_VARIABLES];

        t.path = &h->scout[wave];
        for (t.n = 0; t.n < TOGETHER;) {
            between(k * TOGETHER + t.n, x);
            x[1] = fabs(x[1]);
            x[3] = glint_zone_node(wave, GLINT_HUNT_WAVES);
            together_add(&t, z, x);
        }
        together_trace(&t);
        for (int i = 0; i < TOGETHER; i++)
            survey->n += survey_ray(h, t.path, t.status[i], &t.ray[i],
                                    hits_of(&t, i), survey->radius[survey->n]);
    }
}

/* How far ray RAY gets past the barrels that are not among the N CHOSEN, the
 * relative radius beyond 1; 0 if one of them stops it. */
static double escape(const struct survey *s, int ray, const int *chosen, int n)
{
    const double *r = s->radius[ray];
    double most = 0;

    for (int k = 0; k < n; k++)
        if (r[chosen[k]] > 1)
            return 0;
    for (int k = 0; k < s->n_events; k++)
        most = fmax(most, r[k] - 1);
    return fmin(most, 0.3);
}

/* What escapes with barrel K as the last of N: sum, and the largest. */
static double escapes(const struct survey *s, int *chosen, int n, double *most)
{
    double sum = 0;

    *most = 0;
    for (int i = 0; i < s->n; i++) {
        const double e = escape(s, i, chosen, n);

        sum += e;
        *most = fmax(*most, e);
    }
    return sum;
}

/* Takes barrels, the most useful first, until no ray gets farther past the
 * others than SHOWS. */
static void choose_barrels(const struct survey *s, double shows,
                           struct glint_zone_rays *rays)
{
    double most;

    rays->n_barrels = 0;
    escapes(s, rays->barrel, 0, &most);
    while (most > shows && rays->n_barrels < GLINT_MAX_BARRELS) {
        const int n = rays->n_barrels;
        double least = HUGE_VAL;
        int best = 0;

        for (int k = 0; k < s->n_events; k++) {
            double sum;

            rays->barrel[n] = k;
            sum = escapes(s, rays->barrel, n + 1, &most);
            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        rays->barrel[n] = best;
        rays->n_barrels++;
        escapes(s, rays->barrel, n + 1, &most);
    }
    rays->missed_cut = most;
}

/* ------------------------------------------------------------------ samples */

static void add_ray(const struct glint_hunt *h, const struct glint_path *path,
                    const double x[GLINT_VARIABLES],
                    const struct glint_ray *ray, double (*hits)[2],
                    struct glint_zone_rays *rays)
{
    const double stop = h->setup->optics.stop_radius_mm;
    const int i = rays->n++;

    for (int k = 0; k < GLINT_VARIABLES; k++)
        rays->x[k][i] = x[k];
    rays->at[RAY_SENSOR_X][i] = ray->sensor_x_mm;
    rays->at[RAY_SENSOR_Y][i] = ray->sensor_y_mm;
    rays->at[RAY_STOP_X][i] = ray->stop_x_mm / stop;
    rays->at[RAY_STOP_Y][i] = ray->stop_y_mm / stop;
    rays->at[RAY_ENERGY][i] = ray->energy;
    rays->at[RAY_EXCESS][i] =
        fmax(ray->rel_radius, hypot(ray->stop_x_mm, ray->stop_y_mm) / stop);
    rays->at[RAY_FIELD][i] =
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;
    for (int k = 0; k < rays->n_barrels; k++) {
        const int e = rays->barrel[k];

        rays->radius[k][i] =
            hypot(hits[e][0], hits[e][1]) / path->event[e].semi_mm;
    }
}

/* More nodes than powers in every variable, or a fit would be perfect at the
 * nodes and nowhere else. */
enum { SINES = 9, ACROSS = 24, DOWN = 12 };

/* Rays at one angle and wavelength. Every third of those far outside of what is
 * seen is enough. */
static void trace_plane(const struct glint_zone *zone,
                        const struct glint_hunt *hunt, int sine, int wave,
                        int stride, struct glint_zone_rays *rays)
{
    const int full = rays->n + GLINT_ZONE_RAYS / (4 * SINES);
    struct together t;

    t.path = &hunt->path[wave];
    for (int j = 0; j <= DOWN; j += stride) {
        t.n = 0;
        for (int i = 0; i <= ACROSS; i += stride) {
            const double x[GLINT_VARIABLES] = {
                glint_zone_node(i, ACROSS + 1),
                zone->hollow ? 0.5 + 0.5 * glint_zone_node(j, DOWN + 1)
                             : sin(0.5 * GLINT_PI * j / DOWN),
                glint_zone_node(sine, SINES),
                glint_zone_node(wave, GLINT_HUNT_WAVES)};

            together_add(&t, zone, x);
        }
        together_trace(&t);
        for (int i = 0; i < t.n && rays->n < full; i++) {
            if (t.status[i] != GLINT_RAY_OK)
                continue;
            add_ray(hunt, t.path, t.x[i], &t.ray[i], hits_of(&t, i), rays);
            if (stride == 1 && (i + j) % 3 &&
                fmax(rays->at[RAY_EXCESS][rays->n - 1],
                     rays->at[RAY_FIELD][rays->n - 1]) > 1.1)
                rays->n--;
        }
    }
}

static int count_visible(const struct glint_zone_rays *rays)
{
    int n = 0;

    for (int i = 0; i < rays->n; i++)
        n += glint_zone_rays_seen(rays, i);
    return n;
}

/* Positions are tame in w: four wavelengths at each angle, in turn, are enough.
 * A coarse grid first; a fine one where few of its rays got through.
 */
static void trace_positions(const struct glint_zone *zone,
                            const struct glint_hunt *hunt,
                            struct glint_zone_rays *rays)
{
    static const int shift[] = {0, 3, 5, 8};

    for (int stride = 2; stride > 0; stride--) {
        rays->n = 0;
        for (int k = 0; k < 4 * SINES; k++)
            trace_plane(zone, hunt, k / 4,
                        (k / 4 + shift[k % 4]) % GLINT_HUNT_WAVES, stride,
                        rays);
        if (count_visible(rays) > 500)
            break;
    }
}

double glint_zone_rays_spread(const struct glint_zone_rays *rays)
{
    double least = HUGE_VAL, most = 0, spread = 1;

    for (int i = 0; i < rays->n; i++) {
        if (i == 0 || rays->x[2][i] != rays->x[2][i - 1] ||
            rays->x[3][i] != rays->x[3][i - 1]) {
            least = HUGE_VAL;
            most = 0;
        }
        if (!glint_zone_rays_seen(rays, i))
            continue;
        least = fmin(least, rays->at[RAY_ENERGY][i]);
        most = fmax(most, rays->at[RAY_ENERGY][i]);
        spread = fmax(spread, most / least);
    }
    return spread;
}

/* Energy hardly changes over the pupil, but films make it swing with the
 * wavelength. Towards total reflection it is STEEP: a finer grid then, and at
 * each angle five wavelengths in turn. */
static void trace_energies(const struct glint_zone *zone,
                           const struct glint_hunt *hunt, bool steep,
                           struct glint_zone_rays *rays)
{
    static const int shift[] = {0, 2, 4, 6, 9};

    rays->n = 0;
    for (int k = 0; k < SINES * GLINT_HUNT_WAVES && !steep; k++)
        trace_plane(zone, hunt, k / GLINT_HUNT_WAVES, k % GLINT_HUNT_WAVES, 4,
                    rays);
    for (int k = 0; k < 5 * SINES && steep; k++)
        trace_plane(zone, hunt, k / 5,
                    (k / 5 + shift[k % 5]) % GLINT_HUNT_WAVES, 2, rays);
}

void glint_zone_survey_barrels(const struct glint_zone *zone,
                               const struct glint_hunt *hunt, double shows,
                               glint_zone_survey *survey,
                               struct glint_zone_rays *rays)
{
    struct survey s = {.radius = *survey};

    run_survey(zone, hunt, &s);
    choose_barrels(&s, shows, rays);
}

void glint_zone_trace(const struct glint_zone *zone,
                      const struct glint_hunt *hunt,
                      struct glint_zone_rays *rays,
                      struct glint_zone_rays *energies)
{
    trace_positions(zone, hunt, rays);
    energies->n_barrels = 0;
    trace_energies(zone, hunt, glint_zone_rays_spread(rays) > GLINT_STEEP,
                   energies);
}

void glint_zone_check(const struct glint_zone *zone,
                      const struct glint_hunt *hunt,
                      struct glint_zone_rays *rays)
{
    enum { BUNDLES = 24, RAYS = 16 };
    double x[GLINT_VARIABLES], bundle[GLINT_VARIABLES];
    struct glint_path path;
    struct together t;

    t.path = &path;
    rays->n = rays->n_barrels = 0;
    for (int k = 0; k < BUNDLES; k++) {
        between(k, bundle);
        glint_hunt_path(hunt, bundle[3], &path);
        path.places_only = true;
        for (t.n = 0; t.n < RAYS;) {
            between(k * RAYS + t.n, x);
            x[1] = fabs(x[1]);
            x[2] = bundle[2];
            x[3] = bundle[3];
            together_add(&t, zone, x);
        }
        together_trace(&t);
        for (int i = 0; i < RAYS; i++)
            if (t.status[i] == GLINT_RAY_OK)
                add_ray(hunt, &path, t.x[i], &t.ray[i], hits_of(&t, i), rays);
    }
}
