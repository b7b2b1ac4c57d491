/* SPDX-License-Identifier: MIT
 *
 * Detects frames whose inputs equal those of the previous frame. The bundles,
 * edges and tile lists of the previous frame are then drawn again without
 * tracing a ray. Lights and parameters are compared one by one; there can be
 * thousands of waves and tints, which are compared by a 64-bit digest. */
#include "base/q.h"
#include "flare/state.h"

struct reuse {
    /* Number of lights stored; -1: the frame had more than reuse_lights lights,
     * and none is stored. */
    int n_lights;
    struct glint_flare_frame frame;
    uint64_t digest; /* digest of the wavelengths, their sets and the factors
                        per ghost (tints) to which FRAME points */
    struct glint_light *light;
    /* Colours of the bundles before they are multiplied by gain_q14,
     * [max_bundles]. Set in the first frame that has gains; NULL unless
     * cfg.reuse_gains is set. */
    int32_t (*rgb_q14)[3];
    int has_rgb;
};

/* Allocates the reuse state from arena A. Called twice: first with an arena
 * that only counts bytes, where it returns NULL; then with an arena that has
 * memory. */
static void *allocate_reuse_state(struct glint_arena *a,
                                  const struct glint_flare_config *c)
{
    struct reuse measured, *placed, *own;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    own = placed ? placed : &measured;
    own->light =
        glint_arena_allocate(a, (size_t)c->reuse_lights, sizeof *own->light);
    own->rgb_q14 = NULL;
    if (c->reuse_gains)
        own->rgb_q14 = glint_arena_allocate(a, (size_t)c->max_bundles,
                                            sizeof *own->rgb_q14);
    return placed;
}

static uint64_t add_word_to_digest(uint64_t digest, int64_t x)
{
    const uint64_t y = (digest ^ (uint64_t)x) * UINT64_C(0x9e3779b97f4a7c15);

    return y ^ y >> 29;
}

static uint64_t add_real_to_digest(uint64_t digest, struct glint_real x)
{
    return add_word_to_digest(add_word_to_digest(digest, x.mantissa),
                              x.exponent);
}

static uint64_t add_rgb_to_digest(uint64_t digest, const int32_t rgb_q14[3])
{
    for (int c = 0; c < 3; c++)
        digest = add_word_to_digest(digest, rgb_q14[c]);
    return digest;
}

static uint64_t compute_frame_digest(const struct glint_flare_frame *r)
{
    uint64_t d = 1;

    for (int i = 0; i < r->n_waves; i++) {
        d = add_real_to_digest(add_word_to_digest(d, r->wave[i].wave_q24),
                               r->wave[i].weight);
        d = add_rgb_to_digest(d, r->wave[i].rgb_q14);
    }
    d = add_word_to_digest(d, r->sets != NULL);
    if (r->sets) {
        for (int i = 0; i < r->sets->n_sets; i++)
            d = add_word_to_digest(d, r->sets->size[i]);
        d = add_real_to_digest(add_word_to_digest(d, r->sets->apart_q8),
                               r->sets->step);
    }
    d = add_word_to_digest(d, r->tints != NULL);
    for (uint32_t i = 0; r->tints && i < r->lens->header->n_ghosts; i++)
        d = add_rgb_to_digest(add_real_to_digest(d, r->tints[i].gain),
                              r->tints[i].rgb_q14);
    return d;
}

static int are_reals_equal(struct glint_real a, struct glint_real b)
{
    return a.mantissa == b.mantissa && a.exponent == b.exponent;
}

static int are_lights_equal(const struct glint_light *a,
                            const struct glint_light *b)
{
    return a->sine_q30 == b->sine_q30 && a->cosine_q30 == b->cosine_q30 &&
           a->cos_q30 == b->cos_q30 && a->sin_q30 == b->sin_q30 &&
           a->apart_q30 == b->apart_q30 &&
           are_reals_equal(a->power, b->power) &&
           a->rgb_q14[0] == b->rgb_q14[0] && a->rgb_q14[1] == b->rgb_q14[1] &&
           a->rgb_q14[2] == b->rgb_q14[2];
}

static int are_frame_settings_equal(const struct glint_flare_frame *a,
                                    const struct glint_flare_frame *b)
{
    return a->lens == b->lens && a->n_waves == b->n_waves &&
           are_reals_equal(a->pixels_per_mm, b->pixels_per_mm) &&
           a->fineness == b->fineness && a->uniform == b->uniform &&
           a->only_ghost == b->only_ghost &&
           are_reals_equal(a->faintest, b->faintest) && a->dim == b->dim &&
           are_reals_equal(a->dimmest, b->dimmest) &&
           a->snap_codes_q8 == b->snap_codes_q8 && a->half == b->half;
}

static int are_inputs_unchanged(const struct glint_flare *f,
                                const struct glint_flare_frame *frame,
                                const struct glint_light *lights, int n_lights)
{
    const struct reuse *own = f->reuse;

    if (n_lights != own->n_lights ||
        !are_frame_settings_equal(frame, &own->frame))
        return 0;
    for (int i = 0; i < n_lights; i++)
        if (!are_lights_equal(&lights[i], &own->light[i]))
            return 0;
    return compute_frame_digest(frame) == own->digest;
}

static void store_frame_inputs(struct glint_flare *f,
                               const struct glint_flare_frame *frame,
                               const struct glint_light *lights, int n_lights)
{
    struct reuse *own = f->reuse;

    own->n_lights = n_lights <= f->cfg.reuse_lights ? n_lights : -1;
    own->frame = *frame;
    own->digest = compute_frame_digest(frame);
    for (int i = 0; i < own->n_lights; i++)
        own->light[i] = lights[i];
}

static int reuse_unchanged_frame(struct glint_flare *f,
                                 const struct glint_flare_frame *frame,
                                 const struct glint_light *lights, int n_lights)
{
    if (f->reusable != GLINT_REUSABLE_BINNED ||
        !are_inputs_unchanged(f, frame, lights, n_lights)) {
        store_frame_inputs(f, frame, lights, n_lights);
        return 0;
    }
    f->plan.frame = frame;
    f->plan.light = lights;
    f->stats.reused = 1;
    for (int i = 0; i < glint_workers_count(f->cfg.workers); i++)
        f->worker[i].plan->n_rays = 0;
    return 1;
}

static void apply_light_gains(struct glint_flare *f)
{
    struct reuse *own = f->reuse;
    const int32_t(*gain_q14)[3] = f->plan.frame->gain_q14;

    if (f->reusable == GLINT_REUSABLE_PLANNED)
        own->has_rgb = 0;
    f->reusable = GLINT_REUSABLE_BINNED;
    if (!own->rgb_q14 || (!gain_q14 && !own->has_rgb))
        return;
    for (int i = 0; i < f->n_bundles; i++)
        for (int c = 0; c < 3; c++) {
            int32_t *rgb = &f->bundle[i].rgb_q14[c], *was = &own->rgb_q14[i][c];

            if (!own->has_rgb)
                *was = *rgb;
            *rgb =
                gain_q14
                    ? q_narrow(q_shift(
                          (int64_t)*was * gain_q14[f->planned[i].light][c], 14))
                    : *was;
        }
    own->has_rgb = 1;
}

const struct glint_reuse glint_reuse = {
    allocate_reuse_state, reuse_unchanged_frame, apply_light_gains};
