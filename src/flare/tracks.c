/* SPDX-License-Identifier: MIT
 *
 * Lights over time: spots of one picture after the other become tracks.
 *
 * A step: tracks move to where they should be by now and take the spots they
 * find there (match.h); each follows its spot, number by number (follow.h);
 * those without fade; what spots are left over become tracks; the strongest are
 * shown.
 */
#include "glint/tracks.h"

#include "base/arena.h"
#include "base/q.h"
#include "base/sort.h"
#include "flare/follow.h"
#include "flare/match.h"

enum { MAX_SPOTS = 1024, MAX_TRACKS = 1024, MAX_MS = 60000 };

#define MAX_ELAPSED_US 10000000 /* by then all has risen or faded */
#define VELOCITY_US    100000   /* it is averaged over */
#define COAST_US       300000 /* in which a hidden light loses 1 - 1/e of it */
#define MAX_FLUX_Q16   (INT64_C(1) << 42) /* the largest picture, all white */
#define FULL_Q30       (INT32_C(1) << 30)

/* The strongest are those that are shown where the rest is not stronger by a
 * quarter, so that two of the same flux do not take turns. A flux that changes
 * by a quarter from picture to picture is another shape: lights merged, parted,
 * or something came before them. */
#define QUARTER 4

/* What is followed of a light: places _q16, the rest as in a spot. */
enum channel { X, Y, FLUX, CLIPPED, SIZE, RED, GREEN, BLUE, N_CHANNELS };

struct record {
    uint32_t id; /* 0: a place for a new one */
    enum glint_track_state state;
    struct glint_follow of[N_CHANNELS];
    struct glint_spot last;  /* it was seen as */
    int64_t velocity_q16[2]; /* pixels a second */
    int64_t ahead_q16[2];    /* where it should be now */
    int32_t level_q30;
    int32_t lost_us; /* since it was seen; 0: seen now */
    int is_shown;    /* one of the strongest */
};

struct glint_tracks {
    struct glint_tracks_config cfg;
    int32_t reach_q8;
    uint32_t last_id;
    int is_fresh; /* what is new in the next step has been there before */
    int was_cut;
    struct glint_pace pace; /* of this step */
    struct record *record;  /* [max_tracks] */
    struct glint_match match;
    int32_t *owner; /* of match.seeker: index of record */
    int32_t *order; /* of spots or records */
};

/* ------------------------------------------------------------------- memory */

static int is_time(int32_t ms)
{
    return ms >= 1 && ms <= MAX_MS;
}

static int is_valid(const struct glint_tracks_config *c)
{
    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->max_tracks >= 1 &&
           c->max_tracks <= MAX_TRACKS && c->max_shown >= 1 &&
           c->max_shown <= c->max_tracks && c->match_q15 >= 0 &&
           c->match_q15 <= 1 << 15 && c->cut_q15 >= 1 &&
           is_time(c->attack_ms) && is_time(c->release_ms) &&
           is_time(c->leave_ms) && is_time(c->memory_ms) &&
           is_time(c->smooth_ms);
}

/* Runs twice: to measure, and to place. NULL if measuring or full. */
static struct glint_tracks *carve(struct glint_arena *a,
                                  const struct glint_tracks_config *c)
{
    const size_t n_records = (size_t)c->max_tracks;
    struct glint_tracks *placed = glint_arena_take(a, 1, sizeof *placed);
    struct glint_tracks measured;
    struct glint_tracks *t = placed ? placed : &measured;

    t->record = glint_arena_take(a, n_records, sizeof *t->record);
    t->owner = glint_arena_take(a, n_records, sizeof *t->owner);
    t->order = glint_arena_take(a, MAX_SPOTS, sizeof *t->order);
    glint_match_carve(&t->match, a, c->max_tracks, MAX_SPOTS);
    return a->used <= a->size ? placed : NULL;
}

