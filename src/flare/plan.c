/* SPDX-License-Identifier: MIT */
#include "flare/plan.h"

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"
#include "flare/dim.h"
#include "flare/plan_cells.h"

enum {
    /* number of cells across the small probe; a row has GLINT_RAYS rays, which
     * are traced at once */
    FEW_ACROSS = GLINT_RAYS - 1,
    FEW_DOWN = 4,
    FEW_INSIDE = 6,
    ONE_Q16 = 1 << 16,
    WIDEST_Q16 = 64 << 16, /* max enlargement of a ghost */
    FARTHEST_Q8 = 1 << 20  /* max distance of the point about which a ghost is
                              enlarged from the picture's middle, pixels */
};

/* Converts X, a length in units of the sensor outputs of T, to pixels, clamped
 * to +-2^23 pixels. */
static int64_t convert_to_pixels_q8(const struct glint_plan *p,
                                    const struct glint_transfer *t, int64_t x)
{
    return real_integer(real_times(real_of(x, t->exponent[GLINT_OUT_SENSOR_X]),
                                   plan_compute_pixels_per_mm(p)),
                        8, INT64_C(1) << 31);
}

/* Returns the length X, pixels, in a ghost after the ghost is enlarged. */
static int64_t scale_by_enlargement(const struct glint_bundle_plan *s,
                                    int64_t x_q8)
{
    return s->wider_q16 ? x_q8 * s->wider_q16 >> 16 : x_q8;
}

/* The bounding box of a ray bundle's light, pixels. One axis points along the
 * light's azimuth, the other is perpendicular to it. The box has the centre
 * (middle, across) and half the size (wide, high). */
struct reach {
    int64_t middle_q8, across_q8, wide_q8, high_q8;
};

/* Returns half the size of E perpendicular to the light's azimuth. */
static int64_t compute_extent_half_height(const struct glint_probe_extent *e)
{
    return (e->y_high - e->y_low) / 2;
}

/* Returns the bounding box, in pixels, of E, the extent of the probed rays,
 * enlarged by a tenth and one pixel. */
static struct reach compute_bundle_box(const struct glint_plan *p,
                                       const struct glint_bundle_plan *planned,
                                       const struct glint_transfer *t,
                                       const struct glint_probe_extent *e)
{
    const int64_t high = compute_extent_half_height(e);

    return (struct reach){
        convert_to_pixels_q8(p, t, (e->low + e->high) / 2),
        convert_to_pixels_q8(p, t, (e->y_low + e->y_high) / 2),
        scale_by_enlargement(
            planned,
            convert_to_pixels_q8(p, t, q_divide((e->high - e->low) * 11, 20))) +
            256,
        scale_by_enlargement(
            planned, convert_to_pixels_q8(p, t, high + q_divide(high, 10))) +
            256};
}

/* Returns whether the box E, rotated by TURN, overlaps the picture. A ghost is
 * rotated by the light's azimuth, and then across of E is 0; or by 0 or 180
 * degrees. So the magnitudes of sine, cosine, middle and across suffice. */
static int is_box_in_picture(const struct glint_plan *p,
                             struct glint_azimuth turn, const struct reach *e)
{
    const int64_t c = turn.cos_q30 < 0 ? -turn.cos_q30 : turn.cos_q30;
    const int64_t s = turn.sin_q30 < 0 ? -turn.sin_q30 : turn.sin_q30;
    const int64_t m = e->middle_q8 < 0 ? -e->middle_q8 : e->middle_q8;
    const int64_t n = e->across_q8 < 0 ? -e->across_q8 : e->across_q8;

    return ((m - e->wide_q8) * c + s * (n - e->high_q8)) >> 30 <=
               p->width * 128 >> p->half &&
           ((m - e->wide_q8) * s + c * (n - e->high_q8)) >> 30 <=
               p->height * 128 >> p->half;
}

/* Returns the fraction of the interval MIDDLE - WIDE .. MIDDLE + WIDE that lies
 * within -HALF .. HALF; 255 means all of it. */
