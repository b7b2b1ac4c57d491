/* SPDX-License-Identifier: MIT
 *
 * formats/kept_types.h - the types of picture files, and what each can hold.
 */
#ifndef GLINT_PLATFORM_FORMATS_KEPT_TYPES_H
#define GLINT_PLATFORM_FORMATS_KEPT_TYPES_H

#include <stdbool.h>

#include "formats/samples.h"

enum glint_type_alpha {
    GLINT_ALPHA_NONE,
    GLINT_ALPHA_STRAIGHT,
    GLINT_ALPHA_PREMULTIPLIED
};

struct glint_file_type {
    const char *extension;
    bool is_native; /* written by glint itself */
    bool is_grey;   /* holds no colours */
    enum glint_type_alpha alpha;
    bool takes_u8, takes_u16, takes_half, takes_float;
};

/* Returns the type that PATH's extension stands for, or NULL if it is
 * unknown. */
const struct glint_file_type *glint_file_type_of(const char *path);

/* Returns the kind of sample, among those that TYPE takes, closest to
 * SAMPLE. */
enum glint_sample glint_file_type_sample(const struct glint_file_type *type,
                                         enum glint_sample sample);

#endif
