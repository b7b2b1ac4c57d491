/* SPDX-License-Identifier: MIT
 *
 * decode.h - which format a file has, and its bytes as text.
 */
#ifndef GLINT_TOOLS_IMPORT_DECODE_H
#define GLINT_TOOLS_IMPORT_DECODE_H

#include <stdint.h>

#include "import/imported.h"

/* A format: its name for --format, the end of its files' names, with the dot,
 * if it is known by that, and its reader. */
struct import_format {
    const char *name, *end;
    bool (*read)(struct imported *lens, const char *text, size_t bytes);
};

/* Returns the Kth format, from 0, or NULL if there are no more. */
const struct import_format *import_format_at(int k);

/* Returns the format of the file NAME by its end, or NULL. A .lens and a .dat
 * are FlareSim's and pbrt's. */
const struct import_format *import_format_of(const char *name);

/* Reads DATA as FORMAT. Returns a table as imported_finish() does. DATA is
 * decoded in place. */
char *import_read(struct imported *lens, const struct import_format *format,
                  uint8_t *data, size_t *bytes);

#endif
