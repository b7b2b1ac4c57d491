/* SPDX-License-Identifier: MIT
 *
 * glint/glint.h - the whole API, and the conventions of all its headers.
 *
 * glint computes the ghosts that a lamp shining into a real lens causes in a
 * picture. Most programs need only glint/engine.h, which uses doubles and
 * malloc. Below it are two halves:
 *
 *   offline   glint/prescription.h trace.h   double precision; lens tables,
 *             exact.h bake.h                 exact rays and pictures, models
 *   run time  glint/lamps.h lamp_tracker.h   integers only; no allocation
 *             model.h flare.h                after init
 *
 * Conventions, unless a header says otherwise: pointers are not NULL; arrays do
 * not overlap; pointers are borrowed for the call, and kept only where marked
 * *kept*; outputs are written only on GLINT_OK; distinct objects may be used
 * from distinct threads, one object from one thread at a time. A broken
 * contract is a bug of the caller and may be asserted.
 *
 * Numbers: a name that ends in _qN is an integer with N fraction bits. Rounding
 * is to nearest, ties up. Light saturates, geometry never does. */
#ifndef GLINT_GLINT_H
#define GLINT_GLINT_H

#include "glint/bake.h"
#include "glint/bundle.h"
#include "glint/composite.h"
#include "glint/dials.h"
#include "glint/engine.h"
#include "glint/exact.h"
#include "glint/flare.h"
#include "glint/half.h"
#include "glint/image.h"
#include "glint/kernels.h"
#include "glint/lamp_tracker.h"
#include "glint/lamps.h"
#include "glint/light.h"
#include "glint/model.h"
#include "glint/options.h"
#include "glint/prescription.h"
#include "glint/profile.h"
#include "glint/quality.h"
#include "glint/real.h"
#include "glint/scene/account.h"
#include "glint/scene/model.h"
#include "glint/scene/scene.h"
#include "glint/setup.h"
#include "glint/status.h"
#include "glint/trace.h"
#include "glint/transfer.h"
#include "glint/view.h"
#include "glint/workers.h"

#define GLINT_VERSION "0.1.0"

#endif
