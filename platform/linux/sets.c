/* SPDX-License-Identifier: MIT */
#include "linux/sets.h"

#include "glint/kernels.h"

#if defined(__arm__)

#include <asm/hwcap.h>
#include <sys/auxv.h>

unsigned glint_system_sets(void)
{
    const unsigned neon = getauxval(AT_HWCAP) & HWCAP_NEON ? GLINT_SET_NEON : 0;

    return glint_sets_here() | (neon & glint_sets_built());
}

#else

unsigned glint_system_sets(void)
{
    return glint_sets_here();
}

#endif
