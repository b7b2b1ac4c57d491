/* SPDX-License-Identifier: MIT
 *
 * formats/still_codec.h - what PNG and JPEG implement differently. Internal to
 * the files formats/still*. */
#ifndef GLINT_PLATFORM_FORMATS_STILL_CODEC_H
#define GLINT_PLATFORM_FORMATS_STILL_CODEC_H

#include "formats/oiio.h"

enum { STILL_NOTE_BYTES = 160 };

#define STILL_NEEDS_PLUGIN                                           \
    "needs glint's image plug-in: the package glint-oiio, or 'make " \
    "oiio' with libopenimageio-dev"

/* Bytes that a writer appends to. After memory was short, it stays empty. */
struct still_bytes {
    uint8_t *mem;       /* malloc'ed */
    size_t n, capacity; /* bytes */
    bool is_short;      /* true: memory was short */
};

/* Pixels without gaps, samples in this machine's byte order. */
struct still_pixels {
    int width, height;
    int channels;     /* 1: grey, 2: grey and alpha, 3: RGB, 4: RGB and alpha */
    int sample_bytes; /* 1 or 2 */
    uint8_t *mem;
};

/* An open PNG or JPEG file, which is cast to struct glint_oiio_file. */
struct still_file {
    const struct still_codec *codec;
    const char *path;
    uint8_t *data; /* the file, [bytes] */
    size_t bytes;
    struct still_pixels pixels;
    uint8_t *icc; /* ICC profile, malloc'ed, or NULL */
    size_t icc_bytes;
    const uint8_t *exif; /* TIFF header and directories in DATA, or NULL */
    size_t exif_bytes;
    bool has_other; /* true: it has metadata other than Exif and colours */
    char note[STILL_NOTE_BYTES]; /* text that lists content that is not
                                    preserved, or "" */
};

/* A chunk of a PNG or a segment of a JPEG. */
struct still_piece {
    char name[5]; /* name of the chunk; "" for segments */
    int marker;   /* second byte of the segment's marker; 0 for chunks */
    const uint8_t *whole, *data;
    size_t whole_bytes, data_bytes;
};

enum still_content {
    STILL_CODING,  /* pixels, and how they are coded */
    STILL_CODED,   /* metadata in units of the coding */
    STILL_EXIF,    /* Exif */
    STILL_COLOURS, /* ICC profile, primaries, transfer curve */
    STILL_EXTRA,   /* about other pictures in the file, which are not kept */
    STILL_BOUND,   /* invalid after a change of pixels: signatures */
    STILL_OTHER    /* other metadata */
};

/* Pixels and metadata to encode. */
struct still_source {
    const struct still_pixels *pixels;
    int quality; /* of a JPEG, 1 .. 100; 0: that of LIKE */
    /* file of the same type whose metadata will be added, and whose quality
     * and subsampling of chroma the new one gets; NULL: none */
    const struct still_file *like;
    char *said; /* [STILL_NOTE_BYTES], a text if the quality or subsampling of
                   LIKE cannot be written; may be NULL if LIKE is */
    const uint8_t *icc; /* NULL: none */
    uint8_t *exif;      /* NULL: none */
    size_t icc_bytes, exif_bytes;
};

struct still_codec {
    const char *type; /* "PNG" or "JPEG"; NULL: not built in */
    const char *extensions[3];

    /* Sets file->pixels, icc and note from file->data. On failure the caller
     * frees them. */
    enum glint_status (*decode)(struct still_file *file,
                                struct glint_error *error);

    enum glint_status (*encode)(struct still_bytes *to, const char *path,
                                const struct still_source *from,
                                struct glint_error *error);

    /* Sets PIECE to the next chunk or segment at offset *AT of DATA, 0 for the
     * first, and *AT to its end. A JPEG's last piece begins at its first scan.
     * Returns false at the end and if DATA is malformed. */
    bool (*next_piece)(struct still_piece *piece, const uint8_t *data,
                       size_t bytes, size_t *at);
    enum still_content (*classify)(const struct still_piece *piece);

    size_t head_bytes;      /* bytes of a file before its metadata */
    size_t exif_head_bytes; /* bytes of a piece before its TIFF header */
    size_t exif_max_bytes;  /* max bytes of Exif */
    /* Sets the facts about colours that chunks state. May be NULL. */
    void (*describe)(const struct still_file *file,
                     struct glint_oiio_facts *facts);
};

extern const struct still_codec glint_still_jpeg, glint_still_png;

/* Appends N bytes. */
void glint_still_append(struct still_bytes *to, const void *bytes, size_t n);

/* Appends TEXT to FILE's note. */
void glint_still_add_note(struct still_file *file, const char *text);

/* Appends to FILE's note that BYTES behind the picture are dropped, if there
 * are any. */
void glint_still_note_rest(struct still_file *file, size_t bytes);

/* Allocates the pixels of FILE, of which width, height, channels and
 * sample_bytes are set. Returns GLINT_E_UNSUPPORTED if they are too many, or
 * GLINT_E_MEMORY. */
enum glint_status glint_still_allocate(struct still_file *file,
                                       struct glint_error *error);

#endif
