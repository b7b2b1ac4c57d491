/* SPDX-License-Identifier: MIT
 *
 * Every variant of a kernel must give the bits of its C definition, and touch
 * nothing but its arrays. GLINT_BENCH=1 times it, too. The program needs
 * nothing but the kernels, so that it runs in an emulator.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#include "support/rng.h"
#include "glint/kernels.h"
#include "kernels/kernels.h"
#include "kernels/maps/maps.h"
#include "kernels/rays/rays.h"
#include "linux/sets.h"
#include "image/mix.h"

#define EXPECT(condition)                                              \
    do {                                                               \
        if (!(condition)) {                                            \
            fprintf(stderr, "%s:%d: %s, not so\n", __FILE__, __LINE__, \
                    #condition);                                       \
            exit(1);                                                   \
        }                                                              \
    } while (0)

#define EXPECT_SAME(a, b, bytes) EXPECT(memcmp(a, b, (size_t)(bytes)) == 0)

enum { N = 64, PAGE = 4096, ROUNDS = 20000 };

static uint32_t seed = 99;

static uint32_t draw(void)
{
    return rng_xorshift(&seed);
}

static void *blocks[400];
static int n_blocks;

/* Returns BYTES bytes that end at a page which traps. */
static void *fenced(size_t bytes)
{
    void *mem;

    EXPECT(n_blocks < (int)(sizeof blocks / sizeof *blocks));
    EXPECT(posix_memalign(&mem, PAGE, 2 * PAGE) == 0);
    EXPECT(mprotect((uint8_t *)mem + PAGE, PAGE, PROT_NONE) == 0);
    blocks[n_blocks++] = mem;
    return (uint8_t *)mem + PAGE - bytes;
}

static void free_blocks(void)
{
    while (n_blocks > 0) {
        uint8_t *mem = blocks[--n_blocks];

        EXPECT(mprotect(mem + PAGE, PAGE, PROT_READ | PROT_WRITE) == 0);
        free(mem);
    }
}

struct variant {
    const char *name;
    unsigned set;
};

static const struct variant variants[] = {{"sse41", GLINT_SET_SSE41},
                                          {"avx2", GLINT_SET_AVX2},
                                          {"neon", GLINT_SET_NEON}};

/* The C definitions of all kernels. */
static const struct glint_kernels kernels_c = {
    glint_add_luma_c, glint_add_pairs_c, glint_add_packed_c, glint_add_code_c,
    glint_run_sum_c};
static const struct glint_quad_kernels quad_kernels_c = {
    glint_add_quads_c, glint_add_quads_packed_c};

enum { N_VARIANTS = sizeof variants / sizeof *variants };

static double now_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

/* Prints the least time of many rounds, for C and for the variant, where
 * GLINT_BENCH is set. */
#define BENCH(what, name, of_c, of_variant)                                \
    do {                                                                   \
        double best[2] = {1e9, 1e9};                                       \
        if (!getenv("GLINT_BENCH"))                                        \
            break;                                                         \
        for (int round_ = 0; round_ < 1000; round_++) {                    \
            double t0_ = now_ns(), t1_, t2_;                               \
            for (int i_ = 0; i_ < 20; i_++)                                \
                of_c;                                                      \
            t1_ = now_ns();                                                \
            for (int i_ = 0; i_ < 20; i_++)                                \
                of_variant;                                                \
            t2_ = now_ns();                                                \
            best[0] = t1_ - t0_ < best[0] ? t1_ - t0_ : best[0];           \
            best[1] = t2_ - t1_ < best[1] ? t2_ - t1_ : best[1];           \
        }                                                                  \
        printf("%-10s %-6s %d px: C %.0f ns, %.0f ns, %.1f times\n", what, \
               name, N, best[0] / 20, best[1] / 20, best[0] / best[1]);    \
    } while (0)

/* Returns light that is often 0, often the largest, and else of any size. */
static uint16_t draw_light(void)
{
    const uint32_t x = draw();

    if (x % 5 < 2)
        return x % 5 ? 65535 : 0;
    return (uint16_t)((x >> 8 & 65535) >> (x >> 28));
}

struct rows {
    uint8_t *luma, *cb, *cr;
    uint16_t *light[3];
    int16_t *change[3];
};

static void make_rows(struct rows *r)
{
    r->luma = fenced(N);
    r->cb = fenced(N);
    r->cr = fenced(N);
    for (int c = 0; c < 3; c++) {
        r->light[c] = fenced(N * sizeof(uint16_t));
        r->change[c] = fenced(N * sizeof(int16_t));
    }
}

