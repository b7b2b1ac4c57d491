/* SPDX-License-Identifier: MIT
 *
 * Computes the table of ghost brightness (flare/dim.h). It has the logarithm of
 * the light of each ghost, on-screen or not, for a white light of power 1. Its
 * nodes are sampled sines of the light's angle. This file also merges lights
 * that are close together for dim ghosts. */
#include "base/compiler.h"
#include "flare/dim.h"
#include "flare/state.h"

enum {
    MOST_Q8 = 1 << 14,
    FOLD_Q8 = 3 << 8 /* log2 of (light at a fold of a ghost / mean light of the
                        ghost), an estimate */
};

struct fill {
    struct glint_flare *flare;
    struct glint_flare_frame frame;
    struct glint_light light;
    struct glint_plan plan;
    int node;
};

static int16_t clamp_log2_to_int16(int32_t log2)
{
    return (int16_t)q_clamp_sat(log2, -MOST_Q8, MOST_Q8);
}

/* Returns the largest magnitude among the colour channels of wavelength W. */
static struct glint_real find_max_channel(const struct glint_wave *w)
{
    int32_t most = 0;

    for (int c = 0; c < 3; c++) {
        const int32_t x = w->rgb_q14[c];

        most = x > most ? x : -x > most ? -x : most;
    }
    return real_of(most, -14);
}

/* Worker function: computes the table values of GHOST at one node, as if the
 * picture contained the complete ghost. */
static void fill_ghost_entry_job(void *ctx, int ghost, int worker)
{
    const struct fill *fill = ctx;
    struct glint_plan_scratch *scratch = fill->flare->worker[worker].plan;
    int16_t *value = glint_dim_get_values(&fill->frame, fill->node, ghost);

    for (int wave = 0; wave < GLINT_DIM_WAVES; wave++) {
        struct glint_bundle_plan planned = {.ghost = ghost, .wave = wave};
        struct glint_bundle bundle;
        /* total light that the wavelength would have if all its rays had energy
         * 1 */
        struct glint_real light;

        value[1 + wave] = GLINT_DIM_DARK;
        if (glint_plan_bundle(&fill->plan, &fill->light, &planned, &bundle,
                              scratch) != GLINT_OUTCOME_DRAWN ||
            planned.irradiance.mantissa == 0 || scratch->probe.energy <= 0)
            continue;
        light =
            real_over(planned.flux, find_max_channel(&fill->frame.wave[wave]));
        value[1 + wave] = clamp_log2_to_int16(
            glint_dim_compute_log2_q8(light) +
            glint_dim_compute_log2_q8(
                real_of(scratch->probe.energy, planned.energy_up - 30)));
        if (wave == GLINT_DIM_WAVE)
            value[0] = clamp_log2_to_int16(
                glint_dim_compute_log2_q8(planned.irradiance) +
                (scratch->probe.n_up && scratch->probe.n_down ? FOLD_Q8 : 0));
    }
}

static void fill_brightness_node(struct glint_flare *f, int node)
{
    const struct glint_flare_frame *r = f->plan.frame;
    const int64_t one_q30 = INT32_C(1) << 30;
    const int64_t sine_q30 =
        q_divide((int64_t)r->lens->header->sine_hi_q30 * node, GLINT_DIM_LAST);
    const uint64_t cosine2 =
        (uint64_t)(one_q30 * one_q30 - sine_q30 * sine_q30);
    struct fill fill = {.flare = f,
                        .frame = *r,
                        .light = {.sine_q30 = (int32_t)sine_q30,
                                  .cosine_q30 = (int32_t)q_root(cosine2),
                                  .cos_q30 = (int32_t)one_q30,
                                  .power = real_of(1, 0),
                                  .rgb_q14 = {1 << 14, 1 << 14, 1 << 14}},
                        .plan = f->plan,
                        .node = node};

    fill.frame.only_ghost = -1;
    fill.frame.tints = NULL;
    fill.frame.faintest = (struct glint_real){0, 0};
    fill.plan.frame = &fill.frame;
    fill.plan.light = &fill.light;
    fill.plan.n_lights = 1;
    fill.plan.width = fill.plan.height = 1 << 20;
    fill.plan.dims = 0;
    glint_workers_run(f->cfg.workers, (int)r->lens->header->n_ghosts,
                      fill_ghost_entry_job, &fill);
    r->dim->done[node] = 1;
}

static void fill_brightness_nodes(struct glint_flare *flare, int n_lights)
{
    uint8_t *done = flare->plan.frame->dim->done;

    for (int i = 0; i < n_lights; i++) {
        const int at = glint_dim_find_node_q16(flare->plan.frame,
                                               flare->plan.light[i].sine_q30) >>
                       16;

        for (int node = at - 1; node <= at + 2; node++)
            if (node >= 0 && node <= GLINT_DIM_LAST && !done[node])
                fill_brightness_node(flare, node);
    }
}

/* ------------------------------------------------------- merging of lights */

enum {
    /* Max distance of merged lights for a ghost as bright as the frame's
     * parameter dimmest (the limit of dim ghosts): 1 / SIDE of the picture's
     * longer side, four pixels of 1920. For brighter ghosts it is smaller. The
     * errors of N merged lights add up to sqrt(N) times the error of one. */
    SIDE = 480,
    FARTHEST_Q8 = 1 << 14
};

/* Returns the merged light that replaces LIGHT for GHOST. It is stored in the
 * memory of the first ray bundle of GHOST and LIGHT. Returns NULL if that
 * bundle exceeds max_bundles. */
