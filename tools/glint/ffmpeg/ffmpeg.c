/* SPDX-License-Identifier: MIT
 *
 * Runs ffmpeg and ffprobe as child processes: reads properties and frames of
 * videos, chooses encoder options, and checks that a written file decodes and
 * which properties of the input it has lost.
 */
#define _GNU_SOURCE /* pipe2, memfd_create, fallocate */
#include "ffmpeg/ffmpeg.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "glint/options.h"
#include "posix/at_death.h"
#include "posix/error.h"
#include "posix/input.h"

static bool contains_one_of(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (strstr(text, *words))
            return true;
    return false;
}

/* Returns the bits per sample of pixel format PIXELS: 8, 10, 12 or 16. */
static int get_pixel_format_bits(const char *pixels)
{
    static const char *const of_8[] = {"nv12", "nv16", "yuv410p", NULL};
    static const char *const of_16[] = {"16", "14", "48", "64", "f32", NULL};
    static const char *const of_10[] = {"10", "p9", NULL};

    return contains_one_of(pixels, of_8)    ? 8
           : contains_one_of(pixels, of_16) ? 16
           : strstr(pixels, "12")           ? 12
           : contains_one_of(pixels, of_10) ? 10
                                            : 8;
}

static bool is_pixel_format_rgb(const char *pixels)
{
    static const char *const rgb[] = {"rgb", "bgr",  "gbr", "argb",
                                      "xyz", "pal8", NULL};

    return contains_one_of(pixels, rgb);
}

static bool has_pixel_format_alpha(const char *pixels)
{
    static const char *const alpha[] = {"yuva", "ayuv", "vuya", "rgba",
                                        "bgra", "argb", "abgr", "gbrap",
                                        "ya8",  "ya16", NULL};

    return contains_one_of(pixels, alpha);
}

/* Returns the chroma subsampling of pixel format PIXELS: "444" (also for RGB),
 * "422", "440", "420", "411", "410", or "gray" without chroma. */
static const char *get_pixel_format_chroma(const char *pixels)
{
    static const char *const of_444[] = {"444",  "nv24", "nv42", "p410", "p416",
                                         "ayuv", "vuy",  "xv",   NULL};
    static const char *const of_422[] = {"422",  "nv16", "nv20", "p210",
                                         "p216", "y210", "y212", NULL};
    static const char *const rare[] = {"410", "411", "440", NULL};

    if (strncmp(pixels, "gray", 4) == 0 || strncmp(pixels, "mono", 4) == 0 ||
        strncmp(pixels, "ya", 2) == 0)
        return "gray";
    if (is_pixel_format_rgb(pixels) || contains_one_of(pixels, of_444))
        return "444";
    if (contains_one_of(pixels, of_422))
        return "422";
    for (int i = 0; rare[i]; i++)
        if (strstr(pixels, rare[i]))
            return rare[i];
    return "420";
}

const char *find_pixel_format(const char *chroma, int bits)
{
    static const char *const table[][5] = {
        {"422", "yuv422p", "yuv422p10le", "yuv422p12le", "yuv422p16le"},
        {"444", "yuv444p", "yuv444p10le", "yuv444p12le", "yuv444p16le"},
        {"gray", "gray", "gray10le", "gray12le", "gray16le"},
        {"420", "yuv420p", "yuv420p10le", "yuv420p12le", "yuv420p16le"}};
    const int column = bits <= 8 ? 1 : bits <= 10 ? 2 : bits <= 12 ? 3 : 4;
    size_t i = 0;

    while (i < 3 && strcmp(table[i][0], chroma) != 0)
        i++;
    return table[i][column];
}

/* Returns the y4m pixel format that preserves all samples of PIXELS except
 * alpha, or the nearest format if y4m lacks the chroma subsampling of
 * PIXELS. */
static const char *choose_y4m_pixel_format(const char *pixels)
{
    const char *const chroma = get_pixel_format_chroma(pixels);

    if (strncmp(pixels, "yuvj", 4) == 0) /* full range, too */
        return strcmp(chroma, "444") == 0   ? "yuvj444p"
               : strcmp(chroma, "422") == 0 ? "yuvj422p"
                                            : "yuvj420p";
    return find_pixel_format(chroma, get_pixel_format_bits(pixels));
}

enum { MAX_CHILDREN = 4, NOT_FOUND = 127 };

/* process ids of running children, which are killed when glint ends; 0: unused
 * entry. A signal handler reads the ids, so access is atomic. */
static pid_t running[MAX_CHILDREN];

static void kill_all_children(void)
{
    const int saved = errno;

    for (int i = 0; i < MAX_CHILDREN; i++) {
        const pid_t pid = __atomic_load_n(&running[i], __ATOMIC_SEQ_CST);

        if (pid > 0)
            kill(pid, SIGKILL);
    }
    errno = saved;
}

static void replace_running_child(pid_t old, pid_t fresh)
{
    for (int i = 0; i < MAX_CHILDREN; i++) {
        pid_t expected = old;

        if (__atomic_compare_exchange_n(&running[i], &expected, fresh, 0,
                                        __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
            return;
    }
}

bool child_is_program_installed(const char *name)
{
    const char *path = getenv("PATH");
    char file[4096];

    for (; path && *path; path += strcspn(path, ":"), path += *path == ':') {
        const int n = (int)strcspn(path, ":");

        if (n > 0 &&
            (size_t)snprintf(file, sizeof file, "%.*s/%s", n, path, name) <
                sizeof file &&
            access(file, X_OK) == 0)
            return true;
    }
    return false;
}

/* ----------------------------------------------------------------- starting */

/* Executes ARGV in the child after fork(). IN, OUT and SAID become standard
 * input, output and error (SAID -1: inherited). If exec fails, writes errno to
 * FAILED. Makes system calls only. */
static void exec_child_program(const char *const *argv, int in, int out,
                               int said, int failed)
{
    sigset_t none;
    int number;

    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        (said < 0 || dup2(said, STDERR_FILENO) >= 0))
        execvp(argv[0], (char *const *)argv);
    number = errno;
    if (write(failed, &number, sizeof number) < 0)
        _exit(NOT_FOUND);
    _exit(NOT_FOUND);
}

/* Returns the errno that exec_child_program() wrote to FD, or 0 if the program
 * was executed. */
static int read_child_exec_errno(int fd)
{
    int number = 0;
    ssize_t n;

    do
        n = read(fd, &number, sizeof number);
    while (n < 0 && errno == EINTR);
    return n == (ssize_t)sizeof number ? number : 0;
}

/* Opens the pipe DATA for the child's input or output, and the pipe FAILED for
 * the errno of exec. exec closes both in the child. */
static bool open_child_pipes(int data[2], int failed[2])
{
    if (pipe2(data, O_CLOEXEC) < 0)
        return false;
    if (pipe2(failed, O_CLOEXEC) == 0)
        return true;
    close(data[0]);
    close(data[1]);
    return false;
}

static enum glint_status report_start_failure(const char *name, int number,
                                              struct glint_error *error)
{
    if (number == ENOENT)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                                  "is not installed");
    return glint_error_report_errno(error, GLINT_E_IO, name, number);
}

