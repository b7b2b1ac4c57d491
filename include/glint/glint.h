/* SPDX-License-Identifier: MIT
 *
 * glint/glint.h - the whole API, and what holds everywhere in it.
 *
 * glint computes the ghosts that a real lens throws across a picture when a
 * lamp shines into it. Two halves:
 *
 *   offline   glint/bake.h                   double precision; lens tables,
 *                                            exact rays
 *   run time  glint/lamps.h lamp_tracker.h   integers only; no allocation
 *             flare.h                        after init
 *
 * Conventions, unless a header says otherwise: pointers are not NULL; arrays do
 * not overlap; pointers are borrowed for the call, and kept only where marked
 * *kept*; outputs are written only on GLINT_OK; distinct objects may be used
 * from distinct threads, one object from one thread at a time. A broken
 * contract is a bug of the caller and may be asserted.
 *
 * Numbers: a name that ends in _qN is an integer with N fraction bits. One
 * rounding: to nearest, ties up. Light saturates, geometry never does.
 */
#ifndef GLINT_GLINT_H
#define GLINT_GLINT_H

#include "glint/bake.h"
#include "glint/composite.h"
#include "glint/flare.h"
#include "glint/image.h"
#include "glint/kernels.h"
#include "glint/lamp_tracker.h"
#include "glint/lamps.h"
#include "glint/lens.h"
#include "glint/profile.h"
#include "glint/status.h"
#include "glint/workers.h"

#define GLINT_VERSION "0.1.0"

#endif
