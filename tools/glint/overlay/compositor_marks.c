/* SPDX-License-Identifier: MIT
 *
 * Where the lamps of a compositor are written, and shown on pictures. */
#include <math.h>
#include <string.h>

#include "desk/preview.h"
#include "lamp_files/lamp_keys.h"
#include "overlay/compositor.h"
#include "overlay/show_lights.h"

/* Returns the row that lamp I is saved as: where it was found, or where a list
 * or option puts it. */
static struct lamp_row row_of(const struct compositor *compositor, int i)
{
    const struct glint_engine_lamp *const known = &compositor->lamp[i];
    const struct glint_lamp *lamp = &known->lamp;
    const double *axis = lamp->axis;
    const double focal = compositor->settings.setup.optics.focal_mm;
    const double pixels =
        compositor->view.width * fabs(focal) /
        compositor->view.sensor_width_mm; /* pixels per tangent */
    struct lamp_row row = {.frame = compositor->n_frames,
                           .power = lamp->power,
                           .size = pixels * hypot(axis[0], axis[1]),
                           .shape = axis[0] > 0 ? axis[1] / axis[0] : 1,
                           .turn = lamp->turn_deg,
                           .level = known->level,
                           .seen = fmax(known->seen_px, 0),
                           .id = known->id,
                           .next = -1};

    memcpy(row.rgb, lamp->rgb, sizeof row.rgb);
    if (known->is_found) {
        row.x = known->track.x_q8 / 256.0;
        row.y = known->track.y_q8 / 256.0;
    } else
        glint_view_to_pixel(&compositor->view, focal, lamp, &row.x, &row.y);
    return row;
}

void compositor_save_lamps(struct compositor *compositor)
{
    for (int i = 0; compositor->save.is_open && i < compositor->n_lamps; i++) {
        const struct lamp_row row = row_of(compositor, i);

        lamp_save_row(&compositor->save, &row);
    }
}

/* Marks the lights on IMAGE: found lamps as they are tracked, all others at
 * their places by number. */
void compositor_mark(const struct compositor *compositor,
                     const struct glint_image *image)
{
    const bool found = !compositor->is_listed && compositor->n_hand == 0 &&
                       compositor->n_own > 0;

    if (compositor->settings.options
            .preview) /* without memory there are no numbers */
        preview_number(compositor->engine, compositor->lamp,
                       compositor->n_lamps,
                       glint_engine_exposed(compositor->engine)->scale, image);
    over_scene_mark(&compositor->scene, image);
    if (!compositor->show_lights)
        return;
    for (int i = 0; i < compositor->n_lamps; i++) {
        const struct lamp_row row = row_of(compositor, i);
        const uint32_t id = row.id < LAMP_ID_TEXT ? row.id : (uint32_t)i + 1;
        struct glint_lamp_track track = {.id = id, .state = GLINT_LAMP_STEADY};

        if (!(fabs(row.x) < 1 << 20 && fabs(row.y) < 1 << 20))
            continue;
        if (compositor->lamp[i].is_found)
            track = compositor->lamp[i].track;
        track.x_q8 = (int32_t)(row.x * 256);
        track.y_q8 = (int32_t)(row.y * 256);
        show_light_of(image, &track, row.power);
    }
    show_legend(image, found && compositor->is_followed);
}

bool compositor_marks(const struct compositor *compositor)
{
    return compositor->show_lights || compositor->settings.options.preview ||
           compositor->scene.has_time_line;
}
