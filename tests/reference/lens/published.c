/* SPDX-License-Identifier: MIT */
#include "reference/lens/published.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/setup/degrees.h"
#include "bake/visible/visible.h"
#include "reference/lens/shared_basis.h"

enum {
    SEARCH_ZONES = 15, /* zones on which the basis is searched for */
    ACROSS = 24,       /* cells across a box, 288 in its upper half */
    DOWN = 12,
    /* Rays that must get through; else four times as many are traced. */
    ENOUGH = 60
};

/* Least range of sines; a narrower one would be a knot, not a system. */
#define LEAST_RANGE 1e-6

/* Errors, by kind, at which a fit counts as good. */
static const double tolerance[GLINT_SHARED_OUTPUTS] = {0.0002, 0.0002, 0.0002,
                                                       0.0002, 0.001,  0.0002};

/* The knots of one range of angles, shared by all wavelengths. */
struct knots {
    int n;
    double *sine;
    struct glint_pupil *box; /* box at the knot */
    /* Box at the knot joined with those of its neighbours. */
    struct glint_pupil *joint;
};

struct job {
    struct glint_visible visible;
    const struct glint_published_options *options;
    int n_ranges;
    struct knots knots[GLINT_MAX_RANGES];
    double radius_mm;
    int wave[GLINT_MAX_WAVELENGTHS]; /* indices of the wavelengths, by rising 1
                                        / wavelength^2 */
    struct glint_shared_rays *rays;  /* [SEARCH_ZONES] */
    struct glint_shared_zone *zone;  /* [SEARCH_ZONES] */
    struct glint_shared_basis basis[GLINT_SHARED_OUTPUTS];
};

void glint_published_defaults(struct glint_published_options *options,
                              const struct glint_setup *setup)
{
    const struct glint_prescription *lens = setup->lens;

    *options = (struct glint_published_options){
        .n_zones = 241,
        .max_deg = 60,
        .max_terms = lens->n_surfaces <= 20 ? 5 : 10,
        .wavelength_nm = setup->wavelength_nm,
        .n_wavelengths = setup->n_wavelengths,
        .field_mm = 0.5 * hypot(lens->film_width_mm, lens->film_height_mm)};
}

static bool options_are_good(const struct glint_published_options *o)
{
    bool good = o->n_zones >= 2 && o->max_deg > 0 && o->max_deg <= 89 &&
                o->max_terms >= 1 && o->max_terms <= GLINT_SHARED_TERMS &&
                o->n_wavelengths >= 1 &&
                o->n_wavelengths <= GLINT_MAX_WAVELENGTHS && o->field_mm > 0;

    for (int k = 0; good && k < o->n_wavelengths; k++) {
        good = o->wavelength_nm[k] > 0;
        for (int i = 0; i < k; i++)
            good &= o->wavelength_nm[i] != o->wavelength_nm[k];
    }
    return good;
}

/* Sorts the wavelengths, the longest first. */
static void sort_waves(struct job *job)
{
    const double *nm = job->options->wavelength_nm;

    for (int k = 0; k < job->options->n_wavelengths; k++) {
        int at = k;

        for (; at > 0 && nm[job->wave[at - 1]] < nm[k]; at--)
            job->wave[at] = job->wave[at - 1];
        job->wave[at] = k;
    }
}

static double wavelength(const struct job *job, int rank)
{
    return job->options->wavelength_nm[job->wave[rank]];
}

/* -------------------------------------------------------------------- knots */

static double mix(double a, double b, double part)
{
    return a + (b - a) * part;
}

/* Returns the box at SINE, interpolated between those of the profile. */
static struct glint_pupil box_at(const struct glint_visible_profile *p,
                                 double sine)
{
    struct glint_pupil box = p->box[0];
    int k = 0;

    while (k + 2 < p->n && p->sine[k + 1] <= sine)
        k++;
    if (p->n > 1) {
        const double part = fmin(
            fmax((sine - p->sine[k]) / (p->sine[k + 1] - p->sine[k]), 0), 1);

        box.x0_mm = mix(p->box[k].x0_mm, p->box[k + 1].x0_mm, part);
        box.x1_mm = mix(p->box[k].x1_mm, p->box[k + 1].x1_mm, part);
        box.y1_mm = mix(p->box[k].y1_mm, p->box[k + 1].y1_mm, part);
    }
    return box;
}

