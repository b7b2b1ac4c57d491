/* SPDX-License-Identifier: MIT
 *
 * Container format of all baked files. A file is one block of little-endian
 * 32-bit words, which is validated once and then used in place, in ROM or in a
 * mapped file.
 *
 *     fault = glint_blob_open(&blob, &kind, data, bytes);
 *     table = glint_blob_find_section(&blob, at, n, sizeof *table);
 *
 * The header of every file type begins with struct glint_blob_header and
 * continues with fields of its own type. The sections follow: tables in any
 * order. Header fields hold their offsets in bytes from the start of the file,
 * which are multiples of 4. The magic number identifies the file type. */
#ifndef GLINT_BASE_BLOB_H
#define GLINT_BASE_BLOB_H

#include <stddef.h>
#include <stdint.h>

#include "base/compiler.h"

struct glint_blob_header {
    uint32_t magic, version;
    uint32_t bytes;   /* size of the whole file, header included, bytes */
    uint32_t crc32;   /* CRC-32 of all bytes after this word: polynomial
                         0xedb88320, reflected, initial value and final XOR all
                         ones */
    uint32_t variant; /* enum value of the file type: which variant of its
                         format the file has */
    uint32_t key[2];  /* hash of the source and of the options of the bake, low
                         word first */
    char name[64];    /* name of the baked object, zero-terminated */
};

struct glint_blob_kind {
    uint32_t magic, version;
    /* size of the file type's header, bytes; the common header is its
     * beginning */
    size_t header_bytes;
};

enum glint_blob_fault {
    GLINT_BLOB_OK,
    GLINT_BLOB_UNALIGNED,    /* the block's address is not a multiple of 4 */
    GLINT_BLOB_FOREIGN,      /* wrong magic number, or fewer than 8 bytes */
    GLINT_BLOB_NEWER,        /* newer version than this program reads */
    GLINT_BLOB_NO_VERSION,   /* version 0, which never existed */
    GLINT_BLOB_OLDER,        /* older version than this program reads */
    GLINT_BLOB_TRUNCATED,    /* the file is shorter than its header states */
    GLINT_BLOB_LONGER,       /* the file is longer than its header states */
    GLINT_BLOB_DAMAGED,      /* the checksum is wrong */
    GLINT_BLOB_NAME_CONTROL, /* the name contains a control character */
    GLINT_BLOB_NAME_FOREIGN, /* the name contains a byte above 0x7f */
    GLINT_BLOB_NAME_ENDLESS, /* the name is not zero-terminated */
    GLINT_BLOB_NAME_EMPTY,
    GLINT_BLOB_FAULTS
};

/* Initialiser of an array of error messages, indexed by enum glint_blob_fault.
 * THING names the file type in the messages, and THINGS is its plural. DONE is
 * the participle of the operation that makes the file ("baked"). The message of
 * GLINT_BLOB_OK is NULL. */
#define GLINT_BLOB_FAULT_TEXT(thing, things, done)                          \
    {                                                                       \
        [GLINT_BLOB_UNALIGNED] = "the " thing " is not aligned to 4 bytes", \
        [GLINT_BLOB_FOREIGN] = "not a baked " thing,                        \
        [GLINT_BLOB_NEWER] =                                                \
            "the " thing " was " done " by a newer glint: update glint",    \
        [GLINT_BLOB_NO_VERSION] =                                           \
            "glint has never " done " " things " of version 0",             \
        [GLINT_BLOB_OLDER] =                                                \
            "the " thing " was " done " by an older glint: bake it again",  \
        [GLINT_BLOB_TRUNCATED] = "the " thing " is truncated",              \
        [GLINT_BLOB_LONGER] =                                               \
            "the " thing " is longer than its header states",               \
        [GLINT_BLOB_DAMAGED] =                                              \
            "the checksum is wrong: the " thing " is damaged",              \
        [GLINT_BLOB_NAME_CONTROL] = "the name has a control character",     \
        [GLINT_BLOB_NAME_FOREIGN] = "the name has a byte above 0x7f",       \
        [GLINT_BLOB_NAME_ENDLESS] = "the name is not zero-terminated",      \
        [GLINT_BLOB_NAME_EMPTY] = "the name is empty"                       \
    }

/* Checks at compile time that the struct HEADER begins with the members of
 * struct glint_blob_header. VARIANT_FIELD is the name of the member variant in
 * HEADER. */
#define GLINT_BLOB_HEADER(header, variant_field)           \
    GLINT_BLOB_SAME_PLACE(header, magic, magic);           \
    GLINT_BLOB_SAME_PLACE(header, version, version);       \
    GLINT_BLOB_SAME_PLACE(header, bytes, bytes);           \
    GLINT_BLOB_SAME_PLACE(header, crc32, crc32);           \
    GLINT_BLOB_SAME_PLACE(header, variant_field, variant); \
    GLINT_BLOB_SAME_PLACE(header, key, key);               \
    GLINT_BLOB_SAME_PLACE(header, name, name)
#define GLINT_BLOB_SAME_PLACE(header, field, as) \
    STATIC_ASSERT(offsetof(header, field) ==     \
                  offsetof(struct glint_blob_header, as))

struct glint_blob {
    const struct glint_blob_header *header;
    size_t bytes, header_bytes;
    /* total bytes that the calls of glint_blob_find_section() requested; a
     * section requested twice counts twice */
    uint64_t referred;
};

/* Checks that DATA[BYTES] is a complete file of the type KIND, in time
 * proportional to BYTES. Does not check the header members after crc32. Sets
 * BLOB to refer to the file only if there is no fault. */
enum glint_blob_fault glint_blob_open(struct glint_blob *blob,
                                      const struct glint_blob_kind *kind,
                                      const void *data, size_t bytes);

/* Checks that the name in the header is zero-terminated, not empty and safe to
 * print on a terminal. */
enum glint_blob_fault glint_blob_check_name(const struct glint_blob *blob);

/* Returns the section of COUNT items of ITEM_BYTES each, AT bytes from the
 * start of the file; NULL if it does not lie between the header and the end of
 * the file. COUNT is below 2^38 and ITEM_BYTES below 2^26, so that nothing
 * overflows. */
const void *glint_blob_find_section(struct glint_blob *blob, uint32_t at,
                                    uint64_t count, size_t item_bytes);

/* Sets size and checksum in the header of the finished file DATA[BYTES]. BYTES
 * must be at least the size of a header. */
void glint_blob_set_size_and_checksum(void *data, size_t bytes);

uint32_t glint_blob_compute_crc32(const void *data, size_t bytes);

#endif
