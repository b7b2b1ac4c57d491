/* SPDX-License-Identifier: MIT
 *
 * fake_fb.h - a framebuffer and a console that are files, and an ioctl() that
 * answers for them. Tests link it with
 * --wrap=open64,ioctl,mmap64,munmap,malloc.
 */
#ifndef GLINT_SUPPORT_FAKE_FB_H
#define GLINT_SUPPORT_FAKE_FB_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/fb.h>

enum { FB_BYTES = 65536 };

extern char fake_fb_path[], fake_tty_path[]; /* templates of mkstemp */

struct fake_fb {
    struct fb_fix_screeninfo fix;
    struct fb_var_screeninfo var;
    bool gone, can_pan;
    int open_errno, vsync_errno, n_vsync, n_pan;
    int tty_errno, tty_mode, tty_switching;
    uint32_t yoffset_at_text; /* var.yoffset, lines, when text mode came back */
};
extern struct fake_fb *fake_fb; /* set by the test, shared with forks */

extern int fake_fb_calls;   /* calls so far of those that
                               fake_fb_fail_at can make fail */
extern int fake_fb_fail_at; /* number of the call that fails, from 1; 0: none */
extern int fake_fb_maps;

#endif
