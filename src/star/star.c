/* SPDX-License-Identifier: MIT */
#include "star/starburst.h"

#include "base/arena.h"
#include "base/log2.h"
#include "base/real.h"
#include "star/parts.h"

/* ------------------------------------------------------------------ memory */

static int is_valid_config(const struct glint_star_config *c)
{
    return c->n_workers >= 1 && c->n_workers <= 64 && c->width >= 1 &&
           c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->max_lights >= 1 &&
           c->max_lights <= GLINT_STAR_MAX_LIGHTS;
}

/* Allocates a starburst and its arrays from arena A. Called twice: first with
 * an arena that only counts bytes, where it returns NULL; then with an arena
 * that has memory. */
static struct glint_star *allocate_star(struct glint_arena *a,
                                        const struct glint_star_config *c)
{
    const size_t n = (size_t)c->max_lights, n_workers = (size_t)c->n_workers;
    struct glint_star measured, *placed, *s;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    s = placed ? placed : &measured;
    s->lamp = glint_arena_allocate(a, n, sizeof *s->lamp);
    s->worker = glint_arena_allocate(a, n_workers, sizeof *s->worker);
    s->rows = glint_arena_allocate(a, n_workers, sizeof *s->rows);
    for (size_t i = 0; i < n_workers; i++) {
        uint16_t *const near = glint_arena_allocate(a, 2 * n, sizeof *near);
        int64_t(*const light_q20)[3][GLINT_CODES_WIDTH] =
            glint_arena_allocate(a, GLINT_STAR_BAND, sizeof *light_q20);

        if (placed)
            s->worker[i] =
                (struct glint_star_row){.near = near,
                                        .here = near + n,
                                        .band = {.light_q20 = light_q20}};
    }
    return placed;
}

static void clear_band(struct glint_star_band *band)
{
    for (int row = 0; row < GLINT_STAR_BAND; row++)
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < GLINT_CODES_WIDTH; x++)
                band->light_q20[row][c][x] = 0;
}

size_t glint_star_count_bytes(const struct glint_star_config *cfg)
{
    struct glint_arena arena = glint_arena_begin_measuring();

    if (!is_valid_config(cfg))
        return 0;
    allocate_star(&arena, cfg);
    return arena.used;
}

enum glint_status glint_star_init(struct glint_star **star,
                                  const struct glint_star_config *cfg,
                                  void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_star *s;

    if (!is_valid_config(cfg) || (uintptr_t)mem % GLINT_ALIGN != 0)
        return GLINT_E_ARGUMENT;
    if (glint_star_count_bytes(cfg) > bytes)
        return GLINT_E_MEMORY;
    s = allocate_star(&arena, cfg);
    s->cfg = *cfg;
    s->tables = NULL;
    s->n_lamps = s->is_linear = 0;
    s->kernels = glint_choose_star_kernels(cfg->sets);
    for (uint32_t i = 0; i < GLINT_STAR_INVERSES + 2; i++)
        s->inverse_q31[i] =
            (GLINT_STAR_INVERSES << 16) / (GLINT_STAR_INVERSES + i);
    for (int i = 0; i < cfg->n_workers; i++) {
        s->worker[i].star = s;
        clear_band(&s->worker[i].band);
    }
    *star = s;
    return GLINT_OK;
}

/* ------------------------------------------------------------------ lights */

/* Multiplies each channel of RGB by X. Sets PART to the products as mantissas
 * of 15 bits, and returns their common exponent. */
static int multiply_rgb_by_real(const int32_t rgb_q14[3], struct glint_real x,
                                int32_t part[3])
{
    for (int c = 0; c < 3; c++)
        part[c] = (int32_t)((int64_t)q_clamp_sat(rgb_q14[c], 0, 1 << 14) *
                                x.mantissa >>
                            30);
    return x.exponent + 16;
}

static int32_t compute_real_log2_q16(struct glint_real x)
{
    return x.mantissa > 0
               ? q_log2_q16((uint64_t)x.mantissa) + x.exponent * 65536
               : INT32_MIN / 2;
}

