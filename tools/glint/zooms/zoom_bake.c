/* SPDX-License-Identifier: MIT */
#include "zooms/zoom_bake.h"

#include <math.h>
#include <stdlib.h>

#include "model/picture_check.h"
#include "posix/error.h"
#include "zooms/zoom_error.h"

enum {
    /* max number of times that the step between two evenly spaced positions is
     * halved */
    DEPTH = 4,
    /* length of the smallest step, in places; nothing is baked in the middle of
     * such a step */
    LAST = 2,
    /* Max number of places. A place is a zoom position where ghosts may be
     * baked, or the middle of a smallest step, where only errors are
     * measured. */
    PLACES = 2 * GLINT_MAX_ZOOM_MODELS - 1
};

/* Margin, dB. The error at the measured angles must be below the requested
 * error by this margin, because other angles may have larger errors. */
#define MARGIN_DB 2
/* If the max error of a ghost in a step is below this fraction of the requested
 * error, this ghost is not measured again when the step is halved. */
#define SMALL 1e-3
/* Shift of the measured angles from a place to the next, as a fraction of the
 * interval between two angles. Multiples of this fraction, modulo 1, are evenly
 * distributed from 0 to 1. */
#define GOLDEN 0.6180339887

struct place {
    /* model of the ghosts baked at this place; has no data if there are none */
    struct glint_bake_model model;
    bool *ghosts; /* whether each ghost is baked at this place, [n_ghosts] */
    /* For the step that begins here: total error, in its middle, of the ghosts
     * that are not baked there. */
    struct zoom_error left;
    /* error of each ghost in the middle of the previous step of double length,
     * one half of which is the step that begins here */
    struct zoom_error *before;
    bool is_half; /* whether the errors BEFORE were measured */
};

struct run {
    struct tool *tool;
    const struct zoom_bake *bake;
    struct zoom_baked *baked;
    struct glint_error *error;
    /* progress of baking all evenly spaced positions, or one position between
     * them */
    struct tool_progress progress;
    struct glint_prescription lens; /* lens at the present place */
    /* lens at one smallest step before and after the present place */
    struct glint_prescription beside[2];
    int n_ghosts, n_places, step;
    double start;
    struct place place[PLACES];
    struct zoom_error *ghost; /* error of each ghost, [n_ghosts] */
    struct glint_zoom_lens zoom;
};

static enum glint_status
set_lens_to_zoom_position(const struct run *run, int place,
                          struct glint_prescription *lens)
{
    const struct zoom_bake *const b = run->bake;
    enum glint_status status;

    *lens = *b->lens;
    status = glint_prescription_zoom(lens, place / (run->n_places - 1.0),
                                     run->error);
    if (status == GLINT_OK && b->focus_m > 0)
        status = glint_prescription_focus(lens, b->focus_m, run->error);
    if (status == GLINT_OK && b->f_number > 0)
        status = glint_prescription_set_f_number(lens, b->f_number, run->error);
    return status;
}

/* Sets run->beside to the lens at one smallest step before and after PLACE, and
 * OPTIONS to bake ghosts in agreement with both. Ghosts that need only larger
 * steps use the same neighbours. Sets no neighbours if no positions are added
 * between the evenly spaced ones, whose ghosts differ too much, nor for lenses
 * without rotational symmetry. */
static enum glint_status
set_neighbour_lenses(struct run *run, int place,
                     struct glint_bake_options *options)
{
    enum glint_status status = GLINT_OK;

    options->beside = run->beside;
    options->n_beside = 0;
    for (int at = place - LAST; at <= place + LAST && status == GLINT_OK;
         at += 2 * LAST)
        if (run->bake->halfway_db > 0 && at >= 0 && at < run->n_places &&
            glint_prescription_is_round(&run->lens))
            status = set_lens_to_zoom_position(
                run, at, &run->beside[options->n_beside++]);
    return status;
}

/* Bakes at PLACE the ghosts chosen there, or all ghosts if WHOLE. */
static enum glint_status bake_zoom_position(struct run *run, int place,
                                            bool whole)
{
    struct place *const p = &run->place[place];
    struct glint_bake_options options = *run->bake->options;
    struct glint_bake_report report;
    enum glint_status status =
        set_lens_to_zoom_position(run, place, &run->lens);

    if (status == GLINT_OK)
        status = set_neighbour_lenses(run, place, &options);
    options.ghosts = p->model.ghosts = whole ? NULL : p->ghosts;
    options.workers = run->tool->workers;
    options.progress = tool_progress_show;
    options.progress_ctx = &run->progress;
    if (status == GLINT_OK)
        status = glint_bake(&run->lens, &options, &p->model.data,
                            &p->model.bytes, &report, run->error);
    if (status == GLINT_OK)
        status = picture_check_store(NULL, run->bake->coating, &p->model.data,
                                     &p->model.bytes);
    tool_progress_end(&run->progress);
    p->model.along_q30 = (int32_t)lrint(place / (run->n_places - 1.0) * 0x1p30);
    for (int g = 0; g < run->n_ghosts; g++) {
        p->ghosts[g] |= whole;
        run->baked->n_bakes += p->ghosts[g];
    }
    return status;
}

