/* SPDX-License-Identifier: MIT
 *
 * Starburst: the light that the edges of the aperture stop diffract around each
 * lamp. Run-time half, integers only.
 *
 *     bytes = glint_star_count_bytes(&cfg);                       once
 *     glint_star_init(&star, &cfg, mem, bytes);
 *     glint_star_set_lights(star, &tables, lights, n, faintest);   each frame
 *     glint_star_draw(star, flare, &image);      instead of glint_flare_draw()
 *
 * The image of a point light behind a stop is the stop's Fraunhofer pattern,
 * integrated over the spectrum and over each pixel. It is drawn as the sum of
 * three components from tables:
 *
 *   lines   light that a pair of parallel edges diffracts at right angles to
 *           both edges, to either side: a profile across the line / distance^2
 *   halo    the smooth rest of the far field: tails of the profiles, and light
 *           from the corners; for a circular stop, the whole far field
 *   core    the exact pattern minus lines and halo, near the light, on a
 *           lattice finer than pixels; not drawn for lamps that the picture
 *           itself shows
 *
 * Only pixels where a fraction of a code is visible are drawn. The caller owns
 * all memory. Drawing cannot fail and is bit-identical for any number of
 * workers and any tile size.
 */
#ifndef GLINT_STAR_STARBURST_H
#define GLINT_STAR_STARBURST_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/light.h"
#include "glint/status.h"
#include "glint/workers.h"
#include "kernels/halo.h"
#include "star/smeared.h"
#include "tile/pass.h"

enum {
    GLINT_STAR_PROFILE = 128, /* number of steps of a line profile */
    GLINT_STAR_CORE = 48, /* number of lattice steps from the centre of the core
                             table to its rim */
    /* number of halo tables for extended lamps; table i is for a radius of 2^(i
     * - 1) pixels */
    GLINT_STAR_WIDE = 9,
    GLINT_STAR_MAX_LIGHTS = 4096
};

/* A line of a starburst: the light diffracted by one edge of the stop, or by a
 * pair of parallel edges. Coordinates are in pixels relative to the lamp, y
 * down. u = x cos + y sin runs along the line, v = y cos - x sin across it. */
struct glint_star_line {
    /* direction of the line, 0 <= angle < 180 degrees */
    int32_t cos_q30, sin_q30;
    int32_t cot_q16;    /* cos / sin of the angle, clamped to +-2^12 */
    int32_t across_q16; /* 1 / sin of the angle, at most 2^12 */
    /* Profile across the line. Entry i is the light at v = i reach / 128, times
     * r^2 / (1 - (v / r)^2), where r is the distance from the lamp, in units of
     * member step of the tables. Entries from 128 on are 0. */
    uint16_t profile[GLINT_STAR_PROFILE + 2][3];
};

/* Tables of the starburst of a light of power 1, for one stop, f-number and
 * pixel size. */
struct glint_star_tables {
    int n_lines; /* number of lines, 1 .. GLINT_MAX_BLADES; LINE is sorted by
                    angle */
    const struct glint_star_line *line;
    /* unit of the line profiles: light where a profile is 1 */
    struct glint_real step;
    /* For each step of the profiles, the max value over all lines and
     * channels. */
    uint16_t line_max[GLINT_STAR_PROFILE];
    int32_t reach_q8;           /* distance from the line at which profiles end,
                                   1 .. 2^14 pixels */
    int32_t reach_log2_q16;     /* log2 of reach_q8 */
    int32_t per_pixel_q16;      /* profile steps per pixel, at most 128 */
    int32_t pixels_q16;         /* number of pixels per profile step */
    int32_t core_per_pixel_q16; /* lattice steps of the core table per pixel, 1
                                   .. 4 */
    /* full width at half maximum of the profiles, pixels */
    int32_t width_q8;
    int32_t inner_q8; /* distance from the lamp, pixels, up to which light does
                         not fall with 1 / r^2 */
    /* Halo of a point light. With r, the distance from the lamp in pixels, log2
     * of light times r^2 is halo_log2_q16 plus the entry of HALO, _q11.
     * halo_max: max of each row. */
    int32_t halo_log2_q16;
    uint16_t halo[GLINT_STAR_HALO_ROWS][GLINT_STAR_HALO_COLUMNS][3];
    uint16_t halo_max[GLINT_STAR_HALO_ROWS];
    /* Halos that are blurred by the discs of lamps,
     * [GLINT_STAR_WIDE][GLINT_STAR_HALO_ROWS]; table i is for a radius of 2^(i
     * - 1) pixels. NULL for stops with straight hard edges: their halos have no
     * fans of light and are not blurred. */
    const glint_star_halo_row *wide;
    /* Diffraction by dirt in the stop, or NULL. */
    const struct glint_star_smear *smear;
    /* Core table, rows for y >= 0 only. The other half is the point reflection
     * of this half through the centre. Entries are 16-bit floating-point
     * numbers, _q40, with a sign, five bits e and ten bits m. The value is (m +
     * 1024) 2^(e - 1), or m if e is 0. */
    uint16_t core[GLINT_STAR_CORE + 1][2 * GLINT_STAR_CORE + 1][3];
};

