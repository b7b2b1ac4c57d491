/* SPDX-License-Identifier: MIT
 *
 * playback.h - which frame of poses or a recorded motion a picture shows.
 *
 *     playback_init(&playback);
 *     playback_take(&playback, &line);              step, jump, play ...
 *     frame = playback_next(&playback, elapsed_s);  each picture
 *
 * At a rate, playback follows seconds, not pictures: frame k looks the same
 * whatever was shown before.
 */
#ifndef GLINT_TOOLS_CONTROL_PLAYBACK_H
#define GLINT_TOOLS_CONTROL_PLAYBACK_H

#include "control/controls.h"

struct playback {
    bool is_paused;
    double fps; /* frames a second; below 0: one a picture */
    int last;   /* no frame is behind it */

    /* Private. */
    double at;      /* the frame shown, with its fraction */
    bool has_shown; /* the next picture is no longer the first after a jump */
};

/* Sets PLAYBACK to play from frame 0, one frame a picture. */
void playback_init(struct playback *playback);

/* Obeys LINE; returns whether it is a command of time. */
bool playback_take(struct playback *playback, const struct control_line *line);

/* Returns the frame of the next picture, ELAPSED_S after the one before. */
int playback_next(struct playback *playback, double elapsed_s);

#endif
