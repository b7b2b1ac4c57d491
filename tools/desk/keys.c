/* SPDX-License-Identifier: MIT */
#include "desk/keys.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/text_lines.h"
#include "options/tool.h"
#include "posix/error.h"

enum { MOST_BYTES = 1 << 26, MOST_FRAME = 1000000000 };

static const struct {
    const char *name;
    double low, high;
    const char *takes;
} columns[KEYS_COLUMNS] = {
    [KEYS_FRAME] = {"frame", 0, MOST_FRAME,
                    "frame must be a whole number from 0"},
    [KEYS_EXPOSURE] = {"exposure", -100, 100,
                       "exposure must be -100 to 100 stops"},
    [KEYS_STRENGTH] = {"strength", 0, 100, "strength must be 0 to 100"},
    [KEYS_GAIN] = {"gain", 0, 1e30, "gain must be a factor from 0"},
    [KEYS_STARBURST] = {"starburst", 0, 1000, "starburst must be 0 to 1000"},
    [KEYS_F_NUMBER] = {"f-number", 0.1, 1e5, "f-number must be 0.1 to 100000"},
    [KEYS_TURN] = {"turn", -1e6, 1e6, "turn must be within a million degrees"},
    [KEYS_ROUND] = {"round", 0, 1, "round must be 0 to 1"},
    [KEYS_X] = {"x", -1e6, 1e6, "x and y must be within a million pixels"},
    [KEYS_Y] = {"y", -1e6, 1e6, "x and y must be within a million pixels"},
    [KEYS_EV] = {"ev", -40, 90, "ev must be -40 to 90 stops"},
    [KEYS_ZOOM] = {"zoom", 0, 1e5, "zoom must be mm, or 0 to 1"},
};

/* A file being read. */
struct reading {
    struct keys *keys;
    int column[KEYS_COLUMNS], n_columns; /* of the fields of a row; 0: the
                                            heading was not read yet */
    char cause[200];
};

static const char no_memory[] = "no memory";

static const char *add(struct keys *keys, int column, struct key_value key)
{
    const int n = keys->n[column];

    if ((n & (n - 1)) == 0) { /* at powers of two */
        struct key_value *const more =
            realloc(keys->key[column], 2 * ((size_t)n + 1) * sizeof *more);

        if (!more)
            return no_memory;
        keys->key[column] = more;
    }
    keys->key[column][n] = key;
    keys->n[column]++;
    return NULL;
}

static int column_of(const char *name)
{
    for (int i = 0; i < KEYS_COLUMNS; i++)
        if (strcmp(name, columns[i].name) == 0)
            return i;
    return -1;
}

static const char *check_heading(unsigned seen)
{
    if (!(seen & 1))
        return "a column is needed that is called frame";
    if (seen >> KEYS_EXPOSURE & 1 && seen >> KEYS_STRENGTH & 1)
        return "strength chooses the exposure; have one column of these two";
    if ((seen >> KEYS_X & 1) != (seen >> KEYS_Y & 1) ||
        (seen >> KEYS_EV & 1 && !(seen >> KEYS_X & 1)))
        return "a light needs the columns x and y";
    return NULL;
}

/* Takes LINE as the heading. Returns NULL, or what is wrong with it. */
static const char *take_heading(struct reading *r, char *line)
{
    char *rest = line, *name;
    unsigned seen = 0;

    while ((name = text_field(&rest))) {
        const int column = column_of(name);

        if (column < 0) {
            snprintf(r->cause, sizeof r->cause,
                     "'%.32s' is no column: the first line names frame, and of "
                     "exposure, strength, gain, starburst, f-number, turn, "
                     "round, x, y, ev",
                     name);
            return r->cause;
        }
        if (seen >> column & 1)
            return "a column is there twice";
        seen |= 1u << column;
        r->column[r->n_columns++] = column;
    }
    return check_heading(seen);
}

