/* SPDX-License-Identifier: MIT
 *
 * glint/glint.h - the whole API, and the conventions of all its headers.
 *
 * When a lamp shines into a real lens, reflections between its surfaces cause
 * ghosts in the picture; glint computes them. Most programs need only
 * glint/engine.h, which uses doubles and malloc. It builds on two halves of the
 * library:
 *
 *   offline   glint/prescription.h trace.h   double precision; lens tables,
 *             exact.h bake.h                 exact rays and pictures, models
 *   run time  glint/lamps.h lamp_tracker.h   integers only; no allocation
 *             model.h flare.h                after init
 *
 * Terms: a bundle is the rays of one ghost, one light and one wavelength.
 * Baking computes a model of a lens (or of a scene) ahead of time. A picture in
 * codes has integer values as a file or a display has them, not linear light.
 * Dials are the quality parameters of a frame (glint/dials.h).
 *
 * Conventions, unless a header says otherwise: pointers must not be NULL;
 * arrays must not overlap; a pointer is used only during the call, unless its
 * comment states what it must outlive; outputs are written only on GLINT_OK.
 * Different objects may be used from different threads, one object from one
 * thread at a time. A broken contract is a bug of the caller and may be
 * asserted.
 *
 * Numbers: a name that ends in _qN is an integer with N fraction bits. Values
 * are rounded to nearest, ties up. Light saturates, geometry never does. */
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
#include "glint/pool.h"
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
