/* SPDX-License-Identifier: MIT */
#include "reference/lens/shared_basis.h"

#include <math.h>
#include <string.h>

enum { MAX_CANDIDATES = 160, MAX_STEPS = 60 };

struct search {
    struct glint_shared_zone *zone;
    const struct glint_shared_rays *rays;
    int n_zones;
    enum glint_channel kind;
    int n_candidates;
    uint8_t candidate[MAX_CANDIDATES][GLINT_VARIABLES];
    double remove[GLINT_SHARED_TERMS]; /* error that dropping each term would
                                          add */
};

/* --------------------------------------------------------------- candidates */

static bool odd(enum glint_channel kind)
{
    return kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
}

static bool has(const struct glint_shared_basis *basis, const uint8_t *power)
{
    for (int k = 0; k < basis->n; k++)
        if (memcmp(basis->power[k], power, GLINT_VARIABLES) == 0)
            return true;
    return false;
}

static void add_candidate(struct search *s,
                          const struct glint_shared_basis *basis,
                          const int power[GLINT_VARIABLES])
{
    uint8_t *to;

    if (s->n_candidates == MAX_CANDIDATES || power[1] % 2 != odd(s->kind))
        return;
    to = s->candidate[s->n_candidates];
    for (int k = 0; k < GLINT_VARIABLES; k++) {
        if (power[k] < 0 || power[k] > GLINT_MAX_POWER)
            return;
        to[k] = (uint8_t)power[k];
    }
    for (int k = 0; k < s->n_candidates; k++)
        if (memcmp(s->candidate[k], to, GLINT_VARIABLES) == 0)
            return;
    if (!has(basis, to))
        s->n_candidates++;
}

/* Lists candidates: pure powers (times y for odd outputs), and the neighbours
 * of the terms of the basis. */
static void find_candidates(struct search *s,
                            const struct glint_shared_basis *basis)
{
    s->n_candidates = 0;
    for (int k = 0; k < GLINT_VARIABLES; k++)
        for (int p = 0; p <= GLINT_MAX_POWER; p++) {
            int power[GLINT_VARIABLES] = {0, odd(s->kind), 0, 0};

            power[k] = k == 1 ? 2 * p + odd(s->kind) : p;
            add_candidate(s, basis, power);
        }
    for (int t = 0; t < basis->n; t++)
        for (int k = 0; k < 2 * GLINT_VARIABLES; k++) {
            const int step = k / 2 == 1 ? 2 : 1;
            int power[GLINT_VARIABLES];

            for (int m = 0; m < GLINT_VARIABLES; m++)
                power[m] = basis->power[t][m];
            power[k / 2] += k % 2 ? -step : step;
            add_candidate(s, basis, power);
        }
}

/* ------------------------------------------------------------------- search */

/* Fits all zones; returns the mean squared error. */
static double settle(struct search *s, struct glint_shared_basis *basis)
{
    double coef[GLINT_SHARED_TERMS], sum = 0;

    for (int k = 0; k < basis->n; k++)
        s->remove[k] = 0;
    for (int k = 0; k < s->n_zones; k++) {
        sum += glint_shared_fit(&s->zone[k], &s->rays[k], s->kind, basis, coef);
        glint_shared_part(&s->zone[k], basis->n, s->remove);
    }
    for (int k = 0; k < basis->n; k++)
        s->remove[k] /= s->n_zones;
    basis->square = sum / s->n_zones;
    return basis->square;
}

/* A change of the basis, and the squared error that it promises. */
struct change {
    int candidate, place; /* place is that of the term to replace; n: the
                             candidate becomes one more term */
    double square;
};

static void try_candidates(struct search *s,
                           const struct glint_shared_basis *basis,
                           struct change *grow, struct change *swap)
{
    const double now = basis->square;
    const int n = basis->n;

    *grow = *swap = (struct change){-1, n, now};
    find_candidates(s, basis);
    for (int c = 0; c < s->n_candidates; c++) {
        double gain[GLINT_SHARED_TERMS + 1] = {0};

        for (int k = 0; k < s->n_zones; k++)
            glint_shared_gain(&s->zone[k], &s->rays[k], n, s->candidate[c],
                              gain);
        if (now - gain[n] / s->n_zones < grow->square)
            *grow = (struct change){c, n, now - gain[n] / s->n_zones};
        for (int i = 0; i < n; i++) {
            const double square = now + s->remove[i] - gain[i] / s->n_zones;

            if (square < swap->square)
                *swap = (struct change){c, i, square};
        }
    }
}

