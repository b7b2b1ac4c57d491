/* SPDX-License-Identifier: MIT */
#include "support/tracks/tracks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/view.h"
#include "support/rng.h"

#define SIDE 15.0

/* ------------------------------------------------------------- quaternions */

static void multiply_quaternions(const double a[4], const double b[4],
                                 double to[4])
{
    const double q[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                         a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                         a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                         a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
    const double length =
        sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);

    for (int k = 0; k < 4; k++)
        to[k] = q[k] / length;
}

static void set_rotation_quaternion(double x, double y, double z, double angle,
                                    double q[4])
{
    const double s = sin(angle / 2);

    q[0] = cos(angle / 2);
    q[1] = s * x;
    q[2] = s * y;
    q[3] = s * z;
}

void track_rotate_vector(const double q[4], const double v[3], bool forth,
                         double to[3])
{
    const double s = forth ? 1 : -1;
    const double p[4] = {q[0], s * q[1], s * q[2], s * q[3]};
    const double c[3] = {p[2] * v[2] - p[3] * v[1], p[3] * v[0] - p[1] * v[2],
                         p[1] * v[1] - p[2] * v[0]};

    to[0] = v[0] + 2 * (p[0] * c[0] + p[2] * c[2] - p[3] * c[1]);
    to[1] = v[1] + 2 * (p[0] * c[1] + p[3] * c[0] - p[1] * c[2]);
    to[2] = v[2] + 2 * (p[0] * c[2] + p[1] * c[1] - p[2] * c[0]);
}

/* ------------------------------------------------------------------ motions */

static double random_signed(struct track *t)
{
    return 2 * rng_unit(&t->rng) - 1;
}

/* Moves the body one step ahead. At a wall, it turns back. */
static void move_ahead_or_turn_at_wall(struct track *t, double step)
{
    for (int k = 0; k < 3; k++) {
        t->at[k] += step * t->heading[k];
        if (t->at[k] < 1 || t->at[k] > SIDE - 1) {
            t->at[k] = fmin(fmax(t->at[k], 1), SIDE - 1);
            t->heading[k] = -t->heading[k];
        }
    }
}

static void choose_random_heading(struct track *t)
{
    double length = 0;

    for (int k = 0; k < 3; k++) {
        t->heading[k] = random_signed(t) + 1e-3;
        length += t->heading[k] * t->heading[k];
    }
    for (int k = 0; k < 3; k++)
        t->heading[k] /= sqrt(length);
}

static void move_body_straight(struct track *t)
{
    double q[4];

    if (t->frame % 150 == 0) {
        choose_random_heading(t);
        set_rotation_quaternion(0, 0, 1, .5 * random_signed(t), q);
        multiply_quaternions(t->turn, q, t->turn);
    }
    move_ahead_or_turn_at_wall(t, .01);
}

static void move_body_along_spiral(struct track *t)
{
    const double period = 20000, angle = t->frame * .01;
    const double along = fmod(t->frame, 2 * period) / period;
    double q[4];

    t->at[0] = 1 + (SIDE - 2) * (along < 1 ? along : 2 - along);
    t->at[1] = SIDE / 2 + 5 * cos(angle);
    t->at[2] = SIDE / 2 + 5 * sin(angle);
    set_rotation_quaternion(1, 0, 0, .01, q);
    multiply_quaternions(t->turn, q, t->turn);
}

static void move_body_turning(struct track *t)
{
    double q[4];

    move_body_straight(t);
    set_rotation_quaternion(1, 0, 0, .05 * random_signed(t), q);
    multiply_quaternions(t->turn, q, t->turn);
    set_rotation_quaternion(0, 1, 0, .05 * random_signed(t), q);
    multiply_quaternions(t->turn, q, t->turn);
}

static void move_body_randomly(struct track *t)
{
    double q[4];

    choose_random_heading(t);
    move_ahead_or_turn_at_wall(t, .1 * rng_unit(&t->rng));
    set_rotation_quaternion(t->heading[1], t->heading[2], t->heading[0],
                            .3 * random_signed(t), q);
    multiply_quaternions(t->turn, q, t->turn);
}

/* ------------------------------------------------------------------- foods */

static void place_food_at_random(struct track *t, int slot)
{
    for (int k = 0; k < 3; k++)
        t->food[slot][k] = SIDE * rng_unit(&t->rng);
}

static double round_to_digits(double x, int digits)
{
    char text[40];

    if (!digits)
        return x;
    snprintf(text, sizeof text, "%.*g", digits, x);
    return strtod(text, NULL);
}

static void observe_food_positions(struct track *t, struct track_frame *f)
{
    f->food_distance = 0;
    for (int i = 0; i < t->options.n_foods; i++) {
        double off[3], square = 0;

        for (int k = 0; k < 3; k++) {
            off[k] = t->food[i][k] - t->at[k];
            square += off[k] * off[k];
        }
        f->food_distance += sqrt(square) / t->options.n_foods;
        track_rotate_vector(t->turn, off, false, f->seen[i]);
        for (int k = 0; k < 3; k++)
            f->seen[i][k] = round_to_digits(f->seen[i][k], t->options.digits);
    }
}

/* ------------------------------------------------------------------ frames */

static void (*const move[TRACK_MOTIONS])(struct track *) = {
    move_body_straight, move_body_along_spiral, move_body_turning,
    move_body_randomly};

