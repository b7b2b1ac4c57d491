/* SPDX-License-Identifier: MIT
 *
 * Reads, bakes and prints environment maps.
 */
#include "scenes/environment_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "model/bake_line.h"
#include "posix/ending.h"
#include "posix/input.h"
#include "model/names.h"

#define MAX_FILE_BYTES ((size_t)1 << 28)

static bool has_environment_extension(const char *name)
{
    return glint_has_extension(name, ".environment");
}

bool environment_file_is_source(const char *argument)
{
    return has_environment_extension(argument) ||
           glint_has_extension(argument, ".exr") ||
           glint_has_extension(argument, ".hdr") ||
           glint_has_extension(argument, ".pfm") ||
           glint_has_extension(argument, ".dds");
}

bool environment_file_is_baked(const char *argument)
{
    return tool_has_magic(argument, GLINT_ENVIRONMENT_MAGIC);
}

static enum glint_status read_environment_text(
    const char *path, struct glint_environment_options *options,
    char source[GLINT_ENVIRONMENT_FILE_BYTES], struct glint_error *error)
{
    uint8_t *text = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_read_whole_file(&text, &bytes, path, 1 << 16, error);

    if (status == GLINT_OK)
        status = glint_environment_parse(options, source, (const char *)text,
                                         bytes, path, error);
    free(text);
    return status;
}

/* Bakes the picture FROM as an environment that is called like the file NAMED,
 * without folder and extension. */
static enum glint_status
bake_picture(const char *named, const char *from,
             const struct glint_environment_options *options,
             struct environment_file *file, struct glint_error *error)
{
    struct glint_float_image picture = {0};
    unsigned char *data = NULL;
    uint64_t key = TOOL_KEY_BEGIN;
    char name[64];
    enum glint_status status = glint_picture_load_float(from, &picture, error);

    if (status == GLINT_OK) {
        tool_copy_base_name(named, name);
        tool_hash_into_key(&key, options, sizeof *options);
        tool_hash_into_key(&key, picture.rgb,
                           3 * sizeof(float) * (size_t)picture.width *
                               (size_t)picture.height);
        status = glint_environment_bake(&picture, options, name, key, &data,
                                        &file->bytes, &file->report, error);
        if (status == GLINT_E_UNSUPPORTED) {
            const struct glint_error cause = *error;

            snprintf(error->text, sizeof error->text, "%.120s: %.120s", from,
                     cause.text);
        }
    }
    free(picture.rgb);
    file->data = data;
    file->is_baked_now = true;
    return status;
}

static enum glint_status
bake_source(const char *path, const char *written,
            void (*override)(void *ctx, struct glint_environment_options *),
            void *ctx, int64_t *left, struct environment_file *file,
            struct glint_error *error)
{
    struct glint_environment_options options;
    char source[GLINT_ENVIRONMENT_FILE_BYTES], beside[TOOL_PATH_BYTES];
    const char *picture = path;
    enum glint_status status = GLINT_OK;

    /* The key is a hash of all bytes of the options, so padding must be 0. */
    memset(&options, 0, sizeof options);
    glint_environment_defaults(&options);
    if (has_environment_extension(path)) {
        status = read_environment_text(path, &options, source, error);
        if (status == GLINT_OK)
            status = tool_make_input_path(path, source, written, beside, error);
        picture = beside;
    }
    if (override)
        override(ctx, &options);
    if (status == GLINT_OK)
        status = tool_count_bake_work(left, INT64_C(1) << 3 * options.side_log2,
                                      path, error);
    if (status != GLINT_OK)
        return status;
    status = bake_picture(path, picture, &options, file, error);
    if (status != GLINT_OK && picture == beside)
        tool_add_place_of_name(path, "source", source, error);
    return status;
}

