/* SPDX-License-Identifier: MIT
 *
 * Checks that the parser of translucent media reads values, sets defaults, and
 * reports errors with their positions.
 */
#include "bake/translucent/slab.h"
#include "glint/scene/stone_bake.h"
#include "support/test.h"

#define TWO                                      \
    "stone pale scatter 2 3 4 absorb .1 .2 .3\n" \
    "stone dark scatter .5 .6 .7 absorb 1 2 3\n"

static enum glint_status parse_medium_text(struct glint_stone_text *t,
                                           const char *text,
                                           struct glint_error *error)
{
    return glint_stone_parse(t, text, strlen(text), "x", error);
}

static void parse_valid_medium_text(struct glint_stone_text *t,
                                    const char *text)
{
    struct glint_error error = {.text = ""};

    if (parse_medium_text(t, text, &error) != GLINT_OK)
        fail_msg("%s: %s", text, error.text);
}

TEST(parses_all_lines)
{
    struct glint_stone_text t;

    parse_valid_medium_text(
        &t, "# a comment\nsize 64\ntexel .25\nkernel 15\nslab 12\nindex 1.3\n"
            "\n" TWO "pattern chess 4 pale dark\nmodel factored\n");
    assert_int_equal(t.stone.side, 64);
    assert_true(t.stone.texel_mm == .25 && t.stone.slab_mm == 12 &&
                t.stone.index == 1.3);
    assert_int_equal(t.stone.kernel, 15);
    assert_int_equal(t.stone.pattern, GLINT_STONE_CHESS);
    assert_int_equal(t.stone.fields, 4);
    assert_true(t.stone.material[0].scatter[2] == 4 &&
                t.stone.material[1].absorb[1] == 2);
    assert_int_equal(t.fit.model, GLINT_SCATTER_FACTORED);
    assert_int_equal(t.fit.kernels, 5);
    assert_int_equal(t.fit.rank, 3);
}

/* Checks that omitted lines have the defaults in the README. */
TEST(omitted_lines_have_defaults)
{
    struct glint_stone_text t;

    parse_valid_medium_text(&t, "stone pale scatter 2 3 4 absorb .1 .2 .3\n");
    assert_int_equal(t.stone.side, 128);
    assert_int_equal(t.stone.kernel, 29);
    assert_true(t.stone.texel_mm == .61 && t.stone.slab_mm == 6 &&
                t.stone.index == 1.5);
    assert_int_equal(t.stone.pattern, GLINT_STONE_EVEN);
    assert_int_equal(t.fit.model, GLINT_SCATTER_CLUSTERED);
    assert_int_equal(t.fit.kernels, 4);
    assert_int_equal(t.fit.rank, 3);
    parse_valid_medium_text(&t,
                            TWO "pattern veins 3 pale dark\nmodel factored\n");
    assert_int_equal(t.fit.kernels, 5);
    assert_int_equal(t.stone.seed, 3);
}

/* Checks that the first medium named in a pattern is material 0, whatever the
 * order in which media are defined. */
TEST(first_medium_of_a_pattern_is_material_0)
{
    struct glint_stone_text t;

    parse_valid_medium_text(&t, TWO "pattern image a.pgm dark pale\n");
    assert_string_equal(t.mask, "a.pgm");
    assert_true(t.stone.material[0].scatter[0] == .5 &&
                t.stone.material[1].scatter[0] == 2);
    parse_valid_medium_text(&t, "model clustered\ndata rows of it.pfm\n");
    assert_string_equal(t.rows, "rows of it.pfm");
    assert_int_equal(t.fit.kernels, 4);
    parse_valid_medium_text(&t, "data a.pfm\nmodel albedo\n");
    assert_int_equal(t.fit.kernels, 1);
}

