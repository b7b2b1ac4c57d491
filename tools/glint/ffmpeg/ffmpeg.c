/* SPDX-License-Identifier: MIT
 *
 * What an encoder has written: whether it decodes, and which properties of the
 * input it lacks.
 */
#define _GNU_SOURCE /* pipe2, memfd_create, fallocate */
#include "ffmpeg/ffmpeg.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/at_death.h"
#include "posix/error.h"
#include "posix/input.h"

static bool has_one_of(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (strstr(text, *words))
            return true;
    return false;
}

/* Returns the bits of a sample of PIXELS: 8, 10, 12 or 16. */
static int pixels_bits(const char *pixels)
{
    static const char *const of_8[] = {"nv12", "nv16", "yuv410p", NULL};
    static const char *const of_16[] = {"16", "14", "48", "64", "f32", NULL};
    static const char *const of_10[] = {"10", "p9", NULL};

    return has_one_of(pixels, of_8)    ? 8
           : has_one_of(pixels, of_16) ? 16
           : strstr(pixels, "12")      ? 12
           : has_one_of(pixels, of_10) ? 10
                                       : 8;
}

static bool pixels_are_rgb(const char *pixels)
{
    static const char *const rgb[] = {"rgb", "bgr",  "gbr", "argb",
                                      "xyz", "pal8", NULL};

    return has_one_of(pixels, rgb);
}

static bool pixels_have_alpha(const char *pixels)
{
    static const char *const alpha[] = {"yuva", "ayuv", "vuya", "rgba",
                                        "bgra", "argb", "abgr", "gbrap",
                                        "ya8",  "ya16", NULL};

    return has_one_of(pixels, alpha);
}

/* Returns the chroma of PIXELS: "444" also of RGB, "422", "440", "420", "411",
 * "410", or "gray" for none. */
static const char *pixels_chroma(const char *pixels)
{
    static const char *const of_444[] = {"444",  "nv24", "nv42", "p410", "p416",
                                         "ayuv", "vuy",  "xv",   NULL};
    static const char *const of_422[] = {"422",  "nv16", "nv20", "p210",
                                         "p216", "y210", "y212", NULL};
    static const char *const rare[] = {"410", "411", "440", NULL};

    if (strncmp(pixels, "gray", 4) == 0 || strncmp(pixels, "mono", 4) == 0 ||
        strncmp(pixels, "ya", 2) == 0)
        return "gray";
    if (pixels_are_rgb(pixels) || has_one_of(pixels, of_444))
        return "444";
    if (has_one_of(pixels, of_422))
        return "422";
    for (int i = 0; rare[i]; i++)
        if (strstr(pixels, rare[i]))
            return rare[i];
    return "420";
}

const char *pixels_named(const char *chroma, int bits)
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

/* Returns the y4m format that keeps all samples of PIXELS but alpha, of chroma
 * that has no such format the nearest. */
static const char *pixels_of_y4m(const char *pixels)
{
    const char *const chroma = pixels_chroma(pixels);

    if (strncmp(pixels, "yuvj", 4) == 0) /* full range, too */
        return strcmp(chroma, "444") == 0   ? "yuvj444p"
               : strcmp(chroma, "422") == 0 ? "yuvj422p"
                                            : "yuvj420p";
    return pixels_named(chroma, pixels_bits(pixels));
}

enum { MAX_CHILDREN = 4, NOT_FOUND = 127 };

/* processes to kill at death; atomic, 0: free */
static pid_t running[MAX_CHILDREN];

static void kill_all(void)
{
    const int saved = errno;

    for (int i = 0; i < MAX_CHILDREN; i++) {
        const pid_t pid = __atomic_load_n(&running[i], __ATOMIC_SEQ_CST);

        if (pid > 0)
            kill(pid, SIGKILL);
    }
    errno = saved;
}