static int64_t compute_interval_overlap_q8(int64_t middle, int64_t wide,
                                           int64_t half)
{
    const int64_t low = middle - wide > -half ? middle - wide : -half;
    const int64_t high = middle + wide < half ? middle + wide : half;

    return high > low && wide > 0 ? q_divide(255 * (high - low), 2 * wide) : 0;
}

/* Returns the fraction of a ray bundle's bounding box that is on-screen; 255
 * means all of it. The box is axis-parallel and encloses E rotated by TURN. */
static uint8_t compute_visible_fraction_q8(const struct glint_plan *p,
                                           struct glint_azimuth turn,
                                           const struct reach *e)
{
    const int64_t c = turn.cos_q30 < 0 ? -turn.cos_q30 : turn.cos_q30;
    const int64_t s = turn.sin_q30 < 0 ? -turn.sin_q30 : turn.sin_q30;
    const int64_t across = compute_interval_overlap_q8(
        e->middle_q8 * c >> 30, (e->wide_q8 * c + e->high_q8 * s) >> 30,
        p->width * 128 >> p->half);
    const int64_t down = compute_interval_overlap_q8(
        (e->middle_q8 * s + e->across_q8 * c) >> 30,
        (e->wide_q8 * s + e->high_q8 * c) >> 30, p->height * 128 >> p->half);

    return (uint8_t)((across * down + 254) >> 8);
}

static struct glint_real get_pupil_box_side(const struct glint_transfer *t,
                                            int k)
{
    return real_of(t->box[k], t->box_exponent);
}

/* Returns (light of wavelength WAVE that is drawn with the rays of PLANNED) /
 * (light of PLANNED's own wavelength). It is 1 for that wavelength. For other
 * wavelengths of a dim ghost it is the part that is not drawn with rays of WAVE
 * itself. */
static int64_t compute_dim_factor_q16(const struct glint_plan *p,
                                      const struct glint_bundle_plan *planned,
                                      int wave, int share_q8)
{
    if (wave == planned->wave)
        return 1 << 16;
    return q_shift(p->frame->dim->method->wave_ratio_q16(
                       p->frame, planned->sine_q30, planned->ghost, wave) *
                       (GLINT_DIM_WHOLE_Q8 - share_q8),
                   8);
}

/* Sets RGB to the colour of the ray bundle, scaled such that its largest
 * channel is 1. The colour is the product of the colours of its light, its
 * wavelengths and its tint. Returns the largest channel before scaling. */
static struct glint_real
compute_bundle_colour(const struct glint_plan *p, const struct glint_light *b,
                      const struct glint_bundle_plan *planned, int share_q8,
                      int32_t *rgb_q14)
{
    const struct glint_wave *w = p->frame->wave;
    const struct glint_tint *tint =
        p->frame->tints ? &p->frame->tints[planned->ghost] : NULL;
    const int mixes =
        share_q8 < GLINT_DIM_WHOLE_Q8 && planned->wave == GLINT_DIM_WAVE;
    const int first = mixes ? 0 : planned->wave;
    const int last = mixes ? GLINT_DIM_WAVES - 1 : planned->wave;
    int64_t rgb_q28[3] = {0, 0, 0}, most = 0;

    for (int wave = first; wave <= last; wave++) {
        const int64_t part = compute_dim_factor_q16(p, planned, wave, share_q8);

        for (int c = 0; c < 3; c++)
            rgb_q28[c] +=
                q_shift((int64_t)w[wave].rgb_q14[c] * b->rgb_q14[c] * part, 16);
    }
    for (int c = 0; c < 3; c++) {
        int64_t x = rgb_q28[c];

        if (tint)
            rgb_q28[c] = x = q_shift(x * tint->rgb_q14[c], 14);
        most = x > most ? x : -x > most ? -x : most;
    }
    for (int c = 0; c < 3; c++)
        rgb_q14[c] =
            most ? q_narrow(q_divide(rgb_q28[c] * (1 << 14), most)) : 0;
    return tint ? real_times(real_of(most, -28), tint->gain)
                : real_of(most, -28);
}

/* Returns the flux that the ray bundle would have if all rays of its window had
 * energy 2^EXPONENT, display white times pixels. The window is the rectangle of
 * the pupil that is traced. If the pupil is an annulus, the area of its hole is
 * excluded. */
