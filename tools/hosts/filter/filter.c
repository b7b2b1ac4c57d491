/* SPDX-License-Identifier: MIT */
#include "filter/filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "filter/values.h"
#include "overlay/drawing.h"

struct filter {
    struct tool tool;
    /* cause of the last failure, for display by hosts */
    struct glint_error cause;
    struct drawing drawing;
    int width, height;
    struct filter_values values;
    struct glint_options opened; /* options with which the lens was opened */
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
    filter_values_init(&f->values);
    return f;
}

static void close_filter_drawing(struct filter *f)
{
    if (f->is_open)
        drawing_close(&f->drawing);
    tool_stop_threads(&f->tool);
    f->is_open = false;
}

void filter_destroy(struct filter *f)
{
    if (!f)
        return;
    close_filter_drawing(f);
    filter_values_free(&f->values);
    free(f);
}

/* --------------------------------------------------------------- parameters */

void filter_set_live_values(struct filter *f,
                            const struct filter_values *values)
{
    struct filter_parameter p;

    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (p.is_live)
            f->values.number[i] = values->number[i];
}

void filter_set_values(struct filter *f, const struct filter_values *values)
{
    if (!filter_values_same_except_live(&f->values, values)) {
        /* The drawing is closed first, because its options point to the texts
         * of the old values. */
        close_filter_drawing(f);
        filter_values_free(&f->values);
        filter_values_copy(&f->values, values);
        f->failed = false;
    }
    filter_set_live_values(f, values);
}

bool filter_has_size(const struct filter *f, int width, int height)
{
    return width == f->width && height == f->height;
}

bool filter_is_reusable(const struct filter *f,
                        const struct filter_values *values, int width,
                        int height)
{
    return filter_has_size(f, width, height) &&
           filter_values_same_except_live(&f->values, values);
}

/* ------------------------------------------------------------------ opening */

/* Sets the option of parameter P to value number I. Returns -1 or an exit
 * code. */
static int set_filter_option(struct filter *f, const struct filter_parameter *p,
                             int i)
{
    const struct filter_values *const v = &f->values;

    if (p->type == FILTER_TEXT)
        return v->text[i] ? drawing_line_set_text(&f->tool, &f->drawing.line,
                                                  p->name, v->text[i])
                          : -1;
    return p->is_live || !glint_option_named(p->name) ||
                   filter_is_default(p, v->number[i])
               ? -1
               : drawing_line_set_number(&f->tool, &f->drawing.line, p->name,
                                         v->number[i]);
}

/* Sets all options that are not live. The style is set first, so that other
 * options override it. Returns -1 or an exit code. */
static int set_filter_options(struct filter *f)
{
    const struct filter_values *const v = &f->values;
    const struct glint_light_at at = {
        .xy = {v->number[FILTER_X] * f->width, v->number[FILTER_Y] * f->height},
        .ev = GLINT_LIGHT_AT_EV};
    struct filter_parameter p;
    int code = -1;

    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; filter_get_parameter(i, &p) && code == -1; i++)
            if ((pass == 0) == (strcmp(p.name, "style") == 0))
                code = set_filter_option(f, &p, i);
    if (code == -1 && v->number[FILTER_AUTO] < 0.5)
        code =
            drawing_line_set_text(&f->tool, &f->drawing.line, "lights", "none");
    if (code == -1 && v->number[FILTER_AUTO] < 0.5 &&
        !drawing_line_add_light(&f->drawing.line, &at))
        code = tool_fail(&f->tool, GLINT_E_MEMORY, NULL);
    return code;
}

static bool open_filter_drawing(struct filter *f)
{
    struct drawing *const c = &f->drawing;
    int code;

    f->cause.text[0] = '\0';
    memset(c, 0, sizeof *c);
    drawing_line_set_defaults(&c->line);
    f->is_open = true;
    code = set_filter_options(f);
    if (code == -1)
        code = tool_start_threads(&f->tool);
    if (code == EXIT_OK)
        code = drawing_open(&f->tool, c);
    if (code == EXIT_OK)
        code = drawing_allocate(&f->tool, c, f->width, f->height);
    f->opened = c->line.settings.options;
    return code == EXIT_OK;
}

bool filter_open_lens(struct filter *f)
{
    if (!f->is_open && !f->failed)
        f->failed = !open_filter_drawing(f);
    return !f->failed;
}

/* ------------------------------------------------------------------ drawing */

/* Sets all live options and the position of a manual lamp. */
static void apply_live_options(struct filter *f)
{
    const struct filter_values *const v = &f->values;
    struct drawing *const c = &f->drawing;
    struct glint_options *const o = &c->line.settings.options;
    struct filter_parameter p;
    struct glint_error error;

    *o = f->opened;
    for (int i = 0; filter_get_parameter(i, &p); i++)
        if (p.is_live && glint_option_named(p.name) &&
            !filter_is_default(&p, v->number[i]))
            glint_options_set(o, p.name, v->number[i], &error);
    if (c->files.is_listed) {
        c->files.list.row[0].x = v->number[FILTER_X] * f->width;
        c->files.list.row[0].y = v->number[FILTER_Y] * f->height;
    }
}

const char *filter_error_text(const struct filter *f)
{
    return f->cause.text;
}

bool filter_draw_flare(struct filter *f, const struct glint_image *image,
                       int32_t elapsed_us)
{
    if (!filter_open_lens(f))
        return false;
    apply_live_options(f);
    if (drawing_draw_flare(&f->drawing, image, elapsed_us) != GLINT_OK) {
        f->failed = true;
        tool_error(&f->tool, "out of memory; frames are passed unchanged");
    }
    return !f->failed;
}