/* Combines all baked ghosts into one zoom model, which replaces the previous
 * one. */
static enum glint_status combine_baked_models(struct run *run)
{
    struct glint_bake_model model[GLINT_MAX_ZOOM_MODELS];
    struct zoom_baked *const baked = run->baked;
    enum glint_status status;
    const char *reason;

    baked->n_models = 0;
    for (int k = 0; k < run->n_places; k++)
        if (run->place[k].model.data)
            model[baked->n_models++] = run->place[k].model;
    free(baked->data);
    baked->data = NULL;
    status = glint_bake_zoom(model, baked->n_models, &baked->data,
                             &baked->bytes, run->error);
    if (status != GLINT_OK)
        return status;
    status = glint_zoom_open(&run->zoom, baked->data, baked->bytes, &reason);
    return status == GLINT_OK
               ? status
               : glint_error_report(run->error, status, "the models of a zoom",
                                    "%s", reason);
}

/* Returns the max allowed mean squared error of all ghosts together. */
static double compute_max_total_error(const struct run *run)
{
    return pow(10, -0.1 * (run->bake->halfway_db + MARGIN_DB));
}

/* Chooses the ghosts to bake at TO: those with the largest errors, until the
 * total error of all others is small enough. In the smallest step none can be
 * chosen. Sets LEFT to the total error of the others. Returns the number of
 * chosen ghosts. */
static int choose_ghosts_to_bake(struct run *run, struct place *to,
                                 struct zoom_error *left)
{
    const double most = compute_max_total_error(run);
    int n = 0;

    for (int g = 0; g < run->n_ghosts; g++)
        for (int a = 0; a < ZOOM_ANGLES; a++) {
            left->of[a] += run->ghost[g].of[a];
            if (run->step == LAST)
                run->ghost[g].of[a] = 0;
        }
    for (;; n++) {
        int angle = 0, worst = 0;

        for (int a = 1; a < ZOOM_ANGLES; a++)
            angle = left->of[a] > left->of[angle] ? a : angle;
        for (int g = 1; g < run->n_ghosts; g++)
            worst = run->ghost[g].of[angle] > run->ghost[worst].of[angle]
                        ? g
                        : worst;
        if (left->of[angle] <= most || run->ghost[worst].of[angle] <= 0)
            return n;
        to->ghosts[worst] = true;
        for (int a = 0; a < ZOOM_ANGLES; a++) {
            left->of[a] -= run->ghost[worst].of[a];
            run->ghost[worst].of[a] = 0;
        }
    }
}

static double find_max_angle_error(const struct zoom_error *error)
{
    double worst = 0;

    for (int a = 0; a < ZOOM_ANGLES; a++)
        worst = fmax(worst, error->of[a]);
    return worst;
}

/* Records the PSNR for the error LEFT at the present zoom position if this PSNR
 * is the lowest so far. Prints N_ADDED, the number of ghosts to bake there. */
static void record_lowest_position_psnr(struct run *run,
                                        const struct zoom_error *left,
                                        int n_added)
{
    struct zoom_baked *const baked = run->baked;
    const double db =
        fmin(99, -10 * log10(fmax(find_max_angle_error(left), 1e-10)));

    if (baked->least_db <= 0 || db < baked->least_db) {
        baked->least_db = db;
        baked->least_mm = glint_real_value(run->zoom.header.focal_mm);
    }
    if (!run->tool->quiet)
        fprintf(stderr,
                "glint bake: at %.2f mm bakes %d more ghost%s, %.0f s so far\n",
                glint_real_value(run->zoom.header.focal_mm), n_added,
                n_added == 1 ? "" : "s", tool_clock_s() - run->start);
}

/* Sets those errors in run->ghost to -1 that must be measured in the middle of
 * the step from FROM to TO: those of ghosts baked at both ends, unless their
 * error was small before. Returns whether any ghost is baked at both ends. */
static bool mark_errors_to_measure(struct run *run, int from, int to)
{
    const struct place *const p = &run->place[from];
    bool any = false;

    for (int g = 0; g < run->n_ghosts; g++) {
        const bool has = p->ghosts[g] && run->place[to].ghosts[g];
        const bool small =
            p->is_half && find_max_angle_error(&p->before[g]) <
                              SMALL * compute_max_total_error(run);

        any |= has;
        for (int a = 0; a < ZOOM_ANGLES; a++)
            run->ghost[g].of[a] = !has ? 0 : small ? p->before[g].of[a] : -1;
    }
    return any;
}

/* Stores the errors of all ghosts, measured at MIDDLE of the step that begins
 * at FROM, for both halves of this step. */
