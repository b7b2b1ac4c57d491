/* SPDX-License-Identifier: MIT
 *
 * Draws the picture of glint explain: the dimmed frame with shaded tiles,
 * outlined and numbered ghosts, and a legend below.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "explain/explain.h"
#include "formats/paint.h"

enum { PALETTE = 14, MOST_LABELS = 256, COLUMN = 152 };

static const uint8_t palette[PALETTE][3] = {
    {255, 96, 80},   {96, 224, 96},   {112, 160, 255}, {255, 208, 64},
    {80, 224, 224},  {255, 112, 224}, {255, 160, 64},  {176, 240, 80},
    {184, 144, 255}, {255, 255, 255}, {192, 128, 96},  {128, 192, 160},
    {255, 176, 176}, {160, 160, 160}};

struct label {
    int x0, y0, x1, y1;
    int k, number; /* index of the ghost's colour, and number of the ghost */
};

struct marking {
    struct glint_explain *explain;
    const struct glint_image *image; /* the picture being marked */
    /* Size of the frame in pixels; the legend lies below it. */
    int width, height;
    int scale; /* stroke width of labels and legend, pixels */
    int n_labels;
    struct label label[MOST_LABELS];
};

static void set_ghost_palette(struct paint *p, int k)
{
    const uint8_t *c = palette[k % PALETTE];

    paint_set_colour(p, c[0], c[1], c[2]);
}

/* ------------------------------------------------------------------- tiles */

/* Returns whether any pixel of the tile at (X0, Y0), SIDE pixels wide, has
 * light of the flare. */
static bool is_tile_lit(const struct marking *m, int x0, int y0, int side)
{
    for (int y = y0; y < y0 + side && y < m->height; y++)
        for (int x = x0; x < x0 + side && x < m->width; x++) {
            const int32_t *px = m->explain->linear_q20 +
                                3 * ((size_t)y * (size_t)m->width + (size_t)x);

            if (px[0] | px[1] | px[2])
                return true;
        }
    return false;
}

/* Shades a tile: TOUCHED tiles bluish with brighter left and top lines, other
 * tiles darker. */
static void shade_tile(const struct marking *m, int x0, int y0, int side,
                       bool touched)
{
    static const int tint[3] = {6, 12, 34};

    for (int y = y0; y < y0 + side && y < m->height; y++)
        for (int x = x0; x < x0 + side && x < m->width; x++) {
            uint8_t *px = m->image->plane[0] + y * m->image->stride_bytes[0] +
                          3 * (ptrdiff_t)x;
            const int rim = x == x0 || y == y0 ? 2 : 1;

            for (int c = 0; c < 3; c++)
                px[c] =
                    (uint8_t)(touched ? px[c] / 2 + rim * tint[c] : px[c] / 4);
        }
}

static void shade_lit_tiles(struct marking *m)
{
    const int side = 1 << m->explain->tile_log2;
    int tile = 0;

    if (m->explain->n_lights)
        glint_explain_draw(m->explain, -1);
    for (int y = 0; y < m->height; y += side)
        for (int x = 0; x < m->width; x += side, tile++)
            shade_tile(m, x, y, side,
                       m->explain->n_lights &&
                           (glint_explain_listed(m->explain, tile) > 0 ||
                            is_tile_lit(m, x, y, side)));
}

/* ------------------------------------------------------------------ ghosts */

static bool is_pixel_lit(const struct marking *m, int x, int y)
{
    const int32_t *px;

    if (x < 0 || y < 0 || x >= m->width || y >= m->height)
        /* Pixels outside the picture count as lit, so that the picture's border
         * is not outlined. */
        return true;
    px =
        m->explain->linear_q20 + 3 * ((size_t)y * (size_t)m->width + (size_t)x);
    return (px[0] | px[1] | px[2]) != 0;
}