/* Places knots at both ends of RANGE and at the equidistant angles between them
 * that do not almost coincide with an end. Returns how many. */
static int place_knots(const struct glint_published_options *o,
                       const double range[2], double *sine)
{
    int n = 0;

    sine[n++] = range[0];
    for (int k = 0; k < o->n_zones; k++) {
        const double here = glint_sin_deg(o->max_deg * k / (o->n_zones - 1));
        const double next =
            glint_sin_deg(o->max_deg * (k + 1) / (o->n_zones - 1));
        const double margin = 0.05 * fabs(next - here);

        if (here > range[0] + margin && here < range[1] - margin)
            sine[n++] = here;
    }
    sine[n++] = range[1];
    return n;
}

static enum glint_status set_knots(struct job *job, const double range[2])
{
    struct knots *k = &job->knots[job->n_ranges];
    const size_t most = (size_t)job->options->n_zones + 2;
    struct glint_visible_profile profile;

    if (range[1] < range[0] + LEAST_RANGE)
        return GLINT_OK;
    glint_visible_profile_find(&job->visible, range, &profile);
    if (profile.n == 0)
        return GLINT_OK;
    job->n_ranges++;
    k->sine = malloc(most * sizeof *k->sine);
    k->box = malloc(most * sizeof *k->box);
    k->joint = malloc(most * sizeof *k->joint);
    if (!k->sine || !k->box || !k->joint)
        return GLINT_E_MEMORY;
    k->n = place_knots(job->options, range, k->sine);
    for (int i = 0; i < k->n; i++)
        k->box[i] = box_at(&profile, k->sine[i]);
    for (int i = 0; i < k->n; i++) {
        const struct glint_pupil *b = &k->joint[i];

        k->joint[i] = k->box[i];
        if (i > 0)
            glint_visible_join(&k->joint[i], &k->box[i - 1]);
        if (i < k->n - 1)
            glint_visible_join(&k->joint[i], &k->box[i + 1]);
        job->radius_mm =
            fmax(job->radius_mm,
                 hypot(fmax(fabs(b->x0_mm), fabs(b->x1_mm)), b->y1_mm));
    }
    return GLINT_OK;
}

static enum glint_status find_knots(struct job *job)
{
    double range[GLINT_MAX_RANGES][2];
    enum glint_status status = GLINT_OK;
    const int n =
        glint_visible_ranges(&job->visible, job->options->max_deg, range);

    for (int k = 0; k < n && status == GLINT_OK; k++)
        status = set_knots(job, range[k]);
    /* With a power of two the integers of a box, scaled to 2^30 at this radius,
     * need no rounding. */
    job->radius_mm = job->n_ranges ? exp2(ceil(log2(job->radius_mm))) : 0;
    return status;
}

/* --------------------------------------------------------------------- rays */

struct zone_trace {
    const struct job *job;
    const struct glint_path *path;
    const struct glint_pupil *box;
    double direction[3];
};

/* Traces the ray at (I, J), 0 .. 1, of the box into entry RAYS->n. */
static void trace_ray(const struct zone_trace *t, double i, double j,
                      struct glint_shared_rays *rays)
{
    const struct glint_visible *h = &t->job->visible;
    const double stop = h->setup->optics.stop_radius_mm;
    const double px = mix(t->box->x0_mm, t->box->x1_mm, i);
    const double py = t->box->y1_mm * j;
    const double radius = hypot(px, py) / t->job->radius_mm;
    const int at = rays->n;
    struct glint_ray ray = {0, 0, 0, 0, 0, 0};

    rays->x[0][at] = px / t->job->radius_mm;
    rays->x[1][at] = py / t->job->radius_mm;
    rays->x[2][at] = radius;
    rays->x[3][at] = 1 - radius;
    rays->lost[at] =
        glint_trace(t->path, px, py, t->direction, &ray, NULL) != GLINT_RAY_OK;
    rays->at[GLINT_OUT_SENSOR_X][at] = ray.sensor_x_mm;
    rays->at[GLINT_OUT_SENSOR_Y][at] = ray.sensor_y_mm;
    rays->at[GLINT_OUT_STOP_X][at] = ray.stop_x_mm / stop;
    rays->at[GLINT_OUT_STOP_Y][at] = ray.stop_y_mm / stop;
    rays->at[GLINT_OUT_ENERGY][at] = ray.energy;
    rays->at[GLINT_OUT_RADIUS][at] = ray.rel_radius;
    rays->excess[at] =
        fmax(ray.rel_radius,
             fmax(hypot(ray.stop_x_mm, ray.stop_y_mm) / stop,
                  hypot(ray.sensor_x_mm, ray.sensor_y_mm) / h->field_mm));
}

