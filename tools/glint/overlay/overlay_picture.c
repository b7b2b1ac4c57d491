/* SPDX-License-Identifier: MIT
 *
 * One picture file, with all that it holds, and whether an input can be read.
 */
#include "overlay/overlay.h"
#include "overlay/overlay_file.h"

static enum glint_status draw(void *ctx, struct drawing *drawing,
                              const struct glint_image *image,
                              int32_t elapsed_us)
{
    (void)image;
    return overlay_file_draw(ctx, drawing, elapsed_us);
}

int overlay_picture(struct tool *tool, struct overlay *o, const char *from,
                    const char *to)
{
    struct overlay_file file;
    int code = overlay_file_open(tool, &file, &o->drawing, from, to);

    if (code != EXIT_OK)
        return code;
    if (o->drawing.run.is_sized &&
        (file.image.width != o->drawing.run.view.width ||
         file.image.height != o->drawing.run.view.height)) {
        fprintf(stderr, "glint overlay: %s: is %dx%d, those before it %dx%d\n",
                from, file.image.width, file.image.height,
                o->drawing.run.view.width, o->drawing.run.view.height);
        code = EXIT_INPUT;
    }
    if (code == EXIT_OK)
        code = overlay_draw_by(tool, o, &file.image, draw, &file);
    if (code == EXIT_OK)
        code = overlay_file_save(tool, &file, &o->drawing, o->quality);
    overlay_file_close(&file);
    return code;
}
