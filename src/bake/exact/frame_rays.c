/* SPDX-License-Identifier: MIT
 *
 * Draws a frame of exact rays.
 *
 * Directions of lamps, and of the points of wide lamps, are gathered in
 * patches; each ghost has a field of rays over each patch (ray_field.h). Every
 * field takes as many wavelengths as its colours lie apart, and one that no
 * pixel shows is skipped. Vertices are computed from the fields while edges are
 * made of them. Memory is bounded: a field that finds no room is traced again
 * whenever it is needed, and a picture whose edges find none is drawn in parts,
 * from top to bottom. Neither changes a bit. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/exact/ray_field.h"
#include "engine/frame/block.h"
#include "engine/frame/frame_parts.h"
#include "engine/setup/degrees.h"

/* Most bundles of a frame. */
enum { MAX_BUNDLES = 1 << 20 };

/* Most memory of fields and of edges, each, unless the frame has a lower
 * limit. */
#define MOST_BYTES ((size_t)128 << 20)

/* Largest span of a patch, degrees: positions are then off by less than 0.1
 * pixel. */
#define SPAN_DEG 1.0

/* Radius of a lamp's outermost points / its largest semi-axis, about. */
#define REACH 2.2

/* Parts of the work between which progress is reported, and min jobs of a
 * part.
 */
enum { PARTS = 100, LEAST_PART = 4 };

/* Edges of a bundle, and their references in tiles, that most frames have room
 * for at once. */
#define EDGES 128.0

/* Progress of a frame whose rays are traced, 0 to 1. Finding its ghosts, if no
 * other frame has found them, ends at GLINT_FRAME_FOUND. */
#define TRACED 0.85

/* A lamp, in the patch that holds its direction, or several near each other
 * that stand for one: those of a level are about half as many as those of the
 * level before. Dim ghosts are drawn from fewer. */
enum { LEVELS = 8 };
struct point {
    struct glint_lamp lamp;
    double at[2];
    double reach; /* radius of what it stands for, in the same coordinates */
    int patch;
    int first, last; /* levels that it belongs to: FIRST .. LAST */
};

/* Wavelengths that stand for all light. */
struct wave_set {
    int n;
    double nm[GLINT_MAX_WAVELENGTHS];
    const double *rgb[GLINT_MAX_WAVELENGTHS];
    double unit_flux[GLINT_MAX_WAVELENGTHS];
};

/* The rays of one field, one direction and one wavelength. */
struct ray_bundle {
    int field, point, wave;
    float low, high; /* range of pixel rows; low > high: not known yet */
};

/* Where a worker is. */
struct at_work {
    struct ray_place place;
    struct ray_bundle *bundle;
    float low, high;
    int in_mem; /* field whose rays are in MEM, or -1 */
    void *mem;  /* room for the largest field that is not kept */
};

struct traced {
    struct ray_field_config cfg;
    struct wave_set set[GLINT_MAX_WAVE_SETS];
    int n_sets;
    struct point *point;
    struct ray_patch *patch;
    /* [patches][n_ghosts of the setup]: as glint_ray_field_look() made them */
    struct ray_field *looked;
    struct ray_field *field; /* [fields]: those as this frame draws them */
    int *set_of; /* [fields]: index of its set; -1: no pixel shows the field */
    void **mem;  /* [fields]: its rays; NULL: they are traced when needed */
    struct ray_bundle *bundle;
    struct at_work *worker;
    bool in_codes;
    int *level; /* [fields]: level of the points that a field is drawn from */
    struct glint_optics optics; /* of the setup that was looked through */
    int n_ghosts;
    int n_points, n_patches, n_fields, n_bundles, n_workers;
    struct glint_flare_rays rays;
};

struct job {
    struct glint_frame *frame;
    int first; /* number of the first job of a part */
};

static struct traced *state_of(const struct glint_frame *f)
{
    return f->memory.traced;
}

/* Frees all but the fields. */
static void forget_plan(struct traced *t)
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

static void forget(struct traced *t)
{
    forget_plan(t);
    free(t->point);
    free(t->patch);
    free(t->looked);
    free(t->field);
    t->point = NULL;
    t->patch = NULL;
    t->looked = NULL;
    t->field = NULL;
    t->n_points = t->n_patches = t->n_fields = 0;
}

/* Runs N jobs, in parts, and reports progress after each: FROM and TO,
 * fractions of the frame's work. */
static void run(struct glint_frame *f, int n, glint_job_fn *each, double from,
                double to)
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

static void add_wave(struct wave_set *set, double nm, const double *rgb,
                     double unit_flux)
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

/* Sets the wavelengths, sorted: the setup's sets, or its only list. */
static void set_waves(struct traced *t, const struct glint_setup *s,
                      struct ray_field_config *cfg)
{
    const struct glint_set_wave *w = s->set_wave;
    const struct wave_set *widest;

