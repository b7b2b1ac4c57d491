/* SPDX-License-Identifier: MIT */
#include "options/json_writer.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "posix/error.h"

static const char letters[] =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789.-";

static void write_json_text(FILE *file, const char *text)
{
    fputc('"', file);
    while (*text) {
        const unsigned char c = (unsigned char)*text;
        const size_t length = glint_utf8_get_length(text);

        if (c == '"' || c == '\\')
            fputc('\\', file);
        if (length)
            fwrite(text, 1, length, file);
        else
            fprintf(file, "\\u%04x", c < 0x80 ? c : 0xfffdu);
        text += length ? length : 1;
    }
    fputc('"', file);
}

/* Writes the next argument of VALUES, an integer, by the conversion FORM. The
 * type of the integer is that of l, ll or z in FORM, else int. */
static void write_json_integer(FILE *file, const char *form, va_list *values)
{
    const char *const size = form + strcspn(form, "lz");

    if (*size == 'z')
        fprintf(file, form, va_arg(*values, size_t));
    if (*size == 'l' && size[1] == 'l')
        fprintf(file, form, va_arg(*values, long long));
    if (*size == 'l' && size[1] != 'l')
        fprintf(file, form, va_arg(*values, long));
    if (*size == '\0')
        fprintf(file, form, va_arg(*values, int));
}

/* Writes the next argument of VALUES by the conversion at FORMAT, which has N
 * characters. */
static void write_json_value(FILE *file, const char *format, size_t n,
                             va_list *values)
{
    const char kind = format[n - 1];
    const char *text;
    char form[16];
    double real;

    snprintf(form, sizeof form, "%.*s", (int)n, format);
    if (kind == 's') {
        text = va_arg(*values, const char *);
        if (text)
            write_json_text(file, text);
        else
            fputs("null", file);
    } else if (kind == 'c') {
        fputs(va_arg(*values, int) ? "true" : "false", file);
    } else if (kind != 'd' && kind != 'u') {
        real = va_arg(*values, double);
        isfinite(real) ? fprintf(file, form, real) : fputs("null", file);
    } else {
        write_json_integer(file, form, values);
    }
}

static void write_json_comma(struct json_writer *json, const char *comma)
{
    if (json->is_due)
        fputs(comma, json->to);
    json->is_due = false;
}

/* Writes the key, value or literal word that begins at AT in the format string.
 * Returns the position after it. */
static const char *write_json_word(struct json_writer *json, const char *at,
                                   va_list *values)
{
    const bool is_value = *at == '%';
    const size_t n =
        is_value ? strcspn(at, "cdefgsu") + 1 : strspn(at, letters);
    const size_t more = strspn(at + n, letters);

    write_json_comma(json, ", ");
    if (at[n + more] == ':') {
        fprintf(json->to,
                "\"%s%.*s\": ", is_value ? va_arg(*values, const char *) : "",
                (int)(is_value ? more : n), is_value ? at + n : at);
        return at + n + more + 1;
    }
    if (is_value)
        write_json_value(json->to, at, n, values);
    else
        fwrite(at, 1, n, json->to);
    json->is_due = true;
    return at + n;
}

void json_write(struct json_writer *json, const char *format, ...)
{
    va_list values;
    size_t n;

    va_start(values, format);
    while (*format) {
        n = 1;
        if (strchr("{[", *format)) {
            write_json_comma(json, ", ");
            fputc(*format, json->to);
        } else if (strchr("]}", *format)) {
            fputc(*format, json->to);
            json->is_due = true;
        } else if (*format == '\n') {
            n += strspn(format + 1, " ");
            /* No comma is due before a closing bracket or at the end of
             * FORMAT. */
            if (!strchr("]}", format[n]))
                write_json_comma(json, ",");
            fwrite(format, 1, n, json->to);
        } else if (*format == '%' || strchr(letters, *format)) {
            n = (size_t)(write_json_word(json, format, &values) - format);
        }
        format += n;
    }
    va_end(values);
}