static void replace(pid_t old, pid_t fresh)
{
    for (int i = 0; i < MAX_CHILDREN; i++) {
        pid_t expected = old;

        if (__atomic_compare_exchange_n(&running[i], &expected, fresh, 0,
                                        __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
            return;
    }
}

bool child_exists(const char *name)
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

/* Runs ARGV in the child, with IN, OUT and SAID, unless that is -1, as its
 * streams. If it cannot be run, sends errno through FAILED. Makes system calls
 * only. */
static void become(const char *const *argv, int in, int out, int said,
                   int failed)
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

/* Returns the errno that kept the child from running, or 0. */
static int read_failure(int fd)
{
    int number = 0;
    ssize_t n;

    do
        n = read(fd, &number, sizeof number);
    while (n < 0 && errno == EINTR);
    return n == (ssize_t)sizeof number ? number : 0;
}

/* Opens two pipes, DATA and FAILED, whose ends are closed by exec. */
static bool open_pipes(int data[2], int failed[2])
{
    if (pipe2(data, O_CLOEXEC) < 0)
        return false;
    if (pipe2(failed, O_CLOEXEC) == 0)
        return true;
    close(data[0]);
    close(data[1]);
    return false;
}

static enum glint_status refuse(const char *name, int number,
                                struct glint_error *error)
{
    return glint_error_report(
        error, number == ENOENT ? GLINT_E_UNSUPPORTED : GLINT_E_IO, name, "%s",
        number == ENOENT ? "is not installed" : strerror(number));
}

static enum glint_status start(struct child *child, const char *const *argv,
                               enum child_pipe kind, struct glint_error *error)
{
    const int mine = kind == CHILD_READS ? 1 : 0;
    int data[2], failed[2], number;
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);

    glint_at_death(kill_all);
    if (null < 0 || !open_pipes(data, failed)) {
        number = errno;
        if (null >= 0)
            close(null);
        return refuse(argv[0], number, error);
    }
    child->pid = fork();
    if (child->pid == 0)
        become(argv, mine == 0 ? null : data[0], mine == 0 ? data[1] : null,
               kind == CHILD_PRINTS ? data[1] : child->said, failed[1]);
    number = errno;
    close(null);
    close(data[1 - mine]);
    close(failed[1]);
    if (child->pid > 0) {
        replace(0, child->pid);
        number = read_failure(failed[0]);
    }
    close(failed[0]);
    child->fd = data[mine];
    if (child->pid > 0 && number == 0)
        return GLINT_OK;
    if (child->pid < 0)
        child->pid = 0;
    child_end(child);
    return refuse(argv[0], number, error);
}

/* Starts ARGV[0] of $PATH with ARGV, which ends with NULL. GLINT_E_UNSUPPORTED:
 * it is not there. GLINT_E_IO: the system gives no process or descriptor. */
static enum glint_status start_child(struct child *child,
                                     const char *const *argv,
                                     enum child_pipe kind,
                                     struct glint_error *error)
{
    *child = CHILD_NONE;
    return start(child, argv, kind, error);
}

/* Like start_child(), of a child that WORDS, which end with NULL, are listened
 * for in what it says; child_hear() passes that on. */
static enum glint_status
start_heard(struct child *child, const char *const *argv, enum child_pipe kind,
            const char *const *words, struct glint_error *error)
{
    enum glint_status status;

    *child = CHILD_NONE;
    child->listening = words;
    /* A file, not a pipe: nobody has to read it for the child to go on. */
    child->said = memfd_create("said", MFD_CLOEXEC);
    if (child->said >= 0)
        fcntl(child->said, F_SETFL, O_APPEND);
    status = start(child, argv, kind, error);
    if (status != GLINT_OK)
        child_kill(child);
    return status;
}

/* ------------------------------------------------------------------ hearing */

/* Passes on whole lines, or if ALL what is left. */
static void pass_on(struct child *child, bool all)
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
        /* Its memory is given back; where that cannot be, it stays. */
        (void)fallocate(child->said, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                        0, child->told);
    }
}

void child_hear(struct child *child)
{
    pass_on(child, false);
}

static void end_hearing(struct child *child)
{
    pass_on(child, true);
    if (child->said >= 0)
        close(child->said);
    child->said = -1;
}

/* ------------------------------------------------------------------- ending */