    memset(t->set, 0, sizeof t->set);
    t->n_sets = max_int(s->n_sets, 1);
    for (int k = 0; k < s->n_sets; w += s->set_size[k++])
        for (int i = 0; i < s->set_size[k]; i++)
            add_wave(&t->set[k], w[i].nm, w[i].rgb, w[i].unit_flux);
    for (int i = 0; i < s->n_wavelengths && s->n_sets == 0; i++)
        add_wave(&t->set[0], s->wavelength_nm[i], s->rgb[i], s->unit_flux[i]);
    widest = &t->set[t->n_sets - 1];
    cfg->wave_nm[0] = widest->nm[0];
    cfg->wave_nm[1] = widest->nm[widest->n / 2];
    cfg->wave_nm[2] = widest->nm[widest->n - 1];
}

static double span_of(const struct wave_set *set)
{
    const double a = set->nm[0], b = set->nm[set->n - 1];

    return 1 / (a * a) - 1 / (b * b);
}

/* Returns the smallest set whose steps from wavelength to wavelength do not
 * show in FIELD, a point of which gives LIGHT, display white in the mean: each
 * is below STEP or less than APART pixels wide. Compare wave_sets.c. */
static int choose_set(const struct glint_frame *f,
                      const struct ray_field *field, double light, double step)
{
    const struct traced *t = state_of(f);
    const double apart =
                     field->apart_mm * f->view.width / f->view.sensor_width_mm,
                 most = f->dials.dispersion_q8 / 256.0;
    int k = 0;

    for (; k < t->n_sets - 1 && f->dials.dispersion_q8 > 0; k++)
        if (light / (2 * t->set[k].n) < step ||
            apart * span_of(&t->set[k]) <=
                most * (t->set[k].n - 1) * span_of(&t->set[0]))
            break;
    return k;
}

/* ------------------------------------------------------------------ patches */

static int by_angle(const void *a, const void *b)
{
    const struct point *p = a, *q = b;

    return (p->at[0] > q->at[0]) - (p->at[0] < q->at[0]);
}

/* Sets the coordinates of P in the frame of azimuth PHI_DEG. */
static void set_at(const struct traced *t, struct point *p, double phi_deg)
{
    const double sine = glint_sin_deg(p->lamp.theta_deg);

    p->at[0] = t->cfg.round ? p->lamp.theta_deg
                            : sine * glint_cos_deg(p->lamp.phi_deg - phi_deg);
    p->at[1] =
        t->cfg.round ? 0 : sine * glint_sin_deg(p->lamp.phi_deg - phi_deg);
}

/* Widens LOW .. HIGH to the coordinates of P and of what it stands for. */
static void include_point(const struct point *p, double low[2], double high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k] = fmin(low[k], p->at[k] - p->reach);
        high[k] = fmax(high[k], p->at[k] + p->reach);
    }
}

/* Returns the patch from LOW to HIGH in the frame of azimuth PHI_DEG. */
static struct ray_patch make_patch(const struct traced *t, double phi_deg,
                                   const double low[2], const double high[2])
{
    struct ray_patch p = {.phi_deg = phi_deg};

    for (int k = 0; k < (t->cfg.round ? 1 : 2); k++) {
        p.middle[k] = 0.5 * (low[k] + high[k]);
        p.half[k] = 0.5 * (high[k] - low[k]);
    }
    /* Both components or none, so that cross terms are known. */
    if (!t->cfg.round && (p.half[0] > 0 || p.half[1] > 0))
        for (int k = 0; k < 2; k++)
            p.half[k] = fmax(p.half[k], 1e-4);
    return p;
}

/* Adds to PATCH, which has N, one that holds the points FIRST .. LAST - 1. */
static void add_patch(const struct traced *t, struct point *point, int first,
                      int last, double phi_deg, struct ray_patch *patch, int n)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

    for (int i = first; i < last; i++) {
        include_point(&point[i], low, high);
        point[i].patch = n;
    }
    patch[n] = make_patch(t, phi_deg, low, high);
}

/* Sorts N points of a round lens by their angle, and adds their patches to
 * PATCH, which has HAD; returns how many there are. */
static int gather_round(const struct traced *t, struct point *point, int n,
                        struct ray_patch *patch, int had)
{
    double low = 0, high = 0;
    int first = 0;

    for (int i = 0; i < n; i++)
        set_at(t, &point[i], 0);
    qsort(point, (size_t)n, sizeof *point, by_angle);
    for (int i = 0; i < n; i++) {
        const double from = point[i].at[0] - point[i].reach;
        const double to = point[i].at[0] + point[i].reach;

        if (i > first && fmax(high, to) - fmin(low, from) > SPAN_DEG) {
            add_patch(t, point, first, i, 0, patch, had++);
            first = i;
        }
        low = i > first ? fmin(low, from) : from;
        high = i > first ? fmax(high, to) : to;
    }
    if (n > 0)
        add_patch(t, point, first, n, 0, patch, had++);
    return had;
}

/* Puts each of N points that is in no patch yet, and all those near it, into
 * one of PATCH, which has HAD; returns how many there are. */
static int gather_others(const struct traced *t, struct point *point, int n,
                         struct ray_patch *patch, int had)
{
    const double near = 0.5 * SPAN_DEG * GLINT_PI / 180;
    int last;

