/* SPDX-License-Identifier: MIT
 *
 * Tests options in files: which entries are applied, in which order, and that
 * every error is reported with its line number. A file with an error sets no
 * option.
 */
#include <unistd.h>

#include "options/config.h"
#include "support/scratch.h"
#include "options/command_line.h"
#include "support/test.h"

static const struct option options[] = {
    {"lens", required_argument, NULL, 'L'},
    {"light", required_argument, NULL, 'l'},
    {"grid", required_argument, NULL, 'g'},
    {"dither", no_argument, NULL, 'd'},
    {"balance", no_argument, NULL, 'b'},
    {"tint", optional_argument, NULL, 'T'},
    {"list-devices", no_argument, NULL, 'D'},
    {"config", required_argument, NULL, 'C'},
    TOOL_COMMON_OPTIONS};

/* A command that logs the options that it gets. It rejects some values of the
 * option grid with a message of its own. */
struct command {
    struct tool tool;
    /* "name=value;" for each option, in the order in which they were applied */
    char log[1024];
    const char *lens;
    int grid;
};

static int log_applied_option(void *ctx, const struct option *option,
                              const char *value)
{
    struct command *const c = ctx;
    const size_t used = strlen(c->log);

    snprintf(c->log + used, sizeof c->log - used, "%s=%s;", option->name,
             value ? value : "(none)");
    if (option->val == 'L')
        c->lens = value;
    if (option->val == 'D')
        return EXIT_OK;
    if (option->val == 'g' && !tool_parse_integer(value, 4, 1024, &c->grid))
        return tool_usage(&c->tool, "--%s: '%s' is not valid", option->name,
                          value);
    return -1;
}

static struct command command;
static struct glint_error error;

static struct config make_empty_config(void)
{
    command = (struct command){.tool = {.name = "live"}};
    return (struct config){.tool = &command.tool,
                           .options = options,
                           .take = log_applied_option,
                           .ctx = &command};
}

/* -------------------------------------------------------- captured messages */

static FILE *said;
static int kept_stderr;

static void capture_stderr(void)
{
    fflush(stderr);
    said = tmpfile();
    kept_stderr = dup(STDERR_FILENO);
    assert_true(said && kept_stderr >= 0 &&
                dup2(fileno(said), STDERR_FILENO) >= 0);
}

static void expect_stderr_message(const char *want)
{
    char text[1024];
    size_t n;

    fflush(stderr);
    assert_true(dup2(kept_stderr, STDERR_FILENO) >= 0);
    close(kept_stderr);
    rewind(said);
    n = fread(text, 1, sizeof text - 1, said);
    text[n] = '\0';
    fclose(said);
    assert_string_equal(text, want);
}

/* ---------------------------------------------------------- valid entries */

static void expect_options(const char *text, size_t bytes, const char *log)
{
    struct config config = make_empty_config();
    char *const exact = test_free_later(malloc(bytes + 1));

    memcpy(exact, text, bytes);
    capture_stderr();
    assert_ok(config_parse(&config, "x.ini", exact, bytes, &error));
    expect_stderr_message("");
    assert_string_equal(command.log, log);
    assert_string_equal(error.text, "");
    assert_null(command.tool.where);
    config_free(&config);
    config_free(&config);
}

TEST(applies_entries_in_order)
{
    expect_options(BYTES(""), "");
    expect_options(BYTES("\n\n"), "");
    expect_options(BYTES("grid=64"), "grid=64;");
    expect_options(
        BYTES("[lens]\nlens = heliar tronnier \n[light]\n"
              "light = 1,2\nlight = 3,4\nlens=other\n"
              "[flare]\ndither = yes\nbalance = no\ngrid: 8\n"),
        "lens=heliar "
        "tronnier;light=1,2;light=3,4;lens=other;dither=(none);grid=8;");
    expect_options(BYTES("[camera]\n[output]\nthreads=2\nquiet=yes\n"),
                   "threads=2;quiet=(none);");
    expect_options(BYTES("tint=\ntint=warm\n"), "tint=;tint=warm;");
    expect_options(BYTES("lens = stop = polygon:6\nlens: a:b\n"),
                   "lens=stop = polygon:6;lens=a:b;");
}