static struct glint_real compute_bundle_flux(const struct glint_plan *p,
                                             const struct glint_light *b,
                                             const struct glint_bundle_plan *s,
                                             const struct glint_transfer *t,
                                             struct glint_real colour,
                                             int exponent)
{
    const struct glint_wave *w = &p->frame->wave[s->wave];
    struct glint_real x =
        real_times(get_pupil_box_side(t, 1), get_pupil_box_side(t, 2));

    /* Both factors are half sides of the pupil's bounding box. Unless T covers
     * the complete box, the window covers half of its height only. */
    x.exponent += (t->whole ? 1 : 2) + exponent;
    /* A pixel at half resolution covers four pixels of the picture. */
    x.exponent -= 2 * p->half;
    if (t->annulus)
        x = real_over(x, real_of(t->annulus + 1, 0));
    x = real_times(x, real_of(t->window.u_half_q30, -30));
    x = real_times(
        x, real_of((int64_t)t->window.v_to_q30 - t->window.v_from_q30, -30));
    x = real_times(x, real_of(b->cosine_q30, -30));
    x = real_times(x, real_times(w->weight, b->power));
    return real_times(x, colour);
}

/* Returns an upper bound on the light that the ray bundle adds to a pixel, 1 =
 * display white: twice the flux of a cell of the probe / min area of such a
 * cell on the sensor. The factor 2 allows for brighter light between probed
 * rays. Returns 0 if that area is not known or nearly 0, and for folded ghosts,
 * whose areas do not bound their brightness. */
static struct glint_real
compute_max_light(const struct glint_plan *p,
                  const struct glint_bundle_plan *planned,
                  const struct glint_probe *s, const struct glint_transfer *t,
                  struct glint_real flux)
{
    struct glint_real area;

    if ((s->n_up && s->n_down) || s->least_area < 2 ||
        s->least_area == UINT64_MAX)
        return real_of(0, 0);
    area = real_times(real_of((int64_t)(s->least_area >> 1),
                              2 * t->exponent[GLINT_OUT_SENSOR_X] + 2),
                      real_times(plan_compute_pixels_per_mm(p),
                                 plan_compute_pixels_per_mm(p)));
    if (planned->wider_q16)
        area = real_times(
            area,
            real_of((int64_t)planned->wider_q16 * planned->wider_q16, -32));
    flux.exponent += 1;
    /* number of cells of the complete pupil box */
    area = real_times(area, real_of(s->across * s->rows, 0));
    return real_over(flux, area);
}

/* Returns the max light of a pixel, BRIGHTEST, in units of the min visible
 * light. Returns 2^20 units if BRIGHTEST is 0 (unknown) or the picture is
 * linear. */
static int64_t compute_peak_in_visible_units_q20(const struct glint_plan *p,
                                                 struct glint_real brightest)
{
    const int64_t most = INT64_C(1) << 40;

    if (p->frame->faintest.mantissa == 0 || brightest.mantissa == 0)
        return most;
    return real_integer(real_over(brightest, p->frame->faintest), 20, most);
}

/* Sets inside_q8 of PLANNED to the fraction of probed rays that are not
 * blocked, and contrast_q4 to log2 of (BRIGHTEST / mean irradiance), or 255 if
 * either is 0. */
static void
set_unblocked_fraction_and_contrast(const struct glint_probe *s,
                                    struct glint_real brightest,
                                    struct glint_bundle_plan *planned)
{
    const int nodes = (s->across + 1) * (s->down + 1);

    planned->inside_q8 = (uint8_t)q_divide(255 * (int64_t)s->n_inside, nodes);
    planned->contrast_q4 = 255;
    if (brightest.mantissa && planned->irradiance.mantissa)
        planned->contrast_q4 = (uint8_t)q_clamp_sat(
            (glint_dim_compute_log2_q8(brightest) -
             glint_dim_compute_log2_q8(planned->irradiance)) >>
                4,
            0, 254);
}

void glint_plan_set_transfer(const struct glint_plan *plan,
                             const struct glint_bundle_plan *planned,
                             struct glint_transfer *transfer)
{
    const struct glint_flare_frame *r = plan->frame;

