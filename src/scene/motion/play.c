/* SPDX-License-Identifier: MIT
 *
 * Plays a recorded motion: moves the objects of a scene to their positions in a
 * frame, and finds which sensors see which food items (landmarks, shown as
 * balls). Each frame is computed from the file alone, so frames can be played
 * in any order. */
#include "scene/motion/play.h"

#include "base/divide.h"

#include "scene/valid.h"

/* ------------------------------------------------------------------ opening */

/* Sets N_FOODS and N_SENSORS to the numbers of food items and sensors that the
 * file's header states. The file is not checked yet: a number that is out of
 * range counts as 0. */
static void read_object_counts(const struct glint_scene_motion *how,
                               uint32_t *n_foods, uint32_t *n_sensors)
{
    const struct glint_motion_header *h = (const void *)(how + 1);
    const int is_there = how->bytes >= sizeof *h;

    *n_foods =
        is_there && h->n_foods <= GLINT_MOTION_MAX_FOODS ? h->n_foods : 0;
    *n_sensors =
        is_there && h->n_sensors <= GLINT_MOTION_MAX_SENSORS ? h->n_sensors : 0;
}

size_t glint_motion_count_max_overlays(const struct glint_scene_motion *how)
{
    uint32_t n_foods, n_sensors;

    read_object_counts(how, &n_foods, &n_sensors);
    return (size_t)n_foods * (n_sensors + 1) + GLINT_BOX_EDGES;
}

struct glint_motion_state *
glint_motion_allocate(const struct glint_scene *scene,
                      struct glint_arena *arena)
{
    const struct glint_scene_motion *how = scene->model.motion;
    struct glint_motion_state *m = glint_arena_allocate(arena, 1, sizeof *m);
    uint32_t n_foods, n_sensors;
    struct glint_placed *ball;
    struct glint_motion_layer *layer;

    read_object_counts(how, &n_foods, &n_sensors);
    ball = glint_arena_allocate(arena, n_foods, sizeof *ball);
    layer = glint_arena_allocate(arena, glint_motion_count_max_overlays(how),
                                 sizeof *layer);
    if (m) {
        m->ball = ball;
        m->layer = layer;
        m->max_layers = (int)glint_motion_count_max_overlays(how);
    }
    return m;
}

/* Returns log2 of (step of the motion / step of the scene). */
static int compute_length_scale_log2(const struct glint_scene *s)
{
    return s->model.header->unit_log2 - s->motion->motion.header.unit_log2;
}

/* Sets TO to point FROM of the motion, in steps of the scene; mirrors z if the
 * scene was described in right-handed axes. */
static void convert_to_scene_steps(const struct glint_scene *s,
                                   const int32_t from[3], int32_t to[3])
{
    const int up = compute_length_scale_log2(s);
    const int mirrored = s->model.header->variant == GLINT_HAND_RIGHT;

    for (int k = 0; k < 3; k++) {
        const int32_t x = up > 0 ? (int32_t)(from[k] * (INT64_C(1) << up))
                                 : (int32_t)q_shift(from[k], -up);

        to[k] = k == 2 && mirrored ? -x : x;
    }
}

/* Returns whether all points of the motion are within a quarter of the range of
 * scene coordinates, which leaves room for the radii of objects. */
static int is_motion_in_scene_range(const struct glint_scene *s)
{
    const struct glint_motion_header *h = &s->motion->motion.header;
    const int up = compute_length_scale_log2(s);

    for (int k = 0; k < 3; k++) {
        const int64_t most = q_larger(h->high[k], -h->low[k]);

        if (up > 28 || up < -60 ||
            (up > 0 ? most << up : most >> -up) >= GLINT_SCENE_SPAN / 4)
            return 0;
    }
    return 1;
}

/* Returns whether objects FIRST .. FIRST + N - 1 exist in the scene and are
 * balls, or FIRST is GLINT_SCENE_NONE. */
static int are_balls_of_scene(const struct glint_scene *s, uint32_t first,
                              uint32_t n)
{
    const uint32_t all = s->model.header->n_objects;

    if (first == GLINT_SCENE_NONE)
        return 1;
    if (first > all || n > all - first)
        return 0;
    for (uint32_t i = first; i < first + n; i++)
        if (s->model.object[i].kind != GLINT_OBJECT_SPHERE)
            return 0;
    return 1;
}

static int are_lights_on_body_lamps(const struct glint_scene *s)
{
    for (uint32_t i = 0; i < GLINT_SCENE_MAX_LIGHTS; i++)
        if (s->motion->how->riders >> i & 1 &&
            (i >= s->model.header->n_lights ||
             s->model.light[i].kind != GLINT_LIGHT_LAMP))
            return 0;
    return 1;
}