static enum glint_status start_program(struct child *child,
                                       const char *const *argv,
                                       enum child_pipe kind,
                                       struct glint_error *error)
{
    const int mine = kind == CHILD_READS ? 1 : 0;
    int data[2], failed[2], number;
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);

    glint_at_death_register(kill_all_children);
    if (null < 0 || !open_child_pipes(data, failed)) {
        number = errno;
        if (null >= 0)
            close(null);
        return report_start_failure(argv[0], number, error);
    }
    child->pid = fork();
    if (child->pid == 0)
        exec_child_program(
            argv, mine == 0 ? null : data[0], mine == 0 ? data[1] : null,
            kind == CHILD_PRINTS ? data[1] : child->said, failed[1]);
    number = errno;
    close(null);
    close(data[1 - mine]);
    close(failed[1]);
    if (child->pid > 0) {
        replace_running_child(0, child->pid);
        number = read_child_exec_errno(failed[0]);
    }
    close(failed[0]);
    child->fd = data[mine];
    if (child->pid > 0 && number == 0)
        return GLINT_OK;
    if (child->pid < 0)
        child->pid = 0;
    child_wait_for_exit(child);
    return report_start_failure(argv[0], number, error);
}

/* Starts the program ARGV[0], found in $PATH, with the arguments ARGV, which
 * end with NULL. WORDS: NULL, or a list that ends with NULL; then standard
 * error is a file, which child_forward_messages() copies to glint's standard
 * error, and CHILD->heard is set if the file contains one of WORDS. Errors:
 * GLINT_E_UNSUPPORTED if the program is not installed, GLINT_E_MEMORY if the
 * system has no free process or descriptor, GLINT_E_IO if the program cannot be
 * executed. */
static enum glint_status start_ffmpeg_child(struct child *child,
                                            const char *const *argv,
                                            enum child_pipe kind,
                                            const char *const *words,
                                            struct glint_error *error)
{
    enum glint_status status;

    *child = CHILD_NONE;
    child->listening = words;
    /* A full pipe would block the child; a file cannot. */
    if (words)
        child->said = memfd_create("said", MFD_CLOEXEC);
    if (child->said >= 0)
        fcntl(child->said, F_SETFL, O_APPEND);
    status = start_program(child, argv, kind, error);
    if (status != GLINT_OK)
        child_kill(child);
    return status;
}

/* ---------------------------------------------------------- child messages */

/* Copies new messages of CHILD to standard error: complete lines, or all text
 * if ALL. */
static void forward_child_messages(struct child *child, bool all)
{
    char text[4096];
    ssize_t n;

    while (child->said >= 0 &&
           (n = pread(child->said, text, sizeof text - 1, child->told)) > 0) {
        const char *const end = memrchr(text, '\n', (size_t)n);

        if (end)
            n = end - text + 1;
        else if (!all && n < (ssize_t)sizeof text - 1)
            return;
        text[n] = '\0';
        for (int i = 0; child->listening[i]; i++)
            child->heard |= strstr(text, child->listening[i]) != NULL;
        fwrite(text, 1, (size_t)n, stderr);
        child->told += n;
        /* Frees the memory of the copied text. A failure only leaves that
         * memory in use. */
        (void)fallocate(child->said, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                        0, child->told);
    }
}

void child_forward_messages(struct child *child)
{
    forward_child_messages(child, false);
}

static void close_child_messages(struct child *child)
{
    forward_child_messages(child, true);
    if (child->said >= 0)
        close(child->said);
    child->said = -1;
}

/* --------------------------------------------------------- end of children */

/* Closes the filter file of CHILD after CHILD has ended, because before it may
 * not have opened the file yet. */
static void close_filter_script(struct child *child)
{
    if (child->script >= 0)
        close(child->script);
    child->script = -1;
}

int child_wait_for_exit(struct child *child)
{
    int status = 0;
    pid_t pid;

    if (child->fd >= 0)
        close(child->fd);
    child->fd = -1;
    if (child->pid <= 0) {
        close_filter_script(child);
        close_child_messages(child);
        return 0;
    }
    do
        pid = waitpid(child->pid, &status, 0);
    while (pid < 0 && errno == EINTR);
    replace_running_child(child->pid, 0);
    child->pid = 0;
    close_filter_script(child);
    close_child_messages(child);
    if (pid < 0)
        return NOT_FOUND;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void child_kill(struct child *child)
{
    if (child->pid > 0)
        kill(child->pid, SIGKILL);
    child_wait_for_exit(child);
}

enum { MAX_WORDS = 96, PROBE_BYTES = 1 << 16 };

static const char *find_file_extension(const char *name)
{
    const char *dot = strrchr(name, '.');

    return dot && !strchr(dot, '/') ? dot + 1 : "";
}

static bool is_word_in_list(const char *word, const char *const *words)
{
    for (; *words; words++)
        if (strcasecmp(word, *words) == 0)
            return true;
    return false;
}

bool ffmpeg_is_video(const char *name)
{
    static const char *const extensions[] = {
        "mp4", "m4v",  "mkv", "mov", "webm", "avi", "mpg", "mpeg", "ts",
        "mts", "m2ts", "wmv", "flv", "ogv",  "3gp", "mxf", NULL};

    return is_word_in_list(find_file_extension(name), extensions);
}

/* Sets URL to "file:NAME", so that ffmpeg interprets NAME as a file in any
 * case. Returns false if NAME is too long. */
static bool set_file_url(char url[FFMPEG_URL], const char *name)
{
    return (size_t)snprintf(url, FFMPEG_URL, "file:%s", name) < FFMPEG_URL;
}

/* Container formats that ffmpeg may read, none of which can refer to other
 * files as playlists (HLS, concat, DASH) do. The only protocol allowed is a
 * file. */
static const char containers[] =
    "mov,matroska,avi,mpeg,mpegvideo,mpegts,m4v,h264,hevc,asf,flv,"
    "ogg,mxf,mxf_opatom,gif";
static const char *const input_limits[] = {"-format_whitelist", containers,
                                           "-protocol_whitelist", "file", NULL};

/* -------------------------------------------------------------------- probe */

/* If LINE is "NAME=value", sets WORD to the value, unless WORD is already set
 * or the value is "unknown", "N/A" or "reserved". */
static void parse_word_property(const char *line, const char *name, char *word)
{
    const size_t n = strlen(name);

    if (*word || strncmp(line, name, n) != 0 || line[n] != '=' ||
        strcmp(line + n + 1, "unknown") == 0 ||
        strcmp(line + n + 1, "N/A") == 0 ||
        strcmp(line + n + 1, "reserved") == 0)
        return;
    snprintf(word, FFMPEG_WORD, "%s", line + n + 1);
}

static void parse_number_property(const char *line, const char *name,
                                  int *number)
{
    char word[FFMPEG_WORD] = "";

    parse_word_property(line, name, word);
    if (*word)
        tool_parse_integer(word, 1, GLINT_MAX_SIDE, number);
}

static void parse_stream_line(struct ffmpeg_video *v, const char *line)
{
    parse_word_property(line, "codec_name", v->codec);
    parse_word_property(line, "profile", v->profile);
    parse_word_property(line, "pix_fmt", v->pixels);
    parse_word_property(line, "field_order", v->fields);
    parse_word_property(line, "r_frame_rate", v->rate);
    parse_word_property(line, "avg_frame_rate", v->mean_rate);
    parse_word_property(line, "color_range", v->range);
    parse_word_property(line, "color_space", v->space);
    parse_word_property(line, "color_transfer", v->transfer);
    parse_word_property(line, "color_primaries", v->primaries);
    parse_number_property(line, "width", &v->width);
    parse_number_property(line, "height", &v->height);
}

/* Returns UNITS times the value of NAME, N/D or N, in the ffprobe output TEXT,
 * rounded to an integer; -1 if the value is missing or malformed. */
static long parse_scaled_ratio(const char *text, const char *name, long units)
{
    const char *const at = strstr(text, name);
    char *end;
    long n, d = 1;

    if (!at)
        return -1;
    n = strtol(at + strlen(name), &end, 10);
    if (*end == '/')
        d = strtol(end + 1, NULL, 10);
    return d > 0 ? (n * units + d / 2) / d : -1;
}

/* Reads mastering display, light levels and Dolby Vision from TEXT, the output
 * of ffprobe about the side data of stream and first frame. */
static void parse_side_data(struct ffmpeg_video *v, const char *text)
{
    static const char *const names[] = {
        "green_x=",       "green_y=",      "blue_x=",        "blue_y=",
        "red_x=",         "red_y=",        "white_point_x=", "white_point_y=",
        "max_luminance=", "min_luminance="};
    long m[10];
    bool is_whole = true;

    for (int i = 0; i < 10; i++) {
        m[i] = parse_scaled_ratio(text, names[i], i < 8 ? 50000 : 10000);
        is_whole = is_whole && m[i] >= 0;
    }
    if (is_whole)
        snprintf(v->mastering, sizeof v->mastering,
                 "G(%ld,%ld)B(%ld,%ld)R(%ld,%ld)WP(%ld,%ld)L(%ld,%ld)", m[0],
                 m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9]);
    if (strstr(text, "max_content="))
        snprintf(v->light, sizeof v->light, "%ld,%ld",
                 parse_scaled_ratio(text, "max_content=", 1),
                 parse_scaled_ratio(text, "max_average=", 1));
    v->has_dolby =
        v->has_dolby || strstr(text, "DOVI") || strstr(text, "Dolby Vision");
}