TEST(accepts_blanks_and_line_ends)
{
    expect_options(BYTES("\xef\xbb\xbfgrid=64\r\n  \t \r\nlens = a b\r\n"),
                   "grid=64;lens=a b;");
    expect_options(BYTES("\xef\xbb\xbf; note\n# lens=x\n ; x\n\t# y\ngrid=5"),
                   "grid=5;");
    expect_options(BYTES("grid = 7 ; cells\nlens = a;b\nlens = c # d\n"),
                   "grid=7;lens=a;b;lens=c # d;");
    /* an indented line does not continue the previous line */
    expect_options(BYTES("[lens]\n  lens = a\n  grid = 9\n\tlight=1,2\n"),
                   "lens=a;grid=9;light=1,2;");
    expect_options(BYTES("lens=\xc3\xa4\xc3\xb6.lens\nlens=\"q\"\n"),
                   "lens=\xc3\xa4\xc3\xb6.lens;lens=\"q\";");
}

/* Checks that option values remain valid after the text is freed, until
 * config_free(). */
TEST(values_outlive_the_text)
{
    struct config config = make_empty_config();
    char text[] = "lens=first\ngrid=16\ndither=yes\nlens=second";

    assert_ok(config_parse(&config, "x.ini", text, sizeof text - 1, &error));
    memset(text, 'z', sizeof text);
    assert_string_equal(command.lens, "second");
    assert_int_equal(command.grid, 16);
    config_free(&config);
}

/* ------------------------------------------------------- rejected entries */

static void expect_error(const char *text, size_t bytes, const char *want)
{
    struct config config = make_empty_config();

    assert_int_equal(config_parse(&config, "x.ini", text, bytes, &error),
                     EXIT_INPUT);
    assert_string_equal(error.text, want);
    assert_string_equal(command.log, "");
    config_free(&config);
}

TEST(reports_mistakes_with_their_line)
{
    expect_error(BYTES("grid=64\n\n[lens]\ngrdi=5\n"),
                 "x.ini:4: grdi is not an option of configuration files");
    expect_error(BYTES("--grid=64\n"),
                 "x.ini:1: --grid is not an option of configuration files");
    expect_error(BYTES("gri=64\n"),
                 "x.ini:1: gri is not an option of configuration files");
    expect_error(BYTES("config=y.ini\n"),
                 "x.ini:1: config is not an option of configuration files");
    expect_error(BYTES("help=yes"),
                 "x.ini:1: help is not an option of configuration files");
    expect_error(BYTES("grid=64\nversion=yes"),
                 "x.ini:2: version is not an option of configuration files");
    expect_error(BYTES("grid=64\nlens\n"),
                 "x.ini:2: is neither [section] nor name = value");
    expect_error(BYTES("[lens\ngrid=64\n"),
                 "x.ini:1: is neither [section] nor name = value");
    expect_error(BYTES("lens ; = x\ngrid=64\nfoo=1\n"),
                 "x.ini:1: is neither [section] nor name = value");
    expect_error(BYTES("foo=1\nlens\n"),
                 "x.ini:1: foo is not an option of configuration files");
    expect_error(BYTES("=5\n"),
                 "x.ini:1:  is not an option of configuration files");
    expect_error(BYTES("grid=\n"), "x.ini:1: grid needs a value");
    expect_error(BYTES("grid= ; 64\n"), "x.ini:1: grid needs a value");
    expect_error(BYTES("dither=maybe\n"), "x.ini:1: dither accepts yes or no");
    expect_error(BYTES("dither=\n"), "x.ini:1: dither accepts yes or no");
    expect_error(BYTES("grid=4\ndither=yes\n\ndither=no\n"),
                 "x.ini:4: dither is set twice");
    expect_error(BYTES("grid=4\nlens=a\0b\n"), "x.ini: not a text file");
    expect_error(BYTES("lens=a\x1b[2J\n"),
                 "x.ini:1: contains a control character");
    expect_error(BYTES("lens=a\rgrid=5\n"),
                 "x.ini:1: contains a control character");
}

/* Checks an error that the command itself reports: its message must be
 * preserved and get the line number. Earlier entries must be applied, later
 * ones not. */
TEST(bad_value_keeps_the_commands_message)
{
    struct config config = make_empty_config();

    capture_stderr();
    assert_int_equal(config_parse(&config, "x.ini",
                                  BYTES("lens=a\ngrid=3\nlens=b\n"), &error),
                     EXIT_INPUT);
    expect_stderr_message("glint live: x.ini:2: --grid: '3' is not valid\n");
    assert_string_equal(error.text, "");
    assert_string_equal(command.log, "lens=a;grid=3;");
    assert_null(command.tool.where);
    config_free(&config);
    config = make_empty_config();
    assert_int_equal(config_parse(&config, "x.ini",
                                  BYTES("list-devices=yes\nlens=b\n"), &error),
                     EXIT_INPUT);
    assert_string_equal(
        error.text,
        "x.ini:1: list-devices is an option of the command line only");
    config_free(&config);
}

