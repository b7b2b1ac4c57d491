/* SPDX-License-Identifier: MIT */
#include "engine/frame/frame_star.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/block.h"
#include "engine/setup/dirt.h"
#include "engine/frame/frame_parts.h"

/* Factor on cull_codes, the light that counts as invisible, for starbursts,
 * which fade out smoothly, unlike the edges of ghosts. Factors of 1 and 1/4 do
 * not bring pictures nearer to those with all light; 8 costs 0.2 dB and saves 2
 * of 9 million instructions (a lamp of 12 stops, 1920x1080). */
#define STAR_CULL 2

/* max distance, along x and along y, of a lamp from the picture's top left
 * corner, pixels; starbursts of lamps farther away are not drawn */
static const double most_px = 1 << 16;

/* radius of the image of a point light in a sharp picture, pixels */
static const double least_px = 1.5;

/* Limits of the estimated power of a lamp that is clipped in the picture, from
 * starbursts in real photographs. The smaller limit applies. clipped_times: max
 * power / power estimated from clipped pixels. white_share: max power / power
 * at which the mean of the starburst is white at the rim of the lamp's image.
 * For 10 lamps in two night photographs at f/22, the power computed from the
 * light of the starburst is 7 to 166 times the power estimated from clipped
 * pixels, and 0.37 to 3.4 times (median 0.5) the power that is white at the rim
 * (tests/figures/stars.md). */
static const double clipped_times = 32, white_share = 0.5;

/* Power of a lamp / area of its white spot, 1 = white. Up to HAZY the rim of
 * the spot is lit haze; from GLARING on the rim is the glare of a small lamp.
 * Suns in clear skies have 4 to 50, glints and lit haze 0.6 to 1.2. */
static const double hazy = 1, glaring = 5;

/* Max fraction of the time budget for starbursts. If they would take more time,
 * their faintest light is left out. The light that is left out may reach
 * 2^BUDGET_STEPS times that of cull_codes. If that is not enough, starbursts
 * are not drawn. */
static const double budget_share = 0.25;
enum { BUDGET_STEPS = 8 };

/* Wavelength times f-number of the camera that took the picture, divided by the
 * picture's diagonal. The camera is assumed to be at f/22, with a sensor of 36
 * x 24 mm. */
static const double photo_airy = 0.55e-3 * 22 / 43.27;

static struct glint_star_optics make_star_optics(const struct glint_frame *f)
{
    const struct glint_optics *o = &f->setup->optics;

    return (struct glint_star_optics){
        .n_blades = f->setup->n_blades,
        .rotation_deg = f->setup->blade_rotation_deg,
        .round = f->setup->iris.roundness,
        .soft = f->setup->iris.softness,
        .f_number = fabs(o->focal_mm) / (2 * o->entrance_radius_mm),
        .pixel_um = 1e3 * f->view.sensor_width_mm / f->view.width,
        .draft = glint_frame_is_draft(f)};
}

/* Returns whether tables made for A can be used for B. */
static bool do_star_optics_include(const struct glint_star_optics *a,
                                   const struct glint_star_optics *b)
{
    return a->n_blades == b->n_blades && a->rotation_deg == b->rotation_deg &&
           a->round == b->round && a->soft == b->soft && a->smear == b->smear &&
           a->f_number == b->f_number && a->pixel_um == b->pixel_um &&
           a->draft == b->draft && a->has_core >= b->has_core;
}

/* Recomputes the smear, the diffraction by dirt in the stop, if the dirt has
 * changed. Sets IS_NEW to whether the dirt has changed. */
static enum glint_status update_dirt_smear(struct glint_frame *f, bool *is_new)
{
    struct glint_frame_star *s = &f->star;
    const struct glint_dirt *dirt = f->setup->dirt;
    const uint64_t mark = dirt && dirt->shade.log2 ? dirt->mark : 0;

    *is_new = mark != s->smear_mark;
    if (!*is_new)
        return GLINT_OK;
    glint_smear_finish(&s->smear);
    s->smear_mark = mark;
    return mark ? glint_smear_init(&s->smear, f->setup) : GLINT_OK;
}

/* Makes the tables if those of the frame do not fit; HAS_CORE: also that of the
 * core, which later tables keep. */