/* A lamp at its position in the picture. */
struct glint_star_light {
    int32_t x_q8, y_q8; /* position, pixels from the top left corner */
    /* Radius of the lamp's disc, 0 .. 2^14 pixels; a larger disc has wider
     * lines. Negative if the picture does not show the lamp: its core is then
     * drawn, too. */
    int32_t radius_q8;
    /* power, display white times pixels; clamped to 2^30 */
    struct glint_real power;
    int32_t rgb_q14[3]; /* colour, 0 .. 2^14 */
};

struct glint_star_config {
    int n_workers;     /* max number of workers of the flare with which the
                          starburst is drawn, 1 .. 64 */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    int max_lights;    /* max number of lights, 1 .. GLINT_STAR_MAX_LIGHTS */
    unsigned sets;     /* GLINT_SET_ bits of the kernels to use */
};

/* struct glint_star is opaque, in the caller's memory. */
struct glint_flare;

/* Returns the exact number of bytes that glint_star_init() needs for CFG, or 0
 * if CFG is out of range. */
size_t glint_star_count_bytes(const struct glint_star_config *cfg);

/* Initialises a starburst in MEM[BYTES], which must be aligned to 64 bytes;
 * nothing has to be freed. Returns GLINT_E_MEMORY if BYTES is too small,
 * GLINT_E_ARGUMENT if CFG is out of range. */
enum glint_status glint_star_init(struct glint_star **star,
                                  const struct glint_star_config *cfg,
                                  void *mem, size_t bytes);

/* Sets the N lights to draw. TABLES must stay valid while the starburst is
 * drawn, LIGHTS need not. Lights from index max_lights on are skipped. Pixels
 * where a light adds less than FAINTEST are not drawn; FAINTEST is in display
 * white and must be 0 or at least 2^-21. */
void glint_star_set_lights(struct glint_star *star,
                           const struct glint_star_tables *tables,
                           const struct glint_star_light *lights, int n,
                           struct glint_real faintest);

/* Estimates the number of pixels that lines, halos, smears and cores light. A
 * pixel lit by several of them counts several times. The drawing time is
 * proportional to this number. */
int64_t glint_star_estimate_pixels(const struct glint_star *star);

/* Draws the starburst and the binned ghosts of FLARE onto IMAGE, in place of
 * glint_flare_draw(). The starburst has full resolution even if the flare is
 * drawn at half resolution. */
void glint_star_draw(struct glint_star *star, struct glint_flare *flare,
                     const struct glint_image *image);

/* Returns a pass that draws the starburst onto IMAGE, to be combined with other
 * passes. */
struct glint_pass glint_star_make_pass(struct glint_star *star,
                                       const struct glint_image *image);

/* Draws the starburst onto IMAGE, with the workers and tiles of FLARE but
 * without its ghosts. */
void glint_star_draw_alone(struct glint_star *star, struct glint_flare *flare,
                           const struct glint_image *image);

#endif
