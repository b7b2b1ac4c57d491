/* SPDX-License-Identifier: MIT
 *
 * fake_fb.h - a fake framebuffer and console: two files, and an ioctl() that
 * answers requests for them. Tests link it with
 * --wrap=open64,ioctl,mmap64,munmap,malloc.
 */
#ifndef GLINT_SUPPORT_FAKE_FB_H
#define GLINT_SUPPORT_FAKE_FB_H

#include <stdbool.h>
#include <stdint.h>

#include <linux/fb.h>

enum { FB_BYTES = 65536 };

extern char fake_fb_path[], fake_tty_path[]; /* templates for mkstemp() */

struct fake_fb {
    struct fb_fix_screeninfo fix;
    struct fb_var_screeninfo var;
    bool gone, can_pan;
    int open_errno, vsync_errno, n_vsync, n_pan;
    int tty_errno, tty_mode, tty_switching;
    /* var.yoffset when text mode was restored, rows */
    uint32_t yoffset_at_text;
};
/* set by the test; shared with forked processes */
extern struct fake_fb *fake_fb;

/* number of calls so far that could be made to fail */
extern int fake_fb_calls;
/* which of these calls fails, counted from 1; 0: none */
extern int fake_fb_fail_at;
extern int fake_fb_maps;

#endif
