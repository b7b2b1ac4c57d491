/* SPDX-License-Identifier: MIT */
#include "desk/keys.h"

#include <stdio.h>
#include <stdlib.h>

#include "glint/options.h"
#include "options/timed_text.h"

enum { MAX_BYTES = 1 << 26 };

/* Columns of a key frame file. A column without limits is the engine option of
 * the same name and has its limits. */
static const struct text_column columns[KEYS_COLUMNS] = {
    [KEYS_FRAME] = {"frame", 0, TEXT_MAX_FRAME,
                    "frame must be a whole number from 0 to 1000000000"},
    [KEYS_EXPOSURE] = {.name = "exposure"},
    [KEYS_STRENGTH] = {.name = "strength"},
    [KEYS_GAIN] = {.name = "gain"},
    [KEYS_STARBURST] = {.name = "starburst"},
    [KEYS_F_NUMBER] = {.name = "f-number"},
    [KEYS_TURN] = {"turn", -1e6, 1e6, "turn must be within a million degrees"},
    [KEYS_ROUND] = {"round", 0, 1, "round must be 0 to 1"},
    [KEYS_X] = {"x", -1e6, 1e6, "x and y must be within a million pixels"},
    [KEYS_Y] = {"y", -1e6, 1e6, "x and y must be within a million pixels"},
    [KEYS_EV] = {"ev", -40, 90, "ev must be -40 to 90 stops"},
    [KEYS_ZOOM] = {.name = "zoom"},
};

/* Parser state of a key file */
struct reading {
    struct keys *keys;
    /* index in COLUMNS of each field of a row; n_columns is 0 until the heading
     * was read */
    int column[KEYS_COLUMNS], n_columns;
    char range[160]; /* error message for values out of an option's range */
};

/* Parses the text FIELD as a value of column C. Returns NULL or an error
 * message. */
static const char *parse_key_frame_value(struct reading *r, int c,
                                         const char *field, double *value)
{
    const struct glint_option *const option =
        columns[c].range ? NULL : glint_option_named(columns[c].name);
    struct text_column column = columns[c];
    int n;

    if (option) {
        n = snprintf(r->range, sizeof r->range, "%s must be ", option->name);
        glint_option_accepts(option, r->range + n, sizeof r->range - (size_t)n);
        column = (struct text_column){option->name, option->low, option->high,
                                      r->range};
    }
    return text_parse_value(&column, field,
                            "each field must be a number or empty", value);
}

static const char *add_key_frame(struct keys *keys, int column,
                                 struct key_value key)
{
    struct key_value *const more =
        text_grow_array(keys->key[column], keys->n[column], sizeof *more);

    if (!more)
        return text_no_memory;
    keys->key[column] = more;
    more[keys->n[column]++] = key;
    return NULL;
}

static const char *check_column_heading(unsigned seen)
{
    if (!(seen & 1))
        return "the column 'frame' is missing";
    if (seen >> KEYS_EXPOSURE & 1 && seen >> KEYS_STRENGTH & 1)
        return "the columns strength and exposure exclude each other";
    if ((seen >> KEYS_X & 1) != (seen >> KEYS_Y & 1) ||
        (seen >> KEYS_EV & 1 && !(seen >> KEYS_X & 1)))
        return "a light needs the columns x and y";
    return NULL;
}

static const char *parse_column_heading(struct reading *r,
                                        struct text_lines *lines, char *line)
{
    char *name[KEYS_COLUMNS];
    const int n = text_split_fields(line, name, KEYS_COLUMNS);
    unsigned seen = 0;

    for (int i = 0; i < n && i < KEYS_COLUMNS; i++) {
        const int column = text_find_column(columns, KEYS_COLUMNS, name[i]);

        if (column < 0)
            return text_lines_format_cause(
                lines,
                "'%.32s' is not a column; the first line names frame and any "
                "of exposure, strength, gain, starburst, f-number, turn, "
                "round, zoom, x, y, ev",
                name[i]);
        if (seen >> column & 1)
            return "a column appears twice";
        seen |= 1u << column;
        r->column[r->n_columns++] = column;
    }
    return n > KEYS_COLUMNS ? "a column appears twice"
                            : check_column_heading(seen);
}

static const char *parse_key_frame_row(struct reading *r,
                                       struct text_lines *lines, char *line)
{
    struct keys *const keys = r->keys;
    struct key_value key = {-1, lines->number, 0};
    double value[KEYS_COLUMNS] = {-1};
    bool given[KEYS_COLUMNS] = {false};
    char *field[KEYS_COLUMNS];
    const char *cause = NULL;
    const int n = text_split_fields(line, field, r->n_columns);

    for (int i = 0; i < n && i < r->n_columns && !cause; i++) {
        const int c = r->column[i];

        given[c] = *field[i] != '\0';
        if (given[c])
            cause = parse_key_frame_value(r, c, field[i], &value[c]);
    }
    if (cause)
        return cause;
    if (n != r->n_columns)
        return "expected as many fields as the heading has names";
    key.frame = (int)value[KEYS_FRAME];
    if (key.frame < 0 || key.frame != value[KEYS_FRAME])
        return columns[KEYS_FRAME].range;
    if (keys->n[KEYS_FRAME] > 0 &&
        key.frame <= keys->key[KEYS_FRAME][keys->n[KEYS_FRAME] - 1].frame)
        return "frame numbers must increase from line to line";
    for (int c = 0; c < KEYS_COLUMNS && !cause; c++) {
        key.value = value[c];
        cause = given[c] ? add_key_frame(keys, c, key) : NULL;
    }
    return cause;
}

static const char *parse_key_frame_line(void *ctx, struct text_lines *lines,
                                        char *line)
{
    struct reading *const r = ctx;

    return (r->n_columns ? parse_key_frame_row : parse_column_heading)(r, lines,
                                                                       line);
}

enum glint_status key_frames_parse_text(struct keys *keys, const char *name,
                                        const char *text, size_t bytes,
                                        struct glint_error *error)
{
    struct reading r = {.keys = keys};
    struct text_lines lines;
    enum glint_status status =
        text_lines_open(&lines, name, text, bytes, error);

    *keys = (struct keys){.n = {0}};
    if (status == GLINT_OK)
        status = text_lines_parse_each(&lines, parse_key_frame_line, &r, error);
    if (status == GLINT_OK && keys->n[KEYS_FRAME] == 0)
        status = glint_error_report(error, GLINT_E_FORMAT, name,
                                    "has no key frames");
    if (status != GLINT_OK)
        key_frames_free(keys);
    return status;
}

enum glint_status key_frames_read_file(struct keys *keys, const char *path,
                                       struct glint_error *error)
{
    return key_frames_parse_text(keys, path, NULL, MAX_BYTES, error);
}

int key_frames_find_column(const char *name)
{
    return text_find_column(columns, KEYS_COLUMNS, name);
}

bool key_frames_have_column(const struct keys *keys, enum key_column column)
{
    return keys->n[column] > 0;
}

double key_frames_interpolate_at(const struct keys *keys,
                                 enum key_column column, int frame,
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

void key_frames_free(struct keys *keys)
{
    for (int i = 0; i < KEYS_COLUMNS; i++)
        free(keys->key[i]);
    *keys = (struct keys){.n = {0}};
}
