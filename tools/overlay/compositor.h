/* SPDX-License-Identifier: MIT
 *
 * The flare that overlay and live put on a picture, for lamps that are found in
 * it, listed, or given by hand.
 *
 *     compositor_defaults(&c);
 *     compositor_option(&tool, &c, option, optarg);   each option
 *     compositor_open(&tool, &c);                     lens and lists of lamps
 *     compositor_size(&tool, &c, width, height);      when the size changes
 *     compositor_draw(&c, &image, elapsed_us);        each frame
 *     compositor_close(&c);
 */
#ifndef GLINT_TOOLS_OVERLAY_COMPOSITOR_H
#define GLINT_TOOLS_OVERLAY_COMPOSITOR_H

#include "lamp_files/lamp_save.h"
#include "lamp_files/lamp_list.h"
#include "options/settings.h"
#include "engine/strength.h"

struct compositor {
    struct settings settings;
    const char *lens, *lights_file; /* NULL: lamps are found */
    const char *save_file;          /* file to save lamps to, or NULL */
    bool interpolate;               /* Lamps of a file move between its rows. */
    struct lamp_list at;            /* lamps given by hand, by pixel */
    double threshold_ev[2]; /* stops from white: that a lamp needs, and down to
                               which it extends */
    double headroom_ev;
    bool flare_only, no_tracking, show_lights;
    bool flare_alpha; /* alpha in files of the flare alone */
    /* Bytes reserved for frames, which take no more; 0: as many as they
     * need. */
    size_t reserve_bytes;
    int n_hand;
    struct glint_lamp hand[SETTINGS_MAX_LAMPS];
    /* How bright flares are to be, and the factor on the lamps' powers that
     * this gives for each frame. */
    struct glint_strength strength;
    /* what a picture by itself shows under its flare, from when its lamps are
     * found until it is exposed; else NULL */
    struct glint_ground *ground;
    int dial; /* option that set the brightness, OPT_STRENGTH or OPT_EXPOSURE;
                 0: none */

    /* Set by compositor_open() and compositor_size(). */
    bool is_listed;        /* Lamps come from a list, by file or by pixel. */
    struct lamp_list list; /* lamps of the file and those by pixel */
    struct lamp_save save;
    struct glint_lamp_detector finder;
    struct glint_lamp *lamp; /* lamps of the frame, with room for all by hand
                                and all found or read */
    double *level;   /* share of its power that each lamp has, as in struct
                        glint_strength_lamps */
    double *seen_px; /* extent of each lamp that the picture clips, or 0 */
    uint32_t *id;    /* number that each lamp is saved under */
    struct glint_response response;
    double white; /* light of the picture's white; 1, or as overlay_file.c sets
                     it */
    bool is_measured; /* the picture has the light of lamps beyond white */
    struct glint_view view;
    struct glint_frame frame;
    bool sized;

    /* These are of the last frame. */
    bool is_followed; /* The frame is of a video whose lamps are tracked. */
    int n_frames, n_lamps;
    double find_ms, flare_ms;
    struct glint_frame_report report;
};

enum compositor_option_code {
    OPT_LENS = OPT_LAST,
    OPT_LIGHTS,
    OPT_LIGHT,
    OPT_THRESHOLD,
    OPT_HEADROOM,
    OPT_LAYER,
    OPT_NO_TRACKING,
    OPT_SHOW,
    OPT_STRENGTH,
    OPT_LIGHT_AT,
    OPT_SAVE_LIGHTS,
    OPT_INTERPOLATE,
    OPT_COMPOSITOR_LAST
};

#define COMPOSITOR_OPTIONS                                         \
    {"lens", required_argument, NULL, OPT_LENS},                   \
        {"lights", required_argument, NULL, OPT_LIGHTS},           \
        {"light", required_argument, NULL, OPT_LIGHT},             \
        {"threshold", required_argument, NULL, OPT_THRESHOLD},     \
        {"headroom", required_argument, NULL, OPT_HEADROOM},       \
        {"layer", required_argument, NULL, OPT_LAYER},             \
        {"no-tracking", no_argument, NULL, OPT_NO_TRACKING},       \
        {"show", required_argument, NULL, OPT_SHOW},               \
        {"strength", required_argument, NULL, OPT_STRENGTH},       \
        {"light-at", required_argument, NULL, OPT_LIGHT_AT},       \
        {"save-lights", required_argument, NULL, OPT_SAVE_LIGHTS}, \
        {"interpolate", no_argument, NULL, OPT_INTERPOLATE}, SETTINGS_OPTIONS

