/* SPDX-License-Identifier: MIT
 *
 * State of a scene, and the interfaces between its files.
 *
 * Drawing has three steps: visible.c finds the object at each sample, surface.c
 * the point and normal where a ray hits the object, and phong.c the light that
 * the surface sends along the ray. */
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
    GLINT_SCENE_MOST_LIGHT = 1 << 30, /* max light, q15; more is clamped to
                                         it */
    /* distance, steps, by which the start of secondary rays is moved off a
     * mesh's surface */
    GLINT_SCENE_LIFT = 4,
    GLINT_SCENE_SAMPLES = 16, /* max samples per pixel */
    GLINT_SCENE_PASSES = 8,   /* max number of surfaces that transmit a ray */
    GLINT_COVER_LOG2 = 3 /* log2 of the side, pixels, of the squares over which
                            coverage is summed */
};

#define GLINT_NOTHING UINT32_C(0xffffffff)

/* An object with its position and derived values in this frame. */
struct glint_placed {
    const struct glint_scene_object *object;
    int32_t at[3], radius;
    /* Rotation of the object: its point p lies at position AT + TURN p. */
    struct glint_scene_turn turn;
    /* Centre and radius of the bounding sphere, steps. For a plane: its normal,
     * _q30, and 0. */
    int32_t centre[3], reach;
    uint32_t material; /* index of the material of surfaces that have no
                          material of their own */
    int is_shown;
    /* is_split: the object is shaded at each sample of a pixel. is_catcher: it
     * is a plane that only receives shadows. is_only_shadow: it is a catcher
     * that changes only pixels with shadows of suns with grids, and pixels of
     * objects that may be behind it, which have is_behind_catcher. */
    int16_t is_split, is_catcher, is_only_shadow, is_behind_catcher;
    int skin;             /* index of the object's map if it is translucent,
                             else -1 */
    int is_seen;          /* 1: the object may be visible in this frame */
    struct glint_box box; /* pixels that the object may cover */
    /* Mesh: index of its first vertex in the table of all objects' vertices. */
    uint32_t first_vertex;
    /* Sphere: max distance, at its far side, of a sample's ray from the ray of
     * the pixel's middle, steps, rounded up, plus 1. */
    int32_t margin;
    struct glint_depth depth; /* plane: 1 / z as a function of the position in
                                 the picture */
    int32_t z[2]; /* min and max z in camera coordinates, steps; -GLINT_FAR and
                     GLINT_FAR for planes */
    /* Sphere: depths, 2^30 nearest / z. far_depth: depth of the far side.
     * flat_depth: a single depth for all samples, if it suffices to order the
     * sphere against all balls that it may overlap, else 0. */
    int32_t flat_depth, far_depth;
    /* Sphere: (vector from the camera to its middle) / radius, with over_up
     * fraction bits; over_up is 0 if the quotient is out of range (quick.c). */
    int32_t over[3];
    int over_up;
    /* Sphere: bit i is set if light i is a sun that no ball or mesh can hide
     * from the points of the sphere that face this sun. */
    uint32_t open_to;
    /* Sphere: coefficients for the range of pixels in a row that it may cover
     * (quick.c). */
    struct {
        int is_there;
        int32_t m_q30[3], c_q30, a_q30;
        uint32_t over; /* 2^61 / (-a_q30 2^up) */
        int up;
    } span;
};

enum { GLINT_QUICK_TRIANGLES = 32 };

/* A triangle prepared for shading (quick_mesh.c). */
struct glint_quick_triangle {
    uint32_t id;
    int is_there, is_inside, is_smooth;
    const struct glint_scene_material *material;
    /* Linear functions of the position (x, y), relative to the first corner,
     * q16: AT + ACROSS x + DOWN y. The function of a corner is twice the area
     * of the triangle formed by (x, y) and the opposite edge, so these
     * functions are barycentric weights. Their sum is 2^63 / (one_over
     * 2^up). */
    int32_t x_q8, y_q8, across[3], down[3];
    int64_t at[3];
    int up;
    uint32_t one_over;
    /* for each corner: min z of the three corners / z of this corner */
    int32_t nearer_q30[3];
    /* The first corner's position and normal, and the differences of the second
     * and third corner from them. */
    int32_t place[3][3], normal_q29[3][3];
    int32_t face_q30[3];
};

enum { GLINT_SHADOW_CELLS_LOG2 = 6, GLINT_SHADOW_POINTS = 16 };

/* A sample point of a sun's disc: its direction, and the slope of its rays
 * relative to the ray from the disc's middle, as two tangents. */
