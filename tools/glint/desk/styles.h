/* SPDX-License-Identifier: MIT
 *
 * styles.h - named presets of options for typical appearances of flares.
 */
#ifndef GLINT_TOOLS_DESK_STYLES_H
#define GLINT_TOOLS_DESK_STYLES_H

enum { STYLE_SETTINGS = 8 };

/* A long option and its value. */
struct style_setting {
    const char *option, *value;
};

struct style {
    const char *name, *about; /* NULL ends the table of styles */
    struct style_setting set[STYLE_SETTINGS]; /* ends with an option of NULL */
};

extern const struct style styles[];

/* Returns the style NAME, or NULL. */
const struct style *find_style_of_lens(const char *name);

#endif
