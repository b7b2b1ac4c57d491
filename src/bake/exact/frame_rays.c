/* SPDX-License-Identifier: MIT
 *
 * Draws a frame with exactly traced rays instead of a model (--rays exact).
 *
 * Light points are lamps, and the sample points of area lamps. Points in
 * similar directions are grouped into patches. Each ghost has one ray field per
 * patch (ray_field.h). A ray field traces a few rays and interpolates all
 * others. The number of wavelengths of a field depends on how far its colours
 * separate on the sensor. Fields too faint for any pixel are skipped. The flare
 * rasteriser requests vertices row by row, which are interpolated from the
 * field.
 *
 * Memory is bounded. A field whose rays do not fit into memory is traced again
 * on each use. A picture whose edges do not fit is drawn in bands of rows.
 * Neither changes the result. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/exact/ray_field.h"
#include "engine/frame/block.h"
#include "engine/frame/frame_parts.h"
#include "engine/setup/degrees.h"

/* max number of bundles per frame; a bundle is one ghost, light point and
 * wavelength */
enum { MAX_BUNDLES = 1 << 20 };

/* max bytes for traced rays, and max bytes for edges; a frame may have a lower
 * limit */
#define MOST_BYTES ((size_t)128 << 20)

/* max width of a patch, degrees; interpolated positions are then wrong by less
 * than 0.1 pixel */
#define SPAN_DEG 1.0

/* distance of the outermost sample point of an area lamp from its centre / the
 * lamp's major semi-axis, approximate */
#define REACH 2.2

/* PARTS: max number of progress reports while jobs run. LEAST_PART: min number
 * of jobs between two reports. */
enum { PARTS = 100, LEAST_PART = 4 };

/* Initial capacity per bundle: number of edges, and number of references to
 * edges from tiles. Enough for most frames. */
#define EDGES 128.0

/* Progress of a frame, 0 .. 1: TRACED when all rays are traced. Measuring the
 * ghosts raises it from 0 to GLINT_FRAME_FOUND. If an earlier frame has
 * measured some of the ghosts, it is raised from there to MEASURED_MORE
 * instead. */
#define MEASURED_MORE 0.65
#define TRACED        0.85

/* A light point: a lamp, a sample point of an area lamp, or the sum of several
 * nearby points. Points form levels of detail. Each level has about half as
 * many points as the level before, and faint ghosts are drawn from a higher
 * level. */
enum { LEVELS = 8 };
/* CELL_CODES: RMS difference, 8-bit codes, of neighbouring cells from which the
 * grid of a ghost is refined; CELL_PIXELS: mean size, pixels, of cells that are
 * not refined any more. With these the worst lens of the library,
 * telecentric-laikin-100 at f/2.8, has 57 dB instead of 43. */
#define CELL_CODES  0.5
#define CELL_PIXELS 8.0
struct point {
    struct glint_lamp lamp;
    double at[2];
    /* radius around at that contains the lamps that the point represents, in
     * the unit of at */
    double reach;
    int patch;
    int light;       /* index of the light, of a sum: of the brighter one */
    int first, last; /* the point belongs to the levels first .. last */
};

/* A set of wavelengths that samples the spectrum. */
struct wave_set {
    int n;
    double nm[GLINT_MAX_WAVELENGTHS];
    const double *rgb[GLINT_MAX_WAVELENGTHS];
    double unit_flux[GLINT_MAX_WAVELENGTHS];
};

/* One bundle: the rays of one ray field for one light point and one
 * wavelength. */
struct ray_bundle {
    int field, point, wave;
    /* range of pixel rows that the bundle covers; low > high: unknown */
    float low, high;
};

/* The bundle that a worker is drawing, and the worker's memory for rays. */
struct ray_worker {
    struct ray_place place;
    struct ray_bundle *bundle;
    float low, high;
    int in_mem; /* index of the field whose rays are in mem; -1: none */
    /* memory for the rays of a field that is traced again on each use; large
     * enough for the largest */
    void *mem;
};

struct traced {
    struct ray_field_config cfg;
    struct wave_set set[GLINT_MAX_WAVE_SETS];
    int n_sets;
    struct point *point;
    struct ray_patch *patch;
    /* [patches][n_ghosts of the setup]: fields measured for complete patches,
     * which later frames may reuse */
    struct ray_field *measured;
    /* [fields]: fields of this frame, with their grids */
    struct ray_field *field;
    /* [fields]: index of the field's set of wavelengths; -1: the field is
     * skipped */
    int *set_of;
    /* [fields]: traced rays of the field; NULL: the field is traced on each
     * use */
    void **mem;
    struct ray_bundle *bundle;
    struct ray_worker *worker;
    bool in_codes;
    /* [fields]: level of the light points with which the field is drawn */
    int *level;
    /* optics of the setup for which the fields were measured */
    struct glint_optics optics;
    int n_ghosts;
    int n_points, n_patches, n_fields, n_bundles, n_workers;
    double found; /* progress of the frame when the fields had been measured, 0
                     .. 1 */
    /* The part of the frame that is drawn: indices of a ghost and of a light;
     * -1: all. */
    struct {
        int ghost, light;
    } part;
    struct glint_flare_rays rays;
};

struct job {
    struct glint_frame *frame;
    int first; /* index of the first job of the group of jobs that runs */
};

static struct traced *get_traced_state(const struct glint_frame *f)
{
    return f->memory.traced;
}

/* Frees the arrays that depend on the current frame only. Points, patches and
 * measured fields remain. */
static void free_frame_plan(struct traced *t)
{
    for (int i = 0; i < t->n_fields && t->mem; i++)
        free(t->mem[i]);
    for (int i = 0; i < t->n_workers && t->worker; i++)
        free(t->worker[i].mem);
    free(t->set_of);
    free(t->level);
    free(t->mem);
    free(t->bundle);
    free(t->worker);
    t->set_of = NULL;
    t->level = NULL;
    t->mem = NULL;
    t->bundle = NULL;
    t->worker = NULL;
    t->n_bundles = t->n_workers = 0;
}

static void free_traced_arrays(struct traced *t)
{
    free_frame_plan(t);
    free(t->point);
    free(t->patch);
    free(t->measured);
    free(t->field);
    t->point = NULL;
    t->patch = NULL;
    t->measured = NULL;
    t->field = NULL;
    t->n_points = t->n_patches = t->n_fields = 0;
}

/* Runs N jobs in groups, and reports progress after each group. The progress
 * rises from FROM to TO, fractions of the frame's work. */
static void run_jobs_with_progress(struct glint_frame *f, int n,
                                   glint_job_fn *each, double from, double to)
{
    struct job job = {f, 0};
    const int part = f->progress ? max_int(n / PARTS, LEAST_PART) : n;

    for (job.first = 0; job.first < n; job.first += part) {
        glint_workers_run(f->cfg.workers, min_int(part, n - job.first), each,
                          &job);
        if (f->progress)
            f->progress(f->progress_ctx,
                        from + (to - from) * min_int(job.first + part, n) / n);
    }
}

/* -------------------------------------------------------------- wavelengths */

static void insert_wavelength(struct wave_set *set, double nm,
                              const double *rgb, double unit_flux)
{
    int i = set->n++;

    for (; i > 0 && set->nm[i - 1] > nm; i--) {
        set->nm[i] = set->nm[i - 1];
        set->rgb[i] = set->rgb[i - 1];
        set->unit_flux[i] = set->unit_flux[i - 1];
    }
    set->nm[i] = nm;
    set->rgb[i] = rgb;
    set->unit_flux[i] = unit_flux;
}

