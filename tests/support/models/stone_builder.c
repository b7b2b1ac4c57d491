/* SPDX-License-Identifier: MIT */
#include "support/models/stone_builder.h"

#include "support/test.h"

/* Sets H to a kernel of sum 1 that falls as exp(-d) / d^2, where d is the
 * distance in units of WIDTH texels. */
static void set_exponential_kernel(double *h, int kernel, double width)
{
    const int r = kernel / 2;
    double sum = 0;

    for (int v = -r; v <= r; v++)
        for (int u = -r; u <= r; u++) {
            const double d = sqrt(u * u + v * v + 1.) / width;

            h[(v + r) * kernel + u + r] = exp(-d) / (d * d);
            sum += h[(v + r) * kernel + u + r];
        }
    for (int i = 0; i < kernel * kernel; i++)
        h[i] /= sum;
}

static int is_dark_texel(int side, int x)
{
    return (x % side * 8 / side + x / side * 8 / side) % 2;
}

static void *allocate_array(size_t n, size_t bytes)
{
    void *mem = calloc(n ? n : 1, bytes);

    assert_non_null(mem);
    return mem;
}

/* Sets F to a fit of one or two kernels per channel, whose factors differ
 * between light and dark fields of a checkerboard. */
static void set_scatter_fit(struct glint_scatter_fit *f, double albedo)
{
    const size_t k2 = (size_t)(f->kernel * f->kernel);
    const size_t texels = (size_t)(f->side * f->side);

    f->h = allocate_array((size_t)f->kernels * 3 * k2, sizeof *f->h);
    for (int j = 0; j < f->kernels; j++)
        for (int c = 0; c < 3; c++)
            set_exponential_kernel(f->h + (size_t)(3 * j + c) * k2, f->kernel,
                                   (j ? 2.5 : 5.) - .7 * c);
    f->in = allocate_array(3 * texels, sizeof *f->in);
    f->f = allocate_array((size_t)f->kernels * 3 * texels, sizeof *f->f);
    f->cluster = allocate_array(texels, 1);
    f->out = allocate_array(3 * texels, sizeof *f->out);
    for (size_t x = 0; x < texels; x++) {
        const int dark = is_dark_texel(f->side, (int)x);

        f->cluster[x] = (uint8_t)(dark && f->kernels > 1);
        for (size_t c = 0; c < 3; c++) {
            f->out[3 * x + c] = albedo * (dark ? .6 : 1) * (1 - .1 * (double)c);
            f->in[3 * x + c] = dark ? .9 : 1;
            for (int j = 0; j < f->kernels; j++)
                f->f[(size_t)(3 * j) * texels + c * texels + x] =
                    f->out[3 * x + c] * (j ? (dark ? .4 : -.3) : .7);
        }
    }
}

void build_translucent_model(struct built_stone *b,
                             enum glint_scatter_model model, int side,
                             int kernel, double albedo)
{
    struct glint_error error;
    const char *reason = "";

    memset(b, 0, sizeof *b);
    b->text.stone = (struct glint_stone){.texel_mm = .61, .index = 1.5};
    b->text.fit.rank = 4;
    b->fit = (struct glint_scatter_fit){
        .model = model,
        .side = side,
        .kernel = kernel,
        .kernels = model == GLINT_SCATTER_ALBEDO ? 1 : 2,
        .rank = 4};
    set_scatter_fit(&b->fit, albedo);
    if (model != GLINT_SCATTER_CLUSTERED) {
        free(b->fit.in);
        b->fit.in = NULL;
    }
    assert_ok(glint_stone_bake(&b->fit, &b->text, "test", 7, &b->data,
                               &b->bytes, &b->report, &error));
    if (glint_translucent_open(&b->stone, b->data, b->bytes, &reason) !=
        GLINT_OK)
        fail_msg("%s", reason);
}

void free_translucent_model(struct built_stone *b)
{
    glint_scatter_fit_close(&b->fit);
    free(b->data);
    memset(b, 0, sizeof *b);
}
