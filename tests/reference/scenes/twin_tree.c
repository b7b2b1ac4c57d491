/* SPDX-License-Identifier: MIT
 *
 * Builds trees of bounding boxes over the triangles of each object, and
 * intersects rays with them. Boxes are split at the middle of their longest
 * side.
 */
#include "reference/scenes/twin.h"

#include <stdlib.h>

#include "reference/scenes/vec.h"

enum { LEAF = 4, DEPTH = 64 };

struct twin_node {
    double low[3], high[3];
    int first, n;    /* leaf: its triangles are order[first .. first + n - 1] */
    int left, right; /* inner node: indices of its two children; n is 0 */
};

static void compute_node_bounds(const struct twin *twin, struct twin_node *node)
{
    for (int i = 0; i < 3; i++) {
        node->low[i] = HUGE_VAL;
        node->high[i] = -HUGE_VAL;
    }
    for (int m = node->first; m < node->first + node->n; m++) {
        const struct glint_described_triangle *t =
            &twin->scene->triangle[twin->order[m]];

        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++) {
                node->low[i] = fmin(node->low[i], t->place[k][i]);
                node->high[i] = fmax(node->high[i], t->place[k][i]);
            }
    }
}

/* Moves the triangles of NODE whose centre along AXIS is below AT to the
 * beginning of the node's list. Returns their number. */
static int partition_triangles(const struct twin *twin,
                               const struct twin_node *node, int axis,
                               double at)
{
    int n = 0;

    for (int m = 0; m < node->n; m++) {
        int *const here = &twin->order[node->first + m];
        const struct glint_described_triangle *t =
            &twin->scene->triangle[*here];

        if (t->place[0][axis] + t->place[1][axis] + t->place[2][axis] <
            3 * at) {
            const int other = twin->order[node->first + n];

            twin->order[node->first + n++] = *here;
            *here = other;
        }
    }
    return n;
}

/* Splits node I and its children recursively. *N_NODES is the number of nodes
 * in use. */
static void split_node(struct twin *twin, int i, int *n_nodes, int depth)
{
    struct twin_node *const node = &twin->node[i];
    int axis = 0, n;

    compute_node_bounds(twin, node);
    if (node->n <= LEAF || depth == DEPTH - 2)
        return;
    for (int k = 1; k < 3; k++)
        if (node->high[k] - node->low[k] > node->high[axis] - node->low[axis])
            axis = k;
    n = partition_triangles(twin, node, axis,
                            (node->low[axis] + node->high[axis]) / 2);
    if (n == 0 || n == node->n)
        n = node->n / 2;
    node->left = (*n_nodes)++;
    node->right = (*n_nodes)++;
    twin->node[node->left] = (struct twin_node){.first = node->first, .n = n};
    twin->node[node->right] =
        (struct twin_node){.first = node->first + n, .n = node->n - n};
    node->n = 0;
    split_node(twin, node->left, n_nodes, depth + 1);
    split_node(twin, node->right, n_nodes, depth + 1);
}

enum glint_status reference_build_tree(struct twin *twin)
{
    const struct glint_description *s = twin->scene;
    const size_t n = (size_t)s->n_triangles;
    int n_nodes = 0;

    /* a tree has fewer nodes than twice its triangles */
    twin->node = malloc((2 * n + 1) * sizeof *twin->node);
    twin->order = malloc((n + 1) * sizeof *twin->order);
    twin->root = malloc(((size_t)s->n_objects + 1) * sizeof *twin->root);
    if (!twin->node || !twin->order || !twin->root)
        return GLINT_E_MEMORY;
    for (int i = 0; i < s->n_triangles; i++)
        twin->order[i] = i;
    for (int i = 0; i < s->n_objects; i++) {
        const struct glint_described_object *o = &s->object[i];

        twin->root[i] = -1;
        if (!o->n_triangles)
            continue;
        twin->root[i] = n_nodes++;
        twin->node[twin->root[i]] =
            (struct twin_node){.first = o->first_triangle, .n = o->n_triangles};
        split_node(twin, twin->root[i], &n_nodes, 0);
    }
    return GLINT_OK;
}

/* Returns whether RAY enters the bounding box of NODE before the distance
 * MOST. */
static bool ray_passes_box(const struct twin_node *node,
                           const struct twin_ray *ray, double most)
{
    double from = 0, to = most;

    for (int i = 0; i < 3; i++) {
        const double inverse = 1 / ray->toward[i];
        const double a = (node->low[i] - ray->from[i]) * inverse;
        const double b = (node->high[i] - ray->from[i]) * inverse;

        /* The quotients are NaN if the ray lies in the plane of a face. */
        if (isnan(a) || isnan(b))
            continue;
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    return from <= to * (1 + 1e-9);
}

/* Finds the intersection of RAY with triangle I nearer than hit->t, by
 * [Moller97]. The point is V0 + u (V1 - V0) + v (V2 - V0), where V0, V1 and V2
 * are the corners. */
static bool intersect_triangle(const struct twin *twin, int i,
                               const struct twin_ray *ray, struct twin_hit *hit)
{
    const struct glint_described_triangle *tri = &twin->scene->triangle[i];
    double a[3], b[3], p[3], q[3], s[3], det, u, v, t;

    vec_add_scaled(tri->place[1], -1, tri->place[0], a);
    vec_add_scaled(tri->place[2], -1, tri->place[0], b);
    vec_cross(ray->toward, b, p);
    det = vec_dot(a, p);
    vec_add_scaled(ray->from, -1, tri->place[0], s);
    vec_cross(s, a, q);
    u = vec_dot(s, p);
    v = vec_dot(ray->toward, q);
    t = vec_dot(b, q);
    if (det < 0) {
        u = -u;
        v = -v;
        t = -t;
    }
    /* if the ray lies in the triangle's plane, or the triangle has no area,
     * det, u, v and t are 0 */
    if (!(fabs(det) > 0) || u < 0 || v < 0 || u + v > fabs(det) || t <= 0 ||
        t >= hit->t * fabs(det))
        return false;
    hit->t = t / fabs(det);
    hit->triangle = i;
    hit->inside = det < 0;
    hit->uv[0] = u / fabs(det);
    hit->uv[1] = v / fabs(det);
    return true;
}

bool reference_intersect_mesh(const struct twin *twin, int object,
                              const struct twin_ray *ray, double most,
                              struct twin_hit *hit)
{
    int stack[DEPTH], n = 0;
    bool found = false;

    hit->t = most;
    stack[n++] = twin->root[object];
    while (n) {
        const struct twin_node *node = &twin->node[stack[--n]];

        if (!ray_passes_box(node, ray, hit->t))
            continue;
        if (!node->n) {
            stack[n++] = node->left;
            stack[n++] = node->right;
        }
        for (int m = node->first; m < node->first + node->n; m++)
            if (twin->order[m] != ray->skip_triangle &&
                intersect_triangle(twin, twin->order[m], ray, hit))
                found = true;
    }
    return found;
}
