/* SPDX-License-Identifier: MIT */
#include "support/models/drawn_scene.h"

#include "reference/scenes/twin.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

void drawn_open_scene(struct drawn *d, const char *text,
                      const struct glint_description_files *files,
                      const struct scene_dials *dials, const struct tool *tool)
{
    struct glint_scene_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";

    d->description = malloc(sizeof *d->description);
    assert_non_null(d->description);
    if (glint_description_parse(d->description, text, strlen(text), "x.scene",
                                files, &error) != GLINT_OK ||
        glint_scene_bake(d->description, "x", 1, &d->data, &d->bytes, &report,
                         &error) != GLINT_OK)
        fail_msg("%s", error.text);
    if (glint_scene_open(&d->model, d->data, d->bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    assert_ok(scene_frame_open(&d->frame, tool, &d->model, dials));
}

void drawn_close_scene(struct drawn *d)
{
    scene_frame_close(&d->frame);
    free(d->data);
    glint_description_free(d->description);
    free(d->description);
}

void drawn_draw_image(struct drawn *d, int width, int height,
                      int32_t *light_q20)
{
    struct glint_image image =
        glint_image_over(light_q20, GLINT_LINEAR_Q20, width, height);

    memset(light_q20, 0,
           3 * (size_t)width * (size_t)height * sizeof *light_q20);
    assert_ok(scene_frame_draw(&d->frame, &image));
}

/* Returns whether the reference shows the same object at pixel I and at all of
 * its neighbours. */
static int is_inside_object(const struct twin_pixel *p, int i)
{
    const int x = i % WIDTH, y = i / WIDTH;

    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT &&
                fabs((double)p[v * WIDTH + u].rgb[1] - (double)p[i].rgb[1]) >
                    .2 * (double)p[i].rgb[1] + .01)
                return 0;
    return 1;
}

double drawn_psnr_to_reference(const char *text,
                               const struct glint_description_files *files)
{
    static const struct scene_dials dials = {.width = WIDTH,
                                             .height = HEIGHT,
                                             .edge_samples = 1,
                                             .shadow_points = 1};
    static const struct tool tool = {.name = "test"};
    static const struct twin_view view = {WIDTH, HEIGHT, 0, 1};
    static struct twin_pixel exact[PIXELS];
    static int32_t light_q20[3 * PIXELS];
    double square = 0;
    struct drawn d;
    struct twin twin;
    int n = 0;

    drawn_open_scene(&d, text, files, &dials, &tool);
    drawn_draw_image(&d, WIDTH, HEIGHT, light_q20);
    assert_ok(reference_open(&twin, d.description));
    reference_render_image(&twin, &view, NULL, exact);
    reference_close(&twin);
    drawn_close_scene(&d);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3 && is_inside_object(exact, i); c++, n++)
            square += pow(fmin((double)exact[i].rgb[c], 1) -
                              fmin(light_q20[3 * i + c] * 0x1p-20, 1),
                          2);
    assert_true(n > PIXELS);
    return -10 * log10(square / n + 1e-12);
}
