/* SPDX-License-Identifier: MIT
 *
 * ward_table PICTURE... - measures the accuracy of Ward's reflection lobe,
 * computed by lookups, against sums over all texels. Prints the PSNR in dB by
 * alpha, lookup rule and number of samples, for sRGB codes and for linear
 * light, as the mean over all pictures; for 8 samples and separated lights also
 * the pictures of the lowest and highest PSNR. The image is a brushed ball 32
 * pixels wide, exposed such that its median is 1/4 of white.
 *
 * The sums are over 512 x 512 texels in double precision. Separated lights are
 * added to the lookups in double precision, as lobes of alpha^2 + r^2 / 8,
 * where r is the angular radius of the light.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "formats/picture.h"
#include "glint/view.h"
#include "support/models/ward_ball.h"

enum { ALPHAS = 5, COLUMNS = 10, WAYS = 2 };

/* column of 8 samples and separated lights */
enum { EIGHT = 7 };

static const double alphas[ALPHAS][2] = {
    {.05, .05}, {.1, .1}, {.2, .2}, {.05, .2}, {.02, .2}};
static const double view[3] = {0, 0, -1};

struct map {
    /* baked maps: [Gaussian levels, mipmap levels][without, with separated
     * lights] */
    unsigned char *data[2][2];
    struct glint_environment environment[2][2];
    struct glint_sphere sphere;
};

static void add_environment_lights(const struct glint_environment *e,
                                   const double alpha[2], ward_picture to)
{
    for (uint32_t k = 0; k < e->header->n_lights; k++) {
        const struct glint_environment_light *l = &e->light[k];
        const double r = asin(ldexp(l->radius_q30, -30));
        const double wide[2] = {sqrt(alpha[0] * alpha[0] + r * r / 8),
                                sqrt(alpha[1] * alpha[1] + r * r / 8)};
        double toward[3], frame[3][3];

        for (int j = 0; j < 3; j++)
            toward[j] = ldexp(l->toward_q30[j], -30);
        for (int i = 0; i < WARD_PIXELS; i++)
            for (int c = 0; c < 3 && ward_build_frame(i, frame); c++)
                to[i][c] +=
                    ward_evaluate_lobe((const double(*)[3])frame, view, wide,
                                       GLINT_WARD_BOUNDED, toward) *
                    GLINT_PI * glint_real_value(l->rgb[c]);
    }
}

static int open_environment_map(struct map *m, const char *path)
{
    struct glint_float_image image = {0};
    struct glint_environment_options o;
    struct glint_environment_report report = {0};
    struct glint_error error = {""};
    const char *reason = "";
    size_t bytes;

    if (glint_picture_load_float(path, &image, &error) != GLINT_OK)
        return 0;
    glint_environment_defaults(&o);
    for (int k = 0; k < 4; k++) {
        o.levels = k / 2 ? GLINT_ENVIRONMENT_MIP : GLINT_ENVIRONMENT_GAUSS;
        o.max_lights = k % 2 ? GLINT_ENVIRONMENT_MAX_LIGHTS : 0;
        if (glint_environment_bake(&image, &o, "x", 0, &m->data[k / 2][k % 2],
                                   &bytes, &report, &error) != GLINT_OK ||
            glint_environment_open(&m->environment[k / 2][k % 2],
                                   m->data[k / 2][k % 2], bytes,
                                   &reason) != GLINT_OK)
            return 0;
    }
    o.turn_deg = 0;
    if (!glint_sphere_allocate(&m->sphere, 512))
        return 0;
    glint_sphere_project_panorama(&m->sphere, &image, &o, &report);
    free(image.rgb);
    return 1;
}

static void compute_psnr(ward_picture want, ward_picture got, double db[WAYS])
{
    db[0] = ward_compute_psnr_of_codes(want, got);
    db[1] = ward_compute_psnr(want, got);
}

/* Finds the mipmap bias at which the published lookup rule has the best PSNR,
 * and sets DB to that PSNR. */
