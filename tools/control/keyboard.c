/* SPDX-License-Identifier: MIT */
#include "control/keyboard.h"

#include <poll.h>
#include <signal.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "posix/at_death.h"

/* Degrees, and factors of distances and slopes. */
#define STEP_DEG 3
#define NEARER   0.95
#define SMOOTHER 0.87
#define DIMMER   0.8

const char keyboard_help[] =
    "keys: arrows orbit, + - distance, [ ] turn the environment, { } its "
    "light, "
    "e next environment, a A slopes of brushed metal, m next material, space "
    "pause, . , step, s stop, q end";

static const struct {
    const char *bytes;
    struct control_line line;
} keys[] = {
    {"\033[A", {.verb = CONTROL_ORBIT, .n = 2, .v = {0, STEP_DEG}}},
    {"\033[B", {.verb = CONTROL_ORBIT, .n = 2, .v = {0, -STEP_DEG}}},
    {"\033[C", {.verb = CONTROL_ORBIT, .n = 2, .v = {STEP_DEG, 0}}},
    {"\033[D", {.verb = CONTROL_ORBIT, .n = 2, .v = {-STEP_DEG, 0}}},
    {"+", {.verb = CONTROL_DISTANCE, .n = 1, .v = {NEARER}}},
    {"=", {.verb = CONTROL_DISTANCE, .n = 1, .v = {NEARER}}},
    {"-", {.verb = CONTROL_DISTANCE, .n = 1, .v = {1 / NEARER}}},
    {"[", {.verb = CONTROL_TURN, .n = 1, .v = {-STEP_DEG}}},
    {"]", {.verb = CONTROL_TURN, .n = 1, .v = {STEP_DEG}}},
    {"{", {.verb = CONTROL_SCALE, .n = 1, .v = {DIMMER}}},
    {"}", {.verb = CONTROL_SCALE, .n = 1, .v = {1 / DIMMER}}},
    {"e", {.verb = CONTROL_NEXT_MAP}},
    {"a", {.verb = CONTROL_ALPHA, .n = 1, .v = {SMOOTHER}}},
    {"A", {.verb = CONTROL_ALPHA, .n = 1, .v = {1 / SMOOTHER}}},
    {"m", {.verb = CONTROL_MATERIAL}},
    {" ", {.verb = CONTROL_PAUSE}},
    {".", {.verb = CONTROL_STEP, .n = 1, .v = {1}}},
    {",", {.verb = CONTROL_STEP, .n = 1, .v = {-1}}},
    {"s", {.verb = CONTROL_STOP}},
};

enum { N_KEYS = (int)(sizeof keys / sizeof *keys) };

/* The terminal as it was, while keys are taken. */
static struct termios before;
static volatile sig_atomic_t terminal = -1;

static void put_back(void)
{
    if (terminal >= 0)
        tcsetattr(terminal, TCSANOW, &before);
}

enum glint_status keyboard_open(struct keyboard *k, int fd)
{
    struct termios raw;

    *k = (struct keyboard){.fd = -1};
    if (tcgetattr(fd, &before) != 0)
        return GLINT_E_IO;
    k->fd = fd;
    glint_at_death(put_back);
    terminal = fd;
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    /* From the background this would stop the process. */
    if (tcgetpgrp(fd) == getpgrp())
        tcsetattr(fd, TCSANOW, &raw);
    return GLINT_OK;
}

/* Returns how many bytes the first key of TEXT[N] has: one, or those up to the
 * letter that ends an escape sequence. */
static int length_of(const char *text, int n)
{
    int i = 2;

    if (n < 2 || text[0] != '\033' || text[1] != '[')
        return 1;
    while (i < n && (text[i] < '@' || text[i] > '~'))
        i++;
    return i < n ? i + 1 : n;
}

int keyboard_take(const char *text, int n, struct control_line *line)
{
    const int length = length_of(text, n);

    *line = (struct control_line){.frame = -1};
    for (int i = 0; i < N_KEYS; i++)
        if ((int)strlen(keys[i].bytes) == length &&
            memcmp(keys[i].bytes, text, (size_t)length) == 0) {
            *line = keys[i].line;
            line->frame = -1;
            line->is_change = true;
        }
    return length;
}

/* Reads what was pressed; returns false if that is nothing. */
static bool fill(struct keyboard *k)
{
    struct pollfd there = {.fd = k->fd, .events = POLLIN};
    ssize_t n = 0;

    if (k->fd >= 0 && tcgetpgrp(k->fd) == getpgrp() && poll(&there, 1, 0) > 0)
        n = read(k->fd, k->bytes, sizeof k->bytes);
    k->at = 0;
    k->n = n > 0 ? (int)n : 0;
    return n > 0;
}

bool keyboard_next(struct keyboard *k, struct control_line *line)
{
    while (k->at < k->n || fill(k)) {
        if (k->bytes[k->at] == 'q')
            raise(SIGINT);
        k->at += keyboard_take(k->bytes + k->at, k->n - k->at, line);
        if (line->verb != CONTROL_NONE)
            return true;
    }
    return false;
}

void keyboard_close(struct keyboard *k)
{
    if (k->fd >= 0)
        put_back();
    terminal = -1;
    k->fd = -1;
}
