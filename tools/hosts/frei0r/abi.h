/* SPDX-License-Identifier: MIT
 *
 * abi.h - the binary interface of frei0r 1, version 1.2, rewritten: the
 * functions that hosts call in a plug-in, with their structs and constants.
 *
 * A host calls f0r_init() once, then makes instances. Several threads may call
 * different instances at the same time, but only one thread at a time calls a
 * given instance. Pictures have 4 bytes per pixel and no padding; the top row
 * comes first.
 */
#ifndef GLINT_TOOLS_FREI0R_ABI_H
#define GLINT_TOOLS_FREI0R_ABI_H

#include <stdint.h>

enum { F0R_MAJOR = 1 };
/* type of plug-in: a filter, which makes one picture from one */
enum { F0R_FILTER = 0 };
enum { F0R_BGRA = 0 }; /* colour models: bytes B, G, R, A */
enum f0r_type {
    F0R_BOOL = 0,   /* a double; true from 0.5 on */
    F0R_DOUBLE = 1, /* a double, 0 .. 1 by convention */
    F0R_STRING = 4  /* a char *, UTF-8 */
};

struct f0r_plugin {
    const char *name, *author;
    int kind, colour_model;
    int frei0r_version; /* F0R_MAJOR */
    int major_version, minor_version;
    int n_params;
    const char *explanation;
};

struct f0r_param {
    const char *name;
    int type; /* type of the parameter, F0R_BOOL ... */
    const char *explanation;
};

#define F0R_EXPORT __attribute__((visibility("default")))

/* The host calls f0r_init() after it has loaded the plug-in, and f0r_deinit()
 * before it unloads it. f0r_init() returns 1. */
F0R_EXPORT int f0r_init(void);
F0R_EXPORT void f0r_deinit(void);

F0R_EXPORT void f0r_get_plugin_info(struct f0r_plugin *info);
F0R_EXPORT void f0r_get_param_info(struct f0r_param *info, int index);

/* Returns an instance for pictures of WIDTH x HEIGHT, or NULL. */
F0R_EXPORT void *f0r_construct(unsigned width, unsigned height);
F0R_EXPORT void f0r_destruct(void *instance);

/* VALUE points to a double or a char *. f0r_set_param_value() copies strings.
 * Strings that f0r_get_param_value() returns belong to the instance. */
F0R_EXPORT void f0r_set_param_value(void *instance, void *value, int index);
F0R_EXPORT void f0r_get_param_value(void *instance, void *value, int index);

/* Draws the flare onto IN, the picture at the time SECONDS, and writes the
 * result to OUT. */
F0R_EXPORT void f0r_update(void *instance, double seconds, const uint32_t *in,
                           uint32_t *out);

#endif
