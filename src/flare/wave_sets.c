/* SPDX-License-Identifier: MIT */
#include "flare/wave_sets.h"

#include "base/q.h"
#include "base/real.h"

enum { UNSEEN = -1, ROWS = 3, FARTHEST_Q8 = 1 << 25 };

/* A job of the plan: one pair of a ghost and a light. Jobs are stored in the
 * array slot of the flare, which is unused until ray bundles have their final
 * indices. */
struct job {
    int ghost, light;
    int set;      /* index of the chosen wavelength set; UNSEEN if the ghost is
                     invisible */
    int peak_q20; /* sum of peak_q20 (see struct glint_bundle_plan) over all
                     wavelengths, at most 2^20 */
    int first;    /* index of the job's first ray bundle */
};

typedef char
    glint_job_fits[sizeof(struct job) <= sizeof(struct glint_bundle_slot) ? 1
                                                                          : -1];

static struct job *get_job_array(struct glint_flare *f)
{
    return (struct job *)(void *)f->slot;
}

/* Returns the index of the first wavelength of set SET in the list of the
 * wavelengths of all sets. */
static int find_first_wave_of_set(const struct glint_wave_sets *sets, int set)
{
    int first = 0;

    for (int s = 0; s < set; s++)
        first += sets->size[s];
    return first;
}

int glint_wave_sets_find_set_of_wave(const struct glint_wave_sets *sets,
                                     int wave)
{
    int set = 0;

    for (; set < sets->n_sets - 1 && wave >= sets->size[set]; set++)
        wave -= sets->size[set];
    return set;
}

/* --------------------------------------------------------- choice of a set */

/* Sets AT to the positions, pixels, at which sample rays of PLANNED hit the
 * picture. The rays are spread evenly over half of the ray bundle's window. */
static void trace_sample_rays(const struct glint_plan *plan,
                              const struct glint_bundle_plan *planned,
                              struct glint_transfer *t,
                              int32_t at_q8[ROWS][2][GLINT_RAYS])
{
    const int32_t one_q30 = INT32_C(1) << 30;
    const struct glint_real scale =
        glint_plan_map_sensor_to_picture(plan, planned).pixels_per_mm;

    glint_plan_set_transfer(plan, planned, t);
    for (int row = 0; row < ROWS; row++) {
        const int32_t v_q30 = glint_transfer_v(t, 2 * row + 1, 2 * ROWS);
        int32_t u_q30[GLINT_RAYS], out[GLINT_OUT_KINDS][GLINT_RAYS];

        for (int i = 0; i < GLINT_RAYS; i++)
            u_q30[i] = glint_transfer_u(
                t, (2 * i + 1) * (one_q30 / GLINT_RAYS) - one_q30);
        glint_transfer_rays(t, v_q30, u_q30, 1, out);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < GLINT_RAYS; i++)
                at_q8[row][k][i] = q_narrow(real_integer(
                    real_times(real_of(out[GLINT_OUT_SENSOR_X + k][i],
                                       t->exponent[GLINT_OUT_SENSOR_X + k]),
                               scale),
                    8, FARTHEST_Q8));
    }
}

/* Returns the distance between the ghosts of LIGHT and of its neighbours,
 * pixels, if LIGHT is a sample point of a wide lamp; otherwise 0. A ghost moves
 * with its light in proportion to the ghost's distance from the picture's
 * centre. AT: positions of sample rays of the ghost. */
static int64_t compute_ghost_spacing_q8(const struct glint_light *light,
                                        int32_t at_q8[ROWS][2][GLINT_RAYS])
{
    int64_t x = 0, y = 0;

    if (light->apart_q30 <= 0 || light->sine_q30 <= 0)
        return 0;
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < GLINT_RAYS; i++) {
            x += at_q8[row][0][i];
            y += at_q8[row][1][i];
        }
    return real_integer(
        real_times(
            real_times(real_of(q_root((uint64_t)(x * x + y * y)), 0),
                       real_of(light->apart_q30, -30)),
            real_over(
                real_of(light->cosine_q30, -30),
                real_of((int64_t)light->sine_q30 * ROWS * GLINT_RAYS, -30))),
        0, FARTHEST_Q8);
}

/* Returns the distance between the outlines of a ghost in two wavelengths,
 * pixels. FIRST and LAST are the ray bundles of the outermost wavelengths of
 * the first set. The distance is the root mean square over pairs of rays at the
 * same point of the pupil. Sets *SPACING to the distance of the ghosts of
 * neighbouring points of the lamp. */
static int64_t
compute_outline_distance_q8(const struct glint_plan *plan,
                            const struct glint_bundle_plan *first,
                            const struct glint_bundle_plan *last,
                            struct glint_transfer *t, int64_t *spacing_q8)
{
    int32_t a_q8[ROWS][2][GLINT_RAYS], b_q8[ROWS][2][GLINT_RAYS];
    /* sum of 24 squares of x and 24 squares of y, each at most 2^52 */
    uint64_t squares = 0;

