/* SPDX-License-Identifier: MIT
 *
 * Tests that every variant of a kernel gives the bits of its C definition and
 * writes only to its arrays. The program needs only the kernels, so that it
 * runs in an emulator.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __wasm__
#define mprotect(mem, bytes, protection) 0 /* WebAssembly has no pages */
#else
#include <sys/mman.h>
#endif

#include "support/rng.h"
#include "glint/kernels.h"
#include "base/log2.h"
#include "kernels/halo.h"
#include "kernels/kernels.h"
#include "kernels/maps/maps.h"
#include "kernels/rays/rays.h"
#include "linux/sets.h"
#include "image/mix.h"

#define EXPECT(condition)                                              \
    do {                                                               \
        if (!(condition)) {                                            \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, \
                    #condition);                                       \
            exit(1);                                                   \
        }                                                              \
    } while (0)

#define EXPECT_SAME(a, b, bytes) EXPECT(memcmp(a, b, (size_t)(bytes)) == 0)

enum { N = 64, PAGE = 4096, ROUNDS = 20000 };

static uint32_t seed = 99;

static uint32_t random_bits(void)
{
    return rng_xorshift(&seed);
}

static void *blocks[400];
static int n_blocks;

/* Returns an array of BYTES bytes whose end is at an inaccessible page, so that
 * an overread causes a fault. */
static void *allocate_at_page_end(size_t bytes)
{
    void *mem;

    EXPECT(n_blocks < (int)(sizeof blocks / sizeof *blocks));
    EXPECT(posix_memalign(&mem, PAGE, 2 * PAGE) == 0);
    EXPECT(mprotect((uint8_t *)mem + PAGE, PAGE, PROT_NONE) == 0);
    blocks[n_blocks++] = mem;
    return (uint8_t *)mem + PAGE - bytes;
}

static void free_blocks_at_page_end(void)
{
    while (n_blocks > 0) {
        uint8_t *mem = blocks[--n_blocks];

        EXPECT(mprotect(mem + PAGE, PAGE, PROT_READ | PROT_WRITE) == 0);
        free(mem);
    }
}

/* The kernels as defined in C. */
static const struct glint_kernels kernels_c = {
    glint_add_luma_c, glint_add_pairs_c, glint_add_packed_c, glint_add_code_c,
    glint_run_sum_c};
static const struct glint_quad_kernels quad_kernels_c = {
    glint_add_quads_c, glint_add_quads_packed_c};

/* Returns random light: often 0, often the max, otherwise of any magnitude. */
static uint16_t random_light(void)
{
    const uint32_t x = random_bits();

    if (x % 5 < 2)
        return x % 5 ? 65535 : 0;
    return (uint16_t)((x >> 8 & 65535) >> (x >> 28));
}

struct rows {
    uint8_t *luma, *cb, *cr;
    uint16_t *light[3];
    int16_t *change[3];
};

static void allocate_rows(struct rows *r)
{
    r->luma = allocate_at_page_end(N);
    r->cb = allocate_at_page_end(N);
    r->cr = allocate_at_page_end(N);
    for (int c = 0; c < 3; c++) {
        r->light[c] = allocate_at_page_end(N * sizeof(uint16_t));
        r->change[c] = allocate_at_page_end(N * sizeof(int16_t));
    }
}

static void init_random_colour_factors(struct glint_mix *mix)
{
    const struct glint_image image = {
        .matrix = (enum glint_matrix)(random_bits() & 1),
        .range = (enum glint_range)(random_bits() & 1),
        .transfer = (enum glint_tone)(random_bits() & 1)};

    glint_mix_set_factors(mix, &image);
}

static void add_luma_light(const struct glint_kernels *k, const struct rows *r,
                           int n, const struct glint_mix *mix,
                           const int16_t *round)
{
    const uint16_t *const light[3] = {r->light[0], r->light[1], r->light[2]};

    k->add_luma(r->luma, r->cb, r->cr, light, r->change, n, mix, round);
}

