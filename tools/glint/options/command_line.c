/* SPDX-License-Identifier: MIT */
#include "options/command_line.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "help/help.h"
#include "help/values.h"
#include "glint/glint.h"
#include "linux/sets.h"
#include "options/json_writer.h"
#include "options/suggest.h"

/* Enables only the instruction sets of VALUE, a word of --kernels. Returns
 * false if the word is unknown or this CPU lacks such a set. */
static bool parse_instruction_sets(struct tool *tool, const char *value)
{
    static const char *const words[] = {"c",    "sse41", "avx2",
                                        "neon", "auto",  NULL};
    static const unsigned sets[] = {0, GLINT_SET_SSE41,
                                    GLINT_SET_SSE41 | GLINT_SET_AVX2,
                                    GLINT_SET_NEON, ~0U};
    const int word = tool_find_word_index(value, words);

    if (word < 0 || (word < 4 && (sets[word] & ~glint_system_sets())))
        return false;
    tool->sets_off = ~sets[word];
    tool->kernels = words[word];
    return true;
}

static char **line;
/* option table of the command, which --options prints */
static const struct option *taken;

void tool_set_command_line(char **argv)
{
    line = argv;
}

/* Sets NAME to the long option, without its value, that getopt_long() read
 * last. Returns false if there is none. */
static bool find_last_option(char name[SUGGEST_CHARS])
{
    const char *text = line && optind > 0 ? line[optind - 1] : NULL;
    size_t n;

    if (!text || strncmp(text, "--", 2) != 0)
        return false;
    n = strcspn(text + 2, "=");
    if (n == 0 || n >= SUGGEST_CHARS)
        return false;
    memcpy(name, text + 2, n);
    name[n] = '\0';
    return true;
}

static void suggest_option(const struct tool *tool)
{
    struct suggest s;
    char name[SUGGEST_CHARS];

    if (find_last_option(name)) {
        suggest_begin(&s, name);
        for (const struct option *o = taken; o && o->name; o++)
            suggest_add_candidate(&s, o->name, strlen(o->name));
        if (suggest_find_best(&s) && s.distance > 0)
            fprintf(stderr, "Did you mean --%s? ", s.best);
    }
    fprintf(stderr, "Try 'glint %s --help'.\n", tool->name);
}

static bool has_option_name(const struct option *options, const char *name)
{
    while (options->name && strcmp(options->name, name) != 0)
        options++;
    return options->name != NULL;
}

const struct option *engine_build_options(struct tool *tool, unsigned groups,
                                          const struct glint_options *defaults,
                                          const struct option *own)
{
    static struct glint_options initial;
    static const struct option common[] = {TOOL_COMMON_OPTIONS};
    static struct option all[192];
    const struct glint_option *row;
    int n = 0;

    initial = *defaults;
    tool->groups = groups;
    tool->defaults = &initial;
    for (const struct option *o = own; o->name; o++)
        all[n++] = *o;
    for (int i = 0; (row = glint_option(i)) != NULL; i++)
        if (groups >> row->group & 1 && !has_option_name(own, row->name))
            all[n++] = (struct option){row->name,
                                       row->type == GLINT_OPTION_FLAG
                                           ? no_argument
                                           : required_argument,
                                       NULL, ENGINE_OPTION + i};
    memcpy(all + n, common, sizeof common);
    return all;
}

int tool_getopt(int argc, char *const *argv, const char *shorts,
                const struct option *options, int *index)
{
    taken = options;
    return getopt_long(argc, argv, shorts, options, index);
}

/* Prints the version and the kernels that this CPU runs. */
static void print_version(bool is_json)
{
    static const struct {
        unsigned set;
        const char *name;
    } kernels[] = {{GLINT_SET_SSE41, "sse41"},
                   {GLINT_SET_AVX2, "avx2"},
                   {GLINT_SET_NEON, "neon"}};
    struct json_writer json = {stdout, false};

    if (is_json)
        json_write(&json, "{name: %s, version: %s, kernels: [%s", "glint",
                   GLINT_VERSION, "c");
    else
        printf("glint %s (kernels: c", GLINT_VERSION);
    for (int i = 0; i < 3; i++)
        if (!(glint_system_sets() & kernels[i].set))
            continue;
        else if (is_json)
            json_write(&json, "%s", kernels[i].name);
        else
            printf(" %s", kernels[i].name);
    if (is_json)
        json_write(&json, "], licence: %s}\n", "MIT");
    else
        puts("; MIT licence)");
}

