/* SPDX-License-Identifier: MIT */
#include "stones/stone_file.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "formats/picture.h"
#include "model/cache_file.h"
#include "posix/ending.h"
#include "posix/input.h"
#include "model/names.h"

#define MAX_FILE_BYTES ((size_t)1 << 26)
/* version of the bake, part of the key of cached media; must be increased if
 * the same text is baked to another result */
#define RECIPE UINT64_C(2)

bool stone_file_is_text(const char *argument)
{
    return glint_has_extension(argument, ".translucent");
}

bool stone_file_is_baked(const char *argument)
{
    return tool_has_magic(argument, GLINT_TRANSLUCENT_MAGIC);
}

/* Reader state of a text and the files that it names */
struct source {
    struct glint_stone_text text;
    double *mask; /* coverage of each texel by the medium, owned */
    /* measured rows (the response of each texel), read from a picture; owned */
    struct glint_float_image rows;
    /* number of negative or non-finite values in the rows, set to 0 */
    long long held;
    uint64_t key;
};

static void close_medium_source(struct source *s)
{
    free(s->mask);
    free(s->rows.rgb);
}

/* ------------------------------------------------------------------ reading */

/* Sets MASK[SIDE][SIDE] to the mean code of IMAGE over each texel, 1 =
 * white. */
static void reduce_mask_to_texels(const struct glint_image *image, int side,
                                  double *mask)
{
    for (int i = 0; i < side * side; i++) {
        const int x0 = i % side * image->width / side;
        const int y0 = i / side * image->height / side;
        int x1 = (i % side + 1) * image->width / side;
        int y1 = (i / side + 1) * image->height / side;
        double sum = 0;

        x1 = x1 > x0 ? x1 : x0 + 1;
        y1 = y1 > y0 ? y1 : y0 + 1;
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++)
                for (int c = 0; c < 3; c++)
                    sum +=
                        image->plane[0][3 * ((ptrdiff_t)y * image->width + x) +
                                        c] /
                        765.;
        mask[i] = sum / ((x1 - x0) * (y1 - y0));
    }
}

static enum glint_status read_medium_mask(const struct tool *tool,
                                          const char *path, struct source *s,
                                          struct glint_error *error)
{
    const int side = s->text.stone.side;
    const size_t n = (size_t)side * (size_t)side;
    char beside[TOOL_PATH_BYTES];
    struct glint_image image = {.width = 0};
    double *mask;
    enum glint_status status =
        tool_make_input_path(path, s->text.mask, tool->written, beside, error);

    if (status == GLINT_OK)
        status = glint_picture_load(beside, &image, error);
    if (status != GLINT_OK) {
        tool_add_place_of_name(path, "pattern", s->text.mask, error);
        return status;
    }
    mask = malloc(n * sizeof *mask);
    if (mask) {
        reduce_mask_to_texels(&image, side, mask);
        tool_hash_into_key(&s->key, mask, n * sizeof *mask);
    }
    free(image.plane[0]);
    s->mask = mask;
    return mask ? GLINT_OK : GLINT_E_MEMORY;
}

static enum glint_status read_measured_rows(const struct tool *tool,
                                            const char *path, struct source *s,
                                            struct glint_error *error)
{
    char beside[TOOL_PATH_BYTES];
    enum glint_status status =
        tool_make_input_path(path, s->text.rows, tool->written, beside, error);

    if (status == GLINT_OK)
        status = glint_picture_load_float(beside, &s->rows, error);
    if (status == GLINT_OK)
        tool_hash_into_key(&s->key, s->rows.rgb,
                           3 * sizeof(float) * (size_t)s->rows.width *
                               (size_t)s->rows.height);
    else
        tool_add_place_of_name(path, "data", s->text.rows, error);
    return status;
}

static enum glint_status
read_source(const struct tool *tool, const char *path,
            void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
            struct source *s, struct glint_error *error)
{
    const uint64_t recipe = RECIPE;
    uint8_t *data = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_read_whole_file(&data, &bytes, path, 1 << 16, error);

