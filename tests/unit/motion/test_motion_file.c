/* SPDX-License-Identifier: MIT
 *
 * Tests the file of a baked motion. Any frame must be readable with few blocks.
 * Reading from memory and reading by blocks must give the same frames, and
 * damage must be detected.
 */
#include "base/blob.h"
#include "glint/scene/motion_bake.h"
#include "support/rng.h"
#include "support/test.h"
#include "support/tracks/tracks.h"

static struct glint_motion motion;

enum { FRAMES = 5000, FOODS = 5 };

struct baked {
    unsigned char *data;
    size_t bytes;
    struct glint_motion motion;
    int reads;
};

static struct glint_rigid truth[FRAMES];
static double true_food[FRAMES][FOODS][3];

/* Bakes a track whose positions are multiplied by SCALE. */
static void bake_track(struct baked *baked, int n_frames, int reset_every,
                       double scale)
{
    const struct track_options o = {3, n_frames, FOODS, reset_every, 0, 5};
    const struct glint_motion_body body = {
        .size = scale, .angle_deg = 60, .n_sensors = 2, .theta = {0, 1}};
    struct glint_motion_report report;
    struct glint_motion_baker *baker;
    struct glint_error error;
    struct track track;
    const char *reason;

    baker = glint_motion_baker_open();
    assert_non_null(baker);
    assert_ok(glint_motion_baker_body(baker, &body, &error));
    track_begin_motion(&track, &o);
    for (int i = 0; i < n_frames; i++) {
        static struct glint_motion_sight s;
        struct track_frame f;

        track_next_frame(&track, &f);
        truth[i] = f.pose;
        s.number = i;
        s.n_foods = FOODS;
        s.n_intensities = 2;
        for (int k = 0; k < FOODS; k++) {
            s.is_new[k] = f.is_new[k];
            glint_rigid_transform_point(&f.pose, f.seen[k], true_food[i][k]);
            s.intensity[k][1] = (i % 256) / 255.;
            for (int axis = 0; axis < 3; axis++)
                s.food[k][axis] = scale * f.seen[k][axis];
        }
        assert_ok(glint_motion_baker_frame(baker, &s, &error));
    }
    memset(baked, 0, sizeof *baked);
    assert_ok(glint_motion_baker_finish(baker, "a track", 1, &baked->data,
                                        &baked->bytes, &report, &error));
    glint_motion_baker_close(baker);
    test_free_later(baked->data);
    assert_ok(
        glint_motion_open(&baked->motion, baked->data, baked->bytes, &reason));
}

static int read_motion_block(void *ctx, uint32_t block, uint8_t *to)
{
    struct baked *baked = ctx;

    baked->reads++;
    memcpy(to, baked->data + (size_t)block * GLINT_MOTION_BLOCK,
           GLINT_MOTION_BLOCK);
    return 1;
}

TEST(poses_match_the_simulated_track)
{
    struct baked baked;
    double at = 0, turn = 0;

    bake_track(&baked, FRAMES, 50, 1);
    for (uint32_t k = 0; k < FRAMES; k++) {
        struct glint_motion_frame f;
        double same = 0, square = 0, off = 0;

        assert_ok(glint_motion_frame(&baked.motion, k, &f));
        for (int i = 0; i < 3; i++)
            at = fmax(at, fabs(ldexp(f.pose.at[i], -24) - truth[k].at[i]));
        for (int i = 0; i < 4; i++)
            same += ldexp(f.pose.turn_q14[i], -14) * truth[k].turn[i];
        for (int i = 0; i < 4; i++) {
            const double q = ldexp(f.pose.turn_q14[i], -14);

            square += q * q;
            off +=
                (q - same * truth[k].turn[i]) * (q - same * truth[k].turn[i]);
        }
        turn = fmax(turn, 2 * sqrt(off / square));
        for (int i = 0; i < FOODS; i++)
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabs(ldexp(f.food[i][axis], -24) -
                                 true_food[k][i][axis]) < 1e-6);
        assert_int_equal(f.intensity[3][0], 0);
        assert_int_equal(f.intensity[3][1], k % 256);
    }
    print_message("  off by %.1e at most, turned by %.1e; %.1f bytes a frame\n",
                  at, turn, (double)baked.bytes / FRAMES);
    assert_true(at < 0x1p-24 && turn < 2e-4);
}

