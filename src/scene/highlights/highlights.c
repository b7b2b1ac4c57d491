/* SPDX-License-Identifier: MIT
 *
 * Finds highlights on objects. While objects are drawn, their light above white
 * is summed in squares of 8 x 8 pixels. Connected squares with such light form
 * one highlight.
 *
 * Results do not depend on the number of workers: each square lies in one row
 * of tiles, which one worker draws, and all sums are integers. */
#include "glint/scene/highlights.h"

#include "base/divide.h"
#include "scene/parts.h"

enum {
    ONE_Q15 = GLINT_SCENE_ONE_Q15,
    SIDE_LOG2 = 3,
    SIDE_Q8 = 256 << SIDE_LOG2,
    /* min flux of a reported highlight: 1 unit of _q16 */
    LEAST_Q19 = 8,
    KEPT = 64, /* max number of highlights in the list, before near ones
                  are merged */
    /* log2 of the upper bound of the sum of a highlight's cell weights */
    WEIGHT_LOG2 = 26
};

/* Sums over the pixels of one square. A pixel has weight 16, divided among its
 * samples. Light is below 2^30, so sums of light over 64 pixels are below 2^40,
 * and sums of light times position below 2^62. */
struct glint_highlight_cell {
    int64_t flux_q19; /* sum of L clamp(L - 1, 0, 1), L: luminance */
    int64_t
        at_q27[2]; /* flux times position in the square, summed over pixels */
    /* Half of (flux times squared distance from the square's corner), summed
     * over pixels. */
    int64_t square_q35;
    int64_t red_q19, blue_q19;
    /* Light of the brightest pixel, and index of the object in this pixel. */
    int32_t peak_q15;
    uint32_t object;
};

/* A highlight: a linked list of squares, and the sums over them. */
struct gathered {
    int first, n;
    int64_t flux_q19, red_q19, blue_q19;
    int32_t peak_q15;
    uint32_t object;
    int32_t at_q8[2];
};

struct glint_highlight_state {
    int across, down;
    struct glint_highlight_cell *cell; /* [down][across] */
    /* For each square: index of the next square of the same highlight, END for
     * the highlight's last square, or UNSEEN if the square belongs to no
     * highlight yet. */
    int32_t *next;
    struct gathered *kept; /* [KEPT], brightest first */
};

enum { UNSEEN = -2, END = -1 };

/* ------------------------------------------------------------------- light */

static struct glint_highlight_state *
allocate_highlights(const struct glint_scene *scene, struct glint_arena *arena)
{
    struct glint_highlight_state measured;
    struct glint_highlight_state *placed =
        glint_arena_allocate(arena, 1, sizeof *placed);
    struct glint_highlight_state *b = placed ? placed : &measured;
    size_t n;

    b->across = (scene->cfg.width + 7) >> SIDE_LOG2;
    b->down = (scene->cfg.height + 7) >> SIDE_LOG2;
    n = (size_t)b->across * (size_t)b->down;
    b->cell = glint_arena_allocate(arena, n, sizeof *b->cell);
    b->next = glint_arena_allocate(arena, n, sizeof *b->next);
    b->kept = glint_arena_allocate(arena, KEPT, sizeof *b->kept);
    return placed;
}

static void clear_highlight_cells(struct glint_highlight_state *b)
{
    for (int i = 0; i < b->across * b->down; i++)
        b->cell[i] = (struct glint_highlight_cell){0};
}

static void add_highlight_sample(struct glint_highlight_state *b,
                                 uint32_t object, int32_t x_q8, int32_t y_q8,
                                 const int32_t rgb_q15[3], int share_q4)
{
    const int64_t light_q15 =
        q_shift(INT64_C(6966) * rgb_q15[0] + INT64_C(23436) * rgb_q15[1] +
                    INT64_C(2366) * rgb_q15[2],
                15);
    const int64_t weight_q15 = q_clamp_sat(light_q15 - ONE_Q15, 0, ONE_Q15);
    const int64_t flux_q19 = q_shift(light_q15 * weight_q15, 15) * share_q4;
    struct glint_highlight_cell *c =
        &b->cell[(y_q8 / SIDE_Q8) * b->across + x_q8 / SIDE_Q8];
    const int64_t x = x_q8 % SIDE_Q8, y = y_q8 % SIDE_Q8;

    c->flux_q19 += flux_q19;
    c->at_q27[0] += flux_q19 * x;
    c->at_q27[1] += flux_q19 * y;
    c->square_q35 += flux_q19 * ((x * x + y * y) / 2);
    c->red_q19 += q_shift(rgb_q15[0] * weight_q15, 15) * share_q4;
    c->blue_q19 += q_shift(rgb_q15[2] * weight_q15, 15) * share_q4;
    if (light_q15 > c->peak_q15) {
        c->peak_q15 = (int32_t)light_q15;
        c->object = object;
    }
}