struct glint_shadow_point {
    int32_t toward_q30[3], lean_q30[2];
};

/* The footprint of an object in a sun's shadow grid: the bounds, across the
 * rays, of the region that the object can shadow, in 1/256 of a cell, rounded
 * down; and the object's top, max h. */
struct glint_shadow_thing {
    uint32_t id; /* object index << 20 | triangle index */
    int16_t lo[2], hi[2];
    int32_t top;
};

/* A sun's shadow grid: the objects that cast shadows, sorted into cells across
 * its rays (shadow.c). */
struct glint_shadow {
    int light;    /* index of the sun among the lights */
    int is_ready; /* 1: the grid is up to date, as nothing has moved since it
                     was built */
    int is_empty; /* 1: no ball or mesh casts shadows */
    struct glint_scene_turn turn; /* rotation to coordinates u and v across the
                                     rays and h along them */
    int32_t lo[3], hi[3];         /* bounds of the objects in the grid, in
                                     coordinates u, v, h */
    int32_t lowest; /* min h of points for which the grid is valid */
    /* cells per step along u and v; at most a quarter of a cell, so the stored
     * value is at most 2^30 */
    int32_t cells_q32[2];
    int n_points;
    int32_t lean_q30; /* max slope of the rays from any sample point */
    struct glint_shadow_point point[GLINT_SHADOW_POINTS];
    int32_t (*vertex)[3];   /* vertices of all meshes, rotated by turn to u, v,
                               h */
    struct glint_bins bins; /* per cell: indices into THING of the objects that
                               the cell lists */
    struct glint_shadow_thing *thing; /* [n_things]: objects that cast
                                         shadows */
    int n_things;
    /* memory for the lists of all cells, entries; at least the number of
     * objects */
    int max_refs;
};

/* A light source with its position in this frame. */
struct glint_lit {
    struct glint_shadow *shadow; /* shadow grid of a sun; NULL: shadow rays are
                                    traced through all objects */
    const struct glint_scene_light *light;
    int32_t at[3];         /* lamp: position, steps */
    int32_t toward_q30[3]; /* sun: unit vector to it */
    int32_t rgb_q15[3];    /* sun: light on a white surface that faces the sun,
                              0 .. 2^30 */
};

/* The intersection of a ray with an object. */
struct glint_met {
    uint32_t object, triangle;
    int32_t t;
    int end; /* for a sphere: 0 where the ray enters, 1 where it leaves */
    struct glint_chord chord;
    struct glint_spot_on spot;
};

/* The point where a ray meets a surface. Normals point to the side from which
 * the ray comes. */
struct glint_met_surface {
    const struct glint_scene_material *material;
    uint32_t object, triangle;
    int32_t t, place[3];
    int32_t normal_q30[3], face_q30[3]; /* shading normal, interpolated; normal
                                           of the face */
    int is_inside; /* 1: the ray comes from inside the object */
    int32_t uv_q16[2];
    /* log2 of (area in uv space / area on the surface in steps^2), _q16 */
    int32_t uv_log2_q16;
};

/* Tangent frame of brushed metal at a surface point. */
struct glint_brushed {
    int32_t frame_q30[3][3]; /* rows: tangent, bitangent, normal; unit
                                vectors */
    /* Twice the variance of the normal within a pixel, which is added to the
     * squared alphas of the lobe; -1: not computed yet. */
    int32_t spread_q30;
};

/* Light and coverage of a pixel, scaled to the sum of four samples. */
struct glint_scene_sum {
    int64_t rgb_q17[3];
    /* cover_q10: fraction that objects cover; shadow_q10: darkening by shadow
     * catchers. */
    int cover_q10, shadow_q10;
};

enum {
    GLINT_GLOSS_STEPS_LOG2 = 8,
    GLINT_GLOSS_STEPS = 1 << GLINT_GLOSS_STEPS_LOG2
};

/* Table of a material's specular power (1 - y)^k for y = 0 .. end, interpolated
 * linearly; 0 for larger y. Max error 2^-11.5. */
struct glint_gloss {
    int32_t end_q30;
    int64_t scale_q30; /* 1 / end, 1 .. 2^13 */
    uint16_t at_q15[GLINT_GLOSS_STEPS + 1];
};

