/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include "kernels/choose.h"

glint_turn_fn *glint_turn_of(unsigned sets)
{
    return BEST_OF(sets, glint_turn_);
}