enum glint_status glint_motion_start_playback(struct glint_scene *scene)
{
    const struct glint_scene_motion *how = scene->model.motion;
    struct glint_motion_state *m = scene->motion;
    const struct glint_motion_header *h = &m->motion.header;
    const char *reason;

    m->how = how;
    if (glint_motion_open(&m->motion, how + 1, how->bytes, &reason) !=
            GLINT_OK ||
        !is_motion_in_scene_range(scene) ||
        !are_balls_of_scene(scene, how->body, 1) ||
        !are_balls_of_scene(scene, how->sensor, h->n_sensors) ||
        !are_balls_of_scene(scene, how->food, h->n_foods) ||
        !are_lights_on_body_lamps(scene) ||
        (how->camera != GLINT_SCENE_NONE && how->camera >= h->n_sensors))
        return GLINT_E_FORMAT;
    m->sensor = -1;
    m->shown = (1u << GLINT_KINDS) - 1;
    m->size = how->size;
    m->shell = how->shell;
    m->line = how->line;
    m->edge = how->box;
    m->n_layers = 0;
    convert_to_scene_steps(scene, h->low, m->low);
    convert_to_scene_steps(scene, h->high, m->high);
    glint_scene_seek(scene, 0);
    return how->camera == GLINT_SCENE_NONE
               ? GLINT_OK
               : glint_scene_enter(scene, (int)how->camera);
}

/* ---------------------------------------------------------------- detection */

struct wide {
    uint64_t high, low;
};

/* Returns the 128-bit product A * B of two factors below 2^63. */
static struct wide multiply_to_128_bits(uint64_t a, uint64_t b)
{
    const uint64_t a1 = a >> 32, a0 = a & UINT32_MAX;
    const uint64_t b1 = b >> 32, b0 = b & UINT32_MAX;
    const uint64_t low = a0 * b0;
    const uint64_t middle = a1 * b0 + (low >> 32);
    const uint64_t other = a0 * b1 + (middle & UINT32_MAX);

    return (struct wide){a1 * b1 + (middle >> 32) + (other >> 32),
                         other << 32 | (low & UINT32_MAX)};
}

static int is_128_bit_number_less(struct wide a, struct wide b)
{
    return a.high != b.high ? a.high < b.high : a.low < b.low;
}

/* dot / |D| is the cosine between D and the axis, which has length 1. Its
 * square is compared with that of COS_HALF. */
int glint_motion_is_in_view_cone(const int32_t axis_q30[3],
                                 int32_t cos_half_q30, const int32_t d[3])
{
    const int64_t dot_q30 = v3_dot(axis_q30, d);
    const uint64_t size = q_magnitude(dot_q30); /* below 2^61 */
    const uint64_t cosine = q_magnitude(cos_half_q30);
    const struct wide seen = multiply_to_128_bits(size, size);
    /* at most 2^60 * 3 * 2^58 */
    const struct wide least =
        multiply_to_128_bits(cosine * cosine, (uint64_t)v3_dot(d, d));

    if (dot_q30 > 0)
        return cos_half_q30 <= 0 || is_128_bit_number_less(least, seen);
    return cos_half_q30 < 0 && is_128_bit_number_less(seen, least);
}

static void detect_food_items_in_view(struct glint_motion_state *m)
{
    const struct glint_motion_header *h = &m->motion.header;

    for (uint32_t f = 0; f < h->n_foods; f++) {
        m->seen_by[f] = 0;
        for (uint32_t s = 0; s < h->n_sensors; s++) {
            int32_t d[3];

            v3_subtract(m->food_at[f], m->sensor_at[s], d);
            if (glint_motion_is_in_view_cone(m->axis_q30[s], h->cos_half_q30,
                                             d) &&
                (m->how->detect == GLINT_DETECT_ANGLE ||
                 m->frame.intensity[f][s] > m->how->least))
                m->seen_by[f] |= 1u << s;
        }
    }
}

uint32_t glint_scene_seen_by(const struct glint_scene *scene, uint32_t food)
{
    const struct glint_motion_state *m = scene->motion;

    return m && food < m->motion.header.n_foods ? m->seen_by[food] : 0;
}

/* --------------------------------------------------------------------- seek */

/* Sets TURN_Q30 to the unit quaternion of the body's rotation, mirrored like
 * positions (convert_to_scene_steps()). */
