/* SPDX-License-Identifier: MIT
 *
 * item.h - an item of a data set for flare removal: what is drawn, in numbers.
 *
 *     synth_item_draw(&item, &ranges, seed, number);   at random, the same
 * again synth_item_print(&text, &item, &result);         a line of a manifest
 *     synth_item_read(&item, line, &error);            and back
 *
 * Each number follows from the seed, the number of the item and its own name
 * alone, so that a new name changes no other. Numbers are rounded to a
 * millionth, which the line holds exactly: the line draws the same item. */
#ifndef GLINT_TOOLS_SYNTH_ITEM_H
#define GLINT_TOOLS_SYNTH_ITEM_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "glint/status.h"
#include "options/json_writer.h"

enum { SYNTH_MAX_LIGHTS = 4, SYNTH_NAME_BYTES = 256 };

struct synth_light {
    double x,
        y; /* place, fractions of the picture's sides, from the top left */
    double radius; /* fraction of the picture's height */
    double power;  /* over that of the first light, before ghost_level */
    double kelvin; /* colour, of a black body */
};

struct synth_item {
    double number, seed, width, height;
    char glint[16];                    /* version that drew it */
    char background[SYNTH_NAME_BYTES]; /* name of its file, without folder */
    char background_key[20];           /* of the bytes of that file */
    char lens[64], coating[64];
    double quality;

    /* The part of the background that is taken, as a fraction of the largest of
     * that shape, its place, whether it is mirrored, and the mean light it is
     * brought to, 1 = white; within limits of SYNTH_LEAST_EV. */
    double crop, crop_x, crop_y, mirrored, level;

    /* The stop: stops below the widest opening, and as of struct glint_iris. */
    double stops_down, blades, rotation, roundness, softness;
    double dust, dust_seed, front_dust, front_dust_seed, haze;

    /* Light that the brightest thousandth of the ghosts' pixels reach, which
     * states how bright the lights are, unless the mean would be above
     * SYNTH_MOST_MEAN of it; the star over what these give. */
    double ghost_level, star;

    double read_noise, full_well; /* of white; electrons of white */

    double n_lights;
    struct synth_light light[SYNTH_MAX_LIGHTS];
};

enum { SYNTH_LEAST_EV = -7, SYNTH_MOST_EV = 1 };

/* Results, for readers of a manifest; not an input. */
struct synth_result {
    double background_ev, f_number, focal_mm, sensor_width_mm;
    /* Of each light: display white times pixels, its own light over white, its
     * angles off the axis and about it, and its linear colour. */
    double power[SYNTH_MAX_LIGHTS], white[SYNTH_MAX_LIGHTS],
        theta_deg[SYNTH_MAX_LIGHTS], phi_deg[SYNTH_MAX_LIGHTS],
        rgb[SYNTH_MAX_LIGHTS][3];
};

enum { SYNTH_FIELDS = 30, SYNTH_LIGHT_FIELDS = 5 };

/* The range of each number that is drawn: those of the item, then those of a
 * light. */
struct synth_ranges {
    double low[SYNTH_FIELDS + SYNTH_LIGHT_FIELDS],
        high[SYNTH_FIELDS + SYNTH_LIGHT_FIELDS];
};

void synth_ranges_defaults(struct synth_ranges *ranges);

/* Takes TEXT, "NAME=LOW,HIGH" or "NAME=VALUE". Returns false if there is no
 * such name, or the numbers are out of what it may be; WHY then says it. */
bool synth_ranges_take(struct synth_ranges *ranges, const char *text,
                       struct glint_error *why);

/* Prints each name with its range and law, one per line. */
void synth_ranges_print(FILE *file, const struct synth_ranges *ranges);

/* Writes them as members of an object. */
void synth_ranges_json(struct json_writer *json,
                       const struct synth_ranges *ranges);

/* Draws the numbers of item NUMBER of SEED; members that are not numbers, the
 * size and the quality stay. */
void synth_item_draw(struct synth_item *item, const struct synth_ranges *ranges,
                     int seed, int number);

/* Returns a whole number, 0 .. N - 1, for WHAT is chosen for ITEM. */
int synth_item_choose(const struct synth_item *item, const char *what, int n);

/* Returns the state from which random bits for WHAT of ITEM begin, and the next
 * of these [Steele14]. */
uint64_t synth_item_stream(const struct synth_item *item, const char *what);
uint64_t synth_bits(uint64_t *state);

/* Returns ITEM and RESULT as a line of JSON, malloc'ed; NULL without memory. */
char *synth_item_print(const struct synth_item *item,
                       const struct synth_result *result);

/* Reads LINE, as synth_item_print() writes it. GLINT_E_FORMAT with ERROR: it is
 * not a JSON, or a member is missing or out of range. GLINT_E_UNSUPPORTED:
 * glint was built without jansson. */
enum glint_status synth_item_read(struct synth_item *item, const char *line,
                                  struct glint_error *error);

/* The members of an item for these two, in the order of the line. */
enum synth_law {
    SYNTH_GIVEN,   /* not drawn */
    SYNTH_COUNTED, /* not drawn, a whole number */
    SYNTH_EVEN,    /* evenly over the range */
    SYNTH_LOG,     /* its logarithm evenly */
    SYNTH_HALF,    /* 0 for half of the items, else as SYNTH_LOG */
    SYNTH_WHOLE    /* whole numbers, evenly */
};
struct synth_field {
    const char *name;
    size_t at; /* offset of the double, or of the text */
    enum synth_law law;
    double low, high;   /* range that is drawn, unless another is requested */
    double least, most; /* what the member may be */
    size_t text_bytes;  /* 0: a number */
};
extern const struct synth_field synth_field[SYNTH_FIELDS];
extern const struct synth_field synth_light_field[SYNTH_LIGHT_FIELDS];

#endif
