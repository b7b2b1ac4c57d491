/* SPDX-License-Identifier: MIT
 *
 * glint/composite.h - adds layers of linear light to pictures.
 *
 *     glint_composite_init(&composite, &image, sets, 0, mem, bytes);  once
 *     glint_composite_add(composite, &image, &layer);       each picture
 *
 * For programs that add their own light, such as glow, bloom or a lamp. The
 * functions that draw flares use the same tables, kernels and rounding. All
 * arithmetic is in integers; pixels to which no light is added keep their
 * codes. */
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

/* Light to add: three planes, one per channel, each of the size of the picture.
 * Values are linear BT.709, where 65535 is display white; brighter light
 * saturates. */
struct glint_layer {
    const uint16_t *rgb_q16[3];
    ptrdiff_t stride; /* number of values from the start of one row to the start
                         of the next */
};

/* Returns the number of bytes of memory that glint_composite_init() needs. */
size_t glint_composite_bytes(void);

/* Places tables in MEM[BYTES], aligned to 64, for pictures with the format,
 * range, matrix and transfer curve of IMAGE. The pixels of IMAGE are not read.
 * SETS: instruction sets, glint_sets_here() or a subset; 0: plain C
 * (kernels.h). DITHER 1 adds an ordered pattern of less than a code before
 * rounding. Returns GLINT_E_ARGUMENT if IMAGE is LINEAR_Q20, which needs no
 * tables, or MEM is not aligned. Returns GLINT_E_MEMORY if BYTES is too
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
