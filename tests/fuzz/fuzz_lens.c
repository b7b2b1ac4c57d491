/* SPDX-License-Identifier: MIT
 *
 * Parses random bytes as a lens table. An accepted lens must have at most
 * GLINT_MAX_GHOSTS ghosts, finite optics, and rays without NaN. Rays of the
 * direct image, and of a ghost selected by the text's length, must be
 * bit-identical whether traced singly or in batches.
 *
 *     make fuzz FUZZ=lens SECONDS=60
 */
#include <math.h>

#include "fuzz/fuzz.h"
#include "glint/bake.h"

static void check_ray_is_valid(const struct glint_ray *ray)
{
    require(isfinite(ray->stop_x_mm) && isfinite(ray->stop_y_mm));
    require(isfinite(ray->sensor_x_mm) && isfinite(ray->sensor_y_mm));
    require(ray->energy >= 0.0 && ray->energy <= 1.0);
    require(ray->rel_radius >= 0.0 && isfinite(ray->rel_radius));
}

/* Traces nine rays, spread over the front element, at angles up to 83
 * degrees. */
static void trace_rays_over_front_element(const struct glint_prescription *lens,
                                          const struct glint_ghost *ghost)
{
    enum { RAYS = 9 };
    static struct glint_path path;
    static double hits[GLINT_MAX_EVENTS + 1][2];
    const double semi = lens->surface[0].semi_mm;
    struct glint_launch from[RAYS];
    struct glint_ray ray, many[RAYS];
    enum glint_ray_status status[RAYS];

    glint_path_init_at(&path, lens, ghost, 450.0, 33.0);
    require(path.n_events <= GLINT_MAX_EVENTS);
    for (int i = 0; i < RAYS; i++) {
        const double sine = 0.496 * (i / 3);

        from[i] = (struct glint_launch){
            0.8 * semi * (i % 3 - 1),
            0.3 * semi,
            {0.6 * sine, 0.8 * sine, sqrt(1.0 - sine * sine)}};
    }
    glint_trace_many(&path, RAYS, from, many, status, NULL);
    for (int i = 0; i < RAYS; i++) {
        require(glint_trace(&path, from[i].x_mm, from[i].y_mm,
                            from[i].direction, &ray,
                            i % 2 ? hits : NULL) == status[i]);
        if (status[i] != GLINT_RAY_OK)
            continue;
        check_ray_is_valid(&ray);
        require(memcmp(&ray, &many[i], sizeof ray) == 0);
    }
}

static void trace_all_ghosts(const struct glint_prescription *lens, size_t pick)
{
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    const int n = glint_ghost_list(lens, ghosts, GLINT_MAX_GHOSTS);
    struct glint_optics optics;

    require(lens->n_surfaces >= 1 && lens->n_surfaces <= GLINT_MAX_SURFACES);
    require(lens->stop_after >= 0 && lens->stop_after <= lens->n_surfaces);
    require(memchr(lens->name, 0, sizeof(lens->name)) != NULL);
    require(memchr(lens->source, 0, sizeof(lens->source)) != NULL);
    glint_optics_of(lens, &optics);
    require(isfinite(optics.focal_mm) && isfinite(optics.back_focal_mm));
    require(isfinite(optics.entrance_z_mm) && isfinite(optics.length_mm));
    require(optics.stop_radius_mm > 0.0);
    require(n <= GLINT_MAX_GHOSTS);
    trace_rays_over_front_element(lens, NULL);
    if (n > 0)
        trace_rays_over_front_element(lens, &ghosts[pick % (size_t)n]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct glint_prescription lens;
    struct glint_error error;
    enum glint_status status;

    memset(error.text, 'x', sizeof(error.text));
    status = glint_prescription_parse(&lens, (const char *)data, size,
                                      "fuzz.lens", &error);
    require(status == GLINT_OK || status == GLINT_E_LENS);
    if (status == GLINT_OK)
        trace_all_ghosts(&lens, size);
    else
        require(memchr(error.text, 0, sizeof(error.text)) != NULL &&
                strncmp(error.text, "fuzz.lens:", 10) == 0);
    return 0;
}
