/* SPDX-License-Identifier: MIT
 *
 * The page of a translucent medium's models.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "reference/scatter/stone_models.h"
#include "support/scratch.h"
#include "support/test.h"

static void stone(struct glint_scatter_rows *rows)
{
    struct glint_stone s;
    struct glint_error error;

    glint_stone_defaults(&s);
    s.side = 8;
    s.kernel = 5;
    s.fields = 2;
    assert_ok(glint_scatter_compute(&s, NULL, rows, &error));
}

/* What the file NAME begins with, and whether it has WORDS. */
static bool has(const char *name, const char *words)
{
    char *text = calloc(1, 1 << 18);
    FILE *file = fopen(scratch_path(name), "rb");
    size_t n;
    bool found;

    assert_non_null(text);
    assert_non_null(file);
    n = fread(text, 1, (1 << 18) - 1, file);
    fclose(file);
    found = n > 0 && strstr(text, words) != NULL;
    free(text);
    assert_int_equal(unlink(scratch_path(name)), 0);
    return found;
}

/* A page, a table, curves, and a picture for each model; names cannot make
 * markup. */
TEST(page)
{
    static const char *const picture[] = {
        "clustered-2",     "clustered-4", "factored-3", "factored-5",
        "albedo",          "svd-3",       "svd-5",      "svd-10",
        "log-svd-5",       "log-svd-10",  "tucker-5",   "tucker-15",
        "tucker-turned-5", "als-5",       "peers-5",    "peers-10",
        "subedit"};
    const struct tool tool = {.name = "bake", .quiet = true};
    struct glint_scatter_rows rows;

    stone(&rows);
    assert_ok(stone_models_report(&tool, "a<b", &rows, scratch_dir));
    assert_int_equal(scratch_count(scratch_dir), STONE_MODELS + 3);
    assert_true(has("report.html", "Models of a&#60;b"));
    assert_true(has("report.md", "| [SubEdit](subedit.png) |"));
    assert_true(has("curves.svg", "</svg>"));
    for (int i = 0; i < STONE_MODELS; i++) {
        char name[64];

        snprintf(name, sizeof name, "%s.png", picture[i]);
        assert_true(has(name, "PNG"));
    }
    glint_scatter_close(&rows);
}

TEST(no_folder)
{
    const struct tool tool = {.name = "bake", .quiet = true};
    struct glint_scatter_rows rows;

    stone(&rows);
    assert_int_equal(stone_models_report(&tool, "a", &rows, "/proc/none/a"),
                     EXIT_OUTPUT);
    glint_scatter_close(&rows);
}

TEST_GROUP(scratch_open_dir, scratch_close_dir);
