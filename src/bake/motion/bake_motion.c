/* SPDX-License-Identifier: MIT */
#include "bake/motion/recorded.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is warned of, of the span. */
#define BAD_RESIDUAL 1e-3
#define REACH        1e6

void glint_motion_defaults(struct glint_motion_options *options)
{
    *options = (struct glint_motion_options){GLINT_MOTION_ALL, true};
}

struct glint_motion_baker *
glint_motion_baker_open(const struct glint_motion_options *options)
{
    struct glint_motion_baker *b = calloc(1, sizeof *b);

    if (!b)
        return NULL;
    b->options = *options;
    b->sensed = (struct glint_rigid){
        {0, 0, 0}, {1, 0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    glint_localiser_init(&b->localiser, options->fit, options->average,
                         GLINT_DOUBLE);
    return b;
}

void glint_motion_baker_close(struct glint_motion_baker *baker)
{
    if (!baker)
        return;
    free(baker->pose);
    free(baker->event);
    free(baker->intensity);
    free(baker);
}

static enum glint_status fail(struct glint_error *error, const char *cause)
{
    snprintf(error->text, sizeof error->text, "%s", cause);
    return GLINT_E_LENS;
}

enum glint_status glint_motion_baker_body(struct glint_motion_baker *baker,
                                          const struct glint_motion_body *body,
                                          struct glint_error *error)
{
    if (!(body->size >= 0 && body->size <= REACH))
        return fail(error, "the size of the body is not within 0 .. 1e6");
    if (!(body->angle_deg >= 0.01 && body->angle_deg <= 360))
        return fail(error, "the angle of view is not within 0.01 .. 360 "
                           "degrees");
    if (body->n_sensors > GLINT_MOTION_MAX_SENSORS)
        return fail(error, "more than 32 sensors");
    for (int i = 0; i < body->n_sensors; i++)
        if (!isfinite(body->theta[i]) || !isfinite(body->phi[i]))
            return fail(error, "the direction of a sensor is not finite");
    baker->body = *body;
    baker->has_body = true;
    return GLINT_OK;
}

/* ------------------------------------------------------------------- frames */

/* Makes room for N items of BYTES in *MEM; returns false without memory. */
static bool make_room(void **mem, size_t *room, size_t n, size_t bytes)
{
    size_t more = *room;
    void *grown;

    if (n <= *room)
        return true;
    while (more < n)
        more = more < 256 ? 256 : more + more / 4;
    grown = realloc(*mem, more * bytes);
    if (!grown)
        return false;
    *mem = grown;
    *room = more;
    return true;
}

static bool grow(struct glint_motion_baker *b, int n_foods)
{
    void *pose = b->pose, *event = b->event, *intensity = b->intensity;
    size_t poses = b->pose_room, events = b->event_room;
    const size_t each = (size_t)n_foods * (size_t)b->n_intensities;
    bool good =
        make_room(&pose, &poses, (size_t)b->n_frames + 1, sizeof *b->pose) &&
        make_room(&event, &events, (size_t)b->n_events + (size_t)n_foods,
                  sizeof *b->event) &&
        make_room(&intensity, &b->byte_room, b->n_bytes + each, 1);

    b->pose = pose;
    b->event = event;
    b->intensity = intensity;
    b->pose_room = (uint32_t)poses;
    b->event_room = (uint32_t)events;
    return good;
}

static const char *check(const struct glint_motion_baker *b,
                         const struct glint_motion_sight *s)
{
    if (b->n_frames == GLINT_MOTION_MAX_FRAMES)
        return "more than 67108864 frames";
    if (s->n_foods < 3)
        return "fewer than three foods: nothing can be localised";
    if (s->n_foods > GLINT_MOTION_MAX_FOODS)
        return "more than 32 foods";
    if (b->n_frames && s->n_foods != b->n_foods)
        return "another number of foods than in the first frame";
    if (b->n_frames && s->n_intensities != b->n_intensities)
        return "another number of intensities than in the first frame";
    for (int i = 0; i < s->n_foods; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(s->food[i][k]) <= REACH))
                return "a food's place is not within +-1e6";
    for (int k = 0; k < 3; k++)
        if (!(fabs(s->tv[k]) <= REACH) || !(fabs(s->rv[k]) <= REACH))
            return "rv or tv is not within +-1e6";
    return NULL;
}

/* Adds what the body's own senses say to what they said. */
static void add_senses(struct glint_motion_baker *b,
                       const struct glint_motion_sight *s,
                       const struct glint_rigid *pose)
{
    struct glint_rigid *r = &b->sensed;
    double moved[3], row[3][3] = {{0}}, axis[3] = {0, 0, 0}, off = 0;
    const double angle =
        sqrt(s->rv[0] * s->rv[0] + s->rv[1] * s->rv[1] + s->rv[2] * s->rv[2]);
    const double c = cos(angle), sine = sin(angle);

    for (int k = 0; k < 3; k++) {
        b->report.has_senses |= s->rv[k] != 0 || s->tv[k] != 0;
        axis[k] = angle > 0 ? s->rv[k] / angle : 0;
    }
    glint_rigid_take(r, s->tv, moved);
    memcpy(r->at, moved, sizeof moved);
    for (int i = 0; i < 3; i++) {
        /* Rodrigues' formula gives column i: where axis i of the new body lies
         * in the axes of the old one. */
        double to[3];

        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;

            to[k] = (1 - c) * axis[i] * axis[k] + (k == i ? c : 0) +
                    sine * ((m == i ? axis[l] : 0) - (l == i ? axis[m] : 0));
        }
        for (int k = 0; k < 3; k++)
            row[k][i] = r->row[k][0] * to[0] + r->row[k][1] * to[1] +
                        r->row[k][2] * to[2];
    }
    glint_rigid_nearest((const double(*)[3])row, r);
    for (int k = 0; k < 3; k++)
        off += (r->at[k] - pose->at[k]) * (r->at[k] - pose->at[k]);
    b->report.senses_off = sqrt(off);
    b->report.senses_most = fmax(b->report.senses_most, sqrt(off));
}

