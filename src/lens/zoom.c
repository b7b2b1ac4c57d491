/* SPDX-License-Identifier: MIT
 *
 * Combines the models of several zoom positions to one lens.
 *
 *    in   models of one lens, with the same surfaces, film and band
 *    out  a header interpolated between the headers of two positions, a list of
 *         the ghosts of all models, and interpolated bundles
 *
 * Ghosts of all models are the same pairs of surfaces in the same order. A
 * ghost whose pupil is divided has further parts; the list has as many as the
 * model with the most. Where both neighbouring models divide the pupil of a
 * ghost alike at an angle, the two are mixed; otherwise the nearer model is
 * drawn. Where one model has no light, the other is extrapolated using a third
 * model farther away, or faded.
 */
#include "glint/model.h"

#include "base/blob.h"
#include "base/real.h"
#include "lens/blend.h"
#include "lens/terms.h"

STATIC_ASSERT(sizeof(struct glint_zoom_header) == 100);
STATIC_ASSERT(sizeof(struct glint_zoom_model) == 16);
GLINT_BLOB_HEADER(struct glint_zoom_header, variant);

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("zoom", "zooms", "made");

/* ------------------------------------------------------------------- ghosts */

static int count_whole(const struct glint_lens *lens)
{
    return (int)(lens->header->n_ghosts - lens->header->n_parts);
}

/* Returns the number of further parts of ghost G in model LENS. *NEXT is the
 * index of the first part that has not been counted; it is advanced. */
static int count_parts(const struct glint_lens *lens, int g, uint32_t *next)
{
    const struct glint_model_ghost *const of = &lens->ghost[g];
    int n = 0;

    while (*next < lens->header->n_ghosts && lens->ghost[*next].i == of->i &&
           lens->ghost[*next].j == of->j) {
        ++*next;
        n++;
    }
    return n;
}

/* Lists the ghosts of all models and their parts. Returns the text of an
 * error, or NULL. */
static const char *list_ghosts(struct glint_zoom_lens *z)
{
    const int n = count_whole(&z->model[0]);
    uint32_t next[GLINT_MAX_ZOOM_MODELS];
    int end = n;

    if (n >= GLINT_MAX_ZOOM_GHOSTS)
        return "a zoom has too many ghosts";
    for (int k = 0; k < z->n_models; k++)
        next[k] = (uint32_t)n;
    for (int g = 0; g < n; g++) {
        int most = 0;

        z->ghost[g] = (struct glint_model_ghost){z->model[0].ghost[g].i,
                                                 z->model[0].ghost[g].j, 0, 0};
        z->whole[g] = (int16_t)g;
        z->number[g] = 0;
        for (int k = 0; k < z->n_models; k++) {
            const int parts = count_parts(&z->model[k], g, &next[k]);

            most = parts > most ? parts : most;
        }
        z->part_from[g] = (int16_t)end;
        for (int q = 0; q < most && end < GLINT_MAX_ZOOM_GHOSTS; q++, end++) {
            z->ghost[end] = z->ghost[g];
            z->whole[end] = (int16_t)g;
            z->number[end] = (int16_t)(q + 1);
        }
    }
    if (end >= GLINT_MAX_ZOOM_GHOSTS)
        return "a zoom has too many parts of ghosts";
    z->part_from[n] = (int16_t)end;
    for (int k = 0; k < z->n_models; k++)
        if (next[k] != z->model[k].header->n_ghosts)
            return "parts of a zoom's ghosts are not in the order of ghosts";
    return NULL;
}

static int has_ghost(const struct glint_zoom_lens *z, int k, int g)
{
    return !z->has[k] || (z->has[k][g / 32] >> g % 32 & 1);
}

/* Finds, for each ghost, the nearest models with this ghost on both sides of
 * the zoom position. END receives the first and the last model in use. */
