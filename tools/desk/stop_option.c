/* SPDX-License-Identifier: MIT */
#include "desk/stop_option.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Takes a number LOW .. HIGH after NAME from *AT, and what follows it up to the
 * next comma. Returns false, and leaves *AT, if it does not begin with NAME. */
static bool take_part(const char **at, const char *name, double low,
                      double high, double *value)
{
    const size_t n = strlen(name);
    double number;
    char *end;

    if (strncmp(*at, name, n) != 0)
        return false;
    number = strtod(*at + n, &end);
    if (end == *at + n || (*end && *end != ',') ||
        !(number >= low && number <= high))
        return false;
    *value = number;
    *at = *end ? end + 1 : end;
    return true;
}

bool stop_option_take(struct stop_option *stop, const char *text)
{
    struct glint_iris iris = stop->iris;
    const char *at = text;
    double n = 0, rotation = 0;
    const bool is_circle = strncmp(text, "circle", 6) == 0;

    iris.roundness = iris.softness = 0;
    if (is_circle) {
        if (text[6] && text[6] != ',')
            return false;
        at += text[6] ? 7 : 6;
    } else if (!take_part(&at, "polygon:", 3, GLINT_MAX_BLADES, &n) ||
               n != floor(n))
        return false;
    if (!is_circle && *at && *at != 'r' && *at != 's' &&
        !take_part(&at, "", -1e9, 1e9, &rotation))
        return false;
    while (*at)
        if ((is_circle || !take_part(&at, "round:", 0, 1, &iris.roundness)) &&
            !take_part(&at, "soft:", 0, 1, &iris.softness))
            return false;
    if (at > text && at[-1] == ',')
        return false;
    stop->n_blades = (int)n;
    stop->rotation_deg = rotation;
    stop->iris = iris;
    stop->is_asked = true;
    return true;
}

bool stop_option_specks(const char *text, double *share, int *seed)
{
    double v[2] = {0, 1};

    if (tool_numbers(text, v, 2) == 0 || v[0] < 0 || v[0] > 0.5 ||
        v[1] != floor(v[1]) || v[1] < 0 || v[1] > INT_MAX)
        return false;
    *share = v[0];
    *seed = (int)v[1];
    return true;
}

bool stop_option_dust(struct stop_option *stop, const char *text)
{
    return stop_option_specks(text, &stop->iris.dust, &stop->iris.dust_seed);
}

bool stop_option_shades(const struct stop_option *stop)
{
    return stop->iris.softness > 0 || stop->iris.dust > 0 || stop->mask_file;
}

enum glint_status stop_option_set(const struct stop_option *stop,
                                  struct glint_setup *setup,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error)
{
    *dirt = NULL;
    return stop->iris.roundness > 0 || stop_option_shades(stop)
               ? glint_setup_iris(setup, &stop->iris, dirt, error)
               : GLINT_OK;
}

void stop_option_close(struct stop_option *stop)
{
    glint_dirt_free(stop->dirt);
    free(stop->mask);
}
