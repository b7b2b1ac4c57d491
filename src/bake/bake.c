/* SPDX-License-Identifier: MIT
 *
 * Makes the model of a lens table: fits, quantises, proves, writes and measures
 * it. */
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

/* All that is needed while one model is made. */
struct bake_run {
    const struct glint_prescription *lens;
    struct glint_bake_options options;
    struct glint_setup setup;
    struct glint_setup beside[GLINT_MAX_BESIDE];
    struct glint_brightness brightness;
    struct glint_fitted_ghost *fitted;         /* [n_ghosts] */
    struct glint_quantised_system **quantised; /* [n_ghosts][n_systems] */
    enum glint_status *status;                 /* [n_ghosts] */
    struct glint_draft draft;
    int *first;     /* index of each ghost's first system */
    int *intruders; /* number of intruders of each ghost, see struct
                       glint_bake_report */
    int *rays;
    struct glint_effort effort; /* worker 0's */
    struct glint_error *error;
};

/* --------------------------------------------------------------------- jobs */

/* Returns the ghost and N beside it, to be freed; NULL: no memory. */
static struct glint_visible *visible_of(const struct bake_run *run, int ghost,
                                        int n)
{
    struct glint_visible *const v = calloc((size_t)n + 1, sizeof *v);

    for (int k = 0; v && k <= n; k++) {
        glint_visible_init(&v[k], k ? &run->beside[k - 1] : &run->setup, ghost,
                           glint_bake_field_mm(run->lens, &run->options),
                           run->options.band_nm);
        glint_visible_reach(&v[k], run->options.max_deg);
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
        status = glint_quantise(&f->system[i], &system[i]);
    return status;
}

/* Fraction of a bake until all ghosts are fitted, and until they are quantised.
 */
#define FITTED    0.96
#define QUANTISED 0.97

static void report_effort(struct bake_run *run)
{
    const struct glint_bake_options *o = &run->options;

    if (o->progress)
        o->progress(o->progress_ctx, FITTED * glint_effort_done(&run->effort));
}

static void fit_told(void *ctx, double work, double share)
{
    struct bake_run *run = ctx;

    glint_effort_spend(&run->effort, work, share);
    report_effort(run);
}

/* Factor on all tolerances of lenses that are not round: with two components of
 * the direction, errors of tenths of a pixel need many times as many
 * systems. */
#define SKEW_TOLERANCE 1.5

/* The same factor for energies, which are cheap to fit in parts of the band. */
#define SKEW_ENERGY 0.7

static enum glint_status fit_auto(struct bake_run *run, int ghost, bool tells)
{
    const bool round = glint_prescription_is_round(run->lens);
    const double film = run->lens->film_width_mm;
    const double t = run->options.tolerance * (round ? 1 : SKEW_TOLERANCE);
    const struct glint_tolerance tolerance = {
        .sensor_mm = 0.04 * t * film / 1920,
        .faint_sensor_mm = 0.07 * t * film / 1920,
        .edge_mm = 0.04 * t * film / 1920,
        .stop = 4.5e-4 * t,
        /* A sixteenth of that, or less of a lens that opens wider than
         * GLINT_WIDE, as its model serves all narrower stops. */
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
        glint_fit_told_fn *, void *, struct glint_fitted_ghost *) =
        round ? glint_fit_ghost : glint_skew_fit;
    struct glint_visible *const visible =
        visible_of(run, ghost, run->options.n_beside);
    const enum glint_status status =
        visible ? fit(visible, run->options.max_deg, &tolerance,
                      tells ? fit_told : NULL, run, &run->fitted[ghost])
                : GLINT_E_MEMORY;

    free(visible);
    return status;
}

/* Fits a ghost; worker 0 reports progress. */
static void fit_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;

    if (worker == 0)
        glint_effort_begin(&run->effort, ghost);
    run->status[ghost] = run->options.ghosts && !run->options.ghosts[ghost]
                             ? GLINT_OK
                             : fit_auto(run, ghost, worker == 0);
    if (worker != 0)
        return;
    glint_effort_end(&run->effort);
    report_effort(run);
}