static void check_luma_kernel(const struct glint_kernels *k)
{
    const struct glint_kernels *plain = &kernels_c;
    struct glint_mix mix;
    struct rows want, got;
    int16_t round[8];

    allocate_rows(&want);
    allocate_rows(&got);
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n =
            GLINT_LANES * (1 + (int)(random_bits() % (N / GLINT_LANES)));

        init_random_colour_factors(&mix);
        for (int i = 0; i < 8; i++)
            round[i] = (int16_t)(random_bits() & 127);
        for (int i = 0; i < N; i++) {
            want.luma[i] = got.luma[i] = (uint8_t)random_bits();
            want.cb[i] = got.cb[i] = (uint8_t)random_bits();
            want.cr[i] = got.cr[i] = (uint8_t)random_bits();
            for (int c = 0; c < 3; c++) {
                want.light[c][i] = got.light[c][i] = random_light();
                want.change[c][i] = got.change[c][i] = 77;
            }
        }
        add_luma_light(plain, &want, n, &mix, round);
        add_luma_light(k, &got, n, &mix, round);
        EXPECT_SAME(got.luma, want.luma, N);
        for (int c = 0; c < 3; c++)
            EXPECT_SAME(got.change[c], want.change[c], 2 * N);
    }
}

struct pairs {
    uint8_t *luma, *chroma;
    uint16_t *light[3];
    int16_t *mean[3];
};

static void allocate_pixel_pairs(struct pairs *p)
{
    p->luma = allocate_at_page_end(N);
    p->chroma = allocate_at_page_end(N);
    for (int c = 0; c < 3; c++) {
        p->light[c] = allocate_at_page_end(N * sizeof(uint16_t));
        p->mean[c] = allocate_at_page_end(N * sizeof(int16_t));
    }
}

static void add_light_to_pairs(const struct glint_kernels *k,
                               const struct pairs *p, int n,
                               enum glint_pair_step step,
                               const struct glint_mix *mix,
                               const int16_t *round)
{
    const uint16_t *const light[3] = {p->light[0], p->light[1], p->light[2]};

    k->add_pairs(p->luma, p->chroma, light, p->mean, n, step, mix, round,
                 round + 8);
}

static void check_pixel_pair_kernel(const struct glint_kernels *k)
{
    const struct glint_kernels *plain = &kernels_c;
    struct glint_mix mix;
    struct pairs want, got;
    int16_t round[16];

    allocate_pixel_pairs(&want);
    allocate_pixel_pairs(&got);
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n =
            GLINT_LANES * (1 + (int)(random_bits() % (N / GLINT_LANES)));
        const enum glint_pair_step step =
            (enum glint_pair_step)(random_bits() % 3);

        init_random_colour_factors(&mix);
        for (int i = 0; i < 16; i++)
            round[i] = (int16_t)(random_bits() & 127);
        for (int i = 0; i < N; i++) {
            want.luma[i] = got.luma[i] = (uint8_t)random_bits();
            want.chroma[i] = got.chroma[i] = (uint8_t)random_bits();
            for (int c = 0; c < 3; c++) {
                want.light[c][i] = got.light[c][i] = random_light();
                want.mean[c][i] = got.mean[c][i] =
                    (int16_t)(random_bits() % (GLINT_WHITE_Q15 + 1));
            }
        }
        add_light_to_pairs(plain, &want, n, step, &mix, round);
        add_light_to_pairs(k, &got, n, step, &mix, round);
        EXPECT_SAME(got.luma, want.luma, N);
        EXPECT_SAME(got.chroma, want.chroma, N);
        for (int c = 0; c < 3; c++)
            EXPECT_SAME(got.mean[c], want.mean[c], 2 * N);
    }
}

static void add_light_to_packed_pixels(const struct glint_kernels *k,
                                       uint8_t *pixels,
                                       uint16_t *const light[3], int n,
                                       int luma_at, const struct glint_mix *mix,
                                       const int16_t *round)
{
    const uint16_t *const rgb[3] = {light[0], light[1], light[2]};

    k->add_packed(pixels, rgb, n, luma_at, mix, round, round + 8);
}

