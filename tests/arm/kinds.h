/* SPDX-License-Identifier: MIT
 *
 * Helpers of programs whose output must be the same on every type of CPU: a
 * hash, images to draw onto, kernels by name.
 */
#ifndef GLINT_TESTS_KINDS_H
#define GLINT_TESTS_KINDS_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/image.h"
#include "glint/kernels.h"
#include "linux/sets.h"
#include "support/hash.h"
#include "support/rng.h"

static inline uint64_t kinds_hash_number(uint64_t h, int64_t x)
{
    for (int i = 0; i < 8; i++) {
        const uint8_t byte = (uint8_t)((uint64_t)x >> 8 * i);

        h = hash_bytes(h, &byte, 1);
    }
    return h;
}

/* Sets IMAGE to the memory MEM[BYTES], with a random code range, YCbCr matrix
 * and transfer curve, and fills it with a fixed pattern. */
static inline void kinds_fill_image(struct glint_image *image, uint8_t *mem,
                                    size_t bytes, uint32_t *seed)
{
    image->range = (enum glint_range)(rng_xorshift(seed) % 2);
    image->matrix = (enum glint_matrix)(rng_xorshift(seed) % 2);
    image->transfer = (enum glint_tone)(rng_xorshift(seed) % 2);
    glint_image_place(image, mem);
    for (size_t i = 0; i < bytes; i++)
        mem[i] = (uint8_t)(image->format == GLINT_LINEAR_Q20
                               ? 0
                               : (i * 7 + (i >> 8)) % 61 + 16);
}

/* Returns the instruction sets of WORD: c, sse41, avx2, neon or best. Ends
 * PROGRAM if this CPU lacks them. */
static inline unsigned kinds_parse_sets(const char *program, const char *word)
{
    static const struct {
        const char *word;
        unsigned sets;
    } of[] = {{"c", 0},
              {"sse41", GLINT_SET_SSE41},
              {"avx2", GLINT_SET_AVX2},
              {"neon", GLINT_SET_NEON},
              {"best", ~0U}};

    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        if (strcmp(word, of[i].word) == 0 &&
            (of[i].sets == ~0U || !(of[i].sets & ~glint_system_sets())))
            return of[i].sets & glint_system_sets();
    fprintf(stderr, "%s: no kernels '%s' here\n", program, word);
    exit(2);
}

#endif
