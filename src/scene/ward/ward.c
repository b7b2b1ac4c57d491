/* SPDX-License-Identifier: MIT
 *
 * Ward's lobe over an environment: what each half vector reads, weighed.
 *
 * With o to the eye, i = 2 (h.o) h - o to the light, n the normal, a sample
 * counts (h.o) (h.n)^3 sqrt(n.i / n.o) in the norm of 1992 and (n.i) / ((h.o)
 * (h.n)) in the bounded one, held to 8; their density is Ward's, so that it
 * and the lobe's exponential cancel. */
#include "base/divide.h"
#include "base/log2.h"
#include "glint/scene/ward.h"
#include "scene/vector.h"

enum { ONE_Q14 = 1 << 14, MOST_LIGHT = 1 << 30 };

/* Returns what S counts, q12, 0 .. 8. */
static int32_t weight_q12(enum glint_ward_norm norm,
                          const struct glint_ward_sample *s, int32_t ho_q14,
                          int32_t ni_q14, int32_t no_q14)
{
    uint32_t n, d;

    if (norm == GLINT_WARD_BOUNDED) {
        n = (uint32_t)ni_q14 << 14;
        d = (uint32_t)ho_q14 * (uint32_t)s->factor_q14; /* to 2^28 */
    } else {
        /* Roots keep the digits of n.i and n.o, 1 .. 2^14: q21. */
        const uint32_t root_i_q21 = glint_root((uint64_t)ni_q14 << 28);
        const uint32_t root_o_q21 = glint_root((uint64_t)no_q14 << 28);

        n = (uint32_t)((uint64_t)root_i_q21 *
                           ((uint32_t)ho_q14 * (uint32_t)s->factor_q14 >> 14) >>
                       14);
        d = root_o_q21;
    }
    if ((n >> 3) >= d)
        return 8 << 12;
    return (q_part_q30(n, (uint64_t)d << 3) + (1 << 14)) >> 15;
}

/* Adds what S sends back. */
static void add(const struct glint_ward_lobe *lobe,
                const struct glint_environment *environment,
                const struct glint_ward_sample *s,
                const int32_t frame_q14[3][3], const int32_t out_q14[3],
                int64_t sum_q12[3])
{
    const int32_t *h_q14 = s->half_q14;
    const int32_t ho_q14 = (h_q14[0] * out_q14[0] + h_q14[1] * out_q14[1] +
                            h_q14[2] * out_q14[2] + (1 << 13)) >>
                           14; /* unit vectors: products sum to 2^28 */
    int32_t in_q14[3], toward_q14[3], rgb[3], weight;

    if (ho_q14 <= 0)
        return;
    for (int k = 0; k < 3; k++)
        in_q14[k] = ((ho_q14 * h_q14[k] + (1 << 12)) >> 13) - out_q14[k];
    if (in_q14[2] <= 0)
        return;
    weight = weight_q12(lobe->norm, s, ho_q14, q_smaller(in_q14[2], ONE_Q14),
                        out_q14[2]);
    for (int k = 0; k < 3; k++)
        toward_q14[k] =
            (frame_q14[0][k] * in_q14[0] + frame_q14[1][k] * in_q14[1] +
             frame_q14[2][k] * in_q14[2] + (1 << 13)) >>
            14;
    glint_environment_look(
        environment, toward_q14,
        s->level_q8 +
            (int32_t)q_shift(q_log2_q16((uint64_t)ho_q14) - (14 << 16), 9),
        lobe->nearest, rgb);
    for (int k = 0; k < 3; k++)
        sum_q12[k] += (int64_t)rgb[k] * weight;
}

/* Returns X 2^LOG2, 0 .. 2^30; X is 0 .. 2^61. */
static int32_t scaled(int64_t x, int log2)
{
    if (log2 < -62)
        return 0;
    if (log2 <= 0)
        return q_clamp_sat(q_shift(x, -log2), 0, MOST_LIGHT);
    if (x == 0)
        return 0;
    return log2 > 30 || x >> (30 - log2) > 0 ? MOST_LIGHT
                                             : (int32_t)(x << log2);
}

void glint_ward_light(const struct glint_ward_lobe *lobe,
                      const struct glint_environment *environment,
                      const int32_t frame_q14[3][3], const int32_t view_q14[3],
                      int32_t rgb_q15[3])
{
    int64_t sum_q12[3] = {0, 0, 0}; /* below 32 * 8 * 2^12 * 2^28 = 2^48 */
    int32_t out_q14[3];

    for (int k = 0; k < 3; k++)
        out_q14[k] = (int32_t)q_shift(v3_dot(frame_q14[k], view_q14), 14);
    for (int k = 0; k < lobe->n && out_q14[2] > 0; k++)
        add(lobe, environment, &lobe->sample[k], frame_q14, out_q14, sum_q12);
    for (int k = 0; k < 3; k++) {
        /* The mean, below 2^45, times a colour of 2^15. */
        const int64_t mean_q12 =
            (sum_q12[k] >> 16) * lobe->share_q16 +
            ((sum_q12[k] & 0xffff) * lobe->share_q16 >> 16);

        rgb_q15[k] =
            scaled(mean_q12 * lobe->specular_q15[k], lobe->unit_log2 - 12);
    }
}
