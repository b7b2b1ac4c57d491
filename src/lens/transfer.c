/* SPDX-License-Identifier: MIT
 *
 * Substitutes angle and wavelength into the polynomials of a bundle. The
 * results are polynomials of u and v, the position in the bundle's box;
 * transfer_rays.c evaluates them.
 *
 *   in   a model, a ghost, the sine of the light's angle, a wavelength
 *   out  struct glint_transfer: tables of coefficients of u^a v^b, and a box
 *
 * Formats: variables are _q30 and within +-2^30. Coefficients and all
 * intermediate values of an output are integers in the unit of that output. The
 * bake has proven that they are below 2^30 (bound in struct
 * glint_model_output). So each product of a variable and a coefficient is below
 * 2^60, and is rounded to the output's unit by a shift of 30. */
#include "glint/transfer.h"

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "lens/blend.h"
#include "lens/box.h"
#include "lens/terms.h"

static const void *get_model_table(const struct glint_lens *lens,
                                   uint32_t offset)
{
    return (const unsigned char *)lens->header + offset;
}

/* Maps X from LO .. HI to -1 .. 1, _q30, clamped. */
static int32_t normalise_in_range_q30(int32_t x, int32_t lo, int32_t hi)
{
    const int64_t span = (int64_t)hi - lo;

    if (x <= lo)
        return -TRANSFER_ONE_Q30;
    if (x >= hi)
        return TRANSFER_ONE_Q30;
    return (int32_t)q_divide((2 * (int64_t)x - lo - hi) * TRANSFER_ONE_Q30,
                             span);
}

/* Returns whether WAVE_Q24 is in the wavelength band of system S. The upper end
 * of a band belongs to the next band, if there is one. */
static int is_wave_in_band(const struct glint_model_system *s,
                           const struct glint_model_header *h, int32_t wave_q24)
{
    return wave_q24 >= s->wave_lo_q24 &&
           (wave_q24 < s->wave_hi_q24 ||
            (wave_q24 == s->wave_hi_q24 && wave_q24 == h->wave_hi_q24));
}

/* Returns whether Y_Q30, the y component of a light's direction, is within the
 * range of system S. In the auto basis systems have no such range. */
static int is_direction_in_range(const struct glint_lens *lens,
                                 const struct glint_model_system *s,
                                 int32_t y_q30)
{
    const int32_t *range_q30;

    if (!glint_basis_is_lens(lens->header->basis))
        /* In the auto basis across_at is not validated, so it is not read
         * here. */
        return 1;
    range_q30 = get_model_table(lens, s->across_at);
    return y_q30 >= range_q30[0] && y_q30 <= range_q30[1];
}

static const struct glint_model_system *
find_ghost_system(const struct glint_lens *lens, int ghost, int32_t sine_q30,
                  int32_t y_q30, int32_t wave_q24)
{
    const struct glint_model_ghost *g = &lens->ghost[ghost];
    const struct glint_model_header *h = lens->header;

    wave_q24 = wave_q24 < h->wave_lo_q24   ? h->wave_lo_q24
               : wave_q24 > h->wave_hi_q24 ? h->wave_hi_q24
                                           : wave_q24;
    for (uint32_t k = 0; k < g->n_systems; k++) {
        const struct glint_model_system *s = &lens->system[g->first_system + k];

        if (sine_q30 < s->sine_lo_q30 || sine_q30 > s->sine_hi_q30 ||
            !is_wave_in_band(s, h, wave_q24) ||
            !is_direction_in_range(lens, s, y_q30))
            continue;
        return s;
    }
    return NULL;
}

const struct glint_model_system *
glint_transfer_find_system(const struct glint_lens *lens, int ghost,
                           int32_t sine_q30, int32_t wave_q24)
{
    return find_ghost_system(lens, ghost, sine_q30, 0, wave_q24);
}

/* Powers 0, 1, 2 ... of the angle and of the wavelength of a bundle, both
 * normalised to the ranges of its system. */
struct substituted_powers {
    int32_t s_q30[TRANSFER_MAX_EXPONENT + 1], w_q30[TRANSFER_MAX_EXPONENT + 1];
    /* 1: the model uses the lens basis (lenses that are not round); 0: auto
     * basis */
    int lens;
    /* powers of the y component of the direction; lens basis only */
    int32_t p_q30[GLINT_LENS_POWERS];
};

