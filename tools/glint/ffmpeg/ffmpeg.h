/* SPDX-License-Identifier: MIT
 *
 * ffmpeg.h - reads and writes videos by the installed ffmpeg program.
 *
 *     ffmpeg_is_video("in.mp4");
 *     ffmpeg_probe_video(&video, "in.mp4");                size, colours, sound
 *     ffmpeg_start_reader(&reader, "in.mp4", &video, &error);  y4m comes out
 *     ffmpeg_start_writer(&writer, &target, &video, &error);  y4m goes in
 *     ffmpeg_check_output(target.file, target.name, &error);  and decodes
 *
 * ffmpeg runs as a child process at the other end of a pipe of y4m frames.
 * Sound is copied if the output container supports its codec. Otherwise it is
 * encoded again, and a message is printed. The output has the codec of the
 * input if its container supports that codec. Tags, chapters, time code,
 * subtitles, alpha, fields, colours and mastering data are preserved if the
 * output can store them. A single warning lists all that the output lacks.
 *
 * A child is a program that glint runs at the end of a pipe. No shell is
 * involved, so names need no quotes. The child's messages go to glint's
 * standard error, either directly or through a file that glint copies. The
 * child is killed when glint ends or child_kill() is called. glint always waits
 * for its exit status.
 *
 * An input must be a container of pictures and sound that refers to no other
 * file: a playlist named .mp4 is rejected. */
#ifndef GLINT_TOOLS_FFMPEG_FFMPEG_H
#define GLINT_TOOLS_FFMPEG_FFMPEG_H

#include <sys/types.h>

#include "options/tool.h"
#include "posix/output.h"
#include "video/y4m.h"

enum child_pipe {
    /* glint reads the child's standard output from FD. The child's standard
     * input is empty. */
    CHILD_WRITES,
    /* glint reads the child's standard output and standard error from FD. The
     * child's standard input is empty. */
    CHILD_PRINTS,
    /* glint writes the child's standard input to FD. The child's standard
     * output is discarded. */
    CHILD_READS
};

struct child {
    pid_t pid; /* 0: no process */
    int fd;    /* glint's end of the pipe; -1: closed */
    int said;  /* file that receives the child's standard error; -1: the child
                * writes to glint's standard error */
    /* number of bytes of SAID already copied to glint's standard error */
    off_t told;
    /* texts to search for in the child's messages; ends with NULL, not owned */
    const char *const *listening;
    /* whether a message contained one of the texts LISTENING */
    bool heard;
    int script; /* file from which the child reads its filter; -1: none */
};

/* value of a child without a process */
#define CHILD_NONE ((struct child){.fd = -1, .said = -1, .script = -1})

enum {
    FFMPEG_WORD = 32,
    FFMPEG_URL = 4096,
    FFMPEG_REPORT = 512,
    FFMPEG_TAGS = 1024
};

enum ffmpeg_subtitles { SUBTITLES_NONE, SUBTITLES_TEXT, SUBTITLES_IMAGES };

/* Properties of a video, as ffprobe prints them; "" if unknown */
struct ffmpeg_video {
    /* names of the video codec and its profile, such as hevc and Main 10 */
    char codec[FFMPEG_WORD], profile[FFMPEG_WORD];
    char pixels[FFMPEG_WORD];
    /* progressive, or the order of interlaced fields: tt, bb, tb or bt */
    char fields[FFMPEG_WORD];
    /* nominal and mean frame rate, frames per second, as N/D */
    char rate[FFMPEG_WORD], mean_rate[FFMPEG_WORD];
    char timecode[FFMPEG_WORD]; /* time code of the first frame */
    char range[FFMPEG_WORD], space[FFMPEG_WORD], transfer[FFMPEG_WORD],
        primaries[FFMPEG_WORD];
    char sound[FFMPEG_WORD]; /* codec of the first audio stream; "": no audio */
    int width, height;       /* 0: unknown */
    /* number of video, audio, subtitle, data and attachment streams, and of
     * chapters */
    int n_pictures, n_sounds, n_subtitles, n_data, n_files, n_chapters;
    enum ffmpeg_subtitles subtitles;
    char subtitle[FFMPEG_WORD]; /* codec of the first subtitle stream */
    char mastering[160];        /* mastering display in the format of x265:
                                   G(x,y)B(x,y)R(x,y)WP(x,y)L(a,b) */
    char light[FFMPEG_WORD]; /* max and mean content light level in the format
                                of x265's max-cll: "1000,400", cd/m2 */
    bool has_dolby;          /* the video has Dolby Vision metadata */
    char tags[FFMPEG_TAGS];  /* names of the file's tags, a blank before each */
};

