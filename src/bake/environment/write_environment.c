/* SPDX-License-Identifier: MIT
 *
 * Writes a baked environment map: header, mipmap levels, irradiance, lights.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/environment/sphere.h"
#include "bake/table/draft.h"
#include "glint/view.h"

void glint_environment_encode_9e5(const double (*light)[3], size_t n,
                                  double unit, uint32_t *code)
{
    for (size_t i = 0; i < n; i++) {
        const double most =
            fmax(light[i][0], fmax(light[i][1], light[i][2])) / unit;
        int exponent = 0;
        uint32_t word;

        while (exponent < 31 && rint(ldexp(most, 12 - exponent)) > 511)
            exponent++;
        word = (uint32_t)exponent << 27;
        for (int c = 0; c < 3; c++)
            word |= (uint32_t)fmin(
                        rint(ldexp(light[i][c] / unit, 12 - exponent)), 511)
                    << (9 * c);
        code[i] = word;
    }
}

#define UNITS_9E5 (511 * 0x1p19) /* max value that a 9E5 code can store */

struct writer {
    const struct glint_environment_options *options;
    struct glint_environment_report *report;
    struct glint_draft draft;
    struct glint_environment_header header;
    struct glint_sphere sphere;
    struct glint_split_light light[GLINT_ENVIRONMENT_MAX_LIGHTS];
    int n_lights;
    double (*level[GLINT_ENVIRONMENT_MAX_LEVELS])[3];
};

void glint_environment_defaults(struct glint_environment_options *options)
{
    *options = (struct glint_environment_options){
        .side_log2 = 8,
        .levels = GLINT_ENVIRONMENT_GAUSS,
        .max_lights = GLINT_ENVIRONMENT_MAX_LIGHTS,
        .light_deg = 3.4,
        .light_above = 8,
        .scale = 1};
}

static bool are_options_in_range(const struct glint_environment_options *o)
{
    return o->side_log2 >= GLINT_ENVIRONMENT_LEAST_LOG2 &&
           o->side_log2 <= GLINT_ENVIRONMENT_MOST_LOG2 &&
           (unsigned)o->levels <= GLINT_ENVIRONMENT_MIP && o->max_lights >= 0 &&
           o->max_lights <= GLINT_ENVIRONMENT_MAX_LIGHTS &&
           o->light_deg >= .1 && o->light_deg <= 20 && o->light_above >= 2 &&
           o->light_above <= 1000 && fabs(o->turn_deg) <= 360 &&
           o->scale >= 1e-6 && o->scale <= 1e6;
}

static size_t count_level_texels(const struct writer *w, int level)
{
    return (size_t)1 << (2 * glint_environment_side_log2(
                                 (uint32_t)w->options->levels,
                                 (uint32_t)w->options->side_log2,
                                 (uint32_t)level));
}

/* ------------------------------------------------------------------- light */

static void measure_sphere_luminance(const struct glint_sphere *s, double *mean,
                                     double *largest)
{
    double weight = 0, sum = 0;

    *largest = 0;
    for (size_t i = 0; i < (size_t)s->side * (size_t)s->side; i++) {
        const double x = glint_luminance(s->texel[i].light);

        sum += s->texel[i].weight * x;
        weight += s->texel[i].weight;
        *largest = fmax(*largest, x);
    }
    *mean = sum / weight;
}

/* Resamples the picture to twice the side of level 0 and extracts its
 * lights. */
static bool project_picture_to_sphere(struct writer *w,
                                      const struct glint_float_image *picture,
                                      struct glint_error *error)
{
    double unused;

    if (!glint_sphere_allocate(&w->sphere, 2 << w->options->side_log2))
        return false;
    if (!glint_sphere_project_panorama(&w->sphere, picture, w->options,
                                       w->report)) {
        snprintf(error->text, sizeof error->text,
                 "an environment must be twice as wide as high, or 3 x 2 "
                 "faces of a cube, not %dx%d",
                 picture->width, picture->height);
        return false;
    }
    measure_sphere_luminance(&w->sphere, &w->report->mean, &w->report->largest);
    if (w->report->largest > 0 &&
        (w->report->largest < 1e-30 || w->report->largest > 1e30)) {
        snprintf(error->text, sizeof error->text,
                 "the brightest pixel of the environment is %.3g; it must be "
                 "1e-30 to 1e30",
                 w->report->largest);
        return false;
    }
    w->n_lights = glint_sphere_extract_lights(&w->sphere, w->options, w->light,
                                              w->report);
    measure_sphere_luminance(&w->sphere, &unused, &w->report->residual_largest);
    return w->n_lights >= 0;
}

