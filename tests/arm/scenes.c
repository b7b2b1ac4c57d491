/* SPDX-License-Identifier: MIT
 *
 * scenes SET N MODEL... - draws N random frames with the run-time half and
 * prints a hash of all output, which is the same on every CPU, compiler target
 * and set of kernels. SET is c, sse41, avx2, neon or best.
 *
 *     240 scenes, 236 with light, 1b3f...
 *
 * Models, directions, powers, formats, sizes, tiles and, in every second frame,
 * stars are random, by integers only so as not to depend on libm. Lamps are
 * then found in each image and added to the hash. With GLINT_EACH set, the hash
 * after each frame is printed as well. Exit code 3: a model is invalid.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arm/kinds.h"
#include "base/real.h"
#include "glint/glint.h"
#include "posix/input.h"
#include "support/stars/any.h"
#include "support/shuffle.h"
#include "support/rng.h"

enum {
    MAX_MODELS = 16,
    MAX_LIGHTS = 12,
    MAX_SPOTS = 32,
    ARENA_BYTES = 48 << 20,
    FINDER_BYTES = 8 << 20,
    STAR_BYTES = 1 << 20
};

static struct glint_lens lens[MAX_MODELS];
static int n_models;
static unsigned sets;
static uint32_t seed = 2026;
static void *arena, *finder_memory, *star_memory;

/* Returns a random number of 0 .. BELOW - 1. A statement may call it only
 * once, as C does not define the order in which arguments are evaluated. */
static int random_number(int below)
{
    return (int)(rng_xorshift(&seed) % (uint32_t)below);
}

/* ----------------------------------------------------------- random scenes */

/* Sets *SINE and *COSINE, Q30, to sine and cosine of the angle 2 atan(T /
 * 2^15), by integers only. */
static void set_sine_and_cosine(int32_t t, int32_t *sine, int32_t *cosine)
{
    const int64_t one = INT64_C(1) << 30, t2 = (int64_t)t * t;

    *sine = (int32_t)((((int64_t)t << 46) / (one + t2)));
    *cosine = (int32_t)(((one - t2) << 30) / (one + t2));
}

static void make_random_beam(struct glint_light *b)
{
    int32_t sine, cosine;
    int exponent;

    b->apart_q30 = 0; /* a single light, not one point of a lamp */
    set_sine_and_cosine(random_number(7000), &b->sine_q30,
                        /* The light is at most 24 degrees off the axis. */
                        &b->cosine_q30);
    set_sine_and_cosine(random_number(1 << 15), &sine, &cosine);
    b->sin_q30 = random_number(2) ? sine : -sine;
    b->cos_q30 = random_number(2) ? cosine : -cosine;
    exponent = random_number(14) - 20;
    b->power = real_of(1 + random_number(1 << 30), exponent);
    for (int c = 0; c < 3; c++)
        b->rgb_q14[c] = 4096 + random_number(12289);
}

static void make_random_wavelengths(struct glint_wave wave[3])
{
    static const struct glint_wave plain[3] = {
        {39709472, {16384, 1200, 0}, {0, 0}},  /* 650 nm */
        {59279172, {0, 16384, 900}, {0, 0}},   /* 532 nm */
        {82850510, {700, -300, 16384}, {0, 0}} /* 450 nm */
    };

    for (int i = 0; i < 3; i++) {
        wave[i] = plain[i];
        wave[i].weight = real_of(1 + random_number(1 << 20), -30);
    }
}

static struct glint_flare_config make_random_config(struct shuffle *shuffle)
{
    static const int32_t side[4][2] = {
        {1 << 30, 0}, {0, 1 << 30}, {-(1 << 30), 0}, {0, -(1 << 30)}};
    struct glint_flare_config c = {.workers = &shuffle->workers,
                                   .sets = sets,
                                   .max_bundles = MAX_LIGHTS * 3 * 512,
                                   .max_primitives = 150000,
                                   .max_refs = 600000};

    c.width = 1 + random_number(400);
    c.height = 1 + random_number(300);
    c.tile_log2 = 3 + random_number(4);
    init_shuffled_workers(shuffle, 1 + (int)(seed % 4), seed);
    c.irradiance_steps = random_number(3) * 30;
    c.dither = random_number(2);
    if (random_number(2)) {
        c.stop.n_blades = 4;
        c.stop.apothem_q16 = 46341;
        memcpy(c.stop.normal_q30, side, sizeof side);
    }
    return c;
}

static uint64_t hash_light_image(uint64_t h, const struct glint_image *image)
{
    struct glint_lamp_finder_config c;
    struct glint_lamp_finder *finder;
    struct glint_spot spot[MAX_SPOTS];
    int n;

    glint_lamp_finder_defaults(&c, image->width, image->height);
    c.threshold_high_q8 = -random_number(512);
    c.threshold_low_q8 = c.threshold_high_q8 - random_number(512);
    c.judge = random_number(2);
    c.keep_faint = random_number(2);
    if (image->format == GLINT_LINEAR_Q20 ||
        glint_lamp_finder_init(&finder, &c, finder_memory, FINDER_BYTES) !=
            GLINT_OK)
        return h;
    n = glint_lamp_finder_find(finder, image, spot, MAX_SPOTS);
    for (int i = 0; i < n; i++) {
        const struct glint_spot *s = &spot[i];
        const int64_t all[] = {s->x_q8,       s->y_q8,       s->size_q8,
                               s->area,       s->n_clipped,  s->flux_q16,
                               s->rgb_q15[0], s->rgb_q15[1], s->rgb_q15[2]};

        for (size_t k = 0; k < sizeof all / sizeof *all; k++)
            h = kinds_hash_number(h, all[k]);
    }
    return kinds_hash_number(h, n);
}