static void set_substituted_powers(struct substituted_powers *set,
                                   const struct glint_lens *lens,
                                   const struct glint_model_system *s,
                                   int32_t sine_q30, int32_t y_q30,
                                   int32_t wave_q24)
{
    set->lens = glint_basis_is_lens(lens->header->basis);
    compute_powers_q30(
        normalise_in_range_q30(sine_q30, s->sine_lo_q30, s->sine_hi_q30),
        TRANSFER_MAX_EXPONENT, set->s_q30);
    compute_powers_q30(
        normalise_in_range_q30(wave_q24, s->wave_lo_q24, s->wave_hi_q24),
        TRANSFER_MAX_EXPONENT, set->w_q30);
    if (set->lens) {
        const int32_t *range_q30 = get_model_table(lens, s->across_at);

        compute_powers_q30(
            normalise_in_range_q30(y_q30, range_q30[0], range_q30[1]),
            GLINT_LENS_POWERS - 1, set->p_q30);
    }
}

static void evaluate_transfer_box(struct glint_transfer *t,
                                  const struct glint_lens *lens,
                                  const struct substituted_powers *set)
{
    const struct glint_model_system *s = t->system;
    const int32_t *box = get_model_table(lens, s->box_at);
    int32_t side[GLINT_BOX_TERMS];

    t->box_exponent = s->box_exponent;
    t->box[3] = 0;
    for (int k = 0; k < (set->lens ? GLINT_LENS_SIDES : 3); k++) {
        box = unpack_box_polynomial(box, s->box_terms, side);
        t->box[k] =
            set->lens
                ? evaluate_lens_box_polynomial(side, set->s_q30[1],
                                               set->p_q30[1], set->w_q30[1])
                : evaluate_box_polynomial(side, set->s_q30[1], set->w_q30[1]);
    }
    /* glint_lens_open() tests half sizes only on a grid of angles. Between grid
     * points a half size may be negative, so it is clamped to 0. */
    for (int k = 1; k < 3; k++)
        t->box[k] = t->box[k] < 0 ? 0 : t->box[k];
}

/* Returns coefficient VALUE of a term, multiplied by the powers of angle and
 * wavelength that POWER encodes. Auto basis. */
static WHOLLY_INLINE int32_t substitute_auto_term(
    const struct substituted_powers *set, int32_t value, uint16_t power)
{
    const int c = power >> 8 & 15, d = power >> 12;

    if (c)
        value = q_mul(value, set->s_q30[c], 30);
    return d ? q_mul(value, set->w_q30[d], 30) : value;
}

/* Powers index these tables; glint_lens_open() checks that powers of u and v
 * are at most GLINT_MAX_POWER, and powers in the lens basis below these
 * limits. */
STATIC_ASSERT(GLINT_MAX_POWER < GLINT_TABLE_WIDTH);
STATIC_ASSERT(GLINT_LENS_POWERS <= TRANSFER_MAX_EXPONENT + 1);
STATIC_ASSERT(GLINT_LENS_WAVE_POWERS <= TRANSFER_MAX_EXPONENT + 1);

/* Returns coefficient VALUE of a term, multiplied by the powers of direction
 * and wavelength that POWER encodes. Lens basis. */
static int32_t substitute_lens_term(const struct substituted_powers *set,
                                    int32_t value, uint16_t power)
{
    const unsigned code = power >> 8, of_s = code % GLINT_LENS_POWERS;
    const unsigned of_p = code / GLINT_LENS_POWERS % GLINT_LENS_POWERS;
    const unsigned of_w = code / (GLINT_LENS_POWERS * GLINT_LENS_POWERS);

    if (of_s)
        value = q_mul(value, set->s_q30[of_s], 30);
    if (of_p)
        value = q_mul(value, set->p_q30[of_p], 30);
    return of_w ? q_mul(value, set->w_q30[of_w], 30) : value;
}

/* a polynomial of u and v, to which terms are added */
struct table {
    int32_t (*row)[GLINT_TABLE_WIDTH];
    int degree_u, degree_v;
};