struct glint_scene_worker {
    /* [samples of a tile]: depth of the visible object, 2^30 nearest / z; and
     * its id, object << 20 | triangle, or GLINT_NOTHING. */
    int32_t *depth;
    uint32_t *id;
    struct glint_box tile;
    struct glint_box touched; /* pixels of the tile that may see an object; only
                                 these have samples */
    const struct glint_scene *scene;
    struct glint_tile_scratch scratch;
    /* [half a tile]: light and coverage of blocks of 2 x 2 pixels that see one
     * object and are shaded once, with the block's upper row. NULL: every pixel
     * is shaded. */
    struct glint_scene_sum *quad;
    struct glint_quick_triangle *quick; /* [GLINT_QUICK_TRIANGLES]: cache of
                                           prepared triangles */
    int is_linear;
    struct glint_layer_span *span; /* [layers]: overlays in the current row,
                                      with the pixels that they cover */
    int *over;                     /* [layers]: indices of the overlays at the
                                      current pixel */
    int n_spans, n_over;
};

struct glint_scene {
    struct glint_scene_config cfg;
    struct glint_scene_model model;
    struct glint_scene_view view;
    const int8_t (*sample_q8)[2]; /* offsets of a pixel's samples from its
                                     middle, q8 */
    struct glint_placed *placed;  /* [n_objects] */
    struct glint_lit *lit;        /* [n_lights]: the lights that are on come
                                     first */
    uint32_t n_lit;               /* number of lights that are on */
    int32_t (*seen)[3];           /* camera coordinates of the vertices of all
                                     meshes, steps */
    struct glint_corner *corner;  /* the same vertices projected to the
                                     picture */
    struct glint_bins bins; /* list of triangles per tile, as object << 20 |
                               triangle */
    int32_t nearest;        /* min z of all visible objects, steps, at least
                               1 */
    int has_triangles;      /* 1: bins has the triangles of this frame */
    int n_planes;           /* number of planes that cast shadows */
    uint32_t plane;         /* index of the last plane that casts shadows */
    /* 1: some object has is_split (has_split), or is_catcher (has_catchers) */
    int has_split, has_catchers;
    struct glint_scene_worker *worker; /* [workers] */
    struct glint_blend_rows *rows;     /* [workers] */
    struct glint_resolve *resolve;
    /* table that decodes texels to linear light; NULL: no object has a
     * texture */
    struct glint_curve *curve;
    struct glint_gloss *gloss; /* [n_materials] */
    /* The camera's picture as background of mirrors and glass; not allocated if
     * no material reflects or refracts it. */
    struct glint_around around;
    struct glint_scene_material *material; /* [n_materials]: materials as last
                                              set */
    struct glint_scene_ward *ward;         /* [n_wards] */
    /* state of metals and environments; NULL: the scene has none */
    struct glint_ward_state *wards;
    /* state of translucent media; NULL: the scene has none */
    struct glint_stone_state *stones;
    uint32_t moved; /* counter, incremented when an object or light changes */
    int is_spread;  /* 1: the maps of translucent objects are computed for the
                       current frame */
    /* NULL: highlights are not requested */
    struct glint_highlight_state *bright;
    struct glint_motion_state *motion; /* NULL: there is no recorded motion */
    int cover_across, cover_down;
    uint16_t *cover; /* [cover_down][cover_across]: coverage, _q8, summed over
                        squares of 8 x 8 pixels */
    /* number of ray tests, for glint_scene_count_tests(); NULL: not counted */
    int64_t *tests;
};

/* Counts N tests of a ray against an object, grid cell or triangle. */
static inline void glint_scene_count_ray_tests(const struct glint_scene *scene,
                                               int64_t n)
{
    if (scene->tests)
        *scene->tests += n;
}

static inline uint32_t glint_make_triangle_id(uint32_t object,
                                              uint32_t triangle)
{
    return object << 20 | triangle;
}

/* --------------------------------------------------------- visible, surface */

/* Returns the offsets of N samples from the middle of their pixel, q8. N must
 * be 1, 4, 8 or 16. */
const int8_t (*glint_scene_samples(int n))[2];

/* Sets flat_depth of the balls that can be ordered by one depth. Called after
 * the positions of all objects are set. */
void glint_scene_set_single_depths_of_balls(struct glint_scene *scene);

/* Reduces the box of each shadow catcher to pixels that may have shadows.
 * Called after the shadow grids are built. */
void glint_scene_shrink_catcher_boxes(struct glint_scene *scene);

/* Narrows the range X0 .. X1 - 1 to the pixels of row Y that ball P may cover;
 * returns 1, or 0 if there are none. */
int glint_scene_find_ball_span(const struct glint_scene *scene,
                               const struct glint_placed *p, int y, int32_t *x0,
                               int32_t *x1);

