/* SPDX-License-Identifier: MIT
 *
 * stone_cost FILE [FRAMES [SET]] - measures the cost of the light map of a
 * baked translucent medium. Scatters light over the complete map, three
 * channels, in one thread. Prints the median CPU time of FRAMES maps, ms, and a
 * hash of the map, for each set of kernels (c, sse41, avx2, neon), or for SET
 * only. Sets run alternately. tools/measure/scenes/stone-table counts the
 * instructions of this program.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "glint/kernels.h"
#include "scene/translucent/spread.h"

enum { CHANNELS = 3, SETS = 4, MOST = 1000, LIMIT = 1 << 24 };

static const struct {
    const char *name;
    unsigned bits;
} set_of[SETS] = {{"c", 0},
                  {"sse41", GLINT_SET_SSE41},
                  {"avx2", GLINT_SET_SSE41 | GLINT_SET_AVX2},
                  {"neon", GLINT_SET_NEON}};

/* tools/measure counts the instructions of a map from the call of
 * stone_cost_frame() to the call of stone_cost_idle(). */
void stone_cost_frame(const struct glint_spread *spread,
                      struct glint_spread_scratch *scratch);
void stone_cost_idle(const struct glint_spread *spread);

void stone_cost_frame(const struct glint_spread *spread,
                      struct glint_spread_scratch *scratch)
{
    for (int c = 0; c < CHANNELS; c++)
        for (int x = 0; x < spread->width; x += GLINT_STRIP)
            glint_spread_light_in_strip(spread, c, x, 0, spread->height,
                                        scratch);
}

void stone_cost_idle(const struct glint_spread *spread)
{
    for (int c = 0; c < CHANNELS; c++)
        spread->map[c][0] = 0;
}

/* Sets the incident light to a ramp crossed by a shadow; every tenth texel is
 * bright. */
static void set_incident_light(const struct glint_spread *s)
{
    for (int c = 0; c < CHANNELS; c++)
        for (int y = 0; y < s->height; y++)
            for (int x = 0; x < s->width; x++)
                s->light[c][y * s->width + x] =
                    (int16_t)(x * 8 / s->width == 3 ? 0
                              : (x + 3 * y) % 10    ? 9000 + 40 * y
                                                    : 32767 - 500 * c);
}

static uint64_t hash_light_map(const struct glint_spread *s)
{
    uint64_t hash = UINT64_C(14695981039346656037);

    for (int c = 0; c < CHANNELS; c++)
        for (int i = 0; i < s->width * s->height; i++)
            hash = (hash ^ (uint16_t)s->map[c][i]) * UINT64_C(1099511628211);
    return hash;
}

static double cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static int is_instruction_set_selected(int set, const char *only)
{
    return only ? !strcmp(set_of[set].name, only)
                : (set_of[set].bits & ~glint_sets_here()) == 0;
}

static void time_light_map(struct glint_spread *s,
                           struct glint_spread_scratch *scratch, int frames,
                           const char *only)
{
    /* Volatile pointers prevent inlining, as instruction counters search for
     * these names. */
    void (*volatile idle)(const struct glint_spread *) = stone_cost_idle;
    void (*volatile frame)(const struct glint_spread *,
                           struct glint_spread_scratch *) = stone_cost_frame;
    static double took[SETS][MOST];
    static uint64_t hash[SETS];

    for (int i = 0; i < frames; i++)
        for (int k = 0; k < SETS; k++) {
            double start;

            if (!is_instruction_set_selected(k, only))
                continue;
            s->convolve = glint_choose_convolve_kernel(set_of[k].bits);
            idle(s);
            start = cpu_seconds();
            frame(s, scratch);
            took[k][i] = cpu_seconds() - start;
            hash[k] = hash_light_map(s);
        }
    idle(s);
    for (int k = 0; k < SETS; k++)
        if (is_instruction_set_selected(k, only)) {
            qsort(took[k], (size_t)frames, sizeof **took, compare_doubles);
            printf("%s %.3f %016llx\n", set_of[k].name,
                   1000 * took[k][frames / 2], (unsigned long long)hash[k]);
        }
}

static int time_instruction_sets(const struct glint_translucent *stone,
                                 int frames, const char *only)
{
    const int side = 1 << stone->header->side_log2;
    const size_t n = (size_t)side * (size_t)side;
    struct glint_spread s = {.stone = stone, .width = side, .height = side};
    struct glint_arena arena = glint_arena_begin_measuring();
    struct glint_spread_scratch scratch;
    int16_t *maps = calloc(2 * CHANNELS * n, sizeof *maps);
    void *mem = NULL;

    glint_spread_carve(&arena, stone, side);
    if (maps && posix_memalign(&mem, 64, arena.used) == 0) {
        arena = glint_arena_init_in_memory(mem, arena.used);
        scratch = glint_spread_carve(&arena, stone, side);
        for (size_t c = 0; c < CHANNELS; c++) {
            s.light[c] = maps + 2 * c * n;
            s.map[c] = s.light[c] + n;
        }
        set_incident_light(&s);
        time_light_map(&s, &scratch, frames, only);
    }
    free(maps);
    free(mem);
    return mem ? 0 : 1;
}

int main(int argc, char **argv)
{
    const int frames = argc > 2 ? atoi(argv[2]) : 1;
    FILE *file = argc > 1 ? fopen(argv[1], "rb") : NULL;
    void *data = malloc(LIMIT);
    struct glint_translucent stone;
    const char *reason = "it cannot be read";
    int code = 1;

    if (file && data && frames > 0 && frames <= MOST &&
        glint_translucent_open(&stone, data, fread(data, 1, LIMIT, file),
                               &reason) == GLINT_OK)
        code = time_instruction_sets(&stone, frames, argc > 3 ? argv[3] : NULL);
    else
        fprintf(stderr, "stone_cost: %s\n", reason);
    if (file)
        fclose(file);
    free(data);
    return code;
}