/* Draws the binned ghosts of FLARE and the starbursts of up to MAX_LIGHTS
 * lamps. */
static void draw_starbursts(const struct glint_flare_config *c,
                            struct glint_flare *flare,
                            const struct glint_image *image)
{
    static struct star_any any;
    const struct glint_star_config star_config = {c->workers->n, c->width,
                                                  c->height, MAX_LIGHTS};
    struct glint_star_light light[MAX_LIGHTS];
    struct glint_star *star;
    const int n = 1 + random_number(MAX_LIGHTS);
    const struct glint_real faintest =
        random_number(2) ? real_of(1, -13) : real_of(0, 0);

    if (glint_star_init(&star, &star_config, star_memory, STAR_BYTES) !=
        GLINT_OK) {
        fputs("scenes: the star's memory is too small\n", stderr);
        exit(1);
    }
    star_make_random(&any, &seed);
    for (int i = 0; i < n; i++)
        light[i] = star_make_random_light(c->width, c->height, &seed);
    glint_star_set_lights(star, &any.tables, light, n, faintest);
    glint_star_draw(star, flare, image);
}

static void draw_random_flare(const struct glint_flare_config *c,
                              const struct glint_image *image)
{
    struct glint_light light[MAX_LIGHTS];
    struct glint_wave wave[3];
    struct glint_flare_stats stats;
    struct glint_flare *flare;
    struct glint_flare_frame rays = {.wave = wave,
                                     .pixels_per_mm = real_of(image->width, -5),
                                     .only_ghost = -1};
    const int n_given = 1 + random_number(MAX_LIGHTS);
    const int most = 1 + random_number(MAX_LIGHTS);
    const int32_t near_q30 = 1 << random_number(24);
    int n, n_apart;

    if (glint_flare_init(&flare, c, arena, ARENA_BYTES) != GLINT_OK) {
        fputs("scenes: the arena is too small\n", stderr);
        exit(1);
    }
    rays.lens = &lens[random_number(n_models)];
    rays.n_waves = 1 + random_number(3);
    rays.fineness = 8 << random_number(4);
    rays.half = random_number(3) == 0 ? &glint_half : NULL;
    make_random_wavelengths(wave);
    for (int i = 0; i < n_given; i++)
        make_random_beam(&light[i]);
    if (image->format != GLINT_LINEAR_Q20)
        rays.faintest = real_of(1, -13);
    n = glint_lights_merge(light, n_given, near_q30, most, &n_apart);
    glint_flare_plan(flare, &rays, light, n);
    glint_flare_bin(flare, &stats);
    if (random_number(2))
        draw_starbursts(c, flare, image);
    else
        glint_flare_draw(flare, image);
}

/* Draws a random frame and adds its image to the hash *H. Returns whether the
 * frame contains light. */
static int hash_random_frame(uint64_t *h)
{
    struct shuffle shuffle;
    const struct glint_flare_config c = make_random_config(&shuffle);
    struct glint_image image = {
        .format = (enum glint_pixel_format)random_number(GLINT_RGB565 + 1),
        .width = c.width,
        .height = c.height};
    const size_t bytes = glint_image_bytes(image.format, c.width, c.height);
    uint8_t *mem = malloc(bytes);
    uint64_t before, after;

    if (!mem)
        exit(1);
    kinds_fill_image(&image, mem, bytes, &seed);
    before = hash_bytes(HASH_START, mem, bytes);
    draw_random_flare(&c, &image);
    after = hash_bytes(HASH_START, mem, bytes);
    *h = hash_light_image(kinds_hash_number(*h, (int64_t)(after >> 1)), &image);
    free(mem);
    return before != after;
}

/* ------------------------------------------------------------ command line */

static void open_model(const char *path)
{
    struct glint_error error = {""};
    const char *reason = "";
    uint8_t *data;
    size_t bytes;

    if (glint_input_read_whole_file(&data, &bytes, path, 1 << 28, &error) !=
            GLINT_OK ||
        glint_lens_open(&lens[n_models], data, bytes, &reason) != GLINT_OK) {
        fprintf(stderr, "scenes: %s: %s%s\n", path, error.text, reason);
        exit(3);
    }
    n_models++;
}

int main(int argc, char **argv)
{
    const int n = argc > 3 ? atoi(argv[2]) : 0;
    uint64_t h = HASH_START;
    int lit = 0;

    if (n < 1 || argc - 3 > MAX_MODELS) {
        fputs("scenes SET N MODEL...\n", stderr);
        return 2;
    }
    sets = kinds_parse_sets("scenes", argv[1]);
    for (int i = 3; i < argc; i++)
        open_model(argv[i]);
    if (posix_memalign(&arena, 64, ARENA_BYTES) != 0 ||
        posix_memalign(&finder_memory, 64, FINDER_BYTES) != 0 ||
        posix_memalign(&star_memory, 64, STAR_BYTES) != 0)
        return 1;
    for (int i = 0; i < n; i++) {
        lit += hash_random_frame(&h);
        /* With the hash of every frame, the first different line identifies the
         * frame. */
        if (getenv("GLINT_EACH"))
            printf("%d %08lx\n", i, (unsigned long)(h >> 32));
    }
    printf("%d scenes, %d with light, %08lx%08lx\n", n, lit,
           (unsigned long)(h >> 32), (unsigned long)(h & 0xffffffff));
    return 0;
}
