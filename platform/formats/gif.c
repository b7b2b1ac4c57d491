/* SPDX-License-Identifier: MIT */
#include "formats/gif.h"

#include <stdlib.h>
#include <string.h>

#include "posix/ending.h"
#include "posix/input.h"

/* Returns where the sub-blocks that begin at AT end, or the end of the data. */
static size_t skip_blocks(const uint8_t *d, size_t n, size_t at)
{
    while (at < n && d[at] != 0)
        at += (size_t)d[at] + 1;
    return at < n ? at + 1 : n;
}

static size_t colours(uint8_t packed)
{
    return packed & 0x80 ? (size_t)3 << ((packed & 7) + 1) : 0;
}

static int count_frames(const uint8_t *d, size_t n)
{
    int frames = 0;
    size_t at;

    if (n < 13 || memcmp(d, "GIF8", 4) != 0)
        return 0;
    at = 13 + colours(d[10]);
    while (at < n && d[at] != 0x3b) {
        if (d[at] == 0x21 && at + 2 < n) {
            at = skip_blocks(d, n, at + 2);
        } else if (d[at] == 0x2c && at + 11 < n) {
            frames++;
            at = skip_blocks(d, n, at + 11 + colours(d[at + 9]));
        } else
            break;
    }
    return frames;
}

int glint_gif_frames(const char *name)
{
    struct glint_error error;
    uint8_t *data = NULL;
    size_t bytes = 0;
    int n = 0;

    if (!glint_ends_in(name, ".gif"))
        return 0;
    if (glint_input_slurp(&data, &bytes, name, 1 << 28, &error) == GLINT_OK)
        n = count_frames(data, bytes);
    free(data);
    return n;
}
