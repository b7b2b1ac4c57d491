/* SPDX-License-Identifier: MIT
 *
 * From the description's axes and doubles to those of a baked scene:
 * left-handed steps and units in _q30. Of right-handed scenes z changes its
 * sign. */
#ifndef GLINT_BAKE_SCENE_STEPS_H
#define GLINT_BAKE_SCENE_STEPS_H

#include "glint/scene/description.h"

struct glint_steps {
    int unit_log2;
    double scale; /* 2^unit_log2 */
    double hand;  /* factor of z: 1, or -1 of right-handed scenes */
};

/* Chooses the steps of SCENE; sets REACH to how far anything there lies from
 * the origin. */
struct glint_steps glint_steps_of(const struct glint_description *scene,
                                  double *reach);

/* Sets TO to place AT in steps. */
void glint_steps_place(const struct glint_steps *steps, const double at[3],
                       int32_t to[3]);

/* Sets TO_Q30 to unit vector X. */
void glint_steps_unit(const struct glint_steps *steps, const double x[3],
                      int32_t to_q30[3]);

/* Sets TO_Q30 to unit quaternion TURN. */
void glint_steps_turn(const struct glint_steps *steps, const double turn[4],
                      int32_t to_q30[4]);

/* Sets TURN to quaternion A after B. */
void glint_turn_after(const double a[4], const double b[4], double turn[4]);

#endif
