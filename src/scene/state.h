/* SPDX-License-Identifier: MIT
 *
 * State of a scene, and the interfaces between its modules.
 *
 * visible -> surface -> shade: the object visible at a sample; the point and
 * normal where a ray meets it; the light that it sends back along the ray. */
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
    GLINT_SCENE_MOST_LIGHT = 1 << 30, /* light, q15, saturates there */
    GLINT_SCENE_LIFT = 4,     /* steps above a mesh from which its rays start */
    GLINT_SCENE_SAMPLES = 16, /* of a pixel, at most */
    GLINT_SCENE_PASSES = 8,   /* surfaces that a ray passes through, at most */
    GLINT_COVER_LOG2 = 3 /* log2 of the side of a square of the cover kept */
};

#define GLINT_NOTHING UINT32_C(0xffffffff)

/* An object where it is in this frame. */
struct glint_placed {
    const struct glint_scene_object *object;
    int32_t at[3], radius;
    /* Point p of the object is at at + turn p. */
    struct glint_scene_turn turn;
    /* A ball that holds it; of a plane, its normal, _q30, and 0. */
    int32_t centre[3], reach;
    uint32_t material; /* of what has none of its own */
    int is_shown;
    int is_split, is_catcher; /* as its material and itself say */
    int skin;                 /* its map, where it is translucent; or -1 */
    int is_seen;              /* may be seen in this frame */
    struct glint_box box;     /* pixels that it may touch */
    uint32_t first_vertex;    /* mesh: of those of all objects */
    int32_t margin;           /* sphere: a pixel's diagonal at its far side,
                                 steps, 1 at least */
    struct glint_depth depth; /* plane: 1 / z over the picture */
    int32_t z[2];             /* between which it lies; of a plane, anywhere */
    /* Sphere: 2^30 nearest / z for all of it, where that tells it from all
     * other balls that it may overlap, else 0; and of its far side. */
    int32_t flat_depth, far_depth;
    /* Sphere: from the camera to its middle over its radius, _q OVER_UP; 0:
     * that is not to be had (quick.c). */
    int32_t over[3];
    int over_up;
    /* Sphere: the suns, by bits of their index, from which nothing can hide a
     * place on it that faces them, as of their grids. */
    uint32_t open_to;
    /* Which pixels of a row a ball may touch (quick.c). */
    struct {
        int is_there;
        int32_t m_q30[3], c_q30, a_q30;
        uint32_t over; /* 2^61 over -A 2^UP */
        int up;
    } span;
};

enum { GLINT_QUICK_TRIANGLES = 32 };

/* A triangle that is shaded (quick.c). */
struct glint_quick_triangle {
    uint32_t id;
    int is_there, is_inside, is_smooth;
    const struct glint_scene_material *material;
    /* Twice the area opposite each corner, q16, at place (x, y) from the first:
     * at + across x + down y; all three, times 2^UP, are 2^63 / ONE_OVER. */
    int32_t x_q8, y_q8, across[3], down[3];
    int64_t at[3];
    int up;
    uint32_t one_over;
    int32_t nearer_q30[3]; /* the least depth over that of each */
    /* The first corner, and how the others differ from it. */
    int32_t place[3][3], normal_q29[3][3];
    int32_t face_q30[3];
};

enum { GLINT_SHADOW_CELLS_LOG2 = 6, GLINT_SHADOW_POINTS = 16 };

/* A point of a sun's disc: its direction, and how its rays lean against the
 * middle's, tangents. */
struct glint_shadow_point {
    int32_t toward_q30[3], lean_q30[2];
};

/* The box that an object can shadow, from the direction of a sun: across, in
 * 256ths of a cell, rounded down; how high it reaches. */
struct glint_shadow_thing {
    uint32_t id; /* object << 20 | triangle */
    int16_t lo[2], hi[2];
    int32_t top;
};

