/* SPDX-License-Identifier: MIT
 *
 * Tests tracking of lamps that are hidden or that meet: the displayed energy
 * must not change abruptly, and tracks must keep their ids.
 */

#include "support/night.h"
#include "support/test.h"

enum { FPS30 = 33333 };

static struct night night;

static void init_night(int width, int height)
{
    night_close_tracker(&night);
    night_init_parameters(&night, width, height);
}

TEST_CLOSE
{
    night_close_tracker(&night);
}

static void open_night_without_noise(int width, int height, double sigma)
{
    init_night(width, height);
    night.sigma = sigma;
    assert_true(night_open_tracker(&night));
}

/* Energies of successive frames: LAST, the energy of the last frame; MOST, the
 * largest energy; LARGEST, the largest change from one frame to the next. */
struct steps {
    double last, most, largest;
    int n;
};

static void record_energy_step(struct steps *s, double energy)
{
    if (s->n++ > 0)
        s->largest = fmax(s->largest, fabs(energy - s->last));
    s->most = fmax(s->most, energy);
    s->last = energy;
}

/* Returns the total energy of all tracks in the lower half of the image. Checks
 * that these tracks have the id *ID; if *ID is 0, sets it to the first track's
 * id. */
static double sum_energy_of_lower_half(const struct night *n, uint32_t *id)
{
    double energy = 0;

    for (int i = 0; i < n->n_tracks; i++) {
        const struct glint_lamp_track *t = &n->track[i];

        if (t->y_q8 < 70 * 256)
            continue;
        *id = *id ? *id : t->id;
        assert_int_equal(t->id, *id);
        energy += night_track_power(t);
    }
    return energy;
}

/* Moves a lamp behind a pole 20 pixels wide at several speeds. The energy that
 * the finder measures drops to 0 in one frame. Checks that the energy of the
 * track changes by less than a quarter per frame and that the track keeps its
 * id. N_LAMPS 2: there is also a stationary lamp. */
static void move_lamp_behind_pole(int n_lamps)
{
    static const double speeds[] = {0.7, 1, 2, 4, 6};

    for (int k = 0; k < 5; k++) {
        struct steps raw = {0, 0, 0, 0}, tracked = {0, 0, 0, 0};
        uint32_t id = 0;

        open_night_without_noise(320, 200, 2);
        night.pole_x0 = 150;
        night.pole_x1 = 170;
        for (int frame = 0; frame * speeds[k] < 180; frame++) {
            const struct night_lamp lamps[2] = {
                {70.0 + speeds[k] * frame, 100, 5, 3}, {60, 30, 5, 3}};
            double seen = 0;

            night_draw_and_track(&night, lamps, n_lamps, FPS30);
            for (int i = 0; i < night.n_spots; i++)
                if (night.spot[i].y_q8 > 70 * 256)
                    seen += night_spot_power(&night.spot[i]);
            record_energy_step(&raw, seen);
            record_energy_step(&tracked, sum_energy_of_lower_half(&night, &id));
        }
        print_message("%.1f px a frame: steps of %.2f -> %.2f\n", speeds[k],
                      raw.largest / raw.most, tracked.largest / tracked.most);
        assert_int_equal(night.n_tracks, n_lamps);
        assert_true(tracked.largest < 0.25 * tracked.most);
    }
}

TEST(pole_causes_no_jump)
{
    move_lamp_behind_pole(2);
}

/* Checks that the glow around a hidden lamp does not define the white level,
 * although it is then the brightest part of the image. */
TEST(glow_of_a_hidden_lamp_is_not_white)
{
    move_lamp_behind_pole(1);
}

/* Checks that the tracker remembers the white level as long as it keeps the
 * track of the hidden lamp, and that the level decays meanwhile. */
TEST(white_level_is_remembered_and_decays)
{
    const struct night_lamp lamp = {160, 100, 5, 3};
    int frame = 0;

    open_night_without_noise(320, 200, 1);
    assert_int_equal(glint_lamp_tracker_white_q15(night.tracks, FPS30), 0);
    night_draw_and_track(&night, &lamp, 1, FPS30);
    assert_in_range(glint_lamp_tracker_white_q15(night.tracks, 1442695), 16383,
                    16385);
    assert_in_range(glint_lamp_tracker_white_q15(night.tracks, FPS30), 32000,
                    32100);
    while (frame < 200 && glint_lamp_tracker_white_q15(night.tracks, FPS30)) {
        night_draw_and_track(&night, &lamp, 0, FPS30);
        frame++;
    }
    assert_in_range(frame, 58, 62);
}

/* Moves two lamps together until the finder merges them, and apart again.
 * Checks that their total energy stays within limits, and that neither track
 * jumps. */
TEST(merging_lamps_keep_their_energy)
{
    struct steps energy = {0, 0, 0, 0};
    double least = HUGE_VAL, both = 0, jump = 0;
    struct glint_lamp_track last[8];
    int n_last = 0, n_merged = 0;

    init_night(640, 200);
    night.sigma = 2;
    night.lights.merge_q15 = 32768 * 30 / 640;
    assert_true(night_open_tracker(&night));
    for (int frame = 0; frame < 150; frame++) {
        const double apart = frame < 75 ? 90.0 - frame : frame - 60.0;
        const struct night_lamp lamp[2] = {{320 - apart / 2, 90, 4, 3},
                                           {320 + apart / 2, 100, 5, 3}};

        night_draw_and_track(&night, lamp, 2, FPS30);
        n_merged += night.n_spots == 1;
        record_energy_step(&energy, night_sum_track_energies(&night));
        both = frame < 20 ? fmax(both, night_sum_track_energies(&night)) : both;
        least = fmin(least, night_sum_track_energies(&night));
        for (int i = 0; i < night.n_tracks; i++)
            for (int j = 0; j < n_last; j++)
                if (night.track[i].id == last[j].id)
                    jump =
                        fmax(jump, hypot(night.track[i].x_q8 - last[j].x_q8,
                                         night.track[i].y_q8 - last[j].y_q8) /
                                       256);
        n_last = night.n_tracks;
        assert_in_range(n_last, 1, 2);
        memcpy(last, night.track, (size_t)n_last * sizeof *last);
    }
    print_message(
        "merged: energy %.2f to %.2f of both, steps of %.2f, %.1f px at most\n",
        least / both, energy.most / both, energy.largest / both, jump);
    assert_in_range(n_merged, 20, 60);
    assert_true(energy.largest < 0.15 * both);
    assert_true(least > 0.8 * both && energy.most < 1.2 * both);
    assert_true(jump < 5);
}
