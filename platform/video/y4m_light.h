/* SPDX-License-Identifier: MIT
 *
 * video/y4m_light.h - light on frames of Y4M of any depth and layout.
 *
 *     glint_y4m_light_init(&light, &header);             once for a stream
 *     glint_y4m_light_proxy(&layout, &image, planes);    for finding lamps
 *     glint_y4m_light_add(&light, planes, layer);
 *
 * Codes become R', G', B' and these linear light by BT.709. Light is added, and
 * codes are changed by the difference that it makes, chroma by the mean over
 * its pixels. All is integers and tables of integers, so that results are the
 * same on every machine; codes that no light falls on stay as they are.
 */
#ifndef GLINT_PLATFORM_VIDEO_Y4M_LIGHT_H
#define GLINT_PLATFORM_VIDEO_Y4M_LIGHT_H

#include <stdint.h>

#include "video/y4m.h"

enum {
    GLINT_Y4M_STEPS = 4096,   /* steps of R'G'B' from black to white */
    GLINT_Y4M_OCTAVES = 25,   /* octaves of light, from 2^-24 to white */
    GLINT_Y4M_IN_OCTAVE = 128 /* entries of an octave */
};

struct glint_y4m_light {
    struct glint_y4m_layout layout;
    int width, height;
    int32_t black, most;    /* codes of Y' = 0, and the largest there is */
    int32_t y_span, c_span; /* codes of Y' = 1, and from Cb = -1/2 to 1/2 */
    int32_t kr_q16, kg_q16, kb_q16; /* shares of R', G', B' in Y' */
    int64_t y_factor, c_factor;     /* factors of the spans, y4m_divide.h */
    int64_t cb_factor, cr_factor,
        /* factors of 1 - kb, 1 - kr and kg */
        g_factor;
    int32_t decode_q24[GLINT_Y4M_STEPS + 1]; /* light of each step */
    /* R'G'B' of light, by octave and entry */
    int32_t encode_q20[GLINT_Y4M_OCTAVES][GLINT_Y4M_IN_OCTAVE + 1];
};

/* Prepares LIGHT for the frames of HEADER. */
void glint_y4m_light_init(struct glint_y4m_light *light,
                          const struct glint_y4m_header *header);

/* Fills IMAGE, of LAYOUT's format, with PLANES cut to 8 bits. */
void glint_y4m_light_proxy(const struct glint_y4m_layout *layout,
                           const struct glint_image *image,
                           const uint8_t *planes);

/* Sets all codes of PLANES to black; alpha stays. */
void glint_y4m_light_blacken(const struct glint_y4m_light *light,
                             uint8_t *planes);

/* Adds LAYER, [height][width][3], linear light, 1 = white, to PLANES. */
void glint_y4m_light_add(const struct glint_y4m_light *light, uint8_t *planes,
                         const float *layer);

/* Does as glint_y4m_light_add() after hiding of each pixel the share COVER_Q8,
 * [height][width], 0 .. 256. */
void glint_y4m_light_cover(const struct glint_y4m_light *light, uint8_t *planes,
                           const float *layer, const uint16_t *cover_q8);

#endif
