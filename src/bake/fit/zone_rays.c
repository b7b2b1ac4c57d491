/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_rays.h"

#include <math.h>

#include "engine/setup/degrees.h"

/* Returns the max relative radius of RAY over all surfaces and the stop. */
static double compute_max_radius(const struct glint_visible *h,
                                 const struct glint_ray *ray)
{
    return fmax(ray->rel_radius, hypot(ray->stop_x_mm, ray->stop_y_mm) /
                                     h->setup->optics.stop_radius_mm);
}

/* Returns the distance of RAY's sensor position from the sensor's centre, in
 * field radii. */
static double compute_field_radius(const struct glint_visible *h,
                                   const struct glint_ray *ray)
{
    return hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;
}

static void append_zone_ray(const struct glint_visible *h,
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
    rays->at[RAY_EXCESS][i] = compute_max_radius(h, ray);
    rays->at[RAY_SPREAD][i] = 0;
    rays->at[RAY_FIELD][i] = compute_field_radius(h, ray);
    for (int k = 0; k < rays->n_barrels; k++) {
        const int e = rays->barrel[k];

        rays->radius[k][i] =
            hypot(hits[e][0], hits[e][1]) / path->event[e].semi_mm;
    }
}

static void append_invalid_ray(const double x[GLINT_VARIABLES],
                               struct glint_zone_rays *rays)
{
    const int i = rays->n_invalid++;

    for (int k = 0; k < GLINT_VARIABLES; k++)
        rays->invalid[k][i] = x[k];
}

/* RAY_EXCESS and RAY_FIELD of each ray of a batch at that neighbouring zoom
 * position where the larger one of both is smallest. */
struct beside {
    double excess[GLINT_ZONE_BATCH], field[GLINT_ZONE_BATCH];
};

/* Returns whether a ray with these values of RAY_EXCESS and RAY_FIELD is nearer
 * to the visible region than entry I of B. */
static bool is_nearer_to_visible_region(const struct beside *b, int i,
                                        double excess, double field)
{
    return fmax(excess, field) < fmax(b->excess[i], b->field[i]);
}

/* Traces the rays of T, at wavelength index WAVE, at all neighbouring zoom
 * positions and records the values nearest to the visible region in B. */
static void trace_neighbour_zoom_positions(const struct glint_visible *visible,
                                           int wave, struct glint_zone_batch *t,
                                           struct beside *b)
{
    for (int i = 0; i < GLINT_ZONE_BATCH; i++)
        b->excess[i] = b->field[i] = HUGE_VAL;
    for (int m = 0; m < visible->n_beside; m++) {
        const struct glint_visible *const h = &visible->beside[m];

        t->path = &h->position_path[wave];
        glint_zone_batch_trace_rays(t, false);
        for (int i = 0; i < t->n; i++) {
            double excess, field;

            if (t->status[i] != GLINT_RAY_OK)
                continue;
            excess = compute_max_radius(h, &t->ray[i]);
            field = compute_field_radius(h, &t->ray[i]);
            if (is_nearer_to_visible_region(b, i, excess, field)) {
                b->excess[i] = excess;
                b->field[i] = field;
            }
        }
    }
}

/* Replaces RAY_EXCESS and RAY_FIELD of the last ray of RAYS by those of entry I
 * of B if that entry is nearer to the visible region. */
static void replace_by_nearer_zoom_position(const struct beside *b, int i,
                                            struct glint_zone_rays *rays)
{
    double *const excess = &rays->at[RAY_EXCESS][rays->n - 1];
    double *const field = &rays->at[RAY_FIELD][rays->n - 1];

    if (is_nearer_to_visible_region(b, i, *excess, *field))
        return;
    *excess = b->excess[i];
    *field = b->field[i];
}

/* Number of angles (SINES) and of grid cells along both axes of the pupil. Each
 * variable has more nodes than powers; otherwise a fit could be exact at all
 * nodes and wrong in between. */
enum { SINES = 9, ACROSS = 24, DOWN = 12 };

