/* SPDX-License-Identifier: MIT
 *
 * live_picture.h - copies live frames: to memory, if the memory of the frames
 * is slow or shared, and to files (snapshots).
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_PICTURE_H
#define GLINT_TOOLS_LIVE_LIVE_PICTURE_H

#include "glint/image.h"
#include "glint/status.h"

struct live_copy {
    struct glint_image image;
    void *mem; /* buffer of the copy; NULL: not allocated yet */
    size_t bytes;
};

/* Copies FROM, reading each row only once. Returns the copy, or NULL if
 * there is no memory. Allocates only if FROM is larger than all images
 * before. */
const struct glint_image *live_copy_image(struct live_copy *copy,
                                          const struct glint_image *from);
void live_copy_free(struct live_copy *copy);

/* Saves FROM, in any 8-bit pixel format, to the image file NAME. */
enum glint_status live_save_image(const char *name,
                                  const struct glint_image *from,
                                  struct glint_error *error);

#endif
