/* SPDX-License-Identifier: MIT
 *
 * What is in a baked environment, in words and in numbers. */
#include <math.h>

#include "glint/view.h"
#include "options/json_writer.h"
#include "scenes/environment_file.h"

struct counts {
    long long texels, mips, full; /* these; of mips; of all levels as fine as
                                     the first */
    size_t levels, irradiance, lights, header; /* bytes */
};

static struct counts count(const struct environment_file *file)
{
    const struct glint_environment_header *h = file->environment.header;
    const long long first = 1LL << (2 * h->side_log2);
    struct counts n = {.mips = (4 * first - 1) / 3,
                       .full = (long long)h->n_levels * first,
                       .irradiance = 4096,
                       .header = sizeof *h};

    for (uint32_t k = 0; k < h->n_levels; k++) {
        const long long texels = 1LL
                                 << (2 * file->environment.level[k].side_log2);

        n.texels += texels;
        n.levels += 4 * (size_t)texels;
    }
    n.levels += h->n_levels * sizeof *file->environment.level;
    n.lights = h->n_lights * sizeof *file->environment.light;
    return n;
}

static double degrees(int32_t sine_q30)
{
    return 180 / GLINT_PI * asin(ldexp(sine_q30, -30));
}

static const char *levels_of(const struct glint_environment_header *h)
{
    return h->variant == GLINT_ENVIRONMENT_MIP ? "mip" : "gauss";
}

static void print_json(const struct environment_file *file,
                       const struct counts *n)
{
    const struct glint_environment_header *h = file->environment.header;
    const struct glint_environment_report *r = &file->report;
    struct json_writer json = {.to = stdout};

    json_write(&json, "{name: %s, environment: {size: %d, levels: %s", h->name,
               1 << h->side_log2, levels_of(h));
    if (file->is_baked_now)
        json_write(&json,
                   "picture: [%d, %d], negative: %lld, not_finite: %lld, "
                   "mean: %.6g, largest: %.6g, rest_largest: %.6g, "
                   "light_share: %.6g, spots: %d",
                   r->width, r->height, r->negative, r->not_finite, r->mean,
                   r->largest, r->residual_largest, r->light_share, r->spots);
    json_write(&json,
               "texels: %lld, texels_mip: %lld, texels_full: %lld, lights: [",
               n->texels, n->mips, n->full);
    for (uint32_t i = 0; i < h->n_lights; i++) {
        const struct glint_environment_light *l = &file->environment.light[i];

        json_write(&json,
                   "{toward: [%.6f, %.6f, %.6f], radius_deg: %.4f, "
                   "rgb: [%.6g, %.6g, %.6g]}",
                   ldexp(l->toward_q30[0], -30), ldexp(l->toward_q30[1], -30),
                   ldexp(l->toward_q30[2], -30), degrees(l->radius_q30),
                   glint_real_value(l->rgb[0]), glint_real_value(l->rgb[1]),
                   glint_real_value(l->rgb[2]));
    }
    json_write(&json,
               "], bytes: {header: %zu, levels: %zu, irradiance: %zu, "
               "lights: %zu, all: %zu}}}\n",
               n->header, n->levels, n->irradiance, n->lights, file->bytes);
}

static void print_baking(const struct glint_environment_report *r)
{
    printf("picture      %dx%d", r->width, r->height);
    if (r->negative || r->not_finite)
        printf("; held: %lld pixels below 0, %lld not finite", r->negative,
               r->not_finite);
    printf("\nlight        mean %.4g, largest %.4g, without the lights %.4g\n",
           r->mean, r->largest, r->residual_largest);
    printf("lights have  %.3g %% of it", 100 * r->light_share);
    if (r->spots > 0)
        printf(", of %d spots", r->spots);
    printf("\n");
}

static void print_text(const struct environment_file *file,
                       const struct counts *n)
{
    const struct glint_environment_header *h = file->environment.header;

    printf("%s, an environment %d wide, levels %s\n\n", h->name,
           1 << h->side_log2, levels_of(h));
    if (file->is_baked_now)
        print_baking(&file->report);
    printf("levels       %u:", h->n_levels);
    for (uint32_t k = 0; k < h->n_levels; k++)
        printf(" %d", 1 << file->environment.level[k].side_log2);
    printf("\ntexels       %lld; of mips %lld, of levels all as fine as the "
           "first %lld\n",
           n->texels, n->mips, n->full);
    printf("lights       %u\n", h->n_lights);
    for (uint32_t i = 0; i < h->n_lights; i++) {
        const struct glint_environment_light *l = &file->environment.light[i];

        printf("  toward %7.4f %7.4f %7.4f  radius %5.2f  white in it %.4g "
               "%.4g %.4g\n",
               ldexp(l->toward_q30[0], -30), ldexp(l->toward_q30[1], -30),
               ldexp(l->toward_q30[2], -30), degrees(l->radius_q30),
               glint_real_value(l->rgb[0]), glint_real_value(l->rgb[1]),
               glint_real_value(l->rgb[2]));
    }
    printf("bytes        %zu\n  header       %8zu\n  levels       %8zu\n"
           "  irradiance   %8zu\n",
           file->bytes, n->header, n->levels, n->irradiance);
    if (n->lights)
        printf("  lights       %8zu\n", n->lights);
}

void environment_file_print(const struct tool *tool,
                            const struct environment_file *file)
{
    const struct counts n = count(file);

    (tool->json ? print_json : print_text)(file, &n);
}
