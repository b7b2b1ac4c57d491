/* SPDX-License-Identifier: MIT */
#include "control/controls.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "options/suggest.h"
#include "options/tool.h"
#include "posix/at_death.h"

#define MOST CONTROL_MOST_FRAME

/* clang-format off */
const struct control_form control_forms[] = {
    /* Columns: verb; command word; clause, a keyword after or between the
     * names, or NULL; number of names, and how many names follow the clause;
     * min and max count of numbers; min and max value of a number; whether
     * numbers must be integers; usage. */
    {CONTROL_ORBIT,    "orbit",       NULL,       0, 0, 2, 2, -360, 360, false,
     "orbit YAW PITCH"},
    {CONTROL_DISTANCE, "distance",    NULL,       0, 0, 1, 1, 1e-6, 1e6, false,
     "distance D"},
    {CONTROL_SENSOR,   "camera",      "sensor",   0, 0, 1, 1, 1, 32, true,
     "camera sensor K"},
    {CONTROL_SCENE,    "camera",      "scene",    0, 0, 0, 0, 0, 0, false,
     "camera scene"},
    {CONTROL_WALK,     "walk",        NULL,       0, 0, 3, 3, -1e6, 1e6, false,
     "walk RIGHT UP AHEAD"},
    {CONTROL_LOOK,     "look",        NULL,       0, 0, 3, 3, -360, 360, false,
     "look YAW PITCH ROLL"},
    {CONTROL_ALPHA,    "set",         "alpha",    1, 0, 1, 2, .001, 1, false,
     "set MATERIAL alpha X [Y]"},
    {CONTROL_COLOUR,   "set",         "colour",   1, 0, 3, 3, 0, 1, false,
     "set MATERIAL colour R G B"},
    {CONTROL_DIFFUSE,  "set",         "diffuse",  1, 0, 3, 3, 0, 1, false,
     "set MATERIAL diffuse R G B"},
    {CONTROL_MATERIAL, "material",    NULL,       2, 0, 0, 0, 0, 0, false,
     "material THING MATERIAL"},
    {CONTROL_SHOW,     "show",        NULL,       1, 0, 0, 0, 0, 0, false,
     "show THING"},
    {CONTROL_HIDE,     "hide",        NULL,       1, 0, 0, 0, 0, 0, false,
     "hide THING"},
    {CONTROL_SIZE,     "size",        NULL,       1, 0, 1, 1, 1e-6, 1e6, false,
     "size BALL RADIUS"},
    {CONTROL_TURN,     "environment", "turn",     0, 0, 1, 1, -360, 360, false,
     "environment turn DEG"},
    {CONTROL_SCALE,    "environment", "scale",    0, 0, 1, 1, 1e-6, 1e6, false,
     "environment scale X"},
    {CONTROL_MAP,      "environment", "map",      0, 1, 0, 0, 0, 0, false,
     "environment map NAME"},
    {CONTROL_NEXT_MAP, "environment", "next",     0, 0, 0, 0, 0, 0, false,
     "environment next"},
    {CONTROL_STEP,     "step",        NULL,       0, 0, 0, 1, -MOST, MOST, true,
     "step [N]"},
    {CONTROL_JUMP,     "jump",        NULL,       0, 0, 1, 1, 0, MOST, true,
     "jump N"},
    {CONTROL_PLAY,     "play",        NULL,       0, 0, 0, 1, 0, 120, false,
     "play [FRAMES A SECOND]"},
    {CONTROL_PAUSE,    "pause",       NULL,       0, 0, 0, 0, 0, 0, false,
     "pause"},
    {CONTROL_STOP,     "stop",        NULL,       0, 0, 0, 0, 0, 0, false,
     "stop"},
};
/* clang-format on */
const int control_n_forms = sizeof control_forms / sizeof *control_forms;

static bool can_control_change_option(const struct glint_option *option)
{
    return option->changes == GLINT_OPTION_FRAME &&
           option->type == GLINT_OPTION_REAL;
}

static const char blanks[] = " \t\r\n";

/* Parser state of one line */
struct reader {
    /* text of the line, and the position after the word read last */
    const char *text, *at;
    const char *where;
    char word[CONTROL_LINE];
    int column; /* column of the word read last, or of the line's end */
    struct glint_error *error;
};

enum glint_status control_set_line_error(struct glint_error *error,
                                         const char *where, int column,
                                         const char *format, ...)
{
    char cause[sizeof error->text], place[sizeof error->text];
    va_list values;

    va_start(values, format);
    vsnprintf(cause, sizeof cause, format, values);
    va_end(values);
    snprintf(place, sizeof place, "%.160s:%d", where, column);
    return glint_error_report(error, GLINT_E_FORMAT, place, "%s", cause);
}

