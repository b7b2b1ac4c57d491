/* SPDX-License-Identifier: MIT */
#include "engine/frame/frame.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/area.h"
#include "engine/frame/frame_parts.h"
#include "engine/frame/light.h"
#include "glint/quality.h"

void glint_frame_init(struct glint_frame *frame,
                      const struct glint_setup *setup, struct glint_view view,
                      struct glint_workers *workers)
{
    *frame = (struct glint_frame){.setup = setup,
                                  .view = view,
                                  .cfg = {.workers = workers,
                                          .width = view.width,
                                          .height = view.height,
                                          .tile_log2 = 6},
                                  .dials = glint_dials_at(1 << 14),
                                  .asked = glint_dials_at(1 << 14),
                                  .apart_px = GLINT_FRAME_APART_PX,
                                  .limits.most_bytes = GLINT_FRAME_MOST_BYTES,
                                  .limits.most_minsn = GLINT_FRAME_MOST_MINSN,
                                  .only_ghost = -1};
    glint_setup_stop(setup, &frame->cfg.stop);
}

void glint_frame_init_like(struct glint_frame *frame,
                           const struct glint_frame *like,
                           struct glint_view view)
{
    glint_frame_init(frame, like->setup, view, like->cfg.workers);
    frame->lens = like->lens;
    frame->trace = like->trace;
    frame->clock = like->clock;
    frame->dials = frame->asked = like->asked;
    frame->apart_px = like->apart_px;
    frame->picture.for_codes = like->picture.for_codes;
    frame->picture.uniform = like->picture.uniform;
    frame->only_ghost = like->only_ghost;
    frame->limits.most_bytes = like->limits.most_bytes;
    frame->limits.most_minsn = like->limits.most_minsn;
    frame->cfg.sets = like->cfg.sets;
    frame->cfg.tile_log2 = like->cfg.tile_log2;
    frame->cfg.dither = like->cfg.dither;
}

void glint_frame_finish(struct glint_frame *frame)
{
    glint_frame_star_finish(&frame->star);
    glint_frame_veil_finish(&frame->veil);
    free(frame->still.light);
    free(frame->still.gain_q14);
    free(frame->still.sum_q20);
    if (frame->trace)
        frame->trace->finish(frame);
    free(frame->lights.light);
    free(frame->lights.merged);
    free(frame->lights.seen);
    free(frame->dim.table.log2_q8);
    free(frame->memory.mem);
}

static int count_waves_of_all_sets(const struct glint_setup *s)
{
    int n = 0;

    for (int i = 0; i < s->n_sets; i++)
        n += s->set_size[i];
    return n;
}

static void set_frame_waves(struct glint_frame *f)
{
    const struct glint_setup *s = f->setup;
    const struct glint_set_wave *w = s->set_wave;

    f->lights.sets =
        (struct glint_wave_sets){.planner = &glint_wave_planner,
                                 .n_sets = s->n_sets,
                                 .apart_q8 = f->dials.dispersion_q8};
    for (int i = 0; i < s->n_sets; i++)
        f->lights.sets.size[i] = s->set_size[i];
    if (glint_frame_has_wave_sets(f))
        for (int i = 0; i < count_waves_of_all_sets(s); i++)
            f->lights.wave[i] =
                glint_wave_from_nm(w[i].nm, w[i].rgb, w[i].unit_flux);
    else
        for (int i = 0; i < s->n_wavelengths; i++)
            f->lights.wave[i] = glint_wave_from_nm(s->wavelength_nm[i],
                                                   s->rgb[i], s->unit_flux[i]);
}

/* Converts PX, a distance near the axis in pixels, to an angle, and returns the
 * chord of this angle on the unit sphere. */
static int32_t convert_px_to_chord_q30(const struct glint_frame *f, double px)
{
    const double pixels = glint_frame_compute_pixels_per_tangent(f);

    return (int32_t)lrint(fmin(1, px / pixels) * 0x1p30);
}

bool glint_frame_is_lamp_outside_model(const struct glint_frame *frame,
                                       const struct glint_lamp *lamp)
{
    const struct glint_light b = glint_light_from_lamp(lamp, 1);

    return glint_light_is_outside_model(frame->lens, &b);
}