    trace_sample_rays(plan, first, t, a_q8);
    trace_sample_rays(plan, last, t, b_q8);
    *spacing_q8 = compute_ghost_spacing_q8(&plan->light[first->light], a_q8);
    for (int row = 0; row < ROWS; row++)
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < GLINT_RAYS; i++) {
                const int64_t d = (int64_t)a_q8[row][k][i] - b_q8[row][k][i];

                squares += (uint64_t)(d * d);
            }
    return q_root(squares / (ROWS * GLINT_RAYS));
}

/* Returns the range of 1 / wavelength^2, um^-2, that wavelength set SET
 * covers. */
static int64_t compute_wave_set_width(const struct glint_flare_frame *r,
                                      int set)
{
    const struct glint_wave *w = r->wave + find_first_wave_of_set(r->sets, set);
    const int32_t span = w[r->sets->size[set] - 1].wave_q24 - w[0].wave_q24;

    return span < 0 ? -span : span;
}

/* Returns whether set SET has enough wavelengths for a ghost of total light
 * LIGHT: the steps of brightness from wavelength to wavelength are invisible.
 * With n wavelengths, steps are invisible if LIGHT / (2 n) is below s->step, or
 * if the outlines of neighbouring wavelengths are at most MOST apart. APART:
 * distance between the outermost outlines of the first set. Both are in pixels
 * _q8. */
static int are_wave_steps_invisible(const struct glint_flare_frame *r, int set,
                                    int64_t apart, int64_t most,
                                    struct glint_real light)
{
    const struct glint_wave_sets *s = r->sets;
    const int64_t gaps = s->size[set] - 1;
    const struct glint_real step =
        real_over(light, real_of(s->size[set], 1)); /* LIGHT / (2 n) */

    return real_less(step, s->step) ||
           apart * compute_wave_set_width(r, set) <=
               most * gaps * compute_wave_set_width(r, 0);
}

/* Returns the index of the smallest wavelength set that draws a ghost without
 * visible steps of brightness, or of the last set if none does. PLANNED and
 * BUNDLE are the ghost's ray bundles of the first set. */
static int choose_smallest_wave_set(const struct glint_plan *plan,
                                    const struct glint_bundle_plan *planned,
                                    const struct glint_bundle *bundle,
                                    struct glint_transfer *t)
{
    const struct glint_flare_frame *r = plan->frame;
    const int n = r->sets->size[0];
    const int both = bundle[0].n_cells && bundle[n - 1].n_cells;
    struct glint_real light = {0, 0};
    int set = 0;

    for (int i = 0; i < n; i++)
        if (bundle[i].n_cells)
            light = real_plus(light, planned[i].irradiance);
    if (r->sets->n_sets > 1 &&
        !are_wave_steps_invisible(r, 0, FARTHEST_Q8, 0, light)) {
        int64_t spacing = 0;
        const int64_t apart =
            both ? compute_outline_distance_q8(plan, &planned[0],
                                               &planned[n - 1], t, &spacing)
                 : FARTHEST_Q8;
        const int64_t most =
            spacing > r->sets->apart_q8 ? spacing : r->sets->apart_q8;

        while (set < r->sets->n_sets - 1 &&
               !are_wave_steps_invisible(r, set, apart, most, light))
            set++;
    }
    return set;
}

/* -------------------------------------------------------------------- jobs */

static void plan_waves_of_set(struct glint_flare *f, const struct job *job,
                              int at, int set,
                              struct glint_plan_scratch *scratch)
{
    const struct glint_wave_sets *sets = f->plan.frame->sets;
    const int first = find_first_wave_of_set(sets, set);

    for (int i = 0; i < sets->size[set]; i++) {
        f->planned[at + i] = (struct glint_bundle_plan){
            .ghost = job->ghost, .light = job->light, .wave = first + i};
        glint_plan_bundle(&f->plan, &f->plan.light[job->light],
                          &f->planned[at + i], &f->bundle[at + i], scratch);
    }
}

/* Worker function: plans job NUMBER with the wavelengths of the first set, and
 * chooses the smallest sufficient set. */