/* Objects that cast shadows, from the direction of a sun (shadow.c). */
struct glint_shadow {
    int light;                    /* its index */
    int is_ready;                 /* nothing has moved since */
    int is_empty;                 /* nothing throws any */
    struct glint_scene_turn turn; /* to across u, v, and along its rays */
    int32_t lo[3], hi[3];         /* what lies in the grid */
    int32_t lowest;               /* along the rays, of places it answers for */
    int32_t cells_q32[2];         /* cells in a step, up to 2^30 */
    int n_points;
    int32_t lean_q30; /* the most of all points */
    struct glint_shadow_point point[GLINT_SHADOW_POINTS];
    int32_t (*vertex)[3];             /* of all meshes, turned */
    struct glint_bins bins;           /* of cells: numbers of objects */
    struct glint_shadow_thing *thing; /* [n_things] */
    int n_things;
    int max_refs; /* entries; the number of objects at least */
};

/* A light where it is in this frame. */
struct glint_lit {
    struct glint_shadow *shadow; /* NULL: rays request it */
    const struct glint_scene_light *light;
    int32_t at[3];         /* lamp: place */
    int32_t toward_q30[3]; /* sun: direction */
    int32_t rgb_q15[3];    /* sun: 0 .. 2^30 */
};

/* Intersection of a ray. */
struct glint_met {
    uint32_t object, triangle;
    int32_t t;
    int end; /* of a sphere's chord: 0 where the ray enters */
    struct glint_chord chord;
    struct glint_spot_on spot;
};

/* The place where a ray is met. Normals point to where the ray comes from. */
struct glint_met_surface {
    const struct glint_scene_material *material;
    uint32_t object, triangle;
    int32_t t, place[3];
    int32_t normal_q30[3], face_q30[3]; /* for shading; of the object itself */
    int is_inside;                      /* the ray comes from within */
    int32_t uv_q16[2];
    /* log2 of texels' area, in units of uv, per step^2; _q16 */
    int32_t uv_log2_q16;
};

/* Tangent frame of brushed metal at a place. */
struct glint_brushed {
    int32_t frame_q30[3][3]; /* rows: tangent, bitangent, normal; units */
    int32_t spread_q30;      /* what the normal's turn within a pixel adds to
                                the squares of alphas: twice its variance; -1:
                                no light has requested it */
};

/* Light and cover of a pixel: sums over four samples. */
struct glint_scene_sum {
    int64_t rgb_q17[3];
    int cover_q10, shadow_q10; /* all; of catchers */
};

enum {
    GLINT_GLOSS_STEPS_LOG2 = 8,
    GLINT_GLOSS_STEPS = 1 << GLINT_GLOSS_STEPS_LOG2
};

/* (1 - y)^k of a material, y = 0 .. END in steps, straight between them; beyond
 * it is 0. Off by 2^-11.5. */
struct glint_gloss {
    int32_t end_q30;
    int64_t scale_q30; /* 1 / end: 1 .. 2^13 */
    uint16_t at_q15[GLINT_GLOSS_STEPS + 1];
};

struct glint_scene_worker {
    /* [samples of a tile]: 2^30 nearest / z of what is seen, and what: object
     * << 20 | triangle, or GLINT_NOTHING */
    int32_t *depth;
    uint32_t *id;
    struct glint_box tile;
    struct glint_box touched; /* pixels of it that may see an object; of others
                                 there are no samples */
    const struct glint_scene *scene;
    struct glint_tile_scratch scratch;
    /* [half a tile]: of two by two pixels that see one object, shaded in the
     * upper row; NULL if each is shaded. */
    struct glint_scene_sum *quad;
    struct glint_quick_triangle *quick; /* [GLINT_QUICK_TRIANGLES] */
    int is_linear;
    struct glint_layer_span *span; /* [layers]: of the row that is drawn */
    int *over; /* [layers]: those over the pixel that is drawn */
    int n_spans, n_over;
};

