/* SPDX-License-Identifier: MIT */
#include "control/control.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "options/suggest.h"
#include "options/tool.h"

#define MOST CONTROL_MOST_FRAME

/* clang-format off */
const struct control_form control_forms[] = {
    /* verb             word           clause    names, behind it; numbers, from, to, whole */
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
    {CONTROL_ZOOM,     "zoom",        NULL,       0, 0, 1, 1, 0, 1e5, false,
     "zoom Z"},
};
/* clang-format on */
const int control_n_forms = sizeof control_forms / sizeof *control_forms;

static const char blanks[] = " \t\r\n";

/* A line while it is read, word by word. */
struct reader {
    const char *text, *at; /* AT: behind the last word */
    const char *where;
    char word[CONTROL_LINE];
    int column; /* of the word, or of the end of the line */
    struct glint_error *error;
};

enum glint_status control_fail(struct glint_error *error, const char *where,
                               int column, const char *format, ...)
{
    char cause[sizeof error->text], place[sizeof error->text];
    va_list values;

    va_start(values, format);
    vsnprintf(cause, sizeof cause, format, values);
    va_end(values);
    snprintf(place, sizeof place, "%.160s:%d", where, column);
    return glint_error_report(error, GLINT_E_FORMAT, place, "%s", cause);
}

/* Reads the next word; returns whether there is one. */
static bool next_word(struct reader *r)
{
    const char *const from = r->at + strspn(r->at, blanks);
    const size_t n = *from == '#' ? 0 : strcspn(from, blanks);

    r->column = (int)(from - r->text) + 1;
    r->at = from + n;
    memcpy(r->word, from, n);
    r->word[n] = '\0';
    return n > 0;
}

/* Looks at the word that follows, without taking it. */
static struct reader peek(const struct reader *r)
{
    struct reader ahead = *r;

    next_word(&ahead);
    return ahead;
}

/* ---------------------------------------------------------------- the form */

/* Says what may stand in place of the word. */
static enum glint_status fail_word(const struct reader *r, const char *before)
{
    struct suggest suggest;

    suggest_begin(&suggest, r->word);
    for (int i = 0; i < control_n_forms; i++) {
        const struct control_form *const f = &control_forms[i];
        const char *const may = before ? f->clause : f->word;

        if (may && (!before || strcmp(before, f->word) == 0))
            suggest_try(&suggest, may, strlen(may));
    }
    return control_fail(r->error, r->where, r->column, "'%.24s' is no %s%s%s",
                        r->word, before ? "word of " : "command",
                        before ? before : "", suggest_words(&suggest));
}

/* Returns the first form that begins with WORD, from I on; NULL: none does. */
static const struct control_form *form_of(const char *word, int i)
{
    for (; i < control_n_forms; i++)
        if (strcmp(control_forms[i].word, word) == 0)
            return &control_forms[i];
    return NULL;
}

/* Reads the N names of FORM. */
static enum glint_status read_names(struct reader *r,
                                    const struct control_form *form, int n,
                                    struct control_line *line)
{
    for (int i = 0; i < n; i++) {
        if (!next_word(r))
            return control_fail(r->error, r->where, r->column, "expected %s",
                                form->usage);
        if (strlen(r->word) >= CONTROL_NAME)
            return control_fail(r->error, r->where, r->column,
                                "a name has 31 letters at most");
        memcpy(line->name[i], r->word, strlen(r->word) + 1);
        line->name_column[i] = r->column;
    }
    return GLINT_OK;
}

/* Reads the clause, if forms of the word have some, and sets FORM to that of
 * it. */
static enum glint_status read_clause(struct reader *r,
                                     const struct control_form **form)
{
    const struct control_form *f = *form;

    if (!f->clause)
        return GLINT_OK;
    if (!next_word(r))
        return control_fail(r->error, r->where, r->column, "expected %s",
                            f->usage);
    for (; f; f = form_of(f->word, (int)(f - control_forms) + 1))
        if (strcmp(f->clause, r->word) == 0) {
            *form = f;
            return GLINT_OK;
        }
    return fail_word(r, (*form)->word);
}

static enum glint_status read_numbers(struct reader *r,
                                      const struct control_form *form,
                                      struct control_line *line)
{
    line->column = peek(r).column;
    while (line->n < form->most && next_word(r)) {
        double v;

        if (!tool_number(r->word, &v))
            return control_fail(r->error, r->where, r->column,
                                "'%.24s' is no number; expected %s", r->word,
                                form->usage);
        if (!(v >= form->lowest && v <= form->highest))
            return control_fail(r->error, r->where, r->column,
                                "%s is %.9g to %.9g, not %.9g", form->usage,
                                form->lowest, form->highest, v);
        if (form->is_whole && v != rint(v))
            return control_fail(r->error, r->where, r->column,
                                "%s takes whole numbers, not %.9g", form->usage,
                                v);
        line->v[line->n++] = v;
    }
    return line->n >= form->least ? GLINT_OK
                                  : control_fail(r->error, r->where, r->column,
                                                 "expected %s", form->usage);
}

/* -------------------------------------------------------------------- line */

/* Reads a number of a frame, if the line begins with one. */
static enum glint_status read_frame(struct reader *r, struct control_line *line)
{
    const struct reader ahead = peek(r);
    double v;

    if (!strchr("+-.0123456789", *ahead.word) || !*ahead.word)
        return GLINT_OK;
    *r = ahead;
    if (!tool_number(r->word, &v) || !(v >= 0 && v <= CONTROL_MOST_FRAME) ||
        v != rint(v))
        return control_fail(r->error, r->where, r->column,
                            "a frame is a whole number from 0, not '%.24s'",
                            r->word);
    line->frame = (int)v;
    return GLINT_OK;
}

/* Reads what follows the number of the frame. */
static enum glint_status read_command(struct reader *r,
                                      struct control_line *line)
{
    const struct control_form *form;
    enum glint_status status;

    if (!next_word(r))
        return line->frame < 0
                   ? GLINT_OK
                   : control_fail(r->error, r->where, r->column,
                                  "a command has to follow the frame");
    form = form_of(r->word, 0);
    if (!form)
        return fail_word(r, NULL);
    status = read_names(r, form, form->names, line);
    if (status == GLINT_OK)
        status = read_clause(r, &form);
    if (status == GLINT_OK)
        status = read_names(r, form, form->behind, line);
    if (status == GLINT_OK)
        status = read_numbers(r, form, line);
    if (status == GLINT_OK && next_word(r))
        status = control_fail(r->error, r->where, r->column,
                              "'%.24s' is too much; expected %s", r->word,
                              form->usage);
    line->verb = form->verb;
    return status;
}

enum glint_status control_parse(const char *text, const char *where,
                                struct control_line *line,
                                struct glint_error *error)
{
    struct reader r = {
        .text = text, .at = text, .where = where, .error = error};
    struct control_line read = {.frame = -1};
    enum glint_status status;

    if (strlen(text) >= CONTROL_LINE)
        return control_fail(error, where, CONTROL_LINE,
                            "a line has %d bytes at most", CONTROL_LINE - 1);
    status = read_frame(&r, &read);
    if (status == GLINT_OK)
        status = read_command(&r, &read);
    if (status == GLINT_OK)
        *line = read;
    return status;
}
