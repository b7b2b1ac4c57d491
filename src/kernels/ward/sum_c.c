/* SPDX-License-Identifier: MIT */
#include "kernels/ward/texels.h"
#include "kernels/ward/ward.h"

enum { ONE_Q14 = 1 << 14, ONE_Q16 = 1 << 16 };

/* Returns 2^31 / X for X in 2^15 .. 2^16 with a relative error of at most
 * 2^-14. Starts from a linear approximation with an error of 1/17; two steps
 * of Newton's method follow. */
static uint32_t approximate_reciprocal(uint32_t x)
{
    uint32_t r_q15 = 92521 - (x * 61681 >> 16); /* 48/17 - 32/17 x */

    for (int i = 0; i < 2; i++)
        r_q15 = r_q15 * ((0U - x * r_q15) >> 16) >> 15;
    return r_q15;
}

/* Returns the square root of X_Q14, 1 .. 2^14. Scales X to 1/4 .. 1 and
 * approximates 1 / root linearly with an error of 1/11; three steps of
 * Newton's method follow. */
static uint32_t compute_root_q15(uint32_t x_q14)
{
    const int up = (16 - bit_length(x_q14)) & ~1;
    const uint32_t part_q14 = x_q14 << up >> 2;
    uint32_t y_q14 = 34900 - (part_q14 * 20000 >> 14);

    for (int i = 0; i < 3; i++) {
        const uint32_t square_q14 = y_q14 * y_q14 >> 14;

        y_q14 = y_q14 * ((3 << 14) - (square_q14 * part_q14 >> 14)) >> 15;
    }
    return (y_q14 * part_q14 >> 14 << 2) >> (up / 2);
}

/* A sample of the lobe. in: direction i from the surface to the light, in the
 * surface's frame. ho: cosine h.o between the half vector h and the direction o
 * to the eye. A sample counts if h.o and n.i are positive, where n is the
 * normal. */
struct sample {
    int32_t in_q14[3], ho_q14;
    int counts;
};

static struct sample compute_lobe_sample(const struct glint_ward_lobe *lobe,
                                         int k,
                                         const struct glint_ward_place *place)
{
    const int32_t *out_q14 = place->out_q14;
    struct sample s;
    int32_t ho_q28 = 1 << 13; /* the sum of products of unit vectors, of _q14,
                                 is 2^28 at most */

    for (int j = 0; j < 3; j++)
        ho_q28 += lobe->half_q14[j][k] * out_q14[j];
    s.ho_q14 = ho_q28 >> 14;
    for (int j = 0; j < 3; j++)
        s.in_q14[j] =
            ((s.ho_q14 * lobe->half_q14[j][k] + (1 << 12)) >> 13) - out_q14[j];
    s.counts = s.ho_q14 > 0 && s.in_q14[2] > 0;
    s.ho_q14 = q_larger(s.ho_q14, 1);
    return s;
}

/* Returns 2 - (n.o) / ((h.o) (h.n)), the weight of a sample in the bounded norm
 * (ward.h), for the half vector h, the normal n and the direction o to the
 * eye. */
static int32_t compute_bounded_weight_q12(int32_t ho_q14, int32_t hn_q14,
                                          int32_t no_q14)
{
    const int32_t d_q16 =
        q_smaller(q_larger(ho_q14 * hn_q14 >> 12, 1), ONE_Q16 - 1);
    const int up = 16 - bit_length((uint32_t)d_q16);
    const uint32_t r_q15 = approximate_reciprocal((uint32_t)d_q16 << up);
    /* where n.i is positive, (n.o) 2^up is below 2^15 */
    const uint32_t q_q12 = ((uint32_t)no_q14 << up) * r_q15 >> 17;

    return q_larger((2 << 12) - (int32_t)q_q12, 0);
}

static int32_t compute_weight_of_1992_q12(const struct glint_ward_lobe *lobe,
                                          int k, const struct sample *s,
                                          const struct glint_ward_place *place)
{
    uint32_t root, part_q15;

    if (lobe->norm == GLINT_WARD_BOUNDED)
        return compute_bounded_weight_q12(s->ho_q14, lobe->half_q14[2][k],
                                          place->out_q14[2]);
    root = compute_root_q15(
        (uint32_t)q_smaller(q_larger(s->in_q14[2], 1), ONE_Q14));
    part_q15 = ((uint32_t)(s->ho_q14 * lobe->factor_q14[k]) >> 14) * root >> 14;
    return q_smaller((int32_t)(part_q15 * (uint32_t)place->root_q14 >>
                               (17 - place->root_log2)),
                     8 << 12);
}

