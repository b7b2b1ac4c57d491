/* SPDX-License-Identifier: MIT */
#include "obs/opening.h"

#include <pthread.h>
#include <stdlib.h>

struct opening {
    struct filter *filter; /* the thread's until it is done */
    pthread_mutex_t lock;  /* of these: */
    bool is_done, is_left;
};

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

struct opening *opening_begin(const struct filter_values *values, int width,
                              int height)
{
    struct opening *const o = calloc(1, sizeof *o);
    pthread_t thread;

    if (!o)
        return NULL;
    pthread_mutex_init(&o->lock, NULL);
    o->filter = filter_create("obs", width, height);
    if (o->filter)
        filter_set(o->filter, values);
    if (!o->filter || pthread_create(&thread, NULL, run, o) != 0) {
        finish(o);
        return NULL;
    }
    pthread_detach(thread);
    return o;
}

bool opening_end(struct opening *o, struct filter **filter)
{
    bool is_done;

    pthread_mutex_lock(&o->lock);
    is_done = o->is_done;
    pthread_mutex_unlock(&o->lock);
    if (!is_done)
        return false;
    *filter = o->filter;
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
