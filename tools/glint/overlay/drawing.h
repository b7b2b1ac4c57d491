/* SPDX-License-Identifier: MIT
 *
 * Draws flares on pictures, for all commands and hosts. A drawing has options
 * (drawing_line.h), files that they name (drawing_files.h), and the state from
 * frame to frame. Each frame has the stages: detect lamps, draw the scene, set
 * the exposure, draw the flare, draw marks.
 *
 *     drawing_line_set_defaults(&d.line);          d is zeros
 *     drawing_line_set_option(&tool, &d.line, option, optarg);
 *     drawing_open(&tool, &d);                     lens, lists, scene
 *     drawing_allocate(&tool, &d, width, height);  when the size changes
 *     drawing_draw_flare(&d, &image, elapsed_us);  each frame
 *     drawing_close(&d);
 */
#ifndef GLINT_TOOLS_OVERLAY_DRAWING_H
#define GLINT_TOOLS_OVERLAY_DRAWING_H

#include "formats/samples.h"
#include "overlay/drawing_files.h"

/* Detected lamp that a lamp of --light-at follows */
struct drawing_followed {
    uint32_t id;     /* 0: none, the lamp of --light-at stays at its place */
    uint32_t newest; /* max id of all lamps while the lamp existed */
    double x, y;     /* last place, pixels */
    /* a still picture has neither a lamp nor a bright pixel there */
    bool is_on_dark;
};

/* State while frames are drawn */
struct drawing_run {
    struct glint_view view;
    /* NULL if there is no lens, or before drawing_allocate() */
    struct glint_engine *engine;
    struct glint_engine_cache cache;
    /* progress of the first frame that is drawn by exact rays */
    struct tool_progress progress;
    bool is_progressing, is_sized;
    int n_frames;
    /* exit code of a model that could not be opened for lamps; its reason has
     * been printed */
    int code;

    /* The caller sets both before drawing_detect_and_draw_scene(): the linear
     * light of white in the picture, and whether the picture stores lamps
     * brighter than white. */
    double white;
    bool is_measured;

    /* The following members describe the last frame. */
    /* lamps in this order: detected ones, those of options and lists, those of
     * the scene */
    struct glint_engine_lamp *lamp;
    /* n_found: number of lamps detected in the picture; n_own: number of these
     * and those of options and lists; n_lamps: number of all lamps */
    int n_lamps, n_own, n_found;
    bool is_followed; /* whether lamps are tracked from frame to frame */
    struct drawing_followed at[SETTINGS_MAX_LAMPS]; /* of --light-at */
    bool is_at_set; /* whether AT is set, in a video */
    double find_ms, flare_ms;
    struct glint_engine_report report;
};

struct drawing {
    /* options of the flare; key frames change line.settings */
    struct drawing_line line;
    struct drawing_files files;
    struct drawing_run run;
};

/* Opens the files named by drawing->line. All other members must be zeros.
 * Returns an exit code. */
int drawing_open(const struct tool *tool, struct drawing *drawing);

/* Same as drawing_open(), but rejects --lens none and --show lights. */
int drawing_open_lens(const struct tool *tool, struct drawing *drawing);

/* Allocates the engine and the scene for pictures of WIDTH x HEIGHT pixels.
 * Returns an exit code. */
int drawing_allocate(const struct tool *tool, struct drawing *drawing,
                     int width, int height);

/* Opens the model of a lens that was opened without one, and bakes it if
 * necessary. An engine that was allocated is allocated again; tracked lamps and
 * exposure continue. If the model cannot be opened, the drawing stays as it is;
 * if the engine cannot be allocated, there is none. Returns an exit code. */
int drawing_open_model(const struct tool *tool, struct drawing *drawing);

/* Returns the exit code for STATUS, a failure of a function below. Prints the
 * reason, unless it has been printed already. */
int drawing_fail(const struct tool *tool, const struct drawing *drawing,
                 enum glint_status status);

