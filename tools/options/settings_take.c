/* SPDX-License-Identifier: MIT */
#include "options/settings_take.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/area.h"
#include "desk/stop_option.h"
#include "options/settings_waves.h"

/* The result of taking an option; the first two stand for false and true. */
enum taken { WRONG, TAKEN, OTHER };

static bool parse_sensor(const char *text, double mm[2])
{
    char *end;

    mm[0] = strtod(text, &end);
    return end != text && *end == 'x' && tool_number(end + 1, &mm[1]) &&
           mm[0] >= 0.1 && mm[0] <= 1000 && mm[1] >= 0.1 && mm[1] <= 1000;
}

/* Sets LOG2 to the logarithm of TEXT, a power of two from 2^3 to 2^6. Returns
 * false for other texts. */
static bool parse_side(const char *text, int *log2)
{
    int side;

    if (!tool_integer(text, 8, 64, &side))
        return false;
    for (*log2 = 3; side > 1 << *log2; ++*log2)
        ;
    return side == 1 << *log2;
}

static bool take_error(const char *text, struct settings *s)
{
    double px;

    if (!tool_number(text, &px) || px <= 0)
        return false;
    settings_set_quality(s, glint_quality_for_error(px));
    return true;
}

static bool take_dispersion(const char *text, struct settings *s)
{
    double px;

    if (!tool_number(text, &px) || (px != 0 && !(px >= 0.1 && px <= 100)))
        return false;
    s->dials.dispersion_q8 = (int)lrint(px * 256);
    return true;
}

static bool take_quantum(const char *text, struct settings *s)
{
    if (!tool_number(text, &s->quantum) || s->quantum < 0 || s->quantum > 50)
        return false;
    s->dials.irradiance_steps = glint_quality_steps(s->quantum);
    return true;
}

static bool take_whole(const char *text, struct settings *s)
{
    double codes;

    if (!tool_number(text, &codes) || codes < 0 || codes > 100)
        return false;
    s->dials.snap_codes_q8 = (int)lrint(codes * 256);
    return true;
}

void settings_set_quality(struct settings *s, double quality)
{
    const struct glint_quality q = glint_quality_at(quality);
    const unsigned kept = s->dials.flags & GLINT_DIAL_ALWAYS_HALF;

    s->quality = quality;
    s->dials = q.dials;
    s->dials.flags |= kept;
    s->quantum = q.quantum;
    s->tolerance = q.tolerance;
    s->has_grid = true;
}

bool settings_take_quality(struct settings *s, const char *text)
{
    const bool exact = strcmp(text, "exact") == 0;
    const int name = tool_word(text, glint_quality_name);
    double quality = exact ? 1 : glint_quality_named(name);

    if (!exact && name < 0 &&
        (!tool_number(text, &quality) || quality < 0 || quality > 1))
        return false;
    settings_set_quality(s, quality);
    s->has_quality = true;
    if (exact)
        s->rays = SETTINGS_RAYS_EXACT;
    return true;
}

static bool take_projection(struct settings *s, const char *value)
{
    static const char *const words[] = {"tan", "lens", NULL};
    const int word = tool_word(value, words);

    s->by_lens = word == 1;
    return word >= 0;
}

/* Takes the options of the lens. */
static enum taken take_lens(struct settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_ZOOM:
        return zoom_option_take(&s->zoom, value);
    case OPT_FOCUS:
        return zoom_option_focus(&s->zoom, value);
    case OPT_F_NUMBER:
        return tool_number(value, &s->f_number) && s->f_number > 0;
    case OPT_STOP:
        return stop_option_take(&s->stop, value);
    case OPT_STOP_MASK:
        s->stop.mask_file = value;
        return true;
    case OPT_DUST:
        return stop_option_dust(&s->stop, value);
    case OPT_FRONT_DUST:
        return front_option_dust(&s->front, value);
    case OPT_FRONT_MASK:
        s->front.mask_file = value;
        return true;
    case OPT_PROJECTION:
        return take_projection(s, value);
    case OPT_WAVELENGTHS:
        return settings_take_waves(s, value);
    case OPT_DISPERSION:
        return take_dispersion(value, s);
    case OPT_SENSOR:
        return parse_sensor(value, s->sensor_mm);
    case OPT_GHOST:
        return tool_integer(value, 0, INT_MAX, &s->only_ghost);
    case OPT_GHOSTS:
        s->ghosts_file = value;
        return *value != '\0';
    case OPT_BALANCE:
        s->balance = true;
        return TAKEN;
    default:
        return OTHER;
    }
}