static void find_best_mipmap_bias(const struct glint_environment *e,
                                  const struct glint_ward_material *material,
                                  ward_picture want, ward_picture got,
                                  double db[WAYS])
{
    struct glint_ward_options o = {8, GLINT_WARD_PUBLISHED, 0, 0};

    db[0] = db[1] = 0;
    for (o.bias_q8 = -512; o.bias_q8 <= 256; o.bias_q8 += 128) {
        double here[WAYS];

        ward_render_by_lookups(e, material, &o, got);
        compute_psnr(want, got, here);
        for (int w = 0; w < WAYS; w++)
            db[w] = fmax(db[w], here[w]);
    }
}

static void measure_environment_map(struct map *m, int a,
                                    double db[COLUMNS][WAYS])
{
    static const int samples[5] = {1, 4, 8, 16, 32};
    static ward_picture want, got;
    struct glint_ward_options o = {8, GLINT_WARD_PUBLISHED, 0, 0};
    struct glint_ward_material material = {{32768, 32768, 32768}, {0, 0}, 0};

    for (int k = 0; k < 2; k++)
        material.alpha_q24[k] = (int32_t)lrint(0x1p24 * alphas[a][k]);
    ward_render_by_texel_sums(&m->sphere, alphas[a], want);
    ward_render_by_lookups(&m->environment[1][0], &material, &o, got);
    compute_psnr(want, got, db[0]);
    find_best_mipmap_bias(&m->environment[1][0], &material, want, got, db[1]);
    find_best_mipmap_bias(&m->environment[0][0], &material, want, got, db[2]);
    o.rule = GLINT_WARD_CONSTANT;
    ward_render_by_lookups(&m->environment[1][0], &material, &o, got);
    compute_psnr(want, got, db[3]);
    ward_render_by_lookups(&m->environment[0][0], &material, &o, got);
    compute_psnr(want, got, db[4]);
    for (int k = 0; k < 5; k++) {
        o.samples = samples[k];
        ward_render_by_lookups(&m->environment[0][1], &material, &o, got);
        add_environment_lights(&m->environment[0][1], alphas[a], got);
        compute_psnr(want, got, db[5 + k]);
    }
}

static void print_psnr_table(double sum[ALPHAS][COLUMNS][WAYS],
                             double range[ALPHAS][WAYS][2], int way, int n)
{
    printf("\n%s\n\n", way ? "Linear light:" : "Codes of sRGB:");
    printf("| alpha | published: mip, N 8 | mip, Gauss at its best bias | "
           "constant, N 8: mip, Gauss | and lights: N 1, 4, 8, 16, 32 | "
           "N 8, lowest, highest |\n"
           "|---|---|---|---|---|---|\n");
    for (int a = 0; a < ALPHAS; a++) {
        printf("| %g, %g |", alphas[a][0], alphas[a][1]);
        for (int c = 0; c < COLUMNS; c++)
            printf(" %.1f%s", sum[a][c][way] / n,
                   c == 0 || c == 2 || c == 4 || c >= 9 ? " |" : ",");
        printf(" %.1f, %.1f |\n", range[a][way][0], range[a][way][1]);
    }
}

int main(int argc, char **argv)
{
    static double sum[ALPHAS][COLUMNS][WAYS], range[ALPHAS][WAYS][2];

    for (int i = 1; i < argc; i++) {
        struct map m;

        if (!open_environment_map(&m, argv[i])) {
            fprintf(stderr, "ward_table: %s cannot be baked\n", argv[i]);
            return 1;
        }
        for (int a = 0; a < ALPHAS; a++) {
            double db[COLUMNS][WAYS];

            measure_environment_map(&m, a, db);
            for (int c = 0; c < COLUMNS; c++)
                for (int w = 0; w < WAYS; w++)
                    sum[a][c][w] += db[c][w];
            for (int w = 0; w < WAYS; w++) {
                const double here = db[EIGHT][w];

                range[a][w][0] = i > 1 ? fmin(range[a][w][0], here) : here;
                range[a][w][1] = fmax(range[a][w][1], here);
            }
        }
        for (int k = 0; k < 4; k++)
            free(m.data[k / 2][k % 2]);
        glint_sphere_free(&m.sphere);
    }
    for (int way = 0; way < WAYS; way++)
        print_psnr_table(sum, range, way, argc - 1);
    return 0;
}
