/* SPDX-License-Identifier: MIT */
#include "live/live_bake.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "model/cache_file.h"
#include "model/opened_lens.h"

/* Frames come first, but exact rays must not keep the bake from ending. */
enum { PRIORITY = 10 };

/* Bakes the lens of SETTINGS and ends the process. Only this thread exists in
 * the child process, so the bake has no workers. */
static void bake_and_exit(const struct tool *tool,
                          const struct settings *settings)
{
    static const int of_parent[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2};
    const int null = open("/dev/null", O_RDWR);
    struct opened_lens lens = {.tints = NULL};
    struct settings own = *settings;
    struct tool silent = *tool;
    int code;

    prctl(PR_SET_PDEATHSIG, SIGKILL); /* The child must not outlive glint. */
    /* Signals to all processes of this name or terminal concern the parent,
     * which ends this process. */
    for (size_t i = 0; i < sizeof of_parent / sizeof *of_parent; i++)
        signal(of_parent[i], SIG_IGN);
    setpriority(PRIO_PROCESS, 0, PRIORITY);
    /* A pipe at the standard output must end when the parent ends. */
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    silent.quiet = true;
    silent.workers = NULL;
    own.unbaked = SETTINGS_BAKE;
    code = opened_lens_open(&silent, &lens, &own, own.options.lens);
    _exit(code);
}

bool live_bake_start(struct live_bake *bake, const struct tool *tool,
                     const struct settings *settings)
{
    char folder[CACHE_PATH_BYTES];

    if (!cache_file_find_folder(folder, sizeof folder))
        return false;
    signal(SIGCHLD, SIG_DFL); /* If it is ignored, no exit code is kept. */
    bake->child = fork();
    if (bake->child == 0)
        bake_and_exit(tool, settings);
    return bake->child > 0;
}

enum live_bake_state live_bake_poll(struct live_bake *bake)
{
    int status = 0;
    pid_t ended;

    if (bake->child <= 0)
        return LIVE_BAKE_NONE;
    ended = waitpid(bake->child, &status, WNOHANG);
    if (ended == 0)
        return LIVE_BAKE_RUNNING;
    bake->child = 0;
    return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == EXIT_OK
               ? LIVE_BAKE_DONE
               : LIVE_BAKE_FAILED;
}

void live_bake_stop(struct live_bake *bake)
{
    if (bake->child <= 0)
        return;
    kill(bake->child, SIGKILL);
    waitpid(bake->child, NULL, 0);
    bake->child = 0;
}
