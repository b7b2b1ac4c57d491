/* SPDX-License-Identifier: MIT */
#include "support/models/hostile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flare/by_edges.h"
#include "glint/kernels.h"
#include "support/memory.h"
#include "support/rng.h"

enum { POWERS = 10, SURFACES = 64, PAIRS = SURFACES * (SURFACES - 1) / 2 };

const char *const hostile_name[HOSTILE_FAMILIES] = {
    [HOSTILE_WHOLE] = "2016 whole-frame ghosts",
    [HOSTILE_FOLDS] = "the same, folded and cut",
    [HOSTILE_LOST] = "lost rays",
    [HOSTILE_SYSTEMS] = "thousands of systems",
    [HOSTILE_NUMBERS] = "largest coefficients",
    [HOSTILE_POINTS] = "boxes of no size",
    [HOSTILE_HUGE] = "boxes of the largest size",
    [HOSTILE_WINDOWS] = "no window of the stop",
    [HOSTILE_HEADERS] = "numbers of the header",
    [HOSTILE_COLOURS] = "far apart by wavelength",
    [HOSTILE_SUMS] = "sums that rounding carries over",
    [HOSTILE_TEXTS] = "invalid names"};

/* ------------------------------------------------------------- polynomials */

/* A polynomial in the variables U, V and W: the sum of all u[k] U^k, all v[k]
 * V^k, and w W. */
struct polynomial {
    double u[POWERS], v[POWERS], w;
};

/* Adds SIZE times the Chebyshev polynomial of degree N to the polynomial with
 * the coefficients POWER. A Chebyshev polynomial has values of -1 .. 1. */
static void add_chebyshev_polynomial(double *power, int n, double size)
{
    double last[POWERS] = {1}, here[POWERS] = {0, 1};

    for (int k = 1; k < n; k++)
        for (int i = POWERS - 1; i >= 0; i--) {
            const double next = 2 * (i ? here[i - 1] : 0) - last[i];

            last[i] = here[i];
            here[i] = next;
        }
    for (int i = 0; i < POWERS; i++)
        power[i] += size * (n ? here[i] : i == 0);
}

/* Writes polynomial P to M as output KIND, with coefficients in units of
 * 2^EXPONENT. */
static struct glint_model_output append_output(struct model_image *m, int kind,
                                               const struct polynomial *p,
                                               int exponent)
{
    uint16_t power[2 * POWERS + 1];
    int32_t coef[2 * POWERS + 1];
    struct glint_model_output o = {.kind = (uint8_t)kind,
                                   .exponent = (int16_t)exponent,
                                   .bound = (1 << 30) - 1};

    for (int i = 0; i < 2 * POWERS; i++) {
        const double x = i < POWERS ? p->u[i] : p->v[i - POWERS];

        if (x == 0 || i == POWERS)
            continue;
        power[o.n_terms] = (uint16_t)(i < POWERS ? i : (i - POWERS) * 16);
        coef[o.n_terms++] = (int32_t)lrint(ldexp(x, -exponent));
    }
    if (p->w != 0 || o.n_terms == 0) {
        power[o.n_terms] = 1 << 12;
        coef[o.n_terms++] = (int32_t)lrint(ldexp(p->w, -exponent));
    }
    o.term_at = model_append_items(m, power, o.n_terms * sizeof *power);
    o.coef_at = model_append_items(m, coef, o.n_terms * sizeof *coef);
    return o;
}

/* Returns the exponent E such that the magnitudes of the coefficients of P, in
 * units of 2^E, sum to 2^28 .. 2^29; 0 if P is 0. */
static int find_unit_exponent(const struct polynomial *p)
{
    double sum = fabs(p->w);
    int exponent;

    for (int i = 0; i < POWERS; i++)
        sum += fabs(p->u[i]) + fabs(p->v[i]);
    (void)frexp(sum, &exponent);
    return sum > 0 ? exponent - 29 : 0;
}

/* Writes the polynomials P[N] to M as the first N kinds of output. Returns
 * their offset in M. */