/* Reads the next word of the line. Returns false at the line's end. */
static bool read_next_word(struct reader *r)
{
    const char *const from = r->at + strspn(r->at, blanks);
    const size_t n = *from == '#' ? 0 : strcspn(from, blanks);

    r->column = (int)(from - r->text) + 1;
    r->at = from + n;
    memcpy(r->word, from, n);
    r->word[n] = '\0';
    return n > 0;
}

static struct reader peek_next_word(const struct reader *r)
{
    struct reader ahead = *r;

    read_next_word(&ahead);
    return ahead;
}

/* ---------------------------------------------------------------- the form */

/* Reports an unknown word and suggests a similar one. BEFORE: the command to
 * which it belongs; NULL: the word is itself a command. */
static enum glint_status report_unknown_word(const struct reader *r,
                                             const char *before)
{
    struct suggest suggest;

    suggest_begin(&suggest, r->word);
    for (int i = 0; i < control_n_forms; i++) {
        const struct control_form *const f = &control_forms[i];
        const char *const may = before ? f->clause : f->word;

        if (may && (!before || strcmp(before, f->word) == 0))
            suggest_add_candidate(&suggest, may, strlen(may));
    }
    for (int i = 0; !before && i < GLINT_N_OPTIONS; i++)
        if (can_control_change_option(glint_option(i)))
            suggest_add_candidate(&suggest, glint_option(i)->name,
                                  strlen(glint_option(i)->name));
    return control_set_line_error(
        r->error, r->where, r->column, "'%.24s' is not a %s%s%s", r->word,
        before ? "word of " : "command", before ? before : "",
        suggest_from_words(&suggest));
}

/* Returns the first row of control_forms, from index I on, whose command word
 * is WORD, or NULL. */
static const struct control_form *find_command_form(const char *word, int i)
{
    for (; i < control_n_forms; i++)
        if (strcmp(control_forms[i].word, word) == 0)
            return &control_forms[i];
    return NULL;
}

static enum glint_status read_command_names(struct reader *r,
                                            const struct control_form *form,
                                            int n, struct control_line *line)
{
    for (int i = 0; i < n; i++) {
        if (!read_next_word(r))
            return control_set_line_error(r->error, r->where, r->column,
                                          "expected %s", form->usage);
        if (strlen(r->word) >= CONTROL_NAME)
            return control_set_line_error(r->error, r->where, r->column,
                                          "a name has at most 31 letters");
        memcpy(line->name[i], r->word, strlen(r->word) + 1);
        line->name_column[i] = r->column;
    }
    return GLINT_OK;
}

/* Reads the clause if FORM has one. Sets FORM to the row of the same command
 * word that has this clause. */
static enum glint_status read_command_clause(struct reader *r,
                                             const struct control_form **form)
{
    const struct control_form *f = *form;

    if (!f->clause)
        return GLINT_OK;
    if (!read_next_word(r))
        return control_set_line_error(r->error, r->where, r->column,
                                      "expected %s", f->usage);
    for (; f; f = find_command_form(f->word, (int)(f - control_forms) + 1))
        if (strcmp(f->clause, r->word) == 0) {
            *form = f;
            return GLINT_OK;
        }
    return report_unknown_word(r, (*form)->word);
}

static enum glint_status read_command_numbers(struct reader *r,
                                              const struct control_form *form,
                                              struct control_line *line)
{
    line->column = peek_next_word(r).column;
    while (line->n < form->most && read_next_word(r)) {
        double v;

        if (!tool_parse_number(r->word, &v))
            return control_set_line_error(
                r->error, r->where, r->column,
                "'%.24s' is not a number; expected %s", r->word, form->usage);
        if (!(v >= form->lowest && v <= form->highest))
            return control_set_line_error(r->error, r->where, r->column,
                                          "%s must be %.9g to %.9g, not %.9g",
                                          form->usage, form->lowest,
                                          form->highest, v);
        if (form->is_whole && v != rint(v))
            return control_set_line_error(r->error, r->where, r->column,
                                          "%s needs whole numbers, not %.9g",
                                          form->usage, v);
        line->v[line->n++] = v;
    }
    return line->n >= form->least
               ? GLINT_OK
               : control_set_line_error(r->error, r->where, r->column,
                                        "expected %s", form->usage);
}

