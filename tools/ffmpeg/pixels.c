/* SPDX-License-Identifier: MIT */
#include "ffmpeg/pixels.h"

#include <stddef.h>
#include <string.h>

static bool has_one_of(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (strstr(text, *words))
            return true;
    return false;
}

/* In some names a number is that of the layout, or of all samples of a
 * pixel. */
int pixels_bits(const char *pixels)
{
    static const char *const of_8[] = {"nv12", "nv16", "yuv410p", NULL};
    static const char *const of_16[] = {"16", "14", "48", "64", "f32", NULL};
    static const char *const of_10[] = {"10", "p9", NULL};

    return has_one_of(pixels, of_8)    ? 8
           : has_one_of(pixels, of_16) ? 16
           : strstr(pixels, "12")      ? 12
           : has_one_of(pixels, of_10) ? 10
                                       : 8;
}

bool pixels_are_rgb(const char *pixels)
{
    static const char *const rgb[] = {"rgb", "bgr",  "gbr", "argb",
                                      "xyz", "pal8", NULL};

    return has_one_of(pixels, rgb);
}

bool pixels_have_alpha(const char *pixels)
{
    static const char *const alpha[] = {"yuva", "ayuv", "vuya", "rgba",
                                        "bgra", "argb", "abgr", "gbrap",
                                        "ya8",  "ya16", NULL};

    return has_one_of(pixels, alpha);
}

const char *pixels_chroma(const char *pixels)
{
    static const char *const of_444[] = {"444",  "nv24", "nv42", "p410", "p416",
                                         "ayuv", "vuy",  "xv",   NULL};
    static const char *const of_422[] = {"422",  "nv16", "nv20", "p210",
                                         "p216", "y210", "y212", NULL};
    static const char *const rare[] = {"410", "411", "440", NULL};

    if (strncmp(pixels, "gray", 4) == 0 || strncmp(pixels, "mono", 4) == 0 ||
        strncmp(pixels, "ya", 2) == 0)
        return "gray";
    if (pixels_are_rgb(pixels) || has_one_of(pixels, of_444))
        return "444";
    if (has_one_of(pixels, of_422))
        return "422";
    for (int i = 0; rare[i]; i++)
        if (strstr(pixels, rare[i]))
            return rare[i];
    return "420";
}

const char *pixels_named(const char *chroma, int bits)
{
    static const char *const table[][5] = {
        {"422", "yuv422p", "yuv422p10le", "yuv422p12le", "yuv422p16le"},
        {"444", "yuv444p", "yuv444p10le", "yuv444p12le", "yuv444p16le"},
        {"gray", "gray", "gray10le", "gray12le", "gray16le"},
        {"420", "yuv420p", "yuv420p10le", "yuv420p12le", "yuv420p16le"}};
    const int column = bits <= 8 ? 1 : bits <= 10 ? 2 : bits <= 12 ? 3 : 4;
    size_t i = 0;

    while (i < 3 && strcmp(table[i][0], chroma) != 0)
        i++;
    return table[i][column];
}

const char *pixels_of_y4m(const char *pixels)
{
    const char *const chroma = pixels_chroma(pixels);

    if (strncmp(pixels, "yuvj", 4) == 0) /* full range, too */
        return strcmp(chroma, "444") == 0   ? "yuvj444p"
               : strcmp(chroma, "422") == 0 ? "yuvj422p"
                                            : "yuvj420p";
    return pixels_named(chroma, pixels_bits(pixels));
}