enum glint_status environment_file_read(
    const char *path, const char *written,
    void (*override)(void *ctx, struct glint_environment_options *), void *ctx,
    int64_t *left, struct environment_file *file, struct glint_error *error)
{
    char self[TOOL_PATH_BYTES];
    const char *reason = "";
    uint8_t *data = NULL;
    enum glint_status status;

    *file = (struct environment_file){.data = NULL};
    status = tool_make_input_path("", path, written, self, error);
    if (status == GLINT_OK && environment_file_is_source(path)) {
        status = bake_source(path, written, override, ctx, left, file, error);
    } else if (status == GLINT_OK) {
        status = glint_input_read_whole_file(&data, &file->bytes, path,
                                             MAX_FILE_BYTES, error);
        /* malloc() has aligned the data, as baked environments require */
        file->data = data;
    }
    if (status != GLINT_OK ||
        glint_environment_open(&file->environment, file->data, file->bytes,
                               &reason) == GLINT_OK)
        return status;
    snprintf(error->text, sizeof error->text, "%.180s: %.70s", path, reason);
    environment_file_close(file);
    return GLINT_E_LENS;
}

int environment_file_open(const struct tool *tool, const char *path,
                          void (*override)(void *ctx,
                                           struct glint_environment_options *),
                          void *ctx, struct environment_file *file)
{
    struct glint_error error = {""};
    enum glint_status status;
    const int code = tool_check_scene_not_overwritten(tool, path);

    if (code != EXIT_OK)
        return code;
    status = environment_file_read(path, tool->written, override, ctx, NULL,
                                   file, &error);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void environment_file_close(struct environment_file *file)
{
    free(file->data);
    *file = (struct environment_file){.data = NULL};
}

struct counts {
    /* number of texels: of all stored levels; of a mipmap, whose levels have
     * half the side each; of as many levels with the size of the first */
    long long texels, mips, full;
    size_t levels, irradiance, lights, header; /* bytes of each section */
};

static struct counts
count_environment_contents(const struct environment_file *file)
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

static double convert_q30_to_degrees(int32_t sine_q30)
{
    return 180 / GLINT_PI * asin(ldexp(sine_q30, -30));
}

static void print_environment_json(const struct environment_file *file,
                                   const struct counts *n)
{
    const struct glint_environment_header *h = file->environment.header;
    const struct glint_environment_report *r = &file->report;
    struct json_writer json = {.to = stdout};

    json_write(&json, "{name: %s, environment: {size: %d", h->name,
               1 << h->side_log2);
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
                   ldexp(l->toward_q30[2], -30),
                   convert_q30_to_degrees(l->radius_q30),
                   glint_real_value(l->rgb[0]), glint_real_value(l->rgb[1]),
                   glint_real_value(l->rgb[2]));
    }
    json_write(&json,
               "], bytes: {header: %zu, levels: %zu, irradiance: %zu, "
               "lights: %zu, all: %zu}}}\n",
               n->header, n->levels, n->irradiance, n->lights, file->bytes);
}

static void print_bake_statistics(const struct glint_environment_report *r)
{
    printf("picture      %dx%d", r->width, r->height);
    if (r->negative || r->not_finite)
        printf("; clamped: %lld pixels below 0, %lld not finite", r->negative,
               r->not_finite);
    printf("\nluminance    mean %.4g, max %.4g, max without the lights %.4g\n",
           r->mean, r->largest, r->residual_largest);
    printf("in lights    %.3g %% of all light", 100 * r->light_share);
    if (r->spots > 0)
        printf(", %d lights found", r->spots);
    printf("\n");
}

static void print_environment_text(const struct environment_file *file,
                                   const struct counts *n)
{
    const struct glint_environment_header *h = file->environment.header;

    printf("%s, an environment %d wide\n\n", h->name, 1 << h->side_log2);
    if (file->is_baked_now)
        print_bake_statistics(&file->report);
    printf("levels       %u:", h->n_levels);
    for (uint32_t k = 0; k < h->n_levels; k++)
        printf(" %d", 1 << file->environment.level[k].side_log2);
    printf(
        "\n"
        "texels       %lld; a mipmap would have %lld, all levels at full size "
        "%lld\n",
        n->texels, n->mips, n->full);
    printf("lights       %u\n", h->n_lights);
    for (uint32_t i = 0; i < h->n_lights; i++) {
        const struct glint_environment_light *l = &file->environment.light[i];

        printf("  toward %7.4f %7.4f %7.4f  radius %5.2f  a white surface "
               "facing it gets %.4g "
               "%.4g %.4g\n",
               ldexp(l->toward_q30[0], -30), ldexp(l->toward_q30[1], -30),
               ldexp(l->toward_q30[2], -30),
               convert_q30_to_degrees(l->radius_q30),
               glint_real_value(l->rgb[0]), glint_real_value(l->rgb[1]),
               glint_real_value(l->rgb[2]));
    }
    printf("bytes        %zu\n  header       %8zu\n  levels       %8zu\n"
           "  irradiance   %8zu\n",
           file->bytes, n->header, n->levels, n->irradiance);
    if (n->lights)
        printf("  lights       %8zu\n", n->lights);
}