    for (int first = 0; first < n; first = last) {
        const double phi_deg = point[first].lamp.phi_deg;
        struct point *seed = &point[first];

        set_at(t, seed, phi_deg);
        last = first + 1;
        for (int i = first + 1; i < n; i++) {
            struct point p = point[i];

            set_at(t, &p, phi_deg);
            if (fabs(p.at[0] - seed->at[0]) + p.reach > near ||
                fabs(p.at[1] - seed->at[1]) + p.reach > near)
                continue;
            point[i] = point[last];
            point[last++] = p;
        }
        add_patch(t, point, first, last, phi_deg, patch, had++);
    }
    return had;
}

static int gather_points(const struct traced *t, struct point *point, int n,
                         struct ray_patch *patch, int had)
{
    return t->cfg.round ? gather_round(t, point, n, patch, had)
                        : gather_others(t, point, n, patch, had);
}

static bool is_inside(const struct ray_patch *patch, const struct point *p)
{
    return fabs(p->at[0] - patch->middle[0]) <= patch->half[0] &&
           fabs(p->at[1] - patch->middle[1]) <= patch->half[1];
}

/* Returns the radius of LAMP, in coordinates of patches; points of it lie
 * within. */
static double reach_of(const struct traced *t, const struct glint_lamp *lamp)
{
    const double cosine = glint_cos_deg(lamp->theta_deg);

    return REACH * fmax(lamp->axis[0], lamp->axis[1]) * cosine *
           (t->cfg.round ? cosine * 180 / GLINT_PI : 1);
}

/* Sets PATCH[N] to patches of the N whole LAMPS, but for those that are wider
 * than a patch; returns how many there are. They do not depend on the size of
 * the picture, which decides into how many points a lamp is divided. */
static int gather_lamps(const struct traced *t, const struct glint_lamp *lamps,
                        int n, struct point *room, struct ray_patch *patch)
{
    const double span = t->cfg.round ? SPAN_DEG : SPAN_DEG * GLINT_PI / 180;
    int narrow = 0;

    for (int i = 0; i < n; i++) {
        const double reach = reach_of(t, &lamps[i]);

        if (2 * reach <= span)
            room[narrow++] = (struct point){.lamp = lamps[i], .reach = reach};
    }
    return gather_points(t, room, narrow, patch, 0);
}

/* Puts points into those of the N patches FROM in which they lie. Moves the
 * others to the front; returns their number. */
