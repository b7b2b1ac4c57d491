/* SPDX-License-Identifier: MIT
 *
 * Replaces still_jpeg.c in builds without libjpeg. */
#include "formats/still_codec.h"

const struct still_codec glint_still_jpeg = {.type = NULL};
