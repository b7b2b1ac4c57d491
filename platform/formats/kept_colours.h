/* SPDX-License-Identifier: MIT
 *
 * formats/kept_colours.h - sets the meaning of a picture file's colours by its
 * cICP, profile, gamma or colour space. Part of formats/kept.h.
 */
#ifndef GLINT_PLATFORM_FORMATS_KEPT_COLOURS_H
#define GLINT_PLATFORM_FORMATS_KEPT_COLOURS_H

#include "formats/kept.h"

/* Sets the colours of KEPT's samples as FACTS say. Colours that glint does not
 * know are taken as linear or sRGB, and KEPT's note says so. */
void glint_kept_set_colours(struct glint_kept *kept,
                            const struct glint_oiio_facts *facts);

/* Appends TEXT to NOTES, after "; " if NOTES is not empty. */
void glint_kept_note(char notes[GLINT_KEPT_NOTES], const char *text);

#endif