#define COMPOSITOR_HELP                                                        \
    "  --lens LENS         table or baked model (default nikon-zoom-short)\n"  \
    "  --lights auto|FILE  auto (default): found in each frame; FILE: CSV\n"   \
    "                      frame,x,y,power[,r,g,b[,size]] or JSON lines "      \
    "with\n"                                                                   \
    "                      these keys, and id; x, y in pixels from the top\n"  \
    "                      left, also outside; frames count from 0, * is\n"    \
    "                      every frame; size is its RMS radius, pixels: "      \
    "0.71\n"                                                                   \
    "                      of a disc's\n"                                      \
    "  --interpolate       of a FILE: lamps go from one row to their next, "   \
    "in\n"                                                                     \
    "                      frames that have none; the same id (a column of "   \
    "a\n"                                                                      \
    "                      heading), else the same place in the frame\n"       \
    "  --light-at X,Y[,EV] a lamp at a pixel, for all frames, of EV stops\n"   \
    "                      over a white pixel (default 16); repeatable; "      \
    "replaces\n"                                                               \
    "                      auto, adds to a FILE\n"                             \
    "  --save-lights FILE  writes the lamps of each frame as --lights FILE "   \
    "takes\n"                                                                  \
    "                      them\n"                                             \
    "  --light LIST        one by hand, as of glint render, for all frames;\n" \
    "                      repeatable; replaces auto, adds to a FILE\n"        \
    "  --threshold EV[,EV] how bright a lamp must be, and down to what it "    \
    "extends,\n"                                                               \
    "                      in stops from the picture's white (default "        \
    "-0.1,-0.15)\n"                                                            \
    "  --no-tracking       --lights auto takes each frame of a video by "      \
    "itself,\n"                                                                \
    "                      rather than following lamps from frame to frame\n"  \
    "  --show lights       draws a box, number and stops over a white pixel "  \
    "of\n"                                                                     \
    "                      each light on top\n"                                \
    "  --headroom EV       stops by which clipped pixels really exceed "       \
    "white, 0 to\n"                                                            \
    "                      40 (default: for each lamp, from its halo)\n"       \
    "  --layer WHAT        composite | flare: the flare alone on black |\n"    \
    "                      flare-alpha: a picture of it with alpha, to be\n"   \
    "                      laid over others in linear light\n"                 \
    "  --strength S        how bright the flare comes out, whatever the "      \
    "lamps\n"                                                                  \
    "                      and the lens: 0 none, 0.5 (default) a quarter of\n" \
    "                      white at its brightest, 1 white; twice S is two\n"  \
    "                      stops. Follows the lamps of a video. --exposure "   \
    "EV\n"                                                                     \
    "                      instead sets it by hand\n"

void compositor_defaults(struct compositor *compositor);

/* Takes OPTION if it is one of COMPOSITOR_OPTIONS. Returns -1, or -2 if it is
 * none of these, or an exit code after printing what is wrong. VALUE must
 * outlive COMPOSITOR. */
int compositor_option(const struct tool *tool, struct compositor *compositor,
                      int option, const char *value);

/* Opens the lens, which is baked if need be, the list of lamps and the file to
 * save lamps to. Returns an exit code. */
int compositor_open(const struct tool *tool, struct compositor *compositor);

/* Prepares COMPOSITOR for pictures of WIDTH x HEIGHT. Returns an exit code. */
int compositor_size(const struct tool *tool, struct compositor *compositor,
                    int width, int height);

/* Ends the options of a file: those of the command line may choose again
 * between --strength and --exposure. */
void compositor_options_end(struct compositor *compositor);

/* Sets COMPOSITOR's lamps to those of IMAGE, in the way of compositor_draw(),
 * and saves them, but draws nothing. Returns how many there are. */
int compositor_lamps(struct compositor *compositor,
                     const struct glint_image *image, int32_t elapsed_us);

/* Adds the flare to IMAGE, which has the size of compositor_size() and comes
 * ELAPSED_US after the frame before; 0: a picture by itself. GLINT_E_MEMORY. */
enum glint_status compositor_draw(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us);

/* The parts of compositor_draw(), for compositor_layer.h: _find sets the lamps
 * of IMAGE; _expose saves them, which may have been measured since, and sets
 * the exposure; _scale returns the factor on their light; _mark marks them on
 * IMAGE. */
void compositor_find(struct compositor *compositor,
                     const struct glint_image *image, int32_t elapsed_us);
void compositor_expose(struct compositor *compositor, int32_t elapsed_us);
double compositor_scale(const struct compositor *compositor);
void compositor_mark(const struct compositor *compositor,
                     const struct glint_image *image);

/* Closes COMPOSITOR and moves FRESH there, which is open and not yet sized. */
void compositor_replace(struct compositor *compositor,
                        const struct compositor *fresh);

/* Puts the file of saved lamps in place, after a run that went well. Returns an
 * exit code. */
int compositor_finish(const struct tool *tool, struct compositor *compositor);

void compositor_close(struct compositor *compositor);

#endif
