/* SPDX-License-Identifier: MIT */
#include "engine/setup/dirt.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/setup/degrees.h"
#include "engine/setup/setup.h"

enum { NODES = (1 << GLINT_DIRT_LOG2) + 1 };

/* ------------------------------------------------------------ transmission */

/* Returns the fraction of light that the mask transmits at (X, Y), stop radii,
 * interpolated between four pixels. */
static double interpolate_mask(const struct glint_iris *iris, double x,
                               double y)
{
    const double u = 0.5 * (x + 1) * iris->mask_width - 0.5;
    const double v = 0.5 * (1 - y) * iris->mask_height - 0.5;
    const double held_u = fmin(fmax(u, 0), iris->mask_width - 1);
    const double held_v = fmin(fmax(v, 0), iris->mask_height - 1);
    const int i = (int)fmin(held_u, iris->mask_width - 2);
    const int j = (int)fmin(held_v, iris->mask_height - 2);
    const uint8_t *at = iris->mask + (size_t)j * (size_t)iris->mask_width + i;
    const double s = held_u - i, t = held_v - j;
    const double high = at[0] + s * (at[1] - at[0]);

    at += iris->mask_width;
    return (high + t * (at[0] + s * (at[1] - at[0]) - high)) / 255;
}

/* Returns the fraction of light that dust and mask transmit at (X, Y), stop
 * radii. */
static double compute_dirt_transmission(const struct glint_dirt *d, double x,
                                        double y)
{
    const double u = x * d->cos_turn + y * d->sin_turn;
    const double v = y * d->cos_turn - x * d->sin_turn;
    const double light =
        d->dust.n ? glint_dust_compute_transmission(&d->dust, u, v) : 1;

    return d->iris.mask ? light * interpolate_mask(&d->iris, u, v) : light;
}

static double compute_stop_transmission(const struct glint_dirt *d, double x,
                                        double y)
{
    const double soft = d->iris.softness;
    double in;

    if (!(soft > 0))
        return compute_dirt_transmission(d, x, y);
    in = fmin(fmax(glint_iris_compute_edge_distance(&d->sides, x, y) / soft, 0),
              1);
    return in * in * (3 - 2 * in) * compute_dirt_transmission(d, x, y);
}

/* ------------------------------------------------------------------- table */

/* Returns the mean transmission of soft edge, dust and mask around node (I, J)
 * of the finest level. The mean is over a square as wide as the distance
 * between nodes. */
static double compute_mean_transmission_around_node(const struct glint_dirt *d,
                                                    int i, int j)
{
    enum { N = 2 };
    const double cell = 2.0 / (NODES - 1);
    double sum = 0;

    for (int k = 0; k < N * N; k++) {
        const int row = k / N;
        const double a = (k % N + 0.5) / N - 0.5, b = (row + 0.5) / N - 0.5;

        sum += compute_stop_transmission(d, (i + a) * cell - 1,
                                         (j + b) * cell - 1);
    }
    return sum / (N * N);
}

static void compute_finest_shade_level(struct glint_dirt *d)
{
    for (int j = 0; j < NODES; j++)
        for (int i = 0; i < NODES; i++)
            d->node_q15[j * NODES + i] = (uint16_t)lrint(
                compute_mean_transmission_around_node(d, i, j) * 32768);
}

static void set_mean_transmission(struct glint_dirt *d)
{
    enum { N = 400 };
    double sum = 0, mean;
    int n = 0;

    for (int k = 0; k < N * N; k++) {
        const int row = k / N;
        const double x = (2 * (k % N) + 1.0) / N - 1;
        const double y = (2 * row + 1.0) / N - 1;

        if (glint_iris_compute_edge_distance(&d->sides, x, y) < 0)
            continue;
        sum += compute_stop_transmission(d, x, y);
        n++;
    }
    mean = sum / n;
    d->mean = mean > 1e-4 ? mean : 1;
}