void glint_tracks_defaults(struct glint_tracks_config *cfg, int width,
                           int height)
{
    *cfg = (struct glint_tracks_config){.width = width,
                                        .height = height,
                                        .max_tracks = 128,
                                        .max_shown = 16,
                                        .match_q15 = Q_CONST(0.05, 15),
                                        .cut_q15 = Q_CONST(0.75, 15),
                                        .attack_ms = 200,
                                        .release_ms = 200,
                                        .leave_ms = 400,
                                        .memory_ms = 1000,
                                        .smooth_ms = 250};
}

size_t glint_tracks_bytes(const struct glint_tracks_config *cfg)
{
    struct glint_arena measured = glint_arena_measure();

    if (!is_valid(cfg))
        return 0;
    carve(&measured, cfg);
    return measured.used;
}

enum glint_status glint_tracks_init(struct glint_tracks **tracks,
                                    const struct glint_tracks_config *cfg,
                                    void *mem, size_t bytes)
{
    struct glint_arena arena = glint_arena_over(mem, bytes);
    struct glint_tracks *t;

    if (!is_valid(cfg) || (uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    t = carve(&arena, cfg);
    if (!t)
        return GLINT_E_MEMORY;
    t->cfg = *cfg;
    t->reach_q8 =
        q_narrow(q_shift((int64_t)cfg->width * cfg->match_q15, 15 - 8));
    t->last_id = 0;
    t->was_cut = 0;
    glint_tracks_restart(t);
    *tracks = t;
    return GLINT_OK;
}

void glint_tracks_restart(struct glint_tracks *tracks)
{
    for (int i = 0; i < tracks->cfg.max_tracks; i++)
        tracks->record[i].id = 0;
    tracks->is_fresh = 1;
}

int glint_tracks_was_cut(const struct glint_tracks *tracks)
{
    return tracks->was_cut;
}

/* -------------------------------------------------------------- what is seen
 */

static int64_t clamp(int64_t x, int64_t low, int64_t high)
{
    return x < low ? low : x > high ? high : x;
}

static int64_t flux_of(const struct glint_spot *s)
{
    return clamp(s->flux_q16, 0, MAX_FLUX_Q16);
}

/* What a spot says of each channel, held to what a picture can show. */
static void list_targets(const struct glint_spot *s, int64_t target[N_CHANNELS])
{
    target[X] = clamp(s->x_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[Y] = clamp(s->y_q8, 0, GLINT_MAX_SIDE << 8) * 256;
    target[FLUX] = flux_of(s);
    target[CLIPPED] = clamp(s->n_clipped, 0, 1 << 26) * 65536;
    target[SIZE] = clamp(s->size_q8, 0, GLINT_MAX_SIDE << 8);
    for (int i = 0; i < 3; i++)
        target[RED + i] = clamp(s->rgb_q15[i], 0, 1 << 20);
}

/* An error of VALUE that does no harm: 1/16 pixel, 1/64 of light; half a
 * clipped pixel. */
static int64_t floor_of(enum channel channel, int64_t value)
{
    switch (channel) {
    case X:
    case Y:
        return 65536 / 16;
    case FLUX:
        return value / 64 + 1;
    case CLIPPED:
        return value / 64 + 65536 / 2;
    case SIZE:
        return value / 64 + 256 / 16;
    default:
        return 32768 / 64;
    }
}

static int repeats(const struct glint_spot *a, const struct glint_spot *b)
{
    return a->x_q8 == b->x_q8 && a->y_q8 == b->y_q8 &&
           a->size_q8 == b->size_q8 && a->area == b->area &&
           a->n_clipped == b->n_clipped && a->flux_q16 == b->flux_q16 &&
           a->rgb_q15[0] == b->rgb_q15[0] && a->rgb_q15[1] == b->rgb_q15[1] &&
           a->rgb_q15[2] == b->rgb_q15[2];
}

static int is_other_shape(const struct glint_spot *a,
                          const struct glint_spot *b)
{
    const int64_t p = flux_of(a), q = flux_of(b);
    const int64_t larger = p > q ? p : q;

    return larger - (p > q ? q : p) > larger / QUARTER;
}

/* ------------------------------------------------------------------- motion */

/* Where each track should be, without the spots of this picture. */
static void look_ahead(struct glint_tracks *t)
{
    struct glint_match *m = &t->match;

    m->n_seekers = 0;
    for (int i = 0; i < t->cfg.max_tracks; i++) {
        struct record *r = &t->record[i];

        if (!r->id)
            continue;
        for (int axis = 0; axis < 2; axis++)
            r->ahead_q16[axis] =
                r->of[X + axis].value +
                r->velocity_q16[axis] * t->pace.elapsed_us / 1000000;
        t->owner[m->n_seekers] = i;
        m->seeker[m->n_seekers++] = (struct glint_seeker){
            .id = r->id,
            .x_q8 = q_narrow(r->ahead_q16[0] / 256),
            .y_q8 = q_narrow(r->ahead_q16[1] / 256),
            .max_faint_area =
                r->last.area < 1 << 24 ? r->last.area * 4 : 1 << 26,
            .is_lost = r->lost_us > 0};
    }
}

/* The velocity is that of VALUE, which was BEFORE. A light that crosses the
 * picture in less than a sixteenth of a second is not tracked. */
static void learn_velocity(const struct glint_tracks *t, struct record *r,
                           int axis, int64_t before_q16)
{
    const int64_t limit_q16 = (int64_t)t->cfg.width << (16 + 4);
    const int32_t part_q15 =
        glint_pace_part_q15(t->pace.elapsed_us, VELOCITY_US);
    int64_t now_q16;

    if (t->pace.elapsed_us == 0)
        return;
    now_q16 = clamp((r->of[X + axis].value - before_q16) * 1000000 /
                        t->pace.elapsed_us,
                    -limit_q16, limit_q16);
    r->velocity_q16[axis] +=
        (now_q16 - r->velocity_q16[axis]) * part_q15 / (1 << 15);
}

/* A place that belongs to another shape is not motion: what is shown goes on as
 * it went and comes round in time. */
static void follow_place(struct glint_tracks *t, struct record *r,
                         const int64_t target[2], int is_new_shape,
                         int is_repeat)
{
    for (int axis = 0; axis < 2; axis++) {
        struct glint_follow *f = &r->of[X + axis];
        const int64_t before_q16 = f->value;

        if (is_new_shape) {
            glint_follow_jump(f, target[axis], r->ahead_q16[axis] + f->offset,
                              t->cfg.attack_ms * 1000);
        } else {
            glint_follow_step(f, target[axis], floor_of(X, 0), &t->pace,
                              is_repeat);
            learn_velocity(t, r, axis, before_q16);
        }
    }
}

/* A light without a spot moves on; a hidden one comes to rest. */
static void coast(struct glint_tracks *t, struct record *r)
{
    const int32_t part_q15 =
        r->state == GLINT_TRACK_LEAVING
            ? 0
            : glint_pace_part_q15(t->pace.elapsed_us, COAST_US);

    for (int axis = 0; axis < 2; axis++) {
        r->of[X + axis].value = r->ahead_q16[axis];
        r->velocity_q16[axis] -= r->velocity_q16[axis] * part_q15 / (1 << 15);
    }
}

/* Whether the light moves out of the picture through a border next to it. */
static int is_leaving(const struct glint_tracks *t, const struct record *r)
{
    const int side[2] = {t->cfg.width, t->cfg.height};

    for (int axis = 0; axis < 2; axis++) {
        const int64_t velocity_q16 = r->velocity_q16[axis];
        const int64_t step_q16 = velocity_q16 * t->pace.elapsed_us / 1000000;
        const int64_t margin_q16 = r->of[SIZE].value * 2 * 256 + 2 * 65536 +
                                   2 * (step_q16 < 0 ? -step_q16 : step_q16);
        const int64_t room_q16 =
            velocity_q16 < 0
                ? r->of[X + axis].value
                : side[axis] * INT64_C(65536) - r->of[X + axis].value;
        const int64_t way_q16 =
            (velocity_q16 < 0 ? -velocity_q16 : velocity_q16) *
            t->cfg.leave_ms / 1000;

        if (room_q16 < margin_q16 && way_q16 > room_q16)
            return 1;
    }
    return 0;
}

/* ------------------------------------------------------------------- tracks */

/* Follows TARGET; a step that is faster than the whole of it in the attack or
 * release time is stretched to that. */
static void follow_light(const struct glint_tracks *t, struct glint_follow *f,
                         enum channel channel, int64_t target, int is_repeat)
{
    const int64_t before = f->value, shown = before + f->offset;
    const int64_t larger = target > before ? target : before;
    int64_t change, time_us;

    glint_follow_step(f, target, floor_of(channel, larger), &t->pace,
                      is_repeat);
    change = f->value - before;
    time_us =
        (int64_t)1000 * (change > 0 ? t->cfg.attack_ms : t->cfg.release_ms);
    if ((change < 0 ? -change : change) > larger * t->pace.elapsed_us / time_us)
        glint_follow_jump(f, f->value, shown, (int32_t)time_us);
}

static void start_channels(struct record *r, const struct glint_spot *s)
{
    int64_t target[N_CHANNELS];

    list_targets(s, target);
    for (int c = 0; c < N_CHANNELS; c++)
        glint_follow_start(&r->of[c], target[c],
                           4 * floor_of((enum channel)c, target[c]));
}

/* Track R is seen as S. */
static void see(struct glint_tracks *t, struct record *r,
                const struct glint_spot *s)
{
    const int is_back = r->lost_us > 0;
    const int is_repeat = !is_back && repeats(s, &r->last);
    int64_t target[N_CHANNELS];

    if (is_back && r->level_q30 == 0) {
        start_channels(r, s);
    } else {
        list_targets(s, target);
        follow_place(t, r, target, is_back || is_other_shape(s, &r->last),
                     is_repeat);
        for (int c = FLUX; c < N_CHANNELS; c++)
            follow_light(t, &r->of[c], (enum channel)c, target[c], is_repeat);
    }
    r->last = *s;
    r->lost_us = 0;
}

/* Track R has no spot: it fades and is forgotten in time. */
static void miss(struct glint_tracks *t, struct record *r)
{
    if (r->lost_us == 0)
        r->state = is_leaving(t, r) ? GLINT_TRACK_LEAVING : GLINT_TRACK_FADING;
    coast(t, r);
    r->lost_us += t->pace.elapsed_us > 0 ? t->pace.elapsed_us : 1;
    if (r->level_q30 == 0 && (r->state == GLINT_TRACK_LEAVING ||
                              r->lost_us / 1000 >= t->cfg.memory_ms))
        r->id = 0;
}

/* The part of full level that passes in the time of this step. */
static int32_t level_step_q30(const struct glint_tracks *t, int32_t ms)
{
    const int64_t step_q30 =
        ((int64_t)t->pace.elapsed_us << 30) / ((int64_t)ms * 1000);

    return step_q30 > FULL_Q30 ? FULL_Q30 : (int32_t)step_q30;
}

static void set_level(struct glint_tracks *t, struct record *r)
{
    const struct glint_tracks_config *c = &t->cfg;

    if (r->lost_us == 0 && r->is_shown) {
        const int32_t step_q30 = level_step_q30(t, c->attack_ms);

        r->level_q30 = r->level_q30 > FULL_Q30 - step_q30
                           ? FULL_Q30
                           : r->level_q30 + step_q30;
        if (t->is_fresh)
            r->level_q30 = FULL_Q30;
        r->state =
            r->level_q30 == FULL_Q30 ? GLINT_TRACK_STEADY : GLINT_TRACK_RISING;
    } else {
        const int32_t step_q30 = level_step_q30(
            t, r->state == GLINT_TRACK_LEAVING ? c->leave_ms : c->release_ms);

        r->level_q30 = r->level_q30 > step_q30 ? r->level_q30 - step_q30 : 0;
        if (r->state != GLINT_TRACK_LEAVING)
            r->state = GLINT_TRACK_FADING;
    }
}

/* ------------------------------------------------------------ new ones, cuts
 */

/* The place that a new light of FLUX may have: a free one, else that of the
 * faintest that is not seen, unless it is as bright. NULL: none. */
static struct record *place_for(struct glint_tracks *t, int64_t flux_q16)
{
    struct record *best = NULL;

    for (int i = 0; i < t->cfg.max_tracks; i++) {
        struct record *r = &t->record[i];

        if (!r->id)
            return r;
        if (r->level_q30 > 0 || r->is_shown ||
            (r->lost_us == 0 && r->of[FLUX].value >= flux_q16))
            continue;
        if (!best || (r->lost_us > 0) > (best->lost_us > 0) ||
            ((r->lost_us > 0) == (best->lost_us > 0) &&
             (r->of[FLUX].value < best->of[FLUX].value ||
              (r->of[FLUX].value == best->of[FLUX].value && r->id > best->id))))
            best = r;
    }
    return best;
}

struct births {
    const struct glint_spot *spots;
    const int32_t *rank; /* in by_x */
};

static int is_brighter_spot(const void *ctx, int32_t a, int32_t b)
{
    const struct births *births = ctx;
    const int64_t p = flux_of(&births->spots[births->rank[a]]);
    const int64_t q = flux_of(&births->spots[births->rank[b]]);

    return p != q ? p > q : a < b;
}

/* Spots that no track took become tracks, the brightest first. */
static void begin_tracks(struct glint_tracks *t, const struct glint_spot *spots,
                         int n)
{
    const struct births births = {spots, t->match.by_x};
    int n_new = 0;

    for (int i = 0; i < n; i++) {
        const int32_t spot = t->match.by_x[i];

        if (!t->match.taken[spot] && !spots[spot].faint)
            t->order[n_new++] = i;
    }
    glint_sort(t->order, n_new, is_brighter_spot, &births);
    for (int i = 0; i < n_new; i++) {
        const struct glint_spot *s = &spots[t->match.by_x[t->order[i]]];
        struct record *r = place_for(t, flux_of(s));

        if (!r)
            return;
        *r = (struct record){.id = ++t->last_id, .last = *s};
        start_channels(r, s);
    }
}

/* Whether most of what was seen is gone and most of what is seen is new. A
 * match from afar is no proof of the contrary. */
static int is_cut(const struct glint_tracks *t, const struct glint_spot *spots,
                  int n)
{
    const int64_t near2_q16 = (int64_t)t->reach_q8 * t->reach_q8 / 4;
    int64_t before = 0, gone = 0, now = 0, kept = 0;

    for (int i = 0; i < n; i++)
        if (!spots[i].faint || t->match.taken[i])
            now += flux_of(&spots[i]);
    for (int i = 0; i < t->match.n_seekers; i++) {
        const struct glint_seeker *s = &t->match.seeker[i];
        const struct record *r = &t->record[t->owner[i]];
        int64_t dx_q8, dy_q8;

        if (s->is_lost)
            continue;
        before += flux_of(&r->last);
        if (s->spot < 0) {
            gone += flux_of(&r->last);
            continue;
        }
        dx_q8 = spots[s->spot].x_q8 - s->x_q8;
        dy_q8 = spots[s->spot].y_q8 - s->y_q8;
        if (dx_q8 * dx_q8 + dy_q8 * dy_q8 <= near2_q16)
            kept += flux_of(&spots[s->spot]);
        else
            gone += flux_of(&r->last);
    }
    return before > 0 && now > 0 && gone >= (before * t->cfg.cut_q15) >> 15 &&
           now - kept >= (now * t->cfg.cut_q15) >> 15;
}

/* ------------------------------------------------------------------ the step
 */

/* By falling flux, those shown with a quarter more. */
static int is_before(const void *ctx, int32_t a, int32_t b)
{
    const struct record *p = (const struct record *)ctx + a;
    const struct record *q = (const struct record *)ctx + b;
    const int64_t p_flux = p->of[FLUX].value, q_flux = q->of[FLUX].value;
    const int64_t p_score = p_flux + (p->is_shown ? p_flux / QUARTER : 0);
    const int64_t q_score = q_flux + (q->is_shown ? q_flux / QUARTER : 0);

    return p_score != q_score ? p_score > q_score : p->id < q->id;
}

/* Lists all tracks in t->order, and picks those that are shown. */
static int rank_tracks(struct glint_tracks *t)
{
    int n = 0, n_shown = 0;

    for (int i = 0; i < t->cfg.max_tracks; i++)
        if (t->record[i].id)
            t->order[n++] = i;
    glint_sort(t->order, n, is_before, t->record);
    for (int i = 0; i < n; i++) {
        struct record *r = &t->record[t->order[i]];

        r->is_shown = r->lost_us == 0 && n_shown < t->cfg.max_shown;
        n_shown += r->is_shown;
    }
    return n;
}

static struct glint_track track_of(const struct record *r)
{
    struct glint_track track = {
        .id = r->id,
        .state = r->state,
        .x_q8 = q_narrow(q_shift(glint_follow_shown(&r->of[X]), 8)),
        .y_q8 = q_narrow(q_shift(glint_follow_shown(&r->of[Y]), 8)),
        .size_q8 = q_narrow(glint_follow_shown(&r->of[SIZE])),
        .level_q15 = q_narrow(q_shift(r->level_q30, 30 - 15)),
        .flux_q16 = glint_follow_shown(&r->of[FLUX]),
        .clipped_q16 = glint_follow_shown(&r->of[CLIPPED])};

    for (int i = 0; i < 3; i++)
        track.rgb_q15[i] = q_narrow(glint_follow_shown(&r->of[RED + i]));
    return track;
}

/* Gives each track its spot, or after a cut none. */
static void match(struct glint_tracks *t, const struct glint_spot *spots, int n)
{
    t->was_cut = t->is_fresh;
    look_ahead(t);
    glint_match_find(&t->match, spots, n, t->reach_q8);
    if (!is_cut(t, spots, n))
        return;
    glint_tracks_restart(t);
    t->was_cut = 1;
    look_ahead(t);
    glint_match_find(&t->match, spots, n, t->reach_q8);
}

int glint_tracks_step(struct glint_tracks *tracks,
                      const struct glint_spot *spots, int n, int32_t elapsed_us,
                      struct glint_track *out, int max)
{
    struct glint_tracks *t = tracks;
    int n_tracks, n_out = 0;

    t->pace = glint_pace_of((int32_t)clamp(elapsed_us, 0, MAX_ELAPSED_US),
                            t->cfg.smooth_ms * 1000);
    match(t, spots, n);
    for (int i = 0; i < t->match.n_seekers; i++) {
        struct record *r = &t->record[t->owner[i]];

        for (int c = 0; c < N_CHANNELS; c++)
            glint_follow_blend(&r->of[c], t->pace.elapsed_us);
        if (t->match.seeker[i].spot >= 0)
            see(t, r, &spots[t->match.seeker[i].spot]);
        else
            miss(t, r);
    }
    begin_tracks(t, spots, n);
    n_tracks = rank_tracks(t);
    for (int i = 0; i < n_tracks; i++) {
        struct record *r = &t->record[t->order[i]];

        set_level(t, r);
        if (r->level_q30 >> 15 > 0 && n_out < max)
            out[n_out++] = track_of(r);
    }
    t->is_fresh = 0;
    return n_out;
}
