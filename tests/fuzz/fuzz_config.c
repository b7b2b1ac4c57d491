/* SPDX-License-Identifier: MIT
 *
 * Parses random bytes as a configuration file. The callback must receive
 * existing options with values of the right type and without control
 * characters. A rejected file must have set nothing, and parsing a file again
 * must set the same options.
 *
 *     make fuzz FUZZ=config SECONDS=60
 */
#include "fuzz/fuzz.h"
#include "options/config.h"
#include "options/command_line.h"

static const struct option options[] = {{"lens", required_argument, NULL, 'L'},
                                        {"tint", optional_argument, NULL, 'T'},
                                        {"dither", no_argument, NULL, 'd'},
                                        TOOL_COMMON_OPTIONS};

struct taken {
    int n;
    size_t bytes;
    /* last value that the callback received; valid until config_free() */
    const char *last;
};

static int check_config_option(void *ctx, const struct option *option,
                               const char *value)
{
    struct taken *const t = ctx;

    require(option >= options && option->name);
    require(option->val != 'h' && option->val != 'V');
    require((option->has_arg == no_argument) == !value);
    require(option->has_arg != required_argument || *value);
    for (const char *c = value ? value : ""; *c; c++)
        require((unsigned char)*c >= ' ' || *c == '\t');
    t->n++;
    t->bytes += value ? strlen(value) : 0;
    t->last = value ? value : t->last;
    require(t->bytes < 1 << 20);
    return t->last && *t->last == '!' ? EXIT_USAGE : -1;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct tool tool = {.name = "fuzz", .quiet = true};
    struct taken first = {0}, second = {0};
    struct config config = {.tool = &tool,
                            .options = options,
                            .take = check_config_option,
                            .ctx = &first};
    struct glint_error error;
    const int code =
        config_parse(&config, "f", (const char *)data, size, &error);

    require(!tool.where);
    require(code == EXIT_OK || code == EXIT_USAGE || error.text[0]);
    require(code != EXIT_INPUT || first.n == 0);
    if (first.last)
        require(strlen(first.last) < size);
    config_free(&config);
    config.ctx = &second;
    require(config_parse(&config, "f", (const char *)data, size, &error) ==
            code);
    require(second.n == first.n && second.bytes == first.bytes);
    config_free(&config);
    return 0;
}