/* Returns 2^LOG2_OF, a distance in pixels, rounded up; at most 2^20 + 1. */
static int compute_exp2_ceil(int32_t log2_of_q16)
{
    const int64_t far_q16 = q_exp2_q16(q_smaller(log2_of_q16, 20 * 65536));

    return (int)(far_q16 >> 16) + 1;
}

/* Returns the number of steps of the line profiles from the line's centre to
 * the last step whose light exceeds 2^MIN_LOG2; 0 if none does. */
static int count_visible_profile_steps(const struct glint_star_tables *t,
                                       int32_t min_log2_q16)
{
    const int64_t least =
        q_exp2_q16(q_clamp_sat(min_log2_q16, -65536, 17 * 65536)) >> 16;

    int i = GLINT_STAR_PROFILE;

    while (i > 0 && t->line_max[i - 1] <= least)
        i--;
    return i;
}

/* Divides the distances 0 .. reach around LAMP into zones, and sets the number
 * of visible profile steps in each zone. OVER is log2 of (light 1 pixel from
 * the lamp where the profile is 1) / (min visible light). */
static void divide_distances_into_zones(struct glint_star_lamp *lamp,
                                        const struct glint_star_tables *t,
                                        int32_t over_log2_q16)
{
    const int32_t inner_log2_q16 = q_log2_q16(lamp->inner_q16) - 16 * 65536;
    int n = 1;

    while (n < GLINT_STAR_ZONES && lamp->reach >> 2 * n > 8)
        n++;
    lamp->n_zones = n;
    for (int i = 0; i <= n; i++)
        lamp->start[i] = i ? lamp->reach >> 2 * (n - i) : 0;
    for (int i = 0; i < n; i++) {
        const uint64_t r = (uint64_t)lamp->start[i];
        const int32_t r2_log2_q16 = r ? q_log2_q16(r * r) : 0;

        lamp->seen[i] = count_visible_profile_steps(
            t, q_larger(r2_log2_q16, inner_log2_q16) - over_log2_q16);
    }
}

/* Returns the distance, pixels, up to which the halo of a light of power
 * 2^POWER_LOG2 is brighter than 2^MIN_LOG2; 0 if nowhere. */
static int compute_halo_reach(const struct glint_star_tables *t,
                              int32_t power_log2_q16, int32_t min_log2_q16)
{
    const int last = GLINT_STAR_HALO_ROWS - 1;

    for (int row = last; row >= 0; row--) {
        /* Row i covers r^2 from 2^(4 + i / 2) on; between rows the table is
         * interpolated, and the last row covers all larger r^2. */
        const int32_t max_q11 =
            q_larger(t->halo_max[row], t->halo_max[q_smaller(row + 1, last)]);
        const int32_t r2_log2_q16 =
            t->halo_log2_q16 + max_q11 * 32 + power_log2_q16 - min_log2_q16;
        const int32_t end_q16 = (4 << 16) + (row + 1) * 32768;

        if (r2_log2_q16 >= end_q16 - 32768)
            return compute_exp2_ceil(
                (row < last ? q_smaller(r2_log2_q16, end_q16) : r2_log2_q16) /
                2);
    }
    return 0;
}

/* Returns whether an entry of the halo tables of LAMP exceeds MIN_LOG2 in
 * column COLUMN of ROW or of the row after it. */
static int is_halo_column_visible(const struct glint_star_lamp *lamp, int row,
                                  int column, int32_t min_log2_q16)
{
    const int next = q_smaller(row + 1, GLINT_STAR_HALO_ROWS - 1);
    int max_q11 = 0;

    for (int c = 0; c < 3; c++) {
        max_q11 = q_larger(max_q11, lamp->halo[row][column][c]);
        max_q11 = q_larger(max_q11, lamp->halo[next][column][c]);
        max_q11 = q_larger(max_q11, lamp->next_halo[row][column][c]);
        max_q11 = q_larger(max_q11, lamp->next_halo[next][column][c]);
    }
    return max_q11 * 32 > min_log2_q16;
}

