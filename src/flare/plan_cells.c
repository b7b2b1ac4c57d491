/* SPDX-License-Identifier: MIT */
#include "flare/plan_cells.h"

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"
#include "lens/grid.h"

enum { FOLD_OCTAVES = 3, MOST_SHADE_CELLS = 128, SHADE_CELL_LOG2 = 4 };

/* Returns the root mean square of N values. SUM is the sum of their squares /
 * 2^10. Returns 0 if N is 0. */
static int64_t compute_root_mean_square(uint64_t sum, int n)
{
    return n ? (int64_t)q_root((uint64_t)q_divide((int64_t)sum, n)) << 5 : 0;
}

/* Returns the curvature of the map from the pupil to the outputs A and B, as a
 * distance on the sensor: (second difference of the outputs / their first
 * difference) times the first difference of the sensor position, each the root
 * mean square; 0 if the outputs do not change. The unit is that of the sensor
 * outputs times 2^GLINT_PROBE_FINE_LOG2. */
static int64_t compute_output_curvature(const struct glint_probe *s, int a,
                                        int b)
{
    const int64_t second = compute_root_mean_square(
        s->change[a].second + (a == b ? 0 : s->change[b].second), s->n_bends);
    const int64_t first = compute_root_mean_square(
        s->change[a].first + (a == b ? 0 : s->change[b].first), s->n_bends);
    const int64_t sensor =
        compute_root_mean_square(s->change[GLINT_OUT_SENSOR_X].first +
                                     s->change[GLINT_OUT_SENSOR_Y].first,
                                 s->n_bends);

    /* the product is at most 2^30 * 2^31 */
    return first ? q_divide(second * sensor, first) : 0;
}

/* Returns the root mean square change of the position in the stop over the
 * pupil box, in units of the stop outputs times 2^GLINT_PROBE_FINE_LOG2. */
static int64_t compute_stop_position_change(const struct glint_probe *s)
{
    return compute_root_mean_square(s->change[GLINT_OUT_STOP_X].first +
                                        s->change[GLINT_OUT_STOP_Y].first,
                                    s->n_bends);
}

/* Returns the root mean square change of the position on the sensor over the
 * pupil box, in units of the sensor outputs times 2^GLINT_PROBE_FINE_LOG2. */
static int64_t compute_sensor_position_change(const struct glint_probe *s)
{
    return compute_root_mean_square(s->change[GLINT_OUT_SENSOR_X].first +
                                        s->change[GLINT_OUT_SENSOR_Y].first,
                                    s->n_bends);
}

static int64_t compute_stop_radius(const struct glint_probe *s)
{
    /* The probe limits inside rays to 1.05 stop radii. */
    const int64_t radius =
        q_divide(s->limit[GLINT_OUT_STOP_X] * 20, 21) >> GLINT_PROBE_FINE_LOG2;

    /* The result is at least 1, as it is a divisor. */
    return radius > 0 ? radius : 1;
}

/* Returns the curvature, as a distance on the sensor, of the outline of a stop
 * whose sides have the curvature ROUND. A round stop cuts a ghost where (1 +
 * r^2) / 2 is 1, with r in stop radii. There this function changes as fast as
 * the position in the stop, and its second difference is the squared first
 * difference of that position. */
static int64_t compute_round_stop_curvature(const struct glint_probe *s,
                                            int32_t round_q16)
{
    const int64_t change =
        (compute_stop_position_change(s) >> 2) * round_q16 >> 16;
    const int64_t sensor = compute_sensor_position_change(s);

    /* at most 2^30 * 2^31 */
    return q_divide(change * sensor, (compute_stop_radius(s) >> 2) + 1);
}

/* Reduces N, a number of cells per side, to the number that an 8-bit picture
 * needs. Errors of faint ghosts are less visible in it. With each octave by
 * which a ghost is fainter, its light in codes shrinks by 2^(5/12), and errors
 * are inversely proportional to the square of the number of cells. Folds are
 * brighter than the mean of the ghost. */
static int reduce_cells_for_codes(const struct glint_probe *s,
                                  struct glint_real irradiance, int n)
{
    const int folded = s->n_up && s->n_down;
    int octaves = -(irradiance.exponent + 31) - (folded ? FOLD_OCTAVES : 0);

    if (!folded)
        n -= n / 4;
    for (; octaves > 0 && n > GLINT_LEAST_CELLS; octaves--)
        n -= n / 8;
    return n;
}

/* Returns (error allowed for outlines) / (error allowed for light): 10 or 5. It
 * is 5 for a round stop, which curves all outlines, and if three or more barrel
 * apertures cut the ray bundle. The second barrel value of a vertex is then the
 * tightest of all but the first; it has kinks, so that tips of outlines would
 * depend on the grid. */
static int
choose_outline_to_light_tolerance_ratio(const struct glint_plan *p,
                                        const struct glint_transfer *t)
{
    return p->round_q16 || t->outputs >> GLINT_OUT_BARREL_2 & 1 ? 5 : 10;
}

/* Returns the number of cells per side for a stop with dust or masks: one per
 * 2^SHADE_CELL_LOG2 pixels of the ghost, so that their image is exact to a
 * pixel within each cell; at most MOST_SHADE_CELLS. */
static int compute_cells_for_shade(const struct glint_plan *p,
                                   const struct glint_probe *s,
                                   const struct glint_transfer *t)
{
    const struct glint_real pixels = real_times(
        real_of(compute_sensor_position_change(s),
                t->exponent[GLINT_OUT_SENSOR_X] + GLINT_PROBE_FINE_LOG2),
        plan_compute_pixels_per_mm(p));

    return (int)real_integer(pixels, -SHADE_CELL_LOG2, MOST_SHADE_CELLS);
}

