/* SPDX-License-Identifier: MIT
 *
 * glint-live: glint live as a separate program for embedded boards. It has a
 * tenth of glint's size because it reads only baked models (models_only.c).
 */
#include "posix/process.h"
#include "options/command_line.h"

int main(int argc, char **argv)
{
    glint_process_open_closed_streams();
    tool_set_command_line(argv);
    tool_watch_closed_pipe();
    return tool_close_stdout(cmd_live(argc, argv));
}
