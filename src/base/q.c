/* SPDX-License-Identifier: MIT */
#include "base/q.h"

#ifdef GLINT_Q_CHECK
/* Stops the program when a fixed-point operation overflows in a build with
 * CONFIG=qcheck. Prints nothing, as the run-time half has no stdio; a debugger
 * shows the operation. */
void glint_q_abort_on_overflow(const char *operation, int64_t exact)
{
    (void)operation;
    (void)exact;
    __builtin_trap();
}
#else
typedef int glint_q_is_all_inline; /* C99 requires a declaration in each
                                      translation unit */
#endif
