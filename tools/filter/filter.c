/* SPDX-License-Identifier: MIT */
#include "filter/filter.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "overlay/compositor.h"

const double filter_default[FILTER_NUMBERS] = {
    [FILTER_STRENGTH] = 0.5, [FILTER_GAIN] = 0.5, [FILTER_STARBURST] = 0.5,
    [FILTER_QUALITY] = 0.5,  [FILTER_AUTO] = 1,   [FILTER_X] = 0.5,
    [FILTER_Y] = 0.5};

struct filter {
    struct tool tool;
    struct glint_error cause; /* of a failure, as hosts show it */
    struct compositor compositor;
    int width, height;
    double number[FILTER_NUMBERS];
    char *word[FILTER_WORDS];
    char quality[32], light_at[64]; /* kept: options point to them */
    /* Values of the style, or those of glint overlay. */
    double strength, gain, starburst;
    locale_t c_locale; /* hosts have others, in which 5.6 is no number */
    bool is_open, failed;
};

struct filter *filter_create(const char *host, int width, int height)
{
    struct filter *const f = calloc(1, sizeof *f);

    if (!f)
        return NULL;
    f->tool =
        (struct tool){.name = host, .where = "parameter", .cause = &f->cause};
    f->width = width;
    f->height = height;
    memcpy(f->number, filter_default, sizeof f->number);
    f->c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return f;
}

static void shut(struct filter *f)
{
    if (f->is_open)
        compositor_close(&f->compositor);
    tool_finish(&f->tool);
    f->is_open = false;
}

void filter_destroy(struct filter *f)
{
    if (!f)
        return;
    shut(f);
    for (int i = 0; i < FILTER_WORDS; i++)
        free(f->word[i]);
    if (f->c_locale)
        freelocale(f->c_locale);
    free(f);
}

/* --------------------------------------------------------------- parameters */

static bool is_on(double value)
{
    return value >= 0.5;
}

/* Returns whether a change of WHICH from BEFORE to AFTER asks for another
 * compositor; others are turned from picture to picture. */
static bool reopens(enum filter_number which, double before, double after)
{
    switch (which) {
    case FILTER_QUALITY:
        return before < after || before > after;
    case FILTER_AUTO:
        return is_on(before) != is_on(after);
    default:
        return false;
    }
}

void filter_set_number(struct filter *f, enum filter_number which, double value)
{
    const double before = f->number[which];

    f->number[which] =
        isfinite(value) ? fmin(fmax(value, 0), 1) : filter_default[which];
    if (reopens(which, before, f->number[which])) {
        shut(f);
        f->failed = false;
    }
}

void filter_set_word(struct filter *f, enum filter_word which, const char *text)
{
    char *copy;

    if (strcmp(filter_word(f, which), text ? text : "") == 0)
        return;
    copy = text ? strdup(text) : NULL;
    shut(f); /* its options point to the words */
    free(f->word[which]);
    f->word[which] = copy;
    f->failed = false;
}

double filter_number(const struct filter *f, enum filter_number which)
{
    return f->number[which];
}

const char *filter_word(const struct filter *f, enum filter_word which)
{
    return f->word[which] ? f->word[which] : "";
}

/* ------------------------------------------------------------------ opening */

static int take(struct filter *f, int option, const char *value)
{
    return compositor_option(&f->tool, &f->compositor, option, value);
}

static bool at_default(const struct filter *f, enum filter_number which)
{
    return !(f->number[which] < filter_default[which] ||
             f->number[which] > filter_default[which]);
}

/* Takes the words and the quality as options; returns -1 or an exit code. The
 * style comes first, so that others replace its own. */
static int take_all(struct filter *f)
{
    static const struct {
        enum filter_word word;
        int option;
    } words[] = {{FILTER_STYLE, ENGINE_OPTION_OF(style)},
                 {FILTER_LENS, ENGINE_OPTION_OF(lens)},
                 {FILTER_F_NUMBER, ENGINE_OPTION_OF(f_number)}};
    int code = -1;

    for (int i = 0; i < FILTER_WORDS && code == -1; i++)
        if (*filter_word(f, words[i].word))
            code = take(f, words[i].option, filter_word(f, words[i].word));
    if (code == -1 && !at_default(f, FILTER_QUALITY)) {
        snprintf(f->quality, sizeof f->quality, "%.17g",
                 f->number[FILTER_QUALITY]);
        code = take(f, ENGINE_OPTION_OF(quality), f->quality);
    }
    if (code == -1 && !is_on(f->number[FILTER_AUTO])) {
        snprintf(f->light_at, sizeof f->light_at, "%.17g,%.17g",
                 f->number[FILTER_X] * f->width,
                 f->number[FILTER_Y] * f->height);
        code = take(f, ENGINE_OPTION_OF(light_at), f->light_at);
    }
    return code;
}

static bool open_filter(struct filter *f)
{
    struct compositor *const c = &f->compositor;
    int code;

    f->cause.text[0] = '\0';
    memset(c, 0, sizeof *c);
    compositor_defaults(c);
    f->is_open = true;
    code = take_all(f);
    if (code == -1)
        code = tool_start(&f->tool);
    if (code == EXIT_OK)
        code = compositor_open(&f->tool, c);
    if (code == EXIT_OK)
        code = compositor_size(&f->tool, c, f->width, f->height);
    f->strength = c->strength.asked;
    f->gain = c->settings.options.gain;
    f->starburst = c->settings.options.starburst;
    return code == EXIT_OK;
}

/* ------------------------------------------------------------------ drawing */

static double turned(const struct filter *f, enum filter_number which,
                     double factor, double otherwise)
{
    return at_default(f, which) ? otherwise : factor * f->number[which];
}

/* Sets what may change between pictures. */
static void turn(struct filter *f)
{
    struct compositor *const c = &f->compositor;

    c->strength.asked = turned(f, FILTER_STRENGTH, 1, f->strength);
    c->settings.options.gain = turned(f, FILTER_GAIN, 2, f->gain);
    c->settings.options.starburst =
        turned(f, FILTER_STARBURST, 2, f->starburst);
    if (c->is_listed) {
        c->list.row[0].x = f->number[FILTER_X] * f->width;
        c->list.row[0].y = f->number[FILTER_Y] * f->height;
    }
}

static bool opened(struct filter *f)
{
    if (!f->is_open && !f->failed)
        f->failed = !open_filter(f);
    return !f->failed;
}

static bool draw(struct filter *f, const struct glint_image *image,
                 int32_t elapsed_us)
{
    if (!opened(f))
        return false;
    turn(f);
    if (compositor_draw(&f->compositor, image, elapsed_us) != GLINT_OK) {
        f->failed = true;
        tool_error(&f->tool, "no memory; pictures stay as they are");
    }
    return !f->failed;
}

const char *filter_cause(const struct filter *f)
{
    return f->cause.text;
}

/* Sets the locale of numbers and returns what leave() restores. */
static locale_t enter(const struct filter *f)
{
    return f->c_locale ? uselocale(f->c_locale) : (locale_t)0;
}

static void leave(locale_t before)
{
    if (before)
        uselocale(before);
}

bool filter_open(struct filter *f)
{
    const locale_t before = enter(f);
    const bool is_open = opened(f);

    leave(before);
    return is_open;
}

bool filter_draw(struct filter *f, const struct glint_image *image,
                 int32_t elapsed_us)
{
    const locale_t before = enter(f);
    const bool is_drawn = draw(f, image, elapsed_us);

    leave(before);
    return is_drawn;
}
