/* SPDX-License-Identifier: MIT */
#include "engine/strength.h"

#include <math.h>

#include "engine/setup/spectrum.h"

/* Exponent of the sum of many lights: with 4, sixteen equal flares, which
 * mostly lie side by side, count as two on top of each other. */
static const double norm = 4;

/* Display light of the mean at strength 1, about a third of the largest. */
static const double mean_most = 0.32;

/* log2 of display light at --exposure 0 that is neither much nor little. */
static const double common_log2 = -5;
/* Stops of change for a stop of light. */
static const double compression = 0.15;

/* Display light at strength 0.5: limits of the brightest part and of the mean
 * up to which a hidden flare is lifted, and the least of the brightest part to
 * which a veil is lowered. */
static const double seen_peak = 0.6, seen_mean = 0.04, veil_peak = 0.1;

/* Light that a veil leaves on a quarter of the picture / the least visible
 * light. */
static const double veil_light = 0.5;

/* Light of the brightest ghosts on bright ground / that which turns it white.
 */
static const double white_part = 0.4;

/* How the factor follows: stops a second, most stops a frame, and the time
 * constant. */
static const double fall_per_s = 3, rise_per_s = 2, most_per_frame = 0.125;
static const double settle_s = 0.3;

/* A lamp is at most this much brighter than it would be alone, as a fraction.
 */
static const double overshoot = 0.5;

void glint_strength_defaults(struct glint_strength *strength)
{
    *strength = (struct glint_strength){.asked = 0.5, .gain = 1};
}

/* --------------------------------------------------------------- one frame */

/* Sets LIGHT to that of lamp I at full level, by channel. */
static void light_of(const struct glint_response *response,
                     const struct glint_strength_lamps *lamps, int i,
                     struct glint_response_light *light)
{
    const struct glint_lamp *l = &lamps->lamp[i].lamp;
    const double power = l->power / lamps->pixels / lamps->lamp[i].level;
    const double softening = glint_response_softening(response, l);

    glint_response_at(response, l->theta_deg, light);
    for (int c = 0; c < 3; c++) {
        light->peak[c] *= power * softening * l->rgb[c];
        light->mean[c] *= power * l->rgb[c];
    }
}

static void add(struct glint_response_light *sum,
                const struct glint_response_light *light, double level)
{
    for (int c = 0; c < 3; c++) {
        sum->peak[c] += pow(level * light->peak[c], norm);
        sum->mean[c] += level * light->mean[c];
    }
}

static void finish(struct glint_response_light *sum)
{
    for (int c = 0; c < 3; c++)
        sum->peak[c] = pow(sum->peak[c], 1 / norm);
}

void glint_strength_light(const struct glint_response *response,
                          const struct glint_strength_lamps *lamps,
                          struct glint_response_light *light)
{
    *light = (struct glint_response_light){{0}, {0}};
    for (int i = 0; i < lamps->n; i++) {
        struct glint_response_light one;

        light_of(response, lamps, i, &one);
        add(light, &one, lamps->lamp[i].level);
    }
    finish(light);
}

static double together(double a, double b)
{
    return pow(pow(a, norm) + pow(b, norm), 1 / norm);
}

/* Returns the factor in stops of the strength that the caller set. */
static double own_log2(const struct glint_strength *s)
{
    return 2 * log2(s->asked);
}

/* Returns the factor in stops that LIGHT requests at strength 1. */
static double target_log2(const struct glint_response_light *light)
{
    const double peak = fmax(glint_largest_channel(light->peak), 1e-60);
    const double mean = glint_largest_channel(light->mean) / mean_most;
    const double more =
        compression * (log2(together(peak, mean)) - common_log2);

    return -log2(together(peak * exp2(-tanh(more)), mean));
}

/* --------------------------------------------------------------- over time */

static double step(double towards, double elapsed_s)
{
    const double part = 1 - exp(-elapsed_s / settle_s);
    const double most = fmin(
        (towards > 0 ? rise_per_s : fall_per_s) * elapsed_s, most_per_frame);

    return fmin(fmax(part * towards, -most), most);
}

/* Returns the factor that lowers TIMES: 1 up to TIMES 1, then such that the
 * product rises ever more slowly to 1 + overshoot. */
static double held(double times)
{
    return times <= 1 ? 1
                      : (1 + overshoot * tanh((times - 1) / overshoot)) / times;
}

/* Lowers lamp I towards the exposure that it would get alone; LIGHT is its own
 * light. */
static void hold(const struct glint_strength *s,
                 const struct glint_strength_lamps *lamps, int i,
                 struct glint_response_light *light)
{
    const double times = exp2(s->factor_log2 - target_log2(light));
    const double by = held(times);

    lamps->lamp[i].lamp.power *= by;
    for (int c = 0; c < 3; c++) {
        light->peak[c] *= by;
        light->mean[c] *= by;
    }
}