/* Copies the sets of wavelengths of setup S, sorted by wavelength. If S has
 * only one list of wavelengths, that list becomes the only set. */
static void set_wavelength_sets(struct traced *t, const struct glint_setup *s,
                                struct ray_field_config *cfg)
{
    const struct glint_set_wave *w = s->set_wave;
    const struct wave_set *widest;

    memset(t->set, 0, sizeof t->set);
    t->n_sets = max_int(s->n_sets, 1);
    for (int k = 0; k < s->n_sets; w += s->set_size[k++])
        for (int i = 0; i < s->set_size[k]; i++)
            insert_wavelength(&t->set[k], w[i].nm, w[i].rgb, w[i].unit_flux);
    for (int i = 0; i < s->n_wavelengths && s->n_sets == 0; i++)
        insert_wavelength(&t->set[0], s->wavelength_nm[i], s->rgb[i],
                          s->unit_flux[i]);
    widest = &t->set[t->n_sets - 1];
    cfg->wave_nm[0] = widest->nm[0];
    cfg->wave_nm[1] = widest->nm[widest->n / 2];
    cfg->wave_nm[2] = widest->nm[widest->n - 1];
}

static double compute_band_width(const struct wave_set *set)
{
    const double a = set->nm[0], b = set->nm[set->n - 1];

    return 1 / (a * a) - 1 / (b * b);
}

/* Returns the index of the smallest set of wavelengths for FIELD without
 * visible steps of colour. Steps are invisible if the brightness step between
 * wavelengths is below STEP, or if their images lie less than the pixel
 * distance of the quality parameter for dispersion apart. LIGHT: mean
 * brightness of the field from one light point, 1 = display white. Compare
 * wave_sets.c. */
static int choose_wavelength_set(const struct glint_frame *f,
                                 const struct ray_field *field, double light,
                                 double step)
{
    const struct traced *t = get_traced_state(f);
    const double apart =
                     field->apart_mm * f->view.width / f->view.sensor_width_mm,
                 most = f->dials.dispersion_q8 / 256.0;
    int k = 0;

    for (; k < t->n_sets - 1 && f->dials.dispersion_q8 > 0; k++)
        if (light / (2 * t->set[k].n) < step ||
            apart * compute_band_width(&t->set[k]) <=
                most * (t->set[k].n - 1) * compute_band_width(&t->set[0]))
            break;
    return k;
}

/* ------------------------------------------------------------------ patches */

static int compare_point_angles(const void *a, const void *b)
{
    const struct point *p = a, *q = b;

    return (p->at[0] > q->at[0]) - (p->at[0] < q->at[0]);
}

/* Sets the patch coordinates of point P relative to azimuth PHI_DEG. */
static void set_point_coordinates(const struct traced *t, struct point *p,
                                  double phi_deg)
{
    const double sine = glint_sin_deg(p->lamp.theta_deg);

    p->at[0] = t->cfg.round ? p->lamp.theta_deg
                            : sine * glint_cos_deg(p->lamp.phi_deg - phi_deg);
    p->at[1] =
        t->cfg.round ? 0 : sine * glint_sin_deg(p->lamp.phi_deg - phi_deg);
}

/* Extends the range LOW .. HIGH by point P, including its radius. */
static void extend_range_by_point(const struct point *p, double low[2],
                                  double high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k] = fmin(low[k], p->at[k] - p->reach);
        high[k] = fmax(high[k], p->at[k] + p->reach);
    }
}

/* Returns the patch of directions with the coordinates LOW .. HIGH relative to
 * azimuth PHI_DEG. */
static struct ray_patch make_direction_patch(const struct traced *t,
                                             double phi_deg,
                                             const double low[2],
                                             const double high[2])
{
    struct ray_patch p = {.phi_deg = phi_deg};

    for (int k = 0; k < (t->cfg.round ? 1 : 2); k++) {
        p.middle[k] = 0.5 * (low[k] + high[k]);
        p.half[k] = 0.5 * (high[k] - low[k]);
    }
    /* Either both half sizes are 0 or none is, so that the cross terms of the
     * interpolation are known. */
    if (!t->cfg.round && (p.half[0] > 0 || p.half[1] > 0))
        for (int k = 0; k < 2; k++)
            p.half[k] = fmax(p.half[k], 1e-4);
    return p;
}

/* Sets PATCH[N] to a patch that contains the points FIRST .. LAST - 1. */
static void add_patch_for_points(const struct traced *t, struct point *point,
                                 int first, int last, double phi_deg,
                                 struct ray_patch *patch, int n)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

    for (int i = first; i < last; i++) {
        extend_range_by_point(&point[i], low, high);
        point[i].patch = n;
    }
    patch[n] = make_direction_patch(t, phi_deg, low, high);
}

/* For rotationally symmetric lenses: sorts N points by angle off the axis and
 * groups them into patches. Appends the patches to the HAD patches in PATCH.
 * Returns the new number of patches. */
static int group_points_by_angle(const struct traced *t, struct point *point,
                                 int n, struct ray_patch *patch, int had)
{
    double low = 0, high = 0;
    int first = 0;

    for (int i = 0; i < n; i++)
        set_point_coordinates(t, &point[i], 0);
    qsort(point, (size_t)n, sizeof *point, compare_point_angles);
    for (int i = 0; i < n; i++) {
        const double from = point[i].at[0] - point[i].reach;
        const double to = point[i].at[0] + point[i].reach;

        if (i > first && fmax(high, to) - fmin(low, from) > SPAN_DEG) {
            add_patch_for_points(t, point, first, i, 0, patch, had++);
            first = i;
        }
        low = i > first ? fmin(low, from) : from;
        high = i > first ? fmax(high, to) : to;
    }
    if (n > 0)
        add_patch_for_points(t, point, first, n, 0, patch, had++);
    return had;
}

/* For lenses that are not rotationally symmetric: starts a patch at the first
 * point without a patch, adds all points close to it, and repeats this until
 * all N points have a patch. Appends the patches to the HAD patches in PATCH.
 * Returns the new number of patches. */
static int group_nearby_points(const struct traced *t, struct point *point,
                               int n, struct ray_patch *patch, int had)
{
    const double near = 0.5 * SPAN_DEG * GLINT_PI / 180;
    int last;

    for (int first = 0; first < n; first = last) {
        const double phi_deg = point[first].lamp.phi_deg;
        struct point *seed = &point[first];

        set_point_coordinates(t, seed, phi_deg);
        last = first + 1;
        for (int i = first + 1; i < n; i++) {
            struct point p = point[i];

            set_point_coordinates(t, &p, phi_deg);
            if (fabs(p.at[0] - seed->at[0]) + p.reach > near ||
                fabs(p.at[1] - seed->at[1]) + p.reach > near)
                continue;
            point[i] = point[last];
            point[last++] = p;
        }
        add_patch_for_points(t, point, first, last, phi_deg, patch, had++);
    }
    return had;
}

static int group_points_in_patches(const struct traced *t, struct point *point,
                                   int n, struct ray_patch *patch, int had)
{
    return t->cfg.round ? group_points_by_angle(t, point, n, patch, had)
                        : group_nearby_points(t, point, n, patch, had);
}

