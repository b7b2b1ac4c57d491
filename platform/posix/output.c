/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* for realpath, flock, fopencookie */
#include "posix/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix/at_death.h"
#include "posix/error.h"

/* max characters of an extension in temporary names */
#define EXT_CHARS  16
#define MAX_LINKS  40 /* max links that Linux follows in a path */
#define PATH_BYTES 4096

/* -------------------------------------------------------------------- links */

/* Returns the length of PATH's folder with its slash, or 0 if PATH has no
 * slash. */
static size_t get_folder_length(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? (size_t)(slash + 1 - path) : 0;
}

/* Sets FOLDER, PATH_BYTES long, to the folder of PATH, or "." if PATH has no
 * slash. */
static void copy_folder_of_path(char *folder, const char *path)
{
    const size_t n = get_folder_length(path);

    if (n == 0)
        snprintf(folder, PATH_BYTES, ".");
    else
        snprintf(folder, PATH_BYTES, "%.*s", (int)n, path);
}

/* Returns whether the kernel would follow the symbolic link at PATH, which has
 * the stat data LINK. In a folder that everybody may write to, the kernel
 * follows only links of this user and of the folder's owner. The check is
 * needed because the kernel itself reports a refusal only if the file at the
 * end of the link exists. */
static bool may_follow_link(const char *path, const struct stat *link)
{
    char folder[PATH_BYTES];
    struct stat st;

    copy_folder_of_path(folder, path);
    return link->st_uid == geteuid() ||
           (stat(folder, &st) == 0 &&
            (!(st.st_mode & S_IWOTH) || st.st_uid == link->st_uid));
}

/* Replaces PATH, a buffer of PATH_BYTES, by the path to which the symbolic link
 * PATH points. Returns false with errno set on failure. */
static bool follow_link(char *path)
{
    char text[PATH_BYTES];
    const ssize_t n = readlink(path, text, sizeof text - 1);
    const size_t kept = n > 0 && text[0] == '/' ? 0 : get_folder_length(path);

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

/* Follows the dangling links at PATH. Returns the path of the missing file,
 * which the caller frees, or NULL with errno set. */
static char *follow_dangling_links(const char *path)
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
        if (!S_ISLNK(st.st_mode) || !may_follow_link(at, &st)) {
            errno = S_ISLNK(st.st_mode) ? EACCES : ESTALE;
            return NULL;
        }
        if (!follow_link(at))
            return NULL;
    }
    errno = ELOOP;
    return NULL;
}

/* Returns the path of the file to which PATH leads after all links; the caller
 * frees it. ST is the stat data of this file, or NULL if it does not exist yet,
 * for example behind a dangling link. On failure returns NULL with errno set:
 * EACCES for a dangling link that the kernel would not follow, ESTALE if PATH
 * now leads to another file than ST, or a system error. */