/* Checks that a frame read by blocks equals the frame read from memory, and
 * that frames at the end need as few blocks as those at the beginning. */
TEST(any_frame_needs_few_blocks)
{
    static uint32_t words[GLINT_MOTION_BLOCK / 4];
    uint8_t *const buffer = (uint8_t *)words;
    static struct glint_motion streamed;
    struct glint_motion_blocks blocks = {.read = read_motion_block};
    struct glint_motion_frame f, g;
    struct baked baked;
    const char *reason;
    uint32_t seed = 1;

    memset(&f, 0, sizeof f);
    memset(&g, 0, sizeof g);
    bake_track(&baked, FRAMES, 50, 1);
    blocks.ctx = &baked;
    blocks.n_blocks = (uint32_t)(baked.bytes / GLINT_MOTION_BLOCK);
    assert_ok(glint_motion_over(&streamed, &blocks, buffer, &reason));
    for (int i = 0; i < 2000; i++) {
        const uint32_t k = (uint32_t)rng_int_below(&seed, FRAMES);

        baked.reads = 0;
        assert_ok(glint_motion_frame(&streamed, k, &f));
        assert_ok(glint_motion_frame(&baked.motion, k, &g));
        assert_memory_equal(&f, &g, sizeof f);
        /* at most one block each of the poses, index, events and intensities */
        assert_true(baked.reads <= 4);
    }
    assert_int_equal(glint_motion_frame(&streamed, FRAMES, &f),
                     GLINT_E_ARGUMENT);
}

/* Checks that a changed byte is detected: when the file is opened in memory, or
 * when the block that contains the byte is read. */
TEST(detects_any_changed_byte)
{
    static uint32_t words[GLINT_MOTION_BLOCK / 4];
    uint8_t *const buffer = (uint8_t *)words;
    static struct glint_motion streamed;
    struct glint_motion_blocks blocks = {.read = read_motion_block};
    struct baked baked;
    const char *reason;
    uint32_t seed = 2;

    bake_track(&baked, 1000, 50, 1);
    blocks.ctx = &baked;
    blocks.n_blocks = (uint32_t)(baked.bytes / GLINT_MOTION_BLOCK);
    for (int i = 0; i < 300; i++) {
        const size_t at = (size_t)rng_int_below(&seed, (int)baked.bytes);
        const unsigned char was = baked.data[at];
        const uint32_t header = GLINT_MOTION_BLOCK;
        bool found = false;

        baked.data[at] ^= (unsigned char)(1 << rng_int_below(&seed, 8));
        assert_int_equal(
            glint_motion_open(&motion, baked.data, baked.bytes, &reason),
            GLINT_E_FORMAT);
        found =
            glint_motion_over(&streamed, &blocks, buffer, &reason) != GLINT_OK;
        for (uint32_t k = 0; !found && k < 1000; k++) {
            struct glint_motion_frame f;

            found = glint_motion_frame(&streamed, k, &f) != GLINT_OK;
        }
        /* Bytes 12 .. 15, the checksum of the whole file, are not checked by
         * blocks. */
        assert_true(found || (at >= 12 && at < 16 && at < header));
        baked.data[at] = was;
    }
    for (size_t n = 0; n < baked.bytes; n += 997) {
        assert_int_equal(glint_motion_open(&motion, baked.data, n, &reason),
                         GLINT_E_FORMAT);
        assert_non_null(reason);
    }
}

/* Checks a motion that is read by blocks. A name with control characters must
 * be rejected as it is in memory. A frame that needs an unreadable block must
 * return an error, whichever block it is. */
