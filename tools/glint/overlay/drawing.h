/* SPDX-License-Identifier: MIT
 *
 * The flare that every command and host draws on pictures: what the line says
 * (drawing_line.h), what is opened from it (drawing_files.h), and the run over
 * the frames. A frame goes find -> scene -> expose -> draw -> marks.
 *
 *     drawing_line_defaults(&d.line);                   of zeros
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
    struct glint_engine *engine; /* NULL: there is no lens, or no size yet */
    struct glint_engine_cache cache;
    struct tool_progress progress; /* of the first frame by exact rays */
    bool is_progressing, is_sized;
    int n_frames;

    /* The picture, as set before drawing_find(): the light of its white, and
     * whether it has the light of lamps beyond that. */
    double white;
    bool is_measured;

    /* The last frame. */
    struct glint_engine_lamp *lamp; /* with room for all given, found or read */
    int n_lamps, n_own, n_found; /* all lamps; the first of these, which are not
                                    the scene's; the first, which were found */
    bool is_followed;            /* its lamps are tracked through a video */
    double find_ms, flare_ms;
    struct glint_engine_report report;
};

struct drawing {
    struct drawing_line line; /* key frames change it from frame to frame */
    struct drawing_files files;
    struct drawing_run run;
};

/* Opens what the line names. DRAWING is zeros but for its line. Returns an exit
 * code. */
int drawing_open(const struct tool *tool, struct drawing *drawing);

/* Does as drawing_open(), but rejects --lens none. */
int drawing_open_lens(const struct tool *tool, struct drawing *drawing);

/* Prepares DRAWING for pictures of WIDTH x HEIGHT. Returns an exit code. */
int drawing_size(const struct tool *tool, struct drawing *drawing, int width,
                 int height);

/* Adds the flare to IMAGE, which has the size of drawing_size() and comes
 * ELAPSED_US after the frame before; 0: an independent picture.
 * GLINT_E_MEMORY. */
enum glint_status drawing_draw(struct drawing *drawing,
                               const struct glint_image *image,
                               int32_t elapsed_us);

/* ------------------------------------------------------------------- stages
 *
 * The stages of drawing_draw(), for pictures that are not a struct glint_image:
 * find, expose, a layer, marks. The caller counts run.n_frames. */

/* Sets the lamps of IMAGE and draws the scene over it. GLINT_E_MEMORY. */
enum glint_status drawing_find(struct drawing *drawing,
                               const struct glint_image *image,
                               int32_t elapsed_us);

/* Sets power, place and colour of the lamps found in a proxy of SAMPLES, with
 * the light that the proxy clips. run.white is the light of its code 255. */
void drawing_measure(struct drawing *drawing,
                     const struct glint_samples *samples);

/* Saves the lamps and sets the exposure on IMAGE. GLINT_E_MEMORY. */
enum glint_status drawing_expose(struct drawing *drawing,
                                 const struct glint_image *image);

/* Draws the flare into RGB, upright [height][width][3], linear light. IS_DEEP:
 * as accurate as floats; else planned as for codes of 8 bits, which halves the
 * cost. GLINT_E_MEMORY. */
enum glint_status drawing_layer(struct drawing_run *run, bool is_deep,
                                float *rgb);

/* Marks the lamps and the time line on IMAGE as the line says. */
void drawing_mark(const struct drawing *drawing,
                  const struct glint_image *image);

/* Returns whether the line requests marks. */
bool drawing_has_marks(const struct drawing_line *line);

/* ------------------------------------------------------------------ results */

/* Sets the lamps to those of IMAGE as drawing_find() does, and saves them, but
 * draws nothing. */
enum glint_status drawing_find_lamps(struct drawing *drawing,
                                     const struct glint_image *image,
                                     int32_t elapsed_us);

/* Returns the factor on the light of lamps, once exposed. */
double drawing_scale(const struct drawing_run *run);

/* Returns whether lamps and exposure began again in the frame that was exposed,
 * as after a cut. */
bool drawing_is_new(const struct drawing *drawing);

/* Closes DRAWING and moves FRESH there, which is open and not yet sized. An
 * open file of saved lamps continues. */
void drawing_replace(struct drawing *drawing, const struct drawing *fresh);

/* Puts the file of saved lamps in place, after a run that went well. Returns an
 * exit code. */
int drawing_finish(const struct tool *tool, struct drawing *drawing);

void drawing_close(struct drawing *drawing);

#endif
