/* SPDX-License-Identifier: MIT */
#include "kernels/halo.h"

#include "glint/kernels.h"

glint_halo_fn *glint_choose_halo_kernel(unsigned sets)
{
#if defined(__x86_64__)
    if (sets & GLINT_SET_AVX2)
        return glint_halo_avx2;
#endif
    (void)sets;
    return glint_halo_c;
}
