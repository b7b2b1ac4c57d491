/* SPDX-License-Identifier: MIT
 *
 * layout.h - packed pixel layouts by their names in device trees. A name lists
 * the fields of a pixel from the highest bit down, as in r5g6b5 or x8r8g8b8. A
 * name that ends in "-shifted" describes a panel that fills the low bits of a
 * channel with 0 instead of repeating its high bits. White is then not quite
 * white, as on the emulated VGA card with 5 bits per channel.
 */
#ifndef GLINT_VM_LAYOUT_H
#define GLINT_VM_LAYOUT_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct layout {
    unsigned n_bytes;
    /* length and offset, bits, of red, green, blue */
    unsigned length[3], offset[3];
    int shifted;
};

/* Sets *LAYOUT to the layout called NAME. Returns 0 if the name is unknown. */
__attribute__((unused)) static int layout_of(const char *name,
                                             struct layout *layout)
{
    unsigned at = 0;
    const char *end = strchr(name, '-');
    memset(layout, 0, sizeof *layout);
    layout->shifted = end && strcmp(end, "-shifted") == 0;
    for (size_t i = end ? (size_t)(end - name) : strlen(name); i >= 2; i -= 2) {
        const char *field = name + i - 2;
        const char *known = "rgb", *channel = strchr(known, field[0]);
        unsigned length = (unsigned)(field[1] - '0');
        if (length < 1 || length > 8)
            return 0;
        if (channel) {
            layout->length[channel - known] = length;
            layout->offset[channel - known] = at;
        }
        at += length;
    }
    layout->n_bytes = at / 8;
    return at % 8 == 0 && at >= 16 && at <= 32;
}

/* Returns how the panel displays the value FIELD of channel C, 0 .. 255. If the
 * panel repeats high bits in low ones, the max value gives 255. */
__attribute__((unused)) static uint8_t shown(const struct layout *layout,
                                             unsigned c, uint32_t field)
{
    unsigned n = layout->length[c];
    uint32_t wide = field << (8 - n);
    for (unsigned have = n; have < 8 && !layout->shifted; have += n)
        wide |= wide >> have;
    return (uint8_t)wide;
}

#endif