int child_end(struct child *child)
{
    int status = 0;
    pid_t pid;

    if (child->fd >= 0)
        close(child->fd);
    child->fd = -1;
    if (child->pid <= 0) {
        end_hearing(child);
        return 0;
    }
    do
        pid = waitpid(child->pid, &status, 0);
    while (pid < 0 && errno == EINTR);
    replace(child->pid, 0);
    child->pid = 0;
    end_hearing(child);
    if (pid < 0)
        return NOT_FOUND;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void child_kill(struct child *child)
{
    if (child->pid > 0)
        kill(child->pid, SIGKILL);
    child_end(child);
}

enum { MAX_WORDS = 96, PROBE_BYTES = 1 << 14 };

static const char *extension(const char *name)
{
    const char *dot = strrchr(name, '.');

    return dot && !strchr(dot, '/') ? dot + 1 : "";
}

static bool is_one_of(const char *word, const char *const *words)
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

    return is_one_of(extension(name), extensions);
}

/* Sets URL to "file:NAME", which ffmpeg opens as a file whatever NAME looks
 * like. Returns false if it is too long. */
static bool set_url(char url[FFMPEG_URL], const char *name)
{
    return (size_t)snprintf(url, FFMPEG_URL, "file:%s", name) < FFMPEG_URL;
}

/* The containers that an input may have, whatever its name. They refer to no
 * other file, unlike playlists (HLS, concat, DASH), and nothing but files is
 * opened for them. */
#define CONTAINERS                                                  \
    "mov,matroska,avi,mpeg,mpegvideo,mpegts,m4v,h264,hevc,asf,flv," \
    "ogg,mxf,mxf_opatom"
static const char *const input_limits[] = {"-format_whitelist", CONTAINERS,
                                           "-protocol_whitelist", "file", NULL};

/* -------------------------------------------------------------------- probe */

/* Sets WORD by LINE, "NAME=value", unless WORD is set already or the value is
 * unknown. */
static void take_word(const char *line, const char *name, char *word)
{
    const size_t n = strlen(name);

    if (*word || strncmp(line, name, n) != 0 || line[n] != '=' ||
        strcmp(line + n + 1, "unknown") == 0 ||
        strcmp(line + n + 1, "N/A") == 0 ||
        strcmp(line + n + 1, "reserved") == 0)
        return;
    snprintf(word, FFMPEG_WORD, "%s", line + n + 1);
}

static void take_line(struct ffmpeg_video *v, const char *line)
{
    char width[FFMPEG_WORD] = "", height[FFMPEG_WORD] = "";

    take_word(line, "pix_fmt", v->pixels);
    take_word(line, "color_range", v->range);
    take_word(line, "color_space", v->space);
    take_word(line, "color_transfer", v->transfer);
    take_word(line, "color_primaries", v->primaries);
    take_word(line, "width", width);
    take_word(line, "height", height);
    if (*width)
        tool_integer(width, 1, GLINT_MAX_SIDE, &v->width);
    if (*height)
        tool_integer(height, 1, GLINT_MAX_SIDE, &v->height);
}

/* Reads what CHILD prints into TEXT, as a string, up to PROBE_BYTES. */
static void read_all(struct child *child, char text[PROBE_BYTES])
{
    size_t used = 0;
    ssize_t n;

    while (used < PROBE_BYTES - 1 &&
           ((n = read(child->fd, text + used, PROBE_BYTES - 1 - used)) > 0 ||
            (n < 0 && errno == EINTR)))
        used += n > 0 ? (size_t)n : 0;
    text[used] = '\0';
}

/* Sets TEXT to the lines that ffprobe prints on ENTRIES of the streams KIND of
 * URL, with OPTION unless that is NULL. Returns false if it fails; TEXT is ""
 * if it cannot be run. */
