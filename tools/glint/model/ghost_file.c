/* SPDX-License-Identifier: MIT */
#include "model/ghost_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/timed_text.h"
#include "options/tool.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"

enum { MOST_BYTES = 1 << 20 };

/* Parser state of a ghost file */
struct reading {
    const struct glint_setup *setup;
    const char *lens;
    /* number of ghosts; a ghost whose pupil has several parts counts once */
    int n;
    struct glint_tint *tint;
    bool *solo, *mute;
};

/* Returns the next word of *REST, delimited by blanks, and moves *REST past the
 * word. Returns NULL if there is none. */
static char *read_next_word(char **rest)
{
    char *word = *rest + strspn(*rest, " \t"), *end;

    if (!*word)
        return NULL;
    end = word + strcspn(word, " \t");
    *rest = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

/* Returns the number of the ghost WORD, a number "12" or surfaces "7-3", or -1
 * if there is no such ghost. */
static int parse_ghost_number(const struct reading *r, const char *word)
{
    const char *const dash = strchr(word, '-');
    int ghost = -1, i, j;
    char first[16];

    if (!dash)
        return tool_parse_integer(word, 0, r->n - 1, &ghost) ? ghost : -1;
    if (dash - word >= (ptrdiff_t)sizeof first)
        return -1;
    memcpy(first, word, (size_t)(dash - word));
    first[dash - word] = '\0';
    if (!tool_parse_integer(first, 0, 999, &i) ||
        !tool_parse_integer(dash + 1, 0, 999, &j))
        return -1;
    for (int k = 0; k < r->n; k++)
        if (r->setup->ghost[k].i == i && r->setup->ghost[k].j == j)
            return k;
    return -1;
}

static const char *parse_ghost_gain(struct glint_tint *tint, const char *text)
{
    double gain;

    if (!text || !tool_parse_number(text, &gain) ||
        !(gain >= 0 && gain <= 1000))
        return "gain must be a factor, 0 to 1000";
    tint->gain = glint_real_of(gain);
    return NULL;
}

static const char *parse_ghost_tint(struct glint_tint *tint, const char *text)
{
    double rgb[3];

    if (!text || tool_parse_numbers(text, rgb, 3) != 3)
        return "tint takes R,G,B";
    for (int c = 0; c < 3; c++) {
        if (!(rgb[c] >= 0 && rgb[c] <= 4))
            return "tint must be R,G,B, each 0 to 4";
        tint->rgb_q14[c] = (int32_t)lrint(rgb[c] * 16384);
    }
    return NULL;
}

/* Parses the words after a ghost's name. Returns NULL or an error message. */
static const char *parse_ghost_words(struct reading *r, int ghost, char *rest)
{
    static const char *const words[] = {"mute", "solo", "gain", "tint", NULL};
    const char *cause = NULL;
    char *word;

    while (!cause && (word = read_next_word(&rest)))
        switch (tool_find_word_index(word, words)) {
        case 0:
            r->mute[ghost] = true;
            break;
        case 1:
            r->solo[ghost] = true;
            break;
        case 2:
            cause = parse_ghost_gain(&r->tint[ghost], read_next_word(&rest));
            break;
        case 3:
            cause = parse_ghost_tint(&r->tint[ghost], read_next_word(&rest));
            break;
        default:
            cause = "expected mute, solo, gain G or tint R,G,B after a ghost";
        }
    if (!cause && r->mute[ghost] && r->solo[ghost])
        cause = "solo and mute of one ghost contradict each other";
    return cause;
}

static const char *parse_ghost_line(void *ctx, struct text_lines *lines,
                                    char *line)
{
    struct reading *const r = ctx;
    char *rest = line, *word;
    int ghost;

    line[strcspn(line, "#")] = '\0';
    word = read_next_word(&rest);
    if (!word)
        return NULL;
    if (strcmp(word, "lens") == 0) {
        word = read_next_word(&rest);
        return word && strcmp(word, r->lens) == 0
                   ? NULL
                   : "the file lists ghosts of another lens (glint explain "
                     "--save-ghosts writes those of this lens)";
    }
    ghost = parse_ghost_number(r, word);
    if (ghost >= 0)
        return parse_ghost_words(r, ghost, rest);
    return text_lines_format_cause(
        lines,
        "no ghost '%.20s': lines begin with a number, 0 to %d, or the two "
        "surfaces of a ghost (glint info lists them)",
        word, r->n - 1);
}

/* If any ghost is solo, mutes all that are not. Copies the tint of each ghost
 * to the parts of its pupil. */
static void apply_solo_and_mute(struct reading *r)
{
    bool any_solo = false;

    for (int i = 0; i < r->n; i++)
        any_solo |= r->solo[i];
    for (int i = 0; i < r->n; i++)
        if (r->mute[i] || (any_solo && !r->solo[i]))
            r->tint[i].gain = (struct glint_real){0, 0};
    for (int i = r->n; i < r->setup->n_ghosts; i++)
        for (int k = 0; k < r->n; k++)
            if (r->setup->ghost[k].i == r->setup->ghost[i].i &&
                r->setup->ghost[k].j == r->setup->ghost[i].j)
                r->tint[i] = r->tint[k];
}

static bool allocate_ghost_tints(struct reading *r)
{
    const size_t n = (size_t)r->setup->n_ghosts + 1;

    r->tint = malloc(n * sizeof *r->tint);
    r->solo = calloc(n, sizeof *r->solo);
    r->mute = calloc(n, sizeof *r->mute);
    for (size_t i = 0; i < n && r->tint; i++)
        r->tint[i] =
            (struct glint_tint){{16384, 16384, 16384}, glint_real_of(1)};
    return r->tint && r->solo && r->mute;
}

enum glint_status ghost_file_parse(struct glint_tint **tints, const char *name,
                                   const char *text, size_t bytes,
                                   const struct glint_setup *setup,
                                   const char *lens, struct glint_error *error)
{
    struct reading r = {
        .setup = setup, .lens = lens, .n = setup->n_ghosts - setup->n_parts};
    struct text_lines lines;
    enum glint_status status =
        text_lines_open_text(&lines, name, text, bytes, error);

    if (status == GLINT_OK && !allocate_ghost_tints(&r))
        status = glint_error_report(error, GLINT_E_MEMORY, name, "%s",
                                    text_no_memory);
    if (status == GLINT_OK)
        status = text_lines_parse_each(&lines, parse_ghost_line, &r, error);
    text_lines_close(&lines);
    if (status == GLINT_OK)
        apply_solo_and_mute(&r);
    else {
        free(r.tint);
        r.tint = NULL;
    }
    free(r.solo);
    free(r.mute);
    *tints = r.tint;
    return status;
}

enum glint_status ghost_file_read(struct glint_tint **tints, const char *path,
                                  const struct glint_setup *setup,
                                  const char *lens, struct glint_error *error)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_read_whole_file(&data, &bytes, path, MOST_BYTES, error);

    *tints = NULL;
    if (status == GLINT_OK)
        status = ghost_file_parse(tints, path, (const char *)data, bytes, setup,
                                  lens, error);
    free(data);
    return status;
}

