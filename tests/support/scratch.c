/* SPDX-License-Identifier: MIT */
#include "support/scratch.h"

#include <dirent.h>
#include <unistd.h>

#include "support/test.h"

char scratch_file[] = "/tmp/glint-test-file-XXXXXX";
char scratch_dir[] = "/tmp/glint-test-dir-XXXXXX";

void scratch_create_file(void)
{
    const int fd = mkstemp(scratch_file);

    assert_true(fd >= 0);
    close(fd);
}

void scratch_remove_file(void)
{
    unlink(scratch_file); /* no effect if a test has removed the file */
}

void scratch_create_dir(void)
{
    assert_non_null(mkdtemp(scratch_dir));
}

void scratch_remove_dir(void)
{
    assert_int_equal(rmdir(scratch_dir), 0);
}

const char *scratch_make_path(const char *name)
{
    static char path[2][80];
    static int turn;

    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "%s/%s", scratch_dir, name);
    return path[turn];
}

void scratch_write_file(const char *name, const char *data, size_t bytes)
{
    FILE *const f = fopen(scratch_make_path(name), "wb");

    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, bytes, f), bytes);
    assert_int_equal(fclose(f), 0);
}

void scratch_expect_bytes(const char *path, const char *want, size_t bytes)
{
    FILE *const f = fopen(path, "rb");
    char *const got = malloc(bytes + 1);

    assert_true(f && got);
    assert_int_equal(fread(got, 1, bytes + 1, f), bytes);
    fclose(f);
    assert_memory_equal(got, want, bytes);
    free(got);
}

int scratch_count_entries(const char *dir)
{
    DIR *const d = opendir(dir);
    int n = 0;

    assert_non_null(d);
    while (readdir(d))
        n++;
    closedir(d);
    return n - 2; /* The entries . and .. are not counted. */
}
