/* SPDX-License-Identifier: MIT
 *
 * stone_rows DIR - bakes two translucent media, chess and veins, with all
 * scattering models that the run time can draw, for
 * tools/measure/scenes/stone-table. Media have 128 x 128 texels, kernels 29 x
 * 29.
 *
 * Prints a line for each medium and model: their names, the PSNR of the fit in
 * dB, that of the fit rounded to integers, and the CPU seconds of the fit.
 * PSNRs compare with light scattered by the exact rows. Writes the models of
 * the first medium to DIR/MODEL.glint.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "glint/scene/stone_bake.h"
#include "support/models/psnr.h"

enum { STONES = 2, MODELS = 10 };

static const char *const stone_name[STONES] = {"chess", "veins"};

static const struct {
    const char *name;
    enum glint_scatter_model model;
    int kernels, rank;
} model_of[MODELS] = {
    {"albedo-2", GLINT_SCATTER_ALBEDO, 1, 2},
    {"albedo-3", GLINT_SCATTER_ALBEDO, 1, 3},
    {"clustered-2-3", GLINT_SCATTER_CLUSTERED, 2, 3},
    {"clustered-4-1", GLINT_SCATTER_CLUSTERED, 4, 1},
    {"clustered-4-2", GLINT_SCATTER_CLUSTERED, 4, 2},
    {"clustered-4-3", GLINT_SCATTER_CLUSTERED, 4, 3},
    {"factored-3-3", GLINT_SCATTER_FACTORED, 3, 3},
    {"factored-5-2", GLINT_SCATTER_FACTORED, 5, 2},
    {"factored-5-3", GLINT_SCATTER_FACTORED, 5, 3},
    {"factored-10-3", GLINT_SCATTER_FACTORED, 10, 3},
};

static void exit_with_error(const char *what)
{
    fprintf(stderr, "stone_rows: %s\n", what);
    exit(1);
}

static void write_medium_model(const char *dir, const char *name,
                               const void *data, size_t bytes)
{
    char path[1024];
    FILE *file;

    snprintf(path, sizeof path, "%s/%s.glint", dir, name);
    file = fopen(path, "wb");
    if (!file || fwrite(data, 1, bytes, file) != bytes || fclose(file))
        exit_with_error(path);
}

/* Bakes a fit and sets DB to the PSNR of its integers. If DIR is not NULL,
 * writes the baked model to DIR. LIGHT: three arrays of [3][n]: incident light,
 * light scattered by the exact rows, and scratch. */
static void bake_and_measure_fit(const struct glint_scatter_fit *fit,
                                 const double *const light, double *room,
                                 const char *dir, const char *name, double *db)
{
    const size_t n = 3 * (size_t)(fit->side * fit->side);
    struct glint_stone_report report;
    struct glint_translucent stone;
    struct glint_stone_text text;
    struct glint_error error;
    unsigned char *data;
    const char *reason;
    size_t bytes;

    glint_stone_text_defaults(&text);
    text.fit.rank = fit->rank;
    if (glint_stone_bake(fit, &text, name, 0, &data, &bytes, &report, &error) !=
        GLINT_OK)
        exit_with_error(error.text);
    if (glint_translucent_open(&stone, data, bytes, &reason) != GLINT_OK)
        exit_with_error(reason);
    if (glint_stone_light(&stone, light, room) != GLINT_OK)
        exit_with_error("out of memory");
    *db = peak_psnr(room, light + n, n);
    if (dir)
        write_medium_model(dir, name, data, bytes);
    free(data);
}

static void fit_and_bake(struct glint_scatter_rows *rows, int stone, int model,
                         const double *light, double *room, const char *dir)
{
    struct glint_scatter_options o = {
        model_of[model].model, model_of[model].kernels, model_of[model].rank};
    const clock_t start = clock();
    struct glint_scatter_fit fit;
    double db;

    if (glint_scatter_fit(rows, &o, NULL, &fit) != GLINT_OK)
        exit_with_error("no fit");
    /* o.rank is the rank of factored fits. For other fits it is the number of
     * products into which the bake separates each kernel. */
    fit.rank = o.rank;
    bake_and_measure_fit(&fit, light, room, stone ? NULL : dir,
                         model_of[model].name, &db);
    printf("%s %s %.2f %.2f %.1f\n", stone_name[stone], model_of[model].name,
           fit.error.light_db, db, (double)(clock() - start) / CLOCKS_PER_SEC);
    fflush(stdout);
    glint_scatter_fit_close(&fit);
}

int main(int argc, char **argv)
{
    const int side = 128, kernel = 29;
    const size_t n = 3 * (size_t)(side * side);
    double *light = calloc(3 * n, sizeof *light);

    if (argc < 2 || !light)
        exit_with_error("DIR");
    for (int i = 0; i < STONES; i++) {
        struct glint_scatter_rows rows;
        struct glint_stone stone;
        struct glint_error error;

        glint_stone_defaults(&stone);
        stone.side = side;
        stone.kernel = kernel;
        stone.pattern = i ? GLINT_STONE_VEINS : GLINT_STONE_CHESS;
        stone.seed = 2;
        if (glint_scatter_compute(&stone, NULL, &rows, &error) != GLINT_OK)
            exit_with_error(error.text);
        glint_scatter_test_light(side, light);
        glint_scatter_light_rows(&rows, light, light + n);
        for (int m = 0; m < MODELS; m++)
            fit_and_bake(&rows, i, m, light, light + 2 * n, argv[1]);
        glint_scatter_close(&rows);
    }
    free(light);
    return 0;
}
