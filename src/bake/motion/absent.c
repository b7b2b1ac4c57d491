/* SPDX-License-Identifier: MIT
 *
 * Replaces recording.c in builds without jansson: glint_recording_read()
 * reports that recordings cannot be read.
 */
#include <stdio.h>

#include "glint/scene/motion_bake.h"

enum glint_status glint_recording_read(struct glint_motion_baker *baker,
                                       const char *file_name,
                                       glint_recording_read_fn *read, void *ctx,
                                       struct glint_error *error)
{
    (void)baker, (void)read, (void)ctx;
    snprintf(error->text, sizeof error->text,
             "%.120s: glint was built without jansson (libjansson-dev), which "
             "reads recordings",
             file_name);
    return GLINT_E_UNSUPPORTED;
}
