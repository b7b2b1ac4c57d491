/* SPDX-License-Identifier: MIT */
#include "model/front_option.h"

#include <stdlib.h>

#include "model/stop_option.h"

int front_option_open(const struct tool *tool, struct front_option *option)
{
    struct glint_front front = option->front;
    struct glint_error error = {""};
    enum glint_status status;
    uint8_t *mask = NULL;
    int code = EXIT_OK;

    if (!front_option_asked(option) || option->dirt)
        return EXIT_OK;
    if (option->mask_file)
        code = stop_mask_read(tool, option->mask_file, &mask, &front.mask_width,
                              &front.mask_height);
    if (code != EXIT_OK)
        return code;
    front.mask = mask;
    status = glint_front_make(&option->dirt, &front, &error);
    free(mask);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void front_option_close(struct front_option *option)
{
    glint_front_free(option->dirt);
    option->dirt = NULL;
}