    if (status == GLINT_OK)
        status =
            glint_stone_parse(&s->text, (const char *)data, bytes, path, error);
    free(data);
    if (status != GLINT_OK)
        return status;
    if (over)
        over(ctx, &s->text);
    s->key = TOOL_KEY_BEGIN;
    tool_hash_into_key(&s->key, &recipe, sizeof recipe);
    tool_hash_into_key(&s->key, &s->text, sizeof s->text);
    if (s->text.mask[0])
        status = read_medium_mask(tool, path, s, error);
    if (status == GLINT_OK && s->text.rows[0])
        status = read_measured_rows(tool, path, s, error);
    return status;
}

/* ------------------------------------------------------------------- baking */

/* Sets *DB to the PSNR of the light that leaves the medium STONE, compared with
 * the light by ROWS, the responses of all texels. The test light has lamps,
 * shadows and a ramp. Returns GLINT_E_MEMORY on failure. */
static enum glint_status measure_fit_psnr(const struct glint_scatter_rows *rows,
                                          const struct glint_translucent *stone,
                                          double *db)
{
    const size_t n = 3 * (size_t)rows->side * (size_t)rows->side;
    double *light = malloc(3 * n * sizeof *light);
    double square = 0, peak = 0;
    enum glint_status status = GLINT_E_MEMORY;

    if (light) {
        glint_scatter_test_light(rows->side, light);
        glint_scatter_light_rows(rows, light, light + n);
        status = glint_stone_light(stone, light, light + 2 * n);
    }
    for (size_t i = n; status == GLINT_OK && i < 2 * n; i++) {
        square += (light[i] - light[i + n]) * (light[i] - light[i + n]);
        peak = fmax(peak, light[i]);
    }
    free(light);
    *db = square > 0 ? 10 * log10(peak * peak * (double)n / square) : 999;
    return status;
}

static enum glint_status open_baked_medium(struct stone_file *file,
                                           struct glint_error *error)
{
    const char *reason = "";

    if (glint_translucent_open(&file->stone, file->data, file->bytes,
                               &reason) == GLINT_OK)
        return GLINT_OK;
    snprintf(error->text, sizeof error->text, "%s", reason);
    return GLINT_E_LENS;
}

static enum glint_status fit_scatter_rows(struct glint_scatter_rows *rows,
                                          struct source *s, const char *name,
                                          const struct glint_watch *watch,
                                          struct stone_file *file,
                                          struct glint_error *error)
{
    struct glint_scatter_fit fit;
    struct glint_stone_report report;
    unsigned char *data = NULL;
    enum glint_status status =
        glint_scatter_fit(rows, &s->text.fit, watch, &fit);

    if (status != GLINT_OK)
        return status;
    status = glint_stone_bake(&fit, &s->text, name, s->key, &data, &file->bytes,
                              &report, error);
    if (status == GLINT_OK) {
        file->data = data;
        file->errors.kernel_loss = report.kernel_loss;
        file->errors.tap_bits = report.tap_bits;
        status = open_baked_medium(file, error);
    }
    file->errors.fit_db = fit.error.light_db;
    if (status == GLINT_OK)
        status = measure_fit_psnr(rows, &file->stone, &file->errors.baked_db);
    glint_scatter_fit_close(&fit);
    return status;
}

/* Sets ROWS to the measured rows of the medium in S. If S has no measured rows,
 * computes ROWS by simulation. */
static enum glint_status compute_scatter_rows(struct source *s,
                                              const struct glint_watch *watch,
                                              struct glint_scatter_rows *rows,
                                              struct glint_error *error)
{
    const struct glint_stone *stone = &s->text.stone;

    s->text.stone.mask = s->mask;
    return s->rows.rgb
               ? glint_scatter_read(&s->rows, stone->side, stone->kernel, rows,
                                    &s->held, error)
               : glint_scatter_compute(stone, watch, rows, error);
}

static enum glint_status bake_medium_source(const struct tool *tool,
                                            struct source *s, const char *name,
                                            struct stone_file *file,
                                            struct glint_error *error)
{
    struct tool_progress progress;
    const struct glint_watch watch = {.progress = tool_progress_show,
                                      .ctx = &progress};
    struct glint_scatter_rows rows = {.side = 0};
    const clock_t began = clock();
    /* Fraction of the bake time before the fit, as measured: small if the rows
     * are read from a picture, large if they are simulated. */
    const double before = s->rows.rgb ? .05 : .8;
    enum glint_status status;

