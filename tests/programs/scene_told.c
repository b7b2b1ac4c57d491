/* SPDX-License-Identifier: MIT
 *
 * scene_told FILE [FIRST LAST] - draws the scenes that the cost model of scenes
 * is fitted to, a third of which are held out, and writes a line for each into
 * FILE: 1 if it is held out, what it is, and how many there are of each item.
 * For tests/scene-fit, which counts instructions by callgrind.
 *
 * Balls, rings of triangles, planes, catchers, lights, textures, mirrors,
 * samples and sizes are random, the same ones each time; of the later ones also
 * environments and brushed metal, or translucent stones of any model, size,
 * kernel, number of planes and rank.
 */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/bake.h"
#include "glint/scene/environment_bake.h"
#include "glint/scene/stone_bake.h"
#include "scenes/account.h"
#include "support/rng.h"

enum { PLAIN = 120, METAL = 75, STONE = 60, ALL = PLAIN + METAL + STONE };
enum { TEXT = 1 << 13, RING = 24, TUBE = 12, MOST_PLANES = 6 };

/* What a scene has beside things of plain colours. */
enum kind { IS_PLAIN, IS_METAL, IS_STONE };

/* What is counted: a frame in which things have moved. */
void scene_told_frame(struct scene_frame *frame,
                      const struct glint_image *image);

void scene_told_frame(struct scene_frame *frame,
                      const struct glint_image *image)
{
    const struct glint_scene_object *const first = frame->model->object;
    /* By a step of its numbers, which nobody sees. */
    const int32_t at[3] = {first->at[0] + 1, first->at[1], first->at[2]};

    glint_scene_set_pose(frame->scene, 0, at, first->turn_q30);
    scene_frame_try(frame, image);
}

static double among(uint32_t *seed, double low, double high)
{
    return low + (high - low) * rng_unit(seed);
}

struct text {
    char text[TEXT];
    size_t n;
};

static void put(struct text *t, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    t->n += (size_t)vsnprintf(t->text + t->n, TEXT - t->n, format, args);
    va_end(args);
}

static enum glint_status read_quad(uint8_t **data, size_t *bytes)
{
    static const char quad[] = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "f 1/1 2/2 3/3 4/4\n";

    *bytes = sizeof quad - 1;
    *data = malloc(sizeof quad);
    if (*data)
        memcpy(*data, quad, sizeof quad);
    return *data ? GLINT_OK : GLINT_E_MEMORY;
}

/* A ring of quads, as an OBJ text; of a name in "q" one square with places on
 * a map. */
static enum glint_status read_ring(void *ctx, const char *name, uint8_t **data,
                                   size_t *bytes, struct glint_error *error)
{
    char *const text = malloc(1 << 17);
    size_t n = 0;

    (void)ctx, (void)error;
    if (name[0] == 'q') {
        free(text);
        return read_quad(data, bytes);
    }
    for (int i = 0; text && i < RING * TUBE; i++) {
        const int row = i / TUBE;
        const double a = row * 6.2831853 / RING;
        const double b = i % TUBE * 6.2831853 / TUBE;

        n += (size_t)sprintf(text + n, "v %f %f %f\nvn %f %f %f\n",
                             (1 + .4 * cos(b)) * cos(a), .4 * sin(b),
                             (1 + .4 * cos(b)) * sin(a), cos(b) * cos(a),
                             sin(b), cos(b) * sin(a));
    }
    for (int i = 0; text && i < RING * TUBE; i++) {
        const int p = i + 1, q = i / TUBE * TUBE + (i + 1) % TUBE + 1;
        const int s = (p - 1 + TUBE) % (RING * TUBE) + 1;
        const int r = (q - 1 + TUBE) % (RING * TUBE) + 1;

        n += (size_t)sprintf(text + n, "f %d//%d %d//%d %d//%d %d//%d\n", p, p,
                             q, q, r, r, s, s);
    }
    *data = (uint8_t *)text;
    *bytes = n;
    return text ? GLINT_OK : GLINT_E_MEMORY;
}

static enum glint_status read_picture(void *ctx, const char *name,
                                      struct glint_image *image,
                                      struct glint_error *error)
{
    uint8_t *const mem = malloc(3 * 64 * 64);

    (void)ctx, (void)name, (void)error;
    for (int i = 0; mem && i < 3 * 64 * 64; i++)
        mem[i] = (uint8_t)(i * 37);
    *image =
        (struct glint_image){.format = GLINT_RGB24, .width = 64, .height = 64};
    if (mem)
        glint_image_place(image, mem);
    return mem ? GLINT_OK : GLINT_E_MEMORY;
}