/* Finds the visible object at each sample of TILE. Returns whether the tile
 * must be drawn: objects or overlays may be visible in it, or the background is
 * not the camera's picture. */
int glint_scene_look(struct glint_scene_worker *w, struct glint_box tile);

/* Sets MET to the nearest intersection of RAY with an object; returns 0 if
 * there is none. Skips shadow catchers, and the OBJECT on which the ray starts;
 * if OBJECT is a mesh, only its triangle TRIANGLE. */
int glint_scene_find_nearest_hit(const struct glint_scene *scene,
                                 const struct glint_scene_ray *ray,
                                 uint32_t object, uint32_t triangle,
                                 struct glint_met *met);

/* Returns whether RAY hits any object nearer than LIMIT steps. Skips the same
 * objects as glint_scene_find_nearest_hit(). */
int glint_scene_is_ray_blocked(const struct glint_scene *scene,
                               const struct glint_scene_ray *ray,
                               uint32_t object, uint32_t triangle,
                               int32_t limit);

/* Returns the fraction of a light at distance LIMIT along RAY, _q15, that
 * objects let through to the start of RAY. Skips the same objects as
 * glint_scene_find_nearest_hit(). */
int32_t glint_scene_compute_unblocked_light(const struct glint_scene *scene,
                                            const struct glint_scene_ray *ray,
                                            uint32_t object, uint32_t triangle,
                                            int32_t limit);

/* Returns 0 if no object can shadow any ray of a cone. The cone starts at AXIS,
 * ends at distance T along it, and has the half angle atan(SLOPE_Q30), at most
 * 45 degrees. Skips the same objects as glint_scene_find_nearest_hit(). */
int glint_scene_can_cone_be_blocked(const struct glint_scene *scene,
                                    const struct glint_scene_ray *axis,
                                    uint32_t object, int32_t t,
                                    int32_t slope_q30);

/* Returns whether RAY hits any plane that casts shadows, other than OBJECT. */
int glint_scene_is_ray_blocked_by_plane(const struct glint_scene *scene,
                                        const struct glint_scene_ray *ray,
                                        uint32_t object);

/* Returns whether any plane other than OBJECT casts shadows. */
static inline int
glint_scene_has_other_shadow_planes(const struct glint_scene *s,
                                    uint32_t object)
{
    return s->n_planes > (s->n_planes > 0 && s->plane == object);
}

/* Sets MET to the intersection of the primary ray RAY with object or triangle
 * ID; a ray that just misses a triangle is moved to the triangle's edge.
 * Returns 0 if the ray misses ID. SEEN_Q30 is the ray's direction in camera
 * coordinates. */
int glint_scene_ray_hits_id(const struct glint_scene *scene,
                            const struct glint_scene_ray *ray,
                            const int32_t seen_q30[3], uint32_t id,
                            struct glint_met *met);

/* Sets SURFACE to position, normals and material at the intersection MET of
 * RAY. Returns 1, or 0 if the point is out of range or the triangle has no
 * area. */