static uint32_t append_polynomials_as_outputs(struct model_image *m,
                                              const struct polynomial *p, int n)
{
    struct glint_model_output o[GLINT_OUT_KINDS];

    for (int k = 0; k < n; k++) {
        /* Outputs x and y must have the same exponent, so both get the larger
         * of their two exponents. */
        const int pair = k < GLINT_OUT_ENERGY ? k ^ 1 : k;
        const int a = find_unit_exponent(&p[k]),
                  b = find_unit_exponent(&p[pair]);

        o[k] = append_output(m, k, &p[k], a > b ? a : b);
    }
    return model_append_items(m, o, (size_t)n * sizeof *o);
}

/* ------------------------------------------------------------------- ghosts */

/* Sets P to the output polynomials of a ghost as large as the frame, whose
 * pupil box is as large as the stop. */
static void set_frame_filling_ghost(struct polynomial p[GLINT_OUT_KINDS],
                                    uint32_t *seed)
{
    memset(p, 0, GLINT_OUT_KINDS * sizeof *p);
    p[GLINT_OUT_SENSOR_X].u[1] = 18 + rng_unit(seed);
    p[GLINT_OUT_SENSOR_X].u[3] = rng_unit(seed);
    p[GLINT_OUT_SENSOR_X].v[2] = rng_unit(seed);
    p[GLINT_OUT_SENSOR_Y].v[1] = 12 + rng_unit(seed);
    p[GLINT_OUT_SENSOR_Y].v[3] = rng_unit(seed);
    p[GLINT_OUT_STOP_X].u[1] = 1;
    p[GLINT_OUT_STOP_Y].v[1] = 1;
    p[GLINT_OUT_ENERGY].u[0] = 0.5;
}

/* Sets P to the output polynomials of a ghost that is clipped by barrel
 * apertures and folds across the frame up to nine times in x and in y. */
static void set_folded_ghost(struct polynomial p[GLINT_OUT_KINDS],
                             uint32_t *seed)
{
    set_frame_filling_ghost(p, seed);
    memset(p, 0, 2 * sizeof *p);
    add_chebyshev_polynomial(p[GLINT_OUT_SENSOR_X].u,
                             9 - rng_int_below(seed, 3), 18);
    add_chebyshev_polynomial(p[GLINT_OUT_SENSOR_X].v,
                             2 * rng_int_below(seed, 5), 3);
    add_chebyshev_polynomial(p[GLINT_OUT_SENSOR_Y].v,
                             9 - 2 * rng_int_below(seed, 2), 12);
    for (int k = GLINT_OUT_RADIUS; k < GLINT_OUT_KINDS; k++) {
        p[k].u[0] = 0.8;
        add_chebyshev_polynomial(p[k].u, 1 + rng_int_below(seed, 9), 0.3);
        add_chebyshev_polynomial(p[k].v, 2 * rng_int_below(seed, 5), 0.3);
    }
}

static struct glint_model_system
make_system_of_outputs(const struct model_image *m, uint32_t outputs,
                       int n_outputs, uint32_t box)
{
    const struct glint_model_header *h = model_header_of(m);

    return (struct glint_model_system){.sine_hi_q30 = MODEL_ONE_Q30 / 2,
                                       .wave_lo_q24 = h->wave_lo_q24,
                                       .wave_hi_q24 = h->wave_hi_q24,
                                       .box_at = box,
                                       .box_exponent = -20,
                                       .output_at = outputs,
                                       .n_outputs = (uint8_t)n_outputs,
                                       .box_terms = 1};
}

/* Writes a ghost for each pair of SURFACES, the max number of surfaces of a
 * lens. VARIANTS: number of different ghost shapes. */
static void append_ghost_per_pair(struct model_image *m,
                                  enum hostile_family family, uint32_t *seed)
{
    enum { VARIANTS = 300 };
    static struct glint_model_ghost ghost[PAIRS];
    static struct glint_model_system of[PAIRS];
    const int32_t side[] = {0, 4 << 20, 4 << 20};
    const int folds = family == HOSTILE_FOLDS;
    const uint32_t box = model_append_items(m, side, sizeof side);
    uint32_t output[VARIANTS], n = 0;

