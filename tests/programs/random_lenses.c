/* SPDX-License-Identifier: MIT
 *
 * random_lenses SEED NUMBER [--table] - bakes a random but valid lens
 * (support/random_lens.h) as a draft. Compares an image of its model, as linear
 * light and as pixel codes, with the exact image.
 *
 * Prints a line: number of the lens; result (drawn; dark in both images;
 * rejected by the bake); number of invalid random tables before this lens;
 * surfaces, ghosts, focal length in mm, f-number, degrees of the light, PSNR in
 * dB, flux / exact flux, 99th percentile of differences in codes, and the grid
 * of the exact image. With --table, prints the lens table instead.
 * tests/extremes runs this program many times, each with a time limit.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/random_lens.h"
#include "support/stage.h"

enum { WIDTH = 144, HEIGHT = 96, MANY_GHOSTS = 60 };

/* Returns a lamp of power 1, inside the image or slightly off-screen. */
static struct glint_lamp make_random_lamp(const struct stage *s, uint64_t seed,
                                          int number)
{
    uint64_t r = ~seed * UINT64_C(0xd1342543de82ef95) + (uint64_t)number;
    const double half =
        0.5 * hypot(s->lens.film_width_mm, s->lens.film_height_mm);
    const double corner =
        atan(half / s->setup.optics.focal_mm) * 57.29577951308232;
    const double theta = fmin(60, corner * stage_random_uniform(&r, 0, 1.2));

    return stage_make_lamp(theta, stage_random_uniform(&r, -180, 180), 1);
}

/* Prints the output line of lens NUMBER of S; WHAT is the result of the
 * comparison. */
static int print_lens_result(const struct stage *s, int number,
                             const char *what, int tries, double theta_deg,
                             const struct glint_measure *m, int grid)
{
    printf("%d %s %d %d %d %.4g %.3g %.3g %.1f %.4f %.0f %d\n", number, what,
           tries, s->lens.n_surfaces, glint_ghost_list(&s->lens, NULL, 0),
           s->setup.optics.focal_mm, s->lens.f_number, theta_deg, m->psnr_db,
           m->flux, m->p99, grid);
    return 0;
}

static int compare_lens_with_exact(uint64_t seed, int number)
{
    static struct stage s;
    static char text[RANDOM_LENS_TEXT];
    static float model[3 * WIDTH * HEIGHT], exact[3 * WIDTH * HEIGHT];
    static uint8_t codes[3 * WIDTH * HEIGHT];
    const int tries = make_random_lens(&s.lens, seed, number, text);
    struct glint_measure m = {0};
    struct glint_lamp lamp, bright;
    uint64_t r = seed + (uint64_t)number;
    const int blades =
        stage_random_bits(&r) % 4 ? 3 + (int)(stage_random_bits(&r) % 62) : 0;
    int grid;

    if (tries < 0 || !stage_set_up_lens(&s, blades))
        return print_lens_result(&s, number, "refused", tries, 0, &m, 0);
    lamp = bright = make_random_lamp(&s, seed, number);
    if (!stage_bake_model(&s, 4, fmin(89, lamp.theta_deg + 0.5)))
        return print_lens_result(&s, number, "refused", tries, lamp.theta_deg,
                                 &m, 0);
    stage_set_view(&s, WIDTH, HEIGHT, 0);
    /* With this power all codes are saturated, but range checks must not
     * fail. */
    bright.power = 1e9;
    grid = glint_ghost_list(&s.lens, NULL, 0) > MANY_GHOSTS ? 64 : 128;
    if (!stage_draw_linear(&s, &lamp, 1, model) ||
        !stage_draw_codes(&s, &bright, 1, codes) ||
        !stage_draw_exact(&s, &lamp, 1, grid, exact))
        return 1;
    m = stage_compare_images(&s, exact, model);
    if (m.psnr_db < 45 && stage_draw_exact(&s, &lamp, 1, 2 * grid, exact)) {
        /* A finer grid shows whether the difference is an error of the exact
         * image. */
        grid *= 2;
        m = stage_compare_images(&s, exact, model);
    }
    return print_lens_result(&s, number,
                             stage_sum_image(&s, exact) <= 0 &&
                                     stage_sum_image(&s, model) <= 0
                                 ? "dark"
                                 : "drawn",
                             tries, lamp.theta_deg, &m, grid);
}

int main(int argc, char **argv)
{
    static struct glint_prescription lens;
    static char text[RANDOM_LENS_TEXT];
    const uint64_t seed = argc > 2 ? strtoull(argv[1], NULL, 10) : 0;

    if (argc < 3 || argc > 4 || (argc == 4 && strcmp(argv[3], "--table"))) {
        fprintf(stderr, "random_lenses SEED NUMBER [--table]\n");
        return 2;
    }
    if (argc == 3)
        return compare_lens_with_exact(seed, atoi(argv[2]));
    make_random_lens(&lens, seed, atoi(argv[2]), text);
    printf("# seed %s, lens %s\n%s", argv[1], argv[2], text);
    return 0;
}