int glint_scene_find_surface_at_hit(const struct glint_scene *scene,
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

/* Adds to RGB_Q15 the light that SURFACE sends along RAY, times WEIGHT_Q15:
 * scattered and ambient light, and reflections of the environment and of all
 * light sources. */
void glint_scene_add_phong_light(const struct glint_scene *scene,
                                 const struct glint_scene_ray *ray,
                                 const struct glint_met_surface *surface,
                                 int32_t weight_q15, int32_t rgb_q15[3]);

/* Sets SHADE to the light that SURFACE sends along the primary ray RAY, and to
 * the fraction of the background that SURFACE hides. */
void glint_scene_shade_surface(const struct glint_scene *scene,
                               const struct glint_scene_ray *ray,
                               const struct glint_met_surface *surface,
                               struct glint_met_shade *shade);

/* Returns the fraction, 0 .. 32768, of light LIT that reaches SURFACE, by
 * tracing rays to sample points of LIT; 32768 if the scene has no shadows. */
int32_t glint_trace_shadow_rays(const struct glint_scene *scene,
                                const struct glint_met_surface *surface,
                                const struct glint_lit *lit);

/* Builds the shadow grid of LIT, which must be a sun. */
void glint_shadow_build_grid(const struct glint_scene *scene,
                             const struct glint_lit *lit,
                             struct glint_shadow *shadow);

/* Returns the box of pixels in which the sun whose grid is SHADOW may cast
 * shadows on plane P. */
struct glint_box glint_shadow_find_plane_box(const struct glint_scene *scene,
                                             const struct glint_shadow *shadow,
                                             const struct glint_placed *p);

/* Returns whether the sun whose grid is SHADOW may cast shadows on the flat
 * quadrilateral with corners CORNER. */
int glint_shadow_can_fall_on(const struct glint_shadow *shadow,
                             const int32_t corner[4][3]);

/* Returns the fraction, 0 .. 32768, of a sun's light that reaches SURFACE;
 * SHADOW is the sun's grid. PLACE is the start of shadow rays from SURFACE. */
int32_t glint_shadow_compute_lit_fraction(
    const struct glint_scene *scene, const struct glint_shadow *shadow,
    const struct glint_met_surface *surface, const int32_t place[3]);

/* Sets AT to the start of secondary rays from SURFACE. For a mesh this is the
 * surface point moved by GLINT_SCENE_LIFT along the face's normal, else the
 * point itself. */
static inline void
glint_scene_set_ray_start(const struct glint_scene *scene,
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
glint_scene_lit_fraction(const struct glint_scene *scene,
                         const struct glint_met_surface *surface,
                         const struct glint_lit *lit)
{
    int32_t at[3];

    if (!lit->shadow || !lit->shadow->is_ready)
        return glint_trace_shadow_rays(scene, surface, lit);
    glint_scene_set_ray_start(scene, surface, at);
    return glint_shadow_compute_lit_fraction(scene, lit->shadow, surface, at);
}

/* Sets U and V to unit vectors perpendicular to D and to each other. */
void glint_scene_find_perpendicular_vectors(const int32_t d_q30[3],
                                            int32_t u_q30[3], int32_t v_q30[3]);

/* Sets TOWARD_Q30 to the direction from PLACE to LIT. Sets LEVEL_Q15 to the
 * light that LIT casts on a white surface at PLACE that faces LIT. Returns the
 * distance of LIT: in steps for a lamp, GLINT_FAR for a sun, or 0 if LIT is at
 * PLACE. */
int32_t glint_scene_compute_light_at(const struct glint_scene *scene,
                                     const struct glint_lit *lit,
                                     const int32_t place[3],
                                     int32_t toward_q30[3],
                                     int32_t level_q15[3]);

/* Fills the table GLOSS with powers of exponent POWER_Q8. */
void glint_gloss_fill_power_table(struct glint_gloss *gloss, int32_t power_q8);

/* Returns X^K, _q15, with an error below 1/512. X_Q30 must be 0 .. 2^30,
 * K_Q8 at least 1. */
int32_t glint_compute_power_q15(int32_t x_q30, int32_t k_q8);

/* Turns RAY from the middle of a light source, T steps away, to sample point I
 * of N (1, 4 or 16) on the light's disc. RADIUS is in steps, or, if T is
 * GLINT_FAR, the sine of the angular radius, q30. */
void glint_scene_aim_at_light_point(struct glint_scene_ray *ray, int32_t t,
                                    int32_t radius, int i, int n);

/* Sets RGB_Q15 to the background (not the camera's picture) in direction
 * TOWARD_Q30, averaged over a spot of angular variance SPREAD_Q40,
 * radians^2. */
void glint_scene_look_up_background(const struct glint_scene *scene,
                                    const int32_t toward_q30[3],
                                    int64_t spread_q40, int32_t rgb_q15[3]);

static inline int glint_scene_get_max_highlights(const struct glint_scene *s)
{
    const struct glint_scene_header *h = s->model.header;

    return s->cfg.highlights >= 0 ? s->cfg.highlights
           : h->flare             ? (int)h->highlights
                                  : 0;
}

/* Returns the angular variance of the rays of one pixel, radians^2. */
static inline int64_t
glint_scene_pixel_variance_q40(const struct glint_scene *scene)
{
    const int64_t step_q30 = scene->view.step_q56[0] >> 18;

    return step_q30 < 1 << 30 ? step_q30 * step_q30 >> 22 : INT64_C(1) << 38;
}

/* Sets UV to the texture coordinates of SURFACE on ball P. u increases around
 * the y axis and is 1/2 where an unrotated camera sees the ball's middle; v
 * runs from top to bottom. */
void glint_compute_ball_uv(const struct glint_placed *p,
                           const struct glint_met_surface *surface,
                           int32_t uv_q16[2]);

/* Copies the model's tables of materials and metals to SCENE, which draws with
 * these copies. */
void glint_scene_copy_materials(struct glint_scene *scene);

/* Marks shadow grids and light maps of translucent objects as outdated after a
 * change; the next frame rebuilds them. */
void glint_scene_invalidate_shadows(struct glint_scene *scene);

#endif
