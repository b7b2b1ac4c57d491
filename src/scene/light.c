/* SPDX-License-Identifier: MIT
 *
 * Computes the light that lamps and suns cast on a point. Traces rays to find
 * the fraction of this light that is in shadow. */
#include "base/divide.h"
#include "scene/state.h"

enum { STEPS_LOG2 = 7 };

/* log2(1 + i / 128), with 30 fraction bits. */
/* clang-format off */
static const int32_t log2_q30[(1 << STEPS_LOG2) + 2] = {
    0, 12055174, 24017256, 35887675, 47667823, 59359063,
    70962728, 82480119, 93912511, 105261148, 116527248, 127712004,
    138816582, 149842124, 160789745, 171660541, 182455581, 193175914,
    203822568, 214396548, 224898839, 235330407, 245692198, 255985140,
    266210141, 276368092, 286459867, 296486323, 306448299, 316346620,
    326182095, 335955515, 345667660, 355319292, 364911162, 374444004,
    383918542, 393335482, 402695523, 411999347, 421247625, 430441017,
    439580170, 448665721, 457698295, 466678506, 475606957, 484484242,
    493310944, 502087636, 510814882, 519493235, 528123241, 536705435,
    545240343, 553728485, 562170370, 570566499, 578917365, 587223455,
    595485245, 603703206, 611877800, 620009483, 628098702, 636145900,
    644151509, 652115959, 660039669, 667923055, 675766525, 683570481,
    691335320, 699061430, 706749198, 714399001, 722011213, 729586201,
    737124328, 744625951, 752091421, 759521085, 766915285, 774274358,
    781598637, 788888448, 796144114, 803365955, 810554283, 817709409,
    824831638, 831921271, 838978604, 846003931, 852997541, 859959719,
    866890747, 873790901, 880660455, 887499680, 894308843, 901088206,
    907838029, 914558569, 921250079, 927912807, 934547002, 941152905,
    947730758, 954280797, 960803257, 967298370, 973766362, 980207461,
    986621888, 993009864, 999371606, 1005707329, 1012017244, 1018301561,
    1024560487, 1030794226, 1037002979, 1043186948, 1049346328, 1055481314,
    1061592099, 1067678873, 1073741824, 1079781138};

/* Sample points (x, y), evenly distributed on the unit disc: a set of four
 * points, and a set of sixteen along a spiral. */
static const int32_t four_q15[4][2] = {
    {21773, 7925}, {-7925, 21773}, {-21773, -7925}, {7925, -21773}};
static const int32_t sixteen_q15[16][2] = {
    {5793, 0}, {-7398, 6777}, {1132, -12903}, {9325, 12163},
    {-17112, -3027}, {16210, -10312}, {-5422, 20170}, {-10340, -19910},
    {22434, 8193}, {-23339, 9634}, {11251, -24043}, {8314, 26507},
    {-25059, -14522}, {29397, -6463}, {-17941, 25519}, {-4145, -31985}};
/* clang-format on */

/* ------------------------------------------------------------------- power */

/* Returns -log2(X), _q26, with an error of 2^-23, by a parabola through three
 * neighbouring entries of the table. X_Q30 must be 1 .. 2^30. */
static int32_t compute_minus_log2_q26(uint32_t x_q30)
{
    const int up = 31 - bit_length(x_q30), low = 30 - STEPS_LOG2;
    const uint32_t m_q30 = x_q30 << up; /* 2^30 .. 2^31 - 1 */
    const int32_t *at_q30 = &log2_q30[(m_q30 >> low) - (1 << STEPS_LOG2)];
    const int32_t f_q23 = (int32_t)(m_q30 & ((1U << low) - 1));
    const int32_t rise_q30 = at_q30[1] - at_q30[0];
    const int32_t bend_q30 = at_q30[2] - at_q30[1] - rise_q30;
    const int64_t half_q23 =
        q_shift((int64_t)f_q23 * ((1 << low) - f_q23), low + 1);
    const int64_t y_q30 = at_q30[0] + q_shift((int64_t)rise_q30 * f_q23, low) -
                          q_shift(bend_q30 * half_q23, low);

    return (int32_t)(((int64_t)up << 26) - q_shift(y_q30, 4));
}

