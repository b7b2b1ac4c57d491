/* SPDX-License-Identifier: MIT
 *
 * Opens random bytes as a baked motion, with valid magic, version, size and
 * checksum, both in memory and for reading by blocks. If the file is accepted
 * in memory, all its frames must be readable. A frame read by blocks must equal
 * the frame in memory, or its blocks must be rejected.
 *
 *     make fuzz FUZZ=motion SECONDS=60
 */
#include "fuzz/fuzz.h"
#include "glint/scene/motion.h"

struct file {
    const uint8_t *data;
    uint32_t n_blocks;
};

/* Copies block BLOCK of the file to TO and sets its number and checksum to
 * valid values. */
static int read_motion_block(void *ctx, uint32_t block, uint8_t *to)
{
    const struct file *file = ctx;
    uint32_t *const end = (void *)(to + GLINT_MOTION_ROOM);

    require(block < file->n_blocks);
    memcpy(to, file->data + (size_t)block * GLINT_MOTION_BLOCK,
           GLINT_MOTION_BLOCK);
    end[0] = block;
    end[1] = glint_motion_sum(to, block);
    return 1;
}

static void check_motion_by_blocks(const uint8_t *data, size_t size,
                                   struct glint_motion *whole)
{
    static uint32_t buffer[GLINT_MOTION_BLOCK / 4];
    struct file file = {data, (uint32_t)(size / GLINT_MOTION_BLOCK)};
    const struct glint_motion_blocks blocks = {&file, read_motion_block,
                                               file.n_blocks};
    struct glint_motion motion;
    const char *reason = NULL;

    if (glint_motion_over(&motion, &blocks, (uint8_t *)buffer, &reason) !=
        GLINT_OK) {
        require(reason && *reason && !whole);
        return;
    }
    for (uint32_t k = 0; k < motion.header.n_frames && k < 4096; k++) {
        struct glint_motion_frame a, b;

        memset(&a, 0, sizeof a);
        memset(&b, 0, sizeof b);
        if (glint_motion_frame(&motion, k, &a) == GLINT_OK && whole) {
            require(glint_motion_frame(whole, k, &b) == GLINT_OK);
            require(memcmp(&a, &b, sizeof a) == 0);
        } else {
            require(!whole);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char *copy = fuzz_copy(data, size);
    struct glint_motion motion;
    const char *reason = NULL;
    uint32_t *const word = (void *)copy;
    int is_whole;

    if (size >= sizeof(struct glint_motion_header)) {
        word[0] = GLINT_MOTION_MAGIC;
        word[1] = GLINT_MOTION_VERSION;
        glint_blob_set_size_and_checksum(copy, size);
    }
    is_whole = glint_motion_open(&motion, copy, size, &reason) == GLINT_OK;
    require(is_whole || (reason && *reason));
    check_motion_by_blocks(copy, size, is_whole ? &motion : NULL);
    free(copy);
    return 0;
}