/* Takes LINE, the one of that NUMBER, as a row of keys. */
static const char *take_row(struct reading *r, char *line, int number)
{
    double value[KEYS_COLUMNS] = {-1};
    bool given[KEYS_COLUMNS] = {false};
    char *rest = line, *text;
    const char *cause = NULL;
    int n = 0, frame;

    for (; n < r->n_columns && (text = text_field(&rest)); n++) {
        const int c = r->column[n];

        given[c] = *text != '\0';
        if (given[c] && !tool_number(text, &value[c]))
            return "expected a number, or nothing, in each column";
        if (given[c] &&
            !(value[c] >= columns[c].low && value[c] <= columns[c].high))
            return columns[c].takes;
    }
    frame = (int)value[KEYS_FRAME];
    if (n < r->n_columns || rest)
        return "expected as many fields as the heading has names";
    if (frame < 0 || frame != value[KEYS_FRAME])
        return columns[KEYS_FRAME].takes;
    n = r->keys->n[KEYS_FRAME];
    if (n > 0 && frame <= r->keys->key[KEYS_FRAME][n - 1].frame)
        return "frames must rise from line to line";
    for (int c = 0; c < KEYS_COLUMNS && !cause; c++)
        if (given[c])
            cause =
                add(r->keys, c, (struct key_value){frame, number, value[c]});
    return cause;
}

static enum glint_status read_lines(struct keys *keys, struct text_lines *lines,
                                    struct glint_error *error)
{
    struct reading r = {.keys = keys};
    enum glint_status status = GLINT_OK;
    char *line;

    while (status == GLINT_OK && (line = text_lines_next(lines))) {
        const char *const cause = r.n_columns
                                      ? take_row(&r, line, lines->number)
                                      : take_heading(&r, line);

        if (cause)
            status = text_lines_fail(lines, error, cause);
        if (cause == no_memory)
            status = GLINT_E_MEMORY;
    }
    if (status == GLINT_OK && keys->n[KEYS_FRAME] == 0)
        status = glint_error_report(error, GLINT_E_FORMAT, lines->name,
                                    "has no key frames");
    if (status != GLINT_OK)
        keys_free(keys);
    return status;
}

enum glint_status keys_parse(struct keys *keys, const char *name,
                             const char *text, size_t bytes,
                             struct glint_error *error)
{
    struct text_lines lines;
    enum glint_status status =
        text_lines_copy(&lines, name, text, bytes, error);

    *keys = (struct keys){.n = {0}};
    if (status == GLINT_OK)
        status = read_lines(keys, &lines, error);
    text_lines_close(&lines);
    return status;
}

enum glint_status keys_read(struct keys *keys, const char *path,
                            struct glint_error *error)
{
    struct text_lines lines;
    enum glint_status status = text_lines_open(&lines, path, MOST_BYTES, error);

    *keys = (struct keys){.n = {0}};
    if (status == GLINT_OK)
        status = read_lines(keys, &lines, error);
    text_lines_close(&lines);
    return status;
}

bool keys_has(const struct keys *keys, enum key_column column)
{
    return keys->n[column] > 0;
}

double keys_at(const struct keys *keys, enum key_column column, int frame,
               double other)
{
    const struct key_value *const key = keys->key[column];
    const int n = keys->n[column];
    int low = 0, high = n - 1;

    if (n == 0)
        return other;
    if (frame <= key[0].frame)
        return key[0].value;
    if (frame >= key[high].frame)
        return key[high].value;
    while (high - low > 1) {
        const int mid = (low + high) / 2;

        *(key[mid].frame <= frame ? &low : &high) = mid;
    }
    return key[low].value + (key[high].value - key[low].value) *
                                (frame - key[low].frame) /
                                (key[high].frame - key[low].frame);
}

void keys_free(struct keys *keys)
{
    for (int i = 0; i < KEYS_COLUMNS; i++)
        free(keys->key[i]);
    *keys = (struct keys){.n = {0}};
}
