/* SPDX-License-Identifier: MIT
 *
 * Checks that a file is replaced even if another process replaces it at the
 * same moment, as when several shards of a render finish together.
 */
#include "posix/output.h"
#include "support/scratch.h"
#include "support/test.h"

/* number of times that another process will still replace the file while this
 * process opens it */
static int others;

char *__real_realpath(const char *path, char *resolved);
char *__wrap_realpath(const char *path, char *resolved);

char *__wrap_realpath(const char *path, char *resolved)
{
    if (others > 0) {
        char other[96];
        FILE *f;

        others--;
        snprintf(other, sizeof other, "%s/other", scratch_dir);
        f = fopen(other, "w");
        assert_non_null(f);
        fputs("other", f);
        fclose(f);
        assert_int_equal(rename(other, path), 0);
    }
    return __real_realpath(path, resolved);
}

static void write_file_and_others(const char *path, const char *text)
{
    struct glint_error error = {""};
    struct glint_output out;

    assert_ok(glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error));
    assert_ok(glint_output_write(&out, text, strlen(text), &error));
    assert_ok(glint_output_commit(&out, &error));
}

TEST(files_appear_together)
{
    char path[96], text[16] = "";
    FILE *f;

    snprintf(path, sizeof path, "%s/manifest.jsonl", scratch_dir);
    write_file_and_others(path, "first");
    others = 3;
    write_file_and_others(path, "second");
    assert_int_equal(others, 0);
    f = fopen(path, "r");
    assert_non_null(f);
    assert_int_equal(fread(text, 1, sizeof text, f), 6);
    assert_string_equal(text, "second");
    fclose(f);
    remove(path);
}

TEST_GROUP(scratch_create_dir, scratch_remove_dir);