static void draw_mix(struct glint_mix *mix)
{
    const struct glint_image image = {.matrix = (enum glint_matrix)(draw() & 1),
                                      .range = (enum glint_range)(draw() & 1),
                                      .transfer =
                                          (enum glint_tone)(draw() & 1)};

    glint_mix_init(mix, &image);
}

static void add_luma(const struct glint_kernels *k, const struct rows *r, int n,
                     const struct glint_mix *mix, const int16_t *round)
{
    const uint16_t *const light[3] = {r->light[0], r->light[1], r->light[2]};

    k->add_luma(r->luma, r->cb, r->cr, light, r->change, n, mix, round);
}

static void check_luma(const struct glint_kernels *k, const char *name)
{
    const struct glint_kernels *plain = &kernels_c;
    struct glint_mix mix;
    struct rows want, got;
    int16_t round[8];

    make_rows(&want);
    make_rows(&got);
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = GLINT_LANES * (1 + (int)(draw() % (N / GLINT_LANES)));

        draw_mix(&mix);
        for (int i = 0; i < 8; i++)
            round[i] = (int16_t)(draw() & 127);
        for (int i = 0; i < N; i++) {
            want.luma[i] = got.luma[i] = (uint8_t)draw();
            want.cb[i] = got.cb[i] = (uint8_t)draw();
            want.cr[i] = got.cr[i] = (uint8_t)draw();
            for (int c = 0; c < 3; c++) {
                want.light[c][i] = got.light[c][i] = draw_light();
                want.change[c][i] = got.change[c][i] = 77;
            }
        }
        add_luma(plain, &want, n, &mix, round);
        add_luma(k, &got, n, &mix, round);
        EXPECT_SAME(got.luma, want.luma, N);
        for (int c = 0; c < 3; c++)
            EXPECT_SAME(got.change[c], want.change[c], 2 * N);
    }
    BENCH("add_luma", name, add_luma(plain, &want, N, &mix, round),
          add_luma(k, &got, N, &mix, round));
}

struct pairs {
    uint8_t *luma, *chroma;
    uint16_t *light[3];
    int16_t *mean[3];
};

static void make_pairs(struct pairs *p)
{
    p->luma = fenced(N);
    p->chroma = fenced(N);
    for (int c = 0; c < 3; c++) {
        p->light[c] = fenced(N * sizeof(uint16_t));
        p->mean[c] = fenced(N * sizeof(int16_t));
    }
}

static void add_pairs(const struct glint_kernels *k, const struct pairs *p,
                      int n, enum glint_pair_step step,
                      const struct glint_mix *mix, const int16_t *round)
{
    const uint16_t *const light[3] = {p->light[0], p->light[1], p->light[2]};

    k->add_pairs(p->luma, p->chroma, light, p->mean, n, step, mix, round,
                 round + 8);
}

static void check_pairs(const struct glint_kernels *k, const char *name)
{
    const struct glint_kernels *plain = &kernels_c;
    struct glint_mix mix;
    struct pairs want, got;
    int16_t round[16];

    make_pairs(&want);
    make_pairs(&got);
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = GLINT_LANES * (1 + (int)(draw() % (N / GLINT_LANES)));
        const enum glint_pair_step step = (enum glint_pair_step)(draw() % 3);

        draw_mix(&mix);
        for (int i = 0; i < 16; i++)
            round[i] = (int16_t)(draw() & 127);
        for (int i = 0; i < N; i++) {
            want.luma[i] = got.luma[i] = (uint8_t)draw();
            want.chroma[i] = got.chroma[i] = (uint8_t)draw();
            for (int c = 0; c < 3; c++) {
                want.light[c][i] = got.light[c][i] = draw_light();
                want.mean[c][i] = got.mean[c][i] =
                    (int16_t)(draw() % (GLINT_WHITE_Q15 + 1));
            }
        }
        add_pairs(plain, &want, n, step, &mix, round);
        add_pairs(k, &got, n, step, &mix, round);
        EXPECT_SAME(got.luma, want.luma, N);
        EXPECT_SAME(got.chroma, want.chroma, N);
        for (int c = 0; c < 3; c++)
            EXPECT_SAME(got.mean[c], want.mean[c], 2 * N);
    }
    BENCH("add_pairs", name,
          add_pairs(plain, &want, N, GLINT_PAIRS_ALONE, &mix, round),
          add_pairs(k, &got, N, GLINT_PAIRS_ALONE, &mix, round));
}