    for (int k = 0; k < VARIANTS; k++) {
        struct polynomial p[GLINT_OUT_KINDS];

        if (folds)
            set_folded_ghost(p, seed);
        else
            set_frame_filling_ghost(p, seed);
        if (family == HOSTILE_COLOURS)
            p[GLINT_OUT_SENSOR_X].w = 30;
        output[k] = append_polynomials_as_outputs(
            m, p, folds ? GLINT_OUT_KINDS : GLINT_OUT_ENERGY + 1);
    }
    for (uint32_t j = 1; j < SURFACES; j++)
        for (uint32_t i = 0; i < j; i++, n++) {
            ghost[n] = (struct glint_model_ghost){i, j, n, 1};
            of[n] = make_system_of_outputs(
                m, output[n % VARIANTS],
                folds ? GLINT_OUT_KINDS : GLINT_OUT_ENERGY + 1, box);
            of[n].annulus = folds && n % 5 == 0 ? GLINT_MAX_ANNULUS : 0;
        }
    model_append_ghosts(m, ghost, PAIRS, of, PAIRS);
}

/* Writes ghosts with invalid rays, in one of three variants: all rays have
 * negative energy (NUMBER modulo 3 is 0), stripes of rays do (1), or some rays
 * land far off-screen (2). From NUMBER 5 on, there are as many ghosts as a lens
 * can have. */
static void append_ghosts_with_invalid_rays(struct model_image *m, int number,
                                            uint32_t *seed)
{
    static struct glint_model_ghost ghost[PAIRS];
    static struct glint_model_system of[PAIRS];
    const uint32_t n = number < 5 ? 300 : PAIRS;
    const int32_t side[] = {0, 4 << 20, 4 << 20};
    const uint32_t box = model_append_items(m, side, sizeof side);
    struct polynomial p[GLINT_OUT_KINDS];
    uint32_t output;

    set_frame_filling_ghost(p, seed);
    if (number % 3 == 0)
        p[GLINT_OUT_ENERGY].u[0] = -0.5;
    if (number % 3 == 1)
        add_chebyshev_polynomial(p[GLINT_OUT_ENERGY].u, 9, 0.6);
    if (number % 3 == 2)
        add_chebyshev_polynomial(p[number % 2].v, 8 + number % 2, 0x1p30);
    output = append_polynomials_as_outputs(m, p, GLINT_OUT_ENERGY + 1);
    for (uint32_t k = 0; k < n; k++) {
        ghost[k] = (struct glint_model_ghost){k % 63, 63, k, 1};
        of[k] = make_system_of_outputs(m, output, GLINT_OUT_ENERGY + 1, box);
    }
    model_append_ghosts(m, ghost, n, of, n);
}

/* Writes one ghost, or two from NUMBER 5 on, with 10000 polynomial systems,
 * each for a narrow band of wavelengths and a small range of angles. All
 * systems refer to the same outputs and pupil box, which keeps the file
 * small. */
static void append_ghost_with_many_systems(struct model_image *m, int number,
                                           uint32_t *seed)
{
    enum { ANGLES = 100, BANDS = 100, N = ANGLES * BANDS };
    static struct glint_model_system of[N];
    const struct glint_model_header h = *model_header_of(m);
    const struct glint_model_ghost ghost[] = {
        {0, 1, 0, number < 5 ? N : N / 2},
        {0, 2, number < 5 ? N : N / 2, number < 5 ? 0 : N / 2}};
    const int32_t side[] = {0, 4 << 20, 4 << 20};
    const uint32_t box = model_append_items(m, side, sizeof side);
    const int32_t wide = (h.wave_hi_q24 - h.wave_lo_q24) / BANDS;
    const int32_t turn = MODEL_ONE_Q30 / 2 / ANGLES;
    struct polynomial p[GLINT_OUT_KINDS];
    uint32_t output;

    set_frame_filling_ghost(p, seed);
    output = append_polynomials_as_outputs(m, p, GLINT_OUT_ENERGY + 1);
    for (int k = 0; k < N; k++) {
        of[k] = make_system_of_outputs(m, output, GLINT_OUT_ENERGY + 1, box);
        of[k].sine_lo_q30 = turn * (k / BANDS);
        of[k].sine_hi_q30 = of[k].sine_lo_q30 + turn;
        of[k].wave_lo_q24 = h.wave_lo_q24 + wide * (k % BANDS);
        of[k].wave_hi_q24 = of[k].wave_lo_q24 + wide;
    }
    model_append_ghosts(m, ghost, 2, of, N);
}

