/* SPDX-License-Identifier: MIT
 *
 * formats/stills.h - reads and writes PNG and JPEG by libpng and libjpeg, for
 * systems without the image plug-in. It has the interface of the plug-in
 * (formats/oiio.h), of which it implements what these two file types need:
 *
 *     oiio = glint_stills_find("PNG");
 *     if (oiio)
 *         status = oiio->open(&file, &samples, &facts, "x.png", &error);
 *
 * A file that is written in its own type keeps all metadata of its one picture,
 * byte for byte. In the other type it keeps Exif and the ICC profile, and the
 * options' text names other metadata that is lost. CMYK needs the plug-in. */
#ifndef GLINT_PLATFORM_FORMATS_STILLS_H
#define GLINT_PLATFORM_FORMATS_STILLS_H

#include "formats/oiio.h"

/* Returns the functions for TYPE: "PNG", "JPEG", or a path with one of
 * their extensions. Returns NULL if TYPE is another, or its library is not
 * built in. */
const struct glint_oiio *glint_stills_find(const char *type);

#endif