static bool is_point_in_patch(const struct ray_patch *patch,
                              const struct point *p)
{
    return fabs(p->at[0] - patch->middle[0]) <= patch->half[0] &&
           fabs(p->at[1] - patch->middle[1]) <= patch->half[1];
}

/* Returns the radius around LAMP, in patch coordinates, that contains all its
 * sample points. */
static double compute_lamp_radius(const struct traced *t,
                                  const struct glint_lamp *lamp)
{
    const double cosine = glint_cos_deg(lamp->theta_deg);

    return REACH * fmax(lamp->axis[0], lamp->axis[1]) * cosine *
           (t->cfg.round ? cosine * 180 / GLINT_PI : 1);
}

/* Makes patches that each contain one or more complete LAMPS. Skips lamps wider
 * than a patch. Returns the number of patches. The number of sample points per
 * lamp depends on the picture's size, but these patches do not, so their fields
 * can be reused. ROOM: scratch memory. */
static int make_lamp_patches(const struct traced *t,
                             const struct glint_lamp *lamps, int n,
                             struct point *room, struct ray_patch *patch)
{
    const double span = t->cfg.round ? SPAN_DEG : SPAN_DEG * GLINT_PI / 180;
    int narrow = 0;

    for (int i = 0; i < n; i++) {
        const double reach = compute_lamp_radius(t, &lamps[i]);

        if (2 * reach <= span)
            room[narrow++] = (struct point){.lamp = lamps[i], .reach = reach};
    }
    return group_points_in_patches(t, room, narrow, patch, 0);
}

/* Assigns points to those of the first N patches that contain them. Moves all
 * other points to the front of the list and returns their number. */
static int assign_points_to_patches(struct traced *t,
                                    const struct ray_patch *from, int n)
{
    int left = t->n_points;

    for (int k = 0; k < n; k++) {
        const int before = left;

        for (int i = 0; i < left;) {
            struct point p = t->point[i];

            set_point_coordinates(t, &p, from[k].phi_deg);
            if (!is_point_in_patch(&from[k], &p)) {
                i++;
                continue;
            }
            p.patch = t->n_patches;
            t->point[i] = t->point[--left];
            t->point[left] = p;
        }
        if (left < before)
            t->patch[t->n_patches++] = from[k];
    }
    return left;
}

/* ------------------------------------------------------------------- levels */

/* Sets D to the unit direction of LAMP times the light of LAMP. Returns that
 * light. */
static double compute_weighted_direction(const struct glint_lamp *lamp,
                                         double d[3])
{
    const double light = lamp->power * glint_largest_channel(lamp->rgb);
    const double sine = glint_sin_deg(lamp->theta_deg);

    d[0] = light * sine * glint_cos_deg(lamp->phi_deg);
    d[1] = light * sine * glint_sin_deg(lamp->phi_deg);
    d[2] = light * glint_cos_deg(lamp->theta_deg);
    return light;
}

/* Sets BOTH to a point with the sum of the light of A and B. Its direction is
 * the mean of their directions, weighted by light. */
static void merge_two_points(const struct traced *t, const struct point *a,
                             const struct point *b, struct point *both)
{
    const double degree = GLINT_PI / 180;
    double d[3], e[3];

    *both = compute_weighted_direction(&a->lamp, d) <
                    compute_weighted_direction(&b->lamp, e)
                ? *b
                : *a;
    for (int k = 0; k < 3; k++)
        d[k] += e[k];
    both->lamp.theta_deg = atan2(hypot(d[0], d[1]), d[2]) / degree;
    both->lamp.phi_deg = atan2(d[1], d[0]) / degree;
    both->lamp.power = a->lamp.power + b->lamp.power;
    for (int c = 0; c < 3 && both->lamp.power > 0; c++)
        both->lamp.rgb[c] =
            (a->lamp.rgb[c] * a->lamp.power + b->lamp.rgb[c] * b->lamp.power) /
            both->lamp.power;
    set_point_coordinates(t, both, t->patch[a->patch].phi_deg);
}

/* Returns the squared distance between the unit directions of A and B. It is
 * close to the squared angle between them in radians. Returns HUGE_VAL if a
 * point has no light. */
static double compute_squared_distance(const struct point *a,
                                       const struct point *b)
{
    double d[3], e[3], sum = 0;
    const double by_a = compute_weighted_direction(&a->lamp, d);
    const double by_b = compute_weighted_direction(&b->lamp, e);

    if (!(by_a > 0 && by_b > 0))
        return HUGE_VAL;
    for (int k = 0; k < 3; k++)
        sum += (d[k] / by_a - e[k] / by_b) * (d[k] / by_a - e[k] / by_b);
    return sum;
}

/* Merges pairs of nearest points of LEVEL into points of the next level.
 * Returns whether any pair was merged. */
static bool merge_nearest_points(struct traced *t, int level)
{
    const int n = t->n_points;
    const double most = SPAN_DEG * GLINT_PI / 180;
    bool any = false;

    for (int i = 0; i < n; i++) {
        struct point *a = &t->point[i], both;
        double least = most * most;
        int with = -1;

        if (a->first > level || a->last < LEVELS)
            continue;
        for (int k = i + 1; k < n; k++) {
            const struct point *b = &t->point[k];
            const double d =
                b->patch == a->patch && b->first <= level && b->last == LEVELS
                    ? compute_squared_distance(a, b)
                    : HUGE_VAL;

            if (d < least) {
                least = d;
                with = k;
            }
        }
        if (with < 0)
            continue;
        merge_two_points(t, a, &t->point[with], &both);
        if (!is_point_in_patch(&t->patch[both.patch], &both))
            continue;
        a->last = t->point[with].last = level;
        both.first = level + 1;
        both.last = LEVELS;
        t->point[t->n_points++] = both;
        any = true;
    }
    return any;
}

static void build_point_levels(struct traced *t)
{
    int level = 0;

    while (level < LEVELS && merge_nearest_points(t, level))
        level++;
}

/* --------------------------------------------------------------------- plan */

/* Returns whether this frame draws GHOST, the index of a ghost or of a part of
 * a ghost. */
static bool is_ghost_drawn(const struct glint_frame *f, int ghost)
{
    return (f->only_ghost < 0 ||
            glint_frame_is_part_of_ghost(f->setup, ghost, f->only_ghost)) &&
           (!f->tints || f->tints[ghost].gain.mantissa > 0);
}

/* Returns whether FIELD is drawn and still has to be measured, as no earlier
 * frame has measured it. */
static bool is_field_unmeasured(const struct glint_frame *f,
                                const struct ray_field *field)
{
    return !field->is_measured && is_ghost_drawn(f, field->ghost);
}

static int count_unmeasured_fields(const struct glint_frame *f)
{
    const struct traced *const t = get_traced_state(f);
    int n = 0;

    for (int i = 0; i < t->n_patches * f->setup->n_ghosts; i++)
        n += is_field_unmeasured(f, &t->measured[i]);
    return n;
}

static void run_field_measure_job(void *ctx, int job, int worker)
{
    const struct job *j = ctx;
    struct traced *t = get_traced_state(j->frame);
    struct ray_field *const field = &t->measured[j->first + job];

    (void)worker;
    if (is_field_unmeasured(j->frame, field))
        glint_ray_field_measure(&t->cfg, field);
}