struct glint_scene {
    struct glint_scene_config cfg;
    struct glint_scene_model model;
    struct glint_scene_view view;
    const int8_t (*sample_q8)[2]; /* of a pixel, from its middle */
    struct glint_placed *placed;  /* [n_objects] */
    struct glint_lit *lit;        /* [n_lights] */
    uint32_t n_lit;               /* those that shine: the first ones */
    int32_t (*seen)[3];           /* camera coordinates of all vertices */
    struct glint_corner *corner;  /* and where they are in the picture */
    struct glint_bins bins;       /* of triangles, object << 20 | triangle */
    int32_t nearest;              /* z of what is nearest, 1 at least */
    int has_triangles;            /* bins are filled */
    int n_planes;                 /* that throw shadows, */
    uint32_t plane;               /* and the last of them */
    int has_split, has_catchers;  /* objects that are so */
    struct glint_scene_worker *worker; /* [workers] */
    struct glint_blend_rows *rows;     /* [workers] */
    struct glint_resolve *resolve;
    struct glint_curve *curve; /* of textures; NULL: there are none */
    struct glint_gloss *gloss; /* [n_materials] */
    /* Background of mirrors and glass; not allocated if no material shows it.
     * */
    struct glint_around around;
    struct glint_scene_material *material; /* [n_materials], as they look now */
    struct glint_scene_ward *ward;         /* [n_wards] */
    struct glint_ward_state *wards;   /* NULL: neither environment nor metal */
    struct glint_stone_state *stones; /* NULL: nothing is translucent */
    uint32_t moved; /* how often objects or lights have moved */
    int is_spread;  /* maps are up to date with the frame that was begun */
    struct glint_highlight_state *bright; /* NULL: highlights are not wanted */
    struct glint_motion_state *motion;    /* NULL: nothing was recorded */
    int cover_across, cover_down;
    uint16_t *cover; /* [cover_down][cover_across]: sums of q8 over 64 pixels */
};

static inline uint32_t glint_id(uint32_t object, uint32_t triangle)
{
    return object << 20 | triangle;
}

/* --------------------------------------------------------- visible, surface */

/* Returns where N samples of a pixel lie, 1, 4, 8 or 16, q8 from its middle. */
const int8_t (*glint_scene_samples(int n))[2];

/* Finds balls for which one depth suffices, once all are placed. */
void glint_scene_flatten(struct glint_scene *scene);

/* Confines catchers to where shadows may be, once grids of shadows are made. */
void glint_scene_confine(struct glint_scene *scene);

/* Confines X0 .. X1 - 1 to pixels of row Y that ball P may touch; returns 0 if
 * there are none. */
int glint_scene_span(const struct glint_scene *scene,
                     const struct glint_placed *p, int y, int32_t *x0,
                     int32_t *x1);

/* Finds the visible objects in TILE; returns 0 if there are none. */
int glint_scene_look(struct glint_scene_worker *w, struct glint_box tile);

/* Sets MET to what is nearest on RAY, but OBJECT and, in meshes, TRIANGLE of
 * it; returns 0 if there is nothing. Catchers are passed. */
int glint_scene_meet(const struct glint_scene *scene,
                     const struct glint_scene_ray *ray, uint32_t object,
                     uint32_t triangle, struct glint_met *met);

/* Returns whether anything but that is on RAY nearer than LIMIT. */
int glint_scene_blocks(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray, uint32_t object,
                       uint32_t triangle, int32_t limit);

/* Returns whether a plane but OBJECT is on RAY. */
int glint_scene_planes_block(const struct glint_scene *scene,
                             const struct glint_scene_ray *ray,
                             uint32_t object);

/* Returns whether a plane but OBJECT throws shadows at all. */
static inline int glint_scene_other_planes(const struct glint_scene *s,
                                           uint32_t object)
{
    return s->n_planes > (s->n_planes > 0 && s->plane == object);
}

/* Sets MET to where RAY, of the picture, meets object ID, held inside if it is
 * a triangle; returns 0 if it does not. SEEN_Q30 is its direction in camera
 * coordinates. */
int glint_scene_meet_id(const struct glint_scene *scene,
                        const struct glint_scene_ray *ray,
                        const int32_t seen_q30[3], uint32_t id,
                        struct glint_met *met);

/* Sets SURFACE to where RAY met MET. Returns 0 where there is none: out of
 * range, or without area. */
int glint_scene_surface(const struct glint_scene *scene,
                        const struct glint_scene_ray *ray,
                        const struct glint_met *met,
                        struct glint_met_surface *surface);

/* ------------------------------------------------------------------- shade */

/* Light sent back along a ray, and the fraction of the background that it
 * hides. */
struct glint_met_shade {
    int32_t rgb_q15[3]; /* 0 .. 2^30 */
    int cover_q8;       /* 0 .. 256 */
};