/* --------------------------------------------------------------- gathering */

static void add_cell_to_highlight(const struct glint_highlight_cell *c,
                                  struct gathered *g)
{
    g->n++;
    g->flux_q19 += c->flux_q19;
    g->red_q19 += c->red_q19;
    g->blue_q19 += c->blue_q19;
    if (c->peak_q15 > g->peak_q15) {
        g->peak_q15 = c->peak_q15;
        g->object = c->object;
    }
}

/* Appends neighbours of square I to the list that ends with square LAST: those
 * with light that belong to no highlight yet. Returns the new last square. */
static int append_lit_neighbours(struct glint_highlight_state *b, int i,
                                 int last)
{
    const int x = i % b->across, y = i / b->across;

    for (int v = q_larger(0, y - 1); v <= y + 1 && v < b->down; v++)
        for (int u = q_larger(0, x - 1); u <= x + 1 && u < b->across; u++) {
            const int k = v * b->across + u;

            if (b->cell[k].flux_q19 == 0 || b->next[k] != UNSEEN)
                continue;
            b->next[last] = k;
            b->next[k] = END;
            last = k;
        }
    return last;
}

/* Sets AT to the centroid of the light in square I, pixels q8 from the
 * picture's top left corner. */
static void compute_cell_centroid(const struct glint_highlight_state *b, int i,
                                  int32_t at[2])
{
    const struct glint_highlight_cell *c = &b->cell[i];
    const int corner[2] = {i % b->across * SIDE_Q8, i / b->across * SIDE_Q8};

    for (int k = 0; k < 2; k++)
        at[k] = corner[k] + glint_divide_rounded((uint64_t)c->at_q27[k],
                                                 (uint64_t)c->flux_q19);
}

/* Returns the flux of square C as a weight: the weights of all squares of a
 * highlight of total flux FLUX_Q19 sum to less than 2^WEIGHT_LOG2. */
static uint64_t compute_cell_weight(const struct glint_highlight_cell *c,
                                    int64_t flux_q19)
{
    const int up = q_count_normalising_shift((uint64_t)flux_q19);
    const int down = q_larger(0, 32 - WEIGHT_LOG2 - up);

    return (uint64_t)c->flux_q19 >> down;
}

/* Sets the middle of highlight G to the mean position of its light. */
static void set_highlight_middle(const struct glint_highlight_state *b,
                                 struct gathered *g)
{
    uint64_t weight = 0, at[2] = {0, 0};

    for (int i = g->first; i != END; i = b->next[i]) {
        const uint64_t w = compute_cell_weight(&b->cell[i], g->flux_q19);
        int32_t middle[2];

        compute_cell_centroid(b, i, middle);
        weight += w;
        for (int k = 0; k < 2; k++)
            at[k] += w * (uint64_t)middle[k];
    }
    for (int k = 0; k < 2; k++)
        g->at_q8[k] = glint_divide_rounded(at[k], weight);
}

/* Returns the highlight that contains square I, which must belong to no
 * highlight yet. */
static struct gathered gather_connected_cells(struct glint_highlight_state *b,
                                              int i)
{
    struct gathered g = {.first = i};
    int last = i;

    b->next[i] = END;
    for (int at = i; at != END; at = b->next[at]) {
        add_cell_to_highlight(&b->cell[at], &g);
        last = append_lit_neighbours(b, at, last);
    }
    set_highlight_middle(b, &g);
    return g;
}

/* ----------------------------------------------------------------- choosing */

/* Inserts G into the list KEPT of the brightest highlights, which has N
 * elements and holds at most KEPT; returns the new number. Equally bright
 * highlights stay in the order in which they were found. */
static int insert_highlight_by_brightness(struct gathered *kept, int n,
                                          const struct gathered *g)
{
    int i = n < KEPT ? n : KEPT - 1;

    if (n == KEPT && g->flux_q19 <= kept[i].flux_q19)
        return n;
    for (; i > 0 && kept[i - 1].flux_q19 < g->flux_q19; i--)
        kept[i] = kept[i - 1];
    kept[i] = *g;
    return n < KEPT ? n + 1 : n;
}

