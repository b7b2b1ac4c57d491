/* SPDX-License-Identifier: MIT
 *
 * model_summary.h - size and errors of a baked lens, summed over its polynomial
 * systems, for reports.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_SUMMARY_H
#define GLINT_TOOLS_MODEL_MODEL_SUMMARY_H

#include "model/model_file.h"

extern const char *const model_output_names[GLINT_OUT_KINDS];
extern const char *const model_output_units[GLINT_OUT_KINDS];

/* Error targets of the outputs. An output meets its target if the 99th
 * percentile of its error does not exceed the target. The target of positions
 * is a quarter of a pixel in images of 1920 pixels width. Errors of this size
 * in other outputs are about as visible. */
extern const double model_output_targets[GLINT_OUT_KINDS];

const char *model_get_basis_name(const struct glint_lens *lens);
double model_convert_sine_to_deg(int32_t sine_q30);

/* Returns the wavelength in nm. WAVE_Q24: its inverse square, 1 / um^2. */
double model_convert_wave_to_nm(int32_t wave_q24);

/* A range of a model's polynomial systems: numbers FIRST to FIRST + N - 1 */
struct model_span {
    uint32_t first, n;
};

struct model_span model_get_full_span(const struct glint_lens *lens);
struct model_span model_measure_ghost_span(const struct glint_lens *lens,
                                           uint32_t ghost);

const struct glint_model_output *
model_outputs_of(const struct glint_lens *lens,
                 const struct glint_model_system *system);

/* Returns the bytes that SPAN would occupy in the file if its systems shared
 * no data. */
size_t model_count_span_bytes(const struct glint_lens *lens,
                              struct model_span span);

/* Sets RANGE_DEG to the min and max angle that SPAN covers. */
void model_find_span_angles(const struct glint_lens *lens,
                            struct model_span span, double range_deg[2]);

/* Errors of one output, combined over the N systems of a span that have this
 * output. */
struct model_errors {
    uint32_t n;
    /* means over the systems: number of polynomial terms, squared error, and
     * median error */
    double terms, mean2, p50;
    /* maxima over the systems, in the unit of the output */
    double p99, max, bound, rounding;
};

struct model_summary {
    struct model_errors of[GLINT_OUT_KINDS];
};

struct model_summary model_compute_summary(const struct glint_lens *lens,
                                           struct model_span span);

/* Returns the number of polynomial terms, summed over all outputs. */
double model_count_terms(const struct model_summary *sum);

/* Returns the mean number of polynomial terms per output. */
double model_compute_mean_terms(const struct model_summary *sum);

/* Returns whether any output misses its target. */
bool model_misses_error_target(const struct model_summary *sum);

/* Returns the number of ghosts; ghosts whose pupil has several parts count
 * once. */
uint32_t model_count_ghosts(const struct glint_lens *lens);

/* Returns the number of the ghost of ENTRY. An entry of a model is a ghost or a
 * further part of a ghost's pupil. */
uint32_t model_find_ghost_of_entry(const struct glint_lens *lens,
                                   uint32_t entry);

/* Where the errors of a ghost exceed their targets. A zone is a range of field
 * angles that shares one set of polynomials. */
struct model_miss {
    /* number of zones, counted for each part of the pupil, in which an error
     * exceeds its target */
    uint32_t zones;
    double angle_deg[2]; /* min and max angle of these zones */
    int output;          /* output with the largest ratio of error to target */
    /* 99th percentile of this output's error, and its ratio to the target */
    double p99, over;
};

/* Returns where errors of GHOST, in any part of its pupil, exceed their
 * targets. */
struct model_miss model_find_missed_zones(const struct glint_lens *lens,
                                          uint32_t ghost);

/* Returns the number of ghosts with an error above its target. */
unsigned model_count_ghosts_with_missed_targets(const struct glint_lens *lens);

#endif