void track_begin_motion(struct track *track,
                        const struct track_options *options)
{
    struct track *t = track;

    *t = (struct track){.options = *options,
                        .rng = options->seed,
                        .at = {SIDE / 2, SIDE / 2, SIDE / 2},
                        .turn = {1, 0, 0, 0}};
    for (int i = 0; i < 8; i++)
        rng_bits32(&t->rng);
    for (int i = 0; i < options->n_foods; i++)
        place_food_at_random(t, i);
    choose_random_heading(t);
    move[options->motion](t);
    memcpy(t->first_at, t->at, sizeof t->at);
    memcpy(t->first_turn, t->turn, sizeof t->turn);
}

/* Sets POSE to the true pose of the body, in the axes of frame 0. */
static void compute_true_body_pose(const struct track *t,
                                   struct glint_rigid *pose)
{
    const double back[4] = {t->first_turn[0], -t->first_turn[1],
                            -t->first_turn[2], -t->first_turn[3]};
    double off[3], q[4], axis[3];

    for (int k = 0; k < 3; k++)
        off[k] = t->at[k] - t->first_at[k];
    track_rotate_vector(t->first_turn, off, false, pose->at);
    multiply_quaternions(back, t->turn, q);
    for (int k = 0; k < 4; k++)
        pose->turn[k] = q[0] < 0 ? -q[k] : q[k];
    for (int i = 0; i < 3; i++) {
        const double unit[3] = {i == 0, i == 1, i == 2};

        track_rotate_vector(q, unit, true, axis);
        for (int k = 0; k < 3; k++)
            pose->row[k][i] = axis[k];
    }
}

void track_next_frame(struct track *track, struct track_frame *frame)
{
    struct track *t = track;
    double before_at[3], before_turn[4], off[3], spin[4], sine;

    memcpy(before_at, t->at, sizeof before_at);
    memcpy(before_turn, t->turn, sizeof before_turn);
    memset(frame->is_new, 0, sizeof frame->is_new);
    if (t->frame > 0)
        move[t->options.motion](t);
    for (int k = 0; k < 3; k++)
        off[k] = t->at[k] - before_at[k];
    track_rotate_vector(before_turn, off, false, frame->step);
    for (int k = 1; k < 4; k++)
        before_turn[k] = -before_turn[k];
    multiply_quaternions(before_turn, t->turn, spin);
    sine = sqrt(spin[1] * spin[1] + spin[2] * spin[2] + spin[3] * spin[3]);
    for (int k = 0; k < 3; k++)
        frame->spin[k] =
            sine > 0 ? 2 * atan2(sine, spin[0]) * spin[k + 1] / sine : 0;
    if (t->options.reset_every && t->frame > 0 &&
        t->frame % t->options.reset_every == 0) {
        frame->is_new[t->next_slot] = true;
        place_food_at_random(t, t->next_slot);
        t->next_slot = (t->next_slot + 1) % t->options.n_foods;
    }
    compute_true_body_pose(t, &frame->pose);
    observe_food_positions(t, frame);
    t->frame++;
}

/* --------------------------------------------------------------------- text */

static void write_body_line(bool is_second, int n_sensors, double angle_deg,
                            FILE *to)
{
    fprintf(to, "{\"%s\": {\"%s\": 0.5, \"%s\": [",
            is_second ? "szerkezet" : "structure", is_second ? "meret" : "size",
            is_second ? "erzosejtek" : "sensors");
    for (int i = 0; i < n_sensors; i++)
        fprintf(to, "%s{\"theta\": %.9f, \"phi\": %.9f}", i ? ", " : "",
                GLINT_PI / 2, 2 * GLINT_PI * i / n_sensors);
    fprintf(to, "], \"%s\": %g}, \"frames\": [\n",
            is_second ? "latoszog" : "angleofview", angle_deg);
}

void track_write_recording(const struct track_options *options, bool is_second,
                           int n_sensors, double angle_deg, FILE *to)
{
    struct track t;
    struct track_frame f;

    write_body_line(is_second, n_sensors, angle_deg, to);
    track_begin_motion(&t, options);
    for (int i = 0; i < options->n_frames; i++) {
        track_next_frame(&t, &f);
        if (is_second)
            fprintf(to, "{");
        else
            fprintf(to, "{\"frame_num\": %d, ", i);
        fprintf(to,
                "\"rv\": [%.6g, %.6g, %.6g], \"tv\": [%.6g, %.6g, %.6g], "
                "\"%s\": [",
                f.spin[0], f.spin[1], f.spin[2], f.step[0], f.step[1],
                f.step[2], is_second ? "kajak" : "foods");
        for (int k = 0; k < options->n_foods; k++)
            fprintf(to,
                    "{\"x\": %.*g, \"y\": %.*g, \"z\": %.*g, %s, \"reset\": "
                    "%s}%s",
                    options->digits ? options->digits : 17, f.seen[k][0],
                    options->digits ? options->digits : 17, f.seen[k][1],
                    options->digits ? options->digits : 17, f.seen[k][2],
                    is_second ? "\"i1\": [0.5, 0.25]" : "\"i\": 0.75",
                    f.is_new[k] ? "true" : "false",
                    k + 1 < options->n_foods ? ", " : "");
        fprintf(to, "]}%s\n", i + 1 < options->n_frames ? "," : "");
    }
    fprintf(to, "]}\n");
}
