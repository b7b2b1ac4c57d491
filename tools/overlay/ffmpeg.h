/* SPDX-License-Identifier: MIT
 *
 * ffmpeg.h - videos that only ffmpeg can read or write, by the user's own one.
 *
 *     ffmpeg_is_video("in.mp4");
 *     ffmpeg_probe(&video, "in.mp4");                     what is known of it
 *     ffmpeg_read(&child, "in.mp4", &video, &error);           y4m comes out
 *     ffmpeg_write(&child, "out.mp4", &out, "in.mp4", ...);    y4m goes in
 *
 * ffmpeg runs beside glint, at the other end of a pipe of y4m frames. Sound is
 * copied from the input as it is where the kind of file takes it, else encoded
 * anew, and said. Frame rate, range, matrix, primaries and transfer are kept,
 * titles and chapters, too; subtitles and further pictures are not.
 */
#ifndef GLINT_TOOLS_OVERLAY_FFMPEG_H
#define GLINT_TOOLS_OVERLAY_FFMPEG_H

#include "overlay/child.h"
#include "glint/image.h"
#include "posix/output.h"
#include "options/tool.h"

enum { FFMPEG_WORD = 32 };

/* Words of ffmpeg's, "" where it does not say. */
struct ffmpeg_video {
    char pixels[FFMPEG_WORD]; /* yuv420p ... */
    char range[FFMPEG_WORD], space[FFMPEG_WORD], transfer[FFMPEG_WORD],
        primaries[FFMPEG_WORD];
    char sound[FFMPEG_WORD]; /* codec of the first sound; "": none */
    int width, height;       /* 0: not known */
};

/* Returns whether the extension is a video's: .mp4 .mkv .mov .webm .avi .mpg
 * and their like. */
bool ffmpeg_is_video(const char *name);

/* A GIF of more than one frame, which is looked into: how many; else 0 or 1. */
int ffmpeg_gif_frames(const char *name);

/* Fills VIDEO with what ffprobe says of NAME; all empty where it says nothing.
 */
void ffmpeg_probe(struct ffmpeg_video *video, const char *name);

/* The matrix of its codes. False: not stated. */
bool ffmpeg_matrix(const struct ffmpeg_video *video, enum glint_matrix *matrix);

/* The names are used up to 4000 bytes. GLINT_E_UNSUPPORTED: no ffmpeg. */
enum glint_status ffmpeg_read(struct child *child, const char *name,
                              const struct ffmpeg_video *video,
                              struct glint_error *error);

/* The file to write, and what goes with the pictures. */
struct ffmpeg_target {
    const char *name;  /* the file that will be there */
    const char *file;  /* file that is written for now, of the same extension */
    const char *sound; /* file to take sound and titles from, or NULL */
    /* Options for the encoder, words with blanks, or NULL. */
    const char *options;
    int width, height;
    bool is_444; /* each pixel has its colour */
    enum glint_range range;
    bool quiet;
};

/* VIDEO: of the input, or of all empty words. */
enum glint_status ffmpeg_write(struct child *child,
                               const struct ffmpeg_target *target,
                               const struct ffmpeg_video *video,
                               struct glint_error *error);

/* Prints the pipe that does by hand what glint IN -o OUT would. */
void ffmpeg_by_hand(const struct tool *tool, const char *in, const char *out);

#endif