/* Sets the widths of LAMP's halo in which it is brighter than 2^MIN_LOG2. POWER
 * is the log2 of the lamp's power. */
static void set_halo_widths(struct glint_star_lamp *lamp,
                            const struct glint_star_tables *t,
                            int32_t power_log2_q16, int32_t min_log2_q16)
{
    int64_t widest_q8 = 0;

    for (int row = GLINT_STAR_HALO_ROWS - 1; row >= 0; row--) {
        const int32_t min_q16 = min_log2_q16 - t->halo_log2_q16 -
                                power_log2_q16 + (4 << 16) + row * 32768;
        int n = GLINT_STAR_HALO_COLUMNS;

        while (n > 0 && !is_halo_column_visible(lamp, row, n - 1, min_q16))
            n--;
        if (n == GLINT_STAR_HALO_COLUMNS) {
            widest_q8 = INT32_MAX;
        } else if (n > 0) {
            /* column n is at 1 + 4 v / reach = 2^(n / 4) */
            const int64_t v_q8 =
                (t->reach_q8 * (q_exp2_q16(n * 16384) - 65536) >> 18) + 1;

            widest_q8 = v_q8 > widest_q8 ? v_q8 : widest_q8;
        }
        lamp->halo_width_q8[row] = (int32_t)widest_q8;
    }
}

/* Returns the distance in pixels up to which the smear (diffraction by dirt) of
 * a light of power 2^POWER_LOG2 is brighter than 2^MIN_LOG2. */
static int compute_smear_reach(const struct glint_star_smear *s,
                               int32_t power_log2_q16, int32_t min_log2_q16)
{
    int k = s ? GLINT_STAR_SMEAR_RINGS : 0;

    while (k > 0 &&
           compute_real_log2_q16(s->step[k - 1]) + 16 * 65536 + power_log2_q16 <
               min_log2_q16)
        k--;
    return k > 0 ? GLINT_STAR_SMEAR_PX << (k - 1) : 0;
}

static struct glint_real clamp_lamp_power(struct glint_real power)
{
    const struct glint_real most = {1 << 30, 0};

    return real_less(most, power) ? most : power;
}

/* Returns the factor by which a lamp of RADIUS pixels makes its lines wider and
 * dimmer; at most 2^10. The profile of a uniform disc is 1.73 radii wide at
 * half its max. */
static int64_t compute_line_widening_q8(const struct glint_star_tables *t,
                                        int32_t radius_q8)
{
    const int64_t disc_q8 = q_divide(
        443 * (int64_t)q_clamp_sat(radius_q8, 0, 1 << 22), t->width_q8);
    const int64_t held_q8 = disc_q8 < 1 << 18 ? disc_q8 : 1 << 18;

    return q_root((uint64_t)(65536 + held_q8 * held_q8));
}

/* Sets the two halo tables between which the halo of a lamp of RADIUS pixels is
 * interpolated, and the weight of the second table. */
static void choose_halo_tables(struct glint_star_lamp *lamp,
                               const struct glint_star_tables *t,
                               int32_t radius_q8)
{
    const int32_t radius = q_clamp_sat(radius_q8, 0, 1 << 22);
    const int32_t last_q16 = (GLINT_STAR_WIDE - 1) << 16;
    /* fractional index into the halo tables of extended lamps; -1 selects the
     * table of a point light */
    const int32_t at_q16 =
        radius < 128
            ? (radius - 128) * 512
            : q_smaller(q_log2_q16((uint64_t)radius) - 7 * 65536, last_q16);
    const int at = (at_q16 + 65536) >> 16;

    lamp->halo = lamp->next_halo = t->halo;
    lamp->halo_part_q15 = 0;
    if (!t->wide)
        return;
    if (at > 0)
        lamp->halo = t->wide + (at - 1) * GLINT_STAR_HALO_ROWS;
    if (at < GLINT_STAR_WIDE) {
        lamp->next_halo = t->wide + at * GLINT_STAR_HALO_ROWS;
        lamp->halo_part_q15 = (at_q16 + 65536 - at * 65536) >> 1;
    }
}

