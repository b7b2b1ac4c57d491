/* SPDX-License-Identifier: MIT
 *
 * Computes the rows of the scattering matrix of a heterogeneous translucent
 * slab, whose texels have different materials.
 *
 * Diffusion modes on a lattice of texels describe the exchange of light between
 * materials. Eight modes on this lattice are inaccurate at offsets below two or
 * three texels. A correction is added there: the closed form minus the same
 * modes, both for a homogeneous medium, averaged over the materials of both
 * texels. An entry is the mean of both directions, which are equal in a real
 * translucent medium (reciprocity).
 */
#include "bake/translucent/slab.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------- blocks */

/* Computes the blocks near the diagonal of the inverse of a grid's matrix.
 *
 * S_j are the diagonal blocks after elimination from the top. E_j are the
 * couplings of block j to the next block. G(j, l) are the blocks of the
 * inverse. With T_j = S_j^-1 E_j, each row of blocks follows from the row below
 * it: G(j, l) = T_j G(j + 1, l) for l > j, and G(j, j) = S_j^-1 + T_j G(j + 1,
 * j). Only blocks up to REACH from the diagonal are stored. Entries of T
 * decrease exponentially away from its diagonal. Entries below SMALL times the
 * largest are dropped. */
#define SMALL 1e-11

/* A symmetric positive definite matrix of side x side blocks of side x side
 * entries: a grid of nodes, each coupled to four neighbours. Diagonal blocks
 * are tridiagonal; the blocks next to them are diagonal. */
struct blocks {
    int side;          /* number of nodes per block, and number of blocks */
    const double *own; /* [side][side]: the diagonal, block by block */
    /* coupling of a node with the next node of its block, >= 0 */
    const double *right;
    /* coupling of a node with the same node of the next block, >= 0 */
    const double *down;
};

/* Receives block (J, L) of the inverse, L = J .. J + reach: [side][side]. */
typedef void blocks_fn(void *ctx, int j, int l, const double *block);

struct inverse {
    const struct blocks *b;
    int reach;
    double *eliminated; /* [blocks][side][side]: S_j^-1 of each block */
    double *t, *scratch;
    /* the blocks G(j, j + i), i = 0 .. reach, of the current block row j */
    double **ring;
    /* [side]: range of the non-negligible entries of each row of T */
    int *from, *to;
};

/* Replaces the upper half of A[N][N] by U of its Cholesky factorisation A = U'
 * U. */
static void factorise_cholesky(double *a, int n)
{
    for (int k = 0; k < n; k++) {
        double *row = a + (size_t)k * (size_t)n;
        const double root = sqrt(row[k]);

        for (int m = k; m < n; m++)
            row[m] /= root;
        for (int i = k + 1; i < n; i++) {
            double *other = a + (size_t)i * (size_t)n;

            for (int m = i; m < n; m++)
                other[m] -= row[i] * row[m];
        }
    }
}

/* Replaces A[N][N], symmetric and positive definite, by its inverse. TO is
 * scratch of the same size. */
