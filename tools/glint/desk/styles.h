/* SPDX-License-Identifier: MIT
 *
 * styles.h - named presets of options for typical appearances of flares.
 */
#ifndef GLINT_TOOLS_DESK_STYLES_H
#define GLINT_TOOLS_DESK_STYLES_H

enum { STYLE_SETTINGS = 8 };

/* A long option and the value that the style gives it */
struct style_setting {
    const char *option, *value;
};

struct style {
    const char *name, *about; /* name and description; NULL: end of the table */
    struct style_setting set[STYLE_SETTINGS]; /* options of the style; the last
                                                 has the option NULL */
};

extern const struct style styles[];

/* Returns the style NAME, or NULL if there is none. */
const struct style *find_style_by_name(const char *name);

#endif
