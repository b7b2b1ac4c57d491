/* SPDX-License-Identifier: MIT
 *
 * glint/scene/translucent_bake.h - scattering below the surface of a
 * translucent medium, computed or measured, and its approximation by a few
 * kernels, in double precision.
 *
 *     glint_stone_defaults(&stone);
 *     glint_scatter_compute(&stone, &watch, &rows, &error);
 *     glint_scatter_fit(&rows, &options, &watch, &fit);
 *     glint_scatter_light(&fit, irradiance, radiosity);
 *     glint_scatter_fit_close(&fit);
 *     glint_scatter_close(&rows);
 *
 *   in   two materials and their distribution over a square of texels; or
 *        measured rows
 *   out  R_d as rows, one for each texel x_i: R'(x_i, d = x_o - x_i), the
 *        fraction of the light that falls on x_i and leaves from texel x_o, for
 *        all d of a square kernel; and approximations of the rows by a fit:
 *        clustered, factored, or albedo times one kernel
 *
 * An offset d = (u, v), each -kernel / 2 .. kernel / 2 across and down, is
 * entry (v + kernel / 2) * kernel + u + kernel / 2 of a kernel. Rows are 0
 * where x_o is outside the square: light that leaves there is lost. Channels
 * are R, G, B. The same input gives the same numbers. */
#ifndef GLINT_SCENE_TRANSLUCENT_BAKE_H
#define GLINT_SCENE_TRANSLUCENT_BAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_SCATTER_MAX_SIDE = 256,  /* max texels per side of a translucent
                                      medium */
    GLINT_SCATTER_MAX_KERNEL = 63, /* max texels per side of a kernel */
    GLINT_SCATTER_MAX_TERMS = 20,  /* max terms of a factored fit, or kernels of
                                      other fits */
    GLINT_SCATTER_MAX_RANK = 8
};

/* ------------------------------------------------------------ the medium */

struct glint_stone_material {
    double scatter[3]; /* reduced scattering coefficient, 1/mm, 1e-3 .. 1e3 */
    double absorb[3];  /* absorption coefficient, 1/mm, 0 .. 1e3 */
};

enum glint_stone_pattern {
    GLINT_STONE_EVEN,  /* material 0 alone */
    GLINT_STONE_CHESS, /* a chessboard of fields x fields squares, material 0 at
                          the top left */
    GLINT_STONE_VEINS, /* veins of material 1 in material 0, placed by seed */
    GLINT_STONE_MASK   /* mask is the fraction of material 0 */
};

/* A slab of a translucent medium; one face is lit and visible. */
struct glint_stone {
    int side;        /* texels per side, 1 .. GLINT_SCATTER_MAX_SIDE */
    int kernel;      /* texels per side of a kernel, odd, 1 ..
                        GLINT_SCATTER_MAX_KERNEL */
    double texel_mm; /* side of a texel, 0.01 .. 100 */
    double slab_mm;  /* thickness, 0.1 .. 1000 */
    double index;    /* index of refraction relative to air, 1 .. 3 */
    struct glint_stone_material material[2];
    enum glint_stone_pattern pattern;
    /* Number of squares along each side of the slab for GLINT_STONE_CHESS, 1 ..
     * side. */
    int fields;
    uint32_t seed; /* seed of GLINT_STONE_VEINS */
    /* Fraction of material 0 at each texel, [side][side], 0 .. 1, for
     * GLINT_STONE_MASK; else NULL. */
    const double *mask;
};

/* Sets STONE to 128 texels per side of 0.61 mm, kernels of 29 texels, a slab of
 * 6 mm, index 1.5, and a chessboard of 8 x 8 squares of the marble of
 * [Jensen01] and a darker material. */
void glint_stone_defaults(struct glint_stone *stone);

/* -------------------------------------------------------------- its rows */

/* Progress and cancellation. All members may be NULL; so may the struct. */
struct glint_watch {
    glint_progress_fn *progress;
    /* Called as often as progress; if it returns true, the function ends with
     * GLINT_E_CLOSED. */
    bool (*stop)(void *ctx);
    void *ctx;
};

/* Rows of R_d. Arrays are malloc'ed; glint_scatter_close() frees them. */
struct glint_scatter_rows {
    int side, kernel;
    float *r; /* entries of all rows, [side * side][3][kernel * kernel], row by
                 row */
    /* Fraction of material 0 at each texel, [side * side]; NULL: the rows were
     * measured. */
    double *share;
};

/* Computes ROWS of STONE by diffusion in the slab [Jensen01]. Each entry is at
 * least 0, the sum of a row at most 1, and R'(x, y - x) = R'(y, x - y). Uses 12
 * bytes per entry plus about 25 MB: 158 MiB for 128 texels per side with
 * kernels of 29 texels. On GLINT_E_ARGUMENT, ERROR names the member that is out
 * of range. On GLINT_E_MEMORY or GLINT_E_CLOSED, ROWS is empty. */
enum glint_status glint_scatter_compute(const struct glint_stone *stone,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_rows *rows,
                                        struct glint_error *error);