/* Sets mipmap level K to 2 x 2 averages of level K - 1, or of the sphere if K
 * is 0. */
static void average_mipmap_level(struct writer *w, int k)
{
    const int side = 1 << (w->options->side_log2 - k);

    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            for (int c = 0; c < 3; c++) {
                const size_t at =
                    glint_sphere_get_texel_index(2 * side, 2 * x, 2 * y);
                const size_t i[4] = {at, at + 1, at + 2 * (size_t)side,
                                     at + 2 * (size_t)side + 1};
                double sum = 0;

                for (int j = 0; j < 4; j++)
                    sum += k ? w->level[k - 1][i[j]][c]
                             : w->sphere.texel[i[j]].light[c];
                w->level[k][glint_sphere_get_texel_index(side, x, y)][c] =
                    sum / 4;
            }
}

/* Sets level K to the map blurred by a Gaussian; its sigma is 2^(K - 1) texels
 * of level 0. From level 4 on, the map is first reduced to texels of sigma / 8,
 * but not below 32 x 32, which is faster. */
static bool blur_gaussian_level(struct writer *w, int k)
{
    const double texel =
        sqrt(4 * GLINT_PI) / (double)(1 << w->options->side_log2);
    struct glint_sphere coarse;
    const int step = k > 3 ? 1 << (k - 3) : 1;
    int side = w->sphere.side / step;
    bool good;

    if (side < 32)
        side = 32;
    if (side >= w->sphere.side)
        return glint_sphere_blur_light(
            &w->sphere, ldexp(texel, k - 1),
            (int)glint_environment_side_log2(GLINT_ENVIRONMENT_GAUSS,
                                             (uint32_t)w->options->side_log2,
                                             (uint32_t)k),
            w->level[k]);
    good = glint_sphere_downsample(&coarse, side, &w->sphere) &&
           glint_sphere_blur_light(
               &coarse, ldexp(texel, k - 1),
               (int)glint_environment_side_log2(GLINT_ENVIRONMENT_GAUSS,
                                                (uint32_t)w->options->side_log2,
                                                (uint32_t)k),
               w->level[k]);
    glint_sphere_free(&coarse);
    return good;
}

static bool compute_all_levels(struct writer *w)
{
    for (int k = 0; k <= w->options->side_log2; k++) {
        w->level[k] = malloc(count_level_texels(w, k) * sizeof *w->level[k]);
        if (!w->level[k])
            return false;
        if (w->options->levels == GLINT_ENVIRONMENT_MIP)
            average_mipmap_level(w, k);
        else if (!blur_gaussian_level(w, k))
            return false;
    }
    return true;
}

/* ----------------------------------------------------------------- writing */

static double find_max_channel(double (*light)[3], size_t n)
{
    double most = 0;

    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            most = fmax(most, light[i][c]);
    return most;
}

static bool write_mipmap_level(struct writer *w, int k,
                               struct glint_environment_level *level)
{
    const size_t n = count_level_texels(w, k);
    const double unit = ldexp(1, w->header.unit_log2);
    uint32_t *code = malloc(n * sizeof *code);

    if (!code)
        return false;
    glint_environment_encode_9e5((const double(*)[3])w->level[k], n, unit,
                                 code);
    *level = (struct glint_environment_level){
        .side_log2 = glint_environment_side_log2(
            (uint32_t)w->options->levels, (uint32_t)w->options->side_log2,
            (uint32_t)k),
        .texel_at = glint_draft_append(&w->draft, code, n * sizeof *code)};
    free(code);
    return true;
}

