/* SPDX-License-Identifier: MIT
 *
 * Opens random bytes as a model, or as a zoom if they begin like one, with
 * valid magic, version, size and checksum so that the other checks are reached.
 * An accepted model must trace rays at the ends of every range of angles,
 * inside and outside them, over the corners of the pupil, to near and far
 * positions, and draw a complete frame; no integer may leave its range. The
 * same holds for a zoom, at its positions and between them.
 *
 *     make fuzz FUZZ=model SECONDS=120
 */
#include "flare/window.h"
#include "fuzz/fuzz.h"
#include "glint/flare.h"
#include "glint/transfer.h"

enum {
    ONE = 1 << 30,
    /* max amount by which an interpolated value may exceed the values at both
     * knots, units of 2^-30 */
    SLACK = 64
};

static void check_traced_rays(struct glint_transfer *t)
{
    static const int32_t at_q30[] = {-ONE, -ONE / 3, 0, 1, ONE};

    for (int k = 0; k < 25; k++) {
        struct glint_outputs out;

        glint_transfer_ray(t, at_q30[k % 5], at_q30[k / 5], &out);
        for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
            require(out.at[kind] <= ONE + SLACK &&
                    out.at[kind] >= -ONE - SLACK);
    }
}

static void check_vertex_range(const struct glint_vertex *v)
{
    if (v->energy_q16 < 0)
        return;
    require(v->energy_q16 <= 1 << 16);
    require(abs(v->x_q8) <= GLINT_VERTEX_LIMIT_Q8 &&
            abs(v->y_q8) <= GLINT_VERTEX_LIMIT_Q8);
    require(abs(v->stop_x_q16) <= ONE && abs(v->stop_y_q16) <= ONE);
    for (int k = 0; k < 2; k++)
        require(v->barrel_q16[k] >= 0 && v->barrel_q16[k] <= ONE);
}

static void check_ray_grids(struct glint_transfer *t)
{
    static const int32_t exponent[] = {-200, -25, 0, 200};
    static const int32_t turn_q30[][2] = {
        {ONE, 0}, {0, -ONE}, {-759250125, 759250125}};
    struct glint_vertex v[25];

    for (int k = 0; k < 12; k++) {
        const struct glint_place place = {
            .cos_q30 = turn_q30[k % 3][0],
            .sin_q30 = turn_q30[k % 3][1],
            .pixels_per_mm = {k < 6 ? INT32_MAX : 1 << 30, exponent[k % 4]},
            .middle_x_q8 = 960 << 8,
            .middle_y_q8 = 540 << 8,
            .stop_scale = {k % 5 ? 3 << 29 : 0, k % 3 * 5 - 30}};
        const int n_cells = t->annulus ? 4 : 1 + k % 3;

        memset(v, 0, sizeof v);
        glint_transfer_grid(t, &place, n_cells, v);
        for (int m = 0; m < (n_cells + 1) * (n_cells + 1); m++)
            check_vertex_range(&v[m]);
    }
}

/* Checks that the pupil window of an opening lies inside the pupil box of the
 * ghost. */
static void check_window_is_inside_pupil_box(struct glint_transfer *t,
                                             int32_t opening_q30)
{
    static struct glint_window_nodes nodes;
    const struct glint_box_window *w = &t->window;

    t->window = glint_box_whole(t);
    if (!glint_window_narrow_to_stop(&nodes, t, opening_q30))
        return;
    require(w->u_half_q30 > 0 && w->v_from_q30 >= (t->whole ? -ONE : 0) &&
            w->v_to_q30 > w->v_from_q30 && w->v_to_q30 <= ONE);
    require((int64_t)w->u_middle_q30 + w->u_half_q30 <= ONE &&
            (int64_t)w->u_middle_q30 - w->u_half_q30 >= -ONE);
    require(t->annulus || t->whole || w->v_from_q30 == 0);
    require(!t->annulus || !t->whole);
}

static void check_ghost_at_azimuth(const struct glint_lens *lens, int ghost,
                                   int32_t sine_q30,
                                   struct glint_azimuth azimuth,
                                   int32_t wave_q24)
{
    static struct glint_transfer t;

    if (sine_q30 < 0 || sine_q30 > ONE)
        return;
    memset(&t, 0xa5, sizeof t);
    if (!glint_transfer_init_at(&t, lens, ghost, sine_q30, azimuth, wave_q24))
        return;
    require(t.outputs >> GLINT_OUT_KINDS == 0 && (t.outputs & 31) == 31);
    check_traced_rays(&t);
    check_ray_grids(&t);
    check_window_is_inside_pupil_box(&t, 1 << 29);
    check_window_is_inside_pupil_box(&t, 1 << 20);
    check_ray_grids(&t);
}

