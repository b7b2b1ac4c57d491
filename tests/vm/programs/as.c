/* SPDX-License-Identifier: MIT
 *
 * as UID PROGRAM [ARG...] - runs PROGRAM as user UID without privileges.
 */
#define _DEFAULT_SOURCE /* for setgroups() */
#include <grp.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int main(int argc, char **argv)
{
    const int id = argc > 2 ? atoi(argv[1]) : 0;

    if (id <= 0 || setgroups(0, NULL) < 0 || setgid((gid_t)id) < 0 ||
        setuid((uid_t)id) < 0)
        return 125;
    execvp(argv[2], argv + 2);
    perror(argv[2]);
    return 127;
}