/* Counts a stream of type KIND (ffprobe's codec_type), with CODEC. */
static void count_stream_of_type(struct ffmpeg_video *v, const char *codec,
                                 const char *kind)
{
    static const char *const texts[] = {"subrip", "srt",    "ass",      "ssa",
                                        "text",   "webvtt", "mov_text", NULL};

    v->n_pictures += strcmp(kind, "video") == 0;
    v->n_sounds += strcmp(kind, "audio") == 0;
    v->n_data += strcmp(kind, "data") == 0;
    v->n_files += strcmp(kind, "attachment") == 0;
    if (strcmp(kind, "subtitle") == 0) {
        v->n_subtitles++;
        if (!*v->subtitle)
            snprintf(v->subtitle, sizeof v->subtitle, "%s", codec);
        if (!is_word_in_list(codec, texts))
            v->subtitles = SUBTITLES_IMAGES;
        else if (v->subtitles == SUBTITLES_NONE)
            v->subtitles = SUBTITLES_TEXT;
    }
}

/* Parses LINE, ffprobe output about a stream of any type, a chapter or tags.
 * CODEC stores the codec from one line of a stream to the next. A time code
 * track is not counted as a stream, because its tag is preserved. */
static void parse_other_stream_line(struct ffmpeg_video *v, char *line,
                                    char codec[FFMPEG_WORD])
{
    char kind[FFMPEG_WORD] = "";
    const size_t n = strlen(v->tags);

    if (strncmp(line, "codec_name=", 11) == 0)
        snprintf(codec, FFMPEG_WORD, "%.31s", line + 11);
    parse_word_property(line, "codec_type", kind);
    if (*kind) {
        count_stream_of_type(v, codec, kind);
        if (strcmp(kind, "audio") == 0 && !*v->sound)
            snprintf(v->sound, sizeof v->sound, "%s", codec);
        *codec = '\0';
    }
    if (strcmp(line, "codec_tag_string=tmcd") == 0)
        v->n_data--;
    parse_word_property(line, "TAG:timecode", v->timecode);
    parse_word_property(line, "TAG:TIMECODE", v->timecode);
    v->n_chapters += strncmp(line, "start_time=", 11) == 0;
    if (strncmp(line, "TAG:", 4) != 0)
        return;
    line[strcspn(line, "=")] = '\0';
    if (n + strlen(line) < sizeof v->tags - 1)
        snprintf(v->tags + n, sizeof v->tags - n, " %s", line + 4);
}

/* Reads the output of CHILD into TEXT as a string, at most PROBE_BYTES. */
static void read_child_output(struct child *child, char text[PROBE_BYTES])
{
    size_t used = 0;
    ssize_t n;

    while (used < PROBE_BYTES - 1 &&
           ((n = read(child->fd, text + used, PROBE_BYTES - 1 - used)) > 0 ||
            (n < 0 && errno == EINTR)))
        used += n > 0 ? (size_t)n : 0;
    text[used] = '\0';
}

/* Sets TEXT to what ffprobe prints about ENTRIES of URL. OPTIONS has up to five
 * more arguments and ends with NULL. Returns false if ffprobe fails. */
static bool run_ffprobe(const char *url, const char *const *options,
                        const char *entries, char text[PROBE_BYTES])
{
    const char *argv[18] = {"ffprobe",       "-v",
                            "quiet",         "-show_entries",
                            entries,         "-of",
                            "default=nw=1",  input_limits[0],
                            input_limits[1], input_limits[2],
                            input_limits[3], url};
    struct glint_error error;
    struct child child;

    for (int i = 0; options[i]; i++)
        argv[12 + i] = options[i];
    *text = '\0';
    if (start_ffmpeg_child(&child, argv, CHILD_WRITES, NULL, &error) !=
        GLINT_OK)
        return false;
    read_child_output(&child, text);
    return child_wait_for_exit(&child) == 0;
}

static const char *const of_pictures[] = {"-select_streams", "v:0", NULL};
static const char *const of_all[] = {NULL};

void ffmpeg_probe_video(struct ffmpeg_video *video, const char *name)
{
    static const char *const of_first[] = {"-select_streams", "v:0",
                                           "-read_intervals", "%+#1", NULL};
    char url[FFMPEG_URL], text[PROBE_BYTES], *line, *rest = text;
    char codec[FFMPEG_WORD] = "";

    *video = (struct ffmpeg_video){.width = 0};
    if (!set_file_url(url, name))
        return;
    run_ffprobe(
        url, of_pictures,
        "stream=codec_name,profile,width,height,pix_fmt,field_order,"
        "r_frame_rate,avg_frame_rate,color_range,color_space,color_transfer,"
        "color_primaries",
        text);
    while ((line = strtok_r(rest, "\r\n", &rest)))
        parse_stream_line(video, line);
    rest = text;
    run_ffprobe(
        url, of_all,
        "stream=codec_name,codec_type,codec_tag_string:stream_tags=timecode:"
        "chapter=start_time:chapter_tags=:format_tags",
        text);
    while ((line = strtok_r(rest, "\r\n", &rest)))
        parse_other_stream_line(video, line, codec);
    if (strcmp(video->transfer, "smpte2084") == 0 ||
        strcmp(video->transfer, "arib-std-b67") == 0) {
        run_ffprobe(url, of_first, "stream_side_data:frame_side_data", text);
        parse_side_data(video, text);
    }
}

/* Appends ", KIND TAG" to REPORT if VALUE is below 0, because glint does not
 * support TAG, and TAG is not empty. Returns VALUE. */
