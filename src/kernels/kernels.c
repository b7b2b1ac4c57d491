/* SPDX-License-Identifier: MIT */
#include "kernels/kernels.h"

#include "glint/kernels.h"

void glint_kernels_init(struct glint_kernels *k, unsigned sets)
{
    *k = (struct glint_kernels){glint_horner_along_c, glint_horner_across_c,
                                glint_add_luma_c,     glint_add_pairs_c,
                                glint_add_code_c,     glint_run_sum_c};
#if defined(__x86_64__)
    if (sets & GLINT_SET_SSE41)
        *k = (struct glint_kernels){
            glint_horner_along_sse41, glint_horner_across_sse41,
            glint_add_luma_sse41,     glint_add_pairs_sse41,
            glint_add_code_sse41,     glint_run_sum_sse41};
    if (sets & GLINT_SET_AVX2)
        *k = (struct glint_kernels){
            glint_horner_along_avx2, glint_horner_across_avx2,
            glint_add_luma_avx2,     glint_add_pairs_avx2,
            glint_add_code_avx2,     glint_run_sum_avx2};
#elif defined(__ARM_NEON)
    if (sets & GLINT_SET_NEON)
        *k = (struct glint_kernels){
            glint_horner_along_neon, glint_horner_across_neon,
            glint_add_luma_neon,     glint_add_pairs_neon,
            glint_add_code_neon,     glint_run_sum_neon};
#endif
    (void)sets;
}
