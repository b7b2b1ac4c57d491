/* SPDX-License-Identifier: MIT
 *
 * Stands in for oiio_loader.c in static programs, which cannot load a plug-in.
 */
#include "formats/oiio.h"

#include "posix/error.h"

enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error)
{
    *oiio = NULL;
    return glint_error_report(error, GLINT_E_UNSUPPORTED, "glint-oiio.so",
                              "a static glint loads no plug-ins");
}
