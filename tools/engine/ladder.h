/* SPDX-License-Identifier: MIT
 *
 * One dial for all: quality 0 to 1 along the measured front of accuracy over
 * time.
 */
#ifndef GLINT_TOOLS_ENGINE_LADDER_H
#define GLINT_TOOLS_ENGINE_LADDER_H

#include "options/scene.h"

/* Names of qualities, the coarsest first. */
enum { LADDER_NAMES = 5 };
extern const char *const ladder_name[LADDER_NAMES + 1]; /* and NULL */
double ladder_named(int name);

/* Where QUALITY is among the rungs, 0 to LADDER_RUNGS - 1: between two of them,
 * but on either where one draws four pixels at once and the other does not. */
enum { LADDER_RUNGS = 10 };
double ladder_place(double quality);

/* Sets the dials of SCENE for QUALITY, 0 to 1; 0.5 is what it has by default.
 */
void ladder_set(struct scene *scene, double quality);

/* The same of FRAME, but for how exact its model is; frame_retune() comes after
 * it. */
void ladder_frame(struct frame *frame, double quality);

/* The least quality whose outlines are off by PX pixels in the mean at most.
 */
double ladder_for_error(double px);

/* The same as ladder_set from a number or a name; "exact" is the finest with
 * exact rays. False: neither. */
bool ladder_take(struct scene *scene, const char *text);

#endif
