/* SPDX-License-Identifier: MIT
 *
 * Models of scattering side by side: those
 * that a run time can draw and those that were published, all rebuilt from the
 * same rows, in double precision.
 *
 *     glint_scatter_judge(&rows, &candidate, &watch, &judgement);
 *     glint_scatter_judgement_close(&judgement);
 *
 * Sizes are what the sources count: 8 bytes a number. */
#ifndef REFERENCE_SCATTER_TRANSLUCENT_REPORT_H
#define REFERENCE_SCATTER_TRANSLUCENT_REPORT_H

#include "glint/scene/translucent_bake.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_scatter_candidate_kind {
    GLINT_CANDIDATE_CLUSTERED, /* as glint_scatter_fit() */
    GLINT_CANDIDATE_FACTORED,
    GLINT_CANDIDATE_ALBEDO,
    GLINT_CANDIDATE_SVD,     /* R' = sum of f_j h_j, each channel by itself */
    GLINT_CANDIDATE_LOG_SVD, /* ln(R' / a + b) = such a sum [Kurt14] */
    GLINT_CANDIDATE_TUCKER,  /* mean of R, G, B by rank-1 fits of what is left,
                                and a polynomial of it for each row and channel
                                [Kurt14] */
    GLINT_CANDIDATE_ALS,     /* as svd, f and h not below 0 */
    GLINT_CANDIDATE_PEERS,   /* R' = G sum of f_j h_j, G the mean of a cluster,
                                f and h not below 0, weighted by G^2 [Peers06] */
    GLINT_CANDIDATE_SUBEDIT, /* R' = sqrt(P_i(r) P_o(r)), P of 12 values for
                                each texel and channel [Song09] */
    GLINT_CANDIDATES
};

struct glint_scatter_candidate {
    enum glint_scatter_candidate_kind kind;
    int terms;    /* T, S or kernels, 1 .. GLINT_SCATTER_MAX_TERMS */
    int rank;     /* of factored, 1 .. GLINT_SCATTER_MAX_RANK */
    int degree;   /* P of Tucker, 0 .. 5 */
    bool turned;  /* Tucker: rows begin with their maximum, over it */
    int clusters; /* of Peers, 1 .. GLINT_SCATTER_MAX_TERMS */
    double a, b;  /* of log_svd, a times the largest entry, both > 0; a = 0:
                     searched for, and set */
};

/* Sets CANDIDATE to KIND with 5 terms, rank 3, degree 4, one cluster. */
void glint_scatter_candidate_defaults(struct glint_scatter_candidate *candidate,
                                      enum glint_scatter_candidate_kind kind);

/* Bytes of CANDIDATE for TEXELS rows of ENTRIES each, three channels. */
double
glint_scatter_candidate_bytes(const struct glint_scatter_candidate *candidate,
                              double texels, double entries);

/* Multiplications, or roots and exponentials, that the sums of all rows take:
 * plainly, and with sums of h kept where the model is linear. */
double
glint_scatter_candidate_sums(const struct glint_scatter_candidate *candidate,
                             double texels, double entries, bool kept);

/* Owned: pointers are malloc'ed. Shares are of all entries inside the
 * square, the largest entry of the data is 1. */
struct glint_scatter_judgement {
    struct glint_scatter_candidate candidate; /* with what was searched for */
    double bytes, compression;                /* of 8-byte rows over bytes */
    double seconds;                           /* processor time of the fit */
    double rmse, entry_db, light_db;
    double p50, p95, largest; /* of the errors of texels in ERROR */
    double negative;          /* fraction of entries below 0 */
    double one_way;           /* rms of R'(x, y) - R'(y, x) */
    double energy;            /* largest sum of a row */
    double *error;            /* [side * side] rms of the row's error */
    double *light;            /* [side * side][3] radiosity under
                                 glint_scatter_test_light() */
};

/* Rebuilds ROWS by CANDIDATE and measures how far it is off. Takes as much
 * memory as ROWS again, and half as much for Tucker. ROWS are the same
 * afterwards. GLINT_E_ARGUMENT: CANDIDATE is out of range. GLINT_E_MEMORY,
 * GLINT_E_CLOSED: JUDGEMENT is empty. */
enum glint_status
glint_scatter_judge(struct glint_scatter_rows *rows,
                    const struct glint_scatter_candidate *candidate,
                    const struct glint_watch *watch,
                    struct glint_scatter_judgement *judgement);

void glint_scatter_judgement_close(struct glint_scatter_judgement *judgement);

#ifdef __cplusplus
}
#endif

#endif
