/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/motion/localise.h"
#include "bake/table/draft.h"
#include "base/q.h"
#include "glint/scene/motion_bake.h"
#include "glint/view.h"

struct recorded_pose {
    double at[3];
    float turn[4];
    float residual;
};

/* A food (static landmark) of the recording: its slot, and the frame in which
 * it first appears. */
struct recorded_food {
    uint32_t frame, slot;
    double at[3]; /* final estimate of the food's position */
};

struct glint_motion_baker {
    struct glint_motion_body body;
    bool has_body;
    struct glint_localiser localiser;
    int n_foods, n_intensities;
    uint32_t n_frames, pose_capacity;
    struct recorded_pose *pose; /* pose of the body per frame, [n_frames] */
    uint32_t n_events, event_capacity;
    /* [n_events]: the food items, in the order in which they appear */
    struct recorded_food *event;
    /* [slots]: index in event of the food that currently occupies the slot */
    uint32_t lives[GLINT_MOTION_MAX_FOODS];
    size_t n_bytes, byte_capacity;
    /* intensity codes, [n_frames][n_foods][n_intensities] */
    uint8_t *intensity;
    /* number of the last frame added, as stated in the recording */
    long long number;
    /* pose of the body by its own odometry: its measured motions rv and tv of
     * all frames, combined */
    struct glint_rigid sensed;
    struct glint_motion_report report;
};

enum {
    USUAL_UNIT_LOG2 = 24,
    REACH_LOG2 = 29, /* log2 of the max coordinate of a point, steps */
    /* USUAL_UNIT_LOG2 is also used if a unit up to 2^ROOMY_LOG2 times finer
     * would fit. */
    ROOMY_LOG2 = 3
};

struct writer {
    const struct glint_motion_baker *baker;
    const struct glint_motion_report *report;
    struct glint_draft draft;
    struct glint_motion_header header;
    double scale; /* number of steps per unit of length */
    uint8_t block[GLINT_MOTION_BLOCK];
    size_t used;
    uint32_t number; /* index of the block that is being filled */
};

/* ------------------------------------------------------------------ blocks */

static void finish_motion_block(struct writer *w)
{
    uint32_t end[2] = {w->number, 0};

    if (!w->used)
        return;
    memcpy(w->block + GLINT_MOTION_ROOM, end, sizeof end);
    end[1] = glint_motion_sum(w->block, w->number);
    memcpy(w->block + GLINT_MOTION_ROOM, end, sizeof end);
    glint_draft_append(&w->draft, w->block, sizeof w->block);
    memset(w->block, 0, sizeof w->block);
    w->used = 0;
    w->number++;
}

static void append_block_record(struct writer *w, const void *record,
                                size_t bytes)
{
    if (w->used + bytes > GLINT_MOTION_ROOM)
        finish_motion_block(w);
    memcpy(w->block + w->used, record, bytes);
    w->used += bytes;
}

/* ------------------------------------------------------------------- tables */

static void convert_position_to_steps(const struct writer *w,
                                      const double from[3], int32_t to[3])
{
    for (int k = 0; k < 3; k++)
        to[k] = (int32_t)lrint(from[k] * w->scale);
}

static uint32_t convert_length_to_steps(const struct writer *w, double length)
{
    return (uint32_t)fmin(ceil(length * w->scale), UINT32_MAX);
}

static void append_sensor_table(struct writer *w)
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
        append_block_record(w, &s, sizeof s);
    }
    finish_motion_block(w);
}

static void append_event_table(struct writer *w)
{
    w->header.event_block = w->number;
    for (uint32_t i = 0; i < w->baker->n_events; i++) {
        const struct recorded_food *from = &w->baker->event[i];
        struct glint_motion_event e = {.frame = from->frame,
                                       .slot = from->slot};

        convert_position_to_steps(w, from->at, e.at);
        append_block_record(w, &e, sizeof e);
    }
    finish_motion_block(w);
}

static void append_index_table(struct writer *w)
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
        index.residual = convert_length_to_steps(w, most);
        for (;
             index.event < b->n_events && b->event[index.event].frame <= first;
             index.event++)
            index.food[b->event[index.event].slot] = index.event;
        append_block_record(w, &index, sizeof index);
    }
    finish_motion_block(w);
}

