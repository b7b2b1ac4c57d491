/* SPDX-License-Identifier: MIT
 *
 * linux/fbdev.h - a sink that draws frames to a panel behind /dev/fb0.
 *
 *     glint_fbdev_open(&fb, NULL, &options, &error);
 *     fb.sink.put(&fb.sink, &image, &error); each frame
 *     fb.sink.close(&fb.sink);
 *
 * glint never changes the video mode, and trusts the driver's row stride
 * (line_length) and bit fields. Any packed true-colour format of 16, 24 or 32
 * bits is supported (panel/panel.h). If the driver offers memory for two
 * screens and panning, frames are double-buffered; else they are drawn to the
 * visible screen.
 *
 * Each put() first reads the mode from the driver. If another program has
 * changed it, glint adapts. The call also fails if the device was removed;
 * writing to its memory, which stays mapped, would not fail. Memory is
 * allocated only if the frame's size changes.
 *
 * While the sink is open, the console (the terminal of the process, or the
 * foreground console) is in graphics mode, in which it draws neither text nor
 * cursor. Closing restores its mode, as do exit() and the signals that
 * posix/at_death.h lists; then the kernel redraws the text. After kill -9 the
 * console stays dark and cannot be switched, because in graphics mode the
 * program itself must switch consoles. The next run of glint restores the text,
 * and so do SysRq + K and echo k > /proc/sysrq-trigger from another terminal.
 */
#ifndef GLINT_PLATFORM_LINUX_FBDEV_H
#define GLINT_PLATFORM_LINUX_FBDEV_H

#include <linux/fb.h>

#include "panel/panel.h"

struct glint_fbdev_options {
    enum glint_panel_fit fit;
    /* true: if memory holds only one screen and the driver supports it, wait
     * for the panel's refresh before drawing. This reduces tearing and costs up
     * to one refresh period per frame. */
    bool vsync;
    bool console; /* true: set the console to graphics mode while the sink is
                     open */
};

struct glint_fbdev {
    struct glint_sink sink;
    char id[17];       /* name of the driver */
    int width, height; /* size of the panel, pixels */
    struct glint_pixel_layout layout;
    int n_pages;   /* number of screens in memory, 1 or 2; with 2, each frame is
                      drawn to the hidden screen */
    bool has_note; /* true: the console could not be set to graphics mode */
    /* why the console could not be set to graphics mode */
    struct glint_error note;

    /* Private members. */
    struct glint_fbdev_options options;
    const char *name; /* path of the device; not owned */
    int fd;           /* -1: closed */
    /* Current mode and offset, and the mode and offset before glint panned. */
    struct fb_var_screeninfo var, home;
    uint8_t *map;                 /* mapped memory of the panel; NULL: not
                                     mapped */
    size_t map_bytes, skip_bytes; /* Size of the mapped memory, and offset of
                                     the first pixel in it, bytes. */
    size_t stride_bytes, mem_bytes;
    const uint8_t *cleared[2]; /* addresses of the screens whose borders around
                                  the picture are black already */
    bool has_vsync;
    struct glint_panel panel;
    int console_fd; /* descriptor of the console; -1: the console's mode is not
                       changed */
};

/* Opens the framebuffer PATH; the string must outlive FB. NULL stands for
 * $FRAMEBUFFER, or /dev/fb0 if that is not set. On failure FB is closed.
 * Returns GLINT_E_DEVICE if there is no such device, permission is missing, or
 * glint cannot draw on it; ERROR states what to do. */
enum glint_status glint_fbdev_open(struct glint_fbdev *fb, const char *path,
                                   const struct glint_fbdev_options *options,
                                   struct glint_error *error);

#endif
