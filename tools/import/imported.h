/* SPDX-License-Identifier: MIT
 *
 * imported.h - a lens read from another program's file, before it is written as
 * a lens table.
 *
 *     imported_init(&lens, "x.zmx", strict);
 *     format = import_find_format("x.zmx");
 *     text = import_parse_file(&lens, format, data, &bytes);
 *
 * Readers store the values in the units of the file. imported_write_table()
 * adds missing values and writes a .lens table. A note with a line number
 * reports each value that is guessed and each input that is ignored. STRICT
 * rejects a lens with guesses. It does so only at the end, so that one run
 * reports all guesses.
 */
#ifndef GLINT_TOOLS_IMPORT_IMPORTED_H
#define GLINT_TOOLS_IMPORT_IMPORTED_H

#include <stdint.h>

#include "glint/prescription.h"

enum { IMPORT_SURFACES = 128, IMPORT_NOTES = 256, IMPORT_TEXT = 240 };

struct imported_surface {
    int line;         /* number of the surface's line in the file */
    double radius;    /* radius of curvature, in the file's unit; 0: plane */
    double thickness; /* distance to the next surface, in the file's unit */
    double semi;      /* semi-diameter; 0: not stated */
    /* name of the glass behind the surface; "": nd and vd define it */
    char glass[32];
    /* refractive index (1: air) and Abbe number (0: not stated) */
    double nd, vd;
    bool stop;
    struct glint_shape shape; /* shape of the surface; its member group is not
                               * used */
    /* medium behind the surface, in the syntax of lens tables;
     * imported_write_table() sets it */
    char medium[48];
    double index; /* refractive index of medium */
};

struct imported_note {
    int line; /* line number; 0: the whole file */
    /* true: the note reports a guess, because of which STRICT rejects the
     * lens */
    bool guess;
    char text[IMPORT_TEXT];
};

struct imported {
    const char *file, *format;
    bool strict;
    char name[GLINT_NAME_BYTES], title[IMPORT_TEXT];
    double unit_mm; /* unit of lengths, mm */
    bool unit_said; /* whether the file states the unit */
    /* true: the file has no stop, so the stop is assumed at the front */
    bool stop_guessed;
    /* true: the file states an object that is not at infinity, which glint
     * ignores */
    bool object_near;
    int object_line;
    double object;          /* distance of this object, in the file's unit */
    double f_number_given;  /* f-number set by the user, which overrides the
                               file's; 0: not set */
    double f_number, pupil; /* f-number; diameter of the entrance pupil, in the
                               file's unit; 0: not stated */
    /* half field angle, degrees; half image height, in the file's unit; 0:
     * not stated */
    double field_deg, height;
    double film_mm[2]; /* film width and height, mm; 0: not stated */
    double nominal;    /* nominal focal length, as in the product's name, mm; 0:
                          none */
    int position;      /* zoom position, from 1, set by the user; 0: not set */
    bool chosen;       /* whether a zoom position of the file was selected */
    /* key of the lens that the user selects in a file of many lenses; NULL:
     * none */
    const char *key;
    bool keyed; /* whether the file has several lenses, named by keys */
    int n;
    struct imported_surface surface[IMPORT_SURFACES];
    char error[IMPORT_TEXT + 64]; /* "FILE:LINE: cause" */
    int n_notes, n_guesses; /* number of notes and of guesses, including those
                               that did not fit */
    struct imported_note note[IMPORT_NOTES];
};

/* Neighbouring surfaces must not cross at heights up to this fraction of the
 * smaller of their semi-diameters. */
#define IMPORT_FREE 0.9

/* Reads TEXT[BYTES] into LENS, in the file's own units. Returns false after an
 * error. */
typedef bool import_read_fn(struct imported *lens, const char *text,
                            size_t bytes);

/* A file format: its name for --format, its file extension with the dot (NULL:
 * none), and its reader. */
struct import_format {
    const char *name, *end;
    import_read_fn *read;
};

void imported_init(struct imported *lens, const char *file, bool strict);

/* Sets the error, unless there is one already, and returns false. LINE 0: the
 * error concerns the whole file. */
bool imported_report_error(struct imported *lens, int line, const char *format,
                           ...);

/* Rejects a file without surfaces, which may be of another format. */
bool imported_report_no_surfaces(struct imported *lens);

/* Adds a note about a guess. Always returns true, so that callers can return
 * its result. */
bool imported_add_note(struct imported *lens, int line, const char *format,
                       ...);

/* Adds a note that WORD is not supported, unless there is one for WORD. */
bool imported_note_unread_word(struct imported *lens, int line,
                               const char *word);

/* Sets the distance of the object. If it is not (almost) infinite, the light
 * from infinity that glint assumes counts as a guess. */
void imported_set_object(struct imported *lens, int line, double distance);

/* Sets the unit of lengths to MM millimetres, as stated on line LINE. */
bool imported_set_unit(struct imported *lens, int line, double mm);

/* Sets the image plane of line LINE. If RADIUS is not 0, adds a note that the
 * image is curved. If DEFOCUS, in the file's unit, is not 0, moves the sensor
 * by DEFOCUS and adds a note. */
void imported_set_image_surface(struct imported *lens, int line, double radius,
                                double defocus);

/* Adds a note that lengths are assumed to be in mm, unless WORD in the file
 * has set the unit. */
bool imported_note_missing_unit(struct imported *lens, const char *word);

/* Sets AT to the index, from 0, of the zoom position to read. N: number of
 * positions in the file. Returns false with the error set if the requested
 * position does not exist. */
bool imported_choose_position(struct imported *lens, int line, int n, int *at);

/* Adds a plane with air behind it. Returns NULL, with the error set, if there
 * are too many surfaces. */
struct imported_surface *imported_add_surface(struct imported *lens, int line);

/* Returns the axial distance from S to the next surface at the height H. */
double imported_compute_gap_at_height(const struct imported_surface *s,
                                      double h);

/* Sorts notes by line; notes about the whole file come last. */
void imported_sort_notes(struct imported *lens);

/* Completes LENS and returns it as a lens table, which the caller frees, or
 * NULL with the error set. */
char *imported_write_table(struct imported *lens, size_t *bytes);

/* ------------------------------------------------------------------ readers */

import_read_fn import_zmx, import_pbrt, import_flaresim, import_seq,
    import_oslo, import_openlensflare, import_polyflare, import_opticalbench,
    import_realflare, import_lentil;

/* Returns the Kth format, from 0, or NULL if there are no more. */
const struct import_format *import_get_format(int k);

/* Returns the format of the file NAME by its extension, or NULL if no format
 * has the extension. A .lens file is taken as FlareSim's, a .dat file as
 * pbrt's. */
const struct import_format *import_find_format(const char *name);

/* Reads DATA as FORMAT, decoding it in place, and completes the lens.
 * Returns it as a lens table, which the caller frees, or NULL with the error
 * set. */
char *import_parse_file(struct imported *lens,
                        const struct import_format *format, uint8_t *data,
                        size_t *bytes);

#endif
