/* SPDX-License-Identifier: MIT
 *
 * Replaces still_png.c in builds without libpng. */
#include "formats/still_codec.h"

const struct still_codec glint_still_png = {.type = NULL};