/* -------------------------------------------------------------------- line */

static enum glint_status read_frame_number(struct reader *r,
                                           struct control_line *line)
{
    const struct reader ahead = peek_next_word(r);
    double v;

    if (!strchr("+-.0123456789", *ahead.word) || !*ahead.word)
        return GLINT_OK;
    *r = ahead;
    if (!tool_parse_number(r->word, &v) ||
        !(v >= 0 && v <= CONTROL_MOST_FRAME) || v != rint(v))
        return control_set_line_error(
            r->error, r->where, r->column,
            "a frame must be a whole number from 0 to 1000000000, not '%.24s'",
            r->word);
    line->frame = (int)v;
    return GLINT_OK;
}

static enum glint_status read_option_value(struct reader *r,
                                           const struct glint_option *option,
                                           const struct control_form *form,
                                           struct control_line *line)
{
    struct glint_options options;
    struct glint_error error;
    char accepts[CONTROL_WHERE];
    enum glint_status status;

    snprintf(line->name[0], CONTROL_NAME, "%s", option->name);
    line->name_column[0] = r->column;
    status = read_command_numbers(r, form, line);
    glint_options_defaults(&options);
    if (status != GLINT_OK || glint_options_set(&options, option->name,
                                                line->v[0], &error) == GLINT_OK)
        return status;
    glint_option_accepts(option, accepts, sizeof accepts);
    return control_set_line_error(r->error, r->where, line->column,
                                  "%s must be %s, not %.9g", option->name,
                                  accepts, line->v[0]);
}

static enum glint_status read_command_words(struct reader *r,
                                            struct control_line *line)
{
    struct control_form set = {CONTROL_OPTION, NULL,     NULL,  0,   0, 1, 1,
                               -HUGE_VAL,      HUGE_VAL, false, NULL};
    const struct control_form *form = &set;
    const struct glint_option *option;
    char usage[CONTROL_LINE];
    enum glint_status status;

    if (!read_next_word(r))
        return line->frame < 0 ? GLINT_OK
                               : control_set_line_error(
                                     r->error, r->where, r->column,
                                     "a command must follow the frame number");
    option = glint_option_named(r->word);
    if (option && can_control_change_option(option)) {
        snprintf(usage, sizeof usage, "%s %s", option->name, option->value);
        set.usage = usage;
        status = read_option_value(r, option, form, line);
    } else {
        form = find_command_form(r->word, 0);
        if (!form)
            return report_unknown_word(r, NULL);
        status = read_command_names(r, form, form->names, line);
        if (status == GLINT_OK)
            status = read_command_clause(r, &form);
        if (status == GLINT_OK)
            status = read_command_names(r, form, form->behind, line);
        if (status == GLINT_OK)
            status = read_command_numbers(r, form, line);
    }
    if (status == GLINT_OK && read_next_word(r))
        status = control_set_line_error(
            r->error, r->where, r->column,
            "'%.24s' is one value too many; expected %s", r->word, form->usage);
    line->verb = form->verb;
    return status;
}

enum glint_status control_parse_line(const char *text, const char *where,
                                     struct control_line *line,
                                     struct glint_error *error)
{
    struct reader r = {
        .text = text, .at = text, .where = where, .error = error};
    struct control_line read = {.frame = -1};
    enum glint_status status;

    if (strlen(text) >= CONTROL_LINE)
        return control_set_line_error(error, where, CONTROL_LINE,
                                      "a line has at most %d bytes",
                                      CONTROL_LINE - 1);
    status = read_frame_number(&r, &read);
    if (status == GLINT_OK)
        status = read_command_words(&r, &read);
    if (status == GLINT_OK)
        *line = read;
    return status;
}

/* Changes by a single key press: STEP_DEG is added to angles; the factors
 * multiply distances, slopes of brushed metal and the light of the
 * environment. */
#define STEP_DEG 3
#define NEARER   0.95
#define SMOOTHER 0.87
#define DIMMER   0.8

const char keyboard_help[] =
    "keys: arrows orbit, + - distance, [ ] turn the environment, { } its "
    "light, "
    "e next environment, a A slopes of brushed metal, m next material, space "
    "pause, . , step, s stop, q end";

