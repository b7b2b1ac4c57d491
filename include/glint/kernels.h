/* SPDX-License-Identifier: MIT
 *
 * glint/kernels.h - which instruction sets the hot loops may use.
 *
 * Every set gives the same bits; they differ in speed alone.
 */
#ifndef GLINT_KERNELS_H
#define GLINT_KERNELS_H

enum { GLINT_SET_SSE41 = 1, GLINT_SET_AVX2 = 2, GLINT_SET_NEON = 4 };

/* The GLINT_SET_ bits that this library has kernels for and this CPU can run;
 * NEON is the compiler's word, not the CPU's. */
unsigned glint_sets_here(void);

#endif