/* Writes an output polynomial with the max number of terms to M and returns it.
 * Each term has a different power of u and s, and the power V of v. The run
 * time rounds each term, and here it rounds all terms up. The magnitudes of the
 * coefficients sum to 2^30 - 1, the max that the validity check accepts. */
static struct glint_model_output
append_largest_output(struct model_image *m, int kind, int exponent, int v)
{
    enum { N = GLINT_MAX_MODEL_TERMS, PART = ((1 << 30) - 1) / N };
    struct glint_model_output o = {.kind = (uint8_t)kind,
                                   .n_terms = N,
                                   .exponent = (int16_t)exponent,
                                   .bound = (1 << 30) - 1};
    uint16_t power[N];
    int32_t coef[N];

    for (int k = 0; k < N; k++) {
        power[k] = (uint16_t)MODEL_POWER(k % POWERS, v, k / POWERS % POWERS,
                                         k / (POWERS * POWERS));
        coef[k] = PART;
    }
    coef[0] += (1 << 30) - 1 - N * PART;
    o.term_at = model_append_items(m, power, sizeof power);
    o.coef_at = model_append_items(m, coef, sizeof coef);
    return o;
}

/* Writes a ghost whose outputs have the max number of terms. NUMBER sets their
 * exponents. For even NUMBER, barrel outputs get the exponent -47, with which a
 * shift by 31 bits rounds 2^30 to 1. */
static void append_ghost_with_largest_outputs(struct model_image *m, int number)
{
    static const struct glint_model_ghost ghost[] = {{0, 1, 0, 1}};
    const int32_t side[] = {0, 1 << 29, 1 << 29};
    struct glint_model_output o[GLINT_OUT_KINDS];
    struct glint_model_system s;

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        const int is_barrel = kind > GLINT_OUT_ENERGY;

        o[kind] = append_largest_output(
            m, kind,
            is_barrel && number % 2 == 0 ? -47
            : kind < GLINT_OUT_STOP_X    ? -24 - number
                                         : -29 - number,
            kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y);
    }
    s = make_system_of_outputs(m, model_append_items(m, o, sizeof o),
                               GLINT_OUT_KINDS,
                               model_append_items(m, side, sizeof side));
    s.box_exponent = -26;
    model_append_ghosts(m, ghost, 1, &s, 1);
}

/* ------------------------------------------------------- editing of models */

/* Returns the address of OFFSET in M, for editing a baked model in place. */
static void *address_in_model(const struct model_image *m, uint32_t offset)
{
    return m->data + offset;
}

/* Sets the coefficients of output O to random values whose magnitudes sum to
 * just below 2^30. */
static void randomise_output_coefficients(const struct model_image *m,
                                          struct glint_model_output *o,
                                          uint32_t *seed)
{
    const int n_wide = o->n_terms - o->n_narrow;
    int32_t *wide = address_in_model(m, o->coef_at);
    int16_t *narrow = (int16_t *)(void *)(wide + n_wide);
    int64_t left = (INT64_C(1) << 30) - 1;

    for (int k = 0; k < o->n_narrow; k++) {
        narrow[k] = (int16_t)(rng_int_below(seed, 1 << 9) - (1 << 8));
        left -= (int64_t)abs(narrow[k]) << o->narrow_shift;
    }
    for (int k = 0; k < n_wide && left > 0; k++) {
        const int64_t part =
            k == n_wide - 1 ? left : left * rng_int_below(seed, 1 << 20) >> 20;

        wide[k] = (int32_t)(rng_int_below(seed, 2) ? part : -part);
        left -= part;
    }
}

static void randomise_coefficients(const struct model_image *m,
                                   struct glint_model_system *s, uint32_t *seed)
{
    struct glint_model_output *o = address_in_model(m, s->output_at);