/* X^K is 2^-e with e = -K log2(X). The power of the fractional part of e is
 * computed by a series of six terms, with a max error of 2^-12.6. */
int32_t glint_compute_power_q15(int32_t x_q30, int32_t k_q8)
{
    int64_t down_q26;
    int32_t f_q26, y_q30;

    if (x_q30 <= 0)
        return 0;
    down_q26 =
        q_shift((int64_t)compute_minus_log2_q26((uint32_t)x_q30) * k_q8, 8);
    if (down_q26 >= INT64_C(17) << 26)
        return 0;
    f_q26 = (int32_t)(down_q26 & ((1 << 26) - 1));
    y_q30 =
        Q_CONST(0.0096181291, 30) - q_mul(f_q26, Q_CONST(0.0013333558, 30), 26);
    y_q30 = Q_CONST(0.0555041087, 30) - q_mul(f_q26, y_q30, 26);
    y_q30 = Q_CONST(0.2402265070, 30) - q_mul(f_q26, y_q30, 26);
    y_q30 = Q_CONST(0.6931471806, 30) - q_mul(f_q26, y_q30, 26);
    y_q30 = (1 << 30) - q_mul(f_q26, y_q30, 26);
    return (int32_t)q_shift(y_q30, 15 + (int)(down_q26 >> 26));
}

/* ------------------------------------------------------------------- level */

/* Returns the light of a lamp of intensity REAL at distance sqrt(SQUARE): REAL
 * * 4^UNIT_LOG2 / SQUARE, _q15, clamped to GLINT_SCENE_MOST_LIGHT. */
static int32_t compute_light_at_distance(struct glint_real real, int unit_log2,
                                         uint64_t square)
{
    const int up = q_count_normalising_shift(square);
    /* mantissa / SQUARE * 2^(63 - UP), below 2^63 */
    const uint64_t over =
        (uint64_t)real.mantissa * q_reciprocal(q_shift_to_32_bits(square, up));
    const int down = 63 - up - real.exponent - 2 * unit_log2 - 15;

    if (real.mantissa == 0 || down > 63)
        return 0;
    if (down < 0 || over >> down >= GLINT_SCENE_MOST_LIGHT)
        return GLINT_SCENE_MOST_LIGHT;
    return (int32_t)(over >> down);
}

int32_t glint_scene_compute_light_at(const struct glint_scene *scene,
                                     const struct glint_lit *lit,
                                     const int32_t place[3],
                                     int32_t toward_q30[3],
                                     int32_t level_q15[3])
{
    int32_t off[3];
    int64_t wide[3];
    uint64_t square;

    if (lit->light->kind == GLINT_LIGHT_SUN) {
        for (int k = 0; k < 3; k++) {
            toward_q30[k] = lit->toward_q30[k];
            level_q15[k] = lit->rgb_q15[k];
        }
        return GLINT_FAR;
    }
    v3_subtract(lit->at, place, off);
    for (int k = 0; k < 3; k++)
        wide[k] = off[k];
    if (!glint_normalise_vector(wide, toward_q30))
        return 0;
    square = (uint64_t)v3_dot(off, off);
    for (int k = 0; k < 3; k++)
        level_q15[k] = compute_light_at_distance(
            lit->light->rgb[k], scene->model.header->unit_log2, square);
    return (int32_t)glint_compute_square_root(square);
}

/* ------------------------------------------------------------------ shadows */

void glint_scene_find_perpendicular_vectors(const int32_t d_q30[3],
                                            int32_t u_q30[3], int32_t v_q30[3])
{
    int32_t axis_q30[3] = {0, 0, 0};
    int64_t cross[3];

    axis_q30[q_magnitude(d_q30[0]) > 1 << 29] = 1 << 30;
    v3_cross(d_q30, axis_q30, cross);
    glint_normalise_vector(cross, u_q30);
    v3_cross(d_q30, u_q30, cross);
    glint_normalise_vector(cross, v_q30);
}

