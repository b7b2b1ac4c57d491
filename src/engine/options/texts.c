/* SPDX-License-Identifier: MIT */
#include "engine/options/texts.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "glint/area.h"

/* Parses NAME followed by a number LOW .. HIGH at *AT. Moves *AT past the comma
 * that follows, or to the end of the text. If the text does not begin with NAME
 * and such a number, returns false and does not change *AT. */
static bool parse_named_part(const char **at, const char *name, double low,
                             double high, double *value)
{
    const size_t n = strlen(name);
    const char *end;
    double number;

    if (strncmp(*at, name, n) != 0)
        return false;
    number = glint_option_number(*at + n, &end);
    if (end == *at + n || (*end && *end != ',') ||
        !(number >= low && number <= high))
        return false;
    *value = number;
    *at = *end ? end + 1 : end;
    return true;
}

bool glint_option_stop(const char *text, struct glint_stop_shape *stop)
{
    const bool is_circle = strncmp(text, "circle", 6) == 0;
    struct glint_stop_shape s = {0, 0, 0, 0};
    const char *at = text;
    double n = 0;

    if (is_circle) {
        if (text[6] && text[6] != ',')
            return false;
        at += text[6] ? 7 : 6;
    } else if (!parse_named_part(&at, "polygon:", 3, GLINT_MAX_BLADES, &n) ||
               n != floor(n))
        return false;
    if (!is_circle && *at && *at != 'r' && *at != 's' &&
        !parse_named_part(&at, "", -1e9, 1e9, &s.rotation_deg))
        return false;
    while (*at)
        if ((is_circle ||
             !parse_named_part(&at, "round:", 0, 1, &s.roundness)) &&
            !parse_named_part(&at, "soft:", 0, 1, &s.softness))
            return false;
    if (at > text && at[-1] == ',')
        return false;
    s.n_blades = (int)n;
    *stop = s;
    return true;
}

bool glint_option_dust(const char *text, double *fraction, int *seed)
{
    double v[2] = {0, 1};

    if (glint_option_numbers(text, v, 2) == 0 || v[0] < 0 || v[0] > 0.5 ||
        v[1] != floor(v[1]) || v[1] < 0 || v[1] > INT_MAX)
        return false;
    *fraction = v[0];
    *seed = (int)v[1];
    return true;
}

bool glint_option_waves(const char *text, struct glint_waves *waves)
{
    double *const nm = waves->nm;

    if (strcmp(text, "auto") == 0) {
        waves->kind = GLINT_WAVES_AUTO;
        return true;
    }
    waves->kind = GLINT_WAVES_LIST;
    waves->n = glint_option_numbers(text, nm, GLINT_MAX_WAVELENGTHS);
    if (waves->n == 1 && nm[0] >= 1 && nm[0] <= GLINT_MAX_WAVELENGTHS &&
        nm[0] == floor(nm[0])) {
        waves->kind = GLINT_WAVES_COUNT;
        waves->n = (int)nm[0];
        return true;
    }
    for (int i = 0; i < waves->n; i++)
        if (nm[i] < 300 || nm[i] > 1100)
            return false;
    return waves->n > 0;
}

bool glint_option_sensor(const char *text, double mm[2])
{
    const char *end;

    mm[0] = glint_option_number(text, &end);
    return end != text && *end == 'x' &&
           glint_option_numbers(end + 1, &mm[1], 1) == 1 && mm[0] >= 0.1 &&
           mm[0] <= 1000 && mm[1] >= 0.1 && mm[1] <= 1000;
}

/* default distance of a lamp's lower brightness threshold below its upper
 * threshold, stops */
#define EXTENDS_EV 0.05

bool glint_option_threshold(const char *text, double ev[2])
{
    double v[2];
    const int n = glint_option_numbers(text, v, 2);

    if (n == 1)
        v[1] = fmax(v[0] - EXTENDS_EV, -20);
    if (n == 0 || !(v[0] <= 0) || !(v[1] >= -20 && v[1] <= v[0]))
        return false;
    memcpy(ev, v, sizeof v);
    return true;
}

bool glint_option_light_at(const char *text, struct glint_light_at *at)
{
    *at = (struct glint_light_at){.ev = GLINT_LIGHT_AT_EV};
    for (int k = 0; k < 2; k++) {
        const char *end;

        at->xy[k] = glint_option_number(text, &end);
        if (end == text || !(fabs(at->xy[k]) <= 1e6))
            return false;
        at->is_percent[k] = *end == '%';
        text = end + at->is_percent[k];
        if (k == 0 && *text++ != ',')
            return false;
    }
    at->has_ev = *text == ',';
    if (strcmp(text, ",off") == 0) {
        at->ev = -INFINITY;
        return true;
    }
    return at->has_ev ? glint_option_numbers(text + 1, &at->ev, 1) == 1 &&
                            at->ev >= -40 && at->ev <= 90
                      : *text == '\0';
}

bool glint_lamp_power_is_valid(double power, const double rgb[3])
{
    const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));

    return power >= 0 && power <= GLINT_MAX_LAMP_POWER &&
           most <= GLINT_MAX_LAMP_POWER && power * most <= GLINT_MAX_LAMP_POWER;
}

bool glint_option_light(const char *text, struct glint_lamp *lamp)
{
    double v[7] = {0, 0, 1, 1, 1, 1, 0};
    const int n = glint_option_numbers(text, v, 7);

    if ((n != 2 && n != 3 && n < 6) || v[6] < 0 || v[6] > 45 || v[0] < 0 ||
        v[0] > 89.9 || v[3] < 0 || v[4] < 0 || v[5] < 0 ||
        !glint_lamp_power_is_valid(v[2], v + 3))
        return false;
    *lamp = (struct glint_lamp){.theta_deg = v[0],
                                .phi_deg = v[1],
                                .power = v[2],
                                .rgb = {v[3], v[4], v[5]}};
    glint_area_set_round(lamp, tan(v[6] * GLINT_PI / 180));
    return true;
}

bool glint_option_text_is_valid(enum glint_option_id id, const char *text)
{
    struct glint_stop_shape stop;
    struct glint_waves waves;
    struct glint_light_at at;
    struct glint_lamp lamp;
    double v[3];
    int seed;

    switch (id) {
    case GLINT_OPTION_OF_stop:
        return glint_option_stop(text, &stop);
    case GLINT_OPTION_OF_dust:
    case GLINT_OPTION_OF_front_dust:
        return glint_option_dust(text, v, &seed);
    case GLINT_OPTION_OF_wavelengths:
        return glint_option_waves(text, &waves);
    case GLINT_OPTION_OF_sensor:
        return glint_option_sensor(text, v);
    case GLINT_OPTION_OF_threshold:
        return glint_option_threshold(text, v);
    case GLINT_OPTION_OF_light_at:
        return glint_option_light_at(text, &at);
    case GLINT_OPTION_OF_light:
        return glint_option_light(text, &lamp);
    case GLINT_OPTION_OF_show:
        return strcmp(text, "lights") == 0 || strcmp(text, "timeline") == 0;
    default:
        return true;
    }
}
