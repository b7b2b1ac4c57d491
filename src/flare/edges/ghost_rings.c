/* SPDX-License-Identifier: MIT
 *
 * Draws the ghosts of a stop with a soft edge as nested outlines (rings). Each
 * ring has an equal fraction of the light. */
#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"
#include "flare/edges/ghost_shade.h"

enum { MOST_LOG2 = 4 }; /* log2 of GLINT_SOFT_RINGS */

/* Position of each ring within the soft edge: 0 at its outer border, 1 at its
 * inner border. For ring i it is the solution x of 3 x^2 - 2 x^3 = (2 i + 1) /
 * 32. */
static const uint16_t depth_q16[GLINT_SOFT_RINGS] = {
    6938,  12393, 16384, 19804, 22914, 25838, 28650, 31402,
    34134, 36886, 39698, 42622, 45732, 49152, 53143, 58598};

/* Returns log2 of X, rounded down and clamped to 0 .. 30. */
static int compute_floor_log2(struct glint_real x)
{
    const int64_t n = real_integer(x, 0, INT64_C(1) << 30);

    return bit_length((uint64_t)n | 1) - 1;
}

/* Returns log2 of the number of rings. If the ghost's light is known, the
 * number is limited so that rings are at least a pixel apart and each ring adds
 * at least half a code of light. */
static int choose_rings_log2(const struct glint_ghost_edges *g)
{
    int log2 = MOST_LOG2;

    if (g->irradiance.mantissa && g->coded) {
        /* With each octave by which light gets fainter, the light of one code
         * falls to 2^(-7/12). */
        const int octaves = -(g->irradiance.exponent + 31);
        const int codes_log2 = 8 - (octaves > 0 ? octaves * 5 / 12 : 0);

        log2 = codes_log2 < log2 ? codes_log2 : log2;
    }
    if (g->irradiance.mantissa) {
        /* about 4 times the squared width of the soft edge, pixels^2: the
         * ghost's area times soft^2 */
        const struct glint_real soft = real_of(g->stop->shade->soft_q16, -16);
        const struct glint_real pixels2 = real_times(
            real_over(g->flux, g->irradiance), real_times(soft, soft));
        const int pixels_log2 = compute_floor_log2(pixels2) / 2;

        log2 = pixels_log2 < log2 ? pixels_log2 : log2;
    }
    return log2 > 0 ? log2 : 0;
}

/* Moves the outline of STOP inwards by BY stop radii. Returns 0 if that closes
 * the stop. */
static int shrink_stop_outline(struct glint_stop *stop, int32_t by_q16)
{
    if (stop->n_blades == 0)
        stop->inset_q16 =
            by_q16 - (int32_t)q_shift((int64_t)by_q16 * by_q16, 17);
    else if (stop->round_q30) {
        const int64_t apothem_q16 =
            stop->apothem_q16 - q_divide((int64_t)by_q16 << 30, stop->off_q30);

        stop->apothem_q16 = (int32_t)apothem_q16;
        return apothem_q16 * stop->off_q30 + ((int64_t)stop->round_q30 << 15) >
               0;
    } else
        stop->apothem_q16 -= by_q16;
    return stop->n_blades == 0 ? stop->inset_q16 < 1 << 15
                               : stop->apothem_q16 > 0;
}

void glint_ghost_emit_soft_outline(struct glint_ghost_edges *g)
{
    const struct glint_stop *whole = g->stop;
    const int log2 = whole->shade->soft_q16 ? choose_rings_log2(g) : 0;
    const struct glint_bundle *bundle = g->bundle;
    const int32_t limit_q8 = g->limit_q8;
    struct glint_bundle share = *bundle;
    struct glint_stop ring;
    int n_dropped = 0;

    if (!whole->shade->soft_q16) {
        glint_ghost_emit_hard_outline(g);
        return;
    }
    share.flux_exponent -= log2;
    g->bundle = &share;
    g->stop = &ring;
    g->limit_q8 = limit_q8 >> log2 ? limit_q8 >> log2 : 1;
    for (int i = 0; i < 1 << log2; i++) {
        const int at = (2 * i + 1) << (MOST_LOG2 - log2);
        const int32_t depth =
            log2 == MOST_LOG2
                ? depth_q16[i]
                : (depth_q16[(at - 1) / 2] + depth_q16[at / 2]) / 2;

        ring = *whole;
        if (!shrink_stop_outline(
                &ring,
                (int32_t)q_shift((int64_t)whole->shade->soft_q16 * depth, 16)))
            break;
        g->n_dropped = 0;
        glint_ghost_emit_hard_outline(g);
        n_dropped = g->n_dropped > n_dropped ? g->n_dropped : n_dropped;
    }
    g->n_dropped = n_dropped;
    g->bundle = bundle;
    g->stop = whole;
    g->limit_q8 = limit_q8;
}
