/* SPDX-License-Identifier: MIT
 *
 * ffmpeg.h - videos that only ffmpeg can read or write, by the installed one.
 *
 *     ffmpeg_is_video("in.mp4");
 *     ffmpeg_probe(&video, "in.mp4");                  size, colours, sound
 *     ffmpeg_read(&reader, "in.mp4", &video, &error);  y4m comes out
 *     ffmpeg_write(&writer, &target, &video, &error);  y4m goes in
 *     ffmpeg_check(target.file, target.name, &error);  and decodes
 *
 * ffmpeg runs beside glint, at the other end of a pipe of y4m frames. Sound is
 * copied from the input as it is if the type of the output takes it, else it is
 * encoded again, with a message. The codec is of the input's family where the
 * type of the output takes that. Tags, chapters, time code, subtitles, alpha,
 * fields, colours and mastering data are kept where the output can hold them;
 * one warning names those that are not.
 *
 * A child is a program that glint runs at the end of a pipe. No shell takes
 * part, so names need no quotes. The program shares glint's standard error, or
 * is heard there. It is killed when glint dies or gives it up, and its status
 * is always taken.
 *
 * An input is a container of pictures and sound, which refers to no other file:
 * a playlist named .mp4 is refused.
 */
#ifndef GLINT_TOOLS_FFMPEG_FFMPEG_H
#define GLINT_TOOLS_FFMPEG_FFMPEG_H

#include <sys/types.h>

#include "options/tool.h"
#include "posix/output.h"
#include "video/y4m.h"

enum child_pipe {
    CHILD_WRITES, /* The child's standard output is FD, its input is empty. */
    CHILD_PRINTS, /* So are its standard output and standard error. */
    CHILD_READS /* The child's standard input is FD, its output goes nowhere. */
};

struct child {
    pid_t pid;  /* 0: none */
    int fd;     /* glint's end of the pipe; -1: closed */
    int said;   /* file of its standard error; -1: that is glint's own */
    off_t told; /* bytes of SAID that were passed on */
    const char *const *listening; /* ends with NULL, not owned */
    bool heard;                   /* it has said one of those */
    int script; /* file that it reads its filter from; -1: none */
};

/* A child that is none. */
#define CHILD_NONE ((struct child){.fd = -1, .said = -1, .script = -1})

enum {
    FFMPEG_WORD = 32,
    FFMPEG_URL = 4096,
    FFMPEG_REPORT = 512,
    FFMPEG_TAGS = 1024
};

enum ffmpeg_subtitles { SUBTITLES_NONE, SUBTITLES_TEXT, SUBTITLES_IMAGES };

/* A video in words of ffmpeg's, "" if unknown. */
struct ffmpeg_video {
    char codec[FFMPEG_WORD], profile[FFMPEG_WORD]; /* hevc, Main 10 ... */
    char pixels[FFMPEG_WORD];                      /* yuv420p ... */
    char fields[FFMPEG_WORD]; /* progressive, tt, bb, tb, bt */
    char rate[FFMPEG_WORD], mean_rate[FFMPEG_WORD]; /* frames a second, N/D */
    char timecode[FFMPEG_WORD];                     /* of the first frame */
    char range[FFMPEG_WORD], space[FFMPEG_WORD], transfer[FFMPEG_WORD],
        primaries[FFMPEG_WORD];
    char sound[FFMPEG_WORD]; /* codec of the first audio stream; "": none */
    int width, height;       /* 0: not known */
    /* streams of pictures, sound, subtitles, data and files; chapters */
    int n_pictures, n_sounds, n_subtitles, n_data, n_files, n_chapters;
    enum ffmpeg_subtitles subtitles;
    char subtitle[FFMPEG_WORD]; /* codec of the first subtitles */
    char mastering[160]; /* as x265 takes it: G(x,y)B(x,y)R(x,y)WP(x,y)L(a,b) */
    char light[FFMPEG_WORD]; /* max-cll: "1000,400" */
    bool has_dolby;          /* Dolby Vision */
    char tags[FFMPEG_TAGS];  /* names of the file's tags, each after a blank */
};