static struct glint_light *get_merged_light(struct glint_flare *f, int ghost,
                                            int light)
{
    const struct glint_flare_frame *r = f->plan.frame;
    const int64_t at =
        ((int64_t)light * (int)r->lens->header->n_ghosts + ghost) * r->n_waves;

    return at < f->cfg.max_bundles ? (void *)&f->planned[at] : NULL;
}

STATIC_ASSERT(sizeof(struct glint_light) <= sizeof(struct glint_bundle_plan));

/* Finds, for each of N lights, the nearest of the lights before it in the list,
 * and log2 of the distance to that light. The unit of distance is 1 / SIDE of
 * the picture's longer side, divided by sqrt(N). */
static void find_nearest_preceding_lights(struct glint_flare *f, int n)
{
    const struct glint_flare_frame *r = f->plan.frame;
    const struct glint_light *light = f->plan.light;
    const int longer = q_larger(f->plan.width, f->plan.height);
    const struct glint_real focal = real_times(
        r->lens->header->focal_mm, r->pixels_per_mm); /* focal length, pixels */
    const int32_t scale_log2 =
        glint_dim_compute_log2_q8(real_over(real_times(focal, real_of(SIDE, 0)),
                                            real_of(longer, 0))) +
        glint_dim_compute_log2_q8(real_of(n, 0)) / 2;

    for (int i = 1; i < n; i++) {
        uint64_t least2_q60 = UINT64_MAX;

        for (int k = 0; k < i; k++) {
            const uint64_t apart2_q60 =
                glint_light_compute_squared_distance_q60(&light[k], &light[i]);

            if (apart2_q60 < least2_q60) {
                least2_q60 = apart2_q60;
                r->dim->nearest[i] = (int16_t)k;
            }
        }
        r->dim->apart_log2_q8[i] = (int16_t)q_clamp_sat(
            scale_log2 + glint_dim_compute_log2_q8(
                             real_of((int64_t)(least2_q60 >> 1 | 1), -59)) /
                             2,
            -FARTHEST_Q8, FARTHEST_Q8);
    }
}

/* Returns the fraction of LIGHT, light number I, that is not merged into
 * another light for GHOST, 0 .. GLINT_DIM_WHOLE_Q8. The error of a merged ghost
 * is its light times the distance by which it moves. Up to half the allowed
 * error, all light is merged. From the allowed error on, no light is merged,
 * nor of light 0, of lights from GLINT_DIM_LIGHTS on, and of lights outside the
 * model. */
static int compute_unmerged_fraction_q8(const struct glint_flare_frame *frame,
                                        const struct glint_light *light, int i,
                                        int ghost)
{
    if (i == 0 || i >= GLINT_DIM_LIGHTS ||
        glint_plan_is_light_outside_model(frame->lens, light))
        return GLINT_DIM_WHOLE_Q8;
    return q_clamp_sat(
        glint_dim_compute_brightness_log2_q8(frame, light, ghost) +
            frame->dim->apart_log2_q8[i],
        0, GLINT_DIM_WHOLE_Q8);
}

/* Divides B, which is light number I for GHOST, into two parts. One is drawn
 * separately; the other is merged into the nearest light before B in the
 * list. */
static void merge_fraction_into_nearest_light(struct glint_flare *f,
                                              struct glint_light *b, int ghost,
                                              int i)
{
    struct glint_light part = *b;
    const int left_q8 =
        compute_unmerged_fraction_q8(f->plan.frame, b, i, ghost);

    if (left_q8 == GLINT_DIM_WHOLE_Q8)
        return;
    b->power = real_times(part.power, real_of(left_q8, -8));
    part.power =
        real_times(part.power, real_of(GLINT_DIM_WHOLE_Q8 - left_q8, -8));
    glint_light_merge(
        get_merged_light(f, ghost, f->plan.frame->dim->nearest[i]), &part);
}

struct gather {
    struct glint_flare *flare;
    int n_lights;
};

/* Worker function: merges the lights of GHOST, from the last to the first. So a
 * light that has received light from a later one can be merged in turn. */
static void merge_ghost_lights_job(void *ctx, int ghost, int worker)
{
    const struct gather *g = ctx;
    struct glint_light *b;
    int n = 0;

    (void)worker;
    for (; n < g->n_lights; n++) {
        b = get_merged_light(g->flare, ghost, n);
        if (!b)
            break;
        *b = g->flare->plan.light[n];
        for (int c = 0; c < 3; c++)
            b->rgb_q14[c] *= 1 << GLINT_LIGHT_HELD;
    }
    for (int i = n - 1; i >= 0; i--) {
        b = get_merged_light(g->flare, ghost, i);
        if (!b)
            continue;
        merge_fraction_into_nearest_light(g->flare, b, ghost, i);
        for (int c = 0; c < 3; c++)
            b->rgb_q14[c] = q_narrow(q_shift(b->rgb_q14[c], GLINT_LIGHT_HELD));
    }
}

static void merge_near_lights_per_ghost(struct glint_flare *flare, int n_lights)
{
    struct gather gather = {flare, n_lights};

    find_nearest_preceding_lights(flare, q_smaller(n_lights, GLINT_DIM_LIGHTS));
    glint_workers_run(flare->cfg.workers,
                      (int)flare->plan.frame->lens->header->n_ghosts,
                      merge_ghost_lights_job, &gather);
}

const struct glint_dim_method glint_dim_method = {
    fill_brightness_nodes,
    merge_near_lights_per_ghost,
    get_merged_light,
    compute_unmerged_fraction_q8,
    glint_dim_compute_own_rays_fraction_q8,
    glint_dim_compute_wave_ratio_q16};