static void invert_definite_matrix(double *a, double *to, int n)
{
    factorise_cholesky(a, n);
    /* computes U'^-1 in TO, row by row from the top */
    memset(to, 0, (size_t)n * (size_t)n * sizeof *to);
    for (int i = 0; i < n; i++) {
        double *row = to + (size_t)i * (size_t)n;

        for (int k = 0; k < i; k++) {
            const double share = a[k * n + i];
            const double *other = to + (size_t)k * (size_t)n;

            for (int m = 0; m <= k; m++)
                row[m] -= share * other[m];
        }
        row[i] = 1;
        for (int m = 0; m <= i; m++)
            row[m] /= a[i * n + i];
    }
    memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
    for (int k = 0; k < n; k++) {
        const double *row = to + (size_t)k * (size_t)n;

        for (int i = 0; i <= k; i++)
            for (int m = 0; m <= i; m++)
                a[i * n + m] += row[i] * row[m];
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            a[k * n + i] = a[i * n + k];
}

static double *get_eliminated_block(const struct inverse *v, int j)
{
    const size_t n = (size_t)v->b->side;

    return v->eliminated + (size_t)j * n * n;
}

/* Computes S_j^-1 for block J from that of block J - 1. */
static void eliminate_matrix_block(struct inverse *v, int j)
{
    const struct blocks *b = v->b;
    const int n = b->side;
    const double *own = b->own + j * n, *right = b->right + j * n;
    double *s = get_eliminated_block(v, j);

    memset(s, 0, (size_t)n * (size_t)n * sizeof *s);
    if (j > 0) {
        const double *above = get_eliminated_block(v, j - 1),
                     *e = b->down + (j - 1) * n;

        for (int i = 0; i < n; i++)
            for (int k = i; k < n; k++)
                s[i * n + k] = -e[i] * above[i * n + k] * e[k];
    }
    for (int i = 0; i < n; i++) {
        s[i * n + i] += own[i];
        if (i < n - 1)
            s[i * n + i + 1] -= right[i];
    }
    invert_definite_matrix(s, v->scratch, n);
}

/* Computes T of block row J, and the range of non-negligible entries of each
 * row of T. */
static void compute_transfer_block(struct inverse *v, int j)
{
    const int n = v->b->side;
    const double *s = get_eliminated_block(v, j), *e = v->b->down + j * n;
    double most = 0;

    for (int i = 0; i < n * n; i++) {
        v->t[i] = s[i] * e[i % n];
        most = fmax(most, v->t[i]);
    }
    for (int i = 0; i < n; i++) {
        const double *row = v->t + (size_t)i * (size_t)n;

        v->from[i] = 0;
        v->to[i] = n;
        while (v->from[i] < n - 1 && row[v->from[i]] < SMALL * most)
            v->from[i]++;
        while (v->to[i] > v->from[i] && row[v->to[i] - 1] < SMALL * most)
            v->to[i]--;
    }
}

/* Adds the product T G of the current transfer block T and block G to TO. */
static void add_transfer_product(const struct inverse *v, const double *g,
                                 double *to)
{
    const int n = v->b->side;

    for (int i = 0; i < n; i++) {
        double *sum = to + (size_t)i * (size_t)n;

        for (int k = v->from[i]; k < v->to[i]; k++) {
            const double share = v->t[i * n + k];
            const double *row = g + (size_t)k * (size_t)n;

            for (int m = 0; m < n; m++)
                sum[m] += share * row[m];
        }
    }
}

/* Sets TO to G(j, j). BELOW: G(j, j + 1), or NULL for the last block row. */
static void compute_diagonal_block(const struct inverse *v, int j,
                                   const double *below, double *to)
{
    const int n = v->b->side;

    memcpy(to, get_eliminated_block(v, j), (size_t)n * (size_t)n * sizeof *to);
    if (!below)
        return;
    /* G(j + 1, j) is the transpose of BELOW */
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            v->scratch[i * n + k] = below[k * n + i];
    add_transfer_product(v, v->scratch, to);
}

/* Computes the blocks of block row J from those of row J + 1. */
static void compute_row_blocks(struct inverse *v, int j)
{
    const int below = v->b->side - 1 - j;
    const int kept = below < v->reach ? below : v->reach;
    const size_t block = (size_t)v->b->side * (size_t)v->b->side;
    double *free_block = v->ring[v->reach];

    compute_transfer_block(v, j);
    for (int i = 0; i < kept; i++) {
        double *to = v->scratch;

        memset(to, 0, block * sizeof *to);
        add_transfer_product(v, v->ring[i], to);
        v->scratch = v->ring[i];
        v->ring[i] = to;
    }
    memmove(v->ring + 1, v->ring, (size_t)v->reach * sizeof *v->ring);
    v->ring[0] = free_block;
    compute_diagonal_block(v, j, kept ? v->ring[1] : NULL, free_block);
}

static enum glint_status compute_inverse_blocks(struct inverse *v, int reach,
                                                const struct glint_watch *watch,
                                                blocks_fn *add_block, void *ctx)
{
    const int n = v->b->side;
    /* Estimated fraction of the time that the elimination needs. By
     * measurement, a row of reach + 1 blocks costs as much as (reach + 1) / 2
     * eliminations. */
    const double first = 2.0 / (reach + 2.0);

    for (int j = 0; j < n; j++) {
        eliminate_matrix_block(v, j);
        if (glint_watch_report_progress(watch, first * (j + 1) / n))
            return GLINT_E_CLOSED;
    }
    for (int j = n - 1; j >= 0; j--) {
        const int done = n - j;

        compute_row_blocks(v, j);
        for (int l = j; l < n && l <= j + reach; l++)
            add_block(ctx, j, l, v->ring[l - j]);
        if (glint_watch_report_progress(watch,
                                        first + (1.0 - first) * done / n))
            return GLINT_E_CLOSED;
    }
    return GLINT_OK;
}

/* Calls ADD_BLOCK for each block of the inverse of BLOCKS that is at most REACH
 * blocks from the diagonal. Needs about side^3 doubles. May return
 * GLINT_E_MEMORY, or GLINT_E_CLOSED if the caller stops the work. */
static enum glint_status compute_inverse_band(const struct blocks *blocks,
                                              int reach,
                                              const struct glint_watch *watch,
                                              blocks_fn *add_block, void *ctx)
{
    const size_t n = (size_t)blocks->side, block = n * n;
    struct inverse v = {.b = blocks, .reach = reach > 0 ? reach : 1};
    const size_t in_ring = (size_t)v.reach + 1;
    double *memory = malloc((n + 2 + in_ring) * block * sizeof *memory);
    enum glint_status status = GLINT_E_MEMORY;

    v.ring = malloc(in_ring * sizeof *v.ring);
    v.from = malloc(2 * n * sizeof *v.from);
    if (memory && v.ring && v.from) {
        v.to = v.from + n;
        v.eliminated = memory;
        v.t = memory + n * block;
        v.scratch = v.t + block;
        for (size_t i = 0; i < in_ring; i++)
            v.ring[i] = v.scratch + (i + 1) * block;
        status = compute_inverse_blocks(&v, reach, watch, add_block, ctx);
    }
    free(memory);
    free(v.ring);
    free(v.from);
    return status;
}

/* ------------------------------------------------------------------ pattern */

enum { OCTAVES = 4 };

/* Returns a pseudo-random number, 0 .. 1, for the lattice point (X, Y). */
static double hash_lattice_point(uint32_t seed, int x, int y)
{
    uint32_t h = seed * UINT32_C(0x9e3779b1) ^
                 (uint32_t)x * UINT32_C(0x85ebca6b) ^
                 (uint32_t)y * UINT32_C(0xc2b2ae35);

    h = (h ^ h >> 15) * UINT32_C(0x2c1b3c6d);
    h = (h ^ h >> 12) * UINT32_C(0x297a2d39);
    return (h ^ h >> 15) / 4294967295.0;
}

static double interpolate_by_smoothstep(double t)
{
    return t * t * (3 - 2 * t);
}

/* Returns value noise, 0 .. 1, at (U, V) on a lattice of CELLS x CELLS cells. U
 * and V are 0 .. 1; the noise is periodic with period 1. */
static double compute_value_noise(uint32_t seed, int cells, double u, double v)
{
    const int x = (int)floor(u * cells), y = (int)floor(v * cells);
    const int right = (x + 1) % cells, below = (y + 1) % cells;
    const double s = interpolate_by_smoothstep(u * cells - x),
                 t = interpolate_by_smoothstep(v * cells - y);
    const double top = (1 - s) * hash_lattice_point(seed, x, y) +
                       s * hash_lattice_point(seed, right, y);
    const double bottom = (1 - s) * hash_lattice_point(seed, x, below) +
                          s * hash_lattice_point(seed, right, below);

    return (1 - t) * top + t * bottom;
}

/* Returns the intensity of a vein pattern at (U, V): veins lie where a wave,
 * distorted by noise, is near 0. The pattern is periodic, as its edges meet on
 * a sphere: the wave has an integer number of half periods along both axes. */
static double compute_vein_intensity(uint32_t seed, double u, double v)
{
    enum { CELLS = 3, ALONG_U = 3, ALONG_V = 2 };
    double bent = 0, wave;

    for (int i = 0; i < OCTAVES; i++)
        bent += ldexp(
            compute_value_noise(seed + (uint32_t)i, CELLS << i, u, v) - 0.5,
            -i);
    wave = fabs(sin((ALONG_U * u + ALONG_V * v) * 3.14159265358979 + 5 * bent));
    return wave >= 0.4 ? 1
                       : interpolate_by_smoothstep(fmax(0, (wave - 0.1) / 0.3));
}

void glint_stone_compute_fractions(const struct glint_stone *stone,
                                   double *share)
{
    const int side = stone->side;

    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double *to = &share[y * side + x];

            switch (stone->pattern) {
            case GLINT_STONE_CHESS:
                *to =
                    (x * stone->fields / side + y * stone->fields / side) % 2 ==
                    0;
                break;
            case GLINT_STONE_VEINS:
                *to = compute_vein_intensity(stone->seed, (x + 0.5) / side,
                                             (y + 0.5) / side);
                break;
            case GLINT_STONE_MASK:
                *to = stone->mask[y * side + x];
                break;
            case GLINT_STONE_EVEN:
            default:
                *to = 1;
            }
        }
}

