/* SPDX-License-Identifier: MIT */
#include "bake/motion/split.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1 << 16, MOST_BYTES = 1 << 20, MOST_DEEP = 64, NAME_BYTES = 32 };

struct splitter {
    const char *file_name;
    glint_recording_read_fn *read;
    void *ctx;
    struct glint_error *error;
    enum glint_status status;
    char chunk[CHUNK];
    size_t at, n;
    int c; /* the next byte, or -1 at the end */
    int line, column;
    const char *within; /* what the text must not end in */
    long number;        /* of the element that is read; -1: none */
    bool is_kept;       /* what is passed goes to TEXT */
    char *text;         /* malloc'ed */
    size_t bytes, room;
};

/* --------------------------------------------------------------------- bytes
 */

static bool fail(struct splitter *s, const char *format, ...)
{
    char cause[128];
    va_list args;

    if (s->status != GLINT_OK)
        return false;
    va_start(args, format);
    vsnprintf(cause, sizeof cause, format, args);
    va_end(args);
    snprintf(s->error->text, sizeof s->error->text, "%.80s:%d:%d: %s",
             s->file_name, s->line, s->column, cause);
    s->status = GLINT_E_LENS;
    return false;
}

/* Sets C to the next byte. */
static void load(struct splitter *s)
{
    if (s->at == s->n && s->status == GLINT_OK) {
        const long n = s->read(s->ctx, s->chunk, sizeof s->chunk);

        s->at = 0;
        s->n = n > 0 ? (size_t)n : 0;
        if (n < 0) {
            snprintf(s->error->text, sizeof s->error->text,
                     "%.120s: cannot be read", s->file_name);
            s->status = GLINT_E_IO;
        }
    }
    s->c = s->at < s->n ? (unsigned char)s->chunk[s->at] : -1;
}

static bool ends(struct splitter *s)
{
    if (s->number >= 0)
        return fail(s, "the text ends within frame %ld", s->number);
    return fail(s, "the text ends within %s", s->within);
}

static bool keep(struct splitter *s, char c)
{
    if (s->bytes == MOST_BYTES)
        return fail(s, "%s takes more than 1 MiB", s->within);
    if (s->bytes == s->room) {
        const size_t room = s->room ? 2 * s->room : 4096;
        char *const text = realloc(s->text, room);

        if (!text) {
            s->status = GLINT_E_MEMORY;
            return false;
        }
        s->text = text;
        s->room = room;
    }
    s->text[s->bytes++] = c;
    return true;
}

/* Passes the next byte. */
static bool pass(struct splitter *s)
{
    if (s->c < 0)
        return ends(s);
    if (s->is_kept && !keep(s, (char)s->c))
        return false;
    if (s->c == '\n') {
        s->line++;
        s->column = 1;
    } else {
        s->column++;
    }
    s->at++;
    load(s);
    return s->status == GLINT_OK;
}

static bool pass_space(struct splitter *s)
{
    while (s->c == ' ' || s->c == '\t' || s->c == '\n' || s->c == '\r')
        if (!pass(s))
            return false;
    return s->status == GLINT_OK;
}

static bool expect(struct splitter *s, char c)
{
    if (s->c < 0)
        return ends(s);
    if (s->c != c)
        return fail(s, "'%c' is expected here, in %s", c, s->within);
    return pass(s);
}

/* --------------------------------------------------------------------- values
 */

/* Passes a string, and sets NAME[NAME_BYTES] to its beginning, unless NULL. */
static bool pass_string(struct splitter *s, char *name)
{
    size_t n = 0;

    if (!expect(s, '"'))
        return false;
    while (s->c != '"') {
        if (s->c >= 0 && s->c < ' ')
            return fail(s, "a string ends on its line, with '\"'");
        if (name && n + 1 < NAME_BYTES && s->c >= 0)
            name[n++] = (char)s->c;
        if ((s->c == '\\' && !pass(s)) || !pass(s))
            return false;
    }
    if (name)
        name[n] = '\0';
    return pass(s);
}

/* Takes a comma that nothing follows out of the text. */
static void drop_comma(struct splitter *s)
{
    size_t i = s->bytes;

    while (s->is_kept && i > 0 && (unsigned char)s->text[i - 1] <= ' ')
        i--;
    if (s->is_kept && i > 0 && s->text[i - 1] == ',')
        s->text[i - 1] = ' ';
}

/* Passes any value; what it is made of is left to who reads it, but brackets.
 */