static int report_unsupported_tag(int value, const char *kind, const char *tag,
                                  char report[FFMPEG_REPORT])
{
    const size_t n = strlen(report);

    if (value < 0 && *tag)
        snprintf(report + n, FFMPEG_REPORT - n, ", %s %s", kind, tag);
    return value;
}

void ffmpeg_set_y4m_colour_tags(const struct ffmpeg_video *video,
                                struct glint_y4m_header *header,
                                char report[FFMPEG_REPORT])
{
    static const char *const sd[] = {"smpte170m", "bt470bg", "fcc", NULL};
    static const char *const rgb[] = {"gbr", "rgb", NULL};
    const char *const space = video->space;
    const int matrix = is_word_in_list(space, sd)       ? GLINT_MATRIX_BT601
                       : strcmp(space, "bt709") == 0    ? GLINT_MATRIX_BT709
                       : strcmp(space, "bt2020nc") == 0 ? GLINT_MATRIX_BT2020
                                                        : -1;
    const int transfer = glint_transfer_from_tag(video->transfer);
    const int primaries = glint_primaries_from_tag(video->primaries);

    *report = '\0';
    if (!is_word_in_list(space, rgb))
        report_unsupported_tag(matrix, "matrix", space, report);
    report_unsupported_tag(transfer, "transfer", video->transfer, report);
    report_unsupported_tag(primaries, "primaries", video->primaries, report);
    if (matrix >= 0)
        header->matrix = (enum glint_matrix)matrix;
    if (transfer >= 0)
        header->transfer = (enum glint_transfer_curve)transfer;
    if (primaries >= 0)
        header->primaries = (enum glint_primaries)primaries;
}

/* ---------------------------------------------------------- argument lists */

/* Command line under construction. N may exceed MAX_WORDS, which is then an
 * error. */
struct words {
    const char *word[MAX_WORDS + 1];
    int n;
};

static void add_argument(struct words *w, const char *word)
{
    if (w->n < MAX_WORDS)
        w->word[w->n] = word;
    w->n++;
}

static void add_two_arguments(struct words *w, const char *a, const char *b)
{
    add_argument(w, a);
    add_argument(w, b);
}

/* Adds "-i URL" after the options that limit what ffmpeg may open. */
static void add_input_url(struct words *w, const char *url)
{
    for (int i = 0; input_limits[i]; i++)
        add_argument(w, input_limits[i]);
    add_two_arguments(w, "-i", url);
}

static void begin_ffmpeg_argument_list(struct words *w)
{
    static const char *const first[] = {"ffmpeg",    "-nostdin", "-hide_banner",
                                        "-loglevel", "error",    NULL};

    w->n = 0;
    for (int i = 0; first[i]; i++)
        add_argument(w, first[i]);
}

/* Terminates the arguments by NULL. Returns an error if there were too many. */
static enum glint_status end_ffmpeg_arguments(struct words *w,
                                              struct glint_error *error)
{
    if (w->n > MAX_WORDS)
        return glint_error_report(error, GLINT_E_ARGUMENT, "ffmpeg",
                                  "--encode has more than %d words", MAX_WORDS);
    w->word[w->n] = NULL;
    return GLINT_OK;
}

/* Messages of ffmpeg 5 about a truncated file, despite which it exits with 0.
 * The list ends with NULL. */
static const char *const ffmpeg_cut_words[] = {
    "File ended prematurely" /* .mkv, .webm */, "partial file" /* .mp4, .mov */,
    NULL};

static enum glint_status report_too_long_file_name(const char *name,
                                                   struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                              "the file name is too long for ffmpeg");
}

/* ------------------------------------------------------------------- times */

/* Returns the value of TEXT, "N/D", or 0 if it is malformed. */
static double parse_ratio(const char *text)
{
    const char *end;
    const double n = glint_option_number(text, &end);
    const double d = *end == '/' ? glint_option_number(end + 1, &end) : 1;

    return d > 0 ? n / d : 0;
}

bool ffmpeg_can_store_times(const char *name)
{
    static const char *const types[] = {"mp4", "m4v",  "mov",
                                        "mkv", "webm", NULL};

    return is_word_in_list(find_file_extension(name), types);
}

