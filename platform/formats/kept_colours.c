/* SPDX-License-Identifier: MIT */
#include "formats/kept_colours.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void glint_kept_note(char notes[GLINT_KEPT_NOTES], const char *text)
{
    const size_t used = strlen(notes);

    snprintf(notes + used, GLINT_KEPT_NOTES - used, "%s%s", used ? "; " : "",
             text);
}

/* Sets C by CICP, the numbers of primaries and transfer in ITU-T H.273. Returns
 * false if it does not know the transfer. */
static bool set_by_cicp(struct glint_colours *c, const int cicp[2])
{
    static const double p3[4][2] = {
        {0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, {0.3127, 0.329}};
    static const double bt2020[4][2] = {
        {0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}};

    if (cicp[1] == 13)
        glint_colours_set(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    else if (cicp[1] == 8)
        glint_colours_set(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else if (cicp[1] == 4 || cicp[1] == 5)
        glint_colours_set(c, GLINT_TONE_IS_GAMMA, cicp[1] == 4 ? 2.2 : 2.8,
                          "gamma");
    else if (cicp[1] == 1 || cicp[1] == 6 || cicp[1] == 14 || cicp[1] == 15)
        glint_colours_set(c, GLINT_TONE_IS_BT709, 0, "BT.709");
    else
        return false;
    if (cicp[0] == 9)
        return glint_colours_primaries(c, bt2020);
    return cicp[0] != 12 || glint_colours_primaries(c, p3);
}

/* Sets C by NAME, OpenImageIO's name of a colour space. Returns false if it
 * does not know NAME. */
static bool set_by_name(struct glint_colours *c, const char *name)
{
    static const double adobe[4][2] = {
        {0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.329}};
    double gamma;

    if (strcasecmp(name, "sRGB") == 0)
        glint_colours_set(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    else if (strcasecmp(name, "linear") == 0 ||
             strncasecmp(name, "lin_", 4) == 0)
        glint_colours_set(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else if (strcasecmp(name, "Rec709") == 0)
        glint_colours_set(c, GLINT_TONE_IS_BT709, 0, "BT.709");
    else if (strcasecmp(name, "AdobeRGB") == 0) {
        glint_colours_set(c, GLINT_TONE_IS_GAMMA, 563 / 256.0, "Adobe RGB");
        return glint_colours_primaries(c, adobe);
    } else if (strncmp(name, "Gamma", 5) == 0 &&
               (gamma = strtod(name + 5, NULL)) > 0.1 && gamma < 10)
        glint_colours_set(c, GLINT_TONE_IS_GAMMA, gamma, "gamma");
    else
        return false;
    return true;
}

void glint_kept_set_colours(struct glint_kept *k,
                            const struct glint_oiio_facts *facts)
{
    struct glint_samples *const s = &k->samples;
    struct glint_colours *const c = &s->colours;
    char text[96];
    bool known = true;

    if (k->is_float)
        glint_colours_set(c, GLINT_TONE_IS_LINEAR, 0, "linear");
    else
        glint_colours_set(c, GLINT_TONE_IS_SRGB, 0, "sRGB");
    if (facts->cicp[1])
        known = set_by_cicp(c, facts->cicp);
    else if (facts->icc)
        known = glint_icc_read(c, facts->icc, facts->icc_bytes);
    else if (facts->gamma > 0.1 && facts->gamma < 10)
        glint_colours_set(c, GLINT_TONE_IS_GAMMA, facts->gamma, "gamma");
    else if (*facts->colour_space && !k->is_float)
        known = set_by_name(c, facts->colour_space);
    if (!facts->icc && !facts->cicp[1] && facts->has_primaries)
        glint_colours_primaries(c, (const double(*)[2])facts->primaries);
    if (known)
        return;
    snprintf(text, sizeof text, "%.24s is not known here; taken as %s",
             facts->cicp[1] ? "the transfer of its cICP"
             : facts->icc   ? "what its profile says"
                            : facts->colour_space,
             k->is_float ? "linear" : "sRGB");
    glint_kept_note(k->note, text);
}