/* Checks packed pixels at odd addresses, including spans without light. */
static void check_packed_kernel(const struct glint_kernels *k)
{
    const struct glint_kernels *plain = &kernels_c;
    uint8_t *want = allocate_at_page_end(2 * N + 1),
            *got = allocate_at_page_end(2 * N + 1);
    uint16_t *light[3] = {allocate_at_page_end(2 * N),
                          allocate_at_page_end(2 * N),
                          allocate_at_page_end(2 * N)};
    struct glint_mix mix;
    int16_t round[16];

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n =
            GLINT_LANES * (1 + (int)(random_bits() % (N / GLINT_LANES)));
        const int luma_at = (int)(random_bits() & 1),
                  at = (int)(random_bits() & 1);
        const int dark = (int)(random_bits() % N);

        init_random_colour_factors(&mix);
        for (int i = 0; i < 16; i++)
            round[i] = (int16_t)(random_bits() & 127);
        for (int i = 0; i < 2 * N + 1; i++)
            want[i] = got[i] = (uint8_t)random_bits();
        for (int i = 0; i < 3 * N; i++)
            light[i / N][i % N] = i % N > dark ? random_light() : 0;
        add_light_to_packed_pixels(plain, want + at, light, n, luma_at, &mix,
                                   round);
        add_light_to_packed_pixels(k, got + at, light, n, luma_at, &mix, round);
        EXPECT_SAME(got, want, 2 * N + 1);
    }
}

/* Two rows of luma and of chroma. For packed formats, `luma` contains the
 * complete pixels. */
struct quads {
    uint8_t *luma[2], *chroma[2];
};

static void add_light_to_quads(const struct glint_quad_kernels *k,
                               const struct quads *rows,
                               uint16_t *const light[3], int n, int packed,
                               const struct glint_mix *mix, int16_t (*round)[8])
{
    const uint16_t *const rgb[3] = {light[0], light[1], light[2]};
    const int16_t *const r[2] = {round[0], round[1]};
    const int16_t *const r_chroma[2] = {round[2], round[3]};

    if (packed)
        k->add_packed(rows->luma, rgb, n, packed - 1, mix, r);
    else
        k->add(rows->luma, rows->chroma, rgb, n, mix, r, r_chroma);
}

/* Checks blocks of 2 x 2 pixels, including spans without light. Both rows may
 * be the same, or have common chroma. */
static void check_2x2_block_kernel(const struct glint_quad_kernels *k)
{
    const struct glint_quad_kernels *plain = &quad_kernels_c;
    uint8_t *want[4], *got[4];
    uint16_t *light[3] = {allocate_at_page_end(N), allocate_at_page_end(N),
                          allocate_at_page_end(N)};
    struct quads a, b;
    struct glint_mix mix;
    int16_t round[4][8];

    for (int i = 0; i < 4; i++) {
        want[i] = allocate_at_page_end(2 * N);
        got[i] = allocate_at_page_end(2 * N);
    }
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = 2 * GLINT_LANES *
                      (1 + (int)(random_bits() % (N / (2 * GLINT_LANES))));
        const int packed = (int)(random_bits() % 3),
                  one_row = (int)(random_bits() % 2);
        const int one_chroma = one_row || random_bits() % 2;
        const int dark = (int)(random_bits() % (N / 2));

        init_random_colour_factors(&mix);
        for (int i = 0; i < 32; i++)
            round[i / 8][i % 8] = (int16_t)(random_bits() & 127);
        for (int i = 0; i < 8 && one_row; i++)
            round[1][i] = round[0][i];
        for (int i = 0; i < 8 && one_chroma; i++)
            round[3][i] = round[2][i];
        for (int i = 0; i < 4 * 2 * N; i++)
            want[i % 4][i / 4] = got[i % 4][i / 4] = (uint8_t)random_bits();
        for (int i = 0; i < 3 * N / 2; i++)
            light[i / (N / 2)][i % (N / 2)] =
                i % (N / 2) > dark ? random_light() : 0;
        a = (struct quads){{want[0], want[!one_row]},
                           {want[2], want[2 + !one_chroma]}};
        b = (struct quads){{got[0], got[!one_row]},
                           {got[2], got[2 + !one_chroma]}};
        add_light_to_quads(plain, &a, light, n, packed, &mix, round);
        add_light_to_quads(k, &b, light, n, packed, &mix, round);
        for (int i = 0; i < 4; i++)
            EXPECT_SAME(got[i], want[i], 2 * N);
    }
}

/* Checks all pairs of a code and a light. */
static void check_8bit_code_kernel(const struct glint_kernels *k)
{
    const int16_t round[8] = {64, 0, 127, 1, 63, 65, 100, 30};
    const struct glint_kernels *plain = &kernels_c;
    uint8_t *want = allocate_at_page_end(N), *got = allocate_at_page_end(N);
    uint16_t *light = allocate_at_page_end(N * sizeof *light);

    for (int transfer = 0; transfer < 2; transfer++)
        for (int code = 0; code < 256; code++)
            for (int first = 0; first < 65536; first += N) {
                const struct glint_tone16 *tone =
                    glint_get_tone_constants((enum glint_tone)transfer);

                for (int i = 0; i < N; i++) {
                    want[i] = got[i] = (uint8_t)code;
                    light[i] = (uint16_t)(first + i);
                }
                plain->add_code(want, light, N, tone, round);
                k->add_code(got, light, N, tone, round);
                EXPECT_SAME(got, want, N);
            }
}

