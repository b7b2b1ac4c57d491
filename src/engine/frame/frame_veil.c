/* SPDX-License-Identifier: MIT */
#include "engine/frame/frame_veil.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/block.h"
#include "engine/frame/frame_parts.h"

/* The kernel of veiling glare, a sum of Gaussians. Half of the glare is uniform
 * over the picture, like light that lens barrel and camera body scatter. Sigmas
 * are fractions of the picture's diagonal; a sigma of 0 means uniform. */
static const struct {
    double sigma, share;
} glare[] = {{0.08, 0.25}, {0.25, 0.25}, {0, 0.5}};

/* The kernel of haze: Gaussians with these sigmas, degrees, each with a quarter
 * of the light, so that the light falls with the square of the angle, as glare
 * in the eye does from 1 to 30 degrees [Vos, Disability glare, CIE Journal
 * 3(2), 1984]. The haze of plastics is defined as the fraction scattered by
 * more than 2.5 degrees (ASTM D1003), which is 0.7 of the light of this kernel.
 * */
static const double haze_deg[] = {1.25, 2.5, 5, 10};

/* min sigma of a Gaussian, in cells of the coarse picture that is blurred; with
 * a smaller sigma the cells would be visible */
static const double least_sigma = 1;

enum {
    N_GLARE = sizeof glare / sizeof *glare,
    N_HAZE = sizeof haze_deg / sizeof *haze_deg
};

bool glint_frame_has_veil(const struct glint_frame *f)
{
    return f->veil.glare > 0 || f->veil.haze > 0 || f->veil.front;
}

static bool are_front_optics_equal(const struct glint_front_optics *a,
                                   const struct glint_front_optics *b)
{
    return a->tangent == b->tangent && a->z == b->z && a->radius == b->radius &&
           a->width == b->width && a->height == b->height &&
           a->n_blades == b->n_blades && a->rotation_deg == b->rotation_deg &&
           a->roundness == b->roundness;
}

/* Computes the table of dirt on the front element if the dirt or the frame's
 * optics have changed. */
static enum glint_status update_front_table(struct glint_frame *f)
{
    struct glint_frame_veil *v = &f->veil;
    struct glint_front_optics optics;

    if (!v->front)
        return GLINT_OK;
    v->front->method->optics(&optics, f->setup, f->lens, &f->view);
    if (v->table && v->table_of == v->front &&
        are_front_optics_equal(&optics, &v->table_for))
        return GLINT_OK;
    free(v->table);
    v->table_of = v->front;
    v->table_for = optics;
    return v->front->method->table(&v->table, v->front, &optics, f->setup);
}

enum glint_status glint_frame_veil_allocate(struct glint_frame *f)
{
    struct glint_frame_veil *v = &f->veil;
    const struct glint_veil_config cfg = {
        .n_workers = glint_workers_count(f->cfg.workers),
        .width = f->view.width,
        .height = f->view.height,
        .has_front = v->front != NULL};
    const enum glint_status status = update_front_table(f);
    size_t bytes;
    void *block;

    if (status != GLINT_OK || !glint_frame_has_veil(f) ||
        (v->veil && (v->has_front || !v->front)))
        return status;
    free(v->mem);
    v->veil = NULL;
    bytes = glint_veil_count_bytes(&cfg);
    block = glint_block_allocate_aligned(bytes, &v->mem);
    if (!block)
        return GLINT_E_MEMORY;
    v->bytes = bytes;
    v->has_front = v->front != NULL;
    return glint_veil_init(&v->veil, &cfg, block, bytes);
}

void glint_frame_veil_finish(struct glint_frame_veil *veil)
{
    free(veil->mem);
    free(veil->table);
}

enum glint_status glint_frame_veil_read_picture(struct glint_frame *f,
                                                const struct glint_image *image,
                                                double white)
{
    enum glint_status status;

    if (!glint_frame_has_veil(f))
        return GLINT_OK;
    status = glint_frame_veil_allocate(f);
    if (status == GLINT_OK)
        glint_veil_read_picture(f->veil.veil, image, glint_real_of(white),
                                f->cfg.workers);
    f->veil.has_look = status == GLINT_OK;
    f->veil.is_set = false;
    return status;
}

/* ------------------------------------------------------------------ kernels */

/* Sets TABLE to a Gaussian kernel of SIGMA cells over N cells and their mirror
 * images (struct glint_veil_spread). If SIGMA is 0, the kernel is uniform. */
static void compute_gaussian_table(int32_t *table_q30, int n, double sigma)
{
    double at[GLINT_VEIL_CELLS + 1], sum = 0;
    int32_t rest = INT32_C(1) << 30;

    for (int d = 0; d <= n; d++) {
        at[d] = sigma > 0 ? 0 : 1;
        for (int k = -8; k <= 8 && sigma > 0; k++) {
            const double t = (d + 2.0 * n * k) / sigma;

            at[d] += exp(-0.5 * t * t);
        }
        sum += (d == 0 || d == n ? 1 : 2) * at[d];
    }
    for (int d = n; d > 0; d--) {
        table_q30[d] = (int32_t)lrint(at[d] / sum * 0x1p30);
        rest -= (d == n ? 1 : 2) * table_q30[d];
    }
    table_q30[0] = rest; /* This makes the sum of the weights exactly 1. */
}

