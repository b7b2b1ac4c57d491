/* SPDX-License-Identifier: MIT
 *
 * One picture file, with all that it holds, and whether an input can be read.
 */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "options/numbered.h"
#include "overlay/overlay.h"
#include "overlay/overlay_file.h"
#include "posix/error.h"

static enum glint_status draw(void *ctx, struct compositor *compositor,
                              const struct glint_image *image,
                              int32_t elapsed_us)
{
    (void)image;
    return overlay_file_draw(ctx, compositor, elapsed_us);
}

int overlay_picture(struct tool *tool, struct overlay *o, const char *from,
                    const char *to)
{
    struct overlay_file file;
    int code = overlay_file_open(tool, &file, &o->compositor, from, to);

    if (code != EXIT_OK)
        return code;
    if (o->compositor.sized &&
        (file.image.width != o->compositor.view.width ||
         file.image.height != o->compositor.view.height)) {
        fprintf(stderr, "glint overlay: %s: is %dx%d, those before it %dx%d\n",
                from, file.image.width, file.image.height,
                o->compositor.view.width, o->compositor.view.height);
        code = EXIT_INPUT;
    }
    if (code == EXIT_OK)
        code = overlay_draw_by(tool, o, &file.image, draw, &file);
    if (code == EXIT_OK)
        code = overlay_file_save(tool, &file, &o->compositor, o->quality);
    overlay_file_close(&file);
    return code;
}

int overlay_check_input(struct tool *tool, struct overlay *o)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    char pattern[NUMBERED_BYTES];
    struct stat file;

    if (strcmp(o->input, "-") == 0 && o->compositor.scene.control_file &&
        strcmp(o->compositor.scene.control_file, "-") == 0)
        return tool_usage(tool, "pictures and --control cannot both come from "
                                "standard input");
    if (strcmp(o->input, "-") == 0 || overlay_is_sequence(o))
        return EXIT_OK;
    if (access(o->input, F_OK) != 0 && numbered_from_hashes(pattern, o->input))
        status =
            glint_error_report(&error, GLINT_E_IO, o->input,
                               "is not there; a sequence is named %s", pattern);
    else if (stat(o->input, &file) != 0 ||
             (S_ISREG(file.st_mode) && access(o->input, R_OK) != 0))
        status = glint_error_report(&error, GLINT_E_IO, o->input, "%s",
                                    strerror(errno));
    else if (S_ISREG(file.st_mode) && file.st_size == 0)
        status =
            glint_error_report(&error, GLINT_E_FORMAT, o->input, "is empty");
    else if (S_ISREG(file.st_mode) && !o->is_video)
        o->compositor.settings.picture = o->input;
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
