/* SPDX-License-Identifier: MIT
 *
 * The parts of glint overlay: its options and result (cmd_overlay.c), and the
 * ways of pictures, numbered pictures and videos through it.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_H

#include "overlay/layers.h"
#include "overlay/drawing.h"
#include "overlay/zoom_clip.h"

struct overlay_y4m;

/* Figures over all frames. */
/* The range of N values. */
struct overlay_span {
    double min, max;
    int n;
};

struct overlay_figures {
    /* Of the frame of which most lights were merged, but with the most lights,
     * lights out of the model's range, and dropped bundles and cells of all
     * frames. */
    struct glint_engine_report worst;
    int most_lights;
    struct overlay_span strength, exposure, gain; /* by frame */
    int n_reused;             /* frames drawn with the edges of the last */
    double find_ms, flare_ms; /* ms, sums */
    double peak, mean_sum;    /* light of the flare, 1 = white: the brightest of
                                 all frames; the sum of their means */
    size_t peak_bytes;
    double started, reported; /* s, of the start and the last progress */
};

struct overlay {
    struct drawing drawing;
    /* Memory for a video that is not plain 8 bits; NULL: none. */
    struct overlay_y4m *y4m;
    const char *input, *output;
    int start_number;
    struct zoom_clip zoom;
    /* Frames of a video that are drawn, from 0, and how many before these are
     * looked at. */
    int first, last, warm_up;
    int32_t elapsed_us; /* microseconds from frame to frame; 0: still
                           pictures */
    int range, matrix;  /* 0: auto */
    /* frames without headers; WIDTH 0: none */
    struct {
        int format, width, height, stride;
    } raw;
    int transfer; /* enum glint_transfer_curve; -1: auto */
    int quality;  /* quality of JPEG and WebP; 0: the input's */
    bool is_video;
    bool lists_shots; /* Prints the frames from cut to cut, draws nothing. */
    bool is_cut;      /* Lamps and exposure restarted in the last frame. */
    bool is_copied;   /* The picture file was copied: nothing was drawn. */
    struct layers layers;
    bool has_layers_type, has_raw;
    const char *encode; /* options for ffmpeg, or NULL */
    struct overlay_figures figures;
};

/* Puts the flare on IMAGE, the next frame, and adds up its figures. Returns an
 * exit code, as all functions here that return int. */
int overlay_draw(struct tool *tool, struct overlay *o,
                 const struct glint_image *image);

/* Looks at IMAGE, a frame before the first that is drawn, so that lamps and the
 * exposure are followed. */
int overlay_look(struct tool *tool, struct overlay *o,
                 const struct glint_image *image);

/* Does as overlay_draw() for frames that are not drawn in place: DRAW draws
 * them with CTX. */
typedef enum glint_status overlay_draw_fn(void *ctx, struct drawing *drawing,
                                          const struct glint_image *image,
                                          int32_t elapsed_us);
int overlay_draw_by(struct tool *tool, struct overlay *o,
                    const struct glint_image *image, overlay_draw_fn *draw,
                    void *ctx);

/* Prints progress: over a line of a terminal, else a line every few seconds. */
void overlay_progress(const struct tool *tool, struct overlay *o);

/* Refuses a file that would be written over one that is read, or over another,
 * where the picture FROM becomes the picture TO. */
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

/* Sets VIDEO to whether an animated GIF is to be read or written as frames.
 * Warns if one frame of many is taken, and refuses a GIF of one frame as a
 * video. */
int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video);

/* Refuses, before there is work, a video that ffmpeg would have to read or
 * write and that is not installed. Returns an exit code. */
int overlay_video_check(const struct tool *tool, const struct overlay *o);

/* Draws a video from o->input to o->output. */
int overlay_video(struct tool *tool, struct overlay *o);

#endif