/* Checks GHOST at ten azimuths of the light, or at one if the ghosts of the
 * model do not depend on the azimuth. */
static void check_ghost_at_all_azimuths(const struct glint_lens *lens,
                                        int ghost, int32_t sine_q30,
                                        int32_t wave_q24)
{
    static const struct glint_azimuth at[] = {
        {ONE, 0},     {0, ONE},          {-ONE, 0},       {0, -ONE},
        {ONE, ONE},   {-ONE, 1},         {ONE / 2, -ONE}, {3, 5},
        {-ONE, -ONE}, {ONE / 3, ONE / 7}};
    const int n = glint_basis_is_lens(lens->header->basis)
                      ? (int)(sizeof at / sizeof *at)
                      : 1;

    for (int k = 0; k < n; k++)
        check_ghost_at_azimuth(lens, ghost, sine_q30, at[k], wave_q24);
}

/* Checks GHOST at the angles and wavelengths of the polynomial system that PICK
 * selects. */
static void check_ghost(const struct glint_lens *lens, int ghost, uint32_t pick)
{
    const struct glint_model_ghost *g = &lens->ghost[ghost];
    const int32_t lo = lens->header->wave_lo_q24;
    const int32_t hi = lens->header->wave_hi_q24;

    check_ghost_at_all_azimuths(lens, ghost, 0, lo);
    check_ghost_at_all_azimuths(lens, ghost, ONE, hi);
    if (g->n_systems > 0) {
        const struct glint_model_system *s =
            &lens->system[g->first_system + pick % g->n_systems];
        const int32_t a = s->sine_lo_q30, b = s->sine_hi_q30;

        check_ghost_at_all_azimuths(lens, ghost, a - 1, lo);
        check_ghost_at_all_azimuths(lens, ghost, a, s->wave_lo_q24);
        check_ghost_at_all_azimuths(lens, ghost, a + (b - a) / 3,
                                    lo + (hi - lo) / 3);
        check_ghost_at_all_azimuths(lens, ghost, b, s->wave_hi_q24);
        check_ghost_at_all_azimuths(lens, ghost, b + 1, INT32_MIN);
        check_ghost_at_all_azimuths(lens, ghost, b, INT32_MAX);
    }
}

/* Plans, bins and draws a frame of the model; sanitizers detect errors. */
static void draw_model_frame(const struct glint_lens *lens, int32_t opening_q30)
{
    enum { SIDE = 48, ROOM = 1 << 22 };
    static uint8_t mem[ROOM] __attribute__((aligned(64)));
    static uint8_t picture[2 * SIDE * SIDE];
    const struct glint_model_header *h = lens->header;
    const struct glint_wave wave[2] = {
        {h->wave_lo_q24, {16384, 0, 0}, {1 << 30, -30}},
        {h->wave_hi_q24, {0, 9000, 16384}, {1 << 30, 9}}};
    const struct glint_light beam[2] = {
        {0, ONE, ONE, 0, {1 << 30, -20}, {16384, 16384, 16384}, 0},
        {h->sine_hi_q30,
         ONE / 2,
         ONE / 2,
         -ONE,
         {1 << 30, 20},
         {16384, 1, 0},
         INT32_MAX}};
    const struct glint_flare_frame rays = {.lens = lens,
                                           .wave = wave,
                                           .n_waves = 2,
                                           .pixels_per_mm = {1 << 30, -26},
                                           .fineness = 8,
                                           .faintest = {1 << 30, -42},
                                           .only_ghost = -1};
    struct glint_image image =
        glint_image_over(picture, GLINT_YUYV, SIDE, SIDE);
    const struct glint_flare_config cfg = {.width = SIDE,
                                           .height = SIDE,
                                           .tile_log2 = 4,
                                           .stop.opening_q30 = opening_q30,
                                           .irradiance_steps = 70,
                                           .max_bundles = 64,
                                           .max_primitives = 20000,
                                           .max_refs = 40000};
    struct glint_flare_stats stats;
    struct glint_flare *flare;

    require(glint_flare_init(&flare, &cfg, mem, sizeof mem) == GLINT_OK);
    glint_flare_plan(flare, &rays, beam, 2);
    glint_flare_bin(flare, &stats);
    require(stats.bundles <= cfg.max_bundles && stats.refs <= cfg.max_refs);
    glint_flare_draw(flare, &image);
}

/* Sets magic, version, size and checksum of the header to valid values. */
static void seal_blob_header(uint32_t *word, size_t size, uint32_t magic,
                             uint32_t version)
{
    if (size < 16)
        return;
    word[0] = magic;
    word[1] = version;
    word[2] = (uint32_t)size;
    word[3] = glint_model_crc32(word + 4, size - 16);
}

