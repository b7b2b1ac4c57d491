/* SPDX-License-Identifier: MIT */
#include "kernels/ward/ward.h"

#include "kernels/choose.h"

glint_ward_sum_fn *glint_choose_ward_kernel(unsigned sets)
{
    return BEST_OF(sets, glint_ward_sum_);
}