enum {
    /* margin of the lattice, texels; it repeats the texels at the rim */
    MARGIN = 8,
    /* number of mixing steps from one material to the other for which the
     * closed form is computed */
    LEVELS = 8
};

struct compute {
    const struct glint_stone *stone;
    struct glint_scatter_rows *rows;
    int wide; /* texels of the lattice per side */
    int channel;
    double *share; /* [wide][wide]: fraction of material 0 */
    /* [wide][wide]: values of the current channel */
    double *diffusion, *absorb;
    /* matrix, source and exit factor of each texel for the current mode */
    double *own, *right, *down, *source, *exit;
    /* [mixes][kernel * kernel]: corrections, closed form minus modes; NULL: not
     * computed yet */
    double *closed[LEVELS + 1];
    /* z_b: distance outside the slab's faces at which the fluence is 0, mm */
    double beyond;
};

void glint_stone_defaults(struct glint_stone *stone)
{
    *stone = (struct glint_stone){
        .side = 128,
        .kernel = 29,
        .texel_mm = 0.61,
        .slab_mm = 6,
        .index = 1.5,
        .material = {{{2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
                     {{0.9, 0.75, 0.6}, {0.012, 0.02, 0.035}}},
        .pattern = GLINT_STONE_CHESS,
        .fields = 8,
        .seed = 1,
    };
}

/* Returns an error text with the valid range of the first parameter that is out
 * of range; NULL: all are valid. */
static const char *find_invalid_parameter(const struct glint_stone *s)
{
    if (!(s->side >= 1 && s->side <= GLINT_SCATTER_MAX_SIDE))
        return "size must be 1 to 256 texels";
    if (!(s->kernel >= 1 && s->kernel <= GLINT_SCATTER_MAX_KERNEL &&
          s->kernel % 2))
        return "kernel must be odd, 1 to 63 texels";
    if (!(s->texel_mm >= 0.01 && s->texel_mm <= 100))
        return "texel must be 0.01 to 100 mm";
    if (!(s->slab_mm >= 0.1 && s->slab_mm <= 1000))
        return "thickness of the slab must be 0.1 to 1000 mm";
    if (!(s->index >= 1 && s->index <= 3))
        return "index must be 1 to 3";
    if (s->pattern == GLINT_STONE_CHESS &&
        !(s->fields >= 1 && s->fields <= s->side))
        return "chess needs 1 or more fields per side, at most one per texel";
    if (s->pattern == GLINT_STONE_MASK && !s->mask)
        return "the mask picture of the pattern is missing";
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++) {
            const double scatter = s->material[i].scatter[c];
            const double absorb = s->material[i].absorb[c];

            if (!(scatter >= 1e-3 && scatter <= 1e3))
                return "scatter must be 0.001 to 1000 per mm";
            if (!(absorb >= 0 && absorb <= 1e3))
                return "absorb must be 0 to 1000 per mm";
        }
    for (int i = 0; s->pattern == GLINT_STONE_MASK && i < s->side * s->side;
         i++)
        if (!(s->mask[i] >= 0 && s->mask[i] <= 1))
            return "values of a mask must be 0 to 1";
    return NULL;
}

static int clamp_index(int x, int most)
{
    return x < 0 ? 0 : x > most ? most : x;
}

static void set_channel_diffusion(struct compute *p, int c)
{
    const int n = p->wide * p->wide;
    struct glint_slab slab;
    double sum = 0;

    p->channel = c;
    for (int i = 0; i < n; i++) {
        glint_slab_init_mix(p->stone, p->share[i], c, &slab);
        p->diffusion[i] = slab.diffusion;
        p->absorb[i] = slab.absorb;
        sum += slab.beyond;
    }
    p->beyond = sum / n;
}

static double compute_harmonic_mean(double a, double b)
{
    return 2 * a * b / (a + b);
}

/* Sets the matrix of mode N and, for each texel, its source and the light that
 * leaves it per unit of the mode. */
static void set_mode_matrix(struct compute *p, int n)
{
    const int w = p->wide;
    const double area = p->stone->texel_mm * p->stone->texel_mm;

    for (int i = 0; i < w * w; i++) {
        const double *d = &p->diffusion[i];
        struct glint_slab slab;
        double k;

        glint_slab_init_mix(p->stone, p->share[i], p->channel, &slab);
        slab.beyond = p->beyond;
        k = glint_slab_compute_wave_number(&slab, n);
        p->source[i] = glint_slab_compute_source(&slab, n) * area;
        p->exit[i] = glint_slab_compute_exit(&slab, n);
        p->right[i] = i % w < w - 1 ? compute_harmonic_mean(d[0], d[1]) : 0;
        p->down[i] = i / w < w - 1 ? compute_harmonic_mean(d[0], d[w]) : 0;
        p->own[i] = (d[0] * k * k + p->absorb[i]) * area + p->right[i] +
                    p->down[i] + (i % w > 0 ? p->right[i - 1] : 0) +
                    (i / w > 0 ? p->down[i - w] : 0);
    }
}

/* Adds block (J, L) of the inverse of a mode's matrix to the rows, in both
 * directions of each pair of texels. */
static void add_block_to_rows(void *ctx, int j, int l, const double *block)
{
    const struct compute *p = ctx;
    const int w = p->wide, side = p->rows->side, n = p->rows->kernel;
    const int half = n / 2, middle = n * n / 2;
    const int y = j - MARGIN, below = l - j;

    if (y < 0 || l - MARGIN >= side)
        return;
    for (int x = 0; x < side; x++) {
        const int a = j * w + x + MARGIN;
        const int first = below ? clamp_index(x - half, x) : x;

        for (int to = first; to <= clamp_index(x + half, side - 1); to++) {
            const int b = l * w + to + MARGIN, d = below * n + to - x;
            const double g = block[(x + MARGIN) * w + to + MARGIN];
            const double r =
                g * 0.5 *
                (p->source[a] * p->exit[b] + p->source[b] * p->exit[a]);

            glint_scatter_get_row(p->rows, y * side + x,
                                  p->channel)[middle + d] += (float)r;
            if (d)
                glint_scatter_get_row(p->rows, (l - MARGIN) * side + to,
                                      p->channel)[middle - d] += (float)r;
        }
    }
}

/* Computes the correction (closed form minus modes) of a medium with the
 * fraction LEVEL / LEVELS of material 0, unless it is computed already. Returns
 * false if there is no memory. */
static bool compute_closed_form_correction(struct compute *p, int level)
{
    const int k2 = glint_scatter_count_entries(p->rows->kernel);
    struct glint_slab slab;
    double *modes;

    if (p->closed[level])
        return true;
    p->closed[level] = malloc(2 * (size_t)k2 * sizeof(double));
    if (!p->closed[level])
        return false;
    modes = p->closed[level] + k2;
    glint_slab_init_mix(p->stone, (double)level / LEVELS, p->channel, &slab);
    glint_slab_compute_closed_form(&slab, p->rows->kernel, p->closed[level]);
    if (!glint_slab_compute_by_modes(&slab, p->rows->kernel, modes))
        return false;
    for (int d = 0; d < k2; d++)
        p->closed[level][d] -= modes[d];
    return true;
}

static void free_closed_form_corrections(struct compute *p)
{
    for (int i = 0; i <= LEVELS; i++) {
        free(p->closed[i]);
        p->closed[i] = NULL;
    }
}

/* Returns the closed-form correction of entry D, interpolated for the mix of
 * materials at texel X. */
static double compute_entry_correction(const struct compute *p, int x, int d)
{
    const double at = p->rows->share[x] * LEVELS;
    const int level = clamp_index((int)at, LEVELS - 1);
    const double *low = p->closed[level], *high = p->closed[level + 1];
    const double t = at - level;

    return (low && t < 1 ? (1 - t) * low[d] : 0) +
           (high && t > 0 ? t * high[d] : 0);
}

/* Adds the closed-form correction to all rows of the channel and clamps
 * negative entries to 0. Returns false if there is no memory. */
static bool add_closed_form_corrections(struct compute *p)
{
    const int side = p->rows->side, n = p->rows->kernel;

    for (int x = 0; x < side * side; x++) {
        const double at = p->rows->share[x] * LEVELS;
        const int level = clamp_index((int)at, LEVELS - 1);

        if ((at < level + 1 && !compute_closed_form_correction(p, level)) ||
            (at > level && !compute_closed_form_correction(p, level + 1)))
            return false;
    }
    for (int x = 0; x < side * side; x++) {
        float *row = glint_scatter_get_row(p->rows, x, p->channel);

        for (int d = 0; d < n * n; d++) {
            const int to = glint_scatter_get_target_texel(side, n, x, d);

            if (to >= 0)
                row[d] = (float)fmax(
                    0, (double)row[d] +
                           0.5 * (compute_entry_correction(p, x, d) +
                                  compute_entry_correction(p, to, d)));
        }
    }
    return true;
}

/* Scales each row whose sum exceeds 1, and the entries that lead to its texel,
 * by the same factor. */
static void limit_row_sums(const struct compute *p)
{
    const int side = p->rows->side, n = p->rows->kernel;
    /* scratch; large enough, because the lattice has at least as many texels */
    double *scale = p->own;

    for (int x = 0; x < side * side; x++) {
        const float *row = glint_scatter_get_row(p->rows, x, p->channel);
        double sum = 0;

        for (int d = 0; d < n * n; d++)
            sum += (double)row[d];
        scale[x] = sum > 1 ? 1 / sum : 1;
    }
    for (int x = 0; x < side * side; x++) {
        float *row = glint_scatter_get_row(p->rows, x, p->channel);

        for (int d = 0; d < n * n; d++) {
            const int to = glint_scatter_get_target_texel(side, n, x, d);

            if (to >= 0 && (scale[x] < 1 || scale[to] < 1))
                row[d] *= (float)(scale[x] * scale[to]);
        }
    }
}

static enum glint_status compute_channel_rows(struct compute *p, int c,
                                              const struct glint_watch *watch)
{
    const struct blocks blocks = {p->wide, p->own, p->right, p->down};
    double all = 0, done = 0;

    set_channel_diffusion(p, c);
    /* The progress of mode n is weighted by 1 / sqrt(n), to which its cost is
     * proportional, as measured: light of higher modes spreads less far. */
    for (int n = 1; n <= GLINT_SLAB_MODES; n++)
        all += 3.0 * sqrt(1.0 / n);
    for (int n = 1; n <= GLINT_SLAB_MODES; n++) {
        struct glint_watch_part part = {watch, c / 3.0 + done / all,
                                        sqrt(1.0 / n) / all};
        const struct glint_watch mode = glint_watch_make_for_part(&part);
        enum glint_status status;

        set_mode_matrix(p, n);
        status = compute_inverse_band(&blocks, p->rows->kernel / 2, &mode,
                                      add_block_to_rows, p);
        if (status != GLINT_OK)
            return status;
        done += sqrt(1.0 / n);
    }
    if (!add_closed_form_corrections(p))
        return GLINT_E_MEMORY;
    free_closed_form_corrections(p);
    limit_row_sums(p);
    return GLINT_OK;
}

static enum glint_status compute_all_rows(struct compute *p,
                                          const struct glint_watch *watch)
{
    const size_t n = (size_t)p->wide * (size_t)p->wide;
    double *memory = malloc(8 * n * sizeof *memory);
    double **part[8] = {&p->share, &p->diffusion, &p->absorb, &p->own,
                        &p->right, &p->down,      &p->source, &p->exit};
    enum glint_status status = GLINT_OK;

    if (!memory)
        return GLINT_E_MEMORY;
    for (size_t i = 0; i < 8; i++)
        *part[i] = memory + i * n;
    glint_stone_compute_fractions(p->stone, p->rows->share);
    for (int i = 0; i < p->wide * p->wide; i++)
        p->share[i] =
            p->rows
                ->share[clamp_index(i / p->wide - MARGIN, p->rows->side - 1) *
                            p->rows->side +
                        clamp_index(i % p->wide - MARGIN, p->rows->side - 1)];
    for (int c = 0; c < 3 && status == GLINT_OK; c++)
        status = compute_channel_rows(p, c, watch);
    free_closed_form_corrections(p);
    free(memory);
    return status;
}

enum glint_status glint_scatter_compute(const struct glint_stone *stone,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_rows *rows,
                                        struct glint_error *error)
{
    struct compute p = {
        .stone = stone, .rows = rows, .wide = stone->side + 2 * MARGIN};
    const char *cause = find_invalid_parameter(stone);
    enum glint_status status = GLINT_E_MEMORY;

    *rows = (struct glint_scatter_rows){0};
    if (cause) {
        snprintf(error->text, sizeof error->text, "%s", cause);
        return GLINT_E_ARGUMENT;
    }
    if (glint_scatter_allocate_rows(rows, stone->side, stone->kernel, true))
        status = compute_all_rows(&p, watch);
    if (status != GLINT_OK) {
        glint_scatter_close(rows);
        snprintf(error->text, sizeof error->text, "%s",
                 glint_status_text(status));
    }
    return status;
}