/* Returns whether the bounding box of FIELD on the sensor, rotated by PHI_DEG,
 * overlaps the picture. */
static bool is_field_in_picture(const struct glint_frame *f,
                                const struct ray_field *field, double phi_deg)
{
    const double *s = field->pupil.sensor_mm;
    const double half_w = 0.5 * f->view.sensor_width_mm;
    const double half_h = half_w * f->view.height / f->view.width;
    const double c = glint_cos_deg(phi_deg), d = glint_sin_deg(phi_deg);
    const double x = 0.5 * (s[0] + s[1]), y = 0.5 * (s[2] + s[3]);
    const double w = 0.5 * (s[1] - s[0]), h = 0.5 * (s[3] - s[2]);

    return fabs(x * c - y * d) - fabs(c) * w - fabs(d) * h < half_w &&
           fabs(x * d + y * c) - fabs(d) * w - fabs(c) * h < half_h;
}

/* Returns the azimuth, degrees, by which the ghosts of point P are rotated in
 * the picture. */
static double get_field_azimuth(const struct traced *t, const struct point *p)
{
    return t->cfg.round ? p->lamp.phi_deg : t->patch[p->patch].phi_deg;
}

/* Returns the light of point P through GHOST, max over the colour channels, per
 * mm^2 of pupil flux. */
static double compute_point_light(const struct glint_frame *f,
                                  const struct point *p, int ghost)
{
    const struct traced *t = get_traced_state(f);
    const double gain = f->tints ? glint_real_value(f->tints[ghost].gain) : 1;

    return p->lamp.power * glint_largest_channel(p->lamp.rgb) * gain *
           glint_cos_deg(p->lamp.theta_deg) / t->set[0].unit_flux[0];
}

/* Returns the area of the bounding box of FIELD on the sensor in pixels, plus
 * 1, so that it is never 0. */
static double compute_field_pixels(const struct glint_frame *f,
                                   const struct ray_field *field)
{
    const double *s = field->pupil.sensor_mm;
    const double pixel = f->view.sensor_width_mm / f->view.width;

    return (s[1] - s[0]) * (s[3] - s[2]) / (pixel * pixel) + 1;
}

/* Returns the flux that FIELD would have if no ray were blocked, mm^2: an upper
 * bound of its flux. */
static double compute_unblocked_flux(const struct ray_field *field)
{
    const struct glint_pupil *p = &field->pupil;

    return (p->x1_mm - p->x0_mm) * glint_pupil_height(p) * field->energy_unit;
}

/* Computes the light that the points of LEVEL send through FIELD: ALL, the sum
 * over all points, and MOST, the max of a single point. */
static void sum_point_light(const struct glint_frame *f, int field, int level,
                            double *all, double *most)
{
    const struct traced *t = get_traced_state(f);
    const struct ray_field *r = &t->field[field];

    *all = *most = 0;
    for (int i = 0; i < t->n_points; i++)
        if (&t->patch[t->point[i].patch] == r->patch &&
            t->point[i].first <= level && t->point[i].last >= level) {
            const double light = compute_point_light(f, &t->point[i], r->ghost);

            *all += light;
            *most = fmax(*most, light);
        }
}

/* Returns whether the fields of T were measured with the lens and the band of
 * wavelengths of CFG. */
static bool is_same_lens_and_band(const struct traced *t,
                                  const struct ray_field_config *cfg)
{
    const struct glint_optics *const a = &t->optics;
    const struct glint_optics *const b = &cfg->setup->optics;
    bool same = t->cfg.setup == cfg->setup && t->cfg.draft == cfg->draft &&
                t->n_ghosts == cfg->setup->n_ghosts &&
                a->stop_radius_mm == b->stop_radius_mm &&
                a->focal_mm == b->focal_mm && a->length_mm == b->length_mm &&
                a->squeeze == b->squeeze;

    for (int k = 0; k < 3; k++)
        same = same && t->cfg.wave_nm[k] == cfg->wave_nm[k];
    return same;
}

/* Patches of an earlier frame and their measured fields. */
struct measured_fields {
    struct ray_patch *patch;
    struct ray_field *field;
    int n; /* number of patches */
};

/* Moves the patches and fields of T to HAD if they were measured with the lens
 * and the band of wavelengths of CFG. Otherwise sets HAD empty. */
static void move_measured_fields(struct traced *t,
                                 const struct ray_field_config *cfg,
                                 struct measured_fields *had)
{
    *had = (struct measured_fields){NULL, NULL, 0};
    if (!is_same_lens_and_band(t, cfg))
        return;
    *had = (struct measured_fields){t->patch, t->measured,
                                    t->measured ? t->n_patches : 0};
    t->patch = NULL;
    t->measured = NULL;
}

/* Groups LAMPS into patches and builds the levels of their points. LAMPS has N
 * elements, the sample points of the N_GIVEN lamps in GIVEN. */
static enum glint_status
group_lamps_in_patches(struct traced *t, const struct glint_lamp *lamps, int n,
                       const struct glint_lamp *given, int n_given)
{
    const size_t size = (size_t)n, all = (size_t)n_given;
    struct point *const room = calloc(all + 1, sizeof *room);
    struct ray_patch *const patch = calloc(all + 1, sizeof *patch);
    int left;

    /* space for the points of all levels */
    t->point = calloc(2 * size, sizeof *t->point);
    t->patch = calloc(size, sizeof *t->patch);
    if (room && patch && t->point && t->patch) {
        t->n_points = n;
        for (int i = 0; i < n; i++)
            t->point[i] =
                (struct point){.lamp = lamps[i], .light = i, .last = LEVELS};
        left = assign_points_to_patches(
            t, patch, make_lamp_patches(t, given, n_given, room, patch));
        t->n_patches =
            group_points_in_patches(t, t->point, left, t->patch, t->n_patches);
        build_point_levels(t);
    }
    free(room);
    free(patch);
    return t->n_points ? GLINT_OK : GLINT_E_MEMORY;
}

static bool are_patches_equal(const struct ray_patch *a,
                              const struct ray_patch *b)
{
    return a->phi_deg == b->phi_deg && a->middle[0] == b->middle[0] &&
           a->middle[1] == b->middle[1] && a->half[0] == b->half[0] &&
           a->half[1] == b->half[1];
}

/* Returns the fields that HAD has measured for PATCH, or NULL. They are
 * bit-identical to a new measurement. */
static const struct ray_field *
find_measured_fields(const struct measured_fields *had,
                     const struct ray_patch *patch, int n_ghosts)
{
    for (int k = 0; k < had->n; k++)
        if (are_patches_equal(&had->patch[k], patch))
            return had->field + k * n_ghosts;
    return NULL;
}

/* Allocates one field per ghost and patch. Copies the fields that HAD has
 * measured already. */
static enum glint_status
allocate_ghost_fields(struct traced *t, const struct measured_fields *had,
                      int n_ghosts)
{
    const size_t size = (size_t)t->n_patches * (size_t)n_ghosts;

    t->measured = calloc(size + 1, sizeof *t->measured);
    t->field = calloc(size + 1, sizeof *t->field);
    if (!t->measured || !t->field)
        return GLINT_E_MEMORY;
    for (int patch = 0; patch < t->n_patches; patch++) {
        struct ray_field *const field = t->measured + patch * n_ghosts;
        const struct ray_field *const from =
            find_measured_fields(had, &t->patch[patch], n_ghosts);

        if (from)
            memcpy(field, from, (size_t)n_ghosts * sizeof *field);
        for (int ghost = 0; ghost < n_ghosts; ghost++) {
            field[ghost].ghost = ghost;
            field[ghost].patch = &t->patch[patch];
        }
    }
    return GLINT_OK;
}

