/* SPDX-License-Identifier: MIT
 *
 * glint/status.h - return values of functions that can fail.
 *
 * Functions that load or initialise validate all input and return a status.
 * Functions that draw a frame cannot fail; they count what they leave out.
 * Functions of the offline half return a status and write a line for a person
 * to a struct glint_error. */
#ifndef GLINT_STATUS_H
#define GLINT_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

enum glint_status {
    GLINT_OK = 0,
    GLINT_E_ARGUMENT,    /* a parameter is outside its documented range */
    GLINT_E_MEMORY,      /* not enough memory, or a memory block is too small */
    GLINT_E_FORMAT,      /* a picture or stream is malformed */
    GLINT_E_UNSUPPORTED, /* well formed, but not supported by glint */
    GLINT_E_LENS,        /* a lens table, scene text or model is invalid */
    GLINT_E_IO,          /* reading failed */
    GLINT_E_OUTPUT,      /* writing failed */
    GLINT_E_CLOSED,      /* the reader of a pipe has closed it */
    GLINT_E_DEVICE       /* a camera or display failed, is busy or was
                            disconnected */
};

/* An error message of one line, "FILE:LINE:COLUMN: cause" if the error is in a
 * file. Always terminated; longer texts are truncated. */
struct glint_error {
    char text[256];
};

/* Callback for progress. DONE is the fraction of the work that is done, 0 .. 1.
 * Called by the calling thread or worker 0, never by both at once. */
typedef void glint_progress_fn(void *ctx, double done);

/* Returns a description of STATUS in a few words, never NULL. */
const char *glint_status_text(enum glint_status status);

#ifdef __cplusplus
}
#endif

#endif
