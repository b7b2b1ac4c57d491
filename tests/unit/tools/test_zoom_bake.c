/* SPDX-License-Identifier: MIT
 *
 * Tests the options with which the positions of a zoom lens are baked, by
 * comparing the keys of the models.
 */
#include "support/lens_check.h"
#include "zooms/zoom_bake.h"

static const char table[] = "name t\n"
                            "f-number 20\n"
                            "film 24 16\n"
                            "surface  60    4    12  1.52 60\n"
                            "surface -200  2/8  12  air\n"
                            "stop     6/5  8\n"
                            "surface  90    4    12  1.62 36\n"
                            "surface -90   40/38  12  air\n";

static struct glint_prescription lens;

/* Bakes both ends of the zoom and the positions needed for a PSNR of
 * HALFWAY_DB half-way between positions. Sets KEY to the keys of the models
 * of both ends. */
static void bake_zoom_positions(const struct glint_bake_options *options,
                                double halfway_db, uint64_t key[2])
{
    static struct glint_zoom_lens zoom;
    struct tool tool = {.name = "test", .quiet = true};
    const struct coating coating = {.kind = COATING_TABLE};
    const struct zoom_bake what = {.lens = &lens,
                                   .coating = &coating,
                                   .options = options,
                                   .positions = 2,
                                   .halfway_db = halfway_db};
    struct zoom_baked baked;
    struct glint_error error = {""};
    const char *reason = "";

    if (zoom_bake_positions(&tool, &what, &baked, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    if (glint_zoom_open(&zoom, baked.data, baked.bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    assert_int_equal(zoom.n_models, 2);
    for (int k = 0; k < 2; k++)
        key[k] = zoom.model[k].header->key[0] |
                 (uint64_t)zoom.model[k].header->key[1] << 32;
    free(baked.data);
}

/* Returns the model key of the zoom position ALONG, 0 .. 1. Its neighbouring
 * position is BESIDE; BESIDE < 0: it has none. */
static uint64_t
compute_key_of_position(const struct glint_bake_options *options, double along,
                        double beside)
{
    struct glint_prescription at, other;
    struct glint_bake_options with = *options;

    set_lens_at_position(&at, &lens, along);
    set_lens_at_position(&other, &lens, beside < 0 ? 0 : beside);
    with.beside = &other;
    with.n_beside = beside >= 0;
    return glint_bake_key(&at, &with);
}

/* A position is baked together with its neighbour. Checks that the ends of the
 * zoom have a neighbour at the finest step between positions: 1/16, as an
 * interval may be halved four times. */
TEST(ends_are_baked_with_a_finest_step)
{
    struct glint_bake_options options;
    uint64_t key[2];

    parse_lens_text(&lens, table);
    glint_bake_defaults(&options);
    options.max_deg = 3;
    bake_zoom_positions(&options, 1, key);
    assert_true(key[0] == compute_key_of_position(&options, 0, 1 / 16.0));
    assert_true(key[1] == compute_key_of_position(&options, 1, 15 / 16.0));
    bake_zoom_positions(&options, 0, key);
    assert_true(key[0] == compute_key_of_position(&options, 0, -1));
    assert_true(key[1] == compute_key_of_position(&options, 1, -1));
    assert_true(compute_key_of_position(&options, 0, 1) !=
                compute_key_of_position(&options, 0, -1));
    assert_true(compute_key_of_position(&options, 0, 1) !=
                compute_key_of_position(&options, 0, 0.5));
}
