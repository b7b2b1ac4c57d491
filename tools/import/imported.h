/* SPDX-License-Identifier: MIT
 *
 * imported.h - a lens as another program's file has it, before it is a table.
 *
 *     imported_begin(&lens, "x.zmx", strict);
 *     text = import_read(&lens, import_format_of("x.zmx"), data, &bytes);
 *
 * Readers write down what the file says, in its own units, which is then
 * completed to a .lens table. A note reports whatever is guessed or left out
 * with its line number; STRICT refuses at the end, so that one run tells all of
 * it.
 */
#ifndef GLINT_TOOLS_IMPORT_IMPORTED_H
#define GLINT_TOOLS_IMPORT_IMPORTED_H

#include <stdint.h>

#include "glint/prescription.h"

enum { IMPORT_SURFACES = 128, IMPORT_NOTES = 256, IMPORT_TEXT = 240 };

struct imported_surface {
    int line;         /* of the file */
    double radius;    /* 0: plane */
    double thickness; /* to the next */
    double semi;      /* 0: not said */
    char glass[32];   /* name of the glass behind; "": see nd */
    double nd, vd;    /* nd 1: air; vd 0: not said */
    bool stop;
    struct glint_shape shape; /* no group */
    char medium[48];          /* behind, as a table has it; set by the next */
    double index;             /* of it */
};

struct imported_note {
    int line;   /* 0: of the whole file */
    bool guess; /* STRICT refuses it */
    char text[IMPORT_TEXT];
};

struct imported {
    const char *file, *format;
    bool strict;
    char name[GLINT_NAME_BYTES], title[IMPORT_TEXT];
    double unit_mm;    /* of its lengths */
    bool unit_said;    /* by a word of the file */
    bool stop_guessed; /* there was none */
    bool object_near;  /* glint has light from afar instead of that */
    int object_line;
    double object;            /* its distance */
    double f_number_given;    /* by the user, goes before the file's; or 0 */
    double f_number, pupil;   /* diameter of the entrance pupil; 0: not said */
    double field_deg, height; /* half field, or half image; 0: not said */
    double film_mm[2];        /* 0: not said */
    double nominal;           /* focal length, as products are named; or 0 */
    int position;             /* of a zoom, from 1, by the user; 0: not said */
    bool chosen;              /* the file has positions */
    const char *key; /* of a file of many lenses, by the user; or NULL */
    bool keyed;      /* the file has keys */
    int n;
    struct imported_surface surface[IMPORT_SURFACES];
    char error[IMPORT_TEXT + 64]; /* "FILE:LINE: cause" */
    int n_notes, n_guesses;       /* also of those that did not fit */
    struct imported_note note[IMPORT_NOTES];
};

/* Tables may not overlap within this fraction of the semi-diameters. */
#define IMPORT_FREE 0.9

/* Reads TEXT[BYTES] into LENS, in the file's own units. Returns false after an
 * error. */
typedef bool import_read_fn(struct imported *lens, const char *text,
                            size_t bytes);

/* A format: its name for --format, the end of its files' names, with the dot,
 * if it is known by that, and its reader. */
struct import_format {
    const char *name, *end;
    import_read_fn *read;
};

void imported_begin(struct imported *lens, const char *file, bool strict);

/* Sets the error unless there is one, and returns false. LINE 0 is the whole
 * file. */
bool imported_fail(struct imported *lens, int line, const char *format, ...);

/* Refuses a file without surfaces, which may be of another format. */
bool imported_empty(struct imported *lens);

/* Adds a note of a guess. Returns true, as reading continues. */
bool imported_note(struct imported *lens, int line, const char *format, ...);

/* Adds a note of what changes nothing, which STRICT takes, too. */
void imported_tell(struct imported *lens, int line, const char *format, ...);

/* Notes that WORD is not read, the first time that it is met. */
bool imported_unread(struct imported *lens, int line, const char *word);

/* Takes how far away the object is; if that is neither infinite nor as good as,
 * light from afar is a guess. */
void imported_object(struct imported *lens, int line, double distance);

/* Sets the unit that LINE says. */
bool imported_unit(struct imported *lens, int line, double mm);

/* Notes that the image that LINE has is bent, if RADIUS is not 0, and moves the
 * sensor by its DEFOCUS, in the file's unit, which is reported. */
void imported_image(struct imported *lens, int line, double radius,
                    double defocus);

/* Notes that lengths are taken for mm, unless the file's WORD said a unit. */
bool imported_need_unit(struct imported *lens, const char *word);

/* Sets AT to which of N positions of a zoom is wanted, from 0. */
bool imported_choose(struct imported *lens, int line, int n, int *at);

/* Adds a surface of air; NULL, after an error, if there are too many. */
struct imported_surface *imported_add(struct imported *lens, int line);

/* Returns the distance from S to the next surface at the height H. */
double imported_gap(const struct imported_surface *s, double h);

/* Sorts notes by their lines; those of the whole file come last. */
void imported_sort_notes(struct imported *lens);

/* Completes LENS and returns it as a table, in memory of malloc(); NULL after
 * an error. */
char *imported_finish(struct imported *lens, size_t *bytes);

/* ------------------------------------------------------------------ readers */

import_read_fn import_zmx, import_pbrt, import_flaresim, import_seq,
    import_oslo, import_openlensflare, import_polyflare, import_opticalbench,
    import_realflare, import_lentil;

/* Returns the Kth format, from 0, or NULL if there are no more. */
const struct import_format *import_format_at(int k);

/* Returns the format of the file NAME by its end, or NULL. A .lens and a .dat
 * are FlareSim's and pbrt's. */
const struct import_format *import_format_of(const char *name);

/* Reads DATA as FORMAT, completes it and returns it as a table, in memory of
 * malloc(); NULL after an error. DATA is decoded in place. */
char *import_read(struct imported *lens, const struct import_format *format,
                  uint8_t *data, size_t *bytes);

#endif
