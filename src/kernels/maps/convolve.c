/* SPDX-License-Identifier: MIT */
#include "kernels/choose.h"
#include "kernels/maps/maps.h"

glint_convolve_fn *glint_choose_convolve_kernel(unsigned sets)
{
    return BEST_OF(sets, glint_convolve_);
}
