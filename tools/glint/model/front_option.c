/* SPDX-License-Identifier: MIT */
#include "model/front_option.h"

#include <stdlib.h>

#include "model/stop_option.h"

int front_option_open(const struct tool *tool,
                      const struct front_option *option,
                      struct glint_front_dirt **dirt)
{
    struct glint_front front = option->front;
    struct stop_mask mask = {NULL, 0, 0};
    struct glint_error error = {""};
    enum glint_status status;
    int code = EXIT_OK;

    *dirt = NULL;
    if (!front_option_asked(option))
        return EXIT_OK;
    if (option->mask_file)
        code = stop_mask_read(tool, option->mask_file, &mask);
    if (code != EXIT_OK)
        return code;
    front.mask = mask.luma;
    front.mask_width = mask.width;
    front.mask_height = mask.height;
    status = glint_front_make(dirt, &front, &error);
    free(mask.luma);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
