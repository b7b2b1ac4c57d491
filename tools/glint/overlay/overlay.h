/* SPDX-License-Identifier: MIT
 *
 * glint overlay: options, statistics, and the drawing of pictures, numbered
 * pictures and videos. cmd_overlay.c parses the command line. */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_H

#include "overlay/layers.h"
#include "overlay/drawing.h"
#include "overlay/drawing_line.h"

struct overlay_y4m;

/* Min and max of N values, one value per frame */
struct overlay_span {
    double min, max;
    int n;
};

struct overlay_figures {
    /* Engine report of the frame in which most lights were merged. In this
     * report the numbers of lights, of out-of-range lights, and of dropped ray
     * bundles and cells are maxima over all frames instead. */
    struct glint_engine_report worst;
    int most_lights;
    /* ranges of the options of this name over all frames */
    struct overlay_span strength, exposure, gain;
    /* number of frames that reused the traced edges of the previous frame */
    int n_reused;
    /* total times of lamp detection and of drawing flares, ms */
    double find_ms, flare_ms;
    /* light of the flare, 1 = white: max over all frames, and sum over all
     * frames of the mean over the pixels */
    double peak, mean_sum;
    size_t peak_bytes;
    /* times of the start of the run and of the last progress line, s */
    double started, reported;
};

struct overlay {
    struct drawing drawing;
    /* buffers for a video with a format other than plain 8 bits; NULL: none */
    struct overlay_y4m *y4m;
    const char *input, *output;
    int start_number;
    /* first and last frame of a video to draw, from 0; number of frames before
     * FIRST in which lamps are detected and tracked, but nothing is drawn */
    int first, last, warm_up;
    /* microseconds between frames; 0: pictures are independent */
    int32_t elapsed_us;
    int range, matrix; /* enums of --range and --matrix; 0: auto */
    /* format of raw frames; WIDTH 0: the input is not raw */
    struct {
        int format, width, height, stride;
    } raw;
    int transfer; /* enum glint_transfer_curve; -1: auto */
    int quality;  /* quality of JPEG and WebP, 1 .. 100; 0: that of the input */
    bool is_video;
    /* --list-shots: whether the frames between cuts are listed and nothing is
     * drawn */
    bool lists_shots;
    /* whether tracking and exposure restarted in the last frame */
    bool is_cut;
    /* whether the file was copied because nothing was drawn */
    bool is_copied;
    struct layers layers;
    bool has_layers_type, has_raw;
    const char *encode; /* --encode: options for ffmpeg, or NULL */
    struct overlay_figures figures;
};

/* Draws the flare on IMAGE, the next frame, and updates the statistics. Returns
 * an exit code, as all functions of this header that return int. */
int overlay_draw_frame(struct tool *tool, struct overlay *o,
                       const struct glint_image *image);

/* Detects the lamps in IMAGE, a frame before the first one to draw, and updates
 * tracks and exposure. */
int overlay_find_lamps_only(struct tool *tool, struct overlay *o,
                            const struct glint_image *image);

/* Draws a frame like overlay_draw_frame(), for a frame that cannot be drawn on
 * in place: calls DRAW with CTX instead of drawing_draw_flare(). */
typedef enum glint_status overlay_draw_fn(void *ctx, struct drawing *drawing,
                                          const struct glint_image *image,
                                          int32_t elapsed_us);
int overlay_draw_frame_by_callback(struct tool *tool, struct overlay *o,
                                   const struct glint_image *image,
                                   overlay_draw_fn *draw, void *ctx);

/* Prints the progress: one line that is overwritten on a terminal, else a new
 * line every few seconds. */
void overlay_print_progress(const struct tool *tool, struct overlay *o);

/* Rejects the outputs, TO and those of the options, if one would overwrite the
 * input FROM, another input or another output. */
int overlay_check_outputs(const struct tool *tool, const struct overlay *o,
                          const char *from, const char *to);

/* Draws one picture of a sequence from file FROM to file TO. */
int overlay_draw_picture_file(struct tool *tool, struct overlay *o,
                              const char *from, const char *to);

/* Opens the input, a picture, and then the lens, which may depend on the camera
 * of the picture, and draws it to the output. */
int overlay_draw_single_picture(struct tool *tool, struct overlay *o);

/* Returns whether the input is a numbered sequence. It is if its name contains
 * a '%' and no file has exactly this name. */
bool overlay_is_sequence(const struct overlay *o);

/* Draws the numbered pictures of the pattern o->input to the pattern
 * o->output. */
int overlay_draw_sequence(struct tool *tool, struct overlay *o);

/* Returns whether NAME is a video, by its extension. */
bool overlay_is_video(const char *name);

/* Sets VIDEO to true if an animated GIF is read or written as a video. Rejects
 * a GIF of a single frame as a video. If only one frame of a GIF is used,
 * prints a warning. */
int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video);

/* Rejects a video that needs ffmpeg if ffmpeg is not installed. Called before
 * any work. Returns an exit code. */
int overlay_check_ffmpeg(const struct tool *tool, const struct overlay *o);

/* Draws a video from o->input to o->output. */
int overlay_draw_video(struct tool *tool, struct overlay *o);

#endif