void environment_file_print_contents(const struct tool *tool,
                                     const struct environment_file *file)
{
    struct counts n;

    if (!file->environment.header)
        return;
    n = count_environment_contents(file);
    (tool->json ? print_environment_json : print_environment_text)(file, &n);
}

static const char bake_help[] =
    "glint bake PICTURE|NAME.environment -o OUT.env [options]\n"
    "\n"
    "Converts a panorama to one file for scenes: the light blurred to several\n"
    "levels, the irradiance, and the brightest spots as lights. PICTURE is "
    ".exr,\n"
    ".hdr, .dds (with the image plug-in) or .pfm, twice as wide as high, or\n"
    "3 x 2 faces of a cube. Negative and non-finite pixels are clamped and "
    "counted.\n"
    "A text file NAME.environment (tools/examples/scenes/README.md) names the\n"
    "picture, turns and scales its light, and has the same options, which "
    "those "
    "of\n"
    "the command line override.\n"
    "\n"
    "  -o, --output OUT\n"
    "  --size N            texels along a side: 16 to 1024, a power of two\n"
    "                      (default 256)\n"
    "  --lights N          number of lights, 0 to 16 (default 16)\n";

/* Values of the command line; -1: not given */
struct line {
    int side_log2, lights;
};

static void override_text_options(void *ctx,
                                  struct glint_environment_options *o)
{
    const struct line *l = ctx;

    if (l->side_log2 >= 0)
        o->side_log2 = l->side_log2;
    if (l->lights >= 0)
        o->max_lights = l->lights;
}

static int parse_environment_option(struct tool *tool, void *line, int c,
                                    const char *name)
{
    static const char *const sizes[] = {"16",  "32",  "64",   "128",
                                        "256", "512", "1024", NULL};
    struct line *l = line;
    bool ok = true;

    switch (c) {
    case 's':
        l->side_log2 = tool_find_word_index(optarg, sizes);
        ok = l->side_log2 >= 0;
        l->side_log2 += GLINT_ENVIRONMENT_LEAST_LOG2;
        break;
    case 'n':
        ok = tool_parse_integer(optarg, 0, GLINT_ENVIRONMENT_MAX_LIGHTS,
                                &l->lights);
        break;
    default:
        return tool_apply_option(tool, c, optarg);
    }
    return ok ? -1 : tool_report_bad_value(tool, name, optarg);
}

int cmd_bake_environment(struct tool *tool, int argc, char **argv)
{
    static const struct option options[] = {
        BAKE_LINE_OPTIONS,
        {"size", required_argument, NULL, 's'},
        {"lights", required_argument, NULL, 'n'},
        TOOL_COMMON_OPTIONS};
    struct line line = {.side_log2 = -1, .lights = -1};
    struct environment_file file;
    int code;

    code = bake_line_parse(tool, bake_help, argc, argv, options,
                           parse_environment_option, &line,
                           "expects one environment");
    if (code >= 0)
        return code;
    code = environment_file_open(tool, argv[optind], override_text_options,
                                 &line, &file);
    if (code != EXIT_OK)
        return code;
    code = tool_save_file(tool, tool->written, GLINT_OUTPUT_BINARY, file.data,
                          file.bytes);
    if (code == EXIT_OK && bake_line_prints_report(tool))
        environment_file_print_contents(tool, &file);
    environment_file_close(&file);
    return code;
}
