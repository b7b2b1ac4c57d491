/* SPDX-License-Identifier: MIT */
#include "base/blob.h"

#include "base/compiler.h"

STATIC_ASSERT(sizeof(struct glint_blob_header) == 92);

/* ---------------------------------------------------------------------- CRC */

/* Updates the checksum CRC with N bytes. Processes 4 bits at a time, so that a
 * table of 16 words is enough. */
static uint32_t add_bytes_to_crc32(uint32_t crc, const unsigned char *byte,
                                   size_t n)
{
    static const uint32_t table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
        0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};

    for (size_t i = 0; i < n; i++) {
        crc = crc >> 4 ^ table[(crc ^ byte[i]) & 15];
        crc = crc >> 4 ^ table[(crc ^ byte[i] >> 4) & 15];
    }
    return crc;
}

uint32_t glint_blob_compute_crc32(const void *data, size_t bytes)
{
    return ~add_bytes_to_crc32(UINT32_MAX, data, bytes);
}

static uint32_t compute_file_checksum(const void *data, size_t bytes)
{
    const size_t from = offsetof(struct glint_blob_header, variant);

    return glint_blob_compute_crc32((const unsigned char *)data + from,
                                    bytes - from);
}

/* ------------------------------------------------------------------ reading */

enum glint_blob_fault glint_blob_open(struct glint_blob *blob,
                                      const struct glint_blob_kind *kind,
                                      const void *data, size_t bytes)
{
    const struct glint_blob_header *h = data;

    if ((uintptr_t)data % sizeof(uint32_t))
        return GLINT_BLOB_UNALIGNED;
    if (bytes < 2 * sizeof(uint32_t) || h->magic != kind->magic)
        return GLINT_BLOB_FOREIGN;
    if (h->version > kind->version)
        return GLINT_BLOB_NEWER;
    if (h->version == 0)
        return GLINT_BLOB_NO_VERSION;
    if (h->version < kind->version)
        return GLINT_BLOB_OLDER;
    if (bytes < kind->header_bytes || bytes < h->bytes)
        return GLINT_BLOB_TRUNCATED;
    if (bytes > h->bytes)
        return GLINT_BLOB_LONGER;
    if (compute_file_checksum(data, bytes) != h->crc32)
        return GLINT_BLOB_DAMAGED;
    *blob = (struct glint_blob){h, bytes, kind->header_bytes, 0};
    return GLINT_BLOB_OK;
}

enum glint_blob_fault glint_blob_check_name(const struct glint_blob *blob)
{
    const char *name = blob->header->name;
    size_t n = 0;

    while (n < sizeof blob->header->name && name[n]) {
        const unsigned char c = (unsigned char)name[n++];

        if (c < 0x20 || c == 0x7f)
            return GLINT_BLOB_NAME_CONTROL;
        if (c >= 0x80) /* bytes above 0x7f are unsafe to print: terminals take
                          0x9b as the start of a command */
            return GLINT_BLOB_NAME_FOREIGN;
    }
    if (n == sizeof blob->header->name)
        return GLINT_BLOB_NAME_ENDLESS;
    return n ? GLINT_BLOB_OK : GLINT_BLOB_NAME_EMPTY;
}

const void *glint_blob_find_section(struct glint_blob *blob, uint32_t at,
                                    uint64_t count, size_t item_bytes)
{
    const uint64_t all = count * item_bytes;

    blob->referred += all;
    if (at % 4 || at < blob->header_bytes || at > blob->bytes ||
        all > blob->bytes - at)
        return NULL;
    return (const unsigned char *)blob->header + at;
}

/* ------------------------------------------------------------------ writing */

void glint_blob_set_size_and_checksum(void *data, size_t bytes)
{
    struct glint_blob_header *h = data;

    h->bytes = (uint32_t)bytes;
    h->crc32 = compute_file_checksum(data, bytes);
}