static int gather_inside(struct traced *t, const struct ray_patch *from, int n)
{
    int left = t->n_points;

    for (int k = 0; k < n; k++) {
        const int before = left;

        for (int i = 0; i < left;) {
            struct point p = t->point[i];

            set_at(t, &p, from[k].phi_deg);
            if (!is_inside(&from[k], &p)) {
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

/* Sets D to the direction of LAMP times its light; returns that. */
static double direction_of(const struct glint_lamp *lamp, double d[3])
{
    const double light = lamp->power * glint_largest_channel(lamp->rgb);
    const double sine = glint_sin_deg(lamp->theta_deg);

    d[0] = light * sine * glint_cos_deg(lamp->phi_deg);
    d[1] = light * sine * glint_sin_deg(lamp->phi_deg);
    d[2] = light * glint_cos_deg(lamp->theta_deg);
    return light;
}

/* Sets BOTH to a lamp with the light of A and B between them. */
static void unite(const struct traced *t, const struct point *a,
                  const struct point *b, struct point *both)
{
    const double degree = GLINT_PI / 180;
    double d[3], e[3];

    *both = *a;
    direction_of(&a->lamp, d);
    direction_of(&b->lamp, e);
    for (int k = 0; k < 3; k++)
        d[k] += e[k];
    both->lamp.theta_deg = atan2(hypot(d[0], d[1]), d[2]) / degree;
    both->lamp.phi_deg = atan2(d[1], d[0]) / degree;
    both->lamp.power = a->lamp.power + b->lamp.power;
    for (int c = 0; c < 3 && both->lamp.power > 0; c++)
        both->lamp.rgb[c] =
            (a->lamp.rgb[c] * a->lamp.power + b->lamp.rgb[c] * b->lamp.power) /
            both->lamp.power;
    set_at(t, both, t->patch[a->patch].phi_deg);
}

/* Returns the square of the sine between A and B, about. */
static double apart2(const struct point *a, const struct point *b)
{
    double d[3], e[3], sum = 0;
    const double by_a = direction_of(&a->lamp, d);
    const double by_b = direction_of(&b->lamp, e);

    if (!(by_a > 0 && by_b > 0))
        return HUGE_VAL;
    for (int k = 0; k < 3; k++)
        sum += (d[k] / by_a - e[k] / by_b) * (d[k] / by_a - e[k] / by_b);
    return sum;
}

/* Pairs points of LEVEL with their nearest ones of that level, into points of
 * the next. Returns whether any were. */
static bool add_level(struct traced *t, int level)
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
                    ? apart2(a, b)
                    : HUGE_VAL;

            if (d < least) {
                least = d;
                with = k;
            }
        }
        if (with < 0)
            continue;
        unite(t, a, &t->point[with], &both);
        if (!is_inside(&t->patch[both.patch], &both))
            continue;
        a->last = t->point[with].last = level;
        both.first = level + 1;
        both.last = LEVELS;
        t->point[t->n_points++] = both;
        any = true;
    }
    return any;
}

static void add_levels(struct traced *t)
{
    int level = 0;

    while (level < LEVELS && add_level(t, level))
        level++;
}

/* --------------------------------------------------------------------- plan */

/* Returns whether ghost or part GHOST is to be drawn. */
static bool is_wanted(const struct glint_frame *f, int ghost)
{
    return (f->only_ghost < 0 ||
            glint_frame_is_part_of_ghost(f->setup, ghost, f->only_ghost)) &&
           (!f->tints || f->tints[ghost].gain.mantissa > 0);
}

/* Returns whether FIELD is to be drawn and no frame has looked at it. */
static bool is_unknown(const struct glint_frame *f,
                       const struct ray_field *field)
{
    return !field->is_looked && is_wanted(f, field->ghost);
}

static int count_unknown(const struct glint_frame *f)
{
    const struct traced *const t = state_of(f);
    int n = 0;

    for (int i = 0; i < t->n_patches * f->setup->n_ghosts; i++)
        n += is_unknown(f, &t->looked[i]);
    return n;
}

static void look_job(void *ctx, int job, int worker)
{
    const struct job *j = ctx;
    struct traced *t = state_of(j->frame);
    struct ray_field *const field = &t->looked[j->first + job];

    (void)worker;
    if (is_unknown(j->frame, field))
        glint_ray_field_look(&t->cfg, field);
}

/* Returns whether the box of FIELD on the sensor, turned by PHI_DEG, meets the
 * picture. */
static bool in_view(const struct glint_frame *f, const struct ray_field *field,
                    double phi_deg)
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

/* Returns the azimuth by which FIELD is turned for point P. */
static double turn_of(const struct traced *t, const struct point *p)
{
    return t->cfg.round ? p->lamp.phi_deg : t->patch[p->patch].phi_deg;
}

/* Returns the light of P, largest channel, per mm^2 of the pupil's flux. */
static double light_of(const struct glint_frame *f, const struct point *p,
                       int ghost)
{
    const struct traced *t = state_of(f);
    const double gain = f->tints ? glint_real_value(f->tints[ghost].gain) : 1;

    return p->lamp.power * glint_largest_channel(p->lamp.rgb) * gain *
           glint_cos_deg(p->lamp.theta_deg) / t->set[0].unit_flux[0];
}

/* Returns the size in pixels of the box that the light of FIELD falls in. */
static double pixels_of(const struct glint_frame *f,
                        const struct ray_field *field)
{
    const double *s = field->pupil.sensor_mm;
    const double pixel = f->view.sensor_width_mm / f->view.width;

    return (s[1] - s[0]) * (s[3] - s[2]) / (pixel * pixel) + 1;
}

/* Returns the flux of FIELD if all of its pupil were open, mm^2. */
static double box_flux(const struct ray_field *field)
{
    const struct glint_pupil *p = &field->pupil;

    return (p->x1_mm - p->x0_mm) * glint_pupil_height(p) * field->energy_unit;
}

/* Sets the light that all points of LEVEL give FIELD, and the most that one
 * does. */
static void sum_light(const struct glint_frame *f, int field, int level,
                      double *all, double *most)
{
    const struct traced *t = state_of(f);
    const struct ray_field *r = &t->field[field];

    *all = *most = 0;
    for (int i = 0; i < t->n_points; i++)
        if (&t->patch[t->point[i].patch] == r->patch &&
            t->point[i].first <= level && t->point[i].last >= level) {
            const double light = light_of(f, &t->point[i], r->ghost);

            *all += light;
            *most = fmax(*most, light);
        }
}

/* Returns whether the fields of T were looked at through the lens and with the
 * wavelengths of CFG. */
static bool is_same_lens(const struct traced *t,
                         const struct ray_field_config *cfg)
{
    const struct glint_optics *const a = &t->optics;
    const struct glint_optics *const b = &cfg->setup->optics;
    bool same =
        t->cfg.setup == cfg->setup && t->n_ghosts == cfg->setup->n_ghosts &&
        a->stop_radius_mm == b->stop_radius_mm && a->focal_mm == b->focal_mm &&
        a->length_mm == b->length_mm && a->squeeze == b->squeeze;

    for (int k = 0; k < 3; k++)
        same = same && t->cfg.wave_nm[k] == cfg->wave_nm[k];
    return same;
}

/* Patches, and their fields, of an earlier picture. */
struct sights {
    struct ray_patch *patch;
    struct ray_field *field;
    int n; /* patches */
};

/* Takes the patches and fields of T, if they were made for the lens and the
 * wavelengths of CFG. */
static void take_sights(struct traced *t, const struct ray_field_config *cfg,
                        struct sights *had)
{
    *had = (struct sights){NULL, NULL, 0};
    if (!is_same_lens(t, cfg))
        return;
    *had = (struct sights){t->patch, t->looked, t->looked ? t->n_patches : 0};
    t->patch = NULL;
    t->looked = NULL;
}

/* Gathers LAMPS, N points of the GIVEN lamps, in patches. */
static enum glint_status gather(struct traced *t,
                                const struct glint_lamp *lamps, int n,
                                const struct glint_lamp *given, int n_given)
{
    const size_t size = (size_t)n, all = (size_t)n_given;
    struct point *const room = calloc(all + 1, sizeof *room);
    struct ray_patch *const patch = calloc(all + 1, sizeof *patch);
    int left;

    t->point = calloc(2 * size, sizeof *t->point); /* with all levels */
    t->patch = calloc(size, sizeof *t->patch);
    if (room && patch && t->point && t->patch) {
        t->n_points = n;
        for (int i = 0; i < n; i++)
            t->point[i] = (struct point){.lamp = lamps[i], .last = LEVELS};
        left = gather_inside(t, patch,
                             gather_lamps(t, given, n_given, room, patch));
        t->n_patches = gather_points(t, t->point, left, t->patch, t->n_patches);
        add_levels(t);
    }
    free(room);
    free(patch);
    return t->n_points ? GLINT_OK : GLINT_E_MEMORY;
}

static bool is_same_patch(const struct ray_patch *a, const struct ray_patch *b)
{
    return a->phi_deg == b->phi_deg && a->middle[0] == b->middle[0] &&
           a->middle[1] == b->middle[1] && a->half[0] == b->half[0] &&
           a->half[1] == b->half[1];
}

/* Returns the fields of HAD over PATCH, or NULL. They are the same bits as if
 * they were looked at again. */
static const struct ray_field *find_sight(const struct sights *had,
                                          const struct ray_patch *patch,
                                          int n_ghosts)
{
    for (int k = 0; k < had->n; k++)
        if (is_same_patch(&had->patch[k], patch))
            return had->field + k * n_ghosts;
    return NULL;
}

/* Sets the fields to look at: those of HAD as they are. */
static enum glint_status set_fields(struct traced *t, const struct sights *had,
                                    int n_ghosts)
{
    const size_t size = (size_t)t->n_patches * (size_t)n_ghosts;

    t->looked = calloc(size + 1, sizeof *t->looked);
    t->field = calloc(size + 1, sizeof *t->field);
    if (!t->looked || !t->field)
        return GLINT_E_MEMORY;
    for (int patch = 0; patch < t->n_patches; patch++) {
        struct ray_field *const field = t->looked + patch * n_ghosts;
        const struct ray_field *const from =
            find_sight(had, &t->patch[patch], n_ghosts);

        if (from)
            memcpy(field, from, (size_t)n_ghosts * sizeof *field);
        for (int ghost = 0; ghost < n_ghosts; ghost++) {
            field[ghost].ghost = ghost;
            field[ghost].patch = &t->patch[patch];
        }
    }
    return GLINT_OK;
}

/* Lists the fields that are drawn, with grids for the picture of F. */
static void list_fields(const struct glint_frame *f)
{
    struct traced *const t = state_of(f);

    t->n_fields = 0;
    for (int i = 0; i < t->n_patches * f->setup->n_ghosts; i++)
        if (t->looked[i].is_open && is_wanted(f, t->looked[i].ghost)) {
            t->field[t->n_fields] = t->looked[i];
            glint_ray_field_fit(&t->cfg, &t->field[t->n_fields++]);
        }
}

/* Looks at the fields of N LAMPS, at least 1, but for those of HAD. */
static enum glint_status look_at(struct glint_frame *f,
                                 const struct glint_lamp *lamps, int n,
                                 const struct sights *had)
{
    struct traced *const t = state_of(f);
    const int n_ghosts = f->setup->n_ghosts;
    enum glint_status status;

    if ((int64_t)n * n_ghosts * f->setup->n_wavelengths > INT_MAX)
        return GLINT_E_MEMORY;
    status = gather(t, lamps, n, f->lights.given, f->lights.n_given);
    if (status == GLINT_OK && (int64_t)t->n_patches * n_ghosts > INT_MAX / 2)
        status = GLINT_E_MEMORY;
    if (status == GLINT_OK)
        status = set_fields(t, had, n_ghosts);
    if (status != GLINT_OK)
        return status;
    if (count_unknown(f) > 0)
        run(f, t->n_patches * n_ghosts, look_job, 0, GLINT_FRAME_FOUND);
    list_fields(f);
    return GLINT_OK;
}

/* Finds the fields of LAMPS. */
static enum glint_status look(struct glint_frame *f,
                              const struct glint_lamp *lamps, int n)
{
    struct traced *const t = state_of(f);
    const struct glint_setup *s = f->setup;
    struct ray_field_config cfg = {.setup = s,
                                   .view = f->view,
                                   .round =
                                       glint_prescription_is_round(s->lens),
                                   .max_cells = f->dials.fineness,
                                   .uniform = f->picture.uniform};
    enum glint_status status = GLINT_OK;
    struct sights had;

    set_waves(t, s, &cfg);
    take_sights(t, &cfg, &had);
    forget(t);
    t->cfg = cfg;
    t->optics = s->optics;
    t->n_ghosts = s->n_ghosts;
    if (n > 0)
        status = look_at(f, lamps, n, &had);
    if (status != GLINT_OK)
        forget(t);
    free(had.patch);
    free(had.field);
    return status;
}

/* Skips ghosts that no pixel shows: by the most light that all points may give
 * a pixel together. */
static enum glint_status skip_faint(struct glint_frame *f, double scale,
                                    double faintest)
{
    struct traced *const t = state_of(f);
    const double pixel = f->view.sensor_width_mm / f->view.width;
    double *peak;

    if (!(faintest > 0))
        return GLINT_OK;
    peak = calloc((size_t)f->setup->n_ghosts, sizeof *peak);
    if (!peak)
        return GLINT_E_MEMORY;
    for (int i = 0; i < t->n_fields; i++) {
        double all, most;

        sum_light(f, i, 0, &all, &most);
        peak[t->field[i].ghost] +=
            scale * all * t->field[i].peak_mm2 * pixel * pixel;
    }
    for (int i = 0; i < t->n_fields; i++)
        if (peak[t->field[i].ghost] < faintest)
            t->set_of[i] = -1;
    free(peak);
    return GLINT_OK;
}

/* Returns whether field I is drawn from point P. */
static bool is_drawn_from(const struct traced *t, int i, int p)
{
    return &t->patch[t->point[p].patch] == t->field[i].patch &&
           t->point[p].first <= t->level[i] && t->point[p].last >= t->level[i];
}

/* Chooses the samples of field I for the points and wavelengths that it is
 * drawn from: fewer than for its whole patch. */
static void choose_samples(struct traced *t, int i)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    const struct wave_set *const set = &t->set[t->set_of[i]];
    struct ray_patch range;

    for (int p = 0; p < t->n_points; p++)
        if (is_drawn_from(t, i, p))
            include_point(&t->point[p], low, high);
    range = make_patch(t, t->field[i].patch->phi_deg, low, high);
    glint_ray_field_choose(&t->field[i], &range, set->nm, set->n);
}

