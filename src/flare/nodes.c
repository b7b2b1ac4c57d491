/* SPDX-License-Identifier: MIT
 *
 * Fills the table of flare/dim.h: logarithms of each ghost's light at nodes of
 * the sine of the light's angle, of a white light of power 1, wherever the
 * picture lies. */
#include "flare/dim.h"
#include "flare/state.h"

enum {
    MOST_Q8 = 1 << 14,
    FOLD_Q8 = 3 << 8 /* a fold is as much brighter than its ghost's mean */
};

struct fill {
    struct glint_flare *flare;
    struct glint_flare_frame frame;
    struct glint_light light;
    struct glint_plan plan;
    int node;
};

static int16_t value_of(int32_t log2)
{
    return (int16_t)q_clamp_sat(log2, -MOST_Q8, MOST_Q8);
}

/* Returns the largest channel of wave W. */
static struct glint_real channel_of(const struct glint_wave *w)
{
    int32_t most = 0;

    for (int c = 0; c < 3; c++) {
        const int32_t x = w->rgb_q14[c];

        most = x > most ? x : -x > most ? -x : most;
    }
    return real_of(most, -14);
}

/* One ghost at a node. A picture without end holds all of it. */
static void fill_job(void *ctx, int ghost, int worker)
{
    const struct fill *fill = ctx;
    struct glint_plan_scratch *scratch = fill->flare->worker[worker].plan;
    int16_t *value = glint_dim_values(&fill->frame, fill->node, ghost);

    for (int wave = 0; wave < GLINT_DIM_WAVES; wave++) {
        struct glint_bundle_plan planned = {.ghost = ghost, .wave = wave};
        struct glint_bundle bundle;
        struct glint_real light; /* at energy 1 */

        value[1 + wave] = GLINT_DIM_DARK;
        if (glint_plan_bundle(&fill->plan, &planned, &bundle, scratch) !=
                GLINT_OUTCOME_DRAWN ||
            planned.irradiance.mantissa == 0 || scratch->probe.energy <= 0)
            continue;
        light = real_over(planned.flux, channel_of(&fill->frame.wave[wave]));
        value[1 + wave] =
            value_of(glint_dim_log2_q8(light) +
                     glint_dim_log2_q8(real_of(scratch->probe.energy,
                                               planned.energy_up - 30)));
        if (wave == GLINT_DIM_WAVE)
            value[0] = value_of(
                glint_dim_log2_q8(planned.irradiance) +
                (scratch->probe.n_up && scratch->probe.n_down ? FOLD_Q8 : 0));
    }
}

static void fill_node(struct glint_flare *f, int node)
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
    fill.frame.faintest = (struct glint_real){0, 0};
    fill.plan.frame = &fill.frame;
    fill.plan.light = &fill.light;
    fill.plan.n_lights = 1;
    fill.plan.width = fill.plan.height = 1 << 20;
    fill.plan.dims = 0;
    glint_workers_run(f->cfg.workers, (int)r->lens->header->n_ghosts, fill_job,
                      &fill);
    r->dim->done[node] = 1;
}

static void fill_nodes(struct glint_flare *flare, int n_lights)
{
    uint8_t *done = flare->plan.frame->dim->done;

    for (int i = 0; i < n_lights; i++) {
        const int at =
            glint_dim_node_q16(flare->plan.frame, &flare->plan.light[i]) >> 16;

        for (int node = at - 1; node <= at + 2; node++)
            if (node >= 0 && node <= GLINT_DIM_LAST && !done[node])
                fill_node(flare, node);
    }
}

const struct glint_dim_method glint_dim_method = {
    fill_nodes, glint_dim_share_q8, glint_dim_ratio_q16};