static const struct {
    const char *bytes;
    struct control_line line;
} keys[] = {
    {"\033[A", {.verb = CONTROL_ORBIT, .n = 2, .v = {0, STEP_DEG}}},
    {"\033[B", {.verb = CONTROL_ORBIT, .n = 2, .v = {0, -STEP_DEG}}},
    {"\033[C", {.verb = CONTROL_ORBIT, .n = 2, .v = {STEP_DEG, 0}}},
    {"\033[D", {.verb = CONTROL_ORBIT, .n = 2, .v = {-STEP_DEG, 0}}},
    {"+", {.verb = CONTROL_DISTANCE, .n = 1, .v = {NEARER}}},
    {"=", {.verb = CONTROL_DISTANCE, .n = 1, .v = {NEARER}}},
    {"-", {.verb = CONTROL_DISTANCE, .n = 1, .v = {1 / NEARER}}},
    {"[", {.verb = CONTROL_TURN, .n = 1, .v = {-STEP_DEG}}},
    {"]", {.verb = CONTROL_TURN, .n = 1, .v = {STEP_DEG}}},
    {"{", {.verb = CONTROL_SCALE, .n = 1, .v = {DIMMER}}},
    {"}", {.verb = CONTROL_SCALE, .n = 1, .v = {1 / DIMMER}}},
    {"e", {.verb = CONTROL_NEXT_MAP}},
    {"a", {.verb = CONTROL_ALPHA, .n = 1, .v = {SMOOTHER}}},
    {"A", {.verb = CONTROL_ALPHA, .n = 1, .v = {1 / SMOOTHER}}},
    {"m", {.verb = CONTROL_MATERIAL}},
    {" ", {.verb = CONTROL_PAUSE}},
    {".", {.verb = CONTROL_STEP, .n = 1, .v = {1}}},
    {",", {.verb = CONTROL_STEP, .n = 1, .v = {-1}}},
    {"s", {.verb = CONTROL_STOP}},
};

enum { N_KEYS = (int)(sizeof keys / sizeof *keys) };

/* terminal settings to restore when the process ends */
static struct termios before;
static volatile sig_atomic_t terminal = -1;

static void restore_terminal(void)
{
    if (terminal >= 0)
        tcsetattr(terminal, TCSANOW, &before);
}

enum glint_status keyboard_open(struct keyboard *k, int fd)
{
    struct termios raw;

    *k = (struct keyboard){.fd = -1};
    if (tcgetattr(fd, &before) != 0)
        return GLINT_E_IO;
    k->fd = fd;
    glint_at_death_register(restore_terminal);
    terminal = fd;
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    /* tcsetattr() would stop a process that runs in the background. */
    if (tcgetpgrp(fd) == getpgrp())
        tcsetattr(fd, TCSANOW, &raw);
    return GLINT_OK;
}

/* Returns the number of bytes of the first key in TEXT[N]: 1, or the length of
 * an escape sequence, which ends with a letter. */
static int get_first_key_length(const char *text, int n)
{
    int i = 2;

    if (n < 2 || text[0] != '\033' || text[1] != '[')
        return 1;
    while (i < n && (text[i] < '@' || text[i] > '~'))
        i++;
    return i < n ? i + 1 : n;
}

int keyboard_parse_key(const char *text, int n, struct control_line *line)
{
    const int length = get_first_key_length(text, n);

    *line = (struct control_line){.frame = -1};
    for (int i = 0; i < N_KEYS; i++)
        if ((int)strlen(keys[i].bytes) == length &&
            memcmp(keys[i].bytes, text, (size_t)length) == 0) {
            *line = keys[i].line;
            line->frame = -1;
            line->is_change = true;
        }
    return length;
}

/* Reads pressed keys into K. Returns false if there are none. */
static bool read_pressed_keys(struct keyboard *k)
{
    struct pollfd there = {.fd = k->fd, .events = POLLIN};
    ssize_t n = 0;

    if (k->fd >= 0 && tcgetpgrp(k->fd) == getpgrp() && poll(&there, 1, 0) > 0)
        n = read(k->fd, k->bytes, sizeof k->bytes);
    k->at = 0;
    k->n = n > 0 ? (int)n : 0;
    return n > 0;
}

bool keyboard_next_command(struct keyboard *k, struct control_line *line)
{
    while (k->at < k->n || read_pressed_keys(k)) {
        if (k->bytes[k->at] == 'q')
            raise(SIGINT);
        k->at += keyboard_parse_key(k->bytes + k->at, k->n - k->at, line);
        if (line->verb != CONTROL_NONE)
            return true;
    }
    return false;
}

static void close_keyboard(struct keyboard *k)
{
    if (k->fd >= 0)
        restore_terminal();
    terminal = -1;
    k->fd = -1;
}

enum { MAX_BYTES = 1 << 28 };