static void quantise_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;
    (void)worker;
    run->status[ghost] = quantise_ghost(run, ghost);
}

static void measure_job(void *ctx, int ghost, int worker)
{
    struct bake_run *run = ctx;
    const struct glint_lens lens = glint_draft_lens(&run->draft);
    struct glint_visible *const visible = visible_of(run, ghost, 0);

    (void)worker;
    run->status[ghost] = GLINT_E_MEMORY;
    if (!visible)
        return;
    for (int i = 0; i < run->fitted[ghost].n_systems; i++) {
        struct glint_measured m;

        glint_measure_system(visible, &lens, run->first[ghost] + i,
                             &run->fitted[ghost].system[i], &m);
        glint_draft_note(&run->draft, run->first[ghost] + i, &m);
        run->intruders[ghost] += m.intruders;
        run->rays[ghost] += m.rays;
    }
    run->status[ghost] = GLINT_OK;
    free(visible);
}

/* One round of short jobs, a job for each ghost, and its fraction of the
 * progress, 0 .. 1. */
struct round {
    struct bake_run *run;
    glint_job_fn *job;
    double from, to;
    int most; /* largest number of a job that worker 0 has ended */
};

/* Runs a job of a round. Workers do not wait for each other; worker 0 reports
 * progress. */
static void round_job(void *ctx, int job, int worker)
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

static enum glint_status status_of(const struct bake_run *run)
{
    for (int i = 0; i < run->setup.n_ghosts; i++)
        if (run->status[i] != GLINT_OK)
            return run->status[i];
    return GLINT_OK;
}

static enum glint_status for_ghosts(struct bake_run *run, glint_job_fn *job,
                                    double from, double to)
{
    struct round round = {run, job, from, to, 0};

    glint_workers_run(run->options.workers, run->setup.n_ghosts, round_job,
                      &round);
    if (run->options.progress)
        run->options.progress(run->options.progress_ctx, to);
    return status_of(run);
}

static enum glint_effort_kind kind_of(const struct glint_prescription *lens)
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
                      glint_workers_count(o->workers), kind_of(run->lens));
    if (!glint_prescription_is_round(run->lens)) {
        glint_skew_work(run->lens, run->setup.n_ghosts, o->max_deg,
                        o->tolerance, &head, &typical);
        glint_effort_expect(&run->effort, head, typical);
    }
    report_effort(run);
    glint_workers_run(o->workers, run->setup.n_ghosts, fit_job, run);
    if (o->progress)
        o->progress(o->progress_ctx, FITTED);
    return status_of(run);
}

/* ----------------------------------------------------------------- pipeline */

static int parts_of(const struct glint_fitted_ghost *ghost)
{
    int n = 1;

    for (int i = 0; i < ghost->n_systems; i++)
        n = ghost->system[i].part >= n ? ghost->system[i].part + 1 : n;
    return n;
}

/* Turns the second and further parts of each ghost into separate ghosts,
 * appended after all others. */
static enum glint_status part_ghosts(struct bake_run *run)
{
    struct glint_setup *s = &run->setup;
    const int n = s->n_ghosts;
    enum glint_status status = GLINT_OK;

    for (int ghost = 0; ghost < n; ghost++) {
        const int n_parts = parts_of(&run->fitted[ghost]);

        for (int part = 1; part < n_parts && status == GLINT_OK; part++) {
            if (s->n_ghosts == GLINT_MAX_GHOSTS) {
                snprintf(run->error->text, sizeof run->error->text,
                         "%s: more than %d ghosts and parts of ghosts",
                         run->lens->name, GLINT_MAX_GHOSTS);
                return GLINT_E_LENS;
            }
            s->ghost[s->n_ghosts] = s->ghost[ghost];
            status = glint_fitted_part(&run->fitted[ghost], part,
                                       &run->fitted[s->n_ghosts]);
            s->n_ghosts++;
            s->n_parts++;
        }
    }
    return status;
}