static void check_sum_kernel(const struct glint_kernels *k)
{
    const struct glint_kernels *plain = &kernels_c;
    uint32_t *want = allocate_at_page_end(N * sizeof *want),
             *got = allocate_at_page_end(N * sizeof *got);
    uint16_t *light[2] = {allocate_at_page_end(N * sizeof(uint16_t)),
                          allocate_at_page_end(N * sizeof(uint16_t))};
    uint32_t carry[2];

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n =
            GLINT_LANES * (1 + (int)(random_bits() % (N / GLINT_LANES)));
        const int shift = (int)(random_bits() % 32);
        const int more = 2 + (int)(random_bits() % 14);

        carry[0] = carry[1] = random_bits() % 9
                                  ? random_bits() >> (random_bits() % 32)
                                  : INT32_MAX - random_bits() % 300;
        for (int i = 0; i < N; i++) {
            const int quiet = (turn >> i / 8 & 1) || random_bits() % 3;

            want[i] = got[i] = quiet ? 0 : random_bits() >> shift;
            light[0][i] = light[1][i] = 7;
        }
        plain->run_sum(want, &carry[0], light[0], n, more);
        k->run_sum(got, &carry[1], light[1], n, more);
        EXPECT(carry[0] == carry[1]);
        EXPECT_SAME(got, want, 4 * N);
        EXPECT_SAME(light[0], light[1], 2 * N);
    }
}

/* Checks polynomials like those of baked models: the magnitudes of their
 * coefficients sum to less than 2^30. */
static void check_horner_kernel(const struct glint_horner *k)
{
    const struct glint_horner *plain = glint_choose_horner_kernels(0);
    int32_t *c = allocate_at_page_end(160 * sizeof *c),
            *x = allocate_at_page_end(N * sizeof *x);
    int32_t *want = allocate_at_page_end(N * sizeof *want),
            *got = allocate_at_page_end(N * sizeof *got);

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int degree = (int)(random_bits() % 10);
        const int n = 8 * (1 + (int)(random_bits() % (N / 8)));
        const int32_t most = 1 << 26;

        for (int i = 0; i < 160; i++)
            c[i] = (int32_t)(random_bits() % (2 * (uint32_t)most)) - most;
        for (int i = 0; i < N; i++) {
            x[i] = (int32_t)(random_bits() % (2U << 30)) - (1 << 30);
            want[i] = got[i] = 7;
        }
        plain->along(want, c, degree, x, n);
        k->along(got, c, degree, x, n);
        EXPECT_SAME(got, want, 4 * N);
        plain->across(want, c, 16, degree, x[0], 16);
        k->across(got, c, 16, degree, x[0], 16);
        EXPECT_SAME(got, want, 4 * N);
    }
}

/* Returns a random number whose magnitude is below MOST, often MOST - 1. */
static int32_t random_signed_below(int64_t most)
{
    const uint32_t x = random_bits();
    const int64_t size = x % 7 == 0 ? most - 1 : (x >> 3) % most >> x % 31;

    return (int32_t)(x & 4 ? -size : size);
}