static void format_line_location(const struct controls *in, int number,
                                 char *where)
{
    const char *const name =
        strcmp(in->lines.name, "-") == 0 ? "control" : in->lines.name;

    snprintf(where, CONTROL_WHERE, number > 0 ? "%.140s:%d" : "%.140s", name,
             number);
}

static enum glint_status parse_control_line(const struct controls *in,
                                            const char *text,
                                            struct control_line *line,
                                            struct glint_error *error)
{
    char where[CONTROL_WHERE];
    enum glint_status status;

    format_line_location(in, in->lines.number, where);
    status = control_parse_line(text, where, line, error);
    line->number = in->lines.number;
    return status;
}

static enum glint_status parse_all_control_lines(struct controls *in,
                                                 struct glint_error *error)
{
    enum glint_status status = GLINT_OK;
    struct control_line line = {.verb = CONTROL_NONE};
    const char *text;

    while (status == GLINT_OK &&
           (text = text_lines_read_untrimmed(&in->lines))) {
        struct control_line *const more =
            text_grow_array(in->row, in->n, sizeof *more);

        if (!more)
            return glint_error_report(error, GLINT_E_MEMORY, in->lines.name,
                                      "%s", text_no_memory);
        in->row = more;
        status = parse_control_line(in, text, &line, error);
        if (status == GLINT_OK && line.verb != CONTROL_NONE)
            more[in->n++] = line;
    }
    return status;
}

enum glint_status controls_open(struct controls *input, const char *path,
                                bool is_live, struct glint_error *error)
{
    struct controls *const in = input;
    const bool is_input = strcmp(path, "-") == 0;
    enum glint_status status;

    *in = (struct controls){
        .is_open = true, .lines = {.name = path}, .read_at = -1};
    if (is_input && is_live && isatty(STDIN_FILENO)) {
        in->is_keys = keyboard_open(&in->keys, STDIN_FILENO) == GLINT_OK;
        return in->is_keys ? GLINT_OK
                           : glint_error_report(error, GLINT_E_IO, path, "%s",
                                                strerror(errno));
    }
    if (is_live && (is_input || text_is_named_pipe(path)))
        return text_lines_open_pipe(&in->lines, path, error);
    status = text_lines_open(&in->lines, path, NULL, MAX_BYTES, error);
    if (status == GLINT_OK)
        status = parse_all_control_lines(in, error);
    text_lines_close(&in->lines);
    if (status != GLINT_OK)
        controls_close(in);
    return status;
}

void controls_close(struct controls *input)
{
    text_lines_close(&input->lines);
    if (input->is_open && input->is_keys)
        close_keyboard(&input->keys);
    free(input->row);
    *input = (struct controls){.is_open = false};
}

/* -------------------------------------------------------------------- lines */

/* Reads the next command of the pipe into in->ahead. Returns false if none
 * has arrived. */
static bool read_next_pipe_command(struct controls *in)
{
    const char *text;

    while (in->lines.is_pipe &&
           (text = text_lines_read_untrimmed(&in->lines))) {
        struct glint_error error;

        if (parse_control_line(in, text, &in->ahead, &error) != GLINT_OK)
            controls_reject_line(in, &error);
        else if (in->ahead.verb != CONTROL_NONE)
            return true;
    }
    return false;
}

const struct control_line *controls_next_line(struct controls *input,
                                              int picture)
{
    struct controls *const in = input;

    if (!in->is_open)
        return NULL;
    if (in->is_keys)
        return keyboard_next_command(&in->keys, &in->ahead) ? &in->ahead : NULL;
    if (in->next < in->n)
        return in->row[in->next].frame > picture ? NULL : &in->row[in->next++];
    if (in->read_at != picture)
        text_lines_reset_read_limit(&in->lines);
    in->read_at = picture;
    in->has_ahead = in->has_ahead || read_next_pipe_command(in);
    if (!in->has_ahead || in->ahead.frame > picture)
        return NULL;
    in->has_ahead = false;
    return &in->ahead;
}

const struct control_line *controls_get_line(const struct controls *input,
                                             int i)
{
    return i < input->n ? &input->row[i] : NULL;
}

void controls_format_location(const struct controls *input, int i, char *where)
{
    const int row = i >= 0 ? i : input->next - 1;

    format_line_location(input,
                         input->is_keys ? 0
                         : row >= 0     ? input->row[row].number
                                        : input->ahead.number,
                         where);
}

void controls_reject_line(struct controls *input,
                          const struct glint_error *error)
{
    input->n_bad++;
    input->bad = *error;
}
