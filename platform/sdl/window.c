/* SPDX-License-Identifier: MIT */
#include "sdl/sdl.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "posix/error.h"
#include "posix/process.h"

#define PLUGIN     "glint-sdl.so"
#define PATH_BYTES 4096

static const struct glint_sdl *load(const char *path)
{
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const struct glint_sdl *face =
        handle ? dlsym(handle, "glint_sdl_face") : NULL;

    return face && face->version == GLINT_SDL_VERSION ? face : NULL;
}

/* Loads the plug-in at BEHIND, a path from the folder of the executable.
 * Returns NULL if it is not there. */
static const struct glint_sdl *load_near(const char *behind)
{
    char path[PATH_BYTES + 64];
    const ssize_t n = readlink("/proc/self/exe", path, PATH_BYTES - 1);
    char *slash;

    if (n <= 0)
        return NULL;
    path[n] = '\0';
    slash = strrchr(path, '/');
    if (!slash)
        return NULL;
    snprintf(slash, sizeof path - (size_t)(slash - path), "/%s", behind);
    return access(path, F_OK) == 0 ? load(path) : NULL;
}

static const struct glint_sdl *search(void)
{
    const char *const stated = glint_process_setting("GLINT_SDL");
    const struct glint_sdl *face;

    if (stated && *stated)
        return load(stated);
    face = load_near(PLUGIN);
    if (!face)
        face = load_near("../lib/glint/" PLUGIN);
#ifdef GLINT_PLUGIN_DIR
    if (!face)
        face = load(GLINT_PLUGIN_DIR "/" PLUGIN);
#endif
    return face;
}

/* ------------------------------------------------------------------- frames */

static void give_up(struct glint_window *w)
{
    if (w->window)
        w->sdl->close(w->window);
    w->window = NULL;
    glint_panel_close(&w->panel);
    free(w->pixels);
    w->pixels = NULL;
}

/* Opens a window for pictures of IMAGE's size and closes the one before. */
static enum glint_status begin(struct glint_window *w,
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

    give_up(w);
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
    give_up(w);
    return status;
}

static enum glint_status put(struct glint_sink *sink,
                             const struct glint_image *image,
                             struct glint_error *error)
{
    struct glint_window *w = (struct glint_window *)sink;
    enum glint_status status = GLINT_OK;
    int shown;

    if (!w->window || image->width != w->width || image->height != w->height)
        status = begin(w, image, error);
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
    give_up((struct glint_window *)sink);
}

enum glint_status glint_window_open(struct glint_window *window,
                                    const char *title,
                                    struct glint_error *error)
{
    *window = (struct glint_window){
        .sink = {put, close_window}, .sdl = search(), .title = title};
    if (window->sdl)
        return GLINT_OK;
    return glint_error_report(
        error, GLINT_E_DEVICE, "window",
        "needs glint-sdl.so ('make window', with libsdl2-dev); or a pipe: "
        "glint live -o y4m:- ... | ffplay -loglevel error -");
}
