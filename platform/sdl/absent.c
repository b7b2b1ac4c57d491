/* SPDX-License-Identifier: MIT
 *
 * Stands in for window.c in static programs, which cannot load a plug-in.
 */
#include "posix/error.h"
#include "sdl/sdl.h"

enum glint_status glint_window_open(struct glint_window *window,
                                    const char *title,
                                    struct glint_error *error)
{
    *window = (struct glint_window){.title = title};
    return glint_error_report(error, GLINT_E_DEVICE, "window",
                              "is not for static programs; a pipe: glint live "
                              "-o y4m:- ... | ffplay -loglevel error -");
}