void ghost_file_write_line(char *text, size_t room, int ghost,
                           const struct glint_tint *tint)
{
    const struct glint_tint plain = {{16384, 16384, 16384}, glint_real_of(1)};
    const struct glint_tint *t = tint ? tint : &plain;

    snprintf(text, room, "%-4d %s gain %-6.4g tint %.4g,%.4g,%.4g", ghost,
             t->gain.mantissa ? "    " : "mute",
             t->gain.mantissa ? glint_real_value(t->gain) : 1,
             t->rgb_q14[0] / 16384.0, t->rgb_q14[1] / 16384.0,
             t->rgb_q14[2] / 16384.0);
}

enum glint_status ghost_file_save(const struct glint_explain *e,
                                  const char *path, const char *lens,
                                  struct glint_error *error)
{
    struct glint_output out;
    enum glint_status status =
        glint_output_open(&out, path, GLINT_OUTPUT_TEXT, error);
    int order[GLINT_MAX_GHOSTS];
    char text[300];
    int n = snprintf(text, sizeof text,
                     "# Ghosts of one frame, the brightest first. A line may "
                     "have solo or mute, gain (0 to\n"
                     "# 1000) and tint R,G,B (0 to 4); a ghost without a line "
                     "does not change, unless others are solo.\nlens %s\n",
                     lens);

    glint_explain_sort(e, order);
    if (status == GLINT_OK)
        status = glint_output_write(&out, text, (size_t)n, error);
    for (int i = 0; i < e->n_ghosts && status == GLINT_OK; i++) {
        const struct glint_tint *tint = e->tints ? &e->tints[order[i]] : NULL;
        const struct glint_explain_part *part = &e->ghost[order[i]];
        const struct glint_ghost *g = &e->setup->ghost[order[i]];

        if (glint_explain_drawn(part) == 0 && !(tint && !tint->gain.mantissa))
            continue;
        ghost_file_write_line(text, sizeof text, order[i], tint);
        n = (int)strlen(text);
        n += snprintf(text + n, sizeof text - (size_t)n,
                      "   # surfaces %d-%d, %.2f %% of the light\n", g->i, g->j,
                      100 * part->share);
        status = glint_output_write(&out, text, (size_t)n, error);
    }
    return glint_output_commit_or_abort(&out, status, error);
}
