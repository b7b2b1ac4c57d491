/* SPDX-License-Identifier: MIT */
#include "engine/strength.h"

#include <math.h>

#include "engine/setup/spectrum.h"

/* Exponent of the norm by which the peaks of several flares are combined. With
 * 4, the combined peak of sixteen equal flares is twice that of one. Flares
 * rarely overlap. */
static const double norm = 4;

/* mean light of a flare that counts as much as a peak of white, 1 = white */
static const double mean_most = 0.32;

/* Max mean light of the flare at strength 1, 1 = white. At strength 0.5 it is
 * 1.5 % of white. From about twice that on, ghosts that cover the picture look
 * like fog. */
static const double fog_most = 0.06;

/* log2 of the light of a flare of medium brightness at --exposure 0, 1 = white
 */
static const double common_log2 = -5;
/* increase of the flare's brightness after exposure, stops, per stop of lamp
 * power */
static const double compression = 0.15;

/* Limits of the exposure's correction at strength 0.5, 1 = white. seen_peak,
 * seen_mean: max peak and max mean to which an invisible flare is raised.
 * veil_peak: min peak to which a veiling flare is lowered. */
static const double seen_peak = 0.6, seen_mean = 0.04, veil_peak = 0.1;

/* target for a flare that veils a quarter of the picture: light of the flare
 * there / min visible light */
static const double veil_light = 0.5;

/* target for ghosts on bright parts of the picture: light of the brightest
 * ghosts / light that turns these parts white */
static const double white_part = 0.4;

/* Limits of the change of the exposure over time: stops per second when it
 * falls and when it rises, stops per frame, and the time constant in
 * seconds. */
static const double fall_per_s = 3, rise_per_s = 2, most_per_frame = 0.125;
static const double settle_s = 0.3;

/* max fraction by which the flare of a new lamp exceeds the flare that the lamp
 * would have if it were exposed alone */
static const double overshoot = 0.5;

void glint_strength_set_defaults(struct glint_strength *strength)
{
    *strength = (struct glint_strength){.asked = 0.5, .gain = 1};
}

/* --------------------------------------------------------------- one frame */

/* Sets LIGHT to the light of the flare of lamp I at scale 1. The lamp's fade
 * level is assumed to be 1. */
static void compute_lamp_flare_light(const struct glint_response *response,
                                     const struct glint_strength_lamps *lamps,
                                     int i, struct glint_response_light *light)
{
    const struct glint_lamp *l = &lamps->lamp[i].lamp;
    const double power = l->power / lamps->pixels / lamps->lamp[i].level;
    const double softening = glint_response_compute_softening(response, l);

    glint_response_interpolate_light(response, l->theta_deg, light);
    for (int c = 0; c < 3; c++) {
        light->peak[c] *= power * softening * l->rgb[c];
        light->mean[c] *= power * l->rgb[c];
    }
}

static void add_lamp_light(struct glint_response_light *sum,
                           const struct glint_response_light *light,
                           double level)
{
    for (int c = 0; c < 3; c++) {
        sum->peak[c] += pow(level * light->peak[c], norm);
        sum->mean[c] += level * light->mean[c];
    }
}

static void convert_sums_to_peaks(struct glint_response_light *sum)
{
    for (int c = 0; c < 3; c++)
        sum->peak[c] = pow(sum->peak[c], 1 / norm);
}

void glint_strength_compute_light(const struct glint_response *response,
                                  const struct glint_strength_lamps *lamps,
                                  struct glint_response_light *light)
{
    *light = (struct glint_response_light){{0}, {0}};
    for (int i = 0; i < lamps->n; i++) {
        struct glint_response_light one;

        compute_lamp_flare_light(response, lamps, i, &one);
        add_lamp_light(light, &one, lamps->lamp[i].level);
    }
    convert_sums_to_peaks(light);
}

static double combine_peaks_by_norm(double a, double b)
{
    return pow(pow(a, norm) + pow(b, norm), 1 / norm);
}

/* Returns log2 of the factor on light at the requested strength / the factor at
 * strength 1. */
static double compute_strength_log2(const struct glint_strength *s)
{
    return 2 * log2(s->asked);
}

/* Returns log2 of the factor that exposes a flare of brightness LIGHT at
 * strength 1. It is limited so that the flare does not look like fog.
 * strength.h has the formula. */
static double compute_exposure_log2(const struct glint_response_light *light)
{
    const double peak = fmax(glint_largest_channel(light->peak), 1e-60);
    const double light_mean = fmax(glint_largest_channel(light->mean), 1e-60);
    const double mean = light_mean / mean_most;
    const double more =
        compression * (log2(combine_peaks_by_norm(peak, mean)) - common_log2);

    return fmin(-log2(combine_peaks_by_norm(peak * exp2(-tanh(more)), mean)),
                log2(fog_most / light_mean));
}

/* --------------------------------------------------------------- over time */

static double limit_exposure_change(double towards, double elapsed_s)
{
    const double part = 1 - exp(-elapsed_s / settle_s);
    const double most = fmin(
        (towards > 0 ? rise_per_s : fall_per_s) * elapsed_s, most_per_frame);

    return fmin(fmax(part * towards, -most), most);
}

/* Returns the factor that limits the light of a lamp. TIMES is the lamp's
 * exposure divided by the exposure that it would get alone. For TIMES up to 1
 * the factor is 1. Above, the product of TIMES and the factor rises ever more
 * slowly to 1 + overshoot. */
static double compute_exposure_limit(double times)
{
    return times <= 1 ? 1
                      : (1 + overshoot * tanh((times - 1) / overshoot)) / times;
}