TEST(rejects_invalid_blocks)
{
    static uint8_t buffer[GLINT_MOTION_BLOCK] __attribute__((aligned(8)));
    struct baked baked;
    struct glint_motion_blocks blocks = {.read = read_motion_block,
                                         .ctx = &baked};
    struct glint_motion_frame frame;
    struct glint_motion_header *header;
    const char *reason[2];
    uint32_t *end;

    bake_track(&baked, 1000, 50, 1);
    blocks.n_blocks = (uint32_t)(baked.bytes / GLINT_MOTION_BLOCK);
    assert_ok(glint_motion_over(&motion, &blocks, buffer, &reason[0]));
    header = (void *)baked.data;
    for (uint32_t i = 0; i < blocks.n_blocks; i++) {
        uint8_t *const block = baked.data + (size_t)i * GLINT_MOTION_BLOCK;

        block[GLINT_MOTION_BLOCK - 1] ^= 1;
        motion.held = 0;
        memset(&frame, 0x7f, sizeof frame);
        assert_int_equal(
            glint_motion_frame(&motion, 600, &frame),
            i == header->pose_block + 2 ||
                    i == header->index_block +
                             2 / glint_motion_per_block(
                                     sizeof(struct glint_motion_index)) ||
                    i == header->event_block ||
                    i == header->intensity_block +
                             600 / glint_motion_per_block(header->intensities)
                ? GLINT_E_FORMAT
                : GLINT_OK);
        block[GLINT_MOTION_BLOCK - 1] ^= 1;
    }
    header->name[2] = '\x1b';
    end = (uint32_t *)(void *)(baked.data + GLINT_MOTION_ROOM);
    end[1] = glint_motion_sum(baked.data, 0);
    glint_blob_set_size_and_checksum(baked.data, baked.bytes);
    assert_int_equal(
        glint_motion_open(&motion, baked.data, baked.bytes, &reason[0]),
        GLINT_E_FORMAT);
    assert_int_equal(glint_motion_over(&motion, &blocks, buffer, &reason[1]),
                     GLINT_E_FORMAT);
    assert_string_equal(reason[0], "the name has a control character");
    assert_string_equal(reason[1], reason[0]);
}

/* Checks a file with random words and a valid checksum: it must be rejected, or
 * all its frames must be readable. */
TEST(random_words_are_rejected_or_readable)
{
    struct baked baked;
    unsigned char *copy;
    uint32_t seed = 4;
    int opened = 0;

    bake_track(&baked, 300, 50, 1);
    copy = test_free_later(malloc(baked.bytes));
    for (int i = 0; i < 3000; i++) {
        const char *reason;
        /* every second change is in the file header */
        const size_t at =
            4 * (size_t)rng_int_below(&seed, i % 2 ? 46 : (int)baked.bytes / 4);
        uint32_t word = rng_bits32(&seed) >> rng_int_below(&seed, 32);

        memcpy(copy, baked.data, baked.bytes);
        memcpy(copy + at, &word, 4);
        glint_blob_set_size_and_checksum(copy, baked.bytes);
        if (glint_motion_open(&motion, copy, baked.bytes, &reason) != GLINT_OK)
            continue;
        opened++;
        for (uint32_t k = 0; k < motion.header.n_frames; k++) {
            struct glint_motion_frame f;

            assert_ok(glint_motion_frame(&motion, k, &f));
        }
    }
    print_message("  %d of 3000 open\n", opened);
    assert_true(opened > 10 && opened < 2500);
}

/* Checks that tracks scaled by 1e-6 to 1e4 keep their relative precision, as
 * the bake adapts the unit. */
TEST(unit_adapts_to_the_size)
{
    for (int power = -6; power <= 4; power++) {
        const double scale = pow(10, power);
        double worst = 0;
        struct baked baked;

        bake_track(&baked, 200, 50, scale);
        for (uint32_t k = 0; k < 200; k++) {
            struct glint_motion_frame f;

            assert_ok(glint_motion_frame(&baked.motion, k, &f));
            for (int i = 0; i < 3; i++)
                worst = fmax(worst, fabs(ldexp(f.pose.at[i],
                                               -baked.motion.header.unit_log2) /
                                             scale -
                                         truth[k].at[i]));
        }
        print_message("  size 1e%d: 2^%d steps, off by %.1e of it\n", power,
                      baked.motion.header.unit_log2, worst);
        assert_true(worst < 1e-6);
    }
}