static int compare_times(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Reads packet times from FROM, lines "seconds,flags", and sorts them. Skips
 * packets with the flag D, which are not displayed. */
static void read_packet_times(FILE *from, struct ffmpeg_times *times)
{
    double *more;
    char line[128];
    const char *end;
    int room = 0;

    while (fgets(line, sizeof line, from)) {
        const double time = glint_option_number(line, &end);

        if (end == line || strchr(end, 'D'))
            continue;
        if (times->n == room) {
            room = room ? 2 * room : 256;
            more = realloc(times->at, (size_t)room * sizeof *more);
            if (!more)
                break;
            times->at = more;
        }
        times->at[times->n++] = time;
    }
    if (times->n)
        qsort(times->at, (size_t)times->n, sizeof *times->at, compare_times);
}

/* Returns whether TIMES deviate by more than 2 ms from a constant RATE, frames
 * per second: an interval also by more than a quarter of it, or the time since
 * the first frame also by more than half an interval. */
static bool is_frame_rate_variable(const struct ffmpeg_times *times,
                                   double rate)
{
    const double *const at = times->at;
    const double step = rate > 0 ? 1 / rate : 0;

    for (int i = 1; i < times->n; i++)
        if (fabs(at[i] - at[i - 1] - step) > fmax(step / 4, 2e-3) ||
            fabs(at[i] - at[0] - i * step) > fmax(step / 2, 2e-3))
            return true;
    return false;
}

bool ffmpeg_read_times(struct ffmpeg_times *times, const char *name,
                       const struct ffmpeg_video *video)
{
    char url[FFMPEG_URL], text[PROBE_BYTES], start[FFMPEG_WORD] = "";
    const char *end;
    const char *const argv[] = {"ffprobe",
                                "-v",
                                "quiet",
                                "-select_streams",
                                "v:0",
                                "-show_entries",
                                "packet=pts_time,flags",
                                "-of",
                                "csv=p=0",
                                url,
                                NULL};
    struct glint_error error;
    struct child child;
    FILE *from;

    *times = (struct ffmpeg_times){NULL, 0};
    if (!set_file_url(url, name) ||
        start_ffmpeg_child(&child, argv, CHILD_WRITES, NULL, &error) !=
            GLINT_OK)
        return false;
    from = fdopen(child.fd, "r");
    if (from) {
        read_packet_times(from, times);
        fclose(from);
        child.fd = -1;
    }
    child_wait_for_exit(&child);
    if (!is_frame_rate_variable(times, parse_ratio(video->rate)))
        return false;
    run_ffprobe(url, of_all, "format=start_time", text);
    text[strcspn(text, "\r\n")] = '\0';
    parse_word_property(text, "start_time", start);
    for (int i = 0; i < times->n; i++)
        times->at[i] -= glint_option_number(start, &end);
    return true;
}

/* Writes to TO an ffmpeg expression that maps the frame number N, FIRST .. END
 * - 1, to TIMES[N] in units of 1 / 90000 s. The expression is a binary tree of
 * comparisons. */
static void write_time_expression(FILE *to, const double *times, int first,
                                  int end)
{
    const int middle = first + (end - first) / 2;

    if (end - first == 1) {
        fprintf(to, "%.0f", times[first] * 90000);
        return;
    }
    fprintf(to, "if(lt(N,%d),", middle);
    write_time_expression(to, times, first, middle);
    fputc(',', to);
    write_time_expression(to, times, middle, end);
    fputc(')', to);
}

/* Writes a filter script to a memory file: FILTER (may be NULL), then a filter
 * that sets the TIMES of the frames. Sets NAME to the file's name. Returns the
 * file's descriptor, or -1 on failure. */
static int write_filter_script(const struct ffmpeg_times *times,
                               const char *filter, char name[FFMPEG_WORD + 16])
{
    const int fd = memfd_create("times", MFD_CLOEXEC);
    FILE *const to = fd >= 0 ? fdopen(dup(fd), "w") : NULL;
    bool is_whole = to != NULL;

    if (to) {
        fprintf(to, "%s%ssettb=1/90000,setpts='", filter ? filter : "",
                filter ? "," : "");
        write_time_expression(to, times->at, 0, times->n);
        fputs("'", to);
        is_whole = !ferror(to) && fclose(to) == 0;
    }
    snprintf(name, FFMPEG_WORD + 16, "/proc/%ld/fd/%d", (long)getpid(), fd);
    if (is_whole || fd < 0)
        return fd;
    close(fd);
    return -1;
}

/* ---------------------------------------------------------------- decoding */

enum glint_status ffmpeg_start_reader(struct child *child, const char *name,
                                      const struct ffmpeg_video *video,
                                      bool keeps_times,
                                      struct glint_error *error)
{
    char url[FFMPEG_URL];
    enum glint_status status;
    struct words w;

    *child = CHILD_NONE;
    if (!set_file_url(url, name))
        return report_too_long_file_name(name, error);
    begin_ffmpeg_argument_list(&w);
    add_input_url(&w, url);
    add_two_arguments(&w, "-map", "0:v:0");
    if (keeps_times)
        add_two_arguments(&w, "-fps_mode", "passthrough");
    add_two_arguments(&w, "-pix_fmt", choose_y4m_pixel_format(video->pixels));
    add_two_arguments(&w, "-strict", "-1");
    add_two_arguments(&w, "-f", "yuv4mpegpipe");
    add_argument(&w, "-");
    status = end_ffmpeg_arguments(&w, error);
    return status == GLINT_OK ? start_ffmpeg_child(child, w.word, CHILD_WRITES,
                                                   ffmpeg_cut_words, error)
                              : status;
}

/* ---------------------------------------------------------------- encoding */

/* Returns whether files with extension EXT can contain sound of CODEC without
 * re-encoding. */
static bool can_hold_sound_codec(const char *ext, const char *codec)
{
    static const char *const webm[] = {"opus", "vorbis", NULL};
    static const char *const mp4[] = {"aac",  "mp3",  "ac3", "eac3", "alac",
                                      "opus", "flac", "mp2", "dts",  NULL};
    static const char *const mov[] = {
        "aac",       "mp3", "ac3",       "eac3",      "alac", "pcm_s16le",
        "pcm_s16be", "mp2", "pcm_s24le", "pcm_f32le", NULL};
    static const char *const avi[] = {"aac", "mp3",       "ac3",
                                      "mp2", "pcm_s16le", NULL};
    static const char *const mpeg[] = {"mp2", "mp3", "ac3", "mp1", NULL};
    static const char *const ogg[] = {"opus", "vorbis", "flac", NULL};
    static const struct {
        const char *ext;
        const char *const *codecs;
    } table[] = {{"webm", webm}, {"mp4", mp4},  {"m4v", mp4},
                 {"3gp", mp4},   {"mpg", mpeg}, {"mpeg", mpeg},
                 {"ogv", ogg},   {"mov", mov},  {"avi", avi}};

    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcasecmp(ext, table[i].ext) == 0)
            return is_word_in_list(codec, table[i].codecs);
    return true; /* .mkv and .ts accept nearly all codecs */
}

static const char *const of_mov[] = {"mov", "mp4", "m4v", "3gp", NULL};
static const char *const of_mkv[] = {"mkv", "mka", NULL};

/* Adds arguments that copy the subtitles of the second input to a file of type
 * EXT. Matroska accepts all subtitles and attachments. Other types accept text
 * only, which is converted to the codec of the type. */
static void add_subtitle_arguments(struct words *w, const char *ext,
                                   const struct ffmpeg_video *v)
{
    const bool is_mov = is_word_in_list(ext, of_mov);
    const bool is_webm = strcasecmp(ext, "webm") == 0;

    if (is_word_in_list(ext, of_mkv)) {
        add_two_arguments(w, "-map", "1:s?");
        if (v->n_subtitles)
            add_two_arguments(w, "-c:s",
                              strcmp(v->subtitle, "mov_text") == 0 ? "srt"
                                                                   : "copy");
        if (v->n_files) {
            add_two_arguments(w, "-map", "1:t?");
            add_two_arguments(w, "-c:t", "copy");
        }
    } else if (v->subtitles == SUBTITLES_TEXT && (is_mov || is_webm)) {
        add_two_arguments(w, "-map", "1:s?");
        add_two_arguments(w, "-c:s", is_webm ? "webvtt" : "mov_text");
    }
}

/* Adds arguments that copy sound, subtitles, chapters and tags of the second
 * input, which is the original video. TIMECODE is memory for one argument. */
static void add_other_streams(struct words *w, const struct ffmpeg_target *t,
                              const struct ffmpeg_video *v,
                              char timecode[FFMPEG_REPORT])
{
    const char *const ext = find_file_extension(t->name);

    add_two_arguments(w, "-map", "1:a?");
    add_subtitle_arguments(w, ext, v);
    add_two_arguments(w, "-map_metadata", "1");
    add_two_arguments(w, "-map_chapters", "1");
    snprintf(timecode, FFMPEG_REPORT, "timecode=%s", v->timecode);
    if (*v->timecode)
        add_two_arguments(w, "-metadata:s:v:0", timecode);
    /* Without this flag, tags of phones such as the location are dropped. */
    if (is_word_in_list(ext, of_mov) && strstr(v->tags, " com."))
        add_two_arguments(w, "-movflags", "use_metadata_tags");
    if (can_hold_sound_codec(ext, v->sound))
        add_two_arguments(w, "-c:a", "copy");
    else if (*v->sound && !t->quiet)
        fprintf(stderr,
                "glint overlay: %s: the sound is re-encoded, as .%s cannot "
                "hold %s\n",
                t->name, ext, v->sound);
}

/* Adds the range of T and the matrix, transfer and primaries of V. If input and
 * output have the same ones, ffmpeg does not convert colours. */
static void add_colour_tags(struct words *w, const struct ffmpeg_target *t,
                            const struct ffmpeg_video *v)
{
    add_two_arguments(w, "-color_range",
                      t->range == GLINT_RANGE_FULL ? "pc" : "tv");
    if (*v->space && strcmp(v->space, "gbr") != 0 &&
        strcmp(v->space, "rgb") != 0)
        add_two_arguments(w, "-colorspace", v->space);
    if (*v->transfer)
        add_two_arguments(w, "-color_trc", v->transfer);
    if (*v->primaries)
        add_two_arguments(w, "-color_primaries", v->primaries);
}

/* Returns the filter that pads an odd width or height by one pixel. Returns
 * NULL if both are even, or if the output is 4:4:4 and the input not RGB. */