    for (int k = 0; k < s->n_outputs; k++) {
        const int kind = o[k].kind;

        if (rng_int_below(seed, 3))
            randomise_output_coefficients(m, &o[k], seed);
        if (rng_int_below(seed, 2) && kind > GLINT_OUT_STOP_Y)
            o[k].exponent = (int16_t)(rng_int_below(seed, 121) - 80);
        if (rng_int_below(seed, 4) == 0)
            o[k].exponent =
                (int16_t)(o[k].exponent + rng_int_below(seed, 9) - 4);
        if (kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y)
            o[k].exponent = o[k - 1].exponent;
        if (kind == GLINT_OUT_ENERGY) {
            o[k].head = (uint8_t)rng_int_below(seed, 29);
            o[k].roots = (uint8_t)rng_int_below(seed, 3);
        }
    }
}

static void randomise_pupil_box(const struct model_image *m,
                                struct glint_model_system *s, int huge,
                                uint32_t *seed)
{
    int n = 0;
    int32_t *box = address_in_model(m, s->box_at);

    for (int bit = 0; bit < GLINT_BOX_TERMS; bit++)
        n += s->box_terms >> bit & 1;
    for (int side = 0; side < 3; side++)
        for (int k = 0; k < n; k++)
            box[side * n + k] =
                k == 0 && huge ? (1 << 30) - 1 - (side == 0) * (1 << 29) : 0;
    s->box_exponent = huge && rng_int_below(seed, 2)
                          ? 40 - rng_int_below(seed, 40)
                          : s->box_exponent;
}

/* Replaces the stop positions of S in one of three ways, selected by NUMBER
 * modulo 3. With 0, all rays pass the middle of the stop. With 1, only the
 * first coefficient remains; it grows with NUMBER, so that all rays may miss
 * the stop. With 2, positions get the exponent 2 NUMBER - 20, so that hardly
 * any ray passes the stop. */
static void randomise_stop_positions(const struct model_image *m,
                                     struct glint_model_system *s, int number)
{
    struct glint_model_output *o = address_in_model(m, s->output_at);

    for (int k = GLINT_OUT_STOP_X; k <= GLINT_OUT_STOP_Y; k++) {
        int32_t *wide = address_in_model(m, o[k].coef_at);

        if (number % 3 == 2) {
            o[k].exponent = (int16_t)(-20 + 2 * number);
            continue;
        }
        memset(wide, 0,
               4 * (size_t)(o[k].n_terms - o[k].n_narrow) +
                   2 * (size_t)o[k].n_narrow);
        if (number % 3 == 1 && o[k].n_terms > o[k].n_narrow)
            wide[0] = number << 25;
    }
}

static void randomise_header(struct glint_model_header *h, uint32_t *seed)
{
    struct glint_real *const real[] = {
        &h->focal_mm,       &h->back_focal_mm,  &h->entrance_radius_mm,
        &h->stop_radius_mm, &h->f_number,       &h->film_width_mm,
        &h->film_height_mm, &h->field_mm,       &h->front_mm,
        &h->direct_flux[0], &h->direct_flux[1], &h->stopped_flux[0][0]};

    for (size_t k = 0; k < sizeof real / sizeof *real; k++)
        if (rng_int_below(seed, 3) == 0)
            real[k]->exponent = rng_int_below(seed, 401) - 200;
    if (rng_int_below(seed, 3) == 0)
        h->wave_lo_q24 = 1;
    if (rng_int_below(seed, 3) == 0)
        h->wave_hi_q24 = INT32_MAX;
    if (rng_int_below(seed, 3) == 0)
        h->sine_hi_q30 = rng_int_below(seed, 2) ? 1 : 1 << 30;
    if (rng_int_below(seed, 3) == 0)
        h->n_parts = h->n_ghosts;
}