/* Returns the fractional part of N * R. */
static double compute_fractional_product(int n, double r)
{
    return fmod(n * r, 1);
}

/* grid over the pupil at one angle and wavelength, in zone coordinates */
struct pupil_grid {
    int columns, rows;
    double u[ACROSS + 1], v[DOWN + 1], s, w;
};

/* Sets G to every STRIDE-th column and row. Fast lenses: the grid is shifted by
 * a different amount for each angle and wavelength, as polynomials could
 * otherwise oscillate between rays. */
static void set_pupil_grid(const struct glint_zone *zone, bool wide, int sine,
                           int wave, int stride, struct pupil_grid *g)
{
    /* Multiples of 1 / g and 1 / g^2 fill a square evenly, where g is the root
     * of x^3 = x + 1. */
    const int plane = sine * 4 + wave;
    const double move = wide ? stride : 0;
    const double right =
        move * compute_fractional_product(plane, 0.75487766624669276);
    const double up =
        move * compute_fractional_product(plane, 0.56984029099805327);

    g->columns = ACROSS / stride + 1;
    g->rows = DOWN / stride + 1;
    for (int i = 0; i < g->columns; i++)
        g->u[i] = -cos(GLINT_PI * fmin(i * stride + right, ACROSS) / ACROSS);
    for (int j = 0; j < g->rows; j++) {
        const double at = fmin(j * stride + up, DOWN);

        g->v[j] = zone->annulus ? 0.5 - 0.5 * cos(GLINT_PI * at / DOWN)
                                : sin(0.5 * GLINT_PI * at / DOWN);
    }
    g->s = glint_zone_compute_node(sine, SINES);
    g->w = glint_zone_compute_node(wave, GLINT_VISIBLE_WAVES);
}

/* Traces a grid of rays at one angle and wavelength. In the finest grid only
 * every third ray far outside the visible region is stored. */
static void trace_pupil_grid(const struct glint_zone *zone,
                             const struct glint_visible *visible, int sine,
                             int wave, int stride, struct glint_zone_rays *rays)
{
    const int most = GLINT_ZONE_RAYS / (4 * SINES);
    const int full = rays->n + most, full_invalid = rays->n_invalid + most;
    struct glint_zone_batch t;
    struct pupil_grid g;
    struct beside beside;

    set_pupil_grid(zone, visible->wide, sine, wave, stride, &g);
    for (int at = 0; at < g.columns * g.rows; at += t.n) {
        for (t.n = 0;
             t.n < GLINT_ZONE_BATCH && at + t.n < g.columns * g.rows;) {
            const int k = at + t.n;
            const double x[GLINT_VARIABLES] = {g.u[k % g.columns],
                                               g.v[k / g.columns], g.s, g.w};

            glint_zone_batch_add_ray(&t, zone, x);
        }
        trace_neighbour_zoom_positions(visible, wave, &t, &beside);
        t.path = &visible->path[wave];
        glint_zone_batch_trace_rays(&t, rays->n_barrels > 0);
        for (int i = 0; i < t.n && rays->n < full; i++) {
            const int k = at + i;

            if (t.status[i] != GLINT_RAY_OK) {
                if (rays->n_invalid < full_invalid)
                    append_invalid_ray(t.x[i], rays);
                continue;
            }
            append_zone_ray(visible, t.path, t.x[i], &t.ray[i],
                            glint_zone_batch_get_hits(&t, i), rays);
            replace_by_nearer_zoom_position(&beside, i, rays);
            if (stride == 1 && (k % g.columns + k / g.columns) % 3 &&
                fmax(rays->at[RAY_EXCESS][rays->n - 1],
                     rays->at[RAY_FIELD][rays->n - 1]) > 1.1)
                rays->n--;
        }
    }
}

static int count_visible_rays(const struct glint_zone_rays *rays)
{
    int n = 0;

    for (int i = 0; i < rays->n; i++)
        n += glint_zone_rays_is_visible(rays, i);
    return n;
}