static void plan_first_set_job(void *ctx, int number, int worker)
{
    struct glint_flare *f = ctx;
    struct job *job = &get_job_array(f)[number];
    const struct glint_flare_frame *r = f->plan.frame;
    const int n_ghosts = (int)r->lens->header->n_ghosts;
    const int n = r->sets->size[0], at = number * n;
    int64_t peak_q20 = 0;

    *job = (struct job){
        .ghost = number % n_ghosts, .light = number / n_ghosts, .set = UNSEEN};
    plan_waves_of_set(f, job, at, 0, f->worker[worker].plan);
    for (int i = 0; i < n; i++)
        if (f->bundle[at + i].n_cells) {
            job->set = 0;
            peak_q20 += f->planned[at + i].peak_q20;
        }
    job->peak_q20 = (int)q_clamp_sat(peak_q20, 0, 1 << 20);
    if (job->set == 0)
        job->set =
            choose_smallest_wave_set(&f->plan, &f->planned[at], &f->bundle[at],
                                     &f->worker[worker].plan->transfer);
}

static void plan_chosen_set_job(void *ctx, int number, int worker)
{
    struct glint_flare *f = ctx;
    const struct job *job = &get_job_array(f)[number];

    if (job->set > 0)
        plan_waves_of_set(f, job, job->first, job->set, f->worker[worker].plan);
}

/* Sets the wavelength set of jobs to UNSEEN if their ghost is invisible: the
 * sum of its peaks over all lights is too faint. */
static void remove_invisible_ghosts(struct glint_flare *f, int n)
{
    const int n_ghosts = (int)f->plan.frame->lens->header->n_ghosts;
    struct job *job = get_job_array(f);

    for (int ghost = 0; ghost < n_ghosts && ghost < n; ghost++) {
        int64_t sum_q20 = 0;

        for (int i = ghost; i < n; i += n_ghosts)
            sum_q20 += job[i].set == UNSEEN ? 0 : job[i].peak_q20;
        for (int i = ghost; i < n && sum_q20 < 1 << 20; i += n_ghosts)
            job[i].set = UNSEEN;
    }
}

/* Moves N ray bundles and their plans from index FROM to index TO. The ranges
 * may overlap. */
static void move_planned_bundles(struct glint_flare *f, int from, int to, int n)
{
    for (int i = 0; i < n && from != to; i++) {
        const int k = to > from ? n - 1 - i : i;

        f->planned[to + k] = f->planned[from + k];
        f->bundle[to + k] = f->bundle[from + k];
    }
}

/* Removes the jobs of invisible ghosts (set UNSEEN) from N jobs, and their ray
 * bundles, and closes the gaps. Returns the number of jobs left. */
static int compact_visible_jobs(struct glint_flare *f, int n)
{
    const int size = f->plan.frame->sets->size[0];
    struct job *job = get_job_array(f);
    int kept = 0;

    for (int i = 0; i < n; i++)
        if (job[i].set != UNSEEN) {
            job[kept] = job[i];
            move_planned_bundles(f, i * size, kept++ * size, size);
        }
    return kept;
}

/* Assigns ray bundle indices to the wavelengths of the chosen set of each of N
 * jobs. If the set of a job does not fit into max_bundles, the job gets the
 * first set. Returns the number of bundles. Sets *NEED to the number that all
 * chosen sets would need. */
static int assign_bundle_indices(struct glint_flare *f, int n, int64_t *need)
{
    const int *size = f->plan.frame->sets->size;
    struct job *job = get_job_array(f);
    int total = 0;

    *need = 0;
    for (int i = 0; i < n; i++) {
        const int rest = (n - i - 1) * size[0];

        *need += size[job[i].set];
        if (size[job[i].set] > f->cfg.max_bundles - rest - total)
            job[i].set = 0;
        job[i].first = total;
        total += size[job[i].set];
    }
    for (int i = n - 1; i >= 0; i--)
        if (job[i].set == 0)
            move_planned_bundles(f, i * size[0], job[i].first, size[0]);
    return total;
}

static int plan_ghosts_with_wave_sets(struct glint_flare *flare, int n_jobs)
{
    struct glint_flare_stats *s = &flare->stats;
    const int size = flare->plan.frame->sets->size[0];
    const int most = flare->cfg.max_bundles / size;
    int n = n_jobs < most ? n_jobs : most, total = 0;
    int64_t need = 0, least = (int64_t)n_jobs * size;

    s->dropped_bundles =
        q_narrow(q_clamp_sat((int64_t)(n_jobs - n) * size, 0, INT32_MAX));
    if (n > 0) {
        glint_workers_run(flare->cfg.workers, n, plan_first_set_job, flare);
        remove_invisible_ghosts(flare, n);
        n = compact_visible_jobs(flare, n);
        total = assign_bundle_indices(flare, n, &need);
    }
    if (n > 0)
        glint_workers_run(flare->cfg.workers, n, plan_chosen_set_job, flare);
    least = least > need ? least : need;
    s->need_bundles = q_narrow(q_clamp_sat(least, 0, INT32_MAX));
    return total;
}

const struct glint_wave_planner glint_wave_planner = {
    plan_ghosts_with_wave_sets};
