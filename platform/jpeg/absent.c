/* SPDX-License-Identifier: MIT
 *
 * Replaces mjpeg.c in builds without libjpeg: opening a decoder fails. */
#include "jpeg/mjpeg.h"

#include "posix/error.h"

bool glint_mjpeg_available(void)
{
    return false;
}

enum glint_status glint_mjpeg_open(struct glint_mjpeg **decoder,
                                   const char *name, int max_width,
                                   int max_height, struct glint_error *error)
{
    (void)max_width, (void)max_height;
    *decoder = NULL;
    return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                              "MJPEG: glint was built without libjpeg; choose "
                              "another format, or install it and build again");
}

/* Never called: glint_mjpeg_open() makes no decoder. */
enum glint_status glint_mjpeg_decode(struct glint_mjpeg *decoder,
                                     const void *data, size_t bytes,
                                     struct glint_image *image,
                                     struct glint_error *error)
{
    (void)decoder, (void)data, (void)bytes, (void)image, (void)error;
    return GLINT_E_UNSUPPORTED;
}

void glint_mjpeg_close(struct glint_mjpeg *decoder)
{
    (void)decoder;
}
