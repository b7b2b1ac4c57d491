/* SPDX-License-Identifier: MIT
 *
 * Tests that every variant of the kernel for brushed metal gives the bits of
 * its C definition for random lobes, levels and texels, and reads no texel out
 * of range: the array of texels ends at an inaccessible page. The program
 * needs only the kernels, so that it runs in an emulator.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __wasm__
#define mprotect(mem, bytes, protection) 0 /* WebAssembly has no pages */
#else
#include <sys/mman.h>
#endif

#include "glint/kernels.h"
#include "kernels/ward/ward.h"
#include "linux/sets.h"
#include "support/rng.h"

#define EXPECT(condition)                                              \
    do {                                                               \
        if (!(condition)) {                                            \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, \
                    #condition);                                       \
            exit(1);                                                   \
        }                                                              \
    } while (0)

enum { SIDE_LOG2 = 6, CODES = 1 << 14, PAGE = 4096, LOBES = 3000, PLACES = 8 };

static uint32_t seed = 77;

static int32_t random_below(int32_t n)
{
    return (int32_t)(rng_xorshift(&seed) % (uint32_t)n);
}

static double random_unit(void)
{
    return random_below(1 << 24) / (double)(1 << 24);
}

/* Returns memory for CODES texels of 4 bytes whose end is at an inaccessible
 * page, so that an overread causes a fault. */
static uint8_t *allocate_texels(void)
{
    void *mem;
    uint8_t *at;

    EXPECT(posix_memalign(&mem, PAGE, 4 * CODES + PAGE) == 0);
    at = mem;
    EXPECT(mprotect(at + 4 * CODES, PAGE, PROT_NONE) == 0);
    return at;
}

/* Makes random texels of Gaussian levels or of mipmap levels. The levels end
 * exactly at the end of the array CODE. */
static void make_random_texels(struct glint_texels *t, uint8_t *code)
{
    uint32_t used = 0;
    const int is_mip = random_below(2);

    t->code = (const uint32_t *)(const void *)code;
    t->last = SIDE_LOG2;
    for (int k = SIDE_LOG2; k >= 0; k--) {
        const int side = is_mip || k == 0 ? SIDE_LOG2 - k : SIDE_LOG2 + 1 - k;

        t->level[k].side_log2 = is_mip || side > 2 ? side : 2;
        used += 1U << (2 * t->level[k].side_log2);
        t->level[k].at = CODES - used;
    }
    t->level[SIDE_LOG2 + 1] = t->level[SIDE_LOG2];
    EXPECT(used <= CODES);
    for (int i = 0; i < 4 * CODES; i += 4) {
        const uint32_t word = rng_xorshift(&seed);

        memcpy(code + i, &word, 4);
    }
}

static void make_random_lobe(struct glint_ward_lobe *l)
{
    const double alpha = pow(10, -3 * random_unit());

    memset(l, 0, sizeof *l);
    l->n = 1 + random_below(GLINT_WARD_SAMPLES);
    l->norm = (enum glint_ward_norm)random_below(2);
    for (int k = 0; k < GLINT_WARD_SAMPLES; k++) {
        const double x = alpha * 4 * (random_unit() - .5);
        const double y = alpha * 4 * (random_unit() - .5);
        const double over = 0x1p14 / sqrt(1 + x * x + y * y);

        l->half_q14[0][k] = (int32_t)lrint(x * over);
        l->half_q14[1][k] = (int32_t)lrint(y * over);
        l->half_q14[2][k] = k < l->n ? (int32_t)lrint(over) : -16384;
        l->factor_q14[k] =
            (int32_t)((int64_t)l->half_q14[2][k] * l->half_q14[2][k] >> 14);
        l->span_q14[k] = 16384 + random_below(16384);
        l->span_log2[k] = random_below(20) - 3;
    }
}

/* Makes a random rotation of the surface, and a view direction that is often
 * grazing. */
static void make_random_view(struct glint_ward_place *p)
{
    const double no = pow(random_unit(), random_below(3) ? 1 : 8) + 0x1p-13;
    const double across = sqrt(fmax(1 - no * no, 0)), turn = 7 * random_unit();
    double q[4], length = 0, m[3][3];

    for (int k = 0; k < 4; k++) {
        q[k] = random_unit() - .5;
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(length);
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;

        m[k][k] = 1 - 2 * (q[a] * q[a] + q[b] * q[b]);
        m[k][a] = 2 * (q[k] * q[a] + q[3] * q[b]);
        m[k][b] = 2 * (q[k] * q[b] - q[3] * q[a]);
    }
    for (int k = 0; k < 9; k++)
        p->frame_q14[k / 3][k % 3] = (int32_t)lrint(0x1p14 * m[k / 3][k % 3]);
    p->out_q14[0] = (int32_t)lrint(0x1p14 * across * cos(turn));
    p->out_q14[1] = (int32_t)lrint(0x1p14 * across * sin(turn));
    p->out_q14[2] = (int32_t)fmax(0x1p14 * no, 1);
    p->root_q14 = 16384 + random_below(16385);
    p->root_log2 = random_below(8) - 1;
}

static void check_kernel_variant(glint_ward_sum_fn *sum)
{
    uint8_t *const code = allocate_texels();
    struct glint_texels texels;
    struct glint_ward_lobe lobe;
    int n_lit = 0;

    for (int i = 0; i < LOBES; i++) {
        if (i % 100 == 0)
            make_random_texels(&texels, code);
        make_random_lobe(&lobe);
        for (int k = 0; k < PLACES; k++) {
            struct glint_ward_place place;
            uint64_t want[3], got[3];

            make_random_view(&place);
            glint_ward_sum_c(&lobe, &texels, &place, want);
            sum(&lobe, &texels, &place, got);
            EXPECT(memcmp(want, got, sizeof want) == 0);
            for (int c = 0; c < 3; c++)
                EXPECT(want[c] < UINT64_C(1) << 48);
            n_lit += want[0] > 0;
        }
    }
    EXPECT(n_lit > LOBES * PLACES / 2);
    EXPECT(mprotect(code + 4 * CODES, PAGE, PROT_READ | PROT_WRITE) == 0);
    free(code);
}

int main(void)
{
    check_kernel_variant(glint_choose_ward_kernel(0));
    for (unsigned set = 1; set; set <<= 1)
        if (set & glint_system_sets())
            check_kernel_variant(glint_choose_ward_kernel(set));
    puts("[       OK ] ward kernels"); /* as cmocka, for tests/run-one */
    return 0;
}
