/* SPDX-License-Identifier: MIT
 *
 * glint/scene/translucent_bake.h - scattering below the surface of a
 * translucent medium, computed or measured, and fitted by a few kernels, in
 * double precision.
 *
 *     glint_stone_defaults(&stone);
 *     glint_scatter_compute(&stone, &watch, &rows, &error);
 *     glint_scatter_fit(&rows, &options, &watch, &fit);
 *     glint_scatter_light(&fit, irradiance, radiosity);
 *     glint_scatter_fit_close(&fit);
 *     glint_scatter_close(&rows);
 *
 *   in   two materials and where each is on a square of texels; or rows that
 *        were measured
 *   out  R_d as rows: R'(x_i, d = x_o - x_i), the fraction of the light that
 * falls on texel x_i and leaves by texel x_o, for all d of a square kernel; and
 * fits of it: clustered, factored, albedo times one kernel
 *
 * An offset d = (u, v), each -kernel / 2 .. kernel / 2 across and down, is
 * entry (v + kernel / 2) * kernel + u + kernel / 2 of a kernel. Rows are 0
 * where x_o is outside the square: light that gets there is lost. Channels
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
    GLINT_SCATTER_MAX_SIDE = 256, /* texels of a translucent medium, each way */
    GLINT_SCATTER_MAX_KERNEL = 63, /* texels of a kernel, each way */
    GLINT_SCATTER_MAX_TERMS = 20,  /* of a factored fit; kernels of others */
    GLINT_SCATTER_MAX_RANK = 8
};

/* ------------------------------------------------------------- the translucent
 * medium */

struct glint_stone_material {
    double scatter[3]; /* reduced scattering coefficient, 1/mm, 1e-3 .. 1e3 */
    double absorb[3];  /* absorption coefficient, 1/mm, 0 .. 1e3 */
};

enum glint_stone_pattern {
    GLINT_STONE_EVEN,  /* material 0 alone */
    GLINT_STONE_CHESS, /* fields x fields squares, material 0 at the top left */
    GLINT_STONE_VEINS, /* material 1 in veins through material 0, by seed */
    GLINT_STONE_MASK   /* material 0 by the fraction in mask */
};

/* A slab; one face is lit and seen. */
struct glint_stone {
    int side;        /* texels each way, 1 .. GLINT_SCATTER_MAX_SIDE */
    int kernel;      /* texels each way, odd, 1 .. GLINT_SCATTER_MAX_KERNEL */
    double texel_mm; /* 0.01 .. 100 */
    double slab_mm;  /* thickness, 0.1 .. 1000 */
    double index;    /* of refraction, against air, 1 .. 3 */
    struct glint_stone_material material[2];
    enum glint_stone_pattern pattern;
    int fields;         /* of chess, each way, 1 .. side */
    uint32_t seed;      /* of veins */
    const double *mask; /* [side][side], 0 .. 1; for GLINT_STONE_MASK, else
                           NULL */
};

/* Sets STONE to 128 texels of 0.61 mm, kernels of 29, 6 mm,
 * index 1.5, marble of [Jensen01] and a darker translucent medium, chess of 8
 * x 8. */
void glint_stone_defaults(struct glint_stone *stone);

/* -------------------------------------------------------------- its rows */

/* Progress and cancellation. All members may be NULL; so may the struct. */
struct glint_watch {
    glint_progress_fn *progress;
    bool (*stop)(void *ctx); /* asked as often; true: ends with
                                GLINT_E_CLOSED */
    void *ctx;
};

/* Owned: all is malloc'ed. */
struct glint_scatter_rows {
    int side, kernel;
    float *r;      /* [side * side][3][kernel * kernel], row by row */
    double *share; /* [side * side] fraction of material 0; NULL: measured */
};

/* Computes ROWS of STONE by diffusion in the slab [Jensen01], each entry at
 * least 0, the sum of a row at most 1; R'(x, y - x) = R'(y, x - y). Uses 12
 * bytes per entry and about 25 MB besides; 128 texels with kernels of 29 use
 * 158 MiB. GLINT_E_ARGUMENT: ERROR names what is out of range. GLINT_E_MEMORY,
 * GLINT_E_CLOSED: ROWS is empty. */
enum glint_status glint_scatter_compute(const struct glint_stone *stone,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_rows *rows,
                                        struct glint_error *error);

