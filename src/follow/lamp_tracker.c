/* SPDX-License-Identifier: MIT
 *
 * Tracks lamps over time, from the spots of successive pictures.
 *
 * The tracker processes each picture in five steps. It predicts the position of
 * every track and assigns spots to tracks (match.h). It updates each track with
 * its spot or without one (record.h), and starts new tracks for unmatched
 * spots. Finally it selects the strongest tracks to be shown. */
#include "glint/lamp_tracker.h"

#include "base/arena.h"
#include "base/q.h"
#include "base/sort.h"
#include "follow/match.h"
#include "follow/record.h"

enum {
    MAX_SPOTS = 1024,
    MAX_TRACKS = 1024,
    MAX_MS = 60000,
    FEW_SPOTS = 8,
    MANY_LIGHTS = 3
};

#define MAX_ELAPSED_US 10000000
/* The search radius of a lost lamp grows from reach_q8 by reach_q8 per REACH_US
 * (us), up to MAX_REACHES times reach_q8. */
#define REACH_US    1000000
#define MAX_REACHES 3
/* Time in which the remembered white level falls to 1/e, us; this is a fall of
 * one stop per second. */
#define WHITE_US 1442695

struct glint_lamp_tracker {
    struct glint_lamp_tracker_config cfg;
    int32_t reach_q8;
    uint32_t last_id;
    int was_cut;
    struct glint_record_step step;
    struct glint_record *record; /* [max_tracks] */
    struct glint_match match;
    /* Index of the record of each element of match.seeker, [max_tracks]. */
    int32_t *owner;
    int32_t *order; /* scratch, [MAX_SPOTS]: indices of spots or records while
                       they are sorted */
};

/* ------------------------------------------------------------------- memory */

static int is_valid_duration(int32_t ms)
{
    return ms >= 1 && ms <= MAX_MS;
}

static int is_valid_config(const struct glint_lamp_tracker_config *c)
{
    return c->width >= 1 && c->width <= GLINT_MAX_SIDE && c->height >= 1 &&
           c->height <= GLINT_MAX_SIDE && c->max_tracks >= 1 &&
           c->max_tracks <= MAX_TRACKS && c->max_shown >= 1 &&
           c->max_shown <= c->max_tracks && c->match_q15 >= 0 &&
           c->match_q15 <= 1 << 15 && c->cut_q15 >= 1 &&
           is_valid_duration(c->attack_ms) &&
           is_valid_duration(c->release_ms) && is_valid_duration(c->leave_ms) &&
           is_valid_duration(c->memory_ms) && is_valid_duration(c->smooth_ms);
}

/* Allocates a tracker from arena A. Returns NULL if A only counts bytes or is
 * full. */
static struct glint_lamp_tracker *
allocate_tracker(struct glint_arena *a,
                 const struct glint_lamp_tracker_config *c)
{
    const size_t n_records = (size_t)c->max_tracks;
    struct glint_lamp_tracker *placed =
        glint_arena_allocate(a, 1, sizeof *placed);
    struct glint_lamp_tracker measured;
    struct glint_lamp_tracker *t = placed ? placed : &measured;

    t->record = glint_arena_allocate(a, n_records, sizeof *t->record);
    t->owner = glint_arena_allocate(a, n_records, sizeof *t->owner);
    t->order = glint_arena_allocate(a, MAX_SPOTS, sizeof *t->order);
    glint_match_allocate(&t->match, a, c->max_tracks, MAX_SPOTS);
    return a->used <= a->size ? placed : NULL;
}

void glint_lamp_tracker_defaults(struct glint_lamp_tracker_config *cfg,
                                 int width, int height)
{
    *cfg = (struct glint_lamp_tracker_config){.width = width,
                                              .height = height,
                                              .max_tracks = 128,
                                              .max_shown = 16,
                                              .match_q15 = Q_CONST(0.06, 15),
                                              .cut_q15 = Q_CONST(0.75, 15),
                                              .attack_ms = 200,
                                              .release_ms = 220,
                                              .leave_ms = 400,
                                              .memory_ms = 2000,
                                              .smooth_ms = 300};
}

size_t glint_lamp_tracker_bytes(const struct glint_lamp_tracker_config *cfg)
{
    struct glint_arena measured = glint_arena_begin_measuring();

    if (!is_valid_config(cfg))
        return 0;
    allocate_tracker(&measured, cfg);
    return measured.used;
}