/* Traces rays for fitting positions. Positions vary slowly with the wavelength,
 * so four wavelengths per angle are enough, different ones at consecutive
 * angles. Uses a coarse grid, and a fine one if few rays pass. */
static void trace_rays_for_positions(const struct glint_zone *zone,
                                     const struct glint_visible *visible,
                                     struct glint_zone_rays *rays)
{
    static const int shift[] = {0, 3, 5, 8};

    for (int stride = 2; stride > 0; stride--) {
        rays->n = rays->n_invalid = 0;
        for (int k = 0; k < 4 * SINES; k++)
            trace_pupil_grid(zone, visible, k / 4,
                             (k / 4 + shift[k % 4]) % GLINT_VISIBLE_WAVES,
                             stride, rays);
        if (count_visible_rays(rays) > 500)
            break;
    }
}

/* distance in u or v between a ray and its neighbours */
#define ASIDE 0.01

/* Adds the ray at zone coordinates X to batch T. THREE: also adds a neighbour
 * in v before it and a neighbour in u after it. */
static void add_ray_with_neighbours(struct glint_zone_batch *t,
                                    const struct glint_zone *zone,
                                    double x[GLINT_VARIABLES], bool three)
{
    const double v = x[1];

    if (three) {
        x[1] = v + (v < 0.5 ? ASIDE : -ASIDE);
        glint_zone_batch_add_ray(t, zone, x);
        x[1] = v;
    }
    glint_zone_batch_add_ray(t, zone, x);
    if (three) {
        x[0] += x[0] < 0 ? ASIDE : -ASIDE;
        glint_zone_batch_add_ray(t, zone, x);
    }
}

/* Adds the middle ray of each group of three in T to RAYS, with RAY_SPREAD
 * computed from its two neighbours. */
