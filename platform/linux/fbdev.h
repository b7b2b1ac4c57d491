/* SPDX-License-Identifier: MIT
 *
 * linux/fbdev.h - a panel behind /dev/fb0, as a sink.
 *
 *     glint_fbdev_open(&fb, NULL, &options, &error);
 *     fb.sink.put(&fb.sink, &image, &error);       each frame
 *     fb.sink.close(&fb.sink);
 *
 * The mode is taken as it is, never set; what the driver says of its rows
 * (line_length) and bits is believed. Any packed true colour of 16, 24 or 32
 * bits will do (panel/panel.h). Where the driver offers memory for two screens
 * and panning, each frame is drawn unseen and then shown; else it is drawn to
 * the screen that is shown.
 *
 * Each put asks the driver for the mode first: another program may have changed
 * it, and the picture follows; or the framebuffer may be gone, which its memory
 * does not show, as it stays mapped. Only a frame of a new size takes new
 * memory.
 *
 * Meanwhile the console, the terminal of the process or the one in the
 * foreground, is in graphics mode, in which it draws neither text nor cursor.
 * Closing puts its mode back, as do exit() and the deaths that posix/at_death.h
 * lists; then the kernel paints the text again. After kill -9 the console stays
 * dark, and cannot be switched away from, as graphics mode is for programs that
 * switch by themselves. The next run brings the text back; so does SysRq + K,
 * or echo k > /proc/sysrq-trigger from another terminal.
 */
#ifndef GLINT_PLATFORM_LINUX_FBDEV_H
#define GLINT_PLATFORM_LINUX_FBDEV_H

#include <linux/fb.h>

#include "panel/panel.h"

struct glint_fbdev_options {
    enum glint_panel_fit fit;
    bool dither;  /* panel/panel.h */
    bool vsync;   /* With one screen of memory, wait for the panel's refresh if
                     the driver can: less tearing, up to one refresh of time a
                     frame. */
    bool console; /* keep the console in graphics mode */
};

struct glint_fbdev {
    struct glint_sink sink;
    char id[17];       /* name that the driver gives itself */
    int width, height; /* size of the panel */
    struct glint_pixel_layout layout;
    int n_pages;   /* 2: each frame is drawn to the screen not shown */
    bool has_note; /* the console could not be taken */
    struct glint_error note; /* reason for that */

    /* Private. */
    struct glint_fbdev_options options;
    const char *name;                   /* not owned */
    int fd;                             /* -1: closed */
    struct fb_var_screeninfo var, home; /* mode now, and as it was found */
    uint8_t *map;                       /* NULL: not mapped */
    size_t map_bytes, skip_bytes;       /* Pixels begin at map + skip_bytes. */
    size_t stride_bytes, mem_bytes;
    const uint8_t *cleared[2]; /* screens already black around the picture */
    bool has_vsync;
    struct glint_panel panel;
    int console_fd; /* -1: the console is not taken */
};

/* Opens the framebuffer PATH; the string must outlive FB. NULL stands for
 * $FRAMEBUFFER, or /dev/fb0 if that is not set. On failure FB is closed.
 * GLINT_E_DEVICE: no such device, no permission, or nothing that glint can draw
 * on; ERROR states what to do. */
enum glint_status glint_fbdev_open(struct glint_fbdev *fb, const char *path,
                                   const struct glint_fbdev_options *options,
                                   struct glint_error *error);

#endif