static const char *find_padding_filter(const struct ffmpeg_target *t,
                                       const struct ffmpeg_video *v)
{
    const bool x = t->width % 2, y = t->height % 2;

    if ((!x && !y) || (t->is_444 && !is_pixel_format_rgb(v->pixels)))
        return NULL;
    return x && y ? "pad=iw+1:ih+1,fillborders=right=1:bottom=1:mode=smear"
           : x    ? "pad=iw+1:ih,fillborders=right=1:mode=smear"
                  : "pad=iw:ih+1,fillborders=bottom=1:mode=smear";
}

/* Adds the encoder options of H.264 files, and prints a note if the size will
 * be padded by find_padding_filter().
 *
 * ffmpeg's .mov writer labels 10-bit H.264 in the sizes of AVC-Intra (4:2:2 of
 * 1280x720 and 1920x1080, 4:2:0 of 960x720 and 1440x1080) as AVC-Intra and
 * omits the decoder parameters, so that no program can decode the file. With
 * the label avc1 ffmpeg writes the parameters, but in these sizes it accepts
 * this label only with -strict -1. */
static void add_h264_options(struct words *w, const struct ffmpeg_target *t,
                             const struct ffmpeg_video *v)
{
    static const char *const by_default[] = {"mp4", "m4v", "mkv", NULL};
    const char *ext = find_file_extension(t->name);

    if (!is_word_in_list(ext, by_default))
        add_two_arguments(w, "-c:v", "libx264");
    add_two_arguments(w, "-crf", "18");
    if (strcasecmp(ext, "mov") == 0) {
        add_two_arguments(w, "-tag:v", "avc1");
        add_two_arguments(w, "-strict", "-1");
    }
    if (is_pixel_format_rgb(v->pixels))
        add_two_arguments(
            w, "-pix_fmt",
            find_pixel_format("420", get_pixel_format_bits(v->pixels)));
    if (find_padding_filter(t, v) && !t->quiet)
        fprintf(
            stderr,
            "glint overlay: %s: padded to %dx%d, as H.264 needs even sides\n",
            t->name, t->width + t->width % 2, t->height + t->height % 2);
}

/* An encoder, and the codecs and file types for which it is used */
struct family {
    const char *codec;
    /* extensions of supported output files, each after a blank */
    const char *types;
    const char *encoder;
    const char *options; /* ffmpeg arguments, separated by blanks */
    const char *alpha;   /* pixel format with alpha, or NULL */
};

static const struct family families[] = {
    {"hevc", " mp4 m4v mov mkv ts mts m2ts", "libx265", "-crf 20", NULL},
    {"prores", " mov mkv mxf", "prores_ks", "", "yuva444p10le"},
    {"vp9", " webm mkv mp4", "libvpx-vp9",
     "-crf 24 -b:v 0 -row-mt 1 -cpu-used 4", "yuva420p"},
    {"vp8", " webm mkv", "libvpx", "-crf 10 -b:v 20M -cpu-used 4", NULL},
    {"av1", " mp4 mkv webm", "libsvtav1", "-crf 24 -preset 8", NULL},
    {"ffv1", " mkv avi", "ffv1", "-level 3", "yuva444p10le"},
    {"dvvideo", " avi mov mkv", "dvvideo", "", NULL},
    {"mpeg2video", " mpg mpeg ts mxf mkv mov", "mpeg2video", "-q:v 2", NULL},
    {"mjpeg", " avi mov mkv", "mjpeg", "-q:v 2", NULL}};

static bool is_transfer_hdr(const struct ffmpeg_video *v)
{
    return strcmp(v->transfer, "smpte2084") == 0 ||
           strcmp(v->transfer, "arib-std-b67") == 0;
}

static bool is_encoder_installed(const char *encoder)
{
    const char *const argv[] = {"ffmpeg", "-hide_banner", "-v",
                                "error",  "-encoders",    NULL};
    char text[PROBE_BYTES], word[FFMPEG_WORD];
    struct glint_error error;
    struct child child;

    if (start_ffmpeg_child(&child, argv, CHILD_WRITES, NULL, &error) !=
        GLINT_OK)
        return false;
    read_child_output(&child, text);
    child_wait_for_exit(&child);
    snprintf(word, sizeof word, " %s ", encoder);
    return strstr(text, word) != NULL;
}

/* Returns the encoder for a file of T's type: that of V's codec, or else HEVC
 * for HDR video. Returns NULL, which means the default encoder of the type, if
 * there is none or ffmpeg lacks it. */
static const struct family *choose_encoder_family(const struct ffmpeg_target *t,
                                                  const struct ffmpeg_video *v)
{
    const struct family *found = NULL;
    char type[FFMPEG_WORD];

    snprintf(type, sizeof type, " %s", find_file_extension(t->name));
    for (size_t i = sizeof families / sizeof *families; i-- > 0;) {
        const struct family *const f = &families[i];
        const char *const at = strcasestr(f->types, type);
        const bool takes = at && (at[strlen(type)] == ' ' || !at[strlen(type)]);
        const bool is_own = strcmp(f->codec, v->codec) == 0;

        if (takes && (is_own || (i == 0 && is_transfer_hdr(v) && !found)))
            found = f;
    }
    return found && is_encoder_installed(found->encoder) ? found : NULL;
}

/* Returns the name of V's profile for the encoder prores_ks. For an unknown
 * profile this is "4444" if chroma is not subsampled, else "hq". */
static const char *find_prores_profile(const struct ffmpeg_video *v)
{
    static const char *const names[][2] = {
        {"Proxy", "proxy"},   {"LT", "lt"},     {"Standard", "standard"},
        {"HQ", "hq"},         {"4444", "4444"}, {"XQ", "4444xq"},
        {"4444 XQ", "4444xq"}};

    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(names[i][0], v->profile) == 0)
            return names[i][1];
    return strcmp(get_pixel_format_chroma(v->pixels), "444") == 0 ? "4444"
                                                                  : "hq";
}

static bool is_video_interlaced(const struct ffmpeg_video *v)
{
    static const char *const orders[] = {"tt", "bb", "tb", "bt", NULL};

    return is_word_in_list(v->fields, orders);
}

static void add_interlace_flags(struct words *w, const struct ffmpeg_video *v)
{
    if (is_video_interlaced(v))
        add_two_arguments(w, "-flags", "+ildct+ilme");
}

/* Splits OPTIONS at blanks, in place, and adds each word as an argument. */
static void add_option_words(struct words *w, char *options)
{
    char *word, *rest = options;

    while ((word = strtok_r(rest, " ", &rest)))
        add_argument(w, word);
}

/* Adds the options of encoder F; TEXT is memory for their words. */
static void add_encoder_family(struct words *w, const struct ffmpeg_target *t,
                               const struct ffmpeg_video *v,
                               const struct family *f, char text[FFMPEG_REPORT])
{
    const bool is_hevc = strcmp(f->encoder, "libx265") == 0;

    add_two_arguments(w, "-c:v", f->encoder);
    if (strcmp(f->encoder, "prores_ks") == 0)
        add_two_arguments(w, "-profile:v", find_prores_profile(v));
    if (is_hevc && is_word_in_list(find_file_extension(t->name), of_mov))
        add_two_arguments(w, "-tag:v", "hvc1");
    snprintf(text, FFMPEG_REPORT, "%s%s%s%s%s%s", f->options,
             is_hevc ? " -x265-params log-level=error:repeat-headers=1" : "",
             is_hevc && *v->mastering ? ":hdr10=1:master-display=" : "",
             is_hevc ? v->mastering : "",
             is_hevc && *v->light ? ":max-cll=" : "", is_hevc ? v->light : "");
    add_option_words(w, text);
    add_interlace_flags(w, v);
}