static enum glint_status update_star_tables(struct glint_frame *f,
                                            bool has_core)
{
    struct glint_frame_star *s = &f->star;
    struct glint_star_optics optics = make_star_optics(f);
    bool is_new;
    enum glint_status status = update_dirt_smear(f, &is_new);

    if (status != GLINT_OK)
        return status;
    optics.smear = s->smear.sum ? &s->smear : NULL;
    optics.has_core = has_core || s->optics.has_core;
    if (s->tables && do_star_optics_include(&s->optics, &optics) && !is_new)
        return GLINT_OK;
    glint_star_tables_free(s->tables);
    s->tables = NULL;
    s->optics = optics;
    return glint_star_tables_make(&s->tables, &optics);
}

static enum glint_status allocate_star_lights(struct glint_frame *f, int n)
{
    struct glint_frame_star *s = &f->star;
    struct glint_star_config cfg = {
        .n_workers = glint_workers_count(f->cfg.workers),
        .width = f->view.width,
        .height = f->view.height,
        .max_lights = n < GLINT_STAR_MAX_LIGHTS ? n : GLINT_STAR_MAX_LIGHTS,
        .sets = f->cfg.sets};
    struct glint_star_light *light;
    size_t bytes;
    void *block;

    if (s->star && n <= s->max_lights)
        return GLINT_OK;
    s->star = NULL;
    free(s->mem);
    bytes = glint_star_count_bytes(&cfg);
    block = glint_block_allocate_aligned(bytes, &s->mem);
    light = realloc(s->light, (size_t)n * sizeof *s->light);
    if (light)
        s->light = light;
    if (!block || !light)
        return GLINT_E_MEMORY;
    s->max_lights = n;
    s->bytes = bytes;
    return glint_star_init(&s->star, &cfg, block, bytes);
}

static double compute_photo_airy_px(const struct glint_frame *f)
{
    return photo_airy * hypot(f->view.width, f->view.height);
}

/* Allocates memory for N lamps and makes the tables; HAS_CORE: also that of the
 * core. */
static enum glint_status allocate_star(struct glint_frame *f, int n,
                                       bool has_core)
{
    enum glint_status status;

    if (!(f->star.share > 0) || n == 0)
        return GLINT_OK;
    status = update_star_tables(f, has_core);
    return status == GLINT_OK ? allocate_star_lights(f, n) : status;
}

enum glint_status glint_frame_star_allocate(struct glint_frame *f, int n)
{
    return allocate_star(f, n, true);
}

size_t glint_frame_star_count_bytes(const struct glint_frame *f)
{
    const struct glint_frame_star *s = &f->star;

    return glint_smear_count_bytes(&s->smear) +
           (s->tables ? glint_star_tables_count_bytes(s->tables) : 0) +
           (s->star ? s->bytes + (size_t)s->max_lights * sizeof *s->light : 0) +
           f->veil.bytes + (f->veil.table ? f->veil.table->bytes : 0);
}

/* Returns lamp I with its full power for the starburst. LAMPS have the powers
 * from which ghosts are drawn, which the exposure may have reduced. */
static const struct glint_lamp *get_star_lamp(const struct glint_frame *f,
                                              const struct glint_lamp *lamps,
                                              int i)
{
    return f->known ? &f->known[i].lamp : &lamps[i];
}

/* The appearance of a lamp in the picture. */
struct seen {
    double radius_px; /* radius of a uniform disc of the same RMS extent,
                         pixels; 0 if unknown */
    double hidden_px; /* radius, pixels, that glare around a clipped core may
                         hide: twice the min RMS semi-axis of lamps in still
                         pictures (engine/detector.c) */
    double level;
    bool is_bare; /* true: the lamp is not visible in the picture */
};

static struct seen find_lamp_appearance(const struct glint_frame *f, int i)
{
    const struct glint_engine_lamp *lamp = f->known ? &f->known[i] : NULL;
    const double size_px = lamp ? fmax(lamp->seen_px, 0) : 0;

    return (struct seen){sqrt(2) * size_px, floor(256 / 6. * size_px) / 128,
                         lamp ? lamp->level : 1,
                         f->star.is_bare || (lamp && lamp->seen_px < 0)};
}

/* Returns an estimate of the true power of a lamp in its brightest channel,
 * white times pixels. If the picture clips the lamp, the estimate may exceed
 * POWER, the power found in the picture; otherwise it is POWER. SEEN is the
 * lamp's appearance. */