static void append_middle_rays(const struct glint_visible *visible,
                               struct glint_zone_batch *t,
                               struct glint_zone_rays *rays)
{
    for (int i = 1; i < t->n; i += 3) {
        const struct glint_ray *const a = &t->ray[i - 1], *const b = &t->ray[i];
        const struct glint_ray *const c = &t->ray[i + 1];

        if (t->status[i] != GLINT_RAY_OK)
            continue;
        append_zone_ray(visible, t->path, t->x[i], b,
                        glint_zone_batch_get_hits(t, i), rays);
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

/* Traces the rays of a skew zone for fitting positions and energies: a few rays
 * for each of many light directions and wavelengths. The directions fill the
 * zone up to its borders. */
static void trace_scattered_rays(const struct glint_zone *zone,
                                 const struct glint_visible *visible,
                                 struct glint_zone_rays *rays)
{
    enum { PLANES = 132, RAYS = 24, AT_ONCE = RAYS / 3 };
    struct glint_zone_batch t;

    rays->n = rays->n_invalid = 0;
    for (int k = 0; k < PLANES * RAYS / AT_ONCE; k++) {
        const int wave = k / 3 % GLINT_VISIBLE_WAVES;
        double plane[GLINT_VARIABLES], x[GLINT_VARIABLES];

        glint_zone_set_scattered_point(zone, k / 3, plane);
        t.path = &visible->path[wave];
        t.n = 0;
        for (int n = 0; n < AT_ONCE; n++) {
            glint_zone_set_scattered_point(zone, k * AT_ONCE + n, x);
            for (int i = 0; i < GLINT_VARIABLES; i++)
                x[i] = sin(0.5 * GLINT_PI * (i < GLINT_S ? x[i] : plane[i]));
            x[GLINT_W] = glint_zone_compute_node(wave, GLINT_VISIBLE_WAVES);
            add_ray_with_neighbours(&t, zone, x, true);
        }
        glint_zone_batch_trace_rays(&t, rays->n_barrels > 0);
        append_middle_rays(visible, &t, rays);
    }
}

bool glint_zone_rays_are_all_blocked(const struct glint_zone_rays *rays)
{
    for (int i = 0; i < rays->n; i++)
        if (glint_zone_rays_is_visible(rays, i))
            return false;
    return true;
}

double glint_zone_rays_compute_energy_ratio(const struct glint_zone_rays *rays)
{
    double least = HUGE_VAL, most = 0, spread = 1;

    for (int i = 0; i < rays->n; i++) {
        if (i == 0 || !glint_zone_rays_have_same_light(rays, i, i - 1)) {
            least = HUGE_VAL;
            most = 0;
        }
        if (!glint_zone_rays_is_visible(rays, i))
            continue;
        least = fmin(least, rays->at[RAY_ENERGY][i]);
        most = fmax(most, rays->at[RAY_ENERGY][i]);
        spread = fmax(spread, most / least);
    }
    return spread;
}

void glint_zone_trace_rays(const struct glint_zone *zone,
                           const struct glint_visible *visible,
                           struct glint_zone_rays *rays)
{
    rays->scattered = zone->skew;
    if (zone->skew)
        trace_scattered_rays(zone, visible, rays);
    else
        trace_rays_for_positions(zone, visible, rays);
}

void glint_zone_trace_energies(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               const struct glint_zone_rays *rays,
                               struct glint_zone_rays *energies)
{
    static const int shift[] = {0, 2, 4, 6, 9};
    const bool steep = glint_zone_rays_compute_energy_ratio(rays) > GLINT_STEEP;

    energies->n_barrels = energies->n = energies->n_invalid = 0;
    energies->scattered = false;
    for (int k = 0; k < SINES * GLINT_VISIBLE_WAVES && !steep; k++)
        trace_pupil_grid(zone, visible, k / GLINT_VISIBLE_WAVES,
                         k % GLINT_VISIBLE_WAVES, 4, energies);
    for (int k = 0; k < 5 * SINES && steep; k++)
        trace_pupil_grid(zone, visible, k / 5,
                         (k / 5 + shift[k % 5]) % GLINT_VISIBLE_WAVES, 2,
                         energies);
}

/* Adds the rays of T to RAYS in groups of N consecutive ones. Skips groups with
 * a ray that is not traced to the sensor. */
static void append_ray_groups(const struct glint_visible *visible,
                              struct glint_zone_batch *t, int n,
                              struct glint_zone_rays *rays)
{
    for (int i = 0; i < t->n; i += n) {
        bool all = true;

        for (int k = 0; k < n; k++)
            all &= t->status[i + k] == GLINT_RAY_OK;
        for (int k = i; k < i + n && all; k++)
            append_zone_ray(visible, t->path, t->x[k], &t->ray[k],
                            glint_zone_batch_get_hits(t, k), rays);
    }
}

void glint_zone_trace_check_rays(const struct glint_zone *zone,
                                 const struct glint_visible *visible,
                                 struct glint_zone_rays *rays)
{
    enum { BUNDLES = 24, RAYS = 16, IN_THREES = 10 };
    const int group =
        glint_zone_is_weighted_by_brightness(zone, visible) ? 3 : 1;
    const int places = group == 3 ? IN_THREES : RAYS;
    double x[GLINT_VARIABLES], bundle[GLINT_VARIABLES];
    struct glint_path path;
    struct glint_zone_batch t;

    t.path = &path;
    rays->n = rays->n_barrels = 0;
    for (int k = 0; k < BUNDLES; k++) {
        glint_zone_set_scattered_point(zone, k, bundle);
        glint_visible_init_path(visible, bundle[3], &path);
        path.places_only = group == 1;
        t.n = 0;
        for (int i = 0; i < places; i++) {
            glint_zone_set_scattered_point(zone, k * RAYS + i, x);
            x[GLINT_S] = bundle[GLINT_S];
            x[GLINT_W] = bundle[GLINT_W];
            x[GLINT_P] = bundle[GLINT_P];
            add_ray_with_neighbours(&t, zone, x, group == 3);
        }
        glint_zone_batch_trace_rays(&t, false);
        if (zone->skew)
            append_middle_rays(visible, &t, rays);
        else
            append_ray_groups(visible, &t, group, rays);
    }
}

/* ------------------------------------------------------------------ barrels */

/* The following functions choose the barrels that get polynomials in a zone,
 * such that no ray that passes all of them is far outside any other barrel. */

/* Min width of the range of relative radii at a barrel. If the radii span less,
 * distances outside the barrel are scaled up as if they spanned this much.
 * Where light grazes a hemispherical surface of a fisheye, the whole ghost lies
 * within 0.003 of the rim. */
#define LEAST_RANGE 0.1

/* relative radius stored for a ray that misses a surface */
#define MISS 1.3

/* sample rays, with the relative radius of each ray at each event */
struct sampling {
    int n, n_events;
    /* true: the ray misses a surface, so its position in the stop is unknown */
    bool missed[GLINT_SAMPLING_RAYS];
    double (*radius)[GLINT_MAX_EVENTS + 1];
    /* how far each ray lies outside the barrel that it exceeds most: its
     * relative radius - 1, weighted, at most 0.3 */
    double excess[GLINT_SAMPLING_RAYS];
    /* [events]: range of the relative radii of rays that pass the stop and hit
     * the field */
    double low[GLINT_MAX_EVENTS + 1], high[GLINT_MAX_EVENTS + 1];
    /* [events]: factor on distances outside the barrel */
    double factor[GLINT_MAX_EVENTS + 1];
};

/* Returns whether HIT is the mark (-1, -1) of an event that the ray does not
 * reach. */
static bool is_event_unreached(const double hit[2])
{
    return hit[0] == -1 && hit[1] == -1;
}

/* If the ray misses a surface, sets its relative radius at the first event
 * without a hit to MISS and returns MISS; else returns 0. */
static double mark_missed_surface(double *radius, double (*hits)[2],
                                  int n_events)
{
    int k = 0;

    while (k < n_events && !is_event_unreached(hits[k]))
        k++;
    if (k < n_events)
        radius[k] = MISS;
    return k < n_events ? MISS : 0;
}

/* Extends the radius ranges of S by the relative radii RADIUS of one ray. */
static void extend_radius_ranges(struct sampling *s, const double *radius)
{
    for (int k = 0; k < s->n_events; k++) {
        s->low[k] = radius[k] < s->low[k] ? radius[k] : s->low[k];
        s->high[k] = radius[k] > s->high[k] ? radius[k] : s->high[k];
    }
}

/* Stores the relative radius of a ray at every event. Returns whether the ray
 * is useful: inside the stop and the field, and outside at least one barrel. */
static bool sample_barrel_radii(const struct glint_visible *h,
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
        const double x = hits[k][0], y = hits[k][1];

        radius[k] = e->kind == GLINT_STOP || is_event_unreached(hits[k])
                        ? 0
                        : sqrt(x * x + y * y) / e->semi_mm;
        most = radius[k] > most ? radius[k] : most;
    }
    sampling->missed[sampling->n] = status != GLINT_RAY_OK;
    if (status == GLINT_RAY_MISSED && h->far)
        most = fmax(most, mark_missed_surface(radius, hits, path->n_events));
    if (status != GLINT_RAY_OK)
        return most > 1;
    if (hypot(ray->stop_x_mm, ray->stop_y_mm) >= 1.02 * stop ||
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) >= h->field_mm)
        return false;
    extend_radius_ranges(sampling, radius);
    return most > 1;
}

