/* SPDX-License-Identifier: MIT
 *
 * The file of a motion, block by block. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/motion/recorded.h"
#include "bake/table/draft.h"
#include "base/blob.h"
#include "base/q.h"
#include "glint/view.h"

enum {
    USUAL_UNIT_LOG2 = 24,
    REACH_LOG2 = 29, /* steps that the farthest place is brought to, at most */
    ROOMY_LOG2 = 3   /* by how many bits a motion may be smaller and have the
                         usual unit */
};

struct writer {
    const struct glint_motion_baker *baker;
    struct glint_draft draft;
    struct glint_motion_header header;
    double scale; /* steps in a unit */
    uint8_t block[GLINT_MOTION_BLOCK];
    size_t used;
    uint32_t number; /* of the block that is filled */
};

/* ------------------------------------------------------------------ blocks */

static void end_block(struct writer *w)
{
    uint32_t end[2] = {w->number, 0};

    if (!w->used)
        return;
    memcpy(w->block + GLINT_MOTION_ROOM, end, sizeof end);
    end[1] = glint_motion_sum(w->block, w->number);
    memcpy(w->block + GLINT_MOTION_ROOM, end, sizeof end);
    glint_draft_put(&w->draft, w->block, sizeof w->block);
    memset(w->block, 0, sizeof w->block);
    w->used = 0;
    w->number++;
}

static void put(struct writer *w, const void *record, size_t bytes)
{
    if (w->used + bytes > GLINT_MOTION_ROOM)
        end_block(w);
    memcpy(w->block + w->used, record, bytes);
    w->used += bytes;
}

/* ------------------------------------------------------------------- tables */

static void place(const struct writer *w, const double from[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = (int32_t)lrint(from[k] * w->scale);
}

static uint32_t steps(const struct writer *w, double length)
{
    return (uint32_t)fmin(ceil(length * w->scale), UINT32_MAX);
}

static void put_sensors(struct writer *w)
{
    const struct glint_motion_body *body = &w->baker->body;

    w->header.sensor_block = w->number;
    for (int i = 0; i < body->n_sensors; i++) {
        const double axis[3] = {sin(body->theta[i]) * cos(body->phi[i]),
                                sin(body->theta[i]) * sin(body->phi[i]),
                                cos(body->theta[i])};
        struct glint_motion_sensor s;

        for (int k = 0; k < 3; k++)
            s.axis_q30[k] = (int32_t)lrint(0x1p30 * axis[k]);
        put(w, &s, sizeof s);
    }
    end_block(w);
}

static void put_events(struct writer *w)
{
    w->header.event_block = w->number;
    for (uint32_t i = 0; i < w->baker->n_events; i++) {
        const struct glint_recorded_food *from = &w->baker->event[i];
        struct glint_motion_event e = {.frame = from->frame,
                                       .slot = from->slot};

        place(w, from->at, e.at);
        put(w, &e, sizeof e);
    }
    end_block(w);
}

static void put_index(struct writer *w)
{
    const struct glint_motion_baker *b = w->baker;
    const uint32_t each =
        glint_motion_per_block(sizeof(struct glint_motion_pose));
    struct glint_motion_index index = {.event = 0};

    w->header.index_block = w->number;
    for (uint32_t first = 0; first < b->n_frames; first += each) {
        double most = 0;

        for (uint32_t i = first; i < b->n_frames && i < first + each; i++)
            most = fmax(most, (double)b->pose[i].residual);
        index.residual = steps(w, most);
        for (;
             index.event < b->n_events && b->event[index.event].frame <= first;
             index.event++)
            index.food[b->event[index.event].slot] = index.event;
        put(w, &index, sizeof index);
    }
    end_block(w);
}

static void put_poses(struct writer *w)
{
    w->header.pose_block = w->number;
    for (uint32_t i = 0; i < w->baker->n_frames; i++) {
        const struct glint_recorded_pose *from = &w->baker->pose[i];
        struct glint_motion_pose p;

        place(w, from->at, p.at);
        for (int k = 0; k < 4; k++)
            p.turn_q14[k] = (int16_t)lrint(0x1p14 * (double)from->turn[k]);
        put(w, &p, sizeof p);
    }
    end_block(w);
}

static void put_intensities(struct writer *w)
{
    const size_t each =
        (size_t)w->baker->n_foods * (size_t)w->baker->n_intensities;

    w->header.intensities = (uint32_t)each;
    w->header.intensity_block = w->number;
    for (uint32_t i = 0; each && i < w->baker->n_frames; i++)
        put(w, w->baker->intensity + i * each, each);
    end_block(w);
}

static void widen(const double at[3], double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(low[k], at[k]);
        high[k] = fmax(high[k], at[k]);
    }
}

