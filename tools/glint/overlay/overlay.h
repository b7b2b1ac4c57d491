/* SPDX-License-Identifier: MIT
 *
 * glint overlay: options, statistics, and the drawing of pictures, numbered
 * pictures and videos. cmd_overlay.c parses the command line. */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_H

#include "overlay/layers.h"
#include "overlay/drawing.h"
#include "overlay/zoom_clip.h"

struct overlay_y4m;

/* Statistics over all frames. */
/* Min and max of N values, one value per frame */
struct overlay_span {
    double min, max;
    int n;
};

struct overlay_figures {
    /* Engine report of the frame in which most lights were merged. Its numbers
     * of lights, out-of-range lights, dropped bundles and dropped cells are
     * maxima over all frames. */
    struct glint_engine_report worst;
    int most_lights;
    /* ranges of these options over all frames */
    struct overlay_span strength, exposure, gain;
    int n_reused; /* frames that reused the traced edges of the previous frame
                   */
    /* total time of lamp detection and of the flare, ms */
    double find_ms, flare_ms;
    double peak, mean_sum; /* light of the flare, 1 = white: max over all
                              frames, and sum of the mean light of each frame */
    size_t peak_bytes;
    /* times of the start of the run and of the last progress line, s */
    double started, reported;
};

struct overlay {
    struct drawing drawing;
    /* Buffers of a video whose format is not plain 8 bits, or NULL */
    struct overlay_y4m *y4m;
    const char *input, *output;
    int start_number;
    struct zoom_clip zoom;
    /* First and last frame of a video to draw, from 0, and the number of frames
     * before FIRST in which lamps are only detected */
    int first, last, warm_up;
    /* microseconds between frames; 0: independent pictures */
    int32_t elapsed_us;
    int range, matrix; /* enums of --range and --matrix; 0: auto */
    /* format of raw frames; WIDTH 0: the input has headers */
    struct {
        int format, width, height, stride;
    } raw;
    int transfer; /* enum glint_transfer_curve; -1: auto */
    int quality;  /* quality of JPEG and WebP, 1 .. 100; 0: that of the input */
    bool is_video;
    bool lists_shots;    /* --list-shots: print the frames from cut to cut, draw
                            nothing */
    bool is_cut;         /* lamps and exposure restarted in the last frame */
    bool is_one_of_many; /* one of several inputs, which share one model */
    bool is_copied;      /* the picture file was copied, as nothing was drawn */
    struct layers layers;
    bool has_layers_type, has_raw;
    const char *encode; /* --encode: options for ffmpeg, or NULL */
    struct overlay_figures figures;
};

/* Draws the flare on IMAGE, the next frame, and updates the statistics. Returns
 * an exit code; so do all functions here that return int. */
int overlay_draw_frame(struct tool *tool, struct overlay *o,
                       const struct glint_image *image);

/* Detects lamps and updates tracks and exposure for IMAGE, a frame before the
 * first one to draw. */
int overlay_find_lamps_only(struct tool *tool, struct overlay *o,
                            const struct glint_image *image);

/* Same as overlay_draw_frame() for frames that cannot be drawn in place: calls
 * DRAW with CTX to draw the frame. */
typedef enum glint_status overlay_draw_fn(void *ctx, struct drawing *drawing,
                                          const struct glint_image *image,
                                          int32_t elapsed_us);
int overlay_draw_frame_by_callback(struct tool *tool, struct overlay *o,
                                   const struct glint_image *image,
                                   overlay_draw_fn *draw, void *ctx);

/* Prints the progress: one line that is overwritten on a terminal, else a new
 * line every few seconds. */
void overlay_print_progress(const struct tool *tool, struct overlay *o);

/* Checks a drawing of picture FROM to TO: rejects outputs that would overwrite
 * an input or another output. */
int overlay_check_outputs(const struct tool *tool, const struct overlay *o,
                          const char *from, const char *to);

/* Draws one picture from file FROM to file TO. */
int overlay_draw_picture_file(struct tool *tool, struct overlay *o,
                              const char *from, const char *to);

/* Returns whether the input is a numbered sequence: its name contains a '%' and
 * no file has this name. */
bool overlay_is_sequence(const struct overlay *o);

/* Draws the numbered pictures of the pattern o->input to the pattern
 * o->output. */
int overlay_draw_sequence(struct tool *tool, struct overlay *o);

/* Returns whether NAME is a video, by its extension. */
bool overlay_is_video(const char *name);

/* Sets VIDEO to whether an animated GIF is read or written as a video. Prints a
 * warning if only one of its frames is used. Rejects a GIF of one frame as a
 * video. */
int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video);

/* Rejects a video that needs ffmpeg if ffmpeg is not installed, before any
 * work. Returns an exit code. */
int overlay_check_ffmpeg(const struct tool *tool, const struct overlay *o);

/* Draws a video from o->input to o->output. */
int overlay_draw_video(struct tool *tool, struct overlay *o);

#endif