static int are_highlights_near_each_other(const struct gathered *a,
                                          const struct gathered *b)
{
    const int64_t x = a->at_q8[0] - b->at_q8[0], y = a->at_q8[1] - b->at_q8[1];
    const int64_t most = 256 * GLINT_SCENE_HIGHLIGHT_APART;

    return x * x + y * y < most * most;
}

static void merge_highlights(struct glint_highlight_state *b,
                             struct gathered *to, const struct gathered *from)
{
    int last = to->first;

    while (b->next[last] != END)
        last = b->next[last];
    b->next[last] = from->first;
    to->n += from->n;
    to->flux_q19 += from->flux_q19;
    to->red_q19 += from->red_q19;
    to->blue_q19 += from->blue_q19;
    if (from->peak_q15 > to->peak_q15) {
        to->peak_q15 = from->peak_q15;
        to->object = from->object;
    }
    set_highlight_middle(b, to);
}

static int remove_highlight(struct gathered *kept, int n, int i)
{
    for (; i + 1 < n; i++)
        kept[i] = kept[i + 1];
    return n - 1;
}

/* Merges the first pair of highlights, among *N, whose middles are near each
 * other. Then sorts the list by brightness again. Returns 0 if there is no such
 * pair. */
static int merge_first_pair_of_near_highlights(struct glint_highlight_state *b,
                                               struct gathered *kept, int *n)
{
    for (int i = 0; i < *n; i++)
        for (int k = i + 1; k < *n; k++)
            if (are_highlights_near_each_other(&kept[i], &kept[k])) {
                struct gathered both = kept[i];

                merge_highlights(b, &both, &kept[k]);
                *n = remove_highlight(kept, remove_highlight(kept, *n, k), i);
                *n = insert_highlight_by_brightness(kept, *n, &both);
                return 1;
            }
    return 0;
}

/* -------------------------------------------------------------------- spots */

/* Variances of a highlight, pixels^2 q8, and its covariance. */
struct spread {
    int64_t x_q8, y_q8, xy_q8;
};

/* Returns variance and covariance of highlight G's light: those of the
 * centroids in its squares, plus the mean isotropic variance within a
 * square. */
static struct spread
compute_highlight_variance(const struct glint_highlight_state *b,
                           const struct gathered *g)
{
    int64_t x = 0, y = 0, xy = 0, within = 0;
    uint64_t weight = 0;

    for (int i = g->first; i != END; i = b->next[i]) {
        const struct glint_highlight_cell *c = &b->cell[i];
        const int64_t w = (int64_t)compute_cell_weight(c, g->flux_q19);
        int32_t middle[2];
        int64_t off[2], own;

        compute_cell_centroid(b, i, middle);
        for (int k = 0; k < 2; k++) /* q4, magnitude below 2^17 */
            off[k] = (middle[k] - g->at_q8[k]) / 16;
        own = glint_divide_rounded((uint64_t)c->square_q35,
                                   (uint64_t)c->flux_q19);
        for (int k = 0; k < 2; k++) {
            const int64_t in = middle[k] % SIDE_Q8;

            own -= in * in / 2;
        }
        x += w * off[0] * off[0];
        y += w * off[1] * off[1];
        xy += w * off[0] * off[1];
        within += w * q_clamp_sat(own, 0, SIDE_Q8 * SIDE_Q8);
        weight += (uint64_t)w;
    }
    within = glint_divide_rounded((uint64_t)within, weight << 8);
    return (struct spread){glint_divide_rounded((uint64_t)x, weight) + within,
                           glint_divide_rounded((uint64_t)y, weight) + within,
                           (xy < 0 ? -1 : 1) * (int64_t)glint_divide_rounded(
                                                   q_magnitude(xy), weight)};
}

/* Returns the square root of VARIANCE, pixels q8, at least half a pixel. */
static int32_t compute_standard_deviation_q8(int64_t variance_q8)
{
    return q_larger(128,
                    (int32_t)glint_compute_square_root(
                        (uint64_t)q_clamp_sat(variance_q8, 0, 1 << 30) << 8));
}

