/* SPDX-License-Identifier: MIT
 *
 * Parses a file NAME.translucent, which describes a translucent medium, line by
 * line.
 */
#include <string.h>

#include "bake/scene/clauses.h"
#include "glint/scene/stone_bake.h"

enum { MOST_STONES = 2 };

struct reader {
    struct glint_text text;
    struct glint_stone_text *to;
    char name[MOST_STONES][32];
    int n_stones;
    /* true: the line "pattern" names the two media in reverse order */
    bool is_turned;
    struct glint_text_place pattern;
};

void glint_stone_text_defaults(struct glint_stone_text *text)
{
    memset(text, 0, sizeof *text);
    glint_stone_defaults(&text->stone);
    text->stone.pattern = GLINT_STONE_EVEN;
    glint_scatter_defaults(&text->fit, GLINT_SCATTER_CLUSTERED);
    text->fit.rank = 3;
}

static bool read_integer(struct reader *r, const char *what, int min, int max,
                         int *value)
{
    struct glint_text_place place;
    const struct glint_text_range range = {what, min, max};
    double x;

    if (!glint_text_read_value(&r->text, &range, &x, &place))
        return false;
    *value = (int)x;
    return (double)*value == x ||
           glint_text_set_error(&r->text, place, "%s needs a whole number",
                                what);
}

static bool read_number(struct reader *r, const char *what, double min,
                        double max, double *value)
{
    return glint_numbers_read(&r->text, what, 1, min, max, value);
}

static bool read_size_line(struct reader *r)
{
    struct glint_text at = r->text;
    const struct glint_text_place place = glint_text_next_word(&at).place;
    int *side = &r->to->stone.side;

    return read_integer(r, "size", 32, 256, side) &&
           ((*side & (*side - 1)) == 0 ||
            glint_text_set_error(&r->text, place,
                                 "size must be 32, 64, 128 or 256, not %d",
                                 *side));
}

static bool read_kernel_line(struct reader *r)
{
    struct glint_text at = r->text;
    const struct glint_text_place place = glint_text_next_word(&at).place;
    int *kernel = &r->to->stone.kernel;

    return read_integer(r, "kernel", 1, GLINT_SCATTER_MAX_KERNEL, kernel) &&
           (*kernel % 2 == 1 ||
            glint_text_set_error(
                &r->text, place,
                "kernel must be an odd number, 1 to 63, not %d", *kernel));
}

/* Sets INDEX to the index of the medium named WORD. */
static bool find_medium(struct reader *r, const struct glint_word *word,
                        int *index)
{
    if (!word->length)
        return glint_text_set_error(&r->text, word->place,
                                    "the name of a 'stone' is missing");
    return glint_name_find_index(&r->text, word, "stone", r->name[0],
                                 sizeof r->name[0], r->n_stones, index);
}

static bool read_medium_line(struct reader *r)
{
    struct glint_text at = r->text;
    const struct glint_word word = glint_text_next_word(&at);
    struct glint_stone_material *m = &r->to->stone.material[r->n_stones];
    struct glint_clause clause[] = {
        {"scatter", 3, 1e-3, 1e3, .value = m->scatter, .required = true},
        {"absorb", 3, 0, 1e3, .value = m->absorb, .required = true},
        {0}};

    if (r->n_stones == MOST_STONES)
        return glint_text_set_error(&r->text, word.place, "more than %d stones",
                                    MOST_STONES);
    if (!glint_name_read(&r->text, "stone", r->name[r->n_stones],
                         sizeof r->name[0]))
        return false;
    for (int i = 0; i < r->n_stones; i++)
        if (strcmp(r->name[i], r->name[r->n_stones]) == 0)
            return glint_text_set_error(
                &r->text, word.place,
                "a stone of this name is already defined");
    if (!glint_clauses_read(&r->text, "stone", clause))
        return false;
    r->n_stones++;
    return true;
}

static bool read_file_name(struct reader *r, const char *what,
                           const struct glint_word *word,
                           char file[GLINT_STONE_FILE_BYTES])
{
    if (!word->length)
        return glint_text_set_error(&r->text, word->place,
                                    "the name of the %s is missing", what);
    memcpy(file, word->start, (size_t)word->length);
    file[word->length] = '\0';
    return true;
}

/* Reads the names of two media at the end of the line "pattern". */
static bool read_medium_pair(struct reader *r)
{
    int index[2] = {0, 0};

    for (int i = 0; i < 2; i++) {
        const struct glint_word word = glint_text_next_word(&r->text);

        if (!find_medium(r, &word, &index[i]))
            return false;
        if (i && index[0] == index[1])
            return glint_text_set_error(&r->text, word.place,
                                        "a pattern needs two different stones");
    }
    r->is_turned = index[0] == 1;
    return true;
}