static void store_ghost_errors(struct run *run, int from, int middle)
{
    struct place *const p = &run->place[from], *const m = &run->place[middle];

    for (int g = 0; g < run->n_ghosts; g++)
        p->before[g] = m->before[g] = run->ghost[g];
    p->is_half = m->is_half = true;
}

/* Measures the errors in the middle of the step that begins at FROM, and bakes
 * there the ghosts with large errors. */
static enum glint_status halve_zoom_step(struct run *run, int from)
{
    const int middle = from + run->step / 2, to = from + run->step;
    struct place *const p = &run->place[middle];
    struct zoom_error left = run->place[from].left;
    enum glint_status status;
    int n;

    p->left = left;
    if (!mark_errors_to_measure(run, from, to))
        return GLINT_OK;
    glint_zoom_set(&run->zoom,
                   (int32_t)lrint(middle / (run->n_places - 1.0) * 0x1p30));
    status = set_lens_to_zoom_position(run, middle, &run->lens);
    if (status == GLINT_OK)
        status = zoom_error_measure_ghosts(
            run->tool, &run->lens, &run->zoom, run->bake->options->max_deg,
            fmod(0.5 + middle * GOLDEN, 1), run->n_ghosts, run->ghost,
            run->error);
    if (status != GLINT_OK)
        return status;
    store_ghost_errors(run, from, middle);
    n = choose_ghosts_to_bake(run, p, &left);
    p->left = run->place[from].left = left;
    record_lowest_position_psnr(run, &left, n);
    if (n == 0)
        return GLINT_OK;
    tool_progress_start(&run->progress, run->tool, "bake");
    return bake_zoom_position(run, middle, false);
}

/* Bakes all ghosts at the evenly spaced positions. The first one serves to
 * estimate the total time. */
static enum glint_status bake_even_positions(struct run *run)
{
    struct tool_progress *const p = &run->progress;
    const int positions = run->bake->positions;
    enum glint_status status = GLINT_OK;

    tool_progress_start(p, run->tool, "bake");
    p->besides = run->bake->halfway_db > 0
                     ? " for all positions, and more for those halfway"
                     : " for all positions";
    p->less = "fewer --positions, a smaller --max-angle or a larger "
              "--tolerance";
    for (int k = 0; k < positions && status == GLINT_OK; k++) {
        tool_progress_set_part(p, (double)k / positions, 1.0 / positions);
        status = bake_zoom_position(run, k * run->step, true);
        if (status == GLINT_OK && !run->tool->quiet)
            fprintf(stderr, "glint bake: position %d of %d, %.0f s so far\n",
                    k + 1, positions, tool_clock_s() - run->start);
    }
    return status;
}

/* Bakes the evenly spaced positions, then halves the steps between them. */
static enum glint_status bake_all_positions(struct run *run)
{
    enum glint_status status = bake_even_positions(run);

    if (status == GLINT_OK)
        status = combine_baked_models(run);
    for (; run->step >= LAST && run->bake->halfway_db > 0 && status == GLINT_OK;
         run->step /= 2) {
        for (int k = 0; k + 1 < run->n_places && status == GLINT_OK;
             k += run->step)
            status = halve_zoom_step(run, k);
        if (status == GLINT_OK)
            status = combine_baked_models(run);
    }
    return status;
}

static bool allocate_run_arrays(struct run *run)
{
    const size_t n = (size_t)run->n_ghosts + 1;

    run->ghost = calloc(n, sizeof *run->ghost);
    for (int k = 0; k < run->n_places; k++) {
        run->place[k].ghosts = calloc(n, sizeof(bool));
        run->place[k].before = calloc(n, sizeof *run->place[k].before);
        if (!run->place[k].ghosts || !run->place[k].before)
            return false;
    }
    return run->ghost != NULL;
}

enum glint_status zoom_bake_positions(struct tool *tool,
                                      const struct zoom_bake *bake,
                                      struct zoom_baked *baked,
                                      struct glint_error *error)
{
    struct run *const run = calloc(1, sizeof *run);
    const int n = bake->positions - 1;
    enum glint_status status = GLINT_E_MEMORY;

    *baked = (struct zoom_baked){.data = NULL};
    if (!run)
        return status;
    run->tool = tool;
    run->bake = bake;
    run->baked = baked;
    run->error = error;
    run->start = tool_clock_s();
    run->step = LAST << (bake->halfway_db > 0 ? DEPTH : 0);
    while (n * run->step + 1 > PLACES)
        run->step /= 2;
    run->n_places = n * run->step + 1;
    run->n_ghosts = glint_ghost_list(bake->lens, NULL, 0);
    if (allocate_run_arrays(run))
        status = set_lens_to_zoom_position(run, 0, &run->lens);
    if (status == GLINT_OK)
        status = bake_all_positions(run);
    for (int k = 0; k < run->n_places; k++) {
        free(run->place[k].model.data);
        free(run->place[k].ghosts);
        free(run->place[k].before);
    }
    free(run->ghost);
    free(run);
    if (status != GLINT_OK) {
        free(baked->data);
        baked->data = NULL;
    }
    return status;
}