static void add_packed(const struct glint_kernels *k, uint8_t *pixels,
                       uint16_t *const light[3], int n, int luma_at,
                       const struct glint_mix *mix, const int16_t *round)
{
    const uint16_t *const rgb[3] = {light[0], light[1], light[2]};

    k->add_packed(pixels, rgb, n, luma_at, mix, round, round + 8);
}

/* Checks packed pixels that begin at odd addresses, with dark stretches among
 * them. */
static void check_packed(const struct glint_kernels *k, const char *name)
{
    const struct glint_kernels *plain = &kernels_c;
    uint8_t *want = fenced(2 * N + 1), *got = fenced(2 * N + 1);
    uint16_t *light[3] = {fenced(2 * N), fenced(2 * N), fenced(2 * N)};
    struct glint_mix mix;
    int16_t round[16];

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = GLINT_LANES * (1 + (int)(draw() % (N / GLINT_LANES)));
        const int luma_at = (int)(draw() & 1), at = (int)(draw() & 1);
        const int dark = (int)(draw() % N);

        draw_mix(&mix);
        for (int i = 0; i < 16; i++)
            round[i] = (int16_t)(draw() & 127);
        for (int i = 0; i < 2 * N + 1; i++)
            want[i] = got[i] = (uint8_t)draw();
        for (int i = 0; i < 3 * N; i++)
            light[i / N][i % N] = i % N > dark ? draw_light() : 0;
        add_packed(plain, want + at, light, n, luma_at, &mix, round);
        add_packed(k, got + at, light, n, luma_at, &mix, round);
        EXPECT_SAME(got, want, 2 * N + 1);
    }
    BENCH("add_packed", name, add_packed(plain, want, light, N, 0, &mix, round),
          add_packed(k, got, light, N, 0, &mix, round));
}

/* Two rows of luma and of chroma; rows of packed pixels are in luma. */
struct quads {
    uint8_t *luma[2], *chroma[2];
};

static void add_quads(const struct glint_quad_kernels *k,
                      const struct quads *rows, uint16_t *const light[3], int n,
                      int packed, const struct glint_mix *mix,
                      int16_t (*round)[8])
{
    const uint16_t *const rgb[3] = {light[0], light[1], light[2]};
    const int16_t *const r[2] = {round[0], round[1]};
    const int16_t *const r_chroma[2] = {round[2], round[3]};

    if (packed)
        k->add_packed(rows->luma, rgb, n, packed - 1, mix, r);
    else
        k->add(rows->luma, rows->chroma, rgb, n, mix, r, r_chroma);
}

/* Checks quads with dark stretches among them, whose two rows may be one row,
 * or share their chroma. */
static void check_quads(const struct glint_quad_kernels *k, const char *name)
{
    const struct glint_quad_kernels *plain = &quad_kernels_c;
    uint8_t *want[4], *got[4];
    uint16_t *light[3] = {fenced(N), fenced(N), fenced(N)};
    struct quads a, b;
    struct glint_mix mix;
    int16_t round[4][8];

    for (int i = 0; i < 4; i++) {
        want[i] = fenced(2 * N);
        got[i] = fenced(2 * N);
    }
    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n =
            2 * GLINT_LANES * (1 + (int)(draw() % (N / (2 * GLINT_LANES))));
        const int packed = (int)(draw() % 3), one_row = (int)(draw() % 2);
        const int one_chroma = one_row || draw() % 2;
        const int dark = (int)(draw() % (N / 2));

        draw_mix(&mix);
        for (int i = 0; i < 32; i++)
            round[i / 8][i % 8] = (int16_t)(draw() & 127);
        for (int i = 0; i < 8 && one_row; i++)
            round[1][i] = round[0][i];
        for (int i = 0; i < 8 && one_chroma; i++)
            round[3][i] = round[2][i];
        for (int i = 0; i < 4 * 2 * N; i++)
            want[i % 4][i / 4] = got[i % 4][i / 4] = (uint8_t)draw();
        for (int i = 0; i < 3 * N / 2; i++)
            light[i / (N / 2)][i % (N / 2)] =
                i % (N / 2) > dark ? draw_light() : 0;
        a = (struct quads){{want[0], want[!one_row]},
                           {want[2], want[2 + !one_chroma]}};
        b = (struct quads){{got[0], got[!one_row]},
                           {got[2], got[2 + !one_chroma]}};
        add_quads(plain, &a, light, n, packed, &mix, round);
        add_quads(k, &b, light, n, packed, &mix, round);
        for (int i = 0; i < 4; i++)
            EXPECT_SAME(got[i], want[i], 2 * N);
    }
    BENCH("add_quads", name, add_quads(plain, &a, light, N, 1, &mix, round),
          add_quads(k, &b, light, N, 1, &mix, round));
}

