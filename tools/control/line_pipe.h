/* SPDX-License-Identifier: MIT
 *
 * line_pipe.h - lines of a pipe, terminal or file, as they come.
 *
 *     line_pipe_init(&pipe, fd);
 *     line_pipe_turn(&pipe);                           each picture
 *     while ((line = line_pipe_next(&pipe)))
 *         if (pipe.is_long)
 *             ...
 *
 * Nothing waits, unless that is asked for. A writer that never stops gets
 * 64 KiB a turn. A zero byte is a ?. A line that lacks its end is one once
 * the writer is gone.
 */
#ifndef GLINT_TOOLS_CONTROL_LINE_PIPE_H
#define GLINT_TOOLS_CONTROL_LINE_PIPE_H

#include <stdbool.h>
#include <stddef.h>

enum { LINE_PIPE_BYTES = 512 }; /* of a line with its end */

struct line_pipe {
    int fd;
    bool waits;     /* for more, to the end of the file */
    int number;     /* of the last line, counted from 1 */
    bool is_long;   /* it was longer, and is cut */
    bool has_ended; /* the last reading met the end of the file, or failed */

    /* Private. */
    char text[LINE_PIPE_BYTES], bytes[4096];
    size_t n_text, at, n_bytes;
    bool is_cut; /* of the line that is being read */
    int left;    /* readings in this turn */
};

void line_pipe_init(struct line_pipe *pipe, int fd);

/* Begins a turn. */
void line_pipe_turn(struct line_pipe *pipe);

/* Returns the next line, for the caller to change, which holds until the next
 * call; NULL: there is no more in this turn. */
char *line_pipe_next(struct line_pipe *pipe);

#endif