static void append_pose_table(struct writer *w)
{
    w->header.pose_block = w->number;
    for (uint32_t i = 0; i < w->baker->n_frames; i++) {
        const struct recorded_pose *from = &w->baker->pose[i];
        struct glint_motion_pose p;

        convert_position_to_steps(w, from->at, p.at);
        for (int k = 0; k < 4; k++)
            p.turn_q14[k] = (int16_t)lrint(0x1p14 * (double)from->turn[k]);
        append_block_record(w, &p, sizeof p);
    }
    finish_motion_block(w);
}

static void append_intensity_table(struct writer *w)
{
    const size_t each =
        (size_t)w->baker->n_foods * (size_t)w->baker->n_intensities;

    w->header.intensities = (uint32_t)each;
    w->header.intensity_block = w->number;
    for (uint32_t i = 0; each && i < w->baker->n_frames; i++)
        append_block_record(w, w->baker->intensity + i * each, each);
    finish_motion_block(w);
}

static void extend_bounding_box(const double at[3], double low[3],
                                double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(low[k], at[k]);
        high[k] = fmax(high[k], at[k]);
    }
}

/* Sets LOW and HIGH to the bounding box of all positions of the body and the
 * foods. */
static void compute_bounding_box(const struct glint_motion_baker *baker,
                                 double low[3], double high[3])
{
    for (int k = 0; k < 3; k++)
        low[k] = high[k] = 0;
    for (uint32_t i = 0; i < baker->n_frames; i++)
        extend_bounding_box(baker->pose[i].at, low, high);
    for (uint32_t i = 0; i < baker->n_events; i++)
        extend_bounding_box(baker->event[i].at, low, high);
}

/* ------------------------------------------------------------------- header */

