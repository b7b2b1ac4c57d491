/* SPDX-License-Identifier: MIT
 *
 * Combines the models of several zoom positions into one lens.
 *
 *   in   models of one lens, with the same surfaces, film and wavelengths
 *   out  a header interpolated between those of two positions, a list of the
 *        ghosts of all models, and interpolated bundles
 *
 * All models contain the same pairs of surfaces as ghosts, in the same order. A
 * ghost whose pupil has several separate regions has one additional part per
 * further region. The combined list has as many parts as the model with the
 * largest number of parts. A zoom position lies between two models, one on
 * either SIDE. If both models divide the pupil of a ghost in the same way at an
 * angle, their polynomials are mixed; otherwise the nearer model is drawn. If
 * the ghost has light in only one of them, that model is extrapolated using a
 * third model farther away, or the ghost is faded. */
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

static int count_ghosts_without_parts(const struct glint_lens *lens)
{
    return (int)(lens->header->n_ghosts - lens->header->n_parts);
}

/* Returns the number of additional parts of ghost G in model LENS. Advances
 * *NEXT, the index of the first part that has not been counted, by this
 * number. */
static int count_ghost_parts(const struct glint_lens *lens, int g,
                             uint32_t *next)
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

/* Lists the ghosts of all models and their parts. Returns an error text, or
 * NULL. */
