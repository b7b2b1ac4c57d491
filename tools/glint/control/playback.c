/* SPDX-License-Identifier: MIT */
#include "control/playback.h"

#include <math.h>

void playback_init(struct playback *playback)
{
    *playback = (struct playback){.fps = -1, .last = CONTROL_MOST_FRAME};
}

/* Sets the playback position to AT, clamped to the range of frames. The next
 * picture shows this frame, without an advance. */
static void jump_to_frame(struct playback *p, double at)
{
    p->at = fmax(0, fmin(at, p->last));
    p->has_shown = false;
}

bool playback_execute_command(struct playback *playback,
                              const struct control_line *line)
{
    switch (line->verb) {
    case CONTROL_STEP:
        playback->is_paused = true;
        jump_to_frame(playback,
                      floor(playback->at) + (line->n ? line->v[0] : 1));
        return true;
    case CONTROL_JUMP:
        jump_to_frame(playback, line->v[0]);
        return true;
    case CONTROL_PLAY:
        playback->is_paused = false;
        playback->fps = line->n ? line->v[0] : -1;
        return true;
    case CONTROL_PAUSE:
        /* A key toggles the pause; a control line only sets it. */
        playback->is_paused = !line->is_change || !playback->is_paused;
        return true;
    case CONTROL_STOP:
        playback->is_paused = true;
        jump_to_frame(playback, 0);
        return true;
    default:
        return false;
    }
}

int playback_next_frame(struct playback *playback, double elapsed_s)
{
    struct playback *const p = playback;

    if (p->has_shown && !p->is_paused)
        p->at += p->fps < 0 ? 1 : p->fps * fmax(0, elapsed_s);
    p->at = fmin(p->at, p->last);
    p->has_shown = true;
    return (int)floor(p->at);
}
