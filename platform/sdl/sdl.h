/* SPDX-License-Identifier: MIT
 *
 * sdl/sdl.h - a window on the desktop, through SDL2.
 *
 *     glint_window_open(&window, "glint", &error);
 *     window.sink.put(&window.sink, &image, &error);   the first one opens it
 *     window.sink.close(&window.sink);
 *
 * SDL2 lives in a plug-in, glint-sdl.so, which is loaded when a window is
 * requested, from the places that posix/plugin.h lists, of which $GLINT_SDL
 * is the first. The picture keeps its shape in a window of any size. Once the
 * user closes it or presses Escape or q, put returns GLINT_E_CLOSED.
 */
#ifndef GLINT_PLATFORM_SDL_SDL_H
#define GLINT_PLATFORM_SDL_SDL_H

#include "panel/panel.h"
#include "source_sink.h"

/* Number of this interface. A plug-in with another number is refused. */
#define GLINT_SDL_VERSION 1

struct glint_sdl {
    int version;

    /* Opens a window for pictures of WIDTH x HEIGHT. Returns NULL on failure,
     * with the reason in CAUSE. */
    void *(*open)(const char *title, int width, int height, const char **cause);

    /* Shows PIXELS, four bytes each, B G R and one unused, STRIDE bytes from
     * row to row. Returns 0 if they were shown, 1 if the user has closed the
     * window, -1 on failure. */
    int (*show)(void *window, const void *pixels, int stride);
    void (*close)(void *window);
};

struct glint_window {
    struct glint_sink sink;

    /* Private. */
    const struct glint_sdl *sdl;
    void *window; /* NULL: not open */
    const char *title;
    struct glint_panel panel;
    uint8_t *pixels;
    int width, height; /* pixels of the window's pictures */
};

/* Prepares WINDOW, which the first frame opens. TITLE must outlive it.
 * GLINT_E_DEVICE: there is no plug-in; ERROR names another way to show
 * frames. */
enum glint_status glint_window_open(struct glint_window *window,
                                    const char *title,
                                    struct glint_error *error);

#endif
