/* SPDX-License-Identifier: MIT
 *
 * glint/kernels.h - the instruction sets that the hot loops may use.
 *
 * The output is bit-identical for all sets; only the speed differs. If all CPUs
 * for which the library is built have NEON, as on aarch64, the kernels for
 * pixels exist for NEON only. */
#ifndef GLINT_KERNELS_H
#define GLINT_KERNELS_H

#ifdef __cplusplus
extern "C" {
#endif

enum { GLINT_SET_SSE41 = 1, GLINT_SET_AVX2 = 2, GLINT_SET_NEON = 4 };

/* Returns the GLINT_SET_ bits that this library has kernels for. */
unsigned glint_sets_built(void);

/* Returns the sets in glint_sets_built() that this CPU supports, as far as can
 * be detected without an operating system. NEON is detected at compile time. On
 * 32-bit ARM, where the compiler cannot know, a program may add NEON from
 * glint_sets_built() if its system reports NEON, as platform/linux/sets.h
 * does. */
unsigned glint_sets_here(void);

#ifdef __cplusplus
}
#endif

#endif