static bool take_starburst(const char *value, struct settings *s)
{
    s->starburst_asked = true;
    s->starburst = 0;
    return strcmp(value, "off") == 0 ||
           (tool_number(value, &s->starburst) && s->starburst >= 0 &&
            s->starburst <= 1000);
}

static bool take_only(const char *value, struct settings *s)
{
    static const char *const parts[] = {"ghosts", "starburst", "veil", "all",
                                        NULL};
    const int part = tool_word(value, parts);

    s->ghosts_only = part == 0;
    s->starburst_only = part == 1;
    s->veil_only = part == 2;
    return part >= 0;
}

/* Takes the options of light, and of which lights are drawn. */
static enum taken take_light(struct settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_EXPOSURE:
        s->has_exposure = true;
        return tool_number(value, &s->exposure_ev) &&
               fabs(s->exposure_ev) <= 100;
    case OPT_GAIN:
        return tool_number(value, &s->gain) && s->gain >= 0;
    case OPT_STARBURST:
        return take_starburst(value, s);
    case OPT_VEIL:
        return tool_number(value, &s->veil) && s->veil >= 0 &&
               s->veil + s->haze <= GLINT_MOST_VEIL;
    case OPT_HAZE:
        return tool_number(value, &s->haze) && s->haze >= 0 &&
               s->veil + s->haze <= GLINT_MOST_VEIL;
    case OPT_ONLY:
        return take_only(value, s);
    case OPT_MAX_LIGHTS:
        return tool_integer(value, 1, 1 << 20, &s->max_lights);
    case OPT_AREA_SAMPLES:
        return tool_integer(value, 1, GLINT_AREA_MOST_SAMPLES,
                            &s->area_samples_asked);
    case OPT_APART:
        return tool_number(value, &s->apart_px) && s->apart_px >= 0 &&
               s->apart_px <= 1000;
    case OPT_CULL:
        return tool_number(value, &s->dials.cull_codes) &&
               s->dials.cull_codes >= 0 && s->dials.cull_codes <= 16;
    case OPT_STAR_CULL:
        return tool_number(value, &s->dials.star_cull) &&
               s->dials.star_cull >= 0 && s->dials.star_cull <= 256;
    case OPT_DIM:
        return tool_number(value, &s->dials.dim_codes) &&
               s->dials.dim_codes >= 0 && s->dials.dim_codes <= 256;
    default:
        return OTHER;
    }
}

/* Takes the options of the way from rays to pixels. */
static enum taken take_way(struct settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_GRID:
        s->has_grid = true;
        return tool_integer(value, 4, GLINT_MAX_CELLS, &s->dials.fineness);
    case OPT_TILE:
        return parse_side(value, &s->tile_log2);
    case OPT_DITHER:
        s->dither = true;
        return TAKEN;
    default:
        return OTHER;
    }
}

/* Takes the options that trade accuracy for time. */
static enum taken take_dial(struct settings *s, int option, const char *value)
{
    static const char *const rays[] = {"model", "exact", NULL};
    int word;

    switch (option) {
    case OPT_QUANTUM:
        return take_quantum(value, s);
    case OPT_WHOLE:
        return take_whole(value, s);
    case OPT_HALF:
        s->dials.flags |= GLINT_DIAL_ALWAYS_HALF;
        return TAKEN;
    case OPT_QUALITY:
        return settings_take_quality(s, value);
    case OPT_ERROR:
        return take_error(value, s);
    case OPT_WORK:
        if (!tool_number(value, &s->most_minsn) || s->most_minsn < 0 ||
            s->most_minsn > 1e9)
            return WRONG;
        s->most_minsn *= 1000;
        s->has_work = true;
        return TAKEN;
    case OPT_BUDGET:
        return tool_number(value, &s->budget_ms) && s->budget_ms > 0 &&
               s->budget_ms <= 1e6;
    case OPT_RAYS:
        word = tool_word(value, rays);
        s->rays = word == 0 ? SETTINGS_RAYS_MODEL : SETTINGS_RAYS_EXACT;
        return word >= 0;
    default:
        return OTHER;
    }
}

bool settings_take(struct settings *settings, int option, const char *value)
{
    enum taken taken = take_lens(settings, option, value);

    if (taken == OTHER)
        taken = take_light(settings, option, value);
    if (taken == OTHER)
        taken = take_way(settings, option, value);
    if (taken == OTHER)
        taken = take_dial(settings, option, value);
    return taken == TAKEN;
}