/* Checks every code under every light. */
static void check_code(const struct glint_kernels *k, const char *name)
{
    const int16_t round[8] = {64, 0, 127, 1, 63, 65, 100, 30};
    const struct glint_kernels *plain = &kernels_c;
    uint8_t *want = fenced(N), *got = fenced(N);
    uint16_t *light = fenced(N * sizeof *light);

    for (int transfer = 0; transfer < 2; transfer++)
        for (int code = 0; code < 256; code++)
            for (int first = 0; first < 65536; first += N) {
                const struct glint_tone16 *tone =
                    glint_tone16_of((enum glint_tone)transfer);

                for (int i = 0; i < N; i++) {
                    want[i] = got[i] = (uint8_t)code;
                    light[i] = (uint16_t)(first + i);
                }
                plain->add_code(want, light, N, tone, round);
                k->add_code(got, light, N, tone, round);
                EXPECT_SAME(got, want, N);
            }
    BENCH("add_code", name,
          plain->add_code(want, light, N, glint_tone16_of(GLINT_TONE_SRGB),
                          round),
          k->add_code(got, light, N, glint_tone16_of(GLINT_TONE_SRGB), round));
}

static void check_sum(const struct glint_kernels *k, const char *name)
{
    const struct glint_kernels *plain = &kernels_c;
    uint32_t *want = fenced(N * sizeof *want), *got = fenced(N * sizeof *got);
    uint16_t *light[2] = {fenced(N * sizeof(uint16_t)),
                          fenced(N * sizeof(uint16_t))};
    uint32_t carry[2];

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n = GLINT_LANES * (1 + (int)(draw() % (N / GLINT_LANES)));
        const int shift = (int)(draw() % 32);
        const int more = 2 + (int)(draw() % 14);

        carry[0] = carry[1] =
            draw() % 9 ? draw() >> (draw() % 32) : INT32_MAX - draw() % 300;
        for (int i = 0; i < N; i++) {
            const int quiet = (turn >> i / 8 & 1) || draw() % 3;

            want[i] = got[i] = quiet ? 0 : draw() >> shift;
            light[0][i] = light[1][i] = 7;
        }
        plain->run_sum(want, &carry[0], light[0], n, more);
        k->run_sum(got, &carry[1], light[1], n, more);
        EXPECT(carry[0] == carry[1]);
        EXPECT_SAME(got, want, 4 * N);
        EXPECT_SAME(light[0], light[1], 2 * N);
    }
    BENCH("run_sum", name, plain->run_sum(want, &carry[0], light[0], N, 8),
          k->run_sum(got, &carry[1], light[1], N, 8));
}

/* Checks polynomials whose coefficients have magnitudes that sum to less than
 * 2^30, as the bake proves. */
static void check_horner(const struct glint_horner *k, const char *name)
{
    const struct glint_horner *plain = glint_horner_of(0);
    int32_t *c = fenced(160 * sizeof *c), *x = fenced(N * sizeof *x);
    int32_t *want = fenced(N * sizeof *want), *got = fenced(N * sizeof *got);

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int degree = (int)(draw() % 10);
        const int n = 8 * (1 + (int)(draw() % (N / 8)));
        const int32_t most = 1 << 26;

        for (int i = 0; i < 160; i++)
            c[i] = (int32_t)(draw() % (2 * (uint32_t)most)) - most;
        for (int i = 0; i < N; i++) {
            x[i] = (int32_t)(draw() % (2U << 30)) - (1 << 30);
            want[i] = got[i] = 7;
        }
        plain->along(want, c, degree, x, n);
        k->along(got, c, degree, x, n);
        EXPECT_SAME(got, want, 4 * N);
        plain->across(want, c, 16, degree, x[0], 16);
        k->across(got, c, 16, degree, x[0], 16);
        EXPECT_SAME(got, want, 4 * N);
    }
    BENCH("along 9", name, plain->along(want, c, 9, x, N),
          k->along(got, c, 9, x, N));
    BENCH("across 4", name, plain->across(want, c, 32, 4, x[0], 16),
          k->across(got, c, 32, 4, x[0], 16));
}

