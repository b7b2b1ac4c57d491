/* SPDX-License-Identifier: MIT
 *
 * Compares models of subsurface scattering: fits that the run time can draw,
 * and published models. All are fitted to the same rows, in double precision,
 * and the rows rebuilt from them are compared.
 *
 *     glint_scatter_judge(&rows, &candidate, &watch, &judgement);
 *     glint_scatter_free_judgement(&judgement);
 *
 * Sizes are computed as in the publications: 8 bytes per number.
 */
#ifndef REFERENCE_SCATTER_TRANSLUCENT_REPORT_H
#define REFERENCE_SCATTER_TRANSLUCENT_REPORT_H

#include "glint/scene/translucent_bake.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_scatter_candidate_kind {
    /* CLUSTERED, FACTORED and ALBEDO: the models of glint_scatter_fit() */
    GLINT_CANDIDATE_CLUSTERED,
    GLINT_CANDIDATE_FACTORED,
    GLINT_CANDIDATE_ALBEDO,
    /* singular value decomposition per channel: row R' = sum of f_j h_j */
    GLINT_CANDIDATE_SVD,
    /* decomposition of logarithms: ln(R' / a + b) = sum of f_j h_j [Kurt14] */
    GLINT_CANDIDATE_LOG_SVD,
    /* [Kurt14]: the mean of R, G, B is modelled by successive rank-1 fits of
     * the residual, and each row and channel by a polynomial of this mean */
    GLINT_CANDIDATE_TUCKER,
    GLINT_CANDIDATE_ALS, /* like SVD, with f and h non-negative */
    /* [Peers06]: R' = G sum of f_j h_j, where G is the mean row of a cluster. f
     * and h are non-negative; errors are weighted by G^2. */
    GLINT_CANDIDATE_PEERS,
    /* [Song09]: R' = sqrt(P_i(r) P_o(r)), where P are radial profiles of the
     * texels where light enters (i) and leaves (o), 12 values per texel and
     * channel */
    GLINT_CANDIDATE_SUBEDIT,
    GLINT_CANDIDATES
};

struct glint_scatter_candidate {
    enum glint_scatter_candidate_kind kind;
    int terms;  /* terms or kernels, 1 .. GLINT_SCATTER_MAX_TERMS */
    int rank;   /* rank of FACTORED, 1 .. GLINT_SCATTER_MAX_RANK */
    int degree; /* degree P of TUCKER's polynomial, 0 .. 5 */
    /* TUCKER: each row is rotated to begin with its largest entry, and divided
     * by it */
    bool turned;
    int clusters; /* PEERS: clusters, 1 .. GLINT_SCATTER_MAX_TERMS */
    /* parameters a and b of LOG_SVD, both > 0; a is relative to the largest
     * entry. If a is 0, the fit searches for both and sets them. */
    double a, b;
};

/* Sets CANDIDATE to model KIND with 5 terms, rank 3, degree 4, one cluster. */
void glint_scatter_set_default_candidate(
    struct glint_scatter_candidate *candidate,
    enum glint_scatter_candidate_kind kind);

/* Returns the size in bytes of the model CANDIDATE for TEXELS rows of ENTRIES
 * entries each, three channels. */
double
glint_scatter_candidate_bytes(const struct glint_scatter_candidate *candidate,
                              double texels, double entries);

/* Returns the number of multiplications (or roots and exponentials) that the
 * sums of all rows need. KEPT: linear models use stored sums of their
 * kernels. */
double
glint_scatter_candidate_sums(const struct glint_scatter_candidate *candidate,
                             double texels, double entries, bool kept);

/* Errors of a model. Owns the arrays error and light. Fractions refer to all
 * entries inside the square. Errors are relative to the largest entry of the
 * data. */
struct glint_scatter_judgement {
    /* the candidate, with a and b if the fit searched for them */
    struct glint_scatter_candidate candidate;
    /* bytes: model size; compression: size of the rows, 8 bytes per number,
     * divided by the model size */
    double bytes, compression;
    double seconds; /* processor time of the fit */
    double rmse, entry_db, light_db;
    /* percentiles 50 and 95, and max, of the error map */
    double p50, p95, largest;
    double negative; /* fraction of entries that are negative */
    double one_way;  /* asymmetry: RMS of R'(x, y) - R'(y, x) */
    /* largest sum of a row; above 1 the model creates energy */
    double energy;
    /* [side * side]: RMS error of the row of each texel */
    double *error;
    /* [side * side][3] radiosity under glint_scatter_test_light() */
    double *light;
};

/* Fits CANDIDATE to ROWS, rebuilds the rows from the fit and measures their
 * errors. Needs as much memory as ROWS, and half as much more for Tucker. ROWS
 * are unchanged afterwards. Returns GLINT_E_ARGUMENT if CANDIDATE is out of
 * range. May return GLINT_E_MEMORY or GLINT_E_CLOSED. After an error JUDGEMENT
 * is empty. */
enum glint_status
glint_scatter_judge(struct glint_scatter_rows *rows,
                    const struct glint_scatter_candidate *candidate,
                    const struct glint_watch *watch,
                    struct glint_scatter_judgement *judgement);

void glint_scatter_free_judgement(struct glint_scatter_judgement *judgement);

#ifdef __cplusplus
}
#endif

#endif