static bool ask(const char *url, const char *kind, const char *entries,
                const char *option, char text[PROBE_BYTES])
{
    const char *const argv[] = {"ffprobe",
                                "-v",
                                "quiet",
                                "-select_streams",
                                kind,
                                "-show_entries",
                                entries,
                                "-of",
                                "default=nw=1",
                                input_limits[0],
                                input_limits[1],
                                input_limits[2],
                                input_limits[3],
                                url,
                                option,
                                NULL};
    struct glint_error error;
    struct child child;

    *text = '\0';
    if (start_child(&child, argv, CHILD_WRITES, &error) != GLINT_OK)
        return false;
    read_all(&child, text);
    return child_end(&child) == 0;
}

void ffmpeg_probe(struct ffmpeg_video *video, const char *name)
{
    char url[FFMPEG_URL], text[PROBE_BYTES], *line, *rest = text;

    *video = (struct ffmpeg_video){.width = 0};
    if (!set_url(url, name))
        return;
    ask(url, "v:0",
        "stream=width,height,pix_fmt,color_range,color_space,color_transfer,"
        "color_primaries",
        NULL, text);
    while ((line = strtok_r(rest, "\r\n", &rest)))
        take_line(video, line);
    rest = text;
    ask(url, "a:0", "stream=codec_name", NULL, text);
    while ((line = strtok_r(rest, "\r\n", &rest)))
        take_word(line, "codec_name", video->sound);
}

long ffmpeg_count_frames(const char *name)
{
    char url[FFMPEG_URL], text[PROBE_BYTES], n[FFMPEG_WORD] = "";
    struct glint_error error;
    struct glint_input file;

    if (glint_input_open_file(&file, name, &error) != GLINT_OK)
        return 0;
    glint_input_close(&file);
    if (!set_url(url, name) ||
        !ask(url, "v:0", "stream=nb_read_packets", "-count_packets", text))
        return 0;
    text[strcspn(text, "\r\n")] = '\0';
    take_word(text, "nb_read_packets", n);
    return strtol(n, NULL, 10);
}

/* Adds KIND and TAG to REPORT, ", KIND TAG", if they are unknown. */
static int note_tag(int value, const char *kind, const char *tag,
                    char report[FFMPEG_REPORT])
{
    const size_t n = strlen(report);

    if (value < 0 && *tag)
        snprintf(report + n, FFMPEG_REPORT - n, ", %s %s", kind, tag);
    return value;
}

void ffmpeg_colours(const struct ffmpeg_video *video,
                    struct glint_y4m_header *header, char report[FFMPEG_REPORT])
{
    static const char *const sd[] = {"smpte170m", "bt470bg", "fcc", NULL};
    static const char *const rgb[] = {"gbr", "rgb", NULL};
    const char *const space = video->space;
    const int matrix = is_one_of(space, sd)             ? GLINT_MATRIX_BT601
                       : strcmp(space, "bt709") == 0    ? GLINT_MATRIX_BT709
                       : strcmp(space, "bt2020nc") == 0 ? GLINT_MATRIX_BT2020
                                                        : -1;
    const int transfer = glint_transfer_of_tag(video->transfer);
    const int primaries = glint_primaries_of_tag(video->primaries);

    *report = '\0';
    if (!is_one_of(space, rgb))
        note_tag(matrix, "matrix", space, report);
    note_tag(transfer, "transfer", video->transfer, report);
    note_tag(primaries, "primaries", video->primaries, report);
    if (matrix >= 0)
        header->matrix = (enum glint_matrix)matrix;
    if (transfer >= 0)
        header->transfer = (enum glint_transfer_curve)transfer;
    if (primaries >= 0)
        header->primaries = (enum glint_primaries)primaries;
}

/* ------------------------------------------------------------------- words */

/* A command line as it grows. N also counts words that do not fit. */
struct words {
    const char *word[MAX_WORDS + 1];
    int n;
};

static void add(struct words *w, const char *word)
{
    if (w->n < MAX_WORDS)
        w->word[w->n] = word;
    w->n++;
}

static void add_two(struct words *w, const char *a, const char *b)
{
    add(w, a);
    add(w, b);
}

/* Adds the input URL. */
static void add_input(struct words *w, const char *url)
{
    for (int i = 0; input_limits[i]; i++)
        add(w, input_limits[i]);
    add_two(w, "-i", url);
}

