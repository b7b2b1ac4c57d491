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
 * and panning, each frame is drawn unseen and then shown; else it is drawn
 * where it is seen.
 *
 * Each put asks the driver for the mode first: another program may have changed
 * it, and the picture follows; or the framebuffer may be gone, which the memory
 * does not tell, for it stays mapped. A frame of a new size takes new memory,
 * any other none.
 */
#ifndef GLINT_PLATFORM_LINUX_FBDEV_H
#define GLINT_PLATFORM_LINUX_FBDEV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <linux/fb.h>

#include "linux/console.h"
#include "panel/panel.h"
#include "source_sink.h"

struct glint_fbdev_options {
    enum glint_panel_fit fit;
    bool dither;  /* panel/row_pack.h */
    bool vsync;   /* wait for the panel where there is one screen of memory and
                     the driver can: less tearing, up to a refresh a frame */
    bool console; /* take it (linux/console.h) */
};

struct glint_fbdev {
    struct glint_sink sink;
    char id[17];       /* name that the driver gives itself */
    int width, height; /* size of the panel */
    struct glint_pixel_layout layout;
    int n_pages;             /* 2: frames are drawn unseen */
    bool has_note;           /* the console could not be taken: */
    struct glint_error note; /* why */

    /* Private. */
    struct glint_fbdev_options options;
    const char *name;                   /* kept */
    int fd;                             /* -1: closed */
    struct fb_var_screeninfo var, home; /* now, and as we found it */
    uint8_t *map;                       /* NULL: not mapped */
    size_t map_bytes, skip_bytes;       /* pixels begin so far into it */
    size_t stride_bytes, mem_bytes;
    const uint8_t *cleared[2]; /* screens that are black around the picture */
    bool has_vsync;
    struct glint_panel panel;
    struct glint_console console_held;
};

/* PATH is kept; NULL: $FRAMEBUFFER, or /dev/fb0. On failure FB is closed.
 * GLINT_E_DEVICE: there is none, no permission, or nothing glint can draw on;
 * ERROR says what to do. */
enum glint_status glint_fbdev_open(struct glint_fbdev *fb, const char *path,
                                   const struct glint_fbdev_options *options,
                                   struct glint_error *error);

#endif
