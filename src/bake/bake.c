/* SPDX-License-Identifier: MIT
 *
 * Bakes a lens table into a model: fits polynomials to every ghost, quantises
 * them to integers, proves that these cannot overflow, writes the file and
 * measures its errors.
 */
#include "glint/bake.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/effort.h"
#include "bake/fit/fit.h"
#include "bake/model_header.h"
#include "bake/skew/skew_fit.h"
#include "bake/trace/cells.h"
#include "bake/write_model.h"

/* the state of one bake */
struct bake_run {
    const struct glint_prescription *lens;
    struct glint_bake_options options;
    struct glint_setup setup;
    struct glint_setup beside[GLINT_MAX_BESIDE];
    struct glint_brightness brightness;
    /* fitted polynomials of each ghost, [n_ghosts] */
    struct glint_fitted_ghost *fitted;
    /* integer polynomials, [n_ghosts][n_systems] */
    struct glint_quantised_system **quantised;
    /* status of the current step (fitting or quantising) for each ghost */
    enum glint_status *status;
    struct glint_draft draft;
    /* index in the model of the first system of each ghost */
    int *first;
    /* number of rays of each ghost that the real lens blocks and the model
     * transmits, see struct glint_bake_report */
    int *intruders;
    int *rays;
    struct glint_effort effort; /* progress estimate; only worker 0 writes it */
    struct glint_error *error;
};

/* --------------------------------------------------------------------- jobs */

/* Allocates tables that state from which directions GHOST is visible: one for
 * this zoom position and one for each of the first N neighbouring positions.
 * The caller frees them. Returns NULL if there is no memory. */
static struct glint_visible *allocate_visibility(const struct bake_run *run,
                                                 int ghost, int n)
{
    struct glint_visible *const v = calloc((size_t)n + 1, sizeof *v);

    for (int k = 0; v && k <= n; k++) {
        glint_visible_init(
            &v[k], k ? &run->beside[k - 1] : &run->setup, ghost,
            glint_bake_get_field_radius_mm(run->lens, &run->options),
            run->options.band_nm);
        glint_visible_set_max_angle(&v[k], run->options.max_deg);
    }
    if (v) {
        v->beside = v + 1;
        v->n_beside = n;
    }
    return v;
}

static enum glint_status quantise_ghost(struct bake_run *run, int ghost)
{
    const struct glint_fitted_ghost *f = &run->fitted[ghost];
    enum glint_status status = GLINT_OK;
    struct glint_quantised_system *system =
        calloc((size_t)f->n_systems + 1, sizeof *system);

    if (!system)
        return GLINT_E_MEMORY;
    run->quantised[ghost] = system;
    for (int i = 0; i < f->n_systems && status == GLINT_OK; i++)
        status = glint_quantise_system(&f->system[i], &system[i]);
    return status;
}

/* progress of the bake after fitting and after quantising, 0 .. 1 */
#define FITTED    0.96
#define QUANTISED 0.97

static void report_bake_progress(struct bake_run *run)
{
    const struct glint_bake_options *o = &run->options;

    if (o->progress)
        o->progress(o->progress_ctx,
                    FITTED * glint_effort_estimate_progress(&run->effort));
}

/* context of report_fit_work() for one ghost */
struct fit_report {
    struct bake_run *run;
    bool shows_progress; /* true: this worker reports progress */
    double work;         /* work reported by the last call, in zone fits */
};

/* Records progress for a ghost: WORK, the number of zone fits done so far, and
 * SHARE, the fraction of the ghost's angles that are finished. Returns
 * GLINT_E_UNSUPPORTED, without an error text, if the caller's allow() denies
 * more work. */
static enum glint_status report_fit_work(void *ctx, double work, double share)
{
    struct fit_report *const r = ctx;
    const struct glint_bake_options *const o = &r->run->options;
    const int more = (int)(work - r->work);

    r->work = work;
    if (r->shows_progress) {
        glint_effort_record_work(&r->run->effort, work, share);
        report_bake_progress(r->run);
    }
    return !o->allow || o->allow(o->allow_ctx, more) ? GLINT_OK
                                                     : GLINT_E_UNSUPPORTED;
}

/* Factor on all tolerances of lenses that are not round. Light directions then
 * have two components. The tolerances of round lenses would then require many
 * times as many systems to avoid errors of tenths of a pixel. */
#define SKEW_TOLERANCE 1.5

/* Factor on the energy tolerance of lenses that are not round. Smaller than
 * SKEW_TOLERANCE because dividing the band reduces energy errors at little
 * cost. */