static void begin(struct words *w)
{
    static const char *const first[] = {"ffmpeg",    "-nostdin", "-hide_banner",
                                        "-loglevel", "error",    NULL};

    w->n = 0;
    for (int i = 0; first[i]; i++)
        add(w, first[i]);
}

/* Ends the words of a line. */
static enum glint_status end(struct words *w, struct glint_error *error)
{
    if (w->n > MAX_WORDS)
        return glint_error_report(error, GLINT_E_ARGUMENT, "ffmpeg",
                                  "more than %d words of options", MAX_WORDS);
    w->word[w->n] = NULL;
    return GLINT_OK;
}

/* Messages of ffmpeg 5 on files that are cut off, at which it exits with 0;
 * ends with NULL. */
static const char *const ffmpeg_cut_words[] = {
    "File ended prematurely" /* .mkv, .webm */, "partial file" /* .mp4, .mov */,
    NULL};

static enum glint_status too_long(const char *name, struct glint_error *error)
{
    return glint_error_report(error, GLINT_E_UNSUPPORTED, name,
                              "the name is too long");
}

/* ---------------------------------------------------------------- decoding */

enum glint_status ffmpeg_read(struct child *child, const char *name,
                              const struct ffmpeg_video *video,
                              struct glint_error *error)
{
    char url[FFMPEG_URL];
    enum glint_status status;
    struct words w;

    *child = CHILD_NONE;
    if (!set_url(url, name))
        return too_long(name, error);
    begin(&w);
    add_input(&w, url);
    add_two(&w, "-map", "0:v:0");
    add_two(&w, "-pix_fmt", pixels_of_y4m(video->pixels));
    add_two(&w, "-strict", "-1");
    add_two(&w, "-f", "yuv4mpegpipe");
    add(&w, "-");
    status = end(&w, error);
    return status == GLINT_OK ? start_heard(child, w.word, CHILD_WRITES,
                                            ffmpeg_cut_words, error)
                              : status;
}

/* ---------------------------------------------------------------- encoding */

/* Returns whether a file of this extension takes sound of CODEC as it is. */
static bool takes_sound(const char *ext, const char *codec)
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
            return is_one_of(codec, table[i].codecs);
    return true; /* .mkv and .ts take nearly all */
}

static void add_sound(struct words *w, const struct ffmpeg_target *t,
                      const char *codec, const char *url)
{
    if (!t->sound)
        return;
    add_input(w, url);
    add_two(w, "-map", "0:v:0");
    add_two(w, "-map", "1:a?");
    add_two(w, "-map_metadata", "1");
    add_two(w, "-map_chapters", "1");
    if (takes_sound(extension(t->name), codec))
        add_two(w, "-c:a", "copy");
    else if (*codec && !t->quiet)
        fprintf(stderr,
                "glint overlay: %s: sound is encoded anew, as .%s does not "
                "take %s\n",
                t->name, extension(t->name), codec);
}

/* Adds the meaning of V's codes: range, matrix, transfer and primaries. It is
 * stated of the input and again of the output, so that ffmpeg converts
 * nothing. */
static void add_tags(struct words *w, const struct ffmpeg_target *t,
                     const struct ffmpeg_video *v)
{
    add_two(w, "-color_range", t->range == GLINT_RANGE_FULL ? "pc" : "tv");
    if (*v->space && strcmp(v->space, "gbr") != 0 &&
        strcmp(v->space, "rgb") != 0)
        add_two(w, "-colorspace", v->space);
    if (*v->transfer)
        add_two(w, "-color_trc", v->transfer);
    if (*v->primaries)
        add_two(w, "-color_primaries", v->primaries);
}

/* Adds the options of files whose pictures are H.264. Odd sides grow by one
 * where pixels share their chroma.
 *
 * ffmpeg's .mov writer labels H.264 of 10 bits in the sizes of AVC-Intra (4:2:2
 * of 1280x720 and 1920x1080, 4:2:0 of 960x720 and 1440x1080) as AVC-Intra,
 * which leaves the decoder's parameters out of the file: nothing decodes it.
 * The label avc1 has them, but is taken in these sizes with -strict -1 only. */
