/* SPDX-License-Identifier: MIT
 *
 * Checks how the tracker pairs seekers (tracks that need a spot) with spots
 * (lamps found in one frame), cheapest pair first. The reference is a slow
 * search of all pairs.
 */
#include "support/rng.h"
#include "follow/match.h"

#include "base/arena.h"
#include "support/test.h"

enum { MAX = 1024 };

static struct glint_spot spot[MAX];
static struct glint_match match;
static void *mem;
static uint32_t seed = 1;

TEST_OPEN
{
    struct glint_arena arena = glint_arena_begin_measuring();

    glint_match_allocate(&match, &arena, MAX, MAX);
    if (posix_memalign(&mem, 64, arena.used) != 0)
        fail();
    arena = glint_arena_init_in_memory(mem, arena.used);
    glint_match_allocate(&match, &arena, MAX, MAX);
}

TEST_CLOSE
{
    free(mem);
}

static void place_seekers_and_spots_at_random(int n_seekers, int n_spots,
                                              int side_q8)
{
    match.n_seekers = n_seekers;
    for (int i = 0; i < n_seekers; i++)
        match.seeker[i] =
            (struct glint_seeker){.id = (uint32_t)(i * 7919 % 1021) + 1,
                                  .x_q8 = rng_int_below(&seed, side_q8),
                                  .y_q8 = rng_int_below(&seed, side_q8),
                                  .reach_q8 = rng_int_below(&seed, side_q8 / 4),
                                  .max_faint_area = rng_int_below(&seed, 200),
                                  .is_lost = rng_int_below(&seed, 4) == 0};
    for (int i = 0; i < n_spots; i++)
        spot[i] = (struct glint_spot){.x_q8 = rng_int_below(&seed, side_q8),
                                      .y_q8 = rng_int_below(&seed, side_q8),
                                      .area = rng_int_below(&seed, 200),
                                      .faint = rng_int_below(&seed, 4) == 0};
}

/* Returns the cost, as the header defines it, of pairing seeker S (a track)
 * with spot P, or -1 if P is too far away or a too large faint spot. */
static int64_t compute_pairing_cost(const struct glint_seeker *s,
                                    const struct glint_spot *p)
{
    const int64_t dx = p->x_q8 - s->x_q8, dy = p->y_q8 - s->y_q8;
    const int64_t d2 = dx * dx + dy * dy;

    if (d2 > (int64_t)s->reach_q8 * s->reach_q8 ||
        (p->faint && p->area > s->max_faint_area))
        return -1;
    if (p->faint && s->is_lost)
        return 16 * (d2 + 65536);
    return p->faint || s->is_lost ? 4 * (d2 + 65536) : d2;
}

/* Pairs seekers (tracks) and spots by repeatedly choosing the cheapest of all
 * remaining pairs. Sets PARTNER[i] to the spot of seeker i, -1: none. Returns
 * the number of pairs. */
static int match_by_cheapest_pairs(int n_spots, int32_t *partner)
{
    static uint8_t taken[MAX];
    int n = 0;

    memset(taken, 0, sizeof taken);
    for (int i = 0; i < match.n_seekers; i++)
        partner[i] = -1;
    for (;; n++) {
        int64_t best = INT64_MAX;
        int seeker = -1, at = -1;

        for (int i = 0; i < match.n_seekers; i++)
            for (int j = 0; j < n_spots && partner[i] < 0; j++) {
                const int64_t cost =
                    compute_pairing_cost(&match.seeker[i], &spot[j]);

                if (!taken[j] && cost >= 0 && cost < best)
                    best = cost, seeker = i, at = j;
            }
        if (seeker < 0)
            return n;
        partner[seeker] = at;
        taken[at] = 1;
    }
}

/* Compares the pairs with those of the slow search; no two costs are equal. */
TEST(pairs_match_the_slow_search)
{
    static int32_t partner[MAX];
    int n_matched = 0;

    for (int round = 0; round < 300; round++) {
        /* in every third round up to eight seekers compete for the same
         * spots */
        const int is_near = round % 3 == 0;
        const int n_seekers = rng_int_below(&seed, is_near ? 9 : 40);
        const int n_spots = rng_int_below(&seed, 40);

        place_seekers_and_spots_at_random(n_seekers, n_spots, 300 << 8);
        for (int i = 0; is_near && i < n_seekers; i++) {
            match.seeker[i].x_q8 = match.seeker[i].x_q8 / 8 + (130 << 8);
            match.seeker[i].y_q8 = match.seeker[i].y_q8 / 8 + (130 << 8);
            match.seeker[i].reach_q8 = 600 << 8;
        }
        glint_match_assign_spots(&match, spot, n_spots);
        n_matched += match_by_cheapest_pairs(n_spots, partner);
        for (int i = 0; i < n_seekers; i++)
            assert_int_equal(match.seeker[i].spot, partner[i]);
    }
    assert_true(n_matched > 1000);
}