#define SKEW_ENERGY 0.7

static enum glint_status fit_ghost(struct bake_run *run, int ghost,
                                   bool shows_progress)
{
    const bool round = glint_prescription_is_round(run->lens);
    const double film = run->lens->film_width_mm;
    const double t = run->options.tolerance * (round ? 1 : SKEW_TOLERANCE);
    const struct glint_tolerance tolerance = {
        .sensor_mm = 0.04 * t * film / 1920,
        .faint_sensor_mm = 0.07 * t * film / 1920,
        .edge_mm = 0.04 * t * film / 1920,
        .stop = 4.5e-4 * t,
        /* The min tolerance is 1/16 of the max tolerance .stop. It is smaller
         * for lenses faster than GLINT_WIDE, because their model is also used
         * for all smaller stops. */
        .stop_least = 2.7e-5 * t * fmin(1, run->lens->f_number / GLINT_WIDE),
        .barrel = 4e-4 * t,
        .escape = 1e-3 * t,
        .energy = 1.2e-3 * (round ? t : SKEW_ENERGY * run->options.tolerance),
        .ease = 10,
        .pixel_mm = film / 1920,
        .axis = fmin(1, t),
        .axis_depth = (int)fmin(GLINT_MAX_AXIS_DEPTH,
                                GLINT_PART_DEPTH + fmax(0, ceil(-log2(t)))),
        .brightness = &run->brightness};
    enum glint_status (*const fit)(
        const struct glint_visible *, double, const struct glint_tolerance *,
        glint_fit_progress_fn *, void *, struct glint_fitted_ghost *) =
        round ? glint_fit_ghost : glint_skew_fit_ghost;
    struct glint_visible *const visible =
        allocate_visibility(run, ghost, run->options.n_beside);
    struct fit_report report = {run, shows_progress, 0};
    const enum glint_status status =
        visible ? fit(visible, run->options.max_deg, &tolerance,
                      report_fit_work, &report, &run->fitted[ghost])
                : GLINT_E_MEMORY;

    free(visible);
    return status;
}

/* Fits ghost GHOST as a job of WORKER; worker 0 reports progress. */
static void run_fit_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;

    const struct glint_bake_options *const o = &run->options;

    if (o->allow && !o->allow(o->allow_ctx, 0)) {
        run->status[ghost] = GLINT_E_UNSUPPORTED;
        return;
    }
    if (worker == 0)
        glint_effort_begin_ghost(&run->effort, ghost);
    run->status[ghost] = run->options.ghosts && !run->options.ghosts[ghost]
                             ? GLINT_OK
                             : fit_ghost(run, ghost, worker == 0);
    if (worker != 0)
        return;
    glint_effort_end_ghost(&run->effort);
    report_bake_progress(run);
}

static void run_quantise_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;
    (void)worker;
    run->status[ghost] = quantise_ghost(run, ghost);
}

static void run_measure_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;
    const struct glint_lens lens = glint_draft_get_lens(&run->draft);
    struct glint_visible *const visible = allocate_visibility(run, ghost, 0);

    (void)worker;
    run->status[ghost] = GLINT_E_MEMORY;
    if (!visible)
        return;
    for (int i = 0; i < run->fitted[ghost].n_systems; i++) {
        struct glint_measured m;

        glint_measure_system_errors(visible, &lens, run->first[ghost] + i,
                                    &run->fitted[ghost].system[i], &m);
        glint_draft_write_errors(&run->draft, run->first[ghost] + i, &m);
        run->intruders[ghost] += m.intruders;
        run->rays[ghost] += m.rays;
    }
    run->status[ghost] = GLINT_OK;
    free(visible);
}

/* Context of a loop that runs one short job per ghost. */
struct round {
    struct bake_run *run;
    glint_job_fn *job;
    double from, to;
    int most; /* largest ghost index that worker 0 has finished */
};

/* Runs JOB for one ghost. Worker 0 reports progress. */
static void run_ghost_job(void *ctx, int job, int worker)
{
    struct round *r = ctx;
    const struct glint_bake_options *o = &r->run->options;
    const int n = r->run->setup.n_ghosts;

    r->job(r->run, job, worker);
    if (worker || !o->progress || job < r->most)
        return;
    r->most = job;
    o->progress(o->progress_ctx, r->from + (r->to - r->from) * job / n);
}

static enum glint_status find_first_ghost_error(const struct bake_run *run)
{
    for (int i = 0; i < run->setup.n_ghosts; i++)
        if (run->status[i] != GLINT_OK)
            return run->status[i];
    return GLINT_OK;
}

