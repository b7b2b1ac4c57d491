/* SPDX-License-Identifier: MIT
 *
 * The flare that all commands and hosts draw on pictures: its options
 * (drawing_line.h), their files (drawing_files.h), and the run over the frames.
 * The stages of a frame are find -> scene -> expose -> draw -> marks.
 *
 *     drawing_line_defaults(&d.line);                   d is zeros
 *     drawing_line_option(&tool, &d.line, option, optarg);
 *     drawing_open(&tool, &d);                          lens, lists, scene
 *     drawing_size(&tool, &d, width, height);           when the size changes
 *     drawing_draw(&d, &image, elapsed_us);             each frame
 *     drawing_close(&d);
 */
#ifndef GLINT_TOOLS_OVERLAY_DRAWING_H
#define GLINT_TOOLS_OVERLAY_DRAWING_H

#include "formats/samples.h"
#include "overlay/drawing_files.h"

/* The state of a run over frames. */
struct drawing_run {
    struct glint_view view;
    struct glint_engine *engine; /* NULL without a lens, or before
                                    drawing_size() */
    struct glint_engine_cache cache;
    struct tool_progress progress; /* of the first frame, if by exact rays */
    bool is_progressing, is_sized;
    int n_frames;

    /* About the picture, set before drawing_find(): the light of its white, and
     * whether it holds lamps brighter than white. */
    double white;
    bool is_measured;

    /* Of the last frame. */
    struct glint_engine_lamp *lamp; /* capacity for all lamps: given, found,
                                       read */
    int n_lamps, n_own, n_found; /* lamps in all; the first n_own are not of the
                                    scene; of these the first n_found were found
                                    in the picture */
    bool is_followed;            /* its lamps were tracked from frame to
                                    frame */
    double find_ms, flare_ms;
    struct glint_engine_report report;
};

struct drawing {
    struct drawing_line line; /* key frames change its settings in every
                                 frame */
    struct drawing_files files;
    struct drawing_run run;
};

/* Opens the files of the line. DRAWING must be zeros except its line. Returns
 * an exit code. */
int drawing_open(const struct tool *tool, struct drawing *drawing);

/* Does as drawing_open(), but rejects --lens none. */
int drawing_open_lens(const struct tool *tool, struct drawing *drawing);

/* Prepares DRAWING for pictures of WIDTH x HEIGHT. Returns an exit code. */
int drawing_size(const struct tool *tool, struct drawing *drawing, int width,
                 int height);

/* If IMAGE has lamps, bakes the lens that was opened without a model,
 * SETTINGS_SEARCH, and prepares DRAWING again. Returns an exit code. */
int drawing_bake_found(const struct tool *tool, struct drawing *drawing,
                       const struct glint_image *image);

/* Adds the flare to IMAGE, whose size must be that of drawing_size(). IMAGE
 * follows the previous frame after ELAPSED_US; 0: it is an independent picture.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status drawing_draw(struct drawing *drawing,
                               const struct glint_image *image,
                               int32_t elapsed_us);

/* ------------------------------------------------------------------- stages
 *
 * The stages of drawing_draw(), for pictures that are not a struct glint_image:
 * find, expose, a layer, marks. The caller counts run.n_frames. */

/* Sets the lamps of IMAGE and draws the scene over it. Returns GLINT_E_MEMORY
 * on failure. */
enum glint_status drawing_find(struct drawing *drawing,
                               const struct glint_image *image,
                               int32_t elapsed_us);

/* Corrects power, position and colour of lamps found in a proxy, an 8-bit copy
 * of SAMPLES, for the light that the proxy clips. run.white is the light of its
 * code 255. */
void drawing_measure(struct drawing *drawing,
                     const struct glint_samples *samples);

/* Saves the lamps and sets the exposure of the flare on IMAGE. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status drawing_expose(struct drawing *drawing,
                                 const struct glint_image *image);

/* Draws the flare into RGB, upright [height][width][3], linear light. IS_DEEP:
 * accurate enough for floats; else for 8-bit codes, at half the cost. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status drawing_layer(struct drawing_run *run, bool is_deep,
                                float *rgb);

/* Draws marks of lamps and the time line on IMAGE, if the line requests
 * them. */
void drawing_mark(const struct drawing *drawing,
                  const struct glint_image *image);

/* Returns whether the line requests marks. */
bool drawing_has_marks(const struct drawing_line *line);

/* ------------------------------------------------------------------ results */

/* Sets the lamps of IMAGE as drawing_find() does, and saves them, but draws
 * nothing. */
enum glint_status drawing_find_lamps(struct drawing *drawing,
                                     const struct glint_image *image,
                                     int32_t elapsed_us);

/* Returns the factor on the light of lamps. Call it after drawing_expose(). */
double drawing_scale(const struct drawing_run *run);

/* Returns whether tracking and exposure restarted in the last frame, as after a
 * cut. */
bool drawing_is_new(const struct drawing *drawing);

/* Closes DRAWING and moves FRESH, which must be open and not yet sized, to its
 * place. An open output file of lamps stays open. */
void drawing_replace(struct drawing *drawing, const struct drawing *fresh);

/* Completes the output file of lamps after a successful run. Returns an exit
 * code. */
int drawing_finish(const struct tool *tool, struct drawing *drawing);

void drawing_close(struct drawing *drawing);

#endif