static const struct {
    const char *text, *error;
} wrong[] = {
    {"", "x:1:1: a line 'stone NAME"},
    {"size 96\n", "x:1:6: size must be 32, 64, 128 or 256, not 96"},
    {"size 16\n", "x:1:6: "},
    {"size 512\n", "x:1:6: "},
    {"kernel 14\n", "x:1:8: kernel must be an odd number, 1 to 63, not 14"},
    {"kernel 65\n", "x:1:8: "},
    {"kernel 0\n", "x:1:8: "},
    {"texel 0\n", "x:1:7: "},
    {"texel 100.1\n", "x:1:7: "},
    {"slab .05\n", "x:1:6: "},
    {"index .9\n", "x:1:7: "},
    {"index nan\n", "x:1:7: "},
    {"size\n", "x:1:5: "},
    {"size 32 32\n", "x:1:9: "},
    {"size 32\nsize 64\n", "x:2:1: a second size; the first is on line 1"},
    {"sizes 32\n", "x:1:1: unknown word 'sizes'; did you mean 'size'?"},
    {"model tucker\n",
     "x:1:7: model accepts clustered, factored or albedo, not 'tucker'"},
    {"stone a scatter 1 1 1\n", "x:1:"},
    {"stone a scatter 0 1 1 absorb 0 0 0\n", "x:1:17: "},
    {"stone a scatter 1 1 1 absorb -1 0 0\n", "x:1:30: "},
    {TWO "stone third scatter 1 1 1 absorb 0 0 0\n",
     "x:3:7: more than 2 stones"},
    {"stone a scatter 1 1 1 absorb 0 0 0\n"
     "stone a scatter 1 1 1 absorb 0 0 0\n",
     "x:2:7: a stone of this name is already defined"},
    {TWO, "two stones need a pattern"},
    {TWO "pattern stripes 3 pale dark\n",
     "x:3:9: a pattern must be chess N A B, veins SEED A B or image MASK A B, "
     "not 'stripes'"},
    {TWO "pattern chess 3 pale dart\n",
     "x:3:22: no stone 'dart' is defined above this line; did you mean "
     "'dark'?"},
    {TWO "pattern chess 3 pale pale\n",
     "x:3:22: a pattern needs two different stones"},
    {TWO "pattern chess 3 pale\n", "the name of a 'stone' is missing"},
    {"size 32\n" TWO "pattern chess 33 pale dark\n",
     "x:4:9: 33 fields per side exceed the 32 texels per side"},
    {"data a.pfm\nstone a scatter 1 1 1 absorb 0 0 0\n",
     "'data' excludes 'stone' and 'pattern'"},
    {"data\n", "the name of the rows is missing"},
};

TEST(rejects_wrong_lines)
{
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct glint_error error = {.text = ""};
        struct glint_stone_text t;

        assert_int_equal(parse_medium_text(&t, wrong[i].text, &error),
                         GLINT_E_LENS);
        if (!strstr(error.text, wrong[i].error))
            fail_msg("%s\ngives '%s', not '%s'", wrong[i].text, error.text,
                     wrong[i].error);
    }
}

/* Returns the mean difference of SHARE between adjacent columns of the medium
 * (ROWS: adjacent rows). EDGE: only the differences across the edge where
 * opposite sides of the medium meet. */
static double compute_mean_neighbour_difference(const double *share, int side,
                                                bool rows, bool edge)
{
    const int first = edge ? side - 1 : 0, end = edge ? side : side - 1;
    double sum = 0;

    for (int a = 0; a < side; a++)
        for (int b = first; b < end; b++) {
            const int next = (b + 1) % side;

            sum += rows ? fabs(share[b * side + a] - share[next * side + a])
                        : fabs(share[a * side + b] - share[a * side + next]);
        }
    return sum / ((double)side * (end - first));
}

/* Checks that the texture of veins has no seam on a sphere, where opposite
 * edges of the map meet: differences across edges are as small as those
 * inside. */
TEST(veins_continue_across_edges)
{
    enum { SIDE = 64, SEEDS = 20 };
    static double share[SIDE * SIDE];
    struct glint_stone stone = {.side = SIDE, .pattern = GLINT_STONE_VEINS};
    double edge = 0, within = 0;

    for (; stone.seed < SEEDS; stone.seed++) {
        glint_stone_compute_fractions(&stone, share);
        for (int rows = 0; rows < 2; rows++) {
            edge += compute_mean_neighbour_difference(share, SIDE, rows, true);
            within +=
                compute_mean_neighbour_difference(share, SIDE, rows, false);
        }
    }
    if (edge > 1.5 * within)
        fail_msg("steps at edges %g, within %g", edge, within);
}