static void set_ray_excesses(struct sampling *s)
{
    for (int i = 0; i < s->n; i++) {
        double most = 0;

        for (int k = 0; k < s->n_events; k++) {
            const double out = s->factor[k] * (s->radius[i][k] - 1);

            most = out > most ? out : most;
        }
        s->excess[i] = fmin(most, 0.3);
    }
}

/* Samples rays at scattered angles, as a barrel may block rays in a narrow
 * range of angles only. */
static void sample_zone_rays(const struct glint_zone *z,
                             const struct glint_visible *visible,
                             struct sampling *sampling)
{
    /* fewer rays for skew zones, which are numerous, and for non-spherical
     * surfaces, through which rays are slow to trace */
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
            glint_visible_get_member(visible, k % members);
        const int wave =
            glint_visible_colour[k / members % GLINT_VISIBLE_COLOURS];
        double x[GLINT_VARIABLES];

        t.path = &h->position_path[wave];
        for (t.n = 0; t.n < GLINT_ZONE_BATCH;) {
            glint_zone_set_scattered_point(z, k * GLINT_ZONE_BATCH + t.n, x);
            x[3] = glint_zone_compute_node(wave, GLINT_VISIBLE_WAVES);
            glint_zone_batch_add_ray(&t, z, x);
        }
        glint_zone_batch_trace_rays(&t, true);
        for (int i = 0; i < GLINT_ZONE_BATCH; i++)
            sampling->n +=
                sample_barrel_radii(h, t.path, t.status[i], &t.ray[i],
                                    glint_zone_batch_get_hits(&t, i), sampling);
    }
    for (int k = 0; k < sampling->n_events; k++) {
        const double range = sampling->high[k] - sampling->low[k];

        sampling->factor[k] = visible->far && range > 0 && range < LEAST_RANGE
                                  ? LEAST_RANGE / range
                                  : 1;
    }
    set_ray_excesses(sampling);
}