/* Sets the name in header H to an invalid name, selected by NUMBER. */
static void set_invalid_name(struct glint_model_header *h, int number)
{
    static const char *const name[HOSTILE_EACH] = {"evil\xc2\x9b"
                                                   "31m",
                                                   "evil\x9b"
                                                   "2J",
                                                   "evil\x1b[2J",
                                                   "two\nlines",
                                                   "\xff\xfe",
                                                   "unused",
                                                   "a/../b",
                                                   "",
                                                   "\xe2\x80\xae",
                                                   "del\x7f"};

    /* number 5 is a name without a terminating 0 */
    if (number == 5)
        memset(h->name, 'x', sizeof h->name);
    else
        snprintf(h->name, sizeof h->name, "%s", name[number]);
}

static void edit_all_systems(struct model_image *m,
                             const struct glint_lens *baked,
                             enum hostile_family family, int number,
                             uint32_t *seed)
{
    struct glint_model_header *h;
    struct glint_model_system *s;

    m->bytes = baked->header->bytes;
    m->data = test_free_later(malloc(m->bytes));
    memcpy(m->data, baked->header, m->bytes);
    h = model_header_of(m);
    s = address_in_model(m, h->system_at);
    for (uint32_t k = 0; k < h->n_systems; k++)
        if (family == HOSTILE_NUMBERS)
            randomise_coefficients(m, &s[k], seed);
        else if (family == HOSTILE_WINDOWS)
            randomise_stop_positions(m, &s[k], number);
        else if (family == HOSTILE_POINTS || family == HOSTILE_HUGE)
            randomise_pupil_box(m, &s[k], family == HOSTILE_HUGE, seed);
    if (family == HOSTILE_HEADERS)
        randomise_header(h, seed);
    if (family == HOSTILE_TEXTS)
        set_invalid_name(h, number);
    model_seal_checksum(m);
}

/* ------------------------------------------------------------------ drawing */

/* Returns the sum, over all edges of FLARE, of the pixel rows that the edge
 * crosses. */
static double count_crossed_rows(const struct glint_flare *flare)
{
    double rows = 0;

    for (int i = 0; i < flare->n_drawn; i++)
        for (int k = 0; k < flare->slot[i].n; k++) {
            const struct glint_edge *e =
                &glint_flare_get_edges(flare)->edge[flare->slot[i].first + k];
            const int first = e->y_q8 > 0 ? e->y_q8 >> 8 : 0;
            const int end = (e->end_y_q8 + 255) >> 8;

            rows += (end < flare->height ? end : flare->height) - first;
        }
    return rows;
}

/* Returns the estimated cost of the frame, millions of instructions: a weighted
 * sum of the items that its plans examined, the vertices and edges that were
 * binned, and the rows and pixels drawn. */
static double estimate_frame_instructions(const struct glint_frame *f,
                                          const struct glint_engine_report *r)
{
    double count[GLINT_COST_KINDS] = {
        [GLINT_COST_LOOKED_AT] = (double)r->looked,
        [GLINT_COST_BUNDLES] = (double)f->memory.flare->n_bundles * r->binned,
        [GLINT_COST_EDGES] = (double)r->stats.need_primitives * r->binned,
        [GLINT_COST_ROWS] = count_crossed_rows(f->memory.flare),
        [GLINT_COST_LIT] = (double)r->tiles * (1 << 2 * f->cfg.tile_log2)};
    double work = 0;

    for (int i = 0; i < f->memory.flare->n_bundles; i++) {
        const double n = f->memory.flare->bundle[i].n_cells + 1.;

        count[GLINT_COST_VERTICES] += n * n * r->binned;
    }
    for (int k = 0; k < GLINT_COST_KINDS; k++)
        work += 1e-3 * glint_cost_weight[k].counted * count[k];
    return work;
}

static bool make_hostile_setup(const struct hostile_scene *scene,
                               const struct glint_lens *lens,
                               struct glint_setup *setup)
{
    static const double nm[3] = {650, 532, 450};
    const double widest = glint_real_value(lens->header->f_number);
    struct glint_error error;

    if (glint_setup_from_model(setup, lens, 8, 0, nm, 3, &error) != GLINT_OK)
        return false;
    if (scene->opening < 1 &&
        glint_setup_stop_down(setup, lens, widest / scene->opening, &error) !=
            GLINT_OK)
        return false;
    glint_setup_spread(setup, lens);
    return true;
}