static double estimate_unclipped_power(const struct glint_frame *f,
                                       const struct seen *seen, double power)
{
    const double most = white_share * pow(GLINT_PI * seen->radius_px, 3) /
                        compute_photo_airy_px(f) * seen->level;

    return seen->radius_px > 0 ? fmin(clipped_times * power, fmax(most, power))
                               : power;
}

/* Returns the radius, pixels, of the disc of a lamp. SEEN: its white spot in
 * the picture; FOUND: light found; POWER: estimated true power; OWN_PX: radius
 * by the lamp finder. If FOUND is much brighter than the white spot, the rim of
 * the spot is glare of a small lamp of radius OWN_PX. If not, the rim is lit
 * haze, and the lamp nearly as large as the spot. Between these cases both
 * radii are blended. The white spot of a point light has a radius of least_px
 * plus that at which the mean of the starburst over a circle is white; the
 * square of this sum is subtracted from that of the spot's radius. The result
 * is at least hidden_px, so that lamps of videos are as wide as those of still
 * pictures. */
static double compute_lamp_disc_radius(const struct glint_frame *f,
                                       const struct seen *seen, double found,
                                       double power, double own_px)
{
    const double white_px =
        cbrt(power / seen->level * compute_photo_airy_px(f)) / GLINT_PI;
    const double point_px = least_px + white_px;
    const double area = GLINT_PI * seen->radius_px * seen->radius_px;
    const double over =
        (found / seen->level / fmax(area, 1) - hazy) / (glaring - hazy);
    const double glare = fmin(fmax(over, 0), 1);
    const double least = fmax(own_px, seen->hidden_px);
    const double rest_px =
        sqrt(fmax(seen->radius_px * seen->radius_px - point_px * point_px, 0));

    return fmax(least, rest_px + glare * (least - rest_px));
}

/* Converts LAMP to LIGHT; SCALE is a factor on its power. Returns false if LAMP
 * is too far from the picture or has no light. */
static bool convert_lamp_to_star_light(const struct glint_frame *f,
                                       const struct glint_lamp *lamp,
                                       double scale, const struct seen *seen,
                                       struct glint_star_light *light)
{
    const double focal_mm = f->setup->optics.focal_mm;
    const double pixels = glint_frame_compute_pixels_per_tangent(f);
    const double most = fmax(lamp->rgb[0], fmax(lamp->rgb[1], lamp->rgb[2]));
    const double found = lamp->power * most,
                 all = estimate_unclipped_power(f, seen, found);
    const double radius = compute_lamp_disc_radius(
        f, seen, found, all, 2 * fmax(lamp->axis[0], lamp->axis[1]) * pixels);
    const double power = all * scale;
    double x, y;

    glint_view_to_pixel(&f->view, focal_mm, lamp, &x, &y);
    if (!(fabs(x) < most_px && fabs(y) < most_px) || !(power > 0) ||
        !isfinite(power))
        return false;
    *light = (struct glint_star_light){
        .x_q8 = (int32_t)lrint(256 * x),
        .y_q8 = (int32_t)lrint(256 * y),
        .radius_q8 =
            seen->is_bare ? -1 : (int32_t)lrint(256 * fmin(radius, 8192)),
        .power = glint_real_of(power)};
    for (int c = 0; c < 3; c++)
        light->rgb_q14[c] = (int32_t)lrint(lamp->rgb[c] / most * 16384);
    return true;
}

static int is_star_power_higher(const void *a, const void *b)
{
    const struct glint_star_light *p = a, *q = b;

    const double more = glint_real_value(q->power) - glint_real_value(p->power);

    if (more > 0 || more < 0)
        return more > 0 ? 1 : -1;
    if (p->x_q8 != q->x_q8)
        return p->x_q8 < q->x_q8 ? -1 : 1;
    return p->y_q8 < q->y_q8 ? -1 : p->y_q8 > q->y_q8;
}

/* Sets the starbursts of N_LIGHTS lights. Light below FAINTEST is left out. If
 * the cost exceeds budget_share of the budget, FAINTEST is raised by the
 * smallest step that avoids it. */