static const char *list_all_ghosts(struct glint_zoom_lens *z)
{
    const int n = count_ghosts_without_parts(&z->model[0]);
    uint32_t next[GLINT_MAX_ZOOM_MODELS];
    int end = n;

    if (n >= GLINT_MAX_ZOOM_GHOSTS)
        return "the zoom model has more than 2047 ghosts: use a lens with "
               "fewer "
               "surfaces";
    for (int k = 0; k < z->n_models; k++)
        next[k] = (uint32_t)n;
    for (int g = 0; g < n; g++) {
        int most = 0;

        z->ghost[g] = (struct glint_model_ghost){z->model[0].ghost[g].i,
                                                 z->model[0].ghost[g].j, 0, 0};
        z->whole[g] = (int16_t)g;
        z->number[g] = 0;
        for (int k = 0; k < z->n_models; k++) {
            const int parts = count_ghost_parts(&z->model[k], g, &next[k]);

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
        return "the zoom model has more than 2047 ghosts and pupil regions of "
               "ghosts: use a lens with fewer surfaces";
    z->part_from[n] = (int16_t)end;
    for (int k = 0; k < z->n_models; k++)
        if (next[k] != z->model[k].header->n_ghosts)
            return "damaged zoom model: the pupil regions of ghosts are "
                   "unsorted";
    return NULL;
}

static int has_model_ghost(const struct glint_zoom_lens *z, int k, int g)
{
    return !z->has[k] || (z->has[k][g / 32] >> g % 32 & 1);
}

/* Finds for each ghost the nearest model on either side of the zoom position
 * that contains the ghost. END receives the first and the last of all these
 * models. */
static void find_neighbour_models(struct glint_zoom_lens *z, int end[2])
{
    end[0] = z->below;
    end[1] = z->below + 1;
    for (int g = 0; g < count_ghosts_without_parts(&z->model[0]); g++) {
        int below = z->below, above = z->below + 1;

        while (!has_model_ghost(z, below, g))
            below--;
        while (!has_model_ghost(z, above, g))
            above++;
        z->side[0][g] = (uint8_t)below;
        z->side[1][g] = (uint8_t)above;
        end[0] = below < end[0] ? below : end[0];
        end[1] = above > end[1] ? above : end[1];
    }
}

/* Sets the indices of ghost G and its parts in the model on SIDE (0 or 1). That
 * model has PARTS additional parts, from index AT on; the index of a part that
 * it lacks is -1. */
static void set_neighbour_indices(struct glint_zoom_lens *z, int side, int g,
                                  uint32_t at, int parts)
{
    z->place[side][g] = (int16_t)g;
    for (int e = z->part_from[g]; e < z->part_from[g + 1]; e++)
        z->place[side][e] = (int16_t)(z->number[e] <= parts ? (int)at++ : -1);
}

/* Sets the indices in model K of all ghosts and parts for which K is one of the
 * two neighbour models. */
static void find_model_indices(struct glint_zoom_lens *z, int k)
{
    const struct glint_lens *const m = &z->model[k];
    uint32_t next = (uint32_t)count_ghosts_without_parts(m);

    for (int g = 0; g < count_ghosts_without_parts(m); g++) {
        const uint32_t at = next;
        const int parts = count_ghost_parts(m, g, &next);

        for (int side = 0; side < 2; side++)
            if (z->side[side][g] == k)
                set_neighbour_indices(z, side, g, at, parts);
    }
}

/* ------------------------------------------------------------------- header */

/* Returns A (1 - PART_Q30) + B PART_Q30. */
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

/* Returns the zoom position on a scale on which model FROM is at 0 and model TO
 * at 1. The result is below 0 if FROM lies between the position and TO. */
static int32_t compute_zoom_position_q30(const struct glint_zoom_lens *z,
                                         int from, int to)
{
    const int64_t at_q30 = z->along_q30[from];

    return (int32_t)q_divide((z->now_q30 - at_q30) * TRANSFER_ONE_Q30,
                             z->along_q30[to] - at_q30);
}

static void interpolate_header(struct glint_zoom_lens *z)
{
    const struct glint_model_header *const a = z->model[z->below].header;
    const struct glint_model_header *const b = z->model[z->below + 1].header;
    struct glint_model_header *const h = &z->header;
    const int32_t part = compute_zoom_position_q30(z, z->below, z->below + 1);

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

static int are_reals_equal(struct glint_real a, struct glint_real b)
{
    return a.mantissa == b.mantissa && a.exponent == b.exponent;
}

/* Returns the reason why B cannot be another position of the zoom lens of A;
 * NULL if it can. */
static const char *check_zoom_positions(const struct glint_lens *a,
                                        const struct glint_lens *b)
{
    const struct glint_model_header *const h = a->header, *const g = b->header;

    if (h->basis != GLINT_BASIS_AUTO || g->basis != GLINT_BASIS_AUTO)
        return "a zoom's models must be of round lenses (basis auto)";
    if (h->n_surfaces != g->n_surfaces ||
        count_ghosts_without_parts(a) != count_ghosts_without_parts(b))
        return "the models of a zoom must all be of one lens";
    if (!are_reals_equal(h->film_width_mm, g->film_width_mm) ||
        !are_reals_equal(h->film_height_mm, g->film_height_mm) ||
        !are_reals_equal(h->field_mm, g->field_mm) ||
        h->wave_lo_q24 != g->wave_lo_q24 || h->wave_hi_q24 != g->wave_hi_q24 ||
        h->sine_hi_q30 != g->sine_hi_q30)
        return "the models of a zoom must have equal film, field, wavelength "
               "band and max angle";
    for (int k = 0; k < count_ghosts_without_parts(a); k++)
        if (a->ghost[k].i != b->ghost[k].i || a->ghost[k].j != b->ghost[k].j)
            return "the models of a zoom must have the same ghosts";
    return NULL;
}

/* ---------------------------------------------------------------- transfers */

/* Returns the model on SIDE (0 or 1) that contains ghost or part E. */
static const struct glint_lens *
get_neighbour_model(const struct glint_zoom_lens *z, int e, int side)
{
    return &z->model[z->side[side][z->whole[e]]];
}

/* Returns the current zoom position as a fraction of the way between the two
 * nearest models that contain GHOST: 0 at the lower one, 1 at the upper one. */
static int32_t compute_mix_fraction_q30(const struct glint_zoom_lens *z,
                                        int ghost)
{
    const int g = z->whole[ghost];

    return compute_zoom_position_q30(z, z->side[0][g], z->side[1][g]);
}

/* Returns the annulus (pupil ring, struct glint_model_system) of ghost or part
 * E in the model on SIDE at this angle and wavelength; -1 if no light passes
 * there. */
static int find_system_annulus(const struct glint_zoom_lens *z, int e, int side,
                               int32_t sine_q30, int32_t wave_q24)
{
    const int at = z->place[side][e];
    const struct glint_model_system *const s =
        at < 0 ? NULL
               : glint_transfer_find_system(get_neighbour_model(z, e, side), at,
                                            sine_q30, wave_q24);

    return s ? s->annulus : -1;
}

/* Returns whether the models on both sides divide the pupil of ghost G in the
 * same way. Sets LIT[side] to whether light passes any part of the pupil in
 * that side's model. */
static int is_pupil_divided_alike(const struct glint_zoom_lens *z, int g,
                                  int32_t sine_q30, int32_t wave_q24,
                                  int lit[2])
{
    int alike = 1;

    lit[0] = lit[1] = 0;
    for (int q = z->part_from[g] - 1; q < z->part_from[g + 1]; q++) {
        const int e = q < z->part_from[g] ? g : q;
        const int a = find_system_annulus(z, e, 0, sine_q30, wave_q24);
        const int b = find_system_annulus(z, e, 1, sine_q30, wave_q24);

        lit[0] |= a >= 0;
        lit[1] |= b >= 0;
        alike &= a == b;
    }
    return alike;
}

/* Sets TRANSFER to ghost or part E of the model on SIDE, without mixing.
 * Returns whether light passes. */
static int set_transfer_from_neighbour(struct glint_transfer *transfer,
                                       const struct glint_zoom_lens *z, int e,
                                       int side, int32_t sine_q30,
                                       int32_t wave_q24)
{
    return z->place[side][e] >= 0 &&
           glint_transfer_init(transfer, get_neighbour_model(z, e, side),
                               z->place[side][e], sine_q30, wave_q24);
}

/* Finds a model for extrapolation. Let S be the neighbour model on SIDE.
 * Returns the index of the nearest model, on the far side of S, that contains
 * ghost G. Its distance from S must be at least the distance between both
 * neighbour models, so that extrapolation at most doubles a distance. Returns
 * -1 if there is no such model. */
static int find_model_behind_neighbour(const struct glint_zoom_lens *z, int g,
                                       int side)
{
    const int from = z->side[side][g], step = side ? 1 : -1;
    const int64_t gap =
        (int64_t)z->along_q30[z->side[1][g]] - z->along_q30[z->side[0][g]];

    for (int k = from + step; k >= 0 && k < z->n_models; k += step)
        if (has_model_ghost(z, k, g) &&
            step * ((int64_t)z->along_q30[k] - z->along_q30[from]) >= gap)
            return k;
    return -1;
}

/* Sets TRANSFER to ghost G, extrapolated from the model on SIDE and a model
 * farther away. G must have light only in the model on SIDE. Returns 0 if G has
 * additional parts with light there, or no other model is suitable. */
static int extrapolate_ghost_transfer(struct glint_transfer *transfer,
                                      const struct glint_zoom_lens *z, int g,
                                      int side, int32_t sine_q30,
                                      int32_t wave_q24)
{
    const int beyond = find_model_behind_neighbour(z, g, side);
    const struct glint_model_system *there;

    for (int q = z->part_from[g]; q < z->part_from[g + 1]; q++)
        if (find_system_annulus(z, q, side, sine_q30, wave_q24) >= 0)
            return 0;
    if (beyond < 0)
        return 0;
    there =
        glint_transfer_find_system(&z->model[beyond], g, sine_q30, wave_q24);
    if (!there || there->annulus != 0 ||
        find_system_annulus(z, g, side, sine_q30, wave_q24) != 0)
        return 0;
    return set_transfer_from_neighbour(transfer, z, g, side, sine_q30,
                                       wave_q24) &&
           glint_transfer_mix_position(
               transfer, &z->model[beyond], g, sine_q30, wave_q24,
               compute_zoom_position_q30(z, z->side[side][g], beyond));
}

static int interpolate_transfer(struct glint_transfer *transfer,
                                const struct glint_zoom_lens *zoom, int ghost,
                                int32_t sine_q30, int32_t wave_q24)
{
    const struct glint_zoom_lens *const z = zoom;
    const int32_t part_q30 = compute_mix_fraction_q30(z, ghost);
    const int nearer = part_q30 >= TRANSFER_ONE_Q30 / 2;
    int lit[2];
    int alike;

    if (part_q30 <= 0 || part_q30 >= TRANSFER_ONE_Q30)
        return set_transfer_from_neighbour(transfer, z, ghost, part_q30 > 0,
                                           sine_q30, wave_q24);
    alike = is_pupil_divided_alike(z, z->whole[ghost], sine_q30, wave_q24, lit);
    if (!lit[0] || !lit[1]) {
        const int side = lit[1];

        if (lit[side] && ghost < count_ghosts_without_parts(&z->model[0]) &&
            extrapolate_ghost_transfer(transfer, z, ghost, side, sine_q30,
                                       wave_q24))
            return 1;
        if (!set_transfer_from_neighbour(transfer, z, ghost, side, sine_q30,
                                         wave_q24))
            return 0;
        glint_blend_scale_energy(transfer,
                                 side ? part_q30 : TRANSFER_ONE_Q30 - part_q30);
        return 1;
    }
    if (!alike)
        return set_transfer_from_neighbour(transfer, z, ghost, nearer, sine_q30,
                                           wave_q24);
    if (!set_transfer_from_neighbour(transfer, z, ghost, 0, sine_q30, wave_q24))
        return 0;
    return glint_transfer_mix_position(
               transfer, get_neighbour_model(z, ghost, 1), z->place[1][ghost],
               sine_q30, wave_q24, part_q30) ||
           !nearer ||
           set_transfer_from_neighbour(transfer, z, ghost, 1, sine_q30,
                                       wave_q24);
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
    find_neighbour_models(z, end);
    for (int m = end[0]; m <= end[1]; m++)
        find_model_indices(z, m);
    interpolate_header(z);
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
        wrong = "the positions of a zoom's models must begin at 0 and end at 1";
    for (int k = 0; k < n && !wrong; k++) {
        z->model[k] = model[k];
        z->along_q30[k] = along_q30[k];
        z->has[k] = NULL;
        if (k && along_q30[k] <= along_q30[k - 1])
            wrong = "the positions of a zoom's models must ascend";
        else if (k)
            wrong = check_zoom_positions(&model[0], &model[k]);
    }
    z->n_models = n;
    if (!wrong)
        wrong = list_all_ghosts(z);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_LENS;
    }
    z->header = *model[0].header;
    z->header.n_ghosts =
        (uint32_t)z->part_from[count_ghosts_without_parts(&model[0])];
    z->header.n_parts =
        z->header.n_ghosts - (uint32_t)count_ghosts_without_parts(&model[0]);
    z->header.n_systems = 0;
    z->transfer = interpolate_transfer;
    z->lens = (struct glint_lens){&z->header, z->ghost, NULL, z};
    glint_zoom_set(z, 0);
    return GLINT_OK;
}

/* Records which ghosts each model of the file contains, and sets the first
 * position. M: table of models in the file. */
static enum glint_status record_missing_ghosts(struct glint_zoom_lens *zoom,
                                               struct glint_blob *blob,
                                               const struct glint_zoom_model *m,
                                               const char **reason)
{
    const uint32_t words =
        ((uint32_t)count_ghosts_without_parts(&zoom->model[0]) + 31) / 32;

    for (int k = 0; k < zoom->n_models; k++) {
        const int end = k == 0 || k == zoom->n_models - 1;

        if (!m[k].has_at)
            continue;
        zoom->has[k] =
            glint_blob_find_section(blob, m[k].has_at, words, sizeof(uint32_t));
        *reason =
            end ? "damaged zoom model: its first or last position lacks ghosts"
                : "damaged zoom model: a list of ghosts lies outside the file";
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
    m = glint_blob_find_section(&blob, h->model_at, h->n_models, sizeof *m);
    *reason = "damaged zoom model: a table lies outside the file";
    if (!m)
        return GLINT_E_LENS;
    *reason = "damaged zoom model: it has fewer than 2 models or too many";
    if (h->n_models < 2 || h->n_models > GLINT_MAX_ZOOM_MODELS)
        return GLINT_E_LENS;
    for (uint32_t k = 0; k < h->n_models; k++) {
        const void *const at =
            glint_blob_find_section(&blob, m[k].at, m[k].bytes, 1);

        *reason = "damaged zoom model: a model lies outside the file";
        if (!at || glint_lens_open(&zoom->model[k], at, m[k].bytes, reason) !=
                       GLINT_OK)
            return GLINT_E_LENS;
        zoom->along_q30[k] = m[k].along_q30;
    }
    if (glint_zoom_join(zoom, zoom->model, zoom->along_q30, (int)h->n_models,
                        reason) != GLINT_OK)
        return GLINT_E_LENS;
    return record_missing_ghosts(zoom, &blob, m, reason);
}
