/* SPDX-License-Identifier: MIT
 *
 * ghost_file.h - what is made of single ghosts, in a text file.
 *
 *     lens nikon-zoom-short
 *     12   solo
 *     7-3  gain 0.5  tint 1,0.8,0.6     # the ghost of surfaces 7 and 3
 *     4    mute
 *
 * A ghost is named by its number or its pair of surfaces, as of glint info and
 * glint explain. Where one is solo, all others are mute but those that are
 * solo, too. Gains are 0 to 1000, tints R,G,B 0 to 4. The line with the lens
 * may be left out; # begins a remark.
 */
#ifndef GLINT_TOOLS_MODEL_GHOST_FILE_H
#define GLINT_TOOLS_MODEL_GHOST_FILE_H

#include "glint/light.h"
#include "glint/setup.h"
#include "glint/status.h"

/* Sets *TINTS to those of all ghosts and parts of SETUP, which the caller
 * frees, by the file PATH. LENS: the name that the file's lens must have.
 * GLINT_E_IO, GLINT_E_MEMORY, GLINT_E_FORMAT. */
enum glint_status ghost_file_read(struct glint_tint **tints, const char *path,
                                  const struct glint_setup *setup,
                                  const char *lens, struct glint_error *error);

/* Does as ghost_file_read() with TEXT[BYTES]; NAME is for errors. */
enum glint_status ghost_file_parse(struct glint_tint **tints, const char *name,
                                   const char *text, size_t bytes,
                                   const struct glint_setup *setup,
                                   const char *lens, struct glint_error *error);

/* Writes into TEXT[ROOM] the line of a file that gives ghost GHOST TINT; NULL:
 * as the lens gives it. */
void ghost_file_line(char *text, size_t room, int ghost,
                     const struct glint_tint *tint);

#endif