static void apply(const struct search *s, const struct change *change,
                  struct glint_shared_basis *basis)
{
    memcpy(basis->power[change->place], s->candidate[change->candidate],
           GLINT_VARIABLES);
    if (change->place == basis->n)
        basis->n++;
}

/* Drops the term of BASIS that matters least. */
static void drop(const struct search *s, struct glint_shared_basis *basis)
{
    int least = 0;

    for (int k = 1; k < basis->n; k++)
        if (s->remove[k] < s->remove[least])
            least = k;
    basis->square += s->remove[least];
    basis->n--;
    for (int k = least; k < basis->n; k++)
        memcpy(basis->power[k], basis->power[k + 1], GLINT_VARIABLES);
}

/* The best basis of each size, by size; one with square HUGE_VAL was not found.
 */
struct record {
    struct glint_shared_basis best[GLINT_SHARED_TERMS + 1];
};

/* Accepts CHANGED if its fit is better than the best basis of its size. */
static bool accept(struct search *s, struct glint_shared_basis changed,
                   struct glint_shared_basis *basis, struct record *record)
{
    struct glint_shared_basis *best = &record->best[changed.n];

    if (settle(s, &changed) < 0.995 * best->square) {
        *best = *basis = changed;
        return true;
    }
    settle(s, basis);
    return false;
}

/* Changes the basis once; returns false if nothing helps any more. */
static bool step(struct search *s, struct glint_shared_basis *basis,
                 struct record *record, int max_terms, double square)
{
    struct glint_shared_basis changed = *basis;
    struct change grow, swap;

    if (basis->n > 2) {
        drop(s, &changed);
        if (changed.square < 0.98 * record->best[changed.n].square &&
            accept(s, changed, basis, record))
            return true;
    }
    try_candidates(s, basis, &grow, &swap);
    changed = *basis;
    if (swap.candidate >= 0 && swap.square < 0.98 * basis->square) {
        apply(s, &swap, &changed);
        if (accept(s, changed, basis, record))
            return true;
        try_candidates(s, basis, &grow, &swap);
    }
    if (basis->square <= square || basis->n == max_terms || grow.candidate < 0)
        return false;
    changed = *basis;
    apply(s, &grow, &changed);
    return accept(s, changed, basis, record);
}

/* Picks the smallest basis that is good enough, or that no larger one improves
 * on by more than 5 %. */
static void pick(const struct record *record, int max_terms, double square,
                 struct glint_shared_basis *basis)
{
    double least = HUGE_VAL;

    for (int n = 1; n <= max_terms; n++)
        least = fmin(least, record->best[n].square);
    for (int n = 1; n <= max_terms; n++)
        if (record->best[n].square <= fmax(square, 1.05 * least)) {
            *basis = record->best[n];
            return;
        }
}

void glint_shared_search(struct glint_shared_zone *zone,
                         const struct glint_shared_rays *rays, int n_zones,
                         enum glint_channel kind, int max_terms,
                         double tolerance, struct glint_shared_basis *basis)
{
    struct search s = {
        .zone = zone, .rays = rays, .n_zones = n_zones, .kind = kind};
    const double square = tolerance * tolerance;
    struct change grow, swap;
    struct record record;

    for (int n = 0; n <= GLINT_SHARED_TERMS; n++)
        record.best[n] = (struct glint_shared_basis){.square = HUGE_VAL};
    for (int k = 0; k < n_zones; k++)
        glint_shared_begin(&zone[k], &rays[k], kind, tolerance);
    *basis = (struct glint_shared_basis){.n = 0};
    settle(&s, basis);
    try_candidates(&s, basis, &grow, &swap);
    if (grow.candidate < 0) /* all values are 0: any term will do */
        grow = (struct change){0, 0, 0};
    apply(&s, &grow, basis);
    settle(&s, basis);
    record.best[1] = *basis;
    for (int k = 0; k < MAX_STEPS; k++)
        if (!step(&s, basis, &record, max_terms, square))
            break;
    pick(&record, max_terms, square, basis);
}