/* rays that no chosen barrel blocks */
struct open_rays {
    int n, ray[GLINT_SAMPLING_RAYS];
};

/* Returns the sum of the excesses of the rays O that barrel BARREL does not
 * block. */
static double sum_unblocked_excesses(const struct sampling *s,
                                     const struct open_rays *o, int barrel)
{
    double sum = 0;

    for (int i = 0; i < o->n; i++)
        if (!(s->radius[o->ray[i]][barrel] > 1))
            sum += s->excess[o->ray[i]];
    return sum;
}

/* Removes the rays that barrel BARREL blocks from O. */
static void remove_blocked_rays(const struct sampling *s, int barrel,
                                struct open_rays *o)
{
    int kept = 0;

    for (int i = 0; i < o->n; i++)
        if (!(s->radius[o->ray[i]][barrel] > 1))
            o->ray[kept++] = o->ray[i];
    o->n = kept;
}

static double find_max_excess(const struct sampling *s,
                              const struct open_rays *o)
{
    double most = 0;

    for (int i = 0; i < o->n; i++)
        most = fmax(most, s->excess[o->ray[i]]);
    return most;
}

/* Adds barrels to the list of RAYS, each time the one after which the sum of
 * excesses of unblocked rays is smallest, until none of these exceeds SHOWS.
 * MISSED: also considers rays that miss a surface. */
static void choose_fitted_barrels(const struct sampling *s, bool missed,
                                  double shows, struct glint_zone_rays *rays)
{
    struct open_rays open = {.n = 0};

    for (int i = 0; i < s->n; i++)
        if (missed || !s->missed[i])
            open.ray[open.n++] = i;
    for (int k = 0; k < rays->n_barrels; k++)
        remove_blocked_rays(s, rays->barrel[k], &open);
    while (find_max_excess(s, &open) > shows &&
           rays->n_barrels < GLINT_MAX_BARRELS) {
        double least = HUGE_VAL;
        int best = 0;

        for (int k = 0; k < s->n_events; k++) {
            const double sum = sum_unblocked_excesses(s, &open, k);

            if (sum < least) {
                least = sum;
                best = k;
            }
        }
        rays->barrel[rays->n_barrels++] = best;
        remove_blocked_rays(s, best, &open);
    }
    rays->missed_cut = find_max_excess(s, &open);
}

void glint_zone_choose_barrels(const struct glint_zone *zone,
                               const struct glint_visible *visible,
                               double shows, glint_zone_sampling *sampling,
                               struct glint_zone_rays *rays)
{
    struct sampling s = {.radius = *sampling};

    sample_zone_rays(zone, visible, &s);
    rays->n_barrels = 0;
    if (visible->far)
        choose_fitted_barrels(&s, false, shows, rays);
    choose_fitted_barrels(&s, true, shows, rays);
}
