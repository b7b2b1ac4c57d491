/* SPDX-License-Identifier: MIT */
#include "formats/kept_types.h"

#include <stddef.h>
#include <string.h>
#include <strings.h>

/* clang-format off */
static const struct glint_file_type types[] = {
    /* extension, native, grey, alpha; takes 8 bits, 16, half, float */
    {".ppm",  true,  false, GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pnm",  true,  false, GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pgm",  true,  true,  GLINT_ALPHA_NONE,          true,  true,  false, false},
    {".pfm",  true,  false, GLINT_ALPHA_NONE,          false, false, false, true},
    {".png",  false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  false, false},
    {".jpg",  false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".jpeg", false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".exr",  false, false, GLINT_ALPHA_PREMULTIPLIED, false, false, true,  true},
    {".hdr",  false, false, GLINT_ALPHA_NONE,          false, false, false, true},
    {".tif",  false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  true,  true},
    {".tiff", false, false, GLINT_ALPHA_STRAIGHT,      true,  true,  true,  true},
    {".bmp",  false, false, GLINT_ALPHA_NONE,          true,  false, false, false},
    {".tga",  false, false, GLINT_ALPHA_STRAIGHT,      true,  false, false, false},
    {".webp", false, false, GLINT_ALPHA_STRAIGHT,      true,  false, false, false},
};
/* clang-format on */

const struct glint_file_type *glint_file_type_of(const char *path)
{
    const char *const slash = strrchr(path, '/');
    const char *const extension = strrchr(slash ? slash : path, '.');

    for (size_t i = 0; extension && i < sizeof types / sizeof *types; i++)
        if (strcasecmp(extension, types[i].extension) == 0)
            return &types[i];
    return NULL;
}

enum glint_sample glint_file_type_sample(const struct glint_file_type *type,
                                         enum glint_sample sample)
{
    const bool is_float = glint_sample_is_float(sample);

    if (sample == GLINT_SAMPLE_U8 && type->takes_u8)
        return GLINT_SAMPLE_U8;
    if (sample == GLINT_SAMPLE_HALF && type->takes_half)
        return GLINT_SAMPLE_HALF;
    if (is_float && type->takes_float)
        return GLINT_SAMPLE_FLOAT;
    if (sample == GLINT_SAMPLE_U8 && type->takes_half)
        return GLINT_SAMPLE_HALF;
    if (sample != GLINT_SAMPLE_U8 && type->takes_u16)
        return GLINT_SAMPLE_U16;
    return type->takes_u8 ? GLINT_SAMPLE_U8 : GLINT_SAMPLE_FLOAT;
}