/* Lowers LIGHT, the light of a lamp's ghosts, if the ghosts are brighter than
 * if the lamp were exposed alone. Returns the factor by which it is lowered. */
static double limit_lamp_light(const struct glint_strength *s,
                               struct glint_response_light *light)
{
    const double times = exp2(s->factor_log2 - compute_exposure_log2(light));
    const double by = compute_exposure_limit(times);

    for (int c = 0; c < 3; c++) {
        light->peak[c] *= by;
        light->mean[c] *= by;
    }
    return by;
}

static void follow_exposure_target(struct glint_strength *s, double target,
                                   int32_t elapsed_us)
{
    if (elapsed_us > 0 && s->follows)
        s->factor_log2 +=
            limit_exposure_change(target - s->factor_log2, 1e-6 * elapsed_us);
    else
        s->factor_log2 = target;
    s->follows = true;
}

/* Returns log2 of the factor that exposes all lamps together at strength 1. The
 * fade levels of all lamps are assumed to be 1. */
static double
compute_full_level_exposure_log2(const struct glint_response *response,
                                 const struct glint_strength_lamps *lamps)
{
    struct glint_strength_lamps full = *lamps;
    struct glint_response_light light = {{0}, {0}};

    for (int i = 0; i < full.n; i++) {
        struct glint_response_light one;

        compute_lamp_flare_light(response, &full, i, &one);
        add_lamp_light(&light, &one, 1);
    }
    convert_sums_to_peaks(&light);
    return compute_exposure_log2(&light);
}

static void expose_lamps_of_frame(struct glint_strength *s,
                                  const struct glint_response *response,
                                  const struct glint_strength_lamps *lamps,
                                  int32_t elapsed_us)
{
    follow_exposure_target(s, compute_full_level_exposure_log2(response, lamps),
                           elapsed_us);
    for (int i = 0; i < lamps->n; i++) {
        struct glint_response_light one;

        compute_lamp_flare_light(response, lamps, i, &one);
        lamps->part[i] = limit_lamp_light(s, &one);
        add_lamp_light(&s->light, &one, lamps->lamp[i].level);
    }
    convert_sums_to_peaks(&s->light);
    s->scale = s->gain * exp2(compute_strength_log2(s) + s->factor_log2);
}

static void scale_flare_light(struct glint_strength *s)
{
    for (int c = 0; c < 3; c++) {
        s->light.peak[c] *= s->scale;
        s->light.mean[c] *= s->scale;
    }
}

void glint_strength_expose_frame(struct glint_strength *strength,
                                 const struct glint_response *response,
                                 const struct glint_strength_lamps *lamps,
                                 int32_t elapsed_us)
{
    struct glint_strength *s = strength;

    s->light = (struct glint_response_light){{0}, {0}};
    s->scale = 0;
    s->is_drawn = false;
    for (int i = 0; i < lamps->n; i++)
        lamps->part[i] = 1;
    if (lamps->n == 0) {
        s->follows = false;
        return;
    }
    if (s->is_physical) {
        glint_strength_compute_light(response, lamps, &s->light);
        s->scale = s->gain * exp2(s->exposure_ev);
    } else {
        expose_lamps_of_frame(s, response, lamps, elapsed_us);
    }
    scale_flare_light(s);
}

/* Returns the correction of the exposure of the flare DRAWN, stops. BASE: log2
 * of the flare's factor at strength 0.5. A flare that veils the picture, or
 * turns bright parts of it white, is lowered until it no longer does, but not
 * below a peak of veil_peak. Otherwise an invisible flare is raised until it is
 * visible, or reaches a peak of seen_peak or a mean of seen_mean. */
static double
compute_visibility_lift_log2(double base,
                             const struct glint_response_light *drawn,
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

void glint_strength_correct_exposure(struct glint_strength *strength,
                                     const struct glint_response_light *drawn,
                                     const struct glint_seen *seen)
{
    struct glint_strength *s = strength;

    if (s->is_physical || !(s->scale > 0) ||
        !(glint_largest_channel(drawn->peak) > 0))
        return;
    s->is_drawn = true;
    s->factor_log2 = compute_exposure_log2(drawn);
    if (seen)
        s->factor_log2 +=
            compute_visibility_lift_log2(s->factor_log2 - 2, drawn, seen);
    s->scale = s->gain * exp2(compute_strength_log2(s) + s->factor_log2);
    s->light = *drawn;
    scale_flare_light(s);
}

enum glint_status glint_strength_expose_still_picture(
    struct glint_strength *strength, struct glint_frame *frame,
    const struct glint_lamp *lamps, int n, const struct glint_ground *ground,
    double white)
{
    struct glint_response_light drawn;
    struct glint_seen seen = {0, 0, 0};
    enum glint_status status;

    if (strength->is_physical || !(strength->scale > 0))
        return GLINT_OK;
    status = glint_response_draw_and_measure(
        frame, lamps, n, GLINT_RESPONSE_FINE, ground, &drawn, &seen);
    if (status != GLINT_OK)
        return status == GLINT_E_MEMORY ? status : GLINT_OK;
    seen.few /= white;
    seen.many /= white;
    seen.white /= white;
    for (int c = 0; c < 3; c++) {
        drawn.peak[c] /= white;
        drawn.mean[c] /= white;
    }
    glint_strength_correct_exposure(strength, &drawn, ground ? &seen : NULL);
    return GLINT_OK;
}

double glint_strength_compute_star_factor(const struct glint_strength *s,
                                          double starburst)
{
    const double by =
        s->is_physical ? exp2(s->exposure_ev) : 4 * s->asked * s->asked;

    return s->scale > 0 ? starburst * s->gain * by / s->scale : 0;
}
