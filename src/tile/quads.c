/* SPDX-License-Identifier: MIT */
#include "tile/quads.h"

enum { STEP = 2 * GLINT_LANES }; /* of the kernels, pixels */

/* Of a stretch of two rows, or of a picture's last one alone, the N pixels from
 * AT on, and their light: each R, G, B is of two of a row. */
struct part {
    const struct glint_stretch *of;
    int at, n;
    const uint16_t *light_q16[3];
};

static int padded(int n)
{
    return (n + STEP - 1) & -STEP;
}

/* ------------------------------------------------------------ pixel by pixel
 */

static void double_row(const uint16_t *restrict from, int n,
                       uint16_t *restrict to)
{
    for (int i = 0; i < n; i++)
        to[2 * i] = to[2 * i + 1] = from[i];
}

static void add_to_pixels(const struct part *p, struct glint_quads_rows *rows)
{
    for (int c = 0; c < 3; c++)
        for (int row = 0; row < p->of->n_y; row++)
            double_row(p->light_q16[c], padded(p->n) / 2,
                       rows->light.rgb_q16[c][row] + p->at);
    glint_resolve_part(p->of, p->at, p->n, &rows->light, &rows->rows);
}

/* -------------------------------------------------------- R, G, B by
 * themselves
 */

static void add_to_channels(const struct part *p, struct glint_codes *codes)
{
    const struct glint_resolve *r = p->of->resolve;
    const int last = p->of->n_y - 1;
    const int16_t *const round[2] = {r->round_q7[p->of->y & 7],
                                     r->round_q7[(p->of->y + last) & 7]};

    for (int c = 0; c < 3; c++) {
        uint8_t *const code[2] = {codes->sample[c][0] + p->at,
                                  codes->sample[c][last] + p->at};

        glint_quad_kernels_of(r->sets)->add_code(
            code, p->light_q16[c], padded(p->n), &r->mix.tone, round);
    }
}

/* ------------------------------------------------------------ shared chroma */

static void add_to_pairs(const struct part *p, struct glint_codes *codes)
{
    const struct glint_resolve *r = p->of->resolve;
    const int y = p->of->y, log2_y = p->of->layout->log2_y;
    const int last = p->of->n_y - 1, c_last = log2_y ? 0 : last;
    const int cy = y >> log2_y;
    uint8_t *const luma[2] = {codes->sample[0][0] + p->at,
                              codes->sample[0][last] + p->at};
    uint8_t *const chroma[2] = {codes->chroma[0] + p->at,
                                codes->chroma[c_last] + p->at};
    const int16_t *const round[2] = {r->round_q7[y & 7],
                                     r->round_q7[(y + last) & 7]};
    const int16_t *const round_chroma[2] = {r->round_q7[cy & 7],
                                            r->round_q7[(cy + c_last) & 7]};

    glint_quad_kernels_of(r->sets)->add(
        luma, chroma, p->light_q16, padded(p->n), &r->mix, round, round_chroma);
}

/* YUYV and the like, in place; what is left of whole steps on the side. */
static void add_to_packed(const struct part *p, struct glint_codes *codes)
{
    const struct glint_resolve *r = p->of->resolve;
    const struct glint_quad_kernels *kernels = glint_quad_kernels_of(r->sets);
    const struct glint_image *image = p->of->image;
    const int luma_at = p->of->layout->sample[0].offset;
    const int last = p->of->n_y - 1, y = p->of->y;
    const int whole = p->n & -STEP, n_rest = 2 * (p->n - whole);
    const uint16_t *const light_rest[3] = {p->light_q16[0] + whole / 2,
                                           p->light_q16[1] + whole / 2,
                                           p->light_q16[2] + whole / 2};
    const int16_t *const round[2] = {r->round_q7[y & 7],
                                     r->round_q7[(y + last) & 7]};
    uint8_t *const rest[2] = {codes->sample[0][0], codes->sample[0][last]};
    uint8_t *px[2];

    for (int row = 0; row < 2; row++)
        px[row] = image->plane[0] +
                  (y + (row ? last : 0)) * image->stride_bytes[0] +
                  2 * (ptrdiff_t)(p->of->x + p->at);
    kernels->add_packed(px, p->light_q16, whole, luma_at, &r->mix, round);
    if (n_rest == 0)
        return;
    for (int row = 0; row <= last; row++)
        for (int i = 0; i < 2 * STEP; i++)
            rest[row][i] = i < n_rest ? px[row][2 * whole + i] : 0;
    kernels->add_packed(rest, light_rest, STEP, luma_at, &r->mix, round);
    for (int row = 0; row <= last; row++)
        for (int i = 0; i < n_rest; i++)
            px[row][2 * whole + i] = rest[row][i];
}