/* Computes LAMP, the drawing parameters of light L. Returns 0 if L has no light
 * or a coordinate of 2^17 pixels or more, or if no part of its starburst is
 * brighter than FAINTEST. */
static int set_star_lamp(struct glint_star_lamp *lamp,
                         const struct glint_star_tables *t,
                         const struct glint_star_light *l,
                         struct glint_real faintest)
{
    const int32_t far = 1 << 25;
    const struct glint_real power = clamp_lamp_power(l->power);
    const int64_t wide_q8 = compute_line_widening_q8(t, l->radius_q8);
    const struct glint_real line =
        real_over(real_times(power, t->step), real_of(wide_q8, -8));
    const int32_t min_log2_q16 =
        q_larger(compute_real_log2_q16(faintest), -21 * 65536);
    const int32_t radius_q8 =
        q_larger(q_clamp_sat(l->radius_q8, 0, 1 << 22), t->inner_q8);
    int32_t most = 0;

    if (power.mantissa <= 0 || l->x_q8 <= -far || l->x_q8 >= far ||
        l->y_q8 <= -far || l->y_q8 >= far)
        return 0;
    for (int c = 0; c < 3; c++)
        most = q_larger(most, l->rgb_q14[c]);
    if (most == 0)
        return 0;
    *lamp = (struct glint_star_lamp){
        .x_q8 = l->x_q8, .y_q8 = l->y_q8, .is_bare = l->radius_q8 < 0};
    lamp->per_pixel_q16 =
        (int32_t)q_divide((int64_t)t->per_pixel_q16 << 8, wide_q8);
    lamp->pixels_q16 = (int32_t)(t->pixels_q16 * wide_q8 >> 8);
    lamp->inner_q16 = (uint64_t)radius_q8 * (uint64_t)radius_q8;
    choose_halo_tables(lamp, t, l->radius_q8);
    lamp->line_exponent = multiply_rgb_by_real(l->rgb_q14, line, lamp->line);
    lamp->core_exponent = multiply_rgb_by_real(l->rgb_q14, power, lamp->core);
    for (int c = 0; c < 3; c++)
        lamp->halo_log2_q16[c] = l->rgb_q14[c] > 0
                                     ? compute_real_log2_q16(real_times(
                                           power, real_of(l->rgb_q14[c], -14)))
                                     : INT32_MIN / 2;
    lamp->reach =
        t->n_lines && line.mantissa > 0
            ? compute_exp2_ceil(
                  (compute_real_log2_q16(line) + 16 * 65536 - min_log2_q16) / 2)
            : 0;
    divide_distances_into_zones(lamp, t,
                                compute_real_log2_q16(line) - min_log2_q16);
    lamp->halo_reach =
        compute_halo_reach(t, compute_real_log2_q16(power), min_log2_q16);
    set_halo_widths(lamp, t, compute_real_log2_q16(power), min_log2_q16);
    lamp->smear_reach = compute_smear_reach(
        t->smear, compute_real_log2_q16(power), min_log2_q16);
    return lamp->smear_reach > 1 || lamp->is_bare || lamp->reach > 1 ||
           lamp->halo_reach > 1;
}

void glint_star_set_lights(struct glint_star *star,
                           const struct glint_star_tables *tables,
                           const struct glint_star_light *lights, int n,
                           struct glint_real faintest)
{
    star->tables = tables;
    star->n_lamps = 0;
    star->faintest_log2_q16 =
        q_larger(compute_real_log2_q16(faintest), -21 * 65536) + 4 * 65536;
    for (int i = 0; i < n && star->n_lamps < star->cfg.max_lights; i++)
        star->n_lamps += set_star_lamp(&star->lamp[star->n_lamps], tables,
                                       &lights[i], faintest);
}