static void check_turn_kernel(glint_turn_fn *turn)
{
    const int64_t most = INT64_C(1) << 30;
    const size_t bytes = GLINT_TURNED * sizeof(int32_t);
    int32_t *x = allocate_at_page_end(bytes), *y = allocate_at_page_end(bytes);
    int32_t(*out[2])[GLINT_TURNED] = {allocate_at_page_end(4 * bytes),
                                      allocate_at_page_end(4 * bytes)};
    int32_t(*lost[2])[GLINT_TURNED] = {allocate_at_page_end(2 * bytes),
                                       allocate_at_page_end(2 * bytes)};
    struct glint_turn t = {0, 0, 1, 1};
    int n_lost = 0, n_kept = 0;

    for (int round = 0; round < 5 * ROUNDS; round++) {
        /* in every second round results are close to the max */
        const int near = (int)(random_bits() % 62) + 1;

        t = (struct glint_turn){random_signed_below(2 * most),
                                random_signed_below(2 * most),
                                round % 2 ? near : 28 + near % 8,
                                1 + abs(random_signed_below(most))};
        for (int i = 0; i < GLINT_TURNED; i++) {
            x[i] = random_signed_below(most);
            y[i] = random_signed_below(most);
            for (int k = 0; k < 2; k++)
                lost[0][k][i] = lost[1][k][i] = random_bits() % 4 ? 0 : -1;
        }
        glint_turn_c(&t, x, y, out[0], lost[0]);
        turn(&t, x, y, out[1], lost[1]);
        EXPECT_SAME(out[0], out[1], 4 * bytes);
        EXPECT_SAME(lost[0], lost[1], 2 * bytes);
        for (int i = 0; i < GLINT_TURNED; i++) {
            n_lost += lost[0][0][i] != 0;
            n_kept += out[0][0][i] != 0;
        }
    }
    EXPECT(n_lost > ROUNDS && n_kept > ROUNDS);
}

/* Checks convolutions with the largest kernels and values that a baked
 * translucent medium may have: sums are below 2^31 in any order. */
static void check_convolution_kernel(glint_convolve_fn *convolve)
{
    enum { TAPS = 32, VALUES = N + 2 * TAPS };
    int32_t *value = allocate_at_page_end(VALUES * sizeof *value);
    int32_t *tap = allocate_at_page_end(TAPS * sizeof *tap);
    int32_t *got = allocate_at_page_end(N * sizeof *got),
            *want = allocate_at_page_end(N * sizeof *want);

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n_taps = 1 + (int)(random_bits() % TAPS),
                  n = 32 * (1 + turn % 2);
        const ptrdiff_t stride = 1 + turn % 2;

        for (int i = 0; i < VALUES; i++)
            value[i] = glint_pack_int16_pair(random_signed_below(32768),
                                             random_signed_below(32768));
        for (int k = 0; k < n_taps; k++)
            tap[k] = glint_pack_int16_pair(
                random_signed_below(65536 / (2 * n_taps) < 32768
                                        ? 65536 / (2 * n_taps)
                                        : 32768),
                random_signed_below(1024));
        for (int i = 0; i < N; i++)
            got[i] = want[i] = random_signed_below(1 << 20);
        glint_convolve_c(want, value, stride, tap, n_taps, n);
        convolve(got, value, stride, tap, n_taps, n);
        EXPECT_SAME(got, want, N * sizeof *got);
    }
}

/* Returns a random halo of 1 to 4 lines, at up to 2^18 pixels from a lamp. */
static struct glint_halo make_random_halo(const glint_star_halo_row *table)
{
    const int32_t far = 1 << (9 + random_bits() % 18);
    struct glint_halo h = {.dx_q8 = random_signed_below(far),
                           .dy_q8 = random_signed_below(far),
                           .n_lines = 1 + (int)(random_bits() % 4),
                           .width_q8 = random_signed_below(1 << 24),
                           .reach_q8 = 1 + abs(random_signed_below(1 << 22)),
                           .table = table,
                           .next = table + GLINT_STAR_HALO_ROWS};
    const int64_t inner_q8 = 512 + abs(random_signed_below(1 << 22));

    h.inner_q16 = (uint64_t)(inner_q8 * inner_q8);
    h.reach_log2_q16 = q_log2_q16((uint64_t)h.reach_q8);
    h.next_q15 = random_bits() % 2 ? (int32_t)(random_bits() % 32769) : 0;
    for (int c = 0; c < 3; c++)
        h.log2_q16[c] = random_bits() % 16
                            ? (int32_t)(random_bits() % (70 << 16)) - (60 << 16)
                            : INT32_MIN / 2;
    for (int k = 0; k < h.n_lines; k++) {
        h.cos_q30[k] = random_signed_below(1 << 30);
        h.sin_q30[k] = abs(random_signed_below(1 << 30));
        h.v_q38[k] =
            h.dy_q8 * (int64_t)h.cos_q30[k] - h.dx_q8 * (int64_t)h.sin_q30[k];
    }
    return h;
}