static void add_to_part(const struct part *p, struct glint_quads_rows *rows)
{
    if (p->of->in_place)
        add_to_packed(p, &rows->rows.codes);
    else if (p->of->layout->log2_x)
        add_to_pairs(p, &rows->rows.codes);
    else if (glint_layout_is_rgb(p->of->layout))
        add_to_channels(p, &rows->rows.codes);
    else
        add_to_pixels(p, rows);
}

void glint_resolve_quads(const struct glint_resolve *resolve,
                         const struct glint_image *image, int x, int y, int n_x,
                         int n_y, const uint16_t *const light_q16[3],
                         struct glint_quads_rows *rows)
{
    const struct glint_stretch s =
        glint_stretch_of(resolve, image, x, y, n_x, n_y);
    const struct part all = {
        &s, 0, n_x, {light_q16[0], light_q16[1], light_q16[2]}};

    glint_stretch_read(&s, &rows->rows.codes);
    add_to_part(&all, rows);
    glint_stretch_write(&s, &rows->rows.codes);
}

/* ------------------------------------------------------- where light is even
 */

/* Bit k: whether the k-th unit of S is even; its quads then. */
static unsigned find_even(const struct glint_stretch *s,
                          const struct glint_even *even,
                          const struct glint_light_rows *light,
                          uint16_t (*quads_q16)[GLINT_CODES_WIDTH / 2])
{
    const uint16_t *const rgb_q16[3][2] = {
        {light->rgb_q16[0][0], light->rgb_q16[0][1]},
        {light->rgb_q16[1][0], light->rgb_q16[1][1]},
        {light->rgb_q16[2][0], light->rgb_q16[2][1]}};
    uint16_t *const quads[3] = {quads_q16[0], quads_q16[1], quads_q16[2]};

    if (s->n_y < 2 || !(s->layout->log2_x || glint_layout_is_rgb(s->layout)))
        return 0; /* by quads it would take longer */
    return glint_quad_kernels_of(s->resolve->sets)
        ->fold(rgb_q16, quads, s->n_x & -STEP, even);
}

void glint_resolve_even(const struct glint_resolve *resolve,
                        const struct glint_even *even,
                        const struct glint_image *image, int x, int y, int n_x,
                        int n_y, struct glint_light_rows *light,
                        struct glint_quads_rows *rows)
{
    const struct glint_stretch s =
        glint_stretch_of(resolve, image, x, y, n_x, n_y);
    const unsigned units = find_even(&s, even, light, rows->quads_q16);
    int at = 0;

    glint_stretch_read(&s, &rows->rows.codes);
    while (at < n_x) {
        const unsigned is_even = units >> at / STEP & 1;
        struct part p = {&s, at, STEP, {NULL}};

        while (at + p.n < n_x && (units >> (at + p.n) / STEP & 1) == is_even)
            p.n += STEP;
        if (at + p.n > n_x)
            p.n = n_x - at;
        for (int c = 0; c < 3; c++)
            p.light_q16[c] = rows->quads_q16[c] + at / 2;
        if (is_even)
            add_to_part(&p, rows);
        else
            glint_resolve_part(&s, at, p.n, light, &rows->rows);
        at += p.n;
    }
    glint_stretch_write(&s, &rows->rows.codes);
}

const struct glint_quads glint_quads = {glint_resolve_quads,
                                        glint_resolve_even};