static enum glint_status run_jobs_for_ghosts(struct bake_run *run,
                                             glint_job_fn *job, double from,
                                             double to)
{
    struct round round = {run, job, from, to, 0};

    glint_workers_run(run->options.workers, run->setup.n_ghosts, run_ghost_job,
                      &round);
    if (run->options.progress)
        run->options.progress(run->options.progress_ctx, to);
    return find_first_ghost_error(run);
}

static enum glint_effort_kind
choose_effort_kind(const struct glint_prescription *lens)
{
    for (int k = 0; k < lens->n_surfaces; k++)
        if (glint_surface_is_shaped(&lens->surface[k]))
            return GLINT_EFFORT_SHAPED;
    return lens->f_number < GLINT_WIDE ? GLINT_EFFORT_WIDE
                                       : GLINT_EFFORT_NARROW;
}

static enum glint_status fit_ghosts(struct bake_run *run)
{
    const struct glint_bake_options *o = &run->options;
    double head, typical;

    glint_effort_init(&run->effort, run->setup.n_ghosts,
                      glint_workers_count(o->workers),
                      choose_effort_kind(run->lens));
    if (!glint_prescription_is_round(run->lens)) {
        glint_skew_estimate_work(run->lens, run->setup.n_ghosts, o->max_deg,
                                 o->tolerance, &head, &typical);
        glint_effort_set_estimates(&run->effort, head, typical);
    }
    report_bake_progress(run);
    glint_workers_run(o->workers, run->setup.n_ghosts, run_fit_job, run);
    if (o->progress)
        o->progress(o->progress_ctx, FITTED);
    return find_first_ghost_error(run);
}

/* ----------------------------------------------------------------- pipeline */

static int count_ghost_parts(const struct glint_fitted_ghost *ghost)
{
    int n = 1;

    for (int i = 0; i < ghost->n_systems; i++)
        n = ghost->system[i].part >= n ? ghost->system[i].part + 1 : n;
    return n;
}

/* Splits ghosts that enter through several separate parts of the pupil. The
 * first part remains with the ghost. Each further part becomes a new ghost at
 * the end of the list. */
static enum glint_status split_ghosts_into_parts(struct bake_run *run)
{
    struct glint_setup *s = &run->setup;
    const int n = s->n_ghosts;
    enum glint_status status = GLINT_OK;

    for (int ghost = 0; ghost < n; ghost++) {
        const int n_parts = count_ghost_parts(&run->fitted[ghost]);

        for (int part = 1; part < n_parts && status == GLINT_OK; part++) {
            if (s->n_ghosts == GLINT_MAX_GHOSTS) {
                snprintf(run->error->text, sizeof run->error->text,
                         "%s: more than %d ghosts and parts of ghosts",
                         run->lens->name, GLINT_MAX_GHOSTS);
                return GLINT_E_LENS;
            }
            s->ghost[s->n_ghosts] = s->ghost[ghost];
            status = glint_fitted_move_part(&run->fitted[ghost], part,
                                            &run->fitted[s->n_ghosts]);
            s->n_ghosts++;
            s->n_parts++;
        }
    }
    return status;
}

static enum glint_status allocate_ghost_arrays(struct bake_run *run)
{
    const size_t n = GLINT_MAX_GHOSTS;

    run->fitted = calloc(n, sizeof *run->fitted);
    run->quantised = calloc(n, sizeof *run->quantised);
    run->status = calloc(n, sizeof *run->status);
    run->first = calloc(n, sizeof *run->first);
    run->intruders = calloc(n, sizeof *run->intruders);
    run->rays = calloc(n, sizeof *run->rays);
    return run->fitted && run->quantised && run->status && run->first &&
                   run->intruders && run->rays
               ? GLINT_OK
               : GLINT_E_MEMORY;
}

static void free_ghost_arrays(struct bake_run *run)
{
    for (int g = 0; g < run->setup.n_ghosts && run->fitted && run->quantised;
         g++) {
        for (int i = 0; i < run->fitted[g].n_systems && run->quantised[g]; i++)
            glint_quantised_free_system(&run->quantised[g][i]);
        free(run->quantised[g]);
        glint_fitted_free_ghost(&run->fitted[g]);
    }
    free(run->fitted);
    free(run->quantised);
    free(run->status);
    free(run->first);
    free(run->intruders);
    free(run->rays);
    free(run->draft.data);
}

/* Checks that glint_lens_open(), which the run time calls, accepts the finished
 * model. */
static enum glint_status check_model_opens(const struct bake_run *run)
{
    struct glint_lens lens;
    const char *reason;