/* Returns a Gaussian kernel of SIGMA pixels that scatters the fraction SHARE of
 * all light. If SIGMA is 0, the kernel is uniform. */
static struct glint_veil_spread
make_gaussian_spread(const struct glint_frame *f, double sigma, double share)
{
    struct glint_veil_spread s;
    const double size[2] = {f->view.width, f->view.height};
    int cells[2];

    glint_veil_count_cells(f->view.width, f->view.height, cells);
    for (int k = 0; k < 2; k++) {
        const double in_cells = fmax(sigma * cells[k] / size[k], least_sigma);
        /* a Gaussian wider than this is treated as uniform */
        const bool is_even = !(sigma > 0) || in_cells > 2 * cells[k];

        compute_gaussian_table(k ? s.down_q30 : s.across_q30, cells[k],
                               is_even ? 0 : in_cells);
    }
    s.share = glint_real_of(share * cells[0] * cells[1] / (size[0] * size[1]));
    return s;
}

/* Returns the mean fraction of light that dirt on the front element scatters; 0
 * without dirt. */
static double get_front_scattered_fraction(const struct glint_frame_veil *v)
{
    return v->front && v->table ? v->table->mean : 0;
}

/* Returns all light divided by the light that glare, haze and dirt do not
 * scatter. */
static double compute_total_over_direct_light(const struct glint_frame_veil *v)
{
    return 1 / (1 - fmin(v->glare + v->haze + get_front_scattered_fraction(v),
                         GLINT_MOST_VEIL));
}

/* Sets SPREADS to the kernels of haze, which together scatter the fraction
 * SHARE of all light. Returns the number of kernels. */
static int set_haze_spreads(const struct glint_frame *f, double share,
                            struct glint_veil_spread spreads[N_HAZE])
{
    for (int k = 0; k < N_HAZE; k++)
        spreads[k] =
            make_gaussian_spread(f,
                                 glint_frame_compute_pixels_per_tangent(f) *
                                     tan(haze_deg[k] * GLINT_PI / 180),
                                 share / N_HAZE);
    return N_HAZE;
}

/* Sets SPREADS to the kernels of glare and haze of the frame. Returns the
 * number of kernels. */
static int set_veil_spreads(const struct glint_frame *f,
                            struct glint_veil_spread spreads[N_GLARE + N_HAZE])
{
    const struct glint_frame_veil *v = &f->veil;
    const double over = compute_total_over_direct_light(v);
    int n = 0;

    for (int k = 0; k < N_GLARE && v->glare > 0; k++)
        spreads[n++] = make_gaussian_spread(
            f, glare[k].sigma * hypot(f->view.width, f->view.height),
            v->glare * over * glare[k].share);
    if (v->haze > 0)
        n += set_haze_spreads(f, v->haze * over, spreads + n);
    return n;
}

/* Computes the light that dirt on the front element scatters to a pixel whose
 * beam it covers most. Does nothing without dirt. */
static void spread_front_dirt_light(const struct glint_frame *f)
{
    const struct glint_frame_veil *v = &f->veil;
    struct glint_veil_spread spreads[N_HAZE];

    if (v->front)
        v->front->method->spread(
            v->veil, &v->table->front, spreads,
            set_haze_spreads(
                f, v->table->most * compute_total_over_direct_light(v),
                spreads));
}

/* sigma, as a fraction of the picture's diagonal, of the Gaussian that replaces
 * the uniform part of the glare for off-screen lamps */
static const double even_sigma = 0.5;

/* Returns the value of a Gaussian at distance FAR divided by its value at the
 * centre. */
static double compute_gaussian_falloff(double far, double sigma)
{
    return exp(-0.5 * far * far / (sigma * sigma));
}

/* Returns the veil of a lamp FAR pixels off-screen / veil of the same lamp at
 * the border of the picture. Each kernel falls off by its own Gaussian. */
static double compute_offscreen_fraction(const struct glint_frame *f,
                                         double far)
{
    const struct glint_frame_veil *v = &f->veil;
    const double haze = v->haze + get_front_scattered_fraction(v);
    const double diagonal = hypot(f->view.width, f->view.height);
    double sum = 0;

    for (int k = 0; k < N_GLARE; k++)
        sum += v->glare * glare[k].share *
               compute_gaussian_falloff(far, diagonal * (glare[k].sigma > 0
                                                             ? glare[k].sigma
                                                             : even_sigma));
    for (int k = 0; k < N_HAZE; k++)
        sum += haze / N_HAZE *
               compute_gaussian_falloff(
                   far, glint_frame_compute_pixels_per_tangent(f) *
                            tan(haze_deg[k] * GLINT_PI / 180));
    return sum / fmax(v->glare + haze, 1e-9);
}

