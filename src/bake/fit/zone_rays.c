/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_rays.h"

#include <math.h>

#include "engine/setup/degrees.h"

/* Returns the largest relative radius of RAY over all surfaces and the stop. */
static double compute_excess(const struct glint_visible *h,
                             const struct glint_ray *ray)
{
    return fmax(ray->rel_radius, hypot(ray->stop_x_mm, ray->stop_y_mm) /
                                     h->setup->optics.stop_radius_mm);
}

/* Returns the distance of RAY from the sensor's centre, in field radii. */
static double compute_field(const struct glint_visible *h,
                            const struct glint_ray *ray)
{
    return hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;
}

static void add_ray(const struct glint_visible *h,
                    const struct glint_path *path,
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
    rays->at[RAY_EXCESS][i] = compute_excess(h, ray);
    rays->at[RAY_SPREAD][i] = 0;
    rays->at[RAY_FIELD][i] = compute_field(h, ray);
    for (int k = 0; k < rays->n_barrels; k++) {
        const int e = rays->barrel[k];

        rays->radius[k][i] =
            hypot(hits[e][0], hits[e][1]) / path->event[e].semi_mm;
    }
}

/* For each ray of a batch, EXCESS and FIELD (enum in zone_rays.h) at the
 * neighbouring zoom position where the larger of both is smallest. */
struct beside {
    double excess[GLINT_ZONE_BATCH], field[GLINT_ZONE_BATCH];
};

/* Returns whether (EXCESS, FIELD) is nearer to the visible region than ray I
 * of B. */
static bool is_nearer(const struct beside *b, int i, double excess,
                      double field)
{
    return fmax(excess, field) < fmax(b->excess[i], b->field[i]);
}

/* Traces the rays of T at wavelength number WAVE at the neighbouring zoom
 * positions. */
static void trace_beside(const struct glint_visible *visible, int wave,
                         struct glint_zone_batch *t, struct beside *b)
{
    for (int i = 0; i < t->n; i++)
        b->excess[i] = b->field[i] = HUGE_VAL;
    for (int m = 0; m < visible->n_beside; m++) {
        const struct glint_visible *const h = &visible->beside[m];

        t->path = &h->position_path[wave];
        glint_zone_batch_trace(t);
        for (int i = 0; i < t->n; i++) {
            double excess, field;

            if (t->status[i] != GLINT_RAY_OK)
                continue;
            excess = compute_excess(h, &t->ray[i]);
            field = compute_field(h, &t->ray[i]);
            if (is_nearer(b, i, excess, field)) {
                b->excess[i] = excess;
                b->field[i] = field;
            }
        }
    }
}

/* Replaces EXCESS and FIELD of the last of RAYS by those of ray I of B if
 * the latter are nearer to the visible region. */
static void update_beside(const struct beside *b, int i,
                          struct glint_zone_rays *rays)
{
    double *const excess = &rays->at[RAY_EXCESS][rays->n - 1];
    double *const field = &rays->at[RAY_FIELD][rays->n - 1];

    if (is_nearer(b, i, *excess, *field))
        return;
    *excess = b->excess[i];
    *field = b->field[i];
}

/* Numbers of angles, and of cells across and down. Each variable has more
 * nodes than powers; otherwise a fit could be exact at the nodes and wrong
 * between them. */
enum { SINES = 9, ACROSS = 24, DOWN = 12 };

/* Returns the fractional part of N times R. */
static double fraction_of_turn(int n, double r)
{
    return fmod(n * r, 1);
}

/* Traces rays at one angle and wavelength. In lenses that open wide each
 * angle and wavelength gets a shifted grid; otherwise polynomials could
 * oscillate between the rays. In the finest grid only every third ray far
 * outside the visible region is stored. */
