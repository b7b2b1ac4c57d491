/* SPDX-License-Identifier: MIT */
#include "model/lens_files.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "options/timed_text.h"
#include "posix/process.h"

#ifndef GLINT_SHARE_DIR
#define GLINT_SHARE_DIR "/usr/local/share/glint"
#endif

enum { ABOVE = 3, NAME_CHARS = 64, PATH_CHARS = 1024 };

/* Sets PATH to a folder of the program or plug-in that contains this code: its
 * own folder for UP = 1, the one above that for 2, and so on. Returns false if
 * all users may write to that folder, because lenses in it could not be
 * trusted. */
static bool find_folder_above_program(int up, char *path, size_t bytes)
{
    struct stat st;

    if (!glint_process_find_own_file(path, bytes))
        return false;
    while (up-- > 0) {
        char *slash = strrchr(path, '/');

        if (!slash)
            return false;
        *slash = '\0';
    }
    return stat(path, &st) == 0 && !(st.st_mode & S_IWOTH);
}

bool lens_find_folder(int i, const char *kind, char *path, size_t bytes)
{
    const char *given = strcmp(kind, "lenses") == 0
                            ? glint_process_get_setting("GLINT_LENSES")
                            : NULL;
    size_t used;
    int n = 0;

    *path = '\0';
    if (i == 0) {
        n = snprintf(path, bytes, "%s", given ? given : "");
    } else if (i <= 2 * ABOVE) {
        if (find_folder_above_program((i + 1) / 2, path, bytes)) {
            used = strlen(path);
            n = snprintf(path + used, bytes - used,
                         i % 2 ? "/%s" : "/share/glint/%s", kind);
            n += (int)used;
        } else
            *path = '\0';
    } else if (i == 2 * ABOVE + 1) {
        n = snprintf(path, bytes, GLINT_SHARE_DIR "/%s", kind);
    } else
        return false;
    if ((size_t)n >= bytes)
        *path = '\0';
    return true;
}

/* subfolders of a lens folder that may contain tables; "": the folder itself */
static const char *const groups[] = {"",       "/anamorphic", "/normal",
                                     "/phone", "/tele",       "/vision",
                                     "/wide",  "/zoom"};

enum { N_GROUPS = sizeof groups / sizeof *groups };

bool lens_find_file(const char *name, char *path, size_t bytes)
{
    for (int i = 0; lens_find_folder(i, "lenses", path, bytes); i++) {
        const size_t used = strlen(path);

        for (int r = 0; used > 0 && r < N_GROUPS; r++)
            if ((size_t)snprintf(path + used, bytes - used, "%s/%s.lens",
                                 groups[r], name) < bytes - used &&
                access(path, R_OK) == 0)
                return true;
    }
    return false;
}

/* --------------------------------------------------------------------- list */

struct list {
    char (*name)[NAME_CHARS];
    int n;
};

static bool has_lens_name(const struct list *l, const char *name, size_t length)
{
    for (int i = 0; i < l->n; i++)
        if (strlen(l->name[i]) == length &&
            memcmp(l->name[i], name, length) == 0)
            return true;
    return false;
}

static bool add_lens_name(struct list *l, const char *name, size_t length)
{
    void *more;

    if (length >= NAME_CHARS || has_lens_name(l, name, length))
        return true;
    more = text_grow_array(l->name, l->n, sizeof *l->name);
    if (!more)
        return false;
    l->name = more;
    memcpy(l->name[l->n], name, length);
    l->name[l->n++][length] = '\0';
    return true;
}

/* Adds the .lens files of the folder PATH. Returns false without memory
 * or descriptors. */
static bool add_lens_folder(struct list *l, const char *path)
{
    DIR *folder = *path ? opendir(path) : NULL;
    const struct dirent *entry;
    bool ok = folder || !*path ||
              (errno != ENOMEM && errno != EMFILE && errno != ENFILE);

    while (ok && folder && (entry = readdir(folder))) {
        const size_t n = strlen(entry->d_name);

        if (n > 5 && strcmp(entry->d_name + n - 5, ".lens") == 0)
            ok = add_lens_name(l, entry->d_name, n - 5);
    }
    if (folder)
        closedir(folder);
    return ok;
}

static int compare_lens_names(const void *a, const void *b)
{
    return strcmp(a, b);
}

/* Prints a warning if the folder $GLINT_LENSES cannot be read. Otherwise the
 * user would not learn why lenses of this folder are missing. */
static void check_user_folder(void)
{
    const char *own = glint_process_get_setting("GLINT_LENSES");
    DIR *folder = own && *own ? opendir(own) : NULL;

    if (own && *own && !folder)
        fprintf(stderr, "glint: GLINT_LENSES: %s: %s\n", own, strerror(errno));
    if (folder)
        closedir(folder);
}

int lens_files_visit_all(lens_files_fn *each, void *ctx)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    struct list l = {NULL, 0};
    char path[PATH_CHARS], room[PATH_CHARS + 16];
    bool ok = true;

    pthread_once(&once, check_user_folder);
    for (int i = 0; ok && lens_find_folder(i, "lenses", path, sizeof path); i++)
        for (int r = 0; ok && *path && r < N_GROUPS; r++) {
            snprintf(room, sizeof room, "%s%s", path, groups[r]);
            ok = add_lens_folder(&l, room);
        }
    if (l.n > 0)
        qsort(l.name, (size_t)l.n, sizeof *l.name, compare_lens_names);
    for (int i = 0; ok && i < l.n && each(ctx, l.name[i]); i++)
        ;
    free(l.name);
    return ok ? l.n : -1;
}
