/* SPDX-License-Identifier: MIT */
#include "lamp_files/lamp_save.h"

#include <math.h>
#include <stdio.h>

static void write_text_to_lamp_file(struct lamp_save *s, const char *text,
                                    int n)
{
    if (s->status == GLINT_OK)
        s->status = glint_output_write(&s->out, text, (size_t)n, &s->error);
}

enum glint_status lamp_save_open(struct lamp_save *save, const char *path,
                                 struct glint_error *error)
{
    static const char heading[] =
        "frame,x,y,power,r,g,b,size,id,shape,turn,level,seen\n";
    enum glint_status status;

    *save = (struct lamp_save){.status = GLINT_OK};
    status = glint_output_open(&save->out, path, GLINT_OUTPUT_TEXT, error);
    save->is_open = status == GLINT_OK;
    if (save->is_open)
        write_text_to_lamp_file(save, heading, (int)sizeof heading - 1);
    return status;
}

void lamp_save_write_row(struct lamp_save *save, const struct lamp_row *r)
{
    char line[400];

    if (!(fabs(r->x) <= 1e6 && fabs(r->y) <= 1e6))
        return;
    write_text_to_lamp_file(
        save, line,
        snprintf(line, sizeof line,
                 "%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%lu,%."
                 "17g,%.17g,%.17g,%.17g\n",
                 r->frame, r->x, r->y, r->power, r->rgb[0], r->rgb[1],
                 r->rgb[2], r->size, (unsigned long)r->id, r->shape, r->turn,
                 r->level, r->seen));
}

enum glint_status lamp_save_finish(struct lamp_save *save,
                                   struct glint_error *error)
{
    enum glint_status status = save->status;

    if (!save->is_open)
        return GLINT_OK;
    save->is_open = false;
    if (status == GLINT_OK)
        return glint_output_commit(&save->out, error);
    *error = save->error;
    glint_output_abort(&save->out);
    return status;
}

void lamp_save_abort(struct lamp_save *save)
{
    if (save->is_open)
        glint_output_abort(&save->out);
    save->is_open = false;
}
