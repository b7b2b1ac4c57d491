/* SPDX-License-Identifier: MIT
 *
 * State of a scene, and the interfaces between its modules.
 *
 * visible -> surface -> shade: the object visible at a sample; the point and
 * normal where a ray meets the object; the light that the surface sends back
 * along the ray. */
#ifndef GLINT_SCENE_STATE_H
#define GLINT_SCENE_STATE_H

#include "base/arena.h"
#include "glint/scene/scene.h"
#include "image/curve.h"
#include "scene/around.h"
#include "scene/ray.h"
#include "scene/view.h"
#include "tile/bins.h"
#include "tile/blend.h"

enum {
    GLINT_SCENE_ONE_Q15 = 1 << 15,
    GLINT_SCENE_MOST_LIGHT = 1 << 30, /* max light, q15; larger light
                                         saturates */
    /* distance of the start of secondary rays from a mesh, steps */
    GLINT_SCENE_LIFT = 4,
    GLINT_SCENE_SAMPLES = 16, /* max samples per pixel */
    GLINT_SCENE_PASSES = 8,   /* max surfaces that a ray passes through */
    GLINT_COVER_LOG2 = 3 /* log2 of the side, in pixels, of the squares of the
                            stored cover */
};

#define GLINT_NOTHING UINT32_C(0xffffffff)

/* An object at its position in this frame. */
struct glint_placed {
    const struct glint_scene_object *object;
    int32_t at[3], radius;
    /* Rotation of the object: its point p is at position at + turn p. */
    struct glint_scene_turn turn;
    /* Bounding sphere; for a plane, its normal, _q30, and 0. */
    int32_t centre[3], reach;
    uint32_t material; /* material of the object's surfaces without their own
                          material */
    int is_shown;
    int is_split, is_catcher; /* is_split: samples are shaded one by one;
                                 is_catcher: the object only receives shadows */
    int skin;                 /* index of its map if it is translucent, else
                                 -1 */
    int is_seen;              /* may be visible in this frame */
    struct glint_box box;     /* box of pixels that the object may touch */
    uint32_t first_vertex;    /* mesh: index among the vertices of all
                                 objects */
    int32_t margin;           /* sphere: a pixel's diagonal at its far side,
                                 steps, at least 1 */
    struct glint_depth depth; /* plane: 1 / z over the picture */
    int32_t z[2];             /* min and max z; not used for planes */
    /* Sphere: depths, 2^30 nearest / z. flat_depth: a single depth for the
     * whole sphere, if that orders it correctly against all balls that it
     * may overlap, else 0. far_depth: depth of its far side. */
    int32_t flat_depth, far_depth;
    /* Sphere: (vector from the camera to its middle) / radius, with over_up
     * fraction bits; over_up is 0 if the quotient is out of range (quick.c). */
    int32_t over[3];
    int over_up;
    /* Sphere: a bit per light index of a sun, set if no object can shadow
     * the side of the sphere that faces that sun. */
    uint32_t open_to;
    /* Coefficients for the span of pixels in a row that a ball may touch
     * (quick.c). */
    struct {
        int is_there;
        int32_t m_q30[3], c_q30, a_q30;
        uint32_t over; /* 2^61 / (-a 2^up) */
        int up;
    } span;
};

enum { GLINT_QUICK_TRIANGLES = 32 };

/* A triangle prepared for shading (quick_mesh.c). */
struct glint_quick_triangle {
    uint32_t id;
    int is_there, is_inside, is_smooth;
    const struct glint_scene_material *material;
    /* Twice the area opposite each corner, q16, at position (x, y) from the
     * first corner: at + across x + down y. The sum of all three, times 2^up,
     * is 2^63 / one_over. */
    int32_t x_q8, y_q8, across[3], down[3];
    int64_t at[3];
    int up;
    uint32_t one_over;
    int32_t nearer_q30[3]; /* min depth of the corners / depth of each corner */
    /* The first corner, and the differences of the second and third corner
     * from it. */
    int32_t place[3][3], normal_q29[3][3];
    int32_t face_q30[3];
};