static void add_h264(struct words *w, const struct ffmpeg_target *t,
                     const struct ffmpeg_video *v)
{
    static const char *const by_default[] = {"mp4", "m4v", "mkv", NULL};
    const char *ext = extension(t->name);

    if (!is_one_of(ext, by_default))
        add_two(w, "-c:v", "libx264");
    add_two(w, "-crf", "18");
    if (strcasecmp(ext, "mov") == 0) {
        add_two(w, "-tag:v", "avc1");
        add_two(w, "-strict", "-1");
    }
    if (pixels_are_rgb(v->pixels))
        add_two(w, "-pix_fmt", pixels_named("420", pixels_bits(v->pixels)));
    if ((t->width % 2 == 0 && t->height % 2 == 0) ||
        (t->is_444 && !pixels_are_rgb(v->pixels)))
        return;
    add_two(w, "-vf",
            t->width % 2 && t->height % 2
                ? "pad=iw+1:ih+1,fillborders=right=1:bottom=1:mode=smear"
            : t->width % 2 ? "pad=iw+1:ih,fillborders=right=1:mode=smear"
                           : "pad=iw:ih+1,fillborders=bottom=1:mode=smear");
    if (!t->quiet)
        fprintf(stderr,
                "glint overlay: %s: %dx%d, as H.264 has even sides only\n",
                t->name, t->width + t->width % 2, t->height + t->height % 2);
}

static void add_pictures(struct words *w, const struct ffmpeg_target *t,
                         const struct ffmpeg_video *v)
{
    static const char *const h264[] = {"mp4", "m4v", "mkv",  "mov", "flv",
                                       "ts",  "mts", "m2ts", "3gp", NULL};
    const char *ext = extension(t->name);

    if (strcasecmp(ext, "gif") == 0) {
        add_two(w, "-filter_complex",
                "[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse");
    } else if (strcasecmp(ext, "webm") == 0) {
        add_two(w, "-crf", "24");
        add_two(w, "-b:v", "0");
        add_two(w, "-row-mt", "1");
        add_two(w, "-cpu-used", "4");
    } else if (is_one_of(ext, h264)) {
        add_h264(w, t, v);
    } else
        add_two(w, "-q:v", "2");
}

/* Adds the words of OPTIONS, which it cuts at its blanks. */
static void add_options(struct words *w, char *options)
{
    char *word, *rest = options;

    while ((word = strtok_r(rest, " ", &rest)))
        add(w, word);
}

enum glint_status ffmpeg_write(struct child *child,
                               const struct ffmpeg_target *target,
                               const struct ffmpeg_video *video,
                               struct glint_error *error)
{
    const struct ffmpeg_target *t = target;
    char out[FFMPEG_URL], sound[FFMPEG_URL] = "", options[1024];
    enum glint_status status;
    struct words w;

    *child = CHILD_NONE;
    if (!set_url(out, t->file) || (t->sound && !set_url(sound, t->sound)) ||
        (t->options && strlen(t->options) >= sizeof options))
        return too_long(t->name, error);
    begin(&w);
    add(&w, "-y");
    add_two(&w, "-f", "yuv4mpegpipe");
    add_tags(&w, t, video);
    add_two(&w, "-i", "-");
    add_sound(&w, t, video->sound, sound);
    add_tags(&w, t, video);
    if (t->options) {
        snprintf(options, sizeof options, "%s", t->options);
        add_options(&w, options);
    } else
        add_pictures(&w, t, video);
    add(&w, out);
    status = end(&w, error);
    return status == GLINT_OK ? start_child(child, w.word, CHILD_READS, error)
                              : status;
}

