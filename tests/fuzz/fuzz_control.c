/* SPDX-License-Identifier: MIT
 *
 * Parses random bytes as control lines, and as keys. Accepted lines must be in
 * range and unchanged after writing and reading them; rejected lines must have
 * a position in the message; frames of a playback must be valid.
 *
 *     make fuzz FUZZ=control SECONDS=60
 */
#include <math.h>
#include <stdio.h>

#include "control/controls.h"
#include "control/playback.h"
#include "fuzz/fuzz.h"

static const struct control_form *find_command_syntax(enum control_verb verb)
{
    static const struct control_form option = {.verb = CONTROL_OPTION,
                                               .word = "",
                                               .names = 1,
                                               .least = 1,
                                               .most = 1,
                                               .lowest = -HUGE_VAL,
                                               .highest = HUGE_VAL};

    if (verb == CONTROL_OPTION)
        return &option;
    for (int i = 0; i < control_n_forms; i++)
        if (control_forms[i].verb == verb)
            return &control_forms[i];
    abort();
}

/* Writes the command L as text, parses the text, and checks that the command is
 * unchanged. */
static void check_command_round_trip(const struct control_line *l,
                                     const struct control_form *f)
{
    char text[CONTROL_LINE];
    struct control_line again;
    struct glint_error error;
    int n = 0;

    if (l->frame >= 0)
        n += snprintf(text, sizeof text, "%d ", l->frame);
    n += f->behind ? snprintf(text + n, sizeof text - (size_t)n, "%s %s %s",
                              f->word, f->clause, l->name[0])
                   : snprintf(text + n, sizeof text - (size_t)n, "%s %s %s %s",
                              f->word, l->name[0], l->name[1],
                              f->clause ? f->clause : "");
    for (int i = 0; i < l->n; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, " %.17g", l->v[i]);
    require(control_parse_line(text, "again", &again, &error) == GLINT_OK);
    require(again.verb == l->verb && again.frame == l->frame);
    require(again.n == l->n && !strcmp(again.name[0], l->name[0]));
    for (int i = 0; i < l->n; i++)
        require(again.v[i] == l->v[i]);
}

static void check_parsed_command(const struct control_line *l)
{
    const struct control_form *f;

    require(l->frame >= -1 && l->frame <= CONTROL_MOST_FRAME);
    if (l->verb == CONTROL_NONE)
        return;
    f = find_command_syntax(l->verb);
    require(l->n >= f->least && l->n <= f->most && !l->is_change);
    for (int i = 0; i < l->n; i++)
        require(l->v[i] >= f->lowest && l->v[i] <= f->highest);
    for (int i = 0; i < 2; i++)
        require((*l->name[i] != 0) == (i < f->names + f->behind) &&
                strlen(l->name[i]) < CONTROL_NAME);
    check_command_round_trip(l, f);
}

static void parse_control_text(const char *text, struct playback *playback)
{
    struct control_line line;
    struct glint_error error;
    int frame;

    if (control_parse_line(text, "fuzz:7", &line, &error) != GLINT_OK) {
        require(!strncmp(error.text, "fuzz:7:", 7) && atoi(error.text + 7) > 0);
        return;
    }
    check_parsed_command(&line);
    playback_execute_command(playback, &line);
    frame = playback_next_frame(playback, .04);
    require(frame >= 0 && frame <= playback->last);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct playback playback;
    struct control_line line;
    char *const text = malloc(size + 1);
    char *at;

    if (!text)
        return 0;
    memcpy(text, data, size);
    for (size_t i = 0; i < size; i++)
        text[i] = (char)(text[i] ? text[i] : '?');
    text[size] = '\0';
    for (int i = 0; i < (int)size;) {
        const int n = keyboard_parse_key(text + i, (int)size - i, &line);

        require(n > 0 && n <= (int)size - i);
        i += n;
    }
    playback_init(&playback);
    for (at = strtok(text, "\n"); at; at = strtok(NULL, "\n"))
        parse_control_text(at, &playback);
    free(text);
    return 0;
}