    if (glint_lens_open(&lens, run->draft.data, run->draft.bytes, &reason) ==
        GLINT_OK)
        return GLINT_OK;
    snprintf(run->error->text, sizeof run->error->text, "%s: %s",
             run->lens->name, reason);
    return GLINT_E_LENS;
}

static enum glint_status bake_model(struct bake_run *run)
{
    struct glint_model_header header;
    enum glint_status status = allocate_ghost_arrays(run);

    if (status == GLINT_OK)
        status = glint_model_set_header(run->lens, &run->options, &run->setup,
                                        &header);
    if (status == GLINT_OK)
        status = glint_brightness_find_levels(
            &run->brightness, &run->setup,
            glint_bake_get_field_radius_mm(run->lens, &run->options),
            run->options.max_deg, run->options.band_nm, run->options.workers);
    if (status == GLINT_OK)
        status = fit_ghosts(run);
    if (status == GLINT_OK)
        status = split_ghosts_into_parts(run);
    if (status == GLINT_OK)
        status = run_jobs_for_ghosts(run, run_quantise_job, FITTED, QUANTISED);
    if (status == GLINT_OK)
        status = glint_draft_write_model(&run->draft, &run->setup, &header,
                                         run->fitted, run->quantised);
    if (status != GLINT_OK)
        return status;
    for (int g = 1; g < run->setup.n_ghosts; g++)
        run->first[g] = run->first[g - 1] + run->fitted[g - 1].n_systems;
    status = run_jobs_for_ghosts(run, run_measure_job, QUANTISED, 1);
    if (status != GLINT_OK)
        return status;
    glint_blob_set_size_and_checksum(run->draft.data, run->draft.bytes);
    return check_model_opens(run);
}

static void compute_bake_report(const struct bake_run *run,
                                struct glint_bake_report *r)
{
    *r = (struct glint_bake_report){0, 0, 0};
    for (int g = 0; g < run->setup.n_ghosts; g++) {
        r->rays += run->rays[g];
        r->intruders += run->intruders[g];
        for (int i = 0; i < run->fitted[g].n_systems; i++)
            r->unmet += !run->fitted[g].system[i].met;
    }
}

/* Initialises setups for the neighbouring zoom positions. Rejects a position
 * that belongs to another lens. */
static enum glint_status init_neighbour_setups(struct bake_run *run,
                                               const double rgb_nm[3])
{
    const struct glint_bake_options *const o = &run->options;

    for (int k = 0; k < o->n_beside; k++) {
        const struct glint_prescription *const beside = &o->beside[k];
        enum glint_status status = GLINT_E_ARGUMENT;

        if (!glint_prescription_is_round(run->lens) ||
            beside->n_surfaces != run->lens->n_surfaces ||
            beside->stop_after != run->lens->stop_after)
            snprintf(
                run->error->text, sizeof run->error->text,
                "%s: zoom positions need a rotationally symmetric lens with "
                "the same surfaces and the same stop at all positions",
                run->lens->name);
        else
            status = glint_setup_init(&run->beside[k], beside, 0, 0, rgb_nm, 3,
                                      run->error);
        if (status != GLINT_OK)
            return status;
    }
    return GLINT_OK;
}

enum glint_status glint_bake(const struct glint_prescription *lens,
                             const struct glint_bake_options *options,
                             unsigned char **model, size_t *bytes,
                             struct glint_bake_report *report,
                             struct glint_error *error)
{
    static const double rgb_nm[] = {650, 532, 450};
    struct bake_run *run = calloc(1, sizeof *run);
    enum glint_status status;

    error->text[0] = 0;
    if (!run)
        return GLINT_E_MEMORY;
    run->lens = lens;
    run->options = *options;
    run->error = error;
    status = glint_bake_check_options(options, error);
    if (status == GLINT_OK)
        status = glint_setup_init(&run->setup, lens, 0, 0, rgb_nm, 3, error);
    if (status == GLINT_OK)
        status = init_neighbour_setups(run, rgb_nm);
    if (status == GLINT_OK) {
        status = bake_model(run);
        if (status == GLINT_E_LENS && !error->text[0])
            snprintf(error->text, sizeof error->text,
                     "%s: cannot prove that the integers of the model do not "
                     "overflow",
                     lens->name);
        if (status == GLINT_OK) {
            compute_bake_report(run, report);
            *model = run->draft.data;
            *bytes = run->draft.bytes;
            run->draft.data = NULL;
        }
        free_ghost_arrays(run);
    }
    free(run);
    return status;
}