    glint_transfer_init_at(
        transfer, r->lens, planned->ghost, planned->sine_q30,
        (struct glint_azimuth){planned->cos_q30, planned->sin_q30},
        r->wave[planned->wave].wave_q24);
    transfer->sets = plan->sets;
    transfer->energy_up = planned->energy_up;
    transfer->window = planned->window;
}

struct glint_place
glint_plan_map_sensor_to_picture(const struct glint_plan *plan,
                                 const struct glint_bundle_plan *planned)
{
    struct glint_place place = {
        .cos_q30 = planned->turn.cos_q30,
        .sin_q30 = planned->turn.sin_q30,
        .pixels_per_mm = plan_compute_pixels_per_mm(plan),
        .middle_x_q8 = plan->width * 128 >> plan->half,
        .middle_y_q8 = plan->height * 128 >> plan->half,
        .stop_scale =
            real_over(real_of(1, 0), real_of(plan->opening_q30, -30))};

    if (planned->wider_q16) {
        const int64_t more_q16 = (int64_t)planned->wider_q16 - ONE_Q16;
        const int64_t back_q8 = q_shift(more_q16 * planned->centre_q8[0], 16);
        const int64_t across_q8 = q_shift(more_q16 * planned->centre_q8[1], 16);
        const struct glint_azimuth turn = planned->turn;

        place.pixels_per_mm =
            real_times(place.pixels_per_mm, real_of(planned->wider_q16, -16));
        place.middle_x_q8 -= (int32_t)q_shift(
            back_q8 * turn.cos_q30 - across_q8 * turn.sin_q30, 30);
        place.middle_y_q8 += (int32_t)q_shift(
            back_q8 * turn.sin_q30 + across_q8 * turn.cos_q30, 30);
    }
    return place;
}

/* Returns the left shift that scales energies up as far as possible without
 * overflow. Energies may be up to 5/4 times ENERGY, the max of the probed
 * rays. */
static int compute_energy_shift(int64_t energy)
{
    const int up = 29 - bit_length((uint64_t)(energy + energy / 4));

    return up > 0 ? up : 0;
}

static void set_flux_per_cell(struct glint_bundle *b,
                              const struct glint_transfer *t,
                              struct glint_real flux)
{
    const int rows = b->n_cells - (t->annulus ? 2 : 0);
    const struct glint_real cell =
        real_over(flux, real_of((int64_t)b->n_cells * rows, 0));

    /* light below 2^-400 is invisible; light above 2^400 is clamped later */
    b->flux_q31 = cell.exponent < -400 ? 0 : cell.mantissa;
    b->flux_exponent = cell.exponent > 400 ? 431 : cell.exponent + 31;
}

int glint_plan_is_light_outside_model(const struct glint_lens *lens,
                                      const struct glint_light *light)
{
    return light->sine_q30 > lens->header->sine_hi_q30;
}

/* Returns whether GHOST, a ghost or one of its pupil regions, is to be drawn.
 * Its tint must not be 0. If only_ghost is set, GHOST must come from the same
 * pair of surfaces as that ghost. */
static int is_ghost_selected(const struct glint_flare_frame *r, int ghost)
{
    const struct glint_model_ghost *g = &r->lens->ghost[ghost];
    const struct glint_model_ghost *only =
        &r->lens->ghost[r->only_ghost < 0 ? ghost : r->only_ghost];

    return g->i == only->i && g->j == only->j &&
           (!r->tints || r->tints[ghost].gain.mantissa > 0);
}

/* Returns the length of the vector (X, Y); the magnitudes of X and Y must be
 * below 2^31. */
static int64_t compute_vector_length(int64_t x, int64_t y)
{
    if (y == 0)
        return x < 0 ? -x : x;
    return q_root((uint64_t)(x * x + y * y));
}

/* Sets the enlargement of the ghost, at most WIDEST_Q16, and the fixed point of
 * the enlargement. A lamp of visible extent is sampled by point lights. If the
 * ghosts of these points were smaller than their distance, the lamp's ghost
 * would be a pattern of dots. So each ghost is enlarged to two and a half times
 * the distance between neighbours. A ghost moves with its light in proportion
 * to the ghost's distance from the picture's centre, so lights on the axis need
 * no enlargement. The fixed point lies on the line of the light's azimuth
 * unless the ghost is mirrored rather than rotated. */
