/* SPDX-License-Identifier: MIT
 *
 * glint/profile.h - what a lamp is behind the white that a picture clips it to.
 *
 *     bytes = glint_profile_bytes();                           once
 *     glint_profile_init(&profile, mem, bytes);
 *     n = glint_lamp_finder_find(finder, &image, spots, 1024);   each picture
 *     glint_profile_measure(profile, &image, spots, n);
 *
 * Looks once at the pixels around each spot. Where channels are clipped, their
 * power is taken from how large the clipped core is and how the light falls
 * off around it, and the colour from the fringe where no channel is clipped.
 * Where nothing is, the power is the flux over the background.
 *
 * Integers only; nothing is kept from picture to picture. All results are
 * continuous in the pixels. A spot costs at most some 10000 looked-at pixels,
 * whatever its size, a small one some 300.
 */
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

/* Bytes that init takes. */
size_t glint_profile_bytes(void);

/* Places a profile in MEM[BYTES], aligned to 64. GLINT_E_MEMORY: too small.
 * GLINT_E_ARGUMENT: the alignment is wrong. */
enum glint_status glint_profile_init(struct glint_profile **profile, void *mem,
                                     size_t bytes);

/* Sets power, extent and colour of the N SPOTS of IMAGE, in which they were
 * found. */
void glint_profile_measure(struct glint_profile *profile,
                           const struct glint_image *image,
                           struct glint_spot *spots, int n);

#ifdef __cplusplus
}
#endif

#endif