int tool_apply_option(struct tool *tool, int option, const char *value)
{
    static char of_engine[ENGINE_HELP_BYTES];
    const struct help help = {tool->name,
                              {tool->help, of_engine, tool->help_end}};

    engine_write_help(tool, of_engine);

    switch (option) {
    case 'h':
        help_print_screen(&help);
        return EXIT_OK;
    case TOOL_HELP_ALL:
        help_print_complete(&help);
        return EXIT_OK;
    case TOOL_OPTIONS:
        if (!value)
            help_print_options(&help, taken);
        values_print_words(tool->name, value);
        return EXIT_OK;
    case 'V':
        print_version(tool->json);
        return EXIT_OK;
    case 'q':
        tool->quiet = true;
        return -1;
    case 'v':
        tool->verbose++;
        return -1;
    case 'J':
        tool->json = true;
        return -1;
    case 'j':
        if (tool_parse_integer(value, 1, GLINT_MAX_WORKERS, &tool->n_threads))
            return -1;
        return tool_usage(tool, "--threads must be 1 to %d, not '%s'",
                          GLINT_MAX_WORKERS, value);
    case 'K':
        if (parse_instruction_sets(tool, value))
            return -1;
        return tool_usage(tool,
                          "--kernels must be c, auto or an instruction set of "
                          "this CPU (glint --version), not '%s'",
                          value);
    case 'S':
        if (tool_parse_integer(value, 0, INT_MAX, &tool->seed))
            return -1;
        return tool_usage(tool,
                          "--seed must be a whole number, 0 to %d, not '%s'",
                          INT_MAX, value);
    default: /* getopt_long() has printed the error */
        if (tool->cause)
            snprintf(tool->cause->text, sizeof tool->cause->text,
                     "%s: unknown, ambiguous or without its value",
                     line && optind > 0 ? line[optind - 1] : "options");
        suggest_option(tool);
        return EXIT_USAGE;
    }
}

const char *tool_find_option_value(int argc, char **argv, const char *shorts,
                                   const struct option *options, int option)
{
    /* getopt_long() reorders the words, so it works on a copy. After
     * reordering, a last option without its value would consume the input in
     * the second pass. */
    char **const words = malloc(((size_t)argc + 1) * sizeof *words);
    const char *value = NULL;
    int c;

    if (!words)
        return NULL;
    memcpy(words, argv, ((size_t)argc + 1) * sizeof *words);
    opterr = 0;
    optind = 0; /* resets glibc's and musl's getopt to the beginning */
    while ((c = getopt_long(argc, words, shorts, options, NULL)) >= 0)
        if (c == option)
            value = optarg;
    opterr = 1;
    optind = 0;
    free(words);
    return value;
}

int tool_check_inputs(const struct tool *tool, int argc, char **argv, int n,
                      const char *text)
{
    const char *const last = argv[optind - 1];

    if (optind + n == argc)
        return -1;
    /* getopt_long() has moved inputs behind all options. So LAST is the value
     * of an option. */
    if (optind + n < argc || optind < 3 || last[0] == '-')
        return tool_usage(tool, "%s", text);
    return tool_usage(tool, "%s; '%s' is the value of %s", text, last,
                      argv[optind - 2]);
}

int tool_parse_options(struct tool *tool, int argc, char **argv,
                       const char *shorts, const struct option *options,
                       tool_take_fn *take, void *ctx)
{
    int c, code, index = 0;

    while ((c = tool_getopt(argc, argv, shorts, options, &index)) >= 0) {
        code = take(tool, ctx, c, optarg);
        if (code == -2)
            return tool_report_bad_value(tool, options[index].name, optarg);
        if (code >= 0)
            return code;
    }
    return -1;
}