enum glint_status
glint_lamp_tracker_init(struct glint_lamp_tracker **tracks,
                        const struct glint_lamp_tracker_config *cfg, void *mem,
                        size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_lamp_tracker *t;

    if (!is_valid_config(cfg) || (uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    t = allocate_tracker(&arena, cfg);
    if (!t)
        return GLINT_E_MEMORY;
    t->cfg = *cfg;
    t->step.cfg = &t->cfg;
    t->reach_q8 =
        q_narrow(q_shift((int64_t)cfg->width * cfg->match_q15, 15 - 8));
    t->last_id = 0;
    t->was_cut = 0;
    glint_lamp_tracker_restart(t);
    *tracks = t;
    return GLINT_OK;
}

void glint_lamp_tracker_restart(struct glint_lamp_tracker *tracks)
{
    for (int i = 0; i < tracks->cfg.max_tracks; i++)
        tracks->record[i].id = 0;
    tracks->step.is_fresh = 1;
}

int glint_lamp_tracker_was_cut(const struct glint_lamp_tracker *tracks)
{
    return tracks->was_cut;
}

static int has_any_track(const struct glint_lamp_tracker *tracks)
{
    for (int i = 0; i < tracks->cfg.max_tracks; i++)
        if (tracks->record[i].id)
            return 1;
    return 0;
}

int32_t glint_lamp_tracker_white_q15(const struct glint_lamp_tracker *tracks,
                                     int32_t elapsed_us)
{
    const int32_t us = q_clamp_sat(elapsed_us, 0, MAX_ELAPSED_US);

    return has_any_track(tracks)
               ? (1 << 15) - glint_pace_compute_fraction_q15(us, WHITE_US)
               : 0;
}

/* ----------------------------------------------------------------- matching */

static int32_t compute_search_radius_q8(const struct glint_lamp_tracker *t,
                                        const struct glint_record *r)
{
    const int64_t more_q8 = (int64_t)t->reach_q8 * r->lost_us / REACH_US;
    const int32_t most_q8 = t->reach_q8 * (MAX_REACHES - 1);

    return t->reach_q8 + (more_q8 < most_q8 ? (int32_t)more_q8 : most_q8);
}

/* Sets the lamps (seekers) for which spots are searched: one per track, at the
 * track's predicted position. */
static void set_matcher_input_from_tracks(struct glint_lamp_tracker *t)
{
    struct glint_match *m = &t->match;

    m->n_seekers = 0;
    for (int i = 0; i < t->cfg.max_tracks; i++) {
        struct glint_record *r = &t->record[i];

        if (!r->id)
            continue;
        glint_record_predict_position(r, &t->step);
        t->owner[m->n_seekers] = i;
        m->seeker[m->n_seekers++] = (struct glint_seeker){
            .id = r->id,
            .x_q8 = q_narrow(r->ahead_q16[0] / 256),
            .y_q8 = q_narrow(r->ahead_q16[1] / 256),
            .reach_q8 = compute_search_radius_q8(t, r),
            .max_faint_area = q_clamp_sat(r->last.area, 0, 1 << 26) * 4,
            .is_lost = r->lost_us > 0};
    }
}

/* Returns the max squared distance, pixels^2, of a spot from the predicted
 * position of its lamp at which both count as the same lamp. It shrinks with N,
 * the number of spots in the picture, because among many spots one is near by
 * chance. */
static int64_t
compute_same_lamp_distance2_q16(const struct glint_lamp_tracker *t, int n)
{
    const int64_t reach2_q16 = (int64_t)t->reach_q8 * t->reach_q8;

    return n > FEW_SPOTS ? reach2_q16 * FEW_SPOTS / n : reach2_q16;
}

/* Returns the smaller flux of spot NOW and spot BEFORE, the last spot of the
 * same lamp. Returns 0 if the distance of NOW from the predicted position in S
 * exceeds sqrt(LIMIT2). */
static int64_t compute_common_flux(const struct glint_seeker *s,
                                   const struct glint_spot *before,
                                   const struct glint_spot *now,
                                   int64_t limit2_q16)
{
    const int64_t dx_q8 = (int64_t)now->x_q8 - s->x_q8;
    const int64_t dy_q8 = (int64_t)now->y_q8 - s->y_q8;
    const int64_t p_q16 = glint_record_clamp_flux_q16(before);
    const int64_t q_q16 = glint_record_clamp_flux_q16(now);

    if (dx_q8 * dx_q8 + dy_q8 * dy_q8 > limit2_q16)
        return 0;
    return p_q16 < q_q16 ? p_q16 : q_q16;
}

/* Sums over all lamps of the picture before or after a possible cut: their
 * flux, the flux that also occurs in the other picture (kept), and their number
 * n. */
struct side {
    int64_t flux, kept;
    int n;
};

/* Returns whether B lacks at least the fraction cut_q15 of the flux of A or, if
 * A has no flux, whether B has at least MANY_LIGHTS lamps, because so many
 * appear or vanish at once only at a cut. */
static int is_flux_mostly_unmatched(const struct glint_lamp_tracker *t,
                                    const struct side *a, const struct side *b)
{
    return a->flux > 0 ? a->flux - a->kept >= (a->flux * t->cfg.cut_q15) >> 15
                       : b->n >= MANY_LIGHTS;
}

/* Returns whether the picture is the first after a cut: most flux of the
 * previous picture has vanished, and most flux of this one is new. If one of
 * them has no flux, MANY_LIGHTS lamps in the other suffice. */
static int is_scene_cut(const struct glint_lamp_tracker *t,
                        const struct glint_spot *spots, int n)
{
    const int64_t limit2_q16 = compute_same_lamp_distance2_q16(t, n);
    struct side before = {0, 0, 0}, now = {0, 0, 0};

    for (int i = 0; i < n; i++)
        if (!spots[i].faint || t->match.taken[i]) {
            now.flux += glint_record_clamp_flux_q16(&spots[i]);
            now.n++;
        }
    for (int i = 0; i < t->match.n_seekers; i++) {
        const struct glint_seeker *s = &t->match.seeker[i];
        const struct glint_spot *last = &t->record[t->owner[i]].last;
        const int64_t kept =
            s->spot < 0
                ? 0
                : compute_common_flux(s, last, &spots[s->spot], limit2_q16);

        now.kept += kept;
        if (s->is_lost)
            continue;
        before.flux += glint_record_clamp_flux_q16(last);
        before.kept += kept;
        before.n++;
    }
    return is_flux_mostly_unmatched(t, &before, &now) &&
           is_flux_mostly_unmatched(t, &now, &before);
}

/* Assigns spots to tracks. At a cut, drops all tracks first. */
static void match_spots_to_tracks(struct glint_lamp_tracker *t,
                                  const struct glint_spot *spots, int n)
{
    set_matcher_input_from_tracks(t);
    glint_match_assign_spots(&t->match, spots, n);
    if (is_scene_cut(t, spots, n)) {
        glint_lamp_tracker_restart(t);
        set_matcher_input_from_tracks(t);
        glint_match_assign_spots(&t->match, spots, n);
    }
    t->was_cut = t->step.is_fresh;
}

/* -------------------------------------------------------------- new tracks */

/* Returns whether record P is replaced rather than record Q when a new lamp
 * needs a record. Records of lost lamps are replaced first, then records of
 * fainter lamps, then records of younger lamps. */
static int is_record_replaced_before(const struct glint_record *p,
                                     const struct glint_record *q)
{
    const int64_t p_q16 = p->of[GLINT_CHANNEL_POWER].value;
    const int64_t q_q16 = q->of[GLINT_CHANNEL_POWER].value;

    if ((p->lost_us > 0) != (q->lost_us > 0))
        return p->lost_us > 0;
    return p_q16 != q_q16 ? p_q16 < q_q16 : p->id > q->id;
}

/* Returns a record for a new lamp of POWER. It is a free record, or else the
 * record of a track that is not shown and whose lamp is lost or fainter.
 * Returns NULL if there is no such record. */
static struct glint_record *
find_record_for_new_lamp(struct glint_lamp_tracker *t, int64_t power_q16)
{
    struct glint_record *best = NULL;

    for (int i = 0; i < t->cfg.max_tracks; i++) {
        struct glint_record *r = &t->record[i];

        if (!r->id)
            return r;
        if (r->level_q30 > 0 || r->is_shown ||
            (r->lost_us == 0 && r->of[GLINT_CHANNEL_POWER].value >= power_q16))
            continue;
        if (!best || is_record_replaced_before(r, best))
            best = r;
    }
    return best;
}

struct ranked_spots {
    const struct glint_spot *spots;
    const int32_t *by_x;
};

static int is_spot_brighter(const void *ctx, int32_t a, int32_t b)
{
    const struct ranked_spots *r = ctx;
    const int64_t p_q16 = glint_record_clamp_power_q16(&r->spots[r->by_x[a]]);
    const int64_t q_q16 = glint_record_clamp_power_q16(&r->spots[r->by_x[b]]);

    return p_q16 != q_q16 ? p_q16 > q_q16 : a < b;
}

/* Starts a track for each unmatched spot, the brightest first, until no record
 * is left. */
static void begin_tracks_of_unmatched_spots(struct glint_lamp_tracker *t,
                                            const struct glint_spot *spots,
                                            int n)
{
    const struct ranked_spots ranked = {spots, t->match.by_x};
    int n_new = 0;

    for (int i = 0; i < n; i++) {
        const int32_t spot = t->match.by_x[i];

        if (!t->match.taken[spot] && !spots[spot].faint)
            t->order[n_new++] = i;
    }
    glint_sort(t->order, n_new, is_spot_brighter, &ranked);
    for (int i = 0; i < n_new; i++) {
        const struct glint_spot *s = &spots[t->match.by_x[t->order[i]]];
        struct glint_record *r =
            find_record_for_new_lamp(t, glint_record_clamp_power_q16(s));

        if (!r)
            return;
        glint_record_begin_track(r, ++t->last_id, s);
    }
}

/* ------------------------------------------------------------- shown tracks */

/* Returns the power by which track R is ranked. The power of a track that is
 * already shown counts a quarter more, so that two tracks of similar power do
 * not alternate. */
static int64_t compute_rank_power(const struct glint_record *r)
{
    const int64_t power_q16 = r->of[GLINT_CHANNEL_POWER].value;

    return power_q16 + (r->is_shown ? power_q16 / 4 : 0);
}

static int is_track_stronger(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_record *record = ctx;
    const int64_t p = compute_rank_power(&record[a]),
                  q = compute_rank_power(&record[b]);

    return p != q ? p > q : record[a].id < record[b].id;
}

/* Writes the indices of all tracks to t->order, the strongest first, and marks
 * the max_shown strongest visible ones as shown. Returns the number of tracks.
 */
static int rank_and_select_tracks(struct glint_lamp_tracker *t)
{
    int n = 0, n_shown = 0;

    for (int i = 0; i < t->cfg.max_tracks; i++)
        if (t->record[i].id)
            t->order[n++] = i;
    glint_sort(t->order, n, is_track_stronger, t->record);
    for (int i = 0; i < n; i++) {
        struct glint_record *r = &t->record[t->order[i]];

        r->is_shown = r->lost_us == 0 && n_shown < t->cfg.max_shown;
        n_shown += r->is_shown;
    }
    return n;
}

static int write_shown_tracks(struct glint_lamp_tracker *t,
                              struct glint_lamp_track *out, int max)
{
    const int n = rank_and_select_tracks(t);
    int n_out = 0;

    for (int i = 0; i < n; i++) {
        struct glint_record *r = &t->record[t->order[i]];

        glint_record_update_fade_level(r, &t->step);
        if (r->level_q30 >= 1 << 15 && n_out < max)
            out[n_out++] = glint_record_make_track(r);
    }
    return n_out;
}

int glint_lamp_tracker_step(struct glint_lamp_tracker *tracks,
                            const struct glint_spot *spots, int n,
                            int32_t elapsed_us, struct glint_lamp_track *out,
                            int max)
{
    struct glint_lamp_tracker *t = tracks;

    t->step.pace = glint_pace_compute_for_interval(
        q_clamp_sat(elapsed_us, 0, MAX_ELAPSED_US), t->cfg.smooth_ms * 1000);
    match_spots_to_tracks(t, spots, n);
    for (int i = 0; i < t->match.n_seekers; i++) {
        struct glint_record *r = &t->record[t->owner[i]];
        const int32_t spot = t->match.seeker[i].spot;

        if (spot >= 0)
            glint_record_update_with_spot(r, &t->step, &spots[spot]);
        else
            glint_record_update_without_spot(r, &t->step);
    }
    begin_tracks_of_unmatched_spots(t, spots, n);
    n = write_shown_tracks(t, out, max);
    t->step.is_fresh = 0;
    return n;
}