/* Returns the number of grid cells per side by the rule of lens/grid.h. It is
 * computed from the differences between neighbouring probe rays. */
static int compute_cells_per_side(const struct glint_plan *p,
                                  const struct glint_probe *s,
                                  const struct glint_transfer *t,
                                  struct glint_real irradiance)
{
    const struct glint_flare_frame *r = p->frame;
    const int folds =
        glint_grid_get_max_cells(r->fineness, s->n_up && s->n_down);
    const int most = folds < GLINT_MAX_CELLS ? folds : GLINT_MAX_CELLS;
    int64_t bend =
        compute_output_curvature(s, GLINT_OUT_SENSOR_X, GLINT_OUT_SENSOR_Y);
    int64_t outline =
        compute_output_curvature(s, GLINT_OUT_STOP_X, GLINT_OUT_STOP_Y);
    int64_t bend_q8;
    int n;

    if (r->uniform)
        return r->fineness;
    for (int k = GLINT_OUT_RADIUS; k < GLINT_OUT_KINDS; k++)
        if (t->outputs >> k & 1) {
            const int64_t cut = compute_output_curvature(s, k, k);

            outline = cut > outline ? cut : outline;
        }
    if (p->round_q16) {
        const int64_t cut = compute_round_stop_curvature(s, p->round_q16);

        outline = cut > outline ? cut : outline;
    }
    outline = q_divide(outline, choose_outline_to_light_tolerance_ratio(p, t));
    bend = bend > outline ? bend : outline;
    bend_q8 =
        real_integer(real_times(real_of(bend, t->exponent[GLINT_OUT_SENSOR_X] +
                                                  GLINT_PROBE_FINE_LOG2),
                                plan_compute_pixels_per_mm(p)),
                     8, INT64_C(1) << 40);
    /* n = sqrt(12.5 * curvature in pixels) * fineness / 64 */
    n = q_narrow(
        ((int64_t)q_root((uint64_t)bend_q8 * 3200) * r->fineness + 16383) >>
        14);
    if (p->shaded) {
        const int shade = compute_cells_for_shade(p, s, t);

        n = shade > n ? shade : n;
    }
    if (r->faintest.mantissa)
        n = reduce_cells_for_codes(s, irradiance, n);
    n = n < GLINT_LEAST_CELLS ? GLINT_LEAST_CELLS : n;
    n = glint_grid_round_up_to_four(n);
    return n < most ? n : most;
}

/* Returns N + 2, rounded up to an even number and clamped to GLINT_MAX_CELLS.
 * The two additional rows of cells lie in the hole of an annular pupil box. */
static int add_annulus_hole_cells(int n)
{
    const int more = (n + 3) / 2 * 2;

    return more < GLINT_MAX_CELLS ? more : GLINT_MAX_CELLS;
}

int glint_plan_choose_cells(const struct glint_plan *plan,
                            const struct glint_probe *probe,
                            const struct glint_transfer *transfer,
                            struct glint_real irradiance)
{
    const int n = compute_cells_per_side(plan, probe, transfer, irradiance);

    return transfer->annulus ? add_annulus_hole_cells(n) : n;
}

/* Returns the mean second difference of output K across the pupil box plus that
 * down the box. The unit is that of the output times
 * 2^GLINT_PROBE_FINE_LOG2. */
static int64_t sum_mean_second_differences(const struct glint_probe *s, int k)
{
    int64_t sum = 0;

    for (int way = 0; way < 2; way++)
        sum += s->n_bent[way] ? q_divide(s->change[k].bent[way], s->n_bent[way])
                              : 0;
    return sum;
}

/* Returns the mean second difference of the function (1 + r^2) / 2 of a round
 * stop across the pupil box plus that down the box. In each direction it is the
 * squared change of the stop position, in stop radii. */
static int64_t sum_round_stop_differences_q16(const struct glint_probe *s)
{
    const struct glint_real change =
        real_over(real_of(compute_stop_position_change(s), 0),
                  real_of(compute_stop_radius(s), 0));

    return 2 * real_integer(real_times(change, change), 16, INT64_C(1) << 40);
}

/* Returns the sag of a grid of N_CELLS cells per side: the mean height of the
 * straight lines between its rays above a paraboloid. It is (D + E) / 12 for
 * the second differences D across and E down a cell. BOWL is D + E over the
 * complete pupil box. */
static uint16_t compute_sag_q16(int64_t bowl_q16, int n_cells)
{
    return (uint16_t)q_clamp_sat(
        q_divide(bowl_q16, 12 * (int64_t)n_cells * n_cells), 0, 1 << 12);
}

/* The function (1 + r^2) / 2 of a barrel aperture is a paraboloid. After the
 * sag is subtracted from it, drawn outlines deviate to the outside as often as
 * to the inside. */
void glint_plan_set_sags(struct glint_bundle_plan *planned,
                         const struct glint_probe *probe,
                         const struct glint_transfer *transfer, int n_cells,
                         int32_t round_q16)
{
    for (int k = GLINT_OUT_BARREL_0; k <= GLINT_OUT_BARREL_1; k++) {
        const int64_t bowl_q16 =
            transfer->outputs >> k & 1
                ? real_integer(
                      real_of(sum_mean_second_differences(probe, k),
                              transfer->exponent[k] + GLINT_PROBE_FINE_LOG2),
                      16, INT64_C(1) << 40)
                : 0;

        planned->sag_q16[k - GLINT_OUT_BARREL_0] =
            compute_sag_q16(bowl_q16, n_cells);
    }
    planned->sag_q16[2] =
        round_q16
            ? compute_sag_q16(
                  q_shift(sum_round_stop_differences_q16(probe) * round_q16,
                          16),
                  n_cells)
            : 0;
}
