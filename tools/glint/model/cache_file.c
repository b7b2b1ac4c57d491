/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* for F_OFD_SETLK */
#include "model/cache_file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "glint/prescription.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"
#include "posix/process.h"

bool cache_file_find_folder(char *path, size_t bytes)
{
    const char *cache = glint_process_get_setting("XDG_CACHE_HOME");
    const char *home = glint_process_get_setting("HOME");
    int n = 0;

    if (cache && cache[0] == '/')
        n = snprintf(path, bytes, "%s/glint", cache);
    else if (home && home[0] == '/')
        n = snprintf(path, bytes, "%s/.cache/glint", home);
    return n > 0 && (size_t)n < bytes;
}

bool cache_file_append_name(char *path, size_t bytes, const char *name,
                            uint64_t key, const char *suffix)
{
    const size_t used = strlen(path);
    char safe[GLINT_NAME_BYTES];

    snprintf(safe, sizeof safe, "%s", name);
    for (char *c = safe; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("-_.", *c))
            *c = '_';
    return (size_t)snprintf(path + used, bytes - used, "/%s-%08lx%08lx.%s",
                            safe, (unsigned long)(key >> 32),
                            (unsigned long)(key & 0xffffffff),
                            suffix) < bytes - used;
}

void cache_file_make_folders(char *path)
{
    for (char *c = path + 1; *c; c++)
        if (*c == '/') {
            *c = 0;
            mkdir(path, 0755);
            *c = '/';
        }
}

/* Returns whether nobody except this user, its group and root can have written
 * the file or folder of status ST. */
static bool is_writable_only_by_trusted_users(const struct stat *st)
{
    return (st->st_uid == geteuid() || st->st_uid == 0) &&
           !(st->st_mode & S_IWOTH);
}

/* Returns whether nobody except this user, its group and root may write to the
 * folder of PATH. Another user could store a wrong model there under a valid
 * name. */
static bool is_folder_trusted(const char *path)
{
    char folder[CACHE_PATH_BYTES];
    const char *const slash = strrchr(path, '/');
    const size_t n = slash ? (size_t)(slash - path) : sizeof folder;
    struct stat st;

    if (n >= sizeof folder)
        return false;
    memcpy(folder, path, n);
    folder[n] = '\0';
    return stat(folder, &st) == 0 && is_writable_only_by_trusted_users(&st);
}

uint8_t *cache_file_read(const char *path, size_t max, size_t *bytes)
{
    struct glint_input in = {.fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY |
                                                  O_NOFOLLOW | O_NONBLOCK),
                             .name = path};
    struct glint_error error;
    uint8_t *data = NULL;
    struct stat st;

    *bytes = 0;
    if (in.fd < 0)
        return NULL;
    if (fstat(in.fd, &st) < 0 || !S_ISREG(st.st_mode) ||
        !is_writable_only_by_trusted_users(&st) || !is_folder_trusted(path) ||
        glint_input_read_rest(&in, &data, bytes, max, &error) != GLINT_OK) {
        free(data);
        data = NULL;
    }
    glint_input_close(&in);
    return data;
}

/* Prepares PATH to be written: rejects links and files that are not regular.
 * Removes a file that other users own or may write to, so that the new file
 * gets safe permissions. */
static enum glint_status remove_untrusted_file(const char *path,
                                               struct glint_error *error)
{
    struct stat st;

    if (lstat(path, &st) < 0)
        return GLINT_OK;
    if (!S_ISREG(st.st_mode))
        return glint_error_report(error, GLINT_E_OUTPUT, path,
                                  "is not a regular file; remove it");
    /* A failure is not reported here, because writing the file then fails with
     * an error. */
    if (!is_writable_only_by_trusted_users(&st))
        unlink(path);
    return GLINT_OK;
}

enum glint_status cache_file_write(char *path, const void *data, size_t bytes,
                                   struct glint_error *error)
{
    enum glint_status status;

    cache_file_make_folders(path);
    status =
        is_folder_trusted(path)
            ? remove_untrusted_file(path, error)
            : glint_error_report(
                  error, GLINT_E_OUTPUT, path,
                  "is in a folder that other users may write to; chmod o-w it");
    return status == GLINT_OK
               ? glint_output_save_file(path, GLINT_OUTPUT_BINARY, data, bytes,
                                        error)
               : status;
}

int cache_file_lock(char *path, uint64_t key, void (*waits)(void *ctx),
                    void *ctx)
{
    struct flock byte = {.l_type = F_WRLCK,
                         .l_whence = SEEK_SET,
                         .l_start = (off_t)(key & 0x3fffffff),
                         .l_len = 1};
    char name[CACHE_PATH_BYTES + 8];
    const char *const slash = strrchr(path, '/');
    int fd, got;

    cache_file_make_folders(path);
    snprintf(name, sizeof name, "%.*s.lock", (int)(slash + 1 - path), path);
    fd = open(name, O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
              0600);
    if (fd < 0)
        return -1;
    got = fcntl(fd, F_OFD_SETLK, &byte);
    if (got < 0 && (errno == EAGAIN || errno == EACCES)) {
        waits(ctx);
        do
            got = fcntl(fd, F_OFD_SETLKW, &byte);
        while (got < 0 && errno == EINTR);
    }
    if (got == 0)
        return fd;
    close(fd);
    return -1;
}

void cache_file_unlock(int lock)
{
    if (lock >= 0)
        close(lock);
}
