/* SPDX-License-Identifier: MIT */
#include "control/line_pipe.h"

#include <errno.h>
#include <poll.h>
#include <unistd.h>

enum { READINGS = 16 };

void line_pipe_init(struct line_pipe *pipe, int fd)
{
    *pipe = (struct line_pipe){.fd = fd};
}

void line_pipe_turn(struct line_pipe *pipe)
{
    pipe->left = READINGS;
}

/* Reads more; returns false if nothing came. */
static bool fill(struct line_pipe *p)
{
    struct pollfd there = {.fd = p->fd, .events = POLLIN};
    ssize_t n;

    if (p->left == 0 || (!p->waits && poll(&there, 1, 0) <= 0))
        return false;
    p->left--;
    do
        n = read(p->fd, p->bytes, sizeof p->bytes);
    while (n < 0 && errno == EINTR);
    p->has_ended = n == 0 || (n < 0 && errno != EAGAIN);
    p->at = 0;
    p->n_bytes = n > 0 ? (size_t)n : 0;
    return n > 0;
}

static char *end_line(struct line_pipe *p)
{
    p->text[p->n_text] = '\0';
    p->n_text = 0;
    p->is_long = p->is_cut;
    p->is_cut = false;
    p->number++;
    return p->text;
}

char *line_pipe_next(struct line_pipe *pipe)
{
    for (;;) {
        while (pipe->at < pipe->n_bytes) {
            const char c = pipe->bytes[pipe->at++];

            if (c == '\n')
                return end_line(pipe);
            if (pipe->n_text < LINE_PIPE_BYTES - 1)
                pipe->text[pipe->n_text++] = c ? c : '?';
            else
                pipe->is_cut = true;
        }
        if (!fill(pipe))
            return pipe->has_ended && pipe->n_text ? end_line(pipe) : NULL;
    }
}
