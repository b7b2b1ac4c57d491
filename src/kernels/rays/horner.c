/* SPDX-License-Identifier: MIT */
#include "kernels/rays/rays.h"

#include "kernels/choose.h"

#define HORNER(set)                                                        \
    static const struct glint_horner of_##set = {glint_horner_along_##set, \
                                                 glint_horner_across_##set};

KERNEL_SETS(HORNER)

const struct glint_horner *glint_choose_horner_kernels(unsigned sets)
{
    return BEST_OF(sets, &of_);
}
