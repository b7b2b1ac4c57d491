/* SPDX-License-Identifier: MIT
 *
 * Synthetic ghosts for tests of the integer rasteriser.
 */
#ifndef TESTS_SUPPORT_GHOSTS_H
#define TESTS_SUPPORT_GHOSTS_H

#include "glint/flare.h"

enum { WIDTH = 203, HEIGHT = 151, N_GHOSTS = 6 };

/* A synthetic ghost: a grid of N x N cells over +-1.25 stop radii, scaled,
 * sheared and bent. */
struct ghost {
    int n;
    int cx, cy; /* centre, pixels */
    int size;   /* pixels per stop radius of the ghost's image */
    int bend;   /* quadratic distortion, 1/1000 of size */
    int mirror; /* -1: mirrored */
    /* offset of the barrel aperture from the centre of the stop, 1/1000 of the
     * stop radius */
    int barrel_shift;
    int32_t flux_exponent;
    int32_t rgb_q14[3];
};

extern const struct ghost ghosts[N_GHOSTS];

/* Returns a configuration with an octagonal stop and memory for all ghosts. */
struct glint_flare_config make_octagonal_stop_config(void);

/* Allocates and returns a flare with configuration C. Sets *MEM to its memory,
 * which the caller frees. */
struct glint_flare *allocate_flare(struct glint_flare_config *c, void **mem);

/* Returns the vertex in column I and row J of G's grid. */
struct glint_vertex compute_ghost_vertex(const struct ghost *g, int i, int j);

void add_ghost_to_flare(struct glint_flare *f, const struct ghost *g);

/* Clears the samples PX[HEIGHT][WIDTH][3] and returns a linear image that
 * contains them. */
struct glint_image make_linear_image(int32_t *px);

/* draw_ghost_list() draws the N ghosts of LIST into OUT[HEIGHT][WIDTH][3],
 * linear light Q20; draw_scene() draws the global list `ghosts`. */
struct glint_flare_stats draw_ghost_list(struct glint_flare_config c,
                                         const struct ghost *list, int n,
                                         int32_t *out);
struct glint_flare_stats draw_scene(struct glint_flare_config c, int32_t *out);

/* Draws all ghosts into `pixels` and checks that `pixels` equals `want`. */
extern int32_t pixels[3 * WIDTH * HEIGHT], want[3 * WIDTH * HEIGHT];
void assert_pixels_equal_want(struct glint_flare_config c);

/* Returns the sum of CHANNEL over all pixels, 1 = white. */
double sum_channel_light(const int32_t *p, int channel);

/* Returns the next random number, 0 .. N - 1. */
int draw_random_number(int n);

/* Returns a random ghost in or near the image, folded or not. */
struct ghost make_random_ghost(void);

#endif