/* The time of each frame in seconds from the start of the file. */
struct ffmpeg_times {
    double *at;
    int n;
};

/* The output, and the facts that its encoder needs. */
struct ffmpeg_target {
    const char *name;  /* name of the output */
    const char *file;  /* temporary file to write, of the same extension */
    const char *sound; /* file to take sound and titles from, or NULL */
    /* Options for the encoder, words with blanks, or NULL. */
    const char *options;
    int width, height;
    bool is_444;                      /* each pixel has chroma of its own */
    const struct ffmpeg_times *times; /* times of the frames; NULL: even */
    enum glint_range range;
    bool quiet;
};

/* Returns the format of planes with CHROMA, "420", "422", "444" or "gray", and
 * BITS. */
const char *pixels_named(const char *chroma, int bits);

/* Returns whether NAME is a program of $PATH. */
bool child_exists(const char *name);

/* Passes on to standard error the lines that a child has said since. */
void child_hear(struct child *child);

/* Closes the pipe and waits until the child has ended. Returns its exit status,
 * or 128 plus the signal that killed it, or 0 if there is no child. */
int child_end(struct child *child);

/* Kills the child, if there is one, and takes its status. */
void child_kill(struct child *child);

/* Returns whether the extension is a video's: .mp4 .mkv .mov .webm .avi .mpg
 * and their like. */
bool ffmpeg_is_video(const char *name);

/* Sets VIDEO to what ffprobe knows of NAME; all is empty if it knows
 * nothing. */
void ffmpeg_probe(struct ffmpeg_video *video, const char *name);

/* Returns the number of frames that ffprobe counts in NAME, all of which it
 * reads; 0 if it cannot. */
long ffmpeg_count_frames(const char *name);

/* Sets what HEADER says of the meaning of codes to what VIDEO's tags state.
 * REPORT becomes the tags that glint does not know, ", matrix ictcp", and of
 * which HEADER keeps what it had. */
void ffmpeg_colours(const struct ffmpeg_video *video,
                    struct glint_y4m_header *header,
                    char report[FFMPEG_REPORT]);

/* Reads the times of NAME's frames. Returns whether these are not even steps of
 * VIDEO's rate. The caller frees times->at. */
bool ffmpeg_times_read(struct ffmpeg_times *times, const char *name,
                       const struct ffmpeg_video *video);

/* Returns whether files of NAME's type have a time for each frame. */
bool ffmpeg_keeps_times(const char *name);

/* Starts ffmpeg as CHILD, which writes NAME as y4m to child->fd: each frame
 * once if KEEPS_TIMES, else as many as the rate takes.
 * GLINT_E_UNSUPPORTED: there is no ffmpeg, or NAME has more than some 4000
 * bytes. GLINT_E_IO: the system gives no process or descriptor. */
enum glint_status ffmpeg_read(struct child *child, const char *name,
                              const struct ffmpeg_video *video,
                              bool keeps_times, struct glint_error *error);

/* Starts ffmpeg as CHILD, which reads y4m from child->fd and writes TARGET.
 * VIDEO is that of the input, empty where it is not known. Errors are those of
 * ffmpeg_read(), and GLINT_E_ARGUMENT: more than 96 words. */
enum glint_status ffmpeg_write(struct child *child,
                               const struct ffmpeg_target *target,
                               const struct ffmpeg_video *video,
                               struct glint_error *error);

/* Checks that the first and the last frames of FILE, which ffmpeg has written
 * to become NAME, decode. GLINT_E_OUTPUT: they do not. */
enum glint_status ffmpeg_check(const char *file, const char *name,
                               struct glint_error *error);

/* Prints a warning that names what VIDEO, the input, has and FILE, which ffmpeg
 * has written to become NAME, has not: bits, chroma, alpha, fields, streams,
 * tags and the like. */
void ffmpeg_report_losses(const char *file, const char *name,
                          const struct ffmpeg_video *video);

/* Prints the pipe that does by hand what glint overlay IN -o OUT would. */
void ffmpeg_by_hand(const struct tool *tool, const char *in, const char *out);

#endif
