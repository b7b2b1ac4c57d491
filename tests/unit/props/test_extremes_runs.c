/* SPDX-License-Identifier: MIT
 *
 * Tests long runs: a light that moves periodically gives the same frames in
 * each period, bit by bit, without more memory. 600 frames, or 100 000 with
 * GLINT_LONG.
 */
#include <unistd.h>

#include "support/extreme.h"
#include "support/hash.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 80, H = 54, N = 3 * W * H, ROUND = 200 };

static struct stage heliar;

/* Returns the resident memory of this process, KiB, or 0 if unknown. */
static long read_resident_kib(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    long size = 0, pages = 0;

    if (file && fscanf(file, "%ld %ld", &size, &pages) != 2)
        pages = 0;
    if (file)
        fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Sets the lamps of frame K. One leaves the image on one side, enters on the
 * other side and passes near the axis; a second one appears and vanishes, so
 * that the memory needed rises and falls. Returns the number of lamps. */
static int set_lamps_of_frame(int k, struct glint_lamp *lamp)
{
    const double t = 6.283185307179586 * k / ROUND;

    lamp[0] = stage_make_lamp(fabs(14 * cos(t)), 33 + 40 * sin(3 * t), 3000);
    lamp[1] =
        stage_make_lamp(6 + 5 * sin(2 * t), -100 + 360.0 * k / ROUND, 800);
    return k % ROUND < ROUND / 3 ? 2 : 1;
}

TEST(repeated_frames_are_identical)
{
    const int n = extreme_is_long_run() ? 100000 : 600;
    static uint64_t first[ROUND];
    static uint8_t codes[N];
    size_t bytes = 0;
    long resident = 0;
    int differ = 0;

    assert_true(stage_load_lens(&heliar, "heliar-tronnier"));
    assert_true(stage_set_up_lens(&heliar, 8) &&
                stage_bake_or_load_model(&heliar, 1, 60));
    stage_set_view(&heliar, W, H, 0);
    for (int k = 0; k < n; k++) {
        struct glint_lamp lamp[2];
        uint64_t hash;

        memset(codes, 30, sizeof codes);
        assert_true(stage_draw_codes(&heliar, lamp, set_lamps_of_frame(k, lamp),
                                     codes));
        hash = hash_bytes(HASH_START, codes, N);
        if (k < ROUND)
            first[k] = hash;
        differ += hash != first[k % ROUND];
        if (k == 2 * ROUND - 1) {
            bytes = heliar.frame.memory.bytes;
            resident = read_resident_kib();
        }
        if (extreme_is_long_run() && k % 1000 == 0)
            fprintf(stderr, "\rframe %d of %d ", k, n);
    }
    if (extreme_is_long_run())
        fprintf(stderr, "\r%d frames            \n", n);
    /* If frames did not differ, comparing them would prove nothing. */
    assert_true(first[0] != first[ROUND / 4]);
    assert_at_most(
        extreme_is_long_run()
            ? "runs: 100 000 frames, that differ from the first round's"
            : "runs: 600 frames, that differ from the first round's",
        differ, 0, "frames");
    assert_int_equal(heliar.frame.memory.bytes, bytes);
#ifndef GLINT_SANITIZED
    /* stdio and the allocator may need this memory once, for any number of
     * frames */
    assert_at_most("runs: memory at the end, above the second round's",
                   (double)(read_resident_kib() - resident), 256, "KiB");
#else
    (void)resident;
#endif
}

TEST_CLOSE
{
    stage_free(&heliar);
}
