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

#include "desk/keys.h"
#include "desk/occlusion.h"
#include "lamp_files/lamp_save.h"
#include "lamp_files/lamp_list.h"
#include "options/settings.h"
#include "engine/strength.h"
#include "scenes/over_scene.h"

struct compositor {
    struct settings settings;
    const char *lens, *lights_file; /* NULL: lamps are found */
    const char *save_file;          /* file to save lamps to, or NULL */
    const char *style;              /* the look that was chosen, or NULL */
    const char *keys_file;          /* file of key frames, or NULL */
    /* Key frames in place of those of a file, whose name keys_file is then in
     * messages; NULL: none. */
    const char *keys_text;
    char keys_line[224]; /* "FILE:LINE" of the f-number asked for */
    struct keys keys;
    struct occlusion occlusion; /* what hides lamps */
    struct over_scene scene;    /* things over the picture */
    bool interpolate;           /* Lamps of a file move between its rows. */
    struct lamp_list at;        /* lamps given by hand, by pixel */
    double threshold_ev[2]; /* stops from white: that a lamp needs, and down to
                               which it extends */
    double headroom_ev;
    bool flare_only, no_tracking, show_lights;
    bool is_still;    /* pictures by themselves, for which there is time */
    bool preview;     /* draws fast, and numbers the ghosts */
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
    bool has_lens;         /* false: there is only a scene */
    bool is_listed;        /* Lamps come from a list, by file or by pixel. */
    struct lamp_list list; /* lamps of the file and those by pixel */
    struct lamp_save save;
    struct glint_lamp_detector finder;
    struct glint_lamp *lamp; /* lamps of the frame, with room for all by hand
                                and all found or read */
    double *level;  /* share of its power that each lamp has, as in struct
                       glint_strength_lamps */
    double *share;  /* share of each lamp that the scene does not hide */
    double *excess; /* what each lamp has above the light that the picture
                       shows of it */
    /* [n_before]: the same of the last frame, as if no scene hid anything, and
     * the lamps it was of. */
    double *excess_before;
    uint32_t *id_before;
    int n_before;
    double *seen_px; /* extent of each lamp that the picture clips, or 0 */
    uint32_t *id;    /* number that each lamp is saved under */
    struct glint_response response;
    double white; /* light of the picture's white; 1, or as overlay_file.c sets
                     it */
    bool is_measured; /* the picture has the light of lamps beyond white */
    struct glint_view view;
    struct glint_frame frame;
    struct tool_progress progress; /* of the first frame by exact rays */
    bool sized;

    /* These are of the last frame. */
    bool is_followed; /* The frame is of a video whose lamps are tracked. */
    int n_frames;
    int n_lamps, n_own; /* all lamps; of these that are not the scene's */
    double find_ms, flare_ms;
    struct glint_frame_report report;
};

/* Default power of a lamp by hand, stops over a white pixel: a street lamp in a
 * night picture. */
#define COMPOSITOR_LIGHT_EV 16

enum compositor_option_code {
    OPT_LENS = OPT_LAST,
    OPT_LIGHTS,
    OPT_LIGHT,
    OPT_THRESHOLD,
    OPT_HEADROOM,
    OPT_LAYER,
    OPT_NO_TRACKING,
    OPT_STILL,
    OPT_SHOW,
    OPT_STRENGTH,
    OPT_LIGHT_AT,
    OPT_SAVE_LIGHTS,
    OPT_INTERPOLATE,
    OPT_MASK,
    OPT_EDGE_FADE,
    OPT_KEYS,
    OPT_STYLE,
    OPT_PREVIEW,
    OPT_SCENE,
    OPT_POSE,
    OPT_CONTROL,
    /* Those of a scene, in the order of enum scene_choice. */
    OPT_EDGE_SAMPLES,
    OPT_SHADOW_POINTS,
    OPT_SHADING,
    OPT_WARD_SAMPLES,
    OPT_WARD_NEAREST,
    OPT_STONE_FRAMES,
    OPT_HIGHLIGHTS,
    OPT_COMPOSITOR_LAST
};