static void follow(struct glint_strength *s, double target, int32_t elapsed_us)
{
    if (elapsed_us > 0 && s->follows)
        s->factor_log2 += step(target - s->factor_log2, 1e-6 * elapsed_us);
    else
        s->factor_log2 = target;
    s->follows = true;
}

/* Returns the factor in stops at strength 1 for all lamps at full level. */
static double target_of(const struct glint_response *response,
                        const struct glint_strength_lamps *lamps)
{
    struct glint_strength_lamps full = *lamps;
    struct glint_response_light light = {{0}, {0}};

    for (int i = 0; i < full.n; i++) {
        struct glint_response_light one;

        light_of(response, &full, i, &one);
        add(&light, &one, 1);
    }
    finish(&light);
    return target_log2(&light);
}

static void expose(struct glint_strength *s,
                   const struct glint_response *response,
                   const struct glint_strength_lamps *lamps, int32_t elapsed_us)
{
    follow(s, target_of(response, lamps), elapsed_us);
    for (int i = 0; i < lamps->n; i++) {
        struct glint_response_light one;

        light_of(response, lamps, i, &one);
        hold(s, lamps, i, &one);
        add(&s->light, &one, lamps->lamp[i].level);
    }
    finish(&s->light);
    s->scale = s->gain * exp2(own_log2(s) + s->factor_log2);
}

static void scale_light(struct glint_strength *s)
{
    for (int c = 0; c < 3; c++) {
        s->light.peak[c] *= s->scale;
        s->light.mean[c] *= s->scale;
    }
}

void glint_strength_expose(struct glint_strength *strength,
                           const struct glint_response *response,
                           const struct glint_strength_lamps *lamps,
                           int32_t elapsed_us)
{
    struct glint_strength *s = strength;

    s->light = (struct glint_response_light){{0}, {0}};
    s->scale = 0;
    s->is_drawn = false;
    if (lamps->n == 0) {
        s->follows = false;
        return;
    }
    if (s->is_physical) {
        glint_strength_light(response, lamps, &s->light);
        s->scale = s->gain * exp2(s->exposure_ev);
    } else {
        expose(s, response, lamps, elapsed_us);
    }
    scale_light(s);
}

/* Returns the stops by which the flare DRAWN is lifted so that it can be seen,
 * or lowered so that it neither is a veil nor turns a bright picture white,
 * within the limits of its brightest part and its mean. BASE: log2 of its
 * factor at strength 0.5. */
static double lift_log2(double base, const struct glint_response_light *drawn,
                        const struct glint_seen *seen)
{
    const double peak = log2(fmax(glint_largest_channel(drawn->peak), 1e-60));
    const double mean = log2(fmax(glint_largest_channel(drawn->mean), 1e-60));
    const double room = fmin(log2(seen_peak) - peak, log2(seen_mean) - mean);
    const double few = seen->few > 0 ? -log2(seen->few) : room;
    const double many = seen->many > 0 ? log2(veil_light / seen->many) : room;
    const double white =
        seen->white > 0 ? log2(white_part / seen->white) : room;

    if (fmin(many, white) < base)
        return fmin(fmax(fmin(many, white), log2(veil_peak) - peak) - base, 0);
    return fmax(fmin(fmin(few, white), room) - base, 0);
}

void glint_strength_correct(struct glint_strength *strength,
                            const struct glint_response_light *drawn,
                            const struct glint_seen *seen)
{
    struct glint_strength *s = strength;

    if (s->is_physical || !(s->scale > 0) ||
        !(glint_largest_channel(drawn->peak) > 0))
        return;
    s->is_drawn = true;
    s->factor_log2 = target_log2(drawn);
    if (seen)
        s->factor_log2 += lift_log2(s->factor_log2 - 2, drawn, seen);
    s->scale = s->gain * exp2(own_log2(s) + s->factor_log2);
    s->light = *drawn;
    scale_light(s);
}

enum glint_status glint_strength_expose_still(struct glint_strength *strength,
                                              const struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n,
                                              const struct glint_ground *ground,
                                              double white)
{
    struct glint_response_light drawn;
    struct glint_seen seen = {0, 0, 0};
    enum glint_status status;

    if (strength->is_physical || !(strength->scale > 0))
        return GLINT_OK;
    status = glint_response_draw(frame, lamps, n, GLINT_RESPONSE_FINE, ground,
                                 &drawn, &seen);
    if (status != GLINT_OK)
        return status == GLINT_E_MEMORY ? status : GLINT_OK;
    seen.few /= white;
    seen.many /= white;
    seen.white /= white;
    for (int c = 0; c < 3; c++) {
        drawn.peak[c] /= white;
        drawn.mean[c] /= white;
    }
    glint_strength_correct(strength, &drawn, ground ? &seen : NULL);
    return GLINT_OK;
}

double glint_strength_star(const struct glint_strength *s, double starburst)
{
    const double by =
        s->is_physical ? exp2(s->exposure_ev) : 4 * s->asked * s->asked;

    return s->scale > 0 ? starburst * s->gain * by / s->scale : 0;
}