enum { GLINT_SHADOW_CELLS_LOG2 = 6, GLINT_SHADOW_POINTS = 16 };

/* A sample point of a sun's disc: its direction, and the slope of its rays
 * relative to the rays from the disc's middle, as tangents. */
struct glint_shadow_point {
    int32_t toward_q30[3], lean_q30[2];
};

/* The footprint of the region that an object can shadow, seen from a sun:
 * its extent across the rays, in 1/256 of a cell, rounded down, and its top
 * (max h). */
struct glint_shadow_thing {
    uint32_t id; /* object << 20 | triangle */
    int16_t lo[2], hi[2];
    int32_t top;
};

/* Objects that cast shadows, from the direction of a sun (shadow.c). */
struct glint_shadow {
    int light;    /* index of the sun among the lights */
    int is_ready; /* 1: nothing has moved since the grid was built */
    int is_empty; /* 1: no object casts shadows */
    struct glint_scene_turn turn; /* rotation to coordinates u and v across the
                                     rays and h along them */
    int32_t lo[3], hi[3];         /* bounding box of the objects in the grid */
    int32_t lowest;       /* min h of points for which the grid is valid */
    int32_t cells_q32[2]; /* cells per step, up to 2^30 */
    int n_points;
    int32_t lean_q30; /* max slope of the rays of all sample points */
    struct glint_shadow_point point[GLINT_SHADOW_POINTS];
    int32_t (*vertex)[3];   /* vertices of all meshes, rotated by
                               turn */
    struct glint_bins bins; /* per cell: indices of elements of thing */
    struct glint_shadow_thing *thing; /* [n_things]: shadow casters */
    int n_things;
    int max_refs; /* max entries; at least the number of objects */
};

/* A light at its position in this frame. */
struct glint_lit {
    struct glint_shadow *shadow; /* shadow grid of a sun; NULL: shadows are
                                    found by tracing rays */
    const struct glint_scene_light *light;
    int32_t at[3];         /* lamp: position */
    int32_t toward_q30[3]; /* sun: direction to it */
    int32_t rgb_q15[3];    /* sun: its light, 0 .. 2^30 */
};

/* The intersection of a ray with an object. */
struct glint_met {
    uint32_t object, triangle;
    int32_t t;
    int end; /* end of a sphere's chord: 0 where the ray enters, 1 where it
                leaves */
    struct glint_chord chord;
    struct glint_spot_on spot;
};

/* The point where a ray meets a surface. Normals point to the side that the ray
 * comes from. */
struct glint_met_surface {
    const struct glint_scene_material *material;
    uint32_t object, triangle;
    int32_t t, place[3];
    int32_t normal_q30[3], face_q30[3]; /* shading normal; geometric normal */
    int is_inside; /* 1: the ray comes from inside the object */
    int32_t uv_q16[2];
    /* log2 of the area in uv space per step^2; _q16 */
    int32_t uv_log2_q16;
};

/* Tangent frame of brushed metal at a surface point. */
struct glint_brushed {
    int32_t frame_q30[3][3]; /* rows: tangent, bitangent, normal; unit
                                vectors */
    int32_t spread_q30;      /* term that the normal's variation within a pixel
                                adds to the squared alphas: twice its variance;
                                -1: not computed yet */
};

/* Light and cover of a pixel, as sums over four samples. */
struct glint_scene_sum {
    int64_t rgb_q17[3];
    int cover_q10, shadow_q10; /* cover_q10: cover of all objects; shadow_q10:
                                  shadow on catchers */
};

enum {
    GLINT_GLOSS_STEPS_LOG2 = 8,
    GLINT_GLOSS_STEPS = 1 << GLINT_GLOSS_STEPS_LOG2
};

/* Table of (1 - y)^k of a material for y = 0 .. end, interpolated linearly; 0
 * for larger y. Max error 2^-11.5. */
struct glint_gloss {
    int32_t end_q30;
    int64_t scale_q30; /* 1 / end, 1 .. 2^13 */
    uint16_t at_q15[GLINT_GLOSS_STEPS + 1];
};