static void find_sides(struct glint_zoom_lens *z, int end[2])
{
    end[0] = z->below;
    end[1] = z->below + 1;
    for (int g = 0; g < count_whole(&z->model[0]); g++) {
        int below = z->below, above = z->below + 1;

        while (!has_ghost(z, below, g))
            below--;
        while (!has_ghost(z, above, g))
            above++;
        z->side[0][g] = (uint8_t)below;
        z->side[1][g] = (uint8_t)above;
        end[0] = below < end[0] ? below : end[0];
        end[1] = above > end[1] ? above : end[1];
    }
}

/* Sets the indices in the model of SIDE of the parts of ghost G: PARTS parts
 * from AT on. */
static void set_places(struct glint_zoom_lens *z, int side, int g, uint32_t at,
                       int parts)
{
    z->place[side][g] = (int16_t)g;
    for (int e = z->part_from[g]; e < z->part_from[g + 1]; e++)
        z->place[side][e] = (int16_t)(z->number[e] <= parts ? (int)at++ : -1);
}

/* Sets the indices in model K of all ghosts and parts that have K as a side. */
static void find_places(struct glint_zoom_lens *z, int k)
{
    const struct glint_lens *const m = &z->model[k];
    uint32_t next = (uint32_t)count_whole(m);

    for (int g = 0; g < count_whole(m); g++) {
        const uint32_t at = next;
        const int parts = count_parts(m, g, &next);

        for (int side = 0; side < 2; side++)
            if (z->side[side][g] == k)
                set_places(z, side, g, at, parts);
    }
}

/* ------------------------------------------------------------------- header */

/* Returns A (1 - PART) + B PART. */
static struct glint_real interpolate_real(struct glint_real a,
                                          struct glint_real b, int32_t part_q30)
{
    const int e = a.mantissa == 0           ? b.exponent
                  : b.mantissa == 0         ? a.exponent
                  : a.exponent > b.exponent ? a.exponent
                                            : b.exponent;
    const int off_a = e - a.exponent, off_b = e - b.exponent;
    const int64_t rest = TRANSFER_ONE_Q30 - part_q30;
    const int64_t x =
        a.mantissa && off_a < 62 ? q_shift((a.mantissa * rest), off_a) : 0;
    const int64_t y = b.mantissa && off_b < 62
                          ? q_shift((b.mantissa * (int64_t)part_q30), off_b)
                          : 0;

    return real_of(x + y, e - 30);
}

/* Returns the position of the zoom between model FROM (0) and model TO (1);
 * below 0 if the zoom is on the far side of FROM. */
static int32_t compute_way_q30(const struct glint_zoom_lens *z, int from,
                               int to)
{
    const int64_t at_q30 = z->along_q30[from];

    return (int32_t)q_divide((z->now_q30 - at_q30) * TRANSFER_ONE_Q30,
                             z->along_q30[to] - at_q30);
}

static void set_header(struct glint_zoom_lens *z)
{
    const struct glint_model_header *const a = z->model[z->below].header;
    const struct glint_model_header *const b = z->model[z->below + 1].header;
    struct glint_model_header *const h = &z->header;
    const int32_t part = compute_way_q30(z, z->below, z->below + 1);

    h->focal_mm = interpolate_real(a->focal_mm, b->focal_mm, part);
    h->back_focal_mm =
        interpolate_real(a->back_focal_mm, b->back_focal_mm, part);
    h->entrance_radius_mm =
        interpolate_real(a->entrance_radius_mm, b->entrance_radius_mm, part);
    h->stop_radius_mm =
        interpolate_real(a->stop_radius_mm, b->stop_radius_mm, part);
    h->f_number = interpolate_real(a->f_number, b->f_number, part);
    for (int k = 0; k < GLINT_FLUX_TERMS; k++) {
        h->direct_flux[k] =
            interpolate_real(a->direct_flux[k], b->direct_flux[k], part);
        for (int i = 0; i < 2; i++)
            h->stopped_flux[i][k] = interpolate_real(
                a->stopped_flux[i][k], b->stopped_flux[i][k], part);
    }
}

