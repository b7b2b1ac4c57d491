/* SPDX-License-Identifier: MIT
 *
 * draw.h - draws the layers of an item of a data set, in linear light, and
 * simulates a sensor's image of them.
 *
 * The item's ghost_level sets the brightness of the ghosts. The power of the
 * lights follows from this brightness. The power determines the brightness of
 * the lights' discs, the starburst and the haze. The item's star scales the
 * starburst.
 */
#ifndef GLINT_TOOLS_SYNTH_DRAW_H
#define GLINT_TOOLS_SYNTH_DRAW_H

#include "model/opened_lens.h"
#include "synth/item.h"

struct synth_backgrounds {
    int n;
    char **path; /* paths of the pictures, [n], sorted by file name without
                    folder */
};

enum synth_layer {
    SYNTH_BASE,
    SYNTH_SOURCE, /* the discs of the lights */
    SYNTH_GLARE,  /* starburst and haze of the lights */
    SYNTH_GHOSTS,
    SYNTH_LAYERS
};

struct synth_drawing {
    int width, height;
    float *layer[SYNTH_LAYERS]; /* linear light of each layer,
                                   [height][width][3] */
    /* fraction of each pixel that lights cover, 0 .. 1, [height][width][3] */
    float *cover;
};

/* max mean light of the ghosts if ghost_level is 1, where 1 is white */
#define SYNTH_MOST_MEAN 0.2

enum { SYNTH_MAX_LENSES = 64 };

struct synth_lens {
    struct settings settings;
    struct opened_lens opened;
    char name[64], coating[64];
    double quality;
    double widest; /* smallest f-number that the model was baked for */
};

/* Opened lenses; each lens is opened only once. */
struct synth_lenses {
    int n;
    struct synth_lens *lens[SYNTH_MAX_LENSES];
};

/* Lists image files, sorted by name. WORDS[N] are files, or folders whose
 * image files are recognised by extension. Names must be unique. Returns an
 * exit code. */
int synth_backgrounds_open(const struct tool *tool,
                           struct synth_backgrounds *list, char **words, int n);

void synth_backgrounds_close(struct synth_backgrounds *list);

/* Returns the part of PATH after its last slash. */
const char *synth_background_file_name(const char *path);

/* Sets KEY to a hash of the bytes of the file PATH. */
enum glint_status synth_hash_background(char key[20], const char *path,
                                        struct glint_error *error);

enum glint_status synth_drawing_init(struct synth_drawing *d, int width,
                                     int height);

void synth_drawing_finish(struct synth_drawing *d);

/* Opens the lens of ITEM, unless it is open already, and sets *LENS to it.
 * Returns an exit code. */
int synth_lens_open(const struct tool *tool, struct synth_lenses *lenses,
                    const struct synth_item *item, struct synth_lens **lens);

void synth_lenses_close(struct synth_lenses *lenses);

/* Draws the layers of ITEM into D, which must have ITEM's size, and sets
 * RESULT. Returns an exit code. */
int synth_draw_item(const struct tool *tool, struct synth_lenses *lenses,
                    const struct synth_backgrounds *backgrounds,
                    const struct synth_item *item, struct synth_drawing *d,
                    struct synth_result *result);

/* Sets RGB to the sum of the layers of D whose bits are set in LAYERS. */
void synth_sum_layers(const struct synth_drawing *d, unsigned layers,
                      float *rgb);

/* Adds photon noise and read noise of ITEM's sensor to RGB. */
void synth_add_noise(const struct synth_item *item, float *rgb);

#endif
