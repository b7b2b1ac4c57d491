/* SPDX-License-Identifier: MIT
 *
 * Reads and writes files of the cache, $XDG_CACHE_HOME/glint or ~/.cache/glint.
 *
 * Reads only regular files that only this user, its group and root could have
 * written. Never writes through links or into FIFOs. */
#ifndef GLINT_TOOLS_MODEL_CACHE_FILE_H
#define GLINT_TOOLS_MODEL_CACHE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

enum { CACHE_PATH_BYTES = 1024 };

/* Sets PATH to the folder of the cache. Returns false if no folder is known. */
bool cache_file_find_folder(char *path, size_t bytes);

/* Appends "/NAME-KEY.SUFFIX" to the folder in PATH. Characters of NAME other
 * than letters, digits and "-_." become '_'. Returns false if the path is
 * too long. */
bool cache_file_append_name(char *path, size_t bytes, const char *name,
                            uint64_t key, const char *suffix);

/* Creates the folders above PATH. Failures are not reported, because writing
 * the file then fails with an error. */
void cache_file_make_folders(char *path);

/* Returns the contents of the file PATH, malloc'ed, or NULL if the file is
 * missing, larger than MAX bytes, or could have been written by other users. */
uint8_t *cache_file_read(const char *path, size_t max, size_t *bytes);

/* Makes the folders of PATH and writes DATA[BYTES] to PATH. Errors:
 * GLINT_E_OUTPUT, GLINT_E_MEMORY. */
enum glint_status cache_file_write(char *path, const void *data, size_t bytes,
                                   struct glint_error *error);

/* Locks PATH, whose name has KEY, so that only one process creates this file.
 * Calls WAITS with CTX before it waits for another process that holds the lock.
 * The lock is a byte of the file .lock, which stays in the folder. Returns a
 * descriptor for cache_file_unlock(). Returns -1 if locking fails; the caller
 * then creates the file without a lock. */
int cache_file_lock(char *path, uint64_t key, void (*waits)(void *ctx),
                    void *ctx);
void cache_file_unlock(int lock);

#endif