/* Adds to RGB_Q15 the light of all lights that SURFACE reflects along RAY,
 * times WEIGHT_Q15. */
void glint_scene_phong(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray,
                       const struct glint_met_surface *surface,
                       int32_t weight_q15, int32_t rgb_q15[3]);

/* The shade of a primary RAY that met SURFACE. */
void glint_scene_shade(const struct glint_scene *scene,
                       const struct glint_scene_ray *ray,
                       const struct glint_met_surface *surface,
                       struct glint_met_shade *shade);

/* Returns the fraction, 0 .. 32768, of light LIT that reaches SURFACE, as rays
 * through the scene find it. */
int32_t glint_rays_reach(const struct glint_scene *scene,
                         const struct glint_met_surface *surface,
                         const struct glint_lit *lit);

/* Makes the grid of LIT, a sun. */
void glint_shadow_prepare(const struct glint_scene *scene,
                          const struct glint_lit *lit,
                          struct glint_shadow *shadow);

/* Returns the pixels in which the sun's shadows on plane P may be. */
struct glint_box glint_shadow_box(const struct glint_scene *scene,
                                  const struct glint_shadow *shadow,
                                  const struct glint_placed *p);

/* Returns the fraction of that sun that reaches PLACE, the start of rays from
 * SURFACE. */
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

/* Sets U and V at right angles to D and to each other. */
void glint_scene_frame_of(const int32_t d_q30[3], int32_t u_q30[3],
                          int32_t v_q30[3]);

/* Sets TOWARD_Q30 to the direction from PLACE to LIT and LEVEL_Q15 to what it
 * makes of a white surface that faces it; returns the distance, GLINT_FAR for a
 * sun; 0: PLACE is where it is. */
int32_t glint_scene_light_at(const struct glint_scene *scene,
                             const struct glint_lit *lit,
                             const int32_t place[3], int32_t toward_q30[3],
                             int32_t level_q15[3]);

/* Makes the table of powers of POWER_Q8. */
void glint_gloss_prepare(struct glint_gloss *gloss, int32_t power_q8);

/* Returns X^K, off by less than 1/512; X_Q30 0 .. 2^30, K_Q8 from 1. */
int32_t glint_power_q15(int32_t x_q30, int32_t k_q8);

/* Turns RAY, towards the middle of a light T steps away, to point I of the N
 * (1, 4 or 16) of its disc. RADIUS is in steps; T GLINT_FAR: it is a sine, q30.
 */
void glint_scene_point(struct glint_scene_ray *ray, int32_t t, int32_t radius,
                       int i, int n);

/* Background other than the picture: sets RGB_Q15 to the light from TOWARD_Q30,
 * in the mean of a spot of that angular variance.
 */
void glint_scene_behind(const struct glint_scene *scene,
                        const int32_t toward_q30[3], int64_t spread_q40,
                        int32_t rgb_q15[3]);

/* Returns how many highlights are found at most. */
static inline int glint_scene_wanted_highlights(const struct glint_scene *s)
{
    const struct glint_scene_header *h = s->model.header;

    return s->cfg.highlights >= 0 ? s->cfg.highlights
           : h->flare             ? (int)h->highlights
                                  : 0;
}

/* Returns the angular variance of a pixel. */
static inline int64_t glint_scene_pixel_q40(const struct glint_scene *scene)
{
    const int64_t step_q30 = scene->view.step_q56[0] >> 18;

    return step_q30 < 1 << 30 ? step_q30 * step_q30 >> 22 : INT64_C(1) << 38;
}

/* Sets UV to the place of SURFACE on ball P: u goes round the y axis, 1/2 where
 * a camera that is not turned sees the middle of the ball; v from its top down.
 */
void glint_ball_uv(const struct glint_placed *p,
                   const struct glint_met_surface *surface, int32_t uv_q16[2]);

/* Copies materials and metals of the model, and draws by these from now on. */
void glint_scene_copy_looks(struct glint_scene *scene);

/* Objects have moved: grids of shadows, and maps, wait for the next frame. */
void glint_scene_forget_shadows(struct glint_scene *scene);

#endif
