/* SPDX-License-Identifier: MIT
 *
 * panel/split.h - interleaved samples moved apart, by loops that compilers
 * vectorise. Arrays do not overlap.
 */
#ifndef GLINT_PLATFORM_PANEL_SPLIT_H
#define GLINT_PLATFORM_PANEL_SPLIT_H

#include <stdint.h>

/* Split N groups of two, three or four bytes; of four the last is dropped. */
void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n);
void glint_split_threes(uint8_t *restrict a, uint8_t *restrict b,
                        uint8_t *restrict c, const uint8_t *restrict from,
                        int n);
void glint_split_fours(uint8_t *restrict a, uint8_t *restrict b,
                       uint8_t *restrict c, const uint8_t *restrict from,
                       int n);

/* Split N pairs of pixels, each with two samples of luma and one of Cb and
 * Cr. */
void glint_split_yuyv(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from,
                      int n);
void glint_split_uyvy(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from,
                      int n);

/* Splits N pixels of GLINT_RGB565 into codes of 8 bits. */
void glint_split_565(uint8_t *restrict r, uint8_t *restrict g,
                     uint8_t *restrict b, const uint8_t *restrict from, int n);

#endif
