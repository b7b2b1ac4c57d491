/* SPDX-License-Identifier: MIT */
#include "help/values.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "glint/options.h"

static const struct {
    /* command of the row; NULL: all other commands with the option */
    const char *command;
    const char *option, *takes;
} table[] = {
    /* The first row that matches is used. So the row of a single command must
     * precede the row of all commands. */
    {"bake", "max-angle", "degrees, 1 to 89"},
    {"bake", "lights", "a whole number, 0 to 16"},
    {"bake", "positions", "a whole number, 2 to 64"},
    {"bake", "halfway", "dB, 20 to 60, or 0"},
    {"bake", "size", "16, 32, 64, 128, 256, 512 or 1024"},
    {"bench", "format", "yuyv, i420, nv12, rgb24, xrgb8888 or rgb565"},
    {"compare", "exposure", "stops, -100 to 100, or auto"},
    {"draw", "angle", "degrees, 0 to 89"},
    {"draw", "ghost", "a ghost's number, from 0"},
    {"draw", "plane", "x or y"},
    {"draw", "rays", "a whole number, 1 to 41"},
    {"explain", "top", "a whole number, from 0"},
    {"import", "film", "WxH in mm, such as 36x24"},
    {"import", "format",
     "zmx, seq, oslo, pbrt, flaresim, realflare, lentil, openlensflare, "
     "polyflare or opticalbench"},
    {"import", "position", "a position of a zoom, 1 to 16"},
    {"live", "count", "frames, from 1"},
    {"live", "device",
     "/dev/videoN, a number, the name of a .y4m file, -, test or none"},
    {"live", "fit", "scale or centre"},
    {"live", "format", "a FOURCC such as YUYV, NV12 or MJPG"},
    {"live", "output",
     "fb[:/dev/fb0], kms[:HDMI-A-1], window, FILE.y4m, y4m:-, v4l2:/dev/videoN "
     "or "
     "null"},
    {"overlay", "format", "i420, i422, i444 or grey"},
    {"overlay", "frames", "A-B, the first and last frame, from 0"},
    {NULL, "stride", "bytes of a row, 1 to 131072"},
    {"overlay", "transfer",
     "auto, 709, srgb, linear, gamma22, gamma28, 240m, pq, hlg, log100 or "
     "log316"},
    {"render", "fps", "frames a second, 1 to 1000"},
    {"render", "light",
     "THETA,PHI[,POWER[,R,G,B[,SIZE]]] with THETA 0 to 89.9 degrees"},
    {"sweep", "angle", "up to 8 angles of 0 to 60 degrees, with commas"},
    {"sweep", "lights", "up to 8 whole numbers of 1 to 10000, with commas"},
    {"sweep", "repeat", "rounds, 1 to 100"},
    {"sweep", "size", "up to 8 sizes WxH, with commas"},
    {"synth", "count", "a whole number, 0 to 100000000"},
    {"synth", "layout", "plain, flare7k, bracketflare or wu2021"},
    {"synth", "lenses", "up to 64 names or files of lenses, with commas"},
    {"synth", "quality", "0 to 1, or least, draft, default, high, finest"},
    {"synth", "shard", "I/N, I from 0 and below N"},
    {"synth", "size", "WxH in pixels, each 16 to 8192"},
    {"trace", "angle", "degrees, between -90 and 90"},
    {"trace", "ghost", "a ghost's number, or -1 for the direct path"},
    {"trace", "grid", "a whole number, 1 to 4096"},

    {NULL, "band", "two wavelengths LO,HI in nm, within 300 to 1100"},
    {"styles", "width", "a whole number, 64 to 2048"},
    {NULL, "buffers", "a whole number, 2 to 32"},
    {NULL, "engine", "model or exact"},
    {NULL, "field", "millimetres, above 0"},
    {NULL, "fps", "N or N/D, frames a second, from 1"},
    {NULL, "frame", "a frame's number, from 0"},
    {NULL, "frames", "FIRST-LAST, such as 0-99"},
    {NULL, "input", "a number, 0 to 255"},
    {NULL, "io", "auto, mmap, userptr or read"},
    {NULL, "kernels",
     "auto, c, or what this processor has of sse41, avx2 and neon"},
    {NULL, "jpeg-quality", "a whole number, 1 to 100"},
    {NULL, "layers-type", "half or float"},
    {NULL, "matrix", "auto, 601 or 709"},
    {NULL, "picture", "codes or linear"},
    {NULL, "range", "auto, full or limited"},
    {NULL, "repeat", "a whole number, 1 to 1000"},
    {NULL, "seed", "a whole number, 0 to 2147483647"},
    {NULL, "size", "WxH in pixels, each 1 to 32768"},
    {NULL, "skip", "frames, from 0"},
    {NULL, "snapshot", "a file name with one %d, such as shot-%03d.ppm"},
    {NULL, "start-number", "a whole number, 0 to 1000000000"},
    {NULL, "stats", "auto, line, json or none"},
    {NULL, "threads", "a whole number, from 1"},
    {NULL, "tolerance", "a factor, 0.1 to 100"},
    {NULL, "wavelength", "nm, 300 to 1100; 0.55 micrometres are 550"},
    {NULL, "warm-up", "a whole number, from 0"},
};

const char *values_describe(const char *command, const char *option)
{
    static char of_engine[256];
    const struct glint_option *const row = glint_option_named(option);

    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(table[i].option, option) == 0 &&
            (table[i].command ? strcmp(table[i].command, command) == 0 : !row))
            return table[i].takes;
    if (!row)
        return NULL;
    glint_option_accepts(row, of_engine, sizeof of_engine);
    return of_engine;
}

/* Returns the end of the list item at TEXT: the position of ", ", "; ", " or
 * ", or the end of the text. */
static const char *find_item_end(const char *text)
{
    while (*text && strncmp(text, ", ", 2) != 0 &&
           strncmp(text, "; ", 2) != 0 && strncmp(text, " or ", 4) != 0)
        text++;
    return text;
}

/* Returns whether the list item at TEXT is a range of numbers, "LOW to
 * HIGH". */
static bool is_number_range(const char *text)
{
    const char *const to = strstr(text, " to ");

    return ((*text == '-' || (*text >= '0' && *text <= '9')) && to &&
            to < find_item_end(text)) ||
           strncmp(text, "above ", 6) == 0 || strncmp(text, "from ", 5) == 0;
}

/* Returns whether the list item TEXT[LENGTH] is a literal word, and not a
 * range, a placeholder, or a unit followed by a range. */
static bool is_literal_word(const char *text, size_t length)
{
    const char *const end = text + length;

    for (size_t i = 0; i < length; i++)
        if (!strchr("abcdefghijklmnopqrstuvwxyz0123456789-", text[i]))
            return false;
    return length > 0 && text[0] != '-' &&
           !(text[0] > '9' && strncmp(end, ", ", 2) == 0 &&
             is_number_range(end + 2));
}

void values_print_words(const char *command, const char *option)
{
    const char *text = option ? values_describe(command, option) : NULL;

    while (text && *text) {
        const char *const end = find_item_end(text);

        if (is_literal_word(text, (size_t)(end - text)))
            printf("%.*s\n", (int)(end - text), text);
        text = end + strcspn(end, " ");
        text += *text == ' ';
        text += strncmp(text, "or ", 3) == 0 ? 3 : 0;
    }
}