static int is_equal(struct glint_real a, struct glint_real b)
{
    return a.mantissa == b.mantissa && a.exponent == b.exponent;
}

/* Returns the reason why B is not another position of the zoom A, or NULL if
 * it is one. */
static const char *check_pair(const struct glint_lens *a,
                              const struct glint_lens *b)
{
    const struct glint_model_header *const h = a->header, *const g = b->header;

    if (h->basis != GLINT_BASIS_AUTO || g->basis != GLINT_BASIS_AUTO)
        return "a zoom's models have another basis than auto";
    if (h->n_surfaces != g->n_surfaces || count_whole(a) != count_whole(b))
        return "a zoom's models are of different lenses";
    if (!is_equal(h->film_width_mm, g->film_width_mm) ||
        !is_equal(h->film_height_mm, g->film_height_mm) ||
        !is_equal(h->field_mm, g->field_mm) ||
        h->wave_lo_q24 != g->wave_lo_q24 || h->wave_hi_q24 != g->wave_hi_q24 ||
        h->sine_hi_q30 != g->sine_hi_q30)
        return "a zoom's models differ in film, field, band or largest angle";
    for (int k = 0; k < count_whole(a); k++)
        if (a->ghost[k].i != b->ghost[k].i || a->ghost[k].j != b->ghost[k].j)
            return "a zoom's models have different ghosts";
    return NULL;
}

/* ---------------------------------------------------------------- transfers */

/* Returns the model on SIDE of the ghost or part E. */
static const struct glint_lens *get_model(const struct glint_zoom_lens *z,
                                          int e, int side)
{
    return &z->model[z->side[side][z->whole[e]]];
}

/* Returns the position of the zoom between the two models of GHOST, 0 .. 1. */
static int32_t compute_part_q30(const struct glint_zoom_lens *z, int ghost)
{
    const int g = z->whole[ghost];

    return compute_way_q30(z, z->side[0][g], z->side[1][g]);
}

/* Returns the annulus member of the system of entry E on SIDE at this angle
 * and wavelength, or -1 if no light gets through there. */
static int find_annulus(const struct glint_zoom_lens *z, int e, int side,
                        int32_t sine_q30, int32_t wave_q24)
{
    const int at = z->place[side][e];
    const struct glint_model_system *const s =
        at < 0 ? NULL
               : glint_transfer_system(get_model(z, e, side), at, sine_q30,
                                       wave_q24);

    return s ? s->annulus : -1;
}

/* Returns whether both sides divide the pupil of ghost G alike. Sets
 * LIT[side] to whether light gets through any part on that side. */
static int is_alike(const struct glint_zoom_lens *z, int g, int32_t sine_q30,
                    int32_t wave_q24, int lit[2])
{
    int alike = 1;

    lit[0] = lit[1] = 0;
    for (int q = z->part_from[g] - 1; q < z->part_from[g + 1]; q++) {
        const int e = q < z->part_from[g] ? g : q;
        const int a = find_annulus(z, e, 0, sine_q30, wave_q24);
        const int b = find_annulus(z, e, 1, sine_q30, wave_q24);

        lit[0] |= a >= 0;
        lit[1] |= b >= 0;
        alike &= a == b;
    }
    return alike;
}

/* Sets TRANSFER to entry E of the model on SIDE, without mixing. Returns
 * whether light gets through. */
static int set_from_side(struct glint_transfer *transfer,
                         const struct glint_zoom_lens *z, int e, int side,
                         int32_t sine_q30, int32_t wave_q24)
{
    return z->place[side][e] >= 0 &&
           glint_transfer_init(transfer, get_model(z, e, side),
                               z->place[side][e], sine_q30, wave_q24);
}

/* Returns the nearest model beyond SIDE that has ghost G and is at least as
 * far from SIDE as the two sides are from each other, so that extrapolation
 * at most doubles a distance; -1 if there is none. */
