/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* for memmem */
#include "assimp/assimp.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/error.h"
#include "posix/input.h"
#include "posix/plugin.h"

enum {
    SECONDS = 60, /* max CPU time, seconds, for reading a mesh */
    SIGNALS = 64, /* signal numbers are 1 .. SIGNALS */
    /* Max MiB of address space of the child process beyond that of glint. An
     * .stl of 2^20 triangles, the max of a scene, needs 2.1 GB. */
    MIB = 3072,
    GLB_HEAD = 20, /* bytes before the JSON text of a binary glTF */
    /* max bytes of the beginning of a glTF that are checked */
    MAX_TEXT = 1 << 26,
    MAX_NODES = 1 << 22
};

#define TOO_MUCH                                                    \
    "needs more than 60 s or 3 GiB to read: the mesh is too large " \
    "(or its parts refer to each other too many times)"

static const struct glint_assimp *load_assimp_plugin(struct glint_error *error)
{
    static const struct glint_plugin plugin = {
        "glint-assimp.so",    "GLINT_ASSIMP",
        "glint_assimp_face",  "the mesh plug-in",
        GLINT_ASSIMP_VERSION, "; without it glint reads only OBJ meshes",
        "libassimp-dev",      "assimp"};
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    /* interface of the loaded plug-in, or NULL; guarded by LOCK */
    static const void *found;
    const struct glint_assimp *face;

    pthread_mutex_lock(&lock);
    if (!found)
        glint_plugin_load(&found, &plugin, error);
    face = found;
    pthread_mutex_unlock(&lock);
    return face;
}

/* Returns the bytes of address space that this process has mapped, or 0 if the
 * number is unknown. */
static rlim_t read_mapped_size(void)
{
    char text[32] = "";
    const int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    const ssize_t n = fd < 0 ? -1 : read(fd, text, sizeof text - 1);

    if (fd >= 0)
        close(fd);
    return n > 0 ? (rlim_t)strtoull(text, NULL, 10) *
                       (rlim_t)sysconf(_SC_PAGESIZE)
                 : 0;
}

/* Runs in the child process and exits. Unblocks signals and restores their
 * default actions, because glint's own handlers would remove the temporary
 * files of the parent process. */
