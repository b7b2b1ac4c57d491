/* SPDX-License-Identifier: MIT */
#include "support/stars/canvas.h"

#include "engine/star/star_tables.h"
#include "glint/kernels.h"
#include "support/test.h"

void star_canvas_open(struct star_canvas *c, int width, int height,
                      int tile_log2, int n_workers, uint32_t order)
{
    const struct glint_star_config star = {
        n_workers, width, height, STAR_CANVAS_LIGHTS, glint_sets_here()};
    const size_t bytes = glint_star_count_bytes(&star);

    c->width = width;
    c->height = height;
    bare_flare_open(&c->bare, width, height, tile_log2, n_workers, order);
    c->mem = bare_flare_allocate_filled(bytes);
    assert_int_equal(glint_star_init(&c->star, &star, c->mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_ok(glint_star_init(&c->star, &star, c->mem, bytes));
}

void star_canvas_close(struct star_canvas *c)
{
    bare_flare_close(&c->bare);
    free(c->mem);
}

int64_t star_canvas_draw_light(struct star_canvas *c,
                               const struct glint_star_tables *t,
                               const struct glint_star_light *lights, int n,
                               struct glint_real faintest,
                               enum glint_pixel_format format, void *mem)
{
    struct glint_image image =
        glint_image_over(mem, format, c->width, c->height);
    int64_t pixels;

    memset(mem, 0, glint_image_bytes(format, c->width, c->height));
    glint_star_set_lights(c->star, t, lights, n, faintest);
    pixels = glint_star_estimate_pixels(c->star);
    glint_star_draw(c->star, c->bare.flare, &image);
    return pixels;
}

struct glint_star_tables *
star_canvas_make_tables(int n_blades, double rotation_deg, double airy_px)
{
    const struct glint_star_optics o = {.n_blades = n_blades,
                                        .rotation_deg = rotation_deg,
                                        .f_number = airy_px / 0.55,
                                        .pixel_um = 1,
                                        .has_core = true};
    struct glint_star_tables *t;

    assert_ok(glint_star_tables_make(&t, &o));
    return t;
}

struct glint_star_light star_canvas_make_light(double x, double y,
                                               double power_log2)
{
    return (struct glint_star_light){.x_q8 = (int32_t)lrint(256 * x),
                                     .y_q8 = (int32_t)lrint(256 * y),
                                     .radius_q8 = -1,
                                     .power = glint_real_of(exp2(power_log2)),
                                     .rgb_q14 = {16384, 16384, 16384}};
}