/* Sets the list of fields to the fields that this frame draws, and chooses the
 * sizes of their grids for the picture. */
static void list_drawn_fields(const struct glint_frame *f)
{
    struct traced *const t = get_traced_state(f);

    t->n_fields = 0;
    for (int i = 0; i < t->n_patches * f->setup->n_ghosts; i++)
        if (t->measured[i].is_open && is_ghost_drawn(f, t->measured[i].ghost)) {
            t->field[t->n_fields] = t->measured[i];
            glint_ray_field_choose_grid(&t->cfg, &t->field[t->n_fields++]);
        }
}

/* Groups N LAMPS, at least 1, into patches and measures the fields of these
 * patches. Fields that HAD has measured are copied. */
static enum glint_status measure_lamp_fields(struct glint_frame *f,
                                             const struct glint_lamp *lamps,
                                             int n,
                                             const struct measured_fields *had)
{
    struct traced *const t = get_traced_state(f);
    const int n_ghosts = f->setup->n_ghosts;
    enum glint_status status;

    if ((int64_t)n * n_ghosts * f->setup->n_wavelengths > INT_MAX)
        return GLINT_E_MEMORY;
    status =
        group_lamps_in_patches(t, lamps, n, f->lights.given, f->lights.n_given);
    if (status == GLINT_OK && (int64_t)t->n_patches * n_ghosts > INT_MAX / 2)
        status = GLINT_E_MEMORY;
    if (status == GLINT_OK)
        status = allocate_ghost_fields(t, had, n_ghosts);
    if (status != GLINT_OK)
        return status;
    if (count_unmeasured_fields(f) > 0) {
        t->found = had->n > 0 ? MEASURED_MORE : GLINT_FRAME_FOUND;
        run_jobs_with_progress(f, t->n_patches * n_ghosts,
                               run_field_measure_job,
                               had->n > 0 ? GLINT_FRAME_FOUND : 0, t->found);
    }
    list_drawn_fields(f);
    return GLINT_OK;
}

/* Measures the fields of LAMPS for frame F. Reuses fields of the last frame if
 * lens and wavelengths are the same. */
static enum glint_status measure_frame_fields(struct glint_frame *f,
                                              const struct glint_lamp *lamps,
                                              int n)
{
    struct traced *const t = get_traced_state(f);
    const struct glint_setup *s = f->setup;
    struct ray_field_config cfg = {.setup = s,
                                   .view = f->view,
                                   .round =
                                       glint_prescription_is_round(s->lens),
                                   .max_cells = f->dials.fineness,
                                   .uniform = f->picture.uniform,
                                   .draft = glint_frame_is_draft(f)};
    enum glint_status status = GLINT_OK;
    struct measured_fields had;

    set_wavelength_sets(t, s, &cfg);
    move_measured_fields(t, &cfg, &had);
    free_traced_arrays(t);
    t->cfg = cfg;
    t->optics = s->optics;
    t->n_ghosts = s->n_ghosts;
    if (n > 0)
        status = measure_lamp_fields(f, lamps, n, &had);
    if (status != GLINT_OK)
        free_traced_arrays(t);
    free(had.patch);
    free(had.field);
    return status;
}

/* Skips the fields of ghosts that are too faint: they would stay below FAINTEST
 * even in a pixel that the light of all points reaches. */
static enum glint_status skip_faint_ghosts(struct glint_frame *f, double scale,
                                           double faintest)
{
    struct traced *const t = get_traced_state(f);
    const double pixel = f->view.sensor_width_mm / f->view.width;
    double *peak;

    if (!(faintest > 0))
        return GLINT_OK;
    peak = calloc((size_t)f->setup->n_ghosts, sizeof *peak);
    if (!peak)
        return GLINT_E_MEMORY;
    for (int i = 0; i < t->n_fields; i++) {
        double all, most;

        sum_point_light(f, i, 0, &all, &most);
        peak[t->field[i].ghost] +=
            scale * all * t->field[i].peak_mm2 * pixel * pixel;
    }
    for (int i = 0; i < t->n_fields; i++)
        if (peak[t->field[i].ghost] < faintest)
            t->set_of[i] = -1;
    free(peak);
    return GLINT_OK;
}

/* Returns whether field I is drawn from point P: both have the same patch, and
 * P belongs to the field's level. */
static bool is_field_drawn_from_point(const struct traced *t, int i, int p)
{
    return &t->patch[t->point[p].patch] == t->field[i].patch &&
           t->point[p].first <= t->level[i] && t->point[p].last >= t->level[i];
}

/* Chooses the directions and wavelengths for which field I is traced. They
 * cover only the points of the field's level, which are fewer than all points
 * of its patch. */
static void choose_field_samples(struct traced *t, int i)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    const struct wave_set *const set = &t->set[t->set_of[i]];
    struct ray_patch range;

    for (int p = 0; p < t->n_points; p++)
        if (is_field_drawn_from_point(t, i, p))
            extend_range_by_point(&t->point[p], low, high);
    range = make_direction_patch(t, t->field[i].patch->phi_deg, low, high);
    glint_ray_field_choose_samples(&t->field[i], &range, set->nm, set->n);
}

/* Lists the bundles of ghosts that overlap the picture, sorted by field, then
 * by wavelength. */
static enum glint_status list_visible_bundles(struct glint_frame *f)
{
    struct traced *const t = get_traced_state(f);
    size_t n = 0;

    for (int pass = 0; pass < 2; pass++) {
        n = 0;
        for (int i = 0; i < t->n_fields; i++)
            for (int w = 0; t->set_of[i] >= 0 && w < t->set[t->set_of[i]].n;
                 w++)
                for (int p = 0; p < t->n_points; p++) {
                    if (!is_field_drawn_from_point(t, i, p) ||
                        !is_field_in_picture(
                            f, &t->field[i],
                            get_field_azimuth(t, &t->point[p])))
                        continue;
                    if (pass)
                        t->bundle[n] = (struct ray_bundle){i, p, w, 1, 0};
                    n++;
                }
        if (n > MAX_BUNDLES)
            return GLINT_E_MEMORY;
        if (pass == 0)
            t->bundle = malloc((n + 1) * sizeof *t->bundle);
        if (!t->bundle)
            return GLINT_E_MEMORY;
    }
    t->n_bundles = (int)n;
    return GLINT_OK;
}

static enum glint_status choose_light_scale(struct glint_frame *frame,
                                            const struct glint_lamp *lamps,
                                            int n_lamps,
                                            struct glint_frame_scale *scale)
{
    enum glint_status status = GLINT_OK;
    double brightest = 0, together = 0;
    const struct traced *t;