/* Reads measured rows: PICTURE has SIDE x SIDE tiles of KERNEL x KERNEL pixels;
 * each tile is the row of a texel. Numbers that are negative or not finite
 * become 0 and are counted in *HELD. Entries outside the square become 0.
 * Returns GLINT_E_UNSUPPORTED if PICTURE has another size. */
enum glint_status glint_scatter_read(const struct glint_float_image *picture,
                                     int side, int kernel,
                                     struct glint_scatter_rows *rows,
                                     long long *held,
                                     struct glint_error *error);

void glint_scatter_close(struct glint_scatter_rows *rows);

/* Sets RADIOSITY[side * side][3] to the light that ROWS make of IRRADIANCE[side
 * * side][3]. */
void glint_scatter_light_rows(const struct glint_scatter_rows *rows,
                              const double *irradiance, double *radiosity);

/* ------------------------------------------------------------------ fits */

/* Models of a fit. Some weights vary between texels. They scale the light where
 * it leaves (x_o) and is visible, because weights at x_i would blur the edges
 * of a pattern to the width of a kernel (15 to 20 dB worse on
 * GLINT_STONE_CHESS). */
enum glint_scatter_model {
    /* R' = in(x_i) h_c(d) out(x_o), where c is the cluster of x_o */
    GLINT_SCATTER_CLUSTERED,
    /* R' = sum over j of h_j(d) f_j(x_o), h_j(u, v) = sum over q of
     * column_jq(v) row_jq(u) */
    GLINT_SCATTER_FACTORED,
    /* R' = h(d) out(x_o), where the kernel h sums to 1 */
    GLINT_SCATTER_ALBEDO
};

struct glint_scatter_options {
    enum glint_scatter_model model;
    int kernels; /* clusters or terms, 1 .. GLINT_SCATTER_MAX_TERMS; 1 for
                    GLINT_SCATTER_ALBEDO */
    int rank;    /* rank of each h of the factored model, 1 ..
                    GLINT_SCATTER_MAX_RANK */
};

/* Error of a fit. Decibels are 10 log10(peak^2 / mean squared error); 999 if
 * there is no error. */
struct glint_scatter_error {
    double rmse;     /* RMS error of all entries, relative to the largest
                        entry */
    double entry_db; /* rmse in decibels */
    double light_db; /* error of the radiosity under glint_scatter_test_light(),
                        relative to its peak, in decibels */
    /* Max error of the sum of a row; the sum is a fraction of energy. */
    double albedo;
};

/* A fit. Arrays are malloc'ed, or NULL if the model does not use them;
 * glint_scatter_fit_close() frees them. */
struct glint_scatter_fit {
    enum glint_scatter_model model;
    int side, kernel, kernels, rank;
    double *h;      /* [kernels][3][kernel * kernel] */
    double *column; /* vertical factors of the factored model,
                       [kernels][3][rank][kernel] */
    double *row;    /* horizontal factors of the factored model, likewise */
    double *f;  /* weights f of the factored model, [kernels][3][side * side] */
    double *in; /* weights in(x_i) of the clustered model, [side * side][3] */
    double *out; /* weights out(x_o) of the clustered and albedo models, [side *
                    side][3] */
    /* Light that leaves each texel under uniform light of 1, [side * side][3];
     * the same in all fits of the same rows. */
    double *albedo;
    /* Index of each texel's cluster in the clustered model, [side * side],
     * below kernels. */
    uint8_t *cluster;
    struct glint_scatter_error error;
};

/* Sets OPTIONS to MODEL with 4 clusters, or with 5 terms of rank 3. */
void glint_scatter_defaults(struct glint_scatter_options *options,
                            enum glint_scatter_model model);

/* Makes FIT, which approximates ROWS, and measures its error. ROWS are
 * transposed during the call and restored before it returns. Returns
 * GLINT_E_ARGUMENT if OPTIONS are out of range. On GLINT_E_MEMORY or
 * GLINT_E_CLOSED, FIT is empty. */
enum glint_status glint_scatter_fit(struct glint_scatter_rows *rows,
                                    const struct glint_scatter_options *options,
                                    const struct glint_watch *watch,
                                    struct glint_scatter_fit *fit);

void glint_scatter_fit_close(struct glint_scatter_fit *fit);

/* Returns the value that FIT gives entry D of channel C of the row of texel
 * X. */
double glint_scatter_entry(const struct glint_scatter_fit *fit, int x, int c,
                           int d);

/* Sets RADIOSITY[side * side][3] to the light that FIT makes of IRRADIANCE[side
 * * side][3]; values may be negative. */
void glint_scatter_light(const struct glint_scatter_fit *fit,
                         const double *irradiance, double *radiosity);

/* Sets IRRADIANCE[side * side][3] to the test light for light_db of struct
 * glint_scatter_error: lamps, shadows and a ramp. */
void glint_scatter_test_light(int side, double *irradiance);

#ifdef __cplusplus
}
#endif

#endif
