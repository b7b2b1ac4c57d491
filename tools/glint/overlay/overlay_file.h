/* SPDX-License-Identifier: MIT
 *
 * A picture file on its way through overlay: opened, lit, and written.
 *
 *     overlay_file_open(&tool, &file, &drawing, "in.exr", "out.exr");
 *     overlay_file_draw(&file, &drawing, elapsed_us);
 *     overlay_file_save(&tool, &file, &drawing, quality);
 *     overlay_file_close(&file);
 *
 * Opaque sRGB of 8 bits is drawn on as it is, in integers. Of all other
 * pictures the finder sees a proxy of 8 bits, the light of lamps is measured in
 * floats where the file has them, and the flare is added in linear light to the
 * samples that it reaches. A file on which nothing is drawn is copied if the
 * output has the same type.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_FILE_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_FILE_H

#include "overlay/drawing.h"
#include "formats/picture.h"

struct overlay_file {
    /* Picture in which lamps are found; its size is for drawing_size(). */
    struct glint_image image;

    /* Private. */
    const char *from, *to;
    struct glint_kept kept;
    struct glint_samples work; /* a deeper copy of the input, for floats out */
    /* is_direct: IMAGE is the file's own samples and is drawn on; is_copied:
     * light is added to WORK, not to the file's samples */
    bool is_direct, is_copied;
    double white; /* light of the proxy's white */
    float *layer;
};

/* Opens FROM, which is to be written to TO. Both strings must outlive FILE.
 * Returns an exit code. */
int overlay_file_open(const struct tool *tool, struct overlay_file *file,
                      const struct drawing *drawing, const char *from,
                      const char *to);

/* Adds the flare to a picture that comes ELAPSED_US after the one before.
 * GLINT_E_MEMORY. */
enum glint_status overlay_file_draw(struct overlay_file *file,
                                    struct drawing *drawing,
                                    int32_t elapsed_us);

/* Writes the picture to its output, with QUALITY as in glint_kept_options.
 * Returns an exit code. */
int overlay_file_save(const struct tool *tool, struct overlay_file *file,
                      const struct drawing *drawing, int quality);

/* Closes FILE, unless it is closed already. */
void overlay_file_close(struct overlay_file *file);

#endif
