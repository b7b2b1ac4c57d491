/* SPDX-License-Identifier: MIT
 *
 * glint web: sends the files of the page of tools/hosts/web, and a photograph,
 * to browsers on this computer.
 */
#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "model/lens_files.h"
#include "model/settings.h"
#include "options/command_line.h"
#include "options/tool.h"
#include "posix/error.h"
#include "posix/input.h"

static const char help[] =
    "glint web [PHOTO]\n"
    "\n"
    "Prints the address of a page that adds flares to photographs, with PHOTO "
    "opened,\n"
    "and sends it to browsers on this computer until it is interrupted. The "
    "address\n"
    "contains a random word; nothing else can be read. make web builds the "
    "page.\n";

enum {
    PATH_CHARS = 1024,
    WORD = 32,
    MAX_BYTES = 200000000,
    TIMEOUT_S = 10,
    MAX_CONNECTION_S = 60
};

struct site {
    char folder[PATH_CHARS];
    const char *photo;   /* NULL: none */
    char word[WORD + 2]; /* random, as "/WORD" */
};

static bool find_page_folder(struct site *site)
{
    char file[PATH_CHARS + 16];

    for (int i = 0; lens_find_folder(i, "web", site->folder, PATH_CHARS); i++) {
        snprintf(file, sizeof file, "%s/glint.wasm", site->folder);
        if (*site->folder && access(file, R_OK) == 0)
            return true;
    }
    return false;
}

static bool choose_random_word(struct site *site)
{
    unsigned char random[WORD / 2];
    FILE *file = fopen("/dev/urandom", "rb");
    const bool ok = file && fread(random, sizeof random, 1, file) == 1;

    if (file)
        fclose(file);
    site->word[0] = '/';
    for (int i = 0; i < WORD / 2 && ok; i++)
        snprintf(site->word + 1 + 2 * i, 3, "%02x", random[i]);
    return ok;
}

/* Returns the type of the file NAME. A photograph has none that may contain a
 * script. */
static const char *get_content_type(const char *name, bool is_photo)
{
    enum { FIRST_RASTER = 5 };
    static const char *const types[][2] = {
        {".html", "text/html"},     {".css", "text/css"},
        {".js", "text/javascript"}, {".wasm", "application/wasm"},
        {".svg", "image/svg+xml"},  {".jpg", "image/jpeg"},
        {".jpeg", "image/jpeg"},    {".png", "image/png"},
        {".webp", "image/webp"},    {".avif", "image/avif"},
        {".bmp", "image/bmp"},      {".gif", "image/gif"}};
    const char *const end = strrchr(name, '.');

    for (size_t i = is_photo ? FIRST_RASTER : 0;
         end && i < sizeof types / sizeof *types; i++)
        if (strcasecmp(end, types[i][0]) == 0)
            return types[i][1];
    return "application/octet-stream";
}

/* Sets PATH to the file that REQUEST names: a file of the page, or the
 * photograph. Returns false if it names no such file. */
static bool find_requested_file(const struct site *site, const char *request,
                                char *path, size_t bytes)
{
    const size_t used = strlen(site->word);
    char name[64] = "";

    if (strncmp(request, "GET ", 4) != 0 ||
        strncmp(request + 4, site->word, used) != 0 || request[4 + used] != '/')
        return false;
    request += 4 + used + 1;
    if (*request == '.' || strcspn(request, " ?") >= sizeof name ||
        strspn(request, "abcdefghijklmnopqrstuvwxyz.") !=
            strcspn(request, " ?"))
        return false;
    memcpy(name, request, strcspn(request, " ?"));
    if (strcmp(name, "photo") == 0)
        return site->photo &&
               (size_t)snprintf(path, bytes, "%s", site->photo) < bytes;
    return (size_t)snprintf(path, bytes, "%s/%s", site->folder,
                            *name ? name : "index.html") < bytes;
}

static void send_bytes(int connection, const void *data, size_t bytes)
{
    const char *at = data;
    ssize_t n = 1;

    for (; bytes > 0 && n > 0; at += n, bytes -= (size_t)n)
        n = send(connection, at, bytes, MSG_NOSIGNAL);
}