static bool is_rim_pixel(const struct marking *m, int x, int y)
{
    return is_pixel_lit(m, x, y) &&
           !(is_pixel_lit(m, x - 1, y) && is_pixel_lit(m, x + 1, y) &&
             is_pixel_lit(m, x, y - 1) && is_pixel_lit(m, x, y + 1));
}

static bool is_label_space_free(const struct marking *m, const struct label *l)
{
    if (l->x0 < 0 || l->y0 < 0 || l->x1 > m->width || l->y1 > m->height)
        return false;
    for (int i = 0; i < m->n_labels; i++)
        if (l->x0 < m->label[i].x1 && l->x1 > m->label[i].x0 &&
            l->y0 < m->label[i].y1 && l->y1 > m->label[i].y0)
            return false;
    return true;
}

/* Sets L to the position of a label of W x H pixels on the ghost's outline,
 * else inside the ghost: the first free position from row START downwards, then
 * from the top. Returns false if there is none. */
static bool find_label_position(const struct marking *m, int start, int w,
                                int h, struct label *l)
{
    for (int rim = 1; rim >= 0; rim--)
        for (int k = 0; k < m->height; k += rim ? 1 : h)
            for (int x = 0; x < m->width; x += rim ? 1 : w) {
                const int y = (start + k) % m->height;

                if (rim ? !is_rim_pixel(m, x, y) : !is_pixel_lit(m, x, y))
                    continue;
                *l = (struct label){.x0 = x - w / 2,
                                    .y0 = y - h / 2,
                                    .x1 = x - w / 2 + w,
                                    .y1 = y - h / 2 + h};
                if (is_label_space_free(m, l))
                    return true;
            }
    return false;
}

/* Reserves the position of the label of ghost NUMBER, which was drawn last. */
static void place_ghost_label(struct marking *m, int k, int number)
{
    struct paint p = {.image = m->image, .line = m->scale};
    const int start = k * 5 % 16 * m->height / 16; /* first row; varied */
    struct label l;
    char text[16];

    snprintf(text, sizeof text, "%d", number);
    if (m->n_labels == MOST_LABELS ||
        !find_label_position(m, start, paint_text_width(&p, text) + 4 * p.line,
                             9 * p.line, &l))
        return;
    l.k = k;
    l.number = number;
    m->label[m->n_labels++] = l;
}

static void draw_ghost_label(const struct marking *m, const struct label *l)
{
    struct paint p = {.image = m->image, .line = m->scale};
    char text[16];

    snprintf(text, sizeof text, "%d", l->number);
    paint_set_colour(&p, 0, 0, 0);
    paint_fill_rectangle(&p, l->x0, l->y0, l->x1, l->y1);
    set_ghost_palette(&p, l->k);
    paint_text(&p, l->x0 + 2 * p.line, l->y0 + 2 * p.line, text);
}

static void draw_ghost_outline(const struct marking *m, int k)
{
    struct paint p = {.image = m->image, .line = 1};
    const int wide = (m->scale + 1) / 2;

    set_ghost_palette(&p, k);
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++)
            if (is_rim_pixel(m, x, y))
                paint_fill_rectangle(&p, x, y, x + wide,
                                     y + wide < m->height ? y + wide
                                                          : m->height);
}

/* ------------------------------------------------------------------ legend */

static int count_marked_ghosts(const struct glint_explain *e,
                               const struct explain_title *t)
{
    int n = 0;

    for (int i = 0; i < e->n_ghosts; i++)
        n += e->ghost[i].lit > 0;
    return n < t->top ? n : t->top;
}

static int count_legend_columns(const struct marking *m)
{
    const int n = m->width / (COLUMN * m->scale);

    return n > 0 ? n : 1;
}

static int count_legend_rows(const struct marking *m,
                             const struct explain_title *t)
{
    return 1 +
           (count_marked_ghosts(m->explain, t) + count_legend_columns(m) - 1) /
               count_legend_columns(m);
}

