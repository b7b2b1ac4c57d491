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
#include "model/settings.h"
#include "overlay/over_scene.h"
#include "options/command_line.h"

struct compositor {
    struct settings settings;
    const char *style; /* the look that was chosen, or NULL */
    /* Key frames in place of those of a file, whose name --keys is then in
     * messages; NULL: none. */
    const char *keys_text;
    char keys_line[224]; /* "FILE:LINE" of the f-number asked for */
    struct keys keys;
    struct occlusion occlusion; /* what hides lamps */
    struct over_scene scene;    /* things over the picture */
    struct lamp_list at;        /* lamps given by hand, by pixel */
    bool show_lights;
    bool is_still; /* pictures by themselves, for which there is time */
    /* Bytes reserved for frames, which take no more; 0: as many as they
     * need. */
    size_t reserve_bytes;
    int n_hand;
    struct glint_lamp hand[SETTINGS_MAX_LAMPS];
    int dial; /* code of the option that set the brightness, --strength or
                 --exposure; 0: none */

    /* Set by compositor_open() and compositor_size(). */
    bool has_lens;         /* false: there is only a scene */
    bool is_listed;        /* Lamps come from a list, by file or by pixel. */
    struct lamp_list list; /* lamps of the file and those by pixel */
    struct lamp_save save;
    struct glint_engine_lamp *lamp; /* lamps of the frame, with room for all by
                                       hand and all found or read */
    double white; /* light of the picture's white; 1, or as overlay_file.c sets
                     it */
    bool is_measured; /* the picture has the light of lamps beyond white */
    struct glint_view view;
    struct glint_engine_cache cache;
    struct glint_engine *engine;   /* NULL: there is no lens, or no size yet */
    struct tool_progress progress; /* of the first frame by exact rays */
    bool is_progressing, sized;

    /* These are of the last frame. */
    bool is_followed; /* The frame is of a video whose lamps are tracked. */
    int n_frames;
    int n_lamps, n_own; /* all lamps; of these that are not the scene's */
    double find_ms, flare_ms;
    struct glint_engine_report report;
};

void compositor_defaults(struct compositor *compositor);

/* Sets the engine's option of code OPTION. Returns -1, or -2 if it is none of
 * these, or an exit code after printing what is wrong. VALUE must outlive
 * COMPOSITOR. */
int compositor_option(const struct tool *tool, struct compositor *compositor,
                      int option, const char *value);

/* Set the engine's option NAME, which exists, to a text as compositor_option()
 * does, or to a number as glint_options_set() does. Return -1 or an exit code
 * after printing what the option accepts. */
int compositor_set_text(const struct tool *tool, struct compositor *compositor,
                        const char *name, const char *text);
int compositor_set_number(const struct tool *tool,
                          struct compositor *compositor, const char *name,
                          double value);

/* Adds a lamp at a pixel of all frames, EV stops over white, as --light-at.
 * Returns false without memory, or if it is one too many. */
bool compositor_add_light(struct compositor *compositor, double x, double y,
                          double ev);

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
 * measured since, and sets the exposure on IMAGE; _scale returns the factor on
 * their light; _drawn ends what is shown of the progress of a frame; _mark
 * marks them on IMAGE. */
enum glint_status compositor_find(struct compositor *compositor,
                                  const struct glint_image *image,
                                  int32_t elapsed_us);
enum glint_status compositor_expose(struct compositor *compositor,
                                    const struct glint_image *image);
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

/* Before scene and lens are opened: lets lines of control change the flare;
 * refuses key frames that zoom a table, which would be baked for one position.
 * Returns an exit code. */
int compositor_zoom_begin(const struct tool *tool,
                          struct compositor *compositor);

/* Before the lens is opened, which may be baked for that: refuses lines of
 * control that zoom a table. Returns an exit code. */
int compositor_zoom_lines(const struct tool *tool,
                          const struct compositor *compositor);

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