/* Returns a number of any size below MOST in magnitude, often MOST - 1. */
static int32_t draw_below(int64_t most)
{
    const uint32_t x = draw();
    const int64_t size = x % 7 == 0 ? most - 1 : (x >> 3) % most >> x % 31;

    return (int32_t)(x & 4 ? -size : size);
}

static void check_turn(glint_turn_fn *turn, const char *name)
{
    const int64_t most = INT64_C(1) << 30;
    const size_t bytes = GLINT_TURNED * sizeof(int32_t);
    int32_t *x = fenced(bytes), *y = fenced(bytes);
    int32_t(*out[2])[GLINT_TURNED] = {fenced(4 * bytes), fenced(4 * bytes)};
    int32_t(*lost[2])[GLINT_TURNED] = {fenced(2 * bytes), fenced(2 * bytes)};
    struct glint_turn t = {0, 0, 1, 1};
    int n_lost = 0, n_kept = 0;

    for (int round = 0; round < 5 * ROUNDS; round++) {
        /* Every second round gives results about as large as may be. */
        const int near = (int)(draw() % 62) + 1;

        t = (struct glint_turn){draw_below(2 * most), draw_below(2 * most),
                                round % 2 ? near : 28 + near % 8,
                                1 + abs(draw_below(most))};
        for (int i = 0; i < GLINT_TURNED; i++) {
            x[i] = draw_below(most);
            y[i] = draw_below(most);
            for (int k = 0; k < 2; k++)
                lost[0][k][i] = lost[1][k][i] = draw() % 4 ? 0 : -1;
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
    BENCH("turn 8", name, glint_turn_c(&t, x, y, out[0], lost[0]),
          turn(&t, x, y, out[1], lost[1]));
}

/* Taps and values are as large as a baked translucent medium may have them:
 * sums are below 2^31 in any order. */
static void check_convolve(glint_convolve_fn *convolve, const char *name)
{
    enum { TAPS = 32, VALUES = N + 2 * TAPS };
    int32_t *value = fenced(VALUES * sizeof *value);
    int32_t *tap = fenced(TAPS * sizeof *tap);
    int32_t *got = fenced(N * sizeof *got), *want = fenced(N * sizeof *want);

    for (int turn = 0; turn < ROUNDS; turn++) {
        const int n_taps = 1 + (int)(draw() % TAPS), n = 32 * (1 + turn % 2);
        const ptrdiff_t stride = 1 + turn % 2;

        for (int i = 0; i < VALUES; i++)
            value[i] = glint_pair(draw_below(32768), draw_below(32768));
        for (int k = 0; k < n_taps; k++)
            tap[k] = glint_pair(draw_below(65536 / (2 * n_taps) < 32768
                                               ? 65536 / (2 * n_taps)
                                               : 32768),
                                draw_below(1024));
        for (int i = 0; i < N; i++)
            got[i] = want[i] = draw_below(1 << 20);
        glint_convolve_c(want, value, stride, tap, n_taps, n);
        convolve(got, value, stride, tap, n_taps, n);
        EXPECT_SAME(got, want, N * sizeof *got);
    }
    BENCH("convolve 15", name, glint_convolve_c(want, value, 2, tap, 15, 32),
          convolve(got, value, 2, tap, 15, 32));
}

static void test_same_bits(void)
{
    for (int v = 0; v < N_VARIANTS; v++) {
        const struct glint_kernels *k = glint_kernels_of(variants[v].set);

        if (!(variants[v].set & glint_system_sets()))
            continue;
        check_horner(glint_horner_of(variants[v].set), variants[v].name);
        check_turn(glint_turn_of(variants[v].set), variants[v].name);
        check_convolve(glint_convolve_of(variants[v].set), variants[v].name);
        check_luma(k, variants[v].name);
        check_pairs(k, variants[v].name);
        check_packed(k, variants[v].name);
        check_quads(glint_quad_kernels_of(variants[v].set), variants[v].name);
        check_code(k, variants[v].name);
        check_sum(k, variants[v].name);
    }
}

/* Without light a code must stay, and more light must never make it darker. */
static void test_codes_of_c(void)
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
                glint_add_code_c(lit, add, GLINT_LANES,
                                 glint_tone16_of((enum glint_tone)transfer),
                                 round);
                EXPECT(lit[0] >= before);
                EXPECT(lit[1] == code);
                before = lit[0];
                EXPECT(before == 255 || light < 65535);
            }
        }
}

int main(void)
{
    test_codes_of_c();
    test_same_bits();
    free_blocks();
    return 0;
}