static void check_halo_kernel(glint_halo_fn *add_halo)
{
    enum {
        VALUES = GLINT_HALO_SIDE * GLINT_HALO_STRIDE,
        ROWS = 2 * GLINT_STAR_HALO_ROWS
    };
    static glint_star_halo_row table[ROWS];
    static int64_t want[VALUES], got[VALUES];
    int n_lit = 0;

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n_y = 1 + turn % GLINT_HALO_SIDE;
        const int x = 8 * (turn % 8);
        struct glint_halo h;
        int64_t first;

        for (int i = 0; turn % 64 == 0 && i < ROWS; i++)
            for (int k = 0; k < 3 * GLINT_STAR_HALO_COLUMNS; k++)
                table[i][k / 3][k % 3] = (uint16_t)random_bits();
        h = make_random_halo((const glint_star_halo_row *)table);
        for (int i = 0; i < VALUES; i++)
            want[i] = got[i] = random_signed_below(1 << 30);
        first = want[x];
        glint_halo_c(&h, GLINT_HALO_SIDE, n_y, want + x);
        add_halo(&h, GLINT_HALO_SIDE, n_y, got + x);
        EXPECT_SAME(got, want, VALUES * sizeof *got);
        n_lit += want[x] > first;
    }
    EXPECT(n_lit > ROUNDS / 10);
}

static void check_light_kernel(glint_move_light_fn *move_light)
{
    int64_t *light[2] = {allocate_at_page_end(N * sizeof **light),
                         allocate_at_page_end(N * sizeof **light)};
    uint16_t *codes[2] = {allocate_at_page_end(N * sizeof **codes),
                          allocate_at_page_end(N * sizeof **codes)};

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = 8 * (1 + turn % (N / 8));
        int any[2];

        for (int i = 0; i < N; i++) {
            light[0][i] = light[1][i] =
                turn % 3 == 0 && i < n ? -(turn & 1)
                                       : random_signed_below(INT64_C(1) << 31) *
                                             (INT64_C(1) << random_bits() % 24);
            codes[0][i] = codes[1][i] = 7;
        }
        any[0] = glint_move_light_c(light[0], n, codes[0]);
        any[1] = move_light(light[1], n, codes[1]);
        EXPECT(!any[0] == !any[1] && (turn % 3 > 0 || !any[0]));
        EXPECT_SAME(light[0], light[1], N * sizeof **light);
        EXPECT_SAME(codes[0], codes[1], N * sizeof **codes);
    }
}

static void test_kernels_are_identical(void)
{
    static const unsigned sets[] = {GLINT_SET_SSE41, GLINT_SET_AVX2,
                                    GLINT_SET_NEON};

    for (size_t v = 0; v < sizeof sets / sizeof *sets; v++) {
        const struct glint_kernels *k = glint_choose_pixel_kernels(sets[v]);

        if (!(sets[v] & glint_system_sets()))
            continue;
        check_horner_kernel(glint_choose_horner_kernels(sets[v]));
        check_turn_kernel(glint_choose_turn_kernel(sets[v]));
        check_halo_kernel(glint_choose_star_kernels(sets[v])->add_halo);
        check_light_kernel(glint_choose_star_kernels(sets[v])->move_light);
        check_convolution_kernel(glint_choose_convolve_kernel(sets[v]));
        check_luma_kernel(k);
        check_pixel_pair_kernel(k);
        check_packed_kernel(k);
        check_2x2_block_kernel(glint_choose_quad_kernels(sets[v]));
        check_8bit_code_kernel(k);
        check_sum_kernel(k);
    }
}

/* Checks that a code does not change without light, and that more light never
 * gives a darker code. */
static void test_code_kernel_in_c(void)
{
    const int16_t round[8] = {64, 64, 64, 64, 64, 64, 64, 64};

    for (int transfer = 0; transfer < 2; transfer++)
        for (int code = 0; code < 256; code++) {
            int before = code;

            for (int light = 1; before < 255; light += light / 64 + 1) {
                uint8_t lit[GLINT_LANES];
                uint16_t add[GLINT_LANES] = {
                    (uint16_t)(light < 65535 ? light : 65535)};

                memset(lit, code, sizeof lit);
                glint_add_code_c(
                    lit, add, GLINT_LANES,
                    glint_get_tone_constants((enum glint_tone)transfer), round);
                EXPECT(lit[0] >= before);
                EXPECT(lit[1] == code);
                before = lit[0];
                EXPECT(before == 255 || light < 65535);
            }
        }
}

int main(void)
{
    test_code_kernel_in_c();
    test_kernels_are_identical();
    free_blocks_at_page_end();
    puts("[       OK ] kernels"); /* as cmocka prints it, for tests/run-one */
    return 0;
}
