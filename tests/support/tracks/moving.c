/* SPDX-License-Identifier: MIT */
#include "support/tracks/moving.h"

#include "glint/scene/bake.h"
#include "glint/scene/motion_bake.h"
#include "support/rng.h"
#include "support/test.h"
#include "support/tracks/tracks.h"

/* The recorded motion that scene texts of tests use: the track of a moving
 * body, or only stationary foods (landmarks). */
static struct {
    struct track_options track;
    /* positions of the n_foods stationary foods; NULL: `track` is used */
    double (*food)[3];
    int n_foods;
    double angle_deg;
} recorded;

/* Each axis of the body has two sensors, one for each direction. */
const struct glint_motion_body moving_body = {
    .size = .5,
    .n_sensors = MOVING_SENSORS,
    .theta = {GLINT_PI / 2, GLINT_PI / 2, GLINT_PI / 2, GLINT_PI / 2, 0,
              GLINT_PI},
    .phi = {0, GLINT_PI / 2, GLINT_PI, -GLINT_PI / 2, 0, 0}};

static void write_track_frames(struct glint_motion_baker *baker)
{
    const int n = recorded.food ? 2 : recorded.track.n_frames;
    static struct glint_motion_sight s;
    struct glint_error error;
    struct track track;
    uint32_t seed = 1;

    track_begin_motion(&track, &recorded.track);
    for (int i = 0; i < n; i++) {
        struct track_frame f;

        if (!recorded.food)
            track_next_frame(&track, &f);
        s.number = i;
        s.n_foods = recorded.food ? recorded.n_foods : MOVING_FOODS;
        s.n_intensities = MOVING_SENSORS;
        for (int k = 0; k < s.n_foods; k++) {
            s.is_new[k] = !recorded.food && f.is_new[k];
            for (int j = 0; j < 3; j++)
                s.food[k][j] =
                    recorded.food ? recorded.food[k][j] : f.seen[k][j];
            for (int j = 0; j < MOVING_SENSORS; j++)
                s.intensity[k][j] = recorded.food ? 1 : rng_unit(&seed);
        }
        if (glint_motion_baker_frame(baker, &s, &error) != GLINT_OK)
            fail_msg("%s", error.text);
    }
}

static enum glint_status bake_motion(void *ctx, const char *name,
                                     uint8_t **data, size_t *bytes,
                                     struct glint_error *error)
{
    struct glint_motion_body b = moving_body;
    struct glint_motion_report report;
    struct glint_motion_baker *baker;

    (void)ctx;
    (void)name;
    baker = glint_motion_baker_open();
    assert_non_null(baker);
    b.angle_deg = recorded.angle_deg;
    assert_ok(glint_motion_baker_body(baker, &b, error));
    write_track_frames(baker);
    assert_ok(glint_motion_baker_finish(baker, "run", 1, data, bytes, &report,
                                        error));
    glint_motion_baker_close(baker);
    return GLINT_OK;
}

struct moving *moving_open_scene(const char *text, int tile_log2, int samples)
{
    static const struct tool tool = {.name = "test"};
    const struct glint_description_files files = {NULL, NULL,        NULL,
                                                  NULL, bake_motion, NULL};
    const struct scene_dials dials = {.width = MOVING_WIDTH,
                                      .height = MOVING_HEIGHT,
                                      .edge_samples = samples,
                                      .shadow_points = 1,
                                      .tile_log2 = tile_log2};
    struct moving *d = calloc(1, sizeof *d);
    struct glint_description *scene = malloc(sizeof *scene);
    struct glint_scene_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";

    assert_non_null(d);
    assert_non_null(scene);
    if (glint_description_parse(scene, text, strlen(text), "x.scene", &files,
                                &error) != GLINT_OK ||
        glint_scene_bake(scene, "x", 1, &d->data, &d->bytes, &report, &error) !=
            GLINT_OK)
        fail_msg("%s", error.text);
    glint_description_free(scene);
    free(scene);
    if (glint_scene_open(&d->model, d->data, d->bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    assert_ok(scene_frame_open(&d->frame, &tool, &d->model, &dials));
    return d;
}

void moving_close_scene(struct moving *d)
{
    scene_frame_close(&d->frame);
    free(d->data);
    free(d);
}

void moving_draw_frame(struct moving *d)
{
    struct glint_image image = glint_image_over(d->light_q20, GLINT_LINEAR_Q20,
                                                MOVING_WIDTH, MOVING_HEIGHT);

    memset(d->light_q20, 0, sizeof d->light_q20);
    assert_ok(scene_frame_draw(&d->frame, &image));
}

void moving_bake_track(int motion, int n_frames, double angle_deg)
{
    recorded.track =
        (struct track_options){motion, n_frames, MOVING_FOODS, 7, 0, 9};
    recorded.food = NULL;
    recorded.angle_deg = angle_deg;
}

void moving_bake_foods(double (*food)[3], int n, double angle_deg)
{
    recorded.food = food;
    recorded.n_foods = n;
    recorded.angle_deg = angle_deg;
}

double moving_angle_to_food_deg(void)
{
    return recorded.angle_deg;
}
