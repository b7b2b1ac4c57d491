/* SPDX-License-Identifier: MIT */
#include "glint/composite.h"

#include "base/arena.h"
#include "image/resolve.h"

enum { WIDTH = GLINT_CODES_WIDTH }; /* max pixels per run */

struct glint_composite {
    struct glint_resolve *resolve;
    struct glint_light_rows *light;
    struct glint_resolve_rows *rows;
};

/* Allocates a composite from arena A. Called twice: first with an arena that
 * only counts bytes, where it returns NULL; then with an arena that has
 * memory. */
static struct glint_composite *allocate_composite(struct glint_arena *a)
{
    struct glint_composite measured = {0}, *placed;
    struct glint_composite *c;

    placed = glint_arena_allocate(a, 1, sizeof *placed);
    c = placed ? placed : &measured;
    c->resolve = glint_arena_allocate(a, 1, sizeof *c->resolve);
    c->light = glint_arena_allocate(a, 1, sizeof *c->light);
    c->rows = glint_arena_allocate(a, 1, sizeof *c->rows);
    return placed;
}

size_t glint_composite_bytes(void)
{
    struct glint_arena arena = glint_arena_begin_measuring();

    allocate_composite(&arena);
    return arena.used;
}

enum glint_status glint_composite_init(struct glint_composite **composite,
                                       const struct glint_image *image,
                                       unsigned sets, int dither, void *mem,
                                       size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_composite *c;

    if (image->format == GLINT_LINEAR_Q20 || (uintptr_t)mem % GLINT_ALIGN != 0)
        return GLINT_E_ARGUMENT;
    if (glint_composite_bytes() > bytes)
        return GLINT_E_MEMORY;
    c = allocate_composite(&arena);
    glint_resolve_init(c->resolve, image, dither, sets);
    *composite = c;
    return GLINT_OK;
}

/* Copies the light of N_X x N_Y pixels from LAYER; returns whether the light of
 * any pixel is not 0. */
static int copy_light_of_layer(struct glint_composite *c,
                               const struct glint_layer *layer, int x, int y,
                               int n_x, int n_y)
{
    unsigned any = 0;

    for (int k = 0; k < 3; k++)
        for (int row = 0; row < n_y; row++) {
            const uint16_t *from =
                layer->rgb_q16[k] + (ptrdiff_t)(y + row) * layer->stride + x;

            for (int i = 0; i < WIDTH; i++) {
                c->light->rgb_q16[k][row][i] = i < n_x ? from[i] : 0;
                any |= c->light->rgb_q16[k][row][i];
            }
        }
    return any != 0;
}

void glint_composite_add(struct glint_composite *composite,
                         const struct glint_image *image,
                         const struct glint_layer *layer)
{
    for (int y = 0; y < image->height; y += 2)
        for (int x = 0; x < image->width; x += WIDTH) {
            const int n_y = y + 2 < image->height ? 2 : image->height - y;
            const int n_x = x + WIDTH < image->width ? WIDTH : image->width - x;

            if (copy_light_of_layer(composite, layer, x, y, n_x, n_y))
                glint_resolve_add_to_run(composite->resolve, image, x, y, n_x,
                                         n_y, composite->light,
                                         composite->rows);
        }
}
