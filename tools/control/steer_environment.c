/* SPDX-License-Identifier: MIT
 *
 * Lines on light from all around: which environment is shown, how it is turned
 * and how bright it is. Each keeps what lines have made of it. */
#include <math.h>
#include <string.h>

#include "control/steer.h"
#include "glint/real.h"
#include "options/suggest.h"

#define RADIAN 0.017453292519943295

/* Factors of light that keys can reach, as of scene texts. */
#define LEAST_SCALE 1e-6
#define MOST_SCALE  1e6

static int n_environments(const struct steer *s)
{
    return (int)s->model.header->n_environments;
}

void steer_open_environments(struct steer *steer)
{
    for (int i = 0; i < n_environments(steer); i++) {
        const struct glint_scene_environment *const e =
            &steer->model.environment[i];

        steer->environment[i] =
            (struct steer_map){atan2(e->turn_q30[1], e->turn_q30[0]) / RADIAN,
                               glint_real_value(e->scale)};
    }
}

static bool is_about(const struct control_line *line)
{
    return line->verb == CONTROL_TURN || line->verb == CONTROL_SCALE ||
           line->verb == CONTROL_MAP || line->verb == CONTROL_NEXT_MAP;
}

bool steer_check_environment(const struct steer *steer,
                             const struct control_line *line, const char *where,
                             struct glint_error *error,
                             enum glint_status *status)
{
    struct suggest suggest;

    *status = GLINT_OK;
    if (!is_about(line))
        return false;
    if (n_environments(steer) == 0)
        *status = control_fail(error, where, line->column,
                               "the scene has no environment");
    else if (line->verb == CONTROL_MAP &&
             glint_scene_find_environment(&steer->model, line->name[0]) < 0) {
        suggest_begin(&suggest, line->name[0]);
        for (int i = 0; i < n_environments(steer); i++) {
            const char *const name = steer->model.environment[i].name;

            suggest_try(&suggest, name, strlen(name));
        }
        *status = control_fail(error, where, line->name_column[0],
                               "the scene has no environment '%s'%s",
                               line->name[0], suggest_words(&suggest));
    }
    return true;
}

/* Shows environment I as lines have left it. */
static enum glint_status show(const struct steer *s, struct glint_scene *scene)
{
    const struct steer_map *const m = &s->environment[s->shown];
    const double turn = m->turn_deg * RADIAN;
    const int32_t turn_q30[2] = {(int32_t)lrint(0x1p30 * cos(turn)),
                                 (int32_t)lrint(0x1p30 * sin(turn))};
    enum glint_status status = glint_scene_set_environment(scene, s->shown);

    if (status == GLINT_OK)
        status = glint_scene_turn_environment(scene, turn_q30);
    if (status == GLINT_OK)
        status = glint_scene_scale_environment(scene, glint_real_of(m->scale));
    return status;
}

bool steer_take_environment(struct steer *steer, struct glint_scene *scene,
                            const struct control_line *line,
                            enum glint_status *status)
{
    struct steer_map *const m = &steer->environment[steer->shown];
    const double v = line->v[0];

    if (!is_about(line))
        return false;
    if (line->verb == CONTROL_TURN)
        m->turn_deg = v + (line->is_change ? m->turn_deg : 0);
    else if (line->verb == CONTROL_SCALE)
        m->scale = fmax(LEAST_SCALE,
                        fmin(MOST_SCALE, line->is_change ? v * m->scale : v));
    else if (line->verb == CONTROL_MAP)
        steer->shown =
            glint_scene_find_environment(&steer->model, line->name[0]);
    else
        steer->shown = (steer->shown + 1) % n_environments(steer);
    *status = show(steer, scene);
    return true;
}

void steer_apply_environment(const struct steer *steer,
                             struct glint_scene *scene)
{
    if (n_environments(steer) > 0)
        show(steer, scene);
}
