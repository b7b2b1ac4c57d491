/* SPDX-License-Identifier: MIT
 *
 * fake_fb.h - a fake framebuffer and a fake console, each of them a file, and
 * an ioctl() that answers the requests of glint. Tests link it with
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
    /* value of var.yoffset, rows, at the moment when glint restored text
     * mode */
    uint32_t yoffset_at_text;
};
/* state of the fake devices, in memory shared with child processes; tests
 * change it to simulate devices and faults */
extern struct fake_fb *fake_fb;

/* number of calls so far that could be made to fail */
extern int fake_fb_calls;
/* number of the call that fails, counted from 1; 0: no call fails */
extern int fake_fb_fail_at;
extern int fake_fb_maps;

#endif
