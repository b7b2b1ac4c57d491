/* SPDX-License-Identifier: MIT
 *
 * playback.h - selects the frame of poses or of a recorded motion that a
 * picture shows.
 *
 *     playback_init(&playback);
 *     playback_execute_command(&playback, &line);            step, jump, play
 *     frame = playback_next_frame(&playback, elapsed_s);     each picture
 *
 * If a rate is set, playback follows time, not the number of pictures: frame k
 * does not depend on what was shown before.
 */
#ifndef GLINT_TOOLS_CONTROL_PLAYBACK_H
#define GLINT_TOOLS_CONTROL_PLAYBACK_H

#include "control/controls.h"

struct playback {
    bool is_paused;
    double fps; /* playback rate, frames per second; below 0: one frame per
                   picture */
    int last;

    /* Private. */
    double at;      /* playback position, fractional frame number */
    bool has_shown; /* whether a picture was shown since the last jump */
};

/* Sets PLAYBACK to play from frame 0, one frame per picture. */
void playback_init(struct playback *playback);

/* Executes LINE if it is one of the commands CONTROL_STEP to CONTROL_STOP.
 * Returns whether it is. */
bool playback_execute_command(struct playback *playback,
                              const struct control_line *line);

/* Returns the frame of the next picture, ELAPSED_S after the previous
 * picture. */
int playback_next_frame(struct playback *playback, double elapsed_s);

#endif