static int find_beyond(const struct glint_zoom_lens *z, int g, int side)
{
    const int from = z->side[side][g], step = side ? 1 : -1;
    const int64_t gap =
        (int64_t)z->along_q30[z->side[1][g]] - z->along_q30[z->side[0][g]];

    for (int k = from + step; k >= 0 && k < z->n_models; k += step)
        if (has_ghost(z, k, g) &&
            step * ((int64_t)z->along_q30[k] - z->along_q30[from]) >= gap)
            return k;
    return -1;
}

/* Sets TRANSFER to ghost G, extrapolated from SIDE and a model beyond it.
 * The ghost must have light on SIDE only, and no further parts there.
 * Returns whether this is possible. */
static int extrapolate_ghost(struct glint_transfer *transfer,
                             const struct glint_zoom_lens *z, int g, int side,
                             int32_t sine_q30, int32_t wave_q24)
{
    const int beyond = find_beyond(z, g, side);
    const struct glint_model_system *there;

    for (int q = z->part_from[g]; q < z->part_from[g + 1]; q++)
        if (find_annulus(z, q, side, sine_q30, wave_q24) >= 0)
            return 0;
    if (beyond < 0)
        return 0;
    there = glint_transfer_system(&z->model[beyond], g, sine_q30, wave_q24);
    if (!there || there->annulus != 0 ||
        find_annulus(z, g, side, sine_q30, wave_q24) != 0)
        return 0;
    return set_from_side(transfer, z, g, side, sine_q30, wave_q24) &&
           glint_transfer_mix(transfer, &z->model[beyond], g, sine_q30,
                              wave_q24,
                              compute_way_q30(z, z->side[side][g], beyond));
}

static int transfer_between(struct glint_transfer *transfer,
                            const struct glint_zoom_lens *zoom, int ghost,
                            int32_t sine_q30, int32_t wave_q24)
{
    const struct glint_zoom_lens *const z = zoom;
    const int32_t part_q30 = compute_part_q30(z, ghost);
    const int nearer = part_q30 >= TRANSFER_ONE_Q30 / 2;
    int lit[2];
    int alike;

    if (part_q30 <= 0 || part_q30 >= TRANSFER_ONE_Q30)
        return set_from_side(transfer, z, ghost, part_q30 > 0, sine_q30,
                             wave_q24);
    alike = is_alike(z, z->whole[ghost], sine_q30, wave_q24, lit);
    if (!lit[0] || !lit[1]) {
        const int side = lit[1];

        if (lit[side] && ghost < count_whole(&z->model[0]) &&
            extrapolate_ghost(transfer, z, ghost, side, sine_q30, wave_q24))
            return 1;
        if (!set_from_side(transfer, z, ghost, side, sine_q30, wave_q24))
            return 0;
        glint_blend_fade(transfer,
                         side ? part_q30 : TRANSFER_ONE_Q30 - part_q30);
        return 1;
    }
    if (!alike)
        return set_from_side(transfer, z, ghost, nearer, sine_q30, wave_q24);
    if (!set_from_side(transfer, z, ghost, 0, sine_q30, wave_q24))
        return 0;
    return glint_transfer_mix(transfer, get_model(z, ghost, 1),
                              z->place[1][ghost], sine_q30, wave_q24,
                              part_q30) ||
           !nearer || set_from_side(transfer, z, ghost, 1, sine_q30, wave_q24);
}

/* ------------------------------------------------------------------ opening */

void glint_zoom_set(struct glint_zoom_lens *zoom, int32_t along_q30)
{
    struct glint_zoom_lens *const z = zoom;
    int k = 0, end[2];

    along_q30 = along_q30 < 0                  ? 0
                : along_q30 > TRANSFER_ONE_Q30 ? TRANSFER_ONE_Q30
                                               : along_q30;
    while (k + 2 < z->n_models && along_q30 >= z->along_q30[k + 1])
        k++;
    z->now_q30 = along_q30;
    z->below = k;
    find_sides(z, end);
    for (int m = end[0]; m <= end[1]; m++)
        find_places(z, m);
    set_header(z);
}

