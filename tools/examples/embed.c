/* SPDX-License-Identifier: MIT
 *
 * embed LENS IN.ppm >OUT.ppm - adds the flare of the lamps in a picture. The
 * result equals that of glint overlay --stop polygon:8 --coating table. LENS is
 * a baked model; without EMBED_MODELS it may also be a lens table.
 */
#include <stdio.h>
#include <stdlib.h>

#include "glint/bake.h"
#include "glint/engine.h"

static unsigned char *read_file(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    unsigned char *data = (unsigned char *)calloc(1, 1 << 28);

    *bytes = file && data ? fread(data, 1, (1 << 28) - 1, file) : 0;
    if (file)
        fclose(file);
    return data;
}

int main(int argc, char **argv)
{
    static struct glint_engine_lamp lamps[64];
    static struct glint_image image;
    struct glint_engine_config cfg;
    struct glint_engine_report report;
    struct glint_error error = {"cannot read the picture, or out of memory"};
    struct glint_engine *engine = NULL;
    struct glint_lens lens;
    size_t lens_bytes, bytes;
    unsigned char *model = read_file(argc == 3 ? argv[1] : "", &lens_bytes);
    unsigned char *picture = read_file(argc == 3 ? argv[2] : "", &bytes);
    const char *reason = "";
    int begin = 0, n, bad = 1;
#ifndef EMBED_MODELS
    static struct glint_prescription table;
    struct glint_bake_options options;
    struct glint_bake_report baked;

    if (argc == 3 && glint_prescription_parse(&table, (char *)model, lens_bytes,
                                              argv[1], &error) == GLINT_OK) {
        glint_bake_defaults(&options);
        free(model);
        glint_bake(&table, &options, &model, &lens_bytes, &baked, &error);
    }
#endif
    if (glint_lens_open(&lens, model, lens_bytes, &reason) == GLINT_OK &&
        sscanf((char *)picture, "P6 %d %d 255%*c%n", &image.width,
               &image.height, &begin) == 2 &&
        (double)bytes == begin + 3.0 * image.width * image.height) {
        image.format = GLINT_RGB24;
        glint_image_place(&image, picture + begin);
        glint_engine_defaults(&cfg, image.width, image.height);
        cfg.model = &lens;
        if (glint_engine_create(&engine, &cfg, &error) == GLINT_OK) {
            n = glint_engine_find(engine, &image, 0, lamps, 64);
            bad = !!glint_engine_draw(engine, lamps, n, &image, &report);
        }
    }
    glint_engine_destroy(engine);
    if (bad || fwrite(picture, 1, bytes, stdout) != bytes)
        fprintf(stderr, "embed: %s %s\n", error.text, reason);
    free(picture);
    free(model);
    return bad;
}