/* Computes mip level LEVEL of the transmission, with COARSER nodes per side,
 * from the next finer level FINER, with SIDE nodes per side. A node is the mean
 * of the 3 x 3 finer nodes around it, with weights 1/4, 1/2, 1/4 across and
 * down. */
static void downsample_shade_level(const uint16_t *finer, int side,
                                   uint16_t *level, int coarser)
{
    static const int weight[3] = {1, 2, 1};

    for (int j = 0; j < coarser; j++)
        for (int i = 0; i < coarser; i++) {
            int sum = 8;

            for (int k = 0; k < 9; k++) {
                const int x = 2 * i + k % 3 - 1, y = 2 * j + k / 3 - 1;
                const int at_x = x < 0 ? 0 : x >= side ? side - 1 : x;
                const int at_y = y < 0 ? 0 : y >= side ? side - 1 : y;

                sum +=
                    weight[k % 3] * weight[k / 3] * finer[at_y * side + at_x];
            }
            level[j * coarser + i] = (uint16_t)(sum >> 4);
        }
}

static size_t count_shade_table_nodes(void)
{
    size_t n = 0;

    for (int k = 0; k < GLINT_DIRT_LOG2; k++) {
        const size_t side = ((size_t)1 << (GLINT_DIRT_LOG2 - k)) + 1;

        n += side * side;
    }
    return n;
}

/* Returns the detail that a mip level lacks around a node: the max difference
 * between VALUE, the value of the node, and all finer levels. FINE: the next
 * finer level, with FINE_SIDE nodes per side, of which those up to REACH nodes
 * from (I, J) are compared. ROUGH: the detail that FINE lacks, or NULL if FINE
 * is the finest level. */
static int find_node_roughness(const uint16_t *fine, const uint8_t *rough,
                               int fine_side, int i, int j, int reach,
                               int value)
{
    int most = 0;

    for (int y = j - reach; y <= j + reach; y++)
        for (int x = i - reach; x <= i + reach; x++) {
            const int at = y * fine_side + x;
            int here;

            if (x < 0 || y < 0 || x >= fine_side || y >= fine_side)
                continue;
            here =
                (abs(fine[at] - value) + 127) / 128 + (rough ? rough[at] : 0);
            most = here > most ? here : most;
        }
    return most < 255 ? most : 255;
}

/* Returns a digest (FNV-1a) of the stop's sides and of the N nodes of the
 * finest level of D. It is never 0, as 0 means no dirt. */
static uint64_t compute_shade_digest(const struct glint_dirt *d, int n)
{
    uint64_t mark = UINT64_C(0xcbf29ce484222325);
    const int sides[3] = {d->sides.n, (int)lrint(d->sides.round * 0x1p20),
                          (int)lrint(d->cos_turn * 0x1p20)};

    for (int i = 0; i < 3; i++)
        mark = (mark ^ (uint32_t)sides[i]) * UINT64_C(0x100000001b3);
    for (int i = 0; i < n; i++)
        mark = (mark ^ d->node_q15[i]) * UINT64_C(0x100000001b3);
    return mark | 1;
}

static void make_shade_table(struct glint_dirt *d)
{
    uint16_t *light = d->node_q15;
    uint8_t *rough = d->rough_q8;
    int side = NODES;

    d->shade = (struct glint_shade){
        .method = &glint_shade_method,
        .log2 = d->dust.n || d->iris.mask ? GLINT_DIRT_LOG2 : 0};
    set_mean_transmission(d);
    /* Tables of dust or a mask also include the soft edge. */
    if (!d->shade.log2) {
        d->shade.soft_q16 = (int32_t)lrint(d->iris.softness * 65536);
        return;
    }
    compute_finest_shade_level(d);
    d->mark = compute_shade_digest(d, side * side);
    for (int i = 0; i < side * side; i++)
        rough[i] = (uint8_t)find_node_roughness(light, NULL, side, i % side,
                                                i / side, 1, light[i]);
    for (int k = 0; k < GLINT_DIRT_LOG2; k++) {
        const int n = side * side, coarser = side / 2 + 1;

        d->shade.level_q15[k] = light;
        d->shade.rough_q8[k] = rough;
        if (k + 1 == GLINT_DIRT_LOG2)
            break;
        downsample_shade_level(light, side, light + n, coarser);
        for (int i = 0; i < coarser * coarser; i++)
            rough[n + i] = (uint8_t)find_node_roughness(
                light, rough, side, 2 * (i % coarser), 2 * (i / coarser), 3,
                light[n + i]);
        light += n;
        rough += n;
        side = coarser;
    }
}

