/* SPDX-License-Identifier: MIT
 *
 * Replaces config.c in builds without inih.
 */
#include "options/config.h"

#include "posix/error.h"

int config_read(struct config *config, const char *path)
{
    struct glint_error error;
    const int code = config_parse(config, path, "", 0, &error);

    fprintf(stderr, "glint %s: %s\n", config->tool->name, error.text);
    return code;
}

int config_parse(struct config *config, const char *name, const char *text,
                 size_t bytes, struct glint_error *error)
{
    (void)config, (void)text, (void)bytes;
    glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                       "--config: glint was built without inih, which reads "
                       "these files");
    return EXIT_INPUT;
}

void config_free(struct config *config)
{
    (void)config;
}
