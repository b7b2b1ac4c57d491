/* SPDX-License-Identifier: MIT
 *
 * The starburst: light that the stop's edges diffract, around each lamp, in
 * integers.
 *
 *     bytes = glint_star_bytes(&cfg);                       once
 *     glint_star_init(&star, &cfg, mem, bytes);
 *     glint_star_set(star, &tables, lights, n, faintest);   each frame
 *     glint_star_draw(star, flare, &image);      rather than glint_flare_draw()
 *
 * The picture of a point behind a stop is its Fraunhofer pattern, summed over
 * the spectrum and over each pixel. It is drawn as the sum of three parts from
 * tables:
 *
 *   lines   light that a pair of parallel edges throws to both sides, across
 *           them: a profile across the line, over the square of the distance
 *   halo    the far field less the lines, which is smooth: tails of the
 *           profiles and light from the corners; for a circle, all of it
 *   core    the exact pattern less lines and halo, near the light, on a lattice
 *           finer than pixels; not drawn for lamps whose own core the picture
 *           shows
 *
 * Only pixels where a fraction of a code is visible cost time. All memory is
 * the caller's; drawing cannot fail, and gives the same bits for any number of
 * workers and any tile size. */
#ifndef GLINT_STAR_STARBURST_H
#define GLINT_STAR_STARBURST_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/light.h"
#include "glint/status.h"
#include "glint/workers.h"
#include "star/smeared.h"
#include "tile/pass.h"

enum {
    GLINT_STAR_PROFILE = 128, /* steps of a profile */
    GLINT_STAR_CORE = 48,     /* steps from the core's middle to its rim */
    /* Two rows for each octave of r^2, from 2^4 px^2 on. */
    GLINT_STAR_HALO_ROWS = 45,
    GLINT_STAR_HALO_COLUMNS = 49, /* four columns for each octave of 1 + 4 v /
                                     reach */
    GLINT_STAR_WIDE = 9, /* halos of fans for lamps of radius 2^(i - 1) px */
    GLINT_STAR_MAX_LIGHTS = 4096
};

/* A line: light of a pair of parallel edges, or of one edge. U is measured
 * along the line, V across: u = x cos + y sin, v = y cos - x sin, pixels, y
 * down. */
struct glint_star_line {
    /* direction of the line, from 0 to below 180 degrees */
    int32_t cos_q30, sin_q30;
    int32_t cot_q16;    /* cos / sin of that angle, clamped to +-2^12 */
    int32_t across_q16; /* 1 / sin of that angle, at most 2^12 */
    int32_t border_q16; /* cot of the angle half-way to the next line */
    /* [i]: light at v = reach i / 128, times r^2 / (1 - (v / r)^2), in units of
     * the tables' step. Entries from 128 on are 0. */
    uint16_t profile[GLINT_STAR_PROFILE + 2][3];
};

/* [row][column][channel]: log2 of the light times r^2, _q11. */
typedef uint16_t glint_star_halo_row[GLINT_STAR_HALO_COLUMNS][3];

/* Tables of a star for one stop, f-number and size of pixels. */
struct glint_star_tables {
    int n_lines; /* 1 .. GLINT_MAX_BLADES, angles rising */
    const struct glint_star_line *line;
    int first; /* line of the sector that begins at angle 0: the last, or 0 */
    /* light that the value 1 stands for in all profiles */
    struct glint_real step;
    uint16_t line_max[GLINT_STAR_PROFILE]; /* largest value of all profiles */
    int32_t reach_q8;           /* reach of a profile, 1 .. 2^14 pixels */
    int32_t reach_log2_q16;     /* log2 of reach_q8 */
    int32_t per_pixel_q16;      /* steps of a profile per pixel, at most 128 */
    int32_t pixels_q16;         /* pixels per step of a profile */
    int32_t core_per_pixel_q16; /* steps of the core per pixel, 1 .. 4 */
    /* Width of the profiles at half their brightness, pixels. */
    int32_t width_q8;
    int32_t inner_q8; /* radius in pixels within which 1 / r^2 does not grow any
                         more */
    /* log2 of the light times r^2, _q11, counted from halo_log2_q16; and the
     * largest of each row. */
    int32_t halo_log2_q16;
    uint16_t halo[GLINT_STAR_HALO_ROWS][GLINT_STAR_HALO_COLUMNS][3];
    uint16_t halo_max[GLINT_STAR_HALO_ROWS];
    /* [GLINT_STAR_WIDE][GLINT_STAR_HALO_ROWS]: the halo as lamps of radius 2^(i
     * - 1) pixels blur it; NULL if the stop throws no fans; lamps then do not
     * blur its halo. */
    const glint_star_halo_row *wide;
    /* Diffraction by dirt in the stop, or NULL. */
    const struct glint_star_smear *smear;
    /* The half of the core with y from 0 on; the other half is its mirror image
     * about the middle. Each is a number of 16 bits, _q40: a sign, five bits e,
     * ten bits m. It is (m + 1024) 2^(e - 1), or m if e is 0. */
    uint16_t core[GLINT_STAR_CORE + 1][2 * GLINT_STAR_CORE + 1][3];
};

/* A lamp as the picture shows it. */
struct glint_star_light {
    int32_t x_q8, y_q8; /* pixels from the top left corner */
    int32_t radius_q8;  /* radius of the lamp's disc, 0 .. 2^14 pixels; it
                           widens lines. Negative if the picture does not show
                           the lamp: then its core is drawn as well */
    /* light, in white times pixels; more than 2^30 counts as 2^30 */
    struct glint_real power;
    int32_t rgb_q14[3]; /* colour, 0 .. 2^14 */
};

struct glint_star_config {
    int n_workers;     /* max number of workers of the flares it is drawn with,
                          1 .. 64 */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int max_lights;    /* 1 .. GLINT_STAR_MAX_LIGHTS */
};

/* struct glint_star is opaque, in the caller's memory. */
struct glint_flare;

/* Returns the exact number of bytes that glint_star_init() needs for CFG, or 0
 * if CFG is out of range. */
size_t glint_star_bytes(const struct glint_star_config *cfg);

/* Places a star in MEM[BYTES], which must be aligned to 64 bytes. A star needs
 * no cleanup. Returns GLINT_E_MEMORY if BYTES is too small. */
enum glint_status glint_star_init(struct glint_star **star,
                                  const struct glint_star_config *cfg,
                                  void *mem, size_t bytes);

/* Sets the N lights to draw. TABLES must stay valid while they are drawn,
 * LIGHTS need not. Lights beyond max_lights are skipped, and so is light below
 * FAINTEST, in display white, which must be 0 or at least 2^-21. */
void glint_star_set(struct glint_star *star,
                    const struct glint_star_tables *tables,
                    const struct glint_star_light *lights, int n,
                    struct glint_real faintest);

/* Estimates how many pixels the lines, halos, smears and cores of the star
 * light, counted once for each of these. The drawing time is proportional to
 * it. */
int64_t glint_star_pixels(const struct glint_star *star);

/* Adds the star and, over it, the binned ghosts of FLARE, as glint_flare_draw()
 * does; if the flare is drawn at half resolution, the star is still drawn to
 * all pixels. */
void glint_star_draw(struct glint_star *star, struct glint_flare *flare,
                     const struct glint_image *image);

/* Returns the star as a pass onto IMAGE, to be drawn together with other
 * passes. */
struct glint_pass glint_star_pass_on(struct glint_star *star,
                                     const struct glint_image *image);

/* Adds the star without the binned ghosts of FLARE. */
void glint_star_draw_alone(struct glint_star *star, struct glint_flare *flare,
                           const struct glint_image *image);

#endif