static void run_import_process(const struct glint_assimp *face, int fd,
                               const char *path, unsigned max_triangles)
{
    const struct rlimit time = {SECONDS, SECONDS}, core = {0, 0};
    const struct rlimit memory = {read_mapped_size() + (rlim_t)MIB * 1048576,
                                  RLIM_INFINITY};
    const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    sigset_t all;

    for (int i = 1; i <= SIGNALS; i++)
        signal(i, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* The child must not outlive glint. */
    sigfillset(&all);
    sigprocmask(SIG_UNBLOCK, &all, NULL);
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
    setrlimit(RLIMIT_AS, &memory);
    if (null >= 0)
        dup2(null, 2); /* hides the report of an uncaught C++ exception */
    face->write(fd, path, max_triangles);
    _exit(0);
}

/* Starts the child process, which writes to pipe_fd[1]. Returns its id, or -1
 * with errno set on failure. */
static pid_t start_import_process(const struct glint_assimp *face,
                                  const int pipe_fd[2], const char *path,
                                  unsigned max_triangles)
{
    sigset_t all, before;
    pid_t child;

    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    child = fork();
    if (child == 0) {
        close(pipe_fd[0]);
        run_import_process(face, pipe_fd[1], path, max_triangles);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return child;
}

/* Waits until CHILD has ended; kills it first if its result is no longer needed
 * (IS_WANTED 0). Returns the reason why CHILD failed, or NULL. */
static const char *wait_for_import_process(pid_t child, int is_wanted)
{
    int status = 0;

    if (!is_wanted)
        kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL
                   ? TOO_MUCH
                   : "is damaged: Assimp, which reads it, aborted; convert it "
                     "to .obj";
    return WEXITSTATUS(status) ? "cannot be read" : NULL;
}

/* Removes the status letter (m or x) from the child's output DATA[BYTES].
 * Returns GLINT_OK, or the error that the status letter, the text after it, or
 * FAILURE states. */
static enum glint_status check_import_result(uint8_t *data, size_t *bytes,
                                             const char *path,
                                             const char *failure,
                                             struct glint_error *error)
{
    if (!failure && *bytes < 1)
        failure = "cannot be read";
    if (failure)
        return glint_error_report(error, GLINT_E_FORMAT, path, "%s", failure);
    --*bytes;
    if (data[0] != 'm' && *bytes && memmem(data + 1, *bytes, "bad_alloc", 9))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, path, "%s",
                                  TOO_MUCH);
    if (data[0] != 'm')
        return glint_error_report(error, GLINT_E_FORMAT, path, "%.*s",
                                  (int)(*bytes < 200 ? *bytes : 200),
                                  (const char *)data + 1);
    memmove(data, data + 1, *bytes);
    return GLINT_OK;
}

static size_t read_little_endian_length(const uint8_t *b)
{
    return b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
}

/* Returns whether two nodes of the glTF in TEXT[BYTES] have the same child
 * node. The format forbids that, and Assimp copies shared nodes: ten levels of
 * ten shared children would become 10^10 nodes. */
static int has_node_with_two_parents(const char *text, size_t bytes)
{
    static const char word[] = "\"children\"";
    uint8_t *const seen = calloc(MAX_NODES, 1);
    const char *const end = text + bytes;
    int is_shared = 0;

    while (seen &&
           (text = memmem(text, (size_t)(end - text), word, sizeof word - 1))) {
        text += sizeof word - 1;
        while (text < end && strchr(" \t\r\n:[", *text) && *text)
            text++;
        while (text < end && *text && strchr("0123456789 \t\r\n,", *text)) {
            size_t node = 0;
            int is_number = 0;

            for (; text < end && *text >= '0' && *text <= '9'; text++) {
                is_number = 1;
                node = node < MAX_NODES ? node * 10 + (size_t)(*text - '0')
                                        : MAX_NODES;
            }
            if (is_number && node < MAX_NODES)
                is_shared |= seen[node]++;
            text += !is_number;
        }
    }
    free(seen);
    return is_shared;
}

/* Checks TEXT[BYTES], the beginning of a glTF file of ALL bytes, for missing
 * bytes and shared nodes. Returns NULL, or a text that states the error. A
 * binary glTF begins with a magic number, a version, the length of the file,
 * and the length and type of the JSON chunk. */
static const char *check_gltf(const uint8_t *text, size_t bytes, uintmax_t all)
{
    if (bytes >= 4 && memcmp(text, "glTF", 4) == 0) {
        if (bytes < GLB_HEAD || all < read_little_endian_length(text + 8) ||
            all - GLB_HEAD < read_little_endian_length(text + 12))
            return "is cut off: shorter than the length at its beginning";
        text += GLB_HEAD;
        bytes -= GLB_HEAD;
        if (read_little_endian_length(text - 8) < bytes)
            bytes = read_little_endian_length(text - 8);
    }
    return has_node_with_two_parents((const char *)text, bytes)
               ? "has a node that is the child of two others, which glTF "
                 "forbids"
               : NULL;
}

/* Checks PATH before Assimp reads it: it must be a regular file and, if it
 * is a glTF, must not be cut off and must have no shared nodes. */
static enum glint_status check_mesh_file(const char *path,
                                         struct glint_error *error)
{
    const char *const dot = strrchr(path, '.'), *cause = NULL;
    struct glint_input in;
    struct stat st;
    uint8_t *text;
    size_t n = 0;
    ptrdiff_t got = 1;
    enum glint_status status = glint_input_open_file(&in, path, error);

    if (status != GLINT_OK)
        return status;
    if (fstat(in.fd, &st) < 0 || !S_ISREG(st.st_mode)) {
        glint_input_close(&in);
        return glint_error_report(error, GLINT_E_IO, path, "is not a file");
    }
    if (dot && (!strcasecmp(dot, ".gltf") || !strcasecmp(dot, ".glb"))) {
        const size_t most =
            st.st_size < MAX_TEXT ? (size_t)st.st_size : MAX_TEXT;

        text = malloc(most + 1);
        while (text && got > 0 && n < most) {
            got = glint_input_read_available(&in, text + n, most - n);
            n += got > 0 ? (size_t)got : 0;
        }
        cause = text ? check_gltf(text, n, (uintmax_t)st.st_size) : NULL;
        if (!text)
            status = glint_error_report(error, GLINT_E_MEMORY, path,
                                        "no memory for %zu bytes", most);
        free(text);
    }
    glint_input_close(&in);
    return cause ? glint_error_report(error, GLINT_E_FORMAT, path, "%s", cause)
                 : status;
}

enum glint_status glint_assimp_read_mesh(uint8_t **data, size_t *bytes,
                                         const char *path, size_t max,
                                         unsigned max_triangles,
                                         struct glint_error *error)
{
    const struct glint_assimp *const face = load_assimp_plugin(error);
    struct glint_input in = {.name = path};
    enum glint_status status;
    const char *failure;
    int pipe_fd[2];
    pid_t child;

    *data = NULL;
    *bytes = 0;
    if (!face)
        return GLINT_E_UNSUPPORTED;
    status = check_mesh_file(path, error);
    if (status != GLINT_OK)
        return status;
    if (pipe(pipe_fd) < 0)
        return glint_error_report_errno(error, GLINT_E_IO, path, errno);
    child = start_import_process(face, pipe_fd, path, max_triangles);
    close(pipe_fd[1]);
    in.fd = pipe_fd[0];
    status = child < 0 ? glint_error_report(error, GLINT_E_MEMORY, path, "%s",
                                            strerror(errno))
                       : glint_input_read_rest(&in, data, bytes, max, error);
    glint_input_close(&in);
    if (child > 0) {
        failure = wait_for_import_process(child, status == GLINT_OK);
        if (status == GLINT_OK)
            status = check_import_result(*data, bytes, path, failure, error);
    }
    if (status != GLINT_OK) {
        free(*data);
        *data = NULL;
    }
    return status;
}
