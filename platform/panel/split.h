/* SPDX-License-Identifier: MIT
 *
 * panel/split.h - samples that lie by turns, moved apart: loops that compilers
 * make vectors of. Arrays do not overlap.
 */
#ifndef GLINT_PLATFORM_PANEL_SPLIT_H
#define GLINT_PLATFORM_PANEL_SPLIT_H

#include <stdint.h>

/* N groups of two, three, four bytes (the last is dropped). */
void glint_split_pairs(uint8_t *restrict a, uint8_t *restrict b,
                       const uint8_t *restrict from, int n);
void glint_split_threes(uint8_t *restrict a, uint8_t *restrict b,
                        uint8_t *restrict c, const uint8_t *restrict from,
                        int n);
void glint_split_fours(uint8_t *restrict a, uint8_t *restrict b,
                       uint8_t *restrict c, const uint8_t *restrict from,
                       int n);

/* N pairs of pixels: two samples of luma, one each of chroma. */
void glint_split_yuyv(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from,
                      int n);
void glint_split_uyvy(uint8_t *restrict luma, uint8_t *restrict cb,
                      uint8_t *restrict cr, const uint8_t *restrict from,
                      int n);

/* N pixels of GLINT_RGB565 as codes of 8 bits. */
void glint_split_565(uint8_t *restrict r, uint8_t *restrict g,
                     uint8_t *restrict b, const uint8_t *restrict from, int n);

#endif