static bool draw_hostile_frame(const struct hostile_scene *scene,
                               struct glint_frame *frame,
                               struct hostile_result *result)
{
    enum { W = HOSTILE_WIDTH, H = HOSTILE_HEIGHT };
    struct glint_image image = {.format = scene->linear ? GLINT_LINEAR_Q20
                                                        : GLINT_RGB24,
                                .width = W,
                                .height = H,
                                .range = GLINT_RANGE_FULL};
    void *pixels = calloc((size_t)W * H, 12);
    struct glint_engine_report report;
    bool drawn;

    glint_image_place(&image, pixels);
    drawn = pixels && glint_frame_draw(frame, scene->lamp, scene->n_lamps, 1,
                                       &image, &report) == GLINT_OK;
    free(pixels);
    if (!drawn)
        return false;
    *result = (struct hostile_result){
        .outcome = report.stats.dropped_bundles ? HOSTILE_LESS
                   : report.coarsened           ? HOSTILE_COARSER
                   : report.stats.primitives    ? HOSTILE_DRAWN
                                                : HOSTILE_EMPTY,
        .minsn = estimate_frame_instructions(frame, &report),
        .most_minsn = frame->limits.most_minsn * frame->limits.share,
        .bytes = (double)report.arena_bytes,
        .most_bytes = (double)frame->limits.most_bytes * frame->limits.share,
        .plans = report.plans};
    return true;
}

bool hostile_draw_scene(const struct hostile_scene *scene,
                        struct hostile_result *result)
{
    static struct glint_setup setup;
    struct glint_lens lens;
    struct glint_frame frame;
    bool drawn;

    *result = (struct hostile_result){.outcome = HOSTILE_REFUSED,
                                      .reason = "its setup"};
    if (glint_lens_open(&lens, scene->model.data, scene->model.bytes,
                        &result->reason) != GLINT_OK ||
        !make_hostile_setup(scene, &lens, &setup))
        return true;
    glint_frame_init(
        &frame, &setup,
        glint_view_fit(HOSTILE_WIDTH, HOSTILE_HEIGHT,
                       glint_real_value(lens.header->film_width_mm),
                       glint_real_value(lens.header->film_height_mm)),
        NULL);
    frame.lens = &lens;
    frame.cfg.sets = glint_sets_here();
    drawn = draw_hostile_frame(scene, &frame, result);
    glint_frame_finish(&frame);
    return drawn;
}

/* ----------------------------------------------------------- hostile scene */

void hostile_make_scene(struct hostile_scene *scene, enum hostile_family family,
                        int number, const struct glint_lens *baked)
{
    struct model_image *m = &scene->model;
    uint32_t seed = 1 + 1000 * (uint32_t)family + (uint32_t)number;

    *scene = (struct hostile_scene){
        .opening = family == HOSTILE_WINDOWS ? exp2(-number) : 1,
        .n_lamps = number % 2 ? HOSTILE_LAMPS : 1,
        .linear = number % 5 == 4};
    for (int i = 0; i < scene->n_lamps; i++) {
        scene->lamp[i] = (struct glint_lamp){.power = exp2(8 + number * 4),
                                             .rgb = {1, 1, 1}};
        scene->lamp[i].theta_deg = 1 + 25 * rng_unit(&seed);
        scene->lamp[i].phi_deg = 360 * rng_unit(&seed);
    }
    if ((family >= HOSTILE_NUMBERS && family <= HOSTILE_HEADERS) ||
        family == HOSTILE_TEXTS) {
        edit_all_systems(m, baked, family, number, &seed);
        return;
    }
    model_begin_header(m, GLINT_BASIS_AUTO, "hostile");
    model_header_of(m)->n_surfaces = SURFACES;
    if (family == HOSTILE_LOST)
        append_ghosts_with_invalid_rays(m, number, &seed);
    else if (family == HOSTILE_SYSTEMS)
        append_ghost_with_many_systems(m, number, &seed);
    else if (family == HOSTILE_SUMS)
        append_ghost_with_largest_outputs(m, number);
    else
        append_ghost_per_pair(m, family, &seed);
}
