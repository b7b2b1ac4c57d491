/* SPDX-License-Identifier: MIT
 *
 * styles.h - named presets of options for typical looks of flares. */
#ifndef GLINT_TOOLS_DESK_STYLES_H
#define GLINT_TOOLS_DESK_STYLES_H

enum { STYLE_SETTINGS = 8 };

/* A long option, and its value. */
struct style_setting {
    const char *option, *value;
};

struct style {
    const char *name, *about;                 /* NULL ends the table */
    struct style_setting set[STYLE_SETTINGS]; /* an option NULL ends it */
};

extern const struct style styles[];

/* Returns the style NAME, or NULL. */
const struct style *style_of(const char *name);

#endif
