/* SPDX-License-Identifier: MIT
 *
 * A lens for tests: its table, its baked model, and images drawn by both.
 *
 *     stage_load_lens(&s, "heliar-tronnier");
 *     stage_set_up_lens(&s, 8);
 *     stage_bake_or_load_model(&s, 1, 60);
 *     stage_set_view(&s, 240, 160, 0);
 *     stage_draw_linear(&s, &lamp, 1, linear);
 *     stage_draw_exact(&s, &lamp, 1, 192, exact);
 *     stage_free(&s);
 *
 * Without a model, all rays are traced exactly. On failure functions print the
 * reason to stderr and return false.
 */
#ifndef GLINT_TESTS_STAGE_H
#define GLINT_TESTS_STAGE_H

#include <stdbool.h>

#include "engine/frame/frame.h"
#include "glint/measure.h"
#include "model/model_file.h"

struct stage {
    struct glint_prescription lens;
    struct glint_setup setup, of_model;
    struct glint_workers *workers; /* NULL: serial */
    /* baked model; if no model file is open, rays are traced exactly */
    struct model_file file;
    struct glint_bake_report report; /* filled by stage_bake_model() */
    struct glint_view view;
    struct glint_frame frame;
    bool framed;
    struct glint_engine_report drawn; /* frame statistics of the last image */
};

/* Reads lenses/NAME.lens; the current folder must be the root of the tree. */
bool stage_load_lens(struct stage *stage, const char *name);
bool stage_parse_lens(struct stage *stage, const char *text);

/* Sets up the lens with a stop of N_BLADES blades (0: a circle) and wavelengths
 * of 650, 532 and 450 nm. STAGE must not move in memory afterwards. */
bool stage_set_up_lens(struct stage *stage, int n_blades);

/* Make the model of the lens for lights up to MAX_DEG degrees.
 * stage_bake_model() always bakes; stage_bake_or_load_model() uses the model
 * cache (tools/glint/model/model_cache.h). */
bool stage_bake_model(struct stage *stage, double tolerance, double max_deg);
bool stage_bake_or_load_model(struct stage *stage, double tolerance,
                              double max_deg);

/* Stops the lens down to F_NUMBER. The view does not change, nor the model,
 * which was baked for a wider stop. */
bool stage_stop_down(struct stage *stage, double f_number);

/* Sets the image size, WIDTH x HEIGHT pixels; the width of the image on the
 * sensor, SENSOR_MM (0: that of the lens table); and the default quality
 * parameters: irradiance steps of 1 %, fineness 64, all instruction sets. May
 * be called again. */
void stage_set_view(struct stage *stage, int width, int height,
                    double sensor_mm);

/* Loads lens NAME and sets up everything: a stop of eight blades, a model for
 * lights up to 60 degrees, and images of WIDTH x HEIGHT pixels of the lens's
 * sensor. */
bool stage_open_lens(struct stage *stage, const char *name, int width,
                     int height);

/* Opens model file PATH and sets up everything: a stop of eight blades and
 * images of WIDTH x HEIGHT pixels of the lens's sensor. */
bool stage_open_model_file(struct stage *stage, const char *path, int width,
                           int height);

/* Draw the flare of N lamps into RGB[height][width][3], linear light:
 * stage_draw_linear() with the run time, stage_draw_exact() with exactly traced
 * rays. */
bool stage_draw_linear(struct stage *stage, const struct glint_lamp *lamps,
                       int n, float *rgb);
bool stage_draw_exact(struct stage *stage, const struct glint_lamp *lamps,
                      int n, int grid, float *rgb);

/* Adds the flare of N lamps to CODES, an RGB24 image without padding. */
bool stage_draw_codes(struct stage *stage, const struct glint_lamp *lamps,
                      int n, uint8_t *codes);

/* Compares TEST with REFERENCE by glint_measure (measure.h). */
struct glint_measure stage_compare_images(const struct stage *stage,
                                          const float *reference,
                                          const float *test);

/* Returns the power of LAMP at which the brightest part of its flare is white,
 * by glint_measure_exposure(). */
double stage_find_exposed_power(struct stage *stage,
                                const struct glint_lamp *lamp);

/* Returns the largest difference between the means of corresponding 8 x 8
 * blocks of A and B, codes. A and B are images drawn by stage_draw_codes(). */
double stage_max_block_difference(const struct stage *stage, const uint8_t *a,
                                  const uint8_t *b);

/* Returns the sum of all values of the image RGB. */
double stage_sum_image(const struct stage *stage, const float *rgb);

void stage_free(struct stage *stage);

/* Returns a white point lamp. */
struct glint_lamp stage_make_lamp(double theta_deg, double phi_deg,
                                  double power);

/* Returns 64 bits of splitmix64, the same sequence on every machine. */
uint64_t stage_random_bits(uint64_t *state);
double stage_random_uniform(uint64_t *state, double low, double high);

#endif