struct glint_scene_worker {
    /* [samples of a tile]: depth, 2^30 nearest / z, and id of the visible
     * object: object << 20 | triangle, or GLINT_NOTHING */
    int32_t *depth;
    uint32_t *id;
    struct glint_box tile;
    struct glint_box touched; /* pixels of the tile that may see an object;
                                 other pixels have no samples */
    const struct glint_scene *scene;
    struct glint_tile_scratch scratch;
    /* [half a tile]: results for 2 x 2 pixels that see one object; they are
     * shaded once, in the upper row. NULL: every pixel is shaded. */
    struct glint_scene_sum *quad;
    struct glint_quick_triangle *quick; /* [GLINT_QUICK_TRIANGLES] */
    int is_linear;
    struct glint_layer_span *span; /* [layers]: spans of the current row */
    int *over;                     /* [layers]: layers over the current pixel */
    int n_spans, n_over;
};

struct glint_scene {
    struct glint_scene_config cfg;
    struct glint_scene_model model;
    struct glint_scene_view view;
    const int8_t (*sample_q8)[2]; /* positions of a pixel's samples, relative to
                                     its middle */
    struct glint_placed *placed;  /* [n_objects] */
    struct glint_lit *lit;        /* [n_lights] */
    uint32_t n_lit; /* number of lights that are on; they are the first ones */
    int32_t (*seen)[3];          /* camera coordinates of all vertices */
    struct glint_corner *corner; /* the vertices projected to the picture */
    struct glint_bins bins; /* triangles by tile, as object << 20 | triangle */
    int32_t nearest;        /* min z of all objects, at least 1 */
    int has_triangles;      /* 1: bins are filled */
    int n_planes;           /* number of planes that cast shadows */
    uint32_t plane;         /* index of the last plane that casts shadows */
    int has_split, has_catchers; /* 1: there are objects with is_split, or with
                                    is_catcher */
    struct glint_scene_worker *worker; /* [workers] */
    struct glint_blend_rows *rows;     /* [workers] */
    struct glint_resolve *resolve;
    /* table that decodes texels; NULL: there are no textures */
    struct glint_curve *curve;
    struct glint_gloss *gloss; /* [n_materials] */
    /* The camera's picture as background of mirrors and glass; not allocated
     * if no material shows it. */
    struct glint_around around;
    struct glint_scene_material *material; /* [n_materials]: current
                                              materials */
    struct glint_scene_ward *ward;         /* [n_wards] */
    /* metals and environments; NULL: there are none */
    struct glint_ward_state *wards;
    /* translucent media; NULL: there are none */
    struct glint_stone_state *stones;
    uint32_t moved; /* number of changes of objects or lights */
    int is_spread;  /* 1: maps of translucent objects are up to date for the
                       current frame */
    /* NULL: highlights are not requested */
    struct glint_highlight_state *bright;
    struct glint_motion_state *motion; /* NULL: there is no recorded motion */
    int cover_across, cover_down;
    uint16_t *cover; /* [cover_down][cover_across]: sums of cover, _q8, over
                        squares of 8 x 8 pixels */
    /* Counts tests of rays, see glint_scene_count_tests(); NULL: not counted */
    int64_t *tests;
};

/* Counts N tests of a ray with an object, a cell of a grid or a triangle. */
static inline void glint_scene_count(const struct glint_scene *scene, int64_t n)
{
    if (scene->tests)
        *scene->tests += n;
}

static inline uint32_t glint_id(uint32_t object, uint32_t triangle)
{
    return object << 20 | triangle;
}

/* --------------------------------------------------------- visible, surface */

/* Returns the positions of N samples of a pixel, q8 from its middle. N must be
 * 1, 4, 8 or 16. */
const int8_t (*glint_scene_samples(int n))[2];

/* Finds the balls for which one depth suffices; called after all are placed. */
void glint_scene_flatten(struct glint_scene *scene);

/* Restricts catchers to pixels that may have shadows; called after the
 * shadow grids are built. */
void glint_scene_confine(struct glint_scene *scene);