/* An environment of a rising grey, and as many bright spots as the digit that
 * NAME begins with. */
static enum glint_status read_sky(void *ctx, const char *name, uint8_t **data,
                                  size_t *bytes, struct glint_error *error)
{
    enum { W = 64, H = 32 };
    static float rgb[3 * W * H];
    const struct glint_float_image picture = {W, H, rgb};
    struct glint_environment_options options;
    struct glint_environment_report report;

    (void)ctx;
    for (int i = 0; i < 3 * W * H; i++)
        rgb[i] =
            0.2F + 0.01F * (float)(i % 37) + (i / 3 / W < H / 2 ? 0.5F : 0);
    for (int k = 0; k < name[0] - '0'; k++)
        for (int c = 0; c < 3; c++)
            rgb[3 * ((6 + 3 * (k % 3)) * W + 5 + 12 * k) + c] = 4000;
    glint_environment_defaults(&options);
    options.side_log2 = GLINT_ENVIRONMENT_LEAST_LOG2 + 1;
    return glint_environment_bake(&picture, &options, "sky", 1, data, bytes,
                                  &report, error);
}

/* Sets FIT of TEXELS to even factors and to bells, which are products and so
 * quickly taken apart: what it costs to draw is what counts. */
static void fill_fit(struct glint_scatter_fit *fit, int texels)
{
    const int k = fit->kernel, r = k / 2;

    for (int i = 0; i < 3 * fit->kernels * k * k; i++) {
        const int u = i % k - r, v = i / k % k - r;

        fit->h[i] = exp(-(u * u + v * v) / (1. + r * r)) / (2 * k * k);
    }
    for (int i = 0; i < 3 * texels; i++) {
        fit->in[i] = fit->out[i] = .8;
        for (int j = 0; j < fit->kernels; j++)
            fit->f[3 * j * texels + i] = .8 / (1 + j);
    }
    for (int i = 0; i < texels; i++)
        fit->cluster[i] = (uint8_t)(i / 8 % fit->kernels);
}

/* A stone of the model, side, kernel, planes and rank that NAME says. */
static enum glint_status read_stone(void *ctx, const char *name, uint8_t **data,
                                    size_t *bytes, struct glint_error *error)
{
    enum { SIDE = 128, KERNEL = 29 };
    static double h[MOST_PLANES * 3 * KERNEL * KERNEL];
    static double in[3 * SIDE * SIDE], out[3 * SIDE * SIDE];
    static double f[MOST_PLANES * 3 * SIDE * SIDE];
    static uint8_t cluster[SIDE * SIDE];
    struct glint_scatter_fit fit = {
        .h = h, .in = in, .out = out, .f = f, .cluster = cluster};
    struct glint_stone_report report;
    struct glint_stone_text text;
    int model, rank;

    (void)ctx;
    glint_stone_text_defaults(&text);
    if (sscanf(name, "s%d-%d-%d-%d-%d", &model, &fit.side, &fit.kernel,
               &fit.kernels, &rank) != 5)
        return GLINT_E_FORMAT;
    fill_fit(&fit, fit.side * fit.side);
    fit.model = (enum glint_scatter_model)model;
    text.fit.rank = fit.rank = rank;
    if (fit.model != GLINT_SCATTER_CLUSTERED)
        fit.cluster = NULL;
    return glint_stone_bake(&fit, &text, "stone", 1, data, bytes, &report,
                            error);
}

static void put_stone(struct text *t, int k, uint32_t *seed)
{
    static const int kernels[] = {5, 9, 15, 21, 29};
    const int model = rng_below(seed, 3), side = 32 << rng_below(seed, 3);
    const int kernel = kernels[rng_below(seed, 5)];
    const int planes = 1 + rng_below(seed, MOST_PLANES);
    const int rank = 1 + rng_below(seed, 4);

    put(t, "material m%d translucent s%d-%d-%d-%d-%d %s\n", k, model, side,
        kernel, model == GLINT_SCATTER_ALBEDO ? 1 : planes, rank,
        rng_below(seed, 2) ? "coat ward specular .04 .04 .04 alpha .1 .1" : "");
}