/* The time of each frame in seconds from the start of the file. */
struct ffmpeg_times {
    double *at;
    int n;
};

/* The output video, and what its encoder needs */
struct ffmpeg_target {
    const char *name;
    /* temporary file that ffmpeg writes; has the extension of NAME */
    const char *file;
    /* file whose sound and subtitles are copied; NULL: none */
    const char *sound;
    /* Options for the encoder, separated by blanks, or NULL. */
    const char *options;
    int width, height;
    bool is_444; /* whether chroma is not subsampled */
    /* times of the frames; NULL: constant frame rate */
    const struct ffmpeg_times *times;
    enum glint_range range;
    bool quiet;
};

/* Returns ffmpeg's name of the planar format with CHROMA, "420", "422", "444"
 * or "gray", and BITS per sample. */
const char *find_pixel_format(const char *chroma, int bits);

/* Returns whether NAME is a program in $PATH. */
bool child_is_program_installed(const char *name);

/* Copies new lines of CHILD's messages to standard error. */
void child_forward_messages(struct child *child);

/* Closes the pipe and waits until the child has ended. Returns its exit status,
 * or 128 plus the signal that killed it; 0 if there is no child. */
int child_wait_for_exit(struct child *child);

/* Kills the child, if there is one, and waits for its exit status. */
void child_kill(struct child *child);

/* Returns whether NAME has the extension of a video: .mp4 .mkv .mov .webm .avi
 * .mpg and similar. */
bool ffmpeg_is_video(const char *name);

/* Sets VIDEO to the properties that ffprobe reports of the file NAME. If
 * ffprobe fails, all members are empty. */
void ffmpeg_probe_video(struct ffmpeg_video *video, const char *name);

/* Sets the colour properties of HEADER by the tags of VIDEO. A tag that glint
 * does not support leaves HEADER unchanged and is appended to REPORT: ", matrix
 * ictcp". */
void ffmpeg_set_y4m_colour_tags(const struct ffmpeg_video *video,
                                struct glint_y4m_header *header,
                                char report[FFMPEG_REPORT]);

/* Reads the times of the frames of NAME. Returns whether the intervals differ
 * from those of the constant rate VIDEO->rate. The caller frees times->at. */
bool ffmpeg_read_times(struct ffmpeg_times *times, const char *name,
                       const struct ffmpeg_video *video);

/* Returns whether the file type of NAME stores a time for each frame. */
bool ffmpeg_can_store_times(const char *name);

/* Starts ffmpeg as CHILD, which decodes NAME and writes y4m to child->fd. If
 * KEEPS_TIMES, each frame is written once, else frames are repeated or dropped
 * to make the rate constant. Returns GLINT_E_UNSUPPORTED if ffmpeg is not
 * installed or NAME is longer than about 4000 bytes, GLINT_E_IO if no process
 * or descriptor is available. */
enum glint_status ffmpeg_start_reader(struct child *child, const char *name,
                                      const struct ffmpeg_video *video,
                                      bool keeps_times,
                                      struct glint_error *error);

/* Starts ffmpeg as CHILD, which reads y4m from child->fd and encodes TARGET.
 * VIDEO has the properties of the input, empty if unknown. Errors: those of
 * ffmpeg_start_reader(), and GLINT_E_ARGUMENT if the command has more than 96
 * words. */
enum glint_status ffmpeg_start_writer(struct child *child,
                                      const struct ffmpeg_target *target,
                                      const struct ffmpeg_video *video,
                                      struct glint_error *error);

/* Checks FILE, which ffmpeg wrote and which will be renamed to NAME. Returns
 * GLINT_E_OUTPUT if its first or last frames cannot be decoded. */
enum glint_status ffmpeg_check_output(const char *file, const char *name,
                                      struct glint_error *error);

/* Prints a warning that lists the properties of VIDEO, the input, that FILE
 * lacks: bits, chroma, alpha, fields, streams, tags and similar. ffmpeg wrote
 * FILE, which will be renamed to NAME. */
void ffmpeg_report_losses(const char *file, const char *name,
                          const struct ffmpeg_video *video);

/* Prints the shell pipeline that is equivalent to glint overlay IN -o OUT. */
void ffmpeg_print_manual_commands(const struct tool *tool, const char *in,
                                  const char *out);

#endif
