/* SPDX-License-Identifier: MIT
 *
 * The parts of glint overlay: its options and result (cmd_overlay.c), and how
 * pictures, sequences of them and videos go through it.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_H

#include "overlay/compositor.h"

struct overlay_y4m;

struct overlay {
    struct compositor compositor;
    /* Reader and writer of a video that is not of 8 bits. */
    struct overlay_y4m *y4m;
    const char *input, *output;
    int start_number;
    int32_t elapsed_us; /* microseconds from frame to frame; 0: pictures by
                           themselves */
    int range, matrix;  /* 0: auto */
    int quality;        /* quality of JPEG and WebP; 0: the input's */
    bool is_video;
    const char *encode; /* options for ffmpeg, or NULL */

    /* Lights of the frame with most too many, and of the one with most beyond
     * the model. */
    struct glint_frame_report worst;
    int most_lights;
    double find_ms, flare_ms, started, reported; /* seconds; of progress */
    double peak, mean_sum; /* light of the flare, 1 = white: the brightest of
                              all frames; the sum of their means */
    size_t peak_bytes;
};

/* Puts the flare on IMAGE, which is the next frame, and counts what it took.
 * Returns an exit code, as all of these do. */
int overlay_draw(struct tool *tool, struct overlay *o,
                 const struct glint_image *image);

/* The same where frames are not drawn in place: DRAW does it with CTX. */
typedef enum glint_status overlay_draw_fn(void *ctx,
                                          struct compositor *compositor,
                                          const struct glint_image *image,
                                          int32_t elapsed_us);
int overlay_draw_by(struct tool *tool, struct overlay *o,
                    const struct glint_image *image, overlay_draw_fn *draw,
                    void *ctx);

/* Tells a terminal how far it has come, else a line every few seconds. */
void overlay_progress(const struct tool *tool, struct overlay *o);

/* Refuses an output TO that is the file FROM: what was photographed would be
 * gone. */
int overlay_check_apart(const struct tool *tool, const char *from,
                        const char *to);

/* One picture from file FROM to file TO. */
int overlay_picture(struct tool *tool, struct overlay *o, const char *from,
                    const char *to);

/* The picture o->input to o->output, which may have a %d: then the first. */
int overlay_numbered(struct tool *tool, struct overlay *o);

/* Numbered pictures, as o->input and o->output have them. */
int overlay_sequence(struct tool *tool, struct overlay *o);

/* Returns whether NAME is a video, by its extension. */
bool overlay_is_video(const char *name);

/* Decides on animated GIF: sets VIDEO where it goes in or out as frames, and
 * says where one frame of many is taken. */
int overlay_check_gif(struct tool *tool, const struct overlay *o, bool *video);

/* A video from o->input to o->output. */
int overlay_video(struct tool *tool, struct overlay *o);

#endif