static void set_star_lights_within_budget(struct glint_frame *f, int n_lights,
                                          double faintest)
{
    struct glint_frame_star *s = &f->star;
    const double most_minsn =
        budget_share * f->budget.ms / fmax(f->budget.ms_per_minsn, 1e-9);

    for (int i = 0; i <= BUDGET_STEPS; i++) {
        glint_star_set_lights(s->star, s->tables, s->light, n_lights,
                              glint_real_of(faintest));
        s->pixels = (double)glint_star_estimate_pixels(s->star);
        if (f->budget.ms <= 0 ||
            1e-3 * glint_cost_weight[GLINT_COST_STAR].planned * s->pixels <=
                most_minsn)
            return;
        faintest *= 2;
    }
    glint_star_set_lights(s->star, s->tables, s->light, 0,
                          glint_real_of(faintest));
    s->pixels = 0;
}

enum glint_status glint_frame_star_set_lamps(struct glint_frame *f,
                                             const struct glint_lamp *lamps,
                                             int n, double scale,
                                             const struct glint_image *image)
{
    struct glint_frame_star *s = &f->star;
    enum glint_status status;
    bool has_core = false;
    int n_lights = 0;

    s->is_set = false;
    if (!(s->share > 0) || n == 0)
        return GLINT_OK;
    for (int i = 0; i < n; i++)
        has_core = has_core || find_lamp_appearance(f, i).is_bare;
    status = allocate_star(f, n, has_core);
    /* The sum is NULL if dirt in the stop blocks all light: no starburst. */
    if (status != GLINT_OK || (s->smear_mark && !s->smear.sum))
        return status;
    for (int i = 0; i < n; i++) {
        const struct seen seen = find_lamp_appearance(f, i);

        n_lights += convert_lamp_to_star_light(f, get_star_lamp(f, lamps, i),
                                               scale * s->share, &seen,
                                               &s->light[n_lights]);
    }
    if (n_lights > GLINT_STAR_MAX_LIGHTS)
        qsort(s->light, (size_t)n_lights, sizeof *s->light,
              is_star_power_higher);
    set_star_lights_within_budget(
        f, n_lights,
        STAR_CULL *
            glint_frame_get_light_near_black(f, image, f->dials.cull_codes));
    s->n_lights = n_lights;
    s->is_set = true;
    return GLINT_OK;
}

void glint_frame_draw_passes(struct glint_frame *frame,
                             const struct glint_image *image)
{
    if (frame->veil.is_set && frame->star.is_set) {
        const struct glint_pass star =
            glint_star_make_pass(frame->star.star, image);

        glint_veil_draw(frame->veil.veil, &star, frame->memory.flare, image);
    } else if (frame->veil.is_set)
        glint_veil_draw(frame->veil.veil, NULL, frame->memory.flare, image);
    else if (frame->star.is_set)
        glint_star_draw(frame->star.star, frame->memory.flare, image);
    else
        glint_flare_draw(frame->memory.flare, image);
}

/* Returns the power of the strongest lamp in its brightest channel, as used for
 * starbursts. */
static double find_max_star_power(const struct glint_frame *f,
                                  const struct glint_lamp *lamps, int n)
{
    double most = 0;

    for (int i = 0; i < n; i++) {
        const struct glint_lamp *const lamp = get_star_lamp(f, lamps, i);

        for (int c = 0; c < 3; c++)
            most = fmax(most, lamp->power * lamp->rgb[c]);
    }
    return most;
}

enum glint_status glint_frame_star_draw_alone(struct glint_frame *frame,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb)
{
    const int width = frame->view.width, height = frame->view.height;
    const size_t samples = 3 * (size_t)width * (size_t)height;
    struct glint_image layer =
        glint_image_over(linear_q20, GLINT_LINEAR_Q20, width, height);
    /* No pixel gets more from one starburst than the lamp's total light. */
    const double most =
        find_max_star_power(frame, lamps, n) * frame->star.share;
    const double scale = most > 0 ? exp2(10 - ceil(log2(most))) : 1;
    enum glint_status status;

    memset(linear_q20, 0, samples * sizeof *linear_q20);
    status = glint_frame_star_set_lamps(frame, lamps, n, scale, &layer);
    if (status != GLINT_OK || !frame->star.is_set)
        return status;
    glint_star_draw_alone(frame->star.star, frame->memory.flare, &layer);
    for (size_t i = 0; i < samples; i++)
        rgb[i] += (float)(linear_q20[i] * 0x1p-20 / scale * gain);
    return GLINT_OK;
}

void glint_frame_star_finish(struct glint_frame_star *star)
{
    glint_star_tables_free(star->tables);
    glint_smear_finish(&star->smear);
    free(star->light);
    free(star->mem);
}
