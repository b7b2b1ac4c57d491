/* SPDX-License-Identifier: MIT */
#include "linux/console.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <linux/kd.h>
#include <linux/vt.h>

#include "posix/at_death.h"
#include "posix/error.h"

/* put_back() reads these when the process dies, so that all are atomic. */
static int held_fd = -1;
static int held_mode; /* mode of the console before */
/* process that took the console; its children leave it alone */
static pid_t holder;

/* Puts the console back into its mode. Async-signal-safe, as ioctl() is only a
 * system call in Linux. */
static void put_back(void)
{
    const int saved = errno;
    const int fd = __atomic_load_n(&held_fd, __ATOMIC_SEQ_CST);

    if (fd >= 0 && getpid() == __atomic_load_n(&holder, __ATOMIC_SEQ_CST))
        ioctl(fd, KDSETMODE, __atomic_load_n(&held_mode, __ATOMIC_SEQ_CST));
    errno = saved;
}

void glint_console_watch(void)
{
    glint_at_death(put_back);
}

/* Opens PATH as *FD. Returns the mode to put it back into later, or -1 with
 * errno set. */
static int open_console(const char *path, int *fd)
{
    struct vt_mode switching;
    int mode = KD_TEXT, saved;

    *fd = open(path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (*fd < 0)
        return -1;
    if (ioctl(*fd, KDGETMODE, &mode) < 0) {
        saved = errno;
        close(*fd);
        *fd = -1;
        errno = saved;
        return -1;
    }
    /* A program that draws has the kernel ask it before it switches. Graphics
     * mode without that (VT_AUTO) was left by a program that was killed. */
    if (mode == KD_GRAPHICS && ioctl(*fd, VT_GETMODE, &switching) == 0 &&
        switching.mode == VT_AUTO)
        mode = KD_TEXT;
    return mode;
}

static bool refuse(struct glint_console *console, struct glint_error *note,
                   const char *cause)
{
    if (console->fd >= 0)
        close(console->fd);
    console->fd = -1;
    glint_error_report(note, GLINT_E_DEVICE, "console",
                       "%s; text and cursor may show in the picture", cause);
    return false;
}

bool glint_console_take(struct glint_console *console, struct glint_error *note)
{
    int mode = open_console("/dev/tty", &console->fd);

    if (mode < 0)
        mode = open_console("/dev/tty0", &console->fd);
    if (mode < 0)
        return refuse(console, note,
                      errno == ENOENT || errno == ENXIO || errno == ENODEV
                          ? "there is none"
                          : strerror(errno));
    if (mode == KD_GRAPHICS)
        return refuse(console, note, "another program draws on it");
    __atomic_store_n(&held_mode, mode, __ATOMIC_SEQ_CST);
    __atomic_store_n(&holder, getpid(), __ATOMIC_SEQ_CST);
    __atomic_store_n(&held_fd, console->fd, __ATOMIC_SEQ_CST);
    glint_console_watch();
    if (ioctl(console->fd, KDSETMODE, KD_GRAPHICS) < 0) {
        __atomic_store_n(&held_fd, -1, __ATOMIC_SEQ_CST);
        return refuse(console, note, strerror(errno));
    }
    return true;
}

void glint_console_release(struct glint_console *console)
{
    if (console->fd < 0)
        return;
    put_back();
    __atomic_store_n(&held_fd, -1, __ATOMIC_SEQ_CST);
    close(console->fd);
    console->fd = -1;
}
