/* SPDX-License-Identifier: MIT */
#include "panel/split.h"

void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[2 * i];
        b[i] = from[2 * i + 1];
    }
}

void glint_split_yuyv(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        luma[2 * i] = from[4 * i];
        luma[2 * i + 1] = from[4 * i + 2];
        cb[i] = from[4 * i + 1];
        cr[i] = from[4 * i + 3];
    }
}

void glint_split_uyvy(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        luma[2 * i] = from[4 * i + 1];
        luma[2 * i + 1] = from[4 * i + 3];
        cb[i] = from[4 * i];
        cr[i] = from[4 * i + 2];
    }
}

void glint_split_threes(uint8_t *restrict a, uint8_t *restrict b,
                        uint8_t *restrict c, const uint8_t *restrict from,
                        int n)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[3 * i];
        b[i] = from[3 * i + 1];
        c[i] = from[3 * i + 2];
    }
}

void glint_split_fours(uint8_t *restrict a, uint8_t *restrict b,
                       uint8_t *restrict c, const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        a[i] = from[4 * i];
        b[i] = from[4 * i + 1];
        c[i] = from[4 * i + 2];
    }
}

/* Fills the low bits of a code by its highest ones, so that 0 and the largest
 * become 0 and 255. */
void glint_split_565(uint8_t *restrict r, uint8_t *restrict g,
                     uint8_t *restrict b, const uint8_t *restrict from, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t low = from[2 * i], high = from[2 * i + 1];
        const uint8_t green = (uint8_t)((high & 7) << 3 | low >> 5);

        r[i] = (uint8_t)((high & 0xf8) | high >> 5);
        g[i] = (uint8_t)(green << 2 | green >> 4);
        b[i] = (uint8_t)(low << 3 | (low >> 2 & 7));
    }
}