static void set_ghost_enlargement(const struct glint_plan *p,
                                  const struct glint_light *b,
                                  struct glint_bundle_plan *planned,
                                  const struct glint_transfer *t,
                                  const struct glint_probe_extent *e)
{
    const int64_t middle = (e->low + e->high) / 2;
    const int64_t across = (e->y_low + e->y_high) / 2;
    const struct glint_real wide =
        real_of((e->high - e->low) / 2 + compute_extent_half_height(e), 0);
    struct glint_real wanted;

    planned->wider_q16 = planned->centre_q8[0] = planned->centre_q8[1] = 0;
    if (b->apart_q30 <= 0 || b->sine_q30 <= 0 || wide.mantissa <= 0)
        return;
    wanted = real_times(
        real_of(compute_vector_length(middle, across), 0),
        real_over(real_of(b->cosine_q30, -30), real_of(b->sine_q30, -30)));
    wanted = real_times(wanted, real_of(5 * (int64_t)b->apart_q30, -31));
    if (!real_less(wide, wanted))
        return;
    planned->wider_q16 =
        (int32_t)real_integer(real_over(wanted, wide), 16, WIDEST_Q16);
    planned->centre_q8[0] = (int32_t)q_clamp_sat(
        convert_to_pixels_q8(p, t, middle), -FARTHEST_Q8, FARTHEST_Q8);
    planned->centre_q8[1] = (int32_t)q_clamp_sat(
        convert_to_pixels_q8(p, t, t->side ? -across : across), -FARTHEST_Q8,
        FARTHEST_Q8);
}

/* If the stop is narrower than the model's, narrows the window of the transfer
 * to the rays that the stop transmits. Returns 0 if the stop transmits none. */
static int narrow_window_to_stop(const struct glint_plan *plan,
                                 struct glint_bundle_plan *planned,
                                 struct glint_plan_scratch *scratch)
{
    int any = 1;

    if (plan->opening_q30 < INT32_C(1) << 30) {
        any = glint_window_narrow_to_stop(&scratch->window, &scratch->transfer,
                                          plan->opening_q30);
        scratch->probe.n_rays += scratch->window.n_rays;
    }
    planned->window = scratch->transfer.window;
    return any;
}

/* Traces the rays of a small probe. Traces a larger probe, too, if fewer than
 * FEW_INSIDE rays of the small one pass the lens. Returns whether any ray
 * passes. */
static int probe_bundle(const struct glint_plan *plan,
                        struct glint_transfer *transfer, struct glint_probe *s)
{
    glint_probe_trace_bundle(s, transfer, plan->opening_q30, FEW_ACROSS,
                             FEW_DOWN);
    if (s->n_inside < FEW_INSIDE)
        glint_probe_trace_bundle(s, transfer, plan->opening_q30,
                                 GLINT_PROBE_ACROSS, GLINT_PROBE_DOWN);
    return s->n_inside > 0;
}

/* Returns the area of the bounding box of the extent E of rays, with margins,
 * in pixels^2. */
static struct glint_real compute_bounding_box_area(
    const struct glint_plan *p, const struct glint_bundle_plan *planned,
    const struct glint_transfer *t, const struct glint_probe_extent *e)
{
    const int64_t high = compute_extent_half_height(e);
    const int64_t wide_q8 =
        scale_by_enlargement(
            planned,
            convert_to_pixels_q8(p, t, q_divide((e->high - e->low) * 3, 5))) +
        256;
    const int64_t high_q8 =
        scale_by_enlargement(
            planned, convert_to_pixels_q8(p, t, high + q_divide(high, 10))) +
        256;

    return real_times(real_of(wide_q8, -7), real_of(high_q8, -7));
}

/* Returns the rotation from sensor outputs of T to the picture, for a light at
 * AZIMUTH. */
static struct glint_azimuth
choose_ghost_rotation(const struct glint_transfer *t,
                      struct glint_azimuth azimuth)
{
    const struct glint_azimuth upright = {t->sign * (INT32_C(1) << 30), 0};

    return t->whole ? upright : azimuth;
}

