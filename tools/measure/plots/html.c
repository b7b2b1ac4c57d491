/* SPDX-License-Identifier: MIT */
#include "measure/plots/plot.h"

#include <stdarg.h>
#include <string.h>

static const char shared[] =
    "body{font:15px/1.45 sans-serif;max-width:1060px;margin:2em auto;"
    "padding:0 1em;color:#222}table{border-collapse:collapse;font-size:13px}"
    "td,th{padding:2px 9px;text-align:right;border-bottom:1px solid #ddd}"
    "td:first-child,th:first-child{text-align:left}figure{display:inline-block;"
    "margin:0 8px 14px 0;vertical-align:top;font-size:12px}"
    "img{display:block}svg{max-width:100%;height:auto}.worse{color:#b01e1e}";

/* Writes TEXT with < > & and " escaped as HTML entities. */
static void html_write_text(FILE *file, const char *text)
{
    for (; *text; text++)
        if (strchr("&<>\"", *text))
            fprintf(file, "&#%d;", *text);
        else
            fputc(*text, file);
}

void html_write_head(FILE *file, const char *title, const char *style)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width\">\n<title>",
          file);
    html_write_text(file, title);
    fprintf(file, "</title>\n<style>%s%s</style></head><body>\n<h1>", shared,
            style);
    html_write_text(file, title);
    fputs("</h1>\n", file);
}

void html_write_table_row(FILE *file, const char *tag, const char *format, ...)
{
    char text[1024], *cell = text, *end;
    va_list values;

    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fputs("<tr>", file);
    do {
        end = strchr(cell, '|');
        if (end)
            *end = '\0';
        fprintf(file, "<%s%s>", tag, *cell == '!' ? " class=\"worse\"" : "");
        html_write_text(file, cell + (*cell == '!'));
        fprintf(file, "</%s>", tag);
        cell = end + 1;
    } while (end);
    fputs("</tr>\n", file);
}

void html_write_end(FILE *file)
{
    fputs("</body></html>\n", file);
}