static void draw_legend_title(const struct marking *m,
                              const struct explain_title *t)
{
    struct paint p = {.image = m->image, .line = m->scale};
    char text[160];
    const int y = m->height + 3 * p.line;

    paint_set_colour(&p, 64, 76, 120);
    paint_fill_rectangle(&p, 4 * p.line, y, 9 * p.line, y + 5 * p.line);
    snprintf(text, sizeof text, "%d of %d ghosts  %s",
             count_marked_ghosts(m->explain, t), m->explain->n_ghosts, t->lens);
    paint_set_colour(&p, 208, 208, 208);
    paint_text(&p, 12 * p.line, y, text);
}

/* Draws entry K of the legend: the number of GHOST, its pair of surfaces, and
 * its fraction of the light. */
static void draw_legend_entry(const struct marking *m, int k, int ghost)
{
    struct paint p = {.image = m->image, .line = m->scale};
    const struct glint_explain_part *part = &m->explain->ghost[ghost];
    const struct glint_ghost *g = &m->explain->setup->ghost[ghost];
    const int x = k % count_legend_columns(m) * COLUMN * p.line + 4 * p.line;
    const int y =
        m->height + (3 + 8 * (1 + k / count_legend_columns(m))) * p.line;
    char text[64];

    set_ghost_palette(&p, k);
    paint_fill_rectangle(&p, x, y, x + 5 * p.line, y + 5 * p.line);
    snprintf(text, sizeof text, "%d", ghost);
    paint_text(&p, x + 8 * p.line, y, text);
    snprintf(text, sizeof text, "surfaces %d-%d  %.1f%%", g->i, g->j,
             100 * part->share);
    paint_text(&p, x + 24 * p.line, y, text);
}

/* ----------------------------------------------------------------- picture */

/* Sets MARKED to a new picture, whose plane[0] the caller frees: PICTURE above
 * LEGEND black rows. Returns GLINT_E_MEMORY on failure. */
static enum glint_status copy_picture(const struct glint_image *picture,
                                      int legend, struct glint_image *marked)
{
    const size_t row = 3 * (size_t)picture->width;
    uint8_t *mem;

    *marked = (struct glint_image){.format = GLINT_RGB24,
                                   .width = picture->width,
                                   .height = picture->height + legend};
    mem = calloc(row, (size_t)marked->height);
    if (!mem)
        return GLINT_E_MEMORY;
    glint_image_place(marked, mem);
    for (int y = 0; y < picture->height; y++)
        memcpy(mem + (size_t)y * row,
               picture->plane[0] + y * picture->stride_bytes[0], row);
    return GLINT_OK;
}

enum glint_status explain_draw_marks(struct glint_explain *e,
                                     const struct explain_title *t,
                                     const struct glint_image *picture,
                                     struct glint_image *marked)
{
    struct marking m = {.explain = e,
                        .image = marked,
                        .width = picture->width,
                        .height = picture->height,
                        .scale = 1 + picture->height / 540};
    enum glint_status status;
    int ghosts[GLINT_MAX_GHOSTS], n = 0;

    status = copy_picture(picture, (8 * count_legend_rows(&m, t) + 3) * m.scale,
                          marked);
    if (status != GLINT_OK)
        return status;
    glint_explain_sort(e, ghosts);
    shade_lit_tiles(&m);
    draw_legend_title(&m, t);
    for (int i = 0; i < e->n_ghosts && n < t->top; i++) {
        if (e->ghost[ghosts[i]].lit == 0)
            continue;
        status = glint_explain_draw(e, ghosts[i]);
        if (status != GLINT_OK)
            break;
        draw_ghost_outline(&m, n);
        place_ghost_label(&m, n, ghosts[i]);
        draw_legend_entry(&m, n++, ghosts[i]);
    }
    for (int i = 0; i < m.n_labels; i++)
        draw_ghost_label(&m, &m.label[i]);
    return status;
}