static void put_metal(struct text *t, int k, uint32_t *seed)
{
    static const double alpha[] = {.01, .05, .1, .2};
    const double a = alpha[rng_below(seed, 4)];
    const char *const diffuse = rng_below(seed, 2) ? "diffuse .1 .1 .1" : "";
    const double b = rng_below(seed, 2) ? a : 2 * a;

    put(t, "material m%d ward specular .9 .8 .7 alpha %g %g %s\n", k, a, b,
        diffuse);
}

static void turn_dials(bool is_metal, uint32_t *seed, struct scene_dials *dials)
{
    static const int widths[] = {160, 240, 320};
    static const int samples[] = {1, 4, 4};
    static const int points[] = {1, 4, 4, 16};
    static const int lookups[] = {1, 4, 8, 16, 32};

    *dials = (struct scene_dials){.width = widths[rng_below(seed, 3)],
                                  .edge_samples = samples[rng_below(seed, 3)],
                                  .shadow_points = points[rng_below(seed, 4)],
                                  .half_shading = rng_below(seed, 4) == 0};
    if (is_metal) {
        dials->ward_samples = lookups[rng_below(seed, 5)];
        dials->ward_nearest = rng_below(seed, 3) == 0;
    }
    dials->height = dials->width * 9 / 16;
}

static void put_materials(struct text *t, enum kind kind, uint32_t *seed)
{
    static const char *const ends[] = {
        "", "", "", "", "texture t", "reflect .5", "pass .8 refract 1.4"};

    for (int k = 0; k < 4; k++) {
        const char *end, *specular;

        if (kind == IS_METAL && rng_below(seed, 3)) {
            put_metal(t, k, seed);
            continue;
        }
        if (kind == IS_STONE && (k == 0 || rng_below(seed, 2))) {
            put_stone(t, k, seed);
            continue;
        }
        end = ends[rng_below(seed, 7)];
        specular = rng_below(seed, 3) ? ".3" : "0";
        put(t, "material m%d phong .1 .6 %s colour .9 .5 .2 power 40 %s\n", k,
            specular, end);
    }
}

static void put_rings(struct text *t, bool is_metal, uint32_t *seed)
{
    int n;

    if (is_metal && rng_below(seed, 2))
        put(t, "material ring ward specular .9 .8 .6 alpha .1 .2\n");
    else
        put(t, "material ring phong .1 .6 .3 colour .9 .6 .2 power 12 %s\n",
            rng_below(seed, 6) ? "" : "reflect .4");
    n = rng_below(seed, 3);
    for (int k = 0; k < n; k++) {
        const double turn = among(seed, 0, 90), size = among(seed, .2, .7);
        const double z = among(seed, -1, .5), x = among(seed, -1.2, 1.2);

        put(t,
            "mesh r%d r.obj at %f .4 %f scale %f turn 1 0 0 %f material "
            "ring\n",
            k, x, z, size, turn);
    }
}

/* Puts N suns, and sometimes a lamp. */
static void put_lights(struct text *t, int n, uint32_t *seed)
{
    for (int k = 0; k < n; k++) {
        const double z = among(seed, -.2, 1), y = among(seed, .2, 1);
        const double x = among(seed, -1, 1);

        put(t, "light sun direction %f %f %f colour 5e4 5e4 5e4 radius .27\n",
            x, y, z);
    }
    if (rng_below(seed, 3) == 0) {
        const char *const radius = rng_below(seed, 2) ? " radius .1" : "";
        const double y = among(seed, 1, 4), x = among(seed, -2, 2);

        put(t, "light lamp at %f %f 2 colour 6 6 6%s\n", x, y, radius);
    }
}

