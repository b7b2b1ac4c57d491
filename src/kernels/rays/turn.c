/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include "kernels/choose.h"

glint_turn_fn *glint_choose_turn_kernel(unsigned sets)
{
    return BEST_OF(sets, glint_turn_);
}