void ffmpeg_by_hand(const struct tool *tool, const char *in, const char *out)
{
    const bool coded = ffmpeg_is_video(in);

    fprintf(stderr,
            "glint %s: ffmpeg is not installed, which reads and writes videos "
            "other than .y4m (apt-get install ffmpeg). By hand, where it is:\n"
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

/* The frames to decode: the first one, those from a second before the end on,
 * or all. */
enum piece { FIRST, LAST, ALL };

/* Sets CAUSE to LINE, a message of ffmpeg, without the context before it:
 * "[h264 @ 0x55d0] " or URL and ": ". */
static void set_cause(char cause[CAUSE], const char *line, const char *url)
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
 * frame, lines with '#', and messages, the first of which becomes CAUSE.
 * Returns the number of frames, or 0 if the file is cut off. */
static long count_frames(FILE *from, const char *url, char cause[CAUSE])
{
    char line[LINE];
    bool is_cut = false;
    long n = 0;

    while (fgets(line, sizeof line, from)) {
        n += isdigit((unsigned char)*line) != 0;
        if (!*cause && *line != '#' && !isdigit((unsigned char)*line))
            set_cause(cause, line, url);
        for (int i = 0; ffmpeg_cut_words[i]; i++)
            is_cut |= strstr(line, ffmpeg_cut_words[i]) != NULL;
    }
    return is_cut ? 0 : n;
}

/* Decodes PIECE of URL. Returns false if that fails or yields no frame, with
 * the reason in CAUSE. */
static bool decode(const char *url, enum piece piece, char cause[CAUSE])
{
    /* Packets from the key frame before the place on give frames only with the
     * time stamps that they have in the file. */
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
    if (start_child(&child, argv, CHILD_PRINTS, &error) != GLINT_OK) {
        snprintf(cause, CAUSE, "%.*s", CAUSE - 1, error.text);
        return false;
    }
    from = fdopen(child.fd, "r");
    if (from) {
        n = count_frames(from, url, cause);
        fclose(from);
        child.fd = -1;
    }
    if (child_end(&child) == 0 && n > 0)
        return true;
    if (!*cause)
        snprintf(cause, CAUSE, "ffmpeg decodes no frame");
    return false;
}

enum glint_status ffmpeg_check(const char *file, const char *name,
                               struct glint_error *error)
{
    char url[FFMPEG_URL], cause[CAUSE];
    bool has_first;

    if (!set_url(url, file))
        return glint_error_report(error, GLINT_E_OUTPUT, name,
                                  "the name is too long");
    has_first = decode(url, FIRST, cause);
    /* Files without an index, as .ts, are not found a way into from their end;
     * all of their frames are decoded. */
    if (has_first && (decode(url, LAST, cause) || decode(url, ALL, cause)))
        return GLINT_OK;
    return glint_error_report(
        error, GLINT_E_OUTPUT, name,
        "the %s frame does not decode (%s); choose another encoder "
        "(--encode) or type of file",
        has_first ? "last" : "first", cause);
}

void ffmpeg_report_losses(const char *file, const char *name,
                          const char *pixels)
{
    struct ffmpeg_video made;
    char text[160] = "";
    size_t n = 0;

    ffmpeg_probe(&made, file);
    if (!*made.pixels || !*pixels)
        return;
    if (pixels_bits(made.pixels) < pixels_bits(pixels))
        n += (size_t)snprintf(text, sizeof text, ", %d bits in place of %d",
                              pixels_bits(made.pixels), pixels_bits(pixels));
    if (strcmp(pixels_chroma(pixels), "gray") != 0 &&
        strcmp(pixels_chroma(made.pixels), "444") != 0 &&
        strcmp(pixels_chroma(made.pixels), pixels_chroma(pixels)) != 0)
        n += (size_t)snprintf(
            text + n, sizeof text - n, ", chroma %s in place of %s",
            pixels_chroma(made.pixels),
            pixels_are_rgb(pixels) ? "RGB" : pixels_chroma(pixels));
    if (pixels_have_alpha(pixels) && !pixels_have_alpha(made.pixels))
        snprintf(text + n, sizeof text - n, ", no alpha");
    if (*text)
        fprintf(stderr,
                "glint overlay: %s: has %s; see --encode for encoders that "
                "keep more\n",
                name, text + 2);
}