#define COMPOSITOR_OPTIONS                                             \
    {"lens", required_argument, NULL, OPT_LENS},                       \
        {"lights", required_argument, NULL, OPT_LIGHTS},               \
        {"light", required_argument, NULL, OPT_LIGHT},                 \
        {"threshold", required_argument, NULL, OPT_THRESHOLD},         \
        {"headroom", required_argument, NULL, OPT_HEADROOM},           \
        {"layer", required_argument, NULL, OPT_LAYER},                 \
        {"no-tracking", no_argument, NULL, OPT_NO_TRACKING},           \
        {"still", required_argument, NULL, OPT_STILL},                 \
        {"show", required_argument, NULL, OPT_SHOW},                   \
        {"strength", required_argument, NULL, OPT_STRENGTH},           \
        {"light-at", required_argument, NULL, OPT_LIGHT_AT},           \
        {"save-lights", required_argument, NULL, OPT_SAVE_LIGHTS},     \
        {"interpolate", no_argument, NULL, OPT_INTERPOLATE},           \
        {"mask", required_argument, NULL, OPT_MASK},                   \
        {"edge-fade", required_argument, NULL, OPT_EDGE_FADE},         \
        {"keys", required_argument, NULL, OPT_KEYS},                   \
        {"style", required_argument, NULL, OPT_STYLE},                 \
        {"preview", no_argument, NULL, OPT_PREVIEW},                   \
        {"scene", required_argument, NULL, OPT_SCENE},                 \
        {"pose", required_argument, NULL, OPT_POSE},                   \
        {"control", required_argument, NULL, OPT_CONTROL},             \
        {"edge-samples", required_argument, NULL, OPT_EDGE_SAMPLES},   \
        {"shadow-points", required_argument, NULL, OPT_SHADOW_POINTS}, \
        {"shading", required_argument, NULL, OPT_SHADING},             \
        {"ward-samples", required_argument, NULL, OPT_WARD_SAMPLES},   \
        {"ward-nearest", no_argument, NULL, OPT_WARD_NEAREST},         \
        {"stone-frames", required_argument, NULL, OPT_STONE_FRAMES},   \
        {"highlights", required_argument, NULL, OPT_HIGHLIGHTS},       \
        SETTINGS_OPTIONS

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

/* The help on what an artist turns. */
#define SCENE_HELP                                                            \
    "\nScenes\n"                                                              \
    "  --control FILE      lines that change the scene: [FRAME] orbit YAW "   \
    "PITCH,\n"                                                                \
    "                      distance D, set MATERIAL alpha X Y, show THING,\n" \
    "                      play ...; live: also a FIFO, or - (keys of a\n"    \
    "                      terminal)\n"                                       \
    "  --edge-samples N    points of a pixel at outlines: 1, 4 (default), 8 " \
    "or\n"                                                                    \
    "                      16\n"                                              \
    "  --shadow-points N   1, 4 (default of videos) or 16 (of stills) of a\n" \
    "                      light's disc\n"                                    \
    "  --shading S         full: each pixel (default); half: two by two at\n" \
    "                      once where they see one thing\n"                   \
    "  --ward-samples N    1 to 32 lookups of the environment for a place "   \
    "on\n"                                                                    \
    "                      brushed metal (default 8; in fours)\n"             \
    "  --ward-nearest      each in one level of it, not two blended\n"        \
    "  --stone-frames N    1 (default), 2 or 4: light below the surface of "  \
    "stones\n"                                                                \
    "                      follows what moves only so often\n"                \
    "  --highlights N      0 to 8 spots of things that glint are lights of "  \
    "the\n"                                                                   \
    "                      flare (default: as the scene says)\n"

#define DESK_HELP                                                              \
    "The desk\n"                                                               \
    "  --style NAME        natural | clean | vintage | cinema | toy: a lens, " \
    "a\n"                                                                      \
    "                      coating, a stop and a strength that go together;\n" \
    "                      other options replace its own (glint styles)\n"     \
    "  --preview           draws fast and coarsely, and writes onto the "      \
    "picture\n"                                                                \
    "                      the numbers of the 24 brightest ghosts; as "        \
    "coarsely as\n"                                                            \
    "                      --quality 0.25 unless --quality, --error, "         \
    "--grid or\n"                                                              \
    "                      --budget say otherwise\n"                           \
    "  --mask FILE         hides lamps: white lets light through; a lamp "     \
    "keeps the\n"                                                              \
    "                      share of its extent that is not hidden. A "         \
    "picture,\n"                                                               \
    "                      a pattern or a .y4m, as large as the picture\n"     \
    "  --scene FILE        draws the things of a .scene, or of what glint "    \
    "bake "                                                                    \
    "made\n"                                                                   \
    "                      of it, over the picture: they hide lamps, throw\n"  \
    "                      shadows, and their lights flare; --lens none: no "  \
    "flare\n"                                                                  \
    "  --pose FILE         moves things and camera: lines "                    \
    "frame,object,x,y,z\n"                                                     \
    "                      [,qw,qx,qy,qz] or JSON, object a name or camera, "  \
    "* every\n"                                                                \
    "                      frame; a pose holds until the next\n"               \
    "  --edge-fade PX      lamps beside the picture fade over so many "        \
    "pixels,\n"                                                                \
    "                      above 0 and up to a million\n"                      \
    "  --keys FILE         key frames, CSV: frame, and of exposure, "          \
    "strength,\n"                                                              \
    "                      gain, starburst, f-number, turn, round, zoom, "     \
    "x,y[,ev];\n"                                                              \
    "                      even between rows, empty is no key\n"               \
    "  --still PX          of videos: while lamps move by less, ghosts are "   \
    "drawn by\n"                                                               \
    "                      the rays of before, with the light of now\n"        \
    "                      (default 0: while they do not move at all)\n"       \
    "  of --save-lights    frame,x,y,power,r,g,b,size,id,shape (minor over "   \
    "major\n"                                                                  \
    "                      axis),turn (degrees of the major),level (how far "  \
    "it\n"                                                                     \
    "                      has risen),seen (pixels, of a lamp that clips)\n"

