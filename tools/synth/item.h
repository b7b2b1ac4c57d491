/* SPDX-License-Identifier: MIT
 *
 * item.h - an item of a data set for flare removal: all numbers that define its
 * images.
 *
 *     synth_item_randomise(&item, &ranges, seed, number);  reproducible
 *     synth_item_format_json(&text, &item, &result);  as a line of a manifest
 *     synth_item_parse_json(&item, line, &error);  reads that line
 *
 * Each random number depends only on the seed, the item's number and the name
 * of the member. A new member therefore does not change the values of other
 * members. Numbers are rounded to 1e-6 and stored exactly, so that a line of
 * the manifest reproduces the item.
 */
#ifndef GLINT_TOOLS_SYNTH_ITEM_H
#define GLINT_TOOLS_SYNTH_ITEM_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "glint/status.h"
#include "options/json_writer.h"

enum { SYNTH_MAX_LIGHTS = 4, SYNTH_NAME_BYTES = 256 };

struct synth_light {
    /* position of the light, from the top left, as fractions of the picture's
     * width and height */
    double x, y;
    double radius; /* radius of the disc, fraction of the picture's height */
    /* power relative to the first light; ghost_level scales all lights */
    double power;
    double kelvin; /* colour temperature of a black body */
};

struct synth_item {
    double number, seed, width, height;
    char glint[16];                    /* version of glint that drew the item */
    char background[SYNTH_NAME_BYTES]; /* file name of the background without
                                          its folder */
    char background_key[20];           /* hash of the background file's bytes */
    char lens[64], coating[64];
    double quality;

    /* The crop of the background. crop: its size, as a fraction of the largest
     * crop of that shape. crop_x, crop_y: its position, 0 .. 1. mirrored: 1 if
     * it is mirrored. level: mean light to which the crop is scaled (1 =
     * white), by SYNTH_LEAST_EV to SYNTH_MOST_EV stops. */
    double crop, crop_x, crop_y, mirrored, level;

    /* The aperture stop: stops below the widest opening, and members of struct
     * glint_iris. */
    double stops_down, blades, rotation, roundness, softness;
    double dust, dust_seed, front_dust, front_dust_seed, haze;

    /* ghost_level: light of the brightest 0.1 % of the ghosts' pixels, from
     * which the power of the lights follows. The power is reduced if the mean
     * light of the ghosts would exceed SYNTH_MOST_MEAN times ghost_level. star:
     * factor on the brightness of the starburst. */
    double ghost_level, star;

    double read_noise, full_well; /* read noise, fraction of white; full well,
                                     electrons at white */

    double n_lights;
    struct synth_light light[SYNTH_MAX_LIGHTS];
};

enum { SYNTH_LEAST_EV = -7, SYNTH_MOST_EV = 1 };

/* Results for readers of a manifest; drawing does not use them. */
struct synth_result {
    double background_ev, f_number, focal_mm, sensor_width_mm;
    /* Values per light. power: in units of white x pixels; white: light of its
     * disc, 1 = white; theta_deg, phi_deg: angle off the axis and azimuth; rgb:
     * linear colour. */
    double power[SYNTH_MAX_LIGHTS], white[SYNTH_MAX_LIGHTS],
        theta_deg[SYNTH_MAX_LIGHTS], phi_deg[SYNTH_MAX_LIGHTS],
        rgb[SYNTH_MAX_LIGHTS][3];
};

enum { SYNTH_FIELDS = 30, SYNTH_LIGHT_FIELDS = 5 };

/* The range of each random number: members of the item, then members of a
 * light. */
struct synth_ranges {
    double low[SYNTH_FIELDS + SYNTH_LIGHT_FIELDS],
        high[SYNTH_FIELDS + SYNTH_LIGHT_FIELDS];
};

void synth_ranges_set_defaults(struct synth_ranges *ranges);

/* Parses TEXT, "NAME=LOW,HIGH" or "NAME=VALUE", into RANGES. Returns false,
 * with the cause in WHY, if the name is unknown or a number is out of range. */
bool synth_ranges_parse(struct synth_ranges *ranges, const char *text,
                        struct glint_error *why);

/* Prints each name with its range and law, one per line. */
void synth_ranges_print(FILE *file, const struct synth_ranges *ranges);

/* Writes RANGES as members of a JSON object. */
void synth_ranges_write_json(struct json_writer *json,
                             const struct synth_ranges *ranges);

/* Sets the numbers of ITEM to random values that depend on SEED and NUMBER.
 * Does not change texts, size and quality. */
void synth_item_randomise(struct synth_item *item,
                          const struct synth_ranges *ranges, int seed,
                          int number);

/* Returns a random integer, 0 .. N - 1, that depends on ITEM's seed and number
 * and on WHAT. */
int synth_item_draw_random_index(const struct synth_item *item,
                                 const char *what, int n);

/* synth_item_init_random_state() returns the initial state of a random
 * generator for the purpose WHAT of ITEM. synth_draw_random_bits() advances the
 * state and returns the next 64 bits [Steele14]. */
uint64_t synth_item_init_random_state(const struct synth_item *item,
                                      const char *what);
uint64_t synth_draw_random_bits(uint64_t *state);

/* Returns ITEM and RESULT as a line of JSON, which the caller frees, or NULL
 * if there is no memory. */
char *synth_item_format_json(const struct synth_item *item,
                             const struct synth_result *result);

/* Reads LINE, written by synth_item_format_json(). Returns GLINT_E_FORMAT with
 * ERROR if LINE is not JSON, or a member is missing or out of range;
 * GLINT_E_UNSUPPORTED if glint was built without jansson. */
enum glint_status synth_item_parse_json(struct synth_item *item,
                                        const char *line,
                                        struct glint_error *error);

/* Distribution of a member's random value */
enum synth_law {
    SYNTH_GIVEN,   /* not random */
    SYNTH_COUNTED, /* not random, an integer */
    SYNTH_EVEN,    /* uniform over the range */
    SYNTH_LOG,     /* logarithm uniform over the range */
    SYNTH_HALF,    /* 0 for half of the items, else like SYNTH_LOG */
    SYNTH_WHOLE    /* integers, uniform */
};
struct synth_field {
    const char *name;
    size_t at; /* offset of the double or text in the struct */
    enum synth_law law;
    double low, high;   /* default range of random values */
    double least, most; /* range of allowed values */
    size_t text_bytes;  /* size of the text; 0: the member is a number */
};
extern const struct synth_field synth_field[SYNTH_FIELDS];
extern const struct synth_field synth_light_field[SYNTH_LIGHT_FIELDS];

#endif
