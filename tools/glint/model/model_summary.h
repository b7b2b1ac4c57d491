/* SPDX-License-Identifier: MIT
 *
 * model_summary.h - size and errors of a baked lens, summed over systems, for
 * reports.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_SUMMARY_H
#define GLINT_TOOLS_MODEL_MODEL_SUMMARY_H

#include "model/model_file.h"

extern const char *const model_output_names[GLINT_OUT_KINDS];
extern const char *const model_output_units[GLINT_OUT_KINDS];

/* Largest errors at the 99th percentile with which a ghost meets its target: a
 * quarter of a pixel of 1920, and errors of like effect in other outputs. */
extern const double model_output_targets[GLINT_OUT_KINDS];

const char *model_basis_name(const struct glint_lens *lens);
double model_degrees(int32_t sine_q30);
double model_nanometres(
    int32_t wave_q24); /* converts 1 / square micrometres to nanometres */

/* Systems first .. first + n - 1. */
struct model_span {
    uint32_t first, n;
};

struct model_span model_span_of_all(const struct glint_lens *lens);
struct model_span model_span_of_ghost(const struct glint_lens *lens,
                                      uint32_t ghost);

const struct glint_model_output *
model_outputs_of(const struct glint_lens *lens,
                 const struct glint_model_system *system);

/* Returns the bytes that a span takes in the file, as if systems shared
 * none. */
size_t model_span_bytes(const struct glint_lens *lens, struct model_span span);

/* Sets RANGE_DEG to the least and largest angle that a span covers. */
void model_span_angles(const struct glint_lens *lens, struct model_span span,
                       double range_deg[2]);

/* Errors of an output over the systems of a span that have it. */
struct model_errors {
    uint32_t n;
    double terms, mean2, p50;         /* means */
    double p99, max, bound, rounding; /* worst; all in the unit of errors */
};

struct model_summary {
    struct model_errors of[GLINT_OUT_KINDS];
};

struct model_summary model_summary_of(const struct glint_lens *lens,
                                      struct model_span span);
double model_terms(const struct model_summary *sum); /* terms of all outputs */
double
model_mean_terms(const struct model_summary *sum); /* mean terms of an output */

/* Returns whether some output misses its target. */
bool model_misses(const struct model_summary *sum);

/* Returns the number of ghosts, without the further parts of their pupils. */
uint32_t model_ghost_count(const struct glint_lens *lens);

/* Returns the number of the ghost that ENTRY is, or is a part of. */
uint32_t model_ghost_of(const struct glint_lens *lens, uint32_t entry);

/* Where a ghost misses its targets. */
struct model_miss {
    uint32_t zones;      /* number of zones and parts of them; 0: it does not */
    double angle_deg[2]; /* least and largest angle of them */
    int output;          /* the one that misses its target by most */
    double p99, over;    /* its error, and that in targets */
};

/* Returns where ghost GHOST, with the further parts of its pupil, misses. */
struct model_miss model_miss_of(const struct glint_lens *lens, uint32_t ghost);

/* Returns the number of ghosts of which some part misses its target. */
unsigned model_missed_count(const struct glint_lens *lens);

#endif