/* Projects the light's direction of sample S to the square of the octahedral
 * environment map. */
static void project_direction_to_map(const struct sample *s,
                                     const struct glint_ward_place *place,
                                     int32_t *u_q17, int32_t *v_q17)
{
    int32_t toward_q14[3], p_q16, q_q16;
    uint32_t away_q14[3], r_q15;

    for (int k = 0; k < 3; k++) {
        toward_q14[k] = (place->frame_q14[0][k] * s->in_q14[0] +
                         place->frame_q14[1][k] * s->in_q14[1] +
                         place->frame_q14[2][k] * s->in_q14[2] + (1 << 13)) >>
                        14;
        away_q14[k] = (uint32_t)q_magnitude(toward_q14[k]);
    }
    r_q15 =
        approximate_reciprocal((away_q14[0] + away_q14[1] + away_q14[2]) << 1);
    p_q16 = q_smaller((int32_t)(away_q14[0] * r_q15 >> 14), ONE_Q16);
    q_q16 = q_smaller((int32_t)(away_q14[2] * r_q15 >> 14), ONE_Q16);
    if (toward_q14[1] < 0) {
        const int32_t unfolded_q16 = ONE_Q16 - q_q16;

        q_q16 = ONE_Q16 - p_q16;
        p_q16 = unfolded_q16;
    }
    *u_q17 = ONE_Q16 + (toward_q14[0] < 0 ? -p_q16 : p_q16);
    *v_q17 = ONE_Q16 + (toward_q14[2] < 0 ? -q_q16 : q_q16);
}

/* Returns the coarsest mip level whose variance does not exceed that of sample
 * K. Sets *SHARE_Q8 to the weight of the next level, of four times the
 * variance, with which the blend of both levels has the variance of the
 * sample. */
static int32_t choose_mip_level(const struct glint_ward_lobe *lobe, int k,
                                int32_t ho_q14, int32_t last,
                                uint32_t *share_q8)
{
    const int up = 15 - bit_length((uint32_t)ho_q14);
    const int32_t span_q28 = lobe->span_q14[k] * (ho_q14 << up);
    const int32_t log2 = lobe->span_log2[k] - up;
    const int32_t level = (log2 + (span_q28 >> 29)) >> 1;
    const int32_t over_q8 = span_q28 >> 21 << (log2 - 2 * level + 1);

    *share_q8 = 0;
    if (level < 0)
        return 0;
    if (level >= last)
        return last;
    *share_q8 = (uint32_t)(over_q8 - 256) * 171 >> 9; /* divided by 3 */
    return level;
}

void glint_ward_sum_c(const struct glint_ward_lobe *lobe,
                      const struct glint_texels *texels,
                      const struct glint_ward_place *place, uint64_t sum_q12[3])
{
    for (int j = 0; j < 3; j++)
        sum_q12[j] = 0;
    for (int k = 0; k < lobe->n; k++) {
        const struct sample s = compute_lobe_sample(lobe, k, place);
        struct glint_reads reads;
        struct glint_found found;
        int32_t u_q17, v_q17, level;
        uint32_t share_q8;

        if (!s.counts)
            continue;
        project_direction_to_map(&s, place, &u_q17, &v_q17);
        level = choose_mip_level(lobe, k, s.ho_q14, texels->last, &share_q8);
        glint_choose_texels_to_read(&texels->level[level], u_q17, v_q17,
                                    256 - share_q8, reads.at, reads.weight_q22);
        glint_choose_texels_to_read(&texels->level[level + 1], u_q17, v_q17,
                                    share_q8, reads.at + 4,
                                    reads.weight_q22 + 4);
        glint_sum_texel_light(texels->code, &reads, 8, &found);
        glint_add_light_times_weight(
            &found, (uint32_t)compute_weight_of_1992_q12(lobe, k, &s, place),
            sum_q12);
    }
}