/* -------------------------------------------------------------------- iris */

static const char *check_iris_config(const struct glint_iris *i)
{
    if (!(i->roundness >= 0 && i->roundness <= 1))
        return "the roundness of blades must be 0 to 1";
    if (!(i->softness >= 0 && i->softness <= 1))
        return "the softness of the stop's edge must be 0 to 1 stop radii";
    if (!(i->dust >= 0 && i->dust <= 0.5))
        return "dust must cover 0 to 0.5 of the stop";
    if (i->mask && (i->mask_width < 2 || i->mask_height < 2))
        return "a mask must have at least 2 pixels per side";
    return NULL;
}

static bool has_iris_dirt(const struct glint_iris *i)
{
    return i->softness > 0 || i->dust > 0 || i->mask;
}

static struct glint_dirt *make_stop_dirt(const struct glint_setup *setup)
{
    struct glint_dirt *d = calloc(1, sizeof *d);

    if (!d)
        return NULL;
    d->iris = setup->iris;
    d->through = compute_stop_transmission;
    d->cos_turn = glint_cos_deg(setup->blade_rotation_deg);
    d->sin_turn = glint_sin_deg(setup->blade_rotation_deg);
    d->node_q15 = malloc(count_shade_table_nodes() * sizeof *d->node_q15);
    d->rough_q8 = malloc(count_shade_table_nodes() * sizeof *d->rough_q8);
    if (!d->node_q15 || !d->rough_q8) {
        glint_dirt_free(d);
        return NULL;
    }
    glint_iris_compute_sides(&d->sides, setup);
    glint_dust_generate_specks(&d->dust, setup->iris.dust,
                               setup->iris.dust_seed);
    make_shade_table(d);
    return d;
}

double glint_dirt_light(const struct glint_dirt *dirt, double x, double y)
{
    return dirt->through(dirt, x, y);
}

/* Multiplies the direct flux of SETUP by that through IRIS / that through its
 * own iris. */
static void scale_direct_flux_to_iris(struct glint_setup *setup,
                                      const struct glint_iris *iris)
{
    const struct glint_iris own = setup->iris;

    for (int i = 0; i < setup->n_wavelengths; i++) {
        const double *const falloff = setup->falloff[i];
        double before;

        setup->iris = own;
        before = glint_iris_compute_light_fraction(setup, falloff);
        setup->iris = *iris;
        setup->direct_flux[i] *=
            glint_iris_compute_light_fraction(setup, falloff) / before;
    }
}

enum glint_status glint_setup_iris(struct glint_setup *setup,
                                   const struct glint_iris *iris,
                                   struct glint_dirt **dirt,
                                   struct glint_error *error)
{
    const char *const wrong = check_iris_config(iris);

    *dirt = NULL;
    if (wrong) {
        snprintf(error->text, sizeof error->text, "%s", wrong);
        return GLINT_E_ARGUMENT;
    }
    scale_direct_flux_to_iris(setup, iris);
    setup->dirt = NULL;
    setup->clear = 1;
    if (has_iris_dirt(iris)) {
        *dirt = make_stop_dirt(setup);
        if (!*dirt) {
            snprintf(error->text, sizeof error->text, "not enough memory");
            return GLINT_E_MEMORY;
        }
        setup->dirt = *dirt;
        setup->clear = (*dirt)->mean;
    }
    return glint_setup_set_unit_flux(setup, "the lens", error);
}