enum glint_status glint_zoom_join(struct glint_zoom_lens *zoom,
                                  const struct glint_lens *model,
                                  const int32_t *along_q30, int n,
                                  const char **reason)
{
    struct glint_zoom_lens *const z = zoom;
    const char *wrong = NULL;

    if (n < 2 || n > GLINT_MAX_ZOOM_MODELS || along_q30[0] != 0 ||
        along_q30[n - 1] != TRANSFER_ONE_Q30)
        wrong = "a zoom's positions do not go from end to end";
    for (int k = 0; k < n && !wrong; k++) {
        z->model[k] = model[k];
        z->along_q30[k] = along_q30[k];
        z->has[k] = NULL;
        if (k && along_q30[k] <= along_q30[k - 1])
            wrong = "a zoom's positions do not rise";
        else if (k)
            wrong = check_pair(&model[0], &model[k]);
    }
    z->n_models = n;
    if (!wrong)
        wrong = list_ghosts(z);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_LENS;
    }
    z->header = *model[0].header;
    z->header.n_ghosts = (uint32_t)z->part_from[count_whole(&model[0])];
    z->header.n_parts = z->header.n_ghosts - (uint32_t)count_whole(&model[0]);
    z->header.n_systems = 0;
    z->transfer = transfer_between;
    z->lens = (struct glint_lens){&z->header, z->ghost, NULL, z};
    glint_zoom_set(z, 0);
    return GLINT_OK;
}

/* Records, for each model M of the file, which ghosts it has. */
static enum glint_status set_lacks(struct glint_zoom_lens *zoom,
                                   struct glint_blob *blob,
                                   const struct glint_zoom_model *m,
                                   const char **reason)
{
    const uint32_t words = ((uint32_t)count_whole(&zoom->model[0]) + 31) / 32;

    for (int k = 0; k < zoom->n_models; k++) {
        const int end = k == 0 || k == zoom->n_models - 1;

        if (!m[k].has_at)
            continue;
        zoom->has[k] =
            glint_blob_section(blob, m[k].has_at, words, sizeof(uint32_t));
        *reason = end ? "a zoom's first or last position lacks ghosts"
                      : "a list of ghosts lies outside the file";
        if (end || !zoom->has[k])
            return GLINT_E_LENS;
    }
    glint_zoom_set(zoom, 0);
    return GLINT_OK;
}

enum glint_status glint_zoom_open(struct glint_zoom_lens *zoom,
                                  const void *data, size_t bytes,
                                  const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_ZOOM_MAGIC, GLINT_ZOOM_VERSION, sizeof(struct glint_zoom_header)};
    const struct glint_zoom_header *const h = data;
    const struct glint_zoom_model *m;
    struct glint_blob blob;

    *reason = fault_text[glint_blob_open(&blob, &kind, data, bytes)];
    if (!*reason)
        *reason = fault_text[glint_blob_check_name(&blob)];
    if (*reason)
        return GLINT_E_LENS;
    m = glint_blob_section(&blob, h->model_at, h->n_models, sizeof *m);
    *reason = "a table lies outside the file";
    if (!m)
        return GLINT_E_LENS;
    *reason = "a zoom has fewer than 2 models or too many";
    if (h->n_models < 2 || h->n_models > GLINT_MAX_ZOOM_MODELS)
        return GLINT_E_LENS;
    for (uint32_t k = 0; k < h->n_models; k++) {
        const void *const at =
            glint_blob_section(&blob, m[k].at, m[k].bytes, 1);

        *reason = "a model lies outside the file";
        if (!at || glint_lens_open(&zoom->model[k], at, m[k].bytes, reason) !=
                       GLINT_OK)
            return GLINT_E_LENS;
        zoom->along_q30[k] = m[k].along_q30;
    }
    if (glint_zoom_join(zoom, zoom->model, zoom->along_q30, (int)h->n_models,
                        reason) != GLINT_OK)
        return GLINT_E_LENS;
    return set_lacks(zoom, &blob, m, reason);
}