static bool write_irradiance_map(struct writer *w)
{
    enum { N = 1 << (2 * GLINT_ENVIRONMENT_IRRADIANCE_LOG2) };
    double(*light)[3] = malloc(N * sizeof *light);
    uint32_t *code = malloc(N * sizeof *code);
    struct glint_sphere coarse = {.texel = NULL};
    const bool good =
        light && code &&
        glint_sphere_downsample(
            &coarse, w->sphere.side < 128 ? w->sphere.side : 128, &w->sphere);

    if (good) {
        glint_sphere_compute_irradiance(
            &coarse, GLINT_ENVIRONMENT_IRRADIANCE_LOG2, light);
        glint_environment_encode_9e5((const double(*)[3])light, N,
                                     ldexp(1, w->header.unit_log2), code);
        w->header.irradiance_at =
            glint_draft_append(&w->draft, code, N * sizeof *code);
    }
    glint_sphere_free(&coarse);
    free(light);
    free(code);
    return good;
}

static void write_environment_lights(struct writer *w)
{
    w->header.n_lights = (uint32_t)w->n_lights;
    w->header.light_at = (uint32_t)w->draft.bytes;
    for (int i = 0; i < w->n_lights; i++) {
        const struct glint_split_light *from = &w->light[i];
        struct glint_environment_light l = {
            .radius_q30 = (int32_t)lrint(0x1p30 * sin(from->radius))};

        for (int k = 0; k < 3; k++) {
            l.toward_q30[k] = (int32_t)lrint(0x1p30 * from->toward[k]);
            l.rgb[k] = glint_real_of(from->irradiance[k] / GLINT_PI);
        }
        glint_draft_append(&w->draft, &l, sizeof l);
    }
}

static bool write_environment_tables(struct writer *w)
{
    struct glint_environment_level level[GLINT_ENVIRONMENT_MAX_LEVELS];
    const int n = w->options->side_log2 + 1;
    double most = 0;

    for (int k = 0; k < n; k++)
        most =
            fmax(most, find_max_channel(w->level[k], count_level_texels(w, k)));
    /* A 9E5 code stores at most 2^28 - 2^19 units. The unit is the smallest
     * power of two for which the brightest texel does not exceed that. */
    w->header.unit_log2 = most > 0 ? (int)floor(log2(most / UNITS_9E5)) + 1 : 0;
    for (int k = 0; k < n; k++)
        if (!write_mipmap_level(w, k, &level[k]))
            return false;
    w->header.n_levels = (uint32_t)n;
    w->header.level_at =
        glint_draft_append(&w->draft, level, (size_t)n * sizeof *level);
    if (!write_irradiance_map(w))
        return false;
    write_environment_lights(w);
    return true;
}

static void set_environment_header(struct writer *w, const char *name,
                                   uint64_t key)
{
    static const struct glint_blob_kind kind = {
        .magic = GLINT_ENVIRONMENT_MAGIC, .version = GLINT_ENVIRONMENT_VERSION};
    struct glint_environment_header *h = &w->header;

    glint_draft_begin_header(h, &kind, (uint32_t)w->options->levels, key, name,
                             "environment");
    h->side_log2 = (uint32_t)w->options->side_log2;
    h->code = GLINT_ENVIRONMENT_9E5;
}

enum glint_status
glint_environment_bake(const struct glint_float_image *picture,
                       const struct glint_environment_options *options,
                       const char *name, uint64_t key, unsigned char **data,
                       size_t *bytes, struct glint_environment_report *report,
                       struct glint_error *error)
{
    struct writer w = {.options = options, .report = report};
    bool good;

    *report = (struct glint_environment_report){0};
    error->text[0] = '\0';
    if (!are_options_in_range(options))
        return GLINT_E_ARGUMENT;
    glint_draft_append(&w.draft, NULL, sizeof w.header);
    good = project_picture_to_sphere(&w, picture, error) &&
           compute_all_levels(&w) && write_environment_tables(&w);
    set_environment_header(&w, name, key);
    for (int k = 0; k < GLINT_ENVIRONMENT_MAX_LEVELS; k++)
        free(w.level[k]);
    glint_sphere_free(&w.sphere);
    if (glint_draft_finish_file(&w.draft, &w.header, sizeof w.header, good,
                                data, bytes))
        return GLINT_OK;
    return error->text[0] ? GLINT_E_UNSUPPORTED : GLINT_E_MEMORY;
}
