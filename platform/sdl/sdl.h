/* SPDX-License-Identifier: MIT
 *
 * sdl/sdl.h - a sink that shows frames in a window on the desktop, through
 * SDL2.
 *
 *     glint_window_open(&window, "glint", &error);
 *     window.sink.put(&window.sink, &image, &error); first: opens it
 *     window.sink.close(&window.sink);
 *
 * SDL2 is linked only to a plug-in, glint-sdl.so, which is loaded when a window
 * is requested, from $GLINT_SDL or the folders that posix/plugin.h lists. The
 * picture keeps its aspect ratio in a window of any size. After the user has
 * closed the window or pressed Escape or q, put returns GLINT_E_CLOSED. */
#ifndef GLINT_PLATFORM_SDL_SDL_H
#define GLINT_PLATFORM_SDL_SDL_H

#include "panel/panel.h"
#include "source_sink.h"

/* Version of this interface. glint rejects plug-ins of other versions. */
#define GLINT_SDL_VERSION 1

struct glint_sdl {
    int version;

    /* Opens a window for pictures of WIDTH x HEIGHT. Returns NULL on failure,
     * with the reason in CAUSE. */
    void *(*open)(const char *title, int width, int height, const char **cause);

    /* Shows PIXELS, four bytes each: B, G, R, unused; rows are STRIDE bytes
     * apart. Returns 0 if the pixels were shown, 1 if the user has closed the
     * window, -1 on failure. */
    int (*show)(void *window, const void *pixels, int stride);
    void (*close)(void *window);
};

struct glint_window {
    struct glint_sink sink;

    /* Private members. */
    const struct glint_sdl *sdl;
    void *window; /* NULL: not open */
    const char *title;
    struct glint_panel panel;
    uint8_t *pixels;
    int width, height; /* size of the pictures that the window shows, pixels */
};

/* Prepares WINDOW. The window appears on the desktop with the first frame.
 * TITLE must outlive WINDOW. If there is no plug-in, returns GLINT_E_DEVICE,
 * and ERROR suggests another way to show frames. */
enum glint_status glint_window_open(struct glint_window *window,
                                    const char *title,
                                    struct glint_error *error);

#endif