    tool_progress_start(&progress, tool, name);
    tool_progress_set_part(&progress, 0, before);
    status = compute_scatter_rows(s, &watch, &rows, error);
    if (status == GLINT_OK) {
        tool_progress_set_part(&progress, before, 1 - before);
        status = fit_scatter_rows(&rows, s, name, &watch, file, error);
        glint_scatter_close(&rows);
    }
    tool_progress_end(&progress);
    if (s->held > 0 && !tool->quiet)
        fprintf(stderr,
                "glint %s: %s: %lld numbers that are negative or not finite "
                "were set to 0\n",
                tool->name, name, s->held);
    file->is_baked_now = true;
    file->errors.seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    return status;
}

/* -------------------------------------------------------------------- cache */

/* Opens the cached translucent medium. Returns false if there is none. */
static bool load_cached_medium(const char *path, uint64_t key,
                               struct stone_file *file)
{
    struct glint_error error;

    file->data = cache_file_read(path, MAX_FILE_BYTES, &file->bytes);
    if (!file->data)
        return false;
    if (open_baked_medium(file, &error) == GLINT_OK &&
        (file->stone.header->key[0] | (uint64_t)file->stone.header->key[1]
                                          << 32) == key)
        return true;
    stone_file_close(file);
    return false;
}

static void write_cached_medium(const struct tool *tool, char *path,
                                const struct stone_file *file)
{
    struct glint_error error = {""};

    if (cache_file_write(path, file->data, file->bytes, &error) != GLINT_OK &&
        !tool->quiet)
        fprintf(stderr, "glint %s: the baked medium cannot be cached: %s\n",
                tool->name, error.text);
}

/* Returns the number of values per channel that all rows of the medium STONE
 * have. */
static int64_t count_row_values(const struct glint_stone *stone)
{
    const int64_t side = stone->side, kernel = stone->kernel;

    return side * side * kernel * kernel;
}

static enum glint_status
read_text(const struct tool *tool, const char *path,
          void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
          bool rebake, int64_t *left, struct stone_file *file,
          struct glint_error *error)
{
    struct source source = {.mask = NULL};
    char kept[CACHE_PATH_BYTES], name[64];
    enum glint_status status =
        read_source(tool, path, over, ctx, &source, error);
    bool has_cache;

    tool_copy_base_name(path, name);
    has_cache =
        cache_file_find_folder(kept, sizeof kept) &&
        cache_file_append_name(kept, sizeof kept, name, source.key, "stone");
    if (status == GLINT_OK &&
        (rebake || !has_cache || !load_cached_medium(kept, source.key, file))) {
        status = tool_count_bake_work(
            left, 8 * count_row_values(&source.text.stone), path, error);
        if (status == GLINT_OK)
            status = bake_medium_source(tool, &source, name, file, error);
        if (status == GLINT_OK && has_cache)
            write_cached_medium(tool, kept, file);
    }
    close_medium_source(&source);
    return status;
}

enum glint_status
stone_file_read(const struct tool *tool, const char *path,
                void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
                bool rebake, int64_t *left, struct stone_file *file,
                struct glint_error *error)
{
    uint8_t *data = NULL;
    enum glint_status status;
    char self[TOOL_PATH_BYTES];

    *file = (struct stone_file){.data = NULL};
    status = tool_make_input_path("", path, tool->written, self, error);
    if (status == GLINT_OK && stone_file_is_text(path)) {
        status = read_text(tool, path, over, ctx, rebake, left, file, error);
    } else if (status == GLINT_OK) {
        status = glint_input_read_whole_file(&data, &file->bytes, path,
                                             MAX_FILE_BYTES, error);
        /* malloc() has aligned the data, as baked media require */
        file->data = data;
        if (status == GLINT_OK) {
            struct glint_error cause;

            status = open_baked_medium(file, &cause);
            if (status != GLINT_OK)
                snprintf(error->text, sizeof error->text, "%.150s: %.100s",
                         path, cause.text);
        }
    }
    if (status != GLINT_OK)
        stone_file_close(file);
    return status;
}

void stone_file_close(struct stone_file *file)
{
    free(file->data);
    *file = (struct stone_file){.data = NULL};
}
