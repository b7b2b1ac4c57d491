/* SPDX-License-Identifier: MIT */
#include "base/q.h"

#ifdef GLINT_Q_CHECK
/* The trap of CONFIG=qcheck. It stops at once, so that the failing operation is
 * on the stack; nothing in the run-time half may print. */
void glint_q_overflow(const char *operation, int64_t exact)
{
    (void)operation;
    (void)exact;
    __builtin_trap();
}
#else
typedef int glint_q_is_all_inline; /* A translation unit must not be empty. */
#endif