/* Uses atan2(), as asin() would make glint-live 25 KB larger. */
double glint_frame_get_max_angle_deg(const struct glint_frame *frame)
{
    const double degree = GLINT_PI / 180;
    double sine;

    if (!frame->lens)
        return 89;
    sine = frame->lens->header->sine_hi_q30 * 0x1p-30;
    return atan2(sine, sqrt(1 - sine * sine)) / degree * (1 - 1e-6);
}

/* Appends the point lights that sample LAMP to the WITHIN lights of the frame.
 * Returns the new number of lights. Points outside the model's range of angles
 * are dropped here, as they must not be merged with lights that are drawn. */
static int add_lamp_lights(struct glint_frame *f, const struct glint_lamp *lamp,
                           const struct glint_area_rule *rule, double scale,
                           int within)
{
    struct glint_area area;
    const int n = glint_area_plan(&area, lamp, rule);
    const double apart = n > 1 ? fmin(glint_area_apart(&area), 1) : 0;

    for (int i = 0; i < n; i++) {
        const struct glint_lamp point = glint_area_point(&area, i);

        f->lights.light[within] = glint_light_from_lamp(&point, scale);
        f->lights.light[within].apart_q30 = (int32_t)lrint(apart * 0x1p30);
        within +=
            !glint_light_is_outside_model(f->lens, &f->lights.light[within]);
    }
    return within;
}

/* Returns the max number of lights for N lamps; a lamp of visible extent
 * becomes several lights. */
static int compute_max_lights(const struct glint_frame *f, int n)
{
    const int most = f->dials.max_lights;

    if (f->limits.reserved)
        return min_int(most, f->lights.capacity);
    return n <= most ? max_int(most, f->picture.point_room) : most;
}

/* Converts N LAMPS to lights of the frame; SCALE is a factor on their powers.
 * Merges lights that are too close to be distinguished. If there are still too
 * many lights, merges more of them. */
static enum glint_status convert_lamps_to_lights(struct glint_frame *f,
                                                 const struct glint_lamp *lamps,
                                                 int n, double scale)
{
    const int room = compute_max_lights(f, n);
    int within = 0, total;
    const struct glint_area_rule rule =
        glint_area_rule_of(lamps, n, glint_frame_compute_pixels_per_tangent(f),
                           f->dials.area_points, room, &total);

    if (glint_frame_allocate_lights(f, total) != GLINT_OK)
        return GLINT_E_MEMORY;
    f->lights.n_beyond = 0;
    f->lights.gain_q14 = NULL;
    for (int i = 0; i < n; i++) {
        const int before = within;

        within = add_lamp_lights(f, &lamps[i], &rule, scale, within);
        f->lights.n_beyond += within == before;
    }
    f->lights.n_more = within - (n - f->lights.n_beyond);
    f->lights.n = glint_lights_merge(
        f->lights.light, within, convert_px_to_chord_q30(f, f->apart_px),
        max_int(room, f->dials.max_lights), &f->lights.n_apart);
    if (!f->limits.is_held) /* Otherwise the limits of the frame, which allow
                               more for more lights, have reduced the number of
                               lights. They still apply to the original
                               number. */
        f->limits.share =
            1 + max_int(f->lights.n - 1, 0) / (double)GLINT_FRAME_PER_LIGHT;
    if (f->star.is_alone)
        f->lights.n = 0;
    return GLINT_OK;
}

/* Returns the settings with which the flare is planned and traced for IMAGE.
 * IMAGE may be NULL; the picture then counts as linear. */
