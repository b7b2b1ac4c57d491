/* SPDX-License-Identifier: MIT */
#include "sdl/sdl.h"

#include <stdlib.h>

#include "posix/error.h"
#include "posix/plugin.h"

static const struct glint_plugin plugin = {
    "glint-sdl.so",    "GLINT_SDL", "glint_sdl_face", "the window plug-in",
    GLINT_SDL_VERSION, "",          "libsdl2-dev",    "window"};

/* ------------------------------------------------------------------- frames */

static void release_sdl_window(struct glint_window *w)
{
    if (w->window)
        w->sdl->close(w->window);
    w->window = NULL;
    glint_panel_close(&w->panel);
    free(w->pixels);
    w->pixels = NULL;
}

/* Closes the window, if there is one, and opens a window for pictures of
 * IMAGE's size. */
static enum glint_status open_window_for_image(struct glint_window *w,
                                               const struct glint_image *image,
                                               struct glint_error *error)
{
    const struct glint_panel_config cfg = {
        .width = image->width,
        .height = image->height,
        .layout = {4, {16, 8}, {8, 8}, {0, 8}, {0, 0}},
        .image_width = image->width,
        .image_height = image->height};
    const char *cause = "no memory";
    enum glint_status status;

    release_sdl_window(w);
    w->width = image->width;
    w->height = image->height;
    status = glint_panel_open(&w->panel, &cfg, error);
    if (status != GLINT_OK)
        return status;
    w->pixels = malloc((size_t)image->width * (size_t)image->height * 4);
    if (w->pixels)
        w->window = w->sdl->open(w->title, image->width, image->height, &cause);
    if (w->window)
        return GLINT_OK;
    status = glint_error_report(error, GLINT_E_DEVICE, "window", "%s", cause);
    release_sdl_window(w);
    return status;
}

static enum glint_status show_frame(struct glint_sink *sink,
                                    const struct glint_image *image,
                                    struct glint_error *error)
{
    struct glint_window *w = (struct glint_window *)sink;
    enum glint_status status = GLINT_OK;
    int shown;

    if (!w->window || image->width != w->width || image->height != w->height)
        status = open_window_for_image(w, image, error);
    if (status != GLINT_OK)
        return status;
    glint_panel_draw(&w->panel, image, w->pixels, 4 * (ptrdiff_t)w->width);
    shown = w->sdl->show(w->window, w->pixels, 4 * w->width);
    if (shown < 0)
        return glint_error_report(error, GLINT_E_DEVICE, "window",
                                  "cannot be drawn into");
    return shown > 0 ? GLINT_E_CLOSED : GLINT_OK;
}

static void close_window(struct glint_sink *sink)
{
    release_sdl_window((struct glint_window *)sink);
}

enum glint_status glint_window_open(struct glint_window *window,
                                    const char *title,
                                    struct glint_error *error)
{
    struct glint_error cause;
    const void *sdl;
    const enum glint_status status = glint_plugin_load(&sdl, &plugin, &cause);

    *window = (struct glint_window){
        .sink = {.put = show_frame, .close = close_window},
        .sdl = sdl,
        .title = title};
    if (!status)
        return GLINT_OK;
    return glint_error_report(
        error, GLINT_E_DEVICE, "window",
        "%s; or a pipe: glint live -o y4m:- ... | ffplay -loglevel error -",
        cause.text);
}
