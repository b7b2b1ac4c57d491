/* SPDX-License-Identifier: MIT
 *
 * linux/console.h - keeping the kernel's text off the panel while pictures are
 * shown.
 *
 *     if (!glint_console_take(&console, &note))    puts it in graphics mode
 *         ... tell NOTE to those who want to know, and go on
 *     glint_console_release(&console);             puts it back
 *
 * In graphics mode the console draws neither text nor cursor. It is the
 * terminal that the process belongs to, or the one in the foreground. Its mode
 * comes back by release, and also by exit() and all that posix/at_death.h
 * lists, whereupon the kernel paints the text anew.
 *
 * After kill -9 the console stays dark, and cannot be switched away from: that
 * mode is for programs that switch by themselves. Whatever takes and releases
 * the console next, as the next run does, brings the text back. So does
 * SysRq + K, or echo k > /proc/sysrq-trigger from elsewhere.
 */
#ifndef GLINT_PLATFORM_LINUX_CONSOLE_H
#define GLINT_PLATFORM_LINUX_CONSOLE_H

#include <stdbool.h>

#include "glint/status.h"

struct glint_console {
    int fd; /* -1: not taken */
};

/* One at a time in a process. False: there is none (no permission, a terminal
 * elsewhere), and NOTE says so in a line. */
bool glint_console_take(struct glint_console *console,
                        struct glint_error *note);

/* Puts itself on the list of posix/at_death.h, as take does: for those who must
 * be put right before the console is, and so come after it on that list. */
void glint_console_watch(void);

/* Does nothing when not taken. */
void glint_console_release(struct glint_console *console);

#endif