static WHOLLY_INLINE void add_table_term(struct table *t, uint16_t power,
                                         int32_t value)
{
    const int a = power & 15, b = power >> 4 & 15;

    t->row[b][a] += value;
    t->degree_u = a > t->degree_u ? a : t->degree_u;
    t->degree_v = b > t->degree_v ? b : t->degree_v;
}

/* Sets TABLE to output O with angle and wavelength substituted, in either
 * basis. */
static void fill_output_table(struct table *table,
                              const struct glint_lens *lens,
                              const struct glint_model_output *o,
                              const struct substituted_powers *set)
{
    const uint32_t n = o->n_terms, n_wide = n - o->n_narrow;
    const int32_t *coef = get_model_table(lens, o->coef_at);
    const int32_t by = INT32_C(1) << o->narrow_shift;
    const int16_t *narrow = (const int16_t *)(const void *)(coef + n_wide);
    const uint16_t *power = get_model_table(lens, o->term_at);

    table->degree_u = table->degree_v = 0;
    for (int b = 0; b <= GLINT_MAX_POWER; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            table->row[b][a] = 0;
    for (uint32_t k = 0; k < n && set->lens; k++)
        add_table_term(
            table, power[k],
            substitute_lens_term(
                set, k < n_wide ? coef[k] : narrow[k - n_wide] * by, power[k]));
    for (uint32_t k = 0; k < n_wide && !set->lens; k++)
        add_table_term(table, power[k],
                       substitute_auto_term(set, coef[k], power[k]));
    for (uint32_t k = n_wide; k < n && !set->lens; k++)
        add_table_term(
            table, power[k],
            substitute_auto_term(set, narrow[k - n_wide] * by, power[k]));
}

static void set_transfer_table(struct glint_transfer *t,
                               const struct glint_lens *lens,
                               const struct glint_model_output *o,
                               const struct substituted_powers *set)
{
    struct table table = {t->table[o->kind], 0, 0};

    fill_output_table(&table, lens, o, set);
    t->degree_u[o->kind] = (uint8_t)table.degree_u;
    t->degree_v[o->kind] = (uint8_t)table.degree_v;
}

static void set_transfer_output(struct glint_transfer *t,
                                const struct glint_lens *lens,
                                const struct glint_model_output *o,
                                const struct substituted_powers *set)
{
    t->outputs |= UINT32_C(1) << o->kind;
    t->exponent[o->kind] = o->exponent;
    if (o->kind == GLINT_OUT_ENERGY) {
        t->head = o->head;
        t->roots = o->roots;
        t->exponent[o->kind] -= o->head;
        for (int k = 0; k < o->roots; k++)
            t->exponent[o->kind] = 2 * t->exponent[o->kind] + 29;
    }
    set_transfer_table(t, lens, o, set);
}

static void clear_transfer_outputs(struct glint_transfer *t)
{
    t->outputs = 0;
    t->head = t->roots = t->energy_up = 0;
    t->sets = 0;
    t->n_nodes = 0;
    t->whole = t->side = 0;
    t->sign = 1;
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        t->exponent[k] = 0;
        t->degree_u[k] = t->degree_v[k] = 0;
    }
}

/* The direction of a light in the form that systems use. x is the sine of the
 * light's angle, or in the lens basis the x component of its direction. */
struct system_direction {
    int32_t x_q30, y_q30;
    /* 1: the light is on the side of the plane of symmetry that the model does
     * not cover, so it is mirrored */
    int mirror_x, mirror_y;
};

static struct system_direction
compute_system_direction(const struct glint_lens *lens, int32_t sine_q30,
                         struct glint_azimuth azimuth)
{
    const uint32_t basis = lens->header->basis;
    struct system_direction d = {sine_q30, 0, 0, 0};

    if (!glint_basis_is_lens(basis))
        return d;
    d.x_q30 = q_mul(sine_q30, azimuth.cos_q30, 30);
    d.y_q30 = q_mul(sine_q30, azimuth.sin_q30, 30);
    d.mirror_x = (basis & GLINT_MIRRORS_X) && d.x_q30 < 0;
    d.mirror_y = (basis & GLINT_MIRRORS_Y) && d.y_q30 < 0;
    d.x_q30 = d.mirror_x ? -d.x_q30 : d.x_q30;
    d.y_q30 = d.mirror_y ? -d.y_q30 : d.y_q30;
    return d;
}