TEST(long_file_name_keeps_the_message)
{
    char name[300];
    struct config config = make_empty_config();

    memset(name, 'n', sizeof name);
    strcpy(name + sizeof name - 7, "/x.ini");
    config_parse(&config, name, BYTES("foo=1"), &error);
    config_free(&config);
    assert_non_null(
        strstr(error.text,
               "nnn/x.ini:1: foo is not an option of configuration files"));
}

TEST(skips_unknown_sections)
{
    static const char text[] = "[lens]\nlens=a\n\n[camra]\n\ngrid=5\n"
                               "light=1,2\n[output]\nlens=b\n[]\nlens=c\n";
    struct config config = make_empty_config();

    capture_stderr();
    assert_ok(config_parse(&config, "x.ini", BYTES(text), &error));
    expect_stderr_message("glint live: x.ini:4: the section [camra] is "
                          "unknown, but its lines are used\n");
    assert_string_equal(command.log, "lens=a;grid=5;light=1,2;lens=b;lens=c;");
    config_free(&config);
    config = make_empty_config();
    command.tool.quiet = true;
    capture_stderr();
    assert_ok(config_parse(&config, "x.ini", BYTES(text), &error));
    expect_stderr_message("");
    config_free(&config);
}

/* -------------------------------------------------------------------- files */

static void write_config_file(const char *text)
{
    FILE *const file = fopen(scratch_file, "w");

    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

TEST(command_line_overrides_the_file)
{
    char *line[] = {"live",     "--grid", "32",         "in", "--conf",
                    "/nowhere", "--con",  scratch_file, "-q", NULL};
    struct config config = make_empty_config();
    const char *found;
    int c, index;

    write_config_file("lens=a\ngrid=16\n");
    found = tool_find_option_value(9, line, TOOL_COMMON_SHORT, options, 'C');
    assert_string_equal(found, scratch_file);
    assert_ok(config_read(&config, found));
    assert_int_equal(command.grid, 16);
    while ((c = getopt_long(9, line, TOOL_COMMON_SHORT, options, &index)) >= 0)
        if (c != 'C' && c != 'q')
            assert_int_equal(
                log_applied_option(&command, &options[index], optarg), -1);
    assert_int_equal(command.grid, 32);
    assert_string_equal(command.log, "lens=a;grid=16;grid=32;");
    assert_string_equal(line[optind], "in");
    assert_null(
        tool_find_option_value(3, line, TOOL_COMMON_SHORT, options, 'C'));
    config_free(&config);
}

/* Checks a file that is read again, as on SIGHUP: if it has an error, the old
 * values must remain valid. */
TEST(failed_reload_keeps_the_old_values)
{
    struct config first = make_empty_config(), second;
    const char *lens;
    char want[200];

    write_config_file("lens=a\n");
    assert_ok(config_read(&first, scratch_file));
    lens = command.lens;
    write_config_file("lens=b\ngrid=x\n");
    second = make_empty_config();
    capture_stderr();
    assert_int_equal(config_read(&second, scratch_file), EXIT_INPUT);
    snprintf(want, sizeof want, "glint live: %s:2: --grid: 'x' is not valid\n",
             scratch_file);
    expect_stderr_message(want);
    assert_null(second.lines.mem);
    assert_string_equal(lens, "a");
    config_free(&first);
}

TEST(reads_files)
{
    struct config config = make_empty_config();
    char want[200];

    write_config_file("grid=64\nfoo=1\n");
    capture_stderr();
    assert_int_equal(config_read(&config, scratch_file), EXIT_INPUT);
    snprintf(want, sizeof want,
             "glint live: %s:2: foo is not an option of configuration files\n",
             scratch_file);
    expect_stderr_message(want);
    capture_stderr();
    assert_int_equal(config_read(&config, "/nowhere/x.ini"), EXIT_INPUT);
    expect_stderr_message(
        "glint live: /nowhere/x.ini: No such file or directory\n");
    capture_stderr();
    assert_int_equal(config_read(&config, "/dev/zero"), EXIT_INPUT);
    expect_stderr_message("glint live: /dev/zero: is a device, not a file\n");
    assert_null(config.lines.mem);
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
