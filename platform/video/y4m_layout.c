/* SPDX-License-Identifier: MIT */
#include "video/y4m_layout.h"

#include <string.h>

static const struct colour {
    const char *tag;
    enum glint_pixel_format format;
    bool has_alpha, is_411, may_be_deep;
} colours[] = {
    /* glint_y4m_layout_tag() returns the first tag of a format. */
    {"420jpeg", GLINT_I420, false, false, false},
    {"420mpeg2", GLINT_I420, false, false, false},
    {"420paldv", GLINT_I420, false, false, false},
    {"420", GLINT_I420, false, false, true},
    {"422", GLINT_I422, false, false, true},
    {"411", GLINT_I422, false, true, false},
    {"444", GLINT_I444, false, false, true},
    {"444alpha", GLINT_I444, true, false, false},
    {"mono", GLINT_GREY, false, false, true},
};

#define N_COLOURS (sizeof colours / sizeof *colours)

/* Returns the bits a sample that TEXT, the end of a tag, states: 9 .. 16, 8 if
 * it is empty, 0 if malformed. */
static int bits_of(const char *text, bool is_grey)
{
    static const char *const names[] = {"9", "10", "12", "14", "16"};
    static const int bits[] = {9, 10, 12, 14, 16};

    if (!*text)
        return 8;
    if (!is_grey && *text++ != 'p')
        return 0;
    for (size_t i = 0; i < sizeof bits / sizeof *bits; i++)
        if (strcmp(text, names[i]) == 0)
            return bits[i];
    return 0;
}

bool glint_y4m_layout_parse(struct glint_y4m_layout *layout, const char *tag)
{
    const char *const text = *tag ? tag : colours[0].tag;

    for (size_t i = 0; i < N_COLOURS; i++) {
        const struct colour *const c = &colours[i];
        const size_t n = strlen(c->tag);
        const int bits = strncmp(text, c->tag, n) == 0
                             ? bits_of(text + n, c->format == GLINT_GREY)
                             : 0;

        if (bits == 0 || (bits > 8 && !c->may_be_deep))
            continue;
        *layout =
            (struct glint_y4m_layout){c->format, bits, c->has_alpha, c->is_411};
        return true;
    }
    return false;
}

const char *glint_y4m_layout_tag(enum glint_pixel_format format)
{
    size_t i = 0;

    while (colours[i].format != format)
        i++;
    return colours[i].tag;
}

bool glint_y4m_layout_is_plain(const struct glint_y4m_layout *layout)
{
    return layout->bits == 8 && !layout->is_411;
}

void glint_y4m_layout_size(const struct glint_y4m_layout *layout, int plane,
                           int width, int height, int size[2])
{
    const enum glint_pixel_format format = layout->format;
    const bool is_chroma = plane == 1 || plane == 2;
    const int across = layout->is_411 ? 4 : format == GLINT_I444 ? 1 : 2;
    const int down = format == GLINT_I420 ? 2 : 1;

    size[0] = is_chroma ? (width + across - 1) / across : width;
    size[1] = is_chroma ? (height + down - 1) / down : height;
    if ((is_chroma && format == GLINT_GREY) ||
        (plane == 3 && !layout->has_alpha))
        size[0] = size[1] = 0;
}

size_t glint_y4m_layout_bytes(const struct glint_y4m_layout *layout, int width,
                              int height)
{
    size_t samples = 0;

    for (int p = 0; p < 4; p++) {
        int size[2];

        glint_y4m_layout_size(layout, p, width, height, size);
        samples += (size_t)size[0] * (size_t)size[1];
    }
    return samples * (layout->bits > 8 ? 2 : 1);
}
