/* SPDX-License-Identifier: MIT
 *
 * A picture file on its way through overlay: what is looked at, what is lit,
 * what is written.
 *
 *     overlay_file_open(&tool, &file, &compositor, "in.exr", "out.exr");
 *     overlay_file_draw(&file, &compositor);          in place of
 * compositor_draw() overlay_file_save(&tool, &file, &compositor, quality);
 *     overlay_file_close(&file);
 *
 * Opaque sRGB of 8 bits is drawn on as it is, in integers. Of everything else
 * the finder sees a proxy of 8 bits, floats are measured where it found lamps,
 * and the flare is added in linear light to the samples that it reaches. Where
 * nothing is drawn and the types are the same the file is copied.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_FILE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_FILE_H

#include "overlay/compositor.h"
#include "formats/kept.h"

struct overlay_file {
    /* Picture of the size that compositor_size wants. */
    struct glint_image image;

    /* Private. */
    const char *from, *to;
    struct glint_kept kept;
    struct glint_samples work; /* a deeper copy of the input, for floats out */
    bool is_direct, is_copied; /* drawn on the samples; through work */
    double white;              /* light of the proxy's white */
    float *layer;
};

/* Opens FROM, of which TO will be made; both are kept. Returns an exit code. */
int overlay_file_open(const struct tool *tool, struct overlay_file *file,
                      const struct compositor *compositor, const char *from,
                      const char *to);

/* Adds the flare, ELAPSED_US after the picture before. GLINT_E_MEMORY. */
enum glint_status overlay_file_draw(struct overlay_file *file,
                                    struct compositor *compositor,
                                    int32_t elapsed_us);

/* Writes it; QUALITY as of glint_kept_options. Returns an exit code. */
int overlay_file_save(const struct tool *tool, struct overlay_file *file,
                      const struct compositor *compositor, int quality);

/* Does nothing when closed. */
void overlay_file_close(struct overlay_file *file);

#endif
