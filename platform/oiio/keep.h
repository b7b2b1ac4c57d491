/* SPDX-License-Identifier: MIT
 *
 * oiio/keep.h - the functions of formats/oiio.h that keep a file as it is.
 */
#ifndef GLINT_PLATFORM_OIIO_KEEP_H
#define GLINT_PLATFORM_OIIO_KEEP_H

#include "formats/oiio.h"

namespace glint
{

enum glint_status open_file(struct glint_oiio_file **file,
                            struct glint_samples *samples,
                            struct glint_oiio_facts *facts, const char *path,
                            struct glint_error *error);
void close_file(struct glint_oiio_file *file);
int is_same_type(const struct glint_oiio_file *file, const char *path);
enum glint_status encode_file(void **data, size_t *bytes, const char *path,
                              struct glint_oiio_file *file,
                              const struct glint_samples *pixels,
                              const struct glint_oiio_options *options,
                              struct glint_error *error);

} // namespace glint

#endif