static void add_picture_options(struct words *w, const struct ffmpeg_target *t,
                                const struct ffmpeg_video *v,
                                const struct family *f,
                                char text[FFMPEG_REPORT], const char **pad)
{
    static const char *const h264[] = {"mp4", "m4v", "mkv",  "mov", "flv",
                                       "ts",  "mts", "m2ts", "3gp", NULL};
    static const char *const with_fields[] = {"mpg", "mpeg", "mxf", "avi",
                                              NULL};
    const char *ext = find_file_extension(t->name);

    if (strcasecmp(ext, "gif") == 0) {
        add_two_arguments(w, "-filter_complex",
                          "[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse");
    } else if (f) {
        add_encoder_family(w, t, v, f, text);
        *pad = strcmp(f->encoder, "libx265") == 0 ? find_padding_filter(t, v)
                                                  : NULL;
    } else if (strcasecmp(ext, "webm") == 0) {
        add_two_arguments(w, "-crf", "24");
        add_two_arguments(w, "-b:v", "0");
        add_two_arguments(w, "-row-mt", "1");
        add_two_arguments(w, "-cpu-used", "4");
    } else if (is_word_in_list(ext, h264)) {
        add_h264_options(w, t, v);
        *pad = find_padding_filter(t, v);
        add_interlace_flags(w, v);
    } else {
        /* Neither MPEG-1 nor the codecs of .ogv and .wmv support
         * interlacing. */
        if (is_video_interlaced(v) && strncasecmp(ext, "mp", 2) == 0)
            add_two_arguments(w, "-c:v", "mpeg2video");
        add_two_arguments(w, "-q:v", "2");
        if (is_word_in_list(ext, with_fields))
            add_interlace_flags(w, v);
    }
}

/* Adds a filter that copies the alpha of the second input to the pictures, in
 * pixel format FORMAT. TEXT is memory for the filter. */
static void add_alpha_filter(struct words *w, const char *format,
                             char text[FFMPEG_REPORT])
{
    const char *const opaque =
        strcmp(format, "yuva420p") == 0 ? "yuv420p" : "yuv444p10le";

    snprintf(text, FFMPEG_REPORT,
             "[1:v:0]format=%s,extractplanes=a,setpts=PTS-STARTPTS[a];"
             "[0:v]format=%s,setpts=PTS-STARTPTS[v];"
             "[v][a]mergeplanes=0x00010210:%s[o]",
             format, opaque, format);
    add_two_arguments(w, "-filter_complex", text);
    add_two_arguments(w, "-map", "[o]");
}

enum glint_status ffmpeg_start_writer(struct child *child,
                                      const struct ffmpeg_target *target,
                                      const struct ffmpeg_video *video,
                                      struct glint_error *error)
{
    const struct ffmpeg_target *t = target;
    const struct family *f;
    const char *pad = NULL;
    char out[FFMPEG_URL], sound[FFMPEG_URL] = "", options[1024];
    char text[FFMPEG_REPORT], alpha[FFMPEG_REPORT], timecode[FFMPEG_REPORT];
    char script[FFMPEG_WORD + 16];
    int script_fd = -1;
    enum glint_status status;
    struct words w;

    *child = CHILD_NONE;
    if (!set_file_url(out, t->file) ||
        (t->sound && !set_file_url(sound, t->sound)) ||
        (t->options && strlen(t->options) >= sizeof options))
        return report_too_long_file_name(t->name, error);
    begin_ffmpeg_argument_list(&w);
    add_argument(&w, "-y");
    add_two_arguments(&w, "-f", "yuv4mpegpipe");
    add_colour_tags(&w, t, video);
    add_two_arguments(&w, "-i", "-");
    f = t->options ? NULL : choose_encoder_family(t, video);
    if (t->sound)
        add_two_arguments(&w, "-i", sound);
    if (t->sound && !t->times && f && f->alpha &&
        has_pixel_format_alpha(video->pixels))
        add_alpha_filter(&w, f->alpha, alpha);
    else if (t->sound)
        add_two_arguments(&w, "-map", "0:v:0");
    if (t->sound)
        add_other_streams(&w, t, video, timecode);
    add_colour_tags(&w, t, video);
    if (t->options) {
        snprintf(options, sizeof options, "%s", t->options);
        add_option_words(&w, options);
    } else
        add_picture_options(&w, t, video, f, text, &pad);
    if (t->times)
        script_fd = write_filter_script(t->times, pad, script);
    if (script_fd >= 0) {
        add_two_arguments(&w, "-filter_script:v", script);
        add_two_arguments(&w, "-fps_mode", "vfr");
        add_two_arguments(&w, "-enc_time_base", "1/90000");
    } else if (pad)
        add_two_arguments(&w, "-vf", pad);
    add_argument(&w, out);
    status = end_ffmpeg_arguments(&w, error);
    if (status == GLINT_OK)
        status = start_ffmpeg_child(child, w.word, CHILD_READS, NULL, error);
    if (status == GLINT_OK)
        child->script = script_fd;
    else if (script_fd >= 0)
        close(script_fd);
    return status;
}

void ffmpeg_print_manual_commands(const struct tool *tool, const char *in,
                                  const char *out)
{
    const bool coded = ffmpeg_is_video(in);

    fprintf(stderr,
            "glint %s: videos other than .y4m need ffmpeg, which is not "
            "installed (apt-get install ffmpeg). On a machine with ffmpeg:\n"
            "  ",
            tool->name);
    if (coded)
        fprintf(stderr, "ffmpeg -i '%s' -f yuv4mpegpipe -strict -1 - | ", in);
    fprintf(stderr, "glint overlay %s -o %s", coded ? "-" : in,
            ffmpeg_is_video(out) ? "-" : out);
    if (ffmpeg_is_video(out))
        fprintf(stderr, " | ffmpeg -i -%s%s%s '%s'", coded ? " -i '" : "",
                coded ? in : "", coded ? "' -map 0:v -map 1:a? -c:a copy" : "",
                out);
    fputc('\n', stderr);
}

enum { LINE = 512, CAUSE = 48 };

/* Frames to decode: the first one, those of the last second, or all */
enum piece { FIRST, LAST, ALL };

/* Sets CAUSE to LINE, a message of ffmpeg, without its prefix such as "[h264 @
 * 0x55d0] " or "URL: ". */
static void set_ffmpeg_cause(char cause[CAUSE], const char *line,
                             const char *url)
{
    const char *const context = *line == '[' ? strstr(line, "] ") : NULL;
    const size_t n = strlen(url);

    if (context)
        line = context + 2;
    else if (strncmp(line, url, n) == 0 && line[n] == ':')
        line += n + 1 + (line[n + 1] == ' ');
    snprintf(cause, CAUSE, "%.*s", (int)strcspn(line, "\r\n"), line);
}

/* Reads from FROM what ffmpeg prints: a line that begins with a digit for each
 * frame, lines that begin with '#', and messages. Sets CAUSE to the first
 * message. Returns the number of frames, or 0 if a message reports a truncated
 * file. */
