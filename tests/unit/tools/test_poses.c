/* SPDX-License-Identifier: MIT
 *
 * Checks that poses of objects, read from files and pipes, are applied in
 * order and with the handedness of the scene, and that invalid lines are
 * rejected.
 */
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/poses.h"
#include "support/scratch.h"
#include "support/test.h"

#define ONE_Q30 (1 << 30)

static struct glint_scene_header header;
static struct glint_scene_object object[2];
static struct glint_scene_light light[2];
static struct glint_scene_model model;
static struct poses poses;
static struct glint_error error;

/* Makes a scene of two objects, a sun and a lamp, with 16 steps per unit and
 * the handedness HAND. */
static void make_scene_of_two_objects(uint32_t hand)
{
    header = (struct glint_scene_header){
        .variant = hand, .unit_log2 = 4, .n_objects = 2, .n_lights = 2};
    strcpy(object[0].name, "ball");
    strcpy(object[1].name, "cup");
    strcpy(light[0].name, "sun");
    strcpy(light[1].name, "lamp");
    light[0].kind = GLINT_LIGHT_SUN;
    light[1].kind = GLINT_LIGHT_LAMP;
    model = (struct glint_scene_model){
        .header = &header, .light = light, .object = object};
}

static enum glint_status open_poses_text(const char *text, uint32_t hand)
{
    FILE *const file = fopen(scratch_file, "w");

    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    make_scene_of_two_objects(hand);
    return poses_open(&poses, scratch_file, false, &model, &error);
}

static void expect_next_pose(int frame, int thing, int x)
{
    const struct pose *const p = poses_next_pose(&poses, frame);

    assert_non_null(p);
    assert_int_equal(p->thing, thing);
    assert_int_equal(p->at[0], x);
}

/* Checks that poses are sorted by frame, then by line; the frame "*" counts as
 * 0. */
TEST(poses_are_sorted_by_frame)
{
    assert_ok(open_poses_text("frame,object,x,y,z,qw,qx,qy,qz\n"
                              "7,cup,1,0,0\n# no pose\n\n"
                              "3,camera,2,0,0\n"
                              "{\"y\":0,\"object\":\"ball\",\"frame\":3,"
                              "\"x\":3,\"z\":0}\n"
                              "*,lamp,4,0,0\n",
                              GLINT_HAND_LEFT));
    expect_next_pose(0, 3, 64);
    assert_null(poses_next_pose(&poses, 0));
    assert_null(poses_next_pose(&poses, 2));
    expect_next_pose(5, POSES_CAMERA, 32);
    expect_next_pose(5, 0, 48);
    assert_null(poses_next_pose(&poses, 6));
    expect_next_pose(100, 1, 16);
    assert_null(poses_next_pose(&poses, 100));
    poses_close(&poses);
}

TEST(other_handedness_mirrors_poses)
{
    static const char text[] = "0,ball,1,2,3,2,.4,.6,.8\n0,sun,1,2,2\n";
    struct pose pose[2][2];

    for (uint32_t hand = 0; hand < 2; hand++) {
        assert_ok(open_poses_text(text, hand));
        for (int i = 0; i < 2; i++)
            pose[hand][i] = *poses_next_pose(&poses, 0);
        poses_close(&poses);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pose[0][i].at[0], pose[1][i].at[0]);
        assert_int_equal(pose[0][i].at[1], pose[1][i].at[1]);
        assert_int_equal(pose[0][i].at[2], -pose[1][i].at[2]);
    }
    assert_int_equal(pose[0][0].at[2], 48);
    assert_int_equal(pose[0][1].at[0], lround(ONE_Q30 / 3.));
    assert_true(pose[0][0].has_turn && !pose[0][1].has_turn);
    for (int k = 0; k < 4; k++)
        assert_int_equal(pose[0][0].turn_q30[k],
                         (k == 1 || k == 2 ? -1 : 1) * pose[1][0].turn_q30[k]);
    assert_true(
        fabs(pose[0][0].turn_q30[0] / (double)ONE_Q30 - 2 / sqrt(5.16)) < 1e-9);
}

static void expect_poses_error(const char *text, int line, const char *cause)
{
    char where[64];

    assert_int_equal(open_poses_text(text, GLINT_HAND_LEFT), GLINT_E_FORMAT);
    snprintf(where, sizeof where, ":%d: ", line);
    if (!strstr(error.text, where) || !strstr(error.text, cause))
        fail_msg("'%s' of '%s'", error.text, text);
}

