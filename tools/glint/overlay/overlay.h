/* SPDX-License-Identifier: MIT
 *
 * glint overlay: its options and result (cmd_overlay.c), and how it draws
 * pictures, numbered pictures and videos. */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_H

#include "overlay/layers.h"
#include "overlay/drawing.h"
#include "overlay/zoom_clip.h"

struct overlay_y4m;

/* Statistics over all frames. */
/* The range of N values, one per frame. */
struct overlay_span {
    double min, max;
    int n;
};

struct overlay_figures {
    /* Report of the frame in which most lights were merged, but with the maxima
     * over all frames of lights, lights outside the model's range, dropped
     * bundles and dropped cells. */
    struct glint_engine_report worst;
    int most_lights;
    struct overlay_span strength, exposure, gain; /* of the frames */
    int n_reused;             /* frames drawn with the edges of the previous
                                 frame */
    double find_ms, flare_ms; /* ms, sums */
    double peak, mean_sum;    /* light of the flare, 1 = white: max over all
                                 frames; sum of the frames' means */
    size_t peak_bytes;
    double started, reported; /* s: times of the start and of the last
                                 progress */
};

struct overlay {
    struct drawing drawing;
    /* Memory for a video that is not plain 8 bits, or NULL. */
    struct overlay_y4m *y4m;
    const char *input, *output;
    int start_number;
    struct zoom_clip zoom;
    /* Frames of a video to draw, from 0, and the number of frames before FIRST
     * that are only searched for lamps. */
    int first, last, warm_up;
    int32_t elapsed_us; /* microseconds from frame to frame; 0: independent
                           pictures */
    int range, matrix;  /* 0: auto */
    /* format of frames without headers; WIDTH 0: the input has headers */
    struct {
        int format, width, height, stride;
    } raw;
    int transfer; /* enum glint_transfer_curve; -1: auto */
    int quality;  /* quality of JPEG and WebP; 0: as the input */
    bool is_video;
    bool lists_shots;    /* Prints the frames from cut to cut, draws nothing. */
    bool is_cut;         /* Lamps and exposure restarted in the last frame. */
    bool is_one_of_many; /* one of several inputs, for which one model serves */
    bool is_copied;      /* The picture file was copied: nothing was drawn. */
    struct layers layers;
    bool has_layers_type, has_raw;
    const char *encode; /* options for ffmpeg, or NULL */
    struct overlay_figures figures;
};

/* Draws the flare on IMAGE, the next frame, and adds to the statistics. Returns
 * an exit code, as all functions here that return int. */
int overlay_draw(struct tool *tool, struct overlay *o,
                 const struct glint_image *image);

/* Finds and tracks the lamps and exposure of IMAGE, a frame before the first
 * frame that is drawn. */
int overlay_find_lamps_only(struct tool *tool, struct overlay *o,
                            const struct glint_image *image);

/* As overlay_draw(), for frames that are not drawn in place: calls DRAW with
 * CTX to draw them. */
typedef enum glint_status overlay_draw_fn(void *ctx, struct drawing *drawing,
                                          const struct glint_image *image,
                                          int32_t elapsed_us);
int overlay_draw_with(struct tool *tool, struct overlay *o,
                      const struct glint_image *image, overlay_draw_fn *draw,
                      void *ctx);

/* Prints progress: on a terminal it overwrites one line, else it prints a line
 * every few seconds. */
void overlay_progress(const struct tool *tool, struct overlay *o);

/* Rejects outputs that would overwrite an input or another output, if picture
 * FROM is drawn to TO. */
int overlay_check_apart(const struct tool *tool, const struct overlay *o,
                        const char *from, const char *to);

/* Draws one picture from file FROM to file TO. */
int overlay_picture(struct tool *tool, struct overlay *o, const char *from,
                    const char *to);

/* Returns whether the input is a sequence: its name has a '%' and is not the
 * name of a file. */
bool overlay_is_sequence(const struct overlay *o);

/* Draws the numbered pictures of the patterns o->input and o->output. */
int overlay_sequence(struct tool *tool, struct overlay *o);

/* Returns whether NAME is a video, by its extension. */
bool overlay_is_video(const char *name);

/* Sets VIDEO to whether an animated GIF is read or written as a video. Warns if
 * only one of its frames is used, and rejects a GIF of one frame as a video. */
int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video);

/* Rejects early a video that needs ffmpeg if ffmpeg is not installed. Returns
 * an exit code. */
int overlay_video_check(const struct tool *tool, const struct overlay *o);

/* Draws a video from o->input to o->output. */
int overlay_video(struct tool *tool, struct overlay *o);

#endif