/* Lists the bundles that reach the picture: of each field by wavelength. */
static enum glint_status list_bundles(struct glint_frame *f)
{
    struct traced *const t = state_of(f);
    size_t n = 0;

    for (int pass = 0; pass < 2; pass++) {
        n = 0;
        for (int i = 0; i < t->n_fields; i++)
            for (int w = 0; t->set_of[i] >= 0 && w < t->set[t->set_of[i]].n;
                 w++)
                for (int p = 0; p < t->n_points; p++) {
                    if (!is_drawn_from(t, i, p) ||
                        !in_view(f, &t->field[i], turn_of(t, &t->point[p])))
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

static enum glint_status set_scale(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   struct glint_frame_scale *scale)
{
    enum glint_status status = GLINT_OK;
    double brightest = 0, together = 0;
    const struct traced *t;

    *scale = (struct glint_frame_scale){0, 0};
    if (!frame->memory.traced)
        frame->memory.traced = calloc(1, sizeof *t);
    t = frame->memory.traced;
    status = t ? look(frame, lamps, n_lamps) : GLINT_E_MEMORY;
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < t->n_fields; i++) {
        double all, most;

        sum_light(frame, i, 0, &all, &most);
        brightest = fmax(brightest, most * t->field[i].flux /
                                        pixels_of(frame, &t->field[i]));
        together += all * box_flux(&t->field[i]) * t->set[0].n;
    }
    if (brightest > 0)
        *scale = glint_frame_compute_scale((int)ceil(log2(brightest)),
                                           (int)ceil(log2(together)));
    return GLINT_OK;
}

/* -------------------------------------------------------------------- trace */

static size_t most_bytes(const struct glint_frame *f)
{
    const size_t most = f->limits.most_bytes / 2;

    return most && most < MOST_BYTES ? most : MOST_BYTES;
}

static void trace_job(void *ctx, int job, int worker)
{
    const struct job *j = ctx;
    struct traced *t = state_of(j->frame);
    const int i = j->first + job;

    (void)worker;
    if (t->mem[i])
        glint_ray_field_trace(&t->cfg, &t->field[i], t->mem[i]);
}

/* Takes memory for as many fields as have room, and for workers. */
static enum glint_status hold_fields(struct glint_frame *f)
{
    struct traced *const t = state_of(f);
    size_t left = most_bytes(f), largest = 0;

    t->n_workers = glint_workers_count(f->cfg.workers);
    t->worker = calloc((size_t)t->n_workers, sizeof *t->worker);
    if (!t->worker)
        return GLINT_E_MEMORY;
    for (int i = 0; i < t->n_fields; i++) {
        const size_t bytes = t->set_of[i] >= 0
                                 ? glint_ray_field_bytes(&t->cfg, &t->field[i])
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

/* Draws field I, whose points give LIGHT each per unit of their own in the
 * mean, from fewer points and by a coarser grid as far as that does not show in
 * codes: a point gives less than half of STEP, and errors of faint light
 * shrink, in codes, by 2^(5/12) with each octave. Compare plan_cells.c. */
static void coarsen(struct glint_frame *f, int i, double light, double step)
{
    struct traced *const t = state_of(f);
    struct ray_field *r = &t->field[i];
    double all, most, brightness;

    while (t->level[i] < LEVELS) {
        sum_light(f, i, t->level[i] + 1, &all, &most);
        if (!(light * most < 0.5 * step))
            break;
        t->level[i]++;
    }
    sum_light(f, i, t->level[i], &all, &most);
    brightness = light * most * (r->folds ? 16 : 1);
    if (brightness < 1)
        glint_ray_field_coarsen(&t->cfg, r,
                                exp2(5.0 / 24 * fmax(log2(brightness), -12)));
}

/* Plans a frame of LAMPS times SCALE for IMAGE, and traces its rays. */
static enum glint_status plan(struct glint_frame *f,
                              const struct glint_lamp *lamps, int n,
                              double scale, const struct glint_image *image)
{
    struct traced *const t = state_of(f);
    const double step =
        glint_frame_convert_codes_to_light(f, image, GLINT_FRAME_STEP_CODES);
    enum glint_status status = look(f, lamps, n);

    if (status != GLINT_OK)
        return status;
    t->set_of = calloc((size_t)t->n_fields + 1, sizeof *t->set_of);
    t->level = calloc((size_t)t->n_fields + 1, sizeof *t->level);
    t->mem = calloc((size_t)t->n_fields + 1, sizeof *t->mem);
    if (!t->set_of || !t->mem || !t->level)
        return GLINT_E_MEMORY;
    t->in_codes = is_planned_for_codes(f, image);
    list_fields(f);
    status = skip_faint(
        f, scale,
        glint_frame_convert_codes_to_light(f, image, f->dials.cull_codes));
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < t->n_fields; i++) {
        struct ray_field *r = &t->field[i];
        double all, most, light;

        if (t->set_of[i] < 0)
            continue;
        light = scale * r->flux / pixels_of(f, r);
        sum_light(f, i, 0, &all, &most);
        t->set_of[i] = choose_set(f, r, light * most, step);
        if (t->in_codes)
            coarsen(f, i, light, step);
        choose_samples(t, i);
    }
    status = list_bundles(f);
    return status == GLINT_OK ? hold_fields(f) : status;
}

/* Begins bundle I: for struct glint_flare_rays. */
static int open_bundle(void *ctx, int worker, int i, int y0, int y1)
{
    const struct glint_frame *f = ctx;
    struct traced *t = state_of(f);
    struct at_work *w = &t->worker[worker];
    struct ray_bundle *b = &t->bundle[i];
    const struct point *p = &t->point[b->point];
    const void *mem = t->mem[b->field];

    if (b->low <= b->high && (b->high < (float)y0 || b->low > (float)y1))
        return 0;
    if (!mem && w->in_mem != b->field) {
        glint_ray_field_trace(&t->cfg, &t->field[b->field], w->mem);
        w->in_mem = b->field;
    }
    w->bundle = b;
    w->low = HUGE_VALF;
    w->high = -HUGE_VALF;
    glint_ray_place_set(&w->place, &t->field[b->field], mem ? mem : w->mem,
                        p->at, t->set[t->set_of[b->field]].nm[b->wave],
                        turn_of(t, p));
    return 1;
}

static void row_of(void *ctx, int worker, int j, struct glint_vertex *row)
{
    const struct glint_frame *f = ctx;
    struct traced *t = state_of(f);
    struct at_work *w = &t->worker[worker];
    const int n = w->place.field->n_cells;

    glint_ray_place_row(&t->cfg, &w->place, j, row);
    for (int i = 0; i <= n; i++)
        if (row[i].energy_q16 >= 0) {
            const float y = (float)row[i].y_q8 / 256;

            w->low = y < w->low ? y : w->low;
            w->high = y > w->high ? y : w->high;
        }
    if (j == n) { /* cells may reach a pixel farther than their corners */
        w->bundle->low = w->low - 2;
        w->bundle->high = w->high + 2;
    }
}

/* Fills BUNDLE from bundle B of the frame, whose light is multiplied by
 * SCALE. */
static void make_bundle(const struct glint_frame *f, const struct ray_bundle *b,
                        double scale, struct glint_bundle *bundle)
{
    const struct traced *t = state_of(f);
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

/* Takes a block for the capacities of F and adds all bundles to it. */
static enum glint_status begin_flare(struct glint_frame *f, double scale)
{
    struct traced *const t = state_of(f);
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
    t->rays =
        (struct glint_flare_rays){open_bundle, row_of, f, t->in_codes,
                                  t->in_codes ? f->dials.snap_codes_q8 : 0};
    glint_flare_begin_rays(f->memory.flare, &t->rays);
    for (int i = 0; i < t->n_bundles; i++) {
        struct glint_bundle bundle;

        make_bundle(f, &t->bundle[i], scale, &bundle);
        glint_flare_add(f->memory.flare, &bundle);
    }
    return GLINT_OK;
}

/* Sets the capacities for N edges and REFS references. */
static size_t bytes_for(struct glint_frame *f, double n, double refs)
{
    f->cfg.max_primitives = (int)fmin(INT_MAX, n);
    f->cfg.max_refs = (int)fmin(INT_MAX, refs);
    return glint_flare_bytes(&f->cfg);
}

static bool has_capacity(const struct glint_frame *f,
                         const struct glint_flare_stats *s)
{
    return s->need_primitives <= f->cfg.max_primitives &&
           s->need_refs <= f->cfg.max_refs;
}

/* Gives the flare more room for what S needs, as much as it may take unless
 * ANYWAY. Returns whether there is more than before. */
static bool widen(struct glint_frame *f, const struct glint_flare_stats *s,
                  bool anyway)
{
    const int had = f->cfg.max_primitives, refs_had = f->cfg.max_refs;
    /* A row of tiles cannot be divided: it gets more until it is drawn. */
    const double least = anyway ? 1.25 * had + 1024 : had;
    const double least_refs = anyway ? 1.25 * refs_had + 1024 : refs_had;
    /* Workers' shares are never quite even. */
    const double uneven = glint_workers_count(f->cfg.workers) > 1 ? 1.5 : 1;
    double part = 1;

    while (bytes_for(f,
                     fmax(least, part * (uneven * s->need_primitives + 1024)),
                     fmax(least_refs, part * (s->need_refs + 1024.0))) >
               most_bytes(f) &&
           !anyway && part > 1e-3)
        part *= 0.9;
    return f->cfg.max_primitives > had || f->cfg.max_refs > refs_had;
}

/* Bins rows Y0 .. Y1 - 1. */
static void bin_rows(struct glint_frame *f, int y0, int y1,
                     struct glint_flare_stats *s)
{
    glint_flare_set_rows(f->memory.flare, y0, y1);
    glint_flare_bin(f->memory.flare, s);
}

/* Returns how many rows, whole tiles, to draw from Y0 on, where N rows need
 * what S says. */
static int fewer_rows(const struct glint_frame *f, int n,
                      const struct glint_flare_stats *s)
{
    const int side = 1 << f->cfg.tile_log2;
    const double part =
        fmin((double)f->cfg.max_primitives / max_int(s->need_primitives, 1),
             (double)f->cfg.max_refs / max_int(s->need_refs, 1));

    return max_int(min_int((int)(0.8 * part * n), n - 1) / side, 1) * side;
}

static void add_stats(struct glint_flare_stats *all,
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

/* Bins and draws all rows of IMAGE, as many at a time as have room. */
static enum glint_status draw_rows(struct glint_frame *f, double scale,
                                   const struct glint_image *image,
                                   struct glint_flare_stats *stats)
{
    const int height = f->view.height, side = 1 << f->cfg.tile_log2;
    enum glint_status status = GLINT_OK;
    int rows = height;

    for (int y0 = 0; y0 < height && status == GLINT_OK;) {
        const int n = min_int(rows, height - y0);
        struct glint_flare_stats s;

        bin_rows(f, y0, y0 + n, &s);
        if (!has_capacity(f, &s) || s.dropped_bundles) {
            const bool more = widen(f, &s, n <= side);

            if (more)
                status = begin_flare(f, scale);
            if (!more || !has_capacity(f, &s))
                rows = fewer_rows(f, n, &s);
            continue;
        }
        glint_frame_draw_passes(f, image);
        add_stats(stats, &s);
        y0 += n;
        if (f->progress)
            f->progress(f->progress_ctx, TRACED + (1 - TRACED) * y0 / height);
    }
    return status;
}

static enum glint_status draw(struct glint_frame *frame,
                              const struct glint_lamp *lamps, int n_lamps,
                              double scale, const struct glint_image *image,
                              struct glint_flare_stats *stats, double times[5])
{
    struct glint_flare_stats expected = {0};
    enum glint_status status;
    struct traced *t;

    times[0] = read_frame_clock(frame);
    if (!frame->memory.traced)
        frame->memory.traced = calloc(1, sizeof *t);
    t = frame->memory.traced;
    status = t ? plan(frame, lamps, n_lamps, scale, image) : GLINT_E_MEMORY;
    if (status != GLINT_OK)
        return status;
    times[1] = read_frame_clock(frame);
    run(frame, t->n_fields, trace_job, GLINT_FRAME_FOUND, TRACED);
    times[2] = times[3] = read_frame_clock(frame);
    expected.need_primitives = (int)fmin(EDGES * t->n_bundles, INT_MAX);
    expected.need_refs = expected.need_primitives;
    *stats = (struct glint_flare_stats){0};
    frame->cfg.max_bundles = max_int(t->n_bundles, 1);
    frame->cfg.max_vertices = 0;
    frame->cfg.max_primitives = max_int(frame->cfg.max_primitives, 1 << 13);
    frame->cfg.max_refs = max_int(frame->cfg.max_refs, 1 << 14);
    widen(frame, &expected, false);
    status = begin_flare(frame, scale);
    if (status == GLINT_OK)
        status = draw_rows(frame, scale, image, stats);
    times[4] = read_frame_clock(frame);
    return status;
}

static int n_bundles(const struct glint_frame *frame)
{
    return state_of(frame)->n_bundles;
}

static int ghost(const struct glint_frame *frame, int bundle)
{
    const struct traced *const t = state_of(frame);

    return t->field[t->bundle[bundle].field].ghost;
}

static void finish(struct glint_frame *frame)
{
    if (frame->memory.traced)
        forget(frame->memory.traced);
    free(frame->memory.traced);
    frame->memory.traced = NULL;
}

static void adopt(struct glint_frame *frame, struct glint_frame *from)
{
    finish(frame);
    frame->memory.traced = from->memory.traced;
    from->memory.traced = NULL;
}

const struct glint_frame_rays glint_frame_traces = {draw,  set_scale, n_bundles,
                                                    ghost, finish,    adopt};
