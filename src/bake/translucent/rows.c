/* SPDX-License-Identifier: MIT
 *
 * Rows of a scattering matrix: allocates them, imports measured rows from a
 * picture, and scatters light by them.
 */
#include "bake/translucent/rows.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool glint_scatter_allocate_rows(struct glint_scatter_rows *rows, int side,
                                 int kernel, bool shared)
{
    const size_t texels = (size_t)side * (size_t)side;
    const size_t entries =
        texels * 3 * (size_t)glint_scatter_count_entries(kernel);

    *rows = (struct glint_scatter_rows){.side = side, .kernel = kernel};
    rows->r = calloc(entries, sizeof *rows->r);
    if (shared)
        rows->share = calloc(texels, sizeof *rows->share);
    if (rows->r && (rows->share || !shared))
        return true;
    glint_scatter_close(rows);
    return false;
}

void glint_scatter_close(struct glint_scatter_rows *rows)
{
    free(rows->r);
    free(rows->share);
    memset(rows, 0, sizeof *rows);
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static int max_int(int a, int b)
{
    return a > b ? a : b;
}

struct glint_scatter_inside glint_scatter_find_offsets_inside(int side,
                                                              int kernel, int x)
{
    const int half = kernel / 2, i = x % side, j = x / side;

    return (struct glint_scatter_inside){
        .u_from = max_int(0, half - i),
        .u_to = min_int(kernel, side + half - i),
        .v_from = max_int(0, half - j),
        .v_to = min_int(kernel, side + half - j),
    };
}

int glint_scatter_get_target_texel(int side, int kernel, int x, int d)
{
    const int i = x % side + d % kernel - kernel / 2;
    const int j = x / side + d / kernel - kernel / 2;

    return i < 0 || j < 0 || i >= side || j >= side ? -1 : j * side + i;
}

void glint_scatter_transpose_rows(struct glint_scatter_rows *rows)
{
    const int side = rows->side, n = rows->kernel, last = n * n - 1;

    for (int x = 0; x < side * side; x++)
        for (int d = last / 2 + 1; d <= last; d++) {
            const int to = glint_scatter_get_target_texel(side, n, x, d);

            for (int c = 0; c < 3 && to >= 0; c++) {
                float *there = glint_scatter_get_row(rows, x, c) + d;
                float *back = glint_scatter_get_row(rows, to, c) + last - d;
                const float r = *there;

                *there = *back;
                *back = r;
            }
        }
}

bool glint_watch_report_progress(const struct glint_watch *watch, double done)
{
    if (!watch)
        return false;
    if (watch->progress)
        watch->progress(watch->ctx, done);
    return watch->stop && watch->stop(watch->ctx);
}

static void report_part_progress(void *ctx, double done)
{
    const struct glint_watch_part *part = ctx;

    if (part->whole && part->whole->progress)
        part->whole->progress(part->whole->ctx,
                              part->from + done * part->length);
}

static bool is_stop_requested(void *ctx)
{
    const struct glint_watch_part *part = ctx;

    return part->whole && part->whole->stop &&
           part->whole->stop(part->whole->ctx);
}

struct glint_watch glint_watch_make_for_part(struct glint_watch_part *part)
{
    return (struct glint_watch){report_part_progress, is_stop_requested, part};
}

/* Sets the row of texel X from its tile of PICTURE. Returns the number of
 * invalid values, which become 0. */
static long long read_row_from_picture(const struct glint_float_image *picture,
                                       const struct glint_scatter_rows *rows,
                                       int x)
{
    const int n = rows->kernel, i = x % rows->side, j = x / rows->side;
    const struct glint_scatter_inside in =
        glint_scatter_find_offsets_inside(rows->side, n, x);
    long long held = 0;

    for (int v = in.v_from; v < in.v_to; v++)
        for (int u = in.u_from; u < in.u_to; u++) {
            const float *from = picture->rgb + 3 * ((size_t)(j * n + v) *
                                                        (size_t)picture->width +
                                                    (size_t)(i * n + u));

            for (int c = 0; c < 3; c++) {
                const bool good = isfinite(from[c]) && from[c] >= 0;

                held += !good;
                glint_scatter_get_row(rows, x, c)[v * n + u] =
                    good ? from[c] : 0;
            }
        }
    return held;
}

enum glint_status glint_scatter_read(const struct glint_float_image *picture,
                                     int side, int kernel,
                                     struct glint_scatter_rows *rows,
                                     long long *held, struct glint_error *error)
{
    *rows = (struct glint_scatter_rows){0};
    *held = 0;
    if (side < 1 || side > GLINT_SCATTER_MAX_SIDE || kernel < 1 ||
        kernel > GLINT_SCATTER_MAX_KERNEL || kernel % 2 == 0) {
        snprintf(
            error->text, sizeof error->text,
            "data of %d x %d texels with kernels of %d texels are out of range",
            side, side, kernel);
        return GLINT_E_ARGUMENT;
    }
    if (picture->width != side * kernel || picture->height != side * kernel) {
        snprintf(error->text, sizeof error->text,
                 "the picture of rows must have %d x %d pixels, not %d x %d: "
                 "%d x %d tiles of %d x %d",
                 side * kernel, side * kernel, picture->width, picture->height,
                 side, side, kernel, kernel);
        return GLINT_E_UNSUPPORTED;
    }
    if (!glint_scatter_allocate_rows(rows, side, kernel, false)) {
        snprintf(error->text, sizeof error->text, "out of memory");
        return GLINT_E_MEMORY;
    }
    for (int x = 0; x < side * side; x++)
        *held += read_row_from_picture(picture, rows, x);
    return GLINT_OK;
}

void glint_scatter_light_rows(const struct glint_scatter_rows *rows,
                              const double *irradiance, double *radiosity)
{
    const int side = rows->side, n = rows->kernel, half = n / 2;

    memset(radiosity, 0, 3 * (size_t)side * (size_t)side * sizeof *radiosity);
    for (int x = 0; x < side * side; x++) {
        const struct glint_scatter_inside in =
            glint_scatter_find_offsets_inside(side, n, x);

        for (int c = 0; c < 3; c++) {
            const float *row = glint_scatter_get_row(rows, x, c);

            for (int v = in.v_from; v < in.v_to; v++)
                for (int u = in.u_from; u < in.u_to; u++)
                    radiosity[3 * (x + (v - half) * side + u - half) + c] +=
                        irradiance[3 * x + c] * (double)row[v * n + u];
        }
    }
}
