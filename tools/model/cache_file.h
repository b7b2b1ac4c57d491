/* SPDX-License-Identifier: MIT
 *
 * Files of the cache, $XDG_CACHE_HOME/glint or ~/.cache/glint.
 *
 * What is read is a regular file that nobody but us or the machine's owner
 * could have written; what is written goes through no link and into no FIFO.
 */
#ifndef GLINT_TOOLS_MODEL_CACHE_FILE_H
#define GLINT_TOOLS_MODEL_CACHE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

enum { CACHE_PATH_BYTES = 1024 };

/* PATH becomes the folder. False: there is none. */
bool cache_file_folder(char *path, size_t bytes);

/* Adds "/NAME-KEY.SUFFIX" to the folder in PATH; of NAME letters, digits and
 * "-_." are left. False: too long. */
bool cache_file_name(char *path, size_t bytes, const char *name, uint64_t key,
                     const char *suffix);

/* Makes the folders above PATH; if it fails, so will writing there. */
void cache_file_make_folders(char *path);

/* All of PATH, malloc'ed; NULL: it is not there, not ours or larger than
 * MAX. */
uint8_t *cache_file_read(const char *path, size_t max, size_t *bytes);

/* Writes DATA[BYTES] to PATH and makes its folders. GLINT_E_OUTPUT, _MEMORY. */
enum glint_status cache_file_write(char *path, const void *data, size_t bytes,
                                   struct glint_error *error);

#endif