static struct glint_flare_frame
make_flare_frame(struct glint_frame *f, const struct glint_image *image)
{
    set_frame_waves(f);
    glint_frame_clear_stale_dim_table(f);
    f->lights.sets.step = glint_real_of(
        glint_frame_get_light_near_black(f, image, GLINT_FRAME_STEP_CODES));
    return (struct glint_flare_frame){
        .lens = f->lens,
        .wave = f->lights.wave,
        .n_waves = glint_frame_has_wave_sets(f)
                       ? count_waves_of_all_sets(f->setup)
                       : f->setup->n_wavelengths,
        .sets = glint_frame_has_wave_sets(f) ? &f->lights.sets : NULL,
        .pixels_per_mm = glint_real_of(f->view.width / f->view.sensor_width_mm),
        .fineness = f->dials.fineness,
        .uniform = f->picture.uniform,
        .only_ghost = f->only_ghost,
        .tints = f->tints,
        .faintest = glint_real_of(
            glint_frame_get_light_near_black(f, image, f->dials.cull_codes)),
        .dim = f->dim.table.log2_q8 ? &f->dim.table : NULL,
        .dimmest = glint_real_of(
            glint_frame_get_light_near_black(f, image, f->dials.dim_codes)),
        .snap_codes_q8 = f->dials.snap_codes_q8,
        .half = glint_dials_half(&f->dials) && f->picture.can_half ? &glint_half
                                                                   : NULL,
        .gain_q14 = f->lights.gain_q14};
}

void glint_frame_apply_config(struct glint_frame *f)
{
    f->cfg.irradiance_steps = f->dials.irradiance_steps;
    if (f->memory.block)
        glint_flare_init(&f->memory.flare, &f->cfg, f->memory.block,
                         f->memory.bytes);
}

/* Applies two quality parameters to the configuration of the flare: the
 * rounding of irradiance, and the fineness of the tables of dust. */
static void apply_quality_to_flare_config(struct glint_frame *f)
{
    const bool is_other = f->cfg.irradiance_steps != f->dials.irradiance_steps;

    if (glint_frame_select_dust_tables(f) || is_other)
        glint_frame_apply_config(f);
}

/* Allocates memory for the max number of ray bundles, and plans the frame. */
static enum glint_status plan_frame(struct glint_frame *f,
                                    const struct glint_flare_frame *rays)
{
    enum glint_status status;

    apply_quality_to_flare_config(f);
    status = glint_frame_ensure_plan_capacity(f);
    if (status != GLINT_OK)
        return status;
    glint_flare_plan(f->memory.flare, rays, f->lights.light, f->lights.n);
    f->plan.n_plans++;
    f->plan.n_looked += glint_flare_looked(f->memory.flare);
    return GLINT_OK;
}

/* Lets the budget choose quality parameters. Returns whether they changed, so
 * that the frame must be planned again.
 */
static bool choose_quality_by_budget(struct glint_frame *f)
{
    const struct glint_cost_plan plan = glint_frame_make_cost_plan(f);

    return glint_budget_choose_quality_parameters(&f->budget, &plan, &f->dials);
}

static enum glint_status
draw_flare_by_model(struct glint_frame *f, const struct glint_lamp *lamps,
                    int n_lamps, double scale, const struct glint_image *image,
                    struct glint_flare_stats *stats, double times[5])
{
    const struct glint_dials asked = f->dials;
    enum glint_status status;

    f->picture.can_half = is_planned_for_codes(f, image);
    f->picture.code_light = glint_frame_get_light_near_black(f, image, 1);
    f->plan.scale = scale;
    f->limits.is_held = f->limits.is_full = false;
    f->limits.tight = 0;
    f->plan.n_plans = f->plan.n_binned = 0;
    f->plan.n_looked = 0;
    glint_budget_begin_frame(&f->budget, &f->asked);
    times[0] = read_frame_clock(f);
    status = convert_lamps_to_lights(f, lamps, n_lamps, scale);
    if (status == GLINT_OK && f->budget.ms <= 0 && glint_frame_limit_probing(f))
        status = convert_lamps_to_lights(f, lamps, n_lamps, scale);
    if (status == GLINT_OK)
        status = glint_frame_use_static_lights(
            f, convert_px_to_chord_q30(f, f->dials.still_px));
    while (status == GLINT_OK) {
        f->plan.rays = make_flare_frame(f, image);
        status = plan_frame(f, &f->plan.rays);
        if (status != GLINT_OK)
            break;
        if (f->budget.ms > 0 && choose_quality_by_budget(f))
            continue;
        if (f->budget.ms <= 0 && glint_frame_limit_work(f)) {
            status = convert_lamps_to_lights(f, lamps, n_lamps, scale);
            continue;
        }
        times[1] = times[2] = read_frame_clock(f);
        glint_flare_bin(f->memory.flare, stats);
        f->plan.n_binned++;
        if (glint_frame_fit_capacity(f, stats))
            break;
        status =
            f->limits.reserved ? GLINT_OK : glint_frame_reallocate_flare(f);
    }
    if (f->limits.is_held)
        f->dials = asked;
    if (status != GLINT_OK)
        return status;
    times[3] = read_frame_clock(f);
    glint_frame_draw_passes(f, image);
    times[4] = read_frame_clock(f);
    return GLINT_OK;
}