/* Turns RAY to sample point I of N (4 or 16) on a disc at distance T. The disc
 * has radius RADIUS and lies in the plane of the unit vectors U and V. */
static void aim_at_disc_point(struct glint_scene_ray *ray,
                              const int32_t u_q30[3], const int32_t v_q30[3],
                              int32_t t, int32_t radius, int i, int n)
{
    const int32_t *at_q15 = n == 4 ? four_q15[i] : sixteen_q15[i];
    int64_t to[3];

    /* The sum is at most 2^60 + 1.5 * 2^30 * 2^29. */
    for (int k = 0; k < 3; k++) {
        const int64_t aside_q30 = q_shift(
            (int64_t)u_q30[k] * at_q15[0] + (int64_t)v_q30[k] * at_q15[1], 15);

        to[k] = (int64_t)t * ray->toward_q30[k] + aside_q30 * radius;
    }
    glint_normalise_vector(to, ray->toward_q30);
}

void glint_scene_aim_at_light_point(struct glint_scene_ray *ray, int32_t t,
                                    int32_t radius, int i, int n)
{
    int32_t u_q30[3] = {0}, v_q30[3] = {0};

    if (radius == 0 || n == 1)
        return;
    glint_scene_find_perpendicular_vectors(ray->toward_q30, u_q30, v_q30);
    aim_at_disc_point(ray, u_q30, v_q30, t, radius, i, n);
}

/* Returns whether no object can hide any point of the disc of a light from
 * SURFACE, and all of its points are in front of SURFACE. AXIS is the ray from
 * SURFACE to the middle of the disc. */
static int is_disc_fully_visible(const struct glint_scene *scene,
                                 const struct glint_met_surface *surface,
                                 const struct glint_scene_ray *axis,
                                 int32_t distance, int32_t radius)
{
    enum { SLACK = 16 }; /* tolerance for rounding errors, 2^-30 */
    int32_t slope_q30;

    if (radius >= distance)
        return 0;
    slope_q30 =
        glint_divide_rounded((uint64_t)radius << 30, (uint64_t)distance) + 1;
    return v3_cosine_q30(axis->toward_q30, surface->face_q30) >
               slope_q30 + SLACK &&
           !glint_scene_can_cone_be_blocked(scene, axis, surface->object,
                                            distance, slope_q30);
}

int32_t glint_trace_shadow_rays(const struct glint_scene *scene,
                                const struct glint_met_surface *surface,
                                const struct glint_lit *lit)
{
    const int32_t radius = lit->light->radius;
    const int n = radius ? scene->cfg.shadow_points : 1;
    struct glint_scene_ray middle = {.at = {0}};
    int32_t u_q30[3] = {0}, v_q30[3] = {0}, level_q15[3], distance;
    int32_t reached_q15 = 0;

    if (!scene->model.header->shadow)
        return GLINT_SCENE_ONE_Q15;
    glint_scene_set_ray_start(scene, surface, middle.at);
    distance = glint_scene_compute_light_at(scene, lit, middle.at,
                                            middle.toward_q30, level_q15);
    if (n > 1) {
        if (is_disc_fully_visible(scene, surface, &middle, distance, radius))
            return GLINT_SCENE_ONE_Q15;
        glint_scene_find_perpendicular_vectors(middle.toward_q30, u_q30, v_q30);
    }
    for (int i = 0; i < n; i++) {
        struct glint_scene_ray to = middle;

        if (n > 1)
            aim_at_disc_point(&to, u_q30, v_q30, distance, radius, i, n);
        if (v3_dot(to.toward_q30, surface->face_q30) > 0)
            reached_q15 += glint_scene_compute_unblocked_light(
                scene, &to, surface->object, surface->triangle, distance);
    }
    return reached_q15 >> (n == 1 ? 0 : n == 4 ? 2 : 4);
}
