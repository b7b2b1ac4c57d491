/* SPDX-License-Identifier: MIT
 *
 * ghost_file.h - a text file that solos, mutes, scales or tints single ghosts.
 *
 *     lens nikon-zoom-short
 *     12   solo
 *     7-3  gain 0.5  tint 1,0.8,0.6     # the ghost of surfaces 7 and 3
 *     4    mute
 *
 * A ghost is named by its number or its pair of surfaces, as glint info and
 * glint explain print them. If any ghost is solo, all ghosts that are not solo
 * are mute. Gains are 0 to 1000, tints R,G,B 0 to 4. The line with the lens is
 * optional; # begins a comment. */
#ifndef GLINT_TOOLS_MODEL_GHOST_FILE_H
#define GLINT_TOOLS_MODEL_GHOST_FILE_H

#include "glint/explain.h"
#include "glint/light.h"
#include "glint/setup.h"
#include "glint/status.h"

/* Reads PATH and sets *TINTS to the colour factors of all ghosts of SETUP, and
 * of the parts of their pupils. The caller frees *TINTS. If the file names a
 * lens, this lens must be LENS. Errors: GLINT_E_IO, GLINT_E_MEMORY,
 * GLINT_E_FORMAT. */
enum glint_status ghost_file_read(struct glint_tint **tints, const char *path,
                                  const struct glint_setup *setup,
                                  const char *lens, struct glint_error *error);

/* Parses TEXT[BYTES] like ghost_file_read(); NAME is the file's name in errors.
 */
enum glint_status ghost_file_parse(struct glint_tint **tints, const char *name,
                                   const char *text, size_t bytes,
                                   const struct glint_setup *setup,
                                   const char *lens, struct glint_error *error);

/* Writes to TEXT[ROOM] the line of a file that sets GHOST to TINT; if TINT
 * is NULL, the line leaves the ghost unchanged. */
void ghost_file_write_line(char *text, size_t room, int ghost,
                           const struct glint_tint *tint);

/* Writes to PATH all ghosts of EXPLAIN that are drawn or muted, the brightest
 * first, each with its fraction of the total light. Errors: GLINT_E_OUTPUT,
 * GLINT_E_CLOSED. */
enum glint_status ghost_file_save(const struct glint_explain *explain,
                                  const char *path, const char *lens,
                                  struct glint_error *error);

#endif
