/* SPDX-License-Identifier: MIT
 *
 * Prints the contents of a baked translucent medium as text or JSON.
 */
#include "options/json_writer.h"
#include "stones/stone_file.h"

struct counts {
    /* bytes of each section of the baked medium, and of all of it */
    size_t codes, clusters, taps, all;
    /* bytes per texel, without the coefficients of the kernels */
    double each;
};

static struct counts count_medium_contents(const struct stone_file *file)
{
    const struct glint_translucent_header *h = file->stone.header;
    const size_t texels = (size_t)1 << 2 * h->side_log2;
    const size_t tables = h->variant == GLINT_TRANSLUCENT_FACTORED
                              ? 3 * h->n_planes
                          : h->variant == GLINT_TRANSLUCENT_CLUSTERED ? 6
                                                                      : 3;
    struct counts n = {.codes = tables * texels,
                       .clusters = file->stone.cluster ? texels : 0,
                       .taps = 12 * (size_t)h->n_planes * h->rank * h->kernel,
                       .all = file->bytes};

    n.each = (double)(n.codes + n.clusters) / (double)texels;
    return n;
}

static const char *
get_scatter_model_name(const struct glint_translucent_header *h)
{
    static const char *const name[] = {"clustered", "factored", "albedo"};

    return name[h->variant];
}

static void print_medium_json(const struct stone_file *file,
                              const struct counts *n)
{
    const struct glint_translucent_header *h = file->stone.header;
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{name: %s, stone: {model: %s, size: %d, texel_mm: %g, "
               "kernel: %u, planes: %u, rank: %u, index: %.5g",
               h->name, get_scatter_model_name(h), 1 << h->side_log2,
               h->texel_um / 1000., h->kernel, h->n_planes, h->rank,
               h->index_q16 / 65536.);
    if (file->is_baked_now)
        json_write(&json,
                   "fit_db: %.2f, baked_db: %.2f, kernel_loss: %.6f, "
                   "column_bits: %d, cpu_s: %.2f",
                   file->errors.fit_db, file->errors.baked_db,
                   file->errors.kernel_loss, file->errors.tap_bits,
                   file->errors.seconds);
    json_write(&json,
               "bytes_texel: %g, bytes: {codes: %zu, clusters: %zu, "
               "taps: %zu, all: %zu}}}\n",
               n->each, n->codes, n->clusters, n->taps, n->all);
}

static void print_medium_text(const struct stone_file *file,
                              const struct counts *n)
{
    const struct glint_translucent_header *h = file->stone.header;
    const int side = 1 << h->side_log2;

    printf("%s, a translucent medium of %dx%d texels of %g mm, index %.4g\n\n",
           h->name, side, side, h->texel_um / 1000., h->index_q16 / 65536.);
    printf("model        %s, %u plane%s of rank %u, kernels of %ux%u\n",
           get_scatter_model_name(h), h->n_planes, h->n_planes > 1 ? "s" : "",
           h->rank, h->kernel, h->kernel);
    if (file->is_baked_now) {
        printf("PSNR         %.1f dB against the responses of all texels, "
               "before rounding to integers %.1f dB\n",
               file->errors.baked_db, file->errors.fit_db);
        printf("rank loss    %.3g %% of the kernels' energy; columns have %d "
               "bits\n",
               100 * file->errors.kernel_loss, file->errors.tap_bits);
        printf("bake time    %.1f s of processor time\n", file->errors.seconds);
    }
    printf("per texel    %g bytes\n", n->each);
    printf("bytes        %zu\n  codes        %8zu\n", n->all, n->codes);
    if (n->clusters)
        printf("  clusters     %8zu\n", n->clusters);
    printf("  taps         %8zu\n", n->taps);
}

void stone_file_print_contents(const struct tool *tool,
                               const struct stone_file *file)
{
    const struct counts n = count_medium_contents(file);

    (tool->json ? print_medium_json : print_medium_text)(file, &n);
}
