/* SPDX-License-Identifier: MIT
 *
 * Detects the format of a lens file and decodes its bytes to text.
 */
#include <string.h>
#include <strings.h>

#include "import/imported.h"

static const struct import_format formats[] = {
    {"zmx", ".zmx", import_zmx},
    {"seq", ".seq", import_seq},
    {"oslo", ".len", import_oslo},
    {"pbrt", ".dat", import_pbrt},
    {"flaresim", ".lens", import_flaresim},
    {"realflare", ".json", import_realflare},
    {"openlensflare", ".xml", import_openlensflare},
    {"polyflare", ".fx", import_polyflare},
    {"opticalbench", ".txt", import_opticalbench},
    {"lentil", "lenses.json", import_lentil},
};

enum { N_FORMATS = sizeof formats / sizeof *formats };

const struct import_format *import_get_format(int k)
{
    return k >= 0 && k < N_FORMATS ? &formats[k] : NULL;
}

const struct import_format *import_find_format(const char *name)
{
    const char *end = strrchr(name, '.');

    for (int k = 0; k < N_FORMATS && end; k++)
        if (strcasecmp(end, formats[k].end) == 0)
            return &formats[k];
    return NULL;
}

/* Converts DATA from byte AT on from UTF-16 to one byte per unit. Characters
 * other than ASCII become '?'. HIGH: position of the high byte in a unit, 0 or
 * 1. */
static void convert_utf16_to_bytes(uint8_t *data, size_t *bytes, size_t at,
                                   int high)
{
    size_t n = 0;

    for (; at + 1 < *bytes; at += 2) {
        const uint8_t low = data[at + (size_t)!high];

        data[n++] = data[at + (size_t)high] != 0 || low > 126 ? '?' : low;
    }
    *bytes = n;
}

/* Replaces '\r' by '\n' if the text has no '\n'. */
static void convert_line_ends(uint8_t *data, size_t bytes)
{
    if (bytes == 0 || memchr(data, '\n', bytes))
        return;
    for (size_t i = 0; i < bytes; i++)
        if (data[i] == '\r')
            data[i] = '\n';
}

/* Decodes DATA[*BYTES] in place: converts UTF-16 to ASCII, other characters to
 * '?', removes a byte order mark, and converts line ends '\r' to '\n'. UTF-16
 * without a byte order mark is recognised if it is little-endian. */
static void decode_text(uint8_t *data, size_t *bytes)
{
    if (*bytes >= 2 && data[0] == 0xff && data[1] == 0xfe)
        convert_utf16_to_bytes(data, bytes, 2, 1);
    else if (*bytes >= 2 && data[0] == 0xfe && data[1] == 0xff)
        convert_utf16_to_bytes(data, bytes, 2, 0);
    else if (*bytes >= 4 && data[0] && !data[1] && data[2] && !data[3])
        convert_utf16_to_bytes(data, bytes, 0, 1);
    else if (*bytes >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0) {
        *bytes -= 3;
        memmove(data, data + 3, *bytes);
    }
    convert_line_ends(data, *bytes);
}

char *import_parse_file(struct imported *lens,
                        const struct import_format *format, uint8_t *data,
                        size_t *bytes)
{
    lens->format = format->name;
    decode_text(data, bytes);
    if (*bytes && memchr(data, 0, *bytes)) {
        imported_report_error(lens, 0, "is not a text file");
        return NULL;
    }
    if (!format->read(lens, (const char *)data, *bytes) || lens->error[0])
        return NULL;
    if (lens->key && !lens->keyed) {
        imported_report_error(lens, 0, "has one lens; --lens is not needed");
        return NULL;
    }
    if (lens->position > 1 && !lens->chosen) {
        imported_report_error(lens, 0, "position %d of 1", lens->position);
        return NULL;
    }
    return imported_write_table(lens, bytes);
}