static enum glint_status reserve(struct bake_run *run)
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

static void clear(struct bake_run *run)
{
    for (int g = 0; g < run->setup.n_ghosts && run->fitted && run->quantised;
         g++) {
        for (int i = 0; i < run->fitted[g].n_systems && run->quantised[g]; i++)
            glint_quantised_finish(&run->quantised[g][i]);
        free(run->quantised[g]);
        glint_fitted_finish(&run->fitted[g]);
    }
    free(run->fitted);
    free(run->quantised);
    free(run->status);
    free(run->first);
    free(run->intruders);
    free(run->rays);
    free(run->draft.data);
}

/* Checks that readers will accept the model: else it is not handed out. */
static enum glint_status check_draft(const struct bake_run *run)
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

static enum glint_status bake_run(struct bake_run *run)
{
    struct glint_model_header header;
    enum glint_status status = reserve(run);

    if (status == GLINT_OK)
        status = glint_model_header_of(run->lens, &run->options, &run->setup,
                                       &header);
    if (status == GLINT_OK)
        status = glint_brightness_find(
            &run->brightness, &run->setup,
            glint_bake_field_mm(run->lens, &run->options), run->options.max_deg,
            run->options.band_nm, run->options.workers);
    if (status == GLINT_OK)
        status = fit_ghosts(run);
    if (status == GLINT_OK)
        status = part_ghosts(run);
    if (status == GLINT_OK)
        status = for_ghosts(run, quantise_job, FITTED, QUANTISED);
    if (status == GLINT_OK)
        status = glint_draft_write(&run->draft, &run->setup, &header,
                                   run->fitted, run->quantised);
    if (status != GLINT_OK)
        return status;
    for (int g = 1; g < run->setup.n_ghosts; g++)
        run->first[g] = run->first[g - 1] + run->fitted[g - 1].n_systems;
    status = for_ghosts(run, measure_job, QUANTISED, 1);
    if (status != GLINT_OK)
        return status;
    glint_blob_seal(run->draft.data, run->draft.bytes);
    return check_draft(run);
}

static void sum_up(const struct bake_run *run, struct glint_bake_report *r)
{
    *r = (struct glint_bake_report){0, 0, 0};
    for (int g = 0; g < run->setup.n_ghosts; g++) {
        r->rays += run->rays[g];
        r->intruders += run->intruders[g];
        for (int i = 0; i < run->fitted[g].n_systems; i++)
            r->unmet += !run->fitted[g].system[i].met;
    }
}

/* Sets up the neighbouring positions of LENS, which must be the same lens. */
static enum glint_status set_up_beside(struct bake_run *run,
                                       const double rgb_nm[3])
{
    const struct glint_bake_options *const o = &run->options;

    for (int k = 0; k < o->n_beside; k++) {
        const struct glint_prescription *const beside = &o->beside[k];
        enum glint_status status = GLINT_E_ARGUMENT;

        if (!glint_prescription_is_round(run->lens) ||
            beside->n_surfaces != run->lens->n_surfaces ||
            beside->stop_after != run->lens->stop_after)
            snprintf(run->error->text, sizeof run->error->text,
                     "%s is not rotationally symmetric, or the adjacent zoom "
                     "position has another number of surfaces or another stop",
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
    status = glint_bake_check(options, error);
    if (status == GLINT_OK)
        status = glint_setup_init(&run->setup, lens, 0, 0, rgb_nm, 3, error);
    if (status == GLINT_OK)
        status = set_up_beside(run, rgb_nm);
    if (status == GLINT_OK) {
        status = bake_run(run);
        if (status == GLINT_E_LENS && !error->text[0])
            snprintf(error->text, sizeof error->text,
                     "%s: cannot prove that the integers of the model do not "
                     "overflow",
                     lens->name);
        if (status == GLINT_OK) {
            sum_up(run, report);
            *model = run->draft.data;
            *bytes = run->draft.bytes;
            run->draft.data = NULL;
        }
        clear(run);
    }
    free(run);
    return status;
}
