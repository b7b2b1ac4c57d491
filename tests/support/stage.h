/* SPDX-License-Identifier: MIT
 *
 * One lens on stage: its table, its model, and pictures of both.
 *
 *     stage_load(&s, "heliar-tronnier");          or stage_parse, or s.lens
 *     stage_prepare(&s, 8);                       stop and colours
 *     stage_model(&s, 1, 60);                     or none: rays are exact
 *     stage_view(&s, 240, 160, 0);
 *     stage_linear(&s, &lamp, 1, linear);         run time, floats
 *     stage_exact(&s, &lamp, 1, 192, exact);      the reference
 *     stage_close(&s);
 *
 * Functions return false after saying on stderr what went wrong.
 */
#ifndef GLINT_TESTS_STAGE_H
#define GLINT_TESTS_STAGE_H

#include <stdbool.h>

#include "engine/frame/frame.h"
#include "engine/measure.h"
#include "model/model_file.h"

struct stage {
    struct glint_prescription lens;
    struct glint_setup setup, of_model;
    struct glint_workers *workers;   /* NULL: serial */
    struct model_file file;          /* closed: rays are exact */
    struct glint_bake_report report; /* The bake fills this. */
    struct glint_view view;
    struct glint_frame frame;
    bool framed;
    struct glint_frame_report drawn; /* The last picture filled this. */
};

/* Reads lenses/NAME.lens, from the root of the tree. */
bool stage_load(struct stage *stage, const char *name);
bool stage_parse(struct stage *stage, const char *text);

/* A stop of N_BLADES, 0: a circle, and 650, 532 and 450 nm. After this the
 * stage must stay where it is. */
bool stage_prepare(struct stage *stage, int n_blades);

/* A model for lights up to MAX_DEG: baked here and now, or the one that other
 * tests have baked before (tools/model/model_cache.h). */
bool stage_bake(struct stage *stage, double tolerance, double max_deg);
bool stage_model(struct stage *stage, double tolerance, double max_deg);

/* Stops the lens to F_NUMBER, and its model, which was baked for a wider stop
 * and stays, too. The same pictures as before. */
bool stage_stop(struct stage *stage, double f_number);

/* Pictures of WIDTH x HEIGHT that show SENSOR_MM across; 0: as the film fits.
 * What a newcomer gets: quantum of a percent, grids of fineness 64, all
 * instruction sets. May be repeated. */
void stage_view(struct stage *stage, int width, int height, double sensor_mm);

/* All of these: the lens NAME with a stop of eight blades, its model for lights
 * up to 60 degrees, and pictures of WIDTH x HEIGHT of its film. */
bool stage_open(struct stage *stage, const char *name, int width, int height);

/* RGB [height][width][3], linear light. */
bool stage_linear(struct stage *stage, const struct glint_lamp *lamps, int n,
                  float *rgb);
bool stage_exact(struct stage *stage, const struct glint_lamp *lamps, int n,
                 int grid, float *rgb);

/* Adds the flare to CODES, RGB24 without padding. */
bool stage_codes(struct stage *stage, const struct glint_lamp *lamps, int n,
                 uint8_t *codes);

/* TEST against REFERENCE, as in measure.h. */
struct glint_measure stage_compare(const struct stage *stage,
                                   const float *reference, const float *test);

/* The power at which LAMP's flare is well exposed, as in measure.h. */
double stage_power(struct stage *stage, const struct glint_lamp *lamp);

/* How far the means of 8 x 8 blocks are apart at most, in codes, of two
 * pictures as stage_codes draws them. */
double stage_block_jump(const struct stage *stage, const uint8_t *a,
                        const uint8_t *b);

/* Sum of all values. */
double stage_flux(const struct stage *stage, const float *rgb);

void stage_close(struct stage *stage);

/* A white lamp of POWER. */
struct glint_lamp stage_lamp(double theta_deg, double phi_deg, double power);

/* splitmix64: the same numbers on every machine. */
uint64_t stage_random(uint64_t *state);
double stage_uniform(uint64_t *state, double low, double high);

#endif