    *scale = (struct glint_frame_scale){0, 0};
    if (!frame->memory.traced)
        frame->memory.traced = calloc(1, sizeof *t);
    t = frame->memory.traced;
    status = t ? measure_frame_fields(frame, lamps, n_lamps) : GLINT_E_MEMORY;
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < t->n_fields; i++) {
        double all, most;

        sum_point_light(frame, i, 0, &all, &most);
        brightest =
            fmax(brightest, most * t->field[i].flux /
                                compute_field_pixels(frame, &t->field[i]));
        together += all * compute_unblocked_flux(&t->field[i]) * t->set[0].n;
    }
    if (brightest > 0)
        *scale = glint_frame_compute_scale((int)ceil(log2(brightest)),
                                           (int)ceil(log2(together)));
    return GLINT_OK;
}

/* -------------------------------------------------------------------- trace */

static size_t get_memory_limit(const struct glint_frame *f)
{
    const size_t most = f->limits.most_bytes / 2;

    return most && most < MOST_BYTES ? most : MOST_BYTES;
}

static void run_field_trace_job(void *ctx, int job, int worker)
{
    const struct job *j = ctx;
    struct traced *t = get_traced_state(j->frame);
    const int i = j->first + job;

    (void)worker;
    if (t->mem[i])
        glint_ray_field_trace_rays(&t->cfg, &t->field[i], t->mem[i]);
}

/* Allocates memory for the rays of as many fields as fit into the limit. For
 * the remaining fields, allocates memory for one field per worker. */
static enum glint_status allocate_ray_memory(struct glint_frame *f)
{
    struct traced *const t = get_traced_state(f);
    size_t left = get_memory_limit(f), largest = 0;

    t->n_workers = glint_workers_count(f->cfg.workers);
    t->worker = calloc((size_t)t->n_workers, sizeof *t->worker);
    if (!t->worker)
        return GLINT_E_MEMORY;
    for (int i = 0; i < t->n_fields; i++) {
        const size_t bytes =
            t->set_of[i] >= 0
                ? glint_ray_field_compute_bytes(&t->cfg, &t->field[i])
                : 0;

        if (bytes == 0)
            continue;
        if (bytes <= left) {
            t->mem[i] = malloc(bytes);
            if (!t->mem[i])
                return GLINT_E_MEMORY;
            left -= bytes;
        } else if (bytes > largest)
            largest = bytes;
    }
    for (int i = 0; i < t->n_workers; i++) {
        t->worker[i].in_mem = -1;
        t->worker[i].mem = largest ? malloc(largest) : NULL;
        if (largest && !t->worker[i].mem)
            return GLINT_E_MEMORY;
    }
    return GLINT_OK;
}

/* Reduces the work for field I as long as the error is invisible in 8-bit
 * codes. Draws it from a level with fewer points, while each point adds less
 * than half of STEP, and with a coarser grid. LIGHT: mean brightness of the
 * field for a point of light 1. In codes, errors of faint light shrink by
 * 2^(5/12) per octave. Compare plan_cells.c. */
static void coarsen_faint_field(struct glint_frame *f, int i, double light,
                                double step)
{
    struct traced *const t = get_traced_state(f);
    struct ray_field *r = &t->field[i];
    double all, most, brightness;

    while (t->level[i] < LEVELS) {
        sum_point_light(f, i, t->level[i] + 1, &all, &most);
        if (!(light * most < 0.5 * step))
            break;
        t->level[i]++;
    }
    sum_point_light(f, i, t->level[i], &all, &most);
    brightness = light * most * (r->folds ? 16 : 1);
    if (brightness < 1)
        glint_ray_field_coarsen_grid(
            &t->cfg, r, exp2(5.0 / 24 * fmax(log2(brightness), -12)));
}

/* Refines the grid of field I until its cells, which have uniform irradiance,
 * are invisible: until neighbours differ by CELL_CODES or are CELL_PIXELS wide.
 * SCALE is a factor on the light. A code is taken as 255 sqrt(light / white).
 */
static void refine_bright_field(struct glint_frame *f, int i, double scale)
{
    struct traced *const t = get_traced_state(f);
    struct ray_field *const r = &t->field[i];
    const double pixel = f->view.sensor_width_mm / f->view.width;
    double all, most, n;

    sum_point_light(f, i, t->level[i], &all, &most);
    n = 255 / CELL_CODES * r->measures.root_slope * pixel * sqrt(scale * most);
    n = fmin(n, sqrt(compute_field_pixels(f, r)) / CELL_PIXELS);
    glint_ray_field_refine_grid(&t->cfg, r, n * t->cfg.max_cells / 64);
}

/* Plans the frame: measures the fields of LAMPS, skips faint ghosts, and
 * chooses wavelengths, levels and grids. SCALE is a factor on the light. */
static enum glint_status plan_ray_frame(struct glint_frame *f,
                                        const struct glint_lamp *lamps, int n,
                                        double scale,
                                        const struct glint_image *image)
{
    struct traced *const t = get_traced_state(f);
    const double step =
        glint_frame_get_light_near_black(f, image, GLINT_FRAME_STEP_CODES);
    enum glint_status status = measure_frame_fields(f, lamps, n);

    if (status != GLINT_OK)
        return status;
    t->set_of = calloc((size_t)t->n_fields + 1, sizeof *t->set_of);
    t->level = calloc((size_t)t->n_fields + 1, sizeof *t->level);
    t->mem = calloc((size_t)t->n_fields + 1, sizeof *t->mem);
    if (!t->set_of || !t->mem || !t->level)
        return GLINT_E_MEMORY;
    t->in_codes = is_planned_for_codes(f, image);
    list_drawn_fields(f);
    status = skip_faint_ghosts(
        f, scale,
        glint_frame_get_light_near_black(f, image, f->dials.cull_codes));
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < t->n_fields; i++) {
        struct ray_field *r = &t->field[i];
        double all, most, light;

        if (t->set_of[i] < 0)
            continue;
        light = scale * r->flux / compute_field_pixels(f, r);
        sum_point_light(f, i, 0, &all, &most);
        t->set_of[i] = choose_wavelength_set(f, r, light * most, step);
        if (t->in_codes) {
            coarsen_faint_field(f, i, light, step);
            refine_bright_field(f, i, scale);
        }
        choose_field_samples(t, i);
    }
    status = list_visible_bundles(f);
    return status == GLINT_OK ? allocate_ray_memory(f) : status;
}

/* Returns whether B belongs to the part of the frame that is drawn. */
static bool is_bundle_in_part(const struct glint_frame *f,
                              const struct ray_bundle *b)
{
    const struct traced *const t = get_traced_state(f);

    return (t->part.ghost < 0 || t->part.ghost == t->field[b->field].ghost) &&
           (t->part.light < 0 || t->part.light == t->point[b->point].light);
}

/* Callback of struct glint_flare_rays: prepares the interpolation of bundle I
 * for compute_vertex_row(). Returns 0 if the bundle is not drawn or lies
 * outside rows Y0 .. Y1. */
static int open_ray_bundle(void *ctx, int worker, int i, int y0, int y1)
{
    const struct glint_frame *f = ctx;
    struct traced *t = get_traced_state(f);
    struct ray_worker *w = &t->worker[worker];
    struct ray_bundle *b = &t->bundle[i];
    const struct point *p = &t->point[b->point];
    const void *mem = t->mem[b->field];

    if (!is_bundle_in_part(f, b))
        return 0;
    if (b->low <= b->high && (b->high < (float)y0 || b->low > (float)y1))
        return 0;
    if (!mem && w->in_mem != b->field) {
        glint_ray_field_trace_rays(&t->cfg, &t->field[b->field], w->mem);
        w->in_mem = b->field;
    }
    w->bundle = b;
    w->low = HUGE_VALF;
    w->high = -HUGE_VALF;
    glint_ray_place_set_weights(
        &w->place, &t->field[b->field], mem ? mem : w->mem, p->at,
        t->set[t->set_of[b->field]].nm[b->wave], get_field_azimuth(t, p));
    return 1;
}