static char *resolve_links_of_target(const char *path, const struct stat *st)
{
    struct stat now;
    char *target;

    if (!st)
        return follow_dangling_links(path);
    target = realpath(path, NULL);
    if (!target)
        return NULL;
    /* If TARGET is not the file with the stat data ST, another process has
     * changed a link meanwhile, and the kernel might refuse to follow the new
     * link. */
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

bool glint_target_is_same_file(const char *a, const char *b)
{
    char folder[PATH_BYTES];
    struct stat in_a, in_b;

    if (strcmp(a + get_folder_length(a), b + get_folder_length(b)) != 0 ||
        (stat(a, &in_a) == 0 && !S_ISREG(in_a.st_mode)))
        return false;
    if (strcmp(a, b) == 0)
        return true;
    copy_folder_of_path(folder, a);
    if (stat(folder, &in_a) != 0)
        return false;
    copy_folder_of_path(folder, b);
    return stat(folder, &in_b) == 0 && in_a.st_dev == in_b.st_dev &&
           in_a.st_ino == in_b.st_ino;
}

/* ---------------------------------------------------------- temporary names */

/* Returns the temporary name DIR/.glint-PID-N.EXT for the target
 * DIR/NAME.EXT, which the caller frees, or NULL if memory is exhausted. */
static char *make_temporary_name(const char *target, unsigned n)
{
    const char *const base = target + get_folder_length(target);
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

/* Returns the id of the process that made the temporary file NAME, or 0 if
 * NAME does not have the form of a temporary name. */
static pid_t parse_process_id_in_name(const char *name)
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

/* Returns whether FD is a regular file of this user that no process has
 * locked. */
static bool is_file_abandoned(int fd)
{
    struct stat st;

    return fstat(fd, &st) == 0 && S_ISREG(st.st_mode) &&
           st.st_uid == geteuid() && flock(fd, LOCK_EX | LOCK_NB) == 0;
}

static void remove_if_abandoned(int folder, const char *name)
{
    const pid_t pid = parse_process_id_in_name(name);
    int fd;

    if (pid == 0 || kill(pid, 0) == 0 || errno != ESRCH)
        return;
    fd = openat(folder, name,
                O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (fd < 0)
        return;
    if (is_file_abandoned(fd))
        unlinkat(folder, name, 0);
    close(fd);
}

/* Removes temporary files of killed runs from TARGET's folder: files of this
 * user whose process has ended and that no process on any machine has locked.
 * Does nothing if the last call cleaned the same folder. */
static void remove_abandoned_files(const char *target)
{
    /* hash of inode and device of the folder that was cleaned last */
    static unsigned long cleaned;
    unsigned long here;
    char folder[PATH_BYTES];
    const struct dirent *entry;
    struct stat st;
    DIR *dir;

    copy_folder_of_path(folder, target);
    if (stat(folder, &st) < 0)
        return;
    here = (unsigned long)st.st_ino * 31 + (unsigned long)st.st_dev;
    if (here == __atomic_load_n(&cleaned, __ATOMIC_RELAXED))
        return;
    dir = opendir(folder);
    while (dir && (entry = readdir(dir)))
        remove_if_abandoned(dirfd(dir), entry->d_name);
    if (dir)
        closedir(dir);
    __atomic_store_n(&cleaned, here, __ATOMIC_RELAXED);
}

#define BUFFER_BYTES 65536
#define MAX_TMP      16 /* max number of open temporary files */
/* max number of temporary names to try; files with some of the names may
 * already exist */
#define MAX_TRIES 1000

/* ---------------------------------------------- files to remove when dying */

/* names of temporary files, or NULL; atomic */
static char *doomed[MAX_TMP];
/* 1: the process is dying, and remove_all_temporary_files() may run; atomic */
static int dying;

/* Async-signal-safe. */
static void remove_all_temporary_files(void)
{
    const int saved = errno;

    __atomic_store_n(&dying, 1, __ATOMIC_SEQ_CST);
    for (int i = 0; i < MAX_TMP; i++) {
        const char *const name = __atomic_load_n(&doomed[i], __ATOMIC_SEQ_CST);

        if (name)
            unlink(name);
    }
    errno = saved;
}

static bool register_temporary_file(char *name)
{
    for (int i = 0; i < MAX_TMP; i++) {
        char *none = NULL;

        if (__atomic_compare_exchange_n(&doomed[i], &none, name, false,
                                        __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
            return true;
    }
    return false;
}

/* Removes NAME from the list of temporary files and frees it. NAME is not freed
 * if DYING is set, because remove_all_temporary_files() may use it in another
 * thread. */
static void unregister_temporary_file(char *name)
{
    for (int i = 0; i < MAX_TMP; i++) {
        char *same = name;

        __atomic_compare_exchange_n(&doomed[i], &same, NULL, false,
                                    __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
    }
    if (!__atomic_load_n(&dying, __ATOMIC_SEQ_CST))
        free(name);
}

/* ----------------------------------------------------------------- opening */

static enum glint_status report_open_refusal(const struct glint_output *out,
                                             struct glint_error *error,
                                             int number)
{
    return glint_error_report(error, GLINT_E_OUTPUT, out->name, "%s",
                              strerror(number));
}

/* Creates the file NAME and adds it to the list of temporary files. Signals are
 * blocked between the two steps; otherwise a signal could kill the process
 * before the file is in the list, and the file would remain. Returns the file's
 * descriptor, or -1 with errno set. */
static int create_temporary_file(char *name, mode_t mode)
{
    sigset_t held, old;
    int fd, saved;

    sigfillset(&held);
    pthread_sigmask(SIG_BLOCK, &held, &old);
    fd = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    saved = errno;
    if (fd >= 0 && !register_temporary_file(name)) {
        close(fd);
        unlink(name);
        fd = -1;
        saved = EMFILE;
    }
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    errno = saved;
    return fd;
}

/* Reports that no temporary file could be created. The message contains at most
 * the last 40 bytes of the folder's name, beginning with a complete character,
 * so that the cause fits behind it. */
static enum glint_status
report_temporary_file_failure(const struct glint_output *out, int number,
                              struct glint_error *error)
{
    const char *const slash = strrchr(out->target, '/');
    const char *folder = slash ? out->target : ".";
    const int n = slash && slash > out->target ? (int)(slash - out->target) : 1;
    const int left_out = n > 40 ? n - 40 : 0;

    folder += left_out;
    while (left_out > 0 && (*folder & 0xc0) == 0x80)
        folder++;

    return glint_error_report(
        error, GLINT_E_OUTPUT, out->name,
        "cannot create a temporary file in its folder "
        "'%s%.*s': %s",
        left_out ? "..." : "",
        n - (int)(folder - (slash ? out->target : folder)), folder,
        strerror(number));
}

/* Opens a temporary file in the folder of out->target. MODE: its permission
 * bits, or (mode_t)-1 for the default by umask. */
static enum glint_status open_temporary_file(struct glint_output *out,
                                             mode_t mode,
                                             struct glint_error *error)
{
    static unsigned counter; /* number for the next temporary name; atomic */
    const bool keep = mode != (mode_t)-1;
    int number = 0;

    remove_abandoned_files(out->target);
    for (int i = 0; i < MAX_TRIES; i++) {
        out->tmp = make_temporary_name(
            out->target, __atomic_fetch_add(&counter, 1, __ATOMIC_RELAXED));
        if (!out->tmp)
            return glint_error_report(error, GLINT_E_MEMORY, out->name,
                                      "no memory for a file name");
        out->fd = create_temporary_file(out->tmp, keep ? 0600 : 0666);
        if (out->fd >= 0)
            break;
        number = errno;
        free(out->tmp);
        out->tmp = NULL;
        if (number != EEXIST)
            break;
    }
    if (out->fd < 0)
        return report_temporary_file_failure(out, number, error);
    /* The lock shows remove_abandoned_files() that the file is in use. */
    flock(out->fd, LOCK_EX | LOCK_NB);
    if (keep && fchmod(out->fd, mode) < 0)
        return report_open_refusal(out, error, errno);
    return GLINT_OK;
}

/* Resolves the links of OUT's name and sets OUT's target, unless the file
 * exists and is not regular. Sets IS_THERE to whether the file exists, and ST
 * to its stat data. Tries again if another process replaces the file at the
 * same time, which happens if several jobs finish together. Returns 0 or an
 * errno. */
static int find_output_target(struct glint_output *out, struct stat *st,
                              bool *is_there)
{
    for (int i = 0; i < MAX_TRIES; i++) {
        *is_there = stat(out->name, st) == 0;
        if (!*is_there && (errno != ENOENT || !*out->name))
            return errno;
        if (*is_there && !S_ISREG(st->st_mode))
            return 0;
        if (*is_there && access(out->name, W_OK) < 0)
            return errno;
        out->target = resolve_links_of_target(out->name, *is_there ? st : NULL);
        if (out->target)
            return 0;
        if (errno != ESTALE)
            return errno;
    }
    return ESTALE;
}

static enum glint_status open_target_directly(struct glint_output *out,
                                              bool is_stdout,
                                              enum glint_output_kind kind,
                                              struct glint_error *error)
{
    if (is_stdout)
        out->fd = dup(STDOUT_FILENO);
    else
        out->fd = open(out->name, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (out->fd < 0)
        return report_open_refusal(out, error, errno);
    if (kind == GLINT_OUTPUT_BINARY && isatty(out->fd))
        return glint_error_report(error, GLINT_E_OUTPUT, out->name,
                                  "is a terminal; redirect it or name a file");
    return GLINT_OK;
}

enum glint_status glint_output_open(struct glint_output *out, const char *path,
                                    enum glint_output_kind kind,
                                    struct glint_error *error)
{
    const bool is_stdout = !strcmp(path, "-");
    enum glint_status status;
    bool is_there = false;
    struct stat st;
    int number;

    glint_at_death_register(remove_all_temporary_files);
    *out = (struct glint_output){.fd = -1,
                                 .name = is_stdout ? "standard output" : path};
    out->buffer = malloc(BUFFER_BYTES);
    if (!out->buffer)
        status = glint_error_report(error, GLINT_E_MEMORY, out->name,
                                    "no memory for a buffer");
    else if (is_stdout)
        status = open_target_directly(out, true, kind, error);
    else if ((number = find_output_target(out, &st, &is_there)) != 0)
        status = report_open_refusal(out, error, number);
    else if (!out->target)
        status = open_target_directly(out, false, kind, error);
    else
        status = open_temporary_file(
            out, is_there ? st.st_mode & 0777 : (mode_t)-1, error);
    if (status)
        glint_output_abort(out);
    return status;
}

enum glint_status glint_output_check_path(const char *path,
                                          struct glint_error *error)
{
    struct glint_output out;
    enum glint_status status;
    struct stat st;
    const bool is_there = stat(path, &st) == 0;

    if (is_there && S_ISDIR(st.st_mode))
        return glint_error_report(error, GLINT_E_OUTPUT, path,
                                  "is a folder; name a file in it");
    if (!strcmp(path, "-") || (is_there && !S_ISREG(st.st_mode)))
        return GLINT_OK;
    status = glint_output_open(&out, path, GLINT_OUTPUT_TEXT, error);
    if (status == GLINT_OK)
        glint_output_abort(&out);
    return status;
}

/* ----------------------------------------------------------------- writing */

static enum glint_status report_write_failure(const struct glint_output *out,
                                              struct glint_error *error)
{
    return glint_error_report(
        error, out->failed == EPIPE ? GLINT_E_CLOSED : GLINT_E_OUTPUT,
        out->name, "%s", strerror(out->failed));
}

/* Returns whether a failed write should be repeated. If the write would have
 * blocked, waits until FD is writable. */
static bool is_write_retryable(int fd)
{
    struct pollfd writable = {.fd = fd, .events = POLLOUT};

    if (errno == EAGAIN || errno == EWOULDBLOCK)
        return poll(&writable, 1, -1) >= 0 || errno == EINTR;
    return errno == EINTR;
}

static void write_all_bytes(struct glint_output *out, const uint8_t *data,
                            size_t bytes)
{
    while (bytes > 0 && !out->failed) {
        const ssize_t n = write(out->fd, data, bytes);

        if (n >= 0) {
            data += n;
            bytes -= (size_t)n;
        } else if (!is_write_retryable(out->fd)) {
            out->failed = errno;
        }
    }
}

enum glint_status glint_output_write(struct glint_output *out, const void *data,
                                     size_t bytes, struct glint_error *error)
{
    if (bytes > BUFFER_BYTES - out->used) {
        write_all_bytes(out, out->buffer, out->used);
        out->used = 0; /* NOLINT: committing or aborting frees the buffer */
    }
    if (out->failed)
        return report_write_failure(out, error);
    if (bytes >= BUFFER_BYTES) {
        write_all_bytes(out, data, bytes);
    } else {
        memcpy(out->buffer + out->used, data, bytes);
        out->used += bytes;
    }
    return out->failed ? report_write_failure(out, error) : GLINT_OK;
}

enum glint_status glint_output_flush(struct glint_output *out,
                                     struct glint_error *error)
{
    write_all_bytes(out, out->buffer, out->used);
    out->used = 0;
    return out->failed ? report_write_failure(out, error) : GLINT_OK;
}

/* ----------------------------------------------------------------- closing */

enum glint_status glint_output_commit(struct glint_output *out,
                                      struct glint_error *error)
{
    enum glint_status status = glint_output_flush(out, error);

    if (!status && close(out->fd) < 0 && errno != EINTR)
        status = report_open_refusal(out, error, errno);
    else if (status)
        close(out->fd);
    out->fd = -1;
    if (!status && out->tmp && rename(out->tmp, out->target) < 0)
        status = report_open_refusal(out, error, errno);
    if (!status && out->tmp) {
        unregister_temporary_file(out->tmp);
        out->tmp = NULL;
    }
    glint_output_abort(out);
    return status;
}

void glint_output_abort(struct glint_output *out)
{
    if (out->fd >= 0)
        close(out->fd);
    out->fd = -1;
    if (out->tmp) {
        unlink(out->tmp);
        unregister_temporary_file(out->tmp);
    }
    out->tmp = NULL;
    free(out->target);
    out->target = NULL;
    free(out->buffer);
    out->buffer = NULL;
    out->used = 0;
}

enum glint_status glint_output_commit_or_abort(struct glint_output *out,
                                               enum glint_status status,
                                               struct glint_error *error)
{
    if (status == GLINT_OK)
        return glint_output_commit(out, error);
    glint_output_abort(out);
    return status;
}

enum glint_status glint_output_write_and_commit(struct glint_output *out,
                                                const void *data, size_t bytes,
                                                struct glint_error *error)
{
    return glint_output_commit_or_abort(
        out, glint_output_write(out, data, bytes, error), error);
}

enum glint_status glint_output_save_file(const char *path,
                                         enum glint_output_kind kind,
                                         const void *data, size_t bytes,
                                         struct glint_error *error)
{
    struct glint_output out;
    const enum glint_status status = glint_output_open(&out, path, kind, error);

    return status == GLINT_OK
               ? glint_output_write_and_commit(&out, data, bytes, error)
               : status;
}

struct text_stream {
    char **text;
    size_t *bytes, room;
};

static ssize_t append_to_text(void *cookie, const char *data, size_t n)
{
    struct text_stream *const t = cookie;

    if (*t->bytes + n >= t->room) {
        const size_t room = 2 * (*t->bytes + n) + 4096;
        char *const more = realloc(*t->text, room);

        if (!more)
            return 0;
        *t->text = more;
        t->room = room;
    }
    memcpy(*t->text + *t->bytes, data, n);
    *t->bytes += n;
    (*t->text)[*t->bytes] = '\0';
    return (ssize_t)n;
}

static int free_text_stream(void *cookie)
{
    free(cookie);
    return 0;
}

FILE *glint_memory_file_open(char **text, size_t *bytes)
{
    static const cookie_io_functions_t calls = {.write = append_to_text,
                                                .close = free_text_stream};
    struct text_stream *const t = malloc(sizeof *t);
    FILE *file;

    *text = calloc(1, 1); /* empty text, for streams to which nothing is
                             written */
    *bytes = 0;
    if (!t || !*text) {
        free(t);
        return NULL;
    }
    *t = (struct text_stream){text, bytes, 1};
    file = fopencookie(t, "w", calls);
    if (!file)
        free(t);
    return file;
}

bool glint_memory_file_close(FILE *file)
{
    const bool is_whole = fflush(file) == 0 && !ferror(file);

    return fclose(file) == 0 && is_whole;
}