static void set_spot_extent(const struct spread *s, struct glint_spot *spot)
{
    const int64_t half = (s->x_q8 - s->y_q8) / 2;
    const int64_t middle = (s->x_q8 + s->y_q8) / 2;
    const int64_t apart = glint_compute_square_root(
        (uint64_t)(half * half) + (uint64_t)(s->xy_q8 * s->xy_q8));
    int64_t cos2_q15 = ONE_Q15;

    spot->axis_q8[0] = compute_standard_deviation_q8(middle + apart);
    spot->axis_q8[1] = compute_standard_deviation_q8(middle - apart);
    spot->size_q8 = (int32_t)glint_compute_square_root(
        (uint64_t)((int64_t)spot->axis_q8[0] * spot->axis_q8[0] +
                   (int64_t)spot->axis_q8[1] * spot->axis_q8[1]));
    if (apart > 0)
        cos2_q15 =
            (half < 0 ? -1 : 1) *
            q_smaller(ONE_Q15, glint_divide_rounded(q_magnitude(half) << 15,
                                                    (uint64_t)apart));
    spot->cos_q15 = (int32_t)glint_compute_square_root(
        (uint64_t)(ONE_Q15 + cos2_q15) << 14);
    spot->sin_q15 = (int32_t)glint_compute_square_root(
        (uint64_t)(ONE_Q15 - cos2_q15) << 14);
    if (s->xy_q8 < 0)
        spot->sin_q15 = -spot->sin_q15;
}

static void set_spot_colour(const struct gathered *g, struct glint_spot *spot)
{
    const uint64_t flux = (uint64_t)g->flux_q19;
    /* The blue channel is at most 2^4 times the flux. */
    const int up =
        (int)q_clamp_sat(q_count_normalising_shift(flux) + 26, 0, 15);
    int64_t rest;

    spot->rgb_q15[0] =
        glint_divide_rounded((uint64_t)g->red_q19 << up, flux >> (15 - up));
    spot->rgb_q15[2] =
        glint_divide_rounded((uint64_t)g->blue_q19 << up, flux >> (15 - up));
    rest = ((int64_t)ONE_Q15 << 15) - INT64_C(6966) * spot->rgb_q15[0] -
           INT64_C(2366) * spot->rgb_q15[2];
    spot->rgb_q15[1] =
        rest > 0 ? glint_divide_rounded((uint64_t)rest, 23436) : 0;
}

static void convert_highlight_to_spot(const struct glint_highlight_state *b,
                                      const struct gathered *g,
                                      struct glint_scene_highlight *found)
{
    struct glint_spot *spot = &found->spot;
    const struct spread spread = compute_highlight_variance(b, g);
    const int64_t max_q16 = INT64_C(1) << 42;

    *spot = (struct glint_spot){.x_q8 = g->at_q8[0],
                                .y_q8 = g->at_q8[1],
                                .area = g->n << 2 * SIDE_LOG2};
    spot->flux_q16 = q_shift(g->flux_q19, 3);
    if (spot->flux_q16 > max_q16)
        spot->flux_q16 = max_q16;
    spot->power_q16 = spot->flux_q16;
    set_spot_extent(&spread, spot);
    set_spot_colour(g, spot);
    found->object = (int)g->object;
}

static int find_highlights(const struct glint_scene *scene,
                           struct glint_scene_highlight *found)
{
    struct glint_highlight_state *b = scene->bright;
    struct gathered *const kept = b->kept;
    int n = 0, joined;

    for (int i = 0; i < b->across * b->down; i++)
        b->next[i] = UNSEEN;
    for (int i = 0; i < b->across * b->down; i++)
        if (b->cell[i].flux_q19 > 0 && b->next[i] == UNSEEN) {
            const struct gathered g = gather_connected_cells(b, i);

            n = insert_highlight_by_brightness(kept, n, &g);
        }
    do
        joined = merge_first_pair_of_near_highlights(b, kept, &n);
    while (joined);
    n = q_smaller(n, glint_scene_get_max_highlights(scene));
    while (n > 0 && kept[n - 1].flux_q19 < LEAST_Q19)
        n--;
    for (int i = 0; i < n; i++)
        convert_highlight_to_spot(b, &kept[i], &found[i]);
    return n;
}

const struct glint_scene_highlights glint_scene_highlights = {
    allocate_highlights, clear_highlight_cells, add_highlight_sample};

int glint_scene_find_highlights(const struct glint_scene *scene,
                                struct glint_scene_highlight *found)
{
    return scene->bright ? find_highlights(scene, found) : 0;
}