static void keep_intensities(struct glint_motion_baker *b,
                             const struct glint_motion_sight *s)
{
    for (int i = 0; i < s->n_foods; i++)
        for (int k = 0; k < b->n_intensities; k++) {
            const double x = s->intensity[i][k];
            const double held = x > 0 ? fmin(x, 1) : 0; /* a NaN is 0 */

            b->report.held_intensities += !(held == x);
            b->intensity[b->n_bytes++] = (uint8_t)lrint(255 * held);
        }
}

/* Keeps a located frame. */
static void keep(struct glint_motion_baker *b,
                 const struct glint_motion_sight *s, const bool *is_new,
                 const struct glint_located *located)
{
    struct glint_recorded_pose *p = &b->pose[b->n_frames];

    for (int k = 0; k < 3; k++)
        p->at[k] = located->pose.at[k];
    for (int k = 0; k < 4; k++)
        p->turn[k] = (float)located->pose.turn[k];
    p->residual = (float)located->residual;
    for (int i = 0; i < s->n_foods; i++) {
        if (is_new[i]) {
            b->lives[i] = b->n_events;
            b->event[b->n_events++] = (struct glint_recorded_food){
                .frame = b->n_frames, .slot = (uint32_t)i};
            b->report.n_resets += b->n_frames > 0;
        }
        /* the last frame of its life says the most */
        memcpy(b->event[b->lives[i]].at, b->localiser.place[i],
               sizeof b->event->at);
    }
    keep_intensities(b, s);
    b->n_frames++;
}

enum glint_status
glint_motion_baker_frame(struct glint_motion_baker *baker,
                         const struct glint_motion_sight *sight,
                         struct glint_error *error)
{
    struct glint_motion_baker *b = baker;
    bool is_new[GLINT_MOTION_MAX_FOODS];
    struct glint_located located;
    const char *wrong = check(b, sight);

    if (!wrong && b->n_frames && sight->number >= 0 && b->number >= 0 &&
        sight->number != b->number + 1) {
        snprintf(error->text, sizeof error->text,
                 sight->number > b->number
                     ? "frames are missing: %lld follows %lld"
                     : "frames are out of order: %lld follows %lld",
                 sight->number, b->number);
        return GLINT_E_LENS;
    }
    if (wrong)
        return fail(error, wrong);
    for (int i = 0; i < sight->n_foods; i++)
        is_new[i] = b->n_frames == 0 || sight->is_new[i];
    b->n_intensities = sight->n_intensities;
    if (!grow(b, sight->n_foods))
        return GLINT_E_MEMORY;
    wrong = glint_localise(&b->localiser, sight->n_foods, sight->food, is_new,
                           &located);
    if (wrong)
        return fail(error, wrong);
    b->n_foods = sight->n_foods;
    b->number = sight->number;
    if (b->n_frames)
        add_senses(b, sight, &located.pose);
    keep(b, sight, is_new, &located);
    return GLINT_OK;
}

/* ------------------------------------------------------------------- finish */

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static void sum_up(const struct glint_motion_baker *b,
                   struct glint_motion_report *r)
{
    double low[3], high[3], squares = 0;

    glint_recorded_box(b, low, high);
    *r = b->report;
    r->n_frames = (long)b->n_frames;
    r->span = distance(low, high);
    for (uint32_t i = 0; i < b->n_frames; i++) {
        const double residual = (double)b->pose[i].residual;

        r->path += i ? distance(b->pose[i].at, b->pose[i - 1].at) : 0;
        squares += residual * residual;
        r->bad_frames += residual > BAD_RESIDUAL * r->span;
        if (residual > r->residual) {
            r->residual = residual;
            r->residual_frame = (long)i;
        }
    }
    r->residual_rms = b->n_frames ? sqrt(squares / b->n_frames) : 0;
}

enum glint_status glint_motion_baker_finish(struct glint_motion_baker *baker,
                                            const char *name, uint64_t key,
                                            unsigned char **data, size_t *bytes,
                                            struct glint_motion_report *report,
                                            struct glint_error *error)
{
    const struct glint_motion_baker *b = baker;

    error->text[0] = '\0';
    if (!b->has_body)
        return fail(error,
                    "there is no structure: size, sensors, angle of view; a "
                    "lens file of another program goes to glint import");
    if (!b->n_frames)
        return fail(error, "there are no frames");
    if (b->n_intensities > 1 && b->n_intensities != b->body.n_sensors) {
        snprintf(error->text, sizeof error->text,
                 "foods have %d intensities, but there are %d sensors",
                 b->n_intensities, b->body.n_sensors);
        return GLINT_E_LENS;
    }
    sum_up(b, report);
    return glint_motion_write(b, name, key, data, bytes) ? GLINT_OK
                                                         : GLINT_E_MEMORY;
}
