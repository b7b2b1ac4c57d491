/* SPDX-License-Identifier: MIT
 *
 * glint/profile.h - measures lamps that a picture clips to white.
 *
 *     bytes = glint_profile_bytes();                           once
 *     glint_profile_init(&profile, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 1024);   each picture
 *     glint_profile_measure(profile, &image, spots, n);
 *
 * Reads the pixels around each spot once. If channels are clipped, the power is
 * estimated from the size of the clipped core and from the fall-off of light
 * around it. The colour is then that of the fringe where no channel is clipped.
 * Otherwise the power is the flux minus the background.
 *
 * All arithmetic is in integers. No state is preserved from picture to picture.
 * All results are continuous functions of the pixels. At most about 10000
 * pixels are read per spot, about 300 for a small spot. */
#ifndef GLINT_PROFILE_H
#define GLINT_PROFILE_H

#include <stddef.h>

#include "glint/image.h"
#include "glint/lamps.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_profile; /* opaque, in the caller's memory */

/* Returns the number of bytes that glint_profile_init() needs. */
size_t glint_profile_bytes(void);

/* Places a profile in MEM[BYTES], aligned to 64; *PROFILE points into it.
 * Returns GLINT_E_MEMORY if BYTES is too small. Returns GLINT_E_ARGUMENT if the
 * alignment is wrong. */
enum glint_status glint_profile_init(struct glint_profile **profile, void *mem,
                                     size_t bytes);

/* Sets power, extent and colour of SPOTS[N], N at most 1024, which must have
 * been found in IMAGE. */
void glint_profile_measure(struct glint_profile *profile,
                           const struct glint_image *image,
                           struct glint_spot *spots, int n);

#ifdef __cplusplus
}
#endif

#endif
