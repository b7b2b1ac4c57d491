/* SPDX-License-Identifier: MIT
 *
 * Runs every file of the given directories through one fuzz target, without a
 * fuzzer:
 *
 *     build/.../tests/fuzz/replay_y4m tests/fuzz/corpus/y4m
 */
#include <dirent.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define MAX_BYTES (1 << 20)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Returns 1 if the fuzz target ran on PATH, 0 if PATH is not a regular file, -1
 * if it could not be read or is larger than MAX_BYTES. */
static int replay_file(const char *path)
{
    struct stat st;
    uint8_t *data;
    size_t size;
    FILE *file;

    if (stat(path, &st) < 0)
        return -1;
    if (!S_ISREG(st.st_mode))
        return 0;
    file = fopen(path, "rb");
    /* The copy has exactly the size of the input, so that ASan detects
     * overreads. */
    data = malloc(st.st_size > 0 ? (size_t)st.st_size : 1);
    if (!file || !data || st.st_size > MAX_BYTES) {
        free(data);
        if (file)
            fclose(file);
        return -1;
    }
    size = fread(data, 1, (size_t)st.st_size, file);
    fclose(file);
    LLVMFuzzerTestOneInput(data, size);
    free(data);
    return 1;
}

/* Runs the fuzz target on each file of DIR. Returns the number of files, or -1
 * if DIR or one of its files could not be read. */
static int replay_directory(const char *dir)
{
    DIR *const d = opendir(dir);
    const struct dirent *entry;
    int n = 0;

    if (!d) {
        perror(dir);
        return -1;
    }
    while (n >= 0 && (entry = readdir(d))) {
        char path[4096];
        int replayed;

        snprintf(path, sizeof path, "%s/%s", dir, entry->d_name);
        replayed = replay_file(path);
        if (replayed < 0)
            perror(path);
        n = replayed < 0 ? -1 : n + replayed;
    }
    closedir(d);
    return n;
}

int main(int argc, char **argv)
{
    const char *const slash = strrchr(argv[0], '/');
    int sum = 0;

    for (int i = 1; i < argc; i++) {
        const int n = replay_directory(argv[i]);

        if (n < 0)
            return 1;
        sum += n;
    }
    printf("%s: %d inputs replayed\n", slash ? slash + 1 : argv[0], sum);
    return sum > 0 ? 0 : 1; /* an empty corpus is an error */
}