static bool read_pattern_line(struct reader *r)
{
    struct glint_stone *s = &r->to->stone;
    const struct glint_word word = glint_text_next_word(&r->text);
    char quote[GLINT_QUOTE_BYTES];
    int seed;

    r->pattern = word.place;
    if (glint_word_equals(&word, "chess")) {
        s->pattern = GLINT_STONE_CHESS;
        return read_integer(r, "chess", 1, 256, &s->fields) &&
               read_medium_pair(r);
    }
    if (glint_word_equals(&word, "veins")) {
        s->pattern = GLINT_STONE_VEINS;
        if (!read_integer(r, "veins", 0, 1 << 30, &seed))
            return false;
        s->seed = (uint32_t)seed;
        return read_medium_pair(r);
    }
    if (glint_word_equals(&word, "image")) {
        const struct glint_word file = glint_text_next_word(&r->text);

        s->pattern = GLINT_STONE_MASK;
        return read_file_name(r, "mask", &file, r->to->mask) &&
               read_medium_pair(r);
    }
    return glint_text_set_error(
        &r->text, word.place,
        "a pattern must be chess N A B, veins SEED A B or image MASK A B%s%s%s",
        word.length ? ", not '" : "",
        word.length ? glint_word_quote(&word, quote) : "",
        word.length ? "'" : "");
}

static bool read_model_line(struct reader *r)
{
    static const char *const names[] = {"clustered", "factored", "albedo",
                                        NULL};
    struct glint_scatter_options *fit = &r->to->fit;
    const int rank = fit->rank;
    const int i = glint_choice_read(&r->text, "model",
                                    "clustered, factored or albedo", names);

    if (i < 0)
        return false;
    glint_scatter_defaults(fit, (enum glint_scatter_model)i);
    fit->rank = rank;
    return true;
}

static bool read_texel_line(struct reader *r)
{
    return read_number(r, "texel", .01, 100, &r->to->stone.texel_mm);
}

static bool read_slab_line(struct reader *r)
{
    return read_number(r, "slab", .1, 1000, &r->to->stone.slab_mm);
}

static bool read_index_line(struct reader *r)
{
    return read_number(r, "index", 1, 3, &r->to->stone.index);
}

static bool read_data_line(struct reader *r)
{
    const struct glint_word word = glint_text_get_rest(&r->text);

    return read_file_name(r, "rows", &word, r->to->rows);
}

static const struct glint_text_line lines[] = {
    {"size", false},    {"texel", false}, {"kernel", false},
    {"slab", false},    {"index", false}, {"stone", true},
    {"pattern", false}, {"data", false},  {"model", false}};

enum { N_LINES = sizeof lines / sizeof *lines };

static bool (*const read[N_LINES])(struct reader *) = {
    read_size_line,    read_texel_line, read_kernel_line,
    read_slab_line,    read_index_line, read_medium_line,
    read_pattern_line, read_data_line,  read_model_line};

/* Checks that no line is missing and that no lines contradict each other. */
static bool check_line_consistency(struct reader *r)
{
    struct glint_stone_text *t = r->to;

    if (!t->rows[0] && !r->n_stones)
        return glint_text_set_error(
            &r->text, glint_text_get_end_place(&r->text),
            "a line 'stone NAME scatter R G B absorb R G B' "
            "or 'data ROWS.pfm' is missing");
    if (t->rows[0] && (r->n_stones || r->pattern.line))
        return glint_text_set_error(&r->text,
                                    glint_text_get_end_place(&r->text),
                                    "'data' excludes 'stone' and 'pattern'");
    if (r->n_stones == 2 && !r->pattern.line)
        return glint_text_set_error(
            &r->text, glint_text_get_end_place(&r->text),
            "two stones need a pattern: chess N A B, veins "
            "SEED A B or image MASK A B");
    if (t->stone.pattern == GLINT_STONE_CHESS &&
        t->stone.fields > t->stone.side)
        return glint_text_set_error(
            &r->text, r->pattern,
            "%d fields per side exceed the %d texels per side", t->stone.fields,
            t->stone.side);
    if (t->fit.model == GLINT_SCATTER_ALBEDO)
        t->fit.kernels = 1;
    return true;
}

enum glint_status glint_stone_parse(struct glint_stone_text *text,
                                    const char *data, size_t bytes,
                                    const char *file_name,
                                    struct glint_error *error)
{
    struct reader r = {.to = text};
    int first[N_LINES] = {0};
    bool good;

    glint_stone_text_defaults(text);
    good = glint_text_open(&r.text, data, bytes, file_name, error);
    while (good && glint_text_next_line(&r.text)) {
        int i;

        good = glint_line_read_first_word(&r.text, lines, N_LINES, first, &i) &&
               (i < 0 ||
                (read[i](&r) && glint_line_check_end(&r.text, lines[i].word)));
    }
    good = good && check_line_consistency(&r);
    if (good && r.is_turned) {
        const struct glint_stone_material m = text->stone.material[0];

        text->stone.material[0] = text->stone.material[1];
        text->stone.material[1] = m;
    }
    return good ? GLINT_OK : GLINT_E_LENS;
}