static long count_printed_frames(FILE *from, const char *url, char cause[CAUSE])
{
    char line[LINE];
    bool is_cut = false;
    long n = 0;

    while (fgets(line, sizeof line, from)) {
        n += isdigit((unsigned char)*line) != 0;
        if (!*cause && *line != '#' && !isdigit((unsigned char)*line))
            set_ffmpeg_cause(cause, line, url);
        for (int i = 0; ffmpeg_cut_words[i]; i++)
            is_cut |= strstr(line, ffmpeg_cut_words[i]) != NULL;
    }
    return is_cut ? 0 : n;
}

/* Decodes PIECE of URL. Returns false with the reason in CAUSE if decoding
 * fails or yields no frame. */
static bool decode_video_piece(const char *url, enum piece piece,
                               char cause[CAUSE])
{
    /* Decoding starts at the key frame before the last second. Only with the
     * time stamps of the file (-copyts) are these frames in the output. */
    static const char *const from_end[] = {"-copyts", "-noaccurate_seek",
                                           "-sseof", "-1", NULL};
    const char *argv[24] = {"ffmpeg", "-nostdin", "-hide_banner", "-loglevel",
                            "error",  "-xerror",  "-err_detect",  "explode"};
    const char *const rest[] = {
        "-i", url,        "-map",      "0:v:0",
        "-f", "framecrc", "-frames:v", piece == FIRST ? "1" : "999999999",
        "-",  NULL};
    struct glint_error error;
    struct child child;
    FILE *from;
    long n = 0;
    int k = 8;

    for (int i = 0; piece == LAST && from_end[i]; i++)
        argv[k++] = from_end[i];
    for (int i = 0; rest[i]; i++)
        argv[k++] = rest[i];
    *cause = '\0';
    if (start_ffmpeg_child(&child, argv, CHILD_PRINTS, NULL, &error) !=
        GLINT_OK) {
        snprintf(cause, CAUSE, "%.*s", CAUSE - 1, error.text);
        return false;
    }
    from = fdopen(child.fd, "r");
    if (from) {
        n = count_printed_frames(from, url, cause);
        fclose(from);
        child.fd = -1;
    }
    if (child_wait_for_exit(&child) == 0 && n > 0)
        return true;
    if (!*cause)
        snprintf(cause, CAUSE, "ffmpeg decodes no frame");
    return false;
}

enum glint_status ffmpeg_check_output(const char *file, const char *name,
                                      struct glint_error *error)
{
    char url[FFMPEG_URL], cause[CAUSE];
    bool has_first;

    if (!set_file_url(url, file))
        return glint_error_report(error, GLINT_E_OUTPUT, name,
                                  "the file name is too long for ffmpeg");
    has_first = decode_video_piece(url, FIRST, cause);
    /* ffmpeg cannot seek from the end of a file without an index, such as .ts.
     * Then all frames are decoded. */
    if (has_first && (decode_video_piece(url, LAST, cause) ||
                      decode_video_piece(url, ALL, cause)))
        return GLINT_OK;
    return glint_error_report(
        error, GLINT_E_OUTPUT, name,
        "the %s frame does not decode (%s); choose another encoder "
        "(--encode) or type of file",
        has_first ? "last" : "first", cause);
}

/* Text of a report of lost properties: ", no alpha, ..." */
struct report {
    char text[FFMPEG_TAGS];
    size_t n;
};

__attribute__((format(printf, 2, 3))) static void note(struct report *report,
                                                       const char *format, ...)
{
    const size_t room = sizeof report->text - report->n;
    va_list args;
    int n;

    va_start(args, format);
    n = vsnprintf(report->text + report->n, room, format, args);
    va_end(args);
    if (n > 0 && (size_t)n < room)
        report->n += (size_t)n;
}

/* Adds to the report that the output has only MADE of the input's FROM streams
 * of type KIND. */
static void note_lost_streams(struct report *r, const char *kind, int from,
                              int made)
{
    if (made < from)
        note(r, ", %d of %d %s", made, from, kind);
}

/* Adds to the report each tag in FROM, the names of the input's tags, that is
 * missing in MADE, the names of the output's tags. Ignores case, and tags that
 * belong to the file type. */
static void note_lost_tags(struct report *r, const char *from, const char *made)
{
    static const char *const own[] = {"major_brand",
                                      "minor_version",
                                      "compatible_brands",
                                      "encoder",
                                      "timecode",
                                      "variant_version",
                                      "vendor_id",
                                      "duration",
                                      "handler_name",
                                      "software_version",
                                      NULL};
    char all[FFMPEG_TAGS], has[FFMPEG_TAGS + 2], name[FFMPEG_TAGS + 2];
    char *word, *rest = all;

    snprintf(all, sizeof all, "%s", from);
    snprintf(has, sizeof has, "%s ", made);
    while ((word = strtok_r(rest, " ", &rest))) {
        snprintf(name, sizeof name, " %s ", word);
        if (!is_word_in_list(word, own) && !strcasestr(has, name))
            note(r, ", no tag %s", word);
    }
}

static void note_pixel_losses(struct report *r, const char *made,
                              const char *from)
{
    if (get_pixel_format_bits(made) < get_pixel_format_bits(from))
        note(r, ", %d bits in place of %d", get_pixel_format_bits(made),
             get_pixel_format_bits(from));
    if (strcmp(get_pixel_format_chroma(from), "gray") != 0 &&
        strcmp(get_pixel_format_chroma(made), "444") != 0 &&
        strcmp(get_pixel_format_chroma(made), get_pixel_format_chroma(from)) !=
            0)
        note(r, ", chroma %s in place of %s", get_pixel_format_chroma(made),
             is_pixel_format_rgb(from) ? "RGB" : get_pixel_format_chroma(from));
    if (has_pixel_format_alpha(from) && !has_pixel_format_alpha(made))
        note(r, ", no alpha");
}

void ffmpeg_report_losses(const char *file, const char *name,
                          const struct ffmpeg_video *video)
{
    const struct ffmpeg_video *const v = video;
    struct report r = {"", 0};
    struct ffmpeg_video made;

    ffmpeg_probe_video(&made, file);
    if (!*made.pixels || !*v->pixels)
        return;
    note_pixel_losses(&r, made.pixels, v->pixels);
    if (is_transfer_hdr(v) && strcmp(v->transfer, made.transfer) != 0)
        note(&r, ", no tag for its transfer %s", v->transfer);
    if (is_video_interlaced(v) && !is_video_interlaced(&made))
        note(&r, ", no interlacing flags (%s)", v->fields);
    if (*v->timecode && !*made.timecode)
        note(&r, ", no time code");
    if (*v->mastering && !*made.mastering)
        note(&r, ", no mastering data");
    if (v->has_dolby)
        note(&r, ", no Dolby Vision");
    note_lost_streams(&r, "streams of pictures", v->n_pictures,
                      made.n_pictures);
    note_lost_streams(&r, "streams of sound", v->n_sounds, made.n_sounds);
    note_lost_streams(&r, "streams of subtitles", v->n_subtitles,
                      made.n_subtitles);
    note_lost_streams(&r, "streams of data", v->n_data, made.n_data);
    note_lost_streams(&r, "attached files", v->n_files, made.n_files);
    note_lost_streams(&r, "chapters", v->n_chapters, made.n_chapters);
    note_lost_tags(&r, v->tags, made.tags);
    if (*r.text)
        fprintf(stderr,
                "glint overlay: %s: the output has %s; see --encode for "
                "encoders that preserve more\n",
                name, r.text + 2);
}
