/* SPDX-License-Identifier: MIT
 *
 * Tests where the sides of a square stop cut edges and cells. In the tests, one
 * stop radius is one pixel, so that positions in the stop equal positions on
 * the screen.
 */
#include "flare/edges/cuts.h"
#include "support/test.h"

enum { ONE_Q16 = 1 << 16 };

static const struct glint_stop square = {.n_blades = 4,
                                         .normal_q30 = {{1 << 30, 0},
                                                        {0, 1 << 30},
                                                        {-(1 << 30), 0},
                                                        {0, -(1 << 30)}},
                                         .apothem_q16 = ONE_Q16};

static struct glint_vertex make_stop_vertex(int x_q16, int y_q16)
{
    return (struct glint_vertex){.x_q8 = x_q16 / 256,
                                 .y_q8 = y_q16 / 256,
                                 .stop_x_q16 = x_q16,
                                 .stop_y_q16 = y_q16};
}

/* Returns the visible part of the edge from A to B. */
static struct glint_edge_part clip_edge(const struct glint_vertex *a,
                                        const struct glint_vertex *b)
{
    const struct glint_vertex *const end[2] = {a, b};
    struct glint_outside out[2];
    struct glint_edge_part part;

    for (int k = 0; k < 2; k++)
        glint_cuts_classify_row(&square, end[k], 1, &out[k].sides,
                                &out[k].barrels);
    glint_cuts_find_visible_part(&square, a, out[0], b, out[1], &part);
    return part;
}

/* Checks that an edge that crosses the right side of the stop is cut at x = 1,
 * in both directions. */
TEST(edge_is_cut_at_the_side)
{
    for (int from = -ONE_Q16 + 64; from < ONE_Q16; from += 1777)
        for (int to = ONE_Q16; to < 40 * ONE_Q16; to += to / 3) {
            const struct glint_vertex in = make_stop_vertex(from, 0),
                                      out = make_stop_vertex(to, 5 * 256);
            const struct glint_edge_part there = clip_edge(&in, &out);
            const struct glint_edge_part back = clip_edge(&out, &in);

            assert_true(there.visible && back.visible);
            assert_int_equal(there.cut[0], GLINT_CUT_NOTHING);
            assert_int_equal(there.cut[1], 0);
            assert_int_equal(back.cut[0], 0);
            assert_int_equal(back.cut[1], GLINT_CUT_NOTHING);
            assert_int_equal(there.end_q8[0][0], in.x_q8);
            assert_true(abs(there.end_q8[1][0] - 256) <= 1);
            assert_true(abs(back.end_q8[0][0] - 256) <= 1);
        }
}

/* Checks that an edge across the whole stop is cut twice, that an edge across a
 * corner is cut twice, and that an edge outside a corner is invisible. */
TEST(edge_across_the_stop_is_cut_twice)
{
    const struct glint_vertex left = make_stop_vertex(-2 * ONE_Q16, 0);
    const struct glint_vertex right = make_stop_vertex(3 * ONE_Q16 / 2, 0);
    const struct glint_vertex high = make_stop_vertex(0, 5 * ONE_Q16 / 4);
    const struct glint_vertex past =
        make_stop_vertex(ONE_Q16 / 2, 5 * ONE_Q16 / 2);
    const struct glint_edge_part through = clip_edge(&left, &right);
    const struct glint_edge_part over = clip_edge(&right, &high);

    assert_true(through.visible && over.visible);
    assert_int_equal(through.cut[0], 2);
    assert_int_equal(through.cut[1], 0);
    assert_true(abs(through.end_q8[0][0] + 256) <= 1);
    assert_true(abs(through.end_q8[1][0] - 256) <= 1);
    assert_int_equal(over.cut[0], 0);
    assert_int_equal(over.cut[1], 1);
    assert_true(abs(over.end_q8[0][0] - 256) <= 1);
    assert_true(abs(over.end_q8[1][1] - 256) <= 1);
    assert_false(clip_edge(&right, &past).visible);
}

/* Checks that a cell finds the upper right corner of the stop exactly if the
 * middle of the cell is within three quarters of a cell from the corner. */
TEST(cells_near_a_corner_find_it)
{
    const int wide = ONE_Q16 / 4;

    for (int u = -100; u <= 100; u++)
        for (int v = -100; v <= 100; v += 10) {
            const int x = ONE_Q16 - wide * u / 100,
                      y = ONE_Q16 - wide * v / 100;
            const struct glint_vertex corner[4] = {
                make_stop_vertex(x - wide / 2, y - wide / 2),
                make_stop_vertex(x + wide / 2, y - wide / 2),
                make_stop_vertex(x + wide / 2, y + wide / 2),
                make_stop_vertex(x - wide / 2, y + wide / 2)};
            const struct glint_vertex *const of[4] = {&corner[0], &corner[1],
                                                      &corner[2], &corner[3]};
            int32_t at_q8[2] = {0, 0};
            const int crosses =
                glint_cuts_find_crossing(&square, of, 0, 1, at_q8);

            if (abs(u) < 74 && abs(v) < 74) {
                assert_true(crosses);
                assert_true(abs(at_q8[0] - 256) <= 1);
                assert_true(abs(at_q8[1] - 256) <= 1);
            } else if (abs(u) > 76 || abs(v) > 76) {
                assert_false(crosses);
            }
        }
}