static void compute_vertex_row(void *ctx, int worker, int j,
                               struct glint_vertex *row)
{
    const struct glint_frame *f = ctx;
    struct traced *t = get_traced_state(f);
    struct ray_worker *w = &t->worker[worker];
    const int n = w->place.field->n_cells;

    glint_ray_place_interpolate_row(&t->cfg, &w->place, j, row);
    for (int i = 0; i <= n; i++)
        if (row[i].energy_q16 >= 0) {
            const float y = (float)row[i].y_q8 / 256;

            w->low = y < w->low ? y : w->low;
            w->high = y > w->high ? y : w->high;
        }
    if (j == n) { /* Cells may extend a pixel beyond the positions of their
                     corners. */
        w->bundle->low = w->low - 2;
        w->bundle->high = w->high + 2;
    }
}

/* Sets BUNDLE to bundle B of the frame. SCALE is a factor on its light. */
static void set_flare_bundle(const struct glint_frame *f,
                             const struct ray_bundle *b, double scale,
                             struct glint_bundle *bundle)
{
    const struct traced *t = get_traced_state(f);
    const struct ray_field *r = &t->field[b->field];
    const struct wave_set *set = &t->set[t->set_of[b->field]];
    const struct glint_lamp *lamp = &t->point[b->point].lamp;
    const struct glint_pupil *p = &r->pupil;
    const double n = r->n_cells;
    const double area = (p->x1_mm - p->x0_mm) / n * (glint_pupil_height(p) / n);
    double rgb[3], largest = 0, flux, mantissa;
    int exponent = 0;

    for (int c = 0; c < 3; c++) {
        rgb[c] = set->rgb[b->wave][c] * lamp->rgb[c];
        if (f->tints)
            rgb[c] *= glint_tint_factor(&f->tints[r->ghost], c);
        largest = fmax(largest, fabs(rgb[c]));
    }
    flux = largest * scale * lamp->power * glint_cos_deg(lamp->theta_deg) *
           area * r->energy_unit / set->unit_flux[b->wave];
    mantissa = flux > 0 && isfinite(flux) ? frexp(flux, &exponent) : 0;
    bundle->n_cells = r->n_cells;
    bundle->flux_q31 = (int32_t)floor(mantissa * 0x1p31);
    bundle->flux_exponent = exponent;
    for (int c = 0; c < 3; c++)
        bundle->rgb_q14[c] =
            largest > 0 ? (int32_t)lrint(rgb[c] / largest * 16384) : 0;
}

/* -------------------------------------------------------------------- frame */

/* Allocates the flare's memory block for the capacities of F, and adds all
 * bundles to the flare. SCALE is a factor on their light. */
static enum glint_status begin_flare(struct glint_frame *f, double scale)
{
    struct traced *const t = get_traced_state(f);
    const size_t bytes = glint_flare_bytes(&f->cfg);
    enum glint_status status;

    if (!f->memory.block || f->memory.bytes != bytes) {
        free(f->memory.mem);
        f->memory.bytes = 0;
        f->memory.block = glint_block_allocate_aligned(bytes, &f->memory.mem);
        if (!f->memory.block)
            return GLINT_E_MEMORY;
        f->memory.bytes = bytes;
    }
    status =
        glint_flare_init(&f->memory.flare, &f->cfg, f->memory.block, bytes);
    if (status != GLINT_OK)
        return status;
    t->rays = (struct glint_flare_rays){
        open_ray_bundle, compute_vertex_row, f, t->in_codes,
        t->in_codes ? f->dials.snap_codes_q8 : 0};
    glint_flare_begin_rays(f->memory.flare, &t->rays);
    for (int i = 0; i < t->n_bundles; i++) {
        struct glint_bundle bundle;

        set_flare_bundle(f, &t->bundle[i], scale, &bundle);
        glint_flare_add(f->memory.flare, &bundle);
    }
    return GLINT_OK;
}

/* Sets the capacities of the flare to N edges and REFS references. Returns the
 * size of its memory block in bytes. */
static size_t set_edge_capacity(struct glint_frame *f, double n, double refs)
{
    f->cfg.max_primitives = (int)fmin(INT_MAX, n);
    f->cfg.max_refs = (int)fmin(INT_MAX, refs);
    return glint_flare_bytes(&f->cfg);
}

static bool has_edge_capacity(const struct glint_frame *f,
                              const struct glint_flare_stats *s)
{
    return s->need_primitives <= f->cfg.max_primitives &&
           s->need_refs <= f->cfg.max_refs;
}

/* Raises the capacities to the requirements in S. They stay within the memory
 * limit unless ANYWAY. Returns whether a capacity grew. */
static bool enlarge_edge_capacity(struct glint_frame *f,
                                  const struct glint_flare_stats *s,
                                  bool anyway)
{
    const int had = f->cfg.max_primitives, refs_had = f->cfg.max_refs;
    /* A single row of tiles cannot be divided. So its capacity grows above the
     * limit until it can be drawn. */
    const double least = anyway ? 1.25 * had + 1024 : had;
    const double least_refs = anyway ? 1.25 * refs_had + 1024 : refs_had;
    /* Workers get unequal numbers of edges. */
    const double uneven = glint_workers_count(f->cfg.workers) > 1 ? 1.5 : 1;
    double part = 1;

    while (set_edge_capacity(
               f, fmax(least, part * (uneven * s->need_primitives + 1024)),
               fmax(least_refs, part * (s->need_refs + 1024.0))) >
               get_memory_limit(f) &&
           !anyway && part > 1e-3)
        part *= 0.9;
    return f->cfg.max_primitives > had || f->cfg.max_refs > refs_had;
}

/* Bins the edges of pixel rows Y0 .. Y1 - 1. */
static void bin_pixel_rows(struct glint_frame *f, int y0, int y1,
                           struct glint_flare_stats *s)
{
    glint_flare_set_rows(f->memory.flare, y0, y1);
    glint_flare_bin(f->memory.flare, s);
}

/* Returns the number of pixel rows that fit into the capacities, if N rows have
 * the requirements S. It is a multiple of the tile side. */
static int choose_fewer_rows(const struct glint_frame *f, int n,
                             const struct glint_flare_stats *s)
{
    const int side = 1 << f->cfg.tile_log2;
    const double part =
        fmin((double)f->cfg.max_primitives / max_int(s->need_primitives, 1),
             (double)f->cfg.max_refs / max_int(s->need_refs, 1));

    return max_int(min_int((int)(0.8 * part * n), n - 1) / side, 1) * side;
}

static void add_flare_stats(struct glint_flare_stats *all,
                            const struct glint_flare_stats *s)
{
    all->bundles = max_int(all->bundles, s->bundles);
    all->need_bundles = s->need_bundles;
    all->primitives += s->primitives;
    all->refs += s->refs;
    all->need_primitives = max_int(all->need_primitives, s->need_primitives);
    all->need_refs = max_int(all->need_refs, s->need_refs);
    all->dropped_cells = max_int(all->dropped_cells, s->dropped_cells);
    all->held_cells = max_int(all->held_cells, s->held_cells);
}