static void choose_step_size(struct writer *w, const double low[3],
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

static void set_motion_header(struct writer *w, const char *name, uint64_t key)
{
    static const struct glint_blob_kind kind = {
        .magic = GLINT_MOTION_MAGIC, .version = GLINT_MOTION_VERSION};
    const struct glint_motion_baker *b = w->baker;
    struct glint_motion_header *h = &w->header;
    const double half = b->body.angle_deg * GLINT_PI / 360;
    double low[3], high[3];

    glint_draft_begin_header(h, &kind, 0, key, name, "motion");
    compute_bounding_box(b, low, high);
    choose_step_size(w, low, high);
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
    convert_position_to_steps(w, low, h->low);
    convert_position_to_steps(w, high, h->high);
    h->residual_frame = (uint32_t)w->report->residual_frame;
    h->residual = convert_length_to_steps(w, w->report->residual);
}

/* Writes the baked motion. BAKER must have all frames. Returns false if there
 * is no memory. */
static bool write_motion_file(const struct glint_motion_baker *baker,
                              const struct glint_motion_report *report,
                              const char *name, uint64_t key,
                              unsigned char **data, size_t *bytes)
{
    struct writer w = {.baker = baker, .report = report};
    uint32_t sum;

    set_motion_header(&w, name, key);
    append_block_record(&w, &w.header, sizeof w.header);
    finish_motion_block(&w);
    append_sensor_table(&w);
    append_event_table(&w);
    append_index_table(&w);
    append_pose_table(&w);
    append_intensity_table(&w);
    w.header.bytes = (uint32_t)w.draft.bytes;
    glint_draft_overwrite(&w.draft, 0, &w.header, sizeof w.header);
    sum = w.draft.out_of_memory ? 0 : glint_motion_sum(w.draft.data, 0);
    glint_draft_overwrite(&w.draft, GLINT_MOTION_ROOM + 4, &sum, sizeof sum);
    return glint_draft_finish_file(&w.draft, &w.header, sizeof w.header, true,
                                   data, bytes);
}

/* BAD_RESIDUAL: max residual of the fitted pose of a good frame, as a fraction
 * of the motion's span. REACH: max magnitude of a coordinate. */
#define BAD_RESIDUAL 1e-3
#define REACH        1e6

struct glint_motion_baker *glint_motion_baker_open(void)
{
    struct glint_motion_baker *b = calloc(1, sizeof *b);

    if (!b)
        return NULL;
    b->sensed = (struct glint_rigid){
        {0, 0, 0}, {1, 0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    glint_localiser_init(&b->localiser, true);
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

static enum glint_status set_error_text(struct glint_error *error,
                                        const char *cause)
{
    snprintf(error->text, sizeof error->text, "%s", cause);
    return GLINT_E_LENS;
}

enum glint_status glint_motion_baker_body(struct glint_motion_baker *baker,
                                          const struct glint_motion_body *body,
                                          struct glint_error *error)
{
    if (!(body->size >= 0 && body->size <= REACH))
        return set_error_text(error,
                              "the size of the body is not within 0 .. 1e6");
    if (!(body->angle_deg >= 0.01 && body->angle_deg <= 360))
        return set_error_text(error,
                              "the angle of view is not within 0.01 .. 360 "
                              "degrees");
    if (body->n_sensors > GLINT_MOTION_MAX_SENSORS)
        return set_error_text(error, "more than 32 sensors");
    for (int i = 0; i < body->n_sensors; i++)
        if (!isfinite(body->theta[i]) || !isfinite(body->phi[i]))
            return set_error_text(error,
                                  "the direction of a sensor is not finite");
    baker->body = *body;
    baker->has_body = true;
    return GLINT_OK;
}

/* ------------------------------------------------------------------- frames */

/* Grows the array *MEM such that it has capacity for N items of BYTES each.
 * Returns false if there is no memory. */
static bool grow_memory_array(void **mem, size_t *capacity, size_t n,
                              size_t bytes)
{
    size_t more = *capacity;
    void *grown;

    if (n <= *capacity)
        return true;
    while (more < n)
        more = more < 256 ? 256 : more + more / 4;
    grown = realloc(*mem, more * bytes);
    if (!grown)
        return false;
    *mem = grown;
    *capacity = more;
    return true;
}

static bool reserve_frame_memory(struct glint_motion_baker *b, int n_foods)
{
    void *pose = b->pose, *event = b->event, *intensity = b->intensity;
    size_t poses = b->pose_capacity, events = b->event_capacity;
    const size_t each = (size_t)n_foods * (size_t)b->n_intensities;
    bool good =
        grow_memory_array(&pose, &poses, (size_t)b->n_frames + 1,
                          sizeof *b->pose) &&
        grow_memory_array(&event, &events,
                          (size_t)b->n_events + (size_t)n_foods,
                          sizeof *b->event) &&
        grow_memory_array(&intensity, &b->byte_capacity, b->n_bytes + each, 1);

    b->pose = pose;
    b->event = event;
    b->intensity = intensity;
    b->pose_capacity = (uint32_t)poses;
    b->event_capacity = (uint32_t)events;
    return good;
}

static const char *check_frame_values(const struct glint_motion_baker *b,
                                      const struct glint_motion_sight *s)
{
    if (b->n_frames == GLINT_MOTION_MAX_FRAMES)
        return "more than 67108864 frames";
    if (s->n_foods < 3)
        return "fewer than three food items, too few to compute a pose";
    if (s->n_foods > GLINT_MOTION_MAX_FOODS)
        return "more than 32 food items";
    if (b->n_frames && s->n_foods != b->n_foods)
        return "the number of food items differs from the first frame";
    if (b->n_frames && s->n_intensities != b->n_intensities)
        return "the number of intensities per food item differs from the first "
               "frame";
    for (int i = 0; i < s->n_foods; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabs(s->food[i][k]) <= REACH))
                return "the position of a food item is not within +-1e6";
    for (int k = 0; k < 3; k++)
        if (!(fabs(s->tv[k]) <= REACH) || !(fabs(s->rv[k]) <= REACH))
            return "a number of rv or tv is not within +-1e6";
    return NULL;
}

/* Adds the motion that the body measured in this frame to its odometry. Updates
 * the report's max distance between the odometry and the fitted POSE. */
static void accumulate_body_odometry(struct glint_motion_baker *b,
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
    glint_rigid_transform_point(r, s->tv, moved);
    memcpy(r->at, moved, sizeof moved);
    for (int i = 0; i < 3; i++) {
        /* Rodrigues' formula gives column i of the rotation matrix: axis i of
         * the body after the motion, in the body's axes before the motion. */
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
    glint_rigid_set_nearest_rotation((const double(*)[3])row, r);
    for (int k = 0; k < 3; k++)
        off += (r->at[k] - pose->at[k]) * (r->at[k] - pose->at[k]);
    b->report.senses_off = sqrt(off);
    b->report.senses_most = fmax(b->report.senses_most, sqrt(off));
}

static void store_landmark_intensities(struct glint_motion_baker *b,
                                       const struct glint_motion_sight *s)
{
    for (int i = 0; i < s->n_foods; i++)
        for (int k = 0; k < b->n_intensities; k++) {
            const double x = s->intensity[i][k];
            const double held = x > 0 ? fmin(x, 1) : 0; /* NaN becomes 0 */

            b->report.held_intensities += !(held == x);
            b->intensity[b->n_bytes++] = (uint8_t)lrint(255 * held);
        }
}

static void store_located_frame(struct glint_motion_baker *b,
                                const struct glint_motion_sight *s,
                                const bool *is_new,
                                const struct glint_located *located)
{
    struct recorded_pose *p = &b->pose[b->n_frames];

    for (int k = 0; k < 3; k++)
        p->at[k] = located->pose.at[k];
    for (int k = 0; k < 4; k++)
        p->turn[k] = (float)located->pose.turn[k];
    p->residual = (float)located->residual;
    for (int i = 0; i < s->n_foods; i++) {
        if (is_new[i]) {
            b->lives[i] = b->n_events;
            b->event[b->n_events++] = (struct recorded_food){
                .frame = b->n_frames, .slot = (uint32_t)i};
            b->report.n_resets += b->n_frames > 0;
        }
        /* The latest estimate of a food's position is the most accurate one. */
        memcpy(b->event[b->lives[i]].at, b->localiser.place[i],
               sizeof b->event->at);
    }
    store_landmark_intensities(b, s);
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
    const char *wrong = check_frame_values(b, sight);

    if (!wrong && b->n_frames && sight->number >= 0 && b->number >= 0 &&
        sight->number != b->number + 1) {
        snprintf(error->text, sizeof error->text,
                 sight->number > b->number
                     ? "frames are missing: frame %lld follows frame %lld"
                     : "frames are out of order: frame %lld follows frame %lld",
                 sight->number, b->number);
        return GLINT_E_LENS;
    }
    if (wrong)
        return set_error_text(error, wrong);
    for (int i = 0; i < sight->n_foods; i++)
        is_new[i] = b->n_frames == 0 || sight->is_new[i];
    b->n_intensities = sight->n_intensities;
    if (!reserve_frame_memory(b, sight->n_foods))
        return GLINT_E_MEMORY;
    wrong = glint_localise_body(&b->localiser, sight->n_foods, sight->food,
                                is_new, &located);
    if (wrong)
        return set_error_text(error, wrong);
    b->n_foods = sight->n_foods;
    b->number = sight->number;
    if (b->n_frames)
        accumulate_body_odometry(b, sight, &located.pose);
    store_located_frame(b, sight, is_new, &located);
    return GLINT_OK;
}

/* ------------------------------------------------------------------- finish */

static double compute_point_distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static void sum_motion_report(const struct glint_motion_baker *b,
                              struct glint_motion_report *r)
{
    double low[3], high[3], squares = 0;

    compute_bounding_box(b, low, high);
    *r = b->report;
    r->n_frames = (long)b->n_frames;
    r->span = compute_point_distance(low, high);
    for (uint32_t i = 0; i < b->n_frames; i++) {
        const double residual = (double)b->pose[i].residual;

        r->path +=
            i ? compute_point_distance(b->pose[i].at, b->pose[i - 1].at) : 0;
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
        return set_error_text(
            error,
            "there is no structure (a member with size, sensors and angle of "
            "view); glint import reads lens files of other programs");
    if (!b->n_frames)
        return set_error_text(error, "the recording has no frames");
    if (b->n_intensities > 1 && b->n_intensities != b->body.n_sensors) {
        snprintf(error->text, sizeof error->text,
                 "each food item must have one intensity per sensor, but has "
                 "%d for %d sensors",
                 b->n_intensities, b->body.n_sensors);
        return GLINT_E_LENS;
    }
    sum_motion_report(b, report);
    return write_motion_file(b, report, name, key, data, bytes)
               ? GLINT_OK
               : GLINT_E_MEMORY;
}