static enum glint_outcome plan_bundle(const struct glint_plan *plan,
                                      const struct glint_light *b,
                                      struct glint_bundle_plan *planned,
                                      struct glint_bundle *bundle,
                                      struct glint_plan_scratch *scratch)
{
    const struct glint_flare_frame *r = plan->frame;
    const struct glint_azimuth azimuth = {b->cos_q30, b->sin_q30};
    struct glint_transfer *transfer = &scratch->transfer;
    struct glint_probe *s = &scratch->probe;
    struct glint_real colour, brightest;
    struct reach reach;
    int exponent, share_q8;

    bundle->n_cells = s->n_rays = 0;
    if (!is_ghost_selected(r, planned->ghost))
        return GLINT_OUTCOME_OTHER;
    if (glint_plan_is_light_outside_model(r->lens, b))
        return GLINT_OUTCOME_BEYOND;
    if (!glint_transfer_init_at(transfer, r->lens, planned->ghost, b->sine_q30,
                                azimuth, r->wave[planned->wave].wave_q24))
        return GLINT_OUTCOME_CLOSED;
    planned->turn = choose_ghost_rotation(transfer, azimuth);
    transfer->sets = plan->sets;
    share_q8 = plan->dims ? r->dim->method->own_rays_q8(r, b, planned->ghost)
                          : GLINT_DIM_WHOLE_Q8;
    if (share_q8 == 0 && planned->wave != GLINT_DIM_WAVE)
        return GLINT_OUTCOME_OTHER_SET;
    colour = compute_bundle_colour(plan, b, planned, share_q8, bundle->rgb_q14);
    if (colour.mantissa == 0 || b->power.mantissa == 0)
        return GLINT_OUTCOME_DARK;
    if (!narrow_window_to_stop(plan, planned, scratch))
        return GLINT_OUTCOME_BLOCKED;
    if (!probe_bundle(plan, transfer, s))
        return GLINT_OUTCOME_BLOCKED;
    set_ghost_enlargement(plan, b, planned, transfer, &s->seen);
    reach = compute_bundle_box(plan, planned, transfer, &s->reach);
    if (!is_box_in_picture(plan, planned->turn, &reach))
        return GLINT_OUTCOME_OUTSIDE;
    planned->view_q8 = compute_visible_fraction_q8(plan, planned->turn, &reach);
    planned->energy_up = (uint8_t)compute_energy_shift(s->energy);
    exponent = transfer->exponent[GLINT_OUT_ENERGY] + 29 - planned->energy_up;
    planned->flux =
        compute_bundle_flux(plan, b, planned, transfer, colour, exponent);
    if (share_q8 < GLINT_DIM_WHOLE_Q8 && planned->wave != GLINT_DIM_WAVE)
        planned->flux = real_times(planned->flux, real_of(share_q8, -8));
    brightest = compute_max_light(plan, planned, s, transfer, planned->flux);
    planned->peak_q20 = compute_peak_in_visible_units_q20(plan, brightest);
    if (plan->n_lights == 1 && !r->sets && planned->peak_q20 < 1 << 20)
        return GLINT_OUTCOME_FAINT;
    planned->irradiance =
        real_over(planned->flux,
                  compute_bounding_box_area(plan, planned, transfer, &s->seen));
    set_unblocked_fraction_and_contrast(s, brightest, planned);
    bundle->n_cells =
        glint_plan_choose_cells(plan, s, transfer, planned->irradiance);
    glint_plan_set_sags(planned, s, transfer, bundle->n_cells, plan->round_q16);
    set_flux_per_cell(bundle, transfer, planned->flux);
    return GLINT_OUTCOME_DRAWN;
}

enum glint_outcome glint_plan_bundle(const struct glint_plan *plan,
                                     const struct glint_light *light,
                                     struct glint_bundle_plan *planned,
                                     struct glint_bundle *bundle,
                                     struct glint_plan_scratch *scratch)
{
    enum glint_outcome outcome;

    planned->sine_q30 = light->sine_q30;
    planned->cos_q30 = light->cos_q30;
    planned->sin_q30 = light->sin_q30;
    outcome = plan_bundle(plan, light, planned, bundle, scratch);
    scratch->n_rays += scratch->probe.n_rays;
    return outcome;
}