/* Writes scene I. */
static void write_scene(int i, struct text *t, struct scene_dials *dials)
{
    uint32_t seed = 2654435761u * (uint32_t)(i + 1);
    const enum kind kind = i < PLAIN           ? IS_PLAIN
                           : i < PLAIN + METAL ? IS_METAL
                                               : IS_STONE;
    const bool is_metal = kind == IS_METAL;
    int n;

    for (int k = 0; k < 8; k++)
        rng_bits(&seed);
    turn_dials(is_metal, &seed, dials);
    t->n = 0;
    put(t, "camera fov 50 at 0 1.2 %f toward 0 .4 0\ntexture t x.ppm\n",
        among(&seed, 3, 9));
    n = 1 + rng_below(&seed, 2);
    put_lights(t, n, &seed);
    put_materials(t, kind, &seed);
    n = 1 + rng_below(&seed, 5);
    for (int k = 0; k < n; k++) {
        const int material = rng_below(&seed, 4);
        const double radius = among(&seed, .1, .5), z = among(&seed, -1.5, 1.5);
        const double y = among(&seed, .1, 1), x = among(&seed, -1.6, 1.6);

        put(t, "sphere s%d at %f %f %f radius %f material m%d\n", k, x, y, z,
            radius, material);
    }
    put_rings(t, is_metal, &seed);
    if (kind == IS_STONE && rng_below(&seed, 2))
        put(t, "mesh q q.obj scale %f at 0 .5 %f turn 0 1 0 20 material m0\n",
            among(&seed, .2, .8), -.5);
    if (rng_below(&seed, 2))
        put(t, "plane p at 0 0 0 normal 0 1 0 %s\n",
            rng_below(&seed, 3) || kind == IS_STONE ? "catcher .6"
                                                    : "material m0");
    put(t, "shadow %s\n", rng_below(&seed, 5) ? "on" : "off");
    if (is_metal || (kind == IS_STONE && rng_below(&seed, 2)))
        put(t, "environment %d.sky\n", rng_below(&seed, 5));
}

static int bake(const struct text *t, struct glint_scene_model *model,
                unsigned char **data)
{
    static struct glint_description scene;
    const struct glint_description_files files = {
        NULL, read_ring, read_picture, read_sky, NULL, read_stone};
    struct glint_scene_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";
    size_t bytes = 0;
    enum glint_status status = glint_description_parse(
        &scene, t->text, t->n, "told.scene", &files, &error);

    if (status == GLINT_OK) {
        status =
            glint_scene_bake(&scene, "told", 1, data, &bytes, &report, &error);
        glint_description_free(&scene);
    }
    if (status == GLINT_OK)
        status = glint_scene_open(model, *data, bytes, &reason);
    if (status != GLINT_OK)
        fprintf(stderr, "scene_told: %s%s\n%s", error.text, reason, t->text);
    return status == GLINT_OK;
}

/* The last third of each kind is. */
static int is_held(int i)
{
    return i < PLAIN           ? i >= PLAIN * 2 / 3
           : i < PLAIN + METAL ? i >= PLAIN + METAL * 2 / 3
                               : i >= PLAIN + METAL + STONE * 2 / 3;
}

static int draw(int i, FILE *to)
{
    static struct text text;
    /* Not inlined: counters look for its name. */
    void (*volatile counted)(struct scene_frame *, const struct glint_image *) =
        scene_told_frame;
    const struct tool tool = {.name = "scene_told", .n_threads = 1};
    struct glint_image image = {.format = GLINT_I420};
    struct glint_scene_model model;
    struct scene_account account;
    struct scene_dials dials;
    struct scene_frame frame;
    unsigned char *data = NULL;
    uint8_t *mem;
    int is_done = 0;

    write_scene(i, &text, &dials);
    image.width = dials.width;
    image.height = dials.height;
    mem = calloc(1, glint_image_bytes(image.format, image.width, image.height));
    if (mem && bake(&text, &model, &data) &&
        scene_frame_open(&frame, &tool, &model, &dials) == EXIT_OK) {
        glint_image_place(&image, mem);
        scene_frame_try(&frame, &image);
        counted(&frame, &image);
        is_done = scene_account_make(&account, &frame) == GLINT_OK;
        if (is_done) {
            fprintf(to, "%d %d", is_held(i), i);
            for (int k = 0; k < GLINT_SCENE_ITEMS; k++)
                fprintf(to, " %" PRId64, account.all.count[k]);
            for (int k = 0; k < SCENE_COST_RESTS; k++)
                fprintf(to, " %.0f", account.rest[k]);
            fprintf(to, "\n");
            scene_account_free(&account);
        }
        scene_frame_close(&frame);
    }
    free(data);
    free(mem);
    return is_done;
}

int main(int argc, char **argv)
{
    const int first = argc == 4 ? atoi(argv[2]) : 0;
    const int last = argc == 4 ? atoi(argv[3]) : ALL - 1;
    FILE *const to = argc == 2 || argc == 4 ? fopen(argv[1], "w") : NULL;
    int is_done = to != NULL;

    for (int i = first; is_done && i <= last && i < ALL; i++)
        is_done = draw(i, to);
    if (to && fclose(to) != 0)
        is_done = 0;
    if (!is_done)
        fprintf(stderr, "scene_told FILE [FIRST LAST]: it was not written\n");
    return !is_done;
}