static void trace_plane(const struct glint_zone *zone,
                        const struct glint_visible *visible, int sine, int wave,
                        int stride, struct glint_zone_rays *rays)
{
    const int full = rays->n + GLINT_ZONE_RAYS / (4 * SINES);
    /* Multiples of 1 / g and 1 / g^2, where g is the root of x^3 = x + 1,
     * fill a square evenly. */
    const int plane = sine * 4 + wave;
    const double move = visible->wide ? stride : 0;
    const double right = move * fraction_of_turn(plane, 0.75487766624669276);
    const double up = move * fraction_of_turn(plane, 0.56984029099805327);
    struct glint_zone_batch t;
    struct beside beside;

    for (int j = 0; j <= DOWN; j += stride) {
        t.n = 0;
        for (int i = 0; i <= ACROSS; i += stride) {
            const double x[GLINT_VARIABLES] = {
                -cos(GLINT_PI * fmin(i + right, ACROSS) / ACROSS),
                zone->annulus
                    ? 0.5 - 0.5 * cos(GLINT_PI * fmin(j + up, DOWN) / DOWN)
                    : sin(0.5 * GLINT_PI * fmin(j + up, DOWN) / DOWN),
                glint_zone_node(sine, SINES),
                glint_zone_node(wave, GLINT_VISIBLE_WAVES)};

            glint_zone_batch_add(&t, zone, x);
        }
        trace_beside(visible, wave, &t, &beside);
        t.path = &visible->path[wave];
        glint_zone_batch_trace(&t);
        for (int i = 0; i < t.n && rays->n < full; i++) {
            if (t.status[i] != GLINT_RAY_OK)
                continue;
            add_ray(visible, t.path, t.x[i], &t.ray[i],
                    glint_zone_batch_hits(&t, i), rays);
            update_beside(&beside, i, rays);
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

/* Traces rays for positions. Positions vary slowly with w, so four
 * wavelengths per angle, different ones at consecutive angles, are
 * sufficient. Starts with a coarse grid and repeats with a fine one if few
 * rays pass. */
static void trace_positions(const struct glint_zone *zone,
                            const struct glint_visible *visible,
                            struct glint_zone_rays *rays)
{
    static const int shift[] = {0, 3, 5, 8};

    for (int stride = 2; stride > 0; stride--) {
        rays->n = 0;
        for (int k = 0; k < 4 * SINES; k++)
            trace_plane(zone, visible, k / 4,
                        (k / 4 + shift[k % 4]) % GLINT_VISIBLE_WAVES, stride,
                        rays);
        if (count_visible(rays) > 500)
            break;
    }
}

/* Distance in u or v between a ray and its neighbours. */
#define ASIDE 0.01

/* Adds the ray at X to batch T; if THREE, between its neighbours in v and in
 * u. */
static void add_position(struct glint_zone_batch *t,
                         const struct glint_zone *zone,
                         double x[GLINT_VARIABLES], bool three)
{
    const double v = x[1];

    if (three) {
        x[1] = v + (v < 0.5 ? ASIDE : -ASIDE);
        glint_zone_batch_add(t, zone, x);
        x[1] = v;
    }
    glint_zone_batch_add(t, zone, x);
    if (three) {
        x[0] += x[0] < 0 ? ASIDE : -ASIDE;
        glint_zone_batch_add(t, zone, x);
    }
}

/* Adds the middle ray of each group of three in T, with RAY_SPREAD from its
 * two neighbours. */
static void add_middles(const struct glint_visible *visible,
                        struct glint_zone_batch *t,
                        struct glint_zone_rays *rays)
{
    for (int i = 1; i < t->n; i += 3) {
        const struct glint_ray *const a = &t->ray[i - 1], *const b = &t->ray[i];
        const struct glint_ray *const c = &t->ray[i + 1];

        if (t->status[i] != GLINT_RAY_OK)
            continue;
        add_ray(visible, t->path, t->x[i], b, glint_zone_batch_hits(t, i),
                rays);
        if (t->status[i - 1] == GLINT_RAY_OK &&
            t->status[i + 1] == GLINT_RAY_OK)
            rays->at[RAY_SPREAD][rays->n - 1] =
                fabs((a->sensor_x_mm - b->sensor_x_mm) *
                         (c->sensor_y_mm - b->sensor_y_mm) -
                     (a->sensor_y_mm - b->sensor_y_mm) *
                         (c->sensor_x_mm - b->sensor_x_mm)) /
                (ASIDE * ASIDE);
    }
}

/* Traces the rays of a skew zone, for both positions and energies: a few
 * rays at each of many directions and wavelengths. Directions fill the zone
 * up to its borders. */
static void trace_scattered(const struct glint_zone *zone,
                            const struct glint_visible *visible,
                            struct glint_zone_rays *rays)
{
    enum { PLANES = 132, RAYS = 24, AT_ONCE = RAYS / 3 };
    struct glint_zone_batch t;

    rays->n = 0;
    for (int k = 0; k < PLANES * RAYS / AT_ONCE; k++) {
        const int wave = k / 3 % GLINT_VISIBLE_WAVES;
        double plane[GLINT_VARIABLES], x[GLINT_VARIABLES];

        glint_zone_scatter(zone, k / 3, plane);
        t.path = &visible->path[wave];
        t.n = 0;
        for (int n = 0; n < AT_ONCE; n++) {
            glint_zone_scatter(zone, k * AT_ONCE + n, x);
            for (int i = 0; i < GLINT_VARIABLES; i++)
                x[i] = sin(0.5 * GLINT_PI * (i < GLINT_S ? x[i] : plane[i]));
            x[GLINT_W] = glint_zone_node(wave, GLINT_VISIBLE_WAVES);
            add_position(&t, zone, x, true);
        }
        glint_zone_batch_trace(&t);
        add_middles(visible, &t, rays);
    }
}

bool glint_zone_rays_dark(const struct glint_zone_rays *rays)
{
    for (int i = 0; i < rays->n; i++)
        if (glint_zone_rays_seen(rays, i))
            return false;
    return true;
}

double glint_zone_rays_spread(const struct glint_zone_rays *rays)
{
    double least = HUGE_VAL, most = 0, spread = 1;

    for (int i = 0; i < rays->n; i++) {
        if (i == 0 || !glint_zone_rays_alike(rays, i, i - 1)) {
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

/* Traces rays for energies. Energies hardly vary over the pupil, but films
 * make them oscillate with the wavelength. STEEP: energies vary over the
 * pupil, as towards total reflection; then the grid is finer, with five
 * wavelengths per angle. */
static void trace_energies(const struct glint_zone *zone,
                           const struct glint_visible *visible, bool steep,
                           struct glint_zone_rays *rays)
{
    static const int shift[] = {0, 2, 4, 6, 9};

    rays->n = 0;
    for (int k = 0; k < SINES * GLINT_VISIBLE_WAVES && !steep; k++)
        trace_plane(zone, visible, k / GLINT_VISIBLE_WAVES,
                    k % GLINT_VISIBLE_WAVES, 4, rays);
    for (int k = 0; k < 5 * SINES && steep; k++)
        trace_plane(zone, visible, k / 5,
                    (k / 5 + shift[k % 5]) % GLINT_VISIBLE_WAVES, 2, rays);
}

void glint_zone_trace(const struct glint_zone *zone,
                      const struct glint_visible *visible,
                      struct glint_zone_rays *rays,
                      struct glint_zone_rays *energies)
{
    energies->n_barrels = energies->n = 0;
    rays->scattered = energies->scattered = zone->skew;
    if (zone->skew) {
        trace_scattered(zone, visible, rays);
        return;
    }
    trace_positions(zone, visible, rays);
    trace_energies(zone, visible, glint_zone_rays_spread(rays) > GLINT_STEEP,
                   energies);
}

/* Adds the rays of T in groups of N consecutive rays. Skips groups with a
 * ray that misses a surface. */
static void add_groups(const struct glint_visible *visible,
                       struct glint_zone_batch *t, int n,
                       struct glint_zone_rays *rays)
{
    for (int i = 0; i < t->n; i += n) {
        bool all = true;

        for (int k = 0; k < n; k++)
            all &= t->status[i + k] == GLINT_RAY_OK;
        for (int k = i; k < i + n && all; k++)
            add_ray(visible, t->path, t->x[k], &t->ray[k],
                    glint_zone_batch_hits(t, k), rays);
    }
}

void glint_zone_check(const struct glint_zone *zone,
                      const struct glint_visible *visible,
                      struct glint_zone_rays *rays)
{
    enum { BUNDLES = 24, RAYS = 16, IN_THREES = 10 };
    const int group = glint_zone_by_light(zone, visible) ? 3 : 1;
    const int places = group == 3 ? IN_THREES : RAYS;
    double x[GLINT_VARIABLES], bundle[GLINT_VARIABLES];
    struct glint_path path;
    struct glint_zone_batch t;

    t.path = &path;
    rays->n = rays->n_barrels = 0;
    for (int k = 0; k < BUNDLES; k++) {
        glint_zone_scatter(zone, k, bundle);
        glint_visible_path(visible, bundle[3], &path);
        path.places_only = group == 1;
        t.n = 0;
        for (int i = 0; i < places; i++) {
            glint_zone_scatter(zone, k * RAYS + i, x);
            x[GLINT_S] = bundle[GLINT_S];
            x[GLINT_W] = bundle[GLINT_W];
            x[GLINT_P] = bundle[GLINT_P];
            add_position(&t, zone, x, group == 3);
        }
        glint_zone_batch_trace(&t);
        if (zone->skew)
            add_middles(visible, &t, rays);
        else
            add_groups(visible, &t, group, rays);
    }
}

/* ------------------------------------------------------------------ barrels */

/* Chooses the barrels that are fitted in a zone, such that no ray that
 * passes them is far outside any other barrel. */

/* Min range of the relative radii at a barrel. If rays differ by less, the
 * distance outside the barrel is scaled as if they differed by this much.
 * Where light grazes a hemispherical surface of a fisheye, the whole ghost
 * lies within 0.003 of the rim. */
#define LEAST_RANGE 0.1

/* Relative radius that stands for missing a surface. */
#define MISS 1.3

/* Samples of a zone: relative radius of each ray at each event. */
struct sampling {
    int n, n_events;
    bool lost[GLINT_SAMPLING_RAYS]; /* true: the ray misses a surface, so that
                                       its position in the stop is unknown */
    double (*radius)[GLINT_MAX_EVENTS + 1];
    /* range of the relative radii of rays inside the stop and the field */
    double low[GLINT_MAX_EVENTS + 1], high[GLINT_MAX_EVENTS + 1];
    /* factor on the distance outside each barrel */
    double factor[GLINT_MAX_EVENTS + 1];
};

/* Returns whether HIT marks an event that the ray does not reach. */
static bool is_unreached(const double hit[2])
{
    return hit[0] == -1 && hit[1] == -1;
}

/* If a ray misses a surface, sets its relative radius at the first event
 * without a hit to MISS and returns MISS; else returns 0. */
static double mark_missed(double *radius, double (*hits)[2], int n_events)
{
    int k = 0;

    while (k < n_events && !is_unreached(hits[k]))
        k++;
    if (k < n_events)
        radius[k] = MISS;
    return k < n_events ? MISS : 0;
}

/* Extends the ranges of S by the relative radii RADIUS. */
static void extend_range(struct sampling *s, const double *radius)
{
    for (int k = 0; k < s->n_events; k++) {
        s->low[k] = fmin(s->low[k], radius[k]);
        s->high[k] = fmax(s->high[k], radius[k]);
    }
}

/* Stores the relative radius of a ray at every event. Returns whether the
 * ray is needed: it is inside the stop and the field, and at least one
 * barrel blocks it. */
static bool sample_ray(const struct glint_visible *h,
                       const struct glint_path *path,
                       enum glint_ray_status status,
                       const struct glint_ray *ray, double (*hits)[2],
                       struct sampling *sampling)
{
    double *const radius = sampling->radius[sampling->n];
    const double stop = h->setup->optics.stop_radius_mm;
    double most = 0;

    for (int k = 0; k < path->n_events; k++) {
        const struct glint_event *e = &path->event[k];
        const double r = hypot(hits[k][0], hits[k][1]);

        radius[k] =
            e->kind == GLINT_STOP || is_unreached(hits[k]) ? 0 : r / e->semi_mm;
        most = fmax(most, radius[k]);
    }
    sampling->lost[sampling->n] = status != GLINT_RAY_OK;
    if (status == GLINT_RAY_MISSED && h->far)
        most = fmax(most, mark_missed(radius, hits, path->n_events));
    if (status != GLINT_RAY_OK)
        return most > 1;
    if (hypot(ray->stop_x_mm, ray->stop_y_mm) >= 1.02 * stop ||
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) >= h->field_mm)
        return false;
    extend_range(sampling, radius);
    return most > 1;
}

/* Samples rays at scattered angles, as a barrel may cut in a narrow range of
 * angles only. */
static void sample_rays(const struct glint_zone *z,
                        const struct glint_visible *visible,
                        struct sampling *sampling)
{
    /* Fewer rays: skew zones are numerous, and rays through surfaces that
     * are not spheres are slow to trace. */
    const int n = GLINT_SAMPLING_RAYS / (z->skew ? 2 : visible->shaped ? 3 : 1);
    struct glint_zone_batch t;

    sampling->n = 0;
    sampling->n_events = visible->path[0].n_events;
    for (int k = 0; k < sampling->n_events; k++) {
        sampling->low[k] = HUGE_VAL;
        sampling->high[k] = 0;
    }
    for (int k = 0; k < n / GLINT_ZONE_BATCH; k++) {
        const int members = 1 + visible->n_beside;
        const struct glint_visible *const h =
            glint_visible_member(visible, k % members);
        const int wave =
            glint_visible_colour[k / members % GLINT_VISIBLE_COLOURS];
        double x[GLINT_VARIABLES];

        t.path = &h->position_path[wave];
        for (t.n = 0; t.n < GLINT_ZONE_BATCH;) {
            glint_zone_scatter(z, k * GLINT_ZONE_BATCH + t.n, x);
            x[3] = glint_zone_node(wave, GLINT_VISIBLE_WAVES);
            glint_zone_batch_add(&t, z, x);
        }
        glint_zone_batch_trace(&t);
        for (int i = 0; i < GLINT_ZONE_BATCH; i++)
            sampling->n += sample_ray(h, t.path, t.status[i], &t.ray[i],
                                      glint_zone_batch_hits(&t, i), sampling);
    }
    for (int k = 0; k < sampling->n_events; k++) {
        const double range = sampling->high[k] - sampling->low[k];

        sampling->factor[k] = visible->far && range > 0 && range < LEAST_RANGE
                                  ? LEAST_RANGE / range
                                  : 1;
    }
}

/* Returns how far ray RAY escapes the barrels: its max relative radius - 1,
 * weighted and at most 0.3; 0 if one of the N CHOSEN barrels blocks it. */
static double compute_escape(const struct sampling *s, int ray,
                             const int *chosen, int n)
{
    const double *r = s->radius[ray];
    double most = 0;

    for (int k = 0; k < n; k++)
        if (r[chosen[k]] > 1)
            return 0;
    for (int k = 0; k < s->n_events; k++)
        most = fmax(most, s->factor[k] * (r[k] - 1));
    return fmin(most, 0.3);
}

/* Returns the sum of compute_escape() of all rays past N CHOSEN barrels. *MOST
 * receives the largest. */
static double sum_escapes(const struct sampling *s, bool lost,
                          const int *chosen, int n, double *most)
{
    double sum = 0;

    *most = 0;
    for (int i = 0; i < s->n; i++) {
        const double e =
            !lost && s->lost[i] ? 0 : compute_escape(s, i, chosen, n);

        sum += e;
        *most = fmax(*most, e);
    }
    return sum;
}

/* Adds barrels, each time the one that blocks most, until compute_escape() is
 * at most SHOWS for all rays, or, if LOST is false, for all rays that do not
 * miss a surface. */
static void choose_barrels(const struct sampling *s, bool lost, double shows,
                           struct glint_zone_rays *rays)
{
    double most;

    sum_escapes(s, lost, rays->barrel, rays->n_barrels, &most);
    while (most > shows && rays->n_barrels < GLINT_MAX_BARRELS) {
        const int n = rays->n_barrels;
        double least = HUGE_VAL;
        int best = 0;

        for (int k = 0; k < s->n_events; k++) {
            double sum;

            rays->barrel[n] = k;
            sum = sum_escapes(s, lost, rays->barrel, n + 1, &most);
            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        rays->barrel[n] = best;
        rays->n_barrels++;
        sum_escapes(s, lost, rays->barrel, n + 1, &most);
    }
    rays->missed_cut = most;
}

void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays)
{
    struct sampling s = {.radius = *sampling};

    sample_rays(zone, visible, &s);
    rays->n_barrels = 0;
    if (visible->far)
        choose_barrels(&s, false, shows, rays);
    choose_barrels(&s, true, shows, rays);
}