void glint_recorded_box(const struct glint_motion_baker *baker, double low[3],
                        double high[3])
{
    for (int k = 0; k < 3; k++)
        low[k] = high[k] = 0;
    for (uint32_t i = 0; i < baker->n_frames; i++)
        widen(baker->pose[i].at, low, high);
    for (uint32_t i = 0; i < baker->n_events; i++)
        widen(baker->event[i].at, low, high);
}

/* ------------------------------------------------------------------- header */

static void set_scale(struct writer *w, const double low[3],
                      const double high[3])
{
    double reach = w->baker->body.size;
    int log2 = USUAL_UNIT_LOG2;

    for (int k = 0; k < 3; k++)
        reach = fmax(reach, fmax(-low[k], high[k]));
    if (reach > 0)
        log2 = REACH_LOG2 - 1 - ilogb(reach);
    if (log2 > USUAL_UNIT_LOG2 && log2 <= USUAL_UNIT_LOG2 + ROOMY_LOG2)
        log2 = USUAL_UNIT_LOG2;
    log2 = q_smaller(q_larger(log2, -30), 60);
    w->header.unit_log2 = log2;
    w->scale = ldexp(1, log2);
}

static void set_header(struct writer *w, const char *name)
{
    const struct glint_motion_baker *b = w->baker;
    struct glint_motion_header *h = &w->header;
    const double half = b->body.angle_deg * GLINT_PI / 360;
    double low[3], high[3], most = 0;

    h->magic = GLINT_MOTION_MAGIC;
    h->version = GLINT_MOTION_VERSION;
    h->variant = (uint32_t)b->options.fit;
    glint_draft_name(h->name, name, "motion");
    glint_recorded_box(b, low, high);
    set_scale(w, low, high);
    h->n_frames = b->n_frames;
    h->n_foods = (uint32_t)b->n_foods;
    h->n_sensors = (uint32_t)b->body.n_sensors;
    h->n_events = b->n_events;
    h->size = (int32_t)lrint(b->body.size * w->scale);
    h->cos_half_q30 = (int32_t)lrint(0x1p30 * cos(half));
    h->tan_half_q24 =
        half < GLINT_PI / 2
            ? (int32_t)lrint(0x1p24 * fmin(fmax(tan(half), 0x1p-12), 64))
            : 1 << 30;
    place(w, low, h->low);
    place(w, high, h->high);
    for (uint32_t i = 0; i < b->n_frames; i++)
        if ((double)b->pose[i].residual > most) {
            most = (double)b->pose[i].residual;
            h->residual_frame = i;
        }
    h->residual = steps(w, most);
}

bool glint_motion_write(const struct glint_motion_baker *baker,
                        const char *name, uint64_t key, unsigned char **data,
                        size_t *bytes)
{
    struct writer w = {.baker = baker};
    uint32_t sum;

    set_header(&w, name);
    w.header.key[0] = (uint32_t)key;
    w.header.key[1] = (uint32_t)(key >> 32);
    put(&w, &w.header, sizeof w.header);
    end_block(&w);
    put_sensors(&w);
    put_events(&w);
    put_index(&w);
    put_poses(&w);
    put_intensities(&w);
    if (w.draft.out_of_memory) {
        free(w.draft.data);
        return false;
    }
    w.header.bytes = (uint32_t)w.draft.bytes;
    glint_draft_amend(&w.draft, 0, &w.header, sizeof w.header);
    sum = glint_motion_sum(w.draft.data, 0);
    glint_draft_amend(&w.draft, GLINT_MOTION_ROOM + 4, &sum, sizeof sum);
    glint_blob_seal(w.draft.data, w.draft.bytes);
    *data = w.draft.data;
    *bytes = w.draft.bytes;
    return true;
}