/* Reads a request from CONNECTION and sends the answer. */
static void answer_request(const struct site *site, int connection)
{
    const struct timeval timeout = {TIMEOUT_S, 0};
    char request[8192] = "", path[PATH_CHARS + 64], head[512];
    struct glint_error error;
    uint8_t *data = NULL;
    size_t used = 0, bytes = 0;
    ssize_t n = 1;
    bool found;

    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout);
    while (n > 0 && used + 1 < sizeof request && !strstr(request, "\r\n\r\n")) {
        n = recv(connection, request + used, sizeof request - 1 - used, 0);
        used += n > 0 ? (size_t)n : 0;
        request[used] = '\0';
    }
    if (!strstr(request, "\r\n\r\n"))
        return;
    found = find_requested_file(site, request, path, sizeof path) &&
            glint_input_read_whole_file(&data, &bytes, path, MAX_BYTES,
                                        &error) == GLINT_OK;
    n = snprintf(head, sizeof head,
                 "HTTP/1.1 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n"
                 "Cache-Control: no-store\r\nReferrer-Policy: no-referrer\r\n"
                 "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
                 found ? "200 OK" : "404 Not Found",
                 found ? get_content_type(path, site->photo &&
                                                    !strcmp(path, site->photo))
                       : "text/plain",
                 found ? bytes : 0);
    send_bytes(connection, head, (size_t)n);
    if (found)
        send_bytes(connection, data, bytes);
    free(data);
}

/* Opens a socket that only this computer can reach. Returns it, or -1. */
static int open_local_socket(int *port)
{
    struct sockaddr_in at = {.sin_family = AF_INET};
    socklen_t bytes = sizeof at;
    const int fd = socket(AF_INET, SOCK_STREAM, 0);

    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (fd < 0 || bind(fd, (struct sockaddr *)&at, sizeof at) < 0 ||
        listen(fd, 16) < 0 ||
        getsockname(fd, (struct sockaddr *)&at, &bytes) < 0)
        return -1;
    *port = ntohs(at.sin_port);
    return fd;
}

/* Prints the address; after '#' follows the name of the photograph. */
static int print_address(const struct site *site, int port)
{
    const char *slash = site->photo ? strrchr(site->photo, '/') : NULL;
    const char *name = slash ? slash + 1 : site->photo;

    printf("http://127.0.0.1:%d%s/", port, site->word);
    for (const char *c = name ? name : ""; *c; c++)
        printf(c == name ? "#%%%02X" : "%%%02X", (unsigned char)*c);
    putchar('\n');
    return fflush(stdout);
}

/* Returns whether accept() may succeed later. */
static bool is_temporary(int error)
{
    return error == EINTR || error == ECONNABORTED || error == ENFILE ||
           error == EMFILE || error == ENOBUFS || error == ENOMEM;
}

static int run_web_server(struct tool *tool, struct site *site)
{
    const struct timespec pause = {0, 10000000};
    int port = 0;
    const int fd = open_local_socket(&port);

    if (fd < 0)
        return tool_fail(tool, GLINT_E_IO, strerror(errno));
    if (!choose_random_word(site))
        return tool_fail(tool, GLINT_E_IO, "/dev/urandom cannot be read");
    signal(SIGCHLD, SIG_IGN);
    if (print_address(site, port) != 0)
        return EXIT_OUTPUT;
    for (;;) {
        const int connection = accept(fd, NULL, NULL);

        if (connection < 0 && !is_temporary(errno))
            return tool_fail(tool, GLINT_E_IO, strerror(errno));
        if (connection < 0) {
            nanosleep(&pause, NULL);
            continue;
        }
        /* Browsers open connections that they use later, or never. */
        if (fork() == 0) {
            close(fd);
            alarm(MAX_CONNECTION_S);
            answer_request(site, connection);
            _exit(0);
        }
        close(connection);
    }
}

/* Returns GLINT_OK if PATH is a file that the server can send. */
static enum glint_status check_photo(const char *path,
                                     struct glint_error *error)
{
    struct glint_input photo;
    struct stat st;
    bool ok;

    if (glint_input_open_file(&photo, path, error) != GLINT_OK)
        return GLINT_E_IO;
    ok = strcmp(path, "-") != 0 && fstat(photo.fd, &st) == 0 &&
         S_ISREG(st.st_mode) && st.st_size <= MAX_BYTES;
    glint_input_close(&photo);
    return ok ? GLINT_OK
              : glint_error_report(error, GLINT_E_IO, path,
                                   "expected a file of at most %d MB",
                                   MAX_BYTES / 1000000);
}

int cmd_web(int argc, char **argv)
{
    static const struct option options[] = {TOOL_COMMON_OPTIONS};
    struct tool tool = {.name = "web", .help = help, .help_end = COMMON_HELP};
    struct site site = {.photo = NULL};
    struct glint_error error;
    int c, code = -1;

    while (code < 0 &&
           (c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >= 0)
        code = tool_apply_option(&tool, c, optarg);
    if (code < 0 && argc - optind > 1)
        code = tool_usage(&tool, "expects one photograph, or none");
    if (code >= 0)
        return code;
    site.photo = argv[optind];
    if (site.photo && check_photo(site.photo, &error) != GLINT_OK)
        return tool_fail(&tool, GLINT_E_IO, error.text);
    if (!find_page_folder(&site))
        return tool_fail(&tool, GLINT_E_IO,
                         "there is no page: make web builds it in build/web of "
                         "the source, and then make install installs it");
    return run_web_server(&tool, &site);
}