/* Narrows X0 .. X1 - 1 to the pixels of row Y that ball P may touch; returns 0
 * if there are no such pixels. */
int glint_scene_span(const struct glint_scene *scene,
                     const struct glint_placed *p, int y, int32_t *x0,
                     int32_t *x1);

/* Finds the visible objects at the samples of TILE; returns 0 if no object
 * is visible. */
int glint_scene_look(struct glint_scene_worker *w, struct glint_box tile);

/* Sets MET to the nearest intersection of RAY; returns 0 if there is none.
 * Skips catchers and OBJECT; of a mesh OBJECT only triangle TRIANGLE is
 * skipped. */
int glint_scene_meet(const struct glint_scene *scene,
                     const struct glint_scene_ray *ray, uint32_t object,
                     uint32_t triangle, struct glint_met *met);

/* Returns whether RAY meets anything nearer than LIMIT. Skips the same
 * objects as glint_scene_meet(). */
int glint_scene_blocks(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray, uint32_t object,
                       uint32_t triangle, int32_t limit);

/* Returns whether RAY meets a plane other than OBJECT. */
int glint_scene_planes_block(const struct glint_scene *scene,
                             const struct glint_scene_ray *ray,
                             uint32_t object);

/* Returns whether any plane other than OBJECT casts shadows. */
static inline int glint_scene_other_planes(const struct glint_scene *s,
                                           uint32_t object)
{
    return s->n_planes > (s->n_planes > 0 && s->plane == object);
}

/* Sets MET to the intersection of the primary ray RAY with object ID, clamped
 * to the triangle if ID is a triangle; returns 0 if they do not meet. SEEN_Q30
 * is the ray's direction in camera coordinates. */
int glint_scene_meet_id(const struct glint_scene *scene,
                        const struct glint_scene_ray *ray,
                        const int32_t seen_q30[3], uint32_t id,
                        struct glint_met *met);

/* Sets SURFACE to the surface at the intersection MET of RAY. Returns 0 if the
 * point is out of range or the triangle has no area. */
int glint_scene_surface(const struct glint_scene *scene,
                        const struct glint_scene_ray *ray,
                        const struct glint_met *met,
                        struct glint_met_surface *surface);

/* ------------------------------------------------------------------- shade */

/* Light that a surface sends back along a ray, and the fraction of the
 * background that the surface hides. */
struct glint_met_shade {
    int32_t rgb_q15[3]; /* 0 .. 2^30 */
    int cover_q8;       /* 0 .. 256 */
};

/* Adds to RGB_Q15 the light that SURFACE reflects along RAY from all lights,
 * times WEIGHT_Q15. */
void glint_scene_phong(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray,
                       const struct glint_met_surface *surface,
                       int32_t weight_q15, int32_t rgb_q15[3]);

/* Sets SHADE to the light from SURFACE along the primary ray RAY. */
void glint_scene_shade(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray,
                       const struct glint_met_surface *surface,
                       struct glint_met_shade *shade);

/* Returns the fraction, 0 .. 32768, of light LIT that reaches SURFACE, by
 * tracing rays through the scene. */
int32_t glint_rays_reach(const struct glint_scene *scene,
                         const struct glint_met_surface *surface,
                         const struct glint_lit *lit);

/* Builds the shadow grid of LIT, which must be a sun. */
void glint_shadow_prepare(const struct glint_scene *scene,
                          const struct glint_lit *lit,
                          struct glint_shadow *shadow);

/* Returns the box of pixels in which plane P may have shadows from the sun
 * of SHADOW. */
struct glint_box glint_shadow_box(const struct glint_scene *scene,
                                  const struct glint_shadow *shadow,
                                  const struct glint_placed *p);

/* Returns the fraction, 0 .. 32768, of the light of the sun of SHADOW that
 * reaches PLACE, the start of rays from SURFACE. */
int32_t glint_shadow_reaches(const struct glint_scene *scene,
                             const struct glint_shadow *shadow,
                             const struct glint_met_surface *surface,
                             const int32_t place[3]);

