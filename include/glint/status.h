/* SPDX-License-Identifier: MIT
 *
 * glint/status.h - return values of functions that can fail.
 *
 * Loading and initialising validate everything and return a status; drawing a
 * frame cannot fail and counts what it left out; the offline half returns a
 * status and fills a struct glint_error with one line for a person.
 */
#ifndef GLINT_STATUS_H
#define GLINT_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

enum glint_status {
    GLINT_OK = 0,
    GLINT_E_ARGUMENT,    /* a parameter is outside its documented range */
    GLINT_E_MEMORY,      /* not enough memory, or a block too small */
    GLINT_E_FORMAT,      /* a picture or stream is malformed */
    GLINT_E_UNSUPPORTED, /* well formed, but not something glint handles */
    GLINT_E_LENS,        /* a lens table or model is wrong */
    GLINT_E_IO,          /* reading failed */
    GLINT_E_OUTPUT,      /* writing failed */
    GLINT_E_CLOSED,      /* the reader of a pipe went away */
    GLINT_E_DEVICE       /* a camera or panel failed, is busy or went away */
};

/* One line for a person, "FILE:LINE:COLUMN: cause" where there is a file.
 * Always terminated; longer texts are cut. */
struct glint_error {
    char text[256];
};

/* Progress report: receives the fraction of the work that is done, 0 .. 1, from
 * the calling thread or worker 0, never from both at once. */
typedef void glint_progress_fn(void *ctx, double done);

/* Returns a few words for STATUS, never NULL. */
const char *glint_status_text(enum glint_status status);

#ifdef __cplusplus
}
#endif

#endif