/* Returns the number of spots that are nearer to seeker S than spot AT is. */
static int count_nearer_spots(const struct glint_seeker *s, int at)
{
    int n = 0;

    for (int j = 0; j < MAX; j++) {
        const int64_t cost = compute_pairing_cost(s, &spot[j]);

        n += cost >= 0 && cost < compute_pairing_cost(s, &spot[at]);
    }
    return n;
}

/* Checks the max number of seekers (tracks) and spots, every spot near enough
 * to every seeker: no spot is used twice, and each seeker gets one of its eight
 * nearest spots. */
TEST(crowded_seekers_get_distinct_spots)
{
    static uint8_t seen[MAX];
    int n = 0;

    place_seekers_and_spots_at_random(MAX, MAX, 30 << 8);
    for (int i = 0; i < MAX; i++)
        match.seeker[i].reach_q8 = 1 << 23;
    glint_match_assign_spots(&match, spot, MAX);
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < MAX; i++) {
        const int32_t at = match.seeker[i].spot;

        if (at < 0)
            continue;
        assert_in_range(at, 0, MAX - 1);
        assert_int_equal(seen[at]++, 0);
        assert_int_equal(match.taken[at], 1);
        assert_true(count_nearer_spots(&match.seeker[i], at) < 8);
        n++;
    }
    assert_in_range(n, MAX / 2, MAX);
}

/* Checks that a spot exactly at the max distance of a seeker (a track) is
 * paired, and that a spot further away is not. */
TEST(reach_includes_the_max_distance)
{
    static const int32_t way[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

    for (int k = 0; k < 4; k++)
        for (int more = 0; more < 2; more++) {
            match.n_seekers = 1;
            match.seeker[0] = (struct glint_seeker){
                .id = 1, .x_q8 = 50000, .y_q8 = 40000, .reach_q8 = 3000};
            spot[0] =
                (struct glint_spot){.x_q8 = 50000 + way[k][0] * (3000 + more),
                                    .y_q8 = 40000 + way[k][1] * (3000 + more)};
            glint_match_assign_spots(&match, spot, 1);
            assert_int_equal(match.seeker[0].spot, more ? -1 : 0);
        }
}

/* Places N seekers and N spots at a few positions, so that most costs are
 * equal. Spots at the same position differ in one member. */
static void place_pairs_with_equal_costs(int n)
{
    match.n_seekers = n;
    for (int i = 0; i < n; i++) {
        match.seeker[i] =
            (struct glint_seeker){.id = (uint32_t)(i * 7919 % 1021) + 1,
                                  .x_q8 = rng_int_below(&seed, 4) << 8,
                                  .y_q8 = rng_int_below(&seed, 4) << 8,
                                  .reach_q8 = 2 << 8};
        spot[i] = (struct glint_spot){.x_q8 = rng_int_below(&seed, 4) << 8,
                                      .y_q8 = rng_int_below(&seed, 4) << 8,
                                      .power_q16 = i};
    }
}

/* Shuffles the first N elements, of BYTES bytes each, of THINGS. */
static void shuffle_items(void *things, int n, size_t bytes)
{
    uint8_t *const at = things, kept[sizeof(struct glint_spot)];

    assert_true(bytes <= sizeof kept);
    for (int i = n - 1; i > 0; i--) {
        const int j = rng_int_below(&seed, i + 1);

        memcpy(kept, at + (size_t)i * bytes, bytes);
        memcpy(at + (size_t)i * bytes, at + (size_t)j * bytes, bytes);
        memcpy(at + (size_t)j * bytes, kept, bytes);
    }
}

/* Sets POWER[id] to the power of the spot that is paired with the seeker ID, or
 * to -1 if there is none. */
static void read_powers_of_matches(int64_t power[MAX + 1])
{
    for (int i = 0; i < match.n_seekers; i++) {
        const int32_t at = match.seeker[i].spot;

        power[match.seeker[i].id] = at < 0 ? -1 : spot[at].power_q16;
    }
}

/* Checks that ids and the members of spots decide between equal costs, not the
 * order in the array. */
TEST(ties_do_not_depend_on_order)
{
    static int64_t power[MAX + 1], again[MAX + 1];

    for (int round = 0; round < 100; round++) {
        const int n = 1 + rng_int_below(&seed, 60);

        place_pairs_with_equal_costs(n);
        glint_match_assign_spots(&match, spot, n);
        memset(power, 0, sizeof power);
        memset(again, 0, sizeof again);
        read_powers_of_matches(power);
        shuffle_items(match.seeker, n, sizeof *match.seeker);
        shuffle_items(spot, n, sizeof *spot);
        glint_match_assign_spots(&match, spot, n);
        read_powers_of_matches(again);
        assert_memory_equal(power, again, sizeof power);
    }
}