static void set_body_rotation(const struct glint_scene *s, int32_t turn_q30[4])
{
    const int16_t *q14 = s->motion->frame.pose.turn_q14;
    const int mirrored = s->model.header->variant == GLINT_HAND_RIGHT;
    uint64_t square_q28 = 0;
    int64_t length_q29;

    for (int k = 0; k < 4; k++)
        square_q28 += (uint64_t)(q14[k] * q14[k]);
    length_q29 = (int64_t)glint_compute_square_root(square_q28 << 30);
    for (int k = 0; k < 4; k++) {
        const int32_t q =
            (int32_t)q_divide((int64_t)q14[k] * (INT64_C(1) << 45), length_q29);

        turn_q30[k] = mirrored && (k == 1 || k == 2) ? -q : q;
    }
}

/* Sets AT to the scene position of the point that is at OFFSET in the body's
 * coordinates. */
static void convert_body_offset_to_scene(const struct glint_motion_state *m,
                                         const int32_t offset[3], int32_t at[3])
{
    v3_rotate(&m->turn, offset, at);
    for (int k = 0; k < 3; k++)
        at[k] = q_narrow((int64_t)at[k] + m->body[k]);
}

static void move_sensors(struct glint_scene *s)
{
    struct glint_motion_state *m = s->motion;
    const int mirrored = s->model.header->variant == GLINT_HAND_RIGHT;

    for (uint32_t i = 0; i < m->motion.header.n_sensors; i++) {
        const int32_t *from = m->motion.sensor[i].axis_q30;
        const int32_t axis_q30[3] = {from[0], from[1],
                                     mirrored ? -from[2] : from[2]};
        int32_t out[3];

        v3_rotate(&m->turn, axis_q30, m->axis_q30[i]);
        for (int k = 0; k < 3; k++)
            out[k] = q_mul(axis_q30[k], m->size, 30);
        convert_body_offset_to_scene(m, out, m->sensor_at[i]);
    }
}

static enum glint_status move_camera_to_sensor(struct glint_scene *s)
{
    const struct glint_motion_state *m = s->motion;
    const int32_t *ahead = m->axis_q30[m->sensor];
    struct glint_scene_camera c = {.kind = GLINT_CAMERA_FIELD};
    struct glint_scene_view view;
    int64_t right[3], up[3];
    int32_t body_up_q30[3];
    int axis = 1;

    /* the camera's up is the body's y axis, or its z axis if the sensor looks
     * within 8 degrees of the y axis */
    for (int k = 0; k < 3; k++)
        body_up_q30[k] = m->turn.row_q30[k][axis];
    if (q_magnitude(v3_cosine_q30(body_up_q30, ahead)) > 1063004405)
        axis = 2;
    for (int k = 0; k < 3; k++)
        body_up_q30[k] = m->turn.row_q30[k][axis];
    v3_cross(body_up_q30, ahead, right);
    glint_normalise_vector(right, c.axis_q30[0]);
    v3_cross(ahead, c.axis_q30[0], up);
    glint_normalise_vector(up, c.axis_q30[1]);
    for (int k = 0; k < 3; k++) {
        c.axis_q30[2][k] = ahead[k];
        c.at[k] = m->sensor_at[m->sensor][k];
    }
    c.tan_x_q24 = m->motion.header.tan_half_q24;
    if (glint_scene_check_camera(&c) ||
        !glint_view_init(&view, &c, s->cfg.width, s->cfg.height,
                         s->cfg.focal_q16))
        return GLINT_E_ARGUMENT;
    s->view = view;
    return GLINT_OK;
}

static void move_objects_of_kind(struct glint_scene *s,
                                 const int32_t turn_q30[4])
{
    const struct glint_motion_state *m = s->motion;
    const struct glint_motion_header *h = &m->motion.header;
    const struct glint_scene_motion *how = m->how;

    if (how->body != GLINT_SCENE_NONE)
        glint_scene_set_pose(s, (int)how->body, m->body, turn_q30);
    for (uint32_t i = 0; how->sensor != GLINT_SCENE_NONE && i < h->n_sensors;
         i++)
        glint_scene_set_pose(s, (int)(how->sensor + i), m->sensor_at[i],
                             turn_q30);
    for (uint32_t i = 0; how->food != GLINT_SCENE_NONE && i < h->n_foods; i++)
        glint_scene_set_pose(s, (int)(how->food + i), m->food_at[i],
                             s->model.object[how->food + i].turn_q30);
    for (uint32_t i = 0; i < s->model.header->n_lights; i++) {
        int32_t at[3];

        if (!(how->riders >> i & 1))
            continue;
        convert_body_offset_to_scene(m, s->model.light[i].at, at);
        glint_scene_set_light(s, (int)i, at);
    }
}

