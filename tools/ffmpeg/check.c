/* SPDX-License-Identifier: MIT
 *
 * What an encoder has written: whether it decodes, and which properties of the
 * input it lacks.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "ffmpeg/ffmpeg.h"
#include "ffmpeg/pixels.h"
#include "posix/error.h"

enum { LINE = 512, CAUSE = 48 };

/* The frames to decode: the first one, those from a second before the end on,
 * or all. */
enum piece { FIRST, LAST, ALL };

/* Sets CAUSE to LINE, a message of ffmpeg, without the context before it:
 * "[h264 @ 0x55d0] " or URL and ": ". */
static void set_cause(char cause[CAUSE], const char *line, const char *url)
{
    const char *const context = *line == '[' ? strstr(line, "] ") : NULL;
    const size_t n = strlen(url);

    if (context)
        line = context + 2;
    else if (strncmp(line, url, n) == 0 && line[n] == ':')
        line += n + 1 + (line[n + 1] == ' ');
    snprintf(cause, CAUSE, "%.*s", (int)strcspn(line, "\r\n"), line);
}

/* Reads from FROM what ffmpeg prints: a line that begins with a digit for each
 * frame, lines with '#', and messages, the first of which becomes CAUSE.
 * Returns the number of frames, or 0 if the file is cut off. */
static long count_frames(FILE *from, const char *url, char cause[CAUSE])
{
    char line[LINE];
    bool is_cut = false;
    long n = 0;

    while (fgets(line, sizeof line, from)) {
        n += isdigit((unsigned char)*line) != 0;
        if (!*cause && *line != '#' && !isdigit((unsigned char)*line))
            set_cause(cause, line, url);
        for (int i = 0; ffmpeg_cut_words[i]; i++)
            is_cut |= strstr(line, ffmpeg_cut_words[i]) != NULL;
    }
    return is_cut ? 0 : n;
}

/* Decodes PIECE of URL. Returns false if that fails or yields no frame, with
 * the reason in CAUSE. */
static bool decode(const char *url, enum piece piece, char cause[CAUSE])
{
    /* Packets from the key frame before the place on give frames only with the
     * time stamps that they have in the file. */
    static const char *const from_end[] = {"-copyts", "-noaccurate_seek",
                                           "-sseof", "-1", NULL};
    const char *argv[24] = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel",
                            "error",  "-xerror",  "-err_detect",  "explode"};
    const char *const rest[] = {
        "-i", url,        "-map",      "0:v:0",
        "-f", "framecrc", "-frames:v", piece == FIRST ? "1" : "999999999",
        "-",  NULL};
    struct glint_error error;
    struct child child;
    FILE *from;
    long n = 0;
    int k = 8;

    for (int i = 0; piece == LAST && from_end[i]; i++)
        argv[k++] = from_end[i];
    for (int i = 0; rest[i]; i++)
        argv[k++] = rest[i];
    *cause = '\0';
    if (child_start(&child, argv, CHILD_PRINTS, &error) != GLINT_OK) {
        snprintf(cause, CAUSE, "%.*s", CAUSE - 1, error.text);
        return false;
    }
    from = fdopen(child.fd, "r");
    if (from) {
        n = count_frames(from, url, cause);
        fclose(from);
        child.fd = -1;
    }
    if (child_end(&child) == 0 && n > 0)
        return true;
    if (!*cause)
        snprintf(cause, CAUSE, "ffmpeg decodes no frame");
    return false;
}

enum glint_status ffmpeg_check(const char *file, const char *name,
                               struct glint_error *error)
{
    char url[FFMPEG_URL], cause[CAUSE];
    bool has_first;

    if (!ffmpeg_url(url, file))
        return glint_error_report(error, GLINT_E_OUTPUT, name,
                                  "the name is too long");
    has_first = decode(url, FIRST, cause);
    /* Files without an index, as .ts, are not found a way into from their end;
     * all of their frames are decoded. */
    if (has_first && (decode(url, LAST, cause) || decode(url, ALL, cause)))
        return GLINT_OK;
    return glint_error_report(
        error, GLINT_E_OUTPUT, name,
        "the %s frame does not decode (%s); choose another encoder "
        "(--encode) or type of file",
        has_first ? "last" : "first", cause);
}

void ffmpeg_report_losses(const char *file, const char *name,
                          const char *pixels)
{
    struct ffmpeg_video made;
    char text[160] = "";
    size_t n = 0;

    ffmpeg_probe(&made, file);
    if (!*made.pixels || !*pixels)
        return;
    if (pixels_bits(made.pixels) < pixels_bits(pixels))
        n += (size_t)snprintf(text, sizeof text, ", %d bits in place of %d",
                              pixels_bits(made.pixels), pixels_bits(pixels));
    if (strcmp(pixels_chroma(pixels), "gray") != 0 &&
        strcmp(pixels_chroma(made.pixels), "444") != 0 &&
        strcmp(pixels_chroma(made.pixels), pixels_chroma(pixels)) != 0)
        n += (size_t)snprintf(
            text + n, sizeof text - n, ", chroma %s in place of %s",
            pixels_chroma(made.pixels),
            pixels_are_rgb(pixels) ? "RGB" : pixels_chroma(pixels));
    if (pixels_have_alpha(pixels) && !pixels_have_alpha(made.pixels))
        snprintf(text + n, sizeof text - n, ", no alpha");
    if (*text)
        fprintf(stderr,
                "glint overlay: %s: has %s; see --encode for encoders that "
                "keep more\n",
                name, text + 2);
}