/* Sets AT to the start of rays that leave SURFACE: its position, moved off a
 * mesh by GLINT_SCENE_LIFT along the normal of the face. */
static inline void glint_scene_leave(const struct glint_scene *scene,
                                     const struct glint_met_surface *surface,
                                     int32_t at[3])
{
    const int32_t lift =
        scene->placed[surface->object].object->kind == GLINT_OBJECT_MESH
            ? GLINT_SCENE_LIFT
            : 0;

    for (int k = 0; k < 3; k++)
        at[k] = surface->place[k] + q_mul(surface->face_q30[k], lift, 30);
}

/* Returns the fraction, 0 .. 32768, of light LIT that reaches SURFACE. */
static inline int32_t
glint_scene_reaches(const struct glint_scene *scene,
                    const struct glint_met_surface *surface,
                    const struct glint_lit *lit)
{
    int32_t at[3];

    if (!lit->shadow || !lit->shadow->is_ready)
        return glint_rays_reach(scene, surface, lit);
    glint_scene_leave(scene, surface, at);
    return glint_shadow_reaches(scene, lit->shadow, surface, at);
}

/* Sets U and V to unit vectors perpendicular to D and to each other. */
void glint_scene_frame_of(const int32_t d_q30[3], int32_t u_q30[3],
                          int32_t v_q30[3]);

/* Sets TOWARD_Q30 to the direction from PLACE to LIT and LEVEL_Q15 to the light
 * of a white surface at PLACE that faces LIT. Returns the distance, GLINT_FAR
 * for a sun, or 0 if PLACE is the position of LIT. */
int32_t glint_scene_light_at(const struct glint_scene *scene,
                             const struct glint_lit *lit,
                             const int32_t place[3], int32_t toward_q30[3],
                             int32_t level_q15[3]);

/* Prepares the table of powers of exponent POWER_Q8. */
void glint_gloss_prepare(struct glint_gloss *gloss, int32_t power_q8);

/* Returns X^K, _q15, with an error below 1/512. X_Q30 must be 0 .. 2^30,
 * K_Q8 at least 1. */
int32_t glint_power_q15(int32_t x_q30, int32_t k_q8);

/* Turns RAY, which points to the middle of a light T steps away, to point I of
 * the N (1, 4 or 16) points of the light's disc. RADIUS is in steps, or if T is
 * GLINT_FAR a sine, q30. */
void glint_scene_point(struct glint_scene_ray *ray, int32_t t, int32_t radius,
                       int i, int n);

/* Sets RGB_Q15 to the background (not the picture) in direction TOWARD_Q30,
 * averaged over a spot of angular variance SPREAD_Q40. */
void glint_scene_behind(const struct glint_scene *scene,
                        const int32_t toward_q30[3], int64_t spread_q40,
                        int32_t rgb_q15[3]);

/* Returns the max number of highlights to find. */
static inline int glint_scene_wanted_highlights(const struct glint_scene *s)
{
    const struct glint_scene_header *h = s->model.header;

    return s->cfg.highlights >= 0 ? s->cfg.highlights
           : h->flare             ? (int)h->highlights
                                  : 0;
}

/* Returns the angular variance of a pixel, radians^2. */
static inline int64_t glint_scene_pixel_q40(const struct glint_scene *scene)
{
    const int64_t step_q30 = scene->view.step_q56[0] >> 18;

    return step_q30 < 1 << 30 ? step_q30 * step_q30 >> 22 : INT64_C(1) << 38;
}

/* Sets UV to the texture coordinates of SURFACE on ball P: u runs around the y
 * axis and is 1/2 where an unrotated camera sees the ball's middle; v runs from
 * top to bottom. */
void glint_ball_uv(const struct glint_placed *p,
                   const struct glint_met_surface *surface, int32_t uv_q16[2]);

/* Copies materials and metals of the model; drawing uses the copies from now
 * on. */
void glint_scene_copy_looks(struct glint_scene *scene);

/* Marks shadow grids and maps as outdated after objects have moved; the next
 * frame rebuilds them. */
void glint_scene_forget_shadows(struct glint_scene *scene);

#endif
