/* SPDX-License-Identifier: MIT */
#include "filter/values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/options.h"

/* A parameter. Range, default and help are those of the option NAME. */
struct row {
    const char *name;
    /* upper end of the range that hosts show, which is the value 1 of frei0r;
     * 0: upper end of the option's range */
    double high;
    const char *label; /* label; NULL: same as NAME */
};

/* ffmpeg passes parameters to frei0r in this order, so new rows must be
 * appended. Only the name is required. */
static const struct row rows[FILTER_MAX] = {
    {"lens", 0, "Lens: name or file"},
    {"strength", 1, "Strength"},
    {"gain", 2, "Gain"},
    {"starburst", 2, "Starburst"},
    {"quality", 1, "Quality"},
    [FILTER_AUTO] = {"auto", 1, "Find lamps; off: one lamp at x, y"},
    [FILTER_X] = {"x", 1, "Lamp x if auto is off: 0 left, 1 right"},
    [FILTER_Y] = {"y", 1, "Lamp y if auto is off: 0 top, 1 bottom"},
    {"f-number", 0, "F-number, as 5.6"},
    {"style", 0, "Style"},
};

/* Returns the type that hosts show for OPTION. A number without a default, such
 * as the f-number, is shown as a text; "" means the value of the lens. */
static enum filter_type find_parameter_type(const struct glint_option *option)
{
    if (option->type == GLINT_OPTION_FLAG)
        return FILTER_SWITCH;
    return option->type == GLINT_OPTION_REAL && !isnan(option->initial)
               ? FILTER_NUMBER
               : FILTER_TEXT;
}

bool filter_get_parameter(int index, struct filter_parameter *p)
{
    const struct row *const row =
        index >= 0 && index < FILTER_MAX ? &rows[index] : NULL;
    const struct glint_option *option;

    if (!row || !row->name)
        return false;
    option = glint_option_named(row->name);
    *p = (struct filter_parameter){
        row->name,  row->label ? row->label : row->name,
        row->label, FILTER_NUMBER,
        0,          row->high,
        0.5,        index != FILTER_AUTO};
    if (index == FILTER_AUTO) {
        p->type = FILTER_SWITCH;
        p->initial = 1;
    }
    if (!option)
        return true;
    p->help = option->help;
    p->type = find_parameter_type(option);
    p->low = option->low;
    p->high = row->high > 0 ? row->high : option->high;
    p->initial = option->initial;
    p->is_live =
        p->type == FILTER_NUMBER && option->changes == GLINT_OPTION_FRAME;
    return true;
}

bool filter_is_default(const struct filter_parameter *p, double number)
{
    return !(number < p->initial || number > p->initial);
}

void filter_values_init(struct filter_values *values)
{
    struct filter_parameter p;

    memset(values, 0, sizeof *values);
    for (int i = 0; filter_get_parameter(i, &p); i++)
        values->number[i] = p.type == FILTER_TEXT ? 0 : p.initial;
}

void filter_values_free(struct filter_values *values)
{
    for (int i = 0; i < FILTER_MAX; i++) {
        free(values->text[i]);
        values->text[i] = NULL;
    }
}

void filter_values_copy(struct filter_values *to,
                        const struct filter_values *from)
{
    *to = *from;
    for (int i = 0; i < FILTER_MAX; i++)
        to->text[i] = from->text[i] ? strdup(from->text[i]) : NULL;
}

static bool is_same_text(const char *a, const char *b)
{
    return strcmp(a ? a : "", b ? b : "") == 0;
}

bool filter_values_same_except_live(const struct filter_values *a,
                                    const struct filter_values *b)
{
    struct filter_parameter p;

    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (!p.is_live &&
            (a->number[i] < b->number[i] || a->number[i] > b->number[i] ||
             !is_same_text(a->text[i], b->text[i])))
            return false;
    return true;
}

void filter_set_number(struct filter_values *values, int index, double number)
{
    struct filter_parameter p;

    if (!filter_get_parameter(index, &p))
        return;
    number = isfinite(number) ? fmin(fmax(number, p.low), p.high) : p.initial;
    values->number[index] =
        p.type == FILTER_SWITCH ? (number >= 0.5 ? 1 : 0) : number;
}

void filter_set_text(struct filter_values *values, int index, const char *text)
{
    free(values->text[index]);
    values->text[index] = text && *text ? strdup(text) : NULL;
}