/* Traces rays at the middles of SCALE^2 * ACROSS * DOWN cells. If SCALE is
 * above 1, most rays far outside what is seen are left out. Returns how many
 * get through. */
static int trace_grid(const struct zone_trace *t, int scale,
                      struct glint_shared_rays *rays)
{
    const int across = scale * ACROSS, down = scale * DOWN;
    int seen = 0;

    rays->n = 0;
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across && rays->n < GLINT_SHARED_RAYS; i++) {
            const int at = rays->n;
            bool near;

            trace_ray(t, (i + 0.5) / across, (j + 0.5) / down, rays);
            near = !rays->lost[at] && rays->excess[at] <= 1.1;
            seen += near && rays->excess[at] <= 1;
            rays->n += near || (i % scale == 0 && j % (2 * scale - 1) == 0);
        }
    return seen;
}

static void trace_zone(const struct job *job, const struct glint_path *path,
                       const struct knots *knots, int knot,
                       struct glint_shared_rays *rays)
{
    const double sine = knots->sine[knot];
    const struct zone_trace t = {
        job, path, &knots->joint[knot], {sine, 0, sqrt(1 - sine * sine)}};

    if (trace_grid(&t, 1, rays) < ENOUGH)
        trace_grid(&t, 2, rays);
}

/* ------------------------------------------------------------------- search */

/* Traces rays of zones spread over all knots, each of another wavelength in
 * turn. Returns how many zones. */
static int trace_some(struct job *job)
{
    const int waves = job->options->n_wavelengths;
    int knots = 0, n, range = 0, before = 0;

    for (int k = 0; k < job->n_ranges; k++)
        knots += job->knots[k].n;
    n = knots * waves < SEARCH_ZONES ? knots * waves : SEARCH_ZONES;
    for (int k = 0; k < n; k++) {
        const int knot = (2 * k + 1) * knots / (2 * n);
        struct glint_path path;

        while (knot - before >= job->knots[range].n)
            before += job->knots[range++].n;
        glint_path_init(&path, job->visible.setup->lens,
                        &job->visible.setup->ghost[job->visible.ghost],
                        wavelength(job, k % waves));
        trace_zone(job, &path, &job->knots[range], knot - before,
                   &job->rays[k]);
    }
    return n;
}

static void find_bases(struct job *job)
{
    const int n = trace_some(job);

    for (int kind = 0; kind < GLINT_SHARED_OUTPUTS; kind++)
        glint_shared_search(job->zone, job->rays, n, (enum glint_channel)kind,
                            job->options->max_terms, tolerance[kind],
                            &job->basis[kind]);
}

/* ------------------------------------------------------------------ systems */

static bool init_output(const struct job *job, int kind, int n_knots,
                        struct glint_fitted_output *o)
{
    const struct glint_shared_basis *basis = &job->basis[kind];

    o->kind = (enum glint_channel)kind;
    o->n_terms = basis->n;
    memcpy(o->power, basis->power, sizeof basis->power);
    o->coef = malloc((size_t)n_knots * (size_t)basis->n * sizeof *o->coef);
    return o->coef != NULL;
}

static bool init_system(const struct job *job, const struct knots *knots,
                        double nm, struct glint_published_system *s)
{
    bool good;

    *s = (struct glint_published_system){
        .ghost = job->visible.ghost,
        .sine_lo = knots->sine[0],
        .sine_hi = knots->sine[knots->n - 1],
        .wave_lo = 1e6 / (nm * nm),
        .wave_hi = 1e6 / (nm * nm),
        .n_knots = knots->n,
        .knot = malloc((size_t)knots->n * sizeof *s->knot),
        .box = malloc((size_t)knots->n * 3 * sizeof *s->box),
        .radius_mm = job->radius_mm,
        .n_outputs = GLINT_SHARED_OUTPUTS};
    good = s->knot && s->box;
    for (int kind = 0; kind < GLINT_SHARED_OUTPUTS; kind++)
        good &= init_output(job, kind, knots->n, &s->output[kind]);
    for (int k = 0; good && k < knots->n; k++) {
        const struct glint_pupil *b = &knots->box[k];

        s->knot[k] = knots->sine[k];
        s->box[3 * k] = 0.5 * (b->x0_mm + b->x1_mm);
        s->box[3 * k + 1] = 0.5 * (b->x1_mm - b->x0_mm);
        s->box[3 * k + 2] = b->y1_mm;
    }
    return good;
}