/* -------------------------------------------------------------------- zoom */

/* Seals the zoom in WORD[SIZE]: sets magic, version, size and checksum of its
 * header, and of each model that lies inside the file, to valid values. */
static void seal_zoom_models(uint32_t *word, size_t size)
{
    const struct glint_zoom_header *const h = (const void *)word;
    const struct glint_zoom_model *m;

    if (size >= sizeof *h && h->model_at < size && h->model_at % 4 == 0) {
        m = (const void *)(word + h->model_at / 4);
        for (uint32_t k = 0; k < h->n_models && k < GLINT_MAX_ZOOM_MODELS &&
                             h->model_at + (k + 1) * sizeof *m <= size;
             k++)
            if (m[k].at >= h->model_at + h->n_models * sizeof *m &&
                m[k].at % 4 == 0 && m[k].bytes < size &&
                m[k].at < size - m[k].bytes)
                seal_blob_header(word + m[k].at / 4, m[k].bytes,
                                 GLINT_MODEL_MAGIC, GLINT_MODEL_VERSION);
    }
    seal_blob_header(word, size, GLINT_ZOOM_MAGIC, GLINT_ZOOM_VERSION);
}

/* Checks GHOST of the zoom at the angles of the nearest model at a lower zoom
 * position. */
static void check_ghost_of_zoom(const struct glint_zoom_lens *zoom, int ghost,
                                uint32_t pick)
{
    const struct glint_lens *const below = &zoom->model[zoom->below];
    const struct glint_model_ghost *const g = &below->ghost[zoom->whole[ghost]];
    const int32_t lo = zoom->header.wave_lo_q24;
    const int32_t hi = zoom->header.wave_hi_q24;

    check_ghost_at_all_azimuths(&zoom->lens, ghost, 0, lo);
    check_ghost_at_all_azimuths(&zoom->lens, ghost, ONE, hi);
    if (g->n_systems > 0) {
        const struct glint_model_system *const s =
            &below->system[g->first_system + pick % g->n_systems];
        const int32_t a = s->sine_lo_q30, b = s->sine_hi_q30;

        check_ghost_at_all_azimuths(&zoom->lens, ghost, a, lo);
        check_ghost_at_all_azimuths(&zoom->lens, ghost, a + (b - a) / 3,
                                    lo + (hi - lo) / 3);
        check_ghost_at_all_azimuths(&zoom->lens, ghost, b, hi);
    }
}

static void check_zoom_model(void *data, size_t size)
{
    static const int32_t along_q30[] = {-1,      0,       1,  ONE / 7,
                                        ONE / 2, ONE - 1, ONE};
    static struct glint_zoom_lens zoom;
    const char *reason = NULL;
    uint32_t pick;

    memset(&zoom, 0xa5, sizeof zoom);
    seal_zoom_models(data, size);
    if (glint_zoom_open(&zoom, data, size, &reason) != GLINT_OK) {
        require(reason && *reason);
        return;
    }
    pick = ((const uint32_t *)data)[3];
    for (int k = 0; k < 7; k++) {
        const uint32_t n = zoom.header.n_ghosts;

        require(n < GLINT_MAX_ZOOM_GHOSTS);
        glint_zoom_set(&zoom, along_q30[k]);
        require(zoom.below >= 0 && zoom.below + 1 < zoom.n_models);
        for (uint32_t g = 0; g < n && g < 2; g++)
            check_ghost_of_zoom(&zoom, (int)((pick + g) % n), pick >> 8);
    }
    glint_zoom_set(&zoom, (int32_t)(pick >> 2));
    draw_model_frame(&zoom.lens, pick & 128 ? 0 : 1 << 27);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint32_t *copy = (void *)fuzz_copy(data, size);
    struct glint_lens lens;
    const char *reason = NULL;

    if (size >= 4 && *copy == GLINT_ZOOM_MAGIC) {
        check_zoom_model(copy, size);
        free(copy);
        return 0;
    }
    seal_blob_header(copy, size, GLINT_MODEL_MAGIC, GLINT_MODEL_VERSION);
    if (glint_lens_open(&lens, copy, size, &reason) == GLINT_OK) {
        const uint32_t pick = copy[3];
        const uint32_t n = lens.header->n_ghosts;

        require(n <= INT32_MAX);
        for (uint32_t k = 0; k < n && k < 2; k++)
            check_ghost(&lens, (int)((pick + k) % n), pick >> 8);
        draw_model_frame(&lens, pick & 128 ? 0 : 1 << 27);
    } else {
        require(reason && *reason);
    }
    free(copy);
    return 0;
}
