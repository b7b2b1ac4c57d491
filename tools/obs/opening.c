/* SPDX-License-Identifier: MIT */
#include "obs/opening.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct opening {
    struct flare_settings settings;
    int width, height;
    struct filter *filter; /* the thread's until it is done */
    pthread_mutex_t lock;  /* of these: */
    bool is_done, is_left;
};

void flare_settings_turn(const struct flare_settings *s, struct filter *filter)
{
    static const enum filter_number live[] = {
        FILTER_STRENGTH, FILTER_GAIN, FILTER_STARBURST, FILTER_X, FILTER_Y};

    for (size_t i = 0; i < sizeof live / sizeof *live; i++)
        filter_set_number(filter, live[i], s->number[live[i]]);
}

static bool same(double a, double b)
{
    return !(a < b || a > b);
}

bool flare_settings_serve(const struct flare_settings *a,
                          const struct flare_settings *b)
{
    for (int i = 0; i < FILTER_WORDS; i++)
        if (strcmp(a->word[i], b->word[i]) != 0)
            return false;
    return same(a->number[FILTER_QUALITY], b->number[FILTER_QUALITY]) &&
           same(a->number[FILTER_AUTO], b->number[FILTER_AUTO]);
}

static void finish(struct opening *o)
{
    filter_destroy(o->filter);
    pthread_mutex_destroy(&o->lock);
    free(o);
}

static void *run(void *arg)
{
    struct opening *const o = arg;
    bool is_left;

    filter_open(o->filter); /* if it cannot, drawing will not, either */
    pthread_mutex_lock(&o->lock);
    o->is_done = true;
    is_left = o->is_left;
    pthread_mutex_unlock(&o->lock);
    if (is_left)
        finish(o);
    return NULL;
}

struct opening *opening_begin(const struct flare_settings *settings, int width,
                              int height)
{
    struct opening *const o = calloc(1, sizeof *o);
    pthread_t thread;

    if (!o)
        return NULL;
    o->settings = *settings;
    o->width = width;
    o->height = height;
    pthread_mutex_init(&o->lock, NULL);
    o->filter = filter_create("obs", width, height);
    for (int i = 0; o->filter && i < FILTER_WORDS; i++)
        filter_set_word(o->filter, (enum filter_word)i, settings->word[i]);
    for (int i = 0; o->filter && i < FILTER_NUMBERS; i++)
        filter_set_number(o->filter, (enum filter_number)i,
                          settings->number[i]);
    if (!o->filter || pthread_create(&thread, NULL, run, o) != 0) {
        finish(o);
        return NULL;
    }
    pthread_detach(thread);
    return o;
}

bool opening_end(struct opening *o, struct filter **filter,
                 struct flare_settings *settings, int *width, int *height)
{
    bool is_done;

    pthread_mutex_lock(&o->lock);
    is_done = o->is_done;
    pthread_mutex_unlock(&o->lock);
    if (!is_done)
        return false;
    *filter = o->filter;
    *settings = o->settings;
    *width = o->width;
    *height = o->height;
    o->filter = NULL;
    finish(o);
    return true;
}

void opening_leave(struct opening *o)
{
    bool is_done;

    if (!o)
        return;
    pthread_mutex_lock(&o->lock);
    is_done = o->is_done;
    o->is_left = true;
    pthread_mutex_unlock(&o->lock);
    if (is_done)
        finish(o);
}