static bool pass_value(struct splitter *s)
{
    char close[MOST_DEEP];
    int deep = 0;

    if (!pass_space(s))
        return false;
    if (s->c == ',' || s->c == '}' || s->c == ']')
        return fail(s, "a value is expected here, in %s", s->within);
    do {
        if (s->c == '"') {
            if (!pass_string(s, NULL))
                return false;
            continue;
        }
        if (s->c == '{' || s->c == '[') {
            if (deep == MOST_DEEP)
                return fail(s, "brackets are more than %d deep", MOST_DEEP);
            close[deep++] = s->c == '{' ? '}' : ']';
        } else if (s->c == '}' || s->c == ']') {
            if (deep == 0)
                return true; /* of a number: that of what it is in */
            if (s->c != close[--deep])
                return fail(s, "'%c' closes what '%c' opened", s->c,
                            close[deep] == '}' ? '{' : '[');
            drop_comma(s);
        } else if (deep == 0 && (s->c == ',' || s->c <= ' ')) {
            return s->c >= 0 || ends(s);
        }
        if (!pass(s))
            return false;
    } while (deep > 0 || (s->c != ',' && s->c > ' ' && s->c != ':'));
    return true;
}

/* ---------------------------------------------------------------------- keys
 */

/* Passes a value and hands it out. */
static bool hand_out(struct splitter *s, int key, glint_split_fn *take,
                     void *to)
{
    struct glint_split_piece piece = {.key = key};

    if (!pass_space(s))
        return false;
    piece.line = s->line;
    piece.column = s->column;
    piece.number = s->number < 0 ? 0 : s->number;
    s->is_kept = true;
    s->bytes = 0;
    if (!pass_value(s))
        return false;
    s->is_kept = false;
    piece.text = s->text;
    piece.bytes = s->bytes;
    s->status = take(to, &piece, s->error);
    return s->status == GLINT_OK;
}

/* Passes what separates values; sets DONE to whether CLOSE follows. */
static bool go_on(struct splitter *s, char close, bool *done)
{
    if (!pass_space(s))
        return false;
    *done = s->c == close;
    if (*done)
        return true;
    if (s->c >= 0 && s->c != ',')
        return fail(s, "',' or '%c' is expected here, in %s", close, s->within);
    if (!pass(s) || !pass_space(s))
        return false;
    *done = s->c == close;
    return true;
}

static bool split_array(struct splitter *s, int key, glint_split_fn *take,
                        void *to)
{
    bool done;

    if (!expect(s, '[') || !pass_space(s))
        return false;
    done = s->c == ']';
    for (s->number = 0; !done; s->number++)
        if (!hand_out(s, key, take, to) || !go_on(s, ']', &done))
            return false;
    s->number = -1;
    return pass(s);
}

static bool split_member(struct splitter *s, const struct glint_split_key *key,
                         unsigned *seen, glint_split_fn *take, void *to)
{
    char name[NAME_BYTES];
    int i = 0;

    if (!pass_string(s, name) || !pass_space(s) || !expect(s, ':') ||
        !pass_space(s))
        return false;
    while (key[i].name && strcmp(key[i].name, name) != 0)
        i++;
    if (!key[i].name)
        return pass_value(s);
    if (*seen >> i & 1)
        return fail(s, "a second '%s'", name);
    *seen |= 1u << i;
    return key[i].by_elements ? split_array(s, i, take, to)
                              : hand_out(s, i, take, to);
}

static bool split_object(struct splitter *s, const struct glint_split_key *key,
                         glint_split_fn *take, void *to)
{
    unsigned seen = 0;
    bool done;

    if (!pass_space(s) || !expect(s, '{') || !pass_space(s))
        return false;
    done = s->c == '}';
    while (!done)
        if (!split_member(s, key, &seen, take, to) || !go_on(s, '}', &done))
            return false;
    s->at++;
    s->column++;
    load(s);
    if (!pass_space(s))
        return false;
    return s->c < 0 || fail(s, "the recording has ended before this");
}

enum glint_status glint_split(const char *file_name,
                              glint_recording_read_fn *read, void *ctx,
                              const struct glint_split_key *key,
                              glint_split_fn *take, void *to,
                              struct glint_error *error)
{
    struct splitter *s = calloc(1, sizeof *s);
    enum glint_status status;

    error->text[0] = '\0';
    if (!s)
        return GLINT_E_MEMORY;
    s->file_name = file_name;
    s->read = read;
    s->ctx = ctx;
    s->error = error;
    s->line = s->column = 1;
    s->within = "the recording";
    s->number = -1;
    load(s);
    split_object(s, key, take, to);
    status = s->status;
    free(s->text);
    free(s);
    return status;
}