/* Adds the flare, or with --show lights marks of the lamps, to IMAGE, whose
 * size must be that of drawing_allocate(). ELAPSED_US: microseconds since the
 * previous frame; 0: IMAGE is an independent picture. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status drawing_draw_flare(struct drawing *drawing,
                                     const struct glint_image *image,
                                     int32_t elapsed_us);

/* ------------------------------------------------------------------- stages
 *
 * The stages of drawing_draw_flare(), to be called one by one for a picture
 * that is not a struct glint_image. The caller then counts run.n_frames. */

/* Detects the lamps of IMAGE and draws the scene over it. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status drawing_detect_and_draw_scene(struct drawing *drawing,
                                                const struct glint_image *image,
                                                int32_t elapsed_us);

/* Corrects power, position and colour of lamps that were detected in a proxy,
 * an 8-bit copy of SAMPLES, by adding the light that the proxy clips. The code
 * 255 of the proxy has the linear light run.white. */
void drawing_measure_clipped_lamps(struct drawing *drawing,
                                   const struct glint_samples *samples);

/* Starts the progress of exact rays, and prints what will be drawn. Does
 * nothing with a model. */
void drawing_start_flare(struct drawing *drawing);

/* Ends the progress of the flare, and records its time. START is the time,
 * seconds, at which the drawing of the flare began. */
void drawing_end_flare(struct drawing_run *run, double start);

/* Writes the lamps to the file of --save-lights and sets the exposure of the
 * flare for IMAGE. If there are lamps, first opens or bakes the model of a lens
 * that waits for them (SETTINGS_SEARCH). drawing_fail() reports a failure. */
enum glint_status drawing_set_exposure(struct drawing *drawing,
                                       const struct glint_image *image);

/* Draws the flare into RGB, [height][width][3] of the upright picture, linear
 * light. ACCURACY: GLINT_ENGINE_CODES, GLINT_ENGINE_CODES_16, or 0 for that of
 * floats. Returns GLINT_E_MEMORY on failure. */
enum glint_status drawing_draw_layer(struct drawing_run *run, unsigned accuracy,
                                     float *rgb);

/* Returns whether lamps are searched in the picture, which options can
 * replace. */
bool drawing_searches_picture(const struct drawing *drawing);

/* Sets SPOT to candidate I of the last picture, 0 .. 2: a region that looks
 * like a lamp but was rejected. Returns false if there is none. Frames of a
 * video have no candidates. */
bool drawing_get_candidate(const struct drawing *drawing, int i,
                           struct glint_spot *spot);

/* Returns the index of an X,Y,off of --light-at at which a lamp was found in
 * the last picture, or none if not IS_FOUND; -1: there is no such option. */
int drawing_find_removal(const struct drawing *drawing, bool is_found);

/* Draws on IMAGE the marks of lamps and candidates and the time line of a
 * recorded motion, as far as the options request them. */
void drawing_draw_marks(const struct drawing *drawing,
                        const struct glint_image *image);

/* Returns whether the options request marks or a time line. */
bool drawing_has_marks(const struct drawing_line *line);

/* ------------------------------------------------------------------ results */

/* Detects and saves the lamps of IMAGE like drawing_detect_and_draw_scene(),
 * but draws nothing. */
enum glint_status drawing_detect_lamps_only(struct drawing *drawing,
                                            const struct glint_image *image,
                                            int32_t elapsed_us);

/* Returns the factor that the exposure applies to the power of lamps. Call it
 * after drawing_set_exposure(). */
double drawing_get_exposure_factor(const struct drawing_run *run);

/* Returns whether tracking and exposure restarted in the last frame, for
 * example after a cut. */
bool drawing_has_exposure_restarted(const struct drawing *drawing);

/* Closes DRAWING and moves FRESH into it. FRESH must be open, but not allocated
 * by drawing_allocate(). The output file of lamps stays open. */
void drawing_replace_settings_and_lens(struct drawing *drawing,
                                       const struct drawing *fresh);

/* Completes the output file of lamps after a successful run. Returns an exit
 * code. */
int drawing_finish_lamp_file(const struct tool *tool, struct drawing *drawing);

void drawing_close(struct drawing *drawing);

#endif