/* Reads measured rows: PICTURE has SIDE x SIDE tiles of KERNEL x KERNEL pixels,
 * each the row of a texel. Numbers below 0 or not finite become 0 and are
 * counted in HELD, what lies outside the square becomes 0.
 * GLINT_E_UNSUPPORTED: PICTURE has another size. */
enum glint_status glint_scatter_read(const struct glint_float_image *picture,
                                     int side, int kernel,
                                     struct glint_scatter_rows *rows,
                                     long long *held,
                                     struct glint_error *error);

void glint_scatter_close(struct glint_scatter_rows *rows);

/* Sets RADIOSITY[side * side][3] to the product of ROWS and IRRADIANCE, which
 * has the same shape. */
void glint_scatter_light_rows(const struct glint_scatter_rows *rows,
                              const double *irradiance, double *radiosity);

/* ------------------------------------------------------------------ fits */

/* What changes from texel to texel scales light where it leaves, as that is
 * what is seen: with weights at x_i, edges of a pattern are as wide as a kernel
 * (15 to 20 dB on chess). */
enum glint_scatter_model {
    /* R' = in(x_i) h_c(d) out(x_o), c the cluster of x_o */
    GLINT_SCATTER_CLUSTERED,
    /* R' = sum over j of h_j(d) f_j(x_o), h_j(u, v) = sum over q of
     * column_jq(v) row_jq(u) */
    GLINT_SCATTER_FACTORED,
    /* R' = h(d) out(x_o), where the kernel h sums to 1 */
    GLINT_SCATTER_ALBEDO
};

struct glint_scatter_options {
    enum glint_scatter_model model;
    int kernels; /* clusters or terms, 1 .. GLINT_SCATTER_MAX_TERMS; of albedo
                    1 */
    int rank;    /* of each h of the factored model, 1 ..
                    GLINT_SCATTER_MAX_RANK */
};

/* How far a fit is from its rows. Decibels are 10 log10(peak^2 / mean squared
 * error), 999 for no error. */
struct glint_scatter_error {
    double rmse;     /* of all entries, the largest entry = 1 */
    double entry_db; /* the same in decibels */
    double light_db; /* of the radiosity under lamps, shadows and a ramp, its
                        peak = 1 */
    double albedo;   /* largest error of the sum of a row: of energy */
};

/* Owned: all pointers are malloc'ed, or NULL where a model has no such part. */
struct glint_scatter_fit {
    enum glint_scatter_model model;
    int side, kernel, kernels, rank;
    double *h;      /* [kernels][3][kernel * kernel] */
    double *column; /* factored: [kernels][3][rank][kernel], down */
    double *row;    /* the same, across */
    double *f;      /* factored: [kernels][3][side * side] */
    double *in;     /* clustered: [side * side][3] */
    double *out;    /* clustered, albedo: [side * side][3] */
    double *albedo; /* [side * side][3]: what each texel shows of even light of
                       1, which all fits keep */
    uint8_t *cluster; /* clustered: [side * side], below kernels */
    struct glint_scatter_error error;
};

/* Sets OPTIONS to MODEL with 4 clusters, or 5 terms of rank 3. */
void glint_scatter_defaults(struct glint_scatter_options *options,
                            enum glint_scatter_model model);

/* Fits ROWS, which are turned meanwhile and the same afterwards, and measures
 * FIT. GLINT_E_ARGUMENT: OPTIONS are out of range.
 * GLINT_E_MEMORY, GLINT_E_CLOSED: FIT is empty. */
enum glint_status glint_scatter_fit(struct glint_scatter_rows *rows,
                                    const struct glint_scatter_options *options,
                                    const struct glint_watch *watch,
                                    struct glint_scatter_fit *fit);

void glint_scatter_fit_close(struct glint_scatter_fit *fit);

/* Returns entry D of channel C of the row of texel X as FIT has it. */
double glint_scatter_entry(const struct glint_scatter_fit *fit, int x, int c,
                           int d);

/* Sets RADIOSITY[side * side][3] to what FIT makes of IRRADIANCE; may be below
 * 0. */
void glint_scatter_light(const struct glint_scatter_fit *fit,
                         const double *irradiance, double *radiosity);

/* Sets IRRADIANCE[side * side][3] to the light that glint_scatter_error's
 * light_db is measured under. */
void glint_scatter_test_light(int side, double *irradiance);

#ifdef __cplusplus
}
#endif

#endif
