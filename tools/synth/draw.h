/* SPDX-License-Identifier: MIT
 *
 * draw.h - the layers of an item, in linear light, and the picture that a
 * sensor records of them.
 *
 * ghost_level sets the brightness of the ghosts, and thereby the power of the
 * lights. Their own light, the star and the haze follow physically, except for
 * the star's factor.
 */
#ifndef GLINT_TOOLS_SYNTH_DRAW_H
#define GLINT_TOOLS_SYNTH_DRAW_H

#include "model/opened_lens.h"
#include "synth/item.h"

struct synth_backgrounds {
    int n;
    char **path; /* [n], by the names behind the last slash */
};

enum synth_layer {
    SYNTH_BASE,   /* the background */
    SYNTH_SOURCE, /* the lights themselves */
    SYNTH_GLARE,  /* their star and haze */
    SYNTH_GHOSTS,
    SYNTH_LAYERS
};

struct synth_drawing {
    int width, height;
    float *layer[SYNTH_LAYERS]; /* [height][width][3] linear light */
    float *cover; /* [height][width][3]: share that lights cover */
};

/* Mean light of ghosts whose level is 1, at most. */
#define SYNTH_MOST_MEAN 0.2

enum { SYNTH_MAX_LENSES = 64 };

struct synth_lens {
    struct settings settings;
    struct opened_lens opened;
    char name[64], coating[64];
    double quality;
    double widest; /* f-number of its model */
};

/* Lenses that have been opened, each once. */
struct synth_lenses {
    int n;
    struct synth_lens *lens[SYNTH_MAX_LENSES];
};

/* Lists the pictures of WORDS[N], files, or folders whose pictures are
 * recognised by their endings, sorted by name. Returns an exit code: names have
 * to differ. */
int synth_backgrounds_open(const struct tool *tool,
                           struct synth_backgrounds *list, char **words, int n);

void synth_backgrounds_close(struct synth_backgrounds *list);

/* Returns the name of PATH behind its last slash. */
const char *synth_background_name(const char *path);

/* Sets KEY to that of the bytes of the file PATH. */
enum glint_status synth_background_key(char key[20], const char *path,
                                       struct glint_error *error);

enum glint_status synth_drawing_init(struct synth_drawing *d, int width,
                                     int height);

void synth_drawing_finish(struct synth_drawing *d);

/* Sets *LENS to the lens of ITEM, opened. Returns an exit code. */
int synth_lens_open(const struct tool *tool, struct synth_lenses *lenses,
                    const struct synth_item *item, struct synth_lens **lens);

void synth_lenses_close(struct synth_lenses *lenses);

/* Draws the layers of ITEM into D, of its size, and stores the results. Returns
 * an exit code. */
int synth_draw(const struct tool *tool, struct synth_lenses *lenses,
               const struct synth_backgrounds *backgrounds,
               const struct synth_item *item, struct synth_drawing *d,
               struct synth_result *result);

/* Sets RGB to the sum of LAYERS of D, a bit each. */
void synth_sum(const struct synth_drawing *d, unsigned layers, float *rgb);

/* Adds the noise of ITEM's sensor to RGB: of photons, and of reading. */
void synth_noise(const struct synth_item *item, float *rgb);

#endif