int glint_transfer_init(struct glint_transfer *transfer,
                        const struct glint_lens *lens, int ghost,
                        int32_t sine_q30, int32_t wave_q24)
{
    const struct glint_azimuth right = {TRANSFER_ONE_Q30, 0};

    return glint_transfer_init_at(transfer, lens, ghost, sine_q30, right,
                                  wave_q24);
}

int glint_transfer_init_at(struct glint_transfer *transfer,
                           const struct glint_lens *lens, int ghost,
                           int32_t sine_q30, struct glint_azimuth azimuth,
                           int32_t wave_q24)
{
    const struct system_direction d =
        compute_system_direction(lens, sine_q30, azimuth);
    const struct glint_model_system *system;
    const struct glint_model_output *output;
    struct substituted_powers set;

    if (lens->zoom) /* models of zoom lenses have rotational symmetry */
        return lens->zoom->transfer(transfer, lens->zoom, ghost, sine_q30,
                                    wave_q24);
    system = find_ghost_system(lens, ghost, d.x_q30, d.y_q30, wave_q24);
    if (!system)
        return 0;
    clear_transfer_outputs(transfer);
    transfer->system = system;
    transfer->annulus = (uint8_t)system->annulus;
    set_substituted_powers(&set, lens, system, d.x_q30, d.y_q30, wave_q24);
    transfer->whole = (uint8_t)set.lens;
    transfer->window = glint_box_whole(transfer);
    /* Mirroring in x equals mirroring in y and then rotating by 180 degrees. */
    transfer->sign = (int8_t)(d.mirror_x ? -1 : 1);
    transfer->side = (uint8_t)(d.mirror_x != d.mirror_y);
    evaluate_transfer_box(transfer, lens, &set);
    output = get_model_table(lens, system->output_at);
    for (uint32_t k = 0; k < system->n_outputs; k++)
        set_transfer_output(transfer, lens, &output[k], &set);
    return 1;
}

/* Returns output O of the other zoom position of a mix, with angle and
 * wavelength substituted, and writes its coefficients to ROW. */
static struct glint_blend_output make_blend_output(
    const struct glint_lens *lens, const struct glint_model_output *o,
    const struct substituted_powers *set, int32_t (*row)[GLINT_TABLE_WIDTH])
{
    struct table table = {row, 0, 0};

    fill_output_table(&table, lens, o, set);
    return (struct glint_blend_output){.kind = o->kind,
                                       .head = o->head,
                                       .exponent = o->exponent,
                                       .row = row,
                                       .degree_u = (uint8_t)table.degree_u,
                                       .degree_v = (uint8_t)table.degree_v};
}

int glint_transfer_mix_position(struct glint_transfer *transfer,
                                const struct glint_lens *lens, int ghost,
                                int32_t sine_q30, int32_t wave_q24,
                                int32_t part_q30)
{
    const struct glint_model_system *const system =
        glint_transfer_find_system(lens, ghost, sine_q30, wave_q24);
    const struct glint_model_output *o;
    struct glint_zoom_mix blend = {.to = transfer, .part_q30 = part_q30};
    int32_t box[3] = {transfer->box[0], transfer->box[1], transfer->box[2]};
    const int32_t box_exponent = transfer->box_exponent;
    struct substituted_powers set;

    if (!system)
        return 0;
    o = get_model_table(lens, system->output_at);
    if (o[GLINT_OUT_ENERGY].roots != transfer->roots)
        return 0;
    set_substituted_powers(&set, lens, system, sine_q30, 0, wave_q24);
    transfer->system = system;
    evaluate_transfer_box(transfer, lens, &set);
    if (!glint_blend_mix_box(&blend, box, box_exponent))
        return 0;
    for (uint32_t k = 0; k < system->n_outputs; k++)
        if (o[k].kind >= GLINT_OUT_BARREL_0) {
            const struct glint_blend_output of =
                make_blend_output(lens, &o[k], &set, transfer->of_u);

            glint_blend_register_barrel(&blend, &of);
        }
    glint_blend_pair_barrels(&blend);
    for (uint32_t k = 0; k < system->n_outputs; k++) {
        const struct glint_blend_output of =
            make_blend_output(lens, &o[k], &set, transfer->of_u);

        glint_blend_mix_output(&blend, &of);
    }
    glint_blend_widen_barrels(&blend);
    return 1;
}