/* Fits the coefficients at all knots. */
static void fit_system(struct job *job, const struct knots *knots, double nm,
                       struct glint_published_system *s)
{
    double sum[GLINT_SHARED_OUTPUTS] = {0};
    struct glint_path path;
    int n = 0;

    glint_path_init(&path, job->visible.setup->lens,
                    &job->visible.setup->ghost[job->visible.ghost], nm);
    for (int k = 0; k < knots->n; k++) {
        double square = 0;

        trace_zone(job, &path, knots, k, &job->rays[0]);
        for (int kind = 0; kind < GLINT_SHARED_OUTPUTS; kind++) {
            square = glint_shared_solve(
                job->zone, &job->rays[0], (enum glint_channel)kind,
                &job->basis[kind], tolerance[kind],
                s->output[kind].coef + (ptrdiff_t)k * job->basis[kind].n);
            sum[kind] += fmax(square, 0);
        }
        n += square >= 0;
    }
    s->met = true;
    for (int kind = 0; kind < GLINT_SHARED_OUTPUTS; kind++) {
        s->output[kind].met =
            sum[kind] <= n * tolerance[kind] * tolerance[kind];
        s->met &= s->output[kind].met;
    }
}

static enum glint_status fit_all(struct job *job,
                                 struct glint_published_ghost *out)
{
    const int waves = job->options->n_wavelengths;

    out->system = malloc((size_t)(waves * job->n_ranges) * sizeof *out->system);
    if (!out->system)
        return GLINT_E_MEMORY;
    for (int w = 0; w < waves; w++)
        for (int k = 0; k < job->n_ranges; k++) {
            struct glint_published_system *s = &out->system[out->n_systems++];
            const double nm = wavelength(job, w);

            if (!init_system(job, &job->knots[k], nm, s))
                return GLINT_E_MEMORY;
            fit_system(job, &job->knots[k], nm, s);
        }
    return GLINT_OK;
}

static enum glint_status run(struct job *job, struct glint_published_ghost *out)
{
    const enum glint_status status = find_knots(job);

    if (status != GLINT_OK || job->n_ranges == 0)
        return status;
    job->rays = malloc(SEARCH_ZONES * sizeof *job->rays);
    job->zone = malloc(SEARCH_ZONES * sizeof *job->zone);
    if (!job->rays || !job->zone)
        return GLINT_E_MEMORY;
    find_bases(job);
    return fit_all(job, out);
}

void glint_published_finish(struct glint_published_ghost *ghost)
{
    for (int k = 0; k < ghost->n_systems; k++) {
        struct glint_published_system *s = &ghost->system[k];

        for (int i = 0; i < s->n_outputs; i++)
            free(s->output[i].coef);
        free(s->knot);
        free(s->box);
    }
    free(ghost->system);
    *ghost = (struct glint_published_ghost){.n_systems = 0};
}

enum glint_status
glint_published_fit(const struct glint_setup *setup, int ghost,
                    const struct glint_published_options *options,
                    struct glint_published_ghost *out)
{
    struct job job = {.options = options};
    enum glint_status status;
    double band_nm[2];

    *out = (struct glint_published_ghost){.n_systems = 0};
    if (ghost < 0 || ghost >= setup->n_ghosts || !options_are_good(options))
        return GLINT_E_ARGUMENT;
    sort_waves(&job);
    band_nm[0] = wavelength(&job, options->n_wavelengths - 1);
    band_nm[1] = wavelength(&job, 0);
    glint_visible_init(&job.visible, setup, ghost, options->field_mm, band_nm);
    status = run(&job, out);
    for (int k = 0; k < job.n_ranges; k++) {
        free(job.knots[k].sine);
        free(job.knots[k].box);
        free(job.knots[k].joint);
    }
    free(job.rays);
    free(job.zone); /* NOLINT: n_ranges counts a range before its memory */
    if (status != GLINT_OK)
        glint_published_finish(out);
    return status;
}
