/* SPDX-License-Identifier: MIT
 *
 * Writes hostile models (tests/support/models/hostile.h) as files, for the
 * command itself: FAMILY-NUMBER.glint into FOLDER. Some are edited copies of
 * MODEL. Prints each name, and the family in words.
 *
 *     build/.../hostile_models MODEL FOLDER
 */
#include <stdio.h>
#include <stdlib.h>

#include "support/models/hostile.h"

/* Opens the model file PATH, whose memory is never freed. Returns NULL if it
 * cannot be read. */
static const struct glint_lens *read_model_file(const char *path)
{
    static uint32_t data[1 << 18];
    static struct glint_lens lens;
    FILE *const file = fopen(path, "rb");
    const size_t bytes = file ? fread(data, 1, sizeof data, file) : 0;
    const char *reason = "cannot be read";

    if (file)
        fclose(file);
    if (glint_lens_open(&lens, data, bytes, &reason) == GLINT_OK)
        return &lens;
    fprintf(stderr, "%s: %s\n", path, reason);
    return NULL;
}

static bool write_model_file(const struct model_image *m, const char *folder,
                             int family, int number)
{
    char path[4096];
    FILE *file;
    bool written;

    snprintf(path, sizeof path, "%s/%d-%d.glint", folder, family, number);
    file = fopen(path, "wb");
    written = file && fwrite(m->data, 1, m->bytes, file) == m->bytes;
    if (file)
        written = !fclose(file) && written;
    if (written)
        printf("%d-%d.glint %s\n", family, number, hostile_name[family]);
    else
        perror(path);
    return written;
}

int main(int argc, char **argv)
{
    const struct glint_lens *const baked =
        argc == 3 ? read_model_file(argv[1]) : NULL;

    if (!baked) {
        fprintf(stderr, "usage: %s MODEL FOLDER\n", argv[0]);
        return 2;
    }
    for (int k = 0; k < HOSTILE_FAMILIES * HOSTILE_EACH; k++) {
        const int family = k / HOSTILE_EACH, number = k % HOSTILE_EACH;
        struct hostile_scene scene;
        bool written;

        hostile_make_scene(&scene, (enum hostile_family)family, number, baked);
        written = write_model_file(&scene.model, argv[2], family, number);
        if (!written)
            return 1;
    }
    return 0;
}
