/* SPDX-License-Identifier: MIT
 *
 * The window plug-in glint-sdl.so. No other file of glint uses SDL2. */
#include <SDL2/SDL.h>
#include <stdlib.h>

#include "sdl/sdl.h"

struct view {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
};

static void close_sdl_window(void *window)
{
    struct view *v = window;

    if (v->texture)
        SDL_DestroyTexture(v->texture);
    if (v->renderer)
        SDL_DestroyRenderer(v->renderer);
    if (v->window)
        SDL_DestroyWindow(v->window);
    SDL_Quit();
    free(v);
}

/* Opens a window for pictures of WIDTH x HEIGHT, and halves its size until
 * it fits the desktop. On failure v->texture stays NULL. */
static void create_fitting_window(struct view *v, const char *title, int width,
                                  int height)
{
    SDL_Rect room = {0, 0, width, height};
    double scale = 1;

    SDL_GetDisplayUsableBounds(0, &room);
    while (room.w > 0 && room.h > 0 &&
           (width / scale > room.w || height / scale > room.h))
        scale *= 2;
    v->window = SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED,
                                 SDL_WINDOWPOS_UNDEFINED, (int)(width / scale),
                                 (int)(height / scale), SDL_WINDOW_RESIZABLE);
    if (v->window)
        v->renderer = SDL_CreateRenderer(v->window, -1, 0);
    if (!v->renderer)
        return;
    SDL_RenderSetLogicalSize(v->renderer, width, height);
    v->texture = SDL_CreateTexture(v->renderer, SDL_PIXELFORMAT_RGB888,
                                   SDL_TEXTUREACCESS_STREAMING, width, height);
}

static void *open_sdl_window(const char *title, int width, int height,
                             const char **cause)
{
    struct view *v = calloc(1, sizeof *v);

    *cause = "no memory";
    if (!v)
        return NULL;
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    if (SDL_Init(SDL_INIT_VIDEO) == 0)
        create_fitting_window(v, title, width, height);
    if (v->texture)
        return v;
    *cause = SDL_GetError();
    close_sdl_window(v);
    return NULL;
}

static int is_close_request(const SDL_Event *event)
{
    return event->type == SDL_QUIT || (event->type == SDL_KEYDOWN &&
                                       (event->key.keysym.sym == SDLK_ESCAPE ||
                                        event->key.keysym.sym == SDLK_q));
}

static int show_pixels(void *window, const void *pixels, int stride)
{
    struct view *v = window;
    SDL_Event event;

    while (SDL_PollEvent(&event))
        if (is_close_request(&event))
            return 1;
    if (SDL_UpdateTexture(v->texture, NULL, pixels, stride) != 0)
        return -1;
    SDL_RenderClear(v->renderer);
    SDL_RenderCopy(v->renderer, v->texture, NULL, NULL);
    SDL_RenderPresent(v->renderer);
    return 0;
}

__attribute__((visibility("default"))) const struct glint_sdl glint_sdl_face = {
    GLINT_SDL_VERSION, open_sdl_window, show_pixels, close_sdl_window};