static void move_objects(struct glint_scene *s)
{
    struct glint_motion_state *m = s->motion;
    int32_t turn_q30[4];

    convert_to_scene_steps(s, m->frame.pose.at, m->body);
    set_body_rotation(s, turn_q30);
    glint_scene_quaternion_to_rotation(turn_q30, &m->turn);
    move_sensors(s);
    for (uint32_t i = 0; i < m->motion.header.n_foods; i++)
        convert_to_scene_steps(s, m->frame.food[i], m->food_at[i]);
    move_objects_of_kind(s, turn_q30);
    detect_food_items_in_view(m);
    if (m->sensor >= 0)
        move_camera_to_sensor(s);
}

void glint_scene_seek(struct glint_scene *scene, uint32_t frame)
{
    struct glint_motion_state *m = scene->motion;

    if (!m)
        return;
    m->now = frame < m->motion.header.n_frames ? frame
                                               : m->motion.header.n_frames - 1;
    if (glint_motion_frame(&m->motion, m->now, &m->frame) == GLINT_OK)
        move_objects(scene);
}

uint32_t glint_scene_frames(const struct glint_scene *scene)
{
    return scene->motion ? scene->motion->motion.header.n_frames : 0;
}

/* -------------------------------------------------------------------- looks */

/* Sets FIRST to the index of the first object of type KIND (body, sensors or
 * food items); returns the number of objects of this type. */
static uint32_t find_objects_of_kind(const struct glint_motion_state *m,
                                     enum glint_scene_kind kind,
                                     uint32_t *first)
{
    const uint32_t of[3] = {m->how->body, m->how->sensor, m->how->food};
    const uint32_t n[3] = {1, m->motion.header.n_sensors,
                           m->motion.header.n_foods};

    *first = kind <= GLINT_KIND_FOODS ? of[kind] : GLINT_SCENE_NONE;
    return *first == GLINT_SCENE_NONE ? 0 : n[kind];
}

void glint_scene_show_kind(struct glint_scene *scene,
                           enum glint_scene_kind kind, int is_shown)
{
    struct glint_motion_state *m = scene->motion;
    uint32_t first, n;

    if (!m || kind >= GLINT_KINDS)
        return;
    m->shown = (m->shown & ~(1u << kind)) | (is_shown ? 1u << kind : 0);
    n = find_objects_of_kind(m, kind, &first);
    for (uint32_t i = 0; i < n; i++)
        glint_scene_show(
            scene, (int)(first + i),
            is_shown && !(kind == GLINT_KIND_SENSORS && (int)i == m->sensor));
}

enum glint_status glint_scene_size_kind(struct glint_scene *scene,
                                        enum glint_scene_kind kind,
                                        int32_t steps)
{
    struct glint_motion_state *m = scene->motion;
    uint32_t first, n;

    if (!m || kind >= GLINT_KINDS || steps < 1 || steps > GLINT_SCENE_SPAN / 4)
        return GLINT_E_ARGUMENT;
    n = find_objects_of_kind(m, kind, &first);
    for (uint32_t i = 0; i < n; i++)
        glint_scene_set_radius(scene, (int)(first + i), steps);
    if (kind == GLINT_KIND_BODY) {
        m->size = steps;
        move_objects(scene);
    } else if (kind == GLINT_KIND_SHELLS) {
        m->shell = steps;
    } else if (kind == GLINT_KIND_LINES) {
        m->line = steps;
    } else if (kind == GLINT_KIND_BOX) {
        m->edge = steps;
    } else if (n == 0) {
        return GLINT_E_ARGUMENT;
    }
    return GLINT_OK;
}

enum glint_status glint_scene_enter(struct glint_scene *scene, int sensor)
{
    struct glint_motion_state *m = scene->motion;
    const struct glint_scene_camera *c = &scene->model.header->camera;
    const int before = m ? m->sensor : -1;
    enum glint_status status = GLINT_OK;

    if (!m || sensor < -1 || sensor >= (int)m->motion.header.n_sensors)
        return GLINT_E_ARGUMENT;
    if (sensor < 0 && before < 0)
        return GLINT_OK;
    m->sensor = sensor;
    if (sensor >= 0)
        status = move_camera_to_sensor(scene);
    else
        glint_scene_set_camera(scene, c->at, (const int32_t(*)[3])c->axis_q30);
    if (status != GLINT_OK)
        m->sensor = before;
    /* hides the ball of the camera's sensor, as the camera is inside it */
    glint_scene_show_kind(scene, GLINT_KIND_SENSORS,
                          glint_motion_is_kind_shown(m, GLINT_KIND_SENSORS));
    return status;
}