static void draw_flare_only(struct glint_frame *f,
                            const struct glint_image *image)
{
    glint_flare_draw(f->memory.flare, image);
}

/* Bins all rows of IMAGE, in bands as high as the capacities allow, and draws
 * them by DRAW. */
static enum glint_status draw_all_rows(struct glint_frame *f, double scale,
                                       const struct glint_image *image,
                                       void draw(struct glint_frame *,
                                                 const struct glint_image *),
                                       struct glint_flare_stats *stats)
{
    const int height = f->view.height, side = 1 << f->cfg.tile_log2;
    enum glint_status status = GLINT_OK;
    int rows = height;

    for (int y0 = 0; y0 < height && status == GLINT_OK;) {
        const int n = min_int(rows, height - y0);
        struct glint_flare_stats s;

        bin_pixel_rows(f, y0, y0 + n, &s);
        if (!has_edge_capacity(f, &s) || s.dropped_bundles) {
            const bool more = enlarge_edge_capacity(f, &s, n <= side);

            /* also clears the number of dropped bundles */
            status = begin_flare(f, scale);
            if (!more || !has_edge_capacity(f, &s))
                rows = choose_fewer_rows(f, n, &s);
            continue;
        }
        draw(f, image);
        add_flare_stats(stats, &s);
        y0 += n;
        if (f->progress)
            f->progress(f->progress_ctx, TRACED + (1 - TRACED) * y0 / height);
    }
    return status;
}

static enum glint_status
draw_ray_frame(struct glint_frame *frame, const struct glint_lamp *lamps,
               int n_lamps, double scale, const struct glint_image *image,
               struct glint_flare_stats *stats, double times[5])
{
    struct glint_flare_stats expected = {0};
    enum glint_status status;
    struct traced *t;

    times[0] = read_frame_clock(frame);
    if (!frame->memory.traced)
        frame->memory.traced = calloc(1, sizeof *t);
    t = frame->memory.traced;
    status = t ? plan_ray_frame(frame, lamps, n_lamps, scale, image)
               : GLINT_E_MEMORY;
    if (status != GLINT_OK)
        return status;
    times[1] = read_frame_clock(frame);
    run_jobs_with_progress(frame, t->n_fields, run_field_trace_job, t->found,
                           TRACED);
    times[2] = times[3] = read_frame_clock(frame);
    expected.need_primitives = (int)fmin(EDGES * t->n_bundles, INT_MAX);
    expected.need_refs = expected.need_primitives;
    *stats = (struct glint_flare_stats){0};
    t->part.ghost = t->part.light = -1;
    frame->cfg.max_bundles = max_int(t->n_bundles, 1);
    frame->cfg.max_vertices = 0;
    frame->cfg.max_primitives = max_int(frame->cfg.max_primitives, 1 << 13);
    frame->cfg.max_refs = max_int(frame->cfg.max_refs, 1 << 14);
    enlarge_edge_capacity(frame, &expected, false);
    status = begin_flare(frame, scale);
    if (status == GLINT_OK)
        status =
            draw_all_rows(frame, scale, image, glint_frame_draw_passes, stats);
    times[4] = read_frame_clock(frame);
    return status;
}

static enum glint_status draw_ray_frame_part(struct glint_frame *frame,
                                             int ghost, int light,
                                             const struct glint_image *image)
{
    struct traced *const t = get_traced_state(frame);
    struct glint_flare_stats stats = {0};

    t->part.ghost = ghost;
    t->part.light = light;
    return draw_all_rows(frame, frame->plan.scale, image, draw_flare_only,
                         &stats);
}

/* Returns why FIELD, a measured field, is not drawn for point P: as FIELD I of
 * the frame, or -1 if it is none of these. Returns GLINT_OUTCOME_DRAWN if it is
 * drawn. */
static enum glint_outcome find_ray_outcome(const struct glint_frame *f,
                                           const struct ray_field *field, int i,
                                           int p)
{
    const struct traced *const t = get_traced_state(f);
    const struct point *const point = &t->point[p];

    if (!is_ghost_drawn(f, field->ghost))
        return GLINT_OUTCOME_OTHER;
    if (!(point->lamp.power > 0))
        return GLINT_OUTCOME_DARK;
    if (i < 0)
        return GLINT_OUTCOME_BLOCKED;
    if (t->set_of[i] < 0)
        return GLINT_OUTCOME_FAINT;
    if (!is_field_in_picture(f, &t->field[i], get_field_azimuth(t, point)))
        return GLINT_OUTCOME_OUTSIDE;
    return is_field_drawn_from_point(t, i, p) ? GLINT_OUTCOME_DRAWN
                                              : GLINT_OUTCOME_SHARED;
}

static void report_ray_accounts(const struct glint_frame *frame,
                                glint_frame_account_fn *report, void *ctx)
{
    const struct traced *const t = get_traced_state(frame);
    const int n_ghosts = frame->setup->n_ghosts;
    int i = 0; /* fields of the frame are listed in the order of all fields */

    if (!t || !t->set_of) /* nothing was drawn */
        return;
    for (int k = 0; k < t->n_patches * n_ghosts; k++) {
        const struct ray_field *const field = &t->measured[k];
        const bool is_listed = i < t->n_fields &&
                               t->field[i].patch == field->patch &&
                               t->field[i].ghost == field->ghost;

        for (int p = 0; p < t->n_points; p++) {
            const struct glint_account account = {
                .outcome =
                    find_ray_outcome(frame, field, is_listed ? i : -1, p)};

            if (&t->patch[t->point[p].patch] == field->patch &&
                t->point[p].first == 0 &&
                account.outcome != GLINT_OUTCOME_DRAWN)
                report(ctx, field->ghost, t->point[p].light, &account);
        }
        i += is_listed;
    }
    for (int b = 0; b < t->n_bundles; b++) {
        const struct ray_bundle *const bundle = &t->bundle[b];
        const struct ray_field *const field = &t->field[bundle->field];
        const struct glint_account account = {.outcome = GLINT_OUTCOME_DRAWN,
                                              .cells = field->n_cells,
                                              .vertices = (field->n_cells + 1) *
                                                          (field->n_cells + 1)};

        report(ctx, field->ghost, t->point[bundle->point].light, &account);
    }
}

static int count_ray_bundles(const struct glint_frame *frame)
{
    return get_traced_state(frame)->n_bundles;
}

static int get_bundle_ghost(const struct glint_frame *frame, int bundle)
{
    const struct traced *const t = get_traced_state(frame);

    return t->field[t->bundle[bundle].field].ghost;
}

static void free_ray_state(struct glint_frame *frame)
{
    if (frame->memory.traced)
        free_traced_arrays(frame->memory.traced);
    free(frame->memory.traced);
    frame->memory.traced = NULL;
}

static void move_ray_state(struct glint_frame *frame, struct glint_frame *from)
{
    free_ray_state(frame);
    frame->memory.traced = from->memory.traced;
    from->memory.traced = NULL;
}

const struct glint_frame_rays glint_frame_traces = {
    draw_ray_frame,      choose_light_scale, count_ray_bundles,
    get_bundle_ghost,    free_ray_state,     move_ray_state,
    report_ray_accounts, draw_ray_frame_part};