void compositor_defaults(struct compositor *compositor);

/* Returns whether OPTION is a dial of scenes. */
bool compositor_is_dial(int option);

/* Takes OPTION if it is one of COMPOSITOR_OPTIONS. Returns -1, or -2 if it is
 * none of these, or an exit code after printing what is wrong. VALUE must
 * outlive COMPOSITOR. */
int compositor_option(const struct tool *tool, struct compositor *compositor,
                      int option, const char *value);

/* Takes the options of the style NAME. Returns -1 or an exit code. */
int compositor_style(const struct tool *tool, struct compositor *compositor,
                     const char *name);

/* Takes the style that a line has, wherever it stands, so that all other
 * options replace what it sets. The arguments are those of tool_value_of().
 * Returns -1 or an exit code. */
int compositor_style_of(const struct tool *tool, struct compositor *compositor,
                        int argc, char **argv, const char *shorts,
                        const struct option *options);

/* Opens the lens, which is baked if need be, the list of lamps and the file to
 * save lamps to. Returns an exit code. */
int compositor_open(const struct tool *tool, struct compositor *compositor);

/* Does as compositor_open(), but refuses --lens none. */
int compositor_open_lens(const struct tool *tool,
                         struct compositor *compositor);

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
 * of IMAGE and draws the scene over it; _expose saves them, which may have been
 * measured since, and sets the exposure; _scale returns the factor on their
 * light; _drawn ends what is shown of the progress of a frame; _mark marks them
 * on IMAGE. */
enum glint_status compositor_find(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us);
void compositor_expose(struct compositor *compositor, int32_t elapsed_us);
double compositor_scale(const struct compositor *compositor);
/* Returns whether lamps and exposure begin anew in the frame that _find looked
 * at, as after a cut. */
bool compositor_is_new(const struct compositor *compositor);
void compositor_drawn(struct compositor *compositor);
void compositor_mark(const struct compositor *compositor,
                     const struct glint_image *image);

/* The parts of a compositor that change it from frame to frame. _open_keys
 * reads the key frames, before the lens is opened; _open opens the mask, and
 * adds the lamp of the key frames to the list, once it is. Both return exit
 * codes. _turn sets what the key frames say of the next frame; _hide takes from
 * N lamps the light that does not get through. */
int compositor_desk_open_keys(const struct tool *tool,
                              struct compositor *compositor);
int compositor_desk_open(const struct tool *tool,
                         struct compositor *compositor);
void compositor_desk_turn(struct compositor *compositor);
void compositor_desk_hide(struct compositor *compositor, int n);
void compositor_desk_close(struct compositor *compositor);

/* Before scene and lens are opened: lets lines of control zoom the lens if they
 * may, as key frames do not and its model is given; refuses lines that would
 * have nothing to do beside key frames, and key frames that zoom a table, which
 * would be baked for one position. Returns an exit code. */
int compositor_zoom_begin(const struct tool *tool,
                          struct compositor *compositor);

/* Checks that the lens, which is open, zooms as far as lines of control and key
 * frames say, and leaves it at the first of these. Returns an exit code. */
int compositor_zoom_open(const struct tool *tool,
                         struct compositor *compositor);

/* Zooms as the key frames say of the next frame. */
void compositor_zoom_turn(struct compositor *compositor);

/* Draws the scene over IMAGE, takes from the lamps what it hides, and adds the
 * scene's own. GLINT_E_MEMORY. */
enum glint_status compositor_scene(struct compositor *compositor,
                                   const struct glint_image *image);
/* Prepares the scene for pictures of WIDTH x HEIGHT. Returns an exit code. */
int compositor_scene_size(struct compositor *compositor, int width, int height);

/* Writes the lamps of the frame to the file of saved lamps, if there is one. */
void compositor_save_lamps(struct compositor *compositor);

/* Returns whether COMPOSITOR marks anything on pictures. */
bool compositor_marks(const struct compositor *compositor);

/* Closes COMPOSITOR and moves FRESH there, which is open and not yet sized. */
void compositor_replace(struct compositor *compositor,
                        const struct compositor *fresh);

/* Puts the file of saved lamps in place, after a run that went well. Returns an
 * exit code. */
int compositor_finish(const struct tool *tool, struct compositor *compositor);

void compositor_close(struct compositor *compositor);

#endif
