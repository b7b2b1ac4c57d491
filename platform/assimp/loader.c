/* SPDX-License-Identifier: MIT */
#include "assimp/assimp.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/error.h"
#include "posix/input.h"
#include "posix/plugin.h"

enum {
    SECONDS = 60, /* of the processor that a mesh may take */
    SIGNALS = 64  /* that a system has, at most */
};

static const struct glint_assimp *load(struct glint_error *error)
{
    static const struct glint_plugin plugin = {
        "glint-assimp.so",    "GLINT_ASSIMP",
        "glint_assimp_face",  "the mesh plug-in",
        GLINT_ASSIMP_VERSION, ", so that only OBJ meshes are read",
        "libassimp-dev",      "assimp"};
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static const struct glint_assimp *found; /* under LOCK; stays loaded */
    const struct glint_assimp *face;

    pthread_mutex_lock(&lock);
    if (!found)
        found = glint_plugin_load(&plugin, error);
    face = found;
    pthread_mutex_unlock(&lock);
    return face;
}

/* The other process, until it exits. Signals, which are all blocked, are taken
 * as a process takes them by itself: glint's handlers would clean up after a
 * glint that lives on. */
static void be_the_child(const struct glint_assimp *face, int fd,
                         const char *path, unsigned max_triangles)
{
    const struct rlimit time = {SECONDS, SECONDS}, core = {0, 0};
    const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    sigset_t all;

    for (int i = 1; i <= SIGNALS; i++)
        signal(i, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* not longer than glint lives */
    sigfillset(&all);
    sigprocmask(SIG_UNBLOCK, &all, NULL);
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
    if (null >= 0)
        dup2(null, 2); /* what is said of an exception that nobody takes */
    face->write(fd, path, max_triangles);
    _exit(0);
}

/* Starts the other process; TO is what it writes to. Returns -1 with errno set
 * on failure. */
static pid_t start(const struct glint_assimp *face, const int pipe_fd[2],
                   const char *path, unsigned max_triangles)
{
    sigset_t all, before;
    pid_t child;

    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    child = fork();
    if (child == 0) {
        close(pipe_fd[0]);
        be_the_child(face, pipe_fd[1], path, max_triangles);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return child;
}

/* Ends CHILD, if need be. Returns why it failed, or NULL. */
static const char *end(pid_t child, int is_wanted)
{
    int status = 0;

    if (!is_wanted)
        kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL
                   ? "takes too long, or too much memory, to read"
                   : "is damaged: Assimp, which reads it, aborted; convert it "
                     "to .obj";
    return WEXITSTATUS(status) ? "cannot be read" : NULL;
}

/* Takes the letter off DATA[BYTES] and says what it means. */
static enum glint_status judge(uint8_t *data, size_t *bytes, const char *path,
                               const char *failure, struct glint_error *error)
{
    if (!failure && *bytes < 1)
        failure = "cannot be read";
    if (failure)
        return glint_error_report(error, GLINT_E_FORMAT, path, "%s", failure);
    --*bytes;
    if (data[0] != 'm')
        return glint_error_report(error, GLINT_E_FORMAT, path, "%.*s",
                                  (int)(*bytes < 200 ? *bytes : 200),
                                  (const char *)data + 1);
    memmove(data, data + 1, *bytes);
    return GLINT_OK;
}

enum glint_status glint_assimp_read(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    unsigned max_triangles,
                                    struct glint_error *error)
{
    const struct glint_assimp *const face = load(error);
    struct glint_input in = {.name = path};
    enum glint_status status;
    const char *failure;
    int pipe_fd[2];
    pid_t child;

    *data = NULL;
    *bytes = 0;
    if (!face)
        return GLINT_E_UNSUPPORTED;
    if (access(path, R_OK) < 0 || pipe(pipe_fd) < 0)
        return glint_error_report(error, GLINT_E_IO, path, "%s",
                                  strerror(errno));
    child = start(face, pipe_fd, path, max_triangles);
    close(pipe_fd[1]);
    in.fd = pipe_fd[0];
    status = child < 0 ? glint_error_report(error, GLINT_E_MEMORY, path, "%s",
                                            strerror(errno))
                       : glint_input_append(&in, data, bytes, max, error);
    glint_input_close(&in);
    if (child > 0) {
        failure = end(child, status == GLINT_OK);
        if (status == GLINT_OK)
            status = judge(*data, bytes, path, failure, error);
    }
    if (status != GLINT_OK) {
        free(*data);
        *data = NULL;
    }
    return status;
}
