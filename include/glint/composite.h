/* SPDX-License-Identifier: MIT
 *
 * glint/composite.h - adds light of any origin to pictures, in linear light.
 *
 *     glint_composite_init(&composite, &image, sets, 0, mem, bytes);  once
 *     glint_composite_add(composite, &image, &layer);       each picture
 *
 * For programs that add their own light: glow, bloom, a lamp. Flares use the
 * same tables, kernels and rounding. Integers only; pixels without light keep
 * their codes. */
#ifndef GLINT_COMPOSITE_H
#define GLINT_COMPOSITE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_composite; /* opaque, in the caller's memory */

/* Light to add, as large as the picture, by channel: linear BT.709, 65535 =
 * display white, where it saturates. */
struct glint_layer {
    const uint16_t *rgb_q16[3];
    ptrdiff_t stride; /* values from row to row */
};

/* Returns the bytes that glint_composite_init() needs. */
size_t glint_composite_bytes(void);

/* Places tables in MEM[BYTES], aligned to 64, for pictures with the format
 * and coding of IMAGE, whose pixels are not read. SETS: glint_sets_here() or
 * fewer; 0: plain C (kernels.h). DITHER: 1: adds an ordered pattern of less
 * than a code before rounding. GLINT_E_ARGUMENT: IMAGE is LINEAR_Q20, which
 * needs no tables, or MEM is not aligned. GLINT_E_MEMORY: BYTES is too
 * small. */
enum glint_status glint_composite_init(struct glint_composite **composite,
                                       const struct glint_image *image,
                                       unsigned sets, int dither, void *mem,
                                       size_t bytes);

/* Adds LAYER to IMAGE. */
void glint_composite_add(struct glint_composite *composite,
                         const struct glint_image *image,
                         const struct glint_layer *layer);

#ifdef __cplusplus
}
#endif

#endif