/* cost that dirt on the front element adds to a pixel / cost of a pixel without
 * dirt */
static const double front_pixels = 0.4;

/* The unit is the cost of drawing a pixel. To scatter light from one cell to
 * another costs 1 / SPREADING of it. */
double glint_frame_veil_estimate_cost_px(const struct glint_frame *f)
{
    const double spreading = 14;
    const int n = (f->veil.glare > 0 ? N_GLARE : 0) +
                  (f->veil.haze > 0 ? N_HAZE : 0) +
                  (f->veil.front ? N_HAZE : 0);
    const double rows = f->veil.front ? 1 + front_pixels : 1;
    int cells[2];

    if (!glint_frame_has_veil(f))
        return 0;
    glint_veil_count_cells(f->view.width, f->view.height, cells);
    return rows * f->view.width * f->view.height +
           3. * n * cells[0] * cells[1] * (cells[0] + cells[1]) / spreading;
}

static void add_lamp_to_veil(struct glint_frame *f,
                             const struct glint_lamp *lamp, double power)
{
    const double most = fmax(lamp->rgb[0], fmax(lamp->rgb[1], lamp->rgb[2]));
    int32_t rgb_q14[3];
    double x, y, at_x, at_y, far;

    glint_view_to_pixel(&f->view, f->setup->optics.focal_mm, lamp, &x, &y);
    at_x = fmin(fmax(x, 0), f->view.width);
    at_y = fmin(fmax(y, 0), f->view.height);
    far = hypot(x - at_x, y - at_y);
    if (!isfinite(far) || !(power * most > 0))
        return;
    if (far > 0)
        power *= compute_offscreen_fraction(f, far);
    if (!(power * most > 1e-9))
        return;
    for (int c = 0; c < 3; c++)
        rgb_q14[c] = (int32_t)lrint(fmax(lamp->rgb[c], 0) / most * 16384);
    glint_veil_add_lamp(f->veil.veil, (int32_t)lrint(256 * at_x),
                        (int32_t)lrint(256 * at_y), glint_real_of(power * most),
                        rgb_q14);
}

enum glint_status glint_frame_veil_set_light(struct glint_frame *f,
                                             const struct glint_lamp *lamps,
                                             int n,
                                             const struct glint_image *image)
{
    struct glint_frame_veil *v = &f->veil;
    struct glint_veil_spread spreads[N_GLARE + N_HAZE];
    enum glint_status status = GLINT_OK;

    v->is_set = false;
    if (!glint_frame_has_veil(f) || f->dials.flags & GLINT_DIAL_NO_VEIL)
        return GLINT_OK;
    status = glint_frame_veil_allocate(f);
    if (status == GLINT_OK && !v->has_look)
        status = glint_frame_veil_read_picture(f, image, 1);
    v->has_look = false;
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < n; i++)
        add_lamp_to_veil(f, &lamps[i],
                         f->known ? f->known[i].excess : lamps[i].power);
    glint_veil_spread_light(v->veil, spreads, set_veil_spreads(f, spreads));
    spread_front_dirt_light(f);
    v->is_set = true;
    return GLINT_OK;
}

void glint_frame_veil_add_to_rgb(struct glint_frame *f, double times,
                                 int32_t *linear_q20, float *rgb)
{
    const struct glint_image layer = glint_image_over(
        linear_q20, GLINT_LINEAR_Q20, f->view.width, f->view.height);
    const size_t samples = 3 * (size_t)layer.width * (size_t)layer.height;

    if (!glint_frame_has_veil(f) || !f->veil.is_set)
        return;
    memset(linear_q20, 0, samples * sizeof *linear_q20);
    glint_veil_draw_alone(f->veil.veil, f->memory.flare, &layer);
    for (size_t i = 0; i < samples; i++)
        rgb[i] += (float)(linear_q20[i] * 0x1p-20 * times);
}

enum glint_status glint_frame_veil_draw_alone(struct glint_frame *f,
                                              const struct glint_lamp *lamps,
                                              int n, double gain,
                                              int32_t *linear_q20, float *rgb)
{
    const struct glint_image black = glint_image_over(
        linear_q20, GLINT_LINEAR_Q20, f->view.width, f->view.height);
    const size_t samples = 3 * (size_t)black.width * (size_t)black.height;
    enum glint_status status;

    memset(linear_q20, 0, samples * sizeof *linear_q20);
    status = glint_frame_veil_set_light(f, lamps, n, &black);
    if (status == GLINT_OK)
        glint_frame_veil_add_to_rgb(
            f, f->veil.alone_gain > 0 ? f->veil.alone_gain : gain, linear_q20,
            rgb);
    return status;
}
