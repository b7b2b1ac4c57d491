/* SPDX-License-Identifier: MIT */
#include "synth/item.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "options/tool.h"
#include "posix/output.h"

#define AT(member) offsetof(struct synth_item, member)
#define OF(member) offsetof(struct synth_light, member)
#define TEXT(member)                                    \
    {                                                   \
#member, AT(member), SYNTH_GIVEN, 0, 0, 0, 0,   \
            sizeof(((struct synth_item *)NULL)->member) \
    }
#define NUMBER(member, law, low, high, least, most)         \
    {                                                       \
#member, AT(member), law, low, high, least, most, 0 \
    }
#define LIGHT(member, law, low, high, least, most)          \
    {                                                       \
#member, OF(member), law, low, high, least, most, 0 \
    }

const struct synth_field synth_field[SYNTH_FIELDS] = {
    {"item", AT(number), SYNTH_COUNTED, 0, 0, 0, 2147483647, 0},
    NUMBER(seed, SYNTH_COUNTED, 0, 0, 0, 2147483647),
    TEXT(glint),
    NUMBER(width, SYNTH_COUNTED, 0, 0, 16, 8192),
    NUMBER(height, SYNTH_COUNTED, 0, 0, 16, 8192),
    TEXT(background),
    TEXT(background_key),
    TEXT(lens),
    TEXT(coating),
    NUMBER(quality, SYNTH_GIVEN, 0, 0, 0, 1),
    NUMBER(crop, SYNTH_EVEN, 0.5, 1, 0.01, 1),
    NUMBER(crop_x, SYNTH_EVEN, 0, 1, 0, 1),
    NUMBER(crop_y, SYNTH_EVEN, 0, 1, 0, 1),
    NUMBER(mirrored, SYNTH_WHOLE, 0, 1, 0, 1),
    NUMBER(level, SYNTH_LOG, 0.003, 0.3, 1e-6, 10),
    NUMBER(stops_down, SYNTH_EVEN, 0, 3, 0, 12),
    NUMBER(blades, SYNTH_WHOLE, 5, 11, 3, 64),
    NUMBER(rotation, SYNTH_EVEN, 0, 360, -360, 360),
    NUMBER(roundness, SYNTH_HALF, 0.1, 0.7, 0, 1),
    NUMBER(softness, SYNTH_EVEN, 0, 0, 0, 1),
    NUMBER(dust, SYNTH_HALF, 0.002, 0.05, 0, 0.5),
    NUMBER(dust_seed, SYNTH_WHOLE, 0, 1000000, 0, 2147483647),
    NUMBER(front_dust, SYNTH_HALF, 0.0005, 0.01, 0, 0.5),
    NUMBER(front_dust_seed, SYNTH_WHOLE, 0, 1000000, 0, 2147483647),
    NUMBER(haze, SYNTH_HALF, 0.00005, 0.002, 0, 0.4),
    NUMBER(ghost_level, SYNTH_LOG, 0.06, 1, 1e-6, 1e6),
    NUMBER(star, SYNTH_LOG, 0.1, 4, 0, 1e6),
    NUMBER(read_noise, SYNTH_LOG, 0.0003, 0.004, 0, 1),
    NUMBER(full_well, SYNTH_LOG, 1000, 30000, 1, 1e9),
    NUMBER(n_lights, SYNTH_WHOLE, 1, 3, 1, SYNTH_MAX_LIGHTS),
};

const struct synth_field synth_light_field[SYNTH_LIGHT_FIELDS] = {
    LIGHT(x, SYNTH_EVEN, -0.06, 1.06, -10, 11),
    LIGHT(y, SYNTH_EVEN, -0.06, 1.06, -10, 11),
    LIGHT(radius, SYNTH_LOG, 0.003, 0.03, 1e-4, 1),
    LIGHT(power, SYNTH_LOG, 0.1, 1, 1e-9, 1e9),
    LIGHT(kelvin, SYNTH_WHOLE, 1900, 9000, 1000, 40000),
};

/* ------------------------------------------------------------------- ranges */

static const struct synth_field *get_item_field(int k)
{
    return k < SYNTH_FIELDS ? &synth_field[k]
                            : &synth_light_field[k - SYNTH_FIELDS];
}

