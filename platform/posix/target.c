/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* realpath */
/* NOLINTNEXTLINE(bugprone-reserved-identifier): flock */
#define _DEFAULT_SOURCE
#include "posix/target.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* most characters of an extension that temporary names keep */
#define EXT_CHARS  16
#define MAX_LINKS  40 /* most links that Linux follows */
#define PATH_BYTES 4096

/* -------------------------------------------------------------------- links */

/* Returns the length of PATH's folder with its slash, or 0 if it states
 * none. */
static size_t folder_length(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? (size_t)(slash + 1 - path) : 0;
}

/* Sets FOLDER, PATH_BYTES long, to the folder of PATH, or "." if it states
 * none. */
static void set_folder(char *folder, const char *path)
{
    const size_t n = folder_length(path);

    if (n == 0)
        snprintf(folder, PATH_BYTES, ".");
    else
        snprintf(folder, PATH_BYTES, "%.*s", (int)n, path);
}

/* Checks whether the kernel would follow the link at PATH, whose status is
 * LINK. In a folder that everybody may write to it follows only links of the
 * user and of the folder's owner, but it reports that only if the link leads to
 * a file. */
static bool may_follow(const char *path, const struct stat *link)
{
    char folder[PATH_BYTES];
    struct stat st;

    set_folder(folder, path);
    return link->st_uid == geteuid() ||
           (stat(folder, &st) == 0 &&
            (!(st.st_mode & S_IWOTH) || st.st_uid == link->st_uid));
}

/* Replaces PATH, PATH_BYTES long, by the text of the link there. Returns false
 * with errno set. */
static bool follow(char *path)
{
    char text[PATH_BYTES];
    const ssize_t n = readlink(path, text, sizeof text - 1);
    const size_t kept = n > 0 && text[0] == '/' ? 0 : folder_length(path);

    if (n < 0)
        return false;
    if (kept + (size_t)n >= PATH_BYTES) {
        errno = ENAMETOOLONG;
        return false;
    }
    memcpy(path + kept, text, (size_t)n);
    path[kept + (size_t)n] = 0;
    return true;
}

/* Follows the links at PATH to a file that is not there yet. Returns its path,
 * malloc'ed, or NULL with errno set. */
static char *new_target(const char *path)
{
    char at[PATH_BYTES];
    struct stat st;

    if (strlen(path) >= sizeof at) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    strcpy(at, path);
    for (int i = 0; i < MAX_LINKS; i++) {
        if (lstat(at, &st) < 0)
            return errno == ENOENT ? strdup(at) : NULL;
        if (!S_ISLNK(st.st_mode) || !may_follow(at, &st)) {
            errno = S_ISLNK(st.st_mode) ? EACCES : ESTALE;
            return NULL;
        }
        if (!follow(at))
            return NULL;
    }
    errno = ELOOP;
    return NULL;
}

char *glint_target_of(const char *path, const struct stat *st)
{
    struct stat now;
    char *target;

    if (!st)
        return new_target(path);
    target = realpath(path, NULL);
    if (!target)
        return NULL;
    /* If TARGET is another file than ST, somebody has changed a link since, and
     * the kernel might not have followed the new one. */
    if (lstat(target, &now) == 0 && now.st_dev == st->st_dev &&
        now.st_ino == st->st_ino)
        return target;
    free(target);
    errno = ESTALE;
    return NULL;
}

bool glint_target_is_input(const char *input, const char *output)
{
    struct stat in, out;
    const int in_fails =
        strcmp(input, "-") ? stat(input, &in) : fstat(STDIN_FILENO, &in);
    const int out_fails =
        strcmp(output, "-") ? stat(output, &out) : fstat(STDOUT_FILENO, &out);

    return !in_fails && !out_fails && S_ISREG(in.st_mode) &&
           in.st_dev == out.st_dev && in.st_ino == out.st_ino;
}

bool glint_target_is_same(const char *a, const char *b)
{
    char folder[PATH_BYTES];
    struct stat in_a, in_b;

    if (strcmp(a + folder_length(a), b + folder_length(b)) != 0 ||
        (stat(a, &in_a) == 0 && !S_ISREG(in_a.st_mode)))
        return false;
    if (strcmp(a, b) == 0)
        return true;
    set_folder(folder, a);
    if (stat(folder, &in_a) != 0)
        return false;
    set_folder(folder, b);
    return stat(folder, &in_b) == 0 && in_a.st_dev == in_b.st_dev &&
           in_a.st_ino == in_b.st_ino;
}

/* ---------------------------------------------------------- temporary names */

char *glint_target_beside(const char *target, unsigned n)
{
    const char *const base = target + folder_length(target);
    const char *ext = strrchr(base, '.');
    const size_t size = strlen(target) + 64;
    char *const name = malloc(size);

    if (!ext || ext == base || strlen(ext) > EXT_CHARS)
        ext = "";
    if (name)
        snprintf(name, size, "%.*s.glint-%ld-%u%s", (int)(base - target),
                 target, (long)getpid(), n, ext);
    return name;
}

/* Returns the process that made the temporary file NAME, or 0 if NAME is not
 * one. */
static pid_t maker_of(const char *name)
{
    static const char begin[] = ".glint-";
    char *end;
    long pid;

    if (strncmp(name, begin, sizeof begin - 1) != 0)
        return 0;
    name += sizeof begin - 1;
    pid = strtol(name, &end, 10);
    if (*name < '1' || *name > '9' || *end != '-' || pid > 1 << 30)
        return 0;
    name = end + 1;
    end += 1 + strspn(name, "0123456789");
    return end > name && (*end == '.' || !*end) ? (pid_t)pid : 0;
}

/* Checks whether FD is a regular file of this user's that nobody has locked. */
static bool is_abandoned(int fd)
{
    struct stat st;

    return fstat(fd, &st) == 0 && S_ISREG(st.st_mode) &&
           st.st_uid == geteuid() && flock(fd, LOCK_EX | LOCK_NB) == 0;
}

static void clean(int folder, const char *name)
{
    const pid_t pid = maker_of(name);
    int fd;

    if (pid == 0 || kill(pid, 0) == 0 || errno != ESRCH)
        return;
    fd = openat(folder, name,
                O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (fd < 0)
        return;
    if (is_abandoned(fd))
        unlinkat(folder, name, 0);
    close(fd);
}

void glint_target_clean(const char *target)
{
    /* Hash of inode and device of the folder cleaned last, which is not
     * cleaned again. */
    static unsigned long cleaned;
    unsigned long here;
    char folder[PATH_BYTES];
    const struct dirent *entry;
    struct stat st;
    DIR *dir;

    set_folder(folder, target);
    if (stat(folder, &st) < 0)
        return;
    here = (unsigned long)st.st_ino * 31 + (unsigned long)st.st_dev;
    if (here == __atomic_load_n(&cleaned, __ATOMIC_RELAXED))
        return;
    dir = opendir(folder);
    while (dir && (entry = readdir(dir)))
        clean(dirfd(dir), entry->d_name);
    if (dir)
        closedir(dir);
    __atomic_store_n(&cleaned, here, __ATOMIC_RELAXED);
}
