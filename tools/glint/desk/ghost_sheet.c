/* SPDX-License-Identifier: MIT */
#include "desk/ghost_sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/ghost_file.h"
#include "desk/sheet.h"
#include "glint/measure.h"
#include "formats/picture.h"
#include "posix/output.h"

enum { WIDE = 288, DIMMED = 5 };

/* Display exposure of a thumbnail: 99 % of a ghost's lit samples are at most at
 * this linear light, 1 = white. */
static const double shown = 0.7;

static bool is_ghost_muted(const struct ghost_list *l, int ghost)
{
    const struct glint_tint *tints = l->explain->tints;

    return tints && tints[ghost].gain.mantissa == 0;
}

/* -------------------------------------------------------------------- file */

enum glint_status ghost_list_write_file(const struct ghost_list *l,
                                        const char *path,
                                        struct glint_error *error)
{
    struct glint_output out;
    enum glint_status status =
        glint_output_open(&out, path, GLINT_OUTPUT_TEXT, error);
    char text[300];
    int n = snprintf(text, sizeof text,
                     "# Ghosts of one frame, the brightest first. A line may "
                     "have solo or mute, gain (0 to\n"
                     "# 1000) and tint R,G,B (0 to 4); a ghost without a line "
                     "does not change, unless others are solo.\nlens %s\n",
                     l->lens);

    if (status == GLINT_OK)
        status = glint_output_write(&out, text, (size_t)n, error);
    for (int i = 0; i < l->explain->n_ghosts && status == GLINT_OK; i++) {
        const int ghost = l->ghosts[i];
        const struct glint_explain_part *part = &l->explain->ghost[ghost];
        const struct glint_ghost *g = &l->explain->setup->ghost[ghost];

        if (glint_explain_drawn(part) == 0 && !is_ghost_muted(l, ghost))
            continue;
        ghost_file_write_line(text, sizeof text, ghost,
                              l->explain->tints ? &l->explain->tints[ghost]
                                                : NULL);
        n = (int)strlen(text);
        n += snprintf(text + n, sizeof text - (size_t)n,
                      "   # surfaces %d-%d, %.2f %% of the light\n", g->i, g->j,
                      100 * part->share);
        status = glint_output_write(&out, text, (size_t)n, error);
    }
    if (status == GLINT_OK)
        return glint_output_commit(&out, error);
    glint_output_abort(&out);
    return status;
}

/* ------------------------------------------------------------------- sheet */

/* Averages pixels of the ghost drawn last down to the thumbnail
 * LIGHT[HEIGHT][WIDTH][3]. */
static void reduce_ghost_image(const struct glint_explain *e, int width,
                               int height, float *light)
{
    const int w = e->view->width, h = e->view->height;

    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++, light += 3) {
            const int x0 = (int)((int64_t)i * w / width);
            const int x1 = (int)((int64_t)(i + 1) * w / width);
            const int y0 = (int)((int64_t)j * h / height);
            const int y1 = (int)((int64_t)(j + 1) * h / height);
            double sum[3] = {0, 0, 0};

            for (int y = y0; y < y1; y++)
                for (int x = 3 * x0; x < 3 * x1; x++)
                    sum[x % 3] +=
                        e->linear_q20[3 * (size_t)y * (size_t)w + (size_t)x];
            for (int c = 0; c < 3; c++)
                light[c] =
                    (float)(sum[c] * 0x1p-20 / ((double)(x1 - x0) * (y1 - y0)));
        }
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;

    return (x > y) - (x < y);
}

/* Returns the factor by which the 99th percentile of the samples above 0 in
 * LIGHT[N] becomes SHOWN, or 0 if there are none. ROOM is scratch memory of N
 * floats. */
static double find_display_exposure(const float *light, size_t n, float *room)
{
    size_t lit = 0;

    for (size_t i = 0; i < n; i++)
        if (light[i] > 0)
            room[lit++] = light[i];
    if (lit == 0)
        return 0;
    qsort(room, lit, sizeof *room, compare_floats);
    return shown / (double)room[lit - 1 - lit / 100];
}

/* Draws LIGHT, multiplied by SCALE, over the dimmed image SMALL into TO. All
 * have the size of a thumbnail. */
static void draw_ghost_thumbnail(const struct glint_image *to,
                                 const struct glint_image *small,
                                 const float *light, double scale)
{
    for (int y = 0; y < to->height; y++) {
        uint8_t *px = to->plane[0] + y * to->stride_bytes[0];
        const uint8_t *from = small->plane[0] + y * small->stride_bytes[0];

        for (int x = 0; x < 3 * to->width; x++) {
            const int code =
                (int)lrint(glint_measure_code(scale * (double)*light++)) +
                *from++ / DIMMED;

            *px++ = (uint8_t)(code < 255 ? code : 255);
        }
    }
}

static enum glint_status draw_numbered_ghost(const struct ghost_list *l,
                                             const struct sheet *sheet, int k,
                                             int ghost,
                                             const struct glint_image *small,
                                             float *light)
{
    const size_t n = 3 * (size_t)small->width * (size_t)small->height;
    const struct glint_image to = sheet_get_image(sheet, k);
    const struct glint_ghost *g = &l->explain->setup->ghost[ghost];
    const enum glint_status status = glint_explain_draw(l->explain, ghost);
    char text[64];

    if (status != GLINT_OK)
        return status;
    reduce_ghost_image(l->explain, small->width, small->height, light);
    draw_ghost_thumbnail(&to, small, light,
                         find_display_exposure(light, n, light + n));
    snprintf(text, sizeof text, "%d  %d-%d  %.1f%%", ghost, g->i, g->j,
             100 * l->explain->ghost[ghost].share);
    sheet_draw_caption(sheet, k, text);
    return GLINT_OK;
}

static enum glint_status draw_contact_sheet(const struct ghost_list *l,
                                            const struct glint_image *small,
                                            struct sheet *sheet)
{
    const size_t n = 3 * (size_t)small->width * (size_t)small->height;
    float *const light = calloc(2 * n, sizeof *light);
    int all = 0, k = 0;
    enum glint_status status;

    if (!light)
        return GLINT_E_MEMORY;
    for (int i = 0; i < l->explain->n_ghosts; i++)
        all += glint_explain_drawn(&l->explain->ghost[i]) > 0;
    all = all < l->top ? all : l->top;
    status =
        sheet_open(sheet, all > 0 ? all : 1, small->width, small->height, 1);
    for (int i = 0; i < l->explain->n_ghosts && status == GLINT_OK && k < all;
         i++)
        if (glint_explain_drawn(&l->explain->ghost[l->ghosts[i]]) > 0)
            status =
                draw_numbered_ghost(l, sheet, k++, l->ghosts[i], small, light);
    free(light);
    return status;
}

enum glint_status ghost_list_save_sheet(const struct ghost_list *l,
                                        const char *path,
                                        struct glint_error *error)
{
    struct glint_image small = {.plane = {NULL}};
    struct sheet sheet = {.columns = 0};
    enum glint_status status = sheet_reduce_image(&small, l->picture, WIDE);

    if (status == GLINT_OK)
        status = draw_contact_sheet(l, &small, &sheet);
    if (status == GLINT_OK)
        status = glint_picture_save(path, &sheet.image, error);
    sheet_close(&sheet);
    free(small.plane[0]);
    return status;
}