void synth_ranges_set_defaults(struct synth_ranges *ranges)
{
    for (int k = 0; k < SYNTH_FIELDS + SYNTH_LIGHT_FIELDS; k++) {
        ranges->low[k] = get_item_field(k)->low;
        ranges->high[k] = get_item_field(k)->high;
    }
}

static int find_random_parameter(const char *name, size_t n)
{
    for (int k = 0; k < SYNTH_FIELDS + SYNTH_LIGHT_FIELDS; k++)
        if (get_item_field(k)->law > SYNTH_COUNTED &&
            strlen(get_item_field(k)->name) == n &&
            strncmp(get_item_field(k)->name, name, n) == 0)
            return k;
    return -1;
}

bool synth_ranges_parse(struct synth_ranges *ranges, const char *text,
                        struct glint_error *why)
{
    const size_t n = strcspn(text, "=");
    const int k = find_random_parameter(text, n);
    const struct synth_field *f;
    double v[2];
    int count;

    if (k < 0) {
        snprintf(why->text, sizeof why->text,
                 "'%.*s' is not a range; --range list prints all names",
                 (int)(n < 60 ? n : 60), text);
        return false;
    }
    f = get_item_field(k);
    count = text[n] ? tool_parse_numbers(text + n + 1, v, 2) : 0;
    if (count == 1)
        v[1] = v[0];
    if (count == 0 || v[0] > v[1] || v[0] < f->least || v[1] > f->most ||
        ((f->law == SYNTH_LOG || f->law == SYNTH_HALF) && v[0] <= 0 &&
         v[1] > 0)) {
        snprintf(
            why->text, sizeof why->text,
            "%s must be LOW,HIGH or one number within %g to %g%s, not '%.40s'",
            f->name, f->least, f->most,
            f->law == SYNTH_LOG || f->law == SYNTH_HALF
                ? ", LOW above 0 or both 0"
                : "",
            text[n] ? text + n + 1 : "");
        return false;
    }
    ranges->low[k] = v[0];
    ranges->high[k] = v[1];
    return true;
}

void synth_ranges_print(FILE *file, const struct synth_ranges *ranges)
{
    static const char *const law[] = {
        "",
        "",
        "uniform",
        "log-uniform",
        "0 for half of the items, else log-uniform",
        "whole numbers"};

    for (int k = 0; k < SYNTH_FIELDS + SYNTH_LIGHT_FIELDS; k++)
        if (get_item_field(k)->law > SYNTH_COUNTED)
            fprintf(file, "%s=%.7g,%.7g  %s\n", get_item_field(k)->name,
                    ranges->low[k], ranges->high[k],
                    law[get_item_field(k)->law]);
}

void synth_ranges_write_json(struct json_writer *json,
                             const struct synth_ranges *ranges)
{
    for (int k = 0; k < SYNTH_FIELDS + SYNTH_LIGHT_FIELDS; k++)
        if (get_item_field(k)->law > SYNTH_COUNTED)
            json_write(json, "%s: [%.9g, %.9g]", get_item_field(k)->name,
                       ranges->low[k], ranges->high[k]);
}

/* ------------------------------------------------------------------ drawing */

uint64_t synth_draw_random_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

uint64_t synth_item_init_random_state(const struct synth_item *item,
                                      const char *what)
{
    uint64_t state =
        (uint64_t)item->seed << 32 ^ (uint64_t)(uint32_t)item->number;

    for (state = synth_draw_random_bits(&state); *what; what++) {
        state ^= (unsigned char)*what;
        state = synth_draw_random_bits(&state);
    }
    return state;
}

/* Returns a random number in [0, 1) that depends on ITEM's seed and number
 * and on WHAT. */
static double draw_random_fraction(const struct synth_item *item,
                                   const char *what)
{
    uint64_t state = synth_item_init_random_state(item, what);

    return (double)(synth_draw_random_bits(&state) >> 11) * 0x1p-53;
}

int synth_item_draw_random_index(const struct synth_item *item,
                                 const char *what, int n)
{
    return (int)(draw_random_fraction(item, what) * n);
}

/* Returns a random value of the member NAME, distributed by LAW between LOW
 * and HIGH, rounded to 1e-6. */
static double draw_random_value(const struct synth_item *item, const char *name,
                                enum synth_law law, double low, double high)
{
    double x = draw_random_fraction(item, name), value;