/* Samples and merges the *N LAMPS for exact rays, in the same way as for a
 * model. Returns the resulting lamps and sets *N to their number. Returns NULL
 * if memory is short. */
static const struct glint_lamp *
merge_exact_lamps(struct glint_frame *f, const struct glint_lamp *lamps, int *n)
{
    struct glint_lamp *merged;

    f->lights.given = lamps;
    f->lights.n_given = *n;
    if (convert_lamps_to_lights(f, lamps, *n, 1) != GLINT_OK)
        return NULL;
    if (f->lights.n == *n && f->lights.n_more == 0) {
        for (int i = 0; i < *n; i++) /* merging has changed their order */
            f->lights.light[i] = glint_light_from_lamp(&lamps[i], 1);
        return lamps;
    }
    *n = f->lights.n;
    merged = realloc(f->lights.merged, ((size_t)*n + 1) * sizeof *merged);
    if (!merged)
        return NULL;
    f->lights.merged = merged;
    for (int i = 0; i < *n; i++)
        merged[i] = glint_lamp_from_light(&f->lights.light[i]);
    return merged;
}

static enum glint_status
draw_flare_by_exact_rays(struct glint_frame *f, const struct glint_lamp *lamps,
                         int n_lamps, double scale,
                         const struct glint_image *image,
                         struct glint_flare_stats *stats, double times[5])
{
    const struct glint_lamp *merged = merge_exact_lamps(f, lamps, &n_lamps);

    f->plan.scale = scale;
    apply_quality_to_flare_config(f);
    return merged
               ? f->trace->draw(f, merged, n_lamps, scale, image, stats, times)
               : GLINT_E_MEMORY;
}

static enum glint_status predict_model_scale(struct glint_frame *frame,
                                             const struct glint_lamp *lamps,
                                             int n_lamps,
                                             struct glint_frame_scale *scale)
{
    struct glint_real brightest, together;
    struct glint_flare_frame rays;
    enum glint_status status;

    frame->limits.is_held = frame->picture.can_half = false;
    status = convert_lamps_to_lights(frame, lamps, n_lamps, 1);
    rays = make_flare_frame(frame, NULL);
    if (status == GLINT_OK)
        status = plan_frame(frame, &rays);
    if (status != GLINT_OK)
        return status;
    glint_flare_light(frame->memory.flare, &brightest, &together);
    if (brightest.mantissa)
        *scale = glint_frame_compute_scale(brightest.exponent + 31,
                                           together.exponent + 31);
    return GLINT_OK;
}

enum glint_status glint_frame_predict_scale(struct glint_frame *frame,
                                            const struct glint_lamp *lamps,
                                            int n_lamps,
                                            struct glint_frame_scale *scale)
{
    *scale = (struct glint_frame_scale){0, 0};
    if (frame->lens)
        return predict_model_scale(frame, lamps, n_lamps, scale);
    lamps = merge_exact_lamps(frame, lamps, &n_lamps);
    return lamps ? frame->trace->scale(frame, lamps, n_lamps, scale)
                 : GLINT_E_MEMORY;
}

static int count_drawn_bundles(const struct glint_frame *f,
                               const struct glint_engine_report *r)
{
    return f->lens ? r->stats.bundles : f->trace->n_bundles(f);
}

/* Sets the members of REPORT about the lights, plans and memory of the drawn
 * frame. */