TEST(rejects_wrong_lines)
{
    expect_poses_error("0,ball,1,2\n", 1, "expected frame,object,x,y,z");
    expect_poses_error("\n0,ball,1,2,3,4\n", 2, "expected frame,object,x,y,z");
    expect_poses_error("0,ball,1,2,3,1,0,0,0,0\n", 1,
                       "expected frame,object,x,y,z");
    expect_poses_error("0,ball,1,two,3\n", 1, "must be numbers");
    expect_poses_error("-3,ball,1,2,3\n", 1, "frame must be");
    expect_poses_error("-1,ball,1,2,3\n", 1, "frame must be");
    expect_poses_error("1.5,ball,1,2,3\n", 1, "frame must be");
    expect_poses_error("0,bell,1,2,3\n", 1, "no 'bell'; did you mean 'ball'?");
    expect_poses_error("0,ball,1e8,2,3\n", 1, "out of the range");
    expect_poses_error("0,sun,0,0,0\n", 1, "must not be 0 0 0");
    expect_poses_error("0,ball,0,0,0,0,0,0,0\n", 1, "must not be all 0");
    expect_poses_error("frame,ball\n", 1, "the heading");
    expect_poses_error("{\"x\":1}\n", 1, "are needed");
    expect_poses_error("{\"x\":1\n", 1, "expected , or }");
    expect_poses_error("{\"x\" 1}\n", 1, "a colon is missing");
    expect_poses_error("{\"w\":1}\n", 1, "unknown key; expected one of");
    expect_poses_error("{\"object\":3}\n", 1, "object must be a");
    assert_int_equal(poses_open(&poses, "/no/such/file", false, &model, &error),
                     GLINT_E_IO);
}

TEST(pipe_returns_complete_lines)
{
    static const char parts[4][64] = {"0,ba",
                                      "ll,1,0,0\nrubbish\n5,cup,2,0,0\n",
                                      "1,sun,\n*,cup,3,0,0\n", ""};
    int to;

    unlink(scratch_file);
    assert_int_equal(mkfifo(scratch_file, 0600), 0);
    make_scene_of_two_objects(GLINT_HAND_LEFT);
    assert_ok(poses_open(&poses, scratch_file, true, &model, &error));
    assert_null(poses_next_pose(&poses, 0));
    to = open(scratch_file, O_WRONLY);
    assert_true(to >= 0);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(write(to, parts[i], strlen(parts[i])),
                         strlen(parts[i]));
        if (i == 0)
            assert_null(poses_next_pose(&poses, 1));
        if (i == 1)
            expect_next_pose(2, 0, 16);
        if (i == 2)
            expect_next_pose(3, 1, 48);
    }
    assert_null(poses_next_pose(&poses, 4));
    expect_next_pose(5, 1, 32);
    assert_int_equal(poses.n_bad, 2);
    assert_non_null(strstr(poses.bad.text, ":2: "));
    /* The first line is too long, the second one is valid. */
    for (int i = 0; i < 700; i++)
        assert_int_equal(write(to, "7", 1), 1);
    assert_int_equal(write(to, "\n*,ball,9,0,0\n", 14), 14);
    expect_next_pose(6, 0, 144);
    assert_int_equal(poses.n_bad, 3);
    /* The writer closes the pipe; then a new writer opens it. */
    close(to);
    assert_null(poses_next_pose(&poses, 7));
    to = open(scratch_file, O_WRONLY);
    assert_int_equal(write(to, "*,ball,8,0,0\n", 13), 13);
    expect_next_pose(8, 0, 128);
    close(to);
    poses_close(&poses);
    unlink(scratch_file);
}

TEST(pipe_is_read_up_to_a_limit_per_frame)
{
    static char lines[1 << 18];
    const size_t most = sizeof lines - 16;
    size_t n = 0;
    int to, taken = 0;

    while (n < most)
        n += (size_t)sprintf(lines + n, "*,ball,1,0,0\n");
    unlink(scratch_file);
    assert_int_equal(mkfifo(scratch_file, 0600), 0);
    make_scene_of_two_objects(GLINT_HAND_LEFT);
    assert_ok(poses_open(&poses, scratch_file, true, &model, &error));
    to = open(scratch_file, O_WRONLY | O_NONBLOCK);
    for (int frame = 0; frame < 3; frame++) {
        const int before = taken;

        while (write(to, lines, 13 * 64) > 0)
            ;
        while (poses_next_pose(&poses, frame))
            taken++;
        assert_in_range(taken - before, 1, (1 << 16) / 13 + 1);
    }
    close(to);
    poses_close(&poses);
    unlink(scratch_file);
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
