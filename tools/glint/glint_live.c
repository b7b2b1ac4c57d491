/* SPDX-License-Identifier: MIT
 *
 * glint-live - glint live as a program of its own, for boards: a tenth of the
 * size, as it takes baked models only (models_only.c).
 */
#include "posix/process.h"
#include "options/command_line.h"

int main(int argc, char **argv)
{
    glint_process_hold_streams();
    tool_line(argv);
    tool_watch_reader();
    return tool_end(cmd_live(argc, argv));
}
