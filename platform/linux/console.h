/* SPDX-License-Identifier: MIT
 *
 * linux/console.h - keeping the kernel's text off the panel while pictures are
 * shown.
 *
 *     if (!glint_console_take(&console, &note))    puts it in graphics mode
 *         ... print NOTE, and go on without
 *     glint_console_release(&console);             puts it back
 *
 * In graphics mode the console draws neither text nor cursor. The console is
 * the terminal of the process, or the one in the foreground. Release puts its
 * mode back, as do exit() and the deaths that posix/at_death.h lists; then the
 * kernel paints the text anew.
 *
 * After kill -9 the console stays dark, and cannot be switched away from, as
 * graphics mode is for programs that switch by themselves. The next run, which
 * takes and releases the console, brings the text back. So does SysRq + K, or
 * echo k > /proc/sysrq-trigger from another terminal.
 */
#ifndef GLINT_PLATFORM_LINUX_CONSOLE_H
#define GLINT_PLATFORM_LINUX_CONSOLE_H

#include <stdbool.h>

#include "glint/status.h"

struct glint_console {
    int fd; /* -1: not taken */
};

/* Sets the console to graphics mode; one console at a time in a process.
 * Returns false, with the reason in NOTE, if there is none, permission is
 * missing or another program draws on it. */
bool glint_console_take(struct glint_console *console,
                        struct glint_error *note);

/* Adds the return of the console's mode to the functions of
 * posix/at_death.h, as glint_console_take() does. They run from the newest
 * to the oldest: a function that must run before the console returns is
 * added after this call. */
void glint_console_watch(void);

/* Puts the console back into its mode, if it was taken. */
void glint_console_release(struct glint_console *console);

#endif