static void fill_frame_report(struct glint_frame *frame,
                              struct glint_engine_report *report)
{
    report->beyond_lights = frame->lights.n_beyond;
    report->apart_lights =
        max_int(frame->lights.n_apart - frame->lights.n_more, 1);
    report->coarsened = frame->limits.is_held;
    report->tight = frame->limits.tight > 0;
    report->blurred = frame->cfg.stop.shade == &frame->shade;
    report->plans = frame->plan.n_plans;
    report->binned = frame->plan.n_binned;
    report->looked = frame->plan.n_looked;
    report->drawn_lights =
        max_int(frame->lights.n - frame->lights.n_more,
                frame->star.is_alone ? report->apart_lights : 1);
    report->tiles = glint_flare_tiles(frame->memory.flare);
    report->held_samples = glint_flare_held(frame->memory.flare);
    report->arena_bytes = frame->memory.bytes;
    report->peak_bytes = glint_frame_count_used_bytes(frame, &report->stats);
    report->need_bytes = glint_frame_count_needed_bytes(frame, &report->stats);
    report->star_bytes = glint_frame_star_count_bytes(frame);
    report->ghosts =
        glint_frame_count_ghosts(frame, count_drawn_bundles(frame, report));
}

enum glint_status glint_frame_draw(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double scale,
                                   const struct glint_image *image,
                                   struct glint_engine_report *report)
{
    double times[5] = {0, 0, 0, 0, 0};
    const size_t bytes = frame->memory.bytes;
    enum glint_status status;

    *report = (struct glint_engine_report){
        .lights = n_lamps, .quality = -1, .arena_bytes = frame->memory.bytes};
    /* Nothing is drawn in this case. Without a veil the picture is not read,
     * either. */
    if (n_lamps == 0 && !glint_frame_has_veil(frame))
        return GLINT_OK;
    if (glint_frame_allocate_ghost_data(frame) != GLINT_OK)
        return GLINT_E_MEMORY;
    status = glint_frame_star_set_lamps(frame, lamps, n_lamps, scale, image);
    if (status == GLINT_OK)
        status = glint_frame_veil_set_light(frame, lamps, n_lamps, image);
    if (status == GLINT_OK)
        status = (frame->lens ? draw_flare_by_model : draw_flare_by_exact_rays)(
            frame, lamps, n_lamps, scale, image, &report->stats, times);
    if (status != GLINT_OK)
        return status;
    report->plan_ms = 1e3 * (times[1] - times[0]);
    report->trace_ms = 1e3 * (times[2] - times[1]);
    report->bin_ms = 1e3 * (times[3] - times[2]);
    report->draw_ms = 1e3 * (times[4] - times[3]);
    if (frame->lens && frame->budget.ms > 0) {
        report->predicted_ms = frame->budget.predicted_ms;
        report->calibrated_minsn = frame->budget.calibrated_minsn;
        report->quality = glint_budget_get_quality(&frame->budget);
        report->dials = frame->dials;
        report->unveiled = glint_frame_has_veil(frame) &&
                           frame->dials.flags & GLINT_DIAL_NO_VEIL;
        /* The budget does not learn from frames that allocated memory or reused
         * edges, as their times are not representative. */
        if (frame->memory.bytes == bytes && !report->stats.reused)
            glint_budget_learn_from_frame(&frame->budget,
                                          1e3 * (times[4] - times[0]));
    }
    fill_frame_report(frame, report);
    return GLINT_OK;
}

void glint_frame_set_area_sampling(struct glint_frame *frame, bool is_still,
                                   bool more_points, bool more_lights)
{
    const struct glint_dials *const asked = &frame->asked;

    /* Neither this frame nor the last one is a still picture, so the numbers
     * are not raised. They are not reset either, as a program may have set its
     * own. */
    if (!is_still && !frame->picture.is_still)
        return;
    frame->picture.is_still = is_still;
    frame->dials.area_points =
        is_still && more_points
            ? 1 + GLINT_AREA_STILL * (asked->area_points - 1)
            : asked->area_points;
    frame->picture.point_room =
        is_still && more_lights ? GLINT_AREA_STILL_ROOM * asked->max_lights : 0;
}