    if (law == SYNTH_WHOLE)
        return floor(low + x * (high - low + 1));
    if (law == SYNTH_HALF) {
        if (x < 0.5)
            return 0;
        x = 2 * x - 1;
    }
    value = law == SYNTH_EVEN ? low + x * (high - low)
            : low > 0         ? low * pow(high / low, x)
                              : 0;
    return nearbyint(value * 1e6) / 1e6;
}

static double *find_number_in_struct(void *from,
                                     const struct synth_field *field)
{
    return (double *)(void *)((char *)from + field->at);
}

void synth_item_randomise(struct synth_item *item,
                          const struct synth_ranges *ranges, int seed,
                          int number)
{
    char name[32];

    item->seed = seed;
    item->number = number;
    for (int k = 0; k < SYNTH_FIELDS; k++)
        if (synth_field[k].law > SYNTH_COUNTED)
            *find_number_in_struct(item, &synth_field[k]) =
                draw_random_value(item, synth_field[k].name, synth_field[k].law,
                                  ranges->low[k], ranges->high[k]);
    for (int i = 0; i < SYNTH_MAX_LIGHTS; i++)
        for (int k = 0; k < SYNTH_LIGHT_FIELDS; k++) {
            snprintf(name, sizeof name, "%s %d", synth_light_field[k].name, i);
            *find_number_in_struct(&item->light[i], &synth_light_field[k]) =
                draw_random_value(item, name, synth_light_field[k].law,
                                  ranges->low[SYNTH_FIELDS + k],
                                  ranges->high[SYNTH_FIELDS + k]);
        }
    item->light[0].power = 1;
}

/* ----------------------------------------------------------------- printing */

/* Writes X, a multiple of 1e-6, without trailing zeros. */
static void write_exact_decimal(struct json_writer *json, const char *name,
                                double x)
{
    char text[40], format[16];
    int n = snprintf(text, sizeof text, "%.6f", x), digits = 6;

    while (digits > 0 && text[--n] == '0')
        digits--;
    snprintf(format, sizeof format, "%%s: %%.%df", digits);
    json_write(json, format, name, x);
}

static void write_json_fields(struct json_writer *json,
                              const struct synth_field *field, int n,
                              const void *from)
{
    for (int k = 0; k < n; k++) {
        const char *const at = (const char *)from + field[k].at;

        if (field[k].text_bytes)
            json_write(json, "%s: %s", field[k].name, at);
        else
            write_exact_decimal(json, field[k].name,
                                *(const double *)(const void *)at);
    }
}

static void write_item_result(struct json_writer *json,
                              const struct synth_item *item,
                              const struct synth_result *r)
{
    json_write(json,
               "drawn: {background_ev: %.6g, f_number: %.6g, focal_mm: %.6g, "
               "sensor_width_mm: %.6g, lights: [",
               r->background_ev, r->f_number, r->focal_mm, r->sensor_width_mm);
    for (int i = 0; i < (int)item->n_lights; i++)
        json_write(json,
                   "{power: %.6g, white: %.6g, theta_deg: %.6g, "
                   "phi_deg: %.6g, rgb: [%.6g, %.6g, %.6g]}",
                   r->power[i], r->white[i], r->theta_deg[i], r->phi_deg[i],
                   r->rgb[i][0], r->rgb[i][1], r->rgb[i][2]);
    json_write(json, "]}");
}

char *synth_item_format_json(const struct synth_item *item,
                             const struct synth_result *result)
{
    char *text = NULL;
    size_t bytes = 0;
    struct json_writer json = {.to = glint_memory_file_open(&text, &bytes)};

    if (!json.to)
        return NULL;
    json_write(&json, "{");
    write_json_fields(&json, synth_field, SYNTH_FIELDS, item);
    json_write(&json, "lights: [");
    for (int i = 0; i < (int)item->n_lights; i++) {
        json_write(&json, "{");
        write_json_fields(&json, synth_light_field, SYNTH_LIGHT_FIELDS,
                          &item->light[i]);
        json_write(&json, "}");
    }
    json_write(&json, "]");
    write_item_result(&json, item, result);
    json_write(&json, "}\n");
    if (glint_memory_file_close(json.to))
        return text;
    free(text);
    return NULL;
}
