/* SPDX-License-Identifier: MIT
 *
 * Boxes of pixels.
 */
#ifndef GLINT_TILE_BOX_H
#define GLINT_TILE_BOX_H

/* A box of pixels: columns X0 .. X1 - 1, rows Y0 .. Y1 - 1. */
struct glint_box {
    int x0, y0, x1, y1;
};

static inline struct glint_box glint_box_intersect(struct glint_box a,
                                                   struct glint_box b)
{
    return (struct glint_box){
        a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0,
        a.x1 < b.x1 ? a.x1 : b.x1, a.y1 < b.y1 ? a.y1 : b.y1};
}

static inline int glint_box_is_empty(struct glint_box b)
{
    return b.x0 >= b.x1 || b.y0 >= b.y1;
}

/* Returns the smallest box that contains A and B. */
static inline struct glint_box glint_box_unite(struct glint_box a,
                                               struct glint_box b)
{
    if (glint_box_is_empty(a) || glint_box_is_empty(b))
        return glint_box_is_empty(a) ? b : a;
    return (struct glint_box){
        a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0,
        a.x1 > b.x1 ? a.x1 : b.x1, a.y1 > b.y1 ? a.y1 : b.y1};
}

#endif
